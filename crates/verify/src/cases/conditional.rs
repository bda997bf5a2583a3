//! The conditional link in the words of its source: the eight recipes on the rheometer; relays; and controls that switch.

use super::network::OSCILLATOR;
use crate::{Case, Reading, Tolerance};

pub(super) const PULL: Reading = Reading::component("pull", 0);

pub(super) const WORDS: Case = Case {
    capabilities: &["JIM-10"],
    scene: "rheometer",
    // places are decimals, rounding times k
    tolerance: Tolerance::Absolute(1e-9),
    ..OSCILLATOR
};

/// On beyond an edge of its dead zone, either way, and off again nearer to the middle.
const THREE_WAY_RELAY: &str = r#"networks.sample.links[0].law={ name = "finite_state", states = { off = "0", pulls = "-5", pushes = "5" }, transitions = { "off -> pulls" = "D - L0 > 0.012", "pulls -> off" = "D - L0 < 0.003", "off -> pushes" = "D - L0 < -0.012", "pushes -> off" = "D - L0 > -0.003" } }"#;

const SWITCHED: Case = Case {
    capabilities: &["JIM-13"],
    scene: "network_switched",
    tolerance: Tolerance::Relative(1e-12),
    source: "EXP-57: v' = v - Te k x/m, x' = x + Te v' with k as it is driven",
    mutation: "networks.driven.masses.bob.mass=1.001",
    ..OSCILLATOR
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "words_stop",
        capabilities: &["JIM-10", "JIM-11"],
        what: "a stop in the words of the source: inside 0.995 m only, -k (0.98 - 1)",
        settings: &[
            r#"networks.sample.links[0].law={ name = "conditional", stiffness = 0, states = { away = "CHK, 0; CHZ, 0; INF, D, 0.995 -> in", in = "CHK, 1000; SUP, D, 0.995 -> away" } }"#,
        ],
        reading: PULL.after(12),
        reference: -20.0,
        source: "specification §2.7: collision",
        mutation: "networks.sample.links[0].law.states.away=CHK, 0; INF, D, 0.97 -> in",
        ..WORDS
    },
    Case {
        id: "words_fracture",
        what: "fracture: torn beyond 21 mm it pulls no more",
        settings: &[
            r#"networks.sample.links[0].law={ name = "conditional", stiffness = 1000, states = { whole = "SUP, L, 0.021 -> torn", torn = "CHK, 0; CHZ, 0" } }"#,
        ],
        reading: PULL.after(16),
        reference: 0.0,
        source: "specification §2.7: fracture",
        mutation: "networks.sample.links[0].law.states.torn=CHZ, 0",
        ..WORDS
    },
    Case {
        id: "words_glue",
        what: "glue: joined below 0.985 m with the length of that moment, k (1.03 - 0.98)",
        settings: &[
            r#"networks.sample.links[0].law={ name = "conditional", states = { free = "INF, D, 0.985 -> held", held = "L0=D; CHK, 1000" } }"#,
        ],
        reading: PULL.after(16),
        reference: 50.0,
        source: "specification §2.7: gluing",
        mutation: "networks.sample.links[0].law.states.held=CHK, 1000",
        ..WORDS
    },
    Case {
        id: "words_place",
        what: "glue that takes hold where the led end has come beyond -0.985 m, k (1.03 - 0.98)",
        settings: &[
            r#"networks.sample.links[0].law={ name = "conditional", states = { free = "SUP, X2.x, -0.985 -> held", held = "L0=D; CHK, 1000" } }"#,
        ],
        reading: PULL.after(16),
        reference: 50.0,
        source: "specification §2.7: X1 and X2 are inputs of conditions",
        mutation: "networks.sample.links[0].law.states.free=SUP, X1.x, -0.985 -> held",
        ..WORDS
    },
    Case {
        id: "words_place_on_axis",
        what: "the same of links along an axis",
        settings: &[
            "networks.sample.links[0].along=[1, 0, 0]",
            r#"networks.sample.links[0].law={ name = "conditional", states = { free = "SUP, X2, -0.985 -> held", held = "L0=D; CHK, 1000" } }"#,
        ],
        reading: PULL.after(16),
        reference: 50.0,
        source: "specification §2.7: X1 and X2 are inputs of conditions",
        mutation: "networks.sample.links[0].law.states.free=AUG, X2 -> held",
        ..WORDS
    },
    Case {
        id: "words_glue_holds",
        what: "glue that breaks again: at 20 mm it holds",
        settings: &[
            r#"networks.sample.links[0].law={ name = "conditional", states = { free = "CHK, 0; INF, D, 0.985 -> held", held = "L0=D; CHK, 1000; SUP, L, 0.025 -> free" } }"#,
        ],
        reading: PULL.after(14),
        reference: 20.0,
        source: "specification §2.7: break and re-glue",
        mutation: "networks.sample.links[0].law.states.held=L0=D; CHK, 1000; SUP, L, 0.015 -> free",
        ..WORDS
    },
    Case {
        id: "words_glue_breaks",
        what: "the same at 30 mm has let go",
        settings: &[
            r#"networks.sample.links[0].law={ name = "conditional", states = { free = "CHK, 0; INF, D, 0.985 -> held", held = "L0=D; CHK, 1000; SUP, L, 0.025 -> free" } }"#,
        ],
        reading: PULL.after(15),
        reference: 0.0,
        source: "specification §2.7: break and re-glue",
        mutation: "networks.sample.links[0].law.states.held=L0=D; CHK, 1000; SUP, L, 0.035 -> free",
        ..WORDS
    },
    Case {
        id: "words_plectrum",
        what: "a plectrum: let go at 21 mm, it takes hold when the string swings through, and pushes at 0.99 m",
        settings: &[
            r#"networks.sample.links[0].law={ name = "conditional", stiffness = 1000, states = { held = "CHK, 1000; SUP, L, 0.021 -> gone", gone = "CHK, 0; CHS, L -> held" } }"#,
        ],
        reading: PULL.after(11),
        reference: -10.0,
        source: "specification §2.7: plectrum",
        mutation: "networks.sample.links[0].law.states.gone=CHK, 0",
        ..WORDS
    },
    Case {
        id: "words_step_plasticity",
        what: "step plasticity: past 12.5 mm the rest length jumps to the present one, twice",
        settings: &[
            r#"networks.sample.links[0].law={ name = "conditional", stiffness = 1000, states = { firm = "SUP, L, 0.0125 -> slip", slip = "L0=D; ANY -> firm" } }"#,
        ],
        reading: PULL.after(6),
        reference: -5.0,
        source: "specification §2.7: step plasticity",
        mutation: "networks.sample.links[0].law.states.firm=SUP, L, 0.0175 -> slip",
        ..WORDS
    },
    Case {
        id: "words_grip",
        what: "a grip on command at 55 ms holds the length of that moment",
        settings: &[
            r#"networks.sample.links[0].law={ name = "conditional", external = "if(t > 0.055, 1, 0)", states = { open = "CHK, 0; CDX -> shut", shut = "L0=D; CHK, 1000" } }"#,
        ],
        reading: PULL.after(12),
        reference: -45.0,
        source: "specification §2.7: grip on command",
        mutation: "networks.sample.links[0].law.external=if(t > 0.065, 1, 0)",
        ..WORDS
    },
    Case {
        id: "words_one_way_damper",
        what: "a damper that works one way, pulled at 0.5 m/s: z 0.5 m/s",
        settings: &[
            r#"networks.sample.links[0].law={ name = "conditional", damping = 100, states = { brakes = "DIM, D -> free", free = "VN; AUG, D -> brakes" } }"#,
            "networks.sample.pins[0].motion={ times = [0, 1], offsets = [[0, 0, 0], [-0.5, 0, 0]] }",
        ],
        reading: PULL.after(50),
        reference: 50.0,
        source: "specification §2.7: one-way damper",
        mutation: "networks.sample.links[0].law.states.brakes=VN; DIM, D -> free",
        ..WORDS
    },
    Case {
        id: "words_one_way_damper_back",
        what: "the same pushed together gives nothing",
        settings: &[
            r#"networks.sample.links[0].law={ name = "conditional", damping = 100, states = { brakes = "DIM, D -> free", free = "VN; AUG, D -> brakes" } }"#,
            "networks.sample.pins[0].motion={ times = [0, 1], offsets = [[0, 0, 0], [0.5, 0, 0]] }",
        ],
        reading: PULL.after(50),
        reference: 0.0,
        source: "specification §2.7: one-way damper",
        mutation: "networks.sample.links[0].law.states.free=AUG, D -> brakes",
        ..WORDS
    },
    Case {
        id: "relay_with_dead_zone",
        capabilities: &["JIM-16"],
        what: "a relay with a dead zone of 12 mm: all or nothing, -5 N at -20 mm",
        settings: &[
            r#"networks.sample.links[0].law={ name = "formula", push = "F * (if(D - L0 < -zone, 1, 0) - if(D - L0 > zone, 1, 0))", parameters = { F = 5, zone = 0.012 } }"#,
        ],
        reading: PULL.after(12),
        reference: -5.0,
        source: "specification §2.8.2: plus or minus, with a dead zone",
        mutation: "networks.sample.links[0].law.parameters.zone=0.021",
        ..WORDS
    },
    Case {
        id: "relay_with_hysteresis",
        capabilities: &["JIM-16", "JIM-18"],
        what: "a relay that switches at 1.012 m and back at 0.995 m still pulls at 1 m on its way back",
        settings: &[
            r#"networks.sample.links[0].law={ name = "finite_state", states = { low = "5", high = "-5" }, transitions = { "low -> high" = "D > 1.012", "high -> low" = "D < 0.995" } }"#,
        ],
        reading: PULL.after(10),
        reference: 5.0,
        source: "specification §2.8.2: a loop needs memory",
        mutation: r#"networks.sample.links[0].law.transitions={ "low -> high" = "D > 1.012", "high -> low" = "D < 1.005" }"#,
        ..WORDS
    },
    Case {
        id: "three_way_relay_waits",
        capabilities: &["JIM-16", "JIM-18", "JIM-19"],
        what: "a relay with a dead zone and hysteresis, on from 12 mm either way and off again at 3 mm: at 10 mm on the way there nothing",
        settings: &[THREE_WAY_RELAY],
        reading: PULL.after(2),
        reference: 0.0,
        source: "specification §2.8.2: relay, dead zone and hysteresis",
        mutation: r#"networks.sample.links[0].law.transitions={ "off -> pulls" = "D - L0 > 0.009", "pulls -> off" = "D - L0 < 0.003", "off -> pushes" = "D - L0 < -0.012", "pushes -> off" = "D - L0 > -0.003" }"#,
        ..WORDS
    },
    Case {
        id: "three_way_relay_holds",
        capabilities: &["JIM-16", "JIM-18", "JIM-19"],
        what: "the same at 10 mm on the way back: 5 N still",
        settings: &[THREE_WAY_RELAY],
        reading: PULL.after(9),
        reference: 5.0,
        source: "specification §2.8.2: relay, dead zone and hysteresis",
        // without hysteresis
        mutation: r#"networks.sample.links[0].law.transitions={ "off -> pulls" = "D - L0 > 0.012", "pulls -> off" = "D - L0 < 0.012", "off -> pushes" = "D - L0 < -0.012", "pushes -> off" = "D - L0 > -0.003" }"#,
        ..WORDS
    },
    Case {
        id: "three_way_relay_pushes",
        capabilities: &["JIM-16", "JIM-18", "JIM-19"],
        what: "the same on the way back from -20 mm, at -10 mm: 5 N the other way",
        settings: &[THREE_WAY_RELAY],
        reading: PULL.after(13),
        reference: -5.0,
        source: "specification §2.8.2: relay, dead zone and hysteresis",
        mutation: r#"networks.sample.links[0].law.transitions={ "off -> pulls" = "D - L0 > 0.012", "pulls -> off" = "D - L0 < 0.003", "off -> pushes" = "D - L0 < -0.012", "pushes -> off" = "D - L0 > -0.012" }"#,
        ..WORDS
    },
    Case {
        id: "three_way_relay_is_dead_again",
        capabilities: &["JIM-16", "JIM-18", "JIM-19"],
        what: "and off again, at 10 mm on the way there for the second time, after it has pulled and pushed",
        settings: &[THREE_WAY_RELAY],
        reading: PULL.after(15),
        reference: 0.0,
        source: "specification §2.8.2: relay, dead zone and hysteresis",
        // a relay without a dead zone: from one side to the other
        mutation: r#"networks.sample.links[0].law.transitions={ "off -> pulls" = "D - L0 > 0.012", "pulls -> off" = "D - L0 < 0.003", "off -> pushes" = "D - L0 < -0.012", "pushes -> off" = "D - L0 > 0.012" }"#,
        ..WORDS
    },
    Case {
        id: "exponential_pieces_push",
        capabilities: &["JIM-24"],
        what: "an exponential stop by straight pieces within 0.5 N, 20 mm in: K d (e^2 - 1), and at most the error more",
        settings: &[
            r#"networks.sample.links[0].law={ name = "exponential_pieces", threshold = 1, stiffness = 1000, depth = 0.01, error = 0.5, deepest = 0.05 }"#,
        ],
        reading: PULL.after(12),
        // 10 (e^2 - 1) + 0.25
        reference: -64.140_560_989_306_5,
        tolerance: Tolerance::Absolute(0.25),
        source: "chords of a convex curve are above it",
        mutation: "networks.sample.links[0].law.stiffness=1020",
        ..WORDS
    },
    Case {
        id: "algorithmic_space",
        capabilities: &["JIM-8"],
        what: "the oscillator written with M = m/Te² and Z = z/Te: displacement after 60 steps",
        settings: &[
            "networks.oscillator.space=algorithmic",
            "networks.oscillator.masses.bob.mass=100",
            "networks.oscillator.links[0].law.damping=2",
        ],
        reference: -0.05081919363478367,
        mutation: "networks.oscillator.masses.bob.mass=100.01",
        ..OSCILLATOR
    },
    Case {
        id: "stiffened_spring",
        what: "a mass on a spring that is made four times as stiff after 20 steps, after 40",
        reading: Reading::last("driven").after(40),
        reference: 1.0 + 0.061_263_418_215_935_964,
        ..SWITCHED
    },
    Case {
        id: "cut_spring",
        what: "the same cut after 50 steps flies on, after 80",
        reading: Reading::last("driven").after(80),
        reference: 1.0 - 0.364_166_134_296_847_97,
        ..SWITCHED
    },
    Case {
        id: "stiffening_is_booked",
        what: "energy that the control has made which stiffened the spring, (400 - 100) N/m q²/2 where it stood: more than there was",
        // the other spring stays
        settings: &["networks.latched.controls.release.connects=\"previous > 0\""],
        reading: Reading::last("controls").after(40),
        // κ = 0.01 from q = 0.1 m at rest: q = -0.04624 m after 20 steps
        reference: 0.320_734_104_131_277_7,
        source: "EXP-57: the jump of the energy is logged",
        mutation: "networks.driven.controls.stiffen.value=\"if(t < 0.195, 100, 401)\"",
        ..SWITCHED
    },
    Case {
        id: "cut_is_booked",
        what: "the same and what the cut took away, 400 N/m q²/2 after 50 steps",
        settings: &["networks.latched.controls.release.connects=\"previous > 0\""],
        reading: Reading::last("controls").after(80),
        // κ = 0.04 from there: q = -0.03344 m
        reference: 0.097_040_954_808_387_06,
        source: "EXP-57: the jump of the energy is logged",
        mutation: "networks.driven.controls.cut.connects=\"t < 0.505\"",
        ..SWITCHED
    },
    Case {
        id: "latched_spring",
        what: "a mass let go once it is faster than 0.5 m/s keeps its speed",
        reading: Reading::last("latched").after(80),
        reference: -0.56555640999,
        mutation: "networks.latched.masses.bob.mass=1.001",
        ..SWITCHED
    },
    Case {
        id: "plane_bears_ball",
        capabilities: &["JIM-1", "JIM-22"],
        what: "a ball on an exact plane is in by m g/k",
        scene: "toy_box",
        settings: &[],
        reading: Reading::last("ball"),
        reference: -0.550_981,
        // critically damped at 100/s: e^-200 of a drop is left, rounding of 4000 steps of it
        tolerance: Tolerance::Absolute(1e-12),
        source: "0.05 m above the plane at -0.6 m, less 0.1 kg g/(1000 N/m)",
        mutation: "networks.scale.modules.pan.parameters.stiffness=1001",
        ..OSCILLATOR
    },
];
