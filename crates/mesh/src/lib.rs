//! Elements, shape functions, quadrature, generators and quality of meshes.
//!
//! A [`Mesh`] is points and blocks of cells of one [`ElementKind`] each. What an element is (reference nodes,
//! polynomial basis, faces, rules of quadrature) is data in the table [`ELEMENTS`]; nothing else in this crate
//! knows an element by name except the generators.

mod boundary;
mod element;
mod error;
mod generate;
mod locate;
mod measure;
mod mesh;
mod ordering;
mod quadrature;
mod quality;
mod signed_distance;
mod surface;
mod tree;
mod validate;

pub use boundary::{BoundaryFace, FaceReport, SplitQuadrilateral};
pub use element::{ELEMENTS, Element, ElementKind, Face, MAX_NODES, Monomial, NodeValues};
pub use error::MeshError;
pub use generate::{Build, GENERATORS, MAX_CELLS, generate};
pub use locate::{CellLocator, Location};
pub use measure::BoundingBox;
pub use mesh::{Cell, CellBlock, Group, Mesh};
pub use ordering::{morton_order, recursive_bisection};
pub use quadrature::{QuadraturePoint, QuadratureRule};
pub use quality::{CellQuality, Histogram, QualitySummary};
pub use signed_distance::{ClosestPoint, SignedDistance};
pub use surface::{Feature, TriangleSurface, closest_point_on_triangle, vertex_normals};
pub use tree::{Aabb, AabbTree};
pub use validate::Repairs;
