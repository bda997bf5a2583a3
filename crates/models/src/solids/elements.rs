//! The elements of a body as kernels take them: batches of one kind and law, chunk after chunk, and the way from
//! sums on chunks' own nodes back to rows.

use std::cell::RefCell;
use std::ops::Range;

use rayon::prelude::*;
use souple_math::{Padded, Vec3};
use souple_mesh::{ElementKind, QuadratureRule};

use super::layout::{self, Alike, Chunk, FlatCell, LANES};
use super::{SolidDescription, parallel};

/// Rows gathered by one task.
const ROWS_PER_TASK: usize = 2048;

/// Elements with kernels `K`.
pub struct Elements<K> {
    batches: Vec<Batch<K>>,
    chunk_count: usize,
    partial_count: usize,
    /// For each row of the body, the partial sums of chunks that it gathers, in chunk order.
    gather: Gather,
    rows: Range<usize>,
}

/// The elements of one kind and law.
pub struct Batch<K> {
    pub kind: ElementKind,
    pub kernel: K,
    /// `∂N_a/∂ξ`, sample after sample.
    pub reference: Vec<Vec3>,
    /// Blocks of lanes whose matrices are computed together.
    pub blocks_at_once: usize,
    /// Number of the first chunk among those of all batches.
    first_chunk: usize,
    chunks: Vec<Chunk>,
}

/// Compressed lists: `slots[starts[r] .. starts[r + 1]]` of row `r`.
#[derive(Default)]
struct Gather {
    starts: Vec<u32>,
    slots: Vec<u32>,
}

/// What elements of a batch have in common, and the numbers of each.
pub trait Sorting {
    type Law: PartialEq;
    type Kernel;
    fn law_of(&self, cell: usize) -> &Self::Law;
    /// Numbers of a cell, as many for every cell of its law.
    fn parameters_of(&self, cell: usize) -> &[f64];
    fn kernel(&self, kind: ElementKind, rule: &QuadratureRule, law: &Self::Law) -> Self::Kernel;
    /// What the cells of a law have in common besides.
    fn alike(&self, _law: &Self::Law) -> Alike {
        Alike::IN_KIND
    }
    /// How many blocks of lanes a kernel likes to be asked for at once.
    fn blocks_at_once(&self, _kernel: &Self::Kernel) -> usize {
        1
    }
}

thread_local! {
    /// A chunk's own rows, gathered.
    static OWN_ROWS: RefCell<[Vec<Padded>; 3]> = const { RefCell::new([const { Vec::new() }; 3]) };
    /// The sums on them.
    static OWN_SUMS: RefCell<Vec<Padded>> = const { RefCell::new(Vec::new()) };
}

impl<K: Send + Sync> Elements<K> {
    /// # Errors
    /// A cell is flat or inverted at rest.
    pub fn new(description: &SolidDescription, sorting: &impl Sorting<Kernel = K>) -> Result<Self, FlatCell> {
        let SolidDescription { mesh, first_row, quadrature, section, .. } = description;
        let rows = *first_row..*first_row + mesh.points.len();
        let mut found: Vec<(ElementKind, &_, Vec<u32>)> = Vec::new();
        for (index, cell) in mesh.cells().enumerate() {
            let law = sorting.law_of(index);
            let known = found.iter_mut().find(|(kind, of_kind, _)| *kind == cell.kind && *of_kind == law);
            match known {
                Some((_, _, cells)) => cells.push(index as u32),
                None => found.push((cell.kind, law, vec![index as u32])),
            }
        }
        let mut elements = Self {
            batches: Vec::new(),
            chunk_count: 0,
            partial_count: 0,
            gather: Gather::default(),
            rows: rows.clone(),
        };
        for (kind, law, cells) in found {
            let body = layout::Body {
                mesh,
                first_row: *first_row,
                rule: quadrature.rule(kind),
                measure: section.measure(),
            };
            let parameters_of = |cell: u32| sorting.parameters_of(cell as usize);
            let mut chunks =
                layout::chunks(&body, &cells, &parameters_of, sorting.alike(law), elements.partial_count)?;
            (elements.chunk_count..).zip(&mut chunks).for_each(|(number, chunk)| chunk.number = number);
            elements.partial_count += chunks.iter().map(|chunk| chunk.rows.len()).sum::<usize>();
            let first_chunk = elements.chunk_count;
            elements.chunk_count += chunks.len();
            let (kernel, reference) =
                (sorting.kernel(kind, body.rule, law), reference_gradients(kind, body.rule));
            let blocks_at_once = sorting.blocks_at_once(&kernel);
            elements.batches.push(Batch { kind, kernel, reference, blocks_at_once, first_chunk, chunks });
        }
        elements.gather = Gather::new(&rows, &elements.batches);
        Ok(elements)
    }

    pub fn rows(&self) -> Range<usize> {
        self.rows.clone()
    }

    pub fn chunk_count(&self) -> usize {
        self.chunk_count
    }

    pub fn chunks(&self) -> impl Iterator<Item = (&Batch<K>, &Chunk)> {
        self.batches.iter().flat_map(|batch| batch.chunks.iter().map(move |chunk| (batch, chunk)))
    }

    /// A chunk by its number among those of all batches.
    pub fn chunk(&self, number: usize) -> (&Batch<K>, &Chunk) {
        let batch = self.batches.partition_point(|batch| batch.first_chunk <= number) - 1;
        let batch = &self.batches[batch];
        (batch, &batch.chunks[number - batch.first_chunk])
    }

    /// Runs `work` on every chunk with its own rows of `inputs` and sums on them, then adds the sums to
    /// `out`; `partials` is scratch.
    pub fn add_sums<const I: usize>(
        &self,
        inputs: [&[Vec3]; I],
        partials: &mut Vec<Vec3>,
        out: &mut [Vec3],
        work: impl Fn(&Batch<K>, &Chunk, [&[Padded]; I], &mut [Padded]) + Sync,
    ) {
        self.fill_partials(inputs, partials, work);
        self.gather_partials(partials, &mut out[self.rows.clone()], |out, sum| *out += sum);
    }

    /// What `work` sums on every chunk's own rows.
    pub fn fill_partials<const I: usize>(
        &self,
        inputs: [&[Vec3]; I],
        partials: &mut Vec<Vec3>,
        work: impl Fn(&Batch<K>, &Chunk, [&[Padded]; I], &mut [Padded]) + Sync,
    ) {
        partials.resize(self.partial_count, Vec3::ZERO);
        let start_of = |number: usize| {
            if number == self.chunk_count { self.partial_count } else { self.chunk(number).1.first_partial }
        };
        parallel::fill(0..self.chunk_count, parallel::LIGHT, partials, &start_of, &|number, sums| {
            let (batch, chunk) = self.chunk(number);
            OWN_SUMS.with_borrow_mut(|own| {
                own.clear();
                own.resize(sums.len(), Padded::default());
                chunk.with_own_rows(inputs, |inputs| work(batch, chunk, inputs, own));
                sums.iter_mut().zip(own).for_each(|(sum, own)| *sum = Vec3::from(*own));
            });
        });
    }

    /// Calls `add(out[row], Σ of its partial sums in chunk order)` for every row of the body.
    pub fn gather_partials<T: Send>(
        &self,
        partials: &[Vec3],
        out: &mut [T],
        add: impl Fn(&mut T, Vec3) + Sync,
    ) {
        let gather_rows = |(task, rows): (usize, &mut [T])| {
            for (offset, row) in rows.iter_mut().enumerate() {
                let mut sum = Vec3::ZERO;
                for slot in self.gather.of(task * ROWS_PER_TASK + offset) {
                    sum += partials[*slot as usize];
                }
                add(row, sum);
            }
        };
        if out.len() >= 2 * ROWS_PER_TASK && rayon::current_num_threads() > 1 {
            out.par_chunks_mut(ROWS_PER_TASK).enumerate().for_each(gather_rows);
        } else {
            out.chunks_mut(ROWS_PER_TASK).enumerate().for_each(gather_rows);
        }
    }

    /// The sum over chunks of what `work` makes of their own rows of `inputs`.
    pub fn sum<const I: usize>(
        &self,
        inputs: [&[Vec3]; I],
        work: impl Fn(&Batch<K>, &Chunk, [&[Padded]; I]) -> f64 + Sync,
    ) -> f64 {
        parallel::sum(0..self.chunk_count, &|number| {
            let (batch, chunk) = self.chunk(number);
            chunk.with_own_rows(inputs, |inputs| work(batch, chunk, inputs))
        })
    }

    /// The number of each cell's chunk, of `count` cells in all.
    pub fn chunk_of_cell(&self, count: usize) -> Vec<u32> {
        let mut numbers = vec![0; count];
        for (number, (_, chunk)) in self.chunks().enumerate() {
            chunk.cells.iter().for_each(|cell| numbers[*cell as usize] = number as u32);
        }
        numbers
    }

    /// Calls `visit` with the rows of every element.
    pub fn visit_cliques(&self, visit: &mut dyn FnMut(&[u32])) {
        let mut rows = Vec::new();
        for (batch, chunk) in self.chunks() {
            for slot in 0..chunk.cells.len() {
                rows.clear();
                rows.extend(chunk.rows_of(slot, batch.kind.node_count()));
                visit(&rows);
            }
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let batches = self.batches.iter().map(|batch| {
            size_of::<Batch<K>>()
                + size_of_val(batch.reference.as_slice())
                + batch.chunks.iter().map(|chunk| size_of::<Chunk>() + chunk.bytes()).sum::<usize>()
        });
        batches.sum::<usize>() + 4 * (self.gather.starts.capacity() + self.gather.slots.capacity())
    }
}

/// `∂N_a/∂ξ`, sample after sample.
pub fn reference_gradients(kind: ElementKind, rule: &QuadratureRule) -> Vec<Vec3> {
    rule.points
        .iter()
        .flat_map(|point| kind.shape_gradients(point.position).iter().copied().collect::<Vec<_>>())
        .collect()
}

impl Gather {
    fn new<K>(rows: &Range<usize>, batches: &[Batch<K>]) -> Self {
        let chunks = || batches.iter().flat_map(|batch| &batch.chunks);
        // counted, then placed: no list per row
        let mut starts = vec![0u32; rows.len() + 1];
        for row in chunks().flat_map(|chunk| &chunk.rows) {
            starts[*row as usize - rows.start + 1] += 1;
        }
        for row in 0..rows.len() {
            starts[row + 1] += starts[row];
        }
        let mut slots = vec![0; starts[rows.len()] as usize];
        for chunk in chunks() {
            for (local, row) in chunk.rows.iter().enumerate() {
                let next = &mut starts[*row as usize - rows.start];
                slots[*next as usize] = (chunk.first_partial + local) as u32;
                *next += 1;
            }
        }
        // each start has moved to where the next one began
        starts.rotate_right(1);
        starts[0] = 0;
        Self { starts, slots }
    }

    fn of(&self, row: usize) -> &[u32] {
        &self.slots[self.starts[row] as usize..self.starts[row + 1] as usize]
    }
}

impl Chunk {
    /// Calls `work` with the chunk's rows of each input, side by side.
    pub fn with_own_rows<const I: usize, T>(
        &self,
        inputs: [&[Vec3]; I],
        work: impl FnOnce([&[Padded]; I]) -> T,
    ) -> T {
        OWN_ROWS.with_borrow_mut(|buffers| {
            for (own, values) in buffers.iter_mut().zip(inputs) {
                own.clear();
                own.extend(self.rows.iter().map(|row| Padded::from(values[*row as usize])));
            }
            work(std::array::from_fn(|i| buffers[i].as_slice()))
        })
    }

    /// Rows of the nodes of the chunk's `slot`-th cell.
    pub fn rows_of(&self, slot: usize, nodes: usize) -> impl Iterator<Item = u32> {
        let (lane, block) = (slot / self.block_count(), slot % self.block_count());
        (0..nodes).map(move |a| self.rows[self.connectivity[(block * nodes + a) * LANES + lane] as usize])
    }
}
