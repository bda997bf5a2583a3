//! Steps of a bar that frames carry, with what one solve a step leaves of the answer, and the error of the bar's sag in equilibrium.

use souple_scene::Scene;

use super::frames_table::row;
use super::timing::{Held, Timed, Timing, as_it_is, scene, with_threads};
use super::{Effort, Figure, value_of};

/// A bar and its frames.
#[derive(Clone, Copy)]
pub struct Size {
    /// Frames along x, y, z.
    frames: [u32; 3],
    /// Hexahedra along x, y, z, of eight points each.
    cells: [u32; 3],
    /// What is about it, and the steps a second that are wanted there.
    wanted: &'static [(Around, f64)],
    /// Steps after which a run is compared with a converged one.
    compared: u64,
}

/// 52 frames, 1,024 points.
pub const SMALL: Size = Size {
    frames: [13, 2, 2],
    cells: [32, 2, 2],
    wanted: &[(Around::Nothing, 500.0), (Around::Floor, 60.0)],
    compared: 20,
};
/// 496 frames, 51,200 points.
pub const LARGE: Size =
    Size { frames: [31, 4, 4], cells: [100, 8, 8], wanted: &[(Around::Nothing, 15.0)], compared: 5 };

/// What is about the bar.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Around {
    /// All forces are there from the first step on, and no matrix is assembled.
    Nothing,
    /// A floor a centimetre below, with friction, which the bar comes down on after five steps: from there on matrices are
    /// assembled and factorised.
    Floor,
}

/// So many frames have a say at a point, as the source has them.
const LEAST_EFFECTIVE: f64 = 4.0;

/// The bar of a size in steps of 10 ms, or in equilibrium, by `stepper`.
fn settings(frames: [u32; 3], cells: [u32; 3], around: Around, stepper: &str) -> Vec<String> {
    let numbers = |values: [u32; 3]| format!("[{}, {}, {}]", values[0], values[1], values[2]);
    let mut settings = vec![
        format!("bodies.bar.mesh.cells={}", numbers(cells)),
        format!("bodies.bar.frames.placement={{ name = \"grid\", counts = {} }}", numbers(frames)),
        "bodies.bar.frames.kind=\"rigid\"".to_owned(),
        "bodies.bar.material.name=\"neo_hookean\"".to_owned(),
        "world.period=\"10 ms\"".to_owned(),
        format!("systems.main.stepper={stepper}"),
    ];
    if around == Around::Floor {
        settings.extend([
            "shapes={ floor = { shape = { name = \"plane\", point = [0, -0.01, 0], normal = [0, 1, 0] } } }"
                .to_owned(),
            "contacts=[{ body = \"bar\", shape = \"floor\", stiffness = \"1 kN/m\", friction = 0.4 }]"
                .to_owned(),
        ]);
    }
    settings
}

const STATIC: &str = "{ name = \"static\", newton_tolerance = 1e-8, solver = \"direct\" }";
const ONE_SOLVE: &str = "{ name = \"backward_euler\", newton = \"one\", solver_tolerance = 1e-4 }";
/// The same steps to their end.
const CONVERGED: &str = "{ name = \"backward_euler\", newton_tolerance = 1e-8, solver = \"direct\" }";

fn timing(settings: &[String], samples: usize) -> Timing<'_> {
    let scene = "frames_cantilever";
    // the floor is touched after five steps
    Timing { scene, settings, prepare: as_it_is, warm_up: 8, samples, steps_per_sample: 2 }
}

/// How far the tip is down after so many steps, all of which were made [m].
pub fn tip_of(scene: Scene, steps: u64) -> Result<f64, String> {
    value_of(scene, steps, "tip", 1)
}

pub fn steps(name: &str, size: Size, effort: Effort) -> Result<Vec<Figure>, String> {
    let built = |around: Around, stepper: &str| {
        scene("frames_cantilever", &settings(size.frames, size.cells, around, stepper))
    };
    let at_rest = built(Around::Nothing, STATIC)?;
    let serving = at_rest.bodies[0].frames.as_ref().map(|frames| frames.report).unwrap_or_default();
    if serving.effective < LEAST_EFFECTIVE {
        return Err(format!(
            "{:.1} frames have a say at a point, {LEAST_EFFECTIVE} are wanted",
            serving.effective
        ));
    }
    let sag = (tip_of(at_rest, 1)? / row("frames_bar_affine_neo_hookean")?.reference - 1.0).abs();
    let mut figures = Vec::new();
    for (around, wanted) in size.wanted {
        let converged = tip_of(built(*around, CONVERGED)?, size.compared)?;
        let one_solve = tip_of(built(*around, ONE_SOLVE)?, size.compared)?;
        let held = Held {
            error: (one_solve / converged - 1.0).abs(),
            error_of: format!(
                "tip after {} steps of one solve to 1e-4 (`solver_tolerance`), next to Newton's method to 1e-8; in equilibrium it is \
                 {:.1} % off FEniCSx, quadratic hexahedra; {:.1} frames have a say at a point",
                size.compared,
                100.0 * sag,
                serving.effective
            ),
            baseline: Some(*wanted),
        };
        let name = match around {
            Around::Nothing => name.to_owned(),
            Around::Floor => format!("{name}_touching"),
        };
        let settings = settings(size.frames, size.cells, *around, ONE_SOLVE);
        let timed = timing(&settings, effort.choose(5, 30)).run()?;
        figures.extend(timed.iter().map(|timed| timed.steps_per_second(&name, &held)));
    }
    Ok(figures)
}

/// A step is to take no longer than it lasts [ms].
const TISSUES_PERIOD: f64 = 10.0;

/// Steps of the scene `tissues` while its upper organ is led up.
pub fn tissues(name: &str, effort: Effort) -> Result<Vec<Figure>, String> {
    const STEPS: u64 = 50;
    let settings = [format!("systems.main.stepper={CONVERGED}")];
    // of the lower organ, which nothing leads but what is between the two
    let risen = |settings: &[String]| value_of(scene("tissues", settings)?, STEPS, "lower", 1);
    let held = Held {
        error: (risen(&[])? / risen(&settings)? - 1.0).abs(),
        error_of: format!(
            "way of the lower organ after {STEPS} steps of one solve, next to Newton's method to 1e-8"
        ),
        baseline: Some(TISSUES_PERIOD),
    };
    let samples = effort.choose(5, 15);
    let timing = Timing {
        scene: "tissues",
        settings: &[],
        prepare: as_it_is,
        warm_up: 5,
        samples,
        steps_per_sample: 4,
    };
    Ok(timing.run()?.iter().map(|timed| timed.milliseconds_per_step(name, &held)).collect())
}

/// Cells of the bar along x, y and z, each time twice as many, of eight points each.
const GROWING: [[u32; 3]; 4] = [[50, 4, 4], [50, 8, 4], [50, 8, 8], [100, 8, 8]];
/// Time and memory grow as a power of the number of points; this one is nearer to the first than to one and a half.
const LARGEST_EXPONENT: f64 = 1.25;

/// Time of a thousand points and memory of a thousand points more, for ever more points, all with the same frames, beside those where there
/// are fewest; and the power at which both grow.
pub fn growth(name: &str, effort: Effort) -> Result<Vec<Figure>, String> {
    let runs: Vec<(f64, Timed)> = GROWING[..effort.choose(3, 4)]
        .iter()
        .map(|cells| {
            let points = 8.0 * f64::from(cells.iter().product::<u32>());
            let settings = settings([16, 3, 3], *cells, Around::Nothing, ONE_SOLVE);
            Ok((points, with_threads(1, || timing(&settings, effort.choose(5, 30)).sample(1))??))
        })
        .collect::<Result<_, String>>()?;
    // by time of the processor, where the system tells
    let seconds = |timed: &Timed| {
        if timed.processor.is_empty() { timed.seconds.clone() } else { timed.processor.clone() }
    };
    let microseconds = |timed: &Timed| seconds(timed).iter().map(|seconds| 1e6 * seconds).collect();
    let times: Vec<Grown> =
        runs.iter().map(|(points, timed)| (*points, *points, microseconds(timed), timed)).collect();
    // frames and their matrix, which are the same for all, are no memory of points
    let memories: Vec<Grown> = runs
        .windows(2)
        .map(|pair| {
            let [(fewer, before), (more, timed)] = pair else { unreachable!("windows of two") };
            (*more, more - fewer, vec![1e-6 * (timed.bytes as f64 - before.bytes as f64)], timed)
        })
        .collect();
    let times = grown(&format!("{name}_time"), "us/step of a thousand points", &times)?;
    let memories = grown(&format!("{name}_memory"), "MB of a thousand points more", &memories)?;
    Ok([times, memories].concat())
}

/// Points in all, those that values are of, the values, and the run.
type Grown<'a> = (f64, f64, Vec<f64>, &'a Timed);

/// Figures of what grows with the number of points.
fn grown(name: &str, unit: &'static str, runs: &[Grown]) -> Result<Vec<Figure>, String> {
    let exact = |baseline: Option<f64>| Held { error: 0.0, error_of: String::new(), baseline };
    let mut figures: Vec<Figure> = Vec::new();
    for (points, of, values, timed) in runs {
        let values = values.iter().map(|value| 1e3 * value / of).collect();
        let of_fewest = exact(figures.first().map(|figure| figure.value));
        figures.push(timed.figure(&format!("{name}.{points:.0}"), values, &of_fewest, (unit, false)));
    }
    let ([(fewest, ..), .., (most, _, _, timed)], [first, .., last]) = (runs, figures.as_slice()) else {
        return Err("growth takes two runs".to_owned());
    };
    let exponent = 1.0 + (last.value / first.value).ln() / (most / fewest).ln();
    if exponent > LARGEST_EXPONENT {
        return Err(format!(
            "{name} grows as the number of points to the power {exponent:.2}, {LARGEST_EXPONENT} is borne"
        ));
    }
    figures.push(timed.figure(
        &format!("{name}_exponent"),
        vec![exponent],
        &exact(Some(1.0)),
        ("of points", false),
    ));
    Ok(figures)
}
