//! Cells of a linear law by their stiffness: one matrix for all cells of one shape and material.
//!
//! Where the stress is linear in `F - I` the force of a cell is `f_a = -Σ_b K_ab u_b`, with the displacements `u` and the
//! constant `K_ab = Σ_s V_s ∂P/∂F : (∇N_a, ∇N_b)`. Cells that are each other's translations have the same `K`, so a
//! regular mesh has a few, and they stay in the nearest cache. A translation of the whole cell strains nothing: with
//! `u_a - u_0` the rows and columns of the first node need not be multiplied, and its force is what balances the others'.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use pulp::{Arch, Simd, WithSimd};
use souple_math::{Lanes, Padded, Real, Vec3};
use souple_mesh::{ElementKind, MAX_NODES, Mesh};

use super::elements::reference_gradients;
use super::geometry::accumulate;
use super::group::{Group, for_each_group};
use super::kernel::Kernel;
use super::layout::{self, Alike, Body, Chunk, FlatCell, LANES};
use super::{Section, SolidDescription};
use crate::materials::MaterialLaw;

/// Fewer cells of one shape are not worth a batch of their own, which has chunks of its own and ends each with lanes that are not full.
const LEAST_CELLS: usize = 8 * LANES;

/// The most frequent shapes; all of a regular mesh, whose cubes are cut into six, and of one graded over some sizes.
const MOST_SHAPES: usize = 64;

/// Arms of cells of one shape may differ by as many roundings of the largest coordinate. A generator's point is a sum of a product and
/// of an origin, a placed one has been turned and moved besides: three or four roundings of either end.
const ROUNDINGS: f64 = 16.0;

/// But by no more of the size of the cell, however far it is from the origin: so much of a force is lost at most.
const ALIKE: f64 = 1e-9;

/// Shapes are first told apart by numbers of this fraction of their size: far above what they may differ by, so that cells of one shape
/// hardly ever fall to both sides of a bound, and far below what tells shapes apart.
const COARSE: f64 = 1.0 / 1_048_576.0;

/// Which cells are the same but for where they stand.
#[derive(Default)]
pub struct Shapes {
    /// By cell; `None` where few are like it.
    of_cell: Vec<Option<u32>>,
}

/// Kind and material of a cell and, coarsely, where its nodes are.
type Key = (ElementKind, u16, Vec<i64>);

impl Shapes {
    /// Of the cells whose law is linear.
    pub fn of_linear(description: &SolidDescription) -> Self {
        let SolidDescription { mesh, materials, material_of_cell, axes, section, .. } = description;
        // cells of one shape may have different axes
        let is_alike = |law: &MaterialLaw| axes.is_empty() || matches!(law, MaterialLaw::Known(_));
        let is_linear: Vec<bool> =
            materials.iter().map(|material| material.law.is_linear() && is_alike(&material.law)).collect();
        if *section != Section::Solid || !is_linear.contains(&true) {
            return Self::default();
        }
        Self::of(mesh, material_of_cell, |material| is_linear[usize::from(material)])
    }

    fn of(mesh: &Mesh, material_of_cell: &[u16], is_linear: impl Fn(u16) -> bool) -> Self {
        let largest = mesh.points.iter().map(|point| point.largest_component()).fold(0.0, f64::max);
        let tolerance = ROUNDINGS * f64::EPSILON * largest;
        // of the same key: the first cell of each shape, and the shape's number
        let mut known: HashMap<Key, Vec<(u32, u32)>> = HashMap::new();
        let mut counts: Vec<usize> = Vec::new();
        let mut of_cell = vec![None; mesh.cell_count()];
        for (index, (cell, material)) in mesh.cells().zip(material_of_cell).enumerate() {
            if !is_linear(*material) || !pays(cell.kind) {
                continue;
            }
            let key = (cell.kind, *material, coarse(arms(mesh, cell.nodes)));
            let alike = known.entry(key).or_default();
            let is_like = |(first, _): &&(u32, u32)| {
                let first = mesh.cell(*first).unwrap_or_else(|| unreachable!("a cell of the mesh"));
                let tolerance = tolerance.min(ALIKE * size(arms(mesh, cell.nodes)));
                let mut pairs = arms(mesh, first.nodes).zip(arms(mesh, cell.nodes));
                pairs.all(|(a, b)| (a - b).largest_component() <= tolerance)
            };
            let shape = if let Some((_, shape)) = alike.iter().find(is_like) {
                *shape
            } else {
                let shape = counts.len() as u32;
                alike.push((index as u32, shape));
                counts.push(0);
                shape
            };
            counts[shape as usize] += 1;
            of_cell[index] = Some(shape);
        }
        let mut frequent: Vec<u32> = (0..counts.len() as u32).collect();
        frequent.sort_by_key(|shape| std::cmp::Reverse(counts[*shape as usize]));
        frequent.truncate(MOST_SHAPES);
        frequent.retain(|shape| counts[*shape as usize] >= LEAST_CELLS);
        for shape in &mut of_cell {
            *shape = shape.filter(|shape| frequent.contains(shape));
        }
        Self { of_cell }
    }

    /// The number of a cell's shape.
    pub fn of_cell(&self, cell: usize) -> Option<u32> {
        self.of_cell.get(cell).copied().flatten()
    }
}

/// Whether a product with the matrix takes less than the samples: on all elements but those with one sample.
fn pays(kind: ElementKind) -> bool {
    kind.dimension() == 3 && kind.default_rule().points.len() > 1
}

/// From the first node to the others.
fn arms<'a>(mesh: &'a Mesh, nodes: &'a [u32]) -> impl Iterator<Item = Vec3> + Clone + 'a {
    let point = |node: &u32| mesh.points[*node as usize];
    nodes[1..].iter().map(move |node| point(node) - point(&nodes[0]))
}

fn size(arms: impl Iterator<Item = Vec3>) -> f64 {
    arms.map(|arm| arm.largest_component()).fold(0.0, f64::max)
}

/// Where they end, coarsely.
fn coarse(arms: impl Iterator<Item = Vec3> + Clone) -> Vec<i64> {
    // in powers of two, which rounding of the size does not change but near a bound: 1.37 keeps halves and quarters of a metre,
    // tenths and thirds from these
    let quantum = COARSE * (1.37 * size(arms.clone())).log2().floor().exp2();
    arms.flat_map(|arm| arm.to_array().map(|number| (number / quantum).round() as i64)).collect()
}

/// The stiffness of one shape and material.
pub struct Stiffness {
    nodes: usize,
    /// From the first node to each, at rest.
    rest: Vec<Vec3>,
    /// `K_ab` by columns of all nodes but the first, `[a][b]`.
    matrix: Vec<[f64; 9]>,
    /// `-K_ab` with `a ≤ b` of all nodes.
    blocks: Vec<[f64; 9]>,
}

impl Stiffness {
    /// Of one cell, by the samples of a law.
    ///
    /// # Errors
    /// The cell is flat or inverted at a sample.
    pub fn new(body: &Body, cell: u32, parameters: &[f64], law: &dyn Kernel) -> Result<Self, FlatCell> {
        let of_mesh = body.mesh.cell(cell).unwrap_or_else(|| unreachable!("a cell of the mesh"));
        let nodes = of_mesh.nodes.len();
        let chunks = layout::chunks(body, &[cell], &|_| parameters, Alike::IN_KIND, 0)?;
        let chunk = &chunks[0];
        let own_rows: Vec<Padded> = chunk
            .rows
            .iter()
            .map(|row| Padded::from(body.mesh.points[*row as usize - body.first_row]))
            .collect();
        let mut lanes = vec![0.0; 9 * nodes * (nodes + 1) / 2 * LANES];
        law.blocks(chunk, 0..1, &reference_gradients(of_mesh.kind, body.rule), &own_rows, 1.0, &mut lanes);
        let of_pair = |pair: &[f64]| std::array::from_fn(|entry| pair[entry * LANES]);
        let blocks: Vec<[f64; 9]> = lanes.chunks_exact(9 * LANES).map(of_pair).collect();
        let transposed = |k: [f64; 9]| std::array::from_fn(|entry| k[3 * (entry % 3) + entry / 3]);
        let mut matrix = Vec::with_capacity((nodes - 1) * (nodes - 1));
        for a in 1..nodes {
            for b in 1..nodes {
                let (low, high) = (a.min(b), a.max(b));
                let block = blocks[low * nodes - low * (low + 1) / 2 + high].map(|number: f64| -number);
                matrix.push(if a <= b { block } else { transposed(block) });
            }
        }
        Ok(Self { nodes, rest: arms(body.mesh, of_mesh.nodes).collect(), matrix, blocks })
    }
}

/// The kernel of the cells that have a stiffness.
pub fn kernel(stiffness: Arc<Stiffness>) -> Box<dyn Kernel> {
    match stiffness.nodes {
        5 => Box::new(Shared::<5>(stiffness)),
        6 => Box::new(Shared::<6>(stiffness)),
        8 => Box::new(Shared::<8>(stiffness)),
        _ => Box::new(Shared::<MAX_NODES>(stiffness)),
    }
}

/// [`Kernel`] of cells with one stiffness, of at most `N` nodes.
struct Shared<const N: usize>(Arc<Stiffness>);

impl<const N: usize> Shared<N> {
    fn loops<'a>(&'a self, chunk: &'a Chunk, field: &'a [Padded], is_moved: bool) -> Loops<'a, N> {
        Loops { of: &self.0, chunk, field, is_moved }
    }
}

impl<const N: usize> Kernel for Shared<N> {
    fn forces(&self, chunk: &Chunk, _: &[Vec3], positions: &[Padded], forces: &mut [Padded]) {
        Arch::new().dispatch(Forces { loops: self.loops(chunk, positions, true), scale: 1.0, forces });
    }

    fn differential(
        &self,
        chunk: &Chunk,
        _: &[Vec3],
        _: &[Padded],
        delta: &[Padded],
        scale: f64,
        forces: &mut [Padded],
    ) {
        Arch::new().dispatch(Forces { loops: self.loops(chunk, delta, false), scale, forces });
    }

    fn energy(&self, chunk: &Chunk, _: &[Vec3], positions: &[Padded]) -> f64 {
        0.5 * Arch::new().dispatch(Form(self.loops(chunk, positions, true)))
    }

    fn quadratic_form(&self, chunk: &Chunk, _: &[Vec3], _: &[Padded], delta: &[Padded]) -> f64 {
        Arch::new().dispatch(Form(self.loops(chunk, delta, false)))
    }

    fn blocks(&self, _: &Chunk, blocks: Range<usize>, _: &[Vec3], _: &[Padded], scale: f64, out: &mut [f64]) {
        let numbers = self.0.blocks.iter().flatten();
        for out in out.chunks_exact_mut(9 * self.0.blocks.len() * LANES).take(blocks.len()) {
            for (number, lanes) in numbers.clone().zip(out.chunks_exact_mut(LANES)) {
                lanes.fill(scale * number);
            }
        }
    }
}

/// What the products with the matrix have in common.
struct Loops<'a, const N: usize> {
    of: &'a Stiffness,
    chunk: &'a Chunk,
    /// By node of the chunk.
    field: &'a [Padded],
    /// Whether the field is of positions, and displacements are wanted.
    is_moved: bool,
}

impl<const N: usize> Loops<'_, N> {
    /// Nodes, where their number is known ahead.
    #[inline(always)]
    fn nodes(&self) -> usize {
        if N == MAX_NODES { self.of.nodes } else { N }
    }

    /// The field at the nodes less that at the first.
    #[inline(always)]
    fn relative<S: Simd>(&self, group: &Group<'_, S, N>) -> [Vec3<Lanes<S>>; N] {
        let first = group.gather_node(self.field, 0);
        let mut out = group.zeros();
        for a in 1..self.nodes() {
            out[a] = group.gather_node(self.field, a) - first;
            if self.is_moved {
                let rest = self.of.rest[a - 1];
                let like = first.x;
                out[a] -= Vec3::new(like.splat(rest.x), like.splat(rest.y), like.splat(rest.z));
            }
        }
        out
    }

    /// `Σ_b K_ab u_b`.
    #[inline(always)]
    fn row<S: Simd>(&self, a: usize, u: &[Vec3<Lanes<S>>; N]) -> Vec3<Lanes<S>> {
        let like = u[0].x;
        let mut sum = Vec3::new(like.zero(), like.zero(), like.zero());
        let others = self.nodes() - 1;
        let row = &self.of.matrix[(a - 1) * others..a * others];
        for b in 0..others {
            let k = &row[b];
            let of_column = |i: usize| {
                Vec3::new(like.splat(k[3 * i]), like.splat(k[3 * i + 1]), like.splat(k[3 * i + 2]))
            };
            accumulate(&mut sum, of_column(0), u[b + 1].x);
            accumulate(&mut sum, of_column(1), u[b + 1].y);
            accumulate(&mut sum, of_column(2), u[b + 1].z);
        }
        sum
    }

    /// `number` in lanes of cells, zero in those past the last cell.
    #[inline(always)]
    fn of_cells<S: Simd>(&self, group: &Group<'_, S, N>, number: f64) -> Lanes<S> {
        let mut lanes = [number; LANES];
        for lane in &mut lanes[self.chunk.lanes_in(group.block)..] {
            *lane = 0.0;
        }
        Lanes::load(group.simd, &lanes[group.lane..])
    }
}

struct Forces<'a, const N: usize> {
    loops: Loops<'a, N>,
    scale: f64,
    forces: &'a mut [Padded],
}

impl<const N: usize> WithSimd for Forces<'_, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { loops, scale, forces } = self;
        let (chunk, nodes) = (loops.chunk, loops.nodes());
        for_each_group!(simd, chunk, nodes, 1, 0..chunk.block_count(), N, |group| {
            let u = loops.relative(&group);
            let factor = loops.of_cells(&group, -scale);
            let zero = factor.zero();
            let mut first = Vec3::new(zero, zero, zero);
            for a in 1..nodes {
                let force = loops.row(a, &u) * factor;
                first -= force;
                group.scatter_node(a, force, forces);
            }
            group.scatter_node(0, first, forces);
        });
    }
}

/// `uᵀ K u`.
struct Form<'a, const N: usize>(Loops<'a, N>);

impl<const N: usize> WithSimd for Form<'_, N> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let loops = self.0;
        let (chunk, nodes) = (loops.chunk, loops.nodes());
        let mut sum = 0.0;
        for_each_group!(simd, chunk, nodes, 1, 0..chunk.block_count(), N, |group| {
            let u = loops.relative(&group);
            let mut form = u[0].x.zero();
            for a in 1..nodes {
                form += loops.row(a, &u).dot(u[a]);
            }
            sum += group.sum(form * loops.of_cells(&group, 1.0));
        });
        sum
    }
}
