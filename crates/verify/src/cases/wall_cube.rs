//! V-01 of the multiresolution specification: a cube glued to a wall by one face, under gravity, in Cauchy's and in
//! Green–Lagrange's strain, on the meshes `K_S(n)`: six tetrahedra in each of n³ cells, one for each order of the axes.
//!
//! Cauchy's strain takes the turn at the wall for strain and answers up and down alike; Green–Lagrange's lets the cube arc:
//! its lower far edge comes nearer to the wall by more than the upper one leaves it.

use crate::{Case, Reading, Tolerance};

const DOWN: Case = Case {
    id: "",
    capabilities: &["DEB-50"],
    what: "",
    scene: "wall_cube",
    settings: &[],
    reading: Reading::component("top", 2),
    refinement: None,
    reference: f64::NAN,
    // millimetres as printed, to two digits; the specification allows 0.02 mm
    tolerance: Tolerance::Absolute(6e-6),
    source: "specification, V-01",
    mutation: "world.gravity=[0, 0, -9.9]",
};

const TOP: Case =
    Case { reading: Reading::component("top", 0), mutation: "world.gravity=[0, 0, -9.7]", ..DOWN };
const BOTTOM: Case = Case { reading: Reading::component("bottom", 0), ..DOWN };

/// Settings for n cells along each edge and a law.
macro_rules! cube {
    ($cells:literal, $law:literal) => {
        &[
            concat!("bodies.cube.mesh.cells=[", $cells, ", ", $cells, ", ", $cells, "]"),
            concat!("bodies.cube.material.name=\"", $law, "\""),
        ]
    };
}

/// The three rows of a law and a mesh: how far the upper far edge sinks and moves outward, and the lower one.
macro_rules! rows {
    ($($name:literal $cells:literal $law:literal: $down:literal $top:literal $bottom:literal;)+) => {
        &[$(
            Case {
                id: concat!("wall_cube_", $name, "_down"),
                what: concat!("the cube at the wall sinks: upper far edge, ", $law, ", K_S(", $cells, ")"),
                settings: cube!($cells, $law),
                reference: $down,
                ..DOWN
            },
            Case {
                id: concat!("wall_cube_", $name, "_top"),
                what: concat!("the same edge, away from the wall, ", $law, ", K_S(", $cells, ")"),
                settings: cube!($cells, $law),
                reference: $top,
                ..TOP
            },
            Case {
                id: concat!("wall_cube_", $name, "_bottom"),
                what: concat!("the lower far edge, away from the wall, ", $law, ", K_S(", $cells, ")"),
                settings: cube!($cells, $law),
                reference: $bottom,
                ..BOTTOM
            },
        )+]
    };
}

pub(super) const CASES: &[Case] = rows! {
    "cauchy_2" "2" "linear": -0.01005 0.00220 -0.00258;
    "cauchy_4" "4" "linear": -0.01232 0.00355 -0.00372;
    "cauchy_8" "8" "linear": -0.01395 0.00443 -0.00447;
    "green_2" "2" "st_venant_kirchhoff": -0.01005 0.00162 -0.00316;
    "green_4" "4" "st_venant_kirchhoff": -0.01241 0.00271 -0.00456;
    "green_8" "8" "st_venant_kirchhoff": -0.01416 0.00338 -0.00556;
};

/// V-18: by the hybrid operator the cube only shears, half as far.
pub(super) const SHEARED: &[Case] = &[
    Case {
        id: "wall_cube_hybrid_4_down",
        capabilities: &["DEB-23"],
        what: "the cube at the wall by the hybrid operator: upper far edge, K_S(4)",
        settings: &["bodies.cube.material.name=\"linear\"", HYBRID],
        reference: -0.00708,
        source: "specification, V-01 and V-18",
        ..DOWN
    },
    Case {
        id: "wall_cube_hybrid_8_down",
        capabilities: &["DEB-23"],
        what: "the same, K_S(8), on the way to 7.007 mm of a column of shear",
        settings: &["bodies.cube.material.name=\"linear\"", HYBRID, "bodies.cube.mesh.cells=[8, 8, 8]"],
        reference: -0.00703,
        source: "specification, V-01 and V-18",
        ..DOWN
    },
];

const HYBRID: &str = r#"bodies.cube.formulation={ name = "hybrid" }"#;
