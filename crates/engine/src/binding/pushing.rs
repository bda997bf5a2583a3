//! Forces of contacts, and which relations give way under them.
//!
//! What contacts push with is found for those that give way at the time. Where multipliers are beyond limits then, or what has given way would flow against its
//! push, it is found anew together with all multipliers that have limits: these are then rows of the same problem, with bounds in the place of cones, and
//! those relations alone are solved for along with them that cannot yield. Sweeps over both lead down where nothing rubs, whatever the pushes, and tell which
//! are at their limit. With these giving way, those that are not are brought exactly to where they hold, and the search goes on from there.

use souple_math::{Mat3, Vec3};

use crate::state::SystemState;
use crate::steppers::{Step, StepError};
use crate::unilateral::{Bounded, ContactSystem, Improved, Moving};

use super::limits::{AT_LIMIT, Flowing, Yielding};
use super::linearise::longest_way;
use super::structure::Structure;
use super::{ConstraintSolver, Solved};

impl ConstraintSolver {
    /// Changes forces of contacts, with those relations giving way that do so under them; whether there was anything to change.
    pub(super) fn push_contacts(
        &mut self,
        (step, structure, solved): (&Step, &mut Structure, Solved),
        contacts: &mut ContactSystem,
        state: &SystemState,
        positions: &[Vec3],
    ) -> Result<bool, StepError> {
        let mut places = std::mem::take(&mut self.places);
        self.unpushed.clone_from(&places);
        self.unpushed_multipliers.clone_from(&self.multipliers);
        let moving = self.moving(step, structure, positions, solved);
        let improved = contacts.improve(&moving, state, &mut places);
        self.places = places;
        let improved = improved?;
        if improved == Improved::Nothing {
            return Ok(false);
        }
        self.follow_contacts(step, structure)?;
        // without forces of contacts limits are for the next solve
        if improved == Improved::Forces && self.is_wrong_after_contacts(step, structure)? {
            self.places.clone_from(&self.unpushed);
            self.multipliers.clone_from(&self.unpushed_multipliers);
            self.push_with_limits((step, structure), contacts, positions)?;
        }
        Ok(true)
    }

    /// Moves what contacts have pushed as relations let it move, by their gradients where the step starts. A push on one mass of a body would else bring
    /// it as much farther as the body is heavier than it, where the body has no shape any more and what relations are off by says nothing of
    /// the forces that they ask for.
    fn follow_contacts(&mut self, step: &Step, structure: &Structure) -> Result<(), StepError> {
        if structure.relation_count() == 0 {
            return Ok(());
        }
        let square = step.timestep * step.timestep;
        self.allow_way(structure, longest_way(&self.places, &self.unpushed));
        self.change.clear();
        for index in 0..structure.relation_count() {
            let moved = Mat3::from_diagonal(self.active[index]) * self.pushed_by(structure, index);
            self.change.push(moved * (-1.0 / square));
        }
        self.apply(step, structure)
    }

    /// What a relation changes by where masses were pushed, by its gradients where the step starts.
    fn pushed_by(&self, structure: &Structure, index: usize) -> Vec3 {
        let of_rows = structure.gradients_of(index, &self.gradients);
        of_rows.map(|(row, gradient)| gradient * (self.places[row] - self.unpushed[row])).sum()
    }

    pub(super) fn moving<'a>(
        &'a self,
        step: &'a Step,
        structure: &'a Structure,
        positions: &'a [Vec3],
        solved: Solved,
    ) -> Moving<'a> {
        Moving {
            step,
            structure,
            positions,
            solved,
            before: &self.before,
            inverse_masses: &self.inverse_masses,
            gradients: &self.gradients,
            active: &self.active,
            bodies: structure.bodies(),
            bounded: &[],
        }
    }

    /// Whether those that yield are beyond their limits, or would flow against what they push with, where contacts have pushed and relations have
    /// followed.
    fn is_wrong_after_contacts(&mut self, step: &Step, structure: &Structure) -> Result<bool, StepError> {
        if self.yielding.is_empty() {
            return Ok(false);
        }
        self.farthest_off(step, structure)?;
        Ok(!self.is_within_limits())
    }

    /// Changes forces of contacts and multipliers that have limits together, and lets those give way that are at theirs.
    fn push_with_limits(
        &mut self,
        (step, structure): (&Step, &mut Structure),
        contacts: &mut ContactSystem,
        positions: &[Vec3],
    ) -> Result<(), StepError> {
        self.farthest_off(step, structure)?;
        self.bound_multipliers(structure);
        self.factorize(step, structure)?;
        let mut places = std::mem::take(&mut self.places);
        let moving = Moving {
            bodies: structure.unyielding(),
            bounded: &self.bounded,
            ..self.moving(step, structure, positions, Solved::WithOthers)
        };
        let changes = contacts.improve_with_bounded(&moving, &mut places);
        self.places = places;
        let changes = changes?;
        self.change.clear();
        self.change.resize(structure.relation_count(), Vec3::ZERO);
        for (place, change) in changes.iter().enumerate() {
            let Yielding { relation, limit } = self.yielding[place];
            let index = relation as usize;
            let near = limit * AT_LIMIT;
            let flowing = match self.multipliers[index].x + change.x {
                at if at >= near => Flowing::Pushing,
                at if at <= -near => Flowing::Pulling,
                _ => Flowing::Not,
            };
            self.flow(index, flowing);
        }
        self.factorize(step, structure)?;
        self.follow_with_limits(step, structure)
    }

    /// Leaves multipliers that have limits to sweeps.
    fn bound_multipliers(&mut self, structure: &Structure) {
        self.bounded.clear();
        for Yielding { relation, limit } in &self.yielding {
            let index = *relation as usize;
            let scale = self.scales[index].x;
            let of_rows = structure.gradients_of(index, &self.gradients);
            let slope: f64 = of_rows.map(|(_, gradient)| gradient.row(0).length()).sum();
            self.bounded.push(Bounded {
                relation: *relation,
                multiplier: self.multipliers[index].x,
                limit: *limit,
                off: -self.off[index].x * scale,
                slope,
                near: self.near[index].x * scale / slope,
            });
            self.active[index].x = 0.0;
        }
    }

    /// Moves what contacts have pushed as relations let it move that give way under their limits or hold.
    fn follow_with_limits(&mut self, step: &Step, structure: &Structure) -> Result<(), StepError> {
        self.change.clear();
        self.change.resize(structure.relation_count(), Vec3::ZERO);
        for Yielding { relation, limit } in &self.yielding {
            let index = *relation as usize;
            if self.flowing[index] != Flowing::Not {
                self.change[index].x = self.flowing[index].sign() * limit - self.multipliers[index].x;
            }
        }
        self.apply_change(step, structure);
        self.allow_way(structure, longest_way(&self.places, &self.unpushed));
        let square = step.timestep * step.timestep;
        self.change.clear();
        for index in 0..structure.relation_count() {
            let left = self.scaled_off(step, index) - self.pushed_by(structure, index) / square;
            self.change.push(Mat3::from_diagonal(self.active[index]) * left);
        }
        self.apply(step, structure)
    }
}
