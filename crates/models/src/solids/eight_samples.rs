//! The hexahedron of eight samples, at the corners of a smaller cube.
//!
//! `∂x/∂ξ` does not depend on `ξ`, so two samples share it, and so along `η` and `ζ`: twelve vectors are all gradients there
//! are. Made from the nodes once per element they cost a fifth of what eight samples of [`super::linear_elements::Hexahedron`]
//! do, and a sample takes three of them as they are.

use souple_math::{Mat3, Real, Vec3};
use souple_mesh::{ElementKind, QuadratureRule};

use super::geometry::{Geometry, accumulate};

/// Trilinear, with samples at `(±a, ±a, ±a)`. Its numbers at a sample are `ξ`; its parts `∂x/∂ξ` at the four `(η, ζ)`, then
/// `∂x/∂η` at the four `(ζ, ξ)`, then `∂x/∂ζ` at the four `(ξ, η)`, the first of each pair the fastest.
#[derive(Clone, Copy, Debug)]
pub struct EightSamples;

impl EightSamples {
    /// Whether the samples of a rule lie so.
    pub fn fit(rule: &QuadratureRule) -> bool {
        let a = rule.points[0].position.x.abs();
        let lies_so = |xi: Vec3| xi.to_array().iter().all(|number| number.abs() == a);
        rule.points.len() == 8 && rule.points.iter().all(|point| lies_so(point.position))
    }
}

/// `((1 + a) u + (1 - a) v, (1 - a) u + (1 + a) v)`: twice the values at `-a` and `a` between those at -1 and 1.
#[inline(always)]
fn between<R: Real>(u: Vec3<R>, v: Vec3<R>, a: R) -> (Vec3<R>, Vec3<R>) {
    let (sum, difference) = (u + v, v - u);
    let (mut near, mut far) = (sum, sum);
    accumulate(&mut near, difference, -a);
    accumulate(&mut far, difference, a);
    (near, far)
}

/// The same in both directions of a square, four times the values; its own transpose.
#[inline(always)]
fn within<R: Real>([u, v, w, x]: [Vec3<R>; 4], a: R) -> [Vec3<R>; 4] {
    let ((u, v), (w, x)) = (between(u, v, a), between(w, x, a));
    let ((u, w), (v, x)) = (between(u, w, a), between(v, x, a));
    [u, v, w, x]
}

/// Places of the vectors of a sample among the parts.
#[inline(always)]
fn places(xi: Vec3) -> [usize; 3] {
    let [x, y, z] = xi.to_array().map(|number| usize::from(number > 0.0));
    [y + 2 * z, 4 + z + 2 * x, 8 + x + 2 * y]
}

impl Geometry for EightSamples {
    const NODES: Option<usize> = Some(8);
    const SAMPLES: Option<usize> = Some(8);
    const PARTS: Option<usize> = Some(12);

    fn numbers(_: ElementKind, xi: Vec3) -> Vec<Vec3> {
        vec![xi]
    }

    #[inline(always)]
    fn to_parts<R: Real>(x: &mut [Vec3<R>], numbers: &[Vec3]) {
        let (a, eighth) = (x[0].x.splat(numbers[0].x.abs()), x[0].x.splat(0.125));
        for node in 0..8 {
            x[node] = x[node] * eighth;
        }
        let along_xi = within([x[1] - x[0], x[2] - x[3], x[5] - x[4], x[6] - x[7]], a);
        let along_eta = within([x[3] - x[0], x[7] - x[4], x[2] - x[1], x[6] - x[5]], a);
        let along_zeta = within([x[4] - x[0], x[5] - x[1], x[7] - x[3], x[6] - x[2]], a);
        x[0..4].copy_from_slice(&along_xi);
        x[4..8].copy_from_slice(&along_eta);
        x[8..12].copy_from_slice(&along_zeta);
    }

    #[inline(always)]
    fn gradient<R: Real>(parts: &[Vec3<R>], numbers: &[Vec3]) -> Mat3<R> {
        let [xi, eta, zeta] = places(numbers[0]);
        Mat3::from_columns(parts[xi], parts[eta], parts[zeta])
    }

    #[inline(always)]
    fn spread<R: Real>(stress: &Mat3<R>, numbers: &[Vec3], sums: &mut [Vec3<R>]) {
        let [xi, eta, zeta] = places(numbers[0]);
        sums[xi] -= stress.columns[0];
        sums[eta] -= stress.columns[1];
        sums[zeta] -= stress.columns[2];
    }

    #[inline(always)]
    fn to_nodes<R: Real>(f: &mut [Vec3<R>], numbers: &[Vec3]) {
        let (a, eighth) = (f[0].x.splat(numbers[0].x.abs()), f[0].x.splat(0.125));
        let xi = within([f[0], f[1], f[2], f[3]], a);
        let eta = within([f[4], f[5], f[6], f[7]], a);
        let zeta = within([f[8], f[9], f[10], f[11]], a);
        f[0] = -xi[0] - eta[0] - zeta[0];
        f[1] = xi[0] - eta[2] - zeta[1];
        f[2] = xi[1] + eta[2] - zeta[3];
        f[3] = eta[0] - xi[1] - zeta[2];
        f[4] = zeta[0] - xi[2] - eta[1];
        f[5] = xi[2] - eta[3] + zeta[1];
        f[6] = xi[3] + eta[3] + zeta[3];
        f[7] = eta[1] - xi[3] + zeta[2];
        for node in 0..8 {
            f[node] = f[node] * eighth;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::geometry::assert_parts_are_nodes;
    use super::*;

    /// The rules of eight samples lie so, others do not, and there gradients and forces are those by nodes.
    #[test]
    fn gradients_are_shared() {
        let fitting: Vec<_> =
            ElementKind::Hex8.rules().iter().filter(|rule| EightSamples::fit(rule)).collect();
        assert_eq!(fitting.iter().map(|rule| rule.name).collect::<Vec<_>>(), ["gauss_8"]);
        let samples: Vec<Vec3> = fitting[0].points.iter().map(|point| point.position).collect();
        assert_parts_are_nodes::<EightSamples>(ElementKind::Hex8, &samples);
    }
}
