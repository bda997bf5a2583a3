//! Prescribed motion: pins, partial pins, driven points and frames.

use std::fmt::Debug;
use std::sync::Arc;

use souple_math::{Mat3, Vec3, exponential, logarithm};

/// Where a prescribed point is at a time, as an offset from where it started.
pub trait Motion: Send + Sync + Debug {
    /// [m]
    fn offset(&self, start: Vec3, time: f64) -> Vec3;
    /// The derivative of the offset [m/s].
    fn velocity(&self, start: Vec3, time: f64) -> Vec3;

    /// How what it leads has turned; not at all where it leads points alone.
    fn turn(&self, _time: f64) -> Mat3 {
        Mat3::IDENTITY
    }

    /// Angular velocity of that [rad/s].
    fn spin(&self, _time: f64) -> Vec3 {
        Vec3::ZERO
    }

    /// Whether it is known to be the same at all times.
    fn rests(&self) -> bool {
        false
    }
}

/// A velocity block that does not move freely.
#[derive(Clone, Debug)]
pub struct Constraint {
    pub block: u32,
    /// Projector onto the directions left free; zero for a full pin.
    pub free: Mat3,
    /// Where the block's row stood when it was pinned [m].
    pub start: Vec3,
    /// Of the angular block of a rigid frame: its axes when it was pinned. Such a block is held as a whole.
    pub axes: Option<Mat3>,
    /// How it is led; `None`: it stays.
    pub motion: Option<Arc<dyn Motion>>,
}

impl Constraint {
    /// A full pin at `start`.
    pub fn pin(block: u32, start: Vec3) -> Self {
        Self { block, free: Mat3::ZERO, start, axes: None, motion: None }
    }

    /// A pin that leaves `axes` free where `true`.
    pub fn partial(block: u32, start: Vec3, free: [bool; 3]) -> Self {
        let [x, y, z] = free.map(|is_free| if is_free { 1.0 } else { 0.0 });
        Self { free: Mat3::from_diagonal(Vec3::new(x, y, z)), ..Self::pin(block, start) }
    }

    /// The angular block of a rigid frame, led by the turn of a motion.
    pub fn of_turn(block: u32, axes: Mat3, motion: Option<Arc<dyn Motion>>) -> Self {
        Self { axes: Some(axes), motion, ..Self::pin(block, Vec3::ZERO) }
    }

    /// Projector onto the constrained directions.
    pub fn constrained(&self) -> Mat3 {
        Mat3::IDENTITY - self.free
    }

    /// Where the constrained components are to be [m].
    pub fn position(&self, time: f64, load: f64) -> Vec3 {
        self.start + self.motion.as_ref().map_or(Vec3::ZERO, |motion| motion.offset(self.start, time) * load)
    }

    /// Where the axes of a frame are to be that stood at `axes` when it was pinned.
    pub fn turned(&self, axes: &Mat3, time: f64, load: f64) -> Mat3 {
        let Some(motion) = &self.motion else { return *axes };
        let turn = motion.turn(time);
        // a part of a turn is one about the same axis
        let turn = if load == 1.0 { turn } else { exponential(logarithm(&turn) * load) };
        turn * *axes
    }

    /// Of the block: [m/s], of the angular block of a rigid frame [rad/s].
    pub fn velocity(&self, time: f64) -> Vec3 {
        let Some(motion) = &self.motion else { return Vec3::ZERO };
        if self.axes.is_some() { motion.spin(time) } else { motion.velocity(self.start, time) }
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
