//! An emulated person at a device, tick by tick.

use souple_math::Vec3;

use crate::TICK;
use crate::arm::{Arm, ArmState};
use crate::device::Device;

/// An arm that moves under the forces it is given.
#[derive(Clone, Debug)]
pub struct EmulatedHand {
    arm: Arm,
    state: ArmState,
    history: Vec<f64>,
}

impl EmulatedHand {
    pub fn new(arm: Arm) -> Self {
        Self { history: vec![0.0; arm.history_len()], state: ArmState::default(), arm }
    }
}

impl Device for EmulatedHand {
    fn exchange(&mut self, force: Vec3) -> Option<Vec3> {
        let was_lost = self.arm.is_lost(self.state.time);
        let force = if was_lost { Vec3::ZERO } else { force };
        self.arm.advance(force, TICK, &self.history, &mut self.state);
        self.arm.tick(&mut self.history, &mut self.state);
        (!self.arm.is_lost(self.state.time)).then_some(self.state.hand.place)
    }
}
