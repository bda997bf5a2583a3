//! quadratic in Green strain, on `hex8`; derived from its text by `souple derive --emit kernel`, and not changed by hand.
//!
//! ```text
//! Ψ = lambda/2*tr(E)^2 + mu*dot(E, E)
//! ```
//!
//! Grouped constants at each of 8 samples: `X = X_ξ⁻¹`, 9, and moduli times the volume, 2: 11.

use souple_math::{Mat3, Real, Vec3};

use crate::materials::Parameters;
use crate::solids::derived::{DerivedElement, RestSamples, weighted};

/// See the module.
#[derive(Clone, Copy, Debug)]
pub struct StVenantKirchhoffHex8;

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

/// Of `∂N/∂ξ` at the samples, without signs.
const C: [f64; 3] = [0.3110042339640731, 0.08333333333333334, 0.02232909936926023];

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
fn columns<R: Real>(x: &[Vec3<R>; 8]) -> [Vec3<R>; 12] {
    let e1m0 = x[1] - x[0];
    let e2m3 = x[2] - x[3];
    let e5m4 = x[5] - x[4];
    let e6m7 = x[6] - x[7];
    let e3m0 = x[3] - x[0];
    let e2m1 = x[2] - x[1];
    let e7m4 = x[7] - x[4];
    let e6m5 = x[6] - x[5];
    let e4m0 = x[4] - x[0];
    let e5m1 = x[5] - x[1];
    let e6m2 = x[6] - x[2];
    let e7m3 = x[7] - x[3];
    [
        weighted([(e1m0, C[0]), (e2m3 + e5m4, C[1]), (e6m7, C[2])]),
        weighted([(e3m0, C[0]), (e2m1 + e7m4, C[1]), (e6m5, C[2])]),
        weighted([(e4m0, C[0]), (e5m1 + e7m3, C[1]), (e6m2, C[2])]),
        weighted([(e2m1, C[0]), (e3m0 + e6m5, C[1]), (e7m4, C[2])]),
        weighted([(e5m1, C[0]), (e4m0 + e6m2, C[1]), (e7m3, C[2])]),
        weighted([(e2m3, C[0]), (e1m0 + e6m7, C[1]), (e5m4, C[2])]),
        weighted([(e7m3, C[0]), (e4m0 + e6m2, C[1]), (e5m1, C[2])]),
        weighted([(e6m2, C[0]), (e5m1 + e7m3, C[1]), (e4m0, C[2])]),
        weighted([(e5m4, C[0]), (e1m0 + e6m7, C[1]), (e2m3, C[2])]),
        weighted([(e7m4, C[0]), (e3m0 + e6m5, C[1]), (e2m1, C[2])]),
        weighted([(e6m5, C[0]), (e2m1 + e7m4, C[1]), (e3m0, C[2])]),
        weighted([(e6m7, C[0]), (e2m3 + e5m4, C[1]), (e1m0, C[2])]),
    ]
}

/// Forces on nodes from `ω P X_ξ⁻ᵀ` by columns: minus the transpose of [`columns`].
#[inline(always)]
fn to_nodes<R: Real>(s: &[Vec3<R>; 12]) -> [Vec3<R>; 8] {
    let t1m0_xi = weighted([(s[0], C[0]), (s[5] + s[8], C[1]), (s[11], C[2])]);
    let t2m3_xi = weighted([(s[5], C[0]), (s[0] + s[11], C[1]), (s[8], C[2])]);
    let t5m4_xi = weighted([(s[8], C[0]), (s[0] + s[11], C[1]), (s[5], C[2])]);
    let t6m7_xi = weighted([(s[11], C[0]), (s[5] + s[8], C[1]), (s[0], C[2])]);
    let t3m0_eta = weighted([(s[1], C[0]), (s[3] + s[9], C[1]), (s[10], C[2])]);
    let t2m1_eta = weighted([(s[3], C[0]), (s[1] + s[10], C[1]), (s[9], C[2])]);
    let t7m4_eta = weighted([(s[9], C[0]), (s[1] + s[10], C[1]), (s[3], C[2])]);
    let t6m5_eta = weighted([(s[10], C[0]), (s[3] + s[9], C[1]), (s[1], C[2])]);
    let t4m0_zeta = weighted([(s[2], C[0]), (s[4] + s[6], C[1]), (s[7], C[2])]);
    let t5m1_zeta = weighted([(s[4], C[0]), (s[2] + s[7], C[1]), (s[6], C[2])]);
    let t6m2_zeta = weighted([(s[7], C[0]), (s[4] + s[6], C[1]), (s[2], C[2])]);
    let t7m3_zeta = weighted([(s[6], C[0]), (s[2] + s[7], C[1]), (s[4], C[2])]);
    [
        t1m0_xi + t3m0_eta + t4m0_zeta,
        t2m1_eta + t5m1_zeta - t1m0_xi,
        t6m2_zeta - t2m3_xi - t2m1_eta,
        t2m3_xi + t7m3_zeta - t3m0_eta,
        t5m4_xi + t7m4_eta - t4m0_zeta,
        t6m5_eta - t5m4_xi - t5m1_zeta,
        -(t6m7_xi + t6m5_eta + t6m2_zeta),
        t6m7_xi - t7m4_eta - t7m3_zeta,
    ]
}

impl DerivedElement<8> for StVenantKirchhoffHex8 {
    const SAMPLES: usize = 8;
    type Numbers<R: Real> = Numbers<R>;

    #[inline(always)]
    fn energy<R: Real>(p: &Numbers<R>, x: &[Vec3<R>; 8], at: &impl RestSamples<R>) -> R {
        let c = columns(x);
        let (X, volume) = at.sample(0);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[0], c[1], c[2]) * X;
        let w0 = energy_of(&D, &F);
        let (X, volume) = at.sample(1);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[0], c[3], c[4]) * X;
        let w1 = energy_of(&D, &F);
        let (X, volume) = at.sample(2);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[5], c[1], c[6]) * X;
        let w2 = energy_of(&D, &F);
        let (X, volume) = at.sample(3);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[5], c[3], c[7]) * X;
        let w3 = energy_of(&D, &F);
        let (X, volume) = at.sample(4);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[8], c[9], c[2]) * X;
        let w4 = energy_of(&D, &F);
        let (X, volume) = at.sample(5);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[8], c[10], c[4]) * X;
        let w5 = energy_of(&D, &F);
        let (X, volume) = at.sample(6);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[11], c[9], c[6]) * X;
        let w6 = energy_of(&D, &F);
        let (X, volume) = at.sample(7);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[11], c[10], c[7]) * X;
        let w7 = energy_of(&D, &F);
        w0 + w1 + w2 + w3 + w4 + w5 + w6 + w7
    }

    #[inline(always)]
    fn forces<R: Real>(p: &Numbers<R>, x: &[Vec3<R>; 8], at: &impl RestSamples<R>) -> [Vec3<R>; 8] {
        let c = columns(x);
        let (X, volume) = at.sample(0);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[0], c[1], c[2]) * X;
        let [h0_0, h0_1, h0_2] = stress_of(&D, &F).mul_transpose(&X).columns;
        let (X, volume) = at.sample(1);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[0], c[3], c[4]) * X;
        let [h1_0, h1_1, h1_2] = stress_of(&D, &F).mul_transpose(&X).columns;
        let s0 = h0_0 + h1_0;
        let (X, volume) = at.sample(2);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[5], c[1], c[6]) * X;
        let [h2_0, h2_1, h2_2] = stress_of(&D, &F).mul_transpose(&X).columns;
        let s1 = h0_1 + h2_1;
        let (X, volume) = at.sample(3);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[5], c[3], c[7]) * X;
        let [h3_0, h3_1, h3_2] = stress_of(&D, &F).mul_transpose(&X).columns;
        let s5 = h2_0 + h3_0;
        let s3 = h1_1 + h3_1;
        let (X, volume) = at.sample(4);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[8], c[9], c[2]) * X;
        let [h4_0, h4_1, h4_2] = stress_of(&D, &F).mul_transpose(&X).columns;
        let s2 = h0_2 + h4_2;
        let (X, volume) = at.sample(5);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[8], c[10], c[4]) * X;
        let [h5_0, h5_1, h5_2] = stress_of(&D, &F).mul_transpose(&X).columns;
        let s8 = h4_0 + h5_0;
        let s4 = h1_2 + h5_2;
        let (X, volume) = at.sample(6);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[11], c[9], c[6]) * X;
        let [h6_0, h6_1, h6_2] = stress_of(&D, &F).mul_transpose(&X).columns;
        let s9 = h4_1 + h6_1;
        let s6 = h2_2 + h6_2;
        let (X, volume) = at.sample(7);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[11], c[10], c[7]) * X;
        let [h7_0, h7_1, h7_2] = stress_of(&D, &F).mul_transpose(&X).columns;
        let s11 = h6_0 + h7_0;
        let s10 = h5_1 + h7_1;
        let s7 = h3_2 + h7_2;
        to_nodes(&[s0, s1, s2, s3, s4, s5, s6, s7, s8, s9, s10, s11])
    }

    #[inline(always)]
    fn differential<R: Real>(
        p: &Numbers<R>,
        x: &[Vec3<R>; 8],
        dx: &[Vec3<R>; 8],
        at: &impl RestSamples<R>,
    ) -> [Vec3<R>; 8] {
        let c = columns(x);
        let dc = columns(dx);
        let (X, volume) = at.sample(0);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[0], c[1], c[2]) * X;
        let dF = Mat3::from_columns(dc[0], dc[1], dc[2]) * X;
        let [h0_0, h0_1, h0_2] = differential_of(&D, &F, &dF).mul_transpose(&X).columns;
        let (X, volume) = at.sample(1);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[0], c[3], c[4]) * X;
        let dF = Mat3::from_columns(dc[0], dc[3], dc[4]) * X;
        let [h1_0, h1_1, h1_2] = differential_of(&D, &F, &dF).mul_transpose(&X).columns;
        let s0 = h0_0 + h1_0;
        let (X, volume) = at.sample(2);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[5], c[1], c[6]) * X;
        let dF = Mat3::from_columns(dc[5], dc[1], dc[6]) * X;
        let [h2_0, h2_1, h2_2] = differential_of(&D, &F, &dF).mul_transpose(&X).columns;
        let s1 = h0_1 + h2_1;
        let (X, volume) = at.sample(3);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[5], c[3], c[7]) * X;
        let dF = Mat3::from_columns(dc[5], dc[3], dc[7]) * X;
        let [h3_0, h3_1, h3_2] = differential_of(&D, &F, &dF).mul_transpose(&X).columns;
        let s5 = h2_0 + h3_0;
        let s3 = h1_1 + h3_1;
        let (X, volume) = at.sample(4);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[8], c[9], c[2]) * X;
        let dF = Mat3::from_columns(dc[8], dc[9], dc[2]) * X;
        let [h4_0, h4_1, h4_2] = differential_of(&D, &F, &dF).mul_transpose(&X).columns;
        let s2 = h0_2 + h4_2;
        let (X, volume) = at.sample(5);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[8], c[10], c[4]) * X;
        let dF = Mat3::from_columns(dc[8], dc[10], dc[4]) * X;
        let [h5_0, h5_1, h5_2] = differential_of(&D, &F, &dF).mul_transpose(&X).columns;
        let s8 = h4_0 + h5_0;
        let s4 = h1_2 + h5_2;
        let (X, volume) = at.sample(6);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[11], c[9], c[6]) * X;
        let dF = Mat3::from_columns(dc[11], dc[9], dc[6]) * X;
        let [h6_0, h6_1, h6_2] = differential_of(&D, &F, &dF).mul_transpose(&X).columns;
        let s9 = h4_1 + h6_1;
        let s6 = h2_2 + h6_2;
        let (X, volume) = at.sample(7);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[11], c[10], c[7]) * X;
        let dF = Mat3::from_columns(dc[11], dc[10], dc[7]) * X;
        let [h7_0, h7_1, h7_2] = differential_of(&D, &F, &dF).mul_transpose(&X).columns;
        let s11 = h6_0 + h7_0;
        let s10 = h5_1 + h7_1;
        let s7 = h3_2 + h7_2;
        to_nodes(&[s0, s1, s2, s3, s4, s5, s6, s7, s8, s9, s10, s11])
    }
}
