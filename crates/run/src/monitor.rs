//! Watches the energy of a run: what grows without work is told, with the date and where it grows.
//!
//! `B = T + U + Q − C − W` of what moves, what is stored, what was given off, what controls and couplings made, and the work from outside
//! ([`souple_scene::power_from_outside`], by the trapezoidal rule over periods). No law makes `B` grow; a step that is too long does, and then exponentially: it is told
//! when `B` stands above its lowest value so far, and what moves above nothing, by `growth` times the energy that was exchanged: the greatest of the kinetic energy and of what went into and out of
//! store in the first half of the time that has passed, and of the work that was done until now. A motion that keeps its energy up to the error of its scheme stays far
//! below that, also one that begins late, since what begins it does work; what grows as `e^{γt}` is above it once `e^{γt/2}` is of the order of
//! `growth`: the work of led points grows as `e^{γt/2}` only.

use souple_engine::World;
use souple_scene::spec::world::MonitorSpec;
use souple_scene::{BodyInfo, power_from_outside};

/// Periods that pass before it says anything: schemes of the first order are off by a period at a start from rest.
const FIRST: usize = 32;
/// Rounding of the sums, as a share of what is summed.
const ROUNDING: f64 = 1e-11;
/// By how many times the last digit of their places points shake within a period, at rest and without cause.
const SHAKE: f64 = 100.0;
/// Values that are held of the time that has passed.
const HELD: usize = 1024;

/// Energy grew without work.
#[derive(Clone, Debug, PartialEq)]
pub struct Grown {
    /// When it was told [s].
    pub time: f64,
    /// The body whose masses have most of the kinetic energy.
    pub body: String,
    /// Its mass that moves most, and how fast [m/s].
    pub point: usize,
    pub speed: f64,
    /// How much more there is than at the least [J].
    pub excess: f64,
    /// What was exchanged [J].
    pub reference: f64,
}

impl Grown {
    pub fn message(&self) -> String {
        format!(
            "at {:.6} s there are {:.3e} J more than work can account for, {:.3e} times what moved, was stored and worked before; most of it \
             is in `{}`, whose point {} moves at {:.3e} m/s: the step may be too long (`souple check` tells the longest), or something works that is not counted",
            self.time,
            self.excess,
            self.excess / self.reference,
            self.body,
            self.point,
            self.speed,
        )
    }
}

/// What is watched.
#[derive(Clone, Debug)]
pub struct Monitor {
    spec: MonitorSpec,
    /// `B` at the least [J].
    lowest: f64,
    /// `U` at the last period, and the sum of its changes [J].
    stored: Option<f64>,
    turned: f64,
    /// Greatest kinetic energy or sum of changes of `U` up to each period [J].
    exchanged: History,
    /// `W` and the sum of what it changed by [J], and the power at the last period [W].
    work: f64,
    worked: f64,
    power: f64,
    /// The greatest power so far [W].
    peak: f64,
    pub grown: Option<Grown>,
}

/// What there is at a period [J].
#[derive(Clone, Copy, Debug)]
struct Balance {
    /// `B − min B`.
    excess: f64,
    kinetic: f64,
    /// What was exchanged.
    reference: f64,
}

/// Values that never fall, thinned out by half whenever there are too many.
#[derive(Clone, Debug)]
struct History {
    /// Of the values `0, stride, 2 stride, …`.
    values: Vec<f64>,
    stride: usize,
    count: usize,
    last: f64,
}

impl History {
    fn new() -> Self {
        Self { values: Vec::with_capacity(HELD), stride: 1, count: 0, last: 0.0 }
    }

    /// Takes the next one, or the last again where that is greater.
    fn push(&mut self, value: f64) {
        // what is no number stays
        self.last = if value <= self.last { self.last } else { value };
        if self.count.is_multiple_of(self.stride) {
            if self.values.len() == HELD {
                let mut index = 0;
                self.values.retain(|_| {
                    index += 1;
                    index % 2 == 1
                });
                self.stride *= 2;
            }
            self.values.push(self.last);
        }
        self.count += 1;
    }

    /// The value at half the time, or up to `2/HELD` of the time before.
    fn half(&self) -> f64 {
        self.values[self.count / 2 / self.stride]
    }
}

impl Monitor {
    pub fn new(spec: MonitorSpec, world: &mut World) -> Self {
        let power = power_from_outside(world);
        let mut monitor = Self {
            spec,
            lowest: f64::INFINITY,
            stored: None,
            turned: 0.0,
            exchanged: History::new(),
            work: 0.0,
            worked: 0.0,
            power,
            peak: power.abs(),
            grown: None,
        };
        monitor.take(world);
        monitor
    }

    /// Whether a run is to end where energy grows.
    pub fn stops(&self) -> bool {
        self.spec.stops
    }

    /// Takes the balance of now.
    fn take(&mut self, world: &mut World) -> Balance {
        let energy = world.energy();
        let dissipated: f64 = energy.by_force.iter().map(|(_, energy)| energy.dissipated).sum();
        let made: f64 =
            energy.made_by_control.iter().chain(&energy.made_by_coupling).map(|(_, made)| made).sum();
        let total = energy.total();
        let balance = total + dissipated - made - self.work;
        self.lowest = self.lowest.min(balance);
        let stored = total - energy.kinetic;
        self.turned += (stored - self.stored.replace(stored).unwrap_or(stored)).abs();
        self.exchanged.push(energy.kinetic.max(self.turned));
        let summed = energy.kinetic + stored.abs() + dissipated.abs() + made.abs() + self.work.abs();
        // a start is as wrong later on as at the beginning, by the work of a period
        let begun = self.peak * FIRST as f64 * world.model().period;
        let floor = (ROUNDING * summed).max(shaken(world));
        let reference = self.exchanged.half().max(self.worked + begun).max(floor);
        Balance { excess: balance - self.lowest, kinetic: energy.kinetic, reference }
    }

    /// Looks at a period that has passed; what it has found the first time.
    pub fn look(&mut self, world: &mut World, bodies: &[BodyInfo]) -> Option<&Grown> {
        if self.grown.is_some() {
            return None;
        }
        let power = power_from_outside(world);
        let done = 0.5 * (self.power + power) * world.model().period;
        self.work += done;
        self.worked += done.abs();
        self.peak = self.peak.max(power.abs());
        self.power = power;
        let Balance { excess, kinetic, reference } = self.take(world);
        // energies of what rests are rounded too, by far more than it moves; of what swings half of its energy moves in the mean
        let moving = 2.0 * kinetic;
        // what is no number is not below it either
        let is_well = self.exchanged.count <= FIRST
            || (excess.is_finite() && excess.min(moving) <= self.spec.growth * reference);
        if is_well {
            return None;
        }
        let of_body = |body: &&BodyInfo| -> f64 {
            let velocities = &world.rows(body.system).velocities[body.rows.clone()];
            let mass = &world.model().systems[body.system].mass.diagonal[body.rows.clone()];
            velocities.iter().zip(mass).map(|(v, mass)| 0.5 * mass * v.length_sq()).sum()
        };
        let body = bodies.iter().max_by(|a, b| of_body(a).total_cmp(&of_body(b)))?;
        let velocities = world.rows(body.system).velocities[body.rows.clone()].iter().map(|v| v.length());
        let (point, speed) = velocities.enumerate().max_by(|a, b| a.1.total_cmp(&b.1))?;
        let (time, body) = (world.time(), body.name.clone());
        self.grown = Some(Grown { time, body, point, speed, excess, reference });
        self.grown.as_ref()
    }
}

/// Kinetic energy of points that shake by [`SHAKE`] [J].
fn shaken(world: &World) -> f64 {
    let rate = SHAKE * f64::EPSILON / world.model().period;
    let of_system = |(index, system): (usize, &souple_engine::System)| -> f64 {
        let places = world.rows(index).positions.iter();
        places
            .zip(&system.mass.diagonal)
            .map(|(place, mass)| 0.5 * mass * place.length_sq() * rate * rate)
            .sum()
    };
    world.model().systems.iter().enumerate().map(of_system).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// However long the time, what is held does not grow, and half the time is known to two parts in a thousand.
    #[test]
    fn history_is_thinned() {
        let mut history = History::new();
        for value in 0..100_000 {
            history.push(f64::from(value));
            let (half, count) = (history.half(), f64::from(value + 1));
            assert!(
                half <= 0.5 * count && half >= 0.5 * count - 1.0 - 2.0 * count / HELD as f64,
                "{half} of {count}"
            );
        }
        assert!(history.values.len() <= HELD);
        history.push(3.0);
        assert_eq!(history.last, 99_999.0);
    }
}
