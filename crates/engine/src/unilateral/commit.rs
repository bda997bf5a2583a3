//! What of the contacts of a step that was found goes into forces on rows and into memory.

use souple_math::{Mat3, Vec3};

use crate::state::{SystemState, pairs_of};
use crate::steppers::{Step, StepError, StepReport};

use super::places::{Entry, Place};
use super::{Contact, ContactSystem, Moving, described};

impl ContactSystem {
    /// Adds the change of forces to those on rows, along what is free, and remembers forces and work.
    pub(crate) fn commit(
        &self,
        moving: &Moving,
        next: &mut SystemState,
        (places, row_force): (&[Vec3], &mut [Vec3]),
    ) -> StepReport {
        let system = moving.step.system;
        for contact in &self.contacts {
            let (index, number) = contact.of;
            let Some(unilateral) = system.forces[index].unilateral() else { continue };
            let pairs = pairs_of(&next.pairs, index);
            let (memory, pairs) = (&mut next.memory[system.memory_range(index)], &mut next.pairs[pairs]);
            let whole = contact.frame.transpose_apply(contact.force);
            let change = contact.frame.transpose_apply(contact.force - contact.force_before);
            unilateral.set_force(number, memory, pairs, whole);
            for (row, weight) in contact.sides.iter() {
                // m (W f) is f along what is free
                row_force[row] += moving.inverse_masses[row] * change * (weight * system.mass.diagonal[row]);
                // ½ m v'² − ½ m v² = f·(v + v') h/2
                memory[0] += 0.5 * weight * whole.dot(places[row] - moving.before[row]);
            }
        }
        self.report
    }

    pub(super) fn unsolved(&self, step: &Step, state: &SystemState) -> StepError {
        let mut worst = (0.0, (0, 0), 0);
        for (place, contact) in self.sought.iter().enumerate() {
            let contact = &self.contacts[*contact as usize];
            let off = self.off_at(place) + self.asked_less(place);
            if off >= worst.0 {
                worst = (off, contact.of, contact.sides.rows[0] as usize);
            }
        }
        let (off, of, row) = worst;
        StepError::Unkept {
            force: step.system.forces[of.0].name().to_owned(),
            relation: described(step, state, of),
            off,
            row,
            time: step.end(),
        }
    }

    pub(crate) fn bytes(&self) -> usize {
        let vectors =
            [&self.off, &self.change, &self.swept, &self.direction, &self.response].map(Vec::capacity);
        size_of::<Contact>() * self.contacts.capacity()
            + size_of::<Vec3>() * vectors.iter().sum::<usize>()
            + size_of::<Mat3>() * self.blocks.capacity()
            + size_of::<Place>() * self.places.capacity()
            + size_of::<Entry>() * self.entries.capacity()
            + size_of::<[f64; 2]>() * self.stiffest.capacity()
            + size_of::<f64>() * self.reaches.capacity()
            + self.face.bytes()
            + 8 * (self.touches.capacity()
                + self.entry_starts.capacity()
                + self.starts.capacity()
                + self.own.capacity())
            + self.is_sought.capacity()
            + 4 * (self.sought.capacity() + self.columns.capacity() + self.waiting.capacity())
    }
}
