//! Constraints between masses: rods, wires and told accelerations, kept exactly; areas and volumes.

use super::network::OSCILLATOR;
use crate::{Case, Limit, Reading, Refinement, Statistic, Tolerance, Variant};

const RODS: Case = Case {
    capabilities: &["JIM-97"],
    scene: "exact_rods",
    reading: Reading::component("bob", 0).after(296),
    mutation: "networks.pendulum.masses.hook.positions=[[-4.001, 0, 0]]",
    source: "specification §6.3, PA-15, with the multipliers solved for",
    ..OSCILLATOR
};

const WIRES: Case = Case {
    scene: "bead_on_wire",
    mutation: "world.gravity=[0, -9.8, 0]",
    source: "specification §6.3, PA-15: a point on a path",
    ..RODS
};

const TOLD: Case = Case {
    reading: Reading::component("told", 0),
    mutation: r#"networks.told.constraints[0].acceleration.formula=["2 * cos(3.01 * t)", 0, 0]"#,
    source: "specification §6.3, PA-42: accelerations that are prescribed",
    ..WIRES
};

const KEPT: Case = Case {
    scene: "kept_inside",
    reading: Reading::last("exact_area"),
    tolerance: Tolerance::Relative(1e-12),
    mutation: r#"networks.exact.constraints[0].area.part="1 + 1e-9""#,
    source: "specification §6.2, PA-18: what is enclosed, as a constraint",
    ..RODS
};

const TURNS: Case = Case {
    scene: "told_turns",
    reading: Reading::component("turn_takes", 0).after(1000),
    mutation: "networks.balance.masses.weight.mass=2.001",
    source: "specification §6.3, PA-15: orientation",
    ..RODS
};

const CORE: Case = Case {
    scene: "rigid_core",
    reading: Reading::component("breath", 0).after(100),
    mutation: "networks.breathing.masses.skin.mass=0.1002",
    source: "specification §6.3, PA-31",
    ..RODS
};

const MOULDED: Case = Case {
    scene: "moulded_rods",
    reading: Reading::component("drawn", 1),
    mutation: "networks.drawn.constraints[0].yields_at=20.01",
    source: "specification §6.2, PA-18: mouldability, as a constraint with a limit",
    ..RODS
};

const BRACED: Case = Case {
    scene: "braced_truss",
    reading: Reading::component("speed", 1).after(1),
    mutation: r#"networks.hinged.constraints[0].yields_at="3.01 N""#,
    ..MOULDED
};

const CRUSHED: Case = Case {
    scene: "crushed_legs",
    reading: Reading::component("top", 1),
    mutation: r#"networks.table.constraints[2].yields_at="30.1 N""#,
    source: "specification §6.2, PA-18, and §6.3, PA-37: contacts on what gives way",
    ..MOULDED
};

const LANDED: Case = Case {
    scene: "crushed_landing",
    reading: Reading::component("weight", 1),
    mutation: r#"networks.lander.constraints[0].yields_at="40.5 N""#,
    ..CRUSHED
};

const DRAWN: Case = Case {
    scene: "drawn_wire",
    reading: Reading::last("given_off").after(1),
    mutation: r#"networks.led.constraints[0].yields_at="7.01 N""#,
    ..MOULDED
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "rod_pendulum_swings",
        what: "place of a pendulum of one rod, let go level, near its lowest point",
        // −4 + sin θ, sin(θ/2) = k sn(K − √(g/L) t, k), k = sin 45°
        reference: -4.000_175_021_203_992,
        // of second order: (ω h)²/4 of the length, ω² = 2 g/L at most
        tolerance: Tolerance::Absolute(2e-5),
        ..RODS
    },
    Case {
        id: "rod_pendulum_order",
        what: "order at which the same tends to it as the period gets smaller",
        refinement: Some(Refinement {
            size_of: "period [s]",
            runs: &[
                Variant {
                    size: 8e-3,
                    settings: &[r#"world.period="8 ms""#, "systems.main.steps_per_period=1"],
                },
                Variant {
                    size: 8e-3 / 2.0,
                    settings: &[r#"world.period="8 ms""#, "systems.main.steps_per_period=2"],
                },
                Variant {
                    size: 8e-3 / 4.0,
                    settings: &[r#"world.period="8 ms""#, "systems.main.steps_per_period=4"],
                },
            ],
            limit: Limit::Known(-4.000_175_021_203_992),
        }),
        reading: Reading::component("bob", 0).after(74),
        reference: 2.0,
        // the next term is h² smaller
        tolerance: Tolerance::Absolute(0.01),
        mutation: r#"systems.main.stepper="t_simulation""#,
        ..RODS
    },
    Case {
        id: "rod_pendulum_keeps_length",
        what: "the farthest place to the left in four seconds: the rod is a metre long, and energy is kept",
        reading: Reading::component("bob", 0).taking(Statistic::Min),
        reference: -5.0,
        // it is level to (√(g/L) h/2)² at the step nearest to where it turns
        tolerance: Tolerance::Absolute(1e-5),
        ..RODS
    },
    Case {
        id: "rod_pendulum_pulls",
        what: "greatest pull of the rod: 3 m g at the lowest point",
        reading: Reading::component("pull", 1).taking(Statistic::Max),
        reference: 58.86,
        // the step nearest to it is off by ω h/2, whose cosine is read twice, and the scheme by (ω h)²/24
        tolerance: Tolerance::Relative(4e-5),
        mutation: "networks.pendulum.masses.bob.mass=2.001",
        ..RODS
    },
    Case {
        id: "rod_frame_swings",
        what: "place of the far corner of a square of six rods, one of which follows from the others, that swings as a rigid body, after 0.6 s",
        reading: Reading::component("far_corner", 0).after(300),
        // 1 + 0.6 √2 sin θ of a compound pendulum that starts at rest at 135° from below: I θ'' = −g (Σ m r) sin θ with
        // I = 0.5 kg (2 + √2²) (0.6 m)² = 0.72 kg m² and Σ m r = 0.5 kg (√2 + 2/√2) 0.6 m, integrated in steps of 10 μs
        reference: 1.514_329_954_392_705,
        // of second order: at the most the 5.9/s that it has at the end, its phase is off by (ω h)²/24 of ω t, 2e-5, which is seen from the side
        tolerance: Tolerance::Absolute(2e-5),
        mutation: "networks.frame.masses.corners.positions=[[1, 0, 0], [1.6, 0, 0], [1.601, 0.6, 0], [1, 0.6, 0]]",
        source: "physical consistency; redundant relations, specification §6.3, PA-15",
        ..RODS
    },
    Case {
        id: "rod_frame_stays_square",
        what: "area of the same square after four seconds",
        reading: Reading::last("frame_area"),
        reference: 0.36,
        // each side and diagonal to 1e-12 of what is constrained, which is 4 m wide, at both of its ends
        tolerance: Tolerance::Absolute(3e-11),
        mutation: "networks.frame.masses.corners.positions=[[1, 0, 0], [1.6, 0, 0], [1.601, 0.6, 0], [1, 0.6, 0]]",
        source: "physical consistency; redundant relations, specification §6.3, PA-15",
        ..RODS
    },
    Case {
        id: "rods_are_assembled",
        what: "what a mass that is drawn to a nail a metre above is off by after the time τ",
        reading: Reading::component("nailed", 1).after(100),
        // −(1 + t/τ) e^{−t/τ} at t = τ: D'' + (2/τ) D' + D/τ² = 0 from rest, which steps sample exactly
        reference: -2.0 / std::f64::consts::E,
        // each step keeps it to 1e-12 of 4 m, of which the approach sums (τ/h)² = 100²
        tolerance: Tolerance::Absolute(4e-8),
        mutation: r#"networks.assembly.constraints[0].time="0.21 s""#,
        ..RODS
    },
    Case {
        id: "bead_runs_down_helix",
        what: "height of a bead that has run down a helix for 1.2 s",
        reading: Reading::component("helix", 1),
        // −½ g c²/(1 + c²) t², c = 0.3
        reference: -0.5832,
        // of second order in the 3.5 mrad that it turns by in a step at the end
        tolerance: Tolerance::Absolute(2e-6),
        ..WIRES
    },
    Case {
        id: "bead_slides_down_line",
        what: "velocity of a bead that slides down a slope of 3 in 5, half a step before 1.2 s",
        reading: Reading::component("slope", 0),
        // g (4/5)(3/5)(t − h/2)
        reference: 5.648_205_6,
        tolerance: Tolerance::Relative(1e-11),
        ..WIRES
    },
    Case {
        id: "line_bears_bead",
        what: "what its line pushes it with: 3/5 of its weight, of that 4/5 along x",
        reading: Reading::component("slope_holds", 0),
        reference: 0.941_76,
        // a mass of 0.2 kg, known to 1e-12 of 7 m, over the square of a step
        tolerance: Tolerance::Absolute(3e-6),
        ..WIRES
    },
    Case {
        id: "acceleration_is_told",
        what: "place of a mass whose acceleration along x is told, whatever a spring does to it",
        // (2/9)(1 − cos 3 t)
        reference: 0.421_501_870_296_477_1,
        // sums of second order: (3 h)²/12 of it
        tolerance: Tolerance::Absolute(1e-6),
        ..TOLD
    },
    Case {
        id: "told_acceleration_takes",
        what: "force that it takes: m a + k x",
        reading: Reading::component("takes", 0),
        reference: 3.856_315_336_431_112,
        // it is that of the step before: m a''' + k x' change by −2.95 + 0.53 N/s, in a step of a millisecond
        tolerance: Tolerance::Absolute(2.5e-3),
        mutation: "networks.told.links[0].law.stiffness=10.1",
        ..TOLD
    },
    Case {
        id: "direction_takes_couple",
        what: "force that turns a weight on a bar where its told direction turns back: m r θ''",
        // 2 kg · ½ m · (π/4) π²/s²
        reference: 7.751569170074954,
        // it is that of the step before, when θ'' was less by (π h)²/2, and is a second difference, less by (π h)²/12
        tolerance: Tolerance::Relative(6e-6),
        ..TURNS
    },
    Case {
        id: "direction_bears_weight",
        what: "force by which the same keeps the weight level: m g",
        reading: Reading::component("turn_takes", 1),
        reference: 19.62,
        // 2 kg known to 1e-12 of 3.5 m at both ends over the square of a step
        tolerance: Tolerance::Absolute(3e-5),
        ..TURNS
    },
    Case {
        id: "direction_is_approached",
        what: "what a needle is off its told direction by after the time τ: 2/e of what it was",
        reading: Reading::component("needle", 1).after(200),
        reference: 0.2207276647028654,
        // each step keeps it to 1e-12 of 2 m at both ends, of which the approach sums (τ/h)² = 200²
        tolerance: Tolerance::Absolute(2e-7),
        mutation: r#"networks.needle.constraints[1].time="0.201 s""#,
        ..TURNS
    },
    Case {
        id: "direction_is_kept_in_the_end",
        what: "height of a weight on a bar whose direction is kept by an augmented Lagrangian",
        reading: Reading::component("sagging", 1),
        reference: -1.5,
        // 0.5 s³ + 20 s² + 200 s + 1000 = 0 has its slowest roots at −5.9: e^−17.6 of m g/c = 25 mm is left, not more than ten times
        tolerance: Tolerance::Absolute(6e-9),
        mutation: "networks.sagging.constraints[1].augmented.rate=0",
        ..TURNS
    },
    Case {
        id: "told_arm_reaches",
        what: "place of the hand of an arm whose upper part is told its direction and whose elbow is told its angle, after a second",
        reading: Reading::component("hand", 0).after(1000),
        // cos a + 0.8 cos (a + f), a = 0.9 (1 − cos 2), f = 1.4 (1 − cos 3)
        reference: -0.19338834038379588,
        // directions and rods are kept to 1e-12 of 2 m at both ends, angles to that times 1 + 2 + 1.25 of gradients per metre, on a metre
        tolerance: Tolerance::Absolute(3e-11),
        mutation: r#"networks.arm.constraints[2].angle.value="pi + 1.401 * (1 - cos(3 * t))""#,
        ..TURNS
    },
    Case {
        id: "area_is_kept",
        what: "area of a ring of masses that is drawn out to 1.3 of its width",
        // 12 r² sin(2 π/24)
        reference: 0.776_457_135_307_562_2,
        // off by 1e-12 of Σ |∂A/∂x_i| · 1.45 m, with 24 gradients of half of the 0.26 m between the neighbours of a mass, or less than a half more where drawn
        tolerance: Tolerance::Absolute(1e-11),
        ..KEPT
    },
    Case {
        id: "area_is_kept_in_the_end",
        what: "the same by an augmented Lagrangian, whose multiplier grows until nothing is off",
        reading: Reading::last("augmented_area"),
        reference: 0.776_457_135_307_562_2,
        // it has three seconds, and times below a fifth of one
        tolerance: Tolerance::Relative(1e-6),
        mutation: "networks.augmented.constraints[0].augmented.rate=0",
        ..KEPT
    },
    Case {
        id: "volume_is_kept",
        what: "equator of an octahedron whose poles are pressed to half their distance: √2 times as wide",
        reading: Reading::component("equator", 0),
        reference: -0.092_893_218_813_452_48,
        // motion along the sheet of shapes of that volume has died out
        tolerance: Tolerance::Absolute(1e-9),
        mutation: r#"networks.pressed.constraints[0].volume.part="1 + 0.001 * smoothstep(0, 1, t)""#,
        ..KEPT
    },
    Case {
        id: "volume_pushes",
        what: "force of its pressure on a pole: the springs of the equator do the work of the poles",
        reading: Reading::component("pole", 1),
        // four sides of √2 a at 20 N/m, √½ m long at rest with a₀ = b₀ = ½ m; poles at b = ¼ m keep a² b = a₀² b₀, so that a = √½ m. By virtual work both poles
        // do what sides store, 2 F db = dE: dE/da = 4·20 (√2 a − √½) √2 = 80 (√2 − 1), |da/db| = a/(2 b) = √2, F = 40 (2 − √2)
        reference: 23.431_457_505_076_2,
        // motion has died out at 10/s in three seconds; what is kept to some 1e-12 m of 50 g masses is known to 1e-6 N over the square of a step
        tolerance: Tolerance::Relative(1e-7),
        mutation: "networks.pressed.links[0].law.stiffness=20.1",
        ..KEPT
    },
    Case {
        id: "skin_breathes_around_core",
        what: "displacement of a mass of a skin around a rigid core that is at rest, after 0.1 s: A e^{−γt} sin ωt",
        // A = v/ω, γ = z/2m = 2/s, ω = √(k/m − γ²) = √396/s
        reference: 1.503_231_004_251_977_6e-5,
        // dampers compare with the step before, as if masses were less by ζ/2 = z h/2 m = 2e-4 of them: A is less by ζ/4, ω t = 2 more by ζ/4 of it, which is
        // seen times cot 2, and γ t = 0.2 by ζ/2, and the first step is short by ζ/2: 1.07 ζ in all. Springs of 0.3 m turn by A √3/0.3 m/2 = 6e-5
        tolerance: Tolerance::Relative(5e-4),
        ..CORE
    },
    Case {
        id: "core_stays_amid_skin",
        what: "greatest displacement of the core meanwhile: the forces on it cancel",
        reading: Reading::last("still").taking(Statistic::Max),
        reference: 0.0,
        // rounding of 0.3 m in fifty thousand steps
        tolerance: Tolerance::Absolute(1e-13),
        mutation: "networks.breathing.masses.skin.positions=[[0.2, 0.2, 0.2], [0.2, 0.2, -0.2], [0.2, -0.2, 0.2], [0.2, -0.2, -0.2], [-0.2, 0.2, 0.2], [-0.2, 0.2, -0.2], [-0.2, -0.2, 0.2], [-0.2, -0.2, -0.201]]",
        ..CORE
    },
    Case {
        id: "skin_turns_core",
        what: "speed of a corner of a rigid core at rest whose skin was set off to turn, once both turn as one",
        reading: Reading::last("corner"),
        // 0.3 m ω of 0.064 kg m²/s = ω (0.18 + 0.064/(1 − ω² m/k)²) kg m²: the skin stands off as it turns
        reference: 0.078_681_424_786_706_41,
        // turning to and fro against each other has γ = 2 (1 + 0.064/0.18)/s, and e^−13.6 = 1.3e-6 is left; Δ of springs is of second order of ω² m/k = 1.7e-4 of 0.2/0.3
        tolerance: Tolerance::Relative(5e-6),
        mutation: "networks.spun.masses.core.mass=0.5001",
        ..CORE
    },
    Case {
        id: "skin_and_core_keep_spin",
        what: "angular momentum of the same",
        reading: Reading::component("spin", 2),
        // 8 · 0.1 kg (0.2² + 0.2²) m² · 1/s
        reference: 0.064,
        // rods hold to 1e-12 of 1.8 m at both ends, which is found and not summed
        tolerance: Tolerance::Absolute(1e-13),
        mutation: "networks.spun.masses.skin.mass=0.10001",
        ..CORE
    },
    Case {
        id: "rod_yields",
        what: "place of a weight on a rod beyond what that bears, after 0.2 s: −½ (g + F/m − Y/m) t²",
        reading: Reading::component("drawn", 1).after(200),
        reference: -0.0962,
        // parabolas are exact: rounding of places
        tolerance: Tolerance::Absolute(1e-12),
        ..MOULDED
    },
    Case {
        id: "rod_stays_moulded",
        what: "how far it is drawn out in the end, when the load is gone since 0.2995 s",
        // ½ a t² + (a t)²/(2 b), a = 4.81 m/s², b = (20 − 9.81) m/s²
        reference: -0.317_560_011_653_581_9,
        // it stops within a step: of (a + b) h²/4
        tolerance: Tolerance::Absolute(4e-6),
        ..MOULDED
    },
    Case {
        id: "rod_holds_below_limit",
        what: "how far another is drawn out, whose load it bears",
        reading: Reading::component("held", 1),
        reference: 0.0,
        // 1e-12 of half a metre at both ends
        tolerance: Tolerance::Absolute(1e-12),
        mutation: "networks.held.constraints[0].yields_at=19.8",
        ..MOULDED
    },
    Case {
        id: "braced_truss_hinges",
        what: "velocity of the tip of a truss braced twice after a step: its root is a hinge of two rods that yield about the middle of its bay",
        // h (2.5 P − 3) 2.5/Σ m r², Σ m r² = (0.5 + 2.5 + 6.5) · 2
        reference: -30.0 / 19.0 * 1e-3,
        // the truss turns by h² α/1 = 1e-6 in the step, and forces of its rods with it
        tolerance: Tolerance::Relative(1e-5),
        ..BRACED
    },
    Case {
        id: "braced_truss_holds",
        what: "how far the tip of another sinks in half a second, whose root bears its load",
        reading: Reading::component("held", 1),
        reference: 0.0,
        // three bays of rods that hold to 1e-12 of three metres
        tolerance: Tolerance::Absolute(1e-10),
        mutation: "networks.held.loads[0].force=[0, -1.3, 0]",
        ..BRACED
    },
    Case {
        id: "legs_are_crushed",
        what: "how far a table that is thrown at a floor crushes its legs",
        // h Σ (v − n h (Y/m − g)), of n from 1 to 50: v²/2 over Y/m − g but for v h/2
        reference: -0.0245,
        // feet enter the floor by 1e-7 of the 0.3 mm that legs and weight would push them in a step, fifty times at most
        tolerance: Tolerance::Absolute(1.5e-9),
        ..CRUSHED
    },
    Case {
        id: "crushed_legs_take_energy",
        what: "what is given off by that, the work of four legs",
        reading: Reading::last("given_off"),
        // 4 Y · 24.5 mm
        reference: 2.94,
        // as above, times 4 Y
        tolerance: Tolerance::Absolute(2e-7),
        ..CRUSHED
    },
    Case {
        id: "crushed_landing_stops",
        what: "height at which a weight rests that is thrown at a floor on two oblique legs which give way",
        // 2 Y δ = ½ m (v² + 2 g d) + m g (H − y), y² = (L − δ)² − a²
        reference: 0.762_165_360_267_224_6,
        // it lands within a step, v h, and is braked before it moves in each, v h/2, by 1.4 times what stops it: its weight is the rest
        tolerance: Tolerance::Absolute(9.5e-4),
        ..LANDED
    },
    Case {
        id: "crushed_landing_is_borne",
        what: "what the floor bears of that when it rests",
        reading: Reading::component("lander_borne", 1),
        reference: 22.0,
        // gaps to 1e-7 of what legs would push feet of 0.1 kg in a step, by which 2.2 kg are held: 1e-7 · 11 N/0.1 kg · 2.2 kg
        tolerance: Tolerance::Absolute(2.5e-5),
        mutation: "networks.lander.masses.weight.mass=2.01",
        ..LANDED
    },
    Case {
        id: "crushed_frame_is_borne",
        what: "what the floor bears of a frame braced twice that has landed on a corner",
        reading: Reading::component("frame_borne", 1),
        reference: 40.0,
        // likewise
        tolerance: Tolerance::Relative(1e-6),
        mutation: "networks.frame.masses.joints.mass=0.501",
        ..LANDED
    },
    Case {
        id: "crushed_landing_rests",
        what: "kinetic energy that is left of both",
        reading: Reading::last("moving"),
        reference: 1e-9,
        tolerance: Tolerance::AtMost,
        // the frame still falls over then
        mutation: r#"run.duration="1.5 s""#,
        ..LANDED
    },
    Case {
        id: "led_wire_flows",
        what: "what is given off within a step by a wire whose ends are both led, and by one that brakes a mass",
        // Y v h, and 20 h (4 − 10 h) to second order
        reference: 7.0 * 0.2e-3 + 20.0 * (4e-3 - 10e-6),
        // parabolas are exact: rounding of places times 20 N
        tolerance: Tolerance::Absolute(1e-12),
        ..DRAWN
    },
    Case {
        id: "heat_is_work_of_flow",
        what: "what both have given off in the end: the work of the hand, and all energy of the mass",
        reading: Reading::last("given_off"),
        reference: 8.7,
        // the mass stops within a step: Y a h²/2
        tolerance: Tolerance::Absolute(2e-4),
        mutation: r#"networks.thrown.start.velocity=["4.001 * x", 0, 0]"#,
        ..DRAWN
    },
];
