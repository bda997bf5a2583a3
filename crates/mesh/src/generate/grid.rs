//! A grid of cubes, each cut into cells.
//!
//! Points are numbered `i + (nx+1)(j + (ny+1)k)`, cubes with `i` fastest, then `j`, then `k`; centres of cubes,
//! where a cut needs them, follow after all grid points in the order of their cubes.

use std::collections::BTreeMap;

use souple_math::Vec3;
use souple_table::Value;

use super::cut::{BASE_X_MAX, Blocks, CORNERS, Cut};
use crate::{ElementKind, Group, MAX_CELLS, Mesh, MeshError, MeshSize};

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

    pub(super) fn size(&self) -> MeshSize {
        let cubes = self.cells.iter().map(|count| *count as u64).product::<u64>();
        let corners = self.cells.iter().map(|count| *count as u64 + 1).product::<u64>();
        let centres = match self.cut {
            Cut::Pyramids => cubes,
            Cut::Mixed => (self.cells[1] * self.cells[2]) as u64,
            _ => 0,
        };
        MeshSize { points: corners + centres, cells: cubes * self.cut.cells_per_cube() }
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
                        Zone::Uniform(Cut::Tetrahedra | Cut::Mixed) => blocks.kuhn_tetrahedra(corners),
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
                        group
                            .points
                            .extend((0..=nx).filter(|i| [*i, j, k][axis] == at).map(|i| self.point(i, j, k)));
                    }
                }
                groups.insert(format!("{letter}_{end}"), group);
            }
        }
        groups
    }
}

enum Zone {
    Uniform(Cut),
    /// Pyramids whose faces towards greater x are cut in two triangles.
    Transition,
}
