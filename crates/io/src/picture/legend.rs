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

/// The scale of a legend: its numbers are few digits of a unit that suits them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Scale {
    /// Values in the unit they were given in, with their names, all with as many digits behind the point.
    pub ticks: Vec<(f64, String)>,
    /// With a prefix, as `kPa`; a power of ten where there is no unit.
    pub unit: String,
}

/// Prefixes of powers of a thousand, from the ninth below to the ninth above.
const PREFIXES: [(i32, &str); 7] = [(-9, "n"), (-6, "µ"), (-3, "m"), (0, ""), (3, "k"), (6, "M"), (9, "G")];

/// The names of a scale: round numbers, and both ends; a round number closer to an end than `nearest`, a share of the
/// whole, gives way to it.
pub(super) fn scale(low: f64, high: f64, unit: &str, about: usize, nearest: f64) -> Scale {
    // between zero and the least number there is nothing to tell: all values are zero
    if low.abs().max(high.abs()) <= f64::MIN_POSITIVE {
        return Scale { ticks: vec![(0.0, "0".to_owned())], unit: unit.to_owned() };
    }
    let (factor, unit) = scaled_unit(low.abs().max(high.abs()), unit);
    let (low, high) = (low / factor, high / factor);
    let span = high - low;
    let round = ticks(low, high, about);
    if round.len() < 2 || !span.is_finite() {
        let ticks = round.iter().map(|tick| tick * factor).zip(labels(&round)).collect();
        return Scale { ticks, unit };
    }
    let step = round[1] - round[0];
    let is_round = |value: f64| round.iter().any(|tick| (tick - value).abs() <= 1e-9 * span);
    // ends that are not round are told to a digit more than the steps between, and so is all else, one under the other
    let step = if is_round(low) && is_round(high) { step } else { 0.1 * step };
    let within =
        round.iter().copied().filter(|tick| tick - low > nearest * span && high - tick > nearest * span);
    let values: Vec<f64> = [low].into_iter().chain(within).chain([high]).collect();
    let names = labelled(&values, low.abs().max(high.abs()), step);
    Scale { ticks: values.into_iter().map(|value| value * factor).zip(names).collect(), unit }
}

/// The names of a scale of powers of ten: both ends, and between them powers, every second or third of them where there are more
/// than `most`; of less than two, doubles and halves of powers. None of these is closer to an end than `nearest`, a share of the
/// whole.
pub(super) fn log_scale(low: f64, high: f64, unit: &str, most: usize, nearest: f64) -> Scale {
    let unit = unit.to_owned();
    // a power of ten is one, though its logarithm is rounded
    let [first, last] = [libm::ceil(libm::log10(low) - 1e-9), libm::floor(libm::log10(high) + 1e-9)];
    if !(first.is_finite() && last.is_finite()) {
        return Scale { ticks: vec![(low, minus(low.to_string()))], unit };
    }
    let powers: Vec<i32> = (first as i32..=last as i32).collect();
    let value = |power: i32| libm::pow(10.0, f64::from(power));
    let is_plain = [low, high].iter().all(|end| (1e-3..1e5).contains(end));
    let share = |value: f64| libm::log(value / low) / libm::log(high / low);
    let is_inner = |value: f64| share(value) > nearest && 1.0 - share(value) > nearest;
    let is_power = |end: f64, power: i32| (end / value(power) - 1.0).abs() < 1e-9;
    // ends are told to two digits, which tell them apart unless the range is narrower than that
    let end = |end: f64| {
        let power = libm::floor(libm::log10(end) + 1e-9) as i32;
        let name = match (is_power(end, power), is_plain) {
            (true, _) => power_name(power, is_plain),
            (false, true) => labelled(&[end], end, end_step(end, end + high - low)).concat(),
            (false, false) => {
                let step = end_step(end, end + high - low);
                let digits = (f64::from(power) - libm::log10(step)).round().clamp(1.0, 17.0) as usize;
                let text = format!("{end:.digits$e}");
                let (mantissa, power) = text.split_once('e').unwrap_or((&text, "0"));
                format!("{mantissa}·10{}", raised(power.parse().unwrap_or(0)))
            }
        };
        (end, name)
    };
    let inner: Vec<(f64, String)> = if powers.len() < 2 {
        let power = libm::floor(libm::log10(low) + 1e-9) as i32;
        let mut steps: Vec<f64> = [1.0, 2.0, 5.0]
            .into_iter()
            .flat_map(|step| [step * value(power), step * value(power + 1)])
            .collect();
        steps.sort_by(f64::total_cmp);
        steps.into_iter().map(|step| (step, labels(&[step]).concat())).collect()
    } else {
        let stride = powers.len().div_ceil(most.max(2));
        powers.into_iter().step_by(stride).map(|power| (value(power), power_name(power, is_plain))).collect()
    };
    let inner = inner.into_iter().filter(|(value, _)| is_inner(*value));
    Scale { ticks: [end(low)].into_iter().chain(inner).chain([end(high)]).collect(), unit }
}

/// A power of ten as a person writes it.
fn power_name(power: i32, is_plain: bool) -> String {
    let digits = -power.min(0) as usize;
    if is_plain {
        format!("{:.digits$}", libm::pow(10.0, f64::from(power)))
    } else {
        format!("10{}", raised(power))
    }
}

/// The digit to which both ends of a range are told: a tenth of the first digit of the lower one, or of what is between them.
fn end_step(low: f64, high: f64) -> f64 {
    let between = (high - low).max(f64::EPSILON * high);
    0.1 * libm::pow(10.0, libm::floor(libm::log10(low.min(between)) + 1e-9))
}

/// What values up to `largest` are divided by to be from 0.1 to a thousand, and what the unit is called then.
pub(super) fn scaled_unit(largest: f64, unit: &str) -> (f64, String) {
    if !(largest > 0.0 && largest.is_finite()) || (0.1..1000.0).contains(&largest) {
        return (1.0, unit.to_owned());
    }
    let power = 3 * libm::floor(libm::log10(largest) / 3.0 + 1e-9) as i32;
    match PREFIXES.iter().find(|(known, _)| *known == power).filter(|_| !unit.is_empty()) {
        Some((_, prefix)) => (libm::pow(10.0, f64::from(power)), format!("{prefix}{unit}")),
        None => {
            let factor = libm::pow(10.0, f64::from(power));
            let space = if unit.is_empty() { "" } else { " " };
            (factor, format!("10{}{space}{unit}", raised(power)))
        }
    }
}

/// A whole number as an exponent.
fn raised(number: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raise = |character: char| match character.to_digit(10) {
        Some(digit) => DIGITS[digit as usize],
        None => '⁻',
    };
    number.to_string().chars().map(raise).collect()
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

    /// Both ends are named; where they are not round all numbers have a digit more; round ones keep away from the ends.
    #[test]
    fn the_ends_of_a_scale_are_named() {
        let names = |low: f64, high: f64, unit: &str| -> (Vec<String>, String) {
            let scale = scale(low, high, unit, 5, 0.06);
            (scale.ticks.into_iter().map(|(_, name)| name).collect(), scale.unit)
        };
        let of = |names: &[&str], unit: &str| {
            (names.iter().map(|name| (*name).to_owned()).collect(), unit.to_owned())
        };
        assert_eq!(names(0.0, 1.0, "m"), of(&["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"], "m"));
        assert_eq!(
            names(0.0, 7.031, "m"),
            of(&["0.0", "1.0", "2.0", "3.0", "4.0", "5.0", "6.0", "7.0"], "m")
        );
        assert_eq!(names(15803.2, 16531.7, "Pa"), of(&["15.80", "16.00", "16.20", "16.40", "16.53"], "kPa"));
        assert_eq!(
            names(0.0, 3.4e-6, "m"),
            of(&["0.00", "0.50", "1.00", "1.50", "2.00", "2.50", "3.00", "3.40"], "µm")
        );
        assert_eq!(names(0.0, 0.02, ""), of(&["0", "5", "10", "15", "20"], "10⁻³"));
        assert_eq!(names(0.0, 2e12, "Pa"), of(&["0.0", "0.5", "1.0", "1.5", "2.0"], "10¹² Pa"));
        assert_eq!(names(2.0, 2.0, "m"), of(&["2"], "m"));
        // of zeros, as of the least range about them, there is one number
        for range in [0.0, f64::MIN_POSITIVE] {
            assert_eq!(names(0.0, range, "m/s"), of(&["0"], "m/s"));
            assert_eq!(names(-range, range, "m/s"), of(&["0"], "m/s"));
        }
        for (low, high) in [(0.0, f64::INFINITY), (f64::NAN, 1.0), (-1e308, 1e308), (1.0, 1.0 + 1e-15)] {
            assert!(scale(low, high, "m", 5, 0.05).ticks.len() < 50);
        }
    }

    /// Powers of ten are named as a person writes them; of many every second; within one, its parts.
    #[test]
    fn powers_of_ten_are_named() {
        let names = |low: f64, high: f64| -> Vec<String> {
            log_scale(low, high, "Pa", 7, 0.06).ticks.into_iter().map(|(_, name)| name).collect()
        };
        assert_eq!(names(1.0, 1e3), ["1", "10", "100", "1000"]);
        assert_eq!(names(0.01, 10.0), ["0.01", "0.1", "1", "10"]);
        assert_eq!(names(1e4, 1e7), ["10⁴", "10⁵", "10⁶", "10⁷"]);
        assert_eq!(names(1e-9, 1.0), ["10⁻⁹", "10⁻⁷", "10⁻⁵", "10⁻³", "10⁻¹", "10⁰"]);
        // ends that are no powers, from which powers keep away
        assert_eq!(names(300.0, 4e4), ["300", "1000", "10000", "40000"]);
        assert_eq!(names(3e5, 9.5e7), ["3.0·10⁵", "10⁶", "10⁷", "9.5·10⁷"]);
        assert_eq!(names(2.10e7, 2.14e7), ["2.100·10⁷", "2.140·10⁷"]);
        assert_eq!(names(1e6, 9.97e7), ["10⁶", "10⁷", "1.0·10⁸"]);
        assert_eq!(names(0.002, 1.1), ["0.0020", "0.01", "0.1", "1.1"]);
        assert_eq!(names(150.0, 800.0), ["150", "200", "500", "800"]);
        // no power of ten in it, nor a double of one; one power alone
        assert_eq!(names(2.1, 4.9), ["2.1", "4.9"]);
        assert_eq!(names(0.6, 1.9), ["0.60", "1", "1.9"]);
        assert!(names(f64::NAN, 1.0).len() < 2 && names(1.0, f64::INFINITY).len() < 2);
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
