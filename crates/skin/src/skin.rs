//! A skin: its lattice, its target, its terms, and the step that moves its grid in State.

use std::sync::LazyLock;

use rayon::prelude::*;
use souple_engine::{FieldState, Interruption};
use souple_math::Vec3;

use crate::crossings::Crossings;
use crate::error::SkinError;
use crate::grid::{Grid, Lattice, Neighbours};
use crate::level_set::{Advance, Motion, Surface, advance, longest_step, relaxable};
use crate::marks::Marks;
use crate::polygons::{Audit, area_and_volume, polygonise};
use crate::reaction::{Reaction, ReactionScratch};
use crate::speeds::Speeds;
use crate::start::PlacedTarget;
use crate::strategy::{SurfacePoints, Term, Whole};
use crate::surface::{farthest_within, surface_of};
use crate::target::{Followed, Moment, Target, TargetScratch};
use crate::topology::note;
use crate::view::View;
use crate::waking::{Runaway, Waking};

/// The constant part of a skin.
pub struct Skin {
    pub name: String,
    pub lattice: Lattice,
    pub target: Option<Target>,
    pub terms: Vec<Box<dyn Term>>,
    /// Share of the way that `|∇f|` goes to 1 in a sub-step.
    pub redistance: f64,
    /// What it does to rows; their forces stand before the grid in State.
    pub reaction: Option<Reaction>,
}

/// Numbers at the beginning of a skin's values in State.
pub const HEAD: usize = 8;
pub(crate) const AREA: usize = 0;
pub(crate) const VOLUME: usize = 1;
pub(crate) const REST_AREA: usize = 2;
pub(crate) const REST_VOLUME: usize = 3;
/// Greatest speed of a node beside the surface in the last sub-step [m/s].
pub(crate) const SPEED: usize = 4;
/// When the topology changed last, of the changes that count [s].
pub(crate) const CHANGED: usize = 5;
/// Volume of what it dresses at the end of the first step in which it acts on it, at which its pressure is nothing [m³].
pub(crate) const FLESH: usize = 6;
/// When the topology that counts was left last [s].
pub(crate) const LEFT: usize = 7;

/// Integers before the keys of the blocks.
pub const HEAD_INDICES: usize = 10;
pub(crate) const EULER: usize = 0;
pub(crate) const COMPONENTS: usize = 1;
/// Changes of topology so far that count, see `topology`.
pub(crate) const EVENTS: usize = 2;
pub(crate) const POINTS: usize = 3;
pub(crate) const TRIANGLES: usize = 4;
/// Surfaces so far that were checked to be closed, oriented and manifold: one at the start, one for each step.
pub(crate) const CHECKED: usize = 5;
/// Nodes that the last step worked out, in all its sub-steps.
pub(crate) const WORK: usize = 6;
/// Euler characteristic and components after the last change that counts, or at the start.
pub(crate) const COUNTED: [usize; 2] = [7, 8];
/// Surfaces in a row, up to the last, that were other than what counts.
pub(crate) const WANDERED: usize = 9;

/// Blocks that a skin may have: 1 GB of values.
pub const MOST_BLOCKS: usize = 1 << 19;
/// Blocks that are looked at when a skin starts: half a billion nodes.
pub const MOST_SAMPLED: usize = 1 << 20;
/// Sub-steps of a step at most.
pub(crate) const MOST_SUBSTEPS: u32 = 2_000;
/// Points at which a target is evaluated at once.
const SOME_POINTS: usize = 256;
/// Points of the surface at which the slope of a target is measured in a sub-step, about so many.
const SLOPES: usize = 128;

/// What differs between two states of a run: its count of checked surfaces alone grows with each step. Area and volume, sums
/// over all of its surface, tell those of other runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Fingerprint {
    values: [u64; HEAD],
    indices: [u64; HEAD_INDICES],
    words: usize,
}

impl Fingerprint {
    fn of(field: &FieldState) -> Self {
        Self {
            values: std::array::from_fn(|k| field.values[k].to_bits()),
            indices: std::array::from_fn(|k| field.indices[k]),
            words: field.indices.len(),
        }
    }
}

/// Scratch of a skin.
pub struct SkinScratch {
    neighbours: Neighbours,
    marks: Vec<Marks>,
    next_marks: Vec<Marks>,
    pub(crate) crossings: Crossings,
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) excess: Vec<f64>,
    pub(crate) speeds: Vec<f64>,
    spread: Speeds,
    next: Vec<u64>,
    /// The grid that all of this is of, between steps.
    known: Option<Fingerprint>,
    waking: Waking,
    audit: Audit,
    /// Of its points: a third of each triangle around.
    pub(crate) area_vectors: Vec<Vec3>,
    pub(crate) reaction: ReactionScratch,
    pub(crate) target: Option<TargetScratch>,
    /// When the target was placed last [s].
    placed_at: f64,
}

impl SkinScratch {
    /// The surface of the last step.
    pub fn points(&self) -> &[Vec3] {
        &self.crossings.points
    }

    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    pub fn bytes(&self) -> usize {
        self.neighbours.bytes()
            + size_of::<Marks>() * (self.marks.capacity() + self.next_marks.capacity())
            + self.crossings.bytes()
            + 12 * self.triangles.capacity()
            + 8 * (self.excess.capacity() + self.speeds.capacity() + self.next.capacity())
            + self.spread.bytes()
            + self.waking.bytes()
            + self.audit.bytes()
            + 24 * self.area_vectors.capacity()
            + self.reaction.bytes()
    }
}

impl Skin {
    pub fn new_scratch(&self) -> SkinScratch {
        SkinScratch {
            neighbours: Neighbours::default(),
            marks: Vec::new(),
            next_marks: Vec::new(),
            crossings: Crossings::default(),
            triangles: Vec::new(),
            excess: Vec::new(),
            speeds: Vec::new(),
            spread: Speeds::default(),
            next: Vec::new(),
            known: None,
            waking: Waking::default(),
            audit: Audit::default(),
            area_vectors: Vec::new(),
            reaction: ReactionScratch::default(),
            target: self.target.as_ref().map(Target::new_scratch),
            placed_at: 0.0,
        }
    }

    /// Rows that it acts on.
    pub fn reactions(&self) -> usize {
        self.reaction.as_ref().map_or(0, |reaction| reaction.rows.len())
    }

    /// Rows that lead its target.
    pub fn followed(&self) -> Vec<Followed> {
        let parts = self.target.iter().flat_map(|target| &target.parts);
        parts.flat_map(|part| part.potential.followed()).collect()
    }

    pub(crate) fn voxel(&self) -> f64 {
        self.lattice.voxel
    }

    /// `β` of all terms [m²/s].
    fn tension(&self) -> f64 {
        self.terms.iter().map(|term| term.tension()).sum()
    }

    pub(crate) fn head(&self) -> usize {
        HEAD + 3 * self.reactions()
    }

    pub(crate) fn grid<'a>(&self, field: &'a FieldState) -> Grid<'a> {
        Grid::of_words(&field.indices[HEAD_INDICES..])
    }

    /// The surface of a grid, where it is not the one that the last step left.
    fn find_surface(&self, field: &FieldState, scratch: &mut SkinScratch) {
        // nothing is known of what a step leaves that fails
        let known = scratch.known.take();
        if known != Some(Fingerprint::of(field)) {
            self.find_blocks(field, scratch);
            self.find_crossings(field, scratch);
        }
    }

    pub(crate) fn find_blocks(&self, field: &FieldState, scratch: &mut SkinScratch) {
        scratch.neighbours.find(self.grid(field));
        Marks::find(self.grid(field), &mut scratch.marks);
    }

    pub(crate) fn find_crossings(&self, field: &FieldState, scratch: &mut SkinScratch) {
        scratch.crossings.find(self.grid(field), &scratch.neighbours, &scratch.marks, &self.lattice);
    }

    /// Moves the skin on by `timestep` [s] to the moment `end`.
    ///
    /// # Errors
    /// Why it cannot go on.
    pub fn step(
        &self,
        end: &Moment,
        timestep: f64,
        field: &mut FieldState,
        scratch: &mut SkinScratch,
    ) -> Result<(), SkinError> {
        // made once: a step allocates nothing
        static NEVER: LazyLock<Interruption> = LazyLock::new(Interruption::default);
        self.step_heeding(&NEVER, end, timestep, field, scratch)
    }

    /// The same, unless it is broken off before a sub-step.
    ///
    /// # Errors
    /// Why it cannot go on.
    pub fn step_heeding(
        &self,
        interruption: &Interruption,
        end: &Moment,
        timestep: f64,
        field: &mut FieldState,
        scratch: &mut SkinScratch,
    ) -> Result<(), SkinError> {
        let (mut done, mut substeps) = (0.0, 0);
        let start = end.time - timestep;
        if let (Some(target), Some(placed)) = (&self.target, &mut scratch.target) {
            target.place(end, placed).map_err(SkinError::Target)?;
            scratch.placed_at = end.time;
        }
        self.find_surface(field, scratch);
        field.indices[WORK] = 0;
        while done < timestep {
            interruption.check().map_err(|_| SkinError::Interrupted)?;
            if substeps > 0 {
                self.find_crossings(field, scratch);
                self.measure_size(field, scratch);
            }
            let now = start + done;
            let left = Left { timestep, seconds: timestep - done, substeps: MOST_SUBSTEPS - substeps };
            let (moves, parts) = self.next_moves(field, scratch, now, left)?;
            let substep = left.seconds / f64::from(parts);
            let moved = self.move_by(field, scratch, moves, now + substep)?;
            field.values[SPEED] = moved * self.voxel() / substep;
            done = if parts == 1 { timestep } else { done + substep };
            substeps += 1;
        }
        self.find_crossings(field, scratch);
        self.measure(field, scratch, end.time)?;
        self.react(field, scratch, end)?;
        scratch.known = Some(Fingerprint::of(field));
        Ok(())
    }

    /// How far the surface goes in the next sub-step, its speeds in `scratch` in voxels, and in how many such parts what is
    /// left of the step is taken: as many as the speeds ask that are then applied, those in the middle of the sub-step.
    fn next_moves(
        &self,
        field: &FieldState,
        scratch: &mut SkinScratch,
        now: f64,
        left: Left,
    ) -> Result<(Moves, u32), SkinError> {
        let h = self.voxel();
        if scratch.crossings.points.is_empty() {
            // of a skin that is gone nothing comes back
            scratch.speeds.clear();
            return Ok((Moves { uniform: 0.0, tension: 0.0, redistance: 0.0 }, 1));
        }
        scratch.excess.clear();
        scratch.excess.resize(scratch.crossings.points.len(), 0.0);
        if self.terms.iter().any(|term| term.needs_target()) {
            self.find_excess(scratch);
        }
        let answer = self.answer(field, scratch, now);
        let mut asked = self.add_speeds(field, scratch, now)?;
        let is_timed = self.terms.iter().any(|term| term.is_timed());
        let mut parts = 1;
        loop {
            let longest = self.longest_substep(asked.fastest, answer);
            let wanted = (left.seconds / longest).ceil().max(1.0);
            if wanted.is_nan() || wanted > f64::from(left.substeps) {
                return Err(SkinError::TooManySubsteps { timestep: left.timestep, substep: longest });
            }
            let is_enough = wanted <= f64::from(parts);
            parts = parts.max(wanted as u32);
            let substep = left.seconds / f64::from(parts);
            if is_timed && !(is_enough && asked.time == now + 0.5 * substep) {
                asked = self.add_speeds(field, scratch, now + 0.5 * substep)?;
                continue;
            }
            scratch.speeds.iter_mut().for_each(|speed| *speed *= substep / h);
            let tension = self.tension() * substep / (h * h);
            let redistance = self.redistance.min(relaxable(asked.fastest * substep / h, tension));
            return Ok((Moves { uniform: asked.uniform * substep / h, tension, redistance }, parts));
        }
    }

    /// Area and volume as they stand within a step, where a term asks.
    fn measure_size(&self, field: &mut FieldState, scratch: &mut SkinScratch) {
        if !self.terms.iter().any(|term| term.looks_at_size()) {
            return;
        }
        polygonise(&scratch.neighbours, &scratch.marks, &scratch.crossings, &mut scratch.triangles);
        let (area, volume) = area_and_volume(&scratch.crossings.points, &scratch.triangles);
        field.values[AREA] = area;
        field.values[VOLUME] = volume;
    }

    fn whole(&self, field: &FieldState, time: f64) -> Whole {
        let head = &field.values;
        Whole {
            time,
            area: head[AREA],
            volume: head[VOLUME],
            rest_area: head[REST_AREA],
            rest_volume: head[REST_VOLUME],
        }
    }

    /// Whether its speed without tension differs from place to place.
    fn varies(&self) -> bool {
        self.terms.iter().any(|term| term.varies())
    }

    /// The part of the speed that is the same everywhere [m/s].
    fn uniform(&self, whole: &Whole) -> Result<f64, SkinError> {
        let mut sum = 0.0;
        for (term, entry) in self.terms.iter().enumerate() {
            let speed = entry.uniform(whole);
            if !speed.is_finite() {
                let Whole { time, area, volume, .. } = *whole;
                let expected = entry.expected(whole);
                return Err(SkinError::Term { term, speed, area, volume, time, expected });
            }
            sum += speed;
        }
        Ok(sum)
    }

    /// Speeds of the crossings without tension [m/s].
    fn add_speeds(
        &self,
        field: &FieldState,
        scratch: &mut SkinScratch,
        time: f64,
    ) -> Result<Asked, SkinError> {
        let points = &scratch.crossings.points;
        let whole = self.whole(field, time);
        let uniform = self.uniform(&whole)?;
        scratch.speeds.clear();
        scratch.speeds.resize(points.len(), uniform);
        for term in &self.terms {
            term.add_at(SurfacePoints { points, excess: &scratch.excess }, &whole, &mut scratch.speeds);
        }
        let mut fastest = 0.0_f64;
        for (index, speed) in scratch.speeds.iter().enumerate() {
            if !speed.is_finite() {
                return Err(self.no_speed(points[index], (scratch.excess[index], *speed), &whole, scratch));
            }
            fastest = fastest.max(speed.abs());
        }
        Ok(Asked { time, uniform, fastest })
    }

    /// Why a point has no speed: what its target is there, or which of its terms is none.
    fn no_speed(
        &self,
        point: Vec3,
        (excess, speed): (f64, f64),
        whole: &Whole,
        scratch: &SkinScratch,
    ) -> SkinError {
        let (place, time) = (point.to_array(), whole.time);
        if !excess.is_finite() {
            let placed = self.target.as_ref().zip(scratch.target.as_ref());
            let part = placed.and_then(|(target, placed)| target.broken_part(point, placed));
            let part = part.map(|part| format!("parts[{part}] of ")).unwrap_or_default();
            let part = format!("at t = {} s {part}", scratch.placed_at);
            return SkinError::TargetNotANumber { value: excess, place, part };
        }
        let at = SurfacePoints { points: &[point], excess: &[excess] };
        let term = self.terms.iter().position(|term| {
            let mut own = [0.0];
            term.add_at(at, whole, &mut own);
            !own[0].is_finite()
        });
        let term = term.map(|term| format!("by terms[{term}] ")).unwrap_or_default();
        SkinError::Speed { speed, place, time, term }
    }

    /// The target's potential less its iso value at the crossings.
    pub(crate) fn find_excess(&self, scratch: &mut SkinScratch) {
        let points = &scratch.crossings.points;
        scratch.excess.clear();
        scratch.excess.resize(points.len(), 0.0);
        if let (Some(target), Some(placed)) = (&self.target, &scratch.target) {
            let chunks = scratch.excess.par_chunks_mut(SOME_POINTS).zip(points.par_chunks(SOME_POINTS));
            chunks.for_each(|(excess, points)| target.excesses(points, placed, excess));
        }
    }

    /// How fast terms answer a move of the surface that they made themselves [1/s], the most of some points spread over it:
    /// beyond that they would overshoot, and the skin never rest.
    fn answer(&self, field: &FieldState, scratch: &SkinScratch, time: f64) -> f64 {
        let whole = self.whole(field, time);
        let target = self.target.as_ref().zip(scratch.target.as_ref());
        let (points, excess) = (&scratch.crossings.points, &scratch.excess);
        let stride = points.len().div_ceil(SLOPES).max(1);
        let answer = |(point, excess): (&Vec3, &f64)| {
            let terms = || self.terms.iter();
            let to_size: f64 = terms().map(|term| term.answer(*point, *excess, &whole)).sum();
            let stiffness: f64 = terms().map(|term| term.stiffness(*point, *excess, &whole)).sum();
            let slope = target.filter(|_| stiffness > 0.0).map_or(0.0, |(target, placed)| {
                // over a voxel: a jump of the potential is as steep as the grid can tell
                target.slope(*point, 0.5 * self.voxel(), placed)
            });
            to_size + stiffness * slope
        };
        points.iter().zip(excess).step_by(stride).map(answer).fold(0.0, f64::max)
    }

    fn longest_substep(&self, fastest: f64, answer: f64) -> f64 {
        let h = self.voxel();
        // a term that answers itself goes half the way at most
        longest_step(fastest / h, self.tension() / (h * h)).min(0.5 / answer)
    }

    /// One sub-step, with the speeds of the crossings in voxels; how far the surface moved [voxels].
    pub(crate) fn move_by(
        &self,
        field: &mut FieldState,
        scratch: &mut SkinScratch,
        moves: Moves,
        time: f64,
    ) -> Result<f64, SkinError> {
        let (neighbours, crossings) = (&scratch.neighbours, &scratch.crossings);
        let surface = Surface { grid: self.grid(field), neighbours, marks: &scratch.marks, crossings };
        if self.varies() {
            scratch.spread.spread(neighbours, crossings, &scratch.speeds);
        }
        let Moves { uniform, tension, redistance } = moves;
        let speeds = self.varies().then_some(&scratch.spread);
        let motion = Motion {
            speeds,
            uniform: uniform as f32,
            tension: tension as f32,
            redistance: redistance as f32,
        };
        let next = &mut scratch.next;
        let first = HEAD_INDICES + surface.grid.keys.len();
        next.resize(field.indices.len(), 0);
        next[..first].copy_from_slice(&field.indices[..first]);
        scratch.next_marks.resize(scratch.marks.len(), Marks::default());
        let Advance { moved, nodes } =
            advance(surface, motion, bytemuck::cast_slice_mut(&mut next[first..]), &mut scratch.next_marks);
        next[WORK] += nodes;
        std::mem::swap(&mut field.indices, next);
        std::mem::swap(&mut scratch.marks, &mut scratch.next_marks);
        let changed = scratch
            .waking
            .update(&mut field.indices, HEAD_INDICES, &scratch.neighbours, &mut scratch.marks)
            .map_err(|Runaway| SkinError::Runaway { time })?;
        if changed {
            let blocks = scratch.marks.len();
            if blocks > MOST_BLOCKS {
                return Err(SkinError::Grown { blocks, time });
            }
            scratch.neighbours.find(self.grid(field));
        }
        Ok(moved.into())
    }

    /// Triangles at the crossings found, their measures, and whether the topology changed.
    pub(crate) fn measure(
        &self,
        field: &mut FieldState,
        scratch: &mut SkinScratch,
        time: f64,
    ) -> Result<(), SkinError> {
        polygonise(&scratch.neighbours, &scratch.marks, &scratch.crossings, &mut scratch.triangles);
        let (points, triangles) = (&scratch.crossings.points, &scratch.triangles);
        let (area, volume) = area_and_volume(points, triangles);
        let topology = scratch.audit.check(points.len(), triangles);
        let (euler, components) = topology.map_err(|torn| SkinError::Torn { torn, time })?;
        field.values[AREA] = area;
        field.values[VOLUME] = volume;
        note(field, [euler as u64, components], time);
        let indices = &mut field.indices;
        indices[CHECKED] += 1;
        indices[POINTS] = points.len() as u64;
        indices[TRIANGLES] = triangles.len() as u64;
        Ok(())
    }

    /// Hausdorff's distance between its surface and that of its target at a moment, both as triangles of its lattice [m]; `None`
    /// where one of them is not there. Within the band the target's is its potential over its slope: to first order.
    pub fn distance(&self, at: &Moment, field: &FieldState) -> Option<f64> {
        let target = self.target.as_ref()?;
        let mut placed = target.new_scratch();
        target.place(at, &mut placed).ok()?;
        let bounds = target.bounds(&placed)?;
        let sampled = self
            .sampled(bounds.low, bounds.high, &PlacedTarget { target, scratch: &placed }, MOST_SAMPLED)
            .ok()?;
        let [own_grid, aim_grid] = [field, &sampled].map(|field| self.view(field).grid);
        let [own, aim] = [own_grid, aim_grid].map(|grid| surface_of(grid, &self.lattice).0);
        if own.points.is_empty() || aim.points.is_empty() {
            return None;
        }
        // by a look-up of the other's values while both are within each other's band, else among its triangles
        let near = farthest_within(&own.points, aim_grid, &self.lattice);
        match near.zip(farthest_within(&aim.points, own_grid, &self.lattice)) {
            Some((there, back)) => Some(there.max(back)),
            None => Some(own.farthest_from(&aim)?.max(aim.farthest_from(&own)?)),
        }
    }

    /// A reader's view of the state.
    pub fn view<'a>(&self, field: &'a FieldState) -> View<'a> {
        View::new(field, self.reactions())
    }
}

/// What terms ask for at a moment.
struct Asked {
    /// [s]
    time: f64,
    /// Speed that is the same everywhere [m/s].
    uniform: f64,
    /// The greatest at a crossing [m/s].
    fastest: f64,
}

/// What is left of a step.
#[derive(Clone, Copy)]
struct Left {
    /// Of the whole step [s].
    timestep: f64,
    seconds: f64,
    /// Sub-steps that may be taken.
    substeps: u32,
}

/// A sub-step in voxels.
#[derive(Clone, Copy)]
pub(crate) struct Moves {
    pub uniform: f64,
    pub tension: f64,
    pub redistance: f64,
}
