//! How alike one body moves on meshes of several resolutions, by every model: the table of the multiresolution specification (3.4).
//!
//! A cube is glued to a wall and let go. What is told is how often its far corner swings, how deep and how high, on meshes `K_S(2)`, `K_S(3)`,
//! `K_S(4)`; the error is how far that is from the specification's independent program. The spread of a model is the greatest
//! frequency over the least, less one. Models of levels are there with one mesh, and with half of the cube of a mesh twice as fine.

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
        spread: GREEN_SPREAD,
    },
    Model {
        name: "hybrid",
        settings: &[],
        of_mesh: ALIKE,
        published: Some([[4.06, -35.8e-3], [4.13, -36.0e-3], [4.15, -36.1e-3]]),
        spread: Some(0.025),
    },
    Model {
        name: "gauss_voronoi",
        settings: &[r#"bodies.cube.formulation={ name = "gauss_voronoi" }"#],
        of_mesh: ALIKE,
        published: None,
        spread: None,
    },
    Model {
        name: "gauss_median",
        settings: &[r#"bodies.cube.formulation={ name = "gauss_voronoi", dual = "median" }"#],
        of_mesh: ALIKE,
        published: Some([[4.06, -35.8e-3], [4.13, -36.0e-3], [4.15, -36.1e-3]]),
        spread: None,
    },
    Model {
        name: "springs_constant",
        settings: &[
            r#"bodies.cube.formulation={ name = "mass_spring", rule = "constant", coefficient = 350 }"#,
        ],
        of_mesh: ALIKE,
        published: Some([[4.63, -29.0e-3], [5.19, -26.2e-3], [5.29, -22.9e-3]]),
        spread: None,
    },
    Model {
        name: "springs_proportional",
        settings: &[
            r#"bodies.cube.formulation={ name = "mass_spring", rule = "proportional", coefficient = 7000 }"#,
        ],
        of_mesh: ALIKE,
        published: Some([[5.10, -23.9e-3], [4.42, -30.8e-3], [4.04, -36.2e-3]]),
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
        spread: None,
    },
    Model {
        name: "springs_van_gelder",
        settings: &[r#"bodies.cube.formulation={ name = "mass_spring" }"#, SPRINGS],
        of_mesh: ALIKE,
        published: Some([[3.73, -36.4e-3], [3.63, -44.5e-3], [3.54, -46.5e-3]]),
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
        spread: None,
    },
    Model {
        name: "particles_energy",
        settings: &[GRID, r#"bodies.cube.formulation={ name = "particles" }"#, STIFF],
        of_mesh: ALIKE,
        published: None,
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
        spread: None,
    },
    Model {
        name: "levels",
        settings: &[LEVELS_OWN, STAGGERED, GREEN, STIFF, "bodies.cube.levels={ count = 1 }"],
        of_mesh: ALIKE,
        published: Some([[5.19, -19.2e-3], [5.00, -23.2e-3], [4.85, -25.1e-3]]),
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
        spread: None,
    },
];

/// Cells along an edge, and steps in 10 ms.
const MESHES: [(u32, u32); 3] = [(2, 8), (3, 8), (4, 16)];

/// Frequency, lowest and highest point of the corner within 6 s.
fn swing(model: &Model, mesh: usize) -> Result<[f64; 3], String> {
    let (cells, steps) = MESHES[mesh];
    let mut settings = vec![
        format!("bodies.cube.mesh.cells=[{cells}, {cells}, {cells}]"),
        format!("systems.main.steps_per_period={steps}"),
    ];
    settings.extend(model.settings.iter().chain(model.of_mesh[mesh]).map(|setting| (*setting).to_owned()));
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

pub fn table(effort: Effort) -> Result<Vec<Figure>, String> {
    let mut figures = Vec::new();
    let meshes = effort.choose(2, MESHES.len());
    for model in MODELS {
        let mut frequencies = Vec::new();
        for mesh in 0..meshes {
            let swung = swing(model, mesh)?;
            frequencies.push(swung[0]);
            let published = model.published.map(|all| all[mesh]);
            for (of, (what, unit)) in
                [("frequency", "Hz"), ("depth", "m"), ("height", "m")].into_iter().enumerate()
            {
                let value = swung[of];
                let known = published.and_then(|known| known.get(of).copied());
                figures.push(Figure {
                    name: format!("resolution_{}_{}_{what}", model.name, MESHES[mesh].0),
                    value,
                    by_processor: None,
                    unit,
                    higher_is_better: true,
                    error: known.map_or(0.0, |known| (value / known - 1.0).abs()),
                    error_of: known
                        .map_or(String::new(), |_| "the specification's independent program".to_owned()),
                    baseline: known,
                    threads: 1,
                    samples: 1,
                    spread: 0.0,
                    bytes: 0,
                });
            }
        }
        let (least, greatest) = frequencies
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, greatest), f| (f.min(least), f.max(greatest)));
        figures.push(Figure {
            name: format!("resolution_{}_spread", model.name),
            value: greatest / least - 1.0,
            by_processor: None,
            unit: "",
            higher_is_better: false,
            error: 0.0,
            error_of: String::new(),
            baseline: model.spread,
            threads: 1,
            samples: meshes,
            spread: 0.0,
            bytes: 0,
        });
    }
    Ok(figures)
}
