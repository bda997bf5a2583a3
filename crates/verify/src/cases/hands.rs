//! An emulated hand on a cube of gel: what it feels, and what it must not feel.

use crate::{Case, Reading, Statistic, Tolerance};

const HAND: Case = Case {
    id: "",
    capabilities: &["DEB-46"],
    what: "",
    scene: "hand_on_cube",
    settings: &[],
    reading: Reading::component("force", 2),
    refinement: None,
    reference: 0.0,
    tolerance: Tolerance::Absolute(1e-9),
    source: "",
    mutation: "",
};

/// Pushing far beyond what the device can give.
const HARD: &str = r#"hands.right.motion.formula=[0, 0, "-0.3 * smoothstep(0.1, 0.5, t)"]"#;
/// The same at ten metres a second, through the cube if nothing stopped it.
const FAST: &str = r#"hands.right.motion.formula=[0, 0, "-0.3 * smoothstep(0.1, 0.13, t)"]"#;
/// And of a device that gives little.
const WEAK: &str = r#"hands.right.coupling={ limit = "2 N" }"#;

pub(super) const CASES: &[Case] = &[
    Case {
        id: "hand_limit",
        what: "pushing 30 cm down a cube of 10: the most that the device gives",
        settings: &[HARD, WEAK],
        reference: 2.0,
        tolerance: Tolerance::Relative(1e-6),
        source: "the limit of the device",
        mutation: r#"hands.right.coupling={ limit = "1.5 N" }"#,
        ..HAND
    },
    Case {
        id: "hand_gives_way",
        what: "the same: where the hand comes to rest",
        settings: &[HARD, WEAK],
        reading: Reading::component("hand", 2),
        // x = x_m + F / (k + k_r)
        reference: -0.3 + 2.0 / 350.0,
        tolerance: Tolerance::Absolute(1e-4),
        source: "an arm of 300 N/m with reflexes of 50 N/m under 2 N",
        mutation: r#"hands.right.device.stiffness="200 N/m""#,
        ..HAND
    },
    Case {
        id: "hand_balance",
        capabilities: &["DEB-45", "DEB-46"],
        what: "the same: the ball hands on to the cube what the hand gives",
        settings: &[HARD, WEAK],
        reading: Reading::component("on_cube", 2),
        reference: -2.0,
        tolerance: Tolerance::Relative(0.01),
        source: "balance of the ball at rest",
        mutation: r#"hands.right.coupling={ limit = "1.5 N" }"#,
        ..HAND
    },
    Case {
        id: "hand_fast",
        what: "the same, meaning to go those 30 cm in 30 ms: the ball is stopped, and the hand gives what its device gives",
        settings: &[FAST, WEAK],
        reading: Reading::component("on_cube", 2),
        reference: -2.0,
        tolerance: Tolerance::Relative(0.01),
        source: "balance of the ball at rest; behind the cube nothing would press it",
        mutation: r#"hands.right.coupling={ limit = "1.5 N" }"#,
        ..HAND
    },
    Case {
        id: "hand_stiff",
        what: "pushing as hard on a cube a thousand times as stiff: the ball comes to rest on it",
        settings: &[HARD, WEAK, "bodies.cube.material.youngs_modulus=\"10 MPa\""],
        reading: Reading::component("on_cube", 2),
        reference: -2.0,
        tolerance: Tolerance::Relative(0.01),
        source: "balance of the ball at rest",
        mutation: r#"hands.right.coupling={ limit = "1.5 N" }"#,
        ..HAND
    },
    Case {
        id: "hand_release",
        capabilities: &["DEB-48"],
        what: "force of the ball on the cube when the hand has come back: nothing sticks",
        reading: Reading::component("on_cube", 2),
        source: "specification, V-44: a contact only pushes",
        mutation: r#"hands.right.motion.formula=[0, 0, "-0.025 * smoothstep(0.1, 0.5, t)"]"#,
        ..HAND
    },
    Case {
        id: "hand_lets_go",
        capabilities: &["DEB-48"],
        what: "force on the hand when it has come back",
        source: "nothing touches the ball",
        tolerance: Tolerance::Absolute(1e-3),
        mutation: r#"hands.right.motion.formula=[0, 0, "-0.025 * smoothstep(0.1, 0.5, t)"]"#,
        ..HAND
    },
    Case {
        id: "hand_is_lost",
        what: "force on the hand a tenth of a second after its device was lost in the midst of pressing",
        settings: &["hands.right.device.lost_at=0.8", "hands.right.device.lost_for=100"],
        reading: Reading::component("force", 2).after(90),
        source: "nobody is there to feel anything",
        mutation: "hands.right.device.lost_at=100",
        ..HAND
    },
    Case {
        id: "hand_is_found",
        what: "force on the hand after its device was lost, and has come back to where nothing is touched",
        settings: &["hands.right.device.lost_at=0.8", "hands.right.device.lost_for=0.7"],
        tolerance: Tolerance::Absolute(0.02),
        source: "the ball is drawn to the hand again",
        mutation: r#"hands.right.motion.formula=[0, 0, "-0.025 * smoothstep(0.1, 0.5, t)"]"#,
        ..HAND
    },
    Case {
        id: "hand_never_sticks",
        capabilities: &["DEB-48"],
        what: "force of the ball on the cube along the way out, the most at any date: it never pulls",
        reading: Reading::component("on_cube", 2).taking(Statistic::Max),
        source: "specification, V-44: a contact only pushes",
        // from below, where pushing is upward
        mutation: r#"hands.right.tool={ name = "sphere", centre = [0.05, 0.05, -0.02], radius = 0.03 }"#,
        ..HAND
    },
];
