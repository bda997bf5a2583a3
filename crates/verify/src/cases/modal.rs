//! Bodies that move as a sum of their natural modes (PA-19 of the survey).

use super::bar::{LINEAR, N3, N6};
use crate::{Case, Limit, Reading, Refinement, Tolerance, Variant};

const SURVEY: &[&str] = &["JIM-97"];

/// The reference bar in some of its modes, which have the frequencies that it has as a whole.
const FREQUENCY: Case = Case {
    id: "",
    capabilities: SURVEY,
    what: "",
    scene: "cantilever",
    settings: &[N3, LINEAR, "bodies.bar.modes.count=3"],
    reading: Reading::NaturalFrequency(1),
    refinement: None,
    reference: f64::NAN,
    tolerance: Tolerance::Relative(1e-8),
    source: "FEniCSx, 8 digits trusted, of the bar with all its points",
    // 5e-5 of a frequency
    mutation: r#"bodies.bar.material.youngs_modulus="10.001 MPa""#,
};

/// Deflection of the tip of the slender beam, `F L³ / 3EI` [m].
const TIP: f64 = 3.125e-3;

/// `Σ 12/β⁴` of the first modes of bending of a clamped beam, `β` = 1.875104, 4.694091, 7.854757: what they bear of a force on its tip.
const SHARES: [f64; 3] = [0.970_688_2, 0.995_404_0, 0.998_556_4];

const DEFLECTION: Case = Case {
    scene: "modal_cantilever",
    settings: &[],
    reading: Reading::component("tip", 1),
    // shear adds 0.6 h²/L² = 0.1 %; a third pair of modes gives 0.3 % of the tip, a second 2.5 %
    tolerance: Tolerance::Relative(1.5e-3),
    source: "Euler and Bernoulli: mode n bears 12/beta_n^4 of the deflection by a force on the tip",
    // 0.5 % of it
    mutation: r#"bodies.beam.material.youngs_modulus="10.05 MPa""#,
    ..FREQUENCY
};

/// A free beam that tumbles in its modes.
const TUMBLING: Case = Case {
    scene: "modal_spinning",
    settings: &[],
    reading: Reading::component("momentum", 0),
    reference: 0.5,
    // sums of 1000 steps
    tolerance: Tolerance::Relative(1e-10),
    source: "5 kg at 0.1 m/s",
    mutation: "bodies.beam.damping={ rayleigh_mass = 1e-4 }",
    ..FREQUENCY
};

/// What the beam has at its start: of a cuboid of 5 kg that turns with (0, 0.5, 6) /s.
const INERTIA_ACROSS: f64 = 5.0 / 12.0 * (0.25 + 0.01);
const ENERGY: f64 = 0.5 * 5.0 * 0.01 + 0.5 * INERTIA_ACROSS * (0.25 + 36.0);

const HALVED: &[Variant] = &[
    Variant { size: 2e-3, settings: &[r#"world.period="2 ms""#] },
    Variant { size: 1e-3, settings: &[r#"world.period="1 ms""#] },
];

/// Energy that the first mode of stretch of a spinning bar stores: `2/15 A ρ² ω⁴ R⁵ / E`, of which the first mode has `960/π⁶`.
const STRETCHED: f64 = 2.0 / 15.0 * 0.01 * 1e6 * 1296.0 * 9.765_625e-4 / 5e6 * 0.998_555;

const THIRTY_TWO: &str = "bodies.beam.mesh.cells=[32, 1, 1]";

/// The slender beam in modes within polynomials.
const RITZ: Case = Case {
    scene: "modal_cantilever",
    reading: Reading::NaturalFrequency(1),
    // hexahedra of 1/32 of the length have cubics to the fourth order: 1.3e-5 (1.8e-4 with 1/16, 8e-7 with 1/64)
    tolerance: Tolerance::Relative(2e-5),
    source: "Ritz's method for Timoshenko's beam: deflections of this degree, turns of the one below, shear factor 1",
    // 5e-4 of a frequency
    mutation: r#"bodies.beam.material.youngs_modulus="10.01 MPa""#,
    ..FREQUENCY
};

/// A free bar whose one number of the whole swings at 1 Hz, far above its first mode: `(2π)² ρ L² / 12` [Pa].
const GLOBAL: Case = Case {
    scene: "modal_spinning",
    reading: Reading::FreeFrequency(1),
    reference: 1.0,
    // x, xy and xz are fields of regular hexahedra; digits of the modulus
    tolerance: Tolerance::Relative(1e-8),
    source: "Rayleigh's quotient of the field (x, 0, 0): omega^2 = 12 k E / (rho L^2)",
    // 5e-5 of a frequency
    mutation: "bodies.beam.material.density=1000.1",
    ..FREQUENCY
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "modal_frequency_n3_1",
        what: "first natural frequency of the clamped bar in three of its modes, tet4, n = 3",
        reference: 1.844_810_051_345_729_7,
        ..FREQUENCY
    },
    Case {
        id: "modal_frequency_n3_2",
        what: "second, n = 3",
        reading: Reading::NaturalFrequency(2),
        reference: 2.052_718_638_365_083,
        ..FREQUENCY
    },
    Case {
        id: "modal_frequency_n6_3",
        what: "third, n = 6",
        settings: &[N6, LINEAR, "bodies.bar.modes.count=3"],
        reading: Reading::NaturalFrequency(3),
        reference: 10.037_517_809_785_989,
        ..FREQUENCY
    },
    Case {
        id: "modal_tip_1",
        what: "tip of a slender beam under a force there, in its first pair of modes",
        settings: &["bodies.beam.modes.count=2"],
        reference: TIP * SHARES[0],
        ..DEFLECTION
    },
    Case {
        id: "modal_tip_2",
        what: "in two pairs",
        settings: &["bodies.beam.modes.count=4"],
        reference: TIP * SHARES[1],
        ..DEFLECTION
    },
    Case { id: "modal_tip_3", what: "in three pairs", reference: TIP * SHARES[2], ..DEFLECTION },
    Case {
        id: "modal_reaction",
        what: "what the clamp does to the beam in its modes: it bears the force on the tip",
        reading: Reading::component("clamp", 1),
        reference: -0.02,
        tolerance: Tolerance::Relative(1e-9),
        source: "equilibrium",
        mutation: "bodies.beam.loads=[{ region = \"x_max\", force = [0, 0.0201, 0] }]",
        ..DEFLECTION
    },
    Case {
        id: "modal_momentum_kept",
        what: "momentum of a free beam that tumbles in its modes, after 1000 steps of Runge and Kutta's",
        ..TUMBLING
    },
    Case {
        id: "modal_spin_order",
        what: "order at which its angular momentum about z drifts",
        reading: Reading::component("spin", 2),
        refinement: Some(Refinement {
            size_of: "step [s]",
            runs: HALVED,
            limit: Limit::Known(6.0 * INERTIA_ACROSS),
        }),
        reference: 2.0,
        tolerance: Tolerance::AtLeast,
        source: "rotations by increments from the start of a step are of the second order in rk4 (docs/theory.md)",
        // a torque from outside
        mutation: "bodies.beam.damping={ rayleigh_mass = 1e-3 }",
        ..TUMBLING
    },
    Case {
        id: "modal_energy_order",
        what: "order at which its energy drifts: frame and modes do no work but on each other",
        reading: Reading::last("energy"),
        refinement: Some(Refinement { size_of: "step [s]", runs: HALVED, limit: Limit::Known(ENERGY) }),
        reference: 2.0,
        tolerance: Tolerance::AtLeast,
        source: "rotations by increments from the start of a step are of the second order in rk4 (docs/theory.md)",
        mutation: "bodies.beam.damping={ rayleigh_mass = 1e-3 }",
        ..TUMBLING
    },
    Case {
        id: "modal_stretch_of_spin",
        what: "energy stored by a beam that spins about z, its modes damped until it rests in its frame",
        settings: &[
            "bodies.beam.angular_velocity=[0, 0, 6]",
            "bodies.beam.material.poissons_ratio=0",
            r#"bodies.beam.material.youngs_modulus="5 MPa""#,
            "bodies.beam.modes={ count = 8, damping_ratio = 1 }",
            "run.duration=0.5",
        ],
        reading: Reading::last("stored"),
        reference: STRETCHED,
        // across, where it spins too, (h/L)⁵ of it: 0.03 %; it grows by 1.5e-4 and turns so much slower: 0.1 %; hexahedra of a tenth of the
        // length 0.4 %; the end of a bar as thick as a fifth of its length bulges with (h/L)² of it
        tolerance: Tolerance::Relative(0.02),
        source: "a bar under its own centrifugal force: sigma = rho omega^2 (R^2 - x^2)/2",
        // ω⁴
        mutation: "bodies.beam.angular_velocity=[0, 0, 6.06]",
        ..TUMBLING
    },
    Case {
        id: "modal_ritz_2",
        what: "first natural frequency of a slender beam within polynomials of the second degree",
        settings: &[THIRTY_TWO, "bodies.beam.modes={ count = 2, degree = 2 }"],
        reference: 0.820_743_05,
        ..RITZ
    },
    Case {
        id: "modal_ritz_3",
        what: "of the third",
        settings: &[THIRTY_TWO, "bodies.beam.modes={ count = 2, degree = 3 }"],
        reference: 0.648_621_89,
        ..RITZ
    },
    Case {
        id: "modal_ritz_4",
        what: "of the fourth",
        settings: &[THIRTY_TWO, "bodies.beam.modes={ count = 2, degree = 4 }"],
        reference: 0.645_755_02,
        ..RITZ
    },
    Case {
        id: "global_stretch",
        what: "frequency at which a bar is stretched as a whole, beside one mode",
        settings: &[
            "bodies.beam.material.poissons_ratio=0",
            "bodies.beam.material.youngs_modulus=822.4670334241132",
            "bodies.beam.modes={ count = 1, global = [\"stretch_x\"] }",
        ],
        ..GLOBAL
    },
    Case {
        id: "global_stretch_softened",
        what: "of a matter four times as soft, with four times its stiffness as a whole",
        settings: &[
            "bodies.beam.material.poissons_ratio=0",
            "bodies.beam.material.youngs_modulus=205.6167583560283",
            "bodies.beam.modes={ count = 1, global = [\"stretch_x\"], global_stiffness = 4 }",
        ],
        ..GLOBAL
    },
    Case {
        id: "global_twist",
        what: "at which it is twisted as a whole",
        settings: &[
            "bodies.beam.material.poissons_ratio=0",
            "bodies.beam.material.youngs_modulus=1644.9340668482264",
            "bodies.beam.modes={ count = 1, global = [\"twist_x\"] }",
        ],
        source: "Rayleigh's quotient of the field x e_x × s, sections that stay plane: omega^2 = 12 G / (rho L^2)",
        ..GLOBAL
    },
    Case {
        id: "global_poisson",
        what: "at which a cube is squashed at constant volume, by stretches along all three axes",
        settings: &[
            r#"bodies.beam.mesh={ generate = "bar", size = [0.5, 0.5, 0.5], cells = [4, 4, 4], element = "hex8" }"#,
            "bodies.beam.material.poissons_ratio=0.25",
            "bodies.beam.material.youngs_modulus=1028.0837917801414",
            "bodies.beam.modes={ count = 1, global = [\"stretch_x\", \"stretch_y\", \"stretch_z\"] }",
        ],
        source: "Rayleigh's quotient of a x e_x + b y e_y + c z e_z with a + b + c = 0: omega^2 = 24 G / (rho L^2)",
        ..GLOBAL
    },
];
