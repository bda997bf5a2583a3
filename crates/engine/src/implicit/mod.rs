//! One implicit step as a nonlinear problem: whatever formula of time is behind it ([`Rates`]), and statics as its
//! limit without inertia.
//!
//! The iteration is `souple_solve::newton`; what is particular to a step stays here, before and around it. Prescribed
//! motion is a predictor: one linearised solve carries the constrained components to where they are led, and Newton
//! then works on the free ones alone, so that its merit function is one potential throughout. The merit is the
//! incremental potential where there is one; with damping there still is one as long as tangents are symmetric, known
//! by its slopes. Rounding bounds what residual can be asked for.

mod history;
mod newton;
mod rates;

use std::time::Instant;

use souple_math::Vec3;
use souple_solve::newton as iteration;
use souple_solve::reduce::norm;

use crate::force::{Scratch, TangentWeights};
use crate::linear::{ByReference, Indefinite, LinearError, LinearSystem, Solved, Use};
use crate::state::SystemState;
use crate::steppers::{StepError, StepReport};
use crate::system::{Rows, Surroundings, System, SystemWorkspace};
use crate::tangent::{Assembled, Curvature, Linearisation, OperatorBuffers, Part, TangentOperator};

pub use history::Lent;
pub(crate) use history::{accepts, carried, carry};
pub use rates::Rates;

/// Halvings of a direction before what is left of it is taken.
const MAX_HALVINGS: u32 = 30;
/// Potentials are sums of terms that cancel: what rises by less than this share of them is not held back.
const POTENTIAL_ROUNDING: f64 = 1e-10;

/// The step from `(q_start, v_start)` to the end of `timestep`.
pub struct ImplicitStep<'a> {
    pub system: &'a System,
    pub around: Surroundings<'a>,
    /// Seconds at the end of the step.
    pub end: f64,
    /// How velocity and acceleration at the end follow from the displacement.
    pub rates: Rates,
    /// Whether all forces are minus the gradient of an energy, so that the step minimises a potential.
    pub has_potential: bool,
}

/// How Newton's method iterates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewtonSettings {
    /// Wanted norm of the unbalanced force, relative to the largest there was.
    pub tolerance: f64,
    pub max_iterations: u32,
}

/// Buffers of [`ImplicitStep`] in the size of blocks and rows.
pub struct ImplicitBuffers {
    /// Configuration and velocity at the start of the step.
    pub q_start: Vec<Vec3>,
    /// Where a linearised solve that was taken in part leads.
    pub shortened: Vec<Vec3>,
    pub v_start: Vec<Vec3>,
    /// `v₀` of [`Rates`].
    pub velocity_offset: Vec<Vec3>,
    /// `p` of [`Rates`], over velocity blocks and over rows; those over rows are empty where rows are blocks.
    pub coasting: Vec<Vec3>,
    coasting_rows: Vec<Vec3>,
    /// For formulas, in the size of the velocity.
    pub displacement: Vec<Vec3>,
    /// `-r = -Tᵀ g` over blocks, constrained components zero: the force that is not balanced.
    residual: Vec<Vec3>,
    /// `g` over rows.
    unbalanced: Vec<Vec3>,
    direction: Vec<Vec3>,
    prescribed: Vec<Vec3>,
    rhs: Vec<Vec3>,
    /// Accepted by Newton's method; empty where one solve does.
    q: Vec<Vec3>,
    q_trial: Vec<Vec3>,
    v_trial: Vec<Vec3>,
    /// Turns of frames by themselves, and what inertia is where they lead, over rows and over blocks; for one linearised solve with rigid
    /// frames, empty elsewhere.
    turns: Vec<Vec3>,
    inertia: Vec<Vec3>,
    inertia_residual: Vec<Vec3>,
    /// Empty where no force has velocity terms.
    at_offset: Vec<Vec3>,
    damping: Vec<Vec3>,
    /// Empty where rows are points.
    block_positions: Vec<Vec3>,
    operator: OperatorBuffers,
    newton: iteration::Workspace,
}

impl ImplicitBuffers {
    pub fn new(system: &System) -> Self {
        let blocks = || vec![Vec3::ZERO; system.kinematics.block_count()];
        let rows = || vec![Vec3::ZERO; system.kinematics.row_count()];
        let free_rows = || vec![Vec3::ZERO; system.kinematics.free_row_count()];
        Self {
            q_start: free_rows(),
            v_start: blocks(),
            velocity_offset: blocks(),
            coasting: blocks(),
            coasting_rows: if system.kinematics.is_trivial() { Vec::new() } else { rows() },
            displacement: blocks(),
            residual: blocks(),
            unbalanced: rows(),
            direction: blocks(),
            prescribed: blocks(),
            rhs: blocks(),
            q: Vec::new(),
            q_trial: free_rows(),
            v_trial: blocks(),
            turns: Vec::new(),
            inertia: Vec::new(),
            inertia_residual: Vec::new(),
            at_offset: Vec::new(),
            shortened: Vec::new(),
            damping: Vec::new(),
            block_positions: Vec::new(),
            operator: OperatorBuffers::new(system),
            newton: iteration::Workspace::default(),
        }
    }

    /// `p` over rows.
    fn row_coasting(&self) -> &[Vec3] {
        if self.coasting_rows.is_empty() { &self.coasting } else { &self.coasting_rows }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let buffers = [
            &self.q_start,
            &self.v_start,
            &self.velocity_offset,
            &self.coasting,
            &self.coasting_rows,
            &self.displacement,
            &self.residual,
            &self.unbalanced,
            &self.direction,
            &self.prescribed,
            &self.rhs,
            &self.q,
            &self.q_trial,
            &self.v_trial,
            &self.turns,
            &self.inertia,
            &self.inertia_residual,
            &self.at_offset,
            &self.shortened,
            &self.damping,
            &self.block_positions,
        ];
        buffers.into_iter().map(|buffer| size_of::<Vec3>() * buffer.capacity()).sum::<usize>()
            + self.operator.bytes()
            + self.newton.bytes()
    }
}

/// What constrained components do in a linear solve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Constrained {
    /// They stay where they are.
    Still,
    /// They go where they are led (`prescribed`), and take the others along.
    Led,
}

/// Where the iterations of a linear solve begin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Start {
    Zero,
    /// Where the velocities of the start lead: motion that goes on as it was is solved for already.
    Coasting,
}

/// What is asked of a linear solve.
#[derive(Clone, Copy, Debug)]
struct Wanted {
    from: Start,
    constrained: Constrained,
    indefinite: Indefinite,
    used_as: Use,
    /// As [`LinearSystem::tolerance`].
    tolerance: f64,
}

/// The velocity of constrained components at the end of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LedVelocity {
    /// That of their motion.
    Exact,
    /// As that of what is free beside them, half a step late: no rate of strain comes between them.
    Difference,
}

/// What came of a linear solve.
struct Attempt {
    solved: Result<Solved, LinearError>,
    /// The residual that rounding of positions makes.
    rounding: f64,
}

impl ImplicitStep<'_> {
    /// Starts from `next`: what was, with `v₀` and `p` as if nothing had been before, for a formula to change.
    pub fn begin(&self, next: &SystemState, buffers: &mut ImplicitBuffers) {
        buffers.q_start.copy_from_slice(&next.q);
        buffers.v_start.copy_from_slice(&next.v);
        buffers.velocity_offset.fill(Vec3::ZERO);
        buffers.coasting.copy_from_slice(&next.v);
    }

    /// `v₀` and `p` of constrained components such that they end with the acceleration of their motion, and with the velocity that is wanted.
    /// State holds their exact velocity, from which a difference quotient of one step sees half of their acceleration, and formulas of two
    /// steps follow late, or swing about it.
    pub fn lead_constrained(&self, timestep: f64, led: LedVelocity, buffers: &mut ImplicitBuffers) {
        for constraint in &self.system.constraints {
            let (block, constrained) = (constraint.block as usize, constraint.constrained());
            let d = self.system.to_go(constraint, &buffers.q_start, self.end, self.around.load);
            let acceleration = constraint.mean_acceleration(self.end, timestep);
            let offset = &mut buffers.velocity_offset[block];
            let velocity = match led {
                LedVelocity::Exact => constraint.velocity(self.end),
                LedVelocity::Difference => d * self.rates.velocity + *offset,
            };
            *offset += constrained * (velocity - d * self.rates.velocity - *offset);
            let coasting = &mut buffers.coasting[block];
            *coasting +=
                constrained * (velocity - acceleration * (1.0 / self.rates.acceleration) - *coasting);
        }
    }

    /// Velocity that a configuration implies, `a difference(q, q_start) + v₀`; zero in statics.
    pub fn velocity_into(&self, q: &[Vec3], q_start: &[Vec3], offset: &[Vec3], v: &mut [Vec3]) {
        if self.rates.has_velocity() {
            self.system.kinematics.difference(q, q_start, v);
            v.iter_mut().zip(offset).for_each(|(v, offset)| *v = *v * self.rates.velocity + *offset);
        } else {
            v.fill(Vec3::ZERO);
        }
    }

    /// Row velocities from which acceleration counts.
    fn place_coasting(&self, buffers: &mut ImplicitBuffers) {
        let ImplicitBuffers { q_start, coasting, coasting_rows, operator, .. } = buffers;
        if !coasting_rows.is_empty() {
            // rows with a mass are among those at work
            match operator.rows_at_work(self.system) {
                Some(derived) => {
                    let kinematics = &self.system.kinematics;
                    kinematics.free_velocities_into(q_start, coasting, &mut coasting_rows[..q_start.len()]);
                    kinematics.derive_some_rows(derived, coasting_rows);
                }
                None => self.system.kinematics.velocities_into(q_start, coasting, coasting_rows),
            }
        }
    }

    /// Rows at the trial, as far as forces look at them.
    fn place_trial(&self, ws: &mut SystemWorkspace, buffers: &mut ImplicitBuffers) {
        let ImplicitBuffers { q_trial, v_trial, operator, .. } = buffers;
        match operator.rows_at_work(self.system) {
            Some(derived) => {
                let Rows { positions, velocities, time } = &mut ws.rows;
                *time = self.end;
                self.system.kinematics.some_rows_into(q_trial, v_trial, derived, positions, velocities);
            }
            None => self.system.place_rows(q_trial, v_trial, self.end, &mut ws.rows),
        }
    }

    /// `g = b M (ẋ - p) - f` over rows and `-Tᵀ g` without constrained components at `(q_trial, v_trial)`;
    /// returns the norm of the latter.
    fn evaluate(&self, state: &SystemState, ws: &mut SystemWorkspace, buffers: &mut ImplicitBuffers) -> f64 {
        self.place_trial(ws, buffers);
        self.place_inertia(ws, buffers);
        self.add_forces(state, ws, buffers);
        self.contract(ws, buffers);
        norm(&buffers.residual)
    }

    /// `g -= f` at the placed rows.
    fn add_forces(&self, state: &SystemState, ws: &mut SystemWorkspace, buffers: &mut ImplicitBuffers) {
        let clock = Instant::now();
        self.system.sum_row_forces(&ws.rows, state, &self.around, &mut ws.scratches, &mut ws.row_force);
        ws.stages.forces += clock.elapsed().as_secs_f64();
        for (g, f) in buffers.unbalanced.iter_mut().zip(&ws.row_force) {
            *g -= *f;
        }
    }

    /// `g = b M (ẋ - p)` with the velocities of the placed rows.
    fn place_inertia(&self, ws: &mut SystemWorkspace, buffers: &mut ImplicitBuffers) {
        buffers.unbalanced.fill(Vec3::ZERO);
        if self.rates.has_inertia() {
            let coasting = buffers.row_coasting();
            for ((change, now), before) in ws.row_scratch.iter_mut().zip(&ws.rows.velocities).zip(coasting) {
                *change = (*now - *before) * self.rates.acceleration;
            }
            let ImplicitBuffers { operator, unbalanced, .. } = buffers;
            operator.add_mass_product(self.system, &ws.row_scratch, unbalanced);
        }
    }

    /// `-Tᵀ g` without constrained components.
    fn contract(&self, ws: &mut SystemWorkspace, buffers: &mut ImplicitBuffers) {
        for (minus, g) in ws.row_scratch.iter_mut().zip(&buffers.unbalanced) {
            *minus = -*g;
        }
        self.system.kinematics.forces_into(&buffers.q_trial, &mut ws.row_scratch, &mut buffers.residual);
        self.system.project_free(&mut buffers.residual);
    }

    /// The incremental potential `½ b/a Σ m |ẋ - p|² + E(x)` at the placed rows: minus its gradient is the residual. For
    /// backward Euler the first part is `Σ m |x - x̂|²/(2 h²)`, `x̂` where inertia alone would lead.
    fn merit(&self, state: &SystemState, ws: &mut SystemWorkspace, buffers: &mut ImplicitBuffers) -> f64 {
        let system = self.system;
        let mut stored = 0.0;
        for (index, force) in system.forces.iter().enumerate() {
            let at = system.view(index, &ws.rows, state, &self.around);
            stored += force.energy(&at, &mut ws.scratches[index]).stored;
        }
        if !self.rates.has_inertia() {
            return stored;
        }
        let coasting = buffers.row_coasting();
        for ((change, now), before) in ws.row_scratch.iter_mut().zip(&ws.rows.velocities).zip(coasting) {
            *change = *now - *before;
        }
        self.rates.potential() * buffers.operator.kinetic_energy(system, &ws.row_scratch) + stored
    }

    /// What is left of prescribed motion: how far constrained components are from where they are led.
    fn prescribed_into(&self, q: &[Vec3], prescribed: &mut [Vec3]) -> f64 {
        prescribed.fill(Vec3::ZERO);
        for constraint in &self.system.constraints {
            let to_go = self.system.to_go(constraint, q, self.end, self.around.load);
            prescribed[constraint.block as usize] += constraint.constrained() * to_go;
        }
        let to_go = norm(prescribed);
        if to_go <= 1e-14 * norm(q) { 0.0 } else { to_go }
    }

    /// `direction = A⁻¹ residual` at `(q_trial, v_trial)`.
    /// Returns also the residual that rounding of positions makes, `ε |diag(A) x|`.
    fn solve(
        &self,
        state: &SystemState,
        ws: &mut SystemWorkspace,
        buffers: &mut ImplicitBuffers,
        wanted: Wanted,
    ) -> Result<(Solved, f64), StepError> {
        buffers.rhs.copy_from_slice(&buffers.residual);
        if wanted.constrained == Constrained::Led {
            self.lift_prescribed(state, ws, buffers);
        }
        // places and axes of frames have no scale in common: part by part a matrix is made definite in the scale of each, where shifted as a
        // whole, or stopped on the way, it would be so in that of the stiffest, and what is soft beside it would creep
        let has_parts = self.system.kinematics.has_frames()
            && !ws.linear.is_matrix_free()
            && wanted.used_as == Use::Direction
            && (self.is_symmetric() || self.turns_alone_break_symmetry());
        let first = if has_parts { Wanted { indefinite: Indefinite::Refuse, ..wanted } } else { wanted };
        let mut attempt = self.attempt(Curvature::Exact, state, ws, buffers, first);
        let is_indefinite =
            |attempt: &Attempt| attempt.solved.as_ref().is_err_and(LinearError::may_be_indefinite);
        if !ws.linear.is_matrix_free() && is_indefinite(&attempt) {
            // a direction in which the potential falls, where there is one; Newton's method judges it by the residual
            attempt = self.attempt(Curvature::Definite, state, ws, buffers, first);
        }
        if has_parts && is_indefinite(&attempt) {
            attempt = self.attempt(Curvature::Exact, state, ws, buffers, wanted);
        }
        if attempt.solved.as_ref().is_err_and(LinearError::is_not_finite)
            && let Some(error) = self.force_not_finite(state, ws)
        {
            return Err(error);
        }
        let ImplicitBuffers { residual, direction, prescribed, .. } = buffers;
        self.system.project_free(direction);
        if wanted.constrained == Constrained::Led {
            for (direction, prescribed) in direction.iter_mut().zip(prescribed.iter()) {
                *direction += *prescribed;
            }
        }
        let solved = attempt.solved.map_err(|error| {
            let most_left = || largest(residual).filter(|_| error.may_be_indefinite());
            LinearError { block: error.block.or_else(most_left), ..error }
        })?;
        Ok((solved, attempt.rounding))
    }

    /// The force at the placed rows that spoils a linear system, by itself or by its slope.
    fn force_not_finite(&self, state: &SystemState, ws: &mut SystemWorkspace) -> Option<StepError> {
        let SystemWorkspace { scratches, rows, .. } = ws;
        let weights = TangentWeights { position: -1.0, velocity: -self.rates.velocity };
        let slope = |scratches: &mut [Scratch]| {
            self.system.first_slope_not_finite(rows, state, &self.around, weights, scratches)
        };
        self.system.first_force_not_finite(rows, state, &self.around, scratches).or_else(|| slope(scratches))
    }

    /// Takes from the right-hand side what prescribed motion brings: `A (δ_free + δ_prescribed) = -r`.
    fn lift_prescribed(&self, state: &SystemState, ws: &mut SystemWorkspace, buffers: &mut ImplicitBuffers) {
        let SystemWorkspace { scratches, rows, stages, .. } = ws;
        let ImplicitBuffers { unbalanced, direction, prescribed, rhs, q_trial, v_trial, operator, .. } =
            buffers;
        let clock = Instant::now();
        let at = self.linearisation(state, rows, (q_trial, v_trial), unbalanced);
        TangentOperator::new(&at, Part::Whole, scratches, operator)
            .apply_unconstrained(prescribed, direction);
        // it counts as assembly
        operator.take_seconds();
        for (rhs, lift) in rhs.iter_mut().zip(direction.iter()) {
            *rhs -= *lift;
        }
        self.system.project_free(rhs);
        stages.assembly += clock.elapsed().as_secs_f64();
    }

    fn linearisation<'a>(
        &'a self,
        state: &'a SystemState,
        rows: &'a Rows,
        (q, v): (&'a [Vec3], &'a [Vec3]),
        unbalanced: &'a [Vec3],
    ) -> Linearisation<'a> {
        Linearisation {
            system: self.system,
            state,
            around: self.around,
            rows,
            q,
            v,
            rates: self.rates,
            unbalanced,
        }
    }

    /// `direction = A⁻¹ rhs` with the tangent of a curvature.
    fn attempt(
        &self,
        curvature: Curvature,
        state: &SystemState,
        ws: &mut SystemWorkspace,
        buffers: &mut ImplicitBuffers,
        wanted: Wanted,
    ) -> Attempt {
        let system = self.system;
        if curvature == Curvature::Exact
            && ws.linear.takes_reference_factor(system, wanted.used_as)
            && self.is_symmetric_over_rows()
            && let Some(attempt) = self.attempt_by_reference(state, ws, buffers, wanted)
        {
            return attempt;
        }
        let SystemWorkspace { scratches, rows, tangent, linear, stages, .. } = ws;
        let ImplicitBuffers {
            unbalanced,
            direction,
            rhs,
            q_trial,
            v_trial,
            v_start,
            operator,
            block_positions,
            ..
        } = buffers;
        let at = self.linearisation(state, rows, (q_trial, v_trial), unbalanced);
        let is_matrix_free = linear.is_matrix_free();
        let is_symmetrised = !is_matrix_free
            && self.turns_alone_break_symmetry()
            && (wanted.used_as == Use::Answer || linear.wants_symmetry());
        let symmetric = is_symmetrised || self.is_symmetric();
        let positions = if system.kinematics.is_trivial() {
            &rows.positions
        } else {
            system.block_positions_into(&rows.positions, block_positions);
            &*block_positions
        };
        let clock = Instant::now();
        let Assembled { matrix, symmetric: nearby, turned } = if is_matrix_free {
            let matrix = tangent.assemble_diagonal(&at, scratches);
            Assembled { matrix, symmetric: None, turned: false }
        } else {
            tangent.assemble_with_symmetric(curvature, &at, scratches)
        };
        // of matrices that are not symmetric none is known to be definite: what friction adds to that is left out
        let (matrix, nearby, symmetric) = match nearby {
            Some(nearby) if turned => (nearby, None, system.kinematics.is_conservative()),
            nearby => (matrix, nearby.map(|nearby| &*nearby), symmetric),
        };
        if is_symmetrised {
            matrix.symmetrise();
        }
        stages.assembly += clock.elapsed().as_secs_f64();
        let weighted = (0..positions.len())
            .map(|block| (matrix.diagonal_block(block).trace() / 3.0 * positions[block].length()).powi(2));
        let rounding = f64::EPSILON * weighted.sum::<f64>().sqrt();
        let clock = Instant::now();
        let products = is_matrix_free.then(|| TangentOperator::new(&at, Part::Whole, scratches, operator));
        let linear_system = LinearSystem {
            matrix,
            operator: products.as_ref().map(|operator| operator as _),
            nearby,
            symmetric,
            kinematics: &system.kinematics,
            reference: history::reference(&system.kinematics, &state.history),
            positions,
            indefinite: match curvature {
                Curvature::Exact => wanted.indefinite,
                Curvature::Definite => Indefinite::Solve,
            },
            used_as: wanted.used_as,
            tolerance: wanted.tolerance,
        };
        self.begin_at(wanted.from, v_start, direction);
        let solved = linear.solve(linear_system, rhs, direction);
        stages.solve += clock.elapsed().as_secs_f64();
        stages.products += operator.take_seconds();
        Attempt { solved: solved.map(|solved| Solved { made_definite: turned, ..solved }), rounding }
    }

    /// Where a linear solve begins.
    fn begin_at(&self, from: Start, v_start: &[Vec3], direction: &mut [Vec3]) {
        direction.fill(Vec3::ZERO);
        if from == Start::Coasting && self.rates.has_inertia() {
            for (direction, velocity) in direction.iter_mut().zip(v_start) {
                *direction = *velocity * (1.0 / self.rates.velocity);
            }
            self.system.project_free(direction);
        }
    }

    /// `direction = A⁻¹ rhs` by products and the factor of the reference configuration; `None` where that does not do. Of turning frames
    /// the symmetric part counts.
    fn attempt_by_reference(
        &self,
        state: &SystemState,
        ws: &mut SystemWorkspace,
        buffers: &mut ImplicitBuffers,
        wanted: Wanted,
    ) -> Option<Attempt> {
        let system = self.system;
        let SystemWorkspace { scratches, rows, linear, stages, .. } = ws;
        let ImplicitBuffers {
            unbalanced,
            direction,
            rhs,
            q_trial,
            v_trial,
            v_start,
            operator,
            block_positions,
            ..
        } = buffers;
        let clock = Instant::now();
        let reference = history::reference(&system.kinematics, &state.history);
        let factor = linear.reference_factor(system, reference, self.rates, &self.around, scratches)?;
        factor.follow(&system.kinematics, q_trial);
        system.block_positions_into(&rows.positions, block_positions);
        let weighted = factor.diagonal().iter().zip(&*block_positions);
        let rounding = f64::EPSILON * weighted.map(|(d, x)| (d * x.length()).powi(2)).sum::<f64>().sqrt();
        stages.assembly += clock.elapsed().as_secs_f64();
        let clock = Instant::now();
        let at = self.linearisation(state, rows, (q_trial, v_trial), unbalanced);
        let Wanted { indefinite, used_as, tolerance, .. } = wanted;
        let asked = ByReference { indefinite, used_as, tolerance };
        let part = if system.kinematics.has_turning_frames() { Part::Symmetric } else { Part::Whole };
        let products = TangentOperator::new(&at, part, scratches, operator);
        self.begin_at(wanted.from, v_start, direction);
        let solved = linear.solve_by_reference(&products, &asked, rhs, direction);
        stages.solve += clock.elapsed().as_secs_f64();
        stages.products += operator.take_seconds();
        solved.map(|solved| Attempt { solved: Ok(solved), rounding })
    }

    /// Whether the tangent is symmetric: rigid frames turn on the way, and one-way rows take what they do not give.
    fn is_symmetric(&self) -> bool {
        !self.system.kinematics.has_turning_frames() && self.is_symmetric_over_rows()
    }

    /// Whether turning frames are all that makes the tangent not symmetric. About where they coast what they add is of the
    /// size of the turn in a step: one linearised step may leave it out, as it leaves out what else is of that order.
    fn turns_alone_break_symmetry(&self) -> bool {
        self.system.kinematics.has_turning_frames() && self.is_symmetric_over_rows()
    }

    fn is_symmetric_over_rows(&self) -> bool {
        self.system.kinematics.is_conservative()
            && self.system.forces.iter().all(|force| force.declaration().symmetric_tangent)
    }

    /// One linearisation about the start, for backward Euler `(M - h B - h² K) Δv = h (f + h K v)`, the forces' velocity
    /// terms taken about the velocity of the start.
    ///
    /// Rigid frames are taken to where they turn by themselves, and the solve is for what they turn beside that: inertia is about
    /// there, since about the start it would leave out `ω × (ω × a)`, of which `1/h` times the square of the step's turn is
    /// left however short the step. Forces are about the start all the same, `f + K δ` along the way there: frames that are
    /// turned and not moved strain what is between them, and a tangent of strained matter need not be definite.
    ///
    /// # Errors
    /// The linear solve failed.
    pub fn solve_once(
        &self,
        lent: &Lent,
        q: &mut [Vec3],
        ws: &mut SystemWorkspace,
        buffers: &mut ImplicitBuffers,
    ) -> Result<StepReport, StepError> {
        let state = &lent.0;
        ws.interruption.check()?;
        self.place_coasting(buffers);
        buffers.q_trial.copy_from_slice(q);
        buffers.v_trial.copy_from_slice(&buffers.velocity_offset);
        let turns = self.coast_turns(buffers);
        if turns {
            self.place_inertia_where_turns_lead(ws, buffers);
        }
        self.place_trial(ws, buffers);
        if !turns {
            self.place_inertia(ws, buffers);
        }
        self.add_forces(state, ws, buffers);
        if self.system.forces.iter().any(|force| force.declaration().velocity_terms) {
            self.shift_to_start_velocity(state, ws, buffers);
        }
        self.contract(ws, buffers);
        if turns {
            self.add_forces_along_turns(state, ws, buffers);
        }
        let is_led = self.prescribed_into(q, &mut buffers.prescribed) > 0.0;
        let constrained = if is_led { Constrained::Led } else { Constrained::Still };
        let is_matrix_free = ws.linear.is_matrix_free();
        let indefinite = if is_matrix_free { Indefinite::Solve } else { Indefinite::Refuse };
        let from = if turns { Start::Zero } else { Start::Coasting };
        let wanted = Wanted { from, constrained, indefinite, used_as: Use::Answer, tolerance: 0.0 };
        let (solved, _) = self.solve(state, ws, buffers, wanted)?;
        let fraction = self.hold_back(state, q, ws, buffers);
        self.go(q, fraction, buffers);
        Ok(StepReport {
            shortened: u64::from(fraction < 1.0),
            newton_iterations: 1,
            linear_iterations: u64::from(solved.iterations),
            made_definite: u64::from(solved.made_definite),
            linear_residual: solved.residual,
            ..StepReport::default()
        })
    }

    /// Moves `q` by the fraction of a linearised solve, along the turns of frames first; constrained components go where they are led.
    fn go(&self, q: &mut [Vec3], fraction: f64, buffers: &mut ImplicitBuffers) {
        let ImplicitBuffers { direction, prescribed, turns, rhs, .. } = buffers;
        let kinematics = &self.system.kinematics;
        if !turns.is_empty() {
            kinematics.retract_scaled(q, turns, fraction);
        }
        // the right-hand side has served
        for ((part, whole), led) in rhs.iter_mut().zip(direction.iter()).zip(prescribed.iter()) {
            *part = *led + (*whole - *led) * fraction;
        }
        kinematics.retract(q, rhs);
    }

    /// The fraction of a linearised solve, 1 or halves of it, at which the step's potential, less the work of forces that have none, is
    /// no higher than where it begins, at `q`. That of a linear system never is at 1; of one that is bent so much that the solve knows
    /// nothing of its end, it may be by any amount. What is shortened stays behind where inertia leads, so that momentum is lost with
    /// the energy, of all bodies of the system: such steps are counted, and told at the end of a run.
    fn hold_back(
        &self,
        state: &SystemState,
        q: &[Vec3],
        ws: &mut SystemWorkspace,
        buffers: &mut ImplicitBuffers,
    ) -> f64 {
        let place = |fraction: f64, ws: &mut SystemWorkspace, buffers: &mut ImplicitBuffers| {
            let mut at = std::mem::take(&mut buffers.q_trial);
            at.copy_from_slice(q);
            self.go(&mut at, fraction, buffers);
            buffers.q_trial = at;
            let ImplicitBuffers { q_trial, v_trial, q_start, velocity_offset, .. } = &mut *buffers;
            self.velocity_into(q_trial, q_start, velocity_offset, v_trial);
            self.place_trial(ws, buffers);
            self.merit(state, ws, buffers)
        };
        let start = place(0.0, ws, buffers);
        let mut fraction = 1.0;
        let mut end = place(fraction, ws, buffers);
        let allowed = start + POTENTIAL_ROUNDING * start.abs();
        // what is no number is no less
        let is_higher = |end: f64, work: f64| end.is_nan() || end - work > allowed;
        if is_higher(end, 0.0) {
            place(0.0, ws, buffers);
            let turns = buffers.turns.iter().copied().chain(std::iter::repeat(Vec3::ZERO));
            let way: Vec<Vec3> = buffers.direction.iter().zip(turns).map(|(way, turn)| *way + turn).collect();
            let work = self.work_without_potential(state, q, ws, &way);
            for _ in 0..MAX_HALVINGS {
                end = place(fraction, ws, buffers);
                if !is_higher(end, fraction * work) {
                    break;
                }
                fraction *= 0.5;
            }
        }
        fraction
    }

    /// What forces without a potential do on the way along a direction, as they are at the placed rows [J].
    fn work_without_potential(
        &self,
        state: &SystemState,
        q: &[Vec3],
        ws: &mut SystemWorkspace,
        direction: &[Vec3],
    ) -> f64 {
        let system = self.system;
        let mut forces = vec![Vec3::ZERO; ws.row_scratch.len()];
        for (index, force) in system.forces.iter().enumerate() {
            if !force.declaration().conservative {
                let at = system.view(index, &ws.rows, state, &self.around);
                force.add_force(&at, &mut ws.scratches[index], &mut forces);
            }
        }
        let mut on_blocks = vec![Vec3::ZERO; direction.len()];
        system.kinematics.forces_into(q, &mut forces, &mut on_blocks);
        system.project_free(&mut on_blocks);
        on_blocks.iter().zip(direction).map(|(force, way)| force.dot(*way)).sum()
    }

    /// How rigid frames turn by themselves, in `turns`, and the velocity that this is, in `v_trial`; whether there are any.
    fn coast_turns(&self, buffers: &mut ImplicitBuffers) -> bool {
        let kinematics = &self.system.kinematics;
        let ImplicitBuffers { coasting, velocity_offset, turns, v_trial, .. } = buffers;
        if !(self.rates.has_inertia() && kinematics.has_turning_frames()) {
            turns.clear();
            return false;
        }
        turns.clear();
        turns.resize(coasting.len(), Vec3::ZERO);
        for (_, blocks) in kinematics.unknowns().filter(|(kind, _)| kind.turns()) {
            let turn = blocks.start + 1;
            turns[turn] = (coasting[turn] - velocity_offset[turn]) * (1.0 / self.rates.velocity);
        }
        self.system.project_free(turns);
        for (velocity, moved) in v_trial.iter_mut().zip(turns.iter()) {
            *velocity += *moved * self.rates.velocity;
        }
        true
    }

    /// `inertia = b M (ẋ - p)` where the turns lead and `inertia_residual` from there, with nothing of it in `g`.
    fn place_inertia_where_turns_lead(&self, ws: &mut SystemWorkspace, buffers: &mut ImplicitBuffers) {
        let mut start = std::mem::take(&mut buffers.inertia_residual);
        start.clone_from(&buffers.q_trial);
        self.system.kinematics.retract(&mut buffers.q_trial, &buffers.turns);
        self.place_trial(ws, buffers);
        self.place_inertia(ws, buffers);
        self.contract(ws, buffers);
        buffers.q_trial.copy_from_slice(&start);
        start.clone_from(&buffers.residual);
        buffers.inertia_residual = start;
        buffers.inertia.clone_from(&buffers.unbalanced);
        buffers.unbalanced.fill(Vec3::ZERO);
    }

    /// The residual with forces `f + K δ` along the turns `δ` of frames, and with the inertia that was placed where these lead, from
    /// that of the forces alone.
    fn add_forces_along_turns(
        &self,
        state: &SystemState,
        ws: &mut SystemWorkspace,
        buffers: &mut ImplicitBuffers,
    ) {
        let SystemWorkspace { scratches, rows, .. } = ws;
        let ImplicitBuffers { unbalanced, inertia, direction, turns, q_trial, v_trial, operator, .. } =
            &mut *buffers;
        let at = Linearisation {
            rates: Rates::STATIC,
            ..self.linearisation(state, rows, (q_trial, v_trial), unbalanced)
        };
        TangentOperator::new(&at, Part::Whole, scratches, operator).apply_unconstrained(turns, direction);
        operator.take_seconds();
        for (row, inertia) in unbalanced.iter_mut().zip(inertia.iter()) {
            *row += *inertia;
        }
        let parts = buffers.direction.iter().zip(&buffers.inertia_residual);
        for (residual, (along, inertia)) in buffers.residual.iter_mut().zip(parts) {
            *residual += *inertia - *along;
        }
        self.system.project_free(&mut buffers.residual);
    }

    /// Replaces `f(q, v₀)` in the residual by `f(q, v) - B (v - v₀)`: exact for forces linear in velocity, and
    /// linearised about where the body is going for others.
    fn shift_to_start_velocity(
        &self,
        state: &SystemState,
        ws: &mut SystemWorkspace,
        buffers: &mut ImplicitBuffers,
    ) {
        let system = self.system;
        let mut damping = std::mem::take(&mut buffers.damping);
        let mut change = std::mem::take(&mut ws.row_scratch);
        damping.resize(ws.row_force.len(), Vec3::ZERO);
        buffers.at_offset.clone_from(&ws.row_force);
        change.copy_from_slice(&ws.rows.velocities);
        system.place_rows(&buffers.q_trial, &buffers.v_start, self.end, &mut ws.rows);
        for (change, start) in change.iter_mut().zip(&ws.rows.velocities) {
            *change = *start - *change;
        }
        system.sum_row_forces(&ws.rows, state, &self.around, &mut ws.scratches, &mut ws.row_force);
        let weights = TangentWeights { position: 0.0, velocity: 1.0 };
        system.sum_row_differentials(ws, state, &self.around, weights, &change, &mut damping);
        for (row, g) in buffers.unbalanced.iter_mut().enumerate() {
            *g += buffers.at_offset[row] - (ws.row_force[row] - damping[row]);
        }
        ws.row_scratch = change;
        buffers.damping = damping;
    }
}

/// The block with the largest entry.
fn largest(blocks: &[Vec3]) -> Option<usize> {
    let size = |block: &usize| blocks[*block].length_sq();
    (0..blocks.len()).max_by(|a, b| size(a).total_cmp(&size(b)))
}
