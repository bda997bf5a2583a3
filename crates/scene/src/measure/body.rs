//! Quantities of the matter of a body's points.

use std::borrow::Cow;

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
fn velocities_of<'a>(part: &Part, world: &'a World) -> Cow<'a, [Vec3]> {
    let velocities = &world.rows(part.system).velocities;
    // rows of a part are told once each: those are all
    if part.rows.len() == velocities.len() {
        return Cow::Borrowed(velocities);
    }
    let mut only = vec![Vec3::ZERO; velocities.len()];
    part.rows.iter().for_each(|row| only[*row as usize] = velocities[*row as usize]);
    Cow::Owned(only)
}

/// Masses of rows: of a consistent mass, the sums of its lines over what moves with a shift [kg].
struct Masses<'a> {
    system: &'a System,
    /// Of a mass that couples rows.
    sums: Vec<f64>,
}

impl<'a> Masses<'a> {
    fn new(system: usize, world: &'a World) -> Self {
        let system = &world.model().systems[system];
        let mut masses = Self { system, sums: Vec::new() };
        if !system.mass.is_lumped() {
            masses.sums = (0..system.mass.diagonal.len()).map(|row| masses.alone(row)).collect();
            for &(a, b, coupling) in &system.mass.couplings {
                masses.sums[a as usize] += coupling * masses.share(b as usize);
                masses.sums[b as usize] += coupling * masses.share(a as usize);
            }
        }
        masses
    }

    /// How much of a shift a row moves with.
    fn share(&self, row: usize) -> f64 {
        self.system.kinematics.translation_weight(row)
    }

    fn alone(&self, row: usize) -> f64 {
        self.system.mass.diagonal[row] * self.share(row)
    }

    fn of(&self, row: usize) -> f64 {
        self.sums.get(row).copied().unwrap_or_else(|| self.alone(row))
    }

    fn total(&self, rows: impl Iterator<Item = usize>) -> f64 {
        rows.map(|row| self.of(row) * self.share(row)).sum()
    }
}

/// The mass of some rows [kg].
fn total(system: usize, rows: impl Iterator<Item = usize>, world: &World) -> f64 {
    Masses::new(system, world).total(rows)
}

/// `Σ m x / Σ m` of some rows as they stand [m].
pub fn centre_of_mass(system: usize, rows: impl Iterator<Item = usize> + Clone, world: &World) -> Vec3 {
    let (masses, positions) = (Masses::new(system, world), &world.rows(system).positions);
    let moment: Vec3 = rows.clone().map(|row| positions[row] * masses.of(row)).sum();
    moment / masses.total(rows)
}
