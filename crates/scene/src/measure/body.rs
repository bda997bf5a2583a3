//! Quantities of the matter of a body's points.

use souple_engine::World;
use souple_math::Vec3;

use super::{Measurement, Part};
use crate::spec::quantity::{BodyQuantity, Momentum};

pub fn measure(quantity: BodyQuantity, part: &Part, world: &World) -> Measurement {
    let rows = || part.rows.iter().map(|row| *row as usize);
    match quantity {
        BodyQuantity::Mass => Measurement::Number(masses(part.system, rows(), world).1.iter().sum()),
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
    match momentum {
        Momentum::Linear => part.rows.iter().map(|row| momenta[*row as usize]).sum(),
        Momentum::Angular => {
            let rows = || part.rows.iter().map(|row| *row as usize);
            let about = part.about.unwrap_or_else(|| centre_of_mass(part.system, rows(), world));
            rows().map(|row| (positions[row] - about).cross(momenta[row])).sum()
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

/// Rows and their masses: of a consistent mass, the sums of its lines [kg].
fn masses(system: usize, rows: impl Iterator<Item = usize>, world: &World) -> (Vec<usize>, Vec<f64>) {
    let mass = &world.model().systems[system].mass;
    let mut sums = mass.diagonal.clone();
    for &(a, b, coupling) in &mass.couplings {
        sums[a as usize] += coupling;
        sums[b as usize] += coupling;
    }
    let rows: Vec<usize> = rows.collect();
    let masses = rows.iter().map(|row| sums[*row]).collect();
    (rows, masses)
}

/// `Σ m x / Σ m` of some rows as they stand [m].
pub fn centre_of_mass(system: usize, rows: impl Iterator<Item = usize>, world: &World) -> Vec3 {
    let (rows, masses) = masses(system, rows, world);
    let positions = &world.rows(system).positions;
    let moment: Vec3 = rows.iter().zip(&masses).map(|(row, mass)| positions[*row] * *mass).sum();
    moment / masses.iter().sum::<f64>()
}
