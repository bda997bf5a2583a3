//! What a law must be at rest: energy without a stress, and a stiffness.

#![allow(non_snake_case)]

use souple_math::{Mat3, Vec3, exponential};

use super::{at, deformations, directions, identity, unit, whole};
use crate::graph::{Evaluation, Expr, Node};
use crate::law::evaluate::entries;
use crate::law::read::Read;
use crate::law::{EnergyLaw, LawError, LawParameter, LawProblem};
use crate::{Function, Span};

/// Stress at rest beside the stiffness: what rounding of a hundred operations leaves, far below any physics.
const STRESS_AT_REST: f64 = 1e-9;

/// Rotation vectors [rad].
const TURNS: [[f64; 3]; 8] = [
    [0.4, -1.1, 0.8],
    [2.0, 0.5, -0.3],
    [0.1, 0.0, 0.0],
    [0.0, 1.3, 0.0],
    [0.0, 0.0, -0.7],
    [-0.9, 0.2, 1.7],
    [1.0, 1.0, 0.6],
    [-0.3, -0.5, 0.25],
];

/// How much smaller and larger than moderate ones deformations are tried too.
const SCALES: [f64; 3] = [1.0, 1e-3, 20.0];

/// Some deformation makes a stress. What rounding leaves of zero is another number a millionth beside it; a stress is the same.
pub(super) fn resistance(law: &EnergyLaw, read: &Read) -> Result<(), LawError> {
    let tried =
        deformations().into_iter().flat_map(|F| SCALES.map(|scale| identity() + (F - identity()) * scale));
    let resists = |F: Mat3| {
        let here = law.stress_at(&F);
        let is_steady = |direction: Mat3| {
            let beside = law.stress_at(&(F + direction * 1e-6));
            (beside - here).largest_entry() < 0.1 * here.largest_entry()
        };
        entries(&here).iter().any(|entry| entry.is_infinite()) || directions().into_iter().all(is_steady)
    };
    if tried.into_iter().any(resists) { Ok(()) } else { Err(no_stress(law, read)) }
}

pub(super) fn no_stress(law: &EnergyLaw, read: &Read) -> LawError {
    let is_zero = |(name, parameter): &(String, LawParameter)| {
        let is_used = read.used.contains(name);
        (is_used && parameter.numbers() == [0.0]).then(|| name.clone())
    };
    let zeros = law.parameters.iter().filter_map(is_zero).collect();
    at(read, read.energy, LawProblem::NoStress { zeros })
}

/// The energy has a value at rest, which becomes zero; an offset has no physics.
pub(super) fn value(law: &mut EnergyLaw, read: &Read) -> Result<(), LawError> {
    finite_at(law, read, &identity())?;
    let offset = law.evaluate(&[law.energy], &identity(), &Mat3::ZERO).scalar(law.energy);
    if offset != 0.0 {
        let minus = law.graph.number(-offset);
        law.energy = law.graph.sum(&[law.energy, minus]);
    }
    Ok(())
}

/// Turned bodies are at rest as well, where what is zero by formula is a rounding, above or below.
pub(super) fn values_where_turned(law: &EnergyLaw, read: &Read) -> Result<(), LawError> {
    TURNS.iter().try_for_each(|turn| finite_at(law, read, &exponential(Vec3::from_array(*turn))))
}

fn finite_at(law: &EnergyLaw, read: &Read, F: &Mat3) -> Result<(), LawError> {
    let values = law.evaluate(&[law.energy], F, &Mat3::ZERO);
    for expr in law.graph.reachable(&[law.energy]) {
        if let Some(bad) = values.of(expr).iter().find(|number| !number.is_finite()) {
            let reason = reason(law, &values, expr, *bad);
            // the innermost part that was written: parts of it that the reader made itself have no place
            let named = law.graph.reachable(&[law.energy]).into_iter().find(|outer| {
                read.origins.contains_key(outer)
                    && *outer >= expr
                    && law.graph.depends(&[*outer], &[expr])[outer.index()]
            });
            return Err(at(read, named.unwrap_or(expr), LawProblem::NoValueAtRest { reason }));
        }
    }
    Ok(())
}

fn reason(law: &EnergyLaw, values: &Evaluation, expr: Expr, bad: f64) -> String {
    match law.graph.node(expr) {
        Node::Power(base, exponent) if values.scalar(*base) == 0.0 && values.scalar(*exponent) < 0.0 => {
            "a division by zero".to_owned()
        }
        Node::Power(base, _) if values.scalar(*base) < 0.0 => {
            format!("a power of {} that is not whole", values.scalar(*base))
        }
        Node::Function(function, argument) => {
            format!("{} of {}", format!("{function:?}").to_lowercase(), values.scalar(*argument))
        }
        _ if bad.is_nan() => "it is not defined".to_owned(),
        _ => format!("it is {bad}"),
    }
}

/// Energy a ten-millionth from rest, over the stiffness, at most: a smooth one is of the size of the square.
const JUMP_AT_REST: f64 = 1e-6;

/// The stress is zero at rest and neither it nor the energy jumps there; remembers the stiffness.
pub(super) fn slope(law: &mut EnergyLaw, read: &Read) -> Result<(), LawError> {
    let rest = law.stress_at(&identity());
    if !rest.is_finite() {
        return Err(corner(law, read));
    }
    for b in 0..9 {
        let dF = unit(b);
        let column = entries(&law.differential_at(&identity(), &dF));
        for (a, number) in column.into_iter().enumerate() {
            law.stiffness[9 * a + b] = number;
        }
    }
    // differences stand in where only the second derivative has no value at rest itself
    let size = |matrix: &Mat3| matrix.largest_entry();
    let shifted = |h: f64, direction: &Mat3| law.stress_at(&(identity() + *direction * h));
    // what overflows a thousandth away tells nothing
    let scale = directions()
        .iter()
        .map(|d| size(&(shifted(1e-3, d) - rest)) / 1e-3)
        .filter(|slope| slope.is_finite())
        .fold(0.0, f64::max);
    let limit = STRESS_AT_REST * scale.max(f64::MIN_POSITIVE);
    if size(&rest) > limit || size(&rest).is_nan() {
        // a corner such as that of |J - 1| shows as stress at rest from one side only
        if let Some(expr) = corner_at_rest(law) {
            return Err(at(read, expr, LawProblem::CornerAtRest));
        }
        let P = rest;
        let stress = format!(
            "[{:.4e}, {:.4e}, {:.4e}] Pa on the diagonal, {:.4e} Pa at most beside it",
            P.columns[0].x,
            P.columns[1].y,
            P.columns[2].z,
            (0..9).filter(|i| i % 4 != 0).map(|i| entries(&P)[i].abs()).fold(0.0, f64::max)
        );
        let span = Some(Span::new(0, 0));
        let span = read
            .origins
            .values()
            .filter(|(part, _)| part == "energy")
            .map(|(_, s)| *s)
            .reduce(wider)
            .or(span);
        return Err(LawError::new("energy", span, LawProblem::StressAtRest { stress }));
    }
    for direction in directions() {
        for sign in [1.0, -1.0] {
            let (near, far) = (shifted(sign * 1e-7, &direction), shifted(sign * 2e-7, &direction));
            // a smooth stress halves with the distance; one that jumps stays
            let jumps = size(&near) > 0.75 * size(&far) && size(&near) > 1e-3 * scale * 1e-3;
            // what jumps to a constant has no stress on either side
            let rises = law.energy_at(&(identity() + direction * (sign * 1e-7))).abs() > JUMP_AT_REST * scale;
            if jumps || rises || !near.is_finite() {
                return Err(corner(law, read));
            }
        }
    }
    if law.stiffness.iter().any(|number| !number.is_finite()) {
        return Err(corner(law, read));
    }
    Ok(())
}

fn corner(law: &EnergyLaw, read: &Read) -> LawError {
    let problem = LawProblem::CornerAtRest;
    match corner_at_rest(law) {
        Some(expr) => at(read, expr, problem),
        None => whole(problem),
    }
}

fn wider(a: Span, b: Span) -> Span {
    Span::new(a.start.min(b.start), a.end.max(b.end))
}

/// The first part that has a corner where its operands are at rest.
fn corner_at_rest(law: &EnergyLaw) -> Option<Expr> {
    let values = law.evaluate(&[law.energy], &identity(), &Mat3::ZERO);
    let depends = law.graph.depends(&[law.energy], &[law.deformation]);
    let corner = |expr: &Expr| match law.graph.node(*expr) {
        Node::Power(base, exponent) => values.scalar(*base) == 0.0 && values.scalar(*exponent) < 2.0,
        Node::Function(Function::Abs | Function::Sign | Function::Cbrt, a) => values.scalar(*a) == 0.0,
        Node::Function(Function::Asin | Function::Acos, a) => values.scalar(*a).abs() == 1.0,
        Node::Function(Function::Floor | Function::Ceil, a) => values.scalar(*a).fract() == 0.0,
        Node::Select(condition, _, _) => match law.graph.node(*condition) {
            Node::Compare(_, a, b) => values.scalar(*a) == values.scalar(*b),
            _ => false,
        },
        _ => false,
    };
    law.graph.reachable(&[law.energy]).into_iter().filter(|expr| depends[expr.index()]).find(corner)
}
