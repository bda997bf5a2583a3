//! How samples of frames lie in memory: chunks of neighbouring samples, eight side by side, each eight with the frames
//! that reach any of them.
//!
//! Eight neighbours share most of their frames, so the rows of a frame are read once for eight samples; a frame that
//! does not reach one of them has nothing to say there. Order of samples and sums depends on the body alone.

use souple_mesh::recursive_bisection;

use super::{Carried, ROWS_OF_FRAME, Sample};
use crate::solids::layout::{Chunk as SampleChunk, LANES, LaneBlock};

/// Samples of a chunk: as many as runs of a law take a few times over, few enough to share most of their frames.
const SAMPLES_PER_CHUNK: usize = 256;
/// Numbers of a frame at a sample: the gradient of each of its rows.
pub const GRADIENT_LEN: usize = 3 * ROWS_OF_FRAME;

/// Neighbouring samples of one law.
pub struct Chunk {
    /// Volumes and numbers of the law, as laws take them.
    pub samples: SampleChunk,
    pub block_count: usize,
    /// Frames that reach any of the samples, ascending.
    pub frames: Vec<u32>,
    /// Where the frames of each block start among the members, and where the last ends.
    pub starts: Vec<u32>,
    /// The chunk's own frame of each (block, frame).
    pub members: Vec<u16>,
    /// Of each member: row by row three components of its gradient.
    gradients: Vec<LaneBlock>,
    /// Pairs `i ≤ j` of own frames that share a block.
    pub pairs: Vec<[u16; 2]>,
    /// Of each block's pairs `(a, b)`, `a ≤ b`, of members: the chunk's pair.
    pub places: Vec<u32>,
    pub place_starts: Vec<u32>,
    /// Where the chunk's sums over rows of frames start, in frames, and those over pairs, in pairs.
    pub first_frame: usize,
    pub first_pair: usize,
}

impl Chunk {
    pub fn members(&self, block: usize) -> std::ops::Range<usize> {
        self.starts[block] as usize..self.starts[block + 1] as usize
    }

    #[inline(always)]
    pub fn gradient(&self, member: usize) -> &[LaneBlock] {
        &self.gradients[member * GRADIENT_LEN..(member + 1) * GRADIENT_LEN]
    }

    pub fn bytes(&self) -> usize {
        self.samples.bytes()
            + size_of::<LaneBlock>() * self.gradients.len()
            + 4 * (self.frames.len() + self.starts.len() + self.places.len() + self.place_starts.len())
            + 2 * (self.members.len() + 2 * self.pairs.len())
    }
}

/// Lays out the samples named in `members`, all of one law, into chunks; `parameters_of` gives the numbers of each.
pub fn chunks<'p>(
    (samples, carried): (&[Sample], &[Carried]),
    members: &[u32],
    parameters_of: &dyn Fn(u32) -> &'p [f64],
) -> Vec<Chunk> {
    let places: Vec<_> = members.iter().map(|sample| samples[*sample as usize].position).collect();
    // halves of halves: eight neighbours in the order are neighbours in space
    let order = recursive_bisection(&places, LANES);
    let order: Vec<u32> = order.iter().map(|index| members[*index as usize]).collect();
    order.chunks(SAMPLES_PER_CHUNK).map(|order| lay_out(samples, carried, order, parameters_of)).collect()
}

fn lay_out<'p>(
    samples: &[Sample],
    carried: &[Carried],
    order: &[u32],
    parameters_of: &dyn Fn(u32) -> &'p [f64],
) -> Chunk {
    let block_count = order.len().div_ceil(LANES);
    let at = |block: usize, lane: usize| order.get(block * LANES + lane);
    let sample = |block: usize, lane: usize| match at(block, lane) {
        Some(index) => (samples[*index as usize].volume, parameters_of(*index)),
        None => (0.0, parameters_of(order[0])),
    };
    let frames_of = |indices: &[u32]| {
        let mut frames: Vec<u32> =
            indices.iter().flat_map(|index| carried[*index as usize].frames.iter().copied()).collect();
        frames.sort_unstable();
        frames.dedup();
        frames
    };
    let mut chunk = Chunk {
        samples: SampleChunk::of_samples(block_count, sample),
        block_count,
        frames: frames_of(order),
        starts: vec![0],
        members: Vec::new(),
        gradients: Vec::new(),
        pairs: Vec::new(),
        places: Vec::new(),
        place_starts: vec![0],
        first_frame: 0,
        first_pair: 0,
    };
    let own = |chunk: &Chunk, frame: u32| chunk.frames.partition_point(|known| *known < frame) as u16;
    for indices in order.chunks(LANES) {
        for frame in frames_of(indices) {
            chunk.members.push(own(&chunk, frame));
            let first = chunk.gradients.len();
            chunk.gradients.resize(first + GRADIENT_LEN, LaneBlock::default());
            // lanes past the last sample stand where it stands, without volume
            for lane in 0..LANES {
                let point = &carried[indices[lane.min(indices.len() - 1)] as usize];
                let Ok(place) = point.frames.binary_search(&frame) else { continue };
                for (row, (_, gradient)) in point.rows[place].iter().enumerate() {
                    for axis in 0..3 {
                        chunk.gradients[first + 3 * row + axis].0[lane] = gradient[axis];
                    }
                }
            }
        }
        chunk.starts.push(chunk.members.len() as u32);
    }
    number_pairs(&mut chunk);
    chunk
}

fn number_pairs(chunk: &mut Chunk) {
    let mut ordered = Vec::new();
    for block in 0..chunk.block_count {
        let members = &chunk.members[chunk.members(block)];
        for (a, i) in members.iter().enumerate() {
            ordered.extend(members[a..].iter().map(|j| [*i, *j]));
        }
        chunk.place_starts.push(ordered.len() as u32);
    }
    chunk.pairs.clone_from(&ordered);
    chunk.pairs.sort_unstable();
    chunk.pairs.dedup();
    let place = |pair: &[u16; 2]| chunk.pairs.partition_point(|known| known < pair) as u32;
    chunk.places = ordered.iter().map(place).collect();
}
