//! The tests of this crate, which are one program: as many programs as files would be linked one by one, each with all
//! that the crate stands on.

mod answers;
mod common;
mod contract;
mod derive;
mod determinism;
mod faults;
mod frames_needed;
mod fuzz_targets;
mod kept_laws;
mod mesh_faults;
mod modes;
mod regression;
mod render;
mod results;
mod scenes;
mod tools;
mod words;
