//! Statics: `f(q) = 0`, reached over load steps; what tears there is gone before the step ends.

use souple_math::Vec3;
use souple_table::{Parameter, Range, Value};

use crate::implicit::{self, ImplicitBuffers, ImplicitStep, NewtonSettings, Rates};
use crate::kept::Summed;
use crate::linear::{self, SolverSettings};
use crate::state::SystemState;
use crate::system::{Surroundings, System, SystemWorkspace};

use super::implicit_formula::{NEWTON_ITERATIONS, NEWTON_TOLERANCE, newton_settings, settle_constrained};
use super::parts::in_parts;
use super::{Stability, Step, StepError, StepReport, Stepper, StepperEntry};

/// Equilibrium at the end of every step: loads and prescribed motion grow over `load_steps` in the first
/// step from where the world starts; a load step that does not converge is halved.
#[derive(Clone, Debug)]
pub struct StaticEquilibrium {
    pub load_steps: u32,
    pub newton: NewtonSettings,
    pub solver: SolverSettings,
}

const LOAD_STEPS: Parameter = Parameter::integer(
    "load_steps",
    Range::closed(1.0, 100_000.0),
    "steps over which loads grow from nothing to all; halved by themselves where one does not converge",
)
.or(Value::Integer(1));

/// Halvings of a load step before it is given up.
const MAX_HALVINGS: u32 = 12;

pub(super) const ENTRY: StepperEntry = StepperEntry {
    name: "static",
    summary: "equilibrium by Newton's method over load steps; no inertia, velocities are zero",
    source: "Bonet & Wood 2008, §9.6",
    parameters: &[
        LOAD_STEPS,
        NEWTON_TOLERANCE,
        NEWTON_ITERATIONS,
        linear::SOLVER,
        linear::PRECONDITIONER,
        linear::TOLERANCE,
        linear::MAX_ITERATIONS,
        linear::MATRIX_FREE,
    ],
    build: |values| {
        Box::new(StaticEquilibrium {
            load_steps: values.integer("load_steps") as u32,
            newton: newton_settings(values),
            solver: SolverSettings::from_values(values),
        })
    },
};

/// Whether all forces are minus the gradient of an energy.
pub(super) fn conserves(system: &System) -> bool {
    system.kinematics.is_conservative() && system.forces.iter().all(|force| force.declaration().conservative)
}

impl StaticEquilibrium {
    /// Equilibrium under the fraction `load` of the loads, from the configuration in `next`.
    fn equilibrate(
        &self,
        system: &System,
        around: Surroundings,
        end: f64,
        next: &mut SystemState,
        ws: &mut SystemWorkspace,
        buffers: &mut ImplicitBuffers,
    ) -> Result<StepReport, StepError> {
        let implicit =
            ImplicitStep { system, around, end, rates: Rates::STATIC, has_potential: conserves(system) };
        settle_constrained(&implicit, self.newton, next, ws, buffers)
    }
}

impl StaticEquilibrium {
    /// Equilibrium of what is left, as long as anything bears more than it can; all that does gives way at once, since in statics nothing comes first.
    fn settle_what_gives_way(
        &self,
        step: &Step,
        report: StepReport,
        next: &mut SystemState,
        ws: &mut SystemWorkspace,
        buffers: &mut ImplicitBuffers,
    ) -> Result<StepReport, StepError> {
        let Step { system, around, .. } = *step;
        let (mut report, mut all) = (report, Vec::new());
        loop {
            system.place_rows(&next.q, &next.v, step.end(), &mut ws.rows);
            let broke = system.give_way(ws, next, around);
            // what is whole grows less each time
            if broke.is_empty() {
                return Ok(report);
            }
            all.extend(broke);
            all.sort();
            all.dedup();
            match self.equilibrate(system, *around, step.end(), next, ws, buffers) {
                Ok(again) => report.merge(&again),
                Err(error) => return Err(StepError::GaveWay { forces: all, error: Box::new(error) }),
            }
        }
    }
}

impl Stepper for StaticEquilibrium {
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
        // the first step of a world starts from nothing; later ones continue under full load
        let (first, halvings) =
            if start == 0.0 { (1.0 / f64::from(self.load_steps), MAX_HALVINGS) } else { (1.0, 0) };
        let outcome = in_parts(first, halvings, next, ws, |part, next, ws| {
            let around = Surroundings { load: if start == 0.0 { part.end } else { 1.0 }, ..*around };
            self.equilibrate(system, around, step.end(), next, ws, &mut buffers)
        });
        let report = outcome.map_err(|stuck| stuck.error);
        let report =
            report.and_then(|report| self.settle_what_gives_way(step, report, next, ws, &mut buffers));
        ws.implicit = Some(buffers);
        let report = report?;
        next.v.fill(Vec3::ZERO);
        system.place_rows(&next.q, &next.v, step.end(), &mut ws.rows);
        system.advance_memory(ws, next, around, timestep, Summed::Elsewhere);
        Ok(report)
    }
}
