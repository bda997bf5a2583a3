//! Meshes made from a few numbers: bar, box, sphere, cylinder, shell, sheet, line, lattice, in every kind of cell and in mixes.
//!
//! Boxes are grids of cubes (`grid`), in `parts` of several kinds, balls a grid in a shell of six (`ball`), cylinders a section
//! swept (`cylinder`); each cube is `cut` into cells. Quadratic cells are linear ones raised, middles of edges on the
//! curve where there is one.

mod ball;
mod cuboid;
mod cut;
mod cylinder;
mod disorder;
mod grid;
mod lattice;
mod parts;
mod sheet;

use souple_table::{Entry, Table, Values};

use crate::{Mesh, MeshError};

/// A generator at work on completed values.
#[derive(Clone, Copy, Debug)]
pub struct Build {
    /// How large the mesh will be, without making it.
    pub size: fn(&Values) -> Result<MeshSize, MeshError>,
    pub mesh: fn(&Values) -> Result<Mesh, MeshError>,
}

/// Counts of a mesh that is not made yet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeshSize {
    pub points: u64,
    /// At most this many.
    pub cells: u64,
}

/// All generators.
pub static GENERATORS: Table<Build> = Table {
    kind: "mesh generator",
    entries: &[
        &cuboid::BAR,
        &cuboid::BOX,
        &parts::BAR_OF_PARTS,
        &ball::SPHERE,
        &ball::HOLLOW_SPHERE,
        &cylinder::CYLINDER,
        &cylinder::SHELL,
        &sheet::SHEET,
        &sheet::LINE,
        &lattice::LATTICE,
    ],
};

type GeneratorEntry = Entry<Build>;

/// Most cells that a generator makes.
pub const MAX_CELLS: u64 = 50_000_000;

/// A generated mesh, by the name of its generator.
///
/// # Errors
/// The name or a parameter is unknown or out of range; more than [`MAX_CELLS`] cells.
pub fn generate(name: &str, values: Values) -> Result<Mesh, MeshError> {
    let entry = GENERATORS.find(name)?;
    (entry.build.mesh)(&entry.values(values)?)
}

#[cfg(test)]
mod tests;
