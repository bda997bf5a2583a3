//! The tests of this crate, which are one program: as many programs as files would be linked one by one, each with all
//! that the crate stands on.

mod centred;
mod faults;
mod how_to;
mod lost;
mod manifold;
mod reference_bars;
