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
    /// [N]
    force: Vec3,
}

impl EmulatedHand {
    pub fn new(arm: Arm) -> Self {
        Self { history: vec![0.0; arm.history_len()], state: ArmState::default(), arm, force: Vec3::ZERO }
    }
}

impl Device for EmulatedHand {
    fn place(&mut self) -> Option<Vec3> {
        let was_lost = self.arm.is_lost(self.state.time);
        let force = if was_lost { Vec3::ZERO } else { self.force };
        self.arm.advance(force, TICK, &self.history, &mut self.state);
        self.arm.tick(&mut self.history, &mut self.state);
        (!self.arm.is_lost(self.state.time)).then_some(self.state.hand.place)
    }

    fn give(&mut self, force: Vec3) {
        self.force = force;
    }
}
