//! A thousand times a second: waking in time, and an account of how well that went.

use std::time::{Duration, Instant};

use crate::TICK;

/// Wakes at even times.
#[derive(Debug)]
pub struct Pace {
    period: Duration,
    next: Instant,
    awake: Awake,
}

/// The end of a wait that is spent awake, since sleeping ends late: as long as all sleeps but few of this machine are late, which
/// is learnt from one to the next, as a quantile `m` of their lateness `l`: `m <- m + GAIN (SHARE - [l <= m])`.
#[derive(Debug)]
struct Awake(Duration);

/// Of sleeps that end while there is time.
const SHARE: f64 = 0.9995;
/// What the wait is longer by, nearly, for a sleep that ended too late.
const GAIN: Duration = Duration::from_micros(100);
/// At least, as most sleeps are late by half of it; and at most, so that others have the processor for more than half of the time.
const LEAST_AWAKE: Duration = Duration::from_micros(80);
const MOST_AWAKE: Duration = Duration::from_micros(400);

impl Awake {
    /// Takes note of how late a sleep has ended.
    fn learn(&mut self, late: Duration) {
        let is_within = late <= self.0;
        let wanted = if is_within {
            self.0.saturating_sub(GAIN.mul_f64(1.0 - SHARE))
        } else {
            self.0 + GAIN.mul_f64(SHARE)
        };
        self.0 = wanted.clamp(LEAST_AWAKE, MOST_AWAKE);
    }
}

/// A tick that begins so much too late leaves those out that it has missed.
const GIVEN_UP: u32 = 3;

impl Pace {
    pub fn new(period: Duration) -> Self {
        Self::from(Instant::now(), period)
    }

    /// Wakes at `start` and so many periods.
    pub fn from(start: Instant, period: Duration) -> Self {
        Self { period, next: start + period, awake: Awake(LEAST_AWAKE) }
    }

    /// Waits for the next date; how late it is, and how many dates were left out before it.
    pub fn wait(&mut self) -> (Duration, u32) {
        loop {
            let now = Instant::now();
            let left = self.next.saturating_duration_since(now);
            if left > self.awake.0 {
                let sleep = left - self.awake.0;
                std::thread::sleep(sleep);
                self.awake.learn(now.elapsed().saturating_sub(sleep));
            } else if left.is_zero() {
                break;
            } else {
                std::hint::spin_loop();
            }
        }
        let late = self.next.elapsed();
        let missed = u32::try_from(late.as_nanos() / self.period.as_nanos().max(1)).unwrap_or(u32::MAX);
        let left_out = if missed >= GIVEN_UP { missed } else { 0 };
        self.next += self.period * (left_out + 1);
        (late, left_out)
    }
}

/// Of threads that have a date to keep, the one that stands before the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rank {
    /// The loop at the devices, which never works for long.
    Devices,
    /// The world, which may be behind, and then has all the time that devices leave.
    World,
}

impl Rank {
    /// Of real-time threads, of which the system's own stand higher.
    fn priority(self) -> i32 {
        match self {
            Self::Devices => 80,
            Self::World => 40,
        }
    }
}

/// What came of the wish for priority of a thread.
#[derive(Clone, Debug)]
pub struct Hurry {
    /// In words.
    pub told: String,
    earlier: Earlier,
}

impl Hurry {
    /// Puts this thread, which must be the one that hurried, where it was before.
    pub fn step_back(&self) {
        self.earlier.restore();
    }
}

/// Puts this thread before others of the machine where the system allows it.
pub fn hurry(rank: Rank) -> Hurry {
    let (has_hurried, earlier) = hurried(rank.priority());
    let told = if has_hurried {
        format!("real-time priority {}", rank.priority())
    } else {
        let held_up = match rank {
            Rank::Devices => "the loop",
            Rank::World => "the world",
        };
        format!("no real-time priority: the system refuses it, and other programs may delay {held_up}")
    };
    Hurry { told, earlier }
}

/// How a thread stood before it hurried.
#[cfg(target_os = "linux")]
#[derive(Clone, Copy, Debug)]
struct Earlier {
    /// By how much its sleeps may end later than asked for [ns].
    slack: libc::c_int,
    /// Policy and priority; `None` where they were not changed.
    place: Option<(libc::c_int, libc::c_int)>,
}

#[cfg(target_os = "linux")]
fn hurried(priority: i32) -> (bool, Earlier) {
    // SAFETY: plain calls about the calling thread, with structures made here that live through them.
    unsafe {
        let slack = libc::prctl(libc::PR_GET_TIMERSLACK);
        // sleeps end when they are due, not when it suits the system
        libc::prctl(libc::PR_SET_TIMERSLACK, 1);
        let (mut policy, mut before) = (libc::SCHED_OTHER, libc::sched_param { sched_priority: 0 });
        let is_known = libc::pthread_getschedparam(libc::pthread_self(), &mut policy, &mut before) == 0;
        let wanted = libc::sched_param { sched_priority: priority };
        // what cannot be put back is not changed
        let has_hurried =
            is_known && libc::pthread_setschedparam(libc::pthread_self(), libc::SCHED_FIFO, &wanted) == 0;
        (has_hurried, Earlier { slack, place: has_hurried.then_some((policy, before.sched_priority)) })
    }
}

#[cfg(target_os = "linux")]
impl Earlier {
    fn restore(&self) {
        // SAFETY: plain calls about the calling thread, with a structure made here that lives through them.
        unsafe {
            if let Some((policy, sched_priority)) = self.place {
                libc::pthread_setschedparam(
                    libc::pthread_self(),
                    policy,
                    &libc::sched_param { sched_priority },
                );
            }
            // real-time threads have no slack, and that of others begins anew with their policy; 0, where none could be read, is what it began with
            libc::prctl(libc::PR_SET_TIMERSLACK, self.slack.max(0));
        }
    }
}

#[cfg(not(target_os = "linux"))]
#[derive(Clone, Copy, Debug)]
struct Earlier;

#[cfg(not(target_os = "linux"))]
fn hurried(_: i32) -> (bool, Earlier) {
    (false, Earlier)
}

#[cfg(not(target_os = "linux"))]
impl Earlier {
    fn restore(&self) {}
}

/// How long periods were, in bins of ten microseconds.
#[derive(Clone, Debug)]
pub struct Histogram {
    bins: Vec<u64>,
    /// Longer than the last bin.
    beyond: u64,
    longest: f64,
    sum: f64,
}

/// Width of a bin [s].
const BIN: f64 = 10e-6;
/// What is longer is counted together [s].
const SPAN: f64 = 50.0 * TICK;

impl Default for Histogram {
    fn default() -> Self {
        Self { bins: vec![0; (SPAN / BIN).round() as usize], beyond: 0, longest: 0.0, sum: 0.0 }
    }
}

impl Histogram {
    /// Notes a period [s].
    pub fn push(&mut self, seconds: f64) {
        match self.bins.get_mut((seconds / BIN) as usize) {
            Some(bin) => *bin += 1,
            None => self.beyond += 1,
        }
        self.longest = self.longest.max(seconds);
        self.sum += seconds;
    }

    pub fn count(&self) -> u64 {
        self.bins.iter().sum::<u64>() + self.beyond
    }

    pub fn longest(&self) -> f64 {
        self.longest
    }

    pub fn mean(&self) -> f64 {
        self.sum / self.count().max(1) as f64
    }

    /// The share of periods no longer than this, to a bin.
    pub fn share_within(&self, seconds: f64) -> f64 {
        let last = (seconds / BIN).round() as usize;
        self.bins.iter().take(last).sum::<u64>() as f64 / self.count().max(1) as f64
    }

    /// The length that this share of the periods does not exceed [s], to a bin; the longest of all beyond the bins.
    pub fn quantile(&self, share: f64) -> f64 {
        let wanted = (share * self.count() as f64).ceil() as u64;
        let mut seen = 0;
        for (bin, count) in self.bins.iter().enumerate() {
            seen += count;
            if seen >= wanted.max(1) {
                return ((bin + 1) as f64 * BIN).min(self.longest);
            }
        }
        self.longest
    }

    /// How far from `wanted` this share of the periods is at most, either way [s], to a bin; of those beyond the bins the longest counts.
    pub fn jitter(&self, wanted: f64, share: f64) -> f64 {
        let of_bin = |(bin, count): (usize, &u64)| {
            let (low, high) = (bin as f64 * BIN, (bin + 1) as f64 * BIN);
            // to its farther end, but that of no period is beyond the longest
            ((wanted - low).max(high.min(self.longest) - wanted), *count)
        };
        let mut all: Vec<(f64, u64)> = self.bins.iter().enumerate().map(of_bin).collect();
        all.push((self.longest - wanted, self.beyond));
        all.retain(|(_, count)| *count > 0);
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let needed = ((share * self.count() as f64).ceil() as u64).max(1);
        let mut seen = 0;
        for (off, count) in &all {
            seen += count;
            if seen >= needed {
                return *off;
            }
        }
        0.0
    }

    /// Upper ends of bins that are not empty [s], and their counts.
    pub fn bins(&self) -> Vec<(f64, u64)> {
        let filled = self.bins.iter().enumerate().filter(|(_, count)| **count > 0);
        let filled = filled.map(|(bin, count)| ((bin + 1) as f64 * BIN, *count));
        filled.chain((self.beyond > 0).then_some((self.longest, self.beyond))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Quantiles and shares of known periods, to a bin.
    #[test]
    fn periods_are_counted() {
        let mut histogram = Histogram::default();
        (0..999).for_each(|_| histogram.push(1.004e-3));
        histogram.push(75e-3);
        assert_eq!((histogram.count(), histogram.longest()), (1000, 75e-3));
        assert!((histogram.quantile(0.999) - 1.01e-3).abs() < 1e-12);
        assert_eq!(histogram.quantile(1.0), 75e-3);
        assert!((histogram.share_within(1.2e-3) - 0.999).abs() < 1e-12);
        assert_eq!(histogram.share_within(1.0e-3), 0.0);
        assert!((histogram.jitter(1e-3, 0.999) - 10e-6).abs() < 1e-12);
        assert!((histogram.jitter(1e-3, 1.0) - 74e-3).abs() < 1e-12);
        // a period of 0.5 ms is half a millisecond off, with a bin below it
        histogram.push(0.504e-3);
        assert!((histogram.jitter(1e-3, 0.999) - 0.5e-3).abs() < 1e-12);
        assert_eq!(histogram.bins().iter().map(|(_, count)| count).sum::<u64>(), 1001);
    }

    /// Where one sleep of a thousand is late, and one in ten thousand later still, waits are awake for the first but not for the other; where
    /// none is, they soon are so no more.
    #[test]
    fn waits_are_awake_for_all_sleeps_but_few() {
        let mut awake = Awake(LEAST_AWAKE);
        let late = |tick: u32| match tick {
            _ if tick.is_multiple_of(10_000) => Duration::from_micros(350),
            _ if tick.is_multiple_of(1_000) => Duration::from_micros(150),
            _ => Duration::from_micros(20),
        };
        let mut exceeded = 0;
        for tick in 1..=100_000 {
            exceeded += u32::from(late(tick) > awake.0);
            awake.learn(late(tick));
        }
        // the mean of a bounded sum: 100,000 (1 - SHARE) of them, and the span of the estimate over the gain
        assert!(exceeded <= 50 + 4, "{exceeded}");
        // back by GAIN (1 - SHARE) = 50 ns a tick
        (0..6_400).for_each(|_| awake.learn(Duration::ZERO));
        assert_eq!(awake.0, LEAST_AWAKE);
    }

    /// A thread that has hurried, or was refused, stands afterwards where it stood before.
    #[cfg(target_os = "linux")]
    #[test]
    fn threads_step_back_to_where_they_were() {
        let stands = || {
            let mut parameters = libc::sched_param { sched_priority: 0 };
            let mut policy = -1;
            // SAFETY: plain calls about the calling thread, with structures made here that live through them.
            let slack = unsafe {
                libc::pthread_getschedparam(libc::pthread_self(), &mut policy, &mut parameters);
                libc::prctl(libc::PR_GET_TIMERSLACK)
            };
            (policy, parameters.sched_priority, slack)
        };
        // SAFETY: a plain call about the calling thread.
        unsafe { libc::prctl(libc::PR_SET_TIMERSLACK, 70_000) };
        let before = stands();
        let outer = hurry(Rank::World);
        let between = stands();
        let inner = hurry(Rank::Devices);
        inner.step_back();
        assert_eq!(stands(), between);
        outer.step_back();
        assert_eq!(stands(), before);
    }

    /// No date comes too soon, and dates do not drift: after `n` waits `n` periods have passed, whatever each took.
    #[test]
    fn dates_do_not_drift() {
        let (start, mut pace) = (Instant::now(), Pace::new(Duration::from_millis(2)));
        let mut dates = 0;
        for _ in 0..20 {
            dates += 1 + pace.wait().1;
            assert!(start.elapsed() >= Duration::from_millis(2) * dates.min(20));
        }
    }
}
