//! The one way in which steps are timed.

use std::path::Path;
use std::time::Instant;

use souple_engine::{SnapshotError, World};
use souple_scene::Scene;

use super::Figure;
use crate::scenes;

/// What steps are timed, and how.
pub struct Timing<'a> {
    pub scene: &'a str,
    pub settings: &'a [String],
    /// What is done to the world before the first step.
    pub prepare: fn(&mut World) -> Result<(), SnapshotError>,
    /// Steps before the first sample: what is made once, and what is not of interest.
    pub warm_up: usize,
    pub samples: usize,
    pub steps_per_sample: usize,
}

/// What was timed.
pub struct Timed {
    pub threads: usize,
    /// Of a step, sample by sample [s].
    pub seconds: Vec<f64>,
    pub cells: usize,
    pub bytes: usize,
}

impl Timing<'_> {
    /// Runs with one thread and with all.
    pub fn run(&self) -> Result<Vec<Timed>, String> {
        thread_counts().into_iter().map(|threads| with_threads(threads, || self.sample(threads))?).collect()
    }

    pub fn sample(&self, threads: usize) -> Result<Timed, String> {
        let scene = scene(self.scene, self.settings)?;
        let cells = scene.bodies.iter().map(|body| body.mesh.cell_count()).sum();
        let mut world = scene.model.start(scene.state);
        (self.prepare)(&mut world).map_err(|error| error.to_string())?;
        let mut steps =
            |count: usize| (0..count).try_for_each(|_| world.step().map_err(|error| error.to_string()));
        steps(self.warm_up)?;
        let mut seconds = Vec::with_capacity(self.samples);
        for _ in 0..self.samples {
            let clock = Instant::now();
            steps(self.steps_per_sample)?;
            seconds.push(clock.elapsed().as_secs_f64() / self.steps_per_sample as f64);
        }
        Ok(Timed { threads, seconds, cells, bytes: world.bytes() })
    }
}

pub fn as_it_is(_: &mut World) -> Result<(), SnapshotError> {
    Ok(())
}

/// Bends the bar to a parabola, so that no element is at rest.
pub fn bend(world: &mut World) -> Result<(), SnapshotError> {
    let mut state = world.state().clone();
    for q in &mut state.systems[0].q {
        q.y -= 0.1 * q.x * q.x;
    }
    world.resume(state)
}

/// How wrong a result is, and what another needs for it.
pub struct Held {
    pub error: f64,
    pub error_of: String,
    pub baseline: Option<f64>,
}

impl Timed {
    pub fn elements_per_second(&self, name: &str, held: &Held) -> Figure {
        let rates = self.seconds.iter().map(|seconds| self.cells as f64 / seconds).collect();
        self.figure(name, rates, held, ("elements/s", true))
    }

    /// Of a network, whose cells are its links.
    pub fn links_per_second(&self, name: &str, held: &Held) -> Figure {
        let rates = self.seconds.iter().map(|seconds| self.cells as f64 / seconds).collect();
        self.figure(name, rates, held, ("links/s", true))
    }

    /// Of steps that move so many bytes.
    pub fn gigabytes_per_second(&self, name: &str, bytes: usize, held: &Held) -> Figure {
        let rates = self.seconds.iter().map(|seconds| 1e-9 * bytes as f64 / seconds).collect();
        self.figure(name, rates, held, ("GB/s", true))
    }

    pub fn milliseconds_per_step(&self, name: &str, held: &Held) -> Figure {
        let times = self.seconds.iter().map(|seconds| 1e3 * seconds).collect();
        self.figure(name, times, held, ("ms/step", false))
    }

    pub fn steps_per_second(&self, name: &str, held: &Held) -> Figure {
        let rates = self.seconds.iter().map(|seconds| 1.0 / seconds).collect();
        self.figure(name, rates, held, ("steps/s", true))
    }

    pub fn figure(
        &self,
        name: &str,
        values: Vec<f64>,
        held: &Held,
        (unit, higher_is_better): (&'static str, bool),
    ) -> Figure {
        let (value, spread) = median(values);
        Figure {
            name: format!("{name}_{}t", self.threads),
            value,
            unit,
            higher_is_better,
            error: held.error,
            error_of: held.error_of.clone(),
            baseline: held.baseline,
            threads: self.threads,
            samples: self.seconds.len(),
            spread,
            bytes: self.bytes,
        }
    }
}

pub fn scene(name: &str, settings: &[String]) -> Result<Scene, String> {
    let text = scenes::text(name).ok_or_else(|| format!("there is no scene `{name}`"))?;
    souple_scene::read_text(name, text, Path::new("."), settings)
        .map_err(|diagnostics| diagnostics.to_string())
}

/// Threads to measure with: one, and all that the process may use.
pub fn thread_counts() -> Vec<usize> {
    let all = rayon::current_num_threads();
    if all > 1 { vec![1, all] } else { vec![1] }
}

pub fn with_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> Result<T, String> {
    let pool =
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(|error| error.to_string())?;
    Ok(pool.install(work))
}

/// Median and half the interquartile distance over it.
pub fn median(mut samples: Vec<f64>) -> (f64, f64) {
    samples.sort_by(f64::total_cmp);
    let at = |fraction: f64| samples[((samples.len() - 1) as f64 * fraction).round() as usize];
    (at(0.5), 0.5 * (at(0.75) - at(0.25)) / at(0.5))
}
