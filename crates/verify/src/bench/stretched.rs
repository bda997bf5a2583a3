//! EXP-19: what it takes to follow the stretched cube for 0.9 s, explicitly and implicitly.

use super::timing::{Timing, as_it_is, median, scene, with_threads};
use super::{Effort, Figure, value_of};

/// One way to follow the cube explicitly, and one to do so implicitly.
struct Follow {
    /// [kg/m³]
    density: f64,
    /// Young's modulus [Pa].
    modulus: f64,
    /// The explicit step [s].
    step: f64,
    /// Of forces on either side, where they are not the fastest.
    formulation: Option<&'static str>,
    preconditioner: &'static str,
    /// How often implicit steps must win.
    wanted: Option<f64>,
}

/// Of light stiff matter. What is made once, at rest (grouped constants, the factor of the rest shape), counts for neither side, as in the
/// source's tables, whose totals are steps times seconds a step.
const LIGHT: Follow = Follow {
    density: 1000.0,
    modulus: 1e5,
    step: 5e-5,
    formulation: None,
    preconditioner: "reference_factor",
    wanted: Some(50.0),
};

/// Of heavy soft matter. The source's table has a tenth of the longest stable step there, at which implicit steps win. At the longest one,
/// which is what it is because the step grows with the density over the modulus, they need not.
const HEAVY: Follow = Follow { density: 10_000.0, modulus: 1e4, step: 5e-4, wanted: Some(2.0), ..LIGHT };

/// Fifty times for light stiff matter is said of the source's own forces, by grouped constants; those by derived kernels take a quarter of the time.
const CASES: [Follow; 6] = [
    Follow { formulation: Some("grouped_constants"), ..LIGHT },
    LIGHT,
    Follow { preconditioner: "auto", wanted: None, ..LIGHT },
    HEAVY,
    Follow { preconditioner: "auto", ..HEAVY },
    Follow { step: 5e-3, wanted: None, ..HEAVY },
];

/// Implicit steps in 0.9 s; what is made once is made in the first, which counts as the mean of the others.
const IMPLICIT_STEPS: f64 = 9.0;

pub fn table(name: &str, effort: Effort) -> Result<Vec<Figure>, String> {
    let mut figures = Vec::new();
    for Follow { density, modulus, step, formulation, preconditioner, wanted } in CASES {
        let settings = |step: f64, stepper: &str| {
            let mut settings = vec![
                format!("world.period={step}"),
                format!("systems.main.stepper={stepper}"),
                format!("bodies.cube.material.density={density}"),
                format!("bodies.cube.material.youngs_modulus={modulus}"),
            ];
            settings
                .extend(formulation.map(|name| format!("bodies.cube.formulation={{ name = \"{name}\" }}")));
            settings
        };
        // as the source: one linearised solve a step, to 1e-6
        let stepper = format!(
            "{{ name = \"backward_euler\", newton = \"one\", solver_tolerance = 1e-6, preconditioner = \"{preconditioner}\" }}"
        );
        let implicit = settings(0.1, &stepper);
        let explicit = settings(step, "\"explicit_euler\"");
        let seconds = |settings: &[String], (first, steps): (usize, f64), samples: usize| {
            let mut seconds = Vec::new();
            for _ in 0..samples {
                let timing = Timing {
                    scene: "stretched_cube",
                    settings,
                    prepare: as_it_is,
                    warm_up: first,
                    samples: 1,
                    steps_per_sample: steps as usize - first,
                };
                let timed = with_threads(1, || timing.sample(1))??;
                // time of the processor does not count what else the machine does
                let spent = timed.processor.first().or(timed.seconds.first());
                seconds.push(spent.ok_or("a run of `stretched_cube` that took no time")? * steps);
            }
            Ok::<_, String>(seconds)
        };
        let (of_explicit, _) = median(seconds(&explicit, (0, 0.9 / step), effort.choose(1, 3))?);
        let of_implicit = seconds(&implicit, (1, IMPLICIT_STEPS), effort.choose(3, 9))?;
        let end = |settings: &[String], step: f64| {
            value_of(scene("stretched_cube", settings)?, (6.0 / step) as u64, "waist", 1)
        };
        // explicit runs are at rest some seconds later; the cheap one tells
        let error = end(&implicit, 0.1)? / -0.0082913887 - 1.0;
        let ratios: Vec<f64> = of_implicit.iter().map(|seconds| of_explicit / seconds).collect();
        let samples = ratios.len();
        let (value, spread) = median(ratios);
        let forces = formulation.map_or_else(String::new, |name| format!("{name}_"));
        let solver = if preconditioner == "auto" { "auto_" } else { "" };
        figures.push(Figure {
            by_processor: None,
            name: format!("{name}_{density}_{modulus:e}_{step:e}_{forces}{solver}1t"),
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
