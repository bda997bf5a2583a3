//! The tests of this crate, which are one program: as many programs as files would be linked one by one, each with all
//! that the crate stands on.

mod adaptive;
mod bending;
mod common;
mod crowds;
mod emitted_code;
mod formulations;
mod frames;
mod implicit;
mod incompressible;
mod inelastic;
mod kept_laws;
mod materials;
mod multiresolution;
mod network;
mod octree;
mod polyhedra;
mod rooms;
mod sections;
mod solids;
mod sums;
mod written_laws;
