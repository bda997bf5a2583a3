//! What the staggered stepper asks of a body of levels.

use std::ops::Range;

use souple_engine::levels::{Census, Division, Evaluations, Filter, Followers, Kinematic, Levels, Push};
use souple_engine::{Rows, Scratch};
use souple_math::Vec3;

use super::elastic::Values;
use super::links::Loops;
use super::lists::Work;
use super::{Choice, Coupling, LevelsForce};
use crate::solids::sample_law::Answer;
use crate::stays;

/// The work of a scratch that is only read.
fn read(scratch: &Scratch) -> &Work {
    scratch.downcast_ref().unwrap_or_else(|| unreachable!("made by this force's own new_scratch"))
}

/// Calls `visit` for each of the followers meant, by its number among all points.
fn for_each(force: &LevelsForce, work: &Work, who: Followers, mut visit: impl FnMut(usize)) {
    match who {
        Followers::Ghosts => work.ghosts.iter().for_each(|point| visit(*point as usize)),
        Followers::These(rows) => {
            let own = force.rows();
            rows.iter()
                .map(|row| *row as usize)
                .filter(|row| own.contains(row))
                .for_each(|row| visit(row - own.start));
        }
        Followers::All if force.hierarchy.loops == Loops::Lagged => {
            work.relay.iter().for_each(|point| visit(*point as usize));
        }
        Followers::All => (0..force.hierarchy.point_count()).for_each(visit),
    }
}

/// Where a point is, or how fast, that follows others with weights.
fn follow(
    kind: Kinematic,
    rest: &[Vec3],
    point: usize,
    leaders: impl Iterator<Item = (u32, f64)>,
    values: &[Vec3],
) -> Vec3 {
    match kind {
        // x = X + Σ w (x - X)
        Kinematic::Position => leaders.fold(rest[point], |sum, (leader, weight)| {
            sum + (values[leader as usize] - rest[leader as usize]) * weight
        }),
        Kinematic::Velocity => leaders.map(|(leader, weight)| values[leader as usize] * weight).sum(),
    }
}

impl LevelsForce {
    /// Brings followers to where they follow; `values` are those of this body's points.
    pub(super) fn place(&self, work: &Work, who: Followers, kind: Kinematic, values: &mut [Vec3]) {
        let rest = &self.hierarchy.rest;
        for_each(self, work, who, |point| {
            if work.roles.is_active(point) {
                return;
            }
            values[point] = match self.hierarchy.loops {
                Loops::Activated => {
                    follow(kind, rest, point, work.following.of(point).iter().copied(), values)
                }
                // corner by corner as they stand
                Loops::Lagged => {
                    let feed = work.roles.feed(&self.hierarchy, point).into_iter();
                    let corners = feed.flat_map(|feed| feed.corners.into_iter().zip(feed.weights));
                    follow(kind, rest, point, corners, values)
                }
            };
        });
    }

    /// Gives what is on followers to their leaders.
    pub(super) fn return_all(&self, work: &Work, who: Followers, values: &mut [Vec3]) {
        for_each(self, work, who, |point| {
            if work.roles.is_active(point) || values[point] == Vec3::ZERO {
                return;
            }
            let value = std::mem::replace(&mut values[point], Vec3::ZERO);
            for (leader, weight) in work.following.of(point) {
                values[*leader as usize] += value * *weight;
            }
        });
    }
}

impl Levels for LevelsForce {
    fn rows(&self) -> Range<usize> {
        self.row_range()
    }

    fn shortest_interval(&self, filter: Filter) -> f64 {
        filter.lengthening() * self.shortest_interval
    }

    fn adapt(&self, division: &Division, rows: &mut Rows, memory: &mut [f64], scratch: &mut Scratch) {
        let work = self.work(scratch);
        work.refresh(self, memory);
        work.before.clone_from(&work.active);
        work.were.clear();
        work.were.extend(work.roles.fineness());
        // where they follow, without what holds them elsewhere
        let mut followed = std::mem::take(&mut work.followed);
        followed.clear();
        followed.extend_from_slice(self.own(&rows.positions));
        self.place(work, Followers::All, Kinematic::Position, &mut followed);
        work.followed = followed;
        self.choose(division, rows, memory, work);
        if work.active != work.before {
            self.change_over(rows, memory, work);
            let log = &mut memory[self.stays()..self.urges()];
            stays::note(&work.were, work.roles.fineness(), rows.time, log);
        }
        self.urge(division, rows, memory, work);
        work.divide(self, division);
        work.moved.clear();
        work.moved.extend(
            memory[self.moved()..self.references()]
                .as_chunks::<3>()
                .0
                .iter()
                .map(|sum| Vec3::from_array(*sum)),
        );
    }

    fn active<'a>(&self, scratch: &'a Scratch) -> &'a [u32] {
        &read(scratch).active_rows
    }

    fn moved<'a>(&self, scratch: &'a Scratch) -> &'a [Vec3] {
        &read(scratch).moved
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
        for point in &read(scratch).of_rate[rate as usize] {
            let row = self.first_row + *point as usize;
            velocities[row] += accelerations[row] * interval;
        }
    }

    fn drift(&self, timestep: f64, scratch: &Scratch, rows: &mut Rows) {
        // in every tick: a velocity that quivers about zero would fade unevenly at its own dates
        let fading = libm::exp(-self.mass_damping * timestep);
        for row in &read(scratch).active_rows {
            let row = *row as usize;
            rows.velocities[row] = rows.velocities[row] * fading;
            rows.positions[row] += rows.velocities[row] * timestep;
        }
    }

    fn leverage(&self, scratch: &Scratch) -> f64 {
        match self.hierarchy.loops {
            Loops::Activated => read(scratch).following.leverage,
            // what feeds itself a tick late goes on for as long as it likes
            Loops::Lagged => f64::INFINITY,
        }
    }

    fn follow(&self, who: Followers, kind: Kinematic, scratch: &Scratch, values: &mut [Vec3]) {
        self.place(read(scratch), who, kind, &mut values[self.row_range()]);
    }

    fn give_back(&self, who: Followers, scratch: &Scratch, impulses: &mut [Vec3]) {
        self.return_all(read(scratch), who, &mut impulses[self.row_range()]);
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
        let values = Values { positions: self.own(&rows.positions), variation: &[] };
        let velocities = self.own(&rows.velocities);
        let impulses = &mut impulses[self.row_range()];
        let interval = division.interval(rate);
        let parts = (&self.hierarchy, &self.matter);
        let (due, acting) = (&work.due[rate as usize], &work.acting);
        work.stress.ask(
            parts,
            Answer::Stress,
            due.iter().copied(),
            values,
            |slot, _, tet, corners, stress| {
                let mut stress = *stress;
                if self.viscosity > 0.0 {
                    // P += F 2 η sym(Fᵀ Ḟ)
                    let (F, rate) = (tet.gradient(values.positions), tet.gradient(velocities));
                    stress += F * F.transpose_mul(&rate).symmetric_part() * (2.0 * self.viscosity);
                }
                for (index, (corner, gradient)) in tet.corners.iter().zip(tet.gradients).enumerate() {
                    if corners & (1 << index) != 0 {
                        impulses[*corner as usize] -= stress * gradient * (acting[slot] * interval);
                    }
                }
            },
        );
        if self.coupling == Coupling::Transpose {
            self.return_all(work, Followers::Ghosts, impulses);
        }
    }

    fn kick(
        &self,
        push: Push,
        division: &Division,
        scratch: &Scratch,
        impulses: &mut [Vec3],
        velocities: &mut [Vec3],
    ) {
        let work = read(scratch);
        let (impulses, velocities) = (&mut impulses[self.row_range()], &mut velocities[self.row_range()]);
        let mut give = |points: &[u32], masses: &[f64]| {
            for point in points {
                let point = *point as usize;
                velocities[point] += std::mem::replace(&mut impulses[point], Vec3::ZERO) / masses[point];
            }
        };
        let rate = match push {
            Push::Outer => return give(&work.active, &work.carried),
            Push::Elastic { rate } => rate,
        };
        give(&work.pushed[rate as usize], &work.masses);
        if division.filter == Filter::SemiImplicit {
            work.of_rate[rate as usize].iter().for_each(|point| {
                let v = &mut velocities[*point as usize];
                *v = work.brakes[*point as usize] * *v;
            });
        }
    }

    fn evaluations(&self, division: &Division, scratch: &Scratch) -> usize {
        read(scratch).evaluations(division)
    }

    fn workload(&self, division: &Division, memory: &[f64], scratch: &Scratch) -> Evaluations {
        let count = |work: &Work| {
            let of_rate = work.due.iter().map(|due| due.iter().flat_map(|due| due.slots()).count()).collect();
            Evaluations { first: work.first_evaluations(division), of_rate }
        };
        let known = read(scratch);
        if known.is_of(self, memory) && known.division == Some(*division) {
            return count(known);
        }
        let mut work = Work::new(self);
        work.refresh(self, memory);
        work.divide(self, division);
        count(&work)
    }

    fn variation(&self, positions: &[Vec3], memory: &[f64], scratch: &Scratch) -> Vec<(u32, f64)> {
        let Choice::Adaptive(criterion) = &self.choice else { return Vec::new() };
        let of_active = |work: &Work| {
            let own = self.own(positions);
            let of = |point: &u32| {
                let variation = self.counted_variation(criterion, *point as usize, own, memory);
                (self.first_row as u32 + point, variation)
            };
            work.active.iter().map(of).collect()
        };
        let known = read(scratch);
        if known.is_of(self, memory) {
            return of_active(known);
        }
        let mut work = Work::new(self);
        work.refresh(self, memory);
        of_active(&work)
    }

    fn census(&self, memory: &[f64], scratch: &Scratch) -> Census {
        let known = read(scratch);
        if known.is_of(self, memory) {
            return self.counted(memory, known);
        }
        let mut work = Work::new(self);
        work.refresh(self, memory);
        self.counted(memory, &work)
    }
}
