//! The strongest frequency of values at even times.

use std::f64::consts::{PI, TAU};

/// Zeros behind the values, as many times as these: the peak is found between the bins of the values alone.
const PADDING: usize = 8;
/// Values of which a swing can be told, at least.
const LEAST: usize = 8;
/// Values and zeros at most.
const MOST: usize = 1 << 20;

/// The highest peak of the spectrum [Hz], of values `interval` seconds apart, less their mean, under Hann's window; above two
/// swings within the whole time, below which the window cannot tell a swing from a drift. `None` where nothing swings.
pub fn strongest_frequency(values: &[f64], interval: f64) -> Option<f64> {
    let count = values.len();
    let apart = interval.is_finite() && interval > 0.0;
    if !(LEAST..=MOST).contains(&count) || !apart || values.iter().any(|value| !value.is_finite()) {
        return None;
    }
    let mean = values.iter().sum::<f64>() / count as f64;
    let size = values.iter().fold(0.0_f64, |size, value| size.max((value - mean).abs()));
    // what rounding leaves of a value that stays
    if size <= 1e-12 * mean.abs() {
        return None;
    }
    let length = (PADDING * count).next_power_of_two().min(MOST);
    let mut spectrum = vec![[0.0; 2]; length];
    for (at, (bin, value)) in spectrum.iter_mut().zip(values).enumerate() {
        let window = 0.5 - 0.5 * libm::cos(TAU * at as f64 / (count - 1) as f64);
        bin[0] = window * (value - mean);
    }
    transform(&mut spectrum);
    let power = |bin: usize| spectrum[bin][0].powi(2) + spectrum[bin][1].powi(2);
    let least = (2 * length).div_ceil(count);
    let peaks = (least.max(1)..length / 2)
        .filter(|bin| power(*bin) > power(bin - 1) && power(*bin) >= power(bin + 1));
    let highest = peaks.max_by(|a, b| power(*a).total_cmp(&power(*b)))?;
    Some(highest as f64 / (length as f64 * interval))
}

/// Fourier's transform in place, of a power of two of complex numbers (Cooley & Tukey).
fn transform(values: &mut [[f64; 2]]) {
    let count = values.len();
    let bits = count.trailing_zeros();
    for at in 0..count {
        let mirrored = at.reverse_bits() >> (usize::BITS - bits);
        if at < mirrored {
            values.swap(at, mirrored);
        }
    }
    let mut half = 1;
    while half < count {
        for first in 0..half {
            let angle = -PI * first as f64 / half as f64;
            let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
            for a in (first..count).step_by(2 * half) {
                let b = a + half;
                let [x, y] = values[b];
                let turned = [x * cosine - y * sine, x * sine + y * cosine];
                for part in 0..2 {
                    values[b][part] = values[a][part] - turned[part];
                    values[a][part] += turned[part];
                }
            }
        }
        half *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A swing is found to half a bin beside a mean, a weaker swing and a drift; what stays or drifts alone has none.
    #[test]
    fn swings_are_found() {
        let (interval, count) = (0.01, 601);
        let at = |of: &dyn Fn(f64) -> f64| -> Vec<f64> {
            (0..count).map(|i| of(f64::from(i) * interval)).collect()
        };
        let swing = at(&|t| 3.0 + 0.1 * t + (TAU * 4.06 * t).sin() + 0.3 * (TAU * 9.0 * t).sin());
        let found = strongest_frequency(&swing, interval).unwrap();
        assert!((found - 4.06).abs() < 0.5 / (8192.0 * interval) + 1e-3, "{found}");
        assert_eq!(strongest_frequency(&at(&|_| 0.3), interval), None);
        assert_eq!(strongest_frequency(&[1.0, 2.0], interval), None);
    }
}
