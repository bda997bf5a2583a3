//! Particles: how a cube of them swings by its number, a rod on an octree.

use crate::reading::Statistic;
use crate::{Case, Reading, Tolerance};

const CELLS_7: &str = "bodies.cube.mesh.cells=[7, 7, 7]";

const SWING: Case = Case {
    id: "",
    capabilities: &["DEB-6", "DEB-8"],
    what: "",
    scene: "particles_cube",
    settings: &[],
    reading: Reading::component("corner", 2).taking(Statistic::Frequency),
    refinement: None,
    reference: 4.88,
    tolerance: Tolerance::Relative(0.05),
    source: "specification, V-05: a spread of 10 % at most over the numbers of particles, about the mean of these two",
    mutation: "bodies.cube.material.density=1300",
};

const ENERGY: &str = r#"bodies.cube.formulation={ name = "particles" }"#;
const LUMPED: &str = r#"bodies.cube.mass="lumped""#;

/// Two within 2.5 % of one number are within 5 % of each other.
const CORRECTED: Case = Case {
    capabilities: &["DEB-7", "DEB-8"],
    reading: Reading::NaturalFrequency(1),
    // between linear finite elements on K_M(12), 4.701, and the coarsest of these, 4.531
    reference: 4.60,
    tolerance: Tolerance::Relative(0.025),
    source: "specification, V-05: a spread of 5 % at most of corrected operators, whose place the energy takes: they have none at a free border, and grow",
    mutation: "bodies.cube.material.density=1100",
    ..SWING
};

/// By Newton's method on the finest particles, which knows no octree and no time.
const ROD: Case = Case {
    capabilities: &["DEB-9", "DEB-14"],
    scene: "octree_rod",
    reading: Reading::component("tip", 2),
    reference: -1.7770614e-3,
    source: "static equilibrium of the formulation `particles` on the same points",
    ..SWING
};

/// Held as deep as the coarse level has particles, so that every level is held in the same place, and struck: it begins to turn.
/// Particles divide as it bends most, and are grouped once it has calmed.
pub const STRUCK: &[&str] = &[
    "bodies.rod.pins[0].region={ box = [[-1, -1, -1], [0.0031, 1, 1]] }",
    "bodies.rod.angular_velocity=[0, 30, 0]",
    "bodies.rod.octree.refine=0.06",
    "bodies.rod.octree.coarsen=0.05",
    "run.duration=\"2 s\"",
];

const ROD_STRUCK: Case = Case {
    capabilities: &["DEB-14"],
    settings: STRUCK,
    reading: Reading::last("active"),
    reference: 32.0,
    tolerance: Tolerance::Absolute(0.0),
    source: "specification, V-07: settles at level 3, 2 x 2 x 8 particles, everywhere",
    ..ROD
};

/// The cube of mixed levels: the particles on their own swing 4.52 and 5.10 times a second, with the source's operators 4.93 and 5.66.
const MIXED: Case = Case {
    capabilities: &["DEB-14", "DEB-16"],
    scene: "octree_cube",
    reading: Reading::component("corner", 2).taking(Statistic::Frequency),
    reference: 4.81,
    tolerance: Tolerance::Absolute(0.29 + 0.05 * 4.81),
    source: "specification, V-09: between those of the two levels, 5 % on either side",
    mutation: "bodies.cube.material.density=1400",
    ..SWING
};

/// The rod as a cube of 8 x 8 x 8 particles.
const CUBIC: &str = "bodies.rod.mesh.size=[0.1, 0.1, 0.1]";
const CUBIC_CELLS: &str = "bodies.rod.mesh.cells=[7, 7, 7]";

/// Who is whose neighbour: numbers of the specification.
const NEIGHBOURS: Case = Case {
    capabilities: &["DEB-10"],
    scene: "octree_rod",
    mutation: r#"bodies.rod.octree.fixed="0""#,
    reading: Reading::last("fewest").after(1),
    tolerance: Tolerance::Absolute(0.0),
    source: "specification, 2.6.2 and V-11",
    ..SWING
};

/// The liver that is poked, at every date.
const LIVER_LISTS: Case = Case {
    capabilities: &["DEB-10", "DEB-13"],
    scene: "octree_liver",
    reading: Reading::last("grading").taking(Statistic::Max),
    source: "specification, V-11",
    ..SWING
};

const COARSE: &str = "bodies.cube.octree.fixed=\"0\"";
const FINE: &str = "bodies.cube.octree.fixed=\"1\"";

/// 32 x 8 x 8 particles, of which half the length is divided, half of that again, and so on.
const LONG: &str = "bodies.cube.mesh.size=[0.31, 0.07, 0.07]";
const LONG_CELLS: &str = "bodies.cube.mesh.cells=[31, 7, 7]";
const HALVED_ADAPTIVE: &str = r#"bodies.cube.octree={ levels = 4, operators = "legacy", variant = "adaptive", fixed = "if(x < 0.155, 1, 0) + if(x < 0.075, 1, 0) + if(x < 0.035, 1, 0)" }"#;
const HALVED_HIERARCHICAL: &str = r#"bodies.cube.octree={ levels = 4, operators = "legacy", variant = "hierarchical", fixed = "if(x < 0.155, 1, 0) + if(x < 0.075, 1, 0) + if(x < 0.035, 1, 0)" }"#;
/// One tick for all, which all bear.
const EACH_ONCE: &str = "systems.main.stepper.halvings=0";
const SHORT_STEP: &str = "world.period=\"10 us\"";

pub(super) const CASES: &[Case] = &[
    Case {
        id: "particles_4",
        what: "how often 4 x 4 x 4 particles swing, by the source's operators",
        ..SWING
    },
    Case { id: "particles_8", what: "the same, 8 x 8 x 8 particles", settings: &[CELLS_7], ..SWING },
    Case {
        id: "particles_energy_8",
        capabilities: &["DEB-7", "DEB-8"],
        what: "lowest frequency of 8 x 8 x 8 particles with an energy",
        settings: &[CELLS_7, r#"bodies.cube.formulation={ name = "particles", volumes = "uniform" }"#],
        reading: Reading::NaturalFrequency(1),
        reference: 4.701,
        source: "specification, 3.4: linear finite elements on K_M(12)",
        mutation: "bodies.cube.material.density=1200",
        ..SWING
    },
    Case {
        id: "particles_lumped_4",
        what: "lowest frequency of 4 x 4 x 4 particles with an energy, each of the mass of its part of the cube",
        settings: &[ENERGY, LUMPED],
        ..CORRECTED
    },
    Case {
        id: "particles_lumped_8",
        what: "the same, 8 x 8 x 8 particles",
        settings: &[CELLS_7, ENERGY, LUMPED],
        ..CORRECTED
    },
    Case {
        id: "particles_lumped_16",
        what: "the same, 16 x 16 x 16 particles",
        settings: &["bodies.cube.mesh.cells=[15, 15, 15]", ENERGY, LUMPED],
        ..CORRECTED
    },
    Case {
        id: "octree_cube_fine",
        capabilities: &["DEB-14"],
        what: "how often 8 x 8 x 8 particles of an octree swing",
        settings: &[FINE],
        reference: 4.701,
        tolerance: Tolerance::Relative(0.05),
        source: "specification, 3.4: linear finite elements on K_M(12); 5 % for V-05's corrected operators",
        ..MIXED
    },
    Case { id: "octree_cube_mixed", what: "the same, half of them grouped by eight", ..MIXED },
    Case {
        id: "octree_cube_mixed_free_end",
        what: "the same, those at the wall grouped",
        settings: &["bodies.cube.octree.fixed=\"if(x < 0.05, 0, 1)\""],
        mutation: "bodies.cube.material.density=2000",
        ..MIXED
    },
    Case {
        id: "octree_cube_legacy",
        what: "the same with the source's operators: faster than either level alone by more than 5 %, which the energy cures",
        settings: &["bodies.cube.octree.operators=\"legacy\""],
        reference: 1.05 * 5.664,
        tolerance: Tolerance::Above,
        source: "specification, V-09: mixed levels behave worse, by another frequency; far less stable, as it has them too, they are not: the energy is within 8 % for 30 s; 5.664 Hz of the coarse level alone",
        mutation: "bodies.cube.octree={ levels = 2, fixed = \"0\" }",
        ..MIXED
    },
    Case {
        id: "octree_cube_hierarchical",
        capabilities: &["DEB-15"],
        what: "the same with the source's operators, divided particles staying for what they feel of their own level",
        settings: &["bodies.cube.octree.operators=\"legacy\"", "bodies.cube.octree.variant=\"hierarchical\""],
        reference: 5.30,
        tolerance: Tolerance::Absolute(0.37 + 0.05 * 5.30),
        source: "specification, 2.7 and V-09: between 4.93 Hz of the fine level and 5.66 of the coarse one, 5 % on either side",
        ..MIXED
    },
    Case {
        id: "octree_cube_grows_not",
        what: "how low the corner of the cube of mixed levels comes in half a minute: 5 % below its first swing at most",
        settings: &["run.duration=\"30 s\""],
        reading: Reading::component("corner", 2).taking(Statistic::Min),
        reference: -1.05 * 30.088e-3,
        tolerance: Tolerance::AtLeast,
        source: "specification, V-09: no growth over 30 s",
        mutation: "bodies.cube.octree.operators=\"least_squares\"",
        ..MIXED
    },
    Case {
        id: "octree_cube_work_coarse",
        capabilities: &["DEB-16"],
        what: "forces of a step with 4 x 4 x 4 particles at work, each pushed as often as it needs",
        settings: &[COARSE],
        reading: Reading::last("evaluations").after(1),
        reference: 64.0 * 4.0,
        tolerance: Tolerance::Absolute(0.0),
        source: "specification, V-12: half the rate of particles half as far apart",
        // softer: a stiffer one is refused, as eight times are the most
        mutation: "bodies.cube.material.youngs_modulus=4e3",
        ..MIXED
    },
    Case {
        id: "octree_cube_work_fine",
        capabilities: &["DEB-16"],
        what: "the same with 8 x 8 x 8: 16 times as many, 8 in number and 2 in rate",
        settings: &[FINE],
        reading: Reading::last("evaluations").after(1),
        reference: 16.0 * 64.0 * 4.0,
        tolerance: Tolerance::Absolute(0.0),
        source: "specification, V-12: 14 to 18, here by count",
        // softer: a stiffer one is refused, as eight times are the most
        mutation: "bodies.cube.material.youngs_modulus=4e3",
        ..MIXED
    },
    Case {
        id: "octree_overhead_adaptive",
        capabilities: &["DEB-15"],
        what: "forces of a step of 2048 particles whose octree of four levels is divided by half on each",
        settings: &[LONG, LONG_CELLS, HALVED_ADAPTIVE, EACH_ONCE, SHORT_STEP],
        reading: Reading::last("evaluations").after(1),
        reference: 298.0,
        tolerance: Tolerance::Absolute(0.0),
        source: "specification, V-10",
        mutation: r#"bodies.cube.octree.fixed="if(x < 0.155, 1, 0)""#,
        ..MIXED
    },
    Case {
        id: "octree_overhead_hierarchical",
        capabilities: &["DEB-15"],
        what: "the same of the hierarchical variant: a seventh more",
        settings: &[LONG, LONG_CELLS, HALVED_HIERARCHICAL, EACH_ONCE, SHORT_STEP],
        reading: Reading::last("evaluations").after(1),
        reference: 340.0,
        tolerance: Tolerance::Absolute(0.0),
        source: "specification, V-10",
        mutation: r#"bodies.cube.octree.fixed="if(x < 0.155, 1, 0)""#,
        ..MIXED
    },
    Case {
        id: "particles_16",
        what: "how often 16 x 16 x 16 particles swing",
        settings: &[
            "bodies.cube.mesh.cells=[15, 15, 15]",
            "systems.main.steps_per_period=24",
            "run.duration=\"2 s\"",
        ],
        ..SWING
    },
    Case {
        id: "particles_minute",
        what: "how low the corner of 4 x 4 x 4 particles comes in a minute: 5 % below its first swings at most",
        settings: &["run.duration=\"60 s\""],
        reading: Reading::component("corner", 2).taking(Statistic::Min),
        reference: -1.05 * 26.094e-3,
        tolerance: Tolerance::AtLeast,
        source: "specification, V-05: no drift over 60 s",
        mutation: "bodies.cube.formulation.operators=\"least_squares\"",
        ..SWING
    },
    Case {
        id: "octree_ticks_are_even",
        capabilities: &["DEB-33"],
        what: "the busiest tick of a step of two rates over the mean, none of them idle",
        reading: Reading::last("peak").after(1),
        reference: 2.0,
        tolerance: Tolerance::AtMost,
        source: "specification, V-35",
        mutation: "systems.main.stepper.halvings=6",
        ..MIXED
    },
    Case {
        id: "octree_liver_divides",
        capabilities: &["DEB-14", "DEB-18"],
        what: "finest particles at work in the liver while the tool presses it",
        scene: "octree_liver",
        reading: Reading::last("fine").after(70),
        reference: 8.0,
        tolerance: Tolerance::AtLeast,
        source: "V-08: fine near the tool; one particle of the middle level makes eight",
        mutation: "bodies.liver.octree.refine=1",
        ..SWING
    },
    Case {
        id: "octree_liver_near_the_tool",
        capabilities: &["DEB-18"],
        what: "rank correlation of the level at work with the distance from the tool, then",
        scene: "octree_liver",
        reading: Reading::last("nearness").after(70),
        reference: -0.5,
        tolerance: Tolerance::AtMost,
        source: "V-06 and V-08: fine near the tool, coarse far",
        mutation: "bodies.liver.octree.refine=1",
        ..SWING
    },
    Case {
        id: "octree_liver_work",
        capabilities: &["DEB-16", "DEB-18"],
        what: "forces that a step evaluates while the liver is poked, the most: a fifth of those with the finest particles everywhere",
        scene: "octree_liver",
        reading: Reading::last("evaluations").taking(Statistic::Max),
        // 915 particles, pushed four times a step each
        reference: 0.2 * 915.0 * 4.0,
        tolerance: Tolerance::AtMost,
        source: "V-08: at most a fifth",
        mutation: "bodies.liver.octree.refine=0.1",
        ..SWING
    },
    Case {
        id: "octree_liver_rest",
        capabilities: &["DEB-9", "DEB-13", "DEB-18"],
        what: "particles at work in the liver when the tool has drawn back: the coarsest alone, and none finer",
        scene: "octree_liver",
        reading: Reading::last("active"),
        reference: 36.0,
        tolerance: Tolerance::Absolute(0.0),
        source: "the number of 52 mm cubes with a particle in them; V-08 has 34",
        mutation: "bodies.liver.octree.coarsen=0",
        ..SWING
    },
    Case {
        id: "octree_rod_adaptive",
        what: "sag of the rod that divides where it bends, against that of the finest particles everywhere",
        tolerance: Tolerance::Relative(0.1),
        source: "specification, V-07: within 10 %",
        mutation: r#"bodies.rod.octree.fixed="0""#,
        ..ROD
    },
    Case {
        id: "octree_rod_struck_sags",
        what: "sag of the rod that was struck, at rest again, against that of the finest particles alone held as deep",
        reading: Reading::component("tip", 2),
        reference: -1.374_793e-3,
        tolerance: Tolerance::Relative(0.1),
        source: "specification, V-07: within 10 % of the finest, whose sag is that of `octree.fixed = \"1\"` after 2 s",
        mutation: "world.gravity=[0, 0, -1.05]",
        ..ROD_STRUCK
    },
    Case {
        id: "octree_rod_struck_divides",
        what: "particles at work while it bends most: more than the coarse 32",
        reading: Reading::last("active").taking(Statistic::Max),
        tolerance: Tolerance::Above,
        mutation: "bodies.rod.octree.refine=1",
        ..ROD_STRUCK
    },
    Case {
        id: "octree_rod_struck_settles",
        what: "particles at work when it has calmed",
        mutation: "bodies.rod.octree.coarsen=0.001",
        ..ROD_STRUCK
    },
    Case {
        id: "octree_rods_alike",
        capabilities: &["DEB-16"],
        what: "how far the ends of two rods are from each other within 0.12 s of their fall, one pushed at rates of its own, one in every tick, the most",
        scene: "octree_rods",
        reading: Reading::last("apart").taking(Statistic::Max).after(60),
        reference: 0.0,
        // of the sag of the rod at rest
        tolerance: Tolerance::Absolute(0.02 * 1.7770614e-3),
        source: "specification, V-12: the multirate trajectory of V-07 within 2 % of the single-rate one",
        mutation: "bodies.together.material.density=1050",
        ..ROD
    },
    Case {
        id: "octree_fewest_neighbours",
        what: "active neighbours of particles that are alone in having been divided: 7 sisters and 7 coarser ones",
        // the mother of index (1, 1, 1), 36 mm from three faces
        settings: &[
            CUBIC,
            CUBIC_CELLS,
            r#"bodies.rod.octree.fixed="if(abs(x - 0.0357) + abs(y - 0.0357) + abs(z - 0.0357) < 0.024, 1, 0)""#,
        ],
        reference: 14.0,
        ..NEIGHBOURS
    },
    Case {
        id: "octree_most_neighbours",
        what: "active neighbours of a particle that is alone in not having been divided: 56 finer ones",
        settings: &[
            CUBIC,
            CUBIC_CELLS,
            r#"bodies.rod.octree.fixed="if(abs(x - 0.0357) + abs(y - 0.0357) + abs(z - 0.0357) < 0.024, 0, 1)""#,
        ],
        reading: Reading::last("most").after(1),
        reference: 56.0,
        ..NEIGHBOURS
    },
    Case {
        id: "octree_liver_graded",
        what: "levels by which particles of the liver side by side differ while it is poked, the most at any date: one, where three are at work",
        reference: 1.0,
        tolerance: Tolerance::Absolute(0.0),
        mutation: r#"bodies.liver.octree.fixed="0""#,
        ..LIVER_LISTS
    },
    Case {
        id: "octree_rod_settles",
        capabilities: &["DEB-12", "DEB-14"],
        what: "how often a particle comes or goes within a second while the rod settles in two, the most: once",
        settings: &["run.duration=\"2 s\""],
        reading: Reading::last("toggling"),
        reference: 1.0,
        tolerance: Tolerance::AtMost,
        source: "specification, V-11: no particle toggles more than once a second in a settling run",
        // no hysteresis
        mutation: "bodies.rod.octree.coarsen=0.00299",
        ..ROD
    },
    Case {
        id: "octree_rod_finest",
        what: "sag of a rod of particles, the finest level of its octree alone",
        settings: &[r#"bodies.rod.octree.fixed="1""#],
        // critically damped at 25/s: (1 + 6.3) e^-6.3 of the way are left, and of the first overtones less
        tolerance: Tolerance::Relative(0.02),
        mutation: "world.gravity=[0, 0, -1.1]",
        ..ROD
    },
    Case {
        id: "particles_late",
        what: "how far the corner of 4 x 4 x 4 particles swings in the last 10 s of a minute: as far as in its first",
        settings: &["run.duration=\"60 s\""],
        reading: Reading::component("corner", 2).taking(Statistic::LateSpan(5_000)),
        // 26.09 mm down, 0.74 up
        reference: 26.830e-3,
        tolerance: Tolerance::Relative(0.05),
        source: "specification, V-05: no drift of amplitude over 60 s; the first 10 s of the same run",
        // a swing that dies, to a fifth
        mutation: "bodies.cube.damping.neighbour_friction=0.01",
        ..SWING
    },
    Case {
        id: "particles_late_energy",
        capabilities: &["DEB-7", "DEB-8"],
        what: "the same of 8 x 8 x 8 particles with an energy",
        settings: &[CELLS_7, ENERGY, LUMPED, "run.duration=\"60 s\""],
        reading: Reading::component("corner", 2).taking(Statistic::LateSpan(5_000)),
        reference: 32.277e-3,
        tolerance: Tolerance::Relative(0.05),
        source: "specification, V-05: no drift of amplitude over 60 s; the first 10 s of the same run",
        mutation: "bodies.cube.damping.neighbour_friction=0.01",
        ..SWING
    },
    Case {
        id: "octree_liver_is_whole_again",
        capabilities: &["DEB-14", "DEB-18"],
        what: "how far the place that the tool pushed in by 18 mm is from where it was, two seconds after the tool has gone",
        scene: "octree_liver",
        reading: Reading::last("dent").after(310),
        reference: 0.0,
        // less than 1 % of the size of an organ of two decimetres
        tolerance: Tolerance::Absolute(1e-3),
        source: "specification, V-06: less than 1 % of the size within 2 s of the release",
        // the tool stays
        mutation: "shapes.tool.motion.offsets=[[0, 0, 0], [0, 0, 0], [0, 0, -0.05], [0, 0, -0.05], [0, 0, -0.05]]",
        ..SWING
    },
];
