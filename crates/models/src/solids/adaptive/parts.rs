//! Which cells of a chunk have which law: chunks with the cells of one law only, made anew when laws change.

use crate::solids::SolidForce;
use crate::solids::layout::Chunk;

/// The cells of every chunk by their law.
#[derive(Default)]
pub struct Parts {
    /// Laws of the cells that the parts are of, as memory has them; empty before the first.
    laws: Vec<f64>,
    /// By chunk.
    split: Vec<Split>,
}

/// The cells of one chunk.
#[derive(Default)]
pub enum Split {
    #[default]
    First,
    Second,
    /// The cells of either law, for chunks of both.
    Both(Box<[Chunk; 2]>),
}

impl Parts {
    /// Follows the laws of the cells.
    pub fn follow(&mut self, laws: &[f64], [first, second]: &[SolidForce; 2]) {
        if self.laws == laws {
            return;
        }
        let is_new = self.laws.len() != laws.len();
        self.split.resize_with(first.elements.chunk_count(), Split::default);
        for (split, ((batch, chunk), (_, under_second))) in
            self.split.iter_mut().zip(first.elements.chunks().zip(second.elements.chunks()))
        {
            let changed = |cell: &u32| is_new || self.laws[*cell as usize] != laws[*cell as usize];
            if !chunk.cells.iter().any(changed) {
                continue;
            }
            let is_second = |cell: u32| laws[cell as usize] != 0.0;
            let count = chunk.cells.iter().filter(|cell| is_second(**cell)).count();
            let nodes = batch.kind.node_count();
            let samples = batch.reference.len() / nodes;
            *split = match count {
                0 => Split::First,
                all if all == chunk.cells.len() => Split::Second,
                _ => Split::Both(Box::new([
                    chunk.part(nodes, samples, |cell| !is_second(cell)),
                    under_second.part(nodes, samples, is_second),
                ])),
            };
        }
        self.laws.clear();
        self.laws.extend_from_slice(laws);
    }

    pub fn of(&self, chunk: usize) -> &Split {
        &self.split[chunk]
    }

    pub fn bytes(&self) -> usize {
        let own = |split: &Split| match split {
            Split::Both(parts) => parts.iter().map(|part| size_of::<Chunk>() + part.bytes()).sum(),
            _ => 0,
        };
        8 * self.laws.capacity()
            + size_of::<Split>() * self.split.capacity()
            + self.split.iter().map(own).sum::<usize>()
    }
}
