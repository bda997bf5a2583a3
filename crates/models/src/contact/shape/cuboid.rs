//! A box, along the axes or turned.

use souple_math::{Mat3, Vec3, exponential};
use souple_mesh::TriangleSurface;
use souple_table::{Parameter, Value};

use super::{HOLLOW, Nearest, Outline, Shape, ShapeEntry, ShapeError, boxed, rounded};

/// Outside, edges and corners are round; inside, the nearest face pushes out, of equally near ones the first along its own
/// x, y, z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid {
    /// [m]
    pub centre: Vec3,
    /// Half the length of its sides [m].
    pub half_size: Vec3,
    /// The directions of its sides, as columns.
    pub axes: Mat3,
}

impl Shape for Cuboid {
    fn nearest(&self, point: Vec3, reach: f64) -> Option<Nearest> {
        if !point.is_finite() {
            return None;
        }
        let local = self.axes.transpose_apply(point - self.centre);
        let beyond = [0, 1, 2].map(|axis: usize| local[axis].abs() - self.half_size[axis]);
        if beyond.iter().any(|distance| *distance > reach) {
            return None;
        }
        let side = |axis: usize| Vec3::AXES[axis] * 1.0_f64.copysign(local[axis]);
        if beyond.iter().all(|distance| *distance <= 0.0) {
            let nearest = (1..3).fold(0, |best, axis| if beyond[axis] > beyond[best] { axis } else { best });
            let normal = self.axes * side(nearest);
            return Some(Nearest { distance: beyond[nearest], normal, curvature: Mat3::ZERO });
        }
        // directions in which the nearest point follows
        let flat = Mat3::from_diagonal(Vec3::from_array(beyond.map(|d| if d > 0.0 { 0.0 } else { 1.0 })));
        let on_surface = local.max_components(-self.half_size).min_components(self.half_size);
        let Nearest { distance, normal, curvature } = rounded(local, on_surface, 0.0, flat, Vec3::Z);
        let curvature = (self.axes * curvature).mul_transpose(&self.axes);
        Some(Nearest { distance, normal: self.axes * normal, curvature })
    }

    fn is_distance(&self) -> bool {
        true
    }

    fn outline(&self) -> Option<Outline> {
        let corner = |index: usize| {
            let side = |axis: usize| if index >> axis & 1 == 0 { -1.0 } else { 1.0 };
            let corner = Vec3::from_array([0, 1, 2].map(|axis| side(axis) * self.half_size[axis]));
            self.centre + self.axes * corner
        };
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
        let surface =
            TriangleSurface { points: (0..8).map(corner).collect(), triangles, ..TriangleSurface::default() };
        Some(Outline::solid(surface))
    }
}

pub(super) const ENTRY: ShapeEntry = ShapeEntry {
    name: "box",
    summary: "a box, or a room",
    source: "analytic",
    parameters: &[
        Parameter::vector("centre", "m", "its centre").or(Value::Vector([0.0; 3])),
        Parameter::vector("size", "m", "length of its sides"),
        Parameter::vector(
            "turn",
            "rad",
            "how it is turned about its centre: along an axis, as long as the angle",
        )
        .or(Value::Vector([0.0; 3])),
        HOLLOW,
    ],
    build: |values, _| {
        let size = values.vector("size");
        if size.iter().any(|length| *length <= 0.0) {
            let expected = "three lengths above 0 [m]";
            return Err(ShapeError::Unfit { field: "size", value: format!("{size:?}"), expected });
        }
        let centre = Vec3::from_array(values.vector("centre"));
        let axes = exponential(Vec3::from_array(values.vector("turn")));
        Ok(boxed(Cuboid { centre, half_size: Vec3::from_array(size) * 0.5, axes }, values))
    },
};
