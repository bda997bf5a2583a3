//! Sparse matrices of 3×3 blocks.

use std::sync::Arc;

use souple_math::{Mat3, Vec3};

use crate::error::check_length;
use crate::kernel::{self, Kernel, RowLoop};
use crate::{LinearOperator, Pattern, SolveError, reduce};

/// A matrix with the blocks of a [`Pattern`]; 72 bytes per block and 4 per column index.
///
/// The pattern is shared, so matrices assembled again and again cost no new structure.
#[derive(Clone, Debug)]
pub struct BlockMatrix {
    pattern: Arc<Pattern>,
    /// One block per slot of the pattern.
    values: Vec<Mat3>,
}

impl BlockMatrix {
    pub fn zeros(pattern: Arc<Pattern>) -> Self {
        let values = vec![Mat3::ZERO; pattern.slot_count()];
        Self { pattern, values }
    }

    pub fn pattern(&self) -> &Arc<Pattern> {
        &self.pattern
    }

    /// Blocks in the order of the pattern's slots.
    pub fn values(&self) -> &[Mat3] {
        &self.values
    }

    pub fn values_mut(&mut self) -> &mut [Mat3] {
        &mut self.values
    }

    pub fn set_zero(&mut self) {
        reduce::for_each_chunk(&mut self.values, &|_, chunk: &mut [Mat3]| chunk.fill(Mat3::ZERO));
    }

    /// Adds to the block at `slot` of [`Pattern::slot`].
    #[inline]
    pub fn add_at(&mut self, slot: usize, block: &Mat3) {
        self.values[slot] += *block;
    }

    /// Adds to block `(row, column)`.
    ///
    /// # Errors
    /// The pattern has no such block.
    pub fn add(&mut self, row: usize, column: usize, block: &Mat3) -> Result<(), SolveError> {
        let slot = self.pattern.slot(row, column).ok_or(SolveError::NoSlot { row, column })?;
        self.add_at(slot, block);
        Ok(())
    }

    /// Block `(row, column)`, zero where none is stored.
    pub fn block(&self, row: usize, column: usize) -> Mat3 {
        self.pattern.slot(row, column).map_or(Mat3::ZERO, |slot| self.values[slot])
    }

    /// Block `(row, row)`.
    pub fn diagonal_block(&self, row: usize) -> Mat3 {
        self.values[self.diagonal_slot(row)]
    }

    /// `A += s B`.
    ///
    /// # Errors
    /// `B` has another pattern.
    pub fn add_scaled(&mut self, s: f64, other: &Self) -> Result<(), SolveError> {
        self.check_same_pattern(other)?;
        for (a, b) in self.values.iter_mut().zip(&other.values) {
            *a += *b * s;
        }
        Ok(())
    }

    /// `A *= s`.
    pub fn scale(&mut self, s: f64) {
        for block in &mut self.values {
            *block = *block * s;
        }
    }

    /// Adds `s m_r I` to each diagonal block: `masses` holds one number per row.
    ///
    /// # Errors
    /// `masses` does not fit the matrix.
    pub fn add_scaled_diagonal(&mut self, s: f64, masses: &[f64]) -> Result<(), SolveError> {
        check_length("masses", masses.len(), self.pattern.block_count())?;
        for (row, mass) in masses.iter().enumerate() {
            let slot = self.diagonal_slot(row);
            self.values[slot] = self.values[slot].plus_diagonal(s * mass);
        }
        Ok(())
    }

    /// Restricts the matrix to the free directions: with `S_r` the symmetric projector onto the directions
    /// in which block `r` may move (identity: free; zero: pinned),
    ///
    /// `A_rc ← S_r A_rc S_c`, and `A_rr += scale (I − S_r)`.
    ///
    /// A symmetric positive definite matrix stays so for `scale > 0`; a scale of the size of the diagonal
    /// keeps it well conditioned ([`BlockMatrix::mean_diagonal`]).
    ///
    /// # Errors
    /// `projectors` does not fit the matrix.
    pub fn constrain(&mut self, projectors: &[Mat3], scale: f64) -> Result<(), SolveError> {
        check_length("projectors", projectors.len(), self.pattern.block_count())?;
        for (row, S_row) in projectors.iter().enumerate() {
            let row_is_free = *S_row == Mat3::IDENTITY;
            for slot in self.pattern.slots(row) {
                let column = self.pattern.columns()[slot] as usize;
                let S_column = &projectors[column];
                if !row_is_free || *S_column != Mat3::IDENTITY {
                    self.values[slot] = *S_row * self.values[slot] * *S_column;
                }
                if column == row && !row_is_free {
                    self.values[slot] += (Mat3::IDENTITY - *S_row) * scale;
                }
            }
        }
        Ok(())
    }

    /// [`BlockMatrix::constrain`] for the blocks named alone, each with its projector: the way for few among
    /// many. A block may be named more than once; its projectors then act one after the other.
    ///
    /// # Errors
    /// A block is not one of the matrix; those named before it are constrained.
    pub fn constrain_blocks(
        &mut self,
        constrained: impl IntoIterator<Item = (usize, Mat3)>,
        scale: f64,
    ) -> Result<(), SolveError> {
        for (row, S) in constrained {
            let expected = self.pattern.block_count();
            if row >= expected {
                return Err(SolveError::Length { what: "the constraints", given: row + 1, expected });
            }
            for slot in self.pattern.slots(row) {
                let column = self.pattern.columns()[slot] as usize;
                if column == row {
                    self.values[slot] = S * self.values[slot] * S + (Mat3::IDENTITY - S) * scale;
                } else {
                    // A_rc ← S A_rc,  A_cr ← A_cr S
                    self.values[slot] = S * self.values[slot];
                    let mirror = self.pattern.slot(column, row).expect("patterns are symmetric");
                    self.values[mirror] = self.values[mirror] * S;
                }
            }
        }
        Ok(())
    }

    /// Takes the mean of the matrix and its transpose: the symmetric matrix that is nearest.
    pub fn symmetrise(&mut self) {
        let pattern = Arc::clone(&self.pattern);
        for row in 0..pattern.block_count() {
            for slot in pattern.slots(row) {
                let column = pattern.columns()[slot] as usize;
                if column < row {
                    continue;
                }
                let mirror = pattern.slot(column, row).expect("patterns are symmetric");
                let mean = (self.values[slot] + self.values[mirror].transpose()) * 0.5;
                self.values[slot] = mean;
                self.values[mirror] = mean.transpose();
            }
        }
    }

    /// Mean of the diagonal entries; 0 for a matrix without rows.
    pub fn mean_diagonal(&self) -> f64 {
        let rows = self.pattern.block_count();
        let trace: f64 = (0..rows).map(|row| self.diagonal_block(row).trace()).sum();
        if rows == 0 { 0.0 } else { trace / (3 * rows) as f64 }
    }

    /// The largest entry of `A − Aᵀ` in absolute value: zero for a symmetric matrix.
    pub fn asymmetry(&self) -> f64 {
        let mut largest = 0.0_f64;
        for row in 0..self.pattern.block_count() {
            for slot in self.pattern.slots(row) {
                let column = self.pattern.columns()[slot] as usize;
                if column <= row {
                    let difference = self.values[slot] - self.block(column, row).transpose();
                    largest = largest.max(difference.largest_entry());
                }
            }
        }
        largest
    }

    /// # Errors
    /// Names the first row with an entry that is infinite or not a number.
    pub fn check_finite(&self) -> Result<(), SolveError> {
        // a sum is finite only if all its terms are: one quick pass before looking for the place
        if reduce::all_finite(bytemuck::cast_slice(&self.values)) {
            return Ok(());
        }
        let bad_row = |row: &usize| self.pattern.slots(*row).any(|slot| !self.values[slot].is_finite());
        let block = (0..self.pattern.block_count()).find(bad_row).unwrap_or(0);
        Err(SolveError::NotFinite { what: "the matrix", block })
    }

    /// The matrix written out, row after row of `3 block_count` numbers; for tests and small systems.
    pub fn to_dense(&self) -> Vec<Vec<f64>> {
        let mut dense = vec![vec![0.0; 3 * self.pattern.block_count()]; 3 * self.pattern.block_count()];
        for row in 0..self.pattern.block_count() {
            for slot in self.pattern.slots(row) {
                let column = self.pattern.columns()[slot] as usize;
                for (i, j) in (0..9).map(|k| (k / 3, k % 3)) {
                    dense[3 * row + i][3 * column + j] = self.values[slot].entry(i, j);
                }
            }
        }
        dense
    }

    /// Bytes of the values; the pattern is counted where it is owned.
    pub fn bytes(&self) -> usize {
        std::mem::size_of_val(self.values.as_slice())
    }

    /// # Errors
    /// `other` has another pattern.
    pub fn check_same_pattern(&self, other: &Self) -> Result<(), SolveError> {
        check_pattern(&self.pattern, &other.pattern)
    }

    fn diagonal_slot(&self, row: usize) -> usize {
        self.pattern.diagonal_slot(row)
    }

    /// Rows `first ..` of `A x` into `y`.
    fn multiply_rows(&self, first: usize, x: &[Vec3], y: &mut [Vec3]) {
        kernel::run(Product { matrix: self, first, x, y });
    }
}

/// `Err` unless both are the same structure.
pub(crate) fn check_pattern(expected: &Arc<Pattern>, given: &Arc<Pattern>) -> Result<(), SolveError> {
    if Arc::ptr_eq(expected, given) || expected == given {
        return Ok(());
    }
    Err(SolveError::OtherPattern {
        given_rows: given.block_count(),
        given_blocks: given.slot_count(),
        expected_rows: expected.block_count(),
        expected_blocks: expected.slot_count(),
    })
}

struct Product<'a> {
    matrix: &'a BlockMatrix,
    first: usize,
    x: &'a [Vec3],
    y: &'a mut [Vec3],
}

impl RowLoop for Product<'_> {
    type Output = ();

    #[inline(always)]
    fn run<K: Kernel>(self, kernel: K) {
        let (pattern, values) = (&*self.matrix.pattern, &self.matrix.values[..]);
        for (row, y) in (self.first..).zip(self.y) {
            let slots = pattern.slots(row);
            *y = kernel.row(&values[slots.clone()], &pattern.columns()[slots], self.x);
        }
    }
}

impl LinearOperator for BlockMatrix {
    fn block_count(&self) -> usize {
        self.pattern.block_count()
    }

    fn apply(&self, x: &[Vec3], y: &mut [Vec3]) {
        reduce::for_each_rows(y, &|first, rows: &mut [Vec3]| self.multiply_rows(first, x, rows));
    }

    fn apply_dot(&self, x: &[Vec3], y: &mut [Vec3]) -> f64 {
        reduce::sum_rows(y, &|first, rows: &mut [Vec3]| {
            self.multiply_rows(first, x, rows);
            reduce::dot_chunk(&x[first..first + rows.len()], rows)
        })
    }

    fn residual(&self, b: &[Vec3], x: &[Vec3], r: &mut [Vec3]) -> f64 {
        reduce::sum_rows(r, &|first, rows: &mut [Vec3]| {
            self.multiply_rows(first, x, rows);
            for (r, b) in rows.iter_mut().zip(&b[first..]) {
                *r = *b - *r;
            }
            reduce::dot_chunk(rows, rows)
        })
    }
}
