//! Linear elasticity of small strain.
//!
//! The reference of analytic solutions, and the cheapest law: its stiffness is constant. A rotation counts as
//! strain (by `1 - cos` of the angle), so bodies that turn grow; `corotational` does not.

use souple_math::{Mat3, Real, Vec3};
use souple_table::Entry;

use super::{AnyLaw, Build, ISOTROPIC, Lame, Law, Material};

/// `Ψ = μ ε:ε + λ/2 tr(ε)²` with `ε = (F + Fᵀ)/2 - I`.
#[derive(Clone, Copy, Debug)]
pub struct Linear;

pub(super) const ENTRY: Entry<Build> = Entry {
    name: "linear",
    summary: "small strain: constant stiffness, exact only for small rotations; an inverted element is driven back \
              by a force linear in its displacement",
    source: "Love 1892, A Treatise on the Mathematical Theory of Elasticity",
    parameters: ISOTROPIC,
    build: |values| Material::isotropic(AnyLaw::Linear, values),
};

// σ(A) = μ (A + Aᵀ) + λ tr(A) I
#[inline(always)]
fn hooke<R: Real>(p: &Lame<R>, A: &Mat3<R>) -> Mat3<R> {
    (*A + A.transpose()).scaled(p.mu).plus_diagonal(p.lambda * A.trace())
}

/// `F - I`.
#[inline(always)]
fn displacement_gradient<R: Real>(F: &Mat3<R>) -> Mat3<R> {
    F.plus_diagonal(F.columns[0].x.splat(-1.0))
}

impl Law for Linear {
    type Parameters<R: Real> = Lame<R>;
    type Point<R: Real> = ();

    const OBJECTIVE: bool = false;
    const LINEAR: bool = true;

    #[inline(always)]
    fn at<R: Real>(_: &Lame<R>, _: &Mat3<R>) {}

    #[inline(always)]
    fn energy_density<R: Real>(p: &Lame<R>, F: &Mat3<R>) -> R {
        let strain = displacement_gradient(F).symmetric_part();
        let trace = strain.trace();
        p.mu * strain.dot(&strain) + p.lambda * trace * trace * 0.5
    }

    #[inline(always)]
    fn stress<R: Real>(p: &Lame<R>, F: &Mat3<R>) -> Mat3<R> {
        hooke(p, &displacement_gradient(F))
    }

    #[inline(always)]
    fn stress_differential<R: Real>(p: &Lame<R>, _: &(), dF: &Mat3<R>) -> Mat3<R> {
        hooke(p, dF)
    }

    // K = μ (g_a·g_b) I + μ g_b g_aᵀ + λ g_a g_bᵀ
    #[inline(always)]
    fn tangent_block<R: Real>(p: &Lame<R>, _: &(), g_a: Vec3<R>, g_b: Vec3<R>) -> Mat3<R> {
        let rest = (g_b * p.mu).outer(g_a) + (g_a * p.lambda).outer(g_b);
        rest.plus_diagonal(p.mu * g_a.dot(g_b))
    }
}
