//! Prisms (wedges): triangle `ξ, η ≥ 0`, `ξ + η ≤ 1`, axis `ζ ∈ [-1, 1]`.

use souple_math::Vec3;

use super::{Element, ElementEntry, ElementKind, Monomial, SQRT_3_2, with_middles};
use crate::quadrature::{RuleDefinition, prism};

const NODES: [[f64; 3]; 6] =
    [[0.0, 0.0, -1.0], [1.0, 0.0, -1.0], [0.0, 1.0, -1.0], [0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]];
/// The regular cell.
const REGULAR: &[[f64; 3]] = &[
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.5, SQRT_3_2, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 1.0],
    [0.5, SQRT_3_2, 1.0],
];
/// Corners of each face, normal outward.
const FACES: &[&[u8]] = &[&[0, 2, 1], &[3, 4, 5], &[0, 1, 4, 3], &[1, 2, 5, 4], &[2, 0, 3, 5]];
/// The middle node of a quadratic element on an edge has the number of the corners and that of the edge.
const EDGES: [[u8; 2]; 9] = [[0, 1], [1, 2], [2, 0], [3, 4], [4, 5], [5, 3], [0, 3], [1, 4], [2, 5]];
const MIRRORED: &[u8] = &[3, 4, 5, 0, 1, 2];

fn slack(xi: Vec3) -> f64 {
    xi.x.min(xi.y).min(1.0 - xi.x - xi.y).min(1.0 - xi.z.abs())
}

static PRISM6_DATA: Element = Element {
    kind: ElementKind::Prism6,
    corners: ElementKind::Prism6,
    dimension: 3,
    nodes: &NODES,
    regular: REGULAR,
    basis: &[
        Monomial([0, 0, 0, 0]),
        Monomial([1, 0, 0, 0]),
        Monomial([0, 1, 0, 0]),
        Monomial([0, 0, 1, 0]),
        Monomial([1, 0, 1, 0]),
        Monomial([0, 1, 1, 0]),
    ],
    faces: FACES,
    edges: &EDGES,
    mirrored: MIRRORED,
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
    slack,
};

pub(super) static PRISM6: ElementEntry = ElementEntry {
    name: "prism6",
    summary: "wedge: linear triangle by linear axis; bends well along its axis, joins tets to hexes",
    source: "Dhatt & Touzot 1984, §2.7",
    parameters: &[],
    build: &PRISM6_DATA,
};

static PRISM15_DATA: Element = Element {
    kind: ElementKind::Prism15,
    corners: ElementKind::Prism6,
    dimension: 3,
    nodes: &with_middles::<6, 9, 15>(&NODES, &EDGES),
    regular: REGULAR,
    basis: &[
        Monomial([0, 0, 0, 0]),
        Monomial([1, 0, 0, 0]),
        Monomial([0, 1, 0, 0]),
        Monomial([0, 0, 1, 0]),
        Monomial([1, 0, 1, 0]),
        Monomial([0, 1, 1, 0]),
        Monomial([2, 0, 0, 0]),
        Monomial([1, 1, 0, 0]),
        Monomial([0, 2, 0, 0]),
        Monomial([0, 0, 2, 0]),
        Monomial([2, 0, 1, 0]),
        Monomial([1, 1, 1, 0]),
        Monomial([0, 2, 1, 0]),
        Monomial([1, 0, 2, 0]),
        Monomial([0, 1, 2, 0]),
    ],
    faces: FACES,
    edges: &EDGES,
    mirrored: MIRRORED,
    measure: 1.0,
    rules: &[
        RuleDefinition { name: "gauss_6", degree: 2, points: || prism(3, 2) },
        RuleDefinition { name: "gauss_18", degree: 4, points: || prism(6, 3) },
        RuleDefinition { name: "gauss_21", degree: 5, points: || prism(7, 3) },
        RuleDefinition { name: "gauss_80", degree: 8, points: || prism(16, 5) },
    ],
    default_rule: "gauss_18",
    full_rule: "gauss_80",
    mass_rule: "gauss_18",
    slack,
};

pub(super) static PRISM15: ElementEntry = ElementEntry {
    name: "prism15",
    summary: "quadratic wedge; joins tet10 to hex20",
    source: "Dhatt & Touzot 1984, §2.7",
    parameters: &[],
    build: &PRISM15_DATA,
};
