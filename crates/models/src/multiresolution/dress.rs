//! A display surface that follows a body of several meshes, whichever of them is at work (Debunne 2000, 6 §1).
//!
//! Each node of the surface is tied to a tetrahedron of *every* mesh by barycentric weights, which extrapolate where it stands
//! off: whatever affine map the body is moved by, all ties have the node at the same place, turned, stretched or sheared. Points
//! of all meshes are brought to where they follow in every step, so that the finest tie holds whoever is at work: its points are
//! active or follow. The source ties to three points of the boundary with offsets, and weights by the inverse of distances to
//! the corners; with those a node of an evenly stretched body would leave its place.
//!
//! Where the body is cut ([`Cut`]), triangles go whose middles are on cells that do, and the body's own inner faces are there in their
//! place, as nodes of their own. At the rim nodes hang on cells that stay as long as any triangle around them.
//!
//! Where finer points come, they come where they have followed, and nothing jumps. Where others come to be followed, points are
//! moved ([`Levels::moved`]); what a node would jump by is taken as an offset that fades evenly: the surface never pops. All of
//! that evolves, so it is a field of State.
//!
//! [`Cut`]: super::Cut
//! [`Levels::moved`]: souple_engine::levels::Levels::moved

use std::sync::Arc;

use souple_engine::{CommittedRows, Field, FieldState, FieldStep, Scratch, StepError};
use souple_math::Vec3;
use souple_mesh::{CellLocator, Mesh, OpeningSurface, Span, TriangleSurface};

use super::LevelsForce;
use super::links::Carrier;

/// How a node hangs on a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Tie {
    /// Rows of the tetrahedron's corners.
    corners: [u32; 4],
    weights: [f64; 4],
}

/// The display surface of a body with levels.
#[derive(Debug)]
pub struct Dress {
    name: String,
    /// Index of the body's system, and of its elastic force there.
    of: [usize; 2],
    /// Row of the body's first point.
    first_row: usize,
    /// At rest.
    surface: OpeningSurface,
    /// By level, from coarse to fine, and by node.
    ties: Vec<Vec<Tie>>,
    fading: Fading,
}

/// How what a node would jump by fades.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fading {
    /// In this time [s].
    pub blend: f64,
    /// In more where a node would move by more than this from one period to the next [m].
    pub most: f64,
}

impl Fading {
    /// How long a jump fades, with periods of `timestep` [s].
    fn time(&self, jump: Vec3, timestep: f64) -> f64 {
        self.blend.max(jump.length() / self.most * timestep)
    }

    /// What is left of a jump at an age.
    fn share(&self, jump: Vec3, age: f64, timestep: f64) -> f64 {
        let time = self.time(jump, timestep);
        if time > 0.0 { (1.0 - age / time).max(0.0) } else { 0.0 }
    }
}

/// Numbers of a node: where it is, what is left of a jump and when that was, and how far its points had been moved.
const PER_NODE: usize = 10;

#[derive(Clone, Copy, Debug, Default)]
struct Node {
    shown: Vec3,
    /// What it would have jumped by [m].
    jump: Vec3,
    /// Time since then [s].
    age: f64,
    /// How far others coming to be at work have moved its tie, all in all [m].
    moved: Vec3,
}

impl Node {
    fn read(numbers: &[f64]) -> Self {
        let vector = |at: usize| Vec3::new(numbers[at], numbers[at + 1], numbers[at + 2]);
        Self { shown: vector(0), jump: vector(3), age: numbers[6], moved: vector(7) }
    }

    fn write(self, numbers: &mut [f64]) {
        numbers[..3].copy_from_slice(&self.shown.to_array());
        numbers[3..6].copy_from_slice(&self.jump.to_array());
        numbers[6] = self.age;
        numbers[7..].copy_from_slice(&self.moved.to_array());
    }
}

impl Tie {
    /// What the node has, of values on rows that begin with `first`.
    fn of(&self, values: &[Vec3], first: usize) -> Vec3 {
        let value = |corner: u32| values[corner as usize - first];
        self.corners.iter().zip(self.weights).map(|(corner, weight)| value(*corner) * weight).sum()
    }

    fn is_at_work(&self, active: &[u32]) -> bool {
        self.corners.iter().any(|corner| active.binary_search(corner).is_ok())
    }
}

impl Dress {
    /// Of a body and its meshes, from coarse to fine, of the finest of which cells are cut at dates [s], infinite where that is never,
    /// none where no cell is; `of` are the numbers of the body's system and of its force there. Nodes stand at rest.
    pub fn new(
        name: String,
        of: [usize; 2],
        surface: TriangleSurface,
        (force, meshes, cut_at): (&LevelsForce, &[&Mesh], &[f64]),
        fading: Fading,
    ) -> Self {
        let first_row = force.first_row;
        let row = |corner: u32| first_row as u32 + corner;
        let tie = |carrier: Carrier| Tie { corners: carrier.corners.map(row), weights: carrier.weights };
        let surface = match meshes {
            [.., finest] if !cut_at.is_empty() => opened(surface, finest, cut_at),
            _ => surface.into(),
        };
        let points = &surface.surface.points;
        let hierarchy = force.hierarchy();
        let of_level =
            |(level, mesh): (usize, &&Mesh)| hierarchy.carriers(level, mesh, points).into_iter().map(tie);
        let mut ties: Vec<Vec<Tie>> =
            meshes.iter().enumerate().map(|level| of_level(level).collect()).collect();
        if let ([.., finest], Some(of_finest), true) = (meshes, ties.last_mut(), surface.opens()) {
            let needed = needed_until(&surface);
            let mut dates = needed.clone();
            dates.sort_unstable_by(f64::total_cmp);
            dates.dedup();
            for date in dates {
                let nodes: Vec<usize> = (0..needed.len()).filter(|node| needed[*node] == date).collect();
                let places: Vec<Vec3> = nodes.iter().map(|node| points[*node]).collect();
                let stays = |cell: usize| cut_at[cell] >= date;
                let carriers = hierarchy.carriers_among(meshes.len() - 1, (finest, &stays), &places);
                nodes.into_iter().zip(carriers).for_each(|(node, carrier)| of_finest[node] = tie(carrier));
            }
        }
        Self { name, of, first_row, ties, surface, fading }
    }

    /// Those that are there at a time [s].
    pub fn triangles(&self, time: f64) -> Vec<[u32; 3]> {
        self.surface.at(time).map(|triangle| self.surface.surface.triangles[triangle]).collect()
    }

    /// Where nodes are at rest [m].
    pub fn rest(&self) -> &[Vec3] {
        &self.surface.surface.points
    }

    /// The state before anything has moved.
    pub fn start(&self) -> FieldState {
        let count = self.surface.surface.points.len();
        let mut state = FieldState { values: vec![0.0; PER_NODE * count + 1], indices: vec![0; count] };
        for (shown, numbers) in
            self.surface.surface.points.iter().zip(state.values.chunks_exact_mut(PER_NODE))
        {
            Node { shown: *shown, ..Node::default() }.write(numbers);
        }
        state
    }

    /// Where nodes are [m].
    pub fn points<'a>(&self, state: &'a FieldState) -> impl ExactSizeIterator<Item = Vec3> + 'a {
        let count = self.surface.surface.points.len();
        state.values[..PER_NODE * count].chunks_exact(PER_NODE).map(|numbers| Node::read(numbers).shown)
    }

    /// Of each node, the finest level that is at work where it hangs, counted from the coarsest.
    pub fn levels<'a>(&self, state: &'a FieldState) -> impl ExactSizeIterator<Item = u64> + 'a {
        state.indices.iter().copied()
    }

    /// The most that a node has jumped from one period to the next because others came to be at work [m].
    pub fn greatest_jump(&self, state: &FieldState) -> f64 {
        state.values.last().copied().unwrap_or(0.0)
    }
}

/// A surface of which triangles go with the cells that their middles are on, or are nearest to; and the walls that cuts open, as the faces
/// of these cells.
fn opened(surface: TriangleSurface, mesh: &Mesh, cut_at: &[f64]) -> OpeningSurface {
    let locator = CellLocator::new(mesh);
    let until = |triangle: u32| {
        let [a, b, c] = surface.corners(triangle);
        let cell = locator.carrier((a + b + c) * (1.0 / 3.0)).map(|location| location.cell);
        cell.map_or(f64::INFINITY, |cell| cut_at[cell as usize])
    };
    let triangles = 0..surface.triangles.len() as u32;
    let spans = triangles.map(|triangle| Span { until: until(triangle), ..Span::ALWAYS }).collect();
    let mut made = OpeningSurface {
        surface: TriangleSurface { cells: Vec::new(), mesh_points: Vec::new(), ..surface },
        spans,
    };
    let own = mesh.opening_surface(cut_at);
    let mut number = vec![None; own.surface.points.len()];
    for (corners, span) in own.surface.triangles.iter().zip(&own.spans) {
        if span.from == f64::NEG_INFINITY {
            continue;
        }
        let points = &mut made.surface.points;
        let corners = corners.map(|corner| {
            *number[corner as usize].get_or_insert_with(|| {
                points.push(own.surface.points[corner as usize]);
                points.len() as u32 - 1
            })
        });
        made.surface.triangles.push(corners);
        made.spans.push(*span);
    }
    made
}

/// Until when there is a triangle around each point [s].
fn needed_until(surface: &OpeningSurface) -> Vec<f64> {
    let mut needed = vec![f64::NEG_INFINITY; surface.surface.points.len()];
    for (triangle, corners) in surface.surface.triangles.iter().enumerate() {
        let until = surface.span(triangle).until;
        corners.iter().for_each(|corner| needed[*corner as usize] = needed[*corner as usize].max(until));
    }
    needed
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
        let (Some(moved), Some(finest)) = (rows.moved(system, force), dress.ties.last()) else {
            return Ok(());
        };
        let mut greatest = dress.greatest_jump(field);
        for (index, tie) in finest.iter().enumerate() {
            let at_work = dress.ties.iter().rposition(|ties| ties[index].is_at_work(active));
            field.indices[index] = at_work.unwrap_or(0) as u64;
            let numbers = &mut field.values[PER_NODE * index..][..PER_NODE];
            let mut node = Node::read(numbers);
            let moved = tie.of(moved, dress.first_row);
            if moved != node.moved {
                node.jump =
                    node.jump * dress.fading.share(node.jump, node.age, step.timestep) - (moved - node.moved);
                (node.age, node.moved) = (0.0, moved);
            }
            let share_at = |age: f64| dress.fading.share(node.jump, age, step.timestep);
            let before = if node.age == 0.0 { 1.0 } else { share_at(node.age) };
            node.age += step.timestep;
            let left = share_at(node.age);
            greatest = greatest.max(node.jump.length() * (before - left));
            if left == 0.0 {
                (node.jump, node.age) = (Vec3::ZERO, 0.0);
            }
            node.shown = tie.of(&now.positions, 0) + node.jump * left;
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
        let TriangleSurface { points, triangles, .. } = &surface.surface;
        let spans = size_of::<Span>() * surface.spans.capacity();
        ties + size_of::<Vec3>() * points.capacity() + 12 * triangles.capacity() + spans
    }
}

#[cfg(test)]
mod tests {
    use souple_formal::Formula;
    use souple_math::{Mat3, exponential};
    use souple_table::{Value, Values};

    use super::*;
    use crate::materials::TABLE;
    use crate::multiresolution::{Choice, Coupling, LevelsDescription, Loops, PLACE_VARIABLES, Stiffness};

    /// A cube of 10 cm.
    fn cube(cells: f64) -> Mesh {
        let values = Values::new()
            .with("size", Value::Vector([0.1; 3]))
            .with("cells", Value::Vector([cells; 3]))
            .with("element", Value::Text("tet4"));
        let mut mesh = souple_mesh::generate("bar", values).unwrap();
        mesh.validate().unwrap();
        mesh
    }

    /// The ties of every level have every node where any affine motion of the body has it, also nodes that stand off the meshes:
    /// at rest and under any linear displacement nothing pops.
    #[test]
    fn ties_of_all_levels_agree() {
        let meshes = [cube(2.0), cube(5.0)];
        let [coarse, fine] = &meshes;
        let values = Values::new().with("youngs_modulus", Value::Number(1e4));
        let entry = TABLE.find("linear").unwrap();
        let values = values.with("poissons_ratio", Value::Number(0.3)).with("density", Value::Number(1e3));
        let material = (entry.build)(&entry.values(values).unwrap()).unwrap();
        let force = LevelsForce::new(LevelsDescription {
            name: "body".to_owned(),
            meshes: &[coarse, fine],
            first_row: 0,
            materials: &[material],
            material_of_cell: &vec![0; fine.cell_count()],
            coupling: Coupling::Transpose,
            loops: Loops::Activated,
            stiffness: Stiffness::Own,
            choice: Choice::Fixed(Formula::compile("0", &PLACE_VARIABLES).unwrap()),
            viscosity: 0.0,
            mass_damping: 0.0,
            budget: None,
            cuts: Vec::new(),
            supports: Vec::new(),
        })
        .unwrap();
        let mut surface = cube(7.0).boundary_surface();
        // half of them stand off
        for (index, point) in surface.points.iter_mut().enumerate().filter(|(index, _)| index % 2 == 0) {
            *point += (*point - Vec3::new(0.05, 0.05, 0.05)) * (0.03 + 1e-4 * index as f64);
        }
        let dress = Dress::new(
            "dress".to_owned(),
            [0, 0],
            surface,
            (&force, &[coarse, fine], &[]),
            Fading { blend: 0.1, most: 1e-3 },
        );
        let greatest = |map: Mat3, away: Vec3| {
            let to = |x: &Vec3| map * *x + away;
            let positions: Vec<Vec3> = force.hierarchy().rest.iter().map(to).collect();
            let off = |(x, tie): (&Vec3, &Tie)| (tie.of(&positions, 0) - to(x)).length();
            dress.ties.iter().flat_map(|ties| dress.rest().iter().zip(ties)).map(off).fold(0.0, f64::max)
        };
        assert!(greatest(Mat3::IDENTITY, Vec3::ZERO) < 1e-15);
        let turn = exponential(Vec3::new(1.9, -0.7, 1.1));
        assert!(greatest(turn, Vec3::new(0.2, 0.0, -0.1)) < 1e-14);
        let stretch =
            Mat3::from_columns(Vec3::new(1.3, 0.0, -0.3), Vec3::new(0.2, 0.9, 0.0), Vec3::new(0.0, 0.0, 1.1));
        assert!(greatest(stretch, Vec3::ZERO) < 1e-14);
    }
}
