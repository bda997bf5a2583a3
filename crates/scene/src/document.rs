//! A parsed text: values that know where they stand.

use std::ops::Range;

use toml::de::{DeTable, DeValue};

use crate::diagnostic::{Code, Log, Site};
use crate::layout::Layout;
use crate::source::{Place, Sources};

/// A value and where it was written.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    pub place: Place,
    pub content: Content,
    /// Whether the text holds parameters put in: such a text may be a formula where a number is wanted.
    pub computed: bool,
    /// Of a text: where its bytes were written.
    pub layout: Layout,
}

/// What a value is.
#[derive(Clone, Debug, PartialEq)]
pub enum Content {
    Text(String),
    Integer(i64),
    Number(f64),
    Boolean(bool),
    /// A date or time: no key takes one.
    Date(String),
    List(Vec<Node>),
    Table(Table),
    /// What could not be read, as is reported: no more is said of it.
    Refused,
}

/// Keys and values in the order they were written.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    pub entries: Vec<Entry>,
}

/// A key with its value.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    pub key: String,
    pub key_place: Place,
    pub node: Node,
}

impl Table {
    pub fn get(&self, key: &str) -> Option<&Node> {
        self.entries.iter().find(|entry| entry.key == key).map(|entry| &entry.node)
    }

    pub fn get_mut(&mut self, key: &str) -> Option<&mut Node> {
        self.entries.iter_mut().find(|entry| entry.key == key).map(|entry| &mut entry.node)
    }

    pub fn keys(&self) -> impl Iterator<Item = &str> {
        self.entries.iter().map(|entry| entry.key.as_str())
    }

    /// Takes an entry out.
    pub fn remove(&mut self, key: &str) -> Option<Entry> {
        let at = self.entries.iter().position(|entry| entry.key == key)?;
        Some(self.entries.remove(at))
    }
}

impl Content {
    /// What it is, in words.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Text(_) => "text",
            Self::Integer(_) => "a whole number",
            Self::Number(_) => "a number",
            Self::Boolean(_) => "a truth value",
            Self::Date(_) => "a date",
            Self::List(_) => "a list",
            Self::Table(_) => "a table",
            Self::Refused => "refused",
        }
    }
}

impl Node {
    pub fn new(place: Place, content: Content) -> Self {
        Self { place, content, computed: false, layout: Layout::default() }
    }

    pub fn as_table(&self) -> Option<&Table> {
        match &self.content {
            Content::Table(table) => Some(table),
            _ => None,
        }
    }
}

/// The table that the text of a source stands for; all errors of syntax go to the log, and what could be read
/// in spite of them is returned.
pub fn parse(sources: &Sources, source: usize, log: &Log) -> Table {
    let text = &sources.get(source).text;
    let (table, errors) = DeTable::parse_recoverable(text);
    for error in &errors {
        let span = error.span().unwrap_or(0..0);
        let place = Place { source, start: span.start, end: span.end.max(span.start + 1).min(text.len()) };
        report_syntax(log, place, error.message());
    }
    let mut reader = TomlReader { source, log, text, offset: 0 };
    reader.table(table.get_ref())
}

/// A value written on the command line; the text itself where it is no TOML value (`5ms`, `linear`).
pub fn parse_value(text: &str, source: usize, offset: usize) -> Node {
    let log = Log::default();
    let place = Place { source, start: offset, end: offset + text.len() };
    let offset = offset + text.len() - text.trim_start().len();
    let text = text.trim();
    let node = DeValue::parse(text)
        .ok()
        .map(|value| TomlReader { source, log: &log, text, offset }.value(value.span(), value.get_ref()));
    let mut node = match node {
        Some(node) if log.is_empty() => node,
        _ => {
            let layout = Layout::verbatim(Place { source, start: offset, end: offset + text.len() });
            Node { layout, ..Node::new(place, Content::Text(text.to_owned())) }
        }
    };
    place_all(&mut node, place);
    node
}

/// Everything in `node` stands at `place`.
fn place_all(node: &mut Node, place: Place) {
    node.place = place;
    match &mut node.content {
        Content::List(items) => items.iter_mut().for_each(|item| place_all(item, place)),
        Content::Table(table) => table.entries.iter_mut().for_each(|entry| {
            entry.key_place = place;
            place_all(&mut entry.node, place);
        }),
        _ => {}
    }
}

fn report_syntax(log: &Log, place: Place, message: &str) {
    let (what, expected) = message.split_once(", expected ").unwrap_or((message, "a scene in TOML"));
    log.add(Code::Syntax, &Site { place, path: String::new() }, format!("cannot be read: {what}"), expected);
}

struct TomlReader<'a> {
    source: usize,
    log: &'a Log,
    text: &'a str,
    /// Where the text begins in the source.
    offset: usize,
}

impl TomlReader<'_> {
    fn place(&self, span: Range<usize>) -> Place {
        Place { source: self.source, start: self.offset + span.start, end: self.offset + span.end }
    }

    fn table(&mut self, table: &DeTable) -> Table {
        let mut entries: Vec<Entry> = table
            .iter()
            .map(|(key, value)| Entry {
                key: key.get_ref().to_string(),
                key_place: self.place(key.span()),
                node: self.value(value.span(), value.get_ref()),
            })
            .collect();
        // the parser sorts by name: back to the order of the text
        entries.sort_by_key(|entry| entry.key_place.start);
        Table { entries }
    }

    fn value(&mut self, span: Range<usize>, value: &DeValue) -> Node {
        let place = self.place(span.clone());
        let content = match value {
            DeValue::String(text) => {
                let written = self.text.get(span).unwrap_or_default();
                let layout = Layout::of_literal(written, text, place);
                return Node { layout, ..Node::new(place, Content::Text(text.to_string())) };
            }
            DeValue::Boolean(truth) => Content::Boolean(*truth),
            DeValue::Datetime(date) => Content::Date(date.to_string()),
            DeValue::Integer(integer) => match i64::from_str_radix(integer.as_str(), integer.radix()) {
                Ok(number) => Content::Integer(number),
                Err(_) => {
                    report_syntax(
                        self.log,
                        place,
                        "the whole number is too large, expected at most 9223372036854775807",
                    );
                    Content::Refused
                }
            },
            DeValue::Float(float) => match float.as_str().parse::<f64>() {
                Ok(number) => Content::Number(number),
                Err(_) => {
                    report_syntax(
                        self.log,
                        place,
                        "this is no number, expected a number such as 0.5 or 1e-3",
                    );
                    Content::Refused
                }
            },
            DeValue::Array(items) => {
                Content::List(items.iter().map(|item| self.value(item.span(), item.get_ref())).collect())
            }
            DeValue::Table(table) => Content::Table(self.table(table)),
        };
        Node::new(place, content)
    }
}
