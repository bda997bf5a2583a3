//! V-31 of Debunne's specification: what tetrahedra become that are split, and the step that they bear.
//!
//! The block is of 8 boxes of six tetrahedra. With all cells like the first, of half the size after a regular split, or after three along
//! longest edges, the frequency would double. By an independent program, which splits by recursion from cell to cell, it grows by 2.034,
//! 2.045 and 2.059 from one regular split to the next, and by 2.100 with three along longest edges. Shapes are worse once by the first
//! regular split and stay so, since the shortest diagonal is taken (Zhang 1995); along longest edges the third makes them worse.

use crate::{Case, Reading, Tolerance};

const SHAPE: Case = Case {
    id: "split_none_shape",
    capabilities: &["DEB-27"],
    what: "least scaled Jacobian of the block of 48 tetrahedra that is not split",
    scene: "split_block",
    settings: &["bodies.block.split.times=0"],
    reading: Reading::ScaledJacobian,
    refinement: None,
    reference: 0.412_700_232_368_351_6,
    // sums of a dozen products of coordinates
    tolerance: Tolerance::Relative(1e-12),
    source: "V-31, reported after 0, 1, 2 and 3 splits; by an independent program",
    mutation: "bodies.block.split.times=1",
};

const FREQUENCY: Case = Case {
    reading: Reading::HighestFrequency,
    // as of exp19_one_face_frequency: the power method is below a spectrum's end by a few percent
    tolerance: Tolerance::Relative(0.05),
    source: "V-31: the longest step 2/ω shrinks; by an independent program",
    ..SHAPE
};

/// Rows of a mesh that was split so often in a way: its shape, and its highest frequency [rad/s] beside that of smaller cells of the
/// first shape.
macro_rules! splits {
    ($($by:literal $times:literal: $shape:literal, $frequency:literal ($alone:literal), not $other:literal;)+) => {
        &[
            SHAPE,
            Case {
                id: "split_none_frequency",
                what: "highest frequency of the block of 48 tetrahedra that is not split",
                reference: 782.5,
                ..FREQUENCY
            },
            $(
                Case {
                    id: concat!("split_", $by, "_", $times, "_shape"),
                    what: concat!("least scaled Jacobian of the block, split ", $times, " times by ", $by),
                    settings: splits!(@ $by $times),
                    reference: $shape,
                    mutation: concat!("bodies.block.split.by=\"", $other, "\""),
                    ..SHAPE
                },
                Case {
                    id: concat!("split_", $by, "_", $times, "_frequency"),
                    what: concat!("highest frequency of the same; of cells that were only smaller ", $alone, " rad/s"),
                    settings: splits!(@ $by $times),
                    reference: $frequency,
                    mutation: concat!("bodies.block.split.by=\"", $other, "\""),
                    ..FREQUENCY
                },
            )+
        ]
    };
    (@ $by:literal $times:literal) => {
        &[concat!("bodies.block.split.times=", $times), concat!("bodies.block.split.by=\"", $by, "\"")]
    };
}

pub(super) const CASES: &[Case] = splits! {
    "regular" "1": 0.343_387_349_815_383_4, 1591.3 ("1565"), not "longest_edge";
    "regular" "2": 0.343_387_349_815_383_2, 3253.5 ("3130"), not "longest_edge";
    "regular" "3": 0.343_387_349_815_382_9, 6699.5 ("6260"), not "longest_edge";
    "longest_edge" "1": 0.412_700_232_368_351_5, 912.1 ("986"), not "regular";
    "longest_edge" "2": 0.412_700_232_368_351_5, 1419.6 ("1242"), not "regular";
    "longest_edge" "3": 0.374_629_760_457_745_76, 1643.6 ("1565"), not "regular";
};

/// The step of 1 ms, which is 2/ω of 2000 rad/s.
const STEPS: Case = Case {
    id: "split_once_steps",
    what: "steps of 1 ms that the block comes through, split once in eight: all of its second",
    settings: &[],
    reading: Reading::Steps,
    reference: 1000.0,
    tolerance: Tolerance::AtLeast,
    source: "V-31: what is split 2 or 3 times diverges; 2/ω is 1.26 ms, and 0.61 ms once it is split again",
    mutation: "bodies.block.split.times=2",
    ..SHAPE
};

pub(super) const KEPT_STEPS: &[Case] = &[
    STEPS,
    Case {
        id: "split_twice_steps",
        what: "the same, split twice: what is at the end of the spectrum grows by 8.47 from step to step, from rounding, 1e-17 m, to what has no square, 1e154 m, in 185",
        settings: &["bodies.block.split.times=2"],
        reference: 190.0,
        tolerance: Tolerance::AtMost,
        mutation: "bodies.block.split.times=1",
        ..STEPS
    },
];
