//! The tetrahedron with four nodes: `ξ, η, ζ ≥ 0`, `ξ + η + ζ ≤ 1`.

use std::sync::LazyLock;

use super::{Derived, Element, ElementEntry, ElementKind, Face, Monomial, SQRT_2_3, SQRT_3_2};
use crate::quadrature::{RuleDefinition, tetrahedron};

static DERIVED: LazyLock<Derived> = LazyLock::new(|| DATA.derive());

static DATA: Element = Element {
    kind: ElementKind::Tet4,
    dimension: 3,
    nodes: &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    regular: &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, SQRT_3_2, 0.0], [0.5, SQRT_3_2 / 3.0, SQRT_2_3]],
    basis: &[Monomial([0, 0, 0, 0]), Monomial([1, 0, 0, 0]), Monomial([0, 1, 0, 0]), Monomial([0, 0, 1, 0])],
    faces: &[
        Face { kind: ElementKind::Tri3, nodes: &[0, 2, 1] },
        Face { kind: ElementKind::Tri3, nodes: &[0, 1, 3] },
        Face { kind: ElementKind::Tri3, nodes: &[1, 2, 3] },
        Face { kind: ElementKind::Tri3, nodes: &[0, 3, 2] },
    ],
    edges: &[[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]],
    mirrored: &[0, 1, 3, 2],
    measure: 1.0 / 6.0,
    rules: &[
        RuleDefinition { name: "gauss_1", degree: 1, points: || tetrahedron(1) },
        RuleDefinition { name: "gauss_4", degree: 2, points: || tetrahedron(4) },
        RuleDefinition { name: "gauss_8", degree: 3, points: || tetrahedron(8) },
        RuleDefinition { name: "gauss_14", degree: 5, points: || tetrahedron(14) },
    ],
    default_rule: "gauss_1",
    full_rule: "gauss_1",
    mass_rule: "gauss_4",
    slack: |xi| xi.x.min(xi.y).min(xi.z).min(1.0 - xi.x - xi.y - xi.z),
    derived: &DERIVED,
};

pub(super) static TET4: ElementEntry = ElementEntry {
    name: "tet4",
    summary: "linear tetrahedron; fills any shape, the fastest, locks in bending",
    source: "Dhatt & Touzot 1984, §2.5",
    parameters: &[],
    build: &DATA,
};
