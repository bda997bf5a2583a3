//! Collisions that are detected beside the steps, one period late.

use crate::{Case, Reading, Tolerance};

const LATE: Case = Case {
    id: "late_collisions_going",
    capabilities: &["DEB-37"],
    what: "where the slab is as a ball comes at 2 cm/s, found beside the steps: where it is a period before with collisions that are found first, which is the way of that period, v T = 0.2 mm, deeper in the ball",
    scene: "late_collisions",
    settings: &[],
    reading: Reading::component("under", 2).after(50),
    refinement: None,
    reference: -7.699_447e-3,
    // a hundredth of that way: held points go where they are told, other forces move the rest of the slab alone
    tolerance: Tolerance::Absolute(2e-6),
    source: "held points go by what was found a period before, where they were told to be by then: x(t + T) is the x(t) of world.collisions=\"every_step\", at 0.49 s",
    mutation: "world.collisions=\"every_step\"",
};

pub(super) const CASES: &[Case] = &[
    LATE,
    Case {
        id: "late_collisions_at_rest",
        what: "the same when the ball has stood still for 0.29 s: lateness leaves nothing",
        reading: Reading::component("under", 2).after(79),
        reference: -8.154_467e-3,
        // a tenth of the way of a period: what is told is made by then, and the rest of the slab still moves by micrometres in both
        tolerance: Tolerance::Absolute(2e-5),
        source: "world.collisions=\"every_step\"",
        mutation: "contacts[0].residual=\"0.2 mm\"",
        ..LATE
    },
    Case {
        id: "late_fast_tool",
        capabilities: &["DEB-37", "DEB-44"],
        what: "force on a slab of a rod thinner than its triangles that comes at 10 m/s, four thicknesses of the slab in a period, found beside the steps: two periods ahead are looked through, and where the rod leaves its way steps look anew",
        scene: "fast_tool",
        settings: &[
            "world.collisions=\"one_period_late\"",
            "shapes.needle.motion.times=[0, 0.005, 0.007, 1.3, 1.4]",
        ],
        reading: Reading::component("force", 2).after(80),
        reference: -0.796_400,
        tolerance: Tolerance::Relative(1e-3),
        source: "the reference of fast_tool: a rod that is led there in a fifth of a second, found first in every step",
        mutation: r#"contacts[0].detect="points""#,
        ..LATE
    },
    Case {
        id: "late_liver",
        capabilities: &["DEB-37", "DEB-43"],
        what: "force of the tool that pokes the organ, its triangles found beside the steps: what touches is seen in every step all the same",
        scene: "surgical",
        settings: &["world.collisions=\"one_period_late\""],
        reading: Reading::component("tool", 2).after(90),
        reference: -2.612_312_786_602,
        // more triangles are looked at, and add nothing; sums of a thousand forces round
        tolerance: Tolerance::Relative(1e-9),
        source: "world.collisions=\"every_step\"",
        mutation: "contacts[0].detect=\"points\"",
        ..LATE
    },
];
