//! Expression graphs: every different expression is stored once.
//!
//! Sums and products are n-ary and know no order, so `(a + b)` and `(b + a)` are the same node (hash-consing): equality
//! is equality of [`Expr`], common sub-expressions are shared from the start. Expressions are numbers, vectors or
//! 3×3 matrices; tensor operations stay whole (`cofactor`, `dot`, …), so that they are differentiated and run as such,
//! and [`Graph::components`] spells them out as scalars where code is wanted.
//!
//! Operands are made before what uses them: ascending order of [`Expr`] is an order of evaluation.

mod components;
mod constants;
mod count;
mod differentiate;
mod evaluate;
mod factor;
mod share;
mod simplify;
mod spectral;
mod substitute;
mod tensor;

pub use constants::Grouped;
pub use count::Operations;
pub(crate) use evaluate::EQUAL_STRETCHES;
pub use evaluate::{Evaluation, Tensor};
pub(crate) use simplify::arithmetic_power;
pub(crate) use spectral::STRETCHES;
pub(crate) use substitute::Substitution;

use crate::Function;
use crate::hashing::Map;

/// An expression of a [`Graph`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Expr(u32);

impl Expr {
    pub(crate) fn index(self) -> usize {
        self.0 as usize
    }
}

/// How many numbers an expression stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Shape {
    Scalar,
    Vector,
    /// 3×3, entries by columns.
    Matrix,
    /// `F = U diag(σ) Vᵀ`: `U`, `V` by columns, then `σ`.
    Decomposition,
}

impl Shape {
    /// How many numbers it is.
    pub fn size(self) -> usize {
        match self {
            Self::Scalar => 1,
            Self::Vector => 3,
            Self::Matrix => 9,
            Self::Decomposition => 21,
        }
    }
}

/// A number as a key: equal bits are equal, and `-0` is `0`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Bits(u64);

impl Bits {
    fn of(value: f64) -> Self {
        Self((value + 0.0).to_bits())
    }

    pub fn value(self) -> f64 {
        f64::from_bits(self.0)
    }
}

/// Comparisons of two numbers; the outcome is 1 or 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Comparison {
    Less,
    LessOrEqual,
    Equal,
}

/// What an expression is made of.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Node {
    Number(Bits),
    /// Index into the symbols of the graph.
    Symbol(u32),
    /// The vector or matrix of zeros.
    Zero(Shape),
    Identity,
    /// At least two terms of one shape, ascending.
    Sum(Box<[Expr]>),
    /// At least two numbers, ascending.
    Product(Box<[Expr]>),
    Power(Expr, Expr),
    /// A function of one number.
    Function(Function, Expr),
    Compare(Comparison, Expr, Expr),
    /// The second where the first is not zero, else the third; numbers all.
    Select(Expr, Expr, Expr),
    /// A number times a vector or matrix.
    Scale(Expr, Expr),
    /// Product of matrices.
    Multiply(Expr, Expr),
    /// Matrix times vector.
    Apply(Expr, Expr),
    Transpose(Expr),
    /// Sum of products of entries, of two vectors or two matrices.
    Dot(Expr, Expr),
    Trace(Expr),
    Determinant(Expr),
    /// `cof A = ∂ det A/∂A`.
    Cofactor(Expr),
    /// `A ⨯ B`, bilinear and symmetric, with `A ⨯ A = 2 cof A`: `cof` of a sum is `cof A + A ⨯ B + cof B`.
    Cross(Expr, Expr),
    /// `a bᵀ`.
    Outer(Expr, Expr),
    /// One number of a vector, matrix (by columns) or decomposition.
    Entry(Expr, u8),
    /// Three or nine numbers (by columns).
    Pack(Box<[Expr]>),
    /// The decomposition of a matrix.
    Decompose(Expr),
    /// `U diag(g) Vᵀ` of a decomposition and a vector.
    Compose(Expr, Expr),
    /// `diag(Uᵀ A V)` of a decomposition and a matrix: the rates of the stretches.
    StretchRates(Expr, Expr),
    /// The differential of `U diag(g) Vᵀ`, see [`Graph::compose_differential`].
    ComposeDifferential(Box<[Expr; 5]>),
}

impl Node {
    /// What the node uses, in order.
    pub fn operands(&self) -> Operands<'_> {
        let mut few = [None; 3];
        let mut many: &[Expr] = &[];
        match self {
            Self::Number(_) | Self::Symbol(_) | Self::Zero(_) | Self::Identity => {}
            Self::Sum(list) | Self::Product(list) | Self::Pack(list) => many = list,
            Self::ComposeDifferential(list) => many = &list[..],
            Self::Function(_, a)
            | Self::Transpose(a)
            | Self::Trace(a)
            | Self::Determinant(a)
            | Self::Cofactor(a)
            | Self::Entry(a, _)
            | Self::Decompose(a) => few[0] = Some(*a),
            Self::Power(a, b)
            | Self::Compare(_, a, b)
            | Self::Scale(a, b)
            | Self::Multiply(a, b)
            | Self::Apply(a, b)
            | Self::Dot(a, b)
            | Self::Cross(a, b)
            | Self::Outer(a, b)
            | Self::Compose(a, b)
            | Self::StretchRates(a, b) => (few[0], few[1]) = (Some(*a), Some(*b)),
            Self::Select(a, b, c) => few = [Some(*a), Some(*b), Some(*c)],
        }
        few.into_iter().flatten().chain(many.iter().copied())
    }
}

type Operands<'a> = std::iter::Chain<
    std::iter::Flatten<std::array::IntoIter<Option<Expr>, 3>>,
    std::iter::Copied<std::slice::Iter<'a, Expr>>,
>;

/// A named quantity.
#[derive(Clone, Debug)]
pub struct Symbol {
    pub name: String,
    pub shape: Shape,
}

/// Before the names of symbols that the derivation makes: no name that is written in a law has it.
pub(crate) const OWN: char = '@';

impl Symbol {
    /// The name of a symbol that the derivation made.
    pub(crate) fn own_name(&self) -> Option<&str> {
        self.name.strip_prefix(OWN)
    }
}

/// Expressions over symbols, each stored once.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    nodes: Vec<Node>,
    shapes: Vec<Shape>,
    known: Map<Node, Expr>,
    symbols: Vec<Symbol>,
    /// Transposes, determinants and cofactors of products made so far: a factor that stands in a product many times is gone
    /// into once.
    of_tensors: Map<(OfTensor, Expr), Expr>,
    /// Operands that new expressions may still have; `None` is without bound.
    allowance: Option<usize>,
}

/// What distributes over the terms of a sum of tensors, or the factors of a product of matrices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum OfTensor {
    Transpose,
    Trace,
    Entry(u8),
    Determinant,
    Cofactor,
}

impl Graph {
    pub fn new() -> Self {
        Self::default()
    }

    pub fn node(&self, expr: Expr) -> &Node {
        &self.nodes[expr.index()]
    }

    pub fn shape(&self, expr: Expr) -> Shape {
        self.shapes[expr.index()]
    }

    /// How many different expressions there are.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// The symbol of that name, made where it is new.
    ///
    /// # Panics
    /// If it exists with another shape.
    pub fn symbol(&mut self, name: &str, shape: Shape) -> Expr {
        let position = self.symbols.iter().position(|symbol| symbol.name == name);
        let index = position.unwrap_or_else(|| {
            self.symbols.push(Symbol { name: name.to_owned(), shape });
            self.symbols.len() - 1
        });
        assert_eq!(self.symbols[index].shape, shape, "the symbol `{name}` has another shape");
        self.intern(Node::Symbol(index as u32), shape)
    }

    /// The number of that name that a derivation makes beside those that are written.
    pub(crate) fn own_symbol(&mut self, name: &str) -> Expr {
        self.symbol(&format!("{OWN}{name}"), Shape::Scalar)
    }

    /// The vector of that name, as for numbers.
    pub(crate) fn own_vector(&mut self, name: &str) -> Expr {
        self.symbol(&format!("{OWN}{name}"), Shape::Vector)
    }

    /// The matrix of that name, as for numbers.
    pub(crate) fn own_matrix(&mut self, name: &str) -> Expr {
        self.symbol(&format!("{OWN}{name}"), Shape::Matrix)
    }

    /// The name and shape of a symbol; `None` for other expressions.
    pub fn symbol_of(&self, expr: Expr) -> Option<&Symbol> {
        match self.node(expr) {
            Node::Symbol(index) => Some(&self.symbols[*index as usize]),
            _ => None,
        }
    }

    pub fn number(&mut self, value: f64) -> Expr {
        self.intern(Node::Number(Bits::of(value)), Shape::Scalar)
    }

    /// The value of a number; `None` for other expressions.
    pub fn value(&self, expr: Expr) -> Option<f64> {
        match self.node(expr) {
            Node::Number(bits) => Some(bits.value()),
            _ => None,
        }
    }

    /// Bounds the operands of all expressions made from here on: past it derivatives are left out, and [`Self::is_exhausted`]
    /// says so. Products of many factors have derivatives that grow with the square of their number, and again with the next.
    pub(crate) fn allow(&mut self, operands: Option<usize>) {
        self.allowance = operands;
    }

    /// Whether more was made than was allowed: derivatives made since then are worth nothing.
    pub(crate) fn is_exhausted(&self) -> bool {
        self.allowance == Some(0)
    }

    fn intern(&mut self, node: Node, shape: Shape) -> Expr {
        if let Some(expr) = self.known.get(&node) {
            return *expr;
        }
        if let Some(left) = &mut self.allowance {
            *left = left.saturating_sub(1 + node.operands().count());
        }
        let expr = Expr(self.nodes.len() as u32);
        self.known.insert(node.clone(), expr);
        self.nodes.push(node);
        self.shapes.push(shape);
        expr
    }

    /// All that `roots` are made of, operands before what uses them.
    pub fn reachable(&self, roots: &[Expr]) -> Vec<Expr> {
        let Some(last) = roots.iter().max() else { return Vec::new() };
        let mut is_found = vec![false; last.index() + 1];
        let (mut open, mut found) = (roots.to_vec(), Vec::new());
        // by what is there, not by all that was ever made: large graphs are asked for small parts
        while let Some(expr) = open.pop() {
            if !std::mem::replace(&mut is_found[expr.index()], true) {
                found.push(expr);
                open.extend(self.node(expr).operands());
            }
        }
        found.sort_unstable();
        found
    }

    /// For each expression that `roots` are made of: whether one of `of` is among what it is made of.
    pub fn depends(&self, roots: &[Expr], of: &[Expr]) -> Vec<bool> {
        let length = roots.iter().chain(of).max().map_or(0, |last| last.index() + 1);
        let mut depends = vec![false; length];
        of.iter().for_each(|expr| depends[expr.index()] = true);
        for expr in self.reachable(roots) {
            if self.node(expr).operands().any(|operand| depends[operand.index()]) {
                depends[expr.index()] = true;
            }
        }
        depends
    }

    /// The same operation on other operands.
    pub(crate) fn rebuild(&mut self, expr: Expr, map: &dyn Fn(Expr) -> Expr) -> Expr {
        match self.node(expr).clone() {
            Node::Number(_) | Node::Symbol(_) | Node::Zero(_) | Node::Identity => expr,
            Node::Sum(terms) => {
                let terms: Vec<_> = terms.iter().map(|term| map(*term)).collect();
                self.sum(&terms)
            }
            Node::Product(factors) => {
                let factors: Vec<_> = factors.iter().map(|factor| map(*factor)).collect();
                self.product(&factors)
            }
            Node::Pack(entries) => {
                let entries: Vec<_> = entries.iter().map(|entry| map(*entry)).collect();
                self.pack(&entries)
            }
            Node::ComposeDifferential(list) => {
                let [a, b, c, d, e] = *list;
                self.compose_differential([map(a), map(b), map(c), map(d), map(e)])
            }
            Node::Power(a, b) => self.power(map(a), map(b)),
            Node::Function(function, a) => self.function(function, map(a)),
            Node::Compare(comparison, a, b) => self.compare(comparison, map(a), map(b)),
            Node::Select(a, b, c) => self.select(map(a), map(b), map(c)),
            Node::Scale(a, b) => self.scale(map(a), map(b)),
            Node::Multiply(a, b) => self.multiply(map(a), map(b)),
            Node::Apply(a, b) => self.apply(map(a), map(b)),
            Node::Transpose(a) => self.transpose(map(a)),
            Node::Dot(a, b) => self.dot(map(a), map(b)),
            Node::Trace(a) => self.trace(map(a)),
            Node::Determinant(a) => self.determinant(map(a)),
            Node::Cofactor(a) => self.cofactor(map(a)),
            Node::Cross(a, b) => self.cross(map(a), map(b)),
            Node::Outer(a, b) => self.outer(map(a), map(b)),
            Node::Entry(a, index) => self.entry(map(a), index),
            Node::Decompose(a) => self.decompose(map(a)),
            Node::Compose(a, b) => self.compose(map(a), map(b)),
            Node::StretchRates(a, b) => self.stretch_rates(map(a), map(b)),
        }
    }
}

#[cfg(test)]
mod tests;
