//! Benchmarks: speed with its error beside it, on scenes anyone can run.

mod accuracy;
mod adaptive;
mod balls;
mod beams;
mod contact;
mod filling;
mod formulations;
mod frames;
mod frames_table;
mod hands;
mod laws;
mod levels;
mod links;
mod resolution;
mod rigid;
mod skins;
mod startup;
mod stretched;
mod timing;
mod tools;
mod view;

use std::fmt;

use serde_json::{Value, json};
use souple_run::{Control, Options, Status};
use souple_scene::Scene;
use souple_table::counted;

pub(crate) use timing::{Clock, with_threads};

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
    /// The same by the time that the one thread had a processor; `None` where it is not known.
    pub by_processor: Option<f64>,
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

/// Of forces of hexahedra, prisms and pyramids.
const WANTED_OF_OTHERS: laws::Wanted = laws::Wanted::ElementsPerSecond(3e6);

/// Every benchmark.
pub const BENCHES: &[Bench] = &[
    Bench {
        name: "explicit_tet4_stvk_100k",
        what: "complete symplectic steps of the reference bar, n = 12 (103,680 tetrahedra), bent [elements/s]",
        run: |effort| beams::explicit("explicit_tet4_stvk_100k", "tet4", 20e6, beams::trace_of_tet4, effort),
    },
    Bench {
        name: "explicit_hex8_stvk",
        what: "the same with hexahedra of eight samples, n = 12 [elements/s]",
        run: |effort| beams::explicit("explicit_hex8_stvk", "hex8", 3e6, beams::rest_of_hex8, effort),
    },
    Bench {
        name: "implicit_beam_n3",
        what: "one linearised backward Euler step of the reference bar, n = 3, to 1e-6 [ms/step]",
        run: |effort| beams::implicit_beam("implicit_beam_n3", 3, 4.8, effort),
    },
    Bench {
        name: "implicit_beam_n6",
        what: "the same, n = 6 (12,960 tetrahedra) [ms/step]",
        run: |effort| beams::implicit_beam("implicit_beam_n6", 6, 96.0, effort),
    },
    Bench {
        name: "implicit_beam_n12",
        what: "the same, n = 12 (103,680 tetrahedra) [ms/step]",
        run: |effort| beams::implicit_beam("implicit_beam_n12", 12, 1700.0, effort),
    },
    Bench {
        name: "implicit_beam_24k",
        what: "a soft bar of 24,000 tetrahedra at 2 ms steps [ms/step]",
        run: |effort| beams::soft_beam("implicit_beam_24k", [40, 10, 10], 27.0, effort),
    },
    Bench {
        name: "implicit_beam_5k",
        what: "the same bar with 5,880 tetrahedra [ms/step]",
        run: |effort| beams::soft_beam("implicit_beam_5k", [20, 7, 7], 5.0, effort),
    },
    Bench {
        name: "contact_block",
        what: "a gel block that falls on a floor with friction (324 hexahedra), Newton to 1e-7 [ms/step]",
        run: contact::contact_block,
    },
    Bench {
        name: "frames_50_1k",
        what: "52 rigid frames and 1,024 points, neo-Hookean, one linearised backward Euler step [steps/s]",
        run: |effort| frames::steps("frames_50_1k", frames::SMALL, effort),
    },
    Bench {
        name: "frames_errors",
        what: "the reference bar by every kind of frames and weights: error of the tip, and of the first frequency of torsion beside it [%]",
        run: |effort| frames_table::errors("frames_errors", effort),
    },
    Bench {
        name: "frames_500_50k",
        what: "the same with 496 frames and 51,200 points [steps/s]",
        run: |effort| frames::steps("frames_500_50k", frames::LARGE, effort),
    },
    Bench {
        name: "frames_growth",
        what: "a step of 144 rigid frames by the number of points: time of a thousand of them, memory, how far either is from growing as they do [us/step]",
        run: |effort| frames::growth("frames_growth", effort),
    },
    Bench {
        name: "frames_tissues",
        what: "two organs of finite elements and a pad, a ligament and a sheet of frames between them, pulled apart, one solve of 10 ms [ms/step]",
        run: |effort| frames::tissues("frames_tissues", effort),
    },
    Bench {
        name: "fill_100k",
        what: "the liver filled with about 100,000 tetrahedra, one thread [s]",
        run: filling::fill_100k,
    },
    Bench { name: "startup", what: "`souple list materials` from start to end [ms]", run: startup::startup },
    Bench {
        name: "springs_lattice_100k",
        what: "complete steps of a cubic lattice of 33 masses along each edge (104,544 damped springs) in motion [links/s, GB/s, of a triad's GB/s]",
        run: |effort| links::springs_lattice("springs_lattice_100k", 33, 150e6, effort),
    },
    Bench {
        name: "springs_lattice_1m",
        what: "the same with 70 masses along each edge (1,014,300 damped springs)",
        run: |effort| links::springs_lattice("springs_lattice_1m", 70, 120e6, effort),
    },
    Bench {
        name: "string_audio",
        what: "a string of 1,000 masses and 2,001 links along an axis at 44.1 kHz, one thread [x real time]",
        run: |effort| links::string_audio("string_audio", effort),
    },
    Bench {
        name: "balls_100k",
        what: "steps of a heap of 100,000 balls with cohesion and friction [steps/s]",
        run: |effort| balls::balls_100k("balls_100k", effort),
    },
    Bench {
        name: "balls_scaling",
        what: "the same with 1,000 to 1,000,000 balls, one thread and all [steps/s, pairs/s, ns/ball and step], memory, and the exponent fitted (BEN-6)",
        run: |effort| balls::scaling("balls_scaling", effort),
    },
    Bench {
        name: "balls_1m_peak",
        what: "most memory that the program holds for a run of a million such balls, with frames and picture [MB]",
        run: |effort| balls::peak("balls_1m_peak", effort),
    },
    Bench {
        name: "rigid_stack",
        what: "a period of five bricks on each other whose contacts and friction are solved for, standing and sliding apart, one thread [us]",
        run: |effort| rigid::stack("rigid_stack", effort),
    },
    Bench {
        name: "contours_500",
        what: "a step of five hundred balls with their frontier, the trace of a probe and how far these are apart, in a 25th of a second (EXP-48) [ms]",
        run: |effort| balls::contours("contours_500", effort),
    },
    Bench {
        name: "resolution",
        what: "how alike one cube swings on meshes of three resolutions, by every model [Hz], with the spread of each model",
        run: resolution::table,
    },
    Bench {
        name: "adaptive_saving",
        what: "active points of a block and of the organ while a tool is held in them, all fine over adaptive, with errors of force and surface",
        run: levels::adaptive_saving,
    },
    Bench {
        name: "octree_rod",
        what: "a rod of particles that divide where it bends and are grouped when it calms (V-07) [x as fast as the finest level, and as the coarse one]",
        run: levels::octree_rod,
    },
    Bench {
        name: "octree_in_time",
        what: "the liver of particles, the finest everywhere, one thread: time of computing over the time of the world (V-08)",
        run: levels::octree_in_time,
    },
    Bench {
        name: "dress_share",
        what: "what the surface that is shown of the poked organ takes of a period (V-40)",
        run: levels::dress_share,
    },
    Bench {
        name: "tool_detection_10k",
        what: "one search for what a tool touches, among ten thousand triangles that move [ms]",
        run: tools::detection,
    },
    Bench {
        name: "haptic_period_99_9",
        what: "periods of the devices' loop beside the liver in an emulated hand, against the clock [ms]; how old forces are [ms], and their greatest change from tick to tick [N]; loads of the worlds",
        run: hands::period,
    },
    Bench {
        name: "real_time_ten_minutes",
        what: "ten minutes of the organ in a hand that never rests, against the clock: drift, late periods, loads",
        run: hands::ten_minutes,
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
        what: "frames that a client on this machine gets of a ligament of 20,816 triangles, and from its hand to the frame [frames/s, ms]",
        run: view::rate,
    },
    Bench {
        name: "view_network",
        what: "a frame of a lattice of 8,019 masses and their links, on the thread of the world, and frames that a client on this machine gets of it while it moves [ms, frames/s]",
        run: view::network,
    },
    Bench {
        name: "static_100k",
        what: "equilibrium of the reference bar, n = 12, St. Venant-Kirchhoff, to 1e-8 [s]",
        run: beams::static_100k,
    },
    Bench {
        name: "memory_100k",
        what: "bytes for each tetrahedron of an implicit step of the reference bar, n = 12, with a matrix and without [B/tet]",
        run: beams::memory_100k,
    },
    Bench {
        name: "law_text_tensor",
        what: "steps with a law as text of tensor operations, over those with the same law of the table [x built-in]",
        run: |effort| laws::law_text("law_text_tensor", laws::Writing::Tensors, 1.3, effort),
    },
    Bench {
        name: "law_text_table",
        what: "the same of every law of the table, as it is written in the library, explicit and implicit [x built-in]",
        run: |effort| laws::law_text_table("law_text_table", 1.3, effort),
    },
    Bench {
        name: "law_text_reworded",
        what: "the same of laws of the table in other words than those of the library [x built-in]",
        run: |effort| laws::law_text_reworded("law_text_reworded", 1.3, effort),
    },
    Bench {
        name: "law_text_scalar",
        what: "the same with the law written entry by entry [x built-in]",
        run: |effort| laws::law_text("law_text_scalar", laws::Writing::Scalars, 2.5, effort),
    },
    Bench {
        name: "inelastic",
        what: "steps of a solid whose rest shape may yield, over those of the elastic solid [x elastic]",
        run: |effort| laws::inelastic("inelastic", effort),
    },
    Bench {
        name: "law_ready",
        what: "from text to a program, for every law that ships [ms], and the same from the file where it was kept before",
        run: laws::law_ready,
    },
    Bench {
        name: "tet4_forces",
        what: "forces alone of tetrahedra, St. Venant-Kirchhoff, bent [elements/s], and a derivative product [x force]",
        run: |effort| laws::forces("tet4_forces", "tet4", 12, laws::Wanted::Steps, effort),
    },
    Bench {
        name: "shell_forces",
        what: "forces of triangles that resist bending, of 32,000 cells, one thread [elements/s], and over those of their membrane [x membrane]",
        run: |effort| laws::shells("shell_forces", effort),
    },
    Bench {
        name: "green_over_cauchy",
        what: "forces of tetrahedra by Green and Lagrange's strain over those by Cauchy's, one thread [x Cauchy] (V-01)",
        run: |effort| laws::green_over_cauchy("green_over_cauchy", effort),
    },
    Bench {
        name: "hex8_forces",
        what: "the same of hexahedra of eight samples",
        run: |effort| laws::forces("hex8_forces", "hex8", 12, WANTED_OF_OTHERS, effort),
    },
    Bench {
        name: "prism6_forces",
        what: "the same of prisms of six samples",
        run: |effort| laws::forces("prism6_forces", "prism6", 10, WANTED_OF_OTHERS, effort),
    },
    Bench {
        name: "pyramid5_forces",
        what: "the same of pyramids of five samples",
        run: |effort| laws::forces("pyramid5_forces", "pyramid5", 7, WANTED_OF_OTHERS, effort),
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
        name: "accuracy",
        what: "equilibrium of the long beam by hexahedra and by tetrahedra, ever finer [s], error of its tip (EXP-28)",
        run: |effort| accuracy::table("accuracy", effort),
    },
    Bench {
        name: "explicit_or_implicit",
        what: "0.9 s of the stretched cube by explicit Euler over the same by implicit steps of 0.1 s [x implicit] (EXP-19)",
        run: |effort| stretched::table("explicit_or_implicit", effort),
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
            "by_processor": self.by_processor,
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

impl Figure {
    /// Whether it is worse than what it is held against: by the time of the processor where that is known, for what others do on a
    /// machine is no fault of a figure.
    pub fn misses(&self) -> bool {
        let value = self.by_processor.unwrap_or(self.value);
        self.baseline.is_some_and(
            |baseline| {
                if self.higher_is_better { value < baseline } else { value > baseline }
            },
        )
    }
}

impl fmt::Display for Figure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{:width$} {:>10} {} (",
            self.name,
            readable(self.value),
            self.unit,
            width = f.width().unwrap_or(38),
        )?;
        if let Some(by_processor) = self.by_processor {
            write!(f, "{} by time of the processor; ", readable(by_processor))?;
        }
        if let Some(baseline) = self.baseline {
            write!(f, "baseline {}; ", readable(baseline))?;
        }
        write!(
            f,
            "spread {:.0} %, {}, {}, {:.1} MB",
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

/// Four digits, with millions and thousands as such.
fn readable(value: f64) -> String {
    let (value, prefix) = match value.abs() {
        large if large >= 1e6 => (value * 1e-6, " M"),
        large if large >= 1e4 => (value * 1e-3, " k"),
        _ => (value, ""),
    };
    let digits = (3 - value.abs().max(1e-6).log10().floor() as i32).clamp(0, 6) as usize;
    format!("{value:.digits$}{prefix}")
}

/// Runs a scene and gives the last value of a probe's component.
fn value_of(scene: Scene, steps: u64, probe: &str, component: usize) -> Result<f64, String> {
    let options = Options { steps: Some(steps), ..Options::default() };
    let outcome =
        souple_run::run(scene, &options, &mut |_| Control::Continue).map_err(|error| error.to_string())?;
    if outcome.report.status != Status::Done {
        return Err(outcome.report.warnings.join("; "));
    }
    let trace = outcome.traces.iter().find(|trace| trace.name == probe).ok_or("the probe is missing")?;
    trace
        .last()
        .and_then(|value| value.get(component))
        .copied()
        .ok_or_else(|| "the probe is empty".to_owned())
}
