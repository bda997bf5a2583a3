//! Bodies whose volume is kept.

use souple_models::solids::Pressures;
use souple_table::Range;

use crate::diagnostic::Site;
use crate::keys::{Key, Keys, Shape};
use crate::reader::Reader;

pub(crate) static INCOMPRESSIBLE: Keys = Keys::new(
    "incompressible",
    "its volume is kept, cell by cell or about its points, by multipliers beside a penalty: the augmented Lagrangian",
    &[
        Key::number(
            "penalty",
            "Pa",
            Range::POSITIVE,
            "what change of volume meets at once, added to the law's own bulk modulus; multipliers take over from it",
        )
        .required(),
        Key::number(
            "tolerance",
            "",
            Range::open(0.0, 1.0),
            "by what share of itself no volume changes, where steps solve equations; 1e-6 where left out",
        ),
        Key::number(
            "time",
            "s",
            Range::POSITIVE,
            "in which multipliers take over under explicit steppers, at least that in which the body's `rayleigh_mass` damps",
        ),
        Key::new(
            "pressures",
            Shape::Choice(&["cells", "points"]),
            "whether the volume of each cell is kept, or that about each point; where left out, that about points of `tet4`, and else of cells",
        ),
    ],
);

/// How the volume of a body is kept, as specified.
pub struct IncompressibleSpec {
    /// [Pa].
    pub penalty: f64,
    pub tolerance: Option<f64>,
    /// [s].
    pub time: Option<f64>,
    pub pressures: Pressures,
    pub site: Site,
}

impl IncompressibleSpec {
    pub(crate) fn read(reader: &Reader) -> Self {
        Self {
            penalty: reader.number("penalty"),
            tolerance: reader.maybe_number("tolerance"),
            time: reader.maybe_number("time"),
            pressures: match reader.choice("pressures") {
                _ if !reader.has("pressures") => Pressures::ByElement,
                "points" => Pressures::Points,
                _ => Pressures::Cells,
            },
            site: reader.site(),
        }
    }
}
