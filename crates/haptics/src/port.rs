//! Where energy goes between a person and the machine: force out every tick, and an account of it.
//!
//! A force that is held for a tick while the hand moves on gives back more than the spring took: a wall that is sampled
//! is a source of energy, and a delayed one more so. The observer sums up `-F·Δx`, which for a held force is exact, and the
//! controller lets the device push along with the hand only as fast as what is in the account allows
//! (Hannaford & Ryu 2002, "Time-domain passivity control of haptic interfaces").

use souple_math::Vec3;

use crate::TICK;
use crate::coupling::{Coupling, Moving};

/// What makes the force on a hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Port {
    pub coupling: Coupling,
    /// Whether the controller acts; the observer always does.
    pub passive: bool,
}

/// What a port remembers from tick to tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PortState {
    /// Where the device was at the last tick [m].
    pub place: Vec3,
    /// On the hand since then [N].
    pub force: Vec3,
    /// Put in by the person, less what came back [J].
    pub energy: f64,
    /// Share of the coupling that acts: it grows when a device comes back.
    pub engaged: f64,
    /// The greatest change of the force from tick to tick [N], taking away of a device that is lost not counted.
    pub jump: f64,
}

/// Time in which a device that has come back is coupled again [s].
const ENGAGING: f64 = 0.2;
/// Time in which what is in the account may be given back, at the soonest [s]: the force fades and does not fall.
const GIVING: f64 = 5.0 * TICK;
/// By this a hand's velocity may be another at the next tick, in any direction [m/s].
const STIRRING: f64 = 0.01;

impl Port {
    /// The state before anybody has moved, with the device at its start.
    pub fn start() -> PortState {
        PortState { engaged: 1.0, ..PortState::default() }
    }

    /// A tick, `elapsed` seconds after the one before: the device is at `device`, `None` where it is lost; the force on the hand is in the
    /// state afterwards.
    pub fn tick(&self, state: &mut PortState, device: Option<Vec3>, elapsed: f64, tool: Moving) {
        self.tick_as(state, device, elapsed, |hand| self.coupling.pull(tool, hand));
    }

    /// The same of a device that feels a force itself, and not where its tool is.
    pub fn tick_with(&self, state: &mut PortState, device: Option<Vec3>, elapsed: f64, force: Vec3) {
        self.tick_as(state, device, elapsed, |_| force);
    }

    fn tick_as(
        &self,
        state: &mut PortState,
        device: Option<Vec3>,
        elapsed: f64,
        pull: impl Fn(Moving) -> Vec3,
    ) {
        let Some(place) = device else {
            // nobody is there to feel anything
            *state = PortState { force: Vec3::ZERO, engaged: 0.0, ..*state };
            return;
        };
        if state.engaged == 0.0 {
            // where it was lost is not where it moved from
            state.place = place;
        }
        let moved = place - state.place;
        state.energy -= state.force.dot(moved);
        state.engaged = (state.engaged + elapsed / ENGAGING).min(1.0);
        let hand = Moving { place, velocity: moved / elapsed };
        let pull = self.coupling.limited(pull(hand) * state.engaged);
        let force = if self.passive { self.fitting(pull, hand.velocity, state.energy) } else { pull };
        state.jump = state.jump.max((force - state.force).length());
        (state.place, state.force) = (place, force);
    }

    /// The force with no more of it than the account can pay: along the velocity, across it where the hand gives way, and against it what is beyond a damper, which
    /// takes. A heavier push would turn the hand round within the tick, and take nothing. A hand that rests feels all.
    fn fitting(&self, force: Vec3, velocity: Vec3, energy: f64) -> Vec3 {
        let Some(direction) = velocity.try_normalised() else { return force };
        let speed = velocity.length();
        let payable = |speed: f64| energy.max(0.0) / ((speed + STIRRING) * GIVING);
        let along = force.dot(direction);
        let against = self.coupling.damping_borne() * speed + payable(0.0);
        let fitting = along.max(-against).min(payable(speed));
        let across = force - direction * along;
        let (length, most) = (across.length(), payable(0.0));
        let excess = if length > most { across * (1.0 - most / length) } else { Vec3::ZERO };
        force + direction * (fitting - along) - excess
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use souple_engine::Motion;

    use super::*;
    use crate::arm::{Arm, ArmState};

    const STIFF: Coupling = Coupling { stiffness: 2000.0, damping: 0.0, limit: 10.0 };

    /// Pokes a wall at 0 to a depth of 4 mm and comes back, `count` times; the least that is in the account, and the greatest force.
    fn poked(passive: bool, count: usize) -> (PortState, f64) {
        let port = Port { coupling: STIFF, passive };
        let (mut state, mut least) = (PortState { place: Vec3::X * 2e-3, ..Port::start() }, f64::INFINITY);
        for tick in 0..count * 50 {
            let x = 2e-3 - 3e-3 * (1.0 - f64::cos(tick as f64 * std::f64::consts::TAU / 50.0));
            let place = Vec3::X * x;
            // the tool is stopped by the wall
            let tool = Moving { place: Vec3::X * x.max(0.0), velocity: Vec3::ZERO };
            port.tick(&mut state, Some(place), TICK, tool);
            least = least.min(state.energy);
        }
        (state, least)
    }

    /// A sampled wall without damping gives energy, poke after poke; under control it gives none beyond the error of one tick.
    #[test]
    fn no_energy_comes_out() {
        let (free, _) = poked(false, 20);
        assert!(free.energy < -1e-3, "{free:?}");
        let (_, least) = poked(true, 20);
        // |F| |a| T² of a tick: the speed at the next tick is not known; a = 3 mm (2 π / 50 ms)²
        let bound = 8.0 * 3e-3 * (std::f64::consts::TAU / 0.05).powi(2) * TICK * TICK;
        assert!(least >= -bound, "{least} {bound}");
        assert!(bound < 0.4 * -free.energy);
    }

    /// A force of held points comes two periods of a world of 10 ms late: it gives energy, poke after poke, and under control none beyond
    /// the error of one tick.
    #[test]
    fn no_energy_comes_out_of_late_forces() {
        let poked = |passive: bool| {
            let port = Port { coupling: STIFF, passive };
            let depth = |tick: i32| {
                2e-3 - 3e-3 * (1.0 - f64::cos(f64::from(tick.max(0)) * std::f64::consts::TAU / 200.0))
            };
            let (mut state, mut least) =
                (PortState { place: Vec3::X * 2e-3, ..Port::start() }, f64::INFINITY);
            for tick in 0..4000 {
                let felt = Vec3::X * (-STIFF.stiffness * depth(tick - 20)).max(0.0);
                port.tick_with(&mut state, Some(Vec3::X * depth(tick)), TICK, felt);
                least = least.min(state.energy);
            }
            (state.energy, least)
        };
        let (free, _) = poked(false);
        let (_, least) = poked(true);
        // |F| |a| T² of a tick; |F| = 2 kN/m · 4 mm, a = 3 mm (2 π / 200 ms)²
        let bound = 8.0 * 3e-3 * (std::f64::consts::TAU / 0.2).powi(2) * TICK * TICK;
        assert!(least >= -bound, "{least} {bound}");
        assert!(free < -10.0 * bound, "{free} {bound}");
    }

    /// A hand that means to go along `x`, at a speed that is given.
    #[derive(Debug)]
    struct Along(f64);

    impl Motion for Along {
        fn offset(&self, _: Vec3, time: f64) -> Vec3 {
            Vec3::X * (self.0 * time)
        }

        fn velocity(&self, _: Vec3, _: f64) -> Vec3 {
            Vec3::X * self.0
        }
    }

    /// A tool that begins away from a hand that has put nothing in: it pulls at what rests, and no more once that has given way: what comes out is the work of that tick,
    /// `F² T²/M` at most. Without control the hand is pulled after it.
    #[test]
    fn what_nobody_has_put_in_is_given_for_a_tick() {
        const AWAY: f64 = 5e-3;
        const MASS: f64 = 0.4;
        let least_of = |passive: bool, speed: f64| {
            let intent = Arc::new(Along(speed));
            let (lost, delay) = ((0.0, 0.0), 0.06);
            let arm = Arm { mass: MASS, stiffness: 300.0, damping: 8.0, reflex: 0.0, delay, lost, intent };
            let port = Port { coupling: Coupling::DEFAULT, passive };
            let (mut state, mut hand, mut least) = (Port::start(), ArmState::default(), 0.0_f64);
            for _ in 0..500 {
                let place = hand.hand.place;
                let tool = Moving { place: Vec3::X * place.x + Vec3::Y * AWAY, velocity: Vec3::ZERO };
                port.tick(&mut state, Some(place), TICK, tool);
                least = least.min(state.energy);
                arm.advance(state.force, TICK, &[], &mut hand);
                arm.tick(&mut [], &mut hand);
            }
            least
        };
        let bound = (Coupling::DEFAULT.stiffness * AWAY * TICK).powi(2) / MASS;
        for speed in [0.0, 0.02, 0.05] {
            assert!(least_of(false, speed) < -100.0 * bound, "{speed}");
            let least = least_of(true, speed);
            assert!((-bound..-0.5 * bound).contains(&least), "{speed}: {least} {bound}");
        }
    }

    /// The force is never longer than the device can give.
    #[test]
    fn forces_are_limited() {
        let port = Port { coupling: STIFF, passive: false };
        let mut state = Port::start();
        port.tick(&mut state, Some(Vec3::new(0.3, -0.4, 0.0)), TICK, Moving::default());
        assert!((state.force - Vec3::new(-6.0, 8.0, 0.0)).length() < 1e-12);
    }

    /// A device that is lost feels nothing, and one that comes back is taken in slowly, from no force on, wherever it is then.
    #[test]
    fn lost_and_found() {
        let port = Port { coupling: STIFF, passive: false };
        let mut state = Port::start();
        let place = Vec3::X * 4e-3;
        port.tick(&mut state, Some(place), TICK, Moving::default());
        let held = state;
        port.tick(&mut state, None, TICK, Moving::default());
        assert_eq!((state.force, state.energy), (Vec3::ZERO, held.energy));
        let mut before = 0.0;
        for tick in 1..=200 {
            port.tick(&mut state, Some(Vec3::X * 1e-3), TICK, Moving::default());
            let length = state.force.length();
            // k x T / 0.2 s a tick
            assert!(length - before <= 2.0 * TICK / ENGAGING * (1.0 + 1e-9), "{tick} {length}");
            before = length;
        }
        assert!((before - 2.0).abs() < 1e-9);
        // what the force was at the jump of places does no work
        assert_eq!(state.energy, held.energy);
    }
}
