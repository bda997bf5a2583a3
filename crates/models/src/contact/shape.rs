//! Shapes that bodies touch: the nearest point of a shape, its normal and how it turns.
//!
//! A shape is written in its own place and knows no motion. Adding one is an entry in [`SHAPES`].

mod capsule;
mod closed_surface;
mod cuboid;
mod height;
mod jaws;
mod plane;
mod sphere;

use std::fmt::Debug;

use souple_engine::Configuration;
use souple_engine::obstacle::Side;
use souple_formal::ParseError;
use souple_math::{Mat3, Vec3};
use souple_mesh::{MeshError, TriangleSurface};
use souple_table::{Entry, Parameter, Table, Value, Values};

pub use capsule::Capsule;
pub use closed_surface::ClosedSurface;
pub use cuboid::Cuboid;
pub use height::Height;
pub use jaws::Jaws;
pub use plane::Plane;
pub use sphere::Sphere;

/// What a point sees of a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Negative inside [m].
    pub distance: f64,
    /// Unit gradient of the distance, outward.
    pub normal: Vec3,
    /// `∂normal/∂x` [1/m], symmetric.
    pub curvature: Mat3,
}

/// A body of fixed shape.
pub trait Shape: Send + Sync + Debug {
    /// `None` where the distance surely exceeds `reach`, or has no answer (a point that is not finite).
    fn nearest(&self, point: Vec3, reach: f64) -> Option<Nearest>;

    /// The same of a shape that a field of State holds.
    fn nearest_in(&self, _at: &Configuration, point: Vec3, reach: f64) -> Option<Nearest> {
        self.nearest(point, reach)
    }

    /// In words, what at a point the formula that the shape is of comes to, where that is no number: there is nothing to touch then.
    fn undefined_at(&self, _point: Vec3) -> Option<String> {
        None
    }

    /// Whether a point comes no nearer to it than it moves itself, as it does where the answer is the distance to a thing that rests.
    fn is_distance(&self) -> bool {
        false
    }

    /// Rows that bear what pushes on it; none of a thing that nothing moves.
    fn bearers(&self) -> &[u32] {
        &[]
    }

    /// Visits the bearers of a point, by their places in [`Shape::bearers`], with shares whose sum is one.
    fn visit_shares(&self, _at: &Configuration, _point: Vec3, _visit: &mut dyn FnMut(usize, f64)) {}

    /// A point and the normal of a shape that is a half-space, for drawing it as a ground.
    fn as_plane(&self) -> Option<(Vec3, Vec3)> {
        None
    }

    /// The rounded parts that a tool is made of; none of a shape that is no tool.
    fn parts(&self) -> &[Capsule] {
        &[]
    }

    /// The surface of a bounded shape, for drawing it.
    fn outline(&self) -> Option<Outline> {
        None
    }
}

/// The surface of a shape, curved ones by triangles small enough to look round.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// Facing out of the solid, also where that is into the hollow of a container.
    pub surface: TriangleSurface,
    /// On which side of it bodies are.
    pub bodies: Side,
}

impl Outline {
    fn solid(surface: TriangleSurface) -> Self {
        Self { surface, bodies: Side::Outside }
    }
}

/// A shape that cannot be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ShapeError {
    #[error("`{field}` is {value}, but must be {expected}")]
    Unfit { field: &'static str, value: String, expected: &'static str },
    #[error(
        "`{field}` = \"{text}\" is no formula: {error}; one of {variables} is accepted, such as {example}"
    )]
    Formula {
        field: &'static str,
        text: String,
        variables: &'static str,
        example: &'static str,
        error: Box<ParseError>,
    },
    #[error("`{field}` = \"{surface}\" cannot be a shape: {error}")]
    Surface { field: &'static str, surface: String, error: Box<MeshError> },
    #[error("`{field}` = \"{surface}\" cannot be read: {message}")]
    NoSurface { field: &'static str, surface: String, message: String },
}

/// Finds the surface that a scene names (a file, a generator), or says why there is none.
pub type SurfaceSource<'a> = &'a dyn Fn(&str) -> Result<TriangleSurface, String>;

/// Constructor of a shape from completed values.
pub type BuildShape = fn(&Values, SurfaceSource) -> Result<Box<dyn Shape>, ShapeError>;

pub type ShapeEntry = Entry<BuildShape>;

pub const SHAPES: Table<BuildShape> = Table {
    kind: "shape",
    entries: &[
        &plane::ENTRY,
        &sphere::ENTRY,
        &capsule::ENTRY,
        &jaws::ENTRY,
        &cuboid::ENTRY,
        &height::ENTRY,
        &closed_surface::ENTRY,
    ],
};

/// Whether bodies are kept outside or inside.
const HOLLOW: Parameter =
    Parameter::boolean("hollow", "`true`: bodies are kept inside the shape, which is a container")
        .or(Value::Boolean(false));

/// A container: the outside of a shape.
#[derive(Debug)]
struct Hollow<S>(S);

impl<S: Shape> Shape for Hollow<S> {
    fn nearest(&self, point: Vec3, _reach: f64) -> Option<Nearest> {
        // points far outside the container are deep inside its wall: none is beyond reach
        let Nearest { distance, normal, curvature } = self.0.nearest(point, f64::INFINITY)?;
        Some(Nearest { distance: -distance, normal: -normal, curvature: -curvature })
    }

    fn is_distance(&self) -> bool {
        self.0.is_distance()
    }

    fn outline(&self) -> Option<Outline> {
        let mut outline = self.0.outline()?;
        outline.surface.triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
        Some(Outline { bodies: Side::Inside, ..outline })
    }
}

fn boxed<S: Shape + 'static>(shape: S, values: &Values) -> Box<dyn Shape> {
    if values.boolean("hollow") { Box::new(Hollow(shape)) } else { Box::new(shape) }
}

/// Whether a point is surely farther than `distance` from `centre`, not by rounding alone; without a root.
fn is_beyond(point: Vec3, centre: Vec3, distance: f64) -> bool {
    (point - centre).length_sq() > distance * distance * (1.0 + 8.0 * f64::EPSILON)
}

/// Distance to a rounded thing of `radius` about `centre`, the nearest point of a line, segment or point; at
/// the centre itself, where every direction is as good, along `fallback`.
///
/// `flat` are directions in which the centre follows the point: they do not turn the normal.
fn rounded(point: Vec3, centre: Vec3, radius: f64, flat: Mat3, fallback: Vec3) -> Nearest {
    let offset = point - centre;
    let length = offset.length();
    match offset.try_normalised() {
        // ∂n/∂x = (I - n nᵀ - flat)/|x - c|
        Some(n) => Nearest {
            distance: length - radius,
            normal: n,
            curvature: (Mat3::IDENTITY - n.outer(n) - flat) * (1.0 / length),
        },
        None => Nearest { distance: -radius, normal: fallback, curvature: Mat3::ZERO },
    }
}

/// Rings of a half ball, and points around each ring.
const RINGS: usize = 12;
const AROUND: usize = 4 * RINGS;

/// The surface of all points within `radius` of a segment: rings about its axis, from pole to pole.
fn rounded_surface(from: Vec3, to: Vec3, radius: f64) -> TriangleSurface {
    let axis = (to - from).try_normalised().unwrap_or(Vec3::Z);
    let across = axis.any_orthogonal();
    let along = axis.cross(across);
    // the ring at the equator is there twice, once about each end
    let mut points = vec![from - axis * radius];
    for (centre, first) in [(from, 1), (to, RINGS)] {
        for ring in first..first + RINGS {
            let polar = std::f64::consts::FRAC_PI_2 * (ring as f64 / RINGS as f64);
            let (height, width) = (-radius * libm::cos(polar), radius * libm::sin(polar));
            points.extend((0..AROUND).map(|k| {
                let angle = std::f64::consts::TAU * k as f64 / AROUND as f64;
                centre + axis * height + (across * libm::cos(angle) + along * libm::sin(angle)) * width
            }));
        }
    }
    points.push(to + axis * radius);
    let (rings, last) = (2 * RINGS, points.len() as u32 - 1);
    let at = |ring: usize, k: usize| (1 + ring * AROUND + k % AROUND) as u32;
    let mut triangles = Vec::new();
    for k in 0..AROUND {
        triangles.push([0, at(0, k + 1), at(0, k)]);
        for ring in 1..rings {
            triangles.push([at(ring - 1, k), at(ring - 1, k + 1), at(ring, k + 1)]);
            triangles.push([at(ring - 1, k), at(ring, k + 1), at(ring, k)]);
        }
        triangles.push([at(rings - 1, k), at(rings - 1, k + 1), last]);
    }
    TriangleSurface { points, triangles, ..TriangleSurface::default() }
}

/// Parameter as a direction.
fn direction(field: &'static str, values: &Values) -> Result<Vec3, ShapeError> {
    let vector = Vec3::from_array(values.vector(field));
    vector.try_normalised().ok_or_else(|| ShapeError::Unfit {
        field,
        value: format!("{:?}", vector.to_array()),
        expected: "a vector that is not zero",
    })
}

#[cfg(test)]
mod tests;
