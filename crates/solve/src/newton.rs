//! Newton's method with a line search.
//!
//! The unknowns belong to the problem, which alone knows how to move them (rotations are not added to):
//! Newton sees residuals, directions and fractions of steps.

use souple_math::Vec3;

use crate::krylov;
use crate::reduce;

/// Whether a trial configuration can be evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trial {
    Admissible,
    /// The step left the domain (an inverted element, a number that is not finite): a shorter one is wanted.
    TooLong,
}

/// A system of equations `r(q) = 0` on unknowns that only the problem can move.
///
/// Where there is a merit function `Φ`, `r = −∂Φ/∂q`: residuals are forces.
pub trait NewtonProblem {
    type Error;

    /// Length of residuals and directions, in blocks.
    fn block_count(&self) -> usize;

    /// `r` at the current configuration (the trial one after [`NewtonProblem::try_step`]); overwrites `out`.
    fn residual(&mut self, out: &mut [Vec3]) -> Result<Trial, Self::Error>;

    /// `d` with `−(∂r/∂q) d = r` at the accepted configuration, to the accuracy the problem sees fit;
    /// overwrites `out`, and reports the linear solve if it was iterative.
    fn direction(
        &mut self,
        residual: &[Vec3],
        out: &mut [Vec3],
    ) -> Result<Option<krylov::Report>, Self::Error>;

    /// Makes `retract(accepted, fraction · direction)` the current configuration; fraction 0 returns to the
    /// accepted one.
    fn try_step(&mut self, direction: &[Vec3], fraction: f64) -> Result<Trial, Self::Error>;

    /// Makes the current configuration the accepted one.
    fn accept(&mut self) -> Result<(), Self::Error>;

    /// `Φ` at the current configuration (an incremental potential), if the problem has one. Without it the
    /// norm of the residual must fall.
    fn merit(&mut self) -> Result<Option<f64>, Self::Error> {
        Ok(None)
    }

    /// Whether `r = −∂Φ/∂q` of a `Φ` that cannot be computed, as symmetric tangents tell. The search then goes by
    /// the slopes of `Φ` along the step instead of the norm of the residual, which may have minima of its own.
    fn is_gradient(&self) -> bool {
        false
    }

    /// Size of the forces that balance in `r`, which relative tolerances refer to; `None`: the first residual.
    fn residual_scale(&mut self) -> Option<f64> {
        None
    }

    /// Whether a direction is no longer than the rounding of the unknowns themselves, so that following it
    /// changes nothing that can be represented.
    fn is_negligible(&self, _direction: &[Vec3]) -> bool {
        false
    }

    /// `‖r‖` that rounding alone makes near the accepted configuration: nothing below it can be asked for.
    fn rounding(&mut self) -> f64 {
        0.0
    }
}

/// When Newton may stop, and how it searches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Wanted `‖r‖` relative to [`NewtonProblem::residual_scale`].
    pub relative_tolerance: f64,
    /// `‖r‖` that is good enough whatever the scale.
    pub absolute_tolerance: f64,
    pub max_iterations: usize,
    /// Halvings of a step before it is given up.
    pub max_halvings: usize,
    /// Fraction `c` of the decrease foretold by the slope that a step must bring (Armijo).
    pub sufficient_decrease: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            relative_tolerance: 1e-9,
            absolute_tolerance: 0.0,
            max_iterations: 50,
            max_halvings: 30,
            sufficient_decrease: 1e-4,
        }
    }
}

/// Why Newton stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    Converged,
    IterationLimit,
    /// No fraction of the step was an improvement: usually the tangent is wrong or the tolerance is below
    /// rounding.
    NoDecrease,
    /// The direction climbs: the tangent is not positive definite. Without a merit function: the direction
    /// is not finite.
    NotDescent,
    /// The residual of the first configuration is not finite or not admissible.
    BadStart,
}

/// What Newton did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Report {
    /// Steps accepted.
    pub iterations: usize,
    /// Iterations of the linear solver in all.
    pub linear_iterations: usize,
    /// `‖r‖` of the accepted configuration.
    pub residual: f64,
    pub stop: Stop,
}

impl Report {
    pub fn converged(&self) -> bool {
        self.stop == Stop::Converged
    }
}

/// Vectors and history of a solve; keep it and nothing is allocated again.
#[derive(Clone, Debug, Default)]
pub struct Workspace {
    residual: Vec<Vec3>,
    trial_residual: Vec<Vec3>,
    direction: Vec<Vec3>,
    residuals: Vec<f64>,
    fractions: Vec<f64>,
}

impl Workspace {
    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let vectors = [&self.residual, &self.trial_residual, &self.direction];
        vectors.into_iter().map(|vector| size_of::<Vec3>() * vector.capacity()).sum::<usize>()
            + 8 * (self.residuals.capacity() + self.fractions.capacity())
    }

    /// `‖r‖` before the first step and after each.
    pub fn residuals(&self) -> &[f64] {
        &self.residuals
    }

    /// The fraction of each step that was taken.
    pub fn fractions(&self) -> &[f64] {
        &self.fractions
    }
}

/// Solves `r(q) = 0` from the problem's current configuration. The accepted configuration is always the best
/// found; errors of the problem end the search and are passed on.
///
/// # Errors
/// Those of the problem.
pub fn newton<P: NewtonProblem + ?Sized>(
    problem: &mut P,
    settings: &Settings,
    workspace: &mut Workspace,
) -> Result<Report, P::Error> {
    let Workspace { residual: r, trial_residual, direction: d, residuals, fractions } = workspace;
    for vector in [&mut *r, &mut *trial_residual, &mut *d] {
        vector.resize(problem.block_count(), Vec3::ZERO);
    }
    residuals.clear();
    fractions.clear();

    let mut linear_iterations = 0;
    let start = problem.residual(r)?;
    let mut norm = reduce::norm(r);
    let mut merit = problem.merit()?;
    residuals.push(norm);
    let report = |iterations, linear_iterations, residual, stop| Report {
        iterations,
        linear_iterations,
        residual,
        stop,
    };
    if start == Trial::TooLong || !norm.is_finite() || merit.is_some_and(|merit| !merit.is_finite()) {
        return Ok(report(0, 0, norm, Stop::BadStart));
    }
    let scale = problem.residual_scale().unwrap_or(norm);
    let target = settings.absolute_tolerance.max(settings.relative_tolerance * scale);

    for iteration in 0..=settings.max_iterations {
        if norm <= target.max(problem.rounding()) {
            return Ok(report(iteration, linear_iterations, norm, Stop::Converged));
        }
        if iteration == settings.max_iterations {
            break;
        }
        linear_iterations += problem.direction(r, d)?.map_or(0, |report| report.iterations);
        if problem.is_negligible(d) {
            return Ok(report(iteration, linear_iterations, norm, Stop::Converged));
        }
        // ∂Φ/∂q · d = −r · d
        let slope = -reduce::dot(r, d);
        let is_gradient = merit.is_none() && problem.is_gradient();
        if !(slope.is_finite() && (slope < 0.0 || merit.is_none() && !is_gradient)) {
            return Ok(report(iteration, linear_iterations, norm, Stop::NotDescent));
        }

        let mut fraction = 1.0;
        let mut taken = None;
        for _ in 0..=settings.max_halvings {
            if let Some((trial_norm, trial_merit)) = evaluate(problem, d, fraction, trial_residual)? {
                let c = settings.sufficient_decrease;
                let lower = match (merit, trial_merit) {
                    (Some(before), Some(after)) => {
                        // the change of Φ drowns in its rounding where Φ is a sum of large terms that cancel;
                        // the slopes at both ends do not: ΔΦ ≈ (slope + slope after) fraction/2
                        let slope_after = -reduce::dot(trial_residual, d);
                        after <= before + c * fraction * slope
                            || (trial_norm <= norm && slope_after <= (2.0 * c - 1.0) * slope)
                    }
                    // ΔΦ ≈ (slope + slope after) fraction/2 ≤ c fraction slope
                    _ if is_gradient => {
                        let slope_after = -reduce::dot(trial_residual, d);
                        slope_after <= (2.0 * c - 1.0) * slope
                    }
                    _ => trial_norm <= (1.0 - c * fraction) * norm,
                };
                if lower {
                    taken = Some((trial_norm, trial_merit));
                    break;
                }
            }
            fraction *= 0.5;
        }
        let Some((trial_norm, trial_merit)) = taken else {
            problem.try_step(d, 0.0)?;
            return Ok(report(iteration, linear_iterations, norm, Stop::NoDecrease));
        };
        problem.accept()?;
        std::mem::swap(r, trial_residual);
        (norm, merit) = (trial_norm, trial_merit);
        residuals.push(norm);
        fractions.push(fraction);
    }
    Ok(report(settings.max_iterations, linear_iterations, norm, Stop::IterationLimit))
}

/// Residual norm and merit after a fraction of a step; `None` where the step is too long to have them.
fn evaluate<P: NewtonProblem + ?Sized>(
    problem: &mut P,
    direction: &[Vec3],
    fraction: f64,
    residual: &mut [Vec3],
) -> Result<Option<(f64, Option<f64>)>, P::Error> {
    if problem.try_step(direction, fraction)? == Trial::TooLong
        || problem.residual(residual)? == Trial::TooLong
    {
        return Ok(None);
    }
    let norm = reduce::norm(residual);
    let merit = problem.merit()?;
    let finite = norm.is_finite() && merit.is_none_or(f64::is_finite);
    Ok(finite.then_some((norm, merit)))
}
