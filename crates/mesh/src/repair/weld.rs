//! Points at one place joined, but for closed parts that would be flattened, or that touch at a point or along an edge.

use std::collections::{BTreeMap, HashMap, HashSet};

use souple_math::Vec3;

use super::diagnose::components;
use super::{SurfaceRepairs, facing, flat, from_lowest};
use crate::TriangleSurface;
use crate::sets::Sets;

/// A closed part that would keep less of its volume is flattened.
const KEPT_VOLUME: f64 = 0.5;

/// Joins points, drops triangles that are flat or equal to another, drops points of no triangle.
pub(super) fn weld(
    surface: &TriangleSurface,
    distance: f64,
    repairs: &mut SurfaceRepairs,
) -> TriangleSurface {
    let mut number = joined_points(surface, distance, repairs);
    let welded = surface.triangles.iter().map(|corners| corners.map(|point| number[point as usize]));
    let mut triangles: Vec<[u32; 3]> = welded.collect();
    flat::drop(&surface.points, &mut triangles, repairs);
    // copies that run the same way go first: what is left of three are two of opposite directions at most
    let mut seen: HashSet<[u32; 3]> = HashSet::new();
    let before = triangles.len();
    triangles.retain(|corners| seen.insert(from_lowest(*corners)));
    repairs.doubled_triangles += before - triangles.len();
    facing::drop_pairs(&surface.points, &mut triangles, repairs);
    part_touching(surface, &mut number, &mut triangles, repairs);
    for (point, first) in number.iter().enumerate().filter(|(point, first)| *point as u32 != **first) {
        let apart = (surface.points[point] - surface.points[*first as usize]).length();
        repairs.longest_weld = repairs.longest_weld.max(apart);
        repairs.welded_points += 1;
    }
    let mut mended = TriangleSurface::from_mesh(&surface.points, &triangles, Vec::new());
    mended.mesh_points.clear();
    mended
}

/// For each point the one that it becomes: the lowest within a distance, but in closed parts as thin as that the lowest at its place.
fn joined_points(surface: &TriangleSurface, distance: f64, repairs: &mut SurfaceRepairs) -> Vec<u32> {
    let equal = equal_points(&surface.points);
    if distance == 0.0 {
        return equal;
    }
    let close = close_points(&surface.points, distance, |_| true);
    if close == equal {
        return equal;
    }
    let with = |number: &[u32]| -> Vec<[u32; 3]> {
        surface.triangles.iter().map(|corners| corners.map(|point| number[point as usize])).collect()
    };
    let (before, after) = (with(&equal), with(&close));
    let whole = TriangleSurface { points: surface.points.clone(), triangles: before, ..Default::default() };
    let (part_of, count) = components(&whole);
    let mut triangles_of = vec![Vec::new(); count];
    part_of.iter().enumerate().for_each(|(triangle, part)| triangles_of[*part as usize].push(triangle));
    let mut is_thin = vec![false; surface.points.len()];
    for triangles in triangles_of {
        let part = |of: &[[u32; 3]]| {
            let own: Vec<[u32; 3]> = triangles.iter().map(|triangle| of[*triangle]).collect();
            TriangleSurface::from_mesh(&surface.points, &own, Vec::new())
        };
        let given = part(&whole.triangles);
        let volume = given.enclosed_volume().abs();
        if part(&after).enclosed_volume().abs() < KEPT_VOLUME * volume && given.check_closed().is_ok() {
            repairs.left.thin_parts += 1;
            let points = triangles.iter().flat_map(|triangle| surface.triangles[*triangle]);
            points.for_each(|point| is_thin[point as usize] = true);
        }
    }
    if repairs.left.thin_parts == 0 {
        return close;
    }
    let close = close_points(&surface.points, distance, |point| !is_thin[point]);
    (0..close.len()).map(|point| if is_thin[point] { equal[point] } else { close[point] }).collect()
}

/// Cells to each side, beyond which no distance is told from rounding.
const FARTHEST: f64 = 9_007_199_254_740_992.0;

/// The lowest number of the points within a distance, for each point that may be joined; chains are not followed.
fn close_points(points: &[Vec3], distance: f64, may_join: impl Fn(usize) -> bool) -> Vec<u32> {
    // cells of twice the distance: close points are in touching cells
    let cell = |point: Vec3| {
        (point * (0.5 / distance)).to_array().map(|c| c.floor().clamp(-FARTHEST, FARTHEST) as i64)
    };
    let mut grid: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    let mut number: Vec<u32> = (0..points.len() as u32).collect();
    for (index, point) in points.iter().enumerate().filter(|(index, _)| may_join(*index)) {
        let home = cell(*point);
        let mut first = index as u32;
        for step in 0..27_i64 {
            let beside = [home[0] + step % 3 - 1, home[1] + step / 3 % 3 - 1, home[2] + step / 9 - 1];
            let near = grid.get(&beside).into_iter().flatten();
            let close = near.copied().filter(|other| (points[*other as usize] - *point).length() <= distance);
            first = close.fold(first, u32::min);
        }
        number[index] = first;
        if first == index as u32 {
            grid.entry(home).or_default().push(first);
        }
    }
    number
}

/// The lowest number of the points at the same place, for each point.
pub(super) fn equal_points(points: &[Vec3]) -> Vec<u32> {
    let mut first_at: HashMap<[u64; 3], u32> = HashMap::with_capacity(points.len());
    let number = |(index, point): (usize, &Vec3)| *first_at.entry(point.key()).or_insert(index as u32);
    points.iter().enumerate().map(number).collect()
}

/// Gives closed parts that touch at a point or along an edge their own points back: joined there, they are no surface. Triangles
/// around a point that hang together by edges of two are a fan; where all fans close, each keeps the lowest of the points that it had.
fn part_touching(
    surface: &TriangleSurface,
    number: &mut [u32],
    triangles: &mut [[u32; 3]],
    repairs: &mut SurfaceRepairs,
) {
    let mut is_joined = vec![false; number.len()];
    for (point, first) in number.iter().enumerate().filter(|(point, first)| *point as u32 != **first) {
        (is_joined[point], is_joined[*first as usize]) = (true, true);
    }
    let mut around: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (triangle, corners) in triangles.iter().enumerate() {
        for point in corners.iter().filter(|point| is_joined[**point as usize]) {
            around.entry(*point).or_default().push(triangle);
        }
    }
    if around.is_empty() {
        return;
    }
    // corners as they were given: of copies those of the first, which stayed
    let mut given: HashMap<[u32; 3], [u32; 3]> = HashMap::with_capacity(triangles.len());
    for corners in &surface.triangles {
        let joined = corners.map(|point| number[point as usize]);
        given.entry(from_lowest(joined)).or_insert_with(|| {
            let lowest = (0..3).min_by_key(|k| joined[*k]).unwrap_or(0);
            [0, 1, 2].map(|k| corners[(lowest + k) % 3])
        });
    }
    let given_at = |corners: [u32; 3], point: u32| {
        let key = from_lowest(corners);
        let at = key.iter().position(|corner| *corner == point);
        at.and_then(|at| given.get(&key).map(|given| given[at])).unwrap_or(point)
    };
    let old = triangles.to_vec();
    for (point, users) in around {
        let corners: Vec<[u32; 3]> = users.iter().map(|triangle| old[*triangle]).collect();
        let own: Vec<u32> = corners.iter().map(|corners| given_at(*corners, point)).collect();
        let given_edge = |user: usize, other: u32| (own[user], given_at(corners[user], other));
        let Some(mut fans) = closed_fans(point, &corners, given_edge) else { continue };
        // what was one point stays one
        let mut first_of: HashMap<u32, u32> = HashMap::new();
        for (user, point) in own.iter().enumerate() {
            fans.join(*first_of.entry(*point).or_insert(user as u32), user as u32);
        }
        let mut lowest_of: HashMap<u32, u32> = HashMap::new();
        for (user, point) in own.iter().enumerate() {
            let lowest = lowest_of.entry(fans.of(user as u32)).or_insert(*point);
            *lowest = (*lowest).min(*point);
        }
        if lowest_of.len() == 1 {
            continue;
        }
        repairs.left.touching_points += 1;
        for (user, triangle) in users.iter().enumerate() {
            let lowest = lowest_of[&fans.of(user as u32)];
            number[own[user] as usize] = lowest;
            let at = old[*triangle].iter().position(|corner| *corner == point);
            at.into_iter().for_each(|at| triangles[*triangle][at] = lowest);
        }
    }
}

/// The triangles around a point by the fans that they are in, or `None` where a fan is open. At an edge of more than two triangles those
/// follow each other that did so as they were given.
fn closed_fans(
    point: u32,
    corners: &[[u32; 3]],
    given_edge: impl Fn(usize, u32) -> (u32, u32),
) -> Option<Sets> {
    let mut at_edge: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (user, corners) in corners.iter().enumerate() {
        let others = corners.iter().filter(|other| **other != point);
        others.for_each(|other| at_edge.entry(*other).or_default().push(user));
    }
    let mut fans = Sets::new(corners.len());
    for (other, users) in &at_edge {
        let mut last_at: HashMap<(u32, u32), usize> = HashMap::new();
        for user in users {
            let edge = if users.len() == 2 { (point, *other) } else { given_edge(*user, *other) };
            if let Some(before) = last_at.insert(edge, *user) {
                fans.join(before as u32, *user as u32);
            }
        }
    }
    let mut is_closed = |users: &Vec<usize>| {
        let mut counts: HashMap<u32, usize> = HashMap::new();
        users.iter().for_each(|user| *counts.entry(fans.of(*user as u32)).or_default() += 1);
        counts.into_values().all(|count| count == 2)
    };
    at_edge.values().all(&mut is_closed).then_some(fans)
}
