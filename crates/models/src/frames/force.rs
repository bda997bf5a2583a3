//! Elastic forces of a body of frames: any law, at points that frames carry.

use std::any::Any;
use std::cell::RefCell;
use std::sync::atomic::{AtomicBool, Ordering};

use pulp::Arch;
use souple_engine::state::Pair;
use souple_engine::{
    CellField, Configuration, Curvature, Declaration, Energy, Force, Scratch, TangentWeights,
};
use souple_formal::tape::BATCH;
use souple_math::{Mat3, Vec3};
use souple_solve::{BlockMatrix, dense};

use super::kernel::{Blocks, Gradients, MAP_LEN, PAIR_LEN, RATES_LEN, Spread};
use super::layout::{Body, Chunk, FrameMap, chunks};
use super::matrix::{Pairs, Slots};
use super::{Carried, Frame, ROWS_OF_FRAME, Sample, tangents};
use crate::materials::{Material, MaterialLaw, Oriented};
use crate::solids::layout::{LANES, LaneBlock};
use crate::solids::sample_law::{Answer, ROWS, Run, SampleLaw, TANGENT_LEN};
use crate::solids::{law_of_samples, parallel, turned};

/// Which derivative of the force implicit steps see.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TangentKind {
    /// The exact one: Newton's method is quadratic.
    #[default]
    Full,
    /// Without the stiffness of the stress itself, which laws of small strain have none of.
    Material,
}

/// What a body of frames is made of.
pub struct FramesDescription<'a> {
    pub name: String,
    /// At rest.
    pub frames: &'a [Frame],
    /// Row of each frame's origin; its axes follow.
    pub row_of_frame: &'a [u32],
    pub samples: &'a [Sample],
    /// What frames have to say at each sample.
    pub carried: &'a [Carried],
    /// The same at the middle of each cell of the shape, for what is read off cells.
    pub carried_cells: Vec<Carried>,
    /// Rest volume of each cell [m³].
    pub cell_volumes: Vec<f64>,
    pub materials: &'a [Material],
    /// Index into `materials` for each cell.
    pub material_of_cell: &'a [u16],
    /// The axes of the law of each cell as columns; none: those of the world. Laws without directions do not read them.
    pub axes: &'a [Mat3],
    pub tangent: TangentKind,
}

/// Elastic forces of a body of frames.
pub struct FramesForce {
    name: String,
    laws: Vec<Box<dyn SampleLaw>>,
    /// Of each law: whether its tangent has a part that stands for the stress itself. `P` of small strain is no `F S`.
    has_stress_part: Vec<bool>,
    /// By law.
    chunks: Vec<Chunk>,
    law_of_chunk: Vec<usize>,
    /// Runs of samples before each chunk, and all of them.
    first_runs: Vec<usize>,
    pairs: Pairs,
    row_of_frame: Vec<u32>,
    materials: Vec<Material>,
    material_of_cell: Vec<u16>,
    axes: Vec<Mat3>,
    carried_cells: Vec<Carried>,
    cell_volumes: Vec<f64>,
    /// Chunk and sample of the samples of each cell, one cell after the other, and where those of each start.
    of_cells: Vec<(u32, u32)>,
    cell_starts: Vec<u32>,
    tangent: TangentKind,
}

/// Sums of chunks, kept between calls, and deformation gradients: products about one configuration have them in common.
#[derive(Default)]
struct FramesScratch {
    /// Rows of the frames that `deformation` is of.
    placed: Vec<Vec3>,
    /// Of each run of samples, as laws take it.
    deformation: Vec<f64>,
    rows: Vec<Vec3>,
    /// Of the pairs of some chunks.
    parts: Vec<f64>,
    /// Of all pairs of frames.
    pairs: Vec<f64>,
    slots: Slots,
}

impl FramesScratch {
    fn of(scratch: &mut Scratch) -> &mut Self {
        scratch.downcast_mut().unwrap_or_else(|| unreachable!("made by this force's own new_scratch"))
    }
}

/// What a thread works in.
#[derive(Default)]
struct Memory {
    law: Vec<LaneBlock>,
    /// For the stress beside a differential.
    stress: Vec<LaneBlock>,
    tangents: Vec<LaneBlock>,
    rates: Vec<f64>,
    gradients: Vec<LaneBlock>,
    definite: dense::Workspace,
    sums: Vec<LaneBlock>,
    /// Maps of a chunk's own frames.
    own: [Vec<FrameMap>; 2],
}

thread_local! {
    static MEMORY: RefCell<Memory> = RefCell::default();
}

/// Lanes of a matrix, the longest that laws write.
const MATRIX_LEN: usize = 9 * BATCH;

impl FramesForce {
    pub fn new(description: FramesDescription) -> Self {
        let FramesDescription {
            name,
            frames,
            row_of_frame,
            samples,
            carried,
            materials,
            material_of_cell,
            axes,
            ..
        } = description;
        let numbers_of_axes: Vec<_> = axes.iter().map(turned::numbers).collect();
        let material_of =
            |sample: u32| &materials[material_of_cell[samples[sample as usize].cell as usize] as usize];
        // materials of one law share its loops, with numbers of their own
        let mut found: Vec<&Material> = Vec::new();
        for material in materials {
            if found.iter().all(|known| known.law != material.law) {
                found.push(material);
            }
        }
        let mut force = Self {
            name,
            laws: Vec::new(),
            has_stress_part: Vec::new(),
            chunks: Vec::new(),
            law_of_chunk: Vec::new(),
            first_runs: vec![0],
            pairs: Pairs::new(&[]),
            row_of_frame: row_of_frame.to_vec(),
            materials: materials.to_vec(),
            material_of_cell: material_of_cell.to_vec(),
            axes: axes.to_vec(),
            carried_cells: description.carried_cells,
            cell_volumes: description.cell_volumes,
            of_cells: Vec::new(),
            cell_starts: vec![0],
            tangent: description.tangent,
        };
        for (index, material) in found.iter().enumerate() {
            let (law, count) = law_of_samples(&material.law, !axes.is_empty());
            let is_of = |sample: &u32| material_of(*sample).law == material.law;
            let members: Vec<u32> = (0..samples.len() as u32).filter(is_of).collect();
            let parameters_of = |sample: u32| match &material_of(sample).law {
                MaterialLaw::Known(_) => &material_of(sample).parameters[..count],
                MaterialLaw::Text(_) => {
                    let axes = numbers_of_axes.get(samples[sample as usize].cell as usize);
                    axes.map_or(&[][..], |axes| &axes[..])
                }
            };
            force.laws.push(law);
            force.has_stress_part.push(material.law.is_objective());
            force.chunks.extend(chunks(&Body { frames, samples, carried }, &members, &parameters_of));
            force.law_of_chunk.resize(force.chunks.len(), index);
        }
        let (mut first_frame, mut first_pair) = (0, 0);
        for chunk in &mut force.chunks {
            (chunk.first_frame, chunk.first_pair) = (first_frame, first_pair);
            first_frame += chunk.frames.len();
            first_pair += chunk.pairs.len();
            let runs = force.first_runs.last().map_or(0, |first| first + chunk.block_count.div_ceil(ROWS));
            force.first_runs.push(runs);
        }
        force.pairs = Pairs::new(&force.chunks);
        force.sort_by_cells();
        force
    }

    fn sort_by_cells(&mut self) {
        let of_chunk = |(number, chunk): (usize, &Chunk)| {
            let samples = chunk.cells.iter().enumerate();
            samples.map(|(sample, cell)| (*cell, number as u32, sample as u32)).collect::<Vec<_>>()
        };
        let mut all: Vec<(u32, u32, u32)> = self.chunks.iter().enumerate().flat_map(of_chunk).collect();
        all.sort_unstable();
        let end = |cell: usize| all.partition_point(|(of, ..)| *of as usize <= cell) as u32;
        self.cell_starts.extend((0..self.material_of_cell.len()).map(end));
        self.of_cells = all.into_iter().map(|(_, chunk, sample)| (chunk, sample)).collect();
    }

    fn rows_of<'a>(&'a self, chunk: &'a Chunk) -> impl Iterator<Item = usize> + 'a {
        let rows = |frame: &u32| {
            let first = self.row_of_frame[*frame as usize] as usize;
            first..first + ROWS_OF_FRAME
        };
        chunk.frames.iter().flat_map(rows)
    }

    fn law(&self, chunk: usize) -> &dyn SampleLaw {
        self.laws[self.law_of_chunk[chunk]].as_ref()
    }

    /// Whether something is taken off the tangent of the law of a chunk.
    fn leaves_out_stress_of(&self, chunk: usize) -> bool {
        self.tangent == TangentKind::Material && self.has_stress_part[self.law_of_chunk[chunk]]
    }

    /// Where the sums over rows of a chunk start.
    fn first_row(&self, chunk: usize) -> usize {
        let frame = match self.chunks.get(chunk) {
            Some(chunk) => chunk.first_frame,
            None => self.chunks.last().map_or(0, |chunk| chunk.first_frame + chunk.frames.len()),
        };
        frame * ROWS_OF_FRAME
    }

    fn first_pair(&self, chunk: usize) -> usize {
        let pair = match self.chunks.get(chunk) {
            Some(chunk) => chunk.first_pair,
            None => self.chunks.last().map_or(0, |chunk| chunk.first_pair + chunk.pairs.len()),
        };
        pair * PAIR_LEN
    }

    /// Adds `scale` times the spread answers of all samples to `out`.
    fn add_spread(
        &self,
        answer: Answer,
        [positions, delta]: [&[Vec3]; 2],
        scale: f64,
        scratch: &mut Scratch,
        out: &mut [Vec3],
    ) {
        let scratch = FramesScratch::of(scratch);
        self.place(positions, scratch);
        let FramesScratch { deformation, rows: partials, .. } = scratch;
        partials.resize(self.first_row(self.chunks.len()), Vec3::ZERO);
        let start_of = |chunk: usize| self.first_row(chunk);
        parallel::fill(0..self.chunks.len(), 2, partials, &start_of, &|number, partials| {
            MEMORY.with_borrow_mut(|memory| {
                let work = Work { force: self, number, chunk: &self.chunks[number], memory };
                work.spread(answer, (deformation, delta), scale, partials);
            });
        });
        for chunk in &self.chunks {
            let partials = &partials[chunk.first_frame * ROWS_OF_FRAME..];
            for (row, partial) in self.rows_of(chunk).zip(partials) {
                out[row] += *partial;
            }
        }
    }
}

/// Chunks whose blocks are summed before those of others are made.
const CHUNKS_AT_ONCE: usize = 8;

/// Numbers that a run has of deformation gradients.
const DEFORMATION_LEN: usize = MATRIX_LEN;

impl FramesForce {
    /// Where the deformation gradients of a chunk start.
    fn first_deformation(&self, chunk: usize) -> usize {
        self.first_runs[chunk] * DEFORMATION_LEN
    }

    /// Deformation gradients where frames stand, unless they stood there before.
    fn place(&self, positions: &[Vec3], scratch: &mut FramesScratch) {
        let FramesScratch { placed, deformation, .. } = scratch;
        let rows = |first: &u32| {
            let first = *first as usize;
            &positions[first..first + ROWS_OF_FRAME]
        };
        let now = self.row_of_frame.iter().flat_map(rows);
        if placed.len() == ROWS_OF_FRAME * self.row_of_frame.len() && now.clone().eq(placed.iter()) {
            return;
        }
        placed.clear();
        placed.extend(now);
        deformation.resize(self.first_deformation(self.chunks.len()), 0.0);
        let start_of = |chunk: usize| self.first_deformation(chunk);
        parallel::fill(0..self.chunks.len(), 2, deformation, &start_of, &|number, deformation| {
            MEMORY.with_borrow_mut(|memory| {
                let work = Work { force: self, number, chunk: &self.chunks[number], memory };
                work.place(positions, deformation);
            });
        });
    }
}

/// Work on one chunk.
struct Work<'a> {
    force: &'a FramesForce,
    number: usize,
    chunk: &'a Chunk,
    memory: &'a mut Memory,
}

fn lanes_of(memory: &mut Vec<LaneBlock>, numbers: usize) -> &mut [f64] {
    let wanted = numbers.div_ceil(LANES);
    if memory.len() < wanted {
        memory.resize(wanted, LaneBlock::default());
    }
    bytemuck::cast_slice_mut(memory)
}

/// Runs of a chunk, as many rows of samples as a law takes at once.
fn runs(chunk: &Chunk) -> impl Iterator<Item = Run<'_>> {
    let run =
        |first| Run { chunk: &chunk.samples, per_block: 1, first, end: chunk.block_count.min(first + ROWS) };
    (0..chunk.block_count).step_by(ROWS).map(run)
}

impl Work<'_> {
    fn gather(&mut self, which: usize, values: &[Vec3]) {
        let own = &mut self.memory.own[which];
        own.clear();
        own.extend(self.chunk.maps_of(self.force.rows_of(self.chunk).map(|row| values[row])));
    }

    /// Deformation gradients of all samples.
    fn place(mut self, positions: &[Vec3], deformation: &mut [f64]) {
        self.gather(0, positions);
        let (chunk, own) = (self.chunk, &self.memory.own[0]);
        for (run, out) in runs(chunk).zip(deformation.chunks_exact_mut(DEFORMATION_LEN)) {
            Arch::new().dispatch(Gradients { chunk, run: &run, field: own, out, start: 0 });
        }
    }

    /// The chunk's own part of the deformation gradients of all.
    fn own_deformation<'d>(&self, deformation: &'d [f64]) -> std::slice::ChunksExact<'d, f64> {
        let range = self.force.first_deformation(self.number)..self.force.first_deformation(self.number + 1);
        deformation[range].chunks_exact(DEFORMATION_LEN)
    }

    fn spread(
        mut self,
        answer: Answer,
        (deformation, delta): (&[f64], &[Vec3]),
        scale: f64,
        partials: &mut [Vec3],
    ) {
        let varies = answer == Answer::Differential;
        if varies {
            self.gather(1, delta);
        }
        let deformation = self.own_deformation(deformation);
        let leaves_out_stress = varies && self.force.leaves_out_stress_of(self.number);
        let (law, chunk) = (self.force.law(self.number), self.chunk);
        let places = law.places(answer);
        let Memory { law: memory, stress, sums, own, .. } = &mut *self.memory;
        let memory = lanes_of(memory, places.memory_len);
        law.prepare(answer, memory);
        sums.clear();
        sums.resize(chunk.frames.len() * MAP_LEN, LaneBlock::default());
        for (run, deformation) in runs(chunk).zip(deformation) {
            let arch = Arch::new();
            if leaves_out_stress {
                second_stress(law, &run, deformation, stress);
            }
            give(&run, deformation, &mut memory[places.deformation..]);
            if varies {
                let (field, start) = (&own[1][..], places.variation);
                arch.dispatch(Gradients { chunk, run: &run, field, out: &mut *memory, start });
            }
            law.answer(answer, &run, memory);
            if leaves_out_stress {
                // the law may have overwritten what it was given
                let mut variation = [0.0; MATRIX_LEN];
                let out = &mut variation;
                arch.dispatch(Gradients { chunk, run: &run, field: &own[1], out, start: 0 });
                let second: &[f64] = bytemuck::cast_slice(stress);
                let result = &mut memory[places.result..];
                tangents::subtract_from_differential(second, &variation, result, run.lane_count());
            }
            let stresses = &mut memory[places.result..];
            arch.dispatch(Spread { chunk, run: &run, stresses, scale, sums });
        }
        let total = |lanes: &LaneBlock| lanes.0.iter().sum::<f64>();
        let vector = |lanes: &[LaneBlock]| Vec3::new(total(&lanes[0]), total(&lanes[1]), total(&lanes[2]));
        let of_frames = partials.chunks_exact_mut(ROWS_OF_FRAME).zip(sums.chunks_exact(MAP_LEN));
        for (own, (partials, sums)) in of_frames.enumerate() {
            let turn = Mat3::from_columns(vector(&sums[3..]), vector(&sums[6..]), vector(&sums[9..]));
            partials.copy_from_slice(&chunk.forces_of(own, &FrameMap { origin: vector(sums), turn }));
        }
    }

    fn energy(self, deformation: &[f64]) -> f64 {
        let deformation = self.own_deformation(deformation);
        let (law, chunk) = (self.force.law(self.number), self.chunk);
        let places = law.places(Answer::Energy);
        let memory = lanes_of(&mut self.memory.law, places.memory_len);
        law.prepare(Answer::Energy, memory);
        let mut sum = 0.0;
        for (run, deformation) in runs(chunk).zip(deformation) {
            give(&run, deformation, &mut memory[places.deformation..]);
            law.answer(Answer::Energy, &run, memory);
            for block in run.rows() {
                let densities = &memory[places.result + run.lane_of(block)..];
                for (volume, density) in run.volumes(block).iter().zip(densities) {
                    // lanes without a sample may have no energy at all
                    if *volume > 0.0 {
                        sum += volume * density;
                    }
                }
            }
        }
        sum
    }

    /// Whether some of it was turned round to be definite.
    fn blocks(self, deformation: &[f64], curvature: Curvature, scale: f64, sums: &mut [f64]) -> bool {
        let deformation = self.own_deformation(deformation);
        let leaves_out_stress = self.force.leaves_out_stress_of(self.number);
        let (law, chunk) = (self.force.law(self.number), self.chunk);
        let places = law.places(Answer::Differential);
        let Memory { law: memory, stress, tangents, rates, gradients, definite, .. } = &mut *self.memory;
        let memory = lanes_of(memory, places.memory_len);
        law.prepare(Answer::Differential, memory);
        let tangents = lanes_of(tangents, TANGENT_LEN * BATCH);
        rates.resize(RATES_LEN, 0.0);
        sums.fill(0.0);
        let mut turned = false;
        for (run, deformation) in runs(chunk).zip(deformation) {
            let arch = Arch::new();
            if leaves_out_stress {
                second_stress(law, &run, deformation, stress);
            }
            give(&run, deformation, &mut memory[places.deformation..]);
            law.tangents(&run, memory, tangents);
            if leaves_out_stress {
                tangents::subtract_from_tangents(bytemuck::cast_slice(stress), tangents, run.lane_count());
            }
            if curvature == Curvature::Definite {
                turned |= make_definite(&run, tangents, definite);
            }
            arch.dispatch(Blocks { chunk, run: &run, tangents, scale, rates, gradients, sums });
        }
        turned
    }
}

/// Turns round the negative eigenvalues of `∂P/∂F` at the samples of a run; whether there were any.
fn make_definite(run: &Run, tangents: &mut [f64], workspace: &mut dense::Workspace) -> bool {
    let mut turned = false;
    let lanes = run.rows().flat_map(|row| (0..LANES).map(move |lane| (row, lane)));
    for (row, lane) in lanes {
        // lanes without a sample have no volume, and nothing to say
        if run.volumes(row)[lane] == 0.0 {
            continue;
        }
        let place = |entry: usize| entry * BATCH + run.lane_of(row) + lane;
        let mut of_sample: [f64; TANGENT_LEN] = std::array::from_fn(|entry| tangents[place(entry)]);
        if dense::take_absolute(9, &mut of_sample, workspace) {
            turned = true;
            // symmetric to the last bit
            for (row, column) in (0..9).flat_map(|row| (row..9).map(move |column| (row, column))) {
                let number = of_sample[9 * row + column];
                tangents[place(9 * row + column)] = number;
                tangents[place(9 * column + row)] = number;
            }
        }
    }
    turned
}

/// Gives a law the deformation gradients of a run, at the head of `memory`.
fn give(run: &Run, deformation: &[f64], memory: &mut [f64]) {
    let lanes = 0..run.lane_count();
    for (own, given) in memory.chunks_exact_mut(BATCH).zip(deformation.chunks_exact(BATCH)) {
        own[lanes.clone()].copy_from_slice(&given[lanes.clone()]);
    }
}

/// Writes `S = F⁻¹ P` of a run to the head of `stress`.
fn second_stress(law: &dyn SampleLaw, run: &Run, deformation: &[f64], stress: &mut Vec<LaneBlock>) {
    let places = law.places(Answer::Stress);
    let memory = lanes_of(stress, places.memory_len.max(MATRIX_LEN));
    law.prepare(Answer::Stress, memory);
    give(run, deformation, &mut memory[places.deformation..]);
    law.answer(Answer::Stress, run, memory);
    memory.copy_within(places.result..places.result + MATRIX_LEN, 0);
    tangents::second_stress(deformation, memory, run.lane_count());
}

impl FramesForce {
    /// Adds the blocks of all pairs of frames; whether something was turned round to be definite, sample by sample.
    fn assemble(
        &self,
        curvature: Curvature,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) -> bool {
        if weights.position == 0.0 {
            return false;
        }
        let turned = AtomicBool::new(false);
        let scratch = FramesScratch::of(scratch);
        self.place(at.positions, scratch);
        let FramesScratch { deformation, parts, pairs: sums, slots, .. } = scratch;
        sums.clear();
        sums.resize(self.pairs.frames.len() * PAIR_LEN, 0.0);
        // a few chunks at once: the pairs of all would take more memory than all else
        for first in (0..self.chunks.len()).step_by(CHUNKS_AT_ONCE) {
            let some = first..self.chunks.len().min(first + CHUNKS_AT_ONCE);
            let start_of = |chunk: usize| self.first_pair(chunk) - self.first_pair(first);
            let wanted = start_of(some.end);
            if parts.len() < wanted {
                parts.resize(wanted, 0.0);
            }
            parallel::fill(some.clone(), 2, &mut parts[..wanted], &start_of, &|number, parts| {
                MEMORY.with_borrow_mut(|memory| {
                    let work = Work { force: self, number, chunk: &self.chunks[number], memory };
                    if work.blocks(deformation, curvature, -weights.position, parts) {
                        turned.store(true, Ordering::Relaxed);
                    }
                });
            });
            self.pairs.add_parts(self.first_pair(some.start) / PAIR_LEN, &parts[..wanted], sums);
        }
        slots.scatter(&self.pairs, &self.row_of_frame, sums, matrix);
        turned.into_inner()
    }

    /// What is read off some samples of one cell: means over their volumes, of the energy too.
    fn field_of(&self, samples: &[(u32, u32)], material: Oriented, positions: &[Vec3]) -> CellField {
        let (mut maps, mut of_chunk) = (Vec::new(), None);
        let (mut volume, mut current_volume, mut energy, mut mean) = (0.0, 0.0, 0.0, Mat3::ZERO);
        for &(number, sample) in samples {
            let chunk = &self.chunks[number as usize];
            if of_chunk != Some(number) {
                maps = chunk.maps_of(self.rows_of(chunk).map(|row| positions[row])).collect();
                of_chunk = Some(number);
            }
            let F = chunk.deformation(sample as usize, &maps);
            let part = chunk.volume(sample as usize);
            volume += part;
            current_volume += part * F.determinant();
            energy += part * material.energy_density(&F);
            mean += F * part;
        }
        let field = material.field(&(mean * (1.0 / volume)), volume);
        CellField { energy_density: energy / volume, current_volume, ..field }
    }
}

impl Force for FramesForce {
    fn name(&self) -> &str {
        &self.name
    }

    fn leaves_out_stress(&self) -> bool {
        self.tangent == TangentKind::Material && self.has_stress_part.contains(&true)
    }

    fn declaration(&self) -> Declaration {
        // small strain knows a rest orientation: a rotated body feels a torque
        let internal = self.materials.iter().all(|material| material.law.is_objective());
        Declaration { internal, ..Declaration::ELASTIC }
    }

    fn new_scratch(&self) -> Scratch {
        Box::new(FramesScratch::default())
    }

    fn energy(&self, at: &Configuration, scratch: &mut Scratch) -> Energy {
        let scratch = FramesScratch::of(scratch);
        self.place(at.positions, scratch);
        let deformation = &scratch.deformation;
        let stored = parallel::sum(0..self.chunks.len(), &|number| {
            MEMORY.with_borrow_mut(|memory| {
                Work { force: self, number, chunk: &self.chunks[number], memory }.energy(deformation)
            })
        });
        Energy { stored, dissipated: 0.0 }
    }

    fn add_force(&self, at: &Configuration, scratch: &mut Scratch, out: &mut [Vec3]) {
        self.add_spread(Answer::Stress, [at.positions, &[]], -1.0, scratch, out);
    }

    fn add_differential(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        scratch: &mut Scratch,
        out: &mut [Vec3],
    ) {
        if weights.position != 0.0 {
            self.add_spread(Answer::Differential, [at.positions, delta], -weights.position, scratch, out);
        }
    }

    fn visit_cliques(&self, _: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        let mut rows = Vec::with_capacity(2 * ROWS_OF_FRAME);
        for frames in &self.pairs.frames {
            rows.clear();
            for frame in frames {
                let first = self.row_of_frame[*frame as usize];
                rows.extend(first..first + ROWS_OF_FRAME as u32);
            }
            rows.sort_unstable();
            rows.dedup();
            visit(&rows);
        }
    }

    fn reads_cliques_alone(&self) -> bool {
        true
    }

    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        self.assemble(Curvature::Exact, at, weights, scratch, matrix);
    }

    fn add_definite_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) -> bool {
        self.assemble(Curvature::Definite, at, weights, scratch, matrix)
    }

    fn cell_field(&self, cell: usize, positions: &[Vec3]) -> Option<CellField> {
        let carried = self.carried_cells.get(cell)?;
        let material = self.materials[self.material_of_cell[cell] as usize].along(self.axes.get(cell));
        let [start, end] = [cell, cell + 1].map(|at| self.cell_starts[at] as usize);
        if start < end {
            return Some(self.field_of(&self.of_cells[start..end], material, positions));
        }
        // strain is taken elsewhere: there is something to see here, and nothing to sum
        let mut F = Mat3::ZERO;
        for (frame, rows) in carried.frames.iter().zip(&carried.rows) {
            let first = self.row_of_frame[*frame as usize] as usize;
            for (position, (_, gradient)) in positions[first..].iter().zip(rows) {
                F += position.outer(*gradient);
            }
        }
        let seen = material.field(&F, self.cell_volumes[cell]);
        Some(CellField { volume: 0.0, current_volume: 0.0, ..seen })
    }

    fn bytes(&self) -> usize {
        let carried = self.carried_cells.iter();
        self.chunks.iter().map(|chunk| size_of::<Chunk>() + chunk.bytes()).sum::<usize>()
            + self.pairs.bytes()
            + 4 * self.row_of_frame.capacity()
            + 8 * self.first_runs.capacity()
            + carried
                .map(|c| 4 * c.frames.capacity() + size_of::<[(f64, Vec3); 4]>() * c.rows.capacity())
                .sum::<usize>()
            + 8 * self.cell_volumes.capacity()
            + size_of::<(u32, u32)>() * self.of_cells.capacity()
            + 4 * self.cell_starts.capacity()
            + 2 * self.material_of_cell.capacity()
            + size_of::<Mat3>() * self.axes.capacity()
    }

    fn scratch_bytes(&self, scratch: &Scratch) -> usize {
        scratch.downcast_ref::<FramesScratch>().map_or(0, |scratch| {
            let FramesScratch { placed, deformation, rows, parts, pairs, slots } = scratch;
            24 * (placed.capacity() + rows.capacity())
                + 8 * (deformation.capacity() + parts.capacity() + pairs.capacity())
                + slots.bytes()
        })
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
