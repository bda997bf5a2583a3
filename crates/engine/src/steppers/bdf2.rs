//! The second backward differentiation formula: `M (3 v' - 4 v + v₋₁)/(2 h) = f(q', v')`, `q'` likewise from `v'`.

use crate::implicit::{self, ImplicitBuffers, Rates};
use crate::linear::{self, SolverSettings};
use crate::state::SystemState;
use crate::system::{System, SystemWorkspace};

use super::implicit_formula::{
    Before, NEWTON, NEWTON_ITERATIONS, NEWTON_TOLERANCE, NewtonMode, newton_mode, refuse_rotations,
};
use super::{Stability, Step, StepError, StepReport, Stepper, StepperEntry};

/// Second order, stable at any step, damps what it does not resolve: for long motions in which fast oscillations are
/// to die, where backward Euler would also slow what is wanted. An oscillation that is resolved keeps its energy but for the
/// part `z⁴/2` a step, `z = h ω`: with `w = v - i ω q`, `w' = ρ w` for `ρ = (2 + √(1 - 2 i z))/(3 + 2 i z)`.
///
/// It carries the displacement and the velocity of the step before; the first step is one of backward Euler, which costs
/// no order. A jump (of a load, of a contact) is seen with the past before it, as in all formulas of several steps.
#[derive(Clone, Debug)]
pub struct Bdf2 {
    pub newton: NewtonMode,
    pub solver: SolverSettings,
}

pub(super) const ENTRY: StepperEntry = StepperEntry {
    name: "bdf2",
    summary: "second order, implicit: stable at any step, damps what the step does not resolve and little else",
    source: "Hairer & Wanner 1996, V.1; Choi & Ko 2002, Stable but responsive cloth, §4",
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
        Box::new(Bdf2 { newton: newton_mode(values), solver: SolverSettings::from_values(values) })
    },
};

impl Stepper for Bdf2 {
    fn name(&self) -> &'static str {
        ENTRY.name
    }

    fn refuses(&self, system: &System) -> Option<String> {
        refuse_rotations(ENTRY.name, system)
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
        implicit::accepts(&system.kinematics, history, 2)
    }

    fn step(
        &self,
        step: &Step,
        next: &mut SystemState,
        ws: &mut SystemWorkspace,
    ) -> Result<StepReport, StepError> {
        let Step { system, timestep, .. } = *step;
        let mut buffers = ws.implicit.take().unwrap_or_else(|| ImplicitBuffers::new(system));
        // v' = (3 d - e)/(2 h),  a' = (3 v' - 4 v + v₋₁)/(2 h), with the displacement e of the step before
        let prepare = |next: &SystemState, before: Before| {
            let Some([e, earlier]) = implicit::carried(&system.kinematics, &next.history) else { return };
            for (block, v) in before.v.iter().enumerate() {
                before.velocity_offset[block] = e[block] * (-0.5 / timestep);
                before.coasting[block] = (*v * 4.0 - earlier[block]) * (1.0 / 3.0);
            }
        };
        let has_past = implicit::carried::<2>(&system.kinematics, &next.history).is_some();
        let rate = 1.5 / timestep;
        let rates = if has_past {
            Rates { velocity: rate, acceleration: rate }
        } else {
            Rates::backward_euler(timestep)
        };
        let taken = step.solve(self.newton, rates, next, ws, &mut buffers, Some(&prepare));
        if taken.is_ok() {
            step.finish(next, ws);
            let ImplicitBuffers { q_start, v_start, displacement, .. } = &mut buffers;
            system.kinematics.difference(&next.q, q_start, displacement);
            implicit::carry(&system.kinematics, next, [displacement, v_start]);
        }
        ws.implicit = Some(buffers);
        taken
    }
}
