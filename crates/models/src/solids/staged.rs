//! The loops over elements in three stages: gradients of a run of samples, the law, forces.
//!
//! Laws and elements do not know each other here, so what is compiled grows with their sum and not with their product,
//! and a law as text is as good as any. Compare [`super::kernel`], where a law and the tetrahedron are one loop.

use std::cell::RefCell;
use std::marker::PhantomData;
use std::ops::Range;

use pulp::{Arch, Simd, WithSimd};
use souple_formal::tape::BATCH;
use souple_math::{Lanes, Mat3, Padded, Vec3};
use souple_mesh::{ElementKind, QuadratureRule};

use super::geometry::Geometry;
use super::group::Group;
use super::kernel::Kernel;
use super::layout::{Chunk, LANES, LaneBlock};
use super::sample_law::{Answer, ROWS, Run, SampleLaw, TANGENT_LEN, load_matrix, store_matrix};

/// [`Kernel`] of a law on elements of geometry `G` with at most `N` nodes, and as many parts.
pub struct Staged<G, const N: usize> {
    law: Box<dyn SampleLaw>,
    /// Nodes of an element.
    nodes: usize,
    /// Of the geometry, sample after sample.
    numbers: Vec<Vec3>,
    samples: usize,
    geometry: PhantomData<G>,
}

thread_local! {
    /// What a law works in; and `∂P/∂F` of a run, `[entry of F][entry of P][lane]`.
    static MEMORY: RefCell<[Vec<LaneBlock>; 2]> = const { RefCell::new([Vec::new(), Vec::new()]) };
}

impl<G: Geometry, const N: usize> Staged<G, N> {
    pub fn new(law: Box<dyn SampleLaw>, kind: ElementKind, rule: &QuadratureRule) -> Self {
        let numbers = rule.points.iter().flat_map(|point| G::numbers(kind, point.position)).collect();
        Self { law, nodes: kind.node_count(), numbers, samples: rule.points.len(), geometry: PhantomData }
    }

    /// Runs `work` with memory for an answer, prepared, and for tangents.
    fn with_memory<T>(&self, answer: Answer, work: impl FnOnce(&mut [f64], &mut [f64]) -> T) -> T {
        MEMORY.with_borrow_mut(|[memory, tangents]| {
            let wanted = self.law.places(answer).memory_len.div_ceil(LANES);
            if memory.len() < wanted {
                memory.resize(wanted, LaneBlock::default());
            }
            tangents.resize(TANGENT_LEN * ROWS, LaneBlock::default());
            let memory = bytemuck::cast_slice_mut(memory);
            self.law.prepare(answer, memory);
            work(memory, bytemuck::cast_slice_mut(tangents))
        })
    }

    fn stage<'a>(&'a self, run: Run<'a>) -> Stage<'a, G, N> {
        Stage { run, numbers: &self.numbers, nodes: self.nodes, geometry: PhantomData }
    }

    fn runs<'a>(&self, chunk: &'a Chunk, blocks: Range<usize>) -> impl Iterator<Item = Run<'a>> {
        runs(chunk, G::SAMPLES.unwrap_or(self.samples), blocks)
    }

    /// Adds `scale` times the answer's stresses, spread to the nodes.
    fn add_spread(
        &self,
        answer: Answer,
        chunk: &Chunk,
        [positions, delta]: [&[Padded]; 2],
        scale: f64,
        forces: &mut [Padded],
    ) {
        let places = self.law.places(answer);
        self.with_memory(answer, |memory, _| {
            for run in self.runs(chunk, 0..chunk.block_count()) {
                let stage = self.stage(run);
                stage.gradients(positions, places.deformation, memory);
                if answer == Answer::Differential {
                    stage.gradients(delta, places.variation, memory);
                }
                self.law.answer(answer, &run, memory);
                let stresses = &memory[places.result..];
                Arch::new().dispatch(Spread { stage, stresses, scale, forces });
            }
        });
    }
}

/// Runs over some blocks of a chunk: whole blocks where they fit.
fn runs(chunk: &Chunk, per_block: usize, blocks: Range<usize>) -> impl Iterator<Item = Run<'_>> {
    let length = if per_block > ROWS { ROWS } else { ROWS / per_block * per_block };
    let end = blocks.end * per_block;
    (blocks.start * per_block..end).step_by(length).map(move |first| Run {
        chunk,
        per_block,
        first,
        end: end.min(first + length),
    })
}

impl<G: Geometry, const N: usize> Kernel for Staged<G, N> {
    fn forces(&self, chunk: &Chunk, _: &[Vec3], positions: &[Padded], forces: &mut [Padded]) {
        self.add_spread(Answer::Stress, chunk, [positions, &[]], 1.0, forces);
    }

    fn differential(
        &self,
        chunk: &Chunk,
        _: &[Vec3],
        positions: &[Padded],
        delta: &[Padded],
        scale: f64,
        forces: &mut [Padded],
    ) {
        self.add_spread(Answer::Differential, chunk, [positions, delta], scale, forces);
    }

    fn energy(&self, chunk: &Chunk, _: &[Vec3], positions: &[Padded]) -> f64 {
        let places = self.law.places(Answer::Energy);
        let mut sum = 0.0;
        self.with_memory(Answer::Energy, |memory, _| {
            for run in self.runs(chunk, 0..chunk.block_count()) {
                self.stage(run).gradients(positions, places.deformation, memory);
                self.law.answer(Answer::Energy, &run, memory);
                let densities = &memory[places.result..];
                sum += integral(&run, |lane| densities[lane]);
            }
        });
        sum
    }

    // ∫ δP : δF dV
    fn quadratic_form(&self, chunk: &Chunk, _: &[Vec3], positions: &[Padded], delta: &[Padded]) -> f64 {
        let places = self.law.places(Answer::Differential);
        let mut sum = 0.0;
        self.with_memory(Answer::Differential, |memory, _| {
            for run in self.runs(chunk, 0..chunk.block_count()) {
                let stage = self.stage(run);
                stage.gradients(positions, places.deformation, memory);
                stage.gradients(delta, places.variation, memory);
                self.law.answer(Answer::Differential, &run, memory);
                let (dF, dP) = (&memory[places.variation..], &memory[places.result..]);
                sum += integral(&run, |lane| {
                    (0..9).map(|entry| dP[entry * BATCH + lane] * dF[entry * BATCH + lane]).sum()
                });
            }
        });
        sum
    }

    fn blocks_at_once(&self) -> usize {
        if G::SAMPLES == Some(1) { ROWS } else { 1 }
    }

    fn blocks(
        &self,
        chunk: &Chunk,
        blocks: Range<usize>,
        reference: &[Vec3],
        positions: &[Padded],
        scale: f64,
        out: &mut [f64],
    ) {
        let places = self.law.places(Answer::Differential);
        let first_block = blocks.start;
        self.with_memory(Answer::Differential, |memory, tangents| {
            for run in self.runs(chunk, blocks) {
                let stage = self.stage(run);
                stage.gradients(positions, places.deformation, memory);
                self.law.tangents(&run, memory, tangents);
                Arch::new().dispatch(Blocks { stage, reference, tangents, first_block, scale, out });
            }
        });
    }
}

/// Sums over a run the volumes of samples times `density(lane)`, in their order.
#[inline(always)]
fn integral(run: &Run, density: impl Fn(usize) -> f64) -> f64 {
    let mut sum = 0.0;
    for row in run.rows() {
        let volumes = run.volumes(row);
        for (lane, volume) in volumes.iter().enumerate() {
            sum += volume * density(run.lane_of(row) + lane);
        }
    }
    sum
}

/// The elements of a run.
struct Stage<'a, G, const N: usize> {
    run: Run<'a>,
    /// Of the geometry, sample after sample.
    numbers: &'a [Vec3],
    nodes: usize,
    geometry: PhantomData<G>,
}

impl<'a, G: Geometry, const N: usize> Stage<'a, G, N> {
    /// Writes `∂(values)/∂X` of every sample into the lanes that start at `at`.
    fn gradients(&self, values: &[Padded], at: usize, memory: &mut [f64]) {
        Arch::new().dispatch(Gradients { stage: self, values, out: &mut memory[at..] });
    }

    #[inline(always)]
    fn nodes(&self) -> usize {
        G::NODES.unwrap_or(self.nodes)
    }

    #[inline(always)]
    fn parts(&self) -> usize {
        G::PARTS.unwrap_or(self.nodes)
    }

    #[inline(always)]
    fn per_block(&self) -> usize {
        G::SAMPLES.unwrap_or(self.run.per_block)
    }

    #[inline(always)]
    fn numbers_of(&self, sample: usize) -> &'a [Vec3] {
        let count = self.numbers.len() / self.per_block();
        &self.numbers[sample * count..(sample + 1) * count]
    }

    #[inline(always)]
    fn group<S: Simd>(&self, simd: S, row: usize, lane: usize) -> Group<'a, S, N> {
        let samples = self.per_block();
        Group { simd, chunk: self.run.chunk, nodes: self.nodes(), samples, block: row / samples, lane }
    }
}

struct Gradients<'a, G, const N: usize> {
    stage: &'a Stage<'a, G, N>,
    values: &'a [Padded],
    out: &'a mut [f64],
}

impl<G: Geometry, const N: usize> WithSimd for Gradients<'_, G, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { stage, values, out } = self;
        let run = &stage.run;
        let mut lane = 0;
        while lane < LANES {
            let mut x = stage.group(simd, run.first, lane).zeros();
            for row in run.rows() {
                let group = stage.group(simd, row, lane);
                let sample = row % stage.per_block();
                // one sample at a time: a processor waits for a few lines of its cache, not for those of a whole block
                group.prefetch(1, sample);
                if sample == 0 || row == run.first {
                    x = group.gather(values);
                    G::to_parts(&mut x[..stage.parts()], stage.numbers);
                }
                let (inverse, _) = group.sample(sample);
                let gradient = G::gradient(&x[..stage.parts()], stage.numbers_of(sample)) * inverse;
                store_matrix(&gradient, &mut out[run.lane_of(row) + lane..]);
            }
            lane += S::F64_LANES;
        }
    }
}

struct Spread<'a, G, const N: usize> {
    stage: Stage<'a, G, N>,
    stresses: &'a [f64],
    scale: f64,
    forces: &'a mut [Padded],
}

impl<G: Geometry, const N: usize> WithSimd for Spread<'_, G, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { stage, stresses, scale, forces } = self;
        let run = &stage.run;
        let mut lane = 0;
        while lane < LANES {
            let mut f = stage.group(simd, run.first, lane).zeros();
            for row in run.rows() {
                let group = stage.group(simd, row, lane);
                let sample = row % stage.per_block();
                let (inverse, volume) = group.sample(sample);
                let P = load_matrix(simd, &stresses[run.lane_of(row) + lane..]);
                // H = V P X_ξ⁻ᵀ
                let H = P.mul_transpose(&inverse).scaled(volume * scale);
                G::spread(&H, stage.numbers_of(sample), &mut f[..stage.parts()]);
                // an element of more samples than a run takes is scattered in parts
                if sample + 1 == stage.per_block() || row + 1 == run.end {
                    G::to_nodes(&mut f[..stage.parts()], stage.numbers);
                    group.scatter(&f, forces);
                    f = group.zeros();
                }
            }
            lane += S::F64_LANES;
        }
    }
}

struct Blocks<'a, G, const N: usize> {
    stage: Stage<'a, G, N>,
    /// `∂N_a/∂ξ`, sample after sample.
    reference: &'a [Vec3],
    tangents: &'a [f64],
    /// Block of lanes whose matrices come first in `out`.
    first_block: usize,
    scale: f64,
    out: &'a mut [f64],
}

impl<G: Geometry, const N: usize> WithSimd for Blocks<'_, G, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        for row in self.stage.run.rows() {
            let mut lane = 0;
            while lane < LANES {
                let group = self.stage.group(simd, row, lane);
                self.add_sample(&group, row % self.stage.per_block(), self.stage.run.lane_of(row) + lane);
                lane += S::F64_LANES;
            }
        }
    }
}

impl<G: Geometry, const N: usize> Blocks<'_, G, N> {
    /// Adds the blocks of one sample, whose tangents start at lane `at` of the run.
    #[inline(always)]
    fn add_sample<S: Simd>(&mut self, group: &Group<'_, S, N>, sample: usize, at: usize) {
        let (simd, nodes) = (group.simd, group.nodes);
        let (inverse, volume) = group.sample(sample);
        let weight = volume * -self.scale;
        let gradients = group.gradients(&inverse, &self.reference[sample * nodes..(sample + 1) * nodes]);
        // ∂P/∂F : (e_k ⊗ g_b), for k = 0, 1, 2
        let mut rates = [[Mat3::zero(Lanes::constant(simd, 0.0)); 3]; N];
        for k in 0..3 {
            // entry (k, l) of F is the (3 l + k)-th
            let x = load_matrix(simd, &self.tangents[k * 9 * BATCH + at..]);
            let y = load_matrix(simd, &self.tangents[(3 + k) * 9 * BATCH + at..]);
            let z = load_matrix(simd, &self.tangents[(6 + k) * 9 * BATCH + at..]);
            for b in 0..nodes {
                let g = gradients[b];
                rates[b][k] = x.scaled(g.x) + y.scaled(g.y) + z.scaled(g.z);
            }
        }
        let mut pair = (group.block - self.first_block) * nodes * (nodes + 1) / 2;
        for a in 0..nodes {
            let weighted = gradients[a] * weight;
            for b in a..nodes {
                for k in 0..3 {
                    let column = (rates[b][k] * weighted).to_array();
                    for i in 0..3 {
                        let at = (pair * 9 + 3 * k + i) * LANES;
                        group.add_or_put(sample, column[i], &mut self.out[at..at + LANES]);
                    }
                }
                pair += 1;
            }
        }
    }
}
