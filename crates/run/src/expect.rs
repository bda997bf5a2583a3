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
    pub fn of(expect: &Expect, traces: &[Trace]) -> Self {
        let Some(trace) = traces.iter().find(|trace| trace.name == expect.probe) else {
            return Self { pass: false, message: format!("probe `{}` was not measured", expect.probe) };
        };
        let value = match expect.time {
            Some(time) => trace.at(time),
            None => trace.last(),
        };
        let Some(value) = value else {
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
                let distance = value.iter().zip(wanted.to_array()).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
                (distance <= *tolerance, format!("{:?} within {tolerance}", wanted.to_array()))
            }
            Bound::Between { min, max } => ((*min..=*max).contains(&number), format!("between {min} and {max}")),
        };
        let when = expect.time.map_or("at the end".to_owned(), |time| format!("at {time} s"));
        Self { pass, message: format!("{} {when}: {number} {}, expected {expected}", trace.name, trace.unit) }
    }
}
