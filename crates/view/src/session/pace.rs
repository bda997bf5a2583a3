//! Real time: when the next period is due, and how fast the world really goes.

use std::time::{Duration, Instant};

/// A clock that the world follows.
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    /// Simulated seconds per second that are wished for.
    speed: f64,
    /// A moment, and the simulated time of it [s].
    anchor: (Instant, f64),
    /// The same, where the present measurement began.
    window: (Instant, f64),
    latest: f64,
    /// Simulated seconds per second that were had in the last whole window.
    measured: Option<f64>,
}

/// Lateness after which the clock is set anew: a world too slow for real time does not hurry afterwards.
const LATE: Duration = Duration::from_millis(100);
/// Over how long the real-time factor is measured.
const WINDOW: Duration = Duration::from_millis(500);

impl Pace {
    pub fn new(now: Instant) -> Self {
        Self { speed: 1.0, anchor: (now, 0.0), window: (now, 0.0), latest: 0.0, measured: None }
    }

    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// Goes on from a simulated time [s].
    pub fn start(&mut self, now: Instant, time: f64) {
        self.anchor = (now, time);
        self.window = (now, time);
        self.latest = time;
        self.measured = None;
    }

    pub fn set_speed(&mut self, speed: f64, now: Instant, time: f64) {
        self.speed = speed;
        self.start(now, time);
    }

    /// When a simulated time [s] is to be reached.
    pub fn due(&self, time: f64) -> Instant {
        let (moment, start) = self.anchor;
        moment + Duration::from_secs_f64(((time - start) / self.speed).clamp(0.0, 1e6))
    }

    /// Work over the time that there is for a period of the world [s] at the wished speed.
    pub fn load(&self, worked: Duration, period: f64) -> f64 {
        worked.as_secs_f64() * self.speed / period
    }

    /// A step has reached a simulated time [s].
    pub fn stepped(&mut self, now: Instant, time: f64) {
        self.latest = time;
        if now.saturating_duration_since(self.due(time)) > LATE {
            self.anchor = (now, time);
        }
        let (start, from) = self.window;
        let wall = now.saturating_duration_since(start);
        if wall >= WINDOW {
            self.measured = Some((time - from) / wall.as_secs_f64());
            self.window = (now, time);
        }
    }

    /// Simulated seconds per second, as measured.
    pub fn factor(&self, now: Instant) -> f64 {
        let (start, from) = self.window;
        let wall = now.saturating_duration_since(start).as_secs_f64().max(1e-3);
        // a step that lasts longer than the window is no standstill
        self.measured.unwrap_or((self.latest - from) / wall)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Periods are due in real time at the wished speed; a world that cannot keep up is not chased.
    #[test]
    fn periods_are_due_in_real_time() {
        let start = Instant::now();
        let mut pace = Pace::new(start);
        pace.set_speed(0.5, start, 0.0);
        let after = |seconds: f64| start + Duration::from_secs_f64(seconds);
        assert_eq!(pace.due(0.01), after(0.02));
        // half of the 20 ms that there are for a period of 10 ms
        assert!((pace.load(Duration::from_millis(10), 0.01) - 0.5).abs() < 1e-12);
        // in time
        pace.stepped(after(0.02), 0.01);
        assert_eq!(pace.due(0.02), after(0.04));
        // far too late: from here on as if nothing had happened
        pace.stepped(after(1.0), 0.02);
        assert_eq!(pace.due(0.03), after(1.02));
        assert!((pace.factor(after(1.0)) - 0.02).abs() < 1e-9);
    }
}
