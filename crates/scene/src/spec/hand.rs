//! Hands of people with tools: at which device, and how they feel what they touch.

use souple_haptics::{BETWEEN, Between, ChooseDevice, Coupling, DEVICES, Port, Weight};
use souple_models::contact::SHAPES;
use souple_models::contact::shape::BuildShape;
use souple_table::{Range, Value};

use super::boundary::{MOTION, MotionSpec};
use super::contact::{
    Contact, DAMPING, DETECT, Detect, FRACTION, FRICTION, HEAT, Imposed, PROGRESSIVE, RESIDUAL, RESPONSE,
    TANGENTIAL_STIFFNESS, TEARS_AT, THICKNESS, WEIGH, Weighing,
};
use super::region::Region;
use crate::diagnostic::Site;
use crate::keys::{EntryShape, Key, Keys, NOWHERE, Shape, outlines};
use crate::reader::{Chosen, Reader};

const TOOL: EntryShape = EntryShape {
    tag: "name",
    kind: "shape",
    outlines: || outlines(&SHAPES),
    instead: &[],
    elsewhere: NOWHERE,
};
const DEVICE: EntryShape = EntryShape {
    tag: "name",
    kind: "device",
    outlines: || outlines(&DEVICES),
    instead: &[],
    elsewhere: NOWHERE,
};

static TOUCH: Keys = Keys::new(
    "touch",
    "how a tool touches",
    &[
        Key::number(
            "stiffness",
            "N/m",
            Range::POSITIVE,
            "of a point of mean area; where left out, that of the body's material behind it; of a triangle, twenty times that",
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

static COUPLING: Keys = Keys::new(
    "hand_coupling",
    "the spring and damper between device and tool: what the hand feels",
    &[
        Key::number("stiffness", "N/m", Range::POSITIVE, "of the spring")
            .or(Value::Number(Coupling::DEFAULT.stiffness)),
        Key::number("damping", "N s/m", Range::NOT_NEGATIVE, "of the damper")
            .or(Value::Number(Coupling::DEFAULT.damping)),
        Key::number("limit", "N", Range::POSITIVE, "the most that the device gives, and draws the tool with")
            .or(Value::Number(Coupling::DEFAULT.limit)),
    ],
);

pub(crate) static HAND: Keys = Keys::new(
    "hand",
    "a person's hand at a device, with a tool that touches a body",
    &[
        Key::new("device", Shape::Entry(DEVICE), "what is in the hand").required(),
        Key::new(
            "motion",
            Shape::Table(&MOTION),
            "where an emulated hand means to be; it rests where left out",
        ),
        Key::new("tool", Shape::Entry(TOOL), "its shape, where it is at the start").required(),
        Key::number("mass", "kg", Range::POSITIVE, "of the tool").or(Value::Number(0.05)),
        Key::new(
            "feels_mass",
            Shape::Boolean,
            "whether the hand speeds up that mass itself; `false`: it feels what the tool touches alone",
        )
        .or(Value::Boolean(true)),
        Key::new("body", Shape::Text, "the body that it touches").required(),
        Key::new(
            "region",
            Shape::Region,
            "the part of the body's surface that it touches; all where left out",
        ),
        Key::new("touch", Shape::Table(&TOUCH), "how it touches"),
        Key::new("coupling", Shape::Table(&COUPLING), "how device and tool are joined"),
        Key::new("passive", Shape::Boolean, "whether no more energy comes out of the device than went in")
            .or(Value::Boolean(true)),
        Key::new(
            "between",
            Shape::Choice(&BETWEEN),
            "what the tool, or the force of points that it holds, does for the hand between two periods of the world, against the clock; `hold` acts in every run",
        )
        .or(Value::Text(BETWEEN[0])),
    ],
);

/// A hand as specified.
pub struct HandSpec {
    pub name: String,
    pub device: Option<Chosen<ChooseDevice>>,
    pub motion: Option<MotionSpec>,
    pub tool: Option<Chosen<BuildShape>>,
    /// [kg]
    pub mass: f64,
    pub weight: Weight,
    /// Who is touched, and how; of no shape that has a name.
    pub touch: Contact,
    pub port: Port,
    pub between: Between,
    pub site: Site,
}

/// The name of the force of a hand's tool.
pub fn hand_force(hand: &str) -> String {
    format!("hands.{hand}")
}

impl HandSpec {
    pub(crate) fn read(name: String, reader: &Reader) -> Self {
        let touch = reader.table("touch");
        let maybe = |key: &str| touch.as_ref().and_then(|touch| touch.maybe_number(key));
        let number = |key: &str| maybe(key).unwrap_or(0.0);
        let imposed = touch.as_ref().and_then(Imposed::read);
        let coupled = reader.table("coupling");
        if imposed.is_some() {
            Imposed::refuse_coupling(reader, coupled.as_ref());
        }
        let coupling = coupled.map_or(Coupling::DEFAULT, |coupling| Coupling {
            stiffness: coupling.number("stiffness"),
            damping: coupling.number("damping"),
            limit: coupling.number("limit"),
        });
        Self {
            device: reader.entry("device", &DEVICES),
            motion: reader.table("motion").and_then(|motion| MotionSpec::read(&motion)),
            tool: reader.entry("tool", &SHAPES),
            mass: reader.number("mass"),
            weight: if reader.boolean("feels_mass") { Weight::Felt } else { Weight::Unfelt },
            touch: Contact {
                name: hand_force(&name),
                body: reader.text("body"),
                against: None,
                region: Region::read(reader, "region"),
                stiffness: maybe("stiffness"),
                detect: touch.as_ref().map_or(Detect::Points, |touch| Detect::named(touch.choice("detect"))),
                weigh: touch.as_ref().map_or(Weighing::Area, |touch| Weighing::named(touch.choice("weigh"))),
                friction: number("friction"),
                damping: number("damping"),
                tangential_stiffness: maybe("tangential_stiffness"),
                thickness: number("thickness"),
                heat: number("heat"),
                tears_at: maybe("tears_at"),
                imposed,
                site: reader.site(),
            },
            port: Port { coupling, passive: reader.boolean("passive") },
            between: Between::named(reader.choice("between")),
            name,
            site: reader.site(),
        }
    }
}
