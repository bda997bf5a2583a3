//! The triangle with three nodes, `ξ, η ≥ 0`, `ξ + η ≤ 1`: facets of surfaces.

use std::sync::LazyLock;

use super::{Derived, Element, ElementEntry, ElementKind, Monomial, SQRT_3_2};
use crate::quadrature::{RuleDefinition, triangle};

static DERIVED: LazyLock<Derived> = LazyLock::new(|| DATA.derive());

static DATA: Element = Element {
    kind: ElementKind::Tri3,
    dimension: 2,
    nodes: &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
    regular: &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, SQRT_3_2, 0.0]],
    basis: &[Monomial([0, 0, 0, 0]), Monomial([1, 0, 0, 0]), Monomial([0, 1, 0, 0])],
    faces: &[],
    edges: &[[0, 1], [1, 2], [2, 0]],
    mirrored: &[0, 2, 1],
    measure: 0.5,
    rules: &[
        RuleDefinition { name: "gauss_1", degree: 1, points: || triangle(1) },
        RuleDefinition { name: "gauss_3", degree: 2, points: || triangle(3) },
        RuleDefinition { name: "gauss_6", degree: 4, points: || triangle(6) },
        RuleDefinition { name: "gauss_7", degree: 5, points: || triangle(7) },
    ],
    default_rule: "gauss_1",
    full_rule: "gauss_1",
    mass_rule: "gauss_3",
    slack: |xi| xi.x.min(xi.y).min(1.0 - xi.x - xi.y),
    derived: &DERIVED,
};

pub(super) static TRI3: ElementEntry = ElementEntry {
    name: "tri3",
    summary: "linear triangle; facets of surfaces",
    source: "Dhatt & Touzot 1984, §2.3",
    parameters: &[],
    build: &DATA,
};
