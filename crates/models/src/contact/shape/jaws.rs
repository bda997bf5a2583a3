//! Two fingers of a forceps: rounded rods that meet at a hinge.

use souple_math::Vec3;
use souple_mesh::TriangleSurface;
use souple_table::{Parameter, Range, Value};

use super::{Capsule, Nearest, Outline, Shape, ShapeEntry, direction, rounded_surface};

/// Two rods from one hinge, opened by an angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jaws {
    rods: [Capsule; 2],
}

impl Jaws {
    /// Rods of `length` [m] from `hinge`, half of `opening` [rad] to each side of `forward` about `axis`, both unit vectors.
    pub fn new(hinge: Vec3, [forward, axis]: [Vec3; 2], length: f64, radius: f64, opening: f64) -> Self {
        let aside = axis.cross(forward).try_normalised().unwrap_or_else(|| forward.any_orthogonal());
        let rod = |angle: f64| {
            let along = forward * libm::cos(angle) + aside * libm::sin(angle);
            Capsule { from: hinge, to: hinge + along * length, radius }
        };
        Self { rods: [rod(0.5 * opening), rod(-0.5 * opening)] }
    }
}

impl Shape for Jaws {
    /// Of the nearer rod; between them, where both are as near, of the first.
    fn nearest(&self, point: Vec3, reach: f64) -> Option<Nearest> {
        let [a, b] = self.rods.map(|rod| rod.nearest(point, reach));
        match (a, b) {
            (Some(a), Some(b)) => Some(if b.distance < a.distance { b } else { a }),
            (a, b) => a.or(b),
        }
    }

    fn is_distance(&self) -> bool {
        true
    }

    fn parts(&self) -> &[Capsule] {
        &self.rods
    }

    fn outline(&self) -> Option<Outline> {
        let mut whole = TriangleSurface::default();
        for Capsule { from, to, radius } in self.rods {
            let rod = rounded_surface(from, to, radius);
            let first = whole.points.len() as u32;
            whole.points.extend(rod.points);
            whole.triangles.extend(rod.triangles.iter().map(|corners| corners.map(|point| first + point)));
        }
        Some(Outline::solid(whole))
    }
}

pub(super) const ENTRY: ShapeEntry = ShapeEntry {
    name: "jaws",
    summary: "two rounded rods opened at a hinge: forceps, hooks, spreaders; rods that close are two capsules that turn",
    source: "analytic",
    parameters: &[
        Parameter::vector("hinge", "m", "where the rods meet"),
        Parameter::vector("forward", "", "where they point, closed"),
        Parameter::vector("axis", "", "about which they open").or(Value::Vector([1.0, 0.0, 0.0])),
        Parameter::number("length", "m", Range::POSITIVE, "of a rod"),
        Parameter::number("radius", "m", Range::POSITIVE, "of a rod"),
        Parameter::number("opening", "rad", Range::closed(0.0, std::f64::consts::PI), "angle between them")
            .or(Value::Number(0.5)),
    ],
    build: |values, _| {
        let (forward, axis) = (direction("forward", values)?, direction("axis", values)?);
        // across the way they point
        let across = axis - forward * axis.dot(forward);
        let axis = across.try_normalised().unwrap_or_else(|| forward.any_orthogonal());
        let hinge = Vec3::from_array(values.vector("hinge"));
        let number = |name| values.number(name);
        let jaws = Jaws::new(hinge, [forward, axis], number("length"), number("radius"), number("opening"));
        Ok(Box::new(jaws))
    },
};
