//! Several starts: the least of the motions that commands at random lead to.
//!
//! The first search begins with no commands, or those of a file; each other with a sum of a few cosines over the whole time, of amplitudes
//! at random that fall with their frequency, as large as the actuator gives at most, or as the greatest command of the first answer where it
//! has no bound. Of what they come to the cheapest that meets its keys is kept. Each start has numbers of its own, so that what is found is
//! the same however many are made at once.

use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use souple_scene::{PlanFault, PlanFile};
use souple_solve::quadratic::beyond;
use souple_table::counted;

use super::course::Course;
use super::slopes::DIFFERENCE;
use super::spacetime::Search;
use super::{Attempt, FoundMotion, Motion, Planner, Seen, Spacetime, Watch};
use crate::SweepError;
use crate::least_squares::Ending;

/// Cosines of commands at random: as slow as that none, one and up to four halves of a wave are in the whole time.
const WAVES: usize = 5;
/// Costs that are as near are those of one motion.
const SAME: f64 = 1e-3;

pub(super) fn search(planner: &Planner, how: &Spacetime, watch: Watch) -> Result<FoundMotion, SweepError> {
    let mut search = Search::start(planner, how)?;
    let start = match &how.start {
        None => search.none(),
        Some(file) => from_file(file, &search.course)?,
    };
    let first = search.run(start, watch);
    if how.starts == 1 || planner.stop.is_wished() {
        return first;
    }
    let over = AtomicUsize::new(0);
    let tell = |found: &Result<FoundMotion, SweepError>| {
        let starts = Some([1 + over.fetch_add(1, Ordering::Relaxed), how.starts]);
        let iterations = found.as_ref().map_or(0, |found| found.iterations);
        let found = found.as_ref().ok();
        let came_to = found.map(|found| [found.cost, greatest_miss(planner.motion, found)]);
        watch(Seen { iterations, came_to, starts });
    };
    tell(&first);
    let sizes = sizes(&mut search, &first)?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(planner.count.max(1)).build()?;
    let attempt = |index: usize| {
        let found = Search::start(planner, how).and_then(|mut search| {
            let commands = random(how.seed, index, search.course.periods, &sizes);
            search.run(commands, &|_| {})
        });
        tell(&found);
        found
    };
    let others: Vec<Result<FoundMotion, SweepError>> =
        pool.install(|| (1..how.starts).into_par_iter().map(attempt).collect());
    let all: Vec<Result<FoundMotion, SweepError>> = std::iter::once(first).chain(others).collect();
    best_of(all)
}

/// Commands of all controls period by period; those of the last row go on, as in a scene.
fn from_file(path: &Path, course: &Course) -> Result<Vec<f64>, SweepError> {
    let refused =
        |found: String, expected: String| SweepError::Plan { path: path.to_owned(), found, expected };
    let text = std::fs::read_to_string(path)
        .map_err(|error| refused(error.to_string(), "a plan, as `souple sweep` writes it".to_owned()))?;
    let fault = |fault: PlanFault| refused(fault.found, fault.expected);
    let file = PlanFile::read(&text, course.world.model().period).map_err(fault)?;
    let commands_of = |name: &str| -> Result<Vec<f64>, SweepError> {
        let commands: Vec<f64> = file.column(file.column_of_commands(name).map_err(fault)?).collect();
        Ok((0..course.periods).map(|period| commands[period.min(commands.len() - 1)]).collect())
    };
    let each = course.controls.iter().map(|control| commands_of(&control.name));
    let each = each.collect::<Result<Vec<_>, _>>()?;
    Ok((0..course.periods).flat_map(|period| each.iter().map(move |commands| commands[period])).collect())
}

fn greatest_miss(motion: &Motion, found: &FoundMotion) -> f64 {
    let keys = motion.keys.iter().zip(&found.reached);
    keys.map(|(key, reached)| beyond(*reached, key.band).abs()).fold(0.0, f64::max)
}

/// The cheapest of what searches found, with what each came to.
///
/// # Errors
/// None of them found any; what they came to, each once.
fn best_of(all: Vec<Result<FoundMotion, SweepError>>) -> Result<FoundMotion, SweepError> {
    let attempts: Vec<Attempt> = all.iter().map(attempt).collect();
    let steps = all.iter().flatten().map(|found| found.steps).sum();
    let costs = attempts.iter().enumerate().filter_map(|(at, attempt)| Some((at, attempt.cost?)));
    // the first of those that cost the same
    let best = costs.min_by(|(_, a), (_, b)| a.total_cmp(b)).map(|(at, _)| at);
    let best = best.or_else(|| all.iter().position(Result::is_ok)).unwrap_or(0);
    let count = all.len();
    match all.into_iter().nth(best) {
        Some(Ok(found)) => Ok(FoundMotion { attempts, steps, ..found }),
        _ => Err(SweepError::Starts { count, messages: in_words(&attempts).join("; ") }),
    }
}

/// What is wrong with starts that came to nothing, each once, with how many there are of it.
fn in_words(attempts: &[Attempt]) -> Vec<String> {
    let mut messages: Vec<(&str, usize)> = Vec::new();
    for attempt in attempts.iter().filter(|attempt| attempt.cost.is_none()) {
        match messages.iter_mut().find(|(message, _)| *message == attempt.message) {
            Some((_, count)) => *count += 1,
            None => messages.push((&attempt.message, 1)),
        }
    }
    messages
        .iter()
        .map(|(message, count)| format!("{}: {message}", counted(*count as u64, "start")))
        .collect()
}

fn attempt(found: &Result<FoundMotion, SweepError>) -> Attempt {
    match found {
        Ok(found) if found.ending == Ending::Converged => {
            Attempt { cost: Some(found.cost), message: String::new() }
        }
        Ok(found) => {
            let message = match found.ending {
                Ending::Stalled => "no step came nearer".to_owned(),
                _ => format!("still on its way after {} iterations", found.iterations),
            };
            Attempt { cost: None, message }
        }
        Err(error) => Attempt { cost: None, message: error.to_string() },
    }
}

impl FoundMotion {
    /// What is wrong with starts that came to nothing, in words.
    pub fn without_answer(&self) -> Vec<String> {
        in_words(&self.attempts)
    }

    /// Costs that starts came to, the least first, with how many came there; those are one that differ by less than a thousandth.
    pub fn answers(&self) -> Vec<(f64, usize)> {
        let mut costs: Vec<f64> = self.attempts.iter().filter_map(|attempt| attempt.cost).collect();
        costs.sort_by(f64::total_cmp);
        let mut answers: Vec<(f64, usize)> = Vec::new();
        for cost in costs {
            match answers.last_mut() {
                Some((least, count)) if cost <= *least * (1.0 + SAME) => *count += 1,
                _ => answers.push((cost, 1)),
            }
        }
        answers
    }
}

/// Greatest commands to begin with, of each control [N].
fn sizes(search: &mut Search, first: &Result<FoundMotion, SweepError>) -> Result<Vec<f64>, SweepError> {
    let still = search.none();
    let still = search.course.follow(still)?;
    let usual = search.course.differences(&still).command / DIFFERENCE;
    let controls = search.course.controls.iter().enumerate().map(|(index, control)| {
        if control.largest.is_finite() {
            return control.largest;
        }
        let commands = first.iter().flat_map(|found| &found.commands[index].1);
        Some(commands.fold(0.0, |most: f64, command| most.max(command.abs())))
            .filter(|it| *it > 0.0)
            .unwrap_or(usual)
    });
    Ok(controls.collect())
}

/// Smooth commands at random, those of all controls period by period.
fn random(seed: u64, index: usize, periods: usize, sizes: &[f64]) -> Vec<f64> {
    let mut numbers = Numbers::of(seed, index);
    let curves: Vec<Vec<f64>> = sizes.iter().map(|size| numbers.curve(periods, *size)).collect();
    (0..periods).flat_map(|period| curves.iter().map(move |curve| curve[period])).collect()
}

/// Numbers at random (Steele, Lea and Flood, 2014).
struct Numbers {
    state: u64,
}

impl Numbers {
    /// Of one start of a study.
    fn of(seed: u64, index: usize) -> Self {
        let mut numbers = Self { state: seed };
        // apart from each other however near seeds are
        Self { state: numbers.next().wrapping_add(index as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) }
    }

    fn next(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.state;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// From 0 to 1.
    fn uniform(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// `Σ a_j cos(j π t/T)`, `a_j` up to `1/(1 + j)`, scaled to a share of `size` at random.
    fn curve(&mut self, periods: usize, size: f64) -> Vec<f64> {
        let amplitudes: Vec<f64> =
            (0..WAVES).map(|wave| (2.0 * self.uniform() - 1.0) / (1.0 + wave as f64)).collect();
        let share = self.uniform();
        let at = |period: usize| {
            let phase = std::f64::consts::PI * (period as f64 + 0.5) / periods as f64;
            let waves = amplitudes.iter().enumerate();
            waves.map(|(wave, amplitude)| amplitude * libm::cos(wave as f64 * phase)).sum::<f64>()
        };
        let curve: Vec<f64> = (0..periods).map(at).collect();
        let greatest = curve.iter().fold(f64::MIN_POSITIVE, |most, value| most.max(value.abs()));
        curve.iter().map(|value| share * size * value / greatest).collect()
    }
}
