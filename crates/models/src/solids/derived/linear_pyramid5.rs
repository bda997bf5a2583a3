//! Hooke's law of small strain, on `pyramid5`; derived from its text by `souple derive --emit kernel`, and not changed by hand.
//!
//! ```text
//! Ψ = lambda/2*tr(eps)^2 + mu*dot(eps, eps)
//! ```
//!
//! Grouped constants at each of 4 samples: `X = X_ξ⁻¹`, 9, and moduli times the volume, 2: 11.

use souple_math::{Mat3, Real, Vec3};

use crate::materials::Parameters;
use crate::solids::derived::{DerivedElement, RestSamples, weighted};

/// See the module.
#[derive(Clone, Copy, Debug)]
pub struct LinearPyramid5;

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
const C: [f64; 5] = [1.0, 0.39433756729740643, 0.3333333333333333, 0.16666666666666669, 0.10566243270259357];

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
fn columns<R: Real>(x: &[Vec3<R>; 5]) -> [Vec3<R>; 6] {
    let e1m0 = x[1] - x[0];
    let e2m3 = x[2] - x[3];
    let e3m0 = x[3] - x[0];
    let e2m1 = x[2] - x[1];
    let u0_2 = x[0] + x[2];
    let u1_3 = x[1] + x[3];
    [
        weighted([(e1m0, C[1]), (e2m3, C[4])]),
        weighted([(e3m0, C[1]), (e2m1, C[4])]),
        weighted([(x[4], C[0]), (-u1_3, C[2]), (-u0_2, C[3])]),
        weighted([(e2m1, C[1]), (e3m0, C[4])]),
        weighted([(x[4], C[0]), (-u0_2, C[2]), (-u1_3, C[3])]),
        weighted([(e2m3, C[1]), (e1m0, C[4])]),
    ]
}

/// Forces on nodes from `ω P X_ξ⁻ᵀ` by columns: minus the transpose of [`columns`].
#[inline(always)]
fn to_nodes<R: Real>(s: &[Vec3<R>; 6]) -> [Vec3<R>; 5] {
    let t1m0_xi = weighted([(s[0], C[1]), (s[5], C[4])]);
    let t2m3_xi = weighted([(s[5], C[1]), (s[0], C[4])]);
    let t3m0_eta = weighted([(s[1], C[1]), (s[3], C[4])]);
    let t2m1_eta = weighted([(s[3], C[1]), (s[1], C[4])]);
    let t0_2_zeta = weighted([(-s[4], C[2]), (-s[2], C[3])]);
    let t1_3_zeta = weighted([(-s[2], C[2]), (-s[4], C[3])]);
    let t4_zeta = s[2] + s[4];
    [
        t1m0_xi + t3m0_eta - t0_2_zeta,
        t2m1_eta - t1m0_xi - t1_3_zeta,
        -(t2m3_xi + t2m1_eta + t0_2_zeta),
        t2m3_xi - t3m0_eta - t1_3_zeta,
        -t4_zeta,
    ]
}

impl DerivedElement<5> for LinearPyramid5 {
    const SAMPLES: usize = 4;
    type Numbers<R: Real> = Numbers<R>;

    #[inline(always)]
    fn energy<R: Real>(p: &Numbers<R>, x: &[Vec3<R>; 5], at: &impl RestSamples<R>) -> R {
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
        let F = Mat3::from_columns(c[5], c[1], c[4]) * X;
        let w2 = energy_of(&D, &F);
        let (X, volume) = at.sample(3);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[5], c[3], c[2]) * X;
        let w3 = energy_of(&D, &F);
        w0 + w1 + w2 + w3
    }

    #[inline(always)]
    fn forces<R: Real>(p: &Numbers<R>, x: &[Vec3<R>; 5], at: &impl RestSamples<R>) -> [Vec3<R>; 5] {
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
        let F = Mat3::from_columns(c[5], c[1], c[4]) * X;
        let [h2_0, h2_1, h2_2] = stress_of(&D, &F).mul_transpose(&X).columns;
        let s1 = h0_1 + h2_1;
        let s4 = h1_2 + h2_2;
        let (X, volume) = at.sample(3);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[5], c[3], c[2]) * X;
        let [h3_0, h3_1, h3_2] = stress_of(&D, &F).mul_transpose(&X).columns;
        let s5 = h2_0 + h3_0;
        let s3 = h1_1 + h3_1;
        let s2 = h0_2 + h3_2;
        to_nodes(&[s0, s1, s2, s3, s4, s5])
    }

    #[inline(always)]
    fn differential<R: Real>(
        p: &Numbers<R>,
        _: &[Vec3<R>; 5],
        dx: &[Vec3<R>; 5],
        at: &impl RestSamples<R>,
    ) -> [Vec3<R>; 5] {
        let dc = columns(dx);
        let (X, volume) = at.sample(0);
        let D = Constants::of(p, volume);
        let dF = Mat3::from_columns(dc[0], dc[1], dc[2]) * X;
        let [h0_0, h0_1, h0_2] = differential_of(&D, &dF).mul_transpose(&X).columns;
        let (X, volume) = at.sample(1);
        let D = Constants::of(p, volume);
        let dF = Mat3::from_columns(dc[0], dc[3], dc[4]) * X;
        let [h1_0, h1_1, h1_2] = differential_of(&D, &dF).mul_transpose(&X).columns;
        let s0 = h0_0 + h1_0;
        let (X, volume) = at.sample(2);
        let D = Constants::of(p, volume);
        let dF = Mat3::from_columns(dc[5], dc[1], dc[4]) * X;
        let [h2_0, h2_1, h2_2] = differential_of(&D, &dF).mul_transpose(&X).columns;
        let s1 = h0_1 + h2_1;
        let s4 = h1_2 + h2_2;
        let (X, volume) = at.sample(3);
        let D = Constants::of(p, volume);
        let dF = Mat3::from_columns(dc[5], dc[3], dc[2]) * X;
        let [h3_0, h3_1, h3_2] = differential_of(&D, &dF).mul_transpose(&X).columns;
        let s5 = h2_0 + h3_0;
        let s3 = h1_1 + h3_1;
        let s2 = h0_2 + h3_2;
        to_nodes(&[s0, s1, s2, s3, s4, s5])
    }
}
