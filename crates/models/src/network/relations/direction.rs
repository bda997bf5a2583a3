//! A segment between two masses along a direction that is told.

use std::sync::Arc;

use souple_engine::Motion;
use souple_math::{Mat3, Vec3};

use super::{Relation, across};

/// `g_c = R(t) n_c·(x_b − x_a)` with the two directions `n_c` across where the segment is to point at the start, and the turn `R` by which
/// that is told to go on. Its multipliers are the force on `b` along them [N], the opposite of that on `a`: with the segment they are a couple.
///
/// It says nothing of the length of the segment, nor of which way it points along the direction: neither changes where it is of some length.
#[derive(Clone, Debug)]
pub struct Direction {
    /// From the first to the second.
    pub ends: [u32; 2],
    across: [Vec3; 2],
    /// How what is told turns; it stays where `None`.
    rotation: Option<Arc<dyn Motion>>,
}

impl Direction {
    /// `None` for a direction of no length.
    pub fn new(ends: [u32; 2], along: Vec3, rotation: Option<Arc<dyn Motion>>) -> Option<Self> {
        Some(Self { ends, across: across(along)?, rotation })
    }

    fn apart(&self, positions: &[Vec3]) -> Vec3 {
        let [a, b] = self.ends.map(|end| positions[end as usize]);
        b - a
    }

    /// The directions across at a time.
    fn normals(&self, time: f64) -> [Vec3; 2] {
        let Some(rotation) = &self.rotation else { return self.across };
        let turn = rotation.turn(time);
        self.across.map(|normal| turn * normal)
    }
}

impl Relation for Direction {
    fn rows(&self) -> &[u32] {
        &self.ends
    }

    fn value(&self, positions: &[Vec3], time: f64) -> Vec3 {
        let ([one, other], apart) = (self.normals(time), self.apart(positions));
        Vec3::new(one.dot(apart), other.dot(apart), 0.0)
    }

    fn add_gradients(&self, _positions: &[Vec3], time: f64, gradients: &mut Vec<Mat3>) {
        let [one, other] = self.normals(time);
        let gradient = Mat3::from_columns(one, other, Vec3::ZERO).transpose();
        gradients.extend([-gradient, gradient]);
    }

    // ṅ·s = (ω × n)·s
    fn time_rate(&self, positions: &[Vec3], time: f64) -> Vec3 {
        let Some(rotation) = &self.rotation else { return Vec3::ZERO };
        let spin = rotation.spin(time);
        let apart = self.apart(positions);
        let [one, other] = self.normals(time).map(|normal| spin.cross(normal).dot(apart));
        Vec3::new(one, other, 0.0)
    }

    fn describe(&self) -> String {
        "a direction".to_owned()
    }
}
