//! Springs from rows to fixed anchors: elastic support, soft pins.

use std::any::Any;

use souple_engine::tangent::add_block;
use souple_engine::{
    Configuration, Declaration, Editable, Energy, Force, Pair, ParameterError, Scratch, TangentWeights,
};
use souple_math::{Mat3, Vec3};
use souple_solve::BlockMatrix;

use super::{Fit, LoadError, editable, finite, not_negative, set_number};

/// One spring of no rest length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundSpring {
    pub row: u32,
    /// Share of the stiffness and damping: 1 where they are per row, a fraction where they are a total.
    pub share: f64,
    /// Where it holds the row [m].
    pub anchor: Vec3,
}

/// `f_i = share_i (-k (x_i - anchor_i) - c v_i)`. What damping takes is kept account of in memory.
#[derive(Clone, Debug)]
pub struct GroundSprings {
    name: String,
    springs: Vec<GroundSpring>,
    stiffness: f64,
    damping: f64,
}

impl GroundSprings {
    /// Stiffness [N/m] and damping [N s/m] are multiplied by each spring's share.
    ///
    /// # Errors
    /// No springs, or a number that is negative or not finite.
    pub fn new(
        name: impl Into<String>,
        springs: Vec<GroundSpring>,
        stiffness: f64,
        damping: f64,
    ) -> Result<Self, LoadError> {
        if springs.is_empty() {
            return Err(LoadError::Empty { field: "springs", expected: "row to hold" });
        }
        for (index, spring) in springs.iter().enumerate() {
            not_negative(format!("springs[{index}].share"), spring.share)?;
            for axis in 0..3 {
                finite(format!("springs[{index}].anchor[{axis}]"), spring.anchor[axis])?;
            }
        }
        not_negative("stiffness", stiffness)?;
        not_negative("damping", damping)?;
        Ok(Self { name: name.into(), springs, stiffness, damping })
    }

    fn factor(&self, weights: TangentWeights) -> f64 {
        -(weights.position * self.stiffness + weights.velocity * self.damping)
    }
}

impl Force for GroundSprings {
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

    // it is an account of heat
    fn tangent_reads_memory(&self) -> bool {
        false
    }

    // E = Σ share k/2 |x - anchor|²
    fn energy(&self, at: &Configuration, _scratch: &mut Scratch) -> Energy {
        let stretch = |s: &GroundSpring| s.share * (at.positions[s.row as usize] - s.anchor).length_sq();
        let stored = 0.5 * self.stiffness * self.springs.iter().map(stretch).sum::<f64>();
        Energy { stored, dissipated: at.memory[0] }
    }

    fn add_force(&self, at: &Configuration, _scratch: &mut Scratch, out: &mut [Vec3]) {
        for spring in &self.springs {
            let row = spring.row as usize;
            let pull =
                (spring.anchor - at.positions[row]) * self.stiffness - at.velocities[row] * self.damping;
            out[row] += pull * spring.share;
        }
    }

    fn add_differential(
        &self,
        _at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        _scratch: &mut Scratch,
        out: &mut [Vec3],
    ) {
        for spring in &self.springs {
            let row = spring.row as usize;
            out[row] += delta[row] * (spring.share * self.factor(weights));
        }
    }

    fn visit_cliques(&self, _pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        self.springs.iter().for_each(|spring| visit(&[spring.row]));
    }

    fn add_blocks(
        &self,
        _: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        for spring in &self.springs {
            let row = spring.row as usize;
            add_block(matrix, row, row, &(Mat3::IDENTITY * (spring.share * self.factor(weights))));
        }
    }

    // heat: ∫ c |v|² dt
    fn advance_memory(&self, at: &Configuration, timestep: f64, memory: &mut [f64], _pairs: &mut [Pair]) {
        let speed_sq = |s: &GroundSpring| s.share * at.velocities[s.row as usize].length_sq();
        memory[0] += timestep * self.damping * self.springs.iter().map(speed_sq).sum::<f64>();
    }

    fn editable(&self) -> Vec<Editable> {
        vec![editable("stiffness", "N/m", self.stiffness), editable("damping", "N s/m", self.damping)]
    }

    fn set_parameter(&mut self, name: &str, value: f64) -> Result<(), ParameterError> {
        let numbers = &mut [
            ("stiffness", &mut self.stiffness, Fit::NotNegative),
            ("damping", &mut self.damping, Fit::NotNegative),
        ];
        set_number(&self.name, numbers, name, value)
    }

    fn bytes(&self) -> usize {
        size_of_val(self.springs.as_slice())
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
