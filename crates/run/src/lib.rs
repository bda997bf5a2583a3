//! Runs of scenes: steps, probes, reports, frames, recordings, snapshots.
//!
//! [`run`] steps a scene to its end, with what a run leaves on disk; `souple run`, the validation cases and the
//! benchmarks all go through it, so that each of their numbers can be had again from the command line.

mod expect;
mod frames;
mod machine;
mod picture;
mod recording;
mod report;
mod snapshot_file;
mod trace;

pub use report::counts;

use std::path::PathBuf;
use std::time::Instant;

use souple_engine::{Model, State, StepReport, World, WorldError};
use souple_scene::{BodyInfo, ProbeInfo, Scene};

pub use expect::Verdict;
pub use machine::{instruction_set, peak_bytes};
pub use recording::{Divergence, Recording, RecordingError, command_from_json, command_to_json};
pub use report::{Report, Status};
pub use snapshot_file::{SnapshotFileError, read_snapshot, write_snapshot};
pub use trace::{Trace, write_csv};

/// What a run is asked for beyond its scene.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// World periods to step; the scene's duration where `None`.
    pub steps: Option<u64>,
    /// Seconds to simulate, where `steps` is `None`.
    pub duration: Option<f64>,
    /// Where files go; nothing is written where `None`.
    pub out: Option<PathBuf>,
    /// Frames of the series; the scene's number where `None`.
    pub frames: Option<u64>,
    /// Periods between hashes; the first and the last state are hashed in any case.
    pub hash_every: Option<u64>,
    /// Periods between snapshots.
    pub snapshot_every: Option<u64>,
    /// Continue from this state.
    pub resume: Option<State>,
    /// Commands to re-execute, in order of their periods.
    pub commands: Vec<souple_engine::Command>,
    /// How the scene is called in the report.
    pub scene_name: String,
    pub seed: Option<u64>,
}

/// How a run stands, for progress bars and interruption.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    pub step: u64,
    pub steps: u64,
    pub simulated_seconds: f64,
    pub wall_seconds: f64,
}

/// Whether to go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Control {
    Continue,
    Stop,
}

/// A run that could not start or whose files could not be written.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    #[error("the snapshot does not fit the scene: {0}")]
    Snapshot(#[from] souple_engine::SnapshotError),
    #[error("command before period {period}: {error}")]
    Edit { period: u64, error: souple_engine::EditError },
    #[error(transparent)]
    Io(#[from] souple_io::IoError),
    #[error("the folder `{}` cannot be made: {source}", .path.display())]
    Folder { path: PathBuf, source: std::io::Error },
    #[error(
        "a duration of {duration:e} s at a period of {period} s is {steps:e} steps; at most {limit:e} can be counted"
    )]
    TooManySteps { duration: f64, period: f64, steps: f64, limit: f64 },
    #[error(
        "the {kind} `{name}` cannot name the files of a run: without `/`, `\\` and control characters, not begun by a dot, it would"
    )]
    FileName { kind: &'static str, name: String },
}

/// What a run was.
pub struct Outcome {
    pub report: Report,
    pub traces: Vec<Trace>,
    pub verdicts: Vec<Verdict>,
    pub recording: Recording,
    pub world: World,
    pub bodies: Vec<BodyInfo>,
    /// Where a step was refused, if one was.
    pub failure: Option<WorldError>,
}

/// Steps beyond which a count is surely a slip of the pen.
const MOST_STEPS: f64 = 1e12;

/// Whole periods in `duration`, to the nearest.
///
/// # Errors
/// There are absurdly many.
pub fn steps_in(duration: f64, period: f64) -> Result<u64, RunError> {
    let steps = (duration / period).round();
    if steps.is_nan() || steps > MOST_STEPS {
        return Err(RunError::TooManySteps { duration, period, steps, limit: MOST_STEPS });
    }
    Ok(steps.max(0.0) as u64)
}

/// Runs a scene to its end, to a refused step, or until `watch` stops it.
///
/// # Errors
/// The run cannot start, or a file cannot be written. A refused step is no error: the outcome holds it, with all
/// that was computed before.
pub fn run(
    scene: Scene,
    options: &Options,
    watch: &mut dyn FnMut(&Progress) -> Control,
) -> Result<Outcome, RunError> {
    let Scene {
        title, model, state, bodies, probes, expects, run: defaults, scene_sha256, mut warnings, ..
    } = scene;
    let period = model.period;
    let steps = match options.steps {
        Some(steps) => steps,
        None => steps_in(options.duration.unwrap_or(defaults.duration), period)?,
    };
    if options.out.is_some() {
        check_file_names("body", bodies.iter().map(|body| body.name.as_str()))?;
        check_file_names("probe", probes.iter().map(|probe| probe.name.as_str()))?;
    }
    let mut world = start(model, state, options)?;
    warnings.extend(forecast_warnings(&mut world));
    let first_step = world.state().period;
    let mut traces: Vec<Trace> = probes.iter().map(Trace::new).collect();
    let mut frames = frames::Frames::open(options, &bodies, defaults.frames, steps)?;
    let mut recording = Recording::new(options, &scene_sha256, defaults.seed);
    let mut status = Status::Done;
    let mut failure = None;
    let mut solver = StepReport::default();
    let energy_at_start = world.energy();
    let momentum_at_start = world.momentum();
    let mut commands = options.commands.iter().peekable();
    let clock = Instant::now();
    measure(&probes, &mut traces, &mut world);
    recording.push_hash(&world);
    frames.write(&mut world, &bodies, 0)?;
    for step in 1..=steps {
        while let Some(command) = commands.next_if(|command| command.period <= world.state().period) {
            let error = |error| RunError::Edit { period: command.period, error };
            world.edit(command.edit.clone()).map_err(error)?;
        }
        if let Err(error) = world.step() {
            warnings.push(error.to_string());
            (status, failure) = (Status::Failed, Some(error));
            break;
        }
        solver.merge(world.last_report());
        measure(&probes, &mut traces, &mut world);
        let last = step == steps;
        if last || options.hash_every.is_some_and(|every| step.is_multiple_of(every)) {
            recording.push_hash(&world);
        }
        frames.write(&mut world, &bodies, step)?;
        if let (Some(every), Some(out)) = (options.snapshot_every, &options.out)
            && (last || step.is_multiple_of(every))
        {
            let name = format!("snapshot_{:08}.souple", world.state().period);
            write_snapshot(&out.join(name), &scene_sha256, world.state())?;
        }
        let wall_seconds = clock.elapsed().as_secs_f64();
        let progress = Progress { step, steps, simulated_seconds: step as f64 * period, wall_seconds };
        if watch(&progress) == Control::Stop && !last {
            status = Status::Interrupted;
            recording.push_hash(&world);
            break;
        }
    }
    recording.finish(&world);
    frames.close(&mut world, &bodies)?;
    let verdicts: Vec<Verdict> = if status == Status::Done {
        expects.iter().filter_map(|expect| Verdict::of(expect, &traces, defaults.duration, period)).collect()
    } else {
        Vec::new()
    };
    let report = Report {
        status,
        title,
        scene: options.scene_name.clone(),
        scene_sha256,
        seed: options.seed.unwrap_or(defaults.seed),
        threads: rayon::current_num_threads(),
        steps: world.state().period - first_step,
        simulated_seconds: (world.state().period - first_step) as f64 * period,
        wall_seconds: clock.elapsed().as_secs_f64(),
        counts: report::counts(&world, &bodies),
        stages: world.stages(),
        energy: (energy_at_start, world.energy()),
        momentum: (momentum_at_start, world.momentum()),
        solver,
        peak_bytes: peak_bytes(),
        solver_bytes: world.bytes(),
        probes: traces.iter().map(Trace::summary).collect(),
        hashes: recording.hashes.clone(),
        warnings,
    };
    if let Some(out) = &options.out {
        // numbers first: a picture that cannot be written must not cost the report
        report::write_all(out, &report, &traces, &verdicts)?;
        picture::write_plots(out, &traces)?;
        picture::write_picture(&out.join("last.png"), &report.title, &world, &bodies)?;
    }
    Ok(Outcome { report, traces, verdicts, recording, world, bodies, failure })
}

fn start(model: Model, state: State, options: &Options) -> Result<World, RunError> {
    let resumed = match &options.resume {
        Some(resumed) => {
            resumed.check_shape(&state)?;
            resumed.clone()
        }
        None => state,
    };
    Ok(model.start(resumed))
}

/// Names become names of files, which stay inside the run's folder.
fn check_file_names<'a>(kind: &'static str, names: impl Iterator<Item = &'a str>) -> Result<(), RunError> {
    let is_refused = |name: &str| {
        name.is_empty()
            || name.starts_with('.')
            || name.contains(|c: char| matches!(c, '/' | '\\') || c.is_control())
    };
    for name in names {
        if is_refused(name) {
            return Err(RunError::FileName { kind, name: name.to_owned() });
        }
    }
    Ok(())
}

fn measure(probes: &[ProbeInfo], traces: &mut [Trace], world: &mut World) {
    let time = world.time();
    for (probe, trace) in probes.iter().zip(traces) {
        trace.push(time, probe.measure(world));
    }
}

/// What stands against stability before the first step.
pub fn forecast_warnings(world: &mut World) -> Vec<String> {
    let mut warnings = Vec::new();
    for index in 0..world.model().systems.len() {
        let timestep = world.model().timestep(index);
        let explicit = world.model().systems[index].stepper.stability()
            != souple_engine::steppers::Stability::Unconditional;
        if !explicit {
            continue;
        }
        let (name, stepper, forecast) = world.with_system(index, |system, state, around, ws| {
            let forecast = souple_engine::stability::forecast(system, state, around, ws);
            (system.name.clone(), system.stepper.name(), forecast)
        });
        if timestep > forecast.longest_step {
            warnings.push(format!(
                "system `{name}`: a step of {timestep:.3e} s is longer than {stepper} bears at rest, {:.3e} s (highest frequency {:.4e} rad/s); shorten the period, raise steps_per_period, or take an implicit stepper",
                forecast.longest_step, forecast.highest_frequency
            ));
        }
    }
    let period = world.model().period;
    warnings.extend(world.model().couplings.iter().filter_map(|coupling| coupling.forecast(period)));
    warnings
}
