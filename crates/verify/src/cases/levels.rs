//! Bodies of several meshes: a cube of one of them or of two, a free one.

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
