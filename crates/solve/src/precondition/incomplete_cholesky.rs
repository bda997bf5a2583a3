//! Incomplete Cholesky without fill on the 3×3 pattern.
//!
//! `A ≈ L D Lᵀ` with unit lower `L` that has entries only where `A` has (Meijerink & van der Vorst 1977, by
//! blocks). Where a pivot is not positive the factorisation is repeated for `A + σ diag(A)` with a larger `σ`
//! (Manteuffel 1980). `L` is kept in single precision, rounded once: a preconditioner need not be exact, but
//! it must be one fixed symmetric map, and half the memory is half the time.
//!
//! Larger bodies are eliminated from both ends to where they meet (twisted factorisation, van der Vorst 1987): the ends
//! know nothing of each other, so that two threads may share every sweep, and as many iterations are needed as before.

use std::ops::Range;
use std::sync::Arc;

use souple_math::{Mat3, Vec3};

use super::{Preconditioner, invert_positive};
use crate::error::check_length;
use crate::kernel::{self, Kernel, RowLoop};
use crate::matrix::check_pattern;
use crate::spare::Spare;
use crate::{BlockMatrix, Pattern, SolveError, ordering, reduce};

/// Shifts tried after a breakdown, relative to the diagonal.
const SHIFTS: [f64; 9] = [0.0, 1e-3, 4e-3, 1.6e-2, 6.4e-2, 0.25, 1.0, 4.0, 16.0];

/// How many times farther than in a sweep the numbering may reach, on average, before it is abandoned.
const JUMPY: u64 = 3;

/// Blocks from which on both ends are worth two threads.
const TWO_ENDED_FROM: usize = 1024;

/// Triangular factors of one pattern.
#[derive(Debug)]
pub struct IncompleteCholesky {
    pattern: Arc<Pattern>,
    /// Block eliminated at each step; `None`: as numbered.
    order: Option<Vec<u32>>,
    /// Residual and solution in the order of elimination.
    gathered: Spare<Vec<Vec3>>,
    triangle: Triangle,
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

/// Where rows are cut, in steps of elimination: two ends `0 .. first` and `first .. ends` that are not coupled, and what
/// joins them.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cut {
    first: usize,
    ends: usize,
}

impl Cut {
    /// One end alone.
    fn none(count: usize) -> Self {
        Self { first: count, ends: count }
    }

    /// Where the columns of a row are counted from.
    fn base(&self, row: usize) -> usize {
        if (self.first..self.ends).contains(&row) { self.first } else { 0 }
    }

    fn has_two_ends(&self) -> bool {
        self.first < self.ends
    }
}

/// Structure of the factors; rows and columns count steps of elimination.
#[derive(Debug)]
struct Triangle {
    cut: Cut,
    /// Strictly lower triangle by rows, columns counted from [`Cut::base`] of the row; `slots` are those of the pattern.
    starts: Vec<u32>,
    columns: Vec<u32>,
    slots: Vec<u32>,
    diagonal_slots: Vec<u32>,
    /// Strictly upper triangle by rows, each entry the transpose of the lower one at `mirror`. Columns of an end count
    /// from its base; those of what joins the ends, from `upper_joints` of the row on, from `cut.ends`.
    upper_starts: Vec<u32>,
    upper_joints: Vec<u32>,
    upper_columns: Vec<u32>,
    mirror: Vec<u32>,
}

impl IncompleteCholesky {
    /// Factors along the numbering of the blocks, larger systems from both ends.
    ///
    /// # Errors
    /// A diagonal block is not positive definite.
    pub fn new(matrix: &BlockMatrix) -> Result<Self, SolveError> {
        Self::along(matrix, None)
    }

    /// Factors along the longest axis of the body where the numbering jumps about in it, and along the numbering where
    /// that is local already; larger bodies from both ends.
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
        Self::along(matrix, if is_local { None } else { Some(order) })
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
        Self::in_order(matrix, Some(order), Cut::none(count))
    }

    fn along(matrix: &BlockMatrix, sweep: Option<Vec<u32>>) -> Result<Self, SolveError> {
        let (order, cut) = from_both_ends(matrix.pattern(), sweep);
        Self::in_order(matrix, order, cut)
    }

    fn in_order(matrix: &BlockMatrix, order: Option<Vec<u32>>, cut: Cut) -> Result<Self, SolveError> {
        let pattern = Arc::clone(matrix.pattern());
        let count = pattern.block_count();
        let triangle = Triangle::new(&pattern, order.as_deref(), cut);
        let entries = triangle.columns.len();
        let mut factor = Self {
            pattern,
            gathered: Spare::new(vec![Vec3::ZERO; if order.is_some() { count } else { 0 }]),
            order,
            triangle,
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
        let Self { triangle, work, place, inverses, .. } = self;
        // a breakdown may have left entries of its row
        place.fill(u32::MAX);
        let Cut { first, ends } = triangle.cut;
        let rows = |rows: Range<usize>, work: &mut [Mat3], place: &mut [u32], inverses: &mut [Mat3]| {
            kernel::run(Elimination { triangle, values, shift, rows, work, place, inverses })
        };
        let (work_first, work_rest) = work.split_at_mut(triangle.starts[first] as usize);
        let (place_first, place_rest) = place.split_at_mut(first);
        let (inverses_first, inverses_rest) = inverses.split_at_mut(first);
        let (a, b) = reduce::both(
            triangle.cut.has_two_ends(),
            || rows(0..first, work_first, place_first, inverses_first),
            || rows(first..ends, work_rest, place_rest, inverses_rest),
        );
        a.and(b)?;
        rows(ends..inverses.len(), work, place, inverses)
    }
}

/// The order in which a body is eliminated from both ends of the one given, where it is large enough and the ends are
/// joined by few blocks.
fn from_both_ends(pattern: &Pattern, order: Option<Vec<u32>>) -> (Option<Vec<u32>>, Cut) {
    let count = pattern.block_count();
    let whole = Cut::none(count);
    if count < TWO_ENDED_FROM {
        return (order, whole);
    }
    let sweep = order.clone().unwrap_or_else(|| (0..count as u32).collect());
    let place = ordering::inverse(&sweep);
    // of the second part those that are coupled to the first
    let joins = |half: usize, block: u32| {
        pattern.row(block as usize).iter().any(|&other| (place[other as usize] as usize) < half)
    };
    let joints_of = |half: usize| sweep[half..].iter().filter(|&&block| joins(half, block)).count();
    let first = (count - joints_of(count / 2)) / 2;
    let (joints, mut second): (Vec<u32>, Vec<u32>) =
        sweep[first..].iter().partition(|&&block| joins(first, block));
    if 4 * joints.len() > count {
        return (order, whole);
    }
    second.reverse();
    let cut = Cut { first, ends: first + second.len() };
    (Some([&sweep[..first], &second, &joints].concat()), cut)
}

impl Triangle {
    fn new(pattern: &Pattern, order: Option<&[u32]>, cut: Cut) -> Self {
        let count = pattern.block_count();
        let place = order.map(ordering::inverse);
        let (mut starts, mut columns, mut slots) = (vec![0], Vec::new(), Vec::new());
        let mut diagonal_slots = Vec::with_capacity(count);
        let mut upper_starts = vec![0_u32; count + 1];
        let mut lower: Vec<(u32, u32)> = Vec::new();
        for row in 0..count {
            lower.clear();
            for slot in pattern.slots(order.map_or(row, |order| order[row] as usize)) {
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
        let mut upper_joints = vec![0; count];
        let (mut upper_columns, mut mirror) = (vec![0; columns.len()], vec![0; columns.len()]);
        for row in 0..count {
            if row == cut.ends {
                upper_joints.copy_from_slice(&next[..count]);
            }
            for entry in starts[row]..starts[row + 1] {
                let place = &mut next[columns[entry as usize] as usize];
                upper_columns[*place as usize] =
                    (row - if row < cut.ends { cut.base(row) } else { cut.ends }) as u32;
                mirror[*place as usize] = entry;
                *place += 1;
            }
        }
        if cut.ends == count {
            upper_joints.copy_from_slice(&upper_starts[1..]);
        }
        for row in cut.first..cut.ends {
            columns[starts[row] as usize..starts[row + 1] as usize]
                .iter_mut()
                .for_each(|column| *column -= cut.first as u32);
        }
        Self {
            cut,
            starts,
            columns,
            slots,
            diagonal_slots,
            upper_starts,
            upper_joints,
            upper_columns,
            mirror,
        }
    }

    fn entries(&self, row: usize) -> Range<usize> {
        self.starts[row] as usize..self.starts[row + 1] as usize
    }
}

/// Eliminates `rows`, all of one part; the arrays begin where the part's columns do.
struct Elimination<'a> {
    triangle: &'a Triangle,
    values: &'a [Mat3],
    shift: f64,
    rows: Range<usize>,
    work: &'a mut [Mat3],
    place: &'a mut [u32],
    inverses: &'a mut [Mat3],
}

impl RowLoop for Elimination<'_> {
    type Output = Result<(), usize>;

    #[inline(always)]
    fn run<K: Kernel>(self, kernel: K) -> Result<(), usize> {
        let Self { triangle, values, shift, rows, work, place, inverses } = self;
        let cut = triangle.cut;
        let base = cut.base(rows.start);
        let first_entry = triangle.starts[base] as usize;
        for row in rows {
            let entries = triangle.entries(row);
            for entry in entries.clone() {
                work[entry - first_entry] = values[triangle.slots[entry] as usize];
                place[triangle.columns[entry] as usize] = (entry - first_entry) as u32;
            }
            let diagonal = values[triangle.diagonal_slots[row] as usize];
            for entry in entries.clone() {
                // W_rc = A_rc − Σ_k W_rk L_ckᵀ  with  W = L D
                let column = triangle.columns[entry] as usize + base;
                let turn = cut.base(column) - base;
                let mut sum = kernel.zero();
                for other in triangle.entries(column) {
                    let shared = place[triangle.columns[other] as usize + turn];
                    if shared != u32::MAX {
                        sum =
                            kernel.add_mul_transpose(sum, &work[shared as usize], &work[other - first_entry]);
                    }
                }
                work[entry - first_entry] -= kernel.store(sum);
            }
            let mut sum = kernel.zero();
            for entry in entries {
                // L_rc = W_rc D_c⁻¹,  D_r −= W_rc L_rcᵀ
                let column = triangle.columns[entry] as usize;
                let W = work[entry - first_entry];
                let L = kernel.store(kernel.mul(&W, &inverses[column]));
                sum = kernel.add_mul_transpose(sum, &W, &L);
                work[entry - first_entry] = L;
                place[column] = u32::MAX;
            }
            let pivot = diagonal + Mat3::from_diagonal(diagonal.diagonal() * shift)
                - kernel.store(sum).symmetric_part();
            // a pivot that has lost nearly all of its block is as bad as a negative one
            let floor = Mat3::from_diagonal(diagonal.diagonal() * 1e-4);
            invert_positive(&(pivot - floor)).ok_or(row)?;
            inverses[row - base] = invert_positive(&pivot).ok_or(row)?;
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
        for (upper, &entry) in self.upper.iter_mut().zip(&self.triangle.mirror) {
            *upper = single(&self.work[entry as usize].transpose());
        }
        Ok(())
    }

    fn apply(&self, r: &[Vec3], z: &mut [Vec3]) {
        let Some(order) = &self.order else {
            z.copy_from_slice(r);
            return self.solve(z);
        };
        self.gathered.lend(|gathered| {
            gathered.resize(order.len(), Vec3::ZERO);
            for (gathered, &block) in gathered.iter_mut().zip(order) {
                *gathered = r[block as usize];
            }
            self.solve(gathered);
            for (gathered, &block) in gathered.iter().zip(order) {
                z[block as usize] = *gathered;
            }
        });
    }

    fn bytes(&self) -> usize {
        (72 + 36 + 36 + 16) * self.work.len() + 88 * self.inverses.len()
    }
}

impl IncompleteCholesky {
    /// `z ← (L D Lᵀ)⁻¹ z`, in the order of elimination.
    fn solve(&self, z: &mut [Vec3]) {
        let Cut { first, ends } = self.triangle.cut;
        let two = self.triangle.cut.has_two_ends();
        // L y = r
        let forward = |rows: Range<usize>, z: &mut [Vec3]| kernel::run(Forward { factor: self, rows, z });
        let (head, tail) = z[..ends].split_at_mut(first);
        reduce::both(two, || forward(0..first, head), || forward(first..ends, tail));
        forward(ends..z.len(), z);
        // Lᵀ z = D⁻¹ y
        let (parts, joint) = z.split_at_mut(ends);
        kernel::run(Backward { factor: self, rows: ends..self.inverses.len(), z: joint, joint: &[] });
        let (head, tail) = parts.split_at_mut(first);
        let backward = |rows: Range<usize>, z: &mut [Vec3]| {
            kernel::run(Backward { factor: self, rows, z, joint });
        };
        reduce::both(two, || backward(0..first, head), || backward(first..ends, tail));
    }
}

/// Forward substitution of rows of one part; `z` begins where their columns do.
struct Forward<'a> {
    factor: &'a IncompleteCholesky,
    rows: Range<usize>,
    z: &'a mut [Vec3],
}

impl RowLoop for Forward<'_> {
    type Output = ();

    #[inline(always)]
    fn run<K: Kernel>(self, kernel: K) {
        let Self { factor, rows, z } = self;
        let triangle = &factor.triangle;
        let base = triangle.cut.base(rows.start);
        for row in rows {
            let entries = triangle.entries(row);
            let known = kernel.row_single(&factor.lower[entries.clone()], &triangle.columns[entries], z);
            z[row - base] -= known;
        }
    }
}

/// Backward substitution of rows of one part, whose `z` this is; `joint` is what joins both ends, known already.
struct Backward<'a> {
    factor: &'a IncompleteCholesky,
    rows: Range<usize>,
    z: &'a mut [Vec3],
    joint: &'a [Vec3],
}

impl RowLoop for Backward<'_> {
    type Output = ();

    #[inline(always)]
    fn run<K: Kernel>(self, kernel: K) {
        let Self { factor, rows, z, joint } = self;
        let Triangle { upper_starts, upper_joints, upper_columns, .. } = &factor.triangle;
        let first = rows.start;
        for row in rows.rev() {
            let entries = upper_starts[row] as usize..upper_starts[row + 1] as usize;
            let middle = upper_joints[row] as usize;
            let known = if joint.is_empty() {
                kernel.row_single(&factor.upper[entries.clone()], &upper_columns[entries], z)
            } else {
                let (own, joined) = (entries.start..middle, middle..entries.end);
                let mut known = kernel.row_single(&factor.upper[own.clone()], &upper_columns[own], z);
                if !joined.is_empty() {
                    known += kernel.row_single(&factor.upper[joined.clone()], &upper_columns[joined], joint);
                }
                known
            };
            z[row - first] = factor.inverses[row] * z[row - first] - known;
        }
    }
}
