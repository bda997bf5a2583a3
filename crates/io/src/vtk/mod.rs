//! VTK unstructured grids: XML (`.vtu`), series of them (`.pvd`), and the legacy format (`.vtk`).
//!
//! Groups of a mesh travel as arrays of 0 and 1 called `group:` and the name of the group.

mod array;
mod base64;
mod grid;
mod legacy;
mod series;
mod vtu;
mod vtu_write;
mod xml;

pub use series::Series;

pub(crate) use legacy::VTK_LEGACY;
pub(crate) use vtu::VTU;

use souple_mesh::ElementKind;

/// Prefix of the arrays that hold groups.
const GROUP_PREFIX: &str = "group:";

/// How cells of a VTK type become ours: the kind, and the node of theirs that each of ours is.
#[derive(Clone, Copy, Debug)]
struct CellType {
    number: i64,
    kind: ElementKind,
    order: &'static [usize],
}

/// Pixels and voxels are listed row by row, our quadrilaterals and hexahedra around.
const CELL_TYPES: &[CellType] = &[
    CellType { number: 5, kind: ElementKind::Tri3, order: &[0, 1, 2] },
    CellType { number: 8, kind: ElementKind::Quad4, order: &[0, 1, 3, 2] },
    CellType { number: 9, kind: ElementKind::Quad4, order: &[0, 1, 2, 3] },
    CellType { number: 10, kind: ElementKind::Tet4, order: &[0, 1, 2, 3] },
    CellType { number: 11, kind: ElementKind::Hex8, order: &[0, 1, 3, 2, 4, 5, 7, 6] },
    CellType { number: 12, kind: ElementKind::Hex8, order: &[0, 1, 2, 3, 4, 5, 6, 7] },
    CellType { number: 13, kind: ElementKind::Prism6, order: &[0, 1, 2, 3, 4, 5] },
    CellType { number: 14, kind: ElementKind::Pyramid5, order: &[0, 1, 2, 3, 4] },
];

/// Types that hold no volume and no facet of ours: vertices, lines, strips, polygons, curved curves and facets.
const WITHOUT_VOLUME: &[i64] = &[0, 1, 2, 3, 4, 6, 7, 21, 22, 23, 28, 30, 34, 35, 36];

/// The number of the VTK type of an element.
fn cell_type_of(kind: ElementKind) -> Option<u8> {
    let identity = |cell: &&CellType| cell.kind == kind && cell.order.iter().enumerate().all(|(i, n)| i == *n);
    CELL_TYPES.iter().find(identity).map(|cell| cell.number as u8)
}
