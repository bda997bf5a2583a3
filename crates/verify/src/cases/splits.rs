//! V-31 of Debunne's specification: what tetrahedra become that are split, and the step that they bear.
//!
//! The block is of 8 boxes of six tetrahedra, each along three edges of the box in one of their orders. Shapes are those of the worst
//! tetrahedra that splitting leaves of these, which are looked up below by their corners: along longest edges it is the same to split each
//! for itself, since neighbours have their longest edges in common. With all cells like the first, of half the size after a regular split, or after three along
//! longest edges, the frequency would double. By an independent program, which splits by recursion from cell to cell, it grows by 2.034,
//! 2.045 and 2.059 from one regular split to the next, and by 2.100 with three along longest edges. Shapes are worse once by the first
//! regular split and stay so, since the shortest diagonal is taken (Zhang 1995); along longest edges the third makes them worse.

use crate::{Case, Reading, Tolerance};

/// Sizes of a box of the block [m].
const BOX: [f64; 3] = [0.06, 0.05, 0.04];

/// By Newton's method from above, as many steps as any number here takes.
const fn root(square: f64) -> f64 {
    let (mut root, mut step) = (1.0, 0);
    while step < 60 {
        root = 0.5 * (root + square / root);
        step += 1;
    }
    root
}

/// From one corner to another, in sizes of the box [m].
const fn arm(from: [f64; 3], to: [f64; 3]) -> [f64; 3] {
    [(to[0] - from[0]) * BOX[0], (to[1] - from[1]) * BOX[1], (to[2] - from[2]) * BOX[2]]
}

const fn length(of: [f64; 3]) -> f64 {
    root(of[0] * of[0] + of[1] * of[1] + of[2] * of[2])
}

/// `√2 J` over the largest product of the three edges of a corner, of a tetrahedron in sizes of the box.
const fn scaled_jacobian(corners: [[f64; 3]; 4]) -> f64 {
    let [a, b, c] = [arm(corners[0], corners[1]), arm(corners[0], corners[2]), arm(corners[0], corners[3])];
    let volume = a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0]);
    let (mut largest, mut corner) = (0.0, 0);
    while corner < 4 {
        let (mut product, mut other) = (1.0, 0);
        while other < 4 {
            if other != corner {
                product *= length(arm(corners[corner], corners[other]));
            }
            other += 1;
        }
        if product > largest {
            largest = product;
        }
        corner += 1;
    }
    let six_volumes = if volume < 0.0 { -volume } else { volume };
    root(2.0) * six_volumes / largest
}

/// Along the longest edge, the next and the shortest; halves and quarters of it that are cut off along longest edges are no worse.
const WHOLE: f64 = scaled_jacobian([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 1.0, 1.0]]);
/// Around a shortest diagonal within one of eight, of two that are as short, where rounding takes the worse in some; those at the corners are
/// like the whole, and eighths of these and of all that follow are no worse.
const EIGHTH: f64 = scaled_jacobian([[0.5, 0.5, 0.5], [0.5, 1.0, 0.0], [0.5, 0.5, 0.0], [1.0, 1.0, 0.5]]);
/// One of eight along longest edges: halved along the diagonal of the box, that of its largest face, and then its own longest edge.
const THIRD_HALF: f64 =
    scaled_jacobian([[0.5, 0.5, 0.5], [0.5, 1.0, 0.5], [0.75, 0.75, 0.25], [1.0, 1.0, 1.0]]);

const SHAPE: Case = Case {
    id: "split_none_shape",
    capabilities: &["DEB-27"],
    what: "least scaled Jacobian of the block of 48 tetrahedra that is not split",
    scene: "split_block",
    settings: &["bodies.block.split.times=0"],
    reading: Reading::ScaledJacobian,
    refinement: None,
    reference: WHOLE,
    // sums of a dozen products of coordinates
    tolerance: Tolerance::Relative(1e-12),
    source: "V-31, reported after 0, 1, 2 and 3 splits; the corners of the worst tetrahedron",
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
    ($($by:literal $times:literal: $shape:ident, $frequency:literal ($alone:literal), not $other:literal;)+) => {
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
    "regular" "1": EIGHTH, 1591.3 ("1565"), not "longest_edge";
    "regular" "2": EIGHTH, 3253.5 ("3130"), not "longest_edge";
    "regular" "3": EIGHTH, 6699.5 ("6260"), not "longest_edge";
    "longest_edge" "1": WHOLE, 912.1 ("986"), not "regular";
    "longest_edge" "2": WHOLE, 1419.6 ("1242"), not "regular";
    "longest_edge" "3": THIRD_HALF, 1643.6 ("1565"), not "regular";
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
