//! A case: a scene, what is read of it, and what that must be.

use std::time::Instant;

use serde_json::{Value, json};

use crate::reading::Reading;
use crate::refinement::Refinement;
use crate::row::{Problem, Row, RunOfRow};
use crate::runs::{RunKey, Runs};

/// How far a number may be from its reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tolerance {
    /// In the unit of what is read.
    Absolute(f64),
    /// Of the reference.
    Relative(f64),
    /// The reference is the least that is accepted.
    AtLeast,
    /// The reference is the most that is accepted.
    AtMost,
    /// More than the reference is wanted.
    Above,
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
    pub reading: Reading,
    /// Where the case is about the order at which errors fall, the runs that they fall over.
    pub refinement: Option<Refinement>,
    /// Of what is read, or of its order.
    pub reference: f64,
    pub tolerance: Tolerance,
    pub source: &'static str,
    /// A setting under which the case fails.
    pub mutation: &'static str,
}

/// The cases of these ids or capabilities; all where none is named.
///
/// # Errors
/// The id that is neither.
pub fn cases(ids: &[String]) -> Result<Vec<&'static Case>, String> {
    let is_known = |id: &String| crate::all().any(|case| case.answers_to(id));
    if let Some(unknown) = ids.iter().find(|id| !is_known(id)) {
        return Err(unknown.clone());
    }
    Ok(crate::all().filter(|case| ids.is_empty() || ids.iter().any(|id| case.answers_to(id))).collect())
}

impl Case {
    fn answers_to(&self, id: &str) -> bool {
        self.id == id || self.capabilities.contains(&id)
    }

    /// Runs the scene and compares.
    pub fn run(&self) -> Row {
        self.run_with(&mut Runs::default(), false)
    }

    /// Runs it with the mutation: the row must fail.
    pub fn run_mutated(&self) -> Row {
        self.run_with(&mut Runs::default(), true)
    }

    /// The same by runs that are there, or are made.
    pub(crate) fn run_with(&self, known: &mut Runs, is_mutated: bool) -> Row {
        let clock = Instant::now();
        let runs = self.runs(known, is_mutated);
        let (measured, unit, runs, problem) = match runs.and_then(|(unit, runs)| {
            let measured = match &self.refinement {
                Some(refinement) => refinement.order_of(&runs)?,
                None => runs[0].value,
            };
            Ok((measured, unit, runs))
        }) {
            Ok((measured, unit, runs)) => (measured, unit, runs, None),
            Err(problem) => (f64::NAN, "", Vec::new(), Some(problem)),
        };
        let pass = self.tolerance.accepts(measured, self.reference);
        // an order has no unit, whatever that of the errors is
        let unit = if self.refinement.is_some() { "" } else { unit };
        Row { case: *self, measured, unit, pass, seconds: clock.elapsed().as_secs_f64(), runs, problem }
    }

    /// Unit and values of the runs; one where nothing is refined.
    fn runs(&self, known: &mut Runs, is_mutated: bool) -> Result<(&'static str, Vec<RunOfRow>), Problem> {
        let mut unit = "";
        let mut runs = Vec::new();
        for (size, settings, command) in self.variants() {
            let (value, unit_of_value) = self
                .reading
                .read(self.key(settings, is_mutated), known)
                .map_err(|problem| Problem { message: format!("{command}: {problem}"), ..problem })?;
            unit = unit_of_value;
            runs.push(RunOfRow { size, value, error: None, command });
        }
        if let Some(refinement) = &self.refinement {
            refinement.set_errors(&mut runs);
        }
        Ok((unit, runs))
    }

    /// What is read with settings.
    fn key(&self, settings: Vec<&'static str>, is_mutated: bool) -> RunKey {
        let more = is_mutated.then_some(self.mutation);
        RunKey {
            scene: self.scene,
            settings: settings.into_iter().chain(more).collect(),
            steps: self.reading.steps(),
        }
    }

    /// Runs that it reads; none where it reads something else.
    pub(crate) fn run_keys(&self, is_mutated: bool) -> Vec<RunKey> {
        if !self.reading.reads_a_run() {
            return Vec::new();
        }
        self.variants().into_iter().map(|(_, settings, _)| self.key(settings, is_mutated)).collect()
    }

    /// Size, settings and command of each run.
    fn variants(&self) -> Vec<(Option<f64>, Vec<&'static str>, String)> {
        let variant = |size: Option<f64>, own: &[&'static str]| {
            let settings: Vec<&str> = self.settings.iter().chain(own).copied().collect();
            let command = self.reading.command(self.scene, &settings);
            (size, settings, command)
        };
        match &self.refinement {
            None => vec![variant(None, &[])],
            Some(refinement) => {
                refinement.runs.iter().map(|run| variant(Some(run.size), run.settings)).collect()
            }
        }
    }

    /// The command lines that give the same numbers.
    pub fn commands(&self) -> Vec<String> {
        self.variants().into_iter().map(|(_, _, command)| command).collect()
    }

    pub fn to_json(&self) -> Value {
        let mut row = json!({
            "id": self.id,
            "capabilities": self.capabilities,
            "what": self.what,
            "scene": self.scene,
            "command": self.commands().join("\n"),
            "probe": self.reading.name(),
            "reference": self.reference,
            "tolerance": self.tolerance.absolute(self.reference),
            "wanted": self.tolerance.relation(),
            "source": self.source,
            "mutation": self.mutation,
        });
        if let Some(refinement) = &self.refinement {
            row["order_of"] = json!(refinement.size_of);
        }
        row
    }
}

impl Tolerance {
    /// How far from the reference what is measured may be, in its unit; nothing where the reference is a bound.
    pub fn absolute(self, reference: f64) -> f64 {
        match self {
            Self::Absolute(bound) => bound,
            Self::Relative(fraction) => fraction * reference.abs(),
            Self::AtLeast | Self::AtMost | Self::Above => 0.0,
        }
    }

    /// What is not a number never does.
    pub fn accepts(self, measured: f64, reference: f64) -> bool {
        match self {
            Self::Absolute(_) | Self::Relative(_) => (measured - reference).abs() <= self.absolute(reference),
            Self::AtLeast => measured >= reference,
            Self::AtMost => measured <= reference,
            Self::Above => measured > reference,
        }
    }

    /// How what is measured stands to the reference, in a word or two.
    pub fn relation(self) -> &'static str {
        match self {
            Self::Absolute(_) | Self::Relative(_) => "near",
            Self::AtLeast => "at least",
            Self::AtMost => "at most",
            Self::Above => "above",
        }
    }
}
