//! Linear forces between pairs of points: `f_i = Σ_j B_ij (u_j - u_i)`, a matrix for each end of each pair.
//!
//! Whatever discretisation of a linear law takes displacements of neighbours alone has this form; what differs is who a
//! neighbour is and what `B_ij` is. Where `B_ji = B_ijᵀ` there is an energy, `-½ Σ u_i·f_i`; where not, the pairs make or
//! eat energy as they move.

#![allow(non_snake_case)]

use std::any::Any;
use std::collections::BTreeMap;

use souple_engine::state::Pair;
use souple_engine::tangent::add_block;
use souple_engine::{CellField, Configuration, Declaration, Energy, Force, Scratch, TangentWeights};
use souple_math::{Mat3, Vec3};
use souple_solve::BlockMatrix;

use super::cells::Cells;
use crate::solids::SolidDescription;

/// Matrices of pairs, as they are summed up.
#[derive(Clone, Debug, Default)]
pub struct PairSums {
    of_pair: BTreeMap<[u32; 2], [Mat3; 2]>,
}

impl PairSums {
    /// Adds to `B_ij`: what the displacement of `j` relative to `i` does to `i` [N/m].
    pub fn add(&mut self, i: u32, j: u32, block: Mat3) {
        let (ends, own) = if i < j { ([i, j], 0) } else { ([j, i], 1) };
        self.of_pair.entry(ends).or_insert([Mat3::ZERO; 2])[own] += block;
    }

    /// Pairs, ascending, with `B` of the first end and of the second.
    pub fn iter(&self) -> impl Iterator<Item = ([u32; 2], [Mat3; 2])> + '_ {
        self.of_pair.iter().map(|(ends, blocks)| (*ends, *blocks))
    }

    /// `|B_ji - B_ijᵀ|` over all pairs, relative to the matrices: zero where there is an energy.
    pub fn asymmetry(&self) -> f64 {
        let (mut apart, mut whole) = (0.0, 0.0);
        for [forth, back] in self.of_pair.values() {
            let difference = *back - forth.transpose();
            // each stands for two blocks of the whole matrix
            apart += 2.0 * difference.dot(&difference);
            whole += forth.dot(forth) + back.dot(back);
        }
        if whole > 0.0 { (apart / whole).sqrt() } else { 0.0 }
    }
}

/// [`Force`] between pairs.
pub struct PairForce {
    name: String,
    first_row: u32,
    /// Where the points of the body rest [m].
    rest: Vec<Vec3>,
    pairs: Vec<PointPair>,
    declaration: Declaration,
    /// For what is read off cells, where they are linear tetrahedra.
    cells: Option<Cells>,
}

#[derive(Clone, Copy, Debug)]
struct PointPair {
    nodes: [u32; 2],
    /// `B` of the first end, and of the second [N/m].
    blocks: [Mat3; 2],
}

/// Matrices are transposes of each other to this part of them, where there is an energy.
const SYMMETRIC: f64 = 1e-12;

impl PairForce {
    pub fn new(description: &SolidDescription, sums: &PairSums) -> Self {
        let is_symmetric = sums.asymmetry() <= SYMMETRIC;
        let SolidDescription { name, mesh, first_row, .. } = description;
        let are_tets = mesh.cells().all(|cell| cell.kind == souple_mesh::ElementKind::Tet4);
        let pairs = sums.iter().map(|(nodes, blocks)| PointPair { nodes, blocks });
        Self {
            name: name.clone(),
            first_row: *first_row as u32,
            rest: mesh.points.clone(),
            pairs: pairs.collect(),
            // a body that is turned feels a torque
            declaration: Declaration {
                conservative: is_symmetric,
                symmetric_tangent: is_symmetric,
                internal: false,
                ..Declaration::ELASTIC
            },
            cells: are_tets.then(|| Cells::of(description)),
        }
    }

    /// `Σ` over pairs of `B_ij d` and `-B_ji d`, with `d = u_j - u_i` of some values on rows.
    fn add_products(&self, relative: impl Fn(usize, usize) -> Vec3, scale: f64, out: &mut [Vec3]) {
        for PointPair { nodes, blocks: [forth, back] } in &self.pairs {
            let [i, j] = nodes.map(|node| node as usize);
            let d = relative(i, j) * scale;
            out[self.first_row as usize + i] += *forth * d;
            out[self.first_row as usize + j] -= *back * d;
        }
    }

    fn displacement(&self, positions: &[Vec3], node: usize) -> Vec3 {
        positions[self.first_row as usize + node] - self.rest[node]
    }
}

impl Force for PairForce {
    fn name(&self) -> &str {
        &self.name
    }

    fn acts_within(&self) -> bool {
        true
    }

    fn declaration(&self) -> Declaration {
        self.declaration
    }

    // -½ Σ u_i·f_i; of pairs without an energy what their symmetric part has
    fn energy(&self, at: &Configuration, _: &mut Scratch) -> Energy {
        let of = |PointPair { nodes, blocks: [forth, back] }: &PointPair| {
            let [i, j] = nodes.map(|node| self.displacement(at.positions, node as usize));
            let d = j - i;
            0.5 * (j.dot(*back * d) - i.dot(*forth * d))
        };
        Energy { stored: self.pairs.iter().map(of).sum(), dissipated: 0.0 }
    }

    fn add_force(&self, at: &Configuration, _: &mut Scratch, out: &mut [Vec3]) {
        let relative = |i, j| self.displacement(at.positions, j) - self.displacement(at.positions, i);
        self.add_products(relative, 1.0, out);
    }

    fn add_differential(
        &self,
        _: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        _: &mut Scratch,
        out: &mut [Vec3],
    ) {
        let own = &delta[self.first_row as usize..];
        self.add_products(|i, j| own[j] - own[i], weights.position, out);
    }

    fn visit_cliques(&self, _: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        self.pairs.iter().for_each(|pair| visit(&pair.nodes.map(|node| self.first_row + node)));
    }

    fn add_blocks(
        &self,
        _: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        for PointPair { nodes, blocks } in &self.pairs {
            let [i, j] = nodes.map(|node| (self.first_row + node) as usize);
            let [forth, back] = blocks.map(|block| block * weights.position);
            for (row, column, block) in [(i, j, forth), (i, i, -forth), (j, i, back), (j, j, -back)] {
                add_block(matrix, row, column, &block);
            }
        }
    }

    fn add_symmetric_blocks(
        &self,
        _: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        for PointPair { nodes, blocks: [forth, back] } in &self.pairs {
            let [i, j] = nodes.map(|node| (self.first_row + node) as usize);
            let block = (*forth + back.transpose()) * (0.5 * weights.position);
            let blocks =
                [(i, j, block), (i, i, -block), (j, i, block.transpose()), (j, j, -block.transpose())];
            for (row, column, block) in blocks {
                add_block(matrix, row, column, &block);
            }
        }
    }

    fn cell_field(&self, cell: usize, positions: &[Vec3]) -> Option<CellField> {
        self.cells.as_ref()?.field(cell, positions)
    }

    fn bytes(&self) -> usize {
        size_of_val(self.rest.as_slice())
            + size_of_val(self.pairs.as_slice())
            + self.cells.as_ref().map_or(0, Cells::bytes)
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
