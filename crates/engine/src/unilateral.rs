//! Unilateral constraints: gaps that are not to close, kept open by forces and impulses that push and never pull.
//!
//! A contact has a gap `g(x, t)` with the unit normal `n` along which its points part, and the tangents `t`. A step that starts at `x` with `v` and
//! ends at `x' = x + h v'` finds, for all contacts of a system at once and together with what keeps relations ([`crate::binding`]), forces with
//!
//! - `0 ≤ f_n ⊥ g(x', t') − w ≥ 0`: signs, and one of the two zero;
//! - `|f_t| ≤ μ f_n`, `f_t = 0` with slip against it, `f_t = −μ f_n u_t/|u_t|`, or `u_t = 0` (Coulomb), with the slip `u_t` of the velocity `v'`.
//!
//! What is wanted, `w`, is 0 of contacts that rest or come to: they end closed, not deeper. Of one that would close in this step and whose gap narrowed in the
//! step before, it is `g + ε h |ġ|`: its points part with `ε` times the velocity of their approach (Newton's law of restitution). Forces that act for one step
//! are impulses `h f` then. That is the time stepping of Moreau (1988) and of Stewart & Trinkle (1996), with gaps as they are where the step ends
//! in place of their linearisations: nothing creeps into what it slides along. An elastic impact is the reversal of the step that led to it, to rounding.
//!
//! Forces follow by a projected Gauss–Seidel method over contacts, whose changes are extrapolated as those of conjugate gradients are
//! (Silcowitz-Hansen, Niebe & Erleben 2010), with the matrix `D = h² J W̃ Jᵀ` of what forces move contacts by. `W̃` are inverse masses with relations:
//! a rigid body is masses on exact rods. Where more contacts bear than are needed, of all forces that do the same those are found that are near to those of the step before.

use souple_math::{Mat3, Vec3};

use crate::binding::{Solved, Structure};
use crate::state::{Pair, SystemState, pairs_of};
use crate::steppers::{Step, StepError, StepReport};
use crate::system::System;

/// Of the greatest way by which a gap would be missed without forces: contacts that are off by less are solved. What several contacts
/// of a body ask of it must agree to this, or they hand forces on to each other without end: relations hold well below it.
const CONVERGED: f64 = 1e-7;
/// Likewise, what is let pass when no sweeps are left; the report of the step tells it.
const LET_PASS: f64 = 1e-4;
/// Of coordinates: ten times what relations are off by, for the same reason.
const TOLERANCE: f64 = 1e-11;
/// Sweeps over all contacts of a step.
const MOST_SWEEPS: u64 = 20_000;
/// Sweeps after which it is looked where the step leads: what contacts of a body do not agree about to rounding is not swept away.
const SWEEPS_OF_ROUND: u64 = 500;
/// Each makes the curvature of gaps and relations within the step the square of what it was, or finds contacts that others push together.
const MOST_ROUNDS: u32 = 100;
/// Points of a contact, at most: of two, or one against a triangle.
pub const MOST_SIDES: usize = 4;

/// What happens where a gap is closed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpactLaw {
    /// `ε`, from 0, where nothing bounces, to 1.
    pub restitution: f64,
    /// `μ`.
    pub friction: f64,
}

/// The points of a contact, whose relative velocity is `Σ w v`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sides {
    rows: [u32; MOST_SIDES],
    weights: [f64; MOST_SIDES],
    count: usize,
}

impl Sides {
    /// One point against what is no point.
    pub fn one(row: u32) -> Self {
        Self { rows: [row, 0, 0, 0], weights: [1.0, 0.0, 0.0, 0.0], count: 1 }
    }

    /// Two points.
    pub fn two([a, b]: [u32; 2]) -> Self {
        Self { rows: [a, b, 0, 0], weights: [1.0, -1.0, 0.0, 0.0], count: 2 }
    }

    /// Rows with their weights.
    pub fn iter(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let rows = self.rows[..self.count].iter().map(|row| *row as usize);
        rows.zip(self.weights[..self.count].iter().copied())
    }

    fn relative(&self, of_rows: impl Fn(usize) -> Vec3) -> Vec3 {
        self.iter().map(|(row, weight)| of_rows(row) * weight).sum()
    }
}

/// What of a force keeps gaps open. Numbers of contacts are below [`Unilateral::contact_count`], of the pairs at hand.
///
/// Its first number of memory is the work that its forces have done [J].
pub trait Unilateral: Send + Sync {
    fn contact_count(&self, pairs: &[Pair]) -> usize;

    fn sides(&self, contact: usize, pairs: &[Pair]) -> Sides;

    /// `g(x, t)`, negative where it is closed too far.
    fn gap(&self, contact: usize, pairs: &[Pair], positions: &[Vec3], time: f64) -> f64;

    /// What the gap changes by with the relative place of its points, `∂g/∂(Σ w x)`; zero where no direction opens it.
    fn slope(&self, contact: usize, pairs: &[Pair], positions: &[Vec3], time: f64) -> Vec3;

    /// Of what points are against, where that is no point [m/s].
    fn surface_velocity(&self, _contact: usize, _time: f64) -> Vec3 {
        Vec3::ZERO
    }

    fn law(&self) -> ImpactLaw;

    /// On the points of weight one, as it was found last [N].
    fn force(&self, contact: usize, memory: &[f64], pairs: &[Pair]) -> Vec3;

    fn set_force(&self, contact: usize, memory: &mut [f64], pairs: &mut [Pair], force: Vec3);

    /// What it is, in words.
    fn describe(&self, contact: usize, pairs: &[Pair]) -> String;
}

/// What a step that is being made stands on.
pub(crate) struct Moving<'a> {
    pub step: &'a Step<'a>,
    pub structure: &'a Structure,
    /// How relations were solved for last.
    pub solved: Solved,
    /// Where the step starts [m].
    pub positions: &'a [Vec3],
    /// One step before [m].
    pub before: &'a [Vec3],
    /// By row [1/kg].
    pub inverse_masses: &'a [Mat3],
    /// Scaled, for each entry of the structure.
    pub gradients: &'a [Mat3],
    /// Ones in the components of relations that forces change.
    pub active: &'a [Vec3],
}

/// A contact in a step. Vectors are along the normal and two tangents.
#[derive(Clone, Copy, Debug)]
struct Contact {
    /// Index in the system, and the number within the force.
    of: (usize, usize),
    sides: Sides,
    /// Rows are the normal and the tangents.
    frame: Mat3,
    /// `|∂g/∂x|`.
    steepness: f64,
    law: ImpactLaw,
    /// Where the step starts, over the steepness [m].
    gap: f64,
    /// Change of the gap in the step before, likewise [m].
    narrowing: f64,
    /// The gap at the end, likewise [m].
    wanted: f64,
    /// How far what points are against moves in the step [m].
    carried: Vec3,
    /// [N]
    force: Vec3,
    /// Of the step before [N].
    force_before: Vec3,
    /// How far off it may be by rounding [m].
    near: f64,
}

/// What a sweep did to forces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sweep {
    Settled,
    Moved,
}

/// Scratch of the contacts of a system, kept between steps.
#[derive(Debug, Default)]
pub(crate) struct ContactSystem {
    contacts: Vec<Contact>,
    /// Numbers of those that forces are sought of, ascending, and how far each is off where the step leads.
    sought: Vec<u32>,
    off: Vec<Vec3>,
    /// Of each contact, whether forces are sought of it.
    is_sought: Vec<bool>,
    /// `(body, place among the sought)`, sorted.
    touches: Vec<(u32, u32)>,
    /// `D` by rows: where those of each begin, columns ascending, blocks [m/N].
    starts: Vec<usize>,
    columns: Vec<u32>,
    blocks: Vec<Mat3>,
    /// Of each that is sought the slot on the diagonal, `D_nn`, and the greatest eigenvalue of `D_tt`.
    own: Vec<usize>,
    stiffest: Vec<[f64; 2]>,
    /// What forces are changed by, in all and in a sweep, and the direction that changes go on in.
    change: Vec<Vec3>,
    swept: Vec<Vec3>,
    direction: Vec<Vec3>,
    response: Vec<Vec3>,
    /// The greatest way by which a gap or a slip is off without forces [m].
    scale: f64,
    rounds: u32,
    report: StepReport,
}

impl System {
    /// Whether forces keep gaps open that a step is to solve for.
    pub fn has_contacts(&self) -> bool {
        self.forces.iter().any(|force| force.unilateral().is_some())
    }
}

fn pairs_in(state: &SystemState, force: usize) -> &[Pair] {
    &state.pairs[pairs_of(&state.pairs, force)]
}

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
        let earlier = (start - timestep).max(0.0);
        for (index, force) in system.forces.iter().enumerate() {
            let Some(unilateral) = force.unilateral() else { continue };
            let (pairs, memory) = (pairs_in(state, index), &state.memory[system.memory_range(index)]);
            for number in 0..unilateral.contact_count(pairs) {
                let sides = unilateral.sides(number, pairs);
                let slope = unilateral.slope(number, pairs, moving.positions, start);
                let steepness = slope.length();
                let value = unilateral.gap(number, pairs, moving.positions, start);
                let stored = unilateral.force(number, memory, pairs);
                for (row, weight) in sides.iter() {
                    places[row] -= moving.inverse_masses[row] * stored * (weight * timestep * timestep);
                }
                if !(value.is_finite() && steepness.is_finite()) {
                    let what = "has no value, or no slope, where masses are";
                    return Err(fault(moving.step, state, (index, number), what));
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
                let weights: f64 = sides.iter().map(|(_, weight)| weight.abs()).sum();
                self.contacts.push(Contact {
                    of: (index, number),
                    sides,
                    frame,
                    steepness,
                    law: unilateral.law(),
                    gap: value / steepness,
                    narrowing: (value - before) / steepness,
                    wanted: 0.0,
                    carried: unilateral.surface_velocity(number, start + timestep) * timestep,
                    force: Vec3::ZERO,
                    force_before: frame * stored,
                    near: TOLERANCE * weights * reach,
                });
            }
        }
        Ok(())
    }

    /// Where forces of contacts are to be changed after relations hold: changes them, and where the step leads with them; whether there was anything to change.
    pub(crate) fn improve(
        &mut self,
        moving: &Moving,
        state: &SystemState,
        places: &mut [Vec3],
    ) -> Result<bool, StepError> {
        let is_first = self.rounds == 0;
        let is_more = match is_first {
            true => self.decide(moving, state, places)?,
            false => self.seek_more(moving, state, places)?,
        };
        self.measure(moving, state, places)?;
        if self.sought.is_empty() {
            return Ok(false);
        }
        // what follows asks how contacts move each other, that a step is given up too
        if is_more {
            self.lay_out(moving);
        }
        if is_more || moving.solved == Solved::WithOthers {
            self.fill(moving)?;
        }
        if !is_more && self.is_solved() {
            return Ok(false);
        }
        if self.rounds == MOST_ROUNDS || self.report.contact_iterations >= MOST_SWEEPS {
            return Err(self.unsolved(moving.step, state));
        }
        self.rounds += 1;
        if is_first {
            self.scale = self
                .off
                .iter()
                .fold(0.0, |most, off| off.to_array().map(f64::abs).into_iter().fold(most, f64::max));
        }
        self.solve(is_first);
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
        Ok(true)
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
            return Err(fault(moving.step, state, contact.of, "has no value where the step leads"));
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

    /// Whether no contact asks for another force, or sweeps do not help any more and what is left may pass.
    fn is_solved(&mut self) -> bool {
        let (mut worst, mut is_solved) = (0.0_f64, true);
        for (place, contact) in self.sought.iter().enumerate() {
            let contact = &self.contacts[*contact as usize];
            let by = self.wanted_change(place, contact.force, self.off[place], contact.law.friction);
            let off = self.length_of(place, by);
            worst = worst.max(off);
            is_solved &= off <= contact.near + CONVERGED * self.scale;
        }
        self.report.contact_residual = if worst > 0.0 { worst / self.scale.max(worst) } else { 0.0 };
        is_solved || self.report.contact_iterations >= MOST_SWEEPS && self.report.contact_residual <= LET_PASS
    }

    /// What a contact that is off asks its force to change by: the projection onto signs, and then onto the friction cone, with the slip that the
    /// normal force leaves.
    fn wanted_change(&self, place: usize, force: Vec3, off: Vec3, friction: f64) -> Vec3 {
        let [normal, tangent] = self.stiffest[place];
        if normal <= 0.0 {
            return Vec3::ZERO;
        }
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

    /// How far a change of a contact's force moves itself [m].
    fn length_of(&self, place: usize, change: Vec3) -> f64 {
        let [normal, tangent] = self.stiffest[place];
        (change.x.abs() * normal).max(change.y.hypot(change.z) * tangent)
    }

    /// Which contacts move each other: those that touch one body.
    fn lay_out(&mut self, moving: &Moving) {
        self.touches.clear();
        for (place, contact) in self.sought.iter().enumerate() {
            for (row, _) in self.contacts[*contact as usize].sides.iter() {
                if moving.inverse_masses[row] != Mat3::ZERO {
                    self.touches.push((moving.structure.body(row), place as u32));
                }
            }
        }
        self.touches.sort_unstable();
        self.touches.dedup();
        self.starts.clear();
        self.columns.clear();
        self.starts.push(0);
        for place in 0..self.sought.len() {
            let first = self.columns.len();
            // its own is always there
            self.columns.push(place as u32);
            let sides = self.contacts[self.sought[place] as usize].sides;
            for (row, _) in sides.iter().filter(|(row, _)| moving.inverse_masses[*row] != Mat3::ZERO) {
                let touching = self.touching(moving.structure.body(row));
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
    fn fill(&mut self, moving: &Moving) -> Result<(), StepError> {
        let square = moving.step.timestep * moving.step.timestep;
        self.blocks.clear();
        self.blocks.resize(self.columns.len(), Mat3::ZERO);
        for place in 0..self.sought.len() {
            let contact = self.contacts[self.sought[place] as usize];
            for slot in self.starts[place]..self.starts[place + 1] {
                let other = &self.contacts[self.sought[self.columns[slot] as usize] as usize];
                let mut block = Mat3::ZERO;
                for (row, weight) in contact.sides.iter() {
                    for (_, other_weight) in other.sides.iter().filter(|(other, _)| *other == row) {
                        let moved = contact.frame * moving.inverse_masses[row];
                        block += moved.mul_transpose(&other.frame) * (weight * other_weight * square);
                    }
                }
                self.blocks[slot] = block;
            }
        }
        self.subtract_relations(moving, square)?;
        self.stiffest.clear();
        self.own.clear();
        for place in 0..self.sought.len() {
            self.own.push(self.slot(place, place as u32));
            let own = self.blocks[self.own[place]];
            let [a, b, c] = [own.entry(1, 1), own.entry(1, 2), own.entry(2, 2)];
            let tangent = 0.5 * (a + c) + (0.5 * (a - c)).hypot(b);
            self.stiffest.push([own.entry(0, 0), tangent]);
        }
        Ok(())
    }

    /// What relations take of how far forces move contacts. One solve serves one contact of each body, since bodies do not share relations.
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
                    let contact = self.touches[of_body]
                        .get(turn)
                        .map(|(_, place)| &self.contacts[self.sought[*place as usize] as usize]);
                    // nothing without friction pushes across
                    if let Some(contact) = contact.filter(|it| axis == 0 || it.law.friction > 0.0) {
                        let direction = contact.frame.row(axis);
                        for (row, weight) in contact.sides.iter() {
                            if structure.body(row) != body {
                                continue;
                            }
                            let moved = moving.inverse_masses[row] * direction * weight;
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

    /// The greatest number of contacts that touch one body.
    fn most_of_a_body(&self) -> usize {
        self.touches.chunk_by(|a, b| a.0 == b.0).map(<[_]>::len).max().unwrap_or(0)
    }

    /// Takes one column of each body off, by the multipliers of relations that one contact of it asks for.
    fn subtract_response(&mut self, moving: &Moving, (turn, axis): (usize, usize), square: f64) {
        let structure = moving.structure;
        let mut first = 0;
        while first < self.touches.len() {
            let (body, _) = self.touches[first];
            let of_body = self.touching(body);
            first = of_body.end;
            let Some((_, column)) = self.touches[of_body.clone()].get(turn).copied() else { continue };
            let law = self.contacts[self.sought[column as usize] as usize].law;
            if axis > 0 && law.friction == 0.0 {
                continue;
            }
            for at in of_body {
                let (_, place) = self.touches[at];
                let contact = &self.contacts[self.sought[place as usize] as usize];
                let mut moved = Vec3::ZERO;
                for (row, weight) in contact.sides.iter().filter(|(row, _)| structure.body(*row) == body) {
                    let pull: Vec3 = structure
                        .entries_of(row)
                        .map(|(relation, entry)| {
                            moving.gradients[entry].transpose_apply(self.response[relation])
                        })
                        .sum();
                    moved += moving.inverse_masses[row] * pull * (weight * square);
                }
                let change = contact.frame * moved;
                let slot = self.slot(place as usize, column);
                let block = &mut self.blocks[slot];
                let mut columns = block.columns;
                columns[axis] -= change;
                *block = Mat3 { columns };
            }
        }
    }

    /// Finds what forces are to be changed by, in sweeps. The first of a step begins with the forces of the step before.
    fn solve(&mut self, is_first: bool) {
        let count = self.sought.len();
        for list in [&mut self.change, &mut self.swept, &mut self.direction] {
            list.clear();
            list.resize(count, Vec3::ZERO);
        }
        if is_first {
            for (place, contact) in self.sought.iter().enumerate() {
                self.change[place] = self.contacts[*contact as usize].force_before;
            }
        }
        let mut size_before = f64::INFINITY;
        for sweep in 1..=SWEEPS_OF_ROUND {
            self.report.contact_iterations += 1;
            // what is extrapolated may pull or leave its cone: a round ends with a sweep
            if self.sweep() == Sweep::Settled || sweep == SWEEPS_OF_ROUND {
                return;
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
            for place in 0..count {
                self.change[place] += self.direction[place] * ratio;
                self.direction[place] = self.direction[place] * ratio + self.swept[place];
            }
        }
    }

    /// Gives each contact in turn the force that it asks for.
    fn sweep(&mut self) -> Sweep {
        let mut found = Sweep::Settled;
        for place in 0..self.sought.len() {
            let contact = &self.contacts[self.sought[place] as usize];
            let mut off = self.off[place];
            for slot in self.starts[place]..self.starts[place + 1] {
                off += self.blocks[slot] * self.change[self.columns[slot] as usize];
            }
            let by = self.wanted_change(place, contact.force + self.change[place], off, contact.law.friction);
            // closer than is asked where the step leads, where it is measured again
            if self.length_of(place, by) > 0.2 * (CONVERGED * self.scale + contact.near) {
                found = Sweep::Moved;
            }
            self.swept[place] = by;
            self.change[place] += by;
        }
        found
    }

    fn unsolved(&self, step: &Step, state: &SystemState) -> StepError {
        let mut worst = (0.0, (0, 0), 0);
        for (place, contact) in self.sought.iter().enumerate() {
            let contact = &self.contacts[*contact as usize];
            let by = self.wanted_change(place, contact.force, self.off[place], contact.law.friction);
            let off = self.length_of(place, by);
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

    /// Adds the change of forces to those on rows, along what is free, and remembers forces and work.
    pub(crate) fn give(
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

    pub(crate) fn bytes(&self) -> usize {
        let vectors =
            [&self.off, &self.change, &self.swept, &self.direction, &self.response].map(Vec::capacity);
        size_of::<Contact>() * self.contacts.capacity()
            + size_of::<Vec3>() * vectors.iter().sum::<usize>()
            + size_of::<Mat3>() * self.blocks.capacity()
            + size_of::<[f64; 2]>() * self.stiffest.capacity()
            + 8 * (self.touches.capacity() + self.starts.capacity() + self.own.capacity())
            + self.is_sought.capacity()
            + 4 * (self.sought.capacity() + self.columns.capacity())
    }
}

fn described(step: &Step, state: &SystemState, (force, number): (usize, usize)) -> String {
    let unilateral = step.system.forces[force].unilateral();
    unilateral.map_or_else(String::new, |it| it.describe(number, pairs_in(state, force)))
}

/// What of a contact a step cannot go on from.
fn fault(step: &Step, state: &SystemState, of: (usize, usize), what: &str) -> StepError {
    let sides = step.system.forces[of.0].unilateral().map(|it| it.sides(of.1, pairs_in(state, of.0)));
    StepError::Fault {
        force: step.system.forces[of.0].name().to_owned(),
        row: sides.map_or(0, |sides| sides.rows[0] as usize),
        what: format!("{} {what}", described(step, state, of)),
        time: step.start,
    }
}
