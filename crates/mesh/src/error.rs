//! What can be wrong with a mesh.

use souple_table::{counted, in_number};

use crate::ElementKind;

/// A mesh, or a request for one, that cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshError {
    #[error("the mesh has no points; expected at least one cell and its points")]
    NoPoints,
    #[error("the mesh has no cells; expected at least one cell, such as tet4 or hex20")]
    NoCells,
    #[error("points[{point}] is ({}, {}, {}); expected finite coordinates", .position[0], .position[1], .position[2])]
    PointNotFinite { point: u32, position: [f64; 3] },
    #[error("the mesh has {count} points; expected at most {}", u32::MAX)]
    TooManyPoints { count: usize },
    #[error("{kind} block holds {count} node numbers; expected a multiple of {}", .kind.node_count())]
    BlockLength { kind: ElementKind, count: usize },
    #[error("{list}[{cell}] ({kind}) refers to point {point}, but the mesh has {}", counted(*.point_count as u64, "point"))]
    MissingPoint { list: &'static str, cell: u32, kind: ElementKind, point: u32, point_count: usize },
    #[error("{list}[{cell}] ({kind}) has point {point} twice; expected {} different points", .kind.node_count())]
    DuplicateNode { list: &'static str, cell: u32, kind: ElementKind, point: u32 },
    #[error("{list} has a block of {kind}; expected elements of dimension {dimension} only")]
    WrongDimension { list: &'static str, kind: ElementKind, dimension: usize },
    #[error(
        "cells[{cell}] ({kind}) is flat: volume {volume:e} m³ for a size of {size:e} m; expected a positive volume"
    )]
    FlatCell { cell: u32, kind: ElementKind, volume: f64, size: f64 },
    #[error(
        "cells[{cell}] ({kind}) is tangled: its Jacobian determinant goes from {lowest:e} to {highest:e}; \
         expected one sign (wrong order of nodes, or a concave cell)"
    )]
    TangledCell { cell: u32, kind: ElementKind, lowest: f64, highest: f64 },
    #[error("group `{group}` refers to {list}[{index}], but the mesh has {count}")]
    GroupOutOfRange { group: String, list: &'static str, index: u32, count: usize },
    #[error("the face between cells {cells:?} (points {nodes:?}) is used {} times; expected at most 2", .cells.len())]
    FaceUsedTooOften { cells: Vec<u32>, nodes: Vec<u32> },
    #[error(
        "cells[{cell}] meets cells {triangle_cells:?} by a quadrilateral cut in two triangles; \
         expected a pyramid between them"
    )]
    QuadrilateralMeetsTriangles { cell: u32, triangle_cells: [u32; 2] },
    #[error(
        "the surface is open or badly oriented at the edge between points {a} and {b}: {} along it \
         and {backward} against it; expected one of each", in_number(*.forward as usize, "triangle runs", "triangles run")
    )]
    OpenSurface { a: u32, b: u32, forward: u32, backward: u32 },
    #[error("triangles[{triangle}] has no area; expected three points that are not on one line")]
    FlatTriangle { triangle: u32 },
    #[error(
        "triangles[{}] and triangles[{}] pass through each other, and one is of a part that faces inward, of which it is \
         not known what it is a hollow of; expected hollows that cross nothing", .crossing[0], .crossing[1]
    )]
    CrossedHollow { crossing: [u32; 2] },
    #[error("{list} has a block of {kind}, which is not split; expected {expected} only")]
    NotSplit { list: &'static str, kind: ElementKind, expected: ElementKind },
    #[error("`{name}` is {value}; expected {expected}")]
    Parameter { name: &'static str, value: String, expected: String },
    #[error("{requested} cells were asked for; expected at most {limit}")]
    TooManyCells { requested: f64, limit: u64 },
    #[error(transparent)]
    Fill(#[from] crate::fill::FillError),
    #[error(transparent)]
    Value(#[from] souple_table::ValueError),
    #[error(transparent)]
    UnknownGenerator(#[from] souple_table::UnknownName),
}

impl MeshError {
    /// What is wrong, and what would be accepted where that is told.
    pub fn in_two(&self) -> (String, Option<String>) {
        let told = self.to_string();
        match told.split_once("; expected ") {
            Some((wrong, accepted)) => (wrong.to_owned(), Some(accepted.to_owned())),
            None => (told, None),
        }
    }
}
