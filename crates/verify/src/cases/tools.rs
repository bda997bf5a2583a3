//! Tools against triangles, and hands that push hard, fast, or through a body with them.

use crate::{Case, Reading, Statistic, Tolerance};

const NEEDLE: Case = Case {
    id: "fast_tool",
    capabilities: &["DEB-43", "DEB-44", "DEB-45"],
    what: "force on a slab of a rod thinner than its triangles, held where it came to at 10 m/s",
    scene: "fast_tool",
    settings: &["shapes.needle.motion.times=[0, 0.005, 0.007, 1.3, 1.4]"],
    reading: Reading::component("force", 2).after(80),
    refinement: None,
    reference: -0.796_400,
    // what the slab still swings in one and the other
    tolerance: Tolerance::Relative(1e-3),
    source: "the same tool, led there in a fifth of a second: shapes.needle.motion.times=[0, 0.005, 0.2, 1.3, 1.4]",
    // which it slips between
    mutation: r#"contacts[0].detect="points""#,
};

/// The hand means to be 30 cm further down, through a cube of 10 cm and what it stands on, within 20 ms, with a ball that fits
/// between the points of its surface.
const THROUGH: &[&str] = &[
    r#"hands.right.motion.formula=[0, 0, "-0.3 * smoothstep(0.1, 0.12, t)"]"#,
    r#"hands.right.tool={ name = "sphere", centre = [0.057, 0.061, 0.112], radius = "5 mm" }"#,
    r#"hands.right.coupling={ limit = "1 N" }"#,
    r#"hands.right.touch={ detect = "triangles", stiffness = "2 kN/m" }"#,
];
/// Without triangles.
const POINTS: &str = r#"hands.right.touch={ detect = "points", stiffness = "2 kN/m" }"#;

const THROUGH_CUBE: Case = Case {
    id: "hand_through",
    capabilities: &["DEB-44", "DEB-46"],
    what: "where a hand comes to rest that thrusts a ball of 5 mm through a cube: held by what its device gives",
    scene: "hand_on_cube",
    settings: THROUGH,
    reading: Reading::component("hand", 2).after(150),
    refinement: None,
    // x = x_m + F / (k + k_r)
    reference: -0.3 + 1.0 / 350.0,
    // a fifth of what it would be without the force
    tolerance: Tolerance::Absolute(5e-4),
    source: "an arm of 300 N/m with reflexes of 50 N/m under 1 N, the ball in front of the surface",
    // between which the ball is through
    mutation: POINTS,
};

/// A hand that waits where it has come to: the ball hands on to the organ what the hand gives.
const HELD_ON_LIVER: Case = Case {
    capabilities: &["DEB-45", "DEB-46"],
    reading: Reading::Ratio { of: "on_liver", to: "force", component: 2 },
    reference: -1.0,
    // ours: the soft organ still gives way by as much as takes 0.005 of it
    tolerance: Tolerance::Absolute(0.01),
    source: "balance of the ball at rest; 1.4 s and more after it came",
    // it draws back, and touches nothing
    mutation: "hands.right.motion.times=[0, 0.6, 1, 1.4, 1.8]",
    ..LIVER
};

/// A world that tells a hundred times a second.
pub(crate) const SELDOM: [&str; 2] = ["world.period=\"10 ms\"", "systems.main.stepper.halvings=7"];

/// Six centimetres in six seconds.
const SLOWLY: &[&str] = &[
    "hands.right.motion.times=[0, 0.5, 6.5, 9, 9.1]",
    "hands.right.motion.interpolation=\"linear\"",
    "run.duration=\"6.5 s\"",
];

/// Meshes of the numbers that the source has.
const FAMILY: &str = "bodies.liver.levels={ cells = [28, 172] }";
const MIDDLE: &str = r#"probes.of_level={ body = "liver", quantity = "levels.cells", level = 1 }"#;
const FINEST: &str = r#"probes.of_level={ body = "liver", quantity = "levels.cells", level = 2 }"#;
const SHAPES: &str = r#"probes.shapes={ body = "liver", quantity = "levels.radius_ratio" }"#;
const SURFACE: &str = r#"probes.surface={ body = "liver", quantity = "levels.distance", level = 0 }"#;
/// Of the box around the organ of 1876 tetrahedra, as `souple mesh quality` prints its corners [m].
const DIAGONAL: f64 = 0.285_99;

/// A law that stiffens by an exponential, a tool at 2 m/s, and intervals down to 4 µs where velocities change by more than 5 cm/s.
const BRUTAL: &[&str] = &[
    "world.period=\"1 ms\"",
    "run.duration=\"0.2 s\"",
    r#"systems.main.stepper={ name = "staggered", halvings = 8, velocity_jump = 0.05 }"#,
    r#"bodies.slab.material={ name = "hyperelastic", energy = "m/(2*b)*(exp(b*(I1_bar - 3)) - 1) + k/2*(J - 1)^2", parameters = { m = "1.5 kPa", b = 2, k = "6 kPa" }, density = 1000 }"#,
    "bodies.slab.damping={ rayleigh_mass = 20 }",
    "shapes.needle.motion.times=[0, 0.005, 0.015, 0.3, 0.4]",
];

const LIVER: Case = Case {
    id: "hand_jump_liver",
    capabilities: &["DEB-46", "DEB-47"],
    what: "greatest change of the force from one millisecond to the next while the organ refines under a hand and is let go",
    scene: "hand_on_liver",
    settings: &[],
    reading: Reading::last("jump"),
    refinement: None,
    reference: 0.0,
    tolerance: Tolerance::Absolute(0.077),
    source: "V-43: a twentieth of the greatest force, 1.54 N",
    mutation: r#"hands.right.coupling={ stiffness = "16000 N/m", damping = 2, limit = "5 N" }"#,
};

/// A touch with all that smooths.
const IMPOSED: &str = r#"hands.right.touch={ detect = "triangles", response = "imposed" }"#;

const HELD: Case = Case {
    id: "hand_jump_held",
    capabilities: &["DEB-46", "DEB-47"],
    what: "greatest change of the force on a ball from one step to the next, over the force, while it presses a slab at 3 mm/s and holds the points that it touches, from a depth at which several triangles are in touch",
    scene: "held_press",
    settings: &[],
    reading: Reading::last("jump").taking(Statistic::Max).after(330),
    refinement: None,
    reference: 0.05,
    tolerance: Tolerance::AtMost,
    source: "V-43: with area weighting, progressive displacement and a residual depth, at most 5 % of the current force",
    mutation: r#"hands.right.touch={ detect = "triangles", response = "imposed", progressive = false }"#,
};

pub(super) const CASES: &[Case] = &[
    NEEDLE,
    Case {
        id: "fast_tool_lets_go",
        capabilities: &["DEB-45", "DEB-48"],
        what: "force on the slab when the rod has gone",
        settings: &[],
        reading: Reading::component("force", 2),
        reference: 0.0,
        tolerance: Tolerance::Absolute(1e-9),
        source: "a contact only pushes",
        mutation: "shapes.needle.motion.offsets=[[0, 0, 0], [0, 0, 0], [0, 0, -0.02], [0, 0, -0.02], [0, 0, -0.02]]",
        ..NEEDLE
    },
    Case {
        id: "fast_tool_depth",
        capabilities: &["DEB-45"],
        what: "how deep the slab is in the rod, five detections after it came to stand",
        settings: &[],
        reading: Reading::last("depth").after(6),
        reference: 0.0,
        tolerance: Tolerance::Absolute(1e-4),
        source: "V-41 allows 0.1 mm",
        mutation: r#"contacts[0].stiffness="100 N/m""#,
        ..NEEDLE
    },
    THROUGH_CUBE,
    Case {
        id: "hand_through_depth",
        capabilities: &["DEB-44"],
        what: "how deep the cube has been in that ball at most: less than its radius",
        reading: Reading::last("depth").taking(Statistic::Max).after(150),
        reference: 0.0,
        tolerance: Tolerance::Absolute(5e-3),
        source: "its middle stays in front of the surface",
        mutation: r#"hands.right.touch={ detect = "triangles", stiffness = "20 N/m" }"#,
        ..THROUGH_CUBE
    },
    LIVER,
    HELD,
    Case {
        id: "hand_jump_held_alike",
        what: "the same with the plain sum of the forces on held points in the place of the traction over the area in touch: points of a new triangle bring at once what they bear",
        settings: &[r#"hands.right.touch={ detect = "triangles", response = "imposed", weigh = "alike" }"#],
        tolerance: Tolerance::Above,
        source: "V-43, the first of its ablations",
        mutation: IMPOSED,
        ..HELD
    },
    Case {
        id: "hand_jump_held_at_once",
        what: "the same with displacements that are made at once, in the first step after each look",
        settings: &[
            r#"hands.right.touch={ detect = "triangles", response = "imposed", progressive = false }"#,
        ],
        tolerance: Tolerance::Above,
        source: "V-43, the second of its ablations",
        mutation: IMPOSED,
        ..HELD
    },
    Case {
        id: "hand_jump_held_at_the_edge",
        what: "the same with triangles that are moved out of the ball altogether: they come out of touch, are let go of, and spring back",
        settings: &[r#"hands.right.touch={ detect = "triangles", response = "imposed", residual = 0 }"#],
        tolerance: Tolerance::Above,
        source: "V-43, the last of its ablations",
        mutation: IMPOSED,
        ..HELD
    },
    Case {
        id: "hand_felt_at_once",
        capabilities: &["DEB-46"],
        what: "greatest change of the force on a person from one millisecond to the next while the ball goes 8.4 mm in a fifth of a second, where a person feels all through a period what the points held bore when it began",
        settings: &["hands.right.between=\"hold\"", "hands.right.motion.times=[0, 0.4, 0.6, 0.8, 3.6, 5.1]"],
        reading: Reading::last("step").after(80),
        // of 0.385 N
        reference: 0.05 * 0.385,
        tolerance: Tolerance::Above,
        source: "V-43: above a twentieth of the greatest force; in the mutation the force is new every millisecond, and stays below it",
        mutation: "hands.right.between=\"interpolate\"",
        ..HELD
    },
    Case {
        id: "held_press_depth",
        capabilities: &["DEB-45"],
        what: "how deep the slab is in the ball that presses it at 3 mm/s, at most: the residual and what the ball goes in two periods",
        reading: Reading::last("depth").after(330),
        reference: 1.6e-4,
        source: "V-41: what a look finds is moved out until the next, which finds what the ball has gone since",
        mutation: r#"hands.right.touch={ detect = "triangles", response = "imposed", fraction = 0.1 }"#,
        ..HELD
    },
    Case {
        id: "held_press_lets_go",
        capabilities: &["DEB-48"],
        what: "force of the ball on the slab when it has gone",
        reading: Reading::component("on_slab", 2),
        reference: 0.0,
        tolerance: Tolerance::Absolute(1e-9),
        source: "V-44: nothing sticks",
        mutation: "hands.right.motion.offsets=[[0, 0, 0], [0, 0, 0], [0, 0, -0.0025], [0, 0, -0.0109], [0, 0, -0.0109], [0, 0, -0.0109]]",
        ..HELD
    },
    Case {
        id: "held_press_does_not_pull",
        capabilities: &["DEB-48"],
        what: "the most that the ball pulls the slab up with, as it comes and as it goes: of 0.428 N that it presses with",
        reading: Reading::component("on_slab", 2).taking(Statistic::Max),
        reference: 4.28e-3,
        source: "V-44: at most 1 % of the peak",
        mutation: r#"probes.on_slab.quantity="hand.force""#,
        ..HELD
    },
    Case {
        id: "hand_jump_seldom",
        what: "the same of a world that tells a hundred times a second, whose forces the hand is led to evenly through a period: a twentieth of the greatest all the same",
        settings: &SELDOM,
        source: "V-43, in a world of 10 ms; in the mutation the tool goes as far as it goes within a period at once",
        mutation: "hands.right.between=\"hold\"",
        ..LIVER
    },
    Case {
        id: "hand_jump_at_once",
        what: "the same with a tool that the hand feels to go at once, at the beginning of each period, as far as it goes within one: above what V-43 allows",
        settings: &["hands.right.between=\"hold\"", SELDOM[0], SELDOM[1]],
        reference: 0.077,
        tolerance: Tolerance::Above,
        source: "V-43, the second of its ablations: without progressive motion the jump appears, of 400 N/m times what the tool goes within 10 ms; 0.077 N is a twentieth of the greatest force",
        mutation: "hands.right.between=\"interpolate\"",
        ..LIVER
    },
    Case {
        id: "levels_family",
        capabilities: &["DEB-27"],
        what: "tetrahedra of the coarsest of three meshes of the organ, of which 28, 172 and 1874 are asked for",
        settings: &[FAMILY, "bodies.liver.mesh.size=0", "bodies.liver.mesh.count=1874"],
        reading: Reading::last("coarsest").after(1),
        reference: 28.0,
        tolerance: Tolerance::Relative(0.2),
        source: "V-30: within 20 % of a requested number",
        mutation: "bodies.liver.levels.cells=[60, 172]",
        ..LIVER
    },
    Case {
        id: "levels_family_middle",
        capabilities: &["DEB-27"],
        what: "tetrahedra of the middle one",
        settings: &[FAMILY, "bodies.liver.mesh.size=0", "bodies.liver.mesh.count=1874", MIDDLE],
        reading: Reading::last("of_level").after(1),
        reference: 172.0,
        tolerance: Tolerance::Relative(0.2),
        source: "V-30: within 20 % of a requested number",
        mutation: "bodies.liver.levels.cells=[28, 300]",
        ..LIVER
    },
    Case {
        id: "levels_family_finest",
        capabilities: &["DEB-27"],
        what: "tetrahedra of the finest",
        settings: &[FAMILY, "bodies.liver.mesh.size=0", "bodies.liver.mesh.count=1874", FINEST],
        reading: Reading::last("of_level").after(1),
        reference: 1874.0,
        tolerance: Tolerance::Relative(0.2),
        source: "V-30: within 20 % of a requested number",
        mutation: "bodies.liver.mesh.count=3000",
        ..LIVER
    },
    Case {
        id: "levels_family_shapes",
        capabilities: &["DEB-27"],
        what: "least radius ratio of all their tetrahedra: none is flat",
        settings: &[FAMILY, "bodies.liver.mesh.size=0", "bodies.liver.mesh.count=1874", SHAPES],
        reading: Reading::last("shapes").after(1),
        reference: 0.1,
        tolerance: Tolerance::AtLeast,
        source: "V-30: above 0.1",
        // a slab whose cells are a hundred times as long as they are high
        mutation: r#"bodies.liver={ mesh = { generate = "box", size = [0.2, 0.2, 0.01], cells = [2, 2, 10], element = "tet4" }, material = { name = "linear", youngs_modulus = 0.1, poissons_ratio = 0.3, density = 1000 }, levels = { coarser = [{ mesh = { generate = "box", size = [0.2, 0.2, 0.01], cells = [1, 1, 5], element = "tet4" } }] } }"#,
        ..LIVER
    },
    Case {
        id: "levels_family_surface",
        capabilities: &["DEB-27"],
        what: "how far the surface of the coarsest one is from that of the body, at most, of the diagonal",
        settings: &[FAMILY, "bodies.liver.mesh.size=0", "bodies.liver.mesh.count=1874", SURFACE],
        reading: Reading::last("surface").after(1),
        reference: 0.05 * DIAGONAL,
        tolerance: Tolerance::AtMost,
        source: "V-30: less than 5 % of the diagonal at the coarsest level",
        mutation: r#"bodies.liver.levels={ count = 3, ratio = 2 }"#,
        ..LIVER
    },
    Case {
        id: "levels_small_budget",
        capabilities: &["DEB-39"],
        what: "fine points at work under the hand with a budget below what the coarsest mesh needs: none, and it stands",
        settings: &["bodies.liver.levels.budget=1", "bodies.liver.levels.settled=0"],
        reading: Reading::last("fine").taking(Statistic::Max),
        reference: 0.0,
        tolerance: Tolerance::Absolute(0.0),
        source: "nothing is refined above 95 % of the budget",
        mutation: "bodies.liver.levels.budget=50000",
        ..LIVER
    },
    Case {
        id: "liver_budget",
        capabilities: &["DEB-39"],
        what: "forces that a step evaluates under the hand with a budget of 600, the most at any date",
        settings: &["bodies.liver.levels.budget=600", "bodies.liver.levels.settled=0"],
        reading: Reading::last("evaluations").taking(Statistic::Max),
        reference: 0.95 * 600.0,
        tolerance: Tolerance::AtMost,
        source: "V-36: subdivision is refused above 95 %",
        mutation: "bodies.liver.levels.budget=50000",
        ..LIVER
    },
    Case {
        id: "hand_liver_refines",
        capabilities: &["DEB-12", "DEB-46"],
        what: "points of the finest mesh that move by themselves under the hand while it presses: there is none at 0.85 s, before it comes",
        reading: Reading::last("fine").after(1250),
        reference: 4.0,
        tolerance: Tolerance::AtLeast,
        source: "specification, DEB-12: refines at the tool; four are the least that a tetrahedron has",
        mutation: "bodies.liver.levels.refine=0.9",
        ..LIVER
    },
    Case {
        id: "hand_liver_fast",
        what: "what a ball does to the organ over what it does to the hand that thrust it there in 20 ms and waits, along the thrust",
        settings: &["hands.right.motion.times=[0, 0.6, 0.62, 9, 9.1]"],
        ..HELD_ON_LIVER
    },
    Case {
        id: "hand_liver_stiff",
        what: "the same on an organ a hundred times as stiff",
        settings: &[
            "hands.right.motion.times=[0, 0.6, 1, 9, 9.1]",
            "bodies.liver.material.youngs_modulus=\"1.5 MPa\"",
            "systems.main.stepper.halvings=8",
        ],
        ..HELD_ON_LIVER
    },
    Case {
        id: "hand_liver_hard",
        capabilities: &["DEB-46"],
        what: "the most that a hand feels which pushes 30 cm into the organ, and slides off: what its device gives",
        settings: &[
            "hands.right.motion.offsets=[[0, 0, 0], [0, 0, 0], [0, 0, -0.3], [0, 0, -0.3], [0, 0, 0]]",
            "hands.right.coupling={ limit = \"2 N\" }",
        ],
        reading: Reading::component("force", 2).taking(Statistic::Max),
        reference: 2.0,
        tolerance: Tolerance::AtMost,
        source: "the limit of the device",
        mutation: "hands.right.coupling={ limit = \"5 N\" }",
        ..LIVER
    },
    Case {
        id: "hand_liver_lost",
        capabilities: &["DEB-46"],
        what: "force on a hand that presses the organ a tenth of a second after its device was lost",
        settings: &["hands.right.device.lost_at=1.2", "hands.right.device.lost_for=100"],
        reading: Reading::component("force", 2).after(1300),
        source: "nobody is there to feel anything",
        tolerance: Tolerance::Absolute(0.0),
        mutation: "hands.right.device.lost_at=100",
        ..LIVER
    },
    Case {
        id: "hand_age_liver",
        capabilities: &["DEB-46"],
        what: "how old what the force says of the organ is when the next one takes its place, the most",
        reading: Reading::last("age"),
        // a tick of the device and one of the stepper
        reference: 1e-3 + 1e-3 / 16.0,
        tolerance: Tolerance::Absolute(1e-8),
        source: "the schedule, in time of the world: nothing waits for more than its next date; by the clock it is the benchmark haptic_age_99_9, which V-42's 2.5 ms are about",
        mutation: "systems.main.stepper.halvings=5",
        ..LIVER
    },
    Case {
        id: "hand_age_block",
        capabilities: &["DEB-46"],
        what: "the same of a block that is stepped a thousand times a second: a step, and a tick of the device",
        scene: "hand_on_block",
        reading: Reading::last("age").after(50),
        reference: 2e-3,
        tolerance: Tolerance::Absolute(1e-9),
        source: "the schedule, as in hand_age_liver",
        mutation: "world.period=\"0.5 ms\"",
        ..LIVER
    },
    Case {
        id: "brutal_tool",
        capabilities: &["DEB-17"],
        what: "steps that a slab whose law stiffens by an exponential lives through while a thin tool goes a centimetre into it in 10 ms: all",
        settings: BRUTAL,
        reading: Reading::Steps,
        reference: 200.0,
        tolerance: Tolerance::Absolute(0.0),
        source: "specification, DEB-17: no divergence under brutal tool motion",
        // without it the slab is not finite after 16
        mutation: "systems.main.stepper.velocity_jump=0",
        ..NEEDLE
    },
    Case {
        id: "brutal_tool_locally",
        capabilities: &["DEB-17"],
        what: "forces that a step evaluates meanwhile, the most: a tenth of those of all tetrahedra in the shortest intervals",
        settings: BRUTAL,
        reading: Reading::last("evaluations").taking(Statistic::Max),
        // 8 x 8 x 2 boxes of six tetrahedra, 2^8 times a step
        reference: 0.1 * 768.0 * 256.0,
        tolerance: Tolerance::AtMost,
        source: "specification, DEB-17: steps shrink only locally; a tenth is ours",
        mutation: "systems.main.stepper.velocity_jump=1e-6",
        ..NEEDLE
    },
    Case {
        id: "levels_no_popping",
        capabilities: &["DEB-40", "DEB-41", "DEB-42"],
        what: "the most that a node of the shown surface jumps from period to period because points come and go, also as the tool draws back: with a blend of three of them, which lasts longer where a node would move by more than 0.4 mm",
        scene: "surgical",
        settings: &["bodies.liver.levels.dress.blend=30 ms"],
        reading: Reading::last("jump"),
        reference: 0.0,
        tolerance: Tolerance::Absolute(5e-4),
        source: "V-40",
        mutation: "bodies.liver.levels.dress.most=1",
        ..LIVER
    },
    Case {
        id: "surgical_fine_where_touched",
        capabilities: &["DEB-12", "DEB-30"],
        what: "points of the finest mesh that move by themselves within 6 cm of the middle of a press of the organ while the tool holds still: there were none before it came",
        scene: "surgical",
        settings: &[],
        reading: Reading::last("near").after(90),
        reference: 20.0,
        tolerance: Tolerance::AtLeast,
        source: "specification, DEB-12: refines at the tool",
        mutation: "bodies.liver.levels.refine=0.9",
        ..LIVER
    },
    Case {
        id: "surgical_coarse_when_let_go",
        capabilities: &["DEB-12", "DEB-32"],
        what: "points of the finest mesh of the whole organ that move by themselves half a second after the tool has let go, of 2075: no more than a hundredth beside those that its weight keeps",
        scene: "surgical",
        settings: &[],
        reading: Reading::last("fine"),
        reference: 20.0,
        tolerance: Tolerance::AtMost,
        source: "specification, DEB-12: what the tool has called goes with it",
        // then the weight of the organ counts, and what has been refined stays
        mutation: "bodies.liver.levels.settled=0",
        ..LIVER
    },
    Case {
        id: "hand_jump_slow",
        capabilities: &["DEB-46", "DEB-47"],
        what: "greatest change of the force from one millisecond to the next in a press at a centimetre a second: a twentieth of what the hand feels once that is 0.4 N, a quarter of its greatest; where an edge of the organ slips past the ball it is 1.1 N",
        settings: SLOWLY,
        tolerance: Tolerance::Absolute(0.05 * 0.4),
        source: "V-43: a twentieth of the current force, in a slow press at constant speed",
        mutation: r#"hands.right.coupling={ stiffness = "4000 N/m", damping = 2, limit = "5 N" }"#,
        ..LIVER
    },
    Case {
        id: "hand_liver_never_sticks",
        capabilities: &["DEB-48"],
        what: "force of the ball on the organ along the way out, the most at any date: it never pulls",
        reading: Reading::component("on_liver", 2).taking(Statistic::Max),
        tolerance: Tolerance::Absolute(1e-9),
        source: "specification, V-44: a contact only pushes",
        // through the organ, which the ball leaves behind it
        mutation: "hands.right.motion.offsets=[[0, 0, 0], [0, 0, 0], [0, 0, -0.2], [0, 0, -0.2], [0, 0, 0]]",
        ..LIVER
    },
    Case {
        id: "hand_liver_release_light",
        capabilities: &["DEB-48"],
        what: "the most that a hand is pulled in by while it presses the organ and lets go of it, with a tool of 5 g whose mass it does not feel: less than 1 % of what it feels at most",
        settings: &["hands.right.mass=\"5 g\"", "hands.right.feels_mass=false"],
        reading: Reading::component("force", 2).taking(Statistic::Min),
        reference: -0.01 * 1.551,
        tolerance: Tolerance::AtLeast,
        source: "specification, V-44: 1 % of the peak. What the hand feels when nothing touches is its tool: 5.2 % with 50 g that are felt",
        mutation: "hands.right.feels_mass=true",
        ..LIVER
    },
];
