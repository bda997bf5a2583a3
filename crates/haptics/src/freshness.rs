//! How old a force is: what it says of the body, and where the device was to which it answers.

use crate::TICK;
use crate::pace::Histogram;

/// Ages of the forces that a device is given.
///
/// The world is led by where devices were at a date `r_n`, and lives through its period `n` from there: the end of that period is of the date
/// `r_n + P`. What is shown of a time between two ends is of a date between theirs.
#[derive(Clone, Debug)]
pub struct Freshness {
    /// Of the world [s].
    period: f64,
    /// Periods that were told, and when devices were looked at before them [s]; oldest first.
    told: [(f64, f64); KEPT],
    pub ages: Ages,
}

/// Of one hand.
#[derive(Clone, Debug, Default)]
pub struct Ages {
    /// Of what a force says of the body when the next one takes its place.
    pub of_body: Histogram,
    /// From a place of the device to the force that answers to it.
    pub of_answer: Histogram,
}

/// As many as a way of a tool has (see [`crate::Smoothing`]).
const KEPT: usize = 16;

impl Freshness {
    pub fn new(period: f64) -> Self {
        Self { period, told: [(f64::NEG_INFINITY, 0.0); KEPT], ages: Ages::default() }
    }

    /// The world tells of a period, counted from 1, before which devices were looked at as of a date [s].
    pub fn tell(&mut self, period: f64, looked: f64) {
        self.told.rotate_left(1);
        self.told[KEPT - 1] = (period, looked);
    }

    /// A force is given at a date [s] that says how the body was after so many periods and a part of one.
    pub fn note(&mut self, periods: f64, now: f64) {
        let Some(looked) = self.looked(periods) else { return };
        self.ages.of_answer.push((now - looked).max(0.0));
        self.ages.of_body.push((now + TICK - (looked + self.period)).max(0.0));
    }

    /// When devices were looked at before what is shown [s]; `None` of what was told too long ago, or never.
    fn looked(&self, periods: f64) -> Option<f64> {
        let after = self.told.partition_point(|(period, _)| *period < periods);
        let (end, looked) = *self.told.get(after).or(self.told.last())?;
        let (start, before) = *self.told.get(after.checked_sub(1)?)?;
        if !start.is_finite() {
            return None;
        }
        let share = if end > start { ((periods - start) / (end - start)).clamp(0.0, 1.0) } else { 1.0 };
        Some(before + (looked - before) * share)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of periods of 10 ms that are told as soon as they begin, with what is shown `d` before their end: what the force says is `d` and a
    /// tick old when the next one comes, and it answers to where the device was a period and `d` before.
    #[test]
    fn ages_are_those_of_what_is_shown() {
        let (period, behind) = (10e-3, 4e-3);
        let mut freshness = Freshness::new(period);
        for n in 1..=20 {
            let looked = f64::from(n - 1) * period;
            freshness.tell(f64::from(n), looked);
            for tick in 0..10 {
                let now = looked + f64::from(tick) * TICK;
                freshness.note((now - behind) / period, now);
            }
        }
        let Ages { of_body, of_answer } = &freshness.ages;
        // not of the first periods, which nothing comes before
        assert!((185..=190).contains(&of_body.count()), "{}", of_body.count());
        assert!((of_body.longest() - (behind + TICK)).abs() < 1e-9, "{}", of_body.longest());
        assert!((of_body.mean() - (behind + TICK)).abs() < 1e-9);
        assert!((of_answer.mean() - (behind + period)).abs() < 1e-9);
    }

    /// What is held from one period to the next ages meanwhile.
    #[test]
    fn what_is_held_ages() {
        let mut freshness = Freshness::new(10e-3);
        freshness.tell(1.0, 0.0);
        freshness.tell(2.0, 10e-3);
        freshness.note(2.0, 14e-3);
        freshness.note(2.0, 20e-3);
        assert!((freshness.ages.of_answer.longest() - 10e-3).abs() < 1e-12);
        assert!((freshness.ages.of_body.longest() - 1e-3).abs() < 1e-12);
    }
}
