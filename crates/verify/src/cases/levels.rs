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

/// Levels of the cube by a criterion.
const ADAPTIVE: &str = r#"bodies.cube.levels={ coarser = [{ mesh = { generate = "bar", size = [0.1, 0.1, 0.1], cells = [2, 2, 2], element = "tet4" } }, { mesh = { generate = "bar", size = [0.1, 0.1, 0.1], cells = [4, 4, 4], element = "tet4" } }], refine = 0.03, coarsen = 0.0075 }"#;

const UNDAMPED: &str = "bodies.cube.damping.rayleigh_mass=0";
const SIX_SECONDS: &str = "run.duration=\"6 s\"";

/// The lowest frequency of the clamped cube when it is let go.
const SWING: Case = Case {
    capabilities: &["DEB-28"],
    reading: Reading::component("edge", 2).taking(Statistic::Frequency),
    source: "specification, 3.4: runs of 6 s of K_S(2) and K_S(4), to 0.03 Hz",
    tolerance: Tolerance::Absolute(0.03),
    mutation: "bodies.cube.material.density=1030",
    ..CUBE
};

/// One mesh of two at work on a cube without Poisson's ratio, so viscous that its inertia plays no part: the damping is `η/μ = τ` of the stiffness,
/// so that whatever the mesh it creeps as `1 - exp(-t/τ)`. At `t = τ`, 0.3 s.
const CREEP: Case = Case {
    capabilities: &["DEB-4"],
    // of 1 - exp(-t/τ) at t = τ, 2.5 % of the rate are 2.5 %/(e - 1): any two levels are within 5 %
    tolerance: Tolerance::Relative(0.0145),
    source: "V-27: rates of the levels within 5 % of each other; displacements of each mesh by an independent program",
    mutation: "bodies.cube.damping.viscosity=2500",
    ..CUBE
};

/// [`CREEP`] with a formula of levels and a schedule.
macro_rules! creep {
    ($fixed:literal, $schedule:literal) => {
        creep!($fixed, $schedule, "[4, 4, 4]")
    };
    ($fixed:literal, $schedule:literal, $cells:literal) => {
        &[
            "world.gravity=[0, 0, -0.0981]",
            "run.duration=\"0.3 s\"",
            concat!(r#"systems.main.stepper={ name = "staggered", halvings = 12, schedule = ""#, $schedule, "\" }"),
            concat!("bodies.cube.mesh.cells=", $cells),
            r#"bodies.cube.material={ name = "linear", youngs_modulus = 14000, poissons_ratio = 0, density = 1000 }"#,
            "bodies.cube.damping={ viscosity = 2100 }",
            concat!(
                r#"bodies.cube.levels={ coarser = [{ mesh = { generate = "bar", size = [0.1, 0.1, 0.1], cells = [2, 2, 2], element = "tet4" } }], fixed = ""#,
                $fixed,
                "\" }"
            ),
        ]
    };
}

/// Three meshes that each creep as its own equations say to 6e-4 have rates within 0.2 % of each other.
const TOGETHER: &str = "V-27: rates of three levels within 5 % of each other; M a + C v + K x = f of each mesh by an independent program";

/// A cube of two meshes of close resolution: edges in the ratio of 4 to 5, or other coarse cells and places of the levels.
macro_rules! close {
    ($coupling:literal) => {
        close!($coupling, "[4, 4, 4]", "if(x + z < 0.1, 1, 0)")
    };
    ($coupling:literal, $cells:literal, $fixed:literal) => {
        concat!(
            r#"bodies.cube.levels={ coarser = [{ mesh = { generate = "bar", size = [0.1, 0.1, 0.1], cells = "#,
            $cells,
            r#", element = "tet4" } }], fixed = ""#,
            $fixed,
            "\", ",
            $coupling,
            " }"
        )
    };
}

const LINEAR: &str = r#"bodies.cube.material.name="linear""#;
const CELLS_5: &str = "bodies.cube.mesh.cells=[5, 5, 5]";
const LIGHT: &str = "world.gravity=[0, 0, -0.1]";
const NAIVE: &str = close!(r#"coupling = "one_way", loops = "lagged""#);
/// The source's remedy, and its coupling.
const REMEDIED_ONE_WAY: &str = close!(r#"coupling = "one_way", loops = "activated""#);
const TRANSPOSED: &str = close!(r#"coupling = "transpose""#);
/// Edges in the ratio of 3 to 5, the coarse mesh at the clamp.
const NAIVE_3: &str =
    close!(r#"coupling = "one_way", loops = "lagged""#, "[3, 3, 3]", "if(x + z < 0.1, 0, 1)");
const REMEDIED_3: &str =
    close!(r#"coupling = "one_way", loops = "activated""#, "[3, 3, 3]", "if(x + z < 0.1, 0, 1)");
/// Of a fifth of what the scene has: between the rates at which amplitudes grow without and with the remedy.
const LITTLE_DAMPED: &str = "bodies.cube.damping.rayleigh_mass=10";

/// How far the edge comes up above where it was let go: not at all but for what beats of other modes than the lowest do.
const LOOP: Case = Case {
    capabilities: &["DEB-31"],
    reading: Reading::component("edge", 2).taking(Statistic::Max),
    // a tenth of twice the sag of K_S(5): ours
    reference: 0.1 * 2.0 * 1.320_875_7e-4,
    source: "specification, V-33; sag of K_S(5) under 0.1 m/s² by an independent program",
    ..CUBE
};

const SLOPES: Case = Case {
    capabilities: &["DEB-55"],
    scene: "two_slopes",
    reading: Reading::component("pull", 0),
    // λ (2 m1 e0 + 2 m2 (e - e0)) A with e = 0.22
    reference: 1.2 * (2.0 * 5000.0 * 0.1 + 2.0 * 2500.0 * 0.12) * 2.5e-3,
    source: "the law itself: its stress along the pull, and none across",
    mutation: r#"bodies.block.material.parameters.m2="2.6 kPa""#,
    ..CUBE
};

const CUT: Case = Case {
    id: "",
    capabilities: &["DEB-54"],
    scene: "cut_bar",
    reading: Reading::component("tip", 2),
    mutation: "bodies.bar.levels.cuts[0].time=99",
    ..CUBE
};

/// Of the block whose upper half is cut off, and of the one that was made without it.
const TOUCHED: Case = Case { scene: "cut_touched", mutation: "bodies.cut.levels.cuts[0].time=99", ..CUT };

/// Small loads on the bar, whose upper half is cut at the start.
macro_rules! half_cut {
    ($fixed:literal $(; $more:literal)?) => {
        &[
            $($more,)?
            r#"bodies.bar.material.name="linear""#,
            "bodies.bar.damping={ rayleigh_mass = 15 }",
            "world.gravity=[0, 0, -0.0981]",
            "run.duration=\"2 s\"",
            "bodies.bar.levels.cuts[0].time=0",
            "bodies.bar.levels.cuts[1].time=99",
            concat!(r#"bodies.bar.levels.fixed=""#, $fixed, "\""),
        ]
    };
}

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

/// A bar of six parts of 96 tetrahedra, each four times as stiff as the one before: six rates, the fastest in every tick.
macro_rules! six_rates {
    ($schedule:literal) => {
        &[
            r#"probes={ peak = { body = "cube", quantity = "levels.peak" } }"#,
            "expect=[]",
            "bodies.cube.mesh.cells=[24, 2, 2]",
            "bodies.cube.levels.fixed=\"2\"",
            r#"bodies.cube.regions={ a = { region = { box = [[-1, -1, -1], [0.0167, 1, 1]] }, material = { name = "linear", youngs_modulus = 20, poissons_ratio = 0.37, density = 1000 } }, b = { region = { box = [[0.0167, -1, -1], [0.0334, 1, 1]] }, material = { name = "linear", youngs_modulus = 80, poissons_ratio = 0.37, density = 1000 } }, c = { region = { box = [[0.0334, -1, -1], [0.0501, 1, 1]] }, material = { name = "linear", youngs_modulus = 320, poissons_ratio = 0.37, density = 1000 } }, d = { region = { box = [[0.0501, -1, -1], [0.0668, 1, 1]] }, material = { name = "linear", youngs_modulus = 1280, poissons_ratio = 0.37, density = 1000 } }, e = { region = { box = [[0.0668, -1, -1], [0.0834, 1, 1]] }, material = { name = "linear", youngs_modulus = 5120, poissons_ratio = 0.37, density = 1000 } }, f = { region = { box = [[0.0834, -1, -1], [1, 1, 1]] }, material = { name = "linear", youngs_modulus = 20480, poissons_ratio = 0.37, density = 1000 } } }"#,
            concat!(r#"systems.main.stepper={ name = "staggered", halvings = 5, schedule = ""#, $schedule, "\" }"),
        ]
    };
}

const TICKS: Case = Case {
    capabilities: &["DEB-33"],
    reading: Reading::last("peak").after(1),
    source: "specification, V-35: the worst step over the mean with equal lists, 2 at most staggered, about the number of rates plain",
    ..CUBE
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "levels_ticks_staggered",
        what: "the busiest tick of a step over the mean, six equal lists of tetrahedra, each of a rate of its own",
        settings: six_rates!("staggered"),
        // the fastest and one other, of 63 lists in 32 ticks
        reference: 2.0 * 32.0 / 63.0,
        tolerance: Tolerance::Relative(1e-12),
        mutation: "systems.main.stepper.schedule=\"plain\"",
        ..TICKS
    },
    Case {
        id: "levels_ticks_plain",
        what: "the same where every list is due as its interval begins: all six in the first tick",
        settings: six_rates!("plain"),
        reference: 6.0 * 32.0 / 63.0,
        tolerance: Tolerance::Relative(1e-12),
        mutation: "systems.main.stepper.schedule=\"staggered\"",
        ..TICKS
    },
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
        what: "half of it fine, half coarse: between the sag of one and of the other, nearer to that of the half at the wall, which bends and shears most",
        // of 10.05 and 14.16 mm, weighed by what the half at the wall adds to the sag of a column: 3/4 of shear, 15/16 of bending. At least 3/4, less
        // a tenth, and at most all
        reference: -0.5 * (0.9 * (10.05 + 0.75 * (14.16 - 10.05)) + 14.16) * 1e-3,
        tolerance: Tolerance::Absolute(0.5 * (14.16 - 0.9 * (10.05 + 0.75 * (14.16 - 10.05))) * 1e-3),
        source: "V-32 (d): between levels_cube_coarse and levels_cube_fine; (b): 5 % of a frequency are 10 % of a compliance",
        // by which the body hangs as high as the coarse mesh alone
        mutation: r#"bodies.cube.levels.coupling="one_way""#,
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
        reference: -12.326_408_9e-5,
        // at the whole load St. Venant-Kirchhoff's law differs by 0.73 %, and by a hundredth of that here
        tolerance: Tolerance::Relative(7.3e-5),
        source: "Cauchy on K_S(4), over 100, by an independent program: the mean along the edge, whose points of the fine mesh lie between those of this one",
        mutation: "bodies.cube.material.youngs_modulus=1919000",
        ..CUBE
    },
    Case {
        id: "levels_creep_coarse",
        what: "how far a viscous cube has crept after its time of relaxation, 48 tetrahedra",
        settings: creep!("0", "staggered"),
        reference: -8.095_671_4e-5,
        ..CREEP
    },
    Case {
        id: "levels_creep_fine",
        what: "the same, 384 tetrahedra",
        settings: creep!("1", "staggered"),
        reference: -1.030_201_916e-4,
        ..CREEP
    },
    Case {
        id: "levels_creep_mixed",
        what: "the same, half of it fine, half coarse: between the two, and what each may be off on either side",
        settings: creep!("if(x < 0.05, 1, 0)", "staggered"),
        reference: -9.198_793e-5,
        tolerance: Tolerance::Absolute(1.103_174e-5 + 0.0145 * 9.198_793e-5),
        mutation: "bodies.cube.damping.viscosity=4200",
        ..CREEP
    },
    Case {
        id: "levels_creep_together",
        what: "the same with 48 tetrahedra, every point pushed in every tick: as the modes say",
        settings: creep!("0", "together"),
        reference: -8.095_671_4e-5,
        // of the lowest mode, which is nearly all of it, ω² τ h is 6e-4
        tolerance: Tolerance::Relative(6e-4),
        source: TOGETHER,
        mutation: "bodies.cube.damping.viscosity=2110",
        ..CREEP
    },
    Case {
        id: "levels_creep_together_3",
        what: "the same with 162 tetrahedra",
        settings: creep!("1", "together", "[3, 3, 3]"),
        reference: -9.483_989_698e-5,
        tolerance: Tolerance::Relative(6e-4),
        source: TOGETHER,
        mutation: "bodies.cube.damping.viscosity=2110",
        ..CREEP
    },
    Case {
        id: "levels_creep_together_4",
        what: "the same with 384",
        settings: creep!("1", "together"),
        reference: -1.030_201_917e-4,
        tolerance: Tolerance::Relative(6e-4),
        source: TOGETHER,
        mutation: "bodies.cube.damping.viscosity=2110",
        ..CREEP
    },
    Case {
        id: "levels_loop_grows",
        what: "two meshes of close resolution coupled one way, points that feed each other a tick late: within 4.5 s the cube swings up more than ten times as high as it may",
        settings: &[NAIVE, CELLS_5, LINEAR, LIGHT, UNDAMPED, "run.duration=\"4.5 s\""],
        reference: 10.0 * LOOP.reference,
        tolerance: Tolerance::Above,
        mutation: TRANSPOSED,
        ..LOOP
    },
    Case {
        id: "levels_loop_grows_damped",
        what: "two meshes with edges as 3 to 5 that lose a tenth of their speed in 10 ms, coupled one way, points that feed each other a tick late: as high nevertheless",
        settings: &[NAIVE_3, CELLS_5, LINEAR, LIGHT, LITTLE_DAMPED, "run.duration=\"4.5 s\""],
        reference: 10.0 * LOOP.reference,
        tolerance: Tolerance::Above,
        mutation: REMEDIED_3,
        ..LOOP
    },
    Case {
        id: "levels_loop_remedied",
        what: "the same with the source's remedy, the corners of all that carries active: it comes to rest",
        settings: &[REMEDIED_3, CELLS_5, LINEAR, LIGHT, LITTLE_DAMPED, "run.duration=\"4.5 s\""],
        tolerance: Tolerance::AtMost,
        mutation: NAIVE_3,
        ..LOOP
    },
    Case {
        id: "levels_loop_remedied_one_way",
        what: "without damping the source's remedy, the corners of all that carries active, is not enough: coupled one way the meshes as 4 to 5 swing up as high with it",
        settings: &[REMEDIED_ONE_WAY, CELLS_5, LINEAR, LIGHT, UNDAMPED, "run.duration=\"4.5 s\""],
        reference: 10.0 * LOOP.reference,
        tolerance: Tolerance::Above,
        source: "specification, V-33, which has it that nothing grows then; sag of K_S(5) under 0.1 m/s² by an independent program",
        mutation: TRANSPOSED,
        ..LOOP
    },
    Case {
        id: "levels_loop_transposed",
        what: "the same remedy, coupled by the transpose: it does not",
        settings: &[TRANSPOSED, CELLS_5, LINEAR, LIGHT, UNDAMPED, "run.duration=\"4.5 s\""],
        tolerance: Tolerance::AtMost,
        mutation: NAIVE,
        ..LOOP
    },
    Case {
        id: "two_slopes_pull",
        what: "pull of a block at 1.2 of its length whose law is linear in two pieces, beyond the bend",
        tolerance: Tolerance::Relative(1e-9),
        ..SLOPES
    },
    Case {
        id: "two_slopes_below",
        what: "the same at 1.05 of its length, below the bend",
        settings: &["bodies.block.pins[3].motion.offsets=[[0, 0, 0], [0.005, 0, 0]]"],
        // λ 2 m1 e A with e = 0.05125
        reference: 1.05 * 2.0 * 5000.0 * 0.051_25 * 2.5e-3,
        tolerance: Tolerance::Relative(1e-9),
        mutation: r#"bodies.block.material.parameters.m1="5.1 kPa""#,
        ..SLOPES
    },
    Case {
        id: "two_slopes_levels",
        what: "the same at 1.2 of the length of a body of two meshes, half of it of either, a second and a half after the pull",
        settings: &[
            "world.period=\"10 ms\"",
            "run.duration=\"2.5 s\"",
            r#"systems.main.stepper={ name = "staggered", halvings = 5 }"#,
            "bodies.block.damping={ rayleigh_mass = 60 }",
            r#"bodies.block.levels={ coarser = [{ mesh = { generate = "bar", size = [0.1, 0.05, 0.05], cells = [2, 1, 1], element = "tet4" } }], fixed = "if(x < 0.05, 1, 0)" }"#,
        ],
        // ours: points pushed at dates of their own quiver, by 5e-5 of it then
        tolerance: Tolerance::Relative(2e-4),
        ..SLOPES
    },
    Case {
        id: "cut_falls",
        what: "how far the part of a bar has fallen 0.2 s after it was cut off at rest",
        settings: &[
            "bodies.bar.levels.cuts[0].time=0",
            "bodies.bar.levels.cuts[1].time=0",
            "bodies.bar.damping={ viscosity = 0 }",
        ],
        reading: Reading::component("tip", 2).after(20),
        reference: -0.1962,
        // pushed in the middle of intervals: exact for a constant force
        tolerance: Tolerance::Relative(1e-12),
        source: "Galilei: what is cut off holds no more",
        mutation: "bodies.bar.levels.cuts[1].time=0.1",
        ..CUT
    },
    Case {
        id: "cut_half",
        what: "sag of the end of a bar whose upper half is cut through in one section, the fine mesh at work",
        settings: half_cut!("1"),
        reference: -3.958_266_571e-4,
        // e^-15 of what it swings is 3e-7 of it
        tolerance: Tolerance::Relative(1e-6),
        source: "the mesh without those cells by an independent program: 1.586 times the sag of the whole",
        ..CUT
    },
    Case {
        id: "cut_half_as_finest",
        what: "the same, the coarse mesh at work but beside the cut, and as stiff as the fine one",
        settings: half_cut!("0"; "bodies.bar.levels.stiffness=\"as_finest\""),
        reference: -3.958_266_571e-4,
        // frequencies 5 % on either side are compliances 10 %; half of that
        tolerance: Tolerance::Relative(0.05),
        source: "the mesh without those cells by an independent program; V-32 (b) for how far two levels together may be from one",
        // with its own stiffness the coarse mesh lacks an eighth, and a third where nothing is cut
        mutation: "bodies.bar.levels.stiffness=\"own\"",
        ..CUT
    },
    Case {
        id: "cut_half_coarse",
        what: "the same, the coarse mesh at work but beside the cut: lower than the whole bar, fine",
        settings: half_cut!("0"),
        reference: -2.495_821_9e-4,
        tolerance: Tolerance::AtMost,
        source: "the whole bar by an independent program; a coarse mesh alone would be stiffer than that, and cut it is not",
        ..CUT
    },
    Case {
        id: "cut_touch_nothing",
        what: "the most that a finger feels on its way through where cells were cut away, until 0.3 mm before the face that is left",
        reading: Reading::component("pressed", 2).taking(Statistic::Min).after(40),
        reference: 0.0,
        tolerance: Tolerance::Absolute(0.0),
        source: "the finger is 20 mm deep in what is gone then, and touches nothing",
        ..TOUCHED
    },
    Case {
        id: "cut_touch_nothing_late",
        what: "the same, detected one period late",
        settings: &["world.collisions=\"one_period_late\""],
        reading: Reading::component("pressed", 2).taking(Statistic::Min).after(40),
        reference: 0.0,
        tolerance: Tolerance::Absolute(0.0),
        source: "the finger is 20 mm deep in what is gone then, and touches nothing",
        ..TOUCHED
    },
    Case {
        id: "cut_touch_weight",
        what: "what bears a die that has fallen on the face that a cut has opened",
        reading: Reading::component("carried", 2),
        reference: 0.019_62,
        tolerance: Tolerance::Relative(0.005),
        source: "m g of 2 g",
        mutation: "bodies.die.material.density=2100",
        ..TOUCHED
    },
    Case {
        id: "cut_touch_falls",
        what: "how far a die falls with the lid of the block under it",
        reading: Reading::component("die", 2),
        reference: -0.0201,
        // m g over the stiffness of two of its four lower points, 98 µm; the sag `ρ g h² / 2E` of the lower half, 98 µm, and 49 µm by what
        // points of the face keep of the cells that are gone; and under the die less than the 196 µm of a column as wide
        tolerance: Tolerance::Absolute(4.5e-4),
        source: "its gap of 0.1 mm, and the height of what was cut off",
        ..TOUCHED
    },
    Case {
        id: "levels_swing_coarse",
        what: "how often the cube swings, 48 tetrahedra at work",
        settings: &["bodies.cube.levels.fixed=\"0\"", UNDAMPED, SIX_SECONDS],
        reference: 5.19,
        ..SWING
    },
    Case {
        id: "levels_swing_middle",
        what: "the same, 384 tetrahedra",
        settings: &["bodies.cube.levels.fixed=\"1\"", UNDAMPED, SIX_SECONDS],
        reference: 4.85,
        ..SWING
    },
    Case {
        id: "levels_swing_mixed",
        what: "the same, half of it fine, half coarse: between those of 48 and 3072 tetrahedra",
        settings: &[UNDAMPED, SIX_SECONDS],
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
        id: "levels_cube_settles",
        capabilities: &["DEB-12", "DEB-30"],
        what: "how often a point comes or goes within a second while a clamped cube of three meshes sags and comes to rest, the most: once",
        settings: &[ADAPTIVE, "run.duration=\"2 s\""],
        reading: Reading::last("toggling"),
        reference: 1.0,
        tolerance: Tolerance::AtMost,
        source: "specification, V-11: no particle toggles more than once a second in a settling run",
        // half a second of weight: what is refined as it comes is coarse again when it has gone
        mutation: "world.gravity=[0, 0, \"-9.81 * step(0.5, t) * step(t, 1)\"]",
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
