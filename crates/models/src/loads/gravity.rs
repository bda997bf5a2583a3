//! Gravity: the weight of everything that has mass.

use std::any::Any;

use souple_engine::{
    Configuration, Declaration, Editable, Energy, Force, Kinematics, Mass, ParameterError, Scratch,
    TangentWeights,
};
use souple_formal::Formula;
use souple_math::Vec3;
use souple_solve::BlockMatrix;

use super::{Fit, LoadError, MovingFrame, editable, finite, set_number};

/// What pulls.
#[derive(Clone, Debug)]
enum Acceleration {
    /// Always the same; may be edited [m/s²].
    Constant(Vec3),
    /// Three formulas of [`TIME_VARIABLES`] [m/s²].
    Varying(Box<[Formula; 3]>),
}

/// What a gravity that varies may refer to: the time [s].
pub const TIME_VARIABLES: [&str; 1] = ["t"];

impl Acceleration {
    fn at(&self, time: f64) -> Vec3 {
        match self {
            Self::Constant(g) => *g,
            Self::Varying(formulas) => {
                Vec3::from_array([0, 1, 2].map(|axis: usize| formulas[axis].evaluate(&[time])))
            }
        }
    }
}

/// `f_a = m_a g(t)` with `m_a = Σ_b M_ab`, the sum over rows that move with a translation.
#[derive(Clone, Debug)]
pub struct Gravity {
    name: String,
    acceleration: Acceleration,
    /// From where it is seen; the world at rest where there is none.
    frame: Option<MovingFrame>,
    /// Per row [kg].
    row_masses: Vec<f64>,
}

impl Gravity {
    /// The weight of a system's mass, lumped or consistent; axes of frames have none of their own but what the
    /// mass couples them to.
    ///
    /// # Errors
    /// The acceleration is not finite.
    pub fn new(
        name: impl Into<String>,
        acceleration: Vec3,
        mass: &Mass,
        kinematics: &Kinematics,
    ) -> Result<Self, LoadError> {
        for axis in 0..3 {
            finite(format!("gravity[{axis}]"), acceleration[axis])?;
        }
        Ok(Self::of(name.into(), Acceleration::Constant(acceleration), mass, kinematics))
    }

    /// The same with three formulas of [`TIME_VARIABLES`]: a shaken or turned world, seen from inside it.
    pub fn varying(
        name: impl Into<String>,
        acceleration: [Formula; 3],
        mass: &Mass,
        kinematics: &Kinematics,
    ) -> Self {
        Self::of(name.into(), Acceleration::Varying(Box::new(acceleration)), mass, kinematics)
    }

    fn of(name: String, acceleration: Acceleration, mass: &Mass, kinematics: &Kinematics) -> Self {
        // a fall moves row b by its translation weight: f = M (w g)
        let share = |row| kinematics.translation_weight(row);
        let mut row_masses: Vec<f64> =
            mass.diagonal.iter().enumerate().map(|(row, mass)| mass * share(row)).collect();
        for &(a, b, coupling) in &mass.couplings {
            row_masses[a as usize] += coupling * share(b as usize);
            row_masses[b as usize] += coupling * share(a as usize);
        }
        Self { name, acceleration, frame: None, row_masses }
    }

    /// The same gravity of a world at rest, seen from a frame that moves in it.
    pub fn seen_from(self, frame: MovingFrame) -> Self {
        Self { frame: Some(frame), ..self }
    }

    /// At a time, as it is seen [m/s²].
    pub fn at(&self, time: f64) -> Vec3 {
        let acceleration = self.acceleration.at(time);
        self.frame.as_ref().map_or(acceleration, |frame| frame.direction_to_frame(time, acceleration))
    }

    /// Total weight at a time [N].
    pub fn total(&self, time: f64) -> Vec3 {
        self.at(time) * self.row_masses.iter().sum::<f64>()
    }
}

impl Force for Gravity {
    fn name(&self) -> &str {
        &self.name
    }

    fn declaration(&self) -> Declaration {
        Declaration::LOAD
    }

    // E = -Σ m g · x
    fn energy(&self, at: &Configuration, _scratch: &mut Scratch) -> Energy {
        let weight = self.at(at.time) * at.load;
        let stored = self.row_masses.iter().zip(at.positions).map(|(mass, x)| -mass * weight.dot(*x)).sum();
        Energy { stored, dissipated: 0.0 }
    }

    fn add_force(&self, at: &Configuration, _scratch: &mut Scratch, out: &mut [Vec3]) {
        let weight = self.at(at.time) * at.load;
        for (out, mass) in out.iter_mut().zip(&self.row_masses) {
            *out += weight * *mass;
        }
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

    // those with a mass, which are unknowns or at work in it
    fn reads_cliques_alone(&self) -> bool {
        true
    }

    fn visit_cliques(&self, _pairs: &[souple_engine::Pair], _visit: &mut dyn FnMut(&[u32])) {}

    fn add_blocks(&self, _: &Configuration, _: TangentWeights, _: &mut Scratch, _: &mut BlockMatrix) {}

    fn editable(&self) -> Vec<Editable> {
        let Acceleration::Constant(g) = self.acceleration else { return Vec::new() };
        let names = ["gravity_x", "gravity_y", "gravity_z"];
        (0..3).map(|axis| editable(names[axis], "m/s²", g[axis])).collect()
    }

    fn set_parameter(&mut self, name: &str, value: f64) -> Result<(), ParameterError> {
        let Acceleration::Constant(Vec3 { x, y, z }) = &mut self.acceleration else {
            return set_number(&self.name, &mut [], name, value);
        };
        let numbers = &mut [
            ("gravity_x", x, Fit::Finite),
            ("gravity_y", y, Fit::Finite),
            ("gravity_z", z, Fit::Finite),
        ];
        set_number(&self.name, numbers, name, value)
    }

    fn bytes(&self) -> usize {
        self.row_masses.len() * size_of::<f64>()
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
