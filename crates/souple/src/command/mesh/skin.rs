//! `souple mesh skin`: the surface of particles.

use std::path::Path;

use souple_math::Vec3;
use souple_mesh::{ElementKind, Mesh};
use souple_table::{Parameter, Range, Value};

use super::{parameters, read};
use crate::command::Refusal;

const PARAMETERS: &[Parameter] = &[
    Parameter::number(
        "radius",
        "m",
        Range::NOT_NEGATIVE,
        "half the distance between particles; 0: that of the file",
    )
    .or(Value::Number(0.0)),
    Parameter::number("voxel", "m", Range::NOT_NEGATIVE, "distance between nodes; 0: the smallest radius")
        .or(Value::Number(0.0)),
    Parameter::number("iso", "", Range::POSITIVE, "density on the surface, 1 inside").or(Value::Number(0.5)),
];

/// The surface of a file's particles.
pub fn dressed(input: &Path, texts: &[String]) -> Result<Mesh, Refusal> {
    let name = input.display().to_string();
    let refuse = |message: String| {
        let message = format!("`{name}` cannot be dressed: {message}");
        Refusal::request("skin", name.clone(), "radius=LENGTH, and voxel=LENGTH where it is another", message)
    };
    let known: Vec<&Parameter> = PARAMETERS.iter().collect();
    let values = parameters::values(texts, &known)?;
    let values = values.completed(PARAMETERS).map_err(|error| refuse(error.to_string()))?;
    let radius = values.number("radius");
    let is_table = input.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("csv"));
    let particles: Vec<(Vec3, f64)> = if is_table {
        let rows = souple_io::read_particles(input)?;
        rows.iter()
            .map(|row| (row.position, if radius > 0.0 { radius } else { row.radius.unwrap_or(0.0) }))
            .collect()
    } else {
        read(input)?.0.points.iter().map(|point| (*point, radius)).collect()
    };
    let smallest = particles.iter().map(|(_, radius)| *radius).fold(f64::INFINITY, f64::min);
    let voxel = if values.number("voxel") > 0.0 { values.number("voxel") } else { smallest };
    let (surface, _) = souple_skin::dress(&particles, voxel, values.number("iso"))
        .map_err(|error| refuse(error.to_string()))?;
    let mut mesh = Mesh { points: surface.points, ..Mesh::default() };
    surface.triangles.iter().for_each(|corners| mesh.push_facet(ElementKind::Tri3, corners));
    Ok(mesh)
}
