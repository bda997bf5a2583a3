//! Contact: bodies against shapes, and body against body, by penalty with Coulomb friction, or by displacements.
//!
//! [`law`] says what force two things exert that touch; [`shape`] says where shapes are; [`ShapeContact`] (points),
//! [`ToolContact`] (triangles) and [`SurfaceContact`] find what touches and hand the forces to rows. [`ImposedContact`] does not
//! push: it moves the points that it holds.

mod burden;
mod carrier;
mod clip;
mod imposed;
#[cfg(test)]
mod imposed_tests;
#[cfg(test)]
mod late_tests;
pub mod law;
mod leading;
mod opening;
#[cfg(test)]
mod pair_tests;
pub mod passage;
pub mod shape;
mod shape_contact;
mod surface_contact;
#[cfg(test)]
mod tests;
mod tool_contact;
#[cfg(test)]
mod tool_tests;

pub use carrier::{Carrier, Pressed};
pub use imposed::{Displacing, ImposedContact, ImposedLaw};
pub use law::{ContactForce, ContactLaw, penalty_stiffness};
pub use opening::Shares;
pub use shape::{Nearest, Outline, SHAPES, Shape, ShapeError};
pub use shape_contact::{ContactPoint, ShapeContact, Touch};
pub use surface_contact::{ContactSurface, SurfaceContact, SurfaceContactError, SurfaceTouch};
pub use tool_contact::{ToolContact, ToolSurface, ToolTouch};
