//! Newmark's method: `M a' = f(q', v')`, `v' = v + h ((1 - γ) a + γ a')`, `q' = q + h v + h² ((½ - β) a + β a')`.

use souple_table::{Parameter, Range, Value};

use crate::implicit::{self, ImplicitBuffers, Rates};
use crate::inertia::led_accelerations_at;
use crate::linear::{self, SolverSettings};
use crate::state::SystemState;
use crate::system::{System, SystemWorkspace};

use super::implicit_formula::{
    Before, NEWTON, NEWTON_ITERATIONS, NEWTON_TOLERANCE, NewtonMode, newton_mode, refuse_rotations,
};
use super::{Stability, Step, StepError, StepReport, Stepper, StepperEntry};

/// Average acceleration, `β = ¼`, `γ = ½`: second order, stable at any step for linear forces, and what is linear keeps its
/// energy to rounding; only its phase goes wrong, by `z²/12` of what has passed, `z = h ω`. It damps nothing: what the step
/// does not resolve rings on, and forces that are not linear may make energy of it. Then `γ > ½` takes energy from fast
/// oscillations, best with `β = (γ + ½)²/4`, at the price of the second order: the amplitude of a slow one falls by the part
/// `(γ - ½) z²/2` a step.
///
/// It carries the acceleration, which starts as `M⁻¹ f`.
#[derive(Clone, Debug)]
pub struct Newmark {
    pub beta: f64,
    pub gamma: f64,
    pub newton: NewtonMode,
    pub solver: SolverSettings,
}

const BETA: Parameter = Parameter::number(
    "beta",
    "",
    Range::closed(0.25, 1.0),
    "β: share of the acceleration at the end in the displacement; at least γ/2, or no step would be stable",
)
.or(Value::Number(0.25));

const GAMMA: Parameter = Parameter::number(
    "gamma",
    "",
    Range::closed(0.5, 1.0),
    "γ: share of the acceleration at the end in the velocity; above ½ it dissipates, best with β = (γ + ½)²/4",
)
.or(Value::Number(0.5));

pub(super) const ENTRY: StepperEntry = StepperEntry {
    name: "newmark",
    summary: "second order, implicit: average acceleration keeps the energy of what is linear; gamma above 0.5 dissipates",
    source: "Newmark 1959, A method of computation for structural dynamics; Hughes 2000, The Finite Element Method, §9.1",
    parameters: &[
        BETA,
        GAMMA,
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
        Box::new(Newmark {
            beta: values.number("beta"),
            gamma: values.number("gamma"),
            newton: newton_mode(values),
            solver: SolverSettings::from_values(values),
        })
    },
};

impl Newmark {
    /// `a' = b (v' - p)` over velocity blocks, that of constrained components with them.
    fn carry_acceleration(
        system: &System,
        rates: Rates,
        next: &mut SystemState,
        buffers: &mut ImplicitBuffers,
    ) {
        let ImplicitBuffers { coasting, displacement: acceleration, .. } = buffers;
        for (block, a) in acceleration.iter_mut().enumerate() {
            *a = (next.v[block] - coasting[block]) * rates.acceleration;
        }
        implicit::carry(&system.kinematics, next, [acceleration]);
    }

    /// `a = M⁻¹ f` at the start of the world.
    fn start(
        step: &Step,
        next: &mut SystemState,
        ws: &mut SystemWorkspace,
        buffers: &mut ImplicitBuffers,
    ) -> Result<StepReport, StepError> {
        let Step { system, around, start, timestep } = *step;
        let acceleration = &mut buffers.displacement;
        let report = led_accelerations_at(system, around, (start, timestep), next, ws, acceleration)?;
        implicit::carry(&system.kinematics, next, [acceleration]);
        Ok(report)
    }
}

impl Stepper for Newmark {
    fn name(&self) -> &'static str {
        ENTRY.name
    }

    fn refuses(&self, system: &System) -> Option<String> {
        let Self { beta, gamma, .. } = self;
        if 2.0 * beta < *gamma {
            let least = 0.5 * gamma;
            return Some(format!(
                "`newmark` with gamma = {gamma} is stable for beta of at least {least}, but beta is {beta}"
            ));
        }
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

    fn forget_forces(&self, state: &mut SystemState) {
        // the acceleration is that of the forces before; the next step begins with one of its own
        state.history.clear();
    }

    fn accepts_history(&self, system: &System, history: &[f64]) -> bool {
        implicit::accepts(&system.kinematics, history, 1)
    }

    fn step(
        &self,
        step: &Step,
        next: &mut SystemState,
        ws: &mut SystemWorkspace,
    ) -> Result<StepReport, StepError> {
        let Step { system, timestep, .. } = *step;
        let (Self { beta, gamma, .. }, h) = (self, timestep);
        let mut buffers = ws.implicit.take().unwrap_or_else(|| ImplicitBuffers::new(system));
        let mut report = StepReport::default();
        if implicit::carried::<1>(&system.kinematics, &next.history).is_none() {
            match Self::start(step, next, ws, &mut buffers) {
                Ok(started) => report = started,
                Err(error) => {
                    ws.implicit = Some(buffers);
                    return Err(error);
                }
            }
        }
        // v' = γ/(β h) d + (1 - γ/β) v + h (1 - γ/2β) a,  a' = (v' - v - h (1 - γ) a)/(γ h)
        let rates = Rates { velocity: gamma / (beta * h), acceleration: 1.0 / (gamma * h) };
        let prepare = |next: &SystemState, before: Before| {
            let Some([a]) = implicit::carried(&system.kinematics, &next.history) else { return };
            let ratio = gamma / beta;
            for (block, v) in before.v.iter().enumerate() {
                before.velocity_offset[block] = *v * (1.0 - ratio) + a[block] * (h * (1.0 - 0.5 * ratio));
                before.coasting[block] = *v + a[block] * (h * (1.0 - gamma));
            }
        };
        let taken = step.solve(self.newton, rates, next, ws, &mut buffers, Some(&prepare));
        if let Ok(taken) = &taken {
            report.merge(taken);
            Self::carry_acceleration(system, rates, next, &mut buffers);
            step.finish(next, ws);
        }
        ws.implicit = Some(buffers);
        taken.map(|_| report)
    }
}
