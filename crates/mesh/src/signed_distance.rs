//! Signed distance to a closed triangulated surface: negative inside.
//!
//! The sign is that of `(p - closest) · n` with the pseudo-normal `n` of the face, edge or corner on which the
//! closest point lies: normals of the faces around it, weighted by their angles (Bærentzen & Aanæs 2005).

use souple_math::Vec3;

use crate::opening::opposite_triangles;
use crate::surface::corner_angles;
use crate::{Aabb, AabbTree, Feature, MeshError, TriangleSurface, closest_point_on_triangle};

/// The point of a surface that is closest to a given one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosestPoint {
    pub triangle: u32,
    /// Weights of the corners of the triangle.
    pub weights: [f64; 3],
    /// [m]
    pub position: Vec3,
    /// Unit pseudo-normal, outward.
    pub normal: Vec3,
    /// Negative inside [m].
    pub distance: f64,
}

/// A closed surface that answers how far points are from it.
#[derive(Clone, Debug)]
pub struct SignedDistance {
    surface: TriangleSurface,
    tree: AabbTree,
    face_normals: Vec<Vec3>,
    /// Of the edge from each corner to the next; sums of two unit normals.
    edge_normals: Vec<[Vec3; 3]>,
    /// Triangle and edge on the other side of each edge.
    opposite: Vec<[u32; 3]>,
    corner_normals: Vec<Vec3>,
    reoriented: bool,
}

impl SignedDistance {
    /// A surface that is inside out is turned, see [`SignedDistance::was_reoriented`].
    ///
    /// # Errors
    /// An edge that is not shared by exactly two triangles of opposite direction; a triangle without area.
    pub fn new(surface: TriangleSurface) -> Result<Self, MeshError> {
        let not_manifold = |(_, forward, backward): &([u32; 2], u32, u32)| (*forward, *backward) != (1, 1);
        if let Some(([a, b], forward, backward)) = surface.edge_uses().into_iter().find(not_manifold) {
            return Err(MeshError::OpenSurface { a, b, forward, backward });
        }
        Self::of_boundary(surface)
    }

    /// The same of the boundary of cells, parts of which may touch along edges: as many triangles run along an edge one way as the other.
    /// Whichever bound the same matter there belong together.
    ///
    /// # Errors
    /// An edge along which they do not; a triangle without area.
    pub fn of_boundary(mut surface: TriangleSurface) -> Result<Self, MeshError> {
        if surface.triangles.is_empty() {
            return Err(MeshError::NoCells);
        }
        surface.check_closed()?;
        let reoriented = surface.enclosed_volume() < 0.0;
        if reoriented {
            for corners in &mut surface.triangles {
                corners.swap(1, 2);
            }
        }
        let triangles = 0..surface.triangles.len() as u32;
        if let Some(triangle) = triangles.clone().find(|t| surface.area_vector(*t).try_normalised().is_none())
        {
            return Err(MeshError::FlatTriangle { triangle });
        }
        let boxes: Vec<Aabb> = triangles.map(|triangle| Aabb::of(surface.corners(triangle))).collect();
        let mut distance = Self {
            tree: AabbTree::build(&boxes),
            face_normals: vec![Vec3::ZERO; surface.triangles.len()],
            edge_normals: vec![[Vec3::ZERO; 3]; surface.triangles.len()],
            opposite: opposite_triangles(&surface),
            corner_normals: vec![Vec3::ZERO; surface.points.len()],
            surface,
            reoriented,
        };
        distance.update_normals();
        Ok(distance)
    }

    pub fn surface(&self) -> &TriangleSurface {
        &self.surface
    }

    /// Whether the triangles given had their normals inward and were turned.
    pub fn was_reoriented(&self) -> bool {
        self.reoriented
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let TriangleSurface { points, triangles, mesh_points, cells } = &self.surface;
        let vectors = points.capacity() + self.face_normals.capacity() + self.corner_normals.capacity();
        size_of::<Vec3>() * (vectors + 3 * self.edge_normals.capacity())
            + size_of::<[u32; 3]>() * (triangles.capacity() + self.opposite.capacity())
            + 4 * (mesh_points.capacity() + cells.capacity())
            + self.tree.bytes()
    }

    /// New positions of the points of the same surface; no allocation.
    ///
    /// # Panics
    /// If their number differs.
    pub fn move_points(&mut self, positions: &[Vec3]) {
        self.surface.points.copy_from_slice(positions);
        let surface = &self.surface;
        self.tree.refit((0..surface.triangles.len()).map(|t| Aabb::of(surface.corners(t as u32))));
        self.update_normals();
    }

    fn update_normals(&mut self) {
        let surface = &self.surface;
        self.corner_normals.fill(Vec3::ZERO);
        for (triangle, corners) in surface.triangles.iter().enumerate() {
            let normal = surface.area_vector(triangle as u32).try_normalised().unwrap_or(Vec3::ZERO);
            self.face_normals[triangle] = normal;
            for (point, angle) in corners.iter().zip(corner_angles(surface.corners(triangle as u32))) {
                self.corner_normals[*point as usize] += normal * angle;
            }
        }
        for (triangle, others) in self.opposite.iter().enumerate() {
            self.edge_normals[triangle] =
                others.map(|other| self.face_normals[triangle] + self.face_normals[other as usize]);
        }
    }

    /// The closest point of the surface; `None` where the point or the moved surface is not finite.
    pub fn closest(&self, point: Vec3) -> Option<ClosestPoint> {
        self.closest_within(point, f64::INFINITY)
    }

    /// The closest point of the surface if it is no farther than `limit` [m].
    pub fn closest_within(&self, point: Vec3, limit: f64) -> Option<ClosestPoint> {
        let on = |triangle: u32| {
            let corners = self.surface.corners(triangle);
            let (weights, feature) = closest_point_on_triangle(point, corners);
            let position = corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2];
            (weights, feature, position)
        };
        if !point.is_finite() {
            return None;
        }
        let distance_sq = |triangle| (point - on(triangle).2).length_sq();
        let (triangle, _) = self.tree.nearest(point, limit * limit, distance_sq)?;
        let (weights, feature, position) = on(triangle);
        let direction = match feature {
            Feature::Face => self.face_normals[triangle as usize],
            Feature::Edge(edge) => self.edge_normals[triangle as usize][usize::from(edge)],
            Feature::Corner(corner) => {
                let point = self.surface.triangles[triangle as usize][usize::from(corner)];
                self.corner_normals[point as usize]
            }
        };
        // opposite faces cancel on a fold of the surface: the face's own normal then
        let normal = direction.try_normalised().unwrap_or(self.face_normals[triangle as usize]);
        let offset = point - position;
        let distance = if offset.dot(normal) < 0.0 { -offset.length() } else { offset.length() };
        Some(ClosestPoint { triangle, weights, position, normal, distance })
    }

    /// Distance to the surface, negative inside [m]; NaN where there is no closest point.
    pub fn distance(&self, point: Vec3) -> f64 {
        self.closest(point).map_or(f64::NAN, |closest| closest.distance)
    }

    pub fn contains(&self, point: Vec3) -> bool {
        self.tree.bounds().contains(point) && self.distance(point) < 0.0
    }
}

#[cfg(test)]
mod tests {
    use souple_table::{Value, Values};

    use super::*;
    use crate::generate;

    fn unit_cube(cells: f64) -> TriangleSurface {
        let values = Values::new()
            .with("size", Value::Vector([1.0; 3]))
            .with("cells", Value::Vector([cells; 3]))
            .with("element", Value::Text("hex8"));
        generate("box", values).unwrap().boundary_surface()
    }

    /// Distance to the unit cube, by its formula.
    fn cube_distance(p: Vec3) -> f64 {
        let q = (0..3).map(|axis| (p[axis] - 0.5).abs() - 0.5);
        let outside = q.clone().map(|c| c.max(0.0).powi(2)).sum::<f64>().sqrt();
        outside + q.fold(f64::NEG_INFINITY, f64::max).min(0.0)
    }

    /// Points in, on and around the cube, with closest points on faces, edges and corners.
    fn probes() -> impl Iterator<Item = Vec3> {
        let at = |i: usize| -0.65 + 0.29 * i as f64;
        (0..9 * 9 * 9).map(move |i| Vec3::new(at(i % 9), at(i / 9 % 9), at(i / 81)))
    }

    #[test]
    fn distance_to_a_cube() {
        let cube = SignedDistance::new(unit_cube(3.0)).unwrap();
        for point in probes() {
            let closest = cube.closest(point).unwrap();
            assert!((closest.distance - cube_distance(point)).abs() < 1e-14, "{point:?} {closest:?}");
            assert_eq!(cube.contains(point), cube_distance(point) < 0.0, "{point:?}");
            assert_eq!(cube.closest_within(point, 0.2).is_some(), cube_distance(point).abs() <= 0.2);
        }
    }

    /// The distance moves with the surface, and a surface that is inside out is turned.
    #[test]
    fn distance_to_a_moved_cube() {
        let mut surface = unit_cube(2.0);
        for corners in &mut surface.triangles {
            corners.swap(0, 1);
        }
        let mut cube = SignedDistance::new(surface).unwrap();
        assert!(cube.was_reoriented());
        let shift = Vec3::new(3.0, -2.0, 1.0);
        let moved: Vec<Vec3> = cube.surface().points.iter().map(|point| *point + shift).collect();
        cube.move_points(&moved);
        for point in probes() {
            assert!((cube.distance(point + shift) - cube_distance(point)).abs() < 1e-13);
        }
    }

    /// Neither a point nor a surface that is not finite makes anything panic.
    #[test]
    fn not_finite() {
        let mut cube = SignedDistance::new(unit_cube(1.0)).unwrap();
        for bad in [f64::NAN, f64::INFINITY] {
            let point = Vec3::new(0.5, bad, 0.5);
            assert!(cube.closest(point).is_none() && cube.distance(point).is_nan() && !cube.contains(point));
        }
        cube.move_points(&[Vec3::new(f64::NAN, f64::NAN, f64::NAN); 8]);
        assert!(cube.closest(Vec3::ZERO).is_none() && !cube.contains(Vec3::ZERO));
    }

    #[test]
    fn open_and_flat_surfaces_are_refused() {
        let mut open = unit_cube(1.0);
        open.triangles.pop();
        assert!(matches!(SignedDistance::new(open), Err(MeshError::OpenSurface { .. })));
        let points = vec![Vec3::ZERO, Vec3::X, Vec3::X * 2.0];
        let flat = TriangleSurface::new(points, vec![[0, 1, 2], [0, 2, 1]]).unwrap();
        assert!(matches!(SignedDistance::new(flat), Err(MeshError::FlatTriangle { triangle: 0 })));
        let none = TriangleSurface::new(vec![Vec3::ZERO], Vec::new()).unwrap();
        assert_eq!(SignedDistance::new(none).unwrap_err(), MeshError::NoCells);
    }
}
