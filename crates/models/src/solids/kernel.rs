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
pub const NODES_MAX: usize = 8;
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

/// [`Kernel`] of law `L` on elements of geometry `G`.
pub struct LawKernel<L, G>(PhantomData<(L, G)>);

impl<L, G> Default for LawKernel<L, G> {
    fn default() -> Self {
        Self(PhantomData)
    }
}

impl<L: Law, G: Geometry> Kernel for LawKernel<L, G> {
    fn forces(&self, chunk: &Chunk, reference: &[Vec3], positions: &[Vec3], forces: &mut [Vec3]) {
        Arch::new().dispatch(Forces::<L, G> { chunk, reference, positions, forces, kernel: PhantomData });
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
        Arch::new().dispatch(Differential::<L, G> {
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
        Arch::new().dispatch(Energy::<L, G> { chunk, reference, positions, kernel: PhantomData })
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
        Arch::new().dispatch(Blocks::<L, G> { chunk, block, reference, positions, scale, out, kernel });
    }
}

/// One register's worth of elements: lanes `lane .. lane + S::F64_LANES` of a block.
pub(super) struct Group<'a, S: Simd> {
    pub simd: S,
    pub chunk: &'a Chunk,
    pub nodes: usize,
    pub samples: usize,
    pub block: usize,
    pub lane: usize,
}

impl<'a, S: Simd> Group<'a, S> {
    /// All groups of a chunk, in element order.
    #[inline(always)]
    pub fn all(simd: S, chunk: &'a Chunk, nodes: usize, samples: usize) -> impl Iterator<Item = Self> {
        (0..chunk.block_count()).flat_map(move |block| Self::of_block(simd, chunk, nodes, samples, block))
    }

    #[inline(always)]
    pub fn of_block(
        simd: S,
        chunk: &'a Chunk,
        nodes: usize,
        samples: usize,
        block: usize,
    ) -> impl Iterator<Item = Self> {
        (0..LANES).step_by(S::F64_LANES).map(move |lane| Self { simd, chunk, nodes, samples, block, lane })
    }

    /// Chunk nodes of node `a` of the elements.
    #[inline(always)]
    fn locals(&self, a: usize) -> &'a [u16] {
        let at = (self.block * self.nodes + a) * LANES + self.lane;
        &self.chunk.connectivity[at..at + S::F64_LANES]
    }

    /// Vectors of the elements' nodes, side by side.
    #[inline(always)]
    pub fn gather(&self, values: &[Vec3], out: &mut [Vec3<Lanes<S>>]) {
        for (a, out) in out.iter_mut().enumerate().take(self.nodes) {
            let (mut x, mut y, mut z) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
            for (lane, local) in self.locals(a).iter().enumerate() {
                let value = values[*local as usize];
                (x[lane], y[lane], z[lane]) = (value.x, value.y, value.z);
            }
            let load = |numbers: &[f64; LANES]| Lanes::load(self.simd, numbers);
            *out = Vec3::new(load(&x), load(&y), load(&z));
        }
    }

    /// `sums[n] += values` of the elements' nodes, element after element; lanes without an element add zero.
    #[inline(always)]
    pub fn scatter(&self, values: &[Vec3<Lanes<S>>], sums: &mut [Vec3]) {
        for (a, value) in values.iter().enumerate().take(self.nodes) {
            let (mut x, mut y, mut z) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
            value.x.store(&mut x);
            value.y.store(&mut y);
            value.z.store(&mut z);
            for (lane, local) in self.locals(a).iter().enumerate() {
                let sum = &mut sums[*local as usize];
                sum.x += x[lane];
                sum.y += y[lane];
                sum.z += z[lane];
            }
        }
    }

    /// `X_ξ⁻¹` and the volume at a sample.
    #[inline(always)]
    pub fn sample(&self, sample: usize) -> (Mat3<Lanes<S>>, Lanes<S>) {
        let start = (self.block * self.samples + sample) * SAMPLE_LEN * LANES;
        let numbers = &self.chunk.samples[start..start + SAMPLE_LEN * LANES];
        let number = |i: usize| Lanes::load(self.simd, &numbers[i * LANES + self.lane..]);
        let column = |i: usize| Vec3::new(number(3 * i), number(3 * i + 1), number(3 * i + 2));
        (Mat3::from_columns(column(0), column(1), column(2)), number(9))
    }

    #[inline(always)]
    pub fn parameters<P: Parameters<Lanes<S>>>(&self) -> P {
        let count = P::NAMES.len();
        let start = self.block * count * LANES;
        P::unpack(|i| Lanes::load(self.simd, &self.chunk.parameters[start + i * LANES + self.lane..]))
    }

    #[inline(always)]
    pub fn zeros(&self) -> [Vec3<Lanes<S>>; NODES_MAX] {
        let zero = Lanes::constant(self.simd, 0.0);
        [Vec3::new(zero, zero, zero); NODES_MAX]
    }
}

struct Forces<'a, L, G> {
    chunk: &'a Chunk,
    reference: &'a [Vec3],
    positions: &'a [Vec3],
    forces: &'a mut [Vec3],
    kernel: PhantomData<(L, G)>,
}

impl<L: Law, G: Geometry> WithSimd for Forces<'_, L, G> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let samples = self.reference.len() / G::NODES;
        for group in Group::all(simd, self.chunk, G::NODES, samples) {
            let mut x = group.zeros();
            let mut f = x;
            group.gather(self.positions, &mut x);
            let parameters = group.parameters::<L::Parameters<Lanes<S>>>();
            for sample in 0..samples {
                let reference = &self.reference[sample * G::NODES..(sample + 1) * G::NODES];
                let (inverse, volume) = group.sample(sample);
                let F = G::gradient(&x, reference) * inverse;
                let P = L::stress(&parameters, &F);
                // H = V P X_ξ⁻ᵀ
                G::spread(&P.mul_transpose(&inverse).scaled(volume), reference, &mut f);
            }
            group.scatter(&f, self.forces);
        }
    }
}

struct Differential<'a, L, G> {
    chunk: &'a Chunk,
    reference: &'a [Vec3],
    positions: &'a [Vec3],
    delta: &'a [Vec3],
    scale: f64,
    forces: &'a mut [Vec3],
    kernel: PhantomData<(L, G)>,
}

impl<L: Law, G: Geometry> WithSimd for Differential<'_, L, G> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let samples = self.reference.len() / G::NODES;
        for group in Group::all(simd, self.chunk, G::NODES, samples) {
            let mut x = group.zeros();
            let (mut dx, mut df) = (x, x);
            group.gather(self.positions, &mut x);
            group.gather(self.delta, &mut dx);
            let parameters = group.parameters::<L::Parameters<Lanes<S>>>();
            for sample in 0..samples {
                let reference = &self.reference[sample * G::NODES..(sample + 1) * G::NODES];
                let (inverse, volume) = group.sample(sample);
                let F = G::gradient(&x, reference) * inverse;
                let dF = G::gradient(&dx, reference) * inverse;
                let dP = L::stress_differential(&parameters, &L::at(&parameters, &F), &dF);
                G::spread(&dP.mul_transpose(&inverse).scaled(volume * self.scale), reference, &mut df);
            }
            group.scatter(&df, self.forces);
        }
    }
}

struct Energy<'a, L, G> {
    chunk: &'a Chunk,
    reference: &'a [Vec3],
    positions: &'a [Vec3],
    kernel: PhantomData<(L, G)>,
}

impl<L: Law, G: Geometry> WithSimd for Energy<'_, L, G> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let samples = self.reference.len() / G::NODES;
        let mut sum = 0.0;
        for group in Group::all(simd, self.chunk, G::NODES, samples) {
            let mut x = group.zeros();
            group.gather(self.positions, &mut x);
            let parameters = group.parameters::<L::Parameters<Lanes<S>>>();
            for sample in 0..samples {
                let reference = &self.reference[sample * G::NODES..(sample + 1) * G::NODES];
                let (inverse, volume) = group.sample(sample);
                let F = G::gradient(&x, reference) * inverse;
                let mut energies = [0.0; LANES];
                (L::energy_density(&parameters, &F) * volume).store(&mut energies);
                sum += energies[..S::F64_LANES].iter().sum::<f64>();
            }
        }
        sum
    }
}

struct Blocks<'a, L, G> {
    chunk: &'a Chunk,
    block: usize,
    reference: &'a [Vec3],
    positions: &'a [Vec3],
    scale: f64,
    out: &'a mut [f64],
    kernel: PhantomData<(L, G)>,
}

impl<L: Law, G: Geometry> WithSimd for Blocks<'_, L, G> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let samples = self.reference.len() / G::NODES;
        for group in Group::of_block(simd, self.chunk, G::NODES, samples, self.block) {
            let mut x = group.zeros();
            group.gather(self.positions, &mut x);
            let parameters = group.parameters::<L::Parameters<Lanes<S>>>();
            for sample in 0..samples {
                let reference = &self.reference[sample * G::NODES..(sample + 1) * G::NODES];
                let (inverse, volume) = group.sample(sample);
                let F = G::gradient(&x, reference) * inverse;
                let point = L::at(&parameters, &F);
                let weight = volume * -self.scale;
                let mut gradients = group.zeros();
                for a in 0..G::NODES {
                    // ∂N_a/∂X = X_ξ⁻ᵀ ∂N_a/∂ξ
                    let constant = |number: f64| Lanes::constant(simd, number);
                    let g = reference[a];
                    let g = Vec3::new(constant(g.x), constant(g.y), constant(g.z));
                    gradients[a] = inverse.transpose() * g;
                }
                let mut pair = 0;
                for a in 0..G::NODES {
                    let weighted = gradients[a] * weight;
                    for b in a..G::NODES {
                        let K = L::tangent_block(&parameters, &point, weighted, gradients[b]);
                        for (i, number) in K.columns.into_iter().flat_map(Vec3::to_array).enumerate() {
                            let at = (pair * 9 + i) * LANES + group.lane;
                            let slot = &mut self.out[at..at + S::F64_LANES];
                            let sum = if sample == 0 { number } else { Lanes::load(simd, slot) + number };
                            sum.store(slot);
                        }
                        pair += 1;
                    }
                }
            }
        }
    }
}
