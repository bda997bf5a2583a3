//! For how long points of levels stay, before what made them finer is taken back: kept in the memory of their force, behind what says who
//! is at work.
//!
//! A criterion that flickers shows here: a point that comes and goes within a second has a rate above 1 Hz. A zone that is refined
//! twice in a row has not flickered.

/// Dates are stored this much later [s]: zero, with which memories begin, is then no date; those of getting coarser are negative.
const LATER: f64 = 1.0;

/// Numbers kept for so many points.
pub fn len(points: usize) -> usize {
    1 + points
}

/// Notes how fine points are, before and from a date on [s]: coarser ones in their place, at work, finer ones in their place.
pub fn note(before: &[u8], now: impl Iterator<Item = u8>, time: f64, log: &mut [f64]) {
    let [rate, dates @ ..] = log else { return };
    for ((before, now), date) in before.iter().copied().zip(now).zip(dates) {
        if before == now {
            continue;
        }
        let (is_finer, was_finer) = (now > before, *date > 0.0);
        let stay = time - (date.abs() - LATER);
        // a world that is set up twice at one date has not flickered
        if *date != 0.0 && is_finer != was_finer && stay > 0.0 {
            *rate = rate.max(1.0 / stay);
        }
        *date = if is_finer { time + LATER } else { -(time + LATER) };
    }
}

/// One over the shortest time between two changes of one point that were opposite, so far [Hz].
pub fn rate(log: &[f64]) -> f64 {
    log.first().copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Point 0 comes at 0 s, gives place to finer ones at 0.1 s, and is back at 0.6 s: twice a second. Point 1 goes and comes within 0.2 s.
    #[test]
    fn the_shortest_stay_counts() {
        let mut log = vec![0.0; len(2)];
        let mut to = |before: [u8; 2], now: [u8; 2], time| {
            note(&before, now.into_iter(), time, &mut log);
            rate(&log)
        };
        assert_eq!(to([0, 1], [1, 1], 0.0), 0.0);
        assert_eq!(to([1, 1], [2, 1], 0.1), 0.0);
        assert!((to([2, 1], [1, 0], 0.6) - 2.0).abs() < 1e-12);
        assert!((to([1, 0], [1, 1], 0.8) - 5.0).abs() < 1e-12);
        assert!((to([1, 1], [1, 1], 0.9) - 5.0).abs() < 1e-12);
    }
}
