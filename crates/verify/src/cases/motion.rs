//! Motions and equilibria in closed form: free fall, velocity damping, springs in series, a roller.

use crate::{Case, Reading, Tolerance};

const FREE: Case = Case {
    id: "",
    capabilities: &[],
    what: "",
    scene: "block_on_springs",
    settings: &[],
    reading: Reading::component("place", 1).after(100),
    refinement: None,
    reference: f64::NAN,
    // rounding of 100 steps
    tolerance: Tolerance::Relative(1e-13),
    source: "",
    mutation: "world.gravity=[0, -9.82, 0]",
};

const NO_SPRINGS: &str = "bodies.block.springs[0].stiffness=0";

const SERIES: Case = Case {
    capabilities: &["DEB-53", "FAU-55"],
    scene: "two_materials",
    settings: &[
        r#"world.period="1 s""#,
        r#"systems.main.stepper={ name = "static", newton_tolerance = 1e-10, solver_tolerance = 1e-12 }"#,
        r#"bodies.bar.material.name="linear""#,
        "bodies.bar.material.poissons_ratio=0",
        r#"bodies.bar.regions.stiff.material.name="linear""#,
        "bodies.bar.regions.stiff.material.poissons_ratio=0",
    ],
    reading: Reading::component("middle", 0).after(1),
    tolerance: Tolerance::Relative(1e-8),
    source: "springs in series, k = E A / L; Newton's method stops at 1e-10 of the force",
    mutation: r#"bodies.bar.regions.stiff.material.youngs_modulus="2.1 MPa""#,
    ..FREE
};

/// The reference bar as one straight spring of `n` cells, struck along its axis and braked by strain rate alone. With ν = 0
/// the damping is `η/μ` of the stiffness, so a mode of frequency ω decays as `exp(-η ω² t/2μ)`; of several modes the first is
/// left after a second.
const STRUCK: Case = Case {
    capabilities: &["DEB-4"],
    scene: "cantilever_dynamic",
    reading: Reading::component("tip", 0),
    // strains of 2e-5 are what Green's rate of strain differs by
    tolerance: Tolerance::Relative(1e-4),
    source: "v/ω' exp(-η ω² t/2μ) sin ω't, ω'² = ω² - (η ω²/2μ)², over the modes of a chain of n masses",
    mutation: "bodies.bar.damping.viscosity=1001",
    ..FREE
};

/// [`STRUCK`] with so many cells.
macro_rules! struck {
    ($cells:literal) => {
        &[
            r#"world.period="1 ms""#,
            "world.gravity=[0, 0, 0]",
            r#"systems.main.stepper="rk4""#,
            concat!("bodies.bar.mesh.cells=[", $cells, ", 1, 1]"),
            r#"bodies.bar.mesh.element="hex8""#,
            r#"bodies.bar.material.name="linear""#,
            r#"bodies.bar.material.youngs_modulus="1 MPa""#,
            "bodies.bar.material.poissons_ratio=0",
            "bodies.bar.damping.viscosity=1000",
            "bodies.bar.velocity=[0.001, 0, 0]",
        ]
    };
}

pub(super) const CASES: &[Case] = &[
    Case {
        id: "viscous_decay_1",
        what: "a bar of one cell, struck along its axis, after a second of strain-rate damping",
        settings: struck!("1"),
        reference: 1.938_282_502_777_552_5e-6,
        ..STRUCK
    },
    Case {
        id: "viscous_decay_4",
        what: "the same with four cells",
        settings: struck!("4"),
        reference: -1.842_334_098_014_447_8e-6,
        ..STRUCK
    },
    Case {
        id: "viscous_decay_8",
        what: "the same with eight cells",
        settings: struck!("8"),
        reference: -1.465_990_354_639_281_4e-6,
        ..STRUCK
    },
    Case {
        id: "free_fall",
        capabilities: &["FAU-48", "DEB-50"],
        what: "a free block has fallen g t²/2 after a second",
        settings: &["world.gravity=[0, -9.81, 0]", NO_SPRINGS],
        reference: -4.905,
        source: "Galilei; Verlet is exact for a constant force",
        ..FREE
    },
    Case {
        id: "velocity_damping",
        capabilities: &["FAU-42"],
        what: "speed of a free block after a second of damping at 0.5 /s",
        settings: &[r#"systems.main.stepper="rk4""#, "bodies.block.damping.rayleigh_mass=0.5", NO_SPRINGS],
        reading: Reading::component("speed", 0).after(100),
        // 0.5 exp(-0.5)
        reference: 0.303_265_329_856_316_7,
        // (d h)⁵/120 a step: 100 x 2.6e-14
        tolerance: Tolerance::Relative(5e-12),
        source: "v = v₀ exp(-d t), and thus an energy that falls as exp(-2 d t)",
        mutation: "bodies.block.damping.rayleigh_mass=0.501",
        ..FREE
    },
    Case {
        id: "creep",
        capabilities: &["DEB-35"],
        what: "a block on springs creeps down through a viscous medium, without inertia",
        settings: &[
            r#"systems.main.stepper={ name = "quasi_static", newton_tolerance = 1e-12, solver_tolerance = 1e-13 }"#,
            "world.gravity=[0, -1, 0]",
            "bodies.block.damping.rayleigh_mass=10",
        ],
        // m g/k (1 - (1 + h k/(a m))⁻¹⁰⁰), which tends to m g/k (1 - exp(-k t/(a m)))
        reference: -0.024_802_953_620_954_155,
        tolerance: Tolerance::Relative(1e-10),
        source: "a m v = m g - k x by implicit steps of 10 ms",
        mutation: "bodies.block.damping.rayleigh_mass=10.01",
        ..FREE
    },
    Case {
        id: "series_displacement",
        what: "where a bar half soft, half stiff stretches: in the soft half",
        // 0.5 m x 2000 / (2000 + 50)
        reference: 0.487_804_878_048_780_5,
        ..SERIES
    },
    Case {
        id: "series_reaction",
        what: "what it takes to hold it stretched, positive along the pull",
        reading: Reading::component("pull", 0).after(1),
        // 0.5 m x 4000 N/m x 160000 N/m / 164000 N/m
        reference: 1_951.219_512_195_122,
        ..SERIES
    },
    Case {
        id: "roller_reaction",
        capabilities: &["FAU-45"],
        what: "what a roller, held along x alone, gives along y to a bar under its weight: nothing",
        scene: "two_materials",
        settings: &[
            r#"bodies.bar.pins[1]={ region = { group = "x_max" }, axes = "x" }"#,
            "world.gravity=[0, -9.81, 0]",
        ],
        reading: Reading::component("pull", 1).after(1),
        reference: 0.0,
        // no arithmetic leads to it
        tolerance: Tolerance::Absolute(0.0),
        source: "reactions act along the directions held",
        mutation: r#"bodies.bar.pins[1].axes="xy""#,
        ..FREE
    },
];
