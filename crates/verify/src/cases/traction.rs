//! EXP-14 of the solids' specification: Young's modulus and Poisson's ratio from the traction of a bar.
//!
//! The state is uniform, so that every mesh gives the same: with the strain `e = 0.05` and the section `A = 0.04 m²`, Hooke's law
//! pulls with `E A e`; St. Venant–Kirchhoff's with `E A (1 + e)(e + e²/2)`, which is 1.07625 of that, as its stress is uniaxial
//! in Green's strain; and a bar kept from narrowing one way with `E A e / (1 - ν²)`.

use crate::{Case, Reading, Tolerance};

const PULL: Case = Case {
    id: "",
    capabilities: &["FAU-72", "FAU-7"],
    what: "",
    scene: "traction",
    settings: &[],
    reading: Reading::component("pull", 0),
    refinement: None,
    reference: 2000.0,
    // Newton's method stops at 1e-9 of the greatest force at a node
    tolerance: Tolerance::Relative(1e-8),
    source: "uniform strain; the specification allows 1e-3",
    mutation: r#"bodies.bar.mesh.size=[1.2, 0.2, 0.2002]"#,
};

const SIDE: Case = Case {
    reading: Reading::component("side", 1),
    mutation: "bodies.bar.material.poissons_ratio=0.2001",
    ..PULL
};

// V-37: volume is kept by λ alone. With μ = 7 kPa, ν = λ / (2 (λ + μ)), and what the bar narrows by is -ν 0.05 x 0.2 m: its volume
// grows by (1 - 2 ν) of its strain
const KEPT: Case = Case {
    capabilities: &["DEB-49"],
    source: "V-37: uniaxial stress, change of volume over strain 1 - 2 ν",
    tolerance: Tolerance::Absolute(1e-9),
    ..SIDE
};

/// A pad of which the middle of the top is led down by a fifth: how far a place beside that is pushed away.
const PAD: Case = Case {
    capabilities: &["DEB-49"],
    scene: "pressed_pad",
    reading: Reading::component("beside", 0),
    // Newton's method stops at 1e-10 of the greatest force; of displacements up to 12 cm
    tolerance: Tolerance::Absolute(1e-9),
    source: "V-37: bulges more with λ; K u = f of the same hexahedra by an independent program",
    mutation: "bodies.pad.material.poissons_ratio=0.3",
    ..PULL
};

/// The pad at rest under Hooke's law alone, with this Young's modulus and Poisson's ratio.
macro_rules! pad {
    ($youngs_modulus:literal, $poissons_ratio:literal) => {
        &[
            "bodies.pad.adapt=",
            "probes.second_law=",
            "bodies.pad.damping=",
            r#"systems.main.stepper={ name = "static", newton_tolerance = 1e-10, solver_tolerance = 1e-11 }"#,
            "world.period=\"0.5 s\"",
            "run.duration=\"0.5 s\"",
            concat!("bodies.pad.material.youngs_modulus=", $youngs_modulus),
            concat!("bodies.pad.material.poissons_ratio=", $poissons_ratio),
        ]
    };
}

const ST_VENANT_KIRCHHOFF: &[&str] = &[r#"bodies.bar.material.name="st_venant_kirchhoff""#];

/// Every resolution of EXP-14, from 40 cells to 320, with each of its moduli: a bar of hexahedra under either law, and a slice that can
/// not grow thicker, of triangles and of quadrilaterals.
macro_rules! resolutions {
    ($($count:literal: $cells:literal, $along:literal $across:literal;)+) => {
        &[$(
            resolutions!(@bar $count $cells "linear" "hooke" "1" 2000.0),
            resolutions!(@bar $count $cells "linear" "hooke" "2" 4000.0),
            resolutions!(@bar $count $cells "linear" "hooke" "3" 6000.0),
            resolutions!(@bar $count $cells "st_venant_kirchhoff" "stvk" "1" 2000.0 * 1.076_25),
            resolutions!(@bar $count $cells "st_venant_kirchhoff" "stvk" "2" 4000.0 * 1.076_25),
            resolutions!(@bar $count $cells "st_venant_kirchhoff" "stvk" "3" 6000.0 * 1.076_25),
            resolutions!(@slice $count $along $across "tri3" "1" 2000.0),
            resolutions!(@slice $count $along $across "tri3" "2" 4000.0),
            resolutions!(@slice $count $along $across "tri3" "3" 6000.0),
            resolutions!(@slice $count $along $across "quad4" "1" 2000.0),
            resolutions!(@slice $count $along $across "quad4" "2" 4000.0),
            resolutions!(@slice $count $along $across "quad4" "3" 6000.0),
        )+]
    };
    (@bar $count:literal $cells:literal $law:literal $short:literal $modulus:literal $pull:expr) => {
        Case {
            id: concat!("exp14_", $short, "_", $count, "_", $modulus, "mpa"),
            what: concat!("pull of the stretched bar, ", $law, ", ", $modulus, " MPa, ", $count, " cells"),
            settings: &[
                concat!("bodies.bar.mesh.cells=", $cells),
                concat!("bodies.bar.material.name=\"", $law, "\""),
                concat!("bodies.bar.material.youngs_modulus=\"", $modulus, " MPa\""),
            ],
            reference: $pull,
            ..PULL
        }
    };
    (@slice $count:literal $along:literal $across:literal $element:literal $modulus:literal $pull:expr) => {
        Case {
            id: concat!("exp14_plane_", $element, "_", $count, "_", $modulus, "mpa"),
            what: concat!("the same of a slice of ", $element, ", ", $along, " by ", $across, ", ", $modulus, " MPa, plane strain"),
            settings: &[
                concat!("bodies.plate.mesh={ generate = \"sheet\", length = 1.2, width = 0.2, cells_along = ", $along, ", cells_across = ", $across, ", element = \"", $element, "\" }"),
                r#"bodies.plate.section={ name = "plane_strain", thickness = 0.2 }"#,
                concat!("bodies.plate.material={ name = \"linear\", youngs_modulus = \"", $modulus, " MPa\", poissons_ratio = 0.2, density = 800 }"),
            ],
            reference: $pull / 0.96,
            ..SLICE
        }
    };
}

/// What cannot grow thicker is stiffer by `1 / (1 - ν²)`.
const SLICE: Case = Case {
    capabilities: &["FAU-72", "FAU-1"],
    scene: "plate",
    source: "uniform strain; specification, EXP-14: 1.0417 of the modulus in plane strain",
    mutation: "bodies.plate.material.poissons_ratio=0.2001",
    ..PULL
};

pub(super) const RESOLUTIONS: &[Case] = resolutions! {
    "40": "[10, 2, 2]", "10" "2";
    "80": "[20, 2, 2]", "20" "2";
    "162": "[18, 3, 3]", "18" "3";
    "320": "[20, 4, 4]", "20" "4";
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "volume_lambda_0",
        what: "how much the stretched bar narrows, λ = 0: not at all",
        settings: &[r#"bodies.bar.material.youngs_modulus="14 kPa""#, "bodies.bar.material.poissons_ratio=0"],
        reference: 0.0,
        ..KEPT
    },
    Case {
        id: "volume_lambda_50k",
        what: "the same, λ = 50 kPa, μ = 7 kPa",
        settings: &[
            "bodies.bar.material.youngs_modulus=20140.350877192983",
            "bodies.bar.material.poissons_ratio=0.43859649122807015",
        ],
        reference: -0.438_596_491_228_070_15e-2,
        ..KEPT
    },
    Case {
        id: "volume_lambda_500k",
        what: "the same, λ = 500 kPa: hardly any volume is lost or won",
        settings: &[
            "bodies.bar.material.youngs_modulus=20903.353057199211",
            "bodies.bar.material.poissons_ratio=0.49309664694280081",
        ],
        reference: -0.493_096_646_942_800_8e-2,
        ..KEPT
    },
    Case {
        id: "traction_hooke_1mpa",
        what: "pull of the stretched bar, Hooke's law, E = 1 MPa, hex8",
        ..PULL
    },
    Case {
        id: "traction_hooke_2mpa",
        what: "the same, 2 MPa, tet4, cells half as large",
        settings: &[
            r#"bodies.bar.material.youngs_modulus="2 MPa""#,
            r#"bodies.bar.mesh.element="tet4""#,
            "bodies.bar.mesh.cells=[24, 4, 4]",
        ],
        reference: 4000.0,
        ..PULL
    },
    Case {
        id: "traction_hooke_3mpa",
        what: "the same, 3 MPa, prism6, six cells",
        settings: &[
            r#"bodies.bar.material.youngs_modulus="3 MPa""#,
            r#"bodies.bar.mesh.element="prism6""#,
            "bodies.bar.mesh.cells=[6, 1, 1]",
        ],
        reference: 6000.0,
        ..PULL
    },
    Case {
        id: "traction_hooke_pyramid5",
        what: "the same, 1 MPa, pyramid5",
        settings: &[r#"bodies.bar.mesh.element="pyramid5""#],
        ..PULL
    },
    Case {
        id: "traction_plane_strain",
        what: "pull where the bar cannot narrow one way",
        settings: &[r#"bodies.bar.pins[3].region={ union = [{ group = "z_min" }, { group = "z_max" }] }"#],
        // 1 / (1 - 0.2²)
        reference: 2000.0 / 0.96,
        ..PULL
    },
    Case {
        id: "traction_stvk",
        capabilities: &["FAU-72", "FAU-8"],
        what: "pull of the stretched bar, st_venant_kirchhoff",
        settings: ST_VENANT_KIRCHHOFF,
        reference: 2000.0 * 1.076_25,
        ..PULL
    },
    Case {
        id: "traction_hooke_side",
        what: "how far its side comes in, Hooke's law",
        reference: -0.002,
        ..SIDE
    },
    Case {
        id: "traction_stvk_side",
        capabilities: &["FAU-72", "FAU-8"],
        what: "the same, st_venant_kirchhoff",
        settings: ST_VENANT_KIRCHHOFF,
        // 0.2 m (√(1 - 2 ν E) - 1) with the strain E = e + e²/2
        reference: -0.002_060_615_338_937_665_7,
        ..SIDE
    },
    Case {
        id: "pad_bulges_lambda_0",
        what: "how far a place of a pad beside a press moves away from it, λ = 0, μ = 7 kPa: it is drawn in",
        settings: pad!("14000", "0"),
        reference: -1.818_167_270e-2,
        ..PAD
    },
    Case {
        id: "pad_bulges_lambda_50k",
        what: "the same, λ = 50 kPa: it is pushed away",
        settings: pad!("20140.350877192983", "0.43859649122807015"),
        reference: 2.979_419_706e-3,
        ..PAD
    },
    Case {
        id: "pad_bulges_lambda_500k",
        what: "the same, λ = 500 kPa: by four times as much",
        settings: pad!("20903.353057199211", "0.49309664694280081"),
        reference: 1.373_995_628e-2,
        ..PAD
    },
];
