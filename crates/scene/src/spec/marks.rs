//! What tools leave on the surface of a body.

use souple_models::marks::{BleedingLaw, MarkingLaw};
use souple_table::{Range, Value};

use crate::diagnostic::Site;
use crate::keys::{Key, Keys, Shape};
use crate::reader::Reader;

pub(crate) static MARKS: Keys = Keys::new(
    "marks",
    "a surface that whitens where it is pressed, burns where something hot touches it, and bleeds where it is torn",
    &[
        Key::number("whitening_pressure", "Pa", Range::POSITIVE, "that presses all blood out")
            .or(Value::Number(4e3)),
        Key::number("whitening_time", "s", Range::POSITIVE, "in which it whitens, but for 1/e")
            .or(Value::Number(0.15)),
        Key::number("refill_time", "s", Range::POSITIVE, "in which blood comes back, but for 1/e")
            .or(Value::Number(0.8)),
        Key::number("burn_dose", "J/m^2", Range::POSITIVE, "heat per area that chars it, but for 1/e")
            .or(Value::Number(2e4)),
        Key::new(
            "bleeding",
            Shape::Table(&BLEEDING),
            "blood wells up where its vessels are torn, and runs down it",
        ),
    ],
);

static BLEEDING: Keys = Keys::new(
    "bleeding",
    "blood that wells up where vessels are torn by pressure or cut, runs down the surface, and dries",
    &[
        Key::number("pressure", "Pa", Range::NOT_NEGATIVE, "at which vessels tear; tools may have their own")
            .or(Value::Number(2e4)),
        Key::number(
            "rate",
            "m/s",
            Range::POSITIVE,
            "volume that an open wound lets out, for each area and time",
        )
        .or(Value::Number(1e-4)),
        Key::number("clotting_time", "s", Range::POSITIVE, "in which a wound closes, but for 1/e")
            .or(Value::Number(60.0)),
        Key::number("drying_time", "s", Range::POSITIVE, "in which blood dries, but for 1/e")
            .or(Value::Number(300.0)),
        Key::number("viscosity", "Pa s", Range::POSITIVE, "of blood").or(Value::Number(3.5e-3)),
        Key::number(
            "clinging",
            "m",
            Range::NOT_NEGATIVE,
            "thickness of the blood that clings and does not run",
        )
        .or(Value::Number(5e-5)),
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
            bleeding: reader.table("bleeding").map(|bleeding| BleedingLaw {
                pressure: bleeding.number("pressure"),
                rate: bleeding.number("rate"),
                clotting_time: bleeding.number("clotting_time"),
                drying_time: bleeding.number("drying_time"),
                viscosity: bleeding.number("viscosity"),
                clinging: bleeding.number("clinging"),
            }),
        };
        Self { law, site: reader.site() }
    }
}
