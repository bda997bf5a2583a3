//! Any bytes to the reader of `off`.
#![no_main]

libfuzzer_sys::fuzz_target!(|content: &[u8]| souple_fuzz::read_and_write_back("off", content));
