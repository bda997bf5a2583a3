//! Values of parameters, as read or as completed by defaults.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;

use crate::{Kind, Parameter, nearest};

/// One value, in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value<'a> {
    Number(f64),
    Integer(i64),
    Boolean(bool),
    Vector([f64; 3]),
    Numbers(&'a [f64]),
    Text(&'a str),
    /// Names and what stands for them.
    Texts(&'a [(String, String)]),
}

/// A number as a person writes it: with an exponent where there would be many zeros.
pub fn readable(number: f64) -> String {
    let is_plain = number == 0.0 || !number.is_finite() || (1e-5..1e15).contains(&number.abs());
    if is_plain { number.to_string() } else { format!("{number:e}") }
}

/// A number to four digits, as many as a person compares.
pub fn four_digits(number: f64) -> String {
    let rounded: f64 = format!("{number:.3e}").parse().unwrap_or(number);
    // no minus before zero
    readable(rounded + 0.0)
}

/// A number and its unit, of which there may be none.
pub fn with_unit(number: &str, unit: &str) -> String {
    if unit.is_empty() { number.to_owned() } else { format!("{number} {unit}") }
}

/// A count with its noun: `1 step`, `2 steps`.
pub fn counted(count: u64, noun: &str) -> String {
    let ending = if count == 1 { "" } else { "s" };
    format!("{count} {noun}{ending}")
}

/// A count with words that follow its number: `1 triangle was`, `2 triangles were`.
pub fn in_number(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

impl fmt::Display for Value<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => f.write_str(&readable(*number)),
            Self::Integer(number) => write!(f, "{number}"),
            Self::Boolean(truth) => write!(f, "{truth}"),
            Self::Vector(vector) => {
                let [x, y, z] = vector.map(readable);
                write!(f, "[{x}, {y}, {z}]")
            }
            Self::Numbers(numbers) => write!(f, "{numbers:?}"),
            Self::Text(text) => write!(f, "\"{text}\""),
            Self::Texts(texts) => {
                let entries: Vec<String> =
                    texts.iter().map(|(name, text)| format!("{name} = \"{text}\"")).collect();
                write!(f, "{{ {} }}", entries.join(", "))
            }
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
enum Owned {
    Number(f64),
    Integer(i64),
    Boolean(bool),
    Vector([f64; 3]),
    Numbers(Vec<f64>),
    Text(Cow<'static, str>),
    Texts(Vec<(String, String)>),
}

/// Named values for one entry.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Values(BTreeMap<Cow<'static, str>, Owned>);

/// A value that an entry cannot take.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ValueError {
    #[error("there is no parameter `{name}`{}; there are: {}", .nearest.as_ref().map(|n| format!(" (did you mean `{n}`?)")).unwrap_or_default(), .known.join(", "))]
    Unknown { name: String, nearest: Option<String>, known: Vec<String> },
    #[error("`{name}` is missing; write {expected}")]
    Missing { name: String, expected: String },
    #[error("`{name}` is {value}, but must be {expected}")]
    Unfit { name: String, value: String, expected: String },
}

impl ValueError {
    /// The parameter the error is about.
    pub fn parameter(&self) -> &str {
        match self {
            Self::Unknown { name, .. } | Self::Missing { name, .. } | Self::Unfit { name, .. } => name,
        }
    }
}

impl Values {
    pub fn new() -> Self {
        Self::default()
    }

    /// The same with `name` set.
    #[must_use]
    pub fn with(mut self, name: impl Into<Cow<'static, str>>, value: Value<'_>) -> Self {
        self.set(name, value);
        self
    }

    pub fn set(&mut self, name: impl Into<Cow<'static, str>>, value: Value<'_>) {
        let owned = match value {
            Value::Number(number) => Owned::Number(number),
            Value::Integer(number) => Owned::Integer(number),
            Value::Boolean(truth) => Owned::Boolean(truth),
            Value::Vector(vector) => Owned::Vector(vector),
            Value::Numbers(numbers) => Owned::Numbers(numbers.to_vec()),
            Value::Text(text) => Owned::Text(Cow::Owned(text.to_owned())),
            Value::Texts(texts) => Owned::Texts(texts.to_vec()),
        };
        self.0.insert(name.into(), owned);
    }

    pub fn get(&self, name: &str) -> Option<Value<'_>> {
        self.0.get(name).map(|owned| match owned {
            Owned::Number(number) => Value::Number(*number),
            Owned::Integer(number) => Value::Integer(*number),
            Owned::Boolean(truth) => Value::Boolean(*truth),
            Owned::Vector(vector) => Value::Vector(*vector),
            Owned::Numbers(numbers) => Value::Numbers(numbers),
            Owned::Text(text) => Value::Text(text),
            Owned::Texts(texts) => Value::Texts(texts),
        })
    }

    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.0.keys().map(AsRef::as_ref)
    }

    /// Defaults filled in, kinds and ranges checked; whole numbers serve where a number is wanted.
    ///
    /// # Errors
    /// Names the parameter that is unknown, missing, of the wrong kind or out of range.
    pub fn completed(mut self, parameters: &[Parameter]) -> Result<Self, ValueError> {
        let names = || parameters.iter().map(|parameter| parameter.name);
        if let Some(unknown) = self.names().find(|name| !names().any(|known| known == *name)) {
            return Err(ValueError::Unknown {
                name: unknown.to_owned(),
                nearest: nearest(unknown, names()).map(str::to_owned),
                known: names().map(str::to_owned).collect(),
            });
        }
        for parameter in parameters {
            let value = match (self.get(parameter.name), parameter.default) {
                (Some(Value::Integer(number)), _) if parameter.kind == Kind::Number => {
                    Value::Number(number as f64)
                }
                (Some(value), _) => value,
                (None, Some(default)) => default,
                (None, None) => {
                    let (name, expected) = (parameter.name.to_owned(), parameter.expected());
                    return Err(ValueError::Missing { name, expected });
                }
            };
            let fits = match (parameter.kind, value) {
                (Kind::Number, Value::Number(number)) => parameter.range.contains(number),
                (Kind::Integer, Value::Integer(number)) => parameter.range.contains(number as f64),
                (Kind::Boolean, Value::Boolean(_))
                | (Kind::Text, Value::Text(_))
                | (Kind::Texts, Value::Texts(_)) => true,
                (Kind::Vector, Value::Vector(vector)) => vector.iter().all(|component| component.is_finite()),
                (Kind::Numbers, Value::Numbers(numbers)) => {
                    // an empty list says nothing, unless that is what is meant where nothing is written
                    let may_be_empty = matches!(parameter.default, Some(Value::Numbers([])));
                    (may_be_empty || !numbers.is_empty())
                        && numbers.iter().all(|number| parameter.range.contains(*number))
                }
                (Kind::Choice(choices), Value::Text(text)) => choices.contains(&text),
                _ => false,
            };
            if !fits {
                let (name, value) = (parameter.name.to_owned(), value.to_string());
                return Err(ValueError::Unfit { name, value, expected: parameter.expected() });
            }
            let checked = Values::new().with(parameter.name, value);
            self.0.extend(checked.0);
        }
        Ok(self)
    }

    /// A number among completed values.
    ///
    /// # Panics
    /// If the entry declares no such number: a bug in the entry.
    pub fn number(&self, name: &str) -> f64 {
        match self.get(name) {
            Some(Value::Number(number)) => number,
            other => panic!("the entry declares no number `{name}`: {other:?}"),
        }
    }

    /// A whole number among completed values; panics like [`Values::number`].
    pub fn integer(&self, name: &str) -> i64 {
        match self.get(name) {
            Some(Value::Integer(number)) => number,
            other => panic!("the entry declares no integer `{name}`: {other:?}"),
        }
    }

    /// A truth value among completed values; panics like [`Values::number`].
    pub fn boolean(&self, name: &str) -> bool {
        match self.get(name) {
            Some(Value::Boolean(truth)) => truth,
            other => panic!("the entry declares no boolean `{name}`: {other:?}"),
        }
    }

    /// A vector among completed values; panics like [`Values::number`].
    pub fn vector(&self, name: &str) -> [f64; 3] {
        match self.get(name) {
            Some(Value::Vector(vector)) => vector,
            other => panic!("the entry declares no vector `{name}`: {other:?}"),
        }
    }

    /// A list of numbers among completed values; panics like [`Values::number`].
    pub fn numbers(&self, name: &str) -> &[f64] {
        match self.get(name) {
            Some(Value::Numbers(numbers)) => numbers,
            other => panic!("the entry declares no numbers `{name}`: {other:?}"),
        }
    }

    /// Texts by names among completed values; panics like [`Values::number`].
    pub fn texts(&self, name: &str) -> &[(String, String)] {
        match self.get(name) {
            Some(Value::Texts(texts)) => texts,
            other => panic!("the entry declares no texts `{name}`: {other:?}"),
        }
    }

    /// Text or a choice among completed values; panics like [`Values::number`].
    pub fn text(&self, name: &str) -> &str {
        match self.get(name) {
            Some(Value::Text(text)) => text,
            other => panic!("the entry declares no text `{name}`: {other:?}"),
        }
    }
}
