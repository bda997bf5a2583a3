//! Every law of links on the virtual rheometer, against the vectors of the specification.

use super::network::OSCILLATOR;
use crate::{Case, Reading, Tolerance};

pub(super) const PULL: Reading = Reading::component("pull", 0);

pub(super) const PLASTIC: Case = Case {
    id: "",
    capabilities: &["JIM-50"],
    what: "",
    scene: "rheometer",
    reading: PULL.after(5),
    tolerance: Tolerance::Absolute(1e-9),
    source: "specification §8.1, elasto-plastic with hardening: places are decimals, rounding times k",
    mutation: "networks.sample.links[0].law.hardening=251",
    ..OSCILLATOR
};

const TE: &str = "world.period=0.0033333333333333335";

/// A hundred times as many steps.
const FINE: &str = "world.period=3.3333333333333335e-05";

const BURGER_HUNG: &str = r#"networks.sample.links[0].law={ name = "burger", solid_stiffness = 1000, solid_viscosity = 50, fluid_stiffness = 2000, fluid_viscosity = 500 }"#;
const TEN_NEWTONS_FOR_A_SECOND: &str =
    r#"networks.sample.loads=[{ region = "lead", force = ["if(t < 0.9999, -10, 0)", 0, 0] }]"#;

const MAXWELL: Case = Case {
    capabilities: &["JIM-52", "JIM-56"],
    settings: &[
        TE,
        r#"networks.sample.links[0].law={ name = "maxwell", stiffness = 1000, viscosity = 100 }"#,
        "networks.sample.pins[0].motion={ times = [0, 0.0033333333333333335], offsets = [[0, 0, 0], [-0.01, 0, 0]] }",
    ],
    tolerance: Tolerance::Relative(1e-12),
    source: "specification §8.1, Maxwell: a step of elongation, held",
    mutation: "networks.sample.links[0].law.viscosity=101",
    ..PLASTIC
};

const BINGHAM: Case = Case {
    capabilities: &["JIM-54", "JIM-56"],
    settings: &[
        TE,
        r#"networks.sample.links[0].law={ name = "bingham", stiffness = 1000, viscosity = 100, traction = 10, compression = 10 }"#,
        // 199 steps of 0.5 m/s, then held
        "networks.sample.pins[0].motion={ times = [0, 0.6633333333333333], offsets = [[0, 0, 0], [-0.33166666666666667, 0, 0]] }",
    ],
    tolerance: Tolerance::Relative(1e-11),
    source: "specification §8.1, Bingham: stretched at 0.5 m/s, then held",
    ..MAXWELL
};

const BURGER: Case = Case {
    capabilities: &["JIM-53", "JIM-56"],
    settings: &[
        TE,
        r#"networks.sample.links[0].law={ name = "burger", solid_stiffness = 1000, solid_viscosity = 50, fluid_stiffness = 2000, fluid_viscosity = 500 }"#,
        "networks.sample.pins[0].motion={ times = [0, 0.2], offsets = [[0, 0, 0], [-0.02, 0, 0]] }",
    ],
    // as many digits as are printed
    tolerance: Tolerance::Absolute(5e-9),
    source: "specification §8.1, Burger: stretched at 0.1 m/s to 0.02 m, then held",
    mutation: "networks.sample.links[0].law.solid_viscosity=51",
    ..MAXWELL
};

const PASTE: &str = r#"networks.sample.links[0].law={ name = "bingham", stiffness = 1000, viscosity = 100, traction = 10, compression = 10 }"#;
const LED_BY_FORCE: &str = "networks.sample.pins=[]";

/// A grip that is told to close and to open.
const GRIP: &str = r#"networks.sample.links[0].law={ name = "finite_state", states = { open = "0", closed = "-k * (D - L0)" }, transitions = { "open -> closed" = "t > 0.055 and t < 0.105", "closed -> open" = "t > 0.105" }, entries = { closed = "L0 = D" }, parameters = { k = 1000 } }"#;

pub(super) const CASES: &[Case] = &[
    Case {
        id: "rheometer_spring",
        capabilities: &["JIM-49", "JIM-56"],
        what: "a spring on the way back from 30 mm, at 20 mm: k q",
        settings: &[r#"networks.sample.links[0].law={ name = "spring", stiffness = 1000 }"#],
        reading: PULL.after(7),
        reference: 20.0,
        source: "EXP-40: Q = k q",
        mutation: "networks.sample.links[0].law.stiffness=1001",
        ..PLASTIC
    },
    Case {
        id: "rheometer_spring_has_no_loop",
        capabilities: &["JIM-49", "JIM-56"],
        what: "the same on the way there, at 20 mm",
        settings: &[r#"networks.sample.links[0].law={ name = "spring", stiffness = 1000 }"#],
        reading: PULL.after(4),
        reference: 20.0,
        source: "EXP-40: without loop",
        mutation: r#"networks.sample.links[0].law={ name = "spring_damper", stiffness = 1000, damping = 1 }"#,
        ..PLASTIC
    },
    Case {
        id: "rheometer_damper",
        capabilities: &["JIM-49", "JIM-56"],
        what: "a damper pulled by 5 mm in 10 ms: z q'",
        settings: &[r#"networks.sample.links[0].law={ name = "damper", damping = 100 }"#],
        reading: PULL.after(2),
        reference: 50.0,
        source: "EXP-40: Q = z q'",
        mutation: "networks.sample.links[0].law.damping=101",
        ..PLASTIC
    },
    Case {
        id: "rheometer_kelvin_voigt",
        capabilities: &["JIM-49", "JIM-56"],
        what: "a spring beside a damper pulled at 0.5 m/s: k q + z q'",
        settings: &[
            TE,
            r#"networks.sample.links[0].law={ name = "spring_damper", stiffness = 1000, damping = 100 }"#,
            "networks.sample.pins[0].motion={ times = [0, 1], offsets = [[0, 0, 0], [-0.5, 0, 0]] }",
        ],
        reading: PULL.after(100),
        reference: 216.666_666_666_666_67,
        tolerance: Tolerance::Relative(1e-11),
        source: "k 0.5 m/s 100 Te + z 0.5 m/s",
        mutation: "networks.sample.links[0].law.damping=101",
        ..PLASTIC
    },
    Case {
        id: "rheometer_plastic_hardened",
        what: "an elasto-plastic link pulled to 1.03 m",
        reference: 14.0,
        ..PLASTIC
    },
    Case {
        id: "rheometer_plastic_pushed",
        what: "the same unloaded and pushed to yield at 1 m",
        reading: PULL.after(10),
        reference: -11.2,
        ..PLASTIC
    },
    Case {
        id: "rheometer_plastic_pushed_far",
        what: "the same pushed to 0.98 m",
        reading: PULL.after(12),
        reference: -15.2,
        ..PLASTIC
    },
    Case {
        id: "rheometer_plastic_loop",
        capabilities: &["JIM-50", "JIM-18", "JIM-56"],
        what: "the same pulled again to 1.01 m: the loop remembers",
        reading: PULL.after(15),
        reference: 14.16,
        ..PLASTIC
    },
    Case {
        id: "rheometer_plastic_again",
        what: "the same pulled to 1.03 m at last",
        reading: PULL.after(16),
        reference: 18.16,
        ..PLASTIC
    },
    Case {
        id: "rheometer_perfect_plasticity",
        what: "the same without hardening: a plateau at the threshold",
        settings: &["networks.sample.links[0].law.hardening=0"],
        reference: 10.0,
        mutation: "networks.sample.links[0].law.traction=10.1",
        ..PLASTIC
    },
    Case {
        id: "rheometer_asymmetric",
        capabilities: &["JIM-58"],
        what: "the same with a compression threshold of 5 N, pushed to 1 m: f = A S2 + B q",
        settings: &["networks.sample.links[0].law.compression=5"],
        reading: PULL.after(10),
        // -4 - 0.2 x 6 = -5.2 at 1.010 m, whence S = 1.0152 m and S2 = -5.2 mm; then -0.8 x 5.2 - 0.2 x 15.2
        reference: -7.2,
        ..PLASTIC
    },
    Case {
        id: "rheometer_torn",
        capabilities: &["JIM-51"],
        what: "a link that tears at 13.5 N pulls no more at 1.03 m",
        settings: &["networks.sample.links[0].law.rupture=13.5"],
        reference: 0.0,
        mutation: "networks.sample.links[0].law.rupture=30",
        ..PLASTIC
    },
    Case {
        id: "rheometer_torn_pushes",
        capabilities: &["JIM-51"],
        what: "torn at 1.015 m, it still resists compression: -k (1 - 0.99) at 0.99 m",
        settings: &["networks.sample.links[0].law.rupture=13.5"],
        reading: PULL.after(11),
        reference: -10.0,
        mutation: "networks.sample.links[0].law.rupture=30",
        ..PLASTIC
    },
    Case {
        id: "rheometer_maxwell_struck",
        what: "Maxwell's link at the first step of a held elongation of 0.01 m",
        reading: PULL.after(1),
        reference: 9.677_419_354_838_719,
        ..MAXWELL
    },
    Case {
        id: "rheometer_maxwell_next",
        what: "the same a step later",
        reading: PULL.after(2),
        reference: 9.365_244_536_940_695,
        ..MAXWELL
    },
    Case {
        id: "rheometer_maxwell_relaxed",
        what: "the same thirty steps later: it has let go 1/B a step",
        reading: PULL.after(31),
        reference: 3.618_648_398_297_034_3,
        ..MAXWELL
    },
    Case {
        id: "rheometer_maxwell_flown",
        what: "the same sixty steps later",
        reading: PULL.after(61),
        reference: 1.353_110_343_818_093_8,
        ..MAXWELL
    },
    Case {
        id: "rheometer_bingham_10",
        what: "a paste after ten steps of stretching at 0.5 m/s",
        reading: PULL.after(10),
        reference: 16.146_097_381_651_256,
        ..BINGHAM
    },
    Case {
        id: "rheometer_bingham_60",
        what: "the same after sixty",
        reading: PULL.after(60),
        reference: 51.488_888_262_672_79,
        ..BINGHAM
    },
    Case {
        id: "rheometer_bingham_199",
        what: "the same after 199: it flows at nearly Qe + z v = 60 N",
        reading: PULL.after(199),
        reference: 59.910_758_830_055_06,
        ..BINGHAM
    },
    Case {
        id: "rheometer_bingham_held",
        what: "held for 200 steps it keeps nearly its threshold of 10 N",
        reading: PULL.after(399),
        reference: 10.070_811_916_714_876,
        ..BINGHAM
    },
    Case {
        id: "rheometer_bingham_rest_length",
        what: "led back to the rest length that the flow has left, 1.3215958547499518 m, the paste bears nothing",
        settings: &[
            TE,
            PASTE,
            "networks.sample.pins[0].motion={ times = [0, 0.6633333333333333, 1.33, 1.3333333333333333], offsets = [[0, 0, 0], [-0.33166666666666667, 0, 0], [-0.33166666666666667, 0, 0], [-0.3215958547499518, 0, 0]] }",
        ],
        reading: PULL.after(400),
        reference: 0.0,
        // places of a metre, rounding of 399 steps times k
        tolerance: Tolerance::Absolute(1e-10),
        source: "specification §8.1, Bingham: rest length after",
        ..BINGHAM
    },
    Case {
        id: "rheometer_bingham_is_maxwell",
        what: "without a threshold the paste is Maxwell's fluid",
        capabilities: &["JIM-54"],
        settings: &[
            TE,
            r#"networks.sample.links[0].law={ name = "bingham", stiffness = 1000, viscosity = 100, traction = 0, compression = 0 }"#,
            "networks.sample.pins[0].motion={ times = [0, 0.0033333333333333335], offsets = [[0, 0, 0], [-0.01, 0, 0]] }",
        ],
        reading: PULL.after(61),
        reference: 1.353_110_343_818_093_8,
        ..MAXWELL
    },
    Case {
        id: "rheometer_bingham_is_plastic",
        what: "without viscosity the paste is a perfectly plastic link",
        capabilities: &["JIM-54"],
        settings: &[
            r#"networks.sample.links[0].law={ name = "bingham", stiffness = 1000, viscosity = 0, traction = 10, compression = 10 }"#,
        ],
        reference: 10.0,
        tolerance: Tolerance::Absolute(1e-12),
        mutation: "networks.sample.links[0].law.traction=10.1",
        ..PLASTIC
    },
    Case {
        id: "rheometer_burger_30",
        what: "Burger's link half way through a pull",
        reading: PULL.after(30),
        reference: 7.919_819_93,
        ..BURGER
    },
    Case {
        id: "rheometer_burger_60",
        what: "the same at its end",
        reading: PULL.after(60),
        reference: 12.955_157_33,
        ..BURGER
    },
    Case {
        id: "rheometer_burger_120",
        what: "the same held for sixty steps",
        reading: PULL.after(120),
        reference: 8.325_071_88,
        ..BURGER
    },
    Case {
        id: "rheometer_burger_599",
        what: "the same held for long",
        reading: PULL.after(599),
        reference: 1.091_081_5,
        tolerance: Tolerance::Absolute(5e-8),
        ..BURGER
    },
    Case {
        id: "torn_state",
        capabilities: &["JIM-10", "JIM-19"],
        what: "fracture as a finite-state link: torn beyond 1.02 m it pulls no more",
        settings: &[
            r#"networks.sample.links[0].law={ name = "finite_state", states = { whole = "-k * (D - L0)", torn = "0" }, transitions = { "whole -> torn" = "D - L0 > 0.021" }, parameters = { k = 1000 } }"#,
        ],
        reading: PULL.after(16),
        reference: 0.0,
        source: "specification §2.7: fracture",
        mutation: r#"networks.sample.links[0].law.transitions={ "whole -> torn" = "D > 2" }"#,
        ..PLASTIC
    },
    Case {
        id: "glued_state",
        capabilities: &["JIM-10", "JIM-11", "JIM-19"],
        what: "glue: joined below 0.985 m with the length of that moment, k (1.03 - 0.98) at the end",
        settings: &[
            r#"networks.sample.links[0].law={ name = "finite_state", states = { free = "0", glued = "-k * (D - L0)" }, transitions = { "free -> glued" = "D < 0.985" }, entries = { glued = "L0 = D" }, parameters = { k = 1000 } }"#,
        ],
        reading: PULL.after(16),
        reference: 50.0,
        source: "specification §2.7: gluing",
        mutation: r#"networks.sample.links[0].law.entries={ glued = "L0 = 1" }"#,
        ..PLASTIC
    },
    Case {
        id: "plastic_state",
        capabilities: &["JIM-10"],
        what: "step plasticity: past 12.5 mm the rest length jumps to the present one, twice on the way to 1.03 m and back",
        settings: &[
            r#"networks.sample.links[0].law={ name = "finite_state", states = { elastic = "-k * (D - L0)", jumps = "-k * (D - L0)" }, transitions = { "elastic -> jumps" = "D - L0 > 0.0125", "jumps -> elastic" = "D > 0" }, entries = { jumps = "L0 = D" }, parameters = { k = 1000 } }"#,
        ],
        reading: PULL.after(6),
        reference: -5.0,
        source: "specification §2.7: step plasticity; 1.015 m, then 1.03 m, and back to 1.025 m",
        mutation: "networks.sample.links[0].law.parameters.k=1001",
        ..PLASTIC
    },
    Case {
        id: "gripped_state",
        capabilities: &["JIM-10"],
        what: "a grip on command at 55 ms holds the length of that moment",
        settings: &[
            r#"networks.sample.links[0].law={ name = "finite_state", states = { open = "0", closed = "-k * (D - L0)" }, transitions = { "open -> closed" = "t > 0.055" }, entries = { closed = "L0 = D" }, parameters = { k = 1000 } }"#,
        ],
        reading: PULL.after(12),
        reference: -45.0,
        source: "specification §2.7: grip on command, at 1.025 m, then at 0.98 m",
        mutation: r#"networks.sample.links[0].law.transitions={ "open -> closed" = "t > 0.065" }"#,
        ..PLASTIC
    },
    Case {
        id: "last_condition_wins",
        capabilities: &["JIM-10", "JIM-19"],
        what: "of two conditions that hold the one written last leads on",
        settings: &[
            r#"networks.sample.links[0].law={ name = "finite_state", states = { a = "0", b = "-1", c = "-2" }, transitions = { "a -> b" = "D > 1.001", "a -> c" = "D > 1.002 or D < 0.9" } }"#,
        ],
        reading: PULL.after(2),
        reference: 2.0,
        source: "specification §2.7: the last one met wins",
        mutation: r#"networks.sample.links[0].law.transitions={ "a -> c" = "D > 1.002 or D < 0.9", "a -> b" = "D > 1.001" }"#,
        ..PLASTIC
    },
    Case {
        id: "written_law",
        capabilities: &["JIM-15"],
        what: "a cubic spring written as an energy, k (0.03 m)³ at 1.03 m",
        settings: &[
            r#"networks.sample.links[0].law={ name = "formula", energy = "k/4 * (D - L0)^4", parameters = { k = "1e6" } }"#,
        ],
        reading: PULL.after(16),
        reference: 27.0,
        source: "φ = -dE/dD",
        mutation: "networks.sample.links[0].law.parameters.k=1000001",
        ..PLASTIC
    },
    Case {
        id: "creep_kelvin_voigt",
        capabilities: &["JIM-49", "JIM-56", "JIM-99"],
        what: "creep: a spring beside a damper under 10 N, half a second after they are hung on it",
        settings: &[
            TE,
            r#"networks.sample.links[0].law={ name = "spring_damper", stiffness = 1000, damping = 100 }"#,
            "networks.sample.pins=[]",
            r#"networks.sample.loads=[{ region = "lead", force = [-10, 0, 0] }]"#,
        ],
        reading: Reading::component("stretch", 0).after(150),
        reference: -0.009_955_557_160_285_941,
        tolerance: Tolerance::Relative(1e-11),
        source: "V' = V + Te (F - k q - z V)/m, q' = q + Te V' from rest; 10 N/(1000 N/m) in the end",
        mutation: "networks.sample.links[0].law.damping=101",
        ..PLASTIC
    },
    Case {
        id: "creep_maxwell",
        capabilities: &["JIM-52", "JIM-56", "JIM-99"],
        what: "flow: Maxwell's link under 10 N runs at Q/z = 0.1 m/s in the end, here after three seconds",
        settings: &[
            TE,
            r#"networks.sample.links[0].law={ name = "maxwell", stiffness = 1000, viscosity = 100 }"#,
            "networks.sample.pins=[]",
            r#"networks.sample.loads=[{ region = "lead", force = [-10, 0, 0] }]"#,
        ],
        reading: Reading::component("stretch", 0).after(900),
        reference: -0.309_333_333_835_613_07,
        tolerance: Tolerance::Relative(1e-11),
        source: "f' = A (D - D^r) + B f and V' = V + Te (F - f)/m from rest",
        mutation: "networks.sample.links[0].law.viscosity=100.1",
        ..PLASTIC
    },
    Case {
        id: "creep_burger",
        capabilities: &["JIM-53", "JIM-56", "JIM-99"],
        what: "creep: Burger's link under 10 N for a second, at its end: Q/k2 at once, Q/k1 after a delay and Q t/z2 by flow",
        settings: &[TE, BURGER_HUNG, "networks.sample.pins=[]", TEN_NEWTONS_FOR_A_SECOND],
        reading: Reading::component("stretch", 0).after(300),
        reference: -0.035_026_659_665_983_27,
        tolerance: Tolerance::Relative(1e-11),
        source: "EXP-43: the elements of the link each by differences over a step, and V' = V + Te (F - Q)/m from rest",
        mutation: "networks.sample.links[0].law.fluid_viscosity=501",
        ..PLASTIC
    },
    Case {
        id: "burger_recovers",
        capabilities: &["JIM-53", "JIM-56", "JIM-99"],
        what: "the same two seconds after it was let go: what has flowed stays, the impulse over z2",
        settings: &[TE, BURGER_HUNG, "networks.sample.pins=[]", TEN_NEWTONS_FOR_A_SECOND],
        reading: Reading::component("stretch", 0).after(900),
        reference: -0.02,
        // what is left of the delayed part, exp(-2 k1/(z1 (1 + k1/k2))) and less, and rounding
        tolerance: Tolerance::Relative(1e-10),
        source: "EXP-43: recovery of the instantaneous and of the delayed part",
        mutation: "networks.sample.links[0].law.fluid_viscosity=501",
        ..PLASTIC
    },
    Case {
        id: "plastic_table_1",
        what: "an elasto-plastic link pulled to 1.005 m: elastic",
        reading: PULL.after(1),
        reference: 5.0,
        mutation: "networks.sample.links[0].law.stiffness=1001",
        ..PLASTIC
    },
    Case {
        id: "plastic_table_2",
        what: "an elasto-plastic link pulled to 1.010 m: at its limit",
        reading: PULL.after(2),
        reference: 10.0,
        mutation: "networks.sample.links[0].law.stiffness=1001",
        ..PLASTIC
    },
    Case {
        id: "plastic_table_3",
        what: "an elasto-plastic link pulled to 1.015 m",
        reading: PULL.after(3),
        reference: 11.0,
        ..PLASTIC
    },
    Case {
        id: "plastic_table_4",
        what: "an elasto-plastic link pulled to 1.020 m",
        reading: PULL.after(4),
        reference: 12.0,
        ..PLASTIC
    },
    Case {
        id: "plastic_table_in_one_step",
        what: "a plastic link led from its limit at 1.010 m to 1.030 m in one step: what three steps come to",
        settings: &[
            "networks.sample.pins[0].motion={ times = [0, 0.01, 0.02, 0.03], offsets = [[0, 0, 0], [-0.005, 0, 0], [-0.01, 0, 0], [-0.03, 0, 0]] }",
        ],
        reading: PULL.after(3),
        reference: 14.0,
        source: "specification §8.1: refining the steps of a branch does not change its end; 1.010 to 1.030 in one step gives 14",
        ..PLASTIC
    },
    Case {
        id: "plastic_table_6",
        what: "the same unloaded to 1.025 m: parallel to k",
        reading: PULL.after(6),
        reference: 9.0,
        ..PLASTIC
    },
    Case {
        id: "plastic_table_7",
        what: "the same unloaded to 1.020 m: parallel to k",
        reading: PULL.after(7),
        reference: 4.0,
        ..PLASTIC
    },
    Case {
        id: "plastic_table_8",
        what: "the same unloaded to 1.015 m: parallel to k",
        reading: PULL.after(8),
        reference: -1.0,
        ..PLASTIC
    },
    Case {
        id: "plastic_table_9",
        what: "the same unloaded to 1.010 m: parallel to k",
        reading: PULL.after(9),
        reference: -6.0,
        ..PLASTIC
    },
    Case {
        id: "plastic_table_11",
        what: "the same pushed to 0.990 m",
        reading: PULL.after(11),
        reference: -13.2,
        ..PLASTIC
    },
    Case {
        id: "plastic_table_13",
        what: "the same let go to 0.990 m",
        reading: PULL.after(13),
        reference: -5.2,
        ..PLASTIC
    },
    Case {
        id: "plastic_table_14",
        what: "the same let go to 1.000 m",
        reading: PULL.after(14),
        reference: 4.8,
        ..PLASTIC
    },
    Case {
        id: "bingham_holds_below",
        capabilities: &["JIM-54", "JIM-56"],
        what: "elongation of a paste under a force that rises to 0.98 of its threshold within a second and stays: that of its spring",
        settings: &[
            TE,
            PASTE,
            LED_BY_FORCE,
            r#"networks.sample.loads=[{ region = "lead", force = ["-9.8 * min(t, 1)^2 * (3 - 2 * min(t, 1))", 0, 0] }]"#,
        ],
        reading: Reading::component("stretch", 0).after(600),
        reference: -0.009_909_710_187_463_004,
        // places of a metre, after six hundred steps
        tolerance: Tolerance::Relative(1e-11),
        source: "EXP-44: solid below Qe; V' = V + Te (F - k q)/m from rest, nothing of which flows",
        mutation: "networks.sample.links[0].law.stiffness=1001",
        ..PLASTIC
    },
    Case {
        id: "bingham_gives_no_heat_below",
        capabilities: &["JIM-54", "JIM-56"],
        what: "heat of the same: none",
        settings: &[
            TE,
            PASTE,
            LED_BY_FORCE,
            r#"networks.sample.loads=[{ region = "lead", force = ["-9.8 * min(t, 1)^2 * (3 - 2 * min(t, 1))", 0, 0] }]"#,
        ],
        reading: Reading::last("heat").after(600),
        reference: 0.0,
        tolerance: Tolerance::Absolute(0.0),
        source: "EXP-44: solid below Qe",
        mutation: "networks.sample.links[0].law.traction=9.9",
        ..PLASTIC
    },
    Case {
        id: "bingham_flows_above",
        capabilities: &["JIM-54", "JIM-56"],
        what: "elongation of the same under a force that rises to 15 N: it flows at (Q - Qe)/z = 0.05 m/s, here after three seconds",
        settings: &[
            TE,
            PASTE,
            LED_BY_FORCE,
            r#"networks.sample.loads=[{ region = "lead", force = ["-15 * min(t, 1)^2 * (3 - 2 * min(t, 1))", 0, 0] }]"#,
        ],
        reading: Reading::component("stretch", 0).after(900),
        reference: -0.127_122_867_605_068_9,
        tolerance: Tolerance::Relative(1e-11),
        source: "EXP-44: stress ramp; f = (z k q + k Te Qe)/(k Te + z) beyond the threshold and V' = V + Te (F - f)/m from rest",
        mutation: "networks.sample.links[0].law.viscosity=100.1",
        ..PLASTIC
    },
    Case {
        id: "grip_holds",
        capabilities: &["JIM-10"],
        what: "a grip told to close at 55 ms holds the length of that moment, 1.025 m, at 1 m",
        settings: &[GRIP],
        reading: PULL.after(10),
        reference: -25.0,
        source: "specification §2.7: grip on command, 1 --CDX--> 2",
        mutation: "networks.sample.links[0].law.parameters.k=1001",
        ..PLASTIC
    },
    Case {
        id: "grip_opens_again",
        capabilities: &["JIM-10"],
        what: "the same told to open at 105 ms lets go",
        settings: &[GRIP],
        reading: PULL.after(13),
        reference: 0.0,
        tolerance: Tolerance::Absolute(0.0),
        source: "specification §2.7: grip on command, 2 --CDX--> 1",
        mutation: r#"networks.sample.links[0].law.transitions={ "open -> closed" = "t > 0.055 and t < 0.105" }"#,
        ..PLASTIC
    },
    Case {
        id: "burger_fine_30",
        what: "Burger's link after 30 of three hundred steps a second, each in a hundred",
        settings: &[
            FINE,
            r#"networks.sample.links[0].law={ name = "burger", solid_stiffness = 1000, solid_viscosity = 50, fluid_stiffness = 2000, fluid_viscosity = 500 }"#,
            "networks.sample.pins[0].motion={ times = [0, 0.2], offsets = [[0, 0, 0], [-0.02, 0, 0]] }",
        ],
        reading: PULL.after(3000),
        reference: 7.934_315_25,
        source: "specification §8.1, Burger with Te/100",
        ..BURGER
    },
    Case {
        id: "burger_fine_60",
        what: "Burger's link after 60 of three hundred steps a second, each in a hundred",
        settings: &[
            FINE,
            r#"networks.sample.links[0].law={ name = "burger", solid_stiffness = 1000, solid_viscosity = 50, fluid_stiffness = 2000, fluid_viscosity = 500 }"#,
            "networks.sample.pins[0].motion={ times = [0, 0.2], offsets = [[0, 0, 0], [-0.02, 0, 0]] }",
        ],
        reading: PULL.after(6000),
        reference: 12.974_998_23,
        source: "specification §8.1, Burger with Te/100",
        ..BURGER
    },
    Case {
        id: "burger_fine_120",
        what: "Burger's link after 120 of three hundred steps a second, each in a hundred",
        settings: &[
            FINE,
            r#"networks.sample.links[0].law={ name = "burger", solid_stiffness = 1000, solid_viscosity = 50, fluid_stiffness = 2000, fluid_viscosity = 500 }"#,
            "networks.sample.pins[0].motion={ times = [0, 0.2], offsets = [[0, 0, 0], [-0.02, 0, 0]] }",
        ],
        reading: PULL.after(12000),
        reference: 8.335_960_51,
        source: "specification §8.1, Burger with Te/100",
        ..BURGER
    },
    Case {
        id: "burger_fine_599",
        what: "Burger's link after 599 of three hundred steps a second, each in a hundred",
        settings: &[
            FINE,
            r#"networks.sample.links[0].law={ name = "burger", solid_stiffness = 1000, solid_viscosity = 50, fluid_stiffness = 2000, fluid_viscosity = 500 }"#,
            "networks.sample.pins[0].motion={ times = [0, 0.2], offsets = [[0, 0, 0], [-0.02, 0, 0]] }",
        ],
        reading: PULL.after(59900),
        reference: 1.087_852_15,
        source: "specification §8.1, Burger with Te/100",
        ..BURGER
    },
];
