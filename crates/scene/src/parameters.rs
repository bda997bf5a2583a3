//! `[parameters]`: values named once and used as `"$name"`, alone or within formulas and other texts.
//!
//! A text that is nothing but `"$name"` becomes the parameter's value, whatever that is. Within a longer text a
//! parameter stands for its number in SI units, so that `"2 * $stiffness"` and `"$amplitude * sin(t)"` work.

use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;

use souple_formal::{Formula, Span, parse_quantity};
use souple_table::nearest;

use crate::diagnostic::{Code, Log, Site};
use crate::document::{Content, Node, Table};
use crate::layout::Layout;

/// Parameters within parameters, at most.
pub(crate) const DEEPEST: usize = 32;
/// Bytes and values that all uses of parameters put in together, at most: a few parameters that each name the one
/// before twice would otherwise grow without bound.
const LARGEST: usize = 1 << 20;

/// Puts the parameters of a document in and takes their table out, which it gives.
pub fn substitute(document: &mut Table, log: &Log) -> Table {
    let Some(entry) = document.remove("parameters") else {
        let none = Table::default();
        put_in(document, &none, "", log);
        return none;
    };
    let Content::Table(parameters) = entry.node.content else {
        let site = Site { place: entry.node.place, path: "parameters".to_owned() };
        log.add(
            Code::WrongType,
            &site,
            format!("this is {}", entry.node.content.kind()),
            "a table of named values",
        );
        return Table::default();
    };
    put_in(document, &parameters, "", log);
    parameters
}

/// Puts parameters into a table that stands at `path`.
pub fn put_in(table: &mut Table, parameters: &Table, path: &str, log: &Log) {
    Substitution::new(parameters, log).table(table, path);
}

/// Parameters of which those in `over` take the place of others of their name.
pub fn overlaid(parameters: &Table, over: &Table) -> Table {
    let kept = parameters.entries.iter().filter(|entry| over.get(&entry.key).is_none());
    Table { entries: kept.chain(&over.entries).cloned().collect() }
}

struct Substitution<'a> {
    parameters: &'a Table,
    log: &'a Log,
    /// Parameters being resolved, outermost first: meeting one again is a cycle.
    open: RefCell<Vec<String>>,
    /// Parameters resolved; `None`: refused, which is reported.
    resolved: RefCell<BTreeMap<String, Option<Node>>>,
    /// What may still be put in, see [`LARGEST`].
    left: Cell<usize>,
}

impl<'a> Substitution<'a> {
    fn new(parameters: &'a Table, log: &'a Log) -> Self {
        let (open, resolved) = (RefCell::default(), RefCell::default());
        Self { parameters, log, open, resolved, left: Cell::new(LARGEST) }
    }

    fn table(&self, table: &mut Table, path: &str) {
        for entry in &mut table.entries {
            let separator = if path.is_empty() { "" } else { "." };
            let path = format!("{path}{separator}{}", entry.key);
            self.node(&mut entry.node, &path);
        }
    }

    fn node(&self, node: &mut Node, path: &str) {
        match &mut node.content {
            Content::Table(table) => self.table(table, path),
            Content::List(items) => {
                for (index, item) in items.iter_mut().enumerate() {
                    self.node(item, &format!("{path}[{index}]"));
                }
            }
            Content::Text(text) if text.contains('$') => {
                let text = std::mem::take(text);
                self.text(node, &text, path);
            }
            _ => {}
        }
    }

    /// Puts parameters into `text`, the content of `node`.
    fn text(&self, node: &mut Node, text: &str, path: &str) {
        let site = |start: usize, end: usize| Site {
            place: node.layout.place_of(Span::new(start, end)).unwrap_or(node.place),
            path: path.to_owned(),
        };
        if let Some(name) = text.strip_prefix('$')
            && name_length(name) == name.len()
        {
            let whole = Site { place: node.place, path: path.to_owned() };
            match self.value(name, &whole) {
                // errors in what stands for the name are shown at the name
                Some(Node { content, computed, .. }) => {
                    node.layout = Layout::whole(node.place, text_length(&content));
                    (node.content, node.computed) = (content, computed);
                }
                None => node.content = Content::Refused,
            }
            return;
        }
        let (mut result, mut layout) = (String::new(), Layout::default());
        let mut is_whole = true;
        let mut at = 0;
        while let Some(before) = text[at..].find('$') {
            let start = at + before;
            layout.push_part(&node.layout, at, start);
            result.push_str(&text[at..start]);
            let name = &text[start + 1..start + 1 + name_length(&text[start + 1..])];
            at = start + 1 + name.len();
            let site = site(start, at);
            if name.is_empty() {
                let expected = "`$` and the name of a parameter";
                self.log.add(Code::UnknownParameter, &site, "`$` without a name", expected);
            }
            let value = if name.is_empty() { None } else { self.value(name, &site) };
            match value.and_then(|value| self.within(name, &value, &site)) {
                Some(value) => {
                    layout.push_whole(site.place, value.len());
                    result.push_str(&value);
                }
                None => is_whole = false,
            }
        }
        layout.push_part(&node.layout, at, text.len());
        result.push_str(&text[at..]);
        node.content = if is_whole { Content::Text(result) } else { Content::Refused };
        (node.computed, node.layout) = (true, layout);
    }

    /// The parameter's value, parameters in it put in.
    fn value(&self, name: &str, site: &Site) -> Option<Node> {
        let refuse = |message: String, expected: &str| {
            self.log.add(Code::UnknownParameter, site, message, expected);
            None
        };
        let known = self.resolved.borrow().get(name).cloned();
        let node = match known {
            Some(node) => node?,
            None => {
                let Some(node) = self.parameters.get(name) else {
                    let near = nearest(name, self.parameters.keys());
                    let hint = near.map(|near| format!(" (did you mean `${near}`?)")).unwrap_or_default();
                    let known: Vec<&str> = self.parameters.keys().collect();
                    let expected = if known.is_empty() {
                        "a table [parameters] with it".to_owned()
                    } else {
                        format!("one of {}", known.join(", "))
                    };
                    return refuse(format!("there is no parameter `{name}`{hint}"), &expected);
                };
                if self.open.borrow().iter().any(|open| open == name) {
                    let expected = "parameters that do not refer to each other in a circle";
                    return refuse(format!("parameter `{name}` is made of itself"), expected);
                }
                if self.open.borrow().len() == DEEPEST {
                    let expected = format!("at most {DEEPEST} parameters within each other");
                    return refuse(format!("parameter `{name}` is nested too deep"), &expected);
                }
                self.resolve(name, node)
            }
        };
        let Some(left) = self.left.get().checked_sub(size(&node)) else {
            let message = format!("parameter `{name}` makes the scene too large");
            let expected = format!("at most {LARGEST} bytes and values put in by parameters");
            self.log.add(Code::TooLarge, site, message, expected);
            // said once: nothing more is put in
            self.left.set(0);
            self.resolved.borrow_mut().values_mut().for_each(|node| *node = None);
            return None;
        };
        self.left.set(left);
        Some(node)
    }

    /// A parameter with the parameters in it put in, once for all its uses.
    fn resolve(&self, name: &str, node: &Node) -> Node {
        let mut node = node.clone();
        self.open.borrow_mut().push(name.to_owned());
        self.node(&mut node, &format!("parameters.{name}"));
        self.open.borrow_mut().pop();
        self.resolved.borrow_mut().insert(name.to_owned(), Some(node.clone()));
        node
    }

    /// A parameter as it stands within a longer text: a number in parentheses, or a text as it is; `None` of what cannot, which is
    /// reported.
    fn within(&self, name: &str, node: &Node, site: &Site) -> Option<String> {
        Some(match &node.content {
            Content::Integer(number) => format!("({number})"),
            // the exact number again when read: the shortest decimal that rounds to it
            Content::Number(number) => format!("({number:?})"),
            Content::Text(text) if node.computed => Formula::compile(text, &[])
                .map_or_else(|_| format!("({text})"), |f| format!("({:?})", f.evaluate(&[]))),
            Content::Text(text) => match parse_quantity(text) {
                Ok(quantity) => format!("({:?})", quantity.value),
                Err(_) => text.clone(),
            },
            Content::Refused => return None,
            other => {
                let message =
                    format!("parameter `{name}` is {} and cannot stand within a text", other.kind());
                self.log.add(Code::WrongType, site, message, "a number, a quantity or a text");
                return None;
            }
        })
    }
}

fn text_length(content: &Content) -> usize {
    if let Content::Text(text) = content { text.len() } else { 0 }
}

/// Bytes of texts and number of values in a node.
pub(crate) fn size(node: &Node) -> usize {
    match &node.content {
        Content::Text(text) => 1 + text.len(),
        Content::List(items) => 1 + items.iter().map(size).sum::<usize>(),
        Content::Table(table) => {
            1 + table.entries.iter().map(|entry| entry.key.len() + size(&entry.node)).sum::<usize>()
        }
        _ => 1,
    }
}

/// Bytes of the name that a text begins with.
fn name_length(text: &str) -> usize {
    text.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(text.len())
}
