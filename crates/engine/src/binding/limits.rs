//! Which relations have given way: those whose multipliers are at their limits.

use souple_math::Vec3;

use crate::state::SystemState;
use crate::steppers::Step;

use super::ConstraintSolver;
use super::memory::multiplier;
use super::structure::Structure;

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

impl ConstraintSolver {
    /// Begins with those relations yielding that did so in the step before.
    pub(super) fn flow_on(&mut self, step: &Step, structure: &Structure, next: &SystemState) {
        self.flowing.clear();
        self.change.clear();
        for (index, (force, relation)) in structure.relations.iter().enumerate() {
            let limit = step.system.constraint_set(*force).and_then(|it| it.yields_at(*relation));
            let before = multiplier(&next.memory[step.system.memory_range(*force)], *relation).x;
            let flowing = match limit {
                Some(limit) if self.active[index].x > 0.0 => Flowing::of(before, limit),
                _ => Flowing::Not,
            };
            self.flowing.push(flowing);
            let mut change = Vec3::ZERO;
            if flowing != Flowing::Not {
                change.x = flowing.sign() * limit.unwrap_or(0.0) / self.scales[index].x;
                self.active[index].x = 0.0;
            }
            self.change.push(change);
        }
        self.push(step, structure);
    }

    /// Lets relations give way whose multipliers are beyond their limits, and hold again those that would flow against what they push with;
    /// whether there were any.
    pub(super) fn switch(&mut self, step: &Step, structure: &Structure) -> bool {
        let mut is_any = false;
        self.change.clear();
        for (index, (force, relation)) in structure.relations.iter().enumerate() {
            let mut change = Vec3::ZERO;
            let limit = step.system.constraint_set(*force).and_then(|it| it.yields_at(*relation));
            if let Some(limit) = limit.map(|limit| limit / self.scales[index].x) {
                let (multiplier, is_active) = (self.multipliers[index].x, self.active[index].x > 0.0);
                let is_against = self.off[index].x * self.flowing[index].sign() < -self.near[index].x;
                if is_active && multiplier.abs() > limit {
                    self.flowing[index] = Flowing::of(multiplier, limit);
                    change.x = self.flowing[index].sign() * limit - multiplier;
                    self.active[index].x = 0.0;
                    is_any = true;
                } else if is_against {
                    self.flowing[index] = Flowing::Not;
                    self.active[index].x = 1.0;
                    is_any = true;
                }
            }
            self.change.push(change);
        }
        if is_any {
            self.push(step, structure);
        }
        is_any
    }
}
