//! Sums and vector updates in a fixed order.
//!
//! Every loop is cut into chunks of [`CHUNK`] blocks, and partial sums meet in a binary tree that depends on
//! the length alone. Threads only decide who computes a chunk, never what is added to what.

use std::ops::{Add, Range};

use pulp::{Arch, Simd, WithSimd};
use souple_math::Vec3;

/// Blocks per chunk; part of the meaning of a sum, hence a constant.
pub const CHUNK: usize = 512;

/// Vectors shorter than this are not worth waking a second thread for.
const PARALLEL_FROM: usize = 16 * CHUNK;

/// The same for rows of a matrix, which cost many times an entry of a vector.
const PARALLEL_ROWS_FROM: usize = 4 * CHUNK;

/// Where the tree splits `length` blocks: at a multiple of [`CHUNK`]; `None` for a leaf.
fn middle(length: usize) -> Option<usize> {
    (length > CHUNK).then(|| length.div_ceil(CHUNK).div_ceil(2) * CHUNK)
}

/// Both results, by two threads where the work `is_long`.
pub(crate) fn both<A: Send, B: Send>(
    is_long: bool,
    a: impl FnOnce() -> A + Send,
    b: impl FnOnce() -> B + Send,
) -> (A, B) {
    if is_long && rayon::current_num_threads() > 1 { rayon::join(a, b) } else { (a(), b()) }
}

/// Sum of `leaf` over the chunks of `range`.
pub fn sum<S: Send + Add<Output = S>>(range: Range<usize>, leaf: &(impl Fn(Range<usize>) -> S + Sync)) -> S {
    let Some(middle) = middle(range.len()) else { return leaf(range) };
    let middle = range.start + middle;
    let (a, b) = both(
        range.len() >= PARALLEL_FROM,
        || sum(range.start..middle, leaf),
        || sum(middle..range.end, leaf),
    );
    a + b
}

/// Sum of `leaf(first, chunk)` over the chunks of `y`; `leaf` may overwrite its chunk, which begins at
/// block `first`.
pub fn sum_mut<T: Send, S: Send + Add<Output = S>>(
    first: usize,
    y: &mut [T],
    leaf: &(impl Fn(usize, &mut [T]) -> S + Sync),
) -> S {
    sum_mut_from(PARALLEL_FROM, first, y, leaf)
}

/// [`sum_mut`] for a `leaf` that multiplies rows of a matrix: the same sums, shared among threads earlier.
pub fn sum_rows<T: Send, S: Send + Add<Output = S>>(
    y: &mut [T],
    leaf: &(impl Fn(usize, &mut [T]) -> S + Sync),
) -> S {
    sum_mut_from(PARALLEL_ROWS_FROM, 0, y, leaf)
}

fn sum_mut_from<T: Send, S: Send + Add<Output = S>>(
    parallel_from: usize,
    first: usize,
    y: &mut [T],
    leaf: &(impl Fn(usize, &mut [T]) -> S + Sync),
) -> S {
    let length = y.len();
    let Some(middle) = middle(length) else { return leaf(first, y) };
    let (head, tail) = y.split_at_mut(middle);
    let (a, b) = both(
        length >= parallel_from,
        || sum_mut_from(parallel_from, first, head, leaf),
        || sum_mut_from(parallel_from, first + middle, tail, leaf),
    );
    a + b
}

/// [`sum_mut`] over two vectors of the same length.
pub fn sum_mut_pair<S: Send + Add<Output = S>>(
    first: usize,
    y: &mut [Vec3],
    z: &mut [Vec3],
    leaf: &(impl Fn(usize, &mut [Vec3], &mut [Vec3]) -> S + Sync),
) -> S {
    sum_mut_pair_from(PARALLEL_FROM, first, y, z, leaf)
}

fn sum_mut_pair_from<S: Send + Add<Output = S>>(
    parallel_from: usize,
    first: usize,
    y: &mut [Vec3],
    z: &mut [Vec3],
    leaf: &(impl Fn(usize, &mut [Vec3], &mut [Vec3]) -> S + Sync),
) -> S {
    let length = y.len();
    let Some(middle) = middle(length) else { return leaf(first, y, z) };
    let (y_head, y_tail) = y.split_at_mut(middle);
    let (z_head, z_tail) = z.split_at_mut(middle);
    let (a, b) = both(
        length >= parallel_from,
        || sum_mut_pair_from(parallel_from, first, y_head, z_head, leaf),
        || sum_mut_pair_from(parallel_from, first + middle, y_tail, z_tail, leaf),
    );
    a + b
}

/// The sum of a loop that sums nothing.
struct Nothing;

impl Add for Nothing {
    type Output = Self;
    fn add(self, _: Self) -> Self {
        Self
    }
}

/// Overwrites `y` chunk by chunk.
pub fn for_each_chunk<T: Send>(y: &mut [T], leaf: &(impl Fn(usize, &mut [T]) + Sync)) {
    sum_mut(0, y, &|first, chunk: &mut [T]| {
        leaf(first, chunk);
        Nothing
    });
}

/// Overwrites two vectors of the same length chunk by chunk: products of rows of a matrix, see [`sum_rows`].
pub fn for_each_rows_pair(
    y: &mut [Vec3],
    z: &mut [Vec3],
    leaf: &(impl Fn(usize, &mut [Vec3], &mut [Vec3]) + Sync),
) {
    sum_mut_pair_from(PARALLEL_ROWS_FROM, 0, y, z, &|first, y: &mut [Vec3], z: &mut [Vec3]| {
        leaf(first, y, z);
        Nothing
    });
}

/// [`for_each_chunk`] for rows of a matrix, see [`sum_rows`].
pub fn for_each_rows<T: Send>(y: &mut [T], leaf: &(impl Fn(usize, &mut [T]) + Sync)) {
    sum_rows(y, &|first, chunk: &mut [T]| {
        leaf(first, chunk);
        Nothing
    });
}

/// `to = from`.
pub fn copy(to: &mut [Vec3], from: &[Vec3]) {
    assert_eq!(to.len(), from.len(), "vectors of one length");
    for_each_chunk(to, &|first, chunk: &mut [Vec3]| {
        chunk.copy_from_slice(&from[first..first + chunk.len()]);
    });
}

/// Whether all entries are finite.
pub fn all_finite(a: &[Vec3]) -> bool {
    sum(0..a.len(), &|range| Arch::new().dispatch(Zeros(bytemuck::cast_slice(&a[range])))) == 0.0
}

/// `Σ 0 x`: zero, or not a number where an `x` is not finite; sums need no branches.
struct Zeros<'a>(&'a [f64]);

impl WithSimd for Zeros<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let (lanes, rest) = S::as_simd_f64s(self.0);
        let zero = simd.splat_f64s(0.0);
        let mut sums = [zero; 4];
        for four in lanes.chunks(4) {
            for (sum, x) in sums.iter_mut().zip(four) {
                *sum = simd.mul_add_e_f64s(*x, zero, *sum);
            }
        }
        let [a, b, c, d] = sums;
        let rest: f64 = rest.iter().map(|x| x * 0.0).sum();
        simd.reduce_sum_f64s(simd.add_f64s(simd.add_f64s(a, b), simd.add_f64s(c, d))) + rest
    }
}

/// Points that are kicked and drift: `v' = v + h f/m`, `q' = q + h v'`.
pub struct KickAndDrift<'a> {
    pub q: &'a mut [Vec3],
    pub v: &'a mut [Vec3],
    /// Where the new ones are written as well.
    pub copies: [&'a mut [Vec3]; 2],
    pub forces: &'a [Vec3],
    pub masses: &'a [f64],
    pub timestep: f64,
}

impl KickAndDrift<'_> {
    /// All of them, in one pass. Returns whether all are finite.
    ///
    /// # Panics
    /// If the vectors are not of one length.
    pub fn run(self) -> bool {
        self.zeros() == 0.0
    }

    /// `Σ 0 x` over the new ones, see [`Zeros`].
    fn zeros(self) -> f64 {
        let length = self.q.len();
        let Some(middle) = middle(length) else { return Arch::new().dispatch(self) };
        let Self { q, v, copies: [to_q, to_v], forces, masses, timestep } = self;
        let (q, q_tail) = q.split_at_mut(middle);
        let (v, v_tail) = v.split_at_mut(middle);
        let (to_q, to_q_tail) = to_q.split_at_mut(middle);
        let (to_v, to_v_tail) = to_v.split_at_mut(middle);
        let ((forces, forces_tail), (masses, masses_tail)) =
            (forces.split_at(middle), masses.split_at(middle));
        let head = Self { q, v, copies: [to_q, to_v], forces, masses, timestep };
        let copies = [to_q_tail, to_v_tail];
        let tail = Self { q: q_tail, v: v_tail, copies, forces: forces_tail, masses: masses_tail, timestep };
        let (a, b) = both(length >= PARALLEL_FROM, || head.zeros(), || tail.zeros());
        a + b
    }
}

impl WithSimd for KickAndDrift<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let Self { q, v, copies: [to_q, to_v], forces, masses, timestep } = self;
        assert!([v.len(), to_q.len(), to_v.len(), forces.len(), masses.len()] == [q.len(); 5]);
        let (q, q_rest) = S::as_mut_simd_f64s(bytemuck::cast_slice_mut(q));
        let (v, v_rest) = S::as_mut_simd_f64s(bytemuck::cast_slice_mut(v));
        let (to_q, to_q_rest) = S::as_mut_simd_f64s(bytemuck::cast_slice_mut(to_q));
        let (to_v, to_v_rest) = S::as_mut_simd_f64s(bytemuck::cast_slice_mut(to_v));
        let (forces, forces_rest) = S::as_simd_f64s(bytemuck::cast_slice(forces));
        let (h, zero) = (simd.splat_f64s(timestep), simd.splat_f64s(0.0));
        // no fused products: the same bits as kick and drift one after the other
        let kicked = |v: S::f64s, f: S::f64s, inverse: S::f64s| {
            simd.add_f64s(v, simd.mul_f64s(simd.mul_f64s(f, inverse), h))
        };
        let drifted = |q: S::f64s, v: S::f64s| simd.add_f64s(q, simd.mul_f64s(v, h));
        // a velocity that is not finite makes a position that is none; what was computed is written twice, never read back
        let mut zeros = zero;
        let points = q.iter_mut().zip(v).zip(to_q.iter_mut().zip(to_v)).zip(forces);
        let first = masses.first().copied().unwrap_or(1.0);
        // all are looked at, several at a time
        let differing = masses.iter().fold(0_u64, |count, mass| count + u64::from(*mass != first));
        if differing == 0 {
            let inverse = simd.splat_f64s(1.0 / first);
            for (((q, v), (to_q, to_v)), f) in points {
                let faster = kicked(*v, *f, inverse);
                let further = drifted(*q, faster);
                (*v, *to_v) = (faster, faster);
                (*q, *to_q) = (further, further);
                zeros = simd.mul_add_e_f64s(further, zero, zeros);
            }
        } else {
            // 1/m three times over
            let mut inverses = [0.0; 3 * CHUNK];
            let inverses = &mut inverses[..3 * masses.len()];
            for (three, mass) in inverses.chunks_exact_mut(3).zip(masses) {
                three.fill(1.0 / mass);
            }
            for ((((q, v), (to_q, to_v)), f), inverse) in points.zip(S::as_simd_f64s(inverses).0) {
                let faster = kicked(*v, *f, *inverse);
                let further = drifted(*q, faster);
                (*v, *to_v) = (faster, faster);
                (*q, *to_q) = (further, further);
                zeros = simd.mul_add_e_f64s(further, zero, zeros);
            }
        }
        let done = 3 * masses.len() - q_rest.len();
        let mut rest = 0.0;
        for i in 0..q_rest.len() {
            v_rest[i] += forces_rest[i] * (1.0 / masses[(done + i) / 3]) * timestep;
            q_rest[i] += v_rest[i] * timestep;
            (to_q_rest[i], to_v_rest[i]) = (q_rest[i], v_rest[i]);
            rest += q_rest[i] * 0.0;
        }
        simd.reduce_sum_f64s(zeros) + rest
    }
}

/// `a · b`.
pub fn dot(a: &[Vec3], b: &[Vec3]) -> f64 {
    sum(0..a.len(), &|range: Range<usize>| dot_chunk(&a[range.clone()], &b[range]))
}

/// `a · b` of one chunk, in four interleaved partial sums so that the additions need not wait for each other.
pub(crate) fn dot_chunk(a: &[Vec3], b: &[Vec3]) -> f64 {
    let (a, b): (&[f64], &[f64]) = (bytemuck::cast_slice(a), bytemuck::cast_slice(b));
    let mut partial = [0.0; 4];
    let (a_quads, b_quads) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest: f64 = a_quads.remainder().iter().zip(b_quads.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in a_quads.zip(b_quads) {
        for lane in 0..4 {
            partial[lane] += a[lane] * b[lane];
        }
    }
    (partial[0] + partial[2]) + (partial[1] + partial[3]) + rest
}

/// `√(a · a)`.
pub fn norm(a: &[Vec3]) -> f64 {
    dot(a, a).sqrt()
}

/// `y += s x`.
pub fn add_scaled(y: &mut [Vec3], s: f64, x: &[Vec3]) {
    for_each_chunk(y, &|first, chunk: &mut [Vec3]| {
        for (y, x) in chunk.iter_mut().zip(&x[first..]) {
            *y += *x * s;
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(count: usize, phase: f64) -> Vec<Vec3> {
        let entry = |i: usize| (i as f64 * 0.37 + phase).sin();
        (0..count).map(|i| Vec3::new(entry(i), entry(3 * i + 1), entry(7 * i + 2))).collect()
    }

    /// `a · b` agrees with the plain sum to rounding, `3 n ε` relative to `Σ|aᵢbᵢ| ≤ 3 n`.
    #[test]
    fn dot_is_the_sum_of_products() {
        for count in [0, 1, 2, CHUNK - 1, CHUNK, CHUNK + 1, 3 * CHUNK + 5, 40 * CHUNK + 17] {
            let (a, b) = (wave(count, 0.1), wave(count, 0.7));
            let plain: f64 = a.iter().zip(&b).map(|(a, b)| a.x * b.x + a.y * b.y + a.z * b.z).sum();
            let terms = 3.0 * count as f64;
            assert!((dot(&a, &b) - plain).abs() <= terms * terms * f64::EPSILON);
        }
    }

    /// Points move as by a kick and a drift one after the other, to the last bit, whether their masses are the same or not.
    #[test]
    fn kick_and_drift_are_one_after_the_other() {
        for count in [0, 1, 5, CHUNK, 2 * CHUNK + 7, 17 * CHUNK + 1] {
            for spread in [0.0, 0.3] {
                let masses: Vec<f64> = (0..count).map(|i| 0.7 + spread * (i as f64).sin()).collect();
                let (mut q, mut v, forces) = (wave(count, 0.1), wave(count, 0.5), wave(count, 0.9));
                let (mut expected_q, mut expected_v) = (q.clone(), v.clone());
                for i in 0..count {
                    expected_v[i] += forces[i] * (1.0 / masses[i]) * 0.01;
                    expected_q[i] += expected_v[i] * 0.01;
                }
                let (forces, masses) = (&forces[..], &masses[..]);
                let (mut to_q, mut to_v) = (vec![Vec3::ZERO; count], vec![Vec3::ZERO; count]);
                let copies = [&mut to_q[..], &mut to_v[..]];
                let all = KickAndDrift { q: &mut q, v: &mut v, copies, forces, masses, timestep: 0.01 };
                assert!(all.run());
                assert!(q == expected_q && v == expected_v, "{count}");
                assert!(to_q == q && to_v == v, "{count}");
            }
        }
    }

    /// A point that is kicked to no finite place is told, wherever it stands.
    #[test]
    fn points_that_are_lost_are_told() {
        let count = CHUNK + 5;
        for at in [0, 7, CHUNK, count - 1] {
            for bad in [f64::NAN, f64::INFINITY, f64::MAX] {
                let (mut q, mut v, mut forces) = (wave(count, 0.1), wave(count, 0.5), wave(count, 0.9));
                forces[at].z = bad;
                let (mut to_q, mut to_v, masses) = (q.clone(), v.clone(), vec![1e-3; count]);
                let copies = [&mut to_q[..], &mut to_v[..]];
                let (forces, masses) = (&forces[..], &masses[..]);
                let all = KickAndDrift { q: &mut q, v: &mut v, copies, forces, masses, timestep: 0.01 };
                assert!(!all.run(), "{bad} at {at}");
            }
        }
    }

    /// One entry that is not finite is found wherever it stands.
    #[test]
    fn finds_what_is_not_finite() {
        let finite = wave(2 * CHUNK + 3, 0.3);
        assert!(all_finite(&finite) && all_finite(&[]) && all_finite(&[Vec3::new(f64::MAX, -f64::MAX, 0.0)]));
        for at in [0, 1, CHUNK, finite.len() - 1] {
            for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                let mut entries = finite.clone();
                entries[at].y = bad;
                assert!(!all_finite(&entries), "{bad} at {at}");
            }
        }
    }

    /// Bits do not depend on the number of threads.
    #[test]
    fn same_bits_for_any_thread_count() {
        let (a, b) = (wave(100_003, 0.1), wave(100_003, 0.7));
        let with = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let mut y = a.clone();
                add_scaled(&mut y, 0.3, &b);
                (dot(&a, &b).to_bits(), norm(&y).to_bits())
            })
        };
        let one = with(1);
        assert_eq!(one, with(2));
        assert_eq!(one, with(5));
    }
}
