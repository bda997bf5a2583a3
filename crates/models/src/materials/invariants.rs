//! What laws of invariants share.

use souple_math::{Mat3, Real};

/// `δ(cof F)` for columns `cof F = (b × c, c × a, a × b)`.
#[inline(always)]
pub(crate) fn cofactor_differential<R: Real>(F: &Mat3<R>, dF: &Mat3<R>) -> Mat3<R> {
    let ([a, b, c], [da, db, dc]) = (F.columns, dF.columns);
    Mat3::from_columns(db.cross(c) + b.cross(dc), dc.cross(a) + c.cross(da), da.cross(b) + a.cross(db))
}
