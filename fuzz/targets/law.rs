//! Any bytes as a law: read, derived, tried and compiled.
#![no_main]

libfuzzer_sys::fuzz_target!(|content: &[u8]| souple_fuzz::read_law(content));
