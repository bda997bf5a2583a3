//! A mass whose acceleration is told.

use std::sync::Arc;

use souple_math::{Mat3, Vec3};

use super::Relation;
use crate::loads::FormulaVector;

/// `ẍ = a(t)` along some axes: `g` is the place along them, whose second rate is told. Its multipliers are the force that it takes, beside
/// all others [N] (Isaacs & Cohen 1987).
#[derive(Clone, Debug)]
pub struct Acceleration {
    pub row: [u32; 1],
    /// Ones along the axes that are told.
    pub axes: Vec3,
    /// Where the mass started [m].
    pub start: Vec3,
    /// Of that place and the time [m/s²].
    pub value: Arc<FormulaVector>,
}

impl Acceleration {
    fn along(&self, vector: Vec3) -> Vec3 {
        Mat3::from_diagonal(self.axes) * vector
    }
}

impl Relation for Acceleration {
    fn rows(&self) -> &[u32] {
        &self.row
    }

    fn value(&self, positions: &[Vec3], _time: f64) -> Vec3 {
        self.along(positions[self.row[0] as usize])
    }

    fn add_gradients(&self, _positions: &[Vec3], _time: f64, gradients: &mut Vec<Mat3>) {
        gradients.push(Mat3::from_diagonal(self.axes));
    }

    fn second_rate(&self, time: f64) -> Option<Vec3> {
        Some(self.along(self.value.value(self.start, time)))
    }

    fn describe(&self) -> String {
        "an acceleration".to_owned()
    }
}
