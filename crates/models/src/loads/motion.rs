//! Prescribed motions of pinned points: key frames (formulas are in `formula.rs`).

use souple_engine::Motion;
use souple_math::Vec3;

use super::{LoadError, finite};

/// How key frames are joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// Straight from key to key; the velocity jumps at keys.
    Linear,
    /// A cubic through the keys, at rest at both ends: the velocity is continuous, and between two keys no component
    /// goes beyond them (Fritsch and Carlson 1980), so that what two keys hold is held.
    Smooth,
}

/// Offsets at given times; before the first and after the last the point stands still there.
#[derive(Clone, Debug, PartialEq)]
pub struct KeyFrames {
    times: Vec<f64>,
    offsets: Vec<Vec3>,
    /// Velocities at the keys, for the cubic.
    slopes: Vec<Vec3>,
    interpolation: Interpolation,
}

impl KeyFrames {
    /// Times [s] in ascending order, as many offsets [m].
    ///
    /// # Errors
    /// No keys, not as many offsets as times, a number that is not finite, times that do not ascend.
    pub fn new(times: Vec<f64>, offsets: Vec<Vec3>, interpolation: Interpolation) -> Result<Self, LoadError> {
        if times.is_empty() {
            return Err(LoadError::Empty { field: "times", expected: "key frame" });
        }
        if times.len() != offsets.len() {
            let (found, expected) = (offsets.len(), times.len());
            return Err(LoadError::Count { field: "offsets", found, expected, of: "times" });
        }
        for index in 0..times.len() {
            let field = format!("times[{index}]");
            let time = finite(field.clone(), times[index])?;
            if index > 0 && time <= times[index - 1] {
                return Err(LoadError::Unfit {
                    field,
                    value: time,
                    expected: "later than the time before it",
                });
            }
            for axis in 0..3 {
                finite(format!("offsets[{index}][{axis}]"), offsets[index][axis])?;
            }
        }
        let last = times.len() - 1;
        let slope = |key: usize| {
            if key == 0 || key == last {
                return Vec3::ZERO;
            }
            let speed =
                |from: usize| (offsets[from + 1] - offsets[from]) * (1.0 / (times[from + 1] - times[from]));
            let (before, after) = (speed(key - 1).to_array(), speed(key).to_array());
            let mean = (offsets[key + 1] - offsets[key - 1]) * (1.0 / (times[key + 1] - times[key - 1]));
            let mean = mean.to_array();
            Vec3::from_array([0, 1, 2].map(|axis| monotone(mean[axis], before[axis], after[axis])))
        };
        let slopes = (0..=last).map(slope).collect();
        Ok(Self { times, offsets, slopes, interpolation })
    }

    /// Offset and velocity at a time.
    fn at(&self, time: f64) -> (Vec3, Vec3) {
        let next = self.times.partition_point(|key| *key <= time);
        if next == 0 || next == self.times.len() {
            return (self.offsets[next.saturating_sub(1)], Vec3::ZERO);
        }
        let (from, to) = (next - 1, next);
        let length = self.times[to] - self.times[from];
        let s = (time - self.times[from]) / length;
        let step = self.offsets[to] - self.offsets[from];
        if self.interpolation == Interpolation::Linear {
            return (self.offsets[from] + step * s, step * (1.0 / length));
        }
        // Hermite: p(s) = p₀ + Δ (3s² - 2s³) + T m₀ (s - 2s² + s³) + T m₁ (s³ - s²)
        let (start, end) = (self.slopes[from], self.slopes[to]);
        let offset = self.offsets[from]
            + step * (s * s * (3.0 - 2.0 * s))
            + start * (length * s * (1.0 - s) * (1.0 - s))
            + end * (length * s * s * (s - 1.0));
        let velocity = step * (6.0 * s * (1.0 - s) / length)
            + start * ((1.0 - s) * (1.0 - 3.0 * s))
            + end * (s * (3.0 * s - 2.0));
        (offset, velocity)
    }
}

/// The slope at a key for a mean one, that of the stretch before and that of the one after: none where these turn back or
/// stand still, else at most three times the smaller one, up to which a cubic stays between its ends.
fn monotone(mean: f64, before: f64, after: f64) -> f64 {
    if before * after <= 0.0 {
        return 0.0;
    }
    let most = 3.0 * before.abs().min(after.abs());
    mean.clamp(-most, most)
}

impl Motion for KeyFrames {
    fn offset(&self, _start: Vec3, time: f64) -> Vec3 {
        self.at(time).0
    }

    fn velocity(&self, _start: Vec3, time: f64) -> Vec3 {
        self.at(time).1
    }
}
