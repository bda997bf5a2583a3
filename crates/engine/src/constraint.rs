//! Prescribed motion: pins, partial pins, driven points and frames.

use std::fmt::Debug;
use std::sync::Arc;

use souple_math::{Mat3, Vec3};

/// Where a prescribed point is at a time, as an offset from where it started.
pub trait Motion: Send + Sync + Debug {
    /// [m]
    fn offset(&self, start: Vec3, time: f64) -> Vec3;
    /// The derivative of the offset [m/s].
    fn velocity(&self, start: Vec3, time: f64) -> Vec3;
}

/// A velocity block that does not move freely.
#[derive(Clone, Debug)]
pub struct Constraint {
    pub block: u32,
    /// Projector onto the directions left free; zero for a full pin.
    pub free: Mat3,
    /// Where the block's row stood when it was pinned [m].
    pub start: Vec3,
    /// How it is led; `None`: it stays.
    pub motion: Option<Arc<dyn Motion>>,
}

impl Constraint {
    /// A full pin at `start`.
    pub fn pin(block: u32, start: Vec3) -> Self {
        Self { block, free: Mat3::ZERO, start, motion: None }
    }

    /// A pin that leaves `axes` free where `true`.
    pub fn partial(block: u32, start: Vec3, free: [bool; 3]) -> Self {
        let [x, y, z] = free.map(|is_free| if is_free { 1.0 } else { 0.0 });
        Self { block, free: Mat3::from_diagonal(Vec3::new(x, y, z)), start, motion: None }
    }

    /// Projector onto the constrained directions.
    pub fn constrained(&self) -> Mat3 {
        Mat3::IDENTITY - self.free
    }

    /// Where the constrained components are to be [m].
    pub fn position(&self, time: f64, load: f64) -> Vec3 {
        self.start + self.motion.as_ref().map_or(Vec3::ZERO, |motion| motion.offset(self.start, time) * load)
    }

    /// [m/s]
    pub fn velocity(&self, time: f64) -> Vec3 {
        self.motion.as_ref().map_or(Vec3::ZERO, |motion| motion.velocity(self.start, time))
    }

    /// The mean acceleration over a step about `time` [m/s²]: of second order in the step, and finite also where key
    /// frames make the velocity jump.
    pub fn mean_acceleration(&self, time: f64, timestep: f64) -> Vec3 {
        if self.motion.is_none() {
            return Vec3::ZERO;
        }
        let (from, to) = ((time - 0.5 * timestep).max(0.0), time + 0.5 * timestep);
        (self.velocity(to) - self.velocity(from)) / (to - from)
    }
}
