//! Masses that fill a shape: what is filled, and how closely.

use std::sync::{Arc, OnceLock};

use souple_math::Vec3;
use souple_models::contact::shape::BuildShape;
use souple_models::contact::{SHAPES, Shape as ContactShape};
use souple_models::network::{Filling, Gap, Gaps};
use souple_table::{Range, Value};

use super::super::contact::SHAPE_ENTRY;
use super::super::mesh::{MESH, MeshSpec};
use crate::diagnostic::{Code, Site};
use crate::keys::{Key, Keys, Shape};
use crate::reader::{Chosen, Reader};

pub(super) static FILL: Keys = Keys::new(
    "mass_fill",
    "balls that fill a closed shape: a sheet that touches its surface from within, and a close packing inside",
    &[
        Key::new(
            "shape",
            Shape::Entry(SHAPE_ENTRY),
            "what is filled: a ball, a box, ground under a height, …",
        ),
        Key::new(
            "mesh",
            Shape::Entry(MESH),
            "or the inside of a mesh: a file, a generator, a shape by its formula",
        ),
        Key::number("spacing", "m", Range::POSITIVE, "diameter of the balls").required(),
        Key::number(
            "inset",
            "m",
            Range::NOT_NEGATIVE,
            "of the outermost centres from the surface; a radius where left out",
        ),
        Key::number(
            "depth",
            "m",
            Range::POSITIVE,
            "only so deep below the outermost: a crust, a hollow shape",
        ),
        Key::new(
            "gaps",
            Shape::Choice(&["left", "closed"]),
            "on the surface that are farther than a radius from all balls: `closed` by balls below it",
        )
        .or(Value::Text("left")),
        Key::new(
            "box",
            Shape::Corners,
            "where centres may be; around the shape where left out. A flat one holds a plane of balls",
        )
        .in_unit("m"),
    ],
);

/// What a filling gave.
pub struct Filled {
    pub places: Vec<Vec3>,
    /// Where the surface is farthest from the balls.
    pub widest: Option<Gap>,
    /// What was filled, and how.
    pub shape: Arc<dyn ContactShape>,
    pub filling: Filling,
}

/// A shape to be filled, and what that gave once it has been.
pub struct FillSpec {
    pub shape: Option<Chosen<BuildShape>>,
    pub mesh: Option<MeshSpec>,
    /// [m]
    pub spacing: f64,
    /// [m]
    pub inset: f64,
    /// [m]
    pub depth: f64,
    pub gaps: Gaps,
    /// Corners [m].
    pub bounds: Option<[Vec3; 2]>,
    pub filled: OnceLock<Filled>,
    pub site: Site,
}

impl FillSpec {
    pub(super) fn read(reader: &Reader) -> Self {
        if reader.has("shape") == reader.has("mesh") {
            let message = "one thing is filled";
            reader.log().add(Code::WrongType, &reader.site(), message, "`shape`, or `mesh`, and not both");
        }
        let spacing = reader.number("spacing");
        Self {
            shape: reader.has("shape").then(|| reader.entry("shape", &SHAPES)).flatten(),
            mesh: reader.has("mesh").then(|| MeshSpec::read(reader)).flatten(),
            spacing,
            inset: reader.maybe_number("inset").unwrap_or(0.5 * spacing),
            depth: reader.maybe_number("depth").unwrap_or(f64::INFINITY),
            gaps: if reader.choice("gaps") == "closed" { Gaps::Closed } else { Gaps::Left },
            bounds: reader.corners("box").map(|[a, b]| [a.min_components(b), a.max_components(b)]),
            filled: OnceLock::new(),
            site: reader.site(),
        }
    }

    /// None before it has been filled.
    pub fn places(&self) -> &[Vec3] {
        self.filled.get().map_or(&[], |filled| &filled.places)
    }
}
