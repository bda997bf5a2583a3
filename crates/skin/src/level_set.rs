//! One sub-step of the level set: `∂f/∂t = |∇f| (a − β κ)`, kept near a signed distance.
//!
//! `a` is the speed of all strategies but tension at the nearest surface points: at a node beside the surface the mean
//! over the crossings of its own edges (the source's rule, which lets the skin come to a true rest), a little further out
//! carried along the gradient from the nodes nearer to the surface, beyond that the mean of the block. It moves `f` with
//! upwind slopes (Godunov). Tension takes the curvature of the level through each node, by central differences: all levels
//! of the band then shrink as they would by themselves, so the surface feels no edge of the band, to second order.
//!
//! What drifts is relaxed towards `|∇f| = 1` by `S (1 − |∇f|)` with the smooth sign `S = f/√(f² + 1)` (Sussman et al. 1994;
//! Peng et al. 1999): near the surface this is a factor that varies slowly, so it leaves the surface where it is.

use rayon::prelude::*;

use crate::crossings::{Crossings, FIRST_X, FIRST_Y, LAST_X, Layers, back_x, back_y, bits, layers_where};
use crate::grid::{
    BAND, EDGE, FARTHEST, Found, Grid, Halo, NODES, Neighbours, block_of, key_of, neighbour, node_of,
    steps_to, wide,
};
use crate::widest::{Rows, run_widest};

/// Speeds of the nodes around a surface.
#[derive(Clone, Debug, Default)]
pub struct Speeds {
    /// [voxels per sub-step], where `known`.
    pub values: Vec<f64>,
    pub known: Vec<Layers>,
    /// Nodes within the band.
    band: Vec<Layers>,
    reached: Vec<Layers>,
    staged: Vec<f64>,
    /// Sum and count of the speeds at each block's crossings.
    sums: Vec<(f64, f64)>,
    /// Of the nodes that no speed is carried to, block by block.
    pub far: Vec<f64>,
}

/// The nodes of a set.
fn nodes(set: &Layers) -> impl Iterator<Item = usize> {
    (0..EDGE).flat_map(|z| bits(set[z]).map(move |bit| z * EDGE * EDGE + bit))
}

/// Layers of nodes beyond those beside the surface that speeds are carried to: slopes and curvatures of nodes beside the
/// surface are made of these.
const CARRIED: usize = 1;

/// Steps to the six nearest neighbours of a block, by axis: below and above.
const BESIDE: [[usize; 2]; 3] = [
    [neighbour(-1, 0, 0), neighbour(1, 0, 0)],
    [neighbour(0, -1, 0), neighbour(0, 1, 0)],
    [neighbour(0, 0, -1), neighbour(0, 0, 1)],
];
const STRIDES: [usize; 3] = [1, EDGE, EDGE * EDGE];

/// The node next to one along an axis, `side` 0 below and 1 above; `None` where no block is.
#[inline(always)]
fn next_node(
    neighbours: &Neighbours,
    block: usize,
    node: usize,
    axis: usize,
    side: usize,
) -> Option<(usize, usize)> {
    let stride = STRIDES[axis];
    let place = node / stride % EDGE;
    match side {
        0 if place > 0 => Some((block, node - stride)),
        1 if place < EDGE - 1 => Some((block, node + stride)),
        _ => match neighbours.of(block, BESIDE[axis][side]) {
            Found::Kept(index) => {
                let back = stride * (EDGE - 1);
                Some((index as usize, if side == 0 { node + back } else { node - back }))
            }
            _ => None,
        },
    }
}

impl Speeds {
    /// Means over the crossings at each node, carried outward; `speeds` holds one value for each crossing.
    pub fn spread(&mut self, grid: Grid, neighbours: &Neighbours, crossings: &Crossings, speeds: &[f64]) {
        let count = grid.keys.len();
        self.values.resize(NODES * count, 0.0);
        self.band.clear();
        self.band.extend((0..count).map(|block| layers_where(grid.block(block), |f| f.abs() < BAND)));
        self.known.clear();
        self.known.extend((0..count).map(|block| beside(neighbours, crossings, block)));
        let beside = &self.known;
        let chunks = self.values.par_chunks_mut(NODES).enumerate().with_min_len(16);
        chunks.for_each_init(
            || Box::new([(0.0, 0.0); NODES]),
            |sums, (block, values)| {
                if beside[block] == [0; EDGE] {
                    return;
                }
                add_crossings(neighbours, crossings, speeds, block, sums);
                for node in nodes(&beside[block]) {
                    let (sum, count) = std::mem::take(&mut sums[node]);
                    values[node] = sum / count;
                }
            },
        );
        for _ in 0..CARRIED {
            self.carry(grid, neighbours);
        }
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
            if count > 0.0 { sum / count } else { 0.0 }
        }));
    }

    /// One layer further out.
    fn carry(&mut self, grid: Grid, neighbours: &Neighbours) {
        let (known, band) = (&self.known, &self.band);
        self.reached.clear();
        self.reached.extend((0..known.len()).map(|block| {
            let wider = dilated(neighbours, known, block);
            std::array::from_fn(|z| wider[z] & !known[block][z] & band[block][z])
        }));
        // values of the layer before are read while those of this one are written, so they are staged
        let (reached, values) = (&self.reached, &self.values);
        self.staged.resize(values.len(), 0.0);
        self.staged.par_chunks_mut(NODES).enumerate().with_min_len(16).for_each(|(block, staged)| {
            let own = grid.block(block);
            for node in nodes(&reached[block]) {
                staged[node] = carried(grid, neighbours, known, values, own[node].abs(), block, node);
            }
        });
        let staged = &self.staged;
        self.values.par_chunks_mut(NODES).enumerate().with_min_len(16).for_each(|(block, values)| {
            nodes(&reached[block]).for_each(|node| values[node] = staged[NODES * block + node]);
        });
        for (known, reached) in self.known.iter_mut().zip(&self.reached) {
            known.iter_mut().zip(reached).for_each(|(known, reached)| *known |= reached);
        }
    }

    pub fn bytes(&self) -> usize {
        let layers = self.known.capacity() + self.band.capacity() + self.reached.capacity();
        8 * (self.values.capacity() + self.staged.capacity() + self.far.capacity() + 2 * self.sums.capacity())
            + size_of::<Layers>() * layers
    }
}

/// Nodes of a block at an edge that is cut.
fn beside(neighbours: &Neighbours, crossings: &Crossings, block: usize) -> Layers {
    let cut = crossings.cut(block);
    let before = |axis: usize| match neighbours.of(block, BESIDE[axis][0]) {
        Found::Kept(index) => crossings.cut(index as usize)[axis],
        _ => [0; EDGE],
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

/// The speed of a node from those nearer to the surface, each by how much nearer it is: constant along the gradient.
fn carried(
    grid: Grid,
    neighbours: &Neighbours,
    known: &[Layers],
    values: &[f64],
    distance: f64,
    block: usize,
    node: usize,
) -> f64 {
    let (mut sum, mut weight) = (0.0, 0.0);
    for axis in 0..3 {
        for side in 0..2 {
            let Some((other, at)) = next_node(neighbours, block, node, axis, side) else { continue };
            if known[other][at / (EDGE * EDGE)] >> (at % (EDGE * EDGE)) & 1 == 1 {
                // a little for all, so that a flat place has a mean too
                let w = (distance - grid.values[NODES * other + at].abs()).max(1e-9);
                sum += w * values[NODES * other + at];
                weight += w;
            }
        }
    }
    sum / weight
}

/// Nodes whose neighbour is in the set.
fn dilated(neighbours: &Neighbours, set: &[Layers], block: usize) -> Layers {
    let own = &set[block];
    let other = |axis: usize, side: usize| match neighbours.of(block, BESIDE[axis][side]) {
        Found::Kept(index) => set[index as usize],
        _ => [0; EDGE],
    };
    let sides: [[Layers; 2]; 3] = std::array::from_fn(|axis| std::array::from_fn(|side| other(axis, side)));
    std::array::from_fn(|z| {
        let below = if z > 0 { own[z - 1] } else { sides[2][0][EDGE - 1] };
        let above = if z + 1 < EDGE { own[z + 1] } else { sides[2][1][0] };
        crate::crossings::along_x(own[z], sides[0][1][z])
            | back_x(own[z], sides[0][0][z])
            | crate::crossings::along_y(own[z], sides[1][1][z])
            | back_y(own[z], sides[1][0][z])
            | below
            | above
    })
}

/// How nodes move in a sub-step.
#[derive(Clone, Copy, Debug)]
pub struct Motion<'a> {
    /// Speeds around the surface; `None` where that of all nodes is `uniform`.
    pub speeds: Option<&'a Speeds>,
    /// [voxels per sub-step]
    pub uniform: f64,
    /// `β Δt / voxel²`.
    pub tension: f64,
    /// Share of the way to `|∇f| = 1`.
    pub redistance: f64,
}

/// Moves all values by one sub-step into `next`; the greatest move of the surface [voxels].
pub fn advance(
    grid: Grid,
    neighbours: &Neighbours,
    crossings: &Crossings,
    motion: Motion,
    next: &mut [f64],
) -> f64 {
    let chunks = next.par_chunks_mut(NODES).enumerate().with_min_len(8);
    let fastest = chunks.map_init(
        || (Box::new(Halo::ZERO), Box::new([0.0; NODES])),
        |(halo, speeds), (block, next)| {
            halo.read(grid, neighbours, block);
            match motion.speeds {
                None => speeds.fill(motion.uniform),
                Some(known) => {
                    speeds.fill(known.far[block]);
                    let values = &known.values[NODES * block..][..NODES];
                    nodes(&known.known[block]).for_each(|node| speeds[node] = values[node]);
                }
            }
            let mut fastest = [0.0; EDGE];
            run_widest(Moving {
                halo,
                speeds,
                beside: &beside(neighbours, crossings, block),
                fastest: &mut fastest,
                tension: motion.tension,
                redistance: [
                    motion.redistance * (motion.tension / TENSION_LIMIT).min(1.0),
                    motion.redistance,
                ],
                next: next.try_into().expect("a chunk is a block"),
            });
            fastest.into_iter().fold(0.0, f64::max)
        },
    );
    fastest.reduce(|| 0.0, f64::max)
}

/// Values that move.
struct Moving<'a> {
    halo: &'a Halo,
    speeds: &'a [f64; NODES],
    /// Nodes at an edge that is cut.
    beside: &'a Layers,
    /// The greatest change there over the slope, column by column.
    fastest: &'a mut [f64; EDGE],
    tension: f64,
    /// Shares near the surface and far from it.
    redistance: [f64; 2],
    next: &'a mut [f64; NODES],
}

/// Half second differences up to this are curvature, larger ones kinks [voxels].
const SMOOTH: f64 = 0.125;
/// Speeds up to this are carried by slopes of second order [voxels per sub-step]: what grows by their want of damping has left
/// the band before it shows.
const SLOW: f64 = 0.1;
/// Nodes further out are relaxed by the whole share. Nearer ones keep the distance they came with, since speeds are carried along
/// normals, but for what tension does to it, which is as much less as its step is short of the longest [voxels].
const SETTLED: f64 = 2.5;
/// `β Δt ≤ voxel²/6` (6).
pub const TENSION_LIMIT: f64 = 1.0 / 6.0;
/// Of squared slopes: a level that is flat has no curvature.
const FLAT: f64 = 1e-3;
/// No curvature is told beyond that of a ball of one voxel's radius [1/voxel].
const SHARPEST: f64 = 2.0;

impl Rows for Moving<'_> {
    #[inline(always)]
    fn run(self) {
        let f = &self.halo.0;
        for z in 0..EDGE {
            for y in 0..EDGE {
                let at = wide(1, y + 1, z + 1);
                let row = node_of(0, y, z);
                let out: &mut [f64; EDGE] =
                    (&mut self.next[row..row + EDGE]).try_into().expect("a row has its nodes");
                if is_far(f, at) {
                    out.copy_from_slice(&f[at..at + EDGE]);
                    continue;
                }
                let speeds = self.speeds[row..row + EDGE].try_into().expect("a row has its nodes");
                *out = if self.tension > 0.0 { shrink_row(f, at, self.tension) } else { [0.0; EDGE] };
                let beside = (self.beside[z] >> (EDGE * y)) as u8;
                move_row(f, at, speeds, beside, self.redistance, self.fastest, out);
            }
        }
    }
}

/// Whether a row and those beside it are beyond the band.
#[inline(always)]
fn is_far(f: &[f64], at: usize) -> bool {
    let far =
        |start: usize, len: usize| f[start..start + len].iter().fold(true, |far, f| far & (f.abs() >= BAND));
    let (dy, dz) = (wide(0, 1, 0), wide(0, 0, 1));
    far(at - 1, EDGE + 2)
        && far(at - dy, EDGE)
        && far(at + dy, EDGE)
        && far(at - dz, EDGE)
        && far(at + dz, EDGE)
}

/// `−β κ |∇f| Δt` of a row, by (4) of the source with its signs mended.
#[inline(always)]
fn shrink_row(f: &[f64], at: usize, tension: f64) -> [f64; EDGE] {
    let (dy, dz) = (wide(0, 1, 0), wide(0, 0, 1));
    let line =
        |offset: usize| -> &[f64; EDGE] { f[offset..offset + EDGE].try_into().expect("a row has its nodes") };
    let c = line(at);
    let (xm, xp, ym, yp, zm, zp) =
        (line(at - 1), line(at + 1), line(at - dy), line(at + dy), line(at - dz), line(at + dz));
    let (xpyp, xpym, xmyp, xmym) =
        (line(at + 1 + dy), line(at + 1 - dy), line(at - 1 + dy), line(at - 1 - dy));
    let (ypzp, ypzm, ymzp, ymzm) =
        (line(at + dy + dz), line(at + dy - dz), line(at - dy + dz), line(at - dy - dz));
    let (xpzp, xpzm, xmzp, xmzm) =
        (line(at + 1 + dz), line(at + 1 - dz), line(at - 1 + dz), line(at - 1 - dz));
    let mut out = [0.0; EDGE];
    for i in 0..EDGE {
        let twice = 2.0 * c[i];
        let (x, y, z) = (0.5 * (xp[i] - xm[i]), 0.5 * (yp[i] - ym[i]), 0.5 * (zp[i] - zm[i]));
        let (xx, yy, zz) = (xp[i] + xm[i] - twice, yp[i] + ym[i] - twice, zp[i] + zm[i] - twice);
        // twice the mixed second derivatives
        let xy = 0.5 * ((xpyp[i] - xpym[i]) - (xmyp[i] - xmym[i]));
        let yz = 0.5 * ((ypzp[i] - ypzm[i]) - (ymzp[i] - ymzm[i]));
        let xz = 0.5 * ((xpzp[i] - xpzm[i]) - (xmzp[i] - xmzm[i]));
        let slope_sq = x * x + y * y + z * z + FLAT;
        let sum = x * x * (yy + zz) + y * y * (xx + zz) + z * z * (xx + yy)
            - (x * y * xy + y * z * yz + x * z * xz);
        out[i] = tension * sum / slope_sq;
    }
    out
}

/// Moves a row by its speeds and by what stands in `out`, and relaxes it.
#[inline(always)]
fn move_row(
    f: &[f64],
    at: usize,
    speeds: &[f64; EDGE],
    beside: u8,
    [settling, redistance]: [f64; 2],
    fastest: &mut [f64; EDGE],
    out: &mut [f64; EDGE],
) {
    let (dy, dz) = (wide(0, 1, 0), wide(0, 0, 1));
    let line =
        |offset: usize| -> &[f64; EDGE] { f[offset..offset + EDGE].try_into().expect("a row has its nodes") };
    let c = line(at);
    let (xm, xp) = (line(at - 1), line(at + 1));
    let (ym, yp) = (line(at - dy), line(at + dy));
    let (zm, zp) = (line(at - dz), line(at + dz));
    for i in 0..EDGE {
        let c = c[i];
        let (below, above) = ([c - xm[i], c - ym[i], c - zm[i]], [xp[i] - c, yp[i] - c, zp[i] - c]);
        // slopes towards larger and towards smaller values, to first order for what is carried by them fast, and to second
        // order, where f is smooth, for what is slow and for the distance
        let (mut rising, mut falling, mut rising_2, mut falling_2) = (0.0, 0.0, 0.0, 0.0);
        for k in 0..3 {
            let (low, high) = (below[k], above[k]);
            let half_bend = (0.5 * (high - low)).clamp(-SMOOTH, SMOOTH);
            let up = high.max(-low).max(0.0);
            let down = low.max(-high).max(0.0);
            rising += up * up;
            falling += down * down;
            let (low, high) = (low + half_bend, high - half_bend);
            let up = high.max(-low).max(0.0);
            let down = low.max(-high).max(0.0);
            rising_2 += up * up;
            falling_2 += down * down;
        }
        let speed = speeds[i];
        let upwind = if speed > 0.0 { rising } else { falling };
        let smooth = if speed > 0.0 { rising_2 } else { falling_2 };
        let carried = speed * if speed.abs() > SLOW { upwind } else { smooth }.sqrt();
        let slope = if c > 0.0 { falling_2 } else { rising_2 }.sqrt();
        let far = (c.abs() - SETTLED).clamp(0.0, 1.0);
        let share = settling + (redistance - settling) * far;
        let relaxed = share * (c / (c * c + 1.0).sqrt()) * (1.0 - slope);
        let change = out[i] + carried + relaxed;
        // a level with a slope below one half is no distance, and moves further than it tells
        fastest[i] = fastest[i].max(if beside >> i & 1 == 1 { change.abs() / slope.max(0.5) } else { 0.0 });
        out[i] = (c + change).clamp(-BAND, BAND);
    }
}

/// `κ` of the nearest surface point [1/voxel], positive where the inside is convex, and `|∇f|`.
#[inline(always)]
pub fn curvature_at(f: &[f64], at: usize) -> (f64, f64) {
    let (dy, dz) = (wide(0, 1, 0), wide(0, 0, 1));
    let c = f[at];
    let slope = |d: usize| 0.5 * (f[at + d] - f[at - d]);
    let bend = |d: usize| f[at + d] - 2.0 * c + f[at - d];
    let twist = |d: usize, e: usize| 0.25 * (f[at + d + e] - f[at + d - e] - f[at + e - d] + f[at - d - e]);
    let (x, y, z) = (slope(1), slope(dy), slope(dz));
    let (xx, yy, zz) = (bend(1), bend(dy), bend(dz));
    let (xy, yz, xz) = (twist(1, dy), twist(dy, dz), twist(1, dz));
    let slope_sq = x * x + y * y + z * z + 1e-12;
    let slope = slope_sq.sqrt();
    // (4) of the source, signs mended: κ = div n with n = −∇f/|∇f|
    let sum = x * x * (yy + zz) + y * y * (xx + zz) + z * z * (xx + yy)
        - 2.0 * (x * y * xy + y * z * yz + x * z * xz);
    let curvature = -sum / (slope_sq * slope);
    let gauss = (x * x * (yy * zz - yz * yz)
        + y * y * (xx * zz - xz * xz)
        + z * z * (xx * yy - xy * xy)
        + 2.0 * (x * y * (xz * yz - xy * zz) + y * z * (xy * xz - yz * xx) + x * z * (xy * yz - xz * yy)))
        / (slope_sq * slope_sq);
    let outside = -c / slope;
    let shrink = (1.0 - outside * curvature + outside * outside * gauss).max(0.25);
    let at_surface = (curvature - 2.0 * outside * gauss) / shrink;
    (at_surface.clamp(-SHARPEST, SHARPEST), slope)
}

/// Blocks come and go with the surface.
#[derive(Clone, Debug, Default)]
pub struct Waking {
    band: Vec<Layers>,
    inside: Vec<Layers>,
    /// Whether each block is asked for, by itself or by a neighbour.
    wanted: Vec<bool>,
    woken: Vec<u64>,
    keys: Vec<u64>,
    values: Vec<f64>,
}

/// A skin that would leave its space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Runaway;

/// Entries of a list in State before those of the grid.
#[derive(Clone, Copy, Debug)]
pub struct Heads {
    pub indices: usize,
    pub values: usize,
}

impl Waking {
    /// Wakes the blocks that the band has come to, and drops those that it has left. `true`: the blocks changed.
    ///
    /// # Errors
    /// A block would lie beyond the farthest.
    pub fn update(
        &mut self,
        indices: &mut Vec<u64>,
        values: &mut Vec<f64>,
        heads: Heads,
        neighbours: &Neighbours,
    ) -> Result<bool, Runaway> {
        let grid = Grid { keys: &indices[heads.indices..], values: &values[heads.values..] };
        let count = grid.keys.len();
        self.band.clear();
        self.inside.clear();
        for block in 0..count {
            self.band.push(layers_where(grid.block(block), |f| f.abs() < BAND));
            self.inside.push(layers_where(grid.block(block), |f| f > 0.0));
        }
        self.wanted.clear();
        self.wanted.resize(count, false);
        self.woken.clear();
        for block in 0..count {
            self.wake_around(grid, neighbours, block)?;
        }
        if self.woken.is_empty() && self.wanted.iter().all(|wanted| *wanted) {
            return Ok(false);
        }
        self.woken.sort_unstable();
        self.woken.dedup();
        self.rebuild(indices, values, heads);
        Ok(true)
    }

    fn wake_around(&mut self, grid: Grid, neighbours: &Neighbours, block: usize) -> Result<(), Runaway> {
        let (band, inside) = (self.band[block], self.inside[block]);
        if band == [0; EDGE] && (inside == [0; EDGE] || inside == [!0; EDGE]) {
            // at rest by itself; neighbours may still ask for it, and it for those of another sign
            let sign = inside[0];
            let faces_other = |number: usize| match neighbours.of(block, number) {
                Found::Kept(index) => {
                    let others: Layers = std::array::from_fn(|z| self.inside[index as usize][z] ^ sign);
                    touches(&others, 26 - number)
                }
                _ => false,
            };
            self.wanted[block] |= (0..27).any(faces_other);
        } else {
            self.wanted[block] = true;
        }
        for number in 0..27 {
            if number == neighbour(0, 0, 0) {
                continue;
            }
            let other = neighbours.of(block, number);
            let differs: Layers = match other {
                Found::Kept(_) => band,
                Found::Inside => std::array::from_fn(|z| band[z] | !inside[z]),
                Found::Outside => std::array::from_fn(|z| band[z] | inside[z]),
            };
            if !touches(&differs, number) {
                continue;
            }
            match other {
                Found::Kept(index) => self.wanted[index as usize] = true,
                _ => {
                    let place = block_of(grid.keys[block]);
                    let steps = steps_to(number);
                    let place = [0, 1, 2].map(|axis| place[axis] + i64::from(steps[axis]));
                    if place.iter().any(|c| c.abs() >= FARTHEST) {
                        return Err(Runaway);
                    }
                    self.woken.push(key_of(place));
                    self.wanted[block] = true;
                }
            }
        }
        Ok(())
    }

    /// Merges what is kept with what is woken.
    fn rebuild(&mut self, indices: &mut Vec<u64>, values: &mut Vec<f64>, heads: Heads) {
        self.keys.clear();
        self.keys.extend_from_slice(&indices[..heads.indices]);
        self.values.clear();
        self.values.extend_from_slice(&values[..heads.values]);
        let grid = Grid { keys: &indices[heads.indices..], values: &values[heads.values..] };
        let mut woken = self.woken.iter().copied().peekable();
        for (index, key) in grid.keys.iter().enumerate() {
            while let Some(new) = woken.next_if(|new| new < key) {
                self.keys.push(new);
                self.values.extend([grid.find(new).uniform(); NODES]);
            }
            if self.wanted[index] {
                self.keys.push(*key);
                self.values.extend_from_slice(grid.block(index));
            }
        }
        for new in woken {
            self.keys.push(new);
            self.values.extend([grid.find(new).uniform(); NODES]);
        }
        std::mem::swap(indices, &mut self.keys);
        std::mem::swap(values, &mut self.values);
    }

    pub fn bytes(&self) -> usize {
        let layers = size_of::<Layers>() * (self.band.capacity() + self.inside.capacity());
        layers
            + self.wanted.capacity()
            + 8 * (self.woken.capacity() + self.keys.capacity() + self.values.capacity())
    }
}

/// Whether a set has nodes at the border towards a neighbour.
fn touches(set: &Layers, number: usize) -> bool {
    let [dx, dy, dz] = steps_to(number);
    let mask = [FIRST_X, !0, LAST_X][(dx + 1) as usize] & [FIRST_Y, !0, FIRST_Y << 56][(dy + 1) as usize];
    match dz {
        -1 => set[0] & mask != 0,
        1 => set[EDGE - 1] & mask != 0,
        _ => set.iter().any(|layer| layer & mask != 0),
    }
}
