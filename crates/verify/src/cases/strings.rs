//! Lines and surfaces that swing: modes, energy, what strikes and hangs on a string.

use super::network::OSCILLATOR;
use crate::{Case, Reading, Statistic, Tolerance};

/// A stiffness of M/(Te² 4 sin²(10 π/22)), with which 2 - κ λ is one.
const SIXTH_OF_A_TURN: &str =
    r#"networks.line.links[0].law={ name = "spring_damper", stiffness = 273984606.84943587, damping = 0 }"#;

const THROWN_WEIGHT: &[&str] = &[
    "networks.string.masses.weight.positions=[[0.05, 0.02, -0.1]]",
    "networks.string.masses.weight.velocity=[0, 0, -1]",
    r#"networks.string.pins=[{ region = "string", axes = "xy" }]"#,
];

/// A line along an axis and what strikes it from space, each by its own recurrence.
const STRUCK: Case = Case {
    scene: "weight_on_string",
    // rounding of places of a decimetre, two hundred steps, over a millimetre
    tolerance: Tolerance::Relative(1e-10),
    source: "JIM-91: string excited by a 3D object; X' = 2 X - X_before + Te² F/m of both, F of the spring by its distance in space",
    mutation: "networks.string.links[1].law.damping=0.501",
    ..OSCILLATOR
};

const MODE: Case = Case {
    scene: "vibrating_modes",
    reading: Reading::last("line").after(1000),
    // of the amplitude, 1 mm (EXP-49)
    tolerance: Tolerance::Absolute(1e-16),
    source: "EXP-49: q_n = A cos(ω (n + 1/2) Te)/cos(ω Te/2) from rest, ω Te = 2 asin(√(K/M) sin(p π/22))",
    mutation: "networks.line.links[0].law.stiffness=536870914",
    ..OSCILLATOR
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "line_mode_1",
        capabilities: &["JIM-12", "JIM-91"],
        what: "displacement of the third of ten masses of a line in its lowest mode after 1000 steps",
        reference: 0.000_607_595_779_866_530_6,
        ..MODE
    },
    Case {
        id: "line_mode_3",
        capabilities: &["JIM-12", "JIM-91"],
        what: "the same in the third mode",
        settings: &["parameters.p=3"],
        reference: 0.000_536_081_331_711_372_8,
        ..MODE
    },
    Case {
        id: "line_keeps_its_energy",
        capabilities: &["JIM-94", "JIM-91"],
        what: "energy of a line of ten masses in its tenth mode after 99,998 steps, over that after two, where the mode turns by 60° a step: with X K X/2 in the place of X K X_before/2 it swings by half of itself, and is greatest at these steps, so that the phase is not in it",
        settings: &[
            "parameters.p=10",
            "networks.surface.start={ displacement = [0, 0, 0] }",
            SIXTH_OF_A_TURN,
        ],
        reading: Reading::last("energy").taking(Statistic::LastOver(2)).after(99_998),
        reference: 1.0,
        // rounding of each step, as chance adds it up: √100000 ε
        tolerance: Tolerance::Absolute(7e-14),
        source: "specification §2.5: M (X - X_before)²/2 + X K X_before/2 is constant to rounding, 2e-14 in 100,000 steps [V]",
        // a billionth of a newton second per metre
        mutation: "networks.line.links[0].law.damping=1e-9",
        ..MODE
    },
    Case {
        id: "line_mode_10",
        capabilities: &["JIM-12", "JIM-91"],
        what: "the same in the highest mode",
        settings: &["parameters.p=10"],
        reference: 0.000_854_953_245_712_771_5,
        mutation: "networks.line.links[0].along=[0.01, 0, 1]",
        ..MODE
    },
    Case {
        id: "surface_mode_2_1",
        capabilities: &["JIM-12", "JIM-91"],
        what: "displacement of a mass of a surface of four by five in mode (2, 1) after 1000 steps",
        reading: Reading::last("surface").after(1000),
        reference: 0.000_662_473_273_848_366_1,
        source: "ω Te = 2 asin(√(K/M (sin²(p π/10) + sin²(q π/12)))): the line's, in two directions",
        mutation: "networks.surface.links[0].law.stiffness=268435457",
        ..MODE
    },
    Case {
        id: "string_bears_weight",
        capabilities: &["JIM-91"],
        what: "how far a weight that hangs by a spring in space on a line of masses along an axis draws it down",
        scene: "weight_on_string",
        reading: Reading::last("string"),
        // (W j (N - j)/N + m g j (N - j)/2)/K
        reference: -1.839_375e-3,
        tolerance: Tolerance::Relative(1e-12),
        source: "K (2 u_i - u_{i-1} - u_{i+1}) = f_i",
        mutation: "networks.string.links[1].along=[0, 0.1, 1]",
        ..OSCILLATOR
    },
    Case {
        id: "weight_on_string",
        capabilities: &["JIM-91"],
        what: "the weight itself: that, and the elongation W/k of its spring",
        scene: "weight_on_string",
        reading: Reading::last("weight"),
        reference: -3.801_375e-3,
        tolerance: Tolerance::Relative(1e-12),
        source: "equilibrium of the same",
        mutation: "networks.string.links[1].law.stiffness=501",
        ..OSCILLATOR
    },
    Case {
        id: "string_is_struck",
        capabilities: &["JIM-91"],
        what: "place of the middle of a line of masses along an axis a tenth of a second after a weight in space, hung askew on it by a spring and damper, was thrown down at 1 m/s",
        settings: THROWN_WEIGHT,
        reading: Reading::last("string").after(100),
        reference: -1.089_190_874_912_091e-3,
        ..STRUCK
    },
    Case {
        id: "string_throws_back",
        capabilities: &["JIM-91"],
        what: "and how far the weight has come down by then",
        settings: THROWN_WEIGHT,
        reading: Reading::last("weight").after(100),
        reference: -3.103_774_803_837_44e-3,
        ..STRUCK
    },
    Case {
        id: "string_swings_on",
        capabilities: &["JIM-91"],
        what: "the middle of the line a tenth of a second later",
        settings: THROWN_WEIGHT,
        reading: Reading::last("string").after(200),
        reference: -1.801_543_344_505_805_5e-3,
        ..STRUCK
    },
];
