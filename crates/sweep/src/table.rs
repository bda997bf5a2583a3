//! A table of a study: a line for each run, a column for each value and each result.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;

use souple_io::csv_cell;

use crate::SweepError;
use crate::database::{Database, Stored, number, plain};
use crate::study::Study;

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

impl Row {
    fn is_vector(&self, probe: &str) -> bool {
        self.stored.results.contains_key(&(probe.to_owned(), 1))
    }
}

/// Letters of components.
pub(crate) const AXES: [&str; 3] = ["x", "y", "z"];
/// What of a run a number is, behind probe and component; the last where none is named.
pub(crate) const VALUES: [&str; 4] = ["last", "first", "min", "max"];

/// The runs of a study as the file has them, by the fingerprints of their scenes.
///
/// # Errors
/// The file cannot be read.
pub fn table_of(study: &Study, fingerprints: &[String], database: &Database) -> Result<Table, SweepError> {
    let mut rows = Vec::new();
    for (plan, fingerprint) in study.runs.iter().zip(fingerprints) {
        let Some(stored) = database.find(fingerprint, study.steps)? else { continue };
        rows.push(Row {
            values: plan.values.iter().map(|(_, value)| plain(value)).collect(),
            numbers: plan.values.iter().map(|(_, value)| number(value)).collect(),
            stored,
        });
    }
    Ok(Table { paths: study.paths().map(str::to_owned).collect(), rows })
}

impl Table {
    /// Names of the last values of all probes that any run has, component by component, with their units.
    pub fn results(&self) -> Vec<(String, String)> {
        let mut units = BTreeMap::new();
        for row in &self.rows {
            for ((probe, component), held) in &row.stored.results {
                let axis = row.is_vector(probe).then(|| AXES.get(*component)).flatten();
                units.entry((probe, axis)).or_insert(&held.unit);
            }
        }
        let name = |probe: &str, axis: Option<&&str>| {
            axis.map_or_else(|| probe.to_owned(), |axis| format!("{probe}.{axis}"))
        };
        units.into_iter().map(|((probe, axis), unit)| (name(probe, axis), unit.clone())).collect()
    }

    /// The unit in which all values of a path are written; `None` where it is not one.
    fn unit(&self, path: usize) -> Option<&str> {
        let mut units = self.rows.iter().map(|row| split_unit(&row.values[path]).map(|(_, unit)| unit));
        let first = units.next()??;
        units.all(|unit| unit == Some(first)).then_some(first)
    }

    /// A number of a row with its unit: a path, in the unit in which it is written in all rows or else in SI's, `wall_seconds`, or a probe with its component, which a vector needs, and `first`,
    /// `min` or `max` behind points.
    pub fn find(&self, row: &Row, name: &str) -> Option<(f64, String)> {
        if let Some(path) = self.paths.iter().position(|path| path == name) {
            return match self.unit(path) {
                Some(unit) => Some((split_unit(&row.values[path])?.0, unit.to_owned())),
                None => Some((row.numbers[path]?, String::new())),
            };
        }
        if name == "wall_seconds" {
            return Some((row.stored.wall_seconds, "s".to_owned()));
        }
        let mut parts = name.split('.');
        let probe = parts.next()?;
        let (mut component, mut value) = (None, None);
        for part in parts {
            match AXES.iter().position(|axis| *axis == part) {
                Some(axis) => component = Some(axis),
                None => value = Some(part),
            }
        }
        if component.is_some() != row.is_vector(probe) {
            return None;
        }
        let held = row.stored.results.get(&(probe.to_owned(), component.unwrap_or(0)))?;
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
        Ok(souple_io::write_file(path, |out: &mut dyn Write| {
            for line in self.cells() {
                writeln!(out, "{}", line.iter().map(|cell| csv_cell(cell)).collect::<Vec<_>>().join(","))?;
            }
            Ok(())
        })?)
    }
}

/// A number and the unit behind it.
fn split_unit(text: &str) -> Option<(f64, &str)> {
    let (number, unit) = text.trim().split_once(' ')?;
    Some((number.parse().ok()?, unit.trim()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::database::Held;

    /// A path is told in the unit in which all runs have it, and in SI's where they differ.
    #[test]
    fn paths_keep_their_unit() {
        let of = |values: &[&str]| {
            let row = |text: &&str| {
                let numbers = vec![number(&toml::Value::String((*text).to_owned()))];
                Row { values: vec![(*text).to_owned()], numbers, ..row(&[]) }
            };
            let table = Table { paths: vec!["size".to_owned()], rows: values.iter().map(row).collect() };
            table.find(&table.rows[0], "size")
        };
        assert_eq!(of(&["30 mm", "5 mm"]), Some((30.0, "mm".to_owned())));
        assert_eq!(of(&["30 mm", "1 cm"]), Some((0.03, String::new())));
    }

    /// A run with the last values of probes.
    fn row(last: &[(&str, usize, f64)]) -> Row {
        let held = |value: f64| Held {
            unit: "m".to_owned(),
            first: None,
            last: Some(value),
            least: None,
            greatest: None,
        };
        let results =
            last.iter().map(|(name, component, value)| (((*name).to_owned(), *component), held(*value)));
        let stored = Stored {
            status: "done".to_owned(),
            binary: String::new(),
            wall_seconds: 1.0,
            results: results.collect(),
        };
        Row { values: vec!["[0, 1, 0]".to_owned()], numbers: vec![None], stored }
    }

    /// A run that failed at its start, or has other probes, hides nothing of the others; what is no number has no number.
    #[test]
    fn results_of_all_runs_have_columns() {
        let rows = vec![row(&[]), row(&[("place", 0, 1.0), ("place", 1, 2.0)]), row(&[("speed", 0, 3.0)])];
        let table = Table { paths: vec!["gravity".to_owned()], rows };
        let names: Vec<String> = table.results().into_iter().map(|(name, _)| name).collect();
        assert_eq!(names, ["place.x", "place.y", "speed"]);
        let cells = table.cells();
        assert_eq!(cells[0][..4], ["gravity", "place.x [m]", "place.y [m]", "speed [m]"]);
        assert_eq!(cells[1][1..4], ["", "", ""]);
        assert_eq!(cells[2][1..4], ["1.000000000e0", "2.000000000e0", ""]);
        assert_eq!(cells[3][1..4], ["", "", "3.000000000e0"]);
        let found = |name: &str| table.find(&table.rows[1], name).map(|(number, _)| number);
        assert_eq!(
            (found("place.y"), found("place.y.last"), found("wall_seconds")),
            (Some(2.0), Some(2.0), Some(1.0))
        );
        // a vector is no number, nor is a list of numbers
        assert_eq!((found("place"), found("place.z"), found("gravity")), (None, None, None));
        assert_eq!(number(&toml::Value::Array(vec![toml::Value::Integer(1)])), None);
    }
}
