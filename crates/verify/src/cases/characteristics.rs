//! Forces of laws over the length, point by point, where a link is led to within one step.

use super::rheometer::{PLASTIC, PULL};
use crate::{Case, Tolerance};

/// Softer on the way back.
const CURVED_LOOP: &str = r#"networks.sample.links[0].law={ name = "finite_state", states = { loads = "-k * (D - L0)^3", unloads = "-k / 2 * (D - L0)^3" }, transitions = { "loads -> unloads" = "V < 0", "unloads -> loads" = "V > 0" }, parameters = { k = "1e6" } }"#;

const DEAD_ZONE: &str = r#"networks.sample.links[0].law={ name = "piecewise_linear", thresholds = [0.985, 0.99, 1.01, 1.02], slopes = [0, -1000, 0, -1000, 0], zero = 1 }"#;

const COHESION: &str = r#"networks.sample.links[0].law={ name = "cohesion", hard = 0.95, distance = 1, peak = 1.1, range = 1.5, repulsion = 10000, cohesion = 1000 }"#;

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
        id: "saturation",
        capabilities: &["JIM-16", "JIM-17"],
        what: "a characteristic that saturates at 1.02 m, at 1.03 m: 500 N/m 0.02 m, and no more",
        settings: &[
            r#"networks.sample.links[0].law={ name = "piecewise_linear", thresholds = [0.98, 1.02], slopes = [0, -500, 0], zero = 1 }"#,
        ],
        reference: 10.0,
        source: "specification §2.8.2: saturation",
        mutation: "networks.sample.links[0].law.thresholds=[0.98, 1.021]",
        ..PLASTIC
    },
    Case {
        id: "curvature",
        capabilities: &["JIM-16"],
        what: "a spring whose force grows with the third power, at 0.98 m: k (-0.02 m)³",
        settings: &[
            r#"networks.sample.links[0].law={ name = "formula", push = "-k * (D - L0)^3", parameters = { k = "1e6" } }"#,
        ],
        reading: PULL.after(12),
        reference: -8.0,
        source: "specification §2.8.2: curvature",
        mutation: "networks.sample.links[0].law.parameters.k=1000001",
        ..PLASTIC
    },
    Case {
        id: "dead_zone_is_dead",
        capabilities: &["JIM-16", "JIM-17"],
        what: "a characteristic with a dead zone of a centimetre each way, at its edge",
        settings: &[DEAD_ZONE],
        reading: PULL.after(2),
        reference: 0.0,
        source: "specification §2.8.2: dead zone and saturation",
        mutation: "networks.sample.links[0].law.thresholds=[0.985, 0.99, 1.009, 1.02]",
        ..PLASTIC
    },
    Case {
        id: "dead_zone_then_slope",
        capabilities: &["JIM-16", "JIM-17"],
        what: "the same beyond its edge, at 1.015 m: 1000 N/m 5 mm",
        settings: &[DEAD_ZONE],
        reading: PULL.after(3),
        reference: 5.0,
        source: "specification §2.8.2: dead zone and saturation",
        mutation: "networks.sample.links[0].law.thresholds=[0.985, 0.99, 1.009, 1.02]",
        ..PLASTIC
    },
    Case {
        id: "dead_zone_then_saturation",
        capabilities: &["JIM-16", "JIM-17"],
        what: "the same pushed to 0.98 m, where it has saturated: 1000 N/m 5 mm the other way",
        settings: &[DEAD_ZONE],
        reading: PULL.after(12),
        reference: -5.0,
        source: "specification §2.8.2: dead zone and saturation",
        mutation: "networks.sample.links[0].law.thresholds=[0.984, 0.99, 1.01, 1.02]",
        ..PLASTIC
    },
    Case {
        id: "curved_loop_there",
        capabilities: &["JIM-16", "JIM-18", "JIM-19"],
        what: "a curved characteristic that is another on the way back, at 1.02 m on the way there: k (0.02 m)³",
        settings: &[CURVED_LOOP],
        reading: PULL.after(4),
        reference: 8.0,
        source: "specification §2.8.2: curvature and hysteresis; loops need a memory",
        mutation: "networks.sample.links[0].law.parameters.k=1000001",
        ..PLASTIC
    },
    Case {
        id: "curved_loop_back",
        capabilities: &["JIM-16", "JIM-18", "JIM-19"],
        what: "the same on the way back: half of it",
        settings: &[CURVED_LOOP],
        reading: PULL.after(7),
        reference: 4.0,
        source: "specification §2.8.2: curvature and hysteresis; loops need a memory",
        // without a memory of which way it goes
        mutation: r#"networks.sample.links[0].law.transitions={ "loads -> unloads" = "V > 10" }"#,
        ..PLASTIC
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
        id: "cohesion_edge",
        what: "a cohesive pair at the end of its steep piece, 0.95 m",
        settings: &[
            COHESION,
            "networks.sample.pins[0].motion={ times = [0, 0.01], offsets = [[0, 0, 0], [0.05, 0, 0]] }",
        ],
        reference: -50.0,
        // places of a metre, rounding times k
        tolerance: Tolerance::Absolute(1e-11),
        source: "specification §2.10: the values of the worked example",
        mutation: "networks.sample.links[0].law.cohesion=1001",
        ..CURVE
    },
    Case {
        id: "cohesion_rest",
        what: "a cohesive pair at its distance of 1 m",
        settings: &[
            COHESION,
            "networks.sample.pins[0].motion={ times = [0, 0.01], offsets = [[0, 0, 0], [0, 0, 0]] }",
        ],
        reference: 0.0,
        // places of a metre, rounding times k
        tolerance: Tolerance::Absolute(1e-11),
        source: "specification §2.10: the values of the worked example",
        mutation: "networks.sample.links[0].law.distance=1.001",
        ..CURVE
    },
    Case {
        id: "cohesion_fades",
        what: "a cohesive pair half way to its range, 1.3 m",
        settings: &[
            COHESION,
            "networks.sample.pins[0].motion={ times = [0, 0.01], offsets = [[0, 0, 0], [-0.3, 0, 0]] }",
        ],
        reference: 50.0,
        // places of a metre, rounding times k
        tolerance: Tolerance::Absolute(1e-11),
        source: "specification §2.10: the values of the worked example",
        mutation: "networks.sample.links[0].law.cohesion=1001",
        ..CURVE
    },
    Case {
        id: "cohesion_ends",
        what: "a cohesive pair at its range, 1.5 m",
        settings: &[
            COHESION,
            "networks.sample.pins[0].motion={ times = [0, 0.01], offsets = [[0, 0, 0], [-0.5, 0, 0]] }",
        ],
        reference: 0.0,
        // places of a metre, rounding times k
        tolerance: Tolerance::Absolute(1e-11),
        source: "specification §2.10: the values of the worked example",
        mutation: "networks.sample.links[0].law.range=1.501",
        ..CURVE
    },
    Case {
        id: "cohesion_is_gone",
        what: "a cohesive pair 2 m apart, beyond its range",
        settings: &[
            COHESION,
            "networks.sample.pins[0].motion={ times = [0, 0.01], offsets = [[0, 0, 0], [-1, 0, 0]] }",
        ],
        reference: 0.0,
        // places of a metre, rounding times k
        tolerance: Tolerance::Absolute(1e-11),
        source: "specification §2.10: the values of the worked example",
        mutation: "networks.sample.links[0].law.range=2.1",
        ..CURVE
    },
    Case {
        id: "lennard_jones_strongest_1",
        what: "strongest attraction of the family's member n = 1, at r0 (3/2)^(1/1)",
        settings: &[
            r#"networks.sample.links[0].law={ name = "lennard_jones", depth = 1, distance = 1, exponent = 1 }"#,
            "networks.sample.pins[0].motion={ times = [0, 0.01], offsets = [[0, 0, 0], [-0.5, 0, 0]] }",
        ],
        reference: 0.2962962962962963,
        source: "specification §2.10, the row of n = 1 in closed form",
        mutation: "networks.sample.links[0].law.depth=1.001",
        ..CURVE
    },
    Case {
        id: "lennard_jones_strongest_2",
        what: "strongest attraction of the family's member n = 2, at r0 (5/3)^(1/2)",
        settings: &[
            r#"networks.sample.links[0].law={ name = "lennard_jones", depth = 1, distance = 1, exponent = 2 }"#,
            "networks.sample.pins[0].motion={ times = [0, 0.01], offsets = [[0, 0, 0], [-0.2909944487358056, 0, 0]] }",
        ],
        reference: 0.743612802471824,
        source: "specification §2.10, the row of n = 2 in closed form",
        mutation: "networks.sample.links[0].law.depth=1.001",
        ..CURVE
    },
    Case {
        id: "lennard_jones_strongest_3",
        what: "strongest attraction of the family's member n = 3, at r0 (7/4)^(1/3)",
        settings: &[
            r#"networks.sample.links[0].law={ name = "lennard_jones", depth = 1, distance = 1, exponent = 3 }"#,
            "networks.sample.pins[0].motion={ times = [0, 0.01], offsets = [[0, 0, 0], [-0.20507113208761507, 0, 0]] }",
        ],
        reference: 1.219336946987133,
        source: "specification §2.10, the row of n = 3 in closed form",
        mutation: "networks.sample.links[0].law.depth=1.001",
        ..CURVE
    },
    Case {
        id: "lennard_jones_strongest_4",
        what: "strongest attraction of the family's member n = 4, at r0 (9/5)^(1/4)",
        settings: &[
            r#"networks.sample.links[0].law={ name = "lennard_jones", depth = 1, distance = 1, exponent = 4 }"#,
            "networks.sample.pins[0].motion={ times = [0, 0.01], offsets = [[0, 0, 0], [-0.15829218528826905, 0, 0]] }",
        ],
        reference: 1.7053630051761988,
        source: "specification §2.10, the row of n = 4 in closed form",
        mutation: "networks.sample.links[0].law.depth=1.001",
        ..CURVE
    },
    Case {
        id: "lennard_jones_strongest_8",
        what: "strongest attraction of the family's member n = 8, at r0 (17/9)^(1/8)",
        settings: &[
            r#"networks.sample.links[0].law={ name = "lennard_jones", depth = 1, distance = 1, exponent = 8 }"#,
            "networks.sample.pins[0].motion={ times = [0, 0.01], offsets = [[0, 0, 0], [-0.08274403918250095, 0, 0]] }",
        ],
        reference: 3.681534162552235,
        source: "specification §2.10, the row of n = 8 in closed form",
        mutation: "networks.sample.links[0].law.depth=1.001",
        ..CURVE
    },
    Case {
        id: "lennard_jones_strongest_12",
        what: "strongest attraction of the family's member n = 12, at r0 (25/13)^(1/12)",
        settings: &[
            r#"networks.sample.links[0].law={ name = "lennard_jones", depth = 1, distance = 1, exponent = 12 }"#,
            "networks.sample.pins[0].motion={ times = [0, 0.01], offsets = [[0, 0, 0], [-0.056006005488885346, 0, 0]] }",
        ],
        reference: 5.672695012020033,
        source: "specification §2.10, the row of n = 12 in closed form",
        mutation: "networks.sample.links[0].law.depth=1.001",
        ..CURVE
    },
];
