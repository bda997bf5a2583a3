//! The quadrilateral with four nodes, `ξ, η ∈ [-1, 1]`: facets of surfaces.

use std::sync::LazyLock;

use super::{Derived, Element, ElementEntry, ElementKind, Monomial};
use crate::quadrature::{RuleDefinition, quadrilateral};

static DERIVED: LazyLock<Derived> = LazyLock::new(|| DATA.derive());

static DATA: Element = Element {
    kind: ElementKind::Quad4,
    dimension: 2,
    nodes: &[[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]],
    regular: &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
    basis: &[Monomial([0, 0, 0, 0]), Monomial([1, 0, 0, 0]), Monomial([0, 1, 0, 0]), Monomial([1, 1, 0, 0])],
    faces: &[],
    edges: &[[0, 1], [1, 2], [2, 3], [3, 0]],
    mirrored: &[0, 3, 2, 1],
    measure: 4.0,
    rules: &[
        RuleDefinition { name: "gauss_1", degree: 1, points: || quadrilateral(1) },
        RuleDefinition { name: "gauss_4", degree: 3, points: || quadrilateral(2) },
        RuleDefinition { name: "gauss_9", degree: 5, points: || quadrilateral(3) },
    ],
    default_rule: "gauss_4",
    full_rule: "gauss_9",
    mass_rule: "gauss_4",
    slack: |xi| 1.0 - xi.x.abs().max(xi.y.abs()),
    derived: &DERIVED,
};

pub(super) static QUAD4: ElementEntry = ElementEntry {
    name: "quad4",
    summary: "bilinear quadrilateral; facets of surfaces",
    source: "Dhatt & Touzot 1984, §2.4",
    parameters: &[],
    build: &DATA,
};
