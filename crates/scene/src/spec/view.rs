//! Points of view: places that links see in the place of masses.

use souple_math::Vec3;
use souple_table::{Range, Value};

use super::body::ROTATION;
use super::region::direction;
use crate::diagnostic::{Code, Site};
use crate::keys::{Key, Keys, Shape};
use crate::reader::Reader;

pub(super) static VIEW: Keys = Keys::new(
    "point_of_view",
    "what links see in the place of masses; forces come back so that no work is lost",
    &[
        Key::new("of", Shape::Text, "a group, a part or a port: each of its masses is seen, of `mean` all as one")
            .required(),
        Key::new(
            "kind",
            Shape::Choice(&["scale", "frame", "cylinder", "mean"]),
            "larger or smaller; turned and moved, or as seen from masses that move; by radius, angle and height; all together",
        )
        .required(),
        Key::number("factor", "", Range::ANY, "of scales").or(Value::Number(1.0)),
        Key::vector("origin", "m", "of scales what stays; of frames and cylinders where they are")
            .or(Value::Vector([0.0; 3])),
        Key::new("rotate", Shape::Table(&ROTATION), "of frames: turns what is seen about the origin of the world"),
        Key::new("moving_with", Shape::Text, "of frames: the masses whose mean is the origin, wherever it goes"),
        Key::vector("axis", "", "of cylinders").or(Value::Vector([0.0, 0.0, 1.0])),
        Key::new("weights", Shape::Numbers, "of means: of each mass; alike where left out"),
    ],
);

/// A point of view as it is written.
pub struct ViewSpec {
    pub name: String,
    pub of: String,
    pub kind: ViewKind,
    pub site: Site,
}

/// What is seen.
pub enum ViewKind {
    Scale {
        factor: f64,
        origin: Vec3,
    },
    /// Axis times angle [rad]; the name of what it moves with.
    Frame {
        rotation: Vec3,
        origin: Vec3,
        moving_with: Option<String>,
    },
    Cylinder {
        origin: Vec3,
        axis: Vec3,
    },
    Mean {
        weights: Vec<f64>,
    },
}

impl ViewSpec {
    /// How many points it shows of so many masses.
    pub fn count(&self, masses: u32) -> u32 {
        if matches!(self.kind, ViewKind::Mean { .. }) { 1 } else { masses }
    }

    pub(super) fn read(name: String, reader: &Reader) -> Option<Self> {
        let origin = reader.vector("origin");
        let kind = match reader.choice("kind") {
            "scale" => ViewKind::Scale { factor: reader.number("factor"), origin },
            "frame" => {
                let turn = |rotation: Reader| Some(direction(&rotation, "axis")? * rotation.number("angle"));
                let rotation = reader.table("rotate").and_then(turn).unwrap_or(Vec3::ZERO);
                let moving_with = Some(reader.text("moving_with")).filter(|name| !name.is_empty());
                ViewKind::Frame { rotation, origin, moving_with }
            }
            "cylinder" => {
                let Some(axis) = reader.vector("axis").try_normalised() else {
                    let (message, expected) = ("an axis of no length", "a vector that is not zero");
                    reader.log().add(Code::Conflict, &reader.site_of("axis"), message, expected);
                    return None;
                };
                ViewKind::Cylinder { origin, axis }
            }
            _ => ViewKind::Mean { weights: reader.numbers("weights") },
        };
        Some(Self { name, of: reader.text("of"), kind, site: reader.site() })
    }
}
