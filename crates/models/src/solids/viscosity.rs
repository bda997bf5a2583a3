//! Kelvin–Voigt damping: stress proportional to the rate of strain, none in rigid motion.

use std::any::Any;

use souple_engine::state::Pair;
use souple_engine::{Configuration, Declaration, Energy, Force, Scratch, TangentWeights};
use souple_math::Vec3;
use souple_mesh::{ElementKind, MAX_NODES, QuadratureRule};
use souple_solve::BlockMatrix;

use super::SolidDescription;
use super::assembly::{Assembly, Symmetry};
use super::elements::{Elements, Sorting};
use super::geometry::{AnyElement, Tetrahedron};
use super::layout::FlatCell;
use super::viscous_kernel::{Flow, StrainRate, ViscousKernel};

/// `P = F S`, `S = 2 η Ė`, `Ė = sym(Fᵀ Ḟ)`, with the viscosity `η` [Pa s]. Memory keeps account of the heat,
/// `∫∫ 2 η Ė:Ė dV dt` [J].
pub struct Viscosity {
    name: String,
    elements: Elements<Box<dyn ViscousKernel>>,
}

/// All elements alike, with the one number `2 η`.
struct Alike([f64; 1]);

impl Sorting for Alike {
    type Law = ();
    type Kernel = Box<dyn ViscousKernel>;

    fn law_of(&self, _cell: usize) -> &() {
        &()
    }

    fn parameters_of(&self, _cell: usize) -> &[f64] {
        &self.0
    }

    fn kernel(&self, kind: ElementKind, _: &QuadratureRule, (): &()) -> Box<dyn ViscousKernel> {
        match kind {
            ElementKind::Tet4 => Box::new(StrainRate::<Tetrahedron, 4>::new(4)),
            _ => Box::new(StrainRate::<AnyElement, MAX_NODES>::new(kind.node_count())),
        }
    }
}

impl Viscosity {
    /// # Errors
    /// A cell is flat or inverted at rest.
    pub fn new(description: &SolidDescription, viscosity: f64) -> Result<Self, FlatCell> {
        let elements = Elements::new(description, &Alike([2.0 * viscosity]))?;
        Ok(Self { name: description.name.clone(), elements })
    }

    fn assemble(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        symmetry: Symmetry,
        (assembly, partials): (&mut Assembly, &mut Vec<Vec3>),
        matrix: &mut BlockMatrix,
    ) {
        assembly.add_blocks(
            &self.elements,
            [at.positions, at.velocities],
            partials,
            matrix,
            |batch, chunk, blocks, [positions, velocities], out| {
                let flow = Flow { chunk, reference: &batch.reference, positions, velocities };
                batch.kernel.blocks(flow, blocks, weights, symmetry, out);
            },
        );
    }
}

/// Lists and sums of both kinds of blocks, kept between calls.
struct ViscousScratch {
    partials: Vec<Vec3>,
    general: Assembly,
    symmetric: Assembly,
}

impl ViscousScratch {
    fn of(scratch: &mut Scratch) -> &mut Self {
        scratch.downcast_mut().unwrap_or_else(|| unreachable!("made by this force's own new_scratch"))
    }

    fn bytes(&self) -> usize {
        24 * self.partials.capacity() + self.general.bytes() + self.symmetric.bytes()
    }
}

impl Force for Viscosity {
    fn name(&self) -> &str {
        &self.name
    }

    fn acts_within(&self) -> bool {
        true
    }

    fn declaration(&self) -> Declaration {
        Declaration {
            conservative: false,
            velocity_terms: true,
            symmetric_tangent: false,
            ..Declaration::ELASTIC
        }
    }

    fn memory_len(&self) -> usize {
        1
    }

    // it is an account of heat
    fn tangent_reads_memory(&self) -> bool {
        false
    }

    fn new_scratch(&self) -> Scratch {
        Box::new(ViscousScratch {
            partials: Vec::new(),
            general: Assembly::new(Symmetry::General),
            symmetric: Assembly::new(Symmetry::Symmetric),
        })
    }

    fn energy(&self, at: &Configuration, _: &mut Scratch) -> Energy {
        Energy { stored: 0.0, dissipated: at.memory[0] }
    }

    fn add_force(&self, at: &Configuration, scratch: &mut Scratch, out: &mut [Vec3]) {
        let (partials, inputs) = (&mut ViscousScratch::of(scratch).partials, [at.positions, at.velocities]);
        self.elements.add_sums(inputs, partials, out, |batch, chunk, [positions, velocities], sums| {
            let flow = Flow { chunk, reference: &batch.reference, positions, velocities };
            batch.kernel.forces(flow, sums);
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
        let partials = &mut ViscousScratch::of(scratch).partials;
        let inputs = [at.positions, at.velocities, delta];
        self.elements.add_sums(
            inputs,
            partials,
            out,
            |batch, chunk, [positions, velocities, delta], sums| {
                let flow = Flow { chunk, reference: &batch.reference, positions, velocities };
                batch.kernel.differential(flow, delta, weights, sums);
            },
        );
    }

    fn visit_cliques(&self, _: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        self.elements.visit_cliques(visit);
    }

    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        let ViscousScratch { partials, general, .. } = ViscousScratch::of(scratch);
        self.assemble(at, weights, Symmetry::General, (general, partials), matrix);
    }

    fn add_symmetric_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        let ViscousScratch { partials, symmetric, .. } = ViscousScratch::of(scratch);
        self.assemble(at, weights, Symmetry::Symmetric, (symmetric, partials), matrix);
    }

    // heat: ∫∫ 2 η Ė:Ė dV dt
    fn advance_memory(&self, at: &Configuration, timestep: f64, memory: &mut [f64], _pairs: &mut [Pair]) {
        let inputs = [at.positions, at.velocities];
        let power = self.elements.sum(inputs, |batch, chunk, [positions, velocities]| {
            batch.kernel.power(Flow { chunk, reference: &batch.reference, positions, velocities })
        });
        memory[0] += timestep * power;
    }

    fn bytes(&self) -> usize {
        self.elements.bytes()
    }

    fn scratch_bytes(&self, scratch: &Scratch) -> usize {
        scratch.downcast_ref().map_or(0, ViscousScratch::bytes)
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
