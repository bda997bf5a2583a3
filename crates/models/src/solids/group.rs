//! A register's worth of elements: their nodes gathered, their sums scattered, their numbers loaded.

use std::mem::MaybeUninit;

use pulp::Simd;
use souple_math::{Lanes, Mat3, Padded, Vec3};

use super::layout::{Chunk, LANES, LaneBlock};
use crate::materials::Parameters;

/// One register's worth of elements of at most `N` nodes: lanes `lane .. lane + S::F64_LANES` of a block.
pub struct Group<'a, S: Simd, const N: usize> {
    pub simd: S,
    pub chunk: &'a Chunk,
    /// Nodes of an element; arrays have room for `N`.
    pub nodes: usize,
    pub samples: usize,
    pub block: usize,
    pub lane: usize,
}

impl<'a, S: Simd, const N: usize> Group<'a, S, N> {
    /// Chunk nodes of node `a` of the elements.
    #[inline(always)]
    fn locals(&self, a: usize) -> &'a [u16] {
        let at = (self.block * self.nodes + a) * LANES + self.lane;
        &self.chunk.connectivity[at..at + S::F64_LANES]
    }

    /// Vectors of the elements' nodes, side by side; zero where an element has none.
    #[inline(always)]
    pub fn gather(&self, values: &[Padded]) -> [Vec3<Lanes<S>>; N] {
        // not zeros first: these would be written to memory for nothing
        let mut out = [const { MaybeUninit::<Vec3<Lanes<S>>>::uninit() }; N];
        for a in 0..self.nodes.min(N) {
            out[a].write(self.gather_node(values, a));
        }
        let zero = Lanes::constant(self.simd, 0.0);
        for a in self.nodes..N {
            out[a].write(Vec3::new(zero, zero, zero));
        }
        // SAFETY: each of the N is written, and an array of what may be uninitialised is laid out as one of what is not
        unsafe { std::mem::transmute_copy(&out) }
    }

    /// Vectors of the elements' node `a`.
    #[inline(always)]
    pub fn gather_node(&self, values: &[Padded], a: usize) -> Vec3<Lanes<S>> {
        assert!(values.len() >= self.chunk.rows.len(), "one value for each node of the chunk");
        // SAFETY: the connectivity of a chunk holds indices below `rows.len()` only (`lay_out`)
        unsafe { Vec3::gather(self.simd, values, self.locals(a)) }
    }

    /// `sums[n] += values` of the elements' nodes, element after element; lanes without an element add zero.
    #[inline(always)]
    pub fn scatter(&self, values: &[Vec3<Lanes<S>>; N], sums: &mut [Padded]) {
        for a in 0..self.nodes {
            self.scatter_node(a, values[a], sums);
        }
    }

    /// The same of node `a` alone.
    #[inline(always)]
    pub fn scatter_node(&self, a: usize, value: Vec3<Lanes<S>>, sums: &mut [Padded]) {
        assert!(sums.len() >= self.chunk.rows.len(), "one sum for each node of the chunk");
        // SAFETY: as in `gather_node`
        unsafe { value.scatter_add(self.simd, sums, self.locals(a)) };
    }

    /// The group's lanes of a block of lanes.
    #[inline(always)]
    pub fn load(&self, block: &LaneBlock) -> Lanes<S> {
        // lanes divide a block: said so that the load needs no check
        assert!(self.lane + S::F64_LANES <= LANES);
        Lanes::load(self.simd, &block.0[self.lane..self.lane + S::F64_LANES])
    }

    /// Asks for a sample of the block `ahead` of this one, once for all groups of a block.
    #[inline(always)]
    pub fn prefetch(&self, ahead: usize, sample: usize) {
        if self.lane == 0 {
            self.chunk.prefetch(self.block + ahead, sample, self.samples);
        }
    }

    /// `X_ξ⁻¹` and the volume at a sample.
    #[inline(always)]
    pub fn sample(&self, sample: usize) -> (Mat3<Lanes<S>>, Lanes<S>) {
        let numbers = self.chunk.sample(self.block, sample, self.samples);
        let mut inverse = Mat3::zero(Lanes::constant(self.simd, 0.0));
        for column in 0..3 {
            inverse.columns[column] = Vec3::new(
                self.load(&numbers[3 * column]),
                self.load(&numbers[3 * column + 1]),
                self.load(&numbers[3 * column + 2]),
            );
        }
        (inverse, self.load(&numbers[9]))
    }

    #[inline(always)]
    pub fn parameters<P: Parameters<Lanes<S>>>(&self) -> P {
        let numbers = self.chunk.parameters(self.block, P::NAMES.len());
        P::unpack(|i| self.load(&numbers[i]))
    }

    /// Number `i` of the `count` that every element has.
    #[inline(always)]
    pub fn parameter(&self, i: usize, count: usize) -> Lanes<S> {
        self.load(&self.chunk.parameters(self.block, count)[i])
    }

    /// `∂N_a/∂X = X_ξ⁻ᵀ ∂N_a/∂ξ` of every node.
    #[inline(always)]
    pub fn gradients(&self, inverse: &Mat3<Lanes<S>>, reference: &[Vec3]) -> [Vec3<Lanes<S>>; N] {
        let mut out = self.zeros();
        for a in 0..self.nodes {
            let g = reference[a];
            out[a] = inverse.transpose_apply(Vec3::new(
                Lanes::constant(self.simd, g.x),
                Lanes::constant(self.simd, g.y),
                Lanes::constant(self.simd, g.z),
            ));
        }
        out
    }

    /// The lanes' sum, in their order.
    #[inline(always)]
    pub fn sum(&self, numbers: Lanes<S>) -> f64 {
        let mut lanes = [0.0; LANES];
        numbers.store(&mut lanes);
        let mut sum = 0.0;
        for lane in &lanes[..S::F64_LANES] {
            sum += lane;
        }
        sum
    }

    /// The group's lanes of `out`, a block of lanes: overwritten at the first sample, added to at later ones.
    #[inline(always)]
    pub fn add_or_put(&self, sample: usize, number: Lanes<S>, out: &mut [f64]) {
        let slot = &mut out[self.lane..self.lane + S::F64_LANES];
        let sum = if sample == 0 { number } else { Lanes::load(self.simd, slot) + number };
        sum.store(slot);
    }

    #[inline(always)]
    pub fn zeros(&self) -> [Vec3<Lanes<S>>; N] {
        let zero = Lanes::constant(self.simd, 0.0);
        [Vec3::new(zero, zero, zero); N]
    }
}

/// Runs `$body` for every [`Group`] of the blocks `$blocks` of a chunk, in element order.
macro_rules! for_each_group {
    ($simd:ident, $chunk:expr, $nodes:expr, $samples:expr, $blocks:expr, $N:expr, |$group:ident| $body:block) => {
        for block in $blocks {
            let mut lane = 0;
            while lane < LANES {
                let (simd, chunk, nodes, samples) = ($simd, $chunk, $nodes, $samples);
                let $group = Group::<_, { $N }> { simd, chunk, nodes, samples, block, lane };
                $body
                lane += S::F64_LANES;
            }
        }
    };
}

pub(super) use for_each_group;
