//! Incomplete Cholesky without fill on the 3×3 pattern.
//!
//! `A ≈ L D Lᵀ` with unit lower `L` that has entries only where `A` has (Meijerink & van der Vorst 1977, by
//! blocks). Where a pivot is not positive the factorisation is repeated for `A + σ diag(A)` with a larger `σ`
//! (Manteuffel 1980). `L` is kept in single precision, rounded once: a preconditioner need not be exact, but
//! it must be one fixed symmetric map, and half the memory is half the time.

use std::sync::Arc;

use souple_math::{Mat3, Vec3};

use super::{Preconditioner, invert_positive};
use crate::kernel::{self, Kernel, RowLoop};
use crate::matrix::check_pattern;
use crate::{BlockMatrix, Pattern, SolveError, reduce};

/// Shifts tried after a breakdown, relative to the diagonal.
const SHIFTS: [f64; 9] = [0.0, 1e-3, 4e-3, 1.6e-2, 6.4e-2, 0.25, 1.0, 4.0, 16.0];

/// Triangular factors of one pattern, in the order in which its blocks are numbered.
#[derive(Clone, Debug)]
pub struct IncompleteCholesky {
    pattern: Arc<Pattern>,
    /// Strictly lower triangle by rows; `slots` are those of the pattern.
    starts: Vec<u32>,
    columns: Vec<u32>,
    slots: Vec<u32>,
    diagonal_slots: Vec<u32>,
    /// Strictly upper triangle by rows, each entry the transpose of the lower one at `mirror`.
    upper_starts: Vec<u32>,
    upper_columns: Vec<u32>,
    mirror: Vec<u32>,
    /// `L D` while a row is worked on, then `L`.
    work: Vec<Mat3>,
    lower: Vec<[f32; 9]>,
    upper: Vec<[f32; 9]>,
    /// `D⁻¹`.
    inverses: Vec<Mat3>,
    shift: f64,
}

impl IncompleteCholesky {
    /// # Errors
    /// A diagonal block is not positive definite.
    pub fn new(matrix: &BlockMatrix) -> Result<Self, SolveError> {
        let pattern = Arc::clone(matrix.pattern());
        let count = pattern.block_count();
        let (mut starts, mut columns, mut slots) = (vec![0], Vec::new(), Vec::new());
        let mut diagonal_slots = Vec::with_capacity(count);
        let mut upper_starts = vec![0_u32; count + 1];
        for row in 0..count {
            for slot in pattern.slots(row) {
                let column = pattern.columns()[slot];
                if (column as usize) < row {
                    columns.push(column);
                    slots.push(slot as u32);
                    upper_starts[column as usize + 1] += 1;
                } else if column as usize == row {
                    diagonal_slots.push(slot as u32);
                }
            }
            starts.push(columns.len() as u32);
        }
        for row in 0..count {
            upper_starts[row + 1] += upper_starts[row];
        }
        let mut next = upper_starts.clone();
        let (mut upper_columns, mut mirror) = (vec![0; columns.len()], vec![0; columns.len()]);
        for row in 0..count {
            for entry in starts[row]..starts[row + 1] {
                let place = &mut next[columns[entry as usize] as usize];
                upper_columns[*place as usize] = row as u32;
                mirror[*place as usize] = entry;
                *place += 1;
            }
        }
        let entries = columns.len();
        let mut factor = Self {
            pattern,
            starts,
            columns,
            slots,
            diagonal_slots,
            upper_starts,
            upper_columns,
            mirror,
            work: vec![Mat3::ZERO; entries],
            lower: vec![[0.0; 9]; entries],
            upper: vec![[0.0; 9]; entries],
            inverses: vec![Mat3::ZERO; count],
            shift: 0.0,
        };
        factor.update(matrix)?;
        Ok(factor)
    }

    /// The shift `σ` that the last factorisation needed; 0 without breakdown.
    pub fn shift(&self) -> f64 {
        self.shift
    }

    /// `L D Lᵀ ≈ A + σ diag(A)`; `Err(row)` where a pivot is not positive.
    fn factorise(&mut self, values: &[Mat3], shift: f64) -> Result<(), usize> {
        let count = self.pattern.block_count();
        // where in row `r` a column has its entry
        let mut place = vec![u32::MAX; count];
        for row in 0..count {
            let entries = self.starts[row] as usize..self.starts[row + 1] as usize;
            for entry in entries.clone() {
                self.work[entry] = values[self.slots[entry] as usize];
                place[self.columns[entry] as usize] = entry as u32;
            }
            let diagonal = values[self.diagonal_slots[row] as usize];
            let mut pivot = diagonal + Mat3::from_diagonal(diagonal.diagonal() * shift);
            for entry in entries.clone() {
                // W_rc = A_rc − Σ_k W_rk L_ckᵀ  with  W = L D
                let column = self.columns[entry] as usize;
                let mut W = self.work[entry];
                for other in self.starts[column] as usize..self.starts[column + 1] as usize {
                    let shared = place[self.columns[other] as usize];
                    if shared != u32::MAX {
                        W -= self.work[shared as usize].mul_transpose(&self.work[other]);
                    }
                }
                self.work[entry] = W;
            }
            for entry in entries {
                // L_rc = W_rc D_c⁻¹,  D_r −= W_rc L_rcᵀ
                let column = self.columns[entry] as usize;
                let W = self.work[entry];
                let L = W * self.inverses[column];
                pivot -= W.mul_transpose(&L);
                self.work[entry] = L;
                place[column] = u32::MAX;
            }
            // a pivot that has lost nearly all of its block is as bad as a negative one
            let floor = Mat3::from_diagonal(diagonal.diagonal() * 1e-4);
            invert_positive(&(pivot - floor)).ok_or(row)?;
            self.inverses[row] = invert_positive(&pivot).ok_or(row)?;
        }
        Ok(())
    }
}

impl Preconditioner for IncompleteCholesky {
    fn update(&mut self, matrix: &BlockMatrix) -> Result<(), SolveError> {
        check_pattern(&self.pattern, matrix.pattern())?;
        matrix.check_finite()?;
        let mut failure = 0;
        let shift = SHIFTS.into_iter().find(|&shift| match self.factorise(matrix.values(), shift) {
            Ok(()) => true,
            Err(row) => {
                failure = row;
                false
            }
        });
        self.shift = shift
            .ok_or(SolveError::NotPositiveDefinite { method: "the incomplete Cholesky factorisation", block: failure })?;
        let single = |block: &Mat3| bytemuck::cast_ref::<Mat3, [f64; 9]>(block).map(|entry| entry as f32);
        for (lower, work) in self.lower.iter_mut().zip(&self.work) {
            *lower = single(work);
        }
        for (upper, &entry) in self.upper.iter_mut().zip(&self.mirror) {
            *upper = single(&self.work[entry as usize].transpose());
        }
        Ok(())
    }

    fn apply(&self, r: &[Vec3], z: &mut [Vec3]) {
        kernel::run(Solve { factor: self, r, z });
    }

    fn apply_dot(&self, r: &[Vec3], z: &mut [Vec3]) -> f64 {
        self.apply(r, z);
        reduce::dot(r, z)
    }

    fn bytes(&self) -> usize {
        (72 + 36 + 36 + 16) * self.work.len() + 84 * self.inverses.len()
    }
}

struct Solve<'a> {
    factor: &'a IncompleteCholesky,
    r: &'a [Vec3],
    z: &'a mut [Vec3],
}

impl RowLoop for Solve<'_> {
    type Output = ();

    #[inline(always)]
    fn run<K: Kernel>(self, kernel: K) {
        let Self { factor, r, z } = self;
        // L y = r
        for row in 0..z.len() {
            let entries = factor.starts[row] as usize..factor.starts[row + 1] as usize;
            let known = kernel.row_single(&factor.lower[entries.clone()], &factor.columns[entries], z);
            z[row] = r[row] - known;
        }
        // Lᵀ z = D⁻¹ y
        for row in (0..z.len()).rev() {
            let entries = factor.upper_starts[row] as usize..factor.upper_starts[row + 1] as usize;
            let known = kernel.row_single(&factor.upper[entries.clone()], &factor.upper_columns[entries], z);
            z[row] = factor.inverses[row] * z[row] - known;
        }
    }
}
