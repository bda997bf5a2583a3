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

use souple_table::readable;

pub use database::Database;
pub use fit::{Fit, Found, Search, Unknown};
pub use least_squares::Ending;
pub use motion::{
    Attempt, Cost, FoundMotion, Gain, KeyState, Kind, Motion, Planner, Seen, Spacetime, Watch, When, Windows,
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

/// Digits beyond which a number is told by those that matter, with an exponent: 64-bit numbers have 17.
const DIGITS: usize = 20;

/// Words in which numbers that are written out in very many digits have exponents. Names with as many are left.
fn without_long_numbers(words: &str) -> String {
    let is_of_number = |character: char| character.is_ascii_digit() || character == '.';
    let is_of_name = |character: char| character.is_alphanumeric() || character == '_';
    let (mut short, mut rest, mut before) = (String::with_capacity(words.len().min(1024)), words, ' ');
    while let Some(first) = rest.chars().next() {
        let end = match is_of_number(first) {
            true => rest.find(|character| !is_of_number(character)).unwrap_or(rest.len()),
            false => first.len_utf8(),
        };
        let (part, after) = rest.split_at(end);
        let is_long = part.chars().filter(char::is_ascii_digit).count() > DIGITS;
        let is_apart = !is_of_name(before) && !after.starts_with(is_of_name);
        match part.parse::<f64>().ok().filter(|_| is_long && is_apart) {
            Some(number) if number.is_finite() => short += &readable(number),
            Some(_) => short.extend(part.chars().take(DIGITS).chain(['…'])),
            None => short += part,
        }
        (before, rest) = (part.chars().last().unwrap_or(before), after);
    }
    short
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers that are read to the end stay, as do names; of one of 300 digits the size is told.
    #[test]
    fn long_numbers_are_cut_short() {
        for as_it_is in [
            "from -1.5e300 to 12345678901234567890",
            "no run `2026112823015900000000_a`",
            "Δ = 0.12345678901234567, 3",
        ] {
            assert_eq!(without_long_numbers(as_it_is), as_it_is);
        }
        let long = format!("{:.0} and -{}, 3 m", 1e200, "0.".to_owned() + &"0".repeat(24) + "1");
        assert_eq!(without_long_numbers(&long), "1e200 and -1e-25, 3 m");
        assert_eq!(without_long_numbers(&"7".repeat(400)), format!("{}…", "7".repeat(20)));
    }
}
