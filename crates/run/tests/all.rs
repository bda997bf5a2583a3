//! The tests of this crate, which are one program: as many programs as files would be linked one by one, each with all
//! that the crate stands on.

mod adapting;
mod crowds;
mod cut_open;
mod cut_touch;
mod folds;
mod frequencies;
mod hands;
mod kneaded;
mod levels_resume;
mod monitor;
mod networks_resume;
mod passages;
mod pictures;
mod sounds;
