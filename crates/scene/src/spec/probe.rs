//! Probes: what is measured along a run, and what is expected of it.

use std::fmt;

use souple_math::Vec3;
use souple_table::Range;

use super::region::Region;
use crate::diagnostic::{Code, Site};
use crate::document::Content;
use crate::keys::{Key, Keys, Shape};
use crate::measure::Measurement;
use crate::reader::Reader;

/// What a probe measures: name, unit, what it is of, whether it is a vector.
#[derive(Debug)]
pub struct QuantityEntry {
    pub quantity: Quantity,
    pub name: &'static str,
    pub unit: &'static str,
    pub subject: Subject,
    pub is_vector: bool,
    /// How the values of a region become one.
    pub reduction: Reduction,
}

/// What a quantity is measured on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    Points,
    Cells,
    Body,
    World,
}

/// How many values become one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reduction {
    /// Arithmetic over points, by volume over cells.
    Mean,
    Sum,
    Min,
    Max,
}

/// See [`QUANTITIES`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    Displacement,
    Position,
    Velocity,
    Reaction,
    ContactForce,
    KineticEnergy,
    StrainEnergy,
    VonMises,
    Pressure,
    Volume,
    TotalEnergy,
    TotalKineticEnergy,
    Momentum,
    AngularMomentum,
    Time,
}

const fn entry(
    quantity: Quantity,
    name: &'static str,
    unit: &'static str,
    subject: Subject,
) -> QuantityEntry {
    QuantityEntry { quantity, name, unit, subject, is_vector: false, reduction: Reduction::Sum }
}

const fn point_vector(
    quantity: Quantity,
    name: &'static str,
    unit: &'static str,
    mean: bool,
) -> QuantityEntry {
    let reduction = if mean { Reduction::Mean } else { Reduction::Sum };
    QuantityEntry { quantity, name, unit, subject: Subject::Points, is_vector: true, reduction }
}

const fn world_vector(quantity: Quantity, name: &'static str, unit: &'static str) -> QuantityEntry {
    QuantityEntry { is_vector: true, ..entry(quantity, name, unit, Subject::World) }
}

/// All quantities.
pub static QUANTITIES: &[QuantityEntry] = &[
    point_vector(Quantity::Displacement, "displacement", "m", true),
    point_vector(Quantity::Position, "position", "m", true),
    point_vector(Quantity::Velocity, "velocity", "m/s", true),
    // the sum of what holds the points, against all other forces and their inertia
    point_vector(Quantity::Reaction, "reaction", "N", false),
    point_vector(Quantity::ContactForce, "contact_force", "N", false),
    QuantityEntry {
        reduction: Reduction::Max,
        ..entry(Quantity::VonMises, "von_mises", "Pa", Subject::Cells)
    },
    QuantityEntry {
        reduction: Reduction::Mean,
        ..entry(Quantity::Pressure, "pressure", "Pa", Subject::Cells)
    },
    entry(Quantity::StrainEnergy, "strain_energy", "J", Subject::Cells),
    entry(Quantity::Volume, "volume", "m^3", Subject::Cells),
    entry(Quantity::KineticEnergy, "kinetic_energy", "J", Subject::Body),
    entry(Quantity::TotalEnergy, "energy.total", "J", Subject::World),
    entry(Quantity::TotalKineticEnergy, "energy.kinetic", "J", Subject::World),
    world_vector(Quantity::Momentum, "momentum", "kg m/s"),
    world_vector(Quantity::AngularMomentum, "angular_momentum", "kg m^2/s"),
    entry(Quantity::Time, "time", "s", Subject::World),
];

const NAMES: &[&str] = &[
    "displacement",
    "position",
    "velocity",
    "reaction",
    "contact_force",
    "von_mises",
    "pressure",
    "strain_energy",
    "volume",
    "kinetic_energy",
    "energy.total",
    "energy.kinetic",
    "momentum",
    "angular_momentum",
    "time",
];

pub(crate) static PROBE: Keys = Keys::new(
    "probe",
    "a quantity measured at the end of every period",
    &[
        Key::new("quantity", Shape::Choice(NAMES), "what is measured").required(),
        Key::new("body", Shape::Text, "whose; not for quantities of the world"),
        Key::new("region", Shape::Region, "where; the whole body where left out"),
        Key::new("component", Shape::Choice(&["x", "y", "z", "length"]), "one number of a vector"),
        Key::new(
            "reduce",
            Shape::Choice(&["mean", "sum", "min", "max"]),
            "how the values of a region become one",
        ),
        Key::new("contact", Shape::Text, "only the forces of this contact (for `contact_force`)"),
    ],
);

pub(crate) static EXPECT: Keys = Keys::new(
    "expect",
    "what a probe must read; `souple run` fails where it does not",
    &[
        Key::new("probe", Shape::Text, "the probe's name").required(),
        Key::number("time", "s", Range::NOT_NEGATIVE, "when; the end of the run where left out"),
        Key::new("component", Shape::Choice(&["x", "y", "z", "length"]), "one number of a vector"),
        Key::new("value", Shape::NumberOrVector, "what it must be, within the tolerance"),
        Key::number("tolerance", "", Range::NOT_NEGATIVE, "absolute, in the probe's unit"),
        Key::number("relative_tolerance", "", Range::NOT_NEGATIVE, "relative to the value"),
        Key::number("min", "", Range::ANY, "it must not be below"),
        Key::number("max", "", Range::ANY, "it must not be above"),
    ],
);

/// A quantity measured along the run.
#[derive(Clone, Debug)]
pub struct Probe {
    pub name: String,
    pub quantity: &'static QuantityEntry,
    pub body: Option<String>,
    pub region: Option<Region>,
    pub component: Option<Component>,
    pub reduction: Reduction,
    pub contact: Option<String>,
    pub site: Site,
}

/// One number of a vector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Component {
    Axis(usize),
    Length,
}

impl Component {
    pub fn of(self, vector: Vec3) -> f64 {
        match self {
            Self::Axis(axis) => vector[axis],
            Self::Length => vector.length(),
        }
    }

    fn read(reader: &Reader) -> Option<Self> {
        reader.has("component").then(|| match reader.choice("component") {
            "x" => Self::Axis(0),
            "y" => Self::Axis(1),
            "z" => Self::Axis(2),
            _ => Self::Length,
        })
    }
}

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

impl Probe {
    pub(crate) fn read(name: String, reader: &Reader) -> Self {
        let chosen = reader.choice("quantity");
        let quantity = QUANTITIES.iter().find(|entry| entry.name == chosen).unwrap_or(&QUANTITIES[0]);
        let refuse = |key: &str, message: String, expected: &str| {
            reader.log().add(Code::Conflict, &reader.site_of(key), message, expected);
        };
        let is_known = reader.has("quantity");
        if is_known && quantity.subject == Subject::World {
            for key in reader.written(&["body", "region"]) {
                refuse(key, format!("`{}` is of the whole world", quantity.name), "no body and no region");
            }
        } else if is_known && !reader.has("body") {
            refuse(
                "quantity",
                format!("`{}` is of a body, and none is named", quantity.name),
                "body = \"…\"",
            );
        }
        if is_known && !quantity.is_vector && reader.has("component") {
            refuse(
                "component",
                format!("`{}` is a number without components", quantity.name),
                "no component",
            );
        }
        if reader.has("contact") && quantity.quantity != Quantity::ContactForce {
            refuse(
                "contact",
                format!("`{}` is of no contact", quantity.name),
                "quantity = \"contact_force\"",
            );
        }
        let reduction = match reader.has("reduce").then(|| reader.choice("reduce")) {
            Some("mean") => Reduction::Mean,
            Some("sum") => Reduction::Sum,
            Some("min") => Reduction::Min,
            Some(_) => Reduction::Max,
            None => quantity.reduction,
        };
        let component = Component::read(reader);
        if quantity.is_vector && component.is_none() && matches!(reduction, Reduction::Min | Reduction::Max) {
            refuse("reduce", "a vector has no least or greatest".to_owned(), "`mean`, `sum`, or a component");
        }
        Self {
            name,
            quantity,
            body: reader.maybe_text("body"),
            region: Region::read(reader, "region"),
            component,
            reduction,
            contact: reader.maybe_text("contact"),
            site: reader.site(),
        }
    }

    /// Whether a value is a vector of three.
    pub fn gives_vector(&self) -> bool {
        self.quantity.is_vector && self.component.is_none()
    }
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
                format!("one of {}", known.join(", ")),
            );
            return None;
        };
        let component = Component::read(reader);
        let is_vector = probe.gives_vector() && component.is_none();
        if component.is_some() && !probe.gives_vector() {
            let message = format!("probe `{name}` gives a number without components");
            reader.log().add(Code::Conflict, &reader.site_of("component"), message, "no component");
        }
        let bound = Bound::read(reader, probe.quantity.unit, is_vector)?;
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

    fn read(reader: &Reader, unit: &str, is_vector: bool) -> Option<Self> {
        let number = |key: &str, range: Range| {
            let expected = format!("{} [{unit}]", range.describe());
            reader.reading(key).and_then(|value| value.number(unit, range, &expected))
        };
        let refuse = |key: &str, message: &str, expected: &str| {
            reader.log().add(Code::Conflict, &reader.site_of(key), message, expected);
            None
        };
        let has_limits = reader.has("min") || reader.has("max");
        if !reader.has("value") {
            if !has_limits {
                return refuse(
                    "probe",
                    "nothing is expected here",
                    "`value` with a tolerance, `min` or `max`",
                );
            }
            if is_vector {
                return refuse("probe", "a vector has no least or greatest", "a component");
            }
            let min = if reader.has("min") { number("min", Range::ANY)? } else { f64::NEG_INFINITY };
            let max = if reader.has("max") { number("max", Range::ANY)? } else { f64::INFINITY };
            return Some(Self::Between { min, max });
        }
        if has_limits {
            return refuse(
                "value",
                "a value and limits at once",
                "`value` with a tolerance, or `min` and `max`",
            );
        }
        let reading = reader.reading("value")?;
        let (value, vector) = match (&reading.node.content, is_vector) {
            (Content::List(_), true) => {
                (f64::NAN, Some(reading.vector(unit, Range::ANY, &format!("three finite numbers [{unit}]"))?))
            }
            (Content::List(_), false) => return refuse("value", "the probe gives one number", "one number"),
            (_, true) => return refuse("value", "the probe gives a vector", "three numbers, or a component"),
            (_, false) => (number("value", Range::ANY)?, None),
        };
        let size = vector.map_or(value.abs(), |vector| vector.length());
        let tolerance = match (reader.has("tolerance"), reader.has("relative_tolerance")) {
            (true, false) => number("tolerance", Range::NOT_NEGATIVE)?,
            (false, true) => reader.maybe_number("relative_tolerance")? * size,
            _ => {
                return refuse(
                    "value",
                    "how close the value must be is not said, or twice",
                    "`tolerance` or `relative_tolerance`",
                );
            }
        };
        Some(match vector {
            Some(value) => Self::NearVector { value, tolerance },
            None => Self::Near { value, tolerance },
        })
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

    /// The choices of the key `quantity` are the names of the table.
    #[test]
    fn quantities_can_be_chosen() {
        let names: Vec<_> = QUANTITIES.iter().map(|entry| entry.name).collect();
        assert_eq!(names, NAMES);
    }
}
