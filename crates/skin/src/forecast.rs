//! What a skin will cost, and what its grid will not see, before it is run.

use std::time::Instant;

use souple_engine::FieldState;
use souple_math::Vec3;
use souple_mesh::{BoundingBox, SignedDistance};

use crate::error::SkinError;
use crate::grid::{EDGE, FARTHEST, Lattice};
use crate::skin::{Skin, SkinScratch};
use crate::start::PlacedTarget;
use crate::strategy::{SurfacePoints, Whole};
use crate::surface::surface_of;
use crate::target::{Moment, Rows, Target, TargetScratch};

/// What a step of a skin takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// Of 8³ nodes.
    pub blocks: usize,
    /// Nodes worked out, in all sub-steps.
    pub nodes: u64,
    pub triangles: u64,
    /// Of the state, which a world holds twice, and of scratch.
    pub bytes: usize,
    pub seconds: f64,
}

/// Moments of a run at which a target is looked at.
const MOMENTS: u32 = 32;
/// What the grid sees of a surface is nearer to it than this, but for what is thinner than a voxel [voxels].
const SEEN: f64 = 2.0;
/// Blocks that are looked at for what is thin: some seconds of a target whose ranges are not known.
const MOST_LOOKED: usize = 1 << 16;
/// Places along each edge of a box at which potentials and speeds are asked for, and potentials at which speeds are.
const PLACES: u32 = 5;
const EXCESSES: u32 = 16;

impl Skin {
    /// What a step from a state to a moment takes; the state stays as it is.
    ///
    /// # Errors
    /// The step cannot be made.
    pub fn cost(&self, end: &Moment, timestep: f64, field: &FieldState) -> Result<Cost, SkinError> {
        let mut scratch = self.new_scratch();
        // once for buffers to be there
        self.step(end, timestep, &mut field.clone(), &mut scratch)?;
        let (mut field, clock) = (field.clone(), Instant::now());
        self.step(end, timestep, &mut field, &mut scratch)?;
        let seconds = clock.elapsed().as_secs_f64();
        let view = self.view(&field);
        Ok(Cost {
            blocks: view.grid.keys.len(),
            nodes: view.work(),
            triangles: view.counts()[1],
            bytes: 16 * (field.values.len() + field.indices.len()) + SkinScratch::bytes(&scratch),
            seconds,
        })
    }

    /// What the grid will not see of its target in so much time [s], with rows as they are now: what is thinner than a voxel, what
    /// moves faster than the skin, what leaves the space of the grid, what has no value; and what could not be looked at.
    pub fn doubts(&self, rows: &dyn Rows, duration: f64) -> Vec<String> {
        let Some(target) = &self.target else { return Vec::new() };
        let mut scratch = target.new_scratch();
        let mut times = (0..=MOMENTS).map(|k| duration * f64::from(k) / f64::from(MOMENTS));
        let lost = times.find_map(|time| {
            let why = self.lost(target, &Moment { time, rows }, &mut scratch)?;
            Some((time, why))
        });
        // nothing more is to be seen from there on
        let end = lost.as_ref().map_or(f64::INFINITY, |(time, _)| *time);
        let mut doubts: Vec<String> = lost.into_iter().map(|(_, why)| why).collect();
        if end > 0.0 {
            doubts.extend(self.outrun(target, rows, duration));
        }
        // parts come and go at their own times
        let comes = |time: &f64| 0.0 < *time && *time < duration;
        let mut looks: Vec<f64> =
            target.parts.iter().flat_map(|part| part.during).filter(comes).chain([0.0]).collect();
        looks.sort_by(f64::total_cmp);
        looks.dedup();
        let looks = looks.into_iter().filter(|time| *time < end);
        doubts.extend(looks.into_iter().find_map(|time| self.unseen(target, &Moment { time, rows })));
        doubts
    }

    /// Why a moment has no target that its grid could know.
    fn lost(&self, target: &Target, at: &Moment, scratch: &mut TargetScratch) -> Option<String> {
        let time = at.time;
        if let Err(why) = target.place(at, scratch) {
            return Some(format!("its target cannot be placed at t = {time} s: {why}"));
        }
        let Some(bounds) = target.bounds(scratch) else {
            return Some(format!(
                "its target does not say where it is at t = {time} s: what its grid does not see of it was not looked for"
            ));
        };
        let far = |point: Vec3| {
            let place = self.lattice.to_voxels(point) * (1.0 / EDGE as f64);
            place.to_array().iter().any(|c| c.is_nan() || c.abs() >= FARTHEST as f64)
        };
        if far(bounds.low) || far(bounds.high) {
            return Some(format!("its target leaves the space of its grid at t = {time} s"));
        }
        let mut values = places(bounds).into_iter().map(|place| (place, target.excess(place, scratch)));
        let (place, value) = values.find(|(_, value)| !value.is_finite())?;
        let place = place.to_array();
        Some(format!("{} at t = {time} s", SkinError::TargetNotANumber { value, place, part: String::new() }))
    }

    /// A part that moves faster than the skin can follow.
    fn outrun(&self, target: &Target, rows: &dyn Rows, duration: f64) -> Option<String> {
        let mut scratch = target.new_scratch();
        target.place(&Moment { time: 0.0, rows }, &mut scratch).ok()?;
        let bounds = target.bounds(&scratch)?;
        let fastest = self.fastest(bounds, target.range(bounds, &scratch)[1]);
        let moved = |index: usize| {
            let speed = |k: u32| {
                let part = &target.parts[index];
                let time = duration * f64::from(k) / f64::from(MOMENTS);
                (part.is_there(time)).then(|| (time, part.speed(time)))
            };
            let speeds = (0..=MOMENTS).filter_map(speed).filter(|(_, speed)| speed.is_finite());
            let (time, speed) = speeds.max_by(|a, b| a.1.total_cmp(&b.1))?;
            (speed > fastest && fastest > 0.0 && fastest.is_finite()).then(|| {
                format!(
                    "parts[{index}] of its target moves at {speed:.3} m/s at t = {time} s, and it follows at {fastest:.3} m/s at most: the skin will be left behind; a greater strength of its attraction lets it follow"
                )
            })
        };
        (0..target.parts.len()).find_map(moved)
    }

    /// The greatest speed at which its terms draw it out to a potential of at most so much above its iso value, of places all over a
    /// box and of potentials up to that [m/s].
    fn fastest(&self, bounds: BoundingBox, most: f64) -> f64 {
        let points = places(bounds);
        let whole = Whole { time: 0.0, area: 1.0, volume: 1.0, rest_area: 1.0, rest_volume: 1.0 };
        let speeds = |excess: f64| {
            let mut speeds = vec![0.0; points.len()];
            let at = SurfacePoints { points: &points, excess: &vec![excess; points.len()] };
            self.terms
                .iter()
                .filter(|term| term.needs_target())
                .for_each(|term| term.add_at(at, &whole, &mut speeds));
            speeds
        };
        let at_rest = speeds(0.0);
        let fastest = (1..=EXCESSES).flat_map(|k| {
            let driven = speeds(most * f64::from(k) / f64::from(EXCESSES));
            driven.into_iter().zip(&at_rest).map(|(driven, at_rest)| driven - at_rest).collect::<Vec<_>>()
        });
        fastest.fold(0.0, f64::max)
    }

    /// A place of the target that a grid of half the voxels sees, and its own does not; or why that is not known.
    fn unseen(&self, target: &Target, at: &Moment) -> Option<String> {
        let time = at.time;
        let unknown = |why: &dyn std::fmt::Display| {
            Some(format!(
                "it was not looked at whether its target has something thinner than a voxel at t = {time} s, by half of its voxels: {why}"
            ))
        };
        let mut scratch = target.new_scratch();
        if let Err(why) = target.place(at, &mut scratch) {
            return Some(format!("its target cannot be placed at t = {time} s: {why}"));
        }
        let Some(bounds) = target.bounds(&scratch) else { return unknown(&SkinError::NoDomain) };
        let placed = PlacedTarget { target, scratch: &scratch };
        let half = Skin {
            name: String::new(),
            lattice: Lattice { voxel: 0.5 * self.lattice.voxel, ..self.lattice },
            target: None,
            terms: Vec::new(),
            redistance: self.redistance,
            reaction: None,
        };
        let surface = |skin: &Skin| {
            let field = skin.sampled(bounds.low, bounds.high, &placed, MOST_LOOKED)?;
            Ok(surface_of(skin.grid(&field), &skin.lattice).0)
        };
        let fine = match surface(&half) {
            Ok(fine) => fine,
            Err(why @ SkinError::Empty { .. }) => return Some(format!("at t = {time} s {why}")),
            Err(why) => return unknown(&why),
        };
        // values between nodes come near zero at what is thin, triangles do not
        let seen = match surface(self) {
            Ok(own) => SignedDistance::new(own.into_surface()).ok(),
            Err(SkinError::Empty { .. }) => None,
            Err(why) => return unknown(&why),
        };
        let is_unseen = |point: &&Vec3| {
            let distance = |seen: &SignedDistance| seen.distance(**point).abs();
            seen.as_ref().map_or(f64::INFINITY, distance) > SEEN * self.lattice.voxel
        };
        // to a tenth of a voxel at least
        let decimals = (1.0 - self.lattice.voxel.log10()).ceil().clamp(0.0, 12.0) as usize;
        fine.points.iter().find(is_unseen).map(|place| {
            format!(
                "its target has something thinner than a voxel of {} m near [{}] at t = {time} s, which its grid does not see; smaller voxels would",
                self.lattice.voxel,
                place.to_array().map(|c| format!("{c:.decimals$}")).join(", "),
            )
        })
    }
}

/// Places all over a box, some along each of its edges.
fn places(bounds: BoundingBox) -> Vec<Vec3> {
    let size = bounds.size();
    let place = |k: u32| {
        let share = |index: u32| f64::from(index % PLACES) / f64::from(PLACES - 1);
        let along = Vec3::new(share(k), share(k / PLACES), share(k / PLACES / PLACES));
        bounds.low + Vec3::new(along.x * size.x, along.y * size.y, along.z * size.z)
    };
    (0..PLACES.pow(3)).map(place).collect()
}
