//! Commands to begin with, from a file as plans are written.

use std::path::Path;

use souple_scene::PlannedControl;

use super::course::OFF;
use crate::SweepError;

/// Commands of so many periods, those of all controls period by period. The last row goes on, as in a scene.
///
/// # Errors
/// The file cannot be read, has no column of a control, or a row that is not of the next period.
pub(super) fn read(
    path: &Path,
    controls: &[PlannedControl],
    periods: usize,
    period: f64,
) -> Result<Vec<f64>, SweepError> {
    let text =
        std::fs::read_to_string(path).map_err(|source| SweepError::Read { path: path.to_owned(), source })?;
    commands(&path.display().to_string(), &text, controls, periods, period)
}

fn commands(
    place: &str,
    text: &str,
    controls: &[PlannedControl],
    periods: usize,
    period: f64,
) -> Result<Vec<f64>, SweepError> {
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let head = lines.next().map_or("", |(_, line)| line);
    let names: Vec<&str> = head.split(',').map(str::trim).collect();
    let column_of = |control: &PlannedControl| {
        let wanted = format!("{} [N]", control.name);
        names.iter().position(|name| *name == wanted).ok_or_else(|| {
            SweepError::value(
                place,
                format!("without a column `{wanted}`"),
                "a plan of the controls of the scene",
            )
        })
    };
    let columns = controls.iter().map(column_of).collect::<Result<Vec<usize>, _>>()?;
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for (number, line) in lines {
        let cells: Vec<f64> = line.split(',').filter_map(|cell| cell.trim().parse().ok()).collect();
        let is_good = cells.len() == names.len()
            && cells.iter().all(|cell| cell.is_finite())
            && (cells[0] / period - rows.len() as f64).abs() <= OFF * (1.0 + rows.len() as f64);
        if !is_good {
            let found = format!("`{}` in line {}", line.trim(), number + 1);
            let expected = format!(
                "{} finite numbers with commas, the first {} s",
                names.len(),
                rows.len() as f64 * period
            );
            return Err(SweepError::value(place, found, expected));
        }
        rows.push(columns.iter().map(|column| cells[*column]).collect());
    }
    let last = rows.len().checked_sub(1);
    let last = last.ok_or_else(|| SweepError::value(place, "without rows", "a row for each period"))?;
    Ok((0..periods).flat_map(|at| rows[at.min(last)].clone()).collect())
}
