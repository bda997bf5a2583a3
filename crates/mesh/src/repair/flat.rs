//! Triangles without area: dropped where nothing opens without them, joined with a neighbour elsewhere.

use std::collections::{BTreeSet, HashMap};

use souple_math::Vec3;

use super::{SurfaceRepairs, edges_of, is_flat};
use crate::TriangleSurface;

/// Drops triangles that are a point or a line. One that repeats a corner has the edge that is left twice, so that nothing opens
/// without it. One whose corners lie on a line is dropped where more of its edges are open with it than without.
pub(super) fn drop(points: &[Vec3], triangles: &mut Vec<[u32; 3]>, repairs: &mut SurfaceRepairs) {
    if !triangles.iter().any(|corners| is_flat(*corners, points)) {
        return;
    }
    let before = triangles.len();
    triangles.retain(|[a, b, c]| a != b && b != c && c != a);
    // of nothing but lines nothing is left to be opened
    if triangles.iter().all(|corners| is_flat(*corners, points)) {
        triangles.clear();
    }
    let mut uses: HashMap<[u32; 2], usize> = HashMap::new();
    triangles.iter().flat_map(edges_of).for_each(|edge| *uses.entry(edge).or_default() += 1);
    triangles.retain(|corners| {
        let even = edges_of(corners).iter().filter(|edge| uses[*edge].is_multiple_of(2)).count();
        even > 1 || !is_flat(*corners, points)
    });
    repairs.flat_triangles += before - triangles.len();
}

/// Of a triangle whose corners lie on a line, and its neighbour at the longest edge, takes the other diagonal: both get an area,
/// and the surface stays where it is. Where that neighbour is flat too it comes first.
pub(super) fn join(surface: &mut TriangleSurface, repairs: &mut SurfaceRepairs) {
    let mut waiting: BTreeSet<usize> = (0..surface.triangles.len())
        .filter(|triangle| is_flat(surface.triangles[*triangle], &surface.points))
        .collect();
    if waiting.is_empty() {
        return;
    }
    let mut beside: HashMap<[u32; 2], Vec<usize>> = HashMap::new();
    for (triangle, corners) in surface.triangles.iter().enumerate() {
        edges_of(corners).into_iter().for_each(|edge| beside.entry(edge).or_default().push(triangle));
    }
    // one is done at least in each pass but the last
    loop {
        let before = waiting.len();
        let mut next: Vec<usize> = waiting.iter().rev().copied().collect();
        while let Some(triangle) = next.pop() {
            let is_waiting = waiting.contains(&triangle);
            let Some(pair) =
                is_waiting.then(|| take_other_diagonal(surface, triangle, &mut beside)).flatten()
            else {
                continue;
            };
            waiting.remove(&triangle);
            // those that waited for it, at edges of two
            let edges = pair.into_iter().flat_map(|of| edges_of(&surface.triangles[of]));
            let of_two = edges.filter_map(|edge| beside.get(&edge).filter(|users| users.len() == 2));
            next.extend(of_two.flatten().filter(|other| waiting.contains(other)));
        }
        repairs.joined_triangles += before - waiting.len();
        if waiting.len() == before {
            return;
        }
    }
}

/// A triangle without area and its neighbour at the longest edge, where they took the other diagonal.
fn take_other_diagonal(
    surface: &mut TriangleSurface,
    triangle: usize,
    beside: &mut HashMap<[u32; 2], Vec<usize>>,
) -> Option<[usize; 2]> {
    let [a, b, c] = from_longest_edge(surface, triangle);
    let [first, second] = beside[&sorted(a, b)][..] else { return None };
    let other = if first == triangle { second } else { first };
    let of_other = surface.triangles[other];
    let d = of_other.into_iter().find(|point| *point != a && *point != b)?;
    let runs_against = (0..3).any(|k| of_other[k] == b && of_other[(k + 1) % 3] == a);
    // an edge that was there and is gone has no triangles
    let is_taken = beside.get(&sorted(c, d)).is_some_and(|users| !users.is_empty());
    if d == c || !runs_against || is_flat(of_other, &surface.points) || is_taken {
        return None;
    }
    for of in [triangle, other] {
        for edge in edges_of(&surface.triangles[of]) {
            beside.entry(edge).or_default().retain(|user| *user != of);
        }
    }
    (surface.triangles[triangle], surface.triangles[other]) = ([c, a, d], [d, b, c]);
    for of in [triangle, other] {
        for edge in edges_of(&surface.triangles[of]) {
            beside.entry(edge).or_default().push(of);
        }
    }
    Some([triangle, other])
}

/// Corners from the start of the longest edge on.
fn from_longest_edge(surface: &TriangleSurface, triangle: usize) -> [u32; 3] {
    let [a, b, c] = surface.triangles[triangle];
    let length = |[from, to, _]: &[u32; 3]| {
        (surface.points[*to as usize] - surface.points[*from as usize]).length_sq()
    };
    let turns = [[a, b, c], [b, c, a], [c, a, b]];
    turns
        .into_iter()
        .reduce(|best, turn| if length(&turn) > length(&best) { turn } else { best })
        .unwrap_or([a, b, c])
}

fn sorted(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}
