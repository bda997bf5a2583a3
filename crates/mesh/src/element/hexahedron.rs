//! Hexahedra, `ξ, η, ζ ∈ [-1, 1]`.

use souple_math::Vec3;

use super::{Element, ElementEntry, ElementKind, Monomial, followed_by, with_middles};
use crate::quadrature::{RuleDefinition, hexahedron};

const NODES: [[f64; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];
/// The regular cell.
const REGULAR: &[[f64; 3]] = &[
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 1.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 1.0],
    [1.0, 1.0, 1.0],
    [0.0, 1.0, 1.0],
];
/// Corners of each face, normal outward.
const FACES: &[&[u8]] =
    &[&[0, 3, 2, 1], &[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]];
/// The middle node of a quadratic element on an edge has the number of the corners and that of the edge.
const EDGES: [[u8; 2]; 12] =
    [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]];
const MIRRORED: &[u8] = &[0, 3, 2, 1, 4, 7, 6, 5];

fn slack(xi: Vec3) -> f64 {
    1.0 - xi.largest_component()
}

static HEX8_DATA: Element = Element {
    kind: ElementKind::Hex8,
    corners: ElementKind::Hex8,
    dimension: 3,
    nodes: &NODES,
    regular: REGULAR,
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
    faces: FACES,
    edges: &EDGES,
    mirrored: MIRRORED,
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
    slack,
};

pub(super) static HEX8: ElementEntry = ElementEntry {
    name: "hex8",
    summary: "trilinear hexahedron; the most accurate of the linear elements in bending",
    source: "Dhatt & Touzot 1984, §2.6",
    parameters: &[],
    build: &HEX8_DATA,
};

static HEX20_DATA: Element = Element {
    kind: ElementKind::Hex20,
    corners: ElementKind::Hex8,
    dimension: 3,
    nodes: &with_middles::<8, 12, 20>(&NODES, &EDGES),
    regular: REGULAR,
    basis: &[
        Monomial([0, 0, 0, 0]),
        Monomial([1, 0, 0, 0]),
        Monomial([0, 1, 0, 0]),
        Monomial([0, 0, 1, 0]),
        Monomial([1, 1, 0, 0]),
        Monomial([0, 1, 1, 0]),
        Monomial([1, 0, 1, 0]),
        Monomial([1, 1, 1, 0]),
        Monomial([2, 0, 0, 0]),
        Monomial([0, 2, 0, 0]),
        Monomial([0, 0, 2, 0]),
        Monomial([2, 1, 0, 0]),
        Monomial([2, 0, 1, 0]),
        Monomial([1, 2, 0, 0]),
        Monomial([0, 2, 1, 0]),
        Monomial([1, 0, 2, 0]),
        Monomial([0, 1, 2, 0]),
        Monomial([2, 1, 1, 0]),
        Monomial([1, 2, 1, 0]),
        Monomial([1, 1, 2, 0]),
    ],
    faces: FACES,
    edges: &EDGES,
    mirrored: MIRRORED,
    measure: 8.0,
    rules: &[
        RuleDefinition { name: "gauss_8", degree: 3, points: || hexahedron(2) },
        RuleDefinition { name: "gauss_27", degree: 5, points: || hexahedron(3) },
        RuleDefinition { name: "gauss_64", degree: 7, points: || hexahedron(4) },
        RuleDefinition { name: "gauss_125", degree: 9, points: || hexahedron(5) },
    ],
    default_rule: "gauss_27",
    full_rule: "gauss_125",
    mass_rule: "gauss_27",
    slack,
};

pub(super) static HEX20: ElementEntry = ElementEntry {
    name: "hex20",
    summary: "quadratic hexahedron of the serendipity family; the most accurate in bending",
    source: "Dhatt & Touzot 1984, §2.6",
    parameters: &[],
    build: &HEX20_DATA,
};

/// Middles of faces in the order of VTK, across x, y and z, and of the cell.
const CENTRES: [[f64; 3]; 7] = [
    [-1.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, -1.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, -1.0],
    [0.0, 0.0, 1.0],
    [0.0, 0.0, 0.0],
];

static HEX27_DATA: Element = Element {
    kind: ElementKind::Hex27,
    corners: ElementKind::Hex8,
    dimension: 3,
    nodes: &followed_by::<27>(HEX20_DATA.nodes, &CENTRES),
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
        Monomial([0, 0, 1, 0]),
        Monomial([1, 0, 1, 0]),
        Monomial([2, 0, 1, 0]),
        Monomial([0, 1, 1, 0]),
        Monomial([1, 1, 1, 0]),
        Monomial([2, 1, 1, 0]),
        Monomial([0, 2, 1, 0]),
        Monomial([1, 2, 1, 0]),
        Monomial([2, 2, 1, 0]),
        Monomial([0, 0, 2, 0]),
        Monomial([1, 0, 2, 0]),
        Monomial([2, 0, 2, 0]),
        Monomial([0, 1, 2, 0]),
        Monomial([1, 1, 2, 0]),
        Monomial([2, 1, 2, 0]),
        Monomial([0, 2, 2, 0]),
        Monomial([1, 2, 2, 0]),
        Monomial([2, 2, 2, 0]),
    ],
    faces: FACES,
    edges: &EDGES,
    mirrored: MIRRORED,
    measure: 8.0,
    rules: HEX20_DATA.rules,
    default_rule: "gauss_27",
    full_rule: "gauss_125",
    mass_rule: "gauss_27",
    slack,
};

pub(super) static HEX27: ElementEntry = ElementEntry {
    name: "hex27",
    summary: "triquadratic hexahedron, nodes in its faces and its middle; full quadratics on crooked cells too",
    source: "Dhatt & Touzot 1984, §2.6",
    parameters: &[],
    build: &HEX27_DATA,
};
