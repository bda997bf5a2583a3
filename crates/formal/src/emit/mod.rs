//! Expressions written out: as text that can be read back, as LaTeX, Rust, WGSL and a program for Maxima.
//!
//! Parts that are used more than once, or grow too long for a line, get a line of their own before they are used. All
//! styles share one walk over the graph and differ in how they write an operation.

mod boxes;
mod element;
mod fused;
mod kernel;
mod latex;
mod rust;
mod script;
mod stretches;
mod text;
mod wgsl;

use std::collections::HashMap;

pub use element::{ElementCode, Emitted};
pub use fused::{ElementHeading, element_kernel};
pub use kernel::{Heading, NoKernel, kernel};
pub use latex::Latex;
pub use rust::Rust;
pub use script::{maxima, maxima_name};
pub use text::Text;
pub use wgsl::Wgsl;

use crate::Function;
use crate::graph::{Comparison, Expr, Graph, Node, Shape};

/// How strongly a written expression binds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Binding {
    Sum,
    Product,
    /// A power, or a sign.
    Power,
    Atom,
}

/// A written expression.
#[derive(Clone, Debug)]
pub struct Written {
    pub text: String,
    pub binding: Binding,
}

impl Written {
    pub fn atom(text: impl Into<String>) -> Self {
        Self { text: text.into(), binding: Binding::Atom }
    }

    fn new(text: String, binding: Binding) -> Self {
        Self { text, binding }
    }
}

/// How operations are written.
pub trait Style {
    fn number(&self, value: f64) -> String;
    /// A name of the law, other than those that stand beside it.
    fn symbol(&self, name: &str) -> String {
        distinct(name, &[])
    }
    /// A name that the derivation made: `P0x`, `D_3`.
    fn own_symbol(&self, name: &str) -> String {
        name.to_owned()
    }
    /// Between the factors of a product.
    fn times(&self) -> &'static str {
        " * "
    }
    fn parentheses(&self, text: &str) -> String {
        format!("({text})")
    }
    fn quotient(&self, above: &Written, below: &Written) -> Written;
    /// A power whose exponent is a number.
    fn power(&self, base: &Written, exponent: f64) -> Written;
    fn power_of(&self, base: &Written, exponent: &Written) -> Written;
    fn function(&self, function: Function, argument: &Written) -> Written;
    /// `value` where `a` compares to `b`, else `otherwise`.
    fn select(&self, comparison: (Comparison, &str, &str), value: &str, otherwise: &str) -> Written;
    /// Tensor operations; the default is for languages that are given numbers only.
    fn tensor(&self, _node: &Node, _operands: &[Written]) -> Option<Written> {
        None
    }
    /// A number of a tensor of this shape, as [`Self::tensor`] writes that where nothing is said here.
    fn entry(&self, _shape: Shape, _tensor: &Written, _index: u8) -> Option<Written> {
        None
    }
    /// A line that names a part.
    fn definition(&self, name: &str, value: &str) -> String;
    /// Name of the `index`-th part.
    fn part(&self, index: usize) -> String {
        format!("t{index}")
    }
    /// Whether squares and the like are products of a named part.
    fn powers_are_products(&self) -> bool;
}

/// How a symbol is written; empty for other expressions.
pub fn symbol(graph: &Graph, expr: Expr, style: &dyn Style) -> String {
    graph.symbol_of(expr).map_or_else(String::new, |symbol| match symbol.own_name() {
        Some(own) => style.own_symbol(own),
        None => style.symbol(&symbol.name),
    })
}

/// A name of the law as it can stand beside names that the derivation makes and `taken` ones: with `_` behind it where it could be
/// one of them. No two names become the same.
fn distinct(name: &str, taken: &[&str]) -> String {
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let of_node = |text: &str| text.strip_suffix(['x', 'y', 'z']).is_some_and(digits);
    let is_own = name.strip_prefix(['P', 'U', 'V']).is_some_and(of_node)
        || ["t", "D_", "F_", "dF_"].iter().any(|prefix| name.strip_prefix(prefix).is_some_and(digits));
    if is_own || name.ends_with('_') || taken.contains(&name) { format!("{name}_") } else { name.to_owned() }
}

/// Characters after which an expression gets a line of its own.
const LONG: usize = 96;

/// Lines that define parts, and what `roots` are in terms of them.
pub fn write(graph: &Graph, roots: &[Expr], style: &dyn Style) -> (Vec<String>, Vec<String>) {
    let reachable = graph.reachable(roots);
    let mut uses: HashMap<Expr, usize> = HashMap::new();
    for operand in reachable.iter().flat_map(|expr| graph.node(*expr).operands()) {
        *uses.entry(operand).or_insert(0) += 1;
    }
    let mut bases: Vec<Expr> = Vec::new();
    if style.powers_are_products() {
        bases.extend(reachable.iter().filter_map(|expr| match graph.node(*expr) {
            Node::Power(base, exponent) if graph.value(*exponent).is_some_and(|n| n.abs() > 1.0) => {
                Some(*base)
            }
            _ => None,
        }));
    }
    let mut writer = Writer { graph, style, written: HashMap::new() };
    let mut lines = Vec::new();
    for expr in reachable {
        let written = writer.write(expr);
        let is_leaf =
            graph.node(expr).operands().next().is_none() || matches!(graph.node(expr), Node::Entry(..));
        let shared = uses.get(&expr).is_some_and(|count| *count > 1) || bases.contains(&expr);
        let is_condition = matches!(graph.node(expr), Node::Compare(..));
        let named =
            !is_leaf && !is_condition && uses.contains_key(&expr) && (shared || written.text.len() > LONG);
        // signs and the like are not worth a name
        if named && (written.text.len() > 8 || bases.contains(&expr)) {
            let name = style.part(lines.len());
            lines.push(style.definition(&name, &written.text));
            writer.written.insert(expr, Written::atom(name));
        } else {
            writer.written.insert(expr, written);
        }
    }
    let roots = roots.iter().map(|root| writer.written[root].text.clone()).collect();
    (lines, roots)
}

struct Writer<'a> {
    graph: &'a Graph,
    style: &'a dyn Style,
    written: HashMap<Expr, Written>,
}

impl Writer<'_> {
    fn write(&self, expr: Expr) -> Written {
        let of = |operand: &Expr| &self.written[operand];
        match self.graph.node(expr) {
            Node::Number(bits) => {
                let value = bits.value();
                let text = self.style.number(value);
                let binding = match text.contains('/') {
                    _ if value < 0.0 => Binding::Sum,
                    true => Binding::Product,
                    false => Binding::Atom,
                };
                Written::new(text, binding)
            }
            Node::Symbol(_) => Written::atom(symbol(self.graph, expr, self.style)),
            Node::Sum(terms) => self.sum(terms),
            Node::Product(factors) => self.product(factors),
            Node::Scale(factor, tensor) => self.product(&[*factor, *tensor]),
            Node::Power(base, exponent) => match self.graph.value(*exponent) {
                Some(value) if value < 0.0 => {
                    let below = self.power(of(base), -value);
                    self.style.quotient(&Written::atom(self.style.number(1.0)), &below)
                }
                Some(value) => self.power(of(base), value),
                None => self.style.power_of(of(base), of(exponent)),
            },
            Node::Function(function, argument) => self.style.function(*function, of(argument)),
            Node::Compare(comparison, a, b) => {
                let (one, zero) = (self.style.number(1.0), self.style.number(0.0));
                self.style.select((*comparison, &of(a).text, &of(b).text), &one, &zero)
            }
            Node::Select(condition, value, otherwise) => {
                let (value, otherwise) = (&of(value).text, &of(otherwise).text);
                match self.graph.node(*condition) {
                    Node::Compare(comparison, a, b) => {
                        self.style.select((*comparison, &of(a).text, &of(b).text), value, otherwise)
                    }
                    _ => {
                        let zero = self.style.number(0.0);
                        self.style.select((Comparison::Less, &zero, &of(condition).text), value, otherwise)
                    }
                }
            }
            node => {
                let operands: Vec<Written> = node.operands().map(|operand| of(&operand).clone()).collect();
                let entry = match node {
                    Node::Entry(a, index) => self.style.entry(self.graph.shape(*a), of(a), *index),
                    _ => None,
                };
                entry.or_else(|| self.style.tensor(node, &operands)).unwrap_or_else(|| Written::atom("?"))
            }
        }
    }

    fn power(&self, base: &Written, exponent: f64) -> Written {
        let whole = exponent.fract() == 0.0 && (1.0..=64.0).contains(&exponent);
        if exponent == 1.0 {
            return base.clone();
        }
        if whole && self.style.powers_are_products() {
            let factor = self.within(base, Binding::Power);
            let product = vec![factor; exponent as usize].join(self.style.times());
            return Written::new(product, Binding::Product);
        }
        self.style.power(base, exponent)
    }

    /// In parentheses where it binds less than that.
    fn within(&self, written: &Written, weakest: Binding) -> String {
        if written.binding < weakest { self.style.parentheses(&written.text) } else { written.text.clone() }
    }

    fn sum(&self, terms: &[Expr]) -> Written {
        let mut text = String::new();
        // what is positive stands first, where anything is
        let (mut ordered, negative): (Vec<Expr>, Vec<Expr>) =
            terms.iter().partition(|term| !self.is_negative(**term));
        ordered.extend(negative);
        for term in ordered {
            let written = &self.written[&term];
            if self.is_negative(term)
                && let Some(positive) = written.text.strip_prefix('-')
            {
                text += if text.is_empty() { "-" } else { " - " };
                text += positive;
            } else {
                if !text.is_empty() {
                    text += " + ";
                }
                // a sum within a sum keeps its parentheses: floating point sums are not associative
                text += &self.within(written, Binding::Product);
            }
        }
        Written::new(text, Binding::Sum)
    }

    /// Whether a term is written with a sign in front.
    fn is_negative(&self, term: Expr) -> bool {
        let negative = |expr: &Expr| self.graph.value(*expr).is_some_and(|value| value < 0.0);
        let written = || self.written.get(&term).is_some_and(|written| written.text.starts_with('-'));
        match self.graph.node(term) {
            Node::Number(_) => negative(&term),
            Node::Product(factors) => factors.iter().any(negative) && written(),
            Node::Scale(factor, _) => negative(factor) && written(),
            _ => false,
        }
    }

    fn product(&self, factors: &[Expr]) -> Written {
        let (mut coefficient, mut above, mut below) = (1.0, Vec::new(), Vec::new());
        for factor in factors {
            if let Some(value) = self.graph.value(*factor) {
                coefficient *= value;
                continue;
            }
            match self.graph.node(*factor) {
                // a part that has a name is written by it
                Node::Power(base, exponent) if self.written[factor].binding != Binding::Atom => {
                    match self.graph.value(*exponent) {
                        Some(value) if value < 0.0 => below.push(self.power(&self.written[base], -value)),
                        _ => above.push(self.written[factor].clone()),
                    }
                }
                _ => above.push(self.written[factor].clone()),
            }
        }
        let sign = if coefficient < 0.0 { "-" } else { "" };
        let size = f64::abs(coefficient);
        if size != 1.0 || above.is_empty() {
            above.insert(0, Written::atom(self.style.number(size)));
        }
        let join = |list: &[Written]| -> Written {
            if let [one] = list {
                return one.clone();
            }
            let factors: Vec<String> =
                list.iter().map(|factor| self.within(factor, Binding::Product)).collect();
            Written::new(factors.join(self.style.times()), Binding::Product)
        };
        let product = match (join(&above), below.is_empty()) {
            (above, true) => above,
            (above, false) => self.style.quotient(&above, &join(&below)),
        };
        if sign.is_empty() {
            return product;
        }
        Written::new(format!("-{}", self.within(&product, Binding::Product)), Binding::Sum)
    }
}

#[cfg(test)]
mod tests;
