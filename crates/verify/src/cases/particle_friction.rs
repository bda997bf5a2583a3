//! Drag and friction of particles, of a free cube without stiffness to speak of.

use crate::reading::Statistic;
use crate::{Case, Reading, Tolerance};

/// Half of the cube flies off at 1 m/s, half of it rests.
macro_rules! rubbed {
    ($friction:literal) => {
        &[
            "expect=[]",
            "run.duration=\"0.1 s\"",
            "world.gravity=[0, 0, 0]",
            "bodies.cube.pins=[]",
            "bodies.cube.material.youngs_modulus=1e-12",
            r#"bodies.cube.start={ velocity = ["step(0.05, x)", 0, 0] }"#,
            concat!(
                "bodies.cube.damping={ neighbour_friction = ",
                $friction,
                ", friction_filter = true }"
            ),
            r#"probes.resting={ body = "cube", region = { box = [[-1, -1, -1], [0.049, 1, 1]] }, quantity = "displacement", component = "length", reduce = "max" }"#,
            r#"probes.speed={ body = "cube", quantity = "velocity", component = "x", reduce = "min" }"#,
        ]
    };
}

const RESTING: Case = Case {
    id: "friction_speeds_up_nothing",
    capabilities: &["DEB-5"],
    what: "how far particles that rest are taken along in 0.1 s by neighbours that fly past at 1 m/s, where friction is filtered: not at all",
    scene: "particles_cube",
    settings: rubbed!("0.2"),
    reading: Reading::last("resting"),
    refinement: None,
    reference: 0.0,
    // of 1e-12 Pa over 1000 kg/m³ and a third of 0.1 m within 0.1 s, 1e-16 m
    tolerance: Tolerance::Absolute(1e-14),
    source: "specification, 2.5.4: friction that would accelerate a particle is none",
    mutation: "bodies.cube.damping.friction_filter=false",
};

pub(super) const CASES: &[Case] = &[
    RESTING,
    Case {
        id: "friction_turns_nothing_back",
        what: "the slowest that a particle flies within 0.1 s, where friction as strong as 8 of its momenta in a step is filtered: it never turns back",
        settings: rubbed!("200"),
        reading: Reading::last("speed").taking(Statistic::Min),
        reference: -1e-14,
        tolerance: Tolerance::AtLeast,
        source: "specification, 2.5.4: friction that would reverse a particle's motion is none",
        ..RESTING
    },
    Case {
        id: "drag_slows_down",
        what: "speed of the cube after 0.1 s of a drag of 10/s, which had 1 m/s",
        settings: &[
            "expect=[]",
            "run.duration=\"0.1 s\"",
            "world.gravity=[0, 0, 0]",
            "bodies.cube.pins=[]",
            "bodies.cube.velocity=[1, 0, 0]",
            "bodies.cube.damping={ rayleigh_mass = 10 }",
            r#"probes.speed={ body = "cube", quantity = "velocity", component = "x", reduce = "min" }"#,
        ],
        reading: Reading::last("speed"),
        // (1 - α h)^160 of steps of 0.625 ms
        reference: 0.366_726_814_718_600_5,
        tolerance: Tolerance::Relative(1e-9),
        source: "specification, 2.5.4: F = -k v; v' = v - h α v",
        mutation: "bodies.cube.damping.rayleigh_mass=10.1",
        ..RESTING
    },
];
