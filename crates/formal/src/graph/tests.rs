//! Equal expressions are one expression; conversions of the source's examples.

use super::*;

/// Symbols `a`, `b`, `c`.
fn abc(graph: &mut Graph) -> [Expr; 3] {
    ["a", "b", "c"].map(|name| graph.symbol(name, Shape::Scalar))
}

/// `a - (b + c)`, `(a + b)/(a - b)` and `2 (a + b)²` do not know in which order they were written.
#[test]
fn order_does_not_matter() {
    let mut graph = Graph::new();
    let [a, b, c] = abc(&mut graph);
    let (bc, cb) = (graph.add(b, c), graph.add(c, b));
    assert_eq!(bc, cb);
    let minus = graph.negate(cb);
    assert_eq!(graph.subtract(a, bc), graph.sum(&[minus, a]));
    let (ab, ba) = (graph.add(a, b), graph.add(b, a));
    let (difference, inverse) = (graph.subtract(a, b), graph.subtract(a, b));
    let inverse = graph.power_number(inverse, -1.0);
    assert_eq!(graph.divide(ab, difference), graph.product(&[inverse, ba]));
    let two = graph.number(2.0);
    let (square, product) = (graph.power_number(ab, 2.0), graph.product(&[ba, ba]));
    assert_eq!(graph.product(&[two, square]), graph.product(&[product, two]));
}

/// `a^(8/3)/a` is `a^(5/3)`, whose exponent is the double next to it.
#[test]
fn exponents_stay_fractions() {
    let mut graph = Graph::new();
    let [a, ..] = abc(&mut graph);
    let (power, inverse) = (graph.power_number(a, 8.0 / 3.0), graph.power_number(a, -1.0));
    assert_ne!(8.0 / 3.0 - 1.0, 5.0 / 3.0);
    let product = graph.product(&[power, inverse]);
    assert_eq!(product, graph.power_number(a, 5.0 / 3.0));
}

/// `(a - b (b + a)²)/(a + b)²`: both squares are one expression.
#[test]
fn common_parts_are_shared() {
    let mut graph = Graph::new();
    let [a, b, _] = abc(&mut graph);
    let (ba, ab) = (graph.add(b, a), graph.add(a, b));
    let (first, second) = (graph.power_number(ba, 2.0), graph.power_number(ab, 2.0));
    assert_eq!(first, second);
    let product = graph.product(&[b, first]);
    let difference = graph.subtract(a, product);
    let quotient = graph.divide(difference, second);
    // a sum, a square as one product, a product, a difference, a quotient
    let operations = graph.operations(&[quotient], |_| false);
    assert_eq!((operations.additions, operations.multiplications, operations.divisions), (2, 3, 1));
}

#[test]
fn like_terms_collect() {
    let mut graph = Graph::new();
    let [a, b, _] = abc(&mut graph);
    let double = graph.add(a, a);
    assert_eq!(graph.times_number(2.0, a), double);
    let nothing = graph.subtract(double, double);
    assert_eq!(graph.value(nothing), Some(0.0));
    let inverse = graph.power_number(a, -1.0);
    assert_eq!(graph.product(&[a, inverse, b]), b);
    let exponent = graph.symbol("n", Shape::Scalar);
    let (power, less) = (graph.power(a, exponent), graph.negate(exponent));
    let back = graph.power(a, less);
    let one = graph.product(&[power, back]);
    assert_eq!(graph.value(one), Some(1.0));
}

/// Determinants, cofactors and traces of products; symmetric matrices are their transposes.
#[test]
fn tensors_simplify() {
    let mut graph = Graph::new();
    let f = graph.symbol("F", Shape::Matrix);
    let transposed = graph.transpose(f);
    let c = graph.multiply(transposed, f);
    assert_eq!(graph.transpose(c), c);
    let (trace, squares) = (graph.trace(c), graph.dot(f, f));
    assert_eq!(trace, squares);
    let (determinant, volume) = (graph.determinant(c), graph.determinant(f));
    assert_eq!(determinant, graph.power_number(volume, 2.0));
    let entries: Vec<Expr> = (0..9).map(|index| graph.entry(f, index)).collect();
    assert_eq!(graph.pack(&entries), f);
}

/// Derivatives by a number, with the chain and product rules.
#[test]
fn derivatives_by_numbers() {
    let mut graph = Graph::new();
    let [a, b, _] = abc(&mut graph);
    let square = graph.power_number(a, 2.0);
    let product = graph.product(&[square, b]);
    let slope = graph.derivative(product, a);
    let two = graph.number(2.0);
    assert_eq!(slope, graph.product(&[two, a, b]));
    let logarithm = graph.function(crate::Function::Ln, square);
    let slope = graph.derivative(logarithm, a);
    let inverse = graph.power_number(a, -1.0);
    assert_eq!(slope, graph.product(&[two, inverse]));
}

/// The source's worked example: `c U0x + p0 c U0y` with `c` of rest positions keeps `D0 = c` and `D1 = D0 p0`.
#[test]
fn grouped_constants_of_the_worked_example() {
    let mut graph = Graph::new();
    let [x, y, p, u, v] = ["P1x", "P1y", "p0", "U0x", "U0y"].map(|name| graph.symbol(name, Shape::Scalar));
    let c = graph.subtract(x, y);
    let (first, second) = (graph.product(&[c, u]), graph.product(&[p, c, v]));
    let sum = graph.sum(&[first, second]);
    let Grouped { constants, varying } = graph.group_constants(&[sum], &[u, v]);
    let [(d0, of_d0), (d1, of_d1)] = constants[..] else { panic!("{constants:?}") };
    assert_eq!(of_d0, c);
    assert_eq!(of_d1, graph.product(&[d0, p]));
    let (first, second) = (graph.product(&[d0, u]), graph.product(&[d1, v]));
    assert_eq!(varying, [graph.sum(&[first, second])]);
    // nothing constant is left beside the variables, and no variable is in a constant
    let depends = graph.depends(&[of_d0, of_d1], &[u, v]);
    assert!(!depends[of_d0.index()] && !depends[of_d1.index()]);
}

/// Three sums that have two addends in common, one of them with the other sign, and two products: each pair is computed once, and
/// all are worth what they were.
#[test]
fn pairs_are_computed_once() {
    let mut graph = Graph::new();
    let [a, b, c] = abc(&mut graph);
    let (minus_a, minus_b) = (graph.negate(a), graph.negate(b));
    let d = graph.symbol("d", Shape::Scalar);
    let mut roots = vec![
        graph.sum(&[a, b, c]),
        graph.sum(&[a, b, d]),
        graph.sum(&[minus_a, minus_b, c, d]),
        graph.product(&[a, b, c]),
        graph.product(&[a, b, d]),
    ];
    let minus = graph.number(-3.0);
    roots.push(graph.product(&[minus, a, b]));
    let shared = graph.shared(&roots);
    let count = |roots: &[Expr]| {
        let operations = graph.operations(roots, |_| false);
        (operations.additions, operations.multiplications)
    };
    assert_eq!(count(&roots), (7, 6));
    // a + b, and one more for c, d and c + d each; a b, and c, d and a number more
    assert_eq!(count(&shared), (5, 4));
    let values = |symbol: &Symbol| match symbol.name.as_str() {
        "a" => &[2.0][..],
        "b" => &[3.0][..],
        "c" => &[5.0][..],
        _ => &[7.0][..],
    };
    let all: Vec<Expr> = roots.iter().chain(&shared).copied().collect();
    let evaluation = graph.evaluate(&all, values);
    for (root, shared) in roots.iter().zip(&shared) {
        assert_eq!(evaluation.scalar(*root), evaluation.scalar(*shared));
    }
}

/// `a F + b F A + F B` is `F (a I + b A + B)`, with fewer operations and the same value; where nothing is common all stays as it is.
#[test]
#[allow(non_snake_case)]
fn common_left_factors_are_taken_out() {
    let mut graph = Graph::new();
    let [a, b, _] = abc(&mut graph);
    let [F, A, B] = ["F", "A", "B"].map(|name| graph.symbol(name, Shape::Matrix));
    let (FA, FB) = (graph.multiply(F, A), graph.multiply(F, B));
    let addends = [graph.scale(a, F), graph.scale(b, FA), FB];
    let sum = graph.sum(&addends);
    let factored = graph.factored(&[sum])[0];
    let identity = graph.identity();
    let rest = [graph.scale(a, identity), graph.scale(b, A), B];
    let rest = graph.sum(&rest);
    assert_eq!(factored, graph.multiply(F, rest));
    let BA = graph.multiply(B, A);
    let other = graph.add(FA, BA);
    assert_eq!(graph.factored(&[other]), [other]);
}
