//! An energy that neither rotations nor the order of stretches change.

#![allow(non_snake_case)]

use std::collections::HashMap;

use souple_math::{Mat3, Vec3, exponential};

use super::{at, deformations, directions, identity};
use crate::graph::Expr;
use crate::law::read::Read;
use crate::law::{EnergyLaw, LawError, LawProblem, Strain};

/// Relative change of energy under rotation that rounding may make.
const ROTATION_TOLERANCE: f64 = 1e-9;

pub(super) fn objectivity(law: &mut EnergyLaw, read: &Read) -> Result<(), LawError> {
    if law.strain == Strain::Small {
        return small_rotations(law, read);
    }
    for scale in SCALES {
        if let Some(Changed { F, turned, before, after }) = changed_by_turning(law, scale) {
            let problem = LawProblem::NotObjective { before, after };
            return Err(at(read, spoiler(law, read, &F, &turned).unwrap_or(law.energy), problem));
        }
    }
    Ok(())
}

/// How far deformations are from rest, next to moderate ones: a law of pieces may change only far from there.
const SCALES: [f64; 2] = [1.0, 4.5];
/// Relative change of entries of `F` at which it is seen how much the law makes of roundings, some hundred of them.
const SHIVER: f64 = 3e-14;

/// An energy before and after a turn.
struct Changed {
    F: Mat3,
    turned: Mat3,
    before: f64,
    after: f64,
}

/// The first deformation of a scale whose energy a turn changes by more than roundings do.
fn changed_by_turning(law: &EnergyLaw, scale: f64) -> Option<Changed> {
    let deformations: Vec<Mat3> =
        deformations().into_iter().map(|F| identity() + (F - identity()) * scale).collect();
    // a law may be flat at rest, and along some deformations
    let largest = deformations.iter().map(|F| law.energy_at(F).abs()).filter(|energy| energy.is_finite());
    let largest = largest.fold(0.0, f64::max);
    let stiffness = law.stiffness.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    deformations.into_iter().find_map(|F| {
        let before = law.energy_at(&F);
        if !before.is_finite() {
            return None;
        }
        let shivers = directions().into_iter().map(|direction| law.energy_at(&(F + direction * SHIVER)));
        let noise = shivers.map(|energy| (energy - before).abs()).fold(0.0, f64::max);
        let size = before.abs().max(1e-3 * stiffness.max(largest));
        [Vec3::new(0.4, -1.1, 0.8), Vec3::new(2.0, 0.5, -0.3)].into_iter().find_map(|turn| {
            let turned = exponential(turn) * F;
            let after = law.energy_at(&turned);
            let is_same = (after - before).abs() <= ROTATION_TOLERANCE * size + noise;
            (!is_same).then_some(Changed { F, turned, before, after })
        })
    })
}

/// Under small strain turns are small too: at a strain of size `h` they add the skew `h W` to `F`, and the energy, of the order
/// `h²`, is the same but for higher orders.
fn small_rotations(law: &mut EnergyLaw, read: &Read) -> Result<(), LawError> {
    let h = 1e-5;
    let scale = h * h * law.stiffness.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    for strain in directions() {
        let F = identity() + strain * h;
        for turn in Vec3::AXES {
            let turned = F + (exponential(turn * h) - identity());
            let (before, after) = (law.energy_at(&F), law.energy_at(&turned));
            // energies of the order h³
            if (after - before).abs() > 1e-2 * scale {
                let problem = LawProblem::NotObjective { before, after };
                return Err(at(read, spoiler(law, read, &F, &turned).unwrap_or(law.energy), problem));
            }
        }
    }
    let warning = "small strain (`eps`) takes rotations for strain: bodies that turn swell; E or C do not";
    law.warnings.push(warning.to_owned());
    Ok(())
}

/// The smallest written number that the rotation from one deformation to the other changes.
fn spoiler(law: &EnergyLaw, read: &Read, F: &Mat3, turned: &Mat3) -> Option<Expr> {
    let before = law.evaluate(&[law.energy], F, &Mat3::ZERO);
    let after = law.evaluate(&[law.energy], turned, &Mat3::ZERO);
    law.graph.reachable(&[law.energy]).into_iter().find(|expr| {
        let (a, b) = (before.of(*expr), after.of(*expr));
        a.len() == 1
            && read.origins.contains_key(expr)
            && (a[0] - b[0]).abs() > 1e-9 * (a[0].abs() + b[0].abs())
    })
}

/// The energy is the same in any order of the stretches.
pub(super) fn order_of_stretches(law: &mut EnergyLaw, read: &Read) -> Result<(), LawError> {
    let decomposition = law.graph.decompose(law.deformation);
    let stretches = [0, 1, 2].map(|index| law.graph.stretch(decomposition, index));
    let uses = law.graph.depends(&[law.energy], &stretches)[law.energy.index()];
    if !uses {
        return Ok(());
    }
    for (i, j) in [(0, 1), (1, 2)] {
        let swap = HashMap::from([(stretches[i], stretches[j]), (stretches[j], stretches[i])]);
        let swapped = law.graph.substitute(law.energy, &swap);
        let values = law.evaluate(&[law.energy, swapped], &deformations()[0], &Mat3::ZERO);
        let (a, b) = (values.scalar(law.energy), values.scalar(swapped));
        if (a - b).abs() > 1e-9 * (a.abs() + b.abs()) {
            let used = stretches.into_iter().find(|stretch| read.origins.contains_key(stretch));
            return Err(at(read, used.unwrap_or(law.energy), LawProblem::OrderOfStretches));
        }
    }
    Ok(())
}
