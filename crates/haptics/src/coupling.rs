//! The spring and damper between device and tool.

use souple_math::Vec3;

use crate::TICK;

/// `F = k (a - b) + c (ȧ - ḃ)`, no longer than `limit` (Colgate, Stanley & Brown 1995, "Issues in the haptic display of tool use").
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coupling {
    /// [N/m]
    pub stiffness: f64,
    /// [N s/m]
    pub damping: f64,
    /// The most that the device can give, and the tool is drawn with [N].
    pub limit: f64,
}

/// A place and its velocity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moving {
    /// [m]
    pub place: Vec3,
    /// [m/s]
    pub velocity: Vec3,
}

impl Coupling {
    /// As firm as desktop devices of a few newtons bear.
    pub const DEFAULT: Self = Self { stiffness: 400.0, damping: 2.0, limit: 5.0 };

    /// The pull on `b` towards `a` [N], not limited.
    pub fn pull(&self, a: Moving, b: Moving) -> Vec3 {
        (a.place - b.place) * self.stiffness + (a.velocity - b.velocity) * self.damping
    }

    /// A damping that an arm bears which bears this coupling, `M > T (k T/2 + c)`: with it a tick `T` does not turn the arm round [N s/m].
    pub fn damping_borne(&self) -> f64 {
        0.5 * TICK * self.stiffness + self.damping
    }

    /// A force no longer than what the device can give.
    pub fn limited(&self, force: Vec3) -> Vec3 {
        let length = force.length();
        if length > self.limit { force * (self.limit / length) } else { force }
    }
}
