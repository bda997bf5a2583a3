//! Any bytes to the readers of formulas, conditions, quantities and units.
#![no_main]

libfuzzer_sys::fuzz_target!(|content: &[u8]| souple_fuzz::read_formula(content));
