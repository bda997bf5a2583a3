//! A motion of its own for each axis, where several pins lead one point.

use std::sync::Arc;

use souple_engine::Motion;
use souple_math::Vec3;

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
