//! Where the surface crosses the edges of the grid: one bit for each edge, one number and one point for each crossing.
//!
//! Signs of a block are eight words, one for each layer along z; an edge is cut where a word differs from itself shifted
//! by one node. A crossing's number is that of the first of its layer plus the bits before it, so it is found without a list.

use souple_math::Vec3;

use crate::grid::{EDGE, Found, Grid, Lattice, Neighbours, block_of};
use crate::marks::{ALL, BESIDE, Layers, Marks, NONE, along_x, along_y, bits};

/// Crossings of all edges of a grid with its zero level; an edge belongs to the block of its lower node.
#[derive(Clone, Debug, Default)]
pub struct Crossings {
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

impl Crossings {
    /// Finds all crossings of a grid whose blocks are marked.
    pub fn find(&mut self, grid: Grid, neighbours: &Neighbours, marks: &[Marks], lattice: &Lattice) {
        self.cut.clear();
        self.first.clear();
        self.starts.clear();
        self.points.clear();
        for block in 0..grid.keys.len() {
            let cut = cut(neighbours, marks, block);
            let mut first = [[0; EDGE]; 3];
            self.starts.push(self.points.len() as u32);
            if cut != [NONE; 3] {
                first = [
                    self.place::<0>(grid, neighbours, lattice, block, &cut[0]),
                    self.place::<1>(grid, neighbours, lattice, block, &cut[1]),
                    self.place::<2>(grid, neighbours, lattice, block, &cut[2]),
                ];
            }
            self.cut.push(cut);
            self.first.push(first);
        }
    }

    /// Gives out the numbers of a block's crossings along an axis and places them.
    #[inline(always)]
    fn place<const AXIS: usize>(
        &mut self,
        grid: Grid,
        neighbours: &Neighbours,
        lattice: &Lattice,
        block: usize,
        cut: &Layers,
    ) -> [u32; EDGE] {
        let values = grid.block(block);
        let beyond = grid.of(neighbours.of(block, BESIDE[AXIS][1]));
        let corner = block_of(grid.keys[block]).map(|c| (c * EDGE as i64) as f64);
        let stride = [1, EDGE, EDGE * EDGE][AXIS];
        std::array::from_fn(|z| {
            let first = self.points.len() as u32;
            self.points.extend(bits(cut[z]).map(|bit| {
                let node = z * EDGE * EDGE + bit;
                let place = [bit % EDGE, bit / EDGE, z];
                let is_last = place[AXIS] == EDGE - 1;
                let there =
                    if is_last { beyond[node + stride - EDGE * stride] } else { values[node + stride] };
                let (here, there) = (f64::from(values[node]), f64::from(there));
                let t = (here / (here - there)).clamp(FROM_NODES, 1.0 - FROM_NODES);
                let along =
                    |axis: usize| corner[axis] + place[axis] as f64 + if axis == AXIS { t } else { 0.0 };
                lattice.to_world(Vec3::new(along(0), along(1), along(2)))
            }));
            first
        })
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
        let layers = size_of::<Layers>() * 3 * self.cut.capacity();
        layers + size_of::<[[u32; EDGE]; 3]>() * self.first.capacity() + 24 * self.points.capacity()
    }
}

/// Edges of a block's nodes that are cut, by axis.
fn cut(neighbours: &Neighbours, marks: &[Marks], block: usize) -> [Layers; 3] {
    let inside = &marks[block].inside;
    let [x, y, z] = BESIDE.map(|[_, above]| match neighbours.of(block, above) {
        Found::Kept(index) => &marks[index as usize].inside,
        Found::Inside => &ALL,
        Found::Outside => &NONE,
    });
    [
        std::array::from_fn(|k| inside[k] ^ along_x(inside[k], x[k])),
        std::array::from_fn(|k| inside[k] ^ along_y(inside[k], y[k])),
        std::array::from_fn(|k| inside[k] ^ if k + 1 < EDGE { inside[k + 1] } else { z[0] }),
    ]
}
