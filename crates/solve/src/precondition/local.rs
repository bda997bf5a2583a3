//! Small symmetric eigenproblems: which directions a block cannot move in, which motions a patch cannot tell
//! apart.

use souple_math::{Mat3, Vec3};

use crate::{BlockMatrix, dense};

/// Squared couplings below this fraction of the largest are taken for none: they are known to `ε` of the largest.
const COUPLING: f64 = 1e-14;
/// Squared lengths of motions below this fraction of the largest are taken for coincidence.
const COINCIDENCE: f64 = 1e-10;

/// Projector onto the directions of block `row` that are coupled to others; `None` where all are.
///
/// A constrained direction `d` has `A_rc d = 0` for every other block, which is what
/// [`BlockMatrix::constrain`] leaves.
pub(super) fn constrained_directions(matrix: &BlockMatrix, row: usize) -> Option<Mat3> {
    let pattern = matrix.pattern();
    let mut coupling = Mat3::ZERO;
    for slot in pattern.slots(row) {
        if pattern.columns()[slot] as usize != row {
            // Σ A_rc A_rcᵀ
            let A = &matrix.values()[slot];
            coupling += A.mul_transpose(A);
        }
    }
    let trace = coupling.trace();
    // most blocks are free: then the determinant of the scaled matrix is far from zero
    if trace > 0.0 && (coupling * (1.0 / trace)).determinant() > 1e-12 {
        return None;
    }
    let entries: [[f64; 3]; 3] = std::array::from_fn(|i| coupling.row(i).to_array());
    let (values, vectors) = eigen(entries);
    let free = |value: &f64| trace > 0.0 && *value > COUPLING * trace;
    if values.iter().all(free) {
        return None;
    }
    let kept = values.iter().zip(vectors).filter(|(value, _)| free(value));
    Some(kept.fold(Mat3::ZERO, |projector, (_, v)| {
        let v = Vec3::from_array(v);
        projector + v.outer(v)
    }))
}

/// Projector onto the range of a Gram matrix, or `None` where it has full rank.
pub(super) fn range_projector(gram: &[[f64; 6]; 6]) -> Option<[[f64; 6]; 6]> {
    let (values, vectors) = eigen(*gram);
    let largest = values.iter().fold(0.0_f64, |largest, value| largest.max(*value));
    let kept = |value: f64| largest > 0.0 && value > COINCIDENCE * largest;
    if values.iter().all(|&value| kept(value)) {
        return None;
    }
    let mut projector = [[0.0; 6]; 6];
    for (value, v) in values.iter().zip(vectors) {
        if kept(*value) {
            for (i, j) in (0..36).map(|k| (k / 6, k % 6)) {
                projector[i][j] += v[i] * v[j];
            }
        }
    }
    Some(projector)
}

/// Eigenvalues and eigenvectors (one per row) of a symmetric matrix.
fn eigen<const N: usize>(mut a: [[f64; N]; N]) -> ([f64; N], [[f64; N]; N]) {
    let mut vectors = [[0.0; N]; N];
    dense::eigen(N, a.as_flattened_mut(), vectors.as_flattened_mut());
    (std::array::from_fn(|i| a[i][i]), vectors)
}
