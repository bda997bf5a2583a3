//! Vectors of three, and pairs of numbers, as they lie in long arrays: gathered into lanes as differences, and lanes added
//! back to both ends.

#[cfg(target_arch = "x86_64")]
use std::arch::x86_64::{__m256d, __m256i};

use pulp::Simd;

#[cfg(target_arch = "x86_64")]
use crate::padded::{columns_of_eight, eight_wide, four_or_eight_wide, four_wide};
use crate::{Lanes, Vec3};

impl<S: Simd> Vec3<Lanes<S>> {
    /// `values[to[lane]] - values[from[lane]]` side by side.
    ///
    /// # Safety
    /// There are `S::F64_LANES` indices in both lists, each below the length of `values`.
    #[inline(always)]
    pub unsafe fn gather_difference(simd: S, values: &[Vec3], to: &[u32], from: &[u32]) -> Self {
        debug_assert!(to[..S::F64_LANES].iter().all(|index| (*index as usize) < values.len()));
        debug_assert!(from[..S::F64_LANES].iter().all(|index| (*index as usize) < values.len()));
        #[cfg(target_arch = "x86_64")]
        if let Some(v3) = four_wide(&simd) {
            // SAFETY: promised by the caller for every lane
            let row = |lane: usize| unsafe { difference(v3, values, to, from, lane) };
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
            // SAFETY: promised by the caller for every lane
            let row = |lane: usize| unsafe { difference(v4, values, to, from, lane) };
            let rows = [row(0), row(1), row(2), row(3), row(4), row(5), row(6), row(7)];
            let [x, y, z] = columns_of_eight(v4, rows);
            return Self::new(
                Lanes::new(simd, bytemuck::cast(x)),
                Lanes::new(simd, bytemuck::cast(y)),
                Lanes::new(simd, bytemuck::cast(z)),
            );
        }
        // SAFETY: promised by the caller for every lane
        let value = |lane: usize| unsafe {
            let of = |indices: &[u32]| *values.get_unchecked(*indices.get_unchecked(lane) as usize);
            of(to) - of(from)
        };
        let zero = Lanes::constant(simd, 0.0);
        let mut out = Self::new(zero, zero, zero);
        for lane in 0..S::F64_LANES {
            let value = value(lane);
            out.x.as_mut_slice()[lane] = value.x;
            out.y.as_mut_slice()[lane] = value.y;
            out.z.as_mut_slice()[lane] = value.z;
        }
        out
    }

    /// The vectors of the lanes, one after the other.
    #[inline(always)]
    pub fn unpack(self, simd: S, mut each: impl FnMut(usize, Vec3)) {
        #[cfg(target_arch = "x86_64")]
        if let Some(v3) = four_wide(&simd) {
            let [x, y, z] = self.to_array().map(|lanes| bytemuck::cast(lanes.values()));
            // lanes 0 and 2 of (x y), lanes 1 and 3 of (x y)
            let (even, odd) = (v3.avx._mm256_unpacklo_pd(x, y), v3.avx._mm256_unpackhi_pd(x, y));
            let ([ax, ay, cx, cy], [bx, by, dx, dy]): ([f64; 4], [f64; 4]) =
                (bytemuck::cast(even), bytemuck::cast(odd));
            let [az, bz, cz, dz]: [f64; 4] = bytemuck::cast(z);
            each(0, Vec3::new(ax, ay, az));
            each(1, Vec3::new(bx, by, bz));
            each(2, Vec3::new(cx, cy, cz));
            each(3, Vec3::new(dx, dy, dz));
            return;
        }
        for lane in 0..S::F64_LANES {
            each(lane, Vec3::new(self.x.as_slice()[lane], self.y.as_slice()[lane], self.z.as_slice()[lane]));
        }
    }

    /// `sums[to[lane]] += self`, `sums[from[lane]] -= self`, lane after lane.
    ///
    /// # Safety
    /// There are `S::F64_LANES` indices in both lists, each below the length of `sums`.
    #[inline(always)]
    pub unsafe fn scatter_pair(self, simd: S, sums: &mut [Vec3], to: &[u32], from: &[u32]) {
        debug_assert!(to[..S::F64_LANES].iter().all(|index| (*index as usize) < sums.len()));
        debug_assert!(from[..S::F64_LANES].iter().all(|index| (*index as usize) < sums.len()));
        #[cfg(target_arch = "x86_64")]
        if let Some(v3) = four_wide(&simd) {
            let [x, y, z] = self.to_array().map(|lanes| bytemuck::cast(lanes.values()));
            let (even, odd) = (v3.avx._mm256_unpacklo_pd(x, y), v3.avx._mm256_unpackhi_pd(x, y));
            // (x y) of lanes 0 to 3, and their z
            let halves = [
                v3.avx._mm256_castpd256_pd128(even),
                v3.avx._mm256_castpd256_pd128(odd),
                v3.avx._mm256_extractf128_pd::<1>(even),
                v3.avx._mm256_extractf128_pd::<1>(odd),
            ];
            let thirds: [f64; 4] = bytemuck::cast(z);
            for lane in 0..4 {
                // SAFETY: promised by the caller
                let sum = unsafe { sums.get_unchecked_mut(*to.get_unchecked(lane) as usize) };
                let xy = v3.sse2._mm_add_pd(bytemuck::cast([sum.x, sum.y]), halves[lane]);
                [sum.x, sum.y] = bytemuck::cast(xy);
                sum.z += thirds[lane];
                // SAFETY: promised by the caller
                let sum = unsafe { sums.get_unchecked_mut(*from.get_unchecked(lane) as usize) };
                let xy = v3.sse2._mm_sub_pd(bytemuck::cast([sum.x, sum.y]), halves[lane]);
                [sum.x, sum.y] = bytemuck::cast(xy);
                sum.z -= thirds[lane];
            }
            return;
        }
        #[cfg(target_arch = "x86_64")]
        if let Some(v4) = eight_wide(&simd) {
            let [x, y, z] = self.to_array().map(|lanes| bytemuck::cast(lanes.values()));
            let (even, odd) = (v4.avx512f._mm512_unpacklo_pd(x, y), v4.avx512f._mm512_unpackhi_pd(x, y));
            // (x y) of lanes 0 2 4 6 and of 1 3 5 7, and their z
            let halves: [[[f64; 2]; 4]; 2] = [bytemuck::cast(even), bytemuck::cast(odd)];
            let thirds: [f64; 8] = bytemuck::cast(z);
            for lane in 0..8 {
                let half = bytemuck::cast(halves[lane % 2][lane / 2]);
                // SAFETY: promised by the caller
                let sum = unsafe { sums.get_unchecked_mut(*to.get_unchecked(lane) as usize) };
                let xy = v4.sse2._mm_add_pd(bytemuck::cast([sum.x, sum.y]), half);
                [sum.x, sum.y] = bytemuck::cast(xy);
                sum.z += thirds[lane];
                // SAFETY: promised by the caller
                let sum = unsafe { sums.get_unchecked_mut(*from.get_unchecked(lane) as usize) };
                let xy = v4.sse2._mm_sub_pd(bytemuck::cast([sum.x, sum.y]), half);
                [sum.x, sum.y] = bytemuck::cast(xy);
                sum.z -= thirds[lane];
            }
            return;
        }
        self.unpack(simd, |lane, part| {
            // SAFETY: promised by the caller
            unsafe {
                *sums.get_unchecked_mut(*to.get_unchecked(lane) as usize) += part;
                *sums.get_unchecked_mut(*from.get_unchecked(lane) as usize) -= part;
            }
        });
    }
}

impl<S: Simd> Lanes<S> {
    /// `values[to[lane]] - values[from[lane]]` side by side: first numbers, then second ones.
    ///
    /// # Safety
    /// There are `S::F64_LANES` indices in both lists, each below the length of `values`.
    #[inline(always)]
    pub unsafe fn gather_differences(simd: S, values: &[[f64; 2]], to: &[u32], from: &[u32]) -> [Self; 2] {
        debug_assert!(to[..S::F64_LANES].iter().all(|index| (*index as usize) < values.len()));
        debug_assert!(from[..S::F64_LANES].iter().all(|index| (*index as usize) < values.len()));
        #[cfg(target_arch = "x86_64")]
        if let Some(v3) = four_or_eight_wide(&simd) {
            // SAFETY: promised by the caller for every lane
            let pair = |lane: usize| unsafe {
                let of = |indices: &[u32]| *values.get_unchecked(*indices.get_unchecked(lane) as usize);
                v3.sse2._mm_sub_pd(bytemuck::cast(of(to)), bytemuck::cast(of(from)))
            };
            // (a.0 b.0 c.0 d.0) and (a.1 b.1 c.1 d.1) of four lanes
            let four = |first: usize| -> [[f64; 4]; 2] {
                let ac = v3.avx._mm256_set_m128d(pair(first + 2), pair(first));
                let bd = v3.avx._mm256_set_m128d(pair(first + 3), pair(first + 1));
                [
                    bytemuck::cast(v3.avx._mm256_unpacklo_pd(ac, bd)),
                    bytemuck::cast(v3.avx._mm256_unpackhi_pd(ac, bd)),
                ]
            };
            if S::F64_LANES == 4 {
                return four(0).map(|numbers| Self::load(simd, &numbers));
            }
            let ([a, c], [b, d]) = (four(0), four(4));
            let eight = |low: [f64; 4], high: [f64; 4]| -> [f64; 8] { bytemuck::cast([low, high]) };
            return [Self::load(simd, &eight(a, b)), Self::load(simd, &eight(c, d))];
        }
        // SAFETY: promised by the caller for every lane
        let value = |lane: usize| unsafe {
            let of = |indices: &[u32]| *values.get_unchecked(*indices.get_unchecked(lane) as usize);
            let ([a, b], [c, d]) = (of(to), of(from));
            [a - c, b - d]
        };
        let mut out = [Self::constant(simd, 0.0); 2];
        for lane in 0..S::F64_LANES {
            let value = value(lane);
            out[0].as_mut_slice()[lane] = value[0];
            out[1].as_mut_slice()[lane] = value[1];
        }
        out
    }

    /// `to[lane] - from[lane]` side by side: first numbers, then second ones.
    ///
    /// # Panics
    /// There are fewer than `S::F64_LANES` of either.
    #[inline(always)]
    pub fn differences_in_order(simd: S, to: &[[f64; 2]], from: &[[f64; 2]]) -> [Self; 2] {
        let (to, from) = (&to[..S::F64_LANES], &from[..S::F64_LANES]);
        #[cfg(target_arch = "x86_64")]
        if let Some(v3) = four_or_eight_wide(&simd) {
            let [a, b] = four_differences(v3, to, from);
            if S::F64_LANES == 4 {
                return [Self::load(simd, &a), Self::load(simd, &b)];
            }
            let [c, d] = four_differences(v3, &to[4..], &from[4..]);
            let (first, second): ([f64; 8], [f64; 8]) = (bytemuck::cast([a, c]), bytemuck::cast([b, d]));
            return [Self::load(simd, &first), Self::load(simd, &second)];
        }
        let mut out = [Self::constant(simd, 0.0); 2];
        for lane in 0..S::F64_LANES {
            out[0].as_mut_slice()[lane] = to[lane][0] - from[lane][0];
            out[1].as_mut_slice()[lane] = to[lane][1] - from[lane][1];
        }
        out
    }

    /// `sums[to[lane]] += self`, `sums[from[lane]] -= self`, lane after lane.
    ///
    /// # Safety
    /// There are `S::F64_LANES` indices in both lists, each below the length of `sums`.
    #[inline(always)]
    pub unsafe fn scatter_pair(self, sums: &mut [f64], to: &[u32], from: &[u32]) {
        debug_assert!(to[..S::F64_LANES].iter().all(|index| (*index as usize) < sums.len()));
        debug_assert!(from[..S::F64_LANES].iter().all(|index| (*index as usize) < sums.len()));
        for (lane, number) in self.as_slice().iter().enumerate() {
            // SAFETY: promised by the caller
            unsafe {
                *sums.get_unchecked_mut(*to.get_unchecked(lane) as usize) += number;
                *sums.get_unchecked_mut(*from.get_unchecked(lane) as usize) -= number;
            }
        }
    }
}

/// `values[to[lane]] - values[from[lane]]`, and zero behind it.
///
/// # Safety
/// Both lists have the lane, and their indices there are below the length of `values`.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
unsafe fn difference(v3: &pulp::x86::V3, values: &[Vec3], to: &[u32], from: &[u32], lane: usize) -> __m256d {
    let three: __m256i = bytemuck::cast([-1_i64, -1, -1, 0]);
    // SAFETY: promised by the caller; the mask leaves out what stands behind the vectors
    unsafe {
        let place =
            |indices: &[u32]| values.as_ptr().add(*indices.get_unchecked(lane) as usize).cast::<f64>();
        v3.avx._mm256_sub_pd(
            v3.avx._mm256_maskload_pd(place(to), three),
            v3.avx._mm256_maskload_pd(place(from), three),
        )
    }
}

/// The first four differences side by side: first numbers, then second ones. A function, since a closure may be left standing by
/// itself: what is not inlined is not compiled for the processor's instructions.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn four_differences(v3: &pulp::x86::V3, to: &[[f64; 2]], from: &[[f64; 2]]) -> [[f64; 4]; 2] {
    // two lanes: (a.0 a.1 b.0 b.1)
    let ab = v3.avx._mm256_sub_pd(bytemuck::cast([to[0], to[1]]), bytemuck::cast([from[0], from[1]]));
    let cd = v3.avx._mm256_sub_pd(bytemuck::cast([to[2], to[3]]), bytemuck::cast([from[2], from[3]]));
    let ac = v3.avx._mm256_permute2f128_pd::<0x20>(ab, cd);
    let bd = v3.avx._mm256_permute2f128_pd::<0x31>(ab, cd);
    [bytemuck::cast(v3.avx._mm256_unpacklo_pd(ac, bd)), bytemuck::cast(v3.avx._mm256_unpackhi_pd(ac, bd))]
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
            let vector = |i: usize| Vec3::new(i as f64, 100.0 + (i * i) as f64, 200.0 - i as f64);
            let values: Vec<Vec3> = (0..COUNT).map(vector).collect();
            // several lanes may name one vector, the last of the array too
            for shift in 0..COUNT {
                let list = |salt: usize| -> Vec<u32> {
                    (0..S::F64_LANES).map(|lane| ((shift + salt + lane * lane / 2) % COUNT) as u32).collect()
                };
                let (to, from) = (list(0), list(5));
                // SAFETY: as many indices as lanes, below COUNT
                let difference = unsafe { Vec3::gather_difference(simd, &values, &to, &from) };
                let mut expected = vec![Vec3::ZERO; COUNT];
                difference.unpack(simd, |lane, found| {
                    let (a, b) = (to[lane] as usize, from[lane] as usize);
                    assert_eq!(found, vector(a) - vector(b));
                    expected[a] += found;
                    expected[b] -= found;
                });
                let mut sums = vec![Vec3::ZERO; COUNT];
                // SAFETY: as above
                unsafe { difference.scatter_pair(simd, &mut sums, &to, &from) };
                assert_eq!(sums, expected);
                let pairs: Vec<[f64; 2]> = values.iter().map(|value| [value.x, value.y]).collect();
                // SAFETY: as above
                let [x, y] = unsafe { Lanes::gather_differences(simd, &pairs, &to, &from) };
                assert_eq!((x.as_slice(), y.as_slice()), (difference.x.as_slice(), difference.y.as_slice()));
                let in_order = |first: usize| -> Vec<u32> {
                    (0..S::F64_LANES as u32).map(|lane| first as u32 + lane).collect()
                };
                let (first, second) = (shift % (COUNT - 7), (shift + 3) % (COUNT - 7));
                // SAFETY: as above, for there are no more than eight lanes
                let expected_in_order =
                    unsafe { Lanes::gather_differences(simd, &pairs, &in_order(first), &in_order(second)) };
                let found = Lanes::differences_in_order(simd, &pairs[first..], &pairs[second..]);
                assert_eq!(
                    found.map(|lanes| lanes.as_slice().to_vec()),
                    expected_in_order.map(|lanes| lanes.as_slice().to_vec())
                );
                let mut sums = vec![0.0; COUNT];
                // SAFETY: as above
                unsafe { y.scatter_pair(&mut sums, &to, &from) };
                assert!(sums.iter().zip(&expected).all(|(sum, expected)| *sum == expected.y));
            }
        }
    }

    /// Lanes hold the differences that were named, and each goes to both of its ends, whatever the width.
    #[test]
    fn differences_go_back_to_both_ends() {
        Arch::default().dispatch(ThereAndBack);
        ThereAndBack.with_simd(pulp::Scalar::new());
    }
}
