//! Edges, `ξ ∈ [-1, 1]`: cells of bars and cables, sides of plane cells.

use souple_math::Vec3;

use super::{Element, ElementEntry, ElementKind, Monomial, with_middles};
use crate::quadrature::{RuleDefinition, line};

const NODES: [[f64; 3]; 2] = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
/// The regular cell.
const REGULAR: &[[f64; 3]] = &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
/// The middle node of a quadratic element on an edge has the number of the corners and that of the edge.
const EDGES: [[u8; 2]; 1] = [[0, 1]];
const MIRRORED: &[u8] = &[1, 0];

fn slack(xi: Vec3) -> f64 {
    1.0 - xi.x.abs()
}

static EDGE2_DATA: Element = Element {
    kind: ElementKind::Edge2,
    corners: ElementKind::Edge2,
    dimension: 1,
    nodes: &NODES,
    regular: REGULAR,
    basis: &[Monomial([0, 0, 0, 0]), Monomial([1, 0, 0, 0])],
    faces: &[],
    edges: &EDGES,
    mirrored: MIRRORED,
    measure: 2.0,
    rules: &[
        RuleDefinition { name: "gauss_1", degree: 1, points: || line(1) },
        RuleDefinition { name: "gauss_2", degree: 3, points: || line(2) },
        RuleDefinition { name: "gauss_3", degree: 5, points: || line(3) },
    ],
    default_rule: "gauss_1",
    full_rule: "gauss_1",
    mass_rule: "gauss_2",
    slack,
};

pub(super) static EDGE2: ElementEntry = ElementEntry {
    name: "edge2",
    summary: "straight edge; bars and cables",
    source: "Dhatt & Touzot 1984, §2.2",
    parameters: &[],
    build: &EDGE2_DATA,
};

static EDGE3_DATA: Element = Element {
    kind: ElementKind::Edge3,
    corners: ElementKind::Edge2,
    dimension: 1,
    nodes: &with_middles::<2, 1, 3>(&NODES, &EDGES),
    regular: REGULAR,
    basis: &[Monomial([0, 0, 0, 0]), Monomial([1, 0, 0, 0]), Monomial([2, 0, 0, 0])],
    faces: &[],
    edges: &EDGES,
    mirrored: MIRRORED,
    measure: 2.0,
    rules: &[
        RuleDefinition { name: "gauss_2", degree: 3, points: || line(2) },
        RuleDefinition { name: "gauss_3", degree: 5, points: || line(3) },
    ],
    default_rule: "gauss_2",
    full_rule: "gauss_3",
    mass_rule: "gauss_3",
    slack,
};

pub(super) static EDGE3: ElementEntry = ElementEntry {
    name: "edge3",
    summary: "quadratic edge; curved bars and cables",
    source: "Dhatt & Touzot 1984, §2.2",
    parameters: &[],
    build: &EDGE3_DATA,
};
