//! What a case gave.

use std::fmt;

use serde_json::{Value, json};

use crate::case::{Case, Tolerance};

/// What a case gave.
#[derive(Clone, Debug)]
pub struct Row {
    pub case: Case,
    pub measured: f64,
    pub unit: &'static str,
    pub pass: bool,
    pub seconds: f64,
    /// One, or one for each size.
    pub runs: Vec<RunOfRow>,
    /// Why there is no number.
    pub problem: Option<Problem>,
}

/// Why there is no number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    pub message: String,
    /// The scene was taken, and its run ended before it was due: blown up, or without a solution. That is an answer as well;
    /// a scene that is refused is none.
    pub has_run: bool,
}

impl From<String> for Problem {
    fn from(message: String) -> Self {
        Self { message, has_run: false }
    }
}

impl From<&str> for Problem {
    fn from(message: &str) -> Self {
        Self::from(message.to_owned())
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

/// One run of a case.
#[derive(Clone, Debug, PartialEq)]
pub struct RunOfRow {
    /// Where runs get finer: size of the cells or of the step.
    pub size: Option<f64>,
    pub value: f64,
    /// Distance from the limit.
    pub error: Option<f64>,
    /// The command line that gives the value.
    pub command: String,
}

impl Row {
    /// Whether the row, run under its mutation, saw it: the number is another, or the run did not come to its end.
    pub fn sees_mutation(&self) -> bool {
        !self.pass && self.problem.as_ref().is_none_or(|problem| problem.has_run)
    }

    pub fn to_json(&self) -> Value {
        let mut row = self.case.to_json();
        row["measured"] = json!(self.measured);
        row["unit"] = json!(self.unit);
        row["pass"] = json!(self.pass);
        row["seconds"] = json!(self.seconds);
        if self.case.refinement.is_some() {
            row["runs"] = self.runs.iter().map(RunOfRow::to_json).collect();
        }
        if let Some(problem) = &self.problem {
            row["problem"] = json!(problem.message);
            row["has_run"] = json!(problem.has_run);
        }
        row
    }
}

impl RunOfRow {
    fn to_json(&self) -> Value {
        json!({"size": self.size, "value": self.value, "error": self.error, "command": self.command})
    }
}

/// What was measured, without a verdict: a row that must fail is right when it does.
impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:34} ", self.case.id)?;
        if let Some(problem) = &self.problem {
            return write!(f, "{problem}");
        }
        let tolerance = self.case.tolerance;
        let is_near = matches!(tolerance, Tolerance::Absolute(_) | Tolerance::Relative(_));
        let relation = if is_near { "for" } else { tolerance.relation() };
        if self.case.refinement.is_some() {
            write!(f, "order {:.3} {relation} {} ", self.measured, self.case.reference)?;
        } else {
            write!(f, "{:.10e} {relation} {:.10e} {} ", self.measured, self.case.reference, self.unit)?;
        }
        if is_near {
            let off = (self.measured - self.case.reference).abs();
            let allowed = tolerance.absolute(self.case.reference);
            write!(f, "(off by {off:.1e}, {allowed:.1e} allowed) ")?;
        }
        write!(f, "in {:.2} s", self.seconds)?;
        if self.case.refinement.is_some() {
            for run in &self.runs {
                write!(f, "\n       {:.10e}", run.value)?;
                if let Some(error) = run.error {
                    write!(f, " (error {error:.3e})")?;
                }
                write!(f, "  {}", run.command)?;
            }
        }
        Ok(())
    }
}
