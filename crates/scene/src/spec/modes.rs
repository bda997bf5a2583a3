//! Bodies that move as a sum of their lowest natural modes, about a frame.

use souple_models::reduced::{GLOBAL_DEFORMATIONS, GlobalDeformation};
use souple_table::{Range, Value};

use crate::diagnostic::{Code, Site};
use crate::keys::{Key, Keys, Shape, one_of};
use crate::reader::Reader;

/// Most modes that are sought of one body.
const MOST_MODES: f64 = 200.0;
/// Polynomials of the fifth degree have 168 numbers: as many fields over all points are kept while modes are sought.
const HIGHEST_DEGREE: f64 = 5.0;

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
        Key::integer(
            "degree",
            Range::closed(1.0, HIGHEST_DEGREE),
            "modes are sought among polynomials of this degree of where matter rests, and move all points by such; among all fields of the mesh where left out",
        ),
        Key::new(
            "global",
            Shape::Texts,
            "deformations of the whole of a free body beside the modes, which are sought across them: stretch_x, twist_x, shear_xy, taper_xy, bend_xy, of other axes too, which turn with `rotate`",
        ),
        Key::number(
            "global_stiffness",
            "",
            Range::POSITIVE,
            "of what resists a global deformation: as a part of what the law does",
        )
        .or(Value::Number(1.0)),
    ],
);

/// The modes of a body as specified.
pub struct ModesSpec {
    pub count: usize,
    pub damping_ratio: f64,
    /// Of the polynomials that modes are sought among; `None`: among all fields of the mesh.
    pub degree: Option<usize>,
    /// Deformations of the whole, each told once.
    pub global: Vec<GlobalDeformation>,
    /// Part of the law's own.
    pub global_stiffness: f64,
    pub site: Site,
}

impl ModesSpec {
    pub(crate) fn read(reader: &Reader) -> Self {
        Self {
            // what was refused stays one mode, for other faults to be found
            count: reader.maybe_integer("count").map_or(1, |count| count as usize),
            damping_ratio: reader.number("damping_ratio"),
            degree: reader.maybe_integer("degree").map(|degree| degree as usize),
            global: global(reader),
            global_stiffness: reader.number("global_stiffness"),
            site: reader.site(),
        }
    }
}

fn global(reader: &Reader) -> Vec<GlobalDeformation> {
    let mut found = Vec::new();
    let refuse = |message: String, expected: &str| {
        reader.log().add(Code::Conflict, &reader.site_of("global"), message, expected);
    };
    for name in reader.texts("global") {
        match GLOBAL_DEFORMATIONS.find(&name) {
            Err(_) => {
                let names: Vec<&str> = GLOBAL_DEFORMATIONS.names().collect();
                refuse(format!("`{name}` is no deformation of a whole body"), &one_of(&names));
            }
            Ok(known) if found.contains(&known.build) => {
                refuse(format!("`{name}` is there twice"), "each deformation once");
            }
            Ok(known) => found.push(known.build),
        }
    }
    found
}
