//! Neo-Hookean elasticity in its logarithmic form: the textbook law of rubber and soft tissue.
//!
//! Resists compression without bound down to a twentieth of the rest volume. Below that the logarithm goes on
//! as a parabola, so that an inverted element has a finite force that turns it back; where elements invert as
//! a matter of course, `stable_neo_hookean` gives a softer, better conditioned way home.
//!
//! For a negative Poisson ratio (`λ < 0`) the law itself gives way below the volume ratio `J = exp(μ/λ)`, 0.14 at
//! `ν = -0.5`: what is compressed further, collapses. `stable_neo_hookean` still pushes back there.

use souple_math::{Mat3, Real, Vec3};
use souple_table::Entry;

use super::invariants::{Deformation, Derivatives, Point, length_invariant};
use super::{AnyLaw, Build, ISOTROPIC, Lame, Law, Material};

/// `Ψ = μ/2 (I - 3) - μ ln J + λ/2 (ln J)²` with `I = tr(FᵀF)`, `J = det F`.
#[derive(Clone, Copy, Debug)]
pub struct NeoHookean;

pub(super) const ENTRY: Entry<Build> = Entry {
    name: "neo_hookean",
    summary: "logarithmic form, for large strain; below 5 % of the rest volume ln J goes on as its Taylor polynomial \
              of degree two: flat and inverted elements stay finite and are pushed back, stiffly (not for a \
              negative Poisson ratio); one shrunk to a line or point feels no push from its volume",
    source: "Bonet & Wood 2008, Nonlinear Continuum Mechanics for Finite Element Analysis, §6.4.3",
    parameters: ISOTROPIC,
    build: |values| Material::isotropic(AnyLaw::NeoHookean, values),
};

/// The ratio of volumes below which `ln J` is replaced by its Taylor polynomial of degree two: energy, stress
/// and tangent stay continuous. The stiffness against compression there, about `(λ (1 - ln J₀) + μ) / J₀²`,
/// bounds the condition of a system with collapsed elements.
const SMALLEST_LOGARITHMIC_VOLUME: f64 = 0.05;

/// The continued logarithm and its two derivatives.
struct Logarithm<R> {
    value: R,
    first: R,
    second: R,
}

impl<R: Real> Logarithm<R> {
    // L(J) = ln m + x - x²/2 with m = max(J, J₀), x = (J - m)/m: the logarithm itself where m = J
    #[inline(always)]
    fn at(J: R) -> Self {
        let m = J.max(J.splat(SMALLEST_LOGARITHMIC_VOLUME));
        let inverse = J.one() / m;
        let x = (J - m) * inverse;
        Self { value: m.ln() + x - x * x * 0.5, first: inverse * (-x + 1.0), second: -inverse * inverse }
    }
}

// A = μ/2 (I - 3),  B = -μ L(J) + λ/2 L(J)²
#[inline(always)]
fn point<R: Real>(p: &Lame<R>, F: &Mat3<R>) -> Point<R> {
    let deformation = Deformation::of(F);
    let L = Logarithm::at(deformation.volume);
    let slope = p.lambda * L.value - p.mu;
    deformation.with(Derivatives {
        length: p.mu * 0.5,
        length_second: p.mu.zero(),
        volume: slope * L.first,
        volume_second: p.lambda * L.first * L.first + slope * L.second,
    })
}

impl Law for NeoHookean {
    type Parameters<R: Real> = Lame<R>;
    type Point<R: Real> = Point<R>;

    #[inline(always)]
    fn at<R: Real>(p: &Lame<R>, F: &Mat3<R>) -> Point<R> {
        point(p, F)
    }

    #[inline(always)]
    fn energy_density<R: Real>(p: &Lame<R>, F: &Mat3<R>) -> R {
        let L = Logarithm::at(F.determinant()).value;
        p.mu * (length_invariant(F) - 3.0) * 0.5 + (p.lambda * L * 0.5 - p.mu) * L
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
