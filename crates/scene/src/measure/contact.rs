//! What contacts do at points.

use souple_engine::{ContactPoint, System, World};
use souple_math::Vec3;

use super::Part;

/// Which part of a contact force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Share {
    Total,
    Normal,
    Tangential,
}

impl Share {
    fn of(self, point: &ContactPoint) -> Vec3 {
        match self {
            Self::Total => point.normal_force + point.friction,
            Self::Normal => point.normal_force,
            Self::Tangential => point.friction,
        }
    }
}

/// Forces of one contact or of all on the rows of a part [N].
pub fn contact_forces(part: &Part, share: Share, world: &mut World) -> Vec<Vec3> {
    let mut sums = vec![Vec3::ZERO; world.rows(part.system).positions.len()];
    for_contacts(part, world, &mut |point| {
        let force = share.of(point);
        sums[point.row as usize] += force;
        for &(row, weight) in point.against {
            sums[row as usize] -= force * weight;
        }
    });
    part.rows.iter().map(|row| sums[*row as usize]).collect()
}

/// How deep the rows of a part are in what they touch, the deepest of several; zero where they do not [m].
pub fn penetrations(part: &Part, world: &mut World) -> Vec<f64> {
    let mut depths = vec![0.0; world.rows(part.system).positions.len()];
    for_contacts(part, world, &mut |point| {
        let depth: &mut f64 = &mut depths[point.row as usize];
        *depth = depth.max(point.penetration);
    });
    part.rows.iter().map(|row| depths[*row as usize]).collect()
}

/// All points of the system that touch by the part's contact, or by any.
fn for_contacts(part: &Part, world: &mut World, visit: &mut dyn FnMut(&ContactPoint)) {
    world.with_system(part.system, |system: &System, state, around, ws| {
        let named = |name: &str| part.contact.as_deref().is_none_or(|contact| contact == name);
        for (index, force) in system.forces.iter().enumerate().filter(|(_, force)| named(force.name())) {
            force.visit_contacts(&system.view(index, &ws.rows, state, around), visit);
        }
    });
}
