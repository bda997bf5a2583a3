//! Masses that fill shapes, or stand where files have points, get their places.

use std::sync::Arc;

use souple_math::Vec3;
use souple_mesh::BoundingBox;
use souple_models::contact::Shape;
use souple_models::contact::shape::ClosedSurface;
use souple_models::network::{Filling, Gap, Gaps};

use super::super::{Draft, contact, shape};
use crate::diagnostic::Code;
use crate::spec::network::{FillSpec, Filled, Network, Places};

/// Of a radius: gaps that are wider by less are a radius wide.
const ROUND: f64 = 1e-6;

/// Fills what groups of masses are to fill, and reads what they are to stand at; what cannot be goes to the log.
pub fn fill_all(draft: &mut Draft) {
    let groups = draft.spec.bodies.iter().filter_map(|body| Some((body, body.network.as_ref()?)));
    let mut warnings = Vec::new();
    for (body, group) in
        groups.flat_map(|(body, network)| network.masses.iter().map(move |group| (body, group)))
    {
        let fill = match &group.places {
            Places::Filled(fill) => fill,
            Places::File(file) => {
                if let Some(mesh) = shape::of_file(draft, &file.site, &file.file, file.scale, &mut warnings) {
                    let log = &draft.log;
                    file.take(&mesh.points, |code, message, expected| {
                        log.add(code, &file.site, message, expected)
                    });
                }
                continue;
            }
            _ => continue,
        };
        let Some(shape) = shape_of(fill, &body.name, draft, &mut warnings) else { continue };
        let outline = shape.outline().map(|outline| BoundingBox::of(outline.surface.points));
        let asked = fill.bounds.map(|[low, high]| BoundingBox { low, high });
        let Some(bounds) = asked.or(outline) else {
            let message = "this shape has no end";
            draft.log.add(Code::MissingKey, &fill.site, message, "box = [[…], […]], where balls may be");
            continue;
        };
        let FillSpec { spacing, inset, depth, gaps, .. } = **fill;
        let filling = Filling { spacing, inset, depth, bounds, gaps };
        let places = match filling.fill(shape.as_ref()) {
            Ok(places) => places,
            Err(error) => {
                draft.log.add(Code::OutOfRange, &fill.site, error.to_string(), "another `spacing`, or `box`");
                continue;
            }
        };
        let widest = match gaps {
            Gaps::Closed => filling.widest_gap(shape.as_ref(), &places),
            Gaps::Left => None,
        };
        if let Some(gap) = widest.filter(|gap| gap.width > 0.5 * spacing * (1.0 + ROUND)) {
            let Vec3 { x, y, z } = gap.place;
            let is_far = gap.width >= (Gap::MOST - 0.5) * spacing * (1.0 - ROUND);
            let at_least = if is_far { "at least " } else { "" };
            warnings.push(format!(
                "{}: at ({x:.4}, {y:.4}, {z:.4}) the surface is {at_least}{:.3} radii from the nearest ball of `{}`: none has room nearer to it, as in edges, \
                 where a surface is bent or below an `inset`; smaller balls come nearer",
                draft.place(&fill.site),
                gap.width / (0.5 * spacing),
                group.name,
            ));
        }
        drop(fill.filled.set(Filled { places, widest, shape, filling }));
    }
    for body in &draft.spec.bodies {
        if let Some((message, expected)) = body.network.as_ref().and_then(Network::too_many) {
            draft.log.add(Code::TooLarge, &body.site, message, expected);
        }
    }
    draft.warnings.extend(warnings);
}

/// `None` where it was refused.
fn shape_of(
    fill: &FillSpec,
    body: &str,
    draft: &Draft,
    warnings: &mut Vec<String>,
) -> Option<Arc<dyn Shape>> {
    if let Some(chosen) = &fill.shape {
        return contact::built(draft, chosen).map(Arc::from);
    }
    let mesh = shape::mesh_of(fill.mesh.as_ref()?, body, draft, warnings)?;
    let surface = match mesh.facet_surface() {
        Some(surface) if mesh.cell_count() == 0 => surface,
        _ => mesh.boundary_surface(),
    };
    match ClosedSurface::new(surface) {
        Ok(closed) => Some(Arc::new(closed)),
        Err(error) => {
            draft.log.add(Code::Mesh, &fill.site, error.to_string(), "a mesh with a closed surface");
            None
        }
    }
}
