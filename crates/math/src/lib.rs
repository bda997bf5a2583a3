//! Small fixed-size algebra, written once over plain numbers, SIMD lanes and dual numbers.
//!
//! A kernel generic over [`Real`] serves as test oracle (`f64`), as the hot loop ([`Lanes`]) and as
//! its own derivative check ([`Dual`]).

mod couple;
mod decomposition;
mod dual;
mod lanes;
mod matrix;
mod packed;
mod padded;
mod real;
mod rotation;
mod vector;

pub use couple::couple;
pub use decomposition::{Eigen, Polar, Svd, eigen_symmetric, polar, project_psd, svd, turn_of_stretch};
pub use dual::Dual;
pub use lanes::Lanes;
pub use matrix::Mat3;
pub use padded::{Padded, prefetch};
pub use real::{Real, whole_power};
pub use rotation::{axes_along, exponential, logarithm, orthonormalised};
pub use vector::Vec3;
