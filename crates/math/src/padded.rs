//! Vectors in memory as registers like them: many gathered into lanes at once, and lanes added back.

use std::any::Any;

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
        if S::F64_LANES == 8 {
            // written out so that registers are filled by insertion: through memory, eight narrow stores followed by
            // a wide load would stall
            let (a, b, c, d) = (value(0), value(1), value(2), value(3));
            let (e, f, g, h) = (value(4), value(5), value(6), value(7));
            return Self::new(
                Lanes::load(simd, &[a[0], b[0], c[0], d[0], e[0], f[0], g[0], h[0]]),
                Lanes::load(simd, &[a[1], b[1], c[1], d[1], e[1], f[1], g[1], h[1]]),
                Lanes::load(simd, &[a[2], b[2], c[2], d[2], e[2], f[2], g[2], h[2]]),
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
