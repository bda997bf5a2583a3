//! Solids whose rest shape gives way: creep, yielding, fracture (PA-17 of the survey).

use crate::reading::Statistic;
use crate::{Case, Limit, Reading, Refinement, Tolerance, Variant};

const CLAY: Case = Case {
    id: "",
    capabilities: &["JIM-97", "DEB-55"],
    what: "",
    scene: "clay_bar",
    settings: &[],
    reading: Reading::last("von_mises"),
    refinement: None,
    reference: 10e3,
    // found by halving to the last place, at every sample
    tolerance: Tolerance::Relative(1e-9),
    source: "von Mises: no more than the threshold at the end of a step",
    mutation: r#"bodies.bar.inelasticity.yielding.stress="10.1 kPa""#,
};

/// `E A ε exp(-2 (1 + ν) t / 3 z)` [N].
const RELAXED: f64 = 10.0 * 0.420_350_384_508_681_9;

pub(super) const CASES: &[Case] = &[
    Case {
        id: "clay_yields_at_its_threshold",
        what: "equivalent stress of a bar that is drawn out by a tenth",
        settings: &["run.duration=1"],
        ..CLAY
    },
    Case {
        id: "clay_keeps_its_stretch",
        what: "pull of a bar of clay that was let back by its elastic strain alone",
        reading: Reading::component("pull", 0),
        reference: 0.0,
        // of 92 N: the last step strained it by 5 % of the threshold, a third of which is pressure that no lateral pull holds; and strain of
        // a hundredth, squared, is a hundredth of it
        tolerance: Tolerance::Absolute(3.0),
        source: "0.44 m exp(-σ/E) is the length without force",
        mutation: r#"bodies.bar.inelasticity.yielding.stress="12 kPa""#,
        ..CLAY
    },
    Case {
        id: "pitch_relaxes_as_maxwell_order",
        capabilities: &["JIM-97"],
        what: "order of the error of the pull of pitch that is held, by its steps",
        scene: "pitch_bar",
        reading: Reading::component("pull", 0),
        refinement: Some(Refinement {
            size_of: "period [s]",
            runs: &[
                Variant { size: 0.1, settings: &[r#"world.period="100 ms""#] },
                Variant { size: 0.05, settings: &[r#"world.period="50 ms""#] },
            ],
            limit: Limit::Known(RELAXED),
        }),
        reference: 1.0,
        // the next power of 0.87 h is a tenth of the first, and moves it by log₂ (1 + 0.1) / (1 + 0.05); a strain of 1e-3 is 1e-3 of nonlinearity
        tolerance: Tolerance::Absolute(0.2),
        source: "Maxwell: σ̇ = -2 (1 + ν) σ / 3 z where only strain of shape creeps",
        mutation: r#"parameters.time="1.2 s""#,
        ..CLAY
    },
    Case {
        id: "bar_tears_at_its_weakest",
        capabilities: &["JIM-97"],
        what: "greatest pull of a bar whose cells bear more or less",
        scene: "torn_bar",
        reading: Reading::component("pull", 0).taking(Statistic::Max),
        // 20 kPa, 0.01 m² and the least of 1 + 0.2 (2 u - 1) over the six cells, u by SplitMix64 of the seed
        reference: 200.0 * 0.806_715_317_811_262_5,
        // a step strains by 1e-4: 1 N; inertia of a bar that is drawn at 6 mm/s, ρ c v A = 1.9 N at first, has had three seconds of damping
        tolerance: Tolerance::Relative(0.01),
        source: "the limit of the weakest cell times the area, which Poisson's ratio of zero keeps",
        mutation: "parameters.scatter=0.1",
        ..CLAY
    },
    Case {
        id: "torn_bar_pulls_no_more",
        capabilities: &["JIM-97"],
        what: "pull of a bar that has torn",
        scene: "torn_bar",
        reading: Reading::component("pull", 0),
        // the weakest cell is the second of six: half of it and four more, each of a kilogram, are drawn on at 6 mm/s against damping of 20/s
        reference: 20.0 * 4.5 * 0.006,
        // 161 N before; what is left swings out by exp(-10 t), for more than a second: 161 N exp(-13) and less by implicit steps
        tolerance: Tolerance::Absolute(1e-3),
        source: "no stiffness is pulled: what its motion takes",
        mutation: r#"bodies.bar.inelasticity.fracture.stress="200 kPa""#,
        ..CLAY
    },
];
