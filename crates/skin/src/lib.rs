//! A skin: the zero level of a potential on a sparse grid, moved by strategies, with tension, area and volume of its own.
//!
//! [`Skin`] holds what is constant: a lattice, a [`Target`](target::Target), a list of [`Term`](strategy::Term)s. What
//! evolves is a field of State: blocks of values around the surface. Each step moves it by as many sub-steps as it
//! needs, makes its triangles, checks that they are a closed manifold, and notes when its topology changes.

mod cases;
mod crossings;
mod dress;
mod error;
mod field;
mod forecast;
pub mod grid;
mod level_set;
mod look_up;
mod marks;
pub mod polygons;
mod pressing;
pub mod reaction;
mod skin;
mod speeds;
mod start;
pub mod strategy;
mod surface;
pub mod target;
mod topology;
mod view;
mod waking;
mod widest;

pub use dress::{Dressed, dress};
pub use error::SkinError;
pub use field::SkinField;
pub use forecast::Cost;
pub use grid::{BAND, Grid, Lattice};
pub use look_up::{Seen, look_up};
pub use polygons::{Measures, Polygons};
pub use skin::{Skin, SkinScratch};
pub use start::{Beginning, PlacedTarget};
pub use surface::{mean_curvature, surface_of};
pub use view::View;
