//! A bar whose modulus and density double from end to end.

use crate::{Case, Reading, Tolerance};

const BAR: Case = Case {
    id: "",
    capabilities: &["DEB-53"],
    what: "",
    scene: "graded_bar",
    settings: &[],
    reading: Reading::component("middle", 0),
    refinement: None,
    reference: 0.0,
    // the rule of the middle on 40 cells: h²/24 (f'(1) - f'(0))/ln 2 of f = 1/(1 + x) is 2.8e-5, of the half 3.6e-5
    tolerance: Tolerance::Relative(7e-5),
    source: "σ = E(x) u', E = E₀ (1 + x/L)",
    mutation: "bodies.bar.material_fields.youngs_modulus={ value = \"1e6 * (1 + 1.01 * x)\" }",
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "graded_bar_middle",
        what: "where the middle of a bar goes whose modulus doubles from end to end and whose end goes 1 cm",
        // 1 cm ln 1.5/ln 2
        reference: 5.849_625_007_211_56e-3,
        ..BAR
    },
    Case {
        id: "graded_bar_pull",
        what: "what it takes to pull it",
        reading: Reading::component("pull", 0),
        // E₀ A u/(L ln 2)
        reference: 144.269_504_088_896,
        ..BAR
    },
    Case {
        id: "graded_bar_mass",
        what: "its mass, whose density doubles too",
        reading: Reading::last("mass"),
        // 1500 kg/m³ in the mean: linear, which the middles of cells tell exactly
        reference: 15.0,
        tolerance: Tolerance::Relative(1e-12),
        source: "density 1000 (1 + x) kg/m³",
        mutation: "bodies.bar.material_fields.density={ value = \"1000 * (1 + 1.01 * x)\" }",
        ..BAR
    },
];
