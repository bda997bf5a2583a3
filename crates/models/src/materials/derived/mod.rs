//! Laws whose energy, stress, differential and stiffness between nodes are derived from their texts, as files of Rust.
//!
//! `cargo xtask kernels` writes a file for each law of [`DERIVED`], by `souple derive --emit kernel`; a test compares them. A law in
//! the table of materials names its type from here and adds what a text does not say: what its numbers are called in scenes, their
//! ranges, and moduli at rest.
//!
//! Two laws of the table are written by hand: `ogden`, whose powers of principal stretches have no formula by entries, and
//! `corotational`, whose rotation is found without the stretches, by a polar decomposition that takes less.

pub mod linear;
pub mod mooney_rivlin;
pub mod neo_hookean;
pub mod st_venant_kirchhoff;
pub mod stable_neo_hookean;
pub mod yeoh;

use souple_math::{Real, whole_power};

/// Laws of [`super::WRITTEN_LAWS`] that have a file here, with their texts.
pub const DERIVED: &[(&str, &str)] = &[
    ("linear", include_str!("linear.rs")),
    ("mooney_rivlin", include_str!("mooney_rivlin.rs")),
    ("neo_hookean", include_str!("neo_hookean.rs")),
    ("st_venant_kirchhoff", include_str!("st_venant_kirchhoff.rs")),
    ("stable_neo_hookean", include_str!("stable_neo_hookean.rs")),
    ("yeoh", include_str!("yeoh.rs")),
];

/// `baseⁿ` of a base above zero.
#[inline(always)]
fn power<R: Real>(base: R, exponent: R) -> R {
    (base.ln() * exponent).exp()
}
