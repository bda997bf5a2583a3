//! A ball.

use souple_math::{Mat3, Vec3};
use souple_table::{Parameter, Range, Value};

use super::{
    Capsule, HOLLOW, Nearest, Outline, Shape, ShapeEntry, boxed, is_beyond, rounded, rounded_surface,
};

/// At the very centre the nearest point is taken along z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// [m]
    pub centre: Vec3,
    /// [m]
    pub radius: f64,
    /// The same as a rounded part of no length.
    part: Capsule,
}

impl Sphere {
    pub fn new(centre: Vec3, radius: f64) -> Self {
        Self { centre, radius, part: Capsule { from: centre, to: centre, radius } }
    }
}

impl Shape for Sphere {
    fn nearest(&self, point: Vec3, reach: f64) -> Option<Nearest> {
        if !point.is_finite() || is_beyond(point, self.centre, self.radius + reach) {
            return None;
        }
        Some(rounded(point, self.centre, self.radius, Mat3::ZERO, Vec3::Z))
    }

    fn is_distance(&self) -> bool {
        true
    }

    fn parts(&self) -> &[Capsule] {
        std::slice::from_ref(&self.part)
    }

    fn outline(&self) -> Option<Outline> {
        Some(Outline::solid(rounded_surface(self.centre, self.centre, self.radius)))
    }
}

pub(super) const ENTRY: ShapeEntry = ShapeEntry {
    name: "sphere",
    summary: "a ball, or a round container",
    source: "analytic",
    parameters: &[
        Parameter::vector("centre", "m", "its centre").or(Value::Vector([0.0; 3])),
        Parameter::number("radius", "m", Range::POSITIVE, "its radius"),
        HOLLOW,
    ],
    build: |values, _| {
        let sphere = Sphere::new(Vec3::from_array(values.vector("centre")), values.number("radius"));
        Ok(boxed(sphere, values))
    },
};
