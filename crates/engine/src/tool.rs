//! A tool in a hand: something rigid that presses on the points it meets (see [`crate::Edit::Touch`]).
//!
//! The table of shapes stands above the engine; a world that can be touched has a [`Toolbox`] that reads it.

use souple_math::Vec3;

use crate::force::Force;
use crate::hand::check_place;

/// A tool, by the name of its shape: what a recording says of it is enough to make it again.
#[derive(Clone, Debug, PartialEq)]
pub struct Tool {
    pub shape: String,
    /// Values of the shape by their names: one number, or three of a vector, in SI units.
    pub values: Vec<(String, Vec<f64>)>,
    /// Where the shape's own origin is [m].
    pub place: Vec3,
    /// Of each point that it meets [N/m].
    pub stiffness: f64,
    /// Rows that it may meet.
    pub rows: Vec<u32>,
}

/// Makes the forces of tools.
pub trait Toolbox: Send + Sync {
    /// The force called `name` of a tool whose rows are there; [`Force::lead`] moves it.
    ///
    /// # Errors
    /// Says what does not fit and what would.
    fn make(&self, name: String, tool: &Tool) -> Result<Box<dyn Force>, String>;
}

impl Tool {
    /// # Errors
    /// It meets nothing, or what is not there, or is at no finite place.
    pub(crate) fn check(&self, row_count: usize) -> Result<(), String> {
        check_place("place", self.place).map_err(|error| error.to_string())?;
        match self.rows.iter().max() {
            None => Err("it may meet no point; it must be told at least one".to_owned()),
            Some(row) if *row as usize >= row_count => {
                Err(format!("there is no row {row}; the system has {row_count}"))
            }
            Some(_) => Ok(()),
        }
    }
}
