//! What a scene says must be observed, held against what was.

use souple_scene::spec::probe::{Bound, Expect};

use crate::Trace;

/// One `expect` line and how it fared.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    pub pass: bool,
    /// In words: what was measured, what was expected.
    pub message: String,
}

impl Verdict {
    /// The verdict of one line; `None` where a run that was cut short, or begun late, did not pass its moment.
    ///
    /// `end` [s] is where the scene itself ends: the moment of a line without a time, also in a longer run.
    pub fn of(expect: &Expect, traces: &[Trace], end: f64, period: f64) -> Option<Self> {
        let moment = expect.time.unwrap_or(end);
        let (first, last) =
            traces.first().and_then(|trace| Some((*trace.times.first()?, *trace.times.last()?)))?;
        // a scene ends at the step nearest to its end; a line beyond it is judged there, as it never comes
        let slack = 0.5 * period * (1.0 + 1e-9);
        let is_passed = first - slack <= moment && moment.min(end) <= last + slack;
        is_passed.then(|| Self::at(expect, traces, moment))
    }

    fn at(expect: &Expect, traces: &[Trace], moment: f64) -> Self {
        let Some(trace) = traces.iter().find(|trace| trace.name == expect.probe) else {
            return Self { pass: false, message: format!("probe `{}` was not measured", expect.probe) };
        };
        let Some(value) = trace.at(moment) else {
            return Self { pass: false, message: format!("probe `{}` has no value", expect.probe) };
        };
        let number = match (expect.component, value) {
            (Some(component), [x, y, z]) => component.of(souple_math::Vec3::new(*x, *y, *z)),
            (_, [single]) => *single,
            (None, _) => value.iter().map(|c| c * c).sum::<f64>().sqrt(),
            (Some(_), _) => f64::NAN,
        };
        let (pass, expected) = match &expect.bound {
            Bound::Near { value, tolerance } => {
                ((number - value).abs() <= *tolerance, format!("{value} within {tolerance}"))
            }
            Bound::NearVector { value: wanted, tolerance } => {
                let distance =
                    value.iter().zip(wanted.to_array()).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
                (distance <= *tolerance, format!("{:?} within {tolerance}", wanted.to_array()))
            }
            Bound::Between { min, max } => {
                ((*min..=*max).contains(&number), format!("between {min} and {max}"))
            }
        };
        let message = format!("{} at {moment} s: {number} {}, expected {expected}", trace.name, trace.unit);
        Self { pass, message }
    }
}
