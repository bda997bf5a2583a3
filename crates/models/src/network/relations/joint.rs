//! Two masses at one place.

use souple_math::{Mat3, Vec3};

use super::Relation;

/// `g = x_a − x_b`. Its multiplier is the force on `a` [N].
#[derive(Clone, Debug)]
pub struct Joint {
    pub ends: [u32; 2],
}

impl Relation for Joint {
    fn rows(&self) -> &[u32] {
        &self.ends
    }

    fn value(&self, positions: &[Vec3], _time: f64) -> Vec3 {
        let [a, b] = self.ends.map(|end| positions[end as usize]);
        a - b
    }

    fn add_gradients(&self, _positions: &[Vec3], _time: f64, gradients: &mut Vec<Mat3>) {
        gradients.extend([Mat3::IDENTITY, -Mat3::IDENTITY]);
    }

    fn describe(&self) -> String {
        "a joint".to_owned()
    }
}
