//! Elements, shape functions, quadrature, generators and quality of meshes.
//!
//! A [`Mesh`] is points and blocks of cells of one [`ElementKind`] each. What an element is (reference nodes,
//! polynomial basis, faces, rules of quadrature) is data in the table [`ELEMENTS`]; nothing else in this crate
//! knows an element by name except the generators.

mod boundary;
pub mod coarsen;
mod conformity;
mod creases;
mod decimate;
mod element;
mod error;
pub mod fill;
mod generate;
mod hull;
pub mod implicit;
mod locate;
mod measure;
mod memory;
mod mesh;
mod opening;
mod ordering;
mod polygon;
mod quadrature;
mod quality;
mod raise;
pub mod repair;
mod segment;
mod sets;
mod signed_distance;
mod signed_volume;
pub mod simplify;
mod split;
mod surface;
mod surface_quality;
pub mod tissue;
mod tree;
mod validate;
mod voronoi;
mod winding;

pub use boundary::{BoundaryFace, FaceReport, SplitQuadrilateral, facet_triangles, node_measures};
pub use conformity::{Conformity, HangingPoint};
pub use creases::creases;
pub use element::{ELEMENTS, Element, ElementKind, Face, MAX_NODES, Monomial, NodePlace, NodeValues};
pub use error::MeshError;
pub use generate::{Build, GENERATORS, MAX_CELLS, MeshSize, generate};
pub use hull::{MOST_HULL_POINTS, convex_hull};
pub use locate::{CellLocator, Location};
pub use measure::{BoundingBox, USUAL_SIZES};
pub use memory::{available_memory, gigabytes};
pub use mesh::{Cell, CellBlock, CellsByNumber, Group, Mesh};
pub use opening::{OpeningSurface, Span};
pub use ordering::{morton_order, recursive_bisection};
pub use polygon::{CutPolygon, MOST_POLYGON_CORNERS, cut_polygon, polygon_triangles};
pub use quadrature::{QuadraturePoint, QuadratureRule};
pub use quality::{CellQuality, Histogram, QualitySummary};
pub use segment::{NearestPair, closest_segment_triangle};
pub use sets::Sets;
pub use signed_distance::{ClosestPoint, SignedDistance};
pub use signed_volume::SignedVolume;
pub use split::SplitBy;
pub use surface::{Feature, TriangleSurface, closest_point_on_triangle, vertex_normals};
pub use surface_quality::TriangleQuality;
pub use tree::{Aabb, AabbTree};
pub use validate::Repairs;
pub use voronoi::{Part, VoronoiCells, Wall};
pub use winding::WindingNumber;
