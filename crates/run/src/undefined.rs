//! Watches grounds whose formula has no value where points are: there is nothing to touch there.
//!
//! Constraints tell that themselves: a step that leads where one has no value is refused. It is told once of each contact.

use souple_engine::World;
use souple_models::contact::ShapeContact;
use souple_scene::BodyInfo;
use souple_table::readable;

/// Contacts of which it was told, by their systems and names.
#[derive(Clone, Debug, Default)]
pub struct Undefined {
    told: Vec<(usize, String)>,
}

impl Undefined {
    /// Looks at where points are now; what there is to say of formulas that have no value there for the first time.
    pub fn look(&mut self, world: &World, bodies: &[BodyInfo]) -> Vec<String> {
        let mut said = Vec::new();
        for system in 0..world.model().systems.len() {
            world.visit_forces(system, &mut |force, at| {
                let Some(contact) = force.as_any().downcast_ref::<ShapeContact>() else { return };
                if self.told.iter().any(|(of, name)| *of == system && name == force.name()) {
                    return;
                }
                let mut places = contact.points().iter().zip(contact.places(at));
                let found = places.find_map(|(point, place)| Some((point.row, contact.shape().undefined_at(place)?)));
                let Some((row, what)) = found else { return };
                self.told.push((system, force.name().to_owned()));
                let row = row as usize;
                let body = bodies.iter().find(|body| body.system == system && body.rows.contains(&row));
                let point = body.map_or_else(
                    || format!("row {row}"),
                    |body| {
                        let kind = if body.is_network() { "mass" } else { "point" };
                        format!("{kind} {} of `{}`", row - body.rows.start, body.name)
                    },
                );
                said.push(format!(
                    "nothing to touch: at {} s {point} is at {:?} m, where the shape of contact `{}` has no ground, as {what}",
                    readable(world.time()),
                    at.positions[row].to_array(),
                    force.name(),
                ));
            });
        }
        said
    }
}
