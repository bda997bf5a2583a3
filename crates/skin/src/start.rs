//! How a skin starts: the blocks around the zero level of a function, their values made distances.

use rayon::prelude::*;
use souple_engine::FieldState;
use souple_math::Vec3;

use crate::error::SkinError;
use crate::grid::{BAND, EDGE, FARTHEST, NODES, key_of, wide};
use crate::level_set::relaxable;
use crate::skin::{
    AREA, EVENTS, HEAD_INDICES, MOST_BLOCKS, MOST_SAMPLED, Moves, REST_AREA, REST_VOLUME, Skin, SkinScratch,
    VOLUME,
};

impl Skin {
    /// The state of a skin that begins as the zero level of `value` within a box [m].
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
        let mut field = self.sampled(low, high, value)?;
        self.make_distance(&mut field, scratch)?;
        self.find_crossings(&field, scratch);
        self.measure(&mut field, scratch, 0.0)?;
        field.values[REST_AREA] = field.values[AREA];
        field.values[REST_VOLUME] = field.values[VOLUME];
        field.indices[EVENTS] = 0;
        Ok(field)
    }

    /// The zero level of `value` within a box [m], on the nodes around it; nothing is measured.
    ///
    /// # Errors
    /// There is no inside, it does not end within the box, or it is too large for its voxels.
    pub(crate) fn sampled(
        &self,
        low: Vec3,
        high: Vec3,
        value: &(dyn Fn(Vec3) -> f64 + Sync),
    ) -> Result<FieldState, SkinError> {
        let edge = EDGE as f64;
        // one block around, so that all ends within
        let first = self.lattice.to_voxels(low).to_array().map(|c| (c / edge).floor() - 1.0);
        let last = self.lattice.to_voxels(high).to_array().map(|c| (c / edge).floor() + 1.0);
        let counts = [0, 1, 2].map(|axis| (last[axis] - first[axis] + 1.0).max(1.0));
        let blocks: f64 = counts.iter().product();
        if first.iter().chain(&last).any(|c| c.is_nan() || c.abs() >= FARTHEST as f64) {
            return Err(SkinError::TooFar {
                low: low.to_array(),
                high: high.to_array(),
                voxel: self.voxel(),
            });
        }
        if blocks > MOST_SAMPLED as f64 {
            let size = (high - low).to_array();
            return Err(SkinError::TooManyBlocks { voxel: self.voxel(), size, blocks });
        }
        let mut field = FieldState { values: vec![0.0; self.head()], indices: vec![0; HEAD_INDICES] };
        self.sample(first.map(|c| c as i64), counts.map(|c| c as i64), value, &mut field)?;
        if crate::polygons::is_empty(self.grid(&field)) {
            let (low, high) = (low.to_array(), high.to_array());
            return Err(SkinError::Empty { low, high, voxel: self.voxel() });
        }
        Ok(field)
    }

    /// Values in voxels, by the slope between neighbours, of the blocks within the band.
    fn sample(
        &self,
        first: [i64; 3],
        counts: [i64; 3],
        value: &(dyn Fn(Vec3) -> f64 + Sync),
        field: &mut FieldState,
    ) -> Result<(), SkinError> {
        let lattice = self.lattice;
        let at =
            move |node: [i64; 3]| lattice.to_world(Vec3::new(node[0] as f64, node[1] as f64, node[2] as f64));
        let edge = EDGE as i64;
        let mut words: Vec<u64> = Vec::new();
        // slab by slab of blocks along z: a wide block's values, or nothing where it is uniform
        for z in 0..counts[2] {
            let slab: Vec<Result<Sampled, SkinError>> = (0..counts[0] * counts[1])
                .into_par_iter()
                .map(|i| {
                    let block = [first[0] + i % counts[0], first[1] + i / counts[0], first[2] + z];
                    let is_border = [i % counts[0], i / counts[0], z]
                        .iter()
                        .zip(counts)
                        .any(|(c, count)| *c == 0 || *c == count - 1);
                    let mut values = vec![0.0; 1000];
                    let (mut inside, mut outside) = (false, false);
                    for (index, out) in values.iter_mut().enumerate() {
                        let i = index as i64;
                        let node = [i % 10, i / 10 % 10, i / 100];
                        let place = at([0, 1, 2].map(|axis| edge * block[axis] + node[axis] - 1));
                        let f = value(place);
                        let is_own = node.iter().all(|c| (1..=edge).contains(c));
                        if !f.is_finite() {
                            return Err(SkinError::TargetNotANumber { value: f, place: place.to_array() });
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
                })
                .collect();
            for block in slab {
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

    /// Wakes the whole band, and makes values distances.
    fn make_distance(&self, field: &mut FieldState, scratch: &mut SkinScratch) -> Result<(), SkinError> {
        // a kink runs through the band in as many steps as it has half voxels, and as many again settle it
        self.find_blocks(field, scratch);
        for _ in 0..8 * BAND as usize {
            self.find_crossings(field, scratch);
            scratch.speeds.clear();
            scratch.speeds.resize(scratch.crossings.points.len(), 0.0);
            let moves =
                Moves { uniform: 0.0, tension: 0.0, redistance: (2.0 * self.redistance).min(relaxable(0.0)) };
            self.move_by(field, scratch, moves, 0.0)?;
        }
        Ok(())
    }
}

/// The key and the values of a block; nothing of one beyond the band.
type Sampled = Option<(u64, Vec<f64>)>;

/// Values over the greatest slope to a neighbour, of a block with the nodes around it: near distances in voxels.
fn distances(values: &[f64]) -> Vec<f64> {
    let mut out = Vec::with_capacity(NODES);
    for z in 0..EDGE {
        for y in 0..EDGE {
            for x in 0..EDGE {
                let at = wide(x + 1, y + 1, z + 1);
                let f = values[at];
                let slope_sq: f64 = [1, wide(0, 1, 0), wide(0, 0, 1)]
                    .iter()
                    .map(|d| {
                        let (low, high) = (f - values[at - d], values[at + d] - f);
                        // at a ridge the greater slope, where it is smooth the middle one
                        let is_ridge = low * high < 0.0;
                        let slope = if is_ridge { low.abs().max(high.abs()) } else { 0.5 * (low + high) };
                        slope * slope
                    })
                    .sum();
                let distance = if slope_sq > 0.0 { f / slope_sq.sqrt() } else { f.signum() * BAND };
                out.push(if f == 0.0 { 0.0 } else { distance.clamp(-BAND, BAND) });
            }
        }
    }
    out
}
