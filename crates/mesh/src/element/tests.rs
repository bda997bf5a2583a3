//! Laws that every element of the table obeys.

use souple_math::Vec3;

use super::*;

/// Points inside the reference cell, away from its boundary.
fn samples(kind: ElementKind) -> Vec<Vec3> {
    let finest = kind.rules().last().unwrap();
    finest.points.iter().map(|point| point.position).collect()
}

#[test]
fn table_agrees_with_the_kinds() {
    assert_eq!(ELEMENTS.entries.len(), ElementKind::ALL.len());
    for (entry, kind) in ELEMENTS.entries.iter().zip(ElementKind::ALL.iter().copied()) {
        let element = entry.build;
        assert_eq!(element.kind, kind);
        assert_eq!(ElementKind::from_name(entry.name), Ok(kind));
        assert_eq!(element.nodes.len(), kind.node_count());
        assert_eq!(element.basis.len(), kind.node_count());
        let [default, full, mass] = [kind.default_rule(), kind.full_rule(), kind.mass_rule()];
        assert!(default.points.len() <= full.points.len() && default.points.len() <= mass.points.len());
    }
    assert_eq!(ElementKind::from_name("tet5").unwrap_err().nearest.as_deref(), Some("tet4"));
}

/// The dimension that an element states is that of what its corners span: coplanar ones are a surface. They are its first nodes, and no
/// two elements are of one kind.
#[test]
fn dimension_is_the_rank_of_the_corners() {
    let mut kinds: Vec<ElementKind> = ELEMENTS.entries.iter().map(|entry| entry.build.kind).collect();
    for &kind in &kinds {
        let element = kind.element();
        let corners = kind.corners().element().nodes;
        assert_eq!(&element.nodes[..kind.corner_count()], corners, "{kind}");
        let at = |node: &[f64; 3]| Vec3::from_array(*node);
        let mut spanned: Vec<Vec3> = Vec::new();
        for corner in corners {
            let difference = at(corner) - at(&corners[0]);
            let rest = spanned.iter().fold(difference, |rest, axis| rest - *axis * axis.dot(rest));
            // coordinates are multiples of a half and more
            if rest.length() > 0.1 {
                spanned.push(rest * (1.0 / rest.length()));
            }
        }
        assert_eq!(spanned.len(), element.dimension, "{kind}");
        assert_eq!(kind.dimension(), spanned.len(), "{kind}");
    }
    kinds.sort();
    kinds.dedup();
    assert_eq!(kinds.len(), ELEMENTS.entries.len());
}

/// What is told of an element follows from its data: boxes are quadrilaterals and hexahedra of first order, and a
/// pressure on a flat or curved side is integrated exactly by the rule of its mass.
#[test]
fn uses_follow_from_the_data() {
    for &kind in ElementKind::ALL {
        let element = kind.element();
        let name = kind.name();
        assert_eq!(kind.box_corners().is_some(), ["quad4", "hex8"].contains(&name), "{name}");
        if let Some(corners) = kind.box_corners() {
            for (corner, at) in corners.into_iter().zip([-1.0, 1.0]) {
                assert!(element.nodes[corner][..element.dimension].iter().all(|x| *x == at), "{name}");
            }
        }
        if element.dimension != 2 {
            continue;
        }
        // a curved side: N (x_ξ × x_η) by the rule of the mass and by the finest
        let bent = |node: usize| {
            let [x, y, _] = element.nodes[node];
            Vec3::new(x + 0.1 * y * y, y - 0.2 * x * y, 0.3 * x * x - 0.15 * y * y + 0.2 * x * y)
        };
        let integral = |rule: &QuadratureRule| -> Vec<Vec3> {
            let mut sums = vec![Vec3::ZERO; kind.node_count()];
            for point in &rule.points {
                let (shape, gradients) = (kind.shape(point.position), kind.shape_gradients(point.position));
                let along = |axis: fn(&Vec3) -> f64| {
                    (0..kind.node_count())
                        .map(|node| bent(node) * axis(&gradients[node]))
                        .fold(Vec3::ZERO, |a, b| a + b)
                };
                let normal = along(|g| g.x).cross(along(|g| g.y));
                for (node, sum) in sums.iter_mut().enumerate() {
                    *sum += normal * (shape[node] * point.weight);
                }
            }
            sums
        };
        let finest = kind.rules().last().expect("an element has rules");
        for (ours, exact) in integral(kind.mass_rule()).into_iter().zip(integral(finest)) {
            // a few tens of products of numbers near one
            assert!((ours - exact).length() < 1e-13, "{name}: {ours:?} {exact:?}");
        }
    }
}

/// `N_a(ξ_b) = δ_ab`.
#[test]
fn shape_functions_are_one_at_their_node() {
    for kind in ElementKind::ALL.iter().copied() {
        for (b, node) in kind.element().nodes.iter().enumerate() {
            for (a, value) in kind.shape(Vec3::from_array(*node)).iter().enumerate() {
                let expected = if a == b { 1.0 } else { 0.0 };
                // coefficients of the inverse are halves, quarters, eighths: what is left is their sums' rounding
                assert!((value - expected).abs() < 4e-15, "{kind}: N_{a} at node {b} is {value}");
            }
        }
    }
}

/// `Σ N_a = 1`, `Σ ∂N_a = 0`, and linear fields are reproduced: `Σ N_a ξ_a = ξ`.
#[test]
fn shape_functions_reproduce_linear_fields() {
    for kind in ElementKind::ALL.iter().copied() {
        let nodes: Vec<Vec3> = kind.element().nodes.iter().map(|node| Vec3::from_array(*node)).collect();
        for xi in samples(kind) {
            assert!((kind.shape(xi).iter().sum::<f64>() - 1.0).abs() < 1e-14);
            assert!(kind.shape_gradients(xi).iter().copied().sum::<Vec3>().length() < 1e-14);
            assert!((kind.position(&nodes, xi) - xi).length() < 1e-14);
        }
    }
}

/// Gradients are the central differences of the shape functions, to O(h²) of their third derivatives.
#[test]
fn gradients_are_differences() {
    let h = 1e-5;
    for kind in ElementKind::ALL.iter().copied() {
        for xi in samples(kind) {
            let gradients = kind.shape_gradients(xi);
            for axis in 0..kind.dimension() {
                let step = Vec3::AXES[axis] * h;
                let (ahead, behind) = (kind.shape(xi + step), kind.shape(xi - step));
                for a in 0..kind.node_count() {
                    let difference = (ahead[a] - behind[a]) / (2.0 * h);
                    // rounding 1e-16/h = 1e-11, and h²/6 times the third derivative 6ξη/(1-ζ)⁴, below 6/(1-ζ)² = 600
                    assert!((gradients[a][axis] - difference).abs() < 1e-7, "{kind} {a} {axis}");
                }
            }
        }
    }
}

/// The value at the apex of a pyramid is its node's, and the gradient there is finite.
#[test]
fn pyramid_at_its_apex() {
    let apex = Vec3::Z;
    assert_eq!(ElementKind::Pyramid5.shape(apex)[4], 1.0);
    assert!(ElementKind::Pyramid5.shape_gradients(apex).iter().all(|gradient| gradient.is_finite()));
}

/// Every rule integrates every monomial up to its degree, has positive weights and lies inside the cell.
#[test]
fn quadrature_is_exact_to_its_degree() {
    for kind in ElementKind::ALL.iter().copied() {
        for rule in kind.rules() {
            let weights: f64 = rule.points.iter().map(|point| point.weight).sum();
            assert!(
                (weights - kind.element().measure).abs() < 1e-14 * kind.element().measure.max(1.0),
                "{kind} {}",
                rule.name
            );
            assert_eq!(rule.name, format!("gauss_{}", rule.points.len()));
            for point in &rule.points {
                assert!(
                    point.weight > 0.0 && (kind.element().slack)(point.position) > 0.0,
                    "{kind} {}",
                    rule.name
                );
            }
            for (x, y, z) in exponents(rule.degree, kind.dimension()) {
                let monomial = Monomial([x, y, z, 0]);
                let measured: f64 =
                    rule.points.iter().map(|point| point.weight * monomial.value(point.position)).sum();
                let expected = exact(kind, x.into(), y.into(), z.into());
                // published points have sixteen digits, of which a power of degree d loses d units of the last
                assert!((measured - expected).abs() < 2e-14, "{kind} {} {monomial:?}: {measured}", rule.name);
            }
        }
    }
}

/// Rules of the conical product also integrate the rational functions that pyramids are made of.
#[test]
fn quadrature_of_rational_functions() {
    for (name, base_degree) in [("gauss_4", 3), ("gauss_8", 3), ("gauss_9", 5), ("gauss_27", 5)] {
        for (r, s) in (0..=base_degree).flat_map(|r| (0..=base_degree).map(move |s| (r, s))) {
            // ∫ (ξ/(1-ζ))^r (η/(1-ζ))^s dξ = ⅓ ∫∫ a^r b^s
            let expected = line(r) * line(s) / 3.0;
            let monomial = Monomial([r as u8, s as u8, 0, (r + s) as u8]);
            let rule = ElementKind::Pyramid5.rule(name).unwrap();
            let measured: f64 = rule.points.iter().map(|p| p.weight * monomial.value(p.position)).sum();
            assert!((measured - expected).abs() < 1e-14, "{name} {r} {s}");
        }
    }
}

fn exponents(degree: usize, dimension: usize) -> Vec<(u8, u8, u8)> {
    let d = degree as u8;
    let [widest, deepest] = [2, 3].map(|needed| if dimension < needed { 0 } else { d });
    let all = (0..=d).flat_map(|x| (0..=widest).flat_map(move |y| (0..=deepest).map(move |z| (x, y, z))));
    all.filter(|(x, y, z)| x + y + z <= d).collect()
}

fn factorial(n: usize) -> f64 {
    (1..=n).map(|k| k as f64).product()
}

/// `∫_{-1}^{1} x^n dx`.
fn line(n: usize) -> f64 {
    if n % 2 == 1 { 0.0 } else { 2.0 / (n + 1) as f64 }
}

/// Exact integral of a monomial over the reference cell.
fn exact(kind: ElementKind, x: usize, y: usize, z: usize) -> f64 {
    // simplices: x! y! z! / (x + y + z + d)!
    let triangle = factorial(x) * factorial(y) / factorial(x + y + 2);
    match kind.corners() {
        ElementKind::Edge2 => line(x),
        ElementKind::Tri3 => triangle,
        ElementKind::Quad4 => line(x) * line(y),
        ElementKind::Tet4 => factorial(x) * factorial(y) * factorial(z) / factorial(x + y + z + 3),
        ElementKind::Hex8 => line(x) * line(y) * line(z),
        ElementKind::Prism6 => triangle * line(z),
        // ∫ ζ^z (1-ζ)^(x+y+2) dζ = z! (x+y+2)! / (x+y+z+3)!
        ElementKind::Pyramid5 => {
            line(x) * line(y) * factorial(z) * factorial(x + y + 2) / factorial(x + y + z + 3)
        }
        other => unreachable!("{other} is not linear"),
    }
}

/// Faces have outward normals, and their edges cover the edges of the cell, each twice.
#[test]
fn faces_are_closed_and_outward() {
    for kind in ElementKind::ALL.iter().copied().filter(|kind| kind.dimension() == 3) {
        let nodes: Vec<Vec3> = kind.element().nodes.iter().map(|node| Vec3::from_array(*node)).collect();
        let centre = nodes.iter().copied().sum::<Vec3>() / nodes.len() as f64;
        let mut directed = Vec::new();
        for face in kind.faces() {
            let ring = &face.nodes[..face.kind.corner_count()];
            let corners: Vec<Vec3> = ring.iter().map(|node| nodes[usize::from(*node)]).collect();
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            assert!(normal.dot(corners[0] - centre) > 0.0, "{kind} {face:?}");
            let sides = ring.iter().zip(ring.iter().cycle().skip(1));
            directed.extend(sides.map(|(a, b)| [*a, *b]));
        }
        assert_eq!(directed.len(), 2 * kind.edges().len());
        for [a, b] in kind.edges() {
            assert!(directed.contains(&[*a, *b]) && directed.contains(&[*b, *a]), "{kind} {a} {b}");
        }
    }
}

/// The mirrored order turns the sign of the Jacobian determinant on the whole cell.
#[test]
fn mirrored_order_turns_the_cell() {
    for kind in ElementKind::ALL.iter().copied().filter(|kind| kind.dimension() == 3) {
        let node = |a: &u8| Vec3::from_array(kind.element().nodes[usize::from(*a)]);
        let positions: Vec<Vec3> = kind.mirrored().iter().map(node).collect();
        for xi in samples(kind) {
            assert!(kind.jacobian(&positions, xi).determinant() < 0.0, "{kind}");
        }
    }
}

/// Elements with nodes on their edges reproduce quadratic fields; their nodes are those of the linear one, the middles of its
/// edges in their order, and those of faces and of the cell.
#[test]
fn quadratic_elements_hold_all_quadratics() {
    let field = |x: Vec3| 1.0 + x.x - 2.0 * x.y + x.x * x.x - x.y * x.z + 3.0 * x.z * x.z + x.x * x.y;
    for kind in ElementKind::ALL.iter().copied().filter(|kind| !kind.is_linear()) {
        let nodes: Vec<Vec3> = kind.element().nodes.iter().map(|node| Vec3::from_array(*node)).collect();
        let [corners, of_edges, others] = kind.by_place(&nodes);
        assert_eq!((corners.len(), of_edges.len()), (kind.corner_count(), kind.edges().len()), "{kind}");
        assert_eq!(corners.len() + of_edges.len() + others.len(), nodes.len(), "{kind}");
        for (node, [a, b]) in of_edges.iter().zip(kind.edges()) {
            assert_eq!(*node, (nodes[usize::from(*a)] + nodes[usize::from(*b)]) * 0.5, "{kind}");
        }
        let places: Vec<NodePlace> = (0..nodes.len()).map(|node| kind.place(node)).collect();
        assert!(places.is_sorted(), "{kind}: {places:?}");
        assert_eq!(kind.with_middles(kind.last_place()), kind);
        assert_eq!(kind.with_middles(NodePlace::Corner), kind.corners());
        for xi in samples(kind) {
            let value: f64 =
                kind.shape(xi).iter().zip(&nodes).map(|(weight, node)| weight * field(*node)).sum();
            // twenty terms of size 10
            assert!((value - field(xi)).abs() < 1e-13, "{kind} at {xi:?}: {value}");
        }
    }
}

/// On each face the shape functions of its nodes are those of the face's own element, and the others vanish: neighbours
/// that share the nodes of a face fit.
#[test]
fn shape_functions_on_faces_are_those_of_the_face() {
    for kind in ElementKind::ALL.iter().copied() {
        let nodes: Vec<Vec3> = kind.element().nodes.iter().map(|node| Vec3::from_array(*node)).collect();
        for face in kind.faces() {
            let places: Vec<Vec3> = face.nodes.iter().map(|node| nodes[usize::from(*node)]).collect();
            for eta in samples(face.kind) {
                let on_face = face.kind.shape(eta);
                let in_cell = kind.shape(face.kind.position(&places, eta));
                for (a, value) in in_cell.iter().enumerate() {
                    let own = face.nodes.iter().position(|node| usize::from(*node) == a);
                    let expected = own.map_or(0.0, |b| on_face[b]);
                    assert!((value - expected).abs() < 1e-13, "{kind} {face:?}: N_{a} is {value}");
                }
            }
        }
    }
}

/// On crooked cells of straight edges those with nodes in faces and inside hold all quadratics of the world, which those with nodes on edges
/// alone do not.
#[test]
fn crooked_cells_hold_quadratics() {
    let shift = |x: Vec3| {
        Vec3::new((3.0 * x.x + x.y + 0.5).sin(), (2.0 * x.y - x.x + 0.3).cos(), (x.x * x.z + x.y + 0.7).sin())
    };
    let field = |x: Vec3| 1.0 + x.x - 2.0 * x.y + x.x * x.x - x.y * x.z + 3.0 * x.z * x.z + x.x * x.y;
    for (name, is_exact) in [("quad8", false), ("quad9", true), ("hex20", false), ("hex27", true)] {
        let kind = ElementKind::from_name(name).unwrap();
        let crooked = |xi: Vec3| xi + shift(xi) * 0.2;
        let node = |xi: &[f64; 3]| Vec3::from_array(*xi);
        let corners: Vec<Vec3> = kind.corners().element().nodes.iter().map(|xi| crooked(node(xi))).collect();
        let straight = |xi: Vec3| kind.corners().position(&corners, xi);
        let values: Vec<f64> = kind.element().nodes.iter().map(|xi| field(straight(node(xi)))).collect();
        let off = |xi: Vec3| {
            let found: f64 = kind.shape(xi).iter().zip(&values).map(|(weight, value)| weight * value).sum();
            (found - field(straight(xi))).abs()
        };
        let worst = samples(kind).into_iter().map(off).fold(0.0, f64::max);
        assert_eq!(worst < 1e-13, is_exact, "{name}: {worst:e}");
    }
}
