//! Linear elements by the parts of their fields, and not by their nodes.
//!
//! A trilinear field is `m₀ + m₁ξ + m₂η + m₃ζ + m₄ηζ + m₅ζξ + m₆ξη + m₇ξηζ`: at a sample its gradient takes three products
//! a column in the place of eight, and as few on the way back. Parts are made from nodes once per element, and sums on
//! parts are brought to nodes once, by the transpose.

use souple_math::{Mat3, Real, Vec3};
use souple_mesh::ElementKind;

use super::geometry::{Geometry, accumulate};

/// Trilinear; its numbers at a sample are `ξ`. Parts stand in the places of nodes, that of 1 (whose gradient is zero) first.
#[derive(Clone, Copy, Debug)]
pub struct Hexahedron;

/// Linear on the triangle times linear along the axis, `m₁ξ + m₂η + m₃ζ + m₄ξζ + m₅ηζ`; its numbers at a sample are `ξ`.
#[derive(Clone, Copy, Debug)]
pub struct Prism;

/// `m₁ξ + m₂η + m₃ζ + m₄r` with `r = ξη/(1 - ζ)`; its numbers at a sample are `∇r`.
#[derive(Clone, Copy, Debug)]
pub struct Pyramid;

/// `(a + b, b - a)`.
#[inline(always)]
fn butterfly<R: Real>(a: Vec3<R>, b: Vec3<R>) -> (Vec3<R>, Vec3<R>) {
    (a + b, b - a)
}

impl Geometry for Hexahedron {
    const NODES: Option<usize> = Some(8);
    const SAMPLES: Option<usize> = None;

    fn numbers(_: ElementKind, xi: Vec3) -> Vec<Vec3> {
        vec![xi]
    }

    // sums and differences along ξ, then η, then ζ
    #[inline(always)]
    fn to_parts<R: Real>(x: &mut [Vec3<R>], _: &[Vec3]) {
        let eighth = x[0].x.splat(0.125);
        let ((sum_0, xi_0), (sum_1, xi_1)) = (butterfly(x[0], x[1]), butterfly(x[3], x[2]));
        let ((sum_2, xi_2), (sum_3, xi_3)) = (butterfly(x[4], x[5]), butterfly(x[7], x[6]));
        let ((sum, eta), (xi, xi_eta)) = (butterfly(sum_0, sum_1), butterfly(xi_0, xi_1));
        let ((top, top_eta), (top_xi, top_xi_eta)) = (butterfly(sum_2, sum_3), butterfly(xi_2, xi_3));
        x[1] = (xi + top_xi) * eighth;
        x[2] = (eta + top_eta) * eighth;
        x[3] = (top - sum) * eighth;
        x[4] = (top_eta - eta) * eighth;
        x[5] = (top_xi - xi) * eighth;
        x[6] = (xi_eta + top_xi_eta) * eighth;
        x[7] = (top_xi_eta - xi_eta) * eighth;
    }

    #[inline(always)]
    fn gradient<R: Real>(m: &[Vec3<R>], numbers: &[Vec3]) -> Mat3<R> {
        let Vec3 { x, y, z } = numbers[0];
        let like = m[1].x;
        let (mut along_xi, mut along_eta, mut along_zeta) = (m[1], m[2], m[3]);
        accumulate(&mut along_xi, m[5], like.splat(z));
        accumulate(&mut along_xi, m[6], like.splat(y));
        accumulate(&mut along_xi, m[7], like.splat(y * z));
        accumulate(&mut along_eta, m[4], like.splat(z));
        accumulate(&mut along_eta, m[6], like.splat(x));
        accumulate(&mut along_eta, m[7], like.splat(z * x));
        accumulate(&mut along_zeta, m[4], like.splat(y));
        accumulate(&mut along_zeta, m[5], like.splat(x));
        accumulate(&mut along_zeta, m[7], like.splat(x * y));
        Mat3::from_columns(along_xi, along_eta, along_zeta)
    }

    #[inline(always)]
    fn spread<R: Real>(stress: &Mat3<R>, numbers: &[Vec3], sums: &mut [Vec3<R>]) {
        let Vec3 { x, y, z } = numbers[0];
        let [a, b, c] = stress.columns;
        let like = a.x;
        sums[1] -= a;
        sums[2] -= b;
        sums[3] -= c;
        accumulate(&mut sums[4], b, like.splat(-z));
        accumulate(&mut sums[4], c, like.splat(-y));
        accumulate(&mut sums[5], a, like.splat(-z));
        accumulate(&mut sums[5], c, like.splat(-x));
        accumulate(&mut sums[6], a, like.splat(-y));
        accumulate(&mut sums[6], b, like.splat(-x));
        accumulate(&mut sums[7], a, like.splat(-y * z));
        accumulate(&mut sums[7], b, like.splat(-z * x));
        accumulate(&mut sums[7], c, like.splat(-x * y));
    }

    #[inline(always)]
    fn to_nodes<R: Real>(f: &mut [Vec3<R>], _: &[Vec3]) {
        let eighth = f[0].x.splat(0.125);
        let (eta, top_eta) = (f[2] - f[4], f[2] + f[4]);
        let ((top_xi, xi), (top_xi_eta, xi_eta)) = (back(f[1], f[5]), back(f[6], f[7]));
        let zeta = f[3];
        let ((far_1, near_1), (far_xi, near_xi)) = (back(-zeta, eta), back(xi, xi_eta));
        let ((top_far_1, top_near_1), (top_far_xi, top_near_xi)) =
            (back(zeta, top_eta), back(top_xi, top_xi_eta));
        (f[1], f[0]) = back(near_1, near_xi);
        (f[2], f[3]) = back(far_1, far_xi);
        (f[5], f[4]) = back(top_near_1, top_near_xi);
        (f[6], f[7]) = back(top_far_1, top_far_xi);
        for node in 0..8 {
            f[node] = f[node] * eighth;
        }
    }
}

/// `(a + b, a - b)`.
#[inline(always)]
fn back<R: Real>(a: Vec3<R>, b: Vec3<R>) -> (Vec3<R>, Vec3<R>) {
    (a + b, a - b)
}

impl Geometry for Prism {
    const NODES: Option<usize> = Some(6);
    const SAMPLES: Option<usize> = None;

    fn numbers(_: ElementKind, xi: Vec3) -> Vec<Vec3> {
        vec![xi]
    }

    #[inline(always)]
    fn to_parts<R: Real>(x: &mut [Vec3<R>], _: &[Vec3]) {
        let half = x[0].x.splat(0.5);
        let (xi, eta) = (x[1] - x[0], x[2] - x[0]);
        let (top_xi, top_eta) = (x[4] - x[3], x[5] - x[3]);
        let zeta = x[3] - x[0];
        x[1] = (xi + top_xi) * half;
        x[2] = (eta + top_eta) * half;
        x[3] = zeta * half;
        x[4] = (top_xi - xi) * half;
        x[5] = (top_eta - eta) * half;
    }

    #[inline(always)]
    fn gradient<R: Real>(m: &[Vec3<R>], numbers: &[Vec3]) -> Mat3<R> {
        let Vec3 { x, y, z } = numbers[0];
        let like = m[1].x;
        let (mut along_xi, mut along_eta, mut along_zeta) = (m[1], m[2], m[3]);
        accumulate(&mut along_xi, m[4], like.splat(z));
        accumulate(&mut along_eta, m[5], like.splat(z));
        accumulate(&mut along_zeta, m[4], like.splat(x));
        accumulate(&mut along_zeta, m[5], like.splat(y));
        Mat3::from_columns(along_xi, along_eta, along_zeta)
    }

    #[inline(always)]
    fn spread<R: Real>(stress: &Mat3<R>, numbers: &[Vec3], sums: &mut [Vec3<R>]) {
        let Vec3 { x, y, z } = numbers[0];
        let [a, b, c] = stress.columns;
        let like = a.x;
        sums[1] -= a;
        sums[2] -= b;
        sums[3] -= c;
        accumulate(&mut sums[4], a, like.splat(-z));
        accumulate(&mut sums[4], c, like.splat(-x));
        accumulate(&mut sums[5], b, like.splat(-z));
        accumulate(&mut sums[5], c, like.splat(-y));
    }

    #[inline(always)]
    fn to_nodes<R: Real>(f: &mut [Vec3<R>], _: &[Vec3]) {
        let half = f[0].x.splat(0.5);
        let ((top_xi, xi), (top_eta, eta)) = (back(f[1], f[4]), back(f[2], f[5]));
        let zeta = f[3] * half;
        f[1] = xi * half;
        f[2] = eta * half;
        f[4] = top_xi * half;
        f[5] = top_eta * half;
        f[0] = -zeta - f[1] - f[2];
        f[3] = zeta - f[4] - f[5];
    }
}

impl Geometry for Pyramid {
    const NODES: Option<usize> = Some(5);
    const SAMPLES: Option<usize> = None;

    // r is 1, -1, 1, -1 at the corners of the base and 0 at the apex
    fn numbers(kind: ElementKind, xi: Vec3) -> Vec<Vec3> {
        let gradients = kind.shape_gradients(xi);
        vec![gradients[0] - gradients[1] + gradients[2] - gradients[3]]
    }

    #[inline(always)]
    fn to_parts<R: Real>(x: &mut [Vec3<R>], _: &[Vec3]) {
        let quarter = x[0].x.splat(0.25);
        let ((sum_0, xi_0), (sum_1, xi_1)) = (butterfly(x[0], x[1]), butterfly(x[3], x[2]));
        let ((sum, eta), (xi, r)) = (butterfly(sum_0, sum_1), butterfly(xi_0, xi_1));
        x[1] = xi * quarter;
        x[2] = eta * quarter;
        x[3] = x[4] - sum * quarter;
        x[4] = r * quarter;
    }

    #[inline(always)]
    fn gradient<R: Real>(m: &[Vec3<R>], numbers: &[Vec3]) -> Mat3<R> {
        let Vec3 { x, y, z } = numbers[0];
        let like = m[1].x;
        let (mut along_xi, mut along_eta, mut along_zeta) = (m[1], m[2], m[3]);
        accumulate(&mut along_xi, m[4], like.splat(x));
        accumulate(&mut along_eta, m[4], like.splat(y));
        accumulate(&mut along_zeta, m[4], like.splat(z));
        Mat3::from_columns(along_xi, along_eta, along_zeta)
    }

    #[inline(always)]
    fn spread<R: Real>(stress: &Mat3<R>, numbers: &[Vec3], sums: &mut [Vec3<R>]) {
        let Vec3 { x, y, z } = numbers[0];
        let [a, b, c] = stress.columns;
        let like = a.x;
        sums[1] -= a;
        sums[2] -= b;
        sums[3] -= c;
        accumulate(&mut sums[4], a, like.splat(-x));
        accumulate(&mut sums[4], b, like.splat(-y));
        accumulate(&mut sums[4], c, like.splat(-z));
    }

    #[inline(always)]
    fn to_nodes<R: Real>(f: &mut [Vec3<R>], _: &[Vec3]) {
        let quarter = f[0].x.splat(0.25);
        let apex = f[3];
        let ((far, near), (far_xi, near_xi)) = (back(-apex, f[2]), back(f[1], f[4]));
        (f[1], f[0]) = back(near, near_xi);
        (f[2], f[3]) = back(far, far_xi);
        for node in 0..4 {
            f[node] = f[node] * quarter;
        }
        f[4] = apex;
    }
}

#[cfg(test)]
mod tests {
    use super::super::geometry::assert_parts_are_nodes;
    use super::*;

    #[test]
    fn fields_by_parts_are_fields_by_nodes() {
        for (kind, check) in [
            (ElementKind::Hex8, assert_parts_are_nodes::<Hexahedron> as fn(ElementKind, &[Vec3])),
            (ElementKind::Prism6, assert_parts_are_nodes::<Prism>),
            (ElementKind::Pyramid5, assert_parts_are_nodes::<Pyramid>),
        ] {
            for rule in kind.rules() {
                check(kind, &rule.points.iter().map(|point| point.position).collect::<Vec<_>>());
            }
        }
    }
}
