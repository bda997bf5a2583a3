//! The pyramid with five nodes: base `[-1, 1]²` at `ζ = 0`, apex `(0, 0, 1)`; `|ξ|, |η| ≤ 1 - ζ`.
//!
//! `N_base = ¼ (1 - ζ ± ξ ± η ± ξη/(1-ζ))`, `N_apex = ζ`: bilinear on the base, linear on the triangles, so that
//! it joins hexahedra to tetrahedra. Smooth except at the apex, where the gradient depends on the direction.

use std::f64::consts::FRAC_1_SQRT_2;
use std::sync::LazyLock;

use super::{Derived, Element, ElementEntry, ElementKind, Face, Monomial};
use crate::quadrature::{RuleDefinition, pyramid, pyramid_five};

static DERIVED: LazyLock<Derived> = LazyLock::new(|| DATA.derive());

static DATA: Element = Element {
    kind: ElementKind::Pyramid5,
    dimension: 3,
    nodes: &[[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    regular: &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.5, 0.5, FRAC_1_SQRT_2]],
    basis: &[
        Monomial([0, 0, 0, 0]),
        Monomial([1, 0, 0, 0]),
        Monomial([0, 1, 0, 0]),
        Monomial([0, 0, 1, 0]),
        Monomial([1, 1, 0, 1]),
    ],
    faces: &[
        Face { kind: ElementKind::Quad4, nodes: &[0, 3, 2, 1] },
        Face { kind: ElementKind::Tri3, nodes: &[0, 1, 4] },
        Face { kind: ElementKind::Tri3, nodes: &[1, 2, 4] },
        Face { kind: ElementKind::Tri3, nodes: &[2, 3, 4] },
        Face { kind: ElementKind::Tri3, nodes: &[3, 0, 4] },
    ],
    edges: &[[0, 1], [1, 2], [2, 3], [3, 0], [0, 4], [1, 4], [2, 4], [3, 4]],
    mirrored: &[0, 3, 2, 1, 4],
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
    slack: |xi| xi.z.min(1.0 - xi.z - xi.x.abs().max(xi.y.abs())),
    derived: &DERIVED,
};

pub(super) static PYRAMID5: ElementEntry = ElementEntry {
    name: "pyramid5",
    summary: "rational pyramid: bilinear base, linear sides; joins hexes to tets",
    source: "Bedrosian 1992; Dhatt & Touzot 1984",
    parameters: &[],
    build: &DATA,
};
