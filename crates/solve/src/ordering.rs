//! Orders of elimination that keep a factor sparse.
//!
//! Nested dissection: a separator is eliminated after the two sides it parts (George 1973). Thin bodies do as
//! well with a plain sweep along their length; [`best`] counts the work of all and takes the least.

use faer::Side;
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use souple_math::Vec3;

use crate::error::check_length;
use crate::partition::{Bisection, ByCoupling, Geometric, bounds};
use crate::{Pattern, SolveError};

/// Sets of this many blocks are not dissected further.
const LEAF: usize = 24;

/// An order of elimination and what it costs.
pub(crate) struct Order {
    /// The block eliminated at each step.
    pub blocks: Vec<u32>,
    /// Products of blocks in the factorisation.
    pub work: f64,
}

/// The cheapest of the orders known.
pub(crate) fn best(pattern: &Pattern, coordinates: Option<&[Vec3]>) -> Result<Order, SolveError> {
    if let Some(coordinates) = coordinates {
        check_length("coordinates", coordinates.len(), pattern.block_count())?;
        if let Some(block) = coordinates.iter().position(|place| !place.is_finite()) {
            return Err(SolveError::NotFinite { what: "a coordinate", block });
        }
    }
    let by_coupling = nested_dissection(pattern, &mut ByCoupling::new(pattern));
    let mut best = Order { work: elimination_work(pattern, &by_coupling)?, blocks: by_coupling };
    let others = match coordinates {
        Some(coordinates) => vec![
            nested_dissection(pattern, &mut Geometric { coordinates }),
            sweep_along_longest_axis(coordinates),
        ],
        None => {
            let mut blocks = natural(pattern);
            ByCoupling::new(pattern).sweep(&mut blocks);
            vec![blocks]
        }
    };
    for blocks in others {
        let work = elimination_work(pattern, &blocks)?;
        if work < best.work {
            best = Order { blocks, work };
        }
    }
    Ok(best)
}

fn natural(pattern: &Pattern) -> Vec<u32> {
    (0..pattern.block_count() as u32).collect()
}

/// Blocks sorted along the longest axis of their bounds, then along the others.
pub(crate) fn sweep_along_longest_axis(coordinates: &[Vec3]) -> Vec<u32> {
    let mut blocks: Vec<u32> = (0..coordinates.len() as u32).collect();
    let (low, high) = bounds(coordinates, &blocks);
    let extent = high - low;
    let mut axes = [0, 1, 2];
    axes.sort_by(|&a, &b| extent[b].total_cmp(&extent[a]));
    blocks.sort_unstable_by(|&a, &b| {
        let (p, q) = (coordinates[a as usize], coordinates[b as usize]);
        let by_place = axes.iter().map(|&axis| p[axis].total_cmp(&q[axis])).find(|order| order.is_ne());
        by_place.unwrap_or(a.cmp(&b))
    });
    blocks
}

fn nested_dissection(pattern: &Pattern, bisection: &mut impl Bisection) -> Vec<u32> {
    let mut blocks = natural(pattern);
    let mut order = Vec::with_capacity(blocks.len());
    // 1: first side, 2: second side of the set being cut
    let mut side = vec![0_u8; blocks.len()];
    dissect(pattern, bisection, &mut blocks, &mut side, &mut order);
    // built from the last eliminated to the first
    order.reverse();
    order
}

fn dissect(
    pattern: &Pattern,
    bisection: &mut impl Bisection,
    blocks: &mut [u32],
    side: &mut [u8],
    order_from_last: &mut Vec<u32>,
) {
    if blocks.len() <= LEAF {
        order_from_last.extend(blocks.iter().rev());
        return;
    }
    let middle = bisection.split(blocks);
    let (first, second) = blocks.split_at_mut(middle);
    first.iter().for_each(|&block| side[block as usize] = 1);
    second.iter().for_each(|&block| side[block as usize] = 2);

    // the separator: of either side, the blocks coupled to the other; the smaller of the two
    let rim = |blocks: &[u32], other: u8| {
        blocks.iter().filter(|&&b| pattern.row(b as usize).iter().any(|&c| side[c as usize] == other)).count()
    };
    let (of_first, of_second) = (rim(first, 2), rim(second, 1));
    let (cut, other) = if of_first <= of_second { (&mut *first, 2) } else { (&mut *second, 1) };
    let is_rim = |block: u32| pattern.row(block as usize).iter().any(|&c| side[c as usize] == other);
    // stable: what the bisection put in order stays in order
    cut.sort_by_key(|&block| is_rim(block));
    let inner = cut.partition_point(|&block| !is_rim(block));
    order_from_last.extend(cut[inner..].iter().rev());
    let first_length = if other == 2 { inner } else { first.len() };
    let second_length = if other == 2 { second.len() } else { inner };
    first.iter().for_each(|&block| side[block as usize] = 0);
    second.iter().for_each(|&block| side[block as usize] = 0);
    dissect(pattern, bisection, &mut first[..first_length], side, order_from_last);
    dissect(pattern, bisection, &mut second[..second_length], side, order_from_last);
}

/// Multiplications of a Cholesky factorisation of `pattern` in `order`, one number per block.
fn elimination_work(pattern: &Pattern, order: &[u32]) -> Result<f64, SolveError> {
    let place = inverse(order);
    let mut starts = vec![0];
    let mut rows: Vec<u32> = Vec::with_capacity(pattern.slot_count() / 2 + order.len());
    for (step, &block) in order.iter().enumerate() {
        let first = rows.len();
        rows.extend(
            pattern.row(block as usize).iter().map(|&c| place[c as usize]).filter(|&c| c >= step as u32),
        );
        rows[first..].sort_unstable();
        starts.push(rows.len() as u32);
    }
    Ok(work(&analyse_lower(&starts, &rows)?))
}

/// Symbolic factor of the symmetric structure whose lower triangle is given by columns, in the order given.
pub(crate) fn analyse_lower(
    column_starts: &[u32],
    rows: &[u32],
) -> Result<SymbolicCholesky<u32>, SolveError> {
    // without a permutation of its own faer reads the structure from the upper triangle, the values from the lower
    let size = column_starts.len() - 1;
    let mut upper_starts = vec![0_u32; size + 1];
    for &row in rows {
        upper_starts[row as usize + 1] += 1;
    }
    for column in 0..size {
        upper_starts[column + 1] += upper_starts[column];
    }
    let mut next = upper_starts.clone();
    let mut upper_rows = vec![0_u32; rows.len()];
    for column in 0..size {
        for &row in &rows[column_starts[column] as usize..column_starts[column + 1] as usize] {
            let place = &mut next[row as usize];
            upper_rows[*place as usize] = column as u32;
            *place += 1;
        }
    }
    let upper = SymbolicSparseColMatRef::new_checked(size, size, &upper_starts, None, &upper_rows);
    let parameters = CholeskySymbolicParams {
        supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
        ..CholeskySymbolicParams::default()
    };
    factorize_symbolic_cholesky(upper, Side::Upper, SymmetricOrdering::Identity, parameters)
        .map_err(|_| SolveError::OutOfMemory { what: "the structure of a direct factor" })
}

fn work(symbolic: &SymbolicCholesky<u32>) -> f64 {
    let SymbolicCholeskyRaw::Supernodal(symbolic) = symbolic.raw() else { return f64::INFINITY };
    let supernodes = 0..symbolic.n_supernodes();
    supernodes
        .map(|s| {
            let columns = f64::from(symbolic.supernode_end()[s] - symbolic.supernode_begin()[s]);
            let below = symbolic.supernode(s).pattern().len() as f64;
            // Σ (c − k + r)² for k = 0 … c−1, as an integral
            ((columns + below).powi(3) - below.powi(3)) / 3.0
        })
        .sum()
}

/// `inverse[order[i]] = i`.
pub(crate) fn inverse(order: &[u32]) -> Vec<u32> {
    let mut inverse = vec![0; order.len()];
    for (step, &block) in order.iter().enumerate() {
        inverse[block as usize] = step as u32;
    }
    inverse
}
