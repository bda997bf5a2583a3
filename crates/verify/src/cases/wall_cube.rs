//! V-01 of the multiresolution specification: a cube glued to a wall by one face, under gravity, in Cauchy's and in
//! Green–Lagrange's strain, on the meshes `K_S(n)`: six tetrahedra in each of n³ cells, one for each order of the axes; and on `K_M(n)`, the
//! same with every second cell along each axis mirrored.
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

/// Settings for n mirrored cells along each edge and a law.
macro_rules! mirrored_cube {
    ($cells:literal, $law:literal) => {
        &[
            concat!("bodies.cube.mesh.cells=[", $cells, ", ", $cells, ", ", $cells, "]"),
            "bodies.cube.mesh.element=\"tet4_mirrored\"",
            concat!("bodies.cube.material.name=\"", $law, "\""),
        ]
    };
}

/// The three rows of a law and a mirrored mesh.
macro_rules! mirrored_rows {
    ($($name:literal $cells:literal $law:literal: $down:literal $top:literal $bottom:literal;)+) => {
        &[$(
            Case {
                id: concat!("wall_cube_", $name, "_down"),
                what: concat!("the cube at the wall sinks: upper far edge, ", $law, ", K_M(", $cells, ")"),
                settings: mirrored_cube!($cells, $law),
                reference: $down,
                ..MIRRORED_DOWN
            },
            Case {
                id: concat!("wall_cube_", $name, "_top"),
                what: concat!("the same edge, away from the wall, ", $law, ", K_M(", $cells, ")"),
                settings: mirrored_cube!($cells, $law),
                reference: $top,
                ..MIRRORED_TOP
            },
            Case {
                id: concat!("wall_cube_", $name, "_bottom"),
                what: concat!("the lower far edge, away from the wall, ", $law, ", K_M(", $cells, ")"),
                settings: mirrored_cube!($cells, $law),
                reference: $bottom,
                ..MIRRORED_BOTTOM
            },
        )+]
    };
}

/// Unmirrored the same cells are stiffer, by more than the rows allow.
const UNMIRRORED: &str = "bodies.cube.mesh.element=\"tet4\"";
const MIRRORED_DOWN: Case = Case { mutation: UNMIRRORED, ..DOWN };
const MIRRORED_TOP: Case = Case { mutation: UNMIRRORED, ..TOP };
const MIRRORED_BOTTOM: Case = Case { mutation: UNMIRRORED, ..BOTTOM };

/// The other half of V-01's table.
pub(super) const MIRRORED: &[Case] = mirrored_rows! {
    "cauchy_mirrored_2" "2" "linear": -0.01107 0.00302 -0.00302;
    "cauchy_mirrored_4" "4" "linear": -0.01325 0.00414 -0.00414;
    "cauchy_mirrored_8" "8" "linear": -0.01437 0.00464 -0.00464;
    "green_mirrored_2" "2" "st_venant_kirchhoff": -0.01118 0.00236 -0.00368;
    "green_mirrored_4" "4" "st_venant_kirchhoff": -0.01343 0.00320 -0.00512;
    "green_mirrored_8" "8" "st_venant_kirchhoff": -0.01463 0.00354 -0.00582;
};

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

/// Settings for an element and n cells along each edge by the hybrid operator.
macro_rules! sheared_cube {
    ($element:literal, $cells:literal) => {
        &[
            "bodies.cube.material.name=\"linear\"",
            HYBRID,
            concat!("bodies.cube.mesh.element=\"", $element, "\""),
            concat!("bodies.cube.mesh.cells=[", $cells, ", ", $cells, ", ", $cells, "]"),
        ]
    };
}

/// The three rows of an element and a number of cells by the hybrid operator; of K_S(4) and K_S(8) the first is above.
macro_rules! sheared {
    ($($name:literal $mesh:literal $element:literal $cells:literal: $($down:literal)? $(; $top:literal $bottom:literal)?,)+) => {
        &[$(
            $(Case {
                id: concat!("wall_cube_hybrid_", $name, "_down"),
                what: concat!("the upper far edge of the cube at the wall by the hybrid operator, ", $mesh),
                settings: sheared_cube!($element, $cells),
                reference: $down,
                ..SHEAR_DOWN
            },)?
            $(Case {
                id: concat!("wall_cube_hybrid_", $name, "_top"),
                what: concat!("the same edge, away from the wall: hardly, ", $mesh),
                settings: sheared_cube!($element, $cells),
                reference: $top,
                ..SHEAR_TOP
            },
            Case {
                id: concat!("wall_cube_hybrid_", $name, "_bottom"),
                what: concat!("the lower far edge, away from the wall, ", $mesh),
                settings: sheared_cube!($element, $cells),
                reference: $bottom,
                ..SHEAR_BOTTOM
            },)?
        )+]
    };
}

/// The column of V-01's table that is the hybrid operator's.
pub(super) const SHEARED_MESHES: &[Case] = sheared! {
    "2" "K_S(2)" "tet4" "2": -0.00721; 0.00002 0.00013,
    "4" "K_S(4)" "tet4" "4": ; 0.00001 0.00004,
    "8" "K_S(8)" "tet4" "8": ; 0.0 0.00001,
    "mirrored_2" "K_M(2)" "tet4_mirrored" "2": -0.00710; -0.00014 0.00014,
    "mirrored_4" "K_M(4)" "tet4_mirrored" "4": -0.00703; -0.00005 0.00005,
    "mirrored_8" "K_M(8)" "tet4_mirrored" "8": -0.00701; -0.00002 0.00002,
};

const SHEAR_DOWN: Case = Case { capabilities: &["DEB-23"], source: "specification, V-01 and V-18", ..DOWN };
/// By Cauchy's strain the edges move along the wall's normal by a millimetre and more.
const SHEAR_TOP: Case = Case {
    reading: Reading::component("top", 0),
    mutation: r#"bodies.cube.formulation={ name = "edge_tensors" }"#,
    ..SHEAR_DOWN
};
const SHEAR_BOTTOM: Case = Case { reading: Reading::component("bottom", 0), ..SHEAR_TOP };

const HYBRID: &str = r#"bodies.cube.formulation={ name = "hybrid" }"#;
