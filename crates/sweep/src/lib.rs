//! Studies: a family of runs of one scene, in parallel, into one SQLite file that tables and graphs are made from.
//!
//! A study is a TOML file (see [`Study`]). [`sweep`] makes the runs that the file does not hold yet, so that one that was
//! interrupted goes on where it stood; [`table_of`] and [`graphs::write`] read the file alone. Where a study has a `fit`, values are looked
//! for instead for which a probe follows a measured curve ([`Search`]); where it has a `plan`, commands with which the scene comes to key
//! states ([`Planner`]), or from every state of a grid to a target ([`Tabulator`]).

mod database;
mod fit;
pub mod graphs;
mod least_squares;
mod motion;
mod place;
mod state_space;
mod study;
mod sweep;
mod table;

use std::path::PathBuf;

pub use database::Database;
pub use fit::{Fit, Found, Search, Unknown};
pub use least_squares::Ending;
pub use motion::{
    Attempt, Cost, FoundMotion, Gain, KeyState, Kind, Motion, Planner, Seen, Spacetime, Watch, When, Windows,
    with_unit,
};
pub use state_space::{FoundTable, Span, Tabulation, Tabulator};
pub use study::{Graph, Plan, Study};
pub use sweep::{Progress, Summary, Workers, fingerprints, sweep};
pub use table::{Table, table_of};

/// A study that cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum SweepError {
    #[error("{}: {source}", .path.display())]
    Read { path: PathBuf, source: std::io::Error },
    #[error("{}: {message}", .path.display())]
    Syntax { path: PathBuf, message: String },
    #[error("`{path}` is {value}; expected {expected}")]
    Value { path: String, value: String, expected: String },
    /// The same, with where it is written, from 1.
    #[error("{}:{line}:{column}: {error}", .path.display())]
    At { path: PathBuf, line: usize, column: usize, error: Box<SweepError> },
    #[error("{}: {found}; expected {expected}", .path.display())]
    Plan { path: PathBuf, found: String, expected: String },
    #[error("none of {count} starts comes to a motion that meets its keys: {messages}")]
    Starts { count: usize, messages: String },
    #[error("run {run} ({settings}): {message}")]
    Scene { run: usize, settings: String, message: String },
    #[error("with {settings}: {message}")]
    Failed { settings: String, message: String },
    #[error(
        "the plan asks for {wanted} N of `{name}`, whose actuator gives {largest} N at most; expected later keys, or a stronger actuator"
    )]
    Beyond { name: String, wanted: f64, largest: f64 },
    #[error(
        "no motion near at hand meets all keys{bounds}: {missed}; expected later keys, wider bands, stronger actuators, or other starts or windows"
    )]
    Unmet { missed: String, bounds: String },
    #[error("{}: {source}", .path.display())]
    Database { path: PathBuf, source: rusqlite::Error },
    #[error("{}: it holds results of `{found}`, not of `{wanted}`; expected a file of this study, or a new one", .path.display())]
    OtherStudy { path: PathBuf, found: String, wanted: String },
    #[error("the threads of the runs cannot be made: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    #[error(transparent)]
    Io(#[from] souple_io::IoError),
}

impl SweepError {
    fn value(path: impl Into<String>, value: impl Into<String>, expected: impl Into<String>) -> Self {
        let [value, expected] = [value.into(), expected.into()].map(|words| without_long_numbers(&words));
        Self::Value { path: path.into(), value, expected }
    }
}

/// Digits in a row beyond which a number is told by its first ones: 64-bit numbers have 17 that matter.
const DIGITS: usize = 20;

/// Words in which numbers of very many digits are cut short.
fn without_long_numbers(words: &str) -> String {
    let mut short = String::with_capacity(words.len().min(1024));
    let mut digits = 0;
    for character in words.chars() {
        let is_digit = character.is_ascii_digit();
        if !is_digit && digits > DIGITS {
            short.push('…');
        }
        digits = if is_digit { digits + 1 } else { 0 };
        if digits <= DIGITS {
            short.push(character);
        }
    }
    if digits > DIGITS {
        short.push('…');
    }
    short
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers that are read to the end stay; one of 300 digits is not echoed in full.
    #[test]
    fn long_numbers_are_cut_short() {
        assert_eq!(
            without_long_numbers("from -1.5e300 to 12345678901234567890"),
            "from -1.5e300 to 12345678901234567890"
        );
        let long = format!("{} and {}, 3", "1".repeat(300), "2".repeat(21));
        let short = format!("{}… and {}…, 3", "1".repeat(20), "2".repeat(20));
        assert_eq!(without_long_numbers(&long), short);
        assert_eq!(without_long_numbers(&"7".repeat(300)), format!("{}…", "7".repeat(20)));
    }
}
