//! Bodies of triangles that resist bending: thin shells.

use souple_math::Vec3;
use souple_models::solids::Rigidities;
use souple_table::{Range, Value};

use super::region::Region;
use crate::diagnostic::{Code, Site};
use crate::keys::{Key, Keys, Shape};
use crate::reader::Reader;

const RIGIDITIES: [&str; 4] = ["along", "across", "coupling", "twist"];

pub(crate) static BENDING: Keys = Keys::new(
    "bending",
    "makes a membrane of `tri3` a thin shell: it resists changes of curvature, by the law and thickness of the body where no \
     rigidities are told",
    &[
        Key::vector(
            "axis",
            "",
            "the first axis, brought into the plane of each triangle; the second is across it",
        )
        .or(Value::Vector([1.0, 0.0, 0.0])),
        Key::number("along", "N m", Range::POSITIVE, "rigidity D₁₁ of bending along the first axis"),
        Key::number("across", "N m", Range::POSITIVE, "rigidity D₂₂ of bending along the second axis"),
        Key::number(
            "coupling",
            "N m",
            Range::ANY,
            "rigidity D₁₂: moment along one axis of bending along the other, ν D of an isotropic plate",
        ),
        Key::number(
            "twist",
            "N m",
            Range::POSITIVE,
            "rigidity D₆₆ of twist: moment per 2 κ₁₂, (1 - ν) D / 2 of an isotropic plate",
        ),
        Key::vector(
            "natural_curvature",
            "1/m",
            "κ₁₁, κ₂₂ and κ₁₂ that it wants beside those of its rest shape, positive towards its normals",
        )
        .or(Value::Vector([0.0; 3])),
        Key::number(
            "rayleigh_stiffness",
            "s",
            Range::NOT_NEGATIVE,
            "time b of moments b D κ̇ that damp bending, beside those of `damping.viscosity`",
        )
        .or(Value::Number(0.0)),
        Key::new(
            "clamped",
            Shape::Region,
            "edges of the border with both ends inside keep the slope that they have at rest, and turn as pins lead both ends by a \
             `rotation`; pins hold their points",
        ),
    ],
);

/// How a body resists bending as specified.
pub struct BendingSpec {
    pub axis: Vec3,
    /// Those of the law and the thickness where left out.
    pub rigidities: Option<Rigidities>,
    /// `(κ₁₁, κ₂₂, κ₁₂)` [1/m].
    pub natural_curvature: Vec3,
    /// Of moments per rate of the curvature over those per curvature [s].
    pub rayleigh_stiffness: f64,
    pub clamped: Option<Region>,
    pub site: Site,
}

impl BendingSpec {
    pub(crate) fn read(reader: &Reader) -> Self {
        Self {
            axis: super::region::direction(reader, "axis").unwrap_or(Vec3::X),
            rigidities: rigidities(reader),
            natural_curvature: reader.vector("natural_curvature"),
            rayleigh_stiffness: reader.number("rayleigh_stiffness"),
            clamped: reader.has("clamped").then(|| Region::read(reader, "clamped")).flatten(),
            site: reader.site(),
        }
    }
}

fn rigidities(reader: &Reader) -> Option<Rigidities> {
    let refuse = |message: String, expected: &str| {
        reader.log().add(Code::Conflict, &reader.site(), message, expected);
        None
    };
    let written = reader.written(&RIGIDITIES);
    if written.is_empty() {
        return None;
    }
    let [along, across, coupling, twist] = RIGIDITIES.map(|name| reader.maybe_number(name));
    let (Some(along), Some(across), Some(coupling), Some(twist)) = (along, across, coupling, twist) else {
        let message = format!("a plate has four rigidities, and here are {}", written.join(", "));
        return refuse(message, "along, across, coupling and twist, or none of them");
    };
    let rigidities = Rigidities { along, across, coupling, twist };
    if !rigidities.are_definite() {
        let message =
            format!("with a coupling of {coupling} N m, bending both ways at once would cost no energy");
        return refuse(message, "a coupling whose square is less than `along` times `across`");
    }
    Some(rigidities)
}
