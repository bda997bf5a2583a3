//! Particles divide and are grouped again before a step.

use souple_engine::Rows;
use souple_math::Vec3;

use super::active::{DIVIDED, WANTED, Work};
use super::{OctreeChoice, OctreeForce};

/// A row of single particles shears and does not bend. Under a load `w` along its length `L` its slope is at most `wL/μA`, where a body
/// as thick as its particles, `h`, bends by `wL³/6EI` beside, `I = Ah²/12`: by `2 μ/E (L/h)²` as much, and `E` is at most `3 μ`.
const BENT_OF_SHEARED: f64 = 2.0 / 3.0;

impl OctreeForce {
    /// Moves the set of divided particles on, in `memory`.
    pub(super) fn choose(&self, positions: &[Vec3], memory: &mut [f64], work: &mut Work) {
        work.refresh(self, memory);
        match &self.choice {
            OctreeChoice::Fixed(level) => {
                let tree = &self.tree;
                for particle in tree.finest_count()..tree.count() {
                    let wanted = level.evaluate(&tree.rest[particle].to_array());
                    let is_finer = wanted > f64::from(tree.level_of[particle]);
                    memory[particle - tree.finest_count()] = if is_finer { DIVIDED } else { 0.0 };
                }
                self.balance(memory);
            }
            OctreeChoice::Adaptive { refine, coarsen } => {
                self.follow_criterion([*refine, *coarsen], positions, memory, work);
            }
        }
        work.refresh(self, memory);
    }

    /// Divides until neighbours differ by one level at most, where a formula has said otherwise; whoever is to be divided has
    /// its mother divided too.
    fn balance(&self, memory: &mut [f64]) {
        let (tree, first) = (&self.tree, self.tree.finest_count());
        // from fine to coarse: what is done for a level is done for good
        for level in (1..tree.levels.len()).rev() {
            for particle in tree.levels[level].clone() {
                let is_divided = particle >= first && memory[particle - first] == DIVIDED;
                if !is_divided {
                    continue;
                }
                // daughters see the mother's level; there must be nothing coarser
                for mother in tree.mother[particle].iter().chain(tree.coarser.of(particle)) {
                    memory[*mother as usize - first] = DIVIDED;
                }
            }
        }
    }

    // divide where h |Δu| > refine, group where it is < coarsen for all sisters (3.11, over h); a row or a sheet of
    // single particles cannot bend, and what it does not see of that stands for it
    fn follow_criterion(
        &self,
        [refine, coarsen]: [f64; 2],
        positions: &[Vec3],
        memory: &mut [f64],
        work: &mut Work,
    ) {
        let (tree, first) = (&self.tree, self.tree.finest_count());
        let relative = |particle: usize| {
            let u = |at: usize| positions[at] - tree.rest[at];
            let own = u(particle);
            move |other: u32| u(other as usize) - own
        };
        let variation = |particle: usize| {
            let spacing = tree.spacing[usize::from(tree.level_of[particle])];
            spacing * work.stencils[particle].variation(relative(particle))
        };
        // what a particle, or the row that its mother is of, does not see of what it is asked to follow
        let error = |particle: usize, slenderness: f64| {
            let varies = variation(particle);
            if slenderness == 0.0 {
                return varies;
            }
            let slope = work.stencils[particle].slope(relative(particle));
            varies.max(BENT_OF_SHEARED * slenderness * slenderness * slope)
        };
        let was: Vec<f64> = memory.to_vec();
        for particle in &work.active {
            let particle = *particle as usize;
            let Some(own) = particle.checked_sub(first) else { continue };
            let is_wanted = was[own] == WANTED || error(particle, tree.slenderness[particle]) > refine;
            if !is_wanted {
                continue;
            }
            // coarser neighbours first: they divide with the next step
            let mut coarser =
                tree.coarser.of(particle).iter().filter(|other| work.is_active(**other as usize)).peekable();
            if coarser.peek().is_none() {
                memory[own] = DIVIDED;
            }
            // but for those that divide with this one: asked again, they would never come to it
            coarser.for_each(|other| {
                let other = &mut memory[*other as usize - first];
                *other = if *other == DIVIDED { DIVIDED } else { WANTED };
            });
        }
        for mother in first..tree.count() {
            let daughters = tree.daughters.of(mother);
            let is_grouped = work.is_divided(mother)
                && daughters.iter().all(|daughter| work.is_active(*daughter as usize))
                && daughters
                    .iter()
                    .all(|daughter| error(*daughter as usize, tree.slenderness[mother]) < coarsen);
            // finer neighbours have priority, those that come with this step too
            let has_finer = || {
                daughters.iter().any(|daughter| {
                    let finer = tree.finer.of(*daughter as usize).iter();
                    let beside = tree.same.of(*daughter as usize).iter();
                    finer.clone().any(|other| work.is_present[*other as usize])
                        || beside
                            .filter(|other| **other as usize >= first)
                            .any(|other| memory[*other as usize - first] != 0.0)
                })
            };
            let is_wanted_below = || {
                let own = daughters.iter().filter(|daughter| **daughter as usize >= first);
                own.clone().any(|daughter| memory[*daughter as usize - first] != 0.0)
            };
            if is_grouped && !is_wanted_below() && !has_finer() {
                memory[mother - first] = 0.0;
            }
        }
    }

    /// What others being active does to velocities: daughters stand and move as they have followed, and are given what they lack
    /// of their mother's momentum.
    pub(super) fn change_over(&self, before: &[f64], memory: &[f64], rows: &mut Rows) {
        let (tree, first) = (&self.tree, self.tree.finest_count());
        let velocities = &mut rows.velocities[self.row_range()];
        for mother in first..tree.count() {
            if memory[mother - first] != DIVIDED || before[mother - first] == DIVIDED {
                continue;
            }
            let daughters = tree.daughters.of(mother);
            let momentum: Vec3 =
                daughters.iter().map(|at| velocities[*at as usize] * tree.masses[*at as usize]).sum();
            let lacking = velocities[mother] - momentum * (1.0 / tree.masses[mother]);
            daughters.iter().for_each(|daughter| velocities[*daughter as usize] += lacking);
        }
    }
}
