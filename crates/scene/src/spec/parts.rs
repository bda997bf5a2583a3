//! Networks made of parts: modules that are placed in a network, their ports, and what connects them.
//!
//! A module shows communication points to the outside: an `M` point gives a position and takes forces, an `L` point
//! takes a position and gives a force. An `M` is of masses; an `L` is the end of links whose masses are elsewhere. What joins
//! them is checked here: one `M` to each `L`, as many `L` to an `M` as there are. Of all this nothing is left when the
//! network steps: it is one network of masses and links.

use std::collections::BTreeMap;
use std::ops::Range;

use souple_math::Vec3;
use souple_models::network::Span;
use souple_table::{Range as Interval, Value};

use super::body::{Placement, ROTATION};
use super::network::{CROWD, CrowdSpec, LINK_TABLE, LinkTable, MASSES, MASSES_MAX, MassGroup};
use super::view::ViewSpec;
use crate::diagnostic::{Code, Log, Site};
use crate::keys::{Key, Keys, Shape, did_you_mean, one_of};
use crate::reader::Reader;

static PORT: Keys = Keys::new(
    "port",
    "a communication point that a module shows to the outside",
    &[
        Key::new(
            "kind",
            Shape::Choice(&["M", "L"]),
            "M of masses: position out, forces in; L of ends of links: position in, force out",
        )
        .required(),
        Key::new(
            "of",
            Shape::Text,
            "of M the masses: a group, a part, or a port of a part; L has none: links and connections here name it as they \
             would a group",
        ),
        Key::integer(
            "mass",
            Interval::closed(-MASSES_MAX, MASSES_MAX),
            "of M only this one, counted from 0, or from the last backwards: -1; all where left out",
        ),
    ],
);

static CONNECTION: Keys = Keys::new(
    "connection",
    "an M and an L that are joined",
    &[
        Key::new("M", Shape::Text, "a group, a part, or a port M of a part").required(),
        Key::new("L", Shape::Text, "a port L of a part").required(),
    ],
);

pub(super) const PARTS_SUMMARY: &str = "modules placed in it, by name";
const PORTS_SUMMARY: &str = "what it shows to the outside when it is a module";
const CONNECTIONS_SUMMARY: &str = "which M is joined to which L of its parts";

/// What a network has of these.
pub(super) const PORTS_KEY: Key = Key::new("ports", Shape::Named(&PORT), PORTS_SUMMARY);
pub(super) const CONNECTIONS_KEY: Key =
    Key::new("connections", Shape::Tables(&CONNECTION), CONNECTIONS_SUMMARY);

pub(crate) static MODULE: Keys = Keys::new(
    "module",
    "masses, links and modules that are written once and placed often",
    &[
        Key::new("summary", Shape::Text, "what it is, in a line"),
        Key::new(
            "parameters",
            Shape::Values,
            "values used as \"$name\" within it, unless a part gives others",
        ),
        Key::new("masses", Shape::Named(&MASSES), "groups of masses"),
        Key::new("links", Shape::Tables(&LINK_TABLE), "what acts between masses"),
        Key::new("crowds", Shape::Tables(&CROWD), "what acts between masses wherever they come near"),
        Key::new("modules", Shape::Named(&PART), PARTS_SUMMARY),
        PORTS_KEY,
        CONNECTIONS_KEY,
    ],
);

/// A part of a network: what a module says stands in it by the time it is read (see [`crate::modules`]).
pub(crate) static PART: Keys = Keys::new(
    "part",
    "a module placed in a network: a name of `modules`, of the catalogue or of another network; or what it is made of, written here",
    &[
        Key::new("module", Shape::Text, "which one"),
        Key::new("parameters", Shape::Values, "in place of those of the module"),
        Key::new("rotate", Shape::Table(&ROTATION), "turns it, before it is translated"),
        Key::vector("translate", "m", "moves it").or(Value::Vector([0.0; 3])),
        Key::vector("velocity", "m/s", "at the start, over that of its masses").or(Value::Vector([0.0; 3])),
        Key::new("masses", Shape::Named(&MASSES), "groups of masses"),
        Key::new("links", Shape::Tables(&LINK_TABLE), "what acts between masses"),
        Key::new("crowds", Shape::Tables(&CROWD), "what acts between masses wherever they come near"),
        Key::new("modules", Shape::Named(&PART), PARTS_SUMMARY),
        PORTS_KEY,
        CONNECTIONS_KEY,
    ],
);

/// Masses and what acts between them, of a network and all its parts.
pub struct Assembly {
    pub masses: Vec<MassGroup>,
    pub links: Vec<LinkTable>,
    pub crowds: Vec<CrowdSpec>,
    /// Numbers of the masses of parts and of ports.
    pub presented: Vec<(String, Range<u32>)>,
    /// What links may see in the place of masses; their numbers are presented too.
    pub views: Vec<ViewSpec>,
}

/// How a part stands in what holds it.
#[derive(Clone)]
pub struct Standing {
    pub placement: Placement,
    /// [m/s]
    pub velocity: Vec3,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum PortKind {
    M,
    L,
}

struct Port {
    name: String,
    kind: PortKind,
    of: String,
    mass: Option<i64>,
    site: Site,
}

struct Connection {
    m: String,
    l: String,
    site: Site,
}

/// A network, or a part of one.
struct Part<'a> {
    /// From the network on, such as `car.wheel`; empty for the network.
    path: String,
    site: Site,
    /// Names of its own groups, as they are written.
    groups: Vec<String>,
    /// Names of points of view, of the network.
    views: Vec<String>,
    parts: Vec<(String, Part<'a>)>,
    ports: Vec<Port>,
    connections: Vec<Connection>,
    links: Vec<Reader<'a>>,
    crowds: Vec<Reader<'a>>,
    /// What it is turned by, innermost first.
    standing: Vec<Standing>,
    /// What its ports L are joined to.
    fed: BTreeMap<String, String>,
}

impl Assembly {
    pub(super) fn read(reader: &Reader) -> Self {
        let log = reader.log();
        let (masses, presented) = (Vec::new(), Vec::new());
        let mut all = Self { masses, links: Vec::new(), crowds: Vec::new(), presented, views: Vec::new() };
        let mut root = Part::open(String::new(), reader, Vec::new(), &mut all.masses);
        root.present(&mut all, log);
        root.see(reader, &mut all);
        root.require_feeds(log);
        root.connect(log);
        root.act(&mut all, log);
        all
    }

    /// The numbers of the masses of a group, a part or a port.
    fn numbers_of(&self, name: &str) -> Option<Range<u32>> {
        numbers_of(&self.masses, &self.presented, name)
    }
}

/// The numbers of the masses of a group, a part or a port.
pub(super) fn numbers_of(
    masses: &[MassGroup],
    presented: &[(String, Range<u32>)],
    name: &str,
) -> Option<Range<u32>> {
    let mut first = 0;
    for group in masses {
        let next = first + group.places.count() as u32;
        if group.name == name {
            return Some(first..next);
        }
        first = next;
    }
    presented.iter().find(|(known, _)| known == name).map(|(_, numbers)| numbers.clone())
}

impl Port {
    fn read(name: String, reader: &Reader) -> Self {
        let kind = if reader.choice("kind") == "L" { PortKind::L } else { PortKind::M };
        let (of, mass) = (reader.text("of"), reader.maybe_integer("mass"));
        let refuse = |key: &str, message: String, expected: &str| {
            reader.log().add(Code::Conflict, &reader.site_of(key), message, expected);
        };
        match kind {
            PortKind::M if of.is_empty() => {
                refuse("of", format!("port `{name}` is M of no masses"), "of = \"a group of masses\"");
            }
            PortKind::L if mass.is_some() || !of.is_empty() => {
                let key = if of.is_empty() { "mass" } else { "of" };
                refuse(
                    key,
                    format!("port `{name}` is L: its masses are outside"),
                    "no masses, or kind = \"M\"",
                );
            }
            _ => {}
        }
        Self { name, kind, of, mass, site: reader.site() }
    }

    /// The numbers it shows of these.
    fn narrowed(&self, numbers: Range<u32>, log: &Log) -> Range<u32> {
        let Some(mass) = self.mass else { return numbers };
        let count = numbers.len() as i64;
        let at = if mass < 0 { count + mass } else { mass };
        if !(0..count).contains(&at) {
            let message = format!("port `{}` shows mass {mass}, but `{}` has {count}", self.name, self.of);
            let expected = format!("a number from {} to {}", -count, count - 1);
            log.add(Code::OutOfRange, &self.site, message, expected);
            return numbers;
        }
        numbers.start + at as u32..numbers.start + at as u32 + 1
    }
}

impl<'a> Part<'a> {
    fn open(path: String, reader: &Reader<'a>, standing: Vec<Standing>, masses: &mut Vec<MassGroup>) -> Self {
        let mut part = Self {
            site: reader.site(),
            groups: Vec::new(),
            views: Vec::new(),
            parts: Vec::new(),
            ports: reader.named("ports").into_iter().map(|(name, port)| Port::read(name, &port)).collect(),
            connections: reader.tables("connections").iter().map(Connection::read).collect(),
            links: reader.tables("links"),
            crowds: reader.tables("crowds"),
            standing,
            fed: BTreeMap::new(),
            path,
        };
        for (name, group) in reader.named("masses") {
            masses.push(MassGroup::read(part.full(&name), &group).standing(&part.standing));
            part.groups.push(name);
        }
        for (name, inner) in reader.named("modules") {
            let own = Standing { placement: Placement::read(&inner), velocity: inner.vector("velocity") };
            let standing = [own].into_iter().chain(part.standing.iter().cloned()).collect();
            if part.groups.contains(&name) {
                let message = format!("there are a group of masses and a module `{name}`");
                reader.log().add(Code::Conflict, &inner.site(), message, "names that differ");
            }
            let inner = Part::open(part.full(&name), &inner, standing, masses);
            part.parts.push((name, inner));
        }
        part
    }

    /// A name within it as it is known to the network.
    fn full(&self, name: &str) -> String {
        if self.path.is_empty() { name.to_owned() } else { format!("{}.{name}", self.path) }
    }

    fn part(&self, name: &str) -> Option<&Part<'a>> {
        self.parts.iter().find(|(known, _)| known == name).map(|(_, part)| part)
    }

    fn port(&self, name: &str) -> Option<&Port> {
        self.ports.iter().find(|port| port.name == name)
    }

    /// Tells the network what masses its parts and their ports are of, from the innermost outwards.
    fn present(&self, all: &mut Assembly, log: &Log) {
        for (_, part) in &self.parts {
            part.present(all, log);
            let inside = format!("{}.", part.path);
            let mut numbers: Option<Range<u32>> = None;
            let mut first = 0;
            for group in &all.masses {
                let next = first + group.places.count() as u32;
                if group.name.starts_with(&inside) {
                    numbers = Some(numbers.map_or(first, |numbers| numbers.start)..next);
                }
                first = next;
            }
            all.presented.push((part.path.clone(), numbers.unwrap_or(0..0)));
        }
        for port in self.ports.iter().filter(|port| port.kind == PortKind::M && !port.of.is_empty()) {
            let numbers = match self.masses(&port.of) {
                Ok(name) => all.numbers_of(&name),
                Err(what) => {
                    self.refuse(&port.site, what, log);
                    None
                }
            };
            if let Some(numbers) = numbers {
                all.presented.push((self.full(&port.name), port.narrowed(numbers, log)));
            }
        }
    }

    /// What a name within it is of, as it is known to the network: masses, however they are named, or what a port L is joined to.
    fn masses(&self, name: &str) -> Result<String, String> {
        if self.groups.iter().chain(&self.views).any(|known| known == name) {
            return Ok(self.full(name));
        }
        if let Some(port) = self.port(name) {
            return match port.kind {
                PortKind::M => Ok(self.full(name)),
                // reported where it is joined to nothing
                PortKind::L => self.fed.get(name).cloned().ok_or_else(String::new),
            };
        }
        if let Some(part) = self.part(name) {
            return Ok(part.path.clone());
        }
        let Some((part, inner)) =
            name.split_once('.').and_then(|(part, inner)| Some((self.part(part)?, inner)))
        else {
            return Err(self.unknown(name));
        };
        match part.port(inner) {
            Some(Port { kind: PortKind::M, .. }) => Ok(part.full(inner)),
            Some(Port { kind: PortKind::L, .. }) => Err(format!(
                "`{name}` is an L point: the end of links, not a mass; `connections` join it to one"
            )),
            None if part.ports.is_empty() => part.masses(inner),
            None => {
                let known: Vec<&str> = part.ports.iter().map(|port| port.name.as_str()).collect();
                Err(format!(
                    "`{}` shows no port `{inner}` to the outside; it shows {}",
                    part.path,
                    known.join(", ")
                ))
            }
        }
    }

    fn known(&self) -> Vec<&str> {
        let ports = self.ports.iter().map(|port| port.name.as_str());
        let parts = self.parts.iter().map(|(name, _)| name.as_str());
        self.groups.iter().map(String::as_str).chain(ports).chain(parts).collect()
    }

    fn unknown(&self, name: &str) -> String {
        format!("there is no group of masses `{name}`{}", did_you_mean(name, self.known()))
    }

    fn refuse(&self, site: &Site, what: String, log: &Log) {
        if !what.is_empty() {
            log.add(Code::UnknownName, site, what, one_of(&self.known()));
        }
    }

    /// Presents points of view, of the network alone, behind all masses.
    fn see(&mut self, reader: &Reader, all: &mut Assembly) {
        let log = reader.log();
        let mut first: u32 = all.masses.iter().map(|group| group.places.count() as u32).sum();
        for (name, view) in reader.named("views") {
            let Some(mut view) = ViewSpec::read(name, &view) else { continue };
            if self.known().contains(&view.name.as_str()) {
                let message = format!("there are masses and a point of view `{}`", view.name);
                log.add(Code::Conflict, &view.site, message, "names that differ");
            }
            let numbers = match self.masses(&view.of) {
                Ok(of) => {
                    view.of = of;
                    all.numbers_of(&view.of)
                }
                Err(what) => {
                    self.refuse(&view.site, what, log);
                    None
                }
            };
            let Some(numbers) = numbers else { continue };
            let count = view.count(numbers.len() as u32);
            all.presented.push((view.name.clone(), first..first + count));
            first += count;
            // links name it as they do a group
            self.views.push(view.name.clone());
            all.views.push(view);
        }
    }

    /// Its own ports L need something to be joined to.
    fn require_feeds(&self, log: &Log) {
        for port in &self.ports {
            if port.kind == PortKind::L && !self.fed.contains_key(&port.name) {
                let message = format!(
                    "port L `{}` is joined to no M: its links have an end without a mass",
                    self.full(&port.name)
                );
                let expected =
                    "an entry of `connections` with it, such as { M = \"a group\", L = \"part.port\" }";
                log.add(Code::Conflict, &port.site, message, expected);
            }
        }
    }

    /// Joins ports L of its parts, from the outermost inwards.
    fn connect(&mut self, log: &Log) {
        for Connection { m, l, site } in std::mem::take(&mut self.connections) {
            match self.masses(&m) {
                Ok(masses) => self.feed(&l, masses, &site, log),
                Err(what) => self.refuse(&site, what, log),
            }
        }
        for (_, part) in &mut self.parts {
            part.require_feeds(log);
            part.connect(log);
        }
    }

    /// Joins the port L of a part, `part.port`, to masses.
    fn feed(&mut self, l: &str, masses: String, site: &Site, log: &Log) {
        let refuse = |message: String, expected: &str| log.add(Code::Conflict, site, message, expected);
        let found = l.split_once('.').and_then(|(part, port)| {
            let index = self.parts.iter().position(|(known, _)| known == part)?;
            Some((self.parts[index].1.port(port)?.kind, index, port))
        });
        match found {
            Some((PortKind::L, index, port)) => {
                let part = &mut self.parts[index].1;
                if let Some(other) = part.fed.get(port) {
                    let message = format!("`{l}` is joined to `{other}` and to `{masses}`: two M on one L");
                    refuse(message, "one M; several L may share it");
                } else {
                    part.fed.insert(port.to_owned(), masses);
                }
            }
            Some((PortKind::M, ..)) => refuse(
                format!("`{l}` is an M point like `{masses}`: M to M, with nothing between them"),
                "an L point of a part, or `links` between the two",
            ),
            None if self.masses(l).is_ok() => refuse(
                format!("`{l}` is of masses like `{masses}`: M to M, with nothing between them"),
                "an L point of a part, or `links` between the two",
            ),
            None => {
                let ports = self.parts.iter().flat_map(|(name, part)| {
                    let ports = part.ports.iter().filter(|port| port.kind == PortKind::L);
                    ports.map(move |port| format!("{name}.{}", port.name))
                });
                let known: Vec<String> = ports.collect();
                let hint = did_you_mean(l, known.iter().map(String::as_str));
                let expected = crate::keys::one_of(&known.iter().map(String::as_str).collect::<Vec<_>>());
                log.add(Code::UnknownName, site, format!("there is no port L `{l}`{hint}"), expected);
            }
        }
    }

    /// Gives the network its links and crowds, then those of its parts.
    fn act(&self, all: &mut Assembly, log: &Log) {
        for reader in &self.links {
            let mut table = LinkTable::read(reader);
            self.name(&mut table.of, &reader.site_of("of"), log);
            table.is_of_part = !self.path.is_empty();
            if !table.name.is_empty() {
                table.name = self.full(&table.name);
            }
            if let Span::Along(axis) = &mut table.span {
                *axis = self.standing.iter().fold(*axis, |axis, standing| standing.placement.turn(axis));
            }
            all.links.push(table);
        }
        for reader in &self.crowds {
            let mut crowd = CrowdSpec::read(reader);
            self.name(&mut crowd.of, &reader.site_of("of"), log);
            if !crowd.name.is_empty() {
                crowd.name = self.full(&crowd.name);
            }
            all.crowds.push(crowd);
        }
        for (_, part) in &self.parts {
            part.act(all, log);
        }
    }

    /// Names groups as the network knows them; of all masses of a part, the part.
    fn name(&self, of: &mut Vec<String>, site: &Site, log: &Log) {
        if of.is_empty() && !self.path.is_empty() {
            if self.groups.is_empty() && self.parts.is_empty() {
                let message = format!("`{}` has no masses to join", self.path);
                log.add(Code::EmptyRegion, &self.site, message, "masses, or `of` with two ports L");
            }
            of.push(self.path.clone());
            return;
        }
        for name in of.iter_mut() {
            match self.masses(name) {
                Ok(full) => *name = full,
                Err(what) => self.refuse(site, what, log),
            }
        }
    }
}

impl Connection {
    fn read(reader: &Reader) -> Self {
        Self { m: reader.text("M"), l: reader.text("L"), site: reader.site() }
    }
}
