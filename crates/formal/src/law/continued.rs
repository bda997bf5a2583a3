//! Laws that go on where their formula ends: for flat and inverted elements.

#![allow(non_snake_case)]

use std::collections::HashMap;

use super::EnergyLaw;
use crate::Function;
use crate::graph::{Comparison, Expr, Graph, Node};

/// The ratio of volumes below which `J` in powers that are not whole and positive goes on as a positive function that vanishes
/// towards minus infinity, and `ln J` as a parabola.
pub const SMALLEST_VOLUME: f64 = 0.05;

impl EnergyLaw {
    /// The law with `m(J)` for `J = det F` in powers that are not whole and positive: `m = J` down to [`SMALLEST_VOLUME`] `J₀`, and below
    /// `m = J₀ (1 - x)/(1 - 2x + 2x²)` with `x = J/J₀ - 1`, whose value, slope and curvature are those of `J` at `J₀`; and with
    /// `ln J₀ + x - x²/2` for `ln J` below `J₀`, its Taylor polynomial of degree two. So energy, stress and tangent stay continuous, and
    /// inverted elements are pushed back.
    pub fn continued(&self) -> Self {
        let mut law = self.clone();
        let J = {
            let deformation = law.deformation;
            law.graph.determinant(deformation)
        };
        let m = bounded(&mut law.graph, J);
        let of_volume: Vec<Expr> = law.graph.reachable(&[law.energy]);
        let mut replacements = HashMap::new();
        for expr in of_volume {
            let replacement = match *law.graph.node(expr) {
                Node::Power(base, exponent) if base == J && has_pole(&law.graph, exponent) => {
                    law.graph.power(m, exponent)
                }
                Node::Function(function @ (Function::Ln | Function::Log10), argument) if argument == J => {
                    logarithm(&mut law.graph, J, function)
                }
                _ => continue,
            };
            replacements.insert(expr, replacement);
        }
        law.energy = law.graph.substitute(law.energy, &replacements);
        law.derive();
        law
    }
}

/// Whether `J` to this power has no value, or no slope, where `J` is zero or less.
fn has_pole(graph: &Graph, exponent: Expr) -> bool {
    graph.value(exponent).is_none_or(|exponent| exponent < 0.0 || exponent.fract() != 0.0)
}

/// The logarithm of `J` with its Taylor polynomial of degree two below the least volume.
fn logarithm(graph: &mut Graph, J: Expr, function: Function) -> Expr {
    let (least, minus_one) = (graph.number(SMALLEST_VOLUME), graph.number(-1.0));
    let is_below = graph.compare(Comparison::Less, J, least);
    let ratio = graph.times_number(1.0 / SMALLEST_VOLUME, J);
    let x = graph.sum(&[ratio, minus_one]);
    let square = graph.power_number(x, 2.0);
    let curved = graph.times_number(-0.5, square);
    let natural = graph.number(libm::log(SMALLEST_VOLUME));
    let mut polynomial = graph.sum(&[natural, x, curved]);
    if function == Function::Log10 {
        polynomial = graph.times_number(std::f64::consts::LOG10_E, polynomial);
    }
    let above = graph.function(function, J);
    graph.select(is_below, polynomial, above)
}

/// `m(J)`.
fn bounded(graph: &mut Graph, J: Expr) -> Expr {
    let [one, two, least] = [1.0, 2.0, SMALLEST_VOLUME].map(|value| graph.number(value));
    let is_below = graph.compare(Comparison::Less, J, least);
    let ratio = graph.times_number(1.0 / SMALLEST_VOLUME, J);
    let x = graph.subtract(ratio, one);
    let above = graph.subtract(one, x);
    // 1 - 2x + 2x²: at least a half
    let square = graph.power_number(x, 2.0);
    let difference = graph.subtract(square, x);
    let twice = graph.times(two, difference);
    let below = graph.add(one, twice);
    let fraction = graph.divide(above, below);
    let continued = graph.times(least, fraction);
    graph.select(is_below, continued, J)
}
