//! The tests of this crate, which are one program: as many programs as files would be linked one by one, each with all
//! that the crate stands on.

mod fit;
mod linear_quadratic;
mod motion;
mod mutations;
mod state_space;
mod study;
