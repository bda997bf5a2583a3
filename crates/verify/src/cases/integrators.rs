//! Explicit and semi-implicit integrators on the cube at the wall: which are one, which blow up, and up to which step each holds.

use crate::reading::Statistic;
use crate::{Case, Reading, Tolerance};

/// The cube by Cauchy's strain, let go without friction; steps of 1.25 ms, 800 a second.
const CAUCHY: &str = r#"bodies.cube.material={ name = "linear", youngs_modulus = 19185.185185185186, poissons_ratio = 0.37037037037037035, density = 1000 }"#;
const ELEMENTS: &str = "bodies.cube.formulation=";

const TWINS: Case = Case {
    id: "stoermer_is_modified_euler",
    capabilities: &["DEB-34"],
    what: "farthest that a point of the cube of 27 is by Störmer's method from where modified Euler has it, of 4800 steps the most",
    scene: "swinging_cube",
    settings: &[
        CAUCHY,
        ELEMENTS,
        r#"systems.other={ stepper = "t_simulation", steps_per_period = 8 }"#,
        r#"bodies.twin={ system = "other", mesh = { generate = "box", size = [0.1, 0.1, 0.1], cells = [2, 2, 2], element = "tet4" }, material = { name = "linear", youngs_modulus = 19185.185185185186, poissons_ratio = 0.37037037037037035, density = 1000 }, pins = [{ region = "x_min" }] }"#,
        r#"probes.gap={ body = "cube", quantity = "displacement", component = "length", reduce = "max", against = { body = "twin" } }"#,
        "expect=[]",
    ],
    reading: Reading::last("gap").taking(Statistic::Max),
    refinement: None,
    // of 19.3 mm by which its corner swings
    reference: 1e-12 * 19.3e-3,
    tolerance: Tolerance::AtMost,
    source: "specification, V-34: equal to 1e-12",
    // of the same order in the places, and another method: 0.3 mm
    mutation: r#"systems.other.stepper="verlet""#,
};

/// One kilogram of 10 cm under a thousandth of its weight: what it sags by, 13 µm at most, is a seventh of this. What swings without friction sags by twice that
/// at most, and what is not stable goes beyond any bound.
const BOUND: f64 = 1e-4;

const LIMIT: Case = Case {
    capabilities: &["DEB-34"],
    scene: "levels_cube",
    reading: Reading::component("edge", 2).taking(Statistic::Span).after(1000),
    reference: BOUND,
    tolerance: Tolerance::AtMost,
    source: "specification, V-34: 2/ω of modified Euler, and h² λ(M⁻¹(K - 2D)) < 4 of the semi-implicit push with D the diagonal blocks of K",
    ..TWINS
};

/// The cube of one mesh, every point of which is pushed in each step.
macro_rules! pushed {
    ($cells:literal, $moduli:expr, $semi_implicit:literal, $period:literal) => {
        &[
            "expect=[]",
            "world.gravity=[0, 0, -0.01]",
            concat!("bodies.cube.mesh.cells=", $cells),
            $moduli,
            r#"bodies.cube.levels={ count = 1, fixed = "0", coupling = "one_way" }"#,
            "bodies.cube.damping=",
            concat!(
                r#"systems.main.stepper={ name = "staggered", halvings = 0, semi_implicit = "#,
                $semi_implicit,
                " }"
            ),
            concat!("world.period=\"", $period, "\""),
        ]
    };
}

/// Limits of modified Euler and of the semi-implicit push, rows 2 % below and 5 % above each: what is above grows by 1.9 in each step of modified Euler, and by as
/// little as 1.03 of the semi-implicit push, from rounding, so that it is looked at after so many steps.
macro_rules! limits {
    ($($name:literal $cells:literal $moduli:ident: $explicit:literal [$below:literal, $above:literal after $soon:literal], $limit:literal [$under:literal, $over:literal after $steps:literal];)+) => {
        &[$(
            Case {
                id: concat!("modified_euler_", $name, "_below"),
                what: concat!("how far the edge of the cube swings in 1000 steps of modified Euler of ", $below, ", ", $name, ": the limit is ", $explicit),
                settings: pushed!($cells, $moduli, "false", $below),
                mutation: concat!("world.period=\"", $above, "\""),
                ..LIMIT
            },
            Case {
                id: concat!("modified_euler_", $name, "_above"),
                what: concat!("the same of ", $soon, " steps of ", $above, ": it goes beyond that"),
                settings: pushed!($cells, $moduli, "false", $above),
                reading: LIMIT.reading.after($soon),
                tolerance: Tolerance::Above,
                mutation: concat!("world.period=\"", $below, "\""),
                ..LIMIT
            },
            Case {
                id: concat!("semi_implicit_", $name, "_below"),
                capabilities: &["DEB-36"],
                what: concat!("how far it swings in 1000 semi-implicit steps of ", $under, ", ", $name, ": the limit is ", $limit),
                settings: pushed!($cells, $moduli, "true", $under),
                // the same step of modified Euler
                mutation: "systems.main.stepper.semi_implicit=false",
                ..LIMIT
            },
            Case {
                id: concat!("semi_implicit_", $name, "_above"),
                capabilities: &["DEB-36"],
                what: concat!("the same of ", $steps, " steps of ", $over, ": it goes beyond that"),
                settings: pushed!($cells, $moduli, "true", $over),
                reading: LIMIT.reading.after($steps),
                tolerance: Tolerance::Above,
                mutation: concat!("world.period=\"", $under, "\""),
                ..LIMIT
            },
        )+]
    };
}

/// λ = 20 kPa, μ = 7 kPa.
const SOFT: &str = CAUCHY;
/// λ = 500 kPa, μ = 7 kPa.
const NEARLY_INCOMPRESSIBLE: &str = r#"bodies.cube.material={ name = "linear", youngs_modulus = 20903.353057199211, poissons_ratio = 0.49309664694280081, density = 1000 }"#;

pub(super) const LIMITS: &[Case] = limits! {
    "2" "[2, 2, 2]" SOFT: "5.62 ms" ["5.5 ms", "5.9 ms" after 35], "15.2 ms" ["14.9 ms", "15.9 ms" after 500];
    "4" "[4, 4, 4]" SOFT: "2.83 ms" ["2.77 ms", "2.97 ms" after 40], "7.56 ms" ["7.4 ms", "7.94 ms" after 560];
    "2_incompressible" "[2, 2, 2]" NEARLY_INCOMPRESSIBLE: "1.38 ms" ["1.35 ms", "1.45 ms" after 42], "2.68 ms" ["2.62 ms", "2.82 ms" after 180];
    "4_incompressible" "[4, 4, 4]" NEARLY_INCOMPRESSIBLE: "0.70 ms" ["0.682 ms", "0.731 ms" after 50], "1.35 ms" ["1.32 ms", "1.42 ms" after 300];
};

pub(super) const CASES: &[Case] = &[
    TWINS,
    Case {
        id: "newton_cotes_diverges",
        what: "energy of the cube's motion after 0.4 s by the method of Newton and Cotes at modified Euler's step of 1.25 ms, over the most that it has by that: a thousandfold",
        settings: &[CAUCHY, ELEMENTS, r#"systems.main.stepper="newton_cotes""#, "expect=[]"],
        reading: Reading::last("kinetic").after(40),
        reference: 1000.0 * 0.0278,
        tolerance: Tolerance::Above,
        // the highest frequency of 356 rad/s grows by exp(ω² h t / 4) in amplitude, ten-millionfold in 0.4 s
        source: "specification, V-34: diverges at the step used for modified Euler; 0.0278 J of that within 6 s",
        mutation: r#"systems.main.stepper="symplectic_euler""#,
        ..TWINS
    },
    Case {
        id: "semi_implicit_2_twice",
        capabilities: &["DEB-36"],
        what: "how far the edge of the cube swings in 1000 semi-implicit steps of twice the limit of modified Euler, K_S(2)",
        settings: pushed!("[2, 2, 2]", SOFT, "true", "11.24 ms"),
        mutation: "systems.main.stepper.semi_implicit=false",
        ..LIMIT
    },
    Case {
        id: "semi_implicit_4_twice",
        capabilities: &["DEB-36"],
        what: "the same, K_S(4)",
        settings: pushed!("[4, 4, 4]", SOFT, "true", "5.66 ms"),
        mutation: "systems.main.stepper.semi_implicit=false",
        ..LIMIT
    },
];
