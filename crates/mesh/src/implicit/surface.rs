//! The inside of triangles as a shape, also of triangles with faults.

use souple_math::Vec3;

use super::{Shape, around};
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
    Wound {
        surface: TriangleSurface,
        tree: AabbTree,
        winding: WindingNumber,
        /// Whether it winds around everything a whole number of times, which changes at its triangles alone.
        is_closed: bool,
    },
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
        let distance = exact.map_or_else(|| wound(surface, diagnosis.is_closed()), Distance::Exact);
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

    /// How much of what the surface winds around it does so by no whole number: the volume where the winding number is far from
    /// one, over that where it is above one half, both on a grid of points; above one for sheets and halves of shapes, zero where
    /// normals decide.
    pub fn undefined_share(&self) -> f64 {
        let Distance::Wound { winding, .. } = &self.distance else { return 0.0 };
        let extent = self.bounds.size();
        let at = |index: usize, axis: usize| {
            let place = index / GRID.pow(axis as u32) % GRID;
            self.bounds.low[axis] + extent[axis] * (place as f64 + 0.5) / GRID as f64
        };
        let (mut inside, mut undefined) = (0_u32, 0_u32);
        for index in 0..GRID.pow(3) {
            let number = winding.at(Vec3::new(at(index, 0), at(index, 1), at(index, 2)));
            inside += u32::from(number > 0.5);
            undefined += u32::from((number - number.round()).abs() > WHOLE);
        }
        f64::from(undefined) / f64::from(inside.max(1))
    }
}

/// Points along each axis at which it is asked how often a surface winds around them.
const GRID: usize = 24;
/// How far from a whole number a winding number is still one: dipoles are off by 0.02, and small holes by their share of the sphere.
const WHOLE: f64 = 0.15;

fn wound(surface: TriangleSurface, is_closed: bool) -> Distance {
    let boxes: Vec<Aabb> =
        (0..surface.triangles.len() as u32).map(|triangle| Aabb::of(surface.corners(triangle))).collect();
    let (tree, winding) = (AabbTree::build(&boxes), WindingNumber::new(&surface));
    Distance::Wound { surface, tree, winding, is_closed }
}

impl Shape for SurfaceShape {
    fn value(&self, point: Vec3) -> f64 {
        match &self.distance {
            Distance::Exact(distance) => distance.distance(point),
            Distance::Wound { surface, tree, winding, .. } => {
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

    fn range(&self, within: BoundingBox) -> Option<[f64; 2]> {
        match &self.distance {
            Distance::Exact(_) | Distance::Wound { is_closed: true, .. } => {
                Some(around(self.value(within.centre()), 0.5 * within.diagonal()))
            }
            // what holes leave open may change sides far from all triangles
            Distance::Wound { is_closed: false, .. } => None,
        }
    }

    fn bounds(&self) -> BoundingBox {
        self.bounds
    }
}

#[cfg(test)]
mod tests {
    use souple_table::{Value, Values};

    use super::*;

    /// A ball around the origin and another of the same triangles, scaled and moved.
    fn two_balls(scale: f64, centre: Vec3) -> TriangleSurface {
        let values = Values::new().with("radius", Value::Number(1.0)).with("cells", Value::Integer(4));
        let ball = crate::generate("sphere", values).unwrap().boundary_surface();
        let count = ball.points.len() as u32;
        let points: Vec<Vec3> =
            ball.points.iter().copied().chain(ball.points.iter().map(|p| *p * scale + centre)).collect();
        let moved = ball.triangles.iter().map(|corners| corners.map(|corner| corner + count));
        let triangles: Vec<[u32; 3]> = ball.triangles.iter().copied().chain(moved).collect();
        TriangleSurface::from_mesh(&points, &triangles, Vec::new())
    }

    /// A ball within a ball that faces the same way is solid through and through; one that faces inward is a hollow.
    #[test]
    fn parts_within_each_other() {
        let solid = SurfaceShape::new(two_balls(0.5, Vec3::ZERO)).unwrap();
        assert_eq!(solid.sign(), Sign::WindingNumber);
        for x in [0.1, 0.55, 0.9] {
            assert!(solid.value(Vec3::new(x, 0.0, 0.0)) < 0.0, "{x}");
        }
        let mut hollow = two_balls(0.5, Vec3::ZERO);
        let half = hollow.triangles.len() / 2;
        hollow.triangles[half..].iter_mut().for_each(|corners| corners.swap(1, 2));
        let hollow = SurfaceShape::new(hollow).unwrap();
        assert_eq!(hollow.sign(), Sign::Normals);
        assert!(hollow.value(Vec3::ZERO) > 0.0 && hollow.value(Vec3::new(0.75, 0.0, 0.0)) < 0.0);
    }

    /// Of two cubes the edges of one meet faces of the other exactly on their diagonals, where no triangle passes through
    /// another; what both hold is inside all the same.
    #[test]
    fn parts_that_meet_on_diagonals() {
        let values = souple_table::Values::new()
            .with("size", souple_table::Value::Vector([1.0; 3]))
            .with("cells", souple_table::Value::Vector([1.0; 3]));
        let cube = crate::generate("box", values).unwrap().boundary_surface();
        let count = cube.points.len() as u32;
        let half = Vec3::new(0.5, 0.5, 0.5);
        let points: Vec<Vec3> =
            cube.points.iter().copied().chain(cube.points.iter().map(|p| *p + half)).collect();
        let moved = cube.triangles.iter().map(|corners| corners.map(|corner| corner + count));
        let triangles: Vec<[u32; 3]> = cube.triangles.iter().copied().chain(moved).collect();
        let shape = SurfaceShape::new(TriangleSurface::from_mesh(&points, &triangles, Vec::new())).unwrap();
        assert_eq!(shape.sign(), Sign::WindingNumber);
        let low = cube.bounds().low;
        for inside in [0.05, 0.45, 0.55, 0.75, 0.95, 1.05, 1.45] {
            let place = low + Vec3::new(inside, inside, inside);
            assert!(shape.value(place) < 0.0, "{inside}");
        }
        assert!(shape.value(low + Vec3::new(1.2, 0.2, 0.2)) > 0.0);
    }

    /// Of balls that cross, boxes away from all triangles are known to be inside or outside without a look at each point; of one with
    /// a hole nothing is known of a box.
    #[test]
    fn ranges_hold_between_crossings() {
        let shape = SurfaceShape::new(two_balls(1.0, Vec3::new(1.0, 0.1, 0.2))).unwrap();
        assert_eq!(shape.sign(), Sign::WindingNumber);
        let mut decided = 0;
        for index in 0..9_usize.pow(3) {
            let place = |axis: u32| -1.5 + 0.5 * (index / 9_usize.pow(axis) % 9) as f64;
            let low = Vec3::new(place(0), place(1), place(2));
            let within = BoundingBox { low, high: low + Vec3::new(0.3, 0.3, 0.3) };
            let [least, most] = shape.range(within).unwrap();
            for corner in 0..8 {
                let part =
                    |axis: usize| if corner >> axis & 1 == 1 { within.high[axis] } else { within.low[axis] };
                let value = shape.value(Vec3::new(part(0), part(1), part(2)));
                assert!((least..=most).contains(&value), "{value} in {within:?}");
            }
            decided += usize::from(least > 0.0 || most < 0.0);
        }
        assert!(decided > 300, "{decided}");
        let mut open = two_balls(1.0, Vec3::new(1.0, 0.1, 0.2));
        open.triangles.pop();
        assert!(
            SurfaceShape::new(open).unwrap().range(BoundingBox { low: Vec3::ZERO, high: Vec3::X }).is_none()
        );
    }

    #[test]
    fn balls_apart_are_simple() {
        let apart = SurfaceShape::new(two_balls(1.0, Vec3::new(3.0, 0.0, 0.0))).unwrap();
        assert_eq!(apart.sign(), Sign::Normals);
    }
}
