//! Mooney–Rivlin elasticity, decoupled: rubber at moderate stretch, with two shear moduli and a bulk modulus.
//!
//! Isochoric invariants bear the shape and `J` the volume, so that no pressure comes of shear; rubber and soft tissue are
//! hundreds of times stiffer against change of volume. Two constants fit stretches up to about two; for more take `ogden`,
//! for one constant `neo_hookean`, which is cheaper.

use souple_table::{Entry, Parameter, Range};

pub use super::derived::mooney_rivlin::MooneyRivlin;
use super::derived::mooney_rivlin::Numbers;
use super::{AnyLaw, BULK_MODULUS, Build, DENSITY, Lame, Material, MaterialError};

pub(super) const ENTRY: Entry<Build> = Entry {
    name: "mooney_rivlin",
    summary: "decoupled: rubber at moderate stretch, nearly incompressible; below 5 % of the rest volume the powers of J go \
              on smoothly: flat and inverted elements stay finite and are pushed back; one shrunk to a line or point feels \
              no push from its shape",
    source: "Mooney 1940; Rivlin 1948; decoupled form after Holzapfel 2000, Nonlinear Solid Mechanics, §6.5",
    parameters: &[
        Parameter::number(
            "c10",
            "Pa",
            Range::ANY,
            "c₁₀: of the first invariant; the shear modulus is 2 (c₁₀ + c₀₁)",
        ),
        Parameter::number("c01", "Pa", Range::ANY, "c₀₁: of the second invariant"),
        BULK_MODULUS,
        DENSITY,
    ],
    build: |values| {
        let [c10, c01, bulk] = ["c10", "c01", "bulk_modulus"].map(|name| values.number(name));
        let shear = 2.0 * (c10 + c01);
        if shear <= 0.0 {
            let message = format!(
                "c10 + c01 is {} Pa, so the body would give way under the least shear; their sum must be above 0",
                c10 + c01
            );
            return Err(MaterialError::of("c01", message));
        }
        let small_strain = Lame::from_shear_bulk(shear, bulk);
        let numbers = Numbers { c10, c01, k: bulk };
        Ok(Material::known(AnyLaw::MooneyRivlin, numbers, small_strain, values.number("density")))
    },
};
