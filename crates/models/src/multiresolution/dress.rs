//! A display surface that follows a body of several meshes, whichever of them is at work (Debunne 2000, 6 §1).
//!
//! Each node of the surface is tied to a triangle of the boundary of *every* mesh: the one that is closest at rest, a place on
//! it, and an offset in the triangle's own frame, which turns with it. Of these ties the finest counts whose triangle has a
//! point at work. The source takes weights by the inverse of distances to the corners; with those a node of an evenly
//! stretched body would leave its place, with the place on the triangle it does not.
//!
//! When others come to be at work, a tie would make the node jump. What it would jump by is taken as an offset that fades
//! evenly: the surface never pops. All of that evolves, so it is a field of State.

use std::ops::Range;
use std::sync::Arc;

use souple_engine::{CommittedRows, Field, FieldState, FieldStep, Scratch, StepError};
use souple_math::{Mat3, Vec3};
use souple_mesh::{Aabb, AabbTree, TriangleSurface, closest_point_on_triangle};

/// How a node hangs on a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Tie {
    /// Rows of the triangle's corners.
    corners: [u32; 3],
    weights: [f64; 3],
    /// From the place on the triangle to the node, in the triangle's frame [m].
    offset: Vec3,
}

/// A mesh that a node may hang on: its boundary at rest, and the rows of its points.
pub struct DressLevel {
    pub surface: TriangleSurface,
    pub rows: Range<u32>,
}

/// The display surface of a body with levels.
#[derive(Debug)]
pub struct Dress {
    name: String,
    /// Index of the body's system, and of its elastic force there.
    of: [usize; 2],
    /// At rest.
    surface: TriangleSurface,
    /// By node, from coarse to fine.
    ties: Vec<Vec<Tie>>,
    /// Time in which a jump fades [s].
    blend: f64,
}

/// Numbers of a node: where it is, what is left of a jump, and when that was.
const PER_NODE: usize = 7;

#[derive(Clone, Copy, Debug, Default)]
struct Node {
    shown: Vec3,
    /// What it would have jumped by [m].
    jump: Vec3,
    /// Time since then [s].
    age: f64,
}

impl Node {
    fn read(numbers: &[f64]) -> Self {
        let vector = |at: usize| Vec3::new(numbers[at], numbers[at + 1], numbers[at + 2]);
        Self { shown: vector(0), jump: vector(3), age: numbers[6] }
    }

    fn write(self, numbers: &mut [f64]) {
        numbers[..3].copy_from_slice(&self.shown.to_array());
        numbers[3..6].copy_from_slice(&self.jump.to_array());
        numbers[6] = self.age;
    }
}

/// Axes along the first edge, along the normal, and across both; `None` of a triangle squeezed to a line.
fn frame([a, b, c]: [Vec3; 3]) -> Option<Mat3> {
    let along = (b - a).try_normalised()?;
    let normal = (b - a).cross(c - a).try_normalised()?;
    Some(Mat3::from_columns(along, normal, along.cross(normal)))
}

impl Tie {
    fn place(&self, values: &[Vec3]) -> Vec3 {
        self.corners.iter().zip(self.weights).map(|(corner, weight)| values[*corner as usize] * weight).sum()
    }

    /// Where the node is by this tie.
    fn node(&self, positions: &[Vec3]) -> Vec3 {
        let frame = frame(self.corners.map(|corner| positions[corner as usize]));
        self.place(positions) + frame.map_or(Vec3::ZERO, |frame| frame * self.offset)
    }
}

impl Dress {
    /// Levels from coarse to fine; `of` are the numbers of the body's system and of its force there, `blend` the time in
    /// which jumps fade [s]. Nodes and levels stand at rest.
    pub fn new(
        name: String,
        of: [usize; 2],
        surface: TriangleSurface,
        levels: &[DressLevel],
        blend: f64,
    ) -> Self {
        let mut ties = vec![Vec::with_capacity(levels.len()); surface.points.len()];
        for DressLevel { surface: boundary, rows } in levels {
            let boxes: Vec<Aabb> =
                (0..boundary.triangles.len() as u32).map(|t| Aabb::of(boundary.corners(t))).collect();
            let tree = AabbTree::build(&boxes);
            for (node, ties) in surface.points.iter().zip(&mut ties) {
                let place = |triangle: u32| {
                    let corners = boundary.corners(triangle);
                    let (weights, _) = closest_point_on_triangle(*node, corners);
                    let on: Vec3 = corners.into_iter().zip(weights).map(|(corner, w)| corner * w).sum();
                    (weights, on)
                };
                let distance_sq = |triangle: u32| (*node - place(triangle).1).length_sq();
                let Some((triangle, _)) = tree.nearest(*node, f64::INFINITY, distance_sq) else { continue };
                let (weights, on) = place(triangle);
                let axes = frame(boundary.corners(triangle)).unwrap_or(Mat3::IDENTITY);
                let point = |corner: u32| rows.start + boundary.mesh_points[corner as usize];
                ties.push(Tie {
                    corners: boundary.triangles[triangle as usize].map(point),
                    weights,
                    offset: axes.transpose() * (*node - on),
                });
            }
        }
        Self { name, of, surface, ties, blend }
    }

    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.surface.triangles
    }

    /// Where nodes are at rest [m].
    pub fn rest(&self) -> &[Vec3] {
        &self.surface.points
    }

    /// The state before anything has moved.
    pub fn start(&self) -> FieldState {
        let count = self.ties.len();
        let mut state = FieldState { values: vec![0.0; PER_NODE * count + 1], indices: vec![UNKNOWN; count] };
        for (shown, numbers) in self.surface.points.iter().zip(state.values.chunks_exact_mut(PER_NODE)) {
            Node { shown: *shown, jump: Vec3::ZERO, age: self.blend }.write(numbers);
        }
        state
    }

    /// Where nodes are [m].
    pub fn points<'a>(&self, state: &'a FieldState) -> impl ExactSizeIterator<Item = Vec3> + 'a {
        let count = self.ties.len();
        state.values[..PER_NODE * count].chunks_exact(PER_NODE).map(|numbers| Node::read(numbers).shown)
    }

    /// Of each node, the level that it hangs on, counted from the coarsest.
    pub fn levels<'a>(&self, state: &'a FieldState) -> impl ExactSizeIterator<Item = u64> + 'a {
        state.indices.iter().map(|pattern| if *pattern == UNKNOWN { 0 } else { pattern / PATTERNS })
    }

    /// The most that a node has jumped from one period to the next because others came to be at work [m].
    pub fn greatest_jump(&self, state: &FieldState) -> f64 {
        state.values.last().copied().unwrap_or(0.0)
    }

    fn share(&self, age: f64) -> f64 {
        if self.blend > 0.0 { (1.0 - age / self.blend).max(0.0) } else { 0.0 }
    }
}

/// The level of a node times so many, plus which corners of its triangle are at work.
const PATTERNS: u64 = 8;
/// Of a node that has not been placed yet.
const UNKNOWN: u64 = u64::MAX;

/// Which corners are at work.
fn pattern(tie: &Tie, active: &[u32]) -> u64 {
    let is_active = |corner: &u32| active.binary_search(corner).is_ok();
    (0..3).filter(|k: &usize| is_active(&tie.corners[*k])).map(|k| 1_u64 << k).sum()
}

/// A dress that others hold too, as a field of the world.
pub struct Worn(pub Arc<Dress>);

impl Field for Worn {
    fn name(&self) -> &str {
        &self.0.name
    }

    fn kind(&self) -> &'static str {
        "dress"
    }

    fn accepts(&self, field: &FieldState, current: &FieldState) -> bool {
        (field.values.len(), field.indices.len()) == (current.values.len(), current.indices.len())
    }

    fn step(
        &self,
        rows: CommittedRows,
        step: &FieldStep,
        field: &mut FieldState,
        _scratch: &mut Scratch,
    ) -> Result<(), StepError> {
        let dress = &*self.0;
        let [system, force] = dress.of;
        let now = rows.of(system);
        let active = rows.active(system, force).unwrap_or(&[]);
        let mut greatest = dress.greatest_jump(field);
        for (index, ties) in dress.ties.iter().enumerate() {
            let patterns = ties.iter().enumerate().rev().map(|(level, tie)| (level, pattern(tie, active)));
            let finest = patterns.clone().find(|(_, pattern)| *pattern != 0);
            let Some((level, pattern)) = finest.or_else(|| patterns.clone().next()) else { continue };
            let (tie, code) = (&ties[level], level as u64 * PATTERNS + pattern);
            let numbers = &mut field.values[PER_NODE * index..][..PER_NODE];
            let mut node = Node::read(numbers);
            let target = tie.node(&now.positions);
            let before = std::mem::replace(&mut field.indices[index], code);
            if before != code && before != UNKNOWN {
                // where it would have come to by itself
                let moved = node.shown + tie.place(&now.velocities) * step.timestep;
                (node.jump, node.age) = (moved - target, 0.0);
            }
            let share = dress.share(node.age);
            node.age = (node.age + step.timestep).min(dress.blend);
            let left = dress.share(node.age);
            greatest =
                greatest.max(node.jump.length() * (if dress.blend > 0.0 { share - left } else { 0.0 }));
            if dress.blend == 0.0 && node.jump != Vec3::ZERO {
                greatest = greatest.max(node.jump.length());
                node.jump = Vec3::ZERO;
            }
            node.shown = target + node.jump * left;
            node.write(numbers);
        }
        if let Some(most) = field.values.last_mut() {
            *most = greatest;
        }
        Ok(())
    }

    fn bytes(&self, _scratch: &Scratch) -> usize {
        let Dress { ties, surface, .. } = &*self.0;
        let ties: usize = ties.iter().map(|ties| size_of::<Tie>() * ties.capacity()).sum();
        ties + size_of::<Vec3>() * surface.points.capacity() + 12 * surface.triangles.capacity()
    }
}

#[cfg(test)]
mod tests {
    use souple_math::exponential;
    use souple_table::{Value, Values};

    use super::*;

    /// Boundary of a cube of 10 cm; its points are rows from `first` on.
    fn level(cells: f64, first: u32) -> (DressLevel, Vec<Vec3>) {
        let values = Values::new()
            .with("size", Value::Vector([0.1; 3]))
            .with("cells", Value::Vector([cells; 3]))
            .with("element", Value::Text("tet4"));
        let mut mesh = souple_mesh::generate("bar", values).unwrap();
        mesh.validate().unwrap();
        let rows = first..first + mesh.points.len() as u32;
        (DressLevel { surface: mesh.boundary_surface(), rows }, mesh.points)
    }

    /// At rest all ties have a node at the same place, so that nothing pops; turned by any angle they have it there too,
    /// also nodes that stand off the meshes; and stretched evenly, nodes on the meshes stay on them.
    #[test]
    fn ties_of_all_levels_agree() {
        let (coarse, mut rest) = level(2.0, 0);
        let (fine, points) = level(5.0, rest.len() as u32);
        rest.extend(points);
        let (nodes, _) = level(7.0, 0);
        let mut surface = nodes.surface;
        // half of them stand off
        for (index, point) in surface.points.iter_mut().enumerate().filter(|(index, _)| index % 2 == 0) {
            *point += (*point - Vec3::new(0.05, 0.05, 0.05)) * (0.03 + 1e-4 * index as f64);
        }
        let dress = Dress::new("dress".to_owned(), [0, 0], surface, &[coarse, fine], 0.1);
        let greatest = |to: &dyn Fn(Vec3) -> Vec3, every: usize| {
            let positions: Vec<Vec3> = rest.iter().map(|x| to(*x)).collect();
            let nodes = dress.rest().iter().zip(&dress.ties).enumerate();
            let chosen = nodes.filter(|(index, _)| index % every == every - 1).map(|(_, node)| node);
            chosen
                .flat_map(|(x, ties)| ties.iter().map(|tie| (tie.node(&positions) - to(*x)).length()))
                .fold(0.0, f64::max)
        };
        assert!(greatest(&|x| x, 1) < 1e-15);
        let turn = exponential(Vec3::new(1.9, -0.7, 1.1));
        assert!(greatest(&|x| turn * x + Vec3::new(0.2, 0.0, -0.1), 1) < 1e-14);
        // those that do not stand off
        let stretch = |x: Vec3| Vec3::new(1.3 * x.x + 0.2 * x.y, 0.9 * x.y, 1.1 * x.z - 0.3 * x.x);
        assert!(greatest(&stretch, 2) < 1e-14);
        // weights by the inverse of distances, the source's, would move them by a good part of an edge
        assert!(greatest(&stretch, 1) > 1e-4);
    }
}
