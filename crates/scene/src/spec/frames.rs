//! Bodies carried by frames: how many, where, with what weights, at which points.

use souple_engine::UnknownKind;
use souple_models::frames::{
    BuildPlacement, BuildPoints, BuildWeights, PLACEMENTS, POINTS, TangentKind, WEIGHTS,
};
use souple_table::{Range, Value};

use crate::diagnostic::Site;
use crate::keys::{EntryShape, Key, Keys, Shape, outlines};
use crate::reader::{Chosen, Reader};

const PLACEMENT: EntryShape =
    EntryShape { tag: "name", kind: "placement", outlines: || outlines(&PLACEMENTS), instead: &[] };
const WEIGHT: EntryShape =
    EntryShape { tag: "name", kind: "weights", outlines: || outlines(&WEIGHTS), instead: &[] };
const POINT: EntryShape =
    EntryShape { tag: "name", kind: "points", outlines: || outlines(&POINTS), instead: &[] };

pub(crate) static FRAMES: Keys = Keys::new(
    "frames",
    "a few frames that carry the body: its mesh is its shape, and no longer what moves",
    &[
        Key::new(
            "kind",
            Shape::Choice(&["rigid", "affine"]),
            "rigid: a position and a turn, 6 unknowns; affine: stretches and shears too, 12",
        )
        .or(Value::Text("rigid")),
        Key::new("placement", Shape::Entry(PLACEMENT), "how many frames, and where").required(),
        Key::new(
            "weights",
            Shape::Entry(WEIGHT),
            "how much each has to say at a point; `wendland` if left out",
        ),
        Key::new("points", Shape::Entry(POINT), "where strain and mass are taken; `cells` if left out"),
        Key::new(
            "tangent",
            Shape::Choice(&["full", "material"]),
            "what implicit steps see: the exact tangent, or that without the stiffness of the stress itself",
        )
        .or(Value::Text("full")),
        Key::integer(
            "shown",
            Range::NOT_NEGATIVE,
            "the frame whose weights are written as the field `influence`",
        )
        .or(Value::Integer(0)),
    ],
);

/// The frames of a body as specified; what was refused or left out is `None`.
pub struct FramesSpec {
    pub kind: UnknownKind,
    pub placement: Option<Chosen<BuildPlacement>>,
    pub weights: Option<Chosen<BuildWeights>>,
    pub points: Option<Chosen<BuildPoints>>,
    pub tangent: TangentKind,
    pub shown: usize,
    pub site: Site,
}

impl FramesSpec {
    pub(crate) fn read(reader: &Reader) -> Self {
        Self {
            kind: if reader.choice("kind") == "affine" {
                UnknownKind::AffineFrame
            } else {
                UnknownKind::RigidFrame
            },
            placement: reader.entry("placement", &PLACEMENTS),
            weights: reader.entry("weights", &WEIGHTS),
            points: reader.entry("points", &POINTS),
            tangent: if reader.choice("tangent") == "material" {
                TangentKind::Material
            } else {
                TangentKind::Full
            },
            shown: reader.maybe_integer("shown").unwrap_or(0) as usize,
            site: reader.site(),
        }
    }
}
