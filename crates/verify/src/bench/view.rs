//! What it costs to show a world in the browser.

use std::time::Duration;

use souple_view::measure::{frame_cost, served};

use super::timing::{median, scene};
use super::{Effort, Figure};

/// A frame of a bar whose surface has 20,800 triangles.
pub fn frame_20k(effort: Effort) -> Result<Vec<Figure>, String> {
    let settings = ["bodies.bar.mesh.cells=[120, 20, 20]", "bodies.bar.mesh.element=\"hex8\""];
    let scene = scene("cantilever_dynamic", &settings.map(str::to_owned))?;
    let cost = frame_cost(scene, effort.choose(50, 500))?;
    let samples = cost.seconds.len();
    let (value, spread) = median(cost.seconds.iter().map(|seconds| 1e3 * seconds).collect());
    Ok(vec![Figure {
        by_processor: None,
        name: "view_frame_20k".to_owned(),
        value,
        unit: "ms",
        higher_is_better: false,
        error: cost.error,
        error_of: format!(
            "positions of {} triangles, in the size of the bar: numbers of four bytes",
            cost.triangles
        ),
        baseline: Some(1.0),
        threads: 1,
        samples,
        spread,
        bytes: cost.bytes,
    }])
}

/// Frames that a client on this machine gets of a ligament whose surface has 20,816 triangles, and how soon it sees what it
/// did.
pub fn rate(effort: Effort) -> Result<Vec<Figure>, String> {
    let settings = [
        "bodies.ligament.mesh.cells=[1300, 2, 2]",
        "bodies.ligament.frames.points={ name = \"voxels\", size = \"5 mm\" }",
    ];
    let scene = scene("ligament", &settings.map(str::to_owned))?;
    let served = served(scene, Duration::from_secs(effort.choose(2, 10)), effort.choose(20, 200))?;
    let samples = served.latencies.len();
    let (latency, spread) = median(served.latencies.iter().map(|seconds| 1e3 * seconds).collect());
    let figure = |name: &str, value: f64, unit: &'static str, higher_is_better: bool, baseline: f64| Figure {
        by_processor: None,
        name: name.to_owned(),
        value,
        unit,
        higher_is_better,
        error: 0.0,
        error_of: "nothing: what is shown is the state".to_owned(),
        baseline: Some(baseline),
        threads: rayon::current_num_threads(),
        samples,
        spread,
        bytes: 0,
    };
    Ok(vec![
        figure("view_rate", served.rate, "frames/s", true, 60.0),
        figure("view_latency", latency, "ms", false, 100.0),
    ])
}

/// Frames a second that a live view is to show of masses and links (2.13 of the networks' specification).
const LIVE: f64 = 25.0;

/// A frame of a lattice of 8,019 masses and links, and how many of them a client on this machine gets while it moves.
pub fn network(effort: Effort) -> Result<Vec<Figure>, String> {
    let settings = ["parameters.count=27".to_owned()];
    let cost = frame_cost(scene("network_lattice", &settings)?, effort.choose(50, 500))?;
    let served = served(
        scene("network_lattice", &settings)?,
        Duration::from_secs(effort.choose(2, 10)),
        effort.choose(5, 20),
    )?;
    let (value, spread) = median(cost.seconds.iter().map(|seconds| 1e3 * seconds).collect());
    let figure = |name: &str, value: f64, unit: &'static str, higher_is_better: bool, baseline: f64| Figure {
        by_processor: None,
        name: name.to_owned(),
        value,
        unit,
        higher_is_better,
        error: cost.error,
        error_of: "positions of masses, in the size of the lattice: numbers of four bytes".to_owned(),
        baseline: Some(baseline),
        threads: rayon::current_num_threads(),
        samples: cost.seconds.len(),
        spread,
        bytes: cost.bytes,
    };
    Ok(vec![
        figure("view_network_frame", value, "ms", false, 1e3 / LIVE),
        figure("view_network_rate", served.rate, "frames/s", true, LIVE),
    ])
}
