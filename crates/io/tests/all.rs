//! The tests of this crate, which are one program: as many programs as files would be linked one by one, each with all
//! that the crate stands on.

mod large_files;
mod mutations;
#[path = "../../../fuzz/src/mutator.rs"]
mod mutator;
mod other_readers;
mod properties;
mod surfaces;
