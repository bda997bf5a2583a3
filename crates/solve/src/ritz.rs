//! Eigenpairs of `K φ = ω² M φ` within a space that is given: Rayleigh's quotient is stationary there (Ritz 1909).
//!
//! The lowest are upper bounds of those of the whole (Courant and Fischer), and quadratically near where the space is near the eigenvectors.

use souple_math::{Mat3, Vec3};

use crate::error::check_length;
use crate::mass_basis::{MassBasis, combination};
use crate::modes::with_positive_peak;
use crate::{BlockMatrix, LinearOperator, SolveError, dense, reduce};

/// Eigenpairs within a space, the lowest first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RitzPairs {
    /// `ω²` [1/s²].
    pub eigenvalues: Vec<f64>,
    /// `φ_i · M φ_j = δ_ij`; the largest component is positive.
    pub shapes: Vec<Vec<Vec3>>,
}

impl RitzPairs {
    pub fn append(&mut self, other: Self) {
        self.eigenvalues.extend(other.eigenvalues);
        self.shapes.extend(other.shapes);
    }

    pub fn truncate(&mut self, count: usize) {
        self.eigenvalues.truncate(count);
        self.shapes.truncate(count);
    }
}

/// Pairs of the span of `fields`, less what of it is not orthogonal to the fields `apart_from` in the norm of `M`. Of fields that depend on each
/// other, the span counts.
///
/// # Errors
/// A field that does not fit the matrices.
pub fn pairs_within(
    stiffness: &BlockMatrix,
    mass: &BlockMatrix,
    fields: &[Vec<Vec3>],
    apart_from: &[Vec<Vec3>],
) -> Result<RitzPairs, SolveError> {
    let count = stiffness.block_count();
    for field in fields.iter().chain(apart_from) {
        check_length("a field", field.len(), count)?;
    }
    let mut basis = MassBasis::new(mass);
    apart_from.iter().for_each(|field| {
        basis.add(field.clone());
    });
    let apart = basis.len();
    fields.iter().for_each(|field| {
        basis.add(field.clone());
    });
    let space = &basis.vectors[apart..];

    let n = space.len();
    let (mut projected, mut vectors) = (vec![0.0; n * n], vec![0.0; n * n]);
    let mut pushed = vec![Vec3::ZERO; count];
    for (j, vector) in space.iter().enumerate() {
        stiffness.apply(vector, &mut pushed);
        for (i, other) in space[..=j].iter().enumerate() {
            let entry = reduce::dot(other, &pushed);
            (projected[n * i + j], projected[n * j + i]) = (entry, entry);
        }
    }
    dense::eigen(n, &mut projected, &mut vectors);
    let value = |i: usize| projected[n * i + i];
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&a, &b| value(a).total_cmp(&value(b)).then(a.cmp(&b)));
    let shape = |&i: &usize| with_positive_peak(combination(space, &vectors[n * i..n * i + n], count));
    Ok(RitzPairs {
        eigenvalues: order.iter().map(|&i| value(i)).collect(),
        shapes: order.iter().map(shape).collect(),
    })
}

/// A basis of those combinations of some fields that vanish where entries are held: `free` has what projects an entry to where it may go. Of
/// fields whose values there are numbers of about one.
pub fn vanishing(fields: &[Vec<Vec3>], free: &[(usize, Mat3)]) -> Vec<Vec<Vec3>> {
    let (n, count) = (fields.len(), fields.first().map_or(0, Vec::len));
    if free.is_empty() || n == 0 {
        return fields.to_vec();
    }
    let held = |field: &Vec<Vec3>| -> Vec<Vec3> {
        free.iter().map(|(entry, free)| field[*entry] - *free * field[*entry]).collect()
    };
    let values: Vec<Vec<Vec3>> = fields.iter().map(held).collect();
    let (mut gram, mut vectors) = (vec![0.0; n * n], vec![0.0; n * n]);
    for (i, a) in values.iter().enumerate() {
        for (j, b) in values.iter().enumerate() {
            gram[n * i + j] = reduce::dot(a, b);
        }
    }
    let trace: f64 = (0..n).map(|i| gram[n * i + i]).sum();
    dense::eigen(n, &mut gram, &mut vectors);
    // squares of what fields have there, of which sums of `n` leave rounding
    let null = (0..n).filter(|i| gram[n * i + i] <= n as f64 * f64::EPSILON * trace);
    let combined = |i: usize| {
        let mut field = combination(fields, &vectors[n * i..n * i + n], count);
        free.iter().for_each(|(entry, free)| field[*entry] = *free * field[*entry]);
        field
    };
    null.map(combined).collect()
}
