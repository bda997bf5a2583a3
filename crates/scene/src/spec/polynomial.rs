//! Bodies that move as one polynomial of where their matter rests.

use souple_models::reduced::Degree;
use souple_table::{Range, Value};

use crate::diagnostic::Site;
use crate::keys::{Key, Keys};
use crate::reader::Reader;

pub(crate) static POLYNOMIAL: Keys = Keys::new(
    "polynomial",
    "the body moves as one polynomial of where its matter rests: its mesh is its shape, and no longer what moves",
    &[Key::integer(
        "degree",
        Range::closed(1.0, 2.0),
        "1: affine, 12 unknowns and one strain all over; 2: quadratic, 30, which bends and twists",
    )
    .or(Value::Integer(2))],
);

/// The polynomial of a body as specified.
pub struct PolynomialSpec {
    pub degree: Degree,
    pub site: Site,
}

impl PolynomialSpec {
    pub(crate) fn read(reader: &Reader) -> Self {
        let degree = match reader.maybe_integer("degree") {
            Some(1) => Degree::Affine,
            _ => Degree::Quadratic,
        };
        Self { degree, site: reader.site() }
    }
}
