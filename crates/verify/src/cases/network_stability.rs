//! Lines and clusters at the edge of stability, with links of every kind.

use super::network::OSCILLATOR;
use crate::{Case, Reading, Tolerance};

/// A chain and a cluster at the edge of stability.
const LIMIT: Case = Case {
    capabilities: &["JIM-94"],
    scene: "network_limits",
    source: "EXP-51: q' = (2 - (κ + ζ) λ) q - (1 - ζ λ) q_before from rest, stable up to (κ + 2 ζ) λ = 4",
    ..OSCILLATOR
};

const CHAIN: Case = Case {
    reading: Reading::last("chain").after(200),
    // rounding, which grows as they do
    tolerance: Tolerance::Relative(1e-11),
    mutation: "networks.chain.masses.free.mass=1.00001",
    ..LIMIT
};

const CLUSTER: Case = Case {
    capabilities: &["JIM-94", "JIM-26"],
    reading: Reading::last("cluster").after(10),
    tolerance: Tolerance::Absolute(1e-13),
    mutation: "networks.cluster.masses.balls.mass=1.00001",
    ..LIMIT
};

/// Links with memory at the edge of stability, where the force that a change of sign in each step makes, over the elongation,
/// is 4 M.
const REMEMBERING: Case = Case {
    source: "EXP-51: stable up to H(-1) λ = 4 M (specification §2.6); the law's own recurrence for the mode",
    // rounding, which grows as they do
    tolerance: Tolerance::Relative(1e-10),
    ..CHAIN
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "network_stable",
        capabilities: &["JIM-94"],
        what: "displacement after 100 steps at κ = 1, ζ = 1.49, just below K + 2Z = 4M",
        settings: &[
            "networks.oscillator.links[0].law={ name = \"spring_damper\", stiffness = 100, damping = 14.9 }",
        ],
        reading: Reading::component("place", 0).after(100),
        reference: -0.091_279_440_534_536_52,
        ..OSCILLATOR
    },
    Case {
        id: "network_unstable",
        capabilities: &["JIM-94"],
        what: "the same at ζ = 1.51, just above, where it grows",
        settings: &[
            "networks.oscillator.links[0].law={ name = \"spring_damper\", stiffness = 100, damping = 15.1 }",
        ],
        reading: Reading::component("place", 0).after(100),
        reference: 0.024_432_544_470_258_888,
        ..OSCILLATOR
    },
    Case {
        id: "chain_just_stable",
        what: "a mass of a chain of ten in its fastest mode after 200 steps, its links at 1.02 of their 4M/λ = 1.02067",
        settings: &["parameters.chain.stiffness=1069547.52"],
        reference: -2.940_971_650_302_621,
        ..CHAIN
    },
    Case {
        id: "chain_just_unstable",
        what: "the same at 1.0215: what was a tenth of a metre has grown to 158 km",
        settings: &["parameters.chain.stiffness=1071120.384"],
        reference: 158_110.737_055_827_04,
        ..CHAIN
    },
    Case {
        id: "damped_chain_just_stable",
        what: "the same with dampers, K + 2Z at 1.02",
        settings: &["parameters.chain.stiffness=524288", "parameters.chain.damping=266.24"],
        reference: 5.678_066_773_912_985e-2,
        ..CHAIN
    },
    Case {
        id: "damped_chain_just_unstable",
        what: "the same with K + 2Z at 1.022",
        settings: &["parameters.chain.stiffness=524288", "parameters.chain.damping=267.264"],
        reference: 0.261_013_724_166_939_3,
        ..CHAIN
    },
    Case {
        id: "cluster_just_stable",
        what: "a ball of a tetrahedron of four that breathes, after 100 steps, K = 0.99 M",
        settings: &["parameters.stiffness=1038090.24", "parameters.damping=0"],
        reading: Reading::last("cluster").after(100),
        reference: 0.033_912_209_436_047_74,
        // places of 0.35 m, after a hundred steps that turn by half a circle each
        tolerance: Tolerance::Absolute(1e-12),
        ..CLUSTER
    },
    Case {
        id: "cluster_just_unstable",
        what: "the same after five steps, K = 1.01 M",
        settings: &["parameters.stiffness=1059061.76", "parameters.damping=0"],
        reading: Reading::last("cluster").after(5),
        reference: -0.047_114_681_321_675_6,
        ..CLUSTER
    },
    Case {
        id: "damped_cluster_just_stable",
        what: "the same with damping after forty steps, K + 2Z = 0.98 M",
        settings: &["parameters.stiffness=629145.6", "parameters.damping=194.56"],
        reading: Reading::last("cluster").after(40),
        reference: 6.218_500_445_269_59e-5,
        ..CLUSTER
    },
    Case {
        id: "damped_cluster_just_unstable",
        what: "the same after ten steps, K + 2Z = 1.02 M",
        settings: &["parameters.stiffness=629145.6", "parameters.damping=215.04"],
        reference: 0.011_458_484_968_762_477,
        ..CLUSTER
    },
    Case {
        id: "maxwell_chain_just_stable",
        what: "a mass of a chain of ten of Maxwell's links in its fastest mode after 200 steps, 2 k z/(2 z + k Te) at 0.999 of its limit",
        settings: &[r#"parameters.chain={ name = "maxwell", stiffness = 1445919, viscosity = 2000 }"#],
        reference: 0.038_818_287_563_083_61,
        ..REMEMBERING
    },
    Case {
        id: "maxwell_chain_just_unstable",
        what: "the same at 1.001, where it grows",
        settings: &[r#"parameters.chain={ name = "maxwell", stiffness = 1451714, viscosity = 2000 }"#],
        reference: 3.332_097_429_306_997,
        ..REMEMBERING
    },
    Case {
        id: "burger_chain_just_stable",
        what: "the same of Burger's links, k3 + 1/(1/(k1 + 2 z1/Te) + (2 z2 + k2 Te)/(2 k2 z2)) at 0.998 of its limit",
        settings: &[
            r#"parameters.chain={ name = "burger", solid_stiffness = 500000, solid_viscosity = 1000, fluid_stiffness = 1000000, fluid_viscosity = 3000, stiffness = 425122 }"#,
        ],
        reference: 2.425_654_436_626_984e-3,
        ..REMEMBERING
    },
    Case {
        id: "burger_chain_just_unstable",
        what: "the same at 1.002",
        settings: &[
            r#"parameters.chain={ name = "burger", solid_stiffness = 500000, solid_viscosity = 1000, fluid_stiffness = 1000000, fluid_viscosity = 3000, stiffness = 429395 }"#,
        ],
        reference: 12.031_078_255_678_48,
        ..REMEMBERING
    },
    Case {
        id: "plastic_chain_just_stable",
        what: "the same of elasto-plastic links that do not yield: that of springs at 1.02 of 1.02067",
        settings: &[
            r#"parameters.chain={ name = "elasto_plastic", stiffness = 1069547.52, traction = 1e12 }"#,
        ],
        reference: -2.940_971_650_302_621,
        ..REMEMBERING
    },
    Case {
        id: "plastic_chain_just_unstable",
        what: "the same at 1.0215",
        settings: &[
            r#"parameters.chain={ name = "elasto_plastic", stiffness = 1071120.384, traction = 1e12 }"#,
        ],
        reference: 158_110.737_055_827_04,
        ..REMEMBERING
    },
    Case {
        id: "paste_chain_just_stable",
        what: "the same of pastes that do not flow",
        settings: &[
            r#"parameters.chain={ name = "bingham", stiffness = 1069547.52, viscosity = 100, traction = 1e12, compression = 1e12 }"#,
        ],
        reference: -2.940_971_650_302_621,
        ..REMEMBERING
    },
    Case {
        id: "paste_chain_just_unstable",
        what: "the same at 1.0215",
        settings: &[
            r#"parameters.chain={ name = "bingham", stiffness = 1071120.384, viscosity = 100, traction = 1e12, compression = 1e12 }"#,
        ],
        reference: 158_110.737_055_827_04,
        ..REMEMBERING
    },
    Case {
        id: "compiled_chain_just_stable",
        capabilities: &["JIM-94", "JIM-55"],
        what: "a mass of the chain of Burger's links as a network of springs and dampers after 200 steps, H(-1) at 0.998 of its limit",
        settings: &[
            r#"parameters.chain={ name = "rheological", network = "((spring(5e5) | damper(1000)) - spring(1e6) - damper(3000)) | spring(425122)" }"#,
        ],
        reference: 2.425_654_436_626_984e-3,
        // the elements of the network are solved for as numbers, the law by its polynomials: they part by 1e-6
        tolerance: Tolerance::Relative(1e-5),
        ..REMEMBERING
    },
    Case {
        id: "compiled_chain_just_unstable",
        capabilities: &["JIM-94", "JIM-55"],
        what: "the same at 1.002",
        settings: &[
            r#"parameters.chain={ name = "rheological", network = "((spring(5e5) | damper(1000)) - spring(1e6) - damper(3000)) | spring(429395)" }"#,
        ],
        reference: 12.031_078_255_678_48,
        tolerance: Tolerance::Relative(1e-5),
        ..REMEMBERING
    },
];
