//! Backward Euler: `M (v' - v) = h f(q', v')`, `q' = retract(q, h v')`.

use crate::implicit::{self, ImplicitBuffers, Rates};
use crate::linear::{self, SolverSettings};
use crate::state::SystemState;
use crate::system::{System, SystemWorkspace};

use super::implicit_formula::{NEWTON, NEWTON_ITERATIONS, NEWTON_TOLERANCE, NewtonMode, newton_mode};
use super::{Stability, Step, StepError, StepReport, Stepper, StepperEntry};

/// First order, stable at any step, damps what it does not resolve: the energy of a linear oscillation is divided by
/// `1 + (h ω)²` every step, exactly. What is lost so is in no account of dissipated energy.
#[derive(Clone, Debug)]
pub struct BackwardEuler {
    pub newton: NewtonMode,
    pub solver: SolverSettings,
}

pub(super) const ENTRY: StepperEntry = StepperEntry {
    name: "backward_euler",
    summary: "first order, implicit: stable at any step, damps what the step does not resolve",
    source: "Baraff & Witkin 1998, Large steps in cloth simulation, §3; Hairer & Wanner 1996, IV.3",
    parameters: &[
        NEWTON,
        NEWTON_TOLERANCE,
        NEWTON_ITERATIONS,
        linear::SOLVER,
        linear::PRECONDITIONER,
        linear::TOLERANCE,
        linear::MAX_ITERATIONS,
        linear::MATRIX_FREE,
    ],
    build: |values| {
        Box::new(BackwardEuler { newton: newton_mode(values), solver: SolverSettings::from_values(values) })
    },
};

impl Stepper for BackwardEuler {
    fn name(&self) -> &'static str {
        ENTRY.name
    }

    fn stability(&self) -> Stability {
        Stability::Unconditional
    }

    fn augments(&self) -> bool {
        self.newton.is_full()
    }

    fn solver_settings(&self) -> SolverSettings {
        self.solver.clone()
    }

    fn accepts_history(&self, system: &System, history: &[f64]) -> bool {
        implicit::accepts(&system.kinematics, history, 0)
    }

    fn step(
        &self,
        step: &Step,
        next: &mut SystemState,
        ws: &mut SystemWorkspace,
    ) -> Result<StepReport, StepError> {
        let Step { system, timestep, .. } = *step;
        let mut buffers = ws.implicit.take().unwrap_or_else(|| ImplicitBuffers::new(system));
        let rates = Rates::backward_euler(timestep);
        let taken = step.solve(self.newton, rates, next, ws, &mut buffers, None);
        ws.implicit = Some(buffers);
        let report = taken?;
        step.finish(next, ws);
        Ok(report)
    }
}
