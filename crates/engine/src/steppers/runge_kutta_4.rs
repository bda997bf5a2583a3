//! The classical Runge–Kutta method of fourth order.

use souple_math::Vec3;

use crate::inertia::accelerations_at;
use crate::state::SystemState;
use crate::system::{Surroundings, System, SystemWorkspace};

use super::{Stability, StepError, StepReport, Stepper, StepperEntry};

/// Four force evaluations a step; fourth order for points, and for rotations as far as increments from the
/// step's start commute (their correction `[θ, ω]/2` is left out: second order in the angle turned).
#[derive(Debug)]
pub struct RungeKutta4;

pub(super) const ENTRY: StepperEntry = StepperEntry {
    name: "rk4",
    summary: "classical Runge–Kutta: fourth order, four forces per step, stable below h ω = 2.83; damps slightly",
    source: "Hairer, Nørsett & Wanner 1993, II.1",
    parameters: &[],
    build: |_| Box::new(RungeKutta4),
};

/// Where each stage stands in the step, and its weight in the sum.
const STAGES: [(f64, f64); 4] = [(0.0, 1.0 / 6.0), (0.5, 1.0 / 3.0), (0.5, 1.0 / 3.0), (1.0, 1.0 / 6.0)];

impl Stepper for RungeKutta4 {
    fn name(&self) -> &'static str {
        ENTRY.name
    }

    // on the imaginary axis |1 + z + z²/2 + z³/6 + z⁴/24| = 1 at |z| = 2 √2
    fn stability(&self) -> Stability {
        Stability::Limited(2.0 * std::f64::consts::SQRT_2)
    }

    fn step(
        &self,
        system: &System,
        around: &Surroundings,
        start: f64,
        timestep: f64,
        next: &mut SystemState,
        ws: &mut SystemWorkspace,
    ) -> Result<StepReport, StepError> {
        let mut report = StepReport::default();
        let mut buffers: [Vec<Vec3>; 4] = std::array::from_fn(|i| std::mem::take(&mut ws.blocks[i]));
        let [acceleration, velocity, velocity_sum, acceleration_sum] = &mut buffers;
        let (mut start_q, mut start_v) =
            (std::mem::take(&mut ws.configurations[0]), std::mem::take(&mut ws.blocks[4]));
        start_q.clone_from(&next.q);
        start_v.clone_from(&next.v);
        velocity_sum.fill(Vec3::ZERO);
        acceleration_sum.fill(Vec3::ZERO);
        for (stage, (fraction, weight)) in STAGES.into_iter().enumerate() {
            let time = start + fraction * timestep;
            if stage > 0 {
                // q_i = q + c h v_{i-1},  v_i = v + c h a_{i-1}
                next.q.copy_from_slice(&start_q);
                system.kinematics.retract_scaled(&mut next.q, velocity, fraction * timestep);
                for ((v, start), a) in next.v.iter_mut().zip(&start_v).zip(acceleration.iter()) {
                    *v = *start + *a * (fraction * timestep);
                }
                system.impose_constraints(&mut next.q, &mut next.v, time, around.load);
            }
            match accelerations_at(system, around, time, next, ws, acceleration) {
                Ok(evaluated) => report.merge(&evaluated),
                Err(error) => {
                    give_back(ws, buffers, start_q, start_v);
                    return Err(error);
                }
            }
            velocity.copy_from_slice(&next.v);
            for i in 0..velocity.len() {
                velocity_sum[i] += velocity[i] * weight;
                acceleration_sum[i] += acceleration[i] * weight;
            }
        }
        next.q.copy_from_slice(&start_q);
        next.v.copy_from_slice(&start_v);
        // memory moves on at the start of the step, unseen by the stages
        system.place_rows(&next.q, &next.v, start, &mut ws.rows);
        system.advance_memory(&ws.rows, next, around, timestep);
        system.kinematics.retract_scaled(&mut next.q, velocity_sum, timestep);
        for (v, a) in next.v.iter_mut().zip(acceleration_sum.iter()) {
            *v += *a * timestep;
        }
        system.impose_constraints(&mut next.q, &mut next.v, start + timestep, around.load);
        give_back(ws, buffers, start_q, start_v);
        Ok(report)
    }
}

/// Returns the buffers of a step to the workspace.
fn give_back(ws: &mut SystemWorkspace, buffers: [Vec<Vec3>; 4], start_q: Vec<Vec3>, start_v: Vec<Vec3>) {
    for (slot, buffer) in ws.blocks.iter_mut().zip(buffers) {
        *slot = buffer;
    }
    (ws.configurations[0], ws.blocks[4]) = (start_q, start_v);
}
