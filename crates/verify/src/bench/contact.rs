//! A body that falls on a floor.

use super::timing::{Held, Timing, as_it_is, scene};
use super::{Effort, Figure, value_of};

pub fn contact_block(effort: Effort) -> Result<Vec<Figure>, String> {
    // touch begins at step 28; the block then squashes, slides and springs back
    let steps = effort.choose(60, 200);
    let height = |settings: &[String]| value_of(scene("soft_block", settings)?, steps, "height", 0);
    let tight =
        ["systems.main.stepper={ name = \"backward_euler\", newton_tolerance = 1e-10, solver = \"direct\" }"
            .to_owned()];
    let held = Held {
        error: (height(&[])? / height(&tight)? - 1.0).abs(),
        error_of: format!(
            "height after {:.1} s against the run converged to 1e-10 with sparse LU",
            steps as f64 * 5e-3
        ),
        baseline: None,
    };
    let timing = Timing {
        scene: "soft_block",
        settings: &[],
        prepare: as_it_is,
        warm_up: 30,
        samples: effort.choose(30, 170),
        steps_per_sample: 1,
    };
    Ok(timing.run()?.iter().map(|timed| timed.milliseconds_per_step("contact_block", &held)).collect())
}
