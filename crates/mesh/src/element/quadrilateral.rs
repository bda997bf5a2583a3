//! Quadrilaterals, `ξ, η ∈ [-1, 1]`: cells of plane bodies and membranes, facets of surfaces.

use souple_math::Vec3;

use super::{Element, ElementEntry, ElementKind, Monomial, followed_by, with_middles};
use crate::quadrature::{RuleDefinition, quadrilateral};

const NODES: [[f64; 3]; 4] = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
/// The regular cell.
const REGULAR: &[[f64; 3]] = &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
/// Its sides.
const FACES: &[&[u8]] = &[&[0, 1], &[1, 2], &[2, 3], &[3, 0]];
/// The middle node of a quadratic element on an edge has the number of the corners and that of the edge.
const EDGES: [[u8; 2]; 4] = [[0, 1], [1, 2], [2, 3], [3, 0]];
const MIRRORED: &[u8] = &[0, 3, 2, 1];

fn slack(xi: Vec3) -> f64 {
    1.0 - xi.x.abs().max(xi.y.abs())
}

static QUAD4_DATA: Element = Element {
    kind: ElementKind::Quad4,
    corners: ElementKind::Quad4,
    dimension: 2,
    nodes: &NODES,
    regular: REGULAR,
    basis: &[Monomial([0, 0, 0, 0]), Monomial([1, 0, 0, 0]), Monomial([0, 1, 0, 0]), Monomial([1, 1, 0, 0])],
    faces: FACES,
    edges: &EDGES,
    mirrored: MIRRORED,
    measure: 4.0,
    rules: &[
        RuleDefinition { name: "gauss_1", degree: 1, points: || quadrilateral(1) },
        RuleDefinition { name: "gauss_4", degree: 3, points: || quadrilateral(2) },
        RuleDefinition { name: "gauss_9", degree: 5, points: || quadrilateral(3) },
    ],
    default_rule: "gauss_4",
    full_rule: "gauss_9",
    mass_rule: "gauss_4",
    slack,
};

pub(super) static QUAD4: ElementEntry = ElementEntry {
    name: "quad4",
    summary: "bilinear quadrilateral; plane bodies, membranes, facets of surfaces",
    source: "Dhatt & Touzot 1984, §2.4",
    parameters: &[],
    build: &QUAD4_DATA,
};

static QUAD8_DATA: Element = Element {
    kind: ElementKind::Quad8,
    corners: ElementKind::Quad4,
    dimension: 2,
    nodes: &with_middles::<4, 4, 8>(&NODES, &EDGES),
    regular: REGULAR,
    basis: &[
        Monomial([0, 0, 0, 0]),
        Monomial([1, 0, 0, 0]),
        Monomial([0, 1, 0, 0]),
        Monomial([1, 1, 0, 0]),
        Monomial([2, 0, 0, 0]),
        Monomial([0, 2, 0, 0]),
        Monomial([2, 1, 0, 0]),
        Monomial([1, 2, 0, 0]),
    ],
    faces: FACES,
    edges: &EDGES,
    mirrored: MIRRORED,
    measure: 4.0,
    rules: &[
        RuleDefinition { name: "gauss_4", degree: 3, points: || quadrilateral(2) },
        RuleDefinition { name: "gauss_9", degree: 5, points: || quadrilateral(3) },
        RuleDefinition { name: "gauss_25", degree: 9, points: || quadrilateral(5) },
    ],
    default_rule: "gauss_9",
    full_rule: "gauss_25",
    mass_rule: "gauss_9",
    slack,
};

pub(super) static QUAD8: ElementEntry = ElementEntry {
    name: "quad8",
    summary: "quadratic quadrilateral of the serendipity family",
    source: "Dhatt & Touzot 1984, §2.4",
    parameters: &[],
    build: &QUAD8_DATA,
};

static QUAD9_DATA: Element = Element {
    kind: ElementKind::Quad9,
    corners: ElementKind::Quad4,
    dimension: 2,
    nodes: &followed_by::<9>(QUAD8_DATA.nodes, &[[0.0, 0.0, 0.0]]),
    regular: REGULAR,
    basis: &[
        Monomial([0, 0, 0, 0]),
        Monomial([1, 0, 0, 0]),
        Monomial([2, 0, 0, 0]),
        Monomial([0, 1, 0, 0]),
        Monomial([1, 1, 0, 0]),
        Monomial([2, 1, 0, 0]),
        Monomial([0, 2, 0, 0]),
        Monomial([1, 2, 0, 0]),
        Monomial([2, 2, 0, 0]),
    ],
    faces: FACES,
    edges: &EDGES,
    mirrored: MIRRORED,
    measure: 4.0,
    rules: QUAD8_DATA.rules,
    default_rule: "gauss_9",
    full_rule: "gauss_25",
    mass_rule: "gauss_9",
    slack,
};

pub(super) static QUAD9: ElementEntry = ElementEntry {
    name: "quad9",
    summary: "biquadratic quadrilateral, a node in its middle; faces of hex27",
    source: "Dhatt & Touzot 1984, §2.4",
    parameters: &[],
    build: &QUAD9_DATA,
};
