//! How fast the clamped bar's tip and energy converge on the four elements: as the square of the cells' size.
//!
//! The error of a quantity of the energy's kind is `A h²` where the solution is smooth. Two things keep the measured order below
//! 2, and make the tolerances:
//!
//! - Elements of degree one lock in bending: the bar is too stiff by `x = c h²`, and the error is `x / (1 + x)` of the
//!   tip. From a mesh to the next finer by half that costs `log₂ (1 + x_coarse) / (1 + x_fine)`: 0.04 for hexahedra, 0.07 for
//!   prisms and pyramids (n = 4 and 8, `x` = 0.04 to 0.065 and a quarter of it), 0.12 for tetrahedra (n = 6 and 12, `x` = 0.12 and
//!   0.03). On coarser meshes tetrahedra are in the midst of locking (`x` = 0.45 at n = 3) and seem of order 1.5.
//! - Stress is singular along the clamped edge, as `r^-0.29` for a Poisson's ratio of 0.3 (Williams 1952), which adds an error
//!   `B h^1.42`. It is what elements of degree two are left with: 1.6e-4 m of the tip where they have as many unknowns as the
//!   finest mesh here, out of 1.5e-3 m to 4.5e-3 m. Were it three times as large for degree one, it would be 0.3 of the error
//!   and would cost 0.3 × 0.58 = 0.17.
//!
//! The limit is known to 9e-5 m, which moves the order by 0.03 at most.

use super::bar::{DEFAULT_RULE, HEX8, LINEAR, N2, N3, N4, N6, N8, N12, PRISM6, PYRAMID5, TET4};
use crate::{Case, Limit, Reading, Refinement, Tolerance, Variant};

const TIP_LIMIT: Limit = Limit::Known(-0.14736822752238712);
const ENERGY_LIMIT: Limit = Limit::Known(2.904964026856334);

const HALVED_TO_8: Refinement = Refinement {
    size_of: "cell [m]",
    runs: &[
        Variant { size: 0.05, settings: &[N2] },
        Variant { size: 0.025, settings: &[N4] },
        Variant { size: 0.0125, settings: &[N8] },
    ],
    limit: TIP_LIMIT,
};

const HALVED_TO_12: Refinement = Refinement {
    runs: &[
        Variant { size: 0.1 / 3.0, settings: &[N3] },
        Variant { size: 0.1 / 6.0, settings: &[N6] },
        Variant { size: 0.1 / 12.0, settings: &[N12] },
    ],
    ..HALVED_TO_8
};

const BAR: Case = Case {
    id: "",
    capabilities: &["FAU-73", "FAU-7"],
    what: "",
    scene: "cantilever",
    settings: &[],
    reading: Reading::component("tip", 1),
    refinement: Some(HALVED_TO_8),
    reference: 2.0,
    tolerance: Tolerance::Absolute(0.27),
    source: "Strang & Fix 1973, §3.4; limit of quadratic hexahedra by FEniCSx",
    // the tip of another bar: what is left of the error does not fall at all
    mutation: r#"bodies.bar.material.youngs_modulus="10.1 MPa""#,
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "order_hex8_tip",
        what: "order of the tip's error, hex8, linear",
        settings: &[HEX8, LINEAR, DEFAULT_RULE],
        tolerance: Tolerance::Absolute(0.24),
        ..BAR
    },
    Case {
        id: "order_hex8_energy",
        what: "order of the energy's error, hex8, linear",
        settings: &[HEX8, LINEAR, DEFAULT_RULE],
        reading: Reading::last("energy"),
        refinement: Some(Refinement { limit: ENERGY_LIMIT, ..HALVED_TO_8 }),
        tolerance: Tolerance::Absolute(0.24),
        ..BAR
    },
    Case {
        id: "order_prism6_tip",
        what: "order of the tip's error, prism6, linear",
        settings: &[PRISM6, LINEAR, DEFAULT_RULE],
        ..BAR
    },
    Case {
        id: "order_pyramid5_tip",
        what: "order of the tip's error, pyramid5, linear",
        settings: &[PYRAMID5, LINEAR, DEFAULT_RULE],
        ..BAR
    },
    Case {
        id: "order_tet4_tip",
        what: "order of the tip's error, tet4, linear; locking leaves it 3 % too stiff at n = 12",
        settings: &[TET4, LINEAR],
        refinement: Some(HALVED_TO_12),
        tolerance: Tolerance::Absolute(0.32),
        ..BAR
    },
];
