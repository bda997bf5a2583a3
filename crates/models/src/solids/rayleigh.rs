//! Stiffness-proportional Rayleigh damping.

use std::any::Any;

use souple_engine::state::Pair;
use souple_engine::{Configuration, Declaration, Energy, Force, Scratch, TangentWeights};
use souple_math::Vec3;
use souple_solve::BlockMatrix;

use super::elements::Elements;
use super::kernel::Kernel;
use super::stiffness::Shapes;
use super::{ByLaw, FlatCell, Kernels, SolidDescription, SolidScratch};
use crate::materials::{AnyLaw, Material, MaterialLaw, Parameters};

/// `f = -β K₀ v` with the stiffness of small strain at rest: linear and symmetric. A rotating body is damped
/// too, in proportion to how far it has turned; [`super::Viscosity`] leaves rigid motion alone. Memory keeps account
/// of the heat, `∫ β vᵀ K₀ v dt` [J].
pub struct RayleighDamping {
    name: String,
    /// The body with the linear law of the same moduli: its tangent is `-K₀` wherever it is.
    elements: Elements<Box<dyn Kernel>>,
    /// `β` [s].
    seconds: f64,
}

impl RayleighDamping {
    /// # Errors
    /// A cell is flat or inverted at rest.
    pub fn new(description: &SolidDescription, seconds: f64) -> Result<Self, FlatCell> {
        let linearised = |material: &Material| {
            let mut of_rest = material.clone();
            if let MaterialLaw::Text(law) = &material.law
                && let Some(linear) = law.anisotropic_at_rest()
            {
                of_rest.law = MaterialLaw::Text(linear);
                return of_rest;
            }
            of_rest.law = MaterialLaw::Known(AnyLaw::Linear);
            material.small_strain.pack(|i, number| of_rest.parameters[i] = number);
            of_rest
        };
        let materials: Vec<Material> = description.materials.iter().map(linearised).collect();
        let linear = SolidDescription { materials: &materials, ..description.clone() };
        let elements =
            Elements::new(&linear, &ByLaw::new(&linear, &Shapes::of_linear(&linear), Kernels::Samples)?)?;
        Ok(Self { name: description.name.clone(), elements, seconds })
    }

    /// `out += scale ∂f/∂x δ` of the elements, wherever they are.
    fn add_stiffness(
        &self,
        at: &Configuration,
        scale: f64,
        delta: &[Vec3],
        scratch: &mut Scratch,
        out: &mut [Vec3],
    ) {
        let partials = &mut SolidScratch::of(scratch).partials;
        self.elements.add_sums([at.positions, delta], partials, out, |batch, chunk, [x, delta], sums| {
            batch.kernel.differential(chunk, &batch.reference, x, delta, scale, sums);
        });
    }
}

impl Force for RayleighDamping {
    fn name(&self) -> &str {
        &self.name
    }

    fn acts_within(&self) -> bool {
        true
    }

    fn declaration(&self) -> Declaration {
        Declaration { conservative: false, velocity_terms: true, internal: false, ..Declaration::ELASTIC }
    }

    fn memory_len(&self) -> usize {
        1
    }

    // it is an account of heat
    fn tangent_reads_memory(&self) -> bool {
        false
    }

    fn new_scratch(&self) -> Scratch {
        SolidScratch::boxed()
    }

    fn energy(&self, at: &Configuration, _: &mut Scratch) -> Energy {
        Energy { stored: 0.0, dissipated: at.memory[0] }
    }

    fn add_force(&self, at: &Configuration, scratch: &mut Scratch, out: &mut [Vec3]) {
        self.add_stiffness(at, self.seconds, at.velocities, scratch, out);
    }

    fn add_differential(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        scratch: &mut Scratch,
        out: &mut [Vec3],
    ) {
        if weights.velocity != 0.0 {
            self.add_stiffness(at, self.seconds * weights.velocity, delta, scratch, out);
        }
    }

    fn visit_cliques(&self, _pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        self.elements.visit_cliques(visit);
    }

    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        if weights.velocity == 0.0 {
            return;
        }
        let scale = self.seconds * weights.velocity;
        let SolidScratch { partials, assembly, .. } = SolidScratch::of(scratch);
        assembly.add_blocks(
            &self.elements,
            [at.positions],
            partials,
            matrix,
            |batch, chunk, blocks, [x], out| {
                batch.kernel.blocks(chunk, blocks, &batch.reference, x, scale, out);
            },
        );
    }

    // heat: ∫ β vᵀ K₀ v dt
    fn advance_memory(&self, at: &Configuration, timestep: f64, memory: &mut [f64], _pairs: &mut [Pair]) {
        let power = self.elements.sum([at.positions, at.velocities], |batch, chunk, [x, v]| {
            batch.kernel.quadratic_form(chunk, &batch.reference, x, v)
        });
        memory[0] += timestep * self.seconds * power;
    }

    fn bytes(&self) -> usize {
        self.elements.bytes()
    }

    fn scratch_bytes(&self, scratch: &Scratch) -> usize {
        SolidScratch::bytes(scratch)
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
