//! The numbers a formula can be evaluated on, and its functions over them.
//!
//! A function is written once as its value and its slope; plain numbers never compute the slope. Points without
//! a slope are decided here: `abs`, `sign`, `step`, `hypot` at the origin have slope 0, `min` and `max` take the
//! slope of the operand they take. A constant operand adds nothing to a rate, even where its slope is infinite.

use std::f64::consts::LN_10;
use std::ops::{Add, Div, Mul, Neg, Sub};

use souple_math::Dual;

use crate::Function;

/// A number, perhaps with rates along some direction.
pub trait Scalar:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// `value` that never changes.
    fn constant(value: f64) -> Self;

    fn value(self) -> f64;

    /// `f(self)` from `value = f(x)` and `slope = f'(x)`.
    fn chain(self, value: f64, slope: impl FnOnce() -> f64) -> Self;

    /// `f(self, other)` from its value and its two partial slopes.
    fn chain_two(self, other: Self, value: f64, slopes: impl FnOnce() -> (f64, f64)) -> Self;
}

impl Scalar for f64 {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn value(self) -> f64 {
        self
    }
    #[inline(always)]
    fn chain(self, value: f64, _: impl FnOnce() -> f64) -> Self {
        value
    }
    #[inline(always)]
    fn chain_two(self, _: Self, value: f64, _: impl FnOnce() -> (f64, f64)) -> Self {
        value
    }
}

impl Scalar for Dual {
    fn constant(value: f64) -> Self {
        Self::constant(value)
    }
    fn value(self) -> f64 {
        self.value
    }
    fn chain(self, value: f64, slope: impl FnOnce() -> f64) -> Self {
        Self::new(value, rate(slope(), self.derivative))
    }
    fn chain_two(self, other: Self, value: f64, slopes: impl FnOnce() -> (f64, f64)) -> Self {
        let (own, others) = slopes();
        Self::new(value, rate(own, self.derivative) + rate(others, other.derivative))
    }
}

/// `slope · derivative`, zero where the argument stands still: `sqrt(0 · t)` does not move.
fn rate(slope: f64, derivative: f64) -> f64 {
    if derivative == 0.0 { 0.0 } else { slope * derivative }
}

/// A function of one argument.
pub(crate) fn apply_one<S: Scalar>(function: Function, x: S) -> S {
    let v = x.value();
    match function {
        Function::Sin => x.chain(libm::sin(v), || libm::cos(v)),
        Function::Cos => x.chain(libm::cos(v), || -libm::sin(v)),
        Function::Tan => {
            let tangent = libm::tan(v);
            x.chain(tangent, || 1.0 + tangent * tangent)
        }
        Function::Asin => x.chain(libm::asin(v), || 1.0 / ((1.0 - v) * (1.0 + v)).sqrt()),
        Function::Acos => x.chain(libm::acos(v), || -1.0 / ((1.0 - v) * (1.0 + v)).sqrt()),
        Function::Atan => x.chain(libm::atan(v), || 1.0 / (1.0 + v * v)),
        Function::Sinh => x.chain(libm::sinh(v), || libm::cosh(v)),
        Function::Cosh => x.chain(libm::cosh(v), || libm::sinh(v)),
        Function::Tanh => {
            let tangent = libm::tanh(v);
            x.chain(tangent, || (1.0 - tangent) * (1.0 + tangent))
        }
        Function::Exp => {
            let power = libm::exp(v);
            x.chain(power, || power)
        }
        Function::Ln => x.chain(libm::log(v), || 1.0 / v),
        Function::Log10 => x.chain(libm::log10(v), || 1.0 / (v * LN_10)),
        Function::Sqrt => {
            let root = v.sqrt();
            x.chain(root, || 0.5 / root)
        }
        Function::Cbrt => {
            let root = libm::cbrt(v);
            x.chain(root, || 1.0 / (3.0 * root * root))
        }
        Function::Abs => x.chain(v.abs(), || sign(v)),
        Function::Sign => x.chain(sign(v), || 0.0),
        Function::Floor => x.chain(libm::floor(v), || 0.0),
        Function::Ceil => x.chain(libm::ceil(v), || 0.0),
        other => unreachable!("{} takes more than one argument", other.name()),
    }
}

/// A function of two arguments.
pub(crate) fn apply_two<S: Scalar>(function: Function, a: S, b: S) -> S {
    let (x, y) = (a.value(), b.value());
    match function {
        Function::Atan2 => a.chain_two(b, libm::atan2(x, y), || {
            let length_sq = x * x + y * y;
            (y / length_sq, -x / length_sq)
        }),
        Function::Hypot => {
            let length = libm::hypot(x, y);
            a.chain_two(b, length, || if length == 0.0 { (0.0, 0.0) } else { (x / length, y / length) })
        }
        Function::Min => lesser(a, b),
        Function::Max => greater(a, b),
        Function::Step => {
            // not a number stays visible instead of falling on one side
            let value = if y < x {
                0.0
            } else if y >= x {
                1.0
            } else {
                f64::NAN
            };
            a.chain_two(b, value, || (0.0, 0.0))
        }
        Function::Pow => power(a, b),
        other => unreachable!("{} does not take two arguments", other.name()),
    }
}

/// A function of three arguments.
pub(crate) fn apply_three<S: Scalar>(function: Function, a: S, b: S, c: S) -> S {
    match function {
        Function::Clamp => lesser(greater(a, b), c),
        Function::Smoothstep => smoothstep(a, b, c),
        other => unreachable!("{} does not take three arguments", other.name()),
    }
}

/// `x^y`; for a whole constant `y` see [`integer_power`].
pub(crate) fn power<S: Scalar>(base: S, exponent: S) -> S {
    let (x, y) = (base.value(), exponent.value());
    let value = libm::pow(x, y);
    base.chain_two(exponent, value, || {
        let along_base = if y == 0.0 { 0.0 } else { y * libm::pow(x, y - 1.0) };
        // x^y ln x tends to 0 with x, for positive y
        let along_exponent = if value == 0.0 { 0.0 } else { value * libm::log(x) };
        (along_base, along_exponent)
    })
}

/// `x^n` by repeated squaring: for small `n` a few times faster than `pow` and right for negative `x` too.
pub(crate) fn integer_power<S: Scalar>(base: S, exponent: i32) -> S {
    let x = base.value();
    base.chain(powers(x, exponent), || match exponent {
        0 => 0.0,
        _ => f64::from(exponent) * powers(x, exponent - 1),
    })
}

fn powers(x: f64, exponent: i32) -> f64 {
    let mut remaining = exponent.unsigned_abs();
    let (mut result, mut square) = (1.0, x);
    while remaining > 0 {
        if remaining & 1 == 1 {
            result *= square;
        }
        remaining >>= 1;
        if remaining > 0 {
            square *= square;
        }
    }
    if exponent < 0 { 1.0 / result } else { result }
}

// s = clamp((x − a)/(b − a), 0, 1),  s² (3 − 2s)
fn smoothstep<S: Scalar>(a: S, b: S, x: S) -> S {
    if a.value() == b.value() {
        return apply_two(Function::Step, a, x);
    }
    let s = lesser(greater((x - a) / (b - a), S::constant(0.0)), S::constant(1.0));
    s * s * (S::constant(3.0) - s - s)
}

/// The smaller one; not a number if either is.
fn lesser<S: Scalar>(a: S, b: S) -> S {
    if a.value() < b.value() || a.value().is_nan() { a } else { b }
}

/// The larger one; not a number if either is.
fn greater<S: Scalar>(a: S, b: S) -> S {
    if a.value() > b.value() || a.value().is_nan() { a } else { b }
}

fn sign(x: f64) -> f64 {
    if x > 0.0 {
        1.0
    } else if x < 0.0 {
        -1.0
    } else {
        // keeps zero and not-a-number as they are
        x
    }
}
