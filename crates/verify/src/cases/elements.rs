//! Quadratic elements, plane bodies, membranes and cables: discrete answers of independent codes, orders on a smooth
//! solution, and closed forms.
//!
//! On the cube the exact energy is known and the error is a sum of even powers of the cells' size: linear elements lose
//! `C h²`, quadratic ones `C h⁴`. Between the two finest meshes the next power, which is no more than the first at the
//! coarser of the two, moves the order by `log₂ (1 + 1/4) / (1 + 1/16)` = 0.23 at most.

use std::f64::consts::E;

use super::bar::{FULL_RULE, LINEAR, N1, N2, ST_VENANT_KIRCHHOFF};
use crate::{Case, Limit, Reading, Refinement, Tolerance, Variant};

const TET10: &str = r#"bodies.bar.mesh.element="tet10""#;
const HEX20: &str = r#"bodies.bar.mesh.element="hex20""#;

const BAR: Case = Case {
    id: "",
    capabilities: &["FAU-1", "FAU-58", "FAU-73"],
    what: "",
    scene: "cantilever",
    settings: &[],
    reading: Reading::component("tip", 1),
    refinement: None,
    reference: f64::NAN,
    // as with linear elements: the solver stops at 1e-7 of the largest force
    tolerance: Tolerance::Relative(1e-6),
    source: "GetFEM, FEM_PK(3,2), full integration",
    mutation: r#"bodies.bar.material.youngs_modulus="10.001 MPa""#,
};

// seven digits are printed: half of the last of 0.1447001 is 3.5e-7 of it
const CALCULIX: Case = Case { source: "CalculiX, C3D20, seven digits", ..BAR };

const DEFAULT_RULE: &str = r#"bodies.bar.quadrature="default""#;

/// Energy on the harmonic cube, `∫ μ ε:ε` in closed form.
const ENERGY: f64 = 4297.566239908445;

const fn halved(runs: &'static [Variant]) -> Option<Refinement> {
    Some(Refinement { size_of: "cell [m]", runs, limit: Limit::Known(ENERGY) })
}

const TO_8: &[Variant] = &[
    Variant { size: 0.5, settings: &["parameters.cells=[2, 2, 2]"] },
    Variant { size: 0.25, settings: &["parameters.cells=[4, 4, 4]"] },
    Variant { size: 0.125, settings: &["parameters.cells=[8, 8, 8]"] },
];

const TO_4: &[Variant] = TO_8.split_at(2).0;

const CUBE: Case = Case {
    id: "",
    capabilities: &["FAU-1", "FAU-5", "FAU-58"],
    what: "",
    scene: "harmonic_cube",
    settings: &[],
    reading: Reading::last("energy"),
    refinement: halved(TO_4),
    reference: 4.0,
    tolerance: Tolerance::Absolute(0.23),
    source: "Strang & Fix 1973, §3.4; the energy is an integral of exponentials and cosines",
    // another material: the error does not fall at all
    mutation: "bodies.cube.material.poissons_ratio=0.301",
};

/// The same in the plane: `0.05² μ (e² − 1)` of a slice 10 mm thick.
const SHEET: Case = Case {
    capabilities: &["FAU-1", "FAU-58"],
    scene: "harmonic_sheet",
    refinement: of_sheet(&[SHEET_8, SHEET_16]),
    source: "Strang & Fix 1973, §3.4; the energy is an integral of an exponential",
    mutation: "bodies.sheet.material.poissons_ratio=0.301",
    ..CUBE
};

const SHEET_ENERGY: f64 = 0.05 * 0.05 * 1e6 / 2.6 * (E * E - 1.0) * 0.01;

const fn of_sheet(runs: &'static [Variant]) -> Option<Refinement> {
    Some(Refinement { size_of: "cell [m]", runs, limit: Limit::Known(SHEET_ENERGY) })
}

const SHEET_8: Variant = Variant { size: 1.0 / 8.0, settings: &["parameters.cells=8"] };
const SHEET_16: Variant = Variant { size: 1.0 / 16.0, settings: &["parameters.cells=16"] };
const SHEET_32: Variant = Variant { size: 1.0 / 32.0, settings: &["parameters.cells=32"] };

const PLATE: Case = Case {
    id: "",
    capabilities: &["FAU-1", "FAU-7", "FAU-72"],
    what: "",
    scene: "plate",
    settings: &[],
    reading: Reading::component("pull", 0),
    refinement: None,
    reference: f64::NAN,
    // uniform stretch: what Newton's method leaves
    tolerance: Tolerance::Relative(1e-9),
    source: "E A ε",
    mutation: r#"bodies.plate.material.youngs_modulus="1.001 MPa""#,
};

/// A cable's sag is smooth: chords lose `C h²`, parabolas `C h⁴`.
const CABLE: Case = Case {
    capabilities: &["FAU-1"],
    scene: "hanging_cable",
    reading: Reading::component("middle", 1),
    reference: SAG,
    source: "Irvine 1981, §2.5, elastic catenary",
    mutation: r#"bodies.cable.material.youngs_modulus="1.01 MPa""#,
    ..PLATE
};

const SAG: f64 = -0.0776853321711402;

const fn of_cable(runs: &'static [Variant]) -> Option<Refinement> {
    Some(Refinement { size_of: "cell [m]", runs, limit: Limit::Known(SAG) })
}

const PLANE_STRAIN: &str = r#"bodies.plate.section.name="plane_strain""#;
const TRI3: &str = r#"bodies.plate.mesh.element="tri3""#;
const TRI6: &str = r#"bodies.plate.mesh.element="tri6""#;
const QUAD4: &str = r#"bodies.plate.mesh.element="quad4""#;

pub(super) const CASES: &[Case] = &[
    Case {
        id: "cantilever_tet10_linear_n1",
        what: "tip of the clamped bar, tet10, linear, n = 1",
        settings: &[N1, TET10, LINEAR, DEFAULT_RULE],
        reference: -0.14401940250921832,
        ..BAR
    },
    Case {
        id: "cantilever_tet10_stvk_n1",
        what: "tip of the clamped bar, tet10, st_venant_kirchhoff, n = 1",
        settings: &[N1, TET10, ST_VENANT_KIRCHHOFF, FULL_RULE],
        reference: -0.14174416705698895,
        ..BAR
    },
    Case {
        id: "cantilever_tet10_linear_n2",
        what: "tip of the clamped bar, tet10, linear, n = 2",
        settings: &[N2, TET10, LINEAR, DEFAULT_RULE],
        reference: -0.14651653058648703,
        ..BAR
    },
    Case {
        id: "cantilever_hex20_linear_n1",
        what: "tip of the clamped bar, hex20, linear, n = 1",
        settings: &[N1, HEX20, LINEAR, DEFAULT_RULE],
        reference: -0.1447001,
        ..CALCULIX
    },
    Case {
        id: "cantilever_hex20_linear_n2",
        what: "tip of the clamped bar, hex20, linear, n = 2",
        settings: &[N2, HEX20, LINEAR, DEFAULT_RULE],
        reference: -0.1466165,
        ..CALCULIX
    },
    Case {
        id: "cantilever_hex20_stvk_n1",
        what: "tip of the clamped bar, hex20, st_venant_kirchhoff, 27 samples as there, n = 1",
        settings: &[N1, HEX20, ST_VENANT_KIRCHHOFF, DEFAULT_RULE],
        reference: -0.14240015,
        ..CALCULIX
    },
    Case {
        id: "order_tet4_smooth_energy",
        what: "order of the energy's error on a smooth solution, tet4",
        settings: &[r#"parameters.element="tet4""#],
        refinement: halved(TO_8),
        reference: 2.0,
        ..CUBE
    },
    Case {
        id: "order_tet10_smooth_energy",
        what: "order of the energy's error on a smooth solution, tet10",
        settings: &[r#"parameters.element="tet10""#],
        ..CUBE
    },
    Case {
        id: "order_hex20_smooth_energy",
        what: "order of the energy's error on a smooth solution, hex20",
        settings: &[r#"parameters.element="hex20""#],
        ..CUBE
    },
    Case {
        id: "order_hex27_smooth_energy",
        capabilities: &["FAU-1", "FAU-5", "FAU-29", "FAU-58"],
        what: "order of the energy's error on a smooth solution, hex27",
        settings: &[r#"parameters.element="hex27""#],
        ..CUBE
    },
    Case {
        id: "order_prism15_smooth_energy",
        what: "order of the energy's error on a smooth solution, prism15",
        settings: &[r#"parameters.element="prism15""#],
        ..CUBE
    },
    Case {
        id: "order_pyramid13_smooth_energy",
        what: "order of the energy's error on a smooth solution, pyramid13",
        settings: &[r#"parameters.element="pyramid13""#],
        ..CUBE
    },
    Case {
        id: "order_tri3_smooth_energy",
        what: "order of the energy's error on a smooth solution in the plane, tri3",
        settings: &[r#"parameters.element="tri3""#],
        refinement: of_sheet(&[SHEET_16, SHEET_32]),
        reference: 2.0,
        // the triangles cut off at two corners have no point of their own, which adds an odd power: `log₂ (1 + 1/2) / (1 + 1/4)`
        tolerance: Tolerance::Absolute(0.26),
        ..SHEET
    },
    Case {
        id: "order_quad4_smooth_energy",
        what: "order of the energy's error on a smooth solution in the plane, quad4",
        settings: &[r#"parameters.element="quad4""#],
        reference: 2.0,
        ..SHEET
    },
    Case {
        id: "order_tri6_smooth_energy",
        what: "order of the energy's error on a smooth solution in the plane, tri6",
        settings: &[r#"parameters.element="tri6""#],
        ..SHEET
    },
    Case {
        id: "order_quad8_smooth_energy",
        what: "order of the energy's error on a smooth solution in the plane, quad8",
        settings: &[r#"parameters.element="quad8""#],
        ..SHEET
    },
    Case {
        id: "order_quad9_smooth_energy",
        capabilities: &["FAU-1", "FAU-29", "FAU-58"],
        what: "order of the energy's error on a smooth solution in the plane, quad9",
        settings: &[r#"parameters.element="quad9""#],
        ..SHEET
    },
    Case {
        id: "mixed_quadratic_tip",
        capabilities: &["FAU-1", "FAU-53", "FAU-58"],
        what: "tip of a bar of tet10, hex20, prism15 and pyramid13 in one mesh",
        scene: "mixed_bar",
        settings: &[r#"bodies.bar.mesh.element="mixed_quadratic""#],
        reference: -0.14497825852627025,
        // stress is singular along the clamped edge: hexahedra of this size are 2.5e-4 m from the limit in CalculiX
        tolerance: Tolerance::Absolute(5e-4),
        source: "limit of quadratic hexahedra by FEniCSx, 8e-5 m",
        mutation: r#"bodies.bar.material.youngs_modulus="10.1 MPa""#,
        ..BAR
    },
    Case {
        id: "plate_stress_tri3",
        what: "pull of a stretched plate in plane stress, tri3",
        settings: &[TRI3],
        reference: 200.0,
        ..PLATE
    },
    Case {
        id: "plate_stress_tri6",
        what: "pull of a stretched plate in plane stress, tri6",
        settings: &[TRI6],
        reference: 200.0,
        ..PLATE
    },
    Case {
        id: "plate_stress_quad4",
        what: "pull of a stretched plate in plane stress, quad4",
        settings: &[QUAD4],
        reference: 200.0,
        ..PLATE
    },
    Case {
        id: "plate_stress_side",
        what: "narrowing of a stretched plate in plane stress, quad8",
        reading: Reading::component("side", 1),
        reference: -0.006,
        source: "-ν ε b",
        mutation: "bodies.plate.material.poissons_ratio=0.3001",
        ..PLATE
    },
    Case {
        id: "plate_strain_pull",
        what: "pull of a stretched plate in plane strain, quad8",
        settings: &[PLANE_STRAIN],
        reference: 200.0 / 0.91,
        source: "E A ε / (1 - ν²)",
        ..PLATE
    },
    Case {
        id: "plate_strain_side",
        what: "narrowing of a stretched plate in plane strain, tri6",
        settings: &[PLANE_STRAIN, TRI6],
        reading: Reading::component("side", 1),
        reference: -0.006 / 0.7,
        source: "-ν ε b / (1 - ν)",
        mutation: "bodies.plate.material.poissons_ratio=0.3001",
        ..PLATE
    },
    Case {
        id: "membrane_arc",
        capabilities: &["FAU-1"],
        what: "height of a strip of membrane blown up to an arc",
        scene: "blown_strip",
        reading: Reading::component("top", 2),
        reference: 0.16328516334535745,
        // eight elements, parabolas over a = 0.16 rad of the arc each: an error of the order a⁴/4 = 1.6e-4, twice that
        tolerance: Tolerance::Relative(3e-4),
        source: "t P(λ) = p R on a cylinder, by bisection",
        mutation: r#"parameters.pressure="-101 Pa""#,
        ..PLATE
    },
    Case {
        id: "cable_sag",
        what: "sag of an elastic cable between two nails",
        // a polygon of 32 chords: the error falls as the square of their number, 1/32² = 1e-3
        tolerance: Tolerance::Relative(1e-3),
        ..CABLE
    },
    Case {
        id: "order_edge2_sag",
        what: "order of the sag's error, edge2",
        refinement: of_cable(&[
            Variant { size: 1.0 / 16.0, settings: &["parameters.cells=16"] },
            Variant { size: 1.0 / 32.0, settings: &["parameters.cells=32"] },
        ]),
        reference: 2.0,
        tolerance: CUBE.tolerance,
        ..CABLE
    },
    Case {
        id: "order_edge3_sag",
        what: "order of the sag's error, edge3",
        settings: &[r#"parameters.element="edge3""#],
        refinement: of_cable(&[
            Variant { size: 1.0 / 4.0, settings: &["parameters.cells=4"] },
            Variant { size: 1.0 / 8.0, settings: &["parameters.cells=8"] },
            Variant { size: 1.0 / 16.0, settings: &["parameters.cells=16"] },
        ]),
        reference: 4.0,
        tolerance: CUBE.tolerance,
        ..CABLE
    },
];
