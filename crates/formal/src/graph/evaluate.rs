//! The value of expressions for given symbols: the plain reading of a graph, against which compiled forms are held.

#![allow(non_snake_case)]

use souple_math::{Mat3, Vec3, svd};

use super::{Expr, Graph, Node, Symbol};
use crate::arithmetic;

/// The numbers of one expression, matrices by columns.
pub type Tensor<'a> = &'a [f64];

/// Values of all expressions up to the last asked for.
#[derive(Clone, Debug)]
pub struct Evaluation {
    starts: Vec<usize>,
    numbers: Vec<f64>,
}

impl Evaluation {
    /// The numbers of an evaluated expression.
    pub fn of(&self, expr: Expr) -> Tensor<'_> {
        &self.numbers[self.starts[expr.index()]..self.starts[expr.index() + 1]]
    }

    pub fn scalar(&self, expr: Expr) -> f64 {
        self.of(expr)[0]
    }

    pub fn matrix(&self, expr: Expr) -> Mat3 {
        matrix(self.of(expr))
    }

    fn vector(&self, expr: Expr) -> Vec3 {
        vector(self.of(expr))
    }
}

fn vector(numbers: &[f64]) -> Vec3 {
    Vec3::new(numbers[0], numbers[1], numbers[2])
}

fn matrix(numbers: &[f64]) -> Mat3 {
    Mat3::from_columns(vector(numbers), vector(&numbers[3..]), vector(&numbers[6..]))
}

fn entries(matrix: &Mat3) -> [f64; 9] {
    let mut out = [0.0; 9];
    for (three, column) in out.chunks_exact_mut(3).zip(matrix.columns) {
        three.copy_from_slice(&column.to_array());
    }
    out
}

impl Graph {
    /// Evaluates what `roots` are made of; `symbol` gives the numbers of each symbol.
    ///
    /// # Panics
    /// If `symbol` gives too few numbers.
    pub fn evaluate<'a>(&self, roots: &[Expr], symbol: impl Fn(&Symbol) -> &'a [f64]) -> Evaluation {
        let length = roots.iter().max().map_or(0, |last| last.index() + 1);
        let mut wanted = vec![false; length];
        self.reachable(roots).iter().for_each(|expr| wanted[expr.index()] = true);
        let mut evaluation = Evaluation { starts: vec![0], numbers: Vec::with_capacity(length) };
        for (index, wanted) in wanted.iter().enumerate() {
            if *wanted {
                self.evaluate_node(Expr(index as u32), &symbol, &mut evaluation);
            }
            evaluation.starts.push(evaluation.numbers.len());
        }
        evaluation
    }

    fn evaluate_node<'a>(&self, expr: Expr, symbol: &impl Fn(&Symbol) -> &'a [f64], values: &mut Evaluation) {
        let scalar = |a: Expr| values.scalar(a);
        let mut put = Put { numbers: [0.0; 21], len: 0 };
        match self.node(expr) {
            Node::Number(bits) => put.number(bits.value()),
            Node::Symbol(index) => {
                let of = &self.symbols[*index as usize];
                put.all(&symbol(of)[..of.shape.size()]);
            }
            Node::Zero(shape) => put.len = shape.size(),
            Node::Identity => put.matrix(&Mat3::identity(1.0)),
            Node::Sum(terms) => {
                put.len = self.shape(expr).size();
                for term in terms {
                    for (sum, number) in put.numbers.iter_mut().zip(values.of(*term)) {
                        *sum += number;
                    }
                }
            }
            Node::Product(factors) => put.number(factors.iter().map(|factor| scalar(*factor)).product()),
            Node::Power(a, b) => put.number(super::simplify::arithmetic_power(scalar(*a), scalar(*b))),
            Node::Function(function, a) => put.number(arithmetic::of_one(*function, scalar(*a))),
            Node::Compare(comparison, a, b) => put.number(comparison.holds(scalar(*a), scalar(*b))),
            Node::Select(a, b, c) => put.number(if scalar(*a) != 0.0 { scalar(*b) } else { scalar(*c) }),
            Node::Scale(a, b) => {
                let factor = scalar(*a);
                values.of(*b).iter().for_each(|number| put.number(factor * number));
            }
            Node::Multiply(a, b) => put.matrix(&(values.matrix(*a) * values.matrix(*b))),
            Node::Apply(a, b) => put.all(&(values.matrix(*a) * values.vector(*b)).to_array()),
            Node::Transpose(a) => put.matrix(&values.matrix(*a).transpose()),
            Node::Dot(a, b) => {
                put.number(values.of(*a).iter().zip(values.of(*b)).map(|(x, y)| x * y).sum());
            }
            Node::Trace(a) => put.number(values.matrix(*a).trace()),
            Node::Determinant(a) => put.number(values.matrix(*a).determinant()),
            Node::Cofactor(a) => put.matrix(&values.matrix(*a).cofactor()),
            Node::Cross(a, b) => put.matrix(&cross(&values.matrix(*a), &values.matrix(*b))),
            Node::Outer(a, b) => put.matrix(&values.vector(*a).outer(values.vector(*b))),
            Node::Entry(a, index) => put.number(values.of(*a)[usize::from(*index)]),
            Node::Pack(list) => list.iter().for_each(|entry| put.number(scalar(*entry))),
            Node::Decompose(a) => {
                let parts = svd(&values.matrix(*a));
                put.matrix(&parts.left);
                put.matrix(&parts.right);
                put.all(&parts.values.to_array());
            }
            Node::Compose(d, g) => {
                let (u, v) = bases(values.of(*d));
                put.matrix(&compose(&u, &v, values.of(*g)));
            }
            Node::StretchRates(d, a) => {
                let (u, v) = bases(values.of(*d));
                put.all(&u.transpose_mul(&(values.matrix(*a) * v)).diagonal().to_array());
            }
            Node::ComposeDifferential(list) => {
                let [d, g, dg, limits, df] = list.map(|operand| values.of(operand));
                put.matrix(&compose_differential(d, g, dg, limits, &matrix(df)));
            }
        }
        values.numbers.extend(&put.numbers[..put.len]);
        debug_assert_eq!(put.len, self.shape(expr).size());
    }
}

/// The numbers of a node while they are computed.
struct Put {
    numbers: [f64; 21],
    len: usize,
}

impl Put {
    fn number(&mut self, number: f64) {
        self.numbers[self.len] = number;
        self.len += 1;
    }

    fn all(&mut self, numbers: &[f64]) {
        numbers.iter().for_each(|number| self.number(*number));
    }

    fn matrix(&mut self, matrix: &Mat3) {
        self.all(&entries(matrix));
    }
}

/// `A ⨯ B` by columns of the cofactor, `b × c` and so on.
fn cross(A: &Mat3, B: &Mat3) -> Mat3 {
    let ([a, b, c], [da, db, dc]) = (A.columns, B.columns);
    Mat3::from_columns(db.cross(c) + b.cross(dc), dc.cross(a) + c.cross(da), da.cross(b) + a.cross(db))
}

fn bases(decomposition: &[f64]) -> (Mat3, Mat3) {
    (matrix(decomposition), matrix(&decomposition[9..]))
}

fn compose(u: &Mat3, v: &Mat3, g: &[f64]) -> Mat3 {
    let [a, b, c] = u.columns;
    Mat3::from_columns(a * g[0], b * g[1], c * g[2]).mul_transpose(v)
}

/// Relative distance of stretches below which their difference quotient is taken from its limit. There the quotient
/// would lose `1e-16/1e-5` to rounding, the limit errs by the square of the distance.
pub(crate) const EQUAL_STRETCHES: f64 = 1e-5;

fn compose_differential(d: &[f64], g: &[f64], dg: &[f64], limits: &[f64], df: &Mat3) -> Mat3 {
    let (u, v) = bases(d);
    let s = &d[18..];
    let m = u.transpose_mul(&(*df * v));
    let mut out = Mat3::from_columns(
        Vec3::new(dg[0], 0.0, 0.0),
        Vec3::new(0.0, dg[1], 0.0),
        Vec3::new(0.0, 0.0, dg[2]),
    );
    for (pair, (i, j)) in [(0, 1), (1, 2), (2, 0)].into_iter().enumerate() {
        let (mij, mji) = (m.columns[j].to_array()[i], m.columns[i].to_array()[j]);
        let (difference, sum) = (s[i] - s[j], s[i] + s[j]);
        let near = difference.abs() < EQUAL_STRETCHES * (s[i].abs() + s[j].abs());
        let stretch = if near { limits[pair] } else { (g[i] - g[j]) / difference };
        let turn = (g[i] + g[j]) / sum;
        let (even, odd) = (0.5 * stretch * (mij + mji), 0.5 * turn * (mij - mji));
        set(&mut out, i, j, even + odd);
        set(&mut out, j, i, even - odd);
    }
    (u * out).mul_transpose(&v)
}

fn set(matrix: &mut Mat3, row: usize, column: usize, value: f64) {
    let mut numbers = matrix.columns[column].to_array();
    numbers[row] = value;
    matrix.columns[column] = Vec3::from_array(numbers);
}
