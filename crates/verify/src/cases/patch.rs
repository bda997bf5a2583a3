//! Deformed alike everywhere: the patch test on a mesh of all four elements, and its stresses and energies.

use super::bar::{COROTATIONAL, LINEAR, NEO_HOOKEAN, ST_VENANT_KIRCHHOFF};
use crate::{Case, Reading, Tolerance};

// 2 m³ of what the reference gives per m³
const ENERGY: Case = Case {
    id: "",
    capabilities: &["FAU-3", "FAU-53"],
    what: "",
    scene: "patch",
    settings: &[],
    reading: Reading::last("energy"),
    refinement: None,
    reference: f64::NAN,
    // twelve digits are printed; energies add up some 500 cells
    tolerance: Tolerance::Relative(1e-11),
    source: "energy density at given F, 12 digits",
    mutation: "bodies.bar.material.poissons_ratio=0.3001",
};

// a stress is a difference of nodes 0.25 m apart that Newton's method leaves 1e-12 m from where they belong: 1e-12 / 0.25
// of the stretch, ten times that of the stress
const STRESS: Case = Case {
    what: "",
    reading: Reading::last("most_stress"),
    tolerance: Tolerance::Relative(1e-10),
    source: "von Mises stress of P Fᵀ / J with P at given F, 12 digits",
    ..ENERGY
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "patch_displacement",
        what: "a node inside a patch of every element lands where the linear map puts it",
        reading: Reading::component("inside", 0),
        reference: 0.14,
        tolerance: Tolerance::Absolute(1e-12),
        source: "(F - I) X",
        // of the surface all is given: only another map moves the inside
        mutation: r#"bodies.bar.pins[0].motion.formula="[t * (0.1 * x + 0.05 * y * y - 0.02 * z), 0, 0]""#,
        ..ENERGY
    },
    Case {
        id: "patch_linear_energy",
        what: "energy of the patch, linear",
        settings: &[LINEAR],
        reference: 284807.6923076927,
        ..ENERGY
    },
    Case {
        id: "patch_corotational_energy",
        what: "energy of the patch, corotational",
        settings: &[COROTATIONAL],
        reference: 285203.45182176837,
        ..ENERGY
    },
    Case {
        id: "patch_stvk_energy",
        what: "energy of the patch, st_venant_kirchhoff",
        settings: &[ST_VENANT_KIRCHHOFF],
        reference: 318086.1923076925,
        ..ENERGY
    },
    Case {
        id: "patch_neo_hookean_energy",
        what: "energy of the patch, neo_hookean",
        settings: &[NEO_HOOKEAN],
        reference: 264459.5712602865,
        ..ENERGY
    },
    Case {
        id: "patch_corotational_stress",
        what: "greatest stress in the patch, corotational",
        settings: &[COROTATIONAL],
        reference: 1297445.1010940974,
        ..STRESS
    },
    Case {
        id: "patch_stvk_stress",
        what: "greatest stress in the patch, st_venant_kirchhoff",
        settings: &[ST_VENANT_KIRCHHOFF],
        reference: 1516976.6896302635,
        ..STRESS
    },
    Case {
        id: "patch_stvk_least_stress",
        what: "least stress in the patch: the same",
        settings: &[ST_VENANT_KIRCHHOFF],
        reading: Reading::last("least_stress"),
        reference: 1516976.6896302635,
        ..STRESS
    },
    Case {
        id: "patch_neo_hookean_stress",
        what: "greatest stress in the patch, neo_hookean",
        settings: &[NEO_HOOKEAN],
        reference: 1165006.9563095479,
        ..STRESS
    },
];
