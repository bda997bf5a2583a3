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
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;
use souple_engine::Curvature;
use souple_math::{Mat3, Padded, Vec3};
use souple_solve::dense::{self, take_absolute};
use souple_solve::{BlockMatrix, Pattern};

use super::elements::{Batch, Elements};
use super::layout::{Chunk, LANES};
use super::parallel;

/// Blocks of the matrix gathered by one task.
const SLOTS_PER_TASK: usize = 4096;
/// Place of a block that the matrix does not store.
const NOWHERE: u16 = u16::MAX;

/// Which blocks an element gives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Symmetry {
    /// `(a, b)` with `a ≤ b`; those below the diagonal are their transposes.
    #[default]
    Symmetric,
    /// All `(a, b)`.
    General,
}

impl Symmetry {
    /// Pairs of an element's nodes in the order of its blocks.
    fn pairs(self, nodes: usize) -> impl Iterator<Item = (usize, usize)> {
        let first = move |a| if self == Self::Symmetric { a } else { 0 };
        (0..nodes).flat_map(move |a| (first(a)..nodes).map(move |b| (a, b)))
    }

    /// Where the block of a pair stands among those of an element; `None` where the transpose of another is it.
    #[inline(always)]
    pub fn place(self, nodes: usize, a: usize, b: usize) -> Option<usize> {
        match self {
            Self::General => Some(a * nodes + b),
            // rows before `a` hold `nodes`, `nodes - 1`, … pairs
            Self::Symmetric => (a <= b).then(|| a * nodes - a * (a + 1) / 2 + b),
        }
    }

    pub fn pair_count(self, nodes: usize) -> usize {
        match self {
            Self::Symmetric => nodes * (nodes + 1) / 2,
            Self::General => nodes * nodes,
        }
    }
}

/// Lists and buffers of both passes, kept between calls.
#[derive(Default)]
pub struct Assembly {
    symmetry: Symmetry,
    pattern: Option<Arc<Pattern>>,
    /// `[block][pair of nodes][lane]` of all chunks: which of its chunk's sums an element block goes to, times two,
    /// plus one if transposed.
    places: Vec<u16>,
    /// Where each chunk's places and sums start, and where they end.
    starts: Vec<Start>,
    /// `(row, column)` of each sum; `row ≤ column` where blocks are symmetric.
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
    /// The element blocks of some blocks of lanes.
    static BLOCKS: RefCell<Vec<f64>> = const { RefCell::new(Vec::new()) };
    /// The matrix of one element.
    static ELEMENT: RefCell<(Vec<f64>, dense::Workspace)> = RefCell::default();
}

impl Assembly {
    pub fn new(symmetry: Symmetry) -> Self {
        Self { symmetry, ..Self::default() }
    }

    /// Adds the elements' blocks to `matrix`: `blocks_of(batch, chunk, blocks, own rows of inputs, out)` writes those of
    /// some blocks of lanes, at most [`Batch::blocks_at_once`], `[block][pair of nodes][entry by columns][lane]`.
    /// `partials` is scratch.
    pub fn add_blocks<K: Send + Sync, const I: usize>(
        &mut self,
        elements: &Elements<K>,
        inputs: [&[Vec3]; I],
        partials: &mut Vec<Vec3>,
        matrix: &mut BlockMatrix,
        blocks_of: impl Fn(&Batch<K>, &Chunk, Range<usize>, [&[Padded]; I], &mut [f64]) + Sync,
    ) {
        let pattern = matrix.pattern();
        if pattern.slot_count() == pattern.block_count() {
            return self.add_diagonal_blocks(elements, inputs, partials, matrix, blocks_of);
        }
        self.update(elements, matrix.pattern());
        let mut sums = std::mem::take(&mut self.sums);
        let start_of = |number: usize| self.starts[number].sum;
        parallel::fill(0..elements.chunk_count(), parallel::HEAVY, &mut sums, &start_of, &|number, sums| {
            let (batch, chunk) = elements.chunk(number);
            let places = &self.places[self.starts[number].place..self.starts[number + 1].place];
            // one block's places
            let block_len = self.symmetry.pair_count(batch.kind.node_count()) * LANES;
            let at_once = batch.blocks_at_once;
            sums.fill(Mat3::ZERO);
            chunk.with_own_rows(inputs, |inputs| {
                BLOCKS.with_borrow_mut(|blocks| {
                    blocks.resize(9 * block_len * at_once, 0.0);
                    for (several, places) in places.chunks(block_len * at_once).enumerate() {
                        let first = several * at_once;
                        let range = first..first + places.len() / block_len;
                        blocks_of(batch, chunk, range, inputs, blocks);
                        add_to_sums(blocks, places, sums);
                    }
                });
            });
        });
        self.sums = sums;
        self.gather(matrix);
    }

    /// [`Self::add_blocks`] of symmetric blocks, exactly or with the negative eigenvalues of every element's matrix turned round:
    /// the sum then has none. Cut off instead (Teran et al. 2005) they would leave directions in which an element pressed flat or
    /// turned inside out is held by its mass alone, and a step goes far beyond it; their size keeps it near (Chen et al.
    /// 2024, Stabler neo-Hookean simulation: absolute eigenvalue filtering for projected Newton). Returns whether any were
    /// turned.
    pub fn add<K: Send + Sync, const I: usize>(
        &mut self,
        curvature: Curvature,
        elements: &Elements<K>,
        inputs: [&[Vec3]; I],
        partials: &mut Vec<Vec3>,
        matrix: &mut BlockMatrix,
        blocks_of: impl Fn(&Batch<K>, &Chunk, Range<usize>, [&[Padded]; I], &mut [f64]) + Sync,
    ) -> bool {
        debug_assert_eq!(self.symmetry, Symmetry::Symmetric);
        if curvature == Curvature::Exact {
            self.add_blocks(elements, inputs, partials, matrix, blocks_of);
            return false;
        }
        let turned = AtomicBool::new(false);
        self.add_blocks(elements, inputs, partials, matrix, |batch, chunk, blocks, inputs, out| {
            blocks_of(batch, chunk, blocks.clone(), inputs, out);
            let nodes = batch.kind.node_count();
            let block_len = 9 * Symmetry::Symmetric.pair_count(nodes) * LANES;
            for (block, numbers) in blocks.zip(out.chunks_exact_mut(block_len)) {
                for lane in 0..chunk.lanes_in(block) {
                    if make_definite(nodes, lane, numbers) {
                        turned.store(true, Ordering::Relaxed);
                    }
                }
            }
        });
        turned.into_inner()
    }

    /// [`Self::add_blocks`] to a matrix of diagonal blocks, column by column: element blocks are computed three times, but
    /// nothing has to be kept where memory is what counts.
    fn add_diagonal_blocks<K: Send + Sync, const I: usize>(
        &self,
        elements: &Elements<K>,
        inputs: [&[Vec3]; I],
        partials: &mut Vec<Vec3>,
        matrix: &mut BlockMatrix,
        blocks_of: impl Fn(&Batch<K>, &Chunk, Range<usize>, [&[Padded]; I], &mut [f64]) + Sync,
    ) {
        for column in 0..3 {
            elements.fill_partials(inputs, partials, |batch, chunk, inputs, sums| {
                let nodes = batch.kind.node_count();
                let (block_len, at_once) = (self.symmetry.pair_count(nodes) * LANES, batch.blocks_at_once);
                BLOCKS.with_borrow_mut(|blocks| {
                    blocks.resize(9 * block_len * at_once, 0.0);
                    for first in (0..chunk.block_count()).step_by(at_once) {
                        let range = first..chunk.block_count().min(first + at_once);
                        blocks_of(batch, chunk, range.clone(), inputs, blocks);
                        for (block, numbers) in range.zip(blocks.chunks_exact(9 * block_len)) {
                            self.add_own_column(chunk, block, nodes, column, numbers, sums);
                        }
                    }
                });
            });
            let blocks = &mut matrix.values_mut()[elements.rows()];
            elements.gather_partials(partials, blocks, |block, sum| block.columns[column] += sum);
        }
    }

    /// Adds one column of the diagonal blocks of a block of lanes to the sums on its nodes.
    fn add_own_column(
        &self,
        chunk: &Chunk,
        block: usize,
        nodes: usize,
        column: usize,
        numbers: &[f64],
        sums: &mut [Padded],
    ) {
        for (pair, (a, _)) in self.symmetry.pairs(nodes).enumerate().filter(|(_, (a, b))| a == b) {
            let locals = &chunk.connectivity[(block * nodes + a) * LANES..][..LANES];
            let number = |i: usize, lane: usize| numbers[(pair * 9 + 3 * column + i) * LANES + lane];
            for (lane, local) in locals[..chunk.lanes_in(block)].iter().enumerate() {
                let sum = &mut sums[*local as usize];
                *sum =
                    (Vec3::from(*sum) + Vec3::new(number(0, lane), number(1, lane), number(2, lane))).into();
            }
        }
    }

    /// Bytes of lists and sums.
    pub fn bytes(&self) -> usize {
        2 * self.places.capacity()
            + size_of::<Start>() * self.starts.capacity()
            + 8 * self.entries.capacity()
            + size_of::<Mat3>() * self.sums.capacity()
            + 4 * (self.source_starts.capacity() + self.sources.capacity())
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

    fn update<K: Send + Sync>(&mut self, elements: &Elements<K>, pattern: &Arc<Pattern>) {
        if self.pattern.as_ref().is_some_and(|known| Arc::ptr_eq(known, pattern)) {
            return;
        }
        if self.pattern.is_none() {
            self.number_sums(elements);
        }
        self.list_sources(&elements.rows(), pattern);
        self.pattern = Some(Arc::clone(pattern));
    }

    /// Numbers the pairs of nodes that occur in each chunk.
    fn number_sums<K: Send + Sync>(&mut self, elements: &Elements<K>) {
        let symmetry = self.symmetry;
        let mut known: Vec<(u16, u16)> = Vec::new();
        let mut ordered: Vec<Option<((u16, u16), bool)>> = Vec::new();
        for (batch, chunk) in elements.chunks() {
            self.starts.push(Start { place: self.places.len(), sum: self.entries.len() });
            let nodes = batch.kind.node_count();
            ordered.clear();
            for block in 0..chunk.block_count() {
                let local = |a: usize, lane: usize| chunk.connectivity[(block * nodes + a) * LANES + lane];
                for (a, b) in symmetry.pairs(nodes) {
                    for lane in 0..LANES {
                        let is_summed = lane < chunk.lanes_in(block);
                        // rows of a chunk ascend, so its own numbers stand for them
                        let (i, j) = (local(a, lane), local(b, lane));
                        let is_transposed = symmetry == Symmetry::Symmetric && i > j;
                        let pair = if is_transposed { (j, i) } else { (i, j) };
                        ordered.push(is_summed.then_some((pair, is_transposed)));
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
        let symmetry = self.symmetry;
        let slots_of = |&(row, column): &(u32, u32)| {
            let slot = |a: u32, b: u32| pattern.slot(a as usize, b as usize).map(|slot| slot - first);
            let upper = slot(row, column).map(|slot| (slot, 0));
            let is_alone = row == column || symmetry == Symmetry::General;
            let lower = if is_alone { None } else { slot(column, row).map(|slot| (slot, 1)) };
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

/// Turns round the negative eigenvalues of the matrix of the element in a lane of a block of lanes; whether it had any.
fn make_definite(nodes: usize, lane: usize, numbers: &mut [f64]) -> bool {
    let n = 3 * nodes;
    ELEMENT.with_borrow_mut(|(a, workspace)| {
        a.resize(n * n, 0.0);
        let entries = |(pair, (p, q)): (usize, (usize, usize))| {
            (0..9).map(move |entry| {
                let (row, column) = (3 * p + entry % 3, 3 * q + entry / 3);
                ((pair * 9 + entry) * LANES + lane, n * row + column, n * column + row)
            })
        };
        let pairs = || Symmetry::Symmetric.pairs(nodes).enumerate();
        for (place, upper, lower) in pairs().flat_map(entries) {
            (a[upper], a[lower]) = (numbers[place], numbers[place]);
        }
        let turned = take_absolute(n, a, workspace);
        if turned {
            for (place, upper, _) in pairs().flat_map(entries) {
                numbers[place] = a[upper];
            }
        }
        turned
    })
}

/// Adds the element blocks of some blocks of lanes to the sums of its chunk.
fn add_to_sums(blocks: &[f64], places: &[u16], sums: &mut [Mat3]) {
    for (numbers, places) in blocks.chunks_exact(9 * LANES).zip(places.chunks_exact(LANES)) {
        for (lane, &place) in places.iter().enumerate() {
            if place == NOWHERE {
                continue;
            }
            let number = |i: usize| numbers[i * LANES + lane];
            let column = |i: usize| Vec3::new(number(3 * i), number(3 * i + 1), number(3 * i + 2));
            let row = |i: usize| Vec3::new(number(i), number(i + 3), number(i + 6));
            sums[(place >> 1) as usize] += if place & 1 == 0 {
                Mat3::from_columns(column(0), column(1), column(2))
            } else {
                Mat3::from_columns(row(0), row(1), row(2))
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Blocks are found where they are listed.
    #[test]
    fn pairs_have_places() {
        for symmetry in [Symmetry::Symmetric, Symmetry::General] {
            for nodes in [2, 4, 8] {
                let places: Vec<_> =
                    symmetry.pairs(nodes).map(|(a, b)| symmetry.place(nodes, a, b)).collect();
                let expected: Vec<_> = (0..symmetry.pair_count(nodes)).map(Some).collect();
                assert_eq!(places, expected, "{symmetry:?} {nodes}");
            }
        }
        assert_eq!(Symmetry::Symmetric.place(4, 2, 1), None);
    }
}
