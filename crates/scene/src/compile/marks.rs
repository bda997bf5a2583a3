//! What tools leave on surfaces: fields of the world, each with its first state.

use std::sync::Arc;

use souple_math::Vec3;
use souple_mesh::{Aabb, AabbTree, TriangleSurface, closest_point_on_triangle};
use souple_models::marks::{Gash, Kept, MarkedSurface, Marks, Sides, Tool};

use super::Draft;
use super::bodies::Placed;
use super::levels::{cut_at, opening_surface};
use crate::diagnostic::Code;
use crate::scene::{CarriedMarks, MarksInfo};
use crate::spec::contact::{Against, Contact};
use crate::spec::marks::MarksSpec;

/// Gives bodies the marks that they are told to have, and refuses heat that burns nothing and edges that tear nothing.
pub fn add(draft: &mut Draft) {
    check_tools(draft);
    let made: Vec<(String, Marks)> =
        draft.bodies.iter().filter_map(|body| Some((body.spec.name.clone(), marks(draft, body)?))).collect();
    for (body, marks) in made {
        let info = MarksInfo { body, field: draft.model.fields.len(), marks: Arc::new(marks) };
        draft.state.fields.push(info.marks.start());
        draft.model.fields.push(Box::new(Kept(Arc::clone(&info.marks))));
        let worn = draft.dresses.iter().position(|dress| dress.body == info.body);
        if let (Some(worn), Some(body)) = (worn, draft.body(&info.body)) {
            let places = carried(&opening_surface(draft, body).surface, draft.dresses[worn].dress.rest());
            draft.dresses[worn].marks = Some(CarriedMarks { marks: info.clone(), places });
        }
        draft.marks.push(info);
    }
}

/// Of each place on a dress, where the surface beneath is nearest: corners of one of its triangles, by their number in the mesh, with
/// weights.
fn carried(surface: &TriangleSurface, places: &[Vec3]) -> Arc<[[(u32, f64); 3]]> {
    let boxes: Vec<Aabb> =
        (0..surface.triangles.len()).map(|triangle| Aabb::of(surface.corners(triangle as u32))).collect();
    let tree = AabbTree::build(&boxes);
    let nearest = |place: &Vec3| {
        let distance_sq = |triangle: u32| {
            let corners = surface.corners(triangle);
            let (weights, _) = closest_point_on_triangle(*place, corners);
            let there: Vec3 = corners.iter().zip(weights).map(|(corner, weight)| *corner * weight).sum();
            (*place - there).length_sq()
        };
        // there are triangles, and all of them are finite
        let triangle = tree.nearest(*place, f64::INFINITY, distance_sq).map_or(0, |(triangle, _)| triangle);
        let (weights, _) = closest_point_on_triangle(*place, surface.corners(triangle));
        let corners = surface.triangles[triangle as usize];
        [0, 1, 2].map(|k: usize| (surface.mesh_points[corners[k] as usize], weights[k]))
    };
    places.iter().map(nearest).collect()
}

/// Refuses what contacts do to marks that nothing has which they touch.
fn check_tools(draft: &Draft) {
    for contact in tools(draft) {
        let touches = |has: fn(&MarksSpec) -> bool| {
            touched(contact)
                .any(|name| draft.body(name).and_then(|body| body.spec.marks.as_ref()).is_some_and(has))
        };
        let refuse = |what: &str, expected: &str| {
            let message = format!("contact `{}` {what}", contact.name);
            draft.log.add(Code::Conflict, &contact.site, message, expected);
        };
        if contact.heat > 0.0 && !touches(|_| true) {
            refuse("gives heat to nothing that burns", "a body with `marks`, or no `heat`");
        }
        if contact.tears_at.is_some() && !touches(|marks| marks.law.bleeding.is_some()) {
            refuse("tears nothing that bleeds", "a body with `marks.bleeding`, or no `tears_at`");
        }
    }
}

/// Contacts and hands that give heat or tear.
fn tools<'a>(draft: &Draft<'a>) -> impl Iterator<Item = &'a Contact> + use<'a> {
    let hands = draft.spec.hands.iter().map(|hand| &hand.touch);
    let all = draft.spec.contacts.iter().chain(hands);
    all.filter(|contact| contact.heat > 0.0 || contact.tears_at.is_some())
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
    let surface = opening_surface(draft, body);
    if surface.surface.triangles.is_empty() {
        let message = "the body has no surface that could be marked";
        draft.log.add(Code::Conflict, &spec.site, message, "a mesh of volumes or of sheets");
        return None;
    }
    let tool = |contact: &Contact| Tool {
        contact: contact.name.clone(),
        heat: contact.heat,
        tears_at: contact.tears_at,
    };
    let of = MarkedSurface {
        place: [body.system, body.rows.start],
        surface: &surface,
        point_count: body.mesh.points.len(),
        sides: if body.mesh.dimension() == 3 { Sides::Outer } else { Sides::Both },
        tools: tools(draft).map(tool).collect(),
        gashes: gashes(draft, body),
    };
    Some(Marks::new(format!("{}.marks", body.spec.name), spec.law, of))
}

/// What cuts leave of a body along them: points of cells that are cut which others that are not cut, or later, have too.
fn gashes(draft: &Draft, body: &Placed) -> Vec<Gash> {
    let cut_at = cut_at(draft, body);
    let point_count = body.mesh.points.len();
    let of_cells = |is_taken: &dyn Fn(f64) -> bool| {
        let mut has = vec![false; point_count];
        let taken = body.mesh.cells().zip(&cut_at).filter(|(_, time)| is_taken(**time));
        taken.for_each(|(cell, _)| cell.nodes.iter().for_each(|node| has[*node as usize] = true));
        has
    };
    let mut times: Vec<f64> = cut_at.iter().copied().filter(|time| time.is_finite()).collect();
    times.sort_unstable_by(f64::total_cmp);
    times.dedup();
    let of_time = |time: f64| {
        let (go, stay) = (of_cells(&|date| date == time), of_cells(&|date| date > time));
        let is_along = |point: &u32| go[*point as usize] && stay[*point as usize];
        Gash { time, points: (0..point_count as u32).filter(is_along).collect() }
    };
    times.into_iter().map(of_time).collect()
}
