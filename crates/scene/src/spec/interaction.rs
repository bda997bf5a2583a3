//! What joins bodies: attachments within a system, couplings between systems.

use souple_table::{Range, Value};

use super::region::Region;
use crate::diagnostic::{Code, Site};
use crate::keys::{Key, Keys, Shape};
use crate::reader::Reader;

pub(crate) static ATTACHMENT: Keys = Keys::new(
    "attachment",
    "points of one body held to the nearest places of another, in one system: by stiff springs, or as rows of it",
    &[
        Key::new("from", Shape::Text, "the body whose points are attached").required(),
        Key::new("region", Shape::Region, "which of its points").required(),
        Key::new("to", Shape::Text, "the body they are attached to").required(),
        Key::new(
            "hold",
            Shape::Choice(&["rows", "springs"]),
            "`rows`: the points are no unknowns but hang on the cells that they touch, without slip; `springs`. Where left \
             out, points of a mesh that touch a mesh hang, unless numbers of springs are given",
        ),
        Key::number(
            "stiffness",
            "N/m",
            Range::POSITIVE,
            "of each point's spring; that of a thin layer of both materials where left out",
        ),
        Key::number("damping", "N s/m", Range::NOT_NEGATIVE, "of each point's spring").or(Value::Number(0.0)),
        Key::number("reach", "m", Range::NOT_NEGATIVE, "points further from the other body stay free"),
        Key::number(
            "strength",
            "Pa",
            Range::POSITIVE,
            "tension, over the area of a point, under which its spring tears for good; never where left out",
        ),
    ],
);

pub(crate) static COUPLING: Keys = Keys::new(
    "coupling",
    "damped springs between points of bodies in systems of different rates",
    &[
        Key::new("from", Shape::Text, "a body").required(),
        Key::new("region", Shape::Region, "which of its points").required(),
        Key::new("to", Shape::Text, "the body of another system, each point to its nearest").required(),
        Key::number("stiffness", "N/m", Range::POSITIVE, "of each point's spring").required(),
        Key::number("damping", "N s/m", Range::NOT_NEGATIVE, "of each point's spring").or(Value::Number(0.0)),
    ],
);

/// What holds attached points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Holding {
    /// They hang on the cells that they touch.
    Rows,
    Springs,
}

/// Springs from points of one body to places of another; `None` where the key was refused or left out.
#[derive(Clone, Debug)]
pub struct Link {
    pub from: String,
    pub region: Option<Region>,
    pub to: String,
    /// As written.
    pub hold: Option<Holding>,
    /// Of each point's spring [N/m]; that of a thin layer of both materials where `None`.
    pub stiffness: Option<f64>,
    /// Of each point's spring [N s/m].
    pub damping: f64,
    /// Tension over a point's area under which its spring tears [Pa]; infinite where it never does.
    pub strength: f64,
    /// Attached points are at most this far from the other body [m].
    pub reach: f64,
    pub site: Site,
    pub from_site: Site,
    pub to_site: Site,
}

impl Link {
    pub(crate) fn attachment(reader: &Reader) -> Self {
        let reach = reader.maybe_number("reach").unwrap_or(f64::INFINITY);
        let strength = reader.maybe_number("strength").unwrap_or(f64::INFINITY);
        let hold = reader.has("hold").then(|| match reader.choice("hold") {
            "rows" => Holding::Rows,
            _ => Holding::Springs,
        });
        let link = Self { reach, strength, hold, ..Self::coupling(reader) };
        if hold == Some(Holding::Rows) && link.has_spring() {
            let message = "rows have neither stiffness nor damping nor strength".to_owned();
            reader.log().add(
                Code::Conflict,
                &link.site,
                message,
                "`hold = \"springs\"`, or none of these numbers",
            );
        }
        link
    }

    /// Whether it has numbers of springs.
    pub(crate) fn has_spring(&self) -> bool {
        self.stiffness.is_some() || self.damping > 0.0 || self.strength.is_finite()
    }

    /// Couplings reach any distance.
    pub(crate) fn coupling(reader: &Reader) -> Self {
        Self {
            from: reader.text("from"),
            region: Region::read(reader, "region"),
            to: reader.text("to"),
            hold: None,
            stiffness: reader.maybe_number("stiffness"),
            damping: reader.number("damping"),
            strength: f64::INFINITY,
            reach: f64::INFINITY,
            site: reader.site(),
            from_site: reader.site_of("from"),
            to_site: reader.site_of("to"),
        }
    }
}
