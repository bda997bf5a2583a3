//! EXP-29 to EXP-31 and EXP-39 of the solids' specification: bodies of several kinds of elements, laws and moduli.

use crate::refinement::{Limit, Refinement, Variant};
use crate::{Case, Reading, Tolerance};

const BEAM: Case = Case {
    id: "",
    capabilities: &["FAU-53"],
    what: "",
    scene: "mixed_beam",
    settings: &[],
    reading: Reading::component("tip", 1),
    refinement: None,
    reference: f64::NAN,
    tolerance: Tolerance::Absolute(1e-4),
    source: "specification, EXP-29 oracle; it asks for 1e-4 m",
    mutation: r#"bodies.bar.regions.prisms.material.youngs_modulus="99 MPa""#,
};

/// The beam of `half_turn` of the four kinds in four parts, pyramids as the independent code integrates them.
const OF_PARTS: &str = r#"bodies.bar.mesh={ generate = "bar_of_parts", size = [8, 1, 1], cells = [24, 4, 4], elements = "prism6 pyramid5 hex8 tet4", ends = [0.25, 0.5, 0.75, 1] }"#;
const RULES: &str = r#"bodies.bar.rules={ pyramid5 = "gauss_5" }"#;
const MIXED: &[&str] = &[OF_PARTS, RULES];
const MIXED_POISSON: &[&str] = &[OF_PARTS, RULES, "bodies.bar.material.poissons_ratio=0.3"];

const TURN: Case = Case {
    capabilities: &["FAU-53", "FAU-74"],
    scene: "half_turn",
    settings: MIXED,
    reading: Reading::last("energy"),
    tolerance: Tolerance::Relative(5e-3),
    source: "specification, EXP-31 oracle; it asks for 0.5 %",
    mutation: r#"bodies.bar.material.youngs_modulus="101 MPa""#,
    ..BEAM
};

const TUMOUR: Case = Case {
    capabilities: &["FAU-55"],
    scene: "tumour",
    reading: Reading::last("of_tumour"),
    source: "specification, EXP-39",
    ..BEAM
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "exp29_mixed_24",
        what: "tip of the beam of prisms, pyramids, hexahedra and tetrahedra, 24 x 4 x 4 cubes",
        reference: -0.57177,
        ..BEAM
    },
    Case {
        id: "exp29_mixed_48",
        what: "the same, 48 x 8 x 8 cubes: 11,520 cells",
        settings: &["bodies.bar.mesh.cells=[48, 8, 8]"],
        reference: -0.59816,
        ..BEAM
    },
    Case {
        id: "exp29_order_mixed",
        what: "order of the tip's error, all four elements, 4 and 8 cubes across",
        refinement: Some(Refinement {
            size_of: "cell",
            runs: &[
                Variant { size: 1.0 / 4.0, settings: &["bodies.bar.mesh.cells=[24, 4, 4]"] },
                Variant { size: 1.0 / 8.0, settings: &["bodies.bar.mesh.cells=[48, 8, 8]"] },
            ],
            limit: Limit::Known(-0.6072),
        }),
        reference: 2.0,
        // as of each of the four: `long_beam.rs`
        tolerance: Tolerance::Absolute(0.25),
        source: "specification, EXP-27 (b): order two for every element",
        // another limit
        mutation: r#"bodies.bar.material.youngs_modulus="110 MPa""#,
        ..BEAM
    },
    Case {
        id: "exp30_prisms_of_hooke",
        capabilities: &["FAU-53", "FAU-54"],
        what: "the same with Hooke's law in the prisms, which hardly turn",
        settings: &[
            "bodies.bar.mesh.cells=[48, 8, 8]",
            r#"bodies.bar.regions.prisms.material.name="linear""#,
        ],
        reference: -0.59716,
        source: "specification, EXP-30 oracle; it asks for less than 2 mm from EXP-29",
        mutation: r#"bodies.bar.regions.prisms.material.name="st_venant_kirchhoff""#,
        ..BEAM
    },
    Case {
        id: "exp31_mixed_energy",
        what: "energy of the mixed beam twisted by half a turn",
        reference: 5.0169e6,
        ..TURN
    },
    Case {
        id: "exp31_mixed_moment",
        what: "moment about its axis at the turned end",
        reading: Reading::component("moment", 0),
        reference: 3.1644e6,
        ..TURN
    },
    Case {
        id: "exp31_mixed_energy_poisson",
        what: "the same energy with a Poisson ratio of 0.3",
        settings: MIXED_POISSON,
        reference: 3.9243e6,
        ..TURN
    },
    Case {
        id: "exp31_mixed_moment_poisson",
        what: "the moment with a Poisson ratio of 0.3",
        settings: MIXED_POISSON,
        reading: Reading::component("moment", 0),
        reference: 2.5026e6,
        ..TURN
    },
    Case {
        id: "exp39_tumour_keeps_its_volume",
        what: "volume of a stiff tumour over that at rest, its tissue pressed together by 9 %",
        reference: 1.0,
        tolerance: Tolerance::Absolute(0.01),
        mutation: r#"bodies.tissue.regions.tumour.material.youngs_modulus="4 kPa""#,
        ..TUMOUR
    },
    Case {
        id: "exp39_tissue_gives_way",
        what: "volume of the tissue around it over that at rest",
        reading: Reading::last("around_it"),
        // the whole shrinks to 0.97³, of which the tumour keeps 0.4³; cells beside the tumour are not counted
        reference: (0.97 * 0.97 * 0.97 - 0.064) / (1.0 - 0.064),
        tolerance: Tolerance::Absolute(0.002),
        source: "specification, EXP-39, which asks for less than 0.95; balance of volumes",
        mutation: r#"bodies.tissue.regions.tumour.material.youngs_modulus="4 kPa""#,
        ..TUMOUR
    },
];
