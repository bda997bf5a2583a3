//! The axes of laws that know directions, cell by cell.

use souple_math::{Mat3, Vec3, axes_along};
use souple_mesh::tissue::cell_axes;
use souple_models::materials::Material;
use souple_models::solids::Section;

use super::Draft;
use super::bodies::Placed;
use super::start::at;
use crate::diagnostic::Code;
use crate::spec::body::AxesSpec;

/// The axes of the law of each cell of a body: as its scene says, of tissue along itself; none where they are those of the world, or no
/// law knows directions. What cannot be is reported.
pub fn of_cells(draft: &Draft, body: &Placed) -> Vec<Mat3> {
    let written = body.spec.axes.as_ref();
    let tissue = body.spec.mesh.as_ref().and_then(|mesh| mesh.tissue());
    if written.is_none() && tissue.is_none() {
        return Vec::new();
    }
    let site = written.map_or(&body.spec.site, |spec| &spec.site);
    let refuse = |message: String, expected: &str| {
        draft.log.add(Code::Conflict, site, message, expected);
        Vec::new()
    };
    if !body.materials.all.iter().any(Material::knows_directions) {
        if written.is_none() {
            return Vec::new();
        }
        let message = format!("no law of body `{}` knows directions: axes change nothing", body.spec.name);
        return refuse(message, "a law with fibres, such as an energy with I4(fibre), or no axes");
    }
    let knows_none = [
        ("formulation", body.spec.formulation.is_some()),
        ("adapt", body.spec.adapt.is_some()),
        ("levels", body.spec.levels.is_some()),
        ("octree", body.spec.octree.is_some()),
        ("section", !matches!(body.spec.section(), Section::Solid | Section::PlaneStrain { .. })),
    ];
    if let Some((key, _)) = knows_none.into_iter().find(|(_, is_there)| *is_there) {
        let message = format!("body `{}` has `{key}`, which takes the axes of the world", body.spec.name);
        return refuse(message, "axes of volumes, of plane strain or of frames, sample by sample");
    }
    match (written, tissue) {
        (Some(spec), _) => along_formulas(draft, body, spec),
        (None, Some(tissue)) => cell_axes(&body.mesh, tissue.shape.form),
        (None, None) => Vec::new(),
    }
}

/// Sine of the angle between two directions below which they count as one.
const PARALLEL: f64 = 1e-6;

fn along_formulas(draft: &Draft, body: &Placed, spec: &AxesSpec) -> Vec<Mat3> {
    let mut axes = Vec::with_capacity(body.mesh.cell_count());
    for (cell, centre) in body.mesh.cell_centres().into_iter().enumerate() {
        let x = at(&spec.x, centre);
        let y = spec.y.as_ref().map_or(Vec3::ZERO, |formulas| at(formulas, centre));
        let leans = spec.y.is_none() || x.cross(y).length() > PARALLEL * x.length() * y.length();
        let found = axes_along(x, y).filter(|_| y.is_finite() && leans);
        let Some(found) = found else {
            let message = format!(
                "in cell {cell} of body `{}`, at ({}, {}, {}), x is ({}, {}, {}) and y ({}, {}, {})",
                body.spec.name, centre.x, centre.y, centre.z, x.x, x.y, x.z, y.x, y.y, y.z
            );
            let expected = "finite numbers, an x that is zero in no cell, and a `y` that leans from it";
            draft.log.add(Code::NotFinite, &spec.site, message, expected);
            return Vec::new();
        };
        axes.push(found);
    }
    axes
}
