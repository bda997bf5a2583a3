//! A battery of standard tests of one material, where every link that bears a load bears the same: bending, torsion, pressure
//! from all sides, shear between plates.

use super::network::OSCILLATOR;
use crate::{Case, Reading, Tolerance};

/// Strains of less than 4e-4 and turns of less than 6e-3, as slow as with the softer law.
const STIFF: &[&str] = &[
    r#"parameters.law={ name = "elasto_plastic", stiffness = 1e6, hardening = 2.5e5, traction = 10 }"#,
    "parameters.mass=1",
    "parameters.drag=100",
];

const SPRINGS: &[&str] =
    &[r#"parameters.law={ name = "spring", stiffness = 1e6 }"#, "parameters.mass=1", "parameters.drag=100"];

/// The end of five seconds of 15 N.
const LOADED: u64 = 500;

/// What stays of a plastic material.
const PLASTIC: Case = Case {
    capabilities: &["JIM-99", "JIM-50"],
    scene: "material_tests",
    settings: STIFF,
    // what is left out is of the order of strains
    tolerance: Tolerance::Relative(5e-4),
    source: "EXP-61: permanent elongation of a link (15 - 10)/k' = 2e-5 m, times the shape of the sample",
    mutation: r#"parameters.law={ name = "elasto_plastic", stiffness = 1e6, hardening = 2.51e5, traction = 10 }"#,
    ..OSCILLATOR
};

/// An elastic material under its load.
const ELASTIC: Case = Case {
    capabilities: &["JIM-99", "JIM-5"],
    settings: SPRINGS,
    source: "EXP-61: elongation of a link 15/k = 1.5e-5 m, times the shape of the sample",
    mutation: r#"parameters.law={ name = "spring", stiffness = 1.002e6 }"#,
    ..PLASTIC
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "tests_bending",
        what: "deflection of a beam of six square cells under a couple of 15 N on its chords: e (1 + 3 + … + 11)",
        reading: Reading::last("bent").after(LOADED),
        reference: -36.0 * 1.5e-5,
        ..ELASTIC
    },
    Case {
        id: "tests_torsion",
        what: "how far a side of a square shaft of six cells goes round under 15 N in its diagonals: 6 √2 e",
        reading: Reading::last("twisted").after(LOADED),
        reference: 6.0 * std::f64::consts::SQRT_2 * 1.5e-5,
        ..ELASTIC
    },
    Case {
        id: "tests_shear",
        what: "how far a plate goes that draws three layers along with 15 N in their diagonals: 3 √2 e",
        reading: Reading::last("sheared").after(LOADED),
        reference: 3.0 * std::f64::consts::SQRT_2 * 1.5e-5,
        ..ELASTIC
    },
    Case {
        id: "tests_pressure",
        what: "how far a corner of a hexagon comes in, two links from the middle, under a pressure of 15 √3 N a mass: 2 e",
        reading: Reading::last("right").after(LOADED),
        reference: -2.0 * 1.5e-5,
        ..ELASTIC
    },
    Case {
        id: "tests_pressure_of_balls",
        capabilities: &["JIM-99", "JIM-26", "JIM-31"],
        what: "the same of balls that nothing joins",
        settings: &[
            r#"parameters.law={ name = "spring", stiffness = 0 }"#,
            r#"parameters.balls={ name = "ball", threshold = 0.1, stiffness = 1e6, damping = 0 }"#,
            "parameters.mass=1",
            "parameters.drag=100",
        ],
        reading: Reading::last("right").after(LOADED),
        reference: -2.0 * 1.5e-5,
        mutation: r#"parameters.balls={ name = "ball", threshold = 0.1, stiffness = 1.002e6, damping = 0 }"#,
        ..ELASTIC
    },
    Case {
        id: "tests_bending_stays",
        what: "deflection that stays of a beam of plastic links",
        reading: Reading::last("bent"),
        reference: -36.0 * 2e-5,
        ..PLASTIC
    },
    Case {
        id: "tests_torsion_stays",
        what: "how far a side of a shaft of plastic links stays turned",
        reading: Reading::last("twisted"),
        reference: 6.0 * std::f64::consts::SQRT_2 * 2e-5,
        ..PLASTIC
    },
    Case {
        id: "tests_shear_stays",
        what: "how far a plate stays ahead that drew plastic links along",
        reading: Reading::last("sheared"),
        reference: 3.0 * std::f64::consts::SQRT_2 * 2e-5,
        ..PLASTIC
    },
    Case {
        id: "tests_shear_is_homogeneous",
        what: "the same of the layer below, two thirds as far",
        reading: Reading::last("second"),
        reference: 2.0 * std::f64::consts::SQRT_2 * 2e-5,
        ..PLASTIC
    },
    Case {
        id: "tests_pressure_stays",
        what: "how far a corner of a hexagon of plastic links stays in",
        reading: Reading::last("right"),
        reference: -2.0 * 2e-5,
        ..PLASTIC
    },
    Case {
        id: "tests_pressure_is_homogeneous",
        what: "the same of the mass between it and the middle, half as far",
        reading: Reading::last("inside"),
        reference: -2e-5,
        ..PLASTIC
    },
    Case {
        id: "tests_fluid_is_sheared",
        capabilities: &["JIM-99", "JIM-52"],
        what: "how far the upper plate has drawn a fluid of Maxwell's links along by an impulse of 75 N s in each: 3 √2 75/z",
        settings: &[
            r#"parameters.law={ name = "maxwell", stiffness = 1e6, viscosity = 2.5e6 }"#,
            "parameters.mass=1",
            "parameters.drag=100",
        ],
        reading: Reading::last("sheared"),
        reference: 3.0 * std::f64::consts::SQRT_2 * 3e-5,
        // of the impulse on the lowest layer drag takes 7 · 100 N s/m · 6 √2 e, of 6 · √2 · 75 N s
        tolerance: Tolerance::Relative(1e-3),
        source: "EXP-61, EXP-42: a fluid between two plates flows at Q/z",
        mutation: r#"parameters.law={ name = "maxwell", stiffness = 1e6, viscosity = 2.51e6 }"#,
        ..PLASTIC
    },
];
