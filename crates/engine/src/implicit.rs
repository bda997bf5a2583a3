//! One implicit step as a nonlinear problem: backward Euler, and statics as its limit without inertia.

use std::time::Instant;

use souple_math::Vec3;

use crate::force::TangentWeights;
use crate::linear::LinearError;
use crate::state::SystemState;
use crate::steppers::{StepError, StepReport};
use crate::system::{Surroundings, System, SystemWorkspace};
use crate::tangent::{Linearisation, TangentOperator};

/// The step from `(q_start, v_start)` to the end of `timestep`.
pub struct ImplicitStep<'a> {
    pub system: &'a System,
    pub around: Surroundings<'a>,
    /// Seconds at the end of the step.
    pub end: f64,
    /// `None`: statics.
    pub timestep: Option<f64>,
    pub q_start: &'a [Vec3],
    pub v_start: &'a [Vec3],
    /// `p`: row velocities at the start.
    pub start_row_velocities: &'a [Vec3],
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

/// Halvings of a step before it is given up.
const MAX_HALVINGS: u32 = 30;
/// A step is accepted if the merit falls by this fraction of what the slope promises (Armijo).
const SUFFICIENT_DECREASE: f64 = 1e-4;

/// Buffers of [`ImplicitStep`] in the size of blocks and rows.
pub struct ImplicitBuffers {
    /// `r = Tᵀ g` over blocks, constrained components zero.
    pub residual: Vec<Vec3>,
    /// `g` over rows.
    pub unbalanced: Vec<Vec3>,
    direction: Vec<Vec3>,
    prescribed: Vec<Vec3>,
    rhs: Vec<Vec3>,
    q_trial: Vec<Vec3>,
    v_trial: Vec<Vec3>,
}

impl ImplicitBuffers {
    pub fn new(system: &System) -> Self {
        let blocks = || vec![Vec3::ZERO; system.kinematics.block_count()];
        Self {
            residual: blocks(),
            unbalanced: vec![Vec3::ZERO; system.kinematics.row_count()],
            direction: blocks(),
            prescribed: blocks(),
            rhs: blocks(),
            q_trial: vec![Vec3::ZERO; system.kinematics.free_row_count()],
            v_trial: blocks(),
        }
    }
}

impl ImplicitStep<'_> {
    /// Velocity that a configuration implies, `difference(q, q_start) / h`; zero in statics.
    fn velocity_into(&self, q: &[Vec3], v: &mut [Vec3]) {
        match self.timestep {
            Some(h) => {
                self.system.kinematics.difference(q, self.q_start, v);
                v.iter_mut().for_each(|block| *block = *block * (1.0 / h));
            }
            None => v.fill(Vec3::ZERO),
        }
    }

    /// `g = M (ẋ - p)/h - f` over rows and `r = Tᵀ g` without constrained components; returns `|r|`.
    fn evaluate(&self, q: &[Vec3], v: &[Vec3], state: &SystemState, ws: &mut SystemWorkspace, buffers: &mut ImplicitBuffers) -> f64 {
        let system = self.system;
        system.place_rows(q, v, self.end, &mut ws.rows);
        let clock = Instant::now();
        system.sum_row_forces(&ws.rows, state, &self.around, &mut ws.scratches, &mut ws.row_force);
        ws.stages.forces += clock.elapsed().as_secs_f64();
        let g = &mut buffers.unbalanced;
        g.fill(Vec3::ZERO);
        if let Some(h) = self.timestep {
            for ((change, now), before) in ws.row_scratch.iter_mut().zip(&ws.rows.velocities).zip(self.start_row_velocities) {
                *change = (*now - *before) * (1.0 / h);
            }
            system.mass.add_product(&ws.row_scratch, g);
        }
        for (g, f) in g.iter_mut().zip(&ws.row_force) {
            *g -= *f;
        }
        ws.row_scratch.copy_from_slice(g);
        system.kinematics.forces_into(q, &mut ws.row_scratch, &mut buffers.residual);
        system.project_free(&mut buffers.residual);
        norm(&buffers.residual)
    }

    /// The incremental potential `Σ m |x - x̂|²/(2 h²) + E(x)` at the placed rows, `x̂` where inertia alone
    /// would lead: its gradient is the residual where the mass is lumped on points.
    fn merit(&self, ws: &mut SystemWorkspace, state: &SystemState) -> f64 {
        let stored: f64 = self.system.energies(ws, state, &self.around).iter().map(|energy| energy.stored).sum();
        // |x - x_start - h p|²/h² = |ẋ - p|²
        for ((change, now), before) in ws.row_scratch.iter_mut().zip(&ws.rows.velocities).zip(self.start_row_velocities) {
            *change = *now - *before;
        }
        let inertia = if self.timestep.is_some() { self.system.mass.kinetic_energy(&ws.row_scratch) } else { 0.0 };
        inertia + stored
    }

    /// The residual that rounding alone makes: positions known to `ε |x|` give inertia known to `m ε |x| / h²`,
    /// and forces are sums of terms that cancel.
    fn rounding_floor(&self, ws: &SystemWorkspace) -> f64 {
        let inertia = self.timestep.map_or(0.0, |h| {
            let weighted = |(x, mass): (&Vec3, &f64)| (mass * x.length()).powi(2);
            ws.rows.positions.iter().zip(&self.system.mass.diagonal).map(weighted).sum::<f64>().sqrt() / (h * h)
        });
        4.0 * f64::EPSILON * inertia + 64.0 * f64::EPSILON * norm(&ws.row_force)
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
        norm(prescribed)
    }

    /// `direction = -A⁻¹ r` with constrained components prescribed; returns iterations and residual.
    fn solve(
        &self,
        q: &[Vec3],
        v: &[Vec3],
        state: &SystemState,
        ws: &mut SystemWorkspace,
        buffers: &mut ImplicitBuffers,
        prescribed: bool,
    ) -> Result<(u32, f64), LinearError> {
        let system = self.system;
        let SystemWorkspace { scratches, rows, tangent, linear, stages, .. } = ws;
        let at = Linearisation {
            system,
            state,
            around: self.around,
            rows,
            q,
            v,
            timestep: self.timestep,
            unbalanced: &buffers.unbalanced,
        };
        for (rhs, residual) in buffers.rhs.iter_mut().zip(&buffers.residual) {
            *rhs = -*residual;
        }
        let clock = Instant::now();
        if prescribed {
            // r + A (δ_free + δ_prescribed) = 0
            let operator = TangentOperator::new(&at, scratches);
            operator.apply_unconstrained(&buffers.prescribed, &mut buffers.direction);
            for (rhs, lift) in buffers.rhs.iter_mut().zip(&buffers.direction) {
                *rhs -= *lift;
            }
            system.project_free(&mut buffers.rhs);
        }
        // rigid frames turn on the way, and one-way rows take what they do not give
        let symmetric = !system.kinematics.has_rigid_frames()
            && system.kinematics.is_conservative()
            && system.forces.iter().all(|force| force.declaration().symmetric_tangent);
        buffers.direction.fill(Vec3::ZERO);
        let report = if linear.is_matrix_free() {
            let diagonal = tangent.assemble_diagonal(&at, scratches);
            stages.assembly += clock.elapsed().as_secs_f64();
            let clock = Instant::now();
            let operator = TangentOperator::new(&at, scratches);
            let report = linear.solve_matrix_free(&operator, diagonal, symmetric, &buffers.rhs, &mut buffers.direction);
            stages.solve += clock.elapsed().as_secs_f64();
            report?
        } else {
            let matrix = tangent.assemble(&at, scratches);
            stages.assembly += clock.elapsed().as_secs_f64();
            let clock = Instant::now();
            let positions = system.block_positions(&rows.positions);
            let report = linear.solve(matrix, &positions, symmetric, &buffers.rhs, &mut buffers.direction);
            stages.solve += clock.elapsed().as_secs_f64();
            report?
        };
        system.project_free(&mut buffers.direction);
        if prescribed {
            for (direction, prescribed) in buffers.direction.iter_mut().zip(&buffers.prescribed) {
                *direction += *prescribed;
            }
        }
        Ok(report)
    }

    /// One linearisation about the start: `(M - h B - h² K) Δv = h (f + h K v)`, the forces' velocity terms
    /// taken about the velocity of the start.
    ///
    /// # Errors
    /// The linear solve failed.
    pub fn solve_once(
        &self,
        next: &mut SystemState,
        ws: &mut SystemWorkspace,
        buffers: &mut ImplicitBuffers,
    ) -> Result<StepReport, StepError> {
        let state = next.clone_without_motion();
        buffers.v_trial.fill(Vec3::ZERO);
        let v_zero = std::mem::take(&mut buffers.v_trial);
        let q = self.q_start;
        self.evaluate(q, &v_zero, &state, ws, buffers);
        if self.system.forces.iter().any(|force| force.declaration().velocity_terms) {
            self.shift_to_start_velocity(&state, ws, buffers);
        }
        let prescribed = self.prescribed_into(q, &mut buffers.prescribed) > 0.0;
        let solved = self.solve(q, &v_zero, &state, ws, buffers, prescribed);
        buffers.v_trial = v_zero;
        let (linear_iterations, linear_residual) = solved?;
        self.system.kinematics.retract(&mut next.q, &buffers.direction);
        Ok(StepReport { newton_iterations: 1, linear_iterations, linear_residual, newton_residual: 0.0 })
    }

    /// Replaces `f(q, 0)` in the residual by `f(q, v₀) - B v₀`: exact for forces linear in velocity, and
    /// linearised about where the body is going for others.
    fn shift_to_start_velocity(&self, state: &SystemState, ws: &mut SystemWorkspace, buffers: &mut ImplicitBuffers) {
        let system = self.system;
        let at_rest = ws.row_force.clone();
        system.place_rows(self.q_start, self.v_start, self.end, &mut ws.rows);
        system.sum_row_forces(&ws.rows, state, &self.around, &mut ws.scratches, &mut ws.row_force);
        let mut damping = vec![Vec3::ZERO; at_rest.len()];
        let weights = TangentWeights { position: 0.0, velocity: 1.0 };
        let velocities = self.start_row_velocities;
        system.sum_row_differentials(ws, state, &self.around, weights, velocities, &mut damping);
        for (row, g) in buffers.unbalanced.iter_mut().enumerate() {
            *g += at_rest[row] - (ws.row_force[row] - damping[row]);
        }
        ws.row_scratch.copy_from_slice(&buffers.unbalanced);
        system.kinematics.forces_into(self.q_start, &mut ws.row_scratch, &mut buffers.residual);
        system.project_free(&mut buffers.residual);
    }

    /// Newton's method with line search from the configuration in `next`.
    ///
    /// # Errors
    /// A linear solve failed, or the iteration stalled above its tolerance.
    pub fn solve_newton(
        &self,
        settings: NewtonSettings,
        next: &mut SystemState,
        ws: &mut SystemWorkspace,
        buffers: &mut ImplicitBuffers,
    ) -> Result<StepReport, StepError> {
        let system = self.system;
        let state = next.clone_without_motion();
        let mut report = StepReport::default();
        let mut v = vec![Vec3::ZERO; next.v.len()];
        self.velocity_into(&next.q, &mut v);
        let mut residual = self.evaluate(&next.q, &v, &state, ws, buffers);
        let mut to_go = self.prescribed_into(&next.q, &mut buffers.prescribed);
        // the scale of forces at work: what is unbalanced at first, or what balances where nothing is
        let mut scale = residual.max(norm(&ws.row_force) * 1e-6);
        let floor = self.rounding_floor(ws);
        for iteration in 0..=settings.max_iterations {
            if to_go == 0.0 && residual <= (settings.tolerance * scale).max(floor) {
                report.newton_residual = if scale > 0.0 { residual / scale } else { 0.0 };
                next.v.copy_from_slice(&v);
                return Ok(report);
            }
            if iteration == settings.max_iterations {
                break;
            }
            let merit = (self.has_potential && to_go == 0.0).then(|| self.merit(ws, &state));
            let (iterations, linear_residual) = self.solve(&next.q, &v, &state, ws, buffers, to_go > 0.0)?;
            report.linear_iterations += iterations;
            report.linear_residual = report.linear_residual.max(linear_residual);
            report.newton_iterations += 1;
            let slope: f64 = buffers.residual.iter().zip(&buffers.direction).map(|(r, d)| r.dot(*d)).sum();
            let direction = std::mem::take(&mut buffers.direction);
            let mut fraction = 1.0;
            let mut accepted = false;
            for _ in 0..=MAX_HALVINGS {
                let (mut q_trial, mut v_trial) =
                    (std::mem::take(&mut buffers.q_trial), std::mem::take(&mut buffers.v_trial));
                q_trial.copy_from_slice(&next.q);
                system.kinematics.retract_scaled(&mut q_trial, &direction, fraction);
                self.velocity_into(&q_trial, &mut v_trial);
                let trial = self.evaluate(&q_trial, &v_trial, &state, ws, buffers);
                let better = trial.is_finite()
                    && match merit {
                        // rounding of the potential hides its decrease near the minimum: there the
                        // residual decides
                        Some(merit) if slope < 0.0 => {
                            let wanted = merit + SUFFICIENT_DECREASE * fraction * slope;
                            trial < residual || self.merit(ws, &state) <= wanted
                        }
                        _ => to_go > 0.0 || trial < residual * (1.0 - SUFFICIENT_DECREASE * fraction),
                    };
                if better {
                    next.q.copy_from_slice(&q_trial);
                    v.copy_from_slice(&v_trial);
                    residual = trial;
                    accepted = true;
                }
                (buffers.q_trial, buffers.v_trial) = (q_trial, v_trial);
                if better {
                    break;
                }
                fraction *= 0.5;
            }
            buffers.direction = direction;
            if !accepted {
                // no step along the direction helps: rounding, if the residual is already small
                self.evaluate(&next.q, &v, &state, ws, buffers);
                break;
            }
            to_go = self.prescribed_into(&next.q, &mut buffers.prescribed);
            if to_go <= 1e-14 * norm(&next.q) {
                to_go = 0.0;
            }
            if report.newton_iterations == 1 {
                scale = scale.max(residual);
            }
        }
        report.newton_residual = residual / scale;
        Err(StepError::NewtonStalled {
            iterations: report.newton_iterations,
            residual: report.newton_residual,
            wanted: settings.tolerance,
        })
    }
}

/// Euclidean norm over all components.
pub fn norm(blocks: &[Vec3]) -> f64 {
    souple_solve::reduce::dot(blocks, blocks).sqrt()
}
