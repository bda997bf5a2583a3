//! The order of every stepper in time, on a linear oscillator and on a spinning, breathing cube.
//!
//! `error = C hᵖ (1 + c hᑫ)`: the order measured between two steps is off by about `c hᑫ / ln 2 (1 - 2^-q)`, which falls by `2^q`
//! from one pair to the next. Tolerances are what that leaves: `q = 1` for Euler's methods, those of Runge and Kutta and the second
//! backward differentiation formula, which starts with a step of Euler's (`c h` is 3 % to 6 % at the finest steps), `q = 2` for
//! Verlet's and Newmark's (`c h²` below 1 %).
//!
//! The symplectic Euler method is Verlet's seen half a step late: positions are of second order where the motion starts
//! without acceleration, as it does in both scenes, and velocities of first.

use crate::{Case, Limit, Reading, Refinement, Tolerance, Variant};

const EXPLICIT_EULER: &str = r#"systems.main.stepper="explicit_euler""#;
const SYMPLECTIC_EULER: &str = r#"systems.main.stepper="symplectic_euler""#;
const NEWTON_COTES: &str = r#"systems.main.stepper="newton_cotes""#;
const VERLET: &str = r#"systems.main.stepper="verlet""#;
const RK2: &str = r#"systems.main.stepper="rk2""#;
const RK4: &str = r#"systems.main.stepper="rk4""#;
const BACKWARD_EULER: &str =
    r#"systems.main.stepper={ name = "backward_euler", newton_tolerance = 1e-12, solver_tolerance = 1e-13 }"#;
const BDF2: &str =
    r#"systems.main.stepper={ name = "bdf2", newton_tolerance = 1e-12, solver_tolerance = 1e-13 }"#;
const NEWMARK: &str =
    r#"systems.main.stepper={ name = "newmark", newton_tolerance = 1e-12, solver_tolerance = 1e-13 }"#;

const STEPS_FROM_10_MS: &[Variant] = &[
    Variant { size: 10e-3, settings: &[r#"world.period="10 ms""#] },
    Variant { size: 5e-3, settings: &[r#"world.period="5 ms""#] },
    Variant { size: 2.5e-3, settings: &[r#"world.period="2.5 ms""#] },
];

const STEPS_FROM_4_MS: &[Variant] = &[
    Variant { size: 4e-3, settings: &[r#"world.period="4 ms""#] },
    Variant { size: 2e-3, settings: &[r#"world.period="2 ms""#] },
    Variant { size: 1e-3, settings: &[r#"world.period="1 ms""#] },
];

const STEPS_FROM_500_US: &[Variant] = &[
    Variant { size: 500e-6, settings: &[r#"world.period="500 us""#] },
    Variant { size: 250e-6, settings: &[r#"world.period="250 us""#] },
    Variant { size: 125e-6, settings: &[r#"world.period="125 us""#] },
];

const fn refined(runs: &'static [Variant], limit: f64) -> Option<Refinement> {
    Some(Refinement { size_of: "step [s]", runs, limit: Limit::Known(limit) })
}

// 0.5 / (2 pi) sin(2.4 pi) and 0.5 cos(2.4 pi)
const BLOCK_PLACE: f64 = 0.075_682_672_864_065_71;
const BLOCK_SPEED: f64 = 0.154_508_497_187_473_73;

// by rk4 at 62.5 us, which differs from 125 us in the thirteenth digit
const CUBE_PLACE: f64 = 0.090_640_645_170_5;
const CUBE_SPEED: f64 = -0.161_482_803_994_7;

const BLOCK: Case = Case {
    id: "",
    capabilities: &["FAU-39", "DEB-34"],
    what: "",
    scene: "block_on_springs",
    settings: &[],
    reading: Reading::component("place", 0),
    refinement: refined(STEPS_FROM_10_MS, BLOCK_PLACE),
    reference: 1.0,
    tolerance: Tolerance::Absolute(0.06),
    source: "Hairer, Nørsett & Wanner 1993, II; v/w sin w t",
    // of another start: what is left of the error does not fall
    mutation: "bodies.block.velocity=[0.51, 0, 0]",
};

const CUBE: Case = Case {
    scene: "spinning_cube",
    reading: Reading::component("corner", 0),
    refinement: refined(STEPS_FROM_500_US, CUBE_PLACE),
    source: "Hairer, Nørsett & Wanner 1993, II; rk4 at 62.5 us",
    mutation: "bodies.cube.angular_velocity=[3, 4, 5.1]",
    ..BLOCK
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "order_block_explicit_euler",
        what: "order of explicit Euler, block on springs",
        settings: &[EXPLICIT_EULER],
        ..BLOCK
    },
    Case {
        id: "order_block_newton_cotes",
        capabilities: &["DEB-34"],
        what: "order of Newton and Cotes, block on springs",
        settings: &[NEWTON_COTES],
        ..BLOCK
    },
    Case {
        id: "order_block_symplectic_euler",
        what: "order of symplectic Euler, block on springs, speed",
        settings: &[SYMPLECTIC_EULER],
        reading: Reading::component("speed", 0),
        refinement: refined(STEPS_FROM_10_MS, BLOCK_SPEED),
        ..BLOCK
    },
    Case {
        id: "order_block_verlet",
        what: "order of Verlet, block on springs",
        settings: &[VERLET],
        reference: 2.0,
        tolerance: Tolerance::Absolute(0.01),
        ..BLOCK
    },
    Case {
        id: "order_block_rk2",
        capabilities: &["DEB-34"],
        what: "order of Runge–Kutta 2, block on springs",
        settings: &[RK2],
        reference: 2.0,
        ..BLOCK
    },
    Case {
        id: "order_block_rk4",
        what: "order of Runge–Kutta 4, block on springs",
        settings: &[RK4],
        reference: 4.0,
        tolerance: Tolerance::Absolute(0.08),
        ..BLOCK
    },
    Case {
        id: "order_block_backward_euler",
        capabilities: &["FAU-40"],
        what: "order of backward Euler, block on springs",
        settings: &[BACKWARD_EULER],
        ..BLOCK
    },
    Case {
        id: "order_block_bdf2",
        capabilities: &["DEB-35"],
        what: "order of the second backward differentiation formula, block on springs",
        settings: &[BDF2],
        reference: 2.0,
        ..BLOCK
    },
    Case {
        id: "order_block_newmark",
        capabilities: &["DEB-35"],
        what: "order of Newmark's method, block on springs",
        settings: &[NEWMARK],
        reference: 2.0,
        tolerance: Tolerance::Absolute(0.01),
        ..BLOCK
    },
    Case {
        id: "order_cube_explicit_euler",
        what: "order of explicit Euler, spinning cube",
        settings: &[EXPLICIT_EULER],
        ..CUBE
    },
    Case {
        id: "order_cube_symplectic_euler",
        what: "order of symplectic Euler, spinning cube, speed",
        settings: &[SYMPLECTIC_EULER],
        reading: Reading::component("corner_speed", 0),
        refinement: refined(STEPS_FROM_500_US, CUBE_SPEED),
        ..CUBE
    },
    Case {
        id: "order_cube_verlet",
        what: "order of Verlet, spinning cube",
        settings: &[VERLET],
        refinement: refined(STEPS_FROM_4_MS, CUBE_PLACE),
        reference: 2.0,
        tolerance: Tolerance::Absolute(0.02),
        ..CUBE
    },
    Case {
        id: "order_cube_rk2",
        capabilities: &["DEB-34"],
        what: "order of Runge–Kutta 2, spinning cube",
        settings: &[RK2],
        reference: 2.0,
        ..CUBE
    },
    Case {
        id: "order_cube_rk4",
        what: "order of Runge–Kutta 4, spinning cube",
        settings: &[RK4],
        refinement: refined(STEPS_FROM_4_MS, CUBE_PLACE),
        reference: 4.0,
        tolerance: Tolerance::Absolute(0.05),
        ..CUBE
    },
    Case {
        id: "order_cube_backward_euler",
        capabilities: &["FAU-40", "DEB-35"],
        what: "order of backward Euler, spinning cube",
        settings: &[BACKWARD_EULER],
        ..CUBE
    },
    Case {
        id: "order_cube_bdf2",
        capabilities: &["DEB-35"],
        what: "order of the second backward differentiation formula, spinning cube",
        settings: &[BDF2],
        refinement: refined(STEPS_FROM_4_MS, CUBE_PLACE),
        reference: 2.0,
        ..CUBE
    },
    Case {
        id: "order_cube_newmark",
        capabilities: &["DEB-35"],
        what: "order of Newmark's method, spinning cube",
        settings: &[NEWMARK],
        refinement: refined(STEPS_FROM_4_MS, CUBE_PLACE),
        reference: 2.0,
        tolerance: Tolerance::Absolute(0.02),
        ..CUBE
    },
];
