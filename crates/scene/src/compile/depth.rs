//! Bodies that start inside what they touch: the contact throws them out with all the energy of the overlap.

use souple_engine::{ContactPoint, Surroundings};
use souple_table::in_number;

use super::Draft;

/// A point deeper than this part of the mean edge of its surface is no touch any more: a body at rest sinks in by a part
/// of what its elements are pressed together, which is far less.
const DEEP: f64 = 0.5;

/// Where a contact has the point that is deepest inside.
struct Deepest {
    depth: f64,
    row: u32,
    count: usize,
}

/// Warns of every contact that starts with points deep inside.
pub fn warn(draft: &mut Draft) {
    let mut warnings = Vec::new();
    let of_hands = draft.spec.hands.iter().map(|hand| &hand.touch);
    for contact in draft.spec.contacts.iter().chain(of_hands) {
        let Some(body) = draft.body(&contact.body) else { continue };
        let limit = DEEP * body.mesh.boundary_surface().mean_edge();
        let Some(found) = deepest(draft, body.system, &contact.name, contact.thickness + limit) else {
            continue;
        };
        let bodies = draft.bodies.iter().filter(|other| other.system == body.system);
        let Some(owner) = bodies.into_iter().find(|other| other.rows.contains(&(found.row as usize))) else {
            continue;
        };
        let place = owner.mesh.points[found.row as usize - owner.rows.start];
        warnings.push(format!(
            "{}: {}, the deepest of body `{}` at ({:.4}, {:.4}, {:.4}) by \
             {:.4} m: the contact will throw it out; start apart",
            draft.place(&contact.site),
            in_number(
                found.count,
                "point starts deep inside what it touches",
                "points start deep inside what they touch"
            ),
            owner.spec.name,
            place.x,
            place.y,
            place.z,
            found.depth - contact.thickness,
        ));
    }
    draft.warnings.extend(warnings);
}

/// The deepest of the points of a contact that are deeper than `limit` at the start [m].
fn deepest(draft: &Draft, system: usize, contact: &str, limit: f64) -> Option<Deepest> {
    let (model, fields) = (&draft.systems[system], &draft.state.fields);
    let around = Surroundings { driven: &draft.state.driven, fields, load: 1.0 };
    let force = model.forces.iter().position(|force| force.name() == contact)?;
    let (mut state, mut ws) = (draft.state.systems[system].clone(), model.new_workspace());
    model.place_rows(&state.q, &state.v, 0.0, &mut ws.rows);
    model.update_pairs(&mut ws, &mut state, &around);
    if model.holds() {
        // what a tool would hold is known once it has looked
        model.look(&mut ws, &mut state, &around);
    }
    let mut found: Option<Deepest> = None;
    let mut visit = |point: &ContactPoint| {
        if point.penetration > limit {
            let known = found.get_or_insert(Deepest { depth: 0.0, row: point.row, count: 0 });
            known.count += 1;
            if point.penetration > known.depth {
                (known.depth, known.row) = (point.penetration, point.row);
            }
        }
    };
    model.forces[force].visit_contacts(&model.view(force, &ws.rows, &state, &around), &mut visit);
    found
}
