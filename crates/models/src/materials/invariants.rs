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

/// One deformation: its gradient, its cofactor matrix `∂J/∂F` and the energy's derivatives there.
#[derive(Clone, Copy, Debug)]
pub struct Point<R> {
    F: Mat3<R>,
    cofactor: Mat3<R>,
    derivatives: Derivatives<R>,
}

/// `I = tr(FᵀF)`.
#[inline(always)]
pub(super) fn length_invariant<R: Real>(F: &Mat3<R>) -> R {
    F.dot(F)
}

impl<R: Real> Point<R> {
    #[inline(always)]
    pub(super) fn new(F: &Mat3<R>, derivatives: impl FnOnce(R, R) -> Derivatives<R>) -> Self {
        let cofactor = F.cofactor();
        let J = F.columns[0].dot(cofactor.columns[0]);
        Self { F: *F, cofactor, derivatives: derivatives(length_invariant(F), J) }
    }

    // P = 2 A' F + B' cof F
    #[inline(always)]
    pub(super) fn stress(&self) -> Mat3<R> {
        let d = &self.derivatives;
        self.F.scaled(d.length * 2.0) + self.cofactor.scaled(d.volume)
    }

    // δP = 2 A' δF + 4 A'' (F : δF) F + B'' (cof F : δF) cof F + B' δ(cof F)
    #[inline(always)]
    pub(super) fn stress_differential(&self, dF: &Mat3<R>) -> Mat3<R> {
        let d = &self.derivatives;
        dF.scaled(d.length * 2.0)
            + self.F.scaled(d.length_second * self.F.dot(dF) * 4.0)
            + self.cofactor.scaled(d.volume_second * self.cofactor.dot(dF))
            + cofactor_differential(&self.F, dF).scaled(d.volume)
    }

    // K = 2 A' (g_a·g_b) I + 4 A'' (F g_a)(F g_b)ᵀ + B'' (cof F g_a)(cof F g_b)ᵀ + B' [F (g_b × g_a)]×
    // the last from w·K u = D²J(u ⊗ g_b, w ⊗ g_a) = (u × w)·F (g_b × g_a)
    #[inline(always)]
    pub(super) fn tangent_block(&self, g_a: Vec3<R>, g_b: Vec3<R>) -> Mat3<R> {
        let d = &self.derivatives;
        let (F, cofactor) = (self.F, self.cofactor);
        let length = (F * g_a * (d.length_second * 4.0)).outer(F * g_b);
        let volume = (cofactor * g_a * d.volume_second).outer(cofactor * g_b);
        let turning = (F * g_b.cross(g_a) * d.volume).cross_matrix();
        (length + volume + turning).plus_diagonal(d.length * g_a.dot(g_b) * 2.0)
    }
}

/// `δ(cof F)` for columns `cof F = (b × c, c × a, a × b)`.
#[inline(always)]
fn cofactor_differential<R: Real>(F: &Mat3<R>, dF: &Mat3<R>) -> Mat3<R> {
    let ([a, b, c], [da, db, dc]) = (F.columns, dF.columns);
    Mat3::from_columns(db.cross(c) + b.cross(dc), dc.cross(a) + c.cross(da), da.cross(b) + a.cross(db))
}
