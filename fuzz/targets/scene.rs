//! Any bytes to the reader of scenes.
#![no_main]

libfuzzer_sys::fuzz_target!(|content: &[u8]| souple_fuzz::read_scene(content));
