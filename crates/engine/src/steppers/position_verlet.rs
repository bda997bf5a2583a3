//! Störmer–Verlet in its position form: half a drift, a kick, half a drift.

use crate::state::SystemState;
use crate::system::SystemWorkspace;

use super::explicit::{Drifts, OneForce};
use super::{Stability, Step, StepError, StepReport, Stepper, StepperEntry};

/// `q½ = q + h/2 v`, `v' = v + h a(q½, v)`, `q' = q½ + h/2 v'`: second order and symplectic at one force a
/// step. Forces that depend on velocity see that of the start, which makes their part first order. Energy swings by
/// `(h ω)² / 4` of itself and does not drift below `h ω = 2`: `½ m (1 - (h ω)²/4) v² + ½ k q²` of a linear
/// oscillator is kept exactly.
#[derive(Debug)]
pub struct PositionVerlet;

pub(super) const ENTRY: StepperEntry = StepperEntry {
    name: "verlet",
    summary: "Störmer–Verlet (position form): second order, one force per step, energy bounded below h ω = 2",
    source: "Hairer, Lubich & Wanner 2003, Geometric numerical integration illustrated by the Störmer–Verlet method, eq. 1.8",
    parameters: &[],
    build: |_| Box::new(PositionVerlet),
};

impl Stepper for PositionVerlet {
    fn reads_cliques(&self) -> bool {
        false
    }

    fn name(&self) -> &'static str {
        ENTRY.name
    }

    fn stability(&self) -> Stability {
        Stability::Limited(2.0)
    }

    // q½ = q + h/2 v,  v' = v + h a(q½, v),  q' = q½ + h/2 v'
    fn step(
        &self,
        step: &Step,
        next: &mut SystemState,
        ws: &mut SystemWorkspace,
    ) -> Result<StepReport, StepError> {
        let method = OneForce { before: 0.5, drifts: Drifts::AfterKick };
        method.step(step, next, ws)
    }
}
