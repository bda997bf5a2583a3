//! What holds and loads points: pins, prescribed motion, forces, springs to ground.

use souple_formal::Formula;
use souple_math::Vec3;
use souple_models::loads::VARIABLES;
use souple_table::{Range, Value};

use super::region::Region;
use crate::diagnostic::{Code, Site};
use crate::keys::{Key, Keys, Shape};
use crate::reader::Reader;

/// Variables of formulas of loads (where the point is) and motions (where it started), and time.
pub const LOAD_VARIABLES: &[&str] = &VARIABLES;

pub(crate) static MOTION: Keys = Keys::new(
    "motion",
    "how points are led: key frames (`times` and `offsets`) or a `formula`",
    &[
        Key::new("times", Shape::Numbers, "of the key frames, growing").in_unit("s"),
        Key::new("offsets", Shape::Vectors, "from where the point started, one for each time").in_unit("m"),
        Key::new("interpolation", Shape::Choice(&["linear", "smooth"]), "between key frames")
            .or(Value::Text("linear")),
        Key::new("formula", Shape::VectorFormula(LOAD_VARIABLES), "offset from where the point started")
            .in_unit("m"),
    ],
);

pub(crate) static PIN: Keys = Keys::new(
    "pin",
    "points that are held, or led where a motion is written",
    &[
        Key::new("region", Shape::Region, "which points").required(),
        Key::new("axes", Shape::Axes, "the directions held; all where left out"),
        Key::new("motion", Shape::Table(&MOTION), "how they are led"),
    ],
);

const DISTRIBUTION: Shape = Shape::Choice(&["total", "each"]);

pub(crate) static LOAD: Keys = Keys::new(
    "load",
    "a force on points",
    &[
        Key::new("region", Shape::Region, "which points").required(),
        Key::new("force", Shape::VectorFormula(LOAD_VARIABLES), "numbers, or formulas of time and place")
            .in_unit("N")
            .required(),
        Key::new(
            "distribution",
            DISTRIBUTION,
            "`total`: shared by the points equally; `each`: on every point",
        )
        .or(Value::Text("total")),
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
    pub site: Site,
}

/// An offset from the start, over time [m].
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

/// A force on points.
#[derive(Clone, Debug)]
pub struct Load {
    pub region: Option<Region>,
    /// Of [`LOAD_VARIABLES`] [N].
    pub force: Option<[Formula; 3]>,
    pub distribution: Distribution,
    pub site: Site,
}

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
        let motion = reader.table("motion").and_then(|table| MotionSpec::read(&table));
        let (region, axes) = (Region::read(reader, "region"), reader.axes("axes"));
        Self { region, axes, motion, site: reader.site() }
    }
}

impl MotionSpec {
    pub(crate) fn read(reader: &Reader) -> Option<Self> {
        let refuse = |message: String, expected: &str| {
            reader.log().add(Code::WrongType, &reader.site(), message, expected);
            None
        };
        if reader.has("formula") {
            if reader.has("times") || reader.has("offsets") {
                return refuse("a motion has both a formula and key frames".to_owned(), "one of them");
            }
            return reader.maybe_vector_formula("formula").map(Self::Formula);
        }
        let (times, offsets) = (reader.numbers("times"), reader.vectors("offsets"));
        if !(reader.has("times") && reader.has("offsets")) {
            return refuse(
                "a motion says neither how nor when".to_owned(),
                "`times` and `offsets`, or a `formula`",
            );
        }
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
        Self {
            region: Region::read(reader, "region"),
            force: reader.maybe_vector_formula("force"),
            distribution: Distribution::read(reader),
            site: reader.site(),
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
