//! The loops over elements for a law as text.
//!
//! The deformation gradients of a batch of samples are laid side by side, the law's tape runs over all of them, and the
//! stresses are spread to the nodes. Compare [`super::kernel`], where a law is compiled into the loop.

use std::cell::RefCell;
use std::marker::PhantomData;
use std::ops::Range;
use std::sync::Arc;

use pulp::{Arch, Simd, WithSimd};
use souple_formal::tape::{BATCH, Part, Tape};
use souple_math::{Lanes, Mat3, Vec3};

use super::geometry::Geometry;
use super::group::Group;
use super::kernel::Kernel;
use super::layout::{Chunk, LANES, LaneBlock};
use crate::materials::TextLaw;

/// Samples of blocks of lanes that one run of a tape takes.
const ROWS: usize = BATCH / LANES;
/// Numbers of `∂P/∂F`.
const TANGENT_LEN: usize = 81;

/// [`Kernel`] of a law as text on elements of geometry `G` with `N` nodes.
pub struct TextKernel<G, const N: usize> {
    law: Arc<TextLaw>,
    geometry: PhantomData<G>,
}

impl<G, const N: usize> TextKernel<G, N> {
    pub fn new(law: &Arc<TextLaw>) -> Self {
        Self { law: Arc::clone(law), geometry: PhantomData }
    }
}

thread_local! {
    /// Registers of a tape; and `∂P/∂F` of a batch, `[entry of F][entry of P][lane]`.
    static MEMORY: RefCell<[Vec<LaneBlock>; 2]> = const { RefCell::new([Vec::new(), Vec::new()]) };
}

/// Runs `work` with memory for a tape, its constants written, and for tangents.
fn with_memory<T>(tape: &Tape, work: impl FnOnce(&mut [f64], &mut [f64]) -> T) -> T {
    MEMORY.with_borrow_mut(|[registers, tangents]| {
        let wanted = tape.memory_len().div_ceil(LANES);
        if registers.len() < wanted {
            registers.resize(wanted, LaneBlock::default());
        }
        tangents.resize(TANGENT_LEN * ROWS, LaneBlock::default());
        let registers = bytemuck::cast_slice_mut(registers);
        tape.prepare(registers);
        work(registers, bytemuck::cast_slice_mut(tangents))
    })
}

impl<G: Geometry, const N: usize> Kernel for TextKernel<G, N> {
    fn forces(&self, chunk: &Chunk, reference: &[Vec3], positions: &[Vec3], forces: &mut [Vec3]) {
        let tape = self.law.stress();
        let samples = Samples::<G, N> { chunk, reference, geometry: PhantomData };
        with_memory(tape, |memory, _| {
            Arch::new().dispatch(Forces {
                samples,
                tape,
                memory,
                positions,
                delta: None,
                scale: 1.0,
                forces,
            });
        });
    }

    fn differential(
        &self,
        chunk: &Chunk,
        reference: &[Vec3],
        positions: &[Vec3],
        delta: &[Vec3],
        scale: f64,
        forces: &mut [Vec3],
    ) {
        let tape = self.law.differential();
        let samples = Samples::<G, N> { chunk, reference, geometry: PhantomData };
        with_memory(tape, |memory, _| {
            Arch::new().dispatch(Forces {
                samples,
                tape,
                memory,
                positions,
                delta: Some(delta),
                scale,
                forces,
            });
        });
    }

    fn energy(&self, chunk: &Chunk, reference: &[Vec3], positions: &[Vec3]) -> f64 {
        let tape = self.law.energy();
        let samples = Samples::<G, N> { chunk, reference, geometry: PhantomData };
        let delta = None;
        with_memory(tape, |memory, _| Arch::new().dispatch(Sum { samples, tape, memory, positions, delta }))
    }

    fn quadratic_form(&self, chunk: &Chunk, reference: &[Vec3], positions: &[Vec3], delta: &[Vec3]) -> f64 {
        let tape = self.law.differential();
        let samples = Samples::<G, N> { chunk, reference, geometry: PhantomData };
        let delta = Some(delta);
        with_memory(tape, |memory, _| Arch::new().dispatch(Sum { samples, tape, memory, positions, delta }))
    }

    fn blocks_at_once(&self) -> usize {
        if G::SAMPLES == Some(1) { ROWS } else { 1 }
    }

    fn blocks(
        &self,
        chunk: &Chunk,
        blocks: Range<usize>,
        reference: &[Vec3],
        positions: &[Vec3],
        scale: f64,
        out: &mut [f64],
    ) {
        let tape = self.law.differential();
        let samples = Samples::<G, N> { chunk, reference, geometry: PhantomData };
        with_memory(tape, |memory, tangents| {
            Arch::new().dispatch(Blocks { samples, tape, memory, tangents, blocks, positions, scale, out });
        });
    }
}

/// The samples of a chunk. Row `r` holds sample `r % count` of block `r / count`.
struct Samples<'a, G, const N: usize> {
    chunk: &'a Chunk,
    reference: &'a [Vec3],
    geometry: PhantomData<G>,
}

impl<G, const N: usize> Clone for Samples<'_, G, N> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<G, const N: usize> Copy for Samples<'_, G, N> {}

impl<'a, G: Geometry, const N: usize> Samples<'a, G, N> {
    #[inline(always)]
    fn per_block(&self) -> usize {
        G::SAMPLES.unwrap_or(self.reference.len() / N)
    }

    /// Rows of one run from `first` on: whole blocks where they fit.
    #[inline(always)]
    fn rows_of_run(&self, first: usize, end: usize) -> Range<usize> {
        let per_block = self.per_block();
        let count = if per_block > ROWS { ROWS } else { ROWS / per_block * per_block };
        first..end.min(first + count)
    }

    #[inline(always)]
    fn reference_of(&self, sample: usize) -> &'a [Vec3] {
        &self.reference[sample * N..(sample + 1) * N]
    }

    #[inline(always)]
    fn group<S: Simd>(&self, simd: S, row: usize, lane: usize) -> Group<'a, S, N> {
        let samples = self.per_block();
        Group { simd, chunk: self.chunk, samples, block: row / samples, lane }
    }

    /// `∂(values)/∂X` of every sample of `rows`, into the lanes that start at `at(entry)`.
    #[inline(always)]
    fn gradients<S: Simd>(
        &self,
        simd: S,
        rows: &Range<usize>,
        values: &[Vec3],
        at: usize,
        memory: &mut [f64],
    ) {
        let per_block = self.per_block();
        let mut lane = 0;
        while lane < LANES {
            let mut x = self.group(simd, rows.start, lane).zeros();
            for row in rows.clone() {
                let group = self.group(simd, row, lane);
                let sample = row % per_block;
                if sample == 0 || row == rows.start {
                    x = group.gather(values);
                }
                let (inverse, _) = group.sample(sample);
                let gradient = G::gradient(&x, self.reference_of(sample)) * inverse;
                store_matrix(&gradient, &mut memory[at + (row - rows.start) * LANES + lane..]);
            }
            lane += S::F64_LANES;
        }
    }
}

/// Entry `e` of a matrix lies `e · BATCH` behind its first.
#[inline(always)]
fn load_matrix<S: Simd>(simd: S, memory: &[f64]) -> Mat3<Lanes<S>> {
    let mut matrix = Mat3::zero(Lanes::constant(simd, 0.0));
    for column in 0..3 {
        matrix.columns[column] = Vec3::new(
            Lanes::load(simd, &memory[3 * column * BATCH..]),
            Lanes::load(simd, &memory[(3 * column + 1) * BATCH..]),
            Lanes::load(simd, &memory[(3 * column + 2) * BATCH..]),
        );
    }
    matrix
}

#[inline(always)]
fn store_matrix<S: Simd>(matrix: &Mat3<Lanes<S>>, memory: &mut [f64]) {
    for column in 0..3 {
        matrix.columns[column].x.store(&mut memory[3 * column * BATCH..]);
        matrix.columns[column].y.store(&mut memory[(3 * column + 1) * BATCH..]);
        matrix.columns[column].z.store(&mut memory[(3 * column + 2) * BATCH..]);
    }
}

/// Forces, or their differential along `delta`.
struct Forces<'a, G, const N: usize> {
    samples: Samples<'a, G, N>,
    tape: &'a Tape,
    memory: &'a mut [f64],
    positions: &'a [Vec3],
    delta: Option<&'a [Vec3]>,
    scale: f64,
    forces: &'a mut [Vec3],
}

impl<G: Geometry, const N: usize> WithSimd for Forces<'_, G, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { samples, tape, memory, .. } = self;
        let per_block = samples.per_block();
        let end = samples.chunk.block_count() * per_block;
        let mut first = 0;
        while first < end {
            let rows = samples.rows_of_run(first, end);
            samples.gradients(simd, &rows, self.positions, tape.deformation(0), memory);
            if let Some(delta) = self.delta {
                samples.gradients(simd, &rows, delta, tape.variation(0), memory);
            }
            tape.run(simd, Part::All, rows.len() * LANES, memory);
            let mut lane = 0;
            while lane < LANES {
                let mut f = samples.group(simd, first, lane).zeros();
                for row in rows.clone() {
                    let group = samples.group(simd, row, lane);
                    let sample = row % per_block;
                    if sample == 0 {
                        f = group.zeros();
                    }
                    let (inverse, volume) = group.sample(sample);
                    let P = load_matrix(simd, &memory[tape.output(0, 0) + (row - first) * LANES + lane..]);
                    // H = V P X_ξ⁻ᵀ
                    let weight = volume * self.scale;
                    G::spread(
                        &P.mul_transpose(&inverse).scaled(weight),
                        samples.reference_of(sample),
                        &mut f,
                    );
                    // an element of more samples than a run takes is scattered in parts
                    if sample + 1 == per_block || row + 1 == rows.end {
                        group.scatter(&f, self.forces);
                    }
                }
                lane += S::F64_LANES;
            }
            first = rows.end;
        }
    }
}

/// `∫ Ψ dV`, or `∫ δP : δF dV` along `delta`.
struct Sum<'a, G, const N: usize> {
    samples: Samples<'a, G, N>,
    tape: &'a Tape,
    memory: &'a mut [f64],
    positions: &'a [Vec3],
    delta: Option<&'a [Vec3]>,
}

impl<G: Geometry, const N: usize> WithSimd for Sum<'_, G, N> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let Self { samples, tape, memory, positions, delta } = self;
        let per_block = samples.per_block();
        let end = samples.chunk.block_count() * per_block;
        let (mut first, mut sum) = (0, 0.0);
        while first < end {
            let rows = samples.rows_of_run(first, end);
            samples.gradients(simd, &rows, positions, tape.deformation(0), memory);
            if let Some(delta) = delta {
                samples.gradients(simd, &rows, delta, tape.variation(0), memory);
            }
            tape.run(simd, Part::All, rows.len() * LANES, memory);
            for row in rows.clone() {
                let mut energies = [0.0; LANES];
                let mut lane = 0;
                while lane < LANES {
                    let (_, volume) = samples.group(simd, row, lane).sample(row % per_block);
                    let at = (row - first) * LANES + lane;
                    let density = if delta.is_some() {
                        let dP = load_matrix(simd, &memory[tape.output(0, 0) + at..]);
                        dP.dot(&load_matrix(simd, &memory[tape.variation(0) + at..]))
                    } else {
                        Lanes::load(simd, &memory[tape.output(0, 0) + at..])
                    };
                    (density * volume).store(&mut energies[lane..]);
                    lane += S::F64_LANES;
                }
                sum += energies.iter().sum::<f64>();
            }
            first = rows.end;
        }
        sum
    }
}

struct Blocks<'a, G, const N: usize> {
    samples: Samples<'a, G, N>,
    tape: &'a Tape,
    memory: &'a mut [f64],
    /// `[entry of F][entry of P][lane]`.
    tangents: &'a mut [f64],
    blocks: Range<usize>,
    positions: &'a [Vec3],
    scale: f64,
    out: &'a mut [f64],
}

impl<G: Geometry, const N: usize> Blocks<'_, G, N> {
    /// `∂P/∂F` of a run, column by column: `δF` is one entry after the other.
    #[inline(always)]
    fn fill_tangents<S: Simd>(&mut self, simd: S, rows: &Range<usize>) {
        let lanes = rows.len() * LANES;
        self.samples.gradients(simd, rows, self.positions, self.tape.deformation(0), self.memory);
        self.tape.run(simd, Part::Deformation, lanes, self.memory);
        for entry in 0..9 {
            self.memory[self.tape.variation(entry)..][..lanes].fill(0.0);
        }
        for entry in 0..9 {
            self.memory[self.tape.variation(entry)..][..lanes].fill(1.0);
            self.tape.run(simd, Part::Variation, lanes, self.memory);
            self.memory[self.tape.variation(entry)..][..lanes].fill(0.0);
            for of_stress in 0..9 {
                let from = &self.memory[self.tape.output(0, of_stress)..][..lanes];
                self.tangents[(9 * entry + of_stress) * BATCH..][..lanes].copy_from_slice(from);
            }
        }
    }
}

impl<G: Geometry, const N: usize> WithSimd for Blocks<'_, G, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        let samples = self.samples;
        let per_block = samples.per_block();
        let (mut first, end) = (self.blocks.start * per_block, self.blocks.end * per_block);
        while first < end {
            let rows = samples.rows_of_run(first, end);
            self.fill_tangents(simd, &rows);
            for row in rows.clone() {
                let mut lane = 0;
                while lane < LANES {
                    self.add_row(
                        samples.group(simd, row, lane),
                        row % per_block,
                        (row - first) * LANES + lane,
                    );
                    lane += S::F64_LANES;
                }
            }
            first = rows.end;
        }
    }
}

impl<G: Geometry, const N: usize> Blocks<'_, G, N> {
    /// Adds the blocks of one sample, whose tangents start at lane `at` of the run.
    #[inline(always)]
    fn add_row<S: Simd>(&mut self, group: Group<'_, S, N>, sample: usize, at: usize) {
        let simd = group.simd;
        let (inverse, volume) = group.sample(sample);
        let weight = volume * -self.scale;
        let reference = self.samples.reference_of(sample);
        let mut gradients = group.zeros();
        // ∂P/∂F : (e_k ⊗ g_b), for k = 0, 1, 2
        let zero = Mat3::zero(weight * 0.0);
        let mut rates = [[zero; 3]; N];
        for b in 0..N {
            // ∂N_b/∂X = X_ξ⁻ᵀ ∂N_b/∂ξ
            let g = reference[b];
            let g =
                Vec3::new(Lanes::constant(simd, g.x), Lanes::constant(simd, g.y), Lanes::constant(simd, g.z));
            gradients[b] = inverse.transpose_apply(g);
        }
        for k in 0..3 {
            let along = |l: usize| (3 * l + k) * 9 * BATCH + at;
            let x = load_matrix(simd, &self.tangents[along(0)..]);
            let y = load_matrix(simd, &self.tangents[along(1)..]);
            let z = load_matrix(simd, &self.tangents[along(2)..]);
            for b in 0..N {
                let g = gradients[b];
                rates[b][k] = x.scaled(g.x) + y.scaled(g.y) + z.scaled(g.z);
            }
        }
        let mut pair = (group.block - self.blocks.start) * N * (N + 1) / 2;
        for a in 0..N {
            let weighted = gradients[a] * weight;
            for b in a..N {
                for k in 0..3 {
                    let column = (rates[b][k] * weighted).to_array();
                    for (row, number) in column.into_iter().enumerate() {
                        let at = (pair * 9 + 3 * k + row) * LANES + group.lane;
                        let slot = &mut self.out[at..at + S::F64_LANES];
                        let sum = if sample == 0 { number } else { Lanes::load(simd, slot) + number };
                        sum.store(slot);
                    }
                }
                pair += 1;
            }
        }
    }
}
