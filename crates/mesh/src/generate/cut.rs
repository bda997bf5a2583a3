//! How a cube is cut into cells of each kind, faces matching those of its neighbours.

use std::collections::BTreeMap;

use souple_math::Vec3;
use souple_table::{Kind, Parameter, Value, Values};

use crate::{CellBlock, ElementKind, Mesh, MeshSize, NodePlace};

/// How a cube is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cut {
    /// Six tetrahedra around the diagonal (Kuhn).
    Tetrahedra,
    Hexahedra,
    /// Two prisms with their axes along x where nothing else is said, triangles in the plane of y and z.
    Prisms,
    /// Six pyramids with their apices at the centre of the cube.
    Pyramids,
    /// The same, each cut in two tetrahedra.
    Centred,
    /// Zones of hexahedra, one layer of pyramids, tetrahedra, prisms; conforming.
    Mixed,
}

/// Names of cells; the last one is of grids of cubes alone.
const CHOICES: [&str; 13] = [
    "tet4",
    "hex8",
    "prism6",
    "pyramid5",
    "mixed",
    "tet10",
    "hex20",
    "hex27",
    "prism15",
    "pyramid13",
    "mixed_quadratic",
    "tet4_centred",
    "tet4_mirrored",
];

impl Cut {
    pub(super) const PARAMETER: Parameter = Parameter {
        name: "element",
        summary: "kind of cells; `mixed` has all four kinds, conforming; `tet4_centred` are twelve tetrahedra around the centre of each cube",
        kind: Kind::Choice(CHOICES.split_at(CHOICES.len() - 1).0),
        unit: "",
        range: souple_table::Range::ANY,
        default: Some(Value::Text("tet4")),
    };

    /// Of grids of cubes, which know where each cube is.
    pub(super) const PARAMETER_OF_GRIDS: Parameter = Parameter {
        summary: "kind of cells; `mixed` has all four kinds, conforming; `tet4_centred` are twelve tetrahedra around the centre of each cube, `tet4_mirrored` six as of `tet4`, in every second cube along each axis mirrored",
        kind: Kind::Choice(&CHOICES),
        ..Self::PARAMETER
    };

    pub(super) fn from_values(values: &Values) -> Self {
        let name = values.text("element");
        match (name, ElementKind::from_name(name).map(ElementKind::corners)) {
            (_, Ok(ElementKind::Tet4)) => Self::Tetrahedra,
            (_, Ok(ElementKind::Hex8)) => Self::Hexahedra,
            (_, Ok(ElementKind::Prism6)) => Self::Prisms,
            (_, Ok(ElementKind::Pyramid5)) => Self::Pyramids,
            ("tet4_mirrored", _) => Self::Tetrahedra,
            ("mixed" | "mixed_quadratic", _) => Self::Mixed,
            ("tet4_centred", _) => Self::Centred,
            (other, _) => unreachable!("`{other}` is not among the declared choices"),
        }
    }

    /// The most points of a mesh raised to nodes in the middles of parts up to `most`, for each of the linear one.
    fn raised_per_point(self, most: NodePlace) -> u64 {
        match self {
            _ if most == NodePlace::Corner => 1,
            // three edges along the axes for each point, three faces across them, and a cell
            Self::Hexahedra => [1, 4, 7, 8][most as usize],
            // one across the faces of triangles
            Self::Prisms => 5,
            // three edges of a cube and eight to its centre, for two points
            Self::Pyramids | Self::Centred => 7,
            // three along the axes, three across faces, one through the cube
            Self::Tetrahedra | Self::Mixed => 8,
        }
    }

    pub(super) fn cells_per_cube(self) -> u64 {
        match self {
            Self::Hexahedra => 1,
            Self::Prisms => 2,
            Self::Tetrahedra | Self::Pyramids => 6,
            Self::Centred => 12,
            // five pyramids and two tetrahedra in the layer between
            Self::Mixed => 7,
        }
    }
}

/// In the middles of what the cells asked for have nodes.
pub(super) fn last_place(values: &Values) -> NodePlace {
    match values.text("element") {
        "mixed_quadratic" => NodePlace::Edge,
        name => ElementKind::from_name(name).map_or(NodePlace::Corner, ElementKind::last_place),
    }
}

/// The mesh in the order asked for; `place` gives the middle of an edge from its ends.
pub(super) fn in_order(values: &Values, mesh: Mesh, place: impl Fn([Vec3; 2]) -> Vec3) -> Mesh {
    match last_place(values) {
        NodePlace::Corner => mesh,
        most => mesh.raised(most, place),
    }
}

/// The size of that mesh from the linear one's: at most so many points.
pub(super) fn size_in_order(values: &Values, size: MeshSize) -> MeshSize {
    let per_point = Cut::from_values(values).raised_per_point(last_place(values));
    MeshSize { points: size.points * per_point, ..size }
}

/// The middle of a straight edge.
pub(super) fn middle([a, b]: [Vec3; 2]) -> Vec3 {
    (a + b) * 0.5
}

/// The middle of an edge of which both ends are as far from `centre`: on the arc between them. Others are straight.
pub(super) fn on_arc(ends: [Vec3; 2], centre: Vec3) -> Vec3 {
    let [a, b] = ends.map(|end| (end - centre).length());
    let straight = middle(ends);
    if (a - b).abs() > 1e-9 * a.max(b) {
        return straight;
    }
    (straight - centre).try_normalised().map_or(straight, |ray| centre + ray * (0.5 * (a + b)))
}

/// Axis permutations in the order that numbers the tetrahedra of a cube; odd ones are mirrored.
const KUHN: [([usize; 3], Parity); 6] = [
    ([0, 1, 2], Parity::Even),
    ([0, 2, 1], Parity::Odd),
    ([1, 0, 2], Parity::Odd),
    ([1, 2, 0], Parity::Even),
    ([2, 0, 1], Parity::Even),
    ([2, 1, 0], Parity::Odd),
];

/// Whether an even or an odd number of mirrors has been at work.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Parity {
    Even,
    Odd,
}

impl Parity {
    pub(super) fn of(mirrors: usize) -> Self {
        if mirrors.is_multiple_of(2) { Self::Even } else { Self::Odd }
    }
}

/// Corners of a cube in the node order of the hexahedron.
pub(super) const CORNERS: [[usize; 3]; 8] =
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];

/// Faces of the cube as bases of pyramids, normal inward: seen from the centre, counterclockwise.
const BASES: [[usize; 4]; 6] =
    [[0, 1, 2, 3], [4, 7, 6, 5], [0, 4, 5, 1], [1, 5, 6, 2], [2, 6, 7, 3], [3, 7, 4, 0]];
/// Faces of `BASES` by the axis of the cube that they end.
pub(super) const BASE_X_MAX: usize = 3;
pub(super) const BASE_X_MIN: usize = 5;
pub(super) const BASE_Y_MAX: usize = 4;
pub(super) const BASE_Z_MAX: usize = 1;

/// One block for each kind, so that a mesh has few.
#[derive(Default)]
pub(super) struct Blocks(BTreeMap<ElementKind, Vec<u32>>);

impl Blocks {
    pub(super) fn push(&mut self, kind: ElementKind, nodes: &[u32]) {
        self.0.entry(kind).or_default().extend_from_slice(nodes);
    }

    /// For each permutation of the axes: from the corner (0,0,0) along the axes in that order to (1,1,1), of a cube whose corners
    /// are numbered in a frame of this parity.
    pub(super) fn kuhn_tetrahedra(&mut self, corners: [u32; 8], frame: Parity) {
        for (axes, parity) in KUHN {
            let mut at = [0; 3];
            let mut nodes = [corners[0]; 4];
            for (step, axis) in axes.into_iter().enumerate() {
                at[axis] = 1;
                nodes[step + 1] = corners[CORNERS.iter().position(|corner| *corner == at).unwrap_or(0)];
            }
            if parity != frame {
                nodes.swap(2, 3);
            }
            self.push(ElementKind::Tet4, &nodes);
        }
    }

    /// Six tetrahedra from the corner of lowest number to the halves of the three faces that do not hold it. Each
    /// face of the cube is cut at its corner of lowest number, so that cubes in any position conform.
    pub(super) fn numbered_tetrahedra(&mut self, c: [u32; 8]) {
        let lowest = c.into_iter().min().unwrap_or(c[0]);
        for base in BASES {
            let corners = base.map(|corner| c[corner]);
            if !corners.contains(&lowest) {
                let [p, q, r, s] = from_lowest(corners);
                self.push(ElementKind::Tet4, &[p, q, r, lowest]);
                self.push(ElementKind::Tet4, &[p, r, s, lowest]);
            }
        }
    }

    /// Two prisms from one face to the opposite, cut at the corner of lowest number of the first.
    pub(super) fn prisms_towards(&mut self, c: [u32; 8], end: usize) {
        let far = BASES[end];
        // the bases of opposite faces hold opposite corners in other places: found by the edges between them
        let near = far.map(|corner| across(corner, end));
        let first = (0..4).min_by_key(|place| c[near[*place]]).unwrap_or(0);
        // far is clockwise seen along the axis of the prism: read backwards
        let at = |nodes: [usize; 4], step: usize| c[nodes[(first + 4 - step) % 4]];
        for [p, q, r] in [[0, 1, 2], [0, 2, 3]] {
            let nodes = [at(near, p), at(near, q), at(near, r), at(far, p), at(far, q), at(far, r)];
            self.push(ElementKind::Prism6, &nodes);
        }
    }

    /// The faces across x are cut along the diagonal from (y, z) = (0, 0) to (1, 1), as `kuhn_tetrahedra` cuts them.
    pub(super) fn prisms(&mut self, c: [u32; 8]) {
        self.push(ElementKind::Prism6, &[c[0], c[3], c[7], c[1], c[2], c[6]]);
        self.push(ElementKind::Prism6, &[c[0], c[7], c[4], c[1], c[6], c[5]]);
    }

    /// A pyramid on each face; on the face `split`, two tetrahedra cut at its corner of lowest number.
    pub(super) fn pyramids(&mut self, c: [u32; 8], centre: u32, split: Option<usize>) {
        for (face, base) in BASES.into_iter().enumerate() {
            let [p, q, r, s] = base.map(|corner| c[corner]);
            if split == Some(face) {
                let [p, q, r, s] = from_lowest([p, q, r, s]);
                self.push(ElementKind::Tet4, &[p, q, r, centre]);
                self.push(ElementKind::Tet4, &[p, r, s, centre]);
            } else {
                self.push(ElementKind::Pyramid5, &[p, q, r, s, centre]);
            }
        }
    }

    /// Twelve tetrahedra from the halves of the faces to the centre; each face is cut at its corner of lowest number, as its neighbour cuts it.
    pub(super) fn centred_tetrahedra(&mut self, c: [u32; 8], centre: u32) {
        for base in BASES {
            let [p, q, r, s] = from_lowest(base.map(|corner| c[corner]));
            self.push(ElementKind::Tet4, &[p, q, r, centre]);
            self.push(ElementKind::Tet4, &[p, r, s, centre]);
        }
    }

    pub(super) fn list(self) -> Vec<CellBlock> {
        self.0.into_iter().map(|(kind, nodes)| CellBlock { kind, nodes }).collect()
    }
}

/// The corners of a face in the same sense, starting at the one of lowest number.
fn from_lowest(corners: [u32; 4]) -> [u32; 4] {
    let first = (0..4).min_by_key(|place| corners[*place]).unwrap_or(0);
    [0, 1, 2, 3].map(|step| corners[(first + step) % 4])
}

/// The corner at the other end of the edge that leaves face `base` at `corner`.
fn across(corner: usize, base: usize) -> usize {
    let face = BASES[base].map(|node| CORNERS[node]);
    let axis = (0..3).find(|axis| face.iter().all(|node| node[*axis] == face[0][*axis])).unwrap_or(0);
    let mut at = CORNERS[corner];
    at[axis] = 1 - at[axis];
    CORNERS.iter().position(|node| *node == at).unwrap_or(corner)
}
