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
