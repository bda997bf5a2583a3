//! Particles: how a cube of them swings by its number, a rod on an octree.

use std::f64::consts::SQRT_2;

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

/// All levels of the source's rod, whose coarsest is one row of four: held as deep as the middle level has particles, and struck as it
/// begins to sag. It divides where it bends most as it swings, and is grouped once it has calmed.
const FROM_FOUR: &[&str] = &[
    "bodies.rod.octree.levels=3",
    "bodies.rod.pins[0].region={ box = [[-1, -1, -1], [0.0031, 1, 1]] }",
    "bodies.rod.angular_velocity=[0, 18, 0]",
    "bodies.rod.octree.refine=0.025",
    "bodies.rod.octree.coarsen=0.021",
    "run.duration=\"2 s\"",
];

const ROD_FROM_FOUR: Case = Case {
    id: "octree_rod_from_four",
    what: "particles at work as the rod of three levels, 4, 32 and 256, has swung out: those of the middle level everywhere",
    settings: FROM_FOUR,
    ..ROD_STRUCK
};

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

/// The block of V-06 as 16 x 16 x 8 particles and their groups of eight and of 64, pressed to half its height: 2048 particles at most, 32 at rest.
macro_rules! pressed {
    ($octree:literal) => {
        &[
            "systems.main.stepper.halvings=6",
            "bodies.block.levels=",
            r#"bodies.block.mesh={ generate = "bar", size = [0.12, 0.12, 0.056], cells = [15, 15, 7], element = "hex8" }"#,
            "bodies.block.mass=\"uniform\"",
            r#"bodies.block.material={ name = "linear", youngs_modulus = 10000, poissons_ratio = 0.35, density = 1000 }"#,
            "bodies.block.damping={ rayleigh_mass = 10 }",
            concat!("bodies.block.octree=", $octree),
            "shapes.ball.motion.offsets=[[0, 0, 0], [0, 0, 0], [0, 0, -0.0345], [0, 0, -0.0345], [0, 0, 0]]",
        ]
    };
}

const PRESSED: Case = Case {
    capabilities: &["DEB-12", "DEB-14"],
    scene: "pressed_block",
    settings: pressed!("{ levels = 3, refine = 0.2, coarsen = 0.05 }"),
    source: "specification, V-06",
    ..SWING
};

/// What the operators do to the constant second derivatives of a field, of an inner particle among its 26 neighbours: let go from where the field has
/// it, it has the velocity of one step, a millisecond of `(μ Δu + (λ+μ) grad div u)/ρ`.
macro_rules! field {
    ($operators:literal, $field:literal) => {
        &[
            "world.period=\"1 ms\"",
            "world.gravity=[0, 0, 0]",
            "systems.main.steps_per_period=1",
            "bodies.cube.pins=[]",
            "expect=[]",
            "bodies.cube.mesh.cells=[4, 4, 4]",
            concat!(
                r#"bodies.cube.formulation={ name = "particles", operators = ""#,
                $operators,
                r#"", volumes = "uniform" }"#
            ),
            concat!("bodies.cube.start={ displacement = ", $field, " }"),
            r#"probes.corner={ body = "cube", region = { nearest = [0.05, 0.05, 0.05] }, quantity = "velocity" }"#,
        ]
    };
}

/// `μ/ρ` and `(λ+μ)/ρ` [m²/s²], over a thousand.
const SHEAR: f64 = 7e-3;
const SPREAD: f64 = 27e-3;
/// `Σ l`, `⟨n_x⁴⟩` and `⟨n_x² n_y²⟩` of six neighbours at 1, twelve at √2 and eight at √3.
const LENGTHS: f64 = 6.0 + 12.0 * SQRT_2 + 8.0 * SQRT_3;
const FOURTH: f64 = (2.0 + 2.0 * SQRT_2 + 8.0 / 9.0 * SQRT_3) / LENGTHS;
const CROSSED: f64 = (SQRT_2 + 8.0 / 9.0 * SQRT_3) / LENGTHS;
const SQRT_3: f64 = 1.732_050_807_568_877_2;

const LEGACY: Case = Case {
    capabilities: &["DEB-6", "DEB-7"],
    settings: field!("legacy", "[\"x * x\", 0, 0]"),
    reading: Reading::component("corner", 0).after(1),
    // half of the field's Laplacian is one of three directions of three
    reference: SHEAR * 2.0 / 3.0 + SPREAD * 2.0 * FOURTH,
    tolerance: Tolerance::Relative(1e-4),
    source: "specification, V-04 and 2.5.3: a third of the Laplacian, and means of the direction's fourth powers over the 26 neighbours",
    mutation: "bodies.cube.formulation.operators=\"corrected\"",
    ..SWING
};

/// The greatest error of a particle of a ball of tetrahedra, 14 neighbours to an inner one, more rings of them at the border.
macro_rules! unordered {
    ($field:literal, $velocity:literal) => {
        &[
            "world.period=\"1 ms\"",
            "world.gravity=[0, 0, 0]",
            "systems.main.steps_per_period=1",
            "bodies.cube.pins=[]",
            "expect=[]",
            r#"bodies.cube.mesh={ shape = "ellipsoid", size = 0.02, semi_axes = [0.05, 0.05, 0.05] }"#,
            r#"bodies.cube.formulation={ name = "particles", operators = "least_squares" }"#,
            "bodies.cube.mass=\"lumped\"",
            concat!("bodies.cube.start={ displacement = ", $field, " }"),
            concat!(
                r#"probes.corner={ body = "cube", quantity = "velocity", against = { formula = "#,
                $velocity,
                r#" }, component = "length", reduce = "max" }"#
            ),
        ]
    };
}

pub(super) const CASES: &[Case] = &[
    Case {
        id: "particles_legacy_xx",
        what: "velocity [m/s] that the source's operators give an inner particle in a step of a millisecond, of the displacement `x²` along x",
        ..LEGACY
    },
    Case {
        id: "particles_legacy_yy",
        what: "the same of `y²` along x",
        settings: field!("legacy", "[\"y * y\", 0, 0]"),
        reference: SHEAR * 2.0 / 3.0 + SPREAD * 2.0 * CROSSED,
        ..LEGACY
    },
    Case {
        id: "particles_legacy_xy",
        what: "the same of `x y` along y, a cross derivative, which the source has as none",
        settings: field!("legacy", "[0, \"x * y\", 0]"),
        reference: SPREAD * 2.0 * CROSSED,
        ..LEGACY
    },
    Case {
        id: "particles_exact_sets",
        capabilities: &["DEB-7"],
        what: "farthest [m/s] that least squares are from the exact velocity of a quadratic field of two components, 95 mm/s, on neighbours without any order",
        settings: unordered!("[\"x * x\", \"x * y\", 0]", "[\"0.095\", 0, 0]"),
        reading: Reading::last("corner").after(1),
        reference: 0.0,
        tolerance: Tolerance::Absolute(1e-10 * 0.095),
        source: "specification, V-04: exact to 1e-10 on random sets of 12 neighbours and more",
        mutation: "bodies.cube.formulation.operators=\"corrected\"",
        ..LEGACY
    },
    Case {
        id: "particles_exact_crossed",
        capabilities: &["DEB-7"],
        what: "the same of a field with cross derivatives",
        settings: unordered!("[\"y * z\", \"z * z + x * y\", 0]", "[\"0.027\", \"0.014\", 0]"),
        reading: Reading::last("corner").after(1),
        reference: 0.0,
        tolerance: Tolerance::Absolute(1e-10 * 0.027),
        source: "specification, V-04: exact to 1e-10 on random sets of 12 neighbours and more",
        mutation: "bodies.cube.formulation.operators=\"corrected\"",
        ..LEGACY
    },
    Case {
        id: "particles_corrected_grow",
        capabilities: &["DEB-6", "DEB-7", "DEB-8"],
        what: "how far up the corner of 4 x 4 x 4 particles comes within 0.14 s by corrected operators, which have no energy at a free border: more than the cube is long",
        settings: &["expect=[]", r#"bodies.cube.formulation.operators="corrected""#],
        reading: Reading::component("corner", 0).taking(Statistic::Max).after(14),
        reference: 0.1,
        tolerance: Tolerance::Above,
        source: "specification, 2.5.2: one-sided sets see gradients; V-05 asks for a spread of corrected operators, which cannot be had of what grows",
        mutation: r#"bodies.cube.formulation.operators="legacy""#,
        ..SWING
    },
    Case {
        id: "particles_late_8",
        what: "how far the corner of 8 x 8 x 8 particles swings in the last 10 s of a minute: as far as in its first",
        settings: &[CELLS_7, "run.duration=\"60 s\""],
        reading: Reading::component("corner", 2).taking(Statistic::LateSpan(5_000)),
        reference: 26.929e-3,
        tolerance: Tolerance::Relative(0.05),
        source: "specification, V-05: no drift of amplitude over 60 s; the first 10 s of the same run",
        mutation: "bodies.cube.damping.neighbour_friction=0.01",
        ..SWING
    },
    Case {
        id: "particles_late_energy_4",
        capabilities: &["DEB-7", "DEB-8"],
        what: "the same of 4 x 4 x 4 particles with an energy",
        settings: &[ENERGY, LUMPED, "run.duration=\"60 s\""],
        reading: Reading::component("corner", 2).taking(Statistic::LateSpan(5_000)),
        reference: 30.889e-3,
        tolerance: Tolerance::Relative(0.05),
        source: "specification, V-05: no drift of amplitude over 60 s; the first 10 s of the same run",
        mutation: "bodies.cube.damping.neighbour_friction=0.01",
        ..SWING
    },
    Case {
        id: "octree_block_fine_under_ball",
        what: "rank correlation of the level at work with the distance from a ball that presses a block of particles to half its height",
        reading: Reading::last("nearness").after(90),
        reference: -0.5,
        tolerance: Tolerance::AtMost,
        mutation: "bodies.block.octree.refine=1e9",
        ..PRESSED
    },
    Case {
        id: "octree_block_is_whole_again",
        what: "dent of the block of particles two seconds after the ball has gone: less than 1 % of its width",
        reading: Reading::component("dent", 2).after(330),
        reference: 0.0,
        tolerance: Tolerance::Absolute(1.2e-3),
        mutation: "shapes.ball.motion.offsets=[[0, 0, 0], [0, 0, 0], [0, 0, -0.0325], [0, 0, -0.0325], [0, 0, -0.03]]",
        ..PRESSED
    },
    Case {
        id: "octree_block_is_coarse_again",
        what: "particles at work then: the coarsest, and none finer",
        reading: Reading::last("active").after(330),
        reference: 32.0,
        tolerance: Tolerance::Absolute(0.0),
        mutation: "bodies.block.octree.coarsen=0",
        ..PRESSED
    },
    Case {
        id: "octree_cube_least_squares_grow",
        capabilities: &["DEB-14"],
        what: "energy of the cube of mixed levels by least squares 0.4 s after it was let go with 0.49 J: more than ten times that, where neither level alone gains a fiftieth",
        settings: &["expect=[]", "bodies.cube.octree.operators=\"least_squares\""],
        reading: Reading::last("energy").after(40),
        reference: 10.0 * 0.4905,
        tolerance: Tolerance::Above,
        source: "specification, V-09: mixed levels are far less stable than each alone; least squares, exact of every field, do not cure that, the energy does",
        mutation: "bodies.cube.octree.fixed=\"1\"",
        ..MIXED
    },
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
        source: "specification, V-09: mixed levels behave worse, by another frequency; the specification also calls them far less stable, which they are not here: their energy stays within 8 % for 30 s; 5.664 Hz of the coarse level alone",
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
    Case { mutation: "bodies.rod.octree.coarsen=0.005", ..ROD_FROM_FOUR },
    Case {
        id: "octree_rod_face_sags",
        what: "sag of a rod of three levels held by its end face alone, begun as four particles, against that of the finest particles everywhere: 56 of these are never asked for",
        settings: &[
            "bodies.rod.octree.levels=3",
            "bodies.rod.octree.refine=0.003",
            "bodies.rod.octree.coarsen=0.0015",
            "run.duration=\"0.4 s\"",
        ],
        tolerance: Tolerance::Relative(0.01),
        source: "specification, V-07, which allows 10 %: held by a face, levels are held in other places",
        mutation: "bodies.rod.octree.refine=0.01",
        ..ROD
    },
    Case {
        id: "octree_rod_begins_with_four",
        what: "particles at work as the same rod begins to sag",
        reading: Reading::last("active").after(0),
        reference: 4.0,
        source: "specification, V-07: 4 particles at the start",
        mutation: "bodies.rod.octree.levels=2",
        ..ROD_FROM_FOUR
    },
    Case {
        id: "octree_rod_divides_in_part",
        what: "particles at work while the same rod swings, at most: more than the middle level has, and less than half of the finest",
        reading: Reading::last("active").taking(Statistic::Max),
        reference: 128.0,
        tolerance: Tolerance::AtMost,
        source: "specification, V-07: up to 88 of 256; half of them is ours",
        // it never comes back from being fine where it bends
        mutation: "bodies.rod.octree.refine=0.0211",
        ..ROD_FROM_FOUR
    },
    Case {
        id: "octree_rod_divides",
        what: "the same: more than the middle level has",
        reading: Reading::last("active").taking(Statistic::Max),
        reference: 32.0,
        tolerance: Tolerance::Above,
        source: "specification, V-07: up to 88",
        mutation: "bodies.rod.octree.refine=1",
        ..ROD_FROM_FOUR
    },
    Case {
        id: "octree_rod_four_sags",
        what: "sag of the same rod at rest again, against that of the finest particles alone held as deep",
        reading: Reading::component("tip", 2),
        reference: -1.374_793e-3,
        tolerance: Tolerance::Relative(0.1),
        source: "specification, V-07: the tip within 10 % of the finest, whose sag is that of `octree.fixed = \"1\"` of two levels after 2 s",
        // a row of four does not bend
        mutation: r#"bodies.rod.octree.fixed="0""#,
        ..ROD_FROM_FOUR
    },
    Case {
        id: "octree_rod_four_costs",
        what: "forces that a step of the same rod evaluates, in the mean of two seconds: at most a sixth of those of the finest level everywhere, and at most 1.4 times those of the middle one, 2048",
        reading: Reading::last("evaluations").taking(Statistic::Mean),
        // 256 particles, 64 times a step
        reference: 16_384.0 / 6.0,
        tolerance: Tolerance::AtMost,
        source: "specification, V-07: at most 1/6 of the time of the finest level, and 1.4 times that of the middle one; by work that is counted",
        mutation: "bodies.rod.octree.refine=0.0211",
        ..ROD_FROM_FOUR
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
