//! Shapes that bodies touch, and who touches whom.

use souple_math::Vec3;
use souple_models::contact::shape::BuildShape;
use souple_models::contact::{Displacing, SHAPES};
use souple_table::{Range, Value};

use super::boundary::{MOTION, MotionSpec, TURNING};
use super::region::Region;
use crate::diagnostic::{Code, Site};
use crate::keys::{EntryShape, Key, Keys, NOWHERE, Shape, outlines};
use crate::reader::{Chosen, Reader};

pub(super) const SHAPE_ENTRY: EntryShape = EntryShape {
    tag: "name",
    kind: "shape",
    outlines: || outlines(&SHAPES),
    instead: &[],
    elsewhere: NOWHERE,
};

pub(crate) static SHAPE: Keys = Keys::new(
    "shape",
    "a thing of fixed shape, at rest or led",
    &[
        Key::new("shape", Shape::Entry(SHAPE_ENTRY), "what it is").required(),
        Key::new("motion", Shape::Table(&MOTION), "how it is moved"),
        Key::new("rotation", Shape::Table(&TURNING), "how it is turned about the pivot"),
        Key::vector("pivot", "m", "where it turns").or(Value::Vector([0.0; 3])),
    ],
);

pub(super) const FRICTION: Key =
    Key::number("friction", "", Range::NOT_NEGATIVE, "Coulomb's coefficient").or(Value::Number(0.0));
pub(super) const DAMPING: Key = Key::number(
    "damping",
    "s/m",
    Range::NOT_NEGATIVE,
    "Hunt–Crossley: a collision at speed u gives back 1 - 2/3 d u",
)
.or(Value::Number(0.0));
pub(super) const TANGENTIAL_STIFFNESS: Key =
    Key::number("tangential_stiffness", "N/m", Range::POSITIVE, "of sticking; the stiffness where left out");
pub(super) const THICKNESS: Key =
    Key::number("thickness", "m", Range::NOT_NEGATIVE, "distance at which touching starts")
        .or(Value::Number(0.0));

pub(super) const HEAT: Key = Key::number(
    "heat",
    "W/m^2",
    Range::NOT_NEGATIVE,
    "that it gives to the surface it touches, of a body with `marks`",
)
.or(Value::Number(0.0));

pub(super) const TEARS_AT: Key = Key::number(
    "tears_at",
    "Pa",
    Range::NOT_NEGATIVE,
    "pressure at which it tears vessels, of a body whose `marks` bleed: a sharp tool's is low; that of `bleeding` where left out",
);

pub(super) const DETECT: Key = Key::new(
    "detect",
    Shape::Choice(&DETECTIONS),
    "the body's surface points, or its triangles: between these no tool is too thin, and through them none too fast; of a sphere, a capsule or jaws",
)
.or(Value::Text(DETECTIONS[0]));
pub(super) const WEIGH: Key = Key::new(
    "weigh",
    Shape::Choice(&WEIGHINGS),
    "whether the stiffness of each point or triangle is in proportion to its area, or all are alike, which depends on the mesh; of imposed displacements, whether each held point is felt by the part of its area that is in touch, or wholly",
)
.or(Value::Text(WEIGHINGS[0]));
const WEIGHINGS: [&str; 2] = ["area", "alike"];

pub(super) const RESPONSE: Key = Key::new(
    "response",
    Shape::Choice(&RESPONSES),
    "a penalty pushes what is inside; imposed, triangles are moved out by displacements, and the points held that they move: of `detect = \"triangles\"`, in systems of `staggered` or `symplectic_euler`",
)
.or(Value::Text(RESPONSES[0]));
const RESPONSES: [&str; 2] = ["penalty", "imposed"];
pub(super) const FRACTION: Key = Key::number(
    "fraction",
    "",
    Range { low: 0.0, high: 1.0, low_included: false, high_included: true },
    "of the way out that imposed displacements go in a period",
)
.or(Value::Number(1.0));
pub(super) const RESIDUAL: Key = Key::number(
    "residual",
    "m",
    Range::NOT_NEGATIVE,
    "how deep a triangle stays that is moved out, so that it stays in touch",
)
.or(Value::Number(1e-4));
pub(super) const PROGRESSIVE: Key = Key::new(
    "progressive",
    Shape::Boolean,
    "whether imposed displacements go evenly through the steps of a period, or in its first step at once",
)
.or(Value::Boolean(true));

/// Keys of a penalty that displacements have no use for.
const OF_PENALTY: [&str; 5] = ["stiffness", "friction", "damping", "tangential_stiffness", "thickness"];
/// Keys of displacements that a penalty has no use for.
const OF_IMPOSED: [&str; 3] = ["fraction", "residual", "progressive"];

/// Displacements in the place of a penalty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Imposed {
    pub fraction: f64,
    /// [m]
    pub residual: f64,
    pub displacing: Displacing,
}

/// Refuses keys that say nothing to a response, and do to the one `instead`.
pub(super) fn refuse_idle(reader: &Reader, keys: &[&'static str], [response, instead]: [&str; 2]) {
    for key in reader.written(keys) {
        let message = format!("`{key}` says nothing to `response = \"{response}\"`");
        let expected = format!("`response = \"{instead}\"`, or no `{key}`");
        reader.log().add(Code::Conflict, &reader.site_of(key), message, expected);
    }
}

impl Imposed {
    /// The mass of a tool, and the spring and damper to its device: a tool that holds points has neither.
    pub(super) fn refuse_coupling(hand: &Reader, coupling: Option<&Reader>) {
        let responses = [RESPONSES[1], RESPONSES[0]];
        refuse_idle(hand, &["mass"], responses);
        if let Some(coupling) = coupling {
            refuse_idle(coupling, &["stiffness", "damping"], responses);
        }
    }

    /// `None` of a penalty; keys without effect are refused.
    pub(super) fn read(reader: &Reader) -> Option<Self> {
        let response = reader.choice("response");
        let is_imposed = response == RESPONSES[1];
        let (idle, instead): (&[&'static str], &str) =
            if is_imposed { (&OF_PENALTY, RESPONSES[0]) } else { (&OF_IMPOSED, RESPONSES[1]) };
        refuse_idle(reader, idle, [response, instead]);
        if is_imposed && Detect::named(reader.choice("detect")) == Detect::Points {
            let message = "displacements are imposed on triangles";
            reader.log().add(Code::Conflict, &reader.site(), message, "`detect = \"triangles\"`");
        }
        is_imposed.then(|| Self {
            fraction: reader.number("fraction"),
            residual: reader.number("residual"),
            displacing: if reader.boolean("progressive") {
                Displacing::Progressively
            } else {
                Displacing::AtOnce
            },
        })
    }
}

/// How the stiffness of a contact is shared out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weighing {
    /// By the area around a point, or of a triangle.
    Area,
    Alike,
}

impl Weighing {
    pub(super) fn named(name: &str) -> Self {
        if name == WEIGHINGS[1] { Self::Alike } else { Self::Area }
    }

    /// The share of what has so much of the mean area.
    pub fn share(self, of_mean_area: f64) -> f64 {
        match self {
            Self::Area => of_mean_area,
            Self::Alike => 1.0,
        }
    }
}

const DETECTIONS: [&str; 2] = ["points", "triangles"];

/// What of a body's surface is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detect {
    Points,
    Triangles,
}

impl Detect {
    pub(super) fn named(name: &str) -> Self {
        if name == DETECTIONS[1] { Self::Triangles } else { Self::Points }
    }
}

pub(crate) static CONTACT: Keys = Keys::new(
    "contact",
    "points of a body against a shape or a skin, or the surfaces of two bodies",
    &[
        Key::new("name", Shape::Text, "for probes; `contacts[0]` and so on where left out"),
        Key::new("body", Shape::Text, "the body that touches").required(),
        Key::new("shape", Shape::Text, "the shape it touches"),
        Key::new("other", Shape::Text, "the body it touches"),
        Key::new("skin", Shape::Text, "the skin it touches"),
        Key::new("region", Shape::Region, "the part of the body's surface that touches; all where left out"),
        Key::number(
            "stiffness",
            "N/m",
            Range::POSITIVE,
            "of a point of mean area, or of each mass of a network; where left out, that of the body's material behind it; of a triangle of mean area, twenty times that of the material",
        ),
        DETECT,
        WEIGH,
        FRICTION,
        DAMPING,
        TANGENTIAL_STIFFNESS,
        THICKNESS,
        HEAT,
        TEARS_AT,
        RESPONSE,
        FRACTION,
        RESIDUAL,
        PROGRESSIVE,
    ],
);

/// A thing of fixed shape.
pub struct ShapeSpec {
    pub name: String,
    pub shape: Option<Chosen<BuildShape>>,
    pub motion: Option<MotionSpec>,
    pub rotation: Option<MotionSpec>,
    /// [m]
    pub pivot: Vec3,
    pub site: Site,
}

/// What a body touches.
#[derive(Clone, Debug, PartialEq)]
pub enum Against {
    Shape(String),
    Body(String),
    Skin(String),
}

/// Who touches whom, and how; see `souple_models::contact::ContactLaw`.
#[derive(Clone, Debug)]
pub struct Contact {
    pub name: String,
    pub body: String,
    pub against: Option<Against>,
    pub region: Option<Region>,
    pub stiffness: Option<f64>,
    pub detect: Detect,
    pub weigh: Weighing,
    pub friction: f64,
    pub damping: f64,
    pub tangential_stiffness: Option<f64>,
    pub thickness: f64,
    /// Given to what is touched [W/m²].
    pub heat: f64,
    /// [Pa]
    pub tears_at: Option<f64>,
    /// Displacements in the place of the penalty.
    pub imposed: Option<Imposed>,
    pub site: Site,
}

impl ShapeSpec {
    pub(crate) fn read(name: String, reader: &Reader) -> Self {
        let motion = |key: &str| reader.table(key).and_then(|table| MotionSpec::read(&table));
        Self {
            name,
            shape: reader.entry("shape", &SHAPES),
            motion: motion("motion"),
            rotation: motion("rotation"),
            pivot: reader.vector("pivot"),
            site: reader.site(),
        }
    }
}

impl Contact {
    pub(crate) fn read(index: usize, reader: &Reader) -> Self {
        let named = |key: &str, kind: fn(String) -> Against| reader.maybe_text(key).map(kind);
        let things =
            [named("shape", Against::Shape), named("other", Against::Body), named("skin", Against::Skin)];
        let mut things = things.into_iter().flatten();
        let against = match (things.next(), things.next()) {
            (Some(thing), None) => Some(thing),
            _ => {
                let message = "a contact is with one thing, a shape, another body or a skin";
                reader.log().add(Code::Conflict, &reader.site(), message, "`shape`, `other` or `skin`");
                None
            }
        };
        let imposed = Imposed::read(reader);
        if imposed.is_some() && matches!(against, Some(Against::Body(_) | Against::Skin(_))) {
            let message = "displacements are imposed by a tool, which is a shape";
            reader.log().add(Code::Conflict, &reader.site(), message, "`shape`, or `response = \"penalty\"`");
        }
        Self {
            name: reader.maybe_text("name").unwrap_or_else(|| format!("contacts[{index}]")),
            body: reader.text("body"),
            against,
            region: Region::read(reader, "region"),
            stiffness: reader.maybe_number("stiffness"),
            detect: Detect::named(reader.choice("detect")),
            weigh: Weighing::named(reader.choice("weigh")),
            friction: reader.number("friction"),
            damping: reader.number("damping"),
            tangential_stiffness: reader.maybe_number("tangential_stiffness"),
            thickness: reader.number("thickness"),
            heat: reader.number("heat"),
            tears_at: reader.maybe_number("tears_at"),
            imposed,
            site: reader.site(),
        }
    }
}
