//! Watches the energy of a run: what grows without work is told, with the date and where it grows.
//!
//! `B = T + U + Q − C − W` of what moves, what is stored, what was given off, what controls and couplings made, and the work from outside
//! ([`souple_scene::power_from_outside`], by the trapezoidal rule over periods). No law makes `B` grow; a step that is too long does, and then exponentially: it is told
//! when `B` stands above its lowest value so far by `growth` times the greatest kinetic energy of the first half of the time that has
//! passed. A motion that keeps its energy up to the error of its scheme stays far below that, and what grows as `e^{γt}` is above it
//! once `e^{γt/2}` is of the order of `growth`.

use souple_engine::World;
use souple_scene::spec::world::MonitorSpec;
use souple_scene::{BodyInfo, power_from_outside};

/// Periods that pass before it says anything: schemes of the first order are off by a period at a start from rest.
const FIRST: usize = 32;

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
    /// The greatest kinetic energy in the first half of the time [J].
    pub reference: f64,
}

impl Grown {
    pub fn message(&self) -> String {
        format!(
            "at {:.6} s there are {:.3e} J more than work can account for, {:.3} times the greatest kinetic energy up to half of that time; most of it \
             is in `{}`, whose point {} moves at {:.3e} m/s: the step may be too long, see `souple check`",
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
    /// Greatest kinetic energy up to each period [J].
    kinetic: Vec<f64>,
    /// `W` [J], and the power at the last period [W].
    work: f64,
    power: f64,
    pub grown: Option<Grown>,
}

impl Monitor {
    pub fn new(spec: MonitorSpec, world: &mut World) -> Self {
        let mut monitor = Self {
            spec,
            lowest: f64::INFINITY,
            kinetic: Vec::new(),
            work: 0.0,
            power: power_from_outside(world),
            grown: None,
        };
        monitor.take(world);
        monitor
    }

    /// Whether a run is to end where energy grows.
    pub fn stops(&self) -> bool {
        self.spec.stops
    }

    /// Takes the balance of now; `B − min B` and the reference.
    fn take(&mut self, world: &mut World) -> (f64, f64) {
        let energy = world.energy();
        let dissipated: f64 = energy.by_force.iter().map(|(_, energy)| energy.dissipated).sum();
        let made: f64 =
            energy.made_by_control.iter().chain(&energy.made_by_coupling).map(|(_, made)| made).sum();
        let balance = energy.total() + dissipated - made - self.work;
        self.lowest = self.lowest.min(balance);
        let before = self.kinetic.last().copied().unwrap_or(0.0);
        self.kinetic.push(before.max(energy.kinetic));
        (balance - self.lowest, self.kinetic[self.kinetic.len() / 2])
    }

    /// Looks at a period that has passed; what it has found the first time.
    pub fn look(&mut self, world: &mut World, bodies: &[BodyInfo]) -> Option<&Grown> {
        if self.grown.is_some() {
            return None;
        }
        let power = power_from_outside(world);
        self.work += 0.5 * (self.power + power) * world.model().period;
        self.power = power;
        let (excess, reference) = self.take(world);
        // what is no number is not below it either
        let is_well = self.kinetic.len() <= FIRST || excess <= self.spec.growth * reference;
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
