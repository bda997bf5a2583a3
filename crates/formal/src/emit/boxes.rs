//! What boxes along the axes have for themselves: columns from modes of their corners, and laws of `C = FᵀF` alone.
//!
//! A hexahedron of eight samples `(±g, ±g, ±g)`: sums and differences of its corners along each axis, of which three axes have seven in
//! common, give the columns `∂x/∂X_i`, each a bilinear function of the other two coordinates, at `±g` of these. Forces go back by
//! minus the transpose.

use std::fmt::Write;

use super::fused::SAME;
use crate::element::{ElementData, RestMap};

/// Columns in the order of [`Corners::columns`], and what each sample has of them.
pub(super) struct Corners {
    /// Nodes by their places: bit `a` is set where coordinate `a` is 1.
    nodes: [usize; 8],
    /// `g`.
    at: f64,
}

/// Coordinates in letters: at -1 and at 1, then the difference and the sum of both.
const LETTERS: [char; 4] = ['m', 'p', 'd', 's'];

/// The other two axes.
fn others(axis: usize) -> [usize; 2] {
    [[1, 2], [0, 2], [0, 1]][axis]
}

impl Corners {
    /// Those of a box with a node in each corner and eight samples that are alike; `None`: it is another element.
    pub fn of(element: &ElementData) -> Option<Self> {
        let is_box = matches!(element.map, RestMap::Box { .. });
        if !is_box || element.dimension != 3 || element.node_count != 8 || element.samples.len() != 8 {
            return None;
        }
        let at = element.samples[0].position[0].abs();
        let is_at = |coordinate: &f64| (coordinate.abs() - at).abs() < SAME;
        let mut nodes = [None; 8];
        for (node, gradient) in element.samples[0].gradients.iter().enumerate() {
            nodes[bits(gradient)] = Some(node);
        }
        let nodes = nodes.into_iter().collect::<Option<Vec<usize>>>()?.try_into().ok()?;
        let corners = Self { nodes, at };
        let is_bilinear = element.samples.iter().all(|sample| {
            let places = 0..8;
            sample.position.iter().all(is_at)
                && places.into_iter().all(|place| {
                    let expected = corners.gradient(place, &sample.position);
                    let found = sample.gradients[corners.nodes[place]];
                    expected.iter().zip(found).all(|(a, b)| (a - b).abs() < SAME)
                })
        });
        is_bilinear.then_some(corners)
    }

    /// `∂N/∂ξ` of the node in a corner.
    fn gradient(&self, place: usize, position: &[f64; 3]) -> [f64; 3] {
        let sign = |axis: usize| if place & (1 << axis) == 0 { -1.0 } else { 1.0 };
        [0, 1, 2].map(|axis| {
            let [a, b] = others(axis).map(|other| 1.0 + sign(other) * position[other]);
            sign(axis) * a * b / 8.0
        })
    }

    /// Columns of a sample: of each axis four, with the first of the other two coordinates running faster.
    pub fn of_sample(position: &[f64; 3]) -> [usize; 3] {
        let sample = bits(position);
        [0, 1, 2].map(|axis| {
            let [a, b] = others(axis).map(|other| sample >> other & 1);
            4 * axis + a + 2 * b
        })
    }

    /// The weights of modes that are no, one and two coordinates.
    pub fn weights(&self) -> [f64; 3] {
        [1.0, self.at, self.at * self.at].map(|power| power / 8.0)
    }

    /// The four modes of an axis: its difference with sums and differences along the others.
    fn modes(axis: usize) -> [String; 4] {
        [[false, false], [true, false], [false, true], [true, true]].map(|is_difference| {
            let mut letters = ['d'; 3];
            for (other, is_difference) in others(axis).into_iter().zip(is_difference) {
                letters[other] = if is_difference { 'd' } else { 's' };
            }
            letters.iter().collect()
        })
    }

    /// The body of `columns`.
    pub fn columns(&self) -> String {
        let mut out = String::new();
        for axis in 0..3 {
            for [low, high, difference, sum] in stage(axis) {
                let [low, high] = [low, high].map(|letters| self.corner(&letters));
                let _ = writeln!(out, "    let {difference} = {high} - {low};");
                if sum != "sss" {
                    let _ = writeln!(out, "    let {sum} = {high} + {low};");
                }
            }
        }
        for (axis, name) in ["xi", "eta", "zeta"].into_iter().enumerate() {
            let _ =
                writeln!(out, "    let {name} = bilinear([{}], &K[{axis}]);", Self::modes(axis).join(", "));
        }
        let columns = ["xi", "eta", "zeta"]
            .map(|name| [0, 1, 2, 3].map(|index| format!("{name}[{index}]")).join(", "))
            .join(",\n        ");
        let _ = writeln!(out, "    [\n        {columns},\n    ]");
        out
    }

    /// The body of `to_nodes`.
    pub fn to_nodes(&self) -> String {
        let mut out = String::new();
        let mut terms: Vec<(String, Vec<String>)> = Vec::new();
        for (axis, name) in ["xi", "eta", "zeta"].into_iter().enumerate() {
            let columns = [0, 1, 2, 3].map(|index| format!("s[{}]", 4 * axis + index)).join(", ");
            let _ = writeln!(out, "    let {name} = forces_of_modes([{columns}], &K[{axis}]);");
            for (index, mode) in Self::modes(axis).into_iter().enumerate() {
                let term = format!("{name}[{index}]");
                match terms.iter_mut().find(|(known, _)| *known == mode) {
                    Some((_, of_mode)) => of_mode.push(term),
                    None => terms.push((mode, vec![term])),
                }
            }
        }
        for (mode, of_mode) in terms {
            let _ = writeln!(out, "    let {mode} = {};", of_mode.join(" + "));
        }
        for axis in (0..3).rev() {
            for [low, high, difference, sum] in stage(axis) {
                // nothing moves together
                let (below, above) = if sum == "sss" {
                    (format!("-{difference}"), difference)
                } else {
                    (format!("{sum} - {difference}"), format!("{sum} + {difference}"))
                };
                let _ = writeln!(out, "    let {low} = {below};\n    let {high} = {above};");
            }
        }
        let mut of_node = vec![String::new(); 8];
        for place in 0..8 {
            of_node[self.nodes[place]] = letters_of(place);
        }
        let _ = writeln!(out, "    [{}]", of_node.join(", "));
        out
    }

    /// A node where all three coordinates are of a corner.
    fn corner(&self, letters: &str) -> String {
        let place = (0..8).find(|place| letters_of(*place) == letters);
        place.map_or_else(|| letters.to_owned(), |place| format!("x[{}]", self.nodes[place]))
    }
}

/// Which coordinates are positive.
fn bits(coordinates: &[f64; 3]) -> usize {
    (0..3).filter(|axis| coordinates[*axis] > 0.0).map(|axis| 1 << axis).sum()
}

fn letters_of(place: usize) -> String {
    (0..3).map(|axis| LETTERS[place >> axis & 1]).collect()
}

/// Pairs of what lies at -1 and at 1 of an axis, where earlier axes are sums and differences, with the difference and sum of each.
fn stage(axis: usize) -> Vec<[String; 4]> {
    let letter = |at: usize, index: usize, own: char| {
        let bit = index >> usize::from(at == others(axis)[1]) & 1;
        match at {
            at if at == axis => own,
            at if at < axis => LETTERS[2 + bit],
            _ => LETTERS[bit],
        }
    };
    let of_others = |index: usize| LETTERS.map(|own| (0..3).map(|at| letter(at, index, own)).collect());
    (0..4).map(of_others).collect()
}
