//! Triangles that pass through each other.

use souple_math::Vec3;

use crate::{Aabb, AabbTree, TriangleSurface};

/// Pairs of triangles, lower number first, of which an edge of one passes through the other. Triangles that share
/// an edge are neighbours and do not count; of those that share a corner only the edges across it are looked at.
pub fn crossings(surface: &TriangleSurface) -> Vec<[u32; 2]> {
    let boxes: Vec<Aabb> =
        (0..surface.triangles.len() as u32).map(|triangle| Aabb::of(surface.corners(triangle))).collect();
    let tree = AabbTree::build(&boxes);
    let mut found = Vec::new();
    for (s, bounds) in boxes.iter().enumerate() {
        tree.overlapping(*bounds, |t| {
            if (s as u32) < t && cross(surface, s as u32, t) {
                found.push([s as u32, t]);
            }
        });
    }
    found.sort_unstable();
    found
}

fn cross(surface: &TriangleSurface, s: u32, t: u32) -> bool {
    let [a, b] = [s, t].map(|triangle| surface.triangles[triangle as usize]);
    triangles_cross(a, b, |point| surface.points[point as usize])
}

/// Whether two triangles, by their points, pass through each other as [`crossings`] counts it.
pub fn triangles_cross(a: [u32; 3], b: [u32; 3], position: impl Fn(u32) -> Vec3) -> bool {
    let shared = a.iter().filter(|point| b.contains(point)).count();
    if shared > 1 {
        return false;
    }
    // an edge that ends in a corner of the other triangle touches it without passing through
    let passes = |edges: [u32; 3], through: [u32; 3]| {
        (0..3)
            .map(|i| [edges[i], edges[(i + 1) % 3]])
            .filter(|edge| !edge.iter().any(|p| through.contains(p)))
            .any(|edge| {
                let [p, q] = edge.map(&position);
                segment_passes(p, q, through.map(&position))
            })
    };
    passes(a, b) || passes(b, a)
}

/// Whether a segment passes through the inside of a triangle from one side to the other. What only touches, to
/// rounding, does not count.
fn segment_passes(p: Vec3, q: Vec3, [a, b, c]: [Vec3; 3]) -> bool {
    let volume = |a: Vec3, b: Vec3, c: Vec3, d: Vec3| {
        let [u, v, w] = [b - a, c - a, d - a];
        let value = u.dot(v.cross(w));
        // rounding of a product of three differences of coordinates
        let scale = u.length() * v.length() * w.length();
        if value.abs() <= 1e-13 * scale { 0.0 } else { value }
    };
    let (from, to) = (volume(a, b, c, p), volume(a, b, c, q));
    if from * to >= 0.0 {
        return false;
    }
    let around = [(a, b), (b, c), (c, a)].map(|(u, v)| volume(p, q, u, v));
    around.iter().all(|v| *v > 0.0) || around.iter().all(|v| *v < 0.0)
}
