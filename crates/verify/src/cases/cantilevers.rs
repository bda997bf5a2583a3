//! The reference bar in equilibrium under its weight: discrete answers of independent codes on the same meshes.

use super::bar::{
    COROTATIONAL, DEFAULT_RULE, FULL_RULE, HEX8, LINEAR, N1, N2, N3, N6, NEO_HOOKEAN, PRISM6, PYRAMID5,
    ST_VENANT_KIRCHHOFF,
};
use crate::{Case, Reading, Tolerance};

const BAR: Case = Case {
    id: "",
    capabilities: &["FAU-73"],
    what: "",
    scene: "cantilever",
    settings: &[],
    reading: Reading::component("tip", 1),
    refinement: None,
    reference: f64::NAN,
    tolerance: Tolerance::Relative(1e-7),
    source: "FEniCSx and an own code, ten digits equal",
    mutation: r#"bodies.bar.material.youngs_modulus="10.001 MPa""#,
};

const ENERGY: Case = Case { what: "stored energy of the same", reading: Reading::last("energy"), ..BAR };

// printed digits of the mean over the corners agree to 1e-10; the solver stops at 1e-7 of the largest force
const GETFEM: Case = Case { tolerance: Tolerance::Relative(1e-6), source: "GetFEM, full integration", ..BAR };

pub(super) const CASES: &[Case] = &[
    Case {
        id: "cantilever_tet4_corotational_n3",
        capabilities: &["FAU-73", "FAU-14"],
        what: "tip of the clamped bar, linear tetrahedra, corotational, n = 3",
        settings: &[N3, COROTATIONAL],
        reference: -0.10060500259432772,
        ..BAR
    },
    Case {
        id: "cantilever_tet4_corotational_n3_energy",
        capabilities: &["FAU-73", "FAU-14"],
        settings: &[N3, COROTATIONAL],
        reference: 1.9798598292012073,
        ..ENERGY
    },
    Case {
        id: "cantilever_tet4_linear_n3",
        capabilities: &["FAU-73", "FAU-7"],
        what: "tip of the clamped bar, linear tetrahedra, linear, n = 3",
        settings: &[N3, LINEAR],
        reference: -0.10141496361829683,
        ..BAR
    },
    Case {
        id: "cantilever_tet4_linear_n3_energy",
        capabilities: &["FAU-73", "FAU-7"],
        settings: &[N3, LINEAR],
        reference: 2.001143286400389,
        ..ENERGY
    },
    Case {
        id: "cantilever_tet4_linear_n6",
        capabilities: &["FAU-73", "FAU-7"],
        what: "tip of the clamped bar, linear tetrahedra, linear, n = 6",
        settings: &[N6, LINEAR],
        reference: -0.13152265129731808,
        ..BAR
    },
    Case {
        id: "cantilever_tet4_linear_n6_energy",
        capabilities: &["FAU-73", "FAU-7"],
        settings: &[N6, LINEAR],
        reference: 2.591651489925166,
        ..ENERGY
    },
    Case {
        id: "cantilever_tet4_neo_hookean_n3",
        what: "tip of the clamped bar, linear tetrahedra, neo_hookean, n = 3",
        settings: &[N3, NEO_HOOKEAN],
        reference: -0.10067003081654274,
        ..BAR
    },
    Case {
        id: "cantilever_tet4_neo_hookean_n3_energy",
        settings: &[N3, NEO_HOOKEAN],
        reference: 1.9819685676569796,
        ..ENERGY
    },
    Case {
        id: "cantilever_tet4_stvk_n3",
        capabilities: &["FAU-73", "FAU-8"],
        what: "tip of the clamped bar, linear tetrahedra, st_venant_kirchhoff, n = 3",
        settings: &[N3, ST_VENANT_KIRCHHOFF],
        reference: -0.10051244029848287,
        ..BAR
    },
    Case {
        id: "cantilever_tet4_stvk_n3_energy",
        capabilities: &["FAU-73", "FAU-8"],
        settings: &[N3, ST_VENANT_KIRCHHOFF],
        reference: 1.9768627648170536,
        ..ENERGY
    },
    Case {
        id: "cantilever_tet4_stvk_n6",
        capabilities: &["FAU-73", "FAU-8"],
        what: "tip of the clamped bar, linear tetrahedra, st_venant_kirchhoff, n = 6",
        settings: &[N6, ST_VENANT_KIRCHHOFF],
        reference: -0.12977445957955291,
        ..BAR
    },
    Case {
        id: "cantilever_tet4_stvk_n6_energy",
        capabilities: &["FAU-73", "FAU-8"],
        settings: &[N6, ST_VENANT_KIRCHHOFF],
        reference: 2.545052610456245,
        ..ENERGY
    },
    Case {
        id: "cantilever_hex8_linear_n1",
        capabilities: &["FAU-73", "FAU-7"],
        what: "tip of the clamped bar, hex8, linear, n = 1",
        settings: &[N1, HEX8, LINEAR, DEFAULT_RULE],
        reference: -0.09557806242618869,
        ..GETFEM
    },
    Case {
        id: "cantilever_hex8_stvk_n1",
        capabilities: &["FAU-73", "FAU-8"],
        what: "tip of the clamped bar, hex8, st_venant_kirchhoff, n = 1",
        settings: &[N1, HEX8, ST_VENANT_KIRCHHOFF, FULL_RULE],
        reference: -0.09490604711694053,
        ..GETFEM
    },
    Case {
        id: "cantilever_hex8_linear_n2",
        capabilities: &["FAU-73", "FAU-7"],
        what: "tip of the clamped bar, hex8, linear, n = 2",
        settings: &[N2, HEX8, LINEAR, DEFAULT_RULE],
        reference: -0.12876284033785645,
        ..GETFEM
    },
    Case {
        id: "cantilever_hex8_stvk_n2",
        capabilities: &["FAU-73", "FAU-8"],
        what: "tip of the clamped bar, hex8, st_venant_kirchhoff, n = 2",
        settings: &[N2, HEX8, ST_VENANT_KIRCHHOFF, FULL_RULE],
        reference: -0.12714878683692987,
        ..GETFEM
    },
    Case {
        id: "cantilever_hex8_linear_n3",
        capabilities: &["FAU-73", "FAU-7"],
        what: "tip of the clamped bar, hex8, linear, n = 3",
        settings: &[N3, HEX8, LINEAR, DEFAULT_RULE],
        reference: -0.13818088667104345,
        ..GETFEM
    },
    Case {
        id: "cantilever_hex8_stvk_n3",
        capabilities: &["FAU-73", "FAU-8"],
        what: "tip of the clamped bar, hex8, st_venant_kirchhoff, n = 3",
        settings: &[N3, HEX8, ST_VENANT_KIRCHHOFF, FULL_RULE],
        reference: -0.13619818759625157,
        ..GETFEM
    },
    Case {
        id: "cantilever_prism6_linear_n1",
        capabilities: &["FAU-73", "FAU-7"],
        what: "tip of the clamped bar, prism6, linear, n = 1",
        settings: &[N1, PRISM6, LINEAR, DEFAULT_RULE],
        reference: -0.09023659182761375,
        ..GETFEM
    },
    Case {
        id: "cantilever_prism6_stvk_n1",
        capabilities: &["FAU-73", "FAU-8"],
        what: "tip of the clamped bar, prism6, st_venant_kirchhoff, n = 1",
        settings: &[N1, PRISM6, ST_VENANT_KIRCHHOFF, FULL_RULE],
        reference: -0.08967544201630433,
        ..GETFEM
    },
    Case {
        id: "cantilever_prism6_linear_n2",
        capabilities: &["FAU-73", "FAU-7"],
        what: "tip of the clamped bar, prism6, linear, n = 2",
        settings: &[N2, PRISM6, LINEAR, DEFAULT_RULE],
        reference: -0.12399541986398246,
        ..GETFEM
    },
    Case {
        id: "cantilever_prism6_stvk_n2",
        capabilities: &["FAU-73", "FAU-8"],
        what: "tip of the clamped bar, prism6, st_venant_kirchhoff, n = 2",
        settings: &[N2, PRISM6, ST_VENANT_KIRCHHOFF, FULL_RULE],
        reference: -0.12255805178958526,
        ..GETFEM
    },
    Case {
        id: "cantilever_prism6_linear_n3",
        capabilities: &["FAU-73", "FAU-7"],
        what: "tip of the clamped bar, prism6, linear, n = 3",
        settings: &[N3, PRISM6, LINEAR, DEFAULT_RULE],
        reference: -0.13518639194461943,
        ..GETFEM
    },
    Case {
        id: "cantilever_prism6_stvk_n3",
        capabilities: &["FAU-73", "FAU-8"],
        what: "tip of the clamped bar, prism6, st_venant_kirchhoff, n = 3",
        settings: &[N3, PRISM6, ST_VENANT_KIRCHHOFF, FULL_RULE],
        reference: -0.13333202833611268,
        ..GETFEM
    },
    Case {
        id: "cantilever_pyramid5_linear_n1",
        capabilities: &["FAU-73", "FAU-7"],
        what: "tip of the clamped bar, pyramid5, linear, n = 1",
        settings: &[N1, PYRAMID5, LINEAR, DEFAULT_RULE],
        reference: -0.07844287526143434,
        ..GETFEM
    },
    Case {
        id: "cantilever_pyramid5_stvk_n1",
        capabilities: &["FAU-73", "FAU-8"],
        what: "tip of the clamped bar, pyramid5, st_venant_kirchhoff, n = 1",
        settings: &[N1, PYRAMID5, ST_VENANT_KIRCHHOFF, FULL_RULE],
        reference: -0.07808057204864713,
        ..GETFEM
    },
    Case {
        id: "cantilever_pyramid5_linear_n2",
        capabilities: &["FAU-73", "FAU-7"],
        what: "tip of the clamped bar, pyramid5, linear, n = 2",
        settings: &[N2, PYRAMID5, LINEAR, DEFAULT_RULE],
        reference: -0.11831295084396304,
        ..GETFEM
    },
    Case {
        id: "cantilever_pyramid5_stvk_n2",
        capabilities: &["FAU-73", "FAU-8"],
        what: "tip of the clamped bar, pyramid5, st_venant_kirchhoff, n = 2",
        settings: &[N2, PYRAMID5, ST_VENANT_KIRCHHOFF, FULL_RULE],
        reference: -0.11706704737443191,
        ..GETFEM
    },
    Case {
        id: "cantilever_pyramid5_linear_n3",
        capabilities: &["FAU-73", "FAU-7"],
        what: "tip of the clamped bar, pyramid5, linear, n = 3",
        settings: &[N3, PYRAMID5, LINEAR, DEFAULT_RULE],
        reference: -0.13239214230481916,
        ..GETFEM
    },
    Case {
        id: "cantilever_pyramid5_stvk_n3",
        capabilities: &["FAU-73", "FAU-8"],
        what: "tip of the clamped bar, pyramid5, st_venant_kirchhoff, n = 3",
        settings: &[N3, PYRAMID5, ST_VENANT_KIRCHHOFF, FULL_RULE],
        reference: -0.13065153009362698,
        ..GETFEM
    },
];
