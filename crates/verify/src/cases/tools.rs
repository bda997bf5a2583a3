//! Tools against triangles, and hands that push hard, fast, or through a body with them.

use crate::{Case, Reading, Statistic, Tolerance};

const NEEDLE: Case = Case {
    id: "fast_tool",
    capabilities: &["DEB-43", "DEB-44", "DEB-45"],
    what: "force on a slab of a rod thinner than its triangles, a quarter of a second after it came at 10 m/s",
    scene: "fast_tool",
    settings: &[],
    reading: Reading::component("force", 2).after(25),
    refinement: None,
    reference: f64::NAN,
    // what the slab still swings
    tolerance: Tolerance::Relative(0.03),
    source: "the same tool, led there in a quarter of a second",
    // which it slips between
    mutation: r#"contacts[0].detect="points""#,
};

/// The hand means to be 30 cm further, through the organ and far behind it, within 20 ms.
const THROUGH: &[&str] = &[
    "hands.right.motion.times=[0, 0.2, 0.22]",
    "hands.right.motion.offsets=[[0, 0, 0], [0, 0, 0], [0, 0, -0.3]]",
    r#"hands.right.tool={ name = "sphere", centre = [0.065, -0.01, 0.09], radius = "4 mm" }"#,
];

const HAND: Case = Case {
    id: "hand_through",
    capabilities: &["DEB-44", "DEB-46"],
    what: "where a hand comes to rest that pushes a ball of 4 mm far through the organ: held by what its device gives",
    scene: "hand_on_liver",
    settings: THROUGH,
    reading: Reading::component("hand", 2).after(150),
    refinement: None,
    // x = x_m + F / (k + k_r)
    reference: -0.3 + 5.0 / 350.0,
    tolerance: Tolerance::Absolute(5e-4),
    source: "an arm of 300 N/m with reflexes of 50 N/m under 5 N, the ball in front of the organ",
    // between its points the ball is through
    mutation: r#"hands.right.touch.detect="points""#,
};

pub(super) const CASES: &[Case] = &[
    NEEDLE,
    Case {
        id: "fast_tool_lets_go",
        capabilities: &["DEB-45", "DEB-48"],
        what: "force on the slab when the rod has gone",
        reading: Reading::component("force", 2),
        reference: 0.0,
        tolerance: Tolerance::Absolute(1e-9),
        source: "a contact only pushes",
        mutation: "shapes.needle.motion.offsets=[[0, 0, 0], [0, 0, 0], [0, 0, -0.02], [0, 0, -0.02], [0, 0, -0.02]]",
        ..NEEDLE
    },
    Case {
        id: "fast_tool_depth",
        capabilities: &["DEB-45"],
        what: "how deep the slab is in the rod, two detections after it came to stand: V-41 allows 0.1 mm after five",
        settings: &[r#"contacts[0].stiffness="20 kN/m""#, "systems.main.stepper.halvings=8"],
        reading: Reading::last("depth").after(3),
        reference: 0.0,
        tolerance: Tolerance::Absolute(1e-4),
        source: "V-41",
        mutation: r#"contacts[0].stiffness="100 N/m""#,
        ..NEEDLE
    },
    HAND,
    Case {
        id: "hand_through_depth",
        capabilities: &["DEB-44"],
        what: "how deep the organ has been in that ball at most: less than its radius",
        reading: Reading::last("depth").taking(Statistic::Max).after(150),
        reference: 0.0,
        tolerance: Tolerance::Absolute(4e-3),
        source: "its middle stays in front of the surface",
        mutation: r#"hands.right.touch.stiffness="20 N/m""#,
        ..HAND
    },
    Case {
        id: "hand_jump_liver",
        capabilities: &["DEB-46", "DEB-47"],
        what: "greatest change of the force from one millisecond to the next while the organ refines under a hand and is let go",
        settings: &[],
        reading: Reading::last("jump"),
        reference: 0.0,
        tolerance: Tolerance::Absolute(0.07),
        source: "V-43: a twentieth of the greatest force",
        mutation: r#"hands.right.coupling={ stiffness = "4000 N/m", damping = 3, limit = "5 N" }"#,
        ..HAND
    },
    Case {
        id: "levels_small_budget",
        capabilities: &["DEB-39"],
        what: "fine points at work under the hand with a budget below what the coarsest mesh needs: none, and it stands",
        settings: &["bodies.liver.levels.budget=1"],
        reading: Reading::last("fine").taking(Statistic::Max),
        reference: 0.0,
        tolerance: Tolerance::Absolute(0.0),
        source: "nothing is refined above 95 % of the budget",
        mutation: "bodies.liver.levels.budget=500000",
        ..HAND
    },
    Case {
        id: "levels_no_popping",
        capabilities: &["DEB-40", "DEB-41", "DEB-42"],
        what: "the most that a node of the shown surface jumps from period to period because points come and go",
        scene: "surgical",
        settings: &[],
        reading: Reading::last("jump"),
        reference: 0.0,
        tolerance: Tolerance::Absolute(5e-4),
        source: "V-40",
        mutation: "bodies.liver.levels.dress.blend=0",
        ..HAND
    },
];
