//! Yeoh elasticity, decoupled: rubber that is soft at moderate stretch and stiffens beyond.
//!
//! A cubic in the first isochoric invariant, with the volume borne by a term of its own. One test, in tension or in shear, fits it;
//! `mooney_rivlin` is cheaper where nothing stiffens, `ogden` follows several tests at once.

use souple_table::{Entry, Parameter, Range};

use super::derived::yeoh::Numbers;
pub use super::derived::yeoh::Yeoh;
use super::{AnyLaw, BULK_MODULUS, Build, DENSITY, Lame, Material};

pub(super) const ENTRY: Entry<Build> = Entry {
    name: "yeoh",
    summary: "decoupled: rubber that stiffens, cubic in the first invariant; below 5 % of the rest volume the powers of J go on \
              smoothly: flat and inverted elements stay finite and are pushed back",
    source: "Yeoh 1993, Some forms of the strain energy function for rubber",
    parameters: &[
        Parameter::number("c1", "Pa", Range::POSITIVE, "half the shear modulus at rest"),
        Parameter::number("c2", "Pa", Range::ANY, "of the square of the invariant; often below zero"),
        Parameter::number("c3", "Pa", Range::ANY, "of its cube: how it stiffens at large stretch"),
        BULK_MODULUS,
        DENSITY,
    ],
    build: |values| {
        let [c1, c2, c3, k] = ["c1", "c2", "c3", "bulk_modulus"].map(|name| values.number(name));
        let small_strain = Lame::from_shear_bulk(2.0 * c1, k);
        let numbers = Numbers { c1, c2, c3, k };
        Ok(Material::known(AnyLaw::Yeoh, numbers, small_strain, values.number("density")))
    },
};
