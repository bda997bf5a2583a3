//! smooth for every deformation, inverted ones too, on `tri3`; derived from its text by `souple derive --emit kernel`, and not changed by hand.
//!
//! ```text
//! Ψ = m/2*(I1 - 3 - log((I1 + 1)/4)) + l/2*(J - 1)^2 - 3/4*m*(J - 1)
//! m = 4/3*mu
//! l = lambda + 5/6*mu
//! ```
//!
//! Grouped constants: `X = X_ξ⁻¹`, 4, and moduli times the volume, 2: 6.

use souple_math::{Mat3, Real, Vec3};

use crate::materials::Parameters;
use crate::materials::invariants::cofactor_differential;
use crate::solids::derived::{DerivedElement, RestSamples};

/// See the module.
#[derive(Clone, Copy, Debug)]
pub struct StableNeoHookeanTri3;

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
    /// `mu*volume`
    d0: R,
    /// `(lambda + 0.8333333333333333*mu)*volume`
    d1: R,
}

impl<R: Real> Constants<R> {
    #[inline(always)]
    fn of(p: &Numbers<R>, volume: R) -> Self {
        let one = volume.one();
        let s1 = p.mu * volume; // mu*volume
        let s2 = p.mu.mul_add(one.splat(0.8333333333333333), p.lambda); // lambda + 0.8333333333333333*mu
        let s3 = s2 * volume; // (lambda + 0.8333333333333333*mu)*volume
        Self { d0: s1, d1: s3 }
    }
}

/// `ω Ψ`.
#[inline(always)]
fn energy_of<R: Real>(D: &Constants<R>, F: &Mat3<R>) -> R {
    let F = *F;
    let one = F.columns[0].x.one();
    let s1 = F.dot(&F); // dot(F, F)
    let s2 = s1 + 1.0; // 1 + dot(F, F)
    let s3 = s2 * 0.25; // 0.25*(1 + dot(F, F))
    let s4 = s3.ln(); // ln(0.25*(1 + dot(F, F)))
    let s5 = s1 - 3.0;
    let s6 = s4.mul_add(one.splat(-1.0), s5);
    let s7 = s6 * 0.6666666666666666;
    let s8 = F.determinant(); // det(F)
    let s9 = s8 - 1.0; // det(F) - 1
    let s10 = s9 * s9; // (det(F) - 1)^2
    let s11 = s10 * 0.5;
    let s12 = s9 * -1.0;
    let s13 = s7 * D.d0;
    let s14 = s11.mul_add(D.d1, s13);
    s12.mul_add(D.d0, s14)
}

/// `ω P`.
#[inline(always)]
fn stress_of<R: Real>(D: &Constants<R>, F: &Mat3<R>) -> Mat3<R> {
    let F = *F;
    let one = F.columns[0].x.one();
    let s1 = F.dot(&F); // dot(F, F)
    let s2 = s1 + 1.0; // 1 + dot(F, F)
    let s3 = one.splat(-1.0) / s2;
    let s4 = s3 + 1.0; // 1 - 1/(1 + dot(F, F))
    let s5 = s4 * 1.3333333333333333;
    let s6 = s5 * D.d0; // 4/3*(1 - 1/(1 + dot(F, F)))*D_0
    let M1 = F.cofactor(); // cof(F)
    let s7 = F.columns[0].dot(M1.columns[0]); // det(F)
    let s8 = s7 - 1.0; // det(F) - 1
    let s9 = s8 * D.d1;
    let s10 = D.d0.mul_add(one.splat(-1.0), s9); // (det(F) - 1)*D_1 - D_0
    F.scaled(s6) + M1.scaled(s10)
}

/// `ω δP`.
#[inline(always)]
fn differential_of<R: Real>(D: &Constants<R>, F: &Mat3<R>, dF: &Mat3<R>) -> Mat3<R> {
    let F = *F;
    let dF = *dF;
    let one = F.columns[0].x.one();
    let M1 = F.cofactor(); // cof(F)
    let s1 = F.dot(&F); // dot(F, F)
    let s2 = s1 + 1.0; // 1 + dot(F, F)
    let s3 = s2 * s2;
    let s4 = one / s3; // 1/(1 + dot(F, F))^2
    let s5 = s4 * 2.6666666666666665;
    let s6 = s5 * D.d0;
    let s7 = one.splat(-1.0) / s2;
    let s8 = s7 + 1.0; // 1 - 1/(1 + dot(F, F))
    let s9 = s8 * 1.3333333333333333;
    let s10 = s9 * D.d0; // 4/3*(1 - 1/(1 + dot(F, F)))*D_0
    let s11 = F.columns[0].dot(M1.columns[0]); // det(F)
    let s12 = s11 - 1.0; // det(F) - 1
    let s13 = s12 * D.d1;
    let s14 = D.d0.mul_add(one.splat(-1.0), s13); // (det(F) - 1)*D_1 - D_0
    let s15 = dF.dot(&M1); // dot(dF, cof(F))
    let s16 = D.d1 * s15; // dot(dF, cof(F))*D_1
    let s17 = F.dot(&dF); // dot(F, dF)
    let s18 = s6 * s17; // 8/3*dot(F, dF)*D_0/(1 + dot(F, F))^2
    let M2 = cofactor_differential(&F, &dF); // cross(F, dF)
    let M3 = M1.scaled(s16) + F.scaled(s18);
    let M4 = dF.scaled(s10) + M3;
    M2.scaled(s14) + M4
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

impl DerivedElement<3> for StableNeoHookeanTri3 {
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
        x: &[Vec3<R>; 3],
        dx: &[Vec3<R>; 3],
        at: &impl RestSamples<R>,
    ) -> [Vec3<R>; 3] {
        let (zero, one) = (x[0].x.zero(), x[0].x.one());
        let c = columns(x);
        let dc = columns(dx);
        let (X, volume) = at.sample(0);
        let D = Constants::of(p, volume);
        let F = in_plane([c[0], c[1]], &X, Vec3::new(zero, zero, one));
        let dF = in_plane([dc[0], dc[1]], &X, Vec3::new(zero, zero, zero));
        let [h0_0, h0_1] = back(&differential_of(&D, &F, &dF), &X);
        to_nodes(&[h0_0, h0_1])
    }
}
