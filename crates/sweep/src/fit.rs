//! Identification: values of a scene for which a probe follows a curve that was measured.
//!
//! Least squares `Σ r_i²`, `r_i = y(t_i) − m_i` ([`crate::least_squares`]), where the Jacobian comes of one run more for each value, at once. Values
//! go between their bounds; where the lower is above zero, their logarithms are what steps are made in, so that none is lost among larger ones.
//!
//! A curve over a probe goes one way, as the probe does: a loop of loading and unloading has two values at one place, and is refused.

use std::path::{Path, PathBuf};

use souple_engine::Interruption;
use souple_run::{Control, Options, Status, Trace};
use souple_scene::ProbeInfo;
use toml::{Table, Value};

use crate::SweepError;
use crate::least_squares::{Answer, Certainty, Ending, Problem, certainty, mean_square};
use crate::study::Study;

/// What is looked for.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The probe that is to follow the curve.
    pub probe: Wanted,
    /// The probe that the curve is over; the time where `None`.
    pub over: Option<Wanted>,
    /// The file of the curve.
    pub curve_file: PathBuf,
    /// Points of the curve, by growing abscissa.
    pub curve: Vec<[f64; 2]>,
    pub unknowns: Vec<Unknown>,
    /// Where a step changes no value by more than this share of its range, it ends.
    pub tolerance: f64,
    pub iterations: usize,
}

/// A probe, with its component where it is a vector.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Wanted {
    /// The key that names it.
    key: String,
    pub name: String,
    /// From 0; `None` of what is no vector.
    pub component: Option<usize>,
}

/// A value of the scene that is looked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Unknown {
    pub path: String,
    pub unit: String,
    pub start: f64,
    pub bounds: [f64; 2],
}

/// What was found.
#[derive(Clone, Debug)]
pub struct Found {
    /// Values, and their standard errors; not known where points are no more than values, where a value changes nothing, or of `alike`.
    pub values: Vec<(f64, Option<f64>)>,
    /// Values, by their numbers, that the curve does not tell from one another: other ones give the same.
    pub alike: Vec<usize>,
    /// Root of the mean square of what is left.
    pub residual: f64,
    /// Share of the curve's own variance that is explained; `None` where it has none.
    pub explained: Option<f64>,
    pub iterations: usize,
    pub runs: usize,
    pub ending: Ending,
    /// Abscissa, measured, found.
    pub curve: Vec<[f64; 3]>,
}

const KEYS: &[&str] = &["probe", "over", "curve", "values", "tolerance", "iterations"];
const UNKNOWN_KEYS: &[&str] = &["start", "min", "max", "unit"];
/// How far a curve may go back, as a share of its range: what rounding does.
const BACK: f64 = 1e-9;

impl Fit {
    /// # Errors
    /// A key is missing or unknown, a bound is wrong, the curve is none.
    pub(crate) fn read(
        value: &Value,
        folder: &Path,
        read: impl FnOnce(&Path) -> Result<String, SweepError>,
    ) -> Result<Self, SweepError> {
        let Value::Table(table) = value else {
            return Err(SweepError::value("fit", value.to_string(), "a table"));
        };
        refuse_unknown("fit.", table, KEYS)?;
        let text = |key: &str, expected: &str| match table.get(key) {
            Some(Value::String(text)) => Ok(text.clone()),
            Some(other) => Err(SweepError::value(format!("fit.{key}"), other.to_string(), expected)),
            None => Err(SweepError::value(format!("fit.{key}"), "missing", expected)),
        };
        let curve_file: PathBuf = folder.join(text("curve", "a file of two columns with commas")?);
        let text_of_curve = read(&curve_file).map_err(|error| match error {
            SweepError::Read { path, source } => {
                let found = format!("{}: {source}", path.display());
                SweepError::value("fit.curve", found, "a text file of two columns with commas")
            }
            other => other,
        })?;
        let mut curve = curve(&curve_file, &text_of_curve)?;
        let over = match table.get("over") {
            None => None,
            Some(_) => Some(Wanted::read("fit.over", &text("over", "a probe of the scene")?)),
        };
        if over.is_some()
            && let Some(point) = first_back(&curve)
        {
            return Err(SweepError::value("fit.curve", goes_back(point), ONE_WAY));
        }
        curve.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let Some(Value::Table(values)) = table.get("values") else {
            return Err(SweepError::value(
                "fit.values",
                "missing",
                "a table of paths with start, min and max",
            ));
        };
        let unknowns: Vec<Unknown> =
            values.iter().map(|(path, value)| Unknown::read(path, value)).collect::<Result<_, _>>()?;
        if unknowns.is_empty() || unknowns.len() > curve.len() {
            let found = format!("{} values for {} points", unknowns.len(), curve.len());
            return Err(SweepError::value(
                "fit.values",
                found,
                "at least one, and no more than points of the curve",
            ));
        }
        let probe =
            Wanted::read("fit.probe", &text("probe", "a probe of the scene, with .x, .y or .z of a vector")?);
        let tolerance = match table.get("tolerance").map(|value| (as_number(value), value)) {
            None => 1e-6,
            Some((Some(share), _)) if share > 0.0 && share < 1.0 => share,
            Some((_, value)) => {
                return Err(SweepError::value(
                    "fit.tolerance",
                    value.to_string(),
                    "a number above 0, below 1",
                ));
            }
        };
        let iterations = match table.get("iterations") {
            None => 50,
            Some(Value::Integer(count @ 1..)) => *count as usize,
            Some(other) => {
                let expected = "a whole number above 0";
                return Err(SweepError::value("fit.iterations", other.to_string(), expected));
            }
        };
        Ok(Self { probe, over, curve_file, curve, unknowns, tolerance, iterations })
    }
}

impl std::fmt::Display for Wanted {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self.component {
            None => f.write_str(&self.name),
            Some(component) => write!(f, "{}.{}", self.name, ["x", "y", "z"][component]),
        }
    }
}

impl Wanted {
    /// `PROBE`, `PROBE.x`: the probe and its component.
    pub(crate) fn read(key: impl Into<String>, text: &str) -> Self {
        let key = key.into();
        for (component, suffix) in [".x", ".y", ".z"].into_iter().enumerate() {
            if let Some(name) = text.strip_suffix(suffix) {
                return Self { key, name: name.to_owned(), component: Some(component) };
            }
        }
        Self { key, name: text.to_owned(), component: None }
    }

    /// The probe, and which of its numbers.
    pub(crate) fn among(&self, probes: &[ProbeInfo]) -> Result<(ProbeInfo, usize), SweepError> {
        let Some(probe) = probes.iter().find(|probe| probe.name == self.name) else {
            let known: Vec<&str> = probes.iter().map(|probe| probe.name.as_str()).collect();
            return Err(SweepError::value(&self.key, &self.name, format!("a probe: {}", known.join(", "))));
        };
        let number = self.number(if probe.gives_vector() { 3 } else { 1 })?;
        Ok((probe.clone(), number))
    }

    /// Times and values of the probe.
    fn of(&self, traces: &[Trace]) -> Result<(Vec<f64>, Vec<f64>), SweepError> {
        let Some(trace) = traces.iter().find(|trace| trace.name == self.name) else {
            let known: Vec<&str> = traces.iter().map(|trace| trace.name.as_str()).collect();
            return Err(SweepError::value(&self.key, &self.name, format!("a probe: {}", known.join(", "))));
        };
        let component = self.number(trace.components)?;
        let values = trace.values.iter().skip(component).step_by(trace.components).copied().collect();
        Ok((trace.times.clone(), values))
    }

    /// Which of the numbers of a value that has so many is meant.
    fn number(&self, components: usize) -> Result<usize, SweepError> {
        match (self.component, components) {
            (None, 1) => Ok(0),
            (Some(component), components) if components > 1 && component < components => Ok(component),
            (Some(_), _) => {
                Err(SweepError::value(&self.key, self.to_string(), format!("{}, a scalar", self.name)))
            }
            (None, _) => {
                let expected = format!("a component of it: {0}.x, {0}.y or {0}.z", self.name);
                Err(SweepError::value(&self.key, format!("{}, a vector", self.name), expected))
            }
        }
    }
}

impl Unknown {
    fn read(path: &str, value: &Value) -> Result<Self, SweepError> {
        let place = |key: &str| format!("fit.values.\"{path}\"{key}");
        let expected = "{ start = …, min = …, max = … }";
        let Value::Table(table) = value else {
            return Err(SweepError::value(place(""), value.to_string(), expected));
        };
        refuse_unknown(&place("."), table, UNKNOWN_KEYS)?;
        let number = |key: &str| {
            let found = table.get(key).map_or("missing".to_owned(), Value::to_string);
            let number = table.get(key).and_then(as_number).filter(|number| number.is_finite());
            number.ok_or_else(|| SweepError::value(place(&format!(".{key}")), found, "a finite number"))
        };
        let (start, low, high) = (number("start")?, number("min")?, number("max")?);
        if !(low < high && (low..=high).contains(&start)) {
            let found = format!("{start} between {low} and {high}");
            return Err(SweepError::value(place(""), found, "min ≤ start ≤ max, and min < max"));
        }
        let unit = match table.get("unit") {
            None => String::new(),
            Some(Value::String(unit)) => unit.clone(),
            Some(other) => return Err(SweepError::value(place(".unit"), other.to_string(), "a text")),
        };
        Ok(Self { path: path.to_owned(), unit, start, bounds: [low, high] })
    }

    fn is_logarithmic(&self) -> bool {
        self.bounds[0] > 0.0
    }

    /// Where a value is between its bounds, from 0 to 1.
    fn place(&self, value: f64) -> f64 {
        let [low, high] = self.bounds;
        if self.is_logarithmic() {
            (value / low).ln() / (high / low).ln()
        } else {
            (value - low) / (high - low)
        }
    }

    fn value(&self, place: f64) -> f64 {
        let [low, high] = self.bounds;
        // to the bit, so that a value at a bound is known as such, and the first run is the one that was asked for
        if place >= 1.0 {
            return high;
        }
        if place == self.place(self.start) {
            return self.start;
        }
        let value =
            if self.is_logarithmic() { low * (high / low).powf(place) } else { low + place * (high - low) };
        value.clamp(low, high)
    }

    /// `dvalue/dplace`
    fn rate(&self, place: f64) -> f64 {
        let [low, high] = self.bounds;
        if self.is_logarithmic() { self.value(place) * (high / low).ln() } else { high - low }
    }

    /// As `souple run --set` takes it.
    pub fn setting(&self, value: f64) -> String {
        match self.unit.as_str() {
            "" => format!("{}={value:e}", self.path),
            unit => format!("{}=\"{value:e} {unit}\"", self.path),
        }
    }
}

pub(crate) fn as_number(value: &Value) -> Option<f64> {
    match value {
        Value::Integer(number) => Some(*number as f64),
        Value::Float(number) => Some(*number),
        _ => None,
    }
}

/// A number that is read and can be computed with: its square and its cube are numbers still.
pub(crate) fn is_moderate(number: &f64) -> bool {
    number.is_finite() && number.abs() <= MOST
}

/// Numbers of a study, at most.
const MOST: f64 = souple_table::MODERATE;

/// A number in SI units, or a text of one with its unit, which is of the dimension of `unit`.
pub(crate) fn as_quantity(value: &Value, unit: &str) -> Option<f64> {
    match value {
        Value::String(text) => souple_formal::quantity_in(text, unit).ok(),
        _ => as_number(value),
    }
}

pub(crate) fn refuse_unknown(within: &str, table: &Table, known: &[&str]) -> Result<(), SweepError> {
    match table.keys().find(|key| !known.contains(&key.as_str())) {
        None => Ok(()),
        Some(key) => Err(SweepError::value(
            format!("{within}{key}"),
            "unknown",
            format!("one of {}", known.join(", ")),
        )),
    }
}

/// Two columns with commas, in the order of the file; a first line that is no numbers names them.
fn curve(path: &Path, text: &str) -> Result<Vec<[f64; 2]>, SweepError> {
    let mut points: Vec<[f64; 2]> = Vec::new();
    let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    for (place, (number, line)) in lines.enumerate() {
        let cells: Vec<&str> = line.split(',').map(str::trim).collect();
        let numbers: Vec<f64> = cells
            .iter()
            .filter_map(|cell| cell.parse().ok())
            .filter(|number: &f64| number.is_finite())
            .collect();
        match numbers[..] {
            [x, y] if cells.len() == 2 => points.push([x, y]),
            _ if place == 0 && numbers.is_empty() && cells.len() == 2 => {}
            _ => {
                let place = format!("{}, line {}", path.display(), number + 1);
                return Err(SweepError::value(place, line.trim(), "two finite numbers with a comma"));
            }
        }
    }
    if points.is_empty() {
        return Err(SweepError::value(path.display().to_string(), "no points", "lines of two numbers"));
    }
    Ok(points)
}

const ONE_WAY: &str = "places that go one way: of a loop, one of its branches";

fn goes_back([before, after]: [f64; 2]) -> String {
    format!("a curve that goes back from {before:e} to {after:e}")
}

/// Where the abscissas of a curve first go against the way they went, by more than rounding: from where, and to where.
fn first_back(curve: &[[f64; 2]]) -> Option<[f64; 2]> {
    let places = || curve.iter().map(|point| point[0]);
    let (low, high) = (places().fold(f64::INFINITY, f64::min), places().fold(f64::NEG_INFINITY, f64::max));
    let least = BACK * (high - low);
    // the farthest so far on the way, which is known from the first place that is another
    let (mut farthest, mut way) = (curve.first()?[0], 0.0);
    for place in places() {
        let on = place - farthest;
        if way == 0.0 && on.abs() > least {
            way = on.signum();
        }
        if on * way < -least {
            return Some([farthest, place]);
        }
        if on * way > 0.0 {
            farthest = place;
        }
    }
    None
}

/// A sorted curve between its points by straight lines. Beyond its ends it is held for as far as its points are apart there, and then there is nothing.
fn between(curve: &[[f64; 2]], x: f64) -> Option<f64> {
    let after = curve.partition_point(|point| point[0] < x);
    let held = |end: [f64; 2], next: Option<&[f64; 2]>| {
        let apart = next.map_or(0.0, |next| (next[0] - end[0]).abs());
        ((x - end[0]).abs() <= apart).then_some(end[1])
    };
    match (after.checked_sub(1).map(|before| curve[before]), curve.get(after).copied()) {
        (Some([a, from]), Some([b, to])) => Some(from + (to - from) * (x - a) / (b - a)),
        (None, Some(first)) => held(first, curve.get(1)),
        (Some(last), None) => held(last, curve.len().checked_sub(2).map(|before| &curve[before])),
        (None, None) => None,
    }
}

/// What a fit is made with.
pub struct Search<'a> {
    pub study: &'a Study,
    pub fit: &'a Fit,
    /// Runs at once.
    pub count: usize,
    pub stop: &'a Interruption,
}

impl Search<'_> {
    /// What the scene says at the points of the curve, with its values at these places, less what was measured.
    fn residuals(&self, places: &[f64]) -> Result<Answer, SweepError> {
        let unknowns = &self.fit.unknowns;
        let values =
            unknowns.iter().zip(places).map(|(unknown, place)| unknown.setting(unknown.value(*place)));
        let settings: Vec<String> = self.study.settings.iter().cloned().chain(values).collect();
        let refuse = |message: String| SweepError::Scene { run: 0, settings: settings.join(", "), message };
        let scene = souple_scene::read_file(&self.study.scene, &settings)
            .map_err(|found| refuse(found.to_string()))?;
        let options = Options {
            steps: self.study.steps,
            scene_name: self.study.scene.display().to_string(),
            interruption: self.stop.clone(),
            ..Options::default()
        };
        let mut watch =
            |_: &souple_run::Progress| if self.stop.is_wished() { Control::Stop } else { Control::Continue };
        let outcome =
            souple_run::run(scene, &options, &mut watch).map_err(|error| refuse(error.to_string()))?;
        match outcome.report.status {
            Status::Done => {}
            Status::Interrupted => return Ok(Answer::Interrupted),
            Status::Failed => {
                let message = outcome.report.failure.map_or(String::new(), |failure| failure.message());
                let settings = settings.join(", ");
                return Ok(Answer::Failed(SweepError::Failed { settings, message }));
            }
        }
        self.compared(&outcome.traces)
    }

    /// # Errors
    /// A probe is not there.
    fn compared(&self, traces: &[Trace]) -> Result<Answer, SweepError> {
        let fit = self.fit;
        let (times, ordinates) = fit.probe.of(traces)?;
        let abscissas = fit.over.as_ref().map(|over| over.of(traces)).transpose()?;
        let abscissas = abscissas.map_or(times, |(_, values)| values);
        let mut curve: Vec<[f64; 2]> = abscissas.into_iter().zip(ordinates).map(|(x, y)| [x, y]).collect();
        let failed = |key: &str, value: String, expected: &str| {
            Ok(Answer::Failed(SweepError::value(key, value, expected)))
        };
        if let Some([x, y]) = curve.iter().find(|point| !point.iter().all(|number| number.is_finite())) {
            let (wanted, found) = match &fit.over {
                Some(over) if !x.is_finite() => (over, format!("{x} at {} = {y:e}", fit.probe.name)),
                _ => (&fit.probe, format!("{y} at the abscissa {x:e}")),
            };
            return failed(&wanted.key, found, "a probe that has a finite number all along the run");
        }
        if let (Some(over), Some(point)) = (&fit.over, first_back(&curve)) {
            return failed(&over.key, goes_back(point), ONE_WAY);
        }
        curve.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut residuals = Vec::with_capacity(fit.curve.len());
        for [x, measured] in &fit.curve {
            let Some(found) = between(&curve, *x) else {
                let end = |point: Option<&[f64; 2]>| point.map_or(f64::NAN, |point| point[0]);
                let reached = format!(
                    "points from {:e} to {:e}, where the run leads",
                    end(curve.first()),
                    end(curve.last())
                );
                return failed("fit.curve", format!("a curve with a point at {x:e}"), &reached);
            };
            residuals.push(found - measured);
        }
        Ok(Answer::Residuals(residuals))
    }

    /// Looks for the values; `watch(iterations, residual)` is told of each step. `None`: it was interrupted before the first run had ended.
    ///
    /// # Errors
    /// The scene cannot be run with the values of the start, or read with those to try; a probe is not there, has no numbers or no value where the
    /// curve has points; a value changes nothing.
    pub fn run(&self, watch: &mut dyn FnMut(usize, f64)) -> Result<Option<Found>, SweepError> {
        self.look(watch).map_err(|error| self.study.written.placed(error))
    }

    fn look(&self, watch: &mut dyn FnMut(usize, f64)) -> Result<Option<Found>, SweepError> {
        let (fit, unknowns) = (self.fit, &self.fit.unknowns);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(self.count.max(1)).build()?;
        let without_effect = |index: usize| {
            let unknown = &unknowns[index];
            let place = format!("fit.values.\"{}\"", unknown.path);
            let found = format!("a value that changes nothing at {:e}", unknown.start);
            SweepError::value(place, found, format!("one on which `{}` depends", fit.probe.name))
        };
        let problem = Problem {
            start: unknowns.iter().map(|unknown| unknown.place(unknown.start)).collect(),
            tolerance: fit.tolerance,
            iterations: fit.iterations,
            residuals: &|places| self.residuals(places),
            without_effect: &without_effect,
            pool: &pool,
        };
        let Some(found) = problem.solve(watch)? else { return Ok(None) };
        let square = mean_square(&found.residuals);
        let points = fit.curve.len() as f64;
        let mean = fit.curve.iter().map(|[_, y]| y).sum::<f64>() / points;
        let variance = fit.curve.iter().map(|[_, y]| (y - mean).powi(2)).sum::<f64>() / points;
        let Certainty { errors, alike } = certainty(&found);
        let value = |(k, unknown): (usize, &Unknown)| {
            let place = found.places[k];
            (unknown.value(place), errors[k].map(|error| error * unknown.rate(place)))
        };
        let curve = fit.curve.iter().zip(&found.residuals).map(|([x, y], r)| [*x, *y, y + r]).collect();
        Ok(Some(Found {
            values: unknowns.iter().enumerate().map(value).collect(),
            alike,
            residual: square.sqrt(),
            explained: (variance > 0.0).then(|| 1.0 - square / variance),
            iterations: found.iterations,
            runs: found.runs,
            ending: found.ending,
            curve,
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values come back from their places between bounds, on a scale of logarithms and on a plain one.
    #[test]
    fn places_and_values() {
        for bounds in [[1.0, 1e6], [-3.0, 5.0]] {
            let unknown = Unknown { path: "a".to_owned(), unit: String::new(), start: 2.0, bounds };
            assert!((unknown.value(unknown.place(1.5)) - 1.5).abs() < 1e-12);
            assert_eq!([unknown.value(0.0), unknown.value(1.0)], bounds);
            assert_eq!(unknown.value(unknown.place(2.0)), 2.0);
        }
        // 3 (7/3)^1 is no 7 to the bit
        for high in (4..100).map(f64::from) {
            let unknown =
                Unknown { path: "a".to_owned(), unit: String::new(), start: 3.0, bounds: [3.0, high] };
            assert_eq!(unknown.value(1.0), high);
        }
    }

    /// A curve is straight between its points, is held for a period at its ends, and is nothing beyond.
    #[test]
    fn curves_have_ends() {
        let curve = [[0.0, 1.0], [0.5, 2.0], [1.0, 4.0]];
        let at = [-0.6, -0.5, 0.25, 1.0, 1.5, 1.6].map(|x| between(&curve, x));
        assert_eq!(at, [None, Some(1.0), Some(1.5), Some(4.0), Some(4.0), None]);
        assert_eq!(between(&[], 0.0), None);
    }

    /// Loading and unloading is told with the place where it turns; rest at the start and rounding are not.
    #[test]
    fn loops_are_seen() {
        let back = |places: &[f64]| first_back(&places.iter().map(|x| [*x, 0.0]).collect::<Vec<_>>());
        assert_eq!(back(&[0.0, 0.0, 1.0, 2.0, 1.5, 0.0]), Some([2.0, 1.5]));
        assert_eq!(back(&[0.0, -1.0, -2.0, -1.0]), Some([-2.0, -1.0]));
        assert_eq!(back(&[0.0, 1e-12, -1e-12, 1.0, 1.0 - 1e-12, 2.0]), None);
        assert_eq!(back(&[3.0, 2.0, 2.0, 1.0]), None);
    }

    #[test]
    fn faults_are_named() {
        let fit = |text: &str, curve: &str| {
            let table: Table = text.parse().unwrap();
            Fit::read(&table["fit"], Path::new("."), |_| Ok(curve.to_owned()))
                .map(|_| ())
                .unwrap_err()
                .to_string()
        };
        let head = "[fit]\nprobe = \"force\"\ncurve = \"c.csv\"\n";
        for (rest, curve, words) in [
            ("", "1,2\n", "`fit.values` is missing"),
            ("values.k = { start = 1, min = 2, max = 3 }\n", "1,2\n", "min ≤ start ≤ max"),
            ("values.k = { start = 1, min = 0 }\n", "1,2\n", "`fit.values.\"k\".max` is missing"),
            ("values.k = 1\n", "1,2\n", "expected { start"),
            (
                "values.k = { start = 1, min = 0, max = 3, at = 1 }\n",
                "1,2\n",
                "`fit.values.\"k\".at` is unknown",
            ),
            ("values.k = { start = 1, min = 0, max = 3 }\ntolerance = 0\n", "1,2\n", "`fit.tolerance` is 0"),
            ("values.k = { start = 1, min = 0, max = 3 }\ntolerance = inf\n", "1,2\n", "above 0, below 1"),
            (
                "values.k = { start = 1, min = 0, max = 3 }\niterations = 0.5\n",
                "1,2\n",
                "`fit.iterations` is 0.5",
            ),
            (
                "over = \"way\"\nvalues.k = { start = 1, min = 0, max = 3 }\n",
                "1,2\n2,3\n1.5,2\n",
                "`fit.curve` is a curve that goes back from 2e0 to 1.5e0; expected places that go one way",
            ),
            ("values.k = { start = 1, min = 0, max = 3 }\n", "t,y\n1,x\n", "line 2` is 1,x"),
            ("values.k = { start = 1, min = 0, max = 3 }\n", "t,y\ns,N\n1,2\n", "line 2` is s,N"),
            ("values.k = { start = 1, min = 0, max = 3 }\n", "t,y\n", "no points"),
            ("range = 1\n", "1,2\n", "`fit.range` is unknown"),
        ] {
            let message = fit(&format!("{head}{rest}"), curve);
            assert!(message.contains(words), "{rest:?}: {message}");
        }
    }
}
