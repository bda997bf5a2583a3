//! Whether bodies begin within each other.

use std::cell::OnceCell;

use souple_math::Vec3;
use souple_mesh::{TriangleSurface, WindingNumber, closest_point_on_triangle};

use super::Polyhedra;
use super::features::{Edge, Features};
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
        let start = Start::new(&self.features, positions, tolerance);
        let count = self.features.bodies.len();
        let pairs = (0..count).flat_map(|one| (0..count).map(move |other| [one, other]));
        pairs
            .filter(|[one, other]| one != other && self.features.may_meet([*one.min(other), *one.max(other)]))
            .find_map(|bodies| Some(Entered { bodies, row: start.entered(bodies)? }))
    }
}

/// Where all bodies begin.
struct Start<'a> {
    features: &'a Features,
    positions: &'a [Vec3],
    tolerance: f64,
    /// Of each body what is within it, made where that is asked for first.
    insides: Vec<OnceCell<Inside<'a>>>,
}

impl<'a> Start<'a> {
    fn new(features: &'a Features, positions: &'a [Vec3], tolerance: f64) -> Self {
        let insides = features.bodies.iter().map(|_| OnceCell::new()).collect();
        Self { features, positions, tolerance, insides }
    }

    fn faces(&self, body: usize) -> &'a [[u32; 3]] {
        &self.features.faces[self.features.bodies[body].faces.clone()]
    }

    fn edges(&self, body: usize) -> &'a [Edge] {
        &self.features.edges[self.features.bodies[body].edges.clone()]
    }

    fn inside(&self, body: usize) -> &Inside<'a> {
        self.insides[body].get_or_init(|| Inside::new(self.faces(body), self.positions))
    }

    /// A row of the first body that is in the second, or whose edge is.
    fn entered(&self, [one, other]: [usize; 2]) -> Option<u32> {
        let Self { features, positions, tolerance, .. } = *self;
        let faces = self.faces(other);
        let corners = |body: usize| {
            let corners = features.corners[features.bodies[body].corners.clone()].iter();
            corners.map(|corner| corner.row)
        };
        let [own, around] = [one, other].map(|body| bounds(corners(body).map(|row| positions[row as usize])));
        let reach = features.bodies[one].radius - tolerance;
        let is_apart =
            |axis: usize| own.1[axis] + reach < around.0[axis] || around.1[axis] + reach < own.0[axis];
        if faces.is_empty() || (0..3).any(is_apart) {
            return None;
        }
        let places = |face: &[u32; 3]| face.map(|row| positions[row as usize]);
        let passes = self.edges(one).iter().find(|edge| {
            let ends = edge.places(positions);
            faces.iter().any(|face| passes_through(ends, places(face), tolerance))
        });
        if let Some(edge) = passes {
            return Some(edge.ends[0]);
        }
        let inside = self.inside(other);
        let corner = corners(one).find(|row| {
            let point = positions[*row as usize];
            inside.nearest(point) < reach || inside.holds(point, tolerance)
        });
        corner.or_else(|| self.entered_between(one, inside))
    }

    /// The same by what lies between corners, all of which may be on faces of the other: a row of an edge between where it crosses
    /// these, of the middle of a face, or of what is just below it.
    fn entered_between(&self, one: usize, inside: &Inside) -> Option<u32> {
        let tolerance = self.tolerance;
        let edge = self.edges(one).iter().find(|edge| {
            let [a, b] = edge.places(self.positions);
            let parts = inside.crossed_by([a, b], tolerance);
            let mut middles = parts.windows(2).map(|ends| a + (b - a) * (0.5 * (ends[0] + ends[1])));
            middles.any(|middle| inside.holds(middle, tolerance))
        });
        if let Some(edge) = edge {
            return Some(edge.ends[0]);
        }
        let face = self.faces(one).iter().find(|face| {
            let [a, b, c] = face.map(|row| self.positions[row as usize]);
            let (middle, area) = ((a + b + c) / 3.0, (b - a).cross(c - a));
            let Some(normal) = area.try_normalised() else { return false };
            let below = middle - normal * (BELOW * area.length().sqrt());
            inside.holds(middle, tolerance)
                || (inside.holds(below, tolerance) && self.inside(one).holds(below, tolerance))
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
        let corners = faces.as_flattened().iter().map(|row| positions[*row as usize]);
        let triangles = (0..faces.len() as u32).map(|face| [0, 1, 2].map(|corner| 3 * face + corner));
        let surface = TriangleSurface {
            points: corners.collect(),
            triangles: triangles.collect(),
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
            let is_crossed = share > 0.0 && share < 1.0;
            (is_crossed && is_within(triangle, normal, a + (b - a) * share, -tolerance)).then_some(share)
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
    is_within(triangle, normal, a + (b - a) * (from / (from - to)), tolerance)
}

/// Whether a point in the plane of a triangle is inside each of its borders by more than a margin, which may be below zero.
fn is_within(triangle: [Vec3; 3], normal: Vec3, point: Vec3, margin: f64) -> bool {
    (0..3).all(|at| {
        let (start, end) = (triangle[at], triangle[(at + 1) % 3]);
        let inward = normal.cross(end - start);
        inward.dot(point - start) > margin * inward.length()
    })
}
