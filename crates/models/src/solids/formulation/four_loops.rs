//! The tensor-mass method as it stands in its equations: four nested loops over the nodes of a tetrahedron, for the force and
//! for its derivative. The hand-written code that derived code is measured against.

#![allow(non_snake_case)]

use std::any::Any;

use souple_engine::state::Pair;
use souple_engine::tangent::add_block;
use souple_engine::{CellField, Configuration, Declaration, Energy, Force, Scratch, TangentWeights};
use souple_math::{Mat3, Vec3};
use souple_solve::BlockMatrix;
use souple_table::Entry;

use super::cells::Cells;
use super::polynomial::{Polynomial, tetrahedra};
use super::{BuildFormulation, FormulationError};
use crate::solids::SolidDescription;

const NAME: &str = "four_loops";

pub(super) const ENTRY: Entry<BuildFormulation> = Entry {
    name: NAME,
    summary: "tensor-mass as printed: four nested loops over the nodes of a tetrahedron; laws linear and st_venant_kirchhoff",
    source: "Picinbono, Delingette & Ayache 2003; derivative after Faure 2014, §6.2.2",
    parameters: &[],
    build: |description, _| Ok(Box::new(FourLoops::new(description)?)),
};

/// [`Force`] of linear tetrahedra.
struct FourLoops {
    name: String,
    first_row: u32,
    /// Where the points of the body rest [m].
    rest: Vec<Vec3>,
    cells: Cells,
    tetrahedra: Vec<Tetrahedron>,
}

struct Tetrahedron {
    rows: [u32; 4],
    quadratic: [[Mat3; 4]; 4],
    /// By `(j, k, l)` and `(j, k, l, m)`, the last the fastest; empty under Hooke's law.
    cubic: Vec<Vec3>,
    quartic: Vec<f64>,
}

impl FourLoops {
    fn new(description: &SolidDescription) -> Result<Self, FormulationError> {
        let first_row = description.first_row as u32;
        let made = tetrahedra(NAME, description)?.map(|found| {
            let (nodes, polynomial) = found?;
            Ok(Tetrahedron::new(nodes.map(|node| first_row + node), &polynomial))
        });
        Ok(Self {
            name: description.name.clone(),
            first_row,
            rest: description.mesh.points.clone(),
            cells: Cells::of(description),
            tetrahedra: made.collect::<Result<_, FormulationError>>()?,
        })
    }

    fn displacements(&self, tetrahedron: &Tetrahedron, positions: &[Vec3]) -> [Vec3; 4] {
        tetrahedron.rows.map(|row| positions[row as usize] - self.rest[(row - self.first_row) as usize])
    }
}

/// Operations of the loops for one tetrahedron: forces, and products with their derivative.
///
/// As they stand below, every product and sum counted: `A u` takes 15, `u·v` 5, `u vᵀ` 9, a sum or scaling of vectors 3, of matrices 9.
pub const fn operations(is_quartic: bool) -> [usize; 2] {
    const PAIRS: usize = 16;
    // 2 B U_k; (U_k·U_l) C and (2 U_k·C) U_l; 4 D (U_l·U_m) U_k
    let of_gradient = 15 + 3 + 3;
    let cubic = (5 + 3 + 3) + (5 + 1 + 3 + 3);
    let quartic = 5 + 2 + 3 + 3;
    // 2 B; two dyads, scaled and added, and a multiple of I; a multiple of I and one dyad
    let of_block = 9;
    let cubic_block = 2 * (9 + 9 + 9) + (5 + 1 + 3);
    let quartic_block = (5 + 2 + 3) + (1 + 1 + 9 + 9 + 9);
    let rest = if is_quartic { 1 } else { 0 };
    let gradient = of_gradient + rest * 4 * (cubic + 4 * quartic);
    let block = of_block + rest * 4 * (cubic_block + 4 * quartic_block);
    // each block times a vector, scaled and added
    [PAIRS * gradient, PAIRS * (block + 15 + 3 + 3)]
}

const NODES: std::ops::Range<usize> = 0..4;

impl Tetrahedron {
    fn new(rows: [u32; 4], polynomial: &Polynomial) -> Self {
        let (mut cubic, mut quartic) = (Vec::new(), Vec::new());
        if polynomial.is_quartic {
            for (j, k, l) in (0..64).map(|n| (n >> 4, n >> 2 & 3, n & 3)) {
                cubic.push(polynomial.cubic(j, k, l));
                quartic.extend(NODES.map(|m| polynomial.quartic(j, k, l, m)));
            }
        }
        let quadratic = std::array::from_fn(|j| std::array::from_fn(|k| polynomial.quadratic(j, k)));
        Self { rows, quadratic, cubic, quartic }
    }

    fn cubic(&self, j: usize, k: usize, l: usize) -> Vec3 {
        self.cubic[16 * j + 4 * k + l]
    }

    fn quartic(&self, j: usize, k: usize, l: usize, m: usize) -> f64 {
        self.quartic[64 * j + 16 * k + 4 * l + m]
    }

    fn energy(&self, U: &[Vec3; 4]) -> f64 {
        let mut sum = 0.0;
        for j in NODES {
            for k in NODES {
                sum += U[j].dot(self.quadratic[j][k] * U[k]);
                if self.cubic.is_empty() {
                    continue;
                }
                for l in NODES {
                    sum += U[j].dot(self.cubic(j, k, l)) * U[k].dot(U[l]);
                    for m in NODES {
                        sum += self.quartic(j, k, l, m) * U[j].dot(U[k]) * U[l].dot(U[m]);
                    }
                }
            }
        }
        sum
    }

    // ∂W/∂U_p = 2 Σ B^{pk} U_k + Σ C^{pkl} (U_k·U_l) + 2 Σ (U_j·C^{jpl}) U_l + 4 Σ D^{pklm} U_k (U_l·U_m)
    fn gradient(&self, U: &[Vec3; 4]) -> [Vec3; 4] {
        let mut gradient = [Vec3::ZERO; 4];
        for p in NODES {
            for k in NODES {
                gradient[p] += self.quadratic[p][k] * U[k] * 2.0;
                if self.cubic.is_empty() {
                    continue;
                }
                for l in NODES {
                    gradient[p] += self.cubic(p, k, l) * U[k].dot(U[l]);
                    gradient[p] += U[l] * (2.0 * U[k].dot(self.cubic(k, p, l)));
                    for m in NODES {
                        gradient[p] += U[k] * (4.0 * self.quartic(p, k, l, m) * U[l].dot(U[m]));
                    }
                }
            }
        }
        gradient
    }

    // ∂²W/∂U_p∂U_q = 2 B^{pq} + 2 Σ (C^{pql} U_lᵀ + U_l C^{qpl}ᵀ + (C^{lpq}·U_l) I)
    //   + 4 Σ (D^{pqlm} (U_l·U_m) I + D^{plqm} U_l U_mᵀ + D^{plmq} U_l U_mᵀ)
    fn block(&self, U: &[Vec3; 4], p: usize, q: usize) -> Mat3 {
        let mut block = self.quadratic[p][q] * 2.0;
        if self.cubic.is_empty() {
            return block;
        }
        for l in NODES {
            block += self.cubic(p, q, l).outer(U[l]) * 2.0 + U[l].outer(self.cubic(q, p, l)) * 2.0;
            block = block.plus_diagonal(2.0 * self.cubic(l, p, q).dot(U[l]));
            for m in NODES {
                block = block.plus_diagonal(4.0 * self.quartic(p, q, l, m) * U[l].dot(U[m]));
                let factor = 4.0 * (self.quartic(p, l, q, m) + self.quartic(p, l, m, q));
                block += U[l].outer(U[m]) * factor;
            }
        }
        block
    }
}

impl Force for FourLoops {
    fn name(&self) -> &str {
        &self.name
    }

    fn acts_within(&self) -> bool {
        true
    }

    fn declaration(&self) -> Declaration {
        let is_objective = self.tetrahedra.iter().all(|tetrahedron| !tetrahedron.cubic.is_empty());
        Declaration { internal: is_objective, ..Declaration::ELASTIC }
    }

    fn energy(&self, at: &Configuration, _: &mut Scratch) -> Energy {
        let of =
            |tetrahedron| Tetrahedron::energy(tetrahedron, &self.displacements(tetrahedron, at.positions));
        Energy { stored: self.tetrahedra.iter().map(of).sum(), dissipated: 0.0 }
    }

    fn add_force(&self, at: &Configuration, _: &mut Scratch, out: &mut [Vec3]) {
        for tetrahedron in &self.tetrahedra {
            let gradient = tetrahedron.gradient(&self.displacements(tetrahedron, at.positions));
            tetrahedron.rows.iter().zip(gradient).for_each(|(row, g)| out[*row as usize] -= g);
        }
    }

    fn add_differential(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        _: &mut Scratch,
        out: &mut [Vec3],
    ) {
        for tetrahedron in &self.tetrahedra {
            let U = self.displacements(tetrahedron, at.positions);
            for (p, row) in tetrahedron.rows.iter().enumerate() {
                for (q, column) in tetrahedron.rows.iter().enumerate() {
                    let change = tetrahedron.block(&U, p, q) * delta[*column as usize];
                    out[*row as usize] -= change * weights.position;
                }
            }
        }
    }

    fn visit_cliques(&self, _: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        self.tetrahedra.iter().for_each(|tetrahedron| visit(&tetrahedron.rows));
    }

    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        for tetrahedron in &self.tetrahedra {
            let U = self.displacements(tetrahedron, at.positions);
            for (p, row) in tetrahedron.rows.iter().enumerate() {
                for (q, column) in tetrahedron.rows.iter().enumerate() {
                    let block = tetrahedron.block(&U, p, q) * -weights.position;
                    add_block(matrix, *row as usize, *column as usize, &block);
                }
            }
        }
    }

    fn cell_field(&self, cell: usize, positions: &[Vec3]) -> Option<CellField> {
        self.cells.field(cell, positions)
    }

    fn bytes(&self) -> usize {
        let own = |tetrahedron: &Tetrahedron| {
            size_of::<Tetrahedron>()
                + size_of_val(tetrahedron.cubic.as_slice())
                + size_of_val(tetrahedron.quartic.as_slice())
        };
        size_of_val(self.rest.as_slice())
            + self.cells.bytes()
            + self.tetrahedra.iter().map(own).sum::<usize>()
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
