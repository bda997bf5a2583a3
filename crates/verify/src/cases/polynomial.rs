//! Bodies that move as one polynomial of where their matter rests (PA-20 of the survey).

use crate::{Case, Limit, Reading, Refinement, Tolerance, Variant};

/// A bar in pure bending, which a quadratic polynomial has exactly.
const BENT: Case = Case {
    id: "",
    capabilities: &["JIM-97"],
    what: "",
    scene: "polynomial_bending",
    settings: &[],
    reading: Reading::component("tip", 1),
    refinement: None,
    reference: f64::NAN,
    // solves to 1e-12, and springs that hold points where nothing pulls
    tolerance: Tolerance::Relative(1e-8),
    source: "Timoshenko & Goodier, §102: u = kappa (-x y, (x^2 + nu (y^2 - z^2))/2, nu y z)",
    mutation: "bodies.bar.polynomial.degree=1",
};

/// What is free has no equilibrium to find.
const INERTIA: &str = r#"systems.main.stepper="verlet""#;

/// The same bar, free, without Poisson's ratio.
const FREE: Case = Case {
    settings: &[INERTIA, "bodies.bar.pins=[]", "bodies.bar.loads=[]", "bodies.bar.material.poissons_ratio=0"],
    reading: Reading::FreeFrequency(7),
    mutation: r#"bodies.bar.material.youngs_modulus="8 MPa""#,
    ..BENT
};

/// `√(12 E/ρ)/(2π L)` [Hz].
const STRETCH: f64 = 55.132_889_542_179_21;

/// A free bar that tumbles.
const TUMBLING: Case = Case {
    scene: "polynomial_spinning",
    settings: &[],
    reading: Reading::component("spin", 2),
    reference: 6.0 * INERTIA_ACROSS,
    // sums of 1000 steps
    tolerance: Tolerance::Relative(1e-10),
    source: "m/12 (a² + b²) of a cuboid; symplectic steps keep it in a linear space",
    mutation: "bodies.bar.damping={ rayleigh_mass = 1e-4 }",
    ..BENT
};

const INERTIA_ACROSS: f64 = 5.0 / 12.0 * (0.25 + 0.01);
const ENERGY: f64 = 0.5 * 5.0 * 0.01 + 0.5 * INERTIA_ACROSS * (0.25 + 36.0);

pub(super) const CASES: &[Case] = &[
    Case {
        id: "polynomial_bent_along",
        what: "end of a bar of thirty numbers in pure bending, 0.5 m from the middle",
        // κ x²/2
        reference: 0.1 * 0.25 / 2.0,
        ..BENT
    },
    Case {
        id: "polynomial_bent_across",
        what: "corner of its middle: the saddle that its sides bend into",
        reading: Reading::component("side", 2),
        // ν κ y z
        reference: 0.3 * 0.1 * 0.05 * 0.05,
        ..BENT
    },
    Case {
        id: "polynomial_bent_energy",
        what: "energy that it stores",
        reading: Reading::last("energy"),
        // E I κ²/2 over 1 m
        reference: 0.5 * 1e7 * 1e-4 / 12.0 * 0.01,
        ..BENT
    },
    Case {
        id: "polynomial_frequency",
        what: "first bending of the free bar in thirty numbers",
        // Ritz with w = a (x² - L²/12) and a turn b x of sections: two numbers, of a 2 x 2 matrix. What y² of the section adds to that is of
        // (h/L)⁴
        reference: 11.923_226_16,
        tolerance: Tolerance::Relative(1e-3),
        source: "Rayleigh and Ritz in the same quadratic fields, by hand",
        ..FREE
    },
    Case {
        id: "polynomial_frequency_above",
        what: "it lies above the bar's own, as that of every part of a space",
        // β² = 22.3733, without shear and the inertia of turns, which lower it
        reference: 10.279_2,
        tolerance: Tolerance::Above,
        source: "Euler and Bernoulli, an upper bound of what Timoshenko's beam has",
        mutation: r#"bodies.bar.material.youngs_modulus="5 MPa""#,
        ..FREE
    },
    Case {
        id: "polynomial_frequency_nearer",
        what: "and nearer than the lowest of an affine one, a stretch, for that cannot bend",
        reference: STRETCH,
        tolerance: Tolerance::AtMost,
        source: "Ritz with u = a x: omega^2 = 12 E / (rho L^2)",
        mutation: r#"bodies.bar.material.youngs_modulus="1 GPa""#,
        ..FREE
    },
    Case {
        id: "polynomial_affine_frequency",
        what: "the lowest frequency of the bar in twelve numbers, a stretch",
        settings: &[
            INERTIA,
            "bodies.bar.pins=[]",
            "bodies.bar.loads=[]",
            "bodies.bar.material.poissons_ratio=0",
            "bodies.bar.polynomial.degree=1",
        ],
        reference: STRETCH,
        tolerance: Tolerance::Relative(1e-6),
        source: "Ritz with u = a x: omega^2 = 12 E / (rho L^2)",
        ..FREE
    },
    Case {
        id: "polynomial_spin_kept",
        what: "angular momentum of a free bar of thirty numbers after 1000 symplectic steps",
        ..TUMBLING
    },
    Case {
        id: "polynomial_momentum_kept",
        what: "its momentum",
        reading: Reading::component("momentum", 0),
        reference: 0.5,
        source: "5 kg at 0.1 m/s",
        ..TUMBLING
    },
    Case {
        id: "polynomial_energy_order",
        what: "order at which its energy drifts by Runge and Kutta's steps: forces that are not its gradient would leave a rest",
        settings: &[r#"systems.main.stepper="rk4""#, "run.duration=0.4"],
        reading: Reading::last("energy"),
        refinement: Some(Refinement {
            size_of: "step [s]",
            runs: &[
                Variant { size: 1e-3, settings: &[r#"world.period="1 ms""#] },
                Variant { size: 5e-4, settings: &[r#"world.period="0.5 ms""#] },
            ],
            limit: Limit::Known(ENERGY),
        }),
        // as of `frames_energy_order`
        reference: 5.0,
        tolerance: Tolerance::Absolute(0.5),
        source: "Hairer, Nørsett & Wanner 1993, II",
        mutation: "bodies.bar.damping={ rayleigh_mass = 1e-3 }",
        ..TUMBLING
    },
];
