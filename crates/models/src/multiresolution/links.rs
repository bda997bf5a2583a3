//! How the points and tetrahedra of independent meshes of one body are linked, all at rest and for ever.
//!
//! Every point lies in a tetrahedron of the next coarser mesh and in one of the next finer one, with barycentric weights
//! that extrapolate at the border. A point is the child of the nearest coarser point, in whose Voronoi cell it is: the
//! points of all meshes are a forest.

use std::ops::Range;

use souple_math::{Mat3, Vec3};
use souple_mesh::{Aabb, AabbTree, CellLocator, ElementKind, Mesh};

/// A tetrahedron of one of the meshes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tet {
    /// Points, by their numbers over all meshes.
    pub corners: [u32; 4],
    /// Of the linear shape functions of the corners [1/m].
    pub gradients: [Vec3; 4],
    /// At rest [m³].
    pub volume: f64,
}

impl Tet {
    /// Barycentric coordinates of a place at rest.
    fn weights(&self, rest: &[Vec3], place: Vec3) -> [f64; 4] {
        [0, 1, 2, 3].map(|i: usize| 1.0 + self.gradients[i].dot(place - rest[self.corners[i] as usize]))
    }

    /// `Σ value · gradientᵀ`: of positions, the deformation gradient.
    pub fn gradient(&self, values: &[Vec3]) -> Mat3 {
        let mut sum = Mat3::ZERO;
        for (corner, gradient) in self.corners.iter().zip(&self.gradients) {
            sum += values[*corner as usize].outer(*gradient);
        }
        sum
    }
}

/// What a point hangs on while it follows: the corners of a tetrahedron of another mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Carrier {
    pub corners: [u32; 4],
    pub weights: [f64; 4],
}

/// Lists of numbers, one for each of some things.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lists {
    starts: Vec<u32>,
    entries: Vec<u32>,
}

impl Lists {
    /// From pairs of a thing and an entry, sorted.
    fn of(count: usize, pairs: &[(u32, u32)]) -> Self {
        let mut starts = vec![0; count + 1];
        for (thing, _) in pairs {
            starts[*thing as usize + 1] += 1;
        }
        for thing in 0..count {
            starts[thing + 1] += starts[thing];
        }
        Self { starts, entries: pairs.iter().map(|(_, entry)| *entry).collect() }
    }

    pub fn get(&self, thing: usize) -> &[u32] {
        &self.entries[self.starts[thing] as usize..self.starts[thing + 1] as usize]
    }
}

/// The meshes of a body with their links. Points are numbered over all meshes: those of the finest mesh first, so that
/// they are where a body without levels has its points, then those of the others from coarse to fine.
#[derive(Clone, Debug)]
pub struct Hierarchy {
    /// Rest positions [m].
    pub rest: Vec<Vec3>,
    /// Points of each level, from coarse to fine.
    pub levels: Vec<Range<usize>>,
    pub level_of: Vec<u8>,
    /// Tetrahedra of all levels, from coarse to fine.
    pub tets: Vec<Tet>,
    pub tets_of_level: Vec<Range<usize>>,
    pub tets_of_point: Lists,
    /// Of each point that is not of the coarsest mesh, in the next coarser mesh.
    parents: Vec<Option<Carrier>>,
    /// Of each point that is not of the finest mesh, in the next finer mesh.
    child_tets: Vec<Option<Carrier>>,
    /// Finer points in the Voronoi cell of each point.
    pub children: Lists,
    /// Points that are active when a point is subdivided: its children and, where loops are to be [`Loops::Activated`], the corners
    /// of the tetrahedron that carries it then. Were one of these left to follow, it could come to follow the point that follows it.
    pub successors: Lists,
    pub loops: Loops,
    /// Shortest edge at each point [m].
    pub spacing: Vec<f64>,
}

/// What becomes of a corner of the tetrahedron that carries a subdivided point, and is none of its children: it may follow a coarse
/// tetrahedron of which that point is a corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Loops {
    /// It is active: there is no loop (Debunne 2000, 5 §4.2).
    Activated,
    /// It follows, and each of the two is where the other was a tick before: the source's method without its remedy.
    Lagged,
}

/// Meshes that are no levels of a body.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LevelsError {
    #[error("a body has {count} levels; expected 1 to {MOST}")]
    Count { count: usize },
    #[error("level {level} has {kind} cells; expected tetrahedra (tet4)")]
    Kind { level: usize, kind: &'static str },
    #[error("cell {cell} of level {level} has the volume {volume:e} m³; expected more than zero")]
    Flat { level: usize, cell: usize, volume: f64 },
    #[error(
        "level {level} has {count} points, the finer one after it {finer}; expected levels from coarse to fine"
    )]
    Order { level: usize, count: usize, finer: usize },
}

/// More levels than this are of no use: eight times the points for each.
pub const MOST: usize = 7;

impl Hierarchy {
    /// Of meshes from coarse to fine.
    ///
    /// # Errors
    /// They are too few or too many, no tetrahedra, flat, or not in order.
    pub fn new(meshes: &[&Mesh], loops: Loops) -> Result<Self, LevelsError> {
        check(meshes)?;
        let counts: Vec<usize> = meshes.iter().map(|mesh| mesh.points.len()).collect();
        let finest = counts.last().copied().unwrap_or(0);
        let mut next = finest;
        let mut levels: Vec<Range<usize>> = Vec::new();
        for count in &counts[..counts.len() - 1] {
            levels.push(next..next + count);
            next += count;
        }
        levels.push(0..finest);
        let mut hierarchy = Self {
            rest: vec![Vec3::ZERO; next],
            level_of: vec![0; next],
            levels,
            tets: Vec::new(),
            tets_of_level: Vec::new(),
            tets_of_point: Lists::default(),
            parents: vec![None; next],
            child_tets: vec![None; next],
            children: Lists::default(),
            successors: Lists::default(),
            loops,
            spacing: vec![f64::INFINITY; next],
        };
        hierarchy.add_meshes(meshes)?;
        hierarchy.link(meshes);
        Ok(hierarchy)
    }

    pub fn level_count(&self) -> usize {
        self.levels.len()
    }

    pub fn point_count(&self) -> usize {
        self.rest.len()
    }

    pub fn finest(&self) -> usize {
        self.levels.len() - 1
    }

    /// What carries a point while it stands for nothing and coarser points are at work.
    pub fn parent(&self, point: usize) -> &Carrier {
        self.parents[point]
            .as_ref()
            .unwrap_or_else(|| unreachable!("points of the coarsest mesh are present"))
    }

    /// What carries a point while finer points are in its place.
    pub fn child_tet(&self, point: usize) -> &Carrier {
        self.child_tets[point]
            .as_ref()
            .unwrap_or_else(|| unreachable!("the finest points are not subdivided"))
    }

    fn add_meshes(&mut self, meshes: &[&Mesh]) -> Result<(), LevelsError> {
        let mut incidences = Vec::new();
        for (level, mesh) in meshes.iter().enumerate() {
            let points = self.levels[level].clone();
            self.rest[points.clone()].copy_from_slice(&mesh.points);
            self.level_of[points.clone()].fill(level as u8);
            let first = self.tets.len();
            for (index, cell) in mesh.cells().enumerate() {
                let corners = [0, 1, 2, 3].map(|corner: usize| cell.nodes[corner] + points.start as u32);
                let at = |corner: usize| self.rest[corners[corner] as usize];
                let edges = Mat3::from_columns(at(1) - at(0), at(2) - at(0), at(3) - at(0));
                let volume = edges.determinant() / 6.0;
                let inverse = edges.try_inverse().filter(|inverse| volume > 0.0 && inverse.is_finite());
                let inverse = inverse.ok_or(LevelsError::Flat { level, cell: index, volume })?;
                let [b, c, d] = [0, 1, 2].map(|row| inverse.row(row));
                incidences.extend(corners.map(|corner| (corner, self.tets.len() as u32)));
                for (i, j) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
                    let length = (at(i) - at(j)).length();
                    for corner in [corners[i], corners[j]] {
                        let spacing = &mut self.spacing[corner as usize];
                        *spacing = spacing.min(length);
                    }
                }
                self.tets.push(Tet { corners, gradients: [-(b + c + d), b, c, d], volume });
            }
            self.tets_of_level.push(first..self.tets.len());
        }
        incidences.sort_unstable();
        self.tets_of_point = Lists::of(self.rest.len(), &incidences);
        Ok(())
    }

    fn link(&mut self, meshes: &[&Mesh]) {
        let (mut children, mut successors) = (Vec::new(), Vec::new());
        for level in 1..meshes.len() {
            let (coarse, fine) = (self.levels[level - 1].clone(), self.levels[level].clone());
            let in_coarse = CellLocator::new(meshes[level - 1]);
            let in_fine = CellLocator::new(meshes[level]);
            let nearest = Nearest::new(&self.rest[coarse.clone()]);
            for point in fine.clone() {
                let position = self.rest[point];
                self.parents[point] = self.carrier(&in_coarse, level - 1, position);
                children.push(((coarse.start + nearest.to(position)) as u32, point as u32));
            }
            for point in coarse {
                let carrier = self.carrier(&in_fine, level, self.rest[point]);
                if self.loops == Loops::Activated {
                    successors
                        .extend(carrier.iter().flat_map(|c| c.corners).map(|corner| (point as u32, corner)));
                }
                self.child_tets[point] = carrier;
            }
        }
        children.sort_unstable();
        successors.extend_from_slice(&children);
        successors.sort_unstable();
        successors.dedup();
        self.children = Lists::of(self.rest.len(), &children);
        self.successors = Lists::of(self.rest.len(), &successors);
    }
}

impl Hierarchy {
    /// The tetrahedron of a level that carries a position. Outside of all, of those around the closest one that with the
    /// least extrapolation: a flat tetrahedron at the border has wild weights a little way off.
    fn carrier(&self, locator: &CellLocator, level: usize, position: Vec3) -> Option<Carrier> {
        let first = self.tets_of_level[level].start;
        self.carrier_among(locator, &|cell| first + cell, &|_| true, position)
    }

    /// The same among the tetrahedra that are kept, which the locator's cells are.
    fn carrier_among(
        &self,
        locator: &CellLocator,
        tet_of: &dyn Fn(usize) -> usize,
        is_kept: &dyn Fn(usize) -> bool,
        position: Vec3,
    ) -> Option<Carrier> {
        let location = locator.carrier(position)?;
        let found = tet_of(location.cell as usize);
        let least = |tet: usize| self.tets[tet].weights(&self.rest, position).into_iter().fold(1.0, f64::min);
        let mut best = (least(found), found);
        if location.distance > 0.0 {
            for corner in self.tets[found].corners {
                for tet in
                    self.tets_of_point.get(corner as usize).iter().filter(|tet| is_kept(**tet as usize))
                {
                    let weight = least(*tet as usize);
                    if weight > best.0 {
                        best = (weight, *tet as usize);
                    }
                }
            }
        }
        let tet = &self.tets[best.1];
        Some(Carrier { corners: tet.corners, weights: tet.weights(&self.rest, position) })
    }
}

impl Hierarchy {
    /// What places at rest would hang on in a level, whose mesh that is.
    pub fn carriers(&self, level: usize, mesh: &Mesh, places: &[Vec3]) -> Vec<Carrier> {
        self.carriers_among(level, (mesh, &|_| true), places)
    }

    /// The same among the cells of the mesh that are kept, of which there must be some.
    pub fn carriers_among(
        &self,
        level: usize,
        (mesh, is_kept): (&Mesh, &dyn Fn(usize) -> bool),
        places: &[Vec3],
    ) -> Vec<Carrier> {
        let cells: Vec<usize> = (0..mesh.cell_count()).filter(|cell| is_kept(*cell)).collect();
        let part = (cells.len() < mesh.cell_count()).then(|| mesh.of_cells(is_kept));
        let locator = CellLocator::new(part.as_ref().unwrap_or(mesh));
        let first = self.tets_of_level[level].start;
        let is_kept = |tet: usize| is_kept(tet - first);
        let found =
            |place: &Vec3| self.carrier_among(&locator, &|cell| first + cells[cell], &is_kept, *place);
        places
            .iter()
            .map(|place| found(place).unwrap_or_else(|| unreachable!("a place is finite, a mesh has cells")))
            .collect()
    }
}

fn check(meshes: &[&Mesh]) -> Result<(), LevelsError> {
    if meshes.is_empty() || meshes.len() > MOST {
        return Err(LevelsError::Count { count: meshes.len() });
    }
    for (level, mesh) in meshes.iter().enumerate() {
        let other = mesh.blocks.iter().find(|block| block.kind != ElementKind::Tet4 && !block.is_empty());
        if let Some(block) = other {
            return Err(LevelsError::Kind { level, kind: block.kind.name() });
        }
    }
    for (level, pair) in meshes.windows(2).enumerate() {
        let (count, finer) = (pair[0].points.len(), pair[1].points.len());
        if count >= finer {
            return Err(LevelsError::Order { level, count, finer });
        }
    }
    Ok(())
}

/// Finds the nearest of some points; of several, the first.
struct Nearest<'a> {
    points: &'a [Vec3],
    tree: AabbTree,
}

impl<'a> Nearest<'a> {
    fn new(points: &'a [Vec3]) -> Self {
        let boxes: Vec<Aabb> = points.iter().map(|point| Aabb { low: *point, high: *point }).collect();
        Self { points, tree: AabbTree::build(&boxes) }
    }

    fn to(&self, position: Vec3) -> usize {
        let distance_sq = |point: u32| (self.points[point as usize] - position).length_sq();
        self.tree.nearest(position, f64::INFINITY, distance_sq).map_or(0, |(point, _)| point as usize)
    }
}
