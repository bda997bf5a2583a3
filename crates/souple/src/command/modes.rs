//! `souple modes`: natural frequencies of a scene about its first state.

use serde_json::{Value, json};

use super::{End, Refusal, print_json, print_line, read_scene};

#[derive(clap::Args)]
// `--near -3` is a wrong frequency, not an argument of that name
#[command(allow_negative_numbers = true)]
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
    if !(arguments.near >= 0.0 && arguments.near.is_finite()) {
        let message = format!("`--near` is {} Hz, which is no frequency", arguments.near);
        return Err(Refusal::request(
            "near",
            arguments.near.to_string(),
            "a finite frequency of at least 0 Hz",
            message,
        ));
    }
    let scene = read_scene(&arguments.scene, &arguments.settings)?;
    let systems = souple_run::natural_frequencies(scene, arguments.count, arguments.near)
        .map_err(|error| Refusal::work("modes", error.to_string()))?;
    if arguments.json {
        let document = systems.iter().map(|found| {
            json!({"system": found.system, "hz": found.hertz, "largest_residual": found.largest_residual})
        });
        print_json(&document.collect::<Value>());
        return Ok(End::Done);
    }
    for found in &systems {
        print_line(format_args!("system {}", found.system));
        for (number, hertz) in found.hertz.iter().enumerate() {
            print_line(format_args!("  {:>3}  {hertz} Hz{}", number + 1, what_holds(*hertz, found.nothing)));
        }
    }
    Ok(End::Done)
}

/// What is said of directions in which no stiffness holds.
fn what_holds(hertz: f64, nothing: f64) -> &'static str {
    if hertz.abs() <= nothing {
        ": no stiffness, nothing holds it there"
    } else if hertz < 0.0 {
        ": negative stiffness, it moves away, as what is pressed does across"
    } else {
        ""
    }
}
