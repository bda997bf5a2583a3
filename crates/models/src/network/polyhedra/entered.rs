//! Whether bodies begin within each other.

use souple_math::Vec3;
use souple_mesh::{TriangleSurface, WindingNumber, closest_point_on_triangle};

use super::Polyhedra;
use super::features::Features;
use super::meeting::foot_on_plane;

/// What has entered another body at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entered {
    /// Numbers of the bodies; the first has entered the second.
    pub bodies: [usize; 2],
    /// A row of what has entered.
    pub row: u32,
}

impl Polyhedra {
    /// The first body that has entered another farther than `tolerance` [m] where rows are: by an edge that passes through a face, by a corner inside, or by a ball.
    pub fn entered(&self, positions: &[Vec3], tolerance: f64) -> Option<Entered> {
        let features = &self.features;
        let count = features.bodies.len();
        let pairs = (0..count).flat_map(|one| (0..count).map(move |other| [one, other]));
        pairs
            .filter(|[one, other]| one != other && features.may_meet([*one.min(other), *one.max(other)]))
            .find_map(|bodies| {
                let row = features.entered(bodies, positions, tolerance)?;
                Some(Entered { bodies, row })
            })
    }
}

impl Features {
    /// A row of the first body that is in the second, or whose edge is.
    fn entered(&self, [one, other]: [usize; 2], positions: &[Vec3], tolerance: f64) -> Option<u32> {
        let (one, other) = (&self.bodies[one], &self.bodies[other]);
        let faces = &self.faces[other.faces.clone()];
        let places = |face: &[u32; 3]| face.map(|row| positions[row as usize]);
        let [own, around] = [one, other].map(|body| {
            let rows = self.corners[body.corners.clone()].iter().map(|corner| corner.row as usize);
            bounds(rows.map(|row| positions[row]))
        });
        let reach = one.radius - tolerance;
        let is_apart =
            |axis: usize| own.1[axis] + reach < around.0[axis] || around.1[axis] + reach < own.0[axis];
        if faces.is_empty() || (0..3).any(is_apart) {
            return None;
        }
        let passes = self.edges[one.edges.clone()].iter().find(|edge| {
            let ends = edge.places(positions);
            faces.iter().any(|face| passes_through(ends, places(face), tolerance))
        });
        if let Some(edge) = passes {
            return Some(edge.ends[0]);
        }
        let corners = self.corners[one.corners.clone()].iter().map(|corner| corner.row);
        let surface = TriangleSurface {
            points: positions.to_vec(),
            triangles: faces.to_vec(),
            ..TriangleSurface::default()
        };
        let winding = WindingNumber::new(&surface);
        corners.into_iter().find(|row| {
            let point = positions[*row as usize];
            let distance = |corners: [Vec3; 3]| {
                let (weights, _) = closest_point_on_triangle(point, corners);
                let nearest: Vec3 =
                    corners.into_iter().zip(weights).map(|(corner, weight)| corner * weight).sum();
                (point - nearest).length()
            };
            let nearest = faces.iter().map(|face| distance(places(face))).fold(f64::INFINITY, f64::min);
            nearest < reach || (nearest > tolerance && winding.at(point) > 0.5)
        })
    }
}

fn bounds(places: impl Iterator<Item = Vec3>) -> (Vec3, Vec3) {
    let (least, most) = (f64::NEG_INFINITY, f64::INFINITY);
    let nothing = (Vec3::new(most, most, most), Vec3::new(least, least, least));
    places.fold(nothing, |(low, high), place| (low.min_components(place), high.max_components(place)))
}

/// Whether a segment passes through a triangle, by more than a tolerance on both sides and within its border.
fn passes_through([a, b]: [Vec3; 2], triangle: [Vec3; 3], tolerance: f64) -> bool {
    let Some(normal) = foot_on_plane(triangle, a).1 else { return false };
    let [from, to] = [a, b].map(|end| normal.dot(end - triangle[0]));
    if from.min(to) > -tolerance || from.max(to) < tolerance {
        return false;
    }
    let through = a + (b - a) * (from / (from - to));
    (0..3).all(|at| {
        let (start, end) = (triangle[at], triangle[(at + 1) % 3]);
        let inward = normal.cross(end - start);
        inward.dot(through - start) > tolerance * inward.length()
    })
}
