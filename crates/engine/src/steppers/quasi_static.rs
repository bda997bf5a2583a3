//! Quasi-statics: `f(q', v', t) = 0` at the end of every step, `v' = (q' - q)/h`.

use crate::implicit::{self, ImplicitBuffers, ImplicitStep, NewtonSettings, Rates};
use crate::linear::{self, SolverSettings};
use crate::state::SystemState;
use crate::system::{Surroundings, System, SystemWorkspace};

use super::implicit_formula::{NEWTON_ITERATIONS, NEWTON_TOLERANCE, newton_settings, settle_constrained};
use super::parts::{Stuck, in_parts};
use super::static_equilibrium::conserves;
use super::{Stability, Step, StepError, StepReport, Stepper, StepperEntry};

/// A path of equilibria under loads and motions that change in time, each sought from the last: what happens slowly enough
/// that mass does not resist. Forces see the velocity at which the body follows, so that viscosity and friction act: relaxation
/// and creep, to the first order of the step; where no force depends on velocity every end of a step is the equilibrium of
/// that time. Kinetic energy is none of the balance: beside the rest it tells how good the assumption is.
///
/// A step that does not converge is taken in halves, and those in halves; loads that act from the start grow from nothing in
/// the first step. A body that buckles or snaps through goes to an equilibrium downhill, without what it does on the way;
/// where none is found, the step is refused.
#[derive(Clone, Debug)]
pub struct QuasiStatic {
    pub newton: NewtonSettings,
    pub solver: SolverSettings,
}

/// Halvings of a step before it is given up.
const MAX_HALVINGS: u32 = 10;

pub(super) const ENTRY: StepperEntry = StepperEntry {
    name: "quasi_static",
    summary: "a path of equilibria without inertia under loads and motions in time; viscosity and friction act; steps that do not converge are halved",
    source: "Bonet & Wood 2008, §9.6; Wriggers 2008, Nonlinear Finite Element Methods, §5.1",
    parameters: &[
        NEWTON_TOLERANCE,
        NEWTON_ITERATIONS,
        linear::SOLVER,
        linear::PRECONDITIONER,
        linear::TOLERANCE,
        linear::MAX_ITERATIONS,
        linear::MATRIX_FREE,
    ],
    build: |values| {
        Box::new(QuasiStatic { newton: newton_settings(values), solver: SolverSettings::from_values(values) })
    },
};

impl QuasiStatic {
    /// Equilibrium at the end of `step`, from the configuration in `next`.
    fn follow(
        &self,
        step: &Step,
        next: &mut SystemState,
        ws: &mut SystemWorkspace,
        buffers: &mut ImplicitBuffers,
    ) -> Result<StepReport, StepError> {
        let Step { system, around, timestep, .. } = *step;
        let implicit = ImplicitStep {
            system,
            around: *around,
            end: step.end(),
            rates: Rates::creeping(timestep),
            has_potential: conserves(system),
        };
        implicit.begin(next, buffers);
        let report = settle_constrained(&implicit, self.newton, next, ws, buffers)?;
        let ImplicitBuffers { q_start, velocity_offset, .. } = buffers;
        implicit.velocity_into(&next.q, q_start, velocity_offset, &mut next.v);
        step.finish(next, ws);
        Ok(report)
    }
}

impl Stepper for QuasiStatic {
    fn name(&self) -> &'static str {
        ENTRY.name
    }

    fn stability(&self) -> Stability {
        Stability::Unconditional
    }

    fn augments(&self) -> bool {
        true
    }

    fn has_inertia(&self) -> bool {
        false
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
        let Step { system, around, start, timestep } = *step;
        let mut buffers = ws.implicit.take().unwrap_or_else(|| ImplicitBuffers::new(system));
        // loads that act from the start on find the body at rest
        let load_at = |reached: f64| if start == 0.0 { reached } else { 1.0 };
        let outcome = in_parts(1.0, MAX_HALVINGS, next, ws, |part, next, ws| {
            let around = Surroundings { load: load_at(part.end), ..*around };
            let (from, timestep) = (start + part.start * timestep, (part.end - part.start) * timestep);
            self.follow(&Step { system, around: &around, start: from, timestep }, next, ws, &mut buffers)
        });
        ws.implicit = Some(buffers);
        outcome.map_err(|Stuck { reached, part, error }| match error {
            StepError::Interrupted => error,
            error => StepError::NoEquilibrium {
                from: start + reached * timestep,
                parts: part * timestep,
                error: Box::new(error),
            },
        })
    }
}
