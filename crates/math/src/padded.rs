//! Vectors in memory as registers like them: many gathered into lanes at once, and lanes added back.

use std::any::Any;
#[cfg(target_arch = "x86_64")]
use std::arch::x86_64::{__m256d, __m512d};

use pulp::Simd;

use crate::{Lanes, Vec3};

/// A vector and a fourth number of no meaning: one aligned load of four.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(32))]
pub struct Padded([f64; 4]);

impl From<Vec3> for Padded {
    #[inline(always)]
    fn from(vector: Vec3) -> Self {
        Self([vector.x, vector.y, vector.z, 0.0])
    }
}

impl From<Padded> for Vec3 {
    #[inline(always)]
    fn from(Padded([x, y, z, _]): Padded) -> Self {
        Self { x, y, z }
    }
}

/// The token of 256-bit registers, where they are what `S` computes with. Known when `S` is.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub(crate) fn four_wide<S: Simd>(simd: &S) -> Option<&pulp::x86::V3> {
    (simd as &dyn Any).downcast_ref()
}

/// The token of 512-bit registers, where they are what `S` computes with.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub(crate) fn eight_wide<S: Simd>(simd: &S) -> Option<&pulp::x86::V4> {
    (simd as &dyn Any).downcast_ref()
}

/// A transposition of eight rows (x y z ·): all x, all y, all z. A function, since a closure may be left standing by itself: what is not
/// inlined is not compiled for the processor's instructions.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub(crate) fn columns_of_eight(v4: &pulp::x86::V4, rows: [__m256d; 8]) -> [__m512d; 3] {
    let f = v4.avx512f;
    let [a, b, c, d, e, g, h, i] = rows;
    // two rows each, so that what is picked from two registers below comes in the lanes' order
    let (a, b) = (both(v4, a, c), both(v4, b, d));
    let (c, d) = (both(v4, e, h), both(v4, g, i));
    // (0.x 1.x 0.z 1.z 2.x 3.x 2.z 3.z), and so on
    let (low, high) = (f._mm512_unpacklo_pd(a, b), f._mm512_unpacklo_pd(c, d));
    let (low_y, high_y) = (f._mm512_unpackhi_pd(a, b), f._mm512_unpackhi_pd(c, d));
    [
        f._mm512_shuffle_f64x2::<0b10_00_10_00>(low, high),
        f._mm512_shuffle_f64x2::<0b10_00_10_00>(low_y, high_y),
        f._mm512_shuffle_f64x2::<0b11_01_11_01>(low, high),
    ]
}

/// Two halves of a register.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn both(v4: &pulp::x86::V4, low: __m256d, high: __m256d) -> __m512d {
    v4.avx512f._mm512_insertf64x4::<1>(v4.avx512f._mm512_castpd256_pd512(low), high)
}

/// The instructions of four lanes, which processors of eight have too.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub(crate) fn four_or_eight_wide<S: Simd>(simd: &S) -> Option<&pulp::x86::V3> {
    let eight = (simd as &dyn Any).downcast_ref::<pulp::x86::V4>();
    eight.map(|eight| &**eight).or_else(|| four_wide(simd))
}

/// Asks the processor for the line of the cache where `value` begins. No effect but on time.
#[inline(always)]
pub fn prefetch<T>(value: &T) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        // SAFETY: a hint that reads nothing; every x86-64 processor has it
        unsafe { _mm_prefetch::<_MM_HINT_T0>(std::ptr::from_ref(value).cast()) };
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = value;
}

impl<S: Simd> Vec3<Lanes<S>> {
    /// `values[indices[lane]]` side by side.
    ///
    /// # Safety
    /// There are `S::F64_LANES` indices, each below the length of `values`.
    #[inline(always)]
    pub unsafe fn gather(simd: S, values: &[Padded], indices: &[u16]) -> Self {
        debug_assert!(indices[..S::F64_LANES].iter().all(|index| usize::from(*index) < values.len()));
        // SAFETY: promised by the caller for every lane
        let value = |lane: usize| unsafe { values.get_unchecked(*indices.get_unchecked(lane) as usize).0 };
        #[cfg(target_arch = "x86_64")]
        if let Some(v3) = four_wide(&simd) {
            let row = |lane: usize| bytemuck::cast(value(lane));
            let (a, b, c, d) = (row(0), row(1), row(2), row(3));
            // a transposition: (a.x b.x c.x d.x), then y, then z
            let (even, odd) = (v3.avx._mm256_unpacklo_pd(a, b), v3.avx._mm256_unpacklo_pd(c, d));
            let (even_y, odd_y) = (v3.avx._mm256_unpackhi_pd(a, b), v3.avx._mm256_unpackhi_pd(c, d));
            return Self::new(
                Lanes::new(simd, bytemuck::cast(v3.avx._mm256_permute2f128_pd::<0x20>(even, odd))),
                Lanes::new(simd, bytemuck::cast(v3.avx._mm256_permute2f128_pd::<0x20>(even_y, odd_y))),
                Lanes::new(simd, bytemuck::cast(v3.avx._mm256_permute2f128_pd::<0x31>(even, odd))),
            );
        }
        #[cfg(target_arch = "x86_64")]
        if let Some(v4) = eight_wide(&simd) {
            let row = |lane: usize| bytemuck::cast(value(lane));
            let rows = [row(0), row(1), row(2), row(3), row(4), row(5), row(6), row(7)];
            let [x, y, z] = columns_of_eight(v4, rows);
            return Self::new(
                Lanes::new(simd, bytemuck::cast(x)),
                Lanes::new(simd, bytemuck::cast(y)),
                Lanes::new(simd, bytemuck::cast(z)),
            );
        }
        let zero = Lanes::constant(simd, 0.0);
        let mut out = Self::new(zero, zero, zero);
        for lane in 0..S::F64_LANES {
            let [x, y, z, _] = value(lane);
            out.x.as_mut_slice()[lane] = x;
            out.y.as_mut_slice()[lane] = y;
            out.z.as_mut_slice()[lane] = z;
        }
        out
    }

    /// `sums[indices[lane]] += self`, lane after lane.
    ///
    /// # Safety
    /// There are `S::F64_LANES` indices, each below the length of `sums`.
    #[inline(always)]
    pub unsafe fn scatter_add(self, simd: S, sums: &mut [Padded], indices: &[u16]) {
        debug_assert!(indices[..S::F64_LANES].iter().all(|index| usize::from(*index) < sums.len()));
        #[cfg(target_arch = "x86_64")]
        if let Some(v3) = four_wide(&simd) {
            let [x, y, z] = self.to_array().map(|lanes| bytemuck::cast(lanes.values()));
            // lanes 0 and 2 of (x y), lanes 1 and 3 of (x y), the same of (z z)
            let (even, odd) = (v3.avx._mm256_unpacklo_pd(x, y), v3.avx._mm256_unpackhi_pd(x, y));
            let (even_z, odd_z) = (v3.avx._mm256_unpacklo_pd(z, z), v3.avx._mm256_unpackhi_pd(z, z));
            let rows = [
                v3.avx._mm256_permute2f128_pd::<0x20>(even, even_z),
                v3.avx._mm256_permute2f128_pd::<0x20>(odd, odd_z),
                v3.avx._mm256_permute2f128_pd::<0x31>(even, even_z),
                v3.avx._mm256_permute2f128_pd::<0x31>(odd, odd_z),
            ];
            for lane in 0..4 {
                // SAFETY: promised by the caller
                let sum = unsafe { &mut sums.get_unchecked_mut(*indices.get_unchecked(lane) as usize).0 };
                *sum = bytemuck::cast(v3.avx._mm256_add_pd(bytemuck::cast(*sum), rows[lane]));
            }
            return;
        }
        #[cfg(target_arch = "x86_64")]
        if let Some(v4) = eight_wide(&simd) {
            let f = v4.avx512f;
            let [x, y, z] = self.to_array().map(|lanes| bytemuck::cast(lanes.values()));
            // even and odd lanes of (x y)
            let (even, odd) = (f._mm512_unpacklo_pd(x, y), f._mm512_unpackhi_pd(x, y));
            // lanes `lane` and `lane + 2` of (x y z z), from the even or the odd ones
            let rows = |lane: i64, xy| {
                let (low, pair) = (lane + 8, lane / 2 * 2);
                let places = [pair, pair + 1, low, low, pair + 2, pair + 3, low + 2, low + 2];
                let rows = f._mm512_permutex2var_pd(xy, bytemuck::cast(places), z);
                [f._mm512_castpd512_pd256(rows), f._mm512_extractf64x4_pd::<1>(rows)]
            };
            let ([a, c], [b, d], [e, g], [l, h]) = (rows(0, even), rows(1, odd), rows(4, even), rows(5, odd));
            for (lane, row) in [a, b, c, d, e, l, g, h].into_iter().enumerate() {
                // SAFETY: promised by the caller
                let sum = unsafe { &mut sums.get_unchecked_mut(*indices.get_unchecked(lane) as usize).0 };
                *sum = bytemuck::cast(v4.avx._mm256_add_pd(bytemuck::cast(*sum), row));
            }
            return;
        }
        for lane in 0..S::F64_LANES {
            // SAFETY: promised by the caller
            let sum = unsafe { &mut sums.get_unchecked_mut(*indices.get_unchecked(lane) as usize).0 };
            sum[0] += self.x.as_slice()[lane];
            sum[1] += self.y.as_slice()[lane];
            sum[2] += self.z.as_slice()[lane];
        }
    }
}

#[cfg(test)]
mod tests {
    use pulp::{Arch, WithSimd};

    use super::*;

    const COUNT: usize = 24;

    struct ThereAndBack;

    impl WithSimd for ThereAndBack {
        type Output = ();

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) {
            let vector = |i: usize| Vec3::new(i as f64, 100.0 + i as f64, 200.0 - i as f64);
            let values: Vec<Padded> = (0..COUNT).map(|i| vector(i).into()).collect();
            // several lanes may name one vector
            for shift in 0..COUNT {
                let indices: Vec<u16> =
                    (0..S::F64_LANES).map(|lane| ((shift + lane * lane / 2) % COUNT) as u16).collect();
                // SAFETY: as many indices as lanes, below COUNT
                let gathered = unsafe { Vec3::gather(simd, &values, &indices) };
                let mut expected = vec![Vec3::ZERO; COUNT];
                for (lane, index) in indices.iter().enumerate() {
                    let lane = |lanes: Lanes<S>| lanes.as_slice()[lane];
                    let found = Vec3::new(lane(gathered.x), lane(gathered.y), lane(gathered.z));
                    assert_eq!(found, vector(*index as usize));
                    expected[*index as usize] += found;
                }
                let mut sums = vec![Padded::default(); COUNT];
                // SAFETY: as above
                unsafe { gathered.scatter_add(simd, &mut sums, &indices) };
                assert_eq!(sums.into_iter().map(Vec3::from).collect::<Vec<_>>(), expected);
            }
        }
    }

    /// Lanes hold the vectors that were named, and each goes back to where it came from, whatever the width.
    #[test]
    fn gather_and_scatter_are_transposed() {
        Arch::default().dispatch(ThereAndBack);
        ThereAndBack.with_simd(pulp::Scalar::new());
    }
}
