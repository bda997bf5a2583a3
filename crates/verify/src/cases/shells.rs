//! Surfaces of triangles that resist bending: thin plates and shells (PA-16 of the survey).
//!
//! The error of displacements falls as `C h²`. Where the next power is as large on the coarser of two meshes as a twelfth of the first, the
//! order between them is moved by `log₂ (1 + 1/12) / (1 + 1/48)` = 0.09; on crooked meshes, which are no halves of each other, chance
//! moves it as much again.

use crate::{Case, Limit, Reading, Refinement, Tolerance, Variant};

const TO_32: &[Variant] = &[
    Variant { size: 1.0 / 8.0, settings: &["parameters.cells=8"] },
    Variant { size: 1.0 / 16.0, settings: &["parameters.cells=16"] },
    Variant { size: 1.0 / 32.0, settings: &["parameters.cells=32"] },
];

/// `q a⁴ / D` [m].
const UNIT: f64 = 0.2 / 100.0;

/// Middle of a plate on its edges.
const SUPPORTED: f64 = -0.004_062_35 * UNIT;
/// Middle of a clamped plate.
const CLAMPED: f64 = -0.001_265_32 * UNIT;

const PLATE: Case = Case {
    id: "",
    capabilities: &["JIM-97"],
    what: "",
    scene: "shell_plates",
    settings: &[],
    reading: Reading::component("supported", 2),
    refinement: Some(Refinement { size_of: "cell [m]", runs: TO_32, limit: Limit::Known(SUPPORTED) }),
    reference: 2.0,
    tolerance: Tolerance::Absolute(0.18),
    source: "Timoshenko & Woinowsky-Krieger 1959, tables 8 and 35; series to six digits",
    // another rigidity: the error does not fall
    mutation: r#"bodies.supported.material.youngs_modulus="1.2 GPa""#,
};

const CLAMPED_PLATE: Case = Case {
    reading: Reading::component("clamped", 2),
    refinement: Some(Refinement { size_of: "cell [m]", runs: TO_32, limit: Limit::Known(CLAMPED) }),
    mutation: r#"bodies.clamped.material.youngs_modulus="1.2 GPa""#,
    ..PLATE
};

/// `ρ g h L⁴ / 8` of the shelf [N m²]: over its rigidity, how far its end comes down.
const BURDEN: f64 = 1000.0 * 9.81 * 2e-3 * 0.0625 / 8.0;
/// `E h³ / 12` [N m].
const RIGIDITY: f64 = 50e9 * 8e-9 / 12.0;

const SHELF: Case = Case {
    scene: "shell_shelf",
    reading: Reading::component("end", 2),
    refinement: None,
    reference: -BURDEN / RIGIDITY,
    // cells of L/16: (1/16)² = 0.4 % of the slope's change along the last of them, and half that of lumped weight; the sag is a
    // hundredth of the length, 1e-4 of what is linear
    tolerance: Tolerance::Relative(6e-3),
    source: "q L⁴ / 8 D of a beam with the stiffness D b",
    mutation: r#"bodies.shelf.section.thickness="2.02 mm""#,
    ..PLATE
};

/// The same strip with rigidities of its own: a hundred newton metres along it.
const GRAINED: &str =
    "bodies.shelf.bending={ clamped = \"x_min\", along = 100, across = 1, coupling = 0, twist = 10 }";

/// Sixteen chords of the turn `a`: `(a/2) / sin(a/2)` times the radius.
const ROLLED: f64 = 0.254_750_203_088_701_4;

const CURL: Case = Case {
    scene: "shell_curl",
    reading: Reading::component("end", 2),
    reference: ROLLED,
    // nothing is strained there; swings of 6/s have had four of damping for six seconds, exp(-24) and less by implicit steps
    tolerance: Tolerance::Relative(1e-6),
    source: "a polygon of equal turns, whose folds have the natural curvature",
    mutation: "parameters.curvature=3.93",
    ..SHELF
};

/// `exp(-1)` of a tenth of a millimetre: motion back without a swing takes `D_v / D` of moments per rate and per curvature.
const LEFT: f64 = 1e-4 * 0.367_879_441_171_442_3;

const DECAY: Case = Case {
    scene: "shell_decay",
    reading: Reading::component("rayleigh", 2),
    reference: LEFT,
    // a hundred implicit steps to the time: (1 + 1/100)^-100 is half a hundredth more. Inertia of 1/(1.6 s 62.4/s)² = 1e-4, slopes of
    // 3e-4 squared; both moments are of one shape
    tolerance: Tolerance::Relative(5.2e-3),
    source: "Kelvin-Voigt damping: w' D_v = -w D",
    mutation: r#"bodies.rayleigh.bending.rayleigh_stiffness="1.62 s""#,
    ..SHELF
};

const RULER: Case = Case {
    scene: "shell_ruler",
    reading: Reading::component("end", 2),
    reference: 0.5,
    // rounding, and what Newton's method leaves of a motion of a metre
    tolerance: Tolerance::Absolute(1e-8),
    source: "a rigid turn strains nothing",
    mutation: r#"bodies.ruler.pins[0].rotation.offsets=[[0,0,0],[0,"-89 deg",0]]"#,
    ..SHELF
};

pub(super) const CASES: &[Case] = &[
    Case { id: "shell_supported_order", what: "order of the error of a plate on its edges", ..PLATE },
    Case {
        id: "shell_supported_crooked_order",
        what: "order of the error of a plate on its edges, crooked triangles",
        settings: &["parameters.disorder=0.2"],
        ..PLATE
    },
    Case { id: "shell_clamped_order", what: "order of the error of a clamped plate", ..CLAMPED_PLATE },
    Case {
        id: "shell_clamped_crooked_order",
        what: "order of the error of a clamped plate, crooked triangles",
        settings: &["parameters.disorder=0.2"],
        ..CLAMPED_PLATE
    },
    Case { id: "shell_sags_as_a_beam", what: "end of a shelf under its own weight", ..SHELF },
    Case {
        id: "shell_sags_along_its_grain",
        what: "end of a shelf of two axes under its own weight",
        settings: &[GRAINED],
        reference: -BURDEN / 100.0,
        source: "q L⁴ / 8 D₁₁ of a beam with the stiffness D₁₁ b",
        mutation: "bodies.shelf.bending.along=102",
        ..SHELF
    },
    Case { id: "shell_springs_back", what: "height of a strip that springs back to its circle", ..CURL },
    Case {
        id: "shell_springs_back_along",
        what: "how far along it ends, where it began",
        reading: Reading::component("end", 0),
        ..CURL
    },
    Case {
        id: "shell_springs_back_crooked",
        what: "energy of a crooked strip that lies on its natural curvature, clamp and free edges too",
        reading: Reading::last("energy"),
        settings: &["bodies.strip.mesh.disorder=0.2", "parameters.curvature=1e-3"],
        reference: 0.0,
        // flat, it stores E h³/24 κ² A = 1.7e-9 J, and a thousandth of that where free edges do not know of the curvature; slopes of
        // 4e-4 leave their squares, and damping exp(-48)
        tolerance: Tolerance::Absolute(1e-14),
        source: "a surface of constant curvature, which is in every patch of triangles",
        // triangles of steep slopes are off by their squares
        mutation: "parameters.curvature=0.5",
        ..CURL
    },
    Case { id: "shell_decays_by_rayleigh", what: "what is left of the bend of a damped plate", ..DECAY },
    Case {
        id: "shell_decays_by_viscosity",
        what: "what is left of the bend of a viscous plate",
        reading: Reading::component("viscous", 2),
        // the first mode bends both ways alike, and its twist and its bending across each other weigh less with ν = 0 than with 0.3 by
        // what the triangles are off from Δw² alone, of the order of (π/8)²/12
        tolerance: Tolerance::Relative(2e-2),
        mutation: r#"bodies.viscous.damping.viscosity="1000 MPa s""#,
        ..DECAY
    },
    Case { id: "shell_clamp_is_turned", what: "height of the end of a ruler whose vice was turned", ..RULER },
];
