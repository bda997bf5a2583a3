//! Which relations have given way: a quadratic problem between bounds, to first order where the step leads.
//!
//! Changes `δ` of multipliers are sought with `|λ + δ| ≤ Y` of what yields and `r − (A + ε) δ = 0` where it is within; at its limit that is of the sign of the
//! push, or zero: what is off flows on under it. `A = J W Jᵀ`, scaled, `ε` is [`RAISE`], and `r` is what relations are off by over `h²`. That is the
//! least `½ δ·(A + ε) δ − r·δ` between bounds, of which there is one. It is found by projected Newton steps (Bertsekas 1982): those at a limit which the slope
//! pushes against are held there, the others solved for, and the way there is bent along the bounds and halved until it leads down. Where none of it does,
//! it is gone to the first limit that is met, which stays until the others are solved. Each leads down, so that none comes twice.
//!
//! Contacts are no part of that: which give way under them is found with what they push, see [`super::pushing`].

use souple_math::{Mat3, Vec3};

use crate::state::SystemState;
use crate::steppers::{Step, StepError};

use super::memory::multiplier;
use super::structure::Structure;
use super::{ConstraintSolver, RAISE, Solved, fault};

/// Of a limit, what a multiplier may be beyond it: rounding of a solve whose matrix has the condition `1/RAISE`.
const BEYOND: f64 = 1e-8;
/// Of a limit, what is at it up to rounding.
pub(super) const AT_LIMIT: f64 = 1.0 - 1e-14;
/// Sets that are tried in a step and, besides, for each relation that yields.
const MOST_SWITCHES: [usize; 2] = [100, 10];
/// Halvings of a way that is bent along the bounds.
const HALVINGS: u32 = 8;
/// Of what the slope promises, what a way must lead down by (Armijo).
const DESCENT: f64 = 1e-4;

/// Whether a relation has given way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Flowing {
    Not,
    /// Its multiplier is at the limit.
    Pushing,
    /// It is at the opposite of the limit.
    Pulling,
}

impl Flowing {
    pub(super) fn sign(self) -> f64 {
        match self {
            Self::Not => 0.0,
            Self::Pushing => 1.0,
            Self::Pulling => -1.0,
        }
    }

    /// Of a multiplier against its limit.
    pub(super) fn of(multiplier: f64, limit: f64) -> Self {
        match multiplier {
            beyond if beyond >= limit => Self::Pushing,
            beyond if beyond <= -limit => Self::Pulling,
            _ => Self::Not,
        }
    }
}

/// A relation that yields.
#[derive(Clone, Copy, Debug)]
pub(super) struct Yielding {
    pub(super) relation: u32,
    /// Scaled.
    pub(super) limit: f64,
}

/// What rows respond to.
#[derive(Clone, Copy)]
enum Responding {
    Change,
    /// A part of the way that it is to change by.
    Stride,
}

impl ConstraintSolver {
    /// Begins with those relations yielding that did so in the step before.
    pub(super) fn flow_on(
        &mut self,
        step: &Step,
        structure: &Structure,
        next: &SystemState,
    ) -> Result<(), StepError> {
        self.flowing.clear();
        self.yielding.clear();
        self.led_yielding.clear();
        for (index, (force, relation)) in structure.relations.iter().enumerate() {
            self.flowing.push(Flowing::Not);
            let limit = step.system.constraint_set(*force).and_then(|it| it.yields_at(*relation));
            let Some(limit) = limit else { continue };
            if self.active[index].x > 0.0 {
                self.yielding.push(Yielding { relation: index as u32, limit: limit / self.scales[index].x });
                let before = multiplier(&next.memory[step.system.memory_range(*force)], *relation).x;
                self.flow(index, Flowing::of(before, limit));
            } else if self.has_slope(structure, index) {
                self.led_yielding.push(Yielding { relation: index as u32, limit });
            } else {
                let what = "has given way until masses are where it has no direction to push along";
                return Err(fault(step, structure, index, what));
            }
        }
        Ok(())
    }

    /// Between masses that are all led, where no force changes anything, what is led elsewhere flows under its limit; no force is needed where it is not.
    pub(super) fn flow_as_led(&mut self, step: &Step, structure: &Structure) -> Result<(), StepError> {
        if self.led_yielding.is_empty() {
            return Ok(());
        }
        self.farthest_off(step, structure)?;
        for Yielding { relation, limit } in &self.led_yielding {
            let index = *relation as usize;
            let off = self.off[index].x;
            let flowing = if off.abs() > self.near[index].x { Flowing::of(off, 0.0) } else { Flowing::Not };
            self.flowing[index] = flowing;
            self.multipliers[index].x = flowing.sign() * limit;
        }
        Ok(())
    }

    /// Whether a place of its masses changes its first component.
    fn has_slope(&self, structure: &Structure, index: usize) -> bool {
        let entries = structure.starts[index]..structure.starts[index + 1];
        self.gradients[entries].iter().any(|gradient| gradient.row(0) != Vec3::ZERO)
    }

    pub(super) fn flow(&mut self, index: usize, flowing: Flowing) {
        self.flowing[index] = flowing;
        self.active[index].x = if flowing == Flowing::Not { 1.0 } else { 0.0 };
    }

    /// Whether what gives way pushes with its limit and flows along, and what does not is within, by what relations are off.
    pub(super) fn is_within_limits(&self) -> bool {
        self.yielding.iter().all(|Yielding { relation, limit }| {
            let index = *relation as usize;
            let (sign, multiplier) = (self.flowing[index].sign(), self.multipliers[index].x);
            match self.flowing[index] {
                Flowing::Not => multiplier.abs() <= limit * (1.0 + BEYOND),
                _ => multiplier == sign * limit && self.off[index].x * sign >= -self.near[index].x,
            }
        })
    }

    /// Changes multipliers, and where the step leads with them, by what relations are off there, so that to first order they hold or give way.
    pub(super) fn hold_or_flow(
        &mut self,
        step: &Step,
        structure: &mut Structure,
    ) -> Result<Solved, StepError> {
        if self.yielding.is_empty() {
            self.correct(step, structure)?;
            return Ok(Solved::AsBefore);
        }
        self.change.clear();
        self.change.resize(structure.relation_count(), Vec3::ZERO);
        for Yielding { relation, limit } in &self.yielding {
            let index = *relation as usize;
            let multiplier = self.multipliers[index].x;
            let sign = self.flowing[index].sign();
            let to = if sign == 0.0 { multiplier.clamp(-limit, *limit) } else { sign * limit };
            self.change[index].x = to - multiplier;
        }
        let mut goes_by_limits = false;
        for searches in 0..MOST_SWITCHES[0] + MOST_SWITCHES[1] * self.yielding.len() {
            if searches > 0 {
                self.factorize(step, structure)?;
            }
            self.fall(step, structure);
            self.held.clear();
            let held =
                self.active.iter().zip(&self.left).map(|(active, left)| Mat3::from_diagonal(*active) * *left);
            self.held.extend(held);
            structure.solve(&mut self.held)?;
            if self.is_within(1.0) {
                self.go(1.0);
                self.fall(step, structure);
                if !self.release(step) {
                    self.apply_change(step, structure);
                    return Ok(if searches > 0 { Solved::WithOthers } else { Solved::AsBefore });
                }
                goes_by_limits = false;
            } else if !goes_by_limits && self.descend(structure) {
                self.fall(step, structure);
                self.stay_at_limits();
            } else {
                // what has met its limit stays there until the others are solved, or they would take turns
                goes_by_limits = true;
                self.go_to_first_limit();
            }
        }
        let first = self.yielding.first().map_or(0, |it| it.relation as usize);
        Err(unsettled(step, structure, first))
    }

    // r − (A + ε) δ: along it the quadratic falls
    fn fall(&mut self, step: &Step, structure: &Structure) {
        self.respond(structure, Responding::Change);
        self.left.clear();
        for index in 0..structure.relation_count() {
            let left = self.scaled_off(step, index)
                - self.response_of(structure, index)
                - self.change[index] * RAISE;
            self.left.push(left);
        }
    }

    /// Whether a part of the way leads beyond no limit.
    fn is_within(&self, part: f64) -> bool {
        self.yielding.iter().all(|Yielding { relation, limit }| {
            let index = *relation as usize;
            let to = self.multipliers[index].x + self.change[index].x + part * self.held[index].x;
            self.flowing[index] != Flowing::Not || to.abs() <= limit * (1.0 + BEYOND)
        })
    }

    fn go(&mut self, part: f64) {
        for (change, held) in self.change.iter_mut().zip(&self.held) {
            *change += *held * part;
        }
    }

    /// Lets those hold again that would flow against what they push with; whether there are any.
    fn release(&mut self, step: &Step) -> bool {
        let mut is_any = false;
        for place in 0..self.yielding.len() {
            let index = self.yielding[place].relation as usize;
            let sign = self.flowing[index].sign();
            if self.left[index].x * sign < -self.scaled_near(step, index) {
                self.flow(index, Flowing::Not);
                is_any = true;
            }
        }
        is_any
    }

    /// Goes along the way as far as it leads down, bent along the bounds; whether it does.
    fn descend(&mut self, structure: &Structure) -> bool {
        for halving in 0..HALVINGS {
            let part = 0.5_f64.powi(halving as i32);
            self.stride.clear();
            self.stride.extend(self.held.iter().map(|held| *held * part));
            for Yielding { relation, limit } in &self.yielding {
                let index = *relation as usize;
                let from = self.multipliers[index].x + self.change[index].x;
                self.stride[index].x = (from + self.stride[index].x).clamp(-limit, *limit) - from;
            }
            self.respond(structure, Responding::Stride);
            let (mut slope, mut curvature) = (0.0, 0.0);
            for index in 0..structure.relation_count() {
                let stride = self.stride[index];
                slope -= self.left[index].dot(stride);
                curvature += stride.dot(self.response_of(structure, index) + stride * RAISE);
            }
            if slope < 0.0 && slope + 0.5 * curvature < DESCENT * slope {
                for (change, stride) in self.change.iter_mut().zip(&self.stride) {
                    *change += *stride;
                }
                return true;
            }
        }
        false
    }

    /// Lets those give way that are at a limit, up to rounding, and are pushed against it.
    fn stay_at_limits(&mut self) {
        for place in 0..self.yielding.len() {
            let Yielding { relation, limit } = self.yielding[place];
            let index = relation as usize;
            let (multiplier, left) = (self.multipliers[index].x + self.change[index].x, self.left[index].x);
            let near = limit * AT_LIMIT;
            let flowing = match multiplier {
                at if at >= near && left > 0.0 => Flowing::Pushing,
                at if at <= -near && left < 0.0 => Flowing::Pulling,
                _ => Flowing::Not,
            };
            self.flow(index, flowing);
            if flowing != Flowing::Not {
                self.change[index].x = flowing.sign() * limit - self.multipliers[index].x;
            }
        }
    }

    /// Goes along the way to the first limit that is met, and lets what meets it give way.
    fn go_to_first_limit(&mut self) {
        let mut first: Option<(f64, usize, Flowing, f64)> = None;
        for Yielding { relation, limit } in &self.yielding {
            let index = *relation as usize;
            let (from, by) = (self.multipliers[index].x + self.change[index].x, self.held[index].x);
            if self.flowing[index] != Flowing::Not || by == 0.0 {
                continue;
            }
            let part = ((by.signum() * limit - from) / by).max(0.0);
            if first.is_none_or(|(known, ..)| part < known) {
                first = Some((part, index, Flowing::of(by, 0.0), *limit));
            }
        }
        let Some((part, index, flowing, limit)) = first else { return };
        self.go(part.min(1.0));
        self.flow(index, flowing);
        self.change[index].x = flowing.sign() * limit - self.multipliers[index].x;
    }

    /// Pushes by the change at hand; limits are what those that flow push with, to the last bit.
    pub(super) fn apply_change(&mut self, step: &Step, structure: &Structure) {
        self.push(step, structure);
        for Yielding { relation, limit } in &self.yielding {
            let index = *relation as usize;
            if self.flowing[index] != Flowing::Not {
                self.multipliers[index].x = self.flowing[index].sign() * limit;
            }
        }
    }

    /// What a relation is off by, scaled and over the square of the step.
    pub(super) fn scaled_off(&self, step: &Step, index: usize) -> Vec3 {
        Mat3::from_diagonal(self.scales[index]) * self.off[index] / (step.timestep * step.timestep)
    }

    /// How far a relation may be off, likewise.
    fn scaled_near(&self, step: &Step, index: usize) -> f64 {
        self.near[index].x * self.scales[index].x / (step.timestep * step.timestep)
    }

    // W Jᵀ δ
    fn respond(&mut self, structure: &Structure, to: Responding) {
        self.response.clear();
        self.response.resize(self.inverse_masses.len(), Vec3::ZERO);
        let multipliers = match to {
            Responding::Change => &self.change,
            Responding::Stride => &self.stride,
        };
        structure.spread(1.0, multipliers, &self.gradients, &self.inverse_masses, &mut self.response);
    }

    // J (W Jᵀ δ)
    fn response_of(&self, structure: &Structure, index: usize) -> Vec3 {
        let entries = structure.starts[index]..structure.starts[index + 1];
        entries.map(|entry| self.gradients[entry] * self.response[structure.rows[entry] as usize]).sum()
    }
}

fn unsettled(step: &Step, structure: &Structure, index: usize) -> StepError {
    let (force, relation) = structure.relations[index];
    StepError::LimitsUnsettled {
        force: step.system.forces[force].name().to_owned(),
        relation: step.system.constraint_set(force).map_or_else(String::new, |it| it.describe(relation)),
        row: structure.rows[structure.starts[index]] as usize,
        time: step.end(),
    }
}
