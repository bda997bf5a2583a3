//! What makes the membrane of a body a thin shell.

use souple_engine::Force;
use souple_math::{Mat3, Vec3};
use souple_models::solids::{
    Bending, BendingDescription, BendingError, Plate, Section, plane_axes, rigidity_of_law,
};

use super::Draft;
use super::bodies::Placed;
use crate::diagnostic::Code;
use crate::spec::bending::BendingSpec;

/// The bending of a body that has some; what cannot be is reported.
pub fn force(draft: &Draft, body: &Placed) -> Option<Box<dyn Force>> {
    let spec = body.spec.bending.as_ref()?;
    let refuse = |message: String, expected: &str| {
        draft.log.add(Code::Conflict, &spec.site, message, expected);
        None
    };
    let name = &body.spec.name;
    let Section::Membrane { thickness } = body.spec.section() else {
        let message = format!("body `{name}` is no membrane, and its cells have no normals that bend");
        return refuse(message, "`section = { name = \"membrane\", thickness = … }`");
    };
    if body.is_carried() || body.spec.levels.is_some() || body.spec.octree.is_some() {
        let message = format!("what moves body `{name}` is not its points, and bending is told by those");
        return refuse(message, "a body without frames, modes, polynomial, levels and octree");
    }
    let mut clamped = vec![false; body.mesh.points.len()];
    if let Some(region) = &spec.clamped {
        draft.selector(body).points(region).into_iter().for_each(|point| clamped[point as usize] = true);
    }
    let Some(plates) = plates(body, spec, thickness) else {
        let message = format!("a law of body `{name}` has no stiffness at rest to resist bending with");
        return refuse(message, "a law with some, or `along`, `across`, `coupling` and `twist`");
    };
    let description = BendingDescription {
        name: self::name(body),
        mesh: &body.mesh,
        first_row: body.rows.start,
        plates: &plates,
        clamped: &clamped,
    };
    match Bending::new(&description) {
        Ok(force) => Some(Box::new(force)),
        Err(error) => {
            let expected = match error {
                BendingError::Kind { .. } => "`element = \"tri3\"`",
                BendingError::Flat { .. } => "cells with area",
                BendingError::Nowhere => "cells that share edges, or an edge that is clamped",
                BendingError::Branches { .. } | BendingError::Turned { .. } => "a surface with two sides",
            };
            refuse(format!("body `{name}`: {error}"), expected)
        }
    }
}

/// That of a body of a system that is made, if it has some.
pub fn of<'a>(draft: &'a Draft, body: &Placed) -> Option<&'a Bending> {
    let name = name(body);
    let force = draft.systems[body.system].forces.iter().find(|force| force.name() == name)?;
    force.as_any().downcast_ref()
}

fn name(body: &Placed) -> String {
    format!("{}.bending", body.spec.name)
}

/// Of each cell; of cells that are no triangles none is looked at.
fn plates(body: &Placed, spec: &BendingSpec, thickness: f64) -> Option<Vec<Plate>> {
    let [bending, across, twist] = spec.natural_curvature.to_array();
    let natural = Vec3::new(bending, across, 2.0 * twist);
    let plate = |(cell, nodes): (usize, [Vec3; 3])| {
        let rigidity = match (&spec.rigidities, plane_axes(nodes, spec.axis)) {
            (Some(rigidities), _) => rigidities.matrix(),
            (None, Some(axes)) => {
                let law = body.materials.of(cell).along(body.axes.get(cell));
                rigidity_of_law(&law, axes, thickness).filter(is_definite)?
            }
            // reported as a flat cell
            (None, None) => Mat3::IDENTITY,
        };
        Some(Plate { rigidity, first: spec.axis, natural })
    };
    let corners = body.mesh.cells().map(|cell| [0, 1, 2].map(|i| body.mesh.points[cell.nodes[i] as usize]));
    corners.enumerate().map(plate).collect()
}

/// Whether every curvature costs energy.
fn is_definite(rigidity: &Mat3) -> bool {
    let minor = rigidity.entry(0, 0) * rigidity.entry(1, 1) - rigidity.entry(0, 1).powi(2);
    rigidity.is_finite() && rigidity.entry(0, 0) > 0.0 && minor > 0.0 && rigidity.determinant() > 0.0
}
