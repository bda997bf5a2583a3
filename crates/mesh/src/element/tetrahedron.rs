//! Tetrahedra, `ξ, η, ζ ≥ 0`, `ξ + η + ζ ≤ 1`.

use souple_math::Vec3;

use super::{Element, ElementEntry, ElementKind, Monomial, SQRT_2_3, SQRT_3_2, with_middles};
use crate::quadrature::{RuleDefinition, tetrahedron};

const NODES: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// The regular cell.
const REGULAR: &[[f64; 3]] =
    &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, SQRT_3_2, 0.0], [0.5, SQRT_3_2 / 3.0, SQRT_2_3]];
/// Corners of each face, normal outward.
const FACES: &[&[u8]] = &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[0, 3, 2]];
/// The middle node of a quadratic element on an edge has the number of the corners and that of the edge.
const EDGES: [[u8; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];
const MIRRORED: &[u8] = &[0, 1, 3, 2];

fn slack(xi: Vec3) -> f64 {
    xi.x.min(xi.y).min(xi.z).min(1.0 - xi.x - xi.y - xi.z)
}

static TET4_DATA: Element = Element {
    kind: ElementKind::Tet4,
    corners: ElementKind::Tet4,
    dimension: 3,
    nodes: &NODES,
    regular: REGULAR,
    basis: &[Monomial([0, 0, 0, 0]), Monomial([1, 0, 0, 0]), Monomial([0, 1, 0, 0]), Monomial([0, 0, 1, 0])],
    faces: FACES,
    edges: &EDGES,
    mirrored: MIRRORED,
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
    slack,
};

pub(super) static TET4: ElementEntry = ElementEntry {
    name: "tet4",
    summary: "linear tetrahedron; fills any shape, the fastest, locks in bending",
    source: "Dhatt & Touzot 1984, §2.5",
    parameters: &[],
    build: &TET4_DATA,
};

static TET10_DATA: Element = Element {
    kind: ElementKind::Tet10,
    corners: ElementKind::Tet4,
    dimension: 3,
    nodes: &with_middles::<4, 6, 10>(&NODES, &EDGES),
    regular: REGULAR,
    basis: &[
        Monomial([0, 0, 0, 0]),
        Monomial([1, 0, 0, 0]),
        Monomial([0, 1, 0, 0]),
        Monomial([0, 0, 1, 0]),
        Monomial([2, 0, 0, 0]),
        Monomial([0, 2, 0, 0]),
        Monomial([0, 0, 2, 0]),
        Monomial([1, 1, 0, 0]),
        Monomial([0, 1, 1, 0]),
        Monomial([1, 0, 1, 0]),
    ],
    faces: FACES,
    edges: &EDGES,
    mirrored: MIRRORED,
    measure: 1.0 / 6.0,
    rules: &[
        RuleDefinition { name: "gauss_4", degree: 2, points: || tetrahedron(4) },
        RuleDefinition { name: "gauss_8", degree: 3, points: || tetrahedron(8) },
        RuleDefinition { name: "gauss_14", degree: 5, points: || tetrahedron(14) },
    ],
    default_rule: "gauss_4",
    full_rule: "gauss_14",
    mass_rule: "gauss_14",
    slack,
};

pub(super) static TET10: ElementEntry = ElementEntry {
    name: "tet10",
    summary: "quadratic tetrahedron; fills any shape, bends without locking",
    source: "Dhatt & Touzot 1984, §2.5",
    parameters: &[],
    build: &TET10_DATA,
};
