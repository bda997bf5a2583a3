//! A grid of cubes, each cut into cells.
//!
//! Points are numbered `i + (nx+1)(j + (ny+1)k)`, cubes with `i` fastest, then `j`, then `k`; centres of cubes,
//! where a cut needs them, follow after all grid points in the order of their cubes.

use std::collections::BTreeMap;

use souple_math::Vec3;
use souple_table::Value;

use super::cut::{BASE_X_MAX, BASE_Y_MAX, BASE_Z_MAX, Blocks, CORNERS, Cut, Parity};
use super::disorder::Disorder;
use crate::{ElementKind, Group, MAX_CELLS, Mesh, MeshError, MeshSize};

pub(super) struct Grid {
    cells: [usize; 3],
    /// How the cubes of each layer across x are cut.
    zones: Vec<Zone>,
    /// The face of each cube that its prisms lie towards. Corners are numbered as `prisms` has them: towards x both are one.
    prism_end: usize,
    diagonals: Diagonals,
    disorder: Disorder,
}

/// Along which diagonals cubes are cut in tetrahedra.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Diagonals {
    Parallel,
    /// In every second cube along each axis the mirror image across that axis: neighbours are each other's mirror images.
    Mirrored,
}

impl Grid {
    const START: Self = Self {
        cells: [1; 3],
        zones: Vec::new(),
        prism_end: BASE_X_MAX,
        diagonals: Diagonals::Parallel,
        disorder: Disorder::NONE,
    };

    /// # Errors
    /// Counts that are not whole numbers of at least one, or too many cells.
    pub(super) fn new(name: &'static str, counts: [f64; 3], cut: Cut) -> Result<Self, MeshError> {
        let cells = whole_counts(name, counts, cut.cells_per_cube())?;
        if cut == Cut::Mixed && cells[0] < 4 {
            return Err(unfit(name, counts, "at least 4 cubes along x for `mixed`"));
        }
        let zone = |i: usize| if cut == Cut::Mixed { mixed(i, cells[0]) } else { Zone::Uniform(cut) };
        Ok(Self { cells, zones: (0..cells[0]).map(zone).collect(), ..Self::START })
    }

    /// Cubes cut by the part of the length that their middle is in; `parts` are cuts and where they end, as fractions of
    /// the length, ascending to one.
    ///
    /// # Errors
    /// Counts that are not whole numbers of at least one, or too many cells.
    pub(super) fn of_parts(
        name: &'static str,
        counts: [f64; 3],
        parts: &[(Cut, f64)],
    ) -> Result<Self, MeshError> {
        let most = parts.iter().map(|(cut, _)| cut.cells_per_cube()).max().unwrap_or(1);
        let cells = whole_counts(name, counts, most)?;
        let zone = |i: usize| {
            let middle = (i as f64 + 0.5) / cells[0] as f64;
            let part = parts.iter().find(|(_, end)| middle < *end).or(parts.last());
            Zone::Uniform(part.map_or(Cut::Hexahedra, |(cut, _)| *cut))
        };
        Ok(Self { cells, zones: (0..cells[0]).map(zone).collect(), ..Self::START })
    }

    /// The same with prisms along another axis of the grid: their triangles lie across it.
    pub(super) fn with_prisms_along(self, axis: usize) -> Self {
        Self { prism_end: [BASE_X_MAX, BASE_Y_MAX, BASE_Z_MAX][axis], ..self }
    }

    /// The same with tetrahedra along these diagonals.
    pub(super) fn with_diagonals(self, diagonals: Diagonals) -> Self {
        Self { diagonals, ..self }
    }

    /// The same with its points moved inside, centres of cubes too.
    pub(super) fn with_disorder(self, disorder: Disorder) -> Self {
        Self { disorder, ..self }
    }

    pub(super) fn size(&self) -> MeshSize {
        let corners = self.cells.iter().map(|count| *count as u64 + 1).product::<u64>();
        let of_layer = (self.cells[1] * self.cells[2]) as u64;
        let zones = || self.zones.iter();
        MeshSize {
            points: corners + of_layer * zones().filter(|zone| zone.has_centres()).count() as u64,
            cells: of_layer * zones().map(|zone| zone.cells_per_cube()).sum::<u64>(),
        }
    }

    /// The mesh with its points at `place(ξ)`, `ξ` in the unit cube.
    pub(super) fn mesh(&self, place: impl Fn(Vec3) -> Vec3) -> Mesh {
        let [nx, ny, nz] = self.cells;
        let unit = |at: Vec3| Vec3::new(at.x / nx as f64, at.y / ny as f64, at.z / nz as f64);
        let is_inside = |at: [usize; 3]| (0..3).all(|axis| (1..self.cells[axis]).contains(&at[axis]));
        let mut disorder = self.disorder;
        let mut points = Vec::with_capacity((nx + 1) * (ny + 1) * (nz + 1));
        for k in 0..=nz {
            for j in 0..=ny {
                for i in 0..=nx {
                    let corner = Vec3::new(i as f64, j as f64, k as f64);
                    let moved = if is_inside([i, j, k]) { corner + disorder.next_in_space() } else { corner };
                    points.push(place(unit(moved)));
                }
            }
        }
        let mut blocks = Blocks::default();
        for k in 0..nz {
            for j in 0..ny {
                for i in 0..nx {
                    let corners = CORNERS.map(|[a, b, c]| self.point(i + a, j + b, k + c));
                    let mut centre = || {
                        let middle = Vec3::new(i as f64 + 0.5, j as f64 + 0.5, k as f64 + 0.5);
                        points.push(place(unit(middle + disorder.next_in_space())));
                        points.len() as u32 - 1
                    };
                    match self.zones[i] {
                        Zone::Uniform(Cut::Hexahedra) => blocks.push(ElementKind::Hex8, &corners),
                        Zone::Uniform(Cut::Prisms) => blocks.prisms_towards(corners, self.prism_end),
                        Zone::Uniform(Cut::Pyramids) => blocks.pyramids(corners, centre(), None),
                        Zone::Uniform(Cut::Centred) => blocks.centred_tetrahedra(corners, centre()),
                        Zone::Uniform(Cut::Tetrahedra | Cut::Mixed) => {
                            let (corners, frame) = self.corners_in_frame([i, j, k]);
                            blocks.kuhn_tetrahedra(corners, frame);
                        }
                        Zone::Transition => blocks.pyramids(corners, centre(), Some(BASE_X_MAX)),
                    }
                }
            }
        }
        Mesh { points, blocks: blocks.list(), facet_blocks: Vec::new(), groups: self.sides() }
    }

    /// Corners of a cube, numbered in the frame in which it is cut in tetrahedra, and the parity of that.
    fn corners_in_frame(&self, cube: [usize; 3]) -> ([u32; 8], Parity) {
        let is_mirrored = cube.map(|index| self.diagonals == Diagonals::Mirrored && index % 2 == 1);
        let corners = CORNERS.map(|corner| {
            let at = |axis: usize| {
                let step = if is_mirrored[axis] { 1 - corner[axis] } else { corner[axis] };
                cube[axis] + step
            };
            self.point(at(0), at(1), at(2))
        });
        (corners, Parity::of(is_mirrored.into_iter().filter(|mirrored| *mirrored).count()))
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

/// How the cubes of a layer are cut.
#[derive(Clone, Copy)]
enum Zone {
    Uniform(Cut),
    /// Pyramids whose faces towards greater x are cut in two triangles.
    Transition,
}

impl Zone {
    fn has_centres(self) -> bool {
        matches!(self, Self::Uniform(Cut::Pyramids | Cut::Centred) | Self::Transition)
    }

    fn cells_per_cube(self) -> u64 {
        match self {
            Self::Uniform(cut) => cut.cells_per_cube(),
            Self::Transition => Cut::Mixed.cells_per_cube(),
        }
    }
}

/// Hexahedra | one layer between | tetrahedra | prisms: the two outer zones a third of the length each.
fn mixed(i: usize, count: usize) -> Zone {
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

fn unfit(name: &'static str, counts: [f64; 3], expected: &str) -> MeshError {
    let value = Value::Vector(counts).to_string();
    MeshError::Parameter { name, value, expected: expected.to_owned() }
}

fn whole_counts(name: &'static str, counts: [f64; 3], per_cube: u64) -> Result<[usize; 3], MeshError> {
    if !counts.iter().all(|count| *count >= 1.0 && count.fract() == 0.0) {
        return Err(unfit(name, counts, "three whole numbers of at least 1"));
    }
    // in floating point, where nothing overflows
    let requested = counts[0] * counts[1] * counts[2] * per_cube as f64;
    if requested > MAX_CELLS as f64 {
        return Err(MeshError::TooManyCells { requested, limit: MAX_CELLS });
    }
    Ok(counts.map(|count| count as usize))
}
