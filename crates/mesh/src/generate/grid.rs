//! A grid of cubes, each cut into cells.
//!
//! Points are numbered `i + (nx+1)(j + (ny+1)k)`, cubes with `i` fastest, then `j`, then `k`; centres of cubes,
//! where a cut needs them, follow after all grid points in the order of their cubes.

use std::collections::BTreeMap;

use souple_math::Vec3;
use souple_table::{Kind, Parameter, Value, Values};

use crate::{CellBlock, ElementKind, Group, MAX_CELLS, Mesh, MeshError};

/// How a cube is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cut {
    /// Six tetrahedra around the diagonal (Kuhn).
    Tetrahedra,
    Hexahedra,
    /// Two prisms with their axes along x, triangles in the plane of y and z.
    Prisms,
    /// Six pyramids with their apices at the centre of the cube.
    Pyramids,
    /// Four zones along x: hexahedra, one layer of pyramids, tetrahedra, prisms; conforming.
    Mixed,
}

impl Cut {
    pub(super) const PARAMETER: Parameter = Parameter {
        name: "element",
        summary: "kind of cells; `mixed` has all four kinds, conforming, and needs at least 4 cubes along x",
        kind: Kind::Choice(&["tet4", "hex8", "prism6", "pyramid5", "mixed"]),
        unit: "",
        range: souple_table::Range::ANY,
        default: Some(Value::Text("tet4")),
    };

    pub(super) fn from_values(values: &Values) -> Self {
        match values.text("element") {
            "tet4" => Self::Tetrahedra,
            "hex8" => Self::Hexahedra,
            "prism6" => Self::Prisms,
            "pyramid5" => Self::Pyramids,
            "mixed" => Self::Mixed,
            other => unreachable!("`{other}` is not among the declared choices"),
        }
    }

    fn cells_per_cube(self) -> u64 {
        match self {
            Self::Hexahedra => 1,
            Self::Prisms => 2,
            Self::Tetrahedra | Self::Pyramids => 6,
            // five pyramids and two tetrahedra in the layer between
            Self::Mixed => 7,
        }
    }
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

#[derive(Clone, Copy, PartialEq)]
enum Parity {
    Even,
    Odd,
}

/// Corners of a cube in the node order of the hexahedron.
const CORNERS: [[usize; 3]; 8] =
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];

/// Faces of the cube as bases of pyramids, normal inward: seen from the centre, counterclockwise.
const BASES: [[usize; 4]; 6] =
    [[0, 1, 2, 3], [4, 7, 6, 5], [0, 4, 5, 1], [1, 5, 6, 2], [2, 6, 7, 3], [3, 7, 4, 0]];
/// The face of `BASES` at the end of greatest x.
const BASE_X_MAX: usize = 3;

pub(super) struct Grid {
    cells: [usize; 3],
    cut: Cut,
}

impl Grid {
    /// # Errors
    /// Counts that are not whole numbers of at least one, or too many cells.
    pub(super) fn new(name: &'static str, counts: [f64; 3], cut: Cut) -> Result<Self, MeshError> {
        let unfit = |expected: &str| {
            let value = Value::Vector(counts).to_string();
            MeshError::Parameter { name, value, expected: expected.to_owned() }
        };
        if !counts.iter().all(|count| *count >= 1.0 && count.fract() == 0.0) {
            return Err(unfit("three whole numbers of at least 1"));
        }
        // in floating point, where nothing overflows
        let requested = counts[0] * counts[1] * counts[2] * cut.cells_per_cube() as f64;
        if requested > MAX_CELLS as f64 {
            return Err(MeshError::TooManyCells { requested, limit: MAX_CELLS });
        }
        if cut == Cut::Mixed && counts[0] < 4.0 {
            return Err(unfit("at least 4 cubes along x for `mixed`"));
        }
        Ok(Self { cells: counts.map(|count| count as usize), cut })
    }

    /// The mesh with its points at `place(ξ)`, `ξ` in the unit cube.
    pub(super) fn mesh(&self, place: impl Fn(Vec3) -> Vec3) -> Mesh {
        let [nx, ny, nz] = self.cells;
        let unit = |i: f64, j: f64, k: f64| Vec3::new(i / nx as f64, j / ny as f64, k / nz as f64);
        let mut points = Vec::with_capacity((nx + 1) * (ny + 1) * (nz + 1));
        for k in 0..=nz {
            for j in 0..=ny {
                for i in 0..=nx {
                    points.push(place(unit(i as f64, j as f64, k as f64)));
                }
            }
        }
        let mut blocks = Blocks::default();
        for k in 0..nz {
            for j in 0..ny {
                for i in 0..nx {
                    let corners = CORNERS.map(|[a, b, c]| self.point(i + a, j + b, k + c));
                    let mut centre = || {
                        points.push(place(unit(i as f64 + 0.5, j as f64 + 0.5, k as f64 + 0.5)));
                        points.len() as u32 - 1
                    };
                    match self.zone(i) {
                        Zone::Uniform(Cut::Hexahedra) => blocks.push(ElementKind::Hex8, &corners),
                        Zone::Uniform(Cut::Prisms) => blocks.prisms(corners),
                        Zone::Uniform(Cut::Pyramids) => blocks.pyramids(corners, centre(), None),
                        Zone::Uniform(Cut::Tetrahedra | Cut::Mixed) => blocks.tetrahedra(corners),
                        Zone::Transition => blocks.pyramids(corners, centre(), Some(BASE_X_MAX)),
                    }
                }
            }
        }
        Mesh { points, blocks: blocks.list(), facet_blocks: Vec::new(), groups: self.sides() }
    }

    fn zone(&self, i: usize) -> Zone {
        if self.cut != Cut::Mixed {
            return Zone::Uniform(self.cut);
        }
        // hexahedra | one layer between | tetrahedra | prisms: the two outer zones a third of the length each
        let count = self.cells[0];
        let outer = (count / 3).max(1);
        if i < outer {
            Zone::Uniform(Cut::Hexahedra)
        } else if i == outer {
            Zone::Transition
        } else if i < count - outer {
            Zone::Uniform(Cut::Tetrahedra)
        } else {
            Zone::Uniform(Cut::Prisms)
        }
    }

    fn point(&self, i: usize, j: usize, k: usize) -> u32 {
        let [nx, ny, _] = self.cells;
        (i + (nx + 1) * (j + (ny + 1) * k)) as u32
    }

    /// Points of the six sides.
    fn sides(&self) -> BTreeMap<String, Group> {
        let [nx, ny, nz] = self.cells;
        let mut groups = BTreeMap::new();
        for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
            for (end, at) in [("min", 0), ("max", self.cells[axis])] {
                let mut group = Group::default();
                for k in 0..=nz {
                    for j in 0..=ny {
                        group.points.extend(
                            (0..=nx).filter(|i| [*i, j, k][axis] == at).map(|i| self.point(i, j, k)),
                        );
                    }
                }
                groups.insert(format!("{letter}_{end}"), group);
            }
        }
        groups
    }

    /// Points on the outside of the grid, ascending.
    pub(super) fn outside(&self) -> Vec<u32> {
        let [nx, ny, nz] = self.cells;
        let outer = |i: usize, n: usize| i == 0 || i == n;
        let mut points = Vec::new();
        for k in 0..=nz {
            for j in 0..=ny {
                let on_side = |i: &usize| outer(*i, nx) || outer(j, ny) || outer(k, nz);
                points.extend((0..=nx).filter(on_side).map(|i| self.point(i, j, k)));
            }
        }
        points
    }
}

enum Zone {
    Uniform(Cut),
    /// Pyramids whose faces towards greater x are cut in two triangles.
    Transition,
}

/// One block for each kind, so that a mesh has few.
#[derive(Default)]
struct Blocks(BTreeMap<ElementKind, Vec<u32>>);

impl Blocks {
    fn push(&mut self, kind: ElementKind, nodes: &[u32]) {
        self.0.entry(kind).or_default().extend_from_slice(nodes);
    }

    /// For each permutation of the axes: from the corner (0,0,0) along the axes in that order to (1,1,1).
    fn tetrahedra(&mut self, corners: [u32; 8]) {
        for (axes, parity) in KUHN {
            let mut at = [0; 3];
            let mut nodes = [corners[0]; 4];
            for (step, axis) in axes.into_iter().enumerate() {
                at[axis] = 1;
                nodes[step + 1] = corners[CORNERS.iter().position(|corner| *corner == at).unwrap_or(0)];
            }
            if parity == Parity::Odd {
                nodes.swap(2, 3);
            }
            self.push(ElementKind::Tet4, &nodes);
        }
    }

    /// The faces across x are cut along the diagonal from (y, z) = (0, 0) to (1, 1), as `tetrahedra` cuts them.
    fn prisms(&mut self, c: [u32; 8]) {
        self.push(ElementKind::Prism6, &[c[0], c[3], c[7], c[1], c[2], c[6]]);
        self.push(ElementKind::Prism6, &[c[0], c[7], c[4], c[1], c[6], c[5]]);
    }

    /// A pyramid on each face; on the face `split`, two tetrahedra that meet those of `tetrahedra`.
    fn pyramids(&mut self, c: [u32; 8], centre: u32, split: Option<usize>) {
        for (face, base) in BASES.into_iter().enumerate() {
            let [p, q, r, s] = base.map(|corner| c[corner]);
            if split == Some(face) {
                // base 1 5 6 2: its first and third corners are the ends of the diagonal
                self.push(ElementKind::Tet4, &[p, q, r, centre]);
                self.push(ElementKind::Tet4, &[p, r, s, centre]);
            } else {
                self.push(ElementKind::Pyramid5, &[p, q, r, s, centre]);
            }
        }
    }

    fn list(self) -> Vec<CellBlock> {
        self.0.into_iter().map(|(kind, nodes)| CellBlock { kind, nodes }).collect()
    }
}
