//! Least squares `Σ r_i²` of places between 0 and 1, by Levenberg and Marquardt.
//!
//! A step `(JᵀJ + λ diag JᵀJ) δ = −Jᵀ r` is of the places that are free: one that stands at a bound which it is drawn beyond is held there, and one that changes nothing
//! stays. A step is taken where it descends; where it does not, or nothing can be said there, `λ` grows. It has converged
//! where the step without damping is no longer than the tolerance, and has stalled where steps became that short without descending.

use rayon::ThreadPool;
use rayon::prelude::*;

use crate::SweepError;

/// Damping at the start, at the least, and the factor by which it falls and grows.
const DAMPING: f64 = 1e-3;
const LEAST_DAMPING: f64 = f64::EPSILON;
const FACTOR: f64 = 10.0;
/// Change of a place for a slope: an error of `√ε` of forward differences.
const DIFFERENCE: f64 = 1e-6;

/// What there is at some places.
#[derive(Debug)]
pub(crate) enum Answer {
    /// Finite numbers, one for each point.
    Residuals(Vec<f64>),
    /// Nothing can be said there, and why.
    Failed(SweepError),
    Interrupted,
}

/// How a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// A step to the least would be no longer than the tolerance.
    Converged,
    /// No step that is longer than the tolerance comes nearer.
    Stalled,
    OutOfIterations,
    Interrupted,
}

pub(crate) struct Problem<'a> {
    pub start: Vec<f64>,
    pub tolerance: f64,
    pub iterations: usize,
    pub residuals: &'a (dyn Fn(&[f64]) -> Result<Answer, SweepError> + Sync),
    /// What is said of a place, by its number, that changes nothing at the start.
    pub without_effect: &'a dyn Fn(usize) -> SweepError,
    pub pool: &'a ThreadPool,
}

pub(crate) struct Solution {
    pub places: Vec<f64>,
    pub residuals: Vec<f64>,
    /// Column after column; empty where it is not known.
    pub jacobian: Vec<Vec<f64>>,
    pub iterations: usize,
    pub runs: usize,
    pub ending: Ending,
}

impl Problem<'_> {
    /// Looks for the least; `watch(iterations, residual)` is told of each step. `None`: it was interrupted before there was anything.
    ///
    /// # Errors
    /// Nothing can be said at the start, a place changes nothing there, or `residuals` fails.
    pub fn solve(&self, watch: &mut dyn FnMut(usize, f64)) -> Result<Option<Solution>, SweepError> {
        let residuals = match (self.residuals)(&self.start)? {
            Answer::Residuals(residuals) => residuals,
            Answer::Failed(why) => return Err(why),
            Answer::Interrupted => return Ok(None),
        };
        let mut found = Solution {
            places: self.start.clone(),
            residuals,
            jacobian: Vec::new(),
            iterations: 0,
            runs: 1,
            ending: Ending::OutOfIterations,
        };
        let mut damping = DAMPING;
        while found.iterations < self.iterations {
            found.iterations += 1;
            let ending = match self.slopes(&mut found)? {
                None => self.step(&mut found, &mut damping)?,
                ending => ending,
            };
            watch(found.iterations, mean_square(&found.residuals).sqrt());
            if let Some(ending) = ending {
                found.ending = ending;
                break;
            }
        }
        Ok(Some(found))
    }

    /// The Jacobian by forward differences, of runs at once.
    fn slopes(&self, found: &mut Solution) -> Result<Option<Ending>, SweepError> {
        let places = &found.places;
        // inwards at the upper bound
        let step_of = |place: f64| if place > 0.5 { -DIFFERENCE } else { DIFFERENCE };
        let beside = |k: usize| {
            let mut beside = places.clone();
            beside[k] += step_of(places[k]);
            (self.residuals)(&beside)
        };
        let answers: Vec<Answer> =
            self.pool.install(|| (0..places.len()).into_par_iter().map(beside).collect::<Result<_, _>>())?;
        found.runs += answers.len();
        let mut jacobian = Vec::new();
        for (answer, place) in answers.iter().zip(places) {
            match answer {
                Answer::Interrupted => return Ok(Some(Ending::Interrupted)),
                // at the brink of what can be run there are no slopes
                Answer::Failed(_) => {
                    found.jacobian.clear();
                    return Ok(Some(Ending::Stalled));
                }
                Answer::Residuals(beside) => {
                    let slope = |(b, r): (&f64, &f64)| (b - r) / step_of(*place);
                    jacobian.push(beside.iter().zip(&found.residuals).map(slope).collect());
                }
            }
        }
        let without_effect = |column: &Vec<f64>| column.iter().all(|slope| *slope == 0.0);
        if found.iterations == 1
            && let Some(index) = jacobian.iter().position(without_effect)
        {
            return Err((self.without_effect)(index));
        }
        found.jacobian = jacobian;
        Ok(None)
    }

    /// A step that descends; how the search ends, where it does.
    fn step(&self, found: &mut Solution, damping: &mut f64) -> Result<Option<Ending>, SweepError> {
        let free = free(found);
        let to = |found: &Solution, damping: f64| {
            damped_step(found, &free, damping).map(|step| moved(&found.places, &step))
        };
        let is_short = |found: &Solution, next: &[f64]| {
            found.places.iter().zip(next).all(|(place, next)| (place - next).abs() <= self.tolerance)
        };
        if to(found, LEAST_DAMPING).is_some_and(|next| is_short(found, &next)) {
            return Ok(Some(Ending::Converged));
        }
        let before = mean_square(&found.residuals);
        loop {
            let Some(next) = to(found, *damping) else {
                // columns that are alike to rounding are told apart by damping; what is no number is not
                *damping *= FACTOR;
                if damping.is_infinite() {
                    return Ok(Some(Ending::Stalled));
                }
                continue;
            };
            if is_short(found, &next) {
                return Ok(Some(Ending::Stalled));
            }
            let tried = (self.residuals)(&next)?;
            found.runs += 1;
            match tried {
                Answer::Interrupted => return Ok(Some(Ending::Interrupted)),
                Answer::Residuals(tried) if mean_square(&tried) < before => {
                    *damping = (*damping / FACTOR).max(LEAST_DAMPING);
                    (found.places, found.residuals) = (next, tried);
                    return Ok(None);
                }
                Answer::Residuals(_) | Answer::Failed(_) => *damping *= FACTOR,
            }
        }
    }
}

/// Places that a step may change: no bound holds them, and they change something.
fn free(found: &Solution) -> Vec<usize> {
    let is_free = |k: &usize| {
        let (place, column) = (found.places[*k], &found.jacobian[*k]);
        let slope = dot(column, &found.residuals);
        let is_held = (place <= 0.0 && slope >= 0.0) || (place >= 1.0 && slope <= 0.0);
        !is_held && column.iter().any(|slope| *slope != 0.0)
    };
    (0..found.places.len()).filter(is_free).collect()
}

fn moved(places: &[f64], step: &[f64]) -> Vec<f64> {
    places.iter().zip(step).map(|(place, step)| (place + step).clamp(0.0, 1.0)).collect()
}

pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

pub(crate) fn mean_square(residuals: &[f64]) -> f64 {
    dot(residuals, residuals) / residuals.len() as f64
}

/// `JᵀJ` of some columns.
fn normal(jacobian: &[Vec<f64>], columns: &[usize]) -> Vec<Vec<f64>> {
    columns.iter().map(|a| columns.iter().map(|b| dot(&jacobian[*a], &jacobian[*b])).collect()).collect()
}

/// `(JᵀJ + λ diag JᵀJ) δ = −Jᵀ r` of the free places; `None` where it has no solution that is a number.
fn damped_step(found: &Solution, free: &[usize], damping: f64) -> Option<Vec<f64>> {
    let mut matrix = normal(&found.jacobian, free);
    for (k, row) in matrix.iter_mut().enumerate() {
        row[k] *= 1.0 + damping;
    }
    let right = free.iter().map(|k| -dot(&found.jacobian[*k], &found.residuals)).collect();
    let of_free = solve(matrix, right)?;
    let mut step = vec![0.0; found.places.len()];
    for (k, change) in free.iter().zip(of_free) {
        step[*k] = change;
    }
    step.iter().all(|change| change.is_finite()).then_some(step)
}

/// The sine of the angle between a column and what the others span, below which it is not told from them: a hundred times
/// the error of a slope.
const ALIKE: f64 = 100.0 * DIFFERENCE;

/// What is known of the places that were found.
pub(crate) struct Certainty {
    /// `√(s² (JᵀJ)⁻¹_kk)`, `s² = Σ r²/(n − k)`, where it is known.
    pub errors: Vec<Option<f64>>,
    /// Places that can be changed together without a change of the residuals.
    pub alike: Vec<usize>,
}

/// Of the slopes where the search ended: `(JᵀJ)⁻¹_kk` is one over the square of what is left of a column beside the others.
pub(crate) fn certainty(found: &Solution) -> Certainty {
    let (count, points) = (found.places.len(), found.residuals.len());
    let mut certainty = Certainty { errors: vec![None; count], alike: Vec::new() };
    let freedom = points.saturating_sub(count);
    for (k, column) in found.jacobian.iter().enumerate().filter(|(_, column)| length(column) > 0.0) {
        let mut basis: Vec<Vec<f64>> = Vec::new();
        for (_, other) in found.jacobian.iter().enumerate().filter(|(index, _)| *index != k) {
            let left = beside(other, &basis);
            let size = length(&left);
            if size > ALIKE * length(other) {
                basis.push(left.iter().map(|entry| entry / size).collect());
            }
        }
        let left = length(&beside(column, &basis));
        if left <= ALIKE * length(column) {
            certainty.alike.push(k);
        } else if freedom > 0 {
            let square = dot(&found.residuals, &found.residuals) / freedom as f64;
            certainty.errors[k] = Some(square.sqrt() / left);
        }
    }
    certainty
}

pub(crate) fn length(column: &[f64]) -> f64 {
    dot(column, column).sqrt()
}

/// What of a column is at right angles to all of an orthonormal basis.
pub(crate) fn beside(column: &[f64], basis: &[Vec<f64>]) -> Vec<f64> {
    let mut left = column.to_vec();
    for direction in basis {
        let along = dot(&left, direction);
        left.iter_mut().zip(direction).for_each(|(entry, direction)| *entry -= along * direction);
    }
    left
}

/// Gaussian elimination with pivots; `None` where the matrix is singular.
pub(crate) fn solve(mut matrix: Vec<Vec<f64>>, mut right: Vec<f64>) -> Option<Vec<f64>> {
    let count = right.len();
    for k in 0..count {
        let pivot = (k..count).max_by(|a, b| matrix[*a][k].abs().total_cmp(&matrix[*b][k].abs()))?;
        matrix.swap(k, pivot);
        right.swap(k, pivot);
        if !(matrix[k][k].abs() > 0.0 && matrix[k][k].is_finite()) {
            return None;
        }
        for i in k + 1..count {
            let factor = matrix[i][k] / matrix[k][k];
            for j in k..count {
                matrix[i][j] -= factor * matrix[k][j];
            }
            right[i] -= factor * right[k];
        }
    }
    for k in (0..count).rev() {
        let above: f64 = (k + 1..count).map(|j| matrix[k][j] * right[j]).sum();
        right[k] = (right[k] - above) / matrix[k][k];
    }
    Some(right)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn search(
        start: &[f64],
        iterations: usize,
        residuals: &(dyn Fn(&[f64]) -> Answer + Sync),
    ) -> Result<Option<Solution>, SweepError> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let problem = Problem {
            start: start.to_vec(),
            tolerance: 1e-6,
            iterations,
            residuals: &|places: &[f64]| Ok(residuals(places)),
            without_effect: &|index| SweepError::value(index.to_string(), "nothing", "an effect"),
            pool: &pool,
        };
        problem.solve(&mut |_, _| {})
    }

    fn failed() -> Answer {
        Answer::Failed(SweepError::value("a", "b", "c"))
    }

    /// Elimination exchanges rows where a pivot is nothing, and says where there is no answer.
    #[test]
    fn systems_are_solved() {
        let found = solve(vec![vec![0.0, 2.0], vec![4.0, 1.0]], vec![6.0, 11.0]).unwrap();
        assert!((found[0] - 2.0).abs() < 1e-15 && (found[1] - 3.0).abs() < 1e-15, "{found:?}");
        assert!(solve(vec![vec![1.0, 2.0], vec![2.0, 4.0]], vec![1.0, 1.0]).is_none());
    }

    /// The least beyond a bound: `(x - 2)² + (x + y - 1.5)²` is least at `x = 1`, `y = 0.5` between 0 and 1.
    #[test]
    fn what_a_bound_holds_leaves_the_rest_free() {
        let residuals = |at: &[f64]| Answer::Residuals(vec![at[0] - 2.0, at[0] + at[1] - 1.5, 0.0]);
        let found = search(&[0.1, 0.1], 50, &residuals).unwrap().unwrap();
        assert_eq!((found.ending, found.places[0]), (Ending::Converged, 1.0));
        assert!((found.places[1] - 0.5).abs() < 1e-6, "{:?}", found.places);
    }

    /// Of `x + y` alone neither is known, however little is left; a third that stands apart is.
    #[test]
    fn what_is_not_told_apart_has_no_error() {
        let residuals = |at: &[f64]| {
            let of = |point: f64| {
                (at[0] + at[1] - 0.9) * point + (at[2] - 0.4) * point * point + 1e-4 * (9.0 * point).sin()
            };
            Answer::Residuals((1..=8).map(|point| of(f64::from(point) / 8.0)).collect())
        };
        let found = search(&[0.2, 0.3, 0.1], 50, &residuals).unwrap().unwrap();
        let Certainty { errors, alike } = certainty(&found);
        assert_eq!((alike, errors[2].is_some()), (vec![0, 1], true));
        assert_eq!(errors[..2], [None, None]);
    }

    /// Where slopes say that it descends and it does not, nothing was found: `|x - 0.3|` behind a wall of what cannot be run.
    #[test]
    fn a_stall_is_no_convergence() {
        let residuals =
            |at: &[f64]| if at[0] < 0.5 { failed() } else { Answer::Residuals(vec![at[0] - 0.3, 0.0]) };
        let found = search(&[0.9], 50, &residuals).unwrap().unwrap();
        assert_eq!(found.ending, Ending::Stalled);
        // nearer than the tolerance, or where a slope cannot be had, before the wall
        assert!((0.5..0.5 + 1e-5).contains(&found.places[0]), "{:?}", found.places);
    }

    /// A trial that fails is a step that is not taken.
    #[test]
    fn failed_trials_are_steps_back() {
        // from 0.05 the first step would lead to 0.92
        let residuals = |at: &[f64]| {
            if at[0] > 0.6 { failed() } else { Answer::Residuals(vec![at[0] * at[0] - 0.09, 0.0]) }
        };
        let found = search(&[0.05], 50, &residuals).unwrap().unwrap();
        assert_eq!(found.ending, Ending::Converged);
        assert!((found.places[0] - 0.3).abs() < 1e-6, "{:?}", found.places);
        assert!(search(&[0.7], 50, &residuals).is_err());
    }

    #[test]
    fn what_changes_nothing_is_told() {
        let residuals = |at: &[f64]| Answer::Residuals(vec![at[0] - 0.5, 0.0, 0.0]);
        let error = search(&[0.1, 0.1], 50, &residuals).err().expect("no effect").to_string();
        assert!(error.starts_with("`1` is nothing"), "{error}");
    }

    /// What was found so far is kept.
    #[test]
    fn interruptions_keep_what_was_found() {
        let count = std::sync::atomic::AtomicUsize::new(0);
        let residuals = |at: &[f64]| match count.fetch_add(1, std::sync::atomic::Ordering::Relaxed) {
            3.. => Answer::Interrupted,
            _ => Answer::Residuals(vec![at[0] * at[0] - 0.25, 0.0]),
        };
        let found = search(&[0.9], 50, &residuals).unwrap().unwrap();
        assert_eq!((found.ending, found.runs), (Ending::Interrupted, 4));
        assert!(found.places[0] < 0.9 && found.residuals.len() == 2);
        assert!(search(&[0.9], 50, &|_| Answer::Interrupted).unwrap().is_none());
        assert_eq!(
            search(&[0.9], 1, &|at: &[f64]| Answer::Residuals(vec![at[0] * at[0] - 0.25, 0.0]))
                .unwrap()
                .unwrap()
                .ending,
            Ending::OutOfIterations
        );
    }
}
