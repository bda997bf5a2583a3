//! The generalised winding number of triangles around a point: what a surface with faults encloses.
//!
//! `w(p) = Σ Ω(p)/4π`, the signed solid angles of the triangles: 1 inside a closed surface and 0 outside, smooth
//! across holes (Jacobson, Kavan & Sorkine-Hornung 2013). Triangles far away count as one dipole at their centre,
//! `a · (c - p) / 4π|c - p|³` with the sum `a` of their area vectors (Barill et al. 2018).

use std::f64::consts::PI;

use souple_math::Vec3;

use crate::tree::longest_axis;
use crate::{BoundingBox, TriangleSurface};

/// A group of triangles counts as a dipole beyond this multiple of its radius: the error is then below 0.02, where
/// what is decided is which side of one half.
const FAR: f64 = 3.0;

/// Triangles of one leaf at most.
const LEAF: usize = 8;

struct Node {
    /// Centre weighted by area.
    centre: Vec3,
    /// Of a ball around the centre that holds the triangles.
    radius: f64,
    /// Sum of the area vectors [m²].
    area: Vec3,
    /// Leaf: first of its triangles. Branch: its second child; the first one follows it.
    start: u32,
    /// Triangles of a leaf, zero for a branch.
    count: u32,
}

/// Answers winding numbers of a surface.
pub struct WindingNumber {
    nodes: Vec<Node>,
    triangles: Vec<[Vec3; 3]>,
}

impl WindingNumber {
    pub fn new(surface: &TriangleSurface) -> Self {
        let mut triangles: Vec<[Vec3; 3]> =
            (0..surface.triangles.len() as u32).map(|triangle| surface.corners(triangle)).collect();
        let mut number = Self { nodes: Vec::new(), triangles: Vec::new() };
        if !triangles.is_empty() {
            number.split(&mut triangles, 0);
        }
        number.triangles = triangles;
        number
    }

    fn split(&mut self, triangles: &mut [[Vec3; 3]], start: u32) {
        let centre_of = |[a, b, c]: &[Vec3; 3]| (*a + *b + *c) / 3.0;
        let area_of = |[a, b, c]: &[Vec3; 3]| (*b - *a).cross(*c - *a) * 0.5;
        let total: f64 = triangles.iter().map(|triangle| area_of(triangle).length()).sum();
        let weighted: Vec3 = triangles.iter().map(|t| centre_of(t) * area_of(t).length()).sum();
        let bounds = BoundingBox::of(triangles.iter().map(centre_of));
        let centre = if total > 0.0 { weighted / total } else { bounds.centre() };
        let radius = triangles.iter().flatten().map(|corner| (*corner - centre).length()).fold(0.0, f64::max);
        let area = triangles.iter().map(area_of).sum();
        let node = self.nodes.len();
        self.nodes.push(Node { centre, radius, area, start, count: triangles.len() as u32 });
        if triangles.len() <= LEAF {
            return;
        }
        let axis = longest_axis(bounds.size());
        let middle = triangles.len() / 2;
        triangles.sort_by(|a, b| centre_of(a)[axis].total_cmp(&centre_of(b)[axis]));
        let (low, high) = triangles.split_at_mut(middle);
        self.split(low, start);
        let second = self.nodes.len() as u32;
        self.split(high, start + middle as u32);
        (self.nodes[node].start, self.nodes[node].count) = (second, 0);
    }

    /// About 1 inside, 0 outside, by how much of the surface is seen from its back.
    pub fn at(&self, point: Vec3) -> f64 {
        if self.nodes.is_empty() { 0.0 } else { self.of_node(0, point) / (4.0 * PI) }
    }

    fn of_node(&self, index: u32, point: Vec3) -> f64 {
        let node = &self.nodes[index as usize];
        let offset = node.centre - point;
        let distance = offset.length();
        if distance > FAR * node.radius {
            return node.area.dot(offset) / distance.powi(3);
        }
        if node.count == 0 {
            return self.of_node(index + 1, point) + self.of_node(node.start, point);
        }
        let leaf = &self.triangles[node.start as usize..(node.start + node.count) as usize];
        leaf.iter().map(|corners| solid_angle(corners.map(|corner| corner - point))).sum()
    }
}

/// The solid angle of a triangle seen from the origin, positive from its back [sr] (Van Oosterom & Strackee 1983).
fn solid_angle([a, b, c]: [Vec3; 3]) -> f64 {
    let [p, q, r] = [a, b, c].map(|corner| corner.length());
    let below = p * q * r + a.dot(b) * r + b.dot(c) * p + c.dot(a) * q;
    2.0 * libm::atan2(a.dot(b.cross(c)), below)
}

#[cfg(test)]
mod tests {
    use souple_table::{Value, Values};

    use super::*;

    fn ball() -> TriangleSurface {
        let values = Values::new().with("radius", Value::Number(1.0)).with("cells", Value::Integer(8));
        crate::generate("sphere", values).unwrap().boundary_surface()
    }

    /// One inside and none outside a closed surface, up to the dipoles; minus one inside an inverted one.
    #[test]
    fn closed_surfaces_wind_once() {
        let mut surface = ball();
        let number = WindingNumber::new(&surface);
        surface.triangles.iter_mut().for_each(|corners| corners.swap(0, 1));
        let inverted = WindingNumber::new(&surface);
        for step in 0..40 {
            let radius = 0.1 * f64::from(step) + 0.03;
            let point = Vec3::new(0.48, 0.6, -0.64) * radius;
            // the chords of a ball of eight cubes across are within 0.05 of the sphere
            let expected = if radius < 0.95 {
                1.0
            } else if radius > 1.0 {
                0.0
            } else {
                continue;
            };
            assert!((number.at(point) - expected).abs() < 0.02, "{radius}: {}", number.at(point));
            assert!((inverted.at(point) + expected).abs() < 0.02);
        }
    }

    /// Without a fifth of its triangles a ball still has an inside.
    #[test]
    fn open_surfaces_have_an_inside() {
        let mut surface = ball();
        let centres: Vec<Vec3> = (0..surface.triangles.len() as u32)
            .map(|t| surface.corners(t).into_iter().sum::<Vec3>() / 3.0)
            .collect();
        let mut keep = centres.iter().map(|centre| centre.x < 0.6);
        surface.triangles.retain(|_| keep.next().unwrap());
        let number = WindingNumber::new(&surface);
        assert!(number.at(Vec3::ZERO) > 0.7);
        assert!(number.at(Vec3::X * -0.9) > 0.9);
        assert!(number.at(Vec3::X * 1.5) < 0.2);
    }
}
