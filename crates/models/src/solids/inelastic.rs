//! Solids whose rest shape gives way: creep, yielding and fracture of bodies of finite elements.
//!
//! The deformation is an elastic one of a reference that has changed, `F = F_e F_p`, at each sample of each cell (Terzopoulos & Fleischer
//! 1988, as solids of large strain have it). The law of the body, whichever it is, sees `F_e = F F_p⁻¹`: the cell is one
//! whose rest gradients are `F_p⁻ᵀ ∇N`. The reference keeps its volume. `F_p` is memory: within a step the force has an energy and exact
//! derivatives, and once in each step, where it ends, what has been strained goes over into the reference.
//!
//! With `C_e = F_eᵀ F_e = Σ λ_i² v_i ⊗ v_i` and the logarithmic strain `e = dev Σ ln λ_i v_i ⊗ v_i`, a share `η` of it goes over:
//!
//! `F_p ← exp(η e) F_p`, `F_e ← F_e exp(-η e)`.
//!
//! - Creep with the time `z`: `η = 1 - exp(-h/z)`, which is `Ḟ_p F_p⁻¹ = e/z` exactly at a held strain: matter of Maxwell with the
//!   viscosity `G z`.
//! - Yielding: where the equivalent stress of von Mises is above the threshold, the `η` that brings it to `σ_y + H ε̄` (or all of
//!   it, `η = 1`, as the source has it). `ε̄` adds up `√(2/3 e:e) η`.
//! - Fracture: a cell at a sample of which the greatest principal stress or stretch is beyond its limit has no stiffness from then on. Limits
//!   are scattered from cell to cell by a seed.
//!
//! Statics know no order in which cells tear: where a step finds equilibrium all that bear too much are torn at once, judged with what of
//! their strain goes over, and it is sought again for what is left until no more do.
//!
//! The equivalent stress of an isotropic law is no more than the threshold where the reference moves on, and may be above it elsewhere by what a step
//! strains: take steps that strain little.
//!
//! Forces, and whether cells come above the threshold at all, are asked of eight cells abreast; what is above is brought back one by one.
//!
//! Source: Terzopoulos & Fleischer 1988, §5; Simo & Hughes 1998, §9.3 (logarithmic strain, return to the threshold).

use std::any::Any;
use std::sync::atomic::{AtomicBool, Ordering};

use souple_engine::state::Pair;
use souple_engine::{
    CellField, Configuration, Curvature, Declaration, Energy, Force, Scratch, TangentWeights,
};
use souple_math::{Mat3, Vec3, eigen_symmetric};
use souple_mesh::MAX_NODES;
use souple_solve::BlockMatrix;

use super::abreast::{self, Block, Blocks, Nodal, Sample};
use super::cellwise::Cellwise;
use super::layout::LANES;
use super::row_law::{Row, RowLaw};
use super::turned::AXES_LEN;
use super::{FlatCell, SolidDescription, parallel, rows_along, turned};
use crate::materials::{Material, MaterialLaw, Oriented, PARAMETERS_MAX, cauchy_stress, von_mises};

/// How the reference of a body changes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Inelasticity {
    /// In which elastic strain of shape falls to `1/e` at a held strain [s].
    pub creep_time: Option<f64>,
    pub yielding: Option<Yielding>,
    pub fracture: Option<Fracture>,
}

/// Where matter yields.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Yielding {
    /// Equivalent stress of von Mises [Pa].
    pub stress: f64,
    /// How the threshold grows with what has yielded [Pa].
    pub hardening: f64,
    pub amount: Amount,
}

/// How much of the strain goes into the reference where matter yields.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Amount {
    /// What is above the threshold.
    Excess,
    /// All of it: matter lets go.
    Whole,
}

/// Where matter tears.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fracture {
    /// Greatest principal stress [Pa]; infinite: stress tears nothing.
    pub stress: f64,
    /// Greatest principal stretch of the elastic deformation, less one; infinite: strain tears nothing.
    pub strain: f64,
    /// By what part of themselves limits differ from cell to cell, either way.
    pub scatter: f64,
    pub seed: u64,
}

struct Cell {
    block: usize,
    lane: usize,
    samples: usize,
    /// Where its samples begin in memory.
    memory: usize,
    /// What its limits of fracture are multiplied by.
    strength: f64,
}

/// Numbers of memory of a cell before those of its samples: 1 where it is torn, and what it has given off [J].
const OF_CELL: usize = 2;
const TORN: usize = 0;
const HEAT: usize = 1;
/// Of a sample: `F_p⁻¹` by columns, then `ε̄`.
const SAMPLE: usize = 10;

/// The most numbers that a law in lanes is told.
const ROW_PARAMETERS: usize = if AXES_LEN > PARAMETERS_MAX { AXES_LEN } else { PARAMETERS_MAX };

/// By what part of the threshold the stress of many lanes at once may be rounded otherwise than that of one sample.
const ROUNDING: f64 = 1e-9;

/// What a sample remembers.
struct Reference {
    /// `F_p⁻¹`; its volume is that of rest.
    inverse: Mat3,
    yielded: f64,
}

impl Reference {
    const REST: Self = Self { inverse: Mat3::IDENTITY, yielded: 0.0 };

    fn read(memory: &[f64]) -> Self {
        let column = |j: usize| Vec3::new(memory[3 * j], memory[3 * j + 1], memory[3 * j + 2]);
        Self { inverse: Mat3::from_columns(column(0), column(1), column(2)), yielded: memory[9] }
    }

    fn write(&self, memory: &mut [f64]) {
        for (slots, column) in memory.chunks_exact_mut(3).zip(self.inverse.columns) {
            slots.copy_from_slice(&column.to_array());
        }
        memory[9] = self.yielded;
    }
}

/// `dev ln √(F_eᵀ F_e)` by its directions.
struct Strain {
    /// `e_i`, their sum zero.
    shape: Vec3,
    directions: Mat3,
}

impl Strain {
    /// `None` where an elastic stretch is nothing or not finite.
    fn of(F: &Mat3) -> Option<Self> {
        let eigen = eigen_symmetric(&F.gram());
        let logarithms = Vec3::from_array(eigen.values.to_array().map(|square| 0.5 * libm::log(square)));
        let mean = (logarithms.x + logarithms.y + logarithms.z) / 3.0;
        let shape = logarithms - Vec3::new(mean, mean, mean);
        shape.is_finite().then_some(Self { shape, directions: eigen.vectors })
    }

    /// `exp(share e)`.
    fn exponential(&self, share: f64) -> Mat3 {
        let of_shape = Vec3::from_array(self.shape.to_array().map(|e| libm::exp(share * e)));
        (self.directions * Mat3::from_diagonal(of_shape)).mul_transpose(&self.directions)
    }

    /// `√(2/3 e:e)`.
    fn equivalent(&self) -> f64 {
        (2.0 / 3.0 * self.shape.length_sq()).sqrt()
    }
}

/// Elastic force of a body whose reference changes: of any objective law and any element of volume, sample by sample.
pub struct InelasticForce {
    name: String,
    cells: Vec<Cell>,
    blocks: Blocks,
    nodes: Cellwise,
    materials: Vec<Material>,
    /// The same laws for the lanes of blocks.
    rows: Vec<Box<dyn RowLaw>>,
    material_of_cell: Vec<u16>,
    axes: Vec<Mat3>,
    rules: Inelasticity,
    memory_len: usize,
    is_internal: bool,
}

/// Parts of sums over cells.
#[derive(Default)]
struct InelasticScratch {
    parts: Vec<Vec3>,
    blocks: Vec<Mat3>,
}

fn of(scratch: &mut Scratch) -> &mut InelasticScratch {
    scratch.downcast_mut().unwrap_or_else(|| unreachable!("made by this force's own new_scratch"))
}

impl InelasticForce {
    /// # Errors
    /// A cell is flat or inverted at rest.
    pub fn new(description: &SolidDescription, rules: Inelasticity) -> Result<Self, FlatCell> {
        let SolidDescription { name, mesh, first_row, materials, material_of_cell, axes, quadrature, .. } =
            description;
        let mut cells = Vec::with_capacity(mesh.cell_count());
        let (mut blocks, mut memory) = (Blocks::default(), 0);
        let mut buffer = [Vec3::ZERO; MAX_NODES];
        for (number, cell) in mesh.cells().enumerate() {
            let corners = mesh.positions_into(cell.nodes, &mut buffer);
            let mut samples = Vec::new();
            for (sample, point) in quadrature.rule(cell.kind).points.iter().enumerate() {
                let jacobian = cell.kind.jacobian(corners, point.position);
                let determinant = jacobian.determinant();
                let inverse = jacobian.try_inverse().filter(|_| determinant > 0.0);
                let flat = FlatCell { kind: cell.kind, cell: number as u32, sample, determinant };
                let inverse = inverse.ok_or(flat)?;
                let gradients = cell.kind.shape_gradients(point.position);
                let gradients: Vec<Vec3> =
                    gradients.iter().map(|by_xi| inverse.transpose_apply(*by_xi)).collect();
                samples.push((determinant * point.weight, gradients));
            }
            let strength = rules.fracture.map_or(1.0, |fracture| fracture.strength(number as u64));
            let (block, lane) = blocks.push(cell.kind, usize::from(material_of_cell[number]), &samples);
            let samples = samples.len();
            cells.push(Cell { block, lane, samples, memory, strength });
            memory += OF_CELL + SAMPLE * samples;
        }
        Ok(Self {
            name: name.clone(),
            cells,
            blocks,
            nodes: Cellwise::new(mesh, *first_row),
            is_internal: materials.iter().all(|material| material.law.is_objective()),
            materials: materials.to_vec(),
            rows: materials.iter().map(|material| rows_along(&material.law, !axes.is_empty())).collect(),
            material_of_cell: material_of_cell.to_vec(),
            axes: axes.to_vec(),
            rules,
            memory_len: memory,
        })
    }

    fn law(&self, cell: usize) -> Oriented<'_> {
        self.materials[usize::from(self.material_of_cell[cell])].along(self.axes.get(cell))
    }

    /// The memory of a cell.
    fn memory_of<'a>(&self, cell: usize, memory: &'a [f64]) -> &'a [f64] {
        let cell = &self.cells[cell];
        &memory[cell.memory..][..cell.memory_len()]
    }

    /// `Σ x ⊗ ∇N` at a sample of a cell.
    fn gradient(&self, cell: usize, sample: Sample, positions: &[Vec3]) -> Mat3 {
        let mut F = Mat3::ZERO;
        for (row, gradient) in self.nodes.rows(cell).iter().zip(sample.gradients()) {
            F += positions[*row as usize].outer(gradient);
        }
        F
    }

    /// The samples of a cell, torn ones too.
    fn samples_of(&self, cell: usize) -> impl Iterator<Item = Sample<'_>> {
        self.blocks.samples(self.cells[cell].block, self.cells[cell].lane)
    }

    /// The samples of a cell with `F_p⁻¹` and `F_e`; none of a torn one.
    fn samples<'a>(
        &'a self,
        number: usize,
        positions: &'a [Vec3],
        own: &'a [f64],
    ) -> impl Iterator<Item = (Sample<'a>, Mat3, Mat3)> {
        let count = if is_torn(own) { 0 } else { self.cells[number].samples };
        self.samples_of(number).take(count).zip(references(own)).map(move |(sample, reference)| {
            let F = self.gradient(number, sample, positions);
            (sample, reference.inverse, F * reference.inverse)
        })
    }

    /// Energy of all samples of a cell [J]; none of a torn one.
    fn energy_of(&self, cell: usize, positions: &[Vec3], own: &[f64]) -> f64 {
        let law = self.law(cell);
        self.samples(cell, positions, own)
            .map(|(sample, _, F)| sample.volume() * law.energy_density(&F))
            .sum()
    }

    /// Brings the reference of a cell that is whole on by `timestep`, and tears it where it bears too much; whether anything changed.
    fn advance(&self, number: usize, positions: &[Vec3], timestep: f64, own: &mut [f64]) -> bool {
        let (cell, law) = (&self.cells[number], self.law(number));
        // asked for where something changes, before anything has
        let mut before = None;
        let mut tears = false;
        for (index, sample) in self.samples_of(number).enumerate() {
            let F = self.gradient(number, sample, positions);
            let memory = OF_CELL + SAMPLE * index..OF_CELL + SAMPLE * (index + 1);
            let mut reference = Reference::read(&own[memory.clone()]);
            if self.rules.advance(&law, &F, timestep, &mut reference) {
                before.get_or_insert_with(|| self.energy_of(number, positions, own));
                reference.write(&mut own[memory]);
            }
            tears |= self.rules.tears(&law, &(F * reference.inverse), cell.strength);
        }
        if tears {
            before.get_or_insert_with(|| self.energy_of(number, positions, own));
            own[TORN] = 1.0;
        }
        let Some(before) = before else { return false };
        own[HEAT] += before - self.energy_of(number, positions, own);
        true
    }

    /// Tears a cell that is whole where it bears too much with what of its strain is about to go over; whether it did.
    fn tear(&self, number: usize, positions: &[Vec3], own: &mut [f64]) -> bool {
        let (cell, law) = (&self.cells[number], self.law(number));
        let tears = self.samples_of(number).zip(references(own)).any(|(sample, mut reference)| {
            let F = self.gradient(number, sample, positions);
            self.rules.advance(&law, &F, 0.0, &mut reference);
            self.rules.tears(&law, &(F * reference.inverse), cell.strength)
        });
        if tears {
            own[HEAT] += self.energy_of(number, positions, own);
            own[TORN] = 1.0;
        }
        tears
    }

    /// Calls `change` with every cell that is whole, among those that `candidates` tells of each block, and its memory; whether any changed.
    fn change(
        &self,
        memory: &mut [f64],
        candidates: impl Fn(&Block, &[f64]) -> [bool; LANES] + Sync,
        change: impl Fn(usize, &mut [f64]) -> bool + Sync,
    ) -> bool {
        let changed = AtomicBool::new(false);
        let blocks = self.blocks.all();
        let start_of = |block: usize| {
            blocks.get(block).map_or(self.memory_len, |block| self.cells[block.cells.start].memory)
        };
        parallel::fill(0..blocks.len(), parallel::LIGHT, memory, &start_of, &|block, memory| {
            let is_candidate = candidates(&blocks[block], memory);
            let lens = blocks[block].cells.clone().map(|cell| self.cells[cell].memory_len());
            let mut remaining = memory;
            for ((cell, len), is_candidate) in blocks[block].cells.clone().zip(lens).zip(is_candidate) {
                let (own, rest) = remaining.split_at_mut(len);
                remaining = rest;
                if is_candidate && !is_torn(own) && change(cell, own) {
                    changed.store(true, Ordering::Relaxed);
                }
            }
        });
        changed.into_inner()
    }

    /// Positions of the `N` nodes at most of a block.
    fn gathered<const N: usize>(&self, block: &Block, positions: &[Vec3]) -> [Nodal; N] {
        let mut out = [abreast::NODAL_ZERO; N];
        for (lane, cell) in block.cells.clone().enumerate() {
            for (node, row) in out.iter_mut().zip(self.nodes.rows(cell)) {
                let x = positions[*row as usize];
                (node[0][lane], node[1][lane], node[2][lane]) = (x.x, x.y, x.z);
            }
        }
        out
    }

    /// `F_p⁻¹` and `ε̄` at a sample of a block, whose memory is given; those of rest in lanes past its last cell.
    fn remembered(block: &Block, sample: usize, memory: &[f64]) -> (Row, [f64; LANES]) {
        let (mut inverse, mut yielded) = (abreast::ZERO, [0.0; LANES]);
        for diagonal in [0, 4, 8] {
            inverse[diagonal] = [1.0; LANES];
        }
        let of_cells = memory.chunks_exact(OF_CELL + SAMPLE * block.samples);
        for (lane, own) in of_cells.enumerate() {
            let own = &own[OF_CELL + SAMPLE * sample..][..SAMPLE];
            inverse.iter_mut().zip(own).for_each(|(entry, number)| entry[lane] = *number);
            yielded[lane] = own[9];
        }
        (inverse, yielded)
    }

    /// What the law of a block is told of its lanes, `[number][lane]`.
    fn parameters(&self, block: &Block) -> [f64; ROW_PARAMETERS * LANES] {
        let mut out = [0.0; ROW_PARAMETERS * LANES];
        let material = &self.materials[block.material];
        if let MaterialLaw::Known(_) = material.law {
            let of_numbers = out.chunks_exact_mut(LANES).zip(material.parameters);
            of_numbers.for_each(|(lanes, number)| lanes.fill(number));
            return out;
        }
        // numbers of laws as text are in their programs: they are told of axes alone
        for (lane, axes) in self.axes.iter().skip(block.cells.start).take(block.cells.len()).enumerate() {
            for (i, number) in turned::numbers(axes).into_iter().enumerate() {
                out[i * LANES + lane] = number;
            }
        }
        out
    }

    /// The memory of the cells of a block.
    fn memory_of_block<'a>(&self, block: &Block, memory: &'a [f64]) -> &'a [f64] {
        let first = &self.cells[block.cells.start];
        &memory[first.memory..][..block.cells.len() * first.memory_len()]
    }

    /// On the nodes of the cells of a block.
    fn forces_of(&self, block: &Block, at: &Configuration, parts: &mut [Vec3]) {
        // no more is cleared for a block than its kind needs
        match block.nodes {
            ..=4 => self.forces_within::<4>(block, at, parts),
            5..=8 => self.forces_within::<8>(block, at, parts),
            _ => self.forces_within::<MAX_NODES>(block, at, parts),
        }
    }

    fn forces_within<const N: usize>(&self, block: &Block, at: &Configuration, parts: &mut [Vec3]) {
        let positions = self.gathered::<N>(block, at.positions);
        let (law, parameters) = (&self.rows[block.material], self.parameters(block));
        let memory = self.memory_of_block(block, at.memory);
        let mut forces = [abreast::NODAL_ZERO; N];
        for sample in 0..block.samples {
            let (inverse, _) = Self::remembered(block, sample, memory);
            let F = self.blocks.deform(block, sample, &positions[..block.nodes], &inverse);
            let stress = law.stress(&parameters, &F);
            self.blocks.pull(block, sample, &stress, &inverse, &mut forces[..block.nodes]);
        }
        let of_cells = memory.chunks_exact(OF_CELL + SAMPLE * block.samples);
        for (lane, (own, parts)) in of_cells.zip(parts.chunks_exact_mut(block.nodes)).enumerate() {
            let of_node = |force: &Nodal| match is_torn(own) {
                true => Vec3::ZERO,
                false => Vec3::from_array(force.map(|axis| axis[lane])),
            };
            parts.iter_mut().zip(&forces).for_each(|(part, force)| *part = of_node(force));
        }
    }

    /// Which cells of a block, whose memory is given, may change where a step ends: where nothing but yielding changes them, those with a
    /// sample above the threshold, to rounding, or of no finite stress.
    fn candidates(&self, block: &Block, positions: &[Vec3], memory: &[f64]) -> [bool; LANES] {
        let Inelasticity { creep_time: None, fracture: None, yielding: Some(yielding) } = self.rules else {
            return [true; LANES];
        };
        match block.nodes {
            ..=4 => self.exceeding::<4>(yielding, block, positions, memory),
            5..=8 => self.exceeding::<8>(yielding, block, positions, memory),
            _ => self.exceeding::<MAX_NODES>(yielding, block, positions, memory),
        }
    }

    /// Which cells of a block have a sample above the threshold.
    fn exceeding<const N: usize>(
        &self,
        yielding: Yielding,
        block: &Block,
        positions: &[Vec3],
        memory: &[f64],
    ) -> [bool; LANES] {
        let positions = self.gathered::<N>(block, positions);
        let (law, parameters) = (&self.rows[block.material], self.parameters(block));
        let mut found = [false; LANES];
        for sample in 0..block.samples {
            let (inverse, yielded) = Self::remembered(block, sample, memory);
            let F = self.blocks.deform(block, sample, &positions[..block.nodes], &inverse);
            let stress = abreast::equivalent_stress(&law.stress(&parameters, &F), &F);
            for lane in 0..LANES {
                let threshold = yielding.stress + yielding.hardening * yielded[lane];
                // what is no number is looked at
                found[lane] |= stress[lane].is_nan() || stress[lane] > threshold * (1.0 - ROUNDING);
            }
        }
        found
    }

    /// Whether any were turned round.
    fn assemble(
        &self,
        curvature: Curvature,
        at: &Configuration,
        scale: f64,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) -> bool {
        if scale == 0.0 {
            return false;
        }
        self.nodes.add_blocks(curvature, &mut of(scratch).blocks, matrix, |cell, blocks| {
            let (law, nodes) = (self.law(cell), self.nodes.rows(cell).len());
            for (sample, inverse, F) in self.samples(cell, at.positions, self.memory_of(cell, at.memory)) {
                let scale = -scale * sample.volume();
                let mut gradients = [Vec3::ZERO; MAX_NODES];
                for (changed, gradient) in gradients.iter_mut().zip(sample.gradients()) {
                    *changed = inverse.transpose_apply(gradient);
                }
                for (b, column) in gradients[..nodes].iter().enumerate() {
                    let changes =
                        Vec3::AXES.map(|axis| law.stress_differential(&F, &axis.outer(*column)) * scale);
                    for (a, row) in gradients[..nodes].iter().enumerate() {
                        let [x, y, z] = changes.map(|change| change * *row);
                        blocks[a * nodes + b] += Mat3::from_columns(x, y, z);
                    }
                }
            }
        })
    }
}

impl Cell {
    fn memory_len(&self) -> usize {
        OF_CELL + SAMPLE * self.samples
    }
}

/// Whether a cell is torn, by its memory.
fn is_torn(own: &[f64]) -> bool {
    own[TORN] > 0.0
}

/// Of the samples of a cell, by its memory.
fn references(own: &[f64]) -> impl Iterator<Item = Reference> {
    own[OF_CELL..].chunks_exact(SAMPLE).map(Reference::read)
}

impl Fracture {
    /// What the limits of a cell are multiplied by: evenly within the scatter.
    fn strength(&self, cell: u64) -> f64 {
        // SplitMix64 of seed and cell, its upper 53 bits
        let mut bits = self.seed.wrapping_add(cell.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15));
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let even = ((bits ^ (bits >> 31)) >> 11) as f64 / (1u64 << 53) as f64;
        1.0 + self.scatter * (2.0 * even - 1.0)
    }

    fn is_exceeded(&self, law: &Oriented, F: &Mat3, strength: f64) -> bool {
        let stretch = 1.0 + self.strain * strength;
        let pulls = || {
            let stress = cauchy_stress(&law.stress(F), F);
            stress.is_some_and(|stress| has_value_above(&stress, self.stress * strength))
        };
        has_value_above(&F.gram(), stretch * stretch) || (self.stress.is_finite() && pulls())
    }
}

/// Whether a symmetric matrix has an eigenvalue above a limit.
fn has_value_above(matrix: &Mat3, limit: f64) -> bool {
    // none is farther from their mean than by √(2/3) of the deviator
    let mean = matrix.trace() / 3.0;
    let deviator = matrix.plus_diagonal(-mean);
    let most = mean + (2.0 / 3.0 * deviator.dot(&deviator)).sqrt();
    // what is no number is looked at
    (most.is_nan() || most > limit) && eigen_symmetric(matrix).values.largest_component() > limit
}

/// Equivalent stress of an elastic deformation [Pa].
fn equivalent_stress(law: &Oriented, F: &Mat3) -> f64 {
    cauchy_stress(&law.stress(F), F).map_or(0.0, |stress| von_mises(&stress))
}

/// Halvings of an interval from 0 to 1: to the last place.
const HALVINGS: usize = 53;

impl Yielding {
    fn is_exceeded(&self, law: &Oriented, F: &Mat3, yielded: f64) -> bool {
        equivalent_stress(law, F) > self.stress + self.hardening * yielded
    }

    /// The share of the elastic strain of shape that goes into the reference where the threshold is exceeded.
    fn share(&self, law: &Oriented, F: &Mat3, strain: &Strain, yielded: f64) -> f64 {
        let excess = |share: f64| {
            let threshold = self.stress + self.hardening * (yielded + share * strain.equivalent());
            equivalent_stress(law, &(*F * strain.exponential(-share))) - threshold
        };
        if self.amount == Amount::Whole {
            return 1.0;
        }
        // the stress falls with the share, to nothing at 1, and the threshold does not
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if excess(middle) > 0.0 { low = middle } else { high = middle }
        }
        high
    }
}

impl Inelasticity {
    /// Brings a sample on by `timestep`, at its deformation `F`; whether anything went over.
    fn advance(&self, law: &Oriented, F: &Mat3, timestep: f64, reference: &mut Reference) -> bool {
        let give = |share: f64, strain: &Strain, reference: &mut Reference| {
            reference.inverse = reference.inverse * strain.exponential(-share);
            share > 0.0
        };
        let mut changed = false;
        if let Some(time) = self.creep_time
            && let Some(strain) = Strain::of(&(*F * reference.inverse))
        {
            changed |= give(-libm::expm1(-timestep / time), &strain, reference);
        }
        if let Some(yielding) = self.yielding {
            let elastic = *F * reference.inverse;
            if !yielding.is_exceeded(law, &elastic, reference.yielded) {
                return changed;
            }
            let Some(strain) = Strain::of(&elastic) else { return changed };
            let share = yielding.share(law, &elastic, &strain, reference.yielded);
            if share > 0.0 {
                changed |= give(share, &strain, reference);
                reference.yielded += share * strain.equivalent();
            }
        }
        changed
    }

    fn tears(&self, law: &Oriented, F: &Mat3, strength: f64) -> bool {
        self.fracture.is_some_and(|fracture| fracture.is_exceeded(law, F, strength))
    }
}

impl Force for InelasticForce {
    fn name(&self) -> &str {
        &self.name
    }

    fn acts_within(&self) -> bool {
        true
    }

    fn declaration(&self) -> Declaration {
        Declaration { internal: self.is_internal, ..Declaration::ELASTIC }
    }

    fn memory_len(&self) -> usize {
        self.memory_len
    }

    fn initial_memory(&self, memory: &mut [f64]) {
        memory.fill(0.0);
        for cell in &self.cells {
            for sample in memory[cell.memory + OF_CELL..][..SAMPLE * cell.samples].chunks_exact_mut(SAMPLE) {
                Reference::REST.write(sample);
            }
        }
    }

    fn new_scratch(&self) -> Scratch {
        Box::new(InelasticScratch::default())
    }

    fn energy(&self, at: &Configuration, _scratch: &mut Scratch) -> Energy {
        let own = |cell: usize| self.memory_of(cell, at.memory);
        Energy {
            stored: self.nodes.sum(|cell| self.energy_of(cell, at.positions, own(cell))),
            dissipated: self.nodes.sum(|cell| own(cell)[HEAT]),
        }
    }

    // f_a = -Σ V P(F_e) F_p⁻ᵀ ∇N_a
    fn add_force(&self, at: &Configuration, scratch: &mut Scratch, out: &mut [Vec3]) {
        let parts = &mut of(scratch).parts;
        let blocks = self.blocks.all();
        let first_of = |block: usize| blocks.get(block).map_or(self.cells.len(), |block| block.cells.start);
        self.nodes.fill_chunks(blocks.len(), first_of, parts, |block, parts| {
            self.forces_of(&blocks[block], at, parts);
        });
        self.nodes.gather(parts, out);
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
        let parts = &mut of(scratch).parts;
        self.nodes.fill(parts, |cell, parts| {
            let law = self.law(cell);
            parts.fill(Vec3::ZERO);
            for (sample, inverse, F) in self.samples(cell, at.positions, self.memory_of(cell, at.memory)) {
                let dF = self.gradient(cell, sample, delta) * inverse;
                let change = law.stress_differential(&F, &dF).mul_transpose(&inverse);
                let change = change * (sample.volume() * weights.position);
                parts
                    .iter_mut()
                    .zip(sample.gradients())
                    .for_each(|(part, gradient)| *part -= change * gradient);
            }
        });
        self.nodes.gather(parts, out);
    }

    fn visit_cliques(&self, _pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        self.nodes.visit_cliques(visit);
    }

    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        self.assemble(Curvature::Exact, at, weights.position, scratch, matrix);
    }

    fn add_definite_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) -> bool {
        self.assemble(Curvature::Definite, at, weights.position, scratch, matrix)
    }

    // its memory changes where steps end: nothing is read here
    fn advances_in_place(&self) -> bool {
        true
    }

    fn give_way(&self, at: &Configuration, memory: &mut [f64]) -> bool {
        self.rules.fracture.is_some()
            && self.change(memory, |_, _| [true; LANES], |cell, own| self.tear(cell, at.positions, own))
    }

    fn ends_steps(&self) -> bool {
        true
    }

    fn end_step(&self, positions: &[Vec3], timestep: f64, memory: &mut [f64]) -> bool {
        self.change(
            memory,
            |block, memory| self.candidates(block, positions, memory),
            |cell, own| self.advance(cell, positions, timestep, own),
        )
    }

    fn bytes(&self) -> usize {
        self.nodes.bytes()
            + self.blocks.bytes()
            + size_of_val(self.cells.as_slice())
            + 2 * self.material_of_cell.len()
    }

    fn scratch_bytes(&self, scratch: &Scratch) -> usize {
        scratch.downcast_ref().map_or(0, |InelasticScratch { parts, blocks }| {
            size_of::<Vec3>() * parts.capacity() + size_of::<Mat3>() * blocks.capacity()
        })
    }

    /// As if nothing had gone into the reference.
    fn cell_field(&self, cell: usize, positions: &[Vec3]) -> Option<CellField> {
        self.field(cell, positions, |_| Some(Reference::REST))
    }

    fn cell_field_at(&self, cell: usize, at: &Configuration) -> Option<CellField> {
        let own = (cell < self.cells.len()).then(|| self.memory_of(cell, at.memory))?;
        self.field(cell, at.positions, |sample| {
            (!is_torn(own)).then(|| Reference::read(&own[OF_CELL + SAMPLE * sample..][..SAMPLE]))
        })
    }

    fn rest_volume(&self, cell: usize) -> Option<f64> {
        (cell < self.cells.len()).then(|| self.samples_of(cell).map(Sample::volume).sum())
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}

impl InelasticForce {
    /// Means over a cell: the whole deformation, and the stress and energy of its elastic part, none where `reference` of a sample is none.
    fn field(
        &self,
        number: usize,
        positions: &[Vec3],
        reference: impl Fn(usize) -> Option<Reference>,
    ) -> Option<CellField> {
        let volume = self.rest_volume(number)?;
        let law = self.law(number);
        let (mut F, mut stress, mut cauchy) = (Mat3::ZERO, Mat3::ZERO, Mat3::ZERO);
        let (mut energy, mut current) = (0.0, 0.0);
        for (index, sample) in self.samples_of(number).enumerate() {
            let share = sample.volume() / volume;
            let own = self.gradient(number, sample, positions);
            (F, current) = (F + own * share, current + sample.volume() * own.determinant());
            let Some(Reference { inverse, .. }) = reference(index) else { continue };
            let elastic = own * inverse;
            let of_law = law.stress(&elastic);
            stress += of_law.mul_transpose(&inverse) * share;
            cauchy += cauchy_stress(&of_law, &elastic).unwrap_or(Mat3::ZERO) * share;
            energy += law.energy_density(&elastic) * share;
        }
        Some(CellField {
            deformation: F,
            stress,
            cauchy,
            von_mises: von_mises(&cauchy),
            energy_density: energy,
            volume,
            current_volume: current,
        })
    }
}
