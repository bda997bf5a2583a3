//! Objects of points: agglomerates, heaps and stacks, contours, moulds, matter that tears and sticks again.

use super::network::OSCILLATOR;
use crate::{Case, Reading, Statistic, Tolerance};

const GRAIN: Case = Case {
    capabilities: &["JIM-92"],
    scene: "grain_of_wood",
    reading: Reading::last("far"),
    tolerance: Tolerance::Relative(1e-5),
    source: "EXP-55: chains of links side by side, F n/k",
    ..OSCILLATOR
};

const AGGLOMERATE: Case = Case {
    capabilities: &["JIM-26", "JIM-27"],
    scene: "agglomerate",
    reading: Reading::last("spacing"),
    source: "EXP-37: other arrangements from other starts, neighbours at S",
    ..OSCILLATOR
};

/// Places that are as good as random.
const SHAKEN: &str = r#"networks.group.start={ displacement = ["0.4 * sin(97 * x + 131 * z)", 0, "0.4 * sin(71 * x + 53 * z)"] }"#;

const STACK: Case = Case {
    capabilities: &["JIM-21", "JIM-46", "JIM-47"],
    scene: "brick_stack",
    reading: Reading::component("top", 0),
    source: "EXP-59: a stack of five stands for a minute with a drift of less than 1 %",
    mutation: "parameters.friction=0",
    ..OSCILLATOR
};

/// How far the surface of a figure is from its balls where it is farthest; nothing moves.
macro_rules! mould_is_full {
    ($id:literal, $probe:literal, $radius:literal, $held:literal) => {
        Case {
            id: $id,
            capabilities: &["JIM-37"],
            what: "the widest gap between the surface that balls fill and the nearest of them: a radius at most",
            scene: "moulded_figures",
            settings: &[$held],
            reading: Reading::last($probe).after(1),
            reference: $radius,
            tolerance: Tolerance::AtMost,
            source: "specification §2.12.4: any closed mesh or implicit shape, balls within one radius",
            mutation: "parameters.gaps=left",
            ..OSCILLATOR
        }
    };
}

pub(super) const CASES: &[Case] = &[
    Case {
        id: "grain_along",
        what: "stretch of a block along its grain: 4 N on chains of four links of 4 kN/m",
        reference: 0.004,
        mutation: "parameters.stiff.stiffness=4001",
        ..GRAIN
    },
    Case {
        id: "grain_of_stiffer_sheet",
        capabilities: &["JIM-92", "JIM-35"],
        what: "the same of its uppermost sheet of 8 kN/m",
        reading: Reading::last("far_above"),
        reference: 0.002,
        mutation: "parameters.stiffer.stiffness=8001",
        ..GRAIN
    },
    Case {
        id: "grain_across",
        what: "the same across: 3.2 N on chains of three links of 400 N/m",
        settings: &["parameters.along=0", "parameters.across=64"],
        reading: Reading::last("top"),
        reference: 0.024,
        mutation: "parameters.soft.stiffness=400.1",
        ..GRAIN
    },
    Case {
        id: "agglomerate_spacing",
        what: "mean distance of neighbours of thirty balls that gathered from six by five",
        reference: 1.0,
        tolerance: Tolerance::Relative(1e-3),
        mutation: "networks.group.crowds[0].law.distance=1.002",
        ..AGGLOMERATE
    },
    Case {
        id: "agglomerate_spacing_again",
        what: "the same from a start shaken by 0.4 m",
        settings: &[SHAKEN],
        reference: 1.0,
        tolerance: Tolerance::Relative(1e-3),
        mutation: "networks.group.crowds[0].law.distance=1.002",
        ..AGGLOMERATE
    },
    Case {
        id: "agglomerate_bonds_again",
        what: "neighbours of each from that start: as many within a tenth, so that the energy is the same",
        settings: &[SHAKEN],
        reading: Reading::last("bonds"),
        reference: 142.0 / 30.0,
        tolerance: Tolerance::Relative(0.1),
        source: "EXP-37: the same energy within 10 %; Harborth 1974: [3n - √(12n - 3)] contacts",
        mutation: r#"networks.group.crowds[1].law.push="0 * D""#,
        ..AGGLOMERATE
    },
    Case {
        id: "agglomerate_arrangement_again",
        what: "share of the 49 neighbours on the lattice that are neighbours at the end of the shaken start: another arrangement keeps fewer than the 46 that the start on the lattice does",
        settings: &[SHAKEN],
        reading: Reading::last("kept"),
        reference: 45.0 / 49.0,
        tolerance: Tolerance::AtMost,
        source: "EXP-37: different internal arrangements",
        mutation: "networks.group.start={ displacement = [0, 0, 0] }",
        ..AGGLOMERATE
    },
    Case {
        id: "agglomerate_bonds",
        what: "neighbours of each of them: 2/30 times the bonds, 71 of thirty equal discs at most",
        reading: Reading::last("bonds"),
        reference: 142.0 / 30.0,
        tolerance: Tolerance::Relative(0.1),
        source: "EXP-37: the same energy within 10 %; Harborth 1974: [3n - √(12n - 3)] contacts",
        mutation: r#"networks.group.crowds[1].law.push="0 * D""#,
        ..AGGLOMERATE
    },
    Case {
        id: "contours_agree",
        capabilities: &["JIM-42", "JIM-43"],
        what: "how far the trace of a running probe is from the frontier of interaction of the same balls",
        scene: "two_contours",
        reading: Reading::last("apart"),
        reference: 0.0,
        tolerance: Tolerance::Absolute(0.2),
        source: "EXP-48: both agree within 0.2 S",
        mutation: "networks.block.contours.trace.radius=1.2",
        ..AGGLOMERATE
    },
    Case {
        id: "contours_agree_back",
        capabilities: &["JIM-42", "JIM-43"],
        what: "and how far the frontier is from the trace, of balls in rows, between which there is no room that only the frontier tells",
        scene: "two_contours",
        settings: &[
            "networks.block.masses.balls={ lattice = { origin = [-2.5, 0, -1.5], spacing = 1, counts = [6, 1, 4] }, mass = 1 }",
        ],
        reading: Reading::last("apart_back"),
        reference: 0.0,
        tolerance: Tolerance::Absolute(0.2),
        source: "EXP-48: both agree within 0.2 S",
        mutation: "networks.block.contours.trace.radius=1.2",
        ..AGGLOMERATE
    },
    Case {
        id: "stack_stands",
        what: "how far the uppermost of five bricks is in a minute from where geometry has it, in any direction, where each lies a centimetre beside the one below",
        reading: Reading::last("astray"),
        reference: 0.0,
        // 1 % of its length
        tolerance: Tolerance::Absolute(4e-3),
        ..STACK
    },
    Case {
        id: "stack_keeps_height",
        what: "how far it has come down: till balls beside each other touch, and by what they sink into each other under the weight above",
        reading: Reading::component("top", 2),
        // 2 (0.1 - √(0.1² - 0.01²)) + 2 (0.1 - √(0.1² - 2 0.01²)) + (5 + 4 + 3 + 2 + 1) 1.6 9.81/(8 20000) m
        reference: -4.484_5e-3,
        // 1 % of a brick's height; bricks are shorter by their own links
        tolerance: Tolerance::Absolute(2e-3),
        ..STACK
    },
    Case {
        id: "smooth_heap_stands",
        capabilities: &["JIM-28"],
        what: "height of the topmost of thirty balls that only exclude each other, in four layers on rough ground: more than two diameters",
        scene: "smooth_heap",
        reading: Reading::last("top"),
        reference: 0.2,
        tolerance: Tolerance::Above,
        source: "EXP-35: non-penetration only, a stable heap higher than 2 S on rough ground",
        mutation: "parameters.draw=1",
        ..OSCILLATOR
    },
    Case {
        id: "smooth_heap_rests",
        capabilities: &["JIM-28"],
        what: "the greatest speed in it after four seconds, over that after one",
        scene: "smooth_heap",
        reading: Reading::last("fastest").taking(Statistic::LastOver(100)),
        reference: 1e-3,
        tolerance: Tolerance::AtMost,
        source: "EXP-35: the greatest speed goes to zero",
        mutation: "networks.sand.crowds[0].law.damping=0",
        ..OSCILLATOR
    },
    Case {
        id: "smooth_heap_is_at_rest",
        capabilities: &["JIM-28"],
        what: "the greatest speed itself: less than a thousandth of a diameter in a second",
        scene: "smooth_heap",
        reading: Reading::last("fastest"),
        reference: 1e-4,
        tolerance: Tolerance::AtMost,
        source: "EXP-35: the greatest speed goes to zero; EXP-22: at rest below 1e-3 S/s",
        mutation: "networks.sand.crowds[0].law.damping=0",
        ..OSCILLATOR
    },
    Case {
        id: "smooth_heap_runs_down",
        capabilities: &["JIM-28"],
        what: "height of its topmost ball half a second after a half of its ground began to be drawn away: below the ground's uppermost layer",
        scene: "smooth_heap",
        settings: &["parameters.draw=1"],
        reading: Reading::last("top").after(250),
        reference: 0.1,
        tolerance: Tolerance::AtMost,
        source: "EXP-35: collapse when a support is removed",
        mutation: "parameters.draw=0",
        ..OSCILLATOR
    },
    Case {
        id: "heap_runs_out",
        capabilities: &["JIM-28"],
        what: "how far a heap has run out whose support was drawn away: beyond where that stood",
        scene: "heap_collapses",
        reading: Reading::last("front"),
        reference: 0.55,
        tolerance: Tolerance::Above,
        source: "EXP-35: collapse when a support is removed",
        mutation: "networks.sand.pins[1].motion.offsets=[[0, 0, 0], [0, 0, 0], [0, 0, 0]]",
        ..OSCILLATOR
    },
    Case {
        id: "heap_rests_again",
        capabilities: &["JIM-28"],
        what: "kinetic energy of a heap that ran out after its support was drawn away",
        scene: "heap_collapses",
        reading: Reading::last("moving"),
        reference: 0.0,
        // 66 balls of 0.6 kg at a tenth of a diameter a second
        tolerance: Tolerance::Absolute(2e-3),
        source: "EXP-35: collapse when a support is removed, the greatest speed goes to zero",
        mutation: "parameters.friction={ static = 0, kinetic = 0, stiffness = 1, speed = 0.01 }",
        ..OSCILLATOR
    },
    Case {
        id: "clay_is_torn",
        capabilities: &["JIM-30"],
        what: "parts that a cohesive block is in after it was drawn apart",
        scene: "clay_sticks_again",
        reading: Reading::last("parts").after(300),
        reference: 2.0,
        tolerance: Tolerance::Absolute(0.0),
        source: "EXP-36: components 1 -> 2 -> 1",
        mutation: "networks.clay.pins[1].motion.offsets[1]=[0, 0, 0.2]",
        ..OSCILLATOR
    },
    Case {
        id: "clay_is_one_again",
        capabilities: &["JIM-30"],
        what: "parts of the same after it was pressed together",
        scene: "clay_sticks_again",
        reading: Reading::last("parts").after(600),
        reference: 1.0,
        tolerance: Tolerance::Absolute(0.0),
        source: "EXP-36: components 1 -> 2 -> 1",
        mutation: "networks.clay.pins[1].motion.offsets[2]=[0, 0, 1]",
        ..OSCILLATOR
    },
    Case {
        id: "bar_is_strangled",
        capabilities: &["JIM-30"],
        what: "parts that a bar of cohesive balls is in after two jaws closed round its waist and opened again",
        scene: "strangled_clay",
        reading: Reading::last("parts").after(700),
        reference: 2.0,
        tolerance: Tolerance::Absolute(0.0),
        source: "EXP-09: components 1 -> 2 under strangling",
        mutation: "parameters.close=1",
        ..OSCILLATOR
    },
    Case {
        id: "bar_stays_bent",
        capabilities: &["JIM-30"],
        what: "where the free end of the same is, gripped at the other and pressed aside by one jaw, twenty-two seconds after that began to leave: a diameter aside at least, so that rows have glided",
        scene: "strangled_clay",
        settings: &[
            "networks.clay.pins[0]={ region = { box = [[-0.1, -1, -0.1], [3.1, 1, 3.1]] } }",
            "networks.clay.masses.upper.lattice.origin=[12, 0, 5]",
            "networks.clay.masses.lower.lattice.origin=[30, 0, -6]",
            "parameters.close=5.5",
            "parameters.press=0",
        ],
        reading: Reading::last("end").after(2700),
        reference: -1.0,
        tolerance: Tolerance::AtMost,
        source: "EXP-09: residual bending angle after release",
        // less far, it springs back
        mutation: "parameters.close=3.5",
        ..OSCILLATOR
    },
    Case {
        id: "bar_is_one_again",
        capabilities: &["JIM-30"],
        what: "parts of the same after its ends were pressed together",
        scene: "strangled_clay",
        reading: Reading::last("parts"),
        reference: 1.0,
        tolerance: Tolerance::Absolute(0.0),
        source: "EXP-09: pieces stick again when pressed together if cohesive",
        mutation: "parameters.press=0",
        ..OSCILLATOR
    },
    mould_is_full!("pill_is_full", "pill", 0.008, "networks.pill.masses.balls.fixed=true"),
    mould_is_full!("sphere_is_full", "sphere", 0.01, "networks.sphere.masses.balls.fixed=true"),
    mould_is_full!("block_is_full", "block", 0.009, "networks.block.masses.balls.fixed=true"),
    // a surface of triangles; equal balls within an edge of the angle a leave a gap of 1/sin(a/2) - 1 radii there, more than one where a is less than 60°
    mould_is_full!("mesh_is_full", "egg", 0.009, "networks.egg.masses.balls.fixed=true"),
    Case {
        id: "agglomerate_energy",
        what: "energy of the bonds of thirty balls that gathered: no more than that of 71 of them, which is the most there may be, of k_a (S2 - S)(S3 - S)/2 = 25 J, and within a tenth of it",
        reading: Reading::last("stored"),
        // between -25 71 and 0.9 of it: two that are are within a tenth of each other
        reference: -1686.25,
        tolerance: Tolerance::Absolute(88.75),
        source: "EXP-37: the same energy within 10 %; Harborth 1974: [3n - √(12n - 3)] contacts",
        mutation: r#"networks.group.crowds[1].law.push="0 * D""#,
        ..AGGLOMERATE
    },
    Case {
        id: "agglomerate_energy_again",
        what: "the same from a start shaken by 0.4 m",
        settings: &[SHAKEN],
        reading: Reading::last("stored"),
        reference: -1686.25,
        tolerance: Tolerance::Absolute(88.75),
        source: "EXP-37: the same energy within 10 %; Harborth 1974: [3n - √(12n - 3)] contacts",
        mutation: r#"networks.group.crowds[1].law.push="0 * D""#,
        ..AGGLOMERATE
    },
    Case {
        id: "sheet_tears_from_its_notch",
        capabilities: &["JIM-51"],
        what: "greatest pull of a sheet with a notch: less than that of all links of the ligament at once, which tear one after the other",
        scene: "tearing_sheet",
        reading: Reading::last("pull").taking(Statistic::Max),
        // 16 12 + 31 12/√2
        reference: 455.0,
        tolerance: Tolerance::AtMost,
        source: "EXP-46: rupture; sixteen upright links of 12 N and thirty-one aslant",
        mutation: r#"parameters.law.rupture="30 N""#,
        ..OSCILLATOR
    },
];
