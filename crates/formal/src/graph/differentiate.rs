//! Derivatives: along directions (forward) and by a tensor (backward).
//!
//! Both work on whole tensors, so the stress of an energy and its differential stay short. Within the energy the path
//! from a scalar down to the invariants of tensors is differentiated forward: a branch of `if` that is not taken then
//! never meets the derivative of the other one, which may have no value there.

use std::collections::{BTreeMap, HashMap};

use super::{Comparison, Expr, Graph, Node, Shape};
use crate::Function;

impl Graph {
    /// Derivative of a number by a number (a symbol, or any expression treated as independent).
    pub fn derivative(&mut self, expr: Expr, by: Expr) -> Expr {
        let one = self.number(1.0);
        self.differential(expr, &HashMap::from([(by, one)]))
    }

    /// Differential of `expr` where the expressions in `seeds` vary by what they are mapped to.
    pub fn differential(&mut self, expr: Expr, seeds: &HashMap<Expr, Expr>) -> Expr {
        let mut varying: Vec<Expr> = seeds.keys().copied().collect();
        varying.sort_unstable();
        let depends = self.depends(&[expr], &varying);
        let mut made = seeds.clone();
        for node in self.reachable(&[expr]) {
            if !made.contains_key(&node) && depends[node.index()] {
                let differential = self.differential_of(node, &made);
                made.insert(node, differential);
            }
        }
        made.get(&expr).copied().unwrap_or_else(|| self.zero(self.shape(expr)))
    }

    /// The differential of one node from those of its operands; operands without one do not vary.
    fn differential_of(&mut self, expr: Expr, made: &HashMap<Expr, Expr>) -> Expr {
        if self.is_exhausted() {
            return self.zero(self.shape(expr));
        }
        let d = |operand: Expr| made.get(&operand).copied();
        let mut terms = Vec::new();
        match self.node(expr).clone() {
            Node::Number(_) | Node::Symbol(_) | Node::Zero(_) | Node::Identity | Node::Compare(..) => {}
            Node::Sum(list) => terms.extend(list.iter().filter_map(|term| d(*term))),
            Node::Product(factors) => {
                for (position, factor) in factors.iter().enumerate() {
                    if let Some(differential) = d(*factor).filter(|_| !self.is_exhausted()) {
                        let mut product = factors.to_vec();
                        product[position] = differential;
                        terms.push(self.product(&product));
                    }
                }
            }
            Node::Power(base, exponent) => {
                if let Some(differential) = d(base) {
                    // y xʸ⁻¹ dx
                    let minus_one = self.number(-1.0);
                    let lower = self.sum(&[exponent, minus_one]);
                    let power = self.power(base, lower);
                    terms.push(self.product(&[exponent, power, differential]));
                }
                if let Some(differential) = d(exponent) {
                    // xʸ ln x dy
                    let logarithm = self.function(Function::Ln, base);
                    terms.push(self.product(&[expr, logarithm, differential]));
                }
            }
            Node::Function(function, argument) => {
                if let Some(differential) = d(argument) {
                    let slope = self.slope(function, argument, expr);
                    terms.push(self.product(&[slope, differential]));
                }
            }
            Node::Select(condition, value, otherwise) => {
                let zero = self.number(0.0);
                let (value, otherwise) = (d(value).unwrap_or(zero), d(otherwise).unwrap_or(zero));
                terms.push(self.select_of_multiples(condition, value, otherwise));
            }
            Node::Scale(a, b) => self.product_rule(&mut terms, (a, b), &d, Self::scale),
            Node::Multiply(a, b) => self.product_rule(&mut terms, (a, b), &d, Self::multiply),
            Node::Apply(a, b) => self.product_rule(&mut terms, (a, b), &d, Self::apply),
            Node::Dot(a, b) => self.product_rule(&mut terms, (a, b), &d, Self::dot),
            Node::Cross(a, b) => self.product_rule(&mut terms, (a, b), &d, Self::cross),
            Node::Outer(a, b) => self.product_rule(&mut terms, (a, b), &d, Self::outer),
            Node::Transpose(a) => terms.extend(d(a).map(|da| self.transpose(da))),
            Node::Trace(a) => terms.extend(d(a).map(|da| self.trace(da))),
            Node::Determinant(a) => {
                if let Some(da) = d(a) {
                    let cofactor = self.cofactor(a);
                    terms.push(self.dot(cofactor, da));
                }
            }
            Node::Cofactor(a) => terms.extend(d(a).map(|da| self.cross(a, da))),
            Node::Entry(tensor, index) => match (self.node(tensor).clone(), self.shape(tensor)) {
                (Node::Decompose(matrix), _) => {
                    if let Some(da) = d(matrix) {
                        let rates = self.stretch_rates(tensor, da);
                        terms.push(self.entry(rates, index - super::spectral::STRETCHES));
                    }
                }
                _ => terms.extend(d(tensor).map(|dt| self.entry(dt, index))),
            },
            Node::Pack(entries) => {
                let zero = self.number(0.0);
                let entries: Vec<Expr> = entries.iter().map(|entry| d(*entry).unwrap_or(zero)).collect();
                terms.push(self.pack(&entries));
            }
            Node::Compose(decomposition, g) => {
                if let Node::Decompose(matrix) = *self.node(decomposition)
                    && let Some(df) = d(matrix)
                {
                    let dg = d(g).unwrap_or_else(|| self.zero(Shape::Vector));
                    let limits = self.quotient_limits(decomposition, g);
                    terms.push(self.compose_differential([decomposition, g, dg, limits, df]));
                }
            }
            // varies with its operand, and is met only through its entries and through `Compose`
            Node::Decompose(matrix) => return d(matrix).unwrap_or(expr),
            Node::StretchRates(..) | Node::ComposeDifferential(..) => {
                unreachable!("second differentials of stretches are not taken: laws need two derivatives")
            }
        }
        if terms.is_empty() {
            return self.zero(self.shape(expr));
        }
        self.sum(&terms)
    }

    fn product_rule(
        &mut self,
        terms: &mut Vec<Expr>,
        (a, b): (Expr, Expr),
        d: &impl Fn(Expr) -> Option<Expr>,
        make: fn(&mut Self, Expr, Expr) -> Expr,
    ) {
        if let Some(da) = d(a) {
            terms.push(make(self, da, b));
        }
        if let Some(db) = d(b) {
            terms.push(make(self, a, db));
        }
    }

    /// `f'(x)`, with `value = f(x)` at hand.
    fn slope(&mut self, function: Function, x: Expr, value: Expr) -> Expr {
        let one = self.number(1.0);
        let square = |graph: &mut Self, a: Expr| graph.power_number(a, 2.0);
        match function {
            Function::Sin => self.function(Function::Cos, x),
            Function::Cos => {
                let sine = self.function(Function::Sin, x);
                self.negate(sine)
            }
            Function::Tan => {
                let square = square(self, value);
                self.sum(&[one, square])
            }
            Function::Asin | Function::Acos => {
                let square = square(self, x);
                let rest = self.subtract(one, square);
                let slope = self.power_number(rest, -0.5);
                if function == Function::Acos { self.negate(slope) } else { slope }
            }
            Function::Atan => {
                let square = square(self, x);
                let sum = self.sum(&[one, square]);
                self.power_number(sum, -1.0)
            }
            Function::Sinh => self.function(Function::Cosh, x),
            Function::Cosh => self.function(Function::Sinh, x),
            Function::Tanh => {
                let square = square(self, value);
                self.subtract(one, square)
            }
            Function::Exp => value,
            Function::Ln => self.power_number(x, -1.0),
            Function::Log10 => {
                let slope = self.power_number(x, -1.0);
                self.times_number(std::f64::consts::LOG10_E, slope)
            }
            Function::Cbrt => {
                let slope = self.power_number(value, -2.0);
                self.times_number(1.0 / 3.0, slope)
            }
            // at zero that of one side, so that `|x|²`, which is smooth, keeps its second derivative
            Function::Abs => {
                let zero = self.number(0.0);
                let (minus_one, negative) = (self.number(-1.0), self.compare(Comparison::Less, x, zero));
                self.select(negative, minus_one, one)
            }
            // steps are flat
            _ => self.number(0.0),
        }
    }

    /// `∂ψ/∂A`, entry by entry, of the number `psi` by the matrix or vector `by`.
    pub fn gradient(&mut self, psi: Expr, by: Expr) -> Expr {
        let mut adjoints = Adjoints::default();
        let one = self.number(1.0);
        adjoints.add(psi, one);
        // adjoints are of what the number is made of
        let depends = self.depends(&[psi], &[by]);
        while let Some((expr, adjoint)) = adjoints.pop(self) {
            if self.is_exhausted() {
                break;
            }
            if expr == by {
                return adjoint;
            }
            if expr > by {
                self.push_back(expr, adjoint, &depends, &mut adjoints);
            }
        }
        self.zero(self.shape(by))
    }

    /// Adds to the adjoints of the operands of `expr` what its own adjoint gives them.
    fn push_back(&mut self, expr: Expr, adjoint: Expr, dependent: &[bool], adjoints: &mut Adjoints) {
        let depends = |operand: Expr| dependent[operand.index()];
        match self.node(expr).clone() {
            Node::Sum(terms) if self.shape(expr) != Shape::Scalar => {
                terms.iter().filter(|term| depends(**term)).for_each(|term| adjoints.add(*term, adjoint));
            }
            Node::Scale(factor, tensor) => {
                if depends(tensor) {
                    let back = self.scale(factor, adjoint);
                    adjoints.add(tensor, back);
                }
                if depends(factor) {
                    let back = self.dot(adjoint, tensor);
                    adjoints.add(factor, back);
                }
            }
            Node::Multiply(a, b) => {
                if depends(a) {
                    let bt = self.transpose(b);
                    let back = self.multiply(adjoint, bt);
                    adjoints.add(a, back);
                }
                if depends(b) {
                    let at = self.transpose(a);
                    let back = self.multiply(at, adjoint);
                    adjoints.add(b, back);
                }
            }
            Node::Apply(matrix, vector) => {
                if depends(matrix) {
                    let back = self.outer(adjoint, vector);
                    adjoints.add(matrix, back);
                }
                if depends(vector) {
                    let transposed = self.transpose(matrix);
                    let back = self.apply(transposed, adjoint);
                    adjoints.add(vector, back);
                }
            }
            Node::Transpose(a) => {
                let back = self.transpose(adjoint);
                adjoints.add(a, back);
            }
            Node::Cofactor(a) => {
                let back = self.cross(a, adjoint);
                adjoints.add(a, back);
            }
            Node::Cross(a, b) => {
                for (a, b) in [(a, b), (b, a)] {
                    if depends(a) {
                        let back = self.cross(b, adjoint);
                        adjoints.add(a, back);
                    }
                }
            }
            Node::Outer(u, v) => {
                if depends(u) {
                    let back = self.apply(adjoint, v);
                    adjoints.add(u, back);
                }
                if depends(v) {
                    let transposed = self.transpose(adjoint);
                    let back = self.apply(transposed, u);
                    adjoints.add(v, back);
                }
            }
            Node::Pack(entries) => {
                for (index, entry) in entries.iter().enumerate().filter(|(_, entry)| depends(**entry)) {
                    let back = self.entry(adjoint, index as u8);
                    adjoints.add(*entry, back);
                }
            }
            Node::Dot(a, b) => {
                for (a, b) in [(a, b), (b, a)] {
                    if depends(a) {
                        let back = self.scale(adjoint, b);
                        adjoints.add(a, back);
                    }
                }
            }
            Node::Trace(a) => {
                let identity = self.identity();
                let back = self.scale(adjoint, identity);
                adjoints.add(a, back);
            }
            Node::Determinant(a) => {
                let cofactor = self.cofactor(a);
                let back = self.scale(adjoint, cofactor);
                adjoints.add(a, back);
            }
            Node::Entry(tensor, index) => adjoints.add_entry(tensor, index, adjoint),
            Node::Decompose(matrix) => {
                let back = self.compose(expr, adjoint);
                adjoints.add(matrix, back);
            }
            Node::Compose(..) | Node::StretchRates(..) | Node::ComposeDifferential(..) => {
                unreachable!("an energy has no differentials in it")
            }
            _ => self.push_to_invariants(expr, adjoint, dependent, adjoints),
        }
    }

    /// A choice of two numbers with the factors before it that both have: rates of one invariant, mostly, so that what is chosen does
    /// not vary with the direction. Zero has every factor that is finite wherever `F` is.
    fn select_of_multiples(&mut self, condition: Expr, value: Expr, otherwise: Expr) -> Expr {
        let [first, second] = [value, otherwise].map(|branch| self.factors_of(branch));
        let zero_has = |graph: &Self, factor: &Expr| graph.is_polynomial(*factor);
        let common: Vec<Expr> = match (self.is_zero(value), self.is_zero(otherwise)) {
            (true, _) => second.into_iter().filter(|factor| zero_has(self, factor)).collect(),
            (_, true) => first.into_iter().filter(|factor| zero_has(self, factor)).collect(),
            _ => first.into_iter().filter(|factor| second.contains(factor)).collect(),
        };
        let [value, otherwise] = [value, otherwise].map(|branch| self.without_factors(branch, &common));
        let chosen = self.select(condition, value, otherwise);
        let factors: Vec<Expr> = common.into_iter().chain([chosen]).collect();
        self.product(&factors)
    }

    /// What a product is of, or all addends of a sum have; numbers are none.
    fn factors_of(&self, expr: Expr) -> Vec<Expr> {
        match self.node(expr) {
            Node::Number(_) => Vec::new(),
            Node::Product(factors) => {
                factors.iter().copied().filter(|factor| self.value(*factor).is_none()).collect()
            }
            Node::Sum(terms) => {
                let mut common = self.factors_of(terms[0]);
                for term in &terms[1..] {
                    let factors = self.factors_of(*term);
                    common.retain(|factor| factors.contains(factor));
                }
                if common.is_empty() { vec![expr] } else { common }
            }
            _ => vec![expr],
        }
    }

    /// What stands beside factors that [`Self::factors_of`] gives; of zero it is zero.
    fn without_factors(&mut self, expr: Expr, common: &[Expr]) -> Expr {
        if common.is_empty() || self.is_zero(expr) {
            return expr;
        }
        match self.node(expr).clone() {
            Node::Sum(terms) if !common.contains(&expr) => {
                let terms: Vec<Expr> = terms.iter().map(|term| self.without_factors(*term, common)).collect();
                self.sum(&terms)
            }
            Node::Product(factors) => {
                let rest: Vec<Expr> =
                    factors.iter().copied().filter(|factor| !common.contains(factor)).collect();
                self.product(&rest)
            }
            _ => self.number(1.0),
        }
    }

    /// Whether it is a sum of products of entries of symbols.
    fn is_polynomial(&self, expr: Expr) -> bool {
        match self.node(expr) {
            Node::Number(_) | Node::Symbol(_) | Node::Zero(_) | Node::Identity => true,
            Node::Power(base, exponent) => {
                let is_whole = |value: f64| value >= 0.0 && value.fract() == 0.0;
                self.value(*exponent).is_some_and(is_whole) && self.is_polynomial(*base)
            }
            Node::Sum(_)
            | Node::Product(_)
            | Node::Scale(..)
            | Node::Multiply(..)
            | Node::Apply(..)
            | Node::Transpose(_)
            | Node::Dot(..)
            | Node::Trace(_)
            | Node::Determinant(_)
            | Node::Cofactor(_)
            | Node::Cross(..)
            | Node::Outer(..)
            | Node::Entry(..)
            | Node::Pack(_) => self.node(expr).operands().all(|operand| self.is_polynomial(operand)),
            _ => false,
        }
    }

    /// For a number made of numbers: hands the adjoint to the invariants of tensors it is made of.
    fn push_to_invariants(&mut self, expr: Expr, adjoint: Expr, dependent: &[bool], adjoints: &mut Adjoints) {
        let invariants = self.invariants(expr, dependent);
        let zero = self.number(0.0);
        let constant: HashMap<Expr, Expr> = invariants.iter().map(|invariant| (*invariant, zero)).collect();
        for invariant in &invariants {
            if self.is_exhausted() {
                return;
            }
            let mut seeds = constant.clone();
            seeds.insert(*invariant, self.number(1.0));
            let partial = self.differential(expr, &seeds);
            let back = self.product(&[adjoint, partial]);
            adjoints.add(*invariant, back);
        }
    }

    /// The numbers taken directly from tensors that vary, as `depends` says, below `expr`.
    fn invariants(&self, expr: Expr, depends: &[bool]) -> Vec<Expr> {
        let mut found = Vec::new();
        let mut remaining = vec![expr];
        let mut seen = std::collections::HashSet::new();
        while let Some(expr) = remaining.pop() {
            if !seen.insert(expr) || !depends[expr.index()] {
                continue;
            }
            match self.node(expr) {
                Node::Dot(..) | Node::Trace(_) | Node::Determinant(_) | Node::Entry(..) => found.push(expr),
                node => remaining.extend(node.operands()),
            }
        }
        found.sort_unstable();
        found
    }
}

/// Adjoints not yet handed on, taken out from the latest expression to the earliest.
#[derive(Default)]
struct Adjoints {
    terms: BTreeMap<Expr, Vec<Expr>>,
    entries: BTreeMap<Expr, BTreeMap<u8, Vec<Expr>>>,
}

impl Adjoints {
    fn add(&mut self, expr: Expr, adjoint: Expr) {
        self.terms.entry(expr).or_default().push(adjoint);
    }

    fn add_entry(&mut self, tensor: Expr, index: u8, adjoint: Expr) {
        self.entries.entry(tensor).or_default().entry(index).or_default().push(adjoint);
    }

    fn pop(&mut self, graph: &mut Graph) -> Option<(Expr, Expr)> {
        let of_terms = self.terms.last_key_value().map(|(expr, _)| *expr);
        let of_entries = self.entries.last_key_value().map(|(expr, _)| *expr);
        let expr = of_terms.max(of_entries)?;
        let mut terms = self.terms.remove(&expr).unwrap_or_default();
        if let Some(entries) = self.entries.remove(&expr) {
            let (first, len) = match graph.shape(expr) {
                // the adjoint of a decomposition is that of its stretches
                Shape::Decomposition => (super::spectral::STRETCHES, 3),
                shape => (0, shape.size() as u8),
            };
            let zero = graph.number(0.0);
            let packed: Vec<Expr> = (first..first + len)
                .map(|index| entries.get(&index).map_or(zero, |terms| graph.sum(terms)))
                .collect();
            terms.push(graph.pack(&packed));
        }
        Some((expr, graph.sum(&terms)))
    }
}
