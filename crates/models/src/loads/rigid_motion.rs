//! Rigid motion, of shapes and of the points that a pin leads: carried along and turned about a pivot.

use std::sync::Arc;

use souple_engine::Motion;
use souple_math::{Mat3, Vec3, exponential};

/// A rigid motion; at rest by default.
#[derive(Clone, Debug, Default)]
pub struct RigidMotion {
    /// Offset of the pivot [m].
    pub translation: Option<Arc<dyn Motion>>,
    /// Rotation vector about the pivot [rad].
    pub rotation: Option<Arc<dyn Motion>>,
    /// Where it turns, in the place where it is written [m].
    pub pivot: Vec3,
}

/// Where something rigid is and how it moves, at one time.
#[derive(Clone, Copy, Debug)]
pub struct Pose {
    /// `world = origin + turn (shape - pivot)` [m].
    pub origin: Vec3,
    pub turn: Mat3,
    pub pivot: Vec3,
    /// Of the origin [m/s].
    pub velocity: Vec3,
    /// [rad/s]
    pub angular_velocity: Vec3,
}

/// A place that does not change.
#[derive(Clone, Copy, Debug)]
struct Still(Vec3);

impl Motion for Still {
    fn offset(&self, _start: Vec3, _time: f64) -> Vec3 {
        self.0
    }

    fn velocity(&self, _start: Vec3, _time: f64) -> Vec3 {
        Vec3::ZERO
    }

    fn rests(&self) -> bool {
        true
    }
}

impl RigidMotion {
    /// Carried off once and for all [m].
    pub fn at(offset: Vec3) -> Self {
        Self { translation: Some(Arc::new(Still(offset))), ..Self::default() }
    }

    pub fn pose(&self, time: f64) -> Pose {
        let pivot = self.pivot;
        let (offset, velocity) = prescribed(&self.translation, pivot, time);
        let (angle, rate) = prescribed(&self.rotation, pivot, time);
        let turn = if self.rotation.is_some() { exponential(angle) } else { Mat3::IDENTITY };
        Pose { origin: pivot + offset, turn, pivot, velocity, angular_velocity: left_jacobian(angle) * rate }
    }
}

/// The motion of a point that is carried along.
impl Motion for RigidMotion {
    fn offset(&self, start: Vec3, time: f64) -> Vec3 {
        let pose = self.pose(time);
        pose.to_world(start) - start
    }

    fn velocity(&self, start: Vec3, time: f64) -> Vec3 {
        let pose = self.pose(time);
        pose.velocity + pose.angular_velocity.cross(pose.turn * (start - pose.pivot))
    }

    fn turn(&self, time: f64) -> Mat3 {
        self.pose(time).turn
    }

    fn spin(&self, time: f64) -> Vec3 {
        self.pose(time).angular_velocity
    }

    fn rests(&self) -> bool {
        [&self.translation, &self.rotation].into_iter().flatten().all(|motion| motion.rests())
    }
}

/// A rigid motion within another one: what `inner` leads where `outer` rests is led on by `outer`.
#[derive(Clone, Debug)]
pub struct NestedMotion {
    pub inner: Arc<dyn Motion>,
    pub outer: Arc<dyn Motion>,
}

impl Motion for NestedMotion {
    fn offset(&self, start: Vec3, time: f64) -> Vec3 {
        let inner = self.inner.offset(start, time);
        inner + self.outer.offset(start + inner, time)
    }

    fn velocity(&self, start: Vec3, time: f64) -> Vec3 {
        let place = start + self.inner.offset(start, time);
        self.outer.velocity(place, time) + self.outer.turn(time) * self.inner.velocity(start, time)
    }

    fn turn(&self, time: f64) -> Mat3 {
        self.outer.turn(time) * self.inner.turn(time)
    }

    fn spin(&self, time: f64) -> Vec3 {
        self.outer.spin(time) + self.outer.turn(time) * self.inner.spin(time)
    }
}

fn prescribed(motion: &Option<Arc<dyn Motion>>, start: Vec3, time: f64) -> (Vec3, Vec3) {
    motion.as_ref().map_or((Vec3::ZERO, Vec3::ZERO), |m| (m.offset(start, time), m.velocity(start, time)))
}

impl Pose {
    /// World position of a place of the shape.
    pub fn to_world(&self, shape: Vec3) -> Vec3 {
        self.origin + self.turn * (shape - self.pivot)
    }

    pub fn to_shape(&self, world: Vec3) -> Vec3 {
        self.pivot + self.turn.transpose() * (world - self.origin)
    }

    /// Velocity relative to the shape, in its axes.
    pub fn velocity_to_shape(&self, world: Vec3, velocity: Vec3) -> Vec3 {
        self.turn.transpose() * (velocity - self.velocity - self.angular_velocity.cross(world - self.origin))
    }

    /// Derivative of [`Pose::velocity_to_shape`] for changes of position and velocity.
    pub fn velocity_change_to_shape(&self, position: Vec3, velocity: Vec3) -> Vec3 {
        self.turn.transpose() * (velocity - self.angular_velocity.cross(position))
    }

    pub fn direction_to_shape(&self, world: Vec3) -> Vec3 {
        self.turn.transpose() * world
    }

    pub fn direction_to_world(&self, shape: Vec3) -> Vec3 {
        self.turn * shape
    }

    /// A map of directions in the shape's place as one of directions in the world.
    pub fn tensor_to_world(&self, shape: &Mat3) -> Mat3 {
        self.turn * shape.mul_transpose(&self.turn)
    }
}

/// `J(θ)` with `ω = J(θ) θ̇`: `I + (1 - cos θ)/θ² [θ]× + (θ - sin θ)/θ³ [θ]×²`.
fn left_jacobian(theta: Vec3) -> Mat3 {
    let angle_sq = theta.length_sq();
    // series below the switch: the next terms are θ⁴/720 and θ⁴/5040, under rounding
    let (linear, quadratic) = if angle_sq < 1e-6 {
        (0.5 - angle_sq / 24.0, 1.0 / 6.0 - angle_sq / 120.0)
    } else {
        let angle = angle_sq.sqrt();
        ((1.0 - libm::cos(angle)) / angle_sq, (angle - libm::sin(angle)) / (angle_sq * angle))
    };
    let skew = theta.cross_matrix();
    Mat3::IDENTITY + skew * linear + (skew * skew) * quadratic
}
