//! Definite integrals of polynomials: what a rule of quadrature stands for where the reference map is affine.

use super::{Expr, Graph, Node, Shape};

/// The highest power that is expanded: beyond it the polynomial is no element's.
const MOST: usize = 64;

impl Graph {
    /// `∫ expr d(symbol)` between two expressions that do not hold the symbol; `None` where `expr` is no polynomial of it.
    ///
    /// # Panics
    /// If a bound holds the symbol.
    pub fn integral(&mut self, expr: Expr, symbol: Expr, [low, high]: [Expr; 2]) -> Option<Expr> {
        let bounds = self.depends(&[low, high], &[symbol]);
        assert!(
            ![low, high].iter().any(|bound| bounds[bound.index()]),
            "a bound holds what is integrated over"
        );
        let coefficients = self.coefficients(expr, symbol)?;
        let mut terms = Vec::with_capacity(coefficients.len());
        // c (bⁿ⁺¹ - aⁿ⁺¹) / (n + 1)
        for (power, coefficient) in coefficients.into_iter().enumerate() {
            let next = (power + 1) as f64;
            let [low, high] = [low, high].map(|bound| self.power_number(bound, next));
            let minus_low = self.times_number(-1.0, low);
            let span = self.sum(&[high, minus_low]);
            let term = self.product(&[coefficient, span]);
            terms.push(self.times_number(1.0 / next, term));
        }
        Some(self.sum(&terms))
    }

    /// `c₀, c₁, …` of `Σ cₙ symbolⁿ`; `None` where the expression is no polynomial of the symbol.
    pub fn coefficients(&mut self, expr: Expr, symbol: Expr) -> Option<Vec<Expr>> {
        let depends = self.depends(&[expr], &[symbol]);
        self.coefficients_of(expr, symbol, &depends)
    }

    fn coefficients_of(&mut self, expr: Expr, symbol: Expr, depends: &[bool]) -> Option<Vec<Expr>> {
        if self.shape(expr) != Shape::Scalar {
            return None;
        }
        if !depends[expr.index()] {
            return Some(vec![expr]);
        }
        if expr == symbol {
            return Some(vec![self.number(0.0), self.number(1.0)]);
        }
        match self.node(expr).clone() {
            Node::Sum(terms) => {
                let mut sums: Vec<Vec<Expr>> = Vec::new();
                for term in terms {
                    for (power, coefficient) in
                        self.coefficients_of(term, symbol, depends)?.into_iter().enumerate()
                    {
                        sums.resize_with(sums.len().max(power + 1), Vec::new);
                        sums[power].push(coefficient);
                    }
                }
                Some(sums.into_iter().map(|addends| self.sum(&addends)).collect())
            }
            Node::Product(factors) => {
                let mut product = vec![self.number(1.0)];
                for factor in factors {
                    let factor = self.coefficients_of(factor, symbol, depends)?;
                    product = self.product_of(&product, &factor)?;
                }
                Some(product)
            }
            Node::Power(base, exponent) => {
                let exponent = self.value(exponent).filter(|n| n.fract() == 0.0 && *n >= 1.0)?;
                let base = self.coefficients_of(base, symbol, depends)?;
                let mut product = vec![self.number(1.0)];
                for _ in 0..exponent.min(MOST as f64 + 1.0) as usize {
                    product = self.product_of(&product, &base)?;
                }
                Some(product)
            }
            _ => None,
        }
    }

    /// The product of two polynomials by their coefficients; `None` where it is too long.
    fn product_of(&mut self, a: &[Expr], b: &[Expr]) -> Option<Vec<Expr>> {
        let length = a.len() + b.len() - 1;
        if length > MOST + 1 {
            return None;
        }
        let mut sums = vec![Vec::new(); length];
        for (i, a) in a.iter().enumerate() {
            for (j, b) in b.iter().enumerate() {
                sums[i + j].push(self.product(&[*a, *b]));
            }
        }
        Some(sums.into_iter().map(|addends| self.sum(&addends)).collect())
    }
}
