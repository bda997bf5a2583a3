//! What of a step that was found goes into forces on rows and into memory.

use souple_math::{Mat3, Vec3};

use crate::state::SystemState;
use crate::steppers::{Step, StepError};
use crate::unilateral::Bounded;

use super::limits::{Flowing, Yielding};
use super::memory::{known, memory_len, multiplier, set_earlier, set_multiplier};
use super::structure::Structure;
use super::{ConstraintSolver, fault, rate, value_near};

impl ConstraintSolver {
    /// Takes the forces of the step before, which are among those that were summed, off where the step leads: such as do what others do
    /// too would never leave.
    pub(super) fn remove_forces_before(&mut self, step: &Step, structure: &Structure, next: &SystemState) {
        self.before_step.clear();
        self.before_step.extend(structure.relations.iter().zip(&self.scales).map(
            |((force, relation), scale)| {
                let multiplier = multiplier(&next.memory[step.system.memory_range(*force)], *relation);
                Vec3::from_array([0, 1, 2].map(|axis| multiplier[axis] / scale[axis]))
            },
        ));
        let scale = -step.timestep * step.timestep;
        structure.spread(scale, &self.before_step, &self.gradients, &self.inverse_masses, &mut self.places);
    }

    /// Adds the change of forces to those on rows, along what is free, and remembers multipliers, flows and work.
    pub(super) fn commit(
        &self,
        (step, structure): (&Step, &Structure),
        positions: &[Vec3],
        next: &mut SystemState,
        row_force: &mut [Vec3],
    ) {
        let system = step.system;
        for (index, (force, relation)) in structure.relations.iter().enumerate() {
            let Some(set) = system.constraint_set(*force) else { continue };
            let memory = &mut next.memory[system.memory_range(*force)];
            let count = set.relation_count();
            let mut multiplier = Mat3::from_diagonal(self.scales[index]) * self.multipliers[index];
            set_earlier(memory, (count, *relation), known::VALUES, self.now[index]);
            if let Some(limit) = set.yields_at(*relation) {
                let mut flown = 0.0;
                if self.flowing[index] != Flowing::Not {
                    // the limit itself, by which the next step knows that it flows
                    multiplier.x = self.flowing[index].sign() * limit;
                    let wanted = self.wanted[index];
                    flown = (value_near(set, *relation, (&self.places, step.end()), wanted) - wanted).x;
                }
                memory[memory_len(count) + relation] += flown;
                // of masses: λ Δp, −Y |Δp| where it flows, and what it is told to change by
                let told = step.timestep * set.time_rate(*relation, positions, step.start).x;
                memory[0] += multiplier.x * (flown - told);
            }
            set_multiplier(memory, *relation, multiplier);
            let yields = set.yields_at(*relation).is_some();
            for entry in structure.starts[index]..structure.starts[index + 1] {
                let row = structure.rows[entry] as usize;
                let change = self.multipliers[index] - self.before_step[index];
                let change = self.gradients[entry].transpose_apply(change);
                // m (W f) is f along what is free
                row_force[row] += self.inverse_masses[row] * change * system.mass.diagonal[row];
                if !yields {
                    let whole = self.gradients[entry].transpose_apply(self.multipliers[index]);
                    // ½ m v'² − ½ m v² = f·(v + v') h/2
                    memory[0] += 0.5 * whole.dot(self.places[row] - self.before[row]);
                }
            }
        }
    }

    /// Refuses flows that lead where relations have no meaning.
    pub(super) fn check_flows(
        &self,
        step: &Step,
        structure: &Structure,
        positions: &[Vec3],
    ) -> Result<(), StepError> {
        let flowing = self.flowing.iter().enumerate().filter(|(_, flowing)| **flowing != Flowing::Not);
        for (index, _) in flowing {
            let (force, relation) = structure.relations[index];
            let Some(set) = step.system.constraint_set(force) else { continue };
            if let Some(what) = set.is_lost_between(relation, positions, &self.places) {
                return Err(fault(step, structure, index, what));
            }
        }
        Ok(())
    }

    /// Remembers what relations change by in a second where a step was last sought from: a trajectory is about to move the velocity.
    pub(crate) fn remember_rates(&mut self, step: &Step, positions: &[Vec3], memory: &mut [f64]) {
        let relations = self.structure.iter().flat_map(|structure| &structure.relations);
        for (force, relation) in relations {
            let Some(set) = step.system.constraint_set(*force) else { continue };
            if set.yields_at(*relation).is_some() {
                continue;
            }
            let at = (positions, &self.led[..], step.start);
            let rate = rate(set, *relation, at, &mut self.unscaled);
            let memory = &mut memory[step.system.memory_range(*force)];
            set_earlier(memory, (set.relation_count(), *relation), known::RATES, rate);
        }
    }

    pub(crate) fn bytes(&self) -> usize {
        let vectors = [
            &self.before,
            &self.places,
            &self.unpushed,
            &self.unpushed_multipliers,
            &self.held,
            &self.stride,
            &self.left,
            &self.response,
            &self.velocities,
            &self.wanted,
            &self.off,
            &self.change,
            &self.multipliers,
            &self.before_step,
            &self.active,
            &self.scales,
            &self.near,
            &self.now,
            &self.led,
        ];
        let matrices = self.gradients.capacity() + self.inverse_masses.capacity() + self.unscaled.capacity();
        vectors.into_iter().map(|vector| size_of::<Vec3>() * vector.capacity()).sum::<usize>()
            + size_of::<Mat3>() * matrices
            + size_of::<Flowing>() * self.flowing.capacity()
            + size_of::<Yielding>() * (self.yielding.capacity() + self.led_yielding.capacity())
            + size_of::<Bounded>() * self.bounded.capacity()
            + self.contacts.bytes()
            + self.structure.as_ref().map_or(0, |structure| {
                size_of_val(structure.products.as_slice())
                    + structure.matrix.bytes()
                    + structure.solver.bytes()
            })
    }
}
