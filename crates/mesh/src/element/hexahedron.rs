//! The hexahedron with eight nodes: `ξ, η, ζ ∈ [-1, 1]`.

use std::sync::LazyLock;

use super::{Derived, Element, ElementEntry, ElementKind, Face, Monomial};
use crate::quadrature::{RuleDefinition, hexahedron};

static DERIVED: LazyLock<Derived> = LazyLock::new(|| DATA.derive());

static DATA: Element = Element {
    kind: ElementKind::Hex8,
    dimension: 3,
    nodes: &[
        [-1.0, -1.0, -1.0],
        [1.0, -1.0, -1.0],
        [1.0, 1.0, -1.0],
        [-1.0, 1.0, -1.0],
        [-1.0, -1.0, 1.0],
        [1.0, -1.0, 1.0],
        [1.0, 1.0, 1.0],
        [-1.0, 1.0, 1.0],
    ],
    regular: &[
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 1.0],
        [1.0, 1.0, 1.0],
        [0.0, 1.0, 1.0],
    ],
    basis: &[
        Monomial([0, 0, 0, 0]),
        Monomial([1, 0, 0, 0]),
        Monomial([0, 1, 0, 0]),
        Monomial([0, 0, 1, 0]),
        Monomial([1, 1, 0, 0]),
        Monomial([0, 1, 1, 0]),
        Monomial([1, 0, 1, 0]),
        Monomial([1, 1, 1, 0]),
    ],
    faces: &[
        Face { kind: ElementKind::Quad4, nodes: &[0, 3, 2, 1] },
        Face { kind: ElementKind::Quad4, nodes: &[4, 5, 6, 7] },
        Face { kind: ElementKind::Quad4, nodes: &[0, 1, 5, 4] },
        Face { kind: ElementKind::Quad4, nodes: &[1, 2, 6, 5] },
        Face { kind: ElementKind::Quad4, nodes: &[2, 3, 7, 6] },
        Face { kind: ElementKind::Quad4, nodes: &[3, 0, 4, 7] },
    ],
    edges: &[[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]],
    mirrored: &[0, 3, 2, 1, 4, 7, 6, 5],
    measure: 8.0,
    rules: &[
        RuleDefinition { name: "gauss_1", degree: 1, points: || hexahedron(1) },
        RuleDefinition { name: "gauss_8", degree: 3, points: || hexahedron(2) },
        RuleDefinition { name: "gauss_27", degree: 5, points: || hexahedron(3) },
        RuleDefinition { name: "gauss_64", degree: 7, points: || hexahedron(4) },
    ],
    default_rule: "gauss_8",
    full_rule: "gauss_27",
    mass_rule: "gauss_8",
    slack: |xi| 1.0 - xi.largest_component(),
    derived: &DERIVED,
};

pub(super) static HEX8: ElementEntry = ElementEntry {
    name: "hex8",
    summary: "trilinear hexahedron; the most accurate of the linear elements in bending",
    source: "Dhatt & Touzot 1984, §2.6",
    parameters: &[],
    build: &DATA,
};
