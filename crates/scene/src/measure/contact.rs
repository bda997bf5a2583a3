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

/// How far the contacts of each row of a part whose forces are solved for are from complementarity, the worst of several: `|g|` of a gap whose
/// force pushes, `−g` of a closed one; zero where there are none [m].
pub fn residuals(part: &Part, world: &mut World) -> Vec<f64> {
    let mut worst = vec![0.0; world.rows(part.system).positions.len()];
    world.visit_forces(part.system, &mut |force, at| {
        let Some(unilateral) = force.unilateral().filter(|_| part.has_contact(force.name())) else { return };
        for contact in 0..unilateral.contact_count(at.pairs) {
            let gap = unilateral.gap(contact, at.pairs, at.positions, at.time);
            let slope = unilateral.slope(contact, at.pairs, at.positions, at.time);
            let is_pressing = unilateral.force(contact, at.memory, at.pairs).dot(slope) > 0.0;
            let off = if is_pressing { gap.abs() } else { (-gap).max(0.0) };
            // of formulas in metres, as far as they have a slope
            let steepness = if slope == Vec3::ZERO { 1.0 } else { slope.length() };
            for (row, _) in unilateral.sides(contact, at.pairs, at.positions).iter() {
                let known: &mut f64 = &mut worst[row];
                *known = known.max(off / steepness);
            }
        }
    });
    part.rows.iter().map(|row| worst[*row as usize]).collect()
}

/// All points of the system that touch by the part's contact, or by any.
fn for_contacts(part: &Part, world: &mut World, visit: &mut dyn FnMut(&ContactPoint)) {
    world.with_system(part.system, |system: &System, state, around, ws| {
        for (index, force) in
            system.forces.iter().enumerate().filter(|(_, force)| part.has_contact(force.name()))
        {
            force.visit_contacts(&system.view(index, &ws.rows, state, around), visit);
        }
    });
}
