//! Elastic forces of a body of frames: any law, at points that frames carry.

use std::any::Any;
use std::cell::RefCell;

use pulp::Arch;
use souple_engine::state::Pair;
use souple_engine::{CellField, Configuration, Declaration, Energy, Force, Scratch, TangentWeights};
use souple_formal::tape::BATCH;
use souple_math::{Mat3, Vec3};
use souple_solve::BlockMatrix;

use super::kernel::{Blocks, Gradients, MAP_LEN, PAIR_LEN, RATES_LEN, Spread};
use super::layout::{Body, Chunk, FrameMap, chunks};
use super::matrix::{Pairs, Slots};
use super::{Carried, Frame, ROWS_OF_FRAME, Sample, tangents};
use crate::materials::Material;
use crate::solids::layout::{LANES, LaneBlock};
use crate::solids::sample_law::{Answer, ROWS, Run, SampleLaw, TANGENT_LEN};
use crate::solids::{law_of_samples, parallel};

/// Which derivative of the force implicit steps see.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TangentKind {
    /// The exact one: Newton's method is quadratic.
    #[default]
    Full,
    /// Without the stiffness of the stress itself.
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
    pub tangent: TangentKind,
}

/// Elastic forces of a body of frames.
pub struct FramesForce {
    name: String,
    laws: Vec<Box<dyn SampleLaw>>,
    /// By law.
    chunks: Vec<Chunk>,
    law_of_chunk: Vec<usize>,
    pairs: Pairs,
    row_of_frame: Vec<u32>,
    materials: Vec<Material>,
    material_of_cell: Vec<u16>,
    carried_cells: Vec<Carried>,
    cell_volumes: Vec<f64>,
    tangent: TangentKind,
}

/// Sums of chunks, kept between calls.
#[derive(Default)]
struct FramesScratch {
    rows: Vec<Vec3>,
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
            ..
        } = description;
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
            chunks: Vec::new(),
            law_of_chunk: Vec::new(),
            pairs: Pairs::new(&[]),
            row_of_frame: row_of_frame.to_vec(),
            materials: materials.to_vec(),
            material_of_cell: material_of_cell.to_vec(),
            carried_cells: description.carried_cells,
            cell_volumes: description.cell_volumes,
            tangent: description.tangent,
        };
        for (index, material) in found.iter().enumerate() {
            let (law, count) = law_of_samples(&material.law);
            let is_of = |sample: &u32| material_of(*sample).law == material.law;
            let members: Vec<u32> = (0..samples.len() as u32).filter(is_of).collect();
            let parameters_of = |sample: u32| &material_of(sample).parameters[..count];
            force.laws.push(law);
            force.chunks.extend(chunks(&Body { frames, samples, carried }, &members, &parameters_of));
            force.law_of_chunk.resize(force.chunks.len(), index);
        }
        let (mut first_frame, mut first_pair) = (0, 0);
        for chunk in &mut force.chunks {
            (chunk.first_frame, chunk.first_pair) = (first_frame, first_pair);
            first_frame += chunk.frames.len();
            first_pair += chunk.pairs.len();
        }
        force.pairs = Pairs::new(&force.chunks);
        force
    }

    /// Frames that reach a sample, on the average of all eights of neighbours: what a step costs grows with its square.
    pub fn frames_per_sample(&self) -> f64 {
        let members: usize = self.chunks.iter().map(|chunk| chunk.members.len()).sum();
        members as f64 / self.chunks.iter().map(|chunk| chunk.block_count).sum::<usize>() as f64
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
        let partials = &mut FramesScratch::of(scratch).rows;
        partials.resize(self.first_row(self.chunks.len()), Vec3::ZERO);
        let start_of = |chunk: usize| self.first_row(chunk);
        parallel::fill(0..self.chunks.len(), 2, partials, &start_of, &|number, partials| {
            MEMORY.with_borrow_mut(|memory| {
                let work = Work { force: self, number, chunk: &self.chunks[number], memory };
                work.spread(answer, [positions, delta], scale, partials);
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

    fn spread(mut self, answer: Answer, [positions, delta]: [&[Vec3]; 2], scale: f64, partials: &mut [Vec3]) {
        let varies = answer == Answer::Differential;
        self.gather(0, positions);
        if varies {
            self.gather(1, delta);
        }
        let wants_material = varies && self.force.tangent == TangentKind::Material;
        let (law, chunk) = (self.force.law(self.number), self.chunk);
        let places = law.places(answer);
        let Memory { law: memory, stress, sums, own, .. } = &mut *self.memory;
        let memory = lanes_of(memory, places.memory_len);
        law.prepare(answer, memory);
        sums.clear();
        sums.resize(chunk.frames.len() * MAP_LEN, LaneBlock::default());
        for run in runs(chunk) {
            let arch = Arch::new();
            if wants_material {
                second_stress(law, chunk, &run, &own[0], stress);
            }
            if varies {
                let fields = [&own[0][..], &own[1]];
                let starts = [places.deformation, places.variation];
                arch.dispatch(Gradients { chunk, run: &run, fields, out: &mut *memory, starts });
            } else {
                let starts = [places.deformation];
                arch.dispatch(Gradients { chunk, run: &run, fields: [&own[0]], out: &mut *memory, starts });
            }
            law.answer(answer, &run, memory);
            if wants_material {
                // the law may have overwritten what it was given
                let mut variation = [0.0; MATRIX_LEN];
                let out = &mut variation;
                arch.dispatch(Gradients { chunk, run: &run, fields: [&own[1]], out, starts: [0] });
                let second: &[f64] = bytemuck::cast_slice(stress);
                let result = &mut memory[places.result..];
                tangents::subtract_from_differential(second, &variation, result, run.lane_count());
            }
            let stresses = &memory[places.result..];
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

    fn energy(mut self, positions: &[Vec3]) -> f64 {
        self.gather(0, positions);
        let (law, chunk) = (self.force.law(self.number), self.chunk);
        let places = law.places(Answer::Energy);
        let Memory { law: memory, own, .. } = &mut *self.memory;
        let memory = lanes_of(memory, places.memory_len);
        law.prepare(Answer::Energy, memory);
        let mut sum = 0.0;
        for run in runs(chunk) {
            let (out, starts) = (&mut *memory, [places.deformation]);
            Arch::new().dispatch(Gradients { chunk, run: &run, fields: [&own[0]], out, starts });
            law.answer(Answer::Energy, &run, memory);
            for block in run.rows() {
                let densities = &memory[places.result + run.lane_of(block)..];
                for (volume, density) in chunk.samples.volumes(block).iter().zip(densities) {
                    // lanes without a sample may have no energy at all
                    if *volume > 0.0 {
                        sum += volume * density;
                    }
                }
            }
        }
        sum
    }

    fn blocks(mut self, positions: &[Vec3], scale: f64, sums: &mut [f64]) {
        self.gather(0, positions);
        let wants_material = self.force.tangent == TangentKind::Material;
        let (law, chunk) = (self.force.law(self.number), self.chunk);
        let places = law.places(Answer::Differential);
        let Memory { law: memory, stress, tangents, rates, gradients, own, .. } = &mut *self.memory;
        let memory = lanes_of(memory, places.memory_len);
        law.prepare(Answer::Differential, memory);
        let tangents = lanes_of(tangents, TANGENT_LEN * BATCH);
        rates.resize(RATES_LEN, 0.0);
        sums.fill(0.0);
        for run in runs(chunk) {
            let arch = Arch::new();
            if wants_material {
                second_stress(law, chunk, &run, &own[0], stress);
            }
            let (out, starts) = (&mut *memory, [places.deformation]);
            arch.dispatch(Gradients { chunk, run: &run, fields: [&own[0]], out, starts });
            law.tangents(&run, memory, tangents);
            if wants_material {
                tangents::subtract_from_tangents(bytemuck::cast_slice(stress), tangents, run.lane_count());
            }
            arch.dispatch(Blocks { chunk, run: &run, tangents, scale, rates, gradients, sums });
        }
    }
}

/// Writes `S = F⁻¹ P` of a run to the head of `stress`.
fn second_stress(
    law: &dyn SampleLaw,
    chunk: &Chunk,
    run: &Run,
    own: &[FrameMap],
    stress: &mut Vec<LaneBlock>,
) {
    let places = law.places(Answer::Stress);
    let memory = lanes_of(stress, places.memory_len.max(MATRIX_LEN));
    law.prepare(Answer::Stress, memory);
    let mut deformation = [0.0; MATRIX_LEN];
    Arch::new().dispatch(Gradients { chunk, run, fields: [own], out: &mut deformation, starts: [0] });
    for entry in 0..9 {
        let lanes = entry * BATCH..entry * BATCH + run.lane_count();
        memory[places.deformation..][lanes.clone()].copy_from_slice(&deformation[lanes]);
    }
    law.answer(Answer::Stress, run, memory);
    memory.copy_within(places.result..places.result + MATRIX_LEN, 0);
    tangents::second_stress(&deformation, memory, run.lane_count());
}

impl Force for FramesForce {
    fn name(&self) -> &str {
        &self.name
    }

    fn declaration(&self) -> Declaration {
        // small strain knows a rest orientation: a rotated body feels a torque
        let internal = self.materials.iter().all(|material| material.law.is_objective());
        Declaration { internal, ..Declaration::ELASTIC }
    }

    fn new_scratch(&self) -> Scratch {
        Box::new(FramesScratch::default())
    }

    fn energy(&self, at: &Configuration, _: &mut Scratch) -> Energy {
        let stored = parallel::sum(0..self.chunks.len(), &|number| {
            MEMORY.with_borrow_mut(|memory| {
                Work { force: self, number, chunk: &self.chunks[number], memory }.energy(at.positions)
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

    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        if weights.position == 0.0 {
            return;
        }
        let FramesScratch { pairs: sums, slots, .. } = FramesScratch::of(scratch);
        sums.resize(self.first_pair(self.chunks.len()), 0.0);
        let start_of = |chunk: usize| self.first_pair(chunk);
        parallel::fill(0..self.chunks.len(), 2, sums, &start_of, &|number, sums| {
            MEMORY.with_borrow_mut(|memory| {
                let work = Work { force: self, number, chunk: &self.chunks[number], memory };
                work.blocks(at.positions, -weights.position, sums);
            });
        });
        slots.gather(&self.pairs, &self.row_of_frame, sums, matrix);
    }

    fn cell_field(&self, cell: usize, positions: &[Vec3]) -> Option<CellField> {
        let carried = self.carried_cells.get(cell)?;
        let mut F = Mat3::ZERO;
        for (frame, rows) in carried.frames.iter().zip(&carried.rows) {
            let first = self.row_of_frame[*frame as usize] as usize;
            for (position, (_, gradient)) in positions[first..].iter().zip(rows) {
                F += position.outer(*gradient);
            }
        }
        let material = &self.materials[self.material_of_cell[cell] as usize];
        Some(material.field(&F, self.cell_volumes[cell]))
    }

    fn bytes(&self) -> usize {
        let carried = self.carried_cells.iter();
        self.chunks.iter().map(|chunk| size_of::<Chunk>() + chunk.bytes()).sum::<usize>()
            + self.pairs.bytes()
            + 4 * self.row_of_frame.capacity()
            + carried
                .map(|c| 4 * c.frames.capacity() + size_of::<[(f64, Vec3); 4]>() * c.rows.capacity())
                .sum::<usize>()
            + 8 * self.cell_volumes.capacity()
            + 2 * self.material_of_cell.capacity()
    }

    fn scratch_bytes(&self, scratch: &Scratch) -> usize {
        scratch.downcast_ref::<FramesScratch>().map_or(0, |FramesScratch { rows, pairs, slots }| {
            24 * rows.capacity() + 8 * pairs.capacity() + slots.bytes()
        })
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
