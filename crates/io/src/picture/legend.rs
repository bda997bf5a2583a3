//! The legend of a colour map, and round numbers for its scale.

/// Round numbers from `low` to `high`, about as many as asked for: steps of 1, 2 or 5 times a power of ten.
pub(crate) fn ticks(low: f64, high: f64, about: usize) -> Vec<f64> {
    let span = high - low;
    if !(span > 0.0 && span.is_finite()) {
        return vec![low];
    }
    let raw = span / about.max(1) as f64;
    let power = libm::pow(10.0, libm::floor(libm::log10(raw)));
    // the candidate whose ratio to the wished-for step is closest to one
    let candidates = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power);
    let off = |step: f64| libm::log(step / raw).abs();
    let step =
        candidates.into_iter().fold(power, |best, step| if off(step) < off(best) { step } else { best });
    let first = (low / step - 1e-9).ceil();
    let last = (high / step + 1e-9).floor();
    let count = (last - first).clamp(0.0, 1000.0) as usize;
    // whole multiples, so that 0.30000000000000004 is 0.3 after rounding to the step
    (0..=count)
        .map(|index| (first + index as f64) * step)
        .map(|tick| if tick == 0.0 { 0.0 } else { tick })
        .collect()
}

/// The names of a scale: round numbers, and both ends; a round number closer to an end than `nearest`, a share of the
/// whole, gives way to it.
pub(crate) fn scale(low: f64, high: f64, about: usize, nearest: f64) -> Vec<(f64, String)> {
    let round = ticks(low, high, about);
    let span = high - low;
    if round.len() < 2 || !span.is_finite() {
        return round.iter().copied().zip(labels(&round)).collect();
    }
    let (step, largest) = (round[1] - round[0], low.abs().max(high.abs()));
    let is_round = |value: f64| round.iter().any(|tick| (tick - value).abs() <= 1e-9 * span);
    let end = |value: f64| {
        // an end is told to a digit more than the round numbers between
        let step = if is_round(value) { step } else { 0.1 * step };
        (value, labelled(&[value], largest, step).remove(0))
    };
    let within: Vec<f64> = round
        .iter()
        .copied()
        .filter(|tick| tick - low > nearest * span && high - tick > nearest * span)
        .collect();
    let names = labelled(&within, largest, step);
    [end(low)].into_iter().chain(within.into_iter().zip(names)).chain([end(high)]).collect()
}

/// Numbers with as many digits as their steps need; very large and small ones as `3.2e6`.
pub(crate) fn labels(ticks: &[f64]) -> Vec<String> {
    let largest = ticks.iter().fold(0.0, |largest: f64, tick| largest.max(tick.abs()));
    let step = ticks.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
    let step = if step.is_finite() && step > 0.0 { step } else { largest };
    labelled(ticks, largest, step)
}

/// Numbers to the digit of `step`, all with the exponent of the largest.
fn labelled(ticks: &[f64], largest: f64, step: f64) -> Vec<String> {
    if largest == 0.0 || !largest.is_finite() {
        return ticks.iter().map(|tick| format!("{tick}")).collect();
    }
    let digits_below =
        |scale: f64| (-libm::floor(libm::log10(step / scale) + 1e-9)).clamp(0.0, 17.0) as usize;
    if (1e-3..1e5).contains(&largest) {
        let digits = digits_below(1.0);
        return ticks.iter().map(|tick| minus(format!("{tick:.digits$}"))).collect();
    }
    let exponent = libm::floor(libm::log10(largest) + 1e-9) as i32;
    let scale = libm::pow(10.0, f64::from(exponent));
    let digits = digits_below(scale);
    let scaled = |tick: &f64| {
        let number = minus(format!("{:.digits$}", tick / scale));
        let is_zero = number.bytes().all(|digit| matches!(digit, b'0' | b'.'));
        if is_zero { "0".to_owned() } else { format!("{number}e{exponent}") }
    };
    ticks.iter().map(scaled).collect()
}

/// A true minus sign, and no minus before zero.
fn minus(text: String) -> String {
    match text.strip_prefix('-') {
        Some(rest) if rest.bytes().all(|digit| matches!(digit, b'0' | b'.')) => rest.to_owned(),
        Some(rest) => format!("−{rest}"),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both ends are named, to a digit more than the round numbers, which keep away from them.
    #[test]
    fn the_ends_of_a_scale_are_named() {
        let names = |low: f64, high: f64| -> Vec<String> {
            scale(low, high, 5, 0.06).into_iter().map(|(_, name)| name).collect()
        };
        assert_eq!(names(0.0, 1.0), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(names(0.0, 7.031), ["0", "1", "2", "3", "4", "5", "6", "7.0"]);
        assert_eq!(names(15803.2, 16531.7), ["15803", "16000", "16200", "16400", "16532"][..].to_vec());
        assert_eq!(names(0.0, 3.4e-6)[6..], ["3.0e-6", "3.40e-6"]);
        assert_eq!(names(1e3, 1.71e11)[0], "0");
        assert_eq!(names(2.0, 2.0), ["2"]);
        for (low, high) in [(0.0, f64::INFINITY), (f64::NAN, 1.0), (-1e308, 1e308), (1.0, 1.0 + 1e-15)] {
            assert!(scale(low, high, 5, 0.05).len() < 50);
        }
    }

    #[test]
    fn ticks_are_round_and_within() {
        assert_eq!(labels(&ticks(0.0, 1.0, 5)), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels(&ticks(-3.1, 7.0, 5)), ["−2", "0", "2", "4", "6"]);
        assert_eq!(labels(&ticks(0.0, 3.4e6, 4)), ["0", "1e6", "2e6", "3e6"]);
        assert_eq!(labels(&ticks(0.0, 2.2e-5, 4)), ["0", "0.5e-5", "1.0e-5", "1.5e-5", "2.0e-5"]);
        assert_eq!(labels(&ticks(0.1, 0.4, 3)), ["0.1", "0.2", "0.3", "0.4"]);
        assert_eq!(labels(&ticks(2.0, 2.0, 3)), ["2"]);
        for (low, high) in [(0.0, f64::INFINITY), (f64::NAN, 1.0), (-1e308, 1e308), (1.0, 1.0 + 1e-15)] {
            assert!(labels(&ticks(low, high, 5)).len() < 50);
        }
    }
}
