//! Points with a size as balls: grains, masses that keep others off.

use std::collections::HashMap;

use souple_math::Vec3;

use super::mesh_surface::{Between, Cut, MeshSurface};
use super::surface::EdgeStyle;

/// The golden ratio: corners of an icosahedron are `(0, ±1, ±φ)` and their rotations.
const PHI: f64 = 1.618_033_988_749_895;
const CORNERS: [[f64; 3]; 12] = [
    [-1.0, PHI, 0.0],
    [1.0, PHI, 0.0],
    [-1.0, -PHI, 0.0],
    [1.0, -PHI, 0.0],
    [0.0, -1.0, PHI],
    [0.0, 1.0, PHI],
    [0.0, -1.0, -PHI],
    [0.0, 1.0, -PHI],
    [PHI, 0.0, -1.0],
    [PHI, 0.0, 1.0],
    [-PHI, 0.0, -1.0],
    [-PHI, 0.0, 1.0],
];
const FACES: [[u32; 3]; 20] = [
    [0, 11, 5],
    [0, 5, 1],
    [0, 1, 7],
    [0, 7, 10],
    [0, 10, 11],
    [1, 5, 9],
    [5, 11, 4],
    [11, 10, 2],
    [10, 7, 6],
    [7, 1, 8],
    [3, 9, 4],
    [3, 4, 2],
    [3, 2, 6],
    [3, 6, 8],
    [3, 8, 9],
    [4, 9, 5],
    [2, 4, 11],
    [6, 2, 10],
    [8, 6, 7],
    [9, 8, 1],
];
/// Triangles of all balls of a body, about, and most cuts of their faces: few balls are large in a picture, and each is drawn finely.
const MOST_FACES: usize = 100_000;
const MOST_CUTS: u32 = 4;

/// How often the faces of each of so many balls are cut.
fn cuts_of(count: usize) -> u32 {
    let faces = |cuts: u32| FACES.len() * 4_usize.pow(cuts) * count;
    (2..=MOST_CUTS).rev().find(|cuts| faces(*cuts) <= MOST_FACES).unwrap_or(1)
}

impl MeshSurface {
    /// A ball about each point with a radius above zero [m]; of a cut, those whose middle it leaves.
    pub fn balls(positions: &[Vec3], radii: &[f64], cut: Option<Cut>) -> Self {
        let is_left = |x: Vec3| cut.is_none_or(|cut| (x - cut.point).dot(cut.normal) <= 0.0);
        let drawn = (0..positions.len()).filter(|i| radii[*i] > 0.0 && is_left(positions[*i]));
        let (corners, faces) = unit_ball(cuts_of(drawn.clone().count()));
        let mut of = Self::default();
        for point in drawn {
            let first = of.points.len() as u32;
            of.points.extend(corners.iter().map(|_| Between::at(point as u32)));
            of.surface.points.extend(corners.iter().map(|n| positions[point] + *n * radii[point]));
            of.surface.triangles.extend(faces.iter().map(|face| face.map(|corner| first + corner)));
        }
        of.surface.edges = vec![[false; 3]; of.surface.triangles.len()];
        of.surface.edge_style = EdgeStyle::Hidden;
        of
    }
}

/// An icosahedron whose faces are cut in four some times, its corners on the unit sphere.
fn unit_ball(cuts: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let unit = |x: Vec3| x.try_normalised().unwrap_or(Vec3::Z);
    let mut corners: Vec<Vec3> = CORNERS.iter().map(|corner| unit(Vec3::from_array(*corner))).collect();
    let mut faces = FACES.to_vec();
    for _ in 0..cuts {
        let mut middles: HashMap<[u32; 2], u32> = HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                corners.push(unit(corners[a as usize] + corners[b as usize]));
                corners.len() as u32 - 1
            })
        };
        let cut = |&[a, b, c]: &[u32; 3]| {
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
        };
        faces = faces.iter().flat_map(cut).collect();
    }
    (corners, faces)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ball looks outward and has nearly its volume: inscribed, a little less; finer ones have more of it.
    #[test]
    fn balls_look_outward() {
        let volume = |cuts: u32| -> f64 {
            let (corners, faces) = unit_ball(cuts);
            let corner = |face: &[u32; 3], k: usize| corners[face[k] as usize];
            faces.iter().map(|face| corner(face, 0).dot(corner(face, 1).cross(corner(face, 2))) / 6.0).sum()
        };
        let whole = 4.0 / 3.0 * std::f64::consts::PI;
        // lost between sphere and facets: by the square of the edge, which each cut halves
        let lost: Vec<f64> = (0..4).map(|cuts| whole - volume(cuts)).collect();
        assert!(
            lost.windows(2).all(|pair| pair[1] > 0.0 && (3.0..4.2).contains(&(pair[0] / pair[1]))),
            "{lost:?}"
        );
    }

    /// The outline of a ball that fills a picture of 800 pixels is off a circle by less than a pixel: of the edges of an
    /// icosahedron, 1.05 radii long, `n` cuts leave `1.05 / 2ⁿ`, and an edge of length `e` is `e² / 8` inside.
    #[test]
    fn few_balls_are_round() {
        let off = |count: usize| (1.05 / f64::from(1 << cuts_of(count))).powi(2) / 8.0;
        assert!(400.0 * off(2) < 1.0 && 400.0 * off(19) < 1.0, "{} {}", 400.0 * off(2), 400.0 * off(19));
        assert_eq!([1, 100, 300, 5000].map(cuts_of), [4, 2, 2, 1]);
    }

    #[test]
    fn balls_stand_where_points_are() {
        let positions = [Vec3::ZERO, Vec3::X * 5.0, Vec3::X * 9.0];
        let of = MeshSurface::balls(&positions, &[1.0, 0.0, 0.5], None);
        assert_eq!(of.points.iter().filter(|point| point.from == 1).count(), 0);
        for (place, from) in of.surface.points.iter().zip(&of.points) {
            let radius = if from.from == 0 { 1.0 } else { 0.5 };
            assert!(((*place - positions[from.from as usize]).length() - radius).abs() < 1e-12);
        }
        let cut = Cut { point: Vec3::X * 3.0, normal: Vec3::X };
        let left = MeshSurface::balls(&positions, &[1.0, 1.0, 1.0], Some(cut));
        assert!(left.points.iter().all(|point| point.from == 0) && !left.points.is_empty());
    }
}
