//! A rigid rod: two masses at one distance.

use souple_math::{Mat3, Vec3};

use super::{Relation, first_row};

/// `g = |x_a − x_b| − L`, of gradient `n` at `a` and `−n` at `b`; none where the ends meet. Its multiplier is the push between
/// the ends, positive when pressed [N].
#[derive(Clone, Debug)]
pub struct Rod {
    pub ends: [u32; 2],
    /// Above zero [m].
    pub length: f64,
}

impl Rod {
    fn apart(&self, positions: &[Vec3]) -> Vec3 {
        let [a, b] = self.ends.map(|end| positions[end as usize]);
        a - b
    }
}

impl Relation for Rod {
    fn rows(&self) -> &[u32] {
        &self.ends
    }

    fn value(&self, positions: &[Vec3], _time: f64) -> Vec3 {
        Vec3::X * (self.apart(positions).length() - self.length)
    }

    fn add_gradients(&self, positions: &[Vec3], _time: f64, gradients: &mut Vec<Mat3>) {
        let along = self.apart(positions).try_normalised().unwrap_or(Vec3::ZERO);
        gradients.extend([first_row(along), first_row(-along)]);
    }

    fn slope(&self, positions: &[Vec3], _time: f64) -> Option<Vec3> {
        Some(self.apart(positions).try_normalised().unwrap_or(Vec3::ZERO))
    }

    fn magnitude(&self, _positions: &[Vec3], _time: f64) -> Vec3 {
        Vec3::X * self.length
    }

    fn is_lost_between(&self, from: &[Vec3], to: &[Vec3]) -> Option<&'static str> {
        (self.apart(from).dot(self.apart(to)) <= 0.0).then_some(
            "gives way until its ends meet, where it has no direction, or turns by a quarter within a step: keep them apart, let it bear more, or take smaller steps",
        )
    }

    fn ends(&self) -> Option<[u32; 2]> {
        Some(self.ends)
    }

    fn describe(&self) -> String {
        format!("a rod of {} m", self.length)
    }
}
