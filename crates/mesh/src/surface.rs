//! Triangulated surfaces: areas, normals, enclosed volume, closest points.

use souple_math::Vec3;

use crate::{BoundingBox, MeshError};

/// A triangulated surface, its points numbered for itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleSurface {
    /// Positions [m].
    pub points: Vec<Vec3>,
    /// Corners, counterclockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Point of the mesh that each point is; empty for a surface of its own.
    pub mesh_points: Vec<u32>,
    /// Cell (or facet) of the mesh that each triangle bounds; empty for a surface of its own.
    pub cells: Vec<u32>,
}

/// Where on a triangle a closest point lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feature {
    Face,
    /// The edge from this corner to the next.
    Edge(u8),
    Corner(u8),
}

impl TriangleSurface {
    /// A surface of its own.
    ///
    /// # Errors
    /// Coordinates that are not finite, corners that do not exist or repeat.
    pub fn new(points: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        if points.is_empty() {
            return Err(MeshError::NoPoints);
        }
        if let Some(point) = points.iter().position(|point| !point.is_finite()) {
            let position = points[point].to_array();
            return Err(MeshError::PointNotFinite { point: point as u32, position });
        }
        for (triangle, corners) in triangles.iter().enumerate() {
            let (cell, kind, list) = (triangle as u32, crate::ElementKind::Tri3, "triangles");
            for (place, &point) in corners.iter().enumerate() {
                if point as usize >= points.len() {
                    return Err(MeshError::MissingPoint {
                        list,
                        cell,
                        kind,
                        point,
                        point_count: points.len(),
                    });
                }
                if corners[..place].contains(&point) {
                    return Err(MeshError::DuplicateNode { list, cell, kind, point });
                }
            }
        }
        Ok(Self { points, triangles, mesh_points: Vec::new(), cells: Vec::new() })
    }

    /// Triangles of a mesh, their points renumbered in ascending order.
    pub(crate) fn from_mesh(points: &[Vec3], triangles: &[[u32; 3]], cells: Vec<u32>) -> Self {
        let mut mesh_points: Vec<u32> = triangles.iter().flatten().copied().collect();
        mesh_points.sort_unstable();
        mesh_points.dedup();
        // searched for, so that of a small part not all points of the mesh are looked at
        let number = |node: u32| mesh_points.partition_point(|point| *point < node) as u32;
        Self {
            points: mesh_points.iter().map(|point| points[*point as usize]).collect(),
            triangles: triangles.iter().map(|corners| corners.map(number)).collect(),
            mesh_points,
            cells,
        }
    }

    /// Corners of a triangle [m].
    pub fn corners(&self, triangle: u32) -> [Vec3; 3] {
        self.triangles[triangle as usize].map(|point| self.points[point as usize])
    }

    /// The mean length of the edges of its triangles [m]; those of two triangles count twice.
    pub fn mean_edge(&self) -> f64 {
        let mut sum = 0.0;
        for triangle in 0..self.triangles.len() as u32 {
            let [a, b, c] = self.corners(triangle);
            sum += (b - a).length() + (c - b).length() + (a - c).length();
        }
        sum / (3 * self.triangles.len().max(1)) as f64
    }

    /// Half the cross product of two sides: area times outward normal [m²].
    pub fn area_vector(&self, triangle: u32) -> Vec3 {
        let [a, b, c] = self.corners(triangle);
        (b - a).cross(c - a) * 0.5
    }

    /// Total area [m²].
    pub fn area(&self) -> f64 {
        (0..self.triangles.len() as u32).map(|triangle| self.area_vector(triangle).length()).sum()
    }

    /// Enclosed volume of a closed surface, negative when it is inside out [m³].
    pub fn enclosed_volume(&self) -> f64 {
        // ⅙ Σ (a - o) · ((b - o) × (c - o)), o near the surface so that nothing large cancels
        let origin = self.bounds().centre();
        let tetrahedron = |corners: [Vec3; 3]| {
            let [a, b, c] = corners.map(|corner| corner - origin);
            a.dot(b.cross(c)) / 6.0
        };
        (0..self.triangles.len() as u32).map(|triangle| tetrahedron(self.corners(triangle))).sum()
    }

    pub fn bounds(&self) -> BoundingBox {
        BoundingBox::of(self.points.iter().copied())
    }

    /// Unit normals of the points, see [`vertex_normals`].
    pub fn vertex_normals(&self) -> Vec<Vec3> {
        vertex_normals(&self.points, &self.triangles)
    }

    /// Edges with the number of triangles that run along them upward and downward in point number, ascending.
    pub fn edge_uses(&self) -> Vec<([u32; 2], u32, u32)> {
        let mut directed: Vec<([u32; 2], bool)> = Vec::with_capacity(3 * self.triangles.len());
        for [a, b, c] in &self.triangles {
            for [from, to] in [[*a, *b], [*b, *c], [*c, *a]] {
                directed.push(([from.min(to), from.max(to)], from < to));
            }
        }
        directed.sort_unstable();
        let count = |same: &[([u32; 2], bool)]| {
            let forward = same.iter().filter(|(_, upward)| *upward).count() as u32;
            (same[0].0, forward, same.len() as u32 - forward)
        };
        directed.chunk_by(|a, b| a.0 == b.0).map(count).collect()
    }

    /// Points at which the surface is no manifold, ascending: their triangles are not one fan around them.
    pub fn pinched_points(&self) -> Vec<u32> {
        // each triangle leads around its corner from the next one to the one after
        let mut leads: Vec<[u32; 3]> = Vec::with_capacity(3 * self.triangles.len());
        for [a, b, c] in &self.triangles {
            leads.extend([[*a, *b, *c], [*b, *c, *a], [*c, *a, *b]]);
        }
        leads.sort_unstable();
        let around = leads.chunk_by(|a, b| a[0] == b[0]);
        around.filter(|around| !is_one_fan(around)).map(|around| around[0][0]).collect()
    }

    /// # Errors
    /// The first edge that is not shared by two triangles of opposite direction. Bodies that touch along an edge
    /// have several such pairs and pass.
    pub fn check_closed(&self) -> Result<(), MeshError> {
        match self.edge_uses().into_iter().find(|(_, forward, backward)| forward != backward) {
            Some(([a, b], forward, backward)) => Err(MeshError::OpenSurface { a, b, forward, backward }),
            None => Ok(()),
        }
    }
}

/// Whether the triangles of a point, each `[point, from, to]` and ascending, follow each other from an end to the other or around.
fn is_one_fan(around: &[[u32; 3]]) -> bool {
    let mut ends: Vec<u32> = around.iter().map(|lead| lead[2]).collect();
    ends.sort_unstable();
    if around.windows(2).any(|pair| pair[0][1] == pair[1][1])
        || ends.windows(2).any(|pair| pair[0] == pair[1])
    {
        return false;
    }
    let start = around.iter().find(|lead| ends.binary_search(&lead[1]).is_err()).unwrap_or(&around[0]);
    let (mut here, mut steps) = (start[2], 1);
    while here != start[1]
        && let Ok(next) = around.binary_search_by_key(&here, |lead| lead[1])
    {
        here = around[next][2];
        steps += 1;
    }
    steps == around.len()
}

/// Unit normals of points: normals of their triangles weighted by the angle at the point, which does not depend
/// on how a flat part is cut. A point of no triangle, or of cancelling ones, gets zero.
pub fn vertex_normals(points: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut normals = vec![Vec3::ZERO; points.len()];
    for corners in triangles {
        let [a, b, c] = corners.map(|point| points[point as usize]);
        let Some(normal) = (b - a).cross(c - a).try_normalised() else { continue };
        for (point, angle) in corners.iter().zip(corner_angles([a, b, c])) {
            normals[*point as usize] += normal * angle;
        }
    }
    normals.into_iter().map(|normal| normal.try_normalised().unwrap_or(Vec3::ZERO)).collect()
}

/// Angles at the corners of a triangle [rad].
pub(crate) fn corner_angles([a, b, c]: [Vec3; 3]) -> [f64; 3] {
    // atan2 of |u × v| and u · v is accurate for all angles
    let angle = |at: Vec3, p: Vec3, q: Vec3| {
        let (u, v) = (p - at, q - at);
        libm::atan2(u.cross(v).length(), u.dot(v))
    };
    [angle(a, b, c), angle(b, c, a), angle(c, a, b)]
}

/// Closest point of a triangle to `p`: weights of its corners, and on what it lies.
///
/// Triangles squeezed to a line or a point, which a moving surface may hold, are answered by their edges.
pub fn closest_point_on_triangle(p: Vec3, [a, b, c]: [Vec3; 3]) -> ([f64; 3], Feature) {
    // areas of the triangles that the projection of p makes with each edge, times |(b-a) × (c-a)|
    let normal = (b - a).cross(c - a);
    let areas = [(b, c), (c, a), (a, b)].map(|(q, r)| (q - p).cross(r - p).dot(normal));
    let sum = areas[0] + areas[1] + areas[2];
    if areas.iter().all(|area| *area > 0.0) && sum.is_normal() {
        return (areas.map(|area| area / sum), Feature::Face);
    }
    let mut best = ([1.0, 0.0, 0.0], Feature::Corner(0));
    let mut least = f64::INFINITY;
    for (edge, (q, r)) in [(a, b), (b, c), (c, a)].into_iter().enumerate() {
        let along = r - q;
        let length_sq = along.length_sq();
        let t = if length_sq > 0.0 { ((p - q).dot(along) / length_sq).clamp(0.0, 1.0) } else { 0.0 };
        let distance_sq = (q + along * t - p).length_sq();
        if distance_sq < least {
            let (from, to) = (edge, (edge + 1) % 3);
            let mut weights = [0.0; 3];
            (weights[from], weights[to]) = (1.0 - t, t);
            let feature = if t == 0.0 {
                Feature::Corner(from as u8)
            } else if t == 1.0 {
                Feature::Corner(to as u8)
            } else {
                Feature::Edge(edge as u8)
            };
            (best, least) = ((weights, feature), distance_sq);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    fn position(weights: [f64; 3], [a, b, c]: [Vec3; 3]) -> Vec3 {
        a * weights[0] + b * weights[1] + c * weights[2]
    }

    /// Above each region of the plane around a triangle, the closest point is on the feature of that region.
    #[test]
    fn features_of_a_triangle() {
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
        for (x, y, feature, closest) in [
            (0.25, 0.25, Feature::Face, (0.25, 0.25)),
            (-1.0, -1.0, Feature::Corner(0), (0.0, 0.0)),
            (3.0, 0.5, Feature::Corner(1), (1.0, 0.0)),
            (0.5, 3.0, Feature::Corner(2), (0.0, 1.0)),
            (0.25, -1.0, Feature::Edge(0), (0.25, 0.0)),
            (1.0, 1.0, Feature::Edge(1), (0.5, 0.5)),
            (-1.0, 0.25, Feature::Edge(2), (0.0, 0.25)),
        ] {
            let (weights, on) = closest_point_on_triangle(Vec3::new(x, y, 0.7), corners);
            assert_eq!(on, feature, "{x} {y}");
            let offset = position(weights, corners) - Vec3::new(closest.0, closest.1, 0.0);
            assert!(offset.length() < 1e-15, "{x} {y} {weights:?}");
        }
    }

    /// Triangles squeezed to a line or to a point still have a closest point.
    #[test]
    fn degenerate_triangles() {
        let p = Vec3::new(0.5, 1.0, 0.0);
        let lines = [
            [Vec3::ZERO, Vec3::X, Vec3::X * 2.0],
            [Vec3::ZERO, Vec3::ZERO, Vec3::X],
            [Vec3::X, Vec3::ZERO, Vec3::ZERO],
            [Vec3::X, Vec3::ZERO, Vec3::X],
        ];
        for corners in lines {
            let (weights, _) = closest_point_on_triangle(p, corners);
            assert_eq!(position(weights, corners), Vec3::new(0.5, 0.0, 0.0), "{corners:?}");
        }
        let (weights, feature) = closest_point_on_triangle(p, [Vec3::Z; 3]);
        assert_eq!((weights, feature), ([1.0, 0.0, 0.0], Feature::Corner(0)));
    }
}
