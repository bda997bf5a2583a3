//! Materials: hyperelastic laws, one file each, and their table.
//!
//! A new law is a file with an `impl Law` and an `ENTRY`, and its line in the list below.

// F, P, S, J as in the equations: the reader has the paper beside the code
#![allow(non_snake_case)]

mod corotational;
mod invariants;
mod law;
mod linear;
mod neo_hookean;
mod st_venant_kirchhoff;
mod stable_neo_hookean;

use souple_math::Mat3;
use souple_table::{Entry, Parameter, Range, Table, Values};

pub use law::{Lame, Law, Parameters};

/// Writes the table, the choice of a law at run time and its dispatch from one list.
macro_rules! laws {
    ($($module:ident: $Law:ident,)+) => {
        $(pub use $module::$Law;)+

        /// All materials.
        pub static TABLE: Table<Build> = Table { kind: "material", entries: &[$(&$module::ENTRY),+] };

        /// One of the laws of [`TABLE`], as a value.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum AnyLaw { $($Law),+ }

        impl AnyLaw {
            pub const ALL: &[Self] = &[$(Self::$Law),+];

            /// Runs the visitor's generic function for this law.
            pub fn visit<V: LawVisitor>(self, visitor: V) -> V::Output {
                match self { $(Self::$Law => visitor.visit($Law)),+ }
            }

            /// The law's page in [`TABLE`].
            pub fn entry(self) -> &'static Entry<Build> {
                match self { $(Self::$Law => &$module::ENTRY),+ }
            }
        }
    };
}

laws! {
    linear: Linear,
    corotational: Corotational,
    st_venant_kirchhoff: StVenantKirchhoff,
    neo_hookean: NeoHookean,
    stable_neo_hookean: StableNeoHookean,
}

/// What an entry makes of its completed values.
pub type Build = fn(&Values) -> Material;

/// A function generic over laws, to be instantiated for each and chosen by [`AnyLaw::visit`].
pub trait LawVisitor {
    type Output;
    fn visit<L: Law>(self, law: L) -> Self::Output;
}

/// The most numbers a law may have: the width of [`Material::parameters`].
pub const PARAMETERS_MAX: usize = 8;

/// A law with its numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    pub law: AnyLaw,
    /// The law's numbers in the order of its [`Parameters::NAMES`], zeros behind them.
    pub parameters: [f64; PARAMETERS_MAX],
    /// Moduli at rest, for wave speeds and scales [Pa].
    pub small_strain: Lame,
    /// Mass per rest volume [kg/m³].
    pub density: f64,
}

/// Parameters shared by all isotropic laws of two moduli.
const ISOTROPIC: &[Parameter] = &[
    Parameter::number("youngs_modulus", "Pa", Range::POSITIVE, "E: stiffness of a slender rod in tension"),
    Parameter::number(
        "poissons_ratio",
        "",
        Range::open(-1.0, 0.5),
        "ν: lateral contraction per extension of a rod",
    ),
    Parameter::number("density", "kg/m³", Range::POSITIVE, "ρ: mass per volume of the rest shape"),
];

impl Material {
    /// From the completed values of [`ISOTROPIC`].
    fn isotropic(law: AnyLaw, values: &Values) -> Self {
        let lame = Lame::from_young_poisson(values.number("youngs_modulus"), values.number("poissons_ratio"));
        let mut parameters = [0.0; PARAMETERS_MAX];
        lame.pack(|i, number| parameters[i] = number);
        Self { law, parameters, small_strain: lame, density: values.number("density") }
    }

    /// The numbers as the law `L` takes them.
    pub fn parameters_of<L: Law>(&self) -> L::Parameters<f64> {
        L::Parameters::unpack(|i| self.parameters[i])
    }

    /// [`Law::energy_density`] of this material [J/m³].
    pub fn energy_density(&self, F: &Mat3) -> f64 {
        struct Energy<'a>(&'a Material, &'a Mat3);
        impl LawVisitor for Energy<'_> {
            type Output = f64;
            fn visit<L: Law>(self, _: L) -> f64 {
                L::energy_density(&self.0.parameters_of::<L>(), self.1)
            }
        }
        self.law.visit(Energy(self, F))
    }

    /// [`Law::stress`] of this material [Pa].
    pub fn stress(&self, F: &Mat3) -> Mat3 {
        struct Stress<'a>(&'a Material, &'a Mat3);
        impl LawVisitor for Stress<'_> {
            type Output = Mat3;
            fn visit<L: Law>(self, _: L) -> Mat3 {
                L::stress(&self.0.parameters_of::<L>(), self.1)
            }
        }
        self.law.visit(Stress(self, F))
    }
}

/// Cauchy stress `σ = P Fᵀ / det F` [Pa]; `None` where the element has no volume.
pub fn cauchy_stress(P: &Mat3, F: &Mat3) -> Option<Mat3> {
    let J = F.determinant();
    let sigma = P.mul_transpose(F) * (1.0 / J);
    (J != 0.0 && sigma.is_finite()).then_some(sigma)
}
