//! Backward Euler: `M (v' - v) = h f(q', v')`, `q' = retract(q, h v')`.

use souple_table::{Parameter, Range, Value};

use crate::implicit::{ImplicitBuffers, ImplicitStep, Lent, NewtonSettings};
use crate::linear::{self, SolverSettings};
use crate::state::SystemState;
use crate::system::{Surroundings, System, SystemWorkspace};

use super::{Stability, StepError, StepReport, Stepper, StepperEntry};

/// First order, stable at any step, damps what it does not resolve: the energy of a linear oscillation is divided by
/// `1 + (h ω)²` every step, exactly. What is lost so is in no account of dissipated energy.
#[derive(Clone, Debug)]
pub struct BackwardEuler {
    pub newton: NewtonMode,
    pub solver: SolverSettings,
}

/// How far the nonlinear equation of a step is solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NewtonMode {
    /// One linearisation about the start (Baraff & Witkin 1998): the force at the end is `f + K Δq`, wrong by
    /// `½ ∂²f/∂q² Δq²`, of second order in the step, so the method stays of first order. Exact where forces are linear.
    /// Elsewhere there is no bound on energy: a law that stiffens along the step rises above the parabola that was
    /// minimised, and long steps may gain. What does not touch at the start of a step is not felt in it.
    One,
    /// To the tolerance, with line search. Where the potential is convex from the start of a step to its end,
    /// `E' ≤ E - ½ M |v' - v|²` to the tolerance: energy does not grow.
    Full(NewtonSettings),
}

const NEWTON: Parameter = Parameter::choice(
    "newton",
    &["full", "one"],
    "`full`: to the tolerance, with line search; `one`: a single linearised solve per step",
)
.or(Value::Text("full"));

/// Wanted unbalanced force, relative to the largest in the step.
pub(super) const NEWTON_TOLERANCE: Parameter = Parameter::number(
    "newton_tolerance",
    "",
    Range::open(0.0, 1.0),
    "unbalanced force at which Newton's method stops, relative to the largest in the step",
)
.or(Value::Number(1e-8));

pub(super) const NEWTON_ITERATIONS: Parameter = Parameter::integer(
    "newton_iterations",
    Range::closed(1.0, 1000.0),
    "iterations before a step is given up",
)
.or(Value::Integer(50));

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
        let settings = newton_settings(values);
        let newton =
            if values.text("newton") == "one" { NewtonMode::One } else { NewtonMode::Full(settings) };
        Box::new(BackwardEuler { newton, solver: SolverSettings::from_values(values) })
    },
};

pub(super) fn newton_settings(values: &souple_table::Values) -> NewtonSettings {
    NewtonSettings {
        tolerance: values.number("newton_tolerance"),
        max_iterations: values.integer("newton_iterations") as u32,
    }
}

/// Searches of pairs within one solve before it is given up.
const MAX_SEARCHES: u32 = 16;

/// Newton's method from the configuration of `next` until what touches is what was looked for.
///
/// While it iterates, pairs stay as they are: forces are pure and the merit is one function. Where it ends, rows may have
/// come farther than the search of pairs saw. Pairs are then found again there, those still there with their memory, and
/// the same equation is solved on from there. All of it follows from the State at the start of the step.
pub(super) fn settle(
    implicit: &ImplicitStep,
    settings: NewtonSettings,
    next: &mut SystemState,
    ws: &mut SystemWorkspace,
    buffers: &mut ImplicitBuffers,
) -> Result<StepReport, StepError> {
    let mut report = StepReport::default();
    for _ in 0..MAX_SEARCHES {
        let lent = Lent::from(next);
        let solved = implicit.solve_newton(settings, &lent, &mut next.q, ws, buffers);
        lent.give_back(next);
        report.merge(&solved?);
        implicit.system.place_rows(&next.q, &next.v, implicit.end, &mut ws.rows);
        if !implicit.system.refresh_pairs(ws, next, &implicit.around) {
            return Ok(report);
        }
    }
    Err(StepError::PairsUnsettled { searches: MAX_SEARCHES })
}

impl Stepper for BackwardEuler {
    fn name(&self) -> &'static str {
        ENTRY.name
    }

    fn stability(&self) -> Stability {
        Stability::Unconditional
    }

    fn solver_settings(&self) -> SolverSettings {
        self.solver.clone()
    }

    fn accepts_history(&self, system: &System, history: &[f64]) -> bool {
        Lent::accepts_history(system, history)
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
        let mut buffers = ws.implicit.take().unwrap_or_else(|| ImplicitBuffers::new(system));
        buffers.q_start.copy_from_slice(&next.q);
        buffers.v_start.copy_from_slice(&next.v);
        system.place_rows(&next.q, &next.v, start, &mut ws.rows);
        buffers.start_row_velocities.copy_from_slice(&ws.rows.velocities);
        let implicit = ImplicitStep {
            system,
            around: *around,
            end: start + timestep,
            timestep: Some(timestep),
            has_potential: system.kinematics.is_trivial()
                && system.forces.iter().all(|force| force.declaration().conservative),
        };
        let solved = match self.newton {
            NewtonMode::One => {
                let lent = Lent::from(next);
                let solved = implicit.solve_once(&lent, &mut next.q, ws, &mut buffers);
                lent.give_back(next);
                solved
            }
            NewtonMode::Full(settings) => settle(&implicit, settings, next, ws, &mut buffers),
        };
        // v' = difference(q', q)/h, the very velocity the equation was solved with
        implicit.velocity_into(&next.q, &buffers.q_start, &mut next.v);
        ws.implicit = Some(buffers);
        let report = solved?;
        system.impose_constraints(&mut next.q, &mut next.v, start + timestep, around.load);
        system.place_rows(&next.q, &next.v, start + timestep, &mut ws.rows);
        system.advance_memory(ws, next, around, timestep);
        Ok(report)
    }
}
