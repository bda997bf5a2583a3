//! Iterative solution of linear systems.
//!
//! | method | for | memory (vectors) |
//! |---|---|---|
//! | [`conjugate_gradient`] | symmetric positive definite | 4 |
//! | [`gmres`] | any; steady, dearer as it goes on | restart + 3 |
//! | [`bicgstab`] | any; cheap, may stagnate | 8 |
//!
//! All measure the *true* residual: before claiming convergence they compute `b − A x` anew.

mod bicgstab;
mod conjugate_gradient;
mod gmres;

use std::fmt;

use crate::SolveError;

pub use bicgstab::{BicgstabWorkspace, bicgstab};
pub use conjugate_gradient::{ConjugateGradientWorkspace, conjugate_gradient};
pub use gmres::{GmresWorkspace, gmres};

/// When an iteration may stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Wanted `‖b − A x‖ / ‖b‖`.
    pub tolerance: f64,
    pub max_iterations: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self { tolerance: 1e-8, max_iterations: 10_000 }
    }
}

/// Why an iteration stopped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stop {
    /// The true residual is within the tolerance.
    Converged,
    /// The iterations allowed are spent.
    IterationLimit,
    /// Rounding keeps the true residual above the tolerance.
    Stagnated,
    /// A direction `p` of curvature `p · A p ≤ 0` was met; the workspace holds it. `x` is the best so far.
    Indefinite {
        /// `p · A p / p · p`.
        curvature: f64,
    },
    /// The preconditioner gave `r · M⁻¹ r ≤ 0`.
    PreconditionerIndefinite,
    /// A recurrence broke down: two vectors that must not be orthogonal were.
    Breakdown,
    /// A number became infinite or undefined.
    NotFinite,
}

impl fmt::Display for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Converged => write!(f, "converged"),
            Self::IterationLimit => write!(f, "the iterations allowed are spent"),
            Self::Stagnated => write!(f, "rounding keeps the residual above the tolerance"),
            Self::Indefinite { curvature } => {
                write!(f, "the matrix is not positive definite (curvature {curvature:e})")
            }
            Self::PreconditionerIndefinite => write!(f, "the preconditioner is not positive definite"),
            Self::Breakdown => write!(f, "the recurrence broke down"),
            Self::NotFinite => write!(f, "a number became infinite or undefined"),
        }
    }
}

/// What an iteration did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Report {
    pub iterations: usize,
    /// True `‖b − A x‖ / ‖b‖` of the `x` returned; 0 where `b = 0`.
    pub relative_residual: f64,
    pub stop: Stop,
}

impl Report {
    pub fn converged(&self) -> bool {
        self.stop == Stop::Converged
    }

    /// The report, or a typed error of a `method` that missed its tolerance.
    ///
    /// # Errors
    /// The iteration did not converge.
    pub fn checked(self, method: &'static str, settings: &Settings) -> Result<Self, SolveError> {
        if self.converged() {
            return Ok(self);
        }
        let Self { iterations, relative_residual, stop } = self;
        Err(SolveError::NotConverged {
            method,
            iterations,
            relative_residual,
            tolerance: settings.tolerance,
            stop,
        })
    }
}
