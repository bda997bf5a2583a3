//! Bars and boxes: grids of cubes stretched to a size.

use souple_math::Vec3;
use souple_table::{Parameter, Value, Values};

use super::cut::{Cut, in_order, middle, size_in_order};
use super::disorder::Disorder;
use super::grid::{Diagonals, Grid};
use super::{Build, GeneratorEntry};
use crate::{Mesh, MeshError};

const SIZE: Parameter = Parameter::vector("size", "m", "lengths along x, y, z");
const CELLS: Parameter = Parameter::vector("cells", "", "numbers of cubes along x, y, z (whole numbers)");
const ORIGIN: Parameter =
    Parameter::vector("origin", "m", "the corner of least x, y, z").or(Value::Vector([0.0; 3]));

pub(super) static BAR: GeneratorEntry = GeneratorEntry {
    name: "bar",
    summary: "bar along x from the origin; groups x_min, x_max, y_min, …",
    source: "Kuhn 1960 for the tetrahedra",
    parameters: &[SIZE, CELLS, Cut::PARAMETER_OF_GRIDS, ORIGIN, Disorder::PARAMETER, Disorder::SEED],
    build: BUILD,
};

pub(super) static BOX: GeneratorEntry = GeneratorEntry {
    name: "box",
    summary: "box from its lowest corner; groups x_min, x_max, y_min, …",
    source: "Kuhn 1960 for the tetrahedra",
    parameters: &[SIZE, CELLS, Cut::PARAMETER_OF_GRIDS, ORIGIN, Disorder::PARAMETER, Disorder::SEED],
    build: BUILD,
};

const BUILD: Build = Build { size: |values| Ok(size_in_order(values, grid(values)?.size())), mesh: cuboid };

fn grid(values: &Values) -> Result<Grid, MeshError> {
    let is_mirrored = values.text("element") == "tet4_mirrored";
    let diagonals = if is_mirrored { Diagonals::Mirrored } else { Diagonals::Parallel };
    let grid = Grid::new("cells", values.vector("cells"), Cut::from_values(values))?;
    Ok(grid.with_diagonals(diagonals).with_disorder(Disorder::from_values(values)))
}

fn cuboid(values: &Values) -> Result<Mesh, MeshError> {
    let size = values.vector("size");
    if !size.iter().all(|length| *length > 0.0) {
        let value = Value::Vector(size).to_string();
        return Err(MeshError::Parameter {
            name: "size",
            value,
            expected: "three lengths above 0 [m]".to_owned(),
        });
    }
    let (origin, size) = (Vec3::from_array(values.vector("origin")), Vec3::from_array(size));
    let grid = grid(values)?;
    // origin + size ξ, with ξ = i/n computed first: the corners are exact
    let mesh = grid.mesh(|unit| origin + Vec3::new(size.x * unit.x, size.y * unit.y, size.z * unit.z));
    Ok(in_order(values, mesh, middle))
}
