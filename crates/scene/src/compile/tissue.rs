//! Tissue between bodies: shaped between a region of one and a region of another, attached to both.

use souple_mesh::Mesh;
use souple_mesh::tissue::{ENDS, Patch, tissue};

use super::Draft;
use crate::diagnostic::Code;
use crate::spec::body::Body;
use crate::spec::interaction::Link;
use crate::spec::mesh::{MeshSpec, TissueEnd, TissueSpec};
use crate::spec::region::{Region, RegionKind};

fn tissue_of(body: &Body) -> Option<&TissueSpec> {
    body.mesh.as_ref().and_then(MeshSpec::tissue)
}

/// Bodies of the specification by number, tissue after what it is built between; tissue that waits for itself is
/// reported and left out.
pub fn in_order(draft: &Draft) -> Vec<usize> {
    let bodies = &draft.spec.bodies;
    let (mut order, mut waiting): (Vec<usize>, Vec<usize>) =
        (0..bodies.len()).partition(|index| tissue_of(&bodies[*index]).is_none());
    loop {
        let is_ready = |index: &usize| {
            let is_there = |end: &TissueEnd| order.iter().any(|other| bodies[*other].name == end.body);
            tissue_of(&bodies[*index]).is_some_and(|tissue| is_there(&tissue.from) && is_there(&tissue.to))
        };
        let (ready, rest): (Vec<usize>, Vec<usize>) = waiting.iter().copied().partition(is_ready);
        if ready.is_empty() {
            break;
        }
        order.extend(ready);
        waiting = rest;
    }
    for tissue in waiting.iter().filter_map(|index| tissue_of(&bodies[*index])) {
        let message = "this tissue is built on tissue that waits for it".to_owned();
        draft.log.add(Code::Conflict, &tissue.site, message, "two bodies that are there without it");
    }
    order
}

/// The mesh of tissue; `None` where it was refused.
pub fn build(body: &Body, spec: &TissueSpec, draft: &Draft) -> Option<Mesh> {
    let placement = &body.placement;
    if placement.translation.length_sq() + placement.rotation.length_sq() > 0.0 {
        let message = "tissue stands between its bodies, and is not moved";
        draft.log.add(Code::Conflict, &placement.site, message, "no `translate` and no `rotate`");
        return None;
    }
    if spec.from.body == spec.to.body {
        let message = format!("tissue would join body `{}` to itself", spec.to.body);
        draft.log.add(Code::Conflict, &spec.to.body_site, message, "another body");
        return None;
    }
    let (from, to) = (patch(&spec.from, draft)?, patch(&spec.to, draft)?);
    match tissue(&from, &to, &spec.shape) {
        Ok(mesh) => Some(mesh),
        Err(error) => {
            draft.log.add(Code::Mesh, &spec.site, error.to_string(), error.expected());
            None
        }
    }
}

/// The region that tissue ends on; `None` where there is no such, which is reported elsewhere.
fn patch(end: &TissueEnd, draft: &Draft) -> Option<Patch> {
    let body = draft.body(&end.body)?;
    let selector = draft.selector(body);
    let at = |point: &u32| body.mesh.points[*point as usize];
    let points: Vec<_> = selector.points(&end.region).iter().map(at).collect();
    // corners of faces alone: middles of edges and faces lie between them
    let face = |(kind, nodes): (souple_mesh::ElementKind, Vec<u32>)| {
        nodes[..kind.corner_count()].iter().map(at).collect()
    };
    let faces = if body.spec.network.is_some() { Vec::new() } else { selector.whole_faces(&end.region) };
    let faces = faces.into_iter().map(face).collect();
    (!points.is_empty()).then_some(Patch { points, faces })
}

/// What attaches the ends of all tissue: the name of each attachment and where it is.
pub fn attachments(draft: &Draft) -> Vec<(String, Link)> {
    let all = draft.spec.bodies.iter().filter_map(|body| Some((body, tissue_of(body)?)));
    let of_end = |(body, tissue): (&Body, &TissueSpec), end: &TissueEnd, group: &str| {
        let site = tissue.site.clone();
        let region = Region { kind: RegionKind::Group(group.to_owned()), site: site.clone() };
        let link = Link {
            from: body.name.clone(),
            region: Some(region),
            to: end.body.clone(),
            hold: None,
            stiffness: None,
            damping: 0.0,
            strength: tissue.strength,
            reach: f64::INFINITY,
            from_site: site.clone(),
            to_site: end.body_site.clone(),
            site,
        };
        (format!("{}.{group}", body.name), link)
    };
    all.flat_map(|of| [of_end(of, &of.1.from, ENDS[0]), of_end(of, &of.1.to, ENDS[1])]).collect()
}
