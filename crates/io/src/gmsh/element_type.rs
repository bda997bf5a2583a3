//! The element types of Gmsh by number.

use souple_mesh::{ElementKind, MAX_NODES};

/// What a type number stands for.
#[derive(Clone, Copy, Debug)]
pub(super) struct ElementType {
    pub number: i64,
    pub name: &'static str,
    /// Dimension of the entity it meshes, 0 to 3.
    pub dimension: u8,
    pub node_count: usize,
    /// The element of ours, where there is one.
    pub kind: Option<ElementKind>,
}

const fn ours(number: i64, name: &'static str, kind: ElementKind, dimension: u8) -> ElementType {
    ElementType { number, name, dimension, node_count: kind.node_count(), kind: Some(kind) }
}

const fn other(number: i64, name: &'static str, dimension: u8, node_count: usize) -> ElementType {
    ElementType { number, name, dimension, node_count, kind: None }
}

/// All types up to the fifth order in the plane and the third in space.
const TYPES: &[ElementType] = &[
    ours(1, "line of 2 nodes", ElementKind::Edge2, 1),
    ours(2, "triangle of 3 nodes", ElementKind::Tri3, 2),
    ours(3, "quadrangle of 4 nodes", ElementKind::Quad4, 2),
    ours(4, "tetrahedron of 4 nodes", ElementKind::Tet4, 3),
    ours(5, "hexahedron of 8 nodes", ElementKind::Hex8, 3),
    ours(6, "prism of 6 nodes", ElementKind::Prism6, 3),
    ours(7, "pyramid of 5 nodes", ElementKind::Pyramid5, 3),
    ours(8, "line of 3 nodes", ElementKind::Edge3, 1),
    ours(9, "triangle of 6 nodes", ElementKind::Tri6, 2),
    ours(10, "quadrangle of 9 nodes", ElementKind::Quad9, 2),
    ours(11, "tetrahedron of 10 nodes", ElementKind::Tet10, 3),
    ours(12, "hexahedron of 27 nodes", ElementKind::Hex27, 3),
    other(13, "prism of 18 nodes", 3, 18),
    other(14, "pyramid of 14 nodes", 3, 14),
    other(15, "point", 0, 1),
    ours(16, "quadrangle of 8 nodes", ElementKind::Quad8, 2),
    ours(17, "hexahedron of 20 nodes", ElementKind::Hex20, 3),
    ours(18, "prism of 15 nodes", ElementKind::Prism15, 3),
    ours(19, "pyramid of 13 nodes", ElementKind::Pyramid13, 3),
    other(20, "triangle of 9 nodes", 2, 9),
    other(21, "triangle of 10 nodes", 2, 10),
    other(22, "triangle of 12 nodes", 2, 12),
    other(23, "triangle of 15 nodes", 2, 15),
    other(24, "triangle of 15 nodes", 2, 15),
    other(25, "triangle of 21 nodes", 2, 21),
    other(26, "line of 4 nodes", 1, 4),
    other(27, "line of 5 nodes", 1, 5),
    other(28, "line of 6 nodes", 1, 6),
    other(29, "tetrahedron of 20 nodes", 3, 20),
];

/// The type of a point.
pub(super) const POINT: i64 = 15;

pub(super) fn find(number: i64) -> Option<ElementType> {
    TYPES.iter().copied().find(|element| element.number == number)
}

/// The number of an element of ours; `None` for elements that Gmsh has no type of.
pub(super) fn number_of(kind: ElementKind) -> Option<i64> {
    TYPES.iter().find(|element| element.kind == Some(kind)).map(|element| element.number)
}

/// The node of Gmsh's list that each of our nodes is. Corners agree; Gmsh lists the middles of edges by the corner of
/// lowest number, we by the faces around (as VTK does), and those of faces from the bottom around, we across x, y and z.
pub(super) fn order(kind: ElementKind) -> &'static [u8] {
    const PLAIN: [u8; 20] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19];
    match kind {
        ElementKind::Tet10 => &[0, 1, 2, 3, 4, 5, 6, 7, 9, 8],
        ElementKind::Hex20 => &[0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15],
        ElementKind::Hex27 => &[
            0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15, 22, 23, 21, 24, 20, 25, 26,
        ],
        ElementKind::Prism15 => &[0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11],
        ElementKind::Pyramid13 => &[0, 1, 2, 3, 4, 5, 8, 10, 6, 7, 9, 11, 12],
        _ => &PLAIN[..kind.node_count()],
    }
}

/// Our nodes of an element of a type in the order of Gmsh.
pub(super) fn listed(number: i64, nodes: &[u32]) -> impl Iterator<Item = u32> {
    let mut theirs = [0; MAX_NODES];
    match find(number).and_then(|element| element.kind) {
        Some(kind) => {
            for (node, place) in nodes.iter().zip(order(kind)) {
                theirs[usize::from(*place)] = *node;
            }
        }
        None => theirs[..nodes.len()].copy_from_slice(nodes),
    }
    theirs.into_iter().take(nodes.len())
}
