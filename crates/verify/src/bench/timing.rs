//! The one way in which steps are timed.

use std::hint::black_box;
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
#[derive(Clone)]
pub struct Timed {
    pub threads: usize,
    /// Of a step, sample by sample [s].
    pub seconds: Vec<f64>,
    /// The same by time of the processor, of one thread where the system tells; else empty.
    pub processor: Vec<f64>,
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
        let (mut seconds, mut processor) = (Vec::with_capacity(self.samples), Vec::new());
        for _ in 0..self.samples {
            let clock = Clock::start();
            steps(self.steps_per_sample)?;
            clock.stop(&mut seconds, &mut processor, self.steps_per_sample);
        }
        // several threads work for one clock
        let processor = if threads == 1 { processor } else { Vec::new() };
        Ok(Timed { threads, seconds, processor, cells, bytes: world.bytes() })
    }
}

/// Time that passes, and time that this thread has a processor: where others work on the machine too, what the work itself
/// takes.
pub struct Clock {
    start: Instant,
    on_processor: Option<f64>,
}

impl Clock {
    pub fn start() -> Self {
        let on_processor = seconds_on_processor();
        Self { start: Instant::now(), on_processor }
    }

    /// What the work took of the processor since the start, or the time that has passed where the system does not tell.
    pub fn seconds(&self) -> f64 {
        let passed = self.start.elapsed().as_secs_f64();
        self.on_processor.zip(seconds_on_processor()).map_or(passed, |(start, end)| end - start)
    }

    /// Adds what each of `count` pieces of work took.
    pub fn stop(self, seconds: &mut Vec<f64>, processor: &mut Vec<f64>, count: usize) {
        seconds.push(self.start.elapsed().as_secs_f64() / count as f64);
        if let (Some(start), Some(end)) = (self.on_processor, seconds_on_processor()) {
            processor.push((end - start) / count as f64);
        }
    }
}

/// Of this thread so far; `None` where the system does not tell.
#[cfg(unix)]
fn seconds_on_processor() -> Option<f64> {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Some(time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64)
}

#[cfg(not(unix))]
fn seconds_on_processor() -> Option<f64> {
    None
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

/// What `a = b + s c` over arrays far larger than the caches moves [GB/s].
pub struct Triad {
    by_clock: f64,
    /// By the time that this thread has a processor, where the system tells.
    by_processor: Option<f64>,
}

impl Triad {
    /// The fastest of several, with the threads at hand.
    pub fn measured() -> Self {
        use rayon::prelude::*;
        const LENGTH: usize = 8 << 20;
        // read, read, write, and what is written is fetched first
        const MOVED: f64 = 4.0 * 8.0 * LENGTH as f64;
        let (b, c) = (vec![1.0_f64; LENGTH], vec![2.0_f64; LENGTH]);
        let mut a = vec![0.0_f64; LENGTH];
        let chunk = LENGTH.div_ceil(rayon::current_num_threads());
        let (mut seconds, mut processor) = (Vec::new(), Vec::new());
        for _ in 0..5 {
            let clock = Clock::start();
            a.par_chunks_mut(chunk).zip(b.par_chunks(chunk)).zip(c.par_chunks(chunk)).for_each(
                |((a, b), c)| {
                    for ((a, b), c) in a.iter_mut().zip(b).zip(c) {
                        *a = *b + 3.0 * *c;
                    }
                },
            );
            clock.stop(&mut seconds, &mut processor, 1);
            black_box(&mut a);
        }
        let fastest = |samples: &[f64]| {
            let least = samples.iter().copied().reduce(f64::min)?;
            Some(1e-9 * MOVED / least)
        };
        Self { by_clock: fastest(&seconds).unwrap_or(f64::NAN), by_processor: fastest(&processor) }
    }
}

/// How wrong a result is, and what another needs for it.
pub struct Held {
    pub error: f64,
    pub error_of: String,
    pub baseline: Option<f64>,
}

impl Timed {
    pub fn elements_per_second(&self, name: &str, held: &Held) -> Figure {
        self.of_seconds(name, |seconds| self.cells as f64 / seconds, held, ("elements/s", true))
    }

    /// Of a network, whose cells are its links.
    pub fn links_per_second(&self, name: &str, held: &Held) -> Figure {
        self.of_seconds(name, |seconds| self.cells as f64 / seconds, held, ("links/s", true))
    }

    /// Of steps that move so many bytes.
    pub fn gigabytes_per_second(&self, name: &str, bytes: usize, held: &Held) -> Figure {
        self.of_seconds(name, |seconds| 1e-9 * bytes as f64 / seconds, held, ("GB/s", true))
    }

    /// The same as a part of what a triad moves.
    pub fn share_of_triad(&self, name: &str, bytes: usize, triad: &Triad, held: &Held) -> Figure {
        let moved = |seconds: f64| 1e-9 * bytes as f64 / seconds;
        let shares = self.seconds.iter().map(|seconds| moved(*seconds) / triad.by_clock).collect();
        let by_processor = mean(&self.processor).zip(triad.by_processor);
        Figure {
            by_processor: by_processor.map(|(seconds, whole)| moved(seconds) / whole),
            ..self.figure(name, shares, held, ("of a triad's GB/s", true))
        }
    }

    /// Of steps that simulate so much each [s].
    pub fn times_real_time(&self, name: &str, timestep: f64, held: &Held) -> Figure {
        self.of_seconds(name, |seconds| timestep / seconds, held, ("x real time", true))
    }

    pub fn microseconds_per_step(&self, name: &str, held: &Held) -> Figure {
        self.of_seconds(name, |seconds| 1e6 * seconds, held, ("us/step", false))
    }

    pub fn milliseconds_per_step(&self, name: &str, held: &Held) -> Figure {
        self.of_seconds(name, |seconds| 1e3 * seconds, held, ("ms/step", false))
    }

    pub fn steps_per_second(&self, name: &str, held: &Held) -> Figure {
        self.of_seconds(name, |seconds| 1.0 / seconds, held, ("steps/s", true))
    }

    /// Of a step by the time of the processor, where one thread has worked and the system tells, or as it passed [s].
    pub fn seconds_of_step(&self) -> f64 {
        mean(&self.processor).unwrap_or_else(|| median(self.seconds.clone()).0)
    }

    /// A number of the seconds of a step.
    pub fn of_seconds(
        &self,
        name: &str,
        value: impl Fn(f64) -> f64,
        held: &Held,
        unit: (&'static str, bool),
    ) -> Figure {
        let values = self.seconds.iter().map(|seconds| value(*seconds)).collect();
        let by_processor = mean(&self.processor).map(value);
        Figure { by_processor, ..self.figure(name, values, held, unit) }
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
            by_processor: None,
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

    /// Of one of `count` equal parts of a step.
    pub fn in_parts(self, count: usize) -> Self {
        let part = |seconds: &Vec<f64>| seconds.iter().map(|seconds| seconds / count as f64).collect();
        Self { seconds: part(&self.seconds), processor: part(&self.processor), ..self }
    }

    /// How many times as fast as `slow`, by medians.
    pub fn times_as_fast(&self, name: &str, slow: &Self, held: &Held) -> Figure {
        let (of_slow, _) = median(slow.seconds.clone());
        let ratios = self.seconds.iter().map(|seconds| of_slow / seconds).collect();
        let by_processor = over(&slow.processor, &self.processor);
        Figure { by_processor, ..self.figure(name, ratios, held, ("x as fast", true)) }
    }
}

/// What a scene takes under each of several settings, from its beginning, on one thread; in turn, so that what else the machine does
/// meets all of them alike.
pub fn in_turn(
    scene: &str,
    variants: &[Vec<String>],
    periods: usize,
    rounds: usize,
) -> Result<Vec<Timed>, String> {
    let mut timed: Vec<Timed> = Vec::new();
    for _ in 0..rounds {
        for (number, settings) in variants.iter().enumerate() {
            let timing = Timing {
                scene,
                settings,
                prepare: as_it_is,
                warm_up: 0,
                samples: 1,
                steps_per_sample: periods,
            };
            let again = with_threads(1, || timing.sample(1))??;
            match timed.get_mut(number) {
                Some(so_far) => {
                    so_far.seconds.extend(again.seconds);
                    so_far.processor.extend(again.processor);
                }
                None => timed.push(again),
            }
        }
    }
    Ok(timed)
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

/// `None` where nothing was measured.
fn mean(samples: &[f64]) -> Option<f64> {
    let sum: f64 = samples.iter().sum();
    (sum > 0.0).then(|| sum / samples.len() as f64)
}

/// The mean of one over that of the other, where both are known.
pub fn over(above: &[f64], below: &[f64]) -> Option<f64> {
    Some(mean(above)? / mean(below)?)
}

/// Median and half the interquartile distance over it.
pub fn median(mut samples: Vec<f64>) -> (f64, f64) {
    samples.sort_by(f64::total_cmp);
    let at = |fraction: f64| samples[((samples.len() - 1) as f64 * fraction).round() as usize];
    (at(0.5), 0.5 * (at(0.75) - at(0.25)) / at(0.5))
}
