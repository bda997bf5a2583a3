//! Links made of a network of springs, dampers and sliders: equal to the laws that were derived by hand, and to the
//! continuous solution as steps get finer.

use super::network::OSCILLATOR;
use crate::refinement::{Limit, Refinement, Variant};
use crate::{Case, Reading, Tolerance};

const PULL: Reading = Reading::component("pull", 0);

/// 300 steps a second.
const TE: &str = "world.period=0.0033333333333333335";

const COMPILED: Case = Case {
    capabilities: &["JIM-55"],
    scene: "rheometer",
    reading: PULL,
    tolerance: Tolerance::Relative(1e-11),
    ..OSCILLATOR
};

/// A tree of springs and dampers that chance made, pulled by 20 mm in 100 ms and held: by its own recursion, and by its own exponentials
/// as steps get finer.
macro_rules! tree_of_chance {
    ($number:literal, $network:literal, $other:literal: $recursion:literal, $continuous:literal) => {
        [
            Case {
                id: concat!("tree_of_chance_", $number),
                what: concat!("a tree of springs and dampers that chance made, pulled by 20 mm in 100 ms and held for 60: ", $network),
                settings: &[
                    r#"world.period="1 ms""#,
                    concat!(r#"networks.sample.links[0].law={ name = "rheological", network = ""#, $network, r#"" }"#),
                    PULLED_AND_HELD,
                ],
                reading: PULL.after(160),
                reference: $recursion,
                source: "EXP-45: spring k, damper (z/Te)(1 - T⁻¹), sums beside and in series of fractions of polynomials, and their recursion in fifty digits",
                mutation: concat!(r#"networks.sample.links[0].law.network=""#, $other, r#"""#),
                ..COMPILED
            },
            Case {
                id: concat!("tree_of_chance_order_", $number),
                what: concat!("order at which the same tends to the sum of its exponentials: ", $network),
                settings: &[
                    concat!(r#"networks.sample.links[0].law={ name = "rheological", network = ""#, $network, r#"" }"#),
                    PULLED_AND_HELD,
                ],
                refinement: Some(Refinement {
                    size_of: "step [s]",
                    runs: &[
                        Variant { size: 4e-4, settings: &[r#"world.period="0.4 ms""#] },
                        Variant { size: 2e-4, settings: &[r#"world.period="0.2 ms""#] },
                        Variant { size: 1e-4, settings: &[r#"world.period="0.1 ms""#] },
                    ],
                    limit: Limit::Known($continuous),
                }),
                reference: 1.0,
                // the next term: a step is a hundredth of the shortest relaxation
                tolerance: Tolerance::Absolute(0.01),
                source: "EXP-45: equal to the fine-step solution, error in proportion to Te; poles and residues of the tree in fifty digits",
                mutation: concat!(r#"networks.sample.links[0].law.network=""#, $other, r#"""#),
                ..COMPILED
            },
        ]
    };
}

const PULLED_AND_HELD: &str =
    "networks.sample.pins[0].motion={ times = [0, 0.1], offsets = [[0, 0, 0], [-0.02, 0, 0]] }";

pub(super) const TREES: &[[Case; 2]] = &[
    tree_of_chance!(1,
        "((damper(70) | (damper(110) - (spring(300) - spring(1600)))) - damper(90)) - spring(1400)",
        "((damper(71) | (damper(110) - (spring(300) - spring(1600)))) - damper(90)) - spring(1400)":
        1.974_075_050_480_704_3, 1.946_825_141_416_102),
    tree_of_chance!(2,
        "(damper(30) - spring(1100)) | ((damper(60) - spring(200)) - damper(50))",
        "(damper(30) - spring(1100)) | ((damper(61) - spring(200)) - damper(50))":
        2.496_696_652_795_409_3, 2.473_474_143_641_031),
    tree_of_chance!(3,
        "(damper(40) | ((damper(110) - spring(1100)) | spring(800))) - spring(400)",
        "(damper(40) | ((damper(110) - spring(1100)) | spring(801))) - spring(400)":
        6.235_387_058_782_856, 6.235_931_898_460_937),
    tree_of_chance!(4,
        "(spring(1100) - damper(50)) - (((spring(1800) | damper(70)) | spring(1800)) | (spring(300) | (spring(500) - damper(110))))",
        "(spring(1100) - damper(51)) - (((spring(1800) | damper(70)) | spring(1800)) | (spring(300) | (spring(500) - damper(110))))":
        2.759_626_615_319_751, 2.744_929_941_817_061),
];

pub(super) const CASES: &[Case] = &[
    Case {
        id: "rheological_maxwell",
        what: "a spring and a damper in series, sixty steps after a step of elongation: Maxwell's fluid",
        settings: &[
            TE,
            r#"networks.sample.links[0].law={ name = "rheological", network = "spring(1 kN/m) - damper(100 N s/m)" }"#,
            "networks.sample.pins[0].motion={ times = [0, 0.0033333333333333335], offsets = [[0, 0, 0], [-0.01, 0, 0]] }",
        ],
        reading: PULL.after(61),
        reference: 1.353_110_343_818_093_8,
        source: "specification §8.1, Maxwell",
        mutation: r#"networks.sample.links[0].law.network="spring(1000) - damper(101)""#,
        ..COMPILED
    },
    Case {
        id: "rheological_bingham",
        what: "a spring in series with a slider beside a damper, stretched and held: Bingham's paste",
        settings: &[
            TE,
            r#"networks.sample.links[0].law={ name = "rheological", network = "spring(k) - (slider(10) | damper(z))", parameters = { k = "1000", z = "100" } }"#,
            "networks.sample.pins[0].motion={ times = [0, 0.6633333333333333], offsets = [[0, 0, 0], [-0.33166666666666667, 0, 0]] }",
        ],
        reading: PULL.after(399),
        reference: 10.070_811_916_714_876,
        source: "specification §8.1, Bingham",
        mutation: r#"networks.sample.links[0].law.parameters.z="101""#,
        ..COMPILED
    },
    Case {
        id: "rheological_burger",
        what: "Kelvin–Voigt's and Maxwell's links in series: Burger's material",
        settings: &[
            TE,
            r#"networks.sample.links[0].law={ name = "rheological", network = "(spring(1000) | damper(50)) - spring(2000) - damper(500)" }"#,
            "networks.sample.pins[0].motion={ times = [0, 0.2], offsets = [[0, 0, 0], [-0.02, 0, 0]] }",
        ],
        reading: PULL.after(120),
        reference: 8.325_071_88,
        // as many digits as are printed
        tolerance: Tolerance::Absolute(5e-9),
        source: "specification §8.1, Burger",
        mutation: r#"networks.sample.links[0].law.network="(spring(1000) | damper(51)) - spring(2000) - damper(500)""#,
        ..COMPILED
    },
    Case {
        id: "rheological_plastic",
        what: "a spring in series with a slider beside a spring, pulled to 1.03 m and let go to 1 m: its threshold in \
               compression has moved along with the one in traction",
        settings: &[
            r#"networks.sample.links[0].law={ name = "rheological", network = "spring(1000) - (slider(10) | spring(250))" }"#,
        ],
        reading: PULL.after(10),
        // 14 N at 30 mm; elastic over 20 N to -6 N at 10 mm; then 1000·250/1250 = 200 N/m over 10 mm
        reference: -8.0,
        tolerance: Tolerance::Absolute(1e-9),
        source: "specification §2.15.2: what the assembly of slider and spring really does",
        mutation: r#"networks.sample.links[0].law.network="spring(1000) - (slider(10) | spring(251))""#,
        ..COMPILED
    },
    Case {
        id: "rheological_order",
        what: "order of a network of three springs and two dampers",
        settings: &[
            r#"networks.sample.links[0].law={ name = "rheological", network = "spring(300) | (spring(1000) - damper(30) - (spring(800) | damper(20)))" }"#,
            "networks.sample.pins[0].motion={ times = [0, 0.1], offsets = [[0, 0, 0], [-0.02, 0, 0]] }",
        ],
        refinement: Some(Refinement {
            size_of: "step [s]",
            runs: &[
                Variant { size: 4e-4, settings: &[r#"world.period="0.4 ms""#] },
                Variant { size: 2e-4, settings: &[r#"world.period="0.2 ms""#] },
                Variant { size: 1e-4, settings: &[r#"world.period="0.1 ms""#] },
            ],
            limit: Limit::Known(7.604_589_327_42),
        }),
        reference: 1.0,
        // the next term: a step is a hundredth of the shortest relaxation, 20/1800 s
        tolerance: Tolerance::Absolute(0.01),
        source: "differences over a step are of first order; the limit by differences at 1 µs, extrapolated twice",
        mutation: r#"networks.sample.links[0].law.network="spring(300) | (spring(1000) - damper(30) - (spring(800) | damper(21)))""#,
        ..COMPILED
    },
];
