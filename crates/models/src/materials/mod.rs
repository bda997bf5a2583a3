//! Materials: hyperelastic laws, one file each, and their table.
//!
//! A new law is a file with an `ENTRY` and its line in the list below; its `impl Law` is derived from its text by `cargo xtask kernels`
//! (`derived/`) or, where it has no formula in the entries of `F`, written by hand. A law that is wanted in one scene needs no file:
//! `hyperelastic` takes it as text.

// F, P, S, J as in the equations: the reader has the paper beside the code
#![allow(non_snake_case)]

mod corotational;
mod derived;
mod hyperelastic;
pub(crate) mod invariants;
mod isochoric;
pub(crate) mod kept;
mod law;
mod library;
mod linear;
mod mooney_rivlin;
mod neo_hookean;
mod of_table;
mod ogden;
mod st_venant_kirchhoff;
mod stable_neo_hookean;
mod yeoh;

use std::sync::Arc;

use souple_engine::CellField;
use souple_formal::law::Strain;
use souple_math::{Mat3, Vec3};
use souple_table::{Entry, Parameter, Range, Table, Values};

pub use derived::DERIVED;
pub use hyperelastic::{MaterialError, TextLaw, is_parameter, law_text};
pub use kept::KeptLaws;
pub use law::{Lame, Law, Parameters};
pub use library::{WRITTEN_LAWS, WrittenLaw, lines_of};

/// Writes the table, the choice of a law at run time and its dispatch from one list.
macro_rules! laws {
    ($($module:ident: $Law:ident,)+) => {
        $(pub use $module::$Law;)+

        /// All materials.
        pub static TABLE: Table<Build> =
            Table { kind: "material", entries: &[$(&$module::ENTRY,)+ &hyperelastic::ENTRY] };

        /// One of the laws of [`TABLE`] that are compiled ahead, as a value.
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
    mooney_rivlin: MooneyRivlin,
    ogden: Ogden,
    yeoh: Yeoh,
}

/// What an entry makes of its completed values.
pub type Build = fn(&Values) -> Result<Material, MaterialError>;

/// A function generic over laws, to be instantiated for each and chosen by [`AnyLaw::visit`].
pub trait LawVisitor {
    type Output;
    fn visit<L: Law>(self, law: L) -> Self::Output;
}

/// Small enough for a law to be what it is at rest, and far above rounding.
const SMALL_STRETCH: f64 = 1e-4;

/// The most numbers a law may have: the width of [`Material::parameters`].
pub const PARAMETERS_MAX: usize = 8;

/// The law of a material.
#[derive(Clone, Debug, PartialEq)]
pub enum MaterialLaw {
    /// Compiled with the program.
    Known(AnyLaw),
    /// Written as text, compiled when the scene is read.
    Text(Arc<TextLaw>),
}

impl MaterialLaw {
    /// Whether its stress is linear in `F - I`.
    pub fn is_linear(&self) -> bool {
        struct IsLinear;
        impl LawVisitor for IsLinear {
            type Output = bool;
            fn visit<L: Law>(self, _: L) -> bool {
                L::LINEAR
            }
        }
        match self {
            Self::Known(law) => law.visit(IsLinear),
            Self::Text(law) => law.is_linear(),
        }
    }

    /// Whether a rotation of the body leaves its energy as it is.
    pub fn is_objective(&self) -> bool {
        struct IsObjective;
        impl LawVisitor for IsObjective {
            type Output = bool;
            fn visit<L: Law>(self, _: L) -> bool {
                L::OBJECTIVE
            }
        }
        match self {
            Self::Known(law) => law.visit(IsObjective),
            Self::Text(law) => law.strain() == Strain::Finite,
        }
    }
}

/// A law with its numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    pub law: MaterialLaw,
    /// The numbers of a known law in the order of its [`Parameters::NAMES`], zeros behind them; a law as text holds its
    /// own.
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
    DENSITY,
];

const DENSITY: Parameter =
    Parameter::number("density", "kg/m³", Range::POSITIVE, "ρ: mass per volume of the rest shape");

const BULK_MODULUS: Parameter = Parameter::number(
    "bulk_modulus",
    "Pa",
    Range::POSITIVE,
    "k: stiffness against change of volume; some hundred times the shear modulus for rubber",
);

impl Material {
    /// From the completed values of [`ISOTROPIC`].
    fn isotropic(law: AnyLaw, values: &Values) -> Result<Self, MaterialError> {
        let lame = Lame::from_young_poisson(values.number("youngs_modulus"), values.number("poissons_ratio"));
        Ok(Self::known(law, lame, lame, values.number("density")))
    }

    /// A law with numbers of its own.
    fn known<P: Parameters<f64>>(law: AnyLaw, numbers: P, small_strain: Lame, density: f64) -> Self {
        let mut parameters = [0.0; PARAMETERS_MAX];
        numbers.pack(|i, number| parameters[i] = number);
        Self { law: MaterialLaw::Known(law), parameters, small_strain, density }
    }

    /// Bulk and shear modulus at rest [Pa]; of an anisotropic law the mean shear modulus over all directions.
    pub fn bulk_and_shear(&self) -> [f64; 2] {
        let Lame { lambda, mu } = self.small_strain;
        match &self.law {
            MaterialLaw::Known(_) => [lambda + 2.0 / 3.0 * mu, mu],
            MaterialLaw::Text(law) => law.bulk_and_shear(),
        }
    }

    /// How large a modulus of [`Self::bulk_and_shear`] must be to be told from the rounding of the others [Pa].
    pub fn modulus_rounding(&self) -> f64 {
        match &self.law {
            MaterialLaw::Known(_) => 0.0,
            MaterialLaw::Text(law) => law.modulus_rounding(),
        }
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
        match &self.law {
            MaterialLaw::Known(law) => law.visit(Energy(self, F)),
            MaterialLaw::Text(law) => law.energy_at(F),
        }
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
        match &self.law {
            MaterialLaw::Known(law) => law.visit(Stress(self, F)),
            MaterialLaw::Text(law) => law.stress_at(F),
        }
    }

    /// [`Law::stress_differential`] of this material at one `F` [Pa].
    pub fn stress_differential(&self, F: &Mat3, dF: &Mat3) -> Mat3 {
        struct Differential<'a>(&'a Material, [&'a Mat3; 2]);
        impl LawVisitor for Differential<'_> {
            type Output = Mat3;
            fn visit<L: Law>(self, _: L) -> Mat3 {
                let (parameters, [F, dF]) = (self.0.parameters_of::<L>(), self.1);
                L::stress_differential(&parameters, &L::at(&parameters, F), dF)
            }
        }
        match &self.law {
            MaterialLaw::Known(law) => law.visit(Differential(self, [F, dF])),
            MaterialLaw::Text(law) => law.stress_differential_at(F, dF),
        }
    }

    /// This material with its law's axes as the columns of a rotation; `None`: those of the world.
    pub fn along(&self, axes: Option<&Mat3>) -> Oriented<'_> {
        Oriented { material: self, axes: axes.copied() }
    }

    /// Whether its law may tell directions apart.
    pub fn knows_directions(&self) -> bool {
        match &self.law {
            MaterialLaw::Known(_) => false,
            MaterialLaw::Text(law) => law.knows_directions(),
        }
    }

    /// Young's modulus at rest; of a law that knows directions more in proportion, as the direction that resists a small stretch or
    /// shortening most does to one that goes by the moduli [Pa]. Fibres that bear on one side of rest alone are seen so.
    pub fn stiffest_modulus(&self) -> f64 {
        let Lame { lambda, mu } = self.small_strain;
        let modulus = self.small_strain.youngs_modulus();
        if !self.knows_directions() {
            return modulus;
        }
        let numbers = || [-1.0, 0.0, 1.0].into_iter();
        let ways =
            numbers().flat_map(|x| numbers().flat_map(move |y| numbers().map(move |z| Vec3::new(x, y, z))));
        let resisted = ways.filter_map(Vec3::try_normalised).flat_map(|n| {
            [SMALL_STRETCH, -SMALL_STRETCH].map(|stretch| {
                let F = Mat3::IDENTITY + n.outer(n) * stretch;
                n.dot(self.stress(&F) * n) / stretch
            })
        });
        modulus * resisted.map(|along| along / (lambda + 2.0 * mu)).fold(1.0, f64::max)
    }

    /// What is legal in the law and doubtful.
    pub fn warnings(&self) -> &[String] {
        match &self.law {
            MaterialLaw::Known(_) => &[],
            MaterialLaw::Text(law) => law.warnings(),
        }
    }
}

/// A material whose law's axes are the columns of a rotation `Q`: `Ψ(F) = Ψ'(Qᵀ F Q)`.
#[derive(Clone, Copy, Debug)]
pub struct Oriented<'a> {
    material: &'a Material,
    axes: Option<Mat3>,
}

impl Oriented<'_> {
    fn seen(&self, F: &Mat3) -> Mat3 {
        self.axes.map_or(*F, |Q| Q.transpose_mul(&(*F * Q)))
    }

    /// [J/m³]
    pub fn energy_density(&self, F: &Mat3) -> f64 {
        self.material.energy_density(&self.seen(F))
    }

    /// First Piola–Kirchhoff [Pa].
    pub fn stress(&self, F: &Mat3) -> Mat3 {
        let P = self.material.stress(&self.seen(F));
        self.axes.map_or(P, |Q| (Q * P).mul_transpose(&Q))
    }

    /// `∂P/∂F : δF` [Pa].
    pub fn stress_differential(&self, F: &Mat3, dF: &Mat3) -> Mat3 {
        let dP = self.material.stress_differential(&self.seen(F), &self.seen(dF));
        self.axes.map_or(dP, |Q| (Q * dP).mul_transpose(&Q))
    }

    /// What is read off matter of `volume` [m³] at rest that is deformed by `F`.
    pub fn field(&self, F: &Mat3, volume: f64) -> CellField {
        let stress = self.stress(F);
        let cauchy = cauchy_stress(&stress, F).unwrap_or(Mat3::ZERO);
        CellField {
            deformation: *F,
            stress,
            cauchy,
            von_mises: von_mises(&cauchy),
            energy_density: self.energy_density(F),
            volume,
            current_volume: volume * F.determinant(),
        }
    }
}

/// `√(3/2 dev σ : dev σ)` [Pa].
pub fn von_mises(cauchy: &Mat3) -> f64 {
    let deviator = cauchy.plus_diagonal(-cauchy.trace() / 3.0);
    (1.5 * deviator.dot(&deviator)).sqrt()
}

/// Cauchy stress `σ = P Fᵀ / det F` [Pa]; `None` where the element has no volume.
pub fn cauchy_stress(P: &Mat3, F: &Mat3) -> Option<Mat3> {
    let J = F.determinant();
    let sigma = P.mul_transpose(F) * (1.0 / J);
    (J != 0.0 && sigma.is_finite()).then_some(sigma)
}
