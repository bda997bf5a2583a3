//! The runs of a study, several at once.

use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;

use rayon::prelude::*;
use souple_engine::Interruption;
use souple_run::{Control, Options, Outcome, Status};
use souple_scene::Scene;

use crate::SweepError;
use crate::database::{Database, is_kept};
use crate::graphs;
use crate::study::Study;

/// How many runs at once, with how many threads each: results do not depend on either, times do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Workers {
    pub count: usize,
    pub threads: usize,
    /// Whether runs that the file holds are made again.
    pub again: bool,
}

/// How a study stands.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    pub done: usize,
    pub runs: usize,
}

/// What became of the runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Summary {
    /// Made now.
    pub made: usize,
    /// In the file before.
    pub held: usize,
    /// Of those made or held, how many failed.
    pub failed: usize,
    pub interrupted: usize,
    /// Held ones that another program made.
    pub of_others: usize,
}

impl Summary {
    /// Counts a run that ended so; whether it is kept.
    fn count(&mut self, status: Status) -> bool {
        let is_kept = is_kept(status);
        self.made += usize::from(is_kept);
        self.interrupted += usize::from(!is_kept);
        self.failed += usize::from(status == Status::Failed);
        is_kept
    }
}

/// The fingerprint of the scene of each run, by which the file of results knows it. All scenes are read, as many at once as there
/// are workers: a value that cannot be is said before the first run.
///
/// # Errors
/// A scene cannot be read, the first in the order of the runs; a graph names what the scene does not have.
pub fn fingerprints(study: &Study, workers: Workers) -> Result<Vec<String>, SweepError> {
    let count = workers.count.clamp(1, study.runs.len().max(1));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build()?;
    if !study.runs.is_empty() {
        graphs::check(study, &read(study, 0)?).map_err(|error| study.written.placed(error))?;
    }
    let numbers: Vec<usize> = (0..study.runs.len()).collect();
    let mut fingerprints = Vec::with_capacity(numbers.len());
    // a fault is said before the scenes behind it are read
    for portion in numbers.chunks(4 * count) {
        let of = |number: &usize| read(study, *number).map(|scene| scene.scene_sha256);
        let found: Vec<Result<String, SweepError>> = pool.install(|| portion.par_iter().map(of).collect());
        for fingerprint in found {
            fingerprints.push(fingerprint?);
        }
    }
    Ok(fingerprints)
}

/// Makes the runs that the file does not hold by the [`fingerprints`] of their scenes, stores each as it ends, and breaks off
/// where `stop` is wished.
///
/// # Errors
/// A scene cannot be started, the file cannot be written.
pub fn sweep(
    study: &Study,
    fingerprints: &[String],
    database: &mut Database,
    workers: Workers,
    stop: &Interruption,
    watch: &mut dyn FnMut(Progress),
) -> Result<Summary, SweepError> {
    let mut summary = Summary::default();
    let mut wanted = Vec::new();
    for (number, fingerprint) in fingerprints.iter().enumerate() {
        match database.find(fingerprint, study.steps)?.filter(|_| !workers.again) {
            Some(held) => {
                summary.held += 1;
                summary.failed += usize::from(held.status == Status::Failed.as_str());
                summary.of_others += usize::from(held.binary != souple_run::binary());
            }
            None => wanted.push(number),
        }
    }
    let runs = study.runs.len();
    watch(Progress { done: summary.held, runs });
    let next = AtomicUsize::new(0);
    let (sender, receiver) = mpsc::channel();
    std::thread::scope(|scope| {
        for _ in 0..workers.count.clamp(1, wanted.len().max(1)) {
            let sender = sender.clone();
            let (wanted, next) = (&wanted, &next);
            scope.spawn(move || {
                while !stop.is_wished() {
                    let Some(number) = wanted.get(next.fetch_add(1, Ordering::Relaxed)) else { return };
                    let made = run(study, *number, workers.threads, stop);
                    if sender.send((*number, made)).is_err() {
                        return;
                    }
                }
            });
        }
        drop(sender);
        let mut result = Ok(());
        for (number, made) in &receiver {
            let stored = made.and_then(|outcome| {
                if summary.count(outcome.report.status) {
                    database.store(&study.runs[number], study.steps, &outcome)?;
                }
                Ok(())
            });
            if let (Err(error), true) = (stored, result.is_ok()) {
                // the other workers need not go on
                stop.wish();
                result = Err(error);
            }
            watch(Progress { done: summary.held + summary.made, runs });
        }
        if result.is_err() {
            stop.withdraw();
        }
        result
    })?;
    Ok(summary)
}

fn read(study: &Study, number: usize) -> Result<Scene, SweepError> {
    let settings: Vec<String> = study.settings.iter().cloned().chain(study.runs[number].settings()).collect();
    souple_scene::read_file(&study.scene, &settings).map_err(|diagnostics| SweepError::Scene {
        run: number + 1,
        settings: settings.join(", "),
        message: diagnostics.to_string(),
    })
}

/// One run, within threads of its own.
fn run(study: &Study, number: usize, threads: usize, stop: &Interruption) -> Result<Outcome, SweepError> {
    let plan = &study.runs[number];
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    pool.install(|| {
        let options = Options {
            steps: study.steps,
            scene_name: name(&study.scene),
            interruption: stop.clone(),
            ..Options::default()
        };
        let mut watch =
            |_: &souple_run::Progress| if stop.is_wished() { Control::Stop } else { Control::Continue };
        souple_run::run(read(study, number)?, &options, &mut watch).map_err(|error| SweepError::Scene {
            run: number + 1,
            settings: plan.settings().join(", "),
            message: error.to_string(),
        })
    })
}

/// A scene as reports call it.
fn name(scene: &Path) -> String {
    scene.display().to_string()
}
