//! Linear elements in a frame that turns with each: one rotation per element, not per sample.
//!
//! The rotation `R` is that of the mean deformation gradient, and `f = -R K (Rᵀ x - X)` with the constant stiffness `K`;
//! the tangent `-R K Rᵀ` leaves out how `R` varies. Of linear tetrahedra the force is that of the material `corotational`;
//! elsewhere it is not the gradient of an energy. Made for tetrahedra and hexahedra; here of any element.
//! (Müller & Gross 2004, Interactive virtual materials; Nesme et al. 2005.)

#![allow(non_snake_case)]

use std::marker::PhantomData;
use std::ops::Range;

use pulp::{Arch, Simd, WithSimd};
use souple_engine::Declaration;
use souple_math::{Lanes, Mat3, Padded, Real, Vec3, polar};
use souple_mesh::{ElementKind, MAX_NODES, QuadratureRule};
use souple_table::Entry;

use super::{BuildFormulation, check_cells, moduli_of};
use crate::materials::{AnyLaw, Lame, Law, Linear, MaterialLaw};
use crate::solids::elements::Sorting;
use crate::solids::geometry::{AnyElement, Geometry, Tetrahedron};
use crate::solids::group::{Group, for_each_group};
use crate::solids::kernel::Kernel;
use crate::solids::layout::{Chunk, LANES};
use crate::solids::{SolidDescription, SolidForce};

const NAME: &str = "element_corotational";

pub(super) const ENTRY: Entry<BuildFormulation> = Entry {
    name: NAME,
    summary: "linear elements in a frame that turns with each; laws linear and corotational, tangent approximate",
    source: "Müller & Gross 2004, Interactive virtual materials; Faure 2014, table 6.4",
    parameters: &[],
    build: |description, _| {
        let laws = [AnyLaw::Linear, AnyLaw::Corotational];
        let moduli = moduli_of(NAME, description.materials, &laws, "linear and corotational")?;
        check_cells(NAME, description, |kind| kind.dimension() == 3, "volume elements")?;
        let is_potential = description.mesh.cells().all(|cell| cell.kind == ElementKind::Tet4);
        let declaration = Declaration { conservative: is_potential, ..Declaration::ELASTIC };
        let numbers: Vec<[f64; 2]> = moduli.iter().map(|lame| [lame.mu, lame.lambda]).collect();
        let force = SolidForce::sorted_by(description, &ByModuli { description, numbers: &numbers })?;
        Ok(Box::new(force.declared(declaration)))
    },
};

struct ByModuli<'a> {
    description: &'a SolidDescription<'a>,
    numbers: &'a [[f64; 2]],
}

impl Sorting for ByModuli<'_> {
    type Law = MaterialLaw;
    type Kernel = Box<dyn Kernel>;

    fn law_of(&self, cell: usize) -> &MaterialLaw {
        let SolidDescription { materials, material_of_cell, .. } = self.description;
        &materials[usize::from(material_of_cell[cell])].law
    }

    fn parameters_of(&self, cell: usize) -> &[f64] {
        &self.numbers[usize::from(self.description.material_of_cell[cell])]
    }

    fn kernel(&self, kind: ElementKind, _: &QuadratureRule, _: &MaterialLaw) -> Box<dyn Kernel> {
        match kind {
            ElementKind::Tet4 => Box::new(Corotated::<Tetrahedron, 4> { nodes: 4, geometry: PhantomData }),
            kind => Box::new(Corotated::<AnyElement, MAX_NODES> {
                nodes: kind.node_count(),
                geometry: PhantomData,
            }),
        }
    }
}

/// [`Kernel`] of elements of geometry `G` with at most `N` nodes.
struct Corotated<G, const N: usize> {
    nodes: usize,
    geometry: PhantomData<G>,
}

impl<G: Geometry, const N: usize> Corotated<G, N> {
    fn samples(&self, reference: &[Vec3]) -> usize {
        G::SAMPLES.unwrap_or(reference.len() / self.nodes)
    }

    fn loops<'a, const I: usize>(
        &self,
        chunk: &'a Chunk,
        reference: &'a [Vec3],
        inputs: [&'a [Padded]; I],
    ) -> Loops<'a, G, N, I> {
        let (nodes, samples) = (self.nodes, self.samples(reference));
        Loops { chunk, reference, inputs, nodes, samples, geometry: PhantomData }
    }
}

impl<G: Geometry, const N: usize> Kernel for Corotated<G, N> {
    fn forces(&self, chunk: &Chunk, reference: &[Vec3], positions: &[Padded], forces: &mut [Padded]) {
        Arch::new().dispatch(Forces { loops: self.loops(chunk, reference, [positions]), forces });
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
        let loops = self.loops(chunk, reference, [positions, delta]);
        Arch::new().dispatch(Differential { loops, scale, forces });
    }

    fn energy(&self, chunk: &Chunk, reference: &[Vec3], positions: &[Padded]) -> f64 {
        Arch::new().dispatch(Energy { loops: self.loops(chunk, reference, [positions]) })
    }

    fn quadratic_form(
        &self,
        chunk: &Chunk,
        reference: &[Vec3],
        positions: &[Padded],
        delta: &[Padded],
    ) -> f64 {
        Arch::new().dispatch(QuadraticForm { loops: self.loops(chunk, reference, [positions, delta]) })
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
        for (block, out) in blocks.zip(out.chunks_exact_mut(self.nodes * (self.nodes + 1) / 2 * 9 * LANES)) {
            let loops = self.loops(chunk, reference, [positions]);
            Arch::new().dispatch(Blocks { loops, block, scale, out });
        }
    }
}

/// The elements of a chunk and `I` fields on its nodes, positions first.
struct Loops<'a, G, const N: usize, const I: usize> {
    chunk: &'a Chunk,
    reference: &'a [Vec3],
    inputs: [&'a [Padded]; I],
    nodes: usize,
    samples: usize,
    geometry: PhantomData<G>,
}

impl<'a, G: Geometry, const N: usize, const I: usize> Loops<'a, G, N, I> {
    #[inline(always)]
    fn reference_of(&self, sample: usize) -> &'a [Vec3] {
        &self.reference[sample * self.nodes..(sample + 1) * self.nodes]
    }

    /// `∂(values)/∂X` at a sample, and its volume.
    #[inline(always)]
    fn gradient<S: Simd>(
        &self,
        group: &Group<'_, S, N>,
        values: &[Vec3<Lanes<S>>; N],
        sample: usize,
    ) -> (Mat3<Lanes<S>>, Lanes<S>) {
        let (inverse, volume) = group.sample(sample);
        (G::gradient(&values[..self.nodes], self.reference_of(sample)) * inverse, volume)
    }

    /// The rotation of the mean deformation gradient.
    #[inline(always)]
    fn rotation<S: Simd>(&self, group: &Group<'_, S, N>, x: &[Vec3<Lanes<S>>; N]) -> Mat3<Lanes<S>> {
        let mut sum = Mat3::zero(Lanes::constant(group.simd, 0.0));
        for sample in 0..self.samples {
            let (F, volume) = self.gradient(group, x, sample);
            sum += F.scaled(volume);
        }
        polar(&sum).rotation
    }

    #[inline(always)]
    fn add_spread<S: Simd>(
        &self,
        group: &Group<'_, S, N>,
        P: &Mat3<Lanes<S>>,
        sample: usize,
        f: &mut [Vec3<Lanes<S>>; N],
    ) {
        let (inverse, volume) = group.sample(sample);
        let H = P.mul_transpose(&inverse).scaled(volume);
        G::spread(&H, self.reference_of(sample), &mut f[..self.nodes]);
    }
}

struct Forces<'a, G, const N: usize> {
    loops: Loops<'a, G, N, 1>,
    forces: &'a mut [Padded],
}

impl<G: Geometry, const N: usize> WithSimd for Forces<'_, G, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { loops, forces } = self;
        for_each_group!(
            simd,
            loops.chunk,
            loops.nodes,
            loops.samples,
            0..loops.chunk.block_count(),
            N,
            |group| {
                let x = group.gather(loops.inputs[0]);
                let R = loops.rotation(&group, &x);
                let parameters = group.parameters::<Lame<Lanes<S>>>();
                let mut f = group.zeros();
                for sample in 0..loops.samples {
                    let (F, _) = loops.gradient(&group, &x, sample);
                    let P = R * Linear::stress(&parameters, &R.transpose_mul(&F));
                    loops.add_spread(&group, &P, sample, &mut f);
                }
                group.scatter(&f, forces);
            }
        );
    }
}

struct Differential<'a, G, const N: usize> {
    loops: Loops<'a, G, N, 2>,
    scale: f64,
    forces: &'a mut [Padded],
}

impl<G: Geometry, const N: usize> WithSimd for Differential<'_, G, N> {
    type Output = ();

    // δf = -R K Rᵀ δ
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { loops, scale, forces } = self;
        for_each_group!(
            simd,
            loops.chunk,
            loops.nodes,
            loops.samples,
            0..loops.chunk.block_count(),
            N,
            |group| {
                let (x, dx) = (group.gather(loops.inputs[0]), group.gather(loops.inputs[1]));
                let R = loops.rotation(&group, &x);
                let parameters = group.parameters::<Lame<Lanes<S>>>();
                let mut df = group.zeros();
                for sample in 0..loops.samples {
                    let (dF, _) = loops.gradient(&group, &dx, sample);
                    let dP = turned_differential(&parameters, &R, &dF) * scale;
                    loops.add_spread(&group, &dP, sample, &mut df);
                }
                group.scatter(&df, forces);
            }
        );
    }
}

/// `R (2μ ε + λ tr(ε) I)` of the strain `ε = sym(Rᵀ δF)`.
#[inline(always)]
fn turned_differential<R: Real>(parameters: &Lame<R>, rotation: &Mat3<R>, dF: &Mat3<R>) -> Mat3<R> {
    let turned = rotation.transpose_mul(dF);
    *rotation * Linear::stress_differential(parameters, &(), &turned)
}

struct Energy<'a, G, const N: usize> {
    loops: Loops<'a, G, N, 1>,
}

impl<G: Geometry, const N: usize> WithSimd for Energy<'_, G, N> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let Self { loops } = self;
        let mut sum = 0.0;
        for_each_group!(
            simd,
            loops.chunk,
            loops.nodes,
            loops.samples,
            0..loops.chunk.block_count(),
            N,
            |group| {
                let x = group.gather(loops.inputs[0]);
                let R = loops.rotation(&group, &x);
                let parameters = group.parameters::<Lame<Lanes<S>>>();
                for sample in 0..loops.samples {
                    let (F, volume) = loops.gradient(&group, &x, sample);
                    sum += group.sum(Linear::energy_density(&parameters, &R.transpose_mul(&F)) * volume);
                }
            }
        );
        sum
    }
}

struct QuadraticForm<'a, G, const N: usize> {
    loops: Loops<'a, G, N, 2>,
}

impl<G: Geometry, const N: usize> WithSimd for QuadraticForm<'_, G, N> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let Self { loops } = self;
        let mut sum = 0.0;
        for_each_group!(
            simd,
            loops.chunk,
            loops.nodes,
            loops.samples,
            0..loops.chunk.block_count(),
            N,
            |group| {
                let (x, dx) = (group.gather(loops.inputs[0]), group.gather(loops.inputs[1]));
                let R = loops.rotation(&group, &x);
                let parameters = group.parameters::<Lame<Lanes<S>>>();
                for sample in 0..loops.samples {
                    let (dF, volume) = loops.gradient(&group, &dx, sample);
                    sum += group.sum(turned_differential(&parameters, &R, &dF).dot(&dF) * volume);
                }
            }
        );
        sum
    }
}

struct Blocks<'a, G, const N: usize> {
    loops: Loops<'a, G, N, 1>,
    block: usize,
    scale: f64,
    out: &'a mut [f64],
}

impl<G: Geometry, const N: usize> WithSimd for Blocks<'_, G, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { loops, block, scale, out } = self;
        for_each_group!(simd, loops.chunk, loops.nodes, loops.samples, block..block + 1, N, |group| {
            let x = group.gather(loops.inputs[0]);
            let R = loops.rotation(&group, &x);
            let parameters = group.parameters::<Lame<Lanes<S>>>();
            for sample in 0..loops.samples {
                let (inverse, volume) = group.sample(sample);
                let weight = volume * -scale;
                let gradients = group.gradients(&inverse, loops.reference_of(sample));
                let mut pair = 0;
                for a in 0..loops.nodes {
                    for b in a..loops.nodes {
                        // R (λ g_a g_bᵀ + μ g_b g_aᵀ + μ g_a·g_b I) Rᵀ
                        let (s, t) = (R * gradients[a], R * gradients[b]);
                        let K = (s * parameters.lambda).outer(t) + (t * parameters.mu).outer(s);
                        let K = K.plus_diagonal(parameters.mu * s.dot(t)).scaled(weight);
                        for i in 0..9 {
                            let at = (pair * 9 + i) * LANES;
                            let number = K.columns[i / 3].to_array()[i % 3];
                            group.add_or_put(sample, number, &mut out[at..at + LANES]);
                        }
                        pair += 1;
                    }
                }
            }
        });
    }
}
