//! Planned motion: commands of actuators with which a scene comes to key states, at the least effort.
//!
//! Spacetime constraints (Witkin and Kass, 1988) ask for `min Σ w u²` over all commands of all periods within what actuators give, under
//! `X_{n+1} = step(X_n, u_n)` and keys `a_k ≤ y_k(X_{n_k}) ≤ b_k`, on the scene's own steps ([`spacetime`]); over windows of time in turn
//! (Cohen, 1992), and from several starts ([`starts`]).
//!
//! Linear-quadratic control (Brotman and Netravali, 1988) asks for `∫ Σ q (y − y*)² + Σ w u² dt` to be the least, with keys that are met
//! exactly or at a price, and gives gains for what comes in between beside commands ([`linear_quadratic`]).

mod course;
mod linear_quadratic;
mod read;
mod riccati;
mod slopes;
mod spacetime;
mod starts;

use std::fmt;
use std::path::PathBuf;

use souple_engine::Interruption;
use souple_io::Column;
use souple_table::with_unit;

pub(crate) use self::course::whole;
pub(crate) use self::slopes::{Coordinate, coordinates};
use crate::SweepError;
use crate::fit::Wanted;
use crate::least_squares::Ending;
use crate::study::Study;

/// A motion that is sought.
#[derive(Clone, Debug)]
pub struct Motion {
    pub kind: Kind,
    pub keys: Vec<KeyState>,
    /// What the square of a command costs, by the name of its control; 1 of others.
    pub weights: Vec<(String, f64)>,
    /// Where a step changes commands by no more than this share of them, it ends.
    pub tolerance: f64,
    pub iterations: usize,
}

/// How a motion is sought.
#[derive(Clone, Debug)]
pub enum Kind {
    /// All commands of all periods, at once or by windows.
    Spacetime(Spacetime),
    /// From the end back, with gains.
    LinearQuadratic {
        costs: Vec<Cost>,
        /// How long it goes on at least [s]; to the last key where `None`.
        duration: Option<f64>,
    },
}

/// Where commands are sought, and from where.
#[derive(Clone, Debug)]
pub struct Spacetime {
    pub windows: Windows,
    /// A file of commands to begin with; none at all where `None`.
    pub start: Option<PathBuf>,
    /// The first from these, others from commands at random.
    pub starts: usize,
    pub seed: u64,
}

/// Spans of time whose commands are sought while others are held.
#[derive(Clone, Debug, PartialEq)]
pub enum Windows {
    /// All at once.
    Whole,
    /// `[from, until]`, in their order [s].
    Each(Vec<[f64; 2]>),
    /// One after the other from the start to the end [s]; they overlap by half of their periods, rounded down, where that is not told.
    Sliding { length: f64, overlap: Option<f64> },
}

/// What a probe is to be, and when.
#[derive(Clone, Debug)]
pub struct KeyState {
    pub when: When,
    pub probe: Wanted,
    /// The least and the most, infinite where open, the same of a value.
    pub band: [f64; 2],
    /// What the square of a miss costs; `None`: there is none.
    pub weight: Option<f64>,
    pub(crate) quantities: Vec<Quantity>,
}

/// When a key holds [s].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum When {
    At(f64),
    /// At the end of every period from the one to the other.
    During([f64; 2]),
}

/// What a probe is to be near all the time.
#[derive(Clone, Debug)]
pub struct Cost {
    pub probe: Wanted,
    pub value: f64,
    /// What the square of its difference costs in a second.
    pub weight: f64,
    pub(crate) quantities: Vec<Quantity>,
}

/// A number that is written with a unit, which has to be one of what the probe measures.
#[derive(Clone, Debug)]
pub(crate) struct Quantity {
    /// Path of the key.
    key: String,
    text: String,
}

impl Quantity {
    /// # Errors
    /// It is of another dimension than `unit`.
    pub fn check(&self, unit: &str) -> Result<(), SweepError> {
        let expected = || match unit {
            "" => "a finite number without a unit, as its probe has none".to_owned(),
            unit => format!("a finite number in {unit}, or with a unit of its kind, as its probe has"),
        };
        match souple_formal::quantity_in(&self.text, unit) {
            Ok(_) => Ok(()),
            Err(_) => Err(SweepError::value(&self.key, format!("\"{}\"", self.text), expected())),
        }
    }
}

/// What was found.
#[derive(Clone, Debug)]
pub struct FoundMotion {
    /// Controls, by `BODY.CONTROL`, with their commands period by period [N].
    pub commands: Vec<(String, Vec<f64>)>,
    /// [s]
    pub period: f64,
    /// Of each control, what it makes of numbers of the state; none of spacetime constraints.
    pub gains: Vec<Gain>,
    /// `Σ w u² h` [N² s], and what else costs.
    pub cost: f64,
    /// What each key came to; of one that lasts, where it is farthest out of its band or nearest to going out of it.
    pub reached: Vec<f64>,
    /// SI units of keys.
    pub units: Vec<&'static str>,
    pub iterations: usize,
    /// Periods stepped in all.
    pub steps: usize,
    pub ending: Ending,
    /// What should be known of it.
    pub warnings: Vec<String>,
    /// What each start came to, where there are several.
    pub attempts: Vec<Attempt>,
}

/// What a start came to.
#[derive(Clone, Debug, PartialEq)]
pub struct Attempt {
    /// Of a motion that meets its keys and that no step betters [N² s].
    pub cost: Option<f64>,
    /// What is wrong with it otherwise.
    pub message: String,
}

/// A column of gains, `u = u_n − K_n (S − S_n)`.
#[derive(Clone, Debug)]
pub struct Gain {
    /// `BODY.CONTROL`
    pub control: String,
    /// `BODY[MASS].x` of a position, `BODY[MASS].v.x` of a velocity.
    pub number: String,
    pub is_velocity: bool,
    /// Period by period, and at the end [m, m/s].
    pub planned: Vec<f64>,
    /// Period by period [N/m, N s/m].
    pub gains: Vec<f64>,
}

/// Halvings of a step before it is given up.
const HALVINGS: u32 = 20;
/// Share of the decrease that was forecast which a step has to bring.
const DESCENT: f64 = 1e-4;

impl When {
    /// When it is over [s].
    pub fn end(self) -> f64 {
        match self {
            Self::At(time) => time,
            Self::During([_, until]) => until,
        }
    }
}

impl fmt::Display for When {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::At(time) => write!(f, "at {time} s"),
            Self::During([from, until]) => write!(f, "from {from} s until {until} s"),
        }
    }
}

impl KeyState {
    /// What is asked for, with its unit.
    pub fn wanted(&self, unit: &str) -> String {
        let with_unit = |number: f64| with_unit(&number.to_string(), unit);
        match self.band {
            [low, high] if low == high => with_unit(low),
            [low, high] if high.is_infinite() => format!("at least {}", with_unit(low)),
            [low, high] if low.is_infinite() => format!("at most {}", with_unit(high)),
            [low, high] => format!("{low} to {}", with_unit(high)),
        }
    }
}

/// What a motion is sought with.
pub struct Planner<'a> {
    pub study: &'a Study,
    pub motion: &'a Motion,
    /// Starts at once.
    pub count: usize,
    pub stop: &'a Interruption,
}

/// What a search has come to.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    pub iterations: usize,
    /// Its cost, and the greatest miss of a key; `None` of a start that ends with an error.
    pub came_to: Option<[f64; 2]>,
    /// Of several starts those that are over, and how many there are.
    pub starts: Option<[usize; 2]>,
}

/// Told of each step, and of each of several starts that is over.
pub type Watch<'a> = &'a (dyn Fn(Seen) + Sync);

impl Planner<'_> {
    /// Looks for the motion. `None`: interrupted.
    ///
    /// # Errors
    /// The scene cannot be read or stepped, has nothing to command, or cannot reach a key.
    pub fn run(&self, watch: Watch) -> Result<Option<FoundMotion>, SweepError> {
        let found = match &self.motion.kind {
            Kind::Spacetime(how) => starts::search(self, how, watch),
            Kind::LinearQuadratic { costs, duration } => {
                linear_quadratic::search(self, costs, *duration, watch)
            }
        };
        if self.stop.is_wished() {
            return Ok(None);
        }
        found.map(Some).map_err(|error| self.study.written.placed(error))
    }
}

impl FoundMotion {
    /// What a scene reads: a row for each period with the commands that act in it, with what numbers of the state that have gains are planned
    /// to be then and those gains; and a row with no command and no gain from the end on.
    pub fn columns(&self) -> Vec<Column> {
        let periods = self.commands.first().map_or(0, |(_, commands)| commands.len());
        let mut columns =
            vec![Column::new("time [s]", (0..=periods).map(|period| period as f64 * self.period).collect())];
        let and_none = |values: &[f64]| values.iter().copied().chain([0.0]).collect();
        for (name, commands) in &self.commands {
            columns.push(Column::new(format!("{name} [N]"), and_none(commands)));
        }
        for gain in &self.gains {
            let name = format!("{} [{}]", gain.number, if gain.is_velocity { "m/s" } else { "m" });
            // several controls may have gains of one number
            if columns.iter().all(|column| column.name != name) {
                columns.push(Column::new(name, gain.planned.clone()));
            }
        }
        for gain in &self.gains {
            let unit = if gain.is_velocity { "N s/m" } else { "N/m" };
            let name = format!("{} / {} [{unit}]", gain.control, gain.number);
            columns.push(Column::new(name, and_none(&gain.gains)));
        }
        columns
    }
}
