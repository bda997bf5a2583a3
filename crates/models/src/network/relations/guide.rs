//! A mass on a nail, a straight line or a plane, which may move.

use std::sync::Arc;

use souple_engine::Motion;
use souple_math::{Mat3, Vec3};

use super::{Relation, across};

/// `g_c = n_c·(x − p(t))` with up to three directions `n_c` at right angles: one of a plane, two of a line, three of a nail. Its
/// multipliers are the force on the mass along them [N].
#[derive(Clone, Debug)]
pub struct Guide {
    pub row: [u32; 1],
    /// A place on it at the start [m].
    pub place: Vec3,
    /// Of length 1, or zero for those that it has not.
    pub normals: [Vec3; 3],
    /// How it moves; it stays where `None`.
    pub motion: Option<Arc<dyn Motion>>,
}

impl Guide {
    pub fn nail(row: u32, place: Vec3) -> Self {
        Self { row: [row], place, normals: Vec3::AXES, motion: None }
    }

    /// `None` for a direction of no length.
    pub fn line(row: u32, place: Vec3, direction: Vec3) -> Option<Self> {
        let [one, other] = across(direction)?;
        Some(Self { normals: [one, other, Vec3::ZERO], ..Self::nail(row, place) })
    }

    /// `None` for a normal of no length.
    pub fn plane(row: u32, place: Vec3, normal: Vec3) -> Option<Self> {
        let normals = [normal.try_normalised()?, Vec3::ZERO, Vec3::ZERO];
        Some(Self { normals, ..Self::nail(row, place) })
    }
}

impl Relation for Guide {
    fn rows(&self) -> &[u32] {
        &self.row
    }

    fn value(&self, positions: &[Vec3], time: f64) -> Vec3 {
        let offset = self.motion.as_ref().map_or(Vec3::ZERO, |motion| motion.offset(self.place, time));
        let from = positions[self.row[0] as usize] - self.place - offset;
        Vec3::from_array(self.normals.map(|normal| normal.dot(from)))
    }

    fn add_gradients(&self, _positions: &[Vec3], _time: f64, gradients: &mut Vec<Mat3>) {
        let [a, b, c] = self.normals;
        gradients.push(Mat3::from_columns(a, b, c).transpose());
    }

    fn time_rate(&self, _positions: &[Vec3], time: f64) -> Vec3 {
        let velocity = self.motion.as_ref().map_or(Vec3::ZERO, |motion| motion.velocity(self.place, time));
        Vec3::from_array(self.normals.map(|normal| -normal.dot(velocity)))
    }

    fn slope(&self, _positions: &[Vec3], _time: f64) -> Option<Vec3> {
        let [normal, other, _] = self.normals;
        (other == Vec3::ZERO).then_some(normal)
    }

    fn surface_velocity(&self, time: f64) -> Vec3 {
        self.motion.as_ref().map_or(Vec3::ZERO, |motion| motion.velocity(self.place, time))
    }

    fn magnitude(&self, _positions: &[Vec3], time: f64) -> Vec3 {
        let offset = self.motion.as_ref().map_or(Vec3::ZERO, |motion| motion.offset(self.place, time));
        Vec3::from_array([self.place.length() + offset.length(); 3])
    }

    fn describe(&self) -> String {
        match self.normals {
            [_, Vec3::ZERO, _] => "a plane",
            [_, _, Vec3::ZERO] => "a line",
            _ => "a nail",
        }
        .to_owned()
    }
}
