//! Bodies of frames: the reference bar against converged answers, a ligament, a bar that spins freely, tied organs.

use crate::{Case, Reading, Tolerance};

const BAR: Case = Case {
    id: "",
    capabilities: &["BOS-4"],
    what: "",
    scene: "frames_cantilever",
    settings: &[],
    reading: Reading::component("tip", 1),
    refinement: None,
    reference: TIP_STVK,
    tolerance: Tolerance::Relative(0.02),
    source: "FEniCSx, quadratic hexahedra, fitted limit",
    mutation: r#"bodies.bar.material.youngs_modulus="9.5 MPa""#,
};

/// Tip of the reference bar in equilibrium [m].
const TIP_STVK: f64 = -0.144_982_917_950_976_7;
const TIP_NEO_HOOKEAN: f64 = -0.144_978_258_526_270_25;

const LIGAMENT: Case = Case {
    capabilities: &["BOS-3"],
    scene: "ligament",
    reading: Reading::component("end", 1),
    reference: -0.01,
    tolerance: Tolerance::Absolute(2e-4),
    source: "the motion of the pin",
    mutation: r#"bodies.ligament.pins[1].rotation.offsets[2]=["170 deg", 0, 0]"#,
    ..BAR
};

const SPINNING: Case = Case {
    capabilities: &["BOS-6"],
    scene: "frames_spinning",
    reading: Reading::component("spin", 2),
    // m (L² + w²)/12 ω = 5 kg (0.25 + 0.01) m²/12 · 6/s
    reference: 0.65,
    tolerance: Tolerance::Relative(1e-9),
    source: "angular momentum of a block about its middle, which nothing changes",
    mutation: "bodies.bar.angular_velocity=[0, 0.5, 6.001]",
    ..BAR
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "frames_bar_affine",
        what: "tip of the clamped bar, 44 affine frames, St. Venant-Kirchhoff",
        ..BAR
    },
    Case {
        id: "frames_bar_affine_neo_hookean",
        what: "tip of the clamped bar, 44 affine frames, neo-Hookean",
        settings: &[r#"bodies.bar.material.name="neo_hookean""#],
        reference: TIP_NEO_HOOKEAN,
        ..BAR
    },
    Case {
        id: "frames_bar_affine_fine",
        what: "the same, 189 affine frames, three by three across",
        settings: &["bodies.bar.frames.placement.counts=[21, 3, 3]"],
        tolerance: Tolerance::Relative(2e-3),
        ..BAR
    },
    Case {
        id: "frames_bar_reaction",
        what: "what holds the bar: its weight",
        reading: Reading::component("hold", 1),
        reference: 98.1,
        tolerance: Tolerance::Relative(1e-6),
        source: "1000 kg/m3 of 0.01 m3",
        mutation: "bodies.bar.material.density=1001",
        ..BAR
    },
    Case {
        id: "frames_bar_torsion",
        what: "first natural frequency of torsion of the clamped bar, 44 affine frames",
        reading: Reading::NaturalFrequency(5),
        reference: 14.262_434_014_307_647,
        source: "FEniCSx, linear, consistent mass, fitted limit",
        mutation: r#"bodies.bar.material.youngs_modulus="9 MPa""#,
        ..BAR
    },
    Case {
        id: "frames_ligament_turned",
        what: "corner of the led end of a ligament after half a turn",
        ..LIGAMENT
    },
    Case {
        id: "frames_ligament_long_steps",
        capabilities: &["BOS-3", "BOS-5"],
        what: "the same with steps of 20 ms",
        settings: &[r#"world.period="20 ms""#],
        ..LIGAMENT
    },
    Case {
        id: "frames_ligament_middle",
        what: "side of its middle frame, turned by a quarter and narrowed",
        reading: Reading::component("middle", 1),
        reference: -0.005,
        tolerance: Tolerance::Absolute(6e-4),
        source: "twist is even along a prism",
        mutation: r#"bodies.ligament.pins[1].rotation.offsets[2]=["90 deg", 0, 0]"#,
        ..LIGAMENT
    },
    Case {
        id: "frames_spin_kept",
        what: "angular momentum of a free bar of affine frames after 1000 symplectic steps",
        ..SPINNING
    },
    Case {
        id: "frames_momentum_kept",
        what: "its momentum",
        reading: Reading::component("momentum", 0),
        reference: 0.5,
        source: "5 kg at 0.1 m/s",
        mutation: "bodies.bar.velocity=[0.1001, 0, 0]",
        ..SPINNING
    },
    Case {
        id: "frames_tissue_carries",
        capabilities: &["BOS-9"],
        what: "what holds an organ from which another hangs by tissue: the weight of all three",
        scene: "tied_organs",
        settings: &[
            "bodies.lower.springs=[]",
            "bodies.lower.mesh.cells=[4, 2, 4]",
            "bodies.upper.mesh.cells=[4, 2, 4]",
            "bodies.tissue.mesh.cells=[3, 2, 3]",
            "run.duration=3",
        ],
        reading: Reading::component("pull", 1),
        // (0.4 + 0.4 + 0.072) kg · 9.81 m/s²
        reference: 8.55432,
        tolerance: Tolerance::Relative(1e-3),
        source: "equilibrium: what is left of the swing after three seconds is the tolerance",
        mutation: "bodies.tissue.material.density=1200",
        ..BAR
    },
];
