//! The clamped bar let go under gravity, symplectic steps of 50 µs: traces of independent codes.

use super::bar::{COROTATIONAL, LINEAR, NEO_HOOKEAN, ST_VENANT_KIRCHHOFF};
use crate::{Case, Reading, Tolerance};

const PERIOD: &str = r#"world.period="50 us""#;
const SYMPLECTIC: &str = r#"systems.main.stepper="symplectic_euler""#;
const TIP: Reading = Reading::component("tip", 1);

// the bar has hardly bent after 100 steps: only gravity is in the number, and only gravity can make it wrong
const AFTER_100: Case = Case {
    id: "",
    capabilities: &["FAU-39"],
    what: "",
    scene: "cantilever_dynamic",
    settings: &[],
    reading: TIP.after(100),
    refinement: None,
    reference: f64::NAN,
    tolerance: Tolerance::Relative(1e-8),
    source: "own code, reproduced by an independent one to 6-12 digits",
    mutation: "world.gravity=[0, -9.811, 0]",
};

const AFTER_1000: Case =
    Case { reading: TIP.after(1000), mutation: "bodies.bar.material.density=1001", ..AFTER_100 };

const AFTER_2000: Case =
    Case { reading: TIP.after(2000), tolerance: Tolerance::Relative(1e-7), ..AFTER_1000 };

pub(super) const CASES: &[Case] = &[
    Case {
        id: "explicit_corotational_100",
        what: "tip of the swinging bar after 100 symplectic steps of 50 us, corotational",
        settings: &[PERIOD, SYMPLECTIC, COROTATIONAL],
        reference: -0.00012385124999997945,
        ..AFTER_100
    },
    Case {
        id: "explicit_corotational_1000",
        what: "tip of the swinging bar after 1000 symplectic steps of 50 us, corotational",
        settings: &[PERIOD, SYMPLECTIC, COROTATIONAL],
        reference: -0.015740628654734613,
        ..AFTER_1000
    },
    Case {
        id: "explicit_corotational_2000",
        what: "tip of the swinging bar after 2000 symplectic steps of 50 us, corotational",
        settings: &[PERIOD, SYMPLECTIC, COROTATIONAL],
        reference: -0.06652936382608848,
        ..AFTER_2000
    },
    Case {
        id: "explicit_linear_100",
        what: "tip of the swinging bar after 100 symplectic steps of 50 us, linear",
        settings: &[PERIOD, SYMPLECTIC, LINEAR],
        reference: -0.0001238512500000136,
        ..AFTER_100
    },
    Case {
        id: "explicit_linear_1000",
        what: "tip of the swinging bar after 1000 symplectic steps of 50 us, linear",
        settings: &[PERIOD, SYMPLECTIC, LINEAR],
        reference: -0.015740258835566717,
        ..AFTER_1000
    },
    Case {
        id: "explicit_linear_2000",
        what: "tip of the swinging bar after 2000 symplectic steps of 50 us, linear",
        settings: &[PERIOD, SYMPLECTIC, LINEAR],
        reference: -0.06661878628187899,
        ..AFTER_2000
    },
    Case {
        id: "explicit_neo_hookean_100",
        what: "tip of the swinging bar after 100 symplectic steps of 50 us, neo_hookean",
        settings: &[PERIOD, SYMPLECTIC, NEO_HOOKEAN],
        reference: -0.00012385125000000788,
        ..AFTER_100
    },
    Case {
        id: "explicit_neo_hookean_1000",
        what: "tip of the swinging bar after 1000 symplectic steps of 50 us, neo_hookean",
        settings: &[PERIOD, SYMPLECTIC, NEO_HOOKEAN],
        reference: -0.01574022893635219,
        ..AFTER_1000
    },
    Case {
        id: "explicit_neo_hookean_2000",
        what: "tip of the swinging bar after 2000 symplectic steps of 50 us, neo_hookean",
        settings: &[PERIOD, SYMPLECTIC, NEO_HOOKEAN],
        reference: -0.0665316291259638,
        ..AFTER_2000
    },
    Case {
        id: "explicit_stvk_100",
        what: "tip of the swinging bar after 100 symplectic steps of 50 us, st_venant_kirchhoff",
        settings: &[PERIOD, SYMPLECTIC, ST_VENANT_KIRCHHOFF],
        reference: -0.0001238512500000136,
        ..AFTER_100
    },
    Case {
        id: "explicit_stvk_1000",
        what: "tip of the swinging bar after 1000 symplectic steps of 50 us, st_venant_kirchhoff",
        settings: &[PERIOD, SYMPLECTIC, ST_VENANT_KIRCHHOFF],
        reference: -0.015741317589581534,
        ..AFTER_1000
    },
    Case {
        id: "explicit_stvk_2000",
        what: "tip of the swinging bar after 2000 symplectic steps of 50 us, st_venant_kirchhoff",
        settings: &[PERIOD, SYMPLECTIC, ST_VENANT_KIRCHHOFF],
        reference: -0.06652537366044448,
        ..AFTER_2000
    },
];
