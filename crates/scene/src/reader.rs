//! A cursor over one table of a scene: gives the values of its keys, checked against their description.
//!
//! Opening a table reports the keys that are unknown and those that are missing. A value that was refused is in
//! the log; what the reader returns in its place only keeps the reading going, since nothing is compiled from a
//! specification with faults.

use souple_formal::{Condition, Formula, Span};
use souple_math::Vec3;
use souple_table::{Entry, Table, Value, Values, counted};

use crate::diagnostic::{Code, Log, Site};
use crate::document::{Content, Node, Table as Document};
use crate::keys::{EntryShape, Key, Keys, Need, Others, Shape, did_you_mean};
use crate::layout::Layout;
use crate::values::{Reading, quoted};

/// A table being read.
pub struct Reader<'a> {
    node: &'a Node,
    table: &'a Document,
    keys: &'static Keys,
    path: String,
    log: &'a Log,
}

/// A thing chosen from a table, with its completed values.
pub struct Chosen<B: 'static> {
    pub entry: &'static Entry<B>,
    pub values: Values,
    pub site: Site,
    /// Where the parameters that are written are.
    pub written: Vec<(&'static str, Site)>,
    /// Where the bytes of texts are, by the keys that lead to them: `push`, `parameters.k`.
    pub texts: Vec<(String, Site, Layout)>,
}

// by hand: entries are shared, whatever they build
impl<B> Clone for Chosen<B> {
    fn clone(&self) -> Self {
        let Self { entry, values, site, written, texts } = self;
        Self {
            entry,
            values: values.clone(),
            site: site.clone(),
            written: written.clone(),
            texts: texts.clone(),
        }
    }
}

impl<B> Chosen<B> {
    /// Where a parameter is written, or the whole where it is not.
    pub fn site_of(&self, parameter: &str) -> &Site {
        self.written.iter().find(|(name, _)| *name == parameter).map_or(&self.site, |(_, site)| site)
    }

    /// Where a part of a text is; the whole text, the first of its keys or else what is chosen, where that is not known.
    pub fn site_of_part(&self, keys: &str, part: Option<Span>) -> Site {
        let Some((_, site, layout)) = self.texts.iter().find(|(known, ..)| known == keys) else {
            let first = keys.split('.').next().unwrap_or(keys);
            return self.site_of(first).clone();
        };
        let place = part.and_then(|part| layout.place_of(part));
        Site { place: place.unwrap_or(site.place), ..site.clone() }
    }
}

/// Texts below a node, with the keys that lead to them.
fn texts_of(keys: &str, path: &str, node: &Node, texts: &mut Vec<(String, Site, Layout)>) {
    match &node.content {
        Content::Text(_) => {
            let site = Site { place: node.place, path: path.to_owned() };
            texts.push((keys.to_owned(), site, node.layout.clone()));
        }
        Content::Table(table) => {
            for crate::document::Entry { key, node, .. } in &table.entries {
                let is_bare = key.bytes().all(|byte| byte.is_ascii_alphanumeric() || b"_-".contains(&byte));
                let key = if is_bare { key.clone() } else { format!("\"{key}\"") };
                texts_of(&format!("{keys}.{key}"), &format!("{path}.{key}"), node, texts);
            }
        }
        _ => {}
    }
}

impl<'a> Reader<'a> {
    /// Opens a table; reports keys that it does not take and those it lacks.
    pub fn open(reading: &Reading<'a>, keys: &'static Keys) -> Option<Self> {
        let Reading { node, path, log } = reading.clone();
        let Some(table) = node.as_table() else {
            let expected = format!("a table with {}", keys.known().join(", "));
            return reading.refuse(Code::WrongType, format!("this is {}", node.content.kind()), expected);
        };
        let reader = Self { node, table, keys, path, log };
        reader.check_keys();
        Some(reader)
    }

    fn check_keys(&self) {
        if matches!(self.keys.others, Others::Refused) {
            for entry in &self.table.entries {
                if self.keys.find(&entry.key).is_none() {
                    self.refuse_key(&entry.key, self.keys.known());
                }
            }
        }
        for key in self.keys.keys {
            if matches!(key.need, Need::Required) && self.table.get(key.name).is_none() {
                let message = format!("`{}` is missing", key.name);
                let expected = format!("{} = {} ({})", key.name, key.expected(), key.summary);
                let site = Site { place: self.node.place, path: self.path_of(key.name) };
                self.log.add(Code::MissingKey, &site, message, expected);
            }
        }
    }

    fn refuse_key(&self, name: &str, known: Vec<&str>) {
        let place =
            self.table.entries.iter().find(|e| e.key == name).map_or(self.node.place, |e| e.key_place);
        let site = Site { place, path: self.path_of(name) };
        let message =
            format!("there is no key `{}`{}", quoted(name), did_you_mean(name, known.iter().copied()));
        self.log.add(Code::UnknownKey, &site, message, format!("one of {}", known.join(", ")));
    }

    pub fn log(&self) -> &'a Log {
        self.log
    }

    pub fn site(&self) -> Site {
        Site { place: self.node.place, path: self.path.clone() }
    }

    pub fn site_of(&self, key: &str) -> Site {
        let place = self.table.get(key).map_or_else(|| self.node.place, |node| node.place);
        Site { place, path: self.path_of(key) }
    }

    /// The place of a part of the text of a key.
    pub fn site_of_part(&self, key: &str, part: Span) -> Site {
        let part = self.table.get(key).and_then(|node| node.layout.place_of(part));
        let whole = self.site_of(key);
        Site { place: part.unwrap_or(whole.place), ..whole }
    }

    fn path_of(&self, key: &str) -> String {
        let separator = if self.path.is_empty() { "" } else { "." };
        format!("{}{separator}{key}", self.path)
    }

    pub fn has(&self, key: &str) -> bool {
        self.table.get(key).is_some()
    }

    /// The keys written, of those in `names`.
    pub fn written(&self, names: &[&'static str]) -> Vec<&'static str> {
        names.iter().copied().filter(|name| self.has(name)).collect()
    }

    pub fn reading(&self, key: &str) -> Option<Reading<'a>> {
        let node = self.table.get(key)?;
        Some(Reading { node, path: self.path_of(key), log: self.log })
    }

    /// # Panics
    /// If the description has no such key: a bug of the specification.
    fn key(&self, name: &str) -> &'static Key {
        self.keys.find(name).unwrap_or_else(|| panic!("`{}` describes no key `{name}`", self.keys.name))
    }

    fn read<T>(
        &self,
        name: &str,
        read: impl FnOnce(Reading<'a>, &'static Key, &str) -> Option<T>,
    ) -> Option<T> {
        let key = self.key(name);
        let reading = self.reading(name)?;
        read(reading, key, &key.expected())
    }

    fn default_of(&self, name: &str) -> Option<Value<'static>> {
        match self.key(name).need {
            Need::Default(value) => Some(value),
            Need::Required | Need::Optional => None,
        }
    }

    pub fn maybe_number(&self, name: &str) -> Option<f64> {
        match self.default_of(name) {
            Some(Value::Number(default)) if !self.has(name) => Some(default),
            _ => self.read(name, |value, key, expected| value.number(key.unit, key.range, expected)),
        }
    }

    /// The same of a number without a default, measured in a unit that depends on other keys.
    pub fn maybe_number_in(&self, name: &str, unit: &'static str) -> Option<f64> {
        let expected = self.key(name).in_unit(unit).expected();
        self.read(name, |value, key, _| value.number(unit, key.range, &expected))
    }

    /// NaN in place of a number that was refused.
    pub fn number(&self, name: &str) -> f64 {
        self.maybe_number(name).unwrap_or(f64::NAN)
    }

    pub fn maybe_integer(&self, name: &str) -> Option<i64> {
        match self.default_of(name) {
            Some(Value::Integer(default)) if !self.has(name) => Some(default),
            _ => self.read(name, |value, key, expected| value.integer(key.range, expected)),
        }
    }

    pub fn boolean(&self, name: &str) -> bool {
        let default = matches!(self.default_of(name), Some(Value::Boolean(true)));
        if self.has(name) {
            self.read(name, |value, _, _| value.boolean()).unwrap_or(default)
        } else {
            default
        }
    }

    pub fn maybe_text(&self, name: &str) -> Option<String> {
        self.read(name, |value, _, _| value.text().map(str::to_owned))
    }

    /// Empty in place of a text that was refused or left out.
    pub fn text(&self, name: &str) -> String {
        self.maybe_text(name).unwrap_or_default()
    }

    pub fn choice(&self, name: &str) -> &'static str {
        let Shape::Choice(choices) = self.key(name).shape else { unreachable!("`{name}` is no choice") };
        let chosen = self.read(name, |value, _, _| value.choice(choices));
        match (chosen, self.default_of(name)) {
            (Some(choice), _) => choice,
            (None, Some(Value::Text(default))) => default,
            (None, _) => choices[0],
        }
    }

    pub fn maybe_vector(&self, name: &str) -> Option<Vec3> {
        match self.default_of(name) {
            Some(Value::Vector(default)) if !self.has(name) => Some(Vec3::from_array(default)),
            _ => self.read(name, |value, key, expected| value.vector(key.unit, key.range, expected)),
        }
    }

    /// Zero in place of a vector that was refused.
    pub fn vector(&self, name: &str) -> Vec3 {
        self.maybe_vector(name).unwrap_or(Vec3::ZERO)
    }

    pub fn corners(&self, name: &str) -> Option<[Vec3; 2]> {
        self.read(name, |value, key, expected| {
            let corners = value.list(expected, |item| item.vector(key.unit, key.range, expected))?;
            let count = corners.len();
            let fault = || {
                value.refuse(
                    Code::WrongType,
                    format!("the list has {}", counted(count as u64, "item")),
                    expected,
                )
            };
            <[Vec3; 2]>::try_from(corners).ok().or_else(fault)
        })
    }

    pub fn texts(&self, name: &str) -> Vec<String> {
        let read =
            self.read(name, |value, _, expected| value.list(expected, |item| item.text().map(str::to_owned)));
        read.unwrap_or_default()
    }

    pub fn maybe_indices(&self, name: &str) -> Option<Vec<u32>> {
        let range = souple_table::Range::closed(0.0, f64::from(u32::MAX - 1));
        let expected = "a whole number of at least 0";
        self.read(name, |value, _, list| {
            value.list(list, |item| item.integer(range, expected).map(|i| i as u32))
        })
    }

    pub fn numbers(&self, name: &str) -> Vec<f64> {
        self.maybe_numbers(name).unwrap_or_default()
    }

    pub fn maybe_numbers(&self, name: &str) -> Option<Vec<f64>> {
        self.read(name, |value, key, expected| {
            value.list(expected, |item| item.number(key.unit, key.range, expected))
        })
    }

    pub fn vectors(&self, name: &str) -> Vec<Vec3> {
        self.maybe_vectors(name).unwrap_or_default()
    }

    pub fn maybe_vectors(&self, name: &str) -> Option<Vec<Vec3>> {
        self.read(name, |value, key, expected| {
            value.list(expected, |item| item.vector(key.unit, key.range, "three finite numbers"))
        })
    }

    pub fn maybe_formula(&self, name: &str) -> Option<Formula> {
        let Shape::Formula(variables) = self.key(name).shape else { unreachable!("`{name}` is no formula") };
        self.read(name, |value, key, expected| value.formula(key.unit, variables, expected))
    }

    /// The same, measured in a unit that depends on other keys.
    pub fn formula_in(&self, name: &str, unit: &'static str) -> Option<Formula> {
        let Shape::Formula(variables) = self.key(name).shape else { unreachable!("`{name}` is no formula") };
        let expected = self.key(name).in_unit(unit).expected();
        self.read(name, |value, _, _| value.formula(unit, variables, &expected))
    }

    pub fn maybe_vector_formula(&self, name: &str) -> Option<[Formula; 3]> {
        let Shape::VectorFormula(variables) = self.key(name).shape else {
            unreachable!("`{name}` is no formula")
        };
        self.read(name, |value, key, expected| value.vector_formula(key.unit, variables, expected))
    }

    /// The same, measured in a unit that depends on other keys.
    pub fn vector_formula_in(&self, name: &str, unit: &'static str) -> Option<[Formula; 3]> {
        let Shape::VectorFormula(variables) = self.key(name).shape else {
            unreachable!("`{name}` is no formula")
        };
        let expected = self.key(name).in_unit(unit).expected();
        self.read(name, |value, _, _| value.vector_formula(unit, variables, &expected))
    }

    pub fn maybe_condition(&self, name: &str) -> Option<Condition> {
        let Shape::Condition(variables) = self.key(name).shape else {
            unreachable!("`{name}` is no condition")
        };
        self.read(name, |value, _, expected| value.condition(variables, expected))
    }

    /// Which of x, y, z are named; all three where the key is left out.
    pub fn axes(&self, name: &str) -> [bool; 3] {
        let read = self.read(name, |value, _, expected| {
            let text = value.text()?;
            let known = !text.is_empty() && text.chars().all(|c| "xyz".contains(c));
            if !known {
                return value.refuse(
                    Code::UnknownName,
                    format!("`{}` names no axes", quoted(text)),
                    expected,
                );
            }
            Some(['x', 'y', 'z'].map(|axis| text.contains(axis)))
        });
        read.unwrap_or([true; 3])
    }

    pub fn table(&self, name: &str) -> Option<Reader<'a>> {
        let Shape::Table(keys) = self.key(name).shape else { unreachable!("`{name}` is no table") };
        self.read(name, |value, _, _| Reader::open(&value, keys))
    }

    /// A list of tables; a single table serves as a list of one.
    pub fn tables(&self, name: &str) -> Vec<Reader<'a>> {
        let Shape::Tables(keys) = self.key(name).shape else { unreachable!("`{name}` is no list of tables") };
        let items = self.read(name, |value, _, expected| match value.node.content {
            Content::Table(_) => Some(vec![value]),
            _ => value.items(expected),
        });
        items.unwrap_or_default().iter().filter_map(|item| Reader::open(item, keys)).collect()
    }

    pub fn named(&self, name: &str) -> Vec<(String, Reader<'a>)> {
        let Shape::Named(keys) = self.key(name).shape else { unreachable!("`{name}` holds no named tables") };
        let Some(value) = self.reading(name) else { return Vec::new() };
        let Some(table) = value.node.as_table() else {
            let message = format!("this is {}", value.node.content.kind());
            value.refuse::<()>(Code::WrongType, message, self.key(name).expected());
            return Vec::new();
        };
        let open = |entry: &'a crate::document::Entry| {
            let path = format!("{}.{}", value.path, entry.key);
            let reader = Reader::open(&Reading { node: &entry.node, path, log: self.log }, keys)?;
            Some((entry.key.clone(), reader))
        };
        table.entries.iter().filter_map(open).collect()
    }

    /// The thing that a key chooses from a table: `"name"` or `{ name = "…", parameters }`.
    pub fn entry<B>(&self, name: &str, table: &Table<B>) -> Option<Chosen<B>> {
        let Shape::Entry(shape) = self.key(name).shape else { unreachable!("`{name}` chooses no entry") };
        let others = match self.keys.others {
            Others::ParametersOf(key) if key == name => {
                self.table.entries.iter().filter(|entry| self.keys.find(&entry.key).is_none()).collect()
            }
            _ => Vec::new(),
        };
        let reading = self.reading(name)?;
        choose(&reading, &shape, table, &others, self.keys)
    }

    /// Reports keys that stand beside an entry which was left out.
    pub fn refuse_others(&self) {
        for entry in &self.table.entries {
            if self.keys.find(&entry.key).is_none() {
                self.refuse_key(&entry.key, self.keys.known());
            }
        }
    }
}

/// Reads `"name"` or `{ tag = "name", parameters }`; `others` are parameters written beside it.
pub fn choose<B>(
    reading: &Reading,
    shape: &EntryShape,
    table: &Table<B>,
    others: &[&crate::document::Entry],
    keys: &'static Keys,
) -> Option<Chosen<B>> {
    let log = reading.log;
    let names: Vec<&str> = table.names().collect();
    let expected = format!("{{ {} = \"…\", … }} with one of {}", shape.tag, names.join(", "));
    let (name, own) = match &reading.node.content {
        Content::Text(_) => (reading.clone(), None),
        Content::Table(content) => {
            let Some(node) = content.get(shape.tag) else {
                return reading.refuse(Code::MissingKey, format!("`{}` is missing", shape.tag), expected);
            };
            let path = format!("{}.{}", reading.path, shape.tag);
            (Reading { node, path, log }, Some(content))
        }
        other => return reading.refuse(Code::WrongType, format!("this is {}", other.kind()), expected),
    };
    let entry = match table.find(name.text()?) {
        Ok(entry) => entry,
        Err(unknown) => {
            let elsewhere = (shape.elsewhere)(&unknown.name).map(|words| format!(" ({words})"));
            let near = || unknown.nearest.map(|near| format!(" (did you mean `{near}`?)"));
            let hint = elsewhere.or_else(near).unwrap_or_default();
            let message = format!("there is no {} `{}`{hint}", unknown.kind, quoted(&unknown.name));
            return name.refuse(Code::UnknownName, message, format!("one of {}", unknown.known.join(", ")));
        }
    };
    let (mut values, mut written, mut texts) = (Values::new(), Vec::new(), Vec::new());
    let mut is_good = true;
    let known = || entry.parameters.iter().map(|parameter| parameter.name);
    let inside = own.iter().flat_map(|content| &content.entries).filter(|e| e.key != shape.tag);
    let inside = inside.map(|e| (e, format!("{}.{}", reading.path, e.key), known().collect::<Vec<_>>()));
    let parent = reading.path.rsplit_once('.').map_or("", |(parent, _)| parent);
    let beside = others.iter().map(|e| {
        (*e, format!("{parent}.{}", e.key), keys.known().into_iter().chain(known()).collect::<Vec<_>>())
    });
    for (item, path, accepted) in inside.chain(beside) {
        let Some(parameter) = entry.parameters.iter().find(|parameter| parameter.name == item.key) else {
            let hint = did_you_mean(&item.key, accepted.iter().copied());
            let message = format!("{} `{}` has no key `{}`{hint}", table.kind, entry.name, quoted(&item.key));
            let site = Site { place: item.key_place, path };
            let expected = match accepted.is_empty() {
                true => "its name alone".to_owned(),
                false => format!("one of {}", accepted.join(", ")),
            };
            log.add(Code::UnknownKey, &site, message, expected);
            is_good = false;
            continue;
        };
        let value = Reading { node: &item.node, path, log };
        is_good &= value.parameter(parameter, &mut values).is_some();
        written.push((parameter.name, value.site()));
        texts_of(parameter.name, &value.path, value.node, &mut texts);
    }
    for parameter in entry.parameters {
        let is_written = own.is_some_and(|content| content.get(parameter.name).is_some())
            || others.iter().any(|other| other.key == parameter.name);
        if !is_written && parameter.default.is_none() {
            let message = format!("{} `{}` needs `{}`", table.kind, entry.name, parameter.name);
            let expected = format!("{} = {} ({})", parameter.name, parameter.expected(), parameter.summary);
            let site =
                Site { place: reading.node.place, path: format!("{}.{}", reading.path, parameter.name) };
            log.add(Code::MissingKey, &site, message, expected);
            is_good = false;
        }
    }
    if !is_good {
        return None;
    }
    match entry.values(values) {
        Ok(values) => Some(Chosen { entry, values, site: reading.site(), written, texts }),
        Err(error) => reading.refuse(Code::OutOfRange, error.to_string(), expected),
    }
}
