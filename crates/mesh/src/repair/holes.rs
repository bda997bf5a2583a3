//! Small holes, closed by a fan around their middle.

use std::collections::HashMap;

use souple_math::Vec3;

use super::SurfaceRepairs;
use crate::{BoundingBox, TriangleSurface};

/// Closes the holes whose box has a diagonal up to `limit` [m]. A hole that touches another at a point is left.
pub(super) fn close(surface: &mut TriangleSurface, limit: f64, repairs: &mut SurfaceRepairs) {
    for ring in rings(surface) {
        let corners: Vec<Vec3> = ring.iter().map(|point| surface.points[*point as usize]).collect();
        if ring.len() < 3 || BoundingBox::of(corners.iter().copied()).diagonal() > limit {
            continue;
        }
        if let [a, b, c] = ring[..] {
            surface.triangles.push([a, b, c]);
        } else {
            let middle = surface.points.len() as u32;
            surface.points.push(corners.iter().copied().sum::<Vec3>() / corners.len() as f64);
            for (place, from) in ring.iter().enumerate() {
                surface.triangles.push([*from, ring[(place + 1) % ring.len()], middle]);
            }
        }
        repairs.closed_holes += 1;
    }
}

/// Open edges in rings, each run against the triangles beside it, from its lowest point; ascending.
fn rings(surface: &TriangleSurface) -> Vec<Vec<u32>> {
    let mut next: HashMap<u32, Vec<u32>> = HashMap::new();
    for ([a, b], forward, backward) in surface.edge_uses() {
        match (forward, backward) {
            (1, 0) => next.entry(b).or_default().push(a),
            (0, 1) => next.entry(a).or_default().push(b),
            _ => {}
        }
    }
    let mut starts: Vec<u32> = next.keys().copied().collect();
    starts.sort_unstable();
    let mut used: HashMap<u32, ()> = HashMap::new();
    let mut rings = Vec::new();
    for start in starts {
        if used.contains_key(&start) {
            continue;
        }
        let mut ring = vec![start];
        let mut at = start;
        let is_closed = loop {
            used.insert(at, ());
            // several ways on: two holes touch here
            let Some([only]) = next.get(&at).map(Vec::as_slice) else { break false };
            at = *only;
            if at == start {
                break true;
            }
            if used.contains_key(&at) {
                break false;
            }
            ring.push(at);
        };
        if is_closed {
            rings.push(ring);
        }
    }
    rings
}
