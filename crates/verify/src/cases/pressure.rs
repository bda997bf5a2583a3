//! The work of pressure is `p ΔV`.
//!
//! A block in a mould is drawn out by a sudden pressure on its free face. It turns where all work is stored: `W(s) V = p (s - 1) V` at the
//! stretch `s`, with `W(s) = μ/2 (s² - 1) - μ ln s + λ/2 ln² s` of `neo_hookean`, `E = 10 kPa`, `ν = 0.3`, `p = 2 kPa`, `V = 1 dm³`.

use crate::reading::Statistic;
use crate::{Case, Reading, Tolerance};

const TURN: Case = Case {
    id: "pressure_work_volume",
    capabilities: &["FAU-45"],
    what: "largest volume of a block that a sudden pressure draws out: its energy there is the work p dV",
    scene: "pumped_block",
    settings: &[],
    reading: Reading::last("volume").taking(Statistic::Max),
    refinement: None,
    // the root of W(s) = p (s - 1), by bisection
    reference: 1.357_676_864_780_241e-3,
    // average acceleration by 0.5 ms of a period of 0.12 s: (ω h)²/12 of the way it took, and as much where the turn falls between
    // two steps
    tolerance: Tolerance::Relative(2e-4),
    source: "conservation of energy; the work of a pressure is p dV",
    mutation: "bodies.block.loads[0].pressure=-2010",
};

pub(super) const CASES: &[Case] = &[
    TURN,
    Case {
        id: "pressure_work_energy",
        what: "the energy stored there: pressure times the change of volume",
        reading: Reading::last("stored").taking(Statistic::Max),
        // 2 kPa x 0.357676864780241 dm³
        reference: 0.715_353_729_560_482,
        tolerance: Tolerance::Relative(5e-4),
        ..TURN
    },
];
