//! Any bytes as a tape that was kept: refused, or run.
#![no_main]

libfuzzer_sys::fuzz_target!(|content: &[u8]| souple_fuzz::run_tape(content));
