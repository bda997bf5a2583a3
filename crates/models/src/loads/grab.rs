//! A hand on a body: a damped spring from a material point to a target that is edited while running.

use std::any::Any;

use souple_engine::{
    Configuration, Declaration, Editable, Energy, Force, Pair, ParameterError, Scratch, TangentWeights,
};
use souple_math::{Mat3, Vec3};
use souple_solve::BlockMatrix;

use super::{Combination, Fit, LoadError, editable, finite, not_negative, set_number};

/// `f = -k (x - target) - c ẋ` on `x = Σ weight · row`. A stiffness and damping of zero let go.
#[derive(Clone, Debug)]
pub struct Grab {
    name: String,
    point: Combination,
    target: Vec3,
    stiffness: f64,
    damping: f64,
}

impl Grab {
    /// Target [m], stiffness [N/m], damping [N s/m].
    ///
    /// # Errors
    /// A number that is not finite, or a negative stiffness or damping.
    pub fn new(
        name: impl Into<String>,
        point: Combination,
        target: Vec3,
        stiffness: f64,
        damping: f64,
    ) -> Result<Self, LoadError> {
        for axis in 0..3 {
            finite(format!("target[{axis}]"), target[axis])?;
        }
        not_negative("stiffness", stiffness)?;
        not_negative("damping", damping)?;
        Ok(Self { name: name.into(), point, target, stiffness, damping })
    }

    pub fn target(&self) -> Vec3 {
        self.target
    }

    /// The pull on the body [N].
    pub fn pull(&self, at: &Configuration) -> Vec3 {
        (self.target - self.point.of(at.positions)) * self.stiffness
            - self.point.of(at.velocities) * self.damping
    }

    fn factor(&self, weights: TangentWeights) -> f64 {
        -(weights.position * self.stiffness + weights.velocity * self.damping)
    }
}

impl Force for Grab {
    fn name(&self) -> &str {
        &self.name
    }

    fn declaration(&self) -> Declaration {
        let damped = self.damping > 0.0;
        Declaration { conservative: !damped, velocity_terms: damped, ..Declaration::LOAD }
    }

    fn memory_len(&self) -> usize {
        1
    }

    // E = k/2 |x - target|²
    fn energy(&self, at: &Configuration, _scratch: &mut Scratch) -> Energy {
        let stretch_sq = (self.point.of(at.positions) - self.target).length_sq();
        Energy { stored: 0.5 * self.stiffness * stretch_sq, dissipated: at.memory[0] }
    }

    fn add_force(&self, at: &Configuration, _scratch: &mut Scratch, out: &mut [Vec3]) {
        self.point.spread(self.pull(at), out);
    }

    fn add_differential(
        &self,
        _at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        _scratch: &mut Scratch,
        out: &mut [Vec3],
    ) {
        self.point.spread(self.point.of(delta) * self.factor(weights), out);
    }

    fn visit_cliques(&self, _pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        let rows: Vec<u32> = self.point.rows().iter().map(|&(row, _)| row).collect();
        visit(&rows);
    }

    fn add_blocks(
        &self,
        _: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        self.point.add_blocks(&self.point, &(Mat3::IDENTITY * self.factor(weights)), matrix);
    }

    // heat: ∫ c |ẋ|² dt
    fn advance_memory(&self, at: &Configuration, timestep: f64, memory: &mut [f64], _pairs: &mut [Pair]) {
        memory[0] += timestep * self.damping * self.point.of(at.velocities).length_sq();
    }

    fn editable(&self) -> Vec<Editable> {
        vec![
            editable("target_x", "m", self.target.x),
            editable("target_y", "m", self.target.y),
            editable("target_z", "m", self.target.z),
            editable("stiffness", "N/m", self.stiffness),
            editable("damping", "N s/m", self.damping),
        ]
    }

    fn set_parameter(&mut self, name: &str, value: f64) -> Result<(), ParameterError> {
        let numbers = &mut [
            ("target_x", &mut self.target.x, Fit::Finite),
            ("target_y", &mut self.target.y, Fit::Finite),
            ("target_z", &mut self.target.z, Fit::Finite),
            ("stiffness", &mut self.stiffness, Fit::NotNegative),
            ("damping", &mut self.damping, Fit::NotNegative),
        ];
        set_number(&self.name, numbers, name, value)
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
