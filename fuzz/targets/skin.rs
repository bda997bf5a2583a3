//! Any bytes as a scene; the skins of small ones are made and stepped.
#![no_main]

libfuzzer_sys::fuzz_target!(|content: &[u8]| souple_fuzz::step_skins(content));
