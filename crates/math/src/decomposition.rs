//! Polar, singular-value and eigen-decompositions of 3×3 matrices.
//!
//! [`polar`] and [`svd`] run in SIMD lanes: a fixed number of operations, choices by selection. For
//! finite input they never give NaN and always give proper rotations, for singular and inverted matrices too.

// F, S, R as in the equations
#![allow(non_snake_case)]

use crate::{Mat3, Real, Vec3};

/// Sweeps of one-sided Jacobi, which converges at least quadratically: orthogonal to rounding for every input.
const SWEEPS: usize = 5;

/// Sweeps for [`polar`]: one step of Newton's method takes what they leave below rounding. With three, one random
/// matrix in a million keeps a skew part of 5e-15.
const SWEEPS_BEFORE_NEWTON: usize = 4;

/// Columns shorter than this beside a largest entry of one have no direction of their own (squared).
const VANISHING_SQ: f64 = 1e-60;

/// `F = R S` with a proper rotation `R` and a symmetric `S`.
#[derive(Clone, Copy, Debug)]
pub struct Polar<R = f64> {
    pub rotation: Mat3<R>,
    pub stretch: Mat3<R>,
}

/// `F = U diag(s) Vᵀ` with proper rotations `U`, `V`: the values fall in size, and the last one carries the
/// sign of `det F`.
#[derive(Clone, Copy, Debug)]
pub struct Svd<R = f64> {
    pub left: Mat3<R>,
    pub values: Vec3<R>,
    pub right: Mat3<R>,
}

/// `A = V diag(values) Vᵀ` with a proper rotation `V`; the values fall.
#[derive(Clone, Copy, Debug)]
pub struct Eigen {
    pub values: Vec3,
    pub vectors: Mat3,
}

/// The polar decomposition by the proper rotation that comes closest to `F`.
///
/// Of all proper rotations, `R` has the largest `tr(RᵀF)`. For an inverted `F` the stretch `S = RᵀF` therefore
/// has one negative eigenvalue, the smallest in size: the element counts as inverted along the axis where that
/// is the shortest way back. Where the maximum is not unique (a line, a point, a mirror image) `R` is one of the
/// maxima; for `F = 0` it is the identity.
#[inline(always)]
pub fn polar<R: Real>(F: &Mat3<R>) -> Polar<R> {
    let scaled = F.scaled(inverse_of_largest(F));
    let (left, right) = singular_frames(&scaled, SWEEPS_BEFORE_NEWTON);
    let rotation = polished(&left.mul_transpose(&right), &scaled);
    Polar { rotation, stretch: rotation.transpose_mul(F).symmetric_part() }
}

/// The singular-value decomposition with proper rotations.
#[inline(always)]
pub fn svd<R: Real>(F: &Mat3<R>) -> Svd<R> {
    let (left, right) = singular_frames(&F.scaled(inverse_of_largest(F)), SWEEPS);
    let ([u, v, w], [a, b, c]) = (left.columns, (*F * right).columns);
    Svd { left, values: Vec3::new(u.dot(a), v.dot(b), w.dot(c)), right }
}

/// `H = (tr(S) I - S)⁻¹` for the stretch `S = RᵀF`: the rotation turns by `δR = R [ω]×` with
/// `ω = H (twice the axial vector of Rᵀ δF)`.
///
/// `tr(S) I - S` has the eigenvalues `sᵢ + sⱼ`. Near zero, where the polar rotation is about to jump, its
/// determinant is held above `least_determinant`, so that `H` stays finite and is inexact on purpose.
#[inline(always)]
pub fn turn_of_stretch<R: Real>(stretch: &Mat3<R>, least_determinant: R) -> Mat3<R> {
    let G = (-*stretch).plus_diagonal(stretch.trace());
    // symmetric: the cofactor matrix is the adjugate
    let adjugate = G.cofactor();
    let determinant = G.columns[0].dot(adjugate.columns[0]);
    adjugate.scaled(stretch.columns[0].x.one() / determinant.max(least_determinant))
}

/// One over the largest entry, or a large number for the zero matrix.
#[inline(always)]
fn inverse_of_largest<R: Real>(F: &Mat3<R>) -> R {
    let [a, b, c] = F.columns;
    let largest = largest_component(a).max(largest_component(b)).max(largest_component(c));
    largest.one() / largest.max(largest.splat(1e-300))
}

#[inline(always)]
fn largest_component<R: Real>(u: Vec3<R>) -> R {
    u.x.abs().max(u.y.abs()).max(u.z.abs())
}

/// One step of Newton's method for `R` in `RᵀF = FᵀR`: squares the error of `R`. Needs entries of size one.
///
/// In dual numbers it also removes what the derivative of `R` has from the frames.
#[inline(always)]
fn polished<R: Real>(rotation: &Mat3<R>, F: &Mat3<R>) -> Mat3<R> {
    let stretch = rotation.transpose_mul(F);
    let turn = turn_of_stretch(&stretch.symmetric_part(), F.columns[0].x.splat(1e-10));
    // half the turn: the factor of two of the axial vector is taken off again
    let w = turn * stretch.axial_vector();
    // Cayley: exp([2w]×) ≈ I + 2 ([w]× + [w]×²) / (1 + |w|²), a rotation whatever w
    let scale = w.x.splat(2.0) / (w.length_sq() + 1.0);
    let skew = w.cross_matrix();
    let turned = *rotation + (*rotation * (skew + skew * skew)).scaled(scale);
    // R (3 I - RᵀR) / 2: orthonormal again to rounding, the derivative too
    turned * (turned.transpose_mul(&turned) * -0.5).plus_diagonal(w.x.splat(1.5))
}

/// `(U, V)` of the singular-value decomposition of `F`, whose largest entry is one (or which is zero).
///
/// One-sided Jacobi: `V` turns pairs of columns of `B = F V` until all are orthogonal; they are then `sᵢ uᵢ`, small
/// ones accurate relative to their own size.
#[inline(always)]
fn singular_frames<R: Real>(F: &Mat3<R>, sweeps: usize) -> (Mat3<R>, Mat3<R>) {
    let mut b = F.columns;
    let mut v = Mat3::identity(b[0].x).columns;
    for _ in 0..sweeps {
        orthogonalise::<R, 0, 1>(&mut b, &mut v);
        orthogonalise::<R, 0, 2>(&mut b, &mut v);
        orthogonalise::<R, 1, 2>(&mut b, &mut v);
    }
    put_longer_first::<R, 0, 1>(&mut b, &mut v);
    put_longer_first::<R, 1, 2>(&mut b, &mut v);
    put_longer_first::<R, 0, 1>(&mut b, &mut v);
    (frame_along(&b, &v), Mat3 { columns: v })
}

/// Turns columns `I` and `J` of `b` and `v` in their plane until they are orthogonal in `b`, by at most 45°.
#[inline(always)]
fn orthogonalise<R: Real, const I: usize, const J: usize>(b: &mut [Vec3<R>; 3], v: &mut [Vec3<R>; 3]) {
    let (length_i, length_j, overlap) = (b[I].length_sq(), b[J].length_sq(), b[I].dot(b[J]));
    let zero = overlap.zero();
    // t = tan of the angle: the smaller root of t² + 2ζt - 1, ζ = (|bⱼ|² - |bᵢ|²) / 2 bᵢ·bⱼ
    let difference = length_j - length_i;
    let doubled = overlap * 2.0;
    let hypotenuse = (difference * difference + doubled * doubled).sqrt();
    let signed = difference.select_less(zero, -doubled, doubled);
    let root = signed / (difference.abs() + hypotenuse);
    // within rounding (a cosine of 1e-15) there is nothing to turn; this also keeps 0/0 out
    let tangent = (length_i * length_j * 1e-30).select_less(overlap * overlap, root, zero);
    let cosine = zero.one() / (tangent * tangent + 1.0).sqrt();
    let sine = cosine * tangent;
    (b[I], b[J]) = turned(b[I], b[J], cosine, sine);
    (v[I], v[J]) = turned(v[I], v[J], cosine, sine);
}

#[inline(always)]
fn turned<R: Real>(a: Vec3<R>, b: Vec3<R>, cosine: R, sine: R) -> (Vec3<R>, Vec3<R>) {
    (a * cosine - b * sine, a * sine + b * cosine)
}

/// Exchanges columns `I` and `J` where the second is longer, one with its sign changed: `v` stays proper.
#[inline(always)]
fn put_longer_first<R: Real, const I: usize, const J: usize>(b: &mut [Vec3<R>; 3], v: &mut [Vec3<R>; 3]) {
    let (length_i, length_j) = (b[I].length_sq(), b[J].length_sq());
    let [b_i, b_j, v_i, v_j] = [b[I], b[J], v[I], v[J]];
    b[I] = select_less(length_i, length_j, b_j, b_i);
    b[J] = select_less(length_i, length_j, -b_i, b_j);
    v[I] = select_less(length_i, length_j, v_j, v_i);
    v[J] = select_less(length_i, length_j, -v_i, v_j);
}

/// The proper rotation whose first two columns point along the orthogonal columns `b`, the first the longest.
/// Directions that vanish are taken from `v`.
#[inline(always)]
fn frame_along<R: Real>(b: &[Vec3<R>; 3], v: &[Vec3<R>; 3]) -> Mat3<R> {
    let vanishing = b[0].x.splat(VANISHING_SQ);
    let first = select_less(b[0].length_sq(), vanishing, v[0], b[0]);
    let first = first / first.length();

    let second = across(first, b[1]);
    // v₂ and v₃ cannot both lie along the first direction
    let (p, q) = (across(first, v[1]), across(first, v[2]));
    let spare = select_less(p.length_sq(), q.length_sq(), q, p);
    let second = select_less(second.length_sq(), vanishing, spare, second);
    // across once more: the rounding of a short column is not short beside its length
    let second = across(first, second / second.length());
    let second = second / second.length();
    Mat3::from_columns(first, second, first.cross(second))
}

/// `u` without its part along the unit vector `direction`.
#[inline(always)]
fn across<R: Real>(direction: Vec3<R>, u: Vec3<R>) -> Vec3<R> {
    u - direction * direction.dot(u)
}

#[inline(always)]
fn select_less<R: Real>(a: R, b: R, if_less: Vec3<R>, otherwise: Vec3<R>) -> Vec3<R> {
    Vec3::new(
        a.select_less(b, if_less.x, otherwise.x),
        a.select_less(b, if_less.y, otherwise.y),
        a.select_less(b, if_less.z, otherwise.z),
    )
}

/// Eigenvalues and eigenvectors of a symmetric matrix (of its lower triangle), by cyclic Jacobi.
pub fn eigen_symmetric(matrix: &Mat3) -> Eigen {
    let mut A = *matrix;
    for (i, j) in [(0, 1), (0, 2), (1, 2)] {
        A.columns[j][i] = A.columns[i][j];
    }
    let mut vectors = Mat3::IDENTITY;
    // quadratic convergence: five sweeps do, the rest is a bound for input that is not finite
    for _ in 0..20 {
        let mut turned = false;
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            turned |= annihilate(&mut A, &mut vectors, i, j);
        }
        if !turned {
            break;
        }
    }
    let mut values = A.diagonal();
    for (i, j) in [(0, 1), (1, 2), (0, 1)] {
        if values[i] < values[j] {
            (values[i], values[j]) = (values[j], values[i]);
            vectors.columns.swap(i, j);
            // an exchange is a reflection: the sign makes it a rotation again
            vectors.columns[j] = -vectors.columns[j];
        }
    }
    Eigen { values, vectors }
}

/// One rotation of Jacobi's method, `A ← GᵀAG`, `V ← VG`, that makes `Aᵢⱼ` vanish; whether there was anything to do.
fn annihilate(A: &mut Mat3, vectors: &mut Mat3, i: usize, j: usize) -> bool {
    let (a_i, a_j, a_ij) = (A.entry(i, i), A.entry(j, j), A.entry(i, j));
    // relative to the diagonal: adding it there would change nothing
    if !a_ij.is_finite() || a_ij == 0.0 || a_ij.abs() < 1e-17 * a_i.abs().min(a_j.abs()) {
        return false;
    }
    let zeta = 0.5 * (a_j - a_i) / a_ij;
    let tangent = if zeta.abs() > 1e150 {
        0.5 / zeta // ζ² would overflow
    } else {
        f64::copysign(1.0, zeta) / (zeta.abs() + (1.0 + zeta * zeta).sqrt())
    };
    let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
    let sine = cosine * tangent;

    let turn = |columns: &mut [Vec3; 3]| {
        let (a, b) = (columns[i], columns[j]);
        columns[i] = a * cosine - b * sine;
        columns[j] = a * sine + b * cosine;
    };
    turn(&mut A.columns);
    *A = A.transpose();
    turn(&mut A.columns);
    A.columns[i][j] = 0.0;
    A.columns[j][i] = 0.0;
    A.columns[i][i] = a_i - tangent * a_ij;
    A.columns[j][j] = a_j + tangent * a_ij;
    turn(&mut vectors.columns);
    true
}

/// The nearest symmetric matrix without negative eigenvalues, in the Frobenius norm.
pub fn project_psd(matrix: &Mat3) -> Mat3 {
    let symmetric = matrix.symmetric_part();
    let Eigen { values, vectors } = eigen_symmetric(&symmetric);
    if values.z >= 0.0 {
        return symmetric;
    }
    let positive = values.max_components(Vec3::ZERO);
    let scaled = Mat3::from_columns(
        vectors.columns[0] * positive.x,
        vectors.columns[1] * positive.y,
        vectors.columns[2] * positive.z,
    );
    scaled.mul_transpose(&vectors).symmetric_part()
}

#[cfg(test)]
mod tests {
    use pulp::{Arch, Simd, WithSimd};

    use super::*;
    use crate::{Dual, Lanes, exponential};

    const EPSILON: f64 = f64::EPSILON;

    /// Numbers between -1 and 1 from a fixed seed (Knuth's linear congruence).
    struct Numbers(u64);

    impl Numbers {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        }
        fn vector(&mut self) -> Vec3 {
            Vec3::new(self.next(), self.next(), self.next())
        }
        fn matrix(&mut self) -> Mat3 {
            Mat3::from_columns(self.vector(), self.vector(), self.vector())
        }
        fn rotation(&mut self) -> Mat3 {
            exponential(self.vector() * 3.0)
        }
    }

    /// Singular values, signed as ours: regular, close to each other, equal, inverted, nearly and wholly singular.
    const SINGULAR_VALUES: [[f64; 3]; 18] = [
        [1.0, 1.0, 1.0],
        [1.1, 1.0, 0.9],
        [1.0 + 1e-9, 1.0, 1.0 - 1e-9],
        [1.0 + 1e-15, 1.0, 1.0],
        [3.0, 0.5, 0.1],
        [1.0, 1.0, -0.5],
        [1.0, 0.8, -0.6],
        [1.0, 1.0, -1.0],
        [2.0, 1.0, -1.0 + 1e-9],
        [1.0, 1.0, 0.0],
        [1.0, 1.0, 1e-9],
        [1.0, 1.0, -1e-9],
        [1.0, 1e-6, 1e-12],
        [1e6, 1.0, -1e-6],
        [1.0, 1e-16, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1e-9, -1e-9],
        [0.0, 0.0, 0.0],
    ];

    /// Random, aligned with the axes, and turned, at three scales.
    fn examples() -> Vec<Mat3> {
        let mut numbers = Numbers(1);
        let mut examples: Vec<Mat3> = (0..2000).map(|_| numbers.matrix()).collect();
        for [a, b, c] in SINGULAR_VALUES {
            let diagonal = Mat3::from_diagonal(Vec3::new(a, b, c));
            examples.extend([diagonal, Mat3::from_diagonal(Vec3::new(c, b, a))]);
            for _ in 0..50 {
                let turned = numbers.rotation() * diagonal * numbers.rotation().transpose();
                examples.extend([turned, turned * 1e-200, turned * 1e200, diagonal * numbers.rotation()]);
            }
        }
        examples
    }

    fn assert_rotation(R: &Mat3, of: &Mat3) {
        let error = (R.transpose_mul(R) - Mat3::IDENTITY).largest_entry();
        assert!(error <= 16.0 * EPSILON && R.determinant() > 0.0, "error {error:e}, {R:?} of {of:?}");
    }

    /// `R` is proper and `RᵀF` symmetric, to rounding of the largest entry, for every kind of matrix; of all proper
    /// rotations `R` has the largest `tr(RᵀF)`: no sum of two eigenvalues of `S` is negative.
    #[test]
    fn polar_is_proper_and_symmetric() {
        for F in examples() {
            let Polar { rotation, stretch } = polar(&F);
            assert_rotation(&rotation, &F);
            let rounding = 16.0 * EPSILON * F.largest_entry();
            let skew = rotation.transpose_mul(&F).axial_vector().largest_component();
            assert!(skew <= rounding, "skew {skew:e} of {F:?}");
            assert!((rotation * stretch - F).largest_entry() <= 2.0 * rounding, "{F:?}");
            let values = eigen_symmetric(&(stretch * (1.0 / F.largest_entry().max(1e-300)))).values;
            assert!(values.y + values.z >= -32.0 * EPSILON, "{values:?} of {F:?}");
        }
    }

    /// `F = Q₁ D Q₂ᵀ` has the polar rotation `Q₁ Q₂ᵀ`; its condition is `s₁/(s₂ + s₃)`.
    #[test]
    fn polar_of_known_rotation() {
        let mut numbers = Numbers(2);
        for [a, b, c] in SINGULAR_VALUES.into_iter().filter(|[a, b, c]| b + c > 1e-6 * a) {
            for _ in 0..200 {
                let (left, right) = (numbers.rotation(), numbers.rotation());
                let F = left * Mat3::from_diagonal(Vec3::new(a, b, c)).mul_transpose(&right);
                let error = (polar(&F).rotation - left.mul_transpose(&right)).largest_entry();
                assert!(error <= 16.0 * EPSILON * (1.0 + a / (b + c)), "error {error:e} of {a} {b} {c}");
            }
        }
    }

    /// `F = U diag(s) Vᵀ` with rotations, falling sizes and the sign of the determinant on the last.
    #[test]
    fn svd_rebuilds() {
        for F in examples() {
            let Svd { left, values, right } = svd(&F);
            assert_rotation(&left, &F);
            assert_rotation(&right, &F);
            let scale = F.largest_entry();
            let rebuilt = left * Mat3::from_diagonal(values).mul_transpose(&right);
            assert!((rebuilt - F).largest_entry() <= 24.0 * EPSILON * scale, "{F:?}");
            let slack = 8.0 * EPSILON * scale;
            assert!(values.x >= values.y - slack && values.y >= values.z.abs() - slack && values.y >= -slack);
        }
    }

    /// The derivative of the rotation in dual numbers is `R [ω]×`, `ω = H 2 axial(Rᵀ δF)`, at the identity too.
    #[test]
    fn polar_differentiates() {
        let mut numbers = Numbers(3);
        let examples = [[1.0, 1.0, 1.0], [1.2, 1.0, 0.7], [1.0, 0.9, -0.3], [1.0, 1.0, 0.0]];
        for [a, b, c] in examples {
            let diagonal = Mat3::from_diagonal(Vec3::new(a, b, c));
            let turned = numbers.rotation() * diagonal.mul_transpose(&numbers.rotation());
            for F in [diagonal, turned] {
                let dF = numbers.matrix();
                let Polar { rotation, stretch } = polar(&F);
                let omega =
                    turn_of_stretch(&stretch, 1e-12) * (rotation.transpose_mul(&dF).axial_vector() * 2.0);
                let expected = rotation * omega.cross_matrix();

                let dual = |column: usize, row: usize| Dual::new(F.entry(row, column), dF.entry(row, column));
                let columns =
                    [0, 1, 2].map(|column| Vec3::from_array([0, 1, 2].map(|row| dual(column, row))));
                let measured =
                    polar(&Mat3 { columns }).rotation.columns.map(|u| u.to_array().map(|x| x.derivative));
                let measured = Mat3 { columns: measured.map(Vec3::from_array) };
                assert!((measured - expected).largest_entry() < 1e-12, "{measured:?} for {expected:?}");
            }
        }
    }

    /// In lanes of any width: the scalar answer to rounding, which grows with the condition `s₁/(s₂ + s₃)`.
    #[test]
    fn lanes_agree_with_scalar() {
        struct InLanes<'a>(&'a [Mat3]);
        impl WithSimd for InLanes<'_> {
            type Output = ();
            #[inline(always)]
            fn with_simd<S: Simd>(self, simd: S) {
                for group in self.0.chunks_exact(S::F64_LANES) {
                    let entry = |row, column| {
                        let numbers: Vec<f64> = group.iter().map(|F| F.entry(row, column)).collect();
                        Lanes::load(simd, &numbers)
                    };
                    let columns =
                        [0, 1, 2].map(|column| Vec3::from_array([0, 1, 2].map(|row| entry(row, column))));
                    let Polar { rotation, .. } = polar(&Mat3 { columns });
                    let mut stored = vec![Mat3::ZERO; S::F64_LANES];
                    for (column, row) in (0..9).map(|i| (i / 3, i % 3)) {
                        let mut numbers = vec![0.0; S::F64_LANES];
                        rotation.entry(row, column).store(&mut numbers);
                        for (R, number) in stored.iter_mut().zip(&numbers) {
                            R.columns[column][row] = *number;
                        }
                    }
                    for (R, F) in stored.iter().zip(group) {
                        assert_rotation(R, F);
                        let Vec3 { x, y, z } = svd(F).values;
                        if y + z > 1e-6 * x {
                            let error = (*R - polar(F).rotation).largest_entry();
                            assert!(
                                error <= 16.0 * EPSILON * (1.0 + x / (y + z)),
                                "error {error:e} of {F:?}"
                            );
                        }
                    }
                }
            }
        }
        Arch::default().dispatch(InLanes(&examples()));
        InLanes(&examples()).with_simd(pulp::Scalar::new());
    }

    /// `A = V diag Vᵀ`, falling, for random and repeated eigenvalues.
    #[test]
    fn eigen_rebuilds() {
        let mut numbers = Numbers(4);
        for i in 0..2000 {
            let A = if i % 2 == 0 {
                numbers.matrix().symmetric_part()
            } else {
                let ([a, b, c], Q) = (SINGULAR_VALUES[i % SINGULAR_VALUES.len()], numbers.rotation());
                (Q * Mat3::from_diagonal(Vec3::new(a, b, c))).mul_transpose(&Q).symmetric_part()
            };
            let Eigen { values, vectors } = eigen_symmetric(&A);
            assert_rotation(&vectors, &A);
            let rebuilt = vectors * Mat3::from_diagonal(values).mul_transpose(&vectors);
            assert!((rebuilt - A).largest_entry() <= 16.0 * EPSILON * A.largest_entry());
            assert!(values.x >= values.y && values.y >= values.z);
        }
    }

    /// The projection keeps the positive part of the spectrum and nothing else; semidefinite matrices stay as they are.
    #[test]
    fn projection_is_nearest() {
        let mut numbers = Numbers(5);
        for _ in 0..500 {
            let Q = numbers.rotation();
            let (values, with) = (numbers.vector(), |v: Vec3| (Q * Mat3::from_diagonal(v)).mul_transpose(&Q));
            let positive = with(values.max_components(Vec3::ZERO));
            let projected = project_psd(&with(values));
            assert!((projected - positive).largest_entry() <= 16.0 * EPSILON);
            assert!((project_psd(&positive) - positive).largest_entry() <= 16.0 * EPSILON);
        }
    }

    /// Input that is not finite ends, without panic.
    #[test]
    fn not_finite_input_returns() {
        for bad in [f64::NAN, f64::INFINITY] {
            let F = Mat3::from_diagonal(Vec3::new(1.0, bad, 2.0));
            let _ = (polar(&F), svd(&F), eigen_symmetric(&F), project_psd(&F));
        }
    }
}
