//! EXP-2 and EXP-3 of the solids' specification: grouped constants and fragments of derived expressions.

use crate::derivation::Count;
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

/// Up to the source's count.
const fn at_most(most: f64) -> (f64, Tolerance) {
    (0.5 * most, Tolerance::Absolute(0.5 * most))
}

const HEXAHEDRON: (f64, Tolerance) = at_most(40.0);
const PRISM: (f64, Tolerance) = at_most(77.0);
const PYRAMID: (f64, Tolerance) = at_most(71.0);

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
        what: "grouped constants of a hexahedron that is a box: at most 40",
        settings: &["law=st_venant_kirchhoff", "element=hex8", "rule=gauss_8", "map=box"],
        reference: HEXAHEDRON.0,
        tolerance: HEXAHEDRON.1,
        // without the box the inverse maps of eight samples are kept
        mutation: "map=general",
        ..DERIVED
    },
    Case {
        id: "exp2_prism6",
        what: "grouped constants of a prism of six samples: at most 77",
        settings: &["law=st_venant_kirchhoff", "element=prism6", "rule=gauss_6"],
        reference: PRISM.0,
        tolerance: PRISM.1,
        mutation: "cut=LG",
        ..DERIVED
    },
    Case {
        id: "exp2_pyramid5",
        what: "grouped constants of a pyramid of five samples: at most 71",
        settings: &["law=st_venant_kirchhoff", "element=pyramid5", "rule=gauss_5"],
        reference: PYRAMID.0,
        tolerance: PYRAMID.1,
        mutation: "cut=LG",
        ..DERIVED
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
];
