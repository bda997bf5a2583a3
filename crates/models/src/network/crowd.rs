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
use souple_math::Vec3;
use souple_solve::{BlockMatrix, reduce};

use super::crowd_acting::{Acting, Standing};
use super::crowd_grid::Grid;
use super::crowd_list::{Groups, Neighbours};
use super::crowd_pass::Pass;
use super::driven::DrivenLaw;
use super::friction::{Friction, Hook};
use super::fusible::{Fusible, MOLTEN};
use super::law::Reach;
use super::pair_tangent::{add_change, add_pair_blocks};

/// Numbers of a pair that belong to friction; those of the law follow.
pub(super) const HOOK: usize = 4;
/// Numbers that a law may remember of a pair.
pub const PAIR_MEMORY: usize = 8 - HOOK;

/// What a multitude is made of.
#[derive(Debug)]
pub struct CrowdDescription {
    pub name: String,
    pub law: DrivenLaw,
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

/// What a crowd works with.
#[derive(Default)]
pub(super) struct Work {
    grid: Grid,
    /// Pairs of each so many balls of the first group.
    found: Vec<Vec<[u32; 2]>>,
    /// On the first balls of pairs [N].
    forces: Vec<Vec3>,
    /// Into each mass from its neighbours [W].
    pub flows: Vec<f64>,
    pub list: Neighbours,
    pub pass: Pass,
}

impl Work {
    pub fn of(scratch: &mut Scratch) -> &mut Self {
        scratch.downcast_mut().unwrap_or_else(|| unreachable!("made by this force's own new_scratch"))
    }
}

/// Balls of the first group whose pairs are found by one thread.
const SEARCHED_TOGETHER: usize = 512;

impl Crowd {
    pub fn new(description: CrowdDescription) -> Self {
        let bond = usize::from(description.fusible.is_some());
        assert!(
            description.law.written().memory_len() + bond <= PAIR_MEMORY,
            "laws of pairs remember few numbers"
        );
        Self(description)
    }

    /// The crowd under its law as it is driven.
    fn acting<T>(&self, at: &Configuration, act: impl FnOnce(Acting) -> T) -> T {
        let (mut act, mut out) = (Some(act), None);
        let gain = self.0.law.gain(at.driven);
        self.0.law.acting(at.driven, &mut |law| {
            let acting = Acting { crowd: self, of: &self.0, law, gain };
            out = act.take().map(|act| act(acting));
        });
        out.unwrap_or_else(|| unreachable!("a law is lent once"))
    }

    /// Masses that have a temperature.
    pub fn temperature_count(&self) -> usize {
        self.0.fusible.as_ref().map_or(0, |_| self.mass_count())
    }

    /// Numbers of a pair that the law remembers, and its bond behind them.
    pub fn remembered_len(&self) -> usize {
        self.0.law.written().memory_len() + usize::from(self.0.fusible.is_some())
    }

    /// Masses of both groups.
    pub(super) fn mass_count(&self) -> usize {
        self.0.first.len() + if self.groups().is_one() { 0 } else { self.0.second.len() }
    }

    /// The number of a row among the masses of both groups.
    pub(super) fn mass_of(&self, row: u32) -> usize {
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
        self.acting(at, |acting| {
            acting.visit_standing(at, &mut Work::default(), |standing, memory| {
                let is_near = standing.reach.length < self.0.range;
                if is_near && acting.bond(fusible, standing, memory, at).rest != MOLTEN {
                    visit(standing.pair);
                }
            });
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

    /// The sum of a number of what pairs in range do, from what they store at the range, and of what those that have just left it
    /// stored, which they give off in the coming step [J].
    fn sum_of(&self, at: &Configuration, scratch: &mut Scratch, number: impl Fn(Energy) -> f64) -> f64 {
        self.acting(at, |acting| {
            let (mut sum, at_range) = (0.0, acting.stored_at_range(at.time));
            acting.visit_standing(at, Work::of(scratch), |standing, memory| {
                let Some(act) = acting.act(standing, memory, at) else { return };
                sum += if standing.reach.length < self.0.range {
                    number(act.energy) - at_range
                } else {
                    act.energy.dissipated
                };
            });
            sum
        })
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
        (self.0.law.written().stiffest_within(self.0.range) + bond).max(hook)
    }

    pub(super) fn groups(&self) -> Groups<'_> {
        Groups { first: &self.0.first, second: &self.0.second }
    }

    pub(super) fn standing(&self, pair: [u32; 2], at: &Configuration) -> Standing {
        let [a, b] = pair.map(|row| row as usize);
        let d = at.positions[a] - at.positions[b];
        self.between(pair, [d, d - (at.velocities[a] - at.velocities[b]) * self.0.timestep])
    }

    pub(super) fn between(&self, pair: [u32; 2], [d, before]: [Vec3; 2]) -> Standing {
        let reach = Reach { length: d.length(), before: before.length(), rest: self.0.range };
        Standing { pair, d, before, reach }
    }

    /// Numbers that State has of a pair that is not listed there: of a hook where it began, before those of the law.
    pub(super) fn own_len(&self) -> usize {
        match (&self.0.friction, self.remembered_len()) {
            (None, own) => own,
            // who is there sticks
            (Some(_), 0) => HOOK - 1,
            (Some(_), own) => HOOK + own,
        }
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
        let stored = self.sum_of(at, scratch, |energy| energy.stored);
        Energy { stored, dissipated: at.memory[0] }
    }

    fn held(&self, at: &Configuration, scratch: &mut Scratch) -> f64 {
        // as of links
        let remembers = self.0.law.written().memory_len() > 0;
        self.sum_of(at, scratch, |energy| energy.stored + if remembers { energy.dissipated } else { 0.0 })
    }

    fn add_force(&self, at: &Configuration, scratch: &mut Scratch, out: &mut [Vec3]) {
        if self.0.listing == Listing::Own {
            self.acting(at, |acting| acting.pass(at, Work::of(scratch), Some(out)));
            return;
        }
        let forces = &mut Work::of(scratch).forces;
        forces.resize(at.pairs.len(), Vec3::ZERO);
        self.acting(at, |acting| {
            reduce::sum_mut(0, forces, &|first, forces: &mut [Vec3]| {
                for (force, pair) in forces.iter_mut().zip(&at.pairs[first..]) {
                    *force = acting.act_of(pair, at).map_or(Vec3::ZERO, |act| act.axial + act.across);
                }
                0.0
            })
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
        self.acting(at, |acting| {
            acting.visit_tangents(at, weights, scratch, |ends, block| add_change(ends, &block, delta, out));
        });
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
        self.acting(at, |acting| {
            acting.visit_tangents(at, weights, scratch, |ends, block| add_pair_blocks(ends, &block, matrix));
        });
    }

    fn advance_memory(&self, at: &Configuration, _timestep: f64, memory: &mut [f64], pairs: &mut [Pair]) {
        self.acting(at, |acting| {
            memory[0] += reduce::sum_mut(0, pairs, &|first, pairs: &mut [Pair]| {
                let mut heat = 0.0;
                for (pair, next) in at.pairs[first..].iter().zip(pairs) {
                    let Some(act) = acting.act_of(pair, at) else {
                        next.memory[..HOOK].copy_from_slice(&Hook::FREE.numbers());
                        if self.0.fusible.is_some() {
                            next.memory[HOOK + acting.law.memory_len()] = MOLTEN;
                        }
                        continue;
                    };
                    next.memory = act.memory;
                    heat += act.energy.dissipated;
                }
                heat
            });
            acting.conduct(at, &mut Work::default(), memory);
        });
    }

    fn kept_len(&self) -> Option<usize> {
        (self.0.listing == Listing::Own).then(|| self.own_len())
    }

    fn look_at_kept(&self, at: &Configuration, scratch: &mut Scratch) {
        if self.0.listing == Listing::Own {
            self.acting(at, |acting| acting.pass(at, Work::of(scratch), None));
        }
    }

    fn advance_kept(&self, at: &Configuration, scratch: &mut Scratch, memory: &mut [f64], kept: &mut Kept) {
        let work = Work::of(scratch);
        memory[0] += work.pass.keep(kept);
        self.acting(at, |acting| acting.conduct(at, work, memory));
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
        if let Some(what) = self.0.law.fault(at.driven).or_else(|| self.acting(at, |acting| acting.fault())) {
            return Some((self.0.first.start as usize, what));
        }
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
        let CrowdDescription { first, second, range, .. } = &self.0;
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
        let mut memory = [0.0; 8];
        self.acting(at, |acting| {
            // those that tear in this step, for what they give off; they have nothing left in the next
            if self.remembered_len() > 0 {
                found.extend(at.pairs.iter().filter(|pair| acting.tears(pair, at)));
            }
            for [a, b] in chunks.iter().flatten() {
                let length = (at.positions[*b as usize] - at.positions[*a as usize]).length();
                acting.begin(length, &mut memory);
                found.push(Pair::new(*a as usize, *b as usize, memory));
            }
        });
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
        self.acting(at, |acting| {
            acting.visit_standing(at, &mut Work::default(), |standing, memory| {
                // a bond that tears touches no more; what is no number is shown
                if standing.reach.length >= self.0.range {
                    return;
                }
                let Some(act) = acting.act(standing, memory, at) else { return };
                visit(&ContactPoint {
                    row: standing.pair[0],
                    against: &[(standing.pair[1], 1.0)],
                    penetration: self.0.range - standing.reach.length,
                    normal_force: act.axial,
                    friction: act.across,
                });
            });
        });
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
