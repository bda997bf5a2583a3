//! Planned motion: commands of actuators with which a scene comes to key states, at the least effort.
//!
//! Spacetime constraints (Witkin and Kass, 1988) on the motion as it is stepped: `min Σ w u²` over all commands of all periods, under
//! `X_{n+1} = step(X_n, u_n)` and `y_k(X_{n_k}) = y*_k`. The trajectory is that of the scene's own stepper, so that dynamics hold at every
//! iteration; what is solved for is `G (U − u) = y* − y` with the least `Σ w U²`, `U = W⁻¹Gᵀ (G W⁻¹Gᵀ)⁻¹ (y* − y + G u)`, where a row of `G`
//! comes of the gradient of its key by `g_n = B_nᵀ λ`, `λ ← A_nᵀ λ` back in time. `A_n` and `B_n` are central differences of the step
//! about the trajectory. A step is taken as far as `Σ w u² + Σ ρ |y* − y|` falls; of a linear network the first is the answer.
//!
//! Linear-quadratic control (Brotman and Netravali, 1988) asks for `∫ Σ q (y − y*)² + Σ w u² dt` to be the least, with keys that are met
//! exactly or at a price, and gives gains for what comes in between beside commands ([`linear_quadratic`]).

mod linear_quadratic;
mod riccati;

use souple_engine::{Interruption, State, World};
use souple_io::Column;
use souple_scene::{PlannedControl, ProbeInfo, Scene};
use toml::{Table, Value};

use crate::SweepError;
use crate::fit::{Wanted, as_number, refuse_unknown};
use crate::least_squares::{Ending, beside, dot, length, solve};
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
    /// All commands of all periods at once.
    Spacetime,
    /// From the end back, with gains.
    LinearQuadratic {
        costs: Vec<Cost>,
        /// How long it goes on at least [s]; to the last key where `None`.
        duration: Option<f64>,
    },
}

/// What a probe is to be at a time.
#[derive(Clone, Debug)]
pub struct KeyState {
    /// [s]
    pub time: f64,
    pub probe: Wanted,
    pub value: f64,
    /// What the square of a miss costs; `None`: there is none.
    pub weight: Option<f64>,
}

/// What a probe is to be near all the time.
#[derive(Clone, Debug)]
pub struct Cost {
    pub probe: Wanted,
    pub value: f64,
    /// What the square of its difference costs in a second.
    pub weight: f64,
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
    /// What each key came to.
    pub reached: Vec<f64>,
    pub iterations: usize,
    /// Periods stepped in all.
    pub steps: usize,
    pub ending: Ending,
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

const KEYS: &[&str] = &["kind", "keys", "weights", "tolerance", "iterations"];
const LINEAR_QUADRATIC_KEYS: &[&str] =
    &["kind", "keys", "weights", "tolerance", "iterations", "costs", "duration"];
const KEY_KEYS: &[&str] = &["time", "probe", "value"];
const WEIGHTED_KEY_KEYS: &[&str] = &["time", "probe", "value", "weight"];
const COST_KEYS: &[&str] = &["probe", "value", "weight"];
/// Coordinates of a scene that is planned for, positions and velocities, at most: a period is stepped twice for each.
const MOST_COORDINATES: usize = 600;
/// Commands in all, at most.
const MOST_COMMANDS: usize = 100_000;
/// Central differences of a length `ε^(1/3)` of a scale have errors of `ε^(2/3)`.
const DIFFERENCE: f64 = 6e-6;
/// The sine of the angle between the row of a key and those of others, below which it is not told from them.
const ALIKE: f64 = 1e-7;
/// Halvings of a step before it is given up.
const HALVINGS: u32 = 20;
/// Share of the decrease that was forecast which a step has to bring.
const DESCENT: f64 = 1e-4;

impl Motion {
    /// # Errors
    /// A key is missing or unknown, or has a value that cannot be.
    pub(crate) fn read(table: &Table) -> Result<Self, SweepError> {
        let found = |key: &str| table.get(key).map_or("missing".to_owned(), Value::to_string);
        let kind = match table.get("kind").and_then(Value::as_str) {
            Some("spacetime") => {
                refuse_unknown("plan.", table, KEYS)?;
                Kind::Spacetime
            }
            Some("linear_quadratic") => {
                refuse_unknown("plan.", table, LINEAR_QUADRATIC_KEYS)?;
                Kind::linear_quadratic(table)?
            }
            _ => {
                let expected = "\"spacetime\", \"linear_quadratic\" or \"state_space\"";
                return Err(SweepError::value("plan.kind", found("kind"), expected));
            }
        };
        let keys = match table.get("keys") {
            Some(Value::Array(keys)) if !keys.is_empty() => keys.as_slice(),
            None if matches!(&kind, Kind::LinearQuadratic { costs, duration: Some(_) } if !costs.is_empty()) => {
                &[]
            }
            _ => {
                let expected = match kind {
                    Kind::Spacetime => "tables `[[plan.keys]]`",
                    Kind::LinearQuadratic { .. } => {
                        "tables `[[plan.keys]]`, or `[[plan.costs]]` and a `duration`"
                    }
                };
                return Err(SweepError::value("plan.keys", found("keys"), expected));
            }
        };
        let keys = keys.iter().enumerate().map(|(index, key)| KeyState::read(&kind, index, key));
        let keys = keys.collect::<Result<_, _>>()?;
        let tolerance = match table.get("tolerance") {
            None => 1e-6,
            Some(value) => {
                as_number(value).filter(|share| *share > 0.0 && *share < 1.0).ok_or_else(|| {
                    SweepError::value("plan.tolerance", found("tolerance"), "a number above 0, below 1")
                })?
            }
        };
        let iterations = match table.get("iterations") {
            None => 100,
            Some(Value::Integer(count @ 1..)) => *count as usize,
            Some(_) => {
                return Err(SweepError::value(
                    "plan.iterations",
                    found("iterations"),
                    "a whole number above 0",
                ));
            }
        };
        let weights = match table.get("weights") {
            None => Vec::new(),
            Some(Value::Table(weights)) => weights.iter().map(weight).collect::<Result<_, _>>()?,
            Some(_) => {
                return Err(SweepError::value("plan.weights", found("weights"), "a table of controls"));
            }
        };
        Ok(Self { kind, keys, weights, tolerance, iterations })
    }
}

fn weight((name, value): (&String, &Value)) -> Result<(String, f64), SweepError> {
    let weight = as_number(value).filter(|weight| *weight > 0.0 && weight.is_finite());
    let place = format!("plan.weights.\"{name}\"");
    let weight = weight.ok_or_else(|| SweepError::value(place, value.to_string(), "a number above 0"))?;
    Ok((name.clone(), weight))
}

impl Kind {
    fn linear_quadratic(table: &Table) -> Result<Self, SweepError> {
        let duration = match table.get("duration") {
            None => None,
            Some(value) => {
                let seconds = as_number(value).filter(|seconds| *seconds > 0.0 && seconds.is_finite());
                Some(seconds.ok_or_else(|| {
                    SweepError::value("plan.duration", value.to_string(), "seconds above 0")
                })?)
            }
        };
        let costs = match table.get("costs") {
            None => &[],
            Some(Value::Array(costs)) => costs.as_slice(),
            Some(value) => {
                return Err(SweepError::value("plan.costs", value.to_string(), "tables `[[plan.costs]]`"));
            }
        };
        let costs = costs.iter().enumerate().map(|(index, cost)| Cost::read(index, cost));
        Ok(Self::LinearQuadratic { costs: costs.collect::<Result<_, _>>()?, duration })
    }
}

/// A table of a list, with its place in messages.
struct Entry<'a> {
    place: String,
    table: Option<&'a Table>,
}

impl<'a> Entry<'a> {
    fn read(place: String, value: &'a Value, keys: &[&str]) -> Result<Self, SweepError> {
        let table = value.as_table();
        if let Some(table) = table {
            refuse_unknown(&format!("{place}."), table, keys)?;
        }
        Ok(Self { place, table })
    }

    fn get(&self, key: &str) -> Option<&'a Value> {
        self.table.and_then(|table| table.get(key))
    }

    fn fault(&self, key: &str, expected: &str) -> SweepError {
        let found = self.get(key).map_or("missing".to_owned(), Value::to_string);
        SweepError::value(format!("{}.{key}", self.place), found, expected)
    }

    fn number(&self, key: &str) -> Option<f64> {
        self.get(key).and_then(as_number).filter(|number| number.is_finite())
    }

    fn probe(&self, key: &'static str) -> Result<Wanted, SweepError> {
        let probe = self.get("probe").and_then(Value::as_str);
        let expected = "a probe of the scene, with .x, .y or .z of a vector";
        Ok(Wanted::read(key, probe.ok_or_else(|| self.fault("probe", expected))?))
    }

    fn value(&self) -> Result<f64, SweepError> {
        self.number("value").ok_or_else(|| self.fault("value", "a finite number"))
    }

    fn weight(&self) -> Result<f64, SweepError> {
        let weight = self.number("weight").filter(|weight| *weight > 0.0);
        weight.ok_or_else(|| self.fault("weight", "a number above 0"))
    }
}

impl Cost {
    fn read(index: usize, value: &Value) -> Result<Self, SweepError> {
        let entry = Entry::read(format!("plan.costs[{index}]"), value, COST_KEYS)?;
        Ok(Self { probe: entry.probe("plan.costs.probe")?, value: entry.value()?, weight: entry.weight()? })
    }
}

impl KeyState {
    fn read(kind: &Kind, index: usize, value: &Value) -> Result<Self, SweepError> {
        let keys = match kind {
            Kind::Spacetime => KEY_KEYS,
            Kind::LinearQuadratic { .. } => WEIGHTED_KEY_KEYS,
        };
        let entry = Entry::read(format!("plan.keys[{index}]"), value, keys)?;
        let probe = entry.probe("plan.keys.probe")?;
        let time = entry.number("time").filter(|time| *time > 0.0);
        Ok(Self {
            probe,
            time: time.ok_or_else(|| entry.fault("time", "seconds above 0"))?,
            value: entry.value()?,
            weight: entry.get("weight").map(|_| entry.weight()).transpose()?,
        })
    }
}

/// What a motion is sought with.
pub struct Planner<'a> {
    pub study: &'a Study,
    pub motion: &'a Motion,
    pub stop: &'a Interruption,
}

impl Planner<'_> {
    /// Looks for the motion; `watch(iterations, cost, miss)` is told of each step, `miss` being the greatest of a key. `None`: interrupted.
    ///
    /// # Errors
    /// The scene cannot be read or stepped, has nothing to command, or cannot reach a key.
    pub fn run(&self, watch: &mut dyn FnMut(usize, f64, f64)) -> Result<Option<FoundMotion>, SweepError> {
        let found = match &self.motion.kind {
            Kind::Spacetime => self.search(watch),
            Kind::LinearQuadratic { costs, duration } => {
                linear_quadratic::search(self, costs, *duration, watch)
            }
        };
        if self.stop.is_wished() { Ok(None) } else { found.map(Some) }
    }

    fn search(&self, watch: &mut dyn FnMut(usize, f64, f64)) -> Result<FoundMotion, SweepError> {
        let mut course = Course::start(self.study, self.motion, self.stop.clone(), None)?;
        let period = course.world.model().period;
        let mut now = course.follow(vec![0.0; course.periods * course.controls.len()])?;
        let (mut iterations, mut ending) = (0, Ending::OutOfIterations);
        while iterations < self.motion.iterations {
            iterations += 1;
            let rows = course.sensitivities(&now)?;
            let sought = course.least(&rows, &now)?;
            let change: Vec<f64> =
                sought.commands.iter().zip(&now.commands).map(|(to, from)| to - from).collect();
            if course.cost(&change) <= self.motion.tolerance.powi(2) * course.cost(&sought.commands) {
                ending = Ending::Converged;
                break;
            }
            let Some(next) = course.descend(&now, &change, &sought)? else {
                ending = Ending::Stalled;
                break;
            };
            now = next;
            watch(iterations, course.cost(&now.commands) * period, now.greatest_miss(&course.values));
        }
        let cost = course.cost(&now.commands) * period;
        course.found(now, (iterations, ending), cost, Vec::new())
    }
}

/// A scene whose commands are given from outside.
struct Course {
    world: World,
    start: State,
    controls: Vec<PlannedControl>,
    probes: Vec<ProbeInfo>,
    /// Of the commands of a period.
    weights: Vec<f64>,
    periods: usize,
    /// Of each key: the period that it is the end of, its probe, and which of its numbers.
    keys: Vec<(usize, Measured)>,
    /// Of each key.
    values: Vec<f64>,
    coordinates: Vec<Coordinate>,
    steps: usize,
    stop: Interruption,
}

/// A probe, and which of its numbers.
type Measured = (ProbeInfo, usize);

/// A number of the state that evolves.
#[derive(Clone, Copy)]
pub(crate) struct Coordinate {
    system: usize,
    point: usize,
    component: usize,
    is_velocity: bool,
}

/// A motion: commands, period by period, the states between periods, and what keys come to.
struct Trajectory {
    commands: Vec<f64>,
    states: Vec<State>,
    reached: Vec<f64>,
}

/// What the linearised problem asks for.
struct Least {
    commands: Vec<f64>,
    /// Of each key: `dcost/dy`, half.
    multipliers: Vec<f64>,
}

impl Coordinate {
    pub fn is_velocity(self) -> bool {
        self.is_velocity
    }

    pub fn of(self, state: &State) -> f64 {
        let system = &state.systems[self.system];
        let block = if self.is_velocity { system.v[self.point] } else { system.q[self.point] };
        block[self.component]
    }

    fn moved(self, state: &State, by: f64) -> State {
        let mut state = state.clone();
        let system = &mut state.systems[self.system];
        let block = if self.is_velocity { &mut system.v[self.point] } else { &mut system.q[self.point] };
        block[self.component] += by;
        state
    }
}

impl std::fmt::Display for Coordinate {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let of = if self.is_velocity { "velocity" } else { "position" };
        write!(f, "the {} of the {of} of point {}", ["x", "y", "z"][self.component], self.point)
    }
}

impl Trajectory {
    fn greatest_miss(&self, values: &[f64]) -> f64 {
        self.reached.iter().zip(values).map(|(found, value)| (found - value).abs()).fold(0.0, f64::max)
    }
}

impl Course {
    /// A scene at its start, planned for up to the last key, and for `duration` [s] at least.
    fn start(
        study: &Study,
        motion: &Motion,
        stop: Interruption,
        duration: Option<f64>,
    ) -> Result<Self, SweepError> {
        let refuse =
            |message: String| SweepError::Scene { run: 0, settings: study.settings.join(", "), message };
        let (scene, controls) = souple_scene::read_file_to_plan(&study.scene, &study.settings)
            .map_err(|found| refuse(found.to_string()))?;
        let Scene { mut model, state, probes, .. } = scene;
        if controls.is_empty() {
            let expected = "controls of actuators with `plan = \"FILE.csv\"`";
            return Err(SweepError::value("scene", "without commands that are planned", expected));
        }
        model.controls.retain(|control| controls.iter().all(|planned| planned.name != control.name()));
        if let Some((name, _)) =
            motion.weights.iter().find(|(name, _)| controls.iter().all(|it| it.name != *name))
        {
            let known: Vec<&str> = controls.iter().map(|control| control.name.as_str()).collect();
            return Err(SweepError::value("plan.weights", name, format!("a control: {}", known.join(", "))));
        }
        let whole = |place: String, time: f64| {
            let periods = time / model.period;
            if (periods - periods.round()).abs() > 1e-6 * periods || periods < 0.5 {
                let expected = format!("a whole number of periods of {} s", model.period);
                return Err(SweepError::value(place, time.to_string(), expected));
            }
            Ok(periods.round() as usize)
        };
        let mut keys = Vec::new();
        for (index, key) in motion.keys.iter().enumerate() {
            keys.push((whole(format!("plan.keys[{index}].time"), key.time)?, key.probe.among(&probes)?));
        }
        let last = duration.map(|time| whole("plan.duration".to_owned(), time)).transpose()?;
        let periods = keys.iter().map(|(period, ..)| *period).chain(last).max().unwrap_or(0);
        if periods.saturating_mul(controls.len()) > MOST_COMMANDS {
            let found = format!("{} commands in {periods} periods", controls.len());
            return Err(SweepError::value("plan.keys", found, format!("at most {MOST_COMMANDS} in all")));
        }
        let coordinates = coordinates(&state)?;
        let weight = |control: &PlannedControl| {
            motion.weights.iter().find(|(name, _)| *name == control.name).map_or(1.0, |(_, weight)| *weight)
        };
        Ok(Self {
            weights: controls.iter().map(weight).collect(),
            start: state.clone(),
            world: model.start(state),
            controls,
            probes,
            periods,
            keys,
            values: motion.keys.iter().map(|key| key.value).collect(),
            coordinates,
            steps: 0,
            stop,
        })
    }

    /// The state a period after `state` under commands.
    fn step(&mut self, mut state: State, commands: &[f64]) -> Result<State, SweepError> {
        let failed = |message: String| SweepError::Failed { settings: "these commands".to_owned(), message };
        for (control, command) in self.controls.iter().zip(commands) {
            state.driven[control.driven] = *command;
        }
        if self.stop.is_wished() {
            return Err(failed("it was interrupted".to_owned()));
        }
        self.steps += 1;
        self.world.resume(state).map_err(|error| failed(error.to_string()))?;
        self.world.step().map_err(|error| failed(error.to_string()))?;
        Ok(self.world.state().clone())
    }

    fn measure(&mut self, (probe, number): &Measured, state: &State) -> Result<f64, SweepError> {
        let failed = |message: String| SweepError::Failed { settings: "these commands".to_owned(), message };
        self.world.resume(state.clone()).map_err(|error| failed(error.to_string()))?;
        Ok(probe.measure(&mut self.world).numbers()[*number])
    }

    /// What keys come to where these are the states between periods.
    fn reached(&mut self, states: &[State]) -> Result<Vec<f64>, SweepError> {
        let keys = self.keys.clone();
        keys.iter().map(|(period, measured)| self.measure(measured, &states[*period])).collect()
    }

    /// `dy/dX`, by coordinates.
    fn gradient(
        &mut self,
        measured: &Measured,
        state: &State,
        steps: [f64; 2],
    ) -> Result<Vec<f64>, SweepError> {
        let mut gradient = Vec::with_capacity(self.coordinates.len());
        for coordinate in self.coordinates.clone() {
            let by = steps[usize::from(coordinate.is_velocity)];
            let ahead = self.measure(measured, &coordinate.moved(state, by))?;
            let behind = self.measure(measured, &coordinate.moved(state, -by))?;
            gradient.push((ahead - behind) / (2.0 * by));
        }
        Ok(gradient)
    }

    fn follow(&mut self, commands: Vec<f64>) -> Result<Trajectory, SweepError> {
        let mut states = vec![self.start.clone()];
        for period in 0..self.periods {
            let count = self.controls.len();
            let next = self.step(states[period].clone(), &commands[period * count..(period + 1) * count])?;
            states.push(next);
        }
        let reached = self.reached(&states)?;
        Ok(Trajectory { commands, states, reached })
    }

    /// `Σ w u²`
    fn cost(&self, commands: &[f64]) -> f64 {
        commands
            .iter()
            .zip(self.weights.iter().cycle())
            .map(|(command, weight)| weight * command * command)
            .sum()
    }

    /// Steps of differences: of positions, velocities and commands.
    fn differences(&self, now: &Trajectory) -> [f64; 3] {
        let horizon = self.periods as f64 * self.world.model().period;
        let span = |coordinate: &Coordinate| {
            let values = || now.states.iter().map(|state| coordinate.of(state));
            values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
        };
        let greatest = |is_velocity: bool| {
            let some = self.coordinates.iter().filter(|coordinate| coordinate.is_velocity == is_velocity);
            some.map(span).fold(0.0, f64::max)
        };
        // what does not move yet is of the order of a metre
        let size = Some(greatest(false)).filter(|span| *span > 0.0).unwrap_or(1.0);
        let speed = greatest(true).max(size / horizon);
        let mass: f64 = self.world.model().systems.iter().flat_map(|system| &system.mass.diagonal).sum();
        let command = now.commands.iter().fold(mass * size / horizon.powi(2), |most, it| most.max(it.abs()));
        [size, speed, command].map(|scale| DIFFERENCE * scale)
    }

    /// Keys that are the end of `period` periods, by their numbers.
    fn keys_at(&self, period: usize) -> Vec<(usize, Measured)> {
        let keys = self.keys.iter().enumerate().filter(|(_, (at, _))| *at == period);
        keys.map(|(key, (_, measured))| (key, measured.clone())).collect()
    }

    /// `∂y_k/∂u`, a row for each key.
    fn sensitivities(&mut self, now: &Trajectory) -> Result<Vec<Vec<f64>>, SweepError> {
        let [position, velocity, command] = self.differences(now);
        let (count, all) = (self.controls.len(), self.coordinates.clone());
        let step_of = |coordinate: &Coordinate| if coordinate.is_velocity { velocity } else { position };
        let mut rows = vec![vec![0.0; now.commands.len()]; self.keys.len()];
        // of keys that are not before the period: dy/dX at its end
        let mut gradients: Vec<(usize, Vec<f64>)> = Vec::new();
        for period in (0..self.periods).rev() {
            for (key, measured) in self.keys_at(period + 1) {
                let gradient = self.gradient(&measured, &now.states[period + 1], [position, velocity])?;
                gradients.push((key, gradient));
            }
            let (state, commands) =
                (&now.states[period], &now.commands[period * count..(period + 1) * count]);
            // Bᵀλ
            for index in 0..count {
                let mut beside = |by: f64| {
                    let mut commands = commands.to_vec();
                    commands[index] += by;
                    self.step(state.clone(), &commands)
                };
                let (ahead, behind) = (beside(command)?, beside(-command)?);
                for (key, gradient) in &gradients {
                    rows[*key][period * count + index] = slope(&all, gradient, (&ahead, &behind), command);
                }
            }
            // Aᵀλ
            let mut earlier: Vec<Vec<f64>> =
                gradients.iter().map(|_| Vec::with_capacity(all.len())).collect();
            for coordinate in &all {
                let by = step_of(coordinate);
                let ahead = self.step(coordinate.moved(state, by), commands)?;
                let behind = self.step(coordinate.moved(state, -by), commands)?;
                for ((_, gradient), earlier) in gradients.iter().zip(&mut earlier) {
                    earlier.push(slope(&all, gradient, (&ahead, &behind), by));
                }
            }
            gradients.iter_mut().zip(earlier).for_each(|((_, gradient), earlier)| *gradient = earlier);
        }
        Ok(rows)
    }

    /// `U = W⁻¹Gᵀ μ`, `G W⁻¹Gᵀ μ = y* − y + G u`
    fn least(&self, rows: &[Vec<f64>], now: &Trajectory) -> Result<Least, SweepError> {
        // G W^(-1/2)
        let weighted: Vec<Vec<f64>> = rows
            .iter()
            .map(|row| row.iter().zip(self.weights.iter().cycle()).map(|(g, w)| g / w.sqrt()).collect())
            .collect();
        let mut basis: Vec<Vec<f64>> = Vec::new();
        for (key, row) in weighted.iter().enumerate() {
            // twice: once leaves rounding of what was taken off
            let left = beside(&beside(row, &basis), &basis);
            let size = length(&left);
            // what is no number is not told either
            let is_told = size > ALIKE * length(row);
            if !is_told {
                return Err(Self::key_that_is_not_reached(key));
            }
            basis.push(left.iter().map(|entry| entry / size).collect());
        }
        let sizes: Vec<f64> = weighted.iter().map(|row| length(row)).collect();
        let matrix = weighted
            .iter()
            .zip(&sizes)
            .map(|(a, of_a)| weighted.iter().zip(&sizes).map(|(b, of_b)| dot(a, b) / (of_a * of_b)).collect())
            .collect();
        let right = (rows.iter().zip(&sizes).enumerate())
            .map(|(key, (row, size))| (self.values[key] - now.reached[key] + dot(row, &now.commands)) / size)
            .collect();
        let solved = solve(matrix, right).ok_or_else(|| {
            SweepError::value("plan.keys", "a motion with no finite commands", "keys that commands reach")
        })?;
        let multipliers: Vec<f64> = solved.iter().zip(&sizes).map(|(mu, size)| mu / size).collect();
        let command = |index: usize| {
            let sum: f64 = rows.iter().zip(&multipliers).map(|(row, mu)| row[index] * mu).sum();
            sum / self.weights[index % self.weights.len()]
        };
        Ok(Least { commands: (0..now.commands.len()).map(command).collect(), multipliers })
    }

    fn key_that_is_not_reached(key: usize) -> SweepError {
        SweepError::value(
            format!("plan.keys[{key}]"),
            "what no command changes, or what other keys say already",
            "keys that commands reach each by itself, with at least as many commands as keys",
        )
    }

    /// As far along a change as `Σ w u² + Σ ρ |y* − y|` falls, `ρ` being twice what a key is worth; `None` where it falls nowhere.
    fn descend(
        &mut self,
        now: &Trajectory,
        change: &[f64],
        sought: &Least,
    ) -> Result<Option<Trajectory>, SweepError> {
        let worth: Vec<f64> = sought.multipliers.iter().map(|mu| 4.0 * mu.abs()).collect();
        let missed = |reached: &[f64], values: &[f64]| -> f64 {
            reached
                .iter()
                .zip(values)
                .zip(&worth)
                .map(|((found, value), worth)| worth * (found - value).abs())
                .sum()
        };
        let before = self.cost(&now.commands) + missed(&now.reached, &self.values);
        let forecast = before - self.cost(&sought.commands);
        for halvings in 0..HALVINGS {
            let share = 0.5_f64.powi(halvings as i32);
            let commands =
                now.commands.iter().zip(change).map(|(command, by)| command + share * by).collect();
            let next = match self.follow(commands) {
                // it cannot be stepped so far
                Err(SweepError::Failed { .. }) => continue,
                next => next?,
            };
            let after = self.cost(&next.commands) + missed(&next.reached, &self.values);
            if after < before - DESCENT * share * forecast.max(0.0) {
                return Ok(Some(next));
            }
        }
        Ok(None)
    }

    /// What is handed back of a motion.
    fn found(
        &self,
        now: Trajectory,
        (iterations, ending): (usize, Ending),
        cost: f64,
        gains: Vec<Gain>,
    ) -> Result<FoundMotion, SweepError> {
        self.refuse_what_is_cut(&now)?;
        let count = self.controls.len();
        let of = |index: usize| now.commands.iter().skip(index).step_by(count).copied().collect();
        let controls = self.controls.iter().enumerate();
        Ok(FoundMotion {
            commands: controls.map(|(index, control)| (control.name.clone(), of(index))).collect(),
            period: self.world.model().period,
            gains,
            cost,
            reached: now.reached,
            iterations,
            steps: self.steps,
            ending,
        })
    }

    /// Commands that an actuator would cut off make another motion.
    fn refuse_what_is_cut(&self, now: &Trajectory) -> Result<(), SweepError> {
        for (index, control) in self.controls.iter().enumerate() {
            let of = now.commands.iter().skip(index).step_by(self.controls.len());
            let wanted = of.fold(0.0_f64, |most, command| most.max(command.abs()));
            if wanted > control.largest {
                let (name, largest) = (control.name.clone(), control.largest);
                return Err(SweepError::Beyond { name, wanted, largest });
            }
        }
        Ok(())
    }
}

/// `λ · (X₊ − X₋)/2ε`
fn slope(all: &[Coordinate], gradient: &[f64], (ahead, behind): (&State, &State), by: f64) -> f64 {
    let change = |coordinate: &Coordinate| coordinate.of(ahead) - coordinate.of(behind);
    all.iter().zip(gradient).map(|(coordinate, gradient)| gradient * change(coordinate)).sum::<f64>()
        / (2.0 * by)
}

pub(crate) fn coordinates(state: &State) -> Result<Vec<Coordinate>, SweepError> {
    let mut all = Vec::new();
    for (index, system) in state.systems.iter().enumerate() {
        if system.q.len() != system.v.len() {
            let expected = "a scene of points, without rigid frames";
            return Err(SweepError::value("scene", "of frames that turn", expected));
        }
        for point in 0..system.q.len() {
            for component in 0..3 {
                let coordinate = |is_velocity| Coordinate { system: index, point, component, is_velocity };
                all.extend([false, true].map(coordinate));
            }
        }
    }
    if all.len() > MOST_COORDINATES {
        let found = format!("of {} coordinates", all.len());
        let expected = format!(
            "at most {MOST_COORDINATES}: positions and velocities of {} points",
            MOST_COORDINATES / 6
        );
        return Err(SweepError::value("scene", found, expected));
    }
    Ok(all)
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
