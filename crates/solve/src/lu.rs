//! Sparse LU with partial pivoting, for matrices that are not symmetric.
//!
//! faer's kernels and its column ordering; several times dearer than a Cholesky factor of the same pattern.

use std::sync::{Arc, Mutex, PoisonError};

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::LuError;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::lu::{LuRef, LuSymbolicParams, NumericLu, SymbolicLu, factorize_symbolic_lu};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par};
use souple_math::Vec3;

use crate::error::check_length;
use crate::matrix::check_pattern;
use crate::{BlockMatrix, Pattern, SolveError};

/// A direct solver for all matrices of one pattern, symmetric or not.
pub struct LuSolver {
    pattern: Arc<Pattern>,
    column_starts: Vec<u32>,
    rows: Vec<u32>,
    /// Scalars by columns, in the order of `rows`.
    values: Vec<f64>,
    symbolic: SymbolicLu<u32>,
    numeric: NumericLu<u32, f64>,
    factorised: bool,
    memory: Mutex<MemBuffer>,
}

impl std::fmt::Debug for LuSolver {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let count = self.pattern.block_count();
        f.debug_struct("LuSolver").field("block_count", &count).field("factorised", &self.factorised).finish()
    }
}

impl LuSolver {
    /// Orders and analyses `pattern`.
    ///
    /// # Errors
    /// The matrix is too large for 32-bit indices, or the memory cannot be had.
    pub fn analyse(pattern: &Arc<Pattern>) -> Result<Self, SolveError> {
        let scalars = 9 * pattern.slot_count();
        if u32::try_from(scalars).is_err() {
            return Err(SolveError::TooLarge { blocks: scalars });
        }
        // the pattern is symmetric: the rows of a column are the columns of its row
        let (mut column_starts, mut rows) = (vec![0], Vec::with_capacity(scalars));
        for column in 0..pattern.block_count() {
            for _ in 0..3 {
                rows.extend(pattern.row(column).iter().flat_map(|&row| [3 * row, 3 * row + 1, 3 * row + 2]));
                column_starts.push(rows.len() as u32);
            }
        }
        let size = 3 * pattern.block_count();
        let structure = SymbolicSparseColMatRef::new_checked(size, size, &column_starts, None, &rows);
        let parameters = LuSymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..LuSymbolicParams::default()
        };
        let out_of_memory = || SolveError::OutOfMemory { what: "a direct factor" };
        let symbolic = factorize_symbolic_lu(structure, parameters).map_err(|_| out_of_memory())?;
        let scratch = symbolic
            .factorize_numeric_lu_scratch::<f64>(Par::Seq, Default::default())
            .or(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        let memory = Mutex::new(MemBuffer::try_new(scratch).map_err(|_| out_of_memory())?);
        Ok(Self {
            pattern: Arc::clone(pattern),
            values: vec![0.0; rows.len()],
            column_starts,
            rows,
            symbolic,
            numeric: NumericLu::new(),
            factorised: false,
            memory,
        })
    }

    /// Factorises new values.
    ///
    /// # Errors
    /// The matrix has another pattern, holds numbers that are not finite, or is singular.
    pub fn factorize(&mut self, matrix: &BlockMatrix) -> Result<(), SolveError> {
        self.factorised = false;
        check_pattern(&self.pattern, matrix.pattern())?;
        matrix.check_finite()?;
        let mut next = 0;
        for column in 0..self.pattern.block_count() {
            for j in 0..3 {
                for &row in self.pattern.row(column) {
                    let block = matrix.block(row as usize, column);
                    self.values[next..next + 3].copy_from_slice(&block.columns[j].to_array());
                    next += 3;
                }
            }
        }
        let size = 3 * self.pattern.block_count();
        let structure =
            SymbolicSparseColMatRef::new_checked(size, size, &self.column_starts, None, &self.rows);
        let values = SparseColMatRef::new(structure, &self.values[..]);
        let memory = self.memory.get_mut().unwrap_or_else(PoisonError::into_inner);
        let stack = MemStack::new(memory);
        self.symbolic
            .factorize_numeric_lu(&mut self.numeric, values, Par::Seq, stack, Default::default())
            .map_err(|error| match error {
                LuError::SymbolicSingular { index } => {
                    SolveError::Singular { method: "the LU factorisation", block: index / 3 }
                }
                LuError::Generic(_) => SolveError::OutOfMemory { what: "a direct factor" },
            })?;
        self.factorised = true;
        // a vanishing pivot shows as a solution that is not finite
        let mut probe = vec![Vec3::new(1.0, 1.0, 1.0); self.pattern.block_count()];
        self.solve(&mut probe)?;
        if let Some(block) = probe.iter().position(|entry| !entry.is_finite()) {
            self.factorised = false;
            return Err(SolveError::Singular { method: "the LU factorisation", block });
        }
        Ok(())
    }

    /// Bytes of the structure and the values that are factorised; the factor itself is not accessible.
    pub fn bytes(&self) -> usize {
        12 * self.values.len() + 4 * self.column_starts.len()
    }

    /// `b ← A⁻¹ b`.
    ///
    /// # Errors
    /// There is no factor, or `b` does not fit.
    pub fn solve(&self, b: &mut [Vec3]) -> Result<(), SolveError> {
        check_length("the right-hand side", b.len(), self.pattern.block_count())?;
        if !self.factorised {
            return Err(SolveError::NoFactor { method: "the LU solver" });
        }
        let mut memory = self.memory.lock().unwrap_or_else(PoisonError::into_inner);
        let x = MatMut::from_column_major_slice_mut(
            bytemuck::cast_slice_mut(b),
            3 * self.pattern.block_count(),
            1,
        );
        let factor = LuRef::new_unchecked(&self.symbolic, &self.numeric);
        factor.solve_in_place_with_conj(Conj::No, x, Par::Seq, MemStack::new(&mut memory));
        Ok(())
    }
}
