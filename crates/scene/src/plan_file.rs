//! Files of planned commands, as `souple sweep` writes them and scenes and studies read them: a row for each period.

use souple_io::NumberTable;
use souple_table::readable;

use crate::diagnostic::Code;

/// How far a date may be from the start of its period, in periods: what decimals of a file do.
const OFF: f64 = 1e-6;

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
            if (numbers[0] / period - count as f64).abs() > OFF * (1.0 + count as f64) {
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
