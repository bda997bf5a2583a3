//! Benchmarks: speed with its error beside it, on scenes anyone can run.

mod adaptive;
mod formulations;
mod frames;
mod laws;
mod levels;
mod links;
mod skins;
mod timing;
mod view;

use std::fmt;
use std::time::Instant;

use serde_json::{Value, json};
use souple_run::{Control, Options};
use souple_scene::Scene;
use souple_table::counted;

use timing::{Held, Timing, as_it_is, bend, median, scene, with_threads};

/// One benchmark.
#[derive(Clone, Copy)]
pub struct Bench {
    pub name: &'static str,
    pub what: &'static str,
    pub run: fn(Effort) -> Result<Vec<Figure>, String>,
}

/// How much is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// Few samples: whether all runs, and about how fast.
    Quick,
    Full,
}

impl Effort {
    fn choose<T>(self, quick: T, full: T) -> T {
        match self {
            Self::Quick => quick,
            Self::Full => full,
        }
    }
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
    /// What the error is of; empty where there is nothing to be wrong.
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
        run: |effort| explicit("explicit_tet4_stvk_100k", "tet4", 20e6, trace_of_tet4, effort),
    },
    Bench {
        name: "explicit_hex8_stvk",
        what: "the same with hexahedra of eight samples, n = 12 [elements/s]",
        run: |effort| explicit("explicit_hex8_stvk", "hex8", 3e6, rest_of_hex8, effort),
    },
    Bench {
        name: "implicit_beam_n3",
        what: "one linearised backward Euler step of the reference bar, n = 3, to 1e-6 [ms/step]",
        run: |effort| implicit_beam("implicit_beam_n3", 3, 4.8, effort),
    },
    Bench {
        name: "implicit_beam_n6",
        what: "the same, n = 6 (12,960 tetrahedra) [ms/step]",
        run: |effort| implicit_beam("implicit_beam_n6", 6, 96.0, effort),
    },
    Bench {
        name: "implicit_beam_n12",
        what: "the same, n = 12 (103,680 tetrahedra) [ms/step]",
        run: |effort| implicit_beam("implicit_beam_n12", 12, 1700.0, effort),
    },
    Bench {
        name: "implicit_beam_24k",
        what: "a soft bar of 24,000 tetrahedra at 2 ms steps [ms/step]",
        run: |effort| soft_beam("implicit_beam_24k", [40, 10, 10], 27.0, effort),
    },
    Bench {
        name: "implicit_beam_5k",
        what: "the same bar with 5,880 tetrahedra [ms/step]",
        run: |effort| soft_beam("implicit_beam_5k", [20, 7, 7], 5.0, effort),
    },
    Bench {
        name: "contact_block",
        what: "a gel block that falls on a floor with friction (324 hexahedra), Newton to 1e-7 [ms/step]",
        run: contact_block,
    },
    Bench {
        name: "frames_50_1k",
        what: "52 rigid frames and 1,024 points, neo-Hookean, one linearised backward Euler step [steps/s]",
        run: |effort| frames::steps("frames_50_1k", frames::SMALL, effort),
    },
    Bench {
        name: "frames_500_50k",
        what: "the same with 496 frames and 51,200 points [steps/s]",
        run: |effort| frames::steps("frames_500_50k", frames::LARGE, effort),
    },
    Bench {
        name: "fill_100k",
        what: "the liver filled with about 100,000 tetrahedra, one thread [s]",
        run: fill_100k,
    },
    Bench { name: "startup", what: "`souple list materials` from start to end [ms]", run: startup },
    Bench {
        name: "springs_lattice_100k",
        what: "complete steps of a cubic lattice of 33 masses along each edge (104,544 damped springs) in motion [links/s]",
        run: |effort| links::springs_lattice("springs_lattice_100k", 33, Some(118e6), effort),
    },
    Bench {
        name: "springs_lattice_1m",
        what: "the same with 70 masses along each edge (1,014,300 damped springs) [links/s]",
        run: |effort| links::springs_lattice("springs_lattice_1m", 70, None, effort),
    },
    Bench {
        name: "adaptive_saving",
        what: "active points of the poked organ, all fine over adaptive, with errors of force and surface",
        run: levels::adaptive_saving,
    },
    Bench {
        name: "skin_step_128",
        what: "steps of a skin that fills 128^3 cells with a ball, drawn to another and tense, with its triangles [steps/s]",
        run: skins::step_128,
    },
    Bench {
        name: "skin_cost",
        what: "the same with 64 to 512 cells along an edge [ms/step], and the exponent fitted",
        run: skins::cost,
    },
    Bench {
        name: "skin_image",
        what: "an image of the metamorphosis of a twisted bundle on 50^3 cells, which took 1 s in 1997, one thread [s]",
        run: skins::image,
    },
    Bench {
        name: "skin_100k",
        what: "the surface of 100,000 particles of a ball at voxels of their radius, beside pysplashsurf [particles/s]",
        run: |effort| skins::dress_100k("skin_100k", 1.0, effort),
    },
    Bench {
        name: "skin_100k_half",
        what: "the same at voxels of half their radius",
        run: |effort| skins::dress_100k("skin_100k_half", 0.5, effort),
    },
    Bench {
        name: "view_frame_20k",
        what: "a frame for the browser of a bar with 20,800 triangles, coloured, on the thread of the world [ms]",
        run: view::frame_20k,
    },
    Bench {
        name: "view_rate",
        what: "frames that a client on this machine gets of the falling block, and from its hand to the frame [frames/s, ms]",
        run: view::rate,
    },
    Bench {
        name: "static_100k",
        what: "equilibrium of the reference bar, n = 12, St. Venant-Kirchhoff, to 1e-8 [s]",
        run: static_100k,
    },
    Bench {
        name: "law_text_tensor",
        what: "steps with a law as text of tensor operations, over those with the same law of the table [x built-in]",
        run: |effort| laws::law_text("law_text_tensor", laws::Writing::Tensors, 1.3, effort),
    },
    Bench {
        name: "law_text_scalar",
        what: "the same with the law written entry by entry [x built-in]",
        run: |effort| laws::law_text("law_text_scalar", laws::Writing::Scalars, 2.5, effort),
    },
    Bench {
        name: "tet4_forces",
        what: "forces alone of tetrahedra, St. Venant-Kirchhoff, bent [elements/s], and a derivative product [x force]",
        run: |effort| laws::forces("tet4_forces", "tet4", 12, 20e6, effort),
    },
    Bench {
        name: "hex8_forces",
        what: "the same of hexahedra of eight samples",
        run: |effort| laws::forces("hex8_forces", "hex8", 12, 3e6, effort),
    },
    Bench {
        name: "prism6_forces",
        what: "the same of prisms of six samples",
        run: |effort| laws::forces("prism6_forces", "prism6", 10, 3e6, effort),
    },
    Bench {
        name: "pyramid5_forces",
        what: "the same of pyramids of five samples",
        run: |effort| laws::forces("pyramid5_forces", "pyramid5", 7, 3e6, effort),
    },
    Bench {
        name: "tangents",
        what: "an implicit step with the tangent stored, element by element, and by differences of forces [ms/step]",
        run: |effort| laws::tangents("tangents", effort),
    },
    Bench {
        name: "formal",
        what: "every formulation on the reference bar: forces and derivative products [elements/s], error against samples",
        run: |effort| formulations::table("formal", effort),
    },
    Bench {
        name: "adaptive",
        what: "twenty steps of a bar whose elements change their law, by threshold [ms/step], deviation of its tip",
        run: |effort| adaptive::table("adaptive", effort),
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
            "{:38} {:>12.4} {} (spread {:.0} %, {}, {}, {:.1} MB",
            self.name,
            self.value,
            self.unit,
            100.0 * self.spread,
            counted(self.threads as u64, "thread"),
            counted(self.samples as u64, "sample"),
            self.bytes as f64 * 1e-6,
        )?;
        if !self.error_of.is_empty() {
            write!(f, "; error {:.1e} of {}", self.error, self.error_of)?;
        }
        write!(f, ")")
    }
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

/// Settings of the explicit benchmarks.
fn explicit_settings(element: &str, cells: u32, period: &str) -> Vec<String> {
    vec![
        format!("world.period=\"{period}\""),
        "systems.main.stepper=\"symplectic_euler\"".to_owned(),
        format!("bodies.bar.mesh.cells=[{}, {cells}, {cells}]", 10 * cells),
        format!("bodies.bar.mesh.element=\"{element}\""),
    ]
}

/// How far off an element's answer is, and of what.
type Check = fn() -> Result<(f64, &'static str), String>;

/// This very scheme: the trace of an independent code.
fn trace_of_tet4() -> Result<(f64, &'static str), String> {
    let scene = scene("cantilever_dynamic", &explicit_settings("tet4", 3, "50 us"))?;
    let tip = value_of(scene, 1000, "tip", 1)?;
    Ok(((tip / -0.015741317589581534 - 1.0).abs(), "tip after 1000 steps at n = 3, independent code"))
}

/// The forces of the elements where they balance gravity; the independent code integrates with 27 samples.
fn rest_of_hex8() -> Result<(f64, &'static str), String> {
    let settings = [
        "bodies.bar.mesh.cells=[30, 3, 3]",
        "bodies.bar.mesh.element=\"hex8\"",
        "bodies.bar.quadrature=\"full\"",
        "systems.main.stepper={ name = \"static\", newton_tolerance = 1e-9 }",
    ];
    let scene = scene("cantilever", &settings.map(str::to_owned))?;
    let tip = value_of(scene, 1, "tip", 1)?;
    Ok(((tip / -0.13619818759625157 - 1.0).abs(), "tip at rest at n = 3 with 27 samples, GetFEM"))
}

fn explicit(
    name: &str,
    element: &str,
    peer: f64,
    check: Check,
    effort: Effort,
) -> Result<Vec<Figure>, String> {
    let (error, error_of) = check()?;
    let held = Held { error, error_of: error_of.to_owned(), baseline: Some(peer) };
    let timing = Timing {
        scene: "cantilever_dynamic",
        settings: &explicit_settings(element, 12, "10 us"),
        prepare: bend,
        warm_up: 0,
        samples: effort.choose(5, 30),
        steps_per_sample: 5,
    };
    Ok(timing.run()?.iter().map(|timed| timed.elements_per_second(name, &held)).collect())
}

fn implicit_beam(name: &str, n: u32, peer: f64, effort: Effort) -> Result<Vec<Figure>, String> {
    let mut figures = Vec::new();
    for law in ["corotational", "st_venant_kirchhoff"] {
        let settings = |n: u32, tolerance: &str| {
            vec![
                format!("bodies.bar.mesh.cells=[{}, {n}, {n}]", 10 * n),
                format!("bodies.bar.material.name=\"{law}\""),
                format!(
                    "systems.main.stepper={{ name = \"backward_euler\", newton = \"one\", solver_tolerance = {tolerance} }}"
                ),
            ]
        };
        // at n = 3: an independent code's ten steps, or where there is none ours solved to rounding
        let tip = |settings: &[String]| value_of(scene("cantilever_dynamic", settings)?, 10, "tip", 1);
        let (reference, error_of) = if law == "st_venant_kirchhoff" {
            (-0.06758904669664875, "tip after 10 steps at n = 3, independent code with one Newton step")
        } else {
            (tip(&settings(3, "1e-12"))?, "tip after 10 steps at n = 3, the same solved to 1e-12")
        };
        let held = Held {
            error: (tip(&settings(3, "1e-6"))? / reference - 1.0).abs(),
            error_of: error_of.to_owned(),
            baseline: Some(peer),
        };
        let timing = Timing {
            scene: "cantilever_dynamic",
            settings: &settings(n, "1e-6"),
            prepare: as_it_is,
            warm_up: 2,
            samples: effort.choose(6, 28),
            steps_per_sample: 1,
        };
        let name = format!("{name}_{law}");
        figures.extend(timing.run()?.iter().map(|timed| timed.milliseconds_per_step(&name, &held)));
    }
    Ok(figures)
}

fn soft_beam(name: &str, [x, y, z]: [u32; 3], peer: f64, effort: Effort) -> Result<Vec<Figure>, String> {
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
        let steps = effort.choose(40, 400);
        let sag = |settings: &[String]| value_of(scene("cantilever_dynamic", settings)?, steps, "tip", 1);
        let held = Held {
            error: (sag(&fast)? / sag(&tight)? - 1.0).abs(),
            error_of: format!("sag after {:.2} s against the tightly converged run", steps as f64 * 2e-3),
            baseline: Some(peer),
        };
        let timing = Timing {
            scene: "cantilever_dynamic",
            settings: &fast,
            prepare: as_it_is,
            warm_up: 2,
            samples: effort.choose(8, 98),
            steps_per_sample: 1,
        };
        let name = format!("{name}_{law}");
        figures.extend(timing.run()?.iter().map(|timed| timed.milliseconds_per_step(&name, &held)));
    }
    Ok(figures)
}

fn contact_block(effort: Effort) -> Result<Vec<Figure>, String> {
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

fn static_100k(effort: Effort) -> Result<Vec<Figure>, String> {
    let (n, name) = effort.choose((6, "static_13k"), (12, "static_100k"));
    let settings = |n: u32| {
        vec![
            format!("bodies.bar.mesh.cells=[{}, {n}, {n}]", 10 * n),
            "systems.main.stepper={ name = \"static\", newton_tolerance = 1e-8 }".to_owned(),
        ]
    };
    let expected = -0.12977445957955291;
    let error = (value_of(scene("cantilever", &settings(6))?, 1, "tip", 1)? / expected - 1.0).abs();
    let timing = Timing {
        scene: "cantilever",
        settings: &settings(n),
        prepare: as_it_is,
        warm_up: 0,
        samples: 1,
        steps_per_sample: 1,
    };
    let timed = timing.sample(rayon::current_num_threads())?;
    Ok(vec![Figure {
        name: name.to_owned(),
        value: timed.seconds[0],
        unit: "s",
        higher_is_better: false,
        error,
        error_of: "tip at n = 6, FEniCSx".to_owned(),
        baseline: None,
        threads: timed.threads,
        samples: 1,
        spread: 0.0,
        bytes: timed.bytes,
    }])
}

/// The organ on a lattice of the size that gives about a hundred thousand tetrahedra; the error is that of its volume.
fn fill_100k(effort: Effort) -> Result<Vec<Figure>, String> {
    use souple_mesh::fill::{Cells, Size, fill};
    let body =
        souple_mesh::implicit::body("liver", souple_table::Values::new()).map_err(|e| e.to_string())?;
    let filled = |size: f64| {
        fill(&*body.shape, &Size::uniform(size), Cells::Tetrahedra, &[]).map_err(|error| error.to_string())
    };
    let (size, finer) = (FILL_SIZE, 0.6 * FILL_SIZE);
    let mut samples = Vec::new();
    let mut cells = 0;
    let mut volume = 0.0;
    for _ in 0..effort.choose(1, 5) {
        let clock = Instant::now();
        let mesh = with_threads(1, || filled(size))??;
        samples.push(clock.elapsed().as_secs_f64());
        (cells, volume) = (mesh.cell_count(), mesh.volume());
    }
    let error = (volume / filled(finer)?.volume() - 1.0).abs();
    let count = samples.len();
    let (value, spread) = median(samples);
    Ok(vec![Figure {
        name: "fill_100k".to_owned(),
        value,
        unit: "s",
        higher_is_better: false,
        error,
        error_of: format!("volume of {cells} tetrahedra, against three fifths of the size"),
        baseline: None,
        threads: 1,
        samples: count,
        spread,
        bytes: 0,
    }])
}

/// Edge of the lattice for about a hundred thousand tetrahedra in the liver [m].
const FILL_SIZE: f64 = 5.4e-3;

fn startup(effort: Effort) -> Result<Vec<Figure>, String> {
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    let mut samples = Vec::new();
    for _ in 0..effort.choose(5, 30) {
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
        error_of: String::new(),
        baseline: None,
        threads: 1,
        samples: count,
        spread,
        bytes: 0,
    }])
}
