//! Targets: potentials that a skin is drawn to, above one half inside.
//!
//! A target is a list of parts, put together in their order: blended by their sum, joined, cut, met. A part is an entry
//! of [`PARTS`]; it may be warped, moved, and there for a while only, so that one shape turns into another.

mod formula;
pub mod particles;
mod shape;
mod skeleton;
mod warp;

use std::any::Any;

use souple_formal::Formula;
use souple_math::Vec3;
use souple_mesh::{BoundingBox, TriangleSurface};
use souple_table::{Entry, Table, Values};

pub use particles::{Particle, Particles};
pub use shape::SurfacePart;
pub use warp::{BuildWarp, WARPS, Warp};

/// The value of all built-in potentials on their surface.
pub const ISO: f64 = 0.5;

/// Where the rows of the systems are.
pub trait Rows: Sync {
    /// [m]
    fn positions(&self, system: usize) -> &[Vec3];

    /// Rows of a body with levels that moved by themselves, by its system and its force; none before the first step.
    fn active(&self, system: usize, force: usize) -> &[u32];
}

/// No system has rows.
struct NoRows;

impl Rows for NoRows {
    fn positions(&self, _: usize) -> &[Vec3] {
        &[]
    }

    fn active(&self, _: usize, _: usize) -> &[u32] {
        &[]
    }
}

/// When, and where the rows of the systems are.
#[derive(Clone, Copy)]
pub struct Moment<'a> {
    /// [s]
    pub time: f64,
    pub rows: &'a dyn Rows,
}

impl Moment<'_> {
    /// A time without rows.
    pub fn at(time: f64) -> Self {
        Self { time, rows: &NoRows }
    }
}

/// What a part keeps between evaluations, opaque to all others.
pub type PartScratch = Box<dyn Any + Send + Sync>;

/// Two numbers that values lie between.
pub type Between = [f64; 2];

/// Nothing is known of the values.
pub const UNKNOWN: Between = [f64::NEG_INFINITY, f64::INFINITY];

/// A potential: above [`ISO`] inside.
pub trait Potential: Send + Sync {
    fn new_scratch(&self) -> PartScratch {
        Box::new(())
    }

    /// Follows rows and time.
    ///
    /// # Errors
    /// Why it has no value now.
    fn place(&self, _at: &Moment, _scratch: &mut PartScratch) -> Result<(), String> {
        Ok(())
    }

    fn value(&self, point: Vec3, scratch: &PartScratch) -> f64;

    /// Values at points, in place of what stands in `out`.
    fn values(&self, points: &[Vec3], scratch: &PartScratch, out: &mut [f64]) {
        out.iter_mut().zip(points).for_each(|(out, point)| *out = self.value(*point, scratch));
    }

    /// The least and the greatest of the values that it may have within a box.
    fn range(&self, _within: BoundingBox, _scratch: &PartScratch) -> Between {
        UNKNOWN
    }

    /// A box around all places where it is above `level`; `None` where it is not known, or where there is none, as it falls to
    /// nothing and no further.
    fn bounds(&self, level: f64, scratch: &PartScratch) -> Option<BoundingBox>;

    /// Where it is highest or near to that; `None` where it is not known.
    fn peaks(&self, _scratch: &PartScratch) -> Option<Vec<Vec3>> {
        None
    }

    /// The rows that lead it.
    fn followed(&self) -> Vec<Followed> {
        Vec::new()
    }
}

/// A row that leads a part of a target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Followed {
    pub system: usize,
    pub row: u32,
    /// Half the distance to its neighbours [m].
    pub radius: f64,
}

/// How a part joins what stands before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Combine {
    /// The sum of potentials: seams are round.
    Blend,
    Union,
    /// What was before without this.
    Difference,
    Intersection,
}

impl Combine {
    pub const NAMES: &'static [&'static str] = &["blend", "union", "difference", "intersection"];

    pub fn named(name: &str) -> Self {
        match name {
            "union" => Self::Union,
            "difference" => Self::Difference,
            "intersection" => Self::Intersection,
            _ => Self::Blend,
        }
    }

    /// Whether it makes something where there was nothing.
    pub fn adds(self) -> bool {
        matches!(self, Self::Blend | Self::Union)
    }

    /// `before`: nothing where no part was there.
    fn of(self, before: Option<f64>, value: f64, iso: f64) -> Option<f64> {
        let Some(before) = before else { return self.adds().then_some(value) };
        Some(match self {
            Self::Blend => before + value,
            Self::Union => before.max(value),
            Self::Difference => before.min(2.0 * iso - value),
            Self::Intersection => before.min(value),
        })
    }
}

/// A potential in a target.
pub struct Part {
    pub potential: Box<dyn Potential>,
    pub combine: Combine,
    /// There from the first to before the second [s].
    pub during: [f64; 2],
    /// Applied to the part in this order.
    pub warps: Vec<Box<dyn Warp>>,
    /// Moved by this, as formulas of t [m].
    pub motion: Option<[Formula; 3]>,
}

impl Part {
    /// A part that is always there.
    pub fn new(potential: Box<dyn Potential>) -> Self {
        let during = [f64::NEG_INFINITY, f64::INFINITY];
        Self { potential, combine: Combine::Blend, during, warps: Vec::new(), motion: None }
    }

    pub(crate) fn is_there(&self, time: f64) -> bool {
        self.during[0] <= time && time < self.during[1]
    }

    fn offset(&self, time: f64) -> Vec3 {
        self.motion.as_ref().map_or(Vec3::ZERO, |motion| {
            let [x, y, z] = [0, 1, 2].map(|axis: usize| motion[axis].evaluate(&[time]));
            Vec3::new(x, y, z)
        })
    }

    /// How fast it is moved [m/s].
    pub(crate) fn speed(&self, time: f64) -> f64 {
        self.motion.as_ref().map_or(0.0, |motion| {
            let rates = motion.each_ref().map(|along| along.differentiate(&[time], 0).derivative);
            Vec3::from_array(rates).length()
        })
    }
}

/// What a skin is drawn to.
pub struct Target {
    pub parts: Vec<Part>,
    pub iso: f64,
}

/// A target as placed at a time.
pub struct TargetScratch {
    parts: Vec<PartScratch>,
    offsets: Vec<Vec3>,
    there: Vec<bool>,
}

impl Target {
    pub fn new_scratch(&self) -> TargetScratch {
        TargetScratch {
            parts: self.parts.iter().map(|part| part.potential.new_scratch()).collect(),
            offsets: vec![Vec3::ZERO; self.parts.len()],
            there: vec![false; self.parts.len()],
        }
    }

    /// Follows rows and time.
    ///
    /// # Errors
    /// Why a part has no value now.
    pub fn place(&self, at: &Moment, scratch: &mut TargetScratch) -> Result<(), String> {
        for (index, part) in self.parts.iter().enumerate() {
            scratch.there[index] = part.is_there(at.time);
            scratch.offsets[index] = part.offset(at.time);
            if scratch.there[index] {
                if !scratch.offsets[index].is_finite() {
                    return Err(format!("the motion of parts[{index}] is not finite at t = {} s", at.time));
                }
                let placed = part.potential.place(at, &mut scratch.parts[index]);
                placed.map_err(|why| format!("parts[{index}]: {why}"))?;
            }
        }
        let makes = |(part, is_there): (&Part, &bool)| *is_there && part.combine.adds();
        if !self.parts.is_empty() && !self.parts.iter().zip(&scratch.there).any(makes) {
            return Err(format!("no part of the target that adds to it is there at t = {} s", at.time));
        }
        Ok(())
    }

    /// The first part whose potential is no number at a place.
    pub fn broken_part(&self, point: Vec3, scratch: &TargetScratch) -> Option<usize> {
        (0..self.parts.len())
            .find(|part| scratch.there[*part] && !self.value(*part, point, scratch).is_finite())
    }

    /// The potential of a part as it is placed.
    fn value(&self, index: usize, point: Vec3, scratch: &TargetScratch) -> f64 {
        let (part, mut place) = (&self.parts[index], point - scratch.offsets[index]);
        // the last warp is undone first
        for warp in part.warps.iter().rev() {
            place = warp.undo(place);
        }
        part.potential.value(place, &scratch.parts[index])
    }

    /// The potential less its iso value; positive inside.
    pub fn excess(&self, point: Vec3, scratch: &TargetScratch) -> f64 {
        let mut sum: Option<f64> = None;
        for (index, part) in self.parts.iter().enumerate() {
            if !scratch.there[index] {
                continue;
            }
            sum = part.combine.of(sum, self.value(index, point, scratch), self.iso);
        }
        sum.unwrap_or(0.0) - self.iso
    }

    /// The greatest potential of a target of one part as it is, where that knows its peaks.
    pub fn most(&self, scratch: &TargetScratch) -> Option<f64> {
        let [part] = &self.parts[..] else { return None };
        let peaks = part.potential.peaks(scratch.parts.first()?).filter(|_| part.warps.is_empty())?;
        let offset = *scratch.offsets.first()?;
        Some(peaks.into_iter().map(|peak| self.excess(peak + offset, scratch) + self.iso).fold(0.0, f64::max))
    }

    /// Numbers that [`Target::excess`] lies between within a box.
    pub fn range(&self, within: BoundingBox, scratch: &TargetScratch) -> Between {
        let mut sum: Option<Between> = None;
        for (index, part) in self.parts.iter().enumerate().filter(|(index, _)| scratch.there[*index]) {
            let offset = scratch.offsets[index];
            let moved = BoundingBox { low: within.low - offset, high: within.high - offset };
            let before = part.warps.iter().rev().fold(moved, |moved, warp| warp.before(moved));
            let own = part.potential.range(before, &scratch.parts[index]);
            // a part that is cut out does so with what it has most
            let [low, high] = if part.combine == Combine::Difference { [own[1], own[0]] } else { own };
            let joined = |end: usize, own: f64| part.combine.of(sum.map(|sum| sum[end]), own, self.iso);
            sum = joined(0, low).zip(joined(1, high)).map(|(low, high)| [low, high]);
        }
        let [low, high] = sum.unwrap_or([0.0; 2]);
        [low - self.iso, high - self.iso]
    }

    /// [`Target::excess`] at points, in place of what stands in `out`.
    pub fn excesses(&self, points: &[Vec3], scratch: &TargetScratch, out: &mut [f64]) {
        // one part as it is: all points at once
        if let ([part], Some(placed)) = (&self.parts[..], scratch.parts.first())
            && part.warps.is_empty()
            && part.motion.is_none()
            && scratch.there[0]
        {
            part.potential.values(points, placed, out);
            out.iter_mut().for_each(|value| *value -= self.iso);
            return;
        }
        out.iter_mut().zip(points).for_each(|(out, point)| *out = self.excess(*point, scratch));
    }

    /// The slope of the potential, by differences over `step` to both sides [1/m].
    pub fn slope(&self, point: Vec3, step: f64, scratch: &TargetScratch) -> f64 {
        let excess = |axis: Vec3, sign: f64| self.excess(point + axis * (sign * step), scratch);
        let slope = |axis: Vec3| (excess(axis, 1.0) - excess(axis, -1.0)) / (2.0 * step);
        Vec3::new(slope(Vec3::X), slope(Vec3::Y), slope(Vec3::Z)).length()
    }

    /// A box around all that is inside; `None` where it is not known.
    pub fn bounds(&self, scratch: &TargetScratch) -> Option<BoundingBox> {
        let adding = || {
            let there = self.parts.iter().enumerate().filter(|(index, _)| scratch.there[*index]);
            there.filter(|(_, part)| part.combine.adds())
        };
        // where a sum is above iso, one of its parts is above its share
        let level = self.iso / adding().count() as f64;
        let mut all: Option<BoundingBox> = None;
        for (index, part) in adding() {
            let bounds = part.potential.bounds(level, &scratch.parts[index])?;
            let bounds = part.warps.iter().fold(bounds, |bounds, warp| warp.bounds(bounds));
            let offset = scratch.offsets[index];
            let moved = BoundingBox { low: bounds.low + offset, high: bounds.high + offset };
            all = Some(all.map_or(moved, |all| all.union(moved)));
        }
        all
    }
}

/// What a constructor may ask for besides values.
pub trait Surroundings {
    /// The triangles of a file.
    ///
    /// # Errors
    /// Why there are none.
    fn surface(&self, file: &str) -> Result<TriangleSurface, String>;

    /// The particles of a file or a body, by name; those of a group of it where that is not empty.
    ///
    /// # Errors
    /// Why there are none.
    fn particles(&self, from: &str, group: &str, radius: f64) -> Result<Particles, String>;

    /// The surface of a body, by name: its rows move it.
    ///
    /// # Errors
    /// Why there is none.
    fn body_surface(&self, body: &str) -> Result<(TriangleSurface, usize, Vec<u32>), String>;

    /// Takes a warning: what was made is not all that was told.
    fn warn(&self, warning: String);
}

/// Why a part cannot be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("`{parameter}` is {value}; expected {expected}")]
pub struct PartError {
    pub parameter: &'static str,
    pub value: String,
    pub expected: String,
}

/// Constructor of a part from completed values.
pub type BuildPart = fn(&Values, &dyn Surroundings) -> Result<Box<dyn Potential>, PartError>;
type PartEntry = Entry<BuildPart>;

/// All potentials known by name.
pub static PARTS: Table<BuildPart> = Table {
    kind: "skin part",
    entries: &[
        &particles::PARTICLES,
        &skeleton::POINT,
        &skeleton::SEGMENT,
        &skeleton::POLYLINE,
        &skeleton::TRIANGLE,
        &shape::SHAPE,
        &shape::MESH,
        &shape::SURFACE,
        &formula::FORMULA,
    ],
};
