//! Masses and links: the recurrence of a mass, oscillators step by step, momenta, and every law on the virtual rheometer.

use crate::{Case, Reading, Statistic, Tolerance};

const OSCILLATOR: Case = Case {
    id: "",
    capabilities: &["JIM-5"],
    what: "",
    scene: "network_oscillator",
    settings: &[],
    reading: Reading::component("place", 0).after(60),
    refinement: None,
    reference: f64::NAN,
    // rounding of sixty steps
    tolerance: Tolerance::Relative(1e-12),
    source: "q' = (2 - κ - ζ) q - (1 - ζ) q_before (Jimenez 1993, P2-I.3.2; specification §2.6)",
    mutation: "networks.oscillator.masses.bob.mass=1.0001",
};

const UNDAMPED: &str = "networks.oscillator.links[0].law.damping=0";

const PULL: Reading = Reading::component("pull", 0);

const PLASTIC: Case = Case {
    id: "",
    capabilities: &["JIM-50"],
    what: "",
    scene: "rheometer",
    reading: PULL.after(5),
    tolerance: Tolerance::Absolute(1e-9),
    source: "specification §8.1, elasto-plastic with hardening: places are decimals, rounding times k",
    mutation: "networks.sample.links[0].law.hardening=251",
    ..OSCILLATOR
};

const TE: &str = "world.period=0.0033333333333333335";

const MAXWELL: Case = Case {
    capabilities: &["JIM-52", "JIM-56"],
    settings: &[
        TE,
        r#"networks.sample.links[0].law={ name = "maxwell", stiffness = 1000, viscosity = 100 }"#,
        "networks.sample.pins[0].motion={ times = [0, 0.0033333333333333335], offsets = [[0, 0, 0], [-0.01, 0, 0]] }",
    ],
    tolerance: Tolerance::Relative(1e-12),
    source: "specification §8.1, Maxwell: a step of elongation, held",
    mutation: "networks.sample.links[0].law.viscosity=101",
    ..PLASTIC
};

const BINGHAM: Case = Case {
    capabilities: &["JIM-54", "JIM-56"],
    settings: &[
        TE,
        r#"networks.sample.links[0].law={ name = "bingham", stiffness = 1000, viscosity = 100, traction = 10, compression = 10 }"#,
        // 199 steps of 0.5 m/s, then held
        "networks.sample.pins[0].motion={ times = [0, 0.6633333333333333], offsets = [[0, 0, 0], [-0.33166666666666667, 0, 0]] }",
    ],
    tolerance: Tolerance::Relative(1e-11),
    source: "specification §8.1, Bingham: stretched at 0.5 m/s, then held",
    ..MAXWELL
};

const BURGER: Case = Case {
    capabilities: &["JIM-53", "JIM-56"],
    settings: &[
        TE,
        r#"networks.sample.links[0].law={ name = "burger", solid_stiffness = 1000, solid_viscosity = 50, fluid_stiffness = 2000, fluid_viscosity = 500 }"#,
        "networks.sample.pins[0].motion={ times = [0, 0.2], offsets = [[0, 0, 0], [-0.02, 0, 0]] }",
    ],
    // as many digits as are printed
    tolerance: Tolerance::Absolute(5e-9),
    source: "specification §8.1, Burger: stretched at 0.1 m/s to 0.02 m, then held",
    mutation: "networks.sample.links[0].law.solid_viscosity=51",
    ..MAXWELL
};

/// A law read at a length led to within one step.
const CURVE: Case = Case {
    capabilities: &["JIM-25"],
    reading: PULL.after(2),
    tolerance: Tolerance::Relative(1e-12),
    source: "specification §2.10",
    ..PLASTIC
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "network_free_fall",
        capabilities: &["JIM-4", "JIM-7"],
        what: "a free mass has fallen n (n + 1)/2 times g Te² after n = 200 steps",
        scene: "network_free_fall",
        reading: Reading::component("fall", 2).after(200),
        reference: -19.7181,
        source: "X_n - X_0 = G n (n + 1)/2 (specification §2.4)",
        mutation: "world.gravity=[0, 0, -9.811]",
        ..OSCILLATOR
    },
    Case {
        id: "network_drag",
        capabilities: &["JIM-7"],
        what: "speed of a mass falling through a medium after 200 steps",
        scene: "network_free_fall",
        reading: Reading::component("speed", 2).after(200),
        // -0.981 (1 - 0.9^200)
        reference: -0.980_999_999_307_826_8,
        source: "V' = (1 - z Te/m) V + g Te",
        mutation: "networks.rain.masses.braked.drag=20.1",
        ..OSCILLATOR
    },
    Case {
        id: "network_oscillator_undamped",
        capabilities: &["JIM-3", "JIM-4", "JIM-5"],
        what: "displacement of a mass on a spring, κ = 0.04, after 60 steps",
        settings: &[UNDAMPED],
        reference: -0.009_332_407_371_664_991,
        ..OSCILLATOR
    },
    Case {
        id: "network_oscillator_damped",
        capabilities: &["JIM-5", "JIM-49"],
        what: "the same with a damper beside the spring, ζ = 0.02",
        reference: -0.050_819_193_634_783_46,
        ..OSCILLATOR
    },
    Case {
        id: "network_stable",
        capabilities: &["JIM-94"],
        what: "displacement after 100 steps at κ = 1, ζ = 1.49, just below K + 2Z = 4M",
        settings: &[
            "networks.oscillator.links[0].law={ name = \"spring_damper\", stiffness = 100, damping = 14.9 }",
        ],
        reading: Reading::component("place", 0).after(100),
        reference: -0.091_279_440_534_536_52,
        ..OSCILLATOR
    },
    Case {
        id: "network_unstable",
        capabilities: &["JIM-94"],
        what: "the same at ζ = 1.51, just above, where it grows",
        settings: &[
            "networks.oscillator.links[0].law={ name = \"spring_damper\", stiffness = 100, damping = 15.1 }",
        ],
        reading: Reading::component("place", 0).after(100),
        reference: 0.024_432_544_470_258_888,
        ..OSCILLATOR
    },
    Case {
        id: "network_spin",
        capabilities: &["JIM-6"],
        what: "kinetic energy of two masses that turn, joined by a spring and damper, after 20 s",
        scene: "network_spin",
        reading: Reading::last("turning"),
        // 2 r (1 - cos θ) m = Te² k (2 r - 1), 2 m r² sin θ = L Te: v = 2 r sin(θ/2)/Te
        reference: 2.240_473_723_679_317_5,
        tolerance: Tolerance::Relative(1e-10),
        source: "steady turning in discrete time; a damper along the projected velocity would brake it",
        mutation: "networks.pair.links[0].law.stiffness=1990",
        ..OSCILLATOR
    },
    Case {
        id: "network_angular_momentum",
        capabilities: &["JIM-94", "JIM-6"],
        what: "angular momentum of the same, Σ M X ∧ X' over Te",
        scene: "network_spin",
        reading: Reading::component("spin", 2),
        reference: 1.5,
        // rounding of 2000 steps
        tolerance: Tolerance::Relative(1e-12),
        source: "axial forces keep Σ M X_n ∧ X_{n+1} (specification §2.5)",
        mutation: "networks.pair.angular_velocity=[0, 0, 3.01]",
        ..OSCILLATOR
    },
    Case {
        id: "network_momentum",
        capabilities: &["JIM-94", "JIM-5"],
        what: "momentum of a lattice of damped springs that swings, after a second",
        scene: "network_lattice",
        reading: Reading::component("momentum", 0),
        reference: -0.0968,
        tolerance: Tolerance::Absolute(1e-13),
        source: "F1 = -F2 (specification §2.5)",
        mutation: "networks.lattice.masses.lower.velocity=[0.81, 0, 0]",
        ..OSCILLATOR
    },
    Case {
        id: "rheometer_kelvin_voigt",
        capabilities: &["JIM-49", "JIM-56"],
        what: "a spring beside a damper pulled at 0.5 m/s: k q + z q'",
        settings: &[
            TE,
            r#"networks.sample.links[0].law={ name = "spring_damper", stiffness = 1000, damping = 100 }"#,
            "networks.sample.pins[0].motion={ times = [0, 1], offsets = [[0, 0, 0], [-0.5, 0, 0]] }",
        ],
        reading: PULL.after(100),
        reference: 216.666_666_666_666_67,
        tolerance: Tolerance::Relative(1e-11),
        source: "k 0.5 m/s 100 Te + z 0.5 m/s",
        mutation: "networks.sample.links[0].law.damping=101",
        ..PLASTIC
    },
    Case {
        id: "rheometer_plastic_hardened",
        what: "an elasto-plastic link pulled to 1.03 m",
        reference: 14.0,
        ..PLASTIC
    },
    Case {
        id: "rheometer_plastic_pushed",
        what: "the same unloaded and pushed to yield at 1 m",
        reading: PULL.after(10),
        reference: -11.2,
        ..PLASTIC
    },
    Case {
        id: "rheometer_plastic_pushed_far",
        what: "the same pushed to 0.98 m",
        reading: PULL.after(12),
        reference: -15.2,
        ..PLASTIC
    },
    Case {
        id: "rheometer_plastic_loop",
        capabilities: &["JIM-50", "JIM-18", "JIM-56"],
        what: "the same pulled again to 1.01 m: the loop remembers",
        reading: PULL.after(15),
        reference: 14.16,
        ..PLASTIC
    },
    Case {
        id: "rheometer_plastic_again",
        what: "the same pulled to 1.03 m at last",
        reading: PULL.after(16),
        reference: 18.16,
        ..PLASTIC
    },
    Case {
        id: "rheometer_perfect_plasticity",
        what: "the same without hardening: a plateau at the threshold",
        settings: &["networks.sample.links[0].law.hardening=0"],
        reference: 10.0,
        mutation: "networks.sample.links[0].law.traction=10.1",
        ..PLASTIC
    },
    Case {
        id: "rheometer_asymmetric",
        capabilities: &["JIM-58"],
        what: "the same with a compression threshold of 5 N, pushed to 1 m: f = A S2 + B q",
        settings: &["networks.sample.links[0].law.compression=5"],
        reading: PULL.after(10),
        // -4 - 0.2 x 6 = -5.2 at 1.010 m, whence S = 1.0152 m and S2 = -5.2 mm; then -0.8 x 5.2 - 0.2 x 15.2
        reference: -7.2,
        ..PLASTIC
    },
    Case {
        id: "rheometer_torn",
        capabilities: &["JIM-51"],
        what: "a link that tears at 13.5 N pulls no more at 1.03 m",
        settings: &["networks.sample.links[0].law.rupture=13.5"],
        reference: 0.0,
        mutation: "networks.sample.links[0].law.rupture=30",
        ..PLASTIC
    },
    Case {
        id: "rheometer_torn_pushes",
        capabilities: &["JIM-51"],
        what: "torn at 1.015 m, it still resists compression: -k (1 - 0.99) at 0.99 m",
        settings: &["networks.sample.links[0].law.rupture=13.5"],
        reading: PULL.after(11),
        reference: -10.0,
        mutation: "networks.sample.links[0].law.rupture=30",
        ..PLASTIC
    },
    Case {
        id: "rheometer_maxwell_struck",
        what: "Maxwell's link at the first step of a held elongation of 0.01 m",
        reading: PULL.after(1),
        reference: 9.677_419_354_838_719,
        ..MAXWELL
    },
    Case {
        id: "rheometer_maxwell_next",
        what: "the same a step later",
        reading: PULL.after(2),
        reference: 9.365_244_536_940_695,
        ..MAXWELL
    },
    Case {
        id: "rheometer_maxwell_relaxed",
        what: "the same thirty steps later: it has let go 1/B a step",
        reading: PULL.after(31),
        reference: 3.618_648_398_297_034_3,
        ..MAXWELL
    },
    Case {
        id: "rheometer_maxwell_flown",
        what: "the same sixty steps later",
        reading: PULL.after(61),
        reference: 1.353_110_343_818_093_8,
        ..MAXWELL
    },
    Case {
        id: "rheometer_bingham_10",
        what: "a paste after ten steps of stretching at 0.5 m/s",
        reading: PULL.after(10),
        reference: 16.146_097_381_651_256,
        ..BINGHAM
    },
    Case {
        id: "rheometer_bingham_60",
        what: "the same after sixty",
        reading: PULL.after(60),
        reference: 51.488_888_262_672_79,
        ..BINGHAM
    },
    Case {
        id: "rheometer_bingham_199",
        what: "the same after 199: it flows at nearly Qe + z v = 60 N",
        reading: PULL.after(199),
        reference: 59.910_758_830_055_06,
        ..BINGHAM
    },
    Case {
        id: "rheometer_bingham_held",
        what: "held for 200 steps it keeps nearly its threshold of 10 N",
        reading: PULL.after(399),
        reference: 10.070_811_916_714_876,
        ..BINGHAM
    },
    Case {
        id: "rheometer_bingham_is_maxwell",
        what: "without a threshold the paste is Maxwell's fluid",
        capabilities: &["JIM-54"],
        settings: &[
            TE,
            r#"networks.sample.links[0].law={ name = "bingham", stiffness = 1000, viscosity = 100, traction = 0, compression = 0 }"#,
            "networks.sample.pins[0].motion={ times = [0, 0.0033333333333333335], offsets = [[0, 0, 0], [-0.01, 0, 0]] }",
        ],
        reading: PULL.after(61),
        reference: 1.353_110_343_818_093_8,
        ..MAXWELL
    },
    Case {
        id: "rheometer_bingham_is_plastic",
        what: "without viscosity the paste is a perfectly plastic link",
        capabilities: &["JIM-54"],
        settings: &[
            r#"networks.sample.links[0].law={ name = "bingham", stiffness = 1000, viscosity = 0, traction = 10, compression = 10 }"#,
        ],
        reference: 10.0,
        mutation: "networks.sample.links[0].law.traction=10.1",
        ..PLASTIC
    },
    Case {
        id: "rheometer_burger_30",
        what: "Burger's link half way through a pull",
        reading: PULL.after(30),
        reference: 7.919_819_93,
        ..BURGER
    },
    Case {
        id: "rheometer_burger_60",
        what: "the same at its end",
        reading: PULL.after(60),
        reference: 12.955_157_33,
        ..BURGER
    },
    Case {
        id: "rheometer_burger_120",
        what: "the same held for sixty steps",
        reading: PULL.after(120),
        reference: 8.325_071_88,
        ..BURGER
    },
    Case {
        id: "rheometer_burger_599",
        what: "the same held for long",
        reading: PULL.after(599),
        reference: 1.091_081_5,
        tolerance: Tolerance::Absolute(5e-8),
        ..BURGER
    },
    Case {
        id: "cohesion_pull",
        what: "a cohesive pair 1.1 m apart pulls with k_a (S2 - S)",
        settings: &[
            r#"networks.sample.links[0].law={ name = "cohesion", hard = 0.95, distance = 1, peak = 1.1, range = 1.5, repulsion = 10000, cohesion = 1000 }"#,
            "networks.sample.pins[0].motion={ times = [0, 0.01], offsets = [[0, 0, 0], [-0.1, 0, 0]] }",
        ],
        reference: 100.0,
        mutation: "networks.sample.links[0].law.cohesion=1001",
        ..CURVE
    },
    Case {
        id: "cohesion_push",
        what: "the same pair 0.9 m apart pushes along its steep piece",
        settings: &[
            r#"networks.sample.links[0].law={ name = "cohesion", hard = 0.95, distance = 1, peak = 1.1, range = 1.5, repulsion = 10000, cohesion = 1000 }"#,
            "networks.sample.pins[0].motion={ times = [0, 0.01], offsets = [[0, 0, 0], [0.1, 0, 0]] }",
        ],
        reference: -550.0,
        mutation: "networks.sample.links[0].law.repulsion=10010",
        ..CURVE
    },
    Case {
        id: "piecewise_value",
        capabilities: &["JIM-17", "JIM-16"],
        what: "a characteristic of four pieces at 1.4 m",
        settings: &[
            r#"networks.sample.links[0].law={ name = "piecewise_linear", thresholds = [0.9, 1.2, 1.6], slopes = [-10, -2, 1, 0], zero = 0 }"#,
            "networks.sample.pins[0].motion={ times = [0, 0.01], offsets = [[0, 0, 0], [-0.4, 0, 0]] }",
        ],
        reference: 9.4,
        source: "specification §2.8.3",
        mutation: "networks.sample.links[0].law.slopes=[-10, -2, 2, 0]",
        ..CURVE
    },
    Case {
        id: "lennard_jones_strongest",
        what: "strongest attraction of the family's member n = 6, at r0 (13/7)^(1/6)",
        settings: &[
            r#"networks.sample.links[0].law={ name = "lennard_jones", depth = 1, distance = 1, exponent = 6 }"#,
            "networks.sample.pins[0].motion={ times = [0, 0.01], offsets = [[0, 0, 0], [-0.1086834179687215, 0, 0]] }",
        ],
        reference: 2.689_900_897_204_72,
        source: "specification §2.10, the row of n = 6 in closed form",
        mutation: "networks.sample.links[0].law.exponent=7",
        ..CURVE
    },
    Case {
        id: "ball_push",
        capabilities: &["JIM-21"],
        what: "two balls 0.9 m apart whose radii are a metre together push with k 0.1 m",
        settings: &[
            r#"networks.sample.links[0].law={ name = "ball", threshold = 1, stiffness = 1000 }"#,
            "networks.sample.pins[0].motion={ times = [0, 0.01], offsets = [[0, 0, 0], [0.1, 0, 0]] }",
        ],
        reference: -100.0,
        source: "φ = K (S - D) for D < S",
        mutation: "networks.sample.links[0].law.threshold=1.01",
        ..CURVE
    },
    Case {
        id: "exponential_stop_push",
        capabilities: &["JIM-24"],
        what: "an exponential stop one depth inside pushes with k d (e - 1)",
        settings: &[
            r#"networks.sample.links[0].law={ name = "exponential_stop", threshold = 1, stiffness = 1000, depth = 0.1 }"#,
            "networks.sample.pins[0].motion={ times = [0, 0.01], offsets = [[0, 0, 0], [0.1, 0, 0]] }",
        ],
        // -100 (e - 1)
        reference: -171.828_182_845_904_5,
        source: "specification §2.9.3",
        mutation: "networks.sample.links[0].law.depth=0.101",
        ..CURVE
    },
    Case {
        id: "ball_restitution",
        capabilities: &["JIM-23", "JIM-21"],
        what: "speed of a ball after a collision with damping ratio 0.1",
        scene: "network_collision",
        reading: Reading::component("speed", 0),
        // 0.5 exp(-π h/√(1 - h²))
        reference: 0.36462380714383547,
        // first order in the step: contact lasts some 700 steps
        tolerance: Tolerance::Relative(2e-3),
        source: "specification §2.9.5",
        mutation: "networks.balls.crowds[0].law.damping=4.6",
        ..OSCILLATOR
    },
    Case {
        id: "sliding_distance",
        capabilities: &["JIM-45", "JIM-47", "JIM-22"],
        what: "a mass at 2 m/s slides v²/(2 μ g) on a huge ball and stops",
        scene: "network_friction",
        reading: Reading::component("place", 0),
        reference: 0.509_683_995_922_528,
        tolerance: Tolerance::Relative(1e-2),
        source: "EXP-38: within 1 %",
        mutation: "networks.table.crowds[0].friction.kinetic=0.41",
        ..OSCILLATOR
    },
    Case {
        id: "sliding_distance_slow",
        capabilities: &["JIM-45"],
        what: "the same at 1 m/s",
        scene: "network_friction",
        settings: &["networks.table.masses.book.velocity=[1, 0, 0]"],
        reading: Reading::component("place", 0),
        reference: 0.127_420_998_980_632,
        tolerance: Tolerance::Relative(1e-2),
        source: "EXP-38: within 1 %",
        mutation: "networks.table.crowds[0].friction.kinetic=0.41",
        ..OSCILLATOR
    },
    Case {
        id: "sticking_hook",
        capabilities: &["JIM-46", "JIM-47"],
        what: "at rest under gravity that leans to tan θ = 0.5 the mass hangs on its hook: F_t/K_t from its place",
        scene: "network_friction",
        settings: &[
            "networks.table.masses.book.velocity=[0, 0, 0]",
            r#"world.gravity=["4.905 * min(t/0.5, 1)", 0, -9.81]"#,
        ],
        reading: Reading::component("place", 0),
        reference: 4.905e-5,
        // what the hook gave way while the normal force found its level
        tolerance: Tolerance::Relative(2e-2),
        source: "F_t = -K_t D_acc (specification §2.14.3)",
        mutation: "networks.table.crowds[0].friction.static=0.45",
        ..OSCILLATOR
    },
    Case {
        id: "torn_state",
        capabilities: &["JIM-10", "JIM-19"],
        what: "fracture as a finite-state link: torn beyond 1.02 m it pulls no more",
        settings: &[
            r#"networks.sample.links[0].law={ name = "finite_state", states = { whole = "-k * (D - L0)", torn = "0" }, transitions = { "whole -> torn" = "D - L0 > 0.021" }, parameters = { k = 1000 } }"#,
        ],
        reading: PULL.after(16),
        reference: 0.0,
        source: "specification §2.7: fracture",
        mutation: r#"networks.sample.links[0].law.transitions={ "whole -> torn" = "D > 2" }"#,
        ..PLASTIC
    },
    Case {
        id: "glued_state",
        capabilities: &["JIM-10", "JIM-19"],
        what: "glue: joined below 0.985 m with the length of that moment, k (1.03 - 0.98) at the end",
        settings: &[
            r#"networks.sample.links[0].law={ name = "finite_state", states = { free = "0", glued = "-k * (D - L0)" }, transitions = { "free -> glued" = "D < 0.985" }, entries = { glued = "L0 = D" }, parameters = { k = 1000 } }"#,
        ],
        reading: PULL.after(16),
        reference: 50.0,
        source: "specification §2.7: gluing",
        mutation: r#"networks.sample.links[0].law.entries={ glued = "L0 = 1" }"#,
        ..PLASTIC
    },
    Case {
        id: "plastic_state",
        capabilities: &["JIM-10"],
        what: "step plasticity: past 12.5 mm the rest length jumps to the present one, twice on the way to 1.03 m and back",
        settings: &[
            r#"networks.sample.links[0].law={ name = "finite_state", states = { elastic = "-k * (D - L0)", jumps = "-k * (D - L0)" }, transitions = { "elastic -> jumps" = "D - L0 > 0.0125", "jumps -> elastic" = "D > 0" }, entries = { jumps = "L0 = D" }, parameters = { k = 1000 } }"#,
        ],
        reading: PULL.after(6),
        reference: -5.0,
        source: "specification §2.7: step plasticity; 1.015 m, then 1.03 m, and back to 1.025 m",
        mutation: "networks.sample.links[0].law.parameters.k=1001",
        ..PLASTIC
    },
    Case {
        id: "gripped_state",
        capabilities: &["JIM-10"],
        what: "a grip on command at 55 ms holds the length of that moment",
        settings: &[
            r#"networks.sample.links[0].law={ name = "finite_state", states = { open = "0", closed = "-k * (D - L0)" }, transitions = { "open -> closed" = "t > 0.055" }, entries = { closed = "L0 = D" }, parameters = { k = 1000 } }"#,
        ],
        reading: PULL.after(12),
        reference: -45.0,
        source: "specification §2.7: grip on command, at 1.025 m, then at 0.98 m",
        mutation: r#"networks.sample.links[0].law.transitions={ "open -> closed" = "t > 0.065" }"#,
        ..PLASTIC
    },
    Case {
        id: "last_condition_wins",
        capabilities: &["JIM-10", "JIM-19"],
        what: "of two conditions that hold the one written last leads on",
        settings: &[
            r#"networks.sample.links[0].law={ name = "finite_state", states = { a = "0", b = "-1", c = "-2" }, transitions = { "a -> b" = "D > 1.001", "a -> c" = "D > 1.002" } }"#,
        ],
        reading: PULL.after(2),
        reference: 2.0,
        source: "specification §2.7: the last one met wins",
        mutation: r#"networks.sample.links[0].law.transitions={ "a -> c" = "D > 1.002", "a -> b" = "D > 1.001" }"#,
        ..PLASTIC
    },
    Case {
        id: "written_law",
        capabilities: &["JIM-15"],
        what: "a cubic spring written as an energy, k (0.03 m)³ at 1.03 m",
        settings: &[
            r#"networks.sample.links[0].law={ name = "formula", energy = "k/4 * (D - L0)^4", parameters = { k = "1e6" } }"#,
        ],
        reading: PULL.after(16),
        reference: 27.0,
        source: "φ = -dE/dD",
        mutation: "networks.sample.links[0].law.parameters.k=1000001",
        ..PLASTIC
    },
    Case {
        id: "sand_heap_rests",
        capabilities: &["JIM-28"],
        what: "kinetic energy of a heap of balls with friction, four seconds after the first fell",
        scene: "sand_heap",
        reading: Reading::last("moving"),
        reference: 0.0,
        // 196 balls of 0.5 kg at a tenth of a diameter a second
        tolerance: Tolerance::Absolute(5e-3),
        source: "EXP-35: the greatest speed goes to zero",
        mutation: "networks.sand.crowds[0].friction={ static = 0, kinetic = 0, stiffness = 1, speed = 0.01 }",
        ..OSCILLATOR
    },
    Case {
        id: "clay_breaks",
        capabilities: &["JIM-30", "JIM-25"],
        what: "greatest pull of a cohesive block of sixteen columns: sixteen bonds of k_a (S2 - S)",
        scene: "clay_sticks_again",
        reading: Reading::last("pull").taking(Statistic::Min),
        reference: -1600.0,
        // drag of the moving layers comes on top
        tolerance: Tolerance::Relative(0.03),
        source: "EXP-36: peak force = bonds x k_a (S2 - S)",
        mutation: "networks.clay.crowds[0].law.cohesion=1100",
        ..OSCILLATOR
    },
];
