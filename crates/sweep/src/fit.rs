//! Identification: values of a scene for which a probe follows a curve that was measured.
//!
//! Least squares `Σ r_i²`, `r_i = y(t_i) − m_i`, by Levenberg and Marquardt: `(JᵀJ + λ diag JᵀJ) δ = −Jᵀ r`, where `J` comes of one run more for each value, at once. Values
//! go between their bounds; where the lower is above zero, their logarithms are what steps are made in, so that none is lost among larger ones.
//! The standard error of a value is `√(s² (JᵀJ)⁻¹_kk)`, `s² = Σ r²/(n − k)`.

use std::path::{Path, PathBuf};

use rayon::prelude::*;
use souple_engine::Interruption;
use souple_run::{Control, Options, Status, Trace};
use toml::{Table, Value};

use crate::SweepError;
use crate::study::Study;

/// What is looked for.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The probe that is to follow the curve.
    pub probe: String,
    /// Of a vector, from 0.
    pub component: usize,
    /// The probe that the curve is over; the time where `None`.
    pub over: Option<(String, usize)>,
    /// Points of the curve, by growing abscissa.
    pub curve: Vec<[f64; 2]>,
    pub unknowns: Vec<Unknown>,
    /// Where a step changes no value by more than this share of its range, it ends.
    pub tolerance: f64,
    pub iterations: usize,
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
    /// Values, and their standard errors; not known where points are no more than values, or where a value changes nothing.
    pub values: Vec<(f64, Option<f64>)>,
    /// Root of the mean square of what is left.
    pub residual: f64,
    /// Share of the curve's own variance that is explained.
    pub explained: f64,
    pub iterations: usize,
    pub runs: usize,
    pub has_converged: bool,
    /// Abscissa, measured, found.
    pub curve: Vec<[f64; 3]>,
}

const KEYS: &[&str] = &["probe", "over", "curve", "values", "tolerance", "iterations"];
const UNKNOWN_KEYS: &[&str] = &["start", "min", "max", "unit"];
/// Damping at the start, and the factor by which it falls and grows.
const DAMPING: f64 = 1e-3;
const FACTOR: f64 = 10.0;
/// Change of a value for a slope, as a share of its range: an error of `√ε` of forward differences.
const DIFFERENCE: f64 = 1e-6;

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
        let number = |key: &str, default: f64, expected: &str| match table.get(key).map(as_number) {
            None => Ok(default),
            Some(Some(number)) if number > 0.0 => Ok(number),
            Some(_) => Err(SweepError::value(format!("fit.{key}"), table[key].to_string(), expected)),
        };
        let path: PathBuf = folder.join(text("curve", "a file of two columns with commas")?);
        let curve = curve(&path, &read(&path)?)?;
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
        let (probe, component) =
            probe_of(&text("probe", "a probe of the scene, with .x, .y or .z of a vector")?);
        let over = match table.get("over") {
            None => None,
            Some(_) => Some(probe_of(&text("over", "a probe of the scene")?)),
        };
        let tolerance = number("tolerance", 1e-6, "a number above 0")?;
        let iterations = number("iterations", 50.0, "a number above 0")? as usize;
        Ok(Self { probe, component, over, curve, unknowns, tolerance, iterations })
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

fn as_number(value: &Value) -> Option<f64> {
    match value {
        Value::Integer(number) => Some(*number as f64),
        Value::Float(number) => Some(*number),
        _ => None,
    }
}

fn refuse_unknown(within: &str, table: &Table, known: &[&str]) -> Result<(), SweepError> {
    match table.keys().find(|key| !known.contains(&key.as_str())) {
        None => Ok(()),
        Some(key) => Err(SweepError::value(
            format!("{within}{key}"),
            "unknown",
            format!("one of {}", known.join(", ")),
        )),
    }
}

/// `PROBE`, `PROBE.x`: the probe and its component.
fn probe_of(text: &str) -> (String, usize) {
    for (component, suffix) in [".x", ".y", ".z"].into_iter().enumerate() {
        if let Some(probe) = text.strip_suffix(suffix) {
            return (probe.to_owned(), component);
        }
    }
    (text.to_owned(), 0)
}

/// Two columns with commas; a first line that is no numbers names them.
fn curve(path: &Path, text: &str) -> Result<Vec<[f64; 2]>, SweepError> {
    let mut points: Vec<[f64; 2]> = Vec::new();
    for (number, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let cells: Vec<&str> = line.split(',').map(str::trim).collect();
        let numbers: Vec<f64> = cells
            .iter()
            .filter_map(|cell| cell.parse().ok())
            .filter(|number: &f64| number.is_finite())
            .collect();
        match numbers[..] {
            [x, y] if cells.len() == 2 => points.push([x, y]),
            _ if points.is_empty() && numbers.is_empty() && cells.len() == 2 => {}
            _ => {
                let place = format!("{}, line {}", path.display(), number + 1);
                return Err(SweepError::value(place, line.trim(), "two finite numbers with a comma"));
            }
        }
    }
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    if points.is_empty() {
        return Err(SweepError::value(path.display().to_string(), "no points", "lines of two numbers"));
    }
    Ok(points)
}

/// A curve between its points by straight lines, held at its ends.
fn between(curve: &[[f64; 2]], x: f64) -> f64 {
    let after = curve.partition_point(|point| point[0] < x);
    match (after.checked_sub(1).map(|before| curve[before]), curve.get(after).copied()) {
        (Some([a, from]), Some([b, to])) => from + (to - from) * (x - a) / (b - a),
        (None, Some([_, value])) | (Some([_, value]), None) => value,
        (None, None) => f64::NAN,
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
    /// What the scene says at the points of the curve, with its values at these places.
    fn answer(&self, places: &[f64]) -> Result<Vec<f64>, SweepError> {
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
        if outcome.report.status != Status::Done {
            let why =
                outcome.report.failure.map_or("it was interrupted".to_owned(), |failure| failure.message());
            return Err(refuse(why));
        }
        let column = |(name, component): (&str, usize)| -> Result<Vec<f64>, SweepError> {
            let known =
                || outcome.traces.iter().map(|trace| trace.name.as_str()).collect::<Vec<_>>().join(", ");
            let is_it = |trace: &&Trace| trace.name == name && component < trace.components;
            let found = outcome.traces.iter().find(is_it);
            let trace =
                found.ok_or_else(|| SweepError::value("fit.probe", name, format!("a probe: {}", known())))?;
            Ok(trace.values.iter().skip(component).step_by(trace.components).copied().collect())
        };
        let ordinates = column((&self.fit.probe, self.fit.component))?;
        let abscissas = match &self.fit.over {
            Some((probe, component)) => column((probe, *component))?,
            None => outcome.traces.first().map_or(Vec::new(), |trace| trace.times.clone()),
        };
        let mut curve: Vec<[f64; 2]> = abscissas.into_iter().zip(ordinates).map(|(x, y)| [x, y]).collect();
        curve.sort_by(|a, b| a[0].total_cmp(&b[0]));
        Ok(self.fit.curve.iter().map(|[x, _]| between(&curve, *x)).collect())
    }

    fn residuals(&self, places: &[f64]) -> Result<Vec<f64>, SweepError> {
        let found = self.answer(places)?;
        Ok(found.iter().zip(&self.fit.curve).map(|(found, [_, measured])| found - measured).collect())
    }

    /// Residuals of several places at once.
    fn all(&self, places: &[Vec<f64>]) -> Result<Vec<Vec<f64>>, SweepError> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(self.count.max(1)).build()?;
        pool.install(|| places.par_iter().map(|places| self.residuals(places)).collect())
    }

    /// Looks for the values; `watch(iterations, residual)` is told of each step.
    ///
    /// # Errors
    /// A scene with the values to try cannot be run, a probe is not there.
    pub fn run(&self, watch: &mut dyn FnMut(usize, f64)) -> Result<Found, SweepError> {
        let (unknowns, points) = (&self.fit.unknowns, self.fit.curve.len());
        let mut at: Vec<f64> = unknowns.iter().map(|unknown| unknown.place(unknown.start)).collect();
        let mut residuals = self.residuals(&at)?;
        let (mut damping, mut runs, mut iterations, mut has_converged) = (DAMPING, 1, 0, false);
        let mut jacobian = vec![Vec::new(); at.len()];
        let mean_square = |residuals: &[f64]| residuals.iter().map(|r| r * r).sum::<f64>() / points as f64;
        while !has_converged && iterations < self.fit.iterations && !self.stop.is_wished() {
            iterations += 1;
            // inwards at the upper bound
            let steps: Vec<f64> =
                at.iter().map(|place| if *place > 0.5 { -DIFFERENCE } else { DIFFERENCE }).collect();
            let moved = |k: usize| {
                let mut moved = at.clone();
                moved[k] += steps[k];
                moved
            };
            let beside = self.all(&(0..at.len()).map(moved).collect::<Vec<_>>())?;
            runs += at.len();
            for (column, (beside, step)) in jacobian.iter_mut().zip(beside.iter().zip(&steps)) {
                *column = beside.iter().zip(&residuals).map(|(b, r)| (b - r) / step).collect();
            }
            let before = mean_square(&residuals);
            loop {
                let step = damped_step(&jacobian, &residuals, damping);
                let next: Vec<f64> =
                    at.iter().zip(&step).map(|(place, step)| (place + step).clamp(0.0, 1.0)).collect();
                let change = at.iter().zip(&next).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                has_converged = change <= self.fit.tolerance;
                if has_converged {
                    break;
                }
                let tried = self.residuals(&next)?;
                runs += 1;
                if mean_square(&tried) < before {
                    (at, residuals) = (next, tried);
                    damping = (damping / FACTOR).max(f64::EPSILON);
                    break;
                }
                damping *= FACTOR;
            }
            watch(iterations, mean_square(&residuals).sqrt());
        }
        let square = mean_square(&residuals);
        let mean = self.fit.curve.iter().map(|[_, y]| y).sum::<f64>() / points as f64;
        let variance = self.fit.curve.iter().map(|[_, y]| (y - mean).powi(2)).sum::<f64>() / points as f64;
        let errors = standard_errors(&jacobian, square * points as f64, points);
        let value = |(k, unknown): (usize, &Unknown)| {
            (unknown.value(at[k]), errors[k].map(|error| error * unknown.rate(at[k])))
        };
        let curve = self.fit.curve.iter().zip(&residuals).map(|([x, y], r)| [*x, *y, y + r]).collect();
        Ok(Found {
            values: unknowns.iter().enumerate().map(value).collect(),
            residual: square.sqrt(),
            explained: 1.0 - square / variance,
            iterations,
            runs,
            has_converged,
            curve,
        })
    }
}

/// `JᵀJ`
fn normal(jacobian: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum();
    jacobian.iter().map(|a| jacobian.iter().map(|b| dot(a, b)).collect()).collect()
}

/// `(JᵀJ + λ diag JᵀJ) δ = −Jᵀ r`; a value that changes nothing stays.
fn damped_step(jacobian: &[Vec<f64>], residuals: &[f64], damping: f64) -> Vec<f64> {
    let mut matrix = normal(jacobian);
    let right = jacobian.iter().map(|column| -column.iter().zip(residuals).map(|(j, r)| j * r).sum::<f64>());
    for (k, row) in matrix.iter_mut().enumerate() {
        row[k] = if row[k] > 0.0 { row[k] * (1.0 + damping) } else { 1.0 };
    }
    solve(matrix, right.collect()).unwrap_or_else(|| vec![0.0; jacobian.len()])
}

fn standard_errors(jacobian: &[Vec<f64>], square_sum: f64, points: usize) -> Vec<Option<f64>> {
    let count = jacobian.len();
    let freedom = points.saturating_sub(count);
    let of = |k: usize| {
        let unit = (0..count).map(|i| f64::from(u8::from(i == k))).collect();
        let column = solve(normal(jacobian), unit)?;
        (freedom > 0 && column[k] > 0.0).then(|| (square_sum / freedom as f64 * column[k]).sqrt())
    };
    (0..count).map(of).collect()
}

/// Gaussian elimination with pivots; `None` where the matrix is singular.
fn solve(mut matrix: Vec<Vec<f64>>, mut right: Vec<f64>) -> Option<Vec<f64>> {
    let count = right.len();
    for k in 0..count {
        let pivot = (k..count).max_by(|a, b| matrix[*a][k].abs().total_cmp(&matrix[*b][k].abs()))?;
        matrix.swap(k, pivot);
        right.swap(k, pivot);
        if !(matrix[k][k].abs() > 0.0 && matrix[k][k].is_finite()) {
            return None;
        }
        for i in k + 1..count {
            let factor = matrix[i][k] / matrix[k][k];
            for j in k..count {
                matrix[i][j] -= factor * matrix[k][j];
            }
            right[i] -= factor * right[k];
        }
    }
    for k in (0..count).rev() {
        let above: f64 = (k + 1..count).map(|j| matrix[k][j] * right[j]).sum();
        right[k] = (right[k] - above) / matrix[k][k];
    }
    Some(right)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Elimination exchanges rows where a pivot is nothing, and says where there is no answer.
    #[test]
    fn systems_are_solved() {
        let found = solve(vec![vec![0.0, 2.0], vec![4.0, 1.0]], vec![6.0, 11.0]).unwrap();
        assert!((found[0] - 2.0).abs() < 1e-15 && (found[1] - 3.0).abs() < 1e-15, "{found:?}");
        assert!(solve(vec![vec![1.0, 2.0], vec![2.0, 4.0]], vec![1.0, 1.0]).is_none());
    }

    /// Values come back from their places between bounds, on a scale of logarithms and on a plain one.
    #[test]
    fn places_and_values() {
        for bounds in [[1.0, 1e6], [-3.0, 5.0]] {
            let unknown = Unknown { path: "a".to_owned(), unit: String::new(), start: 2.0, bounds };
            assert!((unknown.value(unknown.place(2.0)) - 2.0).abs() < 1e-12);
            assert_eq!([unknown.value(0.0), unknown.value(1.0)], bounds);
        }
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
            ("values.k = { start = 1, min = 0, max = 3 }\n", "t,y\n1,x\n", "line 2` is 1,x"),
            ("values.k = { start = 1, min = 0, max = 3 }\n", "t,y\n", "no points"),
            ("range = 1\n", "1,2\n", "`fit.range` is unknown"),
        ] {
            let message = fit(&format!("{head}{rest}"), curve);
            assert!(message.contains(words), "{rest:?}: {message}");
        }
    }
}
