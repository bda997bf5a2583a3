//! Quantities at points.

use souple_engine::{Configuration, Force, World};
use souple_math::Vec3;
use souple_models::loads::Attachments;
use souple_models::marks::Mark;
use souple_models::network::Constraints;

use super::body::centre_of_mass;
use super::contact::{Share, contact_forces, penetrations, residuals};
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
        PointQuantity::ConstraintForce => constraint_forces(part, world),
        PointQuantity::ContactForce => contact_forces(part, Share::Total, world),
        PointQuantity::NormalForce => contact_forces(part, Share::Normal, world),
        PointQuantity::FrictionForce => contact_forces(part, Share::Tangential, world),
        PointQuantity::ContactTorque => moments(&contact_forces(part, Share::Total, world), part, world),
        PointQuantity::Penetration => return PointValues::Numbers(penetrations(part, world)),
        PointQuantity::ContactResidual => return PointValues::Numbers(residuals(part, world)),
        PointQuantity::Whitening => return PointValues::Numbers(marks(part, world, |mark| mark.whitening)),
        PointQuantity::Burn => return PointValues::Numbers(marks(part, world, |mark| mark.dose)),
        PointQuantity::Blood => return PointValues::Numbers(marks(part, world, |mark| mark.blood)),
        PointQuantity::BloodVolume => {
            return PointValues::Numbers(marks(part, world, |mark| mark.blood_volume));
        }
        PointQuantity::Slip => {
            return PointValues::Numbers(of_attachments(part, world, Attachments::slip_of));
        }
        PointQuantity::Torn => {
            let is_torn = |springs: &Attachments, link: usize, at: &Configuration| {
                if springs.is_torn(link, at.memory) { 1.0 } else { 0.0 }
            };
            return PointValues::Numbers(of_attachments(part, world, is_torn));
        }
    })
}

/// What constraints do to each row of the part, by the multipliers that were found last [N].
fn constraint_forces(part: &Part, world: &World) -> Vec<Vec3> {
    let mut forces = vec![Vec3::ZERO; world.rows(part.system).positions.len()];
    world.visit_forces(part.system, &mut |force, at| {
        let is_meant = part.constraint.as_deref().is_none_or(|name| name == force.name());
        if !is_meant {
            return;
        }
        if let Some(constraints) = force.as_any().downcast_ref::<Constraints>() {
            constraints.add_force(at, &mut constraints.new_scratch(), &mut forces);
        }
    });
    part.rows.iter().map(|row| forces[*row as usize]).collect()
}

/// Of each row of the part that is on the surface of a body with marks, one of its marks.
fn marks(part: &Part, world: &World, number: fn(Mark) -> f64) -> Vec<f64> {
    let Some((marks, points)) = &part.marks else { return Vec::new() };
    points.iter().filter_map(|point| marks.mark_at(*point as usize, world).map(number)).collect()
}

/// Of each row of the part the greatest number of the springs that attach it; zero where none does.
fn of_attachments(
    part: &Part,
    world: &World,
    number: impl Fn(&Attachments, usize, &Configuration) -> f64,
) -> Vec<f64> {
    let mut numbers = vec![0.0_f64; part.rows.len()];
    // rows of a region ascend
    let place = |row: u32| part.rows.binary_search(&row).ok();
    world.visit_forces(part.system, &mut |force, at| {
        let Some(springs) = force.as_any().downcast_ref::<Attachments>() else { return };
        for (link, ends) in springs.links().iter().enumerate() {
            for place in ends.a.rows().iter().filter_map(|(row, _)| place(*row)) {
                numbers[place] = numbers[place].max(number(springs, link, at));
            }
        }
    });
    numbers
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
