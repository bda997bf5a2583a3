//! Triangles, `ξ, η ≥ 0`, `ξ + η ≤ 1`: cells of plane bodies and membranes, facets of surfaces.

use souple_math::Vec3;

use super::{Element, ElementEntry, ElementKind, Monomial, SQRT_3_2, with_middles};
use crate::quadrature::{RuleDefinition, triangle};

const NODES: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// The regular cell.
const REGULAR: &[[f64; 3]] = &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, SQRT_3_2, 0.0]];
/// Its sides.
const FACES: &[&[u8]] = &[&[0, 1], &[1, 2], &[2, 0]];
/// The middle node of a quadratic element on an edge has the number of the corners and that of the edge.
const EDGES: [[u8; 2]; 3] = [[0, 1], [1, 2], [2, 0]];
const MIRRORED: &[u8] = &[0, 2, 1];

fn slack(xi: Vec3) -> f64 {
    xi.x.min(xi.y).min(1.0 - xi.x - xi.y)
}

static TRI3_DATA: Element = Element {
    kind: ElementKind::Tri3,
    corners: ElementKind::Tri3,
    dimension: 2,
    nodes: &NODES,
    regular: REGULAR,
    basis: &[Monomial([0, 0, 0, 0]), Monomial([1, 0, 0, 0]), Monomial([0, 1, 0, 0])],
    faces: FACES,
    edges: &EDGES,
    mirrored: MIRRORED,
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
    slack,
};

pub(super) static TRI3: ElementEntry = ElementEntry {
    name: "tri3",
    summary: "linear triangle; plane bodies, membranes, facets of surfaces",
    source: "Dhatt & Touzot 1984, §2.3",
    parameters: &[],
    build: &TRI3_DATA,
};

static TRI6_DATA: Element = Element {
    kind: ElementKind::Tri6,
    corners: ElementKind::Tri3,
    dimension: 2,
    nodes: &with_middles::<3, 3, 6>(&NODES, &EDGES),
    regular: REGULAR,
    basis: &[
        Monomial([0, 0, 0, 0]),
        Monomial([1, 0, 0, 0]),
        Monomial([0, 1, 0, 0]),
        Monomial([2, 0, 0, 0]),
        Monomial([1, 1, 0, 0]),
        Monomial([0, 2, 0, 0]),
    ],
    faces: FACES,
    edges: &EDGES,
    mirrored: MIRRORED,
    measure: 0.5,
    rules: &[
        RuleDefinition { name: "gauss_1", degree: 1, points: || triangle(1) },
        RuleDefinition { name: "gauss_3", degree: 2, points: || triangle(3) },
        RuleDefinition { name: "gauss_6", degree: 4, points: || triangle(6) },
        RuleDefinition { name: "gauss_7", degree: 5, points: || triangle(7) },
    ],
    default_rule: "gauss_3",
    full_rule: "gauss_6",
    mass_rule: "gauss_6",
    slack,
};

pub(super) static TRI6: ElementEntry = ElementEntry {
    name: "tri6",
    summary: "quadratic triangle: curved sides, full quadratics",
    source: "Dhatt & Touzot 1984, §2.3",
    parameters: &[],
    build: &TRI6_DATA,
};
