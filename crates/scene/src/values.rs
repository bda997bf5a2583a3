//! Single values of a scene: numbers with units, vectors, texts, formulas.
//!
//! Each function says what is wrong to the log and returns `None` then.

use souple_formal::{Condition, Formula, ParseError, parse_quantity, quantity_in};
use souple_math::Vec3;
use souple_table::{Kind, Parameter, Range, Value, Values, counted, nearest, readable};

use crate::diagnostic::{Code, Log, Site};
use crate::document::{Content, Node};
use crate::source::Place;

/// A value being read: where it is, and where errors go.
#[derive(Clone)]
pub struct Reading<'a> {
    pub node: &'a Node,
    pub path: String,
    pub log: &'a Log,
}

/// Characters of a text shown in a message.
const LONGEST_QUOTE: usize = 60;

impl<'a> Reading<'a> {
    pub fn site(&self) -> Site {
        Site { place: self.node.place, path: self.path.clone() }
    }

    pub fn refuse<T>(
        &self,
        code: Code,
        message: impl Into<String>,
        expected: impl Into<String>,
    ) -> Option<T> {
        self.refuse_at(self.node.place, code, message, expected)
    }

    /// What is wrong with a part of the text.
    fn refuse_part<T>(&self, error: &ParseError, expected: &str) -> Option<T> {
        let place = self.node.layout.place_of(error.span()).unwrap_or(self.node.place);
        self.refuse_at(place, Code::BadFormula, error.without_place(), expected)
    }

    fn refuse_at<T>(
        &self,
        place: Place,
        code: Code,
        message: impl Into<String>,
        expected: impl Into<String>,
    ) -> Option<T> {
        // what is refused already is not refused again for what it is not
        if !matches!(self.node.content, Content::Refused) {
            self.log.add(code, &Site { place, path: self.path.clone() }, message, expected);
        }
        None
    }

    fn wrong_type<T>(&self, expected: &str) -> Option<T> {
        self.refuse(Code::WrongType, format!("this is {}", self.node.content.kind()), expected)
    }

    /// A number in `unit` (SI) within `range`.
    pub fn number(&self, unit: &str, range: Range, expected: &str) -> Option<f64> {
        let number = match &self.node.content {
            Content::Integer(number) => *number as f64,
            Content::Number(number) => *number,
            Content::Text(text) => match quantity_in(text, unit) {
                Ok(number) => number,
                Err(_) if self.node.computed => self.computed(text, expected)?,
                Err(error) => return self.refuse(Code::WrongUnit, error.to_string(), expected),
            },
            _ => return self.wrong_type(expected),
        };
        if range.contains(number) {
            return Some(number);
        }
        let message = if number.is_finite() {
            format!("{} is out of range", readable(number))
        } else {
            format!("{number} is no finite number")
        };
        self.refuse(Code::OutOfRange, message, expected)
    }

    /// The value of a formula without variables: a text with parameters put in.
    fn computed(&self, text: &str, expected: &str) -> Option<f64> {
        match Formula::compile(text, &[]) {
            Ok(formula) => Some(formula.evaluate(&[])),
            Err(error) => self.refuse_part(&error, expected),
        }
    }

    pub fn integer(&self, range: Range, expected: &str) -> Option<i64> {
        let number = match &self.node.content {
            Content::Integer(number) => *number,
            Content::Number(number) if number.fract() == 0.0 && number.abs() < 9e15 => *number as i64,
            Content::Text(text) if self.node.computed => {
                let number = self.computed(text, expected)?;
                if number.fract() != 0.0 || number.abs() >= 9e15 {
                    return self.refuse(Code::OutOfRange, format!("{number} is no whole number"), expected);
                }
                number as i64
            }
            _ => return self.wrong_type(expected),
        };
        if range.contains(number as f64) {
            return Some(number);
        }
        self.refuse(Code::OutOfRange, format!("{number} is out of range"), expected)
    }

    pub fn boolean(&self) -> Option<bool> {
        match self.node.content {
            Content::Boolean(truth) => Some(truth),
            _ => self.wrong_type("true or false"),
        }
    }

    pub fn text(&self) -> Option<&'a str> {
        match &self.node.content {
            Content::Text(text) => Some(text),
            _ => self.wrong_type("text in quotes"),
        }
    }

    pub fn choice(&self, choices: &[&'static str]) -> Option<&'static str> {
        let expected = format!("one of {}", choices.join(", "));
        let Content::Text(text) = &self.node.content else { return self.wrong_type(&expected) };
        if let Some(choice) = choices.iter().find(|choice| *choice == text) {
            return Some(choice);
        }
        let hint = nearest(text, choices.iter().copied()).map(|n| format!(" (did you mean `{n}`?)"));
        let message = format!("there is no choice `{}`{}", quoted(text), hint.unwrap_or_default());
        self.refuse(Code::UnknownName, message, expected)
    }

    /// The items of a list.
    pub fn items(&self, expected: &str) -> Option<Vec<Self>> {
        let Content::List(items) = &self.node.content else { return self.wrong_type(expected) };
        let item = |(index, node)| Self { node, path: format!("{}[{index}]", self.path), log: self.log };
        Some(items.iter().enumerate().map(item).collect())
    }

    pub fn list<T>(&self, expected: &str, read: impl Fn(&Self) -> Option<T>) -> Option<Vec<T>> {
        let items: Vec<Option<T>> = self.items(expected)?.iter().map(read).collect();
        items.into_iter().collect()
    }

    /// A list of three numbers.
    pub fn vector(&self, unit: &str, range: Range, expected: &str) -> Option<Vec3> {
        let items = self.items(expected)?;
        if items.len() != 3 {
            let message = format!("the list has {}", counted(items.len() as u64, "item"));
            return self.refuse(Code::WrongType, message, expected);
        }
        let component = Parameter::number("", "", range, "").expected();
        let unit_text = if unit.is_empty() { String::new() } else { format!(" [{unit}]") };
        let read = |item: &Self| item.number(unit, range, &format!("{component}{unit_text}"));
        let numbers: Vec<Option<f64>> = items.iter().map(read).collect();
        Some(Vec3::new(numbers[0]?, numbers[1]?, numbers[2]?))
    }

    /// A number in `unit` or a formula of `variables`.
    pub fn formula(&self, unit: &str, variables: &[&str], expected: &str) -> Option<Formula> {
        let Content::Text(text) = &self.node.content else {
            return self.number(unit, Range::ANY, expected).map(Formula::constant);
        };
        let wrong_unit = match quantity_in(text, unit) {
            Ok(number) => return Some(Formula::constant(number)),
            Err(error) => error,
        };
        match Formula::compile(text, variables) {
            Ok(formula) => Some(formula),
            // a number with a unit, and not one of those that are wanted
            Err(_) if parse_quantity(text).is_ok() => {
                self.refuse(Code::WrongUnit, wrong_unit.to_string(), expected)
            }
            Err(error) => self.refuse_part(&error, expected),
        }
    }

    /// Three formulas, as a list or as a text in brackets.
    pub fn vector_formula(&self, unit: &str, variables: &[&str], expected: &str) -> Option<[Formula; 3]> {
        if let Content::Text(text) = &self.node.content {
            return match Formula::compile_vector::<3>(text, variables) {
                Ok(formulas) => Some(formulas),
                Err(error) => self.refuse_part(&error, expected),
            };
        }
        let formulas = self.list(expected, |item| item.formula(unit, variables, expected))?;
        let count = formulas.len();
        match <[Formula; 3]>::try_from(formulas) {
            Ok(formulas) => Some(formulas),
            Err(_) => self.refuse(
                Code::WrongType,
                format!("the list has {}", counted(count as u64, "item")),
                expected,
            ),
        }
    }

    pub fn condition(&self, variables: &[&str], expected: &str) -> Option<Condition> {
        let text = self.text()?;
        match Condition::compile(text, variables) {
            Ok(condition) => Some(condition),
            Err(error) => self.refuse_part(&error, expected),
        }
    }

    /// A table of names with a text, number or direction each, as written.
    fn texts(&self, expected: &str) -> Option<Vec<(String, String)>> {
        let Content::Table(table) = &self.node.content else { return self.wrong_type(expected) };
        let mut texts = Vec::with_capacity(table.entries.len());
        for entry in &table.entries {
            let path = format!("{}.{}", self.path, entry.key);
            let item = Reading { node: &entry.node, path, log: self.log };
            let text = match &entry.node.content {
                Content::Text(text) if entry.node.computed => {
                    let value =
                        if parse_quantity(text).is_ok() { None } else { item.computed(text, expected) };
                    value.map_or_else(|| text.clone(), readable)
                }
                Content::Text(text) => text.clone(),
                Content::Integer(number) => number.to_string(),
                Content::Number(_) => readable(item.number("", Range::ANY, "a finite number")?),
                Content::List(_) => {
                    let wanted = "three numbers, as a direction";
                    let [x, y, z] = item.vector("", Range::ANY, wanted)?.to_array().map(readable);
                    format!("[{x}, {y}, {z}]")
                }
                _ => return item.wrong_type(expected),
            };
            texts.push((entry.key.clone(), text));
        }
        Some(texts)
    }

    /// Sets `parameter` of `values` to this.
    pub fn parameter(&self, parameter: &Parameter, values: &mut Values) -> Option<()> {
        let expected = parameter.expected();
        let (unit, range) = (parameter.unit, parameter.range);
        if parameter.kind == Kind::Numbers {
            let each = Parameter::number("", unit, range, "").expected();
            let numbers = self.list(&expected, |item| item.number(unit, range, &each))?;
            if numbers.is_empty() {
                return self.refuse(Code::WrongType, "the list is empty", expected);
            }
            values.set(parameter.name, Value::Numbers(&numbers));
            return Some(());
        }
        if parameter.kind == Kind::Texts {
            values.set(parameter.name, Value::Texts(&self.texts(&expected)?));
            return Some(());
        }
        let value = match parameter.kind {
            Kind::Number => Value::Number(self.number(unit, range, &expected)?),
            Kind::Integer => Value::Integer(self.integer(range, &expected)?),
            Kind::Boolean => Value::Boolean(self.boolean()?),
            Kind::Vector => Value::Vector(self.vector(unit, range, &expected)?.to_array()),
            Kind::Text | Kind::Texts | Kind::Numbers => Value::Text(self.text()?),
            Kind::Choice(choices) => Value::Text(self.choice(choices)?),
        };
        values.set(parameter.name, value);
        Some(())
    }
}

/// The beginning of a text, for messages.
pub fn quoted(text: &str) -> String {
    match text.char_indices().nth(LONGEST_QUOTE) {
        Some((cut, _)) => format!("{}…", &text[..cut]),
        None => text.to_owned(),
    }
}
