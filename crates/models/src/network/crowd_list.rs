//! Which balls may meet before any has moved far: lists that hold for many steps.
//!
//! They reach a little further than forces do, and are made anew when a ball has moved by half of that. What a list has too
//! many of is out of range, and forces on a ball are added in the order of rows: when it was made changes no bit.

use std::ops::Range;

use rayon::prelude::*;
use souple_engine::make_room;
use souple_math::Vec3;
use souple_solve::reduce;

use super::crowd_grid::Grid;

/// How much further than forces lists reach, as a share of the range.
const SKIN: f64 = 0.15;

/// Balls of the first group whose neighbours are found by one thread, and stand together.
pub const LISTED_TOGETHER: usize = 512;

/// Balls of two groups, or twice of one, by their rows.
#[derive(Clone, Copy, Debug)]
pub struct Groups<'a> {
    pub first: &'a Range<u32>,
    pub second: &'a Range<u32>,
}

impl Groups<'_> {
    pub fn is_one(&self) -> bool {
        self.first == self.second
    }

    /// Ranges without common rows.
    fn apart(&self) -> [Range<usize>; 2] {
        let rows = |range: &Range<u32>| range.start as usize..range.end as usize;
        [rows(self.first), if self.is_one() { 0..0 } else { rows(self.second) }]
    }
}

/// Neighbours of each ball of the first group, of one group those of higher rows alone. A place in the list is a slot.
#[derive(Default)]
pub struct Neighbours {
    grid: Grid,
    /// Where balls were when the list was made, of both groups [m].
    listed_at: [Vec<Vec3>; 2],
    /// Slots of each ball of the first group.
    starts: Vec<u32>,
    /// Of each so many balls the row of each slot, ascending for each ball.
    others: Vec<Vec<u32>>,
    /// Of each so many balls the highest of these rows.
    highest: Vec<u32>,
    /// Slots by the ball of the second group that they name, and where those of each begin.
    turned: Vec<u32>,
    turned_starts: Vec<u32>,
}

impl Neighbours {
    /// Whether all that is in range is in the list.
    pub fn hold(&self, groups: Groups, positions: &[Vec3], range: f64) -> bool {
        // less than half, so that rounding does not matter
        let limit_sq = (0.499 * SKIN * range).powi(2);
        let moved = |rows: Range<usize>, listed: &[Vec3]| {
            let now = &positions[rows];
            now.len() == listed.len()
                && reduce::sum(0..now.len(), &|part| {
                    let ways = now[part.clone()].iter().zip(&listed[part]);
                    // what is not finite is left to the check at the end of the step
                    ways.filter(|(now, listed)| (**now - **listed).length_sq() > limit_sq).count() as f64
                }) == 0.0
        };
        let [first, second] = groups.apart();
        !self.starts.is_empty() && moved(first, &self.listed_at[0]) && moved(second, &self.listed_at[1])
    }

    /// Makes the list anew where it does not hold.
    pub fn bring_up_to_date(&mut self, groups: Groups, positions: &[Vec3], range: f64) {
        if self.hold(groups, positions, range) {
            return;
        }
        for (listed, rows) in self.listed_at.iter_mut().zip(groups.apart()) {
            listed.clear();
            listed.extend_from_slice(&positions[rows]);
        }
        self.list(groups, positions, (1.0 + SKIN) * range);
        self.turn(groups);
    }

    fn list(&mut self, groups: Groups, positions: &[Vec3], reach: f64) {
        let Self { grid, starts, others, highest, .. } = self;
        grid.sort(groups.second.clone(), positions, reach);
        let count = groups.first.len();
        starts.clear();
        starts.resize(count + 1, 0);
        others.resize_with(count.div_ceil(LISTED_TOGETHER), Vec::new);
        let is_one = groups.is_one();
        let list = |(chunk, (others, counts)): (usize, (&mut Vec<u32>, &mut [u32]))| {
            others.clear();
            for (index, count) in counts.iter_mut().enumerate() {
                let (row, own) =
                    (groups.first.start + (chunk * LISTED_TOGETHER + index) as u32, others.len());
                grid.visit_near(positions[row as usize], positions, |other| {
                    if !is_one || other > row {
                        make_room(others, 1);
                        others.push(other);
                    }
                });
                others[own..].sort_unstable();
                *count = (others.len() - own) as u32;
            }
        };
        // threads are woken for many balls only
        if others.len() >= 16 && rayon::current_num_threads() > 1 {
            let counts = starts[1..].par_chunks_mut(LISTED_TOGETHER);
            others.par_iter_mut().zip(counts).enumerate().for_each(list);
        } else {
            others.iter_mut().zip(starts[1..].chunks_mut(LISTED_TOGETHER)).enumerate().for_each(list);
        }
        for ball in 0..count {
            starts[ball + 1] += starts[ball];
        }
        highest.clear();
        highest.extend(others.iter().map(|others| others.iter().max().copied().unwrap_or(0)));
    }

    /// Slots by second ball, for each in the order of the first.
    fn turn(&mut self, groups: Groups) {
        let Self { others, turned, turned_starts, .. } = self;
        let (count, first) = (groups.second.len(), groups.second.start);
        turned_starts.clear();
        turned_starts.resize(count + 1, 0);
        others.iter().flatten().for_each(|row| turned_starts[(row - first) as usize + 1] += 1);
        for ball in 0..count {
            turned_starts[ball + 1] += turned_starts[ball];
        }
        // each start moves on to the next while its ball is given slots, and back at the end
        let slots = turned_starts[count] as usize;
        let more = slots.saturating_sub(turned.len());
        make_room(turned, more);
        turned.resize(slots, 0);
        for (slot, row) in others.iter().flatten().enumerate() {
            let start = &mut turned_starts[(row - first) as usize];
            turned[*start as usize] = slot as u32;
            *start += 1;
        }
        turned_starts.copy_within(0..count, 1);
        turned_starts[0] = 0;
    }

    /// First slot of a ball of the first group, by its number there.
    pub fn start(&self, ball: usize) -> usize {
        self.starts[ball] as usize
    }

    /// Rows of the slots of a ball of the first group, ascending.
    pub fn others(&self, ball: usize) -> &[u32] {
        let chunk = ball / LISTED_TOGETHER;
        let first = self.start(chunk * LISTED_TOGETHER);
        &self.others[chunk][self.start(ball) - first..self.start(ball + 1) - first]
    }

    /// The highest row in the slots of some balls of the first group, whole chunks of [`LISTED_TOGETHER`].
    pub fn highest(&self, balls: &Range<usize>) -> u32 {
        let chunks = balls.start / LISTED_TOGETHER..balls.end.div_ceil(LISTED_TOGETHER);
        self.highest[chunks].iter().max().copied().unwrap_or(0)
    }

    /// Slots that name a ball of the second group, by its number there; of some slots those.
    pub fn slots_of(&self, ball: usize, among: &Range<usize>) -> &[u32] {
        let slots = &self.turned[self.turned_starts[ball] as usize..self.turned_starts[ball + 1] as usize];
        let [from, to] =
            [among.start, among.end].map(|end| slots.partition_point(|slot| (*slot as usize) < end));
        &slots[from..to]
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let lists = [&self.starts, &self.highest, &self.turned, &self.turned_starts];
        let numbers = lists.into_iter().chain(&self.others).map(|list| 4 * list.capacity());
        let places = self.listed_at.iter().map(|list| size_of::<Vec3>() * list.capacity());
        numbers.sum::<usize>() + places.sum::<usize>() + self.grid.bytes()
    }
}
