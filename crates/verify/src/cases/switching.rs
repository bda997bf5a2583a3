//! Laws whose numbers are driven, regimes that remember, friction from states alone, and characteristics with jumps.

use super::conditional::{PULL, WORDS};
use super::network::OSCILLATOR;
use crate::{Case, Reading, Tolerance};

const DRIVEN: Case = Case {
    capabilities: &["JIM-13"],
    scene: "network_driven",
    // rounding of five hundred steps
    tolerance: Tolerance::Relative(1e-11),
    source: "EXP-57: v' = v + Te F(x)/m, x' = x + Te v' with the number as it is driven at n Te",
    ..OSCILLATOR
};

const AUTOMATON: Case = Case {
    capabilities: &["JIM-19"],
    scene: "automaton_friction",
    // rounding of a thousand steps, in forces of 1e5 N/m
    tolerance: Tolerance::Absolute(1e-9),
    source: "specification §2.14.4 and §2.14.5 along an axis: v' = v + Te F, x' = x + Te v'",
    ..OSCILLATOR
};

/// Maxwell's fluid as a regime with a memory of its own: the damper moves on by `Te k (D - L0 - x)/z` a step.
const REGIME: &str = r#"networks.sample.links[0].law={ name = "finite_state", states = { flows = "-k * (D - L0 - x)" }, updates = { flows = "x = x + Te * k / z * (D - L0 - x)" }, losses = { flows = "(k * (D - L0 - x))^2 / z" }, memory = { x = 0 }, parameters = { k = 1000, z = 20 } }"#;

const RELAY: &str = r#"networks.sample.links[0].law={ name = "piecewise_linear", thresholds = [0.985, 1.012], slopes = [0, 0, 0], jumps = [-5, -5], zero = 1 }"#;

const MEASURED: &str = r#"networks.sample.links[0].law={ name = "measured_curve", lengths = [0.98, 1, 1.02, 1.05], pushes = [20, 0, -8, -11] }"#;

pub(super) const CASES: &[Case] = &[
    Case {
        id: "brake_is_tightened",
        what: "a block slides against a plastic link whose threshold grows by 20 N a second, 1 N at the start",
        reading: Reading::last("brake"),
        reference: BRAKE,
        mutation: "networks.brake.controls.tighten.value=1 + 19 * t",
        ..DRIVEN
    },
    Case {
        id: "ball_is_stiffened",
        what: "balls that press each other, of a stiffness that grows by 2 kN/m a second: the speed at which one is thrown off",
        reading: Reading::last("thrower"),
        reference: 0.151_210_432_462_850_04,
        mutation: "networks.thrower.controls.stiffen.value=100 + 1900 * t",
        ..DRIVEN
    },
    Case {
        id: "balls_are_parted",
        what: "balls that press each other are parted after 50 steps: the one that is free keeps its speed",
        reading: Reading::last("parted"),
        reference: 0.047_943_335_987_518_7,
        mutation: "networks.parted.controls.part.connects=t < 0.0505",
        ..DRIVEN
    },
    Case {
        id: "spring_is_put_in",
        what: "a spring that is taken out and put in again within a tenth of a second each",
        reading: Reading::last("ramped"),
        reference: 0.972_282_830_918_112_5,
        mutation: "networks.ramped.controls.put_in.ramp=0.11",
        ..DRIVEN
    },
    Case {
        id: "automaton_stops",
        what: "friction from the states of a link: a block thrown at 2 m/s comes to rest after 0.5087 m, v²/(2 mu_c g) = 0.5097 m",
        reading: Reading::last("thrown"),
        reference: 0.508_684_419_999_995_5,
        mutation: "parameters.law.parameters.mu_c=0.401",
        ..AUTOMATON
    },
    Case {
        id: "automaton_holds",
        what: "the same holds against 0.58 of its weight, pulled within half a second: mu_s = 0.6",
        reading: Reading::last("pulled"),
        // F/k, and what was left of its swing
        reference: 5.689_8e-5,
        mutation: "parameters.pull=0.59",
        ..AUTOMATON
    },
    Case {
        id: "automaton_slides",
        what: "and goes under 0.62 of it",
        settings: &["parameters.pull=0.62"],
        reading: Reading::last("pulled"),
        reference: 0.290_118_824_134_623_25,
        mutation: "parameters.law.parameters.mu_s=0.61",
        ..AUTOMATON
    },
    Case {
        id: "automaton_heat",
        what: "what sliding gave off, at each step's speed: within a step of braking, v²/2 = 2 J and the hundredth of a joule of the block that is held",
        // the other one is not pulled
        settings: &["parameters.pull=0"],
        reading: Reading::last("heat"),
        reference: 2.003_919_006_570_316_5,
        mutation: "parameters.law.losses.sliding=mu_s * N * abs(V)",
        ..AUTOMATON
    },
    Case {
        id: "regime_remembers",
        capabilities: &["JIM-19", "JIM-18"],
        what: "a regime with a memory that moves on: Maxwell's fluid by an explicit step, pulled to and fro",
        settings: &[REGIME],
        reading: PULL.after(16),
        reference: 27.590_179_443_36,
        source: "specification §2.8.5: f = k (D - L0 - x), x' = x + Te f/z",
        mutation: r#"networks.sample.links[0].law.updates.flows=x = x + Te * V / 2"#,
        ..WORDS
    },
    Case {
        id: "regime_gives_off",
        capabilities: &["JIM-19", "JIM-18"],
        what: "what it gave off on the way, the sum of Te f²/z",
        settings: &[REGIME],
        reading: Reading::last("heat").after(16),
        reference: 0.889_461_436_355,
        source: "specification §2.8.5: f = k (D - L0 - x), x' = x + Te f/z",
        mutation: r#"networks.sample.links[0].law.losses.flows=(k * (D - L0 - x))^2 / (2 * z)"#,
        ..WORDS
    },
    Case {
        id: "relay_waits",
        capabilities: &["JIM-16", "JIM-17"],
        what: "a relay with a dead zone, by tests: at 1.01 m, before its threshold, no force",
        settings: &[RELAY],
        reading: PULL.after(2),
        reference: 0.0,
        source: "specification §2.8.3: S = a_i E + b_i, jumps exactly",
        mutation: "networks.sample.links[0].law.thresholds=[0.985, 1.009]",
        ..WORDS
    },
    Case {
        id: "relay_pulls",
        capabilities: &["JIM-16", "JIM-17"],
        what: "the same beyond it, at 1.015 m, the whole of its jump",
        settings: &[RELAY],
        reading: PULL.after(3),
        reference: 5.0,
        source: "specification §2.8.3: S = a_i E + b_i, jumps exactly",
        mutation: "networks.sample.links[0].law.thresholds=[0.985, 1.016]",
        ..WORDS
    },
    Case {
        id: "relay_pushes",
        capabilities: &["JIM-16", "JIM-17"],
        what: "and the other way at 0.98 m",
        settings: &[RELAY],
        reading: PULL.after(12),
        reference: -5.0,
        source: "specification §2.8.3: S = a_i E + b_i, jumps exactly",
        mutation: "networks.sample.links[0].law.thresholds=[0.975, 1.012]",
        ..WORDS
    },
    Case {
        id: "measured_between",
        capabilities: &["JIM-17"],
        what: "a characteristic through measured points, between two of them: 3/4 of 8 N at 1.015 m",
        settings: &[MEASURED],
        reading: PULL.after(3),
        reference: 6.0,
        source: "specification §2.8.3: from knots and the slopes beyond them",
        mutation: "networks.sample.links[0].law.pushes=[20, 0, -9, -11]",
        ..WORDS
    },
    Case {
        id: "measured_further",
        capabilities: &["JIM-17"],
        what: "the same on the next piece, at 1.03 m",
        settings: &[MEASURED],
        reading: PULL.after(16),
        reference: 9.0,
        source: "specification §2.8.3: from knots and the slopes beyond them",
        mutation: "networks.sample.links[0].law.lengths=[0.98, 1, 1.02, 1.06]",
        ..WORDS
    },
];

/// [m], by the recurrence of a slider: `f = min(k (x - S), Qe)`, `S = x - f/k` where it yields.
const BRAKE: f64 = 0.505_212_143_555_002_8;
