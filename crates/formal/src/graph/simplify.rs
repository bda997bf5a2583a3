//! Numbers: every way to make one simplifies on the spot.
//!
//! Like terms and equal bases are collected, constants folded, `a - b` is `a + (-1) b` and `a / b` is `a b⁻¹`. Nothing is
//! multiplied out: that would lose the factors that grouped constants and short code live from.

use super::{Comparison, Expr, Graph, Node, Shape};
use crate::{Function, arithmetic};

impl Graph {
    /// Sum of expressions of one shape.
    pub fn sum(&mut self, terms: &[Expr]) -> Expr {
        let Some(first) = terms.first() else { return self.number(0.0) };
        let shape = self.shape(*first);
        let mut constant = 0.0;
        let mut collected: Vec<(Expr, f64)> = Vec::with_capacity(terms.len());
        let mut remaining: Vec<(f64, Expr)> = terms.iter().rev().map(|term| (1.0, *term)).collect();
        while let Some((factor, term)) = remaining.pop() {
            debug_assert_eq!(self.shape(term), shape, "terms of one shape");
            let (coefficient, rest) = self.split_coefficient(term);
            let coefficient = coefficient * factor;
            match rest {
                None => constant += coefficient,
                Some(rest) => match self.node(rest) {
                    Node::Zero(_) => {}
                    Node::Sum(inner) if coefficient.abs() == 1.0 => {
                        remaining.extend(inner.iter().rev().map(|term| (coefficient, *term)));
                    }
                    _ => collected.push((rest, coefficient)),
                },
            }
        }
        // stable: like terms are added up in the order in which they came
        collected.sort_by_key(|(rest, _)| *rest);
        collected.dedup_by(|(rest, coefficient), (first, sum)| {
            let is_like = rest == first;
            if is_like {
                *sum += *coefficient;
            }
            is_like
        });
        if shape == Shape::Matrix {
            self.collect_multiples_of_identity(&mut collected);
        }
        let mut sum = Vec::with_capacity(collected.len() + 1);
        if constant != 0.0 {
            sum.push(self.number(constant));
        }
        for (rest, coefficient) in collected {
            if coefficient != 0.0 {
                sum.push(self.times_number(coefficient, rest));
            }
        }
        match sum.len() {
            0 => self.zero(shape),
            1 => sum[0],
            _ => {
                sum.sort_unstable();
                self.intern(Node::Sum(sum.into()), shape)
            }
        }
    }

    /// `s I + t I` is `(s + t) I`: one term.
    fn collect_multiples_of_identity(&mut self, collected: &mut Vec<(Expr, f64)>) {
        let factor_of = |graph: &Self, rest: Expr| match graph.node(rest) {
            Node::Identity => Some(None),
            Node::Scale(factor, tensor) if *graph.node(*tensor) == Node::Identity => Some(Some(*factor)),
            _ => None,
        };
        let multiples: Vec<(f64, Option<Expr>)> = collected
            .iter()
            .filter_map(|(rest, coefficient)| Some((*coefficient, factor_of(self, *rest)?)))
            .collect();
        if multiples.len() < 2 {
            return;
        }
        collected.retain(|(rest, _)| factor_of(self, *rest).is_none());
        let mut factors = Vec::with_capacity(multiples.len());
        for (coefficient, factor) in multiples {
            factors.push(match factor {
                Some(factor) => self.times_number(coefficient, factor),
                None => self.number(coefficient),
            });
        }
        let (factor, identity) = (self.sum(&factors), self.identity());
        let multiple = self.scale(factor, identity);
        if !self.is_zero(multiple)
            && let (coefficient, Some(rest)) = self.split_coefficient(multiple)
        {
            let place = collected.partition_point(|(other, _)| *other < rest);
            collected.insert(place, (rest, coefficient));
        }
    }

    pub fn add(&mut self, a: Expr, b: Expr) -> Expr {
        self.sum(&[a, b])
    }

    pub fn subtract(&mut self, a: Expr, b: Expr) -> Expr {
        let minus = self.negate(b);
        self.sum(&[a, minus])
    }

    pub fn negate(&mut self, a: Expr) -> Expr {
        self.times_number(-1.0, a)
    }

    /// `value · expr`, of any shape.
    pub fn times_number(&mut self, value: f64, expr: Expr) -> Expr {
        let number = self.number(value);
        if self.shape(expr) == Shape::Scalar {
            self.product(&[number, expr])
        } else {
            self.scale(number, expr)
        }
    }

    /// The numeric factor of an expression and what it multiplies; nothing for a number alone.
    pub(crate) fn split_coefficient(&mut self, expr: Expr) -> (f64, Option<Expr>) {
        match self.node(expr) {
            Node::Number(bits) => (bits.value(), None),
            Node::Product(factors) => {
                if !factors.iter().any(|factor| self.value(*factor).is_some()) {
                    return (1.0, Some(expr));
                }
                let factors = factors.clone();
                let (numbers, others): (Vec<Expr>, Vec<Expr>) =
                    factors.iter().partition(|factor| self.value(**factor).is_some());
                let coefficient = numbers.iter().filter_map(|number| self.value(*number)).product();
                (coefficient, Some(self.product(&others)))
            }
            Node::Scale(factor, tensor) => {
                let (factor, tensor) = (*factor, *tensor);
                let (coefficient, rest) = self.split_coefficient(factor);
                let rest = rest.map_or(tensor, |rest| self.scale(rest, tensor));
                (coefficient, Some(rest))
            }
            _ => (1.0, Some(expr)),
        }
    }

    /// Product of numbers.
    pub fn product(&mut self, factors: &[Expr]) -> Expr {
        let mut coefficient = 1.0;
        // base, exponent, and the power of both
        let mut powers: Vec<(Expr, Expr, Expr)> = Vec::with_capacity(factors.len());
        let one = self.number(1.0);
        let mut remaining: Vec<Expr> = factors.iter().rev().copied().collect();
        while let Some(factor) = remaining.pop() {
            match self.node(factor) {
                Node::Number(bits) => coefficient *= bits.value(),
                Node::Product(inner) => remaining.extend(inner.iter().rev()),
                Node::Power(base, exponent) => powers.push((*base, *exponent, factor)),
                _ => powers.push((factor, one, factor)),
            }
        }
        if coefficient == 0.0 {
            return self.number(0.0);
        }
        powers.sort_by_key(|(base, ..)| *base);
        let mut product = Vec::with_capacity(powers.len() + 1);
        for equal in powers.chunk_by(|(base, ..), (next, ..)| base == next) {
            let power = match equal {
                [(_, _, power)] => *power,
                _ => {
                    let exponents: Vec<Expr> = equal.iter().map(|(_, exponent, _)| *exponent).collect();
                    let exponent = self.sum(&exponents);
                    self.power(equal[0].0, exponent)
                }
            };
            match self.node(power) {
                Node::Number(bits) => coefficient *= bits.value(),
                Node::Product(inner) => product.extend(inner.iter().copied()),
                _ => product.push(power),
            }
        }
        if coefficient != 1.0 || product.is_empty() {
            product.push(self.number(coefficient));
        }
        if product.len() == 1 {
            return product[0];
        }
        product.sort_unstable();
        self.intern(Node::Product(product.into()), Shape::Scalar)
    }

    pub fn times(&mut self, a: Expr, b: Expr) -> Expr {
        self.product(&[a, b])
    }

    pub fn divide(&mut self, a: Expr, b: Expr) -> Expr {
        let inverse = self.power_number(b, -1.0);
        self.product(&[a, inverse])
    }

    pub fn power_number(&mut self, base: Expr, exponent: f64) -> Expr {
        let exponent = self.number(exponent);
        self.power(base, exponent)
    }

    pub fn power(&mut self, base: Expr, exponent: Expr) -> Expr {
        let exponent = match self.value(exponent) {
            Some(value) => self.number(fraction(value)),
            None => exponent,
        };
        let whole = |value: f64| value.fract() == 0.0;
        match (self.value(base), self.value(exponent)) {
            (_, Some(0.0)) => return self.number(1.0),
            (_, Some(1.0)) => return base,
            (Some(1.0), _) => return base,
            // 0^-1 stays written, so that a division by zero is found where it stands
            (Some(x), Some(y)) if arithmetic_power(x, y).is_finite() => {
                return self.number(arithmetic_power(x, y));
            }
            (None, Some(n)) if whole(n) => match self.node(base).clone() {
                // (bᵐ)ⁿ = bᵐⁿ holds for whole n wherever the left side has a value
                Node::Power(inner, m) => {
                    let n = self.number(n);
                    let exponent = self.product(&[m, n]);
                    return self.power(inner, exponent);
                }
                Node::Product(factors) => {
                    let factors: Vec<Expr> =
                        factors.iter().map(|factor| self.power_number(*factor, n)).collect();
                    return self.product(&factors);
                }
                Node::Function(Function::Abs, inner) if n % 2.0 == 0.0 => return self.power(inner, exponent),
                _ => {}
            },
            _ => {}
        }
        self.intern(Node::Power(base, exponent), Shape::Scalar)
    }

    /// A function of one number.
    pub fn function(&mut self, function: Function, argument: Expr) -> Expr {
        if function == Function::Sqrt {
            return self.power_number(argument, 0.5);
        }
        if let Some(x) = self.value(argument) {
            let value = arithmetic::of_one(function, x);
            if value.is_finite() {
                return self.number(value);
            }
        }
        self.intern(Node::Function(function, argument), Shape::Scalar)
    }

    pub fn compare(&mut self, comparison: Comparison, a: Expr, b: Expr) -> Expr {
        if let (Some(x), Some(y)) = (self.value(a), self.value(b)) {
            return self.number(comparison.holds(x, y));
        }
        self.intern(Node::Compare(comparison, a, b), Shape::Scalar)
    }

    /// `value` where `condition` is not zero, else `otherwise`.
    pub fn select(&mut self, condition: Expr, value: Expr, otherwise: Expr) -> Expr {
        match self.value(condition) {
            Some(0.0) => otherwise,
            Some(_) => value,
            None if value == otherwise => value,
            None => self.intern(Node::Select(condition, value, otherwise), Shape::Scalar),
        }
    }

    pub fn minimum(&mut self, a: Expr, b: Expr) -> Expr {
        let less = self.compare(Comparison::Less, a, b);
        self.select(less, a, b)
    }

    pub fn maximum(&mut self, a: Expr, b: Expr) -> Expr {
        let less = self.compare(Comparison::Less, b, a);
        self.select(less, a, b)
    }

    /// Whether the expression is the number or tensor of zeros.
    pub fn is_zero(&self, expr: Expr) -> bool {
        matches!(self.node(expr), Node::Zero(_)) || self.value(expr) == Some(0.0)
    }

    pub fn zero(&mut self, shape: Shape) -> Expr {
        if shape == Shape::Scalar { self.number(0.0) } else { self.intern(Node::Zero(shape), shape) }
    }
}

impl Comparison {
    pub(crate) fn holds(self, a: f64, b: f64) -> f64 {
        f64::from(u8::from(match self {
            Self::Less => a < b,
            Self::LessOrEqual => a <= b,
            Self::Equal => a == b,
        }))
    }
}

/// The thirds, sevenths, ninths or elevenths that a number is but for what subtractions rounded: `8/3 - 1` is `5/3`.
fn fraction(value: f64) -> f64 {
    let rounding = 4.0 * f64::EPSILON * value.abs().max(1.0);
    let nearest = |below: f64| (value * below).round() / below;
    let near = [1.0, 3.0, 7.0, 9.0, 11.0].into_iter().map(nearest);
    near.into_iter().find(|fraction| (fraction - value).abs() <= rounding).unwrap_or(value)
}

/// `x^y`, small whole powers as products.
pub(crate) fn arithmetic_power(x: f64, y: f64) -> f64 {
    if y.fract() == 0.0 && y.abs() <= 8.0 { arithmetic::whole_power(x, y as i32) } else { libm::pow(x, y) }
}
