//! Values set from the command line: `--set bodies.bar.material.youngs_modulus="2 MPa"`.
//!
//! A path names keys by `.`, those that are more than a word in quotes, and items of lists by `[index]`. A value is read as TOML, or as text where it is none
//! (`5ms`, `linear`); nothing behind the `=` takes what is there out. Keys that may be written can be set even where the scene leaves them out, and a whole item behind the
//! last one of a list, or a whole table of a new name among bodies, probes and the like; parts are set of those that are there, and of the system
//! `main` that a scene has where it writes none. Files are relative to the current folder, as everything on the command line is.

use std::path::PathBuf;

use crate::diagnostic::{Code, Fault, Log, Site};
use crate::document::{Content, Entry, Node, Table, parse_value};
use crate::keys::{Keys, Shape, did_you_mean, one_of};
use crate::path::{self, Step};
use crate::source::{Place, Source, Sources};
use crate::spec::SCENE;
use crate::spec::world::{DEFAULT_STEPPER, DEFAULT_SYSTEM};

/// The name of the text of a setting.
const NAME: &str = "--set";

/// Whether a text is a setting of the command line.
pub fn is_one(source: &Source) -> bool {
    source.name == NAME
}

/// What stands beside an energy and says what it is.
const BESIDE_ENERGY: [&str; 2] = ["parameters", "definitions"];

/// The settings of parts of what a path leads to, of it, or of what is read with it.
pub fn within<'a>(path: &str, sources: &'a Sources) -> impl Iterator<Item = &'a str> {
    let starts_with = |set: &str, path: &str| {
        set.strip_prefix(path).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
    };
    let is_within = move |text: &&str| {
        let set = path::assignment(text).map_or(*text, |(set, _)| set).trim();
        // an energy is read together with its constants and the names of its parts
        let law = path.strip_suffix(".energy");
        let is_of_law =
            |law: &str| BESIDE_ENERGY.iter().any(|beside| starts_with(set, &format!("{law}.{beside}")));
        starts_with(set, path) || law.is_some_and(is_of_law)
    };
    let settings = sources.iter().filter(|source| is_one(source)).map(|source| &*source.text);
    settings.filter(is_within)
}

/// Sets what `overrides` (`path=value`) say in a document.
pub fn apply(document: &mut Table, overrides: &[String], sources: &mut Sources, log: &Log) {
    for text in overrides {
        let source = Source { name: NAME.to_owned(), folder: PathBuf::new(), text: text.clone() };
        let source = sources.add(source);
        let whole = Place { source, start: 0, end: text.len() };
        let Some((path, value)) = path::assignment(text) else {
            let site = Site { place: whole, path: String::new() };
            log.add(Code::BadOverride, &site, "this sets nothing", "path=value, such as world.period=5ms");
            continue;
        };
        let node = parse_value(value, source, path.len() + 1);
        let place = Place { source, start: 0, end: path.len() };
        let path = path.trim();
        let Some(steps) = path::steps(path) else {
            let site = Site { place, path: path.to_owned() };
            log.add(
                Code::BadOverride,
                &site,
                "this is no path",
                "keys with dots, in quotes where they are more than a word, such as bodies.bar.pins[0].axes",
            );
            continue;
        };
        let setting = Setting { path, place, log };
        if value.trim().is_empty() {
            setting.take_out(document, &steps);
            continue;
        }
        if let [Step::Key("systems"), Step::Key(DEFAULT_SYSTEM), ..] = steps[..] {
            write_default_system(document, place);
        }
        setting.set(document, Some(&SCENE), &steps, node);
    }
}

/// Writes the system that a scene has where it writes none, so that it can be set.
fn write_default_system(document: &mut Table, place: Place) {
    if document.get("systems").is_some() {
        return;
    }
    let entry =
        |key: &str, content| Entry { key: key.to_owned(), key_place: place, node: Node::new(place, content) };
    let stepper = entry("stepper", Content::Text(DEFAULT_STEPPER.to_owned()));
    let system = entry(DEFAULT_SYSTEM, Content::Table(Table { entries: vec![stepper] }));
    document.entries.push(entry("systems", Content::Table(Table { entries: vec![system] })));
}

/// Whether what is left of a path and what it is set to are a table of a new name as a whole.
fn is_new(steps: &[Step], value: &Node) -> bool {
    matches!((steps, &value.content), ([Step::Key(_)], Content::Table(_)))
}

struct Setting<'a> {
    path: &'a str,
    place: Place,
    log: &'a Log,
}

impl Setting<'_> {
    fn refuse(&self, message: String, expected: String) {
        let site = Site { place: self.place, path: self.path.to_owned() };
        self.log.push(Fault {
            code: Code::UnknownPath,
            site,
            value: Some(self.path.to_owned()),
            expected,
            message,
        });
    }

    /// Takes what `steps` lead to out of `table`.
    fn take_out(&self, table: &mut Table, steps: &[Step]) {
        let Some((last, way)) = steps.split_last() else { return };
        let mut at = Content::Table(std::mem::take(table));
        let mut node = Some(&mut at);
        for step in way {
            node = match (node, step) {
                (Some(Content::Table(table)), Step::Key(name)) => {
                    table.get_mut(name).map(|node| &mut node.content)
                }
                (Some(Content::List(items)), Step::Item(index)) => {
                    items.get_mut(*index).map(|node| &mut node.content)
                }
                _ => None,
            };
        }
        let is_out = match (node, last) {
            (Some(Content::Table(table)), Step::Key(name)) => {
                let count = table.entries.len();
                table.entries.retain(|entry| entry.key != *name);
                table.entries.len() < count
            }
            (Some(Content::List(items)), Step::Item(index)) if *index < items.len() => {
                items.remove(*index);
                true
            }
            _ => false,
        };
        if let Content::Table(whole) = at {
            *table = whole;
        }
        if !is_out {
            let message = format!("the scene has no `{}` to take out", self.path);
            self.refuse(message, "a path that it has".to_owned());
        }
    }

    /// Sets what `steps` lead to from `table`, whose keys are `keys` as far as they are known.
    fn set(&self, table: &mut Table, keys: Option<&'static Keys>, steps: &[Step], value: Node) {
        let [Step::Key(name), rest @ ..] = steps else {
            return self.refuse("a table has keys, not items".to_owned(), "a key".to_owned());
        };
        let shape = keys.and_then(|keys| keys.find(name)).map(|key| key.shape);
        if table.get(name).is_none() {
            let known = || table.keys().chain(keys.iter().flat_map(|keys| keys.known()));
            // the parameters of entries are checked where the entry is read
            let may_be_written = match keys {
                Some(keys) => shape.is_some() || !matches!(keys.others, crate::keys::Others::Refused),
                None => true,
            };
            let names_a_table = match shape {
                Some(Shape::Tables(_)) => !rest.is_empty(),
                Some(Shape::Named(_)) => !rest.is_empty() && !is_new(rest, &value),
                _ => false,
            };
            if !may_be_written || names_a_table {
                let mut names: Vec<&str> = known().collect();
                names.sort_unstable();
                names.dedup();
                if names.contains(name) {
                    let message =
                        format!("the scene has no `{name}` in `{}` of which a part could be set", self.path);
                    return self.refuse(
                        message,
                        format!("`{name}` as a whole, its tables and lists with all that they need"),
                    );
                }
                let hint = did_you_mean(name, names.iter().copied());
                let message = format!("the scene has no `{name}` in `{}`{hint}", self.path);
                return self.refuse(message, one_of(&names));
            }
            let empty = || Node::new(value.place, Content::Table(Table::default()));
            let node = if rest.is_empty() { value.clone() } else { empty() };
            table.entries.push(Entry { key: (*name).to_owned(), key_place: self.place, node });
        }
        let Some(node) = table.get_mut(name) else { return };
        self.set_within(node, shape, rest, value);
    }

    fn set_within(&self, node: &mut Node, shape: Option<Shape>, steps: &[Step], value: Node) {
        match (&mut node.content, steps) {
            (_, []) => *node = value,
            (Content::List(items), [Step::Item(index), rest @ ..]) => {
                let count = items.len();
                match items.get_mut(*index) {
                    Some(item) => {
                        let shape = match shape {
                            Some(Shape::Tables(keys)) => Some(Shape::Table(keys)),
                            _ => None,
                        };
                        self.set_within(item, shape, rest, value);
                    }
                    None if *index == count && rest.is_empty() => items.push(value),
                    None => self.refuse(
                        format!("the list in `{}` has {count} items, none of number {index}", self.path),
                        match rest {
                            [] => format!("an index below {count}, or {count} for one more"),
                            _ => format!("an index below {count}"),
                        },
                    ),
                }
            }
            (Content::Table(table), [Step::Key(name), rest @ ..]) => match shape {
                Some(Shape::Table(keys)) => self.set(table, Some(keys), steps, value),
                Some(Shape::Named(keys)) => match table.get_mut(name) {
                    Some(item) => self.set_within(item, Some(Shape::Table(keys)), rest, value),
                    None if is_new(steps, &value) => {
                        let key = (*name).to_owned();
                        table.entries.push(Entry { key, key_place: self.place, node: value });
                    }
                    None => {
                        let names: Vec<&str> = table.keys().collect();
                        let hint = did_you_mean(name, names.iter().copied());
                        let message = format!("the scene has no `{name}` in `{}`{hint}", self.path);
                        let whole = format!("`{name}={{ … }}`, a new one as a whole");
                        let expected =
                            if names.is_empty() { whole } else { format!("{}, or {whole}", one_of(&names)) };
                        self.refuse(message, expected);
                    }
                },
                Some(Shape::Values) if table.get(name).is_none() => {
                    let names: Vec<&str> = table.keys().collect();
                    let hint = did_you_mean(name, names.iter().copied());
                    self.refuse(format!("the scene has no parameter `{name}`{hint}"), one_of(&names));
                }
                _ => self.set(table, None, steps, value),
            },
            // "backward_euler" becomes { name = "backward_euler" } to take a parameter
            (Content::Text(text), [Step::Key(_), ..]) if matches!(shape, Some(Shape::Entry(_))) => {
                let Some(Shape::Entry(entry)) = shape else { return };
                let content = Content::Text(std::mem::take(text));
                let name = Node { layout: node.layout.clone(), ..Node::new(node.place, content) };
                let tag = Entry { key: entry.tag.to_owned(), key_place: node.place, node: name };
                let mut table = Table { entries: vec![tag] };
                self.set(&mut table, None, steps, value);
                node.content = Content::Table(table);
            }
            (content, [step, ..]) => {
                let wanted = match step {
                    Step::Key(name) => format!("the key `{name}`"),
                    Step::Item(index) => format!("item {index}"),
                };
                self.refuse(
                    format!("`{}` asks {} for {wanted}", self.path, content.kind()),
                    "an existing path".to_owned(),
                );
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(text: &str, overrides: &[&str]) -> (Table, usize) {
        let (mut sources, log) = (Sources::default(), Log::default());
        let source =
            sources.add(Source { name: "x".to_owned(), folder: PathBuf::new(), text: text.to_owned() });
        let mut table = crate::document::parse(&sources, source, &log);
        let overrides: Vec<String> = overrides.iter().map(|&text| text.to_owned()).collect();
        apply(&mut table, &overrides, &mut sources, &log);
        (table, log.into_diagnostics(&sources).0.len())
    }

    /// Numbers, texts without quotes, items of lists and keys that were left out can be set.
    #[test]
    fn values_are_set() {
        let text = "[world]\nperiod = 1\n[bodies.a]\nmaterial = \"x\"\n[[bodies.a.pins]]\nregion = \"y\"\n";
        let overrides = [
            "world.period=5ms",
            "world.gravity=[0,0,1]",
            "bodies.a.pins[0].axes=xy",
            "bodies.a.material.density=1",
        ];
        let (table, faults) = set(text, &overrides);
        assert_eq!(faults, 0);
        let world = table.get("world").and_then(Node::as_table).expect("a table");
        assert_eq!(world.get("period").map(|node| &node.content), Some(&Content::Text("5ms".to_owned())));
        assert!(matches!(world.get("gravity").map(|node| &node.content), Some(Content::List(_))));
        let body =
            table.get("bodies").and_then(Node::as_table).and_then(|t| t.get("a")).and_then(Node::as_table);
        let material = body.and_then(|body| body.get("material")).and_then(Node::as_table).expect("a table");
        assert_eq!(material.keys().collect::<Vec<_>>(), ["name", "density"]);
    }

    /// A table of a new name is added as a whole, also where there is none of its kind; a part of one is not.
    #[test]
    fn new_tables_are_added() {
        let text = "[world]\nperiod = 1\n[bodies.a]\ndrag = 1\n";
        let overrides = [
            "bodies.b={ drag = 2 }",
            "bodies.b.drag=3",
            "bodies.\"c.d\"={ drag = 4 }",
            "bodies.'c.d'.drag=5",
            "probes.new={body=\"a\",quantity=\"position\"}",
        ];
        let (table, faults) = set(text, &overrides);
        assert_eq!(faults, 0);
        let of = |kind: &str| table.get(kind).and_then(Node::as_table).expect("a table").clone();
        assert_eq!(of("bodies").keys().collect::<Vec<_>>(), ["a", "b", "c.d"]);
        let added = of("bodies").get("b").and_then(Node::as_table).expect("a body").clone();
        assert_eq!(added.get("drag").map(|node| &node.content), Some(&Content::Integer(3)));
        assert_eq!(of("probes").keys().collect::<Vec<_>>(), ["new"]);
        for bad in [
            "bodies.b=2",
            "bodies.\"=={}",
            "probes.new=position",
            "probes.new.body=a",
            "worlds.b={}",
            "world.b={}",
        ] {
            assert_eq!(set(text, &[bad]).1, 1, "{bad}");
        }
    }

    /// Keys and items are taken out; what is not there is not.
    #[test]
    fn parts_are_taken_out() {
        let text = "[world]\nperiod = 1\n[bodies.a]\nlist = [1, 2, 3]\n[bodies.a.adapt]\nback = 0\n";
        let (table, faults) = set(text, &["bodies.a.adapt=", "bodies.a.list[1]= "]);
        assert_eq!(faults, 0);
        let body =
            table.get("bodies").and_then(Node::as_table).and_then(|t| t.get("a")).and_then(Node::as_table);
        let body = body.expect("a table");
        assert_eq!(body.keys().collect::<Vec<_>>(), ["list"]);
        assert!(
            matches!(body.get("list").map(|node| &node.content), Some(Content::List(items)) if items.len() == 2)
        );
        for missing in [
            "systems.main=",
            "bodies.a.adpat=",
            "bodies.b.adapt=",
            "bodies.a.list[3]=",
            "bodies.a.list.x=",
            "world.period.x=",
        ] {
            assert_eq!(set(text, &[missing]).1, 1, "{missing}");
        }
    }

    /// The system that stands where none is written can be set, and only it.
    #[test]
    fn the_default_system_is_set() {
        let text = "[world]\nperiod = 1\n";
        let overrides = ["systems.main.steps_per_period=4", "systems.main.newton_tolerance=1e-9"];
        let (table, faults) = set(text, &overrides);
        assert_eq!(faults, 0);
        let systems = table.get("systems").and_then(Node::as_table).expect("systems");
        let main = systems.get("main").and_then(Node::as_table).expect("the system");
        assert_eq!(main.keys().collect::<Vec<_>>(), ["stepper", "steps_per_period", "newton_tolerance"]);
        assert_eq!(set(text, &["systems.other.steps_per_period=4"]).1, 1);
        let written = "[world]\nperiod = 1\n[systems.fast]\nstepper = \"verlet\"\n";
        assert_eq!(set(written, &["systems.main.steps_per_period=4"]).1, 1);
    }

    /// A path that leads nowhere is refused.
    #[test]
    fn unknown_paths_are_refused() {
        let text = "[world]\nperiod = 1\n[bodies.a]\npins = []\n";
        for bad in [
            "world.peroid=1",
            "wolrd.period=1",
            "bodies.b.drag=1",
            "bodies.a.pins[0].axes=x",
            "world.period.x=1",
            "period",
            "a..b=1",
            "a[=1",
        ] {
            assert_eq!(set(text, &[bad]).1, 1, "{bad}");
        }
    }
}
