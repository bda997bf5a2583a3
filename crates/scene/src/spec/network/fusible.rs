//! Matter that melts and sets: what a crowd says of the heat of its masses and of the bonds between them.

use souple_formal::Formula;
use souple_table::{Range, Value};

use crate::diagnostic::Code;
use crate::keys::{Key, Keys, Shape};
use crate::reader::Reader;

pub(super) static FUSIBLE: Keys = Keys::new(
    "crowd_fusible",
    "bonds beside the law of a crowd, which soften, melt and set with the temperatures of its masses [K]",
    &[
        Key::number("capacity", "", Range::POSITIVE, "heat that warms a mass by one kelvin [J/K]").required(),
        Key::number("conductance", "", Range::NOT_NEGATIVE, "of two masses nearer than `reach` [W/K]")
            .or(Value::Number(0.0)),
        Key::number("melting", "", Range::POSITIVE, "at which no bond is left [K]").required(),
        Key::number(
            "softening",
            "",
            Range::NOT_NEGATIVE,
            "below which bonds are whole; in between their stiffness falls in proportion [K]",
        )
        .required(),
        Key::number("stiffness", "N/m", Range::POSITIVE, "of a whole bond").required(),
        Key::number("damping", "N s/m", Range::NOT_NEGATIVE, "of a whole bond").or(Value::Number(0.0)),
        Key::number(
            "reach",
            "m",
            Range::POSITIVE,
            "masses that are nearer set and conduct heat; up to the range of the crowd",
        )
        .required(),
        Key::new("temperature", Shape::Formula(&["x", "y", "z"]), "of masses that start there [K]")
            .required(),
        Key::new(
            "heating",
            Shape::Formula(&["x", "y", "z", "t"]),
            "of a mass from outside, wherever it is at the time [W]",
        ),
        Key::new("exchange", Shape::Formula(&["x", "y", "z", "t"]), "of a mass with what is `ambient` [W/K]"),
        Key::new("ambient", Shape::Formula(&["x", "y", "z", "t"]), "temperature of what is around [K]"),
    ],
);

/// Bonds that melt and set.
#[derive(Clone, Debug)]
pub struct FusibleSpec {
    /// [J/K]
    pub capacity: f64,
    /// [W/K]
    pub conductance: f64,
    /// [K]
    pub softening: f64,
    /// [K]
    pub melting: f64,
    /// [N/m]
    pub stiffness: f64,
    /// [N s/m]
    pub damping: f64,
    /// [m]
    pub reach: f64,
    /// At the start, of `x, y, z` [K].
    pub temperature: Option<Formula>,
    /// Of `x, y, z, t` [W].
    pub heating: Option<Formula>,
    /// [W/K] and [K], of the same.
    pub exchange: Option<[Formula; 2]>,
}

impl FusibleSpec {
    pub fn read(reader: &Reader) -> Self {
        let (softening, melting) = (reader.number("softening"), reader.number("melting"));
        if softening >= melting {
            let message = format!("bonds soften from {softening} K on and melt at {melting} K");
            reader.log().add(Code::Conflict, &reader.site_of("softening"), message, "less than `melting`");
        }
        if reader.has("exchange") != reader.has("ambient") {
            let message = "heat is exchanged with what has a temperature, at a rate";
            reader.log().add(
                Code::MissingKey,
                &reader.site(),
                message,
                "both `exchange` and `ambient`, or neither",
            );
        }
        let [exchange, ambient] = ["exchange", "ambient"].map(|key| reader.maybe_formula(key));
        Self {
            capacity: reader.number("capacity"),
            conductance: reader.number("conductance"),
            softening,
            melting,
            stiffness: reader.number("stiffness"),
            damping: reader.number("damping"),
            reach: reader.number("reach"),
            temperature: reader.maybe_formula("temperature"),
            heating: reader.maybe_formula("heating"),
            exchange: exchange.zip(ambient).map(|(exchange, ambient)| [exchange, ambient]),
        }
    }
}
