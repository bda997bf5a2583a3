//! Bodies whose elements change their law while they run: a cheap one until a criterion says that it does not hold there.
//!
//! Every element has one of two laws at a time, which State remembers. After each step criteria are measured; an element
//! that exceeds one takes the second law, and returns to the first when all have fallen below a fraction of their thresholds.
//! Forces are continuous in positions between switches; what energy a switch takes or gives is added up in memory and
//! counts as dissipated, so that the sum of energies closes (Faure 2014, §6.4).

mod criteria;
mod measure;
mod parts;

use std::any::Any;
use std::cell::RefCell;
use std::ops::Range;

use souple_engine::state::Pair;
use souple_engine::{
    Adapted, CellField, Configuration, Curvature, Declaration, Energy, Force, LawChanges, Scratch,
    TangentWeights,
};
use souple_math::{Mat3, Padded, Vec3};
use souple_mesh::{MAX_NODES, Mesh};
use souple_solve::BlockMatrix;

pub use criteria::Criterion;
use criteria::Element;
use measure::{AtRest, Measured};
use parts::{Parts, Split};

use super::assembly::{Assembly, Symmetry};
use super::elements::Batch;
use super::kernel::Kernel;
use super::layout::{Chunk, LANES};
use super::parallel;
use super::stiffness::Shapes;
use super::{FlatCell, Kernels, SolidDescription, SolidForce};
use crate::materials::Material;

/// When elements change their law.
#[derive(Clone, Debug, PartialEq)]
pub struct Adaptation {
    /// Criteria, each with what it may be under the first law.
    pub thresholds: Vec<(Criterion, f64)>,
    /// Fraction of the thresholds below which an element returns to the first law; zero where it never does.
    pub back: f64,
}

/// Elastic forces of a body of two laws.
///
/// Its memory: the law of each cell, 0 or 1; then the energy that switches took; then how many there were.
pub struct AdaptiveForce {
    /// The body under its first law alone, and under its second.
    solids: [SolidForce; 2],
    mesh: Mesh,
    adaptation: Adaptation,
    /// How the cells of every chunk rest.
    rest: Vec<AtRest>,
    /// Cells of the chunks before each, and of all.
    first_cell: Vec<usize>,
}

struct AdaptiveScratch {
    partials: Vec<Vec3>,
    assembly: Assembly,
    parts: Parts,
}

fn of(scratch: &mut Scratch) -> &mut AdaptiveScratch {
    scratch.downcast_mut().unwrap_or_else(|| unreachable!("made by this force's own new_scratch"))
}

thread_local! {
    /// Element blocks under the second law.
    static BLOCKS: RefCell<Vec<f64>> = const { RefCell::new(Vec::new()) };
    /// What criteria are over their thresholds, chunk after chunk.
    static EXCESS: RefCell<Vec<f64>> = const { RefCell::new(Vec::new()) };
}

type SolidBatch = Batch<Box<dyn Kernel>>;

impl AdaptiveForce {
    /// Of a body of volumes or of surface elements: `description` knows the first law of its cells, `seconds` the other one of each of
    /// its materials. Laws know no directions.
    ///
    /// # Errors
    /// A cell is flat or inverted at rest.
    pub fn new(
        description: &SolidDescription,
        seconds: &[Material],
        adaptation: Adaptation,
    ) -> Result<Self, FlatCell> {
        assert_eq!(description.materials.len(), seconds.len(), "every material has a second");
        let laws = [description.materials, seconds].map(Material::all_of_table);
        let under = |materials| SolidDescription { materials, axes: &[], ..description.clone() };
        let [firsts, seconds] = &laws;
        // chunks hold the same cells under either law: those of one shape where one of the two is linear
        let linear: Vec<Material> = firsts
            .iter()
            .zip(seconds)
            .map(|(first, second)| if second.law.is_linear() { second } else { first }.clone())
            .collect();
        let shapes = Shapes::of_linear(&under(&linear));
        let solid = |laws| SolidForce::of_shapes(&under(laws), &shapes, Kernels::FastestAlike);
        let (solids, mesh) = ([solid(firsts)?, solid(seconds)?], description.mesh.clone());
        let chunks = || solids[0].elements.chunks().map(|(_, chunk)| chunk);
        debug_assert!(
            chunks().zip(solids[1].elements.chunks()).all(|(first, (_, second))| first.cells == second.cells),
            "cells are sorted alike under either law"
        );
        let at_rest = |row: &u32| Padded::from(mesh.points[*row as usize - description.first_row]);
        let measures_lengths = adaptation.thresholds.iter().any(|(of, _)| *of == Criterion::Length);
        let of_chunk = |(batch, chunk): (&SolidBatch, &Chunk)| {
            let rows = chunk.rows.iter().map(at_rest).collect();
            AtRest::new(batch.kind, chunk, rows, measures_lengths)
        };
        let rest = solids[0].elements.chunks().map(of_chunk).collect();
        let mut first_cell = vec![0];
        chunks().for_each(|chunk| first_cell.push(first_cell[first_cell.len() - 1] + chunk.cells.len()));
        Ok(Self { solids, mesh, adaptation, rest, first_cell })
    }

    fn laws<'a>(&self, memory: &'a [f64]) -> &'a [f64] {
        &memory[..self.mesh.cell_count()]
    }

    /// Runs `visit` with the cell as it rests and stands.
    fn with_cell<T>(&self, cell: usize, positions: &[Vec3], visit: impl FnOnce(&Element) -> T) -> T {
        let of_mesh = self.mesh.cell(cell as u32).unwrap_or_else(|| unreachable!("a cell of the mesh"));
        let (mut rest, mut now) = ([Vec3::ZERO; MAX_NODES], [Vec3::ZERO; MAX_NODES]);
        let first_row = self.solids[0].rows().start;
        for (a, node) in of_mesh.nodes.iter().enumerate() {
            rest[a] = self.mesh.points[*node as usize];
            now[a] = positions[first_row + *node as usize];
        }
        let count = of_mesh.nodes.len();
        visit(&Element {
            kind: of_mesh.kind,
            rule: self.solids[0].quadrature().rule(of_mesh.kind),
            thickness: self.solids[0].section.measure(),
            is_plane: self.solids[0].section.is_plane(),
            rest: &rest[..count],
            now: &now[..count],
        })
    }

    /// The greatest criterion of a cell over its threshold; what has no number any more is over any.
    fn excess(&self, cell: usize, law: usize, positions: &[Vec3]) -> f64 {
        let of = |one: &(Criterion, f64)| self.over(cell, law, *one, positions);
        self.adaptation.thresholds.iter().map(of).fold(0.0, f64::max)
    }

    /// One criterion of a cell over its threshold.
    fn over(
        &self,
        cell: usize,
        law: usize,
        (criterion, threshold): (Criterion, f64),
        positions: &[Vec3],
    ) -> f64 {
        let solid = &self.solids[law];
        let stress = |F: &Mat3| solid.material(cell).stress(&solid.completed(cell, *F).0);
        let measure = |element: &Element| element.measure(criterion, stress);
        let over = self.with_cell(cell, positions, measure) / threshold;
        if over.is_nan() { f64::INFINITY } else { over }
    }

    /// [`Self::excess`] of every cell, chunk after chunk; nothing of chunks whose cells keep the second law for good.
    fn excesses(&self, laws: &[f64], positions: &[Vec3], excesses: &mut Vec<f64>) {
        excesses.clear();
        excesses.resize(self.mesh.cell_count(), 0.0);
        let (elements, first_cell) = (&self.solids[0].elements, |chunk: usize| self.first_cell[chunk]);
        let chunks = 0..elements.chunk_count();
        parallel::fill(chunks, parallel::LIGHT, excesses, &first_cell, &|number, excess| {
            let (batch, chunk) = elements.chunk(number);
            if self.adaptation.back == 0.0 && chunk.cells.iter().all(|cell| laws[*cell as usize] != 0.0) {
                return;
            }
            let (kind, reference, rest) = (batch.kind, &batch.reference, &self.rest[number]);
            chunk.with_own_rows([positions], |[now]| {
                let measured = Measured {
                    kind,
                    chunk,
                    reference,
                    rest,
                    now,
                    is_plane: self.solids[0].section.is_plane(),
                };
                for (criterion, threshold) in &self.adaptation.thresholds {
                    if *criterion != Criterion::Force {
                        measured.raise(*criterion, *threshold, excess);
                    }
                }
            });
            for (criterion, threshold) in &self.adaptation.thresholds {
                if *criterion == Criterion::Force {
                    for (excess, cell) in excess.iter_mut().zip(&chunk.cells) {
                        let law = usize::from(laws[*cell as usize] != 0.0);
                        let of_cell = self.over(*cell as usize, law, (*criterion, *threshold), positions);
                        *excess = excess.max(of_cell);
                    }
                }
            }
        });
    }

    /// Stored energy of a cell under a law [J].
    fn energy_of(&self, cell: usize, law: usize, positions: &[Vec3]) -> f64 {
        let solid = &self.solids[law];
        self.with_cell(cell, positions, |element| {
            let mut sum = 0.0;
            element.at_samples(|F, _, volume, _| {
                sum += volume * solid.material(cell).energy_density(&solid.completed(cell, F).0);
            });
            sum
        })
    }

    /// Calls `work` for the law of each cell of a chunk of the first solid with the chunk that holds those cells.
    fn for_each_part(
        &self,
        parts: &Parts,
        batch: &SolidBatch,
        chunk: &Chunk,
        mut work: impl FnMut(&dyn Kernel, &Chunk, &[Vec3]),
    ) {
        let (second, full) = self.solids[1].elements.chunk(chunk.number);
        let kernels: [&dyn Kernel; 2] = [batch.kernel.as_ref(), second.kernel.as_ref()];
        match parts.of(chunk.number) {
            Split::First => work(kernels[0], chunk, &batch.reference),
            Split::Second => work(kernels[1], full, &batch.reference),
            Split::Both(parts) => {
                for (kernel, part) in kernels.into_iter().zip(parts.as_ref()) {
                    work(kernel, part, &batch.reference);
                }
            }
        }
    }

    /// Blocks of a chunk's elements, each by its own law.
    fn blocks(
        &self,
        laws: &[f64],
        (batch, chunk): (&SolidBatch, &Chunk),
        blocks: Range<usize>,
        positions: &[Padded],
        scale: f64,
        out: &mut [f64],
    ) {
        let law_of = |block: usize, lane: usize| {
            let cell = chunk.cells.get(lane * chunk.block_count() + block);
            cell.map_or(0.0, |cell| laws[*cell as usize])
        };
        let lanes = || blocks.clone().flat_map(|block| (0..LANES).map(move |lane| law_of(block, lane)));
        let (second, full) = self.solids[1].elements.chunk(chunk.number);
        if lanes().all(|law| law != 0.0) {
            return second.kernel.blocks(full, blocks, &batch.reference, positions, scale, out);
        }
        batch.kernel.blocks(chunk, blocks.clone(), &batch.reference, positions, scale, out);
        if lanes().all(|law| law == 0.0) {
            return;
        }
        BLOCKS.with_borrow_mut(|other| {
            other.resize(out.len(), 0.0);
            second.kernel.blocks(full, blocks.clone(), &batch.reference, positions, scale, other);
            let of_block = out.len() / blocks.len();
            for (index, block) in blocks.enumerate() {
                for lane in (0..LANES).filter(|lane| law_of(block, *lane) != 0.0) {
                    for entry in (index * of_block..(index + 1) * of_block).step_by(LANES) {
                        out[entry + lane] = other[entry + lane];
                    }
                }
            }
        });
    }
}

impl AdaptiveForce {
    /// Whether anything was turned round to be definite.
    fn assemble(
        &self,
        curvature: Curvature,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) -> bool {
        let (laws, elements) = (self.laws(at.memory), &self.solids[0].elements);
        let AdaptiveScratch { partials, assembly, .. } = of(scratch);
        let inputs = [at.positions];
        assembly.add(curvature, elements, inputs, partials, matrix, |batch, chunk, blocks, [x], out| {
            self.blocks(laws, (batch, chunk), blocks, x, weights.position, out);
        })
    }
}

impl Force for AdaptiveForce {
    fn name(&self) -> &str {
        self.solids[0].name()
    }

    fn acts_within(&self) -> bool {
        true
    }

    fn declaration(&self) -> Declaration {
        let [first, second] = self.solids.each_ref().map(|solid| solid.declaration());
        Declaration { internal: first.internal && second.internal, ..first }
    }

    fn memory_len(&self) -> usize {
        self.mesh.cell_count() + 2
    }

    fn new_scratch(&self) -> Scratch {
        Box::new(AdaptiveScratch {
            partials: Vec::new(),
            assembly: Assembly::new(Symmetry::Symmetric),
            parts: Parts::default(),
        })
    }

    fn energy(&self, at: &Configuration, scratch: &mut Scratch) -> Energy {
        let parts = &mut of(scratch).parts;
        parts.follow(self.laws(at.memory), &self.solids);
        let stored = self.solids[0].elements.sum([at.positions], |batch, chunk, [x]| {
            let mut sum = 0.0;
            self.for_each_part(parts, batch, chunk, |kernel, part, reference| {
                sum += kernel.energy(part, reference, x);
            });
            sum
        });
        Energy { stored, dissipated: at.memory[self.mesh.cell_count()] }
    }

    fn add_force(&self, at: &Configuration, scratch: &mut Scratch, out: &mut [Vec3]) {
        let AdaptiveScratch { partials, parts, .. } = of(scratch);
        parts.follow(self.laws(at.memory), &self.solids);
        self.solids[0].elements.add_sums([at.positions], partials, out, |batch, chunk, [x], sums| {
            self.for_each_part(parts, batch, chunk, |kernel, part, reference| {
                kernel.forces(part, reference, x, sums);
            });
        });
    }

    fn add_differential(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        scratch: &mut Scratch,
        out: &mut [Vec3],
    ) {
        let AdaptiveScratch { partials, parts, .. } = of(scratch);
        parts.follow(self.laws(at.memory), &self.solids);
        let inputs = [at.positions, delta];
        self.solids[0].elements.add_sums(inputs, partials, out, |batch, chunk, [x, delta], sums| {
            self.for_each_part(parts, batch, chunk, |kernel, part, reference| {
                kernel.differential(part, reference, x, delta, weights.position, sums);
            });
        });
    }

    fn visit_cliques(&self, pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        self.solids[0].visit_cliques(pairs, visit);
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

    fn ends_steps(&self) -> bool {
        true
    }

    fn end_step(&self, positions: &[Vec3], _timestep: f64, memory: &mut [f64]) -> bool {
        let count = self.mesh.cell_count();
        // taken out: where threads share the work, this one may be given a part of another's
        let mut excesses = EXCESS.take();
        self.excesses(&memory[..count], positions, &mut excesses);
        let switches = memory[count + 1];
        let cells = self.solids[0].elements.chunks().flat_map(|(_, chunk)| &chunk.cells);
        for (cell, excess) in cells.map(|cell| *cell as usize).zip(&excesses) {
            let law = usize::from(memory[cell] != 0.0);
            let (is_over, is_back) = (*excess > 1.0, *excess < self.adaptation.back);
            if (law == 0 && is_over) || (law == 1 && is_back) {
                let [before, after] = [law, 1 - law].map(|law| self.energy_of(cell, law, positions));
                memory[cell] = (1 - law) as f64;
                memory[count] += before - after;
                memory[count + 1] += 1.0;
            }
        }
        EXCESS.set(excesses);
        memory[count + 1] != switches
    }

    fn cell_field(&self, cell: usize, positions: &[Vec3]) -> Option<CellField> {
        self.solids[0].cell_field(cell, positions)
    }

    fn cell_field_at(&self, cell: usize, at: &Configuration) -> Option<CellField> {
        let law = self.laws(at.memory).get(cell)?;
        self.solids[usize::from(*law != 0.0)].cell_field(cell, at.positions)
    }

    fn rest_volume(&self, cell: usize) -> Option<f64> {
        self.solids[0].rest_volume_of(cell)
    }

    fn adapted_law(&self, cell: usize, at: &Configuration) -> Option<f64> {
        self.laws(at.memory).get(cell).copied()
    }

    fn adapted(&self, cell: usize, at: &Configuration) -> Option<Adapted> {
        let law = self.laws(at.memory).get(cell)?;
        let excess = self.excess(cell, usize::from(*law != 0.0), at.positions);
        Some(Adapted { law: *law, excess })
    }

    fn law_changes(&self, at: &Configuration) -> Option<LawChanges> {
        let changes = at.memory.get(self.mesh.cell_count()..)?;
        Some(LawChanges { taken: *changes.first()?, count: *changes.get(1)? })
    }

    fn bytes(&self) -> usize {
        self.solids.iter().map(|solid| solid.bytes()).sum::<usize>()
            + size_of_val(self.mesh.points.as_slice())
            + size_of_val(self.first_cell.as_slice())
            + self.rest.iter().map(AtRest::bytes).sum::<usize>()
            + self.mesh.cells().map(|cell| size_of_val(cell.nodes)).sum::<usize>()
    }

    fn scratch_bytes(&self, scratch: &Scratch) -> usize {
        scratch.downcast_ref().map_or(0, |AdaptiveScratch { partials, assembly, parts }| {
            size_of::<Vec3>() * partials.capacity() + assembly.bytes() + parts.bytes()
        })
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
