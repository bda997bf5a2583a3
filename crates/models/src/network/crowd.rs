//! Multitudes: balls of one group, or of two, that act on each other wherever they come near.
//!
//! What is near is searched in a grid at the start of every step: the same pairs as of all with all, since a law has a range
//! beyond which it gives no force. Pairs stand in State with what they remember.

use std::any::Any;
use std::ops::Range;

use rayon::prelude::*;
use souple_engine::{Configuration, ContactPoint, Declaration, Energy, Force, Pair, Scratch, TangentWeights};
use souple_math::{Mat3, Vec3};
use souple_solve::{BlockMatrix, reduce};

use super::crowd_grid::Grid;
use super::friction::{Friction, Hook};
use super::kernel::LinkKernel;
use super::law::{Reach, Response};
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
    /// Of the system [s].
    pub timestep: f64,
}

/// Balls that act on each other within a range.
#[derive(Debug)]
pub struct Crowd(CrowdDescription);

/// How a pair stands.
struct Standing {
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
        assert!(description.law.memory_len() <= PAIR_MEMORY, "laws of pairs remember few numbers");
        Self(description)
    }

    /// What a pair takes of the bound `4M` on its masses (see [`super::LinkLaw::stiffest`]) [N/m].
    pub fn stiffest(&self) -> f64 {
        let hook =
            self.0.friction.as_ref().map_or(0.0, |friction| friction.stiffness + 2.0 * friction.damping);
        self.0.law.stiffest(self.0.range).max(hook)
    }

    fn standing(&self, pair: &Pair, at: &Configuration) -> Standing {
        let (a, b) = (pair.a as usize, pair.b as usize);
        let d = at.positions[a] - at.positions[b];
        let before = d - (at.velocities[a] - at.velocities[b]) * self.0.timestep;
        let reach = Reach { length: d.length(), before: before.length(), rest: self.0.range };
        Standing { d, before, reach }
    }

    fn law_memory<'m>(&self, pair: &'m Pair) -> &'m [f64] {
        &pair.memory[HOOK..HOOK + self.0.law.memory_len()]
    }

    /// `None` out of range.
    fn act(&self, pair: &Pair, at: &Configuration) -> Option<Act> {
        let Standing { d, before, reach } = self.standing(pair, at);
        if reach.length >= self.0.range {
            return None;
        }
        let mut memory = pair.memory;
        let own = self.law_memory(pair);
        let Response { push, stored, heat } = self.0.law.respond(&reach, at.time, own);
        let u = d.try_normalised().or(before.try_normalised()).unwrap_or(Vec3::X);
        let mut energy = Energy { stored, dissipated: heat };
        let mut across = Vec3::ZERO;
        if let Some(friction) = &self.0.friction {
            // the elastic part alone presses
            let still = Reach { before: reach.length, ..reach };
            let normal = self.0.law.respond(&still, at.time, own).push;
            let hook = Hook::from_numbers(std::array::from_fn(|i| pair.memory[i]));
            let grip = friction.grip(hook, d, before, normal);
            across = grip.force;
            energy.stored += grip.stored;
            energy.dissipated += grip.heat;
            memory[..HOOK].copy_from_slice(&grip.next.numbers());
        }
        Some(Act { axial: u * push, across, energy, memory })
    }

    fn visit_tangents(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        mut visit: impl FnMut([u32; 2], Mat3),
    ) {
        for pair in at.pairs {
            let Standing { d, before, reach } = self.standing(pair, at);
            let (Some(n), true) = (d.try_normalised(), reach.length < self.0.range) else { continue };
            let m = before.try_normalised().unwrap_or(n);
            let own = self.law_memory(pair);
            let push = self.0.law.respond(&reach, at.time, own).push;
            let [now, past] = self.0.law.slopes(&reach, at.time, own);
            let side = push / reach.length;
            let mut position = n.outer(n) * (now - side) + Mat3::IDENTITY * side + n.outer(m) * past;
            let mut velocity = n.outer(m) * (-self.0.timestep * past);
            if let Some(friction) = &self.0.friction
                && push > 0.0
            {
                // the hook as it is while it sticks
                let across = Mat3::IDENTITY - n.outer(n);
                position -= across * friction.stiffness;
                velocity -= across * (friction.damping * self.0.timestep);
            }
            visit([pair.a as u32, pair.b as u32], position * weights.position + velocity * weights.velocity);
        }
    }
}

impl Force for Crowd {
    fn name(&self) -> &str {
        &self.0.name
    }

    fn declaration(&self) -> Declaration {
        let conservative = self.0.law.is_conservative() && self.0.friction.is_none();
        Declaration {
            conservative,
            velocity_terms: !conservative,
            symmetric_tangent: conservative,
            // friction leaves a couple that no ball bears
            internal: self.0.friction.is_none(),
            changing_pattern: true,
        }
    }

    fn memory_len(&self) -> usize {
        1
    }

    fn new_scratch(&self) -> Scratch {
        Box::new(Work::default())
    }

    fn energy(&self, at: &Configuration, _: &mut Scratch) -> Energy {
        let stored = at.pairs.iter().filter_map(|pair| Some(self.act(pair, at)?.energy.stored)).sum();
        Energy { stored, dissipated: at.memory[0] }
    }

    fn add_force(&self, at: &Configuration, scratch: &mut Scratch, out: &mut [Vec3]) {
        let forces = &mut Work::of(scratch).forces;
        forces.resize(at.pairs.len(), Vec3::ZERO);
        reduce::sum_mut(0, forces, &|first, forces: &mut [Vec3]| {
            for (force, pair) in forces.iter_mut().zip(&at.pairs[first..]) {
                *force = self.act(pair, at).map_or(Vec3::ZERO, |act| act.axial + act.across);
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
        _: &mut Scratch,
        out: &mut [Vec3],
    ) {
        self.visit_tangents(at, weights, |ends, block| add_change(ends, &block, delta, out));
    }

    fn visit_cliques(&self, pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        pairs.iter().for_each(|pair| visit(&[pair.a as u32, pair.b as u32]));
    }

    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        self.visit_tangents(at, weights, |ends, block| add_pair_blocks(ends, &block, matrix));
    }

    fn advance_memory(&self, at: &Configuration, _timestep: f64, memory: &mut [f64], pairs: &mut [Pair]) {
        memory[0] += reduce::sum_mut(0, pairs, &|first, pairs: &mut [Pair]| {
            let mut heat = 0.0;
            for (pair, next) in at.pairs[first..].iter().zip(pairs) {
                let Some(act) = self.act(pair, at) else {
                    next.memory[..HOOK].copy_from_slice(&Hook::FREE.numbers());
                    continue;
                };
                next.memory = act.memory;
                heat += act.energy.dissipated;
            }
            heat
        });
    }

    /// Pairs of a second body that come in the order of their rows.
    fn find_pairs(&self, at: &Configuration, scratch: &mut Scratch, found: &mut Vec<Pair>) {
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
                grid.visit_near(at.positions[a], |b| {
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
        for pair in at.pairs {
            let Some(act) = self.act(pair, at) else { continue };
            visit(&ContactPoint {
                row: pair.a as u32,
                against: &[(pair.b as u32, 1.0)],
                penetration: self.0.range - self.standing(pair, at).reach.length,
                normal_force: act.axial,
                friction: act.across,
            });
        }
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
