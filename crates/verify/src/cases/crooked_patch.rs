//! The patch test on crooked cells: a linear map has the energy of its deformation gradient times the volume, no force inside, and is what
//! the inside finds, on every element, under every law and in mixes (EXP-6).
//!
//! Default rules do for all: they integrate what straight edges leave of `cof J ∇N`, of pyramids too, whose map is polynomial
//! where `1 - w` is taken out.

use crate::{Case, Reading, Tolerance};

const ENERGY: Case = Case {
    id: "",
    capabilities: &["FAU-1", "FAU-3", "FAU-5"],
    what: "",
    scene: "crooked_patch",
    settings: &[],
    reading: Reading::last("energy"),
    refinement: None,
    reference: STVK,
    // some thousand samples at most, of numbers near one, each less than a hundred roundings
    tolerance: Tolerance::Relative(1e-12),
    source: "EXP-6 (f): volume times energy density at given F",
    mutation: NO_MAP,
};

// A cell pulls with 1.5 MPa on faces of 0.1 m². Its deformation gradient is made of places of 4 m and gradients of 10 per metre, each rounded
// to 1e-16 of it: 1e-14 of the modulus, of the face 1e-8 N, and a point has two dozen cells
const FORCE: Case = Case {
    what: "greatest force on a point inside such a patch",
    reading: Reading::last("force"),
    reference: 0.0,
    tolerance: Tolerance::Absolute(1e-7),
    source: "EXP-6 (f): no force on interior nodes",
    ..ENERGY
};

// Newton's method leaves 1e-12 of 1.5e5 N, which moves a point held by 1e6 N/m by 1.5e-13 m; places of 4 m round to 1e-15 m
const GAP: Case = Case {
    what: "how far a point inside comes to rest from where the map puts it, when the sides alone are led",
    reading: Reading::last("gap"),
    reference: 0.0,
    tolerance: Tolerance::Absolute(1e-12),
    source: "EXP-6 (f): an affine displacement is an equilibrium",
    ..ENERGY
};

const FLAT_ENERGY: Case = Case { reading: Reading::last("flat_energy"), reference: FLAT_STVK, ..ENERGY };
const FLAT_FORCE: Case = Case { reading: Reading::last("flat_force"), ..FORCE };
const FLAT_GAP: Case = Case { reading: Reading::last("flat_gap"), ..GAP };

/// Another map than a linear one, of blocks and of sheets.
const NO_MAP: &str = r#"parameters.map="[t * (0.1 * x + 0.05 * y * y), 0, 0]""#;
const NO_FLAT_MAP: &str = r#"parameters.flat_map="[t * (0.1 * x + 0.05 * y * y), 0, 0]""#;

/// `2 m³ (μ E:E + λ/2 tr(E)²)` with `E = (FᵀF - I)/2`.
#[expect(non_snake_case, reason = "a symbol of the mathematics")]
const fn st_venant_kirchhoff(F: [[f64; 3]; 3]) -> f64 {
    const MU: f64 = 1e7 / 2.6;
    const LAMBDA: f64 = 1e7 * 0.3 / (1.3 * 0.4);
    let (mut squares, mut trace) = (0.0, 0.0);
    let mut at = 0;
    while at < 9 {
        let (i, j) = (at / 3, at % 3);
        let strain = 0.5
            * (F[0][i] * F[0][j] + F[1][i] * F[1][j] + F[2][i] * F[2][j] - if i == j { 1.0 } else { 0.0 });
        squares += strain * strain;
        if i == j {
            trace += strain;
        }
        at += 1;
    }
    2.0 * (MU * squares + 0.5 * LAMBDA * trace * trace)
}

const STVK: f64 = st_venant_kirchhoff([[1.1, 0.05, -0.02], [0.03, 0.95, 0.04], [-0.01, 0.02, 1.08]]);
const FLAT_STVK: f64 = st_venant_kirchhoff([[1.1, 0.05, 0.0], [0.03, 0.95, 0.0], [0.0, 0.0, 1.0]]);

/// Energy, force and gap of blocks of each kind of cells.
macro_rules! solids {
    ($($element:literal of $capabilities:expr,)*) => {
        &[$(
            Case {
                id: concat!("exp6_patch_", $element, "_energy"),
                capabilities: $capabilities,
                what: concat!("energy of a crooked patch of ", $element, ", led by one linear map"),
                settings: &[concat!("parameters.solid=\"", $element, "\"")],
                ..ENERGY
            },
            Case {
                id: concat!("exp6_patch_", $element, "_force"),
                capabilities: $capabilities,
                settings: &[concat!("parameters.solid=\"", $element, "\"")],
                ..FORCE
            },
            Case {
                id: concat!("exp6_patch_", $element, "_gap"),
                capabilities: $capabilities,
                settings: &[concat!("parameters.solid=\"", $element, "\"")],
                ..GAP
            },
        )*]
    };
}

/// The same of sheets in plane strain.
macro_rules! sheets {
    ($($element:literal is $name:literal of $capabilities:expr,)*) => {
        &[$(
            Case {
                id: concat!("exp6_patch_", $name, "_energy"),
                capabilities: $capabilities,
                what: concat!("energy of a crooked sheet of ", $element, ", led by one linear map"),
                settings: &[concat!("parameters.flat=\"", $element, "\"")],
                mutation: NO_FLAT_MAP,
                ..FLAT_ENERGY
            },
            Case {
                id: concat!("exp6_patch_", $name, "_force"),
                capabilities: $capabilities,
                settings: &[concat!("parameters.flat=\"", $element, "\"")],
                mutation: NO_FLAT_MAP,
                ..FLAT_FORCE
            },
            Case {
                id: concat!("exp6_patch_", $name, "_gap"),
                capabilities: $capabilities,
                settings: &[concat!("parameters.flat=\"", $element, "\"")],
                mutation: NO_FLAT_MAP,
                ..FLAT_GAP
            },
        )*]
    };
}

/// The same of blocks of all linear and of all quadratic kinds under a law.
macro_rules! laws {
    ($($law:literal of $capabilities:expr, $material:literal, $energy:expr;)*) => {
        &[$(
            Case {
                id: concat!("exp6_patch_", $law, "_energy"),
                capabilities: $capabilities,
                what: concat!("energy of a crooked patch of all linear elements, ", $law),
                settings: &[concat!("parameters.material=", $material)],
                reference: $energy,
                ..ENERGY
            },
            Case {
                id: concat!("exp6_patch_", $law, "_force"),
                capabilities: $capabilities,
                settings: &[concat!("parameters.material=", $material)],
                ..FORCE
            },
            Case {
                id: concat!("exp6_patch_", $law, "_gap"),
                capabilities: $capabilities,
                settings: &[concat!("parameters.material=", $material)],
                ..GAP
            },
            Case {
                id: concat!("exp6_patch_", $law, "_quadratic_energy"),
                capabilities: $capabilities,
                what: concat!("energy of a crooked patch of all quadratic elements, ", $law),
                settings: &[concat!("parameters.material=", $material), QUADRATIC],
                reference: $energy,
                ..ENERGY
            },
            Case {
                id: concat!("exp6_patch_", $law, "_quadratic_force"),
                capabilities: $capabilities,
                settings: &[concat!("parameters.material=", $material), QUADRATIC],
                ..FORCE
            },
        )*]
    };
}

const QUADRATIC: &str = r#"parameters.solid="mixed_quadratic""#;
const ELEMENT: &[&str] = &["FAU-1", "FAU-3", "FAU-5"];
const MIXED: &[&str] = &["FAU-1", "FAU-3", "FAU-53"];

pub(super) const SOLIDS: &[Case] = solids! {
    "tet4" of ELEMENT,
    "hex8" of ELEMENT,
    "prism6" of ELEMENT,
    "pyramid5" of ELEMENT,
    "mixed" of MIXED,
    "tet10" of ELEMENT,
    "hex20" of ELEMENT,
    "prism15" of ELEMENT,
    "pyramid13" of ELEMENT,
    "hex27" of &["FAU-1", "FAU-3", "FAU-29"],
    "mixed_quadratic" of MIXED,
};

pub(super) const SHEETS: &[Case] = sheets! {
    "tri3" is "tri3" of ELEMENT,
    "quad4" is "quad4" of ELEMENT,
    "mixed" is "tri3_quad4" of MIXED,
    "tri6" is "tri6" of ELEMENT,
    "quad8" is "quad8" of ELEMENT,
    "quad9" is "quad9" of &["FAU-1", "FAU-3", "FAU-29"],
    "mixed_quadratic" is "tri6_quad8" of MIXED,
};

// energies: 2 m³ of the density of each law's equation (`souple describe`), in decimal arithmetic of twenty digits
pub(super) const LAWS: &[Case] = laws! {
    "linear" of &["FAU-3", "FAU-7"],
        r#"{ name = "linear", youngs_modulus = "10 MPa", poissons_ratio = 0.3, density = 1000 }"#, 284807.6923076923;
    "corotational" of &["FAU-3", "FAU-15"],
        r#"{ name = "corotational", youngs_modulus = "10 MPa", poissons_ratio = 0.3, density = 1000 }"#, 285203.45182176473;
    "stvk" of &["FAU-3", "FAU-8"],
        r#"{ name = "st_venant_kirchhoff", youngs_modulus = "10 MPa", poissons_ratio = 0.3, density = 1000 }"#, STVK;
    "neo_hookean" of &["FAU-3"],
        r#"{ name = "neo_hookean", youngs_modulus = "10 MPa", poissons_ratio = 0.3, density = 1000 }"#, 264459.5712602852;
    "stable_neo_hookean" of &["FAU-3"],
        r#"{ name = "stable_neo_hookean", youngs_modulus = "10 MPa", poissons_ratio = 0.3, density = 1000 }"#, 281706.19821627847;
    "mooney_rivlin" of &["FAU-3", "FAU-29"],
        r#"{ name = "mooney_rivlin", c10 = "1 MPa", c01 = "0.5 MPa", bulk_modulus = "10 MPa", density = 1000 }"#, 266400.1536000384;
    "ogden" of &["FAU-3", "FAU-29"],
        r#"{ name = "ogden", mu = ["3 MPa", "-0.2 MPa"], alpha = [1.3, -2], bulk_modulus = "10 MPa", density = 1000 }"#, 235260.35524516955;
    "yeoh" of &["FAU-3", "FAU-29"],
        r#"{ name = "yeoh", c1 = "1 MPa", c2 = "-0.1 MPa", c3 = "10 kPa", bulk_modulus = "10 MPa", density = 1000 }"#, 228523.37174223354;
    "text" of &["FAU-3", "FAU-9", "FAU-29"],
        r#"{ name = "hyperelastic", energy = "m*(l1^2 + l2^2 + l3^2 - 3 - 2*log(J)) + k*log(l1*l2*l3)^2", parameters = { m = "1 MPa", k = "4 MPa" }, density = 1000 }"#, 207805.11023042433;
};
