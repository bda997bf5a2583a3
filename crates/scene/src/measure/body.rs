//! Quantities of the matter of a body's points.

use souple_engine::{System, World};
use souple_math::Vec3;

use super::{Measurement, Part};
use crate::spec::quantity::{BodyQuantity, Momentum};

pub fn measure(quantity: BodyQuantity, part: &Part, world: &World) -> Measurement {
    let rows = || part.rows.iter().map(|row| *row as usize);
    match quantity {
        BodyQuantity::Mass => Measurement::Number(total(part.system, rows(), world)),
        BodyQuantity::CentreOfMass => Measurement::Vector(centre_of_mass(part.system, rows(), world)),
        BodyQuantity::KineticEnergy => {
            let mass = &world.model().systems[part.system].mass;
            Measurement::Number(mass.kinetic_energy(&velocities_of(part, world)))
        }
    }
}

/// `Σ m_ab ẋ_b` over the part, or its moment about the place that the part says.
pub fn momentum(momentum: Momentum, part: &Part, world: &World) -> Vec3 {
    let velocities = velocities_of(part, world);
    let mut momenta = vec![Vec3::ZERO; velocities.len()];
    world.model().systems[part.system].mass.add_product(&velocities, &mut momenta);
    let positions = &world.rows(part.system).positions;
    // axes of frames do not move with a shift
    let share = |row: usize| world.model().systems[part.system].kinematics.translation_weight(row);
    match momentum {
        Momentum::Linear => part.rows.iter().map(|row| momenta[*row as usize] * share(*row as usize)).sum(),
        Momentum::Angular => {
            let rows = || part.rows.iter().map(|row| *row as usize);
            let about = part.about.unwrap_or_else(|| centre_of_mass(part.system, rows(), world));
            rows().map(|row| (positions[row] - about * share(row)).cross(momenta[row])).sum()
        }
    }
}

/// Velocities of the part's rows, zero elsewhere.
fn velocities_of(part: &Part, world: &World) -> Vec<Vec3> {
    let velocities = &world.rows(part.system).velocities;
    let mut only = vec![Vec3::ZERO; velocities.len()];
    part.rows.iter().for_each(|row| only[*row as usize] = velocities[*row as usize]);
    only
}

/// Rows and their masses: of a consistent mass, the sums of its lines over what moves with a shift [kg].
fn masses(system: usize, rows: impl Iterator<Item = usize>, world: &World) -> (Vec<usize>, Vec<f64>) {
    let System { mass, kinematics, .. } = &world.model().systems[system];
    let share = |row: usize| kinematics.translation_weight(row);
    let mut sums: Vec<f64> = mass.diagonal.iter().enumerate().map(|(row, m)| m * share(row)).collect();
    for &(a, b, coupling) in &mass.couplings {
        sums[a as usize] += coupling * share(b as usize);
        sums[b as usize] += coupling * share(a as usize);
    }
    let rows: Vec<usize> = rows.collect();
    let masses = rows.iter().map(|row| sums[*row]).collect();
    (rows, masses)
}

/// The mass of some rows [kg].
fn total(system: usize, rows: impl Iterator<Item = usize>, world: &World) -> f64 {
    let (rows, masses) = masses(system, rows, world);
    let share = |row: &usize| world.model().systems[system].kinematics.translation_weight(*row);
    rows.iter().zip(&masses).map(|(row, mass)| mass * share(row)).sum()
}

/// `Σ m x / Σ m` of some rows as they stand [m].
pub fn centre_of_mass(system: usize, rows: impl Iterator<Item = usize>, world: &World) -> Vec3 {
    let (rows, masses) = masses(system, rows, world);
    let positions = &world.rows(system).positions;
    let moment: Vec3 = rows.iter().zip(&masses).map(|(row, mass)| positions[*row] * *mass).sum();
    moment / total(system, rows.iter().copied(), world)
}
