//! Who is at work, whom it sees, and how often: what follows from the memory, kept until that changes.

use souple_engine::levels::Division;

use super::stencil::Stencil;
use super::tree::Octree;
use super::{OctreeForce, OctreeOperators, Variant};

/// What memory holds of a particle whose daughters have its place.
pub const DIVIDED: f64 = 1.0;
/// And of one that is divided with the next step, for a finer neighbour's sake.
pub const WANTED: f64 = 2.0;

/// Scratch of a body of an octree.
#[derive(Debug, Default)]
pub struct Work {
    /// The part of the memory that all else follows from.
    memory: Vec<f64>,
    /// By particle, whether its mother is divided, or it is one of the coarsest.
    pub is_present: Vec<bool>,
    /// Those that move by themselves, ascending.
    pub active: Vec<u32>,
    pub active_rows: Vec<u32>,
    /// Those with a stencil, ascending: the active ones, and of the hierarchical variant divided ones too.
    pub working: Vec<u32>,
    pub stencils: Vec<Stencil>,
    /// How the last lists were made.
    division: Option<Division>,
    /// Active particles by their rate.
    pub of_rate: Vec<Vec<u32>>,
    /// Stencils by the rate that they are due at.
    pub due: Vec<Vec<u32>>,
    /// Who is pushed by the stencils of a rate.
    pub pushed: Vec<Vec<u32>>,
    is_pushed: Vec<bool>,
    /// The memory before the last choice.
    pub before: Vec<f64>,
    /// How fine all were then.
    pub were: Vec<u8>,
}

impl Work {
    pub fn new(tree: &Octree) -> Self {
        let count = tree.count();
        Self {
            is_present: vec![false; count],
            is_pushed: vec![false; count],
            stencils: vec![Stencil::default(); count],
            ..Self::default()
        }
    }

    /// Whether a particle's daughters have its place.
    pub fn is_divided(&self, particle: usize) -> bool {
        let finest = self.is_present.len() - self.memory.len();
        self.is_present[particle] && particle >= finest && self.memory[particle - finest] == DIVIDED
    }

    /// How fine each particle is: 0 where a coarser one is in its place, 1 where it is at work, 2 where it is divided.
    pub fn fineness(&self) -> impl Iterator<Item = u8> + '_ {
        let of = |particle| u8::from(self.is_present[particle]) + u8::from(self.is_divided(particle));
        (0..self.is_present.len()).map(of)
    }

    pub fn is_active(&self, particle: usize) -> bool {
        self.is_present[particle] && !self.is_divided(particle)
    }

    /// Active neighbours of an active particle, from the table of all: of its level, finer, coarser.
    pub fn active_neighbours<'a>(
        &'a self,
        tree: &'a Octree,
        particle: usize,
    ) -> impl Iterator<Item = u32> + 'a {
        let (same, finer, coarser) =
            (tree.same.of(particle), tree.finer.of(particle), tree.coarser.of(particle));
        let all = same.iter().chain(finer).chain(coarser).copied();
        all.filter(|other| self.is_active(*other as usize))
    }

    /// Follows the memory, if that has changed.
    pub fn refresh(&mut self, force: &OctreeForce, memory: &[f64]) {
        // how long particles stay makes no difference
        let memory = &memory[..force.coarser_count()];
        if self.memory == memory && !self.active.is_empty() {
            return;
        }
        let tree = &force.tree;
        self.memory.clear();
        self.memory.extend_from_slice(memory);
        self.division = None;
        for level in 0..tree.levels.len() {
            for particle in tree.levels[level].clone() {
                self.is_present[particle] =
                    tree.mother[particle].is_none_or(|mother| self.is_divided(mother as usize));
            }
        }
        self.active.clear();
        self.working.clear();
        for particle in 0..tree.count() {
            if self.is_active(particle) {
                self.active.push(particle as u32);
            }
            let works = match force.variant {
                Variant::Adaptive => self.is_active(particle),
                Variant::Hierarchical => self.is_present[particle],
            };
            if works {
                self.working.push(particle as u32);
            }
        }
        self.active_rows.clear();
        self.active_rows.extend(self.active.iter().map(|particle| force.first_row as u32 + particle));
        let mut stencils = std::mem::take(&mut self.stencils);
        for particle in &self.working {
            let particle = *particle as usize;
            let matter = (tree.volumes[particle], force.moduli);
            match force.variant {
                Variant::Adaptive => {
                    let neighbours = self.active_neighbours(tree, particle);
                    stencils[particle].set(force.operators, neighbours, particle, &tree.rest, matter);
                }
                // coefficients of all of the level, of which those act that are there: a pair of divided ones is that of their daughters
                Variant::Hierarchical => {
                    let neighbours = tree.same.of(particle).iter().copied();
                    stencils[particle].set(force.operators, neighbours, particle, &tree.rest, matter);
                    let is_divided = self.is_divided(particle);
                    stencils[particle].keep(|other| {
                        let other = other as usize;
                        self.is_present[other] && !(is_divided && self.is_divided(other))
                    });
                }
            }
        }
        self.stencils = stencils;
    }

    /// Sorts particles and stencils by the rates of steps so divided.
    pub fn divide(&mut self, force: &OctreeForce, division: &Division) {
        if self.division.as_ref() == Some(division) {
            return;
        }
        self.division = Some(*division);
        let rates = division.halvings as usize + 1;
        for lists in [&mut self.of_rate, &mut self.due, &mut self.pushed] {
            lists.resize(rates, Vec::new());
            lists.iter_mut().for_each(Vec::clear);
        }
        let rate_of = |particle: u32| {
            let needed = force.intervals[usize::from(force.tree.level_of[particle as usize])];
            (0..division.halvings)
                .find(|rate| division.interval(*rate) <= needed)
                .unwrap_or(division.halvings)
        };
        for particle in &self.active {
            self.of_rate[rate_of(*particle) as usize].push(*particle);
        }
        for particle in &self.working {
            // what pushes others is due when the fastest of them is
            let mut rate = rate_of(*particle);
            if force.operators == OctreeOperators::Energy {
                let others = self.stencils[*particle as usize].neighbours.iter();
                rate = others.map(|other| rate_of(*other)).fold(rate, u32::max);
            }
            self.due[rate as usize].push(*particle);
        }
        for (due, pushed) in self.due.iter().zip(&mut self.pushed) {
            let mut add = |particle: usize, is_pushed: &mut [bool]| {
                if !std::mem::replace(&mut is_pushed[particle], true) {
                    pushed.push(particle as u32);
                }
            };
            for particle in due {
                add(*particle as usize, &mut self.is_pushed);
                if force.operators == OctreeOperators::Energy {
                    let others = &self.stencils[*particle as usize].neighbours;
                    others.iter().for_each(|other| add(*other as usize, &mut self.is_pushed));
                }
            }
            pushed.iter().for_each(|particle| self.is_pushed[*particle as usize] = false);
            pushed.sort_unstable();
        }
    }

    pub fn bytes(&self) -> usize {
        let lists = self.of_rate.iter().chain(&self.due).chain(&self.pushed);
        8 * self.memory.capacity()
            + self.were.capacity()
            + lists.map(|list| 4 * list.capacity()).sum::<usize>()
            + self.stencils.iter().map(Stencil::bytes).sum::<usize>()
    }
}
