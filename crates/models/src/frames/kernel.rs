//! The loops over samples of frames: gradients, the spreading of stresses, products of gradients with tangents.
//!
//! With the gradient `h_a` of row `a`: `F = Σ_a q_a ⊗ h_a`, the row feels `-V P h_a`, and between rows `a` and `b` stands
//! `K_ab[i,k] = V Σ_JL h_a[J] ∂P_iJ/∂F_kL h_b[L]`.

use pulp::{Simd, WithSimd};
use souple_formal::tape::BATCH;
use souple_math::{Lanes, Mat3, Real, Vec3};

use super::ROWS_OF_FRAME;
use super::layout::{Chunk, GRADIENT_LEN};
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

/// Writes `Σ values ⊗ gradient` of every sample of a run; `values` are those of the chunk's own frames' rows.
pub struct Gradients<'a> {
    pub chunk: &'a Chunk,
    pub run: &'a Run<'a>,
    pub values: &'a [Vec3],
    pub out: &'a mut [f64],
}

impl WithSimd for Gradients<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { chunk, run, values, out } = self;
        for block in run.rows() {
            let mut lane = 0;
            while lane < LANES {
                let mut F = Mat3::zero(Lanes::constant(simd, 0.0));
                for member in chunk.members(block) {
                    let frame = ROWS_OF_FRAME * chunk.members[member] as usize;
                    let rows = &values[frame..frame + ROWS_OF_FRAME];
                    for (row, h) in rows.iter().zip(chunk.gradient(member).chunks_exact(3)) {
                        let [x, y, z] = row.to_array().map(|number| Lanes::constant(simd, number));
                        for J in 0..3 {
                            let h = Lanes::load(simd, &h[J].0[lane..]);
                            let column = &mut F.columns[J];
                            column.x = x.mul_add(h, column.x);
                            column.y = y.mul_add(h, column.y);
                            column.z = z.mul_add(h, column.z);
                        }
                    }
                }
                store_matrix(&F, &mut out[run.lane_of(block) + lane..]);
                lane += S::F64_LANES;
            }
        }
    }
}

/// Adds `scale V P h` of a run's samples to the sums of rows, eight samples side by side.
pub struct Spread<'a> {
    pub chunk: &'a Chunk,
    pub run: &'a Run<'a>,
    pub stresses: &'a [f64],
    pub scale: f64,
    /// Of each of the chunk's own frames: row by row three components.
    pub sums: &'a mut [LaneBlock],
}

impl WithSimd for Spread<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { chunk, run, stresses, scale, sums } = self;
        for block in run.rows() {
            let mut lane = 0;
            while lane < LANES {
                let volume = Lanes::load(simd, &chunk.samples.volumes(block)[lane..]);
                let P = load_matrix(simd, &stresses[run.lane_of(block) + lane..]).scaled(volume * scale);
                for member in chunk.members(block) {
                    let frame = GRADIENT_LEN * chunk.members[member] as usize;
                    let sums = &mut sums[frame..frame + GRADIENT_LEN];
                    for (sums, h) in sums.chunks_exact_mut(3).zip(chunk.gradient(member).chunks_exact(3)) {
                        let h = Vec3::new(
                            Lanes::load(simd, &h[0].0[lane..]),
                            Lanes::load(simd, &h[1].0[lane..]),
                            Lanes::load(simd, &h[2].0[lane..]),
                        );
                        let f = (P * h).to_array();
                        for i in 0..3 {
                            let sum = &mut sums[i].0[lane..];
                            (Lanes::load(simd, sum) + f[i]).store(sum);
                        }
                    }
                }
                lane += S::F64_LANES;
            }
        }
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
    pub sums: &'a mut [f64],
}

impl WithSimd for Blocks<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { chunk, run, tangents, scale, rates, sums } = self;
        for block in run.rows() {
            let members = chunk.members(block);
            let places = &chunk.places[chunk.place_starts[block] as usize..];
            let count = members.len();
            for (b, second) in members.clone().enumerate() {
                fill_rates(simd, chunk, (block, second), &tangents[run.lane_of(block)..], scale, rates);
                // pairs are listed line by line: (a, b) is the (b - a)-th of line a
                let mut line = 0;
                for (a, first) in members.clone().take(b + 1).enumerate() {
                    let pair = places[line + b - a] as usize * PAIR_LEN;
                    add_products(simd, chunk.gradient(first), rates, &mut sums[pair..pair + PAIR_LEN]);
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
    chunk: &Chunk,
    (block, member): (usize, usize),
    tangents: &[f64],
    scale: f64,
    rates: &mut [f64],
) {
    let rates = &mut rates[..RATES_LEN];
    let mut lane = 0;
    while lane < LANES {
        let weight = Lanes::load(simd, &chunk.samples.volumes(block)[lane..]) * scale;
        for (b, h) in chunk.gradient(member).chunks_exact(3).enumerate() {
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
