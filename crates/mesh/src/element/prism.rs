//! The prism (wedge) with six nodes: triangle `ξ, η ≥ 0`, `ξ + η ≤ 1`, axis `ζ ∈ [-1, 1]`.

use std::sync::LazyLock;

use super::{Derived, Element, ElementEntry, ElementKind, Face, Monomial, SQRT_3_2};
use crate::quadrature::{RuleDefinition, prism};

static DERIVED: LazyLock<Derived> = LazyLock::new(|| DATA.derive());

static DATA: Element = Element {
    kind: ElementKind::Prism6,
    dimension: 3,
    nodes: &[
        [0.0, 0.0, -1.0],
        [1.0, 0.0, -1.0],
        [0.0, 1.0, -1.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 1.0],
        [0.0, 1.0, 1.0],
    ],
    regular: &[
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.5, SQRT_3_2, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 1.0],
        [0.5, SQRT_3_2, 1.0],
    ],
    basis: &[
        Monomial([0, 0, 0, 0]),
        Monomial([1, 0, 0, 0]),
        Monomial([0, 1, 0, 0]),
        Monomial([0, 0, 1, 0]),
        Monomial([1, 0, 1, 0]),
        Monomial([0, 1, 1, 0]),
    ],
    faces: &[
        Face { kind: ElementKind::Tri3, nodes: &[0, 2, 1] },
        Face { kind: ElementKind::Tri3, nodes: &[3, 4, 5] },
        Face { kind: ElementKind::Quad4, nodes: &[0, 1, 4, 3] },
        Face { kind: ElementKind::Quad4, nodes: &[1, 2, 5, 4] },
        Face { kind: ElementKind::Quad4, nodes: &[2, 0, 3, 5] },
    ],
    edges: &[[0, 1], [1, 2], [2, 0], [3, 4], [4, 5], [5, 3], [0, 3], [1, 4], [2, 5]],
    mirrored: &[3, 4, 5, 0, 1, 2],
    measure: 1.0,
    rules: &[
        RuleDefinition { name: "gauss_1", degree: 1, points: || prism(1, 1) },
        RuleDefinition { name: "gauss_6", degree: 2, points: || prism(3, 2) },
        RuleDefinition { name: "gauss_18", degree: 4, points: || prism(6, 3) },
        RuleDefinition { name: "gauss_21", degree: 5, points: || prism(7, 3) },
    ],
    default_rule: "gauss_6",
    full_rule: "gauss_18",
    mass_rule: "gauss_6",
    slack: |xi| xi.x.min(xi.y).min(1.0 - xi.x - xi.y).min(1.0 - xi.z.abs()),
    derived: &DERIVED,
};

pub(super) static PRISM6: ElementEntry = ElementEntry {
    name: "prism6",
    summary: "wedge: linear triangle by linear axis; bends well along its axis, joins tets to hexes",
    source: "Dhatt & Touzot 1984, §2.7",
    parameters: &[],
    build: &DATA,
};
