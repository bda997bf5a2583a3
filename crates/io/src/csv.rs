//! Tables of numbers as CSV: probes over time.

use std::borrow::Cow;
use std::path::Path;

use crate::{IoError, write_file};

/// A column: its head and its values.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Column {
    /// Name and unit, as `time [s]`.
    pub name: String,
    pub values: Vec<f64>,
}

impl Column {
    pub fn new(name: impl Into<String>, values: Vec<f64>) -> Self {
        Self { name: name.into(), values }
    }
}

/// Writes columns of equal length under their names; each number is the shortest that reads back as the same bits.
///
/// # Errors
/// Columns of different lengths; the file cannot be written.
pub fn write_csv(path: &Path, columns: &[Column]) -> Result<(), IoError> {
    let rows = columns.first().map_or(0, |column| column.values.len());
    if let Some(column) = columns.iter().find(|column| column.values.len() != rows) {
        let subject = format!("the length of the column `{}`", column.name);
        return Err(IoError::request(
            subject,
            column.values.len(),
            format!("{rows}, as of the first column"),
        ));
    }
    write_file(path, |out| {
        let names: Vec<_> = columns.iter().map(|column| csv_cell(&column.name)).collect();
        writeln!(out, "{}", names.join(","))?;
        for row in 0..rows {
            for (index, column) in columns.iter().enumerate() {
                let comma = if index > 0 { "," } else { "" };
                write!(out, "{comma}{}", number(column.values[row]))?;
            }
            writeln!(out)?;
        }
        Ok(())
    })
}

/// NaN is an empty cell, as spreadsheets and data frames take it.
fn number(value: f64) -> String {
    if value.is_nan() { String::new() } else { format!("{value:?}") }
}

/// A text as it stands between commas: in quotes where commas, quotes or line ends ask for them (RFC 4180).
pub fn csv_cell(text: &str) -> Cow<'_, str> {
    if text.contains([',', '"', '\n', '\r']) {
        Cow::Owned(format!("\"{}\"", text.replace('"', "\"\"")))
    } else {
        Cow::Borrowed(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::TemporaryFolder;

    #[test]
    fn numbers_read_back_as_the_same_bits() {
        let folder = TemporaryFolder::new("csv");
        let path = folder.path("probes.csv");
        let (time, value) = (vec![0.0, 0.1, 1.0 / 3.0], vec![-1e-300, f64::NAN, 1e22]);
        let columns = [Column::new("time [s]", time.clone()), Column::new("a, \"b\"", value.clone())];
        write_csv(&path, &columns).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        let mut lines = text.lines();
        assert_eq!(lines.next(), Some("time [s],\"a, \"\"b\"\"\""));
        for (row, line) in lines.enumerate() {
            let (first, second) = line.split_once(',').unwrap();
            assert_eq!(first.parse::<f64>().unwrap(), time[row]);
            assert_eq!(second.parse::<f64>().ok(), Some(value[row]).filter(|value| !value.is_nan()));
        }
    }

    #[test]
    fn columns_of_different_lengths_are_refused() {
        let columns = [Column::new("a", vec![1.0]), Column::new("b", vec![])];
        let error = write_csv(Path::new("never.csv"), &columns).unwrap_err();
        assert!(error.to_string().contains("the length of the column `b` is 0; expected 1"), "{error}");
    }
}
