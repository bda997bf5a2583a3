//! the logarithmic form; derived from its text by `souple derive --emit kernel`, and not changed by hand.
//!
//! ```text
//! Ψ = mu/2*(I1 - 3) - mu*log(J) + lambda/2*log(J)^2
//! ```

use souple_math::{Mat3, Real, Vec3};

use crate::materials::invariants::cofactor_differential;
use crate::materials::{Lame as Numbers, Law};

/// See the module.
#[derive(Clone, Copy, Debug)]
pub struct NeoHookean;

/// What differentials at one `F` share.
#[derive(Clone, Copy, Debug)]
pub struct Point<R> {
    F: Mat3<R>,
    M1: Mat3<R>,
    s7: R,
    s14: R,
    s21: R,
    s23: R,
    s24: R,
    s27: R,
}

impl Law for NeoHookean {
    type Parameters<R: Real> = Numbers<R>;
    type Point<R: Real> = Point<R>;

    #[inline(always)]
    fn at<R: Real>(p: &Numbers<R>, F: &Mat3<R>) -> Point<R> {
        let F = *F;
        let one = F.columns[0].x.one();
        let M1 = F.cofactor(); // cof(F)
        let s1 = F.columns[0].dot(M1.columns[0]); // det(F)
        let s2 = s1 * s1;
        let s3 = one / s2; // 1/det(F)^2
        let s4 = s3 * -1.0; // -1/det(F)^2
        let s5 = s1.select_less(one.splat(0.05), one.splat(-400.0), s4); // if(det(F) < 0.05, -400, -1/det(F)^2)
        let s6 = p.mu * -1.0;
        let s7 = s6 * s5;
        let s8 = s1 * 20.0; // 20*det(F)
        let s9 = s8 - 1.0; // 20*det(F) - 1
        let s10 = s9.mul_add(one.splat(-20.0), one.splat(20.0)); // 20 - 20*(20*det(F) - 1)
        let s11 = one / s1; // 1/det(F)
        let s12 = s1.select_less(one.splat(0.05), s10, s11);
        let s13 = s12 * s12;
        let s14 = p.lambda * s13;
        let s15 = s9 * s9; // (20*det(F) - 1)^2
        let s16 = s8 - 3.995732273553991;
        let s17 = s15.mul_add(one.splat(-0.5), s16);
        let s18 = s1.ln(); // ln(det(F))
        let s19 = s1.select_less(one.splat(0.05), s17, s18);
        let s20 = p.lambda * s19;
        let s21 = s20 * s5;
        let s22 = s6 * s12;
        let s23 = s20.mul_add(s12, s22);
        let s24 = s23 * -1.0;
        let s25 = s6 * s5;
        let s26 = p.lambda.mul_add(s13, s25);
        let s27 = s20.mul_add(s5, s26);
        Point { F, M1, s7, s14, s21, s23, s24, s27 }
    }

    #[inline(always)]
    fn energy_density<R: Real>(p: &Numbers<R>, F: &Mat3<R>) -> R {
        let F = *F;
        let one = F.columns[0].x.one();
        let s1 = F.dot(&F); // dot(F, F)
        let s2 = s1 - 3.0; // dot(F, F) - 3
        let s3 = p.mu * 0.5;
        let s4 = F.determinant(); // det(F)
        let s5 = s4 * 20.0; // 20*det(F)
        let s6 = s5 - 1.0; // 20*det(F) - 1
        let s7 = s6 * s6; // (20*det(F) - 1)^2
        let s8 = s5 - 3.995732273553991;
        let s9 = s7.mul_add(one.splat(-0.5), s8);
        let s10 = s4.ln(); // ln(det(F))
        let s11 = s4.select_less(one.splat(0.05), s9, s10);
        let s12 = p.mu * -1.0;
        let s13 = s11 * s11;
        let s14 = p.lambda * 0.5;
        let s15 = s3 * s2;
        let s16 = s12.mul_add(s11, s15);
        s14.mul_add(s13, s16)
    }

    #[inline(always)]
    fn stress<R: Real>(p: &Numbers<R>, F: &Mat3<R>) -> Mat3<R> {
        let F = *F;
        let one = F.columns[0].x.one();
        let M1 = F.cofactor(); // cof(F)
        let s1 = F.columns[0].dot(M1.columns[0]); // det(F)
        let s2 = s1 * 20.0; // 20*det(F)
        let s3 = s2 - 1.0; // 20*det(F) - 1
        let s4 = s3.mul_add(one.splat(-20.0), one.splat(20.0)); // 20 - 20*(20*det(F) - 1)
        let s5 = one / s1; // 1/det(F)
        let s6 = s1.select_less(one.splat(0.05), s4, s5);
        let s7 = p.mu * -1.0;
        let s8 = s3 * s3; // (20*det(F) - 1)^2
        let s9 = s2 - 3.995732273553991;
        let s10 = s8.mul_add(one.splat(-0.5), s9);
        let s11 = s1.ln(); // ln(det(F))
        let s12 = s1.select_less(one.splat(0.05), s10, s11);
        let s13 = p.lambda * s12;
        let s14 = s7 * s6;
        let s15 = s13.mul_add(s6, s14);
        F.scaled(p.mu) + M1.scaled(s15)
    }

    #[inline(always)]
    fn stress_differential<R: Real>(p: &Numbers<R>, point: &Point<R>, dF: &Mat3<R>) -> Mat3<R> {
        let dF = *dF;
        let s28 = dF.dot(&point.M1); // dot(dF, cof(F))
        let s29 = point.s7 * s28;
        let s30 = point.s14.mul_add(s28, s29);
        let s31 = point.s21.mul_add(s28, s30);
        let M2 = cofactor_differential(&point.F, &dF); // cross(F, dF)
        let M3 = dF.scaled(p.mu) + point.M1.scaled(s31);
        M2.scaled(point.s23) + M3
    }

    #[inline(always)]
    fn tangent_block<R: Real>(p: &Numbers<R>, point: &Point<R>, g_a: Vec3<R>, g_b: Vec3<R>) -> Mat3<R> {
        let one = g_a.x.one();
        let s32 = g_b.z * -1.0;
        let s33 = g_b.y * g_a.z;
        let s34 = s32.mul_add(g_a.y, s33);
        let s35 = g_b.x * -1.0;
        let s36 = g_b.z * g_a.x;
        let s37 = s35.mul_add(g_a.z, s36);
        let s38 = g_b.y * -1.0;
        let s39 = g_b.x * g_a.y;
        let s40 = s38.mul_add(g_a.x, s39);
        let v1 = Vec3::new(s34, s37, s40);
        let v2 = point.F * v1;
        let s41 = point.s23 * v2.z;
        let s42 = point.s24 * v2.y;
        let s43 = point.s24 * v2.z;
        let s44 = point.s23 * v2.x;
        let s45 = point.s23 * v2.y;
        let s46 = point.s24 * v2.x;
        let M5 = Mat3::from_columns(
            Vec3::new(one.splat(0.0), s41, s42),
            Vec3::new(s43, one.splat(0.0), s44),
            Vec3::new(s45, s46, one.splat(0.0)),
        );
        let v3 = point.M1 * g_a; // cof(F)*g_a
        let v4 = point.M1 * g_b; // cof(F)*g_b
        let M6 = (v3 * point.s27).outer(v4) + M5;
        let s47 = g_a.dot(g_b); // dot(g_a, g_b)
        let s48 = p.mu * s47; // mu*dot(g_a, g_b)
        M6.plus_diagonal(s48)
    }
}
