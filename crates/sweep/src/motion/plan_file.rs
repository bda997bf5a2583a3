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

#[cfg(test)]
mod tests {
    use souple_scene::Planned;

    use super::*;

    fn controls() -> Vec<PlannedControl> {
        let control = |name: &str| PlannedControl {
            name: name.to_owned(),
            driven: 0,
            largest: 1.0,
            body: "cart".to_owned(),
            system: 0,
            rows: 0..1,
            by: Planned::Time,
        };
        vec![control("cart.a"), control("cart.b")]
    }

    /// Columns are found by their names, and the last row goes on.
    #[test]
    fn plans_are_read_period_by_period() {
        let text = "time [s],cart.b [N],x [m],cart.a [N]\n0,1,9,2\n\n0.5,3,9,4\n";
        let found = commands("plan.csv", text, &controls(), 3, 0.5).unwrap();
        assert_eq!(found, [2.0, 1.0, 4.0, 3.0, 4.0, 3.0]);
    }

    /// A row that is not of its period, short, or no number is named.
    #[test]
    fn faults_of_plans_are_named() {
        for (text, words) in [
            ("", "`plan.csv` is without a column `cart.a [N]`"),
            ("time [s],cart.a [N],cart.b [N]\n", "`plan.csv` is without rows"),
            (
                "time [s],cart.a [N],cart.b [N]\n0,1,2\n0.4,1,2",
                "is `0.4,1,2` in line 3; expected 3 finite numbers",
            ),
            ("time [s],cart.a [N],cart.b [N]\n0,1", "is `0,1` in line 2"),
            ("time [s],cart.a [N],cart.b [N]\n0,1,inf", "is `0,1,inf` in line 2"),
        ] {
            let error = commands("plan.csv", text, &controls(), 2, 0.5).unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        }
    }
}
