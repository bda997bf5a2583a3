//! Masses that slide on tables and stick, step by step.

use super::network::OSCILLATOR;
use crate::{Case, Reading, Tolerance};

const STILL: &str = "networks.table.masses.book.velocity=[0, 0, 0]";

pub(super) const CASES: &[Case] = &[
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
        id: "friction_holds_below",
        capabilities: &["JIM-46", "JIM-47"],
        what: "way of a mass under gravity that has leaned within half a second to tan θ = 0.582, 3 % below the static coefficient: that of its hook",
        scene: "network_friction",
        settings: &[STILL, r#"world.gravity=["9.81 * 0.582 * min(t / 0.5, 1)", 0, -9.81]"#],
        reading: Reading::component("place", 0),
        // F_t/K_t
        reference: 0.582 * 9.81 / 1e5,
        // what swings on the hook when gravity stops leaning: F/(T K √(K/M)), T half a second, and the way the ball turns, F/K of ten kilometres
        tolerance: Tolerance::Absolute(0.582 * 9.81 / 1e5 / 158.0 + 1e-8),
        source: "EXP-38: slides iff tan θ > mu_s, load ramped over 0.5 s, within 3 % (specification §2.14.5)",
        mutation: r#"world.gravity=["9.81 * 0.618 * min(t / 0.5, 1)", 0, -9.81]"#,
        ..OSCILLATOR
    },
    Case {
        id: "friction_slides_above",
        capabilities: &["JIM-46", "JIM-47"],
        what: "way of the same at tan θ = 0.618, 3 % above: in the second and a half after it, at g (0.618 - 0.4)",
        scene: "network_friction",
        settings: &[STILL, r#"world.gravity=["9.81 * 0.618 * min(t / 0.5, 1)", 0, -9.81]"#],
        reading: Reading::component("place", 0),
        // from 0.6 on: at least that of the last second and a half alone
        reference: 0.5 * 9.81 * 0.218 * 1.5 * 1.5,
        tolerance: Tolerance::AtLeast,
        source: "EXP-38: slides iff tan θ > mu_s, load ramped over 0.5 s, within 3 % (specification §2.14.5)",
        mutation: r#"world.gravity=["9.81 * 0.582 * min(t / 0.5, 1)", 0, -9.81]"#,
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
        // the ball turns by x/R on its way, and the normal force with it: N/(K R) = 1e-8; what swings on the hook dies away meanwhile
        tolerance: Tolerance::Relative(2e-8),
        source: "F_t = -K_t D_acc (specification §2.14.3)",
        mutation: "networks.table.crowds[0].friction.stiffness=100001",
        ..OSCILLATOR
    },
    Case {
        id: "sliding_distance_fast",
        capabilities: &["JIM-45"],
        what: "way of a mass at 4 m/s till it stops, v²/(2 μ g)",
        scene: "network_friction",
        settings: &["networks.table.masses.book.velocity=[4, 0, 0]"],
        reading: Reading::component("place", 0),
        reference: 2.038_735_983_690_112,
        tolerance: Tolerance::Relative(1e-2),
        source: "EXP-38: within 1 %",
        mutation: "networks.table.crowds[0].friction.kinetic=0.41",
        ..OSCILLATOR
    },
    Case {
        id: "sliding_slows_down",
        capabilities: &["JIM-45"],
        what: "speed of a mass that began at 2 m/s, ten milliseconds before it stops: v - μ g t after half a second",
        scene: "network_friction",
        reading: Reading::component("speed", 0).after(50),
        reference: 0.038,
        // friction is F v/(v + V_s) below a few V_s, 5 mm/s, and the first of 500 steps is one too many: 4e-3 m/s
        tolerance: Tolerance::Absolute(4e-3),
        source: "EXP-38: stops after v/(μ g) (specification §2.14.5)",
        mutation: "networks.table.crowds[0].friction.kinetic=0.41",
        ..OSCILLATOR
    },
    Case {
        id: "sliding_has_stopped",
        capabilities: &["JIM-45", "JIM-46"],
        what: "speed of the same 20 ms after v/(μ g): less than V_s, where the hook has it",
        scene: "network_friction",
        reading: Reading::component("speed", 0).after(53),
        reference: 0.0,
        // V_s
        tolerance: Tolerance::Absolute(5e-3),
        source: "EXP-38: stops after v/(μ g) (specification §2.14.5)",
        mutation: "networks.table.crowds[0].friction.kinetic=0.38",
        ..OSCILLATOR
    },
    Case {
        id: "friction_holds_sudden",
        capabilities: &["JIM-46", "JIM-47"],
        what: "way of a mass under gravity that leans to tan θ = 0.2 at once: it sticks, by F_t/K_t",
        scene: "network_friction",
        settings: &[STILL, r#"world.gravity=["9.81 * 0.2", 0, -9.81]"#],
        reading: Reading::component("place", 0),
        reference: 1.962e-5,
        // N/(K R)
        tolerance: Tolerance::Relative(2e-8),
        source: "EXP-38: with a sudden load sticks at 0.2 (specification §2.14.5)",
        mutation: r#"world.gravity=["9.81 * 0.5", 0, -9.81]"#,
        ..OSCILLATOR
    },
    Case {
        id: "friction_slides_sudden",
        capabilities: &["JIM-46", "JIM-47"],
        what: "way of the same at tan θ = 0.5: what swings on the hook goes beyond the static coefficient, 0.6, and it slides at g (0.5 - 0.4) for two seconds",
        scene: "network_friction",
        settings: &[STILL, r#"world.gravity=["9.81 * 0.5", 0, -9.81]"#],
        reading: Reading::component("place", 0),
        // 0.981 2²/2
        reference: 1.962,
        // V_s while it comes to speed
        tolerance: Tolerance::Relative(1e-2),
        source: "EXP-38: with a sudden load slides at 0.5 (specification §2.14.5)",
        mutation: r#"world.gravity=["9.81 * 0.2", 0, -9.81]"#,
        ..OSCILLATOR
    },
];
