//! Block-sparse matrices, preconditioned Krylov methods, direct factors, Newton.
//!
//! No physics: an unknown vector is a slice of [`souple_math::Vec3`], a matrix is sparse with 3×3 blocks.
//! Sums run in an order fixed by the length of the vectors alone, so results have the same bits for
//! any number of threads.
#![allow(non_snake_case)] // symbols of the mathematics: A, L, S

pub mod dense;
pub mod direct;
mod error;
mod kernel;
pub mod krylov;
mod lu;
mod mass_basis;
mod matrix;
pub mod modes;
pub mod newton;
mod operator;
mod ordering;
mod partition;
mod pattern;
pub mod precondition;
pub mod quadratic;
pub mod reduce;
pub mod ritz;
pub mod solvers;
mod spare;

pub use direct::{DirectSolver, RoundedFactor};
pub use error::SolveError;
pub use lu::LuSolver;
pub use matrix::BlockMatrix;
pub use operator::LinearOperator;
pub use pattern::{Pattern, PatternBuilder};
pub use precondition::Preconditioner;
