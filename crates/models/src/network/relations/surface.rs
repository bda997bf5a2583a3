//! A mass on a surface where a formula vanishes, or on the curve where two do.

use std::sync::Arc;

use souple_formal::Formula;
use souple_math::{Mat3, Vec3};

use super::Relation;

/// `g_c = φ_c(x, y, z, t)` of one formula or two. The force on the mass is `Σ λ_c ∇φ_c`: multipliers are counted in the unit that
/// this makes a force.
#[derive(Clone, Debug)]
pub struct Surface {
    pub row: [u32; 1],
    /// Of a place [m] and the time [s].
    pub zeros: Arc<[Formula]>,
}

impl Surface {
    fn at(&self, positions: &[Vec3], time: f64) -> [f64; 4] {
        let place = positions[self.row[0] as usize];
        [place.x, place.y, place.z, time]
    }
}

impl Relation for Surface {
    fn rows(&self) -> &[u32] {
        &self.row
    }

    fn value(&self, positions: &[Vec3], time: f64) -> Vec3 {
        let at = self.at(positions, time);
        let of = |component: usize| self.zeros.get(component).map_or(0.0, |zero| zero.evaluate(&at));
        Vec3::from_array([0, 1, 2].map(of))
    }

    fn add_gradients(&self, positions: &[Vec3], time: f64, gradients: &mut Vec<Mat3>) {
        let at = self.at(positions, time);
        let by = |axis: usize| {
            let of = |component: usize| {
                self.zeros.get(component).map_or(0.0, |zero| zero.differentiate(&at, axis).derivative)
            };
            Vec3::from_array([0, 1, 2].map(of))
        };
        gradients.push(Mat3::from_columns(by(0), by(1), by(2)));
    }

    fn time_rate(&self, positions: &[Vec3], time: f64) -> Vec3 {
        let at = self.at(positions, time);
        let of = |component: usize| {
            self.zeros.get(component).map_or(0.0, |zero| zero.differentiate(&at, 3).derivative)
        };
        Vec3::from_array([0, 1, 2].map(of))
    }

    fn slope(&self, positions: &[Vec3], time: f64) -> Option<Vec3> {
        let [zero] = &*self.zeros else { return None };
        let at = self.at(positions, time);
        Some(Vec3::from_array([0, 1, 2].map(|axis| zero.differentiate(&at, axis).derivative)))
    }

    // what formulas sum is not seen from outside: what they are a metre away, the unit that they are written in, is of its order
    fn magnitude(&self, positions: &[Vec3], time: f64) -> Vec3 {
        let at = self.at(positions, time);
        let beside = |zero: &Formula| -> f64 {
            let of = |number: usize| {
                let mut near = at;
                near[number / 2] += if number.is_multiple_of(2) { 1.0 } else { -1.0 };
                zero.evaluate(&near).abs()
            };
            (0..6).map(of).filter(|it| it.is_finite()).fold(0.0, f64::max)
        };
        Vec3::from_array([0, 1, 2].map(|component| self.zeros.get(component).map_or(0.0, beside)))
    }

    fn describe(&self) -> String {
        let texts: Vec<&str> = self.zeros.iter().map(Formula::text).collect();
        format!("what is zero in `{}`", texts.join("` and `"))
    }
}
