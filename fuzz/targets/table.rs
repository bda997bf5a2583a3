//! Any bytes to the reader of tables of numbers and of plans.
#![no_main]

libfuzzer_sys::fuzz_target!(|content: &[u8]| souple_fuzz::read_table(content));
