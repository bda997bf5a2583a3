//! Multitudes: balls of one group, or of two, that act on each other wherever they come near.
//!
//! What is near is searched in a grid: the same pairs as of all with all, since a law has a range beyond which it gives no
//! force. State holds what pairs remember; the others are found anew, but for steppers that ask which rows a force couples:
//! for those all pairs stand in State ([`Listing`]).

use std::any::Any;
use std::ops::Range;

use rayon::prelude::*;
use souple_engine::{
    Configuration, ContactPoint, Declaration, Energy, Force, Kept, Pair, Scratch, TangentWeights,
};
use souple_math::{Mat3, Vec3};
use souple_solve::{BlockMatrix, reduce};

use super::crowd_grid::Grid;
use super::crowd_list::{Groups, Neighbours};
use super::crowd_pass::{Evaluation, Known, Pass, Task, key};
use super::friction::{Friction, Hook, Phase};
use super::fusible::{Bond, Fusible, MOLTEN};
use super::kernel::LinkKernel;
use super::law::{Moment, Reach, Response};
use super::pair_tangent::{add_change, add_pair_blocks};

/// Numbers of a pair that belong to friction; those of the law follow.
const HOOK: usize = 4;
/// Numbers that a law may remember of a pair.
pub const PAIR_MEMORY: usize = 8 - HOOK;

/// What a multitude is made of.
#[derive(Debug)]
pub struct CrowdDescription {
    pub name: String,
    pub law: Box<dyn LinkKernel>,
    /// Rows of the one group, or of the first.
    pub first: Range<u32>,
    /// Rows of the second group, which shares none with the first; the first again where there is one.
    pub second: Range<u32>,
    /// Beyond it there is no force [m].
    pub range: f64,
    pub friction: Option<Friction>,
    /// Bonds beside the law that melt and set, and the temperatures of the masses.
    pub fusible: Option<Fusible>,
    /// Of the system [s].
    pub timestep: f64,
    pub listing: Listing,
}

/// Where pairs are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Listing {
    /// All of them in State, for steppers that make matrices.
    State,
    /// In lists of the crowd's own; in State what some remember. Smaller and faster by far.
    Own,
}

/// Balls that act on each other within a range.
#[derive(Debug)]
pub struct Crowd(CrowdDescription);

/// How a pair stands.
struct Standing {
    pair: [u32; 2],
    d: Vec3,
    before: Vec3,
    reach: Reach,
}

/// What a pair does.
struct Act {
    /// On the first ball [N].
    axial: Vec3,
    across: Vec3,
    energy: Energy,
    memory: [f64; 8],
}

/// What a crowd works with.
#[derive(Default)]
struct Work {
    grid: Grid,
    /// Pairs of each so many balls of the first group.
    found: Vec<Vec<[u32; 2]>>,
    /// On the first balls of pairs [N].
    forces: Vec<Vec3>,
    /// Into each mass from its neighbours [W].
    flows: Vec<f64>,
    list: Neighbours,
    pass: Pass,
}

impl Work {
    fn of(scratch: &mut Scratch) -> &mut Self {
        scratch.downcast_mut().unwrap_or_else(|| unreachable!("made by this force's own new_scratch"))
    }
}

/// Balls of the first group whose pairs are found by one thread.
const SEARCHED_TOGETHER: usize = 512;

impl Crowd {
    pub fn new(description: CrowdDescription) -> Self {
        let bond = usize::from(description.fusible.is_some());
        assert!(description.law.memory_len() + bond <= PAIR_MEMORY, "laws of pairs remember few numbers");
        Self(description)
    }

    /// Masses that have a temperature.
    pub fn temperature_count(&self) -> usize {
        self.0.fusible.as_ref().map_or(0, |_| self.mass_count())
    }

    /// Numbers of a pair that the law remembers, and its bond behind them.
    pub fn remembered_len(&self) -> usize {
        self.0.law.memory_len() + usize::from(self.0.fusible.is_some())
    }

    /// Masses of both groups.
    fn mass_count(&self) -> usize {
        self.0.first.len() + if self.groups().is_one() { 0 } else { self.0.second.len() }
    }

    /// The number of a row among the masses of both groups.
    fn mass_of(&self, row: u32) -> usize {
        let CrowdDescription { first, second, .. } = &self.0;
        if first.contains(&row) {
            (row - first.start) as usize
        } else {
            first.len() + (row - second.start) as usize
        }
    }

    /// Temperature of the mass of a row, of a crowd that is fusible and has it, by its memory [K].
    pub fn temperature(&self, row: u32, memory: &[f64]) -> Option<f64> {
        let CrowdDescription { first, second, fusible, .. } = &self.0;
        let is_here = fusible.is_some() && (first.contains(&row) || second.contains(&row));
        is_here.then(|| memory[1 + self.mass_of(row)])
    }

    /// Calls `visit` for the ends of every bond that has not melted.
    pub fn visit_bonds(&self, at: &Configuration, mut visit: impl FnMut([u32; 2])) {
        let Some(fusible) = &self.0.fusible else { return };
        self.visit_standing(at, &mut Work::default(), |standing, memory| {
            if self.bond(fusible, standing, memory, at).rest != MOLTEN {
                visit(standing.pair);
            }
        });
    }

    /// `Te (Σ g + e)/c` where it is most, with the mass: beyond 1 temperatures swing from step to step. `None` where nothing
    /// is fusible.
    pub fn heat_share(&self, positions: &[Vec3]) -> Option<(f64, u32)> {
        let fusible = self.0.fusible.as_ref()?;
        let mut neighbours = vec![0; self.mass_count()];
        let mut list = Neighbours::default();
        list.bring_up_to_date(self.groups(), positions, self.0.range);
        for (ball, row) in self.0.first.clone().enumerate() {
            let is_near = |other: &&u32| {
                (positions[row as usize] - positions[**other as usize]).length() < fusible.reach
            };
            for other in list.others(ball).iter().filter(is_near) {
                neighbours[ball] += 1;
                neighbours[self.mass_of(*other)] += 1;
            }
        }
        let second = if self.groups().is_one() { 0..0 } else { self.0.second.clone() };
        let share = |row: u32| {
            let place = positions[row as usize];
            (fusible.share(self.0.timestep, neighbours[self.mass_of(row)], place), row)
        };
        self.0.first.clone().chain(second).map(share).max_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// The bond of a pair.
    fn bond(&self, fusible: &Fusible, standing: &Standing, memory: &[f64; 8], at: &Configuration) -> Bond {
        let [a, b] = standing.pair.map(|row| at.memory[1 + self.mass_of(row)]);
        fusible.bond(&standing.reach, 0.5 * (a + b), memory[HOOK + self.0.law.memory_len()])
    }

    /// Moves temperatures on by a step.
    fn conduct(&self, at: &Configuration, work: &mut Work, memory: &mut [f64]) {
        let Some(fusible) = &self.0.fusible else { return };
        let mut flows = std::mem::take(&mut work.flows);
        flows.clear();
        flows.resize(self.mass_count(), 0.0);
        self.visit_standing(at, work, |standing, _| {
            if standing.reach.length < fusible.reach {
                let [a, b] = standing.pair.map(|row| self.mass_of(row));
                let flow = fusible.conductance * (at.memory[1 + b] - at.memory[1 + a]);
                flows[a] += flow;
                flows[b] -= flow;
            }
        });
        let second = if self.groups().is_one() { 0..0 } else { self.0.second.clone() };
        let places = self.0.first.clone().chain(second).map(|row| at.positions[row as usize]);
        fusible.advance(self.0.timestep, at.time, places, &flows, &mut memory[1..]);
        work.flows = flows;
    }

    /// Beyond it there is no force [m].
    pub fn range(&self) -> f64 {
        self.0.range
    }

    /// Rows of the first group and of the second, which is the first again where there is one.
    pub fn rows(&self) -> [Range<u32>; 2] {
        [self.0.first.clone(), self.0.second.clone()]
    }

    /// What a pair takes of the bound `4M` on its masses (see [`super::LinkLaw::stiffest`]) [N/m].
    pub fn stiffest(&self) -> f64 {
        let hook =
            self.0.friction.as_ref().map_or(0.0, |friction| friction.stiffness + 2.0 * friction.damping);
        let bond = self.0.fusible.as_ref().map_or(0.0, Fusible::stiffest);
        (self.0.law.stiffest_within(self.0.range) + bond).max(hook)
    }

    /// What the law stores in a pair that is as far apart as the range [J]; nothing of laws with memory, whose pairs begin there at rest.
    fn stored_at_range(&self, time: f64) -> f64 {
        let CrowdDescription { law, range, .. } = &self.0;
        let reach = Reach { length: *range, before: *range, rest: *range };
        let stored = match law.memory_len() {
            0 => law.respond(&reach, &Moment::of(time), &[]).stored,
            _ => 0.0,
        };
        // a law that has no number there has no end there either
        if stored.is_finite() { stored } else { 0.0 }
    }

    fn groups(&self) -> Groups<'_> {
        Groups { first: &self.0.first, second: &self.0.second }
    }

    fn standing(&self, pair: [u32; 2], at: &Configuration) -> Standing {
        let [a, b] = pair.map(|row| row as usize);
        let d = at.positions[a] - at.positions[b];
        self.between(pair, [d, d - (at.velocities[a] - at.velocities[b]) * self.0.timestep])
    }

    fn between(&self, pair: [u32; 2], [d, before]: [Vec3; 2]) -> Standing {
        let reach = Reach { length: d.length(), before: before.length(), rest: self.0.range };
        Standing { pair, d, before, reach }
    }

    fn law_memory<'m>(&self, memory: &'m [f64; 8]) -> &'m [f64] {
        &memory[HOOK..HOOK + self.0.law.memory_len()]
    }

    /// `None` out of range, but for a bond that tears there.
    fn act(&self, standing: &Standing, memory: &[f64; 8], at: &Configuration) -> Option<Act> {
        let Standing { d, before, reach, .. } = *standing;
        if reach.length >= self.0.range {
            return self.tear(standing, memory, at);
        }
        let mut next = *memory;
        let own = self.law_memory(memory);
        let Response { mut push, stored, heat } = self.0.law.respond(&reach, &Moment::of(at.time), own);
        let u = d.try_normalised().or(before.try_normalised()).unwrap_or(Vec3::X);
        let mut energy = Energy { stored, dissipated: heat };
        let mut across = Vec3::ZERO;
        if let Some(friction) = &self.0.friction {
            // the elastic part alone presses
            let still = Reach { before: reach.length, ..reach };
            let normal = self.0.law.respond(&still, &Moment::of(at.time), own).push;
            let hook = Hook::from_numbers(std::array::from_fn(|i| memory[i]));
            let grip = friction.grip(hook, d, before, normal);
            across = grip.force;
            energy.stored += grip.stored;
            energy.dissipated += grip.heat;
            next[..HOOK].copy_from_slice(&grip.next.numbers());
        }
        if let Some(fusible) = &self.0.fusible {
            let bond = self.bond(fusible, standing, memory, at);
            push += bond.push;
            energy.stored += bond.stored;
            energy.dissipated += bond.heat;
            next[HOOK + self.0.law.memory_len()] = bond.rest;
        }
        Some(Act { axial: u * push, across, energy, memory: next })
    }

    /// What a bond gives off that is out of range and was in it a step before: all that it stored.
    fn tear(&self, standing: &Standing, memory: &[f64; 8], at: &Configuration) -> Option<Act> {
        let bond_at = HOOK + self.0.law.memory_len();
        let fusible = self.0.fusible.as_ref()?;
        if memory[bond_at] == MOLTEN {
            return None;
        }
        // velocities of some steppers are not those that led here
        let length = standing.reach.before.min(self.0.range);
        let still = Reach { length, before: length, ..standing.reach };
        let before = Standing { reach: still, ..*standing };
        let heat = self.bond(fusible, &before, memory, at).stored;
        let mut next = *memory;
        next[..HOOK].copy_from_slice(&Hook::FREE.numbers());
        next[bond_at] = MOLTEN;
        let energy = Energy { stored: 0.0, dissipated: heat };
        Some(Act { axial: Vec3::ZERO, across: Vec3::ZERO, energy, memory: next })
    }

    /// The same of a pair in State.
    fn act_of(&self, pair: &Pair, at: &Configuration) -> Option<Act> {
        self.act(&self.standing([pair.a as u32, pair.b as u32], at), &pair.memory, at)
    }

    /// Numbers that State has of a pair that is not listed there: of a hook where it began, before those of the law.
    fn own_len(&self) -> usize {
        match (&self.0.friction, self.remembered_len()) {
            (None, own) => own,
            // who is there sticks
            (Some(_), 0) => HOOK - 1,
            (Some(_), own) => HOOK + own,
        }
    }

    /// What a pair remembers, from the numbers that State has of it.
    fn recalled(&self, known: Option<&[f64]>, length: f64) -> [f64; 8] {
        let (mut memory, law, own) = ([0.0; 8], self.0.law.memory_len(), self.remembered_len());
        match known {
            None => {
                if law > 0 {
                    self.0.law.begin(self.0.range, length, &mut memory[HOOK..HOOK + law]);
                }
            }
            Some(numbers) if self.0.friction.is_none() => memory[HOOK..HOOK + own].copy_from_slice(numbers),
            Some(numbers) if own > 0 => memory[..HOOK + own].copy_from_slice(numbers),
            Some(&[x, y, z]) => {
                let hook = Hook { phase: Phase::Stick, began: Vec3::new(x, y, z) };
                memory[..HOOK].copy_from_slice(&hook.numbers());
            }
            Some(numbers) => unreachable!("{} numbers of a hook", numbers.len()),
        }
        memory
    }

    /// A pair that is not plain in a pass: the force on the first ball.
    fn act_alone(
        &self,
        at: &Configuration,
        (pair, ways): ([u32; 2], [Vec3; 2]),
        known: Option<&[f64]>,
        task: &mut Task,
    ) -> Vec3 {
        let standing = self.between(pair, ways);
        let memory = self.recalled(known, standing.reach.length);
        let Some(act) = self.act(&standing, &memory, at) else { return Vec3::ZERO };
        task.heat += act.energy.dissipated;
        if standing.reach.length >= self.0.range {
            return Vec3::ZERO;
        }
        let own = if self.0.friction.is_some() { 0 } else { HOOK };
        task.keep(pair, &act.memory[own..HOOK + self.remembered_len()]);
        act.axial + act.across
    }

    /// Evaluates all pairs that are not in State; forces are added to `out`.
    fn pass(&self, at: &Configuration, work: &mut Work, out: Option<&mut [Vec3]>) {
        let CrowdDescription { law, range, friction, timestep, .. } = &self.0;
        let groups = self.groups();
        work.list.bring_up_to_date(groups, at.positions, *range);
        let with = Evaluation {
            groups,
            list: &work.list,
            law: law.as_ref(),
            friction: friction.as_ref(),
            range: *range,
            timestep: *timestep,
            kept_len: self.own_len(),
            are_plain: self.remembered_len() == 0,
        };
        let act = |pair, ways, known: Option<&[f64]>, task: &mut Task| {
            self.act_alone(at, (pair, ways), known, task)
        };
        work.pass.run(&with, at, out, &act);
    }

    /// Calls `visit` for every pair that may be in range, with what it remembers, in the order of rows.
    fn visit_standing(
        &self,
        at: &Configuration,
        work: &mut Work,
        mut visit: impl FnMut(&Standing, &[f64; 8]),
    ) {
        if self.0.listing == Listing::State {
            for pair in at.pairs {
                visit(&self.standing([pair.a as u32, pair.b as u32], at), &pair.memory);
            }
            return;
        }
        work.list.bring_up_to_date(self.groups(), at.positions, self.0.range);
        let mut known = Known::from(at.kept, self.own_len(), self.0.first.start);
        for (ball, row) in self.0.first.clone().enumerate() {
            for other in work.list.others(ball) {
                let standing = self.standing([row, *other], at);
                if standing.reach.length < self.0.range {
                    let known = known.find(key(standing.pair));
                    visit(&standing, &self.recalled(known, standing.reach.length));
                }
            }
        }
    }

    fn visit_tangents(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        mut visit: impl FnMut([u32; 2], Mat3),
    ) {
        self.visit_standing(at, Work::of(scratch), |standing, memory| {
            let Standing { pair, d, before, reach } = *standing;
            let (Some(n), true) = (d.try_normalised(), reach.length < self.0.range) else { return };
            let m = before.try_normalised().unwrap_or(n);
            let own = self.law_memory(memory);
            let pressed = self.0.law.respond(&reach, &Moment::of(at.time), own).push;
            let ([mut now, mut past], mut push) =
                (self.0.law.slopes(&reach, &Moment::of(at.time), own), pressed);
            if let Some(fusible) = &self.0.fusible {
                let bond = self.bond(fusible, standing, memory, at);
                push += bond.push;
                now += bond.slopes[0];
                past += bond.slopes[1];
            }
            let side = push / reach.length;
            let mut position = n.outer(n) * (now - side) + Mat3::IDENTITY * side + n.outer(m) * past;
            let mut velocity = n.outer(m) * (-self.0.timestep * past);
            if let Some(friction) = &self.0.friction
                && pressed > 0.0
            {
                // the hook as it is while it sticks
                let across = Mat3::IDENTITY - n.outer(n);
                position -= across * friction.stiffness;
                velocity -= across * (friction.damping * self.0.timestep);
            }
            visit(pair, position * weights.position + velocity * weights.velocity);
        });
    }
}

impl Force for Crowd {
    fn name(&self) -> &str {
        &self.0.name
    }

    fn declaration(&self) -> Declaration {
        let is_plain = self.0.friction.is_none() && self.0.fusible.is_none();
        let conservative = self.0.law.is_conservative() && is_plain;
        Declaration {
            conservative,
            velocity_terms: !conservative,
            symmetric_tangent: conservative,
            // friction leaves a couple that no ball bears
            internal: self.0.friction.is_none(),
            changing_pattern: self.0.listing == Listing::State,
        }
    }

    /// The heat given off, then the temperatures of the masses.
    fn memory_len(&self) -> usize {
        1 + if self.0.fusible.is_some() { self.mass_count() } else { 0 }
    }

    fn initial_memory(&self, memory: &mut [f64]) {
        memory[0] = 0.0;
        if let Some(fusible) = &self.0.fusible {
            memory[1..].copy_from_slice(&fusible.temperatures);
        }
    }

    fn new_scratch(&self) -> Scratch {
        Box::new(Work::default())
    }

    /// Stored energy counts from the range, so that it does not jump where pairs come and go.
    fn energy(&self, at: &Configuration, scratch: &mut Scratch) -> Energy {
        let (mut stored, at_range) = (0.0, self.stored_at_range(at.time));
        self.visit_standing(at, Work::of(scratch), |standing, memory| {
            let act = self.act(standing, memory, at).filter(|_| standing.reach.length < self.0.range);
            stored += act.map_or(0.0, |act| act.energy.stored - at_range);
        });
        Energy { stored, dissipated: at.memory[0] }
    }

    fn add_force(&self, at: &Configuration, scratch: &mut Scratch, out: &mut [Vec3]) {
        if self.0.listing == Listing::Own {
            self.pass(at, Work::of(scratch), Some(out));
            return;
        }
        let forces = &mut Work::of(scratch).forces;
        forces.resize(at.pairs.len(), Vec3::ZERO);
        reduce::sum_mut(0, forces, &|first, forces: &mut [Vec3]| {
            for (force, pair) in forces.iter_mut().zip(&at.pairs[first..]) {
                *force = self.act_of(pair, at).map_or(Vec3::ZERO, |act| act.axial + act.across);
            }
            0.0
        });
        // added pair by pair, in order
        for (pair, force) in at.pairs.iter().zip(forces) {
            out[pair.a as usize] += *force;
            out[pair.b as usize] -= *force;
        }
    }

    fn add_differential(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        scratch: &mut Scratch,
        out: &mut [Vec3],
    ) {
        self.visit_tangents(at, weights, scratch, |ends, block| add_change(ends, &block, delta, out));
    }

    fn visit_cliques(&self, pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        pairs.iter().for_each(|pair| visit(&[pair.a as u32, pair.b as u32]));
    }

    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        self.visit_tangents(at, weights, scratch, |ends, block| add_pair_blocks(ends, &block, matrix));
    }

    fn advance_memory(&self, at: &Configuration, _timestep: f64, memory: &mut [f64], pairs: &mut [Pair]) {
        memory[0] += reduce::sum_mut(0, pairs, &|first, pairs: &mut [Pair]| {
            let mut heat = 0.0;
            for (pair, next) in at.pairs[first..].iter().zip(pairs) {
                let Some(act) = self.act_of(pair, at) else {
                    next.memory[..HOOK].copy_from_slice(&Hook::FREE.numbers());
                    if self.0.fusible.is_some() {
                        next.memory[HOOK + self.0.law.memory_len()] = MOLTEN;
                    }
                    continue;
                };
                next.memory = act.memory;
                heat += act.energy.dissipated;
            }
            heat
        });
        self.conduct(at, &mut Work::default(), memory);
    }

    fn kept_len(&self) -> Option<usize> {
        (self.0.listing == Listing::Own).then(|| self.own_len())
    }

    fn look_at_kept(&self, at: &Configuration, scratch: &mut Scratch) {
        if self.0.listing == Listing::Own {
            self.pass(at, Work::of(scratch), None);
        }
    }

    fn advance_kept(&self, at: &Configuration, scratch: &mut Scratch, memory: &mut [f64], kept: &mut Kept) {
        let work = Work::of(scratch);
        memory[0] += work.pass.keep(kept);
        self.conduct(at, work, memory);
    }

    fn accepts_key(&self, key: u64) -> bool {
        self.accepts_pair(&Pair::new((key >> 32) as usize, (key & u64::from(u32::MAX)) as usize, [0.0; 8]))
            && (self.0.first != self.0.second || key >> 32 < key & u64::from(u32::MAX))
    }

    fn visit_near(&self, at: &Configuration, scratch: &Scratch, visit: &mut dyn FnMut([u32; 2])) {
        if self.0.listing == Listing::State {
            return;
        }
        let held = scratch.downcast_ref().map(|work: &Work| &work.list);
        let held = held.filter(|list| list.hold(self.groups(), at.positions, self.0.range));
        let made = held.is_none().then(|| {
            let mut made = Neighbours::default();
            made.bring_up_to_date(self.groups(), at.positions, self.0.range);
            made
        });
        let Some(list) = held.or(made.as_ref()) else { return };
        let range_sq = self.0.range * self.0.range;
        for (ball, row) in self.0.first.clone().enumerate() {
            for other in list.others(ball) {
                if (at.positions[row as usize] - at.positions[*other as usize]).length_sq() < range_sq {
                    visit([row, *other]);
                }
            }
        }
    }

    fn fault(&self, at: &Configuration) -> Option<(usize, String)> {
        let fusible = self.0.fusible.as_ref()?;
        let second = if self.groups().is_one() { 0..0 } else { self.0.second.clone() };
        self.0.first.clone().chain(second).map(|row| row as usize).zip(&at.memory[1..]).find_map(
            |(row, temperature)| Some((row, fusible.fault(*temperature, at.positions[row], at.time)?)),
        )
    }

    fn free_scratch(&self, scratch: &mut Scratch) {
        *scratch = self.new_scratch();
    }

    fn scratch_bytes(&self, scratch: &Scratch) -> usize {
        let Some(Work { grid, found, forces, flows, list, pass }) = scratch.downcast_ref() else { return 0 };
        let found: usize = found.iter().map(|list| 8 * list.capacity()).sum();
        let own = grid.bytes() + found + size_of::<Vec3>() * forces.capacity() + 8 * flows.capacity();
        own + list.bytes() + pass.bytes()
    }

    /// Pairs of a second body that come in the order of their rows.
    fn find_pairs(&self, at: &Configuration, scratch: &mut Scratch, found: &mut Vec<Pair>) {
        if self.0.listing == Listing::Own {
            return;
        }
        let Work { grid, found: chunks, .. } = Work::of(scratch);
        let CrowdDescription { first, second, range, law, .. } = &self.0;
        grid.sort(second.clone(), at.positions, *range);
        let is_one = first == second;
        chunks.resize_with(first.len().div_ceil(SEARCHED_TOGETHER), Vec::new);
        let search = |(chunk, pairs): (usize, &mut Vec<[u32; 2]>)| {
            pairs.clear();
            let start = first.start as usize + chunk * SEARCHED_TOGETHER;
            for a in start..(start + SEARCHED_TOGETHER).min(first.end as usize) {
                let own = pairs.len();
                let above = if is_one { a as u32 } else { 0 };
                grid.visit_near(at.positions[a], at.positions, |b| {
                    if !is_one || b > above {
                        pairs.push([a as u32, b]);
                    }
                });
                pairs[own..].sort_unstable();
            }
        };
        // threads are woken for many balls only
        if chunks.len() >= 16 && rayon::current_num_threads() > 1 {
            chunks.par_iter_mut().enumerate().for_each(search);
        } else {
            chunks.iter_mut().enumerate().for_each(search);
        }
        found.reserve(chunks.iter().map(Vec::len).sum());
        let begins = law.memory_len() > 0;
        let mut memory = [0.0; 8];
        // bonds that tear in this step, for what they give off; they have melted in the next
        if self.0.fusible.is_some() {
            let bond_at = HOOK + law.memory_len();
            let is_far = |pair: &&Pair| {
                (at.positions[pair.a as usize] - at.positions[pair.b as usize]).length_sq() >= range * range
            };
            found.extend(at.pairs.iter().filter(|pair| pair.memory[bond_at] != MOLTEN).filter(is_far));
        }
        for [a, b] in chunks.iter().flatten() {
            if begins {
                let length = (at.positions[*b as usize] - at.positions[*a as usize]).length();
                law.begin(*range, length, &mut memory[HOOK..HOOK + law.memory_len()]);
            }
            found.push(Pair::new(*a as usize, *b as usize, memory));
        }
    }

    fn pairs_are_stale(&self, searched: &[Vec3], at: &Configuration, _scratch: &Scratch) -> bool {
        let now = at.positions;
        let rows = || self.0.first.clone().chain(self.0.second.clone()).map(|row| row as usize);
        rows().any(|row| searched[row] != now[row])
    }

    fn accepts_pair(&self, pair: &Pair) -> bool {
        let holds = |range: &Range<u32>, row: u64| u32::try_from(row).is_ok_and(|row| range.contains(&row));
        holds(&self.0.first, pair.a) && holds(&self.0.second, pair.b) && pair.a != pair.b
    }

    fn visit_contacts(&self, at: &Configuration, visit: &mut dyn FnMut(&ContactPoint)) {
        self.visit_standing(at, &mut Work::default(), |standing, memory| {
            // a bond that tears touches no more; what is no number is shown
            if standing.reach.length >= self.0.range {
                return;
            }
            let Some(act) = self.act(standing, memory, at) else { return };
            visit(&ContactPoint {
                row: standing.pair[0],
                against: &[(standing.pair[1], 1.0)],
                penetration: self.0.range - standing.reach.length,
                normal_force: act.axial,
                friction: act.across,
            });
        });
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
