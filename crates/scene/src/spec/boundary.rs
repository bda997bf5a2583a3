//! What holds and loads points: pins, prescribed motion, forces, springs to ground.

use souple_formal::Formula;
use souple_math::Vec3;
use souple_models::loads::VARIABLES;
use souple_table::{Range, Value};

use super::region::Region;
use crate::diagnostic::{Code, Site};
use crate::keys::{Key, Keys, Shape};
use crate::reader::Reader;

/// Variables of formulas of loads (where the point is) and motions (where it rests), and time.
pub const LOAD_VARIABLES: &[&str] = &VARIABLES;

pub(crate) static MOTION: Keys = Keys::new(
    "motion",
    "how points are led: key frames (`times` and `offsets`) or a `formula`",
    &[
        Key::new("times", Shape::Numbers, "of the key frames, growing").in_unit("s"),
        Key::new("offsets", Shape::Vectors, "from where the point rests, one for each time").in_unit("m"),
        Key::new("interpolation", Shape::Choice(&["linear", "smooth"]), "between key frames")
            .or(Value::Text("linear")),
        Key::new("formula", Shape::VectorFormula(LOAD_VARIABLES), "offset from where the point rests")
            .in_unit("m"),
    ],
);

pub(crate) static TURNING: Keys = Keys::new(
    "turning",
    "how points are turned: key frames (`times` and `offsets`) or a `formula` of a rotation vector",
    &[
        Key::new("times", Shape::Numbers, "of the key frames, growing").in_unit("s"),
        Key::new("offsets", Shape::Vectors, "rotation vectors from the start, one for each time")
            .in_unit("rad"),
        Key::new("interpolation", Shape::Choice(&["linear", "smooth"]), "between key frames")
            .or(Value::Text("linear")),
        Key::new("formula", Shape::VectorFormula(LOAD_VARIABLES), "rotation vector from the start")
            .in_unit("rad"),
    ],
);

pub(crate) static PIN: Keys = Keys::new(
    "pin",
    "points that are held, or led where a motion is written",
    &[
        Key::new("region", Shape::Region, "which points").required(),
        Key::new("axes", Shape::Axes, "the directions held; all where left out"),
        Key::new("motion", Shape::Table(&MOTION), "how they are led"),
        Key::new(
            "rotation",
            Shape::Table(&TURNING),
            "how they are turned about the pivot, before the motion",
        ),
        Key::vector("pivot", "m", "where they turn").or(Value::Vector([0.0; 3])),
        Key::new(
            "bone",
            Shape::Text,
            "the bone, or the shape, that they follow; in the place of a motion of their own",
        ),
    ],
);

const DISTRIBUTION: Shape = Shape::Choice(&["total", "each"]);

pub(crate) static LOAD: Keys = Keys::new(
    "load",
    "a `force` on points, a `traction` or `pressure` on faces, or a `body_force` in cells: one of them",
    &[
        Key::new("region", Shape::Region, "which points, faces of the surface, or cells").required(),
        Key::new(
            "force",
            Shape::VectorFormula(LOAD_VARIABLES),
            "on points: numbers, or formulas of time and of where the point is",
        )
        .in_unit("N"),
        Key::new(
            "distribution",
            DISTRIBUTION,
            "of a `force`: `total` is shared by the points equally, `each` acts on every point; total where left out",
        ),
        Key::new(
            "traction",
            Shape::VectorFormula(LOAD_VARIABLES),
            "force per area of the rest shape, which keeps its direction",
        )
        .in_unit("Pa"),
        Key::new(
            "pressure",
            Shape::Formula(LOAD_VARIABLES),
            "on the faces as they move and turn; positive pushes into the body",
        )
        .in_unit("Pa"),
        Key::new("body_force", Shape::VectorFormula(LOAD_VARIABLES), "force per volume of the rest shape")
            .in_unit("N/m^3"),
    ],
);

pub(crate) static SPRING: Keys = Keys::new(
    "spring",
    "springs from points to where they start",
    &[
        Key::new("region", Shape::Region, "which points").required(),
        Key::number("stiffness", "N/m", Range::NOT_NEGATIVE, "force per displacement").required(),
        Key::number("damping", "N s/m", Range::NOT_NEGATIVE, "force per velocity").or(Value::Number(0.0)),
        Key::new(
            "distribution",
            DISTRIBUTION,
            "`total`: shared by the points equally; `each`: of every point",
        )
        .or(Value::Text("total")),
    ],
);

/// Points that are held or led.
#[derive(Clone, Debug)]
pub struct Pin {
    pub region: Option<Region>,
    /// The directions held.
    pub axes: [bool; 3],
    pub motion: Option<MotionSpec>,
    /// Rotation vector about the pivot [rad].
    pub rotation: Option<MotionSpec>,
    /// [m]
    pub pivot: Vec3,
    /// What they follow.
    pub bone: Option<String>,
    pub site: Site,
}

/// An offset from the start, over time [m], or a rotation vector [rad].
#[derive(Clone, Debug)]
pub enum MotionSpec {
    KeyFrames {
        times: Vec<f64>,
        offsets: Vec<Vec3>,
        is_smooth: bool,
    },
    /// Of [`LOAD_VARIABLES`].
    Formula([Formula; 3]),
}

/// Whether a number is for all points together or for each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Distribution {
    Total,
    Each,
}

/// A load on a part of a body.
#[derive(Clone, Debug)]
pub struct Load {
    pub region: Option<Region>,
    /// `None` where it was refused.
    pub kind: Option<LoadKind>,
    pub site: Site,
}

/// What a load is, in formulas of [`LOAD_VARIABLES`].
#[derive(Clone, Debug)]
pub enum LoadKind {
    /// On points [N].
    Force([Formula; 3], Distribution),
    /// Per area of the rest shape [Pa].
    Traction([Formula; 3]),
    /// On the faces as they are now, positive inward [Pa].
    Pressure(Formula),
    /// Per volume of the rest shape [N/m³].
    BodyForce([Formula; 3]),
}

/// The keys of [`LOAD`] of which one says what the load is.
const LOAD_KINDS: [&str; 4] = ["force", "traction", "pressure", "body_force"];

/// Springs to ground.
#[derive(Clone, Debug)]
pub struct Spring {
    pub region: Option<Region>,
    /// [N/m]
    pub stiffness: f64,
    /// [N s/m]
    pub damping: f64,
    pub distribution: Distribution,
    pub site: Site,
}

impl Pin {
    pub(crate) fn read(reader: &Reader) -> Self {
        let motion = |key| reader.table(key).and_then(|table| MotionSpec::read(&table));
        for key in reader.written(&["motion", "rotation", "pivot"]) {
            if reader.has("bone") {
                let message = format!("a pin that follows a bone has no `{key}` of its own");
                reader.log().add(Code::Conflict, &reader.site_of(key), message, "one of them");
            }
        }
        Self {
            bone: reader.maybe_text("bone"),
            region: Region::read(reader, "region"),
            axes: reader.axes("axes"),
            motion: motion("motion"),
            rotation: motion("rotation"),
            pivot: reader.vector("pivot"),
            site: reader.site(),
        }
    }
}

impl MotionSpec {
    pub(crate) fn read(reader: &Reader) -> Option<Self> {
        let refuse = |message: String, expected: &str| {
            reader.log().add(Code::WrongType, &reader.site(), message, expected);
            None
        };
        if reader.has("formula") {
            if ["times", "offsets", "interpolation"].into_iter().any(|key| reader.has(key)) {
                return refuse("a motion has both a formula and key frames".to_owned(), "one of them");
            }
            return reader.maybe_vector_formula("formula").map(Self::Formula);
        }
        let (times, offsets) = (reader.maybe_numbers("times"), reader.maybe_vectors("offsets"));
        if !(reader.has("times") && reader.has("offsets")) {
            return refuse(
                "a motion says neither how nor when".to_owned(),
                "`times` and `offsets`, or a `formula`",
            );
        }
        // what could not be read is reported already
        let (times, offsets) = (times?, offsets?);
        if times.is_empty() || times.len() != offsets.len() {
            let message = format!("there are {} times and {} offsets", times.len(), offsets.len());
            return refuse(message, "one offset for each time, at least one");
        }
        if let Some(at) = times.windows(2).position(|pair| pair[0] >= pair[1]) {
            let message = format!("time {} does not come after {}", times[at + 1], times[at]);
            return refuse(message, "times that grow");
        }
        Some(Self::KeyFrames { times, offsets, is_smooth: reader.choice("interpolation") == "smooth" })
    }
}

impl Distribution {
    fn read(reader: &Reader) -> Self {
        if reader.choice("distribution") == "each" { Self::Each } else { Self::Total }
    }

    /// The part of each of `count` points.
    pub fn share(self, count: usize) -> f64 {
        match self {
            Self::Total => 1.0 / count as f64,
            Self::Each => 1.0,
        }
    }
}

impl Load {
    pub(crate) fn read(reader: &Reader) -> Self {
        Self { region: Region::read(reader, "region"), kind: LoadKind::read(reader), site: reader.site() }
    }
}

impl LoadKind {
    fn read(reader: &Reader) -> Option<Self> {
        let refuse = |message: String, expected: &str| {
            reader.log().add(Code::Conflict, &reader.site(), message, expected);
            None
        };
        let expected = format!("one of {}", LOAD_KINDS.join(", "));
        let written = reader.written(&LOAD_KINDS);
        let &[kind] = written.as_slice() else {
            return match written.as_slice() {
                [] => refuse("a load does not say what acts".to_owned(), &expected),
                several => refuse(format!("a load has {} at once", several.join(" and ")), &expected),
            };
        };
        if kind != "force" && reader.has("distribution") {
            return refuse(
                format!("a {kind} is not distributed over points"),
                "`distribution` beside a `force`",
            );
        }
        match kind {
            "force" => {
                reader.maybe_vector_formula(kind).map(|force| Self::Force(force, Distribution::read(reader)))
            }
            "traction" => reader.maybe_vector_formula(kind).map(Self::Traction),
            "pressure" => reader.maybe_formula(kind).map(Self::Pressure),
            _ => reader.maybe_vector_formula(kind).map(Self::BodyForce),
        }
    }
}

impl Spring {
    pub(crate) fn read(reader: &Reader) -> Self {
        Self {
            region: Region::read(reader, "region"),
            stiffness: reader.number("stiffness"),
            damping: reader.number("damping"),
            distribution: Distribution::read(reader),
            site: reader.site(),
        }
    }
}
