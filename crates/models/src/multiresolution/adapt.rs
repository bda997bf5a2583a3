//! Points come and go: what is subdivided and regrouped before a step.

use souple_engine::Rows;
use souple_engine::levels::{Division, Followers, Kinematic, Levels};
use souple_math::Vec3;

use super::elastic::Values;
use super::lists::Work;
use super::roles::Role;
use super::{Choice, Coupling, Criterion, LEAST_MASS, LevelsForce};
use crate::solids::sample_law::Answer;

/// Part of the budget above which nothing is subdivided.
const FULL: f64 = 0.95;
/// Steps above the budget before points are regrouped against their criterion.
const PATIENCE: f64 = 2.0;

impl LevelsForce {
    /// Moves the set of subdivided points on, in `memory`.
    pub(super) fn choose(&self, division: &Division, rows: &Rows, memory: &mut [f64], work: &mut Work) {
        memory[self.cuts_made()] = self.cuts.by(rows.time) as f64;
        let positions = &rows.positions[self.rows()];
        work.refresh(self, memory);
        match &self.choice {
            Choice::Fixed(level) => {
                for points in &self.hierarchy.levels[..self.hierarchy.finest()] {
                    for point in points.clone() {
                        let wanted = level.evaluate(&self.hierarchy.rest[point].to_array());
                        let is_finer = wanted > f64::from(self.hierarchy.level_of[point]);
                        self.subdivide(memory, point, is_finer);
                    }
                }
            }
            Choice::Adaptive(criterion) if criterion.settled.is_some_and(|date| rows.time < date) => {
                let coarser = self.hierarchy.levels[..self.hierarchy.finest()].iter().flat_map(Clone::clone);
                coarser.for_each(|point| self.subdivide(memory, point, true));
            }
            Choice::Adaptive(criterion) => {
                self.take_reference(criterion, positions, memory);
                self.judge(criterion, positions, memory, work);
                self.carry_out(criterion, division, memory, work);
                return;
            }
        }
        self.give_up_empty_points(memory, work);
        work.refresh(self, memory);
    }

    /// Notes the variation that the body's own loads make, once: of every point in its own mesh, where the finest is at work.
    fn take_reference(&self, criterion: &Criterion, positions: &[Vec3], memory: &mut [f64]) {
        let [is_taken, references @ ..] = &mut memory[self.references()..] else { return };
        if std::mem::replace(is_taken, 1.0) != 0.0 {
            return;
        }
        for (point, reference) in references.iter_mut().enumerate() {
            *reference = criterion.measure.at(&self.hierarchy, point, positions);
        }
    }

    /// The variation around a point that is compared with thresholds.
    pub(super) fn counted_variation(
        &self,
        criterion: &Criterion,
        point: usize,
        positions: &[Vec3],
        memory: &[f64],
    ) -> f64 {
        let reference = memory.get(self.references() + 1 + point).copied().unwrap_or(0.0);
        (criterion.measure.at(&self.hierarchy, point, positions) - reference).max(0.0)
    }

    /// Which points are to be subdivided, what is wanted most first, equal ones by number; and which may be regrouped.
    fn judge(&self, criterion: &Criterion, positions: &[Vec3], memory: &[f64], work: &mut Work) {
        let hierarchy = &self.hierarchy;
        let Work { active, roles, variation, wanted, unwanted, .. } = work;
        variation.clear();
        variation.resize(hierarchy.point_count(), 0.0);
        for point in active.iter() {
            let point = *point as usize;
            variation[point] = self.counted_variation(criterion, point, positions, memory);
        }
        wanted.clear();
        unwanted.clear();
        for point in hierarchy.levels[..hierarchy.finest()].iter().flat_map(Clone::clone) {
            match roles.of_point[point] {
                Role::Active if variation[point] > criterion.refine => wanted.push(point as u32),
                Role::Subdivided => {
                    let successors = hierarchy.successors.get(point);
                    if successors.iter().all(|child| roles.is_active(*child as usize)) {
                        let of = |child: &u32| variation[*child as usize];
                        let greatest = successors.iter().map(of).fold(0.0, f64::max);
                        unwanted.push((greatest, point as u32));
                    }
                }
                _ => {}
            }
        }
        wanted.sort_unstable_by(|a, b| {
            variation[*b as usize].total_cmp(&variation[*a as usize]).then(a.cmp(b))
        });
    }

    /// Regroups and subdivides what was judged, as far as the budget goes.
    ///
    /// Empty points among those that are regrouped are given up at once: at rest too each look would come to where it began. So what a look came
    /// to is kept with its grounds.
    fn carry_out(&self, criterion: &Criterion, division: &Division, memory: &mut [f64], work: &mut Work) {
        let (wanted, mut unwanted) = (std::mem::take(&mut work.wanted), std::mem::take(&mut work.unwanted));
        let is_regrouped = |(greatest, _): &&(f64, u32)| *greatest < criterion.coarsen;
        let asked = &mut work.verdict.asked;
        (asked.budget, asked.division) = (self.budget, Some(*division));
        asked.before.clear();
        asked.before.extend_from_slice(&memory[..self.stays()]);
        asked.wanted.clone_from(&wanted);
        asked.regrouped.clear();
        asked.regrouped.extend(unwanted.iter().filter(is_regrouped).map(|(_, point)| *point));
        if work.verdict.is_known() {
            memory[..self.stays()].copy_from_slice(&work.verdict.after);
        } else {
            for (_, point) in unwanted.iter().filter(is_regrouped) {
                self.subdivide(memory, *point as usize, false);
            }
            self.spend(division, &wanted, &mut unwanted, memory, work);
            self.give_up_empty_points(memory, work);
            // a budget counts by the rates that velocities ask for; one that is overdrawn regroups by how much each point varies
            let is_certain =
                (self.budget.is_none() || !division.asks_first()) && memory[self.overload()] <= PATIENCE;
            work.verdict.keep(is_certain.then_some(&memory[..self.stays()]));
        }
        work.refresh(self, memory);
        (work.wanted, work.unwanted) = (wanted, unwanted);
    }

    /// Subdivides as far as the budget goes; where it is overdrawn, regroups what needs it least.
    fn spend(
        &self,
        division: &Division,
        wanted: &[u32],
        unwanted: &mut [(f64, u32)],
        memory: &mut [f64],
        work: &mut Work,
    ) {
        let Some(budget) = self.budget else {
            wanted.iter().for_each(|point| self.subdivide(memory, *point as usize, true));
            return;
        };
        let cost = |memory: &[f64], work: &mut Work| {
            work.refresh(self, memory);
            work.divide(self, division);
            work.evaluations(division) as f64
        };
        let before = cost(memory, work);
        // what is refined is counted, not guessed: half of it is taken back until it fits
        let mut accepted = if before < FULL * budget { wanted.len() } else { 0 };
        wanted[..accepted].iter().for_each(|point| self.subdivide(memory, *point as usize, true));
        while accepted > 0 && cost(memory, work) > FULL * budget {
            wanted[accepted / 2..accepted]
                .iter()
                .for_each(|point| self.subdivide(memory, *point as usize, false));
            accepted /= 2;
        }
        let overload = self.overload();
        memory[overload] = if before > budget { memory[overload] + 1.0 } else { 0.0 };
        if memory[overload] > PATIENCE {
            unwanted.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            for (_, point) in unwanted {
                self.subdivide(memory, *point as usize, false);
                if cost(memory, work) <= budget {
                    break;
                }
            }
        }
    }

    /// A point whose matter finer points stand for has nothing to move: it is subdivided too. One way each level stands for all of its own.
    pub(super) fn give_up_empty_points(&self, memory: &mut [f64], work: &mut Work) {
        if self.coupling == Coupling::OneWay {
            return;
        }
        loop {
            work.refresh(self, memory);
            let is_empty = |point: &&u32| {
                let point = **point as usize;
                usize::from(self.hierarchy.level_of[point]) < self.hierarchy.finest()
                    && work.carried[point] <= LEAST_MASS * self.whole_masses[point]
            };
            let mut found = false;
            for point in work.active.iter().filter(is_empty) {
                self.subdivide(memory, *point as usize, true);
                found = true;
            }
            if !found {
                return;
            }
        }
    }

    /// The least rate of each active point at which its velocity changes by no more than a division allows, as it is accelerated now.
    pub(super) fn urge(&self, division: &Division, rows: &Rows, memory: &mut [f64], work: &mut Work) {
        if !division.asks_first() {
            return;
        }
        let values = Values { positions: &rows.positions[self.rows()], variation: &[] };
        let (mut law_memory, mut forces) = (std::mem::take(&mut work.stress), std::mem::take(&mut work.sums));
        self.sum_all(Answer::Stress, values, work, &mut law_memory, &mut forces);
        let urges = self.urges();
        memory[urges..self.moved()].fill(0.0);
        for point in &work.active {
            let point = *point as usize;
            let change = forces[point].length() / work.masses[point] * division.timestep;
            let rate = (0..division.halvings)
                .find(|rate| change <= division.velocity_jump * f64::from(division.dates(*rate)))
                .unwrap_or(division.halvings);
            memory[urges + point] = f64::from(rate);
        }
        (work.stress, work.sums) = (law_memory, forces);
        work.refresh(self, memory);
    }

    /// What others being active does to rows: they follow anew, and keep the momentum of the matter. How far that moves them is summed
    /// up in `memory`.
    pub(super) fn change_over(&self, rows: &mut Rows, memory: &mut [f64], work: &Work) {
        let velocities = &mut rows.velocities[self.rows()];
        let momentum = |velocities: &[Vec3]| -> Vec3 {
            self.finest_masses.iter().zip(velocities).map(|(mass, v)| *v * *mass).sum()
        };
        let before = momentum(velocities);
        self.place(work, Followers::All, Kinematic::Velocity, velocities);
        if self.coupling == Coupling::Transpose {
            let lost = before - momentum(velocities);
            let shift = lost / self.finest_masses.iter().sum::<f64>();
            velocities.iter_mut().for_each(|v| *v += shift);
        }
        let positions = &mut rows.positions[self.rows()];
        self.place(work, Followers::All, Kinematic::Position, positions);
        let moves = positions.iter().zip(&work.followed).map(|(after, before)| *after - *before);
        for (sum, step) in
            memory[self.moved()..self.references()].as_chunks_mut::<3>().0.iter_mut().zip(moves)
        {
            *sum = (Vec3::from_array(*sum) + step).to_array();
        }
    }
}

/// What a look follows from.
#[derive(Clone, Debug, Default, PartialEq)]
struct Grounds {
    budget: Option<f64>,
    division: Option<Division>,
    /// What says who is at work.
    before: Vec<f64>,
    wanted: Vec<u32>,
    regrouped: Vec<u32>,
}

/// What the last look came to, and on what grounds: the same grounds come to the same.
#[derive(Clone, Debug, Default)]
pub struct Verdict {
    /// Of this look, and of the last one.
    asked: Grounds,
    grounds: Grounds,
    /// What says who is at work, after; empty where that follows from more.
    after: Vec<f64>,
}

impl Verdict {
    fn is_known(&self) -> bool {
        !self.after.is_empty() && self.asked == self.grounds
    }

    fn keep(&mut self, after: Option<&[f64]>) {
        std::mem::swap(&mut self.asked, &mut self.grounds);
        self.after.clear();
        self.after.extend_from_slice(after.unwrap_or(&[]));
    }

    pub fn bytes(&self) -> usize {
        let of = |grounds: &Grounds| {
            8 * grounds.before.capacity() + 4 * (grounds.wanted.capacity() + grounds.regrouped.capacity())
        };
        of(&self.asked) + of(&self.grounds) + 8 * self.after.capacity()
    }
}

impl Work {
    /// Stresses that a step so divided evaluates.
    pub fn evaluations(&self, division: &Division) -> usize {
        let samples = |rate: usize| self.due[rate].iter().flat_map(|due| due.slots()).count();
        let at_dates = |rate: u32| samples(rate as usize) * division.dates(rate) as usize;
        self.first_evaluations(division) + (0..=division.halvings).map(at_dates).sum::<usize>()
    }

    /// Those of them by which points choose their rates.
    pub fn first_evaluations(&self, division: &Division) -> usize {
        if division.asks_first() { self.acting.iter().filter(|volume| **volume > 0.0).count() } else { 0 }
    }
}
