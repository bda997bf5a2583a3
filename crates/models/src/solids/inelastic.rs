//! Solids whose rest shape gives way: creep, yielding and fracture of bodies of finite elements.
//!
//! The deformation is an elastic one of a reference that has changed, `F = F_e F_p`, at each sample of each cell (Terzopoulos & Fleischer
//! 1988, as solids of large strain have it). The law of the body, whichever it is, sees `F_e = F F_p⁻¹`: the cell is one
//! whose rest gradients are `F_p⁻ᵀ ∇N`. The reference keeps its volume. `F_p` is memory: within a step the force has an energy and exact
//! derivatives, and once in each step what has been strained goes over into the reference: at its end, under explicit steppers at its start.
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
//! The equivalent stress of an isotropic law is no more than the threshold where the reference moves on, and may be above it elsewhere by what a step
//! strains: take steps that strain little.
//!
//! Source: Terzopoulos & Fleischer 1988, §5; Simo & Hughes 1998, §9.3 (logarithmic strain, return to the threshold).

use std::any::Any;

use souple_engine::state::Pair;
use souple_engine::tangent::add_block;
use souple_engine::{CellField, Configuration, Declaration, Energy, Force, Scratch, TangentWeights};
use souple_math::{Mat3, Vec3, eigen_symmetric};
use souple_mesh::MAX_NODES;
use souple_solve::BlockMatrix;

use super::{FlatCell, SolidDescription};
use crate::materials::{Material, Oriented, cauchy_stress, von_mises};

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

/// A point of a cell where the law is asked.
struct Sample {
    /// At rest [m³].
    volume: f64,
    /// `∇N` of each node at rest [1/m].
    gradients: Vec<Vec3>,
}

struct Cell {
    rows: Vec<u32>,
    samples: Vec<Sample>,
    /// Where its samples begin in memory.
    memory: usize,
    /// What its limits of fracture are multiplied by.
    strength: f64,
}

/// Numbers of memory before those of cells: what has been given off [J].
const HEAT: usize = 0;
const FIRST: usize = 1;
/// Of a cell, before its samples: 1 where it is torn.
const TORN: usize = 1;
/// Of a sample: `F_p` by columns, then `ε̄`.
const SAMPLE: usize = 10;

/// What a sample remembers.
struct Reference {
    F: Mat3,
    yielded: f64,
}

impl Reference {
    const REST: Self = Self { F: Mat3::IDENTITY, yielded: 0.0 };

    fn read(memory: &[f64]) -> Self {
        let column = |j: usize| Vec3::new(memory[3 * j], memory[3 * j + 1], memory[3 * j + 2]);
        Self { F: Mat3::from_columns(column(0), column(1), column(2)), yielded: memory[9] }
    }

    fn write(&self, memory: &mut [f64]) {
        for (slots, column) in memory.chunks_exact_mut(3).zip(self.F.columns) {
            slots.copy_from_slice(&column.to_array());
        }
        memory[9] = self.yielded;
    }

    /// `F_p⁻¹`; its volume is that of rest.
    fn inverse(&self) -> Mat3 {
        self.F.try_inverse().unwrap_or(Mat3::IDENTITY)
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

/// Elastic force of a body whose reference changes: of any law and any element of volume, sample by sample.
pub struct InelasticForce {
    name: String,
    cells: Vec<Cell>,
    materials: Vec<Material>,
    material_of_cell: Vec<u16>,
    axes: Vec<Mat3>,
    rules: Inelasticity,
    memory_len: usize,
    is_internal: bool,
}

impl InelasticForce {
    /// # Errors
    /// A cell is flat or inverted at rest.
    pub fn new(description: &SolidDescription, rules: Inelasticity) -> Result<Self, FlatCell> {
        let SolidDescription { name, mesh, first_row, materials, material_of_cell, axes, quadrature, .. } =
            description;
        let mut cells = Vec::with_capacity(mesh.cell_count());
        let mut memory = FIRST;
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
                let gradients = gradients.iter().map(|by_xi| inverse.transpose_apply(*by_xi)).collect();
                samples.push(Sample { volume: determinant * point.weight, gradients });
            }
            let strength = rules.fracture.map_or(1.0, |fracture| fracture.strength(number as u64));
            let rows = cell.nodes.iter().map(|node| *first_row as u32 + node).collect();
            let count = samples.len();
            cells.push(Cell { rows, samples, memory, strength });
            memory += TORN + SAMPLE * count;
        }
        Ok(Self {
            name: name.clone(),
            cells,
            is_internal: materials.iter().all(|material| material.law.is_objective()),
            materials: materials.to_vec(),
            material_of_cell: material_of_cell.to_vec(),
            axes: axes.to_vec(),
            rules,
            memory_len: memory,
        })
    }

    fn law(&self, cell: usize) -> Oriented<'_> {
        self.materials[usize::from(self.material_of_cell[cell])].along(self.axes.get(cell))
    }

    /// Calls `visit` for every sample of cells that are whole, with the gradients of its nodes in the changed reference, of which there
    /// are as many as rows, and `F_e`.
    fn for_samples(&self, at: &Configuration, mut visit: impl FnMut(usize, &Cell, f64, &[Vec3], &Mat3)) {
        let mut gradients = [Vec3::ZERO; MAX_NODES];
        for (number, cell) in self.cells.iter().enumerate() {
            if cell.is_torn(at.memory) {
                continue;
            }
            for (index, sample) in cell.samples.iter().enumerate() {
                let inverse = cell.reference(index, at.memory).inverse();
                for (changed, gradient) in gradients.iter_mut().zip(&sample.gradients) {
                    *changed = inverse.transpose_apply(*gradient);
                }
                let gradients = &gradients[..cell.rows.len()];
                let F = cell.gradient(at.positions, gradients);
                visit(number, cell, sample.volume, gradients, &F);
            }
        }
    }
}

impl Cell {
    fn is_torn(&self, memory: &[f64]) -> bool {
        memory[self.memory] > 0.0
    }

    fn reference(&self, sample: usize, memory: &[f64]) -> Reference {
        Reference::read(&memory[self.memory + TORN + SAMPLE * sample..][..SAMPLE])
    }

    /// `Σ x ⊗ gradient`.
    fn gradient(&self, positions: &[Vec3], gradients: &[Vec3]) -> Mat3 {
        let mut F = Mat3::ZERO;
        for (row, gradient) in self.rows.iter().zip(gradients) {
            F += positions[*row as usize].outer(*gradient);
        }
        F
    }

    /// Energy of all its samples [J].
    fn energy(&self, law: &Oriented, positions: &[Vec3], memory: &[f64]) -> f64 {
        let of_sample = |(index, sample): (usize, &Sample)| {
            let F = self.gradient(positions, &sample.gradients) * self.reference(index, memory).inverse();
            sample.volume * law.energy_density(&F)
        };
        self.samples.iter().enumerate().map(of_sample).sum()
    }
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
        let stretch = eigen_symmetric(&F.gram()).values.largest_component().sqrt();
        let pull = cauchy_stress(&law.stress(F), F)
            .map_or(0.0, |stress| eigen_symmetric(&stress).values.to_array().into_iter().fold(0.0, f64::max));
        stretch - 1.0 > self.strain * strength || pull > self.stress * strength
    }
}

/// Equivalent stress of an elastic deformation [Pa].
fn equivalent_stress(law: &Oriented, F: &Mat3) -> f64 {
    cauchy_stress(&law.stress(F), F).map_or(0.0, |stress| von_mises(&stress))
}

/// Halvings of an interval from 0 to 1: to the last place.
const HALVINGS: usize = 53;

impl Yielding {
    /// The share of the elastic strain of shape that goes into the reference.
    fn share(&self, law: &Oriented, F: &Mat3, strain: &Strain, yielded: f64) -> f64 {
        let excess = |share: f64| {
            let threshold = self.stress + self.hardening * (yielded + share * strain.equivalent());
            equivalent_stress(law, &(*F * strain.exponential(-share))) - threshold
        };
        if excess(0.0) <= 0.0 {
            return 0.0;
        }
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
    /// Brings a sample on by `timestep`, at its deformation `F`.
    fn advance(&self, law: &Oriented, F: &Mat3, timestep: f64, reference: &mut Reference) {
        let give = |share: f64, strain: &Strain, reference: &mut Reference| {
            reference.F = strain.exponential(share) * reference.F;
        };
        if let Some(time) = self.creep_time
            && let Some(strain) = Strain::of(&(*F * reference.inverse()))
        {
            give(-libm::expm1(-timestep / time), &strain, reference);
        }
        if let Some(yielding) = self.yielding {
            let elastic = *F * reference.inverse();
            let Some(strain) = Strain::of(&elastic) else { return };
            let share = yielding.share(law, &elastic, &strain, reference.yielded);
            if share > 0.0 {
                give(share, &strain, reference);
                reference.yielded += share * strain.equivalent();
            }
        }
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
            for sample in memory[cell.memory + TORN..][..SAMPLE * cell.samples.len()].chunks_exact_mut(SAMPLE)
            {
                Reference::REST.write(sample);
            }
        }
    }

    fn energy(&self, at: &Configuration, _scratch: &mut Scratch) -> Energy {
        let mut stored = 0.0;
        self.for_samples(at, |cell, _, volume, _, F| stored += volume * self.law(cell).energy_density(F));
        Energy { stored, dissipated: at.memory[HEAT] }
    }

    // f_a = -Σ V P(F_e) F_p⁻ᵀ ∇N_a
    fn add_force(&self, at: &Configuration, _scratch: &mut Scratch, out: &mut [Vec3]) {
        self.for_samples(at, |number, cell, volume, gradients, F| {
            let stress = self.law(number).stress(F) * volume;
            for (row, gradient) in cell.rows.iter().zip(gradients) {
                out[*row as usize] -= stress * *gradient;
            }
        });
    }

    fn add_differential(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        _scratch: &mut Scratch,
        out: &mut [Vec3],
    ) {
        if weights.position == 0.0 {
            return;
        }
        self.for_samples(at, |number, cell, volume, gradients, F| {
            let dF = cell.gradient(delta, gradients);
            let change = self.law(number).stress_differential(F, &dF) * (volume * weights.position);
            for (row, gradient) in cell.rows.iter().zip(gradients) {
                out[*row as usize] -= change * *gradient;
            }
        });
    }

    fn visit_cliques(&self, _pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        self.cells.iter().for_each(|cell| visit(&cell.rows));
    }

    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        _scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        if weights.position == 0.0 {
            return;
        }
        self.for_samples(at, |number, cell, volume, gradients, F| {
            let law = self.law(number);
            for (column, gradient) in cell.rows.iter().zip(gradients) {
                let changes = Vec3::AXES.map(|axis| {
                    law.stress_differential(F, &axis.outer(*gradient)) * (-volume * weights.position)
                });
                for (row, gradient) in cell.rows.iter().zip(gradients) {
                    let [x, y, z] = changes.map(|change| change * *gradient);
                    add_block(matrix, *row as usize, *column as usize, &Mat3::from_columns(x, y, z));
                }
            }
        });
    }

    fn advance_memory(&self, at: &Configuration, timestep: f64, memory: &mut [f64], _pairs: &mut [Pair]) {
        for (number, cell) in self.cells.iter().enumerate() {
            if cell.is_torn(memory) {
                continue;
            }
            let law = self.law(number);
            let before = cell.energy(&law, at.positions, memory);
            let mut is_torn = false;
            for (index, sample) in cell.samples.iter().enumerate() {
                let F = cell.gradient(at.positions, &sample.gradients);
                let mut reference = cell.reference(index, memory);
                self.rules.advance(&law, &F, timestep, &mut reference);
                let elastic = F * reference.inverse();
                let tears = |fracture: Fracture| fracture.is_exceeded(&law, &elastic, cell.strength);
                is_torn |= self.rules.fracture.is_some_and(tears);
                reference.write(&mut memory[cell.memory + TORN + SAMPLE * index..][..SAMPLE]);
            }
            if is_torn {
                memory[cell.memory] = 1.0;
            }
            let after = if is_torn { 0.0 } else { cell.energy(&law, at.positions, memory) };
            memory[HEAT] += before - after;
        }
    }

    fn bytes(&self) -> usize {
        let of_sample = |sample: &Sample| size_of::<Sample>() + size_of_val(sample.gradients.as_slice());
        let of_cell = |cell: &Cell| {
            size_of::<Cell>()
                + size_of_val(cell.rows.as_slice())
                + cell.samples.iter().map(of_sample).sum::<usize>()
        };
        self.cells.iter().map(of_cell).sum::<usize>() + 2 * self.material_of_cell.len()
    }

    /// As if nothing had gone into the reference.
    fn cell_field(&self, cell: usize, positions: &[Vec3]) -> Option<CellField> {
        self.field(cell, positions, |_, _| Some(Reference::REST))
    }

    fn cell_field_at(&self, cell: usize, at: &Configuration) -> Option<CellField> {
        self.field(cell, at.positions, |cell, sample| {
            (!cell.is_torn(at.memory)).then(|| cell.reference(sample, at.memory))
        })
    }

    fn rest_volume(&self, cell: usize) -> Option<f64> {
        Some(self.cells.get(cell)?.samples.iter().map(|sample| sample.volume).sum())
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}

impl InelasticForce {
    /// Means over a cell: the whole deformation, and the stress and energy of its elastic part, none where `reference` of a cell and its
    /// sample is none.
    fn field(
        &self,
        number: usize,
        positions: &[Vec3],
        reference: impl Fn(&Cell, usize) -> Option<Reference>,
    ) -> Option<CellField> {
        let cell = self.cells.get(number)?;
        let law = self.law(number);
        let volume: f64 = cell.samples.iter().map(|sample| sample.volume).sum();
        let (mut F, mut stress, mut cauchy) = (Mat3::ZERO, Mat3::ZERO, Mat3::ZERO);
        let (mut energy, mut current) = (0.0, 0.0);
        for (index, sample) in cell.samples.iter().enumerate() {
            let share = sample.volume / volume;
            let own = cell.gradient(positions, &sample.gradients);
            (F, current) = (F + own * share, current + sample.volume * own.determinant());
            let Some(reference) = reference(cell, index) else { continue };
            let inverse = reference.inverse();
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
