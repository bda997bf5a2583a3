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
        id: "liver_weight_mixed",
        capabilities: &["DEB-56", "FAU-53", "FAU-59"],
        what: "the same on hexahedra inside, pyramids and tetrahedra around them",
        settings: &[
            "bodies.liver.mesh.size=0",
            "bodies.liver.mesh.count=10000",
            "bodies.liver.mesh.element=\"hex_dominant\"",
        ],
        ..WEIGHT
    },
];
