//! How links lie in memory, and in what order their forces are summed.
//!
//! Rows are cut into stretches. Links within a stretch add to its rows as they come; links across stretches put their
//! forces into a buffer, from which each stretch then takes its own in order. Neither order depends on the number of
//! threads. Within a part, links follow their lower ends, so that a regular network is read once from end to end. Where a
//! link is a few numbers only, more is gained by straight blocks: eight links that join eight rows in order to eight others
//! in order, as those of a string or of a sheet do, are read and summed without looking up a row.

use std::ops::{AddAssign, Range, SubAssign};

use souple_math::Vec3;

use crate::solids::parallel;

/// Links side by side in a block.
pub const LANES: usize = 8;
/// Rows of a stretch: few links of a lattice cross, and some stretches for each thread remain.
const ROWS_PER_STRETCH: usize = 16384;
/// Blocks that are filled lane after lane: neighbouring links, which share masses, stand in different blocks, so that sums
/// on a mass do not wait for each other. Few, so that memory is still read nearly in order.
const BLOCKS_PER_TILE: usize = 8;
/// Links across stretches that one task computes.
const CROSSING_PER_PART: usize = 512;
/// A part of a stretch is worth a thread of its own.
const GRAIN: usize = 2;

/// In which order links of a stretch stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arrangement {
    /// All spread over the lanes of a tile.
    Spread,
    /// Those first that fill straight blocks.
    Straight,
}

/// Two ends of a link, rows of the system.
pub type Ends = [u32; 2];

/// Links that are computed by one thread.
#[derive(Clone, Debug)]
pub struct Part {
    /// Numbers of its links, slot by slot.
    pub links: Vec<u32>,
    /// Row that ends are counted from.
    pub first_row: usize,
    /// `(block, end, lane)`; lanes without a link join the first row to itself.
    ends: Vec<u32>,
    /// Rest length of `(block, lane)` [m].
    rest: Vec<f64>,
    /// Blocks of the parts before it.
    pub first_block: usize,
    /// Rows that it reads, counted from `first_row`.
    row_count: usize,
    /// Blocks, from the first on, whose links join rows in order to rows in order.
    straight_blocks: usize,
}

/// All links of a law.
#[derive(Clone, Debug)]
pub struct Layout {
    /// One for each stretch, then those across.
    pub parts: Vec<Part>,
    /// First row of each stretch, and the end of the last.
    stretches: Vec<usize>,
    /// `takes[take_starts[s] .. take_starts[s + 1]]`: what stretch `s` takes of the forces across.
    takes: Vec<Take>,
    take_starts: Vec<u32>,
}

/// A force across stretches and the row it acts on.
#[derive(Clone, Copy, Debug)]
struct Take {
    /// Slot of the buffer, times two, plus one where it is the second end.
    slot: u32,
    /// Counted from the first of the stretch.
    row: u32,
}

impl Part {
    fn new(
        (mut links, arrangement): (Vec<u32>, Arrangement),
        all: &[Ends],
        rest: &[f64],
        rows: Range<usize>,
        first_block: usize,
    ) -> Self {
        let straight_blocks = match arrangement {
            Arrangement::Spread => 0,
            Arrangement::Straight => straighten(&mut links, all),
        };
        let blocks = links.len().div_ceil(LANES);
        let mut part = Self {
            ends: vec![0; 2 * LANES * blocks],
            rest: vec![0.0; LANES * blocks],
            first_row: rows.start,
            first_block,
            row_count: rows.len(),
            straight_blocks,
            links,
        };
        for (slot, link) in part.links.iter().enumerate() {
            let (block, lane) = part.place(slot);
            for (end, row) in all[*link as usize].iter().enumerate() {
                part.ends[(2 * block + end) * LANES + lane] = row - rows.start as u32;
            }
            part.rest[block * LANES + lane] = rest[*link as usize];
        }
        assert!(part.ends.iter().all(|end| (*end as usize) < part.row_count), "ends are rows of the part");
        part
    }

    pub fn block_count(&self) -> usize {
        self.links.len().div_ceil(LANES)
    }

    /// Blocks, from the first on, that have a link in every lane.
    #[inline(always)]
    pub fn full_blocks(&self) -> usize {
        let blocks = self.block_count() - self.straight_blocks;
        let links = self.links.len() - LANES * self.straight_blocks;
        let tile = BLOCKS_PER_TILE * (blocks.saturating_sub(1) / BLOCKS_PER_TILE);
        // in the last tile lanes are filled one after the other
        let in_last_lane = (links - LANES * tile).saturating_sub((LANES - 1) * (blocks - tile));
        self.straight_blocks + tile + in_last_lane
    }

    /// Blocks, from the first on, in which link `lane` joins rows `a + lane` and `b + lane` for the `a` and `b` of the first.
    #[inline(always)]
    pub fn straight_blocks(&self) -> usize {
        self.straight_blocks
    }

    /// Rows that the part reads.
    pub fn row_count(&self) -> usize {
        self.row_count
    }

    /// Block and lane of the part's `slot`-th link.
    pub fn place(&self, slot: usize) -> (usize, usize) {
        if slot < LANES * self.straight_blocks {
            return (slot / LANES, slot % LANES);
        }
        let slot = slot - LANES * self.straight_blocks;
        let (tile, inside) = (slot / (BLOCKS_PER_TILE * LANES), slot % (BLOCKS_PER_TILE * LANES));
        let first = self.straight_blocks + BLOCKS_PER_TILE * tile;
        let blocks = (self.block_count() - first).min(BLOCKS_PER_TILE);
        (first + inside % blocks, inside / blocks)
    }

    /// Rows of the ends of the part's `slot`-th link.
    pub fn ends_of(&self, slot: usize) -> Ends {
        self.places_of(slot).map(|place| (place + self.first_row) as u32)
    }

    /// The same, counted from the first row of the part.
    pub fn places_of(&self, slot: usize) -> [usize; 2] {
        let (block, lane) = self.place(slot);
        [0, 1].map(|end| self.ends[(2 * block + end) * LANES + lane] as usize)
    }

    /// Ends of a block's links, `[end][lane]`: below the length of what [`Self::rows_of`] gives.
    #[inline(always)]
    pub fn ends(&self, block: usize) -> &[u32] {
        &self.ends[2 * block * LANES..2 * (block + 1) * LANES]
    }

    /// Rest lengths of a block's links [m].
    #[inline(always)]
    pub fn rest(&self, block: usize) -> &[f64] {
        &self.rest[block * LANES..(block + 1) * LANES]
    }

    /// The rows that the part reads.
    pub fn rows_of<'v>(&self, values: &'v [Vec3]) -> &'v [Vec3] {
        &values[self.first_row..self.first_row + self.row_count]
    }
}

/// Puts those links first that fill straight blocks, and gives the number of these.
fn straighten(links: &mut Vec<u32>, all: &[Ends]) -> usize {
    // equal for links whose ends are equally far apart; of such the next one starts a row further on
    let key = |link: u32| {
        let [a, b] = all[link as usize];
        (i64::from(b) - i64::from(a), a)
    };
    links.sort_by_key(|link| key(*link));
    let (mut straight, mut others) = (Vec::with_capacity(links.len()), Vec::new());
    let follows = |pair: &[u32]| {
        let [(apart, a), (next_apart, next)] = [key(pair[0]), key(pair[1])];
        apart == next_apart && next == a + 1
    };
    for run in links.chunk_by(|a, b| follows(&[*a, *b])) {
        let (whole, rest) = run.split_at(run.len() - run.len() % LANES);
        straight.extend_from_slice(whole);
        others.extend_from_slice(rest);
    }
    let blocks = straight.len() / LANES;
    // as in parts without straight blocks
    let lower_end = |link: &u32| {
        let [a, b] = all[*link as usize];
        (a.min(b), a.max(b), *link)
    };
    others.sort_unstable_by_key(lower_end);
    straight.append(&mut others);
    *links = straight;
    blocks
}

impl Layout {
    pub fn new(ends: &[Ends], rest: &[f64], arrangement: Arrangement) -> Self {
        let all = || ends.iter().flatten().map(|row| *row as usize);
        let rows = all().min().unwrap_or(0)..all().max().map_or(0, |last| last + 1);
        let stretches: Vec<usize> = rows.clone().step_by(ROWS_PER_STRETCH).chain([rows.end]).collect();
        let stretch = |row: u32| (row as usize - rows.start) / ROWS_PER_STRETCH;
        let mut order: Vec<u32> = (0..ends.len() as u32).collect();
        let key = |link: &u32| {
            let [a, b] = ends[*link as usize];
            (a.min(b), a.max(b), *link)
        };
        order.sort_unstable_by_key(key);
        let (mut within, mut across) = (vec![Vec::new(); stretches.len() - 1], Vec::new());
        for link in order {
            let [a, b] = ends[link as usize].map(stretch);
            if a == b { &mut within[a] } else { &mut across }.push(link);
        }
        let mut layout = Self { parts: Vec::new(), stretches, takes: Vec::new(), take_starts: Vec::new() };
        for (index, links) in within.into_iter().enumerate() {
            let rows = layout.stretches[index]..layout.stretches[index + 1];
            layout.push((links, arrangement), ends, rest, rows);
        }
        for links in across.chunks(CROSSING_PER_PART) {
            layout.push((links.to_vec(), Arrangement::Spread), ends, rest, rows.clone());
        }
        layout.list_takes();
        layout
    }

    fn push(&mut self, links: (Vec<u32>, Arrangement), ends: &[Ends], rest: &[f64], rows: Range<usize>) {
        let first_block = self.block_count();
        self.parts.push(Part::new(links, ends, rest, rows, first_block));
    }

    fn stretch_count(&self) -> usize {
        self.stretches.len() - 1
    }

    fn list_takes(&mut self) {
        let first = self.stretches[0];
        let mut lists = vec![Vec::new(); self.stretch_count()];
        let across = self.parts.get(self.stretch_count()..).unwrap_or_default();
        let first_block = across.first().map_or(0, |part| part.first_block);
        for part in across {
            for slot in 0..part.links.len() {
                let (block, lane) = part.place(slot);
                let place = ((part.first_block - first_block + block) * LANES + lane) as u32;
                for (end, row) in part.ends_of(slot).into_iter().enumerate() {
                    let stretch = (row as usize - first) / ROWS_PER_STRETCH;
                    let row = row - self.stretches[stretch] as u32;
                    lists[stretch].push(Take { slot: 2 * place + end as u32, row });
                }
            }
        }
        self.take_starts = vec![0];
        for list in lists {
            self.takes.extend(list);
            self.take_starts.push(self.takes.len() as u32);
        }
    }

    /// Blocks of all parts.
    pub fn block_count(&self) -> usize {
        self.parts.last().map_or(0, |part| part.first_block + part.block_count())
    }

    /// Rows from the first to the last that links join.
    pub fn rows(&self) -> Range<usize> {
        self.stretches[0]..self.stretches[self.stretch_count()]
    }

    /// Runs `work(rows, their own)` on the rows of each stretch.
    pub fn for_each_stretch<T: Send>(&self, own: &mut [T], work: impl Fn(Range<usize>, &mut [T]) + Sync) {
        let start_of = |number: usize| self.stretches[number] - self.stretches[0];
        parallel::fill(0..self.stretch_count(), GRAIN, own, &start_of, &|number, own| {
            work(self.stretches[number]..self.stretches[number + 1], own);
        });
    }

    /// Sums loads of links on [`Layout::rows`]: `within(number, part, sums on its rows)` adds those of a stretch,
    /// `across(number, part, loads on first ends)` writes those of links across, `[block][lane]`; `buffer` is scratch.
    pub fn add_sums<T>(
        &self,
        buffer: &mut Vec<T>,
        out: &mut [T],
        within: impl Fn(usize, &Part, &mut [T]) + Sync,
        across: impl Fn(usize, &Part, &mut [T]) + Sync,
    ) where
        T: Copy + Default + AddAssign + SubAssign + Send + Sync,
    {
        let stretches = self.stretch_count();
        let block =
            |number: usize| self.parts.get(number).map_or(self.block_count(), |part| part.first_block);
        let start_of = |number: usize| LANES * (block(number) - block(stretches));
        buffer.resize(start_of(self.parts.len()), T::default());
        parallel::fill(stretches..self.parts.len(), parallel::LIGHT, buffer, &start_of, &|number, loads| {
            across(number, &self.parts[number], loads);
        });
        let buffer = &*buffer;
        let start_of = |number: usize| self.stretches[number] - self.stretches[0];
        parallel::fill(0..stretches, GRAIN, out, &start_of, &|number, sums| {
            within(number, &self.parts[number], sums);
            let takes = self.take_starts[number] as usize..self.take_starts[number + 1] as usize;
            for Take { slot, row } in &self.takes[takes] {
                let (load, sum) = (buffer[(slot >> 1) as usize], &mut sums[*row as usize]);
                if slot & 1 == 0 {
                    *sum += load;
                } else {
                    *sum -= load;
                }
            }
        });
    }

    /// Where a part's memory stands that keeps one number of its own and `len` for each link, `[block][number][lane]`.
    pub fn memory_range(&self, number: usize, len: usize) -> Range<usize> {
        let start = |number: usize| {
            let blocks = self.parts.get(number).map_or(self.block_count(), |part| part.first_block);
            number + LANES * len * blocks
        };
        start(number)..start((number + 1).min(self.parts.len()))
    }

    /// Runs `work` on every part with its memory.
    pub fn advance(&self, len: usize, memory: &mut [f64], work: impl Fn(&Part, &mut [f64]) + Sync) {
        let start_of = |number: usize| self.memory_range(number, len).start;
        parallel::fill(0..self.parts.len(), GRAIN, memory, &start_of, &|number, own| {
            work(&self.parts[number], own);
        });
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let part = |part: &Part| {
            size_of::<Part>() + 4 * (part.links.capacity() + part.ends.capacity()) + 8 * part.rest.capacity()
        };
        self.parts.iter().map(part).sum::<usize>() + size_of::<Take>() * self.takes.capacity()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every link has a place of its own with its own ends, links in order fill straight blocks, and lanes that are called full
    /// are.
    #[test]
    fn links_have_places_however_they_are_arranged() {
        // a string with second neighbours, some links turned round, and a few across
        let mut ends: Vec<Ends> = (0..40).map(|i| [i, i + 1]).chain((0..21).map(|i| [i + 2, i])).collect();
        ends.extend([[5, 30], [17, 3], [40, 0]]);
        let rest: Vec<f64> = (0..ends.len()).map(|i| i as f64).collect();
        for (arrangement, straight) in [(Arrangement::Spread, 0), (Arrangement::Straight, 5 + 2)] {
            let layout = Layout::new(&ends, &rest, arrangement);
            let part = &layout.parts[0];
            assert_eq!(part.straight_blocks(), straight);
            let mut is_taken = vec![false; LANES * part.block_count()];
            for (slot, link) in part.links.iter().enumerate() {
                let (block, lane) = part.place(slot);
                assert!(!std::mem::replace(&mut is_taken[block * LANES + lane], true), "two links in a lane");
                assert_eq!(part.ends_of(slot), ends[*link as usize]);
                assert_eq!(part.rest(block)[lane], f64::from(*link));
            }
            assert_eq!(part.links.len(), ends.len());
            for block in 0..part.straight_blocks() {
                let joined = part.ends(block);
                for lane in 1..LANES as u32 {
                    assert_eq!(joined[lane as usize], joined[0] + lane);
                    assert_eq!(joined[LANES + lane as usize], joined[LANES] + lane);
                }
            }
            let full = (0..part.block_count())
                .take_while(|block| is_taken[block * LANES..(block + 1) * LANES].iter().all(|taken| *taken));
            assert_eq!(full.count(), part.full_blocks());
        }
    }
}
