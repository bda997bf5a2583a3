//! What is legal physics and often not what was meant.

#![allow(non_snake_case)]

use souple_math::{Mat3, Vec3, eigen_symmetric};

use super::{directions, identity, unit};
use crate::Function;
use crate::graph::{Expr, Node};
use crate::law::evaluate::entries;
use crate::law::{EnergyLaw, bulk_modulus};

/// Warnings about a law that is one.
pub(super) fn doubts(law: &EnergyLaw) -> Vec<String> {
    let mut doubts = Vec::new();
    let largest = largest_stiffness(law);
    let (shear, volume) = (least_shear(law), bulk_modulus(&law.stiffness));
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
    let of_way = |(direction, way): (Mat3, &'static str)| {
        let stiffness = [-ASIDE, ASIDE].map(|step| {
            let dP = law.differential_at(&(identity() + direction * step), &direction);
            dP.dot(&direction) / direction.dot(&direction)
        });
        (way, stiffness)
    };
    let change = |(_, [before, after]): &(&str, [f64; 2])| (after - before).abs();
    // told of the way along which it jumps most: that of a fibre, not of what lies beside it
    let (way, [before, after]) =
        directions().into_iter().zip(ways).map(of_way).max_by(|a, b| change(a).total_cmp(&change(b)))?;
    let largest = largest_stiffness(law).max(before.abs()).max(after.abs());
    // what is left of nothing by rounding is nothing
    let [before, after] =
        [before, after].map(|stiffness| if stiffness.abs() < ASIDE * largest { 0.0 } else { stiffness });
    ((after - before).abs() > STIFFNESS_JUMP * largest).then(|| {
        format!(
            "the stiffness at rest jumps from {before:.3e} to {after:.3e} Pa where a cube begins to be {way}: natural \
             frequencies, stable steps and moduli at rest are told for one side"
        )
    })
}

/// How many places are looked at along each way.
const LOOKS: usize = 160;
/// Halvings that leave two neighbouring numbers of one look.
const TO_NEIGHBOURS: usize = 54;
/// A change between neighbours that is no rounding, next to the numbers at both.
const JUMP: f64 = 1e-6;
/// The same, next to the stiffness at rest: where both numbers are small they are roundings.
const LEAST_JUMP: f64 = 1e-9;
/// Stretches beyond which an energy that overflows is no news: exponentials of tissue are made for less.
const FAR: f64 = 3.0;

/// A way to deform a cube, with the ends of what is looked at and where on it the cube is at rest.
struct Way {
    /// How the cube is deformed at a place, in words.
    says: fn(f64) -> String,
    deformation: fn(f64) -> Mat3,
    ends: [f64; 2],
    rest: f64,
}

const WAYS: [Way; 3] = [
    Way {
        says: |s| format!("pulled along x to {s:.4} of its length"),
        deformation: |s| diagonal(Vec3::new(s, 1.0, 1.0)),
        ends: [0.2, 10.0],
        rest: 1.0,
    },
    Way {
        says: |s| format!("stretched in all directions to {s:.4} of its length"),
        deformation: |s| diagonal(Vec3::new(s, s, s)),
        ends: [0.2, 10.0],
        rest: 1.0,
    },
    Way {
        says: |s| format!("sheared by {s:.4}"),
        deformation: |s| identity() + unit(3) * s,
        ends: [-3.0, 3.0],
        rest: 0.0,
    },
];

impl Way {
    /// Places, closer to each other where a cube is small.
    fn look(&self, number: usize) -> f64 {
        let [low, high] = self.ends;
        let part = number as f64 / (LOOKS - 1) as f64;
        if low > 0.0 { low * (high / low).powf(part) } else { low + (high - low) * part }
    }
}

/// The two neighbours between `low` and `high` where what is true at `low` ceases to be.
fn border(mut low: f64, mut high: f64, is_as_low: impl Fn(f64) -> bool) -> [f64; 2] {
    for _ in 0..TO_NEIGHBOURS {
        let middle = 0.5 * (low + high);
        if is_as_low(middle) { low = middle } else { high = middle }
    }
    [low, high]
}

/// Where an energy that is made of pieces, or its stress, is not continuous, or has a pole.
fn jump(law: &EnergyLaw) -> Option<String> {
    let switches: Vec<Expr> =
        law.graph.reachable(&[law.energy]).into_iter().filter(|expr| is_of_pieces(law, *expr)).collect();
    if switches.is_empty() {
        return None;
    }
    WAYS.iter().find_map(|way| {
        let F = way.deformation;
        // which piece of each is the one in force
        let pieces = |s: f64| -> Vec<i8> {
            let values = law.evaluate(&[law.energy], &F(s), &Mat3::ZERO);
            switches.iter().map(|expr| piece(law, *expr, |operand| values.scalar(operand))).collect()
        };
        (1..LOOKS).find_map(|number| {
            let (mut low, high) = (way.look(number - 1), way.look(number));
            let last = pieces(high);
            loop {
                let of_low = pieces(low);
                if of_low == last {
                    return None;
                }
                let [below, above] = border(low, high, |s| pieces(s) == of_low);
                if let Some(what) = jump_between(law, &F(below), &F(above)) {
                    let place = (way.says)(above);
                    return Some(format!(
                        "{what} where a cube is {place}: what passes there gains or loses it"
                    ));
                }
                low = above;
            }
        })
    })
}

/// The piece of an expression that is in force: a sign, or a number of a step.
fn piece(law: &EnergyLaw, expr: Expr, value: impl Fn(Expr) -> f64) -> i8 {
    let side = |number: f64| i8::from(number < 0.0);
    match law.graph.node(expr) {
        Node::Function(Function::Abs, argument) => side(value(*argument)),
        Node::Function(Function::Tan, argument) => side(value(*argument).cos()),
        // at zero itself is the pole
        Node::Power(base, _) => value(*base).partial_cmp(&0.0).map_or(0, |order| order as i8),
        // steps follow each other: neighbours differ
        _ => (value(expr).rem_euclid(64.0)) as i8,
    }
}

fn is_of_pieces(law: &EnergyLaw, expr: Expr) -> bool {
    match law.graph.node(expr) {
        Node::Compare(..) => true,
        // a pole where its base is zero
        Node::Power(_, exponent) => law.graph.value(*exponent).is_some_and(|exponent| exponent < 0.0),
        Node::Function(function, _) => matches!(
            function,
            Function::Abs
                | Function::Floor
                | Function::Ceil
                | Function::Sign
                | Function::Step
                | Function::Tan
        ),
        _ => false,
    }
}

/// What of a law jumps between two deformations beside each other.
fn jump_between(law: &EnergyLaw, below: &Mat3, above: &Mat3) -> Option<String> {
    let rounding = LEAST_JUMP * largest_stiffness(law);
    let jumps = |change: f64, size: f64| change > JUMP * size && change > rounding;
    let energies = [below, above].map(|F| law.energy_at(F));
    let most = largest_stiffness(law) / f64::EPSILON.sqrt();
    if energies.iter().any(|energy| energy.is_nan() || energy.abs() >= most) {
        return energies[0].is_finite().then(|| "the energy has a pole".to_owned());
    }
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
    WAYS.iter().find_map(|way| {
        let has_value = |s: f64| {
            let energy = law.energy_at(&(way.deformation)(s));
            energy.is_finite() || (energy.is_infinite() && s > FAR)
        };
        let place = |found: Option<f64>| found.map(|without| border(way.rest, without, has_value)[0]);
        let is_end = |s: &f64| !has_value(*s);
        let looks = || (0..LOOKS).map(|number| way.look(number));
        let beyond = place(looks().filter(|s| *s > way.rest).find(is_end));
        let end = beyond.or_else(|| place(looks().rev().filter(|s| *s < way.rest).find(is_end)))?;
        let place = (way.says)(end);
        Some(format!(
            "the energy has no finite value beyond a cube that is {place}: a step that leads there is refused"
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
