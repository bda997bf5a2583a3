//! What a scene says must be observed, held against what was.

use serde_json::{Value, json};
use souple_math::Vec3;
use souple_scene::Measurement;
use souple_scene::spec::expect::Expect;
use souple_scene::spec::probe::Component;

use crate::Trace;
use crate::report::{Status, numbers_to_json};

/// How an expectation fared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finding {
    Holds,
    Fails,
    /// The run did not pass its moment.
    NotJudged,
}

impl Finding {
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::Fails => "fails",
            Self::NotJudged => "not judged",
        }
    }
}

/// One `expect` of a scene and how it fared.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    pub finding: Finding,
    /// What is expected, in words.
    pub text: String,
    /// What was measured, in `unit`; `None` where it was not judged.
    pub value: Option<Vec<f64>>,
    pub unit: &'static str,
    /// Why it was not judged.
    pub why: Option<String>,
}

/// The stretch of time that a run covers.
#[derive(Clone, Copy, Debug)]
pub struct Span {
    /// Where the scene itself ends [s]: the moment of an expectation without a time, also in a longer run.
    pub scene_end: f64,
    /// [s]
    pub period: f64,
    pub status: Status,
    /// The first and the last time measured [s].
    pub measured: (f64, f64),
}

impl Verdict {
    pub fn of(expect: &Expect, traces: &[Trace], span: &Span) -> Self {
        let moment = expect.time.unwrap_or(span.scene_end);
        let trace = traces.iter().find(|trace| trace.name == expect.probe);
        let unit = trace.map_or("", |trace| trace.unit);
        let component = match expect.component {
            Some(Component::Axis(axis)) => [".x", ".y", ".z"][axis],
            Some(Component::Length) => ".length",
            None => "",
        };
        let mut text = format!("{}{component} at {moment} s: {} {unit}", expect.probe, expect.bound);
        let not_judged = |why: String| Self {
            finding: Finding::NotJudged,
            text: text.clone(),
            value: None,
            unit,
            why: Some(why),
        };
        // a moment belongs to the nearest step
        let slack = 0.5 * span.period * (1.0 + 1e-9);
        let (first, last) = span.measured;
        if moment > last + slack {
            let how = match span.status {
                Status::Done => "ended",
                Status::Interrupted => "was interrupted",
                Status::Failed => "failed",
            };
            return not_judged(format!("the run {how} at {last} s"));
        }
        if moment < first - slack {
            return not_judged(format!("the run began at {first} s"));
        }
        let Some((time, value)) = trace.and_then(|trace| trace.at(moment)) else {
            return not_judged(format!("probe `{}` has no value", expect.probe));
        };
        let measured = match *value {
            [x, y, z] => Measurement::Vector(Vec3::new(x, y, z)),
            [number, ..] => Measurement::Number(number),
            [] => Measurement::Number(f64::NAN),
        };
        if (time - moment).abs() > 1e-6 * span.period {
            text += &format!(" (of the step at {time} s, the nearest)");
        }
        let finding = if expect.accepts(measured) { Finding::Holds } else { Finding::Fails };
        Self { finding, text, value: Some(expect.part_of(measured).numbers()), unit, why: None }
    }

    /// In words: what was expected, and what was measured or why nothing was.
    pub fn message(&self) -> String {
        match (&self.value, &self.why) {
            (Some(value), _) => {
                let value = match &value[..] {
                    [number] => number.to_string(),
                    several => format!("{several:?}"),
                };
                format!("{}; measured {value} {}", self.text, self.unit)
            }
            (None, why) => format!("{}; not judged: {}", self.text, why.as_deref().unwrap_or_default()),
        }
    }

    pub fn to_json(&self) -> Value {
        json!({
            "text": self.text,
            "status": self.finding.as_str(),
            "value": self.value.as_deref().map(numbers_to_json),
            "unit": self.unit,
            "reason": self.why,
        })
    }
}

/// All findings on one line: `5 of 6 hold, 1 not judged: the run ended at 0.2 s`.
pub fn summary(verdicts: &[Verdict]) -> String {
    let count = |finding: Finding| verdicts.iter().filter(|verdict| verdict.finding == finding).count();
    let mut text = format!("{} of {} hold", count(Finding::Holds), verdicts.len());
    if count(Finding::Fails) > 0 {
        text += &format!(", {} do not", count(Finding::Fails));
    }
    if count(Finding::NotJudged) > 0 {
        let mut reasons: Vec<&str> = verdicts.iter().filter_map(|verdict| verdict.why.as_deref()).collect();
        reasons.dedup();
        text += &format!(", {} not judged: {}", count(Finding::NotJudged), reasons.join("; "));
    }
    text
}
