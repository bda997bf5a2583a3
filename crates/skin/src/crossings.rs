//! Where the surface crosses the edges of the grid: one bit for each edge, one number and one point for each crossing.
//!
//! Signs of a block are eight words, one for each layer along z; an edge is cut where a word differs from itself shifted
//! by one node. A crossing's number is that of the first of its layer plus the bits before it, so it is found without a list.

use souple_math::Vec3;

use crate::grid::{EDGE, Found, Grid, Lattice, NODES, Neighbours, block_of, neighbour};
use crate::widest::{Rows, run_widest};

/// A bit for each node of a block, by layers along z.
pub type Layers = [u64; EDGE];

/// First and last column along x of a layer, first row along y.
pub const FIRST_X: u64 = 0x0101_0101_0101_0101;
pub const LAST_X: u64 = FIRST_X << 7;
pub const FIRST_Y: u64 = 0xff;

/// Crossings of all edges of a grid with its zero level; an edge belongs to the block of its lower node.
#[derive(Clone, Debug, Default)]
pub struct Crossings {
    /// Nodes inside.
    inside: Vec<Layers>,
    /// Edges cut, by axis.
    cut: Vec<[Layers; 3]>,
    /// Number of the first crossing of each layer.
    first: Vec<[[u32; EDGE]; 3]>,
    /// How many crossings stand before those of each block.
    starts: Vec<u32>,
    /// Where they are [m].
    pub points: Vec<Vec3>,
}

/// Positions along an edge keep so far from its ends [voxels]: a triangle at a node that is on the surface has an area.
const FROM_NODES: f64 = 1e-4;

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

impl Crossings {
    /// Finds all crossings of a grid.
    pub fn find(&mut self, grid: Grid, neighbours: &Neighbours, lattice: &Lattice) {
        let count = grid.keys.len();
        self.inside.clear();
        self.inside.extend((0..count).map(|block| layers_where(grid.block(block), |f| f > 0.0)));
        self.cut.clear();
        self.first.clear();
        self.starts.clear();
        self.points.clear();
        for block in 0..count {
            let inside = self.inside[block];
            let above = self.shifted(neighbours, block, &inside);
            let cut: [Layers; 3] =
                std::array::from_fn(|axis| std::array::from_fn(|z| inside[z] ^ above[axis][z]));
            let mut first = [[0; EDGE]; 3];
            self.starts.push(self.points.len() as u32);
            if cut != [[0; EDGE]; 3] {
                self.place(grid, neighbours, lattice, block, &cut, &mut first);
            }
            self.cut.push(cut);
            self.first.push(first);
        }
    }

    /// For each axis the signs of the next nodes along it.
    fn shifted(&self, neighbours: &Neighbours, block: usize, inside: &Layers) -> [Layers; 3] {
        let next = |steps| match neighbours.of(block, steps) {
            Found::Kept(index) => self.inside[index as usize],
            Found::Inside => [!0; EDGE],
            Found::Outside => [0; EDGE],
        };
        let (x, y, z) = (next(neighbour(1, 0, 0)), next(neighbour(0, 1, 0)), next(neighbour(0, 0, 1)));
        [
            std::array::from_fn(|k| along_x(inside[k], x[k])),
            std::array::from_fn(|k| along_y(inside[k], y[k])),
            std::array::from_fn(|k| if k + 1 < EDGE { inside[k + 1] } else { z[0] }),
        ]
    }

    /// Gives out the numbers of a block's crossings and places them.
    fn place(
        &mut self,
        grid: Grid,
        neighbours: &Neighbours,
        lattice: &Lattice,
        block: usize,
        cut: &[Layers; 3],
        first: &mut [[u32; EDGE]; 3],
    ) {
        let values = grid.block(block);
        let [bx, by, bz] = block_of(grid.keys[block]).map(|c| (c * EDGE as i64) as f64);
        let corner = Vec3::new(bx, by, bz);
        for axis in 0..3 {
            let stride = [1, EDGE, EDGE * EDGE][axis];
            let beyond = [neighbour(1, 0, 0), neighbour(0, 1, 0), neighbour(0, 0, 1)][axis];
            for z in 0..EDGE {
                first[axis][z] = self.points.len() as u32;
                for bit in bits(cut[axis][z]) {
                    let node = z * EDGE * EDGE + bit;
                    let is_last = [bit % EDGE, bit / EDGE, z][axis] == EDGE - 1;
                    let other = if !is_last {
                        values[node + stride]
                    } else {
                        match neighbours.of(block, beyond) {
                            Found::Kept(next) => grid.block(next as usize)[node + stride - EDGE * stride],
                            uniform => uniform.uniform(),
                        }
                    };
                    let t = (values[node] / (values[node] - other)).clamp(FROM_NODES, 1.0 - FROM_NODES);
                    let mut place = corner + Vec3::new((bit % EDGE) as f64, (bit / EDGE) as f64, z as f64);
                    place[axis] += t;
                    self.points.push(lattice.to_world(place));
                }
            }
        }
    }

    pub fn inside(&self, block: usize) -> &Layers {
        &self.inside[block]
    }

    pub fn cut(&self, block: usize) -> &[Layers; 3] {
        &self.cut[block]
    }

    /// The number of the crossing on the edge above a node along an axis; the edge must be cut.
    #[inline(always)]
    pub fn number(&self, block: usize, axis: usize, z: usize, bit: usize) -> u32 {
        let before = self.cut[block][axis][z] & ((1 << bit) - 1);
        self.first[block][axis][z] + before.count_ones()
    }

    /// The numbers of a block's crossings.
    pub fn numbers(&self, block: usize) -> std::ops::Range<usize> {
        let end = self.starts.get(block + 1).map_or(self.points.len(), |next| *next as usize);
        self.starts[block] as usize..end
    }

    pub fn bytes(&self) -> usize {
        let layers = size_of::<Layers>() * (self.inside.capacity() + 3 * self.cut.capacity());
        layers + size_of::<[[u32; EDGE]; 3]>() * self.first.capacity() + 24 * self.points.capacity()
    }
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

/// A bit for each node whose value fits.
pub fn layers_where(values: &[f64; NODES], fits: impl Fn(f64) -> bool) -> Layers {
    let mut layers = [0; EDGE];
    run_widest(Marks { values, fits, layers: &mut layers });
    layers
}

struct Marks<'a, F> {
    values: &'a [f64; NODES],
    fits: F,
    layers: &'a mut Layers,
}

impl<F: Fn(f64) -> bool> Rows for Marks<'_, F> {
    #[inline(always)]
    fn run(self) {
        let mut rows = [0_u8; EDGE * EDGE];
        for (row, values) in rows.iter_mut().zip(self.values.chunks_exact(EDGE)) {
            for x in 0..EDGE {
                *row |= u8::from((self.fits)(values[x])) << x;
            }
        }
        for (layer, rows) in self.layers.iter_mut().zip(rows.chunks_exact(EDGE)) {
            *layer = rows.iter().rev().fold(0, |word, row| word << EDGE | u64::from(*row));
        }
    }
}
