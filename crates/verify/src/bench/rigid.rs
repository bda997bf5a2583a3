//! Rigid bodies in contact: a stack that stands, and one that slides apart.

use super::timing::{Held, Timing, as_it_is};
use super::{Effort, Figure, value_of};

/// Steps of five bricks on each other, with friction that holds them and with one that does not.
pub fn stack(name: &str, effort: Effort) -> Result<Vec<Figure>, String> {
    let mut figures = Vec::new();
    for (of, friction) in [("standing", 0.6), ("sliding", 0.1)] {
        let settings = [format!("parameters.friction={friction}")];
        let timing = Timing {
            scene: "rigid_stack",
            settings: &settings,
            prepare: as_it_is,
            warm_up: 5,
            samples: effort.choose(3, 10),
            steps_per_sample: 5,
        };
        let timed = super::timing::with_threads(1, || timing.sample(1))??;
        let stack = super::timing::scene("rigid_stack", &settings)?;
        let held = Held {
            error: value_of(stack, 10, "residual", 0)?,
            error_of: "the farthest that a contact is off after 10 periods [m]".to_owned(),
            baseline: None,
        };
        figures.push(timed.microseconds_per_step(&format!("{name}_{of}"), &held));
    }
    Ok(figures)
}
