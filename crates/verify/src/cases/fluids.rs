//! Balls that flow and fly: fluids, waves, doughs, powders.

use super::network::OSCILLATOR;
use crate::{Case, Reading, Statistic, Tolerance};

/// Boards beside the dough that stay where they are.
const NO_SIDES: &[&str] = &[
    "shapes.left.motion.offsets=[[0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0]]",
    "shapes.right.motion.offsets=[[0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0]]",
];

/// A fluid of balls that a finger has pressed into.
const FLUID: Case = Case {
    capabilities: &["JIM-31"],
    scene: "medium",
    reading: Reading::last("relief"),
    reference: 0.6,
    tolerance: Tolerance::AtMost,
    source: "EXP-03: level again after a slow press of 3 S, the root of the mean square of heights at most 0.6 S",
    mutation: "parameters.cohesion=3000",
    ..OSCILLATOR
};

/// The finger, which came down four metres beside the middle, dips into the fluid: it meets the surface at 8.13 s.
const DIPPED: [&str; 2] = [
    "networks.medium.masses.finger.positions=[[-4, 0, 4.5]]",
    "networks.medium.pins[1].motion={ times = [0, 8, 8.2, 8.4], offsets = [[0, 0, 0], [0, 0, 0], [0, 0, -3.2], [0, 0, 0]] }",
];

/// Height of a ball at the wall, 8.8 m from a finger that dips into its surface.
const WAVE: Case = Case {
    settings: &DIPPED,
    reading: Reading::component("far", 2),
    source: "EXP-03: waves travel",
    // no dip
    mutation: "networks.medium.pins[1].motion.offsets=[[0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0]]",
    ..FLUID
};

/// Balls that nothing holds, thrown by a finger.
const POWDER: Case = Case {
    capabilities: &["JIM-32"],
    scene: "powder",
    source: "EXP-04: a fast stroke of 12 m/s throws masses 6 to 8 S above the free surface [V]",
    mutation: "parameters.cohesion=1000",
    ..OSCILLATOR
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "fluid_is_level_again",
        capabilities: &["JIM-31"],
        what: "height of the centre of mass of a fluid of balls after a finger left it: no more than before, -0.4998 m, and one ball of fifty on top of the others",
        scene: "medium",
        reading: Reading::last("height"),
        // S/50 above
        reference: -0.4798,
        tolerance: Tolerance::AtMost,
        source: "EXP-03: level again after a press",
        mutation: "parameters.cohesion=10000",
        ..OSCILLATOR
    },
    Case {
        id: "fluid_is_level",
        what: "relief of a fluid of balls that attract each other by 50 N/m, in columns of a ball, after a finger has pressed into it by three diameters and left",
        ..FLUID
    },
    Case {
        id: "fluid_is_level_sooner",
        what: "the same at 20 N/m",
        settings: &["parameters.cohesion=20"],
        ..FLUID
    },
    Case {
        id: "fluid_is_level_as_well",
        what: "the same at 100 N/m",
        settings: &["parameters.cohesion=100"],
        ..FLUID
    },
    Case {
        id: "fluid_stays_in_box",
        what: "how far right any ball of a fluid was that a finger pressed out of its way: no farther than the wall",
        reading: Reading::last("outermost").taking(Statistic::Max),
        reference: 5.3,
        source: "EXP-03: no mass escapes",
        mutation: "networks.medium.modules.right.parameters.stiffness=1",
        ..FLUID
    },
    Case {
        id: "fluid_stays_in_box_left",
        what: "how far left any of them was",
        reading: Reading::last("left").taking(Statistic::Min),
        reference: -5.3,
        tolerance: Tolerance::AtLeast,
        source: "EXP-03: no mass escapes",
        mutation: "networks.medium.modules.left.parameters.stiffness=1",
        ..FLUID
    },
    Case {
        id: "fluid_stays_in_box_above",
        what: "how high any of them was: no higher than the upper edge of the box that they filled at the start",
        reading: Reading::last("top").taking(Statistic::Max),
        reference: 2.6,
        source: "EXP-03: no mass escapes",
        // pressed in within 0.4 s
        mutation: "networks.medium.pins[1].motion.times=[0, 3, 3.4, 14, 24]",
        ..FLUID
    },
    Case {
        id: "wave_passes_middle",
        what: "height of a ball of the surface 3.6 m from a finger that dips in, 0.11 s after it met the surface: a centimetre at least over that at rest, 1.1823 m",
        reading: Reading::component("middle", 2).after(824),
        reference: 1.1923,
        tolerance: Tolerance::AtLeast,
        ..WAVE
    },
    Case {
        id: "wave_is_on_its_way",
        what: "height of a ball at the wall, 8.8 m from that finger, after 0.08 s: that at rest, 0.3623 m, within a millimetre, since sound would come after 0.083 s",
        reading: Reading::component("far", 2).after(821),
        reference: 0.3623,
        // √(9/8 k/m) S = 106 m/s along rows of a triangular lattice
        tolerance: Tolerance::Absolute(1e-3),
        // a dip a tenth of a second earlier
        mutation: "networks.medium.pins[1].motion.times=[0, 7.9, 8.1, 8.3]",
        ..WAVE
    },
    Case {
        id: "wave_reaches_wall",
        what: "height of that ball after 0.27 s, by when the wave has come: a tenth of a diameter at least over that at rest",
        reading: Reading::component("far", 2).after(840),
        reference: 0.4623,
        tolerance: Tolerance::AtLeast,
        ..WAVE
    },
    Case {
        id: "fluid_waves_die",
        what: "kinetic energy of a fluid five seconds after a finger that dipped in was out again: less than what lifts one ball by a hundredth of its diameter",
        settings: &DIPPED,
        reading: Reading::last("kinetic").after(1340),
        // m g S/100
        reference: 0.0981,
        source: "EXP-03: waves decay",
        mutation: "networks.medium.crowds[0].law.damping=0",
        ..FLUID
    },
    Case {
        id: "finger_feels_fluid",
        what: "the greatest force by which a finger is pressed into a fluid of balls that attract each other by 50 N/m, below zero as it is downward: less than what it is of a cohesion of 3 kN/m at least",
        reading: Reading::last("finger").taking(Statistic::Min),
        reference: -1639.0,
        tolerance: Tolerance::AtLeast,
        source: "EXP-03: the finger feels a resistance that depends on cohesion",
        ..FLUID
    },
    Case {
        id: "finger_feels_cohesion",
        what: "the same where they attract each other by 3 kN/m: more than without cohesion, 1039 N, by the strength of two bonds at least, which tear on either side",
        settings: &["parameters.cohesion=3000"],
        reading: Reading::last("finger").taking(Statistic::Min),
        // 1039 + 2 k_a (S2 - S)
        reference: -1639.0,
        source: "EXP-03: the finger feels a resistance that depends on cohesion",
        mutation: "parameters.cohesion=50",
        ..FLUID
    },
    Case {
        id: "dough_keeps_imprint",
        capabilities: &["JIM-29", "JIM-39"],
        what: "height of a dough a second after a board left it that pressed it from 4.53 m to 2.10 m",
        scene: "dough",
        reading: Reading::last("top").after(600),
        // the whole imprint
        reference: 2.1,
        // 40 % of it
        tolerance: Tolerance::Absolute(0.97),
        source: "EXP-05: more than 60 % of the imprint stays",
        mutation: "shapes.board.motion.offsets=[[0, 0, 0], [0, 0, 0], [0, 0, -1], [0, 0, -1], [0, 0, 4]]",
        ..OSCILLATOR
    },
    Case {
        id: "dough_rests_with_its_imprint",
        capabilities: &["JIM-29", "JIM-39"],
        what: "height of the same ten seconds after the board left it, where no others come from the sides: 60 % at least of the imprint, from 4.53 m to 2.10 m, is there",
        scene: "dough",
        settings: NO_SIDES,
        reading: Reading::last("top").after(1500),
        // 4.53 - 0.6 2.43
        reference: 3.07,
        tolerance: Tolerance::AtMost,
        source: "EXP-05: imprint after 10 s of rest more than 60 % of that at release",
        mutation: "shapes.board.motion.offsets=[[0, 0, 0], [0, 0, 0], [0, 0, -1], [0, 0, -1], [0, 0, 4]]",
        ..OSCILLATOR
    },
    Case {
        id: "dough_changes_neighbours",
        capabilities: &["JIM-29", "JIM-39"],
        what: "share of the bonds of the same at the start that are left then: a tenth are others, where 7 % are of a dough that only settles",
        scene: "dough",
        settings: NO_SIDES,
        reading: Reading::last("kept").after(1500),
        reference: 0.9,
        tolerance: Tolerance::AtMost,
        source: "EXP-05: number of changes of neighbours above 0",
        mutation: "shapes.board.motion.offsets=[[0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 4]]",
        ..OSCILLATOR
    },
    Case {
        id: "powder_flies",
        what: "how high grains fly that a finger has carried, which comes up at 12 m/s and stops below the surface, at 1.98 m: v²/2g = 7.34 diameters over it, but for what air and the grains beside them take",
        reading: Reading::last("top").taking(Statistic::Max),
        // 1.98 + 7
        reference: 8.98,
        // from 6 to 8 S
        tolerance: Tolerance::Absolute(1.0),
        ..POWDER
    },
    Case {
        id: "powder_flies_in_grains",
        what: "in how many parts, a diameter and a half from each other, the same is while it flies: two grains at least by themselves, and what stays",
        reading: Reading::last("parts").taking(Statistic::Max),
        reference: 3.0,
        tolerance: Tolerance::AtLeast,
        source: "EXP-04: ballistic flight of isolated grains",
        ..POWDER
    },
    Case {
        id: "powder_settles",
        what: "kinetic energy of the same nine seconds after the last grain fell: less than what lifts one by a hundredth of its diameter",
        reading: Reading::last("kinetic"),
        // m g S/100
        reference: 0.0981,
        tolerance: Tolerance::AtMost,
        source: "EXP-04: then settling",
        // a finger that goes on
        mutation: r#"networks.powder.pins[1].motion.formula=[0, 0, "-6.5 * min(1, max(0, (t - 3) / 3)) + sin(5 * t)"]"#,
        ..POWDER
    },
    Case {
        id: "powder_is_one_heap_again",
        what: "parts that the same is in then",
        reading: Reading::last("parts"),
        reference: 1.0,
        tolerance: Tolerance::Absolute(0.0),
        source: "EXP-04: then settling",
        // no weight from the moment on when they fly
        mutation: r#"world.gravity=[0, 0, "if(t < 8.5, -9.81, 0)"]"#,
        ..POWDER
    },
];
