//! Files of planned commands, as `souple sweep` writes them and scenes and studies read them: a row for each period.

use souple_io::NumberTable;
use souple_table::readable;

use crate::diagnostic::Code;

/// How far a date may be from the start of its period, as a share of when that ends: seven digits of a file do.
const OFF: f64 = 1e-6;
/// And no farther than this, in periods, so that a row that is missing is told however late it is.
const FARTHEST: f64 = 1e-3;

/// Numbers period by period: the first column is when periods begin [s], that of a control, `BODY.CONTROL`, its commands [N].
pub struct PlanFile {
    table: NumberTable,
}

/// What is wrong with such a file.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanFault {
    pub code: Code,
    pub found: String,
    pub expected: String,
}

impl PlanFault {
    fn new(code: Code, found: impl Into<String>, expected: impl Into<String>) -> Self {
        Self { code, found: found.into(), expected: expected.into() }
    }
}

impl PlanFile {
    /// # Errors
    /// A row that is no numbers, or not of the next period [s].
    pub fn read(text: &str, period: f64) -> Result<Self, PlanFault> {
        let table = NumberTable::read(text, &[])
            .map_err(|fault| PlanFault::new(Code::WrongType, fault.what(), fault.expected))?;
        for (count, (line, numbers)) in table.rows.iter().enumerate() {
            let off = (numbers[0] / period - count as f64).abs();
            if off > (OFF * (1.0 + count as f64)).min(FARTHEST) {
                let found = format!("line {line} is of {} s", readable(numbers[0]));
                let [date, period] = [count as f64 * period, period].map(readable);
                let expected = format!("{date} s: a row for each period of {period} s");
                return Err(PlanFault::new(Code::Conflict, found, expected));
            }
        }
        Ok(Self { table })
    }

    /// The name of each column, and where it is.
    pub fn names(&self) -> impl Iterator<Item = (usize, &str)> {
        (1..self.table.heads.len()).map(|column| (column, self.table.name(column)))
    }

    /// Where a number other than the time is.
    pub fn column_of(&self, name: &str) -> Option<usize> {
        self.table.column_of(name, 1)
    }

    /// Where the commands of a control are.
    ///
    /// # Errors
    /// There are none, or in another unit, or there is no row.
    pub fn column_of_commands(&self, control: &str) -> Result<usize, PlanFault> {
        let column = self.column_of(control).ok_or_else(|| {
            PlanFault::new(
                Code::UnknownName,
                format!("no column is of `{control}`"),
                "columns `time [s]` and `BODY.CONTROL [N]`, named in the first line",
            )
        })?;
        for (at, unit) in [(0, "s"), (column, "N")] {
            if self.table.unit(at).is_some_and(|other| other != unit) {
                let found = format!("a column is `{}`", self.table.heads[at]);
                return Err(PlanFault::new(Code::WrongType, found, "times in s and commands in N"));
            }
        }
        if self.table.rows.is_empty() {
            return Err(PlanFault::new(Code::EmptyRegion, "it has no rows", "a row for each period"));
        }
        Ok(column)
    }

    /// What stands in a column, period by period.
    pub fn column(&self, column: usize) -> impl Iterator<Item = f64> {
        self.table.rows.iter().map(move |(_, numbers)| numbers[column])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Columns are found by their names, in any order, and know their units.
    #[test]
    fn columns_are_found_by_their_names() {
        let text = "time [s],n.steer [N],n.place [m],n.drive [N],m.drive [N]\n0,1,9,2,3\n0.01,4,9,5,6\n";
        let file = PlanFile::read(text, 0.01).unwrap();
        let commands =
            |control: &str| -> Vec<f64> { file.column(file.column_of_commands(control).unwrap()).collect() };
        assert_eq!(commands("n.drive"), [2.0, 5.0]);
        assert_eq!(commands("n.steer"), [1.0, 4.0]);
        assert_eq!(commands("m.drive"), [3.0, 6.0]);
        let fault = file.column_of_commands("n.place").unwrap_err();
        assert_eq!((fault.code, fault.found.as_str()), (Code::WrongType, "a column is `n.place [m]`"));
        assert_eq!(file.column_of_commands("n.brake").unwrap_err().code, Code::UnknownName);
        let names: Vec<&str> = file.names().map(|(_, name)| name).collect();
        assert_eq!(names, ["n.steer", "n.place", "n.drive", "m.drive"]);
    }

    /// Dates may be rounded to seven digits and no fewer, and none may be left out, however late it is.
    #[test]
    fn a_row_is_of_each_period() {
        let with = |dates: &mut dyn Iterator<Item = String>| {
            let rows: String = dates.map(|date| format!("{date},1\n")).collect();
            PlanFile::read(&format!("time [s],n.drive [N]\n{rows}"), 1.0 / 3.0).map(|_| ())
        };
        let third = |row: usize| row as f64 / 3.0;
        with(&mut (0..300).map(|row| format!("{:.6e}", third(row)))).unwrap();
        let fault = with(&mut (0..300).map(|row| format!("{:.2e}", third(row)))).unwrap_err();
        assert!(fault.found.starts_with("line 3 is of 0.333 s"), "{}", fault.found);
        let missing = 1_100_000;
        let fault = with(&mut (0..1_100_010).filter(|row| *row != missing).map(|row| third(row).to_string()));
        let fault = fault.unwrap_err();
        assert!(fault.found.starts_with(&format!("line {} is of", missing + 2)), "{}", fault.found);
    }
}
