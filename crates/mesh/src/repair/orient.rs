//! Triangles turned until neighbours agree, parts until they face outward.

use super::SurfaceRepairs;
use super::diagnose::components;
use crate::winding::WindingNumber;
use crate::{Aabb, AabbTree, TriangleSurface};

/// Turns triangles so that the two at an edge run along it in opposite directions, starting from the first triangle
/// of each part; of each part the smaller number is turned. Edges of three triangles or more are not crossed. A part on which there
/// is a way to the other side cannot agree: it is turned where that leaves fewer edges that do not, and counted.
pub(super) fn agree(surface: &mut TriangleSurface, repairs: &mut SurfaceRepairs) {
    let neighbours = neighbours(surface);
    let count = surface.triangles.len();
    let mut turned: Vec<Option<bool>> = vec![None; count];
    for first in 0..count {
        if turned[first].is_some() {
            continue;
        }
        turned[first] = Some(false);
        let mut part = vec![first];
        let mut next = 0;
        while let Some(&triangle) = part.get(next) {
            next += 1;
            for (other, agrees) in &neighbours[triangle] {
                if turned[*other].is_none() {
                    turned[*other] = turned[triangle].map(|turn| turn == *agrees);
                    part.push(*other);
                }
            }
        }
        // turning of the fewer: what most triangles say was meant
        let count_turned = part.iter().filter(|triangle| turned[**triangle] == Some(true)).count();
        let turn = if 2 * count_turned > part.len() { Some(false) } else { Some(true) };
        let edges =
            || part.iter().flat_map(|triangle| neighbours[*triangle].iter().map(|other| (*triangle, *other)));
        let torn = edges().filter(|(s, (t, agrees))| (turned[*s] == turned[*t]) != *agrees).count();
        if torn > 0 {
            repairs.left.one_sided_parts += 1;
            if torn >= edges().filter(|(_, (_, agrees))| !agrees).count() {
                continue;
            }
        }
        for triangle in part.iter().filter(|triangle| turned[**triangle] == turn) {
            surface.triangles[*triangle].swap(1, 2);
            repairs.turned_triangles += 1;
        }
    }
}

/// For each triangle those across its edges of two, and whether both run along the edge in opposite directions.
fn neighbours(surface: &TriangleSurface) -> Vec<Vec<(usize, bool)>> {
    let mut edges: Vec<([u32; 2], usize, bool)> = Vec::with_capacity(3 * surface.triangles.len());
    for (triangle, [a, b, c]) in surface.triangles.iter().enumerate() {
        for [from, to] in [[*a, *b], [*b, *c], [*c, *a]] {
            edges.push(([from.min(to), from.max(to)], triangle, from < to));
        }
    }
    edges.sort_unstable();
    let mut neighbours = vec![Vec::new(); surface.triangles.len()];
    for same in edges.chunk_by(|a, b| a.0 == b.0) {
        if let [(_, s, up), (_, t, up_too)] = same {
            let agrees = up != up_too;
            neighbours[*s].push((*t, agrees));
            neighbours[*t].push((*s, agrees));
        }
    }
    neighbours
}

/// Turns the closed parts whose back is seen from outside. A part within another keeps how it lies to the outer one, so
/// that hollows stay hollows. An open part has no inside, and faces where it was meant to.
pub(super) fn face_outward(surface: &mut TriangleSurface, repairs: &mut SurfaceRepairs) {
    let (part_of, count) = components(surface);
    let mut triangles_of = vec![Vec::new(); count];
    for (triangle, part) in part_of.iter().enumerate() {
        triangles_of[*part as usize].push(surface.triangles[triangle]);
    }
    let parts: Vec<TriangleSurface> = triangles_of
        .iter()
        .map(|triangles| TriangleSurface::from_mesh(&surface.points, triangles, Vec::new()))
        .collect();
    let windings: Vec<WindingNumber> = parts.iter().map(WindingNumber::new).collect();
    let boxes: Vec<Aabb> = parts.iter().map(|part| Aabb::of(part.points.iter().copied())).collect();
    let tree = AabbTree::build(&boxes);
    let closed: Vec<bool> = parts.iter().map(|part| part.check_closed().is_ok()).collect();
    let is_inside_out = |part: usize| closed[part] && parts[part].enclosed_volume() < 0.0;
    let around = |inner: usize| -> Vec<usize> {
        let point = parts[inner].points[0];
        let mut around = Vec::new();
        tree.overlapping(Aabb::of([point]), |outer| {
            let outer = outer as usize;
            if outer != inner && windings[outer].at(point).abs() > 0.5 {
                around.push(outer);
            }
        });
        around.sort_unstable();
        around
    };
    let around: Vec<Vec<usize>> = (0..count).map(around).collect();
    // the outermost part that goes around this one decides
    let outermost = |inner: usize| around[inner].iter().copied().find(|outer| around[*outer].is_empty());
    let is_turned: Vec<bool> = (0..count)
        .map(|number| closed[number] && is_inside_out(outermost(number).unwrap_or(number)))
        .collect();
    let winds = |part: usize| -> f64 {
        let turn = if is_turned[part] { -1.0 } else { 1.0 };
        if closed[part] { turn * parts[part].enclosed_volume().signum() } else { 0.0 }
    };
    repairs.left.nested_parts = (0..count)
        .filter(|inner| winds(*inner) > 0.0 && around[*inner].iter().copied().map(winds).sum::<f64>() > 0.0)
        .count();
    for (triangle, corners) in surface.triangles.iter_mut().enumerate() {
        if is_turned[part_of[triangle] as usize] {
            corners.swap(1, 2);
        }
    }
    repairs.turned_parts = is_turned.iter().filter(|turned| **turned).count();
}
