//! Bodies of several meshes: a cube of one of them or of two, a free one.

use crate::reading::Statistic;
use crate::{Case, Reading, Tolerance};

const CUBE: Case = Case {
    id: "",
    capabilities: &["DEB-3", "DEB-50"],
    what: "",
    scene: "levels_cube",
    settings: &[],
    reading: Reading::component("edge", 2),
    refinement: None,
    reference: 0.0,
    tolerance: Tolerance::Absolute(2e-5),
    source: "V-01: static equilibrium of the same mesh, by Newton's method",
    mutation: r#"bodies.cube.material.youngs_modulus="19.3 kPa""#,
};

const FREE: Case = Case {
    capabilities: &["DEB-28", "DEB-50"],
    scene: "levels_free",
    source: "1 kg at (0.3, 0.1, 0) m/s",
    tolerance: Tolerance::Relative(1e-10),
    // which gives the momentum away at once, and later blows up: the row ends before
    mutation: r#"bodies.cube.levels.coupling="one_way""#,
    ..CUBE
};

const UNDAMPED: &str = "bodies.cube.damping.rayleigh_mass=0";
const THREE_SECONDS: &str = "run.duration=\"3 s\"";

/// The lowest frequency of the clamped cube when it is let go.
const SWING: Case = Case {
    capabilities: &["DEB-28"],
    reading: Reading::component("edge", 2).taking(Statistic::Frequency),
    source: "specification, 3.4: time runs of K_S(2) and K_S(4); a window of 3 s tells lines a third of a hertz apart",
    tolerance: Tolerance::Absolute(0.17),
    mutation: "bodies.cube.material.density=1150",
    ..CUBE
};

/// The free cube of two meshes, for a minute.
const MINUTE: Case = Case {
    capabilities: &["DEB-28"],
    settings: &[
        "bodies.cube.mesh.cells=[4, 4, 4]",
        r#"bodies.cube.levels={ coarser = [{ mesh = { generate = "bar", size = [0.1, 0.1, 0.1], cells = [2, 2, 2], element = "tet4" } }], fixed = "if(x < 0.05, 1, 0)" }"#,
        "run.duration=\"60 s\"",
    ],
    source: "V-32 (c): 5 % of 1/2 m v² + 1/2 ω·J ω at the start, 0.05 + 0.07333 J of 4 x 4 x 4 cells with their masses at their corners",
    reference: 0.123_333_333,
    tolerance: Tolerance::Relative(0.05),
    mutation: r#"bodies.cube.levels.coupling="one_way""#,
    ..FREE
};

const BLOCK: Case = Case {
    capabilities: &["DEB-12", "DEB-14", "DEB-30"],
    scene: "pressed_block",
    source: "specification, V-06 and V-38",
    ..CUBE
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "levels_cube_coarse",
        what: "sag of the clamped cube, the mesh of 48 tetrahedra at work, St. Venant-Kirchhoff",
        settings: &[r#"bodies.cube.levels.fixed="0""#],
        reference: -10.05e-3,
        ..CUBE
    },
    Case {
        id: "levels_cube_middle",
        what: "the same, 384 tetrahedra",
        settings: &[r#"bodies.cube.levels.fixed="1""#],
        reference: -12.41e-3,
        ..CUBE
    },
    Case {
        id: "levels_cube_fine",
        what: "the same, 3072 tetrahedra",
        settings: &[r#"bodies.cube.levels.fixed="2""#],
        reference: -14.16e-3,
        ..CUBE
    },
    Case {
        id: "levels_cube_one_way",
        what: "the same, 384 tetrahedra, coupled one way: a mesh that is alone does not know it",
        settings: &[r#"bodies.cube.levels.fixed="1""#, r#"bodies.cube.levels.coupling="one_way""#],
        reference: -12.41e-3,
        ..CUBE
    },
    Case {
        id: "levels_cube_mixed",
        capabilities: &["DEB-28", "DEB-31"],
        what: "half of it fine, half coarse: between the sag of one and of the other",
        reference: -12.11e-3,
        tolerance: Tolerance::Absolute(2.05e-3),
        source: "V-32 (d): between levels_cube_coarse and levels_cube_fine",
        mutation: r#"bodies.cube.material.youngs_modulus="14 kPa""#,
        ..CUBE
    },
    Case {
        id: "levels_cube_100_stiffer",
        capabilities: &["DEB-50", "DEB-56"],
        what: "sag of the cube a hundred times as stiff, 384 tetrahedra: a hundredth of that of small strain",
        settings: &[
            "bodies.cube.levels.fixed=\"1\"",
            "bodies.cube.material.youngs_modulus=1918518.5185185186",
            "systems.main.stepper.halvings=9",
        ],
        reference: -12.32e-5,
        // V-01 tells five micrometres of the softer one
        tolerance: Tolerance::Relative(0.002),
        source: "V-01, Cauchy on K_S(4), over 100",
        mutation: "bodies.cube.material.youngs_modulus=1930000",
        ..CUBE
    },
    Case {
        id: "levels_swing_coarse",
        what: "how often the cube swings, 48 tetrahedra at work",
        settings: &["bodies.cube.levels.fixed=\"0\"", UNDAMPED, THREE_SECONDS],
        reference: 5.19,
        ..SWING
    },
    Case {
        id: "levels_swing_middle",
        what: "the same, 384 tetrahedra",
        settings: &["bodies.cube.levels.fixed=\"1\"", UNDAMPED, THREE_SECONDS],
        reference: 4.85,
        ..SWING
    },
    Case {
        id: "levels_swing_mixed",
        what: "the same, half of it fine, half coarse: between those of 48 and 3072 tetrahedra",
        settings: &[UNDAMPED, THREE_SECONDS],
        // 4.59 Hz of the fine mesh alone, 5.03 of the coarse one
        reference: 4.81,
        tolerance: Tolerance::Absolute(0.22 + 0.05 * 4.81),
        source: "V-32 (b): between the two, 5 % on either side",
        mutation: "bodies.cube.material.density=1300",
        ..SWING
    },
    Case {
        id: "levels_energy_high",
        what: "energy of a free cube of two meshes in a minute without damping: the most",
        reading: Reading::last("energy").taking(Statistic::Max),
        ..MINUTE
    },
    Case {
        id: "levels_energy_low",
        what: "the same, the least",
        reading: Reading::last("energy").taking(Statistic::Min),
        mutation: "bodies.cube.damping.rayleigh_mass=0.01",
        ..MINUTE
    },
    Case {
        id: "block_fine_under_ball",
        what: "rank correlation of the level at work with the distance from a ball that presses a block to half its height",
        reading: Reading::last("nearness").after(90),
        reference: -0.5,
        tolerance: Tolerance::AtMost,
        mutation: "bodies.block.levels.refine=1e9",
        ..BLOCK
    },
    Case {
        id: "block_is_whole_again",
        what: "dent of the block two seconds after the ball has gone: less than 1 % of its width",
        reading: Reading::component("dent", 2),
        reference: 0.0,
        tolerance: Tolerance::Absolute(1.2e-3),
        mutation: "shapes.ball.motion.offsets=[[0, 0, 0], [0, 0, 0], [0, 0, -0.0325], [0, 0, -0.0325], [0, 0, -0.03]]",
        ..BLOCK
    },
    Case {
        id: "block_is_coarse_again",
        what: "points at work then: the coarsest mesh, and none finer",
        reading: Reading::last("active"),
        reference: 196.0,
        tolerance: Tolerance::Absolute(0.0),
        mutation: "bodies.block.levels.coarsen=0",
        ..BLOCK
    },
    Case {
        id: "levels_momentum_x",
        what: "momentum of a free cube of three meshes after 1600 ticks, along x",
        reading: Reading::component("momentum", 0).after(100),
        reference: 0.3,
        ..FREE
    },
    Case {
        id: "levels_momentum_y",
        what: "the same along y",
        reading: Reading::component("momentum", 1).after(100),
        reference: 0.1,
        ..FREE
    },
];
