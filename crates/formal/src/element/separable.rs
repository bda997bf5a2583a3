//! Fields of a box with a node in each corner, one axis after another.
//!
//! `u(ξ) = Σ_n Π_k (1 ± ξ_k)/2 u_n` is interpolated between opposite faces, then between opposite edges of what is left. Samples
//! that share a coordinate share what is made from it, and `∂u/∂ξ_k` does not depend on `ξ_k`: the eight samples of a hexahedron
//! have twelve different gradients, which take 84 operations for each component, 28 along each axis, where eight nodes at eight
//! samples would take 360. Forces go back the same way.

use super::{ElementData, RestMap};
use crate::graph::{Expr, Graph};

/// Corners by their sides: bit `k` of an index is set at `ξ_k = 1`.
#[derive(Clone, Debug)]
pub(super) struct Corners {
    dimension: usize,
    /// Node of each corner.
    nodes: Vec<usize>,
}

impl Corners {
    /// `None` where the element is no box with one node in each corner.
    pub fn of(element: &ElementData) -> Option<Self> {
        let count = 1 << element.dimension;
        if !matches!(element.map, RestMap::Box { .. }) || element.node_count != count {
            return None;
        }
        let mut nodes = vec![None; count];
        for node in 0..count {
            let sides = (0..element.dimension).filter(|axis| is_high(element, node, *axis));
            nodes[sides.map(|axis| 1 << axis).sum::<usize>()] = Some(node);
        }
        let nodes = nodes.into_iter().collect::<Option<Vec<usize>>>()?;
        Some(Self { dimension: element.dimension, nodes })
    }

    /// Axes other than `along`, in the order in which fields are interpolated.
    fn across(&self, along: usize) -> impl DoubleEndedIterator<Item = usize> + use<> {
        let dimension = self.dimension;
        (1..dimension).map(move |step| (along + step) % dimension)
    }

    /// `∂u/∂ξ_along` at `ξ` of a field by nodes.
    pub fn derivative(&self, graph: &mut Graph, field: &[Expr], along: usize, xi: &[f64; 3]) -> Expr {
        let at = |corner: usize| field[self.nodes[corner]];
        let is_low = |corner: &usize| corner & (1 << along) == 0;
        // by corner of the face ξ_along = -1
        let mut differences: Vec<(usize, Expr)> = (0..self.nodes.len())
            .filter(is_low)
            .map(|corner| (corner, graph.subtract(at(corner | 1 << along), at(corner))))
            .collect();
        for (step, axis) in self.across(along).enumerate() {
            let weights = weights(xi[axis], step);
            let (low, high): (Vec<_>, Vec<_>) =
                differences.into_iter().partition(|(corner, _)| corner & (1 << axis) == 0);
            let between = |((corner, low), (_, high)): ((usize, Expr), (usize, Expr))| {
                let terms = [graph.times_number(weights[0], low), graph.times_number(weights[1], high)];
                (corner, graph.sum(&terms))
            };
            differences = low.into_iter().zip(high).map(between).collect();
        }
        differences[0].1
    }

    /// `Σ_q s_q ∂N_n/∂ξ_along(ξ_q)` by node: the transpose of [`Self::derivative`].
    pub fn spread(&self, graph: &mut Graph, samples: &[([f64; 3], Expr)], along: usize) -> Vec<Expr> {
        // by corner of the face ξ_along = -1 as far as it is known, from what stands at samples
        let mut parts: Vec<(usize, [f64; 3], Expr)> = merged(
            graph,
            samples.iter().map(|(xi, value)| {
                let mut across = *xi;
                across[along] = 0.0;
                (0, across, *value)
            }),
        );
        for (step, axis) in self.across(along).enumerate().collect::<Vec<_>>().into_iter().rev() {
            let weighted: Vec<_> = parts
                .into_iter()
                .flat_map(|(corner, xi, value)| {
                    let mut rest = xi;
                    rest[axis] = 0.0;
                    let weights = weights(xi[axis], step);
                    [
                        (corner, rest, graph.times_number(weights[0], value)),
                        (corner | 1 << axis, rest, graph.times_number(weights[1], value)),
                    ]
                })
                .collect();
            parts = merged(graph, weighted.into_iter());
        }
        let mut of_nodes = vec![graph.number(0.0); self.nodes.len()];
        for (corner, _, value) in parts {
            of_nodes[self.nodes[corner]] = graph.negate(value);
            of_nodes[self.nodes[corner | 1 << along]] = value;
        }
        of_nodes
    }
}

/// Shares of two faces at `ξ`; half of them on the first axis, for `ξ` runs over a length of two.
fn weights(xi: f64, step: usize) -> [f64; 2] {
    let share = if step == 0 { 0.25 } else { 0.5 };
    [share * (1.0 - xi), share * (1.0 + xi)]
}

/// Sums of what has one corner and one place, in the order in which they come.
fn merged(
    graph: &mut Graph,
    parts: impl Iterator<Item = (usize, [f64; 3], Expr)>,
) -> Vec<(usize, [f64; 3], Expr)> {
    let mut groups: Vec<(usize, [f64; 3], Vec<Expr>)> = Vec::new();
    for (corner, xi, value) in parts {
        match groups.iter_mut().find(|(other, at, _)| *other == corner && *at == xi) {
            Some((_, _, values)) => values.push(value),
            None => groups.push((corner, xi, vec![value])),
        }
    }
    groups.into_iter().map(|(corner, xi, values)| (corner, xi, graph.sum(&values))).collect()
}

/// Whether a node is at the high end of an axis: the shape function of a corner rises towards it.
pub(super) fn is_high(element: &ElementData, node: usize, axis: usize) -> bool {
    let shape = &element.shapes[node];
    let slope = shape.iter().find(|(_, powers)| (0..4).all(|k| powers[k] == u8::from(k == axis)));
    slope.is_some_and(|(coefficient, _)| *coefficient > 0.0)
}
