//! What joins bodies: attachments within a system, couplings between systems.

use souple_table::{Range, Value};

use super::region::Region;
use crate::diagnostic::Site;
use crate::keys::{Key, Keys, Shape};
use crate::reader::Reader;

pub(crate) static ATTACHMENT: Keys = Keys::new(
    "attachment",
    "stiff springs from points of one body to the nearest places of another, in one system",
    &[
        Key::new("from", Shape::Text, "the body whose points are attached").required(),
        Key::new("region", Shape::Region, "which of its points").required(),
        Key::new("to", Shape::Text, "the body they are attached to").required(),
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

/// Springs from points of one body to places of another; `None` where the key was refused or left out.
#[derive(Clone, Debug)]
pub struct Link {
    pub from: String,
    pub region: Option<Region>,
    pub to: String,
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
        Self { reach, strength, ..Self::coupling(reader) }
    }

    /// Couplings reach any distance.
    pub(crate) fn coupling(reader: &Reader) -> Self {
        Self {
            from: reader.text("from"),
            region: Region::read(reader, "region"),
            to: reader.text("to"),
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
