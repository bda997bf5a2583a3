//! What is legal physics and often not what was meant.

#![allow(non_snake_case)]

use souple_math::{Mat3, Vec3, eigen_symmetric};

use super::{directions, identity, unit};
use crate::Function;
use crate::graph::{Expr, Node};
use crate::law::EnergyLaw;
use crate::law::evaluate::entries;

/// Warnings about a law that is one.
pub(super) fn doubts(law: &EnergyLaw) -> Vec<String> {
    let mut doubts = Vec::new();
    let largest = largest_stiffness(law);
    let (shear, volume) = (least_shear(law), law.bulk_modulus());
    if volume < -1e-9 * largest || shear < -1e-9 * largest {
        doubts.push("at rest the stiffness is negative: the body leaves its rest shape by itself");
    } else if volume <= 1e-9 * largest {
        doubts.push("nothing resists a change of volume at rest");
    } else if shear <= 1e-9 * largest {
        doubts.push("some shear or stretch meets no resistance at rest");
    }
    let along = |s: f64| law.energy_at(&diagonal(Vec3::new(s, 1.0, 1.0)));
    if !along(-0.5).is_finite() {
        doubts.push("inverted elements have no energy: a step that inverts one is refused");
    } else if along(-1.0).abs() < 1e-9 * largest {
        doubts.push("an element turned inside out is at rest too: nothing turns it back");
    } else if along(1e-9) < 2.0 * largest {
        doubts.push("an element can be crushed flat at little cost");
    }
    let found = [stiffness_jump(law), jump(law), end(law)].into_iter().flatten();
    doubts.into_iter().map(str::to_owned).chain(found).collect()
}

fn diagonal(stretches: Vec3) -> Mat3 {
    Mat3::from_columns(Vec3::X * stretches.x, Vec3::Y * stretches.y, Vec3::Z * stretches.z)
}

fn largest_stiffness(law: &EnergyLaw) -> f64 {
    law.stiffness.iter().fold(0.0, |a: f64, b| a.max(b.abs()))
}

/// How far from rest one side is looked at: farther than roundings of strains, and so near that a smooth stiffness is that at rest.
const ASIDE: f64 = 1e-9;
/// A change of the stiffness from one side of rest to the other that is no rounding, next to the greatest stiffness.
const STIFFNESS_JUMP: f64 = 1e-3;

/// Where the stiffness on one side of rest is another than on the opposite one, as that of `max(J - 1, 0)^2`: what is told of the
/// body at rest holds for one of them.
fn stiffness_jump(law: &EnergyLaw) -> Option<String> {
    let ways = ["deformed", "deformed", "stretched along x", "stretched along y", "swollen"];
    directions().into_iter().zip(ways).rev().find_map(|(direction, way)| {
        let [before, after] = [-ASIDE, ASIDE].map(|step| {
            let dP = law.differential_at(&(identity() + direction * step), &direction);
            dP.dot(&direction) / direction.dot(&direction)
        });
        let largest = largest_stiffness(law).max(before.abs()).max(after.abs());
        ((after - before).abs() > STIFFNESS_JUMP * largest).then(|| {
            format!(
                "the stiffness at rest jumps from {before:.3e} to {after:.3e} Pa where a cube begins to be {way}: natural \
                 frequencies, stable steps and moduli at rest are told for one side"
            )
        })
    })
}

/// Stretches along which jumps and ends are looked for, and how finely.
const STRETCHES: [f64; 2] = [0.2, 3.0];
const LOOKS: usize = 96;
/// Halvings that leave two neighbouring numbers of one look.
const TO_NEIGHBOURS: usize = 52;
/// A change between neighbours that is no rounding, next to the numbers at both.
const JUMP: f64 = 1e-6;
/// The same, next to the stiffness at rest: where both numbers are small they are roundings.
const LEAST_JUMP: f64 = 1e-9;

type Way = (&'static str, fn(f64) -> Vec3);
const WAYS: [Way; 2] =
    [("pulled along x", |s| Vec3::new(s, 1.0, 1.0)), ("stretched in all directions", |s| Vec3::new(s, s, s))];

fn look(number: usize) -> f64 {
    STRETCHES[0] + (STRETCHES[1] - STRETCHES[0]) * number as f64 / (LOOKS - 1) as f64
}

/// The two neighbours between `low` and `high` where what is true at `low` ceases to be.
fn border(mut low: f64, mut high: f64, is_as_low: impl Fn(f64) -> bool) -> [f64; 2] {
    for _ in 0..TO_NEIGHBOURS {
        let middle = 0.5 * (low + high);
        if is_as_low(middle) { low = middle } else { high = middle }
    }
    [low, high]
}

/// Where an energy that is made of pieces, or its stress, is not continuous.
fn jump(law: &EnergyLaw) -> Option<String> {
    let switches: Vec<Expr> =
        law.graph.reachable(&[law.energy]).into_iter().filter(|expr| is_of_pieces(law, *expr)).collect();
    if switches.is_empty() {
        return None;
    }
    WAYS.into_iter().find_map(|(way, stretches)| {
        let F = |s: f64| diagonal(stretches(s));
        // which piece of each is the one in force
        let pieces = |s: f64| -> Vec<f64> {
            let values = law.evaluate(&[law.energy], &F(s), &Mat3::ZERO);
            let piece = |expr: &Expr| match law.graph.node(*expr) {
                Node::Function(Function::Abs, argument) => {
                    f64::from(u8::from(values.scalar(*argument) < 0.0))
                }
                _ => values.scalar(*expr),
            };
            switches.iter().map(piece).collect()
        };
        (1..LOOKS).find_map(|number| {
            let (mut low, high) = (look(number - 1), look(number));
            let last = pieces(high);
            loop {
                let of_low = pieces(low);
                if of_low == last {
                    return None;
                }
                let [below, above] = border(low, high, |s| pieces(s) == of_low);
                if let Some(what) = jump_between(law, &F(below), &F(above)) {
                    let place = format!("where a cube is {way} to {above:.4} of its length");
                    return Some(format!("{what} {place}: what passes there gains or loses it"));
                }
                low = above;
            }
        })
    })
}

fn is_of_pieces(law: &EnergyLaw, expr: Expr) -> bool {
    match law.graph.node(expr) {
        Node::Compare(..) => true,
        Node::Function(function, _) => matches!(
            function,
            Function::Abs | Function::Floor | Function::Ceil | Function::Sign | Function::Step
        ),
        _ => false,
    }
}

/// What of a law jumps between two deformations beside each other.
fn jump_between(law: &EnergyLaw, below: &Mat3, above: &Mat3) -> Option<String> {
    let rounding = LEAST_JUMP * largest_stiffness(law);
    let jumps = |change: f64, size: f64| change > JUMP * size && change > rounding;
    let energies = [below, above].map(|F| law.energy_at(F));
    let change = (energies[1] - energies[0]).abs();
    if jumps(change, energies[0].abs().max(energies[1].abs())) {
        return Some(format!("the energy jumps by {change:.3e} J/m³"));
    }
    let stresses = [below, above].map(|F| law.stress_at(F));
    let change = (stresses[1] - stresses[0]).largest_entry();
    jumps(change, stresses[0].largest_entry().max(stresses[1].largest_entry()))
        .then(|| format!("the stress jumps by {change:.3e} Pa"))
}

/// Where a law that has a value at rest has none any more, of elements that are not inverted.
fn end(law: &EnergyLaw) -> Option<String> {
    WAYS.into_iter().find_map(|(way, stretches)| {
        let has_value = |s: f64| law.energy_at(&diagonal(stretches(s))).is_finite();
        let place = |found: Option<f64>| found.map(|without| border(1.0, without, has_value)[0]);
        let is_end = |s: &f64| !has_value(*s);
        let beyond = place((0..LOOKS).map(look).filter(|s| *s > 1.0).find(is_end)).map(|end| ("beyond", end));
        let below = || place((0..LOOKS).map(look).rev().filter(|s| *s < 1.0).find(is_end));
        let (side, end) = beyond.or_else(|| below().map(|end| ("below", end)))?;
        Some(format!(
            "the energy has no finite value where a cube is {way} {side} {end:.4} of its length: a step that leads there is refused"
        ))
    })
}

/// The least stiffness at rest against shears and stretches without change of volume [Pa].
fn least_shear(law: &EnergyLaw) -> f64 {
    // two bases of three of the five-dimensional space: their least eigenvalues bound that of laws with symmetry axes
    let s = 0.5f64.sqrt();
    let shears = [(3, 1), (6, 2), (7, 5)].map(|(a, b)| (unit(a) + unit(b)) * s);
    let stretches = [(0, 4), (4, 8), (8, 0)].map(|(a, b)| (unit(a) - unit(b)) * s);
    let least = |basis: &[Mat3; 3]| {
        let row = |i: usize| {
            let numbers = [0, 1, 2].map(|j| contract(law, &basis[i], &basis[j]));
            Vec3::from_array(numbers)
        };
        eigen_symmetric(&Mat3::from_columns(row(0), row(1), row(2))).values
    };
    // the three stretches sum to zero: one eigenvalue of theirs is zero by construction, the next one counts
    let (of_shears, of_stretches) = (least(&shears), least(&stretches));
    of_shears.z.min(if of_stretches.z.abs() < of_stretches.y.abs() { of_stretches.y } else { of_stretches.z })
}

fn contract(law: &EnergyLaw, a: &Mat3, b: &Mat3) -> f64 {
    let (a, b) = (entries(a), entries(b));
    (0..81).map(|i| a[i / 9] * law.stiffness[i] * b[i % 9]).sum()
}
