//! Laws that see the deformation through `I = tr(FᵀF)` and `J = det F` only, each by a term of its own:
//! `Ψ = A(I) + B(J)`. They differ in four derivatives; stress and tangent are written here once.

use souple_math::{Mat3, Real, Vec3};

/// First and second derivatives of `A` and `B` [Pa].
#[derive(Clone, Copy, Debug)]
pub(super) struct Derivatives<R> {
    /// `A'(I)`.
    pub length: R,
    /// `A''(I)`.
    pub length_second: R,
    /// `B'(J)`.
    pub volume: R,
    /// `B''(J)`.
    pub volume_second: R,
}

/// One deformation and its invariants.
#[derive(Clone, Copy, Debug)]
pub(super) struct Deformation<R> {
    F: Mat3<R>,
    /// `cof F = ∂J/∂F`.
    cofactor: Mat3<R>,
    /// `I = tr(FᵀF)`.
    pub length: R,
    /// `J = det F`.
    pub volume: R,
}

/// One deformation and the energy's derivatives there.
#[derive(Clone, Copy, Debug)]
pub struct Point<R> {
    deformation: Deformation<R>,
    derivatives: Derivatives<R>,
}

/// `I = tr(FᵀF)`.
#[inline(always)]
pub(super) fn length_invariant<R: Real>(F: &Mat3<R>) -> R {
    F.dot(F)
}

impl<R: Real> Deformation<R> {
    #[inline(always)]
    pub(super) fn of(F: &Mat3<R>) -> Self {
        let cofactor = F.cofactor();
        let volume = F.columns[0].dot(cofactor.columns[0]);
        Self { F: *F, cofactor, length: length_invariant(F), volume }
    }

    #[inline(always)]
    pub(super) fn with(self, derivatives: Derivatives<R>) -> Point<R> {
        Point { deformation: self, derivatives }
    }
}

impl<R: Real> Point<R> {
    // P = 2 A' F + B' cof F
    #[inline(always)]
    pub(super) fn stress(&self) -> Mat3<R> {
        let (Deformation { F, cofactor, .. }, d) = (&self.deformation, &self.derivatives);
        F.scaled(d.length * 2.0) + cofactor.scaled(d.volume)
    }

    // δP = 2 A' δF + 4 A'' (F : δF) F + B'' (cof F : δF) cof F + B' δ(cof F)
    #[inline(always)]
    pub(super) fn stress_differential(&self, dF: &Mat3<R>) -> Mat3<R> {
        let (Deformation { F, cofactor, .. }, d) = (&self.deformation, &self.derivatives);
        dF.scaled(d.length * 2.0)
            + F.scaled(d.length_second * F.dot(dF) * 4.0)
            + cofactor.scaled(d.volume_second * cofactor.dot(dF))
            + cofactor_differential(F, dF).scaled(d.volume)
    }

    // K = 2 A' (g_a·g_b) I + 4 A'' (F g_a)(F g_b)ᵀ + B'' (cof F g_a)(cof F g_b)ᵀ + B' [F (g_b × g_a)]×
    // the last from w·K u = D²J(u ⊗ g_b, w ⊗ g_a) = (u × w)·F (g_b × g_a)
    #[inline(always)]
    pub(super) fn tangent_block(&self, g_a: Vec3<R>, g_b: Vec3<R>) -> Mat3<R> {
        let (Deformation { F, cofactor, .. }, d) = (self.deformation, &self.derivatives);
        let length = (F * g_a * (d.length_second * 4.0)).outer(F * g_b);
        let volume = (cofactor * g_a * d.volume_second).outer(cofactor * g_b);
        let turning = (F * g_b.cross(g_a) * d.volume).cross_matrix();
        (length + volume + turning).plus_diagonal(d.length * g_a.dot(g_b) * 2.0)
    }
}

/// `δ(cof F)` for columns `cof F = (b × c, c × a, a × b)`.
#[inline(always)]
pub(super) fn cofactor_differential<R: Real>(F: &Mat3<R>, dF: &Mat3<R>) -> Mat3<R> {
    let ([a, b, c], [da, db, dc]) = (F.columns, dF.columns);
    Mat3::from_columns(db.cross(c) + b.cross(dc), dc.cross(a) + c.cross(da), da.cross(b) + a.cross(db))
}
