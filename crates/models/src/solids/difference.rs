//! A force whose tangent products are differences of the force: two evaluations in the place of a derivative.
//!
//! `δf ≈ (f(x + ε δ) - f(x - ε δ)) / 2ε` with `ε δ` a small part of a cell at its largest (Faure 2014, eq. 6.1, along a direction
//! and central). Of St. Venant–Kirchhoff's law, whose force is cubic, the error is `ε²/6 f'''[δ, δ, δ]` and rounding. For solvers
//! without a matrix; blocks, where they are asked for, are the exact ones.

use std::any::Any;
use std::ops::Range;

use souple_engine::state::Pair;
use souple_engine::{
    Adapted, CellField, Configuration, Declaration, Editable, Energy, Force, LawChanges, ParameterError,
    Scratch, TangentWeights,
};
use souple_math::Vec3;
use souple_mesh::Mesh;
use souple_solve::BlockMatrix;

/// Part of a cell that points are moved by: its square is about the error, and rounding over it.
const PART_OF_CELL: f64 = 1e-5;

/// A force of positions alone, with tangent products by differences.
pub struct DifferencedForce {
    inner: Box<dyn Force>,
    /// The only rows that the force reads and pulls.
    rows: Range<usize>,
    /// The farthest that a point is moved [m].
    distance: f64,
}

struct DifferenceScratch {
    inner: Scratch,
    moved: Vec<Vec3>,
    forces: [Vec<Vec3>; 2],
}

fn of(scratch: &mut Scratch) -> &mut DifferenceScratch {
    scratch.downcast_mut().unwrap_or_else(|| unreachable!("made by this force's own new_scratch"))
}

impl DifferencedForce {
    /// Of a force on the cells of a mesh whose points are the rows from `first_row`.
    pub fn new(inner: Box<dyn Force>, mesh: &Mesh, first_row: usize) -> Self {
        let cell = mesh.volume() / mesh.cell_count() as f64;
        let rows = first_row..first_row + mesh.points.len();
        Self { inner, rows, distance: PART_OF_CELL * cell.abs().cbrt() }
    }
}

impl Force for DifferencedForce {
    fn name(&self) -> &str {
        self.inner.name()
    }

    fn acts_within(&self) -> bool {
        self.inner.acts_within()
    }

    fn declaration(&self) -> Declaration {
        self.inner.declaration()
    }

    fn memory_len(&self) -> usize {
        self.inner.memory_len()
    }

    fn initial_memory(&self, memory: &mut [f64]) {
        self.inner.initial_memory(memory);
    }

    fn new_scratch(&self) -> Scratch {
        let [moved, plus, minus] = [const { Vec::new() }; 3];
        Box::new(DifferenceScratch { inner: self.inner.new_scratch(), moved, forces: [plus, minus] })
    }

    fn energy(&self, at: &Configuration, scratch: &mut Scratch) -> Energy {
        self.inner.energy(at, &mut of(scratch).inner)
    }

    fn add_force(&self, at: &Configuration, scratch: &mut Scratch, out: &mut [Vec3]) {
        self.inner.add_force(at, &mut of(scratch).inner, out);
    }

    fn add_differential(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        scratch: &mut Scratch,
        out: &mut [Vec3],
    ) {
        let rows = self.rows.clone();
        let farthest = delta[rows.clone()].iter().map(|d| d.length_sq()).fold(0.0, f64::max).sqrt();
        if weights.position == 0.0 || farthest == 0.0 {
            return;
        }
        let step = self.distance / farthest;
        let DifferenceScratch { inner, moved, forces } = of(scratch);
        for (force, step) in forces.iter_mut().zip([step, -step]) {
            moved.resize(at.positions.len(), Vec3::ZERO);
            for ((moved, x), d) in
                moved[rows.clone()].iter_mut().zip(&at.positions[rows.clone()]).zip(&delta[rows.clone()])
            {
                *moved = *x + *d * step;
            }
            force.resize(out.len(), Vec3::ZERO);
            force[rows.clone()].fill(Vec3::ZERO);
            self.inner.add_force(&Configuration { positions: moved, ..*at }, inner, force);
        }
        let [plus, minus] = forces;
        for ((out, plus), minus) in out[rows.clone()].iter_mut().zip(&plus[rows.clone()]).zip(&minus[rows]) {
            *out += (*plus - *minus) * (0.5 * weights.position / step);
        }
    }

    fn visit_cliques(&self, pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        self.inner.visit_cliques(pairs, visit);
    }

    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        self.inner.add_blocks(at, weights, &mut of(scratch).inner, matrix);
    }

    fn add_definite_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) -> bool {
        self.inner.add_definite_blocks(at, weights, &mut of(scratch).inner, matrix)
    }

    fn advance_memory(&self, at: &Configuration, timestep: f64, memory: &mut [f64], pairs: &mut [Pair]) {
        self.inner.advance_memory(at, timestep, memory, pairs);
    }

    fn ends_steps(&self) -> bool {
        self.inner.ends_steps()
    }

    fn end_step(&self, positions: &[Vec3], timestep: f64, memory: &mut [f64]) -> bool {
        self.inner.end_step(positions, timestep, memory)
    }

    fn editable(&self) -> Vec<Editable> {
        self.inner.editable()
    }

    fn set_parameter(&mut self, name: &str, value: f64) -> Result<(), ParameterError> {
        self.inner.set_parameter(name, value)
    }

    fn cell_field(&self, cell: usize, positions: &[Vec3]) -> Option<CellField> {
        self.inner.cell_field(cell, positions)
    }

    fn cell_field_at(&self, cell: usize, at: &Configuration) -> Option<CellField> {
        self.inner.cell_field_at(cell, at)
    }

    fn rest_volume(&self, cell: usize) -> Option<f64> {
        self.inner.rest_volume(cell)
    }

    fn adapted_law(&self, cell: usize, at: &Configuration) -> Option<f64> {
        self.inner.adapted_law(cell, at)
    }

    fn adapted(&self, cell: usize, at: &Configuration) -> Option<Adapted> {
        self.inner.adapted(cell, at)
    }

    fn law_changes(&self, at: &Configuration) -> Option<LawChanges> {
        self.inner.law_changes(at)
    }

    fn bytes(&self) -> usize {
        self.inner.bytes()
    }

    fn scratch_bytes(&self, scratch: &Scratch) -> usize {
        scratch.downcast_ref().map_or(0, |DifferenceScratch { inner, moved, forces }| {
            let buffers = forces.iter().chain([moved]).map(Vec::capacity).sum::<usize>();
            size_of::<Vec3>() * buffers + self.inner.scratch_bytes(inner)
        })
    }

    fn as_any(&self) -> &dyn Any {
        self.inner.as_any()
    }
}
