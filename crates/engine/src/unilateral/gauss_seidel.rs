//! Forces of contacts by projected Gauss–Seidel sweeps, whose changes are extrapolated.

use souple_math::Vec3;

use super::places::{Law, Place};
use super::{
    CONVERGED, ContactSystem, LET_PASS, MOST_ROUNDS, MOST_SWEEPS, PRODUCTS, SWEEPS_AFTER, SWEEPS_BEFORE,
    WEDGED,
};

/// What a sweep did to forces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sweep {
    Settled,
    Moved,
}

/// What there is to be done about forces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Judgement {
    Solved,
    NotYet,
    /// And more sweeps would not help.
    Unsolved,
}

impl ContactSystem {
    /// Finds what forces are to be changed by, in sweeps. The first of a step begins with the forces of the step before.
    pub(super) fn solve(&mut self, is_first: bool) {
        let count = self.places.len();
        for list in [&mut self.change, &mut self.swept, &mut self.direction] {
            list.clear();
            list.resize(count, Vec3::ZERO);
        }
        for (place, contact) in self.sought.iter().enumerate() {
            let contact = &self.contacts[*contact as usize];
            self.places[place].force = contact.force;
            if is_first && !contact.is_jammed {
                self.change[place] = contact.force_before;
            }
        }
        if self.sweep_on(SWEEPS_BEFORE) == Sweep::Moved {
            // as many as unknowns find a face of a chain
            self.descend(PRODUCTS.max(self.places.len() as u64));
            self.sweep_on(SWEEPS_AFTER);
        }
    }

    /// Sweeps until forces have settled, so often at most. What is extrapolated may pull or leave its cone: a sweep is the last.
    pub(super) fn sweep_on(&mut self, most: u64) -> Sweep {
        self.direction.fill(Vec3::ZERO);
        let mut size_before = f64::INFINITY;
        for sweep in 1..=most {
            self.report.contact_iterations += 1;
            if self.sweep() == Sweep::Settled {
                return Sweep::Settled;
            }
            if sweep == most {
                break;
            }
            let size: f64 =
                self.swept.iter().zip(&self.stiffest).map(|(by, [n, _])| by.length_sq() * n).sum();
            let ratio = size / size_before;
            size_before = size;
            if ratio >= 1.0 {
                self.direction.fill(Vec3::ZERO);
                size_before = f64::INFINITY;
                continue;
            }
            for place in 0..self.places.len() {
                self.change[place] += self.direction[place] * ratio;
                self.direction[place] = self.direction[place] * ratio + self.swept[place];
            }
        }
        Sweep::Moved
    }

    /// Gives each place in turn the force that it asks for.
    pub(super) fn sweep(&mut self) -> Sweep {
        let mut found = Sweep::Settled;
        for place in 0..self.places.len() {
            let Place { force, law, .. } = self.places[place];
            let off = self.off[place] + self.moved(place, &self.change);
            let by = self.wanted_change(place, force + self.change[place], off, law);
            if self.length_of(place, by) > self.let_be(place) {
                found = Sweep::Moved;
            }
            self.swept[place] = by;
            self.change[place] += by;
        }
        found
    }

    /// What changes of forces move a place by [m].
    pub(super) fn moved(&self, place: usize, changes: &[Vec3]) -> Vec3 {
        let slots = self.starts[place]..self.starts[place + 1];
        slots.map(|slot| self.blocks[slot] * changes[self.columns[slot] as usize]).sum()
    }

    /// How far a place may be off [m]: closer than is asked where the step leads, where it is measured again.
    pub(super) fn let_be(&self, place: usize) -> f64 {
        0.2 * (CONVERGED * self.tightness * self.scale + self.places[place].near)
    }

    /// What a place that is off asks its force to change by: the projection onto bounds, or onto signs and then onto the friction cone, with the slip
    /// that the normal force leaves.
    pub(super) fn wanted_change(&self, place: usize, force: Vec3, off: Vec3, law: Law) -> Vec3 {
        let [normal, tangent] = self.stiffest[place];
        if normal <= 0.0 {
            return Vec3::ZERO;
        }
        let friction = match law {
            Law::Cone(friction) => friction,
            Law::Bounds(limit) => {
                return Vec3::X * ((force.x - off.x / normal).clamp(-limit, limit) - force.x);
            }
        };
        let push = (force.x - off.x / normal).max(0.0);
        let slip = off + self.blocks[self.own[place]].columns[0] * (push - force.x);
        let held = friction * push;
        let (mut y, mut z) = (0.0, 0.0);
        if held > 0.0 && tangent > 0.0 {
            (y, z) = (force.y - slip.y / tangent, force.z - slip.z / tangent);
            let length = y.hypot(z);
            if length > held {
                (y, z) = (y * (held / length), z * (held / length));
            }
        }
        Vec3::new(push, y, z) - force
    }

    /// How far a change of the force of a place moves itself [m].
    pub(super) fn length_of(&self, place: usize, change: Vec3) -> f64 {
        let [normal, tangent] = self.stiffest[place];
        let Place { law, slope, .. } = self.places[place];
        if let Law::Bounds(_) = law {
            return change.x.abs() * normal / slope;
        }
        (change.x.abs() * normal).max(change.y.hypot(change.z) * tangent)
    }

    /// How far off a contact is where the step leads, as the force tells that it would have [m].
    pub(super) fn off_at(&self, place: usize) -> f64 {
        let contact = &self.contacts[self.sought[place] as usize];
        let law = Law::Cone(contact.law.friction);
        let by = self.wanted_change(place, contact.force, self.off[place], law);
        self.length_of(place, by)
    }

    /// How far off it may be [m].
    pub(super) fn may_be_off(&self, place: usize) -> f64 {
        self.contacts[self.sought[place] as usize].near + CONVERGED * self.scale
    }

    /// Whether contacts have the forces that they ask for, or what is left may pass where sweeps do not help any more.
    pub(super) fn judge(&mut self) -> Judgement {
        let (mut worst, mut is_solved, mut is_little) = (0.0_f64, true, true);
        for place in 0..self.sought.len() {
            let contact = &self.contacts[self.sought[place] as usize];
            let off = self.off_at(place);
            let in_all = off + self.asked_less(place);
            let is_found = off <= self.may_be_off(place);
            worst = worst.max(in_all);
            is_solved &= is_found;
            is_little &= if contact.is_jammed { in_all <= WEDGED * contact.near } else { is_found };
        }
        self.report.contact_residual = if worst > 0.0 { worst / self.scale.max(worst) } else { 0.0 };
        if !is_solved && !self.is_spent() {
            return Judgement::NotYet;
        }
        let is_near = self.report.contact_residual <= LET_PASS;
        let may_pass = match self.is_jammed {
            true => is_near || is_little,
            false => is_near || is_solved,
        };
        if self.is_jammed {
            (self.report.wedged_steps, self.report.contacts_wedged) = (1, worst);
        }
        if may_pass { Judgement::Solved } else { Judgement::Unsolved }
    }

    /// Whether neither sweeps nor rounds are left.
    pub(super) fn is_spent(&self) -> bool {
        self.rounds == MOST_ROUNDS || self.sweeps() >= MOST_SWEEPS
    }

    /// Sweeps, and products in their place, since forces were begun to be sought.
    fn sweeps(&self) -> u64 {
        self.report.contact_iterations - self.spent
    }
}
