//! The half-space below a plane.

use souple_math::{Mat3, Vec3};
use souple_table::{Parameter, Value};

use super::{Nearest, Shape, ShapeEntry, direction};

/// Bodies stay on the side of the normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// A point on it [m].
    pub point: Vec3,
    /// Unit.
    pub normal: Vec3,
}

impl Shape for Plane {
    fn nearest(&self, point: Vec3, _reach: f64) -> Option<Nearest> {
        let distance = (point - self.point).dot(self.normal);
        point.is_finite().then_some(Nearest { distance, normal: self.normal, curvature: Mat3::ZERO })
    }

    fn is_distance(&self) -> bool {
        true
    }

    fn as_plane(&self) -> Option<(Vec3, Vec3)> {
        Some((self.point, self.normal))
    }
}

pub(super) const ENTRY: ShapeEntry = ShapeEntry {
    name: "plane",
    summary: "everything below a plane: floors, walls, inclines",
    source: "analytic",
    parameters: &[
        Parameter::vector("point", "m", "a point on the plane").or(Value::Vector([0.0; 3])),
        Parameter::vector("normal", "", "points to the side where bodies are; of any length")
            .or(Value::Vector([0.0, 1.0, 0.0])),
    ],
    build: |values, _| {
        let (point, normal) = (Vec3::from_array(values.vector("point")), direction("normal", values)?);
        Ok(Box::new(Plane { point, normal }))
    },
};
