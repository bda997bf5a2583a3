//! Linear-quadratic control: commands and gains from the end back.
//!
//! `h Σ_n [Σ q (y(S_n) − y*)² + Σ w u_n²]` and `w (y − y*)²` of keys that have a weight are the least, and keys without one are met. About
//! a motion of the scene's own steps, `A_n` and `B_n` are central differences of the step, and `y = y + M (S − S_n)`; going back from the
//! end gives changes of commands and gains ([`Remainder`]), and the next motion is stepped under `u_n + α k_n − K_n (S − S_n)`. `α` is
//! halved until what is paid, with `ρ` for a unit of a miss of keys, falls; of a linear network the first motion is the answer.

use souple_engine::State;

use super::course::{Course, Measured, Trajectory};
use super::riccati::{Law, Matrix, Remainder, Stage};
use super::slopes::{Coordinate, DIFFERENCE};
use super::{Cost, DESCENT, FoundMotion, Gain, HALVINGS, Planner, Seen, Watch};
use crate::SweepError;
use crate::least_squares::Ending;

/// Coordinates, positions and velocities, at most: matrices of that size are multiplied in each period.
const MOST_COORDINATES: usize = 120;
/// Commands in all, at most.
const MOST_COMMANDS: usize = 100_000;

pub(super) fn search(
    planner: &Planner,
    costs: &[Cost],
    duration: Option<f64>,
    watch: Watch,
) -> Result<FoundMotion, SweepError> {
    let course = Course::start(planner.study, planner.motion, planner.stop.clone(), duration)?;
    if course.coordinates.len() > MOST_COORDINATES {
        let found = format!("of {} coordinates", course.coordinates.len());
        let expected = format!(
            "at most {MOST_COORDINATES} for linear-quadratic control: positions and velocities of {} points",
            MOST_COORDINATES / 6
        );
        return Err(SweepError::value("scene", found, expected));
    }
    if course.periods.saturating_mul(course.controls.len()) > MOST_COMMANDS {
        let found = format!("{} commands in {} periods", course.controls.len(), course.periods);
        return Err(SweepError::value("plan.keys", found, format!("at most {MOST_COMMANDS} in all")));
    }
    let mut regulator = Regulator::new(planner, course, costs)?;
    let commands = vec![0.0; regulator.course.periods * regulator.course.controls.len()];
    let mut now = regulator.course.follow(commands)?;
    regulator.refuse_what_is_not_read(&now)?;
    regulator.course.refuse_what_remembers(&now)?;
    let mut paid = regulator.paid(&now)?;
    let (mut iterations, mut ending) = (0, Ending::OutOfIterations);
    let mut policy = regulator.policy(&now)?;
    while iterations < planner.motion.iterations {
        iterations += 1;
        if regulator.is_small(&now, &policy, planner.motion.tolerance)? {
            ending = Ending::Converged;
            break;
        }
        let Some((next, next_paid)) = regulator.descend(&now, paid, &policy)? else {
            ending = Ending::Stalled;
            break;
        };
        (now, paid) = (next, next_paid);
        policy = regulator.policy(&now)?;
        watch(Seen { iterations, came_to: Some([paid, regulator.greatest_miss(&now)]), starts: None });
    }
    regulator.course.refuse_what_remembers(&now)?;
    regulator.course.refuse_what_is_cut(&now)?;
    let gains = regulator.gains(&now, &policy)?;
    let of_run = regulator.course.warnings_of(&now)?;
    let mut found = regulator.course.found(planner.motion, now, (iterations, ending), paid, gains);
    found.warnings.extend(of_run);
    Ok(found)
}

struct Regulator {
    course: Course,
    /// What probes are to be near, with the value and what the square of the difference costs in a second.
    costs: Vec<(Measured, f64, f64)>,
    /// Of each key; `None`: it is to be met.
    key_weights: Vec<Option<f64>>,
    /// Of each key.
    values: Vec<f64>,
    period: f64,
}

/// What is to be done about a motion.
struct Policy {
    /// Of each period.
    laws: Vec<Law>,
    /// How much less is paid, to the second order.
    less: f64,
    /// Of keys that are to be met, by their numbers: what is paid for a unit of each.
    multipliers: Vec<(usize, f64)>,
}

impl Regulator {
    fn new(planner: &Planner, course: Course, costs: &[Cost]) -> Result<Self, SweepError> {
        let costs = costs.iter().map(|cost| {
            let measured = cost.probe.among(&course.probes)?;
            cost.quantities.iter().try_for_each(|quantity| quantity.check(measured.0.unit))?;
            Ok((measured, cost.value, cost.weight))
        });
        Ok(Self {
            costs: costs.collect::<Result<_, SweepError>>()?,
            key_weights: planner.motion.keys.iter().map(|key| key.weight).collect(),
            values: planner.motion.keys.iter().map(|key| key.band[0]).collect(),
            period: course.world.model().period,
            course,
        })
    }

    /// Controls read positions and velocities of masses as they stand between periods: what State holds has to be that.
    fn refuse_what_is_not_read(&mut self, now: &Trajectory) -> Result<(), SweepError> {
        for state in now.states.iter().take(2) {
            self.course.world.resume(state.clone()).map_err(super::course::failed)?;
            for (index, system) in state.systems.iter().enumerate() {
                let rows = self.course.world.rows(index);
                if rows.positions != system.q || rows.velocities != system.v {
                    let expected = "for linear-quadratic control, a scene of masses whose unknowns are their positions and velocities";
                    return Err(SweepError::value("scene", "of unknowns that are others", expected));
                }
            }
        }
        Ok(())
    }

    /// What a motion costs, but for keys that are to be met.
    fn paid(&mut self, motion: &Trajectory) -> Result<f64, SweepError> {
        let mut paid = self.course.cost(&motion.commands);
        for (measured, value, weight) in &self.costs {
            for state in &motion.states[..self.course.periods] {
                paid += weight * (self.course.measure(measured, state)? - value).powi(2);
            }
        }
        let misses = motion.reached.iter().zip(&self.values).map(|(found, value)| found - value);
        let of_keys = self.key_weights.iter().zip(misses);
        Ok(paid * self.period
            + of_keys.map(|(weight, miss)| weight.unwrap_or(0.0) * miss * miss).sum::<f64>())
    }

    /// The greatest miss of keys that are to be met.
    fn greatest_miss(&self, motion: &Trajectory) -> f64 {
        let misses = motion.reached.iter().zip(&self.values).map(|(found, value)| (found - value).abs());
        let exact = misses.zip(&self.key_weights).filter(|(_, weight)| weight.is_none());
        exact.fold(0.0, |most, (miss, _)| most.max(miss))
    }

    fn policy(&mut self, now: &Trajectory) -> Result<Policy, SweepError> {
        let differences = self.course.differences(now);
        let steps = &differences.coordinates;
        let count = self.course.controls.len();
        let prices: Vec<f64> = self.course.weights.iter().map(|weight| 2.0 * self.period * weight).collect();
        let mut left = Remainder::none(self.course.coordinates.len());
        self.add_keys(&mut left, now, self.course.periods, steps)?;
        let mut laws = Vec::with_capacity(self.course.periods);
        for period in (0..self.course.periods).rev() {
            let commands = &now.commands[period * count..(period + 1) * count];
            let state = &now.states[period];
            let of_state = self.of_state(state, commands, steps)?;
            let of_commands = self.of_commands(state, commands, differences.command)?;
            let stage = Stage { of_state: &of_state, of_commands: &of_commands, commands, prices: &prices };
            laws.push(left.step_back(&stage).ok_or_else(no_finite_gains)?);
            for index in 0..self.costs.len() {
                let (measured, value, weight) = self.costs[index].clone();
                let gradient = self.course.gradient(&measured, state, steps)?;
                let miss = self.course.measure(&measured, state)? - value;
                left.add_cost(weight * self.period, &gradient, miss);
            }
            self.add_keys(&mut left, now, period, steps)?;
        }
        if let Some(key) = left.unmet() {
            return Err(self.course.key_that_is_not_reached(key));
        }
        laws.reverse();
        let (less, multipliers) = left.forecast().ok_or_else(no_finite_gains)?;
        Ok(Policy { laws, less, multipliers })
    }

    /// Keys that are the end of `period` periods.
    fn add_keys(
        &mut self,
        left: &mut Remainder,
        now: &Trajectory,
        period: usize,
        steps: &[f64],
    ) -> Result<(), SweepError> {
        for (key, measured) in self.course.keys_at(period) {
            let gradient = self.course.gradient(&measured, &now.states[period], steps)?;
            let miss = now.reached[key] - self.values[key];
            match self.key_weights[key] {
                Some(weight) => left.add_cost(weight, &gradient, miss),
                None => left.add_key(key, gradient, miss),
            }
        }
        Ok(())
    }

    /// `A`
    fn of_state(&mut self, state: &State, commands: &[f64], steps: &[f64]) -> Result<Matrix, SweepError> {
        let all = self.course.coordinates.clone();
        let mut matrix = vec![Vec::with_capacity(all.len()); all.len()];
        for (coordinate, by) in all.iter().zip(steps) {
            let ahead = self.course.step(coordinate.moved(state, *by), commands)?;
            let behind = self.course.step(coordinate.moved(state, -by), commands)?;
            add_column(&mut matrix, &all, (&ahead, &behind), *by);
        }
        Ok(matrix)
    }

    /// `B`
    fn of_commands(&mut self, state: &State, commands: &[f64], by: f64) -> Result<Matrix, SweepError> {
        let all = self.course.coordinates.clone();
        let mut matrix = vec![Vec::with_capacity(commands.len()); all.len()];
        for index in 0..commands.len() {
            let mut beside = |by: f64| {
                let mut commands = commands.to_vec();
                commands[index] += by;
                self.course.step(state.clone(), &commands)
            };
            let (ahead, behind) = (beside(by)?, beside(-by)?);
            add_column(&mut matrix, &all, (&ahead, &behind), by);
        }
        Ok(matrix)
    }

    /// The motion under `u_n + α k_n − K_n (S − S_n)`.
    fn follow(&mut self, now: &Trajectory, policy: &Policy, share: f64) -> Result<Trajectory, SweepError> {
        let mut states = vec![self.course.start.clone()];
        let mut commands = Vec::with_capacity(now.commands.len());
        let count = self.course.controls.len();
        for (period, law) in policy.laws.iter().enumerate() {
            let deviation: Vec<f64> = self
                .course
                .coordinates
                .iter()
                .map(|coordinate| coordinate.of(&states[period]) - coordinate.of(&now.states[period]))
                .collect();
            let answers = super::riccati::times(&law.gains, &deviation);
            for (index, (change, answer)) in law.change.iter().zip(answers).enumerate() {
                commands.push(now.commands[period * count + index] + share * change - answer);
            }
            let next = self.course.step(states[period].clone(), &commands[period * count..])?;
            states.push(next);
        }
        let reached = self.course.reached(&states)?;
        Ok(Trajectory { commands, states, reached })
    }

    /// Whether the whole way would change commands by no more than `tolerance` of them, or of what differences tell.
    fn is_small(&mut self, now: &Trajectory, policy: &Policy, tolerance: f64) -> Result<bool, SweepError> {
        let whole = match self.follow(now, policy, 1.0) {
            Err(SweepError::Failed { .. }) => return Ok(false),
            whole => whole?,
        };
        let change: Vec<f64> = whole.commands.iter().zip(&now.commands).map(|(to, from)| to - from).collect();
        let command = self.course.differences(now).command;
        let told = self.course.cost(&vec![command * DIFFERENCE; now.commands.len()]);
        Ok(self.course.cost(&change) <= tolerance.powi(2) * self.course.cost(&whole.commands) + told)
    }

    /// As far as what is paid falls, `ρ` being twice what a key is worth; `None` where it falls nowhere.
    fn descend(
        &mut self,
        now: &Trajectory,
        paid: f64,
        policy: &Policy,
    ) -> Result<Option<(Trajectory, f64)>, SweepError> {
        let values = self.values.clone();
        let missed = |motion: &Trajectory| -> f64 {
            let of =
                |(key, worth): &(usize, f64)| 2.0 * worth.abs() * (motion.reached[*key] - values[*key]).abs();
            policy.multipliers.iter().map(of).sum()
        };
        let before = paid + missed(now);
        let forecast = policy.less + missed(now);
        for halvings in 0..HALVINGS {
            let share = 0.5_f64.powi(halvings as i32);
            let next = match self.follow(now, policy, share) {
                // it cannot be stepped so far
                Err(SweepError::Failed { .. }) => continue,
                next => next?,
            };
            let next_paid = self.paid(&next)?;
            if next_paid + missed(&next) < before - DESCENT * share * forecast.max(0.0) {
                return Ok(Some((next, next_paid)));
            }
        }
        Ok(None)
    }

    /// Columns of gains, but for numbers of the state that no control answers to.
    fn gains(&self, now: &Trajectory, policy: &Policy) -> Result<Vec<Gain>, SweepError> {
        let mut columns = Vec::new();
        for (index, control) in self.course.controls.iter().enumerate() {
            for (at, coordinate) in self.course.coordinates.iter().enumerate() {
                let gains: Vec<f64> = policy.laws.iter().map(|law| law.gains[index][at]).collect();
                if gains.iter().all(|gain| *gain == 0.0) {
                    continue;
                }
                if coordinate.system() != control.system || !control.rows.contains(&coordinate.point()) {
                    let found =
                        format!("such that `{}` answers to what is no mass of its network", control.name);
                    let expected = "one network with all that depends on each other";
                    return Err(SweepError::value("scene", found, expected));
                }
                columns.push(Gain {
                    control: control.name.clone(),
                    number: number(&control.body, coordinate.point() - control.rows.start, coordinate),
                    is_velocity: coordinate.is_velocity(),
                    planned: now.states.iter().map(|state| coordinate.of(state)).collect(),
                    gains,
                });
            }
        }
        Ok(columns)
    }
}

fn no_finite_gains() -> SweepError {
    SweepError::value("plan", "a motion with no finite gains", "keys that commands reach, and finite weights")
}

/// `(X₊ − X₋)/2ε`
fn add_column(matrix: &mut Matrix, all: &[Coordinate], (ahead, behind): (&State, &State), by: f64) {
    for (row, coordinate) in matrix.iter_mut().zip(all) {
        row.push((coordinate.of(ahead) - coordinate.of(behind)) / (2.0 * by));
    }
}

fn number(body: &str, mass: usize, coordinate: &Coordinate) -> String {
    let of = if coordinate.is_velocity() { "v." } else { "" };
    format!("{body}[{mass}].{of}{}", ["x", "y", "z"][coordinate.component()])
}
