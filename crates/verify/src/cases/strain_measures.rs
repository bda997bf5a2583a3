//! What strain measures and operators make of motions that need no equilibrium: a shift, a turn, a turn so small that it is
//! linear, a stretch. Each is put on a free cube at the start, whose energy is then read; all are homogeneous, exact on
//! every mesh, and have energies in closed form.
//!
//! Cauchy's strain takes a turn by θ for one of `cos θ - 1` along both axes of its plane; Green–Lagrange's feels none. The
//! hybrid operator feels even what is linear: of the six rigid motions the three shifts alone are free.

use crate::{Case, Reading, Tolerance};

/// λ = 8 kPa and μ = 2.8 kPa, a litre.
const FREE: Case = Case {
    id: "",
    capabilities: &["DEB-2"],
    what: "",
    scene: "swinging_cube",
    settings: &[],
    reading: Reading::last("energy").after(0),
    refinement: None,
    reference: 0.0,
    // entries of a gradient are differences of places, to 7e-15: ½ (λ + 2 μ) · 3 (7e-15)² of a litre, with the places
    // shifted by several of its edges
    tolerance: Tolerance::Absolute(1e-26),
    source: "specification, V-03",
    mutation: r#"bodies.cube.start={ displacement = ["0.01 * x", 0, 0] }"#,
};

/// Of an energy that is there: of entries of 0.1 to 7e-15, twice.
const EXACT: Tolerance = Tolerance::Relative(2e-13);

const PINS: &str = "bodies.cube.pins=[]";
const GRAVITY: &str = "world.gravity=[0, 0, 0]";

const CAUCHY: &str = r#"bodies.cube.formulation={ name = "edge_tensors" }"#;
const HYBRID: &str = r#"bodies.cube.formulation={ name = "hybrid" }"#;
const SPRINGS: &str = r#"bodies.cube.formulation={ name = "mass_spring" }"#;
const SAMPLES: &str = r#"bodies.cube.formulation={ name = "samples" }"#;
const GREEN: &str = r#"bodies.cube.material.name="st_venant_kirchhoff""#;

const SHIFTED: &str = "bodies.cube.start={ displacement = [0.1, -0.2, 0.3] }";
/// By half a radian.
const TURNED: &str = r#"bodies.cube.start={ displacement = ["(cos(0.5) - 1) * x - sin(0.5) * y", "sin(0.5) * x + (cos(0.5) - 1) * y", 0] }"#;
/// `u = ω × x`.
const LINEAR_TURN: &str = r#"bodies.cube.start={ displacement = ["-0.1 * y", "0.1 * x", 0] }"#;
const STRETCHED: &str = r#"bodies.cube.start={ displacement = ["0.01 * x", "0.01 * y", "0.01 * z"] }"#;

pub(super) const CASES: &[Case] = &[
    Case {
        id: "shifted_cauchy",
        what: "energy of a cube that is shifted by several of its edges, Cauchy's strain",
        settings: &[PINS, GRAVITY, CAUCHY, SHIFTED],
        ..FREE
    },
    Case {
        id: "shifted_green",
        capabilities: &["DEB-3"],
        what: "the same, Green-Lagrange's",
        settings: &[PINS, GRAVITY, SAMPLES, GREEN, SHIFTED],
        ..FREE
    },
    Case {
        id: "shifted_hybrid",
        capabilities: &["DEB-23"],
        what: "the same, the hybrid operator",
        settings: &[PINS, GRAVITY, HYBRID, SHIFTED],
        ..FREE
    },
    Case {
        id: "shifted_springs",
        capabilities: &["DEB-24"],
        what: "the same, springs",
        settings: &[PINS, GRAVITY, SPRINGS, SHIFTED],
        ..FREE
    },
    Case {
        id: "turned_green",
        capabilities: &["DEB-3"],
        what: "energy of the cube when it is turned by half a radian, Green-Lagrange's strain: none",
        settings: &[PINS, GRAVITY, SAMPLES, GREEN, TURNED],
        ..FREE
    },
    Case {
        id: "turned_cauchy",
        what: "the same, Cauchy's strain: cos 0.5 - 1 along two axes",
        settings: &[PINS, GRAVITY, CAUCHY, TURNED],
        // 2 (λ + μ) (cos θ - 1)² V
        reference: 0.323_698_229_711_807_34,
        tolerance: EXACT,
        ..FREE
    },
    Case {
        id: "turned_hybrid",
        capabilities: &["DEB-23"],
        what: "the same, the hybrid operator",
        settings: &[PINS, GRAVITY, HYBRID, TURNED],
        // (μ ((cos θ - 1)² + sin²θ) + 2 (λ + μ) (cos θ - 1)²) V
        reference: 1.009_235_883_125_720_2,
        tolerance: EXACT,
        ..FREE
    },
    Case {
        id: "linear_turn_cauchy",
        what: "energy of u = ω × x, Cauchy's strain: all six rigid motions are free",
        settings: &[PINS, GRAVITY, CAUCHY, LINEAR_TURN],
        // ½ Σ u f over 27 points: f of entries of 1 kN/m times a centimetre, to rounding
        tolerance: Tolerance::Absolute(1e-15),
        source: "specification, V-17",
        ..FREE
    },
    Case {
        id: "linear_turn_hybrid",
        capabilities: &["DEB-23"],
        what: "the same, the hybrid operator: shifts alone are",
        settings: &[PINS, GRAVITY, HYBRID, LINEAR_TURN],
        // μ ω² V
        reference: 0.028,
        tolerance: EXACT,
        source: "specification, V-17",
        ..FREE
    },
    Case {
        id: "moduli_100",
        capabilities: &["DEB-1"],
        what: "energy of a cube that is a hundredth longer along every axis, at the ratio of 50/101 where λ is a hundred times μ",
        settings: &[
            PINS,
            GRAVITY,
            CAUCHY,
            STRETCHED,
            "bodies.cube.material.poissons_ratio=0.49504950495049505",
            "bodies.cube.material.youngs_modulus=8372.277227722772",
        ],
        // (9/2 · 100 + 3) μ (1 %)² V
        reference: 0.126_84,
        // 1 - 2 ν is a hundredth: its rounding, of half a unit of the last digit of ν, is that of λ a hundred times
        tolerance: Tolerance::Relative(2e-12),
        source: "specification, V-02",
        mutation: "bodies.cube.material.poissons_ratio=0.495",
        ..FREE
    },
];
