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
    /// Of each point that it meets, or of a triangle of mean area [N/m].
    pub stiffness: f64,
    /// Rows that it may meet.
    pub rows: Vec<u32>,
    /// From when until when each of them is on a surface [s]; empty where all stay.
    pub spans: Vec<[f64; 2]>,
    /// How a hand holds it that gives way, and what it meets between its rows; `None`: it meets these alone, and is where it is led to.
    pub held: Option<HeldTool>,
}

/// A tool on a spring, which meets triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct HeldTool {
    /// Of its rows at rest [m].
    pub places: Vec<Vec3>,
    /// Corners among its rows, in the order that turns left seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// From when until when each triangle is on a surface [s]; empty where all stay.
    pub spans: Vec<[f64; 2]>,
    /// Coulomb's coefficient.
    pub friction: f64,
    /// [kg]
    pub mass: f64,
    /// Of the spring from the hand to the tool [N/m].
    pub spring: f64,
    /// Of the damper beside it [N s/m].
    pub damper: f64,
    /// The most that these give [N].
    pub limit: f64,
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
            Some(_) => {
                check_spans(&self.spans, self.rows.len(), "rows")?;
                self.held.as_ref().map_or(Ok(()), |held| held.check(self.rows.len()))
            }
        }
    }
}

/// # Errors
/// There are some, and not as many as what they are of.
fn check_spans(spans: &[[f64; 2]], count: usize, of: &str) -> Result<(), String> {
    if spans.is_empty() || spans.len() == count {
        return Ok(());
    }
    Err(format!("it is told {} spans of {count} {of}", spans.len()))
}

impl HeldTool {
    /// # Errors
    /// Its triangles are not of its rows, or a number does not fit.
    fn check(&self, row_count: usize) -> Result<(), String> {
        if self.places.len() != row_count {
            return Err(format!("it is told {} places of {row_count} rows", self.places.len()));
        }
        if let Some(corner) = self.triangles.iter().flatten().find(|corner| **corner as usize >= row_count) {
            return Err(format!("a triangle has the corner {corner}; there are {row_count} rows"));
        }
        check_spans(&self.spans, self.triangles.len(), "triangles")?;
        for place in &self.places {
            check_place("places", *place).map_err(|error| error.to_string())?;
        }
        for (field, value) in [("mass", self.mass), ("spring", self.spring), ("limit", self.limit)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(format!("`{field}` is {value}, but must be a finite number above 0"));
            }
        }
        for (field, value) in [("friction", self.friction), ("damper", self.damper)] {
            if !(value.is_finite() && value >= 0.0) {
                return Err(format!("`{field}` is {value}, but must be a finite number of at least 0"));
            }
        }
        Ok(())
    }
}
