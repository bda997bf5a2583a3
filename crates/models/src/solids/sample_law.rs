//! Laws as [`super::staged`] asks them: many samples at once, without elements.

use std::marker::PhantomData;
use std::sync::Arc;

use pulp::{Arch, Simd, WithSimd};
use souple_formal::tape::{BATCH, Part, Tape};
use souple_math::{Lanes, Mat3, Vec3};

use super::group::Group;
use super::layout::{Chunk, LANES};
use crate::materials::{Law, TextLaw};

/// Rows of samples that a run takes: of one sample in each lane of a block.
pub const ROWS: usize = BATCH / LANES;
/// Entries of `∂P/∂F`.
pub const TANGENT_LEN: usize = 81;

/// Samples side by side: row `r` holds sample `r % per_block` of block `r / per_block`.
#[derive(Clone, Copy)]
pub struct Run<'a> {
    pub chunk: &'a Chunk,
    /// Samples of an element.
    pub per_block: usize,
    /// First row; at most [`ROWS`] before `end`.
    pub first: usize,
    pub end: usize,
}

impl Run<'_> {
    pub fn rows(&self) -> std::ops::Range<usize> {
        self.first..self.end
    }

    /// Samples, lanes without an element included.
    pub fn lane_count(&self) -> usize {
        (self.end - self.first) * LANES
    }

    /// Volumes of the lanes of a row.
    #[inline(always)]
    pub fn volumes(&self, row: usize) -> &[f64; LANES] {
        self.chunk.volumes(row / self.per_block, row % self.per_block, self.per_block)
    }

    /// The first lane of a row in the run.
    #[inline(always)]
    pub fn lane_of(&self, row: usize) -> usize {
        (row - self.first) * LANES
    }
}

/// What is wanted of a law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// `F` to `Ψ`.
    Energy,
    /// `F` to `P`.
    Stress,
    /// `F` and `δF` to `δP`.
    Differential,
}

/// Where the lanes of entry 0 start in the memory of an answer; those of entry `e`, by columns, `e · BATCH` behind.
#[derive(Clone, Copy, Debug)]
pub struct Places {
    pub deformation: usize,
    /// Of `δF`, where the answer wants it.
    pub variation: usize,
    pub result: usize,
    /// Numbers that the memory holds.
    pub memory_len: usize,
}

/// A law over samples side by side.
pub trait SampleLaw: Send + Sync {
    fn places(&self, answer: Answer) -> Places;

    /// Writes what every run on a memory finds there.
    fn prepare(&self, answer: Answer, memory: &mut [f64]);

    /// Writes the results of a run whose `F` and `δF` are in the memory.
    fn answer(&self, answer: Answer, run: &Run, memory: &mut [f64]);

    /// Writes `∂P/∂F`, `[entry of F][entry of P][lane]`, in the memory of [`Answer::Differential`].
    fn tangents(&self, run: &Run, memory: &mut [f64], tangents: &mut [f64]);
}

/// A law compiled with the program; its numbers lie in the chunks.
pub struct Compiled<L>(PhantomData<L>);

impl<L> Default for Compiled<L> {
    fn default() -> Self {
        Self(PhantomData)
    }
}

const DEFORMATION: usize = 0;
const VARIATION: usize = 9 * BATCH;
const RESULT: usize = 18 * BATCH;

impl<L: Law> SampleLaw for Compiled<L> {
    fn places(&self, _: Answer) -> Places {
        Places {
            deformation: DEFORMATION,
            variation: VARIATION,
            result: RESULT,
            memory_len: RESULT + 9 * BATCH,
        }
    }

    fn prepare(&self, _: Answer, _: &mut [f64]) {}

    fn answer(&self, answer: Answer, run: &Run, memory: &mut [f64]) {
        Arch::new().dispatch(Answering::<L> { answer, run, memory, law: PhantomData });
    }

    fn tangents(&self, run: &Run, memory: &mut [f64], tangents: &mut [f64]) {
        Arch::new().dispatch(Tangents::<L> { run, memory, tangents, law: PhantomData });
    }
}

/// A register's worth of samples and the place of its first lane.
#[inline(always)]
pub fn group<'a, S: Simd>(simd: S, run: &Run<'a>, row: usize, lane: usize) -> (Group<'a, S, 0>, usize) {
    let (samples, block) = (run.per_block, row / run.per_block);
    (Group { simd, chunk: run.chunk, nodes: 0, samples, block, lane }, run.lane_of(row) + lane)
}

struct Answering<'a, L> {
    answer: Answer,
    run: &'a Run<'a>,
    memory: &'a mut [f64],
    law: PhantomData<L>,
}

impl<L: Law> WithSimd for Answering<'_, L> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { answer, run, memory, .. } = self;
        for row in run.rows() {
            let mut lane = 0;
            while lane < LANES {
                let (group, at) = group(simd, run, row, lane);
                let parameters = group.parameters::<L::Parameters<Lanes<S>>>();
                let F = load_matrix(simd, &memory[DEFORMATION + at..]);
                match answer {
                    Answer::Energy => {
                        L::energy_density(&parameters, &F).store(&mut memory[RESULT + at..]);
                    }
                    Answer::Stress => {
                        store_matrix(&L::stress(&parameters, &F), &mut memory[RESULT + at..]);
                    }
                    Answer::Differential => {
                        let dF = load_matrix(simd, &memory[VARIATION + at..]);
                        let dP = L::stress_differential(&parameters, &L::at(&parameters, &F), &dF);
                        store_matrix(&dP, &mut memory[RESULT + at..]);
                    }
                }
                lane += S::F64_LANES;
            }
        }
    }
}

struct Tangents<'a, L> {
    run: &'a Run<'a>,
    memory: &'a [f64],
    tangents: &'a mut [f64],
    law: PhantomData<L>,
}

impl<L: Law> WithSimd for Tangents<'_, L> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { run, memory, tangents, .. } = self;
        for row in run.rows() {
            let mut lane = 0;
            while lane < LANES {
                let (group, at) = group(simd, run, row, lane);
                let parameters = group.parameters::<L::Parameters<Lanes<S>>>();
                let point = L::at(&parameters, &load_matrix(simd, &memory[DEFORMATION + at..]));
                for entry in 0..9 {
                    let mut unit = [0.0; 9];
                    unit[entry] = 1.0;
                    let mut dF = Mat3::zero(Lanes::constant(simd, 0.0));
                    for column in 0..3 {
                        dF.columns[column] = Vec3::new(
                            Lanes::constant(simd, unit[3 * column]),
                            Lanes::constant(simd, unit[3 * column + 1]),
                            Lanes::constant(simd, unit[3 * column + 2]),
                        );
                    }
                    let dP = L::stress_differential(&parameters, &point, &dF);
                    store_matrix(&dP, &mut tangents[9 * entry * BATCH + at..]);
                }
                lane += S::F64_LANES;
            }
        }
    }
}

/// A law as text, its numbers constants of its tapes.
pub struct Taped(pub Arc<TextLaw>);

impl Taped {
    fn tape(&self, answer: Answer) -> &Tape {
        match answer {
            Answer::Energy => self.0.energy(),
            Answer::Stress => self.0.stress(),
            Answer::Differential => self.0.differential(),
        }
    }
}

impl SampleLaw for Taped {
    fn places(&self, answer: Answer) -> Places {
        let tape = self.tape(answer);
        Places {
            deformation: tape.deformation(0),
            variation: tape.variation(0),
            result: tape.output(0, 0),
            memory_len: tape.memory_len(),
        }
    }

    fn prepare(&self, answer: Answer, memory: &mut [f64]) {
        self.tape(answer).prepare(memory);
    }

    fn answer(&self, answer: Answer, run: &Run, memory: &mut [f64]) {
        self.tape(answer).run_here(Part::All, run.lane_count(), memory);
    }

    // column by column: δF is one entry after the other
    fn tangents(&self, run: &Run, memory: &mut [f64], tangents: &mut [f64]) {
        let (tape, lanes) = (self.tape(Answer::Differential), run.lane_count());
        tape.run_here(Part::Deformation, lanes, memory);
        for entry in 0..9 {
            memory[tape.variation(entry)..][..lanes].fill(0.0);
        }
        for entry in 0..9 {
            memory[tape.variation(entry)..][..lanes].fill(1.0);
            tape.run_here(Part::Variation, lanes, memory);
            memory[tape.variation(entry)..][..lanes].fill(0.0);
            for of_stress in 0..9 {
                let from = &memory[tape.output(0, of_stress)..][..lanes];
                tangents[(9 * entry + of_stress) * BATCH..][..lanes].copy_from_slice(from);
            }
        }
    }
}

/// Entry `e` of a matrix lies `e · BATCH` behind its first.
#[inline(always)]
pub fn load_matrix<S: Simd>(simd: S, memory: &[f64]) -> Mat3<Lanes<S>> {
    // looked at once: no entry has to be checked
    let memory = &memory[..8 * BATCH + S::F64_LANES];
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
pub fn store_matrix<S: Simd>(matrix: &Mat3<Lanes<S>>, memory: &mut [f64]) {
    let memory = &mut memory[..8 * BATCH + S::F64_LANES];
    for column in 0..3 {
        matrix.columns[column].x.store(&mut memory[3 * column * BATCH..]);
        matrix.columns[column].y.store(&mut memory[(3 * column + 1) * BATCH..]);
        matrix.columns[column].z.store(&mut memory[(3 * column + 2) * BATCH..]);
    }
}
