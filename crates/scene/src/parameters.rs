//! `[parameters]`: values named once and used as `"$name"`, alone or within formulas and other texts.
//!
//! A text that is nothing but `"$name"` becomes the parameter's value, whatever that is. Within a longer text a
//! parameter stands for its number in SI units, so that `"2 * $stiffness"` and `"$amplitude * sin(t)"` work.

use souple_formal::{Formula, parse_quantity};
use souple_table::nearest;

use crate::diagnostic::{Code, Log, Site};
use crate::document::{Content, Node, Table};

/// Parameters within parameters, at most; more is a cycle.
const DEEPEST: usize = 32;

/// Puts the parameters of a document in and takes their table out.
pub fn substitute(document: &mut Table, log: &Log) {
    let Some(entry) = document.remove("parameters") else {
        let none = Table::default();
        Substitution { parameters: &none, log }.table(document, "", 0);
        return;
    };
    let Content::Table(parameters) = entry.node.content else {
        let site = Site { place: entry.node.place, path: "parameters".to_owned() };
        log.add(
            Code::WrongType,
            &site,
            format!("this is {}", entry.node.content.kind()),
            "a table of named values",
        );
        return;
    };
    Substitution { parameters: &parameters, log }.table(document, "", 0);
}

struct Substitution<'a> {
    parameters: &'a Table,
    log: &'a Log,
}

impl Substitution<'_> {
    fn table(&self, table: &mut Table, path: &str, depth: usize) {
        for entry in &mut table.entries {
            let separator = if path.is_empty() { "" } else { "." };
            let path = format!("{path}{separator}{}", entry.key);
            self.node(&mut entry.node, &path, depth);
        }
    }

    fn node(&self, node: &mut Node, path: &str, depth: usize) {
        match &mut node.content {
            Content::Table(table) => self.table(table, path, depth),
            Content::List(items) => {
                for (index, item) in items.iter_mut().enumerate() {
                    self.node(item, &format!("{path}[{index}]"), depth);
                }
            }
            Content::Text(text) if text.contains('$') => {
                let text = std::mem::take(text);
                let site = Site { place: node.place, path: path.to_owned() };
                let (content, computed) = self.text(&text, &site, depth);
                node.content = content;
                node.computed = computed;
            }
            _ => {}
        }
    }

    /// What a text with `$` in it becomes, and whether it may be a formula.
    fn text(&self, text: &str, site: &Site, depth: usize) -> (Content, bool) {
        if let Some(name) = text.strip_prefix('$')
            && name_length(name) == name.len()
        {
            return match self.value(name, site, depth) {
                Some(node) => (node.content, node.computed),
                None => (Content::Text(text.to_owned()), false),
            };
        }
        let mut result = String::new();
        let mut rest = text;
        while let Some((before, after)) = rest.split_once('$') {
            result.push_str(before);
            let length = name_length(after);
            let (name, behind) = after.split_at(length);
            if name.is_empty() {
                self.log.add(
                    Code::UnknownParameter,
                    site,
                    "`$` without a name",
                    "`$` and the name of a parameter",
                );
            } else if let Some(node) = self.value(name, site, depth) {
                result.push_str(&self.within(name, &node, site));
            }
            rest = behind;
        }
        result.push_str(rest);
        (Content::Text(result), true)
    }

    /// The parameter's value, parameters in it put in.
    fn value(&self, name: &str, site: &Site, depth: usize) -> Option<Node> {
        let Some(node) = self.parameters.get(name) else {
            let near = nearest(name, self.parameters.keys());
            let hint = near.map(|near| format!(" (did you mean `${near}`?)")).unwrap_or_default();
            let known: Vec<&str> = self.parameters.keys().collect();
            let expected = if known.is_empty() {
                "a table [parameters] with it".to_owned()
            } else {
                format!("one of {}", known.join(", "))
            };
            self.log.add(
                Code::UnknownParameter,
                site,
                format!("there is no parameter `{name}`{hint}"),
                expected,
            );
            return None;
        };
        if depth == DEEPEST {
            let message = format!("parameter `{name}` is made of itself");
            self.log.add(
                Code::UnknownParameter,
                site,
                message,
                "parameters that do not refer to each other in a circle",
            );
            return None;
        }
        let mut node = node.clone();
        self.node(&mut node, &format!("parameters.{name}"), depth + 1);
        Some(node)
    }

    /// A parameter as it stands within a longer text: a number in parentheses, or a text as it is.
    fn within(&self, name: &str, node: &Node, site: &Site) -> String {
        match &node.content {
            Content::Integer(number) => format!("({number})"),
            // the exact number again when read: the shortest decimal that rounds to it
            Content::Number(number) => format!("({number:?})"),
            Content::Text(text) if node.computed => Formula::compile(text, &[])
                .map_or_else(|_| format!("({text})"), |f| format!("({:?})", f.evaluate(&[]))),
            Content::Text(text) => match parse_quantity(text) {
                Ok(quantity) => format!("({:?})", quantity.value),
                Err(_) => text.clone(),
            },
            other => {
                let message =
                    format!("parameter `{name}` is {} and cannot stand within a text", other.kind());
                self.log.add(Code::WrongType, site, message, "a number, a quantity or a text");
                String::new()
            }
        }
    }
}

/// Bytes of the name that a text begins with.
fn name_length(text: &str) -> usize {
    text.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(text.len())
}
