//! Small holes, closed by a fan around their middle, or within their rim where the middle does not see all of it.

use std::collections::{HashMap, HashSet};

use souple_math::Vec3;

use super::diagnose::components;
use super::{SurfaceRepairs, edges_of};
use crate::polygon::{area_vector, cut_polygon};
use crate::{BoundingBox, TriangleSurface};

/// A part whose triangles face one way, to this share of their area, is a flat sheet, and its rings are outlines.
const FLAT: f64 = 0.999;

/// A ring whose area is less, relative to the square of its length, is a slit: rounding.
const SLIT: f64 = 1e-12;

/// Closes the holes whose box has a diagonal up to `limit` of `diagonal` [m]. A hole that touches another at a point is left, and
/// what is no hole: the outline of a sheet, around which it would be doubled.
pub(super) fn close(surface: &mut TriangleSurface, limit: f64, diagonal: f64, repairs: &mut SurfaceRepairs) {
    let open_edges = surface.edge_uses().iter().filter(|(_, up, down)| up + down == 1).count();
    if open_edges == 0 {
        return;
    }
    let (rings, parts) = (rings(surface), Parts::of(surface));
    repairs.left.tangled_edges = open_edges - rings.iter().map(Vec::len).sum::<usize>();
    let mut edges: HashSet<[u32; 2]> = surface.triangles.iter().flat_map(edges_of).collect();
    for ring in rings {
        let corners: Vec<Vec3> = ring.iter().map(|point| surface.points[*point as usize]).collect();
        let size = BoundingBox::of(corners.iter().copied()).diagonal() / diagonal;
        if parts.have_outline(&ring, &corners) {
            repairs.left.outlines += 1;
        } else if size > limit {
            repairs.left.add_hole(size);
        } else {
            repairs.closed_holes += 1;
            repairs.largest_closed_hole = repairs.largest_closed_hole.max(size);
            repairs.folded_holes += usize::from(cover(surface, &ring, &corners, &mut edges) == Cover::Folded);
        }
    }
}

/// What the parts of a surface hold.
struct Parts {
    of_point: HashMap<u32, u32>,
    point_counts: Vec<usize>,
    /// [m²]
    areas: Vec<f64>,
    /// Sums of area times normal [m²].
    area_vectors: Vec<Vec3>,
}

impl Parts {
    fn of(surface: &TriangleSurface) -> Self {
        let (of_triangle, count) = components(surface);
        let mut parts = Self {
            of_point: HashMap::new(),
            point_counts: vec![0; count],
            areas: vec![0.0; count],
            area_vectors: vec![Vec3::ZERO; count],
        };
        for (triangle, part) in of_triangle.iter().enumerate() {
            let area_vector = surface.area_vector(triangle as u32);
            parts.areas[*part as usize] += area_vector.length();
            parts.area_vectors[*part as usize] += area_vector;
            for point in surface.triangles[triangle] {
                if parts.of_point.insert(point, *part).is_none() {
                    parts.point_counts[*part as usize] += 1;
                }
            }
        }
        parts
    }

    /// Whether a ring goes around a sheet: through all of its points, or of more area than half of one that is flat.
    fn have_outline(&self, ring: &[u32], corners: &[Vec3]) -> bool {
        let part = self.of_point[&ring[0]] as usize;
        let is_flat = self.area_vectors[part].length() > FLAT * self.areas[part];
        self.point_counts[part] == ring.len()
            || is_flat && area_vector(corners).length() > 0.5 * self.areas[part]
    }
}

#[derive(PartialEq)]
enum Cover {
    Even,
    /// Triangles lie on each other: the rim crosses itself, seen from everywhere.
    Folded,
}

/// Closes a ring: around its middle where that sees all of it, within it elsewhere.
fn cover(
    surface: &mut TriangleSurface,
    ring: &[u32],
    corners: &[Vec3],
    edges: &mut HashSet<[u32; 2]>,
) -> Cover {
    let normal = area_vector(corners);
    let middle = corners.iter().copied().sum::<Vec3>() / corners.len() as f64;
    let sides = || (0..ring.len()).map(|place| [place, (place + 1) % ring.len()]);
    let around_sq: f64 = sides().map(|[p, q]| (corners[q] - corners[p]).length()).sum::<f64>().powi(2);
    let is_seen = |[p, q]: [usize; 2]| {
        (corners[p] - middle).cross(corners[q] - middle).dot(normal) > SLIT * around_sq * normal.length()
    };
    let is_slit = normal.length() <= SLIT * around_sq;
    if is_slit || ring.len() == 3 || !sides().all(is_seen) {
        let within = cut_polygon(ring, |point| surface.points[point as usize]);
        let sides: HashSet<[u32; 2]> =
            sides().map(|place| place.map(|place| ring[place])).map(|[p, q]| [p.min(q), p.max(q)]).collect();
        let across = || within.triangles.iter().flat_map(edges_of).filter(|edge| !sides.contains(edge));
        // an edge that is there already would have four triangles
        if (is_slit || !within.is_folded) && !across().any(|edge| edges.contains(&edge)) {
            edges.extend(across());
            surface.triangles.extend(within.triangles);
            return Cover::Even;
        }
    }
    let new = surface.points.len() as u32;
    surface.points.push(middle);
    surface.triangles.extend(sides().map(|[p, q]| [ring[p], ring[q], new]));
    if sides().all(is_seen) { Cover::Even } else { Cover::Folded }
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
    let mut used: HashSet<u32> = HashSet::new();
    let mut rings = Vec::new();
    for start in starts {
        if used.contains(&start) {
            continue;
        }
        let mut ring = vec![start];
        let mut at = start;
        let is_closed = loop {
            used.insert(at);
            // several ways on: two holes touch here
            let Some([only]) = next.get(&at).map(Vec::as_slice) else { break false };
            at = *only;
            if at == start {
                break true;
            }
            if used.contains(&at) {
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
