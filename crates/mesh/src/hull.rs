//! The convex hull of a few points.

use souple_math::Vec3;

use crate::BoundingBox;
use crate::polygon::polygon_triangles;

/// Most points of which a hull is found: all planes through three of them are looked at.
pub const MOST_HULL_POINTS: usize = 100;

/// Points nearer to a plane through others than this share of the diagonal of all are on it.
const ON_PLANE: f64 = 1e-9;

/// The corners of the triangles of the convex hull of points, counterclockwise seen from outside; points within it, on its faces and on its edges are no
/// corners. `None` where points are in one plane, are not finite or more than [`MOST_HULL_POINTS`].
pub fn convex_hull(points: &[Vec3]) -> Option<Vec<[u32; 3]>> {
    if points.len() > MOST_HULL_POINTS || !points.iter().all(|point| point.is_finite()) {
        return None;
    }
    let tolerance = ON_PLANE * BoundingBox::of(points.iter().copied()).diagonal();
    let mut faces: Vec<Vec<u32>> = Vec::new();
    let count = points.len();
    for a in 0..count {
        for b in a + 1..count {
            for c in b + 1..count {
                let Some(face) = face_through([a, b, c], points, tolerance)? else { continue };
                if !faces.contains(&face) {
                    faces.push(face);
                }
            }
        }
    }
    let triangles = faces.iter().flat_map(|face| polygon_triangles(face, |point| points[point as usize]));
    Some(triangles.collect()).filter(|triangles: &Vec<_>| !triangles.is_empty())
}

/// The polygon of all points in a plane through three of which no point is outside, counterclockwise seen from there, from its corner of lowest number; an inner `None` of any
/// other plane, and an outer one where all points are in it.
#[expect(clippy::option_option, reason = "no face and no hull are different things")]
fn face_through(three: [usize; 3], points: &[Vec3], tolerance: f64) -> Option<Option<Vec<u32>>> {
    let [a, b, c] = three.map(|point| points[point]);
    let across = (b - a).cross(c - a);
    let longest = (b - a).length().max((c - a).length());
    let Some(mut normal) = across.try_normalised().filter(|_| across.length() > tolerance * longest) else {
        return Some(None);
    };
    let heights = || points.iter().map(|point| normal.dot(*point - a));
    let (is_below, is_above) = (heights().any(|h| h < -tolerance), heights().any(|h| h > tolerance));
    match (is_below, is_above) {
        (true, true) => return Some(None),
        (false, false) => return None,
        (true, false) => {}
        (false, true) => normal = -normal,
    }
    let on = (0..points.len()).filter(|point| normal.dot(points[*point] - a).abs() <= tolerance);
    Some(Some(outline(on.collect(), points, normal, tolerance)))
}

/// The corners of the convex hull of points in a plane, around from that of lowest number.
fn outline(on: Vec<usize>, points: &[Vec3], normal: Vec3, tolerance: f64) -> Vec<u32> {
    let along = normal.any_orthogonal();
    let beside = normal.cross(along);
    let place = |point: usize| (points[point].dot(along), points[point].dot(beside));
    // wrapped from the first along `along`: each next corner has all others on its left
    let first = on
        .iter()
        .copied()
        .fold(on[0], |least, point| if place(point) < place(least) { point } else { least });
    let mut around = vec![first];
    loop {
        let from = around[around.len() - 1];
        let mut next = first;
        for point in on.iter().copied().filter(|point| *point != from) {
            let (to, other) = (points[next] - points[from], points[point] - points[from]);
            let left = normal.dot(to.cross(other));
            let slack = tolerance * to.length().max(other.length());
            let is_farther = left.abs() <= slack && other.length_sq() > to.length_sq();
            if next == from || left < -slack || is_farther {
                next = point;
            }
        }
        if next == first || around.len() > on.len() {
            break;
        }
        around.push(next);
    }
    let lowest = (0..around.len()).min_by_key(|place| around[*place]).unwrap_or(0);
    around.rotate_left(lowest);
    around.into_iter().map(|point| point as u32).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::TriangleSurface;

    fn enclosed(points: &[Vec3]) -> Option<(f64, usize)> {
        let triangles = convex_hull(points)?;
        let count = triangles.len();
        Some((TriangleSurface::new(points.to_vec(), triangles).ok()?.enclosed_volume(), count))
    }

    /// A box has twelve triangles, whatever lies within it, on its faces and on its edges.
    #[test]
    fn of_a_box() {
        let mut points: Vec<Vec3> = (0..8)
            .map(|i| Vec3::new((i & 1) as f64, 2.0 * (i >> 1 & 1) as f64, 3.0 * (i >> 2) as f64))
            .collect();
        let within = [[0.5, 1.0, 1.0], [0.5, 1.0, 0.0], [0.5, 0.0, 0.0], [1.0, 2.0, 1.5]];
        points.extend(within.map(Vec3::from_array));
        let (volume, count) = enclosed(&points).unwrap();
        assert!((volume - 6.0).abs() < 1e-12 && count == 12, "{volume} {count}");
    }

    /// Points on a ball are all corners, and no point is outside; Euler has `2 n - 4` triangles.
    #[test]
    fn of_a_ball() {
        let place = |i: usize| {
            let (z, turn) = (1.0 - (2 * i + 1) as f64 / 60.0, 2.4 * i as f64);
            Vec3::new((1.0 - z * z).sqrt() * turn.cos(), (1.0 - z * z).sqrt() * turn.sin(), z)
        };
        let points: Vec<Vec3> = (0..60).map(place).collect();
        let triangles = convex_hull(&points).unwrap();
        assert_eq!(triangles.len(), 2 * 60 - 4);
        for [a, b, c] in triangles.iter().map(|corners| corners.map(|corner| points[corner as usize])) {
            let normal = (b - a).cross(c - a);
            assert!(points.iter().all(|point| normal.dot(*point - a) < 1e-12));
        }
    }

    /// What has no inside has no hull.
    #[test]
    fn of_what_is_flat() {
        let flat: Vec<Vec3> = (0..9).map(|i| Vec3::new((i % 3) as f64, (i / 3) as f64, 1.0)).collect();
        assert_eq!(convex_hull(&flat), None);
        assert_eq!(convex_hull(&flat[..2]), None);
        assert_eq!(convex_hull(&[]), None);
        let infinite = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(0.0, 0.0, f64::INFINITY)];
        assert_eq!(convex_hull(&infinite), None);
    }
}
