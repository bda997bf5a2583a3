//! Small forces that stand for those of later rooms.

use std::any::Any;

use souple_engine::state::Pair;
use souple_engine::tangent::add_block;
use souple_engine::{
    Configuration, Declaration, Editable, Energy, Force, ParameterError, Scratch, TangentWeights,
};
use souple_math::{Mat3, Vec3};
use souple_solve::BlockMatrix;

/// `f_a = -k (x_a - x_b) - c (v_a - v_b)`, of no rest length.
pub struct Spring {
    pub a: u32,
    pub b: u32,
    pub stiffness: f64,
    pub damping: f64,
}

impl Spring {
    fn factor(&self, weights: TangentWeights) -> f64 {
        weights.position * self.stiffness + weights.velocity * self.damping
    }
}

impl Force for Spring {
    fn name(&self) -> &str {
        "spring"
    }
    fn declaration(&self) -> Declaration {
        let damped = self.damping != 0.0;
        Declaration { conservative: !damped, velocity_terms: damped, ..Declaration::ELASTIC }
    }
    fn energy(&self, at: &Configuration, _: &mut Scratch) -> Energy {
        let stretch = at.positions[self.a as usize] - at.positions[self.b as usize];
        Energy { stored: 0.5 * self.stiffness * stretch.length_sq(), dissipated: 0.0 }
    }
    fn add_force(&self, at: &Configuration, _: &mut Scratch, out: &mut [Vec3]) {
        let (a, b) = (self.a as usize, self.b as usize);
        let force = (at.positions[a] - at.positions[b]) * -self.stiffness
            - (at.velocities[a] - at.velocities[b]) * self.damping;
        out[a] += force;
        out[b] -= force;
    }
    fn add_differential(
        &self,
        _: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        _: &mut Scratch,
        out: &mut [Vec3],
    ) {
        let (a, b) = (self.a as usize, self.b as usize);
        let change = (delta[a] - delta[b]) * -self.factor(weights);
        out[a] += change;
        out[b] -= change;
    }
    fn visit_cliques(&self, _: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        visit(&[self.a, self.b]);
    }
    fn add_blocks(
        &self,
        _: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        let block = Mat3::IDENTITY * self.factor(weights);
        let (a, b) = (self.a as usize, self.b as usize);
        add_block(matrix, a, a, &-block);
        add_block(matrix, b, b, &-block);
        add_block(matrix, a, b, &block);
        add_block(matrix, b, a, &block);
    }
    fn editable(&self) -> Vec<Editable> {
        vec![Editable { name: "stiffness", unit: "N/m", value: self.stiffness }]
    }
    fn set_parameter(&mut self, name: &str, value: f64) -> Result<(), ParameterError> {
        let (force, name) = ("spring".to_owned(), name.to_owned());
        match name.as_str() {
            "stiffness" if value >= 0.0 && value.is_finite() => self.stiffness = value,
            "stiffness" => {
                return Err(ParameterError::Unfit { force, name, value, expected: "0 or more".into() });
            }
            _ => return Err(ParameterError::Unknown { force, name, known: vec!["stiffness".into()] }),
        }
        Ok(())
    }
    fn as_any(&self) -> &dyn Any {
        self
    }
}

/// A spring along x from the origin to point 0 that yields at `limit` newtons: perfect plasticity, its
/// plastic stretch in memory.
pub struct PlasticLink {
    pub stiffness: f64,
    pub limit: f64,
}

impl PlasticLink {
    /// The force at a stretch, and the plastic stretch it leaves (return mapping).
    fn pull(&self, stretch: f64, plastic: f64) -> (f64, f64) {
        let trial = self.stiffness * (stretch - plastic);
        if trial.abs() <= self.limit {
            return (-trial, plastic);
        }
        let force = self.limit.copysign(trial);
        (-force, stretch - force / self.stiffness)
    }
}

impl Force for PlasticLink {
    fn name(&self) -> &str {
        "plastic"
    }
    fn declaration(&self) -> Declaration {
        Declaration { conservative: false, ..Declaration::LOAD }
    }
    fn memory_len(&self) -> usize {
        2
    }
    fn energy(&self, at: &Configuration, _: &mut Scratch) -> Energy {
        let (force, _) = self.pull(at.positions[0].x, at.memory[0]);
        Energy { stored: 0.5 * force * force / self.stiffness, dissipated: at.memory[1] }
    }
    fn add_force(&self, at: &Configuration, _: &mut Scratch, out: &mut [Vec3]) {
        out[0].x += self.pull(at.positions[0].x, at.memory[0]).0;
    }
    fn add_differential(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        _: &mut Scratch,
        out: &mut [Vec3],
    ) {
        if self.pull(at.positions[0].x, at.memory[0]).1 == at.memory[0] {
            out[0].x -= weights.position * self.stiffness * delta[0].x;
        }
    }
    fn visit_cliques(&self, _: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        visit(&[0]);
    }
    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        if self.pull(at.positions[0].x, at.memory[0]).1 == at.memory[0] {
            add_block(matrix, 0, 0, &(Vec3::X.outer(Vec3::X) * (-weights.position * self.stiffness)));
        }
    }
    fn advance_memory(&self, at: &Configuration, _: f64, memory: &mut [f64], _: &mut [Pair]) {
        let (force, plastic) = self.pull(at.positions[0].x, at.memory[0]);
        memory[1] += (force * (plastic - memory[0])).abs();
        memory[0] = plastic;
    }
    fn as_any(&self) -> &dyn Any {
        self
    }
}

/// A constant force on one row.
pub struct Push {
    pub row: u32,
    pub force: Vec3,
}

impl Force for Push {
    fn name(&self) -> &str {
        "push"
    }
    fn declaration(&self) -> Declaration {
        Declaration::LOAD
    }
    fn energy(&self, at: &Configuration, _: &mut Scratch) -> Energy {
        Energy { stored: -self.force.dot(at.positions[self.row as usize]), dissipated: 0.0 }
    }
    fn add_force(&self, at: &Configuration, _: &mut Scratch, out: &mut [Vec3]) {
        out[self.row as usize] += self.force * at.load;
    }
    fn add_differential(
        &self,
        _: &Configuration,
        _: TangentWeights,
        _: &[Vec3],
        _: &mut Scratch,
        _: &mut [Vec3],
    ) {
    }
    fn visit_cliques(&self, _: &[Pair], _: &mut dyn FnMut(&[u32])) {}
    fn add_blocks(&self, _: &Configuration, _: TangentWeights, _: &mut Scratch, _: &mut BlockMatrix) {}
    fn as_any(&self) -> &dyn Any {
        self
    }
}
