//! `souple modes`: natural frequencies of a scene about its first state.

use serde_json::{Value, json};
use souple_solve::modes::Settings;

use super::{End, Refusal, print_json, print_line, read_scene};

#[derive(clap::Args)]
pub struct Arguments {
    /// Scene file, or a folder with a scene.toml
    scene: String,
    /// How many modes of each system
    #[arg(long, default_value_t = 10)]
    count: usize,
    /// Frequencies nearest to this one are found [Hz]; bodies that are free to move need one that is not zero
    #[arg(long, default_value_t = 0.0)]
    near: f64,
    /// Changes a value of the scene; may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    settings: Vec<String>,
    #[arg(long)]
    pub json: bool,
}

/// Most modes asked for at a time: beyond, the subspace no longer pays.
const MOST_MODES: usize = 200;

pub fn modes(arguments: &Arguments) -> Result<End, Refusal> {
    if !(1..=MOST_MODES).contains(&arguments.count) {
        let message = format!("{} modes cannot be asked for at once", arguments.count);
        return Err(Refusal::request(
            "count",
            arguments.count.to_string(),
            format!("1 to {MOST_MODES}"),
            message,
        ));
    }
    if !arguments.near.is_finite() {
        let message = format!("a frequency of {} Hz is none", arguments.near);
        return Err(Refusal::request(
            "near",
            arguments.near.to_string(),
            "a finite frequency in Hz",
            message,
        ));
    }
    let scene = read_scene(&arguments.scene, &arguments.settings)?;
    let mut world = scene.model.start(scene.state);
    let angular = std::f64::consts::TAU * arguments.near;
    let settings = Settings { count: arguments.count, shift: angular * angular, ..Settings::default() };
    let mut systems = Vec::new();
    for index in 0..world.model().systems.len() {
        let (name, found) = world.with_system(index, |system, state, around, ws| {
            (system.name.clone(), souple_engine::modes::lowest(system, state, around, ws, &settings))
        });
        let modes = found.map_err(|error| Refusal::work("modes", format!("system `{name}`: {error}")))?;
        // a frequency of an unstable direction, ω² < 0, is printed as negative
        let hertz = |eigenvalue: &f64| eigenvalue.abs().sqrt().copysign(*eigenvalue) / std::f64::consts::TAU;
        let mut frequencies: Vec<f64> = modes.eigenvalues.iter().map(hertz).collect();
        frequencies.sort_by(f64::total_cmp);
        let worst = modes.residuals.iter().copied().fold(0.0, f64::max);
        systems.push(json!({"system": name, "hz": frequencies, "largest_residual": worst}));
    }
    if arguments.json {
        print_json(&Value::Array(systems));
        return Ok(End::Done);
    }
    for system in &systems {
        print_line(format_args!("system {}", system["system"].as_str().unwrap_or_default()));
        for (number, hertz) in system["hz"].as_array().into_iter().flatten().enumerate() {
            print_line(format_args!("  {:>3}  {hertz} Hz", number + 1));
        }
    }
    Ok(End::Done)
}
