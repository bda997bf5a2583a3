//! Hooke's law of small strain, on `tri3`; derived from its text by `souple derive --emit kernel`, and not changed by hand.
//!
//! ```text
//! Ψ = lambda/2*tr(eps)^2 + mu*dot(eps, eps)
//! ```
//!
//! Grouped constants: `X = X_ξ⁻¹`, 4, and moduli times the volume, 2: 6.

use souple_math::{Mat3, Real, Vec3};

use crate::materials::Parameters;
use crate::solids::derived::{DerivedElement, RestSamples};

/// See the module.
#[derive(Clone, Copy, Debug)]
pub struct LinearTri3;

/// The law's numbers.
#[derive(Clone, Copy, Debug)]
pub struct Numbers<R> {
    pub lambda: R,
    pub mu: R,
}

impl<R: Copy> Parameters<R> for Numbers<R> {
    const NAMES: &'static [&'static str] = &["lambda", "mu"];

    #[inline(always)]
    fn unpack(mut number: impl FnMut(usize) -> R) -> Self {
        Self { lambda: number(0), mu: number(1) }
    }

    #[inline(always)]
    fn pack(self, mut put: impl FnMut(usize, R)) {
        put(0, self.lambda);
        put(1, self.mu);
    }
}

/// Moduli times the volume of a sample.
#[derive(Clone, Copy, Debug)]
struct Constants<R> {
    /// `lambda*volume`
    d0: R,
    /// `mu*volume`
    d1: R,
}

impl<R: Real> Constants<R> {
    #[inline(always)]
    fn of(p: &Numbers<R>, volume: R) -> Self {
        let s1 = p.lambda * volume; // lambda*volume
        let s2 = p.mu * volume; // mu*volume
        Self { d0: s1, d1: s2 }
    }
}

/// `ω Ψ`.
#[inline(always)]
fn energy_of<R: Real>(D: &Constants<R>, F: &Mat3<R>) -> R {
    let F = *F;
    let one = F.columns[0].x.one();
    let s1 = F.trace(); // tr(F)
    let s2 = s1 - 3.0; // tr(F) - 3
    let s3 = s2 * s2; // (tr(F) - 3)^2
    let s4 = s3 * 0.5;
    let M1 = F.transpose(); // transpose(F)
    let M2 = F + M1; // F + transpose(F)
    let M3 = M2 * 0.5;
    let M4 = M3.plus_diagonal(one.splat(-1.0)); // 0.5*(F + transpose(F)) - I
    let s5 = M4.dot(&M4);
    let s6 = s4 * D.d0;
    s5.mul_add(D.d1, s6)
}

/// `ω P`.
#[inline(always)]
fn stress_of<R: Real>(D: &Constants<R>, F: &Mat3<R>) -> Mat3<R> {
    let F = *F;
    let one = F.columns[0].x.one();
    let M1 = F.transpose(); // transpose(F)
    let M2 = (F + M1).scaled(D.d1);
    let s1 = F.trace(); // tr(F)
    let s2 = s1 - 3.0; // tr(F) - 3
    let s3 = s2 * D.d0;
    let s4 = D.d1.mul_add(one.splat(-2.0), s3); // (tr(F) - 3)*D_0 - 2*D_1
    M2.plus_diagonal(s4)
}

/// `ω δP`.
#[inline(always)]
fn differential_of<R: Real>(D: &Constants<R>, dF: &Mat3<R>) -> Mat3<R> {
    let dF = *dF;
    let M1 = dF.transpose(); // transpose(dF)
    let M2 = dF + M1; // dF + transpose(dF)
    let M3 = M2.scaled(D.d1);
    let s1 = dF.trace(); // tr(dF)
    let s2 = D.d0 * s1; // tr(dF)*D_0
    M3.plus_diagonal(s2)
}

/// `∂x/∂ξ` at the samples, by axes: columns that several of them share.
#[inline(always)]
fn columns<R: Real>(x: &[Vec3<R>; 3]) -> [Vec3<R>; 2] {
    let e1m0 = x[1] - x[0];
    let e2m0 = x[2] - x[0];
    [e1m0, e2m0]
}

/// Forces on nodes from `ω P X_ξ⁻ᵀ` by columns: minus the transpose of [`columns`].
#[inline(always)]
fn to_nodes<R: Real>(s: &[Vec3<R>; 2]) -> [Vec3<R>; 3] {
    [s[0] + s[1], -s[0], -s[1]]
}

/// `x_ξ X_ξ⁻¹` in the plane, with a third column.
#[inline(always)]
fn in_plane<R: Real>([a, b]: [Vec3<R>; 2], X: &Mat3<R>, across: Vec3<R>) -> Mat3<R> {
    let [u, v, _] = X.columns;
    Mat3::from_columns(a * u.x + b * u.y, a * v.x + b * v.y, across)
}

/// The columns of `P X_ξ⁻ᵀ` in the plane.
#[inline(always)]
fn back<R: Real>(P: &Mat3<R>, X: &Mat3<R>) -> [Vec3<R>; 2] {
    let ([a, b, _], [u, v, _]) = (P.columns, X.columns);
    [a * u.x + b * v.x, a * u.y + b * v.y]
}

impl DerivedElement<3> for LinearTri3 {
    const SAMPLES: usize = 1;
    type Numbers<R: Real> = Numbers<R>;

    #[inline(always)]
    fn energy<R: Real>(p: &Numbers<R>, x: &[Vec3<R>; 3], at: &impl RestSamples<R>) -> R {
        let (zero, one) = (x[0].x.zero(), x[0].x.one());
        let c = columns(x);
        let (X, volume) = at.sample(0);
        let D = Constants::of(p, volume);
        let F = in_plane([c[0], c[1]], &X, Vec3::new(zero, zero, one));
        energy_of(&D, &F)
    }

    #[inline(always)]
    fn forces<R: Real>(p: &Numbers<R>, x: &[Vec3<R>; 3], at: &impl RestSamples<R>) -> [Vec3<R>; 3] {
        let (zero, one) = (x[0].x.zero(), x[0].x.one());
        let c = columns(x);
        let (X, volume) = at.sample(0);
        let D = Constants::of(p, volume);
        let F = in_plane([c[0], c[1]], &X, Vec3::new(zero, zero, one));
        let [h0_0, h0_1] = back(&stress_of(&D, &F), &X);
        to_nodes(&[h0_0, h0_1])
    }

    #[inline(always)]
    fn differential<R: Real>(
        p: &Numbers<R>,
        _: &[Vec3<R>; 3],
        dx: &[Vec3<R>; 3],
        at: &impl RestSamples<R>,
    ) -> [Vec3<R>; 3] {
        let zero = dx[0].x.zero();
        let dc = columns(dx);
        let (X, volume) = at.sample(0);
        let D = Constants::of(p, volume);
        let dF = in_plane([dc[0], dc[1]], &X, Vec3::new(zero, zero, zero));
        let [h0_0, h0_1] = back(&differential_of(&D, &dF), &X);
        to_nodes(&[h0_0, h0_1])
    }
}
