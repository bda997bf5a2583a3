//! The inside of triangles as a shape, also of triangles with faults.

use souple_math::Vec3;

use super::Shape;
use crate::repair::{Diagnosis, diagnose};
use crate::winding::WindingNumber;
use crate::{
    Aabb, AabbTree, BoundingBox, MeshError, SignedDistance, TriangleSurface, closest_point_on_triangle,
};

/// How it is decided what is inside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// By the normals at the closest point: exact, for a closed surface that does not cross itself.
    Normals,
    /// By a winding number above one half: for surfaces with holes, crossings, loose sheets.
    WindingNumber,
}

/// Distance to triangles, negative inside.
pub struct SurfaceShape {
    distance: Distance,
    bounds: BoundingBox,
    diagnosis: Diagnosis,
}

enum Distance {
    Exact(SignedDistance),
    Wound { surface: TriangleSurface, tree: AabbTree, winding: WindingNumber },
}

impl SurfaceShape {
    /// # Errors
    /// There are no triangles.
    pub fn new(surface: TriangleSurface) -> Result<Self, MeshError> {
        if surface.triangles.is_empty() {
            return Err(MeshError::NoCells);
        }
        let diagnosis = diagnose(&surface);
        let bounds = BoundingBox::of(surface.triangles.iter().flatten().map(|p| surface.points[*p as usize]));
        let bounds = bounds.grown(1e-9 * bounds.diagonal());
        let exact = if diagnosis.is_simple() { SignedDistance::new(surface.clone()).ok() } else { None };
        let distance = exact.map_or_else(|| wound(surface), Distance::Exact);
        Ok(Self { distance, bounds, diagnosis })
    }

    pub fn sign(&self) -> Sign {
        match self.distance {
            Distance::Exact(_) => Sign::Normals,
            Distance::Wound { .. } => Sign::WindingNumber,
        }
    }

    pub fn diagnosis(&self) -> &Diagnosis {
        &self.diagnosis
    }
}

fn wound(surface: TriangleSurface) -> Distance {
    let boxes: Vec<Aabb> =
        (0..surface.triangles.len() as u32).map(|triangle| Aabb::of(surface.corners(triangle))).collect();
    Distance::Wound { tree: AabbTree::build(&boxes), winding: WindingNumber::new(&surface), surface }
}

impl Shape for SurfaceShape {
    fn value(&self, point: Vec3) -> f64 {
        match &self.distance {
            Distance::Exact(distance) => distance.distance(point),
            Distance::Wound { surface, tree, winding } => {
                let distance_sq = |triangle: u32| {
                    let corners = surface.corners(triangle);
                    let ([a, b, c], _) = closest_point_on_triangle(point, corners);
                    (corners[0] * a + corners[1] * b + corners[2] * c - point).length_sq()
                };
                let nearest = tree.nearest(point, f64::INFINITY, distance_sq);
                let distance = nearest.map_or(f64::NAN, |(_, distance_sq)| distance_sq.sqrt());
                if winding.at(point) > 0.5 { -distance } else { distance }
            }
        }
    }

    fn bounds(&self) -> BoundingBox {
        self.bounds
    }
}
