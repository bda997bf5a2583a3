//! The same motion seen from a frame that moves and from a world at rest.
//!
//! The frame turns by `t²` and goes to and fro by `0.1 m (1 - cos 2t)`. What nothing holds stays where it was in the world at rest,
//! so that its path in the frame is known. What the frame carries is the same as what pins carry that are led like the frame.

use crate::{Case, Limit, Reading, Refinement, Tolerance, Variant};

const HALVED: Refinement = Refinement {
    size_of: "step [s]",
    runs: &[
        Variant { size: 0.01, settings: &["world.period=0.01"] },
        Variant { size: 0.005, settings: &["world.period=0.005"] },
    ],
    // cos 4 X + sin 4 Y with (X, Y) = (-0.2 - 0.1 (1 - cos 4), 0.1)
    limit: Limit::Known(0.163_137_835_037_860_08),
};

const PUCK: Case = Case {
    id: "frame_puck_x_order",
    capabilities: &["DEB-50"],
    what: "order at which a free mass, seen from a frame that is spun up and pushed, comes to be where it stays in the world",
    scene: "carousel",
    settings: &[],
    reading: Reading::component("puck", 0),
    refinement: Some(HALVED),
    reference: 2.0,
    tolerance: Tolerance::Absolute(0.05),
    source: "Newton's first law, in the coordinates of the frame",
    mutation: "networks.puck.masses.one.drag=0.001",
};

pub(super) const CASES: &[Case] = &[
    PUCK,
    Case {
        id: "frame_puck_y_order",
        what: "the same, along y",
        reading: Reading::component("puck", 1),
        refinement: Some(Refinement { limit: Limit::Known(-0.341_873_023_009_908_74), ..HALVED }),
        ..PUCK
    },
    Case {
        id: "frame_arm_order",
        what: "order at which the strain energy of an arm, seen from the frame, comes to that of the same arm in a world at rest, \
               led by pins like the frame",
        reading: Reading::last("strain"),
        refinement: Some(Refinement {
            runs: &[
                Variant { size: 0.005, settings: &["world.period=0.005"] },
                Variant { size: 0.0025, settings: &["world.period=0.0025"] },
            ],
            // that of steps of 2.5 ms and 1.25 ms without `world.frame`, its motion and rotation at the pins, extrapolated
            limit: Limit::Known(1.491_236_530e-4),
            ..HALVED
        }),
        // steps of the second order, and a limit that two of them are extrapolated to
        tolerance: Tolerance::Absolute(0.1),
        source: "Newton's second law is the same for both",
        mutation: "bodies.arm.material.density=1010",
        ..PUCK
    },
];
