//! What carries a shape about and feels what the shape presses on: a hand with a tool.

use std::fmt::Debug;
use std::sync::Arc;

use souple_engine::{Editable, InHand, Motion, ParameterError};
use souple_math::Vec3;

use crate::loads::Pose;

/// What the things that a shape touches do to it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pressed {
    /// On the shape [N].
    pub force: Vec3,
    /// How much less it is for each metre that the shape gives way, at most [N/m].
    pub stiffness: f64,
}

/// Moves a shape, whose place is memory of the contact's force: State holds it.
pub trait Carrier: Send + Sync + Debug {
    /// Numbers of memory.
    fn memory_len(&self) -> usize;

    fn initial_memory(&self, memory: &mut [f64]);

    fn pose(&self, memory: &[f64]) -> Pose;

    /// Moves on by `timestep`, while what is touched stays as it is at the date `told` [s].
    fn advance(&self, pressed: &dyn Fn(&Pose) -> Pressed, told: f64, timestep: f64, memory: &mut [f64]);

    /// Moves on by `timestep` with the shape where the device is: that feels `felt` [N] itself, told at the date `told` [s].
    fn advance_held(&self, felt: Vec3, told: f64, timestep: f64, memory: &mut [f64]);

    /// Where the device is to be at the end of the period, from where it started [m].
    fn lead(&mut self, place: Vec3);

    /// Where a person means it to be, for pictures that know no more than the time.
    fn planned(&self) -> Option<Arc<dyn Motion>>;

    fn in_hand(&self, memory: &[f64]) -> InHand;

    fn editable(&self) -> Vec<Editable>;

    /// # Errors
    /// There is no such parameter, or the value does not fit.
    fn set_parameter(&mut self, force: &str, name: &str, value: f64) -> Result<(), ParameterError>;
}
