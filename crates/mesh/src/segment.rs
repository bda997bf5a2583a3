//! Segments against triangles: where they are nearest to each other.

use souple_math::Vec3;

use crate::closest_point_on_triangle;

/// Where a segment and a triangle are nearest to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestPair {
    /// Place on the segment, 0 at its first end and 1 at its second.
    pub along: f64,
    /// Weights of the triangle's corners.
    pub weights: [f64; 3],
    /// Zero where the segment goes through the triangle [m²].
    pub distance_sq: f64,
}

/// The nearest points of a segment and a triangle; a segment of no length is a point. Of a segment that runs beside the
/// triangle's plane or one of its edges, any of the nearest points is answered.
pub fn closest_segment_triangle([a, b]: [Vec3; 2], corners: [Vec3; 3]) -> NearestPair {
    let along = b - a;
    let at = |weights: [f64; 3]| corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2];
    let at_end = |end: Vec3, place: f64| {
        let (weights, _) = closest_point_on_triangle(end, corners);
        NearestPair { along: place, weights, distance_sq: (at(weights) - end).length_sq() }
    };
    let first = at_end(a, 0.0);
    if along == Vec3::ZERO {
        return first;
    }
    if let Some(through) = crossing(a, along, corners) {
        return through;
    }
    // inside of the triangle only an end can be nearest, else an edge is
    let mut best = first;
    let mut take = |pair: NearestPair| {
        if pair.distance_sq < best.distance_sq {
            best = pair;
        }
    };
    take(at_end(b, 1.0));
    for edge in 0..3 {
        let (from, to) = (edge, (edge + 1) % 3);
        let (s, t) = closest_segments(a, along, corners[from], corners[to] - corners[from]);
        let mut weights = [0.0; 3];
        (weights[from], weights[to]) = (1.0 - t, t);
        take(NearestPair { along: s, weights, distance_sq: (a + along * s - at(weights)).length_sq() });
    }
    best
}

/// Where the segment goes through the triangle.
fn crossing(a: Vec3, along: Vec3, [p, q, r]: [Vec3; 3]) -> Option<NearestPair> {
    let normal = (q - p).cross(r - p);
    let rate = along.dot(normal);
    let place = (p - a).dot(normal) / rate;
    // also refuses what is no number: a segment beside the plane, a triangle without area
    if !(0.0..=1.0).contains(&place) {
        return None;
    }
    let x = a + along * place;
    let area = |u: Vec3, v: Vec3| (u - x).cross(v - x).dot(normal) / normal.length_sq();
    let weights = [area(q, r), area(r, p), area(p, q)];
    let is_inside = weights.iter().all(|weight| *weight >= 0.0);
    is_inside.then_some(NearestPair { along: place, weights, distance_sq: 0.0 })
}

/// Places in 0 … 1 where `a + s u` and `b + t v` are nearest; in the middle of where they run side by side.
fn closest_segments(a: Vec3, u: Vec3, b: Vec3, v: Vec3) -> (f64, f64) {
    let offset = a - b;
    let (uu, vv, uv) = (u.length_sq(), v.length_sq(), u.dot(v));
    let (ua, va) = (u.dot(offset), v.dot(offset));
    if vv == 0.0 {
        return ((-ua / uu).clamp(0.0, 1.0), 0.0);
    }
    let determinant = uu * vv - uv * uv;
    let s = if determinant > 1e-12 * uu * vv {
        ((uv * va - ua * vv) / determinant).clamp(0.0, 1.0)
    } else {
        // the part of the first that is beside the second
        let ends = [-ua / uu, (uv - ua) / uu].map(|place| place.clamp(0.0, 1.0));
        0.5 * (ends[0] + ends[1])
    };
    let t = (uv * s + va) / vv;
    if (0.0..=1.0).contains(&t) {
        return (s, t);
    }
    let t = t.clamp(0.0, 1.0);
    (((uv * t - ua) / uu).clamp(0.0, 1.0), t)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No pair of points of a fine grid over both is nearer than what is answered, and the answer is such a pair.
    #[test]
    fn nothing_is_nearer() {
        let fraction = |i: usize, k: f64| (i as f64 * k + 0.13).fract() * 2.0 - 1.0;
        let point = |i: usize| Vec3::new(fraction(i, 0.7548), fraction(i, 0.5698), fraction(i, 0.4385));
        for case in 0..200 {
            let [a, b, p, q, r] = std::array::from_fn(|k| point(5 * case + k));
            let found = closest_segment_triangle([a, b], [p, q, r]);
            let at = |s: f64, w: [f64; 3]| (a + (b - a) * s - (p * w[0] + q * w[1] + r * w[2])).length_sq();
            assert!((at(found.along, found.weights) - found.distance_sq).abs() < 1e-12);
            let count = 24;
            let mut least = f64::INFINITY;
            for i in 0..=count {
                for j in 0..=count {
                    for k in 0..=count - j {
                        let [s, u, v] = [i, j, k].map(|n| n as f64 / count as f64);
                        least = least.min(at(s, [1.0 - u - v, u, v]));
                    }
                }
            }
            assert!(found.distance_sq <= least + 1e-12, "{case}: {found:?} {least}");
            // the grid is no farther than its spacing from the nearest pair
            assert!(least.sqrt() <= found.distance_sq.sqrt() + 6.0 / count as f64, "{case}");
        }
    }

    /// Side by side with an edge, the middle is answered; a segment of no length is a point.
    #[test]
    fn degenerate_segments() {
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let beside =
            closest_segment_triangle([Vec3::new(0.0, -1.0, 0.0), Vec3::new(1.0, -1.0, 0.0)], corners);
        assert_eq!((beside.along, beside.distance_sq), (0.0, 1.0));
        let point = closest_segment_triangle([Vec3::new(0.25, 0.25, 2.0); 2], corners);
        assert_eq!(point.distance_sq, 4.0);
        let through =
            closest_segment_triangle([Vec3::new(0.25, 0.25, -1.0), Vec3::new(0.25, 0.25, 3.0)], corners);
        assert_eq!((through.along, through.distance_sq), (0.25, 0.0));
    }
}
