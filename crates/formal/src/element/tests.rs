//! Counts of the source, forces against energies, cuts against the whole.

use std::collections::HashMap;

use super::*;
use crate::graph::{Expr, Graph};
use crate::law::{EnergyLaw, LawParameter, LawText};

fn law(energy: &str) -> EnergyLaw {
    let number = |name: &str, value| (name.to_owned(), LawParameter::Number { value, dimension: None });
    let parameters = vec![number("lambda", 5.0), number("mu", 3.0)];
    EnergyLaw::compile(&LawText { energy: energy.to_owned(), definitions: Vec::new(), parameters }).unwrap()
}

const HOOKE: &str = "lambda/2*tr(eps)^2 + mu*dot(eps, eps)";
const STVK: &str = "lambda/2*tr(E)^2 + mu*dot(E, E)";
const NEO_HOOKEAN: &str = "mu/2*(I1 - 3) - mu*log(J) + lambda/2*log(J)^2";

const CONSTANT: [u8; 4] = [0; 4];
const XI: [u8; 4] = [1, 0, 0, 0];
const ETA: [u8; 4] = [0, 1, 0, 0];
const ZETA: [u8; 4] = [0, 0, 1, 0];

fn triangle() -> ElementData {
    let gradients = vec![[-1.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let samples = vec![Sample { position: [1.0 / 3.0, 1.0 / 3.0, 0.0], weight: 0.5, gradients }];
    let shapes = vec![vec![(1.0, CONSTANT), (-1.0, XI), (-1.0, ETA)], vec![(1.0, XI)], vec![(1.0, ETA)]];
    ElementData { name: "Triangle".into(), dimension: 2, node_count: 3, shapes, samples, map: RestMap::Nodes }
}

fn tetrahedron() -> ElementData {
    let gradients = vec![[-1.0, -1.0, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let samples = vec![Sample { position: [0.25; 3], weight: 1.0 / 6.0, gradients }];
    let first = vec![(1.0, CONSTANT), (-1.0, XI), (-1.0, ETA), (-1.0, ZETA)];
    let shapes = vec![first, vec![(1.0, XI)], vec![(1.0, ETA)], vec![(1.0, ZETA)]];
    ElementData { name: "Tetra".into(), dimension: 3, node_count: 4, shapes, samples, map: RestMap::Nodes }
}

/// Quadrilateral of 2×2 Gauss points.
fn quadrilateral(map: RestMap) -> ElementData {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let g = 1.0 / 3f64.sqrt();
    let samples = corners.map(|[x, y]| Sample {
        position: [x * g, y * g, 0.0],
        weight: 1.0,
        gradients: corners
            .map(|[a, b]| [0.25 * a * (1.0 + b * y * g), 0.25 * b * (1.0 + a * x * g), 0.0])
            .to_vec(),
    });
    let shapes = corners
        .map(|[a, b]| vec![(0.25, CONSTANT), (0.25 * a, XI), (0.25 * b, ETA), (0.25 * a * b, [1, 1, 0, 0])])
        .to_vec();
    ElementData { name: "Quad".into(), dimension: 2, node_count: 4, shapes, samples: samples.to_vec(), map }
}

/// Hexahedron of 2×2×2 Gauss points.
fn hexahedron(map: RestMap) -> ElementData {
    let corners = [-1.0, 1.0].map(|z| [[-1.0, -1.0, z], [1.0, -1.0, z], [1.0, 1.0, z], [-1.0, 1.0, z]]);
    let corners = corners.concat();
    let g = 1.0 / 3f64.sqrt();
    let gradient = |corner: &[f64; 3], at: [f64; 3]| {
        let factor = |axis: usize| 1.0 + corner[axis] * at[axis];
        [0, 1, 2].map(|k| 0.125 * corner[k] * factor((k + 1) % 3) * factor((k + 2) % 3))
    };
    let samples = corners.iter().map(|corner| {
        let position = corner.map(|side| side * g);
        let gradients = corners.iter().map(|corner| gradient(corner, position)).collect();
        Sample { position, weight: 1.0, gradients }
    });
    let shape = |[a, b, c]: [f64; 3]| {
        let constants = vec![(1.0, CONSTANT), (a, XI), (b, ETA), (c, ZETA)];
        let products = vec![
            (a * b, [1, 1, 0, 0]),
            (b * c, [0, 1, 1, 0]),
            (a * c, [1, 0, 1, 0]),
            (a * b * c, [1, 1, 1, 0]),
        ];
        constants.into_iter().chain(products).map(|(factor, powers)| (0.125 * factor, powers)).collect()
    };
    let shapes = corners.iter().map(|corner| shape(*corner)).collect();
    ElementData { name: "Hexa".into(), dimension: 3, node_count: 8, shapes, samples: samples.collect(), map }
}

/// Values of expressions for rest positions, displacements and variations without symmetry.
fn values(graph: &Graph, roots: &[Expr], moved: Option<(usize, usize, f64)>) -> Vec<f64> {
    let unit = [[0.0, 0.0, 0.0], [1.1, 0.1, 0.0], [0.9, 1.2, 0.1], [0.05, 0.95, 1.0]];
    let mut known: HashMap<String, f64> = HashMap::from([("lambda".to_owned(), 5.0), ("mu".to_owned(), 3.0)]);
    for (node, rest) in unit.iter().enumerate() {
        for (axis, name) in ["x", "y", "z"].iter().enumerate() {
            let wave = |phase: f64| 0.1 * (2.0 * node as f64 + 3.0 * axis as f64 + phase).sin();
            // triangles and tetrahedra take other nodes of the same quadrilateral
            known.insert(format!("@P{node}{name}"), rest[axis]);
            known.insert(format!("@U{node}{name}"), wave(0.3));
            known.insert(format!("@V{node}{name}"), wave(1.7));
        }
    }
    if let Some((node, axis, by)) = moved {
        *known.get_mut(&format!("@U{node}{}", ["x", "y", "z"][axis])).unwrap() += by;
    }
    let known: HashMap<String, [f64; 1]> = known.into_iter().map(|(name, value)| (name, [value])).collect();
    let evaluation = graph.evaluate(roots, |symbol| &known[&symbol.name][..]);
    roots.iter().map(|root| evaluation.scalar(*root)).collect()
}

fn sum_of(fragments: &[ElementExpressions], graph: &Graph, moved: Option<(usize, usize, f64)>) -> Vec<f64> {
    let mut sum = vec![0.0; fragments[0].raw.len()];
    for fragment in fragments {
        for (sum, value) in sum.iter_mut().zip(values(graph, &fragment.raw, moved)) {
            *sum += value;
        }
    }
    sum
}

fn counts(element: &ElementData, energy: &str, cut: Cut) -> Vec<usize> {
    let derived = element.derive(&law(energy), cut);
    derived.energies.iter().map(|fragment| fragment.grouped.constants.len()).collect()
}

/// Tables 3.4 to 3.7: 6 constants of a triangle and 11 of a tetrahedron under both laws; cut by the terms of the law
/// 5 and 10 in each fragment.
#[test]
fn counts_of_the_source() {
    for energy in [HOOKE, STVK] {
        assert_eq!(counts(&triangle(), energy, Cut::NONE), [6]);
        assert_eq!(counts(&tetrahedron(), energy, Cut::NONE), [11]);
        assert_eq!(counts(&triangle(), energy, Cut::ALL), [5, 5]);
        assert_eq!(counts(&tetrahedron(), energy, Cut::ALL), [10, 10]);
    }
    // an axis-aligned rectangle needs its two edges and two factors, whatever the number of samples
    assert_eq!(counts(&quadrilateral(RestMap::Box { low: 0, high: 2 }), STVK, Cut::NONE), [4]);
    // any law needs no more than its moduli in place of these two
    assert_eq!(counts(&tetrahedron(), NEO_HOOKEAN, Cut::NONE), [11]);
}

/// `f = -∂W/∂U` and `δf = (∂f/∂U) V`, against differences.
#[test]
fn forces_are_slopes() {
    let h = 1e-5;
    for element in [triangle(), tetrahedron(), quadrilateral(RestMap::Nodes)] {
        for energy in [HOOKE, STVK, NEO_HOOKEAN] {
            let derived = element.derive(&law(energy), Cut::NONE);
            let graph = &derived.graph;
            let forces = sum_of(&derived.forces, graph, None);
            let differentials = sum_of(&derived.differentials, graph, None);
            let variations: Vec<Expr> = derived.symbols.variations.iter().flatten().copied().collect();
            let variations = values(graph, &variations, None);
            let mut numeric = vec![0.0; forces.len()];
            for (index, variation) in variations.iter().enumerate() {
                let place = (index / element.dimension, index % element.dimension);
                let at = |by: f64| Some((place.0, place.1, by));
                let energy = |by| sum_of(&derived.energies, graph, at(by))[0];
                let slope = (energy(h) - energy(-h)) / (2.0 * h);
                // h² of third derivatives of some tens
                assert!((slope + forces[index]).abs() < 1e-7, "{}: {slope} {}", element.name, forces[index]);
                let (plus, minus) =
                    (sum_of(&derived.forces, graph, at(h)), sum_of(&derived.forces, graph, at(-h)));
                for (sum, (a, b)) in numeric.iter_mut().zip(plus.iter().zip(&minus)) {
                    *sum += variation * (a - b) / (2.0 * h);
                }
            }
            for (numeric, derived) in numeric.iter().zip(&differentials) {
                assert!((numeric - derived).abs() < 1e-7, "{}: {numeric} {derived}", element.name);
            }
        }
    }
}

/// A box by its own map and by its nodes: the same energies, forces and differentials, by fewer operations.
#[test]
fn fields_of_boxes_are_those_of_their_nodes() {
    let numbers = |symbol: &crate::graph::Symbol| -> f64 {
        let name = symbol.name.trim_start_matches('@');
        let corner =
            |node: usize| [u8::from(matches!(node % 4, 1 | 2)), u8::from(node % 4 > 1), u8::from(node > 3)];
        let (node, axis) = (name[1..name.len() - 1].parse().unwrap_or(0), name.bytes().last());
        let axis = usize::from(axis.map_or(0, |letter| letter.saturating_sub(b'x')).min(2));
        let wave = |phase: f64| 0.1 * (2.0 * node as f64 + 3.0 * axis as f64 + phase).sin();
        match name.bytes().next() {
            Some(b'P') => [1.1, 0.9, 1.3][axis] * f64::from(corner(node)[axis]),
            Some(b'U') => wave(0.3),
            Some(b'V') => wave(1.7),
            _ => [5.0, 3.0][usize::from(name == "mu")],
        }
    };
    for energy in [HOOKE, STVK, NEO_HOOKEAN] {
        let both = [RestMap::Box { low: 0, high: 6 }, RestMap::Nodes].map(|map| {
            let derived = hexahedron(map).derive(&law(energy), Cut::NONE);
            let lists = [&derived.energies, &derived.forces, &derived.differentials];
            let roots: Vec<Expr> = lists.iter().flat_map(|list| list[0].raw.clone()).collect();
            let evaluation = derived.graph.evaluate(&roots, |symbol| {
                // leaked: a few hundred numbers for the length of a test
                std::slice::from_ref(Box::leak(Box::new(numbers(symbol))))
            });
            let values: Vec<f64> = roots.iter().map(|root| evaluation.scalar(*root)).collect();
            (values, derived.differentials[0].operations(&derived.graph).0.total())
        });
        let [(of_box, box_count), (of_nodes, node_count)] = both;
        let scale = of_nodes.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        for (a, b) in of_box.iter().zip(&of_nodes) {
            // some hundred roundings
            assert!((a - b).abs() <= 1e-13 * scale, "{energy}: {a} {b}");
        }
        assert!(box_count < node_count, "{energy}: {box_count} {node_count}");
    }
}

/// All sixteen cuts: names, numbers of fragments, and fragments that add up to the whole.
#[test]
fn fragments_add_up() {
    let element = quadrilateral(RestMap::Nodes);
    let law = law(STVK);
    let whole = element.derive(&law, Cut::NONE);
    let (forces, differentials) =
        (sum_of(&whole.forces, &whole.graph, None), sum_of(&whole.differentials, &whole.graph, None));
    let mut names = Vec::new();
    for cut in Cut::every() {
        let derived = element.derive(&law, cut);
        let count = |axis: Axis, pieces: usize| if cut.has(axis) { pieces } else { 1 };
        let of_forces = count(Axis::Law, 2) * count(Axis::Gauss, 4);
        assert_eq!(derived.forces.len(), of_forces);
        assert_eq!(
            derived.differentials.len(),
            of_forces * count(Axis::Nodes, 4) * count(Axis::Dimension, 2)
        );
        for (whole, fragments) in [(&forces, &derived.forces), (&differentials, &derived.differentials)] {
            let sum = sum_of(fragments, &derived.graph, None);
            let scale = whole.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
            assert!(whole.iter().zip(&sum).all(|(a, b)| (a - b).abs() <= 1e-12 * scale), "{cut}");
        }
        // every fragment has its own constants: cutting never needs fewer
        let constants =
            |list: &[ElementExpressions]| -> usize { list.iter().map(|f| f.grouped.constants.len()).sum() };
        assert!(constants(&derived.forces) >= constants(&whole.forces), "{cut}");
        assert_eq!(Cut::from_name(&cut.to_string()), Some(cut));
        names.push(cut.to_string());
    }
    for name in ["DecoupageNon", "DecoupageTout", "DecoupageLN", "DecoupageG"] {
        assert!(names.iter().any(|known| known == name), "{name}");
    }
    assert_eq!(Cut::from_name("X"), None);
}

/// The examples of the source.
#[test]
fn fragments_have_the_names_of_the_source() {
    let cut = Cut::of(&[Axis::Law, Axis::Nodes]);
    let name = Derivative::Differential.constants_name(&format!("HookeHexa8I{cut}"), 4);
    assert_eq!(name, "ECR_dFHookeHexa8IDecoupageLN4");
    let name = Derivative::Force.expression_name(&format!("HookeTriangle{}", Cut::NONE), 0, 0, 0);
    assert_eq!(name, "FHookeTriangleDecoupageNon0_0x");
}

/// EXP-1: the differential on a rectangle derived in the reference frame and written out has at most a third of the operands of the
/// same derived in physical coordinates, where each shape function brings its own nodes along.
#[test]
fn the_reference_frame_is_shorter() {
    let element = quadrilateral(RestMap::Box { low: 0, high: 2 });
    let derived = element.derive(&law(HOOKE), Cut::NONE);
    let direct = element.derive_directly(&law(HOOKE)).unwrap();
    // the same numbers
    let ours = values(&derived.graph, &derived.differentials[0].raw, None);
    let theirs = values(&direct.graph, &direct.differential, None);
    for (a, b) in ours.iter().zip(&theirs) {
        assert!((a - b).abs() <= 1e-13 * a.abs().max(1.0), "{ours:?} {theirs:?}");
    }
    let (of_reference, of_direct) = (derived.differentials[0].operands(&derived.graph), direct.operands());
    assert!(3.0 * of_reference <= of_direct, "{of_reference} {of_direct}");
    assert!(quadrilateral(RestMap::Nodes).derive_directly(&law(HOOKE)).is_none());
}

/// A name of a law may be one that the derivation uses itself: forces, steps and code are the same as under another name.
#[test]
fn names_of_laws_are_their_own() {
    let energy = |name: &str| format!("mu/2*(I1 - 3) - mu*log(J) + {name}/2*log(J)^2");
    let compiled = |name: &str| {
        let number = |name: &str, value| (name.to_owned(), LawParameter::Number { value, dimension: None });
        let parameters = vec![number(name, 5.0), number("mu", 3.0)];
        EnergyLaw::compile(&LawText { energy: energy(name), definitions: Vec::new(), parameters }).unwrap()
    };
    let element = tetrahedron();
    let counts = |name: &str| {
        let derived = element.derive(&compiled(name), Cut::NONE);
        let steps = element.steps(&compiled(name), Cut::NONE);
        (
            derived.forces[0].grouped.constants.len(),
            steps.forces[0].constants.len(),
            steps.forces[0].definitions.len(),
        )
    };
    let plain = element.derive(&compiled("k"), Cut::NONE).emit(crate::emit::ElementCode::Rust).text;
    for name in [
        "omega", "weight", "D_0", "U0x", "P0x", "V1y", "a_0", "F_00", "t0", "p", "d", "u", "v", "type", "x_",
        "x",
    ] {
        assert_eq!(counts(name), counts("k"), "{name}");
        let code = element.derive(&compiled(name), Cut::NONE).emit(crate::emit::ElementCode::Rust).text;
        let argument = code.split_once("]; 4]").and_then(|(_, rest)| rest.split_once(": f64")).unwrap().0;
        let argument = argument.trim_start_matches(", ");
        assert!(!["p", "type", "t0"].contains(&argument), "{code}");
        // its name is all that is different
        let spaced = |code: &str| {
            code.replace(['(', ')', ',', '[', ']', '*', '/', ' ', '\n', ';', ':'], " ")
                .split_whitespace()
                .map(str::to_owned)
                .collect::<Vec<_>>()
        };
        let (ours, theirs) = (spaced(&code), spaced(&plain));
        assert_eq!(ours.len(), theirs.len(), "{name}\n{code}");
        for (ours, theirs) in ours.iter().zip(&theirs) {
            assert!(ours == theirs || (ours == argument && theirs == "k"), "{name}: {ours} for {theirs}");
        }
    }
}
