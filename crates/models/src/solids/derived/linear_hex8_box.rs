//! Hooke's law of small strain, on `hex8`, a box along the axes; derived from its text by `souple derive --emit kernel`, and not changed by hand.
//!
//! ```text
//! Ψ = lambda/2*tr(eps)^2 + mu*dot(eps, eps)
//! ```
//!
//! Grouped constants: the diagonal of `X = X_ξ⁻¹`, 3, and moduli times the volume, 2: 5.

use souple_math::{Mat3, Real, Vec3};

use crate::materials::Parameters;
use crate::solids::derived::boxes::{along, bilinear, forces_of_modes};
use crate::solids::derived::{DerivedElement, RestSamples};

/// See the module.
#[derive(Clone, Copy, Debug)]
pub struct LinearHex8Box;

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

/// Weights of what is constant, linear and bilinear in the other coordinates, at the samples.
const MODES: [f64; 3] = [0.125, 0.07216878364870322, 0.041666666666666664];

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

/// `∂x/∂X` at the samples, by axes, from modes of the corners: `dds` is the sum along ζ of differences along ξ and η, `m` and `p` are
/// corners at -1 and at 1.
#[inline(always)]
fn columns<R: Real>(x: &[Vec3<R>; 8], K: &[[R; 3]; 3]) -> [Vec3<R>; 12] {
    let dmm = x[1] - x[0];
    let smm = x[1] + x[0];
    let dpm = x[2] - x[3];
    let spm = x[2] + x[3];
    let dmp = x[5] - x[4];
    let smp = x[5] + x[4];
    let dpp = x[6] - x[7];
    let spp = x[6] + x[7];
    let ddm = dpm - dmm;
    let dsm = dpm + dmm;
    let sdm = spm - smm;
    let ssm = spm + smm;
    let ddp = dpp - dmp;
    let dsp = dpp + dmp;
    let sdp = spp - smp;
    let ssp = spp + smp;
    let ddd = ddp - ddm;
    let dds = ddp + ddm;
    let sdd = sdp - sdm;
    let sds = sdp + sdm;
    let dsd = dsp - dsm;
    let dss = dsp + dsm;
    let ssd = ssp - ssm;
    let xi = bilinear([dss, dds, dsd, ddd], &K[0]);
    let eta = bilinear([sds, dds, sdd, ddd], &K[1]);
    let zeta = bilinear([ssd, dsd, sdd, ddd], &K[2]);
    [xi[0], xi[1], xi[2], xi[3], eta[0], eta[1], eta[2], eta[3], zeta[0], zeta[1], zeta[2], zeta[3]]
}

/// Forces on nodes from `ω P` by columns: minus the transpose of [`columns`].
#[inline(always)]
fn to_nodes<R: Real>(s: &[Vec3<R>; 12], K: &[[R; 3]; 3]) -> [Vec3<R>; 8] {
    let xi = forces_of_modes([s[0], s[1], s[2], s[3]], &K[0]);
    let eta = forces_of_modes([s[4], s[5], s[6], s[7]], &K[1]);
    let zeta = forces_of_modes([s[8], s[9], s[10], s[11]], &K[2]);
    let dss = xi[0];
    let dds = xi[1] + eta[1];
    let dsd = xi[2] + zeta[1];
    let ddd = xi[3] + eta[3] + zeta[3];
    let sds = eta[0];
    let sdd = eta[2] + zeta[2];
    let ssd = zeta[0];
    let ddm = dds - ddd;
    let ddp = dds + ddd;
    let sdm = sds - sdd;
    let sdp = sds + sdd;
    let dsm = dss - dsd;
    let dsp = dss + dsd;
    let ssm = -ssd;
    let ssp = ssd;
    let dmm = dsm - ddm;
    let dpm = dsm + ddm;
    let smm = ssm - sdm;
    let spm = ssm + sdm;
    let dmp = dsp - ddp;
    let dpp = dsp + ddp;
    let smp = ssp - sdp;
    let spp = ssp + sdp;
    let mmm = smm - dmm;
    let pmm = smm + dmm;
    let mpm = spm - dpm;
    let ppm = spm + dpm;
    let mmp = smp - dmp;
    let pmp = smp + dmp;
    let mpp = spp - dpp;
    let ppp = spp + dpp;
    [mmm, pmm, ppm, mpm, mmp, pmp, ppp, mpp]
}

impl DerivedElement<8> for LinearHex8Box {
    const SAMPLES: usize = 8;
    type Numbers<R: Real> = Numbers<R>;

    #[inline(always)]
    fn energy<R: Real>(p: &Numbers<R>, x: &[Vec3<R>; 8], at: &impl RestSamples<R>) -> R {
        let (X, volume) = at.sample(0);
        let K = along(&X, MODES);
        let c = columns(x, &K);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[0], c[4], c[8]);
        let w0 = energy_of(&D, &F);
        let F = Mat3::from_columns(c[0], c[5], c[9]);
        let w1 = energy_of(&D, &F);
        let F = Mat3::from_columns(c[1], c[4], c[10]);
        let w2 = energy_of(&D, &F);
        let F = Mat3::from_columns(c[1], c[5], c[11]);
        let w3 = energy_of(&D, &F);
        let F = Mat3::from_columns(c[2], c[6], c[8]);
        let w4 = energy_of(&D, &F);
        let F = Mat3::from_columns(c[2], c[7], c[9]);
        let w5 = energy_of(&D, &F);
        let F = Mat3::from_columns(c[3], c[6], c[10]);
        let w6 = energy_of(&D, &F);
        let F = Mat3::from_columns(c[3], c[7], c[11]);
        let w7 = energy_of(&D, &F);
        w0 + w1 + w2 + w3 + w4 + w5 + w6 + w7
    }

    #[inline(always)]
    fn forces<R: Real>(p: &Numbers<R>, x: &[Vec3<R>; 8], at: &impl RestSamples<R>) -> [Vec3<R>; 8] {
        let (X, volume) = at.sample(0);
        let K = along(&X, MODES);
        let c = columns(x, &K);
        let D = Constants::of(p, volume);
        let F = Mat3::from_columns(c[0], c[4], c[8]);
        let [h0_0, h0_1, h0_2] = stress_of(&D, &F).columns;
        let F = Mat3::from_columns(c[0], c[5], c[9]);
        let [h1_0, h1_1, h1_2] = stress_of(&D, &F).columns;
        let s0 = h0_0 + h1_0;
        let F = Mat3::from_columns(c[1], c[4], c[10]);
        let [h2_0, h2_1, h2_2] = stress_of(&D, &F).columns;
        let s4 = h0_1 + h2_1;
        let F = Mat3::from_columns(c[1], c[5], c[11]);
        let [h3_0, h3_1, h3_2] = stress_of(&D, &F).columns;
        let s1 = h2_0 + h3_0;
        let s5 = h1_1 + h3_1;
        let F = Mat3::from_columns(c[2], c[6], c[8]);
        let [h4_0, h4_1, h4_2] = stress_of(&D, &F).columns;
        let s8 = h0_2 + h4_2;
        let F = Mat3::from_columns(c[2], c[7], c[9]);
        let [h5_0, h5_1, h5_2] = stress_of(&D, &F).columns;
        let s2 = h4_0 + h5_0;
        let s9 = h1_2 + h5_2;
        let F = Mat3::from_columns(c[3], c[6], c[10]);
        let [h6_0, h6_1, h6_2] = stress_of(&D, &F).columns;
        let s6 = h4_1 + h6_1;
        let s10 = h2_2 + h6_2;
        let F = Mat3::from_columns(c[3], c[7], c[11]);
        let [h7_0, h7_1, h7_2] = stress_of(&D, &F).columns;
        let s3 = h6_0 + h7_0;
        let s7 = h5_1 + h7_1;
        let s11 = h3_2 + h7_2;
        to_nodes(&[s0, s1, s2, s3, s4, s5, s6, s7, s8, s9, s10, s11], &K)
    }

    #[inline(always)]
    fn differential<R: Real>(
        p: &Numbers<R>,
        _: &[Vec3<R>; 8],
        dx: &[Vec3<R>; 8],
        at: &impl RestSamples<R>,
    ) -> [Vec3<R>; 8] {
        let (X, volume) = at.sample(0);
        let K = along(&X, MODES);
        let dc = columns(dx, &K);
        let D = Constants::of(p, volume);
        let dF = Mat3::from_columns(dc[0], dc[4], dc[8]);
        let [h0_0, h0_1, h0_2] = differential_of(&D, &dF).columns;
        let dF = Mat3::from_columns(dc[0], dc[5], dc[9]);
        let [h1_0, h1_1, h1_2] = differential_of(&D, &dF).columns;
        let s0 = h0_0 + h1_0;
        let dF = Mat3::from_columns(dc[1], dc[4], dc[10]);
        let [h2_0, h2_1, h2_2] = differential_of(&D, &dF).columns;
        let s4 = h0_1 + h2_1;
        let dF = Mat3::from_columns(dc[1], dc[5], dc[11]);
        let [h3_0, h3_1, h3_2] = differential_of(&D, &dF).columns;
        let s1 = h2_0 + h3_0;
        let s5 = h1_1 + h3_1;
        let dF = Mat3::from_columns(dc[2], dc[6], dc[8]);
        let [h4_0, h4_1, h4_2] = differential_of(&D, &dF).columns;
        let s8 = h0_2 + h4_2;
        let dF = Mat3::from_columns(dc[2], dc[7], dc[9]);
        let [h5_0, h5_1, h5_2] = differential_of(&D, &dF).columns;
        let s2 = h4_0 + h5_0;
        let s9 = h1_2 + h5_2;
        let dF = Mat3::from_columns(dc[3], dc[6], dc[10]);
        let [h6_0, h6_1, h6_2] = differential_of(&D, &dF).columns;
        let s6 = h4_1 + h6_1;
        let s10 = h2_2 + h6_2;
        let dF = Mat3::from_columns(dc[3], dc[7], dc[11]);
        let [h7_0, h7_1, h7_2] = differential_of(&D, &dF).columns;
        let s3 = h6_0 + h7_0;
        let s7 = h5_1 + h7_1;
        let s11 = h3_2 + h7_2;
        to_nodes(&[s0, s1, s2, s3, s4, s5, s6, s7, s8, s9, s10, s11], &K)
    }
}
