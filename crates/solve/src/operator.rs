//! Linear maps known by what they do to a vector.

use souple_math::Vec3;

use crate::reduce;

/// A square linear map on `[Vec3]`: a stored matrix, or a sum over elements that is never assembled.
pub trait LinearOperator: Sync {
    /// Length of the vectors, in blocks of three.
    fn block_count(&self) -> usize;

    /// `y = A x`; overwrites `y`.
    fn apply(&self, x: &[Vec3], y: &mut [Vec3]);

    /// `y = A x` and the curvature `x · A x`, in one pass where that is cheaper.
    fn apply_dot(&self, x: &[Vec3], y: &mut [Vec3]) -> f64 {
        self.apply(x, y);
        reduce::dot(x, y)
    }

    /// `r = b − A x`; returns `r · r`.
    fn residual(&self, b: &[Vec3], x: &[Vec3], r: &mut [Vec3]) -> f64 {
        self.apply(x, r);
        reduce::sum_mut(0, r, &|first, chunk: &mut [Vec3]| {
            for (r, b) in chunk.iter_mut().zip(&b[first..]) {
                *r = *b - *r;
            }
            reduce::dot_chunk(chunk, chunk)
        })
    }
}
