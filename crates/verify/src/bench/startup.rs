//! How soon the program answers.

use std::time::Instant;

use super::timing::median;
use super::{Effort, Figure};

pub fn startup(effort: Effort) -> Result<Vec<Figure>, String> {
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
        by_processor: None,
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
