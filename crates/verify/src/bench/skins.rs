//! What skins cost: a step by resolution, and the surface of many particles beside that of another program.

use std::f64::consts::PI;
use std::io::Write;
use std::process::{Command, Stdio};
use std::time::Instant;

use serde_json::Value;
use souple_math::Vec3;
use souple_skin::dress;

use super::timing::{Held, Timed, Timing, as_it_is, median, scene, with_threads};
use super::{Effort, Figure};

/// Of the scene `skin_ball`: where it starts and what it is drawn to [m], attraction [m/s], tension [m²/s], period [s].
const START: f64 = 0.95;
const RADIUS: f64 = 0.85;
const ATTRACTION: f64 = 0.5;
const TENSION: f64 = 5e-4;
const PERIOD: f64 = 0.01;

fn settings(cells: u32) -> Vec<String> {
    vec![format!("skins.ball.voxel={}", 2.0 / f64::from(cells))]
}

/// The radius of the ball at a time, by an equation of one number.
fn radius_at(time: f64) -> f64 {
    // dR/dt = α (G(R) − ½) − 2 β/R,  G = (1 − c u²)³ with G(1) = ½
    let c = 1.0 - 0.5_f64.cbrt();
    let speed = |r: f64| {
        let u = r / RADIUS;
        ATTRACTION * ((1.0 - c * u * u).max(0.0).powi(3) - 0.5) - 2.0 * TENSION / r
    };
    let steps = 1000;
    let h = time / f64::from(steps);
    (0..steps).fold(START, |r, _| r + h * speed(r + 0.5 * h * speed(r)))
}

/// How far the ball of so many cells is from the radius it must have, in voxels.
fn error_of(cells: u32, steps: u64) -> Result<f64, String> {
    let volume = super::value_of(scene("skin_ball", &settings(cells))?, steps, "volume", 0)?;
    let radius = (0.75 * volume / PI).cbrt();
    Ok((radius - radius_at(steps as f64 * PERIOD)).abs() * f64::from(cells) / 2.0)
}

fn stepped(cells: u32, threads: usize, warm_up: usize, samples: usize) -> Result<Timed, String> {
    let timing = Timing {
        scene: "skin_ball",
        settings: &settings(cells),
        prepare: as_it_is,
        warm_up,
        samples,
        steps_per_sample: 1,
    };
    with_threads(threads, || timing.sample(threads))?
}

/// Steps of a ball that fills 128³ cells.
pub fn step_128(effort: Effort) -> Result<Vec<Figure>, String> {
    let held = Held {
        error: error_of(128, effort.choose(50, 200))?,
        error_of: "the ball's radius in voxels, against the equation of its radius".to_owned(),
        baseline: Some(60.0),
    };
    let figures = super::timing::thread_counts().into_iter().map(|threads| {
        let timed = stepped(128, threads, 5, effort.choose(20, 200))?;
        Ok(timed.steps_per_second("skin_step_128", &held))
    });
    figures.collect()
}

/// Milliseconds of a step by resolution, and the exponent that they grow with.
pub fn cost(effort: Effort) -> Result<Vec<Figure>, String> {
    let sizes: &[u32] = effort.choose(&[64, 128, 256], &[64, 128, 256, 512]);
    let mut figures = Vec::new();
    let mut points = Vec::new();
    for cells in sizes {
        let timed = stepped(*cells, 1, 3, effort.choose(5, 15))?;
        let held = Held { error: 0.0, error_of: String::new(), baseline: None };
        let figure = timed.milliseconds_per_step(&format!("skin_cost_{cells}"), &held);
        points.push((f64::from(*cells).ln(), figure.value.ln()));
        figures.push(figure);
    }
    let (exponent, residual) = slope(&points);
    figures.push(Figure {
        by_processor: None,
        name: "skin_cost_exponent".to_owned(),
        value: exponent,
        unit: "of the cells along an edge",
        higher_is_better: false,
        error: residual,
        error_of: "the greatest residual of the fitted line, in natural logarithms".to_owned(),
        baseline: Some(2.0),
        threads: 1,
        samples: points.len(),
        spread: 0.0,
        bytes: figures.last().map_or(0, |figure| figure.bytes),
    });
    Ok(figures)
}

/// Seconds for each of the 25 images of a metamorphosis on 50³ cells, with what is four steps apart.
pub fn image(effort: Effort) -> Result<Vec<Figure>, String> {
    let timing = Timing {
        scene: "skin_untwists",
        settings: &[],
        prepare: as_it_is,
        warm_up: 0,
        samples: effort.choose(5, 25),
        steps_per_sample: 4,
    };
    let timed = with_threads(1, || timing.sample(1))??;
    let held = Held {
        error: super::value_of(scene("skin_untwists", &[])?, 100, "distance", 0)?,
        error_of: "the skin's distance from its target at last [m]".to_owned(),
        baseline: Some(1.0),
    };
    let seconds = timed.seconds.iter().map(|seconds| 4.0 * seconds).collect();
    Ok(vec![timed.figure("skin_image", seconds, &held, ("s/image", false))])
}

/// The slope of a line through points by least squares, and the greatest distance from it.
fn slope(points: &[(f64, f64)]) -> (f64, f64) {
    let count = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let (mut covariance, mut variance) = (0.0, 0.0);
    for point in points {
        covariance += (point.0 - x) * (point.1 - y);
        variance += (point.0 - x) * (point.0 - x);
    }
    let slope = covariance / variance;
    let residual = points.iter().map(|p| (p.1 - y - slope * (p.0 - x)).abs()).fold(0.0, f64::max);
    (slope, residual)
}

/// Radius of the particles [m]; they are twice as far from each other.
const PARTICLE: f64 = 0.01;
const PARTICLES: usize = 100_000;

/// The particles of a ball: those of a cubic lattice that are nearest to its centre.
fn ball() -> Vec<(Vec3, f64)> {
    // 3 % more than the ball's radius by volume, in spacings
    let reach = (1.03 * (0.75 * PARTICLES as f64 / PI).cbrt()).ceil() as i32;
    let side = || -reach..=reach;
    let mut places: Vec<[i32; 3]> =
        side().flat_map(|z| side().flat_map(move |y| side().map(move |x| [x, y, z]))).collect();
    places.sort_by_key(|place| (place.iter().map(|c| c * c).sum::<i32>(), *place));
    let particle = |place: &[i32; 3]| (Vec3::from_array(place.map(f64::from)) * (2.0 * PARTICLE), PARTICLE);
    places.iter().take(PARTICLES).map(particle).collect()
}

/// What another program took for the same.
struct Peer {
    version: String,
    /// The least, one by one.
    seconds: Vec<f64>,
    volume: f64,
}

/// Dresses the particles of a ball at voxels of so many radii, beside `pysplashsurf` where Python has it.
pub fn dress_100k(name: &str, voxel_in_radii: f64, effort: Effort) -> Result<Vec<Figure>, String> {
    let particles = ball();
    let voxel = voxel_in_radii * PARTICLE;
    let times = effort.choose(2, 9);
    let peer = match peer(&particles, voxel, times) {
        Ok(peer) => Some(peer),
        Err(why) => {
            eprintln!("{name} stands alone: {why}");
            None
        }
    };
    let (mut seconds, mut volume) = (Vec::new(), 0.0);
    for _ in 0..times {
        let clock = Instant::now();
        let dressed = with_threads(1, || dress(&particles, voxel, 0.5))?;
        seconds.push(clock.elapsed().as_secs_f64());
        let surface = dressed.map_err(|error| error.to_string())?.surface;
        volume = souple_skin::polygons::area_and_volume(&surface.points, &surface.triangles).1;
    }
    let exact = PARTICLES as f64 * (2.0 * PARTICLE).powi(3);
    let rate = |seconds: &[f64]| {
        let rates = seconds.iter().map(|seconds| PARTICLES as f64 / seconds).collect();
        median(rates)
    };
    let figure = |name: String, (value, spread): (f64, f64), unit, volume: f64, baseline| Figure {
        by_processor: None,
        name,
        value,
        unit,
        higher_is_better: true,
        error: (volume / exact - 1.0).abs(),
        error_of: "volume, against that of the particles".to_owned(),
        baseline,
        threads: 1,
        samples: times,
        spread,
        bytes: 0,
    };
    let ours = rate(&seconds);
    let theirs = peer.as_ref().map(|peer| rate(&peer.seconds));
    let mut figures =
        vec![figure(name.to_owned(), ours, "particles/s", volume, theirs.map(|(value, _)| value))];
    if let (Some(peer), Some(theirs)) = (&peer, theirs) {
        let their_name = format!("{name}_pysplashsurf_{}", peer.version);
        figures.push(figure(their_name, theirs, "particles/s", peer.volume, None));
        let ratio = (ours.0 / theirs.0, ours.1 + theirs.1);
        figures.push(figure(format!("{name}_ratio"), ratio, "ours / pysplashsurf", volume, Some(1.0)));
    }
    Ok(figures)
}

/// The same particles by `pysplashsurf`, with the Python that `SOUPLE_PYTHON` names, or `python3`.
fn peer(particles: &[(Vec3, f64)], voxel: f64, times: usize) -> Result<Peer, String> {
    let python = std::env::var("SOUPLE_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let file = std::env::temp_dir().join(format!("souple-bench-{}.f32", std::process::id()));
    let bytes: Vec<u8> = particles
        .iter()
        .flat_map(|(position, _)| position.to_array())
        .flat_map(|c| (c as f32).to_le_bytes())
        .collect();
    std::fs::write(&file, bytes).map_err(|error| format!("{}: {error}", file.display()))?;
    let output = run_script(
        &python,
        &[&file.display().to_string(), &PARTICLE.to_string(), &voxel.to_string(), &times.to_string()],
    );
    // what is left behind in the folder of temporary files is no reason to fail
    let _ = std::fs::remove_file(&file);
    let document: Value = serde_json::from_slice(&output?).map_err(|error| error.to_string())?;
    let seconds = document["seconds"].as_array().into_iter().flatten().filter_map(Value::as_f64).collect();
    Ok(Peer {
        version: document["version"].as_str().unwrap_or_default().to_owned(),
        seconds,
        volume: document["volume"].as_f64().unwrap_or(f64::NAN),
    })
}

fn run_script(python: &str, arguments: &[&str]) -> Result<Vec<u8>, String> {
    let cannot = |error: std::io::Error| format!("`{python}` cannot be run: {error}");
    let mut child = Command::new(python)
        .arg("-")
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(cannot)?;
    if let Some(mut input) = child.stdin.take() {
        input.write_all(include_bytes!("pysplashsurf.py")).map_err(cannot)?;
    }
    let output = child.wait_with_output().map_err(cannot)?;
    if output.status.success() {
        return Ok(output.stdout);
    }
    let said = String::from_utf8_lossy(&output.stderr);
    Err(format!("`{python}`: {}", said.lines().last().unwrap_or("it failed")))
}
