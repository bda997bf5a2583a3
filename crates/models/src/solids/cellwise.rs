//! Sums over the cells of a body, shared among threads: parts on the nodes of every cell first, gathered row by row then, in the same
//! order for any number of threads.

use std::cell::RefCell;
use std::ops::Range;

use rayon::prelude::*;
use souple_engine::Curvature;
use souple_engine::tangent::add_block;
use souple_math::{Mat3, Vec3};
use souple_mesh::Mesh;
use souple_solve::BlockMatrix;
use souple_solve::dense::{self, take_absolute};

use super::parallel;

/// Cells that one thread takes together.
const CELLS_PER_CHUNK: usize = 16;
/// Rows gathered by one task.
const ROWS_PER_TASK: usize = 2048;
/// Cells whose blocks are held at once.
const CELLS_PER_SLAB: usize = 512;

thread_local! {
    /// The matrix of one cell.
    static CELL: RefCell<(Vec<f64>, dense::Workspace)> = RefCell::default();
}

/// The rows of the nodes of cells, and where each row stands among them.
pub struct Cellwise {
    /// `rows[starts[c] .. starts[c + 1]]` are those of cell `c`.
    starts: Vec<u32>,
    rows: Vec<u32>,
    /// Rows of the body, and `places[row_starts[r] .. row_starts[r + 1]]`, the places in `rows` of its `r`-th, in the order of cells.
    body: Range<usize>,
    row_starts: Vec<u32>,
    places: Vec<u32>,
}

impl Cellwise {
    /// Point `i` of the mesh is row `first_row + i`.
    pub fn new(mesh: &Mesh, first_row: usize) -> Self {
        let body = first_row..first_row + mesh.points.len();
        let (mut starts, mut rows) = (vec![0], Vec::new());
        for cell in mesh.cells() {
            rows.extend(cell.nodes.iter().map(|node| first_row as u32 + node));
            starts.push(rows.len() as u32);
        }
        // counted, then placed
        let mut row_starts = vec![0; body.len() + 1];
        for row in &rows {
            row_starts[*row as usize - body.start + 1] += 1;
        }
        for row in 0..body.len() {
            row_starts[row + 1] += row_starts[row];
        }
        let (mut next, mut places) = (row_starts.clone(), vec![0; rows.len()]);
        for (place, row) in rows.iter().enumerate() {
            let next = &mut next[*row as usize - body.start];
            places[*next as usize] = place as u32;
            *next += 1;
        }
        Self { starts, rows, body, row_starts, places }
    }

    pub fn cell_count(&self) -> usize {
        self.starts.len() - 1
    }

    /// Nodes of all cells.
    pub fn place_count(&self) -> usize {
        self.rows.len()
    }

    /// Where the nodes of a cell stand among those of all.
    pub fn places(&self, cell: usize) -> Range<usize> {
        self.starts[cell] as usize..self.starts[cell + 1] as usize
    }

    pub fn rows(&self, cell: usize) -> &[u32] {
        &self.rows[self.places(cell)]
    }

    /// Calls `work(cell, its part)` for all cells, with a part of as many as it has nodes.
    pub fn fill(&self, parts: &mut Vec<Vec3>, work: impl Fn(usize, &mut [Vec3]) + Sync) {
        let count = self.cell_count();
        let first_of = |chunk: usize| count.min(chunk * CELLS_PER_CHUNK);
        self.fill_chunks(count.div_ceil(CELLS_PER_CHUNK), first_of, parts, |chunk, parts| {
            let mut remaining = parts;
            for cell in first_of(chunk)..first_of(chunk + 1) {
                let (own, rest) = remaining.split_at_mut(self.places(cell).len());
                remaining = rest;
                work(cell, own);
            }
        });
    }

    /// Calls `work(chunk, the parts of its cells)` for all chunks of neighbouring cells, each of those from `first_of` it to that of the next.
    pub fn fill_chunks(
        &self,
        count: usize,
        first_of: impl Fn(usize) -> usize + Sync,
        parts: &mut Vec<Vec3>,
        work: impl Fn(usize, &mut [Vec3]) + Sync,
    ) {
        parts.resize(self.place_count(), Vec3::ZERO);
        let start_of = |chunk: usize| self.starts[first_of(chunk)] as usize;
        parallel::fill(0..count, parallel::LIGHT, parts, &start_of, &work);
    }

    /// `out[row] += Σ part` of its places, in the order of cells.
    pub fn gather(&self, parts: &[Vec3], out: &mut [Vec3]) {
        let out = &mut out[self.body.clone()];
        let gather_rows = |(task, rows): (usize, &mut [Vec3])| {
            for (offset, row) in rows.iter_mut().enumerate() {
                let number = task * ROWS_PER_TASK + offset;
                let own = self.row_starts[number] as usize..self.row_starts[number + 1] as usize;
                *row += self.places[own].iter().map(|place| parts[*place as usize]).sum::<Vec3>();
            }
        };
        if out.len() >= 2 * ROWS_PER_TASK && rayon::current_num_threads() > 1 {
            out.par_chunks_mut(ROWS_PER_TASK).enumerate().for_each(gather_rows);
        } else {
            out.chunks_mut(ROWS_PER_TASK).enumerate().for_each(gather_rows);
        }
    }

    /// `Σ number(cell)`.
    pub fn sum(&self, number: impl Fn(usize) -> f64 + Sync) -> f64 {
        sum_of(self.cell_count(), number)
    }

    pub fn visit_cliques(&self, visit: &mut dyn FnMut(&[u32])) {
        (0..self.cell_count()).for_each(|cell| visit(self.rows(cell)));
    }

    /// Adds the blocks `(a, b)` of every cell that `work(cell, blocks)` writes over zeros, `b` fastest, exactly or with the negative
    /// eigenvalues of each cell's matrix, which is symmetric then, turned round; whether any were. `blocks` is scratch.
    pub fn add_blocks(
        &self,
        curvature: Curvature,
        blocks: &mut Vec<Mat3>,
        matrix: &mut BlockMatrix,
        work: impl Fn(usize, &mut [Mat3]) + Sync,
    ) -> bool {
        let widest = (0..self.cell_count()).map(|cell| self.places(cell).len().pow(2)).max().unwrap_or(0);
        let mut turned = false;
        for first in (0..self.cell_count()).step_by(CELLS_PER_SLAB) {
            let cells = first..self.cell_count().min(first + CELLS_PER_SLAB);
            blocks.resize(widest * CELLS_PER_SLAB, Mat3::ZERO);
            let of_slab = blocks.par_chunks_exact_mut(widest).zip(cells.clone().into_par_iter());
            turned |= of_slab
                .map(|(blocks, cell)| {
                    let nodes = self.places(cell).len();
                    let blocks = &mut blocks[..nodes * nodes];
                    blocks.fill(Mat3::ZERO);
                    work(cell, blocks);
                    curvature == Curvature::Definite && make_definite(nodes, blocks)
                })
                .reduce(|| false, |a, b| a | b);
            for (cell, blocks) in cells.zip(blocks.chunks_exact(widest)) {
                let rows = self.rows(cell);
                for (row, blocks) in rows.iter().zip(blocks.chunks_exact(rows.len())) {
                    for (column, block) in rows.iter().zip(blocks) {
                        add_block(matrix, *row as usize, *column as usize, block);
                    }
                }
            }
        }
        turned
    }

    pub fn bytes(&self) -> usize {
        4 * [&self.starts, &self.rows, &self.row_starts, &self.places].map(Vec::len).iter().sum::<usize>()
    }
}

/// `Σ number(i)` of `count`, in the same order for any number of threads.
pub fn sum_of(count: usize, number: impl Fn(usize) -> f64 + Sync) -> f64 {
    parallel::sum(0..count.div_ceil(CELLS_PER_CHUNK), &|chunk| {
        let first = chunk * CELLS_PER_CHUNK;
        (first..count.min(first + CELLS_PER_CHUNK)).map(&number).sum()
    })
}

/// `out[i] = number(i, out[i])`.
pub fn map_into(out: &mut [f64], number: impl Fn(usize, f64) -> f64 + Sync) {
    let count = out.len();
    let start_of = |chunk: usize| count.min(chunk * CELLS_PER_CHUNK);
    let chunks = 0..count.div_ceil(CELLS_PER_CHUNK);
    parallel::fill(chunks, parallel::LIGHT, out, &start_of, &|chunk, out| {
        for (i, out) in (start_of(chunk)..).zip(out) {
            *out = number(i, *out);
        }
    });
}

/// Turns round the negative eigenvalues of the symmetric matrix of a cell; whether it had any.
fn make_definite(nodes: usize, blocks: &mut [Mat3]) -> bool {
    let n = 3 * nodes;
    CELL.with_borrow_mut(|(a, workspace)| {
        a.resize(n * n, 0.0);
        let place =
            |number: usize, i: usize, j: usize| n * (3 * (number / nodes) + i) + 3 * (number % nodes) + j;
        let entries = || (0..3).flat_map(|j| (0..3).map(move |i| (i, j)));
        for (number, block) in blocks.iter().enumerate() {
            entries().for_each(|(i, j)| a[place(number, i, j)] = block.entry(i, j));
        }
        let turned = take_absolute(n, a, workspace);
        if turned {
            for (number, block) in blocks.iter_mut().enumerate() {
                let entry = |i: usize, j: usize| a[place(number, i, j)];
                *block = Mat3::from_columns(
                    Vec3::new(entry(0, 0), entry(1, 0), entry(2, 0)),
                    Vec3::new(entry(0, 1), entry(1, 1), entry(2, 1)),
                    Vec3::new(entry(0, 2), entry(1, 2), entry(2, 2)),
                );
            }
        }
        turned
    })
}
