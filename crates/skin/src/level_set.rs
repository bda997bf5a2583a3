//! One sub-step of the level set: `∂f/∂t = |∇f| (a − β κ)`, kept near a signed distance.
//!
//! `a` is the speed of all strategies but tension at the nearest surface points: at a node beside the surface the mean
//! over the crossings of its own edges (the source's rule, which lets the skin come to a true rest), a little further out
//! carried along the gradient from the nodes nearer to the surface, beyond that the mean of the block. It moves `f` with
//! upwind slopes (Godunov). Tension takes the curvature of the level through each node, by central differences: all levels
//! of the band then shrink as they would by themselves, so the surface feels no edge of the band, to second order.
//!
//! Speed, tension and relaxation act on the same values at once, so their limits are one budget, beside that of waves: the shortest wave across
//! a cell changes by `√3 (c + ρ) + 4 τ` of what would turn it over, with `c` voxels moved, the share `ρ` relaxed and
//! `τ = β Δt/voxel²` ((5, 6) of the source ask for each alone).
//!
//! What drifts is relaxed towards `|∇f| = 1` by `S (1 − |∇f|)` with the smooth sign `S = f/√(f² + 1)` (Sussman et al. 1994;
//! Peng et al. 1999): near the surface this is a factor that varies slowly, so it leaves the surface where it is.

use rayon::prelude::*;

use crate::crossings::Crossings;
use crate::grid::{EDGE, Grid, Halo, NEAR, NODES, Neighbours, WIDE, wide};
use crate::marks::{Layers, Marks, NONE, widened};
use crate::speeds::{Speeds, beside};
use crate::widest::{Rows, run_widest};

/// How nodes move in a sub-step.
#[derive(Clone, Copy, Debug)]
pub struct Motion<'a> {
    /// Speeds around the surface; `None` where that of all nodes is `uniform`.
    pub speeds: Option<&'a Speeds>,
    /// [voxels per sub-step]
    pub uniform: f32,
    /// `β Δt / voxel²`.
    pub tension: f32,
    /// Share of the way to `|∇f| = 1`.
    pub redistance: f32,
}

/// A surface where it is.
#[derive(Clone, Copy)]
pub struct Surface<'a> {
    pub grid: Grid<'a>,
    pub neighbours: &'a Neighbours,
    /// Of each block.
    pub marks: &'a [Marks],
    pub crossings: &'a Crossings,
}

/// What a sub-step did.
#[derive(Clone, Copy, Debug, Default)]
pub struct Advance {
    /// The greatest move of the surface [voxels].
    pub moved: f32,
    /// Nodes whose values were worked out.
    pub nodes: u64,
}

impl Advance {
    fn and(self, other: Self) -> Self {
        Self { moved: self.moved.max(other.moved), nodes: self.nodes + other.nodes }
    }
}

/// Moves all values by one sub-step into `next`, and marks what they are.
pub fn advance(surface: Surface, motion: Motion, next: &mut [f32], next_marks: &mut [Marks]) -> Advance {
    let blocks = next.par_chunks_mut(NODES).zip(next_marks).enumerate().with_min_len(8);
    let advances = blocks.map_init(
        // on the stack: a step allocates nothing
        || (Halo::filled(0.0), Halo::filled(f32::NAN)),
        |(halo, speeds), (block, (next, next_marks))| {
            let next: &mut [f32; NODES] = next.try_into().expect("a chunk is a block");
            let mut fastest = [0.0; EDGE];
            let moving =
                Moving { surface, motion, block, halo, speeds, fastest: &mut fastest, next, next_marks };
            let active = moving.active();
            if active == NONE {
                moving.rest();
                return Advance::default();
            }
            run_widest(MovingRows { moving, active });
            Advance { moved: fastest.into_iter().fold(0.0, f32::max), nodes: worked_out(&active) }
        },
    );
    advances.reduce(Advance::default, Advance::and)
}

/// Nodes of the rows that have one of a set: rows are worked out as wholes.
fn worked_out(set: &Layers) -> u64 {
    let rows = set.iter().flat_map(|layer| layer.to_le_bytes());
    rows.filter(|row| *row != 0).count() as u64 * EDGE as u64
}

/// A block whose values move.
struct Moving<'a> {
    surface: Surface<'a>,
    motion: Motion<'a>,
    block: usize,
    halo: &'a mut Halo<f32>,
    speeds: &'a mut Halo<f32>,
    /// The greatest change beside the surface over the slope, column by column.
    fastest: &'a mut [f32; EDGE],
    next: &'a mut [f32; NODES],
    next_marks: &'a mut Marks,
}

impl Moving<'_> {
    /// Nodes of the band, and those next to them.
    fn active(&self) -> Layers {
        widened(self.surface.neighbours, self.block, |block| &self.surface.marks[block].band)
    }

    /// All stays as it is.
    fn rest(self) {
        self.next.copy_from_slice(self.surface.grid.block(self.block));
        *self.next_marks = self.surface.marks[self.block];
    }
}

struct MovingRows<'a> {
    moving: Moving<'a>,
    active: Layers,
}

/// Half second differences up to this are curvature, larger ones kinks [voxels].
const SMOOTH: f32 = 0.125;
/// Speeds up to this need no second order in time [voxels per sub-step]: what grows for want of it has left the band before it
/// shows.
const SLOW: f32 = 0.05;
/// Nodes further out are relaxed by the whole share. Nearer ones keep the distance they came with, since speeds are carried along
/// normals, but for what tension does to it, which is as much less as its step is short of the longest [voxels].
const SETTLED: f32 = 2.5;
/// `β Δt ≤ voxel²/6` (6).
const TENSION_LIMIT: f64 = 1.0 / 6.0;
/// Of the budget of a sub-step, what speed and tension may take.
const MOVING: f64 = 0.8;
/// What moves farther lets waves along the diagonal of a cell grow: `c² (Σ nᵢ θᵢ)⁴ ≤ Σ nᵢ² θᵢ⁴` for all waves `θ` of Lax and
/// Wendroff's scheme that is not split by axes [voxels per sub-step].
const WAVES: f64 = 1.0 / 3.0;

/// What a sub-step takes of its budget by its speed [voxels] and its tension.
fn taken(speed: f64, tension: f64) -> f64 {
    3.0_f64.sqrt() * speed + 4.0 * tension
}

/// The longest sub-step for a speed [voxels/s] and a tension `β/voxel²` [1/s] together [s].
pub fn longest_step(speed: f64, tension: f64) -> f64 {
    let (by_budget, by_waves) = (MOVING / taken(speed, tension), 0.9 * WAVES / speed);
    by_budget.min(by_waves).min(TENSION_LIMIT / tension)
}

/// The most that can be relaxed in a sub-step of a speed [voxels] and a tension.
pub fn relaxable(speed: f64, tension: f64) -> f64 {
    let by_budget = (1.0 - taken(speed, tension)) / 3.0_f64.sqrt();
    // what relaxes moves levels too, where waves are kept from growing
    let by_waves = if speed > f64::from(SLOW) { WAVES - speed } else { f64::INFINITY };
    by_budget.min(by_waves).max(0.0)
}
/// Of squared slopes: a level that is flat has no curvature.
const FLAT: f32 = 1e-3;
/// No curvature is told beyond that of a ball of one voxel's radius [1/voxel].
const SHARPEST: f64 = 2.0;

impl Rows for MovingRows<'_> {
    #[inline(always)]
    fn run(self) {
        let Self {
            moving: Moving { surface, motion, block, halo, speeds, fastest, next, next_marks },
            active,
        } = self;
        let Surface { grid, neighbours, marks, crossings } = surface;
        halo.read(&grid.around(neighbours, block), |value| value);
        let f = &halo.0;
        // those that speeds are carried to, and those beside the surface
        let (mut reached, mut far) = (NONE, motion.uniform);
        let beside = match motion.speeds {
            Some(known) => {
                far = known.far(block);
                reached = widened(neighbours, block, |block| known.beside(block));
                if reached != NONE {
                    speeds.read(&known.around(neighbours, block), |speed| speed);
                }
                *known.beside(block)
            }
            None => beside(neighbours, crossings, block),
        };
        let keeping = Keeping {
            // relaxed near the surface by what tension does there
            settling: motion.redistance * (motion.tension / TENSION_LIMIT as f32).min(1.0),
            redistance: motion.redistance,
            moves_alike: motion.speeds.is_none() && motion.uniform != 0.0,
        };
        let (old, _) = grid.block(block).as_chunks::<EDGE>();
        let (new, _) = next.as_chunks_mut::<EDGE>();
        *next_marks = Marks::default();
        let row_of = |set: &Layers, y: usize, z: usize| (set[z] >> (EDGE * y)) as u8;
        for z in 0..EDGE {
            for y in 0..EDGE {
                let row = EDGE * z + y;
                if row_of(&active, y, z) == 0 {
                    new[row] = old[row];
                    next_marks.take_row(y, z, &marks[block]);
                    continue;
                }
                let at = wide(1, y + 1, z + 1);
                let speed = if row_of(&reached, y, z) == 0 {
                    [far; EDGE]
                } else {
                    carried_row(f, &speeds.0, at, far)
                };
                let shrinking =
                    if motion.tension > 0.0 { shrink_row(f, at, motion.tension) } else { [0.0; EDGE] };
                let beside = row_of(&beside, y, z);
                let change = move_row(f, at, &speed, &shrinking, beside, &keeping, fastest);
                let mut moved = old[row];
                for x in 0..EDGE {
                    moved[x] = (moved[x] + change[x]).clamp(-NEAR, NEAR);
                }
                new[row] = moved;
                next_marks.set_row(y, z, &moved);
            }
        }
    }
}

/// Values of a block and those around it.
type Values = [f32; WIDE * WIDE * WIDE];

/// A row of nodes.
#[inline(always)]
fn line(f: &Values, offset: usize) -> &[f32; EDGE] {
    f[offset..offset + EDGE].try_into().expect("a row has its nodes")
}

/// Speeds of a row: of nodes beside the surface their own; of those next to them the mean of the speeds of theirs that are nearer
/// to the surface, each by how much nearer it is, so that speeds are constant along the gradient; `far` of the others.
#[inline(always)]
fn carried_row(f: &Values, speeds: &Values, at: usize, far: f32) -> [f32; EDGE] {
    let (c, own) = (*line(f, at), *line(speeds, at));
    let (mut sum, mut weight) = ([0.0; EDGE], [0.0; EDGE]);
    for stride in [wide(1, 0, 0), wide(0, 1, 0), wide(0, 0, 1)] {
        for other in [at - stride, at + stride] {
            let (distance, speed) = (*line(f, other), *line(speeds, other));
            for i in 0..EDGE {
                // a little for all, so that a flat place has a mean too
                let nearer = (c[i].abs() - distance[i].abs()).max(1e-9);
                let share = where_known(speed[i], nearer);
                sum[i] += share * where_known(speed[i], speed[i]);
                weight[i] += share;
            }
        }
    }
    let mut out = own;
    for i in 0..EDGE {
        let is_carried = (weight[i] > 0.0) & (c[i].abs() < NEAR);
        let carried = if is_carried { sum[i] / weight[i] } else { far };
        out[i] = if own[i].is_nan() { carried } else { own[i] };
    }
    out
}

/// A value, or nothing where the speed is no number; without a branch, for rows of lanes.
#[inline(always)]
fn where_known(speed: f32, value: f32) -> f32 {
    f32::from_bits(value.to_bits() & u32::from(speed.is_nan()).wrapping_sub(1))
}

/// `−β κ |∇f| Δt` of a row, by (4) of the source with its signs mended.
#[inline(always)]
fn shrink_row(f: &Values, at: usize, tension: f32) -> [f32; EDGE] {
    let (dy, dz) = (wide(0, 1, 0), wide(0, 0, 1));
    let line = |offset: usize| line(f, offset);
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
    let mut is_flat = false;
    for i in 0..EDGE {
        let twice = 2.0 * c[i];
        let (x, y, z) = (0.5 * (xp[i] - xm[i]), 0.5 * (yp[i] - ym[i]), 0.5 * (zp[i] - zm[i]));
        let (xx, yy, zz) = (xp[i] + xm[i] - twice, yp[i] + ym[i] - twice, zp[i] + zm[i] - twice);
        // twice the mixed second derivatives
        let xy = 0.5 * ((xpyp[i] - xpym[i]) - (xmyp[i] - xmym[i]));
        let yz = 0.5 * ((ypzp[i] - ypzm[i]) - (ymzp[i] - ymzm[i]));
        let xz = 0.5 * ((xpzp[i] - xpzm[i]) - (xmzp[i] - xmzm[i]));
        let slope_sq = (x * x + y * y + z * z).max(FLAT);
        is_flat |= slope_sq <= FLAT;
        let sum = x * x * (yy + zz) + y * y * (xx + zz) + z * z * (xx + yy)
            - (x * y * xy + y * z * yz + x * z * xz);
        out[i] = tension * sum / slope_sq;
    }
    if is_flat {
        for i in 0..EDGE {
            let about = [xm[i], xp[i], ym[i], yp[i], zm[i], zp[i]];
            // about a node that a ball has shrunk onto nothing slopes, and it would stay: two of the three equal bends of a ball
            if about.iter().all(|value| (*value > 0.0) != (c[i] > 0.0)) {
                out[i] = tension * (2.0 / 3.0) * (about.iter().sum::<f32>() - 6.0 * c[i]);
            }
        }
    }
    out
}

/// `n·∇∇f n` of a row.
#[inline(always)]
fn bend_row(f: &Values, at: usize) -> [f32; EDGE] {
    let (dy, dz) = (wide(0, 1, 0), wide(0, 0, 1));
    let line = |offset: usize| line(f, offset);
    let c = line(at);
    let (xm, xp, ym, yp, zm, zp) =
        (line(at - 1), line(at + 1), line(at - dy), line(at + dy), line(at - dz), line(at + dz));
    let twist = |d: usize, e: usize| [line(at + d + e), line(at + d - e), line(at + e - d), line(at - d - e)];
    let (xy, yz, xz) = (twist(1, dy), twist(dy, dz), twist(1, dz));
    let mixed = |[pp, pm, mp, mm]: [&[f32; EDGE]; 4], i: usize| 0.25 * ((pp[i] - pm[i]) - (mp[i] - mm[i]));
    let mut out = [0.0; EDGE];
    for i in 0..EDGE {
        let twice = 2.0 * c[i];
        let (x, y, z) = (0.5 * (xp[i] - xm[i]), 0.5 * (yp[i] - ym[i]), 0.5 * (zp[i] - zm[i]));
        let straight = x * x * (xp[i] + xm[i] - twice)
            + y * y * (yp[i] + ym[i] - twice)
            + z * z * (zp[i] + zm[i] - twice);
        let across = x * y * mixed(xy, i) + y * z * mixed(yz, i) + x * z * mixed(xz, i);
        out[i] = (straight + 2.0 * across) / (x * x + y * y + z * z).max(FLAT);
    }
    out
}

/// How values are kept near distances.
struct Keeping {
    /// Shares of the way to `|∇f| = 1` near the surface, and farther out.
    settling: f32,
    redistance: f32,
    /// Whether all speeds are one, which is that of the edge of the band too: what is beyond it goes on as what is before it.
    moves_alike: bool,
}

/// How a row changes by its speeds and by what it shrinks, and as it is relaxed.
#[inline(always)]
fn move_row(
    f: &Values,
    at: usize,
    speeds: &[f32; EDGE],
    shrinking: &[f32; EDGE],
    beside: u8,
    &Keeping { settling, redistance, moves_alike }: &Keeping,
    fastest: &mut [f32; EDGE],
) -> [f32; EDGE] {
    let (dy, dz) = (wide(0, 1, 0), wide(0, 0, 1));
    let line = |offset: usize| line(f, offset);
    let c = line(at);
    let (xm, xp) = (line(at - 1), line(at + 1));
    let (ym, yp) = (line(at - dy), line(at + dy));
    let (zm, zp) = (line(at - dz), line(at + dz));
    let (mut changes, mut carried, mut slopes) = (*shrinking, [0.0; EDGE], [0.0; EDGE]);
    let mut drifts = [0.0; EDGE];
    let is_fast = speeds.iter().fold(0.0_f32, |fastest, speed| fastest.max(speed.abs())) > SLOW;
    for i in 0..EDGE {
        let c = c[i];
        let (before, after) = ([xm[i], ym[i], zm[i]], [xp[i], yp[i], zp[i]]);
        // slopes towards larger and towards smaller values, to second order where f is smooth; what moves alike takes those of
        // first order where nothing keeps waves from growing
        let is_inner = !moves_alike | (c.abs() < SETTLED);
        let keeps = if is_inner { 1.0 } else { 0.0 };
        let (mut rising, mut falling, mut slope_sq) = (0.0_f32, 0.0_f32, 0.0_f32);
        for k in 0..3 {
            let (below, above) = (c - before[k], after[k] - c);
            // beyond the band values stand still: what moves alike goes on as it comes
            let is_end = |value: f32| moves_alike & (value.abs() >= NEAR);
            let (is_end_before, is_end_after) = (is_end(before[k]), is_end(after[k]));
            let low = if is_end_before & !is_end_after { above } else { below };
            let high = if is_end_after & !is_end_before { below } else { above };
            let half_bend = (0.5 * (high - low)).clamp(-SMOOTH, SMOOTH);
            let (smooth_low, smooth_high) = (low + half_bend, high - half_bend);
            // towards the surface
            let along =
                if c > 0.0 { smooth_low.max(-smooth_high) } else { smooth_high.max(-smooth_low) }.max(0.0);
            slope_sq += along * along;
            let (low, high) = (low + keeps * half_bend, high - keeps * half_bend);
            let up = high.max(-low).max(0.0);
            let down = low.max(-high).max(0.0);
            rising += up * up;
            falling += down * down;
        }
        carried[i] = if speeds[i] > 0.0 { rising } else { falling }.sqrt();
        let slope = slope_sq.sqrt();
        let far = (c.abs() - SETTLED).clamp(0.0, 1.0);
        let share = settling + (redistance - settling) * far;
        let pull = share * (c / (c * c + 1.0).sqrt());
        changes[i] += pull * (1.0 - slope);
        slopes[i] = slope;
        drifts[i] = if moves_alike { speeds[i] - pull } else { speeds[i] };
    }
    if is_fast {
        // f_tt = a² n·∇∇f n  (Lax & Wendroff): nothing of a distance, but it keeps waves from growing; with what relaxes, where all
        // move alike, f_t = (a − ρS) |∇f| + ρS
        let bends = bend_row(f, at);
        for i in 0..EDGE {
            let bend = bends[i].clamp(-2.0 * SMOOTH, 2.0 * SMOOTH);
            let is_inner = !moves_alike | (c[i].abs() < SETTLED);
            changes[i] += if is_inner { 0.5 * drifts[i] * drifts[i] * bend } else { 0.0 };
        }
    }
    for i in 0..EDGE {
        changes[i] += speeds[i] * carried[i];
    }
    if beside != 0 {
        for i in 0..EDGE {
            // a level with a slope below one half is no distance, and moves further than it tells
            let move_of_surface = changes[i].abs() / slopes[i].max(0.5);
            fastest[i] = fastest[i].max(if beside >> i & 1 == 1 { move_of_surface } else { 0.0 });
        }
    }
    changes
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
