//! How many periods a run steps.

use souple_engine::State;
use souple_table::readable;

use crate::{Options, RunError};

/// Steps beyond which a count is surely a slip of the pen.
const MOST_STEPS: f64 = 1e12;
/// What is not whole by less than this share of a period is rounding of the two numbers.
const WHOLE: f64 = 1e-9;

/// Whole periods, and what was changed to make them whole.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Periods {
    pub count: u64,
    pub warning: Option<String>,
}

/// Periods in `duration` [s], to the nearest whole number, which a warning tells where it changes the duration.
///
/// # Errors
/// There are absurdly many, or the duration is so short that none would be stepped.
pub fn periods_in(duration: f64, period: f64) -> Result<Periods, RunError> {
    let exact = duration / period;
    let whole = exact.round();
    if exact.is_nan() || exact > MOST_STEPS {
        return Err(RunError::TooManySteps { duration, period, steps: exact, limit: MOST_STEPS });
    }
    if whole == 0.0 && duration > 0.0 {
        return Err(RunError::NoStep { duration, period, share: exact });
    }
    let is_whole = (exact - whole).abs() <= WHOLE * whole.max(1.0);
    let warning = (!is_whole).then(|| {
        let end = whole * period;
        format!(
            "a duration of {duration} s is {exact:.6} periods of {} s; {whole} are stepped, to {end:.6} s",
            readable(period)
        )
    });
    Ok(Periods { count: whole as u64, warning })
}

/// The periods that a run steps from `start`: as many as are asked for, or those left to the scene's end.
pub(crate) fn periods_of(
    options: &Options,
    scene_duration: f64,
    period: f64,
    start: &State,
) -> Result<Periods, RunError> {
    if let Some(count) = options.steps {
        return Ok(Periods { count, warning: None });
    }
    if let Some(duration) = options.duration {
        return periods_in(duration, period);
    }
    let Periods { count: whole, mut warning } = periods_in(scene_duration, period)?;
    let count = whole.saturating_sub(start.period);
    if count == 0 && whole > 0 {
        warning = Some(format!(
            "the snapshot is of step {}, and the scene ends after {whole}: nothing is left to run; say how much with --steps or --duration",
            start.period
        ));
    }
    Ok(Periods { count, warning })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Decimal fractions that are whole by meaning are whole; others are rounded and say so; nothing is no run.
    #[test]
    fn durations_are_counted_in_periods() {
        for (duration, period, count) in
            [(0.3, 0.1, 3), (1.0, 1.0 / 3.0, 3), (2.0, 1e-3, 2000), (0.0, 1.0, 0)]
        {
            assert_eq!(periods_in(duration, period).unwrap(), Periods { count, warning: None });
        }
        let rounded = periods_in(0.105, 0.01).unwrap();
        assert!(rounded.count == 10 || rounded.count == 11);
        let warning = rounded.warning.unwrap();
        assert!(warning.contains("10.500000 periods of 0.01 s"), "{warning}");
        for (duration, period) in [(0.004, 0.01), (1.0, 1e12)] {
            assert!(matches!(periods_in(duration, period), Err(RunError::NoStep { .. })));
        }
        assert!(matches!(periods_in(1e9, 1e-6), Err(RunError::TooManySteps { .. })));
    }
}
