//! What drives parameters of forces: modules that make and break connections, and modules that turn a number.
//!
//! A control reads the committed rows once a period and writes one number among the driven parameters of State, before the
//! period is stepped; the force that is wired to it reads it there. What it does carries no dynamic consistency: it may give or
//! take energy at once, of which account is kept ([`crate::EnergyReport::made_by_control`]).

use crate::world::CommittedRows;

/// Numbers that a control keeps among the driven parameters of State: its value, and the energy it has made [J].
pub const CONTROL_LEN: usize = 2;

/// A module whose output is no force but a number that a force reads.
pub trait Control: Send + Sync {
    fn name(&self) -> &str;

    /// Index of the system whose forces it drives.
    fn system(&self) -> usize;

    /// Names of the forces.
    fn forces(&self) -> &[String];

    /// Where its [`CONTROL_LEN`] numbers start in State's driven parameters.
    fn driven(&self) -> usize;

    /// Its value for the period that begins at `time` [s], after `before`.
    fn value(&self, time: f64, period: f64, rows: CommittedRows, before: f64) -> f64;
}
