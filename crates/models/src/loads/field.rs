//! What a load is as a function of place and time.

use std::fmt::Debug;

use souple_math::{Mat3, Vec3};

/// A force on a point that depends on where it is and when.
pub trait ForceField: Send + Sync + Debug {
    /// [N]
    fn force(&self, position: Vec3, time: f64) -> Vec3;

    /// `∂force/∂position` [N/m]; zero where [`ForceField::depends_on_position`] is false.
    fn gradient(&self, _position: Vec3, _time: f64) -> Mat3 {
        Mat3::ZERO
    }

    /// Whether the force changes with the position, so that it has no potential known to us.
    fn depends_on_position(&self) -> bool {
        false
    }
}

/// The same force everywhere and always [N].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UniformForce(pub Vec3);

impl ForceField for UniformForce {
    fn force(&self, _position: Vec3, _time: f64) -> Vec3 {
        self.0
    }
}
