//! A sparse grid: blocks of nodes around a surface, sorted by their place.
//!
//! A node's value is a distance to the surface in voxels, positive inside, clamped to ±[`BAND`] (the source's ±1, scaled).
//! Only blocks that hold a value within the band, and their neighbours where such a value stands at their border, are
//! kept: memory and time follow the area of the surface. A block that is not kept is uniform, and its sign is that of the
//! last node of the block before it in its row (along x), or outside where there is none.

use souple_math::{Mat3, Vec3};

/// Nodes along an edge of a block.
pub const EDGE: usize = 8;
/// Nodes of a block, x fastest.
pub const NODES: usize = EDGE * EDGE * EDGE;
/// Half the width of the band around the surface [voxels].
pub const BAND: f64 = 4.0;
/// The same as values are kept: in 32 bits a surface is placed to 1e-7 voxels, and memory and time are half.
pub const NEAR: f32 = BAND as f32;
/// Words that the values of a block take in State.
pub const WORDS: usize = NODES / 2;

/// Bits of a coordinate of a block in its key.
const BITS: u32 = 21;
const BIAS: i64 = 1 << (BITS - 1);
/// Blocks are at most so far from the origin along each axis.
pub const FARTHEST: i64 = BIAS - 2;

/// Where the nodes are: `origin + voxel · (i, j, k)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lattice {
    /// [m]
    pub origin: Vec3,
    /// [m]
    pub voxel: f64,
}

impl Lattice {
    /// A place in voxels from the origin.
    pub fn to_voxels(&self, point: Vec3) -> Vec3 {
        (point - self.origin) * self.voxel.recip()
    }

    /// Where a place in voxels is [m].
    pub fn to_world(&self, place: Vec3) -> Vec3 {
        self.origin + place * self.voxel
    }
}

/// The key of a block: its coordinates, z first, so that sorted keys run along rows.
pub fn key_of(block: [i64; 3]) -> u64 {
    let [x, y, z] = block.map(|c| (c + BIAS) as u64);
    (z << (2 * BITS)) | (y << BITS) | x
}

/// Coordinates of a block by its key.
pub fn block_of(key: u64) -> [i64; 3] {
    let mask = (1 << BITS) - 1;
    [key & mask, (key >> BITS) & mask, key >> (2 * BITS)].map(|c| c as i64 - BIAS)
}

/// Whether two blocks are in one row along x.
fn in_one_row(a: u64, b: u64) -> bool {
    a >> BITS == b >> BITS
}

/// Number of a node in its block.
pub const fn node_of(x: usize, y: usize, z: usize) -> usize {
    x + EDGE * (y + EDGE * z)
}

/// Blocks and their values, read only.
#[derive(Clone, Copy, Debug)]
pub struct Grid<'a> {
    /// Ascending.
    pub keys: &'a [u64],
    /// [`NODES`] for each key.
    pub values: &'a [f32],
}

impl<'a> Grid<'a> {
    /// Blocks as they stand in State: their keys, and then their values, two in a word.
    pub fn of_words(words: &'a [u64]) -> Self {
        let (keys, values) = words.split_at(words.len() / (1 + WORDS));
        Self { keys, values: bytemuck::cast_slice(values) }
    }

    pub fn block(&self, index: usize) -> &'a [f32; NODES] {
        self.values[NODES * index..][..NODES].try_into().expect("a block has its nodes")
    }

    /// Whether a block that is not kept is inside, where `before` blocks have smaller keys.
    fn is_inside(&self, key: u64, before: usize) -> bool {
        before > 0
            && in_one_row(self.keys[before - 1], key)
            && self.values[NODES * (before - 1) + node_of(EDGE - 1, 0, 0)] > 0.0
    }

    /// The block of this key.
    pub fn find(&self, key: u64) -> Found {
        match self.keys.binary_search(&key) {
            Ok(index) => Found::Kept(index as u32),
            Err(before) if self.is_inside(key, before) => Found::Inside,
            Err(_) => Found::Outside,
        }
    }

    /// The value of a node by its coordinates [voxels].
    pub fn node(&self, node: [i64; 3]) -> f64 {
        let edge = EDGE as i64;
        match self.find(key_of(node.map(|c| c.div_euclid(edge).clamp(-FARTHEST, FARTHEST)))) {
            Found::Kept(index) => {
                let [x, y, z] = node.map(|c| c.rem_euclid(edge) as usize);
                self.values[NODES * index as usize + node_of(x, y, z)].into()
            }
            Found::Inside => BAND,
            Found::Outside => -BAND,
        }
    }

    /// The value at a place between nodes, trilinear, and its gradient, both in voxels.
    pub fn sample(&self, place: Vec3) -> (f64, Vec3) {
        let Some((corners, t)) = self.cell(place) else { return (-BAND, Vec3::ZERO) };
        let at = |x: usize, y: usize, z: usize| corners[x + 2 * y + 4 * z];
        let along_x = [0, 1, 2, 3].map(|yz| mix(corners[2 * yz], corners[2 * yz + 1], t.x));
        let along_y = [mix(along_x[0], along_x[1], t.y), mix(along_x[2], along_x[3], t.y)];
        let slope_x = |y: usize, z: usize| at(1, y, z) - at(0, y, z);
        let gradient = Vec3::new(
            mix(mix(slope_x(0, 0), slope_x(1, 0), t.y), mix(slope_x(0, 1), slope_x(1, 1), t.y), t.z),
            mix(along_x[1] - along_x[0], along_x[3] - along_x[2], t.z),
            along_y[1] - along_y[0],
        );
        (mix(along_y[0], along_y[1], t.z), gradient)
    }

    /// The values around a place as a quadratic spline has them, whose slopes have no kinks: value, gradient and second derivatives
    /// [voxels]. It smooths: a ball's values are `h²/4R` lower. `None` where the place is beyond all blocks, or not finite.
    pub fn smooth(&self, place: Vec3) -> Option<(f64, Vec3, Mat3)> {
        if !is_within(place) {
            return None;
        }
        let nearest = place.to_array().map(|c| c.round() as i64);
        // weights of the node before, the nearest and the one after along each axis, their slopes, and slopes of those
        let along = |axis: usize| {
            let t = place[axis] - nearest[axis] as f64;
            let (before, after) = (0.5 - t, 0.5 + t);
            [
                [0.5 * before * before, 0.75 - t * t, 0.5 * after * after],
                [-before, -2.0 * t, after],
                [1.0, -2.0, 1.0],
            ]
        };
        let [x, y, z] = [along(0), along(1), along(2)];
        // most stand in one block
        let low = nearest.map(|c| c - 1);
        let edge = EDGE as i64;
        let in_block = low.map(|c| c.rem_euclid(edge) as usize);
        let one_block =
            in_block.iter().all(|c| c + 2 < EDGE).then(|| self.find(key_of(low.map(|c| c.div_euclid(edge)))));
        let value_at = |steps: [usize; 3]| match one_block {
            Some(Found::Kept(index)) => {
                let [x, y, z] = [0, 1, 2].map(|axis| in_block[axis] + steps[axis]);
                f64::from(self.block(index as usize)[node_of(x, y, z)])
            }
            Some(Found::Inside) => BAND,
            Some(Found::Outside) => -BAND,
            None => self.node([0, 1, 2].map(|axis| low[axis] + steps[axis] as i64)),
        };
        // sums over all 27 nodes by how often they are derived along each axis
        let mut sums = [[[0.0; 3]; 3]; 3];
        for number in 0..27 {
            let [i, j, k] = [number % 3, number / 3 % 3, number / 9];
            let value = value_at([i, j, k]);
            for (dx, dy, dz) in [
                (0, 0, 0),
                (1, 0, 0),
                (0, 1, 0),
                (0, 0, 1),
                (2, 0, 0),
                (0, 2, 0),
                (0, 0, 2),
                (1, 1, 0),
                (0, 1, 1),
                (1, 0, 1),
            ] {
                sums[dx][dy][dz] += value * x[dx][i] * y[dy][j] * z[dz][k];
            }
        }
        let gradient = Vec3::new(sums[1][0][0], sums[0][1][0], sums[0][0][1]);
        let (xy, yz, xz) = (sums[1][1][0], sums[0][1][1], sums[1][0][1]);
        let bend = Mat3::from_columns(
            Vec3::new(sums[2][0][0], xy, xz),
            Vec3::new(xy, sums[0][2][0], yz),
            Vec3::new(xz, yz, sums[0][0][2]),
        );
        Some((sums[0][0][0], gradient, bend))
    }

    /// The corners of the cell a place is in, and where in it; `None` beyond all blocks, and where it is not finite.
    fn cell(&self, place: Vec3) -> Option<([f64; 8], Vec3)> {
        if !is_within(place) {
            return None;
        }
        let low = place.to_array().map(|c| c.floor() as i64);
        let t = place - Vec3::new(low[0] as f64, low[1] as f64, low[2] as f64);
        Some((self.corners(low), t))
    }

    /// Values at the corners of the cell above a node.
    fn corners(&self, low: [i64; 3]) -> [f64; 8] {
        let edge = EDGE as i64;
        let [x, y, z] = low.map(|c| c.rem_euclid(edge) as usize);
        if x < EDGE - 1 && y < EDGE - 1 && z < EDGE - 1 {
            return match self.find(key_of(low.map(|c| c.div_euclid(edge)))) {
                Found::Kept(index) => {
                    let block = self.block(index as usize);
                    std::array::from_fn(|c| {
                        block[node_of(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2))].into()
                    })
                }
                Found::Inside => [BAND; 8],
                Found::Outside => [-BAND; 8],
            };
        }
        std::array::from_fn(|c| {
            self.node([low[0] + (c as i64 & 1), low[1] + (c as i64 >> 1 & 1), low[2] + (c as i64 >> 2)])
        })
    }

    /// Lowest and highest node of all blocks [voxels]; `None` where there is no block.
    pub fn bounds(&self) -> Option<[[i64; 3]; 2]> {
        let blocks = self.keys.iter().map(|key| block_of(*key));
        let bounds = blocks.fold(None, |bounds: Option<[[i64; 3]; 2]>, block| {
            let [low, high] = bounds.unwrap_or([block; 2]);
            let pick = |f: fn(i64, i64) -> i64, a: [i64; 3]| [0, 1, 2].map(|i| f(a[i], block[i]));
            Some([pick(i64::min, low), pick(i64::max, high)])
        })?;
        let edge = EDGE as i64;
        Some([bounds[0].map(|c| c * edge), bounds[1].map(|c| c * edge + edge - 1)])
    }
}

/// Whether a place is where blocks may be.
fn is_within(place: Vec3) -> bool {
    place.to_array().into_iter().all(|c| c.abs() < (FARTHEST * EDGE as i64) as f64)
}

fn mix(a: f64, b: f64, t: f64) -> f64 {
    a + (b - a) * t
}

/// A block of a grid, kept or uniform.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Found {
    /// By its index.
    Kept(u32),
    Inside,
    Outside,
}

/// The 27 blocks around each, itself in the middle.
#[derive(Clone, Debug, Default)]
pub struct Neighbours {
    around: Vec<[u32; 27]>,
}

const INSIDE: u32 = u32::MAX;
const OUTSIDE: u32 = u32::MAX - 1;

/// Number of a neighbour by its steps along the axes, each -1, 0 or 1.
pub const fn neighbour(dx: i32, dy: i32, dz: i32) -> usize {
    ((dx + 1) + 3 * (dy + 1) + 9 * (dz + 1)) as usize
}

/// Steps along the axes to a neighbour by its number.
pub const fn steps_to(neighbour: usize) -> [i32; 3] {
    [neighbour as i32 % 3 - 1, neighbour as i32 / 3 % 3 - 1, neighbour as i32 / 9 - 1]
}

impl Neighbours {
    /// Looks up all neighbours of all blocks, by one walk along the sorted keys for each of the 26 steps.
    pub fn find(&mut self, grid: Grid) {
        self.around.clear();
        self.around.resize(grid.keys.len(), [OUTSIDE; 27]);
        for number in 0..27 {
            let [dx, dy, dz] = steps_to(number).map(i64::from);
            let step = (dz << (2 * BITS)) + (dy << BITS) + dx;
            let mut at = 0;
            for (around, key) in self.around.iter_mut().zip(grid.keys) {
                let wanted = key.wrapping_add(step as u64);
                while at < grid.keys.len() && grid.keys[at] < wanted {
                    at += 1;
                }
                around[number] = if grid.keys.get(at) == Some(&wanted) {
                    at as u32
                } else if grid.is_inside(wanted, at) {
                    INSIDE
                } else {
                    OUTSIDE
                };
            }
        }
    }

    pub fn of(&self, block: usize, number: usize) -> Found {
        match self.around[block][number] {
            INSIDE => Found::Inside,
            OUTSIDE => Found::Outside,
            index => Found::Kept(index),
        }
    }

    pub fn len(&self) -> usize {
        self.around.len()
    }

    pub fn is_empty(&self) -> bool {
        self.around.is_empty()
    }

    pub fn bytes(&self) -> usize {
        self.around.capacity() * size_of::<[u32; 27]>()
    }
}

/// Nodes along an edge of a block with one more on both sides.
pub const WIDE: usize = EDGE + 2;

/// A block with the nodes next to it.
pub struct Halo<T>(pub [T; WIDE * WIDE * WIDE]);

/// Number of a node of [`Halo`]; 1 is the block's first.
pub const fn wide(x: usize, y: usize, z: usize) -> usize {
    x + WIDE * (y + WIDE * z)
}

/// What stands for blocks that are not kept.
static ALL_INSIDE: Uniform = Uniform([NEAR; NODES]);
static ALL_OUTSIDE: Uniform = Uniform([-NEAR; NODES]);

/// Placed so that it can be copied as words.
#[repr(align(8))]
struct Uniform([f32; NODES]);

impl<'a> Grid<'a> {
    /// The values of the 27 blocks around one.
    pub fn around(&self, neighbours: &Neighbours, block: usize) -> [&'a [f32; NODES]; 27] {
        std::array::from_fn(|number| self.of(neighbours.of(block, number)))
    }

    /// The values of a block that may not be kept.
    pub fn of(&self, found: Found) -> &'a [f32; NODES] {
        match found {
            Found::Kept(index) => self.block(index as usize),
            Found::Inside => &ALL_INSIDE.0,
            Found::Outside => &ALL_OUTSIDE.0,
        }
    }
}

impl<T: Copy> Halo<T> {
    pub const fn filled(value: T) -> Self {
        Self([value; WIDE * WIDE * WIDE])
    }

    /// Reads a block and the nodes around it from the 27 blocks around it, itself in the middle.
    #[inline(always)]
    pub fn read<S: Copy>(&mut self, around: &[&[S; NODES]; 27], convert: impl Fn(S) -> T) {
        // side of a wide coordinate: the neighbour's step, and the coordinate there
        let side = |c: usize| match c {
            0 => (0, EDGE - 1),
            c if c <= EDGE => (1, c - 1),
            _ => (2, 0),
        };
        for z in 0..WIDE {
            let (bz, nz) = side(z);
            for y in 0..WIDE {
                let (by, ny) = side(y);
                let (first, node) = (3 * by + 9 * bz, node_of(0, ny, nz));
                let row: &mut [T; WIDE] =
                    (&mut self.0[wide(0, y, z)..][..WIDE]).try_into().expect("a row is so wide");
                row[0] = convert(around[first][node + EDGE - 1]);
                let middle: &[S; EDGE] =
                    around[first + 1][node..][..EDGE].try_into().expect("a row has its nodes");
                // by a copy, which is made of lanes
                let middle = middle.map(&convert);
                row[1..=EDGE].copy_from_slice(&middle);
                row[EDGE + 1] = convert(around[first + 2][node]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_give_back_their_blocks() {
        for block in [[0, 0, 0], [-1, 5, -7], [FARTHEST, -FARTHEST, 3]] {
            assert_eq!(block_of(key_of(block)), block);
        }
        assert!(key_of([5, 0, 0]) < key_of([-3, 1, 0]) && key_of([9, 9, 0]) < key_of([-9, -9, 1]));
    }

    /// What is not kept takes its sign along its row, and neighbours agree with a search for each.
    #[test]
    fn neighbours_are_what_a_search_finds() {
        let mut keys: Vec<u64> =
            [[0, 0, 0], [1, 0, 0], [4, 0, 0], [0, 1, 0], [-2, 0, 1]].map(key_of).to_vec();
        keys.sort_unstable();
        let mut values = vec![-NEAR; NODES * keys.len()];
        let second = keys.binary_search(&key_of([1, 0, 0])).unwrap();
        values[NODES * second..][..NODES].fill(NEAR);
        let grid = Grid { keys: &keys, values: &values };
        assert_eq!(grid.find(key_of([2, 0, 0])), Found::Inside);
        assert_eq!(grid.find(key_of([5, 0, 0])), Found::Outside);
        assert_eq!(grid.node([17, 3, 3]), BAND);
        let mut neighbours = Neighbours::default();
        neighbours.find(grid);
        for (index, key) in keys.iter().enumerate() {
            for number in 0..27 {
                let [dx, dy, dz] = steps_to(number).map(i64::from);
                let [x, y, z] = block_of(*key);
                assert_eq!(neighbours.of(index, number), grid.find(key_of([x + dx, y + dy, z + dz])));
            }
        }
    }

    /// Trilinear interpolation gives back a linear function and its gradient, also across blocks.
    #[test]
    fn linear_functions_are_sampled_exactly() {
        let keys: Vec<u64> = (0..8).map(|i| key_of([i & 1, i >> 1 & 1, i >> 2])).collect();
        let f = |p: Vec3| 0.1 * p.x - 0.2 * p.y + 0.05 * p.z + 0.3;
        let mut values = vec![0.0; NODES * 8];
        for (index, key) in keys.iter().enumerate() {
            let [bx, by, bz] = block_of(*key).map(|c| c as usize * EDGE);
            for node in 0..NODES {
                let place =
                    Vec3::new((bx + node % 8) as f64, (by + node / 8 % 8) as f64, (bz + node / 64) as f64);
                values[NODES * index + node] = f(place) as f32;
            }
        }
        let grid = Grid { keys: &keys, values: &values };
        for place in [Vec3::new(3.2, 4.7, 1.1), Vec3::new(7.5, 7.9, 7.25), Vec3::new(7.5, 2.0, 3.0)] {
            let (value, gradient) = grid.sample(place);
            // values below four are kept to 2^-24 of themselves, and a slope is a difference of two
            assert!((value - f(place)).abs() < 4.0 * 2.0_f64.powi(-24));
            assert!((gradient - Vec3::new(0.1, -0.2, 0.05)).length() < 3.0 * 8.0 * 2.0_f64.powi(-24));
        }
    }
}
