//! Quasi-statics: `f(q', v', t) = 0` at the end of every step, `v' = (q' - q)/h`.

use crate::implicit::{self, ImplicitBuffers, ImplicitStep, NewtonSettings, Rates};
use crate::linear::{self, SolverSettings};
use crate::state::SystemState;
use crate::system::{Surroundings, System, SystemWorkspace};

use super::implicit_formula::{NEWTON_ITERATIONS, NEWTON_TOLERANCE, newton_settings, settle};
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
        let report = settle(&implicit, self.newton, next, ws, buffers)?;
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
        let mut pairs = std::mem::take(&mut ws.pairs);
        let mut report = StepReport::default();
        // loads that act from the start on find the body at rest
        let load_at = |reached: f64| if start == 0.0 { reached } else { 1.0 };
        let (mut reached, mut part, mut halvings) = (0.0, 1.0, 0);
        let outcome = loop {
            let to = f64::min(1.0, reached + part);
            let around = Surroundings { load: load_at(to), ..*around };
            pairs.clone_from(&next.pairs);
            let part_of = Step {
                system,
                around: &around,
                start: start + reached * timestep,
                timestep: (to - reached) * timestep,
            };
            match self.follow(&part_of, next, ws, &mut buffers) {
                Ok(followed) => {
                    report.merge(&followed);
                    reached = to;
                    if reached >= 1.0 {
                        break Ok(report);
                    }
                }
                Err(error) => {
                    halvings += 1;
                    if halvings > MAX_HALVINGS {
                        let (from, parts) = (start + reached * timestep, part * timestep);
                        break Err(StepError::NoEquilibrium { from, parts, error: Box::new(error) });
                    }
                    part *= 0.5;
                    next.q.copy_from_slice(&buffers.q_start);
                    next.pairs.clone_from(&pairs);
                }
            }
        };
        ws.pairs = pairs;
        ws.implicit = Some(buffers);
        outcome
    }
}
