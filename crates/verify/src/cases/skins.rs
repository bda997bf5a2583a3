//! Skins: tension, curvature, rest, what is held constant, metamorphosis, dressing, contact, cost by resolution.

use crate::reading::Statistic;
use crate::{Case, Limit, Reading, Refinement, Tolerance, Variant};

const SOURCE: &str = "Desbrun & Cani-Gascuel 1998, Active implicit surface for animation";

/// Of the volume of a ball of 0.85 m at voxels of 62.5 mm: the chords of its triangles, which lack 0.66 h²/R² of it as a ball of 64
/// cells across does, are 3.6e-3, and a hundredth of a voxel is 2.2e-3.
const AT_REST_ON_A_BALL: Tolerance = Tolerance::Relative(5.8e-3);

const SKIN: Case = Case {
    id: "",
    capabilities: &[],
    what: "",
    scene: "sphere_under_tension",
    settings: &[],
    reading: Reading::last("volume"),
    refinement: None,
    reference: 0.0,
    tolerance: Tolerance::Relative(0.02),
    source: SOURCE,
    mutation: "",
};

/// The time in which R² falls to half, and the volume `4/3 π (1/2)^(3/2)` that is left.
const HALF: f64 = 1.480_960_979_386_122;

/// Where `0.5 ((1 − c u²)³ − ½) = 10⁻³/R` with `u = R/0.85` and `c = 1 − 2^(−1/3)`: the volume of that ball.
const BALANCED: f64 = 2.54915494157303;

pub(super) const CASES: &[Case] = &[
    Case {
        id: "skin_shrinking_sphere",
        capabilities: &["DC-5"],
        what: "volume of a sphere under tension when R^2 = R0^2 - 4 beta t has halved, 64 cells in its diameter",
        settings: &["skins.ball.voxel=0.03125"],
        reference: HALF,
        // 1 % of R² is 1.5 % of the volume
        tolerance: Tolerance::Relative(0.015),
        mutation: "skins.ball.terms[0].strength=0.11",
        ..SKIN
    },
    Case {
        id: "skin_curvature_order",
        capabilities: &["DC-5"],
        what: "order of the mean curvature of a sphere's skin at the start",
        reading: Reading::last("curvature").after(0),
        refinement: Some(Refinement {
            size_of: "voxel [m]",
            runs: &[
                Variant { size: 0.125, settings: &["skins.ball.voxel=0.125", "skins.ball.redistance=0"] },
                Variant { size: 0.0625, settings: &["skins.ball.voxel=0.0625", "skins.ball.redistance=0"] },
            ],
            limit: Limit::Known(2.0),
        }),
        reference: 2.0,
        tolerance: Tolerance::Absolute(0.3),
        mutation: "skins.ball.start[0].formula=\"0.95 - sqrt(x^2 + y^2 + z^2)\"",
        ..SKIN
    },
    Case {
        id: "skin_shrinking_order",
        capabilities: &["DC-5"],
        what: "order in space of the volume of a sphere under tension that lost 0.12 of R^2, with what chords take of it",
        reading: Reading::last("volume").after(12),
        refinement: Some(Refinement {
            size_of: "voxel [m]",
            runs: &[
                Variant { size: 0.125, settings: &["skins.ball.voxel=0.125"] },
                Variant { size: 0.0625, settings: &["skins.ball.voxel=0.0625"] },
            ],
            // 4/3 π (1 − 0.12)^(3/2)
            limit: Limit::Known(3.457901496037841),
        }),
        reference: 2.0,
        tolerance: Tolerance::Absolute(0.5),
        mutation: "skins.ball.terms[0].strength=0.11",
        ..SKIN
    },
    Case {
        id: "skin_balanced",
        capabilities: &["DC-5", "DC-6"],
        what: "volume at which attraction to a ball and tension are equal: alpha (G(R) - 1/2) = 2 beta/R",
        scene: "skin_ball",
        reading: Reading::last("volume"),
        // R = 0.847427 m
        reference: BALANCED,
        tolerance: AT_REST_ON_A_BALL,
        mutation: "skins.ball.terms[1].strength=5e-3",
        ..SKIN
    },
    Case {
        id: "skin_tension_none",
        capabilities: &["DC-5"],
        what: "volume at which a skin without tension rests on the same ball: that of the ball itself",
        scene: "skin_ball",
        settings: &["skins.ball.terms[1].strength=0"],
        // 4/3 π 0.85³
        reference: 2.572_440_784_514_441_7,
        tolerance: AT_REST_ON_A_BALL,
        mutation: "skins.ball.terms[1].strength=5e-4",
        ..SKIN
    },
    Case {
        id: "skin_tension_strong",
        capabilities: &["DC-5"],
        what: "volume at which ten times that tension and the same attraction are equal",
        scene: "skin_ball",
        settings: &["skins.ball.terms[1].strength=5e-3"],
        // R = 0.823532 m
        reference: 2.339_539_144_285_654_4,
        tolerance: AT_REST_ON_A_BALL,
        mutation: "skins.ball.terms[1].strength=4e-3",
        ..SKIN
    },
    Case {
        id: "skin_rest",
        capabilities: &["DC-6"],
        what: "greatest speed of a skin ten seconds after it was let go to a fixed target at half a metre per second",
        scene: "skin_at_rest",
        reading: Reading::last("speed"),
        reference: 0.0,
        // a five-hundredth of a voxel in a step of 100 ms; what is left of the way, e^(-alpha |grad G| t), is 2e-7 of it
        tolerance: Tolerance::Absolute(1e-3),
        mutation: "skins.peanut.parts[0].motion=[\"0.2*sin(3*t)\", 0, 0]",
        ..SKIN
    },
    Case {
        id: "skin_rest_distance",
        capabilities: &["DC-6"],
        what: "the greatest distance of the skin at rest from its target, of which half a voxel is allowed",
        scene: "skin_at_rest",
        reading: Reading::last("distance"),
        reference: 0.0,
        tolerance: Tolerance::Absolute(0.025),
        mutation: "skins.peanut.terms[0].strength=0.02",
        ..SKIN
    },
    Case {
        id: "skin_held_area",
        capabilities: &["DC-7"],
        what: "area of a drop held against tension, after 1,000 steps",
        scene: "skin_area",
        reading: Reading::last("area").after(1000),
        reference: 12.4,
        tolerance: Tolerance::Relative(1e-3),
        mutation: "skins.drop.terms[1].rate=0.5",
        ..SKIN
    },
    Case {
        id: "skin_held_volume_drift",
        capabilities: &["DC-7"],
        what: "greatest volume of a drop held against tension less the least, over 1,000 steps: within 0.1 % at every step",
        scene: "skin_held",
        reading: Reading::last("volume").taking(Statistic::Span),
        reference: 0.0,
        // tension and rate are equal at γ (V0 − V)/V0 = β κ: 0.05 %
        tolerance: Tolerance::Absolute(4.15e-3),
        mutation: "skins.drop.terms[1].rate=0.4",
        ..SKIN
    },
    Case {
        id: "skin_held_area_drift",
        capabilities: &["DC-7"],
        what: "greatest area of a drop that keeps the area it began with less the least, over 1,000 steps: within 0.1 % at every step",
        scene: "skin_area",
        settings: &["skins.drop.terms[1].area=\"\""],
        reading: Reading::last("area").after(1000).taking(Statistic::Span),
        reference: 0.0,
        // γ (A0 − A)/A0 = β κ: 0.02 %
        tolerance: Tolerance::Absolute(0.0125),
        mutation: "skins.drop.terms[1].rate=0.5",
        ..SKIN
    },
    Case {
        id: "skin_led_area",
        capabilities: &["DC-7"],
        what: "the greatest area of a drop whose area is led up and down by a tenth",
        scene: "skin_area",
        reading: Reading::last("area").taking(Statistic::Max),
        reference: 13.64,
        // where it is led no further, tension holds it back by beta kappa/gamma = 1.9e-4, and its facets measure a tenth of that
        tolerance: Tolerance::Relative(3e-4),
        mutation: "skins.drop.terms[1].rate=0.5",
        ..SKIN
    },
    Case {
        id: "skin_held_volume",
        capabilities: &["DC-7"],
        what: "volume of a drop held against tension, after 1,000 steps",
        scene: "skin_held",
        // that of its triangles at the start; 0.1 % of drift
        reference: 4.150_741_847_3,
        tolerance: Tolerance::Relative(1e-3),
        mutation: "skins.drop.terms[1].rate=0.04",
        ..SKIN
    },
    Case {
        id: "skin_metamorphosis_parts",
        capabilities: &["DC-4"],
        what: "parts of a skin that went from six lobes to two balls",
        scene: "skin_metamorphosis",
        reading: Reading::last("components"),
        reference: 2.0,
        tolerance: Tolerance::Absolute(0.0),
        mutation: "skins.shape.terms[0].strength=0",
        ..SKIN
    },
    Case {
        id: "skin_metamorphosis_euler",
        capabilities: &["DC-3", "DC-4"],
        what: "its Euler characteristic: 2 for each ball",
        scene: "skin_metamorphosis",
        reading: Reading::last("euler"),
        reference: 4.0,
        tolerance: Tolerance::Absolute(0.0),
        mutation: "skins.shape.terms[0].strength=0",
        ..SKIN
    },
    Case {
        id: "skin_metamorphosis_events",
        capabilities: &["DC-4"],
        what: "changes of topology from six lobes to two balls: the filament separates, once",
        scene: "skin_metamorphosis",
        reading: Reading::last("events"),
        reference: 1.0,
        tolerance: Tolerance::Absolute(0.0),
        mutation: "skins.shape.terms[0].strength=0",
        ..SKIN
    },
    Case {
        id: "skin_untwisted",
        capabilities: &["DC-3"],
        what: "changes of topology while a twisted bundle becomes a bean",
        scene: "skin_untwists",
        reading: Reading::last("events"),
        reference: 0.0,
        tolerance: Tolerance::Absolute(0.0),
        mutation: "skins.shape.parts[0].formula=\"0.5*clamp(1 - sqrt(((abs(x) - 0.6)^2 + y^2 + z^2))/0.4, -1, 1)\"",
        ..SKIN
    },
    Case {
        id: "skin_untwisted_distance",
        capabilities: &["DC-3"],
        what: "how far it is from the bean at last, of which a voxel is allowed",
        scene: "skin_untwists",
        // tension keeps off sharp places
        settings: &["skins.shape.terms[1].strength=0.002"],
        reading: Reading::last("distance"),
        reference: 0.0,
        tolerance: Tolerance::Absolute(0.04),
        mutation: "skins.shape.terms[0].strength=0.1",
        ..SKIN
    },
    Case {
        id: "skin_untwisted_rest",
        capabilities: &["DC-3"],
        what: "how far it rests from the bean with the tension that the source names: where alpha (G - 1/2) = beta kappa",
        scene: "skin_untwists",
        reading: Reading::last("distance").after(300),
        // by triangles without a grid, `equilibrium` in crates/skin/tests/rest.rs
        reference: 0.05,
        // half a voxel
        tolerance: Tolerance::Absolute(0.02),
        mutation: "skins.shape.terms[1].strength=0.002",
        ..SKIN
    },
    Case {
        id: "skin_untwisted_volume",
        capabilities: &["DC-3"],
        what: "its volume there; that of the bean is 4/3 pi 0.55^3/sqrt(0.6) = 0.8997 m^3",
        scene: "skin_untwists",
        reading: Reading::last("volume").after(300),
        // of the same triangles: 0.80880, 0.82546, 0.82973 at 258, 1026, 4098 points, and so on by quarters
        reference: 0.83115,
        // a tenth of a voxel on an area of 4.376 m²
        tolerance: Tolerance::Absolute(0.0175),
        mutation: "skins.shape.terms[1].strength=0.002",
        ..SKIN
    },
    Case {
        id: "skin_ring_opens",
        capabilities: &["DC-4"],
        what: "Euler characteristic of a ball that became a ring",
        scene: "skin_ring",
        reading: Reading::last("euler").after(95),
        reference: 0.0,
        tolerance: Tolerance::Absolute(0.0),
        mutation: "skins.shape.terms[0].strength=0",
        ..SKIN
    },
    Case {
        id: "skin_ring_closes",
        capabilities: &["DC-4"],
        what: "Euler characteristic of the ring that became a ball again",
        scene: "skin_ring",
        reading: Reading::last("euler"),
        reference: 2.0,
        tolerance: Tolerance::Absolute(0.0),
        mutation: "skins.shape.parts[1].formula=\"0.5*clamp((0.25 - sqrt((sqrt(x^2 + y^2) - 0.65)^2 + z^2))/0.25, -1, 1)\"",
        ..SKIN
    },
    Case {
        id: "skin_drop_round",
        capabilities: &["DC-1", "DC-5"],
        what: "roundness of a block of loose masses that nothing but the tension of its skin holds",
        scene: "skin_drop",
        reading: Reading::last("roundness"),
        reference: 1.0,
        tolerance: Tolerance::Absolute(0.05),
        mutation: "networks.drop.skin.push.tension=0",
        ..SKIN
    },
    Case {
        id: "skin_drop_momentum",
        capabilities: &["DC-1"],
        what: "momentum of these masses: what the skin pulls with adds up to nothing",
        scene: "skin_drop",
        reading: Reading::component("momentum", 0),
        reference: 0.030_72,
        // roundings of 800 steps on forces a thousand times as large as what is left of them
        tolerance: Tolerance::Relative(1e-9),
        mutation: "networks.drop.masses.water.drag=0.001",
        ..SKIN
    },
    Case {
        id: "skin_drop_spin",
        capabilities: &["DC-1"],
        what: "angular momentum of these masses, which starts as nothing",
        scene: "skin_drop",
        reading: Reading::last("spin").taking(Statistic::Max),
        reference: 0.0,
        // a hundred-millionth of what a hundredth of a radian per second would be, and roundings of 3200 evaluations below it
        tolerance: Tolerance::Absolute(1e-12),
        mutation: "networks.drop.angular_velocity=[0, 0, 0.01]",
        ..SKIN
    },
    Case {
        id: "skin_drop_pressed",
        capabilities: &["DC-1"],
        what: "momentum of these masses with a pressure of the skin that holds the volume against its tension",
        scene: "skin_drop",
        settings: &["networks.drop.skin.push.pressure=1000"],
        reading: Reading::component("momentum", 0),
        reference: 0.030_72,
        tolerance: Tolerance::Relative(1e-9),
        mutation: "networks.drop.masses.water.drag=0.001",
        ..SKIN
    },
    Case {
        id: "skin_drop_keeps_volume",
        capabilities: &["DC-1"],
        what: "the least volume of that drop, of what it has before it is round: tension alone presses it by a twentieth",
        scene: "skin_drop",
        settings: &["networks.drop.skin.push.pressure=1000"],
        reading: Reading::last("volume").taking(Statistic::Min),
        reference: 1.63e-3,
        tolerance: Tolerance::Relative(0.03),
        mutation: "networks.drop.skin.push.pressure=0",
        ..SKIN
    },
    Case {
        id: "skin_thread_pinches",
        capabilities: &["DC-1"],
        what: "parts of a stretched drop's skin",
        scene: "skin_pinch",
        reading: Reading::last("components").taking(Statistic::Max),
        reference: 2.0,
        tolerance: Tolerance::Absolute(0.5),
        mutation: "networks.drop.masses.left.velocity=[0.2, 0, 0]",
        ..SKIN
    },
    Case {
        id: "skin_thread_parts",
        capabilities: &["DC-1", "DC-5"],
        what: "parts of a thread of loose masses whose skin is tense, waves longer than its girth",
        scene: "skin_thread",
        reading: Reading::last("components"),
        reference: 3.0,
        tolerance: Tolerance::Absolute(0.0),
        mutation: "networks.thread.skin.push.tension=0",
        ..SKIN
    },
    Case {
        id: "skin_thread_holds",
        capabilities: &["DC-1", "DC-5"],
        what: "parts of the same thread with waves shorter than its girth, after as long a time",
        scene: "skin_thread",
        settings: &["parameters.wavelength=0.25"],
        reading: Reading::last("components"),
        reference: 1.0,
        tolerance: Tolerance::Absolute(0.0),
        mutation: "parameters.wavelength=0.44",
        ..SKIN
    },
    Case {
        id: "skin_thread_still",
        capabilities: &["DC-1", "DC-5"],
        what: "parts of the thread with the longer waves under a skin that does not pull",
        scene: "skin_thread",
        settings: &["networks.thread.skin.push.tension=0"],
        reading: Reading::last("components"),
        reference: 1.0,
        tolerance: Tolerance::Absolute(0.0),
        mutation: "networks.thread.skin.push.tension=1",
        ..SKIN
    },
    Case {
        id: "skin_touched_momentum",
        capabilities: &["DC-1"],
        what: "momentum of a cube and the network whose skin it ran into, after they parted",
        scene: "skin_touched",
        reading: Reading::component("momentum", 0),
        reference: 0.5,
        tolerance: Tolerance::Relative(1e-9),
        mutation: "networks.clump.masses.grains.drag=0.01",
        ..SKIN
    },
    Case {
        id: "skin_touched_spin",
        capabilities: &["DC-1"],
        what: "angular momentum of both, about the origin: what pushes comes to the masses under the skin with its moment",
        scene: "skin_touched",
        reading: Reading::component("spin", 1),
        // a kilogram at half a metre per second, 10 mm aside
        reference: -0.005,
        tolerance: Tolerance::Relative(1e-9),
        mutation: "networks.clump.masses.grains.drag=0.01",
        ..SKIN
    },
    Case {
        id: "skin_touched_pushes",
        capabilities: &["DC-1"],
        what: "speed of the network afterwards: more than that of both together, less than of an elastic push",
        scene: "skin_touched",
        reading: Reading::component("clump", 0),
        // a half of it to both, all of it to a network of the cube's mass
        reference: 0.375,
        tolerance: Tolerance::Absolute(0.125),
        mutation: "contacts[0].stiffness=1e-6",
        ..SKIN
    },
    Case {
        id: "skin_levels_smooth",
        capabilities: &["DC-2"],
        what: "changes of topology of a skin over particles that split where they are pressed, and merge again",
        scene: "skin_levels",
        reading: Reading::last("events"),
        reference: 0.0,
        tolerance: Tolerance::Absolute(0.0),
        mutation: "bodies.block.skin.radius=0.008",
        ..SKIN
    },
    Case {
        id: "skin_levels_jump",
        capabilities: &["DC-2"],
        what: "the greatest speed of that skin, also in the steps of a split: a quarter of a voxel of 8 mm in a step of 10 ms is not seen",
        scene: "skin_levels",
        reading: Reading::last("speed").taking(Statistic::Max),
        reference: 0.0,
        // attraction: the density is between 0 and 1 and one half on the skin, alpha/2 = 0.15 m/s; tension: beta = 2e-4 m²/s
        // times the curvature of a ball of one voxel, the sharpest that the grid tells, 2/h: 0.05 m/s
        tolerance: Tolerance::Absolute(0.2),
        mutation: "bodies.block.skin.terms[0].strength=3",
        ..SKIN
    },
    Case {
        id: "skin_cost_order",
        capabilities: &["DC-8"],
        what: "order of the blocks that a sphere's grid keeps, by the voxel: the area's, not the volume's",
        reading: Reading::last("blocks").after(0),
        refinement: Some(Refinement {
            size_of: "voxel [m]",
            runs: &[
                Variant { size: 0.03125, settings: &["skins.ball.voxel=0.03125"] },
                Variant { size: 0.015_625, settings: &["skins.ball.voxel=0.015625"] },
            ],
            limit: Limit::Known(0.0),
        }),
        reference: -2.0,
        tolerance: Tolerance::Absolute(0.15),
        mutation: "skins.ball.start[0].formula=\"0.05 - sqrt(x^2 + y^2 + z^2)\"",
        ..SKIN
    },
    Case {
        id: "skin_work_order",
        capabilities: &["DC-8"],
        what: "order of the nodes that a step works out, by the voxel, from 64 to 256 cells in an edge",
        scene: "skin_ball",
        reading: Reading::last("work").after(1),
        refinement: Some(Refinement {
            size_of: "voxel [m]",
            runs: &[
                Variant { size: 0.03125, settings: &["skins.ball.voxel=0.03125"] },
                Variant { size: 0.007_812_5, settings: &["skins.ball.voxel=0.0078125"] },
            ],
            limit: Limit::Known(0.0),
        }),
        reference: -2.0,
        // rows of eight nodes are worked out as wholes, which are more where the ball is few of them across
        tolerance: Tolerance::Absolute(0.1),
        mutation: "skins.ball.start[0].formula=\"0.05 - sqrt(x^2 + y^2 + z^2)\"",
        ..SKIN
    },
    Case {
        id: "skin_strong_rest",
        capabilities: &["DC-6"],
        what: "greatest speed of a skin that is drawn thirty times as strongly: it rests as well",
        scene: "skin_at_rest",
        settings: &["skins.peanut.terms[0].strength=30"],
        reading: Reading::last("speed"),
        reference: 0.0,
        // a hundredth of a voxel in a step of 100 ms
        tolerance: Tolerance::Absolute(5e-3),
        mutation: "skins.peanut.parts[0].motion=[\"0.2*t\", 0, 0]",
        ..SKIN
    },
    Case {
        id: "skin_dresses_one",
        capabilities: &["DC-1"],
        what: "parts of the skin over two balls while they touch",
        scene: "skin_dresses",
        reading: Reading::last("components").after(120),
        reference: 1.0,
        tolerance: Tolerance::Absolute(0.0),
        mutation: "skins.flesh.terms[0].strength=0",
        ..SKIN
    },
    Case {
        id: "skin_dresses_parts",
        capabilities: &["DC-1"],
        what: "parts of that skin when the balls have drawn apart",
        scene: "skin_dresses",
        reading: Reading::last("components"),
        reference: 2.0,
        tolerance: Tolerance::Absolute(0.0),
        mutation: "run.duration=\"0.15 s\"",
        ..SKIN
    },
    Case {
        id: "skin_dresses_events",
        capabilities: &["DC-1"],
        what: "changes of topology of that skin: it joins the balls, and parts",
        scene: "skin_dresses",
        reading: Reading::last("events"),
        reference: 2.0,
        tolerance: Tolerance::Absolute(0.0),
        mutation: "skins.flesh.terms[0].strength=0",
        ..SKIN
    },
];
