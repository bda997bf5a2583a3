//! One bit for each node of a block: which are inside, which are within the band.

use crate::grid::{EDGE, Found, Grid, NEAR, NODES, Neighbours, neighbour};
use crate::widest::{Rows, run_widest};

/// A bit for each node of a block, by layers along z.
pub type Layers = [u64; EDGE];

pub const NONE: Layers = [0; EDGE];
pub const ALL: Layers = [!0; EDGE];

/// First and last column along x of a layer, first row along y.
pub const FIRST_X: u64 = 0x0101_0101_0101_0101;
pub const LAST_X: u64 = FIRST_X << 7;
pub const FIRST_Y: u64 = 0xff;

/// Sets of the nodes of a block.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Marks {
    pub inside: Layers,
    pub band: Layers,
}

impl Marks {
    pub fn of(values: &[f32; NODES]) -> Self {
        let mut marks = Self::default();
        run_widest(Marking { values, marks: &mut marks });
        marks
    }

    /// Those of a block that is not kept.
    pub fn of_uniform(found: Found) -> Self {
        Self { inside: if found == Found::Inside { ALL } else { NONE }, band: NONE }
    }

    /// Those of all blocks of a grid.
    pub fn find(grid: Grid, marks: &mut Vec<Self>) {
        marks.clear();
        marks.extend((0..grid.keys.len()).map(|block| Self::of(grid.block(block))));
    }

    /// Marks a row of nodes.
    #[inline(always)]
    pub fn set_row(&mut self, y: usize, z: usize, row: &[f32; EDGE]) {
        let inside = row_where(row, |value| value > 0.0);
        let band = row_where(row, |value| value.abs() < NEAR);
        self.inside[z] |= inside << (EDGE * y);
        self.band[z] |= band << (EDGE * y);
    }

    /// Takes the marks of a row from others.
    #[inline(always)]
    pub fn take_row(&mut self, y: usize, z: usize, other: &Self) {
        let row = FIRST_Y << (EDGE * y);
        self.inside[z] |= other.inside[z] & row;
        self.band[z] |= other.band[z] & row;
    }
}

/// A bit for each value of a row that fits.
#[inline(always)]
fn row_where(row: &[f32; EDGE], fits: impl Fn(f32) -> bool) -> u64 {
    let mut words = [0_u32; EDGE];
    for x in 0..EDGE {
        words[x] = if fits(row[x]) { 1 << x } else { 0 };
    }
    words.into_iter().fold(0, |bits, word| bits | word).into()
}

struct Marking<'a> {
    values: &'a [f32; NODES],
    marks: &'a mut Marks,
}

impl Rows for Marking<'_> {
    #[inline(always)]
    fn run(self) {
        let (rows, _) = self.values.as_chunks::<EDGE>();
        for (index, row) in rows.iter().enumerate() {
            self.marks.set_row(index % EDGE, index / EDGE, row);
        }
    }
}

/// The bits of a word, lowest first.
pub fn bits(mut word: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        (word != 0).then(|| {
            let bit = word.trailing_zeros() as usize;
            word &= word - 1;
            bit
        })
    })
}

/// The nodes of a set.
pub fn nodes(set: &Layers) -> impl Iterator<Item = usize> {
    (0..EDGE).flat_map(|z| bits(set[z]).map(move |bit| z * EDGE * EDGE + bit))
}

/// A layer shifted so that each node has the bit of the next one along x; `next` is the layer of the next block.
pub fn along_x(layer: u64, next: u64) -> u64 {
    (layer >> 1 & !LAST_X) | (next & FIRST_X) << 7
}

/// The same along y.
pub fn along_y(layer: u64, next: u64) -> u64 {
    layer >> 8 | (next & FIRST_Y) << 56
}

/// The same, each node having the bit of the one before it along x.
pub fn back_x(layer: u64, before: u64) -> u64 {
    (layer << 1 & !FIRST_X) | (before & LAST_X) >> 7
}

/// The same along y.
pub fn back_y(layer: u64, before: u64) -> u64 {
    layer << 8 | before >> 56
}

/// Steps to the six nearest neighbours of a block, by axis: below and above.
pub const BESIDE: [[usize; 2]; 3] = [
    [neighbour(-1, 0, 0), neighbour(1, 0, 0)],
    [neighbour(0, -1, 0), neighbour(0, 1, 0)],
    [neighbour(0, 0, -1), neighbour(0, 0, 1)],
];

/// Nodes of a set that each block has, and those next to them along an axis.
pub fn widened<'a>(neighbours: &Neighbours, block: usize, set: impl Fn(usize) -> &'a Layers) -> Layers {
    let own = set(block);
    let sides: [[&Layers; 2]; 3] = BESIDE.map(|axis| {
        axis.map(|number| match neighbours.of(block, number) {
            Found::Kept(index) => set(index as usize),
            _ => &NONE,
        })
    });
    std::array::from_fn(|z| {
        let below = if z > 0 { own[z - 1] } else { sides[2][0][EDGE - 1] };
        let above = if z + 1 < EDGE { own[z + 1] } else { sides[2][1][0] };
        let across_x = along_x(own[z], sides[0][1][z]) | back_x(own[z], sides[0][0][z]);
        let across_y = along_y(own[z], sides[1][1][z]) | back_y(own[z], sides[1][0][z]);
        own[z] | below | above | across_x | across_y
    })
}
