//! What a thing can be told.

use crate::{Value, readable};

/// One parameter of an entry.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    pub name: &'static str,
    /// One line, with the symbol of the equation where there is one.
    pub summary: &'static str,
    pub kind: Kind,
    /// SI unit of a number or vector (`"Pa"`, `"m/s"`, `""` for a pure number).
    pub unit: &'static str,
    pub range: Range,
    /// The value where none is written; `None`: it must be written.
    pub default: Option<Value<'static>>,
}

/// What kind of value a parameter takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    Number,
    Integer,
    Boolean,
    Vector,
    /// A list of numbers, one at least.
    Numbers,
    /// Free text: a name, a file, a formula; the summary says which.
    Text,
    /// Texts under names of the writer's choice; numbers and directions are kept as they were written.
    Texts,
    Choice(&'static [&'static str]),
}

/// The size of numbers whose squares and cubes are numbers still, at most, in SI units.
pub const MODERATE: f64 = 1e100;

/// The interval a number must lie in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    pub low: f64,
    pub high: f64,
    /// Whether the ends themselves are allowed.
    pub low_included: bool,
    pub high_included: bool,
}

impl Range {
    pub const ANY: Self =
        Self { low: f64::NEG_INFINITY, high: f64::INFINITY, low_included: false, high_included: false };
    pub const POSITIVE: Self = Self { low: 0.0, ..Self::ANY };
    pub const NOT_NEGATIVE: Self = Self { low: 0.0, low_included: true, ..Self::ANY };
    /// Above 0, and not so large that its square or its cube is no number.
    pub const MODERATE: Self = Self { high: MODERATE, high_included: true, ..Self::POSITIVE };

    pub const fn open(low: f64, high: f64) -> Self {
        Self { low, high, low_included: false, high_included: false }
    }

    pub const fn closed(low: f64, high: f64) -> Self {
        Self { low, high, low_included: true, high_included: true }
    }

    pub const fn at_least(low: f64) -> Self {
        Self { low, low_included: true, ..Self::ANY }
    }

    pub fn contains(&self, number: f64) -> bool {
        let above = number > self.low || (self.low_included && number == self.low);
        let below = number < self.high || (self.high_included && number == self.high);
        number.is_finite() && above && below
    }

    /// In words: `above 0`, `between 0 and 0.5, ends excluded`.
    pub fn describe(&self) -> String {
        let are_finite = (self.low.is_finite(), self.high.is_finite());
        let [low, high] = [self.low, self.high].map(readable);
        match are_finite {
            (false, false) => "a finite number".to_owned(),
            (true, false) if self.low_included => format!("a number of at least {low}"),
            (true, false) => format!("a number above {low}"),
            (false, true) if self.high_included => format!("a number of at most {high}"),
            (false, true) => format!("a number below {high}"),
            // the usual lower end, and an upper one that nobody comes to
            (true, true) if *self == Self::MODERATE => format!("a number above {low}, {high} at most"),
            (true, true) => {
                let ends = match (self.low_included, self.high_included) {
                    (true, true) => "ends included",
                    (false, false) => "ends excluded",
                    (true, false) => "the upper end excluded",
                    (false, true) => "the lower end excluded",
                };
                format!("a number between {low} and {high}, {ends}")
            }
        }
    }
}

impl Parameter {
    /// A number that must be written.
    pub const fn number(name: &'static str, unit: &'static str, range: Range, summary: &'static str) -> Self {
        Self { name, summary, kind: Kind::Number, unit, range, default: None }
    }

    pub const fn integer(name: &'static str, range: Range, summary: &'static str) -> Self {
        Self { name, summary, kind: Kind::Integer, unit: "", range, default: None }
    }

    pub const fn boolean(name: &'static str, summary: &'static str) -> Self {
        Self { name, summary, kind: Kind::Boolean, unit: "", range: Range::ANY, default: None }
    }

    pub const fn vector(name: &'static str, unit: &'static str, summary: &'static str) -> Self {
        Self { name, summary, kind: Kind::Vector, unit, range: Range::ANY, default: None }
    }

    /// A list of numbers, each in the range.
    pub const fn numbers(
        name: &'static str,
        unit: &'static str,
        range: Range,
        summary: &'static str,
    ) -> Self {
        Self { name, summary, kind: Kind::Numbers, unit, range, default: None }
    }

    pub const fn text(name: &'static str, summary: &'static str) -> Self {
        Self { name, summary, kind: Kind::Text, unit: "", range: Range::ANY, default: None }
    }

    pub const fn texts(name: &'static str, summary: &'static str) -> Self {
        Self { name, summary, kind: Kind::Texts, unit: "", range: Range::ANY, default: None }
    }

    pub const fn choice(name: &'static str, choices: &'static [&'static str], summary: &'static str) -> Self {
        Self { name, summary, kind: Kind::Choice(choices), unit: "", range: Range::ANY, default: None }
    }

    /// The same with a default, so that it may be left out.
    pub const fn or(mut self, default: Value<'static>) -> Self {
        self.default = Some(default);
        self
    }

    /// What would be accepted, in words.
    pub fn expected(&self) -> String {
        let unit = if self.unit.is_empty() { String::new() } else { format!(" [{}]", self.unit) };
        match self.kind {
            Kind::Number => self.range.describe() + &unit,
            Kind::Integer => {
                self.range.describe().replace("a number", "a whole number").replace("a finite", "a whole")
            }
            Kind::Boolean => "true or false".to_owned(),
            Kind::Vector => format!("three finite numbers{unit}"),
            Kind::Numbers => format!("a list of numbers, each {}{unit}", self.range.describe()),
            Kind::Text => "text".to_owned(),
            Kind::Texts => "a table of names with a number, quantity, direction or text each".to_owned(),
            Kind::Choice(choices) => format!("one of {}", choices.join(", ")),
        }
    }
}
