//! Meshes of edges as tubes with round ends: cables, rods, nets.

use souple_math::Vec3;
use souple_mesh::Mesh;

use super::mesh_surface::{Between, Cut, MeshSurface};
use super::surface::EdgeStyle;

/// Corners around a tube.
const AROUND: u32 = 8;
/// Rings of a tube, by how far they are beyond their end and how wide, in radii: `sin 45°` and `cos 45°`, and the end.
const RINGS: [[f64; 2]; 2] = [[0.707, 0.707], [0.0, 1.0]];

impl MeshSurface {
    /// The edges of a mesh, its points standing at `positions`, as tubes, each cell with its radius [m]; of a cut, what it
    /// leaves. A tube of no radius is not seen, and has its triangles all the same.
    pub fn tubes(mesh: &Mesh, positions: &[Vec3], radius: impl Fn(usize) -> f64, cut: Option<Cut>) -> Self {
        let mut of = Self::default();
        for (cell, view) in mesh.cells().enumerate().filter(|(_, view)| view.kind.dimension() == 1) {
            for pair in along(view.nodes).windows(2) {
                if let Some(shares) = left_of([pair[0], pair[1]], positions, cut) {
                    of.push_tube([pair[0], pair[1]], shares, positions, radius(cell), cell as u32);
                }
            }
        }
        // a tube has no edges of its own, whatever is drawn of others
        of.surface.edge_style = EdgeStyle::Hidden;
        of
    }

    fn push_tube(
        &mut self,
        [from, to]: [u32; 2],
        shares: [f64; 2],
        positions: &[Vec3],
        radius: f64,
        cell: u32,
    ) {
        let ends = shares.map(|share| Between { from, to, share });
        let places = ends.map(|end| end.of(positions));
        let axis = (places[1] - places[0]).try_normalised().unwrap_or(Vec3::X);
        let across = axis.any_orthogonal();
        let other = axis.cross(across);
        let first = self.points.len() as u32;
        let mut push = |end: usize, offset: Vec3| {
            self.points.push(ends[end]);
            self.surface.points.push(places[end] + offset * radius);
        };
        push(0, -axis);
        let rings = RINGS.iter().map(|ring| (0, -ring[0], ring[1]));
        let rings = rings.chain(RINGS.iter().rev().map(|ring| (1, ring[0], ring[1])));
        for (end, beyond, width) in rings {
            for k in 0..AROUND {
                let angle = std::f64::consts::TAU * f64::from(k) / f64::from(AROUND);
                let outward = across * libm::cos(angle) + other * libm::sin(angle);
                push(end, axis * beyond + outward * width);
            }
        }
        push(1, axis);
        let (count, last) = (2 * RINGS.len() as u32, self.points.len() as u32 - 1);
        let at = |ring: u32, k: u32| first + 1 + ring * AROUND + k % AROUND;
        for k in 0..AROUND {
            let triangles = &mut self.surface.triangles;
            triangles.push([first, at(0, k + 1), at(0, k)]);
            for ring in 0..count - 1 {
                let (a, b) = (at(ring, k), at(ring, k + 1));
                let (c, d) = (at(ring + 1, k + 1), at(ring + 1, k));
                triangles.extend([[a, b, c], [a, c, d]]);
            }
            triangles.push([last, at(count - 1, k), at(count - 1, k + 1)]);
        }
        self.surface.edges.resize(self.surface.triangles.len(), [false; 3]);
        self.cells.resize(self.surface.triangles.len(), cell);
    }
}

/// The nodes of an edge in their order along it: corners stand first, what is between them after.
pub(super) fn along(nodes: &[u32]) -> Vec<u32> {
    let (ends, middle) = nodes.split_at(2);
    [&[ends[0]], middle, &[ends[1]]].concat()
}

/// The part of an edge at or below the plane of a cut, by shares from its first point; `None` where nothing is left.
fn left_of([from, to]: [u32; 2], positions: &[Vec3], cut: Option<Cut>) -> Option<[f64; 2]> {
    let Some(cut) = cut else { return Some([0.0, 1.0]) };
    let height = |point: u32| (positions[point as usize] - cut.point).dot(cut.normal);
    let (a, b) = (height(from), height(to));
    match (a <= 0.0, b <= 0.0) {
        (true, true) => Some([0.0, 1.0]),
        (true, false) => Some([0.0, a / (a - b)]),
        (false, true) => Some([a / (a - b), 1.0]),
        (false, false) => None,
    }
}

#[cfg(test)]
mod tests {
    use souple_mesh::ElementKind;

    use super::*;

    fn chain() -> Mesh {
        let points = [0.0, 1.0, 3.0].map(|x| Vec3::new(x, 0.0, 0.0)).to_vec();
        Mesh::new(points, ElementKind::Edge2, vec![0, 1, 1, 2])
    }

    /// Tubes are closed, look outward, and are as long as their edges and twice their radius: a prism of eight sides
    /// with a frustum and a pyramid at each end has the volume that Green's theorem gives its surface.
    #[test]
    fn tubes_are_closed_and_look_outward() {
        let (mesh, radius) = (chain(), 0.1);
        let of = MeshSurface::tubes(&mesh, &mesh.points, |_| radius, None);
        let corner = |index: u32| of.surface.points[index as usize];
        let volume: f64 = of
            .surface
            .triangles
            .iter()
            .map(|t| corner(t[0]).dot(corner(t[1]).cross(corner(t[2]))) / 6.0)
            .sum();
        // area of the octagon of radius one: 4 sin 45°
        let (octagon, c) = (4.0 * 0.5_f64.sqrt() * radius * radius, 0.707);
        let end = octagon * radius * (c * (1.0 + c + c * c) / 3.0 + (1.0 - c) * c * c / 3.0);
        assert!((volume - (3.0 * octagon + 4.0 * end)).abs() < 1e-12, "{volume}");
        assert_eq!(of.cells.iter().filter(|cell| **cell == 1).count(), of.cells.len() / 2);
    }

    /// A cut leaves what is below it, painted by what is between the ends.
    #[test]
    fn cut_tubes_end_at_the_plane() {
        let mesh = chain();
        let cut = Cut { point: Vec3::new(2.0, 0.0, 0.0), normal: Vec3::X };
        let mut of = MeshSurface::tubes(&mesh, &mesh.points, |_| 1e-3, Some(cut));
        let reach = of.surface.points.iter().map(|point| point.x).fold(0.0, f64::max);
        assert!((reach - 2.001).abs() < 1e-12);
        of.paint_points(&[0.0, 10.0, 30.0]);
        let super::super::Paint::PointScalar(values) = &of.surface.paint else { panic!("painted") };
        assert!((values.iter().copied().fold(0.0, f64::max) - 20.0).abs() < 1e-12);
        let all = Cut { point: -Vec3::X, normal: Vec3::X };
        assert!(MeshSurface::tubes(&mesh, &mesh.points, |_| 1e-3, Some(all)).points.is_empty());
    }
}
