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
    /// Parts of a field, where they are not as many as nodes.
    const PARTS: Option<usize> = Self::NODES;

    /// Its numbers at `ξ`.
    fn numbers(kind: ElementKind, xi: Vec3) -> Vec<Vec3> {
        kind.shape_gradients(xi).to_vec()
    }

    /// The parts of a field in the place of its values at the nodes; `_numbers` are those of all samples.
    #[inline(always)]
    fn to_parts<R: Real>(_field: &mut [Vec3<R>], _numbers: &[Vec3]) {}

    /// `∂x/∂ξ = Σ x_a ⊗ ∂N_a/∂ξ` from the parts of `x`.
    fn gradient<R: Real>(parts: &[Vec3<R>], numbers: &[Vec3]) -> Mat3<R>;

    /// `f_a -= H ∂N_a/∂ξ`, on parts: the transpose of [`Geometry::gradient`].
    fn spread<R: Real>(stress: &Mat3<R>, numbers: &[Vec3], forces: &mut [Vec3<R>]);

    /// Forces on nodes in the place of those on parts: the transpose of [`Geometry::to_parts`].
    #[inline(always)]
    fn to_nodes<R: Real>(_forces: &mut [Vec3<R>], _numbers: &[Vec3]) {}
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

/// Gradients and forces by the parts of a geometry are those by nodes, at samples.
#[cfg(test)]
pub fn assert_parts_are_nodes<G: Geometry>(kind: ElementKind, samples: &[Vec3]) {
    let wave = |i: usize| {
        let i = i as f64;
        Vec3::new((1.3 * i + 0.2).sin(), (2.1 * i - 0.4).cos(), (0.7 * i + 1.1).sin())
    };
    let count = kind.node_count();
    let places = G::PARTS.unwrap_or(count);
    let stress = Mat3::from_columns(wave(20), wave(21), wave(22));
    let numbers: Vec<Vec3> = samples.iter().flat_map(|xi| G::numbers(kind, *xi)).collect();
    let nodes: Vec<Vec3> = (0..count).map(wave).collect();
    let mut parts = nodes.clone();
    parts.resize(places, Vec3::ZERO);
    G::to_parts(&mut parts, &numbers);
    for (xi, own) in samples.iter().zip(numbers.chunks_exact(numbers.len() / samples.len())) {
        let shape = kind.shape_gradients(*xi);
        let off = G::gradient(&parts, own) - AnyElement::gradient(&nodes, &shape);
        // a dozen roundings of numbers of some units
        assert!(off.largest_entry() < 1e-13, "{kind} {xi:?}");
        let (mut forces, mut expected) = (vec![Vec3::ZERO; places], vec![Vec3::ZERO; count]);
        G::spread(&stress, own, &mut forces);
        G::to_nodes(&mut forces, &numbers);
        AnyElement::spread(&stress, &shape, &mut expected);
        for (force, expected) in forces.iter().zip(&expected) {
            assert!((*force - *expected).length() < 1e-13, "{kind} {xi:?}");
        }
    }
}
