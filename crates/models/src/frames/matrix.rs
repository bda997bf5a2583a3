//! From sums over pairs of frames in chunks to the blocks of a matrix over rows.
//!
//! Sums of a pair are those of the chunks that know it, in chunk order; blocks below the diagonal are the
//! transposes of those above, so the matrix is symmetric to the last bit.

use std::sync::Arc;

use souple_math::{Mat3, Vec3};
use souple_solve::{BlockMatrix, Pattern};

use super::ROWS_OF_FRAME;
use super::kernel::{LINE, PAIR_LEN};
use super::layout::Chunk;

/// Blocks between the rows of two frames.
const BLOCKS: usize = ROWS_OF_FRAME * ROWS_OF_FRAME;
/// A block that the matrix does not store.
const NOWHERE: u32 = u32::MAX;

/// The pairs of frames of all chunks.
pub struct Pairs {
    /// Frames `i ≤ j`, each pair once.
    pub frames: Vec<[u32; 2]>,
    /// Of each pair of each chunk, one chunk after the other: which of `frames` it is.
    pair_of: Vec<u32>,
}

impl Pairs {
    pub fn new(chunks: &[Chunk]) -> Self {
        let mut all = Vec::new();
        for chunk in chunks {
            all.extend(chunk.pairs.iter().map(|pair| pair.map(|own| chunk.frames[own as usize])));
        }
        let mut frames: Vec<[u32; 2]> = all.clone();
        frames.sort_unstable();
        frames.dedup();
        let pair = |pair: &[u32; 2]| frames.partition_point(|known| known < pair) as u32;
        let pair_of = all.iter().map(pair).collect();
        Self { frames, pair_of }
    }

    /// Adds the parts of chunks, of which the first pair is number `first` of those of all chunks, to the sums of pairs.
    pub fn add_parts(&self, first: usize, parts: &[f64], sums: &mut [f64]) {
        for (pair, part) in self.pair_of[first..].iter().zip(parts.chunks_exact(PAIR_LEN)) {
            let sum = &mut sums[*pair as usize * PAIR_LEN..][..PAIR_LEN];
            sum.iter_mut().zip(part).for_each(|(sum, part)| *sum += part);
        }
    }

    pub fn bytes(&self) -> usize {
        8 * self.frames.len() + 4 * self.pair_of.len()
    }
}

/// Where the blocks of each pair stand in a matrix.
#[derive(Default)]
pub struct Slots {
    pattern: Option<Arc<Pattern>>,
    /// Of each pair: `(a, b)`, row by row, then `(b, a)` in the same order.
    slots: Vec<[u32; 2 * BLOCKS]>,
}

impl Slots {
    /// Adds the sums of all pairs to the matrix.
    pub fn scatter(&mut self, pairs: &Pairs, row_of_frame: &[u32], sums: &[f64], matrix: &mut BlockMatrix) {
        self.update(pairs, row_of_frame, matrix.pattern());
        let values = matrix.values_mut();
        for (pair, slots) in self.slots.iter().enumerate() {
            let sum = &sums[pair * PAIR_LEN..][..PAIR_LEN];
            let is_own = pairs.frames[pair][0] == pairs.frames[pair][1];
            for a in 0..ROWS_OF_FRAME {
                // a frame with itself is symmetric: its lower half would only repeat, with other rounding
                for b in if is_own { a } else { 0 }..ROWS_OF_FRAME {
                    let column = |k: usize| {
                        let entry = |i: usize| sum[(3 * a + i) * LINE + 3 * b + k];
                        Vec3::new(entry(0), entry(1), entry(2))
                    };
                    let block = Mat3::from_columns(column(0), column(1), column(2));
                    let (upper, lower) =
                        (slots[ROWS_OF_FRAME * a + b], slots[BLOCKS + ROWS_OF_FRAME * a + b]);
                    if is_own && a == b {
                        add(values, upper, &block.symmetric_part());
                    } else {
                        add(values, upper, &block);
                        add(values, lower, &block.transpose());
                    }
                }
            }
        }
    }

    fn update(&mut self, pairs: &Pairs, row_of_frame: &[u32], pattern: &Arc<Pattern>) {
        if self.pattern.as_ref().is_some_and(|known| Arc::ptr_eq(known, pattern)) {
            return;
        }
        let slot = |a: u32, b: u32| pattern.slot(a as usize, b as usize).map_or(NOWHERE, |slot| slot as u32);
        self.slots.clear();
        self.slots.extend(pairs.frames.iter().map(|frames| {
            let [i, j] = frames.map(|frame| row_of_frame[frame as usize]);
            std::array::from_fn(|at| {
                let (a, b) = (at % BLOCKS / ROWS_OF_FRAME, at % ROWS_OF_FRAME);
                let (row, column) = (i + a as u32, j + b as u32);
                if at < BLOCKS { slot(row, column) } else { slot(column, row) }
            })
        }));
        self.pattern = Some(Arc::clone(pattern));
    }

    pub fn bytes(&self) -> usize {
        size_of::<[u32; 2 * BLOCKS]>() * self.slots.capacity()
    }
}

fn add(values: &mut [Mat3], slot: u32, block: &Mat3) {
    if slot != NOWHERE {
        values[slot as usize] += *block;
    }
}
