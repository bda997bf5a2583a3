//! The same differential derived in physical coordinates, as it is without a reference element: the shape functions of a box are
//! products of quotients of rest positions, and every gradient brings its own nodes along. What EXP-1 measures the reference
//! frame against.

use std::collections::HashMap;

use super::derive::{Symbols, WEIGHT, terms};
use super::separable::is_high;
use super::{Cut, ElementData, RestMap};
use crate::graph::{Expr, Graph};
use crate::law::EnergyLaw;

/// A differential in physical coordinates.
#[derive(Clone, Debug)]
pub struct Direct {
    pub graph: Graph,
    /// By node and direction.
    pub differential: Vec<Expr>,
}

impl Direct {
    /// Operands of the expressions written out.
    pub fn operands(&self) -> f64 {
        self.graph.operands_written_out(&self.differential, |_| false)
    }
}

/// The box of an element: its corners' nodes, and on which side of each axis a node lies.
struct BoxShape<'a> {
    element: &'a ElementData,
    low: &'a [Expr],
    high: &'a [Expr],
}

/// `None` where the element is no box with one node in each corner.
pub(super) fn derive(element: &ElementData, law: &EnergyLaw) -> Option<Direct> {
    let RestMap::Box { low, high } = element.map else { return None };
    if element.node_count != 1 << element.dimension {
        return None;
    }
    let mut graph = law.graph.clone();
    let symbols = Symbols::new(&mut graph, element, law);
    let shape = BoxShape { element, low: &symbols.rest[low], high: &symbols.rest[high] };
    Some(differential(graph, &shape, &symbols, law))
}

fn differential(mut graph: Graph, shape: &BoxShape, symbols: &Symbols, law: &EnergyLaw) -> Direct {
    let dimension = shape.element.dimension;
    let terms = terms(&mut graph, law, Cut::NONE);
    let mut addends: Vec<Vec<Expr>> = vec![Vec::new(); shape.element.node_count * dimension];
    for sample in &shape.element.samples {
        let gradients: Vec<Vec<Expr>> = (0..shape.element.node_count)
            .map(|node| shape.gradient(&mut graph, node, &sample.position))
            .collect();
        let rate = |graph: &mut Graph, values: &[Vec<Expr>]| -> Vec<Expr> {
            (0..9)
                .map(|index| {
                    let (row, column) = (index % 3, index / 3);
                    let inside = row < dimension && column < dimension;
                    let nodes = if inside { 0..values.len() } else { 0..0 };
                    let products: Vec<Expr> =
                        nodes.map(|n| graph.product(&[values[n][row], gradients[n][column]])).collect();
                    graph.sum(&products)
                })
                .collect()
        };
        let mut deformation = rate(&mut graph, &symbols.displacements);
        let variation = rate(&mut graph, &symbols.variations);
        let one = graph.number(1.0);
        for diagonal in [0, 4, 8] {
            deformation[diagonal] = graph.sum(&[deformation[diagonal], one]);
        }
        let weight = shape.weight(&mut graph, sample.weight);
        let symbol = graph.own_symbol(WEIGHT);
        let mut given = HashMap::from([
            (symbol, vec![weight]),
            (law.deformation, deformation),
            (law.variation, variation),
        ]);
        given.extend(symbols.directions.iter().cloned());
        for term in &terms {
            let stress = graph.components(term.differential, &given);
            for (index, list) in addends.iter_mut().enumerate() {
                let (node, row) = (index / dimension, index % dimension);
                for column in 0..dimension {
                    let product = graph.product(&[stress[3 * column + row], gradients[node][column]]);
                    list.push(graph.negate(product));
                }
            }
        }
    }
    let differential = addends.iter().map(|addends| graph.sum(addends)).collect();
    Direct { graph, differential }
}

impl BoxShape<'_> {
    /// `∂Λ_n/∂x` at the sample `ξ` with `Λ_n = Π (x - x_other)/(x_n - x_other)`.
    fn gradient(&self, graph: &mut Graph, node: usize, xi: &[f64; 3]) -> Vec<Expr> {
        let mut factors = Vec::new();
        for axis in 0..self.element.dimension {
            let (low, high) = (self.low[axis], self.high[axis]);
            let (own, other) = if is_high(self.element, node, axis) { (high, low) } else { (low, high) };
            let (sum, span) = (graph.add(low, high), graph.subtract(high, low));
            let (middle, step) = (graph.times_number(0.5, sum), graph.times_number(0.5 * xi[axis], span));
            let at = graph.add(middle, step);
            let (above, below) = (graph.subtract(at, other), graph.subtract(own, other));
            let one = graph.number(1.0);
            factors.push((graph.divide(above, below), graph.divide(one, below)));
        }
        (0..factors.len())
            .map(|along| {
                let product: Vec<Expr> = factors
                    .iter()
                    .enumerate()
                    .map(|(axis, (value, slope))| if axis == along { *slope } else { *value })
                    .collect();
                graph.product(&product)
            })
            .collect()
    }

    /// The weight of a sample times the share of the box that reference coordinates from -1 to 1 stand for.
    fn weight(&self, graph: &mut Graph, weight: f64) -> Expr {
        let spans: Vec<Expr> =
            self.high.iter().zip(self.low).map(|(high, low)| graph.subtract(*high, *low)).collect();
        let volume = graph.product(&spans);
        graph.times_number(weight / f64::from(1u32 << spans.len()), volume)
    }
}
