//! Stiffness-proportional Rayleigh damping.

use std::any::Any;

use souple_engine::state::Pair;
use souple_engine::{Configuration, Declaration, Energy, Force, Scratch, TangentWeights};
use souple_math::Vec3;
use souple_solve::BlockMatrix;

use super::{FlatCell, SolidDescription, SolidForce};
use crate::materials::{AnyLaw, Material, Parameters};

/// `f = -β K₀ v` with the stiffness of small strain at rest: linear and symmetric. A rotating body is damped
/// too, in proportion to how far it has turned; [`super::Viscosity`] leaves rigid motion alone.
pub struct RayleighDamping {
    /// The body with the linear law of the same moduli: its tangent is `-K₀` wherever it is.
    stiffness: SolidForce,
    /// `β` [s].
    seconds: f64,
}

impl RayleighDamping {
    /// # Errors
    /// A cell is flat or inverted at rest.
    pub fn new(description: &SolidDescription, seconds: f64) -> Result<Self, FlatCell> {
        let linear = |material: &Material| {
            let mut of_rest = *material;
            of_rest.law = AnyLaw::Linear;
            material.small_strain.pack(|i, number| of_rest.parameters[i] = number);
            of_rest
        };
        let materials: Vec<Material> = description.materials.iter().map(linear).collect();
        let stiffness = SolidForce::new(&SolidDescription { materials: &materials, ..description.clone() })?;
        Ok(Self { stiffness, seconds })
    }

    fn weights(&self, weights: TangentWeights) -> TangentWeights {
        TangentWeights { position: weights.velocity * self.seconds, velocity: 0.0 }
    }
}

impl Force for RayleighDamping {
    fn name(&self) -> &str {
        self.stiffness.name()
    }

    fn declaration(&self) -> Declaration {
        Declaration { conservative: false, velocity_terms: true, internal: false, ..Declaration::ELASTIC }
    }

    fn new_scratch(&self) -> Scratch {
        self.stiffness.new_scratch()
    }

    fn energy(&self, _: &Configuration, _: &mut Scratch) -> Energy {
        Energy::default()
    }

    fn add_force(&self, at: &Configuration, scratch: &mut Scratch, out: &mut [Vec3]) {
        let weights = TangentWeights { position: self.seconds, velocity: 0.0 };
        self.stiffness.add_differential(at, weights, at.velocities, scratch, out);
    }

    fn add_differential(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        scratch: &mut Scratch,
        out: &mut [Vec3],
    ) {
        self.stiffness.add_differential(at, self.weights(weights), delta, scratch, out);
    }

    fn visit_cliques(&self, pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        self.stiffness.visit_cliques(pairs, visit);
    }

    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        self.stiffness.add_blocks(at, self.weights(weights), scratch, matrix);
    }

    fn bytes(&self) -> usize {
        self.stiffness.bytes()
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
