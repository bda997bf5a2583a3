//! What the implicit steppers share: how far the equation of a step is solved, and the page of stages around it.

use souple_math::Vec3;
use souple_table::{Parameter, Range, Value, Values};

use crate::force::Unmet;
use crate::implicit::{ImplicitBuffers, ImplicitStep, LedVelocity, Lent, NewtonSettings, Rates};
use crate::kept::Summed;
use crate::state::SystemState;
use crate::system::{System, SystemWorkspace};

use super::{Step, StepError, StepReport};

/// How far the nonlinear equation of a step is solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NewtonMode {
    /// One linearisation about the start (Baraff & Witkin 1998): the force at the end is `f + K Δq`, wrong by
    /// `½ ∂²f/∂q² Δq²`, of second order in the step, so that no method loses its order. Exact where forces are linear.
    /// Elsewhere there is no bound on energy: a law that stiffens along the step rises above the parabola that was
    /// minimised, and long steps may gain: a step whose end is higher than its start is solved by Newton's method in its place, loosely, and
    /// where that fails taken in part. What does not touch at the start of a step is not felt in it.
    One,
    /// To the tolerance, with line search. Under backward Euler, where the potential is convex from the start of a step to
    /// its end, `E' ≤ E - ½ M |v' - v|²` to the tolerance: energy does not grow.
    Full(NewtonSettings),
}

impl NewtonMode {
    pub(super) fn is_full(self) -> bool {
        matches!(self, Self::Full(_))
    }
}

pub(super) const NEWTON: Parameter = Parameter::choice(
    "newton",
    &["full", "one"],
    "`full`: to the tolerance, with line search; `one`: a single linearised solve per step, and more of a step that it would take uphill",
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

pub(super) fn newton_settings(values: &Values) -> NewtonSettings {
    NewtonSettings {
        tolerance: values.number("newton_tolerance"),
        max_iterations: values.integer("newton_iterations") as u32,
    }
}

/// Solves between which multipliers are moved on before a step is given up.
const MOST_AUGMENTATIONS: u32 = 100;

/// Equilibrium of all forces, with the multipliers that keep what is to be kept as near as is wanted: solved as [`settle`] does, and
/// again each time that they were moved on (Bertsekas 1982, §2.2; Simo & Taylor 1991).
pub(super) fn settle_constrained(
    implicit: &ImplicitStep,
    settings: NewtonSettings,
    next: &mut SystemState,
    ws: &mut SystemWorkspace,
    buffers: &mut ImplicitBuffers,
) -> Result<StepReport, StepError> {
    let system = implicit.system;
    let mut report = StepReport::default();
    let mut solves = 0;
    loop {
        report.merge(&settle(implicit, settings, next, ws, buffers)?);
        solves += 1;
        let Some((force, unmet)) = system.augment(&ws.rows, next) else { return Ok(report) };
        if solves == MOST_AUGMENTATIONS || !unmet.off.is_finite() {
            let Unmet { what, off, wanted, row } = unmet;
            let (force, time) = (system.forces[force].name().to_owned(), implicit.end);
            return Err(StepError::Unmet { force, what, off, wanted, solves, row, time });
        }
    }
}

/// Searches of pairs within one solve before it is given up.
const MAX_SEARCHES: u32 = 16;

/// Newton's method from the configuration of `next` until what touches is what was looked for.
///
/// While it iterates, pairs stay as they are: forces are pure and the merit is one function. Where it ends, rows may have
/// come farther than the search of pairs saw. Pairs are then found again there, those still there with their memory, and
/// the same equation is solved on from there. All of it follows from the State at the start of the step.
fn settle(
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

/// Newton's method where one solve does not do: to a thousandth of the unbalanced force, as much as one solve leaves of a step that turns what it moves by a
/// twentieth, `½ (1/20)²`.
const LOOSE: NewtonSettings = NewtonSettings { tolerance: 1e-3, max_iterations: 12 };

/// One linearised solve, or several where its whole would raise the step's potential: what is shortened stays behind where inertia leads. Where Newton's
/// method fails, for whatever reason, the shortened step stands.
fn one_or_as_many(
    implicit: &ImplicitStep,
    lent: &Lent,
    q: &mut [Vec3],
    ws: &mut SystemWorkspace,
    buffers: &mut ImplicitBuffers,
) -> Result<StepReport, StepError> {
    let mut report = implicit.solve_once(lent, q, ws, buffers)?;
    if report.shortened == 0 {
        return Ok(report);
    }
    let mut shortened = std::mem::take(&mut buffers.shortened);
    shortened.clear();
    shortened.extend_from_slice(q);
    q.copy_from_slice(&buffers.q_start);
    match implicit.solve_newton(LOOSE, lent, q, ws, buffers) {
        Ok(more) => {
            report.shortened = 0;
            report.merge(&StepReport { gone_on: 1, ..more });
        }
        Err(StepError::Interrupted) => return Err(StepError::Interrupted),
        Err(_) => q.copy_from_slice(&shortened),
    }
    buffers.shortened = shortened;
    Ok(report)
}

/// The mode that a stepper's completed values ask for.
pub(super) fn newton_mode(values: &Values) -> NewtonMode {
    if values.text("newton") == "one" { NewtonMode::One } else { NewtonMode::Full(newton_settings(values)) }
}

/// `v₀` and `p` of [`Rates`], to be written over velocity blocks, and what they follow from.
pub(super) struct Before<'a> {
    /// Velocity at the start.
    pub v: &'a [Vec3],
    pub velocity_offset: &'a mut [Vec3],
    /// Holds `v` to begin with.
    pub coasting: &'a mut [Vec3],
}

/// Writes what a formula makes of the state and of what it carries.
pub(super) type Prepare<'a> = dyn Fn(&SystemState, Before) + 'a;

impl Step<'_> {
    /// Solves the equation of a formula whose `v₀` and `p` `prepare` writes; it is backward Euler's where nothing is prepared. Buffers
    /// hold the start of the step afterwards, and `p`.
    pub(super) fn solve(
        &self,
        newton: NewtonMode,
        rates: Rates,
        next: &mut SystemState,
        ws: &mut SystemWorkspace,
        buffers: &mut ImplicitBuffers,
        prepare: Option<&Prepare>,
    ) -> Result<StepReport, StepError> {
        let Self { system, around, timestep, .. } = *self;
        let implicit = ImplicitStep {
            system,
            around: *around,
            end: self.end(),
            rates,
            has_potential: system.kinematics.is_trivial()
                && system.forces.iter().all(|force| force.declaration().conservative),
        };
        implicit.begin(next, buffers);
        if let Some(prepare) = prepare {
            let ImplicitBuffers { v_start, velocity_offset, coasting, .. } = buffers;
            prepare(next, Before { v: v_start, velocity_offset, coasting });
        }
        if rates.has_velocity() {
            let led = if prepare.is_some() { LedVelocity::Exact } else { LedVelocity::Difference };
            implicit.lead_constrained(timestep, led, buffers);
        }
        let report = match newton {
            NewtonMode::One => {
                let lent = Lent::from(next);
                let solved = one_or_as_many(&implicit, &lent, &mut next.q, ws, buffers);
                lent.give_back(next);
                solved
            }
            NewtonMode::Full(settings) => settle_constrained(&implicit, settings, next, ws, buffers),
        }?;
        // the very velocity that the equation was solved with
        let ImplicitBuffers { q_start, velocity_offset, .. } = buffers;
        implicit.velocity_into(&next.q, q_start, velocity_offset, &mut next.v);
        Ok(report)
    }

    /// Imposes what is prescribed, and moves memories on.
    pub(super) fn finish(&self, next: &mut SystemState, ws: &mut SystemWorkspace) {
        let end = self.end();
        self.system.impose_constraints(&mut next.q, &mut next.v, end, self.around.load);
        self.system.place_rows(&next.q, &next.v, end, &mut ws.rows);
        self.system.advance_memory(ws, next, self.around, self.timestep, Summed::Elsewhere);
    }
}

/// Why a formula of two steps, which adds vectors of different configurations, cannot step this system.
pub(super) fn refuse_rotations(name: &str, system: &System) -> Option<String> {
    system.kinematics.has_turning_frames().then(|| {
        format!(
            "`{name}` adds displacements of earlier steps, which rigid frames do not have in common; take \
             `backward_euler` or an explicit stepper"
        )
    })
}
