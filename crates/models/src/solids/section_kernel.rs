//! The loops over cells that are sections: any element, any law.
//!
//! Eight cells at a time, sample by sample: `F̄ = x_ξ X_ξ⁻¹`, completed by the section, asked of the law as a row,
//! `H = V P̄ X_ξ⁻ᵀ`, and node `a` feels `-H ∂N_a/∂ξ`. Volumes have loops of their own in [`super::kernel`] and
//! [`super::staged`].

use std::ops::Range;

use pulp::{Arch, Simd, WithSimd};
use souple_math::{Padded, Vec3};
use souple_mesh::MAX_NODES;

use super::kernel::Kernel;
use super::layout::{Chunk, LANES};
use super::row_law::{Row, RowLaw};
use super::section::{Completed, Section};

/// [`Kernel`] of a law on elements of `nodes` nodes that are cells of a section.
pub struct SectionKernel {
    pub law: Box<dyn RowLaw>,
    pub section: Section,
    pub nodes: usize,
}

type Lane = [f64; LANES];
/// Vectors of a block's nodes, `[node][axis][lane]`.
type Nodal = [[Lane; 3]; MAX_NODES];

const NONE: Nodal = [[[0.0; LANES]; 3]; MAX_NODES];
const ZERO: Row = [[0.0; LANES]; 9];

/// One sample of a block: `X_ξ⁻¹` by columns, the volume, `∂N_a/∂ξ`.
#[derive(Clone, Copy)]
struct Sample<'a> {
    inverse: &'a [f64],
    volume: &'a [f64],
    reference: &'a [Vec3],
}

impl SectionKernel {
    fn samples<'a>(
        &self,
        chunk: &'a Chunk,
        block: usize,
        reference: &'a [Vec3],
    ) -> impl Iterator<Item = Sample<'a>> + use<'a> {
        let (nodes, count) = (self.nodes, reference.len() / self.nodes);
        (0..count).map(move |sample| {
            let numbers: &[f64] = bytemuck::cast_slice(chunk.sample(block, sample, count));
            let (inverse, volume) = numbers.split_at(9 * LANES);
            Sample { inverse, volume, reference: &reference[sample * nodes..(sample + 1) * nodes] }
        })
    }

    /// The law's numbers for a block.
    fn parameters<'a>(&self, chunk: &'a Chunk, block: usize) -> &'a [f64] {
        bytemuck::cast_slice(chunk.all_parameters(block))
    }

    fn locals<'a>(&self, chunk: &'a Chunk, block: usize) -> impl Iterator<Item = &'a [u16]> + use<'a> {
        let start = block * self.nodes * LANES;
        chunk.connectivity[start..start + self.nodes * LANES].chunks_exact(LANES)
    }

    fn gather(&self, chunk: &Chunk, block: usize, values: &[Padded]) -> Nodal {
        let mut out = NONE;
        for (node, locals) in out.iter_mut().zip(self.locals(chunk, block)) {
            for (lane, local) in locals.iter().enumerate() {
                let value = Vec3::from(values[usize::from(*local)]);
                (node[0][lane], node[1][lane], node[2][lane]) = (value.x, value.y, value.z);
            }
        }
        out
    }

    fn scatter(&self, chunk: &Chunk, block: usize, values: &Nodal, sums: &mut [Padded]) {
        for (node, locals) in values.iter().zip(self.locals(chunk, block)) {
            for (lane, local) in locals.iter().enumerate() {
                let sum = &mut sums[usize::from(*local)];
                *sum = (Vec3::from(*sum) + Vec3::new(node[0][lane], node[1][lane], node[2][lane])).into();
            }
        }
    }

    fn completed<'a>(&'a self, parameters: &'a [f64], sample: Sample, positions: &Nodal) -> Completed<'a> {
        let F = gradient(sample, positions);
        Completed::new(self.section, self.law.as_ref(), parameters, F)
    }
}

impl Kernel for SectionKernel {
    fn forces(&self, chunk: &Chunk, reference: &[Vec3], positions: &[Padded], forces: &mut [Padded]) {
        for block in 0..chunk.block_count() {
            let x = self.gather(chunk, block, positions);
            let (parameters, mut f) = (self.parameters(chunk, block), NONE);
            for sample in self.samples(chunk, block, reference) {
                let stress = self.completed(parameters, sample, &x).stress();
                spread(sample, &stress, 1.0, &mut f);
            }
            self.scatter(chunk, block, &f, forces);
        }
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
        for block in 0..chunk.block_count() {
            let (x, dx) = (self.gather(chunk, block, positions), self.gather(chunk, block, delta));
            let (parameters, mut df) = (self.parameters(chunk, block), NONE);
            for sample in self.samples(chunk, block, reference) {
                let mut d = [gradient(sample, &dx)];
                self.completed(parameters, sample, &x).differential(&mut d);
                spread(sample, &d[0], scale, &mut df);
            }
            self.scatter(chunk, block, &df, forces);
        }
    }

    fn energy(&self, chunk: &Chunk, reference: &[Vec3], positions: &[Padded]) -> f64 {
        let mut sum = 0.0;
        for block in 0..chunk.block_count() {
            let (x, parameters) = (self.gather(chunk, block, positions), self.parameters(chunk, block));
            for sample in self.samples(chunk, block, reference) {
                let energy = self.completed(parameters, sample, &x).energy();
                sum +=
                    energy.iter().zip(sample.volume).map(|(density, volume)| density * volume).sum::<f64>();
            }
        }
        sum
    }

    fn quadratic_form(
        &self,
        chunk: &Chunk,
        reference: &[Vec3],
        positions: &[Padded],
        delta: &[Padded],
    ) -> f64 {
        let mut sum = 0.0;
        for block in 0..chunk.block_count() {
            let (x, dx) = (self.gather(chunk, block, positions), self.gather(chunk, block, delta));
            let parameters = self.parameters(chunk, block);
            for sample in self.samples(chunk, block, reference) {
                let dF = gradient(sample, &dx);
                let mut d = [dF];
                self.completed(parameters, sample, &x).differential(&mut d);
                for (dP, dF) in d[0].iter().zip(&dF) {
                    for (lane, volume) in sample.volume.iter().enumerate() {
                        sum += dP[lane] * dF[lane] * volume;
                    }
                }
            }
        }
        sum
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
        let block_len = self.nodes * (self.nodes + 1) / 2 * 9 * LANES;
        for (block, out) in blocks.zip(out.chunks_exact_mut(block_len)) {
            let (x, parameters) = (self.gather(chunk, block, positions), self.parameters(chunk, block));
            out.fill(0.0);
            for sample in self.samples(chunk, block, reference) {
                // ∂P/∂F, one entry of F after the other
                let mut tangent = [ZERO; 9];
                for (entry, d) in tangent.iter_mut().enumerate() {
                    d[entry] = [1.0; LANES];
                }
                self.completed(parameters, sample, &x).differential(&mut tangent);
                Arch::new().dispatch(Blocks { sample, tangent: &tangent, scale, out });
            }
        }
    }
}

/// `∂(values)/∂X = Σ v_a ⊗ ∂N_a/∂ξ · X_ξ⁻¹`.
fn gradient(sample: Sample, values: &Nodal) -> Row {
    let mut out = ZERO;
    Arch::new().dispatch(Gradient { sample, values, out: &mut out });
    out
}

/// `f_a -= scale V P X_ξ⁻ᵀ ∂N_a/∂ξ`.
fn spread(sample: Sample, stress: &Row, scale: f64, forces: &mut Nodal) {
    Arch::new().dispatch(Spread { sample, stress, scale, forces });
}

/// `sum += a b` lane by lane.
#[inline(always)]
fn add(sum: &mut Lane, a: &Lane, b: &[f64]) {
    for lane in 0..LANES {
        sum[lane] += a[lane] * b[lane];
    }
}

#[inline(always)]
fn add_scaled(sum: &mut Lane, a: &Lane, factor: f64) {
    for lane in 0..LANES {
        sum[lane] += a[lane] * factor;
    }
}

/// Lanes of number `i`.
#[inline(always)]
fn lanes(numbers: &[f64], i: usize) -> &[f64] {
    &numbers[i * LANES..(i + 1) * LANES]
}

struct Gradient<'a> {
    sample: Sample<'a>,
    values: &'a Nodal,
    out: &'a mut Row,
}

impl WithSimd for Gradient<'_> {
    type Output = ();

    // plain loops over lanes: compiled for the processor's instructions by being inlined here
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let mut by_reference = ZERO;
        for (g, value) in self.sample.reference.iter().zip(self.values) {
            for row in 0..3 {
                add_scaled(&mut by_reference[row], &value[row], g.x);
                add_scaled(&mut by_reference[3 + row], &value[row], g.y);
                add_scaled(&mut by_reference[6 + row], &value[row], g.z);
            }
        }
        for column in 0..3 {
            for k in 0..3 {
                let factor = lanes(self.sample.inverse, 3 * column + k);
                for row in 0..3 {
                    add(&mut self.out[3 * column + row], &by_reference[3 * k + row], factor);
                }
            }
        }
    }
}

struct Spread<'a> {
    sample: Sample<'a>,
    stress: &'a Row,
    scale: f64,
    forces: &'a mut Nodal,
}

impl WithSimd for Spread<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let mut weighted = ZERO;
        for column in 0..3 {
            for k in 0..3 {
                // (X_ξ⁻ᵀ)_jk = (X_ξ⁻¹)_kj
                let factor = lanes(self.sample.inverse, 3 * column + k);
                for row in 0..3 {
                    add(&mut weighted[3 * k + row], &self.stress[3 * column + row], factor);
                }
            }
        }
        for entry in &mut weighted {
            for lane in 0..LANES {
                entry[lane] *= self.sample.volume[lane] * self.scale;
            }
        }
        for (g, force) in self.sample.reference.iter().zip(self.forces) {
            for row in 0..3 {
                add_scaled(&mut force[row], &weighted[row], -g.x);
                add_scaled(&mut force[row], &weighted[3 + row], -g.y);
                add_scaled(&mut force[row], &weighted[6 + row], -g.z);
            }
        }
    }
}

/// Adds the blocks of a sample.
struct Blocks<'a> {
    sample: Sample<'a>,
    /// `[entry of F][entry of P][lane]`.
    tangent: &'a [Row; 9],
    scale: f64,
    out: &'a mut [f64],
}

impl WithSimd for Blocks<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Sample { inverse, volume, reference } = self.sample;
        // ∂N_a/∂X = X_ξ⁻ᵀ ∂N_a/∂ξ
        let mut gradients = NONE;
        for (g, gradient) in reference.iter().zip(&mut gradients) {
            for axis in 0..3 {
                for (k, factor) in [g.x, g.y, g.z].into_iter().enumerate() {
                    for (sum, number) in gradient[axis].iter_mut().zip(lanes(inverse, 3 * axis + k)) {
                        *sum += number * factor;
                    }
                }
            }
        }
        let nodes = reference.len();
        let mut weight = [0.0; LANES];
        for lane in 0..LANES {
            weight[lane] = -volume[lane] * self.scale;
        }
        for b in 0..nodes {
            // V ∂P/∂F : (e_k ⊗ g_b), for each k
            let mut rates = [ZERO; 3];
            for (k, rate) in rates.iter_mut().enumerate() {
                for axis in 0..3 {
                    let mut factor = gradients[b][axis];
                    for lane in 0..LANES {
                        factor[lane] *= weight[lane];
                    }
                    for entry in 0..9 {
                        add(&mut rate[entry], &self.tangent[3 * axis + k][entry], &factor);
                    }
                }
            }
            for a in 0..=b {
                // pairs (a, b) with a ≤ b, row by row
                let pair = a * nodes - a * (a + 1) / 2 + b;
                for (k, rate) in rates.iter().enumerate() {
                    for row in 0..3 {
                        let at = (pair * 9 + 3 * k + row) * LANES;
                        for (axis, gradient) in gradients[a].iter().enumerate() {
                            for lane in 0..LANES {
                                self.out[at + lane] += rate[3 * axis + row][lane] * gradient[lane];
                            }
                        }
                    }
                }
            }
        }
    }
}
