//! Skins: tension, rest, what is held constant, metamorphosis, cost by resolution.

use crate::{Case, Limit, Reading, Refinement, Tolerance, Variant};

const SOURCE: &str = "Desbrun & Cani-Gascuel 1998, Active implicit surface for animation";

const SKIN: Case = Case {
    id: "",
    capabilities: &[],
    what: "",
    scene: "sphere_under_tension",
    settings: &[],
    reading: Reading::last("volume"),
    refinement: None,
    reference: 0.0,
    tolerance: Tolerance::Relative(0.02),
    source: SOURCE,
    mutation: "",
};

/// The time in which R² falls to half, and the volume `4/3 π (1/2)^(3/2)` that is left.
const HALF: f64 = 1.480_960_979_386_122;

pub(super) const CASES: &[Case] = &[
    Case {
        id: "skin_shrinking_sphere",
        capabilities: &["DC-5"],
        what: "volume of a sphere under tension when R^2 = R0^2 - 4 beta t has halved, 64 cells in its diameter",
        settings: &["skins.ball.voxel=0.03125"],
        reference: HALF,
        // 1 % of R² is 1.5 % of the volume
        tolerance: Tolerance::Relative(0.015),
        mutation: "skins.ball.terms[0].strength=0.11",
        ..SKIN
    },
    Case {
        id: "skin_curvature_order",
        capabilities: &["DC-5"],
        what: "order of the mean curvature of a sphere's skin at the start",
        reading: Reading::last("curvature").after(0),
        refinement: Some(Refinement {
            size_of: "voxel [m]",
            runs: &[
                Variant { size: 0.125, settings: &["skins.ball.voxel=0.125", "skins.ball.redistance=0"] },
                Variant { size: 0.0625, settings: &["skins.ball.voxel=0.0625", "skins.ball.redistance=0"] },
            ],
            limit: Limit::Known(2.0),
        }),
        reference: 2.0,
        tolerance: Tolerance::Absolute(0.3),
        mutation: "skins.ball.start[0].formula=\"0.95 - sqrt(x^2 + y^2 + z^2)\"",
        ..SKIN
    },
    Case {
        id: "skin_rest",
        capabilities: &["DC-6"],
        what: "greatest speed of a skin ten seconds after it was let go to a fixed target at half a metre per second",
        scene: "skin_at_rest",
        reading: Reading::last("speed"),
        reference: 0.0,
        tolerance: Tolerance::Absolute(1e-3),
        mutation: "skins.peanut.parts[0].motion=[\"0.2*sin(3*t)\", 0, 0]",
        ..SKIN
    },
    Case {
        id: "skin_held_volume",
        capabilities: &["DC-7"],
        what: "volume of a drop held against tension, after 1,000 steps",
        scene: "skin_held",
        // that of its triangles at the start; 0.1 % of drift
        reference: 4.150_741_847_3,
        tolerance: Tolerance::Relative(1e-3),
        mutation: "skins.drop.terms[1].rate=0.04",
        ..SKIN
    },
    Case {
        id: "skin_metamorphosis_parts",
        capabilities: &["DC-4"],
        what: "parts of a skin that went from six lobes to two balls",
        scene: "skin_metamorphosis",
        reading: Reading::last("components"),
        reference: 2.0,
        tolerance: Tolerance::Absolute(0.0),
        mutation: "skins.shape.terms[0].strength=0",
        ..SKIN
    },
    Case {
        id: "skin_metamorphosis_euler",
        capabilities: &["DC-3", "DC-4"],
        what: "its Euler characteristic: 2 for each ball",
        scene: "skin_metamorphosis",
        reading: Reading::last("euler"),
        reference: 4.0,
        tolerance: Tolerance::Absolute(0.0),
        mutation: "skins.shape.terms[0].strength=0",
        ..SKIN
    },
    Case {
        id: "skin_cost_order",
        capabilities: &["DC-8"],
        what: "order of the blocks that a sphere's grid keeps, by the voxel: the area's, not the volume's",
        reading: Reading::last("blocks").after(0),
        refinement: Some(Refinement {
            size_of: "voxel [m]",
            runs: &[
                Variant { size: 0.03125, settings: &["skins.ball.voxel=0.03125"] },
                Variant { size: 0.015_625, settings: &["skins.ball.voxel=0.015625"] },
            ],
            limit: Limit::Known(0.0),
        }),
        reference: -2.0,
        tolerance: Tolerance::Absolute(0.15),
        mutation: "skins.ball.start[0].formula=\"0.05 - sqrt(x^2 + y^2 + z^2)\"",
        ..SKIN
    },
    Case {
        id: "skin_dresses_one",
        capabilities: &["DC-1"],
        what: "parts of the skin over two balls while they touch",
        scene: "skin_dresses",
        reading: Reading::last("components").after(120),
        reference: 1.0,
        tolerance: Tolerance::Absolute(0.0),
        mutation: "skins.flesh.terms[0].strength=0",
        ..SKIN
    },
];
