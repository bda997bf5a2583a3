//! Multitudes: steps of a heap with cohesion and friction, and how they grow with the number of balls.

use std::path::Path;
use std::process::Command;

use serde_json::Value;
use souple_engine::World;
use souple_scene::{Measurement, Scene};

use super::timing::{Clock, Held, Timed, Timing, as_it_is, scene, thread_counts, with_threads};
use super::{Effort, Figure, value_of};
use crate::scenes;

/// The scene of a heap with cohesion and friction.
const HEAP: &str = "cohesive_heap";

/// Steps in a period of the world.
const STEPS_PER_PERIOD: usize = 10;

/// Steps/s that are wanted of 100,000 balls, on two cores.
const WANTED: f64 = 60.0;
const CORES: usize = 2;

/// Bytes that a ball may take of memory: a gigabyte for a million of them.
const BYTES_OF_BALL: f64 = 1000.0;

/// Of the time of a step by the number of balls: linear, and a twentieth for caches that no longer hold them.
const EXPONENT: f64 = 1.05;

/// `0.5 exp(-π h/√(1 - h²))` of a collision with a damping ratio of 0.1 [m/s].
const REBOUND: f64 = 0.364_623_807_143_835_47;

/// A heap whose cone is as wide [m]: about 730 balls for each cubic metre of it.
fn heap(radius: f64) -> Vec<String> {
    vec![format!("parameters.radius={radius}")]
}

fn held(baseline: Option<f64>) -> Result<Held, String> {
    let rebound = value_of(scene("network_collision", &[])?, 600, "speed", 0)?;
    let error_of = "the speed after a collision of two such balls".to_owned();
    Ok(Held { error: (rebound / REBOUND - 1.0).abs(), error_of, baseline })
}

pub fn balls_100k(name: &str, effort: Effort) -> Result<Vec<Figure>, String> {
    let (settings, on_two, on_others) = (heap(5.2), held(Some(WANTED))?, held(None)?);
    let timing = Timing {
        scene: HEAP,
        settings: &settings,
        prepare: as_it_is,
        warm_up: 1,
        samples: effort.choose(3, 10),
        steps_per_sample: 1,
    };
    let mut counts = thread_counts();
    if counts.iter().any(|count| *count > CORES) {
        counts.insert(1, CORES);
    }
    let of = |threads: usize| {
        let timed = with_threads(threads, || timing.sample(threads))??;
        let held = if threads == CORES { &on_two } else { &on_others };
        Ok(timed.in_parts(STEPS_PER_PERIOD).steps_per_second(name, held))
    };
    counts.into_iter().map(of).collect()
}

/// Numbers of balls, about, with the radius of the cone that holds them [m].
const RADII: [(&str, f64); 4] = [("1k", 1.2), ("10k", 2.45), ("100k", 5.2), ("1m", MILLION)];

/// Of the cone that holds a million balls [m].
const MILLION: f64 = 11.3;

/// A thousand balls to a million, with one thread and with all: steps and pairs in a second, and how their time grows.
pub fn scaling(name: &str, effort: Effort) -> Result<Vec<Figure>, String> {
    let [told, memory, exponent] = [held(None)?, held(Some(BYTES_OF_BALL))?, held(Some(EXPONENT))?];
    let mut figures = Vec::new();
    // of each number of threads the logarithms of balls and of the time of a step
    let mut points: Vec<(Timed, Vec<[f64; 2]>)> = Vec::new();
    // the same of one thread by pairs, of which few balls have fewer each
    let mut by_pairs: Vec<[f64; 2]> = Vec::new();
    for (count, radius) in RADII {
        let Scene { model, state, probes, bodies, .. } = scene(HEAP, &heap(radius))?;
        let balls = bodies[0].mesh.points.len() as f64;
        let probe = probes.iter().find(|probe| probe.name == "pairs").ok_or("there is no probe `pairs`")?;
        let mut world = model.start(state);
        world.step().map_err(|error| error.to_string())?;
        let Measurement::Number(pairs) = probe.measure(&mut world) else {
            return Err("pairs are no number".to_owned());
        };
        for (run, threads) in thread_counts().into_iter().enumerate() {
            let timed = with_threads(threads, || steps(&mut world, threads, effort.choose(2, 5)))??;
            let timed = timed.in_parts(STEPS_PER_PERIOD);
            let name = format!("{name}_{count}");
            let of_pairs = |seconds: f64| pairs / seconds;
            let of_ball = |seconds: f64| 1e9 * seconds / balls;
            let of_pair = |seconds: f64| 1e9 * seconds / pairs;
            figures.push(timed.steps_per_second(&name, &told));
            figures.push(timed.of_seconds(&format!("{name}_pairs"), of_pairs, &told, ("pairs/s", true)));
            let in_step = ("ns/ball and step", false);
            figures.push(timed.of_seconds(&format!("{name}_ball"), of_ball, &told, in_step));
            if threads == 1 {
                let in_step = ("ns/pair and step", false);
                figures.push(timed.of_seconds(&format!("{name}_pair"), of_pair, &told, in_step));
                by_pairs.push([pairs.ln(), timed.seconds_of_step().ln()]);
            }
            let point = [balls.ln(), timed.seconds_of_step().ln()];
            match points.get_mut(run) {
                Some((last, of_run)) => {
                    of_run.push(point);
                    *last = timed;
                }
                None => points.push((timed, vec![point])),
            }
        }
        if let Some((timed, _)) = points.last() {
            let own = vec![timed.bytes as f64 / balls];
            figures.push(timed.figure(&format!("{name}_{count}_memory"), own, &memory, ("B/ball", false)));
        }
    }
    // few balls have fewer neighbours each, and keep many threads waiting: what all do is held
    let all = points.len() - 1;
    for (run, (timed, of_run)) in points.iter().enumerate() {
        let (grows, held) = (vec![slope(of_run)], if run == all { &exponent } else { &told });
        figures.push(timed.figure(&format!("{name}_exponent"), grows, held, ("of balls", false)));
        if timed.threads == 1 {
            let grows = vec![slope(&by_pairs)];
            let of_pairs = ("of pairs", false);
            figures.push(timed.figure(&format!("{name}_pairs_exponent"), grows, &exponent, of_pairs));
        }
    }
    Ok(figures)
}

/// Periods of a world that others may have stepped before.
fn steps(world: &mut World, threads: usize, samples: usize) -> Result<Timed, String> {
    let (mut seconds, mut processor) = (Vec::new(), Vec::new());
    for _ in 0..samples {
        let clock = Clock::start();
        world.step().map_err(|error| error.to_string())?;
        clock.stop(&mut seconds, &mut processor, 1);
    }
    // several threads work for one clock
    let processor = if threads == 1 { processor } else { Vec::new() };
    Ok(Timed { threads, seconds, processor, cells: 0, bytes: world.bytes() })
}

/// Most memory that the program may hold for a run of a million balls, with its frames and its picture [MB].
const PEAK: f64 = 1000.0;

/// What `souple run` holds at its peak, as it tells itself: a process of its own, so that nothing else is in it.
pub fn peak(name: &str, effort: Effort) -> Result<Vec<Figure>, String> {
    let fault = |error: std::io::Error| error.to_string();
    let folder = std::env::temp_dir().join(format!("souple_{name}_{}", std::process::id()));
    std::fs::create_dir_all(&folder).map_err(fault)?;
    let told = report_of_million(&folder, effort.choose(2, 30));
    std::fs::remove_dir_all(&folder).map_err(fault)?;
    let report = told?;
    let bytes = |key: &str| report[key].as_f64().ok_or("this system does not tell what a process holds");
    let figure = |name: String, bytes: f64, baseline: Option<f64>| Figure {
        name,
        value: 1e-6 * bytes,
        by_processor: None,
        unit: "MB",
        higher_is_better: false,
        error: 0.0,
        error_of: String::new(),
        baseline,
        threads: rayon::current_num_threads(),
        samples: 1,
        spread: 0.0,
        bytes: bytes as usize,
    };
    Ok(vec![
        figure(name.to_owned(), bytes("peak_bytes")?, Some(PEAK)),
        // of that the state, forces, and the work of steps
        figure(format!("{name}_world"), bytes("solver_bytes")?, None),
    ])
}

/// The report of a run of so many periods, with frames, tables and picture in a folder.
fn report_of_million(folder: &Path, periods: usize) -> Result<Value, String> {
    let fault = |error: std::io::Error| error.to_string();
    let text = scenes::text(HEAP).ok_or_else(|| format!("there is no scene `{HEAP}`"))?;
    let scene = folder.join("scene.toml");
    std::fs::write(&scene, text).map_err(fault)?;
    let program = std::env::current_exe().map_err(fault)?;
    let mut command = Command::new(&program);
    command.arg("run").arg(&scene).arg("--out").arg(folder.join("out"));
    heap(MILLION).iter().for_each(|setting| {
        command.args(["--set", setting]);
    });
    command.args(["--steps", &periods.to_string(), "--frames", "2", "--quiet", "--json"]);
    command.args(["--threads", &rayon::current_num_threads().to_string()]);
    let output = command.output().map_err(fault)?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        return Err(format!("`{} run` of a million balls failed: {said}", program.display()));
    }
    serde_json::from_slice(&output.stdout).map_err(|error| error.to_string())
}

/// How long contours of five hundred balls may take to be shown 25 times in a second [ms].
const SHOWN: f64 = 40.0;

/// How far the two contours may be apart, of the diameter of the balls.
const APART: f64 = 0.2;

/// Both contours of about five hundred balls, and how far they are apart, beside a step.
pub fn contours(name: &str, effort: Effort) -> Result<Vec<Figure>, String> {
    let many = r#"networks.block.masses.balls.fill={ shape = { name = "capsule", from = [-9, 0, 0], to = [9, 0, 1], radius = 9 }, spacing = 1, box = [[-20, 0, -10], [20, 0, 11]] }"#;
    let settings = [many.to_owned()];
    let sample = || -> Result<(Timed, f64), String> {
        let scene = scene("two_contours", &settings)?;
        let probe =
            scene.probes.into_iter().find(|probe| probe.name == "apart").ok_or("there is no probe")?;
        let cells = scene.bodies[0].mesh.points.len();
        let mut world = scene.model.start(scene.state);
        let (mut seconds, mut processor, mut apart) = (Vec::new(), Vec::new(), 0.0);
        for _ in 0..effort.choose(3, 10) {
            let clock = Clock::start();
            world.step().map_err(|error| error.to_string())?;
            let Measurement::Number(measured) = probe.measure(&mut world) else {
                return Err("no number".to_owned());
            };
            clock.stop(&mut seconds, &mut processor, 1);
            apart = measured;
        }
        Ok((Timed { threads: 1, seconds, processor, cells, bytes: world.bytes() }, apart))
    };
    let (timed, apart) = super::timing::with_threads(1, sample)??;
    let error_of = format!("how far the contours are apart [m], {APART} at most");
    Ok(vec![timed.milliseconds_per_step(name, &Held { error: apart, error_of, baseline: Some(SHOWN) })])
}

/// Of the straight line through points, by least squares.
fn slope(points: &[[f64; 2]]) -> f64 {
    let count = points.len() as f64;
    let [x, y] = [0, 1].map(|axis: usize| points.iter().map(|point| point[axis]).sum::<f64>() / count);
    let above: f64 = points.iter().map(|point| (point[0] - x) * (point[1] - y)).sum();
    above / points.iter().map(|point| (point[0] - x).powi(2)).sum::<f64>()
}
