//! Quantities at points.

use souple_engine::World;
use souple_math::Vec3;

use super::body::centre_of_mass;
use super::contact::{Share, contact_forces, penetrations};
use super::reaction::reactions;
use super::{Part, PointValues};
use crate::spec::quantity::PointQuantity;

/// A value for each row of the part.
pub fn measure(quantity: PointQuantity, part: &Part, world: &mut World) -> PointValues {
    PointValues::Vectors(match quantity {
        PointQuantity::Displacement => {
            let positions = positions(part, world);
            positions.into_iter().zip(&part.starts).map(|(position, start)| position - *start).collect()
        }
        PointQuantity::Position => positions(part, world),
        PointQuantity::Velocity => {
            let velocities = &world.rows(part.system).velocities;
            part.rows.iter().map(|row| velocities[*row as usize]).collect()
        }
        PointQuantity::Reaction => reactions(part, world),
        PointQuantity::Torque => moments(&reactions(part, world), part, world),
        PointQuantity::ContactForce => contact_forces(part, Share::Total, world),
        PointQuantity::NormalForce => contact_forces(part, Share::Normal, world),
        PointQuantity::FrictionForce => contact_forces(part, Share::Tangential, world),
        PointQuantity::ContactTorque => moments(&contact_forces(part, Share::Total, world), part, world),
        PointQuantity::Penetration => return PointValues::Numbers(penetrations(part, world)),
    })
}

fn positions(part: &Part, world: &World) -> Vec<Vec3> {
    let positions = &world.rows(part.system).positions;
    part.rows.iter().map(|row| positions[*row as usize]).collect()
}

/// `(x − c) × f` of forces on the rows [N m].
fn moments(forces: &[Vec3], part: &Part, world: &World) -> Vec<Vec3> {
    let about = part.about.unwrap_or_else(|| centre_of_mass(part.system, part.whole.clone(), world));
    positions(part, world).iter().zip(forces).map(|(x, f)| (*x - about).cross(*f)).collect()
}
