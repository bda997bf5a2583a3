//! `souple mesh repair`.

use std::path::Path;

use serde_json::{Value as Json, json};
use souple_mesh::Mesh;
use souple_mesh::fill::surface_of;
use souple_mesh::repair::{RepairLimits, SurfaceRepairs, repair};
use souple_table::{Parameter, Range, Value};

use super::fill::{SCALE, mesh_of, parameters_in_words};
use super::{announce, parameters, read};
use crate::command::Refusal;

const PARAMETERS: [Parameter; 3] = [
    Parameter::number(
        "weld",
        "",
        Range::closed(0.0, 0.1),
        "points closer than this part of the surface's diagonal are one",
    )
    .or(Value::Number(1e-6)),
    Parameter::number(
        "hole",
        "",
        Range::closed(0.0, 1.0),
        "holes up to this part of the surface's diagonal are closed",
    )
    .or(Value::Number(0.1)),
    SCALE,
];

/// As `--help` prints them.
pub fn parameters_help() -> String {
    parameters_in_words(&PARAMETERS)
}

/// A file's surface, mended, what was done, and what is not carried along.
pub fn repaired(input: &Path, texts: &[String]) -> Result<(Mesh, SurfaceRepairs, Vec<String>), Refusal> {
    let name = input.display().to_string();
    let known: Vec<&Parameter> = PARAMETERS.iter().collect();
    let values = parameters::values(texts, &known)?;
    parameters::refuse_unknown(&values, &known)?;
    let values = values.completed(&PARAMETERS).map_err(|error| {
        let expected = "parameters as `souple mesh repair --help` names them";
        Refusal::request("repair", texts.join(" "), expected, error.to_string())
    })?;
    let (mut mesh, mut notes) = read(input)?;
    let of_cells = mesh.cell_count() > 0;
    let surface = surface_of(&mesh).filter(|_| !of_cells).ok_or_else(|| {
        let what = if of_cells { "holds cells, which have a surface in order" } else { "holds no triangles" };
        let expected = "a surface; `souple mesh convert` writes that of cells, `souple mesh quality` tells what is wrong with them";
        Refusal::request("repair", &name, expected, format!("`{name}` {what}"))
    })?;
    announce(&surface);
    let limits = RepairLimits { weld: values.number("weld"), hole: values.number("hole") };
    let (mut mended, repairs) = repair(&surface, limits);
    if mended.triangles.is_empty() {
        let message =
            format!("`{name}` has nothing left once it is mended: none of its triangles has an area");
        return Err(Refusal::request("repair", &name, "triangles with an area", message));
    }
    let scale = values.number("scale");
    mended.points.iter_mut().for_each(|point| *point = *point * scale);
    let done = repairs.messages();
    notes.extend(if done.is_empty() { vec!["there was nothing to mend".to_owned()] } else { done });
    let groups = std::mem::take(&mut mesh.groups);
    if !groups.is_empty() {
        let names: Vec<String> = groups.into_keys().collect();
        notes.push(format!("triangles are numbered anew, without the groups {}", names.join(", ")));
    }
    Ok((mesh_of(&mended), repairs, notes))
}

/// How many of each kind of repair.
pub fn counts(repairs: &SurfaceRepairs) -> Json {
    json!({
        "welded_points": repairs.welded_points,
        "flat_triangles": repairs.flat_triangles,
        "joined_triangles": repairs.joined_triangles,
        "doubled_triangles": repairs.doubled_triangles,
        "facing_triangles": repairs.facing_triangles,
        "turned_triangles": repairs.turned_triangles,
        "turned_parts": repairs.turned_parts,
        "closed_holes": repairs.closed_holes,
    })
}
