//! The scheme of mass–interaction networks: masses turn forces into positions, with one step of delay.

use souple_math::Vec3;
use souple_table::{Parameter, Value};

use crate::inertia::accelerations_at;
use crate::state::SystemState;
use crate::system::{System, SystemWorkspace};

use super::explicit::{Drifts, OneForce, bound_accelerations, kick, steps_points};
use super::{Stability, Step, StepError, StepReport, Stepper, StepperEntry};

/// `X' = 2 X - X_before + h² F/m` with `F` of `X` and `X_before` alone: what an input does is seen one step later.
///
/// State holds `X` and `v = (X - X_before)/h`, so links that look back find `X_before` as `X - h v`. Energy
/// `½ m v² + ½ Xᵀ K X_before` of a linear network is kept to rounding below `h ω = 2`.
#[derive(Debug)]
pub struct TSimulation {
    pub start: Start,
}

/// Where `X_before` is at the first step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// `X - h v`: the momentum is exact.
    Momentum,
    /// `X - h v + h² F/(2m)`: the trajectory is of second order.
    Trajectory,
}

pub(super) const ENTRY: StepperEntry = StepperEntry {
    name: "t_simulation",
    summary: "X' = 2 X - X_before + h² F/m of mass-interaction networks: one force per step, stable where K + 2Z < 4M",
    source: "Jimenez 1993, P2-I.3.2",
    parameters: &[Parameter::choice(
        "start",
        &["momentum", "trajectory"],
        "X_before of the first step: X - h v keeps the momentum, X - h v + h² F/(2m) the order of the trajectory",
    )
    .or(Value::Text("momentum"))],
    build: |values| {
        let start = if values.text("start") == "trajectory" { Start::Trajectory } else { Start::Momentum };
        Box::new(TSimulation { start })
    },
};

impl Stepper for TSimulation {
    fn reads_cliques(&self) -> bool {
        false
    }

    fn name(&self) -> &'static str {
        ENTRY.name
    }

    fn binds_points(&self, system: &System) -> bool {
        steps_points(system)
    }

    fn stability(&self) -> Stability {
        Stability::Limited(2.0)
    }

    /// One number once the first step is made.
    fn accepts_history(&self, _system: &System, history: &[f64]) -> bool {
        history.len() <= usize::from(self.start == Start::Trajectory)
    }

    // before its first step a trajectory changes the velocity
    fn reads_rows(&self, system: &System, state: &SystemState) -> bool {
        steps_points(system) && (self.start == Start::Momentum || !state.history.is_empty())
    }

    // V' = V + h F(X, X - h V)/m,  X' = X + h V'
    fn step(
        &self,
        step: &Step,
        next: &mut SystemState,
        ws: &mut SystemWorkspace,
    ) -> Result<StepReport, StepError> {
        let Step { system, around, start, timestep } = *step;
        if self.start == Start::Trajectory && next.history.is_empty() {
            let mut acceleration = vec![Vec3::ZERO; next.v.len()];
            if system.binds() {
                bound_accelerations(step, next, ws, &mut acceleration)?;
            } else {
                accelerations_at(system, around, start, next, ws, &mut acceleration)?;
            }
            kick(&mut next.v, &acceleration, -0.5 * timestep);
            next.history.push(1.0);
        }
        let method = OneForce { before: 0.0, drifts: Drifts::AfterKick };
        method.step(step, next, ws)
    }
}
