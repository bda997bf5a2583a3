//! The classical tensor-mass method: the polynomial of the energy summed over the mesh, with its constants on vertices, edges,
//! faces and tetrahedra. Constants of neighbouring tetrahedra add up before the first step, which is what the method is for.
//!
//! The gradient is that of Picinbono, Delingette & Ayache 2003, grouped by what of the mesh its terms belong to, as corrected
//! in the specification (Faure 2014, eq. 2.16). Symmetries leave on an edge `pj` one matrix, four vectors, five numbers; on a
//! face three vectors, and by the node that stands twice two numbers each; on a tetrahedron three numbers. Terms are kept
//! apart by their degree, so that the energy follows as `Σ U·(g₁/2 + g₂/3 + g₃/4)`, and are written over [`Real`], so that
//! dual numbers give the derivative.

#![allow(non_snake_case)]

use std::any::Any;
use std::collections::BTreeMap;

use souple_engine::state::Pair;
use souple_engine::tangent::add_block;
use souple_engine::{CellField, Configuration, Declaration, Energy, Force, Scratch, TangentWeights};
use souple_math::{Dual, Mat3, Real, Vec3};
use souple_solve::BlockMatrix;
use souple_table::Entry;

use super::cells::Cells;
use super::polynomial::{Polynomial, tetrahedra};
use super::{BuildFormulation, FormulationError};
use crate::solids::SolidDescription;

const NAME: &str = "tensor_mass";

pub(super) const ENTRY: Entry<BuildFormulation> = Entry {
    name: NAME,
    summary: "constants on vertices, edges, faces and tetrahedra of the mesh; laws linear and st_venant_kirchhoff, tet4",
    source: "Cotin, Delingette & Ayache 2000; Picinbono, Delingette & Ayache 2003, Non-linear anisotropic elasticity for \
             real-time surgery simulation",
    parameters: &[],
    build: |description, _| Ok(Box::new(TensorMass::new(description)?)),
};

/// [`Force`] of linear tetrahedra.
struct TensorMass {
    name: String,
    first_row: u32,
    /// Where the points of the body rest [m].
    rest: Vec<Vec3>,
    is_objective: bool,
    cells: Cells,
    vertices: Vec<Part<1, Vertex>>,
    edges: Vec<Part<2, Edge>>,
    faces: Vec<Part<3, Face>>,
    tetrahedra: Vec<Part<4, Inside>>,
}

/// Constants that belong to `N` nodes, ascending.
struct Part<const N: usize, C> {
    nodes: [u32; N],
    constants: C,
}

/// Gradients of the energy's terms of degree 2, 3 and 4 with respect to one node.
type ByDegree<R> = [Vec3<R>; 3];

/// What a part of the mesh adds to the gradient at its nodes.
trait Terms<const N: usize>: Default {
    /// Adds the constants of nodes `own` of a tetrahedron.
    fn add(&mut self, polynomial: &Polynomial, own: [usize; N]);

    fn gradients<R: Real>(&self, U: &[Vec3<R>; N]) -> [ByDegree<R>; N];
}

/// `c u`.
#[inline(always)]
fn times<R: Real>(u: Vec3<R>, c: f64) -> Vec3<R> {
    Vec3::new(u.x * c, u.y * c, u.z * c)
}

/// `s c`.
#[inline(always)]
fn along<R: Real>(c: Vec3, s: R) -> Vec3<R> {
    Vec3::new(s * c.x, s * c.y, s * c.z)
}

/// `u·c`.
#[inline(always)]
fn dot<R: Real>(u: Vec3<R>, c: Vec3) -> R {
    u.x * c.x + u.y * c.y + u.z * c.z
}

/// `M u`.
#[inline(always)]
fn apply<R: Real>(M: &Mat3, u: Vec3<R>) -> Vec3<R> {
    along(M.columns[0], u.x) + along(M.columns[1], u.y) + along(M.columns[2], u.z)
}

/// `B^{pp}`, `C^{ppp}`, `D^{pppp}`.
#[derive(Default)]
struct Vertex {
    quadratic: Mat3,
    cubic: Vec3,
    quartic: f64,
}

impl Terms<1> for Vertex {
    fn add(&mut self, of: &Polynomial, [p]: [usize; 1]) {
        self.quadratic += of.quadratic(p, p);
        self.cubic += of.cubic(p, p, p);
        self.quartic += of.quartic(p, p, p, p);
    }

    // 2 B U + (2 U⊗U + U·U I) C + 4 D U (U·U)
    fn gradients<R: Real>(&self, [u]: &[Vec3<R>; 1]) -> [ByDegree<R>; 1] {
        let square = u.length_sq();
        let cubic = *u * (dot(*u, self.cubic) * 2.0) + along(self.cubic, square);
        [[times(apply(&self.quadratic, *u), 2.0), cubic, *u * (square * (4.0 * self.quartic))]]
    }
}

/// Of an edge from `p` to `j`.
#[derive(Default)]
struct Edge {
    /// `B^{pj}`.
    quadratic: Mat3,
    /// `C^{ppj}`, `C^{jpp}`, and the same with `p` and `j` exchanged.
    cubic: [[Vec3; 2]; 2],
    /// `D^{jppp}`, and `D^{pjjj}`.
    thrice: [f64; 2],
    /// `D^{jjpp}`.
    apart: f64,
    /// `D^{jpjp} + D^{pjjp}`.
    crossed: f64,
}

impl Terms<2> for Edge {
    fn add(&mut self, of: &Polynomial, [p, j]: [usize; 2]) {
        self.quadratic += of.quadratic(p, j);
        for (cubic, (p, j)) in self.cubic.iter_mut().zip([(p, j), (j, p)]) {
            cubic[0] += of.cubic(p, p, j);
            cubic[1] += of.cubic(j, p, p);
        }
        self.thrice[0] += of.quartic(j, p, p, p);
        self.thrice[1] += of.quartic(p, j, j, j);
        self.apart += of.quartic(j, j, p, p);
        self.crossed += of.quartic(j, p, j, p) + of.quartic(p, j, j, p);
    }

    fn gradients<R: Real>(&self, U: &[Vec3<R>; 2]) -> [ByDegree<R>; 2] {
        let product = U[0].dot(U[1]);
        let transposed = self.quadratic.transpose();
        [(0, 1, &self.quadratic), (1, 0, &transposed)].map(|(p, j, quadratic)| {
            let (u, w) = (U[p], U[j]);
            let ([ppj, jpp], [jjp, pjj]) = (self.cubic[p], self.cubic[j]);
            let square = w.length_sq();
            // 2 (U_j⊗U_p + U_j·U_p I) C^{ppj} + 2 (U_p⊗U_j) C^{jpp} + 2 (U_j⊗U_j) C^{jjp} + U_j·U_j C^{pjj}
            let cubic = w * (dot(u, ppj) * 2.0)
                + along(ppj, product * 2.0)
                + u * (dot(w, jpp) * 2.0)
                + w * (dot(w, jjp) * 2.0)
                + along(pjj, square);
            // D^{jppp} (2 U_p (U_p·U_j) + U_j (U_p·U_p)) + D^{jjpp} U_p (U_j·U_j)
            //   + (D^{jpjp} + D^{pjjp}) U_j (U_j·U_p) + D^{jjjp} U_j (U_j·U_j)
            let [once, other] = [self.thrice[p], self.thrice[j]];
            let quartic = times(times(u * product, 2.0) + w * u.length_sq(), once)
                + times(u * square, self.apart)
                + times(w * product, self.crossed)
                + times(w * square, other);
            [times(apply(quadratic, w), 2.0), cubic, times(quartic, 4.0)]
        })
    }
}

/// Of three nodes; what stands at `r` has this node first, or twice.
#[derive(Default)]
struct Face {
    /// `C^{rst}` with `s`, `t` the others.
    cubic: [Vec3; 3],
    /// `D^{rrst}`.
    apart: [f64; 3],
    /// `D^{rsrt} + D^{rstr}`.
    crossed: [f64; 3],
}

impl Terms<3> for Face {
    fn add(&mut self, of: &Polynomial, own: [usize; 3]) {
        for at in 0..3 {
            let [r, s, t] = [0, 1, 2].map(|i| own[(at + i) % 3]);
            self.cubic[at] += of.cubic(r, s, t);
            self.apart[at] += of.quartic(r, r, s, t);
            self.crossed[at] += of.quartic(r, s, r, t) + of.quartic(r, s, t, r);
        }
    }

    fn gradients<R: Real>(&self, U: &[Vec3<R>; 3]) -> [ByDegree<R>; 3] {
        [(0, 1, 2), (1, 2, 0), (2, 0, 1)].map(|(p, j, k)| {
            let (u, v, w) = (U[p], U[j], U[k]);
            let vw = v.dot(w);
            // (U_k⊗U_j) C^{jkp} + (U_j⊗U_k) C^{kjp} + U_j·U_k C^{pjk}
            let cubic = w * dot(v, self.cubic[j]) + v * dot(w, self.cubic[k]) + along(self.cubic[p], vw);
            // of the node that stands twice: p, then j, then k
            let quartic = times(v * w.dot(u) + w * v.dot(u), self.crossed[p])
                + times(u * vw, 2.0 * self.apart[p])
                + times(v * vw, self.crossed[j])
                + times(w * v.length_sq(), self.apart[j])
                + times(w * vw, self.crossed[k])
                + times(v * w.length_sq(), self.apart[k]);
            [times(u, 0.0), times(cubic, 2.0), times(quartic, 4.0)]
        })
    }
}

/// Of all four nodes: `D^{abcd} + D^{bacd}` for the pairs `ab|cd`, by the partner of node 0.
#[derive(Default)]
struct Inside([f64; 3]);

/// The partner of each node, by the partner of node 0.
const PARTNERS: [[usize; 4]; 3] = [[1, 0, 3, 2], [2, 3, 0, 1], [3, 2, 1, 0]];

impl Terms<4> for Inside {
    fn add(&mut self, of: &Polynomial, own: [usize; 4]) {
        for (sum, (b, c, d)) in self.0.iter_mut().zip([(1, 2, 3), (2, 1, 3), (3, 1, 2)]) {
            let [a, b, c, d] = [0, b, c, d].map(|i| own[i]);
            *sum += of.quartic(a, b, c, d) + of.quartic(b, a, c, d);
        }
    }

    // 4 Σ (D^{jklp} + D^{kjlp}) U_l (U_j·U_k), l the partner of p
    fn gradients<R: Real>(&self, U: &[Vec3<R>; 4]) -> [ByDegree<R>; 4] {
        [0, 1, 2, 3].map(|p| {
            let zero = times(U[p], 0.0);
            let mut quartic = zero;
            for (constant, partners) in self.0.iter().zip(PARTNERS) {
                let l = partners[p];
                // the other pair: any node that is neither, and its partner
                let j = (0..4).find(|n| *n != p && *n != l).unwrap_or_else(|| unreachable!("four nodes"));
                quartic += times(U[l] * U[j].dot(U[partners[j]]), 4.0 * constant);
            }
            [zero, zero, quartic]
        })
    }
}

impl TensorMass {
    fn new(description: &SolidDescription) -> Result<Self, FormulationError> {
        let mut vertices = BTreeMap::new();
        let mut edges = BTreeMap::new();
        let mut faces = BTreeMap::new();
        let mut inside = Vec::new();
        let mut is_objective = true;
        for found in tetrahedra(NAME, description)? {
            let (nodes, polynomial) = found?;
            is_objective &= polynomial.is_quartic;
            // of the tetrahedron, by the numbers that their nodes have in the mesh
            let mut order = [0, 1, 2, 3];
            order.sort_unstable_by_key(|own| nodes[*own]);
            for a in 0..4 {
                add(&mut vertices, &nodes, &polynomial, [order[a]]);
                for b in a + 1..4 {
                    add(&mut edges, &nodes, &polynomial, [order[a], order[b]]);
                    for c in (b + 1..4).filter(|_| polynomial.is_quartic) {
                        add(&mut faces, &nodes, &polynomial, [order[a], order[b], order[c]]);
                    }
                }
            }
            if polynomial.is_quartic {
                let mut constants = Inside::default();
                constants.add(&polynomial, order);
                inside.push(Part { nodes: order.map(|own| nodes[own]), constants });
            }
        }
        Ok(Self {
            name: description.name.clone(),
            first_row: description.first_row as u32,
            rest: description.mesh.points.clone(),
            is_objective,
            cells: Cells::of(description),
            vertices: parts(vertices),
            edges: parts(edges),
            faces: parts(faces),
            tetrahedra: inside,
        })
    }

    /// Displacements of the body's points.
    fn displacements<'a>(&'a self, positions: &'a [Vec3]) -> impl Fn(u32) -> Vec3 + 'a {
        |node| positions[(self.first_row + node) as usize] - self.rest[node as usize]
    }

    fn each_part(&self, visit: &mut impl VisitPart) {
        self.vertices.iter().for_each(|part| visit.part(part));
        self.edges.iter().for_each(|part| visit.part(part));
        self.faces.iter().for_each(|part| visit.part(part));
        self.tetrahedra.iter().for_each(|part| visit.part(part));
    }
}

fn add<const N: usize, C: Terms<N>>(
    parts: &mut BTreeMap<[u32; N], C>,
    nodes: &[u32; 4],
    polynomial: &Polynomial,
    own: [usize; N],
) {
    parts.entry(own.map(|own| nodes[own])).or_default().add(polynomial, own);
}

fn parts<const N: usize, C>(found: BTreeMap<[u32; N], C>) -> Vec<Part<N, C>> {
    found.into_iter().map(|(nodes, constants)| Part { nodes, constants }).collect()
}

/// Something done with every part of the mesh.
trait VisitPart {
    fn part<const N: usize, C: Terms<N>>(&mut self, part: &Part<N, C>);
}

struct SumEnergy<F> {
    displacement: F,
    sum: f64,
}

impl<F: Fn(u32) -> Vec3> VisitPart for SumEnergy<F> {
    fn part<const N: usize, C: Terms<N>>(&mut self, part: &Part<N, C>) {
        let U = part.nodes.map(&self.displacement);
        for (u, [two, three, four]) in U.iter().zip(part.constants.gradients(&U)) {
            self.sum += u.dot(two * 0.5 + three * (1.0 / 3.0) + four * 0.25);
        }
    }
}

struct AddForces<'a, F> {
    displacement: F,
    /// Of the body's points.
    out: &'a mut [Vec3],
}

impl<F: Fn(u32) -> Vec3> VisitPart for AddForces<'_, F> {
    fn part<const N: usize, C: Terms<N>>(&mut self, part: &Part<N, C>) {
        let gradients = part.constants.gradients(&part.nodes.map(&self.displacement));
        for (node, [two, three, four]) in part.nodes.iter().zip(gradients) {
            self.out[*node as usize] -= two + three + four;
        }
    }
}

struct AddDifferentials<'a, F, G> {
    displacement: F,
    variation: G,
    scale: f64,
    out: &'a mut [Vec3],
}

/// A vector with its rate.
fn varied(u: Vec3, rate: Vec3) -> Vec3<Dual> {
    Vec3::new(Dual::new(u.x, rate.x), Dual::new(u.y, rate.y), Dual::new(u.z, rate.z))
}

/// The rate of the sum over degrees.
fn rate([two, three, four]: ByDegree<Dual>) -> Vec3 {
    let sum = two + three + four;
    Vec3::new(sum.x.derivative, sum.y.derivative, sum.z.derivative)
}

impl<F: Fn(u32) -> Vec3, G: Fn(u32) -> Vec3> VisitPart for AddDifferentials<'_, F, G> {
    fn part<const N: usize, C: Terms<N>>(&mut self, part: &Part<N, C>) {
        let U = part.nodes.map(|node| varied((self.displacement)(node), (self.variation)(node)));
        for (node, gradient) in part.nodes.iter().zip(part.constants.gradients(&U)) {
            self.out[*node as usize] -= rate(gradient) * self.scale;
        }
    }
}

struct AddBlocks<'a, F> {
    displacement: F,
    first_row: u32,
    scale: f64,
    matrix: &'a mut BlockMatrix,
}

impl<F: Fn(u32) -> Vec3> VisitPart for AddBlocks<'_, F> {
    fn part<const N: usize, C: Terms<N>>(&mut self, part: &Part<N, C>) {
        let U = part.nodes.map(&self.displacement);
        let row = |own: usize| (self.first_row + part.nodes[own]) as usize;
        for q in 0..N {
            // columns of ∂²W/∂U_p∂U_q, by p
            let mut blocks = [Mat3::ZERO; N];
            for (axis, direction) in Mat3::IDENTITY.columns.into_iter().enumerate() {
                let U =
                    std::array::from_fn(|own| varied(U[own], if own == q { direction } else { Vec3::ZERO }));
                for (block, gradient) in blocks.iter_mut().zip(part.constants.gradients(&U)) {
                    block.columns[axis] = rate(gradient) * -self.scale;
                }
            }
            for (p, block) in blocks.iter().enumerate() {
                add_block(self.matrix, row(p), row(q), block);
            }
        }
    }
}

impl Force for TensorMass {
    fn name(&self) -> &str {
        &self.name
    }

    fn acts_within(&self) -> bool {
        true
    }

    fn declaration(&self) -> Declaration {
        Declaration { internal: self.is_objective, ..Declaration::ELASTIC }
    }

    fn energy(&self, at: &Configuration, _: &mut Scratch) -> Energy {
        let mut visit = SumEnergy { displacement: self.displacements(at.positions), sum: 0.0 };
        self.each_part(&mut visit);
        Energy { stored: visit.sum, dissipated: 0.0 }
    }

    fn add_force(&self, at: &Configuration, _: &mut Scratch, out: &mut [Vec3]) {
        let out = &mut out[self.first_row as usize..];
        self.each_part(&mut AddForces { displacement: self.displacements(at.positions), out });
    }

    fn add_differential(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        _: &mut Scratch,
        out: &mut [Vec3],
    ) {
        self.each_part(&mut AddDifferentials {
            displacement: self.displacements(at.positions),
            variation: |node: u32| delta[(self.first_row + node) as usize],
            scale: weights.position,
            out: &mut out[self.first_row as usize..],
        });
    }

    fn visit_cliques(&self, _: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        self.vertices.iter().for_each(|part| visit(&part.nodes.map(|node| self.first_row + node)));
        self.edges.iter().for_each(|part| visit(&part.nodes.map(|node| self.first_row + node)));
    }

    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        self.each_part(&mut AddBlocks {
            displacement: self.displacements(at.positions),
            first_row: self.first_row,
            scale: weights.position,
            matrix,
        });
    }

    fn cell_field(&self, cell: usize, positions: &[Vec3]) -> Option<CellField> {
        self.cells.field(cell, positions)
    }

    fn bytes(&self) -> usize {
        size_of_val(self.rest.as_slice())
            + self.cells.bytes()
            + size_of_val(self.vertices.as_slice())
            + size_of_val(self.edges.as_slice())
            + size_of_val(self.faces.as_slice())
            + size_of_val(self.tetrahedra.as_slice())
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
