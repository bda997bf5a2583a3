//! Several `f64` side by side in one register, chosen at run time.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use pulp::Simd;

use crate::Real;

/// `S::F64_LANES` numbers with the token that proves the processor can compute with them.
//
// Aligned, because the registers of the processor that are kept on the stack would not be: each access of 64 bytes would touch two lines of
// the cache. For this much the compiler aligns such a stack to whole registers, and none of 32 or 64 bytes is padded.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(target_arch = "x86_64", repr(align(32)))]
pub struct Lanes<S: Simd> {
    simd: S,
    values: S::f64s,
}

impl<S: Simd> Lanes<S> {
    #[inline(always)]
    pub fn new(simd: S, values: S::f64s) -> Self {
        Self { simd, values }
    }

    #[inline(always)]
    pub fn constant(simd: S, value: f64) -> Self {
        Self { simd, values: simd.splat_f64s(value) }
    }

    /// The first `S::F64_LANES` entries of `values`.
    ///
    /// # Panics
    /// If `values` is shorter than the lanes.
    #[inline(always)]
    pub fn load(simd: S, values: &[f64]) -> Self {
        Self { simd, values: S::as_simd_f64s(&values[..S::F64_LANES]).0[0] }
    }

    #[inline(always)]
    pub fn store(self, values: &mut [f64]) {
        S::as_mut_simd_f64s(&mut values[..S::F64_LANES]).0[0] = self.values;
    }

    #[inline(always)]
    pub fn values(self) -> S::f64s {
        self.values
    }

    /// The numbers side by side.
    #[inline(always)]
    pub fn as_slice(&self) -> &[f64] {
        bytemuck::cast_slice(std::slice::from_ref(&self.values))
    }

    #[inline(always)]
    pub fn as_mut_slice(&mut self) -> &mut [f64] {
        bytemuck::cast_slice_mut(std::slice::from_mut(&mut self.values))
    }

    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        let mut values = self.values;
        for value in bytemuck::cast_slice_mut::<_, f64>(std::slice::from_mut(&mut values)) {
            *value = f(*value);
        }
        Self { simd: self.simd, values }
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident, $instruction:ident) => {
        impl<S: Simd> $trait for Lanes<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self { simd: self.simd, values: self.simd.$instruction(self.values, other.values) }
            }
        }
    };
}
operator!(Add, add, add_f64s);
operator!(Sub, sub, sub_f64s);
operator!(Mul, mul, mul_f64s);
operator!(Div, div, div_f64s);

macro_rules! operator_with_constant {
    ($trait:ident, $method:ident) => {
        impl<S: Simd> $trait<f64> for Lanes<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                self.$method(self.splat(other))
            }
        }
    };
}
operator_with_constant!(Add, add);
operator_with_constant!(Sub, sub);
operator_with_constant!(Mul, mul);

impl<S: Simd> Neg for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { simd: self.simd, values: self.simd.neg_f64s(self.values) }
    }
}

impl<S: Simd> AddAssign for Lanes<S> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<S: Simd> SubAssign for Lanes<S> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<S: Simd> Real for Lanes<S> {
    type Number = f64;

    #[inline(always)]
    fn splat(self, value: f64) -> Self {
        Self::constant(self.simd, value)
    }
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        Self { simd: self.simd, values: self.simd.mul_add_e_f64s(self.values, a.values, b.values) }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self { simd: self.simd, values: self.simd.sqrt_f64s(self.values) }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self { simd: self.simd, values: self.simd.abs_f64s(self.values) }
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.select_less(other, self, other)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        other.select_less(self, self, other)
    }
    // one number after the other through the scalar function: the bits must not depend on the width
    #[inline(always)]
    fn ln(self) -> Self {
        self.map(libm::log)
    }
    #[inline(always)]
    fn exp(self) -> Self {
        self.map(libm::exp)
    }
    #[inline(always)]
    fn is_all_zero(self) -> bool {
        self.as_slice().iter().all(|number| *number == 0.0)
    }
    #[inline(always)]
    fn select_less(self, other: Self, if_less: Self, otherwise: Self) -> Self {
        let mask = self.simd.less_than_f64s(self.values, other.values);
        Self { simd: self.simd, values: self.simd.select_f64s(mask, if_less.values, otherwise.values) }
    }
    #[inline(always)]
    fn numbers(&self) -> &[f64] {
        self.as_slice()
    }
    #[inline(always)]
    fn numbers_mut(&mut self) -> &mut [f64] {
        self.as_mut_slice()
    }
    #[inline(always)]
    fn all_positive(self) -> bool {
        let mut all = true;
        for value in self.as_slice() {
            all &= *value > 0.0;
        }
        all
    }
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use pulp::x86::{V3, V4};

    use super::*;

    /// A register takes as much room as it has numbers, and the wider ones ask for a stack that is aligned.
    #[test]
    fn registers_are_aligned_and_not_padded() {
        assert_eq!((size_of::<Lanes<V3>>(), align_of::<Lanes<V3>>()), (32, 32));
        assert_eq!((size_of::<Lanes<V4>>(), align_of::<Lanes<V4>>()), (64, 32));
    }
}
