//! Solid balls: a grid of cubes on `[-1, 1]³`, mapped smoothly.

use souple_math::Vec3;
use souple_table::{Parameter, Range, Value, Values};

use super::grid::{Cut, Grid};
use super::{Build, GeneratorEntry};
use crate::{Group, Mesh, MeshError};

pub(super) static SPHERE: GeneratorEntry = GeneratorEntry {
    name: "sphere",
    summary: "solid ball; group `surface` holds the points on the sphere",
    source: "Nowell 2005 (mapping of a cube to a ball)",
    parameters: &[
        Parameter::number("radius", "m", Range::POSITIVE, "radius of the ball"),
        Parameter::integer("cells", Range::at_least(1.0), "number of cubes along the diameter"),
        Cut::PARAMETER,
        Parameter::vector("centre", "m", "centre of the ball").or(Value::Vector([0.0; 3])),
    ],
    build: ball as Build,
};

fn ball(values: &Values) -> Result<Mesh, MeshError> {
    let (radius, centre) = (values.number("radius"), Vec3::from_array(values.vector("centre")));
    let grid = Grid::new("cells", [values.integer("cells") as f64; 3], Cut::from_values(values))?;
    let mut mesh = grid.mesh(|unit| centre + ball_from_cube(unit * 2.0 - Vec3::new(1.0, 1.0, 1.0)) * radius);
    mesh.groups.clear();
    mesh.groups.insert("surface".to_owned(), Group { points: grid.outside(), ..Group::default() });
    Ok(mesh)
}

/// Maps `[-1, 1]³` to the unit ball: `x' = x √(1 - y²/2 - z²/2 + y²z²/3)` and likewise for the others.
/// `1 - |x'|² = (1-x²)(1-y²)(1-z²)`: the outside of the cube lands exactly on the sphere.
fn ball_from_cube(p: Vec3) -> Vec3 {
    let squares = Vec3::new(p.x * p.x, p.y * p.y, p.z * p.z);
    let factor = |a: f64, b: f64| (1.0 - 0.5 * a - 0.5 * b + a * b / 3.0).sqrt();
    Vec3::new(
        p.x * factor(squares.y, squares.z),
        p.y * factor(squares.z, squares.x),
        p.z * factor(squares.x, squares.y),
    )
}
