//! Incomplete Cholesky without fill on the 3×3 pattern.
//!
//! `A ≈ L D Lᵀ` with unit lower `L` that has entries only where `A` has (Meijerink & van der Vorst 1977, by
//! blocks). Where a pivot is not positive the factorisation is repeated for `A + σ diag(A)` with a larger `σ`
//! (Manteuffel 1980). `L` is kept in single precision, rounded once: a preconditioner need not be exact, but
//! it must be one fixed symmetric map, and half the memory is half the time.

use std::sync::{Arc, Mutex, PoisonError};

use souple_math::{Mat3, Vec3};

use super::{Preconditioner, invert_positive};
use crate::error::check_length;
use crate::kernel::{self, Kernel, RowLoop};
use crate::matrix::check_pattern;
use crate::{BlockMatrix, Pattern, SolveError, ordering};

/// Shifts tried after a breakdown, relative to the diagonal.
const SHIFTS: [f64; 9] = [0.0, 1e-3, 4e-3, 1.6e-2, 6.4e-2, 0.25, 1.0, 4.0, 16.0];

/// How many times farther than in a sweep the numbering may reach, on average, before it is abandoned.
const JUMPY: u64 = 3;

/// Triangular factors of one pattern.
#[derive(Debug)]
pub struct IncompleteCholesky {
    pattern: Arc<Pattern>,
    /// Block eliminated at each step; `None`: as numbered. All rows and columns below count steps.
    order: Option<Vec<u32>>,
    /// Residual and solution in the order of elimination.
    gathered: Mutex<Vec<Vec3>>,
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
    /// Where in the row worked on a column has its entry; `u32::MAX` elsewhere.
    place: Vec<u32>,
    lower: Vec<[f32; 9]>,
    upper: Vec<[f32; 9]>,
    /// `D⁻¹`.
    inverses: Vec<Mat3>,
    shift: f64,
}

impl IncompleteCholesky {
    /// Factors in the order in which the blocks are numbered.
    ///
    /// # Errors
    /// A diagonal block is not positive definite.
    pub fn new(matrix: &BlockMatrix) -> Result<Self, SolveError> {
        Self::in_order(matrix, None)
    }

    /// Factors along the longest axis of the body where the numbering jumps about in it, and in the order of
    /// the numbering where that is local already.
    ///
    /// # Errors
    /// The coordinates do not fit, or a diagonal block is not positive definite.
    pub fn with_coordinates(matrix: &BlockMatrix, coordinates: &[Vec3]) -> Result<Self, SolveError> {
        let pattern = matrix.pattern();
        check_length("coordinates", coordinates.len(), pattern.block_count())?;
        let order = ordering::sweep_along_longest_axis(coordinates);
        let place = ordering::inverse(&order);
        let reach = |place: &dyn Fn(usize) -> u32| -> u64 {
            let row = |row: usize| {
                pattern
                    .row(row)
                    .iter()
                    .map(|&c| u64::from(place(row).abs_diff(place(c as usize))))
                    .sum::<u64>()
            };
            (0..pattern.block_count()).map(row).sum()
        };
        let is_local = reach(&|row| row as u32) <= JUMPY * reach(&|row| place[row]);
        Self::in_order(matrix, if is_local { None } else { Some(order) })
    }

    /// Factors in a given order: `order[i]` is the `i`-th block eliminated, each occurring once.
    ///
    /// # Errors
    /// The order is no permutation of the blocks, or a diagonal block is not positive definite.
    pub fn with_order(matrix: &BlockMatrix, order: Vec<u32>) -> Result<Self, SolveError> {
        let count = matrix.pattern().block_count();
        check_length("the order", order.len(), count)?;
        let mut seen = vec![false; count];
        for &block in &order {
            if seen.get(block as usize) != Some(&false) {
                return Err(SolveError::NoPermutation { block: block as usize, block_count: count });
            }
            seen[block as usize] = true;
        }
        Self::in_order(matrix, Some(order))
    }

    fn in_order(matrix: &BlockMatrix, order: Option<Vec<u32>>) -> Result<Self, SolveError> {
        let pattern = Arc::clone(matrix.pattern());
        let count = pattern.block_count();
        let place = order.as_deref().map(ordering::inverse);
        let (mut starts, mut columns, mut slots) = (vec![0], Vec::new(), Vec::new());
        let mut diagonal_slots = Vec::with_capacity(count);
        let mut upper_starts = vec![0_u32; count + 1];
        let mut lower: Vec<(u32, u32)> = Vec::new();
        for row in 0..count {
            lower.clear();
            for slot in pattern.slots(order.as_ref().map_or(row, |order| order[row] as usize)) {
                let column = pattern.columns()[slot];
                let column = place.as_ref().map_or(column, |place| place[column as usize]);
                if (column as usize) < row {
                    lower.push((column, slot as u32));
                    upper_starts[column as usize + 1] += 1;
                } else if column as usize == row {
                    diagonal_slots.push(slot as u32);
                }
            }
            lower.sort_unstable();
            columns.extend(lower.iter().map(|entry| entry.0));
            slots.extend(lower.iter().map(|entry| entry.1));
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
            gathered: Mutex::new(vec![Vec3::ZERO; if order.is_some() { count } else { 0 }]),
            order,
            starts,
            columns,
            slots,
            diagonal_slots,
            upper_starts,
            upper_columns,
            mirror,
            work: vec![Mat3::ZERO; entries],
            place: vec![u32::MAX; count],
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
        // a breakdown may have left entries of its row
        self.place.fill(u32::MAX);
        for row in 0..count {
            let entries = self.starts[row] as usize..self.starts[row + 1] as usize;
            for entry in entries.clone() {
                self.work[entry] = values[self.slots[entry] as usize];
                self.place[self.columns[entry] as usize] = entry as u32;
            }
            let diagonal = values[self.diagonal_slots[row] as usize];
            let mut pivot = diagonal + Mat3::from_diagonal(diagonal.diagonal() * shift);
            for entry in entries.clone() {
                // W_rc = A_rc − Σ_k W_rk L_ckᵀ  with  W = L D
                let column = self.columns[entry] as usize;
                let mut W = self.work[entry];
                for other in self.starts[column] as usize..self.starts[column + 1] as usize {
                    let shared = self.place[self.columns[other] as usize];
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
                self.place[column] = u32::MAX;
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
        self.shift = shift.ok_or(SolveError::NotPositiveDefinite {
            method: "the incomplete Cholesky factorisation",
            block: failure,
        })?;
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
        let Some(order) = &self.order else {
            z.copy_from_slice(r);
            return kernel::run(Solve { factor: self, z });
        };
        let mut gathered = self.gathered.lock().unwrap_or_else(PoisonError::into_inner);
        for (gathered, &block) in gathered.iter_mut().zip(order) {
            *gathered = r[block as usize];
        }
        kernel::run(Solve { factor: self, z: &mut gathered });
        for (gathered, &block) in gathered.iter().zip(order) {
            z[block as usize] = *gathered;
        }
    }

    fn bytes(&self) -> usize {
        (72 + 36 + 36 + 16) * self.work.len() + 88 * self.inverses.len()
    }
}

struct Solve<'a> {
    factor: &'a IncompleteCholesky,
    /// Right-hand side, overwritten by the solution.
    z: &'a mut [Vec3],
}

impl RowLoop for Solve<'_> {
    type Output = ();

    #[inline(always)]
    fn run<K: Kernel>(self, kernel: K) {
        let Self { factor, z } = self;
        // L y = r
        for row in 0..z.len() {
            let entries = factor.starts[row] as usize..factor.starts[row + 1] as usize;
            let known = kernel.row_single(&factor.lower[entries.clone()], &factor.columns[entries], z);
            z[row] -= known;
        }
        // Lᵀ z = D⁻¹ y
        for row in (0..z.len()).rev() {
            let entries = factor.upper_starts[row] as usize..factor.upper_starts[row + 1] as usize;
            let known = kernel.row_single(&factor.upper[entries.clone()], &factor.upper_columns[entries], z);
            z[row] = factor.inverses[row] * z[row] - known;
        }
    }
}
