//! What tools leave on surfaces: fields of the world, each with its first state.

use std::sync::Arc;

use souple_models::marks::{Heat, Kept, Marks};

use super::Draft;
use super::bodies::{Placed, point_areas};
use crate::diagnostic::Code;
use crate::scene::MarksInfo;
use crate::spec::contact::{Against, Contact};

/// Gives bodies the marks that they are told to have, and refuses heat that burns nothing.
pub fn add(draft: &mut Draft) {
    for contact in hot(draft) {
        if !touched(contact).any(|name| draft.body(name).is_some_and(|body| body.spec.marks.is_some())) {
            let message = format!("contact `{}` gives heat to nothing that burns", contact.name);
            draft.log.add(Code::Conflict, &contact.site, message, "a body with `marks`, or no `heat`");
        }
    }
    let made: Vec<(String, Marks)> =
        draft.bodies.iter().filter_map(|body| Some((body.spec.name.clone(), marks(draft, body)?))).collect();
    for (body, marks) in made {
        let info = MarksInfo { body, field: draft.model.fields.len(), marks: Arc::new(marks) };
        draft.state.fields.push(info.marks.start());
        draft.model.fields.push(Box::new(Kept(Arc::clone(&info.marks))));
        draft.marks.push(info);
    }
}

/// Contacts and hands that give heat.
fn hot<'a>(draft: &Draft<'a>) -> impl Iterator<Item = &'a Contact> + use<'a> {
    let hands = draft.spec.hands.iter().map(|hand| &hand.touch);
    draft.spec.contacts.iter().chain(hands).filter(|contact| contact.heat > 0.0)
}

/// The bodies of a contact.
fn touched(contact: &Contact) -> impl Iterator<Item = &str> {
    let other = match &contact.against {
        Some(Against::Body(name)) => Some(name.as_str()),
        _ => None,
    };
    [contact.body.as_str()].into_iter().chain(other)
}

/// The marks of a body; `None` where it has none, or where it was refused.
fn marks(draft: &Draft, body: &Placed) -> Option<Marks> {
    let spec = body.spec.marks.as_ref()?;
    let refuse = |message: &str, expected: &str| {
        draft.log.add(Code::Conflict, &spec.site, message, expected);
        None
    };
    if body.spec.levels.as_ref().is_some_and(|levels| levels.dress.is_some()) {
        return refuse("marks are on the body's own surface, which its `dress` hides", "no `dress` beside");
    }
    let surface = body.mesh.boundary_surface();
    if surface.triangles.is_empty() {
        return refuse("the body has no surface that could be marked", "a mesh of volumes or of sheets");
    }
    let heats = hot(draft).map(|contact| Heat { contact: contact.name.clone(), flux: contact.heat });
    let name = format!("{}.marks", body.spec.name);
    let rows = [body.system, body.rows.start];
    let areas = point_areas(&surface);
    Some(Marks::new(name, rows, (&surface, body.mesh.points.len()), areas, spec.law, heats.collect()))
}
