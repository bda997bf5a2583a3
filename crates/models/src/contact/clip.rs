//! What of a triangle is inside a rounded part of a tool.
//!
//! The triangle is divided in three at the place that is deepest inside, and these finely and evenly; each piece is clipped where the distance,
//! taken to be linear between the piece's corners, is zero. As the part is convex, what is found lies inside of it, and lacks strips as wide as the
//! sagitta `h²/8r` of a piece of side `h`. What is smaller than a piece is found too, as a polygon around its deepest place.

use souple_math::Vec3;

use super::shape::Capsule;

/// What is inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inside {
    /// [m²]
    pub area: f64,
    /// The integrals over it of the weights of the three corners [m²]; their sum is the area.
    pub shares: [f64; 3],
}

impl Inside {
    /// Weights of the corners at its centroid.
    pub fn weights(&self) -> [f64; 3] {
        self.shares.map(|share| share / self.area)
    }
}

/// Pieces along a side.
const PIECES: usize = 16;

/// A point of the triangle by the weights of its second and third corner, and its distance from the part, negative inside.
#[derive(Clone, Copy)]
struct Spot {
    u: f64,
    v: f64,
    distance: f64,
}

/// `None` where nothing of the triangle is inside, or as good as nothing. `deepest` are the weights of the corners where it is nearest to
/// the middle of the part.
pub fn inside(part: &Capsule, [a, b, c]: [Vec3; 3], deepest: [f64; 3]) -> Option<Inside> {
    let doubled = (b - a).cross(c - a).length();
    let mut sums = [0.0; 3];
    let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    for k in 0..3 {
        let ([u0, v0], [u1, v1], [u2, v2]) = ([deepest[1], deepest[2]], corners[k], corners[(k + 1) % 3]);
        let spot = |i: usize, j: usize| {
            let (s, t) = (i as f64 / PIECES as f64, j as f64 / PIECES as f64);
            let (u, v) = (u0 + (u1 - u0) * s + (u2 - u0) * t, v0 + (v1 - v0) * s + (v2 - v0) * t);
            let place = a + (b - a) * u + (c - a) * v;
            Spot { u, v, distance: part.distance(place) }
        };
        for i in 0..PIECES {
            for j in 0..PIECES - i {
                add_piece([spot(i, j), spot(i + 1, j), spot(i, j + 1)], &mut sums);
                if i + j + 2 <= PIECES {
                    add_piece([spot(i + 1, j), spot(i + 1, j + 1), spot(i, j + 1)], &mut sums);
                }
            }
        }
    }
    let shares = sums.map(|sum| sum * doubled);
    let area = shares.iter().sum::<f64>();
    (area > 0.0).then_some(Inside { area, shares })
}

/// Adds the integrals of the weights over what of a piece is inside, in the plane of `u` and `v`.
fn add_piece(piece: [Spot; 3], sums: &mut [f64; 3]) {
    if piece.iter().all(|spot| spot.distance >= 0.0) {
        return;
    }
    // Sutherland–Hodgman with one line: at most four corners
    let mut polygon = [piece[0]; 4];
    let mut count = 0;
    for (index, from) in piece.iter().enumerate() {
        let to = &piece[(index + 1) % 3];
        if from.distance < 0.0 {
            polygon[count] = *from;
            count += 1;
        }
        if (from.distance < 0.0) != (to.distance < 0.0) {
            let share = from.distance / (from.distance - to.distance);
            let between = |from: f64, to: f64| from + (to - from) * share;
            polygon[count] = Spot { u: between(from.u, to.u), v: between(from.v, to.v), distance: 0.0 };
            count += 1;
        }
    }
    for index in 1..count.saturating_sub(1) {
        let [p, q, r] = [polygon[0], polygon[index], polygon[index + 1]];
        let area = 0.5 * ((q.u - p.u) * (r.v - p.v) - (r.u - p.u) * (q.v - p.v));
        let (u, v) = ((p.u + q.u + r.u) / 3.0, (p.v + q.v + r.v) / 3.0);
        sums[0] += area * (1.0 - u - v);
        sums[1] += area * u;
        sums[2] += area * v;
    }
}

impl Capsule {
    /// Of a point from its surface, negative inside [m].
    pub(super) fn distance(&self, place: Vec3) -> f64 {
        let along = self.to - self.from;
        let length_sq = along.length_sq();
        let share =
            if length_sq > 0.0 { ((place - self.from).dot(along) / length_sq).clamp(0.0, 1.0) } else { 0.0 };
        (place - self.from - along * share).length() - self.radius
    }

    /// How far it is out of it from a place inside, along a unit direction [m].
    pub(super) fn way_out(&self, place: Vec3, direction: Vec3) -> f64 {
        // the distance is convex along a line: it is negative, then positive once and for all
        let (mut inside, mut outside) = (0.0, 2.0 * self.radius + (self.to - self.from).length());
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inside + outside);
            if self.distance(place + direction * middle) < 0.0 {
                inside = middle;
            } else {
                outside = middle;
            }
        }
        0.5 * (inside + outside)
    }
}

/// Down to the rounding of a double.
const HALVINGS: u32 = 52;

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    fn ball(centre: Vec3, radius: f64) -> Capsule {
        Capsule { from: centre, to: centre, radius }
    }

    /// A plane cuts a ball in a disc: its area and its middle, up to the strips that the pieces' sides cut off, a part of `(h/r)²/6` at
    /// most where chords of length `h` replace arcs of radius `r`.
    #[test]
    fn balls_are_cut_in_discs() {
        let corners = [Vec3::new(-1.0, -1.0, 0.0), Vec3::new(3.0, -1.0, 0.0), Vec3::new(-1.0, 3.0, 0.0)];
        let (r, height) = (0.8, 0.3);
        let radius = f64::sqrt(r * r - height * height);
        let middle = [0.425, 0.3, 0.275];
        let found = inside(&ball(Vec3::new(0.2, 0.1, height), r), corners, middle).unwrap();
        let disc = PI * radius * radius;
        let h = f64::sqrt(2.0) * 4.0 / PIECES as f64;
        assert!(found.area <= disc && found.area > disc * (1.0 - (h / radius).powi(2) / 6.0), "{found:?}");
        let [_, u, v] = found.weights();
        let centroid = corners[0] * (1.0 - u - v) + corners[1] * u + corners[2] * v;
        assert!((centroid - Vec3::new(0.2, 0.1, 0.0)).length() < 0.05 * h, "{centroid:?}");
        // the whole of a triangle that is inside altogether: a third for each corner
        let all = inside(&ball(Vec3::ZERO, 10.0), corners, middle).unwrap();
        assert!((all.area - 8.0).abs() < 1e-12);
        assert!(all.weights().iter().all(|weight| (weight - 1.0 / 3.0).abs() < 1e-12));
        assert_eq!(inside(&ball(Vec3::Z, 0.5), corners, middle), None);
    }

    /// A ball of a millimetre that is a tenth of one deep in a triangle of thirty is found, though its disc is a fourth of a piece across: as the
    /// polygon between the places where pieces' sides leave it, by distances taken to be linear.
    #[test]
    fn what_is_smaller_than_a_piece_is_found() {
        let corners = [Vec3::ZERO, Vec3::new(30.0, 0.0, 0.0), Vec3::new(0.0, 30.0, 0.0)];
        let deepest = [1.0 - 0.31 - 0.27, 0.31, 0.27];
        let place = Vec3::new(0.31 * 30.0, 0.27 * 30.0, 0.0);
        let found = inside(&ball(place + Vec3::Z * 0.9, 1.0), corners, deepest).unwrap();
        let disc = PI * (1.0 - 0.81);
        assert!(found.area > 0.0 && found.area <= disc, "{found:?}");
        let [_, u, v] = found.weights();
        assert!((corners[1] * u + corners[2] * v - place).length() < 0.2, "{found:?}");
    }

    /// The way out of a rod, across it and along it.
    #[test]
    fn ways_lead_out() {
        let rod = Capsule { from: Vec3::ZERO, to: Vec3::X * 2.0, radius: 0.5 };
        for (place, direction, expected) in
            [(Vec3::X, Vec3::Y, 0.5), (Vec3::new(1.0, 0.2, 0.0), -Vec3::Y, 0.7), (Vec3::X, -Vec3::X, 1.5)]
        {
            assert!((rod.way_out(place, direction) - expected).abs() < 1e-12);
        }
    }
}
