//! Matrices of three by three.

use std::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

use crate::{Real, Vec3};

/// A 3×3 matrix, stored by columns.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
#[repr(C)]
pub struct Mat3<R = f64> {
    pub columns: [Vec3<R>; 3],
}

// SAFETY: nine `f64` in declared order without padding; any bits are valid.
unsafe impl bytemuck::Zeroable for Mat3<f64> {}
// SAFETY: as above.
unsafe impl bytemuck::Pod for Mat3<f64> {}

impl Mat3<f64> {
    pub const ZERO: Self = Self { columns: [Vec3::ZERO; 3] };
    pub const IDENTITY: Self = Self { columns: Vec3::AXES };

    pub const fn from_diagonal(diagonal: Vec3) -> Self {
        Self {
            columns: [
                Vec3::new(diagonal.x, 0.0, 0.0),
                Vec3::new(0.0, diagonal.y, 0.0),
                Vec3::new(0.0, 0.0, diagonal.z),
            ],
        }
    }

    /// Entries as written on paper, row after row.
    pub const fn from_rows(rows: [[f64; 3]; 3]) -> Self {
        let [[a, b, c], [d, e, f], [g, h, i]] = rows;
        Self { columns: [Vec3::new(a, d, g), Vec3::new(b, e, h), Vec3::new(c, f, i)] }
    }

    /// The inverse, or `None` where the determinant is zero or not finite.
    pub fn try_inverse(self) -> Option<Self> {
        let determinant = self.determinant();
        (determinant != 0.0 && determinant.is_finite())
            .then(|| self.cofactor().transpose() * (1.0 / determinant))
    }

    pub fn is_finite(self) -> bool {
        self.columns.iter().all(|column| column.is_finite())
    }

    /// The largest entry in absolute value.
    pub fn largest_entry(self) -> f64 {
        self.columns.iter().map(|column| column.largest_component()).fold(0.0, f64::max)
    }
}

impl<R: Copy> Mat3<R> {
    #[inline(always)]
    pub fn from_columns(a: Vec3<R>, b: Vec3<R>, c: Vec3<R>) -> Self {
        Self { columns: [a, b, c] }
    }

    #[inline(always)]
    pub fn entry(&self, row: usize, column: usize) -> R {
        self.columns[column][row]
    }

    #[inline(always)]
    pub fn row(&self, row: usize) -> Vec3<R> {
        Vec3::new(self.columns[0][row], self.columns[1][row], self.columns[2][row])
    }

    #[inline(always)]
    pub fn transpose(&self) -> Self {
        Self { columns: [self.row(0), self.row(1), self.row(2)] }
    }

    #[inline(always)]
    pub fn diagonal(&self) -> Vec3<R> {
        Vec3::new(self.columns[0].x, self.columns[1].y, self.columns[2].z)
    }
}

impl<R: Real> Mat3<R> {
    /// The identity in the lanes of `like`.
    #[inline(always)]
    pub fn identity(like: R) -> Self {
        let (zero, one) = (like.zero(), like.one());
        Self::from_columns(Vec3::new(one, zero, zero), Vec3::new(zero, one, zero), Vec3::new(zero, zero, one))
    }

    #[inline(always)]
    pub fn zero(like: R) -> Self {
        let column = Vec3::new(like.zero(), like.zero(), like.zero());
        Self { columns: [column; 3] }
    }

    #[inline(always)]
    pub fn trace(&self) -> R {
        self.columns[0].x + self.columns[1].y + self.columns[2].z
    }

    #[inline(always)]
    pub fn determinant(&self) -> R {
        self.columns[0].dot(self.columns[1].cross(self.columns[2]))
    }

    /// `det(A) A⁻ᵀ`: the derivative of the determinant; defined for singular matrices too.
    #[inline(always)]
    pub fn cofactor(&self) -> Self {
        let [a, b, c] = self.columns;
        Self { columns: [b.cross(c), c.cross(a), a.cross(b)] }
    }

    /// `A : B = Σ Aᵢⱼ Bᵢⱼ`.
    #[inline(always)]
    pub fn dot(&self, other: &Self) -> R {
        self.columns[0].dot(other.columns[0])
            + self.columns[1].dot(other.columns[1])
            + self.columns[2].dot(other.columns[2])
    }

    /// `(A + Aᵀ) / 2`.
    #[inline(always)]
    pub fn symmetric_part(&self) -> Self {
        (*self + self.transpose()) * 0.5
    }

    /// `w` with `w × u = (A - Aᵀ)/2 u`.
    #[inline(always)]
    pub fn axial_vector(&self) -> Vec3<R> {
        let [a, b, c] = &self.columns;
        Vec3::new((b.z - c.y) * 0.5, (c.x - a.z) * 0.5, (a.y - b.x) * 0.5)
    }

    /// `Aᵀ B` without forming the transpose.
    #[inline(always)]
    pub fn transpose_mul(&self, other: &Self) -> Self {
        let [a, b, c] = other.columns;
        // no closure over the columns: in lanes it would not be compiled for the processor's instructions
        Self { columns: [self.transpose_apply(a), self.transpose_apply(b), self.transpose_apply(c)] }
    }

    /// `Aᵀ A`, its six different dot products taken once.
    #[inline(always)]
    pub fn gram(&self) -> Self {
        let [a, b, c] = self.columns;
        let (ab, bc, ca) = (a.dot(b), b.dot(c), c.dot(a));
        Self::from_columns(
            Vec3::new(a.dot(a), ab, ca),
            Vec3::new(ab, b.dot(b), bc),
            Vec3::new(ca, bc, c.dot(c)),
        )
    }

    /// `Aᵀ u` without forming the transpose.
    #[inline(always)]
    pub fn transpose_apply(&self, u: Vec3<R>) -> Vec3<R> {
        Vec3::new(self.columns[0].dot(u), self.columns[1].dot(u), self.columns[2].dot(u))
    }

    /// `A Bᵀ` without forming the transpose.
    #[inline(always)]
    pub fn mul_transpose(&self, other: &Self) -> Self {
        *self * other.transpose()
    }

    #[inline(always)]
    pub fn scaled(&self, scale: R) -> Self {
        Self { columns: [self.columns[0] * scale, self.columns[1] * scale, self.columns[2] * scale] }
    }

    /// `A + s I`.
    #[inline(always)]
    pub fn plus_diagonal(mut self, s: R) -> Self {
        self.columns[0].x += s;
        self.columns[1].y += s;
        self.columns[2].z += s;
        self
    }
}

impl<R: Real> Add for Mat3<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let ([a, b, c], [d, e, f]) = (self.columns, other.columns);
        Self { columns: [a + d, b + e, c + f] }
    }
}

impl<R: Real> Sub for Mat3<R> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let ([a, b, c], [d, e, f]) = (self.columns, other.columns);
        Self { columns: [a - d, b - e, c - f] }
    }
}

impl<R: Real> Neg for Mat3<R> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        let [a, b, c] = self.columns;
        Self { columns: [-a, -b, -c] }
    }
}

impl<R: Real> Mul<f64> for Mat3<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, scale: f64) -> Self {
        self.scaled(self.columns[0].x.splat(scale))
    }
}

impl<R: Real> Mul<Vec3<R>> for Mat3<R> {
    type Output = Vec3<R>;
    #[inline(always)]
    fn mul(self, u: Vec3<R>) -> Vec3<R> {
        let [a, b, c] = self.columns;
        Vec3::new(
            a.x.mul_add(u.x, b.x.mul_add(u.y, c.x * u.z)),
            a.y.mul_add(u.x, b.y.mul_add(u.y, c.y * u.z)),
            a.z.mul_add(u.x, b.z.mul_add(u.y, c.z * u.z)),
        )
    }
}

impl<R: Real> Mul for Mat3<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let [a, b, c] = other.columns;
        Self { columns: [self * a, self * b, self * c] }
    }
}

impl<R: Real> AddAssign for Mat3<R> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<R: Real> SubAssign for Mat3<R> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
