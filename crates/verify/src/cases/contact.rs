//! Contact: what carries, what sticks, what slides, what is conserved.

use crate::{Case, Reading, Tolerance};

const INCLINE: Case = Case {
    id: "",
    capabilities: &["FAU-92"],
    what: "",
    scene: "",
    settings: &[],
    reading: Reading::component("speed", 0),
    refinement: None,
    reference: f64::NAN,
    tolerance: Tolerance::Absolute(f64::NAN),
    source: "Coulomb: friction 0.5 holds up to atan 0.5 = 26.57 degrees",
    mutation: "",
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "soft_block_rests",
        what: "the floor carries the weight of a block at rest, m g",
        scene: "soft_block",
        reading: Reading::component("floor", 1),
        reference: 117.72,
        tolerance: Tolerance::Relative(0.01),
        source: "1000 kg/m3 x 0.012 m3 x 9.81 m/s2",
        mutation: "bodies.block.material.density=1050",
        ..INCLINE
    },
    Case {
        id: "incline_sticks",
        what: "speed of a block on an incline 2 % below the angle of friction: none",
        scene: "incline_sticks",
        reference: 0.0,
        // what sticks comes to rest exactly as far as Newton's method goes: 1e-7 of the force over a second
        tolerance: Tolerance::Absolute(1e-6),
        // 26.03 degrees are beyond atan 0.48 = 25.64 degrees
        mutation: "contacts[0].friction=0.48",
        ..INCLINE
    },
    Case {
        id: "incline_slides",
        what: "speed of a block after a second on an incline 2 % above the angle of friction",
        scene: "incline_slides",
        // (g_x - 0.5 g_y) 1 s
        reference: 0.1025,
        // friction is less than full while the block settles; half a percent of the coefficient is 0.0025 g_y 1 s
        tolerance: Tolerance::Absolute(0.0218),
        mutation: "contacts[0].friction=0.49",
        ..INCLINE
    },
    Case {
        id: "collision_momentum",
        what: "momentum after two balls of 4 kg m/s each have collided",
        scene: "collision",
        reading: Reading::component("momentum", 0),
        reference: 0.0,
        tolerance: Tolerance::Absolute(1e-11),
        source: "conservation: rounding of 2500 steps of sums over two bodies",
        mutation: "bodies.left.velocity=[1.001, 0, 0]",
        ..INCLINE
    },
    Case {
        id: "collision_momentum_across",
        what: "momentum across the collision, where friction acts",
        scene: "collision",
        reading: Reading::component("momentum", 1),
        reference: 0.0,
        tolerance: Tolerance::Absolute(1e-11),
        source: "conservation: rounding of 2500 steps of sums over two bodies",
        mutation: "bodies.left.velocity=[1, 0.001, 0]",
        ..INCLINE
    },
];
