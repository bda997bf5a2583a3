//! A person's arm that holds a device: a mass on a spring and a damper that follow what the person means to do.
//!
//! `m a = F + k (x_m - x) + c (v_m - v) + k_r (x_m - x)(t - τ)`: muscles that are tensed are springs at once (Hogan 1985, "The
//! mechanics of multi-joint posture and movement control"); reflexes add theirs a delay later.

use std::sync::Arc;

use souple_engine::Motion;
use souple_math::Vec3;

use crate::TICK;
use crate::coupling::Moving;

/// An arm and what it means to do.
#[derive(Clone, Debug)]
pub struct Arm {
    /// Of hand and device, as felt at the grip [kg].
    pub mass: f64,
    /// Of tensed muscles [N/m].
    pub stiffness: f64,
    /// [N s/m]
    pub damping: f64,
    /// Of reflexes [N/m].
    pub reflex: f64,
    /// After which reflexes act [s].
    pub delay: f64,
    /// When the device is lost, and for how long [s].
    pub lost: (f64, f64),
    /// Where it means to be, from where it started.
    pub intent: Arc<dyn Motion>,
}

/// How an arm stands.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ArmState {
    pub hand: Moving,
    /// [s]
    pub time: f64,
    /// Ticks so far, by which reflexes remember.
    pub ticks: u64,
}

impl Arm {
    /// Numbers that reflexes remember.
    pub fn history_len(&self) -> usize {
        if self.reflex > 0.0 { 3 * self.lag() } else { 0 }
    }

    /// Ticks of the delay.
    fn lag(&self) -> usize {
        (self.delay / TICK).round().max(1.0) as usize
    }

    fn meant(&self, time: f64) -> Moving {
        let (place, velocity) =
            (self.intent.offset(Vec3::ZERO, time), self.intent.velocity(Vec3::ZERO, time));
        Moving { place, velocity }
    }

    /// Whether the device has no hold of it.
    pub fn is_lost(&self, time: f64) -> bool {
        let (at, duration) = self.lost;
        time >= at && time < at + duration
    }

    /// Moves on under the force of the device, at most for a tick. Implicit in the hand's own velocity: stable for any arm.
    pub fn advance(&self, force: Vec3, timestep: f64, history: &[f64], state: &mut ArmState) {
        let h = timestep;
        let (meant, Moving { place, velocity }) = (self.meant(state.time + h), state.hand);
        let mut force = force + (meant.place - place) * self.stiffness + meant.velocity * self.damping;
        if !history.is_empty() {
            // the oldest is the next to be written over
            let at = 3 * (state.ticks as usize % self.lag());
            force += Vec3::new(history[at], history[at + 1], history[at + 2]) * self.reflex;
        }
        // (m + h c + h² k) v' = m v + h F
        let carried = self.mass + h * (self.damping + h * self.stiffness);
        let velocity = (velocity * self.mass + force * h) / carried;
        state.hand = Moving { place: place + velocity * h, velocity };
        state.time += h;
    }

    /// A tick is over: what reflexes will answer is noted.
    pub fn tick(&self, history: &mut [f64], state: &mut ArmState) {
        if !history.is_empty() {
            let error = self.meant(state.time).place - state.hand.place;
            let at = 3 * (state.ticks as usize % self.lag());
            history[at..at + 3].copy_from_slice(&error.to_array());
        }
        state.ticks += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A place that is meant from the start on.
    #[derive(Debug)]
    struct At(Vec3);

    impl Motion for At {
        fn offset(&self, _: Vec3, _: f64) -> Vec3 {
            self.0
        }

        fn velocity(&self, _: Vec3, _: f64) -> Vec3 {
            Vec3::ZERO
        }
    }

    fn arm(reflex: f64) -> Arm {
        let intent = Arc::new(At(Vec3::X * 0.01));
        Arm { mass: 0.4, stiffness: 300.0, damping: 8.0, reflex, delay: 0.05, lost: (0.0, 0.0), intent }
    }

    fn settled(arm: &Arm, force: Vec3, ticks: usize) -> ArmState {
        let (mut state, mut history) = (ArmState::default(), vec![0.0; arm.history_len()]);
        for _ in 0..ticks {
            arm.advance(force, TICK, &history, &mut state);
            arm.tick(&mut history, &mut state);
        }
        state
    }

    /// Against a steady force the arm gives way by `F / (k + k_r)`.
    #[test]
    fn an_arm_gives_way() {
        for reflex in [0.0, 100.0] {
            let state = settled(&arm(reflex), Vec3::X * -2.0, 5000);
            let expected = 0.01 - 2.0 / (300.0 + reflex);
            assert!((state.hand.place.x - expected).abs() < 1e-9, "{reflex} {state:?}");
        }
    }

    /// Before the delay is over reflexes change nothing, after it they do.
    #[test]
    fn reflexes_come_late() {
        let place = |reflex, ticks| settled(&arm(reflex), Vec3::ZERO, ticks).hand.place;
        assert_eq!(place(100.0, 50), place(0.0, 50));
        assert_ne!(place(100.0, 52), place(0.0, 52));
    }

    /// The swing of an undamped arm has the period `2 π √(m/k)`; the implicit step brakes it and leaves that as it is.
    #[test]
    fn an_arm_swings() {
        let arm = Arm { damping: 0.0, ..arm(0.0) };
        let (mut state, mut crossings) = (ArmState::default(), Vec::new());
        let mut before = -1.0;
        while crossings.len() < 3 {
            arm.advance(Vec3::ZERO, TICK, &[], &mut state);
            let x = state.hand.place.x - 0.01;
            if x * before < 0.0 {
                crossings.push(state.time - TICK * x / (x - before));
            }
            before = x;
        }
        let omega = (300.0_f64 / 0.4).sqrt();
        // half a period apart; of the first order in ωh, squared
        let half = crossings[1] - crossings[0];
        assert!((half * omega / std::f64::consts::PI - 1.0).abs() < (omega * TICK).powi(2), "{half}");
    }
}
