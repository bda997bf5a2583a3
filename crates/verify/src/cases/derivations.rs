//! EXP-1 to EXP-7, EXP-20 and EXP-26 of the solids' specification: what derived expressions are as long as, what they are made of
//! and whether they are right. Work is counted in operations and operands: time depends on the machine and on what else it does.

use crate::derivation::{Count, Trial};
use crate::{Case, Reading, Tolerance};

/// Settings are arguments of `souple derive`.
const DERIVED: Case = Case {
    id: "",
    capabilities: &["FAU-22"],
    what: "",
    scene: "",
    settings: &[],
    reading: Reading::Derived(Count::Constants),
    refinement: None,
    reference: 0.0,
    tolerance: Tolerance::Absolute(0.0),
    source: "Faure 2014, Tables 3.4 to 3.7",
    mutation: "cut=L",
};

/// Between the two.
const fn within(least: f64, most: f64) -> (f64, Tolerance) {
    (0.5 * (least + most), Tolerance::Absolute(0.5 * (most - least)))
}

/// The same numbers as another row, between the two.
const fn row_within(least: f64, most: f64, row: Case) -> Case {
    let (reference, tolerance) = within(least, most);
    Case { reference, tolerance, ..row }
}

/// Of every law on every element under every rule, against the bounds of EXP-6.
const fn tried(id: &'static str, what: &'static str, trial: Trial, most: f64) -> Case {
    Case {
        id,
        capabilities: &["FAU-5", "FAU-7", "FAU-8", "FAU-9", "FAU-10", "FAU-26", "FAU-27", "FAU-28", "FAU-29"],
        what,
        settings: &["check"],
        reading: Reading::Derived(Count::Off(trial)),
        reference: most,
        tolerance: Tolerance::AtMost,
        source: "specification, EXP-6; every law of `souple list laws` on every element of surfaces and volumes under each rule",
        mutation: "fault=1e-5",
        ..DERIVED
    }
}

const STVK: &str = "law=st_venant_kirchhoff";
const HOOKE: &str = "law=linear";

/// Operations of the differential over those on another element.
const fn over(other: &'static str) -> Reading {
    Reading::Derived(Count::DifferentialOperationsOver(other))
}

/// The same in tensors.
const fn over_in_tensors(other: &'static str) -> Reading {
    Reading::Derived(Count::TensorOperationsOver(other))
}

/// Operations of the differential of an element under St. Venant-Kirchhoff's law, EXP-26: tetrahedra, pyramids, boxes, prisms is the
/// order of the code that is written, and the last three are close; in tensors, with `F` at each sample, boxes and prisms are alike.
const DIFFERENTIAL: Case = Case {
    capabilities: &["FAU-10"],
    reference: 1.0,
    tolerance: Tolerance::AtMost,
    source: "Faure 2014, Fig 6.11: tetrahedra by far the fastest, the others close; specification, EXP-26",
    ..DERIVED
};

/// Constants of an element that a step reads, for forces and differential together.
const STEPS: Case = Case {
    reading: Reading::Derived(Count::StepConstants),
    source: "Faure 2014, Tables 3.4 to 3.7; specification, EXP-2: Hooke and St. Venant-Kirchhoff alike",
    // samples of several maps
    mutation: "element=prism6",
    ..DERIVED
};

/// What the source's expressions are longer.
const SIZE: Case = Case {
    capabilities: &["FAU-18", "FAU-28"],
    reading: Reading::Derived(Count::CodeBytes),
    source: "Faure 2014, p. 71",
    ..DERIVED
};

/// Against the sums of the method as it is printed, EXP-20.
const FOUR_LOOPS: Case = Case {
    capabilities: &["FAU-11", "FAU-12", "FAU-22"],
    source: "specification, EXP-20: operations of the four loops over those of derived expressions; times in `souple bench formal`",
    // four samples of one strain
    mutation: "rule=gauss_4",
    ..DERIVED
};

/// Lines of the source's table of conversions: both sides of each are one expression.
const CONVERTED: Case = Case {
    capabilities: &["FAU-19", "FAU-20", "FAU-21"],
    reading: Reading::Derived(Count::ConstantsOfFormula),
    reference: 1.0,
    source: "Faure 2014, §3.4.2; specification, 2.11.2 and EXP-7",
    ..DERIVED
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "exp2_tri3_hooke",
        what: "grouped constants of a triangle under Hooke's law",
        settings: &["law=linear", "element=tri3", "rule=gauss_1"],
        reference: 6.0,
        ..DERIVED
    },
    Case {
        id: "exp2_tri3_stvk",
        what: "the same under St. Venant-Kirchhoff's",
        settings: &["law=st_venant_kirchhoff", "element=tri3", "rule=gauss_1"],
        reference: 6.0,
        ..DERIVED
    },
    Case {
        id: "exp2_tet4_hooke",
        what: "grouped constants of a tetrahedron under Hooke's law",
        settings: &["law=linear", "element=tet4"],
        reference: 11.0,
        ..DERIVED
    },
    Case {
        id: "exp2_tet4_stvk",
        what: "the same under St. Venant-Kirchhoff's",
        settings: &["law=st_venant_kirchhoff", "element=tet4"],
        reference: 11.0,
        ..DERIVED
    },
    Case {
        id: "exp2_tet4_terms",
        capabilities: &["FAU-22", "FAU-24"],
        what: "the same cut along the terms of the law: ten in each",
        settings: &["law=st_venant_kirchhoff", "element=tet4", "cut=L"],
        reference: 20.0,
        mutation: "cut=none",
        ..DERIVED
    },
    Case {
        id: "exp2_hex8_box",
        capabilities: &["FAU-4", "FAU-22"],
        what: "grouped constants of a hexahedron that is a box: 3 of the map and 2 of the weight, where the source has 40",
        settings: &["law=st_venant_kirchhoff", "element=hex8", "rule=gauss_8", "map=box"],
        reference: 5.0,
        // without the box the inverse maps of eight samples are kept
        mutation: "map=general",
        ..DERIVED
    },
    Case {
        id: "exp2_prism6",
        what: "grouped constants of a prism of six samples: 6 (9 + 2), where the source has 77",
        settings: &["law=st_venant_kirchhoff", "element=prism6", "rule=gauss_6"],
        reference: 66.0,
        mutation: "cut=LG",
        ..DERIVED
    },
    Case {
        id: "exp2_pyramid5",
        what: "grouped constants of a pyramid of five samples: 5 (9 + 2), where the source has 71",
        settings: &["law=st_venant_kirchhoff", "element=pyramid5", "rule=gauss_5"],
        reference: 55.0,
        mutation: "cut=LG",
        ..DERIVED
    },
    Case {
        id: "exp2_tet4_hooke_steps",
        what: "constants of a tetrahedron that forces and differential read, Hooke's law: the source's eleven",
        settings: &[HOOKE, "element=tet4"],
        reference: 11.0,
        ..STEPS
    },
    Case {
        id: "exp2_tet4_stvk_steps",
        what: "the same under St. Venant-Kirchhoff's law",
        settings: &[STVK, "element=tet4"],
        reference: 11.0,
        ..STEPS
    },
    Case {
        id: "exp2_hex8_box_steps",
        capabilities: &["FAU-4", "FAU-22"],
        what: "the same of a hexahedron that is a box, where the source has 40",
        settings: &[STVK, "element=hex8", "rule=gauss_8", "map=box"],
        reference: 40.0,
        tolerance: Tolerance::AtMost,
        mutation: "map=general",
        ..STEPS
    },
    Case {
        id: "exp2_prism6_steps",
        what: "the same of a prism of six samples, where the source has 77",
        settings: &[STVK, "element=prism6", "rule=gauss_6"],
        reference: 77.0,
        tolerance: Tolerance::AtMost,
        mutation: "rule=gauss_18",
        ..STEPS
    },
    Case {
        id: "exp2_pyramid5_steps",
        what: "the same of a pyramid of five samples, where the source has 71",
        settings: &[STVK, "element=pyramid5", "rule=gauss_5"],
        reference: 71.0,
        tolerance: Tolerance::AtMost,
        mutation: "rule=gauss_8",
        ..STEPS
    },
    Case {
        id: "exp3_hex8_27",
        capabilities: &["FAU-24", "FAU-25"],
        what: "fragments of the differential of a hexahedron of 27 samples, cut along all axes",
        settings: &["law=st_venant_kirchhoff", "element=hex8", "rule=gauss_27", "map=box", "cut=all"],
        reading: Reading::Derived(Count::Fragments),
        reference: 1296.0,
        source: "Faure 2014, p. 76",
        mutation: "cut=LG",
        ..DERIVED
    },
    Case {
        id: "exp3_hex8_27_forces",
        capabilities: &["FAU-24", "FAU-25"],
        what: "fragments of the forces of that hexahedron, cut along law and Gauss points: two for each sample",
        settings: &["law=st_venant_kirchhoff", "element=hex8", "rule=gauss_27", "map=box", "cut=LG"],
        reading: Reading::Derived(Count::ForceFragments),
        reference: 2.0 * 27.0,
        source: "Faure 2014, p. 76; specification, EXP-3",
        mutation: "cut=L",
        ..DERIVED
    },
    Case {
        id: "exp2_hex8_box_hooke",
        capabilities: &["FAU-4", "FAU-22"],
        what: "the same of a box under Hooke's law",
        settings: &[HOOKE, "element=hex8", "rule=gauss_8", "map=box"],
        reference: 5.0,
        mutation: "map=general",
        ..DERIVED
    },
    Case {
        id: "exp2_prism6_hooke",
        what: "the same of a prism under Hooke's law",
        settings: &[HOOKE, "element=prism6", "rule=gauss_6"],
        reference: 66.0,
        mutation: "cut=LG",
        ..DERIVED
    },
    Case {
        id: "exp2_pyramid5_hooke",
        what: "the same of a pyramid under Hooke's law",
        settings: &[HOOKE, "element=pyramid5", "rule=gauss_5"],
        reference: 55.0,
        mutation: "cut=LG",
        ..DERIVED
    },
    Case {
        id: "exp2_tri3_terms",
        capabilities: &["FAU-22", "FAU-24"],
        what: "grouped constants of a triangle cut along the terms of St. Venant-Kirchhoff's law: five in each",
        settings: &[STVK, "element=tri3", "cut=L"],
        reference: 10.0,
        mutation: "cut=none",
        ..DERIVED
    },
    Case {
        id: "exp2_tri3_terms_each",
        capabilities: &["FAU-22", "FAU-24"],
        what: "the same of the term that has most: five in either",
        settings: &[STVK, "element=tri3", "cut=L"],
        reading: Reading::Derived(Count::MostConstants),
        reference: 5.0,
        mutation: "cut=none",
        ..DERIVED
    },
    Case {
        id: "exp2_tet4_terms_each",
        capabilities: &["FAU-22", "FAU-24"],
        what: "the same of a tetrahedron: ten in either",
        settings: &[STVK, "element=tet4", "cut=L"],
        reading: Reading::Derived(Count::MostConstants),
        reference: 10.0,
        mutation: "cut=none",
        ..DERIVED
    },
    row_within(
        55.0,
        152.0,
        Case {
            id: "exp2_pyramid5_cut",
            capabilities: &["FAU-22", "FAU-24"],
            what: "grouped constants of a pyramid cut along law and Gauss points: more than uncut, no more than the source's 152",
            settings: &[STVK, "element=pyramid5", "rule=gauss_5", "cut=LG"],
            mutation: "rule=gauss_8",
            ..DERIVED
        },
    ),
    row_within(
        5.0,
        92.0,
        Case {
            id: "exp2_hex8_box_cut",
            capabilities: &["FAU-22", "FAU-24"],
            what: "grouped constants of a box cut along Gauss points: more than uncut, no more than the source's 92",
            settings: &[STVK, "element=hex8", "rule=gauss_8", "map=box", "cut=G"],
            mutation: "rule=gauss_27",
            ..DERIVED
        },
    ),
    row_within(
        66.0,
        192.0,
        Case {
            id: "exp2_prism6_cut",
            capabilities: &["FAU-22", "FAU-24"],
            what: "grouped constants of a prism cut along law and Gauss points: more than uncut, no more than the source's 192",
            settings: &[STVK, "element=prism6", "rule=gauss_6", "cut=LG"],
            mutation: "rule=gauss_18",
            ..DERIVED
        },
    ),
    row_within(
        3.0,
        10.0,
        Case {
            id: "exp1_reference_frame",
            capabilities: &["FAU-3", "FAU-4", "FAU-22"],
            what: "operands of the differential on a rectangle derived in physical coordinates over those by the reference element",
            settings: &[HOOKE, "element=quad4", "map=box"],
            reading: Reading::Derived(Count::DirectOperands),
            source: "Faure 2014, p. 39: up to ten times longer; specification, EXP-1: at least three times",
            // three factors of a shape function in the place of two
            mutation: "element=hex8",
            ..DERIVED
        },
    ),
    Case {
        id: "exp4_tri3",
        what: "bytes of the code of a triangle under Hooke's law; the source's expressions have 21,200",
        settings: &[HOOKE, "element=tri3"],
        mutation: "element=hex8",
        reference: 2.12e4,
        tolerance: Tolerance::AtMost,
        ..SIZE
    },
    Case {
        id: "exp4_hex8",
        what: "bytes of the code of a hexahedron of eight samples under St. Venant-Kirchhoff's law: a three-hundredth of the source's",
        settings: &[STVK, "element=hex8", "rule=gauss_8"],
        mutation: "rule=gauss_27",
        reference: 6.36e7 / 300.0,
        tolerance: Tolerance::AtMost,
        ..SIZE
    },
    Case {
        id: "exp5_associations",
        capabilities: &["FAU-5", "FAU-26", "FAU-28"],
        what: "associations of a law, an element with its rule, and a cut: no fewer than the 4240 of the source",
        settings: &["list"],
        reading: Reading::Derived(Count::Associations),
        reference: 4240.0,
        tolerance: Tolerance::AtLeast,
        source: "Faure 2014, p. 80; specification, EXP-5",
        mutation: "law=linear",
        ..DERIVED
    },
    Case {
        id: "exp7_worked_example",
        capabilities: &["FAU-19", "FAU-20", "FAU-21", "FAU-22", "FAU-23"],
        what: "constants of the source's worked example: the bracket, wherever and in whatever order it stands, and its product",
        settings: &["group=(P1x - P1y)*U0x + U0y*p0*(-P1y + P1x)", "varying=U0x", "varying=U0y"],
        reading: Reading::Derived(Count::ConstantsOfFormula),
        reference: 2.0,
        source: "Faure 2014, Fig 3.15 to 3.18; specification, EXP-7",
        mutation: "varying=p0",
        ..DERIVED
    },
    Case {
        id: "exp7_difference",
        what: "constants of (a - (b + c)) x + (-(c + b) + a) y: one, for a difference is a sum in any order",
        settings: &["group=(a - (b + c))*x + (-(c + b) + a)*y", "varying=x", "varying=y"],
        mutation: "group=(a - (b + c))*x + (-(c - b) + a)*y",
        ..CONVERTED
    },
    Case {
        id: "exp7_quotient",
        what: "constants of (a + b)/(a - b) x + (a - b)^-1 (b + a) y: one, for a quotient is a product with an inverse",
        settings: &["group=(a + b)/(a - b)*x + (a - b)^(-1)*(b + a)*y", "varying=x", "varying=y"],
        mutation: "group=(a + b)/(a - b)*x + (b - a)^(-1)*(b + a)*y",
        ..CONVERTED
    },
    Case {
        id: "exp7_power",
        what: "constants of 2 (a + b)^2 x + (b + a)^2 2 y: one, for a power is of its sum in any order",
        settings: &["group=2*(a + b)^2*x + (b + a)^2*2*y", "varying=x", "varying=y"],
        mutation: "group=2*(a + b)^2*x + (b + a)^3*2*y",
        ..CONVERTED
    },
    Case {
        id: "exp7_conversion",
        capabilities: &["FAU-19", "FAU-20", "FAU-21"],
        what: "constants of (a - b (b + a)^2)/(a + b)^2 + c (a - b (b + a)^2) (a + b)^-2 with c varying: one, for both are one expression",
        settings: &[
            "group=(a - b*(b + a)^2)/(a + b)^2*x + c*(a - b*(b + a)^2)*(a + b)^(-2)",
            "varying=c",
            "varying=x",
        ],
        reading: Reading::Derived(Count::ConstantsOfFormula),
        reference: 1.0,
        source: "Faure 2014, eq. 3.42 to 3.44; specification, EXP-7",
        mutation: "group=(a - b*(b + a)^2)/(a + b)^2*x + c*(a - b*(b + a)^2)*(a + b)^(-3)",
        ..DERIVED
    },
    Case {
        mutation: "step=0.005",
        ..tried(
            "exp6_forces",
            "forces against differences of the energy, the worst of all",
            Trial::Force,
            1e-6,
        )
    },
    Case {
        mutation: "step=0.005",
        ..tried(
            "exp6_differentials",
            "differentials against differences of the forces, the worst of all",
            Trial::Differential,
            1e-6,
        )
    },
    tried(
        "exp6_symmetry",
        "symmetry of the matrix of the differential, all of it, the worst of all",
        Trial::Symmetry,
        1e-12,
    ),
    tried(
        "exp6_rigid",
        "forces of a cell that is turned and moved, the worst of all laws that do not count turns as strain",
        Trial::Rigid,
        1e-10,
    ),
    Case {
        // more than laws are allowed that do not
        reference: 1e-10,
        tolerance: Tolerance::Above,
        mutation: "law=st_venant_kirchhoff",
        ..tried(
            "exp6_turned",
            "the same of Hooke's law, which counts turns as strain: above what others are allowed",
            Trial::Turned,
            1e-10,
        )
    },
    tried("exp6_balance", "sums of forces and moments, the worst of all", Trial::Balance, 1e-10),
    tried(
        "exp6_samples",
        "derived expressions against the law at the samples as bodies take it, the worst of all",
        Trial::Samples,
        1e-10,
    ),
    Case {
        capabilities: &["FAU-24", "FAU-26", "FAU-28"],
        source: "specification, EXP-3 and EXP-5; every law on every element of first order, cut along all axes and in one way of fourteen more",
        ..tried(
            "exp3_fragments",
            "fragments of forces and differential added up, against what is not cut, the worst of all",
            Trial::Fragments,
            1e-12,
        )
    },
    Case {
        id: "exp20_stvk_forces",
        what: "operations of the literal sums of the tensor-mass method over those of derived forces, St. Venant-Kirchhoff",
        settings: &[STVK, "element=tet4"],
        reading: Reading::Derived(Count::FourLoopForces),
        reference: 10.0,
        tolerance: Tolerance::AtLeast,
        ..FOUR_LOOPS
    },
    Case {
        id: "exp20_stvk_differential",
        what: "the same of the differential",
        settings: &[STVK, "element=tet4"],
        reading: Reading::Derived(Count::FourLoopDifferential),
        reference: 10.0,
        tolerance: Tolerance::AtLeast,
        ..FOUR_LOOPS
    },
    Case {
        id: "exp20_hooke_forces",
        what: "the same of forces under Hooke's law, where the source's derived code is three times slower: no slower",
        settings: &[HOOKE, "element=tet4"],
        reading: Reading::Derived(Count::FourLoopForces),
        reference: 1.0,
        tolerance: Tolerance::AtLeast,
        ..FOUR_LOOPS
    },
    Case {
        id: "exp20_hooke_differential",
        what: "the same of the differential under Hooke's law",
        settings: &[HOOKE, "element=tet4"],
        reading: Reading::Derived(Count::FourLoopDifferential),
        reference: 1.0,
        tolerance: Tolerance::AtLeast,
        ..FOUR_LOOPS
    },
    Case {
        id: "exp26_tet4",
        what: "operations of the differential on a tetrahedron over those on a pyramid, the least of the others: a fifth at most",
        settings: &[STVK, "element=tet4"],
        reading: over("element=pyramid5 rule=gauss_5"),
        // one sample against five
        reference: 0.2,
        mutation: "element=prism6",
        ..DIFFERENTIAL
    },
    Case {
        id: "exp26_pyramid5",
        what: "the same on a pyramid of five samples over those on a box of eight: fewer",
        settings: &[STVK, "element=pyramid5", "rule=gauss_5"],
        reading: over("element=hex8 rule=gauss_8 map=box"),
        mutation: "rule=gauss_8",
        ..DIFFERENTIAL
    },
    Case {
        id: "exp26_hex8",
        capabilities: &["FAU-4", "FAU-10"],
        what: "the same on a box of eight samples over those on a prism of six: fewer, in code that is written out; in tensors they are alike",
        settings: &[STVK, "element=hex8", "rule=gauss_8", "map=box"],
        reading: over("element=prism6 rule=gauss_6 map=general"),
        mutation: "rule=gauss_27",
        ..DIFFERENTIAL
    },
    Case {
        id: "exp26_prism6",
        what: "the same on a prism of six samples over those on a pyramid of five: close, at most as samples times nodes",
        settings: &[STVK, "element=prism6", "rule=gauss_6"],
        reading: over("element=pyramid5 rule=gauss_5"),
        reference: 36.0 / 25.0,
        mutation: "rule=gauss_18",
        ..DIFFERENTIAL
    },
    Case {
        id: "exp26_tet4_run",
        what: "the same in tensors: a tetrahedron over a pyramid of five samples, a fifth at most",
        settings: &[STVK, "element=tet4"],
        reading: over_in_tensors("element=pyramid5 rule=gauss_5"),
        // one sample against five
        reference: 0.2,
        mutation: "element=prism6",
        ..DIFFERENTIAL
    },
    Case {
        id: "exp26_pyramid5_run",
        what: "a pyramid of five samples over a box of eight: fewer",
        settings: &[STVK, "element=pyramid5", "rule=gauss_5"],
        reading: over_in_tensors("element=hex8 rule=gauss_8 map=box"),
        mutation: "rule=gauss_8",
        ..DIFFERENTIAL
    },
    Case {
        id: "exp26_hex8_run",
        capabilities: &["FAU-4", "FAU-10"],
        what: "a box of eight samples over a pyramid of five: close, a sample no dearer where maps are three numbers",
        settings: &[STVK, "element=hex8", "rule=gauss_8", "map=box"],
        reading: over_in_tensors("element=pyramid5 rule=gauss_5 map=general"),
        reference: 8.0 / 5.0,
        mutation: "map=general",
        ..DIFFERENTIAL
    },
    Case {
        id: "exp26_prism6_run",
        what: "a prism of six samples over a pyramid of five: close, at most as samples times nodes",
        settings: &[STVK, "element=prism6", "rule=gauss_6"],
        reading: over_in_tensors("element=pyramid5 rule=gauss_5"),
        reference: 36.0 / 25.0,
        mutation: "rule=gauss_18",
        ..DIFFERENTIAL
    },
];
