//! quadratic in Green strain; derived from its text by `souple derive --emit kernel`, and not changed by hand.
//!
//! ```text
//! Ψ = lambda/2*tr(E)^2 + mu*dot(E, E)
//! ```

use souple_math::{Mat3, Real, Vec3};

use crate::materials::{Lame as Numbers, Law};

/// See the module.
#[derive(Clone, Copy, Debug)]
pub struct StVenantKirchhoff;

/// What differentials at one `F` share.
#[derive(Clone, Copy, Debug)]
pub struct Point<R> {
    F: Mat3<R>,
    M3: Mat3<R>,
    M4: Mat3<R>,
}

impl Law for StVenantKirchhoff {
    type Parameters<R: Real> = Numbers<R>;
    type Point<R: Real> = Point<R>;

    #[inline(always)]
    fn at<R: Real>(p: &Numbers<R>, F: &Mat3<R>) -> Point<R> {
        let F = *F;
        let one = F.columns[0].x.one();
        let M1 = F.gram(); // transpose(F)*F
        let M2 = M1.scaled(p.mu);
        let s1 = M1.trace(); // dot(F, F)
        let s2 = s1.mul_add(one.splat(0.5), one.splat(-1.5)); // 0.5*dot(F, F) - 1.5
        let s3 = p.lambda * s2;
        let s4 = p.mu.mul_add(one.splat(-1.0), s3); // lambda*(0.5*dot(F, F) - 1.5) - mu
        let M3 = M2.plus_diagonal(s4);
        let M4 = F.mul_transpose(&F); // F*transpose(F)
        Point { F, M3, M4 }
    }

    #[inline(always)]
    fn energy_density<R: Real>(p: &Numbers<R>, F: &Mat3<R>) -> R {
        let F = *F;
        let one = F.columns[0].x.one();
        let M1 = F.gram(); // transpose(F)*F
        let s1 = M1.trace(); // dot(F, F)
        let s2 = s1.mul_add(one.splat(0.5), one.splat(-1.5)); // 0.5*dot(F, F) - 1.5
        let s3 = s2 * s2; // (0.5*dot(F, F) - 1.5)^2
        let s4 = p.lambda * 0.5;
        let M2 = M1 * 0.5;
        let M3 = M2.plus_diagonal(one.splat(-0.5)); // 0.5*transpose(F)*F - 0.5*I
        let s5 = M3.dot(&M3);
        let s6 = s4 * s3;
        p.mu.mul_add(s5, s6)
    }

    #[inline(always)]
    fn stress<R: Real>(p: &Numbers<R>, F: &Mat3<R>) -> Mat3<R> {
        let F = *F;
        let one = F.columns[0].x.one();
        let M1 = F.gram(); // transpose(F)*F
        let M2 = M1.scaled(p.mu);
        let s1 = M1.trace(); // dot(F, F)
        let s2 = s1.mul_add(one.splat(0.5), one.splat(-1.5)); // 0.5*dot(F, F) - 1.5
        let s3 = p.lambda * s2;
        let s4 = p.mu.mul_add(one.splat(-1.0), s3); // lambda*(0.5*dot(F, F) - 1.5) - mu
        let M3 = M2.plus_diagonal(s4);
        F * M3
    }

    #[inline(always)]
    fn stress_differential<R: Real>(p: &Numbers<R>, point: &Point<R>, dF: &Mat3<R>) -> Mat3<R> {
        let dF = *dF;
        let M5 = dF.transpose_mul(&point.F); // transpose(dF)*F
        let M6 = M5.transpose(); // transpose(F)*dF
        let M7 = (M5 + M6).scaled(p.mu);
        let s5 = M5.trace(); // dot(F, dF)
        let s6 = p.lambda * s5; // lambda*dot(F, dF)
        let M8 = M7.plus_diagonal(s6);
        let M9 = point.F * M8;
        let M10 = dF * point.M3;
        M9 + M10
    }

    #[inline(always)]
    fn tangent_block<R: Real>(p: &Numbers<R>, point: &Point<R>, g_a: Vec3<R>, g_b: Vec3<R>) -> Mat3<R> {
        let v1 = point.F * g_a; // F*g_a
        let v2 = point.F * g_b; // F*g_b
        let s7 = g_a.dot(g_b); // dot(g_a, g_b)
        let s8 = p.mu * s7; // mu*dot(g_a, g_b)
        let M12 = (v1 * p.lambda).outer(v2) + (v2 * p.mu).outer(v1);
        let M13 = point.M4.scaled(s8) + M12;
        let v3 = point.M3 * g_a;
        let s9 = g_b.dot(v3);
        M13.plus_diagonal(s9)
    }
}
