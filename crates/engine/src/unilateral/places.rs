//! Places of the problem that is swept for: contacts, and multipliers between bounds beside them.

use souple_math::{Mat3, Vec3};

use super::{ContactSystem, Moving};

/// A multiplier of a relation that yields, which is sought together with the forces of contacts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounded {
    pub relation: u32,
    /// As are all: scaled.
    pub multiplier: f64,
    pub limit: f64,
    /// What it is beyond what it is to be.
    pub off: f64,
    /// What it changes by when all its points move by a metre.
    pub slope: f64,
    /// How far off it may be by rounding [m].
    pub near: f64,
}

/// What a force may be.
#[derive(Clone, Copy, Debug)]
pub(super) enum Law {
    /// A push, with friction of so much of it.
    Cone(f64),
    /// Of either sign, up to a limit.
    Bounds(f64),
}

/// What a force is sought of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// Before the change that is sought.
    pub(super) force: Vec3,
    pub(super) law: Law,
    /// See [`Bounded::slope`]; one of contacts.
    pub(super) slope: f64,
    pub(super) near: f64,
}

/// What a force at a place moves a row by: along the rows of a matrix, times a weight and its inverse mass.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    pub(super) row: u32,
    pub(super) weight: f64,
    pub(super) along: Mat3,
}

impl Place {
    /// Directions in which there may be a force.
    pub(super) fn has_axis(&self, axis: usize) -> bool {
        axis == 0 || matches!(self.law, Law::Cone(friction) if friction > 0.0)
    }
}

impl ContactSystem {
    /// Lists the contacts that are sought, and multipliers beside them.
    pub(super) fn take_places(&mut self, moving: &Moving) {
        self.places.clear();
        self.entries.clear();
        self.entry_starts.clear();
        self.entry_starts.push(0);
        for contact in &self.sought {
            let contact = &self.contacts[*contact as usize];
            self.places.push(Place {
                force: contact.force,
                law: Law::Cone(contact.law.friction),
                slope: 1.0,
                near: contact.near,
            });
            self.entries.extend(contact.sides.iter().map(|(row, weight)| Entry {
                row: row as u32,
                weight,
                along: contact.frame,
            }));
            self.entry_starts.push(self.entries.len());
        }
        for bounded in moving.bounded {
            self.places.push(Place {
                force: Vec3::X * bounded.multiplier,
                law: Law::Bounds(bounded.limit),
                slope: bounded.slope,
                near: bounded.near,
            });
            let gradients = moving.structure.gradients_of(bounded.relation as usize, moving.gradients);
            self.entries.extend(gradients.map(|(row, along)| Entry { row: row as u32, weight: 1.0, along }));
            self.entry_starts.push(self.entries.len());
        }
    }

    pub(super) fn entries_of(&self, place: usize) -> &[Entry] {
        &self.entries[self.entry_starts[place]..self.entry_starts[place + 1]]
    }
}
