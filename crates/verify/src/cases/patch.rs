//! Deformed alike everywhere: the patch test on meshes of all volume elements, linear and quadratic, and of the surface elements in
//! plane strain, and its stresses and energies.
//!
//! Cells are regular here, which tries that elements meet; `crooked_patch` has crooked ones.

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

const QUADRATIC: &str = r#"bodies.bar.mesh.element="mixed_quadratic""#;
const HEX27: &str = r#"bodies.bar.mesh.element="hex27""#;

/// All sides of the plate led by one linear map.
const LED: &str = r#"bodies.plate.pins=[{ region = { union = [{ group = "x_min" }, { group = "x_max" }, { group = "y_min" }, { group = "y_max" }] }, motion = { formula = "[t * (0.05 * x + 0.03 * y), t * (0.02 * x - 0.04 * y), 0]" } }]"#;
const PLANE_STRAIN: &str = r#"bodies.plate.section.name="plane_strain""#;
const PLANE_STVK: &str = r#"bodies.plate.material.name="st_venant_kirchhoff""#;

/// A plate of an element, led.
macro_rules! plate {
    ($element:literal) => {
        &[concat!("bodies.plate.mesh.element=\"", $element, "\""), PLANE_STRAIN, PLANE_STVK, LED]
    };
}

/// `E = (FᵀF - I)/2` with no strain across, 0.48 m² 10 mm thick.
const PLANE_ENERGY: f64 = {
    const F: [[f64; 2]; 2] = [[1.05, 0.03], [0.02, 0.96]];
    const MU: f64 = 1e6 / 2.6;
    const LAMBDA: f64 = 1e6 * 0.3 / (1.3 * 0.4);
    let xx = 0.5 * (F[0][0] * F[0][0] + F[1][0] * F[1][0] - 1.0);
    let yy = 0.5 * (F[0][1] * F[0][1] + F[1][1] * F[1][1] - 1.0);
    let xy = 0.5 * (F[0][0] * F[0][1] + F[1][0] * F[1][1]);
    (MU * (xx * xx + yy * yy + 2.0 * xy * xy) + 0.5 * LAMBDA * (xx + yy) * (xx + yy)) * 0.48 * 0.01
};

const PLANE: Case = Case {
    capabilities: &["FAU-1", "FAU-3"],
    scene: "plate",
    reference: PLANE_ENERGY,
    // sums of some fifty samples of numbers near one, less than a hundred roundings each
    tolerance: Tolerance::Relative(1e-12),
    source: "thickness times area times the energy density at given F",
    mutation: "bodies.plate.material.poissons_ratio=0.3001",
    ..ENERGY
};

const PLANE_MIDDLE: Case = Case {
    reading: Reading::component("middle", 0),
    reference: 0.05 * 0.6 + 0.03 * 0.2,
    tolerance: Tolerance::Absolute(1e-12),
    source: "(F - I) X",
    // of the sides all is given: only another map moves the inside
    mutation: r#"bodies.plate.pins[0].motion.formula="[t * (0.05 * x + 0.03 * y * y), 0, 0]""#,
    ..PLANE
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
    Case {
        id: "patch_quadratic_displacement",
        capabilities: &["FAU-1", "FAU-3", "FAU-53"],
        what: "a node inside a patch of tet10, hex20, prism15 and pyramid13 lands where the linear map puts it",
        settings: &[QUADRATIC],
        reading: Reading::component("inside", 0),
        reference: 0.14,
        tolerance: Tolerance::Absolute(1e-12),
        source: "(F - I) X",
        mutation: r#"bodies.bar.pins[0].motion.formula="[t * (0.1 * x + 0.05 * y * y - 0.02 * z), 0, 0]""#,
        ..ENERGY
    },
    Case {
        id: "patch_quadratic_energy",
        capabilities: &["FAU-1", "FAU-3", "FAU-53"],
        what: "energy of that patch, st_venant_kirchhoff",
        settings: &[QUADRATIC],
        reference: 318086.1923076925,
        ..ENERGY
    },
    Case {
        id: "patch_quadratic_neo_hookean_energy",
        capabilities: &["FAU-1", "FAU-3", "FAU-53"],
        what: "the same, neo_hookean",
        settings: &[QUADRATIC, NEO_HOOKEAN],
        reference: 264459.5712602865,
        ..ENERGY
    },
    Case {
        id: "patch_hex27_displacement",
        capabilities: &["FAU-1", "FAU-3", "FAU-29"],
        what: "a node inside a patch of hex27 lands where the linear map puts it",
        settings: &[HEX27],
        reading: Reading::component("inside", 0),
        reference: 0.14,
        tolerance: Tolerance::Absolute(1e-12),
        source: "(F - I) X",
        mutation: r#"bodies.bar.pins[0].motion.formula="[t * (0.1 * x + 0.05 * y * y - 0.02 * z), 0, 0]""#,
        ..ENERGY
    },
    Case {
        id: "patch_hex27_energy",
        capabilities: &["FAU-1", "FAU-3", "FAU-29"],
        what: "energy of that patch, st_venant_kirchhoff",
        settings: &[HEX27],
        reference: 318086.1923076925,
        ..ENERGY
    },
    Case {
        id: "patch_tri3",
        what: "a node inside a plate of tri3 whose sides are led lands where the linear map puts it",
        settings: plate!("tri3"),
        ..PLANE_MIDDLE
    },
    Case { id: "patch_tri3_energy", what: "energy of that plate", settings: plate!("tri3"), ..PLANE },
    Case {
        id: "patch_quad4",
        what: "a node inside a plate of quad4 whose sides are led lands where the linear map puts it",
        settings: plate!("quad4"),
        ..PLANE_MIDDLE
    },
    Case { id: "patch_quad4_energy", what: "energy of that plate", settings: plate!("quad4"), ..PLANE },
    Case {
        id: "patch_tri6",
        what: "a node inside a plate of tri6 whose sides are led lands where the linear map puts it",
        settings: plate!("tri6"),
        ..PLANE_MIDDLE
    },
    Case { id: "patch_tri6_energy", what: "energy of that plate", settings: plate!("tri6"), ..PLANE },
    Case {
        id: "patch_quad8",
        what: "a node inside a plate of quad8 whose sides are led lands where the linear map puts it",
        settings: plate!("quad8"),
        ..PLANE_MIDDLE
    },
    Case { id: "patch_quad8_energy", what: "energy of that plate", settings: plate!("quad8"), ..PLANE },
    Case {
        id: "patch_quad9",
        capabilities: &["FAU-1", "FAU-3", "FAU-29"],
        what: "a node inside a plate of quad9 whose sides are led lands where the linear map puts it",
        settings: plate!("quad9"),
        ..PLANE_MIDDLE
    },
    Case {
        id: "patch_quad9_energy",
        capabilities: &["FAU-1", "FAU-3", "FAU-29"],
        what: "energy of that plate",
        settings: plate!("quad9"),
        ..PLANE
    },
];
