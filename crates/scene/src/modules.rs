//! `[modules]`: parts of networks that are written once and placed often, each time with parameters of its own.
//!
//! `networks.NAME.modules.PART = { module = "wheel", parameters = { … } }` becomes a table that holds what the module
//! says, its parameters put in, so that all that follows reads it as though it had been written there. Modules hold
//! modules; whatever holds itself is refused. A name is looked up among the modules of the scene, then in the
//! [`catalogue`], then among the networks: an object serves as a module.

mod catalogue;

use std::collections::BTreeMap;

pub use catalogue::MODULES;

use crate::diagnostic::{Code, Log, Site};
use crate::document::{Content, Entry, Node, Table, parse};
use crate::keys::{did_you_mean, one_of};
use crate::parameters::{DEEPEST, overlaid, put_in, size};
use crate::source::{Source, Sources};
use crate::spec::parts::MODULE;

/// What a module puts into the part that it becomes.
const CONTENTS: [&str; 6] = ["masses", "links", "crowds", "modules", "ports", "connections"];
/// What a network may say beside, that says how it stands when it is simulated alone.
const OF_NETWORKS_ALONE: [&str; 5] = ["account", "rotate", "translate", "velocity", "system"];
/// Bytes and values that all modules together put into a scene, at most: a few that each hold the one before twice would
/// otherwise grow without bound.
const LARGEST: usize = 1 << 24;

/// Puts what modules say into the networks that name them.
pub fn expand(
    document: &mut Table,
    modules: Option<Entry>,
    parameters: &Table,
    sources: &mut Sources,
    log: &Log,
) {
    let modules = match modules.map(|entry| entry.node) {
        None => Table::default(),
        Some(Node { content: Content::Table(modules), .. }) => modules,
        Some(node) => {
            let site = Site { place: node.place, path: "modules".to_owned() };
            let message = format!("this is {}", node.content.kind());
            log.add(Code::WrongType, &site, message, "modules by name");
            return;
        }
    };
    let networks = document.get("networks").and_then(Node::as_table).cloned().unwrap_or_default();
    let has_parts =
        |entry: &Entry| entry.node.as_table().is_some_and(|network| network.get("modules").is_some());
    let of_catalogue = BTreeMap::new();
    let mut expansion = Expansion {
        modules: &modules,
        networks: &networks,
        of_catalogue,
        parameters,
        sources,
        log,
        open: Vec::new(),
        used: Vec::new(),
        left: LARGEST,
    };
    if networks.entries.iter().any(has_parts)
        && let Some(Node { content: Content::Table(networks), .. }) = document.get_mut("networks")
    {
        for entry in &mut networks.entries {
            let path = format!("networks.{}", entry.key);
            expansion.open = vec![entry.key.clone()];
            if let Content::Table(network) = &mut entry.node.content {
                expansion.parts(network, &path);
            }
        }
    }
    expansion.check_unused();
}

struct Expansion<'a> {
    modules: &'a Table,
    networks: &'a Table,
    /// What was asked for of the catalogue.
    of_catalogue: BTreeMap<&'static str, Table>,
    /// Of the scene.
    parameters: &'a Table,
    sources: &'a mut Sources,
    log: &'a Log,
    /// Modules being put in, outermost first.
    open: Vec<String>,
    used: Vec<String>,
    /// What may still be put in, see [`LARGEST`].
    left: usize,
}

impl Expansion<'_> {
    /// Fills the parts of a network or of a module.
    fn parts(&mut self, holder: &mut Table, path: &str) {
        let Some(Node { content: Content::Table(parts), .. }) = holder.get_mut("modules") else { return };
        for entry in &mut parts.entries {
            let path = format!("{path}.modules.{}", entry.key);
            self.part(&mut entry.node, &path);
        }
    }

    fn part(&mut self, node: &mut Node, path: &str) {
        let site = Site { place: node.place, path: path.to_owned() };
        let Content::Table(part) = &mut node.content else { return };
        let Some(named) = part.get("module") else {
            // what it is made of stands here
            self.parts(part, path);
            return;
        };
        let Content::Text(name) = &named.content else { return };
        let (name, site) = (name.clone(), Site { place: named.place, path: format!("{}.module", site.path) });
        if let Some(written) = CONTENTS.iter().find(|key| part.get(key).is_some()) {
            let message = format!("this part has `{written}` beside those of module `{name}`");
            self.log.add(
                Code::Conflict,
                &site,
                message,
                "a module taken as it is, or a part without `module`",
            );
            return;
        }
        if self.open.contains(&name) {
            let circle = self.open.iter().chain([&name]).cloned().collect::<Vec<_>>().join(" -> ");
            let message = format!("modules hold each other in a circle: {circle}");
            self.log.add(Code::Conflict, &site, message, "modules that do not hold themselves");
            return;
        }
        if self.open.len() > DEEPEST {
            let message = format!("module `{name}` is nested too deep");
            self.log.add(
                Code::TooLarge,
                &site,
                message,
                format!("at most {DEEPEST} modules within each other"),
            );
            return;
        }
        let Some(mut module) = self.find(&name, &site) else { return };
        let given = match part.remove("parameters").map(|entry| entry.node) {
            None => Table::default(),
            Some(Node { content: Content::Table(given), .. }) => given,
            Some(other) => {
                let site = Site { place: other.place, path: format!("{path}.parameters") };
                let message = format!("this is {}", other.content.kind());
                self.log.add(Code::WrongType, &site, message, "values by name");
                return;
            }
        };
        let own = match module.remove("parameters").map(|entry| entry.node.content) {
            Some(Content::Table(own)) => own,
            _ => Table::default(),
        };
        for entry in given.entries.iter().filter(|entry| own.get(&entry.key).is_none()) {
            let known: Vec<&str> = own.keys().collect();
            let hint = did_you_mean(&entry.key, known.iter().copied());
            let site = Site { place: entry.key_place, path: format!("{path}.parameters.{}", entry.key) };
            let message = format!("module `{name}` has no parameter `{}`{hint}", entry.key);
            self.log.add(Code::UnknownParameter, &site, message, one_of(&known));
        }
        let parameters = overlaid(&overlaid(self.parameters, &own), &given);
        put_in(&mut module, &parameters, path, self.log);
        let added: usize = module.entries.iter().map(|entry| size(&entry.node)).sum();
        let Some(left) = self.left.checked_sub(added) else {
            let message = format!("module `{name}` makes the scene too large");
            let expected = format!("at most {LARGEST} bytes and values put in by modules");
            self.log.add(Code::TooLarge, &site, message, expected);
            return;
        };
        self.left = left;
        self.open.push(name);
        self.parts(&mut module, path);
        self.open.pop();
        let contents = module.entries.into_iter().filter(|entry| CONTENTS.contains(&entry.key.as_str()));
        part.entries.extend(contents);
    }

    /// The module of a name, checked to be one.
    fn find(&mut self, name: &str, site: &Site) -> Option<Table> {
        if let Some(node) = self.modules.get(name) {
            if !self.used.iter().any(|used| used == name) {
                self.used.push(name.to_owned());
            }
            let module = node.as_table().cloned();
            if module.is_none() {
                let site = Site { place: node.place, path: format!("modules.{name}") };
                let message = format!("this is {}", node.content.kind());
                self.log.add(Code::WrongType, &site, message, "a table with masses, links or modules");
            }
            return module.filter(|module| self.is_module(module, &format!("modules.{name}")));
        }
        if let Ok(entry) = MODULES.find(name) {
            let (sources, log) = (&mut *self.sources, self.log);
            let table = self.of_catalogue.entry(entry.name).or_insert_with(|| {
                let source = Source {
                    name: format!("module {}", entry.name),
                    folder: std::path::PathBuf::new(),
                    text: entry.build.to_owned(),
                };
                let source = sources.add_of_catalogue(source);
                parse(sources, source, log)
            });
            return Some(table.clone());
        }
        if let Some(network) = self.networks.get(name).and_then(Node::as_table) {
            let fits = |key: &str| CONTENTS.contains(&key) || OF_NETWORKS_ALONE.contains(&key);
            if let Some(other) = network.keys().find(|key| !fits(key)) {
                let message = format!("network `{name}` has `{other}`, which no part of another has");
                let expected = format!("a network of {} alone", CONTENTS.join(", "));
                self.log.add(Code::Conflict, site, message, expected);
                return None;
            }
            return Some(network.clone());
        }
        let mut known: Vec<&str> = self.modules.keys().collect();
        known.extend(MODULES.entries.iter().map(|entry| entry.name));
        known.extend(self.networks.keys());
        let hint = did_you_mean(name, known.iter().copied());
        self.log.add(Code::UnknownName, site, format!("there is no module `{name}`{hint}"), one_of(&known));
        None
    }

    /// Whether all keys are those of a module; reports the others.
    fn is_module(&self, module: &Table, path: &str) -> bool {
        let known = MODULE.known();
        let wrong: Vec<&Entry> =
            module.entries.iter().filter(|entry| MODULE.find(&entry.key).is_none()).collect();
        for entry in &wrong {
            let hint = did_you_mean(&entry.key, known.iter().copied());
            let site = Site { place: entry.key_place, path: format!("{path}.{}", entry.key) };
            let message = format!("a module has no key `{}`{hint}", entry.key);
            self.log.add(Code::UnknownKey, &site, message, one_of(&known));
        }
        wrong.is_empty()
    }

    /// Modules that no network places are read as little as unused parameters are, but misspelt keys are told.
    fn check_unused(&self) {
        for entry in self.modules.entries.iter().filter(|entry| !self.used.contains(&entry.key)) {
            if let Some(module) = entry.node.as_table() {
                self.is_module(module, &format!("modules.{}", entry.key));
            }
        }
    }
}
