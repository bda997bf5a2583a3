//! Any bytes to the reader of particles, and what is read to the dresser.
#![no_main]

libfuzzer_sys::fuzz_target!(|content: &[u8]| souple_fuzz::dress_particles(content));
