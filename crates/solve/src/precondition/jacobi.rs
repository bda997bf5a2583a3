//! The inverse of the diagonal blocks, and no preconditioner at all.

use std::sync::Arc;

use souple_math::{Mat3, Vec3};

use super::{Preconditioner, invert_positive};
use crate::matrix::check_pattern;
use crate::{BlockMatrix, Pattern, SolveError, reduce};

/// `M = I`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Identity;

impl Preconditioner for Identity {
    fn update(&mut self, _: &BlockMatrix) -> Result<(), SolveError> {
        Ok(())
    }

    fn apply(&self, r: &[Vec3], z: &mut [Vec3]) {
        z.copy_from_slice(r);
    }

    fn bytes(&self) -> usize {
        0
    }
}

/// `M = diag(A_rr)`: costs next to nothing and follows any change of values.
#[derive(Clone, Debug)]
pub struct BlockJacobi {
    pattern: Arc<Pattern>,
    inverses: Vec<Mat3>,
}

impl BlockJacobi {
    /// # Errors
    /// A diagonal block is not positive definite.
    pub fn new(matrix: &BlockMatrix) -> Result<Self, SolveError> {
        let pattern = Arc::clone(matrix.pattern());
        let inverses = vec![Mat3::ZERO; pattern.block_count()];
        let mut jacobi = Self { pattern, inverses };
        jacobi.update(matrix)?;
        Ok(jacobi)
    }
}

impl Preconditioner for BlockJacobi {
    fn update(&mut self, matrix: &BlockMatrix) -> Result<(), SolveError> {
        check_pattern(&self.pattern, matrix.pattern())?;
        for (row, inverse) in self.inverses.iter_mut().enumerate() {
            *inverse = invert_positive(&matrix.diagonal_block(row))
                .ok_or(SolveError::NotPositiveDefinite { method: "block_jacobi", block: row })?;
        }
        Ok(())
    }

    fn apply(&self, r: &[Vec3], z: &mut [Vec3]) {
        reduce::for_each_chunk(z, &|first, z: &mut [Vec3]| {
            for ((z, r), inverse) in z.iter_mut().zip(&r[first..]).zip(&self.inverses[first..]) {
                *z = *inverse * *r;
            }
        });
    }

    fn apply_dot(&self, r: &[Vec3], z: &mut [Vec3]) -> f64 {
        reduce::sum_mut(0, z, &|first, z: &mut [Vec3]| {
            for ((z, r), inverse) in z.iter_mut().zip(&r[first..]).zip(&self.inverses[first..]) {
                *z = *inverse * *r;
            }
            reduce::dot_chunk(&r[first..first + z.len()], z)
        })
    }

    fn bytes(&self) -> usize {
        std::mem::size_of_val(self.inverses.as_slice())
    }
}
