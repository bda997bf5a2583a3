//! What the staggered stepper asks of a body of an octree.
//!
//! Divided particles are where their daughters' centre of mass is; those whose mother is whole follow her and her neighbours. What acts
//! on those from outside acts on the one that is active above them: the masses of all that follow one particle add up to its own.

use std::ops::Range;

use souple_engine::levels::{
    Census, Division, Evaluations, Filter, Followers, Kinematic, Levels, Neighbours, Push,
};
use souple_engine::{Rows, Scratch};
use souple_math::Vec3;

use super::active::Work;
use super::{OctreeForce, Variant};
use crate::stays;

fn read(scratch: &Scratch) -> &Work {
    scratch.downcast_ref().unwrap_or_else(|| unreachable!("made by this force's own new_scratch"))
}

impl OctreeForce {
    /// Brings divided particles, and all that are not present if wanted, to where they follow.
    fn place(&self, work: &Work, who: Followers, kind: Kinematic, values: &mut [Vec3]) {
        let tree = &self.tree;
        // displacements, or velocities
        let of = |values: &[Vec3], at: usize| match kind {
            Kinematic::Position => values[at] - tree.rest[at],
            Kinematic::Velocity => values[at],
        };
        let set = |values: &mut [Vec3], at: usize, value: Vec3| {
            values[at] = match kind {
                Kinematic::Position => tree.rest[at] + value,
                Kinematic::Velocity => value,
            };
        };
        // p = Σ m_i p_i/m, from fine to coarse
        for level in (0..tree.finest()).rev() {
            for particle in tree.levels[level].clone().filter(|at| work.is_divided(*at)) {
                let daughters = tree.daughters.of(particle).iter().map(|at| *at as usize);
                let sum: Vec3 = daughters.map(|at| of(values, at) * tree.masses[at]).sum();
                set(values, particle, sum * (1.0 / tree.masses[particle]));
            }
        }
        if matches!(who, Followers::Ghosts) || matches!(who, Followers::These(rows) if !self.has_any(rows)) {
            return;
        }
        for level in 1..tree.levels.len() {
            for particle in tree.levels[level].clone().filter(|at| !work.is_present[*at]) {
                let leaders = tree.leaders.of(particle).iter();
                let value = leaders.map(|(leader, weight)| of(values, *leader as usize) * *weight).sum();
                set(values, particle, value);
            }
        }
    }

    fn has_any(&self, rows: &[u32]) -> bool {
        let own = self.row_range();
        rows.iter().any(|row| own.contains(&(*row as usize)))
    }
}

impl Levels for OctreeForce {
    fn rows(&self) -> Range<usize> {
        self.row_range()
    }

    /// Particles have no filter.
    fn shortest_interval(&self, _filter: Filter) -> f64 {
        self.intervals.iter().copied().fold(f64::INFINITY, f64::min)
    }

    fn adapt(&self, division: &Division, rows: &mut Rows, memory: &mut [f64], scratch: &mut Scratch) {
        let work = self.work(scratch);
        work.refresh(self, memory);
        let mut before = std::mem::take(&mut work.before);
        before.clear();
        before.extend_from_slice(&memory[..self.coarser_count()]);
        let mut were = std::mem::take(&mut work.were);
        were.clear();
        were.extend(work.fineness());
        work.were = were;
        self.choose(&rows.positions[self.row_range()], memory, work);
        if before != memory[..self.coarser_count()] {
            stays::note(&work.were, work.fineness(), rows.time, &mut memory[self.coarser_count()..]);
            self.change_over(&before, memory, rows);
            let range = self.row_range();
            self.place(work, Followers::All, Kinematic::Position, &mut rows.positions[range.clone()]);
            self.place(work, Followers::All, Kinematic::Velocity, &mut rows.velocities[range]);
        }
        work.before = before;
        work.divide(self, division);
    }

    fn active<'a>(&self, scratch: &'a Scratch) -> &'a [u32] {
        &read(scratch).active_rows
    }

    fn drift(&self, timestep: f64, scratch: &Scratch, rows: &mut Rows) {
        let fading = libm::exp(-self.mass_damping * timestep);
        for row in &read(scratch).active_rows {
            let row = *row as usize;
            rows.velocities[row] = rows.velocities[row] * fading;
            rows.positions[row] += rows.velocities[row] * timestep;
        }
    }

    fn accelerate(
        &self,
        rate: u32,
        division: &Division,
        scratch: &Scratch,
        accelerations: &[Vec3],
        velocities: &mut [Vec3],
    ) {
        let interval = division.interval(rate);
        for particle in &read(scratch).of_rate[rate as usize] {
            let row = self.first_row + *particle as usize;
            velocities[row] += accelerations[row] * interval;
        }
    }

    fn follow(&self, who: Followers, kind: Kinematic, scratch: &Scratch, values: &mut [Vec3]) {
        let work = read(scratch);
        if matches!(who, Followers::Ghosts) && self.variant == Variant::Adaptive {
            return;
        }
        self.place(work, who, kind, &mut values[self.row_range()]);
    }

    fn give_back(&self, who: Followers, scratch: &Scratch, impulses: &mut [Vec3]) {
        let work = read(scratch);
        if matches!(who, Followers::These(rows) if !self.has_any(rows)) {
            return;
        }
        let (tree, impulses) = (&self.tree, &mut impulses[self.row_range()]);
        // up to who is active, from fine to coarse
        for level in (1..tree.levels.len()).rev() {
            for particle in tree.levels[level].clone().filter(|at| !work.is_present[*at]) {
                let Some(mother) = tree.mother[particle] else { continue };
                let felt = std::mem::replace(&mut impulses[particle], Vec3::ZERO);
                impulses[mother as usize] += felt;
            }
        }
        // and down from who is divided
        for level in 0..tree.finest() {
            for particle in tree.levels[level].clone().filter(|at| work.is_divided(*at)) {
                let felt = std::mem::replace(&mut impulses[particle], Vec3::ZERO);
                if felt == Vec3::ZERO {
                    continue;
                }
                for daughter in tree.daughters.of(particle) {
                    impulses[*daughter as usize] +=
                        felt * (tree.masses[*daughter as usize] / tree.masses[particle]);
                }
            }
        }
    }

    fn add_impulses(
        &self,
        rate: u32,
        division: &Division,
        rows: &Rows,
        scratch: &mut Scratch,
        impulses: &mut [Vec3],
    ) {
        let work = self.work(scratch);
        let range = self.row_range();
        let (positions, impulses) = (&rows.positions[range.clone()], &mut impulses[range]);
        let interval = division.interval(rate);
        let u = |at: usize| positions[at] - self.tree.rest[at];
        for particle in &work.due[rate as usize] {
            let own = u(*particle as usize);
            work.stencils[*particle as usize].push(
                self.operators,
                *particle,
                |other| u(other as usize) - own,
                |whom, f| impulses[whom as usize] += f * interval,
            );
        }
    }

    fn kick(
        &self,
        push: Push,
        _: &Division,
        scratch: &Scratch,
        impulses: &mut [Vec3],
        velocities: &mut [Vec3],
    ) {
        let work = read(scratch);
        let (impulses, velocities) = (&mut impulses[self.row_range()], &mut velocities[self.row_range()]);
        let mut give = |particles: &[u32]| {
            for particle in particles {
                let at = *particle as usize;
                let change = std::mem::replace(&mut impulses[at], Vec3::ZERO) * (1.0 / self.tree.masses[at]);
                if work.is_divided(at) {
                    self.speed_up(work, at, change, velocities);
                } else {
                    velocities[at] += change;
                }
            }
        };
        match push {
            Push::Outer => give(&work.active),
            Push::Elastic { rate } => give(&work.pushed[rate as usize]),
        }
    }

    fn evaluations(&self, division: &Division, scratch: &Scratch) -> usize {
        let work = read(scratch);
        (0..=division.halvings)
            .map(|rate| work.due[rate as usize].len() * division.dates(rate) as usize)
            .sum()
    }

    fn workload(&self, division: &Division, memory: &[f64], _: &Scratch) -> Evaluations {
        let mut work = Work::new(&self.tree);
        work.refresh(self, memory);
        work.divide(self, division);
        Evaluations { first: 0, of_rate: work.due.iter().map(Vec::len).collect() }
    }

    fn census(&self, memory: &[f64], _: &Scratch) -> Census {
        let tree = &self.tree;
        let mut work = Work::new(tree);
        work.refresh(self, memory);
        let count = |is_counted: &dyn Fn(usize) -> bool| {
            tree.levels.iter().map(|level| level.clone().filter(|at| is_counted(*at)).count()).collect()
        };
        let level_of = |particle: usize| {
            let mut at = particle;
            while !work.is_present[at] {
                let Some(mother) = tree.mother[at] else { break };
                at = mother as usize;
            }
            u32::from(tree.level_of[at])
        };
        Census {
            active: count(&|at| work.is_active(at)),
            active_rows: self
                .rows()
                .zip(0..)
                .filter(|(_, at)| work.is_active(*at))
                .map(|(row, _)| row as u32)
                .collect(),
            ghosts: count(&|at| self.variant == Variant::Hierarchical && work.is_divided(at)),
            cells: tree.levels.iter().map(Range::len).collect(),
            level_of_point: (0..tree.finest_count()).map(level_of).collect(),
            toggling: stays::rate(&memory[self.coarser_count()..]),
            grading: self
                .beside(&work)
                .map(|[a, b]| tree.level_of[a].abs_diff(tree.level_of[b]))
                .max()
                .unwrap_or(0)
                .into(),
            neighbours: (self.variant == Variant::Adaptive).then(|| self.neighbours(&work)),
        }
    }
}

impl OctreeForce {
    /// Pairs of active particles that lie side by side, by the places of the finest particles that they stand for: each pair is met
    /// as often as these touch, from both sides.
    fn beside<'a>(&'a self, work: &'a Work) -> impl Iterator<Item = [usize; 2]> + 'a {
        let tree = &self.tree;
        let active_above = move |particle: usize| {
            let mothers = std::iter::successors(Some(particle), |at| tree.mother[*at].map(|at| at as usize));
            mothers.into_iter().find(|at| work.is_active(*at)).unwrap_or(particle)
        };
        let of = move |particle: usize| {
            let own = active_above(particle);
            let others = tree.same.of(particle).iter().map(move |other| active_above(*other as usize));
            others.filter(move |other| *other != own).map(move |other| [own, other])
        };
        (0..tree.finest_count()).flat_map(of)
    }

    fn neighbours(&self, work: &Work) -> Neighbours {
        let tree = &self.tree;
        let inner = work.active.iter().map(|at| *at as usize).filter(|at| tree.same.of(*at).len() == 26);
        let counts: Vec<usize> = inner.map(|at| work.active_neighbours(tree, at).count()).collect();
        let mut pairs: Vec<[usize; 2]> = self.beside(work).collect();
        pairs.sort_unstable();
        pairs.dedup();
        let is_unlisted =
            |[own, other]: &&[usize; 2]| work.active_neighbours(tree, *own).all(|at| at as usize != *other);
        Neighbours {
            fewest: counts.iter().copied().min().unwrap_or(0),
            most: counts.iter().copied().max().unwrap_or(0),
            unlisted: pairs.iter().filter(is_unlisted).count(),
        }
    }

    /// Gives a change of velocity to all active particles below a divided one.
    fn speed_up(&self, work: &Work, particle: usize, change: Vec3, velocities: &mut [Vec3]) {
        for daughter in self.tree.daughters.of(particle) {
            let daughter = *daughter as usize;
            if work.is_divided(daughter) {
                self.speed_up(work, daughter, change, velocities);
            } else {
                velocities[daughter] += change;
            }
        }
    }
}
