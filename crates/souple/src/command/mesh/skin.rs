//! `souple mesh skin`: the surface of particles.

use std::path::Path;

use souple_math::Vec3;
use souple_mesh::{ElementKind, Mesh};
use souple_skin::target::Particle;
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
    Parameter::number("time", "s", Range::ANY, "when: particles of a file may move, come and go")
        .or(Value::Number(0.0)),
];

/// Voxels larger than this see no single particles [radii].
const COARSE: f64 = 2.0;

/// The surface of a file's particles, and what it does not show.
pub fn dressed(input: &Path, texts: &[String]) -> Result<(Mesh, Vec<String>), Refusal> {
    let name = input.display().to_string();
    let refuse = |message: String, expected: &str| {
        let message = format!("`{name}` cannot be dressed: {message}");
        Refusal::request("skin", name.clone(), expected, message)
    };
    let radius_is_missing =
        |message: String| refuse(message, "radius=LENGTH, and voxel=LENGTH where it is another");
    let known: Vec<&Parameter> = PARAMETERS.iter().collect();
    let values = parameters::values(texts, &known)?;
    let as_described = "parameters as `souple mesh skin --help` names them";
    let values = values.completed(PARAMETERS).map_err(|error| refuse(error.to_string(), as_described))?;
    let (radius, time) = (values.number("radius"), values.number("time"));
    let is_table = input.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("csv"));
    let mut notes = Vec::new();
    let particles: Vec<(Vec3, f64)> = if is_table {
        let rows = souple_io::read_particles(input)?;
        if radius > 0.0 && rows.iter().any(|row| row.radius.is_some()) {
            notes.push(format!(
                "all particles have the radius {radius} m that is given, not those of the file"
            ));
        }
        if let Some(row) = rows.iter().position(|row| radius == 0.0 && row.radius.is_none()) {
            return Err(radius_is_missing(format!(
                "`radius` is missing or 0, and particle {row} has none in the file"
            )));
        }
        let particle = |row: &souple_io::ParticleRow| Particle {
            position: row.position,
            velocity: row.velocity,
            radius: row.radius.filter(|_| radius == 0.0).unwrap_or(radius),
            during: row.during,
        };
        let there: Vec<(Vec3, f64)> = rows.iter().filter_map(|row| particle(row).at(time)).collect();
        if there.is_empty() && !rows.is_empty() {
            let from = rows.iter().map(|row| row.during[0]).fold(f64::INFINITY, f64::min);
            let until = rows.iter().map(|row| row.during[1]).fold(f64::NEG_INFINITY, f64::max);
            let message = format!("no particle is there at {time} s");
            return Err(refuse(message, &format!("time=SECONDS, from {from} s to before {until} s")));
        }
        there
    } else if radius == 0.0 {
        return Err(radius_is_missing(
            "`radius` is missing or 0, and the points of a mesh have none".to_owned(),
        ));
    } else {
        read(input)?.0.points.iter().map(|point| (*point, radius)).collect()
    };
    let smallest = particles.iter().map(|(_, radius)| *radius).fold(f64::INFINITY, f64::min);
    let voxel = if values.number("voxel") > 0.0 { values.number("voxel") } else { smallest };
    let iso = values.number("iso");
    let dressed = souple_skin::dress(&particles, voxel, iso)
        .map_err(|error| refuse(error.to_string(), "particles that a surface can go around"))?;
    if voxel > COARSE * smallest {
        notes.push(format!(
            "voxels of {voxel} m are larger than {COARSE} radii of {smallest} m: what is smaller than a voxel is lost"
        ));
    }
    let outside = particles.iter().filter(|(position, _)| !dressed.holds(*position)).count();
    if outside > 0 {
        notes.push(format!(
            "{outside} of {} particles are outside the surface: a lower `iso` than {iso}, a larger `radius` or smaller voxels would hold them",
            particles.len()
        ));
    }
    let surface = dressed.surface;
    let mut mesh = Mesh { points: surface.points, ..Mesh::default() };
    surface.triangles.iter().for_each(|corners| mesh.push_facet(ElementKind::Tri3, corners));
    Ok((mesh, notes))
}
