//! Tables of numbers as CSV: probes over time.

use std::borrow::Cow;
use std::path::Path;

use crate::error::quoted;
use crate::{Fault, IoError, Place, write_file};

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

/// What stands between commas; in quotes commas may stand, and two quotes for one. `None` where a quote is not closed.
pub fn csv_cells(line: &str) -> Option<Vec<String>> {
    let (mut all, mut cell, mut is_quoted) = (Vec::new(), String::new(), false);
    let mut characters = line.trim().chars().peekable();
    while let Some(character) = characters.next() {
        match character {
            '"' if is_quoted && characters.peek() == Some(&'"') => {
                characters.next();
                cell.push('"');
            }
            '"' => is_quoted = !is_quoted,
            ',' if !is_quoted => all.push(std::mem::take(&mut cell).trim().to_owned()),
            other => cell.push(other),
        }
    }
    all.push(cell.trim().to_owned());
    (!is_quoted).then_some(all)
}

/// What [`write_csv`] writes: the heads of columns, and rows of numbers. Empty lines say nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NumberTable {
    /// Names with their units, of which there may be none.
    pub heads: Vec<String>,
    /// Lines, from 1, with as many numbers as there are heads.
    pub rows: Vec<(usize, Vec<f64>)>,
}

impl NumberTable {
    /// A text of columns, those of the names `endless` with numbers that may be infinite.
    ///
    /// # Errors
    /// A row without a number for each head, or with one that is not finite in another column.
    pub fn read(text: &str, endless: &[&str]) -> Result<Self, Fault> {
        let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
        let (first, head) = lines.next().unwrap_or_default();
        let fault = |number: usize, line: &str, expected: String| {
            Fault::new(Place::Line(number + 1), "the row", quoted(line.trim().as_bytes()), expected)
        };
        let heads = csv_cells(head).ok_or_else(|| fault(first, head, "quotes in pairs".to_owned()))?;
        let mut table = Self { heads, rows: Vec::new() };
        let is_endless: Vec<bool> =
            (0..table.heads.len()).map(|column| endless.contains(&table.name(column))).collect();
        for (number, line) in lines {
            let cells = line.split(',').zip(&is_endless);
            let numbers: Vec<f64> = cells
                .filter_map(|(cell, is_endless)| {
                    let number = cell.trim().parse().ok();
                    number.filter(|number: &f64| number.is_finite() || (*is_endless && !number.is_nan()))
                })
                .collect();
            if numbers.len() != table.heads.len() || line.split(',').count() != numbers.len() {
                let expected =
                    format!("{} finite numbers with commas, one for each column", table.heads.len());
                return Err(fault(number, line, expected));
            }
            table.rows.push((number + 1, numbers));
        }
        Ok(table)
    }

    /// What the head of a column says before its unit.
    pub fn name(&self, column: usize) -> &str {
        self.heads[column].split(" [").next().unwrap_or_default()
    }

    pub fn unit(&self, column: usize) -> Option<&str> {
        let (_, unit) = self.heads[column].split_once(" [")?;
        Some(unit.trim_end_matches(']'))
    }

    /// The first column of a name from a column on.
    pub fn column_of(&self, name: &str, from: usize) -> Option<usize> {
        (from..self.heads.len()).find(|column| self.name(*column) == name)
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

    #[test]
    fn tables_read_back() {
        let folder = TemporaryFolder::new("csv");
        let path = folder.path("table.csv");
        let columns = [
            Column::new("time [s]", vec![0.0, 1.0 / 3.0]),
            Column::new("a, \"b\" [N]", vec![-1e-300, 1e22]),
            Column::new("value", vec![f64::INFINITY, 2.0]),
        ];
        write_csv(&path, &columns).unwrap();
        let read = NumberTable::read(&std::fs::read_to_string(&path).unwrap(), &["value"]).unwrap();
        assert_eq!(read.heads, columns.each_ref().map(|column| column.name.clone()));
        for (row, (line, numbers)) in read.rows.iter().enumerate() {
            assert_eq!((*line, numbers.len()), (row + 2, 3));
            assert!(columns.iter().zip(numbers).all(|(column, number)| column.values[row] == *number));
        }
        assert_eq!(read.column_of("a, \"b\"", 1), Some(1));
        assert_eq!([read.unit(0), read.unit(1), read.unit(2)], [Some("s"), Some("N"), None]);
    }

    /// A cell that is no number does not make way for the next.
    #[test]
    fn rows_that_are_none_are_named_by_their_lines() {
        for (text, words) in [
            ("a,b\n1,2\n\n1,x,3\n", "line 4: the row is \"1,x,3\"; expected 2 finite numbers"),
            ("a,b\nx,1,2\n", "line 2"),
            ("a,b\n1\n", "line 2"),
            ("a,b\n1,inf\n", "line 2"),
            ("a,value\n1,NaN\n", "line 2"),
            ("a,\"b\n1,2\n", "line 1: the row is \"a,\\\"b\"; expected quotes in pairs"),
        ] {
            let fault = NumberTable::read(text, &["value"]).unwrap_err().to_string();
            assert!(fault.contains(words), "{fault}");
        }
    }
}
