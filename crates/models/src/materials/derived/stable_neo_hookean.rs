//! smooth for every deformation, inverted ones too; derived from its text by `souple derive --emit kernel`, and not changed by hand.
//!
//! ```text
//! Ψ = m/2*(I1 - 3 - log((I1 + 1)/4)) + l/2*(J - 1)^2 - 3/4*m*(J - 1)
//! m = 4/3*mu
//! l = lambda + 5/6*mu
//! ```

use souple_math::{Mat3, Real, Vec3};

use crate::materials::invariants::cofactor_differential;
use crate::materials::{Lame as Numbers, Law};

/// See the module.
#[derive(Clone, Copy, Debug)]
pub struct StableNeoHookean;

/// What differentials at one `F` share.
#[derive(Clone, Copy, Debug)]
pub struct Point<R> {
    F: Mat3<R>,
    s1: R,
    M1: Mat3<R>,
    s5: R,
    s11: R,
    s15: R,
    s16: R,
}

impl Law for StableNeoHookean {
    type Parameters<R: Real> = Numbers<R>;
    type Point<R: Real> = Point<R>;

    #[inline(always)]
    fn at<R: Real>(p: &Numbers<R>, F: &Mat3<R>) -> Point<R> {
        let F = *F;
        let one = F.columns[0].x.one();
        let s1 = p.mu.mul_add(one.splat(0.8333333333333333), p.lambda); // lambda + 0.8333333333333333*mu
        let M1 = F.cofactor(); // cof(F)
        let s2 = F.columns[0].dot(M1.columns[0]); // det(F)
        let s3 = s2 - 1.0; // det(F) - 1
        let s4 = s1 * s3;
        let s5 = p.mu.mul_add(one.splat(-1.0), s4);
        let s6 = F.dot(&F); // dot(F, F)
        let s7 = s6 + 1.0; // 1 + dot(F, F)
        let s8 = s7 * s7;
        let s9 = one / s8; // 1/(1 + dot(F, F))^2
        let s10 = p.mu * 2.6666666666666665;
        let s11 = s10 * s9; // 8/3*mu/(1 + dot(F, F))^2
        let s12 = one.splat(-1.0) / s7;
        let s13 = s12 + 1.0; // 1 - 1/(1 + dot(F, F))
        let s14 = p.mu * 1.3333333333333333;
        let s15 = s14 * s13; // 4/3*mu*(1 - 1/(1 + dot(F, F)))
        let s16 = s5 * -1.0;
        Point { F, s1, M1, s5, s11, s15, s16 }
    }

    #[inline(always)]
    fn energy_density<R: Real>(p: &Numbers<R>, F: &Mat3<R>) -> R {
        let F = *F;
        let one = F.columns[0].x.one();
        let s1 = F.dot(&F); // dot(F, F)
        let s2 = s1 + 1.0; // 1 + dot(F, F)
        let s3 = s2 * 0.25; // 0.25*(1 + dot(F, F))
        let s4 = s3.ln(); // ln(0.25*(1 + dot(F, F)))
        let s5 = s1 - 3.0;
        let s6 = s4.mul_add(one.splat(-1.0), s5);
        let s7 = p.mu * 0.6666666666666666;
        let s8 = p.mu.mul_add(one.splat(0.8333333333333333), p.lambda); // lambda + 0.8333333333333333*mu
        let s9 = F.determinant(); // det(F)
        let s10 = s9 - 1.0; // det(F) - 1
        let s11 = s10 * s10; // (det(F) - 1)^2
        let s12 = s8 * 0.5;
        let s13 = p.mu * -1.0;
        let s14 = s7 * s6;
        let s15 = s12.mul_add(s11, s14);
        s13.mul_add(s10, s15)
    }

    #[inline(always)]
    fn stress<R: Real>(p: &Numbers<R>, F: &Mat3<R>) -> Mat3<R> {
        let F = *F;
        let one = F.columns[0].x.one();
        let s1 = p.mu.mul_add(one.splat(0.8333333333333333), p.lambda); // lambda + 0.8333333333333333*mu
        let M1 = F.cofactor(); // cof(F)
        let s2 = F.columns[0].dot(M1.columns[0]); // det(F)
        let s3 = s2 - 1.0; // det(F) - 1
        let s4 = s1 * s3;
        let s5 = p.mu.mul_add(one.splat(-1.0), s4);
        let s6 = F.dot(&F); // dot(F, F)
        let s7 = s6 + 1.0; // 1 + dot(F, F)
        let s8 = one.splat(-1.0) / s7;
        let s9 = s8 + 1.0; // 1 - 1/(1 + dot(F, F))
        let s10 = p.mu * 1.3333333333333333;
        let s11 = s10 * s9; // 4/3*mu*(1 - 1/(1 + dot(F, F)))
        M1.scaled(s5) + F.scaled(s11)
    }

    #[inline(always)]
    fn stress_differential<R: Real>(_: &Numbers<R>, point: &Point<R>, dF: &Mat3<R>) -> Mat3<R> {
        let dF = *dF;
        let s17 = dF.dot(&point.M1); // dot(dF, cof(F))
        let s18 = point.s1 * s17;
        let M2 = cofactor_differential(&point.F, &dF); // cross(F, dF)
        let s19 = point.F.dot(&dF); // dot(F, dF)
        let s20 = point.s11 * s19; // 8/3*mu*dot(F, dF)/(1 + dot(F, F))^2
        let M3 = point.M1.scaled(s18) + M2.scaled(point.s5);
        let M4 = point.F.scaled(s20) + M3;
        dF.scaled(point.s15) + M4
    }

    #[inline(always)]
    fn tangent_block<R: Real>(_: &Numbers<R>, point: &Point<R>, g_a: Vec3<R>, g_b: Vec3<R>) -> Mat3<R> {
        let one = g_a.x.one();
        let s21 = g_b.z * -1.0;
        let s22 = g_b.y * g_a.z;
        let s23 = s21.mul_add(g_a.y, s22);
        let s24 = g_b.x * -1.0;
        let s25 = g_b.z * g_a.x;
        let s26 = s24.mul_add(g_a.z, s25);
        let s27 = g_b.y * -1.0;
        let s28 = g_b.x * g_a.y;
        let s29 = s27.mul_add(g_a.x, s28);
        let v1 = Vec3::new(s23, s26, s29);
        let v2 = point.F * v1;
        let s30 = point.s5 * v2.z;
        let s31 = point.s16 * v2.y;
        let s32 = point.s16 * v2.z;
        let s33 = point.s5 * v2.x;
        let s34 = point.s5 * v2.y;
        let s35 = point.s16 * v2.x;
        let M6 = Mat3::from_columns(
            Vec3::new(one.splat(0.0), s30, s31),
            Vec3::new(s32, one.splat(0.0), s33),
            Vec3::new(s34, s35, one.splat(0.0)),
        );
        let v3 = point.M1 * g_a; // cof(F)*g_a
        let v4 = point.M1 * g_b; // cof(F)*g_b
        let v5 = point.F * g_a; // F*g_a
        let v6 = point.F * g_b; // F*g_b
        let M7 = (v3 * point.s1).outer(v4) + M6;
        let M8 = (v5 * point.s11).outer(v6) + M7;
        let s36 = g_a.dot(g_b); // dot(g_a, g_b)
        let s37 = point.s15 * s36;
        M8.plus_diagonal(s37)
    }
}
