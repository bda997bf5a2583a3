//! A table of a study: a line for each run, a column for each value and each result.

use std::io::Write;
use std::path::Path;

use crate::SweepError;
use crate::database::{Database, Stored, number, plain};
use crate::study::Study;
use crate::sweep::fingerprints;

/// The runs of a study that its file holds.
pub struct Table {
    /// Paths that vary.
    pub paths: Vec<String>,
    pub rows: Vec<Row>,
}

/// One run.
pub struct Row {
    /// Of each path, as it was written.
    pub values: Vec<String>,
    /// The same as numbers, where they are.
    pub numbers: Vec<Option<f64>>,
    pub stored: Stored,
}

/// Letters of components.
const AXES: [&str; 3] = ["x", "y", "z"];

/// The runs of a study as the file has them.
///
/// # Errors
/// A scene or the file cannot be read.
pub fn table_of(study: &Study, database: &Database) -> Result<Table, SweepError> {
    let mut rows = Vec::new();
    for (plan, sha) in study.runs.iter().zip(fingerprints(study)?) {
        let Some(stored) = database.find(&sha, study.steps)? else { continue };
        rows.push(Row {
            values: plan.values.iter().map(|(_, value)| plain(value)).collect(),
            numbers: plan.values.iter().map(|(_, value)| number(value)).collect(),
            stored,
        });
    }
    Ok(Table { paths: study.paths().map(str::to_owned).collect(), rows })
}

impl Table {
    /// Names of the last values of all probes, component by component, with their units.
    pub fn results(&self) -> Vec<(String, String)> {
        let Some(row) = self.rows.first() else { return Vec::new() };
        let results = &row.stored.results;
        let name = |(probe, component): &(String, usize)| match results.contains_key(&(probe.clone(), 1)) {
            true => format!("{probe}.{}", AXES.get(*component).unwrap_or(&"?")),
            false => probe.clone(),
        };
        results.iter().map(|(key, held)| (name(key), held.unit.clone())).collect()
    }

    /// A number of a row with its unit: a path, `wall_seconds`, or a probe with its component and `first`, `min` or `max`
    /// behind points.
    pub fn find(&self, row: &Row, name: &str) -> Option<(f64, String)> {
        if let Some(path) = self.paths.iter().position(|path| path == name) {
            return Some((row.numbers[path]?, String::new()));
        }
        if name == "wall_seconds" {
            return Some((row.stored.wall_seconds, "s".to_owned()));
        }
        let mut parts = name.split('.');
        let probe = parts.next()?;
        let (mut component, mut value) = (0, None);
        for part in parts {
            match AXES.iter().position(|axis| *axis == part) {
                Some(axis) => component = axis,
                None => value = Some(part),
            }
        }
        let held = row.stored.results.get(&(probe.to_owned(), component))?;
        let number = match value {
            None | Some("last") => held.last,
            Some("first") => held.first,
            Some("min") => held.least,
            Some("max") => held.greatest,
            Some(_) => None,
        };
        Some((number?, held.unit.clone()))
    }

    /// Head and lines, as cells.
    pub fn cells(&self) -> Vec<Vec<String>> {
        let results = self.results();
        let unit = |(name, unit): &(String, String)| {
            if unit.is_empty() { name.clone() } else { format!("{name} [{unit}]") }
        };
        let own = ["status".to_owned(), "wall_seconds [s]".to_owned()];
        let head = self.paths.iter().cloned().chain(results.iter().map(unit)).chain(own).collect();
        let line = |row: &Row| -> Vec<String> {
            let numbers = results.iter().map(|(name, _)| {
                self.find(row, name).map_or_else(String::new, |(number, _)| format!("{number:.9e}"))
            });
            let own = [row.stored.status.clone(), format!("{:.3}", row.stored.wall_seconds)];
            row.values.iter().cloned().chain(numbers).chain(own).collect()
        };
        std::iter::once(head).chain(self.rows.iter().map(line)).collect()
    }

    /// Writes it with commas; cells with commas in quotes.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_csv(&self, path: &Path) -> Result<(), SweepError> {
        let quoted = |cell: &String| {
            if cell.contains([',', '"', '\n']) {
                format!("\"{}\"", cell.replace('"', "\"\""))
            } else {
                cell.clone()
            }
        };
        Ok(souple_io::write_file(path, |out: &mut dyn Write| {
            for line in self.cells() {
                writeln!(out, "{}", line.iter().map(quoted).collect::<Vec<_>>().join(","))?;
            }
            Ok(())
        })?)
    }
}
