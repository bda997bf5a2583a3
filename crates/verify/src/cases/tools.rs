//! Tools against triangles, and hands that push hard, fast, or through a body with them.

use crate::{Case, Reading, Statistic, Tolerance};

const NEEDLE: Case = Case {
    id: "fast_tool",
    capabilities: &["DEB-43", "DEB-44", "DEB-45"],
    what: "force on a slab of a rod thinner than its triangles, held where it came to at 10 m/s",
    scene: "fast_tool",
    settings: &["shapes.needle.motion.times=[0, 0.005, 0.007, 1.3, 1.4]"],
    reading: Reading::component("force", 2).after(80),
    refinement: None,
    reference: -0.667_625,
    // what the slab still swings in one and the other
    tolerance: Tolerance::Relative(1e-3),
    source: "the same tool, led there in a fifth of a second: shapes.needle.motion.times=[0, 0.005, 0.2, 1.3, 1.4]",
    // which it slips between
    mutation: r#"contacts[0].detect="points""#,
};

/// The hand means to be 30 cm further down, through a cube of 10 cm and what it stands on, within 20 ms, with a ball that fits
/// between the points of its surface.
const THROUGH: &[&str] = &[
    r#"hands.right.motion.formula=[0, 0, "-0.3 * smoothstep(0.1, 0.12, t)"]"#,
    r#"hands.right.tool={ name = "sphere", centre = [0.057, 0.061, 0.112], radius = "5 mm" }"#,
    r#"hands.right.coupling={ limit = "1 N" }"#,
    r#"hands.right.touch={ detect = "triangles", stiffness = "2 kN/m" }"#,
];
/// Without triangles.
const POINTS: &str = r#"hands.right.touch={ detect = "points", stiffness = "2 kN/m" }"#;

const THROUGH_CUBE: Case = Case {
    id: "hand_through",
    capabilities: &["DEB-44", "DEB-46"],
    what: "where a hand comes to rest that thrusts a ball of 5 mm through a cube: held by what its device gives",
    scene: "hand_on_cube",
    settings: THROUGH,
    reading: Reading::component("hand", 2).after(150),
    refinement: None,
    // x = x_m + F / (k + k_r)
    reference: -0.3 + 1.0 / 350.0,
    // a fifth of what it would be without the force
    tolerance: Tolerance::Absolute(5e-4),
    source: "an arm of 300 N/m with reflexes of 50 N/m under 1 N, the ball in front of the surface",
    // between which the ball is through
    mutation: POINTS,
};

const LIVER: Case = Case {
    id: "hand_jump_liver",
    capabilities: &["DEB-46", "DEB-47"],
    what: "greatest change of the force from one millisecond to the next while the organ refines under a hand and is let go",
    scene: "hand_on_liver",
    settings: &[],
    reading: Reading::last("jump"),
    refinement: None,
    reference: 0.0,
    tolerance: Tolerance::Absolute(0.083),
    source: "V-43: a twentieth of the greatest force, 1.67 N",
    mutation: r#"hands.right.coupling={ stiffness = "4000 N/m", damping = 2, limit = "5 N" }"#,
};

pub(super) const CASES: &[Case] = &[
    NEEDLE,
    Case {
        id: "fast_tool_lets_go",
        capabilities: &["DEB-45", "DEB-48"],
        what: "force on the slab when the rod has gone",
        settings: &[],
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
        what: "how deep the slab is in the rod, five detections after it came to stand",
        settings: &[r#"contacts[0].stiffness="20 kN/m""#, "systems.main.stepper.halvings=8"],
        reading: Reading::last("depth").after(6),
        reference: 0.0,
        tolerance: Tolerance::Absolute(1e-4),
        source: "V-41 allows 0.1 mm",
        mutation: r#"contacts[0].stiffness="100 N/m""#,
        ..NEEDLE
    },
    THROUGH_CUBE,
    Case {
        id: "hand_through_depth",
        capabilities: &["DEB-44"],
        what: "how deep the cube has been in that ball at most: less than its radius",
        reading: Reading::last("depth").taking(Statistic::Max).after(150),
        reference: 0.0,
        tolerance: Tolerance::Absolute(5e-3),
        source: "its middle stays in front of the surface",
        mutation: r#"hands.right.touch={ detect = "triangles", stiffness = "20 N/m" }"#,
        ..THROUGH_CUBE
    },
    LIVER,
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
        ..LIVER
    },
    Case {
        id: "levels_no_popping",
        capabilities: &["DEB-40", "DEB-41", "DEB-42"],
        what: "the most that a node of the shown surface jumps from period to period because points come and go",
        scene: "surgical",
        settings: &[],
        reading: Reading::last("jump").after(80),
        reference: 0.0,
        tolerance: Tolerance::Absolute(5e-4),
        source: "V-40",
        mutation: "bodies.liver.levels.dress.blend=0",
        ..LIVER
    },
];
