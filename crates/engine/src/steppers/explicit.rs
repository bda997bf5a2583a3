//! The two Euler methods that evaluate the force once, at the start of the step.

use crate::inertia::accelerations_at;
use crate::state::SystemState;
use crate::system::{Surroundings, System, SystemWorkspace};

use super::{Stability, StepError, StepReport, Stepper, StepperEntry};

/// `q' = q + h v`, `v' = v + h a(q, v)`: first order, gains energy at any step; for comparison.
#[derive(Debug)]
pub struct ExplicitEuler;

/// `v' = v + h a(q, v)`, `q' = q + h v'`: first order, keeps energy bounded below `h ω = 2`; the cheapest
/// way to move a body freely, called modified or semi-implicit Euler too.
#[derive(Debug)]
pub struct SymplecticEuler;

pub(super) const EXPLICIT_EULER: StepperEntry = StepperEntry {
    name: "explicit_euler",
    summary: "first order, one force per step; gains energy at any step, for comparison only",
    source: "Hairer, Lubich & Wanner 2006, I.1.2",
    parameters: &[],
    build: |_| Box::new(ExplicitEuler),
};

pub(super) const SYMPLECTIC_EULER: StepperEntry = StepperEntry {
    name: "symplectic_euler",
    summary: "first order, one force per step, energy bounded below h ω = 2; the cheapest explicit method",
    source: "Hairer, Lubich & Wanner 2006, I.1.2",
    parameters: &[],
    build: |_| Box::new(SymplecticEuler),
};

impl Stepper for ExplicitEuler {
    fn name(&self) -> &'static str {
        EXPLICIT_EULER.name
    }

    fn stability(&self) -> Stability {
        Stability::Growing
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
        let mut acceleration = std::mem::take(&mut ws.blocks[0]);
        let evaluated = accelerations_at(system, around, start, next, ws, &mut acceleration);
        let report = match evaluated {
            Ok(report) => report,
            Err(error) => {
                ws.blocks[0] = acceleration;
                return Err(error);
            }
        };
        system.advance_memory(&ws.rows, next, around, timestep);
        // q' = q + h v
        system.kinematics.retract_scaled(&mut next.q, &next.v, timestep);
        // v' = v + h a
        for (v, a) in next.v.iter_mut().zip(&acceleration) {
            *v += *a * timestep;
        }
        system.impose_constraints(&mut next.q, &mut next.v, start + timestep, around.load);
        ws.blocks[0] = acceleration;
        Ok(report)
    }
}

impl Stepper for SymplecticEuler {
    fn name(&self) -> &'static str {
        SYMPLECTIC_EULER.name
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
        let mut acceleration = std::mem::take(&mut ws.blocks[0]);
        let evaluated = accelerations_at(system, around, start, next, ws, &mut acceleration);
        let report = match evaluated {
            Ok(report) => report,
            Err(error) => {
                ws.blocks[0] = acceleration;
                return Err(error);
            }
        };
        system.advance_memory(&ws.rows, next, around, timestep);
        // v' = v + h a
        for (v, a) in next.v.iter_mut().zip(&acceleration) {
            *v += *a * timestep;
        }
        // q' = q + h v'
        system.kinematics.retract_scaled(&mut next.q, &next.v, timestep);
        system.impose_constraints(&mut next.q, &mut next.v, start + timestep, around.load);
        ws.blocks[0] = acceleration;
        Ok(report)
    }
}
