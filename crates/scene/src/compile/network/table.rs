//! Tables of commands over a state space: files of `souple sweep`, a row for each state.

use souple_io::NumberTable;
use souple_math::Vec3;

use super::super::Draft;
use super::super::bodies::Placed;
use super::columns::text_of;
use super::controls::Input;
use crate::diagnostic::{Code, Site};
use crate::spec::control::{ControlSpec, Drives, INPUTS, Lookup, STATES, StateSpec};
use crate::spec::network::Network;

/// Numbers of a state space, as a control reads them of masses.
#[derive(Clone, Debug)]
pub struct StateSpace {
    /// `BODY.CONTROL`
    pub control: String,
    inputs: Vec<Input>,
    /// Without formulas they are the inputs, in their order.
    states: Vec<StateSpec>,
}

/// A number of the state of a network: the place or the velocity of a mass along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NumberOfMass {
    /// Row of the system.
    pub row: usize,
    /// Of x, y, z.
    pub component: usize,
    pub is_velocity: bool,
}

impl StateSpace {
    /// That of a control that has a table; `None` of others, or where an input is not of the network.
    pub(crate) fn of(draft: &Draft, body: &Placed, network: &Network, control: &ControlSpec) -> Option<Self> {
        let Some(Drives::Table { states, .. }) = &control.drives else { return None };
        let inputs = control.inputs.iter().map(|input| Input::new(draft, body, network, input));
        Some(Self {
            control: format!("{}.{}", body.spec.name, control.name),
            inputs: inputs.collect::<Option<_>>()?,
            states: states.clone(),
        })
    }

    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.states.iter().map(|state| state.name.as_str())
    }

    /// The state of masses, a number for each name.
    pub fn read(&self, positions: &[Vec3], velocities: &[Vec3], state: &mut [f64]) {
        let mut values = [0.0; INPUTS];
        for (value, input) in values.iter_mut().zip(&self.inputs) {
            *value = input.read(positions, velocities);
        }
        for (index, (number, spec)) in state.iter_mut().zip(&self.states).enumerate() {
            *number = spec.value.as_ref().map_or(values[index], |formula| formula.evaluate(&values));
        }
    }

    /// Of each number of the state: the number of the one mass that it is, where it is one.
    pub fn numbers_of_masses(&self) -> Vec<Option<NumberOfMass>> {
        let of = |(index, state): (usize, &StateSpec)| match state.value {
            None => self.inputs[index].number_of_mass(),
            Some(_) => None,
        };
        self.states.iter().enumerate().map(of).collect()
    }
}

/// Commands of a control by its state.
pub struct Table {
    /// Of each number of the state, the places of entries, growing.
    axes: Vec<Vec<f64>>,
    /// Of each entry, the last number of the state running fastest [N]; `None`: nothing leads from there to where the table leads.
    commands: Vec<Option<f64>>,
    lookup: Lookup,
}

impl Table {
    /// The command at a state, and at the nearest one of the table from beyond it. Corners of a cell that lead nowhere are left out; where all
    /// of them are, it is none.
    pub fn command(&self, state: &[f64]) -> f64 {
        let mut cells = [(0, 0.0); STATES];
        for ((cell, axis), number) in cells.iter_mut().zip(&self.axes).zip(state) {
            *cell = cell_of(axis, *number);
            if self.lookup == Lookup::Nearest {
                cell.1 = cell.1.round();
            }
        }
        let (mut sum, mut whole) = (0.0, 0.0);
        for corner in 0..1_usize << self.axes.len() {
            let (mut entry, mut weight) = (0, 1.0);
            for (at, (axis, (low, share))) in self.axes.iter().zip(cells).enumerate() {
                let is_upper = corner >> at & 1 == 1;
                weight *= if is_upper { share } else { 1.0 - share };
                // an axis of one place has no upper one, and no share of it
                entry = entry * axis.len() + (low + usize::from(is_upper)).min(axis.len() - 1);
            }
            if let (Some(command), true) = (self.commands[entry], weight > 0.0) {
                sum += weight * command;
                whole += weight;
            }
        }
        if whole > 0.0 { sum / whole } else { 0.0 }
    }
}

/// The place below a number, and which share of the way to the next it is at; at an end from beyond it.
fn cell_of(axis: &[f64], number: f64) -> (usize, f64) {
    let low =
        axis.partition_point(|place| *place <= number).saturating_sub(1).min(axis.len().saturating_sub(2));
    match axis.get(low + 1) {
        Some(high) => (low, ((number - axis[low]) / (high - axis[low])).clamp(0.0, 1.0)),
        None => (low, 0.0),
    }
}

/// The table of a control; `None` where the file was refused.
///
/// The first columns are the numbers of the state, by their names, in their order; a column has the name of the control, `BODY.CONTROL`, and
/// `value` has how much the way from there costs, infinite where there is none.
pub fn read(
    draft: &Draft,
    (site, file): (&Site, &str),
    control: &str,
    (names, lookup): (&[&str], Lookup),
) -> Option<Table> {
    let refuse = |code: Code, message: String, expected: &str| {
        draft.log.add(code, site, format!("`{file}`: {message}"), expected);
        None
    };
    let text = text_of(draft, (site, file), "a table, as `souple sweep` writes it")?;
    let read = match NumberTable::read(&text, &["value"]) {
        Ok(read) => read,
        Err(fault) => return refuse(Code::WrongType, fault.what(), &fault.expected),
    };
    let columns: Vec<&str> = (0..read.heads.len()).map(|column| read.name(column)).collect();
    let Some(column) = read.column_of(control, names.len()).filter(|_| columns.starts_with(names)) else {
        let expected = format!("columns {}, `{control} [N]` and `value [s]`", names.join(", "));
        return refuse(Code::UnknownName, format!("its columns are `{}`", columns.join(", ")), &expected);
    };
    let value = read.column_of("value", names.len());
    let rows = &read.rows;
    let axes: Vec<Vec<f64>> = (0..names.len()).map(|at| places(rows, at)).collect();
    let of_entry = |mut entry: usize| {
        let mut state = vec![0.0; axes.len()];
        for (number, axis) in state.iter_mut().zip(&axes).rev() {
            *number = axis[entry % axis.len()];
            entry /= axis.len();
        }
        state
    };
    let entries = axes.iter().map(Vec::len).fold(1, usize::saturating_mul);
    let is_off = |(entry, (_, cells)): &(usize, &(usize, Vec<f64>))| {
        *entry >= entries || of_entry(*entry)[..] != cells[..axes.len()]
    };
    let expected = "a row for each combination of the places along each number of the state, the last one running fastest";
    if let Some((_, (line, _))) = rows.iter().enumerate().find(is_off) {
        return refuse(Code::Conflict, format!("line {line} is out of its place"), expected);
    }
    if rows.is_empty() || rows.len() != entries {
        return refuse(Code::Conflict, format!("{} rows for {entries} states", rows.len()), expected);
    }
    let leads = |cells: &Vec<f64>| value.is_none_or(|value| cells[value].is_finite());
    let commands = rows.iter().map(|(_, cells)| leads(cells).then_some(cells[column])).collect();
    Some(Table { axes, commands, lookup })
}

/// Different numbers of a column, growing.
fn places(rows: &[(usize, Vec<f64>)], column: usize) -> Vec<f64> {
    let mut places: Vec<f64> = rows.iter().map(|(_, cells)| cells[column]).collect();
    places.sort_by(f64::total_cmp);
    places.dedup();
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Between entries of `3 x + 5 y + 2 x y` the table is that very function; beyond its ends it is what it is there.
    #[test]
    fn tables_are_linear_along_each_axis() {
        let of = |x: f64, y: f64| 3.0 * x + 5.0 * y + 2.0 * x * y;
        let axes = vec![vec![-1.0, 0.5, 2.0], vec![0.0, 4.0]];
        let commands = axes[0].iter().flat_map(|x| axes[1].iter().map(|y| Some(of(*x, *y)))).collect();
        let mut table = Table { axes, commands, lookup: Lookup::Linear };
        for (x, y) in [(-1.0, 0.0), (0.25, 1.0), (0.5, 4.0), (1.9, 3.5), (2.0, 4.0)] {
            // a few roundings of numbers up to 40
            assert!((table.command(&[x, y]) - of(x, y)).abs() < 1e-13, "{x}, {y}");
        }
        assert!((table.command(&[7.0, -3.0]) - of(2.0, 0.0)).abs() < 1e-13);
        table.lookup = Lookup::Nearest;
        assert_eq!(table.command(&[0.9, 1.9]), of(0.5, 0.0));
    }

    /// Corners that lead nowhere have no say; where there is no other, there is no command.
    #[test]
    fn what_leads_nowhere_is_left_out() {
        let table = Table {
            axes: vec![vec![0.0, 1.0, 2.0]],
            commands: vec![Some(4.0), None, None],
            lookup: Lookup::Linear,
        };
        assert_eq!([0.0, 0.75, 1.0, 1.5].map(|x| table.command(&[x])), [4.0, 4.0, 0.0, 0.0]);
    }
}
