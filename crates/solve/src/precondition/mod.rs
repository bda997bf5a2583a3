//! Approximate inverses that make iterations few.
//!
//! A preconditioner is built for one structure and updated with new values, re-using all its buffers.

mod automatic;
mod incomplete_cholesky;
mod jacobi;
mod lagged;
mod local;
mod rigid_modes;
mod table;

use souple_math::{Mat3, Vec3};

use crate::error::check_length;
use crate::{BlockMatrix, SolveError, reduce};

pub use automatic::{Automatic, Choice, weight_of_the_diagonal};
pub use incomplete_cholesky::IncompleteCholesky;
pub use jacobi::{BlockJacobi, Identity};
pub use lagged::LaggedFactor;
pub use rigid_modes::{RigidModes, RigidModesSettings, Smoother};
pub use table::{Build, TABLE};

/// What a block of three unknowns is, as far as rigid motions are concerned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BlockRole {
    /// Displacement of a point: `u = t + ω × x`.
    Point,
    /// Change of a vector that turns with the body (an axis of an affine frame): `u = ω × axis`.
    Axis(Vec3),
    /// Angular velocity of a rigid frame: `u = ω`.
    Rotation,
}

/// Where the blocks of a matrix are.
#[derive(Clone, Copy, Debug, Default)]
pub struct Geometry<'a> {
    /// One place per block (a frame's blocks: its origin) [m]; `None`: unknown.
    pub coordinates: Option<&'a [Vec3]>,
    /// One role per block; `None`: all are points.
    pub roles: Option<&'a [BlockRole]>,
}

impl Geometry<'_> {
    /// All blocks are points, at these places.
    pub fn points(coordinates: &[Vec3]) -> Geometry<'_> {
        Geometry { coordinates: Some(coordinates), roles: None }
    }

    fn check(&self, block_count: usize) -> Result<(), SolveError> {
        if let Some(coordinates) = self.coordinates {
            check_length("coordinates", coordinates.len(), block_count)?;
            if let Some(block) = coordinates.iter().position(|place| !place.is_finite()) {
                return Err(SolveError::NotFinite { what: "a coordinate", block });
            }
        }
        self.roles.map_or(Ok(()), |roles| check_length("roles", roles.len(), block_count))
    }
}

/// An approximate inverse `M⁻¹` of a matrix, symmetric positive definite where that matrix is.
pub trait Preconditioner: Send + Sync {
    /// Follows new values on the same pattern. May keep parts of earlier values where the preconditioner is
    /// meant to lag; see [`Preconditioner::rebuild`].
    ///
    /// # Errors
    /// The matrix has another pattern, or cannot be preconditioned in this manner.
    fn update(&mut self, matrix: &BlockMatrix) -> Result<(), SolveError>;

    /// Forgets all earlier values and takes those of `matrix`: afterwards the preconditioner is the one that
    /// would be built afresh.
    ///
    /// # Errors
    /// As for [`Preconditioner::update`].
    fn rebuild(&mut self, matrix: &BlockMatrix) -> Result<(), SolveError> {
        self.update(matrix)
    }

    /// Takes note of new places of the blocks; counts from the next update. Only preconditioners that know
    /// rigid motions care.
    ///
    /// # Errors
    /// The places do not fit or are not finite; the old ones stay.
    fn follow(&mut self, _coordinates: &[Vec3]) -> Result<(), SolveError> {
        Ok(())
    }

    /// `z = M⁻¹ r`; overwrites `z`.
    fn apply(&self, r: &[Vec3], z: &mut [Vec3]);

    /// `z = M⁻¹ r`; returns `r · z`.
    fn apply_dot(&self, r: &[Vec3], z: &mut [Vec3]) -> f64 {
        self.apply(r, z);
        reduce::dot(r, z)
    }

    /// Bytes held.
    fn bytes(&self) -> usize;
}

/// `A⁻¹` of a symmetric block by its Cholesky factor; `None` where it is not positive definite to rounding.
pub(crate) fn invert_positive(A: &Mat3) -> Option<Mat3> {
    let [a, b, c] = A.columns;
    let tiny = 1e-14 * a.x.max(b.y).max(c.z);
    // leading minors by elimination
    let pivot_1 = a.x;
    let pivot_2 = b.y - a.y * a.y / pivot_1;
    let bc = b.z - a.y * a.z / pivot_1;
    let pivot_3 = c.z - a.z * a.z / pivot_1 - bc * bc / pivot_2;
    if !(pivot_1 > tiny && pivot_2 > tiny && pivot_3 > tiny) {
        return None;
    }
    A.try_inverse().map(|inverse| inverse.symmetric_part())
}
