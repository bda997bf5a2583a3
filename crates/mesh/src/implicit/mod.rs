//! Shapes as functions of position: negative inside, positive outside, zero on the surface.
//!
//! [`Shape`] is what a filling asks; [`SHAPES`] is the table of shapes known by name, [`FormulaShape`] one written as
//! text, [`SurfaceShape`] the inside of triangles.

mod blend;
mod figures;
mod formula;
mod joined;
mod liver;
mod surface;

use souple_math::Vec3;
use souple_table::{Entry, Table, Values};

use crate::{BoundingBox, MeshError};

pub use blend::Solid;
pub use formula::FormulaShape;
pub use joined::JoinedSolids;
pub use surface::{Sign, SurfaceShape};

/// A solid as a function.
pub trait Shape: Send + Sync {
    /// Negative inside, positive outside. Where it is near the signed distance [m], growth of cells by distance and
    /// cuts of edges are found fastest; nothing else depends on that.
    fn value(&self, point: Vec3) -> f64;

    /// Two numbers that values lie between within a box; `None` where nothing is known.
    fn range(&self, _within: BoundingBox) -> Option<[f64; 2]> {
        None
    }

    /// A box around everything inside.
    fn bounds(&self) -> BoundingBox;
}

/// Of a distance, so far from where it is known.
fn around(distance: f64, reach: f64) -> [f64; 2] {
    [distance - reach, distance + reach]
}

/// A shape known by name, and parts of it that become groups.
pub struct Body {
    pub shape: Box<dyn Shape>,
    pub parts: Vec<(&'static str, Box<dyn Shape>)>,
}

/// Constructor of a body from completed values.
pub type BuildBody = fn(&Values) -> Result<Body, MeshError>;

/// All shapes known by name.
pub static SHAPES: Table<BuildBody> = Table {
    kind: "body shape",
    entries: &[
        &liver::LIVER,
        &figures::CHARACTER,
        &figures::BUNNY,
        &figures::TORUS,
        &figures::ELLIPSOID,
        &formula::FORMULA,
    ],
};

type BodyEntry = Entry<BuildBody>;

/// A shape by its name.
///
/// # Errors
/// The name or a parameter is unknown or out of range.
pub fn body(name: &str, values: Values) -> Result<Body, MeshError> {
    let entry = SHAPES.find(name)?;
    (entry.build)(&entry.values(values)?)
}
