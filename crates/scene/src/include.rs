//! Files that take in others: `include = ["material.toml"]`.
//!
//! What the including file writes wins. Tables are merged key by key, except those that name what they are
//! (`name`, `generate`, `file`), which replace each other whole; lists of tables are joined.

use std::path::{Path, PathBuf};

use crate::diagnostic::{Code, Fault, Log, Site};
use crate::document::{Content, Node, Table, parse};
use crate::source::{Place, Source, Sources};

/// Files within files, at most.
const DEEPEST: usize = 32;
/// Largest scene file [bytes].
const LARGEST: u64 = 64 << 20;
/// A table with one of these is a value of its own.
const TAGS: [&str; 3] = ["name", "generate", "file"];

/// A scene's text and all it includes, as one table.
pub struct Includer<'a> {
    pub sources: &'a mut Sources,
    pub log: &'a Log,
    /// Files being read, outermost first: meeting one again is a cycle.
    open: Vec<PathBuf>,
}

impl<'a> Includer<'a> {
    pub fn new(sources: &'a mut Sources, log: &'a Log) -> Self {
        Self { sources, log, open: Vec::new() }
    }

    /// Reads a file; `from` is where another file asks for it.
    pub fn read_file(&mut self, path: &Path, from: Option<Site>) -> Option<Table> {
        let name = path.display().to_string();
        let site = from.unwrap_or_else(|| {
            let empty = Source { name: name.clone(), folder: PathBuf::new(), text: String::new() };
            Site { place: Place::start_of(self.sources.add(empty)), path: String::new() }
        });
        let refuse = |code: Code, message: String, expected: &str| {
            let fault = Fault {
                code,
                site: site.clone(),
                value: Some(name.clone()),
                expected: expected.to_owned(),
                message,
            };
            self.log.push(fault);
            None
        };
        if let Some(text) = self.sources.text_in_library(path) {
            let folder = path.parent().map(Path::to_owned).unwrap_or_default();
            // the library holds what was read once: its includes end
            return Some(self.read_text(Source { name, folder, text }));
        }
        let canonical = match path.canonicalize() {
            Ok(canonical) => canonical,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                return refuse(
                    Code::NotFound,
                    format!("there is no file `{name}`"),
                    "an existing scene file",
                );
            }
            Err(error) => {
                return refuse(Code::Unreadable, format!("`{name}`: {error}"), "a file that can be read");
            }
        };
        if self.open.contains(&canonical) || self.open.len() == DEEPEST {
            let chain: Vec<_> =
                self.open.iter().chain([&canonical]).map(|p| p.display().to_string()).collect();
            let message = format!("the include goes round in a circle: {}", chain.join(" -> "));
            return refuse(Code::CyclicInclude, message, "files that do not include each other");
        }
        let size = std::fs::metadata(&canonical)
            .map_or(0, |data| if data.is_file() { data.len() } else { u64::MAX });
        if size == u64::MAX {
            let what = if canonical.is_dir() { "is a folder without a scene.toml" } else { "is no file" };
            let expected = "a scene file, or a folder with a scene.toml";
            return refuse(Code::Unreadable, format!("`{name}` {what}"), expected);
        }
        if size > LARGEST {
            return refuse(
                Code::TooLarge,
                format!("`{name}` has {size} bytes"),
                "a scene file of at most 64 MiB",
            );
        }
        let bytes = match std::fs::read(&canonical) {
            Ok(bytes) => bytes,
            Err(error) => {
                return refuse(Code::Unreadable, format!("`{name}`: {error}"), "a file that can be read");
            }
        };
        let text = match String::from_utf8(bytes) {
            Ok(text) => text,
            Err(error) => {
                let at = error.utf8_error().valid_up_to();
                let message = format!("`{name}` is no text: byte {at} is not UTF-8");
                return refuse(Code::NotText, message, "a scene in TOML, a text in UTF-8");
            }
        };
        let folder = path.parent().map(Path::to_owned).unwrap_or_default();
        self.open.push(canonical);
        let table = self.read_text(Source { name, folder, text });
        self.open.pop();
        Some(table)
    }

    /// Reads a text and what it includes.
    pub fn read_text(&mut self, source: Source) -> Table {
        let folder = source.folder.clone();
        let source = self.sources.add(source);
        let mut table = parse(self.sources, source, self.log);
        let Some(include) = table.remove("include") else { return table };
        let mut base = Table::default();
        for (path, site) in self.include_list(&include.node) {
            if let Some(included) = self.read_file(&folder.join(path), Some(site)) {
                base = merged(base, included);
            }
        }
        merged(base, table)
    }

    fn include_list(&self, node: &Node) -> Vec<(String, Site)> {
        let site = |node: &Node, path: String| Site { place: node.place, path };
        let items = match &node.content {
            Content::List(items) => items.iter().collect(),
            _ => vec![node],
        };
        let mut files = Vec::new();
        for (index, item) in items.into_iter().enumerate() {
            let site = site(item, format!("include[{index}]"));
            match &item.content {
                Content::Text(text) => files.push((text.clone(), site)),
                other => {
                    let message = format!("this is {}", other.kind());
                    self.log.add(
                        Code::WrongType,
                        &site,
                        message,
                        "a list of files, such as [\"other.toml\"]",
                    );
                }
            }
        }
        files
    }
}

/// `base` with `over` laid upon it.
fn merged(mut base: Table, over: Table) -> Table {
    for entry in over.entries {
        match base.get_mut(&entry.key) {
            Some(below) => *below = merged_node(below.clone(), entry.node),
            None => base.entries.push(entry),
        }
    }
    base
}

fn merged_node(base: Node, over: Node) -> Node {
    let is_tagged = |table: &Table| TAGS.iter().any(|tag| table.get(tag).is_some());
    let Node { place, content: laid, computed, layout } = over;
    let content = match (base.content, laid) {
        (Content::Table(base), Content::Table(over)) if !is_tagged(&over) => {
            Content::Table(merged(base, over))
        }
        (Content::List(mut base), Content::List(over)) if is_table_list(&base) && is_table_list(&over) => {
            base.extend(over);
            Content::List(base)
        }
        (_, over) => over,
    };
    Node { place, content, computed, layout }
}

fn is_table_list(items: &[Node]) -> bool {
    !items.is_empty() && items.iter().all(|item| item.as_table().is_some())
}
