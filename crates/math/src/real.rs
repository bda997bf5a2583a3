//! What a kernel may do with a number.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A number, or several side by side.
///
/// Constants enter through arithmetic with `f64` (`x * 2.0`, `x + 1.0`) or through [`Real::splat`] on a
/// value at hand: a lane value carries the proof that the processor has its instructions, so a
/// constant can only be made beside one.
pub trait Real:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + AddAssign
    + SubAssign
{
    /// One of the numbers side by side.
    type Number: Real<Number = Self::Number>;

    /// The constant `value` in the lanes of `self`.
    fn splat(self, value: f64) -> Self;
    /// `self * a + b`, fused where the processor has the instruction.
    fn mul_add(self, a: Self, b: Self) -> Self;
    fn sqrt(self) -> Self;
    fn abs(self) -> Self;
    fn min(self, other: Self) -> Self;
    fn max(self, other: Self) -> Self;
    /// Natural logarithm; the same bits on every path of one number.
    fn ln(self) -> Self;
    /// Exponential; the same bits on every path of one number.
    fn exp(self) -> Self;
    /// `if_less` where `self < other`, else `otherwise`, lane by lane.
    fn select_less(self, other: Self, if_less: Self, otherwise: Self) -> Self;
    /// The numbers side by side, to be looked at one by one.
    fn numbers(&self) -> &[Self::Number];
    fn numbers_mut(&mut self) -> &mut [Self::Number];
    /// Whether every lane is above zero.
    fn all_positive(self) -> bool;

    /// Whether this is zero, in every lane: what it multiplies need not be computed.
    fn is_all_zero(self) -> bool;

    fn zero(self) -> Self {
        self.splat(0.0)
    }

    fn one(self) -> Self {
        self.splat(1.0)
    }
}

/// `baseⁿ` by squares.
#[inline(always)]
pub fn whole_power<R: Real>(base: R, exponent: u8) -> R {
    let (mut remaining, mut square, mut product) = (exponent, base, base.one());
    while remaining > 0 {
        if remaining % 2 == 1 {
            product = product * square;
        }
        remaining /= 2;
        square = square * square;
    }
    product
}

impl Real for f64 {
    type Number = Self;

    #[inline(always)]
    fn splat(self, value: f64) -> Self {
        value
    }
    // not fused: without the processor's instruction `f64::mul_add` is a slow library call
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        self * a + b
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
    #[inline(always)]
    fn ln(self) -> Self {
        libm::log(self)
    }
    #[inline(always)]
    fn exp(self) -> Self {
        libm::exp(self)
    }
    #[inline(always)]
    fn is_all_zero(self) -> bool {
        self == 0.0
    }
    #[inline(always)]
    fn select_less(self, other: Self, if_less: Self, otherwise: Self) -> Self {
        if self < other { if_less } else { otherwise }
    }
    #[inline(always)]
    fn numbers(&self) -> &[Self] {
        std::slice::from_ref(self)
    }
    #[inline(always)]
    fn numbers_mut(&mut self) -> &mut [Self] {
        std::slice::from_mut(self)
    }
    #[inline(always)]
    fn all_positive(self) -> bool {
        self > 0.0
    }
}
