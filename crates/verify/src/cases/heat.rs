//! Fusible matter: heat along a chain of masses, bonds that soften, melt and set.

use super::network::OSCILLATOR;
use crate::{Case, Reading, Tolerance};

const BOND: Case = Case {
    capabilities: &["JIM-97"],
    scene: "heat",
    reading: Reading::component("pull", 0),
    // the temperature is a sum of some hundred steps
    tolerance: Tolerance::Absolute(1e-9),
    source: "specification §6.3, PA-THERM: stiffness linear in the mean temperature of the ends, none above melting",
    mutation: "networks.pair.crowds[0].fusible.stiffness=101",
    ..OSCILLATOR
};

const WAX: Case = Case {
    capabilities: &["JIM-97"],
    scene: "wax",
    reading: Reading::last("bonds"),
    source: "edges above melting are removed (specification §6.3, PA-THERM); that bonds come back below it, between what is near, is the project's own: physical consistency",
    ..OSCILLATOR
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "heat_decays",
        capabilities: &["JIM-97"],
        what: "temperature at the warm end of a rod after 400 steps, in which a mode of the chain has decayed",
        scene: "heat",
        reading: Reading::last("warm_end").after(400),
        reference: 310.782_798_454_781_4,
        tolerance: Tolerance::Relative(1e-13),
        source: "specification §6.3, PA-THERM: θ' = θ + Te/c Σ g (θ_j − θ); half a wave over 40 masses decays by 1 − 4 (g Te/c) sin²(π/80)",
        mutation: "networks.rod.crowds[0].fusible.conductance=51",
        ..OSCILLATOR
    },
    Case {
        id: "heat_is_kept",
        capabilities: &["JIM-97"],
        what: "mean temperature of the same rod, which gives no heat away",
        scene: "heat",
        reading: Reading::last("rod").after(400),
        reference: 300.0,
        tolerance: Tolerance::Relative(1e-13),
        source: "what flows out of one mass flows into the other",
        mutation: r#"networks.rod.crowds[0].fusible.heating="1e-6""#,
        ..OSCILLATOR
    },
    Case {
        id: "bond_is_whole",
        what: "pull of a bond drawn by 5 cm, at 309 K, below where it softens",
        reading: Reading::component("pull", 0).after(30),
        reference: 5.0,
        ..BOND
    },
    Case {
        id: "bond_is_half",
        what: "the same at 330 K, halfway from softening to melting",
        reading: Reading::component("pull", 0).after(100),
        reference: 2.5,
        mutation: "networks.pair.crowds[0].fusible.softening=305",
        ..BOND
    },
    Case {
        id: "bond_melts",
        what: "bonds of the pair at 354 K, above where it melts",
        reading: Reading::last("bonds").after(180),
        reference: 0.0,
        mutation: "networks.pair.crowds[0].fusible.melting=360",
        ..BOND
    },
    Case {
        id: "bond_sets",
        what: "pull of the pair when it is cold again where it was: it has set at the length that it has",
        reading: Reading::component("pull", 0).after(390),
        reference: 0.0,
        mutation: "networks.pair.crowds[0].fusible.melting=370",
        ..BOND
    },
    Case { id: "bond_holds_again", what: "the same when it is drawn by 3 cm more", reference: 3.0, ..BOND },
    Case {
        id: "wax_is_molten",
        what: "bonds of a block of wax that has been on a hot plate for six seconds",
        reading: Reading::last("bonds").after(600),
        reference: 0.0,
        tolerance: Tolerance::Absolute(0.0),
        mutation: "networks.wax.crowds[0].fusible.melting=480",
        ..WAX
    },
    Case {
        id: "wax_sets",
        what: "bonds of the same wax when it is cold: at least the 143 that one piece of its 144 balls needs",
        reference: 143.0,
        tolerance: Tolerance::AtLeast,
        mutation: r#"networks.wax.crowds[0].fusible.ambient="420""#,
        ..WAX
    },
    Case {
        id: "wax_is_one_piece",
        what: "parts that it is in then",
        reading: Reading::last("parts"),
        reference: 1.0,
        tolerance: Tolerance::Absolute(0.0),
        mutation: r#"networks.wax.crowds[0].law={ name = "ball", threshold = 0.02, stiffness = 300, damping = 0.02 }"#,
        ..WAX
    },
];
