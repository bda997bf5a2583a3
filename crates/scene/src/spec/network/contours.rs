//! Contours of the masses of a network: ways to tell where an object ends, and a cross that tells how it has turned.

use souple_models::network::contour::{Frontier, Plane, Scan};
use souple_table::{Range, Value};

use crate::diagnostic::{Code, Site};
use crate::keys::{Key, Keys, Shape};
use crate::reader::Reader;

pub(super) static CONTOUR: Keys = Keys::new(
    "contour",
    "where an object ends, in a plane: the line `through` the masses of its skin, the `frontier` of what it does to what comes, or the trace of a probe that runs along it (`scan`); or a `cross` on it",
    &[
        Key::new("through", Shape::Integers, "masses of a closed line, by number in the network"),
        Key::new("skin", Shape::Text, "a group whose masses are a closed line in their order"),
        Key::new("frontier", Shape::Texts, "groups of balls of one radius"),
        Key::new("scan", Shape::Texts, "groups of balls of one radius"),
        Key::new(
            "cross",
            Shape::Integers,
            "masses by number in the network: a cross is drawn on the first, before and behind it, which turns as they all do",
        ),
        Key::number("radius", "m", Range::POSITIVE, "of the balls; length of the arms of a cross"),
        Key::number(
            "probe",
            "m",
            Range::POSITIVE,
            "radius of what comes to the frontier: the larger, the more hollows it bridges; a tenth of `radius` where left out",
        ),
        Key::number(
            "step",
            "m",
            Range::POSITIVE,
            "of the frontier's grid, or of the scan; a tenth of `radius` where left out",
        ),
        Key::number(
            "band",
            "m",
            Range::POSITIVE,
            "how far balls hold the scan's probe; half of `radius` where left out",
        ),
        Key::new("normal", Shape::Choice(&["x", "y", "z"]), "across the plane").or(Value::Text("y")),
    ],
);

/// Steps in what a ball reaches, at most.
const STEPS_MAX: f64 = 1000.0;

/// Names that no contour has.
const WORN: &str = "skin";
const FACES: &str = "faces";

/// Where an object ends.
#[derive(Clone, Debug)]
pub struct ContourSpec {
    pub name: String,
    pub way: Way,
    pub plane: Plane,
    pub site: Site,
}

/// How a contour is told.
#[derive(Clone, Debug, PartialEq)]
pub enum Way {
    /// Through masses by number.
    Through(Vec<u32>),
    /// Through a group in its order.
    Skin(String),
    Frontier(Vec<String>, Frontier),
    Scan(Vec<String>, Scan),
    /// Masses by number that turn it, on the first of which it is, and the length of its arms [m].
    Cross(Vec<u32>, f64),
}

impl ContourSpec {
    /// `None` where it was refused.
    pub(super) fn read(name: String, reader: &Reader) -> Option<Self> {
        let refuse = |key: &str, message: &str, expected: &str| {
            reader.log().add(Code::Conflict, &reader.site_of(key), message, expected);
        };
        // frames and pictures tell a contour `NETWORK.NAME`
        let taken = [(WORN, "what dresses a network"), (FACES, "the faces of its bodies")];
        if let Some((_, what)) = taken.into_iter().find(|(taken, _)| *taken == name) {
            let message = format!("a contour `{name}` has the name that frames and pictures give to {what}");
            reader.log().add(Code::Conflict, &reader.site(), message, "another name, say `outline`");
            return None;
        }
        let written = reader.written(&["through", "skin", "frontier", "scan", "cross"]);
        let [way] = written[..] else {
            let message = format!("a contour is told in one way, this one in {}", written.len());
            reader.log().add(
                Code::WrongType,
                &reader.site(),
                message,
                "one of through, skin, frontier, scan, cross",
            );
            return None;
        };
        let is_of_balls = matches!(way, "frontier" | "scan");
        let radius = reader.maybe_number("radius");
        if (is_of_balls || way == "cross") != radius.is_some() {
            let expected = "radius = \"…\" with `frontier`, `scan` or `cross`";
            refuse(way, "balls and crosses have a `radius`, skins have none", expected);
            return None;
        }
        let radius = radius.unwrap_or(1.0);
        let number = |key: &str, share: f64| reader.maybe_number(key).unwrap_or(share * radius);
        let step = number("step", 0.1);
        // of the frontier's grid a ball touches the square of twice as many corners
        let (reach, of) = match way {
            "frontier" => (radius + number("probe", 0.1), "`radius` and `probe` together"),
            _ => (radius, "`radius`"),
        };
        if is_of_balls && step > reach {
            let message = format!("a step of {step:?} m passes over balls: {of} is {reach} m");
            let expected = format!("at most {reach} m, a tenth of the radius where left out");
            reader.log().add(Code::OutOfRange, &reader.site_of("step"), message, expected);
            return None;
        }
        if is_of_balls && reach > STEPS_MAX * step {
            let message =
                format!("a step of {step:?} m goes {:.3e} times into {of}, {reach:?} m", reach / step);
            let expected = format!("at least {:?} m, a thousandth", reach / STEPS_MAX);
            reader.log().add(Code::OutOfRange, &reader.site_of("step"), message, expected);
            return None;
        }
        let way = match way {
            "through" => Way::Through(reader.maybe_indices("through")?),
            "skin" => Way::Skin(reader.maybe_text("skin")?),
            "frontier" => {
                let frontier = Frontier { radius, probe: number("probe", 0.1), cell: step };
                Way::Frontier(reader.texts("frontier"), frontier)
            }
            "cross" => Way::Cross(reader.maybe_indices("cross")?, radius),
            _ => Way::Scan(reader.texts("scan"), Scan { radius, band: number("band", 0.5), step }),
        };
        let normal = ["x", "y", "z"].iter().position(|axis| *axis == reader.choice("normal"));
        Some(Self { name, way, plane: Plane::across(normal.unwrap_or(1)), site: reader.site() })
    }

    /// Groups of masses that it is of.
    pub(super) fn groups(&self) -> &[String] {
        match &self.way {
            Way::Through(_) | Way::Cross(..) => &[],
            Way::Skin(group) => std::slice::from_ref(group),
            Way::Frontier(groups, _) | Way::Scan(groups, _) => groups,
        }
    }
}
