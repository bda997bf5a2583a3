//! Prescribed motions: from key frames and formulas, and one for each axis where several pins lead one point.

use std::sync::Arc;

use souple_engine::Motion;
use souple_math::{Mat3, Vec3};
use souple_models::loads::{FormulaVector, Interpolation, KeyFrames, MovingFrame, Pose, RigidMotion};
use souple_table::four_digits;

use super::bones;
use crate::diagnostic::{Code, Log, Site};
use crate::spec::Spec;
use crate::spec::boundary::{MotionSpec, Pin};
use crate::spec::world::FrameSpec;

/// `Some(None)` where no motion is written, `None` where it was refused.
pub fn motion(log: &Log, spec: Option<&MotionSpec>, site: &Site) -> Option<Option<Arc<dyn Motion>>> {
    let motion: Arc<dyn Motion> = match spec {
        None => return Some(None),
        Some(MotionSpec::Formula(formulas)) => Arc::new(FormulaVector::from_components(formulas.clone())),
        Some(MotionSpec::KeyFrames { times, offsets, is_smooth }) => {
            let interpolation = if *is_smooth { Interpolation::Smooth } else { Interpolation::Linear };
            match KeyFrames::new(times.clone(), offsets.clone(), interpolation) {
                Ok(frames) => Arc::new(frames),
                Err(error) => {
                    log.add(Code::OutOfRange, site, error.to_string(), "key frames in order");
                    return None;
                }
            }
        }
    };
    Some(Some(motion))
}

/// How a pin leads its points: `Some(None)` where they stay, `None` where a motion was refused.
pub fn motion_of_pin(log: &Log, spec: &Spec, pin: &Pin) -> Option<Option<Arc<dyn Motion>>> {
    if let Some(bone) = &pin.bone {
        return bones::motion_of(log, spec, bone, &pin.site).map(Some);
    }
    let translation = motion(log, pin.motion.as_ref(), &pin.site)?;
    let Some(rotation) = motion(log, pin.rotation.as_ref(), &pin.site)? else { return Some(translation) };
    Some(Some(Arc::new(RigidMotion { translation, rotation: Some(rotation), pivot: pin.pivot })))
}

/// The frame that a system with this `timestep` [s] is seen from for a run's `duration` [s]; `None` where it was refused.
pub fn frame(log: &Log, spec: &FrameSpec, timestep: f64, duration: f64) -> Option<MovingFrame> {
    let translation = motion(log, spec.motion.as_ref(), &spec.site)?;
    let rotation = motion(log, spec.rotation.as_ref(), &spec.site)?;
    let frame = RigidMotion { translation, rotation, pivot: spec.pivot };
    let start = frame.pose(0.0);
    if !(start.origin.is_finite() && start.velocity.is_finite() && start.angular_velocity.is_finite()) {
        let [place, velocity, spin] =
            [start.origin, start.velocity, start.angular_velocity].map(|vector| vector.to_array());
        let message = format!(
            "at t = 0 the frame is at {place:?} m, moves by {velocity:?} m/s and turns by {spin:?} rad/s"
        );
        log.add(Code::NotFinite, &spec.site, message, "formulas that are finite at the start");
        return None;
    }
    if let Some((site, jump)) = jump_of_frame(spec, &frame, timestep, duration) {
        let message = format!("{jump}, and a frame that does is no place to be: its acceleration has no end");
        let expected = "a formula without jumps of place or velocity over the run, such as `0.1 * smoothstep(0.4, 0.6, t)`";
        log.add(Code::Conflict, site, message, expected);
        return None;
    }
    Some(MovingFrame::new(frame, timestep))
}

/// What jumps where a frame does, in words, and where it is written.
fn jump_of_frame<'a>(
    spec: &'a FrameSpec,
    frame: &RigidMotion,
    timestep: f64,
    duration: f64,
) -> Option<(&'a Site, String)> {
    let vector = |of: fn(Pose) -> Vec3| {
        first_jump(|time| of(frame.pose(time)), |a, b| (*a - *b).length(), timestep, duration)
    };
    // |R - R'| = 2 √2 sin(θ/2) in the norm of Frobenius
    let angle = |a: &Mat3, b: &Mat3| {
        let between = *a - *b;
        2.0 * (between.dot(&between) / 8.0).sqrt().min(1.0).asin()
    };
    let turn = || first_jump(|time| frame.pose(time).turn, angle, timestep, duration);
    let told = |site, what: &str, unit: &str, jump: Option<(f64, f64)>| {
        jump.map(|(time, size)| {
            let [time, size] = [time, size].map(four_digits);
            (site, format!("at t = {time} s {what} jumps by {size} {unit}"))
        })
    };
    let (motion, rotation) = (&spec.motion_site, &spec.rotation_site);
    told(motion, "the place of the frame", "m", vector(|pose| pose.origin))
        .or_else(|| told(motion, "the velocity of the frame", "m/s", vector(|pose| pose.velocity)))
        .or_else(|| told(rotation, "the turn of the frame", "rad", turn()))
        .or_else(|| {
            told(rotation, "the angular velocity of the frame", "rad/s", vector(|pose| pose.angular_velocity))
        })
}

/// Most intervals of a run that are looked at for jumps.
const MOST_INTERVALS: f64 = 10_000.0;
/// How often an interval is halved towards what may be a jump.
const HALVINGS: u32 = 14;
/// Of the change over an interval what is left where it does not shrink: roots, which grow infinitely fast, halve theirs in two
/// halvings and keep a 128th.
const JUMP: f64 = 0.01;

/// When a function of time first jumps in a run of some `duration`, and by how much; what changes within a ten-thousandth of an
/// `interval` jumps, or of a longer one where the run has more than can be looked at.
fn first_jump<T>(
    of: impl Fn(f64) -> T,
    distance: impl Fn(&T, &T) -> f64,
    interval: f64,
    duration: f64,
) -> Option<(f64, f64)> {
    let count = (duration / interval).ceil().clamp(1.0, MOST_INTERVALS) as usize;
    let time = |index: usize| duration * index as f64 / count as f64;
    let changes: Vec<f64> =
        (0..count).map(|index| distance(&of(time(index)), &of(time(index + 1)))).collect();
    let largest = changes.iter().copied().fold(0.0, f64::max);
    (0..count).find_map(|index| {
        // below there may be rounding alone
        if changes[index] <= 1e-6 * largest {
            return None;
        }
        let (mut from, mut to) = (time(index), time(index + 1));
        // the most that a part of it changes: the ends of a vibration may be at rest
        let (mut whole, mut left) = (changes[index], changes[index]);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (from + to);
            let at_middle = of(middle);
            let (before, after) = (distance(&of(from), &at_middle), distance(&at_middle, &of(to)));
            if before > after {
                to = middle
            } else {
                from = middle
            }
            left = before.max(after);
            whole = whole.max(left);
            if left <= JUMP * whole {
                return None;
            }
        }
        Some((to, left))
    })
}

/// `None`: the axis stays where it started.
#[derive(Clone, Debug, Default)]
pub struct AxisMotions(pub [Option<Arc<dyn Motion>>; 3]);

impl AxisMotions {
    /// How they lead a point: all axes by one motion where it is the same, which tells how what it leads turns; `None` where all stay.
    pub fn into_one(self) -> Option<Arc<dyn Motion>> {
        match &self.0 {
            [None, None, None] => None,
            [Some(x), Some(y), Some(z)] if Arc::ptr_eq(x, y) && Arc::ptr_eq(x, z) => Some(Arc::clone(x)),
            _ => Some(Arc::new(self)),
        }
    }

    fn by_axis(&self, of: impl Fn(&dyn Motion) -> Vec3) -> Vec3 {
        Vec3::from_array(
            [0, 1, 2].map(|axis: usize| self.0[axis].as_deref().map_or(0.0, |motion| of(motion)[axis])),
        )
    }
}

impl Motion for AxisMotions {
    fn offset(&self, start: Vec3, time: f64) -> Vec3 {
        self.by_axis(|motion| motion.offset(start, time))
    }

    fn velocity(&self, start: Vec3, time: f64) -> Vec3 {
        self.by_axis(|motion| motion.velocity(start, time))
    }
}
