//! How samples of frames lie in memory: chunks of neighbouring samples, eight side by side, each eight with the frames
//! that reach any of them.
//!
//! Eight neighbours share most of their frames, so a frame is read once for eight samples; a frame that does not reach one of them
//! has nothing to say there. Large bodies wait for memory, so what is kept of a frame at a sample is its weight and the gradient of
//! that, four numbers: the twelve of the gradients of its rows follow from these and from where sample and frame are at rest. They are
//! kept in single precision, as multiples of a unit so that weights still sum to one and gradients to nothing exactly: a rigid motion
//! strains nothing to double precision, and what strains differ is a millionth of them.
//!
//! Order of samples and sums depends on the body alone.

use souple_math::{Mat3, Vec3};
use souple_mesh::recursive_bisection;

use super::{Carried, Frame, ROWS_OF_FRAME, Sample};
use crate::solids::layout::{Chunk as SampleChunk, LANES, LaneBlock};
use crate::solids::sample_law::ROWS;

/// Samples of a chunk: as many as runs of a law take a few times over, few enough to share most of their frames.
const SAMPLES_PER_CHUNK: usize = 256;
/// Numbers of a frame at a sample: its weight, and the gradient of that.
pub const SHARE_LEN: usize = 4;
/// Numbers of a frame at a sample, written out: the gradient of each of its rows.
pub const GRADIENT_LEN: usize = 3 * ROWS_OF_FRAME;

/// Numbers of eight samples in single precision.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(32))]
pub struct SingleBlock(pub [f32; LANES]);

/// A frame that a run of samples meets in one of its blocks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Visit {
    /// The chunk's own frame.
    pub own: u32,
    pub block: u32,
    pub member: u32,
}

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
    pub members: Vec<u32>,
    /// Of each member: its weight, and three components of the gradient of that.
    shares: Vec<SingleBlock>,
    /// Of each run of blocks that a law takes: its members, by own frame.
    visits: Vec<Visit>,
    visit_starts: Vec<u32>,
    /// Of each block: where its samples are at rest [m], counted from the middle of the chunk, so that bodies far from the origin
    /// lose no digits.
    points: Vec<LaneBlock>,
    /// Own frames at rest, origins counted likewise.
    rest: Vec<Frame>,
    /// The cell of each sample.
    pub cells: Vec<u32>,
    /// Pairs `i ≤ j` of own frames that share a block.
    pub pairs: Vec<[u32; 2]>,
    /// Of each block's pairs `(a, b)`, `a ≤ b`, of members: the chunk's pair.
    pub places: Vec<u32>,
    pub place_starts: Vec<u32>,
    /// Where the chunk's sums over rows of frames start, in frames, and those over pairs, in pairs.
    pub first_frame: usize,
    pub first_pair: usize,
}

/// Where a frame takes a material point: from `P` to `origin + turn P`. As a field of forces, the force at `P = 0` and `Σ f ⊗ P`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameMap {
    pub origin: Vec3,
    pub turn: Mat3,
}

impl Chunk {
    pub fn members(&self, block: usize) -> std::ops::Range<usize> {
        self.starts[block] as usize..self.starts[block + 1] as usize
    }

    #[inline(always)]
    pub fn share(&self, member: usize) -> &[SingleBlock] {
        &self.shares[member * SHARE_LEN..(member + 1) * SHARE_LEN]
    }

    /// Members of the run that begins with a block, frame by frame.
    pub fn visits(&self, first_block: usize) -> &[Visit] {
        let run = first_block / ROWS;
        &self.visits[self.visit_starts[run] as usize..self.visit_starts[run + 1] as usize]
    }

    #[inline(always)]
    pub fn points(&self, block: usize) -> &[LaneBlock] {
        &self.points[3 * block..3 * (block + 1)]
    }

    /// Maps of own frames from their rows, four a frame.
    pub fn maps_of<'a>(
        &'a self,
        rows: impl Iterator<Item = Vec3> + 'a,
    ) -> impl Iterator<Item = FrameMap> + 'a {
        let mut rows = rows;
        self.rest.iter().map(move |Frame { origin, axes }| {
            let mut row = || rows.next().unwrap_or(Vec3::ZERO);
            let (now, mut turn) = (row(), Mat3::ZERO);
            for axis in axes.columns {
                turn += row().outer(axis);
            }
            FrameMap { origin: now - turn * *origin, turn }
        })
    }

    /// `F` of a sample under maps of own frames: `Σ (o + B P) ⊗ ∇w + w B`.
    pub fn deformation(&self, sample: usize, maps: &[FrameMap]) -> Mat3 {
        let (block, lane) = (sample / LANES, sample % LANES);
        let of = |numbers: &[LaneBlock], axis: usize| numbers[axis].0[lane];
        let points = self.points(block);
        let point = Vec3::new(of(points, 0), of(points, 1), of(points, 2));
        let mut F = Mat3::ZERO;
        for member in self.members(block) {
            let FrameMap { origin, turn } = maps[self.members[member] as usize];
            let number = |index: usize| f64::from(self.share(member)[index].0[lane]);
            let gradient = Vec3::new(number(1), number(2), number(3));
            F += (origin + turn * point).outer(gradient) + turn * number(0);
        }
        F
    }

    /// Volume of a sample at rest [m³].
    pub fn volume(&self, sample: usize) -> f64 {
        self.samples.volumes(sample / LANES, 0, 1)[sample % LANES]
    }

    /// Forces on the rows of own frame number `own` from those on its map: the transpose of [`Chunk::maps_of`].
    pub fn forces_of(&self, own: usize, on_map: &FrameMap) -> [Vec3; ROWS_OF_FRAME] {
        let (Frame { origin, axes }, FrameMap { origin: force, turn }) = (&self.rest[own], on_map);
        let about_origin = *turn - force.outer(*origin);
        let [x, y, z] = axes.columns.map(|axis| about_origin * axis);
        [*force, x, y, z]
    }

    /// Writes the gradients of the rows of a member: `∇w` of its origin, `l_k ∇w + w A_k` of its axis `k`.
    pub fn gradients_into(&self, block: usize, member: usize, out: &mut [LaneBlock]) {
        let Frame { origin, axes } = &self.rest[self.members[member] as usize];
        let (share, points) = (self.share(member), self.points(block));
        for (out, slope) in out.iter_mut().zip(&share[1..]) {
            out.0 = slope.0.map(f64::from);
        }
        for (axis, out) in axes.columns.iter().zip(out[3..].chunks_exact_mut(3)) {
            for lane in 0..LANES {
                let point = Vec3::new(points[0].0[lane], points[1].0[lane], points[2].0[lane]);
                let local = axis.dot(point - *origin);
                for J in 0..3 {
                    let (slope, weight) = (f64::from(share[1 + J].0[lane]), f64::from(share[0].0[lane]));
                    out[J].0[lane] = slope * local + weight * axis[J];
                }
            }
        }
    }

    pub fn bytes(&self) -> usize {
        self.samples.bytes()
            + size_of::<SingleBlock>() * self.shares.len()
            + size_of::<Visit>() * self.visits.len()
            + size_of::<LaneBlock>() * self.points.len()
            + size_of::<Frame>() * self.rest.len()
            + 4 * (self.frames.len() + self.starts.len() + self.visit_starts.len())
            + 4 * (self.places.len() + self.place_starts.len())
            + 4 * (self.members.len() + 2 * self.pairs.len() + self.cells.len())
    }
}

/// Lays out the samples named in `members`, all of one law, into chunks; `parameters_of` gives the numbers of each.
pub fn chunks<'p>(body: &Body, members: &[u32], parameters_of: &dyn Fn(u32) -> &'p [f64]) -> Vec<Chunk> {
    let places: Vec<_> = members.iter().map(|sample| body.samples[*sample as usize].position).collect();
    // halves of halves: eight neighbours in the order are neighbours in space
    let order = recursive_bisection(&places, LANES);
    let order: Vec<u32> = order.iter().map(|index| members[*index as usize]).collect();
    order.chunks(SAMPLES_PER_CHUNK).map(|order| lay_out(body, order, parameters_of)).collect()
}

/// Whose samples are laid out.
pub struct Body<'a> {
    pub frames: &'a [Frame],
    pub samples: &'a [Sample],
    /// What frames have to say at each sample.
    pub carried: &'a [Carried],
}

fn lay_out<'p>(body: &Body, order: &[u32], parameters_of: &dyn Fn(u32) -> &'p [f64]) -> Chunk {
    let Body { frames: rest, samples, carried } = body;
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
    let place = |index: &u32| samples[*index as usize].position;
    let centre = order.iter().map(place).sum::<Vec3>() * (1.0 / order.len() as f64);
    let frames = frames_of(order);
    let from_centre = |frame: &u32| {
        let Frame { origin, axes } = rest[*frame as usize];
        Frame { origin: origin - centre, axes }
    };
    let mut chunk = Chunk {
        samples: SampleChunk::of_samples(block_count, sample),
        block_count,
        rest: frames.iter().map(from_centre).collect(),
        cells: order.iter().map(|index| samples[*index as usize].cell).collect(),
        frames,
        starts: vec![0],
        members: Vec::new(),
        shares: Vec::new(),
        visits: Vec::new(),
        visit_starts: vec![0],
        points: vec![LaneBlock::default(); 3 * block_count],
        pairs: Vec::new(),
        places: Vec::new(),
        place_starts: vec![0],
        first_frame: 0,
        first_pair: 0,
    };
    for (block, indices) in order.chunks(LANES).enumerate() {
        // lanes past the last sample stand where it stands, without volume
        let at = |lane: usize| indices[lane.min(indices.len() - 1)];
        for lane in 0..LANES {
            let point = place(&at(lane)) - centre;
            for axis in 0..3 {
                chunk.points[3 * block + axis].0[lane] = point[axis];
            }
        }
        let reaching = frames_of(indices);
        let first = chunk.shares.len();
        chunk.members.extend(reaching.iter().map(|frame| own_frame(&chunk.frames, *frame)));
        chunk.shares.resize(first + reaching.len() * SHARE_LEN, SingleBlock::default());
        for lane in 0..LANES {
            let point = &carried[at(lane) as usize];
            let share = |frame: &u32| {
                let Ok(place) = point.frames.binary_search(frame) else { return [0.0; SHARE_LEN] };
                let (weight, gradient) = point.rows[place][0];
                [weight, gradient.x, gradient.y, gradient.z]
            };
            let shares = in_units(reaching.iter().map(share).collect());
            for (share, blocks) in shares.iter().zip(chunk.shares[first..].chunks_exact_mut(SHARE_LEN)) {
                blocks.iter_mut().zip(share).for_each(|(block, number)| block.0[lane] = *number as f32);
            }
        }
        chunk.starts.push(chunk.members.len() as u32);
    }
    chunk.shares.shrink_to_fit();
    list_visits(&mut chunk);
    number_pairs(&mut chunk);
    chunk
}

/// A chunk's own number of one of its frames.
fn own_frame(frames: &[u32], frame: u32) -> u32 {
    frames.partition_point(|known| *known < frame) as u32
}

/// Binary digits of a number in single precision, less one for what sums are made up with.
const DIGITS: i32 = 23;

/// The shares of frames at a sample, each number a multiple of a unit that single precision holds exactly, with the sums that they
/// have: 1 and 0. What rounding leaves goes to the frame with the greatest weight.
fn in_units(shares: Vec<[f64; SHARE_LEN]>) -> Vec<[f64; SHARE_LEN]> {
    let mut shares = shares;
    let Some(main) = (0..shares.len()).max_by(|a, b| shares[*a][0].total_cmp(&shares[*b][0])) else {
        return shares;
    };
    // what goes to the frame with the greatest weight must be rounding, and not what weights lack
    debug_assert!((shares.iter().map(|share| share[0]).sum::<f64>() - 1.0).abs() < 1e-9, "{shares:?}");
    for number in 0..SHARE_LEN {
        let most = shares.iter().map(|share| share[number].abs()).fold(0.0, f64::max);
        let unit = libm::ldexp(1.0, libm::frexp(most).1 - DIGITS);
        let mut left = if number == 0 { 1.0 } else { 0.0 };
        for share in &mut shares {
            share[number] = (share[number] / unit).round() * unit;
            left -= share[number];
        }
        shares[main][number] += left;
    }
    shares
}

fn list_visits(chunk: &mut Chunk) {
    for first in (0..chunk.block_count).step_by(ROWS) {
        let blocks = first..chunk.block_count.min(first + ROWS);
        let start = chunk.visits.len();
        for block in blocks {
            let members = chunk.starts[block]..chunk.starts[block + 1];
            chunk.visits.extend(members.map(|member| Visit {
                own: chunk.members[member as usize],
                block: block as u32,
                member,
            }));
        }
        chunk.visits[start..].sort_by_key(|visit| (visit.own, visit.block));
        chunk.visit_starts.push(chunk.visits.len() as u32);
    }
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
    let place = |pair: &[u32; 2]| chunk.pairs.partition_point(|known| known < pair) as u32;
    chunk.places = ordered.iter().map(place).collect();
}

#[cfg(test)]
mod tests {
    use super::*;

    /// More frames may reach a chunk than sixteen bits count.
    #[test]
    fn own_frames_are_numbered_beyond_sixteen_bits() {
        let frames: Vec<u32> = (0..70_000).map(|frame| 3 * frame).collect();
        assert_eq!(own_frame(&frames, 3 * 69_999), 69_999);
    }

    /// Shares in units are what single precision holds, sum to one and their gradients to nothing to the last bit, and are off by half
    /// a unit, the greatest number over 2²², that with the greatest weight by as much as all.
    #[test]
    fn shares_in_units_sum_as_they_did() {
        let raw: Vec<[f64; SHARE_LEN]> = (0..26)
            .map(|i| {
                let wave = |phase: f64| (f64::from(i) * 2.3 + phase).sin();
                [wave(0.1).powi(4), 40.0 * wave(1.0), 1e-9 * wave(2.0), 0.0]
            })
            .collect();
        let sum = |of: &[[f64; SHARE_LEN]], number: usize| of.iter().map(|share| share[number]).sum::<f64>();
        let sums: [f64; SHARE_LEN] = std::array::from_fn(|number| sum(&raw, number));
        let shares: Vec<[f64; SHARE_LEN]> = raw
            .iter()
            .map(|share| {
                let part = share[0] / sums[0];
                std::array::from_fn(
                    |number| {
                        if number == 0 { part } else { share[number] - part * sums[number] }
                    },
                )
            })
            .collect();
        let rounded = in_units(shares.clone());
        for number in 0..SHARE_LEN {
            assert_eq!(sum(&rounded, number), if number == 0 { 1.0 } else { 0.0 });
            let most = shares.iter().map(|share| share[number].abs()).fold(0.0, f64::max);
            for (rounded, share) in rounded.iter().zip(&shares) {
                assert_eq!(f64::from(rounded[number] as f32), rounded[number]);
                assert!((rounded[number] - share[number]).abs() <= 26.0 * most * f64::from(f32::EPSILON));
            }
        }
    }
}
