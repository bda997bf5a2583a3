//! Loads: forces from outside, springs to the ground and between bodies, drag, prescribed motions and moving frames.
//!
//! Loads that grow with the load steps of `static` are multiplied by [`souple_engine::Configuration::load`];
//! springs and drag are not loads in that sense and always act in full.

mod attachment;
#[cfg(test)]
pub(crate) mod battery;
mod combination;
mod drag;
mod field;
mod formula;
mod gravity;
mod ground_springs;
mod motion;
mod moving_frame;
mod point_load;
mod pressure;
mod rigid_motion;
#[cfg(test)]
mod tests;

use souple_engine::{Editable, ParameterError};

pub use attachment::{Attachments, Link, Slip};
pub use combination::Combination;
pub use drag::{Drag, MassDamping};
pub use field::{ForceField, UniformForce};
pub use formula::{FormulaVector, VARIABLES};
pub use gravity::{Gravity, TIME_VARIABLES};
pub use ground_springs::{GroundSpring, GroundSprings};
pub use motion::{Interpolation, KeyFrames};
pub use moving_frame::{FictitiousForce, MovingFrame};
pub use point_load::PointLoad;
pub use pressure::{PressedFace, Pressure};
pub use rigid_motion::{NestedMotion, Pose, RigidMotion};

/// A number a load cannot take.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LoadError {
    #[error("`{field}` is {value}, but must be {expected}")]
    Unfit { field: String, value: f64, expected: &'static str },
    #[error("`{field}` is empty; give at least one {expected}")]
    Empty { field: &'static str, expected: &'static str },
    #[error("`{field}` has {found} entries, but there are {expected} of {of}; give as many")]
    Count { field: &'static str, found: usize, expected: usize, of: &'static str },
}

const NOT_NEGATIVE: &str = "a finite number of at least 0";
const FINITE: &str = "a finite number";

/// Accepts finite numbers from zero.
pub(crate) fn not_negative(field: impl Into<String>, value: f64) -> Result<f64, LoadError> {
    if value.is_finite() && value >= 0.0 {
        return Ok(value);
    }
    Err(LoadError::Unfit { field: field.into(), value, expected: NOT_NEGATIVE })
}

/// Accepts finite numbers.
pub(crate) fn finite(field: impl Into<String>, value: f64) -> Result<f64, LoadError> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(LoadError::Unfit { field: field.into(), value, expected: FINITE })
    }
}

/// What a parameter edited while running may be.
#[derive(Clone, Copy)]
pub(crate) enum Fit {
    Finite,
    NotNegative,
}

/// Sets one of the named numbers of a force.
pub(crate) fn set_number(
    force: &str,
    numbers: &mut [(&'static str, &mut f64, Fit)],
    name: &str,
    value: f64,
) -> Result<(), ParameterError> {
    let (force, wanted) = (force.to_owned(), name.to_owned());
    let Some((_, number, fit)) = numbers.iter_mut().find(|(known, _, _)| *known == name) else {
        let known = numbers.iter().map(|(known, _, _)| (*known).to_owned()).collect();
        return Err(ParameterError::Unknown { force, name: wanted, known });
    };
    let (fits, expected) = match fit {
        Fit::Finite => (value.is_finite(), FINITE),
        Fit::NotNegative => (value.is_finite() && value >= 0.0, NOT_NEGATIVE),
    };
    if !fits {
        return Err(ParameterError::Unfit { force, name: wanted, value, expected: expected.to_owned() });
    }
    **number = value;
    Ok(())
}

/// An editable number.
pub(crate) fn editable(name: &'static str, unit: &'static str, value: f64) -> Editable {
    Editable { name, unit, value }
}
