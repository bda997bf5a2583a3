//! Polar, singular-value and eigen-decompositions of 3×3 matrices.
//!
//! [`polar`] and [`svd`] run in SIMD lanes; what comes out of a lane does not depend on its neighbours. For finite input they never give NaN and always give proper rotations, for singular and inverted
//! matrices too.

// F, S, R as in the equations
#![allow(non_snake_case)]

use crate::{Mat3, Real, Vec3};

/// Sweeps of one-sided Jacobi, which converges at least quadratically: orthogonal to rounding for every input.
const SWEEPS: usize = 5;

/// Sweeps for [`iterated`]: one step of Newton's method takes what they leave below rounding. With three, one random
/// matrix in a million keeps a skew part of 5e-15.
const SWEEPS_BEFORE_NEWTON: usize = 4;

/// Columns shorter than this beside a largest entry of one have no direction of their own (squared).
const VANISHING_SQ: f64 = 1e-60;

/// The least `(s₁ + s₂)(s₂ + s₃)(s₃ + s₁)` over `(s₁ + s₂ + s₃)³` of the signed singular values for which the closed form
/// of [`polar`] is trusted; it is 0.3 at rest. Rounding grows with the inverse.
const LEAST_TURNING_SHARE: f64 = 0.1;

/// Steps of Halley's method for the trace of the stretch, and the last one's largest share of it: the error goes with
/// its third power, and that of the rotation with the sixth.
const TRACE_STEPS: usize = 3;
const LARGEST_LAST_STEP: f64 = 1e-4;

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
    let (mut rotation, trust) = closed_form(&scaled);
    if !trust.all_positive() {
        rotation = iterated_unless_trusted(&scaled, &trust, &rotation);
    }
    Polar { rotation, stretch: rotation.transpose_mul(F).symmetric_part() }
}

/// The polar rotation of a matrix with entries of size one, and a number that is above zero where it is exact to rounding:
/// not of matrices near a jump of the rotation.
///
/// `R = ((κ + |F|²) F + λ cof F - F FᵀF)/ζ` with `λ = tr S`, `κ = (λ² - |F|²)/2`, `ζ = κ λ - det F` (Markley 1993, Attitude
/// Determination Using Vector Observations: A Fast Optimal Matrix Algorithm). `λ` is the largest root of
/// `(λ² - |F|²)² - 8 λ det F - 4 |cof F|²`. An error of `λ` changes `R` by a factor that commutes with `S`, which making `R`
/// orthonormal takes away to first order.
#[inline(always)]
fn closed_form<R: Real>(F: &Mat3<R>) -> (Mat3<R>, R) {
    let (C, cofactor) = (F.gram(), F.cofactor());
    let (size, area) = (C.trace(), cofactor.dot(&cofactor));
    let determinant = F.columns[0].dot(cofactor.columns[0]);
    // from above: s₁s₂ + s₂s₃ + s₃s₁ ≤ √3 |cof F|, equal at rest
    let mut trace = ((area * 3.0).sqrt() * 2.0 + size).sqrt();
    let mut step = trace;
    for _ in 0..TRACE_STEPS {
        let square = trace * trace;
        let g = square - size;
        let value = g.mul_add(g, (trace * determinant).mul_add(trace.splat(-8.0), area * -4.0));
        let slope = (trace * g - determinant * 2.0) * 4.0;
        let half_curvature = square * 6.0 - size * 2.0;
        step = value * slope / (slope * slope - value * half_curvature);
        trace -= step;
    }
    let kappa = (trace * trace - size) * 0.5;
    let zeta = kappa * trace - determinant;
    let inverse = zeta.one() / zeta;
    let turned =
        F.scaled((kappa + size) * inverse) + cofactor.scaled(trace * inverse) - (*F * C).scaled(inverse);
    let trust =
        (zeta - trace * trace * trace * LEAST_TURNING_SHARE).min(trace * LARGEST_LAST_STEP - step.abs());
    (orthonormal(&turned), trust)
}

/// `rotation`, in lanes without trust that of the iteration. Number by number: what is rare should not grow every kernel.
#[cold]
#[inline(never)]
fn iterated_unless_trusted<R: Real>(F: &Mat3<R>, trust: &R, rotation: &Mat3<R>) -> Mat3<R> {
    let mut rotation = *rotation;
    for (lane, trust) in trust.numbers().iter().enumerate() {
        if trust.all_positive() {
            continue;
        }
        let number = |x: R| x.numbers()[lane];
        let alone = Mat3 { columns: F.columns.map(|u| Vec3::new(number(u.x), number(u.y), number(u.z))) };
        for (column, iterated) in rotation.columns.iter_mut().zip(iterated(&alone).columns) {
            column.x.numbers_mut()[lane] = iterated.x;
            column.y.numbers_mut()[lane] = iterated.y;
            column.z.numbers_mut()[lane] = iterated.z;
        }
    }
    rotation
}

/// The polar rotation of a matrix with entries of size one, whatever they are.
fn iterated<R: Real>(F: &Mat3<R>) -> Mat3<R> {
    let (left, right) = singular_frames(F, SWEEPS_BEFORE_NEWTON);
    polished(&left.mul_transpose(&right), F)
}

/// `R (3 I - RᵀR)/2`: squares the distance of `R` from the rotations.
#[inline(always)]
fn orthonormal<R: Real>(rotation: &Mat3<R>) -> Mat3<R> {
    *rotation * (rotation.gram() * -0.5).plus_diagonal(rotation.columns[0].x.splat(1.5))
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
    // again to rounding, the derivative too
    orthonormal(&turned)
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
mod tests;
