//! What tools leave on the surface of an organ: how fast it whitens and fills again, the heat that burns it, and its blood.

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

const BLEEDING: Case = Case {
    scene: "bleeding_organ",
    source: "the source's organ bleeds in pictures (5 §5.1), without a model; ours is a thin film that gravity pulls (Nusselt 1916, Huppert 1982), with wounds that clot and blood that dries as exponentials, exact for steps of any length",
    ..MARKED
};

/// Wounds that are closed as soon as the blade has left them.
const CLOTTED: &str = "bodies.liver.marks.bleeding.clotting_time=0.01";
/// A tenth of a millimetre in what is left of time, none of which clings.
const GUSHES: &str = "bodies.liver.marks.bleeding.rate=0.01";
const RUNS: &str = "bodies.liver.marks.bleeding.clinging=0";
const NEVER_DRY: &str = "bodies.liver.marks.bleeding.drying_time=1e14";

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
    Case {
        id: "blood_wells_up",
        what: "growth of the thickest blood in 0.5 s, where nothing makes it run: the rate of a wound that stays open, 0.25 mm/s",
        settings: &[
            "world.gravity=[0, 0, 0]",
            "bodies.liver.marks.whitening_pressure=1e15",
            "bodies.liver.marks.bleeding.clotting_time=1e14",
            NEVER_DRY,
        ],
        reading: Reading::last("thickest").taking(Statistic::LateSpan(150)).after(200),
        reference: 1.25e-4,
        // sums of some hundred steps, and a film that clots and dries by 1e-14 of itself in a second
        tolerance: Tolerance::Relative(1e-11),
        mutation: r#"bodies.liver.marks.bleeding.rate="0.26 mm/s""#,
        ..BLEEDING
    },
    Case {
        id: "blood_is_kept",
        what: "volume of the blood at the end over that 1.5 s before, while it runs down and no wound is open: no volume is made or lost",
        settings: &[CLOTTED, NEVER_DRY, GUSHES, RUNS],
        reading: Reading::last("blood").taking(Statistic::LastOver(250)).after(400),
        reference: 1.0,
        mutation: "bodies.liver.marks.bleeding.drying_time=1e6",
        ..BLEEDING
    },
    Case {
        id: "blood_dries",
        what: "the same where it dries in 2 s, whatever runs",
        settings: &[CLOTTED, GUSHES, RUNS, "bodies.liver.marks.bleeding.drying_time=2"],
        reading: Reading::last("blood").taking(Statistic::LastOver(250)).after(400),
        // exp(-0.75)
        reference: 0.472_366_552_741_014_7,
        mutation: "bodies.liver.marks.bleeding.drying_time=2.1",
        ..BLEEDING
    },
];
