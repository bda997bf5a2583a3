//! The loop at the devices: a thread of its own, a thousand times a second, that waits for nobody.
//!
//! It tells the world where devices are and hears from it where tools are, and what those feel that hold points, by numbers that
//! lie ready ([`Latest`]). A world that is late, or has ended, leaves the hand with a spring to where the tool was last, or with a
//! force that fades.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use souple_math::Vec3;

use crate::TICK;
use crate::coupling::Moving;
use crate::device::Device;
use crate::exchange::Latest;
use crate::freshness::{Ages, Freshness};
use crate::pace::{Histogram, Pace, Rank, hurry};
use crate::port::{Port, PortState};
use crate::smoothing::{Between, ForceSmoothing, Smoothing};

/// What a device feels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feels {
    /// The spring to its tool, a thing of its own.
    Tool,
    /// The force of the points that its tool holds, which is where the device is.
    Force,
}

/// A hand that is served.
pub struct Station {
    pub name: String,
    pub device: Box<dyn Device>,
    pub port: Port,
    pub feels: Feels,
    pub between: Between,
    /// Of the world [s].
    pub period: f64,
}

/// What the world tells of a hand.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Told {
    pub tool: Moving,
    /// Of points that the tool holds, on it [N].
    pub felt: Vec3,
    /// When the device was where the world was led to by it, see [`DeviceNow::At`] [s].
    pub looked: f64,
}

/// One moment of one hand.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tick {
    /// Since the loop began [s].
    pub time: f64,
    pub device: Vec3,
    /// Where the device feels the tool.
    pub tool: Vec3,
    /// On the person [N].
    pub force: Vec3,
    /// [J]
    pub energy: f64,
    pub is_lost: bool,
}

/// Where a device is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeviceNow {
    /// From where it started [m]; `None` where it is lost.
    pub place: Option<Vec3>,
    /// When it was looked at, since the loop began [s].
    pub date: f64,
}

/// How the loop kept its time.
#[derive(Clone, Debug, Default)]
pub struct Toll {
    /// From one waking to the next.
    pub periods: Histogram,
    /// Dates that passed before the loop woke.
    pub left_out: u64,
    /// Seconds of work, all ticks together.
    pub busy: f64,
    /// What came of the wish for priority.
    pub priority: String,
}

/// What is left of a loop that has ended.
pub struct Served {
    pub toll: Toll,
    /// Of each hand.
    pub ticks: Vec<Vec<Tick>>,
    pub ports: Vec<PortState>,
    /// What devices said that made no sense.
    pub refused: Vec<u64>,
    pub ages: Vec<Ages>,
}

/// The loop cannot be.
#[derive(Debug, thiserror::Error)]
#[error("no thread for the loop of the devices: {0}")]
pub struct ServiceError(#[from] std::io::Error);

/// Numbers between the loop and the world, of one hand.
#[derive(Debug)]
struct Wire {
    /// Place, 1 where it is there, and when [s].
    device: Latest<5>,
    /// Place, velocity, what it feels, how often it was told, and when the device was looked at [s].
    tool: Latest<11>,
}

/// The loop at work.
pub struct Service {
    wires: Vec<Arc<Wire>>,
    told: f64,
    start: Instant,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<Served>>,
}

/// Within which of its tick all devices are served, as a rule [s].
const SERVED: f64 = 0.1 * TICK;
/// Ticks that an emulated person lives through at most when the loop wakes too late.
const MOST_AT_ONCE: u32 = 1000;

impl Service {
    /// Starts serving; moments are kept for `duration` seconds.
    ///
    /// # Errors
    /// The system gives no thread.
    pub fn start(stations: Vec<Station>, duration: f64) -> Result<Self, ServiceError> {
        let wire = |_: &Station| {
            Arc::new(Wire { device: Latest::new([0.0, 0.0, 0.0, 1.0, 0.0]), tool: Latest::new([0.0; 11]) })
        };
        let wires: Vec<Arc<Wire>> = stations.iter().map(wire).collect();
        let stop = Arc::new(AtomicBool::new(false));
        let (of_loop, end) = (wires.clone(), stop.clone());
        let room = (duration / TICK).ceil().clamp(0.0, 1e7) as usize;
        let start = Instant::now();
        let thread = std::thread::Builder::new()
            .name("devices".to_owned())
            .spawn(move || serve(stations, &of_loop, &end, start, room))?;
        Ok(Self { wires, told: 0.0, start, stop, thread: Some(thread) })
    }

    /// When devices have been served next, as a rule: a world that begins then has their newest places, and the rest of the tick to
    /// answer within.
    pub fn next_served(&self) -> Instant {
        let ticks = (self.start.elapsed().as_secs_f64() / TICK).floor() + 1.0;
        self.start + Duration::from_secs_f64(ticks * TICK + SERVED)
    }

    /// Where the device of a hand is; `None` where that cannot be told just now.
    pub fn device(&self, hand: usize) -> Option<DeviceNow> {
        let [x, y, z, is_there, date] = self.wires[hand].device.read()?;
        Some(DeviceNow { place: (is_there == 1.0).then_some(Vec3::new(x, y, z)), date })
    }

    /// The world tells where all tools are, and what they feel.
    pub fn tell(&mut self, all: impl Iterator<Item = Told>) {
        self.told += 1.0;
        for (wire, Told { tool, felt, looked }) in self.wires.iter().zip(all) {
            let ([x, y, z], [u, v, w]) = (tool.place.to_array(), tool.velocity.to_array());
            let [a, b, c] = felt.to_array();
            wire.tool.write(&[x, y, z, u, v, w, a, b, c, self.told, looked]);
        }
    }

    /// Ends the loop.
    pub fn end(mut self) -> Option<Served> {
        self.stop.store(true, Ordering::Relaxed);
        self.thread.take()?.join().ok()
    }
}

impl Drop for Service {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            // whoever drops it asks for no account
            let _ = thread.join();
        }
    }
}

/// A station with what it remembers.
struct Desk {
    station: Station,
    tool: Smoothing,
    felt: ForceSmoothing,
    port: PortState,
    device: Option<Vec3>,
    told: f64,
    freshness: Freshness,
    ticks: Vec<Tick>,
}

impl Desk {
    /// With nothing told yet, and room for so many moments.
    fn of(station: Station, room: usize) -> Self {
        Self {
            freshness: Freshness::new(station.period),
            tool: Smoothing::new(station.between, station.period),
            felt: ForceSmoothing::new(station.between, station.period),
            station,
            port: Port::start(),
            device: Some(Vec3::ZERO),
            told: 0.0,
            ticks: Vec::with_capacity(room),
        }
    }

    /// At the date `now`, by so many ticks after the last one, and by the clock at `clock` [s].
    fn serve(&mut self, wire: &Wire, now: f64, ticks: u32, clock: f64) {
        let Station { device, port, feels, .. } = &mut self.station;
        let elapsed = f64::from(ticks) * TICK;
        for _ in 0..ticks.min(MOST_AT_ONCE) {
            self.device = device.place();
        }
        if let Some([x, y, z, u, v, w, a, b, c, told, looked]) = wire.tool.read()
            && told != self.told
        {
            self.told = told;
            let tool = Moving { place: Vec3::new(x, y, z), velocity: Vec3::new(u, v, w) };
            self.tool.tell(told as u64, tool, now);
            self.felt.tell(told as u64, Vec3::new(a, b, c), now);
            self.freshness.tell(told, looked);
        }
        let tool = self.tool.at(now);
        let shown = match feels {
            Feels::Tool => {
                port.tick(&mut self.port, self.device, elapsed, tool);
                self.tool.periods(now)
            }
            Feels::Force => {
                port.tick_with(&mut self.port, self.device, elapsed, self.felt.at(now));
                self.felt.periods(now)
            }
        };
        device.give(self.port.force);
        self.freshness.note(shown, clock);
        let [x, y, z] = self.port.place.to_array();
        wire.device.write(&[x, y, z, f64::from(u8::from(self.device.is_some())), clock]);
        if self.ticks.len() < self.ticks.capacity() {
            let PortState { force, energy, place, .. } = self.port;
            let is_lost = self.device.is_none();
            self.ticks.push(Tick { time: now, device: place, tool: tool.place, force, energy, is_lost });
        }
    }
}

fn serve(
    stations: Vec<Station>,
    wires: &[Arc<Wire>],
    stop: &AtomicBool,
    start: Instant,
    room: usize,
) -> Served {
    let mut desks: Vec<Desk> = stations.into_iter().map(|station| Desk::of(station, room)).collect();
    // the thread ends with the loop: nobody asks for its earlier place
    let mut toll = Toll { priority: hurry(Rank::Devices).told, ..Toll::default() };
    let (mut pace, mut woken, mut dates) = (Pace::from(start, Duration::from_secs_f64(TICK)), start, 0_u64);
    while !stop.load(Ordering::Relaxed) {
        let (_, left_out) = pace.wait();
        let now = Instant::now();
        toll.periods.push((now - woken).as_secs_f64());
        toll.left_out += u64::from(left_out);
        woken = now;
        // devices and tools are shown as of the date, by however much the loop woke later: they move on together
        dates += u64::from(left_out) + 1;
        for (desk, wire) in desks.iter_mut().zip(wires) {
            desk.serve(wire, dates as f64 * TICK, left_out + 1, (now - start).as_secs_f64());
        }
        toll.busy += now.elapsed().as_secs_f64();
    }
    // the device is left without force
    for desk in &mut desks {
        desk.station.device.give(Vec3::ZERO);
    }
    let refused = desks.iter().map(|desk| desk.station.device.refused()).collect();
    let mut served = Served { toll, ticks: Vec::new(), ports: Vec::new(), refused, ages: Vec::new() };
    for desk in desks {
        served.ticks.push(desk.ticks);
        served.ports.push(desk.port);
        served.ages.push(desk.freshness.ages);
    }
    served
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::coupling::Coupling;
    /// A device that is pulled 10 mm away at once, and is lost after half of its ticks.
    struct Away {
        left: u32,
    }

    impl Device for Away {
        fn place(&mut self) -> Option<Vec3> {
            self.left = self.left.saturating_sub(1);
            (self.left > 0).then_some(Vec3::X * 0.01)
        }

        fn give(&mut self, _: Vec3) {}
    }

    fn at_a_desk(port: Port, device: Box<dyn Device>, feels: Feels) -> Station {
        Station { name: "a".to_owned(), device, port, feels, between: Between::Interpolate, period: 0.01 }
    }

    fn is_lost(service: &Service) -> bool {
        service.device(0).is_some_and(|now| now.place.is_none())
    }

    /// The loop feels the spring to a tool that rests, tells where its device is, and that it is lost, while the world says
    /// nothing at all.
    #[test]
    fn the_loop_waits_for_nobody() {
        let port = Port { coupling: Coupling::DEFAULT, passive: true };
        let station = at_a_desk(port, Box::new(Away { left: 40 }), Feels::Tool);
        let service = Service::start(vec![station], 1.0).expect("a thread");
        let (mut seen, clock) = (false, Instant::now());
        while !is_lost(&service) && clock.elapsed() < Duration::from_secs(30) {
            seen |= service.device(0).and_then(|now| now.place) == Some(Vec3::X * 0.01);
            std::thread::sleep(Duration::from_micros(200));
        }
        let served = service.end().expect("an account");
        assert!(seen && served.toll.periods.count() >= 1);
        // 400 N/m · 10 mm, once the first jump, which the damper feels too, is over
        let steady = served.ticks[0].iter().filter(|tick| (tick.force.x + 4.0).abs() < 1e-9).count();
        assert!(steady > 0, "{:?}", served.ticks[0].first());
        assert_eq!(served.ports[0].force, Vec3::ZERO);
    }

    /// A device that goes a millimetre further every tick, and keeps each place with the force that it is given there.
    struct Walking {
        ticks: u32,
        given: Arc<std::sync::Mutex<Vec<(u32, Vec3)>>>,
    }

    impl Device for Walking {
        fn place(&mut self) -> Option<Vec3> {
            self.ticks += 1;
            Some(Vec3::X * 1e-3 * f64::from(self.ticks))
        }

        fn give(&mut self, force: Vec3) {
            self.given.lock().expect("no test has failed").push((self.ticks, force));
        }
    }

    /// A device is given the force of the place that it has just told, not of the one before: that of a spring of 400 N/m to a tool that rests.
    #[test]
    fn forces_are_given_in_the_tick_that_makes_them() {
        let coupling = Coupling { damping: 0.0, ..Coupling::DEFAULT };
        let given = Arc::default();
        let device = Box::new(Walking { ticks: 0, given: Arc::clone(&given) });
        let mut desk = Desk::of(at_a_desk(Port { coupling, passive: false }, device, Feels::Tool), 10);
        let wire = Wire { device: Latest::new([0.0; 5]), tool: Latest::new([0.0; 11]) };
        for tick in 1..=10 {
            let now = f64::from(tick) * TICK;
            desk.serve(&wire, now, 1, now);
        }
        let given = given.lock().expect("no test has failed");
        assert_eq!(given.len(), 10);
        for (tick, force) in given.iter() {
            assert!((force.x + 400.0 * 1e-3 * f64::from(*tick)).abs() < 1e-12, "{given:?}");
        }
    }

    /// A device that is there and rests, until it is taken away.
    struct Resting {
        is_away: Arc<AtomicBool>,
    }

    impl Device for Resting {
        fn place(&mut self) -> Option<Vec3> {
            (!self.is_away.load(Ordering::Relaxed)).then_some(Vec3::ZERO)
        }

        fn give(&mut self, _: Vec3) {}
    }

    /// Calls until a condition holds.
    fn until(mut holds: impl FnMut() -> bool) {
        let clock = Instant::now();
        while !holds() {
            assert!(clock.elapsed() < Duration::from_secs(30));
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    /// The device feels the force that the world tells, and not where the tool is: none before the first, the whole of it while it is told,
    /// none as soon as the device is lost.
    #[test]
    fn held_points_are_felt() {
        let port = Port { coupling: Coupling::DEFAULT, passive: true };
        let is_away = Arc::new(AtomicBool::new(false));
        let device = Box::new(Resting { is_away: is_away.clone() });
        let mut service =
            Service::start(vec![at_a_desk(port, device, Feels::Force)], 30.0).expect("a thread");
        let tool = Moving { place: Vec3::X, velocity: Vec3::ZERO };
        let (felt, clock) = (Vec3::new(0.3, 0.0, -0.4), Instant::now());
        until(|| {
            service.tell(std::iter::once(Told { tool, felt, looked: 0.0 }));
            clock.elapsed() > Duration::from_millis(100)
        });
        is_away.store(true, Ordering::Relaxed);
        until(|| is_lost(&service));
        let served = service.end().expect("an account");
        let forces: Vec<Vec3> = served.ticks[0].iter().map(|tick| tick.force).collect();
        assert!(
            forces.iter().all(|force| force.cross(felt).length() < 1e-12 && force.length() < 0.5 + 1e-12)
        );
        // each thing that is told takes from what lacks its part of a period: e⁻¹⁰ is left after ten periods, of which the loop may sleep one
        assert!(forces.iter().any(|force| (*force - felt).length() < 0.5 * f64::exp(-9.0)), "{forces:?}");
        assert_eq!(served.ports[0].force, Vec3::ZERO);
    }
}
