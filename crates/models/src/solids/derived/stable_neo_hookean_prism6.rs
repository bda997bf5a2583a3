//! smooth for every deformation, inverted ones too, on `prism6`; derived from its text by `souple derive --emit kernel`, and not changed by hand.
//!
//! ```text
//! Ψ = m/2*(I1 - 3 - log((I1 + 1)/4)) + l/2*(J - 1)^2 - 3/4*m*(J - 1)
//! m = 4/3*mu
//! l = lambda + 5/6*mu
//! ```
//!
//! Grouped constants at each of 6 samples: `X = X_ξ⁻¹`, 9, and moduli times the volume, 2: 11.

use souple_math::{Mat3, Real, Vec3};

use crate::materials::Parameters;
use crate::materials::invariants::cofactor_differential;
use crate::solids::derived::{DerivedElement, RestSamples, weighted};

/// See the module.
#[derive(Clone, Copy, Debug)]
pub struct StableNeoHookeanPrism6;

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

/// Of `∂N/∂ξ` at the samples, without signs.
const C: [f64; 4] = [0.7886751345948129, 0.33333333333333337, 0.21132486540518713, 0.08333333333333333];

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
fn columns<R: Real>(x: &[Vec3<R>; 6]) -> [Vec3<R>; 7] {
    let e1m0 = x[1] - x[0];
    let e4m3 = x[4] - x[3];
    let e2m0 = x[2] - x[0];
    let e5m3 = x[5] - x[3];
    let e3m0 = x[3] - x[0];
    let e4m1 = x[4] - x[1];
    let e5m2 = x[5] - x[2];
    [
        weighted([(e1m0, C[0]), (e4m3, C[2])]),
        weighted([(e2m0, C[0]), (e5m3, C[2])]),
        weighted([(e3m0, C[1]), (e4m1 + e5m2, C[3])]),
        weighted([(e4m1, C[1]), (e3m0 + e5m2, C[3])]),
        weighted([(e5m2, C[1]), (e3m0 + e4m1, C[3])]),
        weighted([(e4m3, C[0]), (e1m0, C[2])]),
        weighted([(e5m3, C[0]), (e2m0, C[2])]),
    ]
}

/// Forces on nodes from `ω P X_ξ⁻ᵀ` by columns: minus the transpose of [`columns`].
#[inline(always)]
fn to_nodes<R: Real>(s: &[Vec3<R>; 7]) -> [Vec3<R>; 6] {
    let t1m0_xi = weighted([(s[0], C[0]), (s[5], C[2])]);
    let t4m3_xi = weighted([(s[5], C[0]), (s[0], C[2])]);
    let t2m0_eta = weighted([(s[1], C[0]), (s[6], C[2])]);
    let t5m3_eta = weighted([(s[6], C[0]), (s[1], C[2])]);
    let t3m0_zeta = weighted([(s[2], C[1]), (s[3] + s[4], C[3])]);
    let t4m1_zeta = weighted([(s[3], C[1]), (s[2] + s[4], C[3])]);
    let t5m2_zeta = weighted([(s[4], C[1]), (s[2] + s[3], C[3])]);
    [
        t1m0_xi + t2m0_eta + t3m0_zeta,
        t4m1_zeta - t1m0_xi,
        t5m2_zeta - t2m0_eta,
        t4m3_xi + t5m3_eta - t3m0_zeta,
        -(t4m3_xi + t4m1_zeta),
        -(t5m3_eta + t5m2_zeta),
    ]
}

impl DerivedElement<6> for StableNeoHookeanPrism6 {
    const SAMPLES: usize = 6;
    type Numbers<R: Real> = Numbers<R>;

    #[inline(always)]
    fn energy<R: Real>(p: &Numbers<R>, x: &[Vec3<R>; 6], at: &impl RestSamples<R>) -> R {
        let c = columns(x);
        let (X, volume) = at.sample(0);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[0], c[1], c[2]) * X;
        let w0 = energy_of(&D, &F);
        let (X, volume) = at.sample(1);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[0], c[1], c[3]) * X;
        let w1 = energy_of(&D, &F);
        let (X, volume) = at.sample(2);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[0], c[1], c[4]) * X;
        let w2 = energy_of(&D, &F);
        let (X, volume) = at.sample(3);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[5], c[6], c[2]) * X;
        let w3 = energy_of(&D, &F);
        let (X, volume) = at.sample(4);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[5], c[6], c[3]) * X;
        let w4 = energy_of(&D, &F);
        let (X, volume) = at.sample(5);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[5], c[6], c[4]) * X;
        let w5 = energy_of(&D, &F);
        w0 + w1 + w2 + w3 + w4 + w5
    }

    #[inline(always)]
    fn forces<R: Real>(p: &Numbers<R>, x: &[Vec3<R>; 6], at: &impl RestSamples<R>) -> [Vec3<R>; 6] {
        let c = columns(x);
        let (X, volume) = at.sample(0);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[0], c[1], c[2]) * X;
        let [h0_0, h0_1, h0_2] = stress_of(&D, &F).mul_transpose(&X).columns;
        let (X, volume) = at.sample(1);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[0], c[1], c[3]) * X;
        let [h1_0, h1_1, h1_2] = stress_of(&D, &F).mul_transpose(&X).columns;
        let (X, volume) = at.sample(2);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[0], c[1], c[4]) * X;
        let [h2_0, h2_1, h2_2] = stress_of(&D, &F).mul_transpose(&X).columns;
        let s0 = h0_0 + h1_0 + h2_0;
        let s1 = h0_1 + h1_1 + h2_1;
        let (X, volume) = at.sample(3);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[5], c[6], c[2]) * X;
        let [h3_0, h3_1, h3_2] = stress_of(&D, &F).mul_transpose(&X).columns;
        let s2 = h0_2 + h3_2;
        let (X, volume) = at.sample(4);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[5], c[6], c[3]) * X;
        let [h4_0, h4_1, h4_2] = stress_of(&D, &F).mul_transpose(&X).columns;
        let s3 = h1_2 + h4_2;
        let (X, volume) = at.sample(5);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[5], c[6], c[4]) * X;
        let [h5_0, h5_1, h5_2] = stress_of(&D, &F).mul_transpose(&X).columns;
        let s5 = h3_0 + h4_0 + h5_0;
        let s6 = h3_1 + h4_1 + h5_1;
        let s4 = h2_2 + h5_2;
        to_nodes(&[s0, s1, s2, s3, s4, s5, s6])
    }

    #[inline(always)]
    fn differential<R: Real>(
        p: &Numbers<R>,
        x: &[Vec3<R>; 6],
        dx: &[Vec3<R>; 6],
        at: &impl RestSamples<R>,
    ) -> [Vec3<R>; 6] {
        let c = columns(x);
        let dc = columns(dx);
        let (X, volume) = at.sample(0);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[0], c[1], c[2]) * X;
        let dF = Mat3::from_columns(dc[0], dc[1], dc[2]) * X;
        let [h0_0, h0_1, h0_2] = differential_of(&D, &F, &dF).mul_transpose(&X).columns;
        let (X, volume) = at.sample(1);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[0], c[1], c[3]) * X;
        let dF = Mat3::from_columns(dc[0], dc[1], dc[3]) * X;
        let [h1_0, h1_1, h1_2] = differential_of(&D, &F, &dF).mul_transpose(&X).columns;
        let (X, volume) = at.sample(2);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[0], c[1], c[4]) * X;
        let dF = Mat3::from_columns(dc[0], dc[1], dc[4]) * X;
        let [h2_0, h2_1, h2_2] = differential_of(&D, &F, &dF).mul_transpose(&X).columns;
        let s0 = h0_0 + h1_0 + h2_0;
        let s1 = h0_1 + h1_1 + h2_1;
        let (X, volume) = at.sample(3);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[5], c[6], c[2]) * X;
        let dF = Mat3::from_columns(dc[5], dc[6], dc[2]) * X;
        let [h3_0, h3_1, h3_2] = differential_of(&D, &F, &dF).mul_transpose(&X).columns;
        let s2 = h0_2 + h3_2;
        let (X, volume) = at.sample(4);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[5], c[6], c[3]) * X;
        let dF = Mat3::from_columns(dc[5], dc[6], dc[3]) * X;
        let [h4_0, h4_1, h4_2] = differential_of(&D, &F, &dF).mul_transpose(&X).columns;
        let s3 = h1_2 + h4_2;
        let (X, volume) = at.sample(5);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[5], c[6], c[4]) * X;
        let dF = Mat3::from_columns(dc[5], dc[6], dc[4]) * X;
        let [h5_0, h5_1, h5_2] = differential_of(&D, &F, &dF).mul_transpose(&X).columns;
        let s5 = h3_0 + h4_0 + h5_0;
        let s6 = h3_1 + h4_1 + h5_1;
        let s4 = h2_2 + h5_2;
        to_nodes(&[s0, s1, s2, s3, s4, s5, s6])
    }
}
