//! A direct factor of an earlier matrix.
//!
//! As long as the matrix changes little, a handful of iterations with an old factor is cheaper than a new one.

use souple_math::Vec3;

use super::Preconditioner;
use crate::{BlockMatrix, DirectSolver, SolveError};

/// A Cholesky factor renewed on every `period`-th update.
#[derive(Debug)]
pub struct LaggedFactor {
    solver: DirectSolver,
    period: usize,
    /// Updates since the factor was made.
    age: usize,
}

impl LaggedFactor {
    /// `period`: updates served by one factor, at least one.
    ///
    /// # Errors
    /// The coordinates do not fit, or the matrix is not positive definite.
    pub fn new(
        matrix: &BlockMatrix,
        coordinates: Option<&[Vec3]>,
        period: usize,
    ) -> Result<Self, SolveError> {
        let mut solver = DirectSolver::analyse(matrix.pattern(), coordinates)?;
        solver.factorize(matrix)?;
        Ok(Self { solver, period: period.max(1), age: 0 })
    }

    /// Updates since the factor was made.
    pub fn age(&self) -> usize {
        self.age
    }
}

/// Age and factor decide the bits of later solves: who promises that a resumed run repeats a run keeps the date of
/// the last renewal with the state, and calls [`Preconditioner::rebuild`] at dates computed from it.
impl Preconditioner for LaggedFactor {
    fn update(&mut self, matrix: &BlockMatrix) -> Result<(), SolveError> {
        crate::matrix::check_pattern(self.solver.pattern(), matrix.pattern())?;
        self.age += 1;
        if self.age >= self.period { self.rebuild(matrix) } else { Ok(()) }
    }

    fn rebuild(&mut self, matrix: &BlockMatrix) -> Result<(), SolveError> {
        self.solver.factorize(matrix)?;
        self.age = 0;
        Ok(())
    }

    fn apply(&self, r: &[Vec3], z: &mut [Vec3]) {
        z.copy_from_slice(r);
        if self.solver.solve(z).is_err() {
            // a failed renewal leaves no factor; the identity is a poor preconditioner, but a valid one
            z.copy_from_slice(r);
        }
    }

    fn bytes(&self) -> usize {
        self.solver.bytes()
    }
}
