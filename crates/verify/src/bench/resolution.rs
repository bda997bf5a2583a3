//! How alike one body moves on meshes of several resolutions, by every model: the table of the multiresolution specification (3.4).
//!
//! A cube is glued to a wall and let go. What is told is how often its far corner swings, how deep and how high, on meshes `K_S(2)`, `K_S(3)`,
//! `K_S(4)`; the error is how far that is from the specification's independent program. The spread of a model is the greatest
//! frequency over the least, less one. All of that is told of the mirrored meshes `K_M(n)` too. Of linear models, the four lowest frequencies of each mesh
//! and the longest step of explicit steppers, `2/ω`, are beside it. Models of levels are there with one mesh, and with half of the cube of a mesh twice as fine.

use souple_run::{Control, Options, Status};

use super::timing::scene;
use super::{Effort, Figure};

/// A model and what it swings at: settings, and by mesh the frequency [Hz] and the lowest point [m] as published, where they are.
struct Model {
    name: &'static str,
    settings: &'static [&'static str],
    /// Settings of each mesh besides.
    of_mesh: [&'static [&'static str]; 3],
    published: Option<[[f64; 2]; 3]>,
    /// The same of mirrored meshes.
    mirrored: Option<[[f64; 2]; 3]>,
    /// The four lowest frequencies [Hz] and the longest explicit step [ms] as published, of straight meshes and of mirrored ones.
    linear: Option<[[[f64; 5]; 3]; 2]>,
    /// The spread that the specification allows.
    spread: Option<f64>,
}

/// λ = 20 kPa, μ = 7 kPa.
const STIFF: &str = "bodies.cube.material.youngs_modulus=19185.185185185186";
/// What Van Gelder's stiffness asks for.
const SPRINGS: &str = "bodies.cube.material.youngs_modulus=20000";
const ALIKE: [&[&str]; 3] = [&[], &[], &[]];
/// A grid of points that are particles alone, as many as `K_S(n)` has.
const GRID: &str = r#"bodies.cube.mesh.element="hex8""#;

/// Without a formulation, in whose place levels are.
const LEVELS_OWN: &str = "bodies.cube.formulation=";
const STAGGERED: &str = r#"systems.main.stepper={ name = "staggered", halvings = 1 }"#;
const GREEN: &str = r#"bodies.cube.material.name="st_venant_kirchhoff""#;
/// V-28.
const GREEN_SPREAD: Option<f64> = Some(0.13);

/// A mesh of as many cells, half of the cube of it and half of the finer one.
macro_rules! halves {
    ($cells:literal) => {
        concat!(
            r#"bodies.cube.levels={ coarser = [{ mesh = { generate = "box", size = [0.1, 0.1, 0.1], cells = "#,
            $cells,
            r#", element = "tet4" } }], fixed = "if(x < 0.05, 1, 0)" }"#
        )
    };
}

const MODELS: &[Model] = &[
    Model {
        name: "cauchy",
        settings: &[r#"bodies.cube.formulation={ name = "edge_tensors" }"#, STIFF],
        of_mesh: ALIKE,
        published: Some([[5.33, -19.3e-3], [5.08, -22.6e-3], [4.92, -24.8e-3]]),
        mirrored: Some([[5.17, -23.3e-3], [5.13, -24.1e-3], [4.90, -27.7e-3]]),
        linear: Some([
            [
                [5.241, 5.535, 7.463, 11.577, 5.62],
                [5.102, 5.330, 7.036, 11.599, 3.77],
                [4.990, 5.161, 6.784, 11.544, 2.83],
            ],
            [
                [5.165, 5.165, 7.361, 10.605, 6.36],
                [5.102, 5.141, 7.013, 11.498, 3.90],
                [4.891, 4.891, 6.741, 11.423, 3.24],
            ],
        ]),
        spread: None,
    },
    Model {
        name: "green_lagrange",
        settings: &[
            r#"bodies.cube.formulation={ name = "samples" }"#,
            r#"bodies.cube.material.name="st_venant_kirchhoff""#,
            STIFF,
        ],
        of_mesh: ALIKE,
        published: Some([[5.19, -19.2e-3], [5.00, -23.2e-3], [4.85, -25.1e-3]]),
        mirrored: Some([[5.04, -24.1e-3], [4.96, -24.2e-3], [4.71, -28.4e-3]]),
        linear: None,
        spread: GREEN_SPREAD,
    },
    Model {
        name: "hybrid",
        settings: &[],
        of_mesh: ALIKE,
        published: Some([[4.06, -35.8e-3], [4.13, -36.0e-3], [4.15, -36.1e-3]]),
        mirrored: Some([[4.04, -37.2e-3], [4.13, -36.1e-3], [4.15, -36.6e-3]]),
        linear: Some([
            [
                [4.056, 4.060, 6.050, 8.147, 8.53],
                [4.131, 4.132, 5.926, 8.853, 5.77],
                [4.155, 4.155, 5.824, 9.094, 4.34],
            ],
            [
                [4.050, 4.050, 5.935, 8.171, 9.81],
                [4.125, 4.125, 5.831, 8.864, 5.91],
                [4.150, 4.150, 5.730, 9.086, 4.99],
            ],
        ]),
        spread: Some(0.025),
    },
    Model {
        name: "gauss_voronoi",
        settings: &[r#"bodies.cube.formulation={ name = "gauss_voronoi" }"#],
        of_mesh: ALIKE,
        published: None,
        mirrored: None,
        linear: None,
        spread: None,
    },
    Model {
        name: "gauss_median",
        settings: &[r#"bodies.cube.formulation={ name = "gauss_voronoi", dual = "median" }"#],
        of_mesh: ALIKE,
        published: Some([[4.06, -35.8e-3], [4.13, -36.0e-3], [4.15, -36.1e-3]]),
        mirrored: Some([[4.04, -37.2e-3], [4.13, -36.1e-3], [4.15, -36.6e-3]]),
        linear: None,
        spread: None,
    },
    Model {
        name: "springs_constant",
        settings: &[
            r#"bodies.cube.formulation={ name = "mass_spring", rule = "constant", coefficient = 350 }"#,
        ],
        of_mesh: ALIKE,
        published: Some([[4.63, -29.0e-3], [5.19, -26.2e-3], [5.29, -22.9e-3]]),
        mirrored: Some([[5.94, -17.8e-3], [6.02, -17.1e-3], [7.00, -13.1e-3]]),
        linear: None,
        spread: None,
    },
    Model {
        name: "springs_proportional",
        settings: &[
            r#"bodies.cube.formulation={ name = "mass_spring", rule = "proportional", coefficient = 7000 }"#,
        ],
        of_mesh: ALIKE,
        published: Some([[5.10, -23.9e-3], [4.42, -30.8e-3], [4.04, -36.2e-3]]),
        mirrored: Some([[6.88, -12.5e-3], [5.69, -19.8e-3], [5.75, -19.2e-3]]),
        linear: None,
        spread: None,
    },
    Model {
        name: "springs_inverse",
        settings: &[],
        of_mesh: [
            &[r#"bodies.cube.formulation={ name = "mass_spring", rule = "inverse", coefficient = 20 }"#],
            &[r#"bodies.cube.formulation={ name = "mass_spring", rule = "inverse", coefficient = 13 }"#],
            &[r#"bodies.cube.formulation={ name = "mass_spring", rule = "inverse", coefficient = 6 }"#],
        ],
        published: Some([[4.46, -31.5e-3], [4.98, -28.9e-3], [3.90, -39.5e-3]]),
        mirrored: Some([[5.29, -21.3e-3], [5.56, -20.9e-3], [4.94, -25.6e-3]]),
        linear: None,
        spread: None,
    },
    Model {
        name: "springs_van_gelder",
        settings: &[r#"bodies.cube.formulation={ name = "mass_spring" }"#, SPRINGS],
        of_mesh: ALIKE,
        published: Some([[3.73, -36.4e-3], [3.63, -44.5e-3], [3.54, -46.5e-3]]),
        mirrored: Some([[5.15, -23.9e-3], [4.56, -33.4e-3], [4.73, -29.3e-3]]),
        linear: None,
        spread: None,
    },
    Model {
        name: "particles_legacy",
        settings: &[
            GRID,
            r#"bodies.cube.formulation={ name = "particles", operators = "legacy", volumes = "uniform" }"#,
            r#"bodies.cube.mass="uniform""#,
            STIFF,
        ],
        of_mesh: ALIKE,
        published: None,
        mirrored: None,
        linear: None,
        spread: None,
    },
    Model {
        name: "particles_energy",
        settings: &[GRID, r#"bodies.cube.formulation={ name = "particles" }"#, STIFF],
        of_mesh: ALIKE,
        published: None,
        mirrored: None,
        linear: None,
        spread: None,
    },
    Model {
        name: "octree",
        settings: &[
            GRID,
            LEVELS_OWN,
            STAGGERED,
            r#"bodies.cube.mass="uniform""#,
            r#"bodies.cube.octree={ levels = 2, fixed = "if(x < 0.05, 1, 0)" }"#,
            STIFF,
        ],
        // twice as many along an edge as `K_S(n)` has cells, half of them grouped
        of_mesh: [
            &["bodies.cube.mesh.cells=[3, 3, 3]"],
            &["bodies.cube.mesh.cells=[5, 5, 5]"],
            &["bodies.cube.mesh.cells=[7, 7, 7]"],
        ],
        published: None,
        mirrored: None,
        linear: None,
        spread: None,
    },
    Model {
        name: "levels",
        settings: &[LEVELS_OWN, STAGGERED, GREEN, STIFF, "bodies.cube.levels={ count = 1 }"],
        of_mesh: ALIKE,
        published: Some([[5.19, -19.2e-3], [5.00, -23.2e-3], [4.85, -25.1e-3]]),
        mirrored: None,
        linear: None,
        spread: GREEN_SPREAD,
    },
    Model {
        name: "levels_mixed",
        settings: &[LEVELS_OWN, STAGGERED, GREEN, STIFF],
        of_mesh: [
            &["bodies.cube.mesh.cells=[4, 4, 4]", halves!("[2, 2, 2]")],
            &["bodies.cube.mesh.cells=[6, 6, 6]", halves!("[3, 3, 3]")],
            &["bodies.cube.mesh.cells=[8, 8, 8]", halves!("[4, 4, 4]")],
        ],
        published: None,
        mirrored: None,
        linear: None,
        spread: None,
    },
];

/// Cells along an edge, and steps in 10 ms.
const MESHES: [(u32, u32); 3] = [(2, 8), (3, 8), (4, 16)];

/// Which way the cells are cut.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Cut {
    /// `K_S(n)`
    Straight,
    /// `K_M(n)`
    Mirrored,
}

impl Cut {
    /// What names of figures have of it.
    fn infix(self) -> &'static str {
        match self {
            Self::Straight => "",
            Self::Mirrored => "mirrored_",
        }
    }

    fn setting(self) -> Option<&'static str> {
        (self == Self::Mirrored).then_some(r#"bodies.cube.mesh.element="tet4_mirrored""#)
    }
}

fn settings_of(model: &Model, cut: Cut, mesh: usize) -> Vec<String> {
    let (cells, steps) = MESHES[mesh];
    let mut settings = vec![
        format!("bodies.cube.mesh.cells=[{cells}, {cells}, {cells}]"),
        format!("systems.main.steps_per_period={steps}"),
    ];
    let of_model = cut.setting().into_iter().chain(model.settings.iter().chain(model.of_mesh[mesh]).copied());
    settings.extend(of_model.map(str::to_owned));
    settings
}

/// The four lowest frequencies [Hz], and the longest step that an explicit stepper may take [ms].
fn linear(model: &Model, cut: Cut, mesh: usize) -> Result<[f64; 5], String> {
    let settings = settings_of(model, cut, mesh);
    let found = souple_run::natural_frequencies(scene("swinging_cube", &settings)?, 4, 0.0)
        .map_err(|error| error.to_string())?;
    let hertz = &found.first().ok_or("the scene has no system")?.hertz;
    let [first, second, third, fourth] = hertz[..] else {
        return Err("the cube has no four modes".to_owned());
    };
    let scene = scene("swinging_cube", &settings)?;
    let mut world = scene.model.start(scene.state);
    let highest = world.with_system(0, |system, state, around, ws| {
        souple_engine::stability::forecast(system, state, around, ws).highest_frequency
    });
    Ok([first, second, third, fourth, 2e3 / highest])
}

/// Frequency, lowest and highest point of the corner within 6 s.
fn swing(model: &Model, cut: Cut, mesh: usize) -> Result<[f64; 3], String> {
    let settings = settings_of(model, cut, mesh);
    let options = Options { scene_name: "swinging_cube".to_owned(), ..Options::default() };
    let outcome = souple_run::run(scene("swinging_cube", &settings)?, &options, &mut |_| Control::Continue)
        .map_err(|error| error.to_string())?;
    if outcome.report.status != Status::Done {
        return Ok([f64::NAN; 3]);
    }
    let trace = outcome.traces.iter().find(|trace| trace.name == "corner").ok_or("the probe is missing")?;
    let summary = trace.summary();
    Ok([summary.frequency[2].unwrap_or(f64::NAN), summary.min[2], summary.max[2]])
}

/// A number beside what is published of it.
fn figure(name: String, value: f64, unit: &'static str, known: Option<f64>) -> Figure {
    Figure {
        name,
        value,
        by_processor: None,
        unit,
        higher_is_better: true,
        error: known.map_or(0.0, |known| (value / known - 1.0).abs()),
        error_of: known.map_or(String::new(), |_| "the specification's independent program".to_owned()),
        baseline: known,
        threads: 1,
        samples: 1,
        spread: 0.0,
        bytes: 0,
    }
}

pub fn table(effort: Effort) -> Result<Vec<Figure>, String> {
    let meshes = effort.choose(2, MESHES.len());
    let mut figures = Vec::new();
    for model in MODELS {
        figures.extend(model.figures(Cut::Straight, meshes)?);
        // particles and levels have grids of their own
        if model.mirrored.is_some() {
            figures.extend(model.figures(Cut::Mirrored, meshes)?);
        }
    }
    Ok(figures)
}

impl Model {
    fn figures(&self, cut: Cut, meshes: usize) -> Result<Vec<Figure>, String> {
        let (mut figures, mut frequencies) = (Vec::new(), Vec::new());
        let named = |mesh: usize, what: &str| {
            format!("resolution_{}_{}{}_{what}", self.name, cut.infix(), MESHES[mesh].0)
        };
        let published = match cut {
            Cut::Straight => self.published,
            Cut::Mirrored => self.mirrored,
        };
        for mesh in 0..meshes {
            let swung = swing(self, cut, mesh)?;
            frequencies.push(swung[0]);
            for (of, (what, unit)) in
                [("frequency", "Hz"), ("depth", "m"), ("height", "m")].into_iter().enumerate()
            {
                let known = published.and_then(|all| all[mesh].get(of).copied());
                figures.push(figure(named(mesh, what), swung[of], unit, known));
            }
            if let Some(known) = self.linear.map(|all| all[cut as usize][mesh]) {
                let names = [("f1", "Hz"), ("f2", "Hz"), ("f3", "Hz"), ("f4", "Hz"), ("longest_step", "ms")];
                let found = linear(self, cut, mesh)?;
                for ((what, unit), (value, known)) in names.into_iter().zip(found.into_iter().zip(known)) {
                    figures.push(figure(named(mesh, what), value, unit, Some(known)));
                }
            }
        }
        let (least, greatest) = frequencies
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, greatest), f| (f.min(least), f.max(greatest)));
        figures.push(Figure {
            higher_is_better: false,
            baseline: self.spread,
            samples: meshes,
            error: 0.0,
            error_of: String::new(),
            ..figure(
                format!("resolution_{}_{}spread", self.name, cut.infix()),
                greatest / least - 1.0,
                "",
                None,
            )
        });
        Ok(figures)
    }
}
