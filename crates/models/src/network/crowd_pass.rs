//! One evaluation of all pairs of a multitude: forces, heat, and what is remembered next.
//!
//! A step reads all three, so they are computed together; forces stand slot by slot until each ball gathers its own, in the
//! order of rows. Of many slots a window at a time stands there: since windows follow the order of rows too, what a ball gathers
//! of one after the other it gathers in the same order, and no bit depends on how wide they are.

use std::ops::Range;

use souple_engine::{Configuration, Kept, KeptRef, make_room};
use souple_math::Vec3;
use souple_solve::reduce;

use super::crowd_list::{Groups, LISTED_TOGETHER, Neighbours};
use super::friction::{Friction, Hook, Phase};
use super::kernel::LinkKernel;
use super::layout::LANES;

/// Balls of the first group that a thread takes at once, at least.
const TOGETHER: usize = LISTED_TOGETHER;
/// Slots whose forces stand side by side, at least: 6 MiB, where those of a million balls would fill 130.
const WINDOW: usize = 1 << 18;
/// Tasks that are enough for any number of threads: each has buffers of its own.
const TASKS: usize = 256;
/// Balls whose pairs are looked at together: their numbers stay near the processor.
const AT_HAND: usize = 32;

/// What all pairs do.
pub struct Pass {
    /// Slots of a window, at least.
    window: usize,
    /// On the first ball of each slot of a window [N].
    forces: Vec<Vec3>,
    tasks: Vec<Task>,
}

impl Default for Pass {
    fn default() -> Self {
        Self { window: WINDOW, forces: Vec::new(), tasks: Vec::new() }
    }
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

/// What becomes of pairs that leave the range in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Leaving {
    Forgotten,
    /// They are looked at once more.
    SeenOff,
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
        make_room(&mut self.keys, 1);
        self.keys.push(key(pair));
        make_room(&mut self.numbers, numbers.len());
        self.numbers.extend_from_slice(numbers);
    }

    /// What pairs of a batch do whose law has no memory.
    fn act_together(
        &mut self,
        at: &Configuration,
        with: &Evaluation,
        known: &mut Known,
        forces: &mut [Vec3],
    ) {
        let mut batch = std::mem::take(&mut self.batch);
        batch.respond(with, at.time);
        for (i, ((slot, pair), [d, before])) in batch.pairs.iter().zip(&batch.ways).enumerate() {
            let length = batch.lengths[0][i];
            let along = if length > f64::MIN_POSITIVE {
                *d / length
            } else {
                before.try_normalised().unwrap_or(Vec3::X)
            };
            let mut force = along * batch.pushes[i];
            self.heat += batch.heats[i];
            if let Some(friction) = with.friction
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
        leaving: Leaving,
        (first_slot, forces): (usize, &mut [Vec3]),
    ) {
        self.pairs.clear();
        self.ways.clear();
        self.lengths.iter_mut().for_each(Vec::clear);
        let range_sq = range * range;
        for ball in balls {
            let row = first_row as usize + ball;
            let (x, v) = (at.positions[row], at.velocities[row]);
            for (slot, other) in (list.start(ball)..).zip(list.others(ball)) {
                let other = *other as usize;
                let d = x - at.positions[other];
                let length_sq = d.length_sq();
                // most pairs of a list are out of range, and are asked no more
                let before = || d - (v - at.velocities[other]) * timestep;
                // written so that what is not finite acts, and is found
                if length_sq >= range_sq
                    && (leaving == Leaving::Forgotten || before().length_sq() >= range_sq)
                {
                    forces[slot - first_slot] = Vec3::ZERO;
                    continue;
                }
                let before = before();
                self.pairs.push(((slot - first_slot) as u32, [row as u32, other as u32]));
                self.ways.push([d, before]);
                self.lengths[0].push(length_sq.sqrt());
                self.lengths[1].push(before.length());
            }
        }
    }

    fn respond(&mut self, with: &Evaluation, time: f64) {
        let Evaluation { law, gain, range, .. } = *with;
        let Self { lengths, pushes, still, heats, unused, .. } = self;
        let whole = lengths[0].len().next_multiple_of(LANES);
        lengths.iter_mut().for_each(|lengths| lengths.resize(whole, range));
        [&mut *pushes, &mut *still, &mut *heats, &mut *unused]
            .into_iter()
            .for_each(|list| list.resize(whole, 0.0));
        let [now, before] = lengths.each_ref();
        law.respond_to_many(range, time, [now, before], [pushes, heats]);
        if with.friction.is_some() {
            // the elastic part alone presses
            law.respond_to_many(range, time, [now, now], [still, unused]);
        }
        if gain != 1.0 {
            [pushes, still, heats].into_iter().flatten().for_each(|number| *number *= gain);
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
    /// How much of the law acts.
    pub gain: f64,
    pub friction: Option<&'a Friction>,
    /// [m]
    pub range: f64,
    /// [s]
    pub timestep: f64,
    /// Numbers of an entry.
    pub kept_len: usize,
    /// Pairs do what the law and friction say and nothing else, and the law has no memory: they are looked at together.
    pub are_plain: bool,
}

impl Pass {
    /// Evaluates all pairs and adds their forces to `out`; `act(pair, ways, known numbers, task)` does where they are
    /// not plain.
    pub fn run(
        &mut self,
        with: &Evaluation,
        at: &Configuration,
        mut out: Option<&mut [Vec3]>,
        act: &(impl Fn([u32; 2], [Vec3; 2], Option<&[f64]>, &mut Task) -> Vec3 + Sync),
    ) {
        let Evaluation { groups, list, range, timestep, kept_len, are_plain, .. } = *with;
        let (count, first_row) = (groups.first.len(), groups.first.start);
        let together = count.div_ceil(TASKS).max(1).next_multiple_of(TOGETHER);
        self.tasks.resize_with(count.div_ceil(together), Task::default);
        let first_ball = |task: usize| (task * together).min(count);
        let start_of = |task: usize| list.start(first_ball(task));
        let work = |number: usize, task: &mut Task, forces: &mut [Vec3]| {
            let balls = number * together..((number + 1) * together).min(count);
            let mut known = Known::from(at.kept, kept_len, first_row + balls.start as u32);
            task.keys.clear();
            task.numbers.clear();
            task.heat = 0.0;
            let first_slot = list.start(balls.start);
            for start in balls.clone().step_by(AT_HAND) {
                let own = start..(start + AT_HAND).min(balls.end);
                let mut batch = std::mem::take(&mut task.batch);
                let leaving = if are_plain { Leaving::Forgotten } else { Leaving::SeenOff };
                batch.gather((own, first_row), (list, range, timestep), at, leaving, (first_slot, forces));
                if are_plain {
                    task.batch = batch;
                    task.act_together(at, with, &mut known, forces);
                    continue;
                }
                for ((slot, pair), ways) in batch.pairs.iter().zip(&batch.ways) {
                    forces[*slot as usize] = act(*pair, *ways, known.find(key(*pair)), task);
                }
                task.batch = batch;
            }
        };
        let mut first = 0;
        while first < self.tasks.len() {
            let mut last = first + 1;
            while last < self.tasks.len() && start_of(last) - start_of(first) < self.window {
                last += 1;
            }
            let slots = start_of(first)..start_of(last);
            let more = slots.len().saturating_sub(self.forces.len());
            make_room(&mut self.forces, more);
            self.forces.resize(slots.len(), Vec3::ZERO);
            each(first, &mut self.tasks[first..last], &mut self.forces, &start_of, &work);
            if let Some(out) = &mut out {
                let balls = first_ball(first)..first_ball(last);
                self.add_window(groups, list, (balls, slots), out);
            }
            first = last;
        }
    }

    /// Adds the forces of a window to each ball: from lower rows, then from higher ones.
    fn add_window(
        &self,
        groups: Groups,
        list: &Neighbours,
        (balls, slots): (Range<usize>, Range<usize>),
        out: &mut [Vec3],
    ) {
        let own = |ball: usize, sum: &mut Vec3| {
            let own = list.start(ball) - slots.start..list.start(ball + 1) - slots.start;
            self.forces[own].iter().for_each(|force| *sum += *force);
        };
        let from_others = |ball: usize, sum: &mut Vec3| {
            let of_ball = list.slots_of(ball, &slots);
            of_ball.iter().for_each(|slot| *sum -= self.forces[*slot as usize - slots.start]);
        };
        let (is_one, first_row) = (groups.is_one(), groups.first.start as usize);
        // of one group balls beyond the window are named by its slots too
        let named = if is_one { (list.highest(&balls) as usize + 1).saturating_sub(first_row) } else { 0 };
        let rows = first_row + balls.start..first_row + balls.end.max(named);
        reduce::for_each_chunk(&mut out[rows], &|first, sums: &mut [Vec3]| {
            for (ball, sum) in (balls.start + first..).zip(sums) {
                if is_one {
                    from_others(ball, sum);
                }
                if ball < balls.end {
                    own(ball, sum);
                }
            }
        });
        if !is_one {
            let rows = groups.second.start as usize..groups.second.end as usize;
            reduce::for_each_chunk(&mut out[rows], &|first, sums: &mut [Vec3]| {
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

#[cfg(test)]
mod tests {
    use super::*;
    use souple_engine::KeptRef;
    use souple_math::Real;

    use crate::network::kernel::InLanes;
    use crate::network::law::{LinkLaw, MEMORY, Reach, Response};

    /// Pushes as far as its ends are within the range.
    #[derive(Debug)]
    struct Apart;

    impl LinkLaw for Apart {
        fn respond<R: Real>(&self, reach: &Reach<R>, _: &mut [R; MEMORY]) -> Response<R> {
            let push = reach.rest - reach.length;
            Response { push, stored: push * push * 0.5, heat: push * 0.0 }
        }

        fn is_conservative(&self) -> bool {
            true
        }

        fn stiffest(&self) -> f64 {
            1.0
        }
    }

    /// Balls gather the same bits from many windows as from one, of one group and of two.
    #[test]
    fn windows_change_no_bit() {
        let number = |i: usize, salt: f64| ((i as f64 * 12.9898 + salt).sin() * 43_758.545_3).fract().abs();
        let place = |i: usize| Vec3::new(number(i, 0.1), number(i, 1.7), number(i, 3.3)) * 5.0;
        let positions: Vec<Vec3> = (0..4000).map(place).collect();
        let velocities = vec![Vec3::ZERO; positions.len()];
        for [first, second] in [[0..4000_u32, 0..4000], [0..2500, 2500..4000]] {
            let groups = Groups { first: &first, second: &second };
            let mut list = Neighbours::default();
            list.bring_up_to_date(groups, &positions, 0.6);
            let with = Evaluation {
                groups,
                list: &list,
                law: &InLanes(Apart),
                gain: 1.0,
                friction: None,
                range: 0.6,
                timestep: 1e-3,
                kept_len: 0,
                are_plain: true,
            };
            let at = Configuration {
                positions: &positions,
                velocities: &velocities,
                time: 0.0,
                load: 1.0,
                memory: &[],
                pairs: &[],
                kept: KeptRef::default(),
                driven: &[],
                fields: &[],
            };
            let sums = |window: usize| {
                let mut out = vec![Vec3::new(0.1, 0.2, 0.3); positions.len()];
                let mut pass = Pass { window, ..Pass::default() };
                pass.run(&with, &at, Some(&mut out), &|_, _, _, _| Vec3::ZERO);
                (out, pass.forces.len())
            };
            let ((whole, all), (parts, few)) = (sums(usize::MAX), sums(1000));
            assert!(few < all / 2, "{few} of {all} slots are side by side");
            assert_eq!(whole, parts);
        }
    }
}
