//! Masses that stick to what they lie on and slide on it: dry friction, friction that grows or falls with speed, bristles.

use super::network::OSCILLATOR;
use crate::{Case, Reading, Statistic, Tolerance};

/// The same friction at any speed of sliding.
const DRY: &str = "networks.belt.crowds[0].friction={ static = 0.6, kinetic = 0.3, stiffness = 100000, damping = 300, speed = 0.002 }";

/// A belt that runs to and fro by a decimetre, at 5 mm/s, under a mass on a spring and damper.
const REVERSED: Case = Case {
    capabilities: &["JIM-45", "JIM-46", "JIM-48"],
    scene: "bow",
    settings: &[
        DRY,
        r#"networks.belt.links[0].law={ name = "spring_damper", stiffness = 100, damping = 20 }"#,
        "networks.belt.pins[0].motion={ times = [0, 20, 60, 100, 140, 180], offsets = [[0, 0, 0], [0.1, 0, 0], [-0.1, 0, 0], [0.1, 0, 0], [-0.1, 0, 0], [0.1, 0, 0]] }",
    ],
    ..OSCILLATOR
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "skin_keeps_drop",
        capabilities: &["JIM-36"],
        what: "how far balls that fall on a floor run out in a skin, over how far the same balls run without one",
        scene: "drops_on_a_floor",
        reading: Reading::Ratio { of: "in_skin", to: "bare", component: 0 },
        // without it they run out by more than the width that they fell with (`bare_drop_spreads`): with it by less than a quarter of that
        reference: 0.25,
        tolerance: Tolerance::AtMost,
        source: "EXP-56: the skin prevents spreading",
        mutation: "parameters.skin=200",
        ..OSCILLATOR
    },
    Case {
        id: "ski_slides_steadily",
        capabilities: &["JIM-48"],
        what: "stretch of the spring of a mass on a belt at 0.2 m/s where friction grows with speed",
        scene: "bow",
        settings: &["networks.belt.crowds[0].friction.growth=1"],
        reading: Reading::last("place"),
        // 10 N (0.3 + 0.3 e^-4 + 0.2)/100 N/m
        reference: 0.050_549_469_166_62,
        // the belt, a ball of 10 km that has come 0.8 m, leans by 8e-5
        tolerance: Tolerance::Relative(4e-4),
        source: "g(v, p) = p [μ_c + (μ_s - μ_c) e^{-v/v_b} + c v] (specification §2.14.6)",
        mutation: "networks.belt.crowds[0].friction.growth=1.01",
        ..OSCILLATOR
    },
    Case {
        id: "hook_creeps",
        capabilities: &["JIM-48"],
        what: "way of a mass under 1 N in four seconds, held by a hook of 100 kN/m in series with a damper of 1 kN s/m",
        scene: "bow",
        settings: &[
            r#"networks.belt.pins[0].motion.formula=["0", 0, 0]"#,
            r#"networks.belt.links[0].law={ name = "spring_damper", stiffness = 0, damping = 0 }"#,
            "networks.belt.loads[0].force=[1, 0, -10]",
            "networks.belt.crowds[0].friction={ static = 0.6, kinetic = 0.3, stiffness = 100000, hook_viscosity = 1000, speed = 0.005 }",
        ],
        reading: Reading::last("place"),
        // F t/z + F/k
        reference: 0.004_01,
        // m F/z² = 1e-6 m is lost while it comes to speed
        tolerance: Tolerance::Relative(1e-3),
        source: "specification §2.14.6: the hook is a Maxwell element",
        mutation: "networks.belt.crowds[0].friction.hook_viscosity=1010",
        ..OSCILLATOR
    },
    Case {
        id: "hook_holds_up_to_its_peak",
        capabilities: &["JIM-46", "JIM-48"],
        what: "greatest stretch of the spring of a mass on a belt that runs slowly: where it pulls by 0.6 of 10 N",
        scene: "bow",
        settings: &[DRY, r#"networks.belt.pins[0].motion.formula[0]="0.02 * t""#],
        reading: Reading::last("place").taking(Statistic::Max),
        reference: 0.06,
        // v²/(2 3 N/m) = 7e-5 m beyond it, and z v/k = 4e-5 m short of it
        tolerance: Tolerance::Absolute(1.1e-4),
        source: "EXP-39: peak μ_s N",
        mutation: "networks.belt.crowds[0].friction.static=0.602",
        ..OSCILLATOR
    },
    Case {
        id: "hook_slides_on_its_plateau",
        capabilities: &["JIM-45", "JIM-48"],
        what: "stretch of the same under which the belt slides, where a damper of 20 N s/m keeps the mass from swinging: 0.3 of 10 N",
        scene: "bow",
        settings: &[
            DRY,
            r#"networks.belt.links[0].law={ name = "spring_damper", stiffness = 100, damping = 20 }"#,
        ],
        reading: Reading::last("place"),
        reference: 0.03,
        // the belt, a ball of 10 km that has come 0.8 m, leans by 8e-5
        tolerance: Tolerance::Relative(4e-4),
        source: "EXP-39: plateau μ_c N",
        mutation: "networks.belt.crowds[0].friction.kinetic=0.301",
        ..OSCILLATOR
    },
    Case {
        id: "turned_hook_holds_up_to_its_peak",
        what: "place of a mass on a belt that runs to and fro, farthest back: it slid, stuck as the belt turned, and is carried to where spring and damper pull by 0.6 of 10 N the other way",
        reading: Reading::last("place").taking(Statistic::Min).after(6000),
        // (6 N - 20 N s/m 5 mm/s)/(100 N/m)
        reference: -0.059,
        // it is looked at every 50 µm; a step more on its way, and the lean of the belt, a micrometre each
        tolerance: Tolerance::Absolute(5.2e-5),
        source: "EXP-39: peak μ_s N, cycles of sticking again",
        mutation: "networks.belt.crowds[0].friction.static=0.602",
        ..REVERSED
    },
    Case {
        id: "turned_hook_slides_on_its_plateau",
        what: "the same when it has slid since: the spring pulls by 0.3 of 10 N the other way",
        reading: Reading::last("place").after(6000),
        reference: -0.03,
        // the belt, a ball of 10 km a decimetre aside, leans by 1e-5
        tolerance: Tolerance::Absolute(2e-6),
        source: "EXP-39: plateau μ_c N, after the load is reversed",
        mutation: "networks.belt.crowds[0].friction.kinetic=0.301",
        ..REVERSED
    },
    Case {
        id: "turned_hook_is_elastic",
        what: "the same on the next way there, stuck for ten seconds: 50 mm from its plateau, and where the belt was half a cycle before it slid; its hook and spring in series",
        reading: Reading::last("place").after(7000),
        // K_t (50 - 30) mm = (K_t + k) x + z v
        reference: (2000.0 - 0.1) / 100_100.0,
        // the belt leans by 1e-5 at most, at its turn and here
        tolerance: Tolerance::Absolute(2e-6),
        source: "EXP-39: slope K_t of the hook; F_t = -K_t D_acc (specification §2.14.3)",
        mutation: "networks.belt.crowds[0].friction.stiffness=90000",
        ..REVERSED
    },
    Case {
        id: "cycle_of_hook_is_closed",
        what: "the same a cycle of the belt later, over where it was",
        reading: Reading::last("place").taking(Statistic::LastOver(7000)).after(15_000),
        reference: 1.0,
        // virtual points of one step or the next: 2.5 µm of 20 mm
        tolerance: Tolerance::Absolute(1.25e-4),
        source: "EXP-39: cycles of hysteresis, closed",
        // farther back in the second cycle
        mutation: "networks.belt.pins[0].motion.offsets[4]=[-0.11, 0, 0]",
        ..REVERSED
    },
    Case {
        id: "bow_sticks_and_slips",
        capabilities: &["JIM-48"],
        what: "span of the places of the same where friction falls with speed: between sticking and slipping back",
        scene: "bow",
        reading: Reading::last("place").taking(Statistic::Span),
        // about the mean of 0.6 N/k: 0.03 m each way, and 0.2 m/s √(m/k) = 0.02 m
        reference: 0.072,
        tolerance: Tolerance::Relative(0.1),
        source: "EXP-39: relaxation oscillation with the bow's curve",
        mutation: "networks.belt.links[0].law.stiffness=200",
        ..OSCILLATOR
    },
];
