//! Any bytes to the reader of `.pvd`.
#![no_main]

libfuzzer_sys::fuzz_target!(|content: &[u8]| souple_fuzz::read_series(content));
