//! Laws whose energy, stress and differential are derived from their texts, as files of Rust.
//!
//! `cargo xtask kernels` writes a file for each law of [`DERIVED`], by `souple derive --emit kernel`; a test compares them. A law in
//! the table of materials names its type from here and adds what a text does not say: what its numbers are called in scenes, their
//! ranges, and moduli at rest.
//!
//! Laws that are written by hand stay so where that is faster: Mooney and Rivlin's derived takes one and a half times as long in forces,
//! for powers of `J` share a logarithm there.

pub mod yeoh;

use souple_math::{Real, whole_power};

/// Laws of [`super::WRITTEN_LAWS`] that have a file here, with their texts.
pub const DERIVED: &[(&str, &str)] = &[("yeoh", include_str!("yeoh.rs"))];

/// `baseⁿ` of a base above zero.
#[inline(always)]
fn power<R: Real>(base: R, exponent: R) -> R {
    (base.ln() * exponent).exp()
}
