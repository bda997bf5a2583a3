//! Natural frequencies: discrete ones of independent codes, closed forms, and the order at which they converge.

use super::bar::{DEFAULT_RULE, HEX8, LINEAR, N2, N3, N4, N6, N8, TET4};
use crate::{Case, Limit, Reading, Refinement, Tolerance, Variant};

const BAR: Case = Case {
    id: "",
    capabilities: &["DEB-2"],
    what: "",
    scene: "cantilever",
    settings: &[],
    reading: Reading::NaturalFrequency(1),
    refinement: None,
    reference: f64::NAN,
    tolerance: Tolerance::Relative(1e-8),
    source: "FEniCSx, 8 digits trusted",
    // 5e-5 of a frequency
    mutation: r#"bodies.bar.material.youngs_modulus="10.001 MPa""#,
};

// a frequency is the root of a quotient of energies: as in `cantilever_orders`, with half the locking in it, and a limit known to
// 4.7e-4 Hz, which is 0.06 of the finest error of hexahedra and moves the order by 0.06
const ORDER: Case = Case {
    reading: Reading::NaturalFrequency(1),
    refinement: Some(Refinement {
        size_of: "cell [m]",
        runs: &[
            Variant { size: 0.05, settings: &[N2] },
            Variant { size: 0.025, settings: &[N4] },
            Variant { size: 0.0125, settings: &[N8] },
        ],
        limit: Limit::Known(1.6098905919842392),
    }),
    reference: 2.0,
    tolerance: Tolerance::Absolute(0.25),
    source: "Strang & Fix 1973, §6.3; limit of quadratic hexahedra by FEniCSx",
    mutation: r#"bodies.bar.material.youngs_modulus="10.1 MPa""#,
    ..BAR
};

/// Of 1000 kg/m³ and 100 kPa.
const HIGHEST: f64 = 2.0 / 7.6e-3;
const SQRT_10: f64 = 3.162_277_660_168_379_5;

// 5 % of a frequency is 10 % of explicit Euler's longest step, of which the specification allows 20 %
const HIGHEST_OF_CUBE: Case = Case {
    capabilities: &["FAU-39"],
    scene: "stretched_cube",
    reading: Reading::HighestFrequency,
    tolerance: Tolerance::Relative(0.05),
    source: "specification, EXP-19: 7.6 ms ± 5 % with nodes of equal mass",
    mutation: "bodies.cube.material.poissons_ratio=0.4",
    ..BAR
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "frequency_tet4_n3_1",
        what: "first natural frequency of the clamped bar, tet4, n = 3",
        settings: &[N3, LINEAR],
        reference: 1.8448100513457297,
        ..BAR
    },
    Case {
        id: "frequency_tet4_n3_2",
        what: "second, n = 3",
        settings: &[N3, LINEAR],
        reading: Reading::NaturalFrequency(2),
        reference: 2.052718638365083,
        ..BAR
    },
    Case {
        id: "frequency_tet4_n6_1",
        what: "first, n = 6",
        settings: &[N6, LINEAR],
        reference: 1.6749007844335804,
        ..BAR
    },
    Case {
        id: "frequency_tet4_n6_3",
        what: "third, n = 6",
        settings: &[N6, LINEAR],
        reading: Reading::NaturalFrequency(3),
        reference: 10.037517809785989,
        ..BAR
    },
    Case {
        id: "order_hex8_frequency",
        what: "order of the first frequency's error, hex8",
        settings: &[HEX8, LINEAR, DEFAULT_RULE],
        ..ORDER
    },
    Case {
        id: "order_tet4_frequency",
        what: "order of the first frequency's error, tet4, still locking",
        settings: &[TET4, LINEAR],
        refinement: Some(Refinement {
            size_of: "cell [m]",
            runs: &[
                Variant { size: 0.1 / 3.0, settings: &[N3] },
                Variant { size: 0.1 / 6.0, settings: &[N6] },
            ],
            limit: Limit::Known(1.6098905919842392),
        }),
        // √(1 + x) at x = 0.45 and 0.12 costs log₂ (1 - x/4) / (1 - x/4) = 0.13, the clamped edge 0.17
        tolerance: Tolerance::Absolute(0.3),
        mutation: r#"bodies.bar.material.youngs_modulus="11 MPa""#,
        ..ORDER
    },
    Case {
        id: "frequency_block",
        capabilities: &[],
        what: "natural frequency of a block of 1 kg on springs of 4 pi² N/m",
        scene: "block_on_springs",
        reference: 1.0,
        tolerance: Tolerance::Relative(1e-9),
        source: "√(k/m) / 2 pi; residuals of 1e-10 allowed",
        mutation: "bodies.block.material.density=1001",
        ..BAR
    },
    Case {
        id: "exp19_highest_frequency",
        what: "highest frequency of EXP-18's cube, 2/h for the longest symplectic step h",
        settings: &[r#"bodies.cube.mass="uniform""#],
        reference: HIGHEST,
        ..HIGHEST_OF_CUBE
    },
    Case {
        id: "exp19_highest_frequency_10000_1e5",
        what: "the same, 10000 kg/m3 and 100 kPa: explicit Euler's limit, damping over its square, scales as density over modulus",
        settings: &[r#"bodies.cube.mass="uniform""#, "bodies.cube.material.density=10000"],
        reference: HIGHEST / SQRT_10,
        ..HIGHEST_OF_CUBE
    },
    Case {
        id: "exp19_highest_frequency_1000_1e4",
        what: "the same, 1000 kg/m3 and 10 kPa",
        settings: &[r#"bodies.cube.mass="uniform""#, r#"bodies.cube.material.youngs_modulus="10 kPa""#],
        reference: HIGHEST / SQRT_10,
        ..HIGHEST_OF_CUBE
    },
    Case {
        id: "exp19_highest_frequency_10000_1e4",
        what: "the same, 10000 kg/m3 and 10 kPa",
        settings: &[
            r#"bodies.cube.mass="uniform""#,
            "bodies.cube.material.density=10000",
            r#"bodies.cube.material.youngs_modulus="10 kPa""#,
        ],
        reference: HIGHEST / 10.0,
        ..HIGHEST_OF_CUBE
    },
];
