//! Points that follow others: what is a linear map of the body at rest stays one, also where weights extrapolate at the border.
//!
//! Bodies fly and spin without stiffness to speak of, so that each point that moves by itself goes straight on with the velocity that it has, which is linear
//! in the place at rest; where the others have to be is known.

use crate::{Case, Reading, Tolerance};

const CUBE: Case = Case {
    id: "ghosts_are_linear",
    capabilities: &["DEB-28", "DEB-29"],
    what: "farthest that a point of a cube of three meshes is from a translation and a linear map of it, by 0.1 m and more, where each mesh follows the others in part",
    scene: "levels_free",
    settings: &[
        "expect=[]",
        "run.duration=\"0.1 s\"",
        "bodies.cube.material.youngs_modulus=1e-12",
        "bodies.cube.angular_velocity=[2, 4, 8]",
        r#"probes.off={ body = "cube", quantity = "displacement", component = "length", reduce = "max", against = { formula = "[t * (0.3 + 4 * (z - 0.05) - 8 * (y - 0.05)), t * (0.1 + 8 * (x - 0.05) - 2 * (z - 0.05)), t * (2 * (y - 0.05) - 4 * (x - 0.05))]" } }"#,
    ],
    reading: Reading::last("off"),
    refinement: None,
    reference: 1e-12,
    tolerance: Tolerance::AtMost,
    source: "specification, V-32 (a): rigid translation and any globally linear displacement exactly, to 1e-12",
    // as stiff as that its spin stretches it by 0.3 mm: points go other ways
    mutation: "bodies.cube.material.youngs_modulus=1",
};

pub(super) const CASES: &[Case] = &[
    CUBE,
    Case {
        id: "border_ghosts_are_linear",
        what: "the same of a ball, on the border of which points of one mesh are outside of the others and extrapolate",
        settings: &[
            "expect=[]",
            "run.duration=\"0.1 s\"",
            r#"bodies.cube.mesh={ shape = "ellipsoid", semi_axes = [0.05, 0.05, 0.05], size = 0.012 }"#,
            r#"bodies.cube.levels={ count = 3, fixed = "if(x < 0, 2, if(y < 0, 1, 0))" }"#,
            "bodies.cube.material.youngs_modulus=1e-12",
            "bodies.cube.angular_velocity=[2, 4, 8]",
            // about its centre of mass, (-0.06, -0.12, -0.12) µm as it is filled
            r#"probes.off={ body = "cube", quantity = "displacement", component = "length", reduce = "max", against = { formula = "[t * (0.3 + 4 * (z + 1.21407427e-7) - 8 * (y + 1.21407427e-7)), t * (0.1 + 8 * (x + 6.07037135e-8) - 2 * (z + 1.21407427e-7)), t * (2 * (y + 1.21407427e-7) - 4 * (x + 6.07037135e-8))]" } }"#,
        ],
        ..CUBE
    },
    Case {
        id: "daughters_are_linear",
        capabilities: &["DEB-11"],
        what: "the same of the 256 finest particles of a rod, placed in the frames of 32 that move",
        scene: "octree_rod",
        settings: &[
            "expect=[]",
            "run.duration=\"0.1 s\"",
            "bodies.rod.pins=[]",
            "bodies.rod.damping=",
            "world.gravity=[0, 0, 0]",
            "bodies.rod.velocity=[0.3, 0.1, 0]",
            "bodies.rod.angular_velocity=[2, 4, 8]",
            r#"bodies.rod.octree={ levels = 2, fixed = "0" }"#,
            "bodies.rod.material.youngs_modulus=1e-12",
            r#"probes.off={ body = "rod", quantity = "displacement", component = "length", reduce = "max", against = { formula = "[t * (0.3 + 4 * (z - 0.003) - 8 * (y - 0.003)), t * (0.1 + 8 * (x - 0.015) - 2 * (z - 0.003)), t * (2 * (y - 0.003) - 4 * (x - 0.015))]" } }"#,
        ],
        source: "DEB-11: linear deformation is reproduced",
        // which stay
        mutation: r#"bodies.rod.pins=[{ region = { group = "x_min" } }]"#,
        ..CUBE
    },
];
