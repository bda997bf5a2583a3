//! Benchmarks: speed with its error beside it, on scenes anyone can run.

use std::fmt;
use std::path::Path;
use std::time::Instant;

use serde_json::{Value, json};
use souple_run::{Control, Options};
use souple_scene::Scene;

use crate::scenes;

/// One benchmark.
#[derive(Clone, Copy)]
pub struct Bench {
    pub name: &'static str,
    pub what: &'static str,
    /// Measures; `true` asks for few samples.
    pub run: fn(bool) -> Result<Vec<Figure>, String>,
}

/// One figure.
#[derive(Clone, Debug)]
pub struct Figure {
    pub name: String,
    pub value: f64,
    pub unit: &'static str,
    pub higher_is_better: bool,
    /// How wrong the result is that this speed gives.
    pub error: f64,
    /// What the error is of.
    pub error_of: String,
    /// What it is held against.
    pub baseline: Option<f64>,
    pub threads: usize,
    pub samples: usize,
    /// Half the distance between the quartiles over the median.
    pub spread: f64,
    pub bytes: usize,
}

/// All benchmarks, or those named.
///
/// # Errors
/// The name that is unknown.
pub fn benches(names: &[String]) -> Result<Vec<&'static Bench>, String> {
    if let Some(unknown) = names.iter().find(|name| !BENCHES.iter().any(|bench| bench.name == name.as_str()))
    {
        return Err(unknown.clone());
    }
    Ok(BENCHES
        .iter()
        .filter(|bench| names.is_empty() || names.iter().any(|name| name == bench.name))
        .collect())
}

/// Every benchmark.
pub const BENCHES: &[Bench] = &[
    Bench {
        name: "explicit_tet4_stvk_100k",
        what: "complete symplectic steps of the reference bar, n = 12 (103,680 tetrahedra), bent [elements/s]",
        run: |quick| explicit("explicit_tet4_stvk_100k", "tet4", 12, 20e6, quick),
    },
    Bench {
        name: "explicit_hex8_stvk",
        what: "the same with hexahedra of eight samples, n = 12 [elements/s]",
        run: |quick| explicit("explicit_hex8_stvk", "hex8", 12, 3e6, quick),
    },
    Bench {
        name: "implicit_beam_n3",
        what: "one linearised backward Euler step of the reference bar, n = 3, to 1e-6 [ms/step]",
        run: |quick| implicit_beam("implicit_beam_n3", 3, 4.8, quick),
    },
    Bench {
        name: "implicit_beam_n6",
        what: "the same, n = 6 (12,960 tetrahedra) [ms/step]",
        run: |quick| implicit_beam("implicit_beam_n6", 6, 96.0, quick),
    },
    Bench {
        name: "implicit_beam_n12",
        what: "the same, n = 12 (103,680 tetrahedra) [ms/step]",
        run: |quick| implicit_beam("implicit_beam_n12", 12, 1700.0, quick),
    },
    Bench {
        name: "implicit_beam_24k",
        what: "a soft bar of 24,000 tetrahedra at 2 ms steps [ms/step]",
        run: |quick| soft_beam("implicit_beam_24k", [40, 10, 10], 27.0, quick),
    },
    Bench {
        name: "implicit_beam_5k",
        what: "the same bar with 5,880 tetrahedra [ms/step]",
        run: |quick| soft_beam("implicit_beam_5k", [20, 7, 7], 5.0, quick),
    },
    Bench { name: "startup", what: "`souple list materials` from start to end [ms]", run: startup },
    Bench {
        name: "static_100k",
        what: "equilibrium of the reference bar, n = 12, St. Venant-Kirchhoff, to 1e-8 [s]",
        run: static_100k,
    },
];

impl Bench {
    pub fn to_json(&self) -> Value {
        json!({"name": self.name, "what": self.what})
    }
}

impl Figure {
    pub fn to_json(&self) -> Value {
        json!({
            "name": self.name,
            "value": self.value,
            "unit": self.unit,
            "higher_is_better": self.higher_is_better,
            "error": self.error,
            "error_of": self.error_of,
            "baseline": self.baseline,
            "threads": self.threads,
            "samples": self.samples,
            "spread": self.spread,
            "bytes": self.bytes,
            "machine": souple_run::instruction_set(),
        })
    }
}

impl fmt::Display for Figure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{:38} {:>12.4} {} (spread {:.0} %, {} threads, {} samples, {:.1} MB; error {:.1e} of {})",
            self.name,
            self.value,
            self.unit,
            100.0 * self.spread,
            self.threads,
            self.samples,
            self.bytes as f64 * 1e-6,
            self.error,
            self.error_of
        )
    }
}

/// Median and half the interquartile distance over it.
fn median(mut samples: Vec<f64>) -> (f64, f64) {
    samples.sort_by(f64::total_cmp);
    let at = |fraction: f64| samples[((samples.len() - 1) as f64 * fraction).round() as usize];
    (at(0.5), 0.5 * (at(0.75) - at(0.25)) / at(0.5))
}

fn scene(name: &str, settings: &[String]) -> Result<Scene, String> {
    let text = scenes::text(name).ok_or_else(|| format!("there is no scene `{name}`"))?;
    souple_scene::read_text(name, text, Path::new("."), settings)
        .map_err(|diagnostics| diagnostics.to_string())
}

/// Threads to measure with: one, and all that the process may use.
fn thread_counts() -> Vec<usize> {
    let all = rayon::current_num_threads();
    if all > 1 { vec![1, all] } else { vec![1] }
}

fn with_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> Result<T, String> {
    let pool =
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(|error| error.to_string())?;
    Ok(pool.install(work))
}

/// Runs a scene and gives the last value of a probe's component.
fn value_of(scene: Scene, steps: u64, probe: &str, component: usize) -> Result<f64, String> {
    let options = Options { steps: Some(steps), ..Options::default() };
    let outcome =
        souple_run::run(scene, &options, &mut |_| Control::Continue).map_err(|error| error.to_string())?;
    let trace = outcome.traces.iter().find(|trace| trace.name == probe).ok_or("the probe is missing")?;
    trace
        .last()
        .and_then(|value| value.get(component))
        .copied()
        .ok_or_else(|| "the probe is empty".to_owned())
}

fn explicit(name: &str, element: &str, n: u32, peer: f64, quick: bool) -> Result<Vec<Figure>, String> {
    let settings = |cells: u32| {
        vec![
            "world.period=\"10 us\"".to_owned(),
            "systems.main.stepper=\"symplectic_euler\"".to_owned(),
            format!("bodies.bar.mesh.cells=[{}, {cells}, {cells}]", 10 * cells),
            format!("bodies.bar.mesh.element=\"{element}\""),
        ]
    };
    // the error of this very scheme: the trace of an independent code at n = 3 after 1000 steps of 50 µs
    let mut reference = settings(3);
    reference[0] = "world.period=\"50 us\"".to_owned();
    reference[3] = "bodies.bar.mesh.element=\"tet4\"".to_owned();
    let expected = -0.015741317589581534;
    let error = (value_of(scene("cantilever_dynamic", &reference)?, 1000, "tip", 1)? / expected - 1.0).abs();
    let mut figures = Vec::new();
    for threads in thread_counts() {
        let settings = settings(n);
        let (samples, bytes) = with_threads(threads, move || -> Result<_, String> {
            let scene = scene("cantilever_dynamic", &settings)?;
            let elements = scene.bodies[0].mesh.cell_count();
            let mut world = scene.model.start(scene.state);
            bend(&mut world);
            let mut samples = Vec::new();
            for _ in 0..if quick { 5 } else { 30 } {
                let clock = Instant::now();
                for _ in 0..5 {
                    world.step().map_err(|error| error.to_string())?;
                }
                samples.push(5.0 * elements as f64 / clock.elapsed().as_secs_f64());
            }
            Ok((samples, world.bytes()))
        })??;
        let count = samples.len();
        let (value, spread) = median(samples);
        figures.push(Figure {
            name: format!("{name}_{threads}t"),
            value,
            unit: "elements/s",
            higher_is_better: true,
            error,
            error_of: "tip after 1000 steps at n = 3 (tet4), independent code".to_owned(),
            baseline: Some(peer),
            threads,
            samples: count,
            spread,
            bytes,
        });
    }
    Ok(figures)
}

/// Bends the bar to a parabola, so that no element is at rest.
fn bend(world: &mut souple_engine::World) {
    let mut state = world.state().clone();
    for q in &mut state.systems[0].q {
        q.y -= 0.1 * q.x * q.x;
    }
    world.resume(state);
}

fn implicit_beam(name: &str, n: u32, peer: f64, quick: bool) -> Result<Vec<Figure>, String> {
    let mut figures = Vec::new();
    for law in ["corotational", "st_venant_kirchhoff"] {
        let settings = |n: u32| {
            vec![
                format!("bodies.bar.mesh.cells=[{}, {n}, {n}]", 10 * n),
                format!("bodies.bar.material.name=\"{law}\""),
                "systems.main.stepper={ name = \"backward_euler\", newton = \"one\", solver_tolerance = 1e-6 }".to_owned(),
            ]
        };
        // at n = 3: an independent code's ten steps, or where there is none ours solved to rounding
        let tip = |settings: &[String]| value_of(scene("cantilever_dynamic", settings)?, 10, "tip", 1);
        let (reference, error_of) = if law == "st_venant_kirchhoff" {
            (-0.06758904669664875, "tip after 10 steps at n = 3, independent code with one Newton step")
        } else {
            let mut tight = settings(3);
            tight[2] = tight[2].replace("1e-6", "1e-12");
            (tip(&tight)?, "tip after 10 steps at n = 3, the same solved to 1e-12")
        };
        let error = (tip(&settings(3))? / reference - 1.0).abs();
        for threads in thread_counts() {
            let settings = settings(n);
            let (samples, bytes) = with_threads(threads, move || -> Result<_, String> {
                let scene = scene("cantilever_dynamic", &settings)?;
                let mut world = scene.model.start(scene.state);
                let mut samples = Vec::new();
                for step in 0..if quick { 8 } else { 30 } {
                    let clock = Instant::now();
                    world.step().map_err(|error| error.to_string())?;
                    if step > 1 {
                        samples.push(1e3 * clock.elapsed().as_secs_f64());
                    }
                }
                Ok((samples, world.bytes()))
            })??;
            let count = samples.len();
            let (value, spread) = median(samples);
            figures.push(Figure {
                name: format!("{name}_{law}_{threads}t"),
                value,
                unit: "ms/step",
                higher_is_better: false,
                error,
                error_of: error_of.to_owned(),
                baseline: Some(peer),
                threads,
                samples: count,
                spread,
                bytes,
            });
        }
    }
    Ok(figures)
}

fn soft_beam(name: &str, [x, y, z]: [u32; 3], peer: f64, quick: bool) -> Result<Vec<Figure>, String> {
    let mut figures = Vec::new();
    for law in ["corotational", "neo_hookean"] {
        let settings = |stepper: &str| {
            vec![
                "world.period=\"2 ms\"".to_owned(),
                "bodies.bar.mesh.size=[1, 0.25, 0.25]".to_owned(),
                format!("bodies.bar.mesh.cells=[{x}, {y}, {z}]"),
                format!("bodies.bar.material.name=\"{law}\""),
                "bodies.bar.material.youngs_modulus=\"30 kPa\"".to_owned(),
                "bodies.bar.material.density=80".to_owned(),
                format!("systems.main.stepper={stepper}"),
            ]
        };
        let fast = settings("{ name = \"backward_euler\", newton = \"one\", solver_tolerance = 1e-4 }");
        let tight =
            settings("{ name = \"backward_euler\", newton_tolerance = 1e-9, solver_tolerance = 1e-10 }");
        let steps = if quick { 40 } else { 400 };
        let sag = |settings: &[String]| value_of(scene("cantilever_dynamic", settings)?, steps, "tip", 1);
        let error = (sag(&fast)? / sag(&tight)? - 1.0).abs();
        for threads in thread_counts() {
            let settings = fast.clone();
            let (samples, bytes) = with_threads(threads, move || -> Result<_, String> {
                let scene = scene("cantilever_dynamic", &settings)?;
                let mut world = scene.model.start(scene.state);
                let mut samples = Vec::new();
                for step in 0..if quick { 10 } else { 100 } {
                    let clock = Instant::now();
                    world.step().map_err(|error| error.to_string())?;
                    if step > 1 {
                        samples.push(1e3 * clock.elapsed().as_secs_f64());
                    }
                }
                Ok((samples, world.bytes()))
            })??;
            let count = samples.len();
            let (value, spread) = median(samples);
            figures.push(Figure {
                name: format!("{name}_{law}_{threads}t"),
                value,
                unit: "ms/step",
                higher_is_better: false,
                error,
                error_of: format!(
                    "sag after {:.2} s against the tightly converged run",
                    f64::from(steps as u32) * 2e-3
                ),
                baseline: Some(peer),
                threads,
                samples: count,
                spread,
                bytes,
            });
        }
    }
    Ok(figures)
}

fn static_100k(quick: bool) -> Result<Vec<Figure>, String> {
    let n = if quick { 6 } else { 12 };
    let settings = vec![
        format!("bodies.bar.mesh.cells=[{}, {n}, {n}]", 10 * n),
        "systems.main.stepper={ name = \"static\", newton_tolerance = 1e-8 }".to_owned(),
    ];
    let expected = -0.12977445957955291;
    let mut at_six = settings.clone();
    at_six[0] = "bodies.bar.mesh.cells=[60, 6, 6]".to_owned();
    let error = (value_of(scene("cantilever", &at_six)?, 1, "tip", 1)? / expected - 1.0).abs();
    let scene = scene("cantilever", &settings)?;
    let mut world = scene.model.start(scene.state);
    let clock = Instant::now();
    world.step().map_err(|error| error.to_string())?;
    Ok(vec![Figure {
        name: if quick { "static_13k".to_owned() } else { "static_100k".to_owned() },
        value: clock.elapsed().as_secs_f64(),
        unit: "s",
        higher_is_better: false,
        error,
        error_of: "tip at n = 6, FEniCSx".to_owned(),
        baseline: None,
        threads: rayon::current_num_threads(),
        samples: 1,
        spread: 0.0,
        bytes: world.bytes(),
    }])
}

fn startup(quick: bool) -> Result<Vec<Figure>, String> {
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    let mut samples = Vec::new();
    for _ in 0..if quick { 5 } else { 30 } {
        let clock = Instant::now();
        let output = std::process::Command::new(&program)
            .args(["list", "materials"])
            .output()
            .map_err(|error| error.to_string())?;
        samples.push(1e3 * clock.elapsed().as_secs_f64());
        if !output.status.success() {
            return Err(format!("`{} list materials` failed", program.display()));
        }
    }
    let count = samples.len();
    let (value, spread) = median(samples);
    Ok(vec![Figure {
        name: "startup".to_owned(),
        value,
        unit: "ms",
        higher_is_better: false,
        error: 0.0,
        error_of: "nothing: a list has no error".to_owned(),
        baseline: None,
        threads: 1,
        samples: count,
        spread,
        bytes: 0,
    }])
}
