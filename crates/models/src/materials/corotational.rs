//! Corotational elasticity: small strain, measured in axes that turn with the material.
//!
//! For bodies that turn far and strain little: the stress is linear in the stretch, the rotation exact. Its
//! energy needs a polar decomposition; at moderate strain `st_venant_kirchhoff` is cheaper and stiffens, under
//! strong compression `neo_hookean` resists and this law does not.

use souple_math::{Mat3, Real, Vec3, polar, turn_of_stretch};
use souple_table::Entry;

use super::{AnyLaw, Build, ISOTROPIC, Lame, Law, Material};

/// `Ψ = μ |F - R|² + λ/2 tr(RᵀF - I)²` with `F = R S` the polar decomposition.
#[derive(Clone, Copy, Debug)]
pub struct Corotational;

pub(super) const ENTRY: Entry<Build> = Entry {
    name: "corotational",
    summary: "linear stress in axes that turn with the material: large rotations, small strain; a flat or inverted \
              element is pushed back along its shortest axis, where two are equally short along either",
    source: "Sifakis & Barbič 2012, FEM Simulation of 3D Deformable Solids, §3.4",
    parameters: ISOTROPIC,
    build: |values| Material::isotropic(AnyLaw::Corotational, values),
};

/// The least `(s₁ + s₂)(s₂ + s₃)(s₃ + s₁)` of the singular values for which the tangent is exact; it is 8 at
/// rest. Where it vanishes the rotation jumps and the exact tangent has no bound. Below, energy and stress stay
/// exact, and the tangent of an element whose longest stretch is one keeps to a thousand times its size at rest.
const LEAST_TURNING_DETERMINANT: f64 = 1e-3;

/// The rotation and how its differential enters the stress.
#[derive(Clone, Copy, Debug)]
pub struct Point<R> {
    rotation: Mat3<R>,
    /// `T = (λ tr(S - I) - 2μ)(tr(V) I - V)⁻¹` with the left stretch `V = F Rᵀ` [Pa], symmetric:
    /// `(λ tr(S - I) - 2μ) δR = [T t]× R` where `t` is twice the axial vector of `δF Rᵀ`.
    turning: Mat3<R>,
}

/// `tr(RᵀF - I)`.
#[inline(always)]
fn dilation<R: Real>(rotation: &Mat3<R>, F: &Mat3<R>) -> R {
    rotation.dot(F) - 3.0
}

impl Law for Corotational {
    type Parameters<R: Real> = Lame<R>;
    type Point<R: Real> = Point<R>;

    #[inline(always)]
    fn at<R: Real>(p: &Lame<R>, F: &Mat3<R>) -> Point<R> {
        let rotation = polar(F).rotation;
        let left_stretch = F.mul_transpose(&rotation).symmetric_part();
        let inverse = turn_of_stretch(&left_stretch, p.mu.splat(LEAST_TURNING_DETERMINANT));
        let turning = inverse.scaled(p.lambda * dilation(&rotation, F) - p.mu * 2.0);
        Point { rotation, turning }
    }

    #[inline(always)]
    fn energy_density<R: Real>(p: &Lame<R>, F: &Mat3<R>) -> R {
        let rotation = polar(F).rotation;
        let (strain, trace) = (*F - rotation, dilation(&rotation, F));
        p.mu * strain.dot(&strain) + p.lambda * trace * trace * 0.5
    }

    // P = 2μ (F - R) + λ tr(RᵀF - I) R; R does not vary in Ψ, for which it is stationary
    #[inline(always)]
    fn stress<R: Real>(p: &Lame<R>, F: &Mat3<R>) -> Mat3<R> {
        let rotation = polar(F).rotation;
        (*F - rotation).scaled(p.mu * 2.0) + rotation.scaled(p.lambda * dilation(&rotation, F))
    }

    // δP = 2μ δF + λ (R : δF) R + (λ tr(RᵀF - I) - 2μ) δR
    #[inline(always)]
    fn stress_differential<R: Real>(p: &Lame<R>, point: &Point<R>, dF: &Mat3<R>) -> Mat3<R> {
        let ([a, b, c], [da, db, dc]) = (point.rotation.columns, dF.columns);
        // twice the axial vector of δF Rᵀ = Σ δFₖ ⊗ rₖ is Σ rₖ × δFₖ
        let turn = point.turning * (a.cross(da) + b.cross(db) + c.cross(dc));
        let turned = Mat3::from_columns(turn.cross(a), turn.cross(b), turn.cross(c));
        dF.scaled(p.mu * 2.0) + point.rotation.scaled(p.lambda * point.rotation.dot(dF)) + turned
    }

    // K = 2μ (g_a·g_b) I + λ a bᵀ - [a]× T [b]×,  a = R g_a, b = R g_b
    #[inline(always)]
    fn tangent_block<R: Real>(p: &Lame<R>, point: &Point<R>, g_a: Vec3<R>, g_b: Vec3<R>) -> Mat3<R> {
        let (a, b) = (point.rotation * g_a, point.rotation * g_b);
        // explicit columns: a closure over lanes would not be compiled for the processor's instructions
        let [t, u, v] = point.turning.columns;
        // rows of -[a]× T, then of -[a]× T [b]×: a row x becomes x × b
        let [x, y, z] = Mat3::from_columns(t.cross(a), u.cross(a), v.cross(a)).transpose().columns;
        let turned = Mat3::from_columns(x.cross(b), y.cross(b), z.cross(b)).transpose();
        ((a * p.lambda).outer(b) + turned).plus_diagonal(p.mu * g_a.dot(g_b) * 2.0)
    }
}
