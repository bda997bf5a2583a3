//! St. Venant–Kirchhoff elasticity: energy quadratic in Green strain.
//!
//! Cheap, good for large rotations with moderate strain. It softens and then collapses under strong
//! compression (below a stretch of 0.58 along one axis); `neo_hookean` does not.

use souple_math::{Mat3, Real, Vec3};
use souple_table::Entry;

use super::{AnyLaw, Build, ISOTROPIC, Lame, Law, Material};

/// `Ψ = μ E:E + λ/2 tr(E)²` with `E = (FᵀF - I)/2`.
#[derive(Clone, Copy, Debug)]
pub struct StVenantKirchhoff;

pub(super) const ENTRY: Entry<Build> = Entry {
    name: "st_venant_kirchhoff",
    summary: "quadratic in Green strain: cheap, large rotations, moderate strain; weak under compression, and an \
              inverted element is as content as its mirror image: nothing drives it back",
    source: "Sifakis & Barbič 2012, FEM Simulation of 3D Deformable Solids, §3.3",
    parameters: ISOTROPIC,
    build: |values| Material::isotropic(AnyLaw::StVenantKirchhoff, values),
};

/// `F`, `S` and `F Fᵀ` at one deformation.
#[derive(Clone, Copy, Debug)]
pub struct Point<R> {
    F: Mat3<R>,
    second_piola: Mat3<R>,
    left_cauchy_green: Mat3<R>,
}

// S = 2μE + λ tr(E) I = μ C + (λ/2 (tr(C) - 3) - μ) I
#[inline(always)]
fn second_piola<R: Real>(p: &Lame<R>, F: &Mat3<R>) -> Mat3<R> {
    let C = F.gram();
    let s = (p.lambda * 0.5).mul_add(C.trace() - 3.0, -p.mu);
    let [a, b, c] = C.columns;
    let (xy, yz, zx) = (p.mu * a.y, p.mu * b.z, p.mu * a.z);
    Mat3::from_columns(
        Vec3::new(p.mu.mul_add(a.x, s), xy, zx),
        Vec3::new(xy, p.mu.mul_add(b.y, s), yz),
        Vec3::new(zx, yz, p.mu.mul_add(c.z, s)),
    )
}

impl Law for StVenantKirchhoff {
    type Parameters<R: Real> = Lame<R>;
    type Point<R: Real> = Point<R>;

    #[inline(always)]
    fn at<R: Real>(p: &Lame<R>, F: &Mat3<R>) -> Point<R> {
        Point { F: *F, second_piola: second_piola(p, F), left_cauchy_green: F.transpose().gram() }
    }

    #[inline(always)]
    fn energy_density<R: Real>(p: &Lame<R>, F: &Mat3<R>) -> R {
        let E = F.gram().plus_diagonal(F.columns[0].x.splat(-1.0)) * 0.5;
        let trace = E.trace();
        p.mu * E.dot(&E) + p.lambda * trace * trace * 0.5
    }

    // P = F S
    #[inline(always)]
    fn stress<R: Real>(p: &Lame<R>, F: &Mat3<R>) -> Mat3<R> {
        *F * second_piola(p, F)
    }

    // δP = δF S + F (2μ δE + λ tr(δE) I),  2 δE = FᵀδF + δFᵀF
    #[inline(always)]
    fn stress_differential<R: Real>(p: &Lame<R>, point: &Point<R>, dF: &Mat3<R>) -> Mat3<R> {
        let A = point.F.transpose_mul(dF);
        let dS = (A + A.transpose()).scaled(p.mu).plus_diagonal(p.lambda * A.trace());
        *dF * point.second_piola + point.F * dS
    }

    // K = (g_a·S g_b) I + μ (g_a·g_b) F Fᵀ + μ (F g_b)(F g_a)ᵀ + λ (F g_a)(F g_b)ᵀ
    #[inline(always)]
    fn tangent_block<R: Real>(p: &Lame<R>, point: &Point<R>, g_a: Vec3<R>, g_b: Vec3<R>) -> Mat3<R> {
        let (a, b) = (point.F * g_a, point.F * g_b);
        let initial_stress = g_a.dot(point.second_piola * g_b);
        let material = point.left_cauchy_green.scaled(p.mu * g_a.dot(g_b)) + (b * p.mu).outer(a);
        (material + (a * p.lambda).outer(b)).plus_diagonal(initial_stress)
    }
}
