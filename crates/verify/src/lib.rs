//! Validation cases and benchmarks over committed scenes.
//!
//! A [`Case`] names a scene, settings and a probe: `souple run SCENE --set …` gives the same number without this
//! crate. Each case carries a mutation, a setting that makes it fail, so that it is known to see something.

pub mod bench;
mod cases;
pub mod scenes;

use std::fmt;
use std::path::Path;
use std::time::Instant;

use serde_json::{Value, json};
use souple_run::{Control, Options, Status};

pub use cases::CASES;

/// How far a number may be from its reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tolerance {
    /// In the probe's unit.
    Absolute(f64),
    /// Of the reference.
    Relative(f64),
}

/// A number that a scene must give.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    pub id: &'static str,
    /// Capability ids of the specifications that it bears witness to.
    pub capabilities: &'static [&'static str],
    pub what: &'static str,
    /// Folder in `scenes/`.
    pub scene: &'static str,
    /// `path=value`, as `souple run --set` takes them.
    pub settings: &'static [&'static str],
    /// World periods to step; the scene's duration where `None`.
    pub steps: Option<u64>,
    pub probe: &'static str,
    /// Component of a vector.
    pub component: Option<usize>,
    pub reference: f64,
    pub tolerance: Tolerance,
    pub source: &'static str,
    /// A setting under which the case fails.
    pub mutation: &'static str,
}

/// What a case gave.
#[derive(Clone, Debug)]
pub struct Row {
    pub case: Case,
    pub measured: f64,
    pub unit: String,
    pub pass: bool,
    pub seconds: f64,
    /// Why there is no number.
    pub problem: Option<String>,
}

/// The cases of these ids or capabilities; all where none is named.
///
/// # Errors
/// The id that is neither.
pub fn cases(ids: &[String]) -> Result<Vec<&'static Case>, String> {
    let is_known = |id: &String| CASES.iter().any(|case| case.answers_to(id));
    if let Some(unknown) = ids.iter().find(|id| !is_known(id)) {
        return Err(unknown.clone());
    }
    Ok(CASES.iter().filter(|case| ids.is_empty() || ids.iter().any(|id| case.answers_to(id))).collect())
}

impl Case {
    fn answers_to(&self, id: &str) -> bool {
        self.id == id || self.capabilities.contains(&id)
    }

    /// Runs the scene and compares.
    pub fn run(&self) -> Row {
        self.run_with(&[])
    }

    /// Runs it with the mutation: the row must fail.
    pub fn run_mutated(&self) -> Row {
        self.run_with(&[self.mutation])
    }

    fn run_with(&self, more: &[&str]) -> Row {
        let clock = Instant::now();
        let measured = self.measure(more);
        let seconds = clock.elapsed().as_secs_f64();
        let (measured, unit, problem) = match measured {
            Ok((number, unit)) => (number, unit, None),
            Err(problem) => (f64::NAN, String::new(), Some(problem)),
        };
        let pass = (measured - self.reference).abs() <= self.tolerance.absolute(self.reference);
        Row { case: *self, measured, unit, pass, seconds, problem }
    }

    fn measure(&self, more: &[&str]) -> Result<(f64, String), String> {
        let text = scenes::text(self.scene).ok_or_else(|| format!("there is no scene `{}`", self.scene))?;
        let settings: Vec<String> = self.settings.iter().chain(more).map(|text| (*text).to_owned()).collect();
        let scene = souple_scene::read_text(self.scene, text, Path::new("."), &settings)
            .map_err(|diagnostics| diagnostics.to_string())?;
        let options = Options { steps: self.steps, scene_name: self.scene.to_owned(), ..Options::default() };
        let outcome = souple_run::run(scene, &options, &mut |_| Control::Continue)
            .map_err(|error| error.to_string())?;
        if outcome.report.status != Status::Done {
            return Err(outcome.report.warnings.join("; "));
        }
        let trace = outcome.traces.iter().find(|trace| trace.name == self.probe);
        let trace = trace.ok_or_else(|| format!("the scene has no probe `{}`", self.probe))?;
        let value = trace.last().and_then(|value| value.get(self.component.unwrap_or(0))).copied();
        Ok((value.ok_or("the probe has no such component")?, trace.unit.to_owned()))
    }

    /// The command line that gives the same number.
    pub fn command(&self) -> String {
        let mut command = format!("souple run scenes/{}", self.scene);
        for setting in self.settings {
            command += &format!(" --set '{setting}'");
        }
        if let Some(steps) = self.steps {
            command += &format!(" --steps {steps}");
        }
        command
    }

    pub fn to_json(&self) -> Value {
        json!({
            "id": self.id,
            "capabilities": self.capabilities,
            "what": self.what,
            "scene": self.scene,
            "command": self.command(),
            "probe": self.probe,
            "reference": self.reference,
            "tolerance": self.tolerance.absolute(self.reference),
            "source": self.source,
        })
    }
}

impl Tolerance {
    fn absolute(self, reference: f64) -> f64 {
        match self {
            Self::Absolute(bound) => bound,
            Self::Relative(fraction) => fraction * reference.abs(),
        }
    }
}

impl Row {
    pub fn to_json(&self) -> Value {
        let mut row = self.case.to_json();
        row["measured"] = json!(self.measured);
        row["unit"] = json!(self.unit);
        row["pass"] = json!(self.pass);
        row["seconds"] = json!(self.seconds);
        if let Some(problem) = &self.problem {
            row["problem"] = json!(problem);
        }
        row
    }
}

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verdict = if self.pass { "ok  " } else { "FAIL" };
        write!(f, "{verdict} {:34} ", self.case.id)?;
        match &self.problem {
            Some(problem) => write!(f, "{problem}"),
            None => write!(
                f,
                "{:.10e} for {:.10e} {} (off by {:.1e}, {:.1e} allowed) in {:.2} s",
                self.measured,
                self.case.reference,
                self.unit,
                (self.measured - self.case.reference).abs(),
                self.case.tolerance.absolute(self.case.reference),
                self.seconds
            ),
        }
    }
}
