//! Work on chunks, shared among threads: the same bits for any number of them.
//!
//! Ranges of chunks are halved until a thread takes them as they are; nothing is allocated on the way.

use std::ops::Range;

/// Chunks that are not worth halving, where each is a force, a product or an energy (some microseconds).
pub const LIGHT: usize = 8;
/// The same where each is the blocks of a matrix (some tens of microseconds).
pub const HEAVY: usize = 4;

/// Calls `work(chunk, its part of sums)`; the part of chunk `n` is `start_of(n)..start_of(n + 1)`, counted from that
/// of the first chunk.
pub fn fill<T: Send>(
    chunks: Range<usize>,
    grain: usize,
    sums: &mut [T],
    start_of: &(impl Fn(usize) -> usize + Sync),
    work: &(impl Fn(usize, &mut [T]) + Sync),
) {
    if chunks.len() >= grain.max(2) && rayon::current_num_threads() > 1 {
        let middle = chunks.start + chunks.len() / 2;
        let (head, tail) = sums.split_at_mut(start_of(middle) - start_of(chunks.start));
        rayon::join(
            || fill(chunks.start..middle, grain, head, start_of, work),
            || fill(middle..chunks.end, grain, tail, start_of, work),
        );
        return;
    }
    let mut remaining = sums;
    for chunk in chunks {
        let (mine, rest) = remaining.split_at_mut(start_of(chunk + 1) - start_of(chunk));
        remaining = rest;
        work(chunk, mine);
    }
}

/// `Σ number(chunk)`, added up along the same halves whether threads share them or not.
pub fn sum(chunks: Range<usize>, number: &(impl Fn(usize) -> f64 + Sync)) -> f64 {
    if chunks.len() < LIGHT {
        return chunks.map(number).sum();
    }
    let middle = chunks.start + chunks.len() / 2;
    let (head, tail) = (chunks.start..middle, middle..chunks.end);
    let (head, tail) = if rayon::current_num_threads() > 1 {
        rayon::join(|| sum(head, number), || sum(tail, number))
    } else {
        (sum(head, number), sum(tail, number))
    };
    head + tail
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
    }

    /// Every chunk is called once with its own part, by any number of threads.
    #[test]
    fn parts_are_those_of_their_chunks() {
        let start_of = |chunk: usize| chunk * (chunk + 1) / 2;
        let filled = |threads| {
            with_threads(threads, || {
                let mut sums = vec![0; start_of(40) - start_of(3)];
                fill(3..40, LIGHT, &mut sums, &start_of, &|chunk, part| {
                    assert_eq!(part.len(), chunk + 1);
                    part.iter_mut().for_each(|sum| *sum += chunk);
                });
                sums
            })
        };
        let expected: Vec<usize> = (3..40).flat_map(|chunk| vec![chunk; chunk + 1]).collect();
        assert_eq!(filled(1), expected);
        assert_eq!(filled(3), expected);
    }

    /// Sums are the same to the last bit by any number of threads.
    #[test]
    fn sums_do_not_depend_on_threads() {
        let number = |chunk: usize| (chunk as f64 * 0.7).sin();
        let of = |threads| with_threads(threads, || sum(0..1000, &number));
        assert_eq!(of(1).to_bits(), of(3).to_bits());
        let plain: f64 = (0..1000).map(number).sum();
        // a thousand roundings of sums below 1000
        assert!((of(1) - plain).abs() < 1000.0 * 1000.0 * f64::EPSILON);
    }
}
