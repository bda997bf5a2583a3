//! Loads and motions written as formulas of time `t` and place `x`, `y`, `z`.

use souple_engine::Motion;
use souple_formal::{Formula, ParseError};
use souple_math::{Mat3, Vec3};

use super::ForceField;

/// What formulas may refer to: a place [m] and the time [s].
pub const VARIABLES: [&str; 4] = ["x", "y", "z", "t"];
const TIME: usize = 3;

/// A vector of place and time, such as `[0, -10 * sin(t), 0]`.
#[derive(Clone, Debug)]
pub struct FormulaVector {
    components: [Formula; 3],
}

impl FormulaVector {
    /// Reads a list of three formulas of `x`, `y`, `z`, `t`.
    ///
    /// # Errors
    /// The text is not such a list; the error points at the place.
    pub fn compile(text: &str) -> Result<Self, ParseError> {
        Ok(Self { components: Formula::compile_vector(text, &VARIABLES)? })
    }

    /// Three formulas of [`VARIABLES`], in this order.
    pub fn from_components(components: [Formula; 3]) -> Self {
        Self { components }
    }

    /// Not finite where a formula is not defined.
    pub fn value(&self, position: Vec3, time: f64) -> Vec3 {
        let values = arguments(position, time);
        Vec3::from_array([0, 1, 2].map(|axis: usize| self.components[axis].evaluate(&values)))
    }

    /// The derivative by one of the variables.
    fn derivative(&self, position: Vec3, time: f64, by: usize) -> Vec3 {
        let values = arguments(position, time);
        Vec3::from_array(
            [0, 1, 2].map(|axis: usize| self.components[axis].differentiate(&values, by).derivative),
        )
    }
}

fn arguments(position: Vec3, time: f64) -> [f64; 4] {
    [position.x, position.y, position.z, time]
}

impl ForceField for FormulaVector {
    fn force(&self, position: Vec3, time: f64) -> Vec3 {
        self.value(position, time)
    }

    fn gradient(&self, position: Vec3, time: f64) -> Mat3 {
        let by = |axis| self.derivative(position, time, axis);
        Mat3::from_columns(by(0), by(1), by(2))
    }

    fn depends_on_position(&self) -> bool {
        self.components.iter().any(|formula| (0..TIME).any(|axis| formula.depends_on(axis)))
    }
}

/// As a motion, `x`, `y`, `z` are where the point started.
impl Motion for FormulaVector {
    fn offset(&self, start: Vec3, time: f64) -> Vec3 {
        self.value(start, time)
    }

    fn velocity(&self, start: Vec3, time: f64) -> Vec3 {
        self.derivative(start, time, TIME)
    }
}
