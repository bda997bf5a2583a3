//! Bodies that move as a sum of their lowest natural modes, about a frame.

use souple_table::{Range, Value};

use crate::diagnostic::Site;
use crate::keys::{Key, Keys};
use crate::reader::Reader;

/// Most modes that are sought of one body.
const MOST_MODES: f64 = 200.0;

pub(crate) static MODES: Keys = Keys::new(
    "modes",
    "its lowest natural modes, of small strain at rest: the body moves as their sum, about a frame that its pins hold or that goes with it",
    &[
        Key::integer("count", Range::closed(1.0, MOST_MODES), "how many; higher ones are left out").required(),
        Key::number(
            "damping_ratio",
            "",
            Range::NOT_NEGATIVE,
            "of every mode, critical at 1; `rayleigh_mass` and `rayleigh_stiffness` of `damping` are proportional ones",
        )
        .or(Value::Number(0.0)),
    ],
);

/// The modes of a body as specified.
pub struct ModesSpec {
    pub count: usize,
    pub damping_ratio: f64,
    pub site: Site,
}

impl ModesSpec {
    pub(crate) fn read(reader: &Reader) -> Self {
        Self {
            // what was refused stays one mode, for other faults to be found
            count: reader.maybe_integer("count").map_or(1, |count| count as usize),
            damping_ratio: reader.number("damping_ratio"),
            site: reader.site(),
        }
    }
}
