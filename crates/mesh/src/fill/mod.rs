//! Tetrahedra in any shape: isosurface stuffing (Labelle & Shewchuk 2007).
//!
//! A lattice of well shaped tetrahedra is laid over the shape (`lattice`, `background`), its points near the surface
//! are moved onto it (`warp`), and what is inside of each tetrahedron is written with few stencils (`stencil`). The
//! surface of the result follows the shape's to second order in the size; edges sharper than the size are bevelled.
//!
//! Dihedral angles lie between 10.7° and 164.8° for every shape and size. The bound is proven for a uniform
//! lattice. It holds for a graded one too, because every tetrahedron that touches a point of a smallest cube near
//! the surface is one of the uniform lattice, and the others are not moved: their angles, 45° to 120°, are those of
//! the halves, quarters and half pyramids as they stand.
//!
//! Where a size is given everywhere, cubes at the surface are of several sizes too. Points between sizes move by no more than
//! their smallest cubes allow, and diagonals follow one order around each corner outside: the filling conforms and nothing
//! is inverted, but angles are as they come out, and the mesh tells them.

mod background;
mod groups;
mod hexes;
mod lattice;
mod lost;
mod options;
mod pinched;
mod prisms;
mod stencil;
mod surface;
mod voxels;
mod warp;

use souple_math::Vec3;
use souple_table::four_digits;

use crate::implicit::Shape;
use crate::{ElementKind, Group, MAX_CELLS, Mesh, USUAL_SIZES, available_memory, gigabytes};

pub use options::{Filled, Options, PARAMETERS};
pub(crate) use surface::carry_groups;
pub use surface::{FilledSurface, fill_mesh, fill_surface, surface_of};

use lattice::Lattice;
use stencil::Stencils;

/// How large cells are.
pub struct Size {
    /// Edge of the lattice's smallest cubes [m], those at the surface but where a field holds there too: the longest edges of
    /// the tetrahedra have this length, the others are `√3/2` of it.
    pub smallest: f64,
    pub grading: Grading,
}

/// How large cells are elsewhere.
pub enum Grading {
    /// As at the surface.
    Uniform,
    /// Edges grow by `growth` for each length that one goes inward, up to `largest` [m].
    Inward { growth: f64, largest: f64 },
    /// Edges are at most as long as a function of the position says, and at most `largest` [m].
    Field { size: Box<dyn Fn(Vec3) -> f64 + Sync>, largest: f64, reach: Reach },
}

/// Where a function of the position says how large cells are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reach {
    /// Away from the surface, where cells are the smallest.
    Inside,
    /// At the surface too: the bounds on angles are not proven there.
    Everywhere,
}

/// What cells a shape is filled with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cells {
    Tetrahedra,
    /// Hexahedra inside, tetrahedra at the surface, prisms and pyramids between.
    HexDominant,
    /// Equal cubes alone, with a stair for a surface.
    Voxels,
}

impl Cells {
    /// How many a cube inside becomes.
    fn of_cube(self) -> f64 {
        match self {
            Self::Tetrahedra => 12.0,
            Self::HexDominant | Self::Voxels => 1.0,
        }
    }

    /// What a filling of about so many cells takes at least: lattice, mesh, and the mesh before where one comes near to a count
    /// [bytes]. Measured on the liver, 223 bytes for each of four million tetrahedra, 930 for each of a million cells of which most are
    /// hexahedra.
    pub fn memory(self, cells: f64) -> u64 {
        let of_cell = match self {
            Self::Tetrahedra => 220.0,
            Self::HexDominant | Self::Voxels => 900.0,
        };
        (of_cell * cells) as u64
    }

    fn check_memory(self, cells: f64, available: Option<u64>) -> Result<(), FillError> {
        let needed = self.memory(cells);
        match available {
            Some(available) if needed > available => Err(FillError::TooLarge { cells, needed, available }),
            _ => Ok(()),
        }
    }
}

/// A part of the filling that becomes a group of cells: those whose centre is inside a shape.
pub struct Part<'a> {
    pub name: &'a str,
    pub shape: &'a dyn Shape,
}

/// A shape that cannot be filled as asked.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FillError {
    #[error("the size of cells is {size} m; expected a length above 0")]
    Size { size: f64 },
    #[error("the shape's bounds go from {low:?} to {high:?}; expected a box of finite size")]
    Bounds { low: [f64; 3], high: [f64; 3] },
    #[error(
        "cells of {} m in a box of {} ask for {requested:.1e} lattice points; expected at most {limit:e}: a larger size{}",
        four_digits(*.size), metres(.extent), or_metres(.extent)
    )]
    TooManyPoints { size: f64, extent: [f64; 3], requested: f64, limit: f64 },
    #[error(
        "cells of {} m in a box of {} make about {requested:.1e} of them; expected at most {limit:.0e}: a larger size, or `growth`{}",
        four_digits(*.size), metres(.extent), or_metres(.extent)
    )]
    TooManyCells { size: f64, extent: [f64; 3], requested: f64, limit: f64 },
    #[error(
        "about {cells:.1e} cells take {} of memory to make, and {} are available on this machine; expected fewer: a larger size, or `growth`",
        gigabytes(*.needed), gigabytes(*.available)
    )]
    TooLarge { cells: f64, needed: u64, available: u64 },
    #[error("the shape has no value at {position:?}; expected a number: negative inside, positive outside")]
    NotANumber { position: [f64; 3] },
    #[error("the shape is inside at {position:?}, on the border of its bounds; expected larger bounds")]
    BeyondBounds { position: [f64; 3] },
    #[error(
        "no cell of {} m is inside the shape, which was looked for in a box of {}: its least value there is {}, and inside it is below 0; expected a smaller size, or a shape with an inside",
        four_digits(*.size), metres(.extent), four_digits(*.least)
    )]
    Nothing { size: f64, extent: [f64; 3], least: f64 },
    #[error(
        "{count} cells cannot be had: in a box of {} the shape is so thin that cells of {} m are too large for it, and {requested:.1e} points of a lattice would be looked at for smaller ones; expected a `size` below its thickness, or a larger `count`",
        metres(.extent), four_digits(*.size)
    )]
    Thin { count: f64, size: f64, extent: [f64; 3], requested: f64 },
    #[error("the size of cells is {size} m at {position:?}; expected a length above 0")]
    SizeAt { size: f64, position: [f64; 3] },
    #[error(
        "no triangle of the surface has an area, of {triangles}; expected lengths and areas that numbers can hold"
    )]
    NoArea { triangles: usize },
    #[error("the surface is flat, it measures {}; expected one that encloses something", metres(.extent))]
    Flat { extent: [f64; 3] },
    #[error(
        "the surface encloses nothing that is certain: around {:.0} % of the places that it winds around at all it does so by no whole number ({}); expected a closed surface, or one with small holes",
        100.0 * .share, .causes.join("; ")
    )]
    Undefined { share: f64, causes: Vec<String> },
}

/// Lengths along the axes, in words.
fn metres(extent: &[f64; 3]) -> String {
    let [x, y, z] = extent.map(four_digits);
    format!("{x} x {y} x {z} m")
}

/// What else would do of a shape that is hardly in metres.
fn or_metres([x, y, z]: &[f64; 3]) -> &'static str {
    if x.max(*y).max(*z) > USUAL_SIZES[1] {
        "; or a shape in metres: one in millimetres takes scale = 0.001"
    } else {
        ""
    }
}

impl Size {
    pub fn uniform(smallest: f64) -> Self {
        Self { smallest, grading: Grading::Uniform }
    }

    fn coarsest_level(&self, limit: u8) -> u8 {
        let largest = match self.grading {
            Grading::Uniform => self.smallest,
            Grading::Inward { largest, .. } | Grading::Field { largest, .. } => largest,
        };
        // the slack keeps a ratio of exactly two from being rounded to less
        let ratio = (largest / self.smallest * (1.0 + 1e-12)).max(1.0);
        if ratio.is_finite() { (ratio.log2().floor() as u8).min(limit) } else { 0 }
    }

    /// Edge of the lattice with which a body of a volume [m³] has about as many tetrahedra: twelve to a cube.
    pub fn for_count(volume: f64, tetrahedra: f64) -> f64 {
        (12.0 * volume / tetrahedra).cbrt()
    }

    /// About how many tetrahedra a body of a volume [m³] has on a lattice of an edge [m].
    pub fn count_for(volume: f64, edge: f64) -> f64 {
        12.0 * volume / edge.powi(3)
    }
}

/// The mesh of a shape. Group `surface` holds the points of the boundary, each part is a group of cells and points.
///
/// The result is the same for any number of threads.
///
/// # Errors
/// The size, the bounds or a value of the shape cannot be used; nothing of the lattice is inside.
pub fn fill(shape: &dyn Shape, size: &Size, cells: Cells, parts: &[Part<'_>]) -> Result<Mesh, FillError> {
    let lattice = Lattice::new(shape, size)?;
    // twelve tetrahedra to a cube
    let requested = 12.0 * lattice.inside_count() as f64;
    if requested > MAX_CELLS as f64 {
        let (size, extent) = (size.smallest, shape.bounds().size().to_array());
        return Err(FillError::TooManyCells { size, extent, requested, limit: MAX_CELLS as f64 });
    }
    cells.check_memory(lattice.inside_count() as f64 * cells.of_cube(), available_memory())?;
    let mut mesh = match cells {
        Cells::Tetrahedra => tetrahedra(&lattice, shape),
        Cells::HexDominant => hexes::hex_dominant(&lattice, shape),
        Cells::Voxels => voxels::voxels(shape, size.smallest),
    };
    if mesh.cell_count() == 0 {
        let extent = shape.bounds().size().to_array();
        return Err(FillError::Nothing { size: size.smallest, extent, least: lattice.least_value() });
    }
    mesh.remove_loose_points();
    mesh.groups.insert(
        groups::SURFACE.to_owned(),
        Group { points: mesh.boundary_surface().mesh_points, ..Group::default() },
    );
    let centres = if parts.is_empty() { Vec::new() } else { mesh.cell_centres() };
    for Part { name, shape } in parts {
        let group = group_of_cells(&mesh, &centres, *shape);
        mesh.groups.insert((*name).to_owned(), group);
    }
    Ok(mesh)
}

fn tetrahedra(lattice: &Lattice, shape: &dyn Shape) -> Mesh {
    let mut background = lattice.background();
    let warped = warp::warp(&mut background, shape);
    let mut stencils = Stencils::new(&background, &warped);
    for tet in &background.tets {
        stencils.fill(*tet);
    }
    let nodes = std::mem::take(&mut stencils.tets).into_flattened();
    let cuts = warped.cuts.iter().map(|cut| cut.position);
    let points = background.points.iter().copied().chain(cuts).collect();
    Mesh::new(points, ElementKind::Tet4, nodes)
}

fn group_of_cells(mesh: &Mesh, centres: &[Vec3], shape: &dyn Shape) -> Group {
    let cells: Vec<u32> =
        (0..centres.len() as u32).filter(|cell| shape.value(centres[*cell as usize]) < 0.0).collect();
    let mut points: Vec<u32> =
        cells.iter().filter_map(|cell| mesh.cell(*cell)).flat_map(|cell| cell.nodes).copied().collect();
    points.sort_unstable();
    points.dedup();
    Group { points, cells, ..Group::default() }
}

#[cfg(test)]
mod tests;
