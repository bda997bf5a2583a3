//! Relations between points that are kept by forces which the step solves for.
//!
//! A relation `g(x, t)` of up to three components is to have the value `w` where a step ends. The force that brings it there is
//! `Jᵀ λ` with the gradients `J = ∂g/∂x` where the step starts, so that the step ends at
//!
//! `x' = x + h v + h² W (f + Jᵀ λ)`, `g(x', t') = w`,
//!
//! with the inverse masses `W`, zero along what pins hold. The multipliers `λ` follow by Newton's method with the matrix of the
//! start, `J W Jᵀ δλ = (w − g(x', t'))/h²`, which is symmetric and as sparse as relations share points. Relations that hold at
//! both ends of a step are those of SHAKE (Ryckaert, Ciccotti & Berendsen 1977): it is symplectic, and of second order.
//!
//! Relations may repeat each other: the matrix is then singular, and its diagonal is raised by [`RAISE`] of itself. What is left
//! of that is gone after a few of the solves that are made anyway, and of all forces that do the same those with the least
//! `Σ (J W Jᵀ)_cc λ_c²` are found. Relations that contradict each other are told, not shared out.

use std::sync::Arc;

use souple_math::{Mat3, Vec3};
use souple_solve::{BlockMatrix, DirectSolver, PatternBuilder, SolveError};

use crate::force::{Configuration, Force};
use crate::state::SystemState;
use crate::steppers::{Step, StepError};
use crate::system::{System, SystemWorkspace};

/// Of a diagonal entry, what is added to it: far above rounding, so that relations which repeat others have a pivot, and far
/// below the least eigenvalue of the scaled matrix of thousands of rods in a row, `(π/n)²/2`, so that solves converge.
const RAISE: f64 = 1e-8;
/// How far off a relation may be, of what it changes by when its points move by their greatest coordinate: places are known to
/// `2e-16` of that, and sums over thousands of them to this.
const TOLERANCE: f64 = 1e-12;
/// Each takes a share of the error away that is the square of the angle by which gradients turn within the step.
const MOST_SOLVES: u32 = 50;
/// On the diagonal of a component that no force can change: it is not solved for.
const IDLE: f64 = 1.0;

/// What of a force relates points.
pub trait Binding: Send + Sync {
    fn relation_count(&self) -> usize;

    /// Rows that a relation is of, each once.
    fn rows(&self, relation: usize) -> &[u32];

    /// `g(x, t)`; zero in the components that it has not.
    fn value(&self, relation: usize, positions: &[Vec3], time: f64) -> Vec3;

    /// `∂g/∂x` for each of its rows in turn: the gradient of a component in each row of the matrix.
    fn add_gradients(&self, relation: usize, positions: &[Vec3], time: f64, gradients: &mut Vec<Mat3>);

    /// The value that it is to have where a step of `timestep` from `start` ends, by those one step before and where it starts.
    fn wanted(&self, relation: usize, values: [Vec3; 2], start: f64, timestep: f64) -> Vec3;

    /// What it is, in words.
    fn describe(&self, relation: usize) -> String;
}

/// Numbers in the memory of a force with so many relations: the work that it has done [J], then the multipliers.
pub fn memory_len(relations: usize) -> usize {
    1 + 3 * relations
}

/// The multipliers of a relation, by the memory of its force.
pub fn multiplier(memory: &[f64], relation: usize) -> Vec3 {
    let first = 1 + 3 * relation;
    Vec3::new(memory[first], memory[first + 1], memory[first + 2])
}

/// Sets [`multiplier`].
pub fn set_multiplier(memory: &mut [f64], relation: usize, multiplier: Vec3) {
    let first = 1 + 3 * relation;
    memory[first..first + 3].copy_from_slice(&multiplier.to_array());
}

/// `out += Jᵀ λ` of the multipliers in a force's memory.
pub fn add_forces(binding: &dyn Binding, at: &Configuration, out: &mut [Vec3]) {
    let mut gradients = Vec::new();
    for relation in 0..binding.relation_count() {
        let multiplier = multiplier(at.memory, relation);
        if multiplier == Vec3::ZERO {
            continue;
        }
        gradients.clear();
        binding.add_gradients(relation, at.positions, at.time, &mut gradients);
        for (row, gradient) in binding.rows(relation).iter().zip(&gradients) {
            out[*row as usize] += gradient.transpose_apply(multiplier);
        }
    }
}

/// Scratch of the relations of a system, kept between steps.
#[derive(Debug, Default)]
pub(crate) struct Bound {
    structure: Option<Structure>,
    /// For each entry of the structure.
    gradients: Vec<Mat3>,
    /// By row [1/kg].
    inverse_masses: Vec<Mat3>,
    /// One step before, and where the step leads [m].
    before: Vec<Vec3>,
    places: Vec<Vec3>,
    velocities: Vec<Vec3>,
    wanted: Vec<Vec3>,
    /// Of each relation, in the units of its components.
    off: Vec<Vec3>,
    change: Vec<Vec3>,
    multipliers: Vec<Vec3>,
    /// The multipliers that the step before ended with.
    before_step: Vec<Vec3>,
    /// Ones in the components that forces change.
    active: Vec<Vec3>,
}

/// What of the relations of a system stays from step to step.
#[derive(Debug)]
struct Structure {
    /// The force and the number within it of each relation.
    relations: Vec<(usize, usize)>,
    /// Where the entries of each begin, and at the end of the list how many there are.
    starts: Vec<usize>,
    /// The row of each entry.
    rows: Vec<u32>,
    /// Slot of the matrix, and the two entries of one row whose product goes there.
    products: Vec<(u32, [u32; 2])>,
    matrix: BlockMatrix,
    solver: DirectSolver,
}

impl System {
    /// Whether forces relate points that a step is to solve for.
    pub fn binds(&self) -> bool {
        self.forces.iter().any(|force| force.binding().is_some())
    }

    fn binding(&self, force: usize) -> Option<&dyn Binding> {
        self.forces[force].binding()
    }
}

impl Structure {
    fn new(system: &System) -> Result<Self, SolveError> {
        let (mut relations, mut starts, mut rows) = (Vec::new(), vec![0], Vec::new());
        let forces = system.forces.iter().map(AsRef::as_ref).enumerate();
        for (force, binding) in
            forces.filter_map(|(index, force): (usize, &dyn Force)| Some((index, force.binding()?)))
        {
            for relation in 0..binding.relation_count() {
                relations.push((force, relation));
                rows.extend_from_slice(binding.rows(relation));
                starts.push(rows.len());
            }
        }
        let mut of_row: Vec<Vec<(u32, u32)>> = vec![Vec::new(); system.kinematics.row_count()];
        for (relation, entries) in starts.windows(2).enumerate() {
            for entry in entries[0]..entries[1] {
                of_row[rows[entry] as usize].push((relation as u32, entry as u32));
            }
        }
        let mut pattern = PatternBuilder::new(relations.len());
        for related in &of_row {
            let clique: Vec<u32> = related.iter().map(|(relation, _)| *relation).collect();
            pattern.add_clique(&clique)?;
        }
        let pattern = Arc::new(pattern.build()?);
        let mut products = Vec::new();
        for related in &of_row {
            for (a, entry_a) in related {
                for (b, entry_b) in related {
                    let (row, column) = (*a as usize, *b as usize);
                    let slot = pattern.slot(row, column).ok_or(SolveError::NoSlot { row, column })?;
                    products.push((slot as u32, [*entry_a, *entry_b]));
                }
            }
        }
        let solver = DirectSolver::analyse(&pattern, None)?;
        Ok(Self { relations, starts, rows, products, matrix: BlockMatrix::zeros(pattern), solver })
    }

    /// `W Jᵀ λ` of all relations, scaled and added to rows.
    fn spread(
        &self,
        scale: f64,
        multipliers: &[Vec3],
        gradients: &[Mat3],
        inverse: &[Mat3],
        rows: &mut [Vec3],
    ) {
        for (entries, multiplier) in self.starts.windows(2).zip(multipliers) {
            for entry in entries[0]..entries[1] {
                let row = self.rows[entry] as usize;
                rows[row] += inverse[row] * gradients[entry].transpose_apply(*multiplier) * scale;
            }
        }
    }
}

/// Adds the forces that keep relations to the forces on the placed rows, and remembers them. For steps from `x` and `v` to
/// `v' = v + h f/m`, `x' = x + h v'` of points with lumped masses.
///
/// # Errors
/// Relations that no forces keep.
pub(crate) fn bind(step: &Step, next: &mut SystemState, ws: &mut SystemWorkspace) -> Result<(), StepError> {
    let clock = std::time::Instant::now();
    let mut bound = std::mem::take(&mut ws.bound);
    let kept = bound.keep(step, next, ws);
    ws.bound = bound;
    ws.stages.solve += clock.elapsed().as_secs_f64();
    kept
}

fn unsolved(error: SolveError) -> StepError {
    StepError::Linear { error: error.to_string(), block: None }
}

impl Bound {
    fn keep(
        &mut self,
        step: &Step,
        next: &mut SystemState,
        ws: &mut SystemWorkspace,
    ) -> Result<(), StepError> {
        let mut structure = match self.structure.take() {
            Some(structure) => structure,
            None => Structure::new(step.system).map_err(unsolved)?,
        };
        self.lead(step, ws);
        self.look(step, &structure, &ws.rows.positions);
        self.assemble(&mut structure);
        structure.solver.factorize(&structure.matrix).map_err(unsolved)?;
        self.take_off(step, &structure, next);
        self.solve(step, &structure)?;
        self.give(step.system, &structure, next, &mut ws.row_force);
        self.structure = Some(structure);
        Ok(())
    }

    /// Takes the forces of the step before, which are among those that were summed, off where the step leads: such as do what others do
    /// too would never leave.
    fn take_off(&mut self, step: &Step, structure: &Structure, next: &SystemState) {
        self.before_step.clear();
        self.before_step.extend(
            structure.relations.iter().map(|(force, relation)| {
                multiplier(&next.memory[step.system.memory_range(*force)], *relation)
            }),
        );
        let scale = -step.timestep * step.timestep;
        structure.spread(scale, &self.before_step, &self.gradients, &self.inverse_masses, &mut self.places);
    }

    /// Finds the multipliers under which the step leads to where all relations are what they are to be.
    fn solve(&mut self, step: &Step, structure: &Structure) -> Result<(), StepError> {
        let square = step.timestep * step.timestep;
        self.multipliers.clear();
        self.multipliers.resize(structure.relations.len(), Vec3::ZERO);
        let mut solves = 0;
        while let Some(worst) = self.farthest_off(step, structure) {
            if solves == MOST_SOLVES {
                return Err(self.unkept(step, structure, worst));
            }
            solves += 1;
            self.change.clear();
            let active = self.off.iter().zip(&self.active);
            self.change.extend(active.map(|(off, active)| Mat3::from_diagonal(*active) * *off / square));
            structure.solver.solve(&mut self.change).map_err(unsolved)?;
            structure.spread(square, &self.change, &self.gradients, &self.inverse_masses, &mut self.places);
            for (multiplier, change) in self.multipliers.iter_mut().zip(&self.change) {
                *multiplier += *change;
            }
        }
        Ok(())
    }

    fn unkept(&self, step: &Step, structure: &Structure, worst: usize) -> StepError {
        let (force, relation) = structure.relations[worst];
        StepError::Unkept {
            force: step.system.forces[force].name().to_owned(),
            relation: step.system.binding(force).map_or_else(String::new, |it| it.describe(relation)),
            off: self.off[worst].length(),
            row: structure.rows[structure.starts[worst]] as usize,
            time: step.end(),
        }
    }

    /// Where the step leads without new forces, and where a step before led here.
    fn lead(&mut self, step: &Step, ws: &SystemWorkspace) {
        let Step { system, around, timestep, .. } = *step;
        let (q, v) = (&ws.rows.positions, &ws.rows.velocities);
        self.inverse_masses.clear();
        self.inverse_masses.extend(system.mass.diagonal.iter().map(|mass| Mat3::IDENTITY * mass.recip()));
        for constraint in &system.constraints {
            let inverse = &mut self.inverse_masses[constraint.block as usize];
            *inverse = constraint.free * *inverse;
        }
        let points = || q.iter().zip(v);
        self.before.clear();
        self.before.extend(points().map(|(x, v)| *x - *v * timestep));
        let forces = ws.row_force.iter().zip(&system.mass.diagonal);
        self.velocities.clear();
        self.velocities
            .extend(v.iter().zip(forces).map(|(v, (force, mass))| *v + *force * (timestep / mass)));
        self.places.clear();
        self.places.extend(q.iter().zip(&self.velocities).map(|(x, v)| *x + *v * timestep));
        system.impose_constraints(&mut self.places, &mut self.velocities, step.end(), around.load);
    }

    /// Gradients where the step starts, and the values that are wanted where it ends.
    fn look(&mut self, step: &Step, structure: &Structure, positions: &[Vec3]) {
        let Step { system, start, timestep, .. } = *step;
        self.gradients.clear();
        self.wanted.clear();
        for (force, relation) in &structure.relations {
            let Some(binding) = system.binding(*force) else { continue };
            binding.add_gradients(*relation, positions, start, &mut self.gradients);
            // there is nothing before the start: a formula may have no value there
            let before = binding.value(*relation, &self.before, (start - timestep).max(0.0));
            let now = binding.value(*relation, positions, start);
            self.wanted.push(binding.wanted(*relation, [before, now], start, timestep));
        }
    }

    // J W Jᵀ
    fn assemble(&mut self, structure: &mut Structure) {
        structure.matrix.set_zero();
        for (slot, [a, b]) in &structure.products {
            let inverse = &self.inverse_masses[structure.rows[*a as usize] as usize];
            let product =
                (self.gradients[*a as usize] * *inverse).mul_transpose(&self.gradients[*b as usize]);
            structure.matrix.add_at(*slot as usize, &product);
        }
        self.active.clear();
        for relation in 0..structure.relations.len() {
            let slot = structure.matrix.pattern().diagonal_slot(relation);
            let diagonal = structure.matrix.values()[slot].diagonal();
            let is_active = diagonal.to_array().map(|entry| if entry > 0.0 { 1.0 } else { 0.0 });
            self.active.push(Vec3::from_array(is_active));
            let raised = diagonal.to_array().map(|entry| if entry > 0.0 { RAISE * entry } else { IDLE });
            structure.matrix.add_at(slot, &Mat3::from_diagonal(Vec3::from_array(raised)));
        }
    }

    /// The relation that is farthest from what it is to be where the step leads; `None` where all are near enough.
    fn farthest_off(&mut self, step: &Step, structure: &Structure) -> Option<usize> {
        let system = step.system;
        let coordinates = structure.rows.iter().flat_map(|row| self.places[*row as usize].to_array());
        let scale = coordinates.fold(0.0_f64, |largest, x| largest.max(x.abs()));
        self.off.clear();
        let mut worst: Option<(usize, f64)> = None;
        for (index, (force, relation)) in structure.relations.iter().enumerate() {
            let Some(binding) = system.binding(*force) else { continue };
            let off = self.wanted[index] - binding.value(*relation, &self.places, step.end());
            self.off.push(off);
            let entries = structure.starts[index]..structure.starts[index + 1];
            let gradients = &self.gradients[entries];
            for component in 0..3 {
                let slope: f64 = gradients.iter().map(|gradient| gradient.row(component).length()).sum();
                let (off, near) = (off[component].abs(), TOLERANCE * slope * scale);
                let by = if off <= near { 0.0 } else { off / near };
                // what is no number is never near
                if by.is_nan() || (by > 0.0 && worst.is_none_or(|(_, known)| by > known)) {
                    worst = Some((index, if by.is_nan() { f64::INFINITY } else { by }));
                }
            }
        }
        worst.map(|(index, _)| index)
    }

    /// Adds the change of forces to those on rows, along what is free, and remembers multipliers and work.
    fn give(&self, system: &System, structure: &Structure, next: &mut SystemState, row_force: &mut [Vec3]) {
        for (index, (force, relation)) in structure.relations.iter().enumerate() {
            let memory = &mut next.memory[system.memory_range(*force)];
            set_multiplier(memory, *relation, self.multipliers[index]);
            for entry in structure.starts[index]..structure.starts[index + 1] {
                let row = structure.rows[entry] as usize;
                let whole = self.gradients[entry].transpose_apply(self.multipliers[index]);
                let change = self.multipliers[index] - self.before_step[index];
                let change = self.gradients[entry].transpose_apply(change);
                // m (W f) is f along what is free
                row_force[row] += self.inverse_masses[row] * change * system.mass.diagonal[row];
                // ½ m v'² − ½ m v² = f·(v + v') h/2
                memory[0] += 0.5 * whole.dot(self.places[row] - self.before[row]);
            }
        }
    }

    pub(crate) fn bytes(&self) -> usize {
        let vectors = [
            &self.before,
            &self.places,
            &self.velocities,
            &self.wanted,
            &self.off,
            &self.change,
            &self.multipliers,
            &self.before_step,
            &self.active,
        ];
        let matrices = self.gradients.capacity() + self.inverse_masses.capacity();
        vectors.into_iter().map(|vector| size_of::<Vec3>() * vector.capacity()).sum::<usize>()
            + size_of::<Mat3>() * matrices
            + self.structure.as_ref().map_or(0, |structure| {
                size_of_val(structure.products.as_slice())
                    + structure.matrix.bytes()
                    + structure.solver.bytes()
            })
    }
}
