//! The functions of the language on numbers and on dual numbers, from one text.
//!
//! Each function gives its value and, where a derivative is carried, its slope. At a corner (`abs`, `min`,
//! `floor`, …) the slope is that of one side, and zero for `abs` and `hypot`. Transcendental functions come
//! from `libm`, so that they give the same bits on every machine.

use std::ops::{Add, Div, Mul, Neg, Sub};

use souple_math::Dual;

use crate::{BinaryOperator, Function};

/// A number that a formula computes with.
pub(crate) trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    fn constant(value: f64) -> Self;
    fn value(self) -> f64;
    /// `f(self)` of that value, where `f'` is `slope`.
    fn chain(self, value: f64, slope: impl FnOnce() -> f64) -> Self;
    /// `f(self, other)` of that value, where the partial derivatives of `f` are `slopes`.
    fn chain_both(self, other: Self, value: f64, slopes: impl FnOnce() -> (f64, f64)) -> Self;
}

impl Number for f64 {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn value(self) -> f64 {
        self
    }
    #[inline(always)]
    fn chain(self, value: f64, _slope: impl FnOnce() -> f64) -> Self {
        value
    }
    #[inline(always)]
    fn chain_both(self, _other: Self, value: f64, _slopes: impl FnOnce() -> (f64, f64)) -> Self {
        value
    }
}

impl Number for Dual {
    fn constant(value: f64) -> Self {
        Dual::constant(value)
    }
    fn value(self) -> f64 {
        self.value
    }
    fn chain(self, value: f64, slope: impl FnOnce() -> f64) -> Self {
        Dual::new(value, along(slope(), self.derivative))
    }
    fn chain_both(self, other: Self, value: f64, slopes: impl FnOnce() -> (f64, f64)) -> Self {
        let (first, second) = slopes();
        Dual::new(value, along(first, self.derivative) + along(second, other.derivative))
    }
}

/// `slope · rate`, and zero for what does not move even where the slope is infinite (`sqrt(0)`).
fn along(slope: f64, rate: f64) -> f64 {
    if rate == 0.0 { 0.0 } else { slope * rate }
}

/// Truth as a number: 1 and 0.
fn truth<T: Number>(holds: bool) -> T {
    T::constant(f64::from(u8::from(holds)))
}

/// Whether a number made by [`truth`] stands for true.
pub(crate) fn holds<T: Number>(truth: T) -> bool {
    truth.value() != 0.0
}

/// `1` for false and `0` for true.
pub(crate) fn negation<T: Number>(operand: T) -> T {
    truth(!holds(operand))
}

#[inline(always)]
pub(crate) fn binary<T: Number>(operator: BinaryOperator, left: T, right: T) -> T {
    let (a, b) = (left.value(), right.value());
    match operator {
        BinaryOperator::Add => left + right,
        BinaryOperator::Subtract => left - right,
        BinaryOperator::Multiply => left * right,
        BinaryOperator::Divide => left / right,
        BinaryOperator::Power => power(left, right),
        BinaryOperator::Less => truth(a < b),
        BinaryOperator::LessOrEqual => truth(a <= b),
        BinaryOperator::Greater => truth(a > b),
        BinaryOperator::GreaterOrEqual => truth(a >= b),
        BinaryOperator::Equal => truth(a == b),
        BinaryOperator::NotEqual => truth(a != b),
        BinaryOperator::And => truth(holds(left) && holds(right)),
        BinaryOperator::Or => truth(holds(left) || holds(right)),
    }
}

// d(xʸ) = y xʸ⁻¹ dx + xʸ ln x dy
fn power<T: Number>(base: T, exponent: T) -> T {
    let (x, y) = (base.value(), exponent.value());
    let value = libm::pow(x, y);
    base.chain_both(exponent, value, || {
        // x⁰ is one everywhere, also where x⁻¹ is infinite; and xʸ ln x vanishes with x
        let by_base = if y == 0.0 { 0.0 } else { y * libm::pow(x, y - 1.0) };
        let by_exponent = if value == 0.0 { 0.0 } else { value * libm::log(x) };
        (by_base, by_exponent)
    })
}

/// `base^exponent` by squaring, for small whole exponents.
pub(crate) fn whole_power<T: Number>(base: T, exponent: i32) -> T {
    let mut remaining = exponent.unsigned_abs();
    let (mut square, mut product) = (base, None);
    while remaining > 0 {
        if remaining % 2 == 1 {
            product = Some(product.map_or(square, |product| product * square));
        }
        remaining /= 2;
        if remaining > 0 {
            square = square * square;
        }
    }
    let product = product.unwrap_or(T::constant(1.0));
    if exponent < 0 { T::constant(1.0) / product } else { product }
}

/// A function of one number; the table of functions says which these are.
pub(crate) fn of_one<T: Number>(function: Function, argument: T) -> T {
    let x = argument.value();
    match function {
        Function::Sin => argument.chain(libm::sin(x), || libm::cos(x)),
        Function::Cos => argument.chain(libm::cos(x), || -libm::sin(x)),
        Function::Tan => {
            let tangent = libm::tan(x);
            argument.chain(tangent, || 1.0 + tangent * tangent)
        }
        Function::Asin => argument.chain(libm::asin(x), || 1.0 / ((1.0 - x) * (1.0 + x)).sqrt()),
        Function::Acos => argument.chain(libm::acos(x), || -1.0 / ((1.0 - x) * (1.0 + x)).sqrt()),
        Function::Atan => argument.chain(libm::atan(x), || 1.0 / (1.0 + x * x)),
        Function::Sinh => argument.chain(libm::sinh(x), || libm::cosh(x)),
        Function::Cosh => argument.chain(libm::cosh(x), || libm::sinh(x)),
        Function::Tanh => {
            let tangent = libm::tanh(x);
            argument.chain(tangent, || (1.0 - tangent) * (1.0 + tangent))
        }
        Function::Exp => {
            let power = libm::exp(x);
            argument.chain(power, || power)
        }
        Function::Ln => argument.chain(libm::log(x), || 1.0 / x),
        Function::Log10 => argument.chain(libm::log10(x), || 1.0 / (x * std::f64::consts::LN_10)),
        Function::Sqrt => {
            let root = x.sqrt();
            argument.chain(root, || 0.5 / root)
        }
        Function::Cbrt => {
            let root = libm::cbrt(x);
            argument.chain(root, || 1.0 / (3.0 * root * root))
        }
        Function::Abs => argument.chain(x.abs(), || sign(x)),
        Function::Sign => argument.chain(sign(x), || 0.0),
        Function::Floor => argument.chain(x.floor(), || 0.0),
        Function::Ceil => argument.chain(x.ceil(), || 0.0),
        other => unreachable!("{other:?} takes more than one argument"),
    }
}

/// A function of two numbers; `min` and `max` of more are made of these.
pub(crate) fn of_two<T: Number>(function: Function, first: T, second: T) -> T {
    let (a, b) = (first.value(), second.value());
    match function {
        Function::Atan2 => first.chain_both(second, libm::atan2(a, b), || {
            let distance_sq = a * a + b * b;
            (b / distance_sq, -a / distance_sq)
        }),
        Function::Hypot => {
            let length = libm::hypot(a, b);
            // the corner at the origin is flat like that of `abs`
            let slopes = || if length == 0.0 { (0.0, 0.0) } else { (a / length, b / length) };
            first.chain_both(second, length, slopes)
        }
        // what is not a number stays so, to be found by whoever checks the result
        Function::Min if a < b || a.is_nan() => first,
        Function::Max if a > b || a.is_nan() => first,
        Function::Min | Function::Max => second,
        Function::Pow => power(first, second),
        Function::Step if a.is_nan() || b.is_nan() => T::constant(f64::NAN),
        Function::Step => truth(b >= a),
        other => unreachable!("{other:?} does not take two arguments"),
    }
}

/// A function of three numbers.
pub(crate) fn of_three<T: Number>(function: Function, first: T, second: T, third: T) -> T {
    match function {
        Function::If => {
            if holds(first) {
                second
            } else {
                third
            }
        }
        Function::Clamp => of_two(Function::Min, of_two(Function::Max, first, second), third),
        Function::Smoothstep => smoothstep(first, second, third),
        other => unreachable!("{other:?} does not take three arguments"),
    }
}

// s² (3 − 2 s) with s = (x − low)/(high − low) held between 0 and 1
fn smoothstep<T: Number>(low: T, high: T, x: T) -> T {
    // a ramp without width is a step
    if low.value() == high.value() {
        return of_two(Function::Step, low, x);
    }
    let s = (x - low) / (high - low);
    if s.value() <= 0.0 {
        T::constant(0.0)
    } else if s.value() >= 1.0 {
        T::constant(1.0)
    } else {
        s * s * (T::constant(3.0) - (s + s))
    }
}

/// -1, 0 or 1; unlike `f64::signum`, zero has no sign here.
fn sign(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.signum() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ArgumentCount, FUNCTIONS, Formula};

    /// The derivative of every function by each of its arguments equals its central difference.
    #[test]
    fn slopes_are_differences() {
        // rounding (ε|f|/h) and truncation (h²/6 times the third derivative) balance near h = ε^(1/3); at these
        // points |f| stays below 10, and the third derivative (of asin at 0.9, of a steep ramp) below 400
        let h = libm::cbrt(f64::EPSILON);
        let tolerance = 10.0 * f64::EPSILON / h + 400.0 * h * h / 6.0;
        let variables = ["a", "b", "c"];
        let points = [[0.3, 0.7, 0.45], [0.8, 0.4, 0.55], [0.4, 1.2, 0.2], [0.9, 2.3, 1.4]];
        for entry in FUNCTIONS.iter().filter(|entry| entry.function != Function::If) {
            let (ArgumentCount::Exactly(count) | ArgumentCount::AtLeast(count)) = entry.arguments;
            let text = format!("{}({})", entry.name, variables[..count].join(", "));
            let formula = Formula::compile(&text, &variables[..count]).unwrap();
            for (point, by) in points.iter().flat_map(|point| (0..count).map(move |by| (point, by))) {
                let along = |step: f64| {
                    let mut moved = *point;
                    moved[by] += step;
                    formula.evaluate(&moved)
                };
                let difference = (along(h) - along(-h)) / (2.0 * h);
                let derivative = formula.differentiate(point, by).derivative;
                assert!(
                    (derivative - difference).abs() < tolerance,
                    "{text} by {by}: {derivative} {difference}"
                );
            }
        }
    }

    /// What does not move has no rate, even where the slope is infinite; corners have the slope of one side.
    #[test]
    fn slopes_at_the_edge() {
        let at = |text: &str, x: f64, rate: f64| {
            let formula = Formula::compile(text, &["x"]).unwrap();
            formula.evaluate_dual(&[Dual::new(x, rate)])
        };
        assert_eq!(at("sqrt(x)", 0.0, 0.0), Dual::new(0.0, 0.0));
        assert_eq!(at("sqrt(x)", 0.0, 1.0), Dual::new(0.0, f64::INFINITY));
        assert_eq!(at("abs(x)", 0.0, 1.0), Dual::new(0.0, 0.0));
        assert_eq!(at("x^0", 0.0, 1.0), Dual::new(1.0, 0.0));
        assert_eq!(at("x^3", -2.0, 1.0), Dual::new(-8.0, 12.0));
        assert_eq!(at("x^-2", 2.0, 1.0), Dual::new(0.25, -0.25));
        assert_eq!(at("x^2.5", 0.0, 1.0), Dual::new(0.0, 0.0));
        assert_eq!(at("(-2)^(x + 2)", 0.0, 0.0), Dual::new(4.0, 0.0));
        assert_eq!(at("hypot(x, 0)", 0.0, 1.0), Dual::new(0.0, 0.0));
        assert_eq!(at("0^x", 2.0, 1.0), Dual::new(0.0, 0.0));
        assert_eq!(at("x^(0 * (x + 1))", 0.0, 1.0), Dual::new(1.0, 0.0));
        assert_eq!(at("if(x > 0, sqrt(x), 0)", -1.0, 1.0), Dual::new(0.0, 0.0));
        assert_eq!(at("smoothstep(0, 2, x)", 1.0, 1.0), Dual::new(0.5, 0.75));
        assert_eq!(at("smoothstep(1, 1, x)", 1.0, 1.0), Dual::new(1.0, 0.0));
        assert_eq!(at("smoothstep(2, 0, x)", 0.5, 1.0).value, 0.84375);
    }
}
