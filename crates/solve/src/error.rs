//! What can go wrong when a system is built or solved.

use crate::krylov::Stop;

/// A refusal of this crate; names the quantity, its value and what would be accepted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SolveError {
    /// An array does not fit the matrix.
    #[error("{what} has {given} entries, but the system has {expected} blocks")]
    Length { what: &'static str, given: usize, expected: usize },
    /// A coupling refers to a block that does not exist.
    #[error("clique {clique} refers to block {block}, but the system has {block_count} blocks")]
    BlockOutOfRange { clique: usize, block: usize, block_count: usize },
    /// Two blocks that were never declared as coupled.
    #[error("the pattern has no block ({row}, {column}); blocks are stored for pairs that share a clique")]
    NoSlot { row: usize, column: usize },
    /// More than `u32::MAX` blocks.
    #[error("the pattern needs {blocks} blocks, but at most {} can be stored", u32::MAX)]
    TooLarge { blocks: usize },
    /// Two matrices that should share a pattern do not.
    #[error(
        "the matrix has {given_blocks} blocks in {given_rows} rows; expected the pattern of {expected_blocks} \
         blocks in {expected_rows} rows for which this solver was built"
    )]
    OtherPattern { given_rows: usize, given_blocks: usize, expected_rows: usize, expected_blocks: usize },
    /// A pivot is not positive: the matrix is not positive definite (or singular to rounding).
    #[error(
        "the matrix is not positive definite: {method} found a pivot that is not positive at block {block}"
    )]
    NotPositiveDefinite { method: &'static str, block: usize },
    /// A pivot vanishes: the matrix is singular.
    #[error("the matrix is singular: {method} found no usable pivot at block {block}")]
    Singular { method: &'static str, block: usize },
    /// An order of elimination that leaves out blocks or repeats them.
    #[error(
        "the order of elimination holds block {block} twice or out of range; it must hold each of 0..{block_count} once"
    )]
    NoPermutation { block: usize, block_count: usize },
    /// A number that is infinite or not a number.
    #[error("{what} is not finite at block {block}")]
    NotFinite { what: &'static str, block: usize },
    /// An iteration ended without reaching its tolerance.
    #[error(
        "{method} stopped after {iterations} iterations at a relative residual of {relative_residual:.2e}, \
         wanted {tolerance:.2e}: {stop}"
    )]
    NotConverged {
        method: &'static str,
        iterations: usize,
        relative_residual: f64,
        tolerance: f64,
        stop: Stop,
    },
    /// Eigenpairs asked for beyond what the matrix has.
    #[error("{wanted} eigenpairs were asked for, but the system has {available} unknowns")]
    TooManyModes { wanted: usize, available: usize },
    /// The memory for a factor could not be had.
    #[error("not enough memory for {what}; an iterative method with another preconditioner needs less")]
    OutOfMemory { what: &'static str },
    /// The pivots of a factor were asked for before there was one.
    #[error("{method} was asked to solve before a matrix was factorised")]
    NoFactor { method: &'static str },
}

/// `Err` unless an array of `given` entries fits a system of `expected` blocks.
pub(crate) fn check_length(what: &'static str, given: usize, expected: usize) -> Result<(), SolveError> {
    if given == expected { Ok(()) } else { Err(SolveError::Length { what, given, expected }) }
}
