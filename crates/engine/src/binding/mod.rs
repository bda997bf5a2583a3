//! Relations between points that are kept by forces which the step solves for.
//!
//! A relation `g(x, t)` of up to three components is to have the value `w` where a step ends. The force that brings it there is
//! `Jᵀ λ` with the gradients `J = ∂g/∂x` where the step starts, so that the step ends at
//!
//! `x' = x + h v + h² W (f + Jᵀ λ)`, `g(x', t') = w`,
//!
//! with the inverse masses `W`, zero along what pins hold. The multipliers `λ` follow by Newton's method with the matrix of the
//! start, `J W Jᵀ δλ = (w − g(x', t'))/h²`, which is symmetric and as sparse as relations share points. Relations that hold at
//! both ends of a step are those of SHAKE (Ryckaert, Ciccotti & Berendsen 1977): it is symplectic, and of second order.
//!
//! Each component is scaled so that the diagonal of `J W Jᵀ` is one. Relations may repeat each other: the matrix is then singular, and its
//! diagonal is raised by `RAISE`. What is left of that is gone after a few of the solves that are made anyway, and of all forces that do the same those with the least
//! `Σ (J W Jᵀ)_cc λ_c²` are found. Relations that contradict each other are told, not shared out.
//!
//! A relation of one component may yield: `|λ| ≤ Y`, and where that is reached it gives way and what it is to be goes along, `w' = g(x', t')`, a
//! perfectly plastic flow `p` from what it was told. Which do is a quadratic problem between bounds, solved to first order in each iteration
//! of Newton's method (`limits.rs`), and together with the forces of contacts where these push (`pushing.rs`).
//! What yields takes `Y |Δp|`, and works on masses what it is told to change by times its multiplier.

mod commit;
#[cfg(test)]
mod landing;
mod limits;
mod linearise;
mod memory;
mod pushing;
mod solve;
mod structure;

use souple_math::{Mat3, Vec3};
use souple_solve::SolveError;

use crate::force::Configuration;
use crate::steppers::{Step, StepError};
use crate::system::System;
use crate::unilateral::{Bounded, ContactSystem};

pub use memory::{memory_len, multiplier, set_multiplier, yielding_memory_len};
pub(crate) use solve::{Solved, Sought, bind};
pub(crate) use structure::Structure;

use limits::{Flowing, Yielding};

/// Of a diagonal entry, what is added to it: far above rounding, so that relations which repeat others have a pivot, and far
/// below the least eigenvalue of the scaled matrix of thousands of rods in a row, `(π/n)²/2`, so that solves converge.
const RAISE: f64 = 1e-8;
/// How far off a relation may be, of what it changes by when its points move by the greatest coordinate of any of them or by the longest way in the
/// step, and of what it was off by before any force: places are known to `2e-16` of that, and sums over thousands of them to this.
const TOLERANCE: f64 = 1e-12;
/// Likewise, of the numbers of which it is the difference, each known to `1e-16` of itself.
const ROUNDING: f64 = 2e-15;
/// Each takes a share of the error away that is the square of the angle by which gradients turn within the step.
const MOST_SOLVES: u32 = 50;
/// On the diagonal of a component that no force can change, or that has given way: it is not solved for.
const IDLE: f64 = 1.0;

/// What is known of a relation before a step starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Earlier {
    /// Its value one step before.
    Value(Vec3),
    /// `ġ` at the start, where no step led there.
    Rate(Vec3),
}

/// What of a force relates points.
pub trait ConstraintSet: Send + Sync {
    fn relation_count(&self) -> usize;

    /// Rows that a relation is of, each once.
    fn rows(&self, relation: usize) -> &[u32];

    /// `g(x, t)`; zero in the components that it has not.
    fn value(&self, relation: usize, positions: &[Vec3], time: f64) -> Vec3;

    /// What its value repeats by, where it is one number of which whole turns make no difference; 0 of others.
    fn period(&self, _relation: usize) -> f64 {
        0.0
    }

    /// `∂g/∂x` for each of its rows in turn: the gradient of a component in each row of the matrix.
    fn add_gradients(&self, relation: usize, positions: &[Vec3], time: f64, gradients: &mut Vec<Mat3>);

    /// `∂g/∂t` where points stay.
    fn time_rate(&self, relation: usize, positions: &[Vec3], time: f64) -> Vec3;

    /// How large the numbers are of which `g` is the difference.
    fn magnitude(&self, relation: usize, positions: &[Vec3], time: f64) -> Vec3;

    /// Whether what it changes by the second time is told, and not what it is to be.
    fn is_told(&self, relation: usize) -> bool;

    /// The value that it is to have where a step of `timestep` from `start` ends, by what was before and its value where it starts.
    fn wanted(&self, relation: usize, earlier: Earlier, now: Vec3, start: f64, timestep: f64) -> Vec3;

    /// The greatest multiplier, of either sign, by which a relation of one component is kept: where more would be needed it gives way, and stays
    /// as it was then. Such a relation is wanted to be zero. `None` where it is kept by whatever is needed.
    fn yields_at(&self, _relation: usize) -> Option<f64> {
        None
    }

    /// What of a relation that gives way has no meaning any more, in words, where its points went from some places to others within a step.
    fn is_lost_between(&self, _relation: usize, _from: &[Vec3], _to: &[Vec3]) -> Option<&'static str> {
        None
    }

    /// What it is, in words.
    fn describe(&self, relation: usize) -> String;
}

/// `ġ = J v + ∂g/∂t` of points that move so; gradients are scratch.
fn rate(
    set: &dyn ConstraintSet,
    relation: usize,
    (positions, velocities, time): (&[Vec3], &[Vec3], f64),
    gradients: &mut Vec<Mat3>,
) -> Vec3 {
    gradients.clear();
    set.add_gradients(relation, positions, time, gradients);
    let rows = set.rows(relation).iter().zip(gradients.iter());
    let moved: Vec3 = rows.map(|(row, gradient)| *gradient * velocities[*row as usize]).sum();
    moved + set.time_rate(relation, positions, time)
}

/// The value of a relation where whole periods make no difference: the one nearest to another, so that what flows on does not come back.
fn value_near(
    set: &dyn ConstraintSet,
    relation: usize,
    (positions, time): (&[Vec3], f64),
    near: Vec3,
) -> Vec3 {
    nearest(set.value(relation, positions, time), set.period(relation), near)
}

fn nearest(value: Vec3, period: f64, near: Vec3) -> Vec3 {
    if period > 0.0 { value - Vec3::X * (period * ((value.x - near.x) / period).round()) } else { value }
}

/// `out += Jᵀ λ` of the multipliers in a force's memory; gradients are scratch.
pub fn add_forces(set: &dyn ConstraintSet, at: &Configuration, gradients: &mut Vec<Mat3>, out: &mut [Vec3]) {
    for relation in 0..set.relation_count() {
        let multiplier = multiplier(at.memory, relation);
        if multiplier == Vec3::ZERO {
            continue;
        }
        gradients.clear();
        set.add_gradients(relation, at.positions, at.time, gradients);
        for (row, gradient) in set.rows(relation).iter().zip(gradients.iter()) {
            out[*row as usize] += gradient.transpose_apply(multiplier);
        }
    }
}

/// Scratch of the relations of a system, kept between steps.
#[derive(Debug, Default)]
pub(crate) struct ConstraintSolver {
    structure: Option<Structure>,
    /// For each entry of the structure, scaled.
    gradients: Vec<Mat3>,
    /// Of each component `1/√(J W Jᵀ)_cc`, one where no force changes it.
    scales: Vec<Vec3>,
    /// How far off each component may be.
    near: Vec<Vec3>,
    /// What relations are where the step starts.
    now: Vec<Vec3>,
    /// By row [1/kg].
    inverse_masses: Vec<Mat3>,
    /// One step before, and where the step leads [m].
    before: Vec<Vec3>,
    places: Vec<Vec3>,
    /// Where it led before contacts pushed last [m], and the multipliers then.
    unpushed: Vec<Vec3>,
    unpushed_multipliers: Vec<Vec3>,
    /// Of points where the step starts, and where it leads [m/s].
    velocities: Vec<Vec3>,
    led: Vec<Vec3>,
    wanted: Vec<Vec3>,
    /// Of each relation, in the units of its components.
    off: Vec<Vec3>,
    change: Vec<Vec3>,
    /// Scaled, as are those of the step before.
    multipliers: Vec<Vec3>,
    /// The multipliers that the step before ended with.
    before_step: Vec<Vec3>,
    /// Ones in the components that forces change, and that have not given way.
    active: Vec<Vec3>,
    /// Of each relation.
    flowing: Vec<Flowing>,
    /// Those that may give way; likewise those between masses that are all led.
    yielding: Vec<Yielding>,
    led_yielding: Vec<Yielding>,
    /// What those that are held are to change by, and what all changes do to rows.
    held: Vec<Vec3>,
    stride: Vec<Vec3>,
    /// What relations are left off by, scaled.
    left: Vec<Vec3>,
    response: Vec<Vec3>,
    /// Of the relation at hand.
    unscaled: Vec<Mat3>,
    contacts: ContactSystem,
    /// Those that are sought with contacts.
    bounded: Vec<Bounded>,
}

impl System {
    /// Whether forces relate points, or keep gaps open, that a step is to solve for.
    pub fn binds(&self) -> bool {
        self.has_contacts() || self.forces.iter().any(|force| force.constraint_set().is_some())
    }

    fn constraint_set(&self, force: usize) -> Option<&dyn ConstraintSet> {
        self.forces[force].constraint_set()
    }
}

fn unsolved(error: SolveError) -> StepError {
    StepError::Linear { error: error.to_string(), block: None }
}

/// What of a relation a step cannot go on from.
fn fault(step: &Step, structure: &Structure, relation: usize, what: &str) -> StepError {
    let (force, number) = structure.relations[relation];
    let described = step.system.constraint_set(force).map_or_else(String::new, |it| it.describe(number));
    StepError::Fault {
        force: step.system.forces[force].name().to_owned(),
        row: structure.rows[structure.starts[relation]] as usize,
        what: format!("{described} {what}"),
        time: step.start,
    }
}
