//! Sparse direct factors: `A = L Lᵀ` for positive definite, `A = L D Lᵀ` for symmetric matrices.
//!
//! The numerics are faer's supernodal kernels; the order of elimination is ours (`ordering.rs`). Structure is
//! analysed once, each new set of values is factorised into the same memory, always by one thread: the bits of
//! a factor do not depend on how many there are.

use std::sync::{Arc, Mutex, PoisonError};

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::ldlt::factor::LdltError;
use faer::linalg::cholesky::llt::factor::LltError;
use faer::sparse::linalg::cholesky::{LdltRef, LltRef, SymbolicCholesky, SymbolicCholeskyRaw};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};
use souple_math::{Mat3, Vec3};

use crate::error::check_length;
use crate::matrix::check_pattern;
use crate::ordering;
use crate::{BlockMatrix, Pattern, SolveError};

/// A pivot smaller than this fraction of its row's largest entry is lost in the rounding of the row.
const LOST_IN_ROUNDING: f64 = 1e-13;

/// How much of a pivot may be the rounding of single precision: the factor then solves all that is stiff to about as many digits as a
/// preconditioner is worth.
const LOST_IN_SINGLE: f64 = 0.01;

/// Which factor is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Factor {
    /// `L Lᵀ`: the matrix must be positive definite.
    Cholesky,
    /// `L D Lᵀ` without pivoting: the matrix must be symmetric with non-zero leading minors in the order of
    /// elimination, as shifted stiffness matrices are.
    Ldlt,
}

/// A direct solver for all matrices of one pattern.
pub struct DirectSolver {
    pattern: Arc<Pattern>,
    factor: Factor,
    /// Block eliminated at each step.
    order: Vec<u32>,
    symbolic: SymbolicCholesky<u32>,
    /// Lower triangle in the order of elimination, scalar by scalar.
    column_starts: Vec<u32>,
    rows: Vec<u32>,
    lower: Vec<f64>,
    /// For each column of blocks, the slots of the matrix that fill it, from the diagonal down.
    block_starts: Vec<u32>,
    slots: Vec<u32>,
    values: Vec<f64>,
    factorised: bool,
    negative_pivots: usize,
    /// The least pivot over the largest entry of its column.
    least_pivot: f64,
    scratch: Mutex<Scratch>,
}

struct Scratch {
    memory: MemBuffer,
    permuted: Vec<Vec3>,
}

impl std::fmt::Debug for DirectSolver {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("DirectSolver")
            .field("factor", &self.factor)
            .field("block_count", &self.pattern.block_count())
            .field("factor_nonzeros", &self.factor_nonzeros())
            .field("factorised", &self.factorised)
            .finish_non_exhaustive()
    }
}

impl DirectSolver {
    /// Orders and analyses `pattern` for [`Factor::Cholesky`]. `coordinates`, one place per block, make a
    /// better order than couplings alone.
    ///
    /// # Errors
    /// The coordinates do not fit or are not finite, or the memory cannot be had.
    pub fn analyse(pattern: &Arc<Pattern>, coordinates: Option<&[Vec3]>) -> Result<Self, SolveError> {
        Self::analyse_for(Factor::Cholesky, pattern, coordinates)
    }

    /// [`DirectSolver::analyse`] for either kind of factor.
    ///
    /// # Errors
    /// As there.
    pub fn analyse_for(
        factor: Factor,
        pattern: &Arc<Pattern>,
        coordinates: Option<&[Vec3]>,
    ) -> Result<Self, SolveError> {
        Self::with_order(factor, pattern, ordering::best(pattern, coordinates)?)
    }

    pub(crate) fn with_order(
        factor: Factor,
        pattern: &Arc<Pattern>,
        order: ordering::Order,
    ) -> Result<Self, SolveError> {
        let order = order.blocks;
        let LowerTriangle { column_starts, rows, block_starts, slots } = LowerTriangle::new(pattern, &order)?;
        let symbolic = ordering::analyse_lower(&column_starts, &rows)?;

        let out_of_memory = |_| SolveError::OutOfMemory { what: "a direct factor" };
        let mut values = Vec::new();
        values
            .try_reserve_exact(symbolic.len_val())
            .map_err(|_| SolveError::OutOfMemory { what: "a direct factor" })?;
        values.resize(symbolic.len_val(), 0.0);
        let numeric = match factor {
            Factor::Cholesky => symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default()),
            Factor::Ldlt => symbolic.factorize_numeric_ldlt_scratch::<f64>(Par::Seq, Default::default()),
        };
        let memory = MemBuffer::try_new(numeric.or(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq)))
            .map_err(out_of_memory)?;
        Ok(Self {
            pattern: Arc::clone(pattern),
            factor,
            symbolic,
            lower: vec![0.0; rows.len()],
            column_starts,
            rows,
            block_starts,
            slots,
            values,
            factorised: false,
            negative_pivots: 0,
            least_pivot: 0.0,
            scratch: Mutex::new(Scratch { memory, permuted: vec![Vec3::ZERO; order.len()] }),
            order,
        })
    }

    /// Factorises new values.
    ///
    /// # Errors
    /// The matrix has another pattern, holds numbers that are not finite, or is not positive definite
    /// (Cholesky) or singular (LDLT) to rounding. There is no factor then.
    pub fn factorize(&mut self, matrix: &BlockMatrix) -> Result<(), SolveError> {
        self.factorised = false;
        check_pattern(&self.pattern, matrix.pattern())?;
        matrix.check_finite()?;
        self.fill_lower(matrix.values());
        let scratch = self.scratch.get_mut().unwrap_or_else(PoisonError::into_inner);
        let stack = MemStack::new(&mut scratch.memory);
        let size = 3 * self.order.len();
        let structure =
            SymbolicSparseColMatRef::new_checked(size, size, &self.column_starts, None, &self.rows);
        let lower = SparseColMatRef::new(structure, &self.lower[..]);
        let block_of = |pivot: usize| self.order.get(pivot / 3).map_or(0, |&block| block as usize);
        match self.factor {
            Factor::Cholesky => self
                .symbolic
                .factorize_numeric_llt(
                    &mut self.values,
                    lower,
                    Side::Lower,
                    Default::default(),
                    Par::Seq,
                    stack,
                    Default::default(),
                )
                .map(|_| ())
                .map_err(|LltError::NonPositivePivot { index }| SolveError::NotPositiveDefinite {
                    method: "the Cholesky factorisation",
                    block: block_of(index),
                })?,
            Factor::Ldlt => self
                .symbolic
                .factorize_numeric_ldlt(
                    &mut self.values,
                    lower,
                    Side::Lower,
                    Default::default(),
                    Par::Seq,
                    stack,
                    Default::default(),
                )
                .map(|_| ())
                .map_err(|LdltError::ZeroPivot { index }| SolveError::Singular {
                    method: "the LDLT factorisation",
                    block: block_of(index),
                })?,
        }
        self.check_pivots()?;
        self.factorised = true;
        Ok(())
    }

    /// `b ← A⁻¹ b`.
    ///
    /// # Errors
    /// There is no factor, or `b` does not fit.
    pub fn solve(&self, b: &mut [Vec3]) -> Result<(), SolveError> {
        check_length("the right-hand side", b.len(), self.order.len())?;
        if !self.factorised {
            return Err(SolveError::NoFactor { method: "the direct solver" });
        }
        let mut scratch = self.scratch.lock().unwrap_or_else(PoisonError::into_inner);
        let Scratch { memory, permuted } = &mut *scratch;
        for (x, &block) in permuted.iter_mut().zip(&self.order) {
            *x = b[block as usize];
        }
        let size = 3 * self.order.len();
        let x = MatMut::from_column_major_slice_mut(bytemuck::cast_slice_mut(permuted), size, 1);
        let stack = MemStack::new(memory);
        match self.factor {
            Factor::Cholesky => {
                LltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(
                    Conj::No,
                    x,
                    Par::Seq,
                    stack,
                );
            }
            Factor::Ldlt => {
                LdltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(
                    Conj::No,
                    x,
                    Par::Seq,
                    stack,
                );
            }
        }
        for (x, &block) in permuted.iter().zip(&self.order) {
            b[block as usize] = *x;
        }
        Ok(())
    }

    pub fn pattern(&self) -> &Arc<Pattern> {
        &self.pattern
    }

    /// Keeps the Cholesky factor alone, in single precision, for preconditioners: half the memory, and half of what a solve reads.
    ///
    /// # Errors
    /// The solver as it is: no digits of some pivot would be left that are worth it, its factor is another, or there is none.
    pub fn into_rounded(self) -> Result<RoundedFactor, Box<Self>> {
        let is_kept = f64::from(f32::EPSILON) < LOST_IN_SINGLE * self.least_pivot;
        let is_supernodal = matches!(self.symbolic.raw(), SymbolicCholeskyRaw::Supernodal(_));
        let is_cholesky = self.factorised && self.factor == Factor::Cholesky;
        if !(is_kept && is_supernodal && is_cholesky) {
            return Err(Box::new(self));
        }
        let values: Vec<f32> = self.values.iter().map(|value| *value as f32).collect();
        let memory = MemBuffer::try_new(self.symbolic.solve_in_place_scratch::<f32>(1, Par::Seq));
        match memory {
            Ok(memory) if values.iter().all(|value| value.is_finite()) => {
                let Self { order, symbolic, .. } = self;
                let scratch = Mutex::new(RoundedScratch { memory, permuted: vec![[0.0; 3]; order.len()] });
                Ok(RoundedFactor { order, symbolic, values, scratch })
            }
            _ => Err(Box::new(self)),
        }
    }

    /// Numbers stored in the factor, the padding of supernodes included.
    pub fn factor_nonzeros(&self) -> usize {
        self.symbolic.len_val()
    }

    /// Negative pivots of the last factor: the number of negative eigenvalues of the matrix (Sylvester).
    pub fn negative_pivots(&self) -> usize {
        self.negative_pivots
    }

    /// Bytes held by factor, structure and copies of the values.
    pub fn bytes(&self) -> usize {
        let indices = self.column_starts.len() + self.rows.len() + self.block_starts.len() + self.slots.len();
        8 * (self.values.len() + self.lower.len()) + 4 * (indices + self.order.len())
    }

    /// Lower triangle of the matrix, in the order of elimination.
    fn fill_lower(&mut self, blocks: &[Mat3]) {
        let mut next = 0;
        for range in self.block_starts.windows(2) {
            let slots = &self.slots[range[0] as usize..range[1] as usize];
            for j in 0..3 {
                for (place, &slot) in slots.iter().enumerate() {
                    // the diagonal block gives what lies on and below its diagonal
                    let column =
                        &blocks[slot as usize].columns[j].to_array()[if place == 0 { j } else { 0 }..];
                    self.lower[next..next + column.len()].copy_from_slice(column);
                    next += column.len();
                }
            }
        }
    }

    /// `Err` where a pivot is nothing but rounding; counts negative ones.
    fn check_pivots(&mut self) -> Result<(), SolveError> {
        let SymbolicCholeskyRaw::Supernodal(symbolic) = self.symbolic.raw() else { return Ok(()) };
        self.negative_pivots = 0;
        self.least_pivot = f64::INFINITY;
        for s in 0..symbolic.n_supernodes() {
            let (begin, end) = (symbolic.supernode_begin()[s] as usize, symbolic.supernode_end()[s] as usize);
            let height = end - begin + symbolic.supernode(s).pattern().len();
            let first = symbolic.col_ptr_for_val()[s] as usize;
            for column in begin..end {
                let entry = self.values[first + (column - begin) * (height + 1)];
                let range = self.column_starts[column] as usize..self.column_starts[column + 1] as usize;
                let largest =
                    self.lower[range].iter().fold(0.0_f64, |largest, entry| largest.max(entry.abs()));
                let pivot = if self.factor == Factor::Cholesky { entry * entry } else { entry };
                let block = self.order[column / 3] as usize;
                if pivot.is_nan() || pivot.abs() <= LOST_IN_ROUNDING * largest {
                    return Err(match self.factor {
                        Factor::Cholesky => {
                            SolveError::NotPositiveDefinite { method: "the Cholesky factorisation", block }
                        }
                        Factor::Ldlt => SolveError::Singular { method: "the LDLT factorisation", block },
                    });
                }
                self.least_pivot = self.least_pivot.min(pivot.abs() / largest);
                self.negative_pivots += usize::from(pivot < 0.0);
            }
        }
        Ok(())
    }
}

/// A Cholesky factor in single precision. Products `L Lᵀ` of what is rounded are positive definite all the same.
pub struct RoundedFactor {
    /// Block eliminated at each step.
    order: Vec<u32>,
    symbolic: SymbolicCholesky<u32>,
    values: Vec<f32>,
    scratch: Mutex<RoundedScratch>,
}

struct RoundedScratch {
    memory: MemBuffer,
    permuted: Vec<[f32; 3]>,
}

impl RoundedFactor {
    /// `b ← (L Lᵀ)⁻¹ b`; `b` has a number for each block of the matrix.
    pub fn solve(&self, b: &mut [Vec3]) {
        assert_eq!(b.len(), self.order.len(), "a number for each block");
        // single precision has no room for all sizes that forces have
        let scale = b.iter().flat_map(|b| b.to_array()).fold(0.0, |largest: f64, b| largest.max(b.abs()));
        if scale == 0.0 || !scale.is_finite() {
            return;
        }
        let mut scratch = self.scratch.lock().unwrap_or_else(PoisonError::into_inner);
        let RoundedScratch { memory, permuted } = &mut *scratch;
        for (x, &block) in permuted.iter_mut().zip(&self.order) {
            *x = (b[block as usize] * (1.0 / scale)).to_array().map(|x| x as f32);
        }
        let size = 3 * self.order.len();
        let x = MatMut::from_column_major_slice_mut(permuted.as_flattened_mut(), size, 1);
        LltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            x,
            Par::Seq,
            MemStack::new(memory),
        );
        for (x, &block) in permuted.iter().zip(&self.order) {
            b[block as usize] = Vec3::from_array(x.map(f64::from)) * scale;
        }
    }

    /// Bytes held by factor and structure.
    pub fn bytes(&self) -> usize {
        4 * (self.values.len() + self.order.len())
    }
}

/// Structure of the lower triangle in the order of elimination.
struct LowerTriangle {
    column_starts: Vec<u32>,
    rows: Vec<u32>,
    block_starts: Vec<u32>,
    slots: Vec<u32>,
}

impl LowerTriangle {
    fn new(pattern: &Pattern, order: &[u32]) -> Result<Self, SolveError> {
        let place = ordering::inverse(order);
        let scalars = 9 * (pattern.slot_count() + order.len()) / 2;
        if u32::try_from(scalars).is_err() {
            return Err(SolveError::TooLarge { blocks: scalars });
        }
        let (mut column_starts, mut block_starts) = (vec![0], vec![0]);
        let (mut rows, mut slots) = (Vec::with_capacity(scalars), Vec::with_capacity(pattern.slot_count()));
        let mut below: Vec<(u32, u32)> = Vec::new();
        for (step, &block) in order.iter().enumerate() {
            below.clear();
            for &other in pattern.row(block as usize) {
                let at = place[other as usize];
                if at >= step as u32 {
                    let slot = pattern.slot(other as usize, block as usize).expect("patterns are symmetric");
                    below.push((at, slot as u32));
                }
            }
            below.sort_unstable();
            slots.extend(below.iter().map(|(_, slot)| slot));
            block_starts.push(slots.len() as u32);
            for j in 0..3 {
                for &(at, _) in &below {
                    let first = if at == step as u32 { j } else { 0 };
                    rows.extend((first..3).map(|i| 3 * at + i));
                }
                column_starts.push(rows.len() as u32);
            }
        }
        Ok(Self { column_starts, rows, block_starts, slots })
    }
}
