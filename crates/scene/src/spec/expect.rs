//! What is expected of probes: `souple run` fails where it does not hold.

use std::fmt;

use souple_math::Vec3;
use souple_table::Range;

use super::probe::{COMPONENT, Component, Probe};
use super::quantity::Rank;
use crate::diagnostic::{Code, Site};
use crate::document::Content;
use crate::keys::{Key, Keys, Shape};
use crate::measure::Measurement;
use crate::reader::Reader;

pub(crate) static EXPECT: Keys = Keys::new(
    "expect",
    "what a probe must read; `souple run` fails where it does not",
    &[
        Key::new("probe", Shape::Text, "the probe's name").required(),
        Key::number("time", "s", Range::NOT_NEGATIVE, "when; the end of the run where left out"),
        COMPONENT,
        Key::new("value", Shape::NumberOrVector, "what it must be, within the tolerance"),
        Key::number("tolerance", "", Range::NOT_NEGATIVE, "absolute, in the probe's unit"),
        Key::number("relative_tolerance", "", Range::NOT_NEGATIVE, "relative to the value"),
        Key::number("min", "", Range::ANY, "it must not be below"),
        Key::number("max", "", Range::ANY, "it must not be above"),
    ],
);

/// What a probe must read.
#[derive(Clone, Debug)]
pub struct Expect {
    pub probe: String,
    /// [s]; the end of the run where `None`.
    pub time: Option<f64>,
    pub component: Option<Component>,
    pub bound: Bound,
    pub site: Site,
}

/// The values that are accepted, in the probe's SI unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bound {
    Near { value: f64, tolerance: f64 },
    NearVector { value: Vec3, tolerance: f64 },
    Between { min: f64, max: f64 },
}

impl Expect {
    /// The part of a measurement of its probe that this is about.
    pub fn part_of(&self, measured: Measurement) -> Measurement {
        match (self.component, measured) {
            (Some(component), Measurement::Vector(vector)) => Measurement::Number(component.of(vector)),
            (_, measured) => measured,
        }
    }

    /// Whether a measurement of its probe is accepted.
    pub fn accepts(&self, measured: Measurement) -> bool {
        self.bound.accepts(&self.part_of(measured))
    }

    /// # Returns
    /// `None` where it was refused.
    pub(crate) fn read(reader: &Reader, probes: &[Probe]) -> Option<Self> {
        let name = reader.maybe_text("probe")?;
        let Some(probe) = probes.iter().find(|probe| probe.name == name) else {
            let known: Vec<&str> = probes.iter().map(|probe| probe.name.as_str()).collect();
            let hint = crate::keys::did_you_mean(&name, known.iter().copied());
            let message = format!("there is no probe `{name}`{hint}");
            reader.log().add(
                Code::UnknownName,
                &reader.site_of("probe"),
                message,
                crate::keys::one_of(&known),
            );
            return None;
        };
        let component = Component::read(reader);
        let rank = if component.is_some() { Rank::Number } else { probe.rank() };
        if component.is_some() && probe.rank() == Rank::Number {
            let message = format!("probe `{name}` gives a number without components");
            reader.log().add(Code::Conflict, &reader.site_of("component"), message, "no component");
        }
        let bound = Bound::read(reader, probe.quantity.build.unit, rank)?;
        Some(Self { probe: name, time: reader.maybe_number("time"), component, bound, site: reader.site() })
    }
}

impl Bound {
    /// Whether a measurement is accepted; one that is not finite never is.
    pub fn accepts(&self, measured: &Measurement) -> bool {
        match (*self, *measured) {
            (Self::Near { value, tolerance }, Measurement::Number(number)) => {
                (number - value).abs() <= tolerance
            }
            (Self::NearVector { value, tolerance }, Measurement::Vector(vector)) => {
                (vector - value).length() <= tolerance
            }
            (Self::Between { min, max }, Measurement::Number(number)) => {
                number.is_finite() && number >= min && number <= max
            }
            _ => false,
        }
    }

    /// `rank` is that of the values which the bound is about.
    fn read(reader: &Reader, unit: &str, rank: Rank) -> Option<Self> {
        let has_limits = reader.has("min") || reader.has("max");
        match (reader.has("value"), has_limits) {
            (true, false) => Self::read_value(reader, unit, rank),
            (false, true) => Self::read_limits(reader, unit, rank),
            (false, false) => refuse(
                reader,
                "probe",
                "nothing is expected here",
                "`value` with a tolerance, `min` or `max`",
            ),
            (true, true) => refuse(
                reader,
                "value",
                "a value and limits at once",
                "`value` with a tolerance, or `min` and `max`",
            ),
        }
    }

    fn read_limits(reader: &Reader, unit: &str, rank: Rank) -> Option<Self> {
        if rank == Rank::Vector {
            return refuse(reader, "probe", "a vector has no least or greatest", "a component");
        }
        let limit = |key: &str, open: f64| match reader.has(key) {
            true => number(reader, key, unit, Range::ANY),
            false => Some(open),
        };
        let (min, max) = (limit("min", f64::NEG_INFINITY)?, limit("max", f64::INFINITY)?);
        if min > max {
            let message = format!("nothing is at least {min} and at most {max}");
            return refuse(reader, "min", &message, "`min` below `max`");
        }
        Some(Self::Between { min, max })
    }

    fn read_value(reader: &Reader, unit: &str, rank: Rank) -> Option<Self> {
        let reading = reader.reading("value")?;
        let is_list = matches!(reading.node.content, Content::List(_));
        match (rank, is_list) {
            (Rank::Vector, true) => {
                let value = reading.vector(unit, Range::ANY, &format!("three finite numbers [{unit}]"))?;
                Some(Self::NearVector { value, tolerance: tolerance(reader, unit, value.length())? })
            }
            (Rank::Number, false) => {
                let value = number(reader, "value", unit, Range::ANY)?;
                Some(Self::Near { value, tolerance: tolerance(reader, unit, value.abs())? })
            }
            (Rank::Number, true) => refuse(reader, "value", "the probe gives one number", "one number"),
            (Rank::Vector, false) => {
                refuse(reader, "value", "the probe gives a vector", "three numbers, or a component")
            }
        }
    }
}

fn refuse<T>(reader: &Reader, key: &str, message: &str, expected: &str) -> Option<T> {
    reader.log().add(Code::Conflict, &reader.site_of(key), message, expected);
    None
}

fn number(reader: &Reader, key: &str, unit: &str, range: Range) -> Option<f64> {
    let expected = format!("{} [{unit}]", range.describe());
    reader.reading(key).and_then(|value| value.number(unit, range, &expected))
}

/// How far a measurement may be from a value of this size.
fn tolerance(reader: &Reader, unit: &str, size: f64) -> Option<f64> {
    match (reader.has("tolerance"), reader.has("relative_tolerance")) {
        (true, false) => number(reader, "tolerance", unit, Range::NOT_NEGATIVE),
        (false, true) => Some(reader.maybe_number("relative_tolerance")? * size),
        _ => refuse(
            reader,
            "value",
            "how close the value must be is not said, or twice",
            "`tolerance` or `relative_tolerance`",
        ),
    }
}

impl fmt::Display for Bound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Near { value, tolerance } => write!(f, "{value} ± {tolerance}"),
            Self::NearVector { value, tolerance } => {
                write!(f, "({}, {}, {}) ± {tolerance}", value.x, value.y, value.z)
            }
            Self::Between { min, max } if *max == f64::INFINITY => write!(f, "at least {min}"),
            Self::Between { min, max } if *min == f64::NEG_INFINITY => write!(f, "at most {max}"),
            Self::Between { min, max } => write!(f, "between {min} and {max}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bounds hold at their ends and refuse what is not finite.
    #[test]
    fn bounds_are_closed() {
        let near = Bound::Near { value: 1.0, tolerance: 0.5 };
        assert!(near.accepts(&Measurement::Number(1.5)) && !near.accepts(&Measurement::Number(1.6)));
        let above = Bound::Between { min: 0.0, max: f64::INFINITY };
        assert!(
            above.accepts(&Measurement::Number(0.0)) && !above.accepts(&Measurement::Number(f64::INFINITY))
        );
        assert!(
            !near.accepts(&Measurement::Number(f64::NAN)) && !above.accepts(&Measurement::Number(f64::NAN))
        );
        let vector = Bound::NearVector { value: Vec3::X, tolerance: 1.0 };
        assert!(
            vector.accepts(&Measurement::Vector(Vec3::ZERO)) && !vector.accepts(&Measurement::Number(1.0))
        );
        assert_eq!((above.to_string(), near.to_string()), ("at least 0".to_owned(), "1 ± 0.5".to_owned()));
    }
}
