//! Why a check failed.

use std::io;
use std::path::PathBuf;
use std::process::ExitStatus;

#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// What was found wrong, one line each.
    #[error("{}", .0.join("\n"))]
    Faults(Vec<String>),
    #[error("`{command}` ended with {status}")]
    Command { command: String, status: ExitStatus },
    #[error("`{command}` cannot be run ({error}); {remedy}")]
    Missing { command: String, error: io::Error, remedy: &'static str },
    #[error("{}: {error}", .path.display())]
    File { path: PathBuf, error: io::Error },
    #[error("`{command}` did not answer with the JSON it should: {what}")]
    Answer { command: String, what: String },
}

impl Failure {
    /// No failure if there is no fault.
    pub fn unless_empty(faults: Vec<String>) -> Result<(), Self> {
        if faults.is_empty() { Ok(()) } else { Err(Self::Faults(faults)) }
    }
}
