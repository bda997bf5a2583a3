//! Common factors taken out: what makes derived expressions shorter without changing their value.
//!
//! Derivatives of functions of `C = FᵀF` have `F` and `δF` on the left of every addend: `a F + F A + F B` is `F (a I + A + B)`, one
//! product of matrices in the place of two, and numbers on a diagonal in the place of a scaled matrix.

use super::{Expr, Graph, Node, Shape};
use crate::hashing::Map;

impl Graph {
    /// Expressions with common left factors of matrices taken out of sums, each where that takes fewer operations.
    pub fn factored(&mut self, roots: &[Expr]) -> Vec<Expr> {
        let mut made: Map<Expr, Expr> = Map::default();
        for expr in self.reachable(roots) {
            let rebuilt = self.rebuild(expr, &|operand| made[&operand]);
            let factored = match self.node(rebuilt) {
                Node::Sum(_) if self.shape(rebuilt) == Shape::Matrix => self.factored_sum(rebuilt),
                _ => rebuilt,
            };
            made.insert(expr, factored);
        }
        let factored: Vec<Expr> = roots.iter().map(|root| made[root]).collect();
        let cost = |graph: &Self, roots: &[Expr]| graph.operations(roots, |_| false).total();
        if cost(self, &factored) < cost(self, roots) { factored } else { roots.to_vec() }
    }

    /// `number · expr` with the number in every addend, where those have numbers of their own.
    pub(crate) fn times_each(&mut self, number: f64, expr: Expr) -> Expr {
        let number = self.number(number);
        let addends = self.scaled_addends(expr, number);
        let addends: Vec<Expr> =
            addends.into_iter().map(|(scale, addend)| self.scale(scale, addend)).collect();
        self.sum(&addends)
    }

    fn factored_sum(&mut self, sum: Expr) -> Expr {
        let one = self.number(1.0);
        // `s L R` by `L`, in the order in which the factors come
        let mut of_factor: Vec<(Expr, Vec<(Expr, Expr)>)> = Vec::new();
        for (scale, product) in self.scaled_addends(sum, one) {
            let (left, rest) = match *self.node(product) {
                Node::Multiply(left, rest) => (left, rest),
                _ => (product, self.identity()),
            };
            match of_factor.iter_mut().find(|(other, _)| *other == left) {
                Some((_, addends)) => addends.push((scale, rest)),
                None => of_factor.push((left, vec![(scale, rest)])),
            }
        }
        let addends: Vec<Expr> = of_factor
            .into_iter()
            .map(|(left, addends)| {
                // `a E` with `E = C/2 - I/2` is part of this sum, not one of its own
                let rests: Vec<(Expr, Expr)> =
                    addends.into_iter().flat_map(|(scale, rest)| self.scaled_addends(rest, scale)).collect();
                let rests: Vec<Expr> =
                    rests.into_iter().map(|(scale, rest)| self.scale(scale, rest)).collect();
                let rest = self.sum(&rests);
                self.multiply(left, rest)
            })
            .collect();
        self.sum(&addends)
    }

    /// The addends of a sum, those of scaled sums within it among them, each with the number before it.
    fn scaled_addends(&mut self, expr: Expr, scale: Expr) -> Vec<(Expr, Expr)> {
        match self.node(expr).clone() {
            Node::Sum(terms) => terms.iter().flat_map(|term| self.scaled_addends(*term, scale)).collect(),
            Node::Scale(factor, tensor) => {
                let scale = self.product(&[scale, factor]);
                self.scaled_addends(tensor, scale)
            }
            _ => vec![(scale, expr)],
        }
    }

    /// A sum of numbers whose addends all have the same number before them, but for signs, as that number times their sum.
    pub(super) fn with_number_in_front(&mut self, sum: Expr) -> Expr {
        let Node::Sum(terms) = self.node(sum).clone() else { return sum };
        let split: Vec<(f64, Option<Expr>)> =
            terms.iter().map(|term| self.split_coefficient(*term)).collect();
        let number = split[0].0.abs();
        if number == 1.0 || split.iter().any(|(coefficient, _)| coefficient.abs() != number) {
            return sum;
        }
        let addends: Vec<Expr> = split
            .into_iter()
            .map(|(coefficient, rest)| {
                let sign = coefficient.signum();
                match rest {
                    Some(rest) => self.times_number(sign, rest),
                    None => self.number(sign),
                }
            })
            .collect();
        let inner = self.sum(&addends);
        self.times_number(number, inner)
    }
}
