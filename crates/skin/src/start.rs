//! How a skin starts: the blocks around the zero level of a function, their values made distances.
//!
//! Blocks are looked for from coarse to fine: cubes of blocks in which the function is known to keep its sign are left out
//! as wholes, so that the cost follows the surface where ranges of the function are known.

use rayon::prelude::*;
use souple_engine::FieldState;
use souple_math::Vec3;
use souple_mesh::BoundingBox;

use crate::error::SkinError;
use crate::grid::{BAND, EDGE, FARTHEST, NODES, key_of, wide};
use crate::level_set::relaxable;
use crate::skin::{
    AREA, COMPONENTS, COUNTED, EULER, HEAD_INDICES, MOST_BLOCKS, MOST_SAMPLED, Moves, REST_AREA, REST_VOLUME,
    Skin, SkinScratch, VOLUME,
};
use crate::target::{Between, Target, TargetScratch, UNKNOWN};

/// A function whose zero level a skin begins as.
pub trait Beginning: Sync {
    fn value(&self, point: Vec3) -> f64;

    /// Two numbers that it lies between within a box.
    fn range(&self, within: BoundingBox) -> Between;

    /// Which of its parts is no number at a place.
    fn broken_part(&self, _point: Vec3) -> Option<usize> {
        None
    }
}

/// A function of which nothing is known but its values.
struct Unknown<'a>(&'a (dyn Fn(Vec3) -> f64 + Sync));

impl Beginning for Unknown<'_> {
    fn value(&self, point: Vec3) -> f64 {
        (self.0)(point)
    }

    fn range(&self, _: BoundingBox) -> Between {
        UNKNOWN
    }
}

/// A target where it is.
pub struct PlacedTarget<'a> {
    pub target: &'a Target,
    pub scratch: &'a TargetScratch,
}

impl Beginning for PlacedTarget<'_> {
    fn value(&self, point: Vec3) -> f64 {
        self.target.excess(point, self.scratch)
    }

    fn range(&self, within: BoundingBox) -> Between {
        self.target.range(within, self.scratch)
    }

    fn broken_part(&self, point: Vec3) -> Option<usize> {
        self.target.broken_part(point, self.scratch)
    }
}

/// The blocks of a box, and one around, so that all ends within.
#[derive(Clone, Copy)]
struct Blocks {
    first: [i64; 3],
    counts: [i64; 3],
}

impl Blocks {
    fn is_border(&self, block: [i64; 3]) -> bool {
        (0..3).any(|axis| {
            let place = block[axis] - self.first[axis];
            place == 0 || place == self.counts[axis] - 1
        })
    }
}

/// A cube of `2^level` blocks along each edge, by its lowest block.
#[derive(Clone, Copy)]
struct Cube {
    low: [i64; 3],
    level: u32,
}

/// Blocks whose values are held at once, 64 MB.
const AT_ONCE: usize = 1 << 14;

impl Skin {
    /// The state of a skin that begins as the zero level of `value` within a box [m], of which all is looked at.
    ///
    /// # Errors
    /// There is no inside, it does not end within the box, or it is too large for its voxels.
    pub fn start(
        &self,
        low: Vec3,
        high: Vec3,
        value: &(dyn Fn(Vec3) -> f64 + Sync),
        scratch: &mut SkinScratch,
    ) -> Result<FieldState, SkinError> {
        self.begin(low, high, &Unknown(value), scratch)
    }

    /// The same of a function whose ranges are known.
    ///
    /// # Errors
    /// There is no inside, it does not end within the box, or it is too large for its voxels.
    pub fn begin(
        &self,
        low: Vec3,
        high: Vec3,
        as_what: &dyn Beginning,
        scratch: &mut SkinScratch,
    ) -> Result<FieldState, SkinError> {
        let mut field = self.sampled(low, high, as_what, MOST_SAMPLED)?;
        self.make_distance(&mut field, scratch)?;
        self.find_crossings(&field, scratch);
        self.measure(&mut field, scratch, 0.0)?;
        field.values[REST_AREA] = field.values[AREA];
        field.values[REST_VOLUME] = field.values[VOLUME];
        COUNTED
            .into_iter()
            .zip([EULER, COMPONENTS])
            .for_each(|(to, from)| field.indices[to] = field.indices[from]);
        Ok(field)
    }

    /// The zero level of a function within a box [m], on the nodes around it; nothing is measured. At most so many blocks are
    /// looked at.
    ///
    /// # Errors
    /// There is no inside, it does not end within the box, or it is too large for its voxels.
    pub(crate) fn sampled(
        &self,
        low: Vec3,
        high: Vec3,
        as_what: &dyn Beginning,
        most: usize,
    ) -> Result<FieldState, SkinError> {
        let edge = EDGE as f64;
        let first = self.lattice.to_voxels(low).to_array().map(|c| (c / edge).floor() - 1.0);
        let last = self.lattice.to_voxels(high).to_array().map(|c| (c / edge).floor() + 1.0);
        let counts = [0, 1, 2].map(|axis| (last[axis] - first[axis] + 1.0).max(1.0));
        if first.iter().chain(&last).any(|c| c.is_nan() || c.abs() >= FARTHEST as f64) {
            return Err(SkinError::TooFar {
                low: low.to_array(),
                high: high.to_array(),
                voxel: self.voxel(),
            });
        }
        let blocks = Blocks { first: first.map(|c| c as i64), counts: counts.map(|c| c as i64) };
        let too_many = |cubes: usize, level: u32| SkinError::TooManyCubes {
            voxel: self.voxel(),
            size: (high - low).to_array(),
            most,
            cubes,
            edge: edge * f64::from(level).exp2() * self.voxel(),
        };
        let mut found = self.looked_for(blocks, as_what, most, &too_many)?;
        // along rows, as keys ascend
        found.sort_unstable_by_key(|block| key_of(*block));
        let mut field = FieldState { values: vec![0.0; self.head()], indices: vec![0; HEAD_INDICES] };
        self.sample(blocks, &found, as_what, &mut field)?;
        if crate::polygons::is_empty(self.grid(&field)) {
            let (low, high) = (low.to_array(), high.to_array());
            return Err(SkinError::Empty { low, high, voxel: self.voxel() });
        }
        Ok(field)
    }

    /// Blocks in which a function may change its sign, or come near to that; `too_many` says of how many cubes of a level that
    /// they are more than `most`.
    fn looked_for(
        &self,
        blocks: Blocks,
        as_what: &dyn Beginning,
        most: usize,
        too_many: &dyn Fn(usize, u32) -> SkinError,
    ) -> Result<Vec<[i64; 3]>, SkinError> {
        let widest = blocks.counts.into_iter().max().unwrap_or(1);
        let level = u64::try_from(widest).unwrap_or(1).next_power_of_two().trailing_zeros();
        let mut cubes = vec![Cube { low: blocks.first, level }];
        // level by level, each cube into its eight
        loop {
            let kept: Vec<Result<Option<Cube>, SkinError>> = cubes
                .par_iter()
                .map(|cube| Ok(self.may_change(blocks, *cube, as_what)?.then_some(*cube)))
                .collect();
            let mut finer = Vec::new();
            for cube in kept {
                let Some(Cube { low, level }) = cube? else { continue };
                if level == 0 {
                    finer.push(Cube { low, level });
                    continue;
                }
                let half = 1 << (level - 1);
                let eighths =
                    (0..8).map(|corner| [0, 1, 2].map(|axis: usize| low[axis] + half * (corner >> axis & 1)));
                let is_within =
                    |low: &[i64; 3]| (0..3).all(|axis| low[axis] < blocks.first[axis] + blocks.counts[axis]);
                finer.extend(eighths.filter(is_within).map(|low| Cube { low, level: level - 1 }));
            }
            if finer.len() > most {
                return Err(too_many(finer.len(), finer[0].level));
            }
            let is_finest = cubes.first().is_none_or(|cube| cube.level == 0);
            cubes = finer;
            if is_finest {
                return Ok(cubes.into_iter().map(|cube| cube.low).collect());
            }
        }
    }

    /// Whether a function may change its sign in a cube of blocks, or within the band around it.
    fn may_change(&self, blocks: Blocks, cube: Cube, as_what: &dyn Beginning) -> Result<bool, SkinError> {
        let node = |block: [i64; 3], by: f64| {
            let [x, y, z] = block.map(|c| (c * EDGE as i64) as f64 + by);
            self.lattice.to_world(Vec3::new(x, y, z))
        };
        let beyond = cube.low.map(|c| c + (1 << cube.level));
        // one node more to both sides for slopes
        let (low, high) = (node(cube.low, -BAND - 1.0), node(beyond, BAND));
        let [least, most] = as_what.range(BoundingBox { low, high });
        let end = |axis: usize| (blocks.first[axis] + blocks.counts[axis]).min(beyond[axis]) - 1;
        let highest = [0, 1, 2].map(end);
        if least > 0.0
            && let Some(block) = [cube.low, highest].into_iter().find(|block| blocks.is_border(*block))
        {
            return Err(SkinError::BeyondDomain { place: node(block, 0.0).to_array() });
        }
        Ok(!(least > 0.0 || most < 0.0))
    }

    /// Values in voxels, by the slope between neighbours, of the blocks within the band.
    fn sample(
        &self,
        blocks: Blocks,
        found: &[[i64; 3]],
        as_what: &dyn Beginning,
        field: &mut FieldState,
    ) -> Result<(), SkinError> {
        let mut words: Vec<u64> = Vec::new();
        for some in found.chunks(AT_ONCE) {
            let sampled: Vec<Result<Sampled, SkinError>> =
                some.par_iter().map(|block| self.sample_block(blocks, *block, as_what)).collect();
            for block in sampled {
                if let Some((key, values)) = block? {
                    field.indices.push(key);
                    let (pairs, _) = values.as_chunks::<2>();
                    words.extend(
                        pairs.iter().map(|pair| bytemuck::cast::<[f32; 2], u64>(pair.map(|f| f as f32))),
                    );
                    let blocks = field.indices.len() - HEAD_INDICES;
                    if blocks > MOST_BLOCKS {
                        return Err(SkinError::Grown { blocks, time: 0.0 });
                    }
                }
            }
        }
        field.indices.extend(words);
        Ok(())
    }

    fn sample_block(
        &self,
        blocks: Blocks,
        block: [i64; 3],
        as_what: &dyn Beginning,
    ) -> Result<Sampled, SkinError> {
        let edge = EDGE as i64;
        let is_border = blocks.is_border(block);
        let mut values = vec![0.0; 1000];
        let (mut inside, mut outside) = (false, false);
        for (index, out) in values.iter_mut().enumerate() {
            let i = index as i64;
            let node = [i % 10, i / 10 % 10, i / 100];
            let [x, y, z] = [0, 1, 2].map(|axis| (edge * block[axis] + node[axis] - 1) as f64);
            let place = self.lattice.to_world(Vec3::new(x, y, z));
            let f = as_what.value(place);
            let is_own = node.iter().all(|c| (1..=edge).contains(c));
            if !f.is_finite() {
                let part = as_what.broken_part(place);
                let part = part.map(|part| format!("parts[{part}] of ")).unwrap_or_default();
                return Err(SkinError::TargetNotANumber { value: f, place: place.to_array(), part });
            }
            if is_border && is_own && f > 0.0 {
                return Err(SkinError::BeyondDomain { place: place.to_array() });
            }
            (inside, outside) = (inside | (f > 0.0), outside | (f <= 0.0));
            *out = f;
        }
        let distances = distances(&values);
        let is_near = (inside && outside) || distances.iter().any(|f| f.abs() < BAND);
        Ok(is_near.then(|| (key_of(block), distances)))
    }

    /// Wakes the whole band, and makes values distances.
    fn make_distance(&self, field: &mut FieldState, scratch: &mut SkinScratch) -> Result<(), SkinError> {
        // a kink runs through the band in as many steps as it has half voxels, and as many again settle it
        self.find_blocks(field, scratch);
        for _ in 0..8 * BAND as usize {
            self.find_crossings(field, scratch);
            scratch.speeds.clear();
            scratch.speeds.resize(scratch.crossings.points.len(), 0.0);
            let moves = Moves {
                uniform: 0.0,
                tension: 0.0,
                redistance: (2.0 * self.redistance).min(relaxable(0.0, 0.0)),
            };
            self.move_by(field, scratch, moves, 0.0)?;
        }
        Ok(())
    }
}

/// The key and the values of a block; nothing of one beyond the band.
type Sampled = Option<(u64, Vec<f64>)>;

/// Square of the share of the slope that turns round at a ridge along an axis, at least; where a surface is bent over some
/// voxels it is the inverse of these.
const RIDGE: f64 = 0.25;

/// Values over the greatest slope to a neighbour, of a block with the nodes around it: near distances in voxels.
fn distances(values: &[f64]) -> Vec<f64> {
    let mut out = Vec::with_capacity(NODES);
    for z in 0..EDGE {
        for y in 0..EDGE {
            for x in 0..EDGE {
                let at = wide(x + 1, y + 1, z + 1);
                let f = values[at];
                let slopes =
                    [1, wide(0, 1, 0), wide(0, 0, 1)].map(|d| (f - values[at - d], values[at + d] - f));
                let middle_sq: f64 = slopes.iter().map(|(low, high)| 0.25 * (low + high).powi(2)).sum();
                let slope_sq: f64 = slopes
                    .iter()
                    .map(|(low, high)| {
                        let greater_sq = low.abs().max(high.abs()).powi(2);
                        // at a ridge the greater slope; where it is smooth, as at the top of a ball, the middle one
                        let is_ridge = low * high < 0.0 && greater_sq > RIDGE * middle_sq;
                        if is_ridge { greater_sq } else { 0.25 * (low + high).powi(2) }
                    })
                    .sum();
                let distance = if slope_sq > 0.0 { f / slope_sq.sqrt() } else { f.signum() * BAND };
                out.push(if f == 0.0 { 0.0 } else { distance.clamp(-BAND, BAND) });
            }
        }
    }
    out
}
