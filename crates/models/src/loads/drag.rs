//! Drag: resistance to motion against the surroundings, per row or proportional to mass.

use std::any::Any;

use souple_engine::tangent::add_block;
use souple_engine::{
    Configuration, Declaration, Editable, Energy, Force, Mass, Pair, ParameterError, Scratch, TangentWeights,
};
use souple_math::{Mat3, Vec3};
use souple_solve::BlockMatrix;

use super::{Fit, LoadError, editable, not_negative, set_number};

/// Not a potential, linear in the velocity, symmetric, and braked against the world.
const DECLARATION: Declaration =
    Declaration { conservative: false, velocity_terms: true, ..Declaration::LOAD };

/// `f_i = -c share_i v_i`: viscous surroundings. What it takes is kept account of in memory.
#[derive(Clone, Debug)]
pub struct Drag {
    name: String,
    rows: Vec<(u32, f64)>,
    coefficient: f64,
}

impl Drag {
    /// `coefficient` [N s/m] times the share of each row.
    ///
    /// # Errors
    /// No rows, or a number that is negative or not finite.
    pub fn new(name: impl Into<String>, rows: Vec<(u32, f64)>, coefficient: f64) -> Result<Self, LoadError> {
        if rows.is_empty() {
            return Err(LoadError::Empty { field: "rows", expected: "row that is braked" });
        }
        for (index, (_, share)) in rows.iter().enumerate() {
            not_negative(format!("rows[{index}].share"), *share)?;
        }
        not_negative("coefficient", coefficient)?;
        Ok(Self { name: name.into(), rows, coefficient })
    }
}

impl Force for Drag {
    fn name(&self) -> &str {
        &self.name
    }

    fn declaration(&self) -> Declaration {
        DECLARATION
    }

    fn memory_len(&self) -> usize {
        1
    }

    // it is an account of heat
    fn tangent_reads_memory(&self) -> bool {
        false
    }

    fn energy(&self, at: &Configuration, _scratch: &mut Scratch) -> Energy {
        Energy { stored: 0.0, dissipated: at.memory[0] }
    }

    fn add_force(&self, at: &Configuration, _scratch: &mut Scratch, out: &mut [Vec3]) {
        for &(row, share) in &self.rows {
            out[row as usize] -= at.velocities[row as usize] * (self.coefficient * share);
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
        for &(row, share) in &self.rows {
            out[row as usize] -= delta[row as usize] * (weights.velocity * self.coefficient * share);
        }
    }

    fn visit_cliques(&self, _pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        self.rows.iter().for_each(|&(row, _)| visit(&[row]));
    }

    fn add_blocks(
        &self,
        _: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        for &(row, share) in &self.rows {
            let block = Mat3::IDENTITY * (-weights.velocity * self.coefficient * share);
            add_block(matrix, row as usize, row as usize, &block);
        }
    }

    // heat: ∫ c |v|² dt
    fn advance_memory(&self, at: &Configuration, timestep: f64, memory: &mut [f64], _pairs: &mut [Pair]) {
        let speed_sq = |&(row, share): &(u32, f64)| share * at.velocities[row as usize].length_sq();
        memory[0] += timestep * self.coefficient * self.rows.iter().map(speed_sq).sum::<f64>();
    }

    fn editable(&self) -> Vec<Editable> {
        vec![editable("coefficient", "N s/m", self.coefficient)]
    }

    fn set_parameter(&mut self, name: &str, value: f64) -> Result<(), ParameterError> {
        set_number(&self.name, &mut [("coefficient", &mut self.coefficient, Fit::NotNegative)], name, value)
    }

    fn bytes(&self) -> usize {
        size_of_val(self.rows.as_slice())
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}

/// `f = -α M v`, the mass term of Rayleigh damping: every free motion decays like `exp(-α t)` or, where it
/// oscillates, `exp(-α t / 2)`.
#[derive(Clone, Debug)]
pub struct MassDamping {
    name: String,
    mass: Mass,
    rate: f64,
}

impl MassDamping {
    /// `rate` is `α` [1/s]; `mass` may be a part of the system's.
    ///
    /// # Errors
    /// The rate is negative or not finite.
    pub fn new(name: impl Into<String>, mass: Mass, rate: f64) -> Result<Self, LoadError> {
        not_negative("rate", rate)?;
        Ok(Self { name: name.into(), mass, rate })
    }
}

impl Force for MassDamping {
    fn name(&self) -> &str {
        &self.name
    }

    fn declaration(&self) -> Declaration {
        DECLARATION
    }

    fn memory_len(&self) -> usize {
        1
    }

    // it is an account of heat
    fn tangent_reads_memory(&self) -> bool {
        false
    }

    fn energy(&self, at: &Configuration, _scratch: &mut Scratch) -> Energy {
        Energy { stored: 0.0, dissipated: at.memory[0] }
    }

    fn add_force(&self, at: &Configuration, _scratch: &mut Scratch, out: &mut [Vec3]) {
        self.mass.add_scaled_product(-self.rate, at.velocities, out);
    }

    fn add_differential(
        &self,
        _at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        _scratch: &mut Scratch,
        out: &mut [Vec3],
    ) {
        self.mass.add_scaled_product(-self.rate * weights.velocity, delta, out);
    }

    fn visit_cliques(&self, _pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        (0..self.mass.diagonal.len() as u32).for_each(|row| visit(&[row]));
        self.mass.couplings.iter().for_each(|&(a, b, _)| visit(&[a, b]));
    }

    fn add_blocks(
        &self,
        _: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        let scale = -self.rate * weights.velocity;
        for (row, mass) in self.mass.diagonal.iter().enumerate() {
            add_block(matrix, row, row, &(Mat3::IDENTITY * (mass * scale)));
        }
        for &(a, b, mass) in &self.mass.couplings {
            let block = Mat3::IDENTITY * (mass * scale);
            add_block(matrix, a as usize, b as usize, &block);
            add_block(matrix, b as usize, a as usize, &block);
        }
    }

    // heat: ∫ α vᵀ M v dt
    fn advance_memory(&self, at: &Configuration, timestep: f64, memory: &mut [f64], _pairs: &mut [Pair]) {
        memory[0] += timestep * self.rate * 2.0 * self.mass.kinetic_energy(at.velocities);
    }

    fn editable(&self) -> Vec<Editable> {
        vec![editable("rate", "1/s", self.rate)]
    }

    fn set_parameter(&mut self, name: &str, value: f64) -> Result<(), ParameterError> {
        set_number(&self.name, &mut [("rate", &mut self.rate, Fit::NotNegative)], name, value)
    }

    fn bytes(&self) -> usize {
        size_of_val(self.mass.diagonal.as_slice()) + size_of_val(self.mass.couplings.as_slice())
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
