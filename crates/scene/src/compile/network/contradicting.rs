//! Rigid bodies whose masses start at velocities that no rigid body has.

use souple_math::Vec3;
use souple_table::four_digits;

use super::super::bodies::Placed;
use super::super::{Draft, start};
use super::constraints::rigid_groups;
use crate::spec::network::{ConstraintKind, MassGroup, Network};

/// Masses that part or near by less than this share of how fast they are start as of one body: rounding of what turns them.
const TOGETHER: f64 = 1e-6;

/// Warns of bodies that `rigid` makes of masses which start towards or away from each other.
pub fn warn_of_starts(draft: &mut Draft) {
    let warnings: Vec<String> =
        draft.bodies.iter().filter_map(|body| of_body(draft, body, body.spec.network.as_ref()?)).collect();
    draft.warnings.extend(warnings);
}

fn of_body(draft: &Draft, body: &Placed, network: &Network) -> Option<String> {
    // what the whole network has besides is a motion of a rigid body
    let velocity = |group: &MassGroup| if group.is_fixed { Vec3::ZERO } else { group.velocity };
    let velocities: Vec<Vec3> = network.of_each(velocity).collect();
    let rest = &body.mesh.points;
    let places = start::places(body.spec.start.as_ref(), rest);
    let parts = |ends: &[u32; 2]| {
        let [a, b] = ends.map(|end| end as usize);
        let along = (places[b] - places[a]).try_normalised()?;
        let speed = along.dot(velocities[b] - velocities[a]).abs();
        let size = velocities[a].length().max(velocities[b].length());
        (speed > TOGETHER * size).then_some((*ends, speed))
    };
    let rigid = network.constraints.iter().filter(|spec| matches!(spec.kind, Some(ConstraintKind::Rigid)));
    rigid.filter(|spec| spec.augmented.is_none()).find_map(|spec| {
        let (name, ([a, b], speed)) = rigid_groups(spec, network, rest)
            .find_map(|(name, rods)| Some((name, rods?.iter().find_map(parts)?)))?;
        let of = match name {
            "all masses" => "all masses of the network".to_owned(),
            name => format!("`{name}`"),
        };
        let cure = if spec.of.is_empty() { "`of`, with the groups that are bodies of their own," } else { "a group for each body" };
        Some(format!(
            "{}: `rigid` makes one body of {of}, and masses {a} and {b} start at {} m/s along the rod between them, which the first \
             step takes away: {cure} would keep it",
            draft.place(&spec.kind_site),
            four_digits(speed)
        ))
    })
}
