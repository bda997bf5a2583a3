//! quadratic in Green strain, on `hex8`, a box along the axes; derived from its text by `souple derive --emit kernel`, and not changed by hand.
//!
//! ```text
//! Ψ = lambda/2*tr(E)^2 + mu*dot(E, E)
//! ```
//!
//! Grouped constants: the diagonal of `X = X_ξ⁻¹`, 3, and moduli times the volume, 2: 5.

use souple_math::{Mat3, Real, Vec3};

use crate::materials::Parameters;
use crate::solids::derived::boxes::{
    add_across, add_scaled, along, bilinear, forces_of_modes, metric, metric_differential,
};
use crate::solids::derived::{DerivedElement, RestSamples};

/// See the module.
#[derive(Clone, Copy, Debug)]
pub struct StVenantKirchhoffHex8Box;

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
fn energy_of<R: Real>(D: &Constants<R>, C: &Mat3<R>) -> R {
    let C = *C;
    let one = C.columns[0].x.one();
    let M1 = C * 0.5;
    let M2 = M1.plus_diagonal(one.splat(-0.5)); // 0.5*C - 0.5*I
    let s1 = M2.dot(&M2);
    let s2 = C.trace(); // tr(C)
    let s3 = s2.mul_add(one.splat(0.5), one.splat(-1.5)); // 0.5*tr(C) - 1.5
    let s4 = s3 * s3; // (0.5*tr(C) - 1.5)^2
    let s5 = D.d0 * 0.5; // 0.5*D_0
    let s6 = s1 * D.d1;
    s4.mul_add(s5, s6)
}

/// `ω S`.
#[inline(always)]
fn stress_of<R: Real>(D: &Constants<R>, C: &Mat3<R>) -> Mat3<R> {
    let C = *C;
    let one = C.columns[0].x.one();
    let M1 = C.scaled(D.d1);
    let s1 = C.trace(); // tr(C)
    let s2 = s1.mul_add(one.splat(0.5), one.splat(-1.5)); // 0.5*tr(C) - 1.5
    let s3 = s2 * D.d0;
    let s4 = D.d1.mul_add(one.splat(-1.0), s3); // (0.5*tr(C) - 1.5)*D_0 - D_1
    M1.plus_diagonal(s4)
}

/// `ω S` and `ω δS`.
#[inline(always)]
fn differential_of<R: Real>(D: &Constants<R>, C: &Mat3<R>, dC: &Mat3<R>) -> (Mat3<R>, Mat3<R>) {
    let C = *C;
    let dC = *dC;
    let one = C.columns[0].x.one();
    let M1 = C.scaled(D.d1);
    let s1 = C.trace(); // tr(C)
    let s2 = s1.mul_add(one.splat(0.5), one.splat(-1.5)); // 0.5*tr(C) - 1.5
    let s3 = s2 * D.d0;
    let s4 = D.d1.mul_add(one.splat(-1.0), s3); // (0.5*tr(C) - 1.5)*D_0 - D_1
    let M2 = M1.plus_diagonal(s4); // D_1*C + ((0.5*tr(C) - 1.5)*D_0 - D_1)*I
    let s5 = D.d0 * 0.5; // 0.5*D_0
    let M3 = dC.scaled(D.d1);
    let s6 = dC.trace(); // tr(dC)
    let s7 = s5 * s6; // tr(dC)*0.5*D_0
    let M4 = M3.plus_diagonal(s7); // D_1*dC + tr(dC)*0.5*D_0*I
    (M2, M4)
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

impl DerivedElement<8> for StVenantKirchhoffHex8Box {
    const SAMPLES: usize = 8;
    type Numbers<R: Real> = Numbers<R>;

    #[inline(always)]
    fn energy<R: Real>(p: &Numbers<R>, x: &[Vec3<R>; 8], at: &impl RestSamples<R>) -> R {
        let (X, volume) = at.sample(0);
        let K = along(&X, MODES);
        let c = columns(x, &K);
        let D = Constants::of(p, volume);
        let g = [
            c[0].dot(c[0]),
            c[1].dot(c[1]),
            c[2].dot(c[2]),
            c[3].dot(c[3]),
            c[4].dot(c[4]),
            c[5].dot(c[5]),
            c[6].dot(c[6]),
            c[7].dot(c[7]),
            c[8].dot(c[8]),
            c[9].dot(c[9]),
            c[10].dot(c[10]),
            c[11].dot(c[11]),
        ];
        let w0 = energy_of(&D, &metric([c[0], c[4], c[8]], [g[0], g[4], g[8]]));
        let w1 = energy_of(&D, &metric([c[0], c[5], c[9]], [g[0], g[5], g[9]]));
        let w2 = energy_of(&D, &metric([c[1], c[4], c[10]], [g[1], g[4], g[10]]));
        let w3 = energy_of(&D, &metric([c[1], c[5], c[11]], [g[1], g[5], g[11]]));
        let w4 = energy_of(&D, &metric([c[2], c[6], c[8]], [g[2], g[6], g[8]]));
        let w5 = energy_of(&D, &metric([c[2], c[7], c[9]], [g[2], g[7], g[9]]));
        let w6 = energy_of(&D, &metric([c[3], c[6], c[10]], [g[3], g[6], g[10]]));
        let w7 = energy_of(&D, &metric([c[3], c[7], c[11]], [g[3], g[7], g[11]]));
        w0 + w1 + w2 + w3 + w4 + w5 + w6 + w7
    }

    #[inline(always)]
    fn forces<R: Real>(p: &Numbers<R>, x: &[Vec3<R>; 8], at: &impl RestSamples<R>) -> [Vec3<R>; 8] {
        let (X, volume) = at.sample(0);
        let K = along(&X, MODES);
        let c = columns(x, &K);
        let D = Constants::of(p, volume);
        let g = [
            c[0].dot(c[0]),
            c[1].dot(c[1]),
            c[2].dot(c[2]),
            c[3].dot(c[3]),
            c[4].dot(c[4]),
            c[5].dot(c[5]),
            c[6].dot(c[6]),
            c[7].dot(c[7]),
            c[8].dot(c[8]),
            c[9].dot(c[9]),
            c[10].dot(c[10]),
            c[11].dot(c[11]),
        ];
        let zero = c[0] * volume.zero();
        let S0 = stress_of(&D, &metric([c[0], c[4], c[8]], [g[0], g[4], g[8]]));
        let [s0, s4, s8] = add_across([zero, zero, zero], [c[0], c[4], c[8]], &S0);
        let S1 = stress_of(&D, &metric([c[0], c[5], c[9]], [g[0], g[5], g[9]]));
        let [s0, s5, s9] = add_across([s0, zero, zero], [c[0], c[5], c[9]], &S1);
        let s0 = add_scaled(s0, c[0], S0.columns[0].x + S1.columns[0].x);
        let S2 = stress_of(&D, &metric([c[1], c[4], c[10]], [g[1], g[4], g[10]]));
        let [s1, s4, s10] = add_across([zero, s4, zero], [c[1], c[4], c[10]], &S2);
        let s4 = add_scaled(s4, c[4], S0.columns[1].y + S2.columns[1].y);
        let S3 = stress_of(&D, &metric([c[1], c[5], c[11]], [g[1], g[5], g[11]]));
        let [s1, s5, s11] = add_across([s1, s5, zero], [c[1], c[5], c[11]], &S3);
        let s1 = add_scaled(s1, c[1], S2.columns[0].x + S3.columns[0].x);
        let s5 = add_scaled(s5, c[5], S1.columns[1].y + S3.columns[1].y);
        let S4 = stress_of(&D, &metric([c[2], c[6], c[8]], [g[2], g[6], g[8]]));
        let [s2, s6, s8] = add_across([zero, zero, s8], [c[2], c[6], c[8]], &S4);
        let s8 = add_scaled(s8, c[8], S0.columns[2].z + S4.columns[2].z);
        let S5 = stress_of(&D, &metric([c[2], c[7], c[9]], [g[2], g[7], g[9]]));
        let [s2, s7, s9] = add_across([s2, zero, s9], [c[2], c[7], c[9]], &S5);
        let s2 = add_scaled(s2, c[2], S4.columns[0].x + S5.columns[0].x);
        let s9 = add_scaled(s9, c[9], S1.columns[2].z + S5.columns[2].z);
        let S6 = stress_of(&D, &metric([c[3], c[6], c[10]], [g[3], g[6], g[10]]));
        let [s3, s6, s10] = add_across([zero, s6, s10], [c[3], c[6], c[10]], &S6);
        let s6 = add_scaled(s6, c[6], S4.columns[1].y + S6.columns[1].y);
        let s10 = add_scaled(s10, c[10], S2.columns[2].z + S6.columns[2].z);
        let S7 = stress_of(&D, &metric([c[3], c[7], c[11]], [g[3], g[7], g[11]]));
        let [s3, s7, s11] = add_across([s3, s7, s11], [c[3], c[7], c[11]], &S7);
        let s3 = add_scaled(s3, c[3], S6.columns[0].x + S7.columns[0].x);
        let s7 = add_scaled(s7, c[7], S5.columns[1].y + S7.columns[1].y);
        let s11 = add_scaled(s11, c[11], S3.columns[2].z + S7.columns[2].z);
        to_nodes(&[s0, s1, s2, s3, s4, s5, s6, s7, s8, s9, s10, s11], &K)
    }

    #[inline(always)]
    fn differential<R: Real>(
        p: &Numbers<R>,
        x: &[Vec3<R>; 8],
        dx: &[Vec3<R>; 8],
        at: &impl RestSamples<R>,
    ) -> [Vec3<R>; 8] {
        let (X, volume) = at.sample(0);
        let K = along(&X, MODES);
        let c = columns(x, &K);
        let dc = columns(dx, &K);
        let D = Constants::of(p, volume);
        let g = [
            c[0].dot(c[0]),
            c[1].dot(c[1]),
            c[2].dot(c[2]),
            c[3].dot(c[3]),
            c[4].dot(c[4]),
            c[5].dot(c[5]),
            c[6].dot(c[6]),
            c[7].dot(c[7]),
            c[8].dot(c[8]),
            c[9].dot(c[9]),
            c[10].dot(c[10]),
            c[11].dot(c[11]),
        ];
        let dg = [
            c[0].dot(dc[0]),
            c[1].dot(dc[1]),
            c[2].dot(dc[2]),
            c[3].dot(dc[3]),
            c[4].dot(dc[4]),
            c[5].dot(dc[5]),
            c[6].dot(dc[6]),
            c[7].dot(dc[7]),
            c[8].dot(dc[8]),
            c[9].dot(dc[9]),
            c[10].dot(dc[10]),
            c[11].dot(dc[11]),
        ];
        let zero = c[0] * volume.zero();
        let (F, dF) = ([c[0], c[4], c[8]], [dc[0], dc[4], dc[8]]);
        let C = metric(F, [g[0], g[4], g[8]]);
        let dC = metric_differential(F, dF, [dg[0], dg[4], dg[8]]);
        let (S0, dS0) = differential_of(&D, &C, &dC);
        let [s0, s4, s8] = add_across(add_across([zero, zero, zero], F, &dS0), dF, &S0);
        let (F, dF) = ([c[0], c[5], c[9]], [dc[0], dc[5], dc[9]]);
        let C = metric(F, [g[0], g[5], g[9]]);
        let dC = metric_differential(F, dF, [dg[0], dg[5], dg[9]]);
        let (S1, dS1) = differential_of(&D, &C, &dC);
        let [s0, s5, s9] = add_across(add_across([s0, zero, zero], F, &dS1), dF, &S1);
        let s0 = add_scaled(
            add_scaled(s0, dc[0], S0.columns[0].x + S1.columns[0].x),
            c[0],
            dS0.columns[0].x + dS1.columns[0].x,
        );
        let (F, dF) = ([c[1], c[4], c[10]], [dc[1], dc[4], dc[10]]);
        let C = metric(F, [g[1], g[4], g[10]]);
        let dC = metric_differential(F, dF, [dg[1], dg[4], dg[10]]);
        let (S2, dS2) = differential_of(&D, &C, &dC);
        let [s1, s4, s10] = add_across(add_across([zero, s4, zero], F, &dS2), dF, &S2);
        let s4 = add_scaled(
            add_scaled(s4, dc[4], S0.columns[1].y + S2.columns[1].y),
            c[4],
            dS0.columns[1].y + dS2.columns[1].y,
        );
        let (F, dF) = ([c[1], c[5], c[11]], [dc[1], dc[5], dc[11]]);
        let C = metric(F, [g[1], g[5], g[11]]);
        let dC = metric_differential(F, dF, [dg[1], dg[5], dg[11]]);
        let (S3, dS3) = differential_of(&D, &C, &dC);
        let [s1, s5, s11] = add_across(add_across([s1, s5, zero], F, &dS3), dF, &S3);
        let s1 = add_scaled(
            add_scaled(s1, dc[1], S2.columns[0].x + S3.columns[0].x),
            c[1],
            dS2.columns[0].x + dS3.columns[0].x,
        );
        let s5 = add_scaled(
            add_scaled(s5, dc[5], S1.columns[1].y + S3.columns[1].y),
            c[5],
            dS1.columns[1].y + dS3.columns[1].y,
        );
        let (F, dF) = ([c[2], c[6], c[8]], [dc[2], dc[6], dc[8]]);
        let C = metric(F, [g[2], g[6], g[8]]);
        let dC = metric_differential(F, dF, [dg[2], dg[6], dg[8]]);
        let (S4, dS4) = differential_of(&D, &C, &dC);
        let [s2, s6, s8] = add_across(add_across([zero, zero, s8], F, &dS4), dF, &S4);
        let s8 = add_scaled(
            add_scaled(s8, dc[8], S0.columns[2].z + S4.columns[2].z),
            c[8],
            dS0.columns[2].z + dS4.columns[2].z,
        );
        let (F, dF) = ([c[2], c[7], c[9]], [dc[2], dc[7], dc[9]]);
        let C = metric(F, [g[2], g[7], g[9]]);
        let dC = metric_differential(F, dF, [dg[2], dg[7], dg[9]]);
        let (S5, dS5) = differential_of(&D, &C, &dC);
        let [s2, s7, s9] = add_across(add_across([s2, zero, s9], F, &dS5), dF, &S5);
        let s2 = add_scaled(
            add_scaled(s2, dc[2], S4.columns[0].x + S5.columns[0].x),
            c[2],
            dS4.columns[0].x + dS5.columns[0].x,
        );
        let s9 = add_scaled(
            add_scaled(s9, dc[9], S1.columns[2].z + S5.columns[2].z),
            c[9],
            dS1.columns[2].z + dS5.columns[2].z,
        );
        let (F, dF) = ([c[3], c[6], c[10]], [dc[3], dc[6], dc[10]]);
        let C = metric(F, [g[3], g[6], g[10]]);
        let dC = metric_differential(F, dF, [dg[3], dg[6], dg[10]]);
        let (S6, dS6) = differential_of(&D, &C, &dC);
        let [s3, s6, s10] = add_across(add_across([zero, s6, s10], F, &dS6), dF, &S6);
        let s6 = add_scaled(
            add_scaled(s6, dc[6], S4.columns[1].y + S6.columns[1].y),
            c[6],
            dS4.columns[1].y + dS6.columns[1].y,
        );
        let s10 = add_scaled(
            add_scaled(s10, dc[10], S2.columns[2].z + S6.columns[2].z),
            c[10],
            dS2.columns[2].z + dS6.columns[2].z,
        );
        let (F, dF) = ([c[3], c[7], c[11]], [dc[3], dc[7], dc[11]]);
        let C = metric(F, [g[3], g[7], g[11]]);
        let dC = metric_differential(F, dF, [dg[3], dg[7], dg[11]]);
        let (S7, dS7) = differential_of(&D, &C, &dC);
        let [s3, s7, s11] = add_across(add_across([s3, s7, s11], F, &dS7), dF, &S7);
        let s3 = add_scaled(
            add_scaled(s3, dc[3], S6.columns[0].x + S7.columns[0].x),
            c[3],
            dS6.columns[0].x + dS7.columns[0].x,
        );
        let s7 = add_scaled(
            add_scaled(s7, dc[7], S5.columns[1].y + S7.columns[1].y),
            c[7],
            dS5.columns[1].y + dS7.columns[1].y,
        );
        let s11 = add_scaled(
            add_scaled(s11, dc[11], S3.columns[2].z + S7.columns[2].z),
            c[11],
            dS3.columns[2].z + dS7.columns[2].z,
        );
        to_nodes(&[s0, s1, s2, s3, s4, s5, s6, s7, s8, s9, s10, s11], &K)
    }
}
