//! Which relations give way under contacts.
//!
//! What contacts push with is found for those that give way at the time. Where multipliers are beyond limits then, or what has given way would flow against its
//! push, these are switched: all of them as long as they get fewer, else one by one by the least number, as in principal pivoting by blocks (Júdice &
//! Pires 1994; Murty 1974).

use souple_math::{Mat3, Vec3};

use crate::steppers::{Step, StepError};

use super::limits::{BEYOND, Flowing, MOST_SWITCHES, Responding, Yielding, unsettled};
use super::structure::Structure;
use super::{ConstraintSolver, RAISE};

/// Switches of all at once that may leave as many on the wrong side as there were.
const TRIES: u32 = 5;

/// A relation on the wrong side, and what it is to be.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wrong {
    relation: u32,
    to: Flowing,
}

/// How far the search for those that give way under contacts has come.
#[derive(Debug)]
pub(super) struct Pivoting {
    fewest: usize,
    tries: u32,
    switches: usize,
}

impl Default for Pivoting {
    fn default() -> Self {
        Self { fewest: usize::MAX, tries: TRIES, switches: 0 }
    }
}

impl Pivoting {
    /// Keeps of those on the wrong side, by rising numbers, such as are to be switched; how many sets have been tried.
    fn choose(&mut self, wrong: &mut Vec<Wrong>) -> usize {
        self.switches += 1;
        if wrong.len() < self.fewest {
            (self.fewest, self.tries) = (wrong.len(), TRIES);
        } else if self.tries > 0 {
            self.tries -= 1;
        } else {
            wrong.truncate(1);
        }
        self.switches
    }
}

impl ConstraintSolver {
    /// Finds what multipliers are to change by, with those at their limits that have given way and the others held.
    fn solve_linear(&mut self, step: &Step, structure: &Structure) -> Result<(), StepError> {
        self.change.clear();
        self.change.resize(structure.relation_count(), Vec3::ZERO);
        for Yielding { relation, limit } in &self.yielding {
            let index = *relation as usize;
            if self.flowing[index] != Flowing::Not {
                self.change[index].x = self.flowing[index].sign() * limit - self.multipliers[index].x;
            }
        }
        self.respond(structure, Responding::Change);
        self.held.clear();
        for index in 0..structure.relation_count() {
            let left = self.scaled_off(step, index) - self.response_of(structure, index);
            self.held.push(Mat3::from_diagonal(self.active[index]) * left);
        }
        structure.solve(&mut self.held)?;
        for (change, held) in self.change.iter_mut().zip(&self.held) {
            *change += *held;
        }
        Ok(())
    }

    /// Those that yield and, with the change at hand, are beyond their limits, or would flow against what they push with.
    fn find_wrong(&mut self, step: &Step, structure: &Structure) {
        if self.yielding.is_empty() {
            self.wrong.clear();
            return;
        }
        self.respond(structure, Responding::Change);
        let mut wrong = std::mem::take(&mut self.wrong);
        wrong.clear();
        for Yielding { relation, limit } in &self.yielding {
            let index = *relation as usize;
            let change = self.change[index].x;
            let to = if self.flowing[index] == Flowing::Not {
                let multiplier = self.multipliers[index].x + change;
                if multiplier.abs() <= limit * (1.0 + BEYOND) {
                    continue;
                }
                Flowing::of(multiplier, *limit)
            } else {
                let left = (self.scaled_off(step, index) - self.response_of(structure, index)).x;
                if (left - RAISE * change) * self.flowing[index].sign() >= -self.scaled_near(step, index) {
                    continue;
                }
                Flowing::Not
            };
            wrong.push(Wrong { relation: *relation, to });
        }
        self.wrong = wrong;
    }

    /// The same where contacts have pushed, and relations have followed: by multipliers as they are.
    pub(super) fn find_wrong_after_contacts(
        &mut self,
        step: &Step,
        structure: &Structure,
    ) -> Result<bool, StepError> {
        if self.yielding.is_empty() {
            return Ok(false);
        }
        self.farthest_off(step, structure)?;
        self.change.clear();
        self.change.resize(structure.relation_count(), Vec3::ZERO);
        self.find_wrong(step, structure);
        Ok(!self.wrong.is_empty())
    }

    /// Lets relations that are on the wrong side give way, or hold again: all of them as long as they get fewer, else one by one by the least number.
    pub(super) fn switch(
        &mut self,
        step: &Step,
        structure: &mut Structure,
        pivoting: &mut Pivoting,
    ) -> Result<(), StepError> {
        let mut wrong = std::mem::take(&mut self.wrong);
        let switches = pivoting.choose(&mut wrong);
        for Wrong { relation, to } in &wrong {
            self.flow(*relation as usize, *to);
        }
        let first = wrong.first().map_or(0, |it| it.relation as usize);
        self.wrong = wrong;
        if switches > MOST_SWITCHES[0] + MOST_SWITCHES[1] * self.yielding.len() {
            return Err(unsettled(step, structure, first));
        }
        self.factorize(step, structure)
    }

    /// Brings relations to what they are to be with those giving way that do, to first order.
    pub(super) fn bring_back(&mut self, step: &Step, structure: &Structure) -> Result<(), StepError> {
        self.farthest_off(step, structure)?;
        self.solve_linear(step, structure)?;
        self.apply_change(step, structure);
        Ok(())
    }
}
