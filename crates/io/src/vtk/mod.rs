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

pub use series::{Series, SeriesPart, read_series, read_series_bytes};

pub(crate) use legacy::VTK_LEGACY;
pub(crate) use vtu::VTU;
pub(crate) use xml::escape;

use souple_mesh::ElementKind;

use crate::IoError;
use crate::dataset::{Facets, Output};

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
    CellType { number: 22, kind: ElementKind::Tri6, order: PLAIN.split_at(6).0 },
    CellType { number: 23, kind: ElementKind::Quad8, order: PLAIN.split_at(8).0 },
    CellType { number: 24, kind: ElementKind::Tet10, order: PLAIN.split_at(10).0 },
    CellType { number: 25, kind: ElementKind::Hex20, order: PLAIN.split_at(20).0 },
    CellType { number: 26, kind: ElementKind::Prism15, order: PLAIN.split_at(15).0 },
    CellType { number: 27, kind: ElementKind::Pyramid13, order: PLAIN.split_at(13).0 },
    CellType { number: 28, kind: ElementKind::Quad9, order: PLAIN.split_at(9).0 },
    CellType { number: 29, kind: ElementKind::Hex27, order: PLAIN },
];

/// Edges, which are cells where a grid has nothing else, and left out beside other cells.
const EDGE_TYPES: [CellType; 2] = [
    CellType { number: 3, kind: ElementKind::Edge2, order: PLAIN.split_at(2).0 },
    CellType { number: 21, kind: ElementKind::Edge3, order: PLAIN.split_at(3).0 },
];

/// Nodes of quadratic cells: VTK lists them as we do.
const PLAIN: &[usize] =
    &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26];

/// The type of polygons of any number of corners.
const POLYGON: i64 = 7;

/// Types that hold no volume and no facet of ours: vertices, lines, strips, polygons of two corners, curved curves and some
/// facets.
const WITHOUT_VOLUME: &[i64] = &[0, 1, 2, 3, 4, 6, 7, 21, 30, 34, 35, 36];

/// The number of the VTK type of an element.
fn cell_type_of(kind: ElementKind) -> Option<u8> {
    let identity =
        |cell: &&CellType| cell.kind == kind && cell.order.iter().enumerate().all(|(i, n)| i == *n);
    CELL_TYPES.iter().chain(&EDGE_TYPES).find(identity).map(|cell| cell.number as u8)
}

/// A group as numbers 0 and 1.
struct MarkedGroup<'a> {
    name: &'a str,
    /// Where the group has points, or nothing at all: it is kept by its name.
    on_points: Option<Vec<u8>>,
    /// Cells, then facets, where the group has any.
    on_cells: Option<Vec<u8>>,
}

/// All groups with what is written of them.
fn group_marks<'a>(output: &Output<'a>) -> Result<Vec<MarkedGroup<'a>>, IoError> {
    let mesh = output.mesh;
    let facets_written = output.facets == Facets::Written;
    let facet_count = if facets_written { mesh.facet_count() } else { 0 };
    let mut marked = Vec::with_capacity(mesh.groups.len());
    for (name, group) in &mesh.groups {
        let facets = if facets_written { group.facets.as_slice() } else { &[] };
        let has_cells = !group.cells.is_empty() || !facets.is_empty();
        let on_points = (!group.points.is_empty() || !has_cells)
            .then(|| marks(name, &group.points, mesh.points.len()))
            .transpose()?;
        let on_cells = has_cells
            .then(|| {
                Ok::<_, IoError>([
                    marks(name, &group.cells, mesh.cell_count())?,
                    marks(name, facets, facet_count)?,
                ])
            })
            .transpose()?
            .map(|lists| lists.concat());
        marked.push(MarkedGroup { name, on_points, on_cells });
    }
    Ok(marked)
}

/// One for each member, zero for the others.
fn marks(name: &str, members: &[u32], count: usize) -> Result<Vec<u8>, IoError> {
    let mut marks = vec![0; count];
    for member in members {
        let slot = marks.get_mut(*member as usize).ok_or_else(|| {
            IoError::request(
                format!("a member of the group `{name}`"),
                member,
                format!("a number below {count}"),
            )
        })?;
        *slot = 1;
    }
    Ok(marks)
}
