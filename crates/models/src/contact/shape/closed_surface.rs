//! The inside of a closed triangulated surface.

use souple_math::{Mat3, Vec3};
use souple_mesh::{MeshError, SignedDistance, TriangleSurface};
use souple_table::{Parameter, Range, Value};

use super::{HOLLOW, Nearest, Outline, Shape, ShapeEntry, ShapeError, boxed};

/// Signed distance to a closed surface of triangles.
#[derive(Clone, Debug)]
pub struct ClosedSurface {
    distance: SignedDistance,
}

/// Closer than this part of the surface's size, the direction to the nearest point is lost in rounding and the
/// surface's own normal serves.
const ON_SURFACE: f64 = 1e-12;

impl ClosedSurface {
    /// # Errors
    /// The surface is open, empty or has a triangle without area.
    pub fn new(surface: TriangleSurface) -> Result<Self, MeshError> {
        Ok(Self { distance: SignedDistance::new(surface)? })
    }
}

impl Shape for ClosedSurface {
    fn nearest(&self, point: Vec3, reach: f64) -> Option<Nearest> {
        let bounds = self.distance.surface().bounds();
        if !bounds.grown(reach).contains(point) {
            return None;
        }
        let closest = self.distance.closest(point)?;
        let n = (point - closest.position) * closest.distance.recip();
        if closest.distance.abs() <= ON_SURFACE * bounds.diagonal() || !n.is_finite() {
            let curvature = Mat3::ZERO;
            return Some(Nearest { distance: closest.distance, normal: closest.normal, curvature });
        }
        // the nearest point follows over a face and along an edge, and stays at a corner
        let corners = self.distance.surface().corners(closest.triangle);
        let [a, b, c] = corners;
        let along = |edge: Vec3| edge.try_normalised().map_or(Mat3::ZERO, |edge| edge.outer(edge));
        let flat = match closest.weights.map(|weight| weight == 0.0) {
            [false, false, false] => Mat3::IDENTITY - n.outer(n),
            [true, false, false] => along(b - c),
            [false, true, false] => along(c - a),
            [false, false, true] => along(a - b),
            _ => Mat3::ZERO,
        };
        let curvature = (Mat3::IDENTITY - n.outer(n) - flat) * closest.distance.recip();
        Some(Nearest { distance: closest.distance, normal: n, curvature })
    }

    fn is_distance(&self) -> bool {
        true
    }

    fn outline(&self) -> Option<Outline> {
        Some(Outline::solid(self.distance.surface().clone()))
    }
}

pub(super) const ENTRY: ShapeEntry = ShapeEntry {
    name: "closed_surface",
    summary: "the inside of a closed triangulated surface: bones, moulds, tools",
    source: "Bærentzen & Aanæs 2005, Signed distance computation using the angle weighted pseudonormal",
    parameters: &[
        Parameter::text("surface", "file of a closed triangulated surface"),
        Parameter::number("scale", "", Range::POSITIVE, "metres in one unit of the file")
            .or(Value::Number(1.0)),
        HOLLOW,
    ],
    build: |values, source| {
        let (field, name) = ("surface", values.text("surface"));
        let mut surface = source(name).map_err(|message| ShapeError::NoSurface {
            field,
            surface: name.to_owned(),
            message,
        })?;
        let scale = values.number("scale");
        surface.points.iter_mut().for_each(|point| *point = *point * scale);
        let wrong = |error| ShapeError::Surface { field, surface: name.to_owned(), error: Box::new(error) };
        let closed = ClosedSurface::new(surface).map_err(wrong)?;
        Ok(boxed(closed, values))
    },
};
