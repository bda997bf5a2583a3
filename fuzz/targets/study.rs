//! Any bytes to the reader of studies and of their tables.
#![no_main]

libfuzzer_sys::fuzz_target!(|content: &[u8]| souple_fuzz::read_study(content));
