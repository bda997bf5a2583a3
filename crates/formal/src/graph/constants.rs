//! Grouped constants: what can be computed once per element instead of once per step.
//!
//! An expression that depends on no variable is a constant. The largest ones are taken out and numbered, the constant
//! terms of a sum and the constant factors of a product together (Faure 2014, algorithm 6). Equal constants are one
//! constant wherever they stand, for equal expressions are one expression. Plain numbers stay in the code.

use std::collections::HashMap;

use super::{Expr, Graph, Node, Shape, Substitution};
use crate::hashing::Map;

/// Expressions split into grouped constants and what varies.
#[derive(Clone, Debug)]
pub struct Grouped {
    /// `D_0`, `D_1`, …: the symbol that stands for the constant, and its expression; later ones may use earlier ones.
    pub constants: Vec<(Expr, Expr)>,
    /// The expressions in the symbols of the constants and the variables.
    pub varying: Vec<Expr>,
}

struct Extraction<'a> {
    graph: &'a mut Graph,
    varies: Vec<bool>,
    constants: Vec<(Expr, Expr)>,
    symbols: Map<Expr, Expr>,
}

impl Graph {
    /// Splits expressions of numbers; what depends on none of `variables` is constant.
    pub fn group_constants(&mut self, roots: &[Expr], variables: &[Expr]) -> Grouped {
        let varies = self.depends(roots, variables);
        let reachable = self.reachable(roots);
        let mut extraction =
            Extraction { graph: self, varies, constants: Vec::new(), symbols: Map::default() };
        let mut made: Map<Expr, Expr> = Map::default();
        for expr in reachable {
            if extraction.varies[expr.index()] {
                let new = extraction.rewrite(expr, &made);
                made.insert(expr, new);
            }
        }
        let varying = roots.iter().map(|root| match made.get(root) {
            Some(new) => *new,
            None => extraction.constant(*root),
        });
        let varying = varying.collect();
        let constants = extraction.constants;
        let constants = self.nest(constants);
        Grouped { constants, varying }
    }

    /// The same with one constant for all that differ by a number, which stays in the code: twice a modulus is no constant of its own.
    pub(crate) fn without_multiples(&mut self, grouped: Grouped) -> Grouped {
        let (mut whole, mut replaced) = (Substitution::default(), Vec::new());
        let mut kept: Vec<(Expr, Expr)> = Vec::new();
        let mut symbol_of: Map<Expr, Expr> = Map::default();
        for (symbol, definition) in grouped.constants {
            let definition = self.substituted(definition, &mut whole);
            whole.replace(symbol, definition, false);
            let (number, rest) = self.without_number(definition);
            let known = *symbol_of.entry(rest).or_insert_with(|| {
                kept.push((symbol, rest));
                symbol
            });
            replaced.push((symbol, self.times_number(number, known)));
        }
        let mut replaced = Substitution::new(replaced);
        let varying = grouped.varying.iter().map(|expr| self.substituted(*expr, &mut replaced)).collect();
        let constants = self.nest(kept);
        Grouped { constants, varying }
    }

    /// A product as its number and the rest.
    fn without_number(&mut self, expr: Expr) -> (f64, Expr) {
        let Node::Product(factors) = self.node(expr).clone() else { return (1.0, expr) };
        let (numbers, others): (Vec<Expr>, Vec<Expr>) =
            factors.iter().partition(|factor| self.value(**factor).is_some());
        let number = numbers.iter().filter_map(|factor| self.value(*factor)).product();
        (number, self.product(&others))
    }

    /// Writes constants with the earlier ones they contain.
    fn nest(&mut self, constants: Vec<(Expr, Expr)>) -> Vec<(Expr, Expr)> {
        let mut symbols = Substitution::default();
        let mut nested = Vec::with_capacity(constants.len());
        for (symbol, expr) in constants {
            let is_held = symbols.has_met(expr);
            nested.push((symbol, self.substituted(expr, &mut symbols)));
            symbols.replace(expr, symbol, is_held);
        }
        nested
    }
}

impl Extraction<'_> {
    /// The symbol of a constant; numbers stand for themselves, tensors for the constants of their entries.
    fn constant(&mut self, expr: Expr) -> Expr {
        if self.graph.value(expr).is_some() {
            return expr;
        }
        if self.graph.shape(expr) != Shape::Scalar {
            return self.constant_tensor(expr);
        }
        if let Some(symbol) = self.symbols.get(&expr) {
            return *symbol;
        }
        let symbol = self.graph.own_symbol(&format!("D_{}", self.constants.len()));
        self.constants.push((symbol, expr));
        self.symbols.insert(expr, symbol);
        symbol
    }

    fn constant_tensor(&mut self, expr: Expr) -> Expr {
        match *self.graph.node(expr) {
            Node::Symbol(_) | Node::Identity | Node::Zero(_) => return expr,
            Node::Decompose(matrix) => {
                let matrix = self.constant(matrix);
                return self.graph.decompose(matrix);
            }
            _ => {}
        }
        let entries = self.graph.components(expr, &HashMap::new());
        let entries: Vec<Expr> = entries.into_iter().map(|entry| self.constant(entry)).collect();
        self.graph.pack(&entries)
    }

    /// The factors as whole powers of constants that are there already, where all of them are: their product is not
    /// worth a place in memory.
    fn extracted(&mut self, factors: &[Expr]) -> Option<Vec<Expr>> {
        let mut known = Vec::with_capacity(factors.len());
        for factor in factors {
            let (base, power) = match *self.graph.node(*factor) {
                Node::Power(base, exponent) => match self.graph.value(exponent) {
                    Some(n) if n.fract() == 0.0 => (self.graph.power_number(base, n.signum()), n.abs()),
                    _ => (*factor, 1.0),
                },
                _ => (*factor, 1.0),
            };
            let symbol = *self.symbols.get(&base)?;
            known.push(self.graph.power_number(symbol, power));
        }
        Some(known)
    }

    fn rewrite(&mut self, expr: Expr, made: &Map<Expr, Expr>) -> Expr {
        let node = self.graph.node(expr).clone();
        let constants: Vec<Expr> = node.operands().filter(|operand| !self.varies[operand.index()]).collect();
        let plain = |graph: &Graph, operand: &Expr| graph.value(*operand).is_some();
        let (numbers, grouped): (Vec<Expr>, Vec<Expr>) =
            constants.into_iter().partition(|operand| plain(self.graph, operand));
        let varying = |operands: &[Expr]| -> Vec<Expr> {
            operands.iter().filter_map(|operand| made.get(operand).copied()).collect()
        };
        match node {
            Node::Sum(terms) if !grouped.is_empty() => {
                let constant = self.graph.sum(&grouped);
                let mut sum = varying(&terms);
                sum.push(self.constant(constant));
                sum.extend(numbers);
                self.graph.sum(&sum)
            }
            Node::Product(factors) if !grouped.is_empty() => {
                let mut product = varying(&factors);
                match self.extracted(&grouped) {
                    Some(known) => product.extend(known),
                    None => {
                        let constant = self.graph.product(&grouped);
                        product.push(self.constant(constant));
                    }
                }
                product.extend(numbers);
                self.graph.product(&product)
            }
            _ => {
                let mut known: Map<Expr, Expr> =
                    node.operands().filter_map(|key| Some((key, *made.get(&key)?))).collect();
                for operand in grouped.into_iter().chain(numbers) {
                    let constant = self.constant(operand);
                    known.insert(operand, constant);
                }
                self.graph.rebuild(expr, &|operand| known.get(&operand).copied().unwrap_or(operand))
            }
        }
    }
}
