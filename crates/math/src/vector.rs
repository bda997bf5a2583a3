//! Vectors of three.

use std::ops::{Add, AddAssign, Div, Index, IndexMut, Mul, Neg, Sub, SubAssign};

use crate::{Mat3, Real};

/// Three numbers: a point, a displacement, a force.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
#[repr(C)]
pub struct Vec3<R = f64> {
    pub x: R,
    pub y: R,
    pub z: R,
}

// SAFETY: three `f64` in declared order without padding; any bits are valid.
unsafe impl bytemuck::Zeroable for Vec3<f64> {}
// SAFETY: as above.
unsafe impl bytemuck::Pod for Vec3<f64> {}

impl Vec3<f64> {
    pub const ZERO: Self = Self::new(0.0, 0.0, 0.0);
    pub const X: Self = Self::new(1.0, 0.0, 0.0);
    pub const Y: Self = Self::new(0.0, 1.0, 0.0);
    pub const Z: Self = Self::new(0.0, 0.0, 1.0);
    pub const AXES: [Self; 3] = [Self::X, Self::Y, Self::Z];

    pub fn is_finite(self) -> bool {
        self.x.is_finite() && self.y.is_finite() && self.z.is_finite()
    }

    /// The unit vector along `self`, or `None` for a vector shorter than the smallest normal number.
    #[inline]
    pub fn try_normalised(self) -> Option<Self> {
        let length = self.length();
        (length > f64::MIN_POSITIVE && length.is_finite()).then(|| self / length)
    }

    /// A unit vector orthogonal to `self`.
    pub fn any_orthogonal(self) -> Self {
        let axis = if self.x.abs() <= self.y.abs() && self.x.abs() <= self.z.abs() {
            Self::X
        } else if self.y.abs() <= self.z.abs() {
            Self::Y
        } else {
            Self::Z
        };
        let orthogonal = self.cross(axis);
        orthogonal.try_normalised().unwrap_or(Self::X)
    }

    pub fn min_components(self, other: Self) -> Self {
        Self::new(self.x.min(other.x), self.y.min(other.y), self.z.min(other.z))
    }

    pub fn max_components(self, other: Self) -> Self {
        Self::new(self.x.max(other.x), self.y.max(other.y), self.z.max(other.z))
    }

    pub fn largest_component(self) -> f64 {
        self.x.abs().max(self.y.abs()).max(self.z.abs())
    }

    /// What vectors that compare equal have in common, to look them up by: zeros of both signs are one.
    pub fn key(self) -> [u64; 3] {
        self.to_array().map(|c| (c + 0.0).to_bits())
    }
}

impl<R> Vec3<R> {
    #[inline(always)]
    pub const fn new(x: R, y: R, z: R) -> Self {
        Self { x, y, z }
    }
}

impl<R: Copy> Vec3<R> {
    #[inline(always)]
    pub fn from_array([x, y, z]: [R; 3]) -> Self {
        Self { x, y, z }
    }

    #[inline(always)]
    pub fn to_array(self) -> [R; 3] {
        [self.x, self.y, self.z]
    }
}

impl<R: Real> Vec3<R> {
    #[inline(always)]
    pub fn dot(self, other: Self) -> R {
        self.x.mul_add(other.x, self.y.mul_add(other.y, self.z * other.z))
    }

    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Self::new(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )
    }

    #[inline(always)]
    pub fn length_sq(self) -> R {
        self.dot(self)
    }

    #[inline(always)]
    pub fn length(self) -> R {
        self.length_sq().sqrt()
    }

    /// `self ⊗ other`, entry `(i, j) = selfᵢ otherⱼ`.
    #[inline(always)]
    pub fn outer(self, other: Self) -> Mat3<R> {
        Mat3::from_columns(self * other.x, self * other.y, self * other.z)
    }

    /// The matrix of `u -> self × u`.
    #[inline(always)]
    pub fn cross_matrix(self) -> Mat3<R> {
        let zero = self.x.zero();
        Mat3::from_columns(
            Self::new(zero, self.z, -self.y),
            Self::new(-self.z, zero, self.x),
            Self::new(self.y, -self.x, zero),
        )
    }
}

impl<R: Real> Add for Vec3<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}

impl<R: Real> Sub for Vec3<R> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}

impl<R: Real> Neg for Vec3<R> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}

impl<R: Real> Mul<R> for Vec3<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, scale: R) -> Self {
        Self::new(self.x * scale, self.y * scale, self.z * scale)
    }
}

impl Mul<Vec3> for f64 {
    type Output = Vec3;
    #[inline(always)]
    fn mul(self, vector: Vec3) -> Vec3 {
        vector * self
    }
}

impl<R: Real> Div<R> for Vec3<R> {
    type Output = Self;
    #[inline(always)]
    fn div(self, scale: R) -> Self {
        Self::new(self.x / scale, self.y / scale, self.z / scale)
    }
}

impl<R: Real> AddAssign for Vec3<R> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<R: Real> SubAssign for Vec3<R> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl std::iter::Sum for Vec3 {
    fn sum<I: Iterator<Item = Self>>(values: I) -> Self {
        values.fold(Self::ZERO, |sum, value| sum + value)
    }
}

impl<R> Index<usize> for Vec3<R> {
    type Output = R;
    #[inline(always)]
    fn index(&self, axis: usize) -> &R {
        match axis {
            0 => &self.x,
            1 => &self.y,
            2 => &self.z,
            _ => panic!("a vector of three has no component {axis}"),
        }
    }
}

impl<R> IndexMut<usize> for Vec3<R> {
    #[inline(always)]
    fn index_mut(&mut self, axis: usize) -> &mut R {
        match axis {
            0 => &mut self.x,
            1 => &mut self.y,
            2 => &mut self.z,
            _ => panic!("a vector of three has no component {axis}"),
        }
    }
}
