//! Tensors spelled out as numbers: what code for one number at a time, counts and grouped constants work on.

use std::collections::HashMap;

use super::{Expr, Graph, Node, Shape};

impl Graph {
    /// The numbers of `expr` as expressions of numbers only, by columns. `given` says what stands for the entries of
    /// symbols; other symbols of several numbers become symbols of their own, `F` giving `F_00`, `F_10`, ….
    ///
    /// The decomposition into stretches has no finite formula: it stays an operation on nine numbers, and so does what is made with it.
    pub fn components(&mut self, expr: Expr, given: &HashMap<Expr, Vec<Expr>>) -> Vec<Expr> {
        let mut made = given.clone();
        for node in self.reachable(&[expr]) {
            if !made.contains_key(&node) {
                let components = self.components_of(node, &made);
                made.insert(node, components);
            }
        }
        made.remove(&expr).unwrap_or_default()
    }

    fn components_of(&mut self, expr: Expr, made: &HashMap<Expr, Vec<Expr>>) -> Vec<Expr> {
        let of = |operand: &Expr| &made[operand];
        let scalar = |operand: &Expr| made[operand][0];
        let node = self.node(expr).clone();
        match &node {
            Node::Symbol(_) if self.shape(expr) != Shape::Scalar => {
                let symbol = self.symbol_of(expr).expect("a symbol").clone();
                (0..symbol.shape.size())
                    .map(|index| {
                        let name = match symbol.shape {
                            // by letters: `D_0` is a grouped constant
                            Shape::Vector => format!("{}_{}", symbol.name, ["x", "y", "z"][index]),
                            _ => format!("{}_{}{}", symbol.name, index % 3, index / 3),
                        };
                        self.own_symbol(&name)
                    })
                    .collect()
            }
            Node::Zero(shape) => vec![self.number(0.0); shape.size()],
            Node::Identity => {
                (0..9).map(|index| self.number(if index % 4 == 0 { 1.0 } else { 0.0 })).collect()
            }
            Node::Sum(terms) => (0..self.shape(expr).size())
                .map(|index| {
                    let terms: Vec<Expr> = terms.iter().map(|term| of(term)[index]).collect();
                    let sum = self.sum(&terms);
                    self.with_number_in_front(sum)
                })
                .collect(),
            Node::Scale(factor, tensor) => {
                of(tensor).iter().map(|entry| self.product(&[scalar(factor), *entry])).collect()
            }
            Node::Multiply(a, b) => self.matrix_product(of(a), of(b)),
            Node::Apply(a, v) => self.matrix_product(of(a), of(v)),
            Node::Transpose(a) => (0..9).map(|index| of(a)[(index % 3) * 3 + index / 3]).collect(),
            Node::Dot(a, b) => vec![self.sum_of_products(of(a), of(b))],
            Node::Trace(a) => vec![self.sum(&[of(a)[0], of(a)[4], of(a)[8]])],
            Node::Cofactor(a) => self.cofactor_components(of(a), of(a), 0.5),
            Node::Cross(a, b) => self.cofactor_components(of(a), of(b), 1.0),
            Node::Determinant(a) => {
                let cofactor = self.cofactor_components(of(a), of(a), 0.5);
                vec![self.sum_of_products(&of(a)[..3], &cofactor[..3])]
            }
            Node::Outer(u, v) => {
                (0..9).map(|index| self.product(&[of(u)[index % 3], of(v)[index / 3]])).collect()
            }
            Node::Entry(a, index) => vec![of(a)[usize::from(*index)]],
            Node::Pack(entries) => entries.iter().map(scalar).collect(),
            Node::Decompose(_)
            | Node::Compose(..)
            | Node::StretchRates(..)
            | Node::ComposeDifferential(_) => self.components_of_stretches(expr, &node, made),
            // numbers of numbers
            _ => vec![self.rebuild(expr, &|operand| made[&operand][0])],
        }
    }

    /// The numbers of the same operation on operands that are packed of their numbers.
    fn components_of_stretches(
        &mut self,
        expr: Expr,
        node: &Node,
        made: &HashMap<Expr, Vec<Expr>>,
    ) -> Vec<Expr> {
        let packed: Vec<(Expr, Expr)> = node
            .operands()
            .map(|operand| {
                let new = match *self.node(operand) {
                    Node::Decompose(matrix) => {
                        let matrix = self.pack(&made[&matrix]);
                        self.decompose(matrix)
                    }
                    _ => self.pack(&made[&operand]),
                };
                (operand, new)
            })
            .collect();
        let new = |operand: Expr| {
            packed.iter().find_map(|(old, new)| (*old == operand).then_some(*new)).unwrap_or(operand)
        };
        let rebuilt = self.rebuild(expr, &new);
        (0..self.shape(expr).size()).map(|index| self.entry(rebuilt, index as u8)).collect()
    }

    fn sum_of_products(&mut self, a: &[Expr], b: &[Expr]) -> Expr {
        let products: Vec<Expr> = a.iter().zip(b).map(|(a, b)| self.product(&[*a, *b])).collect();
        self.sum(&products)
    }

    /// `A B`, or `A b` for three numbers.
    fn matrix_product(&mut self, a: &[Expr], b: &[Expr]) -> Vec<Expr> {
        (0..b.len())
            .map(|index| {
                let (row, column) = (index % 3, index / 3);
                let of_row: Vec<Expr> = (0..3).map(|k| a[3 * k + row]).collect();
                self.sum_of_products(&of_row, &b[3 * column..3 * column + 3])
            })
            .collect()
    }

    /// `factor · A ⨯ B`; `cof A` is half of `A ⨯ A`.
    fn cofactor_components(&mut self, a: &[Expr], b: &[Expr], factor: f64) -> Vec<Expr> {
        (0..9)
            .map(|index| {
                let (i, j) = (index % 3, index / 3);
                let (i1, i2, j1, j2) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
                let at = |row: usize, column: usize| 3 * column + row;
                let products = [
                    (factor, a[at(i1, j1)], b[at(i2, j2)]),
                    (factor, b[at(i1, j1)], a[at(i2, j2)]),
                    (-factor, a[at(i2, j1)], b[at(i1, j2)]),
                    (-factor, b[at(i2, j1)], a[at(i1, j2)]),
                ];
                let products = products.map(|(factor, x, y)| {
                    let product = self.product(&[x, y]);
                    self.times_number(factor, product)
                });
                self.sum(&products)
            })
            .collect()
    }
}
