//! Newton's method on a step: the predictor that leads prescribed motion, and the step as the iteration sees it.

use souple_math::Vec3;
use souple_solve::krylov;
use souple_solve::newton::{self, NewtonProblem, Trial, newton};
use souple_solve::reduce::norm;

use super::history::Lent;
use super::{
    Constrained, ImplicitBuffers, ImplicitStep, MAX_HALVINGS, NewtonSettings, Start, Wanted, largest,
};
use crate::linear::{Indefinite, Solved, Use};
use crate::state::SystemState;
use crate::steppers::{StepError, StepReport};
use crate::system::SystemWorkspace;

/// Loosest linear solve of a Newton iteration, and how much tighter it gets as the residual falls: proportional to
/// it, which keeps the convergence quadratic (Dembo, Eisenstat & Steihaug 1982).
const LOOSEST: f64 = 1e-2;
const FORCING: f64 = 0.1;
/// What of the forces at the rows stands for the loads where all is balanced from the beginning.
const SHARE_OF_LOADS: f64 = 1e-2;

impl ImplicitStep<'_> {
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
        self.place_coasting(buffers);
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
            let solved = newton(&mut problem, &limits, &mut workspace)?;
            Ok(if solved.converged() { solved } else { problem.judge_by_loads(solved) })
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
            return Err(StepError::NewtonStalled {
                block: largest(&buffers.residual).unwrap_or_default(),
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
        let ImplicitBuffers { q, q_trial, v_trial, q_start, velocity_offset: offset, .. } =
            &mut *self.buffers;
        q_trial.copy_from_slice(q);
        if let Some((direction, fraction)) = direction {
            self.step.system.kinematics.retract_scaled(q_trial, direction, fraction);
        }
        self.step.velocity_into(q_trial, q_start, offset, v_trial);
        self.is_current = false;
    }

    /// The norm of the unbalanced force at the current configuration.
    fn evaluate(&mut self) -> f64 {
        self.is_current = true;
        self.step.evaluate(self.state, self.ws, self.buffers)
    }

    fn solve(&mut self, constrained: Constrained, tolerance: f64) -> Result<Solved, StepError> {
        self.ws.interruption.check()?;
        let indefinite = if self.step.is_symmetric() { Indefinite::Descend } else { Indefinite::Solve };
        let wanted =
            Wanted { from: Start::Zero, constrained, indefinite, used_as: Use::Direction, tolerance };
        let (solved, rounding) = self.step.solve(self.state, self.ws, self.buffers, wanted)?;
        // forces are sums of terms that cancel
        self.rounding = rounding.max(64.0 * f64::EPSILON * norm(&self.ws.row_force));
        self.report.newton_iterations += 1;
        self.report.linear_iterations += u64::from(solved.iterations);
        self.report.made_definite += u64::from(solved.made_definite);
        self.report.linear_residual = self.report.linear_residual.max(solved.residual);
        Ok(solved)
    }

    /// What a body that hangs on nothing began with may be rounding already, and no scale: what was balanced from the beginning on, by
    /// the forces that balance each other, has converged.
    fn judge_by_loads(&mut self, solved: newton::Report) -> newton::Report {
        self.place(None);
        let residual = self.evaluate();
        let SystemWorkspace { scratches, rows, .. } = &mut *self.ws;
        let forces = self.step.system.largest_force(rows, self.state, &self.step.around, scratches);
        let loads = SHARE_OF_LOADS * forces;
        let is_balanced = loads.is_finite() && self.scale.max(residual) <= self.settings.tolerance * loads;
        if is_balanced {
            self.scale = loads;
        }
        newton::Report {
            residual,
            stop: if is_balanced { newton::Stop::Converged } else { solved.stop },
            ..solved
        }
    }

    /// Brings constrained components to where they are led, and the free ones along.
    fn predict(&mut self) -> Result<(), StepError> {
        // what has no value where prescribed points would have stood
        let mut obstacle = None;
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
                if halvings == 0 {
                    obstacle = self.not_finite();
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
            to_go => Err(obstacle.unwrap_or(StepError::NotReached { to_go })),
        }
    }

    /// The force or energy that is not finite where things stand.
    fn not_finite(&mut self) -> Option<StepError> {
        let SystemWorkspace { scratches, rows, .. } = &mut *self.ws;
        let (system, around) = (self.step.system, &self.step.around);
        system
            .first_force_not_finite(rows, self.state, around, scratches)
            .or_else(|| system.first_energy_not_finite(rows, self.state, around, scratches))
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

    // along a turn at a constant rate the slope is the torque about it, and what inertia adds to that is of the size of the turn
    fn is_gradient(&self) -> bool {
        self.step.is_symmetric() || self.step.turns_alone_break_symmetry()
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
