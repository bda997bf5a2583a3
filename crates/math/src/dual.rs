//! Forward-mode derivatives: a number and its rate along one direction.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use crate::Real;

/// `value + derivative ε` with `ε² = 0`: any kernel over [`Real`] differentiates itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual {
    pub value: f64,
    pub derivative: f64,
}

impl Dual {
    pub fn constant(value: f64) -> Self {
        Self { value, derivative: 0.0 }
    }

    pub fn new(value: f64, derivative: f64) -> Self {
        Self { value, derivative }
    }
}

impl Add for Dual {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self::new(self.value + other.value, self.derivative + other.derivative)
    }
}

impl Sub for Dual {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Self::new(self.value - other.value, self.derivative - other.derivative)
    }
}

impl Mul for Dual {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        Self::new(self.value * other.value, self.derivative * other.value + self.value * other.derivative)
    }
}

impl Div for Dual {
    type Output = Self;
    #[inline]
    fn div(self, other: Self) -> Self {
        let quotient = self.value / other.value;
        Self::new(quotient, (self.derivative - quotient * other.derivative) / other.value)
    }
}

impl Neg for Dual {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self::new(-self.value, -self.derivative)
    }
}

impl Add<f64> for Dual {
    type Output = Self;
    #[inline]
    fn add(self, other: f64) -> Self {
        Self::new(self.value + other, self.derivative)
    }
}

impl Sub<f64> for Dual {
    type Output = Self;
    #[inline]
    fn sub(self, other: f64) -> Self {
        Self::new(self.value - other, self.derivative)
    }
}

impl Mul<f64> for Dual {
    type Output = Self;
    #[inline]
    fn mul(self, other: f64) -> Self {
        Self::new(self.value * other, self.derivative * other)
    }
}

impl AddAssign for Dual {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Dual {
    #[inline]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Real for Dual {
    type Number = Self;

    #[inline]
    fn splat(self, value: f64) -> Self {
        Self::constant(value)
    }
    #[inline]
    fn mul_add(self, a: Self, b: Self) -> Self {
        self * a + b
    }
    #[inline]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        Self::new(root, 0.5 * self.derivative / root)
    }
    #[inline]
    fn abs(self) -> Self {
        if self.value < 0.0 { -self } else { self }
    }
    #[inline]
    fn min(self, other: Self) -> Self {
        if self.value < other.value { self } else { other }
    }
    #[inline]
    fn max(self, other: Self) -> Self {
        if self.value > other.value { self } else { other }
    }
    #[inline]
    fn ln(self) -> Self {
        Self::new(libm::log(self.value), self.derivative / self.value)
    }
    #[inline]
    fn exp(self) -> Self {
        let value = libm::exp(self.value);
        Self::new(value, self.derivative * value)
    }
    #[inline]
    fn is_all_zero(self) -> bool {
        self.value == 0.0 && self.derivative == 0.0
    }
    #[inline]
    fn select_less(self, other: Self, if_less: Self, otherwise: Self) -> Self {
        if self.value < other.value { if_less } else { otherwise }
    }
    #[inline]
    fn numbers(&self) -> &[Self] {
        std::slice::from_ref(self)
    }
    #[inline]
    fn numbers_mut(&mut self) -> &mut [Self] {
        std::slice::from_mut(self)
    }
    #[inline]
    fn all_positive(self) -> bool {
        self.value > 0.0
    }
}
