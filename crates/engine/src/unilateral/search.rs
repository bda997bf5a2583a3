//! Which contacts there are in a step, which of them forces are sought of, and how far off these are where it leads.

use souple_math::{Mat3, Vec3};

use crate::binding::Solved;
use crate::state::SystemState;
use crate::steppers::{Step, StepError, StepReport};

use super::gauss_seidel::Judgement;
use super::{Contact, ContactSystem, Improved, Moving, OF_RELATIONS, TIGHTER, TOLERANCE, fault, pairs_in};

impl ContactSystem {
    /// Looks which contacts there are where the step starts, and takes their forces of the step before, which are among those that were summed, off where
    /// it leads.
    pub(crate) fn begin(
        &mut self,
        moving: &Moving,
        state: &SystemState,
        places: &mut [Vec3],
    ) -> Result<(), StepError> {
        let Step { system, start, timestep, .. } = *moving.step;
        self.contacts.clear();
        self.sought.clear();
        (self.rounds, self.report) = (0, StepReport::default());
        (self.are_decided, self.is_laid_out_otherwise, self.tightness) = (false, false, 1.0);
        (self.is_jammed, self.spent) = (false, 0);
        let earlier = (start - timestep).max(0.0);
        for (index, force) in system.forces.iter().enumerate() {
            let Some(unilateral) = force.unilateral() else { continue };
            let (pairs, memory) = (pairs_in(state, index), &state.memory[system.memory_range(index)]);
            for number in 0..unilateral.contact_count(pairs) {
                let sides = unilateral.sides(number, pairs, moving.positions);
                let slope = unilateral.slope(number, pairs, moving.positions, start);
                let steepness = slope.length();
                let value = unilateral.gap(number, pairs, moving.positions, start);
                let stored = unilateral.force(number, memory, pairs);
                for (row, weight) in sides.iter() {
                    places[row] -= moving.inverse_masses[row] * stored * (weight * timestep * timestep);
                }
                if !(value.is_finite() && steepness.is_finite()) {
                    let what = "has no value, or no slope, where masses are";
                    return Err(fault(moving, state, (index, number), what));
                }
                // points at one place part along x
                let normal = slope.try_normalised().unwrap_or(Vec3::X);
                let steepness = if steepness > 0.0 { steepness } else { 1.0 };
                let across = normal.any_orthogonal();
                let frame = Mat3::from_columns(normal, across, normal.cross(across)).transpose();
                let before = unilateral.gap(number, pairs, moving.before, earlier);
                let reach = sides
                    .iter()
                    .flat_map(|(row, _)| moving.positions[row].to_array())
                    .fold(0.0_f64, |most, x| most.max(x.abs()));
                self.contacts.push(Contact {
                    of: (index, number),
                    sides,
                    frame,
                    steepness,
                    law: unilateral.law(),
                    gap: value / steepness,
                    narrowing: (value - before) / steepness,
                    wanted: 0.0,
                    is_jammed: false,
                    carried: unilateral.surface_velocity(number, start + timestep) * timestep,
                    force: Vec3::ZERO,
                    force_before: frame * stored,
                    near: TOLERANCE * sides.weight() * reach,
                });
            }
        }
        self.allow_rounding(moving, places);
        Ok(())
    }

    /// Lets contacts be off by rounding of the longest way in the step, and by what relations of their bodies may be off: masses near the origin are not
    /// known better than what pushes them.
    fn allow_rounding(&mut self, moving: &Moving, places: &[Vec3]) {
        let largest = |x: Vec3| x.to_array().into_iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let mut way = 0.0_f64;
        self.reaches.clear();
        self.reaches.resize(places.len(), 0.0);
        for (row, (to, from)) in places.iter().zip(moving.positions).enumerate() {
            way = way.max(largest(*to - *from));
            let reach = &mut self.reaches[moving.bodies[row] as usize];
            *reach = reach.max(largest(*from));
        }
        for contact in &mut self.contacts {
            let of_sides = contact.sides.iter().map(|(row, _)| self.reaches[moving.bodies[row] as usize]);
            let reach = of_sides.fold(0.0_f64, f64::max);
            let least = (TOLERANCE * way).max(OF_RELATIONS * reach);
            contact.near = contact.near.max(contact.sides.weight() * least);
        }
    }

    /// Where forces of contacts are to be changed after relations hold: changes them, and where the step leads with them.
    pub(crate) fn improve(
        &mut self,
        moving: &Moving,
        state: &SystemState,
        places: &mut [Vec3],
    ) -> Result<Improved, StepError> {
        let is_first = self.rounds == 0;
        let is_more = match std::mem::replace(&mut self.are_decided, true) {
            false => self.decide(moving, state, places)?,
            true => self.seek_more(moving, state, places)?,
        };
        self.measure(moving, state, places)?;
        if self.sought.is_empty() {
            return Ok(Improved::Nothing);
        }
        // what follows asks how contacts move each other, that a step is given up too
        let is_other = is_more || std::mem::take(&mut self.is_laid_out_otherwise);
        if is_other {
            self.lay_out(moving);
        }
        if is_other || moving.solved == Solved::WithOthers {
            self.fill(moving)?;
        }
        self.give_way();
        let judgement = match is_more {
            false => self.judge(),
            true if self.is_spent() => Judgement::Unsolved,
            true => Judgement::NotYet,
        };
        match judgement {
            Judgement::Solved => {
                self.change.clear();
                self.change.resize(self.places.len(), Vec3::ZERO);
                for (place, contact) in self.sought.iter().enumerate() {
                    self.places[place].force = self.contacts[*contact as usize].force;
                }
                return match self.wait_for_beyond_numbers() {
                    None => Ok(Improved::Nothing),
                    Some(worst) if !self.begin_jammed(moving, places) => {
                        Err(self.too_hard(moving, state, worst))
                    }
                    Some(_) => Ok(Improved::BegunAnew),
                };
            }
            Judgement::Unsolved => {
                self.wait_for_unsolved();
                return match self.begin_jammed(moving, places) {
                    true => Ok(Improved::BegunAnew),
                    false => Err(self.unsolved(moving.step, state)),
                };
            }
            Judgement::NotYet => {}
        }
        self.rounds += 1;
        if is_first && !self.is_jammed {
            self.scale = self
                .off
                .iter()
                .fold(0.0, |most, off| off.to_array().map(f64::abs).into_iter().fold(most, f64::max));
        }
        self.solve(is_first);
        if let Some(worst) = self.wait_for_beyond_numbers() {
            return match self.begin_jammed(moving, places) {
                true => Ok(Improved::BegunAnew),
                false => Err(self.too_hard(moving, state, worst)),
            };
        }
        self.push(moving, places);
        Ok(Improved::Forces)
    }

    /// Finds what the last improvement was to find together with multipliers between bounds, from where it began, and changes where the step leads by what
    /// contacts push; what multipliers are to change by.
    pub(crate) fn improve_with_bounded(
        &mut self,
        moving: &Moving,
        places: &mut [Vec3],
    ) -> Result<&[Vec3], StepError> {
        self.take_back();
        self.is_laid_out_otherwise = true;
        self.off.extend(moving.bounded.iter().map(|bounded| Vec3::X * bounded.off));
        self.lay_out(moving);
        self.fill(moving)?;
        self.solve(self.rounds == 1);
        self.tightness *= TIGHTER;
        self.push(moving, places);
        Ok(&self.change[self.sought.len()..])
    }

    /// Changes forces of contacts by what was found, and where the step leads.
    fn push(&mut self, moving: &Moving, places: &mut [Vec3]) {
        for (place, contact) in self.sought.iter().enumerate() {
            let contact = &mut self.contacts[*contact as usize];
            let change = self.change[place];
            contact.force += change;
            let push = contact.frame.transpose_apply(change);
            for (row, weight) in contact.sides.iter() {
                let moved = moving.inverse_masses[row] * push;
                places[row] += moved * (weight * moving.step.timestep * moving.step.timestep);
            }
        }
    }

    /// Takes back what forces were changed by last.
    fn take_back(&mut self) {
        for (contact, place) in self.sought.iter().zip(&self.places) {
            self.contacts[*contact as usize].force = place.force;
        }
    }

    /// The gap where the step leads, over the steepness [m].
    fn gap_at(
        &self,
        contact: &Contact,
        moving: &Moving,
        state: &SystemState,
        places: &[Vec3],
    ) -> Result<f64, StepError> {
        let (force, number) = contact.of;
        let Some(unilateral) = moving.step.system.forces[force].unilateral() else { return Ok(0.0) };
        let value = unilateral.gap(number, pairs_in(state, force), places, moving.step.end());
        if !value.is_finite() {
            return Err(fault(moving, state, contact.of, "has no value where the step leads"));
        }
        Ok(value / contact.steepness)
    }

    /// Which contacts collide, which come to rest, and which others may be pushed together by them; whether there are any.
    fn decide(&mut self, moving: &Moving, state: &SystemState, places: &[Vec3]) -> Result<bool, StepError> {
        self.off.clear();
        let mut deepest = 0.0_f64;
        for index in 0..self.contacts.len() {
            let contact = self.contacts[index];
            let end = self.gap_at(&contact, moving, state, places)?;
            deepest = deepest.max(-end);
            self.off.push(Vec3::X * end);
            if end < 0.0 && contact.narrowing < -contact.near && contact.law.restitution > 0.0 {
                self.contacts[index].wanted = contact.gap - contact.law.restitution * contact.narrowing;
            }
        }
        self.is_sought.clear();
        self.is_sought.resize(self.contacts.len(), false);
        for (index, contact) in self.contacts.iter().enumerate() {
            let end = self.off[index].x;
            if end < contact.near.max(deepest) || contact.force_before.x > 0.0 {
                self.is_sought[index] = true;
                self.sought.push(index as u32);
            }
        }
        Ok(!self.sought.is_empty())
    }

    /// Adds contacts that are pushed together by others; whether there are any.
    fn seek_more(
        &mut self,
        moving: &Moving,
        state: &SystemState,
        places: &[Vec3],
    ) -> Result<bool, StepError> {
        let mut is_any = false;
        for index in 0..self.contacts.len() {
            let contact = &self.contacts[index];
            if !self.is_sought[index] && self.gap_at(contact, moving, state, places)? < -contact.near {
                self.sought.push(index as u32);
                self.is_sought[index] = true;
                is_any = true;
            }
        }
        if is_any {
            self.sought.sort_unstable();
        }
        Ok(is_any)
    }

    /// How far off the sought contacts are where the step leads: the gap from what is wanted, and the slip [m].
    fn measure(&mut self, moving: &Moving, state: &SystemState, places: &[Vec3]) -> Result<(), StepError> {
        self.off.clear();
        for index in 0..self.sought.len() {
            let contact = &self.contacts[self.sought[index] as usize];
            let normal = self.gap_at(contact, moving, state, places)? - contact.wanted;
            let slip = contact.sides.relative(|row| places[row] - moving.positions[row]) - contact.carried;
            let slip = contact.frame * slip;
            self.off.push(Vec3::new(normal, slip.y, slip.z));
        }
        Ok(())
    }
}
