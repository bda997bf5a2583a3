//! Validation cases and benchmarks over committed scenes.
//!
//! A [`Case`] names a scene, settings and what is read: the command that [`Case::commands`] prints gives the same
//! number without this crate. A case may run its scene several times, ever finer, and be about the order at which the
//! error falls ([`Refinement`]). Each case carries a mutation, a setting that makes it fail, so that it is known to see
//! something.

pub mod bench;
mod case;
mod cases;
mod derivation;
mod reading;
mod refinement;
mod row;
mod runs;
pub mod scenes;
pub mod suite;

pub use case::{Case, Tolerance, cases};
pub use cases::{TABLES, all};
pub use derivation::{Count, Trial};
pub use reading::{Observation, OperatorNumber, Reading, Statistic};
pub use refinement::{Limit, Refinement, Variant};
pub use row::{Problem, Row, RunOfRow};
