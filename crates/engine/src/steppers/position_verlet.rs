//! Störmer–Verlet in its position form: half a drift, a kick, half a drift.

use crate::inertia::accelerations_at;
use crate::state::SystemState;
use crate::system::{Surroundings, System, SystemWorkspace};

use super::{Stability, StepError, StepReport, Stepper, StepperEntry};

/// `q½ = q + h/2 v`, `v' = v + h a(q½, v)`, `q' = q½ + h/2 v'`: second order and symplectic at one force a
/// step. Forces that depend on velocity see that of the start, which makes their part first order.
#[derive(Debug)]
pub struct PositionVerlet;

pub(super) const ENTRY: StepperEntry = StepperEntry {
    name: "verlet",
    summary: "Störmer–Verlet (position form): second order, one force per step, energy bounded below h ω = 2",
    source: "Hairer, Lubich & Wanner 2003, Geometric numerical integration illustrated by the Störmer–Verlet method, eq. 1.8",
    parameters: &[],
    build: |_| Box::new(PositionVerlet),
};

impl Stepper for PositionVerlet {
    fn name(&self) -> &'static str {
        ENTRY.name
    }

    fn stability(&self) -> Stability {
        Stability::Limited(2.0)
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
        let half = 0.5 * timestep;
        let mut acceleration = std::mem::take(&mut ws.blocks[0]);
        // q½ = q + h/2 v
        system.kinematics.retract_scaled(&mut next.q, &next.v, half);
        // v' = v + h a(q½, v)
        let evaluated = accelerations_at(system, around, start + half, next, ws, &mut acceleration);
        let report = match evaluated {
            Ok(report) => report,
            Err(error) => {
                ws.blocks[0] = acceleration;
                return Err(error);
            }
        };
        system.advance_memory(&ws.rows, next, around, timestep);
        for (v, a) in next.v.iter_mut().zip(&acceleration) {
            *v += *a * timestep;
        }
        // q' = q½ + h/2 v'
        system.kinematics.retract_scaled(&mut next.q, &next.v, half);
        system.impose_constraints(&mut next.q, &mut next.v, start + timestep, around.load);
        ws.blocks[0] = acceleration;
        Ok(report)
    }
}
