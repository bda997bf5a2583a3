//! Points, cells in blocks of one kind each, groups by name.

use std::collections::BTreeMap;

use souple_math::Vec3;

use crate::ElementKind;

/// A mesh of cells of one dimension, of mixed kinds, with the facets of a surface and groups by name.
///
/// Cells are numbered over all blocks in order, facets likewise; these numbers are permanent.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Rest positions [m].
    pub points: Vec<Vec3>,
    /// Volume cells; of a plane body or membrane, surface cells; of bars, edges.
    pub blocks: Vec<CellBlock>,
    /// Facets (triangles, quadrilaterals) as read from files; they carry groups and no volume.
    pub facet_blocks: Vec<CellBlock>,
    pub groups: BTreeMap<String, Group>,
}

/// Cells of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct CellBlock {
    pub kind: ElementKind,
    /// Point numbers, `kind.node_count()` for each cell.
    pub nodes: Vec<u32>,
}

/// A named part of a mesh; each list is sorted and without repetition.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Group {
    pub points: Vec<u32>,
    /// Numbers over all volume blocks.
    pub cells: Vec<u32>,
    /// Numbers over all facet blocks.
    pub facets: Vec<u32>,
}

/// A view of one cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell<'a> {
    pub kind: ElementKind,
    pub nodes: &'a [u32],
}

impl CellBlock {
    pub fn new(kind: ElementKind) -> Self {
        Self { kind, nodes: Vec::new() }
    }

    /// Number of cells.
    pub fn len(&self) -> usize {
        self.nodes.len() / self.kind.node_count()
    }

    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Node lists, cell after cell.
    pub fn cells(&self) -> std::slice::ChunksExact<'_, u32> {
        self.nodes.chunks_exact(self.kind.node_count())
    }
}

/// The cells of a mesh by number, each found without a walk along all blocks.
pub struct CellsByNumber<'a> {
    mesh: &'a Mesh,
    offsets: Vec<u32>,
}

impl<'a> CellsByNumber<'a> {
    pub fn get(&self, index: u32) -> Option<Cell<'a>> {
        // blocks without cells begin where the next one does: the last that begins there has the cell
        let number = self.offsets.partition_point(|offset| *offset <= index).checked_sub(1)?;
        let block = &self.mesh.blocks[number];
        let n = block.kind.node_count();
        let start = (index - self.offsets[number]) as usize * n;
        Some(Cell { kind: block.kind, nodes: block.nodes.get(start..start + n)? })
    }
}

impl Mesh {
    /// A mesh of one kind of cell, not yet validated.
    pub fn new(points: Vec<Vec3>, kind: ElementKind, nodes: Vec<u32>) -> Self {
        Self { points, blocks: vec![CellBlock { kind, nodes }], ..Self::default() }
    }

    /// Dimension of the cells: that of the first, for [`Mesh::validate`] refuses mixtures; 3 for a mesh without cells.
    pub fn dimension(&self) -> usize {
        let first = self.blocks.iter().find(|block| !block.is_empty());
        first.map_or(3, |block| block.kind.dimension())
    }

    pub fn cell_count(&self) -> usize {
        self.blocks.iter().map(CellBlock::len).sum()
    }

    pub fn facet_count(&self) -> usize {
        self.facet_blocks.iter().map(CellBlock::len).sum()
    }

    /// Number of cells of one kind.
    pub fn count_of(&self, kind: ElementKind) -> usize {
        self.blocks.iter().filter(|block| block.kind == kind).map(CellBlock::len).sum()
    }

    /// All volume cells in the order of their numbers.
    pub fn cells(&self) -> impl Iterator<Item = Cell<'_>> {
        self.blocks.iter().flat_map(|block| block.cells().map(|nodes| Cell { kind: block.kind, nodes }))
    }

    /// All facets in the order of their numbers.
    pub fn facets(&self) -> impl Iterator<Item = Cell<'_>> {
        self.facet_blocks.iter().flat_map(|block| block.cells().map(|nodes| Cell { kind: block.kind, nodes }))
    }

    /// Cell of number `index`, or `None` beyond the last.
    pub fn cell(&self, index: u32) -> Option<Cell<'_>> {
        let mut local = index as usize;
        for block in &self.blocks {
            if local < block.len() {
                let n = block.kind.node_count();
                return Some(Cell { kind: block.kind, nodes: &block.nodes[local * n..(local + 1) * n] });
            }
            local -= block.len();
        }
        None
    }

    /// Cells by number, for many of them: where kinds alternate there are as many blocks as cells.
    pub fn cells_by_number(&self) -> CellsByNumber<'_> {
        CellsByNumber { mesh: self, offsets: self.block_offsets() }
    }

    /// Number of the first cell of each block.
    pub fn block_offsets(&self) -> Vec<u32> {
        let mut offset = 0;
        let mut offsets = Vec::with_capacity(self.blocks.len());
        for block in &self.blocks {
            offsets.push(offset);
            offset += block.len() as u32;
        }
        offsets
    }

    /// Positions of the nodes of a cell, in `buffer`.
    pub fn positions_into<'a>(&self, nodes: &[u32], buffer: &'a mut [Vec3; crate::MAX_NODES]) -> &'a [Vec3] {
        for (slot, node) in buffer.iter_mut().zip(nodes) {
            *slot = self.points[*node as usize];
        }
        &buffer[..nodes.len()]
    }

    /// Cells of one kind appended: to the last block if it has that kind, else to a new one.
    pub fn push_cell(&mut self, kind: ElementKind, nodes: &[u32]) {
        push(&mut self.blocks, kind, nodes);
    }

    pub fn push_facet(&mut self, kind: ElementKind, nodes: &[u32]) {
        push(&mut self.facet_blocks, kind, nodes);
    }
}

fn push(blocks: &mut Vec<CellBlock>, kind: ElementKind, nodes: &[u32]) {
    assert_eq!(nodes.len(), kind.node_count(), "{kind} with {} nodes", nodes.len());
    match blocks.last_mut() {
        Some(block) if block.kind == kind => block.nodes.extend_from_slice(nodes),
        _ => blocks.push(CellBlock { kind, nodes: nodes.to_vec() }),
    }
}
