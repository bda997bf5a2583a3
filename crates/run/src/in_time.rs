//! A world in true real time under hands: one second on the clock is one second of the world.
//!
//! The loop of the devices has a thread of its own ([`Service`]); the world steps in this one, a period after the other, each
//! begun when its time has come. Devices come in as recorded edits, and so does what the clock decides (the budget of bodies
//! with levels): a recording replays without a clock. While a period is computed, the person feels the one before.

use std::time::{Duration, Instant};

use souple_engine::{Edit, EditError, StageTimes};
use souple_haptics::{
    DeviceNow, Feels, Histogram, Hurry, Moving, Rank, Served, Service, ServiceError, Station, TICK, Told,
    hurry,
};

use crate::{Control, Governor, Progress, Session, Stepped, Trace};

/// How the world kept its time.
#[derive(Clone, Debug, Default)]
pub struct WorldToll {
    pub periods: u64,
    /// Time of computing over time of the world, of each period.
    pub loads: Vec<f64>,
    /// Periods that were not ready in time.
    pub late: u64,
    /// Time that was given up because the world could not catch up [s].
    pub lost: f64,
    /// Clock less world at the end, what was given up left out [s].
    pub drift: f64,
    /// Budgets that the clock has set.
    pub budgets: u64,
    /// What its periods took by stages.
    pub stages: StageTimes,
    /// How long periods took from beginning to beginning.
    pub begun: Histogram,
    /// What came of the wish for priority.
    pub priority: String,
    /// Probes are read after so much time of the world, and at its end [s].
    pub between_measures: f64,
}

/// What a run in time was.
pub struct InTime {
    pub world: WorldToll,
    pub served: Served,
    pub traces: Vec<Trace>,
    /// It was stopped before its end.
    pub was_stopped: bool,
}

/// Why there is no run in time.
#[derive(Debug, thiserror::Error)]
pub enum TimeError {
    #[error(
        "the scene has no hand; it needs [hands.NAME], as `scenes/hand_on_liver` has one: its organ is pressed by a hand"
    )]
    NoHand,
    #[error("the device of hand `{hand}`: {why}")]
    Device { hand: String, why: String },
    #[error(transparent)]
    Service(#[from] ServiceError),
    #[error("hand `{hand}`: {error}")]
    Edit { hand: String, error: EditError },
    #[error("the loop of the devices has ended by a fault of the program")]
    Lost,
}

/// A world that is behind by more periods gives up catching up.
const CATCHING_UP: f64 = 3.0;
/// Of a tick, and of a period.
const ROUNDING: f64 = 1e-6;
/// Probes are read no more often [s]: they are for people and files, and may cost more than a short period.
const MEASURED: f64 = 0.01;

/// The threads of the world before those of other programs, until it is dropped; then each is where it was.
struct Hurried {
    world: Hurry,
    /// By their numbers.
    pool: Vec<Hurry>,
}

impl Hurried {
    fn new() -> Self {
        Self { world: hurry(Rank::World), pool: rayon::broadcast(|_| hurry(Rank::World)) }
    }
}

impl Drop for Hurried {
    fn drop(&mut self) {
        self.world.step_back();
        rayon::broadcast(|thread| self.pool[thread.index()].step_back());
    }
}

/// Probes are read after so many periods, and after the last one.
fn periods_between_measures(period: f64) -> u64 {
    (MEASURED / period - ROUNDING).ceil().max(1.0) as u64
}

/// When periods are due, by a clock that counts seconds from the beginning of a run.
#[derive(Clone, Copy, Debug, Default)]
struct Dates {
    /// Of the world [s].
    period: f64,
    /// When the first period began, later by what was given up [s].
    start: f64,
    late: u64,
    lost: f64,
}

impl Dates {
    /// Period `step`, counted from 1, is ready at `now`: how long the next one is to wait [s].
    fn ready(&mut self, step: u64, now: f64) -> f64 {
        let left = self.start + step as f64 * self.period - now;
        if left > 0.0 {
            return left;
        }
        self.late += 1;
        if -left <= CATCHING_UP * self.period {
            return 0.0;
        }
        // in whole ticks of the devices, of which each period begins just after one
        let lost = (-left / TICK - ROUNDING).ceil() * TICK;
        self.lost += lost;
        self.start += lost;
        (left + lost).max(0.0)
    }

    /// Clock less world after so many periods, what was given up left out [s].
    fn drift(&self, periods: u64, now: f64) -> f64 {
        now - self.start - periods as f64 * self.period
    }
}

/// Steps a world for `duration` seconds of the clock.
///
/// # Errors
/// It has no hands, or their devices are not there. A step that is refused ends the run; the session tells of it.
pub fn run_in_time(
    session: &mut Session,
    duration: f64,
    watch: &mut dyn FnMut(&Progress) -> Control,
) -> Result<InTime, TimeError> {
    let period = session.world.model().period;
    let steps = (duration / period).round().max(1.0) as u64;
    let mut service = Service::start(stations(session, period)?, duration)?;
    let mut toll =
        WorldToll { loads: Vec::with_capacity(steps.min(1 << 24) as usize), ..WorldToll::default() };
    let mut traces: Vec<Trace> = session.probes.iter().map(Trace::new).collect();
    session.measure(&mut |probe, time, value| traces[probe].push(time, value));
    let mut governor = Governor::new(session.world.model());
    let mut leads = vec![Lead { is_held: true, looked: 0.0 }; session.hands.len()];
    let hurried = Hurried::new();
    toll.priority.clone_from(&hurried.world.told);
    let (between_measures, mut measured) = (periods_between_measures(period), 0);
    toll.between_measures = between_measures as f64 * period;
    // dates are counted from this one, however late the sleep ends
    let began = service.next_served();
    std::thread::sleep(began.saturating_duration_since(Instant::now()));
    let stages = session.world.stages();
    let (mut dates, mut begun) = (Dates { period, ..Dates::default() }, began);
    let mut was_stopped = false;
    for step in 1..=steps {
        // a world that is slower than the clock makes fewer periods, and no longer run
        if began.elapsed().as_secs_f64() >= duration {
            break;
        }
        let clock = Instant::now();
        if step > 1 {
            toll.begun.push((clock - begun).as_secs_f64());
        }
        begun = clock;
        lead(session, &service, &mut leads)?;
        let stepped = session.step();
        if stepped != Stepped::On {
            was_stopped = stepped == Stepped::BrokenOff;
            break;
        }
        service.tell(session.hands.iter().zip(&leads).map(|(hand, lead)| {
            let in_hand = hand.of(&session.world);
            let tool = Moving { place: in_hand.tool, velocity: in_hand.tool_velocity };
            Told { tool, felt: in_hand.felt, looked: lead.looked }
        }));
        if step.is_multiple_of(between_measures) {
            session.measure(&mut |probe, time, value| traces[probe].push(time, value));
            measured = step;
        }
        toll.periods = step;
        let load = clock.elapsed().as_secs_f64() / period;
        toll.loads.push(load);
        toll.budgets += governor.after(session, load);
        let left = dates.ready(step, began.elapsed().as_secs_f64());
        if left > 0.0 {
            std::thread::sleep(Duration::from_secs_f64(left));
        }
        let wall_seconds = began.elapsed().as_secs_f64();
        let progress = Progress { step, steps, simulated_seconds: step as f64 * period, wall_seconds };
        if watch(&progress) == Control::Stop {
            was_stopped = step < steps;
            break;
        }
    }
    (toll.late, toll.lost) = (dates.late, dates.lost);
    toll.stages = session.world.stages() - stages;
    toll.drift = dates.drift(toll.periods, began.elapsed().as_secs_f64());
    let served = service.end().ok_or(TimeError::Lost)?;
    drop(hurried);
    if measured < toll.periods {
        // how it ended
        session.measure(&mut |probe, time, value| traces[probe].push(time, value));
    }
    Ok(InTime { world: toll, served, traces, was_stopped })
}

fn stations(session: &Session, period: f64) -> Result<Vec<Station>, TimeError> {
    if session.hands.is_empty() {
        return Err(TimeError::NoHand);
    }
    let station = |hand: &souple_scene::HandInfo| {
        let forces = &session.world.model().systems[hand.system].forces;
        let is_holding = forces.iter().any(|force| force.name() == hand.force && force.holding().is_some());
        let feels = if is_holding { Feels::Force } else { Feels::Tool };
        let device = hand.device.open();
        let device = device.map_err(|why| TimeError::Device { hand: hand.name.clone(), why })?;
        Ok(Station { name: hand.name.clone(), device, port: hand.port, feels, between: hand.between, period })
    };
    session.hands.iter().map(station).collect()
}

/// How a device leads its tool.
#[derive(Clone, Copy, Debug)]
struct Lead {
    is_held: bool,
    /// When it was where its tool is led to, by the clock of the devices [s].
    looked: f64,
}

/// Devices lead their tools for a period.
fn lead(session: &mut Session, service: &Service, leads: &mut [Lead]) -> Result<(), TimeError> {
    for (hand, lead) in leads.iter_mut().enumerate() {
        // a device that cannot be told just now stays where it was
        let Some(device) = service.device(hand) else { continue };
        let (system, force) = (session.hands[hand].system, session.hands[hand].force.clone());
        let DeviceNow { place, date } = device;
        let is_held = place.is_some();
        lead.looked = date;
        let mut edits = Vec::new();
        if let Some(place) = place {
            edits.push(Edit::Lead { system, force: force.clone(), place });
        }
        if std::mem::replace(&mut lead.is_held, is_held) != is_held {
            let value = f64::from(u8::from(is_held));
            edits.push(Edit::SetParameter { system, force, parameter: "held".to_owned(), value });
        }
        for edit in edits {
            let error = |error| TimeError::Edit { hand: session.hands[hand].name.clone(), error };
            session.world.edit(edit).map_err(error)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::governor::{FULL, ruled};

    /// The rule of V-36, not a machine, through ten minutes of a given clock: a body wants a fifth more than can be done in a period, the time
    /// is in proportion to the budget, and once a minute the machine is held up for two fifths of a period. The budget comes down to a load of
    /// 95 % and stays, the world is never a frame behind, and fewer than one frame in a thousand is late.
    #[test]
    fn ten_minutes_of_a_given_clock() {
        let (period, steps, most) = (0.01, 60_000_u64, 1.2);
        let mut dates = Dates { period, ..Dates::default() };
        let (mut now, mut budget, mut full, mut greatest) = (0.0, most, 0, 0.0_f64);
        for step in 1..=steps {
            // subdivided up to 95 % of the budget, see `LevelsForce`
            let load = FULL * budget;
            let held_up = if step % 6000 == 0 { 0.4 * period } else { 0.0 };
            now += load * period + held_up;
            now += dates.ready(step, now);
            full += u64::from(load > FULL);
            budget = ruled(budget, most, load);
            greatest = greatest.max(dates.drift(step, now));
        }
        // loads of 1.14 and 1.026, and then one of 0.923
        assert_eq!(full, 2);
        assert!(FULL * budget <= FULL);
        assert!(greatest < period, "{greatest}");
        // held up in the last one too: late by two fifths of a period less what a load of 0.923 leaves
        assert!((dates.drift(steps, now) - (0.4 - (1.0 - 0.9234)) * period).abs() < 1e-6);
        assert!((dates.late as f64) < 1e-3 * steps as f64, "{}", dates.late);
        assert_eq!(dates.lost, 0.0);
    }

    /// Probes are read after whole periods, no more often than once in ten milliseconds.
    #[test]
    fn probes_are_read_seldom() {
        let read = [1e-3, 2e-3, 3e-3, 4e-3, 7e-3, 10e-3, 0.02].map(periods_between_measures);
        assert_eq!(read, [10, 5, 4, 3, 2, 1, 1]);
    }

    /// A machine that stands still for a second gives that second up, and is in time again with the next period.
    #[test]
    fn what_cannot_be_caught_up_is_given_up() {
        let mut dates = Dates { period: 0.01, ..Dates::default() };
        assert!(dates.ready(1, 0.004) > 0.0);
        assert_eq!(dates.ready(2, 1.02), 0.0);
        assert!((dates.lost - 1.0).abs() < 1e-12 && dates.drift(2, 1.02).abs() < 1e-12);
        assert!((dates.ready(3, 1.025) - 0.005).abs() < 1e-12);
        assert_eq!(dates.late, 1);
    }
}
