//! From node positions to the gradient at a sample, and back.

use souple_math::{Mat3, Real, Vec3};
use souple_mesh::ElementKind;

/// An element as the kernels see it: the parts of a field, those of nodes unless it says otherwise, and its numbers at a
/// sample, `∂N_a/∂ξ`.
pub trait Geometry: Copy + Send + Sync + 'static {
    /// Nodes, where their number is known ahead.
    const NODES: Option<usize>;
    /// Samples, where their number does not depend on the rule: one where the gradient is the same everywhere.
    const SAMPLES: Option<usize>;

    /// Its numbers at `ξ`.
    fn numbers(kind: ElementKind, xi: Vec3) -> Vec<Vec3> {
        kind.shape_gradients(xi).to_vec()
    }

    /// The parts of a field in the place of its values at the nodes.
    #[inline(always)]
    fn to_parts<R: Real>(_field: &mut [Vec3<R>]) {}

    /// `∂x/∂ξ = Σ x_a ⊗ ∂N_a/∂ξ` from the parts of `x`.
    fn gradient<R: Real>(parts: &[Vec3<R>], numbers: &[Vec3]) -> Mat3<R>;

    /// `f_a -= H ∂N_a/∂ξ`, on parts: the transpose of [`Geometry::gradient`].
    fn spread<R: Real>(stress: &Mat3<R>, numbers: &[Vec3], forces: &mut [Vec3<R>]);

    /// Forces on nodes in the place of those on parts: the transpose of [`Geometry::to_parts`].
    #[inline(always)]
    fn to_nodes<R: Real>(_forces: &mut [Vec3<R>]) {}
}

/// The linear tetrahedron: gradients are differences of corners.
#[derive(Clone, Copy, Debug)]
pub struct Tetrahedron;

impl Geometry for Tetrahedron {
    const NODES: Option<usize> = Some(4);
    const SAMPLES: Option<usize> = Some(1);

    #[inline(always)]
    fn gradient<R: Real>(x: &[Vec3<R>], _: &[Vec3]) -> Mat3<R> {
        Mat3::from_columns(x[1] - x[0], x[2] - x[0], x[3] - x[0])
    }

    #[inline(always)]
    fn spread<R: Real>(stress: &Mat3<R>, _: &[Vec3], forces: &mut [Vec3<R>]) {
        let [a, b, c] = stress.columns;
        forces[0] += a + b + c;
        forces[1] -= a;
        forces[2] -= b;
        forces[3] -= c;
    }
}

/// Any element: as many nodes as it has reference gradients at a sample.
#[derive(Clone, Copy, Debug)]
pub struct AnyElement;

impl Geometry for AnyElement {
    const NODES: Option<usize> = None;
    const SAMPLES: Option<usize> = None;

    #[inline(always)]
    fn gradient<R: Real>(x: &[Vec3<R>], reference: &[Vec3]) -> Mat3<R> {
        gradient(x, reference)
    }

    #[inline(always)]
    fn spread<R: Real>(stress: &Mat3<R>, reference: &[Vec3], forces: &mut [Vec3<R>]) {
        spread(stress, reference, forces);
    }
}

#[inline(always)]
fn gradient<R: Real>(x: &[Vec3<R>], reference: &[Vec3]) -> Mat3<R> {
    let like = x[0].x;
    let mut sum = Mat3::zero(like);
    for a in 0..reference.len() {
        let g = reference[a];
        accumulate(&mut sum.columns[0], x[a], like.splat(g.x));
        accumulate(&mut sum.columns[1], x[a], like.splat(g.y));
        accumulate(&mut sum.columns[2], x[a], like.splat(g.z));
    }
    sum
}

#[inline(always)]
fn spread<R: Real>(stress: &Mat3<R>, reference: &[Vec3], forces: &mut [Vec3<R>]) {
    let like = stress.columns[0].x;
    for a in 0..reference.len() {
        let g = reference[a];
        accumulate(&mut forces[a], stress.columns[0], like.splat(-g.x));
        accumulate(&mut forces[a], stress.columns[1], like.splat(-g.y));
        accumulate(&mut forces[a], stress.columns[2], like.splat(-g.z));
    }
}

/// `sum += factor x`.
#[inline(always)]
pub fn accumulate<R: Real>(sum: &mut Vec3<R>, x: Vec3<R>, factor: R) {
    *sum = Vec3::new(x.x.mul_add(factor, sum.x), x.y.mul_add(factor, sum.y), x.z.mul_add(factor, sum.z));
}
