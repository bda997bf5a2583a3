//! A cylinder with round ends.

use souple_math::{Mat3, Vec3};
use souple_table::{Parameter, Range};

use super::{HOLLOW, Nearest, Outline, Shape, ShapeEntry, boxed, is_beyond, rounded, rounded_surface};

/// All points within a radius of a segment; a segment of no length is a ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule {
    /// Ends of the segment [m].
    pub from: Vec3,
    pub to: Vec3,
    /// [m]
    pub radius: f64,
}

impl Shape for Capsule {
    fn nearest(&self, point: Vec3, reach: f64) -> Option<Nearest> {
        let along = self.to - self.from;
        // of a segment of no length 0/0, which clamps to no number: its ball answers below
        let share = ((point - self.from).dot(along) / along.length_sq()).clamp(0.0, 1.0);
        if !point.is_finite() || is_beyond(point, self.from + along * share, self.radius + reach) {
            return None;
        }
        let Some(axis) = along.try_normalised() else {
            return Some(rounded(point, self.from, self.radius, Mat3::ZERO, Vec3::Z));
        };
        let place = (point - self.from).dot(axis);
        let length = along.length();
        let (centre, flat) = if place <= 0.0 {
            (self.from, Mat3::ZERO)
        } else if place >= length {
            (self.to, Mat3::ZERO)
        } else {
            (self.from + axis * place, axis.outer(axis))
        };
        Some(rounded(point, centre, self.radius, flat, axis.any_orthogonal()))
    }

    fn is_distance(&self) -> bool {
        true
    }

    fn parts(&self) -> &[Capsule] {
        std::slice::from_ref(self)
    }

    fn outline(&self) -> Option<Outline> {
        Some(Outline::solid(rounded_surface(self.from, self.to, self.radius)))
    }
}

pub(super) const ENTRY: ShapeEntry = ShapeEntry {
    name: "capsule",
    summary: "a cylinder with round ends: fingers, pipes, rods",
    source: "analytic",
    parameters: &[
        Parameter::vector("from", "m", "centre of one end"),
        Parameter::vector("to", "m", "centre of the other end"),
        Parameter::number("radius", "m", Range::POSITIVE, "its radius"),
        HOLLOW,
    ],
    build: |values, _| {
        let end = |name| Vec3::from_array(values.vector(name));
        let capsule = Capsule { from: end("from"), to: end("to"), radius: values.number("radius") };
        Ok(boxed(capsule, values))
    },
};
