//! Forces and motions given as formulas of time and place, and motions put together axis by axis.

use std::sync::Arc;

use souple_engine::Motion;
use souple_formal::Formula;
use souple_math::{Mat3, Vec3};
use souple_models::loads::ForceField;

/// Position of `t` and of `x`, `y`, `z` among [`crate::spec::boundary::LOAD_VARIABLES`].
const TIME: usize = 0;
const PLACE: [usize; 3] = [1, 2, 3];

fn values(place: Vec3, time: f64) -> [f64; 4] {
    [time, place.x, place.y, place.z]
}

fn evaluate(formulas: &[Formula; 3], place: Vec3, time: f64) -> Vec3 {
    let values = values(place, time);
    let [x, y, z] = [0, 1, 2].map(|axis: usize| formulas[axis].evaluate(&values));
    Vec3::new(x, y, z)
}

fn derivative(formulas: &[Formula; 3], place: Vec3, time: f64, by: usize) -> Vec3 {
    let values = values(place, time);
    let [x, y, z] = [0, 1, 2].map(|axis: usize| formulas[axis].differentiate(&values, by).derivative);
    Vec3::new(x, y, z)
}

/// A force as a formula of time and of where the point is [N].
#[derive(Clone, Debug)]
pub struct FormulaForce(pub [Formula; 3]);

impl ForceField for FormulaForce {
    fn force(&self, position: Vec3, time: f64) -> Vec3 {
        evaluate(&self.0, position, time)
    }

    // ∂F/∂x, column by column
    fn gradient(&self, position: Vec3, time: f64) -> Mat3 {
        let [x, y, z] = PLACE.map(|by| derivative(&self.0, position, time, by));
        Mat3::from_columns(x, y, z)
    }

    fn depends_on_position(&self) -> bool {
        self.0.iter().any(|formula| PLACE.iter().any(|place| formula.depends_on(*place)))
    }
}

/// An offset as a formula of time and of where the point started [m].
#[derive(Clone, Debug)]
pub struct FormulaMotion(pub [Formula; 3]);

impl Motion for FormulaMotion {
    fn offset(&self, start: Vec3, time: f64) -> Vec3 {
        evaluate(&self.0, start, time)
    }

    fn velocity(&self, start: Vec3, time: f64) -> Vec3 {
        derivative(&self.0, start, time, TIME)
    }
}

/// A motion of its own for each axis, where several pins lead one point.
#[derive(Clone, Debug, Default)]
pub struct AxisMotions(pub [Option<Arc<dyn Motion>>; 3]);

impl AxisMotions {
    fn by_axis(&self, of: impl Fn(&dyn Motion) -> Vec3) -> Vec3 {
        let [x, y, z] = [0, 1, 2].map(|axis: usize| self.0[axis].as_deref().map_or(0.0, |motion| of(motion)[axis]));
        Vec3::new(x, y, z)
    }
}

impl Motion for AxisMotions {
    fn offset(&self, start: Vec3, time: f64) -> Vec3 {
        self.by_axis(|motion| motion.offset(start, time))
    }

    fn velocity(&self, start: Vec3, time: f64) -> Vec3 {
        self.by_axis(|motion| motion.velocity(start, time))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::boundary::LOAD_VARIABLES;

    fn formulas(text: &str) -> [Formula; 3] {
        Formula::compile_vector::<3>(text, LOAD_VARIABLES).expect("formulas")
    }

    /// Velocity and gradient are the derivatives of offset and force: central differences of step `h` are off by
    /// `h²` times third derivatives of order one, and by rounding `ε/h`.
    #[test]
    fn derivatives_agree_with_differences() {
        let h = 1e-5;
        let tolerance = 10.0 * h * h + 1e-15 / h;
        let text = "[sin(2*t) + x*y, t^2 * z, exp(-t) * x^2]";
        let (place, time) = (Vec3::new(0.3, -0.7, 0.9), 0.4);
        let motion = FormulaMotion(formulas(text));
        let difference = (motion.offset(place, time + h) - motion.offset(place, time - h)) / (2.0 * h);
        assert!((difference - motion.velocity(place, time)).largest_component() < tolerance);
        let force = FormulaForce(formulas(text));
        assert!(force.depends_on_position());
        for (axis, direction) in [Vec3::X, Vec3::Y, Vec3::Z].into_iter().enumerate() {
            let step = direction * h;
            let difference = (force.force(place + step, time) - force.force(place - step, time)) / (2.0 * h);
            let column = force.gradient(place, time).columns[axis];
            assert!((difference - column).largest_component() < tolerance);
        }
        assert!(!FormulaForce(formulas("[t, 0, 1]")).depends_on_position());
    }
}
