//! Energy as theory has it: what each stepper makes, keeps or takes.
//!
//! On an oscillator of frequency `ω` every stepper is a matrix, and what it does to the energy `E` in a step of `z = ω h` is
//! known in closed form:
//!
//! | stepper | energy |
//! |---|---|
//! | explicit Euler | `E (1 + z²)` a step |
//! | symplectic Euler | swings by `E₀ z / (1 - z²/4)` where it starts with nothing but speed, for ever |
//! | Verlet | swings by `E₀ z²/4` from the same start, for ever |
//! | Runge–Kutta 2 | `E (1 + z⁴/4)` a step |
//! | Runge–Kutta 4 | `E (1 - z⁶/72 + z⁸/576)` a step |
//! | backward Euler | `E / (1 + z²)` a step |
//! | second backward differentiation formula | `E₀ \|w_n\|²`, `(3 + 2 i z) w_n = 4 w_(n-1) - w_(n-2)`, `w₀ = 1`, `w₁ = 1/(1 + i z)` |
//! | Newmark | `E₀`, for ever; with `γ > ½` the powers of its matrix |

use std::f64::consts::TAU;

use crate::{Case, Limit, Reading, Refinement, Statistic, Tolerance, Variant};

const EXPLICIT_EULER: &str = r#"systems.main.stepper="explicit_euler""#;
const SYMPLECTIC_EULER: &str = r#"systems.main.stepper="symplectic_euler""#;
const NEWTON_COTES: &str = r#"systems.main.stepper="newton_cotes""#;
const RK2: &str = r#"systems.main.stepper="rk2""#;
const RK4: &str = r#"systems.main.stepper="rk4""#;
const BACKWARD_EULER: &str =
    r#"systems.main.stepper={ name = "backward_euler", newton_tolerance = 1e-12, solver_tolerance = 1e-13 }"#;
const BDF2: &str =
    r#"systems.main.stepper={ name = "bdf2", newton_tolerance = 1e-12, solver_tolerance = 1e-13 }"#;
const NEWMARK: &str =
    r#"systems.main.stepper={ name = "newmark", newton_tolerance = 1e-12, solver_tolerance = 1e-13 }"#;
const NEWMARK_THAT_DISSIPATES: &str = r#"systems.main.stepper={ name = "newmark", gamma = 0.6, beta = 0.3025, newton_tolerance = 1e-12, solver_tolerance = 1e-13 }"#;

/// Energy of the block at the start [J].
const START: f64 = 0.125;

/// `(ω h)²` of the block for a step [s].
const fn z2(timestep: f64) -> f64 {
    TAU * TAU * timestep * timestep
}

const fn power(base: f64, exponent: u32) -> f64 {
    let (mut product, mut factors) = (1.0, 0);
    while factors < exponent {
        product *= base;
        factors += 1;
    }
    product
}

const BLOCK: Case = Case {
    id: "",
    capabilities: &["FAU-39"],
    what: "",
    scene: "block_on_springs",
    settings: &[],
    reading: Reading::last("energy").after(100),
    refinement: None,
    reference: f64::NAN,
    tolerance: Tolerance::Relative(1e-12),
    source: "amplification matrix of the oscillator; Hairer, Lubich & Wanner 2006, I.1",
    mutation: "bodies.block.springs[0].stiffness=39.4",
};

// 1000 oscillations; a step ends within z/2 of the extreme, where the energy is within (z/2)² of it, over many
// oscillations much closer
const SWING: Reading = Reading::last("energy").taking(Statistic::Span).after(100_000);

const CUBE_SWING: Case = Case {
    scene: "spinning_cube",
    reading: Reading::last("energy").taking(Statistic::Span),
    refinement: Some(Refinement {
        size_of: "step [s]",
        runs: &[
            Variant { size: 4e-3, settings: &[r#"world.period="4 ms""#] },
            Variant { size: 2e-3, settings: &[r#"world.period="2 ms""#] },
            Variant { size: 1e-3, settings: &[r#"world.period="1 ms""#] },
        ],
        limit: Limit::Known(0.0),
    }),
    tolerance: Tolerance::Absolute(0.02),
    source: "Hairer, Lubich & Wanner 2006, IX.8: energy of symplectic methods to the order of the method",
    ..BLOCK
};

/// `x' = 2 x - x₋₁ - z² x` from 0 and with `h v₀` a step before, 120 times.
const PLACE: Case = Case {
    reading: Reading::component("place", 0),
    reference: 0.075_750_517_514_506_37,
    // 120 steps, each with rounding of 8 cm, and of four terms
    tolerance: Tolerance::Relative(1e-12),
    source: "V-34: modified Euler and Störmer are one recurrence, here in forty digits",
    ..BLOCK
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "energy_explicit_euler",
        what: "energy of the block after 100 steps of 10 ms: grown",
        settings: &[EXPLICIT_EULER],
        reference: START * power(1.0 + z2(0.01), 100),
        ..BLOCK
    },
    Case {
        id: "energy_backward_euler",
        capabilities: &["FAU-40"],
        what: "energy of the block after 100 steps of 10 ms: dissipated",
        settings: &[BACKWARD_EULER],
        reference: START / power(1.0 + z2(0.01), 100),
        // Newton's method stops at 1e-12 of the force, 100 times
        tolerance: Tolerance::Relative(1e-10),
        ..BLOCK
    },
    Case {
        id: "energy_bdf2",
        capabilities: &["DEB-35"],
        what: "energy of the block after 100 steps of 50 ms under the second backward differentiation formula: dissipated",
        settings: &[BDF2, r#"world.period="50 ms""#],
        // the recursion above
        reference: START * 0.596_071_663_767_725,
        tolerance: Tolerance::Relative(1e-10),
        ..BLOCK
    },
    Case {
        id: "energy_newmark_swing",
        capabilities: &["DEB-35"],
        what: "swing of the energy under Newmark over 20 oscillations: none",
        settings: &[NEWMARK],
        reading: Reading::last("energy").taking(Statistic::Span).after(2_000),
        reference: 0.0,
        // Newton's method leaves 1e-12 of the force, which does as much of the energy's work in a step at most, to and fro
        tolerance: Tolerance::Absolute(1e-12),
        source: "Newmark 1959; Hughes 2000, §9.1: the trapezoidal rule keeps quadratic invariants",
        mutation: "systems.main.stepper.beta=0.3",
        ..BLOCK
    },
    Case {
        id: "energy_newmark_dissipates",
        capabilities: &["DEB-35"],
        what: "energy of the block after 100 steps of 50 ms under Newmark with gamma = 0.6: dissipated",
        settings: &[NEWMARK_THAT_DISSIPATES, r#"world.period="50 ms""#],
        // powers of the matrix of (q, v, a)
        reference: 0.048_095_516_170_437_11,
        tolerance: Tolerance::Relative(1e-10),
        ..BLOCK
    },
    Case {
        id: "energy_newton_cotes",
        capabilities: &["DEB-34"],
        what: "energy of the block after 100 steps of 8 ms under Newton and Cotes: grown, where modified Euler keeps it",
        settings: &[NEWTON_COTES, r#"world.period="8 ms""#],
        // powers of the matrix of (q, v)
        reference: 0.140_818_030_731_289_5,
        tolerance: Tolerance::Relative(1e-10),
        source: "V-34; v' = v - h k q, q' = q + h v - h² k/2 q",
        mutation: r#"systems.main.stepper="symplectic_euler""#,
        ..BLOCK
    },
    Case {
        id: "energy_rk2",
        capabilities: &["DEB-34"],
        what: "energy of the block after 100 steps of 8 ms: slowly grown",
        settings: &[RK2, r#"world.period="8 ms""#],
        reference: START * power(1.0 + power(z2(0.008), 2) / 4.0, 100),
        ..BLOCK
    },
    Case {
        id: "energy_rk4",
        what: "energy of the block after 100 steps of 50 ms: hardly dissipated",
        settings: &[RK4, r#"world.period="50 ms""#],
        reference: START * power(1.0 - power(z2(0.05), 3) / 72.0 + power(z2(0.05), 4) / 576.0, 100),
        ..BLOCK
    },
    Case {
        id: "order_energy_rk4",
        what: "order of the energy that Runge–Kutta 4 loses to the block",
        settings: &[RK4],
        reading: Reading::last("energy"),
        refinement: Some(Refinement {
            size_of: "step [s]",
            runs: &[
                Variant { size: 50e-3, settings: &[r#"world.period="50 ms""#] },
                Variant { size: 25e-3, settings: &[r#"world.period="25 ms""#] },
                Variant { size: 12.5e-3, settings: &[r#"world.period="12.5 ms""#] },
            ],
            limit: Limit::Known(START),
        }),
        reference: 5.0,
        // z⁸/576 is z²/8 = 0.003 of z⁶/72 at 25 ms
        tolerance: Tolerance::Absolute(0.01),
        mutation: "bodies.block.velocity=[0.5001, 0, 0]",
        ..BLOCK
    },
    Case {
        id: "energy_verlet_swing",
        what: "swing of the energy under Verlet over 1000 oscillations: no drift",
        reading: SWING,
        reference: START * z2(0.01) / 4.0,
        tolerance: Tolerance::Relative(1e-4),
        ..BLOCK
    },
    Case {
        id: "energy_symplectic_euler_swing",
        what: "swing of the energy under symplectic Euler over 1000 oscillations: no drift",
        settings: &[SYMPLECTIC_EULER],
        reading: SWING,
        reference: START * TAU * 0.01 / (1.0 - z2(0.01) / 4.0),
        tolerance: Tolerance::Relative(1e-4),
        ..BLOCK
    },
    Case {
        id: "order_energy_verlet",
        what: "order of the energy's swing under Verlet, spinning cube",
        reference: 2.0,
        // as for Verlet's positions
        mutation: r#"systems.main.stepper="symplectic_euler""#,
        ..CUBE_SWING
    },
    Case {
        id: "order_energy_symplectic_euler",
        what: "order of the energy's swing under symplectic Euler, spinning cube",
        settings: &[SYMPLECTIC_EULER],
        reference: 1.0,
        mutation: r#"systems.main.stepper="verlet""#,
        ..CUBE_SWING
    },
    Case {
        id: "energy_cube_verlet_swing",
        what: "swing of the energy under Verlet over 200 s of spin: what it is over 2 s, to a part",
        reading: Reading::last("energy").taking(Statistic::Span).after(100_000),
        refinement: None,
        reference: 1.606_287_288_6e-4,
        tolerance: Tolerance::Relative(0.5),
        source: "the swing over the first 2 s; a drift of 1e-9 of the energy a step would be 1200 times that",
        mutation: r#"systems.main.stepper="symplectic_euler""#,
        ..CUBE_SWING
    },
    Case {
        id: "energy_cube_backward_euler",
        capabilities: &["FAU-40"],
        what: "greatest energy of the spinning cube under backward Euler: that of the start",
        settings: &[BACKWARD_EULER],
        reading: Reading::last("energy").taking(Statistic::Max),
        refinement: None,
        reference: 2.0,
        tolerance: Tolerance::Relative(1e-12),
        source: "Hairer & Wanner 1996, IV.3: B-stability; the start is at rest shape",
        mutation: r#"systems.main.stepper="explicit_euler""#,
        ..CUBE_SWING
    },
    Case {
        id: "spin_verlet",
        what: "swing of the angular momentum under Verlet over 200 s of spin: rounding",
        reading: Reading::component("spin", 0).taking(Statistic::Span).after(100_000),
        refinement: None,
        reference: 0.0,
        // 100 000 steps of 27 points, each with rounding of 0.4 kg m²/s / 27 that adds up as a walk: √(1e5 x 27) ε 0.4 / 27
        tolerance: Tolerance::Absolute(1e-13),
        source: "Hairer, Lubich & Wanner 2006, IV.1: quadratic invariants of symplectic methods",
        mutation: r#"systems.main.stepper="rk4""#,
        ..CUBE_SWING
    },
    Case {
        id: "place_modified_euler",
        capabilities: &["DEB-34"],
        what: "place of the block after 120 steps of modified Euler",
        settings: &[SYMPLECTIC_EULER],
        ..PLACE
    },
    Case {
        id: "place_stoermer",
        capabilities: &["DEB-34"],
        what: "the same by Störmer's two places: the same to rounding",
        settings: &[r#"systems.main.stepper="t_simulation""#],
        ..PLACE
    },
];
