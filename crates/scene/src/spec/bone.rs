//! Bones: rigid motions with names, which frames and pins follow; one may follow another.

use souple_math::Vec3;
use souple_table::Value;

use super::boundary::{MOTION, MotionSpec, TURNING};
use crate::diagnostic::{Code, Site};
use crate::keys::{Key, Keys, Shape};
use crate::reader::Reader;

pub(crate) static BONE: Keys = Keys::new(
    "bone",
    "a rigid motion with a name, which frames and pins follow",
    &[
        Key::new("motion", Shape::Table(&MOTION), "how it is led"),
        Key::new("rotation", Shape::Table(&TURNING), "how it is turned about the pivot, before the motion"),
        Key::vector("pivot", "m", "where it turns: its joint, as all stands at rest")
            .or(Value::Vector([0.0; 3])),
        Key::new("follows", Shape::Text, "a bone that takes it along"),
    ],
);

pub(crate) static BOUND: Keys = Keys::new(
    "bound_frames",
    "frames that follow a bone",
    &[
        Key::new("bone", Shape::Text, "of `bones`, or a shape of `shapes` with its motion").required(),
        Key::new("frames", Shape::Integers, "which frames, by number in the order of their placement")
            .required(),
    ],
);

/// A rigid motion with a name.
#[derive(Clone, Debug)]
pub struct BoneSpec {
    pub name: String,
    pub motion: Option<MotionSpec>,
    /// Rotation vector about the pivot [rad].
    pub rotation: Option<MotionSpec>,
    /// [m]
    pub pivot: Vec3,
    pub follows: Option<String>,
    pub follows_site: Site,
    pub site: Site,
}

/// Frames that follow a bone.
#[derive(Clone, Debug)]
pub struct BoundFrames {
    pub bone: String,
    pub frames: Vec<u32>,
    pub site: Site,
}

impl BoneSpec {
    pub(crate) fn read(name: String, reader: &Reader) -> Self {
        let motion = |key| reader.table(key).and_then(|table| MotionSpec::read(&table));
        Self {
            name,
            motion: motion("motion"),
            rotation: motion("rotation"),
            pivot: reader.vector("pivot"),
            follows: reader.maybe_text("follows"),
            follows_site: reader.site_of("follows"),
            site: reader.site(),
        }
    }
}

impl BoundFrames {
    pub(crate) fn read(reader: &Reader) -> Self {
        Self {
            bone: reader.text("bone"),
            frames: {
                let frames = reader.maybe_indices("frames").unwrap_or_default();
                if reader.has("frames") && frames.is_empty() {
                    let message = "no frame is named";
                    reader.log().add(
                        Code::OutOfRange,
                        &reader.site_of("frames"),
                        message,
                        "numbers of frames, such as [0]",
                    );
                }
                frames
            },
            site: reader.site(),
        }
    }
}
