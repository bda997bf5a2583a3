//! The stiffness matrix of a solid, summed in two passes that any number of threads may share.
//!
//! First every chunk sums the blocks of its elements on its own pairs of nodes, in element order; then every block
//! of the matrix gathers the sums of the chunks that know its pair, in chunk order. Neither order depends on who
//! computes, so neither do the bits. Chunk sums are a fifth of the element blocks they are made of and stay in cache
//! while they grow; blocks below the diagonal are the transposes of those above, so the matrix is symmetric to the
//! last bit.

use std::cell::RefCell;
use std::ops::Range;
use std::sync::Arc;

use rayon::prelude::*;
use souple_math::{Mat3, Vec3};
use souple_solve::{BlockMatrix, Pattern};

use super::Batch;
use super::kernel::BLOCK_LEN_MAX;
use super::layout::{Chunk, LANES};

/// Chunks below which threads cost more than they bring.
const PARALLEL_CHUNKS: usize = 4;
/// Blocks of the matrix gathered by one task.
const SLOTS_PER_TASK: usize = 4096;
/// Place of a block that the matrix does not store.
const NOWHERE: u16 = u16::MAX;

/// Which pairs of nodes are summed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Pairs {
    All,
    /// For a matrix of diagonal blocks.
    Equal,
}

/// Lists and buffers of both passes, kept between calls.
#[derive(Default)]
pub struct Assembly {
    pairs: Option<Pairs>,
    pattern: Option<Arc<Pattern>>,
    /// `[block][pair of nodes][lane]` of all chunks: which of its chunk's sums an element block goes to, times two,
    /// plus one if transposed.
    places: Vec<u16>,
    /// Where each chunk's places and sums start, and where they end.
    starts: Vec<Start>,
    /// `(row, column)` of each sum, `row ≤ column`.
    entries: Vec<(u32, u32)>,
    sums: Vec<Mat3>,
    /// Slots of the body's rows, and for each of them `sources[source_starts[i] .. source_starts[i + 1]]`: a sum
    /// times two, plus one if transposed.
    slots: Range<usize>,
    source_starts: Vec<u32>,
    sources: Vec<u32>,
}

#[derive(Clone, Copy, Default)]
struct Start {
    place: usize,
    sum: usize,
}

thread_local! {
    /// A chunk's own rows and the element blocks of one block of lanes.
    static LOCAL: RefCell<(Vec<Vec3>, Vec<f64>)> = const { RefCell::new((Vec::new(), Vec::new())) };
}

impl Assembly {
    /// `matrix += scale ∂f/∂x` at `positions` for all chunks of a body of the rows `rows`.
    pub fn add_blocks(
        &mut self,
        batches: &[Batch],
        rows: &Range<usize>,
        positions: &[Vec3],
        scale: f64,
        matrix: &mut BlockMatrix,
    ) {
        self.update(batches, rows, matrix.pattern());
        let mut sums = std::mem::take(&mut self.sums);
        let (mut remaining, mut first) = (sums.as_mut_slice(), 0);
        for batch in batches {
            let chunks = first..first + batch.chunks.len();
            let (mine, rest) = remaining.split_at_mut(self.starts[chunks.end].sum - self.starts[first].sum);
            BatchSums { assembly: self, batch, first, positions, scale }.fill(chunks.clone(), mine);
            (remaining, first) = (rest, chunks.end);
        }
        self.sums = sums;
        self.gather(matrix);
    }

    fn gather(&self, matrix: &mut BlockMatrix) {
        let gather_slots = |(task, blocks): (usize, &mut [Mat3])| {
            let first = task * SLOTS_PER_TASK;
            for (starts, block) in self.source_starts[first..].windows(2).zip(blocks) {
                let mut sum = *block;
                for source in &self.sources[starts[0] as usize..starts[1] as usize] {
                    let part = &self.sums[(source >> 1) as usize];
                    sum += if source & 1 == 0 { *part } else { part.transpose() };
                }
                *block = sum;
            }
        };
        let blocks = &mut matrix.values_mut()[self.slots.clone()];
        if blocks.len() >= 2 * SLOTS_PER_TASK && rayon::current_num_threads() > 1 {
            blocks.par_chunks_mut(SLOTS_PER_TASK).enumerate().for_each(gather_slots);
        } else {
            blocks.chunks_mut(SLOTS_PER_TASK).enumerate().for_each(gather_slots);
        }
    }

    fn update(&mut self, batches: &[Batch], rows: &Range<usize>, pattern: &Arc<Pattern>) {
        if self.pattern.as_ref().is_some_and(|known| Arc::ptr_eq(known, pattern)) {
            return;
        }
        let is_diagonal = pattern.slot_count() == pattern.block_count();
        let pairs = if is_diagonal { Pairs::Equal } else { Pairs::All };
        if self.pairs != Some(pairs) {
            self.number_sums(batches, pairs);
        }
        self.list_sources(rows, pattern);
        self.pattern = Some(Arc::clone(pattern));
    }

    /// Numbers the pairs of nodes that occur in each chunk.
    fn number_sums(&mut self, batches: &[Batch], pairs: Pairs) {
        *self = Self { pairs: Some(pairs), ..Self::default() };
        let mut known: Vec<(u16, u16)> = Vec::new();
        let mut ordered: Vec<Option<((u16, u16), bool)>> = Vec::new();
        for (batch, chunk) in
            batches.iter().flat_map(|batch| batch.chunks.iter().map(move |chunk| (batch, chunk)))
        {
            self.starts.push(Start { place: self.places.len(), sum: self.entries.len() });
            let nodes = batch.kind.node_count();
            ordered.clear();
            for block in 0..chunk.block_count() {
                let local = |a: usize, lane: usize| chunk.connectivity[(block * nodes + a) * LANES + lane];
                for (a, b) in (0..nodes).flat_map(|a| (a..nodes).map(move |b| (a, b))) {
                    for lane in 0..LANES {
                        let is_summed = lane < chunk.lanes_in(block) && (a == b || pairs == Pairs::All);
                        // rows of a chunk ascend, so its own numbers stand for them
                        let (i, j) = (local(a, lane), local(b, lane));
                        ordered.push(is_summed.then(|| ((i.min(j), i.max(j)), i > j)));
                    }
                }
            }
            known.clear();
            known.extend(ordered.iter().flatten().map(|(pair, _)| *pair));
            known.sort_unstable();
            known.dedup();
            let place = |&(pair, transposed): &((u16, u16), bool)| {
                let at = known.binary_search(&pair).unwrap_or_else(|_| unreachable!("collected above"));
                2 * at as u16 + u16::from(transposed)
            };
            self.places.extend(ordered.iter().map(|entry| entry.as_ref().map_or(NOWHERE, place)));
            let row = |local: u16| chunk.rows[local as usize];
            self.entries.extend(known.iter().map(|&(i, j)| (row(i), row(j))));
        }
        self.starts.push(Start { place: self.places.len(), sum: self.entries.len() });
        self.sums = vec![Mat3::ZERO; self.entries.len()];
    }

    /// Lists for each slot of the body's rows the sums it gathers, in chunk order.
    fn list_sources(&mut self, rows: &Range<usize>, pattern: &Pattern) {
        self.slots = pattern.row_starts()[rows.start] as usize..pattern.row_starts()[rows.end] as usize;
        let first = self.slots.start;
        let slots_of = |&(row, column): &(u32, u32)| {
            let slot = |a: u32, b: u32| pattern.slot(a as usize, b as usize).map(|slot| slot - first);
            let upper = slot(row, column).map(|slot| (slot, 0));
            let lower = if row == column { None } else { slot(column, row).map(|slot| (slot, 1)) };
            [upper, lower].into_iter().flatten()
        };
        self.source_starts.clear();
        self.source_starts.resize(self.slots.len() + 1, 0);
        for (slot, _) in self.entries.iter().flat_map(slots_of) {
            self.source_starts[slot + 1] += 1;
        }
        for slot in 0..self.slots.len() {
            self.source_starts[slot + 1] += self.source_starts[slot];
        }
        self.sources.clear();
        self.sources.resize(self.source_starts[self.slots.len()] as usize, 0);
        for (sum, entry) in self.entries.iter().enumerate() {
            for (slot, transposed) in slots_of(entry) {
                let next = &mut self.source_starts[slot];
                self.sources[*next as usize] = 2 * sum as u32 + transposed;
                *next += 1;
            }
        }
        // each start has moved to where the next one began
        self.source_starts.rotate_right(1);
        self.source_starts[0] = 0;
    }
}

/// The sums of one batch, whose chunks are numbered from `first`.
#[derive(Clone, Copy)]
struct BatchSums<'a> {
    assembly: &'a Assembly,
    batch: &'a Batch,
    first: usize,
    positions: &'a [Vec3],
    scale: f64,
}

impl BatchSums<'_> {
    /// Fills the sums of some chunks, halving the work among threads.
    fn fill(self, chunks: Range<usize>, sums: &mut [Mat3]) {
        let starts = &self.assembly.starts;
        if chunks.len() >= PARALLEL_CHUNKS && rayon::current_num_threads() > 1 {
            let middle = chunks.start + chunks.len() / 2;
            let (head, tail) = sums.split_at_mut(starts[middle].sum - starts[chunks.start].sum);
            rayon::join(|| self.fill(chunks.start..middle, head), || self.fill(middle..chunks.end, tail));
            return;
        }
        let mut remaining = sums;
        for number in chunks {
            let (mine, rest) = remaining.split_at_mut(starts[number + 1].sum - starts[number].sum);
            remaining = rest;
            let places = &self.assembly.places[starts[number].place..starts[number + 1].place];
            self.fill_chunk(&self.batch.chunks[number - self.first], places, mine);
        }
    }

    fn fill_chunk(self, chunk: &Chunk, places: &[u16], sums: &mut [Mat3]) {
        let Self { batch, scale, .. } = self;
        let nodes = batch.kind.node_count();
        let block_len = nodes * (nodes + 1) / 2 * LANES;
        sums.fill(Mat3::ZERO);
        LOCAL.with_borrow_mut(|(positions, blocks)| {
            chunk.localise(self.positions, positions);
            blocks.resize(BLOCK_LEN_MAX, 0.0);
            for (block, places) in places.chunks_exact(block_len).enumerate() {
                batch.kernel.blocks(chunk, block, &batch.reference, positions, scale, blocks);
                for (numbers, places) in blocks.chunks_exact(9 * LANES).zip(places.chunks_exact(LANES)) {
                    for (lane, &place) in places.iter().enumerate() {
                        if place == NOWHERE {
                            continue;
                        }
                        let number = |i: usize| numbers[i * LANES + lane];
                        let column =
                            |i: usize| Vec3::new(number(3 * i), number(3 * i + 1), number(3 * i + 2));
                        let row = |i: usize| Vec3::new(number(i), number(i + 3), number(i + 6));
                        sums[(place >> 1) as usize] += if place & 1 == 0 {
                            Mat3::from_columns(column(0), column(1), column(2))
                        } else {
                            Mat3::from_columns(row(0), row(1), row(2))
                        };
                    }
                }
            }
        });
    }
}
