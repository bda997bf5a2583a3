//! Plans of commands: files of `souple sweep`, a row for each period.

use std::ops::Range;

use souple_math::Vec3;

use super::super::Draft;
use super::super::bodies::Placed;
use super::columns::text_of;
use super::table::NumberOfMass;
use crate::diagnostic::{Code, Site};
use crate::plan_file::{PlanFault, PlanFile};
use crate::spec::control::Feedback;

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
/// Columns `BODY.CONTROL / NUMBER` are gains, and `NUMBER` has a column with what it is planned to be. Gains are left aside where there is
/// no `feedback`.
pub fn read(
    draft: &Draft,
    body: &Placed,
    (site, file): (&Site, &str),
    control: &str,
    feedback: Feedback,
) -> Option<Plan> {
    let text = text_of(draft, (site, file), "a plan, as `souple sweep` writes it")?;
    let plan = PlanFile::read(&text, draft.spec.world.period)
        .and_then(|file| of_file(&file, (&body.spec.name, &body.rows), control, feedback));
    plan.map_err(|PlanFault { code, found, expected }| {
        draft.log.add(code, site, format!("`{file}`: {found}"), expected);
    })
    .ok()
}

fn of_file(
    file: &PlanFile,
    (body, rows): (&str, &Range<usize>),
    control: &str,
    feedback: Feedback,
) -> Result<Plan, PlanFault> {
    let column = file.column_of_commands(control)?;
    let mut gains = Vec::new();
    for (at, name) in file.names().filter(|_| feedback == Feedback::AsPlanned) {
        let Some(number) = name.strip_prefix(control).and_then(|rest| rest.strip_prefix(" / ")) else {
            continue;
        };
        let (Some(planned), Some(of)) = (file.column_of(number), number_of(body, rows, number)) else {
            let expected = format!(
                "positions and velocities of masses of the network, `{body}[0].x` to `{body}[{}].v.z`, with a column of what each is \
                 planned to be",
                rows.len().saturating_sub(1)
            );
            return Err(PlanFault {
                code: Code::UnknownName,
                found: format!("a gain is of `{number}`"),
                expected,
            });
        };
        let planned = file.column(planned).zip(file.column(at)).map(|(planned, gain)| [planned, gain]);
        gains.push(Gain { number: of, planned: planned.collect() });
    }
    Ok(Plan { commands: file.column(column).collect(), gains })
}
