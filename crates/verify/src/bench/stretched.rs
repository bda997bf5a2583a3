//! EXP-19: what it takes to follow the stretched cube for 0.9 s, explicitly and implicitly.

use super::timing::{Timing, as_it_is, median, scene, with_threads};
use super::{Effort, Figure, value_of};

/// One way to follow the cube explicitly.
struct Follow {
    /// [kg/m³]
    density: f64,
    /// Young's modulus [Pa].
    modulus: f64,
    /// The explicit step [s].
    step: f64,
    /// Of explicit forces, where it is not the fastest.
    formulation: Option<&'static str>,
    /// How often implicit steps must win.
    wanted: Option<f64>,
}

/// Fifty times for light stiff matter is said of the source's own forces, by grouped constants; forces by derived kernels, which
/// take a third of the time, are printed beside it. The source's table has a tenth of the longest stable step for heavy soft matter, at
/// which implicit steps win. At the longest one, which is what it is because the step grows with the density over the modulus, they need not.
const CASES: [Follow; 4] = [
    Follow {
        density: 1000.0,
        modulus: 1e5,
        step: 5e-5,
        formulation: Some("grouped_constants"),
        wanted: Some(50.0),
    },
    Follow { density: 1000.0, modulus: 1e5, step: 5e-5, formulation: None, wanted: None },
    Follow { density: 10_000.0, modulus: 1e4, step: 5e-4, formulation: None, wanted: Some(2.0) },
    Follow { density: 10_000.0, modulus: 1e4, step: 5e-3, formulation: None, wanted: None },
];

pub fn table(name: &str, effort: Effort) -> Result<Vec<Figure>, String> {
    let mut figures = Vec::new();
    for Follow { density, modulus, step, formulation, wanted } in CASES {
        let settings = |step: f64, stepper: &str| {
            vec![
                format!("world.period={step}"),
                format!("systems.main.stepper={stepper}"),
                format!("bodies.cube.material.density={density}"),
                format!("bodies.cube.material.youngs_modulus={modulus}"),
            ]
        };
        // as the source: one linearised solve a step, to 1e-6
        let implicit =
            settings(0.1, "{ name = \"backward_euler\", newton = \"one\", solver_tolerance = 1e-6 }");
        let mut explicit = settings(step, "\"explicit_euler\"");
        explicit.extend(formulation.map(|name| format!("bodies.cube.formulation={{ name = \"{name}\" }}")));
        let seconds = |settings: &[String], steps: f64, samples: usize| {
            let mut seconds = Vec::new();
            for _ in 0..samples {
                let timing = Timing {
                    scene: "stretched_cube",
                    settings,
                    prepare: as_it_is,
                    warm_up: 0,
                    samples: 1,
                    steps_per_sample: steps as usize,
                };
                let timed = with_threads(1, || timing.sample(1))??;
                // time of the processor does not count what else the machine does
                let spent = timed.processor.first().or(timed.seconds.first());
                seconds.push(spent.ok_or("a run of `stretched_cube` that took no time")? * steps);
            }
            Ok::<_, String>(seconds)
        };
        let (of_explicit, _) = median(seconds(&explicit, 0.9 / step, 1)?);
        let of_implicit = seconds(&implicit, 9.0, effort.choose(1, 5))?;
        let end = |settings: &[String], step: f64| {
            value_of(scene("stretched_cube", settings)?, (6.0 / step) as u64, "waist", 1)
        };
        // explicit runs are at rest some seconds later; the cheap one tells
        let error = end(&implicit, 0.1)? / -0.0082913887 - 1.0;
        let ratios: Vec<f64> = of_implicit.iter().map(|seconds| of_explicit / seconds).collect();
        let samples = ratios.len();
        let (value, spread) = median(ratios);
        let forces = formulation.map_or_else(String::new, |name| format!("{name}_"));
        figures.push(Figure {
            by_processor: None,
            name: format!("{name}_{density}_{modulus:e}_{step:e}_{forces}1t"),
            value,
            unit: "x implicit",
            higher_is_better: true,
            error: error.abs(),
            error_of: "waist at rest".to_owned(),
            baseline: wanted,
            threads: 1,
            samples,
            spread,
            bytes: 0,
        });
    }
    Ok(figures)
}
