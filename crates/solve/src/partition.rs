//! Cutting a set of blocks in two by where they lie, or by who is coupled to whom.

use std::collections::VecDeque;

use souple_math::Vec3;

use crate::Pattern;

/// How a set of blocks is bisected.
pub(crate) trait Bisection {
    /// Reorders `blocks` so that the first part and the rest lie on two sides; returns the length of the
    /// first, between 1 and `blocks.len() − 1` for two blocks or more.
    fn split(&mut self, blocks: &mut [u32]) -> usize;
}

/// By coordinates: across the longest extent, at the plane that balances the sides best.
pub(crate) struct Geometric<'a> {
    pub coordinates: &'a [Vec3],
}

impl Bisection for Geometric<'_> {
    fn split(&mut self, blocks: &mut [u32]) -> usize {
        let (low, high) = bounds(self.coordinates, blocks);
        let extent = high - low;
        let mut axes = [0, 1, 2];
        axes.sort_by(|&a, &b| extent[b].total_cmp(&extent[a]));
        let key = |block: u32| axes.map(|axis| self.coordinates[block as usize][axis]);
        blocks.sort_unstable_by(|&a, &b| {
            let by_place =
                key(a).iter().zip(&key(b)).map(|(a, b)| a.total_cmp(b)).find(|order| order.is_ne());
            by_place.unwrap_or(a.cmp(&b))
        });
        // blocks of one plane stay together, so that separators of regular meshes are planes too
        let half = blocks.len() / 2;
        let plane = key(blocks[half])[0];
        let first = blocks.partition_point(|&block| key(block)[0] < plane);
        let last = blocks.partition_point(|&block| key(block)[0] <= plane);
        let nearer = if half - first <= last - half { first } else { last };
        let balanced = 4 * nearer >= blocks.len() && 4 * nearer <= 3 * blocks.len();
        if balanced { nearer } else { half }
    }
}

/// By coupling: the near half of the breadth-first order from a block at the rim of the graph.
pub(crate) struct ByCoupling<'a> {
    pattern: &'a Pattern,
    /// Set number in which each block was last put; couplings across sets do not count.
    set: Vec<u32>,
    next_set: u32,
    visited: Vec<u32>,
    next_visit: u32,
    order: Vec<u32>,
}

impl<'a> ByCoupling<'a> {
    pub fn new(pattern: &'a Pattern) -> Self {
        let count = pattern.block_count();
        Self {
            pattern,
            set: vec![0; count],
            next_set: 1,
            visited: vec![0; count],
            next_visit: 1,
            order: Vec::new(),
        }
    }

    /// Breadth-first order of the part of `set` that hangs together with `start`, appended to `order`;
    /// returns the last block reached.
    fn visit(&mut self, start: u32, set: u32, mark: u32) -> u32 {
        let mut queue = VecDeque::from([start]);
        self.visited[start as usize] = mark;
        let mut last = start;
        while let Some(block) = queue.pop_front() {
            self.order.push(block);
            last = block;
            for &other in self.pattern.row(block as usize) {
                if self.set[other as usize] == set && self.visited[other as usize] != mark {
                    self.visited[other as usize] = mark;
                    queue.push_back(other);
                }
            }
        }
        last
    }

    fn mark(&mut self) -> u32 {
        self.next_visit += 1;
        self.next_visit
    }

    /// The blocks ordered by distance from a rim, part after part.
    pub fn sweep(&mut self, blocks: &mut [u32]) {
        self.next_set += 1;
        let set = self.next_set;
        for &block in blocks.iter() {
            self.set[block as usize] = set;
        }
        self.order.clear();
        let done = self.mark();
        for &block in blocks.iter() {
            if self.visited[block as usize] == done {
                continue;
            }
            // two sweeps to and fro end at a pseudo-peripheral block
            let kept = self.order.len();
            let mut rim = block;
            for _ in 0..2 {
                let mark = self.mark();
                rim = self.visit(rim, set, mark);
                self.order.truncate(kept);
            }
            self.visit(rim, set, done);
        }
        blocks.copy_from_slice(&self.order);
    }
}

impl Bisection for ByCoupling<'_> {
    fn split(&mut self, blocks: &mut [u32]) -> usize {
        self.sweep(blocks);
        blocks.len() / 2
    }
}

pub(crate) fn bounds(coordinates: &[Vec3], blocks: &[u32]) -> (Vec3, Vec3) {
    let infinite = Vec3::new(f64::INFINITY, f64::INFINITY, f64::INFINITY);
    blocks.iter().fold((infinite, -infinite), |(low, high), &block| {
        let place = coordinates[block as usize];
        (low.min_components(place), high.max_components(place))
    })
}

/// Parts of at most `largest` blocks each; returns the part of every block and their number.
pub(crate) fn aggregates(
    bisection: &mut impl Bisection,
    block_count: usize,
    largest: usize,
) -> (Vec<u32>, usize) {
    let mut blocks: Vec<u32> = (0..block_count as u32).collect();
    let mut part_of = vec![0; block_count];
    let mut count = 0;
    // sets still to be cut, as (first, last + 1)
    let mut pending = vec![(0, block_count)];
    while let Some((first, end)) = pending.pop() {
        let range = first..end;
        if range.is_empty() {
            continue;
        }
        if range.len() <= largest {
            for &block in &blocks[range] {
                part_of[block as usize] = count;
            }
            count += 1;
            continue;
        }
        let middle = first + bisection.split(&mut blocks[range]);
        pending.push((middle, end));
        pending.push((first, middle));
    }
    (part_of, count as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(n: usize) -> (Vec<Vec3>, Pattern) {
        let place = |i: usize| Vec3::new((i % n) as f64, (i / n % n) as f64, (i / n / n) as f64);
        let coordinates: Vec<Vec3> = (0..n * n * n).map(place).collect();
        let mut pairs = Vec::new();
        for i in 0..coordinates.len() {
            let steps = [1, n, n * n].into_iter().zip(coordinates[i].to_array());
            pairs.extend(
                steps.filter(|(_, at)| *at < (n - 1) as f64).map(|(step, _)| [i as u32, (i + step) as u32]),
            );
        }
        (coordinates, Pattern::from_cliques(n * n * n, pairs.iter().map(|pair| &pair[..])).unwrap())
    }

    /// Every block is in one part, and no part is larger than allowed.
    #[test]
    fn aggregates_cover_all_blocks() {
        let (coordinates, pattern) = grid(7);
        let same_place = vec![Vec3::ZERO; coordinates.len()];
        let results = [
            aggregates(&mut Geometric { coordinates: &coordinates }, coordinates.len(), 20),
            aggregates(&mut Geometric { coordinates: &same_place }, coordinates.len(), 20),
            aggregates(&mut ByCoupling::new(&pattern), coordinates.len(), 20),
        ];
        for (part_of, count) in results {
            let mut sizes = vec![0; count];
            part_of.iter().for_each(|&part| sizes[part as usize] += 1);
            assert!(sizes.iter().all(|&size| (1..=20).contains(&size)));
        }
    }
}
