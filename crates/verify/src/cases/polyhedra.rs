//! Rigid bodies that meet by faces, edges and corners: rocking, toppling, sliding, arches without mortar, a heap of shapes.

use super::network::OSCILLATOR;
use crate::{Case, Reading, Statistic, Tolerance};

/// A block of `b = 0.1 m` by `h = 0.3 m` from its middle, with its masses at its corners: `p² = g/(2R)`, `R² = b² + h²`, tilted by 0.1 rad.
const ROCKS: Case = Case {
    capabilities: &["JIM-97"],
    scene: "rocking_blocks",
    source: "specification §6.3, PA-36 and PA-37; Housner 1963: θ'' = −p² sin(α − θ)",
    mutation: "parameters.friction=0.01",
    ..OSCILLATOR
};

const FINE: &[&str] = &["systems.main.steps_per_period=40", "run.duration=0.6"];

const ARCHES: Case = Case {
    scene: "masonry_arch",
    source: "specification §6.3, PA-37; Milankovitch 1907, Heyman 1969: a half circle stands from a thickness of 0.107 of its radius on",
    mutation: "parameters.friction=0",
    ..ROCKS
};

const SMOOTH: &[&str] = &["parameters.friction=0.3"];

const DICE: Case = Case {
    scene: "thrown_dice",
    source: "specification §6.3, PA-36 and PA-37: impacts, contacts and friction of many",
    mutation: "networks.thrown.masses.marbles.mass=0.201",
    ..ROCKS
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "rocking_block_falls_back",
        what: "height of the lifted edge of a tilted block after 0.15 s, by integrating θ'' = −p² sin(α − θ): 2 b sin θ",
        reading: Reading::component("falls", 0).after(30),
        reference: 0.012_097_004_855_218_935,
        // of first order: half a step of 1 ms early, as steps from rest are, is 5.4e-5 at the 0.541 rad/s that it turns with then, times 2 b; and as much for the next order
        tolerance: Tolerance::Absolute(1.1e-4),
        mutation: "world.gravity=[0, 0, -10.5]",
        ..ROCKS
    },
    Case {
        id: "rocking_block_rises_again",
        what: "greatest height of the other edge after the first impact, which leaves 1 − sin² α = 0.9 of the velocity: cos(α − θ₁) = cos α + 0.81 (cos(α − θ₀) − cos α)",
        reading: Reading::component("rises", 0).taking(Statistic::Max),
        reference: 0.015_564_760_611_018_306,
        // of first order in steps of 0.125 ms: the way of the edge in one at 0.91 rad/s, and what gravity turns by in one at 4.9 /s² of the 0.82 rad/s after the
        // impact, before and after it, twice since heights go by squares
        tolerance: Tolerance::Absolute(6.9e-5),
        settings: FINE,
        mutation: "networks.rocks.modules.block.rotate.angle=\"0.101 rad\"",
        ..ROCKS
    },
    Case {
        id: "block_stands_on_a_slope",
        what: "how far the top of a block of slenderness 1/3 is after 1.5 s from where it stood on a rough slope of 0.31",
        reading: Reading::last("flatter"),
        // 1e-7 of the g h² = 1e-5 m that a step would sink by, in each of 1500, and some of it along the slope
        reference: 1e-8,
        tolerance: Tolerance::AtMost,
        ..ROCKS
    },
    Case {
        id: "block_topples_on_a_slope",
        what: "and on one of 0.36, where it topples by more than its height",
        reading: Reading::last("steeper"),
        reference: 0.6,
        tolerance: Tolerance::AtLeast,
        mutation: "world.gravity=[0, 0, 0]",
        ..ROCKS
    },
    Case {
        id: "slab_slides_on_faces",
        what: "velocity after 1.5 s of a slab on a slope of 0.4 with friction 0.3: g cos φ (tan φ − μ) t",
        reading: Reading::last("slides"),
        reference: 1.366_253_450_637_657,
        tolerance: Tolerance::Relative(1e-6),
        mutation: "parameters.smooth=0.301",
        ..ROCKS
    },
    Case {
        id: "masonry_arch_stands",
        what: "how far any stone of a half circle of a thickness of 0.15 of its radius is after 0.4 s from where it was laid",
        reading: Reading::last("stands"),
        // a millionth of what a stone would have fallen by: g t²/2 = 0.78 m
        reference: 8e-7,
        tolerance: Tolerance::AtMost,
        ..ARCHES
    },
    Case {
        id: "masonry_arch_bears_on_the_ground",
        what: "what its 56 kg press the ground with",
        reading: Reading::component("thrust", 2),
        reference: -56.0 * 9.81,
        // what contacts are let pass with
        tolerance: Tolerance::Relative(1e-4),
        mutation: "modules.thick_stone.masses.corners.mass=1.001",
        ..ARCHES
    },
    Case {
        id: "masonry_arch_falls",
        what: "how far the key stone of one of 0.08 has come down then",
        reading: Reading::last("falls"),
        // a fifteenth of what it would have fallen by without the others
        reference: -0.05,
        tolerance: Tolerance::AtMost,
        mutation: "world.gravity=[0, 0, 0]",
        ..ARCHES
    },
    Case {
        id: "thrown_dice_rest",
        what: "kinetic energy that is left of dice, pyramids and marbles in a bowl after three seconds",
        reading: Reading::last("moving"),
        // all of them at 0.02 mm/s: a thousand times what contacts are solved to
        reference: 1e-9,
        tolerance: Tolerance::AtMost,
        mutation: "world.gravity=[0, 0, 9.81]",
        ..DICE
    },
    Case {
        id: "thrown_dice_bear_their_weight",
        what: "what their 4.6 kg press the bowl with then",
        reading: Reading::component("borne", 2),
        reference: -4.6 * 9.81,
        tolerance: Tolerance::Relative(1e-6),
        ..DICE
    },
    Case {
        id: "thrown_dice_stay_in_the_bowl",
        what: "least height that any corner of them has come to: none has gone through the bowl",
        reading: Reading::component("lowest", 0).taking(Statistic::Min),
        // what contacts are solved to: 1e-7 of the way of a step of 2 ms at the 6 m/s of what falls from 1.8 m
        reference: -1.2e-9,
        tolerance: Tolerance::AtLeast,
        mutation: "networks.thrown.constraints[1].faces[0].of=[\"first\", \"second\", \"third\", \"fourth\", \"fifth\"]",
        ..DICE
    },
    Case {
        id: "thrown_dice_rest_with_little_friction",
        what: "kinetic energy that is left of them with a friction of 0.3",
        settings: SMOOTH,
        reading: Reading::last("moving"),
        reference: 1e-9,
        tolerance: Tolerance::AtMost,
        mutation: "world.gravity=[0, 0, 9.81]",
        ..DICE
    },
];
