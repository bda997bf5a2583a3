//! Tables of commands over a state space, for the way to a target that costs least, by dynamic programming.
//!
//! `F(S) = t + ∫ C dt` is the least from every entry of a grid of states to a target, under commands of a few levels (van de Panne, Fiume and
//! Vranesic, 1990). The model is the scene itself: a shot sets its masses to the state of an entry, holds one level, and is stepped until a
//! number of the state has gone the distance between two entries, the target is met, or it has been held for long enough. Values follow from
//! the shots by [`iteration`].

mod iteration;
mod shooter;

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use souple_engine::Interruption;
use souple_formal::{Condition, Formula, ParseError};
use souple_io::Column;
use toml::{Table, Value};

use self::iteration::{Grid, MOST_NUMBERS, Place, Shot, Shots};
use self::shooter::Shooter;
use crate::SweepError;
use crate::fit::{as_quantity, refuse_unknown};
use crate::study::Study;

/// A table of commands that is sought.
#[derive(Clone, Debug)]
pub struct Tabulation {
    pub states: Vec<Span>,
    /// Of each control, `BODY.CONTROL`, its levels [N].
    pub levels: Vec<(String, Vec<f64>)>,
    /// Condition on the state.
    pub target: String,
    /// What a second costs besides itself: a formula of the state and of commands, by the last part of the names of their controls.
    pub cost: Option<String>,
    /// What of masses is set, `BODY[MASS].x` or `BODY[MASS].v.x`, by formulas of the state [m, m/s].
    pub sets: Vec<(String, String)>,
    /// How long a level is held at most [s]; a hundred periods where `None`.
    pub hold: Option<f64>,
    /// Where an iteration changes no worth by more than this, they stand; that of the target is 1.
    pub tolerance: f64,
    pub iterations: usize,
}

/// A number of the state, and the places along it.
#[derive(Clone, Debug, PartialEq)]
pub struct Span {
    pub name: String,
    pub from: f64,
    pub to: f64,
    pub points: usize,
}

/// What was found.
#[derive(Clone, Debug)]
pub struct FoundTable {
    names: Vec<String>,
    /// Of each entry.
    places: Vec<Place>,
    /// Controls, by `BODY.CONTROL`, with their command of each entry [N].
    pub commands: Vec<(String, Vec<f64>)>,
    /// What the way from each entry costs [s]; infinite where there is none.
    pub values: Vec<f64>,
    /// The same from where the scene starts, between entries; `None` where that is beyond them.
    pub from_start: Option<f64>,
    pub shots: usize,
    /// Shots that ended where nothing can be stepped.
    pub failed: usize,
    pub iterations: usize,
    pub is_converged: bool,
}

/// What a table is sought with.
#[derive(Clone, Copy)]
pub struct Tabulator<'a> {
    pub study: &'a Study,
    pub tabulation: &'a Tabulation,
    /// Threads.
    pub count: usize,
    pub stop: &'a Interruption,
}

const KEYS: &[&str] =
    &["kind", "states", "levels", "target", "cost", "sets", "hold", "tolerance", "iterations"];
const SPAN_KEYS: &[&str] = &["from", "to", "points"];
/// Shots in all, at most: a few hundred megabytes.
const MOST_SHOTS: usize = 5_000_000;

impl Tabulation {
    /// # Errors
    /// A key is missing or unknown, or has a value that cannot be.
    pub(crate) fn read(table: &Table) -> Result<Self, SweepError> {
        refuse_unknown("plan.", table, KEYS)?;
        let found = |key: &str| table.get(key).map_or("missing".to_owned(), Value::to_string);
        let fault =
            |key: &str, expected: &str| SweepError::value(format!("plan.{key}"), found(key), expected);
        let number = |key: &str, is_good: &dyn Fn(f64) -> bool, unit: &str, expected: &str| {
            let Some(value) = table.get(key) else { return Ok(None) };
            let number = as_quantity(value, unit).filter(|number| is_good(*number));
            number.map(Some).ok_or_else(|| fault(key, expected))
        };
        let states = match table.get("states") {
            Some(Value::Table(states)) => states.iter().map(Span::read).collect::<Result<_, _>>()?,
            _ => {
                return Err(fault(
                    "states",
                    "tables of `from`, `to` and `points`, by the names of the state",
                ));
            }
        };
        let levels = match table.get("levels") {
            Some(Value::Table(levels)) => levels.iter().map(levels_of).collect::<Result<_, _>>()?,
            _ => return Err(fault("levels", "lists of commands, by the names of controls")),
        };
        let sets = match table.get("sets") {
            None => Vec::new(),
            Some(Value::Table(sets)) => sets.iter().map(text_of_set).collect::<Result<_, _>>()?,
            Some(_) => return Err(fault("sets", "formulas of the state, by numbers of masses")),
        };
        let cost = match table.get("cost") {
            None => None,
            Some(Value::String(cost)) => Some(cost.clone()),
            Some(_) => return Err(fault("cost", "a formula of the state and of commands")),
        };
        let Some(Value::String(target)) = table.get("target") else {
            return Err(fault("target", "a condition on the state"));
        };
        let iterations = match table.get("iterations") {
            None => 10_000,
            Some(Value::Integer(count @ 1..)) => *count as usize,
            Some(_) => return Err(fault("iterations", "a whole number above 0")),
        };
        let share =
            number("tolerance", &|share| share > 0.0 && share < 1.0, "", "a number above 0, below 1")?;
        Ok(Self {
            states,
            levels,
            target: target.clone(),
            cost,
            sets,
            hold: number("hold", &|hold| hold > 0.0 && hold.is_finite(), "s", "seconds above 0")?,
            tolerance: share.unwrap_or(1e-6),
            iterations,
        })
    }

    /// Combinations of levels, the last control running fastest.
    fn combinations(&self) -> usize {
        self.levels.iter().map(|(_, levels)| levels.len()).fold(1, usize::saturating_mul)
    }

    /// The commands of a combination, of each control.
    fn commands(&self, mut combination: usize) -> Vec<f64> {
        let mut commands = vec![0.0; self.levels.len()];
        for (command, (_, levels)) in commands.iter_mut().zip(&self.levels).rev() {
            *command = levels[combination % levels.len()];
            combination /= levels.len();
        }
        commands
    }

    fn grid(&self) -> Result<Grid, SweepError> {
        if self.states.is_empty() || self.states.len() > MOST_NUMBERS {
            let found = format!("a state of {} numbers", self.states.len());
            return Err(SweepError::value("plan.states", found, format!("1 to {MOST_NUMBERS}")));
        }
        let entries = self.states.iter().map(|span| span.points).fold(1, usize::saturating_mul);
        let shots = entries.saturating_mul(self.combinations());
        if shots > MOST_SHOTS {
            let room = shots as f64 * size_of::<Shot>() as f64 / 2_f64.powi(20);
            let found = format!(
                "a grid of {:.3e} states under {} levels, which takes {:.3e} shots and {room:.3e} MiB",
                entries as f64,
                self.combinations(),
                shots as f64
            );
            let expected = format!("at most {:.0e} shots: fewer points, or levels", MOST_SHOTS as f64);
            return Err(SweepError::value("plan.states", found, expected));
        }
        Ok(Grid { axes: self.states.iter().map(Span::places).collect() })
    }

    fn target(&self) -> Result<Condition, SweepError> {
        let names: Vec<&str> = self.states.iter().map(|span| span.name.as_str()).collect();
        Condition::compile(&self.target, &names).map_err(|error| {
            refused("plan.target", &self.target, &error, &format!("a condition on {}", names.join(", ")))
        })
    }

    fn cost(&self) -> Result<Formula, SweepError> {
        let controls = self.levels.iter().map(|(name, _)| name.rsplit('.').next().unwrap_or(name));
        let names: Vec<&str> = self.states.iter().map(|span| span.name.as_str()).chain(controls).collect();
        let twice = names.iter().enumerate().find(|(at, name)| names[..*at].contains(name));
        match (&self.cost, twice) {
            (None, _) => Ok(Formula::constant(0.0)),
            (Some(_), Some((_, name))) => Err(SweepError::value(
                "plan.cost",
                format!("a formula of two things called `{name}`"),
                "numbers of the state and controls with different names",
            )),
            (Some(cost), None) => Formula::compile(cost, &names).map_err(|error| {
                refused("plan.cost", cost, &error, &format!("a formula of {}", names.join(", ")))
            }),
        }
    }
}

/// What a formula is refused for.
fn refused(place: &str, text: &str, error: &ParseError, expected: &str) -> SweepError {
    SweepError::value(place, format!("`{text}`: {}", error.without_place()), expected)
}

fn levels_of((name, value): (&String, &Value)) -> Result<(String, Vec<f64>), SweepError> {
    let numbers = value.as_array().and_then(|list| list.iter().map(|it| as_quantity(it, "N")).collect());
    let is_good = |levels: &Vec<f64>| {
        !levels.is_empty()
            && levels.iter().all(|level| level.is_finite())
            && (1..levels.len()).all(|at| !levels[..at].contains(&levels[at]))
    };
    let levels = numbers.filter(is_good).ok_or_else(|| {
        SweepError::value(
            format!("plan.levels.\"{name}\""),
            value.to_string(),
            "a list of different finite commands [N]",
        )
    })?;
    Ok((name.clone(), levels))
}

fn text_of_set((name, value): (&String, &Value)) -> Result<(String, String), SweepError> {
    let text = value.as_str().map(str::to_owned).or_else(|| as_quantity(value, "").map(|it| it.to_string()));
    let text = text.ok_or_else(|| {
        SweepError::value(format!("plan.sets.\"{name}\""), value.to_string(), "a formula of the state")
    })?;
    Ok((name.clone(), text))
}

impl Span {
    fn read((name, value): (&String, &Value)) -> Result<Self, SweepError> {
        let place = |key: &str| format!("plan.states.{name}{key}");
        let Value::Table(table) = value else {
            let expected = "{ from = …, to = …, points = … }";
            return Err(SweepError::value(place(""), value.to_string(), expected));
        };
        refuse_unknown(&place("."), table, SPAN_KEYS)?;
        let found = |key: &str| table.get(key).map_or("missing".to_owned(), Value::to_string);
        let number = |key: &str| {
            let number = table.get(key).and_then(as_si).filter(|number| number.is_finite());
            number.ok_or_else(|| SweepError::value(place(&format!(".{key}")), found(key), "a finite number"))
        };
        let (from, to) = (number("from")?, number("to")?);
        if from >= to {
            return Err(SweepError::value(place(""), format!("from {from} to {to}"), "`from` below `to`"));
        }
        let points = match table.get("points") {
            Some(Value::Integer(points @ 2..)) => *points as usize,
            _ => {
                let expected = "a whole number of at least 2";
                return Err(SweepError::value(place(".points"), found("points"), expected));
            }
        };
        Ok(Self { name: name.clone(), from, to, points })
    }

    fn places(&self) -> Vec<f64> {
        let last = (self.points - 1) as f64;
        (0..self.points)
            // both ends to the bit
            .map(|at| (self.from * (last - at as f64) + self.to * at as f64) / last)
            .collect()
    }
}

/// A number in SI units, with any unit of its own.
fn as_si(value: &Value) -> Option<f64> {
    match value {
        Value::String(text) => souple_formal::parse_quantity(text).ok().map(|quantity| quantity.value),
        _ => as_quantity(value, ""),
    }
}

impl Tabulator<'_> {
    /// Looks for the table; `watch(done, all)` is told of shots. `None`: interrupted.
    ///
    /// # Errors
    /// The scene cannot be read or stepped, its state is not what the table is over, the grid is too large, or nothing leads to the target.
    pub fn run(&self, watch: &(dyn Fn(usize, usize) + Sync)) -> Result<Option<FoundTable>, SweepError> {
        let names = shooter::names(self.study)?;
        let mut tabulation = self.tabulation.clone();
        // names that it does not read are told of in their turn
        tabulation.states.sort_by_key(|span| names.iter().position(|name| *name == span.name));
        let found = Tabulator { tabulation: &tabulation, ..*self }.run_in_order(watch);
        found.map_err(|error| self.study.written.placed(error))
    }

    fn run_in_order(&self, watch: &(dyn Fn(usize, usize) + Sync)) -> Result<Option<FoundTable>, SweepError> {
        let grid = self.tabulation.grid()?;
        let pool = rayon::ThreadPoolBuilder::new().num_threads(self.count.max(1)).build()?;
        let mut shooter = Shooter::start(self.study, self.tabulation, &grid)?;
        let is_target = shooter.targets()?;
        if !is_target.contains(&false) {
            let expected = "one that does not hold in some state of the grid, to lead from there";
            return Err(SweepError::value(
                "plan.target",
                "a condition that every state of the grid meets",
                expected,
            ));
        }
        let Some((shots, failed)) = self.shots(&grid, &is_target, &pool, watch)? else { return Ok(None) };
        if !is_target.contains(&true) && !shots.iter().any(|shot| shot.end == iteration::End::Target) {
            let expected = "one that holds at a state of the grid, or on the way from one to the next";
            return Err(SweepError::value("plan.target", "a condition that no state meets", expected));
        }
        let combinations = 0..self.tabulation.combinations();
        let commands: Vec<Vec<f64>> =
            combinations.map(|combination| self.tabulation.commands(combination)).collect();
        let efforts: Vec<f64> =
            commands.iter().map(|all| all.iter().map(|command| command * command).sum()).collect();
        let all = Shots { grid: &grid, is_target: &is_target, shots: &shots, efforts: &efforts };
        let how = (self.tabulation.tolerance, self.tabulation.iterations);
        let Some(found) = all.values(how, &pool, self.stop) else { return Ok(None) };
        let values: Vec<f64> = (0..grid.len()).map(|entry| found.cost(entry)).collect();
        if !values.iter().zip(&is_target).any(|(value, is_target)| value.is_finite() && !is_target) {
            let expected =
                "a target that levels reach from states of the grid: more points, or stronger levels";
            return Err(SweepError::value("plan.target", "where nothing leads from elsewhere", expected));
        }
        let start = shooter.start_state();
        let of = |control: usize| {
            let each = found.levels.iter().zip(&values);
            each.map(|(level, value)| if value.is_finite() { commands[*level][control] } else { 0.0 })
                .collect()
        };
        let names = self.tabulation.levels.iter().enumerate();
        Ok(Some(FoundTable {
            names: self.tabulation.states.iter().map(|span| span.name.clone()).collect(),
            places: (0..grid.len()).map(|entry| grid.place(entry)).collect(),
            commands: names.map(|(index, (name, _))| (name.clone(), of(index))).collect(),
            from_start: grid.contains(&start).then(|| found.cost_at(&grid, &start)),
            shots: shots.len(),
            failed,
            iterations: found.iterations,
            is_converged: found.is_converged,
            values,
        }))
    }

    /// Shots from all entries, and how many of them could not be stepped.
    fn shots(
        &self,
        grid: &Grid,
        is_target: &[bool],
        pool: &rayon::ThreadPool,
        watch: &(dyn Fn(usize, usize) + Sync),
    ) -> Result<Option<(Vec<Shot>, usize)>, SweepError> {
        let (entries, levels) = (grid.len(), self.tabulation.combinations());
        let (done, share) = (AtomicUsize::new(0), entries.div_ceil(self.count.max(1)));
        let of_worker = |worker: usize| -> Result<(Vec<Shot>, Vec<String>), SweepError> {
            // a world for each: what a shot comes to does not depend on those before it
            let mut shooter = Shooter::start(self.study, self.tabulation, grid)?;
            let (mut shots, mut failed) = (Vec::new(), Vec::new());
            for entry in worker * share..((worker + 1) * share).min(entries) {
                if self.stop.is_wished() {
                    break;
                }
                shooter.refuse_what_is_not_of_the_state(entry, entry % levels)?;
                for level in 0..levels {
                    shots.push(shooter.shoot(entry, level, is_target[entry], &mut failed)?);
                }
                watch((done.fetch_add(1, Ordering::Relaxed) + 1) * levels, entries * levels);
            }
            Ok((shots, failed))
        };
        let workers = 0..entries.div_ceil(share);
        let each: Vec<(Vec<Shot>, Vec<String>)> =
            pool.install(|| workers.into_par_iter().map(of_worker).collect::<Result<_, _>>())?;
        if self.stop.is_wished() {
            return Ok(None);
        }
        let failed: Vec<&String> = each.iter().flat_map(|(_, failed)| failed).collect();
        let count = failed.len();
        if let Some(message) = failed.first().filter(|_| count == entries * levels) {
            return Err(SweepError::Failed {
                settings: "any state of the grid".to_owned(),
                message: (*message).clone(),
            });
        }
        Ok(Some((each.into_iter().flat_map(|(shots, _)| shots).collect(), count)))
    }
}

impl FoundTable {
    /// What a scene reads: a row for each state, the last number running fastest, with the commands there and what the way to the target costs.
    pub fn columns(&self) -> Vec<Column> {
        let number = |at: usize| self.places.iter().map(|place| place[at]).collect();
        let states = self.names.iter().enumerate().map(|(at, name)| Column::new(name.clone(), number(at)));
        let commands = self.commands.iter();
        let commands = commands.map(|(name, values)| Column::new(format!("{name} [N]"), values.clone()));
        states.chain(commands).chain([Column::new("value [s]", self.values.clone())]).collect()
    }

    /// How many entries there is no way from, with the first of them in words.
    pub fn unreached(&self) -> (usize, Option<String>) {
        let mut entries = (0..self.values.len()).filter(|entry| self.values[*entry].is_infinite());
        let first = entries.clone().next().map(|entry| self.in_words(entry));
        (entries.by_ref().count(), first)
    }

    fn in_words(&self, entry: usize) -> String {
        in_words(&self.names, &self.places[entry])
    }
}

/// `x = 1, v = 2`
fn in_words(names: &[impl AsRef<str>], place: &Place) -> String {
    let each = names.iter().zip(place).map(|(name, number)| format!("{} = {number}", name.as_ref()));
    each.collect::<Vec<_>>().join(", ")
}
