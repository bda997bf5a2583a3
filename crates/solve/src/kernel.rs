//! The inner loop of every product and every triangular solve: one row of 3×3 blocks times a vector.
//!
//! Written once over [`Kernel`]; [`run`] picks the widest the processor has. A block is nine numbers by
//! columns, so that a column is one (overlapping) load of four.

use bytemuck::cast_ref;
use souple_math::{Mat3, Vec3};

/// How a row is multiplied.
pub(crate) trait Kernel: Copy {
    /// A 3×3 block in registers.
    type Block: Copy;

    /// `Σ A_k x[column_k]`.
    fn row(self, blocks: &[Mat3], columns: &[u32], x: &[Vec3]) -> Vec3;
    /// The same with blocks kept in single precision; sums are in double.
    fn row_single(self, blocks: &[[f32; 9]], columns: &[u32], x: &[Vec3]) -> Vec3;
    /// `sum + A Bᵀ`.
    fn add_mul_transpose(self, sum: Self::Block, A: &Mat3, B: &Mat3) -> Self::Block;
    /// `A B`.
    fn mul(self, A: &Mat3, B: &Mat3) -> Self::Block;
    fn zero(self) -> Self::Block;
    fn store(self, block: Self::Block) -> Mat3;
}

/// A loop over rows that can run on any kernel.
pub(crate) trait RowLoop {
    type Output;
    fn run<K: Kernel>(self, kernel: K) -> Self::Output;
}

/// Runs `rows` with the widest kernel of this processor.
pub(crate) fn run<L: RowLoop>(rows: L) -> L::Output {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = pulp::x86::V3::try_new() {
        struct Wide<L>(L, pulp::x86::V3);
        impl<L: RowLoop> pulp::NullaryFnOnce for Wide<L> {
            type Output = L::Output;
            #[inline(always)]
            fn call(self) -> L::Output {
                self.0.run(self.1)
            }
        }
        return simd.vectorize(Wide(rows, simd));
    }
    rows.run(Plain)
}

/// Plain multiplications, for processors without 256-bit fused instructions.
#[derive(Clone, Copy)]
pub(crate) struct Plain;

impl Kernel for Plain {
    type Block = Mat3;

    #[inline(always)]
    fn add_mul_transpose(self, sum: Mat3, A: &Mat3, B: &Mat3) -> Mat3 {
        sum + A.mul_transpose(B)
    }

    #[inline(always)]
    fn mul(self, A: &Mat3, B: &Mat3) -> Mat3 {
        *A * *B
    }

    #[inline(always)]
    fn zero(self) -> Mat3 {
        Mat3::ZERO
    }

    #[inline(always)]
    fn store(self, block: Mat3) -> Mat3 {
        block
    }

    #[inline(always)]
    fn row(self, blocks: &[Mat3], columns: &[u32], x: &[Vec3]) -> Vec3 {
        let mut sum = Vec3::ZERO;
        for (block, &column) in blocks.iter().zip(columns) {
            sum += *block * x[column as usize];
        }
        sum
    }

    #[inline(always)]
    fn row_single(self, blocks: &[[f32; 9]], columns: &[u32], x: &[Vec3]) -> Vec3 {
        let mut sum = Vec3::ZERO;
        for (block, &column) in blocks.iter().zip(columns) {
            let wide: [f64; 9] = block.map(f64::from);
            let block: Mat3 = bytemuck::cast(wide);
            sum += block * x[column as usize];
        }
        sum
    }
}

#[cfg(target_arch = "x86_64")]
impl Kernel for pulp::x86::V3 {
    /// Columns; the fourth lanes are of no meaning.
    type Block = [pulp::f64x4; 3];

    #[inline(always)]
    fn add_mul_transpose(self, sum: Self::Block, A: &Mat3, B: &Mat3) -> Self::Block {
        let (a, [x, y, z], mut sum) = (columns(self, A), B.columns, sum);
        for (k, b) in [x, y, z].into_iter().enumerate() {
            sum[0] = self.mul_add_f64x4(a[k], self.splat_f64x4(b.x), sum[0]);
            sum[1] = self.mul_add_f64x4(a[k], self.splat_f64x4(b.y), sum[1]);
            sum[2] = self.mul_add_f64x4(a[k], self.splat_f64x4(b.z), sum[2]);
        }
        sum
    }

    #[inline(always)]
    fn mul(self, A: &Mat3, B: &Mat3) -> Self::Block {
        let (a, mut product) = (columns(self, A), self.zero());
        for (j, b) in B.columns.iter().enumerate() {
            let first = self.mul_f64x4(a[0], self.splat_f64x4(b.x));
            let second = self.mul_add_f64x4(a[1], self.splat_f64x4(b.y), first);
            product[j] = self.mul_add_f64x4(a[2], self.splat_f64x4(b.z), second);
        }
        product
    }

    #[inline(always)]
    fn zero(self) -> Self::Block {
        [self.splat_f64x4(0.0); 3]
    }

    #[inline(always)]
    fn store(self, block: Self::Block) -> Mat3 {
        let [a, b, c] = block.map(|column| -> [f64; 4] { pulp::cast(column) });
        Mat3::from_columns(
            Vec3::new(a[0], a[1], a[2]),
            Vec3::new(b[0], b[1], b[2]),
            Vec3::new(c[0], c[1], c[2]),
        )
    }

    #[inline(always)]
    fn row(self, blocks: &[Mat3], columns: &[u32], x: &[Vec3]) -> Vec3 {
        let load = |four: &[f64]| -> pulp::f64x4 { pulp::cast([four[0], four[1], four[2], four[3]]) };
        let mut sums = [self.splat_f64x4(0.0); 3];
        for (block, &column) in blocks.iter().zip(columns) {
            let (x, entries) = (&x[column as usize], cast_ref::<Mat3, [f64; 9]>(block));
            sums[0] = self.mul_add_f64x4(load(&entries[0..4]), self.splat_f64x4(x.x), sums[0]);
            sums[1] = self.mul_add_f64x4(load(&entries[3..7]), self.splat_f64x4(x.y), sums[1]);
            // the third column is loaded with its neighbour in front: four from entry 6 would leave the block
            sums[2] = self.mul_add_f64x4(load(&entries[5..9]), self.splat_f64x4(x.z), sums[2]);
        }
        gather_columns(sums)
    }

    #[inline(always)]
    fn row_single(self, blocks: &[[f32; 9]], columns: &[u32], x: &[Vec3]) -> Vec3 {
        let load = |four: &[f32]| -> pulp::f64x4 {
            self.convert_f32x4_to_f64x4(pulp::cast([four[0], four[1], four[2], four[3]]))
        };
        let mut sums = [self.splat_f64x4(0.0); 3];
        for (entries, &column) in blocks.iter().zip(columns) {
            let x = &x[column as usize];
            sums[0] = self.mul_add_f64x4(load(&entries[0..4]), self.splat_f64x4(x.x), sums[0]);
            sums[1] = self.mul_add_f64x4(load(&entries[3..7]), self.splat_f64x4(x.y), sums[1]);
            sums[2] = self.mul_add_f64x4(load(&entries[5..9]), self.splat_f64x4(x.z), sums[2]);
        }
        gather_columns(sums)
    }
}

/// The columns of a block, their fourth lanes filled by their neighbours.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn columns(simd: pulp::x86::V3, A: &Mat3) -> [pulp::f64x4; 3] {
    let entries = cast_ref::<Mat3, [f64; 9]>(A);
    let load = |four: &[f64]| -> pulp::f64x4 { pulp::cast([four[0], four[1], four[2], four[3]]) };
    // the third is loaded with its neighbour in front, and turned by one lane
    let third = simd.avx2._mm256_permute4x64_pd::<0b00_11_10_01>(pulp::cast(load(&entries[5..9])));
    [load(&entries[0..4]), load(&entries[3..7]), pulp::cast(third)]
}

/// Adds the three columns' shares; the third lies one lane higher.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn gather_columns(sums: [pulp::f64x4; 3]) -> Vec3 {
    let [a, b, c] = sums.map(|sum| -> [f64; 4] { pulp::cast(sum) });
    Vec3::new(a[0] + b[0] + c[1], a[1] + b[1] + c[2], a[2] + b[2] + c[3])
}
