//! Plans of commands: files of `souple sweep`, a row for each period.

use std::ops::Range;

use souple_math::Vec3;

use super::super::Draft;
use super::super::bodies::Placed;
use super::columns::{column_names, text_of};
use super::table::NumberOfMass;
use crate::diagnostic::{Code, Site};
use crate::spec::control::Feedback;

/// How far a date may be from the start of its period, in periods: what decimals of a file do.
const OFF: f64 = 1e-6;

/// Commands of a control, period by period, and what it makes of deviations from the planned motion: `u_n − K_n (S − S_n)`.
pub struct Plan {
    /// [N]
    commands: Vec<f64>,
    /// A gain for each number of the state that there is one for.
    gains: Vec<Gain>,
}

/// What a control makes of one number of the state.
struct Gain {
    number: NumberOfMass,
    /// `S_n` and `K_n`, period by period.
    planned: Vec<[f64; 2]>,
}

impl Plan {
    /// The command of a period; that of the last goes on.
    pub fn command(&self, period: usize, positions: &[Vec3], velocities: &[Vec3]) -> f64 {
        let period = period.min(self.commands.len() - 1);
        let answer: f64 = self.gains.iter().map(|gain| gain.answer(period, positions, velocities)).sum();
        self.commands[period] - answer
    }
}

impl Gain {
    fn answer(&self, period: usize, positions: &[Vec3], velocities: &[Vec3]) -> f64 {
        let [planned, gain] = self.planned[period];
        let NumberOfMass { row, component, is_velocity } = self.number;
        let now = if is_velocity { velocities[row] } else { positions[row] };
        gain * (now[component] - planned)
    }
}

/// How numbers of the state of masses are called in the first line of a plan: `BODY[3].x`, `BODY[3].v.x`.
const NUMBERS: [(&str, bool, usize); 6] =
    [("x", false, 0), ("y", false, 1), ("z", false, 2), ("v.x", true, 0), ("v.y", true, 1), ("v.z", true, 2)];

/// A number of the masses of a body.
pub fn number_of(body: &str, rows: &Range<usize>, name: &str) -> Option<NumberOfMass> {
    let (mass, number) = name.strip_prefix(body)?.strip_prefix('[')?.split_once("].")?;
    let row = rows.start + mass.parse::<usize>().ok()?;
    let (_, is_velocity, component) = NUMBERS.into_iter().find(|(known, ..)| *known == number)?;
    rows.contains(&row).then_some(NumberOfMass { row, component, is_velocity })
}

/// The plan of a control; `None` where the file was refused.
///
/// The first column is the time at which periods begin [s]; that of the control has its name, `BODY.CONTROL`, before its unit. Columns
/// `BODY.CONTROL / NUMBER` are gains, and `NUMBER` has a column with what it is planned to be. Gains are left aside where there is no
/// `feedback`.
pub fn read(
    draft: &Draft,
    body: &Placed,
    (site, file): (&Site, &str),
    control: &str,
    feedback: Feedback,
) -> Option<Plan> {
    let (body, rows) = (body.spec.name.as_str(), &body.rows);
    let refuse = |code: Code, message: String, expected: &str| {
        draft.log.add(code, site, format!("`{file}`: {message}"), expected);
        None
    };
    let text = text_of(draft, (site, file), "a plan, as `souple sweep` writes it")?;
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let head = lines.next().map_or("", |(_, line)| line);
    let names = column_names(head);
    let column_of = |name: &str| names.iter().skip(1).position(|known| *known == name).map(|at| at + 1);
    let Some(column) = column_of(control) else {
        let message = format!("no column is of `{control}`");
        return refuse(
            Code::UnknownName,
            message,
            "columns `time [s]` and `BODY.CONTROL [N]`, named in the first line",
        );
    };
    for (at, unit) in [(0, "s"), (column, "N")] {
        let cell = head.split(',').nth(at).unwrap_or_default().trim();
        let has_other = cell.split_once(" [").is_some_and(|(_, rest)| rest.trim_end_matches(']') != unit);
        if has_other {
            return refuse(Code::WrongType, format!("a column is `{cell}`"), "times in s and commands in N");
        }
    }
    // columns of what is planned and of the gain, and what there is of each
    let mut gains: Vec<([usize; 2], Gain)> = Vec::new();
    for (at, name) in names.iter().enumerate().filter(|_| feedback == Feedback::AsPlanned) {
        let Some(number) = name.strip_prefix(control).and_then(|rest| rest.strip_prefix(" / ")) else {
            continue;
        };
        let (Some(planned), Some(of)) = (column_of(number), number_of(body, rows, number)) else {
            let expected = format!(
                "positions and velocities of masses of the network, `{body}[0].x` to `{body}[{}].v.z`, with a column of what each is \
                 planned to be",
                rows.len().saturating_sub(1)
            );
            return refuse(Code::UnknownName, format!("a gain is of `{number}`"), &expected);
        };
        gains.push(([planned, at], Gain { number: of, planned: Vec::new() }));
    }
    let (period, count) = (draft.spec.world.period, names.len());
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
        commands.push(cells[column]);
        gains.iter_mut().for_each(|(columns, gain)| gain.planned.push(columns.map(|column| cells[column])));
    }
    if commands.is_empty() {
        return refuse(Code::EmptyRegion, "it has no rows".to_owned(), "a row for each period");
    }
    Some(Plan { commands, gains: gains.into_iter().map(|(_, gain)| gain).collect() })
}
