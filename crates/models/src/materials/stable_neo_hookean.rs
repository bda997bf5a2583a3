//! Stable neo-Hookean elasticity: a polynomial in the volume instead of a logarithm.
//!
//! Made for animation and contact: smooth and finite for every deformation, and an element that was flattened
//! or turned inside out finds back. Under strong compression it is softer than `neo_hookean`, whose energy
//! grows without bound.

use souple_math::{Mat3, Real, Vec3};
use souple_table::Entry;

use super::invariants::{Deformation, Derivatives, Point, length_invariant};
use super::{AnyLaw, Build, ISOTROPIC, Lame, Law, Material};

/// `Ψ = μ/2 (I - 3) + λ/2 (J - α)² - μ/2 ln(I + 1) + constant`, zero at rest, with `I = tr(FᵀF)`, `J = det F`,
/// `α = 1 + 3μ/4λ` and the paper's `μ = 4/3 μ_Lamé`, `λ = λ_Lamé + 5/6 μ_Lamé` that make small strain agree.
#[derive(Clone, Copy, Debug)]
pub struct StableNeoHookean;

pub(super) const ENTRY: Entry<Build> = Entry {
    name: "stable_neo_hookean",
    summary: "for large strain, contact and animation: smooth for every deformation; a flat or inverted element is \
              pushed back with bounded stiffness, one shrunk to a line or point balances there, unstably",
    source: "Smith, de Goes & Kim 2018, Stable Neo-Hookean Flesh Simulation, eq. 14 and §3.4",
    parameters: ISOTROPIC,
    build: |values| Material::isotropic(AnyLaw::StableNeoHookean, values),
};

/// The paper's `(μ, λ)` from Lamé's.
#[inline(always)]
fn reparametrised<R: Real>(p: &Lame<R>) -> (R, R) {
    (p.mu * (4.0 / 3.0), p.mu * (5.0 / 6.0) + p.lambda)
}

// A = μ/2 (I - 3) - μ/2 ln(I + 1),  B = λ/2 (J - α)²,  λ (J - α) = λ (J - 1) - 3/4 μ
#[inline(always)]
fn point<R: Real>(p: &Lame<R>, F: &Mat3<R>) -> Point<R> {
    let (mu, lambda) = reparametrised(p);
    let deformation = Deformation::of(F);
    let inverse = mu.one() / (deformation.length + 1.0);
    let half_mu = mu * 0.5;
    deformation.with(Derivatives {
        length: half_mu - half_mu * inverse,
        length_second: half_mu * inverse * inverse,
        volume: lambda * (deformation.volume - 1.0) - mu * 0.75,
        volume_second: lambda,
    })
}

impl Law for StableNeoHookean {
    type Parameters<R: Real> = Lame<R>;
    type Point<R: Real> = Point<R>;

    #[inline(always)]
    fn at<R: Real>(p: &Lame<R>, F: &Mat3<R>) -> Point<R> {
        point(p, F)
    }

    // λ/2 (J - α)² - λ/2 (1 - α)² = (λ/2 (J - 1) - 3/4 μ)(J - 1)
    #[inline(always)]
    fn energy_density<R: Real>(p: &Lame<R>, F: &Mat3<R>) -> R {
        let (mu, lambda) = reparametrised(p);
        let (I, dJ) = (length_invariant(F), F.determinant() - 1.0);
        let length = (I - 3.0) - ((I + 1.0) * 0.25).ln();
        mu * length * 0.5 + (lambda * dJ * 0.5 - mu * 0.75) * dJ
    }

    #[inline(always)]
    fn stress<R: Real>(p: &Lame<R>, F: &Mat3<R>) -> Mat3<R> {
        point(p, F).stress()
    }

    #[inline(always)]
    fn stress_differential<R: Real>(_: &Lame<R>, point: &Point<R>, dF: &Mat3<R>) -> Mat3<R> {
        point.stress_differential(dF)
    }

    #[inline(always)]
    fn tangent_block<R: Real>(_: &Lame<R>, point: &Point<R>, g_a: Vec3<R>, g_b: Vec3<R>) -> Mat3<R> {
        point.tangent_block(g_a, g_b)
    }
}
