//! Triangles that pass through each other.

use std::ops::Range;

use rayon::prelude::*;
use souple_math::Vec3;

use crate::{Aabb, AabbTree, TriangleSurface};

/// Triangles that are looked at together, by one thread.
const BATCH: usize = 1024;
/// Batches between two looks at how many have been found.
const ROUND: usize = 8;
/// Most neighbours that are looked at for the triangles of a batch: as of a tip at which thirty thousand meet.
const MOST_LOOKS: usize = 32_768 * BATCH;
/// Most neighbours of all triangles: some ten seconds. Surfaces as they are have some fifteen to a triangle, whatever their size.
const MOST_LOOKS_OF_ALL: usize = 200_000_000;
const MOST_LOOKS_OF_EACH: usize = 64;

/// Pairs of triangles that pass through each other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Crossings {
    /// Lower number first, in ascending order.
    pub pairs: Vec<[u32; 2]>,
    /// Whether there may be more of them: the search has ended at the wished-for number, or triangles lie within each other so
    /// densely that not all pairs could be looked at.
    pub is_cut_off: bool,
}

/// At least the first `most` pairs of triangles of which an edge of one passes through the other. Triangles that share an edge
/// are neighbours and do not count; of those that share a corner only the edges across it are looked at.
///
/// The result is the same for any number of threads.
pub fn crossings(surface: &TriangleSurface, most: usize) -> Crossings {
    let looks = MOST_LOOKS_OF_ALL.max(MOST_LOOKS_OF_EACH * surface.triangles.len());
    crossings_within(surface, most, looks)
}

/// The same with about so many looks at neighbours.
fn crossings_within(surface: &TriangleSurface, most: usize, most_looks: usize) -> Crossings {
    let boxes: Vec<Aabb> =
        (0..surface.triangles.len() as u32).map(|triangle| Aabb::of(surface.corners(triangle))).collect();
    let tree = AabbTree::build(&boxes);
    let mut found = Crossings::default();
    let batches: Vec<usize> = (0..boxes.len()).step_by(BATCH).collect();
    let mut all_looks = 0;
    for round in batches.chunks(ROUND) {
        let of_batch = |first: &usize| {
            let batch = *first..(*first + BATCH).min(boxes.len());
            crossings_of(surface, (&tree, &boxes), batch, most)
        };
        let parts: Vec<(Crossings, usize)> = round.par_iter().map(of_batch).collect();
        for (part, looks) in parts {
            found.pairs.extend(part.pairs);
            found.is_cut_off |= part.is_cut_off;
            all_looks += looks;
        }
        // what the last round has found is all there is, however long that took
        let is_last = round.last() == batches.last();
        if found.pairs.len() > most || (all_looks > most_looks && !is_last) {
            found.pairs.truncate(most);
            found.is_cut_off = true;
            break;
        }
    }
    found
}

/// Those of a batch of triangles with others of higher number, and how many neighbours were looked at.
fn crossings_of(
    surface: &TriangleSurface,
    (tree, boxes): (&AabbTree, &[Aabb]),
    batch: Range<usize>,
    most: usize,
) -> (Crossings, usize) {
    let mut found = Crossings::default();
    let mut looks = 0;
    for s in batch {
        let first = found.pairs.len();
        tree.overlapping_while(boxes[s], |t| {
            looks += 1;
            if (s as u32) < t && cross(surface, s as u32, t) {
                found.pairs.push([s as u32, t]);
            }
            looks < MOST_LOOKS && found.pairs.len() <= most
        });
        found.pairs[first..].sort_unstable();
        if looks >= MOST_LOOKS || found.pairs.len() > most {
            found.is_cut_off = true;
            break;
        }
    }
    (found, looks)
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
        let corners = through.map(&position);
        let sides = sides_of(corners, edges.map(&position));
        // most pairs are told here: all of one lies on one side of the other, as those of a flat part do
        if !(sides.contains(&1) && sides.contains(&-1)) {
            return false;
        }
        let crosses = |i: usize| {
            let next = (i + 1) % 3;
            let is_apart = ![edges[i], edges[next]].iter().any(|p| through.contains(p));
            is_apart
                && sides[i] * sides[next] < 0
                && line_meets([edges[i], edges[next]].map(&position), corners)
        };
        (0..3).any(crosses)
    };
    passes(a, b) || passes(b, a)
}

/// Rounding of a product of three differences of coordinates, relative to their lengths.
const ROUNDING: f64 = 1e-13;

/// For each of three points the side of a triangle's plane that it is on: 1 or -1, and 0 in the plane, to rounding.
fn sides_of([a, b, c]: [Vec3; 3], points: [Vec3; 3]) -> [i8; 3] {
    let (u, v) = (b - a, c - a);
    let normal = u.cross(v);
    let rounding_sq = ROUNDING * ROUNDING * u.length_sq() * v.length_sq();
    points.map(|point| {
        let w = point - a;
        let height = normal.dot(w);
        if height * height <= rounding_sq * w.length_sq() { 0 } else { height.signum() as i8 }
    })
}

/// Whether the line through two points on both sides of a triangle's plane meets its inside. What only touches its border, to
/// rounding, does not count.
fn line_meets([p, q]: [Vec3; 2], [a, b, c]: [Vec3; 3]) -> bool {
    let side = |u: Vec3, v: Vec3| {
        let [along, u, v] = [q - p, u - p, v - p];
        let volume = along.dot(u.cross(v));
        let rounding = ROUNDING * along.length() * u.length() * v.length();
        if volume.abs() <= rounding { 0.0 } else { volume }
    };
    let around = [side(a, b), side(b, c), side(c, a)];
    around.iter().all(|v| *v > 0.0) || around.iter().all(|v| *v < 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Triangles above each other, so far apart that each is looked at beside itself alone.
    fn sheets(count: u32) -> TriangleSurface {
        let sheet = |k: u32| {
            let lift = 2.0 * f64::from(k);
            [Vec3::new(0.0, 0.0, lift), Vec3::new(1.0, 0.0, 1.0 + lift), Vec3::new(0.0, 1.0, lift)]
        };
        let points: Vec<Vec3> = (0..count).flat_map(sheet).collect();
        let triangles = (0..count).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        TriangleSurface::new(points, triangles).unwrap()
    }

    /// Without a pair that crosses, the search ends by the number of looks, and says so; where nothing was left to be looked at
    /// it has found that there is none.
    #[test]
    fn the_search_ends() {
        let more_than_a_round = (ROUND * BATCH) as u32 + 1;
        let found = crossings_within(&sheets(more_than_a_round), 10, 1000);
        assert_eq!(found, Crossings { pairs: Vec::new(), is_cut_off: true });
        let found = crossings_within(&sheets(1500), 10, 1000);
        assert_eq!(found, Crossings::default());
    }
}
