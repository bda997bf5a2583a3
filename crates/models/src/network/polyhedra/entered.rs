//! Whether bodies begin within each other.

use souple_math::Vec3;
use souple_mesh::{TriangleSurface, WindingNumber, closest_point_on_triangle};

use super::Polyhedra;
use super::features::{Body, Features};
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
    /// The first body that has entered another farther than `tolerance` [m] where rows are: by an edge that passes through a face, by a corner, a part of an edge
    /// or the middle of a face inside, or by a ball.
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
        let inside = Inside::new(faces, positions);
        let corners = self.corners[one.corners.clone()].iter().map(|corner| corner.row);
        let corner = corners.into_iter().find(|row| {
            let point = positions[*row as usize];
            inside.nearest(point) < reach || inside.holds(point, tolerance)
        });
        corner.or_else(|| self.entered_between(one, &inside, tolerance))
    }

    /// The same by what lies between corners, all of which may be on faces of the other: a row of an edge between where it crosses
    /// these, of the middle of a face, or of what is just below it.
    fn entered_between(&self, one: &Body, inside: &Inside, tolerance: f64) -> Option<u32> {
        let edges = &self.edges[one.edges.clone()];
        let edge = edges.iter().find(|edge| {
            let [a, b] = edge.places(inside.positions);
            let parts = inside.crossed_by([a, b], tolerance);
            let mut middles = parts.windows(2).map(|ends| a + (b - a) * (0.5 * (ends[0] + ends[1])));
            middles.any(|middle| inside.holds(middle, tolerance))
        });
        if let Some(edge) = edge {
            return Some(edge.ends[0]);
        }
        let faces = &self.faces[one.faces.clone()];
        let own = Inside::new(faces, inside.positions);
        let face = faces.iter().find(|face| {
            let [a, b, c] = face.map(|row| inside.positions[row as usize]);
            let (middle, area) = ((a + b + c) / 3.0, (b - a).cross(c - a));
            let Some(normal) = area.try_normalised() else { return false };
            let below = middle - normal * (BELOW * area.length().sqrt());
            inside.holds(middle, tolerance) || (own.holds(below, tolerance) && inside.holds(below, tolerance))
        });
        face.map(|face| face[0])
    }
}

/// How far below the middle of a face it is looked, as a share of the square root of twice its area.
const BELOW: f64 = 0.01;

/// What is within a surface.
struct Inside<'a> {
    faces: &'a [[u32; 3]],
    positions: &'a [Vec3],
    winding: WindingNumber,
}

impl<'a> Inside<'a> {
    fn new(faces: &'a [[u32; 3]], positions: &'a [Vec3]) -> Self {
        let surface = TriangleSurface {
            points: positions.to_vec(),
            triangles: faces.to_vec(),
            ..TriangleSurface::default()
        };
        Self { faces, positions, winding: WindingNumber::new(&surface) }
    }

    fn places(&self) -> impl Iterator<Item = [Vec3; 3]> {
        self.faces.iter().map(|face| face.map(|row| self.positions[row as usize]))
    }

    /// How far the nearest face is.
    fn nearest(&self, point: Vec3) -> f64 {
        let distance = |corners: [Vec3; 3]| {
            let (weights, _) = closest_point_on_triangle(point, corners);
            let nearest: Vec3 =
                corners.into_iter().zip(weights).map(|(corner, weight)| corner * weight).sum();
            (point - nearest).length()
        };
        self.places().map(distance).fold(f64::INFINITY, f64::min)
    }

    /// Whether a point is within the surface, farther than a tolerance from it.
    fn holds(&self, point: Vec3, tolerance: f64) -> bool {
        self.winding.at(point) > 0.5 && self.nearest(point) > tolerance
    }

    /// Where a segment begins, comes through faces or their borders, and ends, as shares of it, ascending.
    fn crossed_by(&self, [a, b]: [Vec3; 2], tolerance: f64) -> Vec<f64> {
        let crossing = |triangle: [Vec3; 3]| {
            let normal = foot_on_plane(triangle, a).1?;
            let [from, to] = [a, b].map(|end| normal.dot(end - triangle[0]));
            let share = from / (from - to);
            let through = a + (b - a) * share;
            let is_within = within_border(triangle, normal, through) >= -tolerance;
            (share > 0.0 && share < 1.0 && is_within).then_some(share)
        };
        let mut shares: Vec<f64> = [0.0, 1.0].into_iter().chain(self.places().filter_map(crossing)).collect();
        shares.sort_by(f64::total_cmp);
        shares
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
    within_border(triangle, normal, through) > tolerance
}

/// How far a point of the plane of a triangle is from the nearest of its sides, below 0 beyond one [m].
fn within_border(triangle: [Vec3; 3], normal: Vec3, point: Vec3) -> f64 {
    let from_side = |at: usize| {
        let (start, end) = (triangle[at], triangle[(at + 1) % 3]);
        let inward = normal.cross(end - start);
        inward.dot(point - start) / inward.length()
    };
    (0..3).map(from_side).fold(f64::INFINITY, f64::min)
}
