//! Bodies carried by frames: how many, where, with what weights, at which points.

use souple_engine::UnknownKind;
use souple_models::frames::{
    BuildPlacement, BuildPoints, BuildWeights, PLACEMENTS, POINTS, TangentKind, WEIGHTS,
};
use souple_table::{Range, Value, Values};

use super::bone::{BOUND, BoundFrames};
use crate::diagnostic::Site;
use crate::keys::{EntryShape, Key, Keys, NOWHERE, Shape, outlines};
use crate::reader::{Chosen, Reader};

const PLACEMENT: EntryShape = EntryShape {
    tag: "name",
    kind: "placement",
    outlines: || outlines(&PLACEMENTS),
    instead: &[],
    elsewhere: NOWHERE,
};
const WEIGHT: EntryShape = EntryShape {
    tag: "name",
    kind: "weights",
    outlines: || outlines(&WEIGHTS),
    instead: &[],
    elsewhere: NOWHERE,
};
const POINT: EntryShape = EntryShape {
    tag: "name",
    kind: "points",
    outlines: || outlines(&POINTS),
    instead: &[],
    elsewhere: NOWHERE,
};

/// Weights and points of bodies that name none.
pub const DEFAULT_WEIGHTS: &str = "wendland";
pub const DEFAULT_POINTS: &str = "cells";

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
        Key::new("bones", Shape::Tables(&BOUND), "which frames follow which bones"),
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
    pub bones: Vec<BoundFrames>,
    pub shown: usize,
    pub shown_site: Site,
    pub site: Site,
}

impl FramesSpec {
    /// So many times as many frames, placed in the same manner; frames that are listed stay, and others come between them.
    pub(crate) fn multiply(&mut self, times: f64) {
        let Some(placement) = &mut self.placement else { return };
        let values = &mut placement.values;
        let more = |count: f64| (count * times).round().max(1.0);
        if let Some(Value::Vector(counts)) = values.get("counts") {
            // of distances between frames as many as of frames on a long line
            let along = |count: f64| if count > 1.0 { 1.0 + more(count - 1.0) } else { count };
            values.set("counts", Value::Vector(counts.map(along)));
        } else if let Some(Value::Integer(count)) = values.get("count") {
            values.set("count", Value::Integer(more(count as f64) as i64));
        } else if let Some(Value::Numbers(at)) = values.get("at") {
            let (kept, count) = (at.to_vec(), more(at.len() as f64 / 3.0) as i64);
            if let Ok(entry) = PLACEMENTS.find("farthest_point") {
                let wanted =
                    Values::new().with("count", Value::Integer(count)).with("kept", Value::Numbers(&kept));
                if let Ok(values) = entry.values(wanted) {
                    *placement = Chosen {
                        entry,
                        values,
                        site: placement.site.clone(),
                        written: Vec::new(),
                        texts: Vec::new(),
                    };
                }
            }
        }
    }

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
            bones: reader.tables("bones").iter().map(BoundFrames::read).collect(),
            shown: reader.maybe_integer("shown").unwrap_or(0) as usize,
            shown_site: reader.site_of("shown"),
            site: reader.site(),
        }
    }
}
