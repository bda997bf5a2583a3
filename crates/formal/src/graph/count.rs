//! How much work expressions are.

use super::{Expr, Graph, Node};
use crate::Function;
use crate::hashing::Map;

/// Operations of one evaluation in which every different expression is computed once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Operations {
    pub additions: usize,
    pub multiplications: usize,
    pub divisions: usize,
    /// Roots, powers that are not whole, transcendental functions.
    pub functions: usize,
    pub comparisons: usize,
}

impl Operations {
    pub fn total(&self) -> usize {
        self.additions + self.multiplications + self.divisions + self.functions + self.comparisons
    }
}

impl std::ops::Add for Operations {
    type Output = Self;

    fn add(mut self, other: Self) -> Self {
        self.additions += other.additions;
        self.multiplications += other.multiplications;
        self.divisions += other.divisions;
        self.functions += other.functions;
        self.comparisons += other.comparisons;
        self
    }
}

impl Graph {
    /// Operations to evaluate `roots` together; expressions for which `known` holds are at hand already.
    ///
    /// A sign is free, and a whole power is counted as squarings and products.
    pub fn operations(&self, roots: &[Expr], known: impl Fn(Expr) -> bool) -> Operations {
        let mut wanted = vec![false; roots.iter().max().map_or(0, |last| last.index() + 1)];
        roots.iter().for_each(|root| wanted[root.index()] = true);
        let mut total = Operations::default();
        for index in (0..wanted.len()).rev() {
            let expr = Expr(index as u32);
            if wanted[index] && !known(expr) {
                total = total + self.operations_of(expr);
                self.node(expr).operands().for_each(|operand| wanted[operand.index()] = true);
            }
        }
        total
    }

    /// Operands of `roots` written out in full, each part as often as it is used: how long a text without names for parts
    /// would be. Expressions for which `known` holds have a name and count as one.
    pub fn operands_written_out(&self, roots: &[Expr], known: impl Fn(Expr) -> bool) -> f64 {
        // the length of a text that shares nothing grows exponentially: more than any whole number
        let mut lengths: Map<Expr, f64> = Map::default();
        for expr in self.reachable(roots) {
            let inside: f64 = self.node(expr).operands().map(|operand| lengths[&operand]).sum();
            lengths.insert(expr, if known(expr) || inside == 0.0 { 1.0 } else { inside });
        }
        roots.iter().map(|root| lengths[root]).sum()
    }

    fn operations_of(&self, expr: Expr) -> Operations {
        let of =
            |additions, multiplications| Operations { additions, multiplications, ..Operations::default() };
        let len = self.shape(expr).size();
        match self.node(expr) {
            Node::Number(_)
            | Node::Symbol(_)
            | Node::Zero(_)
            | Node::Identity
            | Node::Transpose(_)
            | Node::Entry(..)
            | Node::Pack(_) => Operations::default(),
            Node::Sum(terms) => {
                // multiples of the identity meet the diagonal alone
                let diagonals = terms.iter().filter(|term| self.is_spherical(**term)).count();
                let whole = terms.len() - diagonals;
                of(len * whole.saturating_sub(1) + if whole > 0 { 3 * diagonals } else { 0 }, 0)
            }
            Node::Product(factors) => {
                let divisions = factors.iter().filter(|factor| self.is_reciprocal(**factor)).count();
                let signs = factors.iter().filter(|factor| self.value(**factor) == Some(-1.0)).count();
                // the division takes the place of a product
                let products = factors.len() - 1 - signs;
                of(0, products.saturating_sub(divisions))
            }
            Node::Power(_, exponent) => self.operations_of_power(*exponent),
            Node::Function(Function::Abs, _) => Operations::default(),
            Node::Function(..) => Operations { functions: 1, ..Operations::default() },
            Node::Compare(..) | Node::Select(..) => Operations { comparisons: 1, ..Operations::default() },
            Node::Scale(..) if self.is_spherical(expr) => Operations::default(),
            Node::Scale(factor, _) => of(0, if self.value(*factor) == Some(-1.0) { 0 } else { len }),
            Node::Multiply(..) => of(18, 27),
            Node::Apply(..) => of(6, 9),
            Node::Dot(a, _) => of(self.shape(*a).size() - 1, self.shape(*a).size()),
            Node::Trace(_) => of(2, 0),
            Node::Determinant(_) => of(5, 9),
            Node::Cofactor(_) => of(9, 18),
            Node::Cross(..) => of(27, 36),
            Node::Outer(..) => of(0, 9),
            // about what the iterations take
            Node::Decompose(_) => Operations {
                additions: 300,
                multiplications: 400,
                divisions: 20,
                functions: 20,
                comparisons: 0,
            },
            Node::Compose(..) => of(18, 36),
            Node::StretchRates(..) => of(24, 36),
            Node::ComposeDifferential(_) => {
                Operations { additions: 90, multiplications: 126, divisions: 6, functions: 0, comparisons: 3 }
            }
        }
    }

    /// Whether a matrix is the identity or a multiple of it.
    fn is_spherical(&self, expr: Expr) -> bool {
        match self.node(expr) {
            Node::Identity => true,
            Node::Scale(_, tensor) => matches!(self.node(*tensor), Node::Identity),
            _ => false,
        }
    }

    fn is_reciprocal(&self, expr: Expr) -> bool {
        matches!(self.node(expr), Node::Power(_, exponent) if self.value(*exponent).is_some_and(|value| value < 0.0))
    }

    fn operations_of_power(&self, exponent: Expr) -> Operations {
        match self.value(exponent) {
            Some(value) if value.fract() == 0.0 && value.abs() <= 64.0 => {
                let whole = value.abs() as u32;
                let products = (whole.ilog2() + whole.count_ones() - 1) as usize;
                let divisions = usize::from(value < 0.0);
                Operations { multiplications: products, divisions, ..Operations::default() }
            }
            _ => Operations { functions: 1, ..Operations::default() },
        }
    }
}
