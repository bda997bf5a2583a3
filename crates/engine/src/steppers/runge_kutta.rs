//! Runge–Kutta methods: the midpoint rule of second order, and the classical method of fourth.

use souple_math::Vec3;

use crate::inertia::{accelerations_at, take_along};
use crate::kept::Summed;
use crate::state::SystemState;
use crate::system::SystemWorkspace;

use super::explicit::kick;
use super::{Stability, Step, StepError, StepReport, Stepper, StepperEntry};

/// Four force evaluations a step; fourth order for points, and for rotations as far as increments from the
/// step's start commute (their correction `[θ, ω]/2` is left out: second order in the angle turned).
///
/// Energy is not kept exactly: that of an oscillation is multiplied by `1 - (h ω)⁶/72 + (h ω)⁸/576` every step, a loss
/// of sixth order in a step and fifth per second, and a gain beyond `h ω = 2 √2`. What is kept account of as
/// dissipated is summed at the starts of steps, to first order.
#[derive(Debug)]
pub struct RungeKutta4;

pub(super) const RK4: StepperEntry = StepperEntry {
    name: "rk4",
    summary: "classical Runge–Kutta: fourth order, four forces per step, stable below h ω = 2.83; damps slightly",
    source: "Hairer, Nørsett & Wanner 1993, II.1",
    parameters: &[],
    build: |_| Box::new(RungeKutta4),
};

/// The explicit midpoint rule, modified Euler in Runge's sense: `q½ = q + h/2 v`, `v½ = v + h/2 a(q, v)`, `q' = q + h v½`,
/// `v' = v + h a(q½, v½)`. Two force evaluations a step, second order for points and for rotations.
///
/// The energy of an oscillation is multiplied by `1 + (h ω)⁴/4` every step, exactly: a gain of third order per second. Without
/// damping it grows at any step, slowly where `h ω` is small; `verlet` bounds it at half the cost.
#[derive(Debug)]
pub struct RungeKutta2;

pub(super) const RK2: StepperEntry = StepperEntry {
    name: "rk2",
    summary: "explicit midpoint: second order, two forces per step; gains energy slowly, to be taken with damping",
    source: "Runge 1895; Hairer, Nørsett & Wanner 1993, II.1",
    parameters: &[],
    build: |_| Box::new(RungeKutta2),
};

/// Where each stage stands in the step, moved there by the rates of the one before, and its weight in the sum.
type Stage = (f64, f64);

const MIDPOINT: &[Stage] = &[(0.0, 0.0), (0.5, 1.0)];
const CLASSICAL: &[Stage] = &[(0.0, 1.0 / 6.0), (0.5, 1.0 / 3.0), (0.5, 1.0 / 3.0), (1.0, 1.0 / 6.0)];

impl Stepper for RungeKutta2 {
    fn reads_cliques(&self) -> bool {
        false
    }

    fn name(&self) -> &'static str {
        RK2.name
    }

    // |1 + i z - z²/2|² = 1 + z⁴/4: amplitudes grow by z⁴/8 a step
    fn stability(&self) -> Stability {
        Stability::Growing { factor: 0.125, power: 3 }
    }

    fn step(
        &self,
        step: &Step,
        next: &mut SystemState,
        ws: &mut SystemWorkspace,
    ) -> Result<StepReport, StepError> {
        Method::with_buffers(MIDPOINT, ws, |method, ws| method.step(step, next, ws))
    }
}

impl Stepper for RungeKutta4 {
    fn reads_cliques(&self) -> bool {
        false
    }

    fn name(&self) -> &'static str {
        RK4.name
    }

    // on the imaginary axis |1 + z + z²/2 + z³/6 + z⁴/24| = 1 at |z| = 2 √2
    fn stability(&self) -> Stability {
        Stability::Limited(2.0 * std::f64::consts::SQRT_2)
    }

    fn step(
        &self,
        step: &Step,
        next: &mut SystemState,
        ws: &mut SystemWorkspace,
    ) -> Result<StepReport, StepError> {
        Method::with_buffers(CLASSICAL, ws, |method, ws| method.step(step, next, ws))
    }
}

/// A method and its buffers, lent by the workspace.
struct Method {
    stages: &'static [Stage],
    /// Acceleration and velocity of a stage, their weighted sums, and the velocity of the start.
    blocks: [Vec<Vec3>; 5],
    start_q: Vec<Vec3>,
}

impl Method {
    fn with_buffers<T>(
        stages: &'static [Stage],
        ws: &mut SystemWorkspace,
        step: impl FnOnce(&mut Self, &mut SystemWorkspace) -> T,
    ) -> T {
        let mut lent = Self {
            stages,
            blocks: std::array::from_fn(|i| std::mem::take(&mut ws.blocks[i])),
            start_q: std::mem::take(&mut ws.configuration),
        };
        let stepped = step(&mut lent, ws);
        for (slot, buffer) in ws.blocks.iter_mut().zip(lent.blocks) {
            *slot = buffer;
        }
        ws.configuration = lent.start_q;
        stepped
    }

    fn step(
        &mut self,
        step: &Step,
        next: &mut SystemState,
        ws: &mut SystemWorkspace,
    ) -> Result<StepReport, StepError> {
        let Step { system, around, start, timestep } = *step;
        let mut report = StepReport::default();
        let Self { stages, blocks, start_q } = self;
        let [acceleration, velocity, acceleration_sum, velocity_sum, start_v] = blocks;
        start_q.clone_from(&next.q);
        start_v.clone_from(&next.v);
        for buffer in [&mut *acceleration, velocity, acceleration_sum, velocity_sum] {
            buffer.resize(next.v.len(), Vec3::ZERO);
        }
        velocity_sum.fill(Vec3::ZERO);
        acceleration_sum.fill(Vec3::ZERO);
        for (stage, (fraction, weight)) in stages.iter().copied().enumerate() {
            let time = start + fraction * timestep;
            if stage > 0 {
                // q_i = q + c h v_{i-1},  v_i = v + c h a_{i-1}
                next.q.copy_from_slice(start_q);
                next.v.copy_from_slice(start_v);
                system.kinematics.retract_scaled(&mut next.q, velocity, fraction * timestep);
                kick(&mut next.v, acceleration, fraction * timestep);
                report.merge(&take_along(system, (start, time), &next.q, &mut next.v, ws)?);
                system.impose_constraints(&mut next.q, &mut next.v, time, around.load);
                system.place_rows(&next.q, &next.v, time, &mut ws.rows);
                system.refresh_pairs(ws, next, around);
            }
            report.merge(&accelerations_at(system, around, time, next, ws, acceleration)?);
            velocity.copy_from_slice(&next.v);
            for i in 0..velocity.len() {
                velocity_sum[i] += velocity[i] * weight;
                acceleration_sum[i] += acceleration[i] * weight;
            }
        }
        next.q.copy_from_slice(start_q);
        next.v.copy_from_slice(start_v);
        // memory moves on at the start of the step, unseen by the stages
        system.place_rows(&next.q, &next.v, start, &mut ws.rows);
        system.advance_memory(ws, next, around, timestep, Summed::Elsewhere);
        // q' = q + h Σ b v_i,  v' = v + h Σ b a_i
        system.kinematics.retract_scaled(&mut next.q, velocity_sum, timestep);
        kick(&mut next.v, acceleration_sum, timestep);
        report.merge(&take_along(system, (start, step.end()), &next.q, &mut next.v, ws)?);
        system.impose_constraints(&mut next.q, &mut next.v, step.end(), around.load);
        Ok(report)
    }
}
