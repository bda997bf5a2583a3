//! The loops over samples of frames: gradients, the spreading of stresses, products of gradients with tangents.
//!
//! A frame takes a material point from `X` to `o + B X`, with `B = Σ_k a_k ⊗ A_k` of its axes and `o = x - B X_0` of its origin, so
//! that `F = Σ (o + B X) ⊗ ∇w + w B`; of a stress `P` the map feels `-V P ∇w` and `-V (P ∇w ⊗ X + w P)`.
//!
//! With the gradient `h_a` of row `a` it is `F = Σ_a q_a ⊗ h_a`, and between rows `a` and `b` stands
//! `K_ab[i,k] = V Σ_JL h_a[J] ∂P_iJ/∂F_kL h_b[L]`.

use pulp::{Simd, WithSimd};
use souple_formal::tape::BATCH;
use souple_math::{Lanes, Mat3, Real, Vec3};

use super::ROWS_OF_FRAME;
use super::layout::{Chunk, FrameMap, GRADIENT_LEN, SingleBlock};
use crate::solids::geometry::accumulate;
use crate::solids::layout::{LANES, LaneBlock};
use crate::solids::sample_law::{Run, load_matrix, store_matrix};

/// Numbers of a line of a pair's sum: three for each row of the second frame, and room for registers.
pub const LINE: usize = 16;
/// Lines of a pair's sum: three for each row of the first frame.
pub const LINES: usize = 3 * ROWS_OF_FRAME;
/// Numbers of a pair's sum: entry `(i, k)` of the block of rows `(a, b)` at `(3 a + i) LINE + 3 b + k`.
pub const PAIR_LEN: usize = LINES * LINE;
/// Numbers of the rates of a frame at eight samples: `[sample][J][i]` lines.
pub const RATES_LEN: usize = LANES * 9 * LINE;

/// Writes `Σ (o + B P) ⊗ ∇w + w B` of every sample of a run, of maps `P -> o + B P` of the chunk's own frames.
pub struct Gradients<'a> {
    pub chunk: &'a Chunk,
    pub run: &'a Run<'a>,
    pub field: &'a [FrameMap],
    pub out: &'a mut [f64],
    pub start: usize,
}

impl WithSimd for Gradients<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { chunk, run, field, out, start } = self;
        for block in run.rows() {
            let mut lane = 0;
            while lane < LANES {
                let P = load_vector(simd, chunk.points(block), lane);
                let mut F = Mat3::zero(Lanes::constant(simd, 0.0));
                for member in chunk.members(block) {
                    let share = chunk.share(member);
                    let weight = load_single(simd, &share[0], lane);
                    let slope = load_slope(simd, share, lane);
                    let (at, turn) = carried(simd, &field[chunk.members[member] as usize], P);
                    accumulate(&mut F.columns[0], at, slope.x);
                    accumulate(&mut F.columns[1], at, slope.y);
                    accumulate(&mut F.columns[2], at, slope.z);
                    for J in 0..3 {
                        accumulate(&mut F.columns[J], turn.columns[J], weight);
                    }
                }
                store_matrix(&F, &mut out[start + run.lane_of(block) + lane..]);
                lane += S::F64_LANES;
            }
        }
    }
}

#[inline(always)]
fn load_vector<S: Simd>(simd: S, blocks: &[LaneBlock], lane: usize) -> Vec3<Lanes<S>> {
    Vec3::new(
        Lanes::load(simd, &blocks[0].0[lane..]),
        Lanes::load(simd, &blocks[1].0[lane..]),
        Lanes::load(simd, &blocks[2].0[lane..]),
    )
}

#[inline(always)]
fn load_single<S: Simd>(simd: S, block: &SingleBlock, lane: usize) -> Lanes<S> {
    let mut numbers = [0.0; LANES];
    for (number, single) in numbers[..S::F64_LANES].iter_mut().zip(&block.0[lane..]) {
        *number = f64::from(*single);
    }
    Lanes::load(simd, &numbers)
}

/// The gradient of a member's weight.
#[inline(always)]
fn load_slope<S: Simd>(simd: S, share: &[SingleBlock], lane: usize) -> Vec3<Lanes<S>> {
    Vec3::new(
        load_single(simd, &share[1], lane),
        load_single(simd, &share[2], lane),
        load_single(simd, &share[3], lane),
    )
}

/// `o + B P`, and `B`.
#[inline(always)]
fn carried<S: Simd>(simd: S, map: &FrameMap, P: Vec3<Lanes<S>>) -> (Vec3<Lanes<S>>, Mat3<Lanes<S>>) {
    let mut turn = Mat3::zero(Lanes::constant(simd, 0.0));
    let mut at = constant(simd, map.origin);
    for J in 0..3 {
        turn.columns[J] = constant(simd, map.turn.columns[J]);
    }
    accumulate(&mut at, turn.columns[0], P.x);
    accumulate(&mut at, turn.columns[1], P.y);
    accumulate(&mut at, turn.columns[2], P.z);
    (at, turn)
}

#[inline(always)]
fn constant<S: Simd>(simd: S, vector: Vec3) -> Vec3<Lanes<S>> {
    Vec3::new(
        Lanes::constant(simd, vector.x),
        Lanes::constant(simd, vector.y),
        Lanes::constant(simd, vector.z),
    )
}

/// Numbers of a frame's sums: the force on its map's origin, then by columns what is on its turn.
pub const MAP_LEN: usize = 12;

/// Adds `scale V (P ∇w, P ∇w ⊗ X + w P)`, with the stress `P` at the sample `X`, to the sums of frames, eight samples side by side: the
/// transpose of [`Gradients`]. What a frame gets of a run is summed in registers.
pub struct Spread<'a> {
    pub chunk: &'a Chunk,
    pub run: &'a Run<'a>,
    /// Overwritten by `scale V P`.
    pub stresses: &'a mut [f64],
    pub scale: f64,
    /// Of each of the chunk's own frames [`MAP_LEN`].
    pub sums: &'a mut [LaneBlock],
}

impl WithSimd for Spread<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { chunk, run, stresses, scale, sums } = self;
        let mut lane = 0;
        while lane < LANES {
            for block in run.rows() {
                let volume = Lanes::load(simd, &run.volumes(block)[lane..]);
                let stresses = &mut stresses[run.lane_of(block) + lane..];
                store_matrix(&load_matrix(simd, stresses).scaled(volume * scale), stresses);
            }
            let mut visits = chunk.visits(run.first);
            while let Some(first) = visits.first() {
                let own = first.own;
                let mut force_sum = constant(simd, Vec3::ZERO);
                let mut turn_sum = Mat3::zero(Lanes::constant(simd, 0.0));
                while let Some((visit, rest)) = visits.split_first() {
                    if visit.own != own {
                        break;
                    }
                    visits = rest;
                    let block = visit.block as usize;
                    let share = chunk.share(visit.member as usize);
                    let stress = load_matrix(simd, &stresses[run.lane_of(block) + lane..]);
                    let X = load_vector(simd, chunk.points(block), lane);
                    let weight = load_single(simd, &share[0], lane);
                    let force = stress * load_slope(simd, share, lane);
                    force_sum += force;
                    let arms = [X.x, X.y, X.z];
                    for J in 0..3 {
                        accumulate(&mut turn_sum.columns[J], force, arms[J]);
                        accumulate(&mut turn_sum.columns[J], stress.columns[J], weight);
                    }
                }
                let sums = &mut sums[MAP_LEN * own as usize..][..MAP_LEN];
                add(simd, force_sum, &mut sums[..3], lane);
                for J in 0..3 {
                    add(simd, turn_sum.columns[J], &mut sums[3 * (J + 1)..3 * (J + 2)], lane);
                }
            }
            lane += S::F64_LANES;
        }
    }
}

#[inline(always)]
fn add<S: Simd>(simd: S, vector: Vec3<Lanes<S>>, sums: &mut [LaneBlock], lane: usize) {
    let numbers = vector.to_array();
    for i in 0..3 {
        let sum = &mut sums[i].0[lane..];
        (Lanes::load(simd, sum) + numbers[i]).store(sum);
    }
}

/// Adds `scale V hᵀ ∂P/∂F h` of a run's samples to the sums of the chunk's pairs of frames.
pub struct Blocks<'a> {
    pub chunk: &'a Chunk,
    pub run: &'a Run<'a>,
    pub tangents: &'a [f64],
    pub scale: f64,
    /// Scratch for one frame, [`RATES_LEN`].
    pub rates: &'a mut [f64],
    /// Scratch for the gradients of a block's members.
    pub gradients: &'a mut Vec<LaneBlock>,
    pub sums: &'a mut [f64],
}

impl WithSimd for Blocks<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { chunk, run, tangents, scale, rates, gradients, sums } = self;
        for block in run.rows() {
            let members = chunk.members(block);
            gradients.resize(members.len() * GRADIENT_LEN, LaneBlock::default());
            for (member, out) in members.clone().zip(gradients.chunks_exact_mut(GRADIENT_LEN)) {
                chunk.gradients_into(block, member, out);
            }
            let places = &chunk.places[chunk.place_starts[block] as usize..];
            let count = members.len();
            for (b, second) in gradients.chunks_exact(GRADIENT_LEN).enumerate() {
                let volumes = run.volumes(block);
                fill_rates(simd, (volumes, second), &tangents[run.lane_of(block)..], scale, rates);
                // pairs are listed line by line: (a, b) is the (b - a)-th of line a
                let mut line = 0;
                for (a, first) in gradients.chunks_exact(GRADIENT_LEN).take(b + 1).enumerate() {
                    let pair = places[line + b - a] as usize * PAIR_LEN;
                    add_products(simd, first, rates, &mut sums[pair..pair + PAIR_LEN]);
                    line += count - a;
                }
            }
        }
    }
}

/// Writes `scale V ∂P_iJ/∂F_kL h_b[L]` for every row `b` of a frame.
#[inline(always)]
fn fill_rates<S: Simd>(
    simd: S,
    (volumes, gradient): (&[f64; LANES], &[LaneBlock]),
    tangents: &[f64],
    scale: f64,
    rates: &mut [f64],
) {
    let rates = &mut rates[..RATES_LEN];
    let mut lane = 0;
    while lane < LANES {
        let weight = Lanes::load(simd, &volumes[lane..]) * scale;
        for (b, h) in gradient.chunks_exact(3).enumerate() {
            let h = [0, 1, 2].map(|L: usize| Lanes::load(simd, &h[L].0[lane..]) * weight);
            for k in 0..3 {
                for entry in 0..9 {
                    // entry (k, L) of F is the (3 L + k)-th
                    let of =
                        |L: usize| Lanes::load(simd, &tangents[(9 * (3 * L + k) + entry) * BATCH + lane..]);
                    let rate = of(0).mul_add(h[0], of(1).mul_add(h[1], of(2) * h[2]));
                    for (s, number) in rate.as_slice().iter().enumerate() {
                        rates[((lane + s) * 9 + entry) * LINE + 3 * b + k] = *number;
                    }
                }
            }
        }
        lane += S::F64_LANES;
    }
}

/// `sum[(a, i)] += Σ h_a[J] rates[J][i]` over eight samples.
#[inline(always)]
fn add_products<S: Simd>(simd: S, gradient: &[LaneBlock], rates: &[f64], sum: &mut [f64]) {
    let (gradient, rates, sum) = (&gradient[..GRADIENT_LEN], &rates[..RATES_LEN], &mut sum[..PAIR_LEN]);
    let mut lane = 0;
    while lane < LINES {
        let mut sums = [[Lanes::constant(simd, 0.0); 3]; ROWS_OF_FRAME];
        for sample in 0..LANES {
            for J in 0..3 {
                let line = (9 * sample + 3 * J) * LINE + lane;
                let x = Lanes::load(simd, &rates[line..]);
                let y = Lanes::load(simd, &rates[line + LINE..]);
                let z = Lanes::load(simd, &rates[line + 2 * LINE..]);
                for a in 0..ROWS_OF_FRAME {
                    let h = Lanes::constant(simd, gradient[3 * a + J].0[sample]);
                    sums[a][0] = h.mul_add(x, sums[a][0]);
                    sums[a][1] = h.mul_add(y, sums[a][1]);
                    sums[a][2] = h.mul_add(z, sums[a][2]);
                }
            }
        }
        for a in 0..ROWS_OF_FRAME {
            for i in 0..3 {
                let at = &mut sum[(3 * a + i) * LINE + lane..];
                (Lanes::load(simd, at) + sums[a][i]).store(at);
            }
        }
        lane += S::F64_LANES;
    }
}
