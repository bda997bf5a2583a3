//! `souple mesh repair`.

use std::ops::RangeInclusive;
use std::path::Path;

use serde_json::{Value as Json, json};
use souple_io::Dataset;
use souple_mesh::fill::surface_of;
use souple_mesh::repair::{RepairLimits, SurfaceRepairs, repair};
use souple_mesh::{Mesh, TriangleSurface};
use souple_table::{Parameter, Range, Value};

use super::fill::{SCALE, mesh_of, parameters_in_words};
use super::{announce, parameters};
use crate::command::Refusal;

const PARAMETERS: [Parameter; 3] = [
    Parameter::number(
        "weld",
        "",
        Range::closed(0.0, 0.1),
        "points closer than this part of the surface's diagonal, from corner to corner of the box around it, are one",
    )
    .or(Value::Number(1e-6)),
    Parameter::number(
        "hole",
        "",
        Range::closed(0.0, 1.0),
        "holes whose box has a diagonal up to this part of the surface's are closed",
    )
    .or(Value::Number(0.1)),
    SCALE,
];

/// As `--help` prints them.
pub fn parameters_help() -> String {
    parameters_in_words(&PARAMETERS)
}

/// Lengths of which areas and volumes are numbers too [m].
const SIZES: RangeInclusive<f64> = 1e-100..=1e100;

/// Refuses a surface that, as it is or as it would be written, is so small or large that it cannot be measured.
fn check_size(name: &str, surface: &TriangleSurface) -> Result<(), Refusal> {
    let length = surface.bounds().size().largest_component();
    if SIZES.contains(&length) {
        return Ok(());
    }
    let message =
        format!("`{name}` is {length:e} m long as it would be written, of which no areas can be computed");
    let expected = format!(
        "a length of {:e} to {:e} m, which `souple mesh convert` makes with scale=FACTOR",
        SIZES.start(),
        SIZES.end()
    );
    Err(Refusal::request("size", format!("{length:e}"), expected, message))
}

/// A surface that is mended.
pub struct Repaired {
    pub mesh: Mesh,
    repairs: SurfaceRepairs,
    limits: RepairLimits,
    pub notes: Vec<String>,
}

/// A file's surface, mended, what was done, and what is not carried along.
pub fn repaired(input: &Path, texts: &[String]) -> Result<Repaired, Refusal> {
    let name = input.display().to_string();
    let known: Vec<&Parameter> = PARAMETERS.iter().collect();
    let values = parameters::values(texts, &known)?;
    parameters::refuse_unknown(&values, &known)?;
    let values = values.completed(&PARAMETERS).map_err(|error| {
        let expected = "parameters as `souple mesh repair --help` names them";
        Refusal::request("repair", texts.join(" "), expected, error.to_string())
    })?;
    let Dataset { mut mesh, mut notes, unread, .. } = souple_io::read_dataset(input)?;
    notes.extend(unread);
    let of_cells = mesh.cell_count() > 0;
    let surface = surface_of(&mesh).filter(|_| !of_cells).ok_or_else(|| {
        let what = if of_cells { "holds cells, which have a surface in order" } else { "holds no triangles" };
        let expected = "a surface; `souple mesh convert` writes that of cells, `souple mesh quality` tells what is wrong with them";
        Refusal::request("repair", &name, expected, format!("`{name}` {what}"))
    })?;
    announce(&surface);
    // of points at one place it is told below
    if surface.bounds().size().largest_component() > 0.0 {
        check_size(&name, &surface)?;
    }
    let limits = RepairLimits { weld: values.number("weld"), hole: values.number("hole") };
    let (mut mended, mut repairs) = repair(&surface, limits);
    if mended.triangles.is_empty() {
        let message =
            format!("`{name}` has nothing left once it is mended: none of its triangles has an area");
        return Err(Refusal::request("repair", &name, "triangles with an area", message));
    }
    let scale = values.number("scale");
    let is_unchanged = repairs.messages().is_empty();
    mended.points.iter_mut().for_each(|point| *point = *point * scale);
    repairs.longest_weld *= scale;
    check_size(&name, &mended)?;
    // quadrilaterals and groups stay where nothing was mended
    if is_unchanged {
        mesh.points.iter_mut().for_each(|point| *point = *point * scale);
        return Ok(Repaired { mesh, repairs, limits, notes });
    }
    let groups = std::mem::take(&mut mesh.groups);
    if !groups.is_empty() {
        let names: Vec<String> = groups.into_keys().collect();
        notes.push(format!("triangles are numbered anew, without the groups {}", names.join(", ")));
    }
    Ok(Repaired { mesh: mesh_of(&mended), repairs, limits, notes })
}

impl Repaired {
    /// Adds to the document of the written surface what was done, and what was left.
    pub fn tell(&self, document: &mut Json) {
        let (done, left) = (self.repairs.messages(), self.repairs.left.messages(self.limits));
        let faults = document["faults"]["messages"].as_array().map_or(0, Vec::len) + left.len();
        if let Some(notes) = document["notes"].as_array_mut() {
            match (done.len(), faults) {
                (0, 0) => notes.push("there was nothing to mend".into()),
                (0, _) => notes.push("nothing was mended".into()),
                (_, 0) => {}
                (_, _) => notes.push("points and triangles have the numbers of the written file".into()),
            }
        }
        document["repairs"] = counts(&self.repairs);
        document["repairs"]["messages"] = json!(done);
        document["repairs"]["left"]["messages"] = json!(left);
    }
}

/// How many of each kind of repair.
fn counts(repairs: &SurfaceRepairs) -> Json {
    json!({
        "welded_points": repairs.welded_points,
        "flat_triangles": repairs.flat_triangles,
        "joined_triangles": repairs.joined_triangles,
        "doubled_triangles": repairs.doubled_triangles,
        "facing_triangles": repairs.facing_triangles,
        "turned_triangles": repairs.turned_triangles,
        "turned_parts": repairs.turned_parts,
        "closed_holes": repairs.closed_holes,
        "largest_closed_hole": repairs.largest_closed_hole,
        "folded_holes": repairs.folded_holes,
        "longest_weld": repairs.longest_weld,
        "left": {
            "thin_parts": repairs.left.thin_parts,
            "touching_points": repairs.left.touching_points,
            "one_sided_parts": repairs.left.one_sided_parts,
            "nested_parts": repairs.left.nested_parts,
            "holes": repairs.left.holes,
            "smallest_hole": repairs.left.smallest_hole,
            "largest_hole": repairs.left.largest_hole,
            "outlines": repairs.left.outlines,
            "tangled_edges": repairs.left.tangled_edges,
        },
    })
}
