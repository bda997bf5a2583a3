//! Prescribed motions: from key frames and formulas, and one for each axis where several pins lead one point.

use std::sync::Arc;

use souple_engine::Motion;
use souple_math::Vec3;
use souple_models::loads::{FormulaVector, Interpolation, KeyFrames, MovingFrame, RigidMotion};

use crate::diagnostic::{Code, Log, Site};
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
pub fn motion_of_pin(log: &Log, pin: &Pin) -> Option<Option<Arc<dyn Motion>>> {
    let translation = motion(log, pin.motion.as_ref(), &pin.site)?;
    let Some(rotation) = motion(log, pin.rotation.as_ref(), &pin.site)? else { return Some(translation) };
    Some(Some(Arc::new(RigidMotion { translation, rotation: Some(rotation), pivot: pin.pivot })))
}

/// The frame that a system with this `timestep` [s] is seen from; `None` where it was refused.
pub fn frame(log: &Log, spec: &FrameSpec, timestep: f64) -> Option<MovingFrame> {
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
    Some(MovingFrame::new(frame, timestep))
}

/// `None`: the axis stays where it started.
#[derive(Clone, Debug, Default)]
pub struct AxisMotions(pub [Option<Arc<dyn Motion>>; 3]);

impl AxisMotions {
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
