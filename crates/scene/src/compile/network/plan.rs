//! Plans of commands: files of `souple sweep`, a row for each period.

use super::super::Draft;
use crate::diagnostic::{Code, Site};

/// How far a date may be from the start of its period, in periods: what decimals of a file do.
const OFF: f64 = 1e-6;

/// The commands of a control, period by period [N]; `None` where the file was refused.
///
/// The first column is the time at which periods begin [s]; that of the control has its name, `BODY.CONTROL`, before its unit.
pub fn read(draft: &Draft, site: &Site, file: &str, control: &str) -> Option<Vec<f64>> {
    let refuse = |code: Code, message: String, expected: &str| {
        draft.log.add(code, site, format!("`{file}`: {message}"), expected);
        None
    };
    let text = match draft.sources.read(site.place.source, file) {
        Ok(text) => text,
        Err(error) => {
            let is_missing = error.kind() == std::io::ErrorKind::NotFound;
            let code = if is_missing { Code::NotFound } else { Code::Unreadable };
            return refuse(code, error.to_string(), "a plan, as `souple sweep` writes it");
        }
    };
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let head = lines.next().map_or("", |(_, line)| line);
    let names =
        head.split(',').map(|cell| cell.trim().trim_end_matches(']').split(" [").next().unwrap_or(""));
    let Some(column) = names.skip(1).position(|name| name == control) else {
        let message = format!("no column is of `{control}`");
        return refuse(
            Code::UnknownName,
            message,
            "columns `time [s]` and `BODY.CONTROL [N]`, named in the first line",
        );
    };
    let (period, count) = (draft.spec.world.period, head.split(',').count());
    let mut commands = Vec::new();
    for (number, line) in lines {
        let cells: Vec<f64> = line.split(',').filter_map(|cell| cell.trim().parse().ok()).collect();
        if cells.len() != count || !cells.iter().all(|cell| cell.is_finite()) {
            let message = format!("line {} is `{}`", number + 1, line.trim());
            return refuse(
                Code::WrongType,
                message,
                "as many finite numbers with commas as the first line has names",
            );
        }
        if (cells[0] / period - commands.len() as f64).abs() > OFF {
            let message = format!("line {} is of {} s", number + 1, cells[0]);
            let expected =
                format!("{} s: a row for each period of {period} s", commands.len() as f64 * period);
            return refuse(Code::Conflict, message, &expected);
        }
        commands.push(cells[column + 1]);
    }
    if commands.is_empty() {
        return refuse(Code::EmptyRegion, "it has no rows".to_owned(), "a row for each period");
    }
    Some(commands)
}
