//! Neighbouring cells abreast, eight of one kind and material in the lanes of a block: the law is asked at a sample of all of them at once,
//! with a map before the deformation that may differ from sample to sample.

use std::ops::Range;

use pulp::{Arch, Simd, WithSimd};
use souple_math::Vec3;
use souple_mesh::ElementKind;

use super::layout::{LANES, LaneBlock};
use super::row_law::Row;

pub const ZERO: Row = [[0.0; LANES]; 9];
/// Of a node, `[axis][lane]`.
pub type Nodal = [[f64; LANES]; 3];
pub const NODAL_ZERO: Nodal = [[0.0; LANES]; 3];

/// Up to eight neighbouring cells.
pub struct Block {
    pub cells: Range<usize>,
    pub material: usize,
    pub samples: usize,
    pub nodes: usize,
    /// Where its numbers begin: of each sample the volume, then the gradients.
    first: usize,
}

/// The blocks of a body, and where its matter rests in them.
#[derive(Default)]
pub struct Blocks {
    blocks: Vec<Block>,
    numbers: Vec<LaneBlock>,
    kind: Option<ElementKind>,
}

/// A point of a cell where the law is asked.
#[derive(Clone, Copy)]
pub struct Sample<'a> {
    numbers: &'a [LaneBlock],
    lane: usize,
}

impl Sample<'_> {
    /// At rest [m³].
    pub fn volume(self) -> f64 {
        self.numbers[0].0[self.lane]
    }

    /// `∇N` of each node at rest [1/m].
    pub fn gradients(self) -> impl Iterator<Item = Vec3> {
        let Self { numbers, lane } = self;
        numbers[1..].chunks_exact(3).map(move |g| Vec3::new(g[0].0[lane], g[1].0[lane], g[2].0[lane]))
    }
}

impl Blocks {
    /// Takes the next cell of a body in; `samples` are volumes and gradients of its nodes. Says which block and which lane it has.
    pub fn push(
        &mut self,
        kind: ElementKind,
        material: usize,
        samples: &[(f64, Vec<Vec3>)],
    ) -> (usize, usize) {
        let fits = |block: &Block| block.cells.len() < LANES && block.material == material;
        if self.kind != Some(kind) || !self.blocks.last().is_some_and(fits) {
            let next = self.blocks.last().map_or(0, |block| block.cells.end);
            let (nodes, first) = (kind.node_count(), self.numbers.len());
            let samples = samples.len();
            self.blocks.push(Block { cells: next..next, material, samples, nodes, first });
            self.numbers.resize(first + samples * (1 + 3 * nodes), LaneBlock::default());
            self.kind = Some(kind);
        }
        let number = self.blocks.len() - 1;
        let block = &mut self.blocks[number];
        let lane = block.cells.len();
        block.cells.end += 1;
        let gradients = |gradients: &[Vec3]| gradients.iter().flat_map(|g| g.to_array()).collect::<Vec<_>>();
        let of_cell = samples.iter().flat_map(|(volume, own)| [vec![*volume], gradients(own)].concat());
        for (slot, number) in self.numbers[block.first..].iter_mut().zip(of_cell) {
            slot.0[lane] = number;
        }
        (number, lane)
    }

    pub fn all(&self) -> &[Block] {
        &self.blocks
    }

    fn numbers(&self, block: &Block, sample: usize) -> &[LaneBlock] {
        let len = 1 + 3 * block.nodes;
        &self.numbers[block.first + sample * len..][..len]
    }

    /// The samples of a lane of a block.
    pub fn samples(&self, block: usize, lane: usize) -> impl Iterator<Item = Sample<'_>> {
        let block = &self.blocks[block];
        (0..block.samples).map(move |sample| Sample { numbers: self.numbers(block, sample), lane })
    }

    /// `F_e = Σ x ⊗ ∇N F_p⁻¹` of all lanes.
    pub fn deform(&self, block: &Block, sample: usize, positions: &[Nodal], inverse: &Row) -> Row {
        let mut out = ZERO;
        let numbers = self.numbers(block, sample);
        Arch::new().dispatch(Deform { numbers, positions, inverse, out: &mut out });
        out
    }

    /// Subtracts `V P F_p⁻ᵀ ∇N` of all lanes from the forces of nodes.
    pub fn pull(&self, block: &Block, sample: usize, stress: &Row, inverse: &Row, forces: &mut [Nodal]) {
        let numbers = self.numbers(block, sample);
        Arch::new().dispatch(Pull { numbers, stress, inverse, forces });
    }

    pub fn bytes(&self) -> usize {
        size_of_val(self.blocks.as_slice()) + size_of_val(self.numbers.as_slice())
    }
}

#[inline(always)]
fn add_product(out: &mut [f64; LANES], a: &[f64; LANES], b: &[f64; LANES]) {
    for lane in 0..LANES {
        out[lane] += a[lane] * b[lane];
    }
}

struct Deform<'a> {
    numbers: &'a [LaneBlock],
    positions: &'a [Nodal],
    inverse: &'a Row,
    out: &'a mut Row,
}

impl WithSimd for Deform<'_> {
    type Output = ();

    // plain loops over lanes: compiled for the processor's instructions by being inlined here
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let mut F = ZERO;
        for (x, gradient) in self.positions.iter().zip(self.numbers[1..].chunks_exact(3)) {
            for column in 0..3 {
                for row in 0..3 {
                    add_product(&mut F[3 * column + row], &x[row], &gradient[column].0);
                }
            }
        }
        for column in 0..3 {
            for k in 0..3 {
                for row in 0..3 {
                    add_product(
                        &mut self.out[3 * column + row],
                        &F[3 * k + row],
                        &self.inverse[3 * column + k],
                    );
                }
            }
        }
    }
}

struct Pull<'a> {
    numbers: &'a [LaneBlock],
    stress: &'a Row,
    inverse: &'a Row,
    forces: &'a mut [Nodal],
}

impl WithSimd for Pull<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let mut minus_volume = [0.0; LANES];
        for lane in 0..LANES {
            minus_volume[lane] = -self.numbers[0].0[lane];
        }
        // P F_p⁻ᵀ
        let mut stress = ZERO;
        for column in 0..3 {
            for k in 0..3 {
                let mut factor = [0.0; LANES];
                add_product(&mut factor, &self.inverse[3 * k + column], &minus_volume);
                for row in 0..3 {
                    add_product(&mut stress[3 * column + row], &self.stress[3 * k + row], &factor);
                }
            }
        }
        for (force, gradient) in self.forces.iter_mut().zip(self.numbers[1..].chunks_exact(3)) {
            for column in 0..3 {
                for row in 0..3 {
                    add_product(&mut force[row], &stress[3 * column + row], &gradient[column].0);
                }
            }
        }
    }
}

/// Equivalent stress of von Mises `√(3/2 dev τ : dev τ)/|J|` of all lanes, with `τ = P Fᵀ` [Pa].
pub fn equivalent_stress(stress: &Row, F: &Row) -> [f64; LANES] {
    let mut out = [0.0; LANES];
    Arch::new().dispatch(Equivalent { stress, F, out: &mut out });
    out
}

struct Equivalent<'a> {
    stress: &'a Row,
    F: &'a Row,
    out: &'a mut [f64; LANES],
}

impl WithSimd for Equivalent<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let (P, F) = (self.stress, self.F);
        let mut tau = ZERO;
        for column in 0..3 {
            for k in 0..3 {
                for row in 0..3 {
                    add_product(&mut tau[3 * column + row], &P[3 * k + row], &F[3 * k + column]);
                }
            }
        }
        for lane in 0..LANES {
            let f = |i: usize, j: usize| F[3 * j + i][lane];
            let J = f(0, 0) * (f(1, 1) * f(2, 2) - f(1, 2) * f(2, 1))
                - f(0, 1) * (f(1, 0) * f(2, 2) - f(1, 2) * f(2, 0))
                + f(0, 2) * (f(1, 0) * f(2, 1) - f(1, 1) * f(2, 0));
            let mean = (tau[0][lane] + tau[4][lane] + tau[8][lane]) / 3.0;
            let mut square = 0.0;
            for entry in 0..9 {
                let deviator = if entry % 4 == 0 { tau[entry][lane] - mean } else { tau[entry][lane] };
                square += deviator * deviator;
            }
            self.out[lane] = (1.5 * square).sqrt() / J.abs();
        }
    }
}
