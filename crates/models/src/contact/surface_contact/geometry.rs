//! A point and a triangle: where the nearest point lies, how they stand to each other, what turns a triangle.

use souple_engine::Configuration;
use souple_math::{Real, Vec3};
use souple_mesh::TriangleSurface;

use super::super::law::Approach;

/// What of a triangle a point is nearest to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Region {
    Face,
    /// From this corner to the next.
    Edge(usize),
    Corner(usize),
}

/// Positions and velocities of a point and the corners of a triangle.
pub struct Corners<R> {
    pub positions: [Vec3<R>; 4],
    pub velocities: [Vec3<R>; 4],
}

impl Corners<f64> {
    pub fn at(rows: [u32; 4], at: &Configuration) -> Self {
        Self {
            positions: rows.map(|row| at.positions[row as usize]),
            velocities: rows.map(|row| at.velocities[row as usize]),
        }
    }
}

/// How the point stands to the triangle, and the weights of the corners at the nearest point; `None` where
/// there is no direction: a triangle squeezed to a line, a point on the edge or corner itself.
///
/// `anchor` are the weights of friction's anchor. In the plane of a triangle the weights may leave `[0, 1]` during a step: the plane goes on.
pub fn approach<R: Real>(
    region: Region,
    corners: &Corners<R>,
    anchor: [f64; 3],
    thickness: f64,
    value: impl Fn(R) -> f64,
) -> Option<(Approach<R>, [R; 3])> {
    let [x, a, b, c] = corners.positions;
    let ends = [a, b, c];
    let (zero, one) = (x.x.zero(), x.x.one());
    let (offset, weights) = match region {
        Region::Face => {
            // areas of the triangles of the projection of x with two corners each
            let across = (b - a).cross(c - a);
            let double_area_sq = across.length_sq();
            let area = |q: Vec3<R>, r: Vec3<R>| (q - x).cross(r - x).dot(across) / double_area_sq;
            (across, [area(b, c), area(c, a), area(a, b)])
        }
        Region::Edge(edge) => {
            let (from, to) = (edge, (edge + 1) % 3);
            let along = ends[to] - ends[from];
            let t = (x - ends[from]).dot(along) / along.length_sq();
            let mut weights = [zero; 3];
            (weights[from], weights[to]) = (one - t, t);
            (x - (ends[from] + along * t), weights)
        }
        Region::Corner(corner) => {
            let mut weights = [zero; 3];
            weights[corner] = one;
            (x - ends[corner], weights)
        }
    };
    let length = offset.length();
    if !value(length).is_normal() || !weights.into_iter().all(|weight| value(weight).is_finite()) {
        return None;
    }
    let normal = offset * (one / length);
    let distance = if region == Region::Face { normal.dot(x - a) } else { length };
    let anchor =
        ends[0] * one.splat(anchor[0]) + ends[1] * one.splat(anchor[1]) + ends[2] * one.splat(anchor[2]);
    let [v, va, vb, vc] = corners.velocities;
    let velocity = v - (va * weights[0] + vb * weights[1] + vc * weights[2]);
    Some((Approach { gap: distance - thickness, normal, from_anchor: x - anchor, velocity }, weights))
}

/// Forces on three corners of no sum and moment `M`: those of a rigid turn, `h_i = (I⁻¹ M) × r_i` with
/// `I = Σ |r|² - r rᵀ` about the middle. None for a triangle squeezed to a line.
pub fn turn<R: Real>(corners: [Vec3<R>; 3], moment: Vec3<R>, value: impl Fn(R) -> f64) -> [Vec3<R>; 3] {
    let middle = (corners[0] + corners[1] + corners[2]) * moment.x.splat(1.0 / 3.0);
    let arms = corners.map(|corner| corner - middle);
    let mut inertia = arms[0].outer(arms[0]).scaled(-moment.x.one()).plus_diagonal(arms[0].length_sq());
    for arm in &arms[1..] {
        inertia += arm.outer(*arm).scaled(-moment.x.one()).plus_diagonal(arm.length_sq());
    }
    let (determinant, size) = (inertia.determinant(), inertia.trace());
    if value(determinant) <= 1e-18 * value(size).powi(3) {
        return [moment * moment.x.zero(); 3];
    }
    let rotation = (inertia.cofactor().transpose() * moment) * (moment.x.one() / determinant);
    arms.map(|arm| rotation.cross(arm))
}

/// Barycentric coordinates of the projection of `x` on a triangle's plane, of its nearest point where it has none.
pub fn barycentric(x: Vec3, corners: [Vec3; 3]) -> [f64; 3] {
    let [a, b, c] = corners;
    let across = (b - a).cross(c - a);
    let area = |q: Vec3, r: Vec3| (q - x).cross(r - x).dot(across) / across.length_sq();
    let weights = [area(b, c), area(c, a), area(a, b)];
    if weights.iter().all(|weight| weight.is_finite()) {
        return weights;
    }
    souple_mesh::closest_point_on_triangle(x, corners).0
}

/// A third of the triangles around each point: the integral of its weight over the surface [m²].
pub fn corner_areas(surface: &TriangleSurface) -> Vec<f64> {
    let mut areas = vec![0.0; surface.points.len()];
    for (triangle, corners) in surface.triangles.iter().enumerate() {
        let third = surface.area_vector(triangle as u32).length() / 3.0;
        corners.iter().for_each(|corner| areas[*corner as usize] += third);
    }
    areas
}

/// Kinds of region in the number of a pair: face, edges, corners.
pub const REGIONS: u64 = 7;

impl Region {
    /// What [`region_code`] says.
    pub fn from_code(code: u64) -> Self {
        match code as usize {
            0 => Self::Face,
            edge @ 1..=3 => Self::Edge(edge - 1),
            corner => Self::Corner(corner - 4),
        }
    }
}

/// A point this close to the prism over a triangle, in parts of its size, is over the triangle itself: points
/// over the edges of a flat part are on its plane, not on an edge.
pub const OVER: f64 = 1e-6;

/// Where the nearest point lies, as part of a pair's number: from outside, weights of zero are corners it is
/// away from; from inside, and on the surface itself, the plane serves.
pub fn region_code(x: Vec3, corners: [Vec3; 3], weights: [f64; 3], distance: f64) -> u64 {
    if distance <= 0.0 || barycentric(x, corners).iter().all(|weight| *weight >= -OVER) {
        return 0;
    }
    match weights.map(|weight| weight == 0.0) {
        [false, false, false] => 0,
        [false, false, true] => 1,
        [true, false, false] => 2,
        [false, true, false] => 3,
        [false, true, true] => 4,
        [true, false, true] => 5,
        _ => 6,
    }
}
