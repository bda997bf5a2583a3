//! Lamé's thick sphere: a hollow ball under pressure from inside.
//!
//! `u(r) = p a³ / (E (b³ - a³)) ((1 - 2ν) r + (1 + ν) b³ / (2 r²))`, here with `a = 1 m`, `b = 2 m`, `p = 1 kPa`, `E = 1 MPa`, `ν = 0.3`. The pressure
//! follows the faces; at strains of 1e-3 that changes the answer by as much.
//!
//! Linear elements on chords of the sphere have errors of even powers of their size, `e(h) = C h² (1 + κ h² + …)`: faces sink below the
//! sphere by `h²/8R`, and the interpolation is off by as much. The order between two sizes then differs from two in proportion to
//! `κ h²`, and between halves of them by a quarter of that. Each bar is half of what the order between the runs before
//! differs by, as much again as two terms leave: 0.018 of hexahedra (sizes 0.25 and 0.125), 0.278 of prisms (the same), 0.244 of pyramids
//! (0.5 and 0.25), 0.212 of tetrahedra (0.25 and 0.125).

use crate::{Case, Limit, Reading, Refinement, Tolerance, Variant};

const INNER: f64 = 8.0e-4;

/// So small a pressure that the faces stay: the answer changes by its strain, 1e-6.
const GENTLE: &str = r#"parameters.pressure="1 Pa""#;

const HALVED: Refinement = Refinement {
    size_of: "cell [m]",
    runs: &[
        Variant { size: 0.25, settings: &["parameters.cells=4", "parameters.layers=4"] },
        Variant { size: 0.125, settings: &["parameters.cells=8", "parameters.layers=8"] },
        Variant { size: 0.0625, settings: &["parameters.cells=16", "parameters.layers=16"] },
    ],
    limit: Limit::Known(1e-3 * INNER),
};

/// Six cells to a cube: pyramids are near their order sooner, tetrahedra later.
const PYRAMIDS: Refinement = Refinement {
    runs: &[
        Variant { size: 0.25, settings: &["parameters.cells=4", "parameters.layers=4"] },
        Variant { size: 0.125, settings: &["parameters.cells=8", "parameters.layers=8"] },
    ],
    ..HALVED
};

const TETRAHEDRA: Refinement = Refinement {
    runs: &[
        Variant { size: 1.0 / 8.0, settings: &["parameters.cells=8", "parameters.layers=8"] },
        Variant { size: 1.0 / 12.0, settings: &["parameters.cells=12", "parameters.layers=12"] },
    ],
    ..HALVED
};

const SPHERE: Case = Case {
    id: "",
    capabilities: &["FAU-7"],
    what: "",
    scene: "thick_sphere",
    settings: &[GENTLE],
    reading: Reading::component("inner", 0),
    refinement: Some(HALVED),
    reference: 2.0,
    tolerance: Tolerance::Absolute(0.009),
    source: "Lamé 1852; Timoshenko & Goodier 1970, §136",
    mutation: "bodies.ball.material.poissons_ratio=0.31",
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "thick_sphere_order_hex8",
        what: "order of the inner radius' error under inner pressure, hex8",
        ..SPHERE
    },
    Case {
        id: "thick_sphere_order_prism6",
        what: "the same, prism6",
        settings: &[GENTLE, r#"parameters.element="prism6""#],
        tolerance: Tolerance::Absolute(0.139),
        ..SPHERE
    },
    Case {
        id: "thick_sphere_order_pyramid5",
        what: "the same, pyramid5",
        settings: &[GENTLE, r#"parameters.element="pyramid5""#],
        refinement: Some(PYRAMIDS),
        tolerance: Tolerance::Absolute(0.122),
        ..SPHERE
    },
    Case {
        id: "thick_sphere_order_tet4",
        what: "the same, tet4",
        settings: &[GENTLE, r#"parameters.element="tet4""#],
        refinement: Some(TETRAHEDRA),
        tolerance: Tolerance::Absolute(0.106),
        ..SPHERE
    },
];
