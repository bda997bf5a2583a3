//! Points of view: one oscillation, whoever looks at it (EXP-58).

use super::network::OSCILLATOR;
use crate::{Case, Reading, Tolerance};

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
];
