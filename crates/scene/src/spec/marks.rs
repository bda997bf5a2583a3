//! What tools leave on the surface of a body.

use souple_models::marks::MarkingLaw;
use souple_table::{Range, Value};

use crate::diagnostic::Site;
use crate::keys::{Key, Keys};
use crate::reader::Reader;

pub(crate) static MARKS: Keys = Keys::new(
    "marks",
    "a surface that whitens where it is pressed, and burns where something hot touches it",
    &[
        Key::number("whitening_pressure", "Pa", Range::POSITIVE, "that presses all blood out")
            .or(Value::Number(4e3)),
        Key::number("whitening_time", "s", Range::POSITIVE, "in which it whitens, but for 1/e")
            .or(Value::Number(0.15)),
        Key::number("refill_time", "s", Range::POSITIVE, "in which blood comes back, but for 1/e")
            .or(Value::Number(0.8)),
        Key::number("burn_dose", "J/m^2", Range::POSITIVE, "heat per area that chars it, but for 1/e")
            .or(Value::Number(2e4)),
    ],
);

/// A surface that shows what was done to it, as specified.
pub struct MarksSpec {
    pub law: MarkingLaw,
    pub site: Site,
}

impl MarksSpec {
    pub(crate) fn read(reader: &Reader) -> Self {
        let law = MarkingLaw {
            whitening_pressure: reader.number("whitening_pressure"),
            whitening_time: reader.number("whitening_time"),
            refill_time: reader.number("refill_time"),
            burn_dose: reader.number("burn_dose"),
        };
        Self { law, site: reader.site() }
    }
}
