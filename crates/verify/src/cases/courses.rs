//! Laws of links along a course on the rheometer, reading by reading: characteristics point by point, automata at each change
//! of state, and what plastic links remember.

use super::rheometer::{PLASTIC, PULL};
use crate::{Case, Reading, Tolerance};

/// Rows that differ in what they are led to.
macro_rules! courses {
    ($base:expr; $($name:literal, $capabilities:expr, $what:literal, $settings:expr, $source:literal { $($after:literal -> $pull:literal unless $mutation:expr;)+ })+) => {
        &[$($(
            Case {
                id: concat!($name, "_", $after),
                capabilities: $capabilities,
                what: concat!($what, ", after ", $after, " steps"),
                settings: $settings,
                reading: PULL.after($after),
                reference: $pull,
                source: $source,
                mutation: $mutation,
                ..$base
            }
        ),+),+]
    };
}

/// A characteristic led to a length in one step, from a metre.
macro_rules! lengths {
    ($law:expr, $capabilities:expr, $what:literal, $source:literal, $mutation:expr, $tolerance:expr; $($id:literal at $length:literal, $offset:literal: $pull:expr;)+) => {
        &[$(
            Case {
                id: $id,
                capabilities: $capabilities,
                what: concat!($what, " at ", $length, " m"),
                settings: &[
                    $law,
                    concat!("networks.sample.pins[0].motion={ times = [0, 0.01], offsets = [[0, 0, 0], [", $offset, ", 0, 0]] }"),
                ],
                reading: PULL.after(2),
                reference: $pull,
                tolerance: $tolerance,
                source: $source,
                mutation: $mutation,
                ..PLASTIC
            }
        ),+]
    };
}

const FOUR_PIECES: &str = r#"networks.sample.links[0].law={ name = "piecewise_linear", thresholds = [0.9, 1.2, 1.6], slopes = [-10, -2, 1, 0], zero = 0 }"#;
const THREE_PIECES: &str = r#"networks.sample.links[0].law={ name = "cohesion", distance = 1, peak = 1.1, range = 1.5, cohesion = 1000 }"#;

/// The values of the specification's example but that at 1.4 m, which `piecewise_value` has; a push is a pull below zero.
pub(super) const MULTI_LINEAR: &[Case] = lengths!(
    FOUR_PIECES, &["JIM-17", "JIM-16"], "a characteristic of four pieces", "specification §2.8.3: values of the example",
    "networks.sample.links[0].law.zero=0.001", Tolerance::Absolute(1e-12);
    "piecewise_at_05" at "0.5", "0.5": 5.0;
    "piecewise_at_09" at "0.9", "0.1": 9.0;
    "piecewise_at_1" at "1", "0": 9.2;
    "piecewise_at_12" at "1.2", "-0.2": 9.6;
    "piecewise_at_16" at "1.6", "-0.6": 9.2;
    "piecewise_at_2" at "2", "-1": 9.2;
);

/// Along an axis, where the force of no length has a direction.
pub(super) const MULTI_LINEAR_AT_ZERO: &[Case] = lengths!(
    r#"networks.sample.links[0]={ law = { name = "piecewise_linear", thresholds = [0.9, 1.2, 1.6], slopes = [-10, -2, 1, 0], zero = 0 }, of = ["hold", "lead"], all = true, along = [1, 0, 0] }"#,
    &["JIM-17", "JIM-16"], "a characteristic of four pieces along an axis", "specification §2.8.3: values of the example",
    "networks.sample.links[0].law.zero=0.001", Tolerance::Absolute(1e-12);
    "piecewise_at_0" at "0", "1": 0.0;
);

/// Cohesion whose repulsion is as stiff as its attraction: three pieces, not four.
pub(super) const COHESION: &[Case] = lengths!(
    THREE_PIECES, &["JIM-25"], "cohesion of three pieces, as stiff when pushed as when pulled,", "specification §2.10: the three-piece form omits S1",
    // places of a metre, rounding times k
    "networks.sample.links[0].law.distance=1.001", Tolerance::Absolute(1e-11);
    "three_pieces_push" at "0.9", "0.1": -100.0;
    "three_pieces_rest" at "1", "0": 0.0;
    "three_pieces_strongest" at "1.1", "-0.1": 100.0;
    "three_pieces_fade" at "1.3", "-0.3": 50.0;
);

pub(super) const COHESION_ENDS: &[Case] = lengths!(
    THREE_PIECES, &["JIM-25"], "cohesion of three pieces, as stiff when pushed as when pulled,", "specification §2.10: the three-piece form omits S1",
    "networks.sample.links[0].law.range=2.1", Tolerance::Absolute(1e-11);
    "three_pieces_end" at "1.5", "-0.5": 0.0;
    "three_pieces_are_gone" at "2", "-1": 0.0;
);

/// Pulls of the family's members a micrometre from rest.
macro_rules! stiffness_at_rest {
    ($($exponent:literal: $stiffness:literal;)+) => {
        &[$(
            Case {
                id: concat!("lennard_jones_stiffness_", $exponent),
                capabilities: &["JIM-25"],
                what: concat!("pull of the family's member n = ", $exponent, " a micrometre from rest: 2 n² E0/r0² of it"),
                settings: &[
                    concat!(r#"networks.sample.links[0].law={ name = "lennard_jones", depth = 1, distance = 1, exponent = "#, $exponent, " }"),
                    "networks.sample.pins[0].motion={ times = [0, 0.01], offsets = [[0, 0, 0], [-1e-6, 0, 0]] }",
                ],
                reading: PULL.after(2),
                reference: 1e-6 * $stiffness,
                // it softens: φ'' d/(2 φ') = 3 (n + 1) d/2, and rounding of a metre over a micrometre
                tolerance: Tolerance::Relative(1.5e-6 * ($exponent as f64 + 1.0) + 1e-9),
                source: "specification §2.10: stiffness of the table",
                mutation: "networks.sample.links[0].law.depth=1.001",
                ..PLASTIC
            }
        ),+]
    };
}

pub(super) const STIFFNESS_AT_REST: &[Case] = stiffness_at_rest!(
    1: 2.0;
    2: 8.0;
    3: 18.0;
    4: 32.0;
    6: 72.0;
    8: 128.0;
    12: 288.0;
);

const SATURATES: &[&str] = &[
    r#"networks.sample.links[0].law={ name = "piecewise_linear", thresholds = [0.985, 1.02], slopes = [0, -500, 0], zero = 1 }"#,
];
const CUBIC: &[&str] = &[
    r#"networks.sample.links[0].law={ name = "formula", push = "-k * (D - L0)^3", parameters = { k = "1e6" } }"#,
];
const ON_OR_OFF: &[&str] = &[
    r#"networks.sample.links[0].law={ name = "formula", push = "-F * if(D > L0, 1, 0)", parameters = { F = 5 } }"#,
];
const PLUS_OR_MINUS: &[&str] = &[
    r#"networks.sample.links[0].law={ name = "formula", push = "F * (if(D < L0, 1, 0) - if(D > L0, 1, 0))", parameters = { F = 5 } }"#,
];

const FEWER_SLOPES: &str = "networks.sample.links[0].law.slopes=[0, -501, 0]";
const FORCE_OF_RELAY: &str = "networks.sample.links[0].law.parameters.F=6";
const CUBES: &str = "networks.sample.links[0].law.parameters.k=1000001";

/// What a plastic link has come to: led back to its rest length S it bears nothing; beyond S + S1 by 10 mm it bears
/// k S1 + B 10 mm, and short of S + S2 by as much k S2 - B 10 mm.
macro_rules! remembers {
    ($($after:literal, $length:literal, $next:literal: $back:expr, $beyond:expr => $pulled:literal, $short:expr => $pushed:literal unless $mutation:literal;)+) => {
        &[$(
            Case {
                id: concat!("plastic_rest_", $after),
                what: concat!("a plastic link that was led to ", $length, " m on its course, then to its rest length: nothing"),
                settings: &[$back],
                reading: PULL.after($next),
                reference: 0.0,
                mutation: $mutation,
                ..REMEMBERED
            },
            Case {
                id: concat!("plastic_traction_", $after),
                what: concat!("the same, of ", $length, " m, 10 mm beyond where it yields"),
                settings: &[$beyond],
                reading: PULL.after($next),
                reference: $pulled,
                ..REMEMBERED
            },
            Case {
                id: concat!("plastic_compression_", $after),
                what: concat!("the same, of ", $length, " m, 10 mm short of where it yields when pushed"),
                settings: &[$short],
                reading: PULL.after($next),
                reference: $pushed,
                ..REMEMBERED
            },
        )+]
    };
}

/// Where the course goes after a step.
macro_rules! then {
    ($next:literal, $offset:literal) => {
        concat!("networks.sample.pins[0].motion.offsets[", $next, "]=[", $offset, ", 0, 0]")
    };
}

/// The whole course, and where it goes then.
macro_rules! at_last {
    ($offset:literal) => {
        concat!(
            "networks.sample.pins[0].motion={ times = [0, 0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07, 0.08, 0.09, 0.10, 0.11, 0.12, 0.13, 0.14, 0.15, 0.16, 0.17], ",
            "offsets = [[0, 0, 0], [-0.005, 0, 0], [-0.010, 0, 0], [-0.015, 0, 0], [-0.020, 0, 0], [-0.030, 0, 0], [-0.025, 0, 0], [-0.020, 0, 0], [-0.015, 0, 0], ",
            "[-0.010, 0, 0], [0, 0, 0], [0.010, 0, 0], [0.020, 0, 0], [0.010, 0, 0], [0, 0, 0], [-0.010, 0, 0], [-0.030, 0, 0], [", $offset, ", 0, 0]] }"
        )
    };
}

const REMEMBERED: Case = Case {
    capabilities: &["JIM-50", "JIM-18"],
    source: "specification §8.1, elasto-plastic with hardening: S, S1 and S2 after",
    mutation: "networks.sample.links[0].law.hardening=251",
    ..PLASTIC
};

pub(super) const REMEMBERS: &[Case] = remembers!(
    2, "1.010", 3: then!(3, "0"), then!(3, "-0.02") => 12.0, then!(3, "0.02") => -12.0 unless "networks.sample.links[0].law.traction=9.9";
    3, "1.015", 4: then!(4, "-0.004"), then!(4, "-0.025") => 13.0, then!(4, "0.016") => -12.0 unless "networks.sample.links[0].law.hardening=251";
    4, "1.020", 5: then!(5, "-0.008"), then!(5, "-0.03") => 14.0, then!(5, "0.012") => -12.0 unless "networks.sample.links[0].law.hardening=251";
    5, "1.030", 6: then!(6, "-0.016"), then!(6, "-0.04") => 16.0, then!(6, "0.004") => -12.0 unless "networks.sample.links[0].law.hardening=251";
    9, "1.030 and 1.010", 10: then!(10, "-0.016"), then!(10, "-0.04") => 16.0, then!(10, "0.004") => -12.0 unless "networks.sample.links[0].law.hardening=251";
    10, "1.030 and 1.000", 11: then!(11, "-0.0112"), then!(11, "-0.0352") => 16.0, then!(11, "0.01") => -13.2 unless "networks.sample.links[0].law.hardening=251";
    11, "1.030 and 0.990", 12: then!(12, "-0.0032"), then!(12, "-0.0272") => 16.0, then!(12, "0.02") => -15.2 unless "networks.sample.links[0].law.hardening=251";
    12, "1.030 and 0.980", 13: then!(13, "0.0048"), then!(13, "-0.0192") => 16.0, then!(13, "0.03") => -17.2 unless "networks.sample.links[0].law.hardening=251";
    14, "0.980 and 1.000", 15: then!(15, "0.0048"), then!(15, "-0.0192") => 16.0, then!(15, "0.03") => -17.2 unless "networks.sample.links[0].law.hardening=251";
    15, "0.980 and 1.010", 16: then!(16, "0.00416"), then!(16, "-0.02") => 16.16, then!(16, "0.02936") => -17.2 unless "networks.sample.links[0].law.hardening=251";
    16, "0.980 and 1.030", 17: at_last!("-0.01184"), at_last!("-0.04") => 20.16, at_last!("0.01336") => -17.2 unless "networks.sample.links[0].law.hardening=251";
);

const BOTH_ALIKE: &[&str] = &["networks.sample.links[0].law.mode=isotropic"];
const MOVING_RANGE: &[&str] = &["networks.sample.links[0].law.mode=kinematic"];
const INDEPENDENT: &str = "networks.sample.links[0].law.mode=independent";

/// A spring of 0.975 of 4 M, the stiffest that a free mass bears.
const RIGID: &str = r#"networks.sample.links[0].law={ name = "elasto_plastic", stiffness = 39000, hardening = 250, traction = 10 }"#;
const RIGID_PLASTIC: Case = Case {
    capabilities: &["JIM-50"],
    settings: &[RIGID],
    source: "specification §2.15.3: rigid-plastic is k as large as stability allows",
    ..PLASTIC
};

pub(super) const RIGID_PLASTICITY: &[Case] = &[
    Case {
        id: "rigid_plastic_yields",
        what: "a plastic link as stiff as stability allows, k = 0.975 of 4 m/Te², pulled by 30 mm: Qe + k' q, as a slider beside a spring",
        reference: 17.5,
        // k'/(k + k') of it: its spring gives
        tolerance: Tolerance::Relative(250.0 / 39_250.0),
        mutation: "networks.sample.links[0].law.stiffness=1000",
        ..RIGID_PLASTIC
    },
    Case {
        id: "rigid_plastic_is_pushed",
        what: "the same 5 mm back: pushed at once, -Qe - k' 5 mm",
        reading: PULL.after(6),
        reference: -11.25,
        // k' times what its spring gives from the one threshold to the other, and k'/(k + k')
        tolerance: Tolerance::Absolute(250.0 * (17.5 + 11.25) / 39_000.0 + 11.25 * 250.0 / 39_250.0),
        mutation: "networks.sample.links[0].law.stiffness=1000",
        ..RIGID_PLASTIC
    },
    Case {
        id: "rigid_plastic_holds",
        what: "elongation of the same when it hangs by itself from a force that rises to 0.98 of its threshold within a second: Q/k, a quarter of a millimetre",
        settings: &[RIGID, "networks.sample.pins=[]", FORCE_BELOW_THRESHOLD],
        reading: Reading::component("stretch", 0).after(600),
        reference: -9.8 / 39_000.0,
        // what swings where the force begins and ceases to rise: 2 6 Q/(T² m ω² k), ω² = k/m, greater by 1/√(1 - 0.975) so near to the edge of stability
        tolerance: Tolerance::Absolute(12.0 * 9.8 / (39_000.0 * 39_000.0) * 6.4),
        mutation: "networks.sample.links[0].law.traction=9.7",
        ..RIGID_PLASTIC
    },
];

const FORCE_BELOW_THRESHOLD: &str = r#"networks.sample.loads=[{ region = "lead", force = ["-9.8 * min(t, 1)^2 * (3 - 2 * min(t, 1))", 0, 0] }]"#;

const STOP: &[&str] = &[
    r#"networks.sample.links[0].law={ name = "conditional", stiffness = 0, states = { away = "CHK, 0; CHZ, 0; INF, D, 0.995 -> in", in = "CHK, 1000; SUP, D, 0.995 -> away" } }"#,
];
const FRACTURE: &[&str] = &[
    r#"networks.sample.links[0].law={ name = "conditional", stiffness = 1000, states = { whole = "SUP, L, 0.021 -> torn", torn = "CHK, 0; CHZ, 0" } }"#,
];
const GLUE: &[&str] = &[
    r#"networks.sample.links[0].law={ name = "conditional", states = { free = "INF, D, 0.985 -> held", held = "L0=D; CHK, 1000" } }"#,
];
const GLUE_AGAIN: &[&str] = &[
    r#"networks.sample.links[0].law={ name = "conditional", states = { free = "CHK, 0; INF, D, 0.985 -> held", held = "L0=D; CHK, 1000; SUP, L, 0.025 -> free" } }"#,
    // pressed together a second time, nearer, and drawn again
    "networks.sample.pins[0].motion={ times = [0, 0.10, 0.12, 0.14, 0.15, 0.16, 0.17, 0.18, 0.19], offsets = [[0, 0, 0], [0, 0, 0], [0.020, 0, 0], [0, 0, 0], [-0.010, 0, 0], [-0.030, 0, 0], [0.030, 0, 0], [0.010, 0, 0], [0, 0, 0]] }",
];
const PLECTRUM: &[&str] = &[
    r#"networks.sample.links[0].law={ name = "conditional", stiffness = 1000, states = { held = "CHK, 1000; SUP, L, 0.021 -> gone", gone = "CHK, 0; CHS, L -> held" } }"#,
];
const STEPS: &[&str] = &[
    r#"networks.sample.links[0].law={ name = "conditional", stiffness = 1000, states = { firm = "SUP, L, 0.0125 -> slip", slip = "L0=D; ANY -> firm" } }"#,
];
const COMMANDED: &[&str] = &[
    r#"networks.sample.links[0].law={ name = "conditional", external = "if(t > 0.055 and t < 0.065 or t > 0.095 and t < 0.105, 1, 0)", states = { open = "CHK, 0; CDX -> shut", shut = "L0=D; CHK, 1000; CDX -> open" } }"#,
];
const ONE_WAY: &[&str] = &[
    r#"networks.sample.links[0].law={ name = "conditional", damping = 100, states = { brakes = "DIM, D -> free", free = "VN; AUG, D -> brakes" } }"#,
];
const BOTH_HOLD: &[&str] = &[
    r#"networks.sample.links[0].law={ name = "conditional", states = { a = "SUP, D, 1.001 -> b; SUP, L, 0.001 -> c", b = "CHK, 100", c = "CHK, 200" } }"#,
];

pub(super) const CASES: &[Case] = courses! { PLASTIC;
    "saturation", &["JIM-16", "JIM-17"], "a characteristic of 500 N/m that saturates at 0.985 m and at 1.02 m", SATURATES, "EXP-53: sampled curves match; specification §2.8.2, saturation" {
        2 -> 5.0 unless FEWER_SLOPES;
        4 -> 10.0 unless FEWER_SLOPES;
        5 -> 10.0 unless FEWER_SLOPES;
        11 -> -5.0 unless FEWER_SLOPES;
        12 -> -7.5 unless FEWER_SLOPES;
    }
    "cubic", &["JIM-16"], "a spring whose force grows with the third power", CUBIC, "EXP-53: sampled curves match; specification §2.8.2, curvature" {
        2 -> 1.0 unless CUBES;
        3 -> 3.375 unless CUBES;
        4 -> 8.0 unless CUBES;
        5 -> 27.0 unless CUBES;
        11 -> -1.0 unless CUBES;
    }
    "relay_on_or_off", &["JIM-16"], "all or nothing: 5 N beyond a metre", ON_OR_OFF, "EXP-53: specification §2.8.2, all or nothing" {
        1 -> 5.0 unless FORCE_OF_RELAY;
        5 -> 5.0 unless FORCE_OF_RELAY;
        11 -> 0.0 unless "networks.sample.links[0].law.push=-F * if(D > 0.985, 1, 0)";
    }
    "relay_plus_or_minus", &["JIM-16"], "plus or minus: 5 N beyond a metre, and 5 N the other way below", PLUS_OR_MINUS, "EXP-53: specification §2.8.2, plus or minus" {
        1 -> 5.0 unless FORCE_OF_RELAY;
        5 -> 5.0 unless FORCE_OF_RELAY;
        11 -> -5.0 unless FORCE_OF_RELAY;
        15 -> 5.0 unless FORCE_OF_RELAY;
    }
    "plastic_isotropic", &["JIM-50"], "a plastic link that hardens both ways alike, on the course of the table", BOTH_ALIKE, "specification §2.15.2: |S2| := S1; its recursion by hand" {
        10 -> -14.4 unless INDEPENDENT;
        12 -> -18.4 unless INDEPENDENT;
        15 -> 11.6 unless INDEPENDENT;
        16 -> 21.04 unless INDEPENDENT;
    }
    "plastic_kinematic", &["JIM-50"], "a plastic link whose elastic range moves as a whole, on the course of the table", MOVING_RANGE, "specification §2.15.2: S2 += dS1, what the slider beside a spring really does; its recursion by hand" {
        10 -> -8.0 unless INDEPENDENT;
        12 -> -12.0 unless INDEPENDENT;
        15 -> 10.0 unless INDEPENDENT;
        16 -> 14.0 unless INDEPENDENT;
    }
    "words_stop", &["JIM-10"], "a stop below 0.995 m on its course: away, in, in, away", STOP, "EXP-54: sequence of states, collision" {
        9 -> 0.0 unless "networks.sample.links[0].law.states.away=INF, D, 1.012 -> in";
        11 -> -10.0 unless "networks.sample.links[0].law.states.away=CHK, 0; CHZ, 0; INF, D, 0.985 -> in";
        13 -> -10.0 unless "networks.sample.links[0].law.states.in=CHK, 1000; SUP, D, 0.985 -> away";
        15 -> 0.0 unless "networks.sample.links[0].law.states.in=CHK, 1000; SUP, D, 1.012 -> away";
    }
    "words_fracture", &["JIM-10"], "a spring that tears beyond 21 mm on its course: whole, torn, torn", FRACTURE, "EXP-54: sequence of states, fracture" {
        4 -> 20.0 unless "networks.sample.links[0].law.states.whole=SUP, L, 0.019 -> torn";
        5 -> 0.0 unless "networks.sample.links[0].law.states.whole=SUP, L, 0.031 -> torn";
        12 -> 0.0 unless "networks.sample.links[0].law.states.torn=CHZ, 0";
    }
    "words_glue", &["JIM-10"], "glue that takes hold below 0.985 m on its course: free, held with the length of that moment, held", GLUE, "EXP-54: sequence of states, gluing" {
        11 -> 0.0 unless "networks.sample.links[0].law.states.free=INF, D, 1.005 -> held";
        12 -> 0.0 unless "networks.sample.links[0].law.states.held=CHK, 1000";
        13 -> 10.0 unless "networks.sample.links[0].law.states.held=L0=D; CHK, 1001";
    }
    "words_glue_again", &["JIM-10"], "glue that breaks at 25 mm and takes hold again: free, held, held, free, held at 0.97 m, held", GLUE_AGAIN, "EXP-54: sequence of states, break and re-glue" {
        11 -> 0.0 unless "networks.sample.links[0].law.states.free=CHK, 0; INF, D, 1.005 -> held";
        14 -> 20.0 unless "networks.sample.links[0].law.states.held=L0=D; CHK, 1000; SUP, L, 0.015 -> free";
        16 -> 0.0 unless "networks.sample.links[0].law.states.held=L0=D; CHK, 1000; SUP, L, 0.055 -> free";
        17 -> 0.0 unless "networks.sample.links[0].law.states.held=CHK, 1000; SUP, L, 0.025 -> free";
        18 -> 20.0 unless "networks.sample.links[0].law.states.held=L0=D; CHK, 1000; SUP, L, 0.055 -> free";
    }
    "words_plectrum", &["JIM-10"], "a plectrum on its course: held, gone beyond 21 mm, gone, held again from where the string has swung through, held, gone", PLECTRUM, "EXP-54: sequence of states, plectrum" {
        4 -> 20.0 unless "networks.sample.links[0].law.states.held=CHK, 1000; SUP, L, 0.019 -> gone";
        5 -> 0.0 unless "networks.sample.links[0].law.states.held=CHK, 1000; SUP, L, 0.031 -> gone";
        9 -> 0.0 unless "networks.sample.links[0].law.states.gone=CHK, 0; DIM, L -> held";
        12 -> -20.0 unless "networks.sample.links[0].law.states.gone=CHK, 0";
        16 -> 0.0 unless "networks.sample.links[0].law.states.held=CHK, 1000; SUP, L, 0.031 -> gone";
    }
    "words_step_plasticity", &["JIM-10"], "step plasticity on its course: firm, slipped at 1.015 m, firm, slipped at 1.03 m", STEPS, "EXP-54: sequence of states, step plasticity" {
        2 -> 10.0 unless "networks.sample.links[0].law.states.firm=SUP, L, 0.008 -> slip";
        3 -> 0.0 unless "networks.sample.links[0].law.states.firm=SUP, L, 0.0175 -> slip";
        4 -> 5.0 unless "networks.sample.links[0].law.states.firm=SUP, L, 0.0175 -> slip";
        5 -> 0.0 unless "networks.sample.links[0].law.states.slip=L0=D";
    }
    "words_grip", &["JIM-10"], "a grip that is told to close at 60 ms and to open at 100 ms: open, shut at 1.025 m, shut, open, open", COMMANDED, "EXP-54: sequence of states, grip on command" {
        5 -> 0.0 unless "networks.sample.links[0].law.external=if(t > 0.025 and t < 0.035, 1, 0)";
        6 -> 0.0 unless "networks.sample.links[0].law.states.shut=CHK, 1000";
        9 -> -15.0 unless "networks.sample.links[0].law.external=if(t > 0.065 and t < 0.075 or t > 0.095 and t < 0.105, 1, 0)";
        10 -> 0.0 unless "networks.sample.links[0].law.states.shut=L0=D; CHK, 1000";
        12 -> 0.0 unless "networks.sample.links[0].law.states.shut=L0=D; CHK, 1000";
    }
    "words_one_way_damper", &["JIM-10"], "a damper that works one way on its course, in the midst of each way: brakes, free on the way back, free, brakes", ONE_WAY, "EXP-54: sequence of states, one-way damper" {
        3 -> 50.0 unless "networks.sample.links[0].law.damping=101";
        7 -> 0.0 unless "networks.sample.links[0].law.states.free=AUG, D -> brakes";
        11 -> 0.0 unless "networks.sample.links[0].law.states.free=AUG, D -> brakes";
        13 -> 100.0 unless "networks.sample.links[0].law.states.free=VN";
    }
    "words_last_condition_wins", &["JIM-10", "JIM-19"], "of two conditions of the conditional link that hold the one written last leads on: 200 N/m, not 100", BOTH_HOLD, "specification §2.7: if several hold, the last one met wins" {
        1 -> 1.0 unless "networks.sample.links[0].law.states.a=SUP, L, 0.001 -> c; SUP, D, 1.001 -> b";
    }
};
