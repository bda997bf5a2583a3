//! What tools leave on the surface of an organ: how fast it whitens and fills again, and the heat that burns it.

use crate::reading::Statistic;
use crate::{Case, Reading, Tolerance};

const MARKED: Case = Case {
    id: "",
    capabilities: &["DEB-52"],
    what: "",
    scene: "marked_organ",
    settings: &[],
    reading: Reading::last("whitest"),
    refinement: None,
    reference: 0.0,
    // sums of some hundred steps, each exact
    tolerance: Tolerance::Relative(1e-12),
    source: "whitening and burns of the source's organ (5 §5.1) are told in words; the kinetics are ours, dw/dt = (w∞ - w)/τ and dD/dt = q, and exact for steps of any length",
    mutation: "bodies.liver.marks.refill_time=0.6",
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "marks_whiten",
        what: "whiteness of the whitest point under a tool that presses from the start on by more than empties the vessels, after 0.2 s of a whitening time of 0.1 s",
        settings: &[
            r#"shapes.blunt.motion={ times = [0, 9], offsets = [[0, 0, -0.04], [0, 0, -0.04]], interpolation = "linear" }"#,
            "bodies.liver.marks.whitening_pressure=1e-3",
        ],
        reading: Reading::last("whitest").after(40),
        // 1 - exp(-2)
        reference: 0.864_664_716_763_387_3,
        mutation: "bodies.liver.marks.whitening_time=0.11",
        ..MARKED
    },
    Case {
        id: "marks_refill",
        what: "whiteness 0.4 s after, over that of when both tools have gone: blood comes back in 0.5 s, whatever was pressed",
        reading: Reading::last("whitest").taking(Statistic::LastOver(220)).after(300),
        // exp(-0.8)
        reference: 0.449_328_964_117_221_6,
        ..MARKED
    },
    Case {
        id: "marks_burn",
        what: "heat per area that the hottest point takes up in 0.2 s under a tool of 120 kW/m² that is held on it",
        reading: Reading::last("burnt").taking(Statistic::LateSpan(110)).after(150),
        reference: 24_000.0,
        mutation: r#"contacts[1].heat="119 kW/m^2""#,
        ..MARKED
    },
    Case {
        id: "marks_stay",
        what: "the same point's heat at the end over that of when the tool has left it: nothing heals",
        reading: Reading::last("burnt").taking(Statistic::LastOver(180)).after(300),
        reference: 1.0,
        // which touches it longer
        mutation: "shapes.hot.motion.times=[0, 0.1, 0.4, 1, 1.2]",
        ..MARKED
    },
];
