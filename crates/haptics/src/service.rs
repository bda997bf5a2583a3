//! The loop at the devices: a thread of its own, a thousand times a second, that waits for nobody.
//!
//! It tells the world where devices are and hears from it where tools are, by numbers that lie ready ([`Latest`]). A world that
//! is late, or has ended, leaves the hand with a spring to where the tool was last.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use souple_math::Vec3;

use crate::TICK;
use crate::coupling::Moving;
use crate::device::Device;
use crate::exchange::Latest;
use crate::pace::{Histogram, Pace, hurry};
use crate::port::{Port, PortState};
use crate::smoothing::Smoothing;

/// A hand that is served.
pub struct Station {
    pub name: String,
    pub device: Box<dyn Device>,
    pub port: Port,
    pub smoothing: Smoothing,
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
}

/// Where a device is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DeviceNow {
    /// From where it started [m].
    At(Vec3),
    Lost,
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
}

/// The loop cannot be.
#[derive(Debug, thiserror::Error)]
#[error("no thread for the loop of the devices: {0}")]
pub struct ServiceError(#[from] std::io::Error);

/// Numbers between the loop and the world, of one hand.
#[derive(Debug)]
struct Wire {
    /// Place, and 1 where it is there.
    device: Latest<4>,
    /// Place, velocity, and how often it was told.
    tool: Latest<7>,
}

/// The loop at work.
pub struct Service {
    wires: Vec<Arc<Wire>>,
    told: f64,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<Served>>,
}

/// Ticks that an emulated person lives through at most when the loop wakes too late.
const MOST_AT_ONCE: u32 = 1000;

impl Service {
    /// Starts serving; moments are kept for `duration` seconds.
    ///
    /// # Errors
    /// The system gives no thread.
    pub fn start(stations: Vec<Station>, duration: f64) -> Result<Self, ServiceError> {
        let wire = |_: &Station| {
            Arc::new(Wire { device: Latest::new([0.0, 0.0, 0.0, 1.0]), tool: Latest::new([0.0; 7]) })
        };
        let wires: Vec<Arc<Wire>> = stations.iter().map(wire).collect();
        let stop = Arc::new(AtomicBool::new(false));
        let (of_loop, end) = (wires.clone(), stop.clone());
        let room = (duration / TICK).ceil().clamp(0.0, 1e7) as usize;
        let thread = std::thread::Builder::new()
            .name("devices".to_owned())
            .spawn(move || serve(stations, &of_loop, &end, room))?;
        Ok(Self { wires, told: 0.0, stop, thread: Some(thread) })
    }

    /// Where the device of a hand is; `None` where that cannot be told just now.
    pub fn device(&self, hand: usize) -> Option<DeviceNow> {
        let [x, y, z, is_there] = self.wires[hand].device.read()?;
        Some(if is_there == 1.0 { DeviceNow::At(Vec3::new(x, y, z)) } else { DeviceNow::Lost })
    }

    /// The world tells where all tools are.
    pub fn tell(&mut self, tools: impl Iterator<Item = Moving>) {
        self.told += 1.0;
        for (wire, Moving { place, velocity }) in self.wires.iter().zip(tools) {
            let ([x, y, z], [u, v, w]) = (place.to_array(), velocity.to_array());
            wire.tool.write(&[x, y, z, u, v, w, self.told]);
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
    port: PortState,
    device: Option<Vec3>,
    told: f64,
    ticks: Vec<Tick>,
}

impl Desk {
    fn serve(&mut self, wire: &Wire, now: f64, ticks: u32) {
        let Station { device, port, smoothing, .. } = &mut self.station;
        for _ in 0..ticks.min(MOST_AT_ONCE) {
            self.device = device.exchange(self.port.force);
        }
        if let Some([x, y, z, u, v, w, told]) = wire.tool.read()
            && told != self.told
        {
            self.told = told;
            smoothing.tell(Moving { place: Vec3::new(x, y, z), velocity: Vec3::new(u, v, w) }, now);
        }
        let tool = smoothing.at(now);
        port.tick(&mut self.port, self.device, tool);
        let [x, y, z] = self.port.place.to_array();
        wire.device.write(&[x, y, z, f64::from(u8::from(self.device.is_some()))]);
        if self.ticks.len() < self.ticks.capacity() {
            let PortState { force, energy, place, .. } = self.port;
            self.ticks.push(Tick { time: now, device: place, tool: tool.place, force, energy });
        }
    }
}

fn serve(stations: Vec<Station>, wires: &[Arc<Wire>], stop: &AtomicBool, room: usize) -> Served {
    let desk = |station: Station| Desk {
        station,
        port: Port::start(),
        device: Some(Vec3::ZERO),
        told: 0.0,
        ticks: Vec::with_capacity(room),
    };
    let mut desks: Vec<Desk> = stations.into_iter().map(desk).collect();
    let mut toll = Toll { priority: hurry(), ..Toll::default() };
    let start = Instant::now();
    let (mut pace, mut woken) = (Pace::new(Duration::from_secs_f64(TICK)), start);
    while !stop.load(Ordering::Relaxed) {
        let (_, left_out) = pace.wait();
        let now = Instant::now();
        toll.periods.push((now - woken).as_secs_f64());
        toll.left_out += u64::from(left_out);
        woken = now;
        for (desk, wire) in desks.iter_mut().zip(wires) {
            desk.serve(wire, (now - start).as_secs_f64(), left_out + 1);
        }
        toll.busy += now.elapsed().as_secs_f64();
    }
    // the device is left without force
    for desk in &mut desks {
        let _ = desk.station.device.exchange(Vec3::ZERO);
    }
    let refused = desks.iter().map(|desk| desk.station.device.refused()).collect();
    let (ticks, ports) = desks.into_iter().map(|desk| (desk.ticks, desk.port)).unzip();
    Served { toll, ticks, ports, refused }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::coupling::Coupling;
    use crate::smoothing::Between;

    /// A device that is pulled 10 mm away at once, and is lost after half of its ticks.
    struct Away {
        left: u32,
    }

    impl Device for Away {
        fn exchange(&mut self, _: Vec3) -> Option<Vec3> {
            self.left = self.left.saturating_sub(1);
            (self.left > 0).then_some(Vec3::X * 0.01)
        }
    }

    /// The loop feels the spring to a tool that rests, tells where its device is, and that it is lost, while the world says
    /// nothing at all.
    #[test]
    fn the_loop_waits_for_nobody() {
        let port = Port { coupling: Coupling::DEFAULT, passive: true };
        let smoothing = Smoothing::new(Between::Interpolate, 0.01);
        let station = Station { name: "a".to_owned(), device: Box::new(Away { left: 40 }), port, smoothing };
        let service = Service::start(vec![station], 1.0).expect("a thread");
        let (mut seen, clock) = (false, Instant::now());
        while service.device(0) != Some(DeviceNow::Lost) && clock.elapsed() < Duration::from_secs(30) {
            seen |= service.device(0) == Some(DeviceNow::At(Vec3::X * 0.01));
            std::thread::sleep(Duration::from_micros(200));
        }
        let served = service.end().expect("an account");
        assert!(seen && served.toll.periods.count() >= 1);
        // 400 N/m · 10 mm, once the first jump, which the damper feels too, is over
        let steady = served.ticks[0].iter().filter(|tick| (tick.force.x + 4.0).abs() < 1e-9).count();
        assert!(steady > 0, "{:?}", served.ticks[0].first());
        assert_eq!(served.ports[0].force, Vec3::ZERO);
    }
}
