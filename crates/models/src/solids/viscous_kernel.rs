//! The loops of [`super::Viscosity`] over elements, one text for every element and width of register.
//!
//! At a sample of volume `V`: `F = x_ξ X_ξ⁻¹`, `Ḟ = ẋ_ξ X_ξ⁻¹`, `S = 2 η sym(Fᵀ Ḟ)`, `H = V F S X_ξ⁻ᵀ`, and node `a`
//! feels `-H ∂N_a/∂ξ`.

use std::marker::PhantomData;
use std::ops::Range;

use pulp::{Arch, Simd, WithSimd};
use souple_engine::TangentWeights;
use souple_math::{Mat3, Padded, Real, Vec3};

use super::assembly::Symmetry;
use super::geometry::Geometry;
use super::group::{Group, for_each_group};
use super::layout::{Chunk, LANES};

/// A chunk in motion.
#[derive(Clone, Copy)]
pub struct Flow<'a> {
    pub chunk: &'a Chunk,
    /// `∂N_a/∂ξ`, sample after sample.
    pub reference: &'a [Vec3],
    /// Of the chunk's own nodes.
    pub positions: &'a [Padded],
    pub velocities: &'a [Padded],
}

/// The loops on one element, behind a pointer so that a body may mix them.
pub trait ViscousKernel: Send + Sync {
    /// `forces[n] += f_n` over the chunk's nodes.
    fn forces(&self, flow: Flow, forces: &mut [Padded]);
    /// `forces[n] += (a ∂f/∂x δ + b ∂f/∂v δ)_n` over the chunk's nodes.
    fn differential(&self, flow: Flow, delta: &[Padded], weights: TangentWeights, forces: &mut [Padded]);
    /// `∫ 2 η Ė:Ė dV` of the chunk [W].
    fn power(&self, flow: Flow) -> f64;
    /// `a ∂f_i/∂x_j + b ∂f_i/∂v_j`, or the symmetric part of it, of the elements of some blocks of lanes,
    /// `[block][(i, j)][entry by columns][lane]`.
    fn blocks(
        &self,
        flow: Flow,
        blocks: Range<usize>,
        weights: TangentWeights,
        symmetry: Symmetry,
        out: &mut [f64],
    );
}

/// [`ViscousKernel`] on elements of geometry `G` with at most `N` nodes.
pub struct StrainRate<G, const N: usize> {
    /// Nodes of an element.
    nodes: usize,
    geometry: PhantomData<G>,
}

impl<G, const N: usize> StrainRate<G, N> {
    pub fn new(nodes: usize) -> Self {
        Self { nodes, geometry: PhantomData }
    }
}

impl<G: Geometry, const N: usize> ViscousKernel for StrainRate<G, N> {
    fn forces(&self, flow: Flow, forces: &mut [Padded]) {
        Arch::new().dispatch(Forces::<G, N> { flow, forces, nodes: self.nodes, geometry: PhantomData });
    }

    fn differential(&self, flow: Flow, delta: &[Padded], weights: TangentWeights, forces: &mut [Padded]) {
        Arch::new().dispatch(Differential::<G, N> {
            flow,
            delta,
            weights,
            forces,
            nodes: self.nodes,
            geometry: PhantomData,
        });
    }

    fn power(&self, flow: Flow) -> f64 {
        Arch::new().dispatch(Power::<G, N> { flow, nodes: self.nodes, geometry: PhantomData })
    }

    fn blocks(
        &self,
        flow: Flow,
        blocks: Range<usize>,
        weights: TangentWeights,
        symmetry: Symmetry,
        out: &mut [f64],
    ) {
        let block_len = symmetry.pair_count(self.nodes) * 9 * LANES;
        for (block, out) in blocks.zip(out.chunks_exact_mut(block_len)) {
            Arch::new().dispatch(Blocks::<G, N> {
                flow,
                block,
                weights,
                symmetry,
                out,
                nodes: self.nodes,
                geometry: PhantomData,
            });
        }
    }
}

/// `2 η sym(Fᵀ Ḟ)`.
#[inline(always)]
fn stress<R: Real>(modulus: R, F: &Mat3<R>, rate: &Mat3<R>) -> Mat3<R> {
    F.transpose_mul(rate).symmetric_part().scaled(modulus)
}

/// `a (δF S + F 2η sym(δFᵀ Ḟ)) + b F 2η sym(Fᵀ δF)` with `S = 2 η sym(Fᵀ Ḟ)`.
#[inline(always)]
fn stress_differential<R: Real>(
    modulus: R,
    [F, rate, S]: [&Mat3<R>; 3],
    d: &Mat3<R>,
    weights: TangentWeights,
) -> Mat3<R> {
    let by_position = *d * *S + *F * stress(modulus, d, rate);
    let by_velocity = *F * stress(modulus, F, d);
    by_position.scaled(modulus.splat(weights.position)) + by_velocity.scaled(modulus.splat(weights.velocity))
}

/// The symmetric part of [`stress_differential`], as a form over `δF` and a trial gradient: of `F 2η sym(δFᵀ Ḟ)` that is
/// `(F 2η sym(δFᵀ Ḟ) + Ḟ 2η sym(Fᵀ δF))/2`, the rest is symmetric as it is.
#[inline(always)]
fn symmetric_differential<R: Real>(
    modulus: R,
    [F, rate, S]: [&Mat3<R>; 3],
    d: &Mat3<R>,
    weights: TangentWeights,
) -> Mat3<R> {
    let strain = stress(modulus, F, d);
    let turning = (*F * stress(modulus, d, rate) + *rate * strain).scaled(modulus.splat(0.5));
    (*d * *S + turning).scaled(modulus.splat(weights.position))
        + (*F * strain).scaled(modulus.splat(weights.velocity))
}

struct Forces<'a, G, const N: usize> {
    flow: Flow<'a>,
    forces: &'a mut [Padded],
    nodes: usize,
    geometry: PhantomData<G>,
}

impl<G: Geometry, const N: usize> WithSimd for Forces<'_, G, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Flow { chunk, reference, positions, velocities } = self.flow;
        let nodes = G::NODES.unwrap_or(self.nodes);
        let samples = G::SAMPLES.unwrap_or(reference.len() / nodes);
        for_each_group!(simd, chunk, nodes, samples, 0..chunk.block_count(), N, |group| {
            let (x, v) = (group.gather(positions), group.gather(velocities));
            let modulus = group.parameter(0, 1);
            let mut f = group.zeros();
            for sample in 0..samples {
                let reference = &reference[sample * nodes..(sample + 1) * nodes];
                let (inverse, volume) = group.sample(sample);
                let F = G::gradient(&x, reference) * inverse;
                let rate = G::gradient(&v, reference) * inverse;
                let P = F * stress(modulus, &F, &rate);
                // H = V P X_ξ⁻ᵀ
                G::spread(&P.mul_transpose(&inverse).scaled(volume), reference, &mut f);
            }
            group.scatter(&f, self.forces);
        });
    }
}

struct Differential<'a, G, const N: usize> {
    flow: Flow<'a>,
    delta: &'a [Padded],
    weights: TangentWeights,
    forces: &'a mut [Padded],
    nodes: usize,
    geometry: PhantomData<G>,
}

impl<G: Geometry, const N: usize> WithSimd for Differential<'_, G, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Flow { chunk, reference, positions, velocities } = self.flow;
        let nodes = G::NODES.unwrap_or(self.nodes);
        let samples = G::SAMPLES.unwrap_or(reference.len() / nodes);
        for_each_group!(simd, chunk, nodes, samples, 0..chunk.block_count(), N, |group| {
            let (x, v) = (group.gather(positions), group.gather(velocities));
            let delta = group.gather(self.delta);
            let modulus = group.parameter(0, 1);
            let mut df = group.zeros();
            for sample in 0..samples {
                let reference = &reference[sample * nodes..(sample + 1) * nodes];
                let (inverse, volume) = group.sample(sample);
                let F = G::gradient(&x, reference) * inverse;
                let rate = G::gradient(&v, reference) * inverse;
                let d = G::gradient(&delta, reference) * inverse;
                let S = stress(modulus, &F, &rate);
                let dP = stress_differential(modulus, [&F, &rate, &S], &d, self.weights);
                G::spread(&dP.mul_transpose(&inverse).scaled(volume), reference, &mut df);
            }
            group.scatter(&df, self.forces);
        });
    }
}

struct Power<'a, G, const N: usize> {
    flow: Flow<'a>,
    nodes: usize,
    geometry: PhantomData<G>,
}

impl<G: Geometry, const N: usize> WithSimd for Power<'_, G, N> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let Flow { chunk, reference, positions, velocities } = self.flow;
        let nodes = G::NODES.unwrap_or(self.nodes);
        let samples = G::SAMPLES.unwrap_or(reference.len() / nodes);
        let mut sum = 0.0;
        for_each_group!(simd, chunk, nodes, samples, 0..chunk.block_count(), N, |group| {
            let (x, v) = (group.gather(positions), group.gather(velocities));
            let modulus = group.parameter(0, 1);
            for sample in 0..samples {
                let reference = &reference[sample * nodes..(sample + 1) * nodes];
                let (inverse, volume) = group.sample(sample);
                let F = G::gradient(&x, reference) * inverse;
                let rate = G::gradient(&v, reference) * inverse;
                let strain_rate = F.transpose_mul(&rate).symmetric_part();
                sum += group.sum(strain_rate.dot(&strain_rate) * modulus * volume);
            }
        });
        sum
    }
}

struct Blocks<'a, G, const N: usize> {
    flow: Flow<'a>,
    block: usize,
    weights: TangentWeights,
    symmetry: Symmetry,
    out: &'a mut [f64],
    nodes: usize,
    geometry: PhantomData<G>,
}

impl<G: Geometry, const N: usize> WithSimd for Blocks<'_, G, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Flow { chunk, reference, positions, velocities } = self.flow;
        let nodes = G::NODES.unwrap_or(self.nodes);
        let samples = G::SAMPLES.unwrap_or(reference.len() / nodes);
        for_each_group!(simd, chunk, nodes, samples, self.block..self.block + 1, N, |group| {
            let (x, v) = (group.gather(positions), group.gather(velocities));
            let modulus = group.parameter(0, 1);
            let axes = Mat3::identity(modulus).columns;
            for sample in 0..samples {
                let reference = &reference[sample * nodes..(sample + 1) * nodes];
                let (inverse, volume) = group.sample(sample);
                let F = G::gradient(&x, reference) * inverse;
                let rate = G::gradient(&v, reference) * inverse;
                let stress = stress(modulus, &F, &rate);
                let gradients = group.gradients(&inverse, reference);
                for b in 0..nodes {
                    for k in 0..3 {
                        // the force on a, -V dP g_a, for a unit displacement of b along axis k
                        let d = axes[k].outer(gradients[b]);
                        let at_hand = [&F, &rate, &stress];
                        let dP = match self.symmetry {
                            Symmetry::General => stress_differential(modulus, at_hand, &d, self.weights),
                            Symmetry::Symmetric => symmetric_differential(modulus, at_hand, &d, self.weights),
                        };
                        let dP = dP.scaled(-volume);
                        for a in 0..nodes {
                            let Some(place) = self.symmetry.place(nodes, a, b) else { break };
                            let column = (dP * gradients[a]).to_array();
                            for i in 0..3 {
                                let at = (place * 9 + 3 * k + i) * LANES;
                                group.add_or_put(sample, column[i], &mut self.out[at..at + LANES]);
                            }
                        }
                    }
                }
            }
        });
    }
}
