//! Unilateral constraints: gaps that are not to close, kept open by forces and impulses that push and never pull.
//!
//! A contact has a gap `g(x, t)` with the unit normal `n` along which its points part, and the tangents `t`. A step that starts at `x` with `v` and
//! ends at `x' = x + h v'` finds, for all contacts of a system at once and together with what keeps relations ([`crate::binding`]), forces with
//!
//! - `0 ≤ f_n ⊥ g(x', t') − w ≥ 0`: signs, and one of the two zero;
//! - `|f_t| ≤ μ f_n`, `f_t = 0` with slip against it, `f_t = −μ f_n u_t/|u_t|`, or `u_t = 0` (Coulomb), with the slip `u_t` of the velocity `v'`.
//!
//! What is wanted, `w`, is 0 of contacts that rest or come to: they end closed, not deeper. Of one that would close in this step and whose gap narrowed in the
//! step before, it is `g + ε h |ġ|`: its points part with `ε` times the velocity of their approach (Newton's law of restitution). Forces that act for one step
//! are impulses `h f` then. That is the time stepping of Moreau (1988) and of Stewart & Trinkle (1996), with gaps as they are where the step ends
//! in place of their linearisations: nothing creeps into what it slides along. An elastic impact is the reversal of the step that led to it, to rounding.
//!
//! Forces follow by a projected Gauss–Seidel method over contacts, whose changes are extrapolated as those of conjugate gradients are, with the
//! matrix `D = h² J W̃ Jᵀ` of what forces move contacts by. `W̃` are inverse masses with relations: a rigid body is masses on exact rods. Where sweeps do not
//! settle soon, as along chains of bodies, conjugate residuals follow over what sweeps have left free (`face.rs`), and sweeps that judge what these found
//! (Silcowitz-Hansen, Niebe & Erleben 2010). Multipliers of relations that yield are sought beside contacts, within bounds in the place of cones, where
//! these decide which of them give way ([`crate::binding`]); the other relations are eliminated then.
//! Where more contacts bear than are needed, of all forces that do the same those are found that are near to those of the step before.

#[cfg(test)]
mod chains;
mod commit;
mod delassus;
mod face;
mod gauss_seidel;
mod jammed;
mod places;
mod search;

use souple_math::{Mat3, Vec3};

use crate::binding::{Solved, Structure};
use crate::state::{Pair, SystemState, pairs_of};
use crate::steppers::{Step, StepError, StepReport};
use crate::system::System;

use face::Face;
pub(crate) use places::Bounded;
use places::{Entry, Place};

/// Of the greatest way by which a gap would be missed without forces: contacts that are off by less are solved. What several contacts
/// of a body ask of it must agree to this, or they hand forces on to each other without end: relations hold well below it.
const CONVERGED: f64 = 1e-7;
/// Likewise, what is let pass when no sweeps are left; the report of the step tells it.
const LET_PASS: f64 = 1e-4;
/// Of how far off contacts may be by rounding, what is let pass of jammed bodies too: a millionth of coordinates, or of the longest
/// way of the step. Bodies that are jammed move from step to step along what Coulomb's law has no one answer for, by ways that nobody sees.
const WEDGED: f64 = 1e5;
/// Of coordinates, or of the longest way in the step: ten times what relations are off by, for the same reason.
const TOLERANCE: f64 = 1e-11;
/// Of coordinates of a body, what its relations are off by.
const OF_RELATIONS: f64 = 1e-12;
/// Sweeps over all contacts of a step, and products in the place of sweeps; as many again each time that contacts are found jammed.
const MOST_SWEEPS: u64 = 20_000;
/// Sweeps after which forces are sought on the face that they have found, products with `D` of that search, more where there are more contacts, and sweeps after it. These are a round, after
/// which it is looked where the step leads: what contacts of a body do not agree about to rounding is not swept away.
const SWEEPS_BEFORE: u64 = 60;
const PRODUCTS: u64 = 100;
const SWEEPS_AFTER: u64 = 30;
/// Each makes the curvature of gaps and relations within the step the square of what it was, finds contacts that others push together, or spends its sweeps.
const MOST_ROUNDS: u32 = 400;
/// Of how far off contacts may be, what they may be after another search with multipliers between bounds than after the one before: relations that
/// hold after it share out anew what it has left.
const TIGHTER: f64 = 0.1;
/// Points of a contact, at most: of two, or one against a triangle.
pub const MOST_SIDES: usize = 4;

/// What happens where a gap is closed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpactLaw {
    /// `ε`, from 0, where nothing bounces, to 1.
    pub restitution: f64,
    /// `μ`.
    pub friction: f64,
}

/// The points of a contact, whose relative velocity is `Σ w v`: weights of what is on one side add up to 1, those on the other to −1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sides {
    rows: [u32; MOST_SIDES],
    weights: [f64; MOST_SIDES],
    count: usize,
    /// How many of them are on the first side.
    first: usize,
}

impl Sides {
    /// One point against what is no point.
    pub fn one(row: u32) -> Self {
        Self::between([(row, 1.0)], [])
    }

    /// Two points.
    pub fn two([a, b]: [u32; 2]) -> Self {
        Self::between([(a, 1.0)], [(b, 1.0)])
    }

    /// Points with their shares of a place, against others with theirs; at most [`MOST_SIDES`] in all.
    pub fn between<const A: usize, const B: usize>(first: [(u32, f64); A], second: [(u32, f64); B]) -> Self {
        const { assert!(A + B <= MOST_SIDES) };
        let mut sides = Self { rows: [0; MOST_SIDES], weights: [0.0; MOST_SIDES], count: A + B, first: A };
        let all = first.into_iter().chain(second.map(|(row, share)| (row, -share)));
        for (place, (row, weight)) in all.enumerate() {
            (sides.rows[place], sides.weights[place]) = (row, weight);
        }
        sides
    }

    /// Rows with their weights.
    pub fn iter(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let rows = self.rows[..self.count].iter().map(|row| *row as usize);
        rows.zip(self.weights[..self.count].iter().copied())
    }

    /// Those of the first side, with their shares of the force.
    pub fn first(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.iter().take(self.first)
    }

    /// Those of the second side, with their shares of the opposite force.
    pub fn second(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.iter().skip(self.first).map(|(row, weight)| (row, -weight))
    }

    /// The sum of weights, without their signs.
    fn weight(&self) -> f64 {
        self.iter().map(|(_, weight)| weight.abs()).sum()
    }

    fn relative(&self, of_rows: impl Fn(usize) -> Vec3) -> Vec3 {
        self.iter().map(|(row, weight)| of_rows(row) * weight).sum()
    }
}

/// What of a force keeps gaps open. Numbers of contacts are below [`Unilateral::contact_count`], of the pairs at hand.
///
/// Its first number of memory is the work that its forces have done [J].
pub trait Unilateral: Send + Sync {
    fn contact_count(&self, pairs: &[Pair]) -> usize;

    /// Its points where these are.
    fn sides(&self, contact: usize, pairs: &[Pair], positions: &[Vec3]) -> Sides;

    /// `g(x, t)`, negative where it is closed too far.
    fn gap(&self, contact: usize, pairs: &[Pair], positions: &[Vec3], time: f64) -> f64;

    /// What the gap changes by with the relative place of its points, `∂g/∂(Σ w x)`; zero where no direction opens it.
    fn slope(&self, contact: usize, pairs: &[Pair], positions: &[Vec3], time: f64) -> Vec3;

    /// Of what points are against, where that is no point [m/s].
    fn surface_velocity(&self, _contact: usize, _time: f64) -> Vec3 {
        Vec3::ZERO
    }

    fn law(&self) -> ImpactLaw;

    /// On the points of weight one, as it was found last [N].
    fn force(&self, contact: usize, memory: &[f64], pairs: &[Pair]) -> Vec3;

    fn set_force(&self, contact: usize, memory: &mut [f64], pairs: &mut [Pair], force: Vec3);

    /// What it is, in words.
    fn describe(&self, contact: usize, pairs: &[Pair]) -> String;
}

/// What a step that is being made stands on.
pub(crate) struct Moving<'a> {
    pub step: &'a Step<'a>,
    pub structure: &'a Structure,
    /// How relations were solved for last.
    pub solved: Solved,
    /// Where the step starts [m].
    pub positions: &'a [Vec3],
    /// One step before [m].
    pub before: &'a [Vec3],
    /// By row [1/kg].
    pub inverse_masses: &'a [Mat3],
    /// Scaled, for each entry of the structure.
    pub gradients: &'a [Mat3],
    /// Ones in the components of relations that forces change.
    pub active: &'a [Vec3],
    /// Of each row: those of one body move each other by relations that are solved for.
    pub bodies: &'a [u32],
    /// Multipliers of other relations, that are swept for.
    pub bounded: &'a [Bounded],
}

/// What was done about forces of contacts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Improved {
    Nothing,
    /// They were changed.
    Forces,
    /// They were taken away, and are sought anew of jammed bodies.
    BegunAnew,
}

/// A contact in a step. Vectors are along the normal and two tangents.
#[derive(Clone, Copy, Debug)]
struct Contact {
    /// Index in the system, and the number within the force.
    of: (usize, usize),
    sides: Sides,
    /// Rows are the normal and the tangents.
    frame: Mat3,
    /// `|∂g/∂x|`.
    steepness: f64,
    law: ImpactLaw,
    /// Where the step starts, over the steepness [m].
    gap: f64,
    /// Change of the gap in the step before, likewise [m].
    narrowing: f64,
    /// The gap at the end, likewise [m].
    wanted: f64,
    /// Whether it is asked less than the law ([`jammed`]).
    is_jammed: bool,
    /// How far what points are against moves in the step [m].
    carried: Vec3,
    /// [N]
    force: Vec3,
    /// Of the step before [N].
    force_before: Vec3,
    /// How far off it may be by rounding [m].
    near: f64,
}

/// Scratch of the contacts of a system, kept between steps.
#[derive(Debug, Default)]
pub(crate) struct ContactSystem {
    contacts: Vec<Contact>,
    /// Numbers of those that forces are sought of, ascending, and how far each is off where the step leads.
    sought: Vec<u32>,
    off: Vec<Vec3>,
    /// Of each contact, whether forces are sought of it.
    is_sought: Vec<bool>,
    /// Those that are sought, and multipliers beside them; what each moves.
    places: Vec<Place>,
    entry_starts: Vec<usize>,
    entries: Vec<Entry>,
    /// `(body, place)`, sorted.
    touches: Vec<(u32, u32)>,
    /// `D` by rows: where those of each begin, columns ascending, blocks [m/N].
    starts: Vec<usize>,
    columns: Vec<u32>,
    blocks: Vec<Mat3>,
    /// Of each place the slot on the diagonal, `D_nn`, and the greatest eigenvalue of `D_tt`.
    own: Vec<usize>,
    stiffest: Vec<[f64; 2]>,
    /// What forces are changed by, in all and in a sweep, and the direction that changes go on in.
    change: Vec<Vec3>,
    swept: Vec<Vec3>,
    direction: Vec<Vec3>,
    response: Vec<Vec3>,
    /// Of the search on a face.
    face: Face,
    /// Places that are to be jammed, with what hangs together with them.
    waiting: Vec<u32>,
    /// The greatest coordinate of a body, at its least row [m].
    reaches: Vec<f64>,
    /// The greatest way by which a gap or a slip is off without forces [m].
    scale: f64,
    /// Of how far off they may be, what sweeps go on to.
    tightness: f64,
    rounds: u32,
    /// Whether `D` was laid out with multipliers among the places, or before contacts were jammed.
    is_laid_out_otherwise: bool,
    /// Whether it is known in this step which collide.
    are_decided: bool,
    /// Whether there are contacts that are asked less, and how many sweeps were spent when they were begun to be.
    is_jammed: bool,
    spent: u64,
    report: StepReport,
}

impl System {
    /// Whether forces keep gaps open that a step is to solve for.
    pub fn has_contacts(&self) -> bool {
        self.forces.iter().any(|force| force.unilateral().is_some())
    }
}

fn pairs_in(state: &SystemState, force: usize) -> &[Pair] {
    &state.pairs[pairs_of(&state.pairs, force)]
}

fn described(step: &Step, state: &SystemState, (force, number): (usize, usize)) -> String {
    let unilateral = step.system.forces[force].unilateral();
    unilateral.map_or_else(String::new, |it| it.describe(number, pairs_in(state, force)))
}

/// What of a contact a step cannot go on from.
fn fault(moving: &Moving, state: &SystemState, of: (usize, usize), what: &str) -> StepError {
    let step = moving.step;
    let unilateral = step.system.forces[of.0].unilateral();
    let sides = unilateral.map(|it| it.sides(of.1, pairs_in(state, of.0), moving.positions));
    StepError::Fault {
        force: step.system.forces[of.0].name().to_owned(),
        row: sides.map_or(0, |sides| sides.rows[0] as usize),
        what: format!("{} {what}", described(step, state, of)),
        time: step.start,
    }
}
