//! The loops over elements, one text for every law, element and width of register.
//!
//! At a sample with `X_ξ⁻¹ = (∂X/∂ξ)⁻¹` and volume `V`: `F = x_ξ X_ξ⁻¹`, `H = V P(F) X_ξ⁻ᵀ`, and node `a` feels
//! `-H ∂N_a/∂ξ`.

use std::marker::PhantomData;

use pulp::{Arch, Simd, WithSimd};
use souple_math::{Lanes, Mat3, Vec3};

use super::geometry::Geometry;
use super::layout::{Chunk, LANES, SAMPLE_LEN};
use crate::materials::{Law, Parameters};

/// Most nodes an element has here.
const NODES_MAX: usize = 8;
/// Numbers of a symmetric set of 3×3 blocks of one element, `a ≤ b`, for a block of lanes.
pub const BLOCK_LEN_MAX: usize = NODES_MAX * (NODES_MAX + 1) / 2 * 9 * LANES;

/// The loops for one law on one element, behind a pointer so that a body may mix both.
pub trait Kernel: Send + Sync {
    /// `forces[n] += f_n` over the chunk's nodes.
    fn forces(&self, chunk: &Chunk, reference: &[Vec3], positions: &[Vec3], forces: &mut [Vec3]);
    /// `forces[n] += scale · (∂f/∂x δ)_n` over the chunk's nodes.
    fn differential(
        &self,
        chunk: &Chunk,
        reference: &[Vec3],
        positions: &[Vec3],
        delta: &[Vec3],
        scale: f64,
        forces: &mut [Vec3],
    );
    /// Stored energy of the chunk [J].
    fn energy(&self, chunk: &Chunk, reference: &[Vec3], positions: &[Vec3]) -> f64;
    /// `scale · ∂f_a/∂x_b` of the elements of one block, `[(a, b) with a ≤ b][entry by columns][lane]`.
    fn blocks(
        &self,
        chunk: &Chunk,
        block: usize,
        reference: &[Vec3],
        positions: &[Vec3],
        scale: f64,
        out: &mut [f64],
    );
}

/// [`Kernel`] of law `L` on elements of geometry `G` with `N` nodes.
///
/// No closures over lanes here: what is not inlined is not compiled for the processor's instructions.
pub struct LawKernel<L, G, const N: usize>(PhantomData<(L, G)>);

impl<L, G, const N: usize> Default for LawKernel<L, G, N> {
    fn default() -> Self {
        Self(PhantomData)
    }
}

impl<L: Law, G: Geometry, const N: usize> Kernel for LawKernel<L, G, N> {
    fn forces(&self, chunk: &Chunk, reference: &[Vec3], positions: &[Vec3], forces: &mut [Vec3]) {
        Arch::new().dispatch(Forces::<L, G, N> { chunk, reference, positions, forces, kernel: PhantomData });
    }

    fn differential(
        &self,
        chunk: &Chunk,
        reference: &[Vec3],
        positions: &[Vec3],
        delta: &[Vec3],
        scale: f64,
        forces: &mut [Vec3],
    ) {
        let kernel = PhantomData;
        Arch::new().dispatch(Differential::<L, G, N> {
            chunk,
            reference,
            positions,
            delta,
            scale,
            forces,
            kernel,
        });
    }

    fn energy(&self, chunk: &Chunk, reference: &[Vec3], positions: &[Vec3]) -> f64 {
        Arch::new().dispatch(Energy::<L, G, N> { chunk, reference, positions, kernel: PhantomData })
    }

    fn blocks(
        &self,
        chunk: &Chunk,
        block: usize,
        reference: &[Vec3],
        positions: &[Vec3],
        scale: f64,
        out: &mut [f64],
    ) {
        let kernel = PhantomData;
        Arch::new().dispatch(Blocks::<L, G, N> { chunk, block, reference, positions, scale, out, kernel });
    }
}

/// One register's worth of elements of `N` nodes: lanes `lane .. lane + S::F64_LANES` of a block.
pub(super) struct Group<'a, S: Simd, const N: usize> {
    pub simd: S,
    pub chunk: &'a Chunk,
    pub samples: usize,
    pub block: usize,
    pub lane: usize,
}

impl<'a, S: Simd, const N: usize> Group<'a, S, N> {
    /// Chunk nodes of node `a` of the elements.
    #[inline(always)]
    fn locals(&self, a: usize) -> &'a [u16] {
        let at = (self.block * N + a) * LANES + self.lane;
        &self.chunk.connectivity[at..at + S::F64_LANES]
    }

    /// Vectors of the elements' nodes, side by side.
    #[inline(always)]
    pub fn gather(&self, values: &[Vec3]) -> [Vec3<Lanes<S>>; N] {
        assert!(values.len() >= self.chunk.rows.len(), "one value for each node of the chunk");
        let mut out = self.zeros();
        for a in 0..N {
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
        for a in 0..N {
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

    #[inline(always)]
    pub fn zeros(&self) -> [Vec3<Lanes<S>>; N] {
        let zero = Lanes::constant(self.simd, 0.0);
        [Vec3::new(zero, zero, zero); N]
    }
}

/// Runs `$body` for every group of the blocks `$blocks` of a chunk, in element order.
macro_rules! for_each_group {
    ($simd:ident, $chunk:expr, $samples:expr, $blocks:expr, $N:ident, |$group:ident| $body:block) => {
        for block in $blocks {
            let mut lane = 0;
            while lane < LANES {
                let $group = Group::<_, $N> { simd: $simd, chunk: $chunk, samples: $samples, block, lane };
                $body
                lane += S::F64_LANES;
            }
        }
    };
}

struct Forces<'a, L, G, const N: usize> {
    chunk: &'a Chunk,
    reference: &'a [Vec3],
    positions: &'a [Vec3],
    forces: &'a mut [Vec3],
    kernel: PhantomData<(L, G)>,
}

impl<L: Law, G: Geometry, const N: usize> WithSimd for Forces<'_, L, G, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let samples = G::SAMPLES.unwrap_or(self.reference.len() / N);
        for_each_group!(simd, self.chunk, samples, 0..self.chunk.block_count(), N, |group| {
            let x = group.gather(self.positions);
            let mut f = group.zeros();
            let parameters = group.parameters::<L::Parameters<Lanes<S>>>();
            for sample in 0..samples {
                let reference = &self.reference[sample * N..(sample + 1) * N];
                let (inverse, volume) = group.sample(sample);
                let F = G::gradient(&x, reference) * inverse;
                let P = L::stress(&parameters, &F);
                // H = V P X_ξ⁻ᵀ
                G::spread(&P.mul_transpose(&inverse).scaled(volume), reference, &mut f);
            }
            group.scatter(&f, self.forces);
        });
    }
}

struct Differential<'a, L, G, const N: usize> {
    chunk: &'a Chunk,
    reference: &'a [Vec3],
    positions: &'a [Vec3],
    delta: &'a [Vec3],
    scale: f64,
    forces: &'a mut [Vec3],
    kernel: PhantomData<(L, G)>,
}

impl<L: Law, G: Geometry, const N: usize> WithSimd for Differential<'_, L, G, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let samples = G::SAMPLES.unwrap_or(self.reference.len() / N);
        for_each_group!(simd, self.chunk, samples, 0..self.chunk.block_count(), N, |group| {
            let (x, dx) = (group.gather(self.positions), group.gather(self.delta));
            let mut df = group.zeros();
            let parameters = group.parameters::<L::Parameters<Lanes<S>>>();
            for sample in 0..samples {
                let reference = &self.reference[sample * N..(sample + 1) * N];
                let (inverse, volume) = group.sample(sample);
                let F = G::gradient(&x, reference) * inverse;
                let dF = G::gradient(&dx, reference) * inverse;
                let dP = L::stress_differential(&parameters, &L::at(&parameters, &F), &dF);
                G::spread(&dP.mul_transpose(&inverse).scaled(volume * self.scale), reference, &mut df);
            }
            group.scatter(&df, self.forces);
        });
    }
}

struct Energy<'a, L, G, const N: usize> {
    chunk: &'a Chunk,
    reference: &'a [Vec3],
    positions: &'a [Vec3],
    kernel: PhantomData<(L, G)>,
}

impl<L: Law, G: Geometry, const N: usize> WithSimd for Energy<'_, L, G, N> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let samples = G::SAMPLES.unwrap_or(self.reference.len() / N);
        let mut sum = 0.0;
        for_each_group!(simd, self.chunk, samples, 0..self.chunk.block_count(), N, |group| {
            let x = group.gather(self.positions);
            let parameters = group.parameters::<L::Parameters<Lanes<S>>>();
            for sample in 0..samples {
                let reference = &self.reference[sample * N..(sample + 1) * N];
                let (inverse, volume) = group.sample(sample);
                let F = G::gradient(&x, reference) * inverse;
                let mut energies = [0.0; LANES];
                (L::energy_density(&parameters, &F) * volume).store(&mut energies);
                sum += energies[..S::F64_LANES].iter().sum::<f64>();
            }
        });
        sum
    }
}

struct Blocks<'a, L, G, const N: usize> {
    chunk: &'a Chunk,
    block: usize,
    reference: &'a [Vec3],
    positions: &'a [Vec3],
    scale: f64,
    out: &'a mut [f64],
    kernel: PhantomData<(L, G)>,
}

impl<L: Law, G: Geometry, const N: usize> WithSimd for Blocks<'_, L, G, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let samples = G::SAMPLES.unwrap_or(self.reference.len() / N);
        for_each_group!(simd, self.chunk, samples, self.block..self.block + 1, N, |group| {
            let x = group.gather(self.positions);
            let parameters = group.parameters::<L::Parameters<Lanes<S>>>();
            for sample in 0..samples {
                let reference = &self.reference[sample * N..(sample + 1) * N];
                let (inverse, volume) = group.sample(sample);
                let F = G::gradient(&x, reference) * inverse;
                let point = L::at(&parameters, &F);
                let weight = volume * -self.scale;
                let mut gradients = group.zeros();
                for a in 0..N {
                    // ∂N_a/∂X = X_ξ⁻ᵀ ∂N_a/∂ξ
                    let g = reference[a];
                    let (x, y, z) =
                        (Lanes::constant(simd, g.x), Lanes::constant(simd, g.y), Lanes::constant(simd, g.z));
                    gradients[a] = inverse.transpose_apply(Vec3::new(x, y, z));
                }
                let mut pair = 0;
                for a in 0..N {
                    let weighted = gradients[a] * weight;
                    for b in a..N {
                        let K = L::tangent_block(&parameters, &point, weighted, gradients[b]);
                        for i in 0..9 {
                            let number = K.columns[i / 3].to_array()[i % 3];
                            let at = (pair * 9 + i) * LANES + group.lane;
                            let slot = &mut self.out[at..at + S::F64_LANES];
                            let sum = if sample == 0 { number } else { Lanes::load(simd, slot) + number };
                            sum.store(slot);
                        }
                        pair += 1;
                    }
                }
            }
        });
    }
}
