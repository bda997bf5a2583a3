//! How elements lie in memory: chunks of neighbouring elements, in blocks of eight lanes.
//!
//! A chunk numbers its own nodes, sums the forces of its elements on them in element order, and hands the
//! partial sums to one gather over rows, in chunk order. Neither order depends on the number of threads.

use souple_math::{Mat3, Vec3};
use souple_mesh::{Cell, ElementKind, Mesh, QuadratureRule};

/// Elements side by side in a block.
pub const LANES: usize = 8;
/// Numbers per sample and element: the inverse of `∂X/∂ξ` by columns, then the volume.
pub const SAMPLE_LEN: usize = 10;

/// Samples a chunk holds at most, so that its data stay in the first-level cache.
const SAMPLES_PER_CHUNK: usize = 256;

/// Blocks of lanes that a chunk has at least, whatever their samples: what it does beside its samples, and lanes that are left empty where
/// its elements have two laws, count for little then.
const LEAST_BLOCKS: usize = 4;

/// Eight numbers side by side, on their own line of the cache: a load that straddles two costs double.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
pub struct LaneBlock(pub [f64; LANES]);

// SAFETY: eight `f64` fill the 64 bytes of the alignment; any bits are valid.
unsafe impl bytemuck::Zeroable for LaneBlock {}
// SAFETY: as above.
unsafe impl bytemuck::Pod for LaneBlock {}

/// A few hundred neighbouring samples.
#[derive(Clone, Debug)]
pub struct Chunk {
    /// Cell numbers of the body, ascending. Lane `l` of block `b` holds the `(l · block_count + b)`-th of them: neighbours
    /// in the list, which share nodes, stand in different blocks, so that sums on a node do not wait for
    /// each other.
    pub cells: Vec<u32>,
    /// Row of each of the chunk's nodes.
    pub rows: Vec<u32>,
    /// Chunk node of `(block, node, lane)`; lanes past the last element repeat it.
    pub connectivity: Vec<u16>,
    /// `[stored block][sample][SAMPLE_LEN][lane]`, see [`Self::stored`]; lanes past the last element have no volume.
    samples: Vec<LaneBlock>,
    /// Where all elements have one shape, how many blocks have as many of them as the first.
    full_blocks: Option<usize>,
    /// `[block][parameter][lane]`, or of one block that stands for all where all elements have the same numbers.
    parameters: Vec<LaneBlock>,
    has_one_material: bool,
    /// Where the chunk's nodes start among the partial sums.
    pub first_partial: usize,
    /// Among the chunks of all batches.
    pub number: usize,
}

impl Chunk {
    /// Samples without nodes, eight to a block, for laws alone: `(volume, parameters)` by block and lane. Lanes past the
    /// last sample have no volume.
    pub fn of_samples<'p>(blocks: usize, sample: impl Fn(usize, usize) -> (f64, &'p [f64])) -> Self {
        let parameters = |block, lane| sample(block, lane).1;
        let first = parameters(0, 0);
        let lanes = || (0..blocks).flat_map(|block| (0..LANES).map(move |lane| (block, lane)));
        let has_one_material = lanes().all(|(block, lane)| parameters(block, lane) == first);
        let mut chunk = Self {
            cells: Vec::new(),
            rows: Vec::new(),
            connectivity: Vec::new(),
            samples: vec![LaneBlock::default(); blocks * SAMPLE_LEN],
            full_blocks: None,
            parameters: vec![LaneBlock::default(); first.len() * if has_one_material { 1 } else { blocks }],
            has_one_material,
            first_partial: 0,
            number: 0,
        };
        for (block, lane) in lanes() {
            let (volume, numbers) = sample(block, lane);
            chunk.samples[(block + 1) * SAMPLE_LEN - 1].0[lane] = volume;
            if block == 0 || !has_one_material {
                for (i, number) in numbers.iter().enumerate() {
                    chunk.parameters[block * first.len() + i].0[lane] = *number;
                }
            }
        }
        chunk
    }

    /// The cells that `keep` names, one at least, on the same nodes; elements have `nodes` and `samples`.
    pub fn part(&self, nodes: usize, samples: usize, keep: impl Fn(u32) -> bool) -> Self {
        let slots: Vec<usize> = (0..self.cells.len()).filter(|slot| keep(self.cells[*slot])).collect();
        let blocks = slots.len().div_ceil(LANES);
        let (from_blocks, numbers) = (self.block_count(), samples * SAMPLE_LEN);
        let parameters = self.all_parameters(0).len();
        let parameter_blocks = if self.has_one_material { 1 } else { blocks };
        let mut part = Self {
            cells: slots.iter().map(|slot| self.cells[*slot]).collect(),
            rows: self.rows.clone(),
            connectivity: vec![0; blocks * nodes * LANES],
            samples: Vec::new(),
            full_blocks: self.full_blocks.map(|_| full_blocks(slots.len())),
            parameters: vec![LaneBlock::default(); parameter_blocks * parameters],
            has_one_material: self.has_one_material,
            ..*self
        };
        part.samples = match part.full_blocks {
            Some(_) => samples_of_one_shape(&self.samples[..numbers], slots.len()),
            None => vec![LaneBlock::default(); blocks * numbers],
        };
        for to in 0..blocks * LANES {
            let (lane, block) = (to / blocks, to % blocks);
            // lanes past the last element repeat it, without volume
            let from = slots[to.min(slots.len() - 1)];
            let (from_lane, from_block) = (from / from_blocks, from % from_blocks);
            for node in 0..nodes {
                part.connectivity[(block * nodes + node) * LANES + lane] =
                    self.connectivity[(from_block * nodes + node) * LANES + from_lane];
            }
            let own_numbers = if part.full_blocks.is_some() { 0 } else { numbers };
            for number in 0..own_numbers {
                let is_volume = number % SAMPLE_LEN == SAMPLE_LEN - 1;
                part.samples[block * numbers + number].0[lane] = if is_volume && to >= slots.len() {
                    0.0
                } else {
                    self.samples[from_block * numbers + number].0[from_lane]
                };
            }
            if block < parameter_blocks {
                let from_block = if self.has_one_material { 0 } else { from_block };
                for number in 0..parameters {
                    part.parameters[block * parameters + number].0[lane] =
                        self.parameters[from_block * parameters + number].0[from_lane];
                }
            }
        }
        part
    }

    pub fn block_count(&self) -> usize {
        self.cells.len().div_ceil(LANES)
    }

    /// Real elements in a block.
    pub fn lanes_in(&self, block: usize) -> usize {
        (self.cells.len() - block).div_ceil(self.block_count()).min(LANES)
    }

    /// Which of the blocks of samples is that of `block`: its own, or, of elements of one shape, the first, and the second where
    /// `block` has an element less than the first.
    #[inline(always)]
    fn stored(&self, block: usize) -> usize {
        match self.full_blocks {
            Some(full) => usize::from(block >= full),
            None => block,
        }
    }

    /// `[SAMPLE_LEN]` of a sample of a block, of `count` that each element has.
    #[inline(always)]
    pub fn sample(&self, block: usize, sample: usize, count: usize) -> &[LaneBlock] {
        let start = (self.stored(block) * count + sample) * SAMPLE_LEN;
        &self.samples[start..start + SAMPLE_LEN]
    }

    /// Asks for the numbers of a sample of a block, if there is one, before they are used: they are read once a pass from far
    /// away, and elements are done faster than the processor's own guesses bring them. Those of one shape are near.
    #[inline(always)]
    pub fn prefetch(&self, block: usize, sample: usize, count: usize) {
        if self.full_blocks.is_some() {
            return;
        }
        let start = (block * count + sample) * SAMPLE_LEN;
        if let Some(lines) = self.samples.get(start..start + SAMPLE_LEN) {
            for line in lines {
                souple_math::prefetch(line);
            }
        }
    }

    /// `X_ξ⁻¹` and the volume of the chunk's `slot`-th cell at a sample of `count`.
    pub fn sample_of(&self, slot: usize, sample: usize, count: usize) -> (Mat3, f64) {
        let (lane, block) = (slot / self.block_count(), slot % self.block_count());
        let numbers = self.sample(block, sample, count);
        let number = |i: usize| numbers[i].0[lane];
        let column = |i: usize| Vec3::new(number(3 * i), number(3 * i + 1), number(3 * i + 2));
        (Mat3::from_columns(column(0), column(1), column(2)), number(9))
    }

    /// The volume of the chunk's `slot`-th cell at a sample of `count`.
    pub fn volume_of(&self, slot: usize, sample: usize, count: usize) -> f64 {
        self.volumes(slot % self.block_count(), sample, count)[slot / self.block_count()]
    }

    /// Volumes of a sample of a block, of `count` that each element has.
    #[inline(always)]
    pub fn volumes(&self, block: usize, sample: usize, count: usize) -> &[f64; LANES] {
        &self.sample(block, sample, count)[SAMPLE_LEN - 1].0
    }

    /// The `count` parameters of a block's elements.
    #[inline(always)]
    pub fn parameters(&self, block: usize, count: usize) -> &[LaneBlock] {
        let block = if self.has_one_material { 0 } else { block };
        &self.parameters[block * count..(block + 1) * count]
    }

    /// All parameters of a block's elements.
    pub fn all_parameters(&self, block: usize) -> &[LaneBlock] {
        let blocks = if self.has_one_material { 1 } else { self.block_count() };
        self.parameters(block, self.parameters.len() / blocks)
    }

    pub fn bytes(&self) -> usize {
        4 * (self.cells.len() + self.rows.len())
            + 2 * self.connectivity.len()
            + size_of::<LaneBlock>() * (self.samples.len() + self.parameters.len())
    }
}

/// A cell that has no volume to compute with.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "{kind} cell {cell} is flat or inverted at rest: det ∂X/∂ξ = {determinant:e} at sample {sample}; it must be positive"
)]
pub struct FlatCell {
    pub kind: ElementKind,
    pub cell: u32,
    pub sample: usize,
    pub determinant: f64,
}

/// The body that cells are of.
pub struct Body<'a> {
    pub mesh: &'a Mesh,
    /// Row of the mesh's first point.
    pub first_row: usize,
    pub rule: &'a QuadratureRule,
    /// What makes a volume of the measure of a cell: 1, a thickness, the area of a cross-section.
    pub measure: f64,
}

/// What the cells of chunks have in common, and how many blocks of lanes a chunk has at least.
#[derive(Clone, Copy, Debug)]
pub struct Alike {
    /// All are translations of the first, but for rounding: the numbers of their samples are stored once.
    pub has_one_shape: bool,
    pub least_blocks: usize,
}

impl Alike {
    /// Cells of a kind, no more.
    pub const IN_KIND: Self = Self { has_one_shape: false, least_blocks: LEAST_BLOCKS };
}

/// Of `count` elements, how many blocks have as many as the first.
fn full_blocks(count: usize) -> usize {
    let blocks = count.div_ceil(LANES);
    count - (count.div_ceil(blocks) - 1) * blocks
}

/// Samples of the blocks that `count` elements of one shape store, from those of a block whose first lane has such an element.
fn samples_of_one_shape(of_block: &[LaneBlock], count: usize) -> Vec<LaneBlock> {
    let blocks = count.div_ceil(LANES);
    let lanes = count.div_ceil(blocks);
    let stored = if full_blocks(count) < blocks { 2 } else { 1 };
    let of_stored = |less: usize| {
        of_block.iter().enumerate().map(move |(number, of_lanes)| {
            let is_volume = number % SAMPLE_LEN == SAMPLE_LEN - 1;
            let is_empty = |lane| is_volume && lane >= lanes - less;
            LaneBlock(std::array::from_fn(|lane| if is_empty(lane) { 0.0 } else { of_lanes.0[0] }))
        })
    };
    (0..stored).flat_map(of_stored).collect()
}

/// Lays out `cells` (numbers, all of one kind) into chunks; `parameters_of` gives as many numbers for each.
///
/// # Errors
/// A cell is flat or inverted at a sample.
pub fn chunks<'p>(
    body: &Body,
    cells: &[u32],
    parameters_of: &dyn Fn(u32) -> &'p [f64],
    alike: Alike,
    first_partial: usize,
) -> Result<Vec<Chunk>, FlatCell> {
    let per_chunk = (SAMPLES_PER_CHUNK / body.rule.points.len() / LANES).max(alike.least_blocks) * LANES;
    // compact chunks share few nodes with others: fewer partial sums, positions that stay in cache
    let order = {
        let centres: Vec<Vec3> = cells.iter().map(|cell| body.centre(*cell)).collect();
        souple_mesh::recursive_bisection(&centres, per_chunk)
    };
    let mut next_partial = first_partial;
    let mut members = Vec::with_capacity(per_chunk);
    let mut chunks = Vec::with_capacity(cells.len().div_ceil(per_chunk));
    for numbers in order.chunks(per_chunk) {
        members.clear();
        members.extend(numbers.iter().map(|index| cells[*index as usize]));
        let chunk = lay_out(body, &members, parameters_of, alike.has_one_shape, next_partial)?;
        next_partial += chunk.rows.len();
        chunks.push(chunk);
    }
    Ok(chunks)
}

impl Body<'_> {
    fn cell(&self, cell: u32) -> Cell<'_> {
        self.mesh.cell(cell).unwrap_or_else(|| unreachable!("cells are numbers of the mesh's own"))
    }

    fn centre(&self, cell: u32) -> Vec3 {
        let nodes = self.cell(cell).nodes;
        nodes.iter().map(|node| self.mesh.points[*node as usize]).sum::<Vec3>() * (1.0 / nodes.len() as f64)
    }
}

fn lay_out<'p>(
    body: &Body,
    members: &[u32],
    parameters_of: &dyn Fn(u32) -> &'p [f64],
    has_one_shape: bool,
    first_partial: usize,
) -> Result<Chunk, FlatCell> {
    let Body { mesh, first_row, rule, measure } = body;
    let kind = body.cell(members[0]).kind;
    let row = |node: &u32| node + *first_row as u32;
    let nodes = kind.node_count();
    let mut rows: Vec<u32> = members.iter().flat_map(|cell| body.cell(*cell).nodes.iter().map(row)).collect();
    rows.sort_unstable();
    rows.dedup();
    rows.shrink_to_fit();
    let blocks = members.len().div_ceil(LANES);
    let parameter_count = parameters_of(members[0]).len();
    let has_one_material = members.iter().all(|cell| parameters_of(*cell) == parameters_of(members[0]));
    let parameter_blocks = if has_one_material { 1 } else { blocks };
    let numbers = rule.points.len() * SAMPLE_LEN;
    let mut chunk = Chunk {
        cells: members.to_vec(),
        connectivity: vec![0; blocks * nodes * LANES],
        samples: vec![LaneBlock::default(); if has_one_shape { numbers } else { blocks * numbers }],
        full_blocks: has_one_shape.then(|| full_blocks(members.len())),
        parameters: vec![LaneBlock::default(); parameter_blocks * parameter_count],
        has_one_material,
        rows,
        first_partial,
        number: 0,
    };
    let mut corners = [Vec3::ZERO; souple_mesh::MAX_NODES];
    for slot in 0..blocks * LANES {
        let (lane, block) = (slot / blocks, slot % blocks);
        let cell = members[slot.min(members.len() - 1)];
        let cell_nodes = body.cell(cell).nodes;
        for (a, node) in cell_nodes.iter().enumerate() {
            let local =
                chunk.rows.binary_search(&row(node)).unwrap_or_else(|_| unreachable!("collected above"));
            chunk.connectivity[(block * nodes + a) * LANES + lane] = local as u16;
        }
        if block < parameter_blocks {
            for (i, number) in parameters_of(cell).iter().enumerate() {
                chunk.parameters[block * parameter_count + i].0[lane] = *number;
            }
        }
        if has_one_shape && slot > 0 {
            continue;
        }
        let corners = mesh.positions_into(cell_nodes, &mut corners);
        for (sample, point) in rule.points.iter().enumerate() {
            let jacobian = kind.jacobian(corners, point.position);
            let determinant = jacobian.determinant();
            let inverse = jacobian.try_inverse().filter(|inverse| determinant > 0.0 && inverse.is_finite());
            let inverse = inverse.ok_or(FlatCell { kind, cell, sample, determinant })?;
            let volume = if slot < members.len() { determinant * point.weight * measure } else { 0.0 };
            let at = (block * rule.points.len() + sample) * SAMPLE_LEN;
            for (i, number) in entries(&inverse).chain([volume]).enumerate() {
                chunk.samples[at + i].0[lane] = number;
            }
        }
    }
    if has_one_shape {
        chunk.samples = samples_of_one_shape(&chunk.samples, members.len());
    }
    Ok(chunk)
}

fn entries(matrix: &Mat3) -> impl Iterator<Item = f64> {
    matrix.columns.into_iter().flat_map(|column| column.to_array())
}

#[cfg(test)]
mod tests {
    use souple_table::{Value, Values};

    use super::*;

    /// Chunks of a row of cells, whatever they are divided into, and parts of them.
    fn chunks_of_row(count: usize, has_one_shape: bool) -> Vec<Chunk> {
        let row = Value::Vector([count as f64, 1.0, 1.0]);
        let values = Values::new().with("size", row).with("cells", row).with("element", Value::Text("hex8"));
        let mesh = souple_mesh::generate("bar", values).unwrap();
        let cells: Vec<u32> = (0..count as u32).collect();
        let body = Body { mesh: &mesh, first_row: 0, rule: ElementKind::Hex8.default_rule(), measure: 1.0 };
        let alike = Alike { has_one_shape, ..Alike::IN_KIND };
        let whole = chunks(&body, &cells, &|_| &[], alike, 0).unwrap();
        let parts = [2, 3, 5].into_iter().flat_map(|nth| {
            let of_chunk = move |chunk: &Chunk| {
                let first = chunk.cells[0];
                chunk.part(8, 8, |cell| cell == first || cell % nth == 0)
            };
            whole.iter().map(of_chunk)
        });
        parts.chain(whole.iter().cloned()).collect()
    }

    #[test]
    fn cells_of_one_shape_have_the_samples_of_their_own() {
        for count in 1..70 {
            for (alone, alike) in chunks_of_row(count, false).iter().zip(&chunks_of_row(count, true)) {
                assert_eq!((&alone.cells, &alone.connectivity), (&alike.cells, &alike.connectivity));
                for block in 0..alone.block_count() {
                    for sample in 0..8 {
                        let [of_alone, of_alike] = [alone, alike].map(|chunk| chunk.sample(block, sample, 8));
                        let pairs = of_alone.iter().zip(of_alike).flat_map(|(a, b)| a.0.into_iter().zip(b.0));
                        for (own, shared) in pairs {
                            // a few roundings of the largest coordinate
                            let is_like = (own - shared).abs() <= 8.0 * f64::EPSILON * count as f64;
                            assert!(is_like, "{count} cells: {own} {shared}");
                        }
                    }
                }
                assert!(alike.samples.len() <= 2 * 8 * SAMPLE_LEN);
            }
        }
    }
}
