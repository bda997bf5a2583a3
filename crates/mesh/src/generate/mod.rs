//! Meshes made from a few numbers: bar, box, sphere, in every kind of cell and in mixes.
//!
//! Boxes are grids of cubes (`grid`), balls a grid in a shell of six (`ball`); each cube is `cut` into cells.

mod ball;
mod cuboid;
mod cut;
mod grid;

use souple_table::{Entry, Table, Values};

use crate::{Mesh, MeshError};

/// Constructor of a generated mesh from completed values.
pub type Build = fn(&Values) -> Result<Mesh, MeshError>;

/// All generators.
pub static GENERATORS: Table<Build> =
    Table { kind: "mesh generator", entries: &[&cuboid::BAR, &cuboid::BOX, &ball::SPHERE] };

type GeneratorEntry = Entry<Build>;

/// Most cells that a generator makes.
pub const MAX_CELLS: u64 = 50_000_000;

/// A generated mesh, by the name of its generator.
///
/// # Errors
/// The name or a parameter is unknown or out of range; more than [`MAX_CELLS`] cells.
pub fn generate(name: &str, values: Values) -> Result<Mesh, MeshError> {
    let entry = GENERATORS.find(name)?;
    (entry.build)(&entry.values(values)?)
}

#[cfg(test)]
mod tests;
