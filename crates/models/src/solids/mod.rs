//! Solids: finite elements of any kind and law, mixed in one body.

mod assembly;
mod geometry;
mod kernel;
mod layout;
mod mass;
mod output;
mod rayleigh;
mod viscosity;

use std::any::Any;
use std::cell::RefCell;
use std::ops::Range;

use rayon::prelude::*;
use souple_engine::state::Pair;
use souple_engine::{Configuration, Declaration, Energy, Force, Scratch, TangentWeights};
use souple_math::Vec3;
use souple_mesh::{ElementKind, Mesh, QuadratureRule};
use souple_solve::BlockMatrix;

use crate::materials::{AnyLaw, Law, LawVisitor, Material, Parameters};
use assembly::Assembly;
use geometry::{Nodes, Tetrahedron};
use kernel::{Kernel, LawKernel};
use layout::Chunk;

pub use layout::FlatCell;
pub use mass::{consistent_mass, lumped_mass};
pub use output::CellField;
pub use rayleigh::RayleighDamping;
pub use viscosity::Viscosity;

/// Elastic forces of a body.
pub struct SolidForce {
    name: String,
    batches: Vec<Batch>,
    /// For each row of the body, the partial sums of chunks that it gathers, in chunk order.
    gather: Gather,
    rows: Range<usize>,
    partial_count: usize,
    /// Per cell of the body.
    materials: Vec<Material>,
    material_of_cell: Vec<u16>,
    mesh: Mesh,
    quadrature: Quadrature,
}

/// The elements of one kind and law.
struct Batch {
    kind: ElementKind,
    kernel: Box<dyn Kernel>,
    /// `∂N_a/∂ξ`, sample after sample.
    reference: Vec<Vec3>,
    chunks: Vec<Chunk>,
}

/// Compressed lists: `slots[starts[r] .. starts[r + 1]]` of row `r`.
#[derive(Default)]
struct Gather {
    starts: Vec<u32>,
    slots: Vec<u32>,
}

/// Which rule of quadrature integrates the energy of an element.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quadrature {
    /// Exact for linear elasticity on straight-sided elements; the cheapest that keeps full rank.
    #[default]
    Default,
    /// Exact for St. Venant–Kirchhoff energy too: more samples in hexahedra, prisms and pyramids.
    Full,
}

impl Quadrature {
    pub fn rule(self, kind: ElementKind) -> &'static QuadratureRule {
        match self {
            Self::Default => kind.default_rule(),
            Self::Full => kind.full_rule(),
        }
    }
}

/// What a body is made of.
#[derive(Clone)]
pub struct SolidDescription<'a> {
    pub name: String,
    /// Rest shape; point `i` is row `first_row + i`.
    pub mesh: &'a Mesh,
    pub first_row: usize,
    pub materials: &'a [Material],
    /// Index into `materials` for each cell.
    pub material_of_cell: &'a [u16],
    pub quadrature: Quadrature,
}

/// Chunks below which threads cost more than they bring.
const PARALLEL_CHUNKS: usize = 16;
/// Rows gathered by one task.
const ROWS_PER_TASK: usize = 2048;

/// Partial sums, kept between calls.
#[derive(Default)]
struct SolidScratch {
    partials: Vec<Vec3>,
    energies: Vec<f64>,
    assembly: Assembly,
}

thread_local! {
    /// A chunk's own rows, gathered.
    static LOCAL: RefCell<[Vec<Vec3>; 2]> = const { RefCell::new([Vec::new(), Vec::new()]) };
}

struct MakeKernel(ElementKind);

impl LawVisitor for MakeKernel {
    type Output = Box<dyn Kernel>;

    fn visit<L: Law>(self, _: L) -> Box<dyn Kernel> {
        match self.0.node_count() {
            4 => Box::new(LawKernel::<L, Tetrahedron, 4>::default()),
            5 => Box::new(LawKernel::<L, Nodes<5>, 5>::default()),
            6 => Box::new(LawKernel::<L, Nodes<6>, 6>::default()),
            8 => Box::new(LawKernel::<L, Nodes<8>, 8>::default()),
            other => unreachable!("no volume element has {other} nodes"),
        }
    }
}

impl SolidForce {
    /// # Errors
    /// A cell is flat or inverted at rest.
    pub fn new(description: &SolidDescription) -> Result<Self, FlatCell> {
        let SolidDescription { name, mesh, first_row, materials, material_of_cell, quadrature } = description;
        let rows = *first_row..*first_row + mesh.points.len();
        let nodes_of_cell: Vec<Vec<u32>> = mesh
            .cells()
            .map(|cell| cell.nodes.iter().map(|node| node + *first_row as u32).collect())
            .collect();
        let mut rest_positions = vec![Vec3::ZERO; rows.end];
        rest_positions[rows.clone()].copy_from_slice(&mesh.points);
        let mut batches: Vec<Batch> = Vec::new();
        let mut partial_count = 0;
        for (kind, law) in kinds_and_laws(mesh, materials, material_of_cell) {
            let cells: Vec<(u32, &[u32])> = mesh
                .cells()
                .enumerate()
                .filter(|(index, cell)| {
                    cell.kind == kind && materials[material_of_cell[*index] as usize].law == law
                })
                .map(|(index, _)| (index as u32, nodes_of_cell[index].as_slice()))
                .collect();
            let rule = quadrature.rule(kind);
            let count = law.visit(ParameterCount);
            let parameters_of =
                |cell: u32| materials[material_of_cell[cell as usize] as usize].parameters[..count].to_vec();
            let chunks = layout::chunks(kind, rule, &rest_positions, &cells, &parameters_of, partial_count)?;
            partial_count += chunks.iter().map(|chunk| chunk.rows.len()).sum::<usize>();
            let kernel = law.visit(MakeKernel(kind));
            batches.push(Batch { kind, kernel, reference: reference_gradients(kind, rule), chunks });
        }
        let gather = Gather::new(&rows, &batches);
        Ok(Self {
            name: name.clone(),
            batches,
            gather,
            rows,
            partial_count,
            materials: materials.to_vec(),
            material_of_cell: material_of_cell.to_vec(),
            mesh: (*mesh).clone(),
            quadrature: *quadrature,
        })
    }

    fn chunks(&self) -> impl Iterator<Item = (&Batch, &Chunk)> {
        self.batches.iter().flat_map(|batch| batch.chunks.iter().map(move |chunk| (batch, chunk)))
    }

    /// Runs `work` on every chunk with its slice of partial sums, then adds the sums to `out`.
    fn sum_over_chunks(
        &self,
        scratch: &mut SolidScratch,
        out: &mut [Vec3],
        work: impl Fn(&Batch, &Chunk, &mut [Vec3]) + Sync,
    ) {
        scratch.partials.resize(self.partial_count, Vec3::ZERO);
        let mut remaining = scratch.partials.as_mut_slice();
        let mut tasks = Vec::with_capacity(self.chunks().count());
        for (batch, chunk) in self.chunks() {
            let (mine, rest) = remaining.split_at_mut(chunk.rows.len());
            remaining = rest;
            tasks.push((batch, chunk, mine));
        }
        let run = |(batch, chunk, sums): (&Batch, &Chunk, &mut [Vec3])| {
            sums.fill(Vec3::ZERO);
            work(batch, chunk, sums);
        };
        let parallel = tasks.len() >= PARALLEL_CHUNKS && rayon::current_num_threads() > 1;
        if parallel {
            tasks.into_par_iter().for_each(run);
        } else {
            tasks.into_iter().for_each(run);
        }
        let partials = &scratch.partials;
        let gather_rows = |(task, rows): (usize, &mut [Vec3])| {
            for (offset, row) in rows.iter_mut().enumerate() {
                let sum =
                    self.gather.of(task * ROWS_PER_TASK + offset).iter().map(|slot| partials[*slot as usize]);
                *row += sum.sum();
            }
        };
        let rows = &mut out[self.rows.clone()];
        if parallel {
            rows.par_chunks_mut(ROWS_PER_TASK).enumerate().for_each(gather_rows);
        } else {
            rows.chunks_mut(ROWS_PER_TASK).enumerate().for_each(gather_rows);
        }
    }
}

/// Rows of a cell's nodes.
fn nodes_of(cell: &souple_mesh::Cell, first_row: usize) -> Vec<u32> {
    cell.nodes.iter().map(|node| node + first_row as u32).collect()
}

struct ParameterCount;

impl LawVisitor for ParameterCount {
    type Output = usize;

    fn visit<L: Law>(self, _: L) -> usize {
        <L::Parameters<f64> as Parameters<f64>>::NAMES.len()
    }
}

struct IsObjective;

impl LawVisitor for IsObjective {
    type Output = bool;

    fn visit<L: Law>(self, _: L) -> bool {
        L::OBJECTIVE
    }
}

/// The pairs of element and law that occur, in order of first occurrence.
fn kinds_and_laws(
    mesh: &Mesh,
    materials: &[Material],
    material_of_cell: &[u16],
) -> Vec<(ElementKind, AnyLaw)> {
    let mut found = Vec::new();
    for (cell, material) in mesh.cells().zip(material_of_cell) {
        let pair = (cell.kind, materials[*material as usize].law);
        if !found.contains(&pair) {
            found.push(pair);
        }
    }
    found
}

fn reference_gradients(kind: ElementKind, rule: &QuadratureRule) -> Vec<Vec3> {
    rule.points
        .iter()
        .flat_map(|point| kind.shape_gradients(point.position).iter().copied().collect::<Vec<_>>())
        .collect()
}

impl Gather {
    fn new(rows: &Range<usize>, batches: &[Batch]) -> Self {
        let mut lists = vec![Vec::new(); rows.len()];
        for chunk in batches.iter().flat_map(|batch| &batch.chunks) {
            for (local, row) in chunk.rows.iter().enumerate() {
                lists[*row as usize - rows.start].push((chunk.first_partial + local) as u32);
            }
        }
        let mut gather = Self { starts: vec![0], slots: Vec::new() };
        for list in lists {
            gather.slots.extend(list);
            gather.starts.push(gather.slots.len() as u32);
        }
        gather
    }

    fn of(&self, row: usize) -> &[u32] {
        &self.slots[self.starts[row] as usize..self.starts[row + 1] as usize]
    }
}

impl Chunk {
    /// The chunk's rows of `values`, in `local`.
    fn localise(&self, values: &[Vec3], local: &mut Vec<Vec3>) {
        local.clear();
        local.extend(self.rows.iter().map(|row| values[*row as usize]));
    }
}

fn solid_scratch(scratch: &mut Scratch) -> &mut SolidScratch {
    scratch.downcast_mut().unwrap_or_else(|| unreachable!("made by this force's own new_scratch"))
}

impl Force for SolidForce {
    fn name(&self) -> &str {
        &self.name
    }

    fn declaration(&self) -> Declaration {
        // small strain knows a rest orientation: a rotated body feels a torque
        Declaration { internal: self.is_objective(), ..Declaration::ELASTIC }
    }

    fn new_scratch(&self) -> Scratch {
        Box::new(SolidScratch::default())
    }

    fn energy(&self, at: &Configuration, scratch: &mut Scratch) -> Energy {
        let scratch = solid_scratch(scratch);
        let chunks: Vec<_> = self.chunks().collect();
        scratch.energies.resize(chunks.len(), 0.0);
        let energy_of = |(energy, (batch, chunk)): (&mut f64, &(&Batch, &Chunk))| {
            LOCAL.with_borrow_mut(|[positions, _]| {
                chunk.localise(at.positions, positions);
                *energy = batch.kernel.energy(chunk, &batch.reference, positions);
            });
        };
        if chunks.len() >= PARALLEL_CHUNKS {
            scratch.energies.par_iter_mut().zip(&chunks).for_each(energy_of);
        } else {
            scratch.energies.iter_mut().zip(&chunks).for_each(energy_of);
        }
        Energy { stored: scratch.energies.iter().sum(), dissipated: 0.0 }
    }

    fn add_force(&self, at: &Configuration, scratch: &mut Scratch, out: &mut [Vec3]) {
        self.sum_over_chunks(solid_scratch(scratch), out, |batch, chunk, sums| {
            LOCAL.with_borrow_mut(|[positions, _]| {
                chunk.localise(at.positions, positions);
                batch.kernel.forces(chunk, &batch.reference, positions, sums);
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
        if weights.position == 0.0 {
            return;
        }
        self.sum_over_chunks(solid_scratch(scratch), out, |batch, chunk, sums| {
            LOCAL.with_borrow_mut(|[positions, deltas]| {
                chunk.localise(at.positions, positions);
                chunk.localise(delta, deltas);
                batch.kernel.differential(chunk, &batch.reference, positions, deltas, weights.position, sums);
            });
        });
    }

    fn visit_cliques(&self, _pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        let mut rows = Vec::new();
        for cell in self.mesh.cells() {
            rows.clear();
            rows.extend(cell.nodes.iter().map(|node| node + self.rows.start as u32));
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
        let assembly = &mut solid_scratch(scratch).assembly;
        assembly.add_blocks(&self.batches, &self.rows, at.positions, weights.position, matrix);
    }

    fn bytes(&self) -> usize {
        let chunks: usize = self.chunks().map(|(_, chunk)| chunk.bytes()).sum();
        let cells: usize = self.mesh.blocks.iter().map(|block| 4 * block.nodes.len()).sum();
        chunks
            + cells
            + 4 * (self.gather.starts.len() + self.gather.slots.len())
            + 24 * self.mesh.points.len()
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}

impl SolidForce {
    /// Whether every law gives rotated bodies no stress.
    fn is_objective(&self) -> bool {
        self.materials.iter().all(|material| material.law.visit(IsObjective))
    }

    /// The rest shape; its point `i` is row `rows().start + i`.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    pub fn rows(&self) -> Range<usize> {
        self.rows.clone()
    }

    pub fn quadrature(&self) -> Quadrature {
        self.quadrature
    }

    /// The material of a cell.
    pub fn material(&self, cell: usize) -> &Material {
        &self.materials[self.material_of_cell[cell] as usize]
    }
}
