//! The speeds of the nodes beside the surface, from those of its crossings.

use rayon::prelude::*;

use crate::crossings::Crossings;
use crate::grid::{EDGE, Found, NODES, Neighbours};
use crate::marks::{BESIDE, FIRST_Y, LAST_X, Layers, NONE, back_x, back_y, bits, nodes};

/// Speeds around a surface.
#[derive(Clone, Debug, Default)]
pub struct Speeds {
    /// Of nodes at an edge that is cut [voxels per sub-step], in blocks that have such nodes; no number elsewhere.
    values: Vec<f32>,
    beside: Vec<Layers>,
    /// Sum and count of the speeds at each block's crossings.
    sums: Vec<(f64, f64)>,
    /// Of nodes that no speed is carried to, block by block.
    far: Vec<f32>,
}

/// Stands for blocks without a node beside the surface.
static NOWHERE: [f32; NODES] = [f32::NAN; NODES];
const STRIDES: [usize; 3] = [1, EDGE, EDGE * EDGE];

impl Speeds {
    /// Means over the crossings at each node; `speeds` holds one value for each crossing.
    pub fn spread(&mut self, neighbours: &Neighbours, crossings: &Crossings, speeds: &[f64]) {
        let count = neighbours.len();
        self.beside.clear();
        self.beside.extend((0..count).map(|block| beside(neighbours, crossings, block)));
        self.values.resize(NODES * count, f32::NAN);
        let beside = &self.beside;
        let chunks = self.values.par_chunks_mut(NODES).enumerate().with_min_len(16);
        chunks.for_each_init(
            || [(0.0, 0.0); NODES],
            |sums, (block, values)| {
                if beside[block] == NONE {
                    return;
                }
                values.fill(f32::NAN);
                add_crossings(neighbours, crossings, speeds, block, sums);
                for node in nodes(&beside[block]) {
                    let (sum, count) = std::mem::take(&mut sums[node]);
                    values[node] = (sum / count) as f32;
                }
            },
        );
        self.average(neighbours, crossings, speeds);
    }

    /// The mean over the crossings of each block and those around it.
    fn average(&mut self, neighbours: &Neighbours, crossings: &Crossings, speeds: &[f64]) {
        self.sums.clear();
        self.sums.extend((0..neighbours.len()).map(|block| {
            let own = &speeds[crossings.numbers(block)];
            (own.iter().sum::<f64>(), own.len() as f64)
        }));
        let sums = &self.sums;
        self.far.clear();
        self.far.extend((0..neighbours.len()).map(|block| {
            let (mut sum, mut count) = (0.0, 0.0);
            for number in 0..27 {
                if let Found::Kept(index) = neighbours.of(block, number) {
                    let other = sums[index as usize];
                    (sum, count) = (sum + other.0, count + other.1);
                }
            }
            if count > 0.0 { (sum / count) as f32 } else { 0.0 }
        }));
    }

    /// Nodes of a block that have a speed of their own.
    pub fn beside(&self, block: usize) -> &Layers {
        &self.beside[block]
    }

    /// The speed of a block's other nodes [voxels per sub-step].
    pub fn far(&self, block: usize) -> f32 {
        self.far[block]
    }

    /// Speeds in the 27 blocks around one, no number where there is none.
    pub fn around(&self, neighbours: &Neighbours, block: usize) -> [&[f32; NODES]; 27] {
        std::array::from_fn(|number| match neighbours.of(block, number) {
            Found::Kept(index) if self.beside[index as usize] != NONE => {
                self.values[NODES * index as usize..][..NODES].try_into().expect("a block has its nodes")
            }
            _ => &NOWHERE,
        })
    }

    pub fn bytes(&self) -> usize {
        4 * (self.values.capacity() + self.far.capacity())
            + 16 * self.sums.capacity()
            + size_of::<Layers>() * self.beside.capacity()
    }
}

/// Nodes of a block at an edge that is cut.
pub fn beside(neighbours: &Neighbours, crossings: &Crossings, block: usize) -> Layers {
    let cut = crossings.cut(block);
    let before = |axis: usize| match neighbours.of(block, BESIDE[axis][0]) {
        Found::Kept(index) => crossings.cut(index as usize)[axis],
        _ => NONE,
    };
    let (x, y, z) = (before(0), before(1), before(2));
    std::array::from_fn(|k| {
        let below = if k > 0 { cut[2][k - 1] } else { z[EDGE - 1] };
        cut[0][k] | back_x(cut[0][k], x[k]) | cut[1][k] | back_y(cut[1][k], y[k]) | cut[2][k] | below
    })
}

/// Adds the speeds of the crossings of all edges of a block's nodes to these nodes, with how many there are.
fn add_crossings(
    neighbours: &Neighbours,
    crossings: &Crossings,
    speeds: &[f64],
    block: usize,
    sums: &mut [(f64, f64); NODES],
) {
    let mut add = |node: usize, speed: f64| {
        sums[node].0 += speed;
        sums[node].1 += 1.0;
    };
    let mut number = crossings.numbers(block).start;
    for (axis, stride) in STRIDES.into_iter().enumerate() {
        for (z, layer) in crossings.cut(block)[axis].into_iter().enumerate() {
            for bit in bits(layer) {
                let node = z * EDGE * EDGE + bit;
                add(node, speeds[number]);
                if node / stride % EDGE < EDGE - 1 {
                    add(node + stride, speeds[number]);
                }
                number += 1;
            }
        }
        // edges from the block below end here
        let Found::Kept(below) = neighbours.of(block, BESIDE[axis][0]) else { continue };
        let below = below as usize;
        for (z, layer) in crossings.cut(below)[axis].into_iter().enumerate() {
            let last = match axis {
                0 => LAST_X,
                1 => FIRST_Y << (EDGE * (EDGE - 1)),
                _ if z == EDGE - 1 => !0,
                _ => 0,
            };
            for bit in bits(layer & last) {
                let node = z * EDGE * EDGE + bit - stride * (EDGE - 1);
                add(node, speeds[crossings.number(below, axis, z, bit) as usize]);
            }
        }
    }
}
