//! Hooke's law of small strain; derived from its text by `souple derive --emit kernel`, and not changed by hand.
//!
//! ```text
//! Ψ = lambda/2*tr(eps)^2 + mu*dot(eps, eps)
//! ```

use souple_math::{Mat3, Real, Vec3};

use crate::materials::{Lame as Numbers, Law};

/// See the module.
#[derive(Clone, Copy, Debug)]
pub struct Linear;

impl Law for Linear {
    type Parameters<R: Real> = Numbers<R>;
    type Point<R: Real> = ();

    const OBJECTIVE: bool = false;
    const LINEAR: bool = true;

    #[inline(always)]
    fn at<R: Real>(_: &Numbers<R>, _: &Mat3<R>) {}

    #[inline(always)]
    fn energy_density<R: Real>(p: &Numbers<R>, F: &Mat3<R>) -> R {
        let F = *F;
        let one = F.columns[0].x.one();
        let s1 = F.trace(); // tr(F)
        let s2 = s1 - 3.0; // tr(F) - 3
        let s3 = s2 * s2; // (tr(F) - 3)^2
        let s4 = p.lambda * 0.5;
        let M1 = F.transpose(); // transpose(F)
        let M2 = F + M1; // F + transpose(F)
        let M3 = M2 * 0.5;
        let M4 = M3.plus_diagonal(one.splat(-1.0)); // 0.5*(F + transpose(F)) - I
        let s5 = M4.dot(&M4);
        let s6 = s4 * s3;
        p.mu.mul_add(s5, s6)
    }

    #[inline(always)]
    fn stress<R: Real>(p: &Numbers<R>, F: &Mat3<R>) -> Mat3<R> {
        let F = *F;
        let one = F.columns[0].x.one();
        let M1 = F.transpose(); // transpose(F)
        let M2 = (F + M1).scaled(p.mu);
        let s1 = F.trace(); // tr(F)
        let s2 = s1 - 3.0; // tr(F) - 3
        let s3 = p.lambda * s2;
        let s4 = p.mu.mul_add(one.splat(-2.0), s3); // lambda*(tr(F) - 3) - 2*mu
        M2.plus_diagonal(s4)
    }

    #[inline(always)]
    fn stress_differential<R: Real>(p: &Numbers<R>, _: &(), dF: &Mat3<R>) -> Mat3<R> {
        let dF = *dF;
        let M1 = dF.transpose(); // transpose(dF)
        let M2 = dF + M1; // dF + transpose(dF)
        let M3 = M2.scaled(p.mu);
        let s1 = dF.trace(); // tr(dF)
        let s2 = p.lambda * s1; // lambda*tr(dF)
        M3.plus_diagonal(s2)
    }

    #[inline(always)]
    fn tangent_block<R: Real>(p: &Numbers<R>, _: &(), g_a: Vec3<R>, g_b: Vec3<R>) -> Mat3<R> {
        let M5 = (g_a * p.lambda).outer(g_b) + (g_b * p.mu).outer(g_a);
        let s3 = g_a.dot(g_b); // dot(g_a, g_b)
        let s4 = p.mu * s3; // mu*dot(g_a, g_b)
        M5.plus_diagonal(s4)
    }
}
