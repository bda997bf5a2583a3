//! What the tables of a scene may hold, as data: read by the reader, by overrides and by the JSON Schema.

use souple_table::{Parameter, Range, Table, Value, nearest};

/// The keys of one kind of table.
#[derive(Debug)]
pub struct Keys {
    /// Name of the kind, for the schema.
    pub name: &'static str,
    pub summary: &'static str,
    pub keys: &'static [Key],
    /// Whether other keys belong to a thing named within (a system's stepper).
    pub others: Others,
}

/// What to make of keys that are not listed.
#[derive(Clone, Copy, Debug)]
pub enum Others {
    Refused,
    /// They are parameters of the entry that the key of this name chooses.
    ParametersOf(&'static str),
}

/// One key.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    pub name: &'static str,
    pub summary: &'static str,
    pub shape: Shape,
    /// SI unit of numbers (`""` for pure ones).
    pub unit: &'static str,
    /// Interval for numbers, also for those in vectors and lists.
    pub range: Range,
    pub need: Need,
}

/// Whether a key must be written.
#[derive(Clone, Copy, Debug)]
pub enum Need {
    Required,
    Optional,
    Default(Value<'static>),
}

/// What kind of value a key takes.
#[derive(Clone, Copy, Debug)]
pub enum Shape {
    Number,
    Integer,
    Boolean,
    /// Three numbers.
    Vector,
    /// Two corners: `[[x, y, z], [x, y, z]]`.
    Corners,
    Text,
    Choice(&'static [&'static str]),
    Texts,
    Integers,
    Numbers,
    Vectors,
    /// A number or formula of these variables.
    Formula(&'static [&'static str]),
    /// Three numbers or formulas of these variables, or the formula of a vector.
    VectorFormula(&'static [&'static str]),
    /// A condition on these variables.
    Condition(&'static [&'static str]),
    /// A number or three.
    NumberOrVector,
    /// A subset of the letters x, y, z.
    Axes,
    /// `{ name = …, parameters }` or the name alone.
    Entry(EntryShape),
    /// A part of a body (see `spec::region`).
    Region,
    Regions,
    Table(&'static Keys),
    /// A list of tables.
    Tables(&'static Keys),
    /// Tables by name.
    Named(&'static Keys),
    /// Values by name, of any kind.
    Values,
}

/// A choice from tables of entries.
#[derive(Clone, Copy, Debug)]
pub struct EntryShape {
    /// The key that names the entry: `name`, `generate`.
    pub tag: &'static str,
    pub kind: &'static str,
    pub outlines: fn() -> Vec<Outline>,
    /// Whole other forms (`{ file = … }`); the first of them also as a text alone.
    pub instead: &'static [&'static Keys],
    /// Where a name is known that is none of the tables', in words to stand behind `there is no …`.
    pub elsewhere: fn(&str) -> Option<String>,
}

/// For tables that hold all names of their kind.
pub const NOWHERE: fn(&str) -> Option<String> = |_| None;

/// An entry of a table without its constructor.
#[derive(Clone, Debug)]
pub struct Outline {
    pub name: &'static str,
    pub summary: &'static str,
    pub parameters: &'static [Parameter],
}

/// The entries of a table without their constructors.
pub fn outlines<B>(table: &Table<B>) -> Vec<Outline> {
    let outline = |entry: &&'static souple_table::Entry<B>| Outline {
        name: entry.name,
        summary: entry.summary,
        parameters: entry.parameters,
    };
    table.entries.iter().map(outline).collect()
}

impl Key {
    pub const fn new(name: &'static str, shape: Shape, summary: &'static str) -> Self {
        Self { name, summary, shape, unit: "", range: Range::ANY, need: Need::Optional }
    }

    pub const fn number(name: &'static str, unit: &'static str, range: Range, summary: &'static str) -> Self {
        Self { unit, range, ..Self::new(name, Shape::Number, summary) }
    }

    pub const fn vector(name: &'static str, unit: &'static str, summary: &'static str) -> Self {
        Self { unit, ..Self::new(name, Shape::Vector, summary) }
    }

    pub const fn integer(name: &'static str, range: Range, summary: &'static str) -> Self {
        Self { range, ..Self::new(name, Shape::Integer, summary) }
    }

    /// The same, measured in `unit`.
    pub const fn in_unit(mut self, unit: &'static str) -> Self {
        self.unit = unit;
        self
    }

    pub const fn required(mut self) -> Self {
        self.need = Need::Required;
        self
    }

    pub const fn or(mut self, default: Value<'static>) -> Self {
        self.need = Need::Default(default);
        self
    }

    /// What would be accepted, in words.
    pub fn expected(&self) -> String {
        let unit = if self.unit.is_empty() { String::new() } else { format!(" [{}]", self.unit) };
        match self.shape {
            Shape::Number => self.range.describe() + &unit,
            Shape::Integer => {
                self.range.describe().replace("a number", "a whole number").replace("a finite", "a whole")
            }
            Shape::Boolean => "true or false".to_owned(),
            Shape::Vector => format!("three finite numbers{unit}"),
            Shape::Corners => format!("two corners{unit}, such as [[0, 0, 0], [1, 1, 1]]"),
            Shape::Text => "text".to_owned(),
            Shape::Choice(choices) => format!("one of {}", choices.join(", ")),
            Shape::Texts => "a list of texts".to_owned(),
            Shape::Integers => "a list of whole numbers of at least 0".to_owned(),
            Shape::Numbers => format!("a list of numbers{unit}"),
            Shape::Vectors => format!("a list of vectors{unit}"),
            Shape::Formula(variables) => format!("a number{unit} or a formula of {}", variables.join(", ")),
            Shape::VectorFormula(variables) => {
                format!("three numbers{unit} or formulas of {}", variables.join(", "))
            }
            Shape::Condition(variables) => {
                format!("a condition on {}, such as \"{} < 0.1\"", variables.join(", "), variables[0])
            }
            Shape::NumberOrVector => format!("a number{unit} or three"),
            Shape::Axes => "some of the letters x, y, z, such as \"xy\"".to_owned(),
            Shape::Entry(entry) => format!("{{ {} = \"…\", … }}", entry.tag),
            Shape::Region => "a group's name, or { box = … }, { nearest = … } and the like".to_owned(),
            Shape::Regions => "a list of regions".to_owned(),
            Shape::Table(keys) => format!("a table with {}", keys.known().join(", ")),
            Shape::Tables(keys) => format!("a list of tables with {}", keys.known().join(", ")),
            Shape::Named(keys) => format!("tables by name, each with {}", keys.known().join(", ")),
            Shape::Values => "values by name".to_owned(),
        }
    }
}

impl Keys {
    pub const fn new(name: &'static str, summary: &'static str, keys: &'static [Key]) -> Self {
        Self { name, summary, keys, others: Others::Refused }
    }

    pub fn find(&self, name: &str) -> Option<&'static Key> {
        self.keys.iter().find(|key| key.name == name)
    }

    pub fn known(&self) -> Vec<&'static str> {
        self.keys.iter().map(|key| key.name).collect()
    }
}

/// What may be chosen, in words.
pub fn one_of(names: &[&str]) -> String {
    if names.is_empty() {
        "none here, for the scene has none".to_owned()
    } else {
        format!("one of {}", names.join(", "))
    }
}

/// ` (did you mean …?)`, or nothing.
pub fn did_you_mean<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    nearest(name, known).map(|near| format!(" (did you mean `{near}`?)")).unwrap_or_default()
}
