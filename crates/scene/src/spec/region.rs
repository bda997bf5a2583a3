//! Regions: parts of a body, by name, shape, index or condition.

use souple_formal::Condition;
use souple_math::Vec3;
use souple_table::Range;

use crate::diagnostic::{Code, Site};
use crate::document::Content;
use crate::keys::{Key, Keys, Shape};
use crate::reader::Reader;
use crate::values::Reading;

/// A part of a body.
#[derive(Clone, Debug)]
pub struct Region {
    pub kind: RegionKind,
    pub site: Site,
}

/// How a region says what belongs to it; positions are those of the body as placed.
#[derive(Clone, Debug)]
pub enum RegionKind {
    All,
    /// A group of the mesh.
    Group(String),
    Box {
        low: Vec3,
        high: Vec3,
    },
    Sphere {
        centre: Vec3,
        radius: f64,
    },
    /// Where `(x - point) · normal <= 0`.
    HalfSpace {
        point: Vec3,
        normal: Vec3,
    },
    /// The one point closest to a position.
    Nearest(Vec3),
    Points(Vec<u32>),
    Cells(Vec<u32>),
    /// Of x, y, z.
    Formula(Condition),
    Union(Vec<Region>),
    Intersection(Vec<Region>),
    Not(std::boxed::Box<Region>),
}

/// Regions within regions, at most.
const DEEPEST: usize = 16;

pub(crate) static SPHERE: Keys = Keys::new(
    "sphere_region",
    "points within a ball",
    &[
        Key::vector("centre", "m", "centre of the ball").required(),
        Key::number("radius", "m", Range::NOT_NEGATIVE, "radius of the ball").required(),
    ],
);

pub(crate) static HALF_SPACE: Keys = Keys::new(
    "half_space_region",
    "points on the side of a plane that its normal points away from",
    &[
        Key::vector("point", "m", "a point of the plane").required(),
        Key::vector("normal", "", "points out of the region").required(),
    ],
);

pub(crate) static REGION: Keys = Keys::new(
    "region",
    "a part of a body; exactly one of these keys, or the name of a group as text",
    &[
        Key::new("all", Shape::Boolean, "everything"),
        Key::new("group", Shape::Text, "a group of the mesh"),
        Key::new("box", Shape::Corners, "what lies between two corners, faces included").in_unit("m"),
        Key::new("sphere", Shape::Table(&SPHERE), "what lies in a ball"),
        Key::new("half_space", Shape::Table(&HALF_SPACE), "what lies behind a plane"),
        Key::vector("nearest", "m", "the point closest to a position"),
        Key::new("points", Shape::Integers, "points by number"),
        Key::new("cells", Shape::Integers, "cells by number, and their points"),
        Key::new("formula", Shape::Condition(&["x", "y", "z"]), "where a condition holds"),
        Key::new("union", Shape::Regions, "what is in one of several regions"),
        Key::new("intersection", Shape::Regions, "what is in all of several regions"),
        Key::new("not", Shape::Region, "what is not in a region"),
    ],
);

impl Region {
    /// The region at a key; `None` where it is left out or was refused.
    pub(crate) fn read(reader: &Reader, key: &str) -> Option<Self> {
        Self::from_reading(&reader.reading(key)?, 0)
    }

    /// `depth` regions lie around this one.
    pub(crate) fn from_reading(reading: &Reading, depth: usize) -> Option<Self> {
        let site = reading.site();
        if let Content::Text(name) = &reading.node.content {
            return Some(Self { kind: RegionKind::Group(name.clone()), site });
        }
        if depth == DEEPEST {
            let expected = format!("at most {DEEPEST} regions within each other");
            return reading.refuse(Code::TooLarge, "the region is nested too deep", expected);
        }
        let reader = Reader::open(reading, &REGION)?;
        let written = reader.written(&REGION.known());
        let [key] = written[..] else {
            let message = format!("a region says one thing, this one says {}", written.len());
            let expected = format!("exactly one of {}", REGION.known().join(", "));
            return reading.refuse(Code::WrongType, message, expected);
        };
        let kind = Self::kind(&reader, key, depth)?;
        Some(Self { kind, site })
    }

    fn kind(reader: &Reader, key: &str, depth: usize) -> Option<RegionKind> {
        Some(match key {
            "all" if reader.boolean(key) => RegionKind::All,
            "all" => RegionKind::Points(Vec::new()),
            "group" => RegionKind::Group(reader.maybe_text(key)?),
            "box" => {
                let [a, b] = reader.corners(key)?;
                RegionKind::Box { low: a.min_components(b), high: a.max_components(b) }
            }
            "sphere" => {
                let sphere = reader.table(key)?;
                RegionKind::Sphere {
                    centre: sphere.maybe_vector("centre")?,
                    radius: sphere.maybe_number("radius")?,
                }
            }
            "half_space" => {
                let plane = reader.table(key)?;
                let normal = direction(&plane, "normal")?;
                RegionKind::HalfSpace { point: plane.maybe_vector("point")?, normal }
            }
            "nearest" => RegionKind::Nearest(reader.maybe_vector(key)?),
            "points" => RegionKind::Points(reader.maybe_indices(key)?),
            "cells" => RegionKind::Cells(reader.maybe_indices(key)?),
            "formula" => RegionKind::Formula(reader.maybe_condition(key)?),
            "not" => RegionKind::Not(Box::new(Self::from_reading(&reader.reading(key)?, depth + 1)?)),
            _ => {
                let items = reader
                    .reading(key)?
                    .list("a list of regions", |item| Self::from_reading(item, depth + 1))?;
                if key == "union" { RegionKind::Union(items) } else { RegionKind::Intersection(items) }
            }
        })
    }
}

/// A vector of length one; a vector without length is refused.
pub(crate) fn direction(reader: &Reader, key: &str) -> Option<Vec3> {
    let vector = reader.maybe_vector(key)?;
    let length = vector.largest_component();
    if !(length > 0.0 && length.is_finite()) {
        reader.log().add(
            Code::OutOfRange,
            &reader.site_of(key),
            "this vector has no direction",
            "a vector that is not zero",
        );
        return None;
    }
    // scaled first, so that the square of the length neither vanishes nor overflows
    (vector * (1.0 / length)).try_normalised()
}
