//! The loops over elements with a law compiled in: what the linear tetrahedron runs, one text for every law and width of
//! register. Other elements, and laws as text, run in stages: [`super::staged`].
//!
//! At a sample with `X_ξ⁻¹ = (∂X/∂ξ)⁻¹` and volume `V`: `F = x_ξ X_ξ⁻¹`, `H = V P(F) X_ξ⁻ᵀ`, and node `a` feels
//! `-H ∂N_a/∂ξ`.

use std::marker::PhantomData;
use std::ops::Range;

use pulp::{Arch, Simd, WithSimd};
use souple_math::{Lanes, Padded, Vec3};

use super::geometry::Geometry;
use super::group::{Group, for_each_group};
use super::layout::{Chunk, LANES};
use crate::materials::Law;

/// Blocks between the one that is computed and the one that is asked for from memory: two take about as long as that
/// takes to answer.
const AHEAD: usize = 2;

/// The loops for one law on one element, behind a pointer so that a body may mix both.
pub trait Kernel: Send + Sync {
    /// `forces[n] += f_n` over the chunk's nodes.
    fn forces(&self, chunk: &Chunk, reference: &[Vec3], positions: &[Padded], forces: &mut [Padded]);
    /// `forces[n] += scale · (∂f/∂x δ)_n` over the chunk's nodes.
    fn differential(
        &self,
        chunk: &Chunk,
        reference: &[Vec3],
        positions: &[Padded],
        delta: &[Padded],
        scale: f64,
        forces: &mut [Padded],
    );
    /// Stored energy of the chunk [J].
    fn energy(&self, chunk: &Chunk, reference: &[Vec3], positions: &[Padded]) -> f64;
    /// `δᵀ K δ` of the chunk with `K = -∂f/∂x` [J for a displacement of m].
    fn quadratic_form(
        &self,
        chunk: &Chunk,
        reference: &[Vec3],
        positions: &[Padded],
        delta: &[Padded],
    ) -> f64;
    /// How many blocks of lanes [`Self::blocks`] likes to be asked for at once.
    fn blocks_at_once(&self) -> usize {
        1
    }
    /// `scale · ∂f_a/∂x_b` of the elements of some blocks, `[block][(a, b) with a ≤ b][entry by columns][lane]`.
    fn blocks(
        &self,
        chunk: &Chunk,
        blocks: Range<usize>,
        reference: &[Vec3],
        positions: &[Padded],
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
    fn forces(&self, chunk: &Chunk, reference: &[Vec3], positions: &[Padded], forces: &mut [Padded]) {
        Arch::new().dispatch(Forces::<L, G, N> { chunk, reference, positions, forces, kernel: PhantomData });
    }

    fn differential(
        &self,
        chunk: &Chunk,
        reference: &[Vec3],
        positions: &[Padded],
        delta: &[Padded],
        scale: f64,
        forces: &mut [Padded],
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

    fn energy(&self, chunk: &Chunk, reference: &[Vec3], positions: &[Padded]) -> f64 {
        Arch::new().dispatch(Energy::<L, G, N> { chunk, reference, positions, kernel: PhantomData })
    }

    fn quadratic_form(
        &self,
        chunk: &Chunk,
        reference: &[Vec3],
        positions: &[Padded],
        delta: &[Padded],
    ) -> f64 {
        let kernel = PhantomData;
        Arch::new().dispatch(QuadraticForm::<L, G, N> { chunk, reference, positions, delta, kernel })
    }

    fn blocks(
        &self,
        chunk: &Chunk,
        blocks: Range<usize>,
        reference: &[Vec3],
        positions: &[Padded],
        scale: f64,
        out: &mut [f64],
    ) {
        let kernel = PhantomData;
        for (block, out) in blocks.zip(out.chunks_exact_mut(N * (N + 1) / 2 * 9 * LANES)) {
            Arch::new().dispatch(Blocks::<L, G, N> {
                chunk,
                block,
                reference,
                positions,
                scale,
                out,
                kernel,
            });
        }
    }
}

struct Forces<'a, L, G, const N: usize> {
    chunk: &'a Chunk,
    reference: &'a [Vec3],
    positions: &'a [Padded],
    forces: &'a mut [Padded],
    kernel: PhantomData<(L, G)>,
}

impl<L: Law, G: Geometry, const N: usize> WithSimd for Forces<'_, L, G, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let samples = G::SAMPLES.unwrap_or(self.reference.len() / N);
        for_each_group!(simd, self.chunk, N, samples, 0..self.chunk.block_count(), N, |group| {
            let x = group.gather(self.positions);
            let mut f = group.zeros();
            let parameters = group.parameters::<L::Parameters<Lanes<S>>>();
            for sample in 0..samples {
                group.prefetch(AHEAD, sample);
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
    positions: &'a [Padded],
    delta: &'a [Padded],
    scale: f64,
    forces: &'a mut [Padded],
    kernel: PhantomData<(L, G)>,
}

impl<L: Law, G: Geometry, const N: usize> WithSimd for Differential<'_, L, G, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let samples = G::SAMPLES.unwrap_or(self.reference.len() / N);
        for_each_group!(simd, self.chunk, N, samples, 0..self.chunk.block_count(), N, |group| {
            let (x, dx) = (group.gather(self.positions), group.gather(self.delta));
            let mut df = group.zeros();
            let parameters = group.parameters::<L::Parameters<Lanes<S>>>();
            for sample in 0..samples {
                group.prefetch(AHEAD, sample);
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
    positions: &'a [Padded],
    kernel: PhantomData<(L, G)>,
}

impl<L: Law, G: Geometry, const N: usize> WithSimd for Energy<'_, L, G, N> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let samples = G::SAMPLES.unwrap_or(self.reference.len() / N);
        let mut sum = 0.0;
        for_each_group!(simd, self.chunk, N, samples, 0..self.chunk.block_count(), N, |group| {
            let x = group.gather(self.positions);
            let parameters = group.parameters::<L::Parameters<Lanes<S>>>();
            for sample in 0..samples {
                let reference = &self.reference[sample * N..(sample + 1) * N];
                let (inverse, volume) = group.sample(sample);
                let F = G::gradient(&x, reference) * inverse;
                sum += group.sum(L::energy_density(&parameters, &F) * volume);
            }
        });
        sum
    }
}

struct QuadraticForm<'a, L, G, const N: usize> {
    chunk: &'a Chunk,
    reference: &'a [Vec3],
    positions: &'a [Padded],
    delta: &'a [Padded],
    kernel: PhantomData<(L, G)>,
}

impl<L: Law, G: Geometry, const N: usize> WithSimd for QuadraticForm<'_, L, G, N> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let samples = G::SAMPLES.unwrap_or(self.reference.len() / N);
        let mut sum = 0.0;
        for_each_group!(simd, self.chunk, N, samples, 0..self.chunk.block_count(), N, |group| {
            let (x, dx) = (group.gather(self.positions), group.gather(self.delta));
            let parameters = group.parameters::<L::Parameters<Lanes<S>>>();
            for sample in 0..samples {
                let reference = &self.reference[sample * N..(sample + 1) * N];
                let (inverse, volume) = group.sample(sample);
                let F = G::gradient(&x, reference) * inverse;
                let dF = G::gradient(&dx, reference) * inverse;
                let dP = L::stress_differential(&parameters, &L::at(&parameters, &F), &dF);
                sum += group.sum(dP.dot(&dF) * volume);
            }
        });
        sum
    }
}

struct Blocks<'a, L, G, const N: usize> {
    chunk: &'a Chunk,
    block: usize,
    reference: &'a [Vec3],
    positions: &'a [Padded],
    scale: f64,
    out: &'a mut [f64],
    kernel: PhantomData<(L, G)>,
}

impl<L: Law, G: Geometry, const N: usize> WithSimd for Blocks<'_, L, G, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let samples = G::SAMPLES.unwrap_or(self.reference.len() / N);
        for_each_group!(simd, self.chunk, N, samples, self.block..self.block + 1, N, |group| {
            let x = group.gather(self.positions);
            let parameters = group.parameters::<L::Parameters<Lanes<S>>>();
            for sample in 0..samples {
                let reference = &self.reference[sample * N..(sample + 1) * N];
                let (inverse, volume) = group.sample(sample);
                let F = G::gradient(&x, reference) * inverse;
                let point = L::at(&parameters, &F);
                let weight = volume * -self.scale;
                let gradients = group.gradients(&inverse, reference);
                let mut pair = 0;
                for a in 0..N {
                    let weighted = gradients[a] * weight;
                    for b in a..N {
                        let K = L::tangent_block(&parameters, &point, weighted, gradients[b]);
                        for i in 0..9 {
                            let number = K.columns[i / 3].to_array()[i % 3];
                            let at = (pair * 9 + i) * LANES;
                            group.add_or_put(sample, number, &mut self.out[at..at + LANES]);
                        }
                        pair += 1;
                    }
                }
            }
        });
    }
}
