//! What forces keep bodies away from, as pictures show it.

use std::sync::Arc;

use souple_math::Vec3;

use crate::Motion;

/// A rigid thing that bodies may touch.
#[derive(Clone, Debug)]
pub struct Obstacle {
    /// Forces against one and the same thing give it one name.
    pub name: String,
    /// As it is written, before it moves.
    pub form: Form,
    /// How its points are carried along.
    pub motion: Arc<dyn Motion>,
}

/// Where an obstacle is.
#[derive(Clone, Debug, PartialEq)]
pub enum Form {
    Plane {
        /// [m]
        point: Vec3,
        /// Unit normal, towards the free side.
        normal: Vec3,
    },
    /// A closed surface.
    Surface {
        /// [m]
        points: Vec<Vec3>,
        /// Corners in the order that turns left seen from where bodies are.
        triangles: Vec<[u32; 3]>,
        bodies: Side,
    },
}

/// On which side of a closed surface bodies are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    Outside,
    Inside,
}

impl Obstacle {
    /// Where a point of it is at a time [m].
    pub fn place(&self, point: Vec3, time: f64) -> Vec3 {
        point + self.motion.offset(point, time)
    }

    /// Where a direction at a point of it points at a time; unit for a unit vector, as the motion is rigid.
    pub fn direction(&self, point: Vec3, direction: Vec3, time: f64) -> Vec3 {
        direction + self.motion.offset(point + direction, time) - self.motion.offset(point, time)
    }
}
