//! Actuators of networks: forces that controls command.

use souple_math::Vec3;
use souple_table::Range;

use crate::diagnostic::{Code, Site};
use crate::keys::{Key, Keys, Shape};
use crate::reader::Reader;

pub(super) static ACTUATOR: Keys = Keys::new(
    "actuator",
    "a force on masses along a direction, whose magnitude a control commands once a period",
    &[
        Key::new("of", Shape::Text, "a group, a part or a port, whose masses share it equally").required(),
        Key::vector("direction", "", "where a positive command pushes, of any length").required(),
        Key::number(
            "largest",
            "N",
            Range::POSITIVE,
            "magnitude, beyond which commands are cut off; none where left out",
        ),
    ],
);

/// An actuator as it is written.
pub struct ActuatorSpec {
    pub name: String,
    pub of: String,
    /// Not zero.
    pub direction: Vec3,
    /// [N]; infinite where there is none.
    pub largest: f64,
    pub site: Site,
}

impl ActuatorSpec {
    pub(super) fn read(name: String, reader: &Reader) -> Self {
        let direction = reader.vector("direction");
        if reader.has("direction") && direction.try_normalised().is_none() {
            let message = "a direction of no length";
            let expected = "a vector that is not zero, such as [1, 0, 0]";
            reader.log().add(Code::Conflict, &reader.site_of("direction"), message, expected);
        }
        Self {
            name,
            of: reader.text("of"),
            direction,
            largest: reader.maybe_number("largest").unwrap_or(f64::INFINITY),
            site: reader.site(),
        }
    }
}
