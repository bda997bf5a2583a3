//! Masses and links: the recurrence of a mass, oscillators step by step, momenta, impacts, multitudes.

use crate::{Case, Limit, Reading, Refinement, Statistic, Tolerance, Variant};

pub(super) const OSCILLATOR: Case = Case {
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

/// A mass that nothing holds.
const FREE: &str = r#"networks.oscillator.links[0].law={ name = "spring", stiffness = 0 }"#;
const IMPULSE: &str =
    r#"networks.oscillator.loads=[{ region = "bob", force = ["if(t > 0.15 and t < 0.25, 10, 0)", 0, 0] }]"#;

/// With the scene's period of 10 ms, `g Te²` is a metre.
const UNIT_FALL: &str = "world.gravity=[0, 0, -10000]";

/// Friction step by step: a thousand steps in a second, each of them told.
const EACH_STEP: [&str; 2] = [r#"world.period="1 ms""#, "systems.main.steps_per_period=1"];

/// A mass that slides at a speed just before it sticks, and at the time when it has stopped.
macro_rules! slides_and_stops {
    ($speed:literal, $sliding:literal at $before:literal: $left:literal, $stopped:literal at $after:literal, $would_go:literal) => {
        [
            Case {
                id: $sliding,
                capabilities: &["JIM-45"],
                what: concat!(
                    "speed of a mass that began at ",
                    $speed,
                    " m/s, ",
                    $before,
                    " ms after: v - μ g t, faster than V_s"
                ),
                scene: "network_friction",
                settings: &[
                    EACH_STEP[0],
                    EACH_STEP[1],
                    concat!("networks.table.masses.book.velocity=[", $speed, ", 0, 0]"),
                ],
                reading: Reading::component("speed", 0).after($before),
                reference: $left,
                // a step of friction more or less, μ g Te
                tolerance: Tolerance::Absolute(0.4 * 9.81e-3),
                source: "EXP-38: v0/(μ g) = 0.2548, 0.5097, 1.0194 s (specification §2.14.5)",
                mutation: "networks.table.crowds[0].friction.kinetic=0.41",
                ..OSCILLATOR
            },
            Case {
                id: $stopped,
                capabilities: &["JIM-45", "JIM-46"],
                what: concat!(
                    "speed of the same ",
                    $after,
                    " ms after, where the specification has it stopped: less than V_s, its hook has it"
                ),
                scene: "network_friction",
                settings: &[
                    EACH_STEP[0],
                    EACH_STEP[1],
                    concat!("networks.table.masses.book.velocity=[", $speed, ", 0, 0]"),
                ],
                reading: Reading::component("speed", 0).after($after),
                reference: 0.0,
                // V_s
                tolerance: Tolerance::Absolute(5e-3),
                source: "specification §2.14.5: stop times of 0.257, 0.512, 1.021 s for 1, 2, 4 m/s [V]",
                // slides then at more than V_s
                mutation: concat!("networks.table.crowds[0].friction.kinetic=", $would_go),
                ..OSCILLATOR
            },
        ]
    };
}

pub(super) const STOPS: &[[Case; 2]] = &[
    slides_and_stops!(1, "slow_slides" at 253: 0.007_228, "slow_has_stopped" at 257, 0.38),
    slides_and_stops!(2, "mass_slides" at 508: 0.006_608, "mass_has_stopped" at 512, 0.38),
    slides_and_stops!(4, "fast_slides" at 1017: 0.009_292, "fast_has_stopped" at 1021, 0.39),
];

/// How far a mass of a tetrahedron ever was from the middle of the hollow that holds it, shaken at 5 and at 45 m/s.
macro_rules! stays_in_the_rattle {
    ($mass:literal) => {
        [
            Case {
                id: concat!("rattle_keeps_", $mass),
                capabilities: &["JIM-22"],
                what: concat!("how far the ", $mass, " mass of a tetrahedron ever is from the middle of a bubble of 2 m that is shaken at 5 m/s: a fiftieth of its radius beyond it at most"),
                scene: "rattle",
                reading: Reading::last($mass).taking(Statistic::Max),
                reference: 2.04,
                tolerance: Tolerance::AtMost,
                source: "EXP-02: penetration below 2 % at 5 m/s",
                mutation: "networks.rattle.links[1].law.stiffness=5000",
                ..OSCILLATOR
            },
            Case {
                id: concat!("rattle_keeps_", $mass, "_in_violence"),
                capabilities: &["JIM-22"],
                what: concat!("the same of the ", $mass, " mass, shaken at 45 m/s: 15 % beyond it at most"),
                scene: "rattle",
                settings: VIOLENTLY,
                reading: Reading::last($mass).taking(Statistic::Max).after(5000),
                reference: 2.3,
                tolerance: Tolerance::AtMost,
                source: "EXP-02: penetration below 15 % of the radius under violent shaking at 45 m/s",
                mutation: "networks.rattle.links[1].law.stiffness=5000",
                ..OSCILLATOR
            },
        ]
    };
}

const VIOLENTLY: &[&str] = &["parameters.reach=9", "parameters.rate=5"];

pub(super) const RATTLE: &[[Case; 2]] = &[
    stays_in_the_rattle!("first"),
    stays_in_the_rattle!("second"),
    stays_in_the_rattle!("third"),
    stays_in_the_rattle!("fourth"),
    [
        Case {
            id: "rattle_is_silent_first",
            capabilities: &["JIM-22"],
            what: "force of the hand on the handle of the same 0.7 s after it began to move: what its own kilogram takes, r w² cos w t, and nothing of the toy, which lies still",
            scene: "rattle",
            reading: Reading::last("blow").after(350),
            reference: 3.824_210_936_422_442,
            // it is told where a step began or ended
            tolerance: Tolerance::Absolute(5.0 * 0.002),
            source: "EXP-02: the force on the handle shows the delayed shocks",
            mutation: "networks.rattle.links[1].law.threshold=1.7",
            ..OSCILLATOR
        },
        Case {
            id: "rattle_strikes_later",
            capabilities: &["JIM-22"],
            what: "greatest force on the same within the first second: when the handle has gone as far as there is room, the wall strikes the nearest mass at 3.56 m/s, v √(k m) at least, as the others stand behind it",
            scene: "rattle",
            reading: Reading::last("blow").taking(Statistic::Max).after(500),
            // along the line to (-a, -a, a), a = 1/√8 m, when that is 2 m long, after 0.785 s
            reference: 503.0,
            tolerance: Tolerance::AtLeast,
            source: "EXP-02: the force on the handle shows the delayed shocks",
            mutation: "networks.rattle.links[1].law.stiffness=10000",
            ..OSCILLATOR
        },
    ],
];

/// Links that may yield and tear, and balls that push; all thrown with a spin.
const THROWN: [&str; 3] = [
    "networks.lattice.angular_velocity=[0, 0, 2]",
    r#"networks.lattice.links[0].law={ name = "elasto_plastic", stiffness = 100, hardening = 25, traction = 0.05, rupture = 0.12 }"#,
    r#"networks.lattice.crowds=[{ law = { name = "ball", threshold = 0.098, stiffness = 100, damping = 0.01 } }]"#,
];

/// Twice what the line to a mass sweeps in a step, 2 L Te/m: D D_before sin θ.
const PROJECTED: &str = r#"networks.pair.links[0].law={ name = "formula", push = "-k * (D - L0) - z / period * (D - D_before * sqrt(1 - (twice_swept / (D * D_before))^2))", parameters = { k = 2000, z = 20, period = 0.01, twice_swept = 0.03 } }"#;

const NANONEWTON: &str = r#"networks.lattice.loads=[{ region = "lower", force = ["1e-9", 0, 0] }]"#;

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
        id: "network_free_fall_1",
        capabilities: &["JIM-4", "JIM-7"],
        what: "fall of a mass after one step from rest, in units of g Te²",
        scene: "network_free_fall",
        settings: &[UNIT_FALL],
        reading: Reading::component("fall", 2).after(1),
        reference: -1.0,
        source: "specification §8.1, free fall: 1, 3, 55 for n = 1, 2, 10",
        mutation: "world.gravity=[0, 0, -10001]",
        ..OSCILLATOR
    },
    Case {
        id: "network_free_fall_2",
        capabilities: &["JIM-4", "JIM-7"],
        what: "fall of a mass after two steps from rest, in units of g Te²",
        scene: "network_free_fall",
        settings: &[UNIT_FALL],
        reading: Reading::component("fall", 2).after(2),
        reference: -3.0,
        source: "specification §8.1, free fall: 1, 3, 55 for n = 1, 2, 10",
        mutation: "world.gravity=[0, 0, -10001]",
        ..OSCILLATOR
    },
    Case {
        id: "network_free_fall_10",
        capabilities: &["JIM-4", "JIM-7"],
        what: "fall of a mass after ten steps from rest, in units of g Te²",
        scene: "network_free_fall",
        settings: &[UNIT_FALL],
        reading: Reading::component("fall", 2).after(10),
        reference: -55.0,
        source: "specification §8.1, free fall: 1, 3, 55 for n = 1, 2, 10",
        mutation: "world.gravity=[0, 0, -10001]",
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
        id: "impulse_is_not_seen_at_once",
        capabilities: &["JIM-3"],
        what: "displacement of a mass at the very step, the second, at which 10 N act on it for a step",
        settings: &[FREE, IMPULSE],
        reading: Reading::component("place", 0).after(2),
        reference: 0.0,
        tolerance: Tolerance::Absolute(0.0),
        source: "specification §2.2: outputs that result from inputs appear exactly one period later",
        mutation: r#"networks.oscillator.loads[0].force=["if(t > 0.05 and t < 0.15, 10, 0)", 0, 0]"#,
        ..OSCILLATOR
    },
    Case {
        id: "impulse_is_seen_a_step_later",
        capabilities: &["JIM-3"],
        what: "the same at the next step: F Te²/m",
        settings: &[FREE, IMPULSE],
        reading: Reading::component("place", 0).after(3),
        reference: 0.1,
        source: "specification §2.2: outputs that result from inputs appear exactly one period later",
        mutation: r#"networks.oscillator.loads[0].force=["if(t > 0.25 and t < 0.35, 10, 0)", 0, 0]"#,
        ..OSCILLATOR
    },
    Case {
        id: "motion_is_seen_a_step_later",
        capabilities: &["JIM-3"],
        what: "displacement of a mass on a spring of 4 N/m at the step after its other end was led on by a centimetre: k d Te²/m",
        settings: &[
            r#"networks.oscillator.links[0].law={ name = "spring", stiffness = 4 }"#,
            "networks.oscillator.links[0].rest_length=1.1",
            "networks.oscillator.masses.ground.fixed=false",
            r#"networks.oscillator.pins=[{ region = "ground", motion = { formula = ["if(t > 0.15, 0.01, 0)", 0, 0] } }]"#,
        ],
        reading: Reading::component("place", 0).after(3),
        reference: 4e-4,
        // places of a metre
        tolerance: Tolerance::Absolute(1e-15),
        source: "specification §2.2: outputs that result from inputs appear exactly one period later",
        mutation: r#"networks.oscillator.pins[0].motion.formula[0]="if(t > 0.25, 0.01, 0)""#,
        ..OSCILLATOR
    },
    Case {
        id: "swirl_from_outside",
        capabilities: &["JIM-15"],
        what: "place across of a mass that a force from outside turns, 4 N/m times its place turned by a right angle: no energy has it, no link gives it",
        settings: &[
            FREE,
            r#"networks.oscillator.loads=[{ region = "bob", force = ["-4 * y", "4 * x", 0] }]"#,
        ],
        reading: Reading::component("place", 1),
        reference: 2_249.737_100_069_97,
        source: "z' = (2 + i k Te²/m) z - z_before from rest at 1.1 m, in the plane of complex numbers; extra-physical modules (specification §2.18)",
        mutation: r#"networks.oscillator.loads[0].force=["-4 * y", "4.001 * x", 0]"#,
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
        id: "order_of_the_period",
        capabilities: &["JIM-8"],
        what: "order at which a damped oscillator in physical units tends to its trajectory as the period gets smaller, after 6 s",
        refinement: Some(Refinement {
            size_of: "period [s]",
            runs: &[
                Variant { size: 10e-3, settings: &[r#"world.period="10 ms""#] },
                Variant { size: 5e-3, settings: &[r#"world.period="5 ms""#] },
                Variant { size: 2.5e-3, settings: &[r#"world.period="2.5 ms""#] },
            ],
            // 0.1 (e^-0.6 (cos 6 ω + 0.1/ω sin 6 ω) - 1), ω² = 3.99
            limit: Limit::Known(-0.055_644_368_244_838_475),
        }),
        reading: Reading::component("place", 0),
        reference: 1.0,
        // errors of 0.0002 (1 + h s⁻¹): h/(2 ln 2) of the finer pair
        tolerance: Tolerance::Absolute(0.01),
        source: "JIM-8: changing Te leaves the trajectory unchanged up to O(Te)",
        // of another trajectory: what is left of the error does not fall
        mutation: "networks.oscillator.links[0].law.stiffness=4.001",
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
        source: "steady turning in discrete time; EXP-50: a damper of distances does not act on it",
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
        id: "projected_velocity_pulls",
        capabilities: &["JIM-6"],
        what: "kinetic energy of the same with a damper along the projected velocity, (D - D_before cos θ)/Te, which a turn does not leave alone: as its masses keep their spin, 0.03 m²/2 = D D_before sin θ/2, it draws them together all the time, and they turn faster",
        scene: "network_spin",
        settings: &[PROJECTED],
        reading: Reading::last("turning"),
        // 2 r (1 - cos θ) (m - z Te) = Te² k (2 r - 1), 2 m r² sin θ = L Te: v = 2 r sin(θ/2)/Te
        reference: 2.242_464_222_534_651,
        tolerance: Tolerance::Relative(1e-10),
        source: "specification §2.5: the projected velocity is (D - cos θ D_before)/Te, not zero where D = D_before",
        // the lengths' own rate
        mutation: "networks.pair.links[0].law.parameters.twice_swept=0",
        ..OSCILLATOR
    },
    Case {
        id: "damper_of_velocities_loses_spin",
        capabilities: &["JIM-6"],
        what: "spin of the same where dampers act on the whole of the velocity, along x and along y, in the place of that along the line",
        scene: "network_spin",
        settings: &[
            r#"networks.pair.links=[{ law = { name = "spring", stiffness = 2000 }, chain = true }, { law = { name = "damper", damping = 0.02 }, chain = true, along = [1, 0, 0] }, { law = { name = "damper", damping = 0.02 }, chain = true, along = [0, 1, 0] }]"#,
        ],
        reading: Reading::component("spin", 2),
        // 1.5 (1 - 2 z Te/m)^2000
        reference: 0.673_885_587_090_078_8,
        // rounding of 2000 steps
        tolerance: Tolerance::Relative(1e-12),
        source: "EXP-50: other dampers lose spin; X ∧ X' of each step is 1 - 2 z Te/m of that of the step before",
        mutation: r#"networks.pair.links=[{ law = { name = "spring", stiffness = 2000 }, chain = true }, { law = { name = "damper", damping = 0.02 }, chain = true }]"#,
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
        // a force from outside, of a nanonewton
        mutation: NANONEWTON,
        ..OSCILLATOR
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
        id: "sand_heap_stands",
        capabilities: &["JIM-28"],
        what: "height of the topmost ball of a heap on rough ground: more than two diameters",
        scene: "sand_heap",
        reading: Reading::last("top"),
        reference: 0.2,
        tolerance: Tolerance::Above,
        source: "EXP-35: a stable heap, higher than 2 S with rough ground",
        mutation: "networks.sand.crowds[0].friction={ static = 0, kinetic = 0, stiffness = 1, speed = 0.01 }",
        ..OSCILLATOR
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
    Case {
        id: "thrown_momentum",
        capabilities: &["JIM-94", "JIM-5"],
        what: "momentum of a lattice that is thrown with a spin, whose links may yield and tear and whose masses push each other, after a second",
        scene: "network_lattice",
        settings: &THROWN,
        reading: Reading::component("momentum", 0),
        reference: -0.0968,
        // rounding of 1331 masses and 1000 steps
        tolerance: Tolerance::Absolute(1e-13),
        source: "EXP-52: any internal network keeps its momentum (specification §2.5)",
        mutation: NANONEWTON,
        ..OSCILLATOR
    },
    Case {
        id: "thrown_spin",
        capabilities: &["JIM-94", "JIM-5"],
        what: "angular momentum of the same: 2 rad/s times 1.331 kg (n² - 1)/6 (0.1 m)², n = 11",
        scene: "network_lattice",
        settings: &THROWN,
        reading: Reading::component("spin", 2),
        reference: 0.5324,
        tolerance: Tolerance::Absolute(1e-13),
        source: "EXP-52: axial forces keep Σ M X_n ∧ X_{n+1}, whatever the law (specification §2.5)",
        mutation: r#"networks.lattice.loads=[{ region = "lower", force = [0, "1e-9 * x", 0] }]"#,
        ..OSCILLATOR
    },
    Case {
        id: "thrown_spin_across",
        capabilities: &["JIM-94", "JIM-5"],
        what: "angular momentum of the same about y, by its halves that are thrown apart: -0.8 m/s (0.605 kg 0.3 m + 0.726 kg 0.25 m)",
        scene: "network_lattice",
        settings: &THROWN,
        reading: Reading::component("spin", 1),
        // about the origin, which is the middle
        reference: -0.2904,
        tolerance: Tolerance::Absolute(1e-13),
        source: "EXP-52: axial forces keep Σ M X_n ∧ X_{n+1}, whatever the law (specification §2.5)",
        mutation: NANONEWTON,
        ..OSCILLATOR
    },
    Case {
        id: "balls_overlap_by_their_stiffness",
        capabilities: &["JIM-21"],
        what: "nearest place of a ball that runs into its like without loss, from the middle: by half of v √(m/k) nearer than touching",
        scene: "network_collision",
        settings: &["networks.balls.crowds[0].law.damping=0"],
        reading: Reading::last("place").taking(Statistic::Min),
        // 0.5 - √(0.5/1000)/2
        reference: 0.488_819_660_112_501,
        // of the overlap of 11.2 mm, that a step is into the zone before it is felt: (ω Te)²/2; told each millisecond, (10 ω Te)²/8
        tolerance: Tolerance::Absolute(0.0112 * (1e-5 + 2.5e-4)),
        source: "JIM-21: two balls never overlap more than the stiffness predicts, v √(m/k) of the reduced mass",
        mutation: "networks.balls.crowds[0].law.stiffness=999",
        ..OSCILLATOR
    },
    Case {
        id: "damped_balls_overlap_less",
        capabilities: &["JIM-21", "JIM-23"],
        what: "the same with a damping ratio of 0.1: no nearer",
        scene: "network_collision",
        reading: Reading::last("place").taking(Statistic::Min),
        reference: 0.488_819_660_112_501,
        tolerance: Tolerance::AtLeast,
        source: "JIM-21: two balls never overlap more than the stiffness predicts, v √(m/k) of the reduced mass",
        mutation: "networks.balls.crowds[0].law.stiffness=700",
        ..OSCILLATOR
    },
    Case {
        id: "ball_restitution_05",
        capabilities: &["JIM-23", "JIM-21"],
        what: "speed of a ball after a collision with damping ratio 0.05",
        scene: "network_collision",
        settings: &["networks.balls.crowds[0].law.damping=2.23606797749979"],
        reading: Reading::component("speed", 0),
        // 0.5 exp(-π h/√(1 - h²))
        reference: 0.42723394650337826,
        // first order in the step, ω Te = 4.5e-3
        tolerance: Tolerance::Relative(4.5e-3),
        source: "specification §2.9.5",
        mutation: "networks.balls.crowds[0].law.stiffness=800",
        ..OSCILLATOR
    },
    Case {
        id: "ball_restitution_30",
        capabilities: &["JIM-23", "JIM-21"],
        what: "speed of a ball after a collision with damping ratio 0.3",
        scene: "network_collision",
        settings: &["networks.balls.crowds[0].law.damping=13.416407864998739"],
        reading: Reading::component("speed", 0),
        // 0.5 exp(-π h/√(1 - h²))
        reference: 0.1861630524632932,
        // first order in the step, ω Te = 4.5e-3
        tolerance: Tolerance::Relative(4.5e-3),
        source: "specification §2.9.5",
        mutation: "networks.balls.crowds[0].law.stiffness=970",
        ..OSCILLATOR
    },
    Case {
        id: "ball_restitution_50",
        capabilities: &["JIM-23", "JIM-21"],
        what: "speed of a ball after a collision with damping ratio 0.5",
        scene: "network_collision",
        settings: &["networks.balls.crowds[0].law.damping=22.360679774997898"],
        reading: Reading::component("speed", 0),
        // 0.5 exp(-π h/√(1 - h²))
        reference: 0.08151676741079024,
        // first order in the step, ω Te = 4.5e-3
        tolerance: Tolerance::Relative(4.5e-3),
        source: "specification §2.9.5",
        mutation: "networks.balls.crowds[0].law.stiffness=970",
        ..OSCILLATOR
    },
];
