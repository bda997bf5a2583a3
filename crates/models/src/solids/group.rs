//! A register's worth of elements: their nodes gathered, their sums scattered, their numbers loaded.

use pulp::Simd;
use souple_math::{Lanes, Mat3, Vec3};

use super::layout::{Chunk, LANES, SAMPLE_LEN};
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

    /// Vectors of the elements' nodes, side by side.
    #[inline(always)]
    pub fn gather(&self, values: &[Vec3]) -> [Vec3<Lanes<S>>; N] {
        assert!(values.len() >= self.chunk.rows.len(), "one value for each node of the chunk");
        let mut out = self.zeros();
        for a in 0..self.nodes {
            let locals = self.locals(a);
            // SAFETY: the connectivity of a chunk holds indices below `rows.len()` only (`lay_out`)
            let value = |lane: usize| unsafe { *values.get_unchecked(locals[lane] as usize) };
            // written out so that registers are filled by insertion: through memory, eight narrow stores
            // followed by a wide load would stall
            if S::F64_LANES == 8 {
                let v: [Vec3; 8] =
                    [value(0), value(1), value(2), value(3), value(4), value(5), value(6), value(7)];
                out[a] = Vec3::new(
                    self.lanes_of([v[0].x, v[1].x, v[2].x, v[3].x, v[4].x, v[5].x, v[6].x, v[7].x]),
                    self.lanes_of([v[0].y, v[1].y, v[2].y, v[3].y, v[4].y, v[5].y, v[6].y, v[7].y]),
                    self.lanes_of([v[0].z, v[1].z, v[2].z, v[3].z, v[4].z, v[5].z, v[6].z, v[7].z]),
                );
            } else if S::F64_LANES == 4 {
                let v: [Vec3; 4] = [value(0), value(1), value(2), value(3)];
                out[a] = Vec3::new(
                    self.lanes_of([v[0].x, v[1].x, v[2].x, v[3].x]),
                    self.lanes_of([v[0].y, v[1].y, v[2].y, v[3].y]),
                    self.lanes_of([v[0].z, v[1].z, v[2].z, v[3].z]),
                );
            } else {
                for lane in 0..S::F64_LANES {
                    let v = value(lane);
                    out[a].x.as_mut_slice()[lane] = v.x;
                    out[a].y.as_mut_slice()[lane] = v.y;
                    out[a].z.as_mut_slice()[lane] = v.z;
                }
            }
        }
        out
    }

    #[inline(always)]
    fn lanes_of<const W: usize>(&self, numbers: [f64; W]) -> Lanes<S> {
        Lanes::load(self.simd, &numbers)
    }

    /// `sums[n] += values` of the elements' nodes, element after element; lanes without an element add zero.
    #[inline(always)]
    pub fn scatter(&self, values: &[Vec3<Lanes<S>>; N], sums: &mut [Vec3]) {
        assert!(sums.len() >= self.chunk.rows.len(), "one sum for each node of the chunk");
        for a in 0..self.nodes {
            let locals = self.locals(a);
            for lane in 0..S::F64_LANES {
                // SAFETY: as in `gather`
                let sum = unsafe { sums.get_unchecked_mut(locals[lane] as usize) };
                sum.x += values[a].x.as_slice()[lane];
                sum.y += values[a].y.as_slice()[lane];
                sum.z += values[a].z.as_slice()[lane];
            }
        }
    }

    /// `X_ξ⁻¹` and the volume at a sample.
    #[inline(always)]
    pub fn sample(&self, sample: usize) -> (Mat3<Lanes<S>>, Lanes<S>) {
        let start = (self.block * self.samples + sample) * SAMPLE_LEN * LANES;
        let numbers = &self.chunk.samples()[start..start + SAMPLE_LEN * LANES];
        let mut inverse = Mat3 {
            columns: [Vec3::new(
                Lanes::constant(self.simd, 0.0),
                Lanes::constant(self.simd, 0.0),
                Lanes::constant(self.simd, 0.0),
            ); 3],
        };
        for column in 0..3 {
            let at = 3 * column * LANES + self.lane;
            inverse.columns[column] = Vec3::new(
                Lanes::load(self.simd, &numbers[at..]),
                Lanes::load(self.simd, &numbers[at + LANES..]),
                Lanes::load(self.simd, &numbers[at + 2 * LANES..]),
            );
        }
        (inverse, Lanes::load(self.simd, &numbers[9 * LANES + self.lane..]))
    }

    #[inline(always)]
    pub fn parameters<P: Parameters<Lanes<S>>>(&self) -> P {
        let start = self.block * P::NAMES.len() * LANES + self.lane;
        let (simd, numbers) = (self.simd, &self.chunk.parameters()[start..]);
        P::unpack(|i| Lanes::load(simd, &numbers[i * LANES..]))
    }

    /// Number `i` of the `count` that every element has.
    #[inline(always)]
    pub fn parameter(&self, i: usize, count: usize) -> Lanes<S> {
        Lanes::load(self.simd, &self.chunk.parameters()[(self.block * count + i) * LANES + self.lane..])
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
