//! Pyramids: base `[-1, 1]²` at `ζ = 0`, apex `(0, 0, 1)`; `|ξ|, |η| ≤ 1 - ζ`.
//!
//! `N_base = ¼ (1 - ζ ± ξ ± η ± ξη/(1-ζ))`, `N_apex = ζ`: bilinear on the base, linear on the triangles, so that
//! the linear one joins hexahedra to tetrahedra; the quadratic one has the same rational functions times linear
//! ones, and all quadratics. Smooth except at the apex, where the gradient depends on the direction.

use souple_math::Vec3;
use std::f64::consts::FRAC_1_SQRT_2;

use super::{Element, ElementEntry, ElementKind, Monomial, with_middles};
use crate::quadrature::{RuleDefinition, pyramid, pyramid_five};

const NODES: [[f64; 3]; 5] =
    [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// The regular cell.
const REGULAR: &[[f64; 3]] =
    &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.5, 0.5, FRAC_1_SQRT_2]];
/// Corners of each face, normal outward.
const FACES: &[&[u8]] = &[&[0, 3, 2, 1], &[0, 1, 4], &[1, 2, 4], &[2, 3, 4], &[3, 0, 4]];
/// The middle node of a quadratic element on an edge has the number of the corners and that of the edge.
const EDGES: [[u8; 2]; 8] = [[0, 1], [1, 2], [2, 3], [3, 0], [0, 4], [1, 4], [2, 4], [3, 4]];
const MIRRORED: &[u8] = &[0, 3, 2, 1, 4];

fn slack(xi: Vec3) -> f64 {
    xi.z.min(1.0 - xi.z - xi.x.abs().max(xi.y.abs()))
}

static PYRAMID5_DATA: Element = Element {
    kind: ElementKind::Pyramid5,
    corners: ElementKind::Pyramid5,
    dimension: 3,
    nodes: &NODES,
    regular: REGULAR,
    basis: &[
        Monomial([0, 0, 0, 0]),
        Monomial([1, 0, 0, 0]),
        Monomial([0, 1, 0, 0]),
        Monomial([0, 0, 1, 0]),
        Monomial([1, 1, 0, 1]),
    ],
    faces: FACES,
    edges: &EDGES,
    mirrored: MIRRORED,
    measure: 4.0 / 3.0,
    rules: &[
        RuleDefinition { name: "gauss_1", degree: 1, points: || pyramid(1, 1) },
        // Gradients of the shape functions, hence F and det J, are polynomials of ξ/(1-ζ) and η/(1-ζ) alone: one
        // point of height integrates the internal forces of every law, on every pyramid, as well as two.
        RuleDefinition { name: "gauss_4", degree: 1, points: || pyramid(2, 1) },
        RuleDefinition { name: "gauss_5", degree: 2, points: pyramid_five },
        RuleDefinition { name: "gauss_8", degree: 3, points: || pyramid(2, 2) },
        RuleDefinition { name: "gauss_9", degree: 1, points: || pyramid(3, 1) },
        RuleDefinition { name: "gauss_27", degree: 5, points: || pyramid(3, 3) },
    ],
    default_rule: "gauss_4",
    full_rule: "gauss_9",
    mass_rule: "gauss_8",
    slack,
};

pub(super) static PYRAMID5: ElementEntry = ElementEntry {
    name: "pyramid5",
    summary: "rational pyramid: bilinear base, linear sides; joins hexes to tets",
    source: "Bedrosian 1992; Dhatt & Touzot 1984",
    parameters: &[],
    build: &PYRAMID5_DATA,
};

static PYRAMID13_DATA: Element = Element {
    kind: ElementKind::Pyramid13,
    corners: ElementKind::Pyramid5,
    dimension: 3,
    nodes: &with_middles::<5, 8, 13>(&NODES, &EDGES),
    regular: REGULAR,
    basis: &[
        Monomial([0, 0, 0, 0]),
        Monomial([1, 0, 0, 0]),
        Monomial([0, 1, 0, 0]),
        Monomial([0, 0, 1, 0]),
        Monomial([1, 1, 0, 1]),
        Monomial([0, 0, 2, 0]),
        Monomial([1, 0, 1, 0]),
        Monomial([0, 1, 1, 0]),
        Monomial([1, 1, 1, 1]),
        Monomial([2, 0, 0, 0]),
        Monomial([0, 2, 0, 0]),
        Monomial([2, 1, 0, 1]),
        Monomial([1, 2, 0, 1]),
    ],
    faces: FACES,
    edges: &EDGES,
    mirrored: MIRRORED,
    measure: 4.0 / 3.0,
    rules: &[
        RuleDefinition { name: "gauss_8", degree: 3, points: || pyramid(2, 2) },
        RuleDefinition { name: "gauss_18", degree: 3, points: || pyramid(3, 2) },
        RuleDefinition { name: "gauss_27", degree: 5, points: || pyramid(3, 3) },
        RuleDefinition { name: "gauss_75", degree: 5, points: || pyramid(5, 3) },
    ],
    default_rule: "gauss_18",
    full_rule: "gauss_75",
    mass_rule: "gauss_27",
    slack,
};

pub(super) static PYRAMID13: ElementEntry = ElementEntry {
    name: "pyramid13",
    summary: "quadratic rational pyramid; joins hex20 to tet10",
    source: "Bedrosian 1992",
    parameters: &[],
    build: &PYRAMID13_DATA,
};
