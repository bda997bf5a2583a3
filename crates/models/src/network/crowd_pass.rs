//! One evaluation of all pairs of a multitude: forces, heat, and what is remembered next.
//!
//! A step reads all three, so they are computed together; forces stand slot by slot until each ball gathers its own, in the
//! order of rows.

use std::ops::Range;

use souple_engine::{Configuration, Kept, KeptRef, make_room};
use souple_math::Vec3;
use souple_solve::reduce;

use super::crowd_list::{Groups, Neighbours};
use super::friction::{Friction, Hook, Phase};
use super::kernel::LinkKernel;
use super::layout::LANES;

/// Balls of the first group that a thread takes at once, at least.
const TOGETHER: usize = 512;
/// Tasks that are enough for any number of threads: each has buffers of its own.
const TASKS: usize = 256;
/// Balls whose pairs are looked at together: their numbers stay near the processor.
const AT_HAND: usize = 32;

/// What all pairs do.
#[derive(Default)]
pub struct Pass {
    /// On the first ball of each slot [N].
    forces: Vec<Vec3>,
    tasks: Vec<Task>,
}

/// What the pairs of some balls do beside forces.
#[derive(Default)]
pub struct Task {
    keys: Vec<u64>,
    numbers: Vec<f64>,
    /// [J]
    pub heat: f64,
    batch: Batch,
}

/// Pairs in range that are looked at together; lengths in whole blocks of lanes.
#[derive(Default)]
pub struct Batch {
    /// Slots counted from the first of the task, and rows.
    pub pairs: Vec<(u32, [u32; 2])>,
    /// `P1 - P2` now and a step before [m].
    pub ways: Vec<[Vec3; 2]>,
    lengths: [Vec<f64>; 2],
    pushes: Vec<f64>,
    /// Pushes as though ends stood still [N].
    still: Vec<f64>,
    heats: Vec<f64>,
    unused: Vec<f64>,
}

/// The key of a pair.
pub fn key([a, b]: [u32; 2]) -> u64 {
    u64::from(a) << 32 | u64::from(b)
}

/// Entries looked for by ascending keys.
pub struct Known<'a> {
    kept: KeptRef<'a>,
    len: usize,
    next: usize,
}

impl<'a> Known<'a> {
    /// From the first ball on.
    pub fn from(kept: KeptRef<'a>, len: usize, row: u32) -> Self {
        let next = kept.keys.partition_point(|known| *known < key([row, 0]));
        Self { kept, len, next }
    }

    /// The numbers of an entry, if there is one; of later keys each time.
    pub fn find(&mut self, key: u64) -> Option<&'a [f64]> {
        while self.kept.keys.get(self.next).is_some_and(|known| *known < key) {
            self.next += 1;
        }
        let is_here = self.kept.keys.get(self.next) == Some(&key);
        is_here.then(|| &self.kept.numbers[self.next * self.len..(self.next + 1) * self.len])
    }
}

impl Task {
    /// Writes what a pair remembers.
    pub fn keep(&mut self, pair: [u32; 2], numbers: &[f64]) {
        self.keys.push(key(pair));
        self.numbers.extend_from_slice(numbers);
    }

    /// What pairs of a batch do whose law has no memory.
    fn act_together(
        &mut self,
        at: &Configuration,
        (law, range, friction): (&dyn LinkKernel, f64, Option<&Friction>),
        known: &mut Known,
        forces: &mut [Vec3],
    ) {
        let mut batch = std::mem::take(&mut self.batch);
        batch.respond(law, range, at.time, friction.is_some());
        for (i, ((slot, pair), [d, before])) in batch.pairs.iter().zip(&batch.ways).enumerate() {
            let length = batch.lengths[0][i];
            let along = if length > f64::MIN_POSITIVE {
                *d / length
            } else {
                before.try_normalised().unwrap_or(Vec3::X)
            };
            let mut force = along * batch.pushes[i];
            self.heat += batch.heats[i];
            if let Some(friction) = friction
                && batch.still[i] > 0.0
                && length > f64::MIN_POSITIVE
            {
                let began = known.find(key(*pair)).map(|began| Vec3::new(began[0], began[1], began[2]));
                let hook = began.map_or(Hook::FREE, |began| Hook { phase: Phase::Stick, began });
                let grip = friction.grip_along(along, hook, *d, *before, batch.still[i]);
                force += grip.force;
                self.heat += grip.heat;
                if grip.next.phase == Phase::Stick {
                    self.keep(*pair, &grip.next.began.to_array());
                }
            }
            forces[*slot as usize] = force;
        }
        self.batch = batch;
    }
}

impl Batch {
    /// Takes the pairs in range of some balls; forces of the others are none.
    fn gather(
        &mut self,
        (balls, first_row): (Range<usize>, u32),
        (list, range, timestep): (&Neighbours, f64, f64),
        at: &Configuration,
        (first_slot, forces): (usize, &mut [Vec3]),
    ) {
        self.pairs.clear();
        self.ways.clear();
        self.lengths.iter_mut().for_each(Vec::clear);
        let range_sq = range * range;
        for ball in balls {
            let row = first_row as usize + ball;
            let (x, v) = (at.positions[row], at.velocities[row]);
            for slot in list.start(ball)..list.start(ball + 1) {
                let other = list.other(slot);
                let d = x - at.positions[other];
                let length_sq = d.length_sq();
                // written so that what is not finite acts, and is found
                if length_sq >= range_sq {
                    forces[slot - first_slot] = Vec3::ZERO;
                    continue;
                }
                let before = d - (v - at.velocities[other]) * timestep;
                self.pairs.push(((slot - first_slot) as u32, [row as u32, other as u32]));
                self.ways.push([d, before]);
                self.lengths[0].push(length_sq.sqrt());
                self.lengths[1].push(before.length());
            }
        }
    }

    fn respond(&mut self, law: &dyn LinkKernel, range: f64, time: f64, has_friction: bool) {
        let Self { lengths, pushes, still, heats, unused, .. } = self;
        let whole = lengths[0].len().next_multiple_of(LANES);
        lengths.iter_mut().for_each(|lengths| lengths.resize(whole, range));
        [&mut *pushes, &mut *still, &mut *heats, &mut *unused]
            .into_iter()
            .for_each(|list| list.resize(whole, 0.0));
        let [now, before] = lengths.each_ref();
        law.respond_to_many(range, time, [now, before], [pushes, heats]);
        if has_friction {
            // the elastic part alone presses
            law.respond_to_many(range, time, [now, now], [still, unused]);
        }
    }

    fn bytes(&self) -> usize {
        let numbers = [&self.pushes, &self.still, &self.heats, &self.unused].into_iter().chain(&self.lengths);
        numbers.map(|list| 8 * list.capacity()).sum::<usize>()
            + size_of::<(u32, [u32; 2])>() * self.pairs.capacity()
            + size_of::<[Vec3; 2]>() * self.ways.capacity()
    }
}

/// What pairs are evaluated with.
pub struct Evaluation<'a> {
    pub groups: Groups<'a>,
    pub list: &'a Neighbours,
    pub law: &'a dyn LinkKernel,
    pub friction: Option<&'a Friction>,
    /// [m]
    pub range: f64,
    /// [s]
    pub timestep: f64,
    /// Numbers of an entry.
    pub kept_len: usize,
}

impl Pass {
    /// Evaluates all pairs; `act(pair, ways, known numbers, task)` does where the law has a memory.
    pub fn run(
        &mut self,
        with: &Evaluation,
        at: &Configuration,
        act: &(impl Fn([u32; 2], [Vec3; 2], Option<&[f64]>, &mut Task) -> Vec3 + Sync),
    ) {
        let Evaluation { groups, list, law, friction, range, timestep, kept_len } = *with;
        let (count, first_row) = (groups.first.len(), groups.first.start);
        let together = count.div_ceil(TASKS).max(1).next_multiple_of(TOGETHER);
        let more = list.slot_count().saturating_sub(self.forces.len());
        make_room(&mut self.forces, more);
        self.forces.resize(list.slot_count(), Vec3::ZERO);
        self.tasks.resize_with(count.div_ceil(together), Task::default);
        let start_of = |task: usize| list.start((task * together).min(count));
        each(0, &mut self.tasks, &mut self.forces, &start_of, &|number, task, forces| {
            let balls = number * together..((number + 1) * together).min(count);
            let mut known = Known::from(at.kept, kept_len, first_row + balls.start as u32);
            task.keys.clear();
            task.numbers.clear();
            task.heat = 0.0;
            let first_slot = list.start(balls.start);
            for start in balls.clone().step_by(AT_HAND) {
                let own = start..(start + AT_HAND).min(balls.end);
                let mut batch = std::mem::take(&mut task.batch);
                batch.gather((own, first_row), (list, range, timestep), at, (first_slot, forces));
                if law.memory_len() == 0 {
                    task.batch = batch;
                    task.act_together(at, (law, range, friction), &mut known, forces);
                    continue;
                }
                for ((slot, pair), ways) in batch.pairs.iter().zip(&batch.ways) {
                    forces[*slot as usize] = act(*pair, *ways, known.find(key(*pair)), task);
                }
                task.batch = batch;
            }
        });
    }

    /// Adds its forces to each ball: from lower rows, then from higher ones.
    pub fn add_to(&self, groups: Groups, list: &Neighbours, out: &mut [Vec3]) {
        let own = |ball: usize, sum: &mut Vec3| {
            self.forces[list.start(ball)..list.start(ball + 1)].iter().for_each(|force| *sum += *force);
        };
        let from_others = |ball: usize, sum: &mut Vec3| {
            list.slots_of(ball).iter().for_each(|slot| *sum -= self.forces[*slot as usize]);
        };
        let rows = |rows: &Range<u32>| rows.start as usize..rows.end as usize;
        let is_one = groups.is_one();
        reduce::for_each_chunk(&mut out[rows(groups.first)], &|first, sums: &mut [Vec3]| {
            for (ball, sum) in (first..).zip(sums) {
                if is_one {
                    from_others(ball, sum);
                }
                own(ball, sum);
            }
        });
        if !is_one {
            reduce::for_each_chunk(&mut out[rows(groups.second)], &|first, sums: &mut [Vec3]| {
                (first..).zip(sums).for_each(|(ball, sum)| from_others(ball, sum));
            });
        }
    }

    /// Writes what is remembered, and gives the heat [J].
    pub fn keep(&self, kept: &mut Kept) -> f64 {
        let sum = |len: fn(&Task) -> usize| self.tasks.iter().map(len).sum();
        kept.make_room(sum(|task| task.keys.len()), sum(|task| task.numbers.len()));
        for task in &self.tasks {
            kept.keys.extend_from_slice(&task.keys);
            kept.numbers.extend_from_slice(&task.numbers);
        }
        self.tasks.iter().map(|task| task.heat).sum()
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let of = |task: &Task| {
            size_of::<Task>() + 8 * (task.keys.capacity() + task.numbers.capacity()) + task.batch.bytes()
        };
        size_of::<Vec3>() * self.forces.capacity() + self.tasks.iter().map(of).sum::<usize>()
    }
}

/// Calls `work` on each task with its own forces, tasks shared among threads where they are many.
fn each(
    first: usize,
    tasks: &mut [Task],
    forces: &mut [Vec3],
    start_of: &(impl Fn(usize) -> usize + Sync),
    work: &(impl Fn(usize, &mut Task, &mut [Vec3]) + Sync),
) {
    match tasks {
        [] => {}
        [task] => work(first, task, forces),
        _ => {
            let middle = tasks.len() / 2;
            let (head, tail) = tasks.split_at_mut(middle);
            let split = start_of(first + middle) - start_of(first);
            let (head_forces, tail_forces) = forces.split_at_mut(split);
            let mut one = || each(first, head, head_forces, start_of, work);
            let mut two = || each(first + middle, tail, tail_forces, start_of, work);
            if rayon::current_num_threads() > 1 {
                rayon::join(one, two);
            } else {
                one();
                two();
            }
        }
    }
}
