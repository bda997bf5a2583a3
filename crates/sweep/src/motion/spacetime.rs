//! Spacetime constraints by sequential quadratic programming on the scene's own steps.
//!
//! `min Σ w u²` over commands `|u| ≤ u_max` under keys `a ≤ y ≤ b`. Every trial is a run of the scene, so that its equations of motion hold
//! at every iteration and keys alone are linearised: `y + G (U − u)`, where a row of `G` comes of the gradient of its key by
//! `g_n = B_nᵀ λ`, `λ ← A_nᵀ λ` back in time. Commands sought are the least of `½ Σ w U² + Σ ρ d(y + G (U − u), [a, b])` within what actuators
//! give (Fletcher's Sl1QP, 1985), which has an answer where keys cannot be met too. The way there is taken as far as
//! `Σ w u² + Σ ρ d(y, [a, b])` falls; where the whole of it does not make it fall, once more with keys as they came out (a correction of the
//! second order), before it is halved. It ends where the way is short: there the conditions of a least are met.
//!
//! With windows the commands of one span of time are sought while others are held, in turn. Where windows share as many commands as keys
//! that come later ask for, what their least says of the price of these is the same, and so what is found is the least of the whole.

use std::ops::Range;

use souple_solve::quadratic::{self, NoLeast, QuadraticProgram, beyond};
use souple_table::{readable, with_unit};

use super::course::{Course, OFF, Trajectory, failed, whole};
use super::slopes::DIFFERENCE;
use super::{DESCENT, FoundMotion, HALVINGS, Motion, Planner, Seen, Spacetime, Watch, Windows};
use crate::SweepError;
use crate::least_squares::{Ending, beside, dot, length};

/// Commands in all, at most.
const MOST_COMMANDS: usize = 1_000_000;
/// Keys of a window that commands change, at most: systems of that size are solved.
const MOST_KEYS: usize = 2_000;
/// Commands of a window times keys, at most.
const MOST_SLOPES: usize = 20_000_000;
/// The sine of the angle between the row of a key and those of others, below which it is not told from them.
const ALIKE: f64 = 1e-7;
/// What a miss costs in a linearised problem, in units of what commands that mend it alone cost. Where keys are still missed the second
/// tells whether they can be met at all.
const PRICES: [f64; 2] = [1e5, 1e8];
/// Misses of a linearised problem below this share of what there was to mend are rounding.
const MET: f64 = 1e-9;
/// A change of what is paid and missed below this share of it is rounding, and no reason to turn back.
const ROUNDING: f64 = 1e-13;

/// What is said where slopes promise what does not come, and nothing else is known.
const UNSMOOTH: &str = "commands that slopes promise to bring keys nearer do not, and nothing touches on the way: the motion bends sharply with its \
                        commands, as where a law stops or switches, or it goes by an obstacle within a period";
/// What is said where no commands can be computed, and nothing else is known.
const UNLIKE: &str = "no commands can be computed that bring keys nearer: keys and `weights` are of very unlike sizes, or commands hardly change keys";

/// A search from some commands.
pub(super) struct Search<'a> {
    pub course: Course,
    motion: &'a Motion,
    windows: Vec<Range<usize>>,
    /// Of each key: what a unit of a miss costs where trials are weighed.
    prices: Vec<f64>,
    /// Of each key: `√(Σ g²/w)` by the commands of the window that changes it most, in the last iteration.
    lengths: Vec<f64>,
    /// The least of these that there was: differences across an impact are of a leap.
    least_lengths: Vec<f64>,
    /// Of each control, whether a key depends on it.
    is_felt: Vec<bool>,
    /// Why no step came nearer, where that is known.
    why: Option<String>,
}

/// Keys about a motion, linear in the commands of a window.
struct Linear {
    window: Range<usize>,
    /// Keys that these commands change, by their numbers.
    keys: Vec<usize>,
    rows: Vec<Vec<f64>>,
    /// `√(Σ g²/w)`
    lengths: Vec<f64>,
}

/// The least of a linearised problem.
struct Sought {
    /// Of the window.
    commands: Vec<f64>,
    /// Of each key of the linearised problem.
    multipliers: Vec<f64>,
}

/// What came of the turn of a window.
#[derive(PartialEq)]
enum Turn {
    Taken,
    /// A step would be no longer than the tolerance.
    Quiet,
    /// No step comes nearer.
    Stalled,
}

impl<'a> Search<'a> {
    /// # Errors
    /// The scene cannot be read or has nothing to command, or there are too many commands and keys at once.
    pub fn start(planner: &Planner<'a>, how: &Spacetime) -> Result<Self, SweepError> {
        let course = Course::start(planner.study, planner.motion, planner.stop.clone(), None)?;
        let count = course.controls.len();
        if course.periods.saturating_mul(count) > MOST_COMMANDS {
            let found = format!("{count} commands in {} periods", course.periods);
            return Err(SweepError::value("plan.keys", found, format!("at most {MOST_COMMANDS} in all")));
        }
        let windows = ranges(&how.windows, course.periods, course.world.model().period)?;
        for window in &windows {
            let keys = course.keys.iter().filter(|key| key.period > window.start).count();
            let commands = window.len() * count;
            if keys > MOST_KEYS || keys.saturating_mul(commands) > MOST_SLOPES {
                let found = format!("{keys} keys and {commands} commands that are sought at once");
                let expected = format!(
                    "at most {MOST_KEYS}, each period of a span being one, and {MOST_SLOPES} slopes of them by commands: shorter spans, or, for slopes, \
                     shorter `windows`"
                );
                return Err(SweepError::value("plan.keys", found, expected));
            }
        }
        let keys = course.keys.len();
        Ok(Self {
            motion: planner.motion,
            windows,
            prices: vec![0.0; keys],
            lengths: vec![0.0; keys],
            least_lengths: vec![f64::INFINITY; keys],
            is_felt: vec![false; count],
            why: None,
            course,
        })
    }

    /// No commands, as many as there are.
    pub fn none(&self) -> Vec<f64> {
        vec![0.0; self.course.periods * self.course.controls.len()]
    }

    /// From some commands, which are cut to what actuators give.
    ///
    /// # Errors
    /// The scene cannot be stepped, or no motion near at hand meets the keys.
    pub fn run(&mut self, mut commands: Vec<f64>, watch: Watch) -> Result<FoundMotion, SweepError> {
        for (command, control) in commands.iter_mut().zip(self.course.controls.iter().cycle()) {
            *command = command.clamp(-control.largest, control.largest);
        }
        let mut now = self.course.follow(commands)?;
        self.course.refuse_what_remembers(&now)?;
        let (mut iterations, mut ending) = (0, Ending::OutOfIterations);
        while iterations < self.motion.iterations {
            iterations += 1;
            self.lengths.fill(0.0);
            self.why = None;
            let turns = (0..self.windows.len()).map(|at| {
                let window = self.windows[at].clone();
                self.turn(&mut now, window, iterations == 1)
            });
            let turns: Vec<Turn> = turns.collect::<Result<_, _>>()?;
            if turns.iter().all(|turn| *turn == Turn::Quiet) {
                ending = Ending::Converged;
                break;
            }
            if !turns.contains(&Turn::Taken) {
                ending = Ending::Stalled;
                break;
            }
            let (cost, miss) = (self.paid(&now), self.greatest_miss(&now));
            watch(Seen { iterations, came_to: Some([cost, miss]), starts: None });
        }
        self.found(now, iterations, ending)
    }

    /// `Σ w u² h`
    fn paid(&self, now: &Trajectory) -> f64 {
        self.course.cost(&now.commands) * self.course.world.model().period
    }

    fn greatest_miss(&self, now: &Trajectory) -> f64 {
        let keys = self.course.keys.iter().zip(&now.reached);
        keys.map(|(key, reached)| beyond(*reached, key.band).abs()).fold(0.0, f64::max)
    }

    /// Goes on from a motion by the commands of a window.
    fn turn(
        &mut self,
        now: &mut Trajectory,
        window: Range<usize>,
        is_first: bool,
    ) -> Result<Turn, SweepError> {
        let rows = self.course.sensitivities(now, &window)?;
        if is_first && window.len() == self.course.periods {
            self.refuse_what_is_not_told(&rows)?;
        }
        let linear = self.linear(window, rows);
        let at = self.of_window(&now.commands, &linear.window);
        let sought = match self.least(&linear, &now.reached, &at)? {
            Some(sought) => sought,
            None => {
                self.why = Some(self.stopped(&linear).unwrap_or_else(|| UNLIKE.to_owned()));
                return Ok(Turn::Stalled);
            }
        };
        let change: Vec<f64> = sought.commands.iter().zip(&at).map(|(to, from)| to - from).collect();
        let all = self.course.cost(&self.with(now, &linear.window, &sought.commands));
        if self.course.cost(&change) <= self.motion.tolerance.powi(2) * all {
            return Ok(Turn::Quiet);
        }
        for (key, multiplier) in linear.keys.iter().zip(&sought.multipliers) {
            // Powell, 1978: at least twice what a key is worth, and no more than halved at a time
            self.prices[*key] =
                (2.0 * multiplier.abs()).max(0.5 * (self.prices[*key] + 2.0 * multiplier.abs()));
        }
        Ok(match self.descend(now, &linear, &sought)? {
            Some(next) => {
                *now = next;
                self.why = None;
                Turn::Taken
            }
            None => Turn::Stalled,
        })
    }

    fn linear(&mut self, window: Range<usize>, rows: Vec<Vec<f64>>) -> Linear {
        let mut linear = Linear { window, keys: Vec::new(), rows: Vec::new(), lengths: Vec::new() };
        for (key, row) in rows.into_iter().enumerate() {
            for (is_felt, index) in self.is_felt.iter_mut().zip(0..) {
                *is_felt |=
                    row.iter().skip(index).step_by(self.course.controls.len()).any(|slope| *slope != 0.0);
            }
            let length = length(&self.weighted(&row));
            self.lengths[key] = self.lengths[key].max(length);
            if length > 0.0 {
                self.least_lengths[key] = self.least_lengths[key].min(length);
                linear.keys.push(key);
                linear.rows.push(row);
                linear.lengths.push(length);
            }
        }
        linear
    }

    /// `G W^(-1/2)`
    fn weighted(&self, row: &[f64]) -> Vec<f64> {
        row.iter()
            .zip(self.course.weights.iter().cycle())
            .map(|(slope, weight)| slope / weight.sqrt())
            .collect()
    }

    /// Keys with a value that no command changes, or that others say already.
    fn refuse_what_is_not_told(&self, rows: &[Vec<f64>]) -> Result<(), SweepError> {
        let mut basis: Vec<Vec<f64>> = Vec::new();
        for (key, row) in rows.iter().enumerate() {
            let [low, high] = self.course.keys[key].band;
            if low < high {
                continue;
            }
            let row = self.weighted(row);
            // twice: once leaves rounding of what was taken off
            let left = beside(&beside(&row, &basis), &basis);
            let size = length(&left);
            // what is no number is not told either
            let is_told = size > ALIKE * length(&row);
            if !is_told {
                return Err(self.course.key_that_is_not_reached(key));
            }
            basis.push(left.iter().map(|entry| entry / size).collect());
        }
        Ok(())
    }

    fn of_window(&self, commands: &[f64], window: &Range<usize>) -> Vec<f64> {
        let count = self.course.controls.len();
        commands[window.start * count..window.end * count].to_vec()
    }

    /// The commands of a motion, but for a window.
    fn with(&self, now: &Trajectory, window: &Range<usize>, of_window: &[f64]) -> Vec<f64> {
        let mut commands = now.commands.clone();
        let first = window.start * self.course.controls.len();
        commands[first..first + of_window.len()].copy_from_slice(of_window);
        commands
    }

    /// Commands of the window for which the linearised keys, which come to `reached` under the commands `at`, are met at the least effort, or
    /// missed by the least. `None`: rows of keys are so unlike that none can be computed.
    fn least(&self, linear: &Linear, reached: &[f64], at: &[f64]) -> Result<Option<Sought>, SweepError> {
        let band = |(key, row): (&usize, &Vec<f64>)| {
            let from = dot(row, at) - reached[*key];
            self.course.keys[*key].band.map(|side| side + from)
        };
        let bands: Vec<[f64; 2]> = linear.keys.iter().zip(&linear.rows).map(band).collect();
        let to_mend = |commands: &[f64]| {
            let each = linear.rows.iter().zip(&bands).zip(&linear.lengths);
            each.map(|((row, band), length)| beyond(dot(row, commands), *band).abs() / length)
                .fold(0.0, f64::max)
        };
        let size = to_mend(&vec![0.0; at.len()]);
        if size == 0.0 {
            let (commands, multipliers) = (vec![0.0; at.len()], vec![0.0; bands.len()]);
            return Ok(Some(Sought { commands, multipliers }));
        }
        let controls = self.course.controls.iter().zip(&self.course.weights).cycle().take(at.len());
        let mut program = QuadraticProgram {
            curvature: controls.clone().map(|(_, weight)| *weight).collect(),
            gradient: vec![0.0; at.len()],
            bounds: controls.map(|(control, _)| [-control.largest, control.largest]).collect(),
            rows: linear
                .rows
                .iter()
                .zip(&bands)
                .map(|(row, band)| quadratic::Row { slopes: row.clone(), band: *band, price: 0.0 })
                .collect(),
        };
        let mut at_price = |price: f64| {
            for (row, length) in program.rows.iter_mut().zip(&linear.lengths) {
                row.price = price * size / length;
            }
            match program.solve(&|| self.course.is_stopped()) {
                Ok(least) => Ok(Some(least)),
                Err(NoLeast::Unsolved) => Ok(None),
                Err(NoLeast::Interrupted) => Err(failed("it was interrupted")),
            }
        };
        let mut least = at_price(PRICES[0])?;
        if least.as_ref().is_some_and(|least| to_mend(&least.values) > MET * size) {
            least = at_price(PRICES[1])?;
        }
        Ok(least.map(|least| Sought { commands: least.values, multipliers: least.multipliers }))
    }

    /// As far towards what is sought as what is paid and missed falls; `None` where it falls nowhere.
    fn descend(
        &mut self,
        now: &Trajectory,
        linear: &Linear,
        sought: &Sought,
    ) -> Result<Option<Trajectory>, SweepError> {
        let at = self.of_window(&now.commands, &linear.window);
        let before = self.weighed(&now.commands, &now.reached);
        let forecast = {
            let mut reached = now.reached.clone();
            for (key, row) in linear.keys.iter().zip(&linear.rows) {
                reached[*key] += dot(row, &sought.commands) - dot(row, &at);
            }
            let commands = self.with(now, &linear.window, &sought.commands);
            before - self.weighed(&commands, &reached)
        };
        let falls = |search: &Self, next: &Trajectory, share: f64| {
            let after = search.weighed(&next.commands, &next.reached);
            after < before - DESCENT * share * forecast.max(0.0) + ROUNDING * before
        };
        let mut first_tried: Option<Trajectory> = None;
        for halvings in 0..HALVINGS {
            let share = 0.5_f64.powi(halvings as i32);
            let commands: Vec<f64> =
                at.iter().zip(&sought.commands).map(|(from, to)| from + share * (to - from)).collect();
            let Some(next) = self.tried(now, linear, &commands)? else { continue };
            if falls(self, &next, share) {
                return Ok(Some(next));
            }
            first_tried.get_or_insert_with(|| next.clone());
            if halvings == 0
                && let Some(again) = self.least(linear, &next.reached, &commands)?
                && let Some(next) = self.tried(now, linear, &again.commands)?
                && falls(self, &next, share)
            {
                return Ok(Some(next));
            }
        }
        // where the step is smooth, a small enough part of the way brings a share of what is forecast
        if forecast > self.motion.tolerance * before {
            // what stops at a wall may touch it in what is tried alone
            let touch = match (self.course.first_touch(now)?, &first_tried) {
                (None, Some(tried)) => self.course.first_touch(tried)?,
                (touch, _) => touch,
            };
            self.why = Some(match (self.stopped(linear), touch) {
                (Some(why), _) => why,
                (None, Some((contact, time))) => format!(
                    "commands that slopes promise to bring keys nearer do not: contact `{contact}`, which presses from {} s on, stops the motion or \
                     throws it back, or is a way through that is easier",
                    readable(time)
                ),
                (None, None) => UNSMOOTH.to_owned(),
            });
        }
        Ok(None)
    }

    /// What stops the motion, in words: early commands change nothing of a key that later ones change.
    fn stopped(&self, linear: &Linear) -> Option<String> {
        let count = self.course.controls.len();
        let told = linear.keys.iter().zip(&linear.rows).filter_map(|(key, row)| {
            let most = row.iter().fold(0.0_f64, |most, slope| most.max(slope.abs()));
            let without = row.iter().take_while(|slope| slope.abs() <= ALIKE * most).count() / count;
            (without > 0).then_some((without, &self.motion.keys[self.course.keys[*key].of].probe))
        });
        let (periods, probe) = told.max_by_key(|(periods, _)| *periods)?;
        let time = (linear.window.start + periods) as f64 * self.course.world.model().period;
        Some(format!(
            "commands before {} s change nothing of `{probe}`, and later ones do: what they do is lost by then, as where a wall or an obstacle stops the motion, or drag does",
            readable(time)
        ))
    }

    /// The motion with other commands in a window; `None` where it cannot be stepped.
    fn tried(
        &mut self,
        now: &Trajectory,
        linear: &Linear,
        of_window: &[f64],
    ) -> Result<Option<Trajectory>, SweepError> {
        let first = linear.window.start;
        let commands = self.with(now, &linear.window, of_window);
        match self.course.follow_from(first, now.states[..=first].to_vec(), commands) {
            Err(SweepError::Failed { .. }) => Ok(None),
            next => next.map(Some),
        }
    }

    /// `Σ w u² + 2 Σ ρ d(y, [a, b])`
    fn weighed(&self, commands: &[f64], reached: &[f64]) -> f64 {
        let keys = self.course.keys.iter().zip(reached).zip(&self.prices);
        let missed: f64 = keys.map(|((key, reached), price)| price * beyond(*reached, key.band).abs()).sum();
        self.course.cost(commands) + 2.0 * missed
    }

    fn found(
        &mut self,
        now: Trajectory,
        iterations: usize,
        ending: Ending,
    ) -> Result<FoundMotion, SweepError> {
        self.course.refuse_what_remembers(&now)?;
        let missed = self.missed(&now);
        if ending == Ending::Converged && !missed.is_empty() {
            return Err(SweepError::Unmet { missed: missed.join("; "), bounds: self.bounds() });
        }
        let cost = self.paid(&now);
        let of_run = self.course.warnings_of(&now)?;
        let mut found = self.course.found(self.motion, now, (iterations, ending), cost, Vec::new());
        let idle = self.course.controls.iter().zip(&self.is_felt).filter(|(_, is_felt)| !**is_felt);
        found.warnings.extend(idle.map(|(control, _)| {
            format!(
                "no key depends on the commands of `{}`: what it pushes is held, or nothing that is measured hangs on it",
                control.name
            )
        }));
        found.warnings.extend(missed);
        found.warnings.extend(of_run);
        found.warnings.extend(self.why.take().filter(|_| ending == Ending::Stalled));
        Ok(found)
    }

    /// Keys that are missed by more than commands within the tolerance would mend, in words.
    fn missed(&self, now: &Trajectory) -> Vec<String> {
        let command = self.course.differences(now).command / DIFFERENCE;
        let size = self.course.cost(&vec![command; now.commands.len()]).sqrt();
        let mut worst: Vec<Option<(usize, f64)>> = vec![None; self.motion.keys.len()];
        for (at, (key, reached)) in self.course.keys.iter().zip(&now.reached).enumerate() {
            let by = beyond(*reached, key.band);
            let side = reached - by;
            // where the step is not smooth its slopes tell nothing
            let length = if self.why.is_none() {
                self.lengths[at]
            } else {
                self.lengths[at].min(self.least_lengths[at])
            };
            let of_rounding = if length > 0.0 { 0.0 } else { reached.abs() + side.abs() };
            let is_met = by.abs() <= self.motion.tolerance * (length * size).max(of_rounding);
            if !is_met && worst[key.of].is_none_or(|(_, most)| by.abs() > most.abs()) {
                worst[key.of] = Some((at, by));
            }
        }
        let words = worst.iter().enumerate().filter_map(|(of, worst)| worst.map(|worst| (of, worst)));
        words.map(|(of, (at, by))| self.in_words(of, at, by, now.reached[at])).collect()
    }

    fn in_words(&self, of: usize, at: usize, by: f64, reached: f64) -> String {
        let (asked, key) = (&self.motion.keys[of], &self.course.keys[at]);
        let unit = key.measured.0.unit;
        let number = |number: f64| with_unit(&format!("{number:.6e}"), unit);
        let date = match asked.when {
            super::When::At(_) => String::new(),
            super::When::During(_) => {
                format!(" after {} s", key.period as f64 * self.course.world.model().period)
            }
        };
        format!(
            "`plan.keys[{of}]` asks for `{}` to be {} {}, and it comes to {}{date}, {} {}",
            asked.probe,
            asked.wanted(unit),
            asked.when,
            number(reached),
            number(by.abs()),
            if by < 0.0 { "short" } else { "beyond" }
        )
    }

    /// What actuators give, in words.
    fn bounds(&self) -> String {
        let bounded = self.course.controls.iter().filter(|control| control.largest.is_finite());
        let each: Vec<String> =
            bounded.map(|control| format!("{} N of `{}`", control.largest, control.name)).collect();
        if each.is_empty() { String::new() } else { format!(" within {}", each.join(" and ")) }
    }
}

/// The periods of each window.
fn ranges(windows: &Windows, periods: usize, period: f64) -> Result<Vec<Range<usize>>, SweepError> {
    let first_from = |time: f64| (time / period - OFF).ceil() as usize;
    match windows {
        Windows::Whole => Ok(std::iter::once(0..periods).collect()),
        Windows::Each(spans) => {
            let each = spans.iter().enumerate().map(|(index, [from, until])| {
                let window = first_from(*from)..first_from(*until).min(periods);
                if window.is_empty() {
                    let found =
                        format!("from {from} s until {until} s, in which no period of the plan begins");
                    let expected = format!(
                        "a span with a multiple of {period} s in it, before {} s",
                        periods as f64 * period
                    );
                    return Err(SweepError::value(format!("plan.windows[{index}]"), found, expected));
                }
                Ok(window)
            });
            each.collect()
        }
        Windows::Sliding { length, overlap } => {
            let length = whole("plan.windows.length", *length, period)?;
            let overlap = match overlap {
                None => (length / 2).max(1),
                Some(0.0) => 0,
                Some(time) => whole("plan.windows.overlap", *time, period)?,
            };
            let on = length.saturating_sub(overlap).max(1);
            let mut all = Vec::new();
            for first in (0..periods).step_by(on) {
                all.push(first..(first + length).min(periods));
                if first + length >= periods {
                    break;
                }
            }
            Ok(all)
        }
    }
}
