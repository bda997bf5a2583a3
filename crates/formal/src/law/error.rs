//! Why a text is no law.

use std::fmt;

use crate::error::did_you_mean;
use crate::graph::Shape;
use crate::law::Word;
use crate::{Dimension, ParseError, Span};

/// What is wrong with a law, and where.
#[derive(Clone, Debug, PartialEq)]
pub struct LawError {
    /// `energy`, or the name of the definition or parameter.
    pub part: String,
    /// The place in the text of that part.
    pub span: Option<Span>,
    pub problem: Box<LawProblem>,
}

/// What is wrong with a law.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LawProblem {
    #[error("{}", .0.without_place())]
    Syntax(#[from] ParseError),
    #[error("`{read}` is no sign of this language; `{meant}` is written `{written_here}`")]
    SignOfBooks { read: &'static str, meant: &'static str, written_here: &'static str },
    #[error("a law of {nodes} parts is too large; at most {limit} are accepted")]
    TooLarge { nodes: usize, limit: usize },
    #[error(
        "the derivatives of a law with this part, which is made of {parts}, are too long: \
         more than {limit} operands; a shorter sum or product is accepted"
    )]
    LongDerivatives { parts: usize, limit: usize },
    #[error("there is no `{name}`{}; there are the parameters and definitions of this law{own}, and {}{}", did_you_mean(.nearest), Word::list(), of_direction(.name, *.shape))]
    UnknownName {
        name: String,
        nearest: Option<String>,
        own: String,
        /// What is wanted where it stands: a vector for a direction, else a number.
        shape: Shape,
    },
    #[error("there is no function `{name}`{}; there are {}", or_product(.name, .nearest), .known.join(", "))]
    UnknownFunction { name: String, nearest: Option<String>, known: Vec<&'static str> },
    #[error("`{name}` is said to vary, but is not in the formula{}; in it are {}", did_you_mean(.nearest), .known.join(", "))]
    NotInFormula { name: String, nearest: Option<String>, known: Vec<String> },
    #[error("`{name}` has a meaning in every law ({meaning}); choose another name")]
    ReservedName { name: String, meaning: String },
    #[error(
        "`{name}` is no name; a letter from a to z or A to Z followed by such letters, digits and `_` is accepted"
    )]
    BadName { name: String },
    #[error("`{name}` is given twice")]
    GivenTwice { name: String },
    #[error("the definitions need each other: {}; none of them can be computed first", .cycle.join(" -> "))]
    Recursion { cycle: Vec<String> },
    #[error("this is {found}, where {wanted} is wanted")]
    WrongShape { found: String, wanted: String },
    #[error("`{name}` was given {found} argument(s); write `{usage}`")]
    WrongArgumentCount { name: String, found: usize, usage: String },
    #[error("{0}")]
    WrongUnit(Box<UnitClash>),
    #[error("the parameter must be a finite number or a direction [x, y, z] that is not zero")]
    BadParameter,
    #[error("at rest (F = I) this has no finite value: {reason}")]
    NoValueAtRest { reason: String },
    #[error(
        "at rest (F = I) this has a corner, where the energy, the stress or the stiffness jumps or rises without bound, or its derivatives there are found by dividing zero by zero; a smooth form such as a square is accepted"
    )]
    CornerAtRest,
    #[error(
        "at rest (F = I) the stress is {stress}, and must be zero: terms that grow linearly must balance, as `- mu*log(J)` balances `mu/2*(I1 - 3)`"
    )]
    StressAtRest { stress: String },
    #[error(
        "a rotation changes the energy from {before:.6e} to {after:.6e}: write it with C, E, J or invariants of C, or with `eps` where small strain is meant"
    )]
    NotObjective { before: f64, after: f64 },
    #[error(
        "the energy changes with the order of the principal stretches l1, l2, l3; write the same for each of them, as in `l1^a + l2^a + l3^a`"
    )]
    OrderOfStretches,
    #[error("the energy does not change with the deformation: no F, C, E, eps, J, I1, … is in it")]
    NoDeformation,
    #[error("no deformation that was tried, small or large, makes a stress: {}; a body of this law would resist nothing", of_zeros(.zeros))]
    NoStress { zeros: Vec<String> },
}

fn of_direction(name: &str, shape: Shape) -> String {
    match shape {
        Shape::Vector => format!("; a direction is given among the parameters, as `{name} = [1, 0, 0]`"),
        _ => String::new(),
    }
}

fn or_product(name: &str, nearest: &Option<String>) -> String {
    if nearest.is_some() { did_you_mean(nearest) } else { format!("; for a product write `{name} * (…)`") }
}

/// Why all is zero.
fn of_zeros(zeros: &[String]) -> String {
    match zeros {
        [] => "its terms cancel, or are multiplied by zero".to_owned(),
        [one] => format!("the parameter `{one}` is zero"),
        several => format!("the parameters `{}` are zero", several.join("`, `")),
    }
}

/// Units where others are wanted.
#[derive(Clone, Debug, PartialEq)]
pub struct UnitClash {
    /// What has them, as written.
    pub written: String,
    /// Powers of kilogram, metre and second.
    pub found: [f64; 3],
    pub wanted: WantedUnits,
    /// The parameters in it, also by way of definitions, with the dimensions they were given; one of them is to blame.
    pub parameters: Vec<(String, Option<Dimension>)>,
}

/// Which units are wanted, and why.
#[derive(Clone, Debug, PartialEq)]
pub enum WantedUnits {
    /// Of a term of the energy.
    EnergyDensity,
    /// Of an argument or an exponent.
    Pure,
    /// Of the base of a power whose exponent is no plain number.
    PureBase,
    /// The same as those of what stands at that place, as written there.
    Like { units: [f64; 3], beside: Span, written: String },
}

impl UnitClash {
    /// In a box: errors are small beside what is read.
    pub(super) fn boxed(found: [f64; 3], wanted: WantedUnits) -> Box<Self> {
        Box::new(Self { written: String::new(), found, wanted, parameters: Vec::new() })
    }
}

/// Energy per volume of the rest shape.
pub(super) const ENERGY_DENSITY: Dimension = Dimension::new(1, -1, -2);

pub(super) fn describe_units(units: [f64; 3]) -> String {
    if units.iter().all(|power| power.fract() == 0.0 && power.abs() < 100.0) {
        return Dimension::new(units[0] as i8, units[1] as i8, units[2] as i8).describe();
    }
    let [mass, length, time] = units;
    format!("a quantity in [kg^{mass} m^{length} s^{time}]")
}

/// Parameters that are named in a message about units.
const PARAMETERS_TOLD: usize = 4;

impl fmt::Display for UnitClash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` is {}, where ", self.written, describe_units(self.found))?;
        match &self.wanted {
            WantedUnits::EnergyDensity => {
                write!(f, "an energy per volume is wanted, which is {}", ENERGY_DENSITY.describe())?;
            }
            WantedUnits::Pure => f.write_str("a pure number is wanted")?,
            WantedUnits::PureBase => {
                f.write_str("a pure number is wanted under an exponent that is not a plain number")?;
            }
            WantedUnits::Like { units, written, .. } => {
                write!(f, "{} is wanted, as `{written}` beside it is", describe_units(*units))?;
            }
        }
        let of = |dimension: Option<Dimension>| match dimension {
            None => "given without unit".to_owned(),
            Some(dimension) => dimension.describe(),
        };
        match self.parameters.as_slice() {
            [] => f.write_str("; no parameter is in it"),
            [(name, dimension)] => write!(f, "; the parameter in it, `{name}`, is {}", of(*dimension)),
            several => {
                let told = several.iter().take(PARAMETERS_TOLD);
                let told: Vec<String> =
                    told.map(|(name, dimension)| format!("`{name}` is {}", of(*dimension))).collect();
                let more = if several.len() > told.len() { ", …" } else { "" };
                write!(f, "; of the parameters in it {}{more}", told.join(", "))
            }
        }
    }
}

impl fmt::Display for LawError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.part, self.problem)
    }
}

impl std::error::Error for LawError {}

impl LawError {
    pub(super) fn new(part: impl Into<String>, span: Option<Span>, problem: LawProblem) -> Self {
        Self { part: part.into(), span, problem: Box::new(problem) }
    }

    /// The message, and under it, set in, the place in `text`, which is the text of [`Self::part`].
    pub fn explained(&self, text: &str) -> String {
        match self.span {
            Some(span) if !text.is_empty() => {
                format!("{self}\n    {}", span.underline(text).replace('\n', "\n    "))
            }
            _ => self.to_string(),
        }
    }
}
