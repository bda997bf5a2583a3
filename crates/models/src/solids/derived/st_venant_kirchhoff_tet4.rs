//! quadratic in Green strain, on `tet4`; derived from its text by `souple derive --emit kernel`, and not changed by hand.
//!
//! ```text
//! Ψ = lambda/2*tr(E)^2 + mu*dot(E, E)
//! ```
//!
//! Grouped constants: `X = X_ξ⁻¹`, 9, and moduli times the volume, 2: 11.

use souple_math::{Mat3, Real, Vec3};

use crate::materials::Parameters;
use crate::solids::derived::{DerivedElement, RestSamples};

/// See the module.
#[derive(Clone, Copy, Debug)]
pub struct StVenantKirchhoffTet4;

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
    let M1 = F.gram(); // transpose(F)*F
    let s1 = M1.trace(); // dot(F, F)
    let s2 = s1.mul_add(one.splat(0.5), one.splat(-1.5)); // 0.5*dot(F, F) - 1.5
    let s3 = s2 * s2; // (0.5*dot(F, F) - 1.5)^2
    let s4 = s3 * 0.5;
    let M2 = M1 * 0.5;
    let M3 = M2.plus_diagonal(one.splat(-0.5)); // 0.5*transpose(F)*F - 0.5*I
    let s5 = M3.dot(&M3);
    let s6 = s4 * D.d0;
    s5.mul_add(D.d1, s6)
}

/// `ω P`.
#[inline(always)]
fn stress_of<R: Real>(D: &Constants<R>, F: &Mat3<R>) -> Mat3<R> {
    let F = *F;
    let one = F.columns[0].x.one();
    let M1 = F.gram(); // transpose(F)*F
    let M2 = M1.scaled(D.d1);
    let s1 = M1.trace(); // dot(F, F)
    let s2 = s1.mul_add(one.splat(0.5), one.splat(-1.5)); // 0.5*dot(F, F) - 1.5
    let s3 = s2 * D.d0;
    let s4 = D.d1.mul_add(one.splat(-1.0), s3); // (0.5*dot(F, F) - 1.5)*D_0 - D_1
    let M3 = M2.plus_diagonal(s4);
    F * M3
}

/// `ω δP`.
#[inline(always)]
fn differential_of<R: Real>(D: &Constants<R>, F: &Mat3<R>, dF: &Mat3<R>) -> Mat3<R> {
    let F = *F;
    let dF = *dF;
    let one = F.columns[0].x.one();
    let M1 = F.gram(); // transpose(F)*F
    let M2 = M1.scaled(D.d1);
    let s1 = M1.trace(); // dot(F, F)
    let s2 = s1.mul_add(one.splat(0.5), one.splat(-1.5)); // 0.5*dot(F, F) - 1.5
    let s3 = s2 * D.d0;
    let s4 = D.d1.mul_add(one.splat(-1.0), s3); // (0.5*dot(F, F) - 1.5)*D_0 - D_1
    let M3 = M2.plus_diagonal(s4);
    let M4 = dF.transpose_mul(&F); // transpose(dF)*F
    let M5 = M4.transpose(); // transpose(F)*dF
    let M6 = (M4 + M5).scaled(D.d1);
    let s5 = M4.trace(); // dot(F, dF)
    let s6 = D.d0 * s5; // dot(F, dF)*D_0
    let M7 = M6.plus_diagonal(s6);
    let M8 = F * M7;
    let M9 = dF * M3;
    M8 + M9
}

/// `∂x/∂ξ` at the samples, by axes: columns that several of them share.
#[inline(always)]
fn columns<R: Real>(x: &[Vec3<R>; 4]) -> [Vec3<R>; 3] {
    let e1m0 = x[1] - x[0];
    let e2m0 = x[2] - x[0];
    let e3m0 = x[3] - x[0];
    [e1m0, e2m0, e3m0]
}

/// Forces on nodes from `ω P X_ξ⁻ᵀ` by columns: minus the transpose of [`columns`].
#[inline(always)]
fn to_nodes<R: Real>(s: &[Vec3<R>; 3]) -> [Vec3<R>; 4] {
    [s[0] + s[1] + s[2], -s[0], -s[1], -s[2]]
}

impl DerivedElement<4> for StVenantKirchhoffTet4 {
    const SAMPLES: usize = 1;
    type Numbers<R: Real> = Numbers<R>;

    #[inline(always)]
    fn energy<R: Real>(p: &Numbers<R>, x: &[Vec3<R>; 4], at: &impl RestSamples<R>) -> R {
        let c = columns(x);
        let (X, volume) = at.sample(0);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[0], c[1], c[2]) * X;
        energy_of(&D, &F)
    }

    #[inline(always)]
    fn forces<R: Real>(p: &Numbers<R>, x: &[Vec3<R>; 4], at: &impl RestSamples<R>) -> [Vec3<R>; 4] {
        let c = columns(x);
        let (X, volume) = at.sample(0);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[0], c[1], c[2]) * X;
        let [h0_0, h0_1, h0_2] = stress_of(&D, &F).mul_transpose(&X).columns;
        to_nodes(&[h0_0, h0_1, h0_2])
    }

    #[inline(always)]
    fn differential<R: Real>(
        p: &Numbers<R>,
        x: &[Vec3<R>; 4],
        dx: &[Vec3<R>; 4],
        at: &impl RestSamples<R>,
    ) -> [Vec3<R>; 4] {
        let c = columns(x);
        let dc = columns(dx);
        let (X, volume) = at.sample(0);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[0], c[1], c[2]) * X;
        let dF = Mat3::from_columns(dc[0], dc[1], dc[2]) * X;
        let [h0_0, h0_1, h0_2] = differential_of(&D, &F, &dF).mul_transpose(&X).columns;
        to_nodes(&[h0_0, h0_1, h0_2])
    }
}
