//! One implicit step as a nonlinear problem: backward Euler, and statics as its limit without inertia.
//!
//! The iteration is `souple_solve::newton`; what is particular to a step stays here, before and around it. Prescribed
//! motion is a predictor: one linearised solve carries the constrained components to where they are led, and Newton
//! then works on the free ones alone, so that its merit function is one potential throughout. The merit is the
//! incremental potential where there is one; with damping there still is one as long as tangents are symmetric, known
//! by its slopes. Rounding bounds what residual can be asked for.

use std::time::Instant;

use souple_math::Vec3;
use souple_solve::krylov;
use souple_solve::newton::{self, NewtonProblem, Trial, newton};
use souple_solve::reduce::norm;

use crate::force::TangentWeights;
use crate::linear::{Indefinite, LinearError, LinearSystem, Solved};
use crate::state::SystemState;
use crate::steppers::{StepError, StepReport};
use crate::system::{Surroundings, System, SystemWorkspace};
use crate::tangent::{Assembled, Linearisation, OperatorBuffers, TangentOperator};

/// The step from `(q_start, v_start)` to the end of `timestep`.
pub struct ImplicitStep<'a> {
    pub system: &'a System,
    pub around: Surroundings<'a>,
    /// Seconds at the end of the step.
    pub end: f64,
    /// `None`: statics.
    pub timestep: Option<f64>,
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

/// Halvings of a predictor before it is given up.
const MAX_HALVINGS: u32 = 30;
/// Loosest linear solve of a Newton iteration, and how much tighter it gets as the residual falls: proportional to
/// it, which keeps the convergence quadratic (Dembo, Eisenstat & Steihaug 1982).
const LOOSEST: f64 = 1e-2;
const FORCING: f64 = 0.1;
/// What of the forces at the rows stands for the loads where all is balanced from the beginning.
const SHARE_OF_LOADS: f64 = 1e-2;

/// Buffers of [`ImplicitStep`] in the size of blocks and rows.
pub struct ImplicitBuffers {
    /// Configuration and velocity at the start of the step.
    pub q_start: Vec<Vec3>,
    pub v_start: Vec<Vec3>,
    /// `p`: row velocities at the start.
    pub start_row_velocities: Vec<Vec3>,
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
    /// Empty where no force has velocity terms.
    at_rest: Vec<Vec3>,
    damping: Vec<Vec3>,
    operator: OperatorBuffers,
    newton: newton::Workspace,
}

impl ImplicitBuffers {
    pub fn new(system: &System) -> Self {
        let blocks = || vec![Vec3::ZERO; system.kinematics.block_count()];
        let rows = || vec![Vec3::ZERO; system.kinematics.row_count()];
        let free_rows = || vec![Vec3::ZERO; system.kinematics.free_row_count()];
        Self {
            q_start: free_rows(),
            v_start: blocks(),
            start_row_velocities: rows(),
            residual: blocks(),
            unbalanced: rows(),
            direction: blocks(),
            prescribed: blocks(),
            rhs: blocks(),
            q: Vec::new(),
            q_trial: free_rows(),
            v_trial: blocks(),
            at_rest: Vec::new(),
            damping: Vec::new(),
            operator: OperatorBuffers::new(system),
            newton: newton::Workspace::default(),
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let buffers = [
            &self.q_start,
            &self.v_start,
            &self.start_row_velocities,
            &self.residual,
            &self.unbalanced,
            &self.direction,
            &self.prescribed,
            &self.rhs,
            &self.q,
            &self.q_trial,
            &self.v_trial,
            &self.at_rest,
            &self.damping,
        ];
        buffers.into_iter().map(|buffer| size_of::<Vec3>() * buffer.capacity()).sum::<usize>()
            + self.operator.bytes()
            + self.newton.bytes()
    }
}

/// What forces may read of the state while its configuration is sought: the rest of `next` is lent to it, without
/// a copy, until [`Lent::give_back`].
pub struct Lent(SystemState);

impl Lent {
    /// Also writes down the configuration that the solver's orders and patches refer to, if there is none.
    pub fn from(next: &mut SystemState) -> Self {
        if next.history.len() != 3 * next.q.len() {
            next.history.clear();
            next.history.extend(next.q.iter().flat_map(|row| row.to_array()));
        }
        Self(SystemState {
            memory: std::mem::take(&mut next.memory),
            pairs: std::mem::take(&mut next.pairs),
            history: std::mem::take(&mut next.history),
            ..SystemState::default()
        })
    }

    /// Whether `history` is a configuration that [`Lent::from`] wrote down, or none.
    pub fn accepts_history(system: &System, history: &[f64]) -> bool {
        history.is_empty() || history.len() == 3 * system.kinematics.free_row_count()
    }

    pub fn give_back(self, next: &mut SystemState) {
        next.memory = self.0.memory;
        next.pairs = self.0.pairs;
        next.history = self.0.history;
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

/// What is asked of a linear solve.
#[derive(Clone, Copy, Debug)]
struct Wanted {
    constrained: Constrained,
    indefinite: Indefinite,
    /// As [`LinearSystem::tolerance`].
    tolerance: f64,
}

impl ImplicitStep<'_> {
    /// Velocity that a configuration implies, `difference(q, q_start) / h`; zero in statics.
    pub fn velocity_into(&self, q: &[Vec3], q_start: &[Vec3], v: &mut [Vec3]) {
        match self.timestep {
            Some(h) => {
                self.system.kinematics.difference(q, q_start, v);
                v.iter_mut().for_each(|block| *block = *block * (1.0 / h));
            }
            None => v.fill(Vec3::ZERO),
        }
    }

    /// `g = M (ẋ - p)/h - f` over rows and `-Tᵀ g` without constrained components at `(q_trial, v_trial)`;
    /// returns the norm of the latter.
    fn evaluate(&self, state: &SystemState, ws: &mut SystemWorkspace, buffers: &mut ImplicitBuffers) -> f64 {
        let system = self.system;
        system.place_rows(&buffers.q_trial, &buffers.v_trial, self.end, &mut ws.rows);
        let clock = Instant::now();
        system.sum_row_forces(&ws.rows, state, &self.around, &mut ws.scratches, &mut ws.row_force);
        ws.stages.forces += clock.elapsed().as_secs_f64();
        let g = &mut buffers.unbalanced;
        g.fill(Vec3::ZERO);
        if let Some(h) = self.timestep {
            let start = &buffers.start_row_velocities;
            for ((change, now), before) in ws.row_scratch.iter_mut().zip(&ws.rows.velocities).zip(start) {
                *change = (*now - *before) * (1.0 / h);
            }
            system.mass.add_product(&ws.row_scratch, g);
        }
        for (g, f) in g.iter_mut().zip(&ws.row_force) {
            *g -= *f;
        }
        self.contract(ws, buffers);
        norm(&buffers.residual)
    }

    /// `-Tᵀ g` without constrained components.
    fn contract(&self, ws: &mut SystemWorkspace, buffers: &mut ImplicitBuffers) {
        for (minus, g) in ws.row_scratch.iter_mut().zip(&buffers.unbalanced) {
            *minus = -*g;
        }
        self.system.kinematics.forces_into(&buffers.q_trial, &mut ws.row_scratch, &mut buffers.residual);
        self.system.project_free(&mut buffers.residual);
    }

    /// The incremental potential `Σ m |x - x̂|²/(2 h²) + E(x)` at the placed rows, `x̂` where inertia alone
    /// would lead: minus its gradient is the residual.
    fn merit(&self, state: &SystemState, ws: &mut SystemWorkspace, buffers: &ImplicitBuffers) -> f64 {
        let system = self.system;
        let mut stored = 0.0;
        for (index, force) in system.forces.iter().enumerate() {
            let at = system.view(index, &ws.rows, state, &self.around);
            stored += force.energy(&at, &mut ws.scratches[index]).stored;
        }
        if self.timestep.is_none() {
            return stored;
        }
        // |x - x_start - h p|²/h² = |ẋ - p|²
        let start = &buffers.start_row_velocities;
        for ((change, now), before) in ws.row_scratch.iter_mut().zip(&ws.rows.velocities).zip(start) {
            *change = *now - *before;
        }
        system.mass.kinetic_energy(&ws.row_scratch) + stored
    }

    /// What is left of prescribed motion: how far constrained components are from where they are led.
    fn prescribed_into(&self, q: &[Vec3], prescribed: &mut [Vec3]) -> f64 {
        prescribed.fill(Vec3::ZERO);
        for constraint in &self.system.constraints {
            if let Some(row) = self.system.kinematics.point_block_row(constraint.block) {
                let to_go = constraint.position(self.end, self.around.load) - q[row as usize];
                prescribed[constraint.block as usize] += constraint.constrained() * to_go;
            }
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
    ) -> Result<(Solved, f64), LinearError> {
        let system = self.system;
        let SystemWorkspace { scratches, rows, tangent, linear, stages, .. } = ws;
        let ImplicitBuffers {
            unbalanced,
            residual,
            direction,
            prescribed,
            rhs,
            q_trial,
            v_trial,
            operator,
            ..
        } = buffers;
        let at = Linearisation {
            system,
            state,
            around: self.around,
            rows,
            q: q_trial,
            v: v_trial,
            timestep: self.timestep,
            unbalanced,
        };
        rhs.copy_from_slice(residual);
        let clock = Instant::now();
        if wanted.constrained == Constrained::Led {
            // A (δ_free + δ_prescribed) = -r
            TangentOperator::new(&at, scratches, operator).apply_unconstrained(prescribed, direction);
            for (rhs, lift) in rhs.iter_mut().zip(direction.iter()) {
                *rhs -= *lift;
            }
            system.project_free(rhs);
        }
        let symmetric = self.is_symmetric();
        let moved;
        let positions = if system.kinematics.is_trivial() {
            &rows.positions
        } else {
            moved = system.block_positions(&rows.positions);
            &moved
        };
        let is_matrix_free = linear.is_matrix_free();
        let Assembled { matrix, symmetric: nearby } = if is_matrix_free {
            Assembled { matrix: tangent.assemble_diagonal(&at, scratches), symmetric: None }
        } else {
            tangent.assemble_with_symmetric(&at, scratches)
        };
        stages.assembly += clock.elapsed().as_secs_f64();
        let weighted = (0..positions.len())
            .map(|block| (matrix.diagonal_block(block).trace() / 3.0 * positions[block].length()).powi(2));
        let rounding = f64::EPSILON * weighted.sum::<f64>().sqrt();
        let clock = Instant::now();
        let products = is_matrix_free.then(|| TangentOperator::new(&at, scratches, operator));
        let linear_system = LinearSystem {
            matrix,
            operator: products.as_ref().map(|operator| operator as _),
            nearby,
            symmetric,
            kinematics: &system.kinematics,
            reference: &state.history,
            positions,
            indefinite: wanted.indefinite,
            tolerance: wanted.tolerance,
        };
        let solved = linear.solve(linear_system, rhs, direction);
        stages.solve += clock.elapsed().as_secs_f64();
        system.project_free(direction);
        if wanted.constrained == Constrained::Led {
            for (direction, prescribed) in direction.iter_mut().zip(prescribed.iter()) {
                *direction += *prescribed;
            }
        }
        Ok((solved?, rounding))
    }

    /// Whether the tangent is symmetric: rigid frames turn on the way, and one-way rows take what they do not give.
    fn is_symmetric(&self) -> bool {
        !self.system.kinematics.has_rigid_frames()
            && self.system.kinematics.is_conservative()
            && self.system.forces.iter().all(|force| force.declaration().symmetric_tangent)
    }

    /// One linearisation about the start: `(M - h B - h² K) Δv = h (f + h K v)`, the forces' velocity terms
    /// taken about the velocity of the start.
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
        buffers.q_trial.copy_from_slice(q);
        buffers.v_trial.fill(Vec3::ZERO);
        self.evaluate(state, ws, buffers);
        if self.system.forces.iter().any(|force| force.declaration().velocity_terms) {
            self.shift_to_start_velocity(state, ws, buffers);
        }
        let is_led = self.prescribed_into(q, &mut buffers.prescribed) > 0.0;
        let constrained = if is_led { Constrained::Led } else { Constrained::Still };
        let wanted = Wanted { constrained, indefinite: Indefinite::Solve, tolerance: 0.0 };
        let (solved, _) = self.solve(state, ws, buffers, wanted)?;
        self.system.kinematics.retract(q, &buffers.direction);
        Ok(StepReport {
            newton_iterations: 1,
            linear_iterations: u64::from(solved.iterations),
            linear_residual: solved.residual,
            newton_residual: 0.0,
        })
    }

    /// Replaces `f(q, 0)` in the residual by `f(q, v₀) - B v₀`: exact for forces linear in velocity, and
    /// linearised about where the body is going for others.
    fn shift_to_start_velocity(
        &self,
        state: &SystemState,
        ws: &mut SystemWorkspace,
        buffers: &mut ImplicitBuffers,
    ) {
        let system = self.system;
        let mut damping = std::mem::take(&mut buffers.damping);
        damping.resize(ws.row_force.len(), Vec3::ZERO);
        buffers.at_rest.clone_from(&ws.row_force);
        system.place_rows(&buffers.q_start, &buffers.v_start, self.end, &mut ws.rows);
        system.sum_row_forces(&ws.rows, state, &self.around, &mut ws.scratches, &mut ws.row_force);
        let weights = TangentWeights { position: 0.0, velocity: 1.0 };
        let velocities = &buffers.start_row_velocities;
        system.sum_row_differentials(ws, state, &self.around, weights, velocities, &mut damping);
        for (row, g) in buffers.unbalanced.iter_mut().enumerate() {
            *g += buffers.at_rest[row] - (ws.row_force[row] - damping[row]);
        }
        buffers.damping = damping;
        self.contract(ws, buffers);
    }

    /// Newton's method with line search from the configuration `q`, which it leaves at the solution.
    ///
    /// # Errors
    /// A linear solve failed, or the iteration stalled above its tolerance.
    pub fn solve_newton(
        &self,
        settings: NewtonSettings,
        lent: &Lent,
        q: &mut [Vec3],
        ws: &mut SystemWorkspace,
        buffers: &mut ImplicitBuffers,
    ) -> Result<StepReport, StepError> {
        buffers.q.clear();
        buffers.q.extend_from_slice(q);
        let mut workspace = std::mem::take(&mut buffers.newton);
        let mut problem = ImplicitProblem {
            step: self,
            state: &lent.0,
            settings,
            ws,
            buffers,
            scale: 0.0,
            rounding: 0.0,
            is_current: false,
            report: StepReport::default(),
        };
        let solved = problem.predict().and_then(|()| {
            let limits = newton::Settings {
                relative_tolerance: settings.tolerance,
                max_iterations: settings.max_iterations as usize,
                ..newton::Settings::default()
            };
            newton(&mut problem, &limits, &mut workspace)
        });
        let (scale, mut report) = (problem.scale, problem.report);
        buffers.newton = workspace;
        let solved = solved?;
        report.newton_residual = if scale > 0.0 { solved.residual / scale } else { 0.0 };
        if !solved.converged() {
            let SystemWorkspace { scratches, rows, .. } = ws;
            if let Some(error) = self.system.first_force_not_finite(rows, &lent.0, &self.around, scratches) {
                return Err(error);
            }
            let size = |block: &usize| buffers.residual[*block].length_sq();
            return Err(StepError::NewtonStalled {
                block: (0..buffers.residual.len())
                    .max_by(|a, b| size(a).total_cmp(&size(b)))
                    .unwrap_or_default(),
                iterations: report.newton_iterations,
                residual: report.newton_residual,
                wanted: settings.tolerance,
            });
        }
        q.copy_from_slice(&buffers.q);
        Ok(report)
    }
}

/// A Newton step shorter than this share of the positions is rounding.
const POSITION_ROUNDING: f64 = 64.0 * f64::EPSILON;

/// A step as Newton's method sees it: `buffers.q` is accepted, `(q_trial, v_trial)` current.
struct ImplicitProblem<'p, 'a> {
    step: &'p ImplicitStep<'a>,
    state: &'p SystemState,
    settings: NewtonSettings,
    ws: &'p mut SystemWorkspace,
    buffers: &'p mut ImplicitBuffers,
    /// The largest unbalanced force so far.
    scale: f64,
    rounding: f64,
    /// Whether `buffers.residual` is that of the current configuration.
    is_current: bool,
    report: StepReport,
}

impl ImplicitProblem<'_, '_> {
    /// Makes `retract(q, fraction · direction)` current.
    fn place(&mut self, direction: Option<(&[Vec3], f64)>) {
        let ImplicitBuffers { q, q_trial, v_trial, q_start, .. } = &mut *self.buffers;
        q_trial.copy_from_slice(q);
        if let Some((direction, fraction)) = direction {
            self.step.system.kinematics.retract_scaled(q_trial, direction, fraction);
        }
        self.step.velocity_into(q_trial, q_start, v_trial);
        self.is_current = false;
    }

    /// The norm of the unbalanced force at the current configuration.
    fn evaluate(&mut self) -> f64 {
        self.is_current = true;
        self.step.evaluate(self.state, self.ws, self.buffers)
    }

    fn solve(&mut self, constrained: Constrained, tolerance: f64) -> Result<Solved, StepError> {
        let indefinite = if self.step.is_symmetric() { Indefinite::Descend } else { Indefinite::Solve };
        let wanted = Wanted { constrained, indefinite, tolerance };
        let (solved, rounding) = self.step.solve(self.state, self.ws, self.buffers, wanted)?;
        // forces are sums of terms that cancel
        self.rounding = rounding.max(64.0 * f64::EPSILON * norm(&self.ws.row_force));
        self.report.newton_iterations += 1;
        self.report.linear_iterations += u64::from(solved.iterations);
        self.report.linear_residual = self.report.linear_residual.max(solved.residual);
        Ok(solved)
    }

    /// Brings constrained components to where they are led, and the free ones along.
    fn predict(&mut self) -> Result<(), StepError> {
        self.place(None);
        let unbalanced = self.evaluate();
        self.scale = unbalanced.max(SHARE_OF_LOADS * norm(&self.ws.row_force));
        for _ in 0..MAX_HALVINGS {
            if self.step.prescribed_into(&self.buffers.q, &mut self.buffers.prescribed) == 0.0 {
                return Ok(());
            }
            if !self.is_current {
                self.place(None);
                self.evaluate();
            }
            self.solve(Constrained::Led, LOOSEST)?;
            let direction = std::mem::take(&mut self.buffers.direction);
            let mut fraction = 1.0;
            let mut halvings = 0;
            let after = loop {
                self.place(Some((&direction, fraction)));
                let after = self.evaluate();
                let is_usable = after.is_finite()
                    && (!self.step.has_potential
                        || self.step.merit(self.state, self.ws, self.buffers).is_finite());
                if is_usable || halvings == MAX_HALVINGS {
                    break after;
                }
                fraction *= 0.5;
                halvings += 1;
            };
            self.buffers.direction = direction;
            let ImplicitBuffers { q, q_trial, .. } = &mut *self.buffers;
            q.copy_from_slice(q_trial);
            self.scale = self.scale.max(after);
        }
        match self.step.prescribed_into(&self.buffers.q, &mut self.buffers.prescribed) {
            0.0 => Ok(()),
            to_go => Err(StepError::NotReached { to_go }),
        }
    }
}

impl NewtonProblem for ImplicitProblem<'_, '_> {
    type Error = StepError;

    fn block_count(&self) -> usize {
        self.buffers.residual.len()
    }

    fn residual(&mut self, out: &mut [Vec3]) -> Result<Trial, StepError> {
        if !self.is_current {
            self.evaluate();
        }
        out.copy_from_slice(&self.buffers.residual);
        Ok(Trial::Admissible)
    }

    fn direction(
        &mut self,
        residual: &[Vec3],
        out: &mut [Vec3],
    ) -> Result<Option<krylov::Report>, StepError> {
        let relative = norm(residual) / self.scale;
        // no tighter than what the wanted residual needs
        let tolerance = (0.1 * self.settings.tolerance / relative).max(FORCING * relative);
        self.solve(Constrained::Still, tolerance.min(LOOSEST))?;
        out.copy_from_slice(&self.buffers.direction);
        Ok(None)
    }

    fn try_step(&mut self, direction: &[Vec3], fraction: f64) -> Result<Trial, StepError> {
        self.place(Some((direction, fraction)));
        Ok(Trial::Admissible)
    }

    fn accept(&mut self) -> Result<(), StepError> {
        let ImplicitBuffers { q, q_trial, .. } = &mut *self.buffers;
        q.copy_from_slice(q_trial);
        Ok(())
    }

    fn merit(&mut self) -> Result<Option<f64>, StepError> {
        let has_potential = self.step.has_potential;
        Ok(has_potential.then(|| self.step.merit(self.state, self.ws, self.buffers)))
    }

    fn is_gradient(&self) -> bool {
        self.step.is_symmetric()
    }

    fn residual_scale(&mut self) -> Option<f64> {
        Some(self.scale)
    }

    fn rounding(&mut self) -> f64 {
        self.rounding
    }

    fn is_negligible(&self, direction: &[Vec3]) -> bool {
        norm(direction) <= POSITION_ROUNDING * norm(&self.buffers.q)
    }
}
