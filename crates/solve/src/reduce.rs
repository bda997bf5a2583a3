//! Sums and vector updates in a fixed order.
//!
//! Every loop is cut into chunks of [`CHUNK`] blocks, and partial sums meet in a binary tree that depends on
//! the length alone. Threads only decide who computes a chunk, never what is added to what.

use std::ops::{Add, Range};

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

/// Overwrites two vectors of the same length chunk by chunk.
pub fn for_each_chunk_pair(
    y: &mut [Vec3],
    z: &mut [Vec3],
    leaf: &(impl Fn(usize, &mut [Vec3], &mut [Vec3]) + Sync),
) {
    sum_mut_pair(0, y, z, &|first, y: &mut [Vec3], z: &mut [Vec3]| {
        leaf(first, y, z);
        Nothing
    });
}

/// [`for_each_chunk_pair`] for products of rows of a matrix, see [`sum_rows`].
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
    // 0 x is zero, or not a number where x is not finite; sums need no branches
    let zeros = |range: Range<usize>| {
        let numbers: &[f64] = bytemuck::cast_slice(&a[range]);
        let quads = numbers.chunks_exact(4);
        let rest: f64 = quads.remainder().iter().map(|number| number * 0.0).sum();
        let mut partial = [0.0; 4];
        for quad in quads {
            for lane in 0..4 {
                partial[lane] += quad[lane] * 0.0;
            }
        }
        partial[0] + partial[1] + partial[2] + partial[3] + rest
    };
    sum(0..a.len(), &zeros) == 0.0
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
