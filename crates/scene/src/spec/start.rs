//! How the points of a body stand and move at the start, as formulas of where they rest.

use souple_formal::Formula;
use souple_models::multiresolution::PLACE_VARIABLES;

use crate::diagnostic::Site;
use crate::keys::{Key, Keys, Shape};
use crate::reader::Reader;

pub(crate) static START: Keys = Keys::new(
    "start",
    "how its points stand and move at the start, by where they rest: numbers, or formulas of `x`, `y`, `z`",
    &[
        Key::new("displacement", Shape::VectorFormula(&PLACE_VARIABLES), "from where they rest").in_unit("m"),
        Key::new("velocity", Shape::VectorFormula(&PLACE_VARIABLES), "over that of the body").in_unit("m/s"),
    ],
);

/// The start of a body of points.
#[derive(Clone, Debug)]
pub struct StartSpec {
    /// Of [`PLACE_VARIABLES`].
    pub displacement: Option<[Formula; 3]>,
    /// Of the same.
    pub velocity: Option<[Formula; 3]>,
    pub site: Site,
}

impl StartSpec {
    pub(crate) fn read(reader: &Reader) -> Self {
        Self {
            displacement: reader.maybe_vector_formula("displacement"),
            velocity: reader.maybe_vector_formula("velocity"),
            site: reader.site(),
        }
    }
}
