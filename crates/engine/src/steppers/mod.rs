//! Ways to step in time: one file each and one line in [`TABLE`].

mod backward_euler;
mod bdf2;
mod explicit;
mod implicit_formula;
mod newmark;
mod parts;
mod position_verlet;
mod quasi_static;
mod runge_kutta;
mod staggered;
mod static_equilibrium;
mod t_simulation;

use souple_table::{Entry, Table, Values};

use crate::levels::Division;
use crate::linear::SolverSettings;
use crate::state::{Place, SystemState};
use crate::system::{Surroundings, System, SystemWorkspace};

pub use backward_euler::BackwardEuler;
pub use bdf2::Bdf2;
pub use explicit::{ExplicitEuler, NewtonCotes, SymplecticEuler};
pub use implicit_formula::NewtonMode;
pub use newmark::Newmark;
pub use position_verlet::PositionVerlet;
pub use quasi_static::QuasiStatic;
pub use runge_kutta::{RungeKutta2, RungeKutta4};
pub use staggered::{Schedule, Staggered, StaggeredBuffers};
pub use static_equilibrium::StaticEquilibrium;
pub use t_simulation::{Start, TSimulation};

/// What a step had to do.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepReport {
    pub newton_iterations: u64,
    pub linear_iterations: u64,
    /// Linear solves whose matrix was not definite and was made so ([`crate::Force::add_definite_blocks`]).
    pub made_definite: u64,
    /// Linearised steps that were taken in part, since the whole would have raised the step's potential.
    pub shortened: u64,
    /// Steps of one linearised solve that Newton's method went on with for that reason.
    pub gone_on: u64,
    /// Largest relative residual among the linear solves.
    pub linear_residual: f64,
    /// Norm of the remaining unbalanced force over that at the start; 0 for explicit steppers.
    pub newton_residual: f64,
    /// Sweeps over contacts whose forces are solved for, and products with their matrix.
    pub contact_iterations: u64,
    /// How far such contacts are from signs, gaps and friction as they are to be, of how far they would be without forces.
    pub contact_residual: f64,
    /// Steps in which bodies were jammed: contacts that have no forces by the law were asked less, and by how much [m].
    pub wedged_steps: u64,
    pub contacts_wedged: f64,
}

impl StepReport {
    /// The report of this step and those before it.
    pub fn merge(&mut self, other: &Self) {
        self.newton_iterations += other.newton_iterations;
        self.linear_iterations += other.linear_iterations;
        self.made_definite += other.made_definite;
        self.shortened += other.shortened;
        self.gone_on += other.gone_on;
        self.linear_residual = self.linear_residual.max(other.linear_residual);
        self.newton_residual = self.newton_residual.max(other.newton_residual);
        self.contact_iterations += other.contact_iterations;
        self.contact_residual = self.contact_residual.max(other.contact_residual);
        self.wedged_steps += other.wedged_steps;
        self.contacts_wedged = self.contacts_wedged.max(other.contacts_wedged);
    }
}

/// A step that could not finish; State is as it was.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StepError {
    #[error("the linear solve of a step failed: {error}")]
    Linear {
        error: String,
        /// The velocity block where it failed, if it did at one.
        block: Option<usize>,
    },
    #[error(
        "Newton's method did not converge in {iterations} iterations: the unbalanced force is {residual:.3e} of what it was, {wanted:.1e} is wanted; take smaller steps, of time or load, or `newton = \"one\"` where the stepper knows it"
    )]
    NewtonStalled {
        iterations: u64,
        residual: f64,
        wanted: f64,
        /// The velocity block of the largest unbalanced force.
        block: usize,
    },
    #[error(
        "prescribed points are {to_go:.3e} m from where they are led, and no step brings them closer; lead them more slowly"
    )]
    NotReached { to_go: f64 },
    #[error(
        "from {from} s on no equilibrium was found, even in parts of {parts:.1e} s: {error}{}",
        may_buckle(error)
    )]
    NoEquilibrium {
        /// Seconds up to which there was one.
        from: f64,
        /// The shortest step tried [s].
        parts: f64,
        error: Box<StepError>,
    },
    #[error("{} gave way, and no rest of what is left was found: {error}", .forces.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", "))]
    GaveWay {
        /// Names of the forces of which something broke.
        forces: Vec<String>,
        error: Box<StepError>,
    },
    #[error(
        "force `{force}` is not finite or too large to compute with ({value:?} at row {row}, time {time} s): it has no value there; lead or load more slowly, or stay where it has"
    )]
    ForceNotFinite { force: String, row: usize, value: [f64; 3], time: f64 },
    #[error(
        "the {what} of what is led is not finite or too large to compute with ({value:?} at time {time} s)"
    )]
    MotionNotFinite {
        /// Motion or velocity.
        what: &'static str,
        /// The velocity block that is led.
        block: usize,
        value: [f64; 3],
        time: f64,
    },
    #[error(
        "the energy of force `{force}` is not finite where the step leads (time {time} s): it has no value there; lead or load more slowly, or stay where it has"
    )]
    EnergyNotFinite { force: String, time: f64 },
    #[error(
        "the slope of force `{force}` is not finite or too large to compute with (at row {row}, time {time} s): it is infinite there, or there is none"
    )]
    SlopeNotFinite { force: String, row: usize, time: f64 },
    #[error("force `{force}`: {what} (at row {row}, time {time} s)")]
    Fault { force: String, row: usize, what: String, time: f64 },
    #[error(
        "what touches changed {searches} times within a step, and with it where the step leads; take a smaller step or more load steps"
    )]
    PairsUnsettled { searches: u32 },
    #[error(
        "`{force}`: {relation} is {off:.3e} from what it is to be where the step ends (time {time} s), and no forces bring it there: it is held elsewhere, contradicted by others, locked by friction, or turns too far in one step: take a smaller one"
    )]
    Unkept { force: String, relation: String, off: f64, row: usize, time: f64 },
    #[error(
        "`{force}`: {what} is off by {off:.1e} after {solves} solves (time {time} s), {wanted:.1e} is wanted: raise the penalty, or what it may be off by; where all of it is held or led there is nothing that could give"
    )]
    Unmet { force: String, what: &'static str, off: f64, wanted: f64, solves: u32, row: usize, time: f64 },
    #[error(
        "`{force}`: which constraints give way is not found, among them {relation} (time {time} s): take a smaller step"
    )]
    LimitsUnsettled { force: String, relation: String, row: usize, time: f64 },
    #[error("{0}")]
    Field(String),
    /// It was broken off from outside ([`crate::Interruption`]).
    #[error("the step was broken off")]
    Interrupted,
    #[error(
        "{field} is not finite after the step to {time} s; the step may be too long for what is stiff there"
    )]
    StateNotFinite { field: Place, time: f64 },
}

impl StepError {
    /// Whether a shorter way may not meet it: not where nothing was asked of the way, or where there is no state that keeps what is to be kept.
    fn may_pass(&self) -> bool {
        !matches!(self, Self::Interrupted | Self::Unmet { .. })
    }

    /// What the innermost attempt failed of.
    pub fn cause(&self) -> &Self {
        match self {
            Self::NoEquilibrium { error, .. } | Self::GaveWay { error, .. } => error.cause(),
            other => other,
        }
    }
}

/// What else may be the matter where nothing is infinite.
fn may_buckle(cause: &StepError) -> &'static str {
    match cause.cause() {
        StepError::ForceNotFinite { .. }
        | StepError::EnergyNotFinite { .. }
        | StepError::SlopeNotFinite { .. } => "",
        _ => {
            "; the body may buckle, snap or slip free there: damp it, lead it instead of loading it, or take a stepper \
             with inertia"
        }
    }
}

/// How long a step may be for an oscillation of angular frequency `ω`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stability {
    /// Any step.
    Unconditional,
    /// `h ω` below this.
    Limited(f64),
    /// No step without damping: amplitudes grow by `factor (h ω)^(power + 1)` a step, which is
    /// `factor ω^(power + 1) h^power` per second.
    Growing { factor: f64, power: i32 },
}

/// A step to be made: of what, from when, how far.
#[derive(Clone, Copy)]
pub struct Step<'a> {
    pub system: &'a System,
    pub around: &'a Surroundings<'a>,
    /// When it begins [s].
    pub start: f64,
    /// How long it is [s].
    pub timestep: f64,
}

impl Step<'_> {
    /// When it ends [s].
    pub fn end(&self) -> f64 {
        self.start + self.timestep
    }
}

/// A way to step.
pub trait Stepper: Send + Sync {
    /// Whether the next step overwrites configuration and velocity from rows that are placed already
    /// ([`SystemWorkspace::rows_are_the_state`]), and leaves the rows as they stand after it: neither needs to be copied then.
    fn reads_rows(&self, _system: &System, _state: &SystemState) -> bool {
        false
    }

    /// Its name in the table.
    fn name(&self) -> &'static str;

    /// Why it cannot step this system, in words that name what stands in the way.
    fn refuses(&self, _system: &System) -> Option<String> {
        None
    }

    /// Whether it steps bodies of which only some points move by themselves, see [`crate::Levels`].
    fn steps_levels(&self) -> bool {
        false
    }

    /// Whether it leads points that forces hold, see [`crate::Holding`].
    fn holds_points(&self, _system: &System) -> bool {
        false
    }

    /// Whether it solves for the forces of relations between points, see [`crate::ConstraintSet`].
    fn binds_points(&self, _system: &System) -> bool {
        false
    }

    /// Whether its steps keep what forces keep by multipliers, see [`crate::Force::augment`].
    fn augments(&self) -> bool {
        false
    }

    /// How it divides such a step, and which rates it takes together; `None` where it does not.
    fn ticks(&self, _timestep: f64) -> Option<(Division, Schedule)> {
        None
    }

    /// Whether it asks which rows a force couples ([`crate::Force::visit_cliques`]), as those do that make a matrix.
    fn reads_cliques(&self) -> bool {
        true
    }

    fn stability(&self) -> Stability;

    /// How long a force is taken to stay what it is within a step [s]: what [`Stepper::stability`] is of.
    fn interval(&self, timestep: f64) -> f64 {
        timestep
    }

    /// Whether mass resists acceleration in its steps; statics knows no inertia.
    fn has_inertia(&self) -> bool {
        true
    }

    /// How it solves linear systems; defaults for those that solve none but masses.
    fn solver_settings(&self) -> SolverSettings {
        SolverSettings::default()
    }

    /// Drops what history says of forces, which have jumped at the state that a step came to.
    fn forget_forces(&self, _state: &mut SystemState) {}

    /// Whether it can go on from a [`SystemState::history`] read from a file.
    fn accepts_history(&self, _system: &System, history: &[f64]) -> bool {
        history.is_empty()
    }

    /// Moves `next`, which holds the state where the step begins, to where it ends.
    ///
    /// # Errors
    /// The step cannot be finished; `next` is then worthless.
    fn step(
        &self,
        step: &Step,
        next: &mut SystemState,
        ws: &mut SystemWorkspace,
    ) -> Result<StepReport, StepError>;
}

/// Makes a stepper from its checked parameters.
pub type BuildStepper = fn(&Values) -> Box<dyn Stepper>;

/// All steppers.
pub const TABLE: Table<BuildStepper> = Table {
    kind: "stepper",
    entries: &[
        &explicit::EXPLICIT_EULER,
        &explicit::SYMPLECTIC_EULER,
        &explicit::NEWTON_COTES,
        &position_verlet::ENTRY,
        &t_simulation::ENTRY,
        &runge_kutta::RK2,
        &runge_kutta::RK4,
        &staggered::ENTRY,
        &backward_euler::ENTRY,
        &bdf2::ENTRY,
        &newmark::ENTRY,
        &static_equilibrium::ENTRY,
        &quasi_static::ENTRY,
    ],
};

/// An entry of [`TABLE`].
pub type StepperEntry = Entry<BuildStepper>;
