//! Objects in layers, and how they meet: which groups of masses act on which (Jimenez 1993, P2-III.2.2; specification
//! §2.12).
//!
//! ```text
//! agglomerate ::= balls, a law             a group of masses and a crowd of it
//! object      ::= agglomerates, laws       kernel, dermis, epidermis
//! scene       ::= objects, laws            encounters
//! ```
//!
//! A kernel acts on the dermis that lies on it, the dermis on itself and on the epidermis around it. Objects meet by their
//! outermost layers alone, unless they are to break: that is what layers save.

use std::collections::BTreeSet;

use souple_models::network::{BuildLink, LINKS};
use souple_table::{Range, Value};

use super::{CrowdSpec, FRICTION, FrictionSpec, LINK};
use crate::diagnostic::{Code, Site};
use crate::keys::{Key, Keys, Shape, did_you_mean, one_of};
use crate::reader::{Chosen, Reader};

pub(super) static OBJECT: Keys = Keys::new(
    "object",
    "groups of masses as the layers of one thing; the laws between layers become crowds",
    &[
        Key::new("kernel", Shape::Texts, "groups that structure it: a heavy ball, a skeleton of links"),
        Key::new("dermis", Shape::Texts, "groups that are its matter"),
        Key::new("epidermis", Shape::Texts, "groups that delimit it: a closed line or surface of links"),
        Key::new("centring", Shape::Entry(LINK), "what kernel and dermis do to each other"),
        Key::new("matter", Shape::Entry(LINK), "what masses of the dermis do to each other"),
        Key::new("adhesion", Shape::Entry(LINK), "what dermis and epidermis do to each other"),
        Key::new(
            "breakable",
            Shape::Boolean,
            "all its layers meet other things, for its inside may come out; the outermost alone where false",
        )
        .or(Value::Boolean(false)),
    ],
);

pub(super) static ENCOUNTER: Keys = Keys::new(
    "encounter",
    "what objects do to each other where they meet, every two of those named",
    &[
        Key::new("law", Shape::Entry(LINK), "between masses of the layers that meet").required(),
        Key::new("name", Shape::Text, "what controls call the crowds of it"),
        Key::new(
            "of",
            Shape::Texts,
            "objects, and groups of masses that are of none; all of them where left out",
        ),
        Key::new("layers", Shape::Choice(&["outermost", "all"]), "which layers of them meet")
            .or(Value::Text("outermost")),
        Key::number("range", "m", Range::POSITIVE, "no force beyond; that of the law where left out"),
        Key::new("friction", Shape::Table(&FRICTION), "what holds them across"),
    ],
);

/// The layers of an object, from inside out.
struct Object {
    name: String,
    layers: [Vec<String>; 3],
    is_breakable: bool,
}

impl Object {
    /// Groups of masses that meet others.
    fn surface(&self, layers: &str) -> Vec<String> {
        if self.is_breakable || layers == "all" {
            return self.layers.concat();
        }
        self.layers.iter().rev().find(|layer| !layer.is_empty()).cloned().unwrap_or_default()
    }
}

/// The crowds that objects and encounters of a network stand for; `groups`: of masses.
pub(super) fn crowds(network: &str, groups: &[&str], reader: &Reader) -> Vec<CrowdSpec> {
    let mut crowds = Vec::new();
    let mut objects: Vec<Object> = Vec::new();
    let mut taken = BTreeSet::new();
    for (name, table) in reader.named("objects") {
        if groups.contains(&name.as_str()) {
            let message = format!("there are an object and a group of masses `{name}`");
            reader.log().add(Code::Conflict, &table.site(), message, "names that differ");
        }
        let layers = ["kernel", "dermis", "epidermis"].map(|key| table.texts(key));
        for (key, layer) in ["kernel", "dermis", "epidermis"].into_iter().zip(&layers) {
            for group in layer {
                let refuse = |code, message, expected: String| {
                    reader.log().add(code, &table.site_of(key), message, expected);
                };
                if !groups.contains(&group.as_str()) {
                    let hint = did_you_mean(group, groups.iter().copied());
                    let message = format!("there is no group of masses `{group}`{hint}");
                    refuse(Code::UnknownName, message, one_of(groups));
                } else if !taken.insert(group.clone()) {
                    let message = format!("the group `{group}` is in a layer already");
                    refuse(Code::Conflict, message, "each group in one layer of one object".to_owned());
                }
            }
        }
        if layers.iter().all(Vec::is_empty) {
            let message = format!("the object `{name}` has no layer");
            reader.log().add(Code::MissingKey, &table.site(), message, "kernel, dermis or epidermis");
        }
        let [kernel, dermis, epidermis] = &layers;
        let within: Vec<[&String; 2]> = (0..dermis.len())
            .flat_map(|i| (i..dermis.len()).map(move |j| [&dermis[i], &dermis[j]]))
            .collect();
        for (key, pairs) in [
            ("centring", between(kernel, dermis)),
            ("matter", within),
            ("adhesion", between(dermis, epidermis)),
        ] {
            let Some(law) = table.has(key).then(|| table.entry(key, &LINKS)).flatten() else { continue };
            if pairs.is_empty() {
                let message = format!("`{key}` joins nothing: a layer is missing");
                reader.log().add(
                    Code::Conflict,
                    &table.site_of(key),
                    message,
                    "both layers that it is between",
                );
            }
            let law =
                Between { name: String::new(), law, range: None, friction: None, site: table.site_of(key) };
            let named = |[a, b]: [&String; 2]| law.of(format!("{network}.{name}.{key}"), a, b);
            crowds.extend(numbered(pairs.into_iter().map(named).collect()));
        }
        objects.push(Object { name, layers, is_breakable: table.boolean("breakable") });
    }
    // what is of no object meets others as it is
    let alone = groups.iter().filter(|group| !taken.contains(**group));
    let alone = alone.map(|group| Object {
        name: (*group).to_owned(),
        layers: [vec![(*group).to_owned()], Vec::new(), Vec::new()],
        is_breakable: false,
    });
    objects.extend(alone.collect::<Vec<_>>());
    for (index, table) in reader.tables("encounters").into_iter().enumerate() {
        crowds.extend(encounter(&format!("{network}.encounters[{index}]"), &table, &objects));
    }
    crowds
}

/// A crowd for every two groups that meet.
fn encounter(name: &str, table: &Reader, objects: &[Object]) -> Vec<CrowdSpec> {
    let names = table.texts("of");
    let known: Vec<&str> = objects.iter().map(|object| object.name.as_str()).collect();
    for unknown in names.iter().filter(|name| !known.contains(&name.as_str())) {
        let hint = did_you_mean(unknown, known.iter().copied());
        let message = format!("there is no object `{unknown}`, nor a group that is of none{hint}");
        let expected = one_of(&known);
        table.log().add(Code::UnknownName, &table.site_of("of"), message, expected);
    }
    let is_meant = |object: &&Object| names.is_empty() || names.contains(&object.name);
    let meeting: Vec<&Object> = objects.iter().filter(is_meant).collect();
    let Some(law) = table.entry("law", &LINKS) else { return Vec::new() };
    if meeting.len() < 2 {
        let message = "an encounter is of two things at least";
        table.log().add(Code::Conflict, &table.site(), message, "objects, or groups of masses, in `of`");
    }
    let law = Between {
        name: table.text("name"),
        law,
        range: table.maybe_number("range"),
        friction: table.table("friction").map(|friction| FrictionSpec::read(&friction)),
        site: table.site(),
    };
    let layers = table.choice("layers");
    let mut crowds = Vec::new();
    for (index, first) in meeting.iter().enumerate() {
        for second in &meeting[index + 1..] {
            let (own, other) = (first.surface(layers), second.surface(layers));
            let meet = between(&own, &other);
            let [inner, outer] = [first, second].map(|object| object.layers.concat());
            let all = between(&inner, &outer).into_iter().filter(|pair| !meet.contains(pair));
            let kept_apart: Vec<[String; 2]> = all.map(|pair| pair.map(String::clone)).collect();
            let known = crowds.len();
            crowds.extend(meet.iter().map(|[a, b]| law.of(name.to_owned(), a, b)));
            if let Some(crowd) = crowds.get_mut(known) {
                crowd.kept_apart = kept_apart;
            }
        }
    }
    numbered(crowds)
}

fn between<'a>(first: &'a [String], second: &'a [String]) -> Vec<[&'a String; 2]> {
    first.iter().flat_map(|a| second.iter().map(move |b| [a, b])).collect()
}

/// Where several have one name, each gets its own.
fn numbered(mut crowds: Vec<CrowdSpec>) -> Vec<CrowdSpec> {
    if crowds.len() > 1 {
        for (index, crowd) in crowds.iter_mut().enumerate() {
            crowd.force = crowd.force.as_ref().map(|name| format!("{name}[{index}]"));
        }
    }
    crowds
}

/// A law between groups.
struct Between {
    /// What controls call it.
    name: String,
    law: Chosen<BuildLink>,
    /// [m]
    range: Option<f64>,
    friction: Option<FrictionSpec>,
    site: Site,
}

impl Between {
    fn of(&self, force: String, a: &str, b: &str) -> CrowdSpec {
        let of = if a == b { vec![a.to_owned()] } else { vec![a.to_owned(), b.to_owned()] };
        CrowdSpec {
            name: self.name.clone(),
            force: Some(force),
            law: Some(self.law.clone()),
            of,
            kept_apart: Vec::new(),
            range: self.range,
            friction: self.friction.clone(),
            fusible: None,
            site: self.site.clone(),
        }
    }
}
