//! Multitudes: steps of a heap with cohesion and friction, and how they grow with the number of balls.

use souple_scene::Measurement;

use super::timing::{Clock, Held, Timed, Timing, as_it_is, median, scene};
use super::{Effort, Figure, value_of};

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

fn timing(settings: &[String], samples: usize) -> Timing<'_> {
    Timing { scene: "cohesive_heap", settings, prepare: as_it_is, warm_up: 1, samples, steps_per_sample: 1 }
}

pub fn balls_100k(name: &str, effort: Effort) -> Result<Vec<Figure>, String> {
    let (settings, on_two, on_others) = (heap(5.2), held(Some(WANTED))?, held(None)?);
    let timed = timing(&settings, effort.choose(3, 10)).run()?;
    let held = |timed: &Timed| if timed.threads == CORES { &on_two } else { &on_others };
    Ok(timed
        .into_iter()
        .map(|timed| {
            let held = held(&timed);
            timed.in_parts(STEPS_PER_PERIOD).steps_per_second(name, held)
        })
        .collect())
}

/// A thousand balls to a million, with all threads.
pub fn scaling(name: &str, effort: Effort) -> Result<Vec<Figure>, String> {
    let radii: &[(&str, f64)] = &[("1k", 1.2), ("10k", 2.45), ("100k", 5.2), ("1m", 11.3)];
    let [held, memory, exponent] = [held(None)?, held(Some(BYTES_OF_BALL))?, held(Some(EXPONENT))?];
    let mut figures = Vec::new();
    let mut points = Vec::new();
    for (count, radius) in &radii[..effort.choose(3, 4)] {
        let settings = heap(*radius);
        let balls = scene("cohesive_heap", &settings)?.bodies[0].mesh.points.len() as f64;
        let timed: Timed = timing(&settings, effort.choose(3, 5)).sample(rayon::current_num_threads())?;
        let timed = timed.in_parts(STEPS_PER_PERIOD);
        let of_ball: Vec<f64> = timed.seconds.iter().map(|seconds| 1e9 * seconds / balls).collect();
        points.push([balls.ln(), (balls * median(of_ball.clone()).0).ln()]);
        let figure = timed.figure(&format!("{name}_{count}"), of_ball, &held, ("ns/ball and step", false));
        let own = timed.bytes as f64 / balls;
        figures.push(figure);
        figures.push(timed.figure(&format!("{name}_{count}_memory"), vec![own], &memory, ("B/ball", false)));
        if let ("1m", slope) = (*count, slope(&points)) {
            figures.push(timed.figure(
                &format!("{name}_exponent"),
                vec![slope],
                &exponent,
                ("of balls", false),
            ));
        }
    }
    Ok(figures)
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
