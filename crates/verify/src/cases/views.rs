//! Points of view: one oscillation, whoever looks at it (EXP-58).

use super::network::OSCILLATOR;
use crate::{Case, Reading, Statistic, Tolerance};

/// After 60 steps at `κ = 0.04` from 0.1 m out: that of `network_oscillator_undamped` [m].
const MOVED: f64 = -0.009_332_407_371_664_991;

const SCALED: Case = Case {
    id: "views_scale",
    capabilities: &["JIM-14"],
    what: "displacement of a mass that its spring sees ten times as large, and is a hundredth as stiff for that, after 60 steps",
    scene: "network_views",
    reading: Reading::last("large").after(60),
    reference: MOVED,
    // rounding of sixty steps on lengths of a metre, over what has been moved
    tolerance: Tolerance::Relative(1e-11),
    source: "EXP-58: forces come back by the transposed derivative, so that k = s² k'; then network_oscillator",
    mutation: "networks.large.views.bob_seen.factor=10.01",
    ..OSCILLATOR
};

macro_rules! ten {
    ($pair:literal) => {
        concat!(
            $pair, ", ", $pair, ", ", $pair, ", ", $pair, ", ", $pair, ", ", $pair, ", ", $pair, ", ", $pair,
            ", ", $pair, ", ", $pair
        )
    };
}

/// Two weights, fifty times.
macro_rules! fifty {
    ($pair:literal) => {
        concat!(ten!($pair), ", ", ten!($pair), ", ", ten!($pair), ", ", ten!($pair), ", ", ten!($pair))
    };
}

/// Masses of a ring that count thrice and once by turns: as a mass of 10 g/Σ w² = 0.8 kg.
const WEIGHTED: &str = concat!("networks.many.views.middle.weights=[", fifty!("0.015, 0.005"), "]");

pub(super) const CASES: &[Case] = &[
    SCALED,
    Case {
        id: "views_mean",
        what: "the same of a hundred masses on a ring whose mean a spring sees",
        reading: Reading::last("many").after(60),
        source: "EXP-58: each bears a hundredth of the force, as one mass of their sum would bear the whole",
        mutation: "networks.many.masses.ring.mass=0.0101",
        ..SCALED
    },
    Case {
        id: "views_cylinder",
        what: "the same of a mass that is pulled along the radius alone, by its share across",
        reading: Reading::last("round").after(60),
        // at 30 degrees
        reference: 0.5 * MOVED,
        source: "EXP-58: ∂r/∂x is the direction of the radius",
        mutation: "networks.round.views.bob_seen.origin=[0, -2.01, 0]",
        ..SCALED
    },
    Case {
        id: "views_frame",
        what: "the same of a mass seen from a carriage that drives and gives way, turned by a right angle",
        reading: Reading::last("carried").after(60),
        // the carriage of three times the mass takes a quarter
        reference: 0.75 * MOVED,
        source: "EXP-58: a frame that masses carry bears the opposite force; two masses swing as the reduced one",
        mutation: "networks.carried.masses.carriage.mass=3.01",
        ..SCALED
    },
    Case {
        id: "views_weighted_mean",
        what: "the same of a hundred masses of which every second counts thrice: what a spring sees is a mass of 10 g/Σ w², and they go by their own share, in the mean 0.8 of it",
        settings: &[WEIGHTED, "networks.many.links[0].law.stiffness=3.2"],
        reading: Reading::last("many").after(60),
        // Σ w/100 over Σ w²
        reference: 0.8 * MOVED,
        source: "EXP-58: distribution over 100 points, F_i = w_i F",
        mutation: concat!("networks.many.views.middle.weights=[", fifty!("0.0151, 0.0049"), "]"),
        ..SCALED
    },
    Case {
        id: "views_keep_energy",
        what: "energy of all four, one with unequal weights, after 98 steps over that after two, where each turns by 60° a step: what their springs do is what is done to their masses",
        settings: &[
            WEIGHTED,
            "networks.many.links[0].law.stiffness=80",
            "networks.large.links[0].law.stiffness=1",
            "networks.round.links[0].law.stiffness=100",
            "networks.carried.links[0].law.stiffness=75",
        ],
        reading: Reading::last("energy").taking(Statistic::LastOver(2)).after(98),
        reference: 1.0,
        tolerance: Tolerance::Absolute(1e-12),
        source: "EXP-58: work conserved to 1e-12",
        // a nanonewton second per metre
        mutation: r#"networks.large.links[0].law={ name = "spring_damper", stiffness = 1, damping = 1e-9 }"#,
        ..SCALED
    },
];
