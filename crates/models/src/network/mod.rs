//! Networks of masses and interactions: points that have all the inertia, links that have all the behaviour.
//!
//! A mass is a point unknown of the engine. Links of one law are one [`souple_engine::Force`]; what they remember
//! lives in State. Laws are in [`laws`], one file and one line of its table each.

mod actuator;
mod cases;
pub mod constraints;
pub mod contour;
pub mod crowd;
mod crowd_acting;
mod crowd_grid;
mod crowd_list;
mod crowd_pass;
mod driven;
pub mod filling;
pub mod force;
pub mod friction;
mod fusible;
pub mod kernel;
pub mod law;
pub mod laws;
mod layout;
mod measures;
mod pair_tangent;
mod parting;
mod piecewise;
pub mod polyhedra;
pub mod relations;
mod rheology;
pub mod rigid_balls;
mod sample;
pub mod sided;
mod span;
mod view;
pub mod written;

pub use actuator::Actuator;
pub use constraints::{Augmented, Constraints, Keeping};
pub use crowd::{Crowd, CrowdDescription, Listing, PAIR_MEMORY};
pub use driven::{DRIVEN_PARAMETERS, DrivenLaw, Recipe, Wiring};
pub use filling::{Filling, FillingError, Gap, Gaps};
pub use force::{Account, LinkDescription, LinkStance, Links};
pub use friction::{Friction, Grip, Hook, Phase, Slide};
pub use fusible::Fusible;
pub use kernel::{InLanes, LinkKernel};
pub use law::{AsksFor, BuildLink, LinkEntry, LinkError, LinkLaw, Making, Moment, Reach, Response};
pub use laws::LINKS;
pub use layout::Ends;
pub use parting::{Apart, Parting};
pub use piecewise::Piecewise;
pub use polyhedra::{Entered, Polyhedra, PolyhedraDescription, Polyhedron};
pub use rigid_balls::{RigidBalls, RigidBallsDescription};
pub use sample::state_dimension;
pub use sided::{Sense, Sided, SidedConstraints};
pub use span::Span;
pub use view::{Map, ViewPoint, ViewedLinks};
