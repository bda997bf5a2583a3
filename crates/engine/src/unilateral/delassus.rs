//! The operator of Delassus: what forces of contacts, and multipliers between bounds, move these by, with other relations held.

use souple_math::{Mat3, Vec3};

use crate::steppers::StepError;

use super::places::Entry;
use super::{ContactSystem, Moving};

impl ContactSystem {
    /// Which places move each other: those that touch one body.
    pub(super) fn lay_out(&mut self, moving: &Moving) {
        self.take_places(moving);
        self.touches.clear();
        for place in 0..self.places.len() {
            for entry in self.entry_starts[place]..self.entry_starts[place + 1] {
                let row = self.entries[entry].row as usize;
                if moving.inverse_masses[row] != Mat3::ZERO {
                    self.touches.push((moving.bodies[row], place as u32));
                }
            }
        }
        self.touches.sort_unstable();
        self.touches.dedup();
        self.starts.clear();
        self.columns.clear();
        self.starts.push(0);
        for place in 0..self.places.len() {
            let first = self.columns.len();
            // its own is always there
            self.columns.push(place as u32);
            for entry in self.entry_starts[place]..self.entry_starts[place + 1] {
                let row = self.entries[entry].row as usize;
                if moving.inverse_masses[row] == Mat3::ZERO {
                    continue;
                }
                let touching = self.touching(moving.bodies[row]);
                let Self { columns, touches, .. } = self;
                columns.extend(touches[touching].iter().map(|(_, other)| *other));
            }
            let own = &mut self.columns[first..];
            own.sort_unstable();
            let mut kept = 0;
            for at in 0..own.len() {
                if at == 0 || own[at] != own[kept - 1] {
                    own[kept] = own[at];
                    kept += 1;
                }
            }
            self.columns.truncate(first + kept);
            self.starts.push(self.columns.len());
        }
    }

    /// Where those that touch a body are in the list.
    fn touching(&self, body: u32) -> std::ops::Range<usize> {
        let first = self.touches.partition_point(|(other, _)| *other < body);
        first..self.touches.partition_point(|(other, _)| *other <= body)
    }

    fn slot(&self, row: usize, column: u32) -> usize {
        let range = self.starts[row]..self.starts[row + 1];
        let first = range.start;
        first + self.columns[range].partition_point(|other| *other < column)
    }

    // D = h² J (W − W Gᵀ (G W Gᵀ)⁻¹ G W) Jᵀ
    pub(super) fn fill(&mut self, moving: &Moving) -> Result<(), StepError> {
        let square = moving.step.timestep * moving.step.timestep;
        self.blocks.clear();
        self.blocks.resize(self.columns.len(), Mat3::ZERO);
        for place in 0..self.places.len() {
            for slot in self.starts[place]..self.starts[place + 1] {
                let others = self.entries_of(self.columns[slot] as usize);
                let mut block = Mat3::ZERO;
                for entry in self.entries_of(place) {
                    for other in others.iter().filter(|other| other.row == entry.row) {
                        let moved = entry.along * moving.inverse_masses[entry.row as usize];
                        block += moved.mul_transpose(&other.along) * (entry.weight * other.weight * square);
                    }
                }
                self.blocks[slot] = block;
            }
        }
        self.subtract_relations(moving, square)?;
        self.stiffest.clear();
        self.own.clear();
        for place in 0..self.places.len() {
            self.own.push(self.slot(place, place as u32));
            let own = self.blocks[self.own[place]];
            let [a, b, c] = [own.entry(1, 1), own.entry(1, 2), own.entry(2, 2)];
            let tangent = 0.5 * (a + c) + (0.5 * (a - c)).hypot(b);
            self.stiffest.push([own.entry(0, 0), tangent]);
        }
        self.soften();
        Ok(())
    }

    /// What relations take of how far forces move contacts. One solve serves one place of each body, since bodies do not share relations.
    fn subtract_relations(&mut self, moving: &Moving, square: f64) -> Result<(), StepError> {
        let structure = moving.structure;
        if structure.relation_count() == 0 {
            return Ok(());
        }
        for turn in 0..self.most_of_a_body() {
            for axis in 0..3 {
                self.response.clear();
                self.response.resize(structure.relation_count(), Vec3::ZERO);
                let mut is_any = false;
                let mut first = 0;
                while first < self.touches.len() {
                    let (body, _) = self.touches[first];
                    let of_body = self.touching(body);
                    first = of_body.end;
                    let place = self.touches[of_body].get(turn).map(|(_, place)| *place as usize);
                    // nothing without friction pushes across
                    if let Some(place) = place.filter(|it| self.places[*it].has_axis(axis)) {
                        for at in self.entry_starts[place]..self.entry_starts[place + 1] {
                            let Entry { row, weight, along } = self.entries[at];
                            let row = row as usize;
                            if moving.bodies[row] != body {
                                continue;
                            }
                            let moved = moving.inverse_masses[row] * along.row(axis) * weight;
                            for (relation, entry) in structure.entries_of(row) {
                                is_any = true;
                                let part = Mat3::from_diagonal(moving.active[relation]);
                                self.response[relation] += part * (moving.gradients[entry] * moved);
                            }
                        }
                    }
                }
                if !is_any {
                    continue;
                }
                structure.solve(&mut self.response)?;
                self.subtract_response(moving, (turn, axis), square);
            }
        }
        Ok(())
    }

    /// The greatest number of places that touch one body.
    fn most_of_a_body(&self) -> usize {
        self.touches.chunk_by(|a, b| a.0 == b.0).map(<[_]>::len).max().unwrap_or(0)
    }

    /// Takes one column of each body off, by the multipliers of relations that one place of it asks for.
    fn subtract_response(&mut self, moving: &Moving, (turn, axis): (usize, usize), square: f64) {
        let structure = moving.structure;
        let mut first = 0;
        while first < self.touches.len() {
            let (body, _) = self.touches[first];
            let of_body = self.touching(body);
            first = of_body.end;
            let Some((_, column)) = self.touches[of_body.clone()].get(turn).copied() else { continue };
            if !self.places[column as usize].has_axis(axis) {
                continue;
            }
            let of_this = |entry: &&Entry| moving.bodies[entry.row as usize] == body;
            for at in of_body {
                let (_, place) = self.touches[at];
                let (mut change, mut moved) = (Vec3::ZERO, Vec3::ZERO);
                let mut entries = self.entries_of(place as usize).iter().filter(of_this).peekable();
                while let Some(entry) = entries.next() {
                    let row = entry.row as usize;
                    let pull: Vec3 = structure
                        .entries_of(row)
                        .map(|(relation, entry)| {
                            moving.gradients[entry].transpose_apply(self.response[relation])
                        })
                        .sum();
                    moved += moving.inverse_masses[row] * pull * (entry.weight * square);
                    // sides of a contact are along one frame
                    if entries.peek().is_none_or(|next| next.along != entry.along) {
                        change += entry.along * std::mem::take(&mut moved);
                    }
                }
                let slot = self.slot(place as usize, column);
                let block = &mut self.blocks[slot];
                let mut columns = block.columns;
                columns[axis] -= change;
                *block = Mat3 { columns };
            }
        }
    }
}
