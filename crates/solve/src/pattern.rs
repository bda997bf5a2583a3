//! Which pairs of blocks a matrix stores.

use crate::SolveError;

/// Structure of a sparse matrix of 3×3 blocks: compressed rows, columns ascending, structurally symmetric,
/// the diagonal always present.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pattern {
    /// Row `r` owns the slots `row_starts[r] .. row_starts[r + 1]`; length `block_count + 1`.
    row_starts: Vec<u32>,
    /// Column of each slot.
    columns: Vec<u32>,
    /// Slot of each diagonal block.
    diagonal: Vec<u32>,
}

/// Collects groups of blocks that are coupled to each other: the nodes of an element, the ends of a link.
#[derive(Clone, Debug)]
pub struct PatternBuilder {
    block_count: usize,
    clique_starts: Vec<usize>,
    clique_blocks: Vec<u32>,
}

impl PatternBuilder {
    pub fn new(block_count: usize) -> Self {
        Self { block_count, clique_starts: vec![0], clique_blocks: Vec::new() }
    }

    /// Declares that all pairs among `blocks` may have an entry. Repetitions are harmless.
    ///
    /// # Errors
    /// A block is not below the block count.
    pub fn add_clique(&mut self, blocks: &[u32]) -> Result<(), SolveError> {
        if let Some(&block) = blocks.iter().find(|&&block| block as usize >= self.block_count) {
            let (clique, block_count) = (self.clique_starts.len() - 1, self.block_count);
            return Err(SolveError::BlockOutOfRange { clique, block: block as usize, block_count });
        }
        self.clique_blocks.extend_from_slice(blocks);
        self.clique_starts.push(self.clique_blocks.len());
        Ok(())
    }

    /// # Errors
    /// More blocks than 32 bits can number.
    pub fn build(&self) -> Result<Pattern, SolveError> {
        let clique =
            |index: usize| &self.clique_blocks[self.clique_starts[index]..self.clique_starts[index + 1]];
        let incidence = self.incidence();
        let mut row_starts = Vec::with_capacity(self.block_count + 1);
        let mut columns = Vec::new();
        let mut diagonal = Vec::with_capacity(self.block_count);
        row_starts.push(0);
        let mut row_of_last_visit = vec![u32::MAX; self.block_count];
        for row in 0..self.block_count {
            let start = columns.len();
            row_of_last_visit[row] = row as u32;
            columns.push(row as u32);
            for &owner in incidence.cliques_of(row) {
                for &column in clique(owner as usize) {
                    if std::mem::replace(&mut row_of_last_visit[column as usize], row as u32) != row as u32 {
                        columns.push(column);
                    }
                }
            }
            columns[start..].sort_unstable();
            let end =
                u32::try_from(columns.len()).map_err(|_| SolveError::TooLarge { blocks: columns.len() })?;
            row_starts.push(end);
            let place = columns[start..].partition_point(|&column| (column as usize) < row);
            diagonal.push((start + place) as u32);
        }
        columns.shrink_to_fit();
        Ok(Pattern { row_starts, columns, diagonal })
    }

    /// The cliques each block is in, in order of declaration.
    fn incidence(&self) -> Incidence {
        let mut starts = vec![0_usize; self.block_count + 1];
        for &block in &self.clique_blocks {
            starts[block as usize + 1] += 1;
        }
        for block in 0..self.block_count {
            starts[block + 1] += starts[block];
        }
        let mut next = starts.clone();
        let mut cliques = vec![0; self.clique_blocks.len()];
        for (clique, range) in self.clique_starts.windows(2).enumerate() {
            for &block in &self.clique_blocks[range[0]..range[1]] {
                cliques[next[block as usize]] = clique as u32;
                next[block as usize] += 1;
            }
        }
        Incidence { starts, cliques }
    }
}

struct Incidence {
    starts: Vec<usize>,
    cliques: Vec<u32>,
}

impl Incidence {
    fn cliques_of(&self, block: usize) -> &[u32] {
        &self.cliques[self.starts[block]..self.starts[block + 1]]
    }
}

impl Pattern {
    /// The pattern in which two blocks are coupled when they occur in one clique.
    ///
    /// # Errors
    /// A clique names a block that does not exist, or there are more blocks than 32 bits can number.
    pub fn from_cliques<'a>(
        block_count: usize,
        cliques: impl IntoIterator<Item = &'a [u32]>,
    ) -> Result<Self, SolveError> {
        let mut builder = PatternBuilder::new(block_count);
        for clique in cliques {
            builder.add_clique(clique)?;
        }
        builder.build()
    }

    /// The pattern of a block-diagonal matrix.
    ///
    /// # Errors
    /// More blocks than 32 bits can number.
    pub fn diagonal(block_count: usize) -> Result<Self, SolveError> {
        Self::from_cliques(block_count, [])
    }

    /// Number of rows, each of three scalars.
    pub fn block_count(&self) -> usize {
        self.row_starts.len() - 1
    }

    /// Number of stored 3×3 blocks.
    pub fn slot_count(&self) -> usize {
        self.columns.len()
    }

    pub fn row_starts(&self) -> &[u32] {
        &self.row_starts
    }

    pub fn columns(&self) -> &[u32] {
        &self.columns
    }

    /// The slots of `row`.
    #[inline]
    pub fn slots(&self, row: usize) -> std::ops::Range<usize> {
        self.row_starts[row] as usize..self.row_starts[row + 1] as usize
    }

    /// The columns of `row`, ascending.
    #[inline]
    pub fn row(&self, row: usize) -> &[u32] {
        &self.columns[self.slots(row)]
    }

    /// Where block `(row, column)` is stored; `None` if it is zero by structure.
    #[inline]
    pub fn slot(&self, row: usize, column: usize) -> Option<usize> {
        let slots = self.slots(row);
        self.columns[slots.clone()].binary_search(&(column as u32)).ok().map(|place| slots.start + place)
    }

    /// Where block `(row, row)` is stored.
    #[inline]
    pub fn diagonal_slot(&self, row: usize) -> usize {
        self.diagonal[row] as usize
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        4 * (self.row_starts.len() + self.columns.len() + self.diagonal.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of a pattern are sorted, without repetition, with the diagonal, and symmetric.
    #[test]
    fn cliques_make_a_symmetric_pattern() {
        let cliques: [&[u32]; 4] = [&[4, 1, 2], &[2, 2, 0], &[5], &[1, 4]];
        let pattern = Pattern::from_cliques(7, cliques).unwrap();
        let rows: Vec<&[u32]> = (0..7).map(|row| pattern.row(row)).collect();
        let expected: [&[u32]; 7] = [&[0, 2], &[1, 2, 4], &[0, 1, 2, 4], &[3], &[1, 2, 4], &[5], &[6]];
        assert_eq!(rows, expected);
        assert_eq!(pattern.slot(2, 4), Some(8));
        assert_eq!(pattern.slot(0, 1), None);
    }

    #[test]
    fn a_block_out_of_range_is_named() {
        let cliques: [&[u32]; 2] = [&[0, 1], &[1, 3]];
        let error = Pattern::from_cliques(3, cliques).unwrap_err();
        assert_eq!(error, SolveError::BlockOutOfRange { clique: 1, block: 3, block_count: 3 });
    }
}
