//! Steps of a bar that frames carry, with the error of its sag in equilibrium.

use super::timing::{Held, Timing, as_it_is, scene};
use super::{Effort, Figure, value_of};

/// A bar and its frames.
#[derive(Clone, Copy)]
pub struct Size {
    /// Frames along x, y, z.
    frames: [u32; 3],
    /// Hexahedra along x, y, z, of eight points each.
    cells: [u32; 3],
    /// Steps a second that are wanted.
    wanted: f64,
}

/// 52 frames, 1,024 points.
pub const SMALL: Size = Size { frames: [13, 2, 2], cells: [32, 2, 2], wanted: 500.0 };
/// 496 frames, 51,200 points.
pub const LARGE: Size = Size { frames: [31, 4, 4], cells: [100, 8, 8], wanted: 15.0 };

/// Tip of the bar in equilibrium, neo-Hookean, by quadratic hexahedra [m].
const TIP: f64 = -0.144_978_258_526_270_25;

pub fn steps(name: &str, size: Size, effort: Effort) -> Result<Vec<Figure>, String> {
    let numbers = |values: [u32; 3]| format!("[{}, {}, {}]", values[0], values[1], values[2]);
    let settings = |stepper: &str| {
        vec![
            format!("bodies.bar.mesh.cells={}", numbers(size.cells)),
            format!("bodies.bar.frames.placement={{ name = \"grid\", counts = {} }}", numbers(size.frames)),
            "bodies.bar.frames.kind=\"rigid\"".to_owned(),
            "bodies.bar.material.name=\"neo_hookean\"".to_owned(),
            "world.period=\"10 ms\"".to_owned(),
            format!("systems.main.stepper={stepper}"),
        ]
    };
    let at_rest = settings("{ name = \"static\", newton_tolerance = 1e-8, solver = \"direct\" }");
    let tip = value_of(scene("frames_cantilever", &at_rest)?, 1, "tip", 1)?;
    let held = Held {
        error: (tip / TIP - 1.0).abs(),
        error_of: "tip in equilibrium, FEniCSx, quadratic hexahedra".to_owned(),
        baseline: Some(size.wanted),
    };
    let timing = Timing {
        scene: "frames_cantilever",
        settings: &settings("{ name = \"backward_euler\", newton = \"one\", solver_tolerance = 1e-6 }"),
        prepare: as_it_is,
        warm_up: 3,
        samples: effort.choose(5, 30),
        steps_per_sample: 2,
    };
    Ok(timing.run()?.iter().map(|timed| timed.steps_per_second(name, &held)).collect())
}
