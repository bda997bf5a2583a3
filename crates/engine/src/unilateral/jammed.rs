//! Bodies that are jammed: steps whose contacts find no forces by the law are solved once more, asking less of them.
//!
//! With friction there need be no forces at all that open gaps. What lies in a wedge whose walls rub so much that it cannot slide along them is not moved
//! out of it by any force of these walls: neither by the restitution of a collision there, nor by what a gap is too deep by rounding. Coulomb's law has an
//! answer where some motion `x'` keeps `g(x') − w > μ |u_t|` at all contacts (Acary, Cadoux, Lemaréchal & Malick 2011). Among walls at rest that is
//! so of standing still, where nothing wants a gap to be wider than it is: `w ≤ min(g, 0)`. Of such steps, then,
//!
//! - no collision is given back anything, `ε = 0`, and what is closed too deep, by no more than is let pass elsewhere, is not to be deeper;
//! - contacts give way by `c D p`, `D` being what each resists alone: by so little that where forces are what they would be for one body nobody sees it, but
//!   of all forces that do the same one is then the least, and none grows beyond all bounds.
//!
//! What contacts give way by in all is told, and is to be as little as what is let pass elsewhere: walls that crush a body are refused.

use souple_math::{Mat3, Vec3};

use crate::state::SystemState;
use crate::steppers::StepError;

use super::{ContactSystem, Moving, WEDGED, fault};

/// `c`: a hundred times less than what is let pass, so that a jam may press a hundred times as hard as what stops one body.
const GIVES_WAY: f64 = 1e-6;

impl ContactSystem {
    /// Begins the search for forces anew, from where the step leads without them, with less asked of contacts that wait for it and of those that hang
    /// together with these; false where all of them are asked less already.
    pub(super) fn begin_jammed(&mut self, moving: &Moving, places: &mut [Vec3]) -> bool {
        if !self.mark_jammed() {
            return false;
        }
        let square = moving.step.timestep * moving.step.timestep;
        for contact in &mut self.contacts {
            let push = contact.frame.transpose_apply(std::mem::take(&mut contact.force));
            for (row, weight) in contact.sides.iter() {
                places[row] -= moving.inverse_masses[row] * push * (weight * square);
            }
        }
        (self.spent, self.rounds, self.tightness) = (self.report.contact_iterations, 0, 1.0);
        // what contacts resist is laid out anew, with what they give way by
        (self.is_jammed, self.is_laid_out_otherwise) = (true, true);
        true
    }

    /// Asks less of contacts that wait for it, of those that touch the same bodies, and so on; whether there is any that was not.
    fn mark_jammed(&mut self) -> bool {
        let mut is_any = false;
        while let Some(place) = self.waiting.pop() {
            let contact = &mut self.contacts[self.sought[place as usize] as usize];
            if std::mem::replace(&mut contact.is_jammed, true) {
                continue;
            }
            is_any = true;
            // what they give way by comes to what they are left inside
            contact.wanted = contact.gap.clamp(-0.5 * WEDGED * contact.near, 0.0);
            let slots = self.starts[place as usize]..self.starts[place as usize + 1];
            self.waiting.extend_from_slice(&self.columns[slots]);
        }
        is_any
    }

    /// Has contacts that have not found their forces wait for less to be asked of them.
    pub(super) fn wait_for_unsolved(&mut self) {
        self.waiting.clear();
        for place in 0..self.sought.len() {
            if self.off_at(place) > self.may_be_off(place) {
                self.waiting.push(place as u32);
            }
        }
    }

    /// Likewise those whose forces are such that rounding of these alone moves points farther than contacts are to be found to; the place of the one that
    /// presses hardest.
    pub(super) fn wait_for_beyond_numbers(&mut self) -> Option<usize> {
        self.waiting.clear();
        let mut worst = (0.0, None);
        for place in 0..self.sought.len() {
            let unknown = f64::EPSILON * self.length_of(place, self.force_at(place));
            if unknown > self.may_be_off(place) {
                self.waiting.push(place as u32);
                if unknown > worst.0 {
                    worst = (unknown, Some(place));
                }
            }
        }
        worst.1
    }

    /// Adds to what contacts resist alone what they give way by.
    pub(super) fn soften(&mut self) {
        for place in 0..self.sought.len() {
            let softness = self.softness(place);
            self.blocks[self.own[place]] += softness;
        }
    }

    /// Takes contacts to be where they would be had they not given way to their forces.
    pub(super) fn give_way(&mut self) {
        for place in 0..self.sought.len() {
            let by = self.softness(place) * self.contacts[self.sought[place] as usize].force;
            self.off[place] += by;
        }
    }

    /// What a contact gives way by to its force [m/N].
    fn softness(&self, place: usize) -> Mat3 {
        if !self.contacts[self.sought[place] as usize].is_jammed {
            return Mat3::ZERO;
        }
        let [normal, tangent] = self.stiffest[place];
        Mat3::from_diagonal(Vec3::new(normal, tangent, tangent) * GIVES_WAY)
    }

    /// How much less than the law a contact was asked for: what it has given way by to its force, and is left inside [m].
    pub(super) fn asked_less(&self, place: usize) -> f64 {
        let contact = &self.contacts[self.sought[place] as usize];
        if !contact.is_jammed {
            return 0.0;
        }
        self.length_of(place, contact.force) * GIVES_WAY - contact.wanted
    }

    /// Why such a force ends a run.
    pub(super) fn too_hard(&self, moving: &Moving, state: &SystemState, place: usize) -> StepError {
        let contact = &self.contacts[self.sought[place] as usize];
        let force = self.force_at(place).length();
        let what = format!(
            "is to be pressed with {force:.1e} N, beside which no number holds what moves it: bodies lock themselves between surfaces that friction does not let them \
             leave; take less friction"
        );
        fault(moving, state, contact.of, &what)
    }
}
