//! Bodies that are fillings of shapes: what is known of them without a mesh.

use crate::{Case, Reading, Tolerance};

const WEIGHT: Case = Case {
    id: "liver_weight_10k",
    capabilities: &["DEB-56"],
    what: "pull of the ligaments on the organ of ten thousand tetrahedra at rest: its weight",
    scene: "liver",
    settings: &["bodies.liver.mesh.size=0", "bodies.liver.mesh.count=10000"],
    reading: Reading::component("hanging", 1).after(70),
    refinement: None,
    // 1060 kg/m³ x 9.81 m/s² x 1.2651e-3 m³
    reference: 13.155,
    // the volume of a filling of that size is wrong by 2 % at most
    tolerance: Tolerance::Relative(0.02),
    source: "density times gravity times the volume of a filling of 100,000 tetrahedra",
    mutation: "bodies.liver.material.density=1200",
};

pub(super) const CASES: &[Case] = &[
    WEIGHT,
    Case {
        id: "liver_weight_1k",
        what: "the same of a thousand tetrahedra, after a hundred steps",
        settings: &[
            "bodies.liver.mesh.size=0",
            "bodies.liver.mesh.count=1000",
            "shapes.tool.motion.times=[0, 9]",
            "shapes.tool.motion.offsets=[[0, 0, 0], [0, 0, 0]]",
        ],
        reading: Reading::component("hanging", 1).after(100),
        // a thousand tetrahedra cut off more of the shape's edges
        tolerance: Tolerance::Relative(0.06),
        mutation: "bodies.liver.material.density=1400",
        ..WEIGHT
    },
    Case {
        id: "liver_falls_100k",
        what: "energy of a hundred steps of fall of the organ of a hundred thousand tetrahedra, hanging from its ligaments",
        settings: &[
            "bodies.liver.mesh.size=0",
            "bodies.liver.mesh.count=100000",
            r#"systems.main.stepper="symplectic_euler""#,
            "bodies.liver.damping.rayleigh_stiffness=0",
            r#"world.period="20 us""#,
        ],
        reading: Reading::last("kinetic").after(100),
        // 1/2 m (g t)², 1.341 kg and 2 ms
        reference: 2.58e-4,
        // the volume is right to 2 %; waves from the ligaments have come as far as 2 cm into twenty, and brake a tenth of it at most
        tolerance: Tolerance::Relative(0.14),
        source: "free fall of what the ligaments do not hold yet",
        mutation: "world.gravity=[0, -20, 0]",
        ..WEIGHT
    },
    Case {
        id: "liver_weight_mixed",
        capabilities: &["DEB-56", "FAU-53", "FAU-59"],
        what: "the same on hexahedra inside, prisms, pyramids and tetrahedra around them",
        settings: &[
            "bodies.liver.mesh.size=0",
            "bodies.liver.mesh.count=10000",
            "bodies.liver.mesh.element=\"hex_dominant\"",
        ],
        ..WEIGHT
    },
];
