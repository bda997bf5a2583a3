//! Orders of points in space, so that what is near in memory is near in space.

use souple_math::Vec3;

use crate::BoundingBox;
use crate::tree::longest_axis;

/// An order of points such that each run of `chunk_size` is compact: recursive bisection along the longest axis
/// at multiples of the chunk size; within a chunk, by number. The last chunk may be shorter.
///
/// # Panics
/// If `chunk_size` is zero.
pub fn recursive_bisection(centres: &[Vec3], chunk_size: usize) -> Vec<u32> {
    assert!(chunk_size > 0, "chunks hold at least one point");
    let mut order: Vec<u32> = (0..centres.len() as u32).collect();
    bisect(centres, &mut order, chunk_size);
    order
}

fn bisect(centres: &[Vec3], items: &mut [u32], chunk_size: usize) {
    let chunks = items.len().div_ceil(chunk_size);
    if chunks <= 1 {
        items.sort_unstable();
        return;
    }
    let axis = longest_axis(BoundingBox::of(items.iter().map(|item| centres[*item as usize])).size());
    let middle = chunks.div_ceil(2) * chunk_size;
    if middle < items.len() {
        // ties are broken by number: the halves do not depend on how they were found
        items.select_nth_unstable_by(middle, |a, b| {
            let [x, y] = [a, b].map(|item| centres[*item as usize][axis]);
            x.total_cmp(&y).then(a.cmp(b))
        });
    }
    let (low, high) = items.split_at_mut(middle);
    bisect(centres, low, chunk_size);
    bisect(centres, high, chunk_size);
}

/// The order of points along Morton's curve on a grid of 2²¹ cells each way over their box; equal ones by number.
pub fn morton_order(centres: &[Vec3]) -> Vec<u32> {
    let bounds = BoundingBox::of(centres.iter().copied());
    // one scale for all axes: cells of the curve stay cubes
    let size = bounds.size().largest_component();
    let scale = if size > 0.0 { f64::from((1u32 << 21) - 1) / size } else { 0.0 };
    let code = |point: Vec3| {
        let [x, y, z] = ((point - bounds.low) * scale).to_array().map(|c| spread(c as u64));
        x | y << 1 | z << 2
    };
    let mut keyed: Vec<(u64, u32)> =
        centres.iter().enumerate().map(|(index, point)| (code(*point), index as u32)).collect();
    keyed.sort_unstable();
    keyed.into_iter().map(|(_, index)| index).collect()
}

/// Two zero bits after each of the lowest 21 bits.
fn spread(bits: u64) -> u64 {
    let mut x = bits & 0x1f_ffff;
    x = (x | x << 32) & 0x001f_0000_0000_ffff;
    x = (x | x << 16) & 0x001f_0000_ff00_00ff;
    x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
    x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
    (x | x << 2) & 0x1249_2492_4924_9249
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(n: usize) -> Vec<Vec3> {
        let at = |i: usize| Vec3::new((i % n) as f64, (i / n % n) as f64, (i / n / n) as f64);
        (0..n * n * n).map(at).collect()
    }

    fn assert_permutation(order: &[u32]) {
        let mut sorted = order.to_vec();
        sorted.sort_unstable();
        assert!(sorted.into_iter().eq(0..order.len() as u32));
    }

    /// Chunks of eight on a grid of 8³ are cubes of 2³: their boxes have the least possible diagonal.
    #[test]
    fn bisection_makes_compact_chunks() {
        let points = grid(8);
        let order = recursive_bisection(&points, 8);
        assert_permutation(&order);
        for chunk in order.chunks(8) {
            let bounds = BoundingBox::of(chunk.iter().map(|index| points[*index as usize]));
            assert_eq!(bounds.size(), Vec3::new(1.0, 1.0, 1.0));
        }
    }

    /// All but the last chunk are full, whatever the count.
    #[test]
    fn bisection_of_any_count() {
        for count in [0, 1, 7, 8, 9, 63, 65, 100] {
            let points: Vec<Vec3> = grid(5).into_iter().take(count).collect();
            let order = recursive_bisection(&points, 8);
            assert_eq!(order.len(), count);
            assert_permutation(&order);
        }
        assert_permutation(&recursive_bisection(&[Vec3::ZERO; 40], 3));
    }

    /// Each block of eight along Morton's curve on a grid of 8³ is a cube of 2³.
    #[test]
    fn morton_visits_octants() {
        let points = grid(8);
        let order = morton_order(&points);
        assert_permutation(&order);
        for chunk in order.chunks(8) {
            let bounds = BoundingBox::of(chunk.iter().map(|index| points[*index as usize]));
            assert_eq!(bounds.size(), Vec3::new(1.0, 1.0, 1.0));
        }
    }
}
