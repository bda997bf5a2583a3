//! Steps of a bar that frames carry, with the error of its sag in equilibrium.

use super::timing::{Held, Timing, as_it_is, scene, with_threads};
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

/// The bar of a size in steps of 10 ms, or in equilibrium, by `stepper`.
fn settings(frames: [u32; 3], cells: [u32; 3], stepper: &str) -> Vec<String> {
    let numbers = |values: [u32; 3]| format!("[{}, {}, {}]", values[0], values[1], values[2]);
    vec![
        format!("bodies.bar.mesh.cells={}", numbers(cells)),
        format!("bodies.bar.frames.placement={{ name = \"grid\", counts = {} }}", numbers(frames)),
        "bodies.bar.frames.kind=\"rigid\"".to_owned(),
        "bodies.bar.material.name=\"neo_hookean\"".to_owned(),
        "world.period=\"10 ms\"".to_owned(),
        format!("systems.main.stepper={stepper}"),
    ]
}

const STATIC: &str = "{ name = \"static\", newton_tolerance = 1e-8, solver = \"direct\" }";
/// One solve leaves a hundredth of what a whole step moves; the tip after twenty steps is that of a tolerance of 1e-10 to 1e-8.
const ONE_SOLVE: &str = "{ name = \"backward_euler\", newton = \"one\", solver_tolerance = 1e-4 }";

fn timing(settings: &[String], samples: usize) -> Timing<'_> {
    let scene = "frames_cantilever";
    Timing { scene, settings, prepare: as_it_is, warm_up: 3, samples, steps_per_sample: 2 }
}

pub fn steps(name: &str, size: Size, effort: Effort) -> Result<Vec<Figure>, String> {
    let at_rest = scene("frames_cantilever", &settings(size.frames, size.cells, STATIC))?;
    let serving = at_rest.bodies[0].frames.as_ref().map(|frames| frames.report).unwrap_or_default();
    let tip = value_of(at_rest, 1, "tip", 1)?;
    let held = Held {
        error: (tip / TIP - 1.0).abs(),
        error_of: format!(
            "tip in equilibrium, FEniCSx, quadratic hexahedra; {:.1} frames have a say at a point",
            serving.effective
        ),
        baseline: Some(size.wanted),
    };
    let settings = settings(size.frames, size.cells, ONE_SOLVE);
    let timed = timing(&settings, effort.choose(5, 30)).run()?;
    Ok(timed.iter().map(|timed| timed.steps_per_second(name, &held)).collect())
}

/// Cells of the bar along x, y and z, each time twice as many, of eight points each.
const GROWING: [[u32; 3]; 4] = [[50, 4, 4], [50, 8, 4], [50, 8, 8], [100, 8, 8]];

/// Time and memory for ever more points, all with the same frames: of a thousand points, and how far from those of the fewest.
pub fn growth(name: &str, effort: Effort) -> Result<Vec<Figure>, String> {
    let mut figures: Vec<Figure> = Vec::new();
    for cells in &GROWING[..effort.choose(2, 4)] {
        let thousands = 8e-3 * cells.iter().product::<u32>() as f64;
        let settings = settings([16, 3, 3], *cells, ONE_SOLVE);
        let timed = with_threads(1, || timing(&settings, effort.choose(5, 30)).sample(1))??;
        let figure =
            |quantity: &str, values: Vec<f64>, (unit, higher): (&'static str, bool), known: Option<f64>| {
                let held = Held { error: 0.0, error_of: String::new(), baseline: None };
                let mut figure = timed.figure(
                    &format!("{name}_{quantity}.{:.0}", 1e3 * thousands),
                    values,
                    &held,
                    (unit, higher),
                );
                let of_fewest = known.unwrap_or(figure.value);
                figure.error = figure.value / of_fewest - 1.0;
                "of a thousand of the fewest points".clone_into(&mut figure.error_of);
                figure
            };
        let first = |of: usize| figures.get(of).map(|figure| figure.value);
        let times = timed.seconds.iter().map(|seconds| 1e6 * seconds / thousands).collect();
        let time = figure("time", times, ("us/step of a thousand points", false), first(0));
        let memory = vec![1e-6 * timed.bytes as f64 / thousands];
        let memory = figure("memory", memory, ("MB of a thousand points", false), first(1));
        figures.extend([time, memory]);
    }
    Ok(figures)
}
