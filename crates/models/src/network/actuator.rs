//! Actuators: forces along a fixed direction whose magnitude a control commands.

use std::any::Any;

use souple_engine::{Configuration, Declaration, Energy, Force, Pair, Scratch, TangentWeights};
use souple_math::Vec3;
use souple_solve::BlockMatrix;

/// `f_i = (u/n) d` on each of `n` rows, with the command `u` [N] among the driven parameters of State.
///
/// Within a period the command is constant, and the force is that of the potential `E = −u d · x̄` of the mean `x̄` of its rows; what a
/// change of the command makes of it is booked by the control ([`souple_engine::EnergyReport::made_by_control`]). What was made, less
/// what is stored, is the work that the actuator has done: `Σ u d · Δx̄`.
#[derive(Clone, Debug)]
pub struct Actuator {
    name: String,
    rows: std::ops::Range<u32>,
    direction: Vec3,
    command: usize,
}

impl Actuator {
    /// On `rows`, along `direction` of any length but zero; `command` is where the command stands among State's driven parameters.
    pub fn new(name: impl Into<String>, rows: std::ops::Range<u32>, direction: Vec3, command: usize) -> Self {
        let direction = direction.try_normalised().unwrap_or(Vec3::ZERO);
        Self { name: name.into(), rows, direction, command }
    }

    /// On each row [N].
    fn share(&self, at: &Configuration) -> Vec3 {
        self.direction * (at.driven[self.command] / self.rows.len().max(1) as f64)
    }
}

impl Force for Actuator {
    fn name(&self) -> &str {
        &self.name
    }

    fn declaration(&self) -> Declaration {
        Declaration::LOAD
    }

    // E = −u d · x̄
    fn energy(&self, at: &Configuration, _: &mut Scratch) -> Energy {
        let rows = &at.positions[self.rows.start as usize..self.rows.end as usize];
        let stored = -self.share(at).dot(rows.iter().copied().sum::<Vec3>());
        Energy { stored, dissipated: 0.0 }
    }

    fn add_force(&self, at: &Configuration, _: &mut Scratch, out: &mut [Vec3]) {
        let share = self.share(at);
        out[self.rows.start as usize..self.rows.end as usize].iter_mut().for_each(|force| *force += share);
    }

    // the same wherever its rows are
    fn add_differential(
        &self,
        _: &Configuration,
        _: TangentWeights,
        _: &[Vec3],
        _: &mut Scratch,
        _: &mut [Vec3],
    ) {
    }

    fn visit_cliques(&self, _: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        self.rows.clone().for_each(|row| visit(&[row]));
    }

    fn add_blocks(&self, _: &Configuration, _: TangentWeights, _: &mut Scratch, _: &mut BlockMatrix) {}

    fn as_any(&self) -> &dyn Any {
        self
    }
}
