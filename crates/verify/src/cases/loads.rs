//! Traction and a body force that follows a formula of where the points are.
//!
//! A bar of 1 m, `E = 10 kPa`, `ν = 0`, pulled by `p = 100 Pa` at its end and by `c x`, `c = 2 kN/m³`, along its length, comes to rest at
//! `E x'' + c x = 0`, `x(0) = 0`, `E (x'(1) - 1) = p`: `x = (1 + p/E) sin(k X) / (k cos k)` with `k² = c/E`.

use crate::{Case, Limit, Reading, Refinement, Tolerance, Variant};

const BAR: Case = Case {
    id: "loaded_bar_wall",
    capabilities: &["FAU-49"],
    what: "pull on the wall of a bar under a traction and a body force by formula",
    scene: "loaded_bar",
    settings: &[],
    reading: Reading::component("wall", 0),
    refinement: None,
    // -A E (x'(0) - 1), A = 100 cm²
    reference: -12.016_162_871_137_626,
    // forces of a cell go to its corners: the sum of a line is right to (k h)²/12 = 1.9e-5
    tolerance: Tolerance::Relative(2e-5),
    source: "the equation of the rod, in closed form",
    mutation: r#"bodies.bar.loads[0].traction=["101 Pa", 0, 0]"#,
};

pub(super) const CASES: &[Case] = &[
    BAR,
    Case {
        id: "loaded_bar_order",
        what: "order of the error of its tip by the cell",
        reading: Reading::component("tip", 0),
        refinement: Some(Refinement {
            size_of: "cell [m]",
            runs: &[
                Variant { size: 1.0 / 15.0, settings: &["bodies.bar.mesh.cells=[15, 1, 1]"] },
                Variant { size: 1.0 / 30.0, settings: &["bodies.bar.mesh.cells=[30, 1, 1]"] },
                Variant { size: 1.0 / 60.0, settings: &["bodies.bar.mesh.cells=[60, 1, 1]"] },
            ],
            limit: Limit::Known(0.083_194_521_859_585_31),
        }),
        reference: 2.0,
        // what the next order leaves, (k h)² of the coarsest
        tolerance: Tolerance::Absolute(1e-2),
        mutation: r#"bodies.bar.loads[1].body_force=["2010 * x", 0, 0]"#,
        ..BAR
    },
];
