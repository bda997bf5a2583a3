//! Runs of scenes: steps, probes, reports, frames, sounds, recordings, snapshots.
//!
//! [`run`] steps a scene to its end, with what a run leaves on disk; `souple run`, the validation cases and the
//! benchmarks all go through it, so that each of their numbers can be had again from the command line.

mod command;
mod course;
mod doubts;
mod duration;
mod expect;
mod failure;
mod folds;
mod frames;
mod frequencies;
mod governor;
mod in_time;
mod in_time_report;
mod leaps;
mod links;
mod lookout;
mod machine;
mod monitor;
mod output;
mod passages;
mod picture;
mod recording;
mod report;
mod session;
pub mod show;
mod snapshot_file;
mod sound;
mod spectrum;
mod timeline;
mod trace;
mod undefined;
mod wavering;

use std::collections::BTreeMap;
use std::path::PathBuf;

use souple_engine::steppers::Stability;
use souple_engine::{Interruption, Timeline, World};
use souple_scene::spec::sound::Sound;
use souple_scene::{BodyInfo, Scene, SkinInfo};
use souple_table::readable;

pub use command::{command_from_json, command_to_json};
pub use duration::{Periods, periods_in};
pub use expect::{Finding, Verdict, summary};
pub use failure::{Cause, Failure, Part, Spot};
pub use folds::Fold;
pub use frames::solid_of;
pub use frequencies::{FrequencyError, NaturalFrequencies, natural_frequencies};
pub use governor::Governor;
pub use in_time::{InTime, TimeError, WorldToll, run_in_time};
pub use links::links_of;
pub use lookout::Lookout;
pub use machine::{binary, instruction_set, peak_bytes};
pub use monitor::{Grown, Monitor};
pub use output::{MANIFEST, OutputError};
pub use recording::{Divergence, Hashed, Recording, RecordingError};
pub use report::{AroundSteps, Report, SkinChange, Status, counts};
pub use session::{Change, ChangeError, Session, Stepped, put_setting};
pub use snapshot_file::{Snapshot, SnapshotFileError, read_snapshot, write_snapshot};
pub use souple_haptics::Histogram;
pub use timeline::write_timeline;
pub use trace::{Summary, Trace, write_csv};

use output::{OutputFolder, Plan};

/// What a run is asked for beyond its scene.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// World periods to step; where `None`, to the end of the scene's duration.
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
    /// Where a recording of the run goes, if anywhere.
    pub record: Option<PathBuf>,
    /// Continue from this state, with the edits before it.
    pub resume: Option<Snapshot>,
    /// Commands to re-execute, in order of their periods; those before the snapshot that is resumed are skipped.
    pub commands: Vec<souple_engine::Command>,
    /// Changes of the scene to make along the way, in order of their periods.
    pub changes: Vec<Change>,
    /// Where the files of the scene are, if not where it says.
    pub places: BTreeMap<PathBuf, PathBuf>,
    /// How the scene is called in the report.
    pub scene_name: String,
    pub seed: Option<u64>,
    /// What breaks a step off, and with it the run.
    pub interruption: Interruption,
    /// What has the stages of the run.
    pub timeline: Timeline,
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

/// A run that could not start; or, in words, what ended it between two steps.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    #[error("the snapshot does not fit the scene: {0}")]
    Snapshot(#[from] souple_engine::SnapshotError),
    #[error("energy grew without work: {0}")]
    Grown(String),
    #[error("command before period {period}: {error}")]
    Edit { period: u64, error: souple_engine::EditError },
    #[error("change before period {period}: {error}")]
    Change { period: u64, error: ChangeError },
    #[error(transparent)]
    Output(#[from] OutputError),
    #[error("the recording is lost: {0}")]
    Recording(souple_io::IoError),
    #[error(
        "the simulation has blown up: body `{body}` is {} times as large as at rest; take shorter steps{}, or more damping",
        readable(format!("{growth:.0e}").parse().unwrap_or(*growth)),
        if *stability == Stability::Unconditional { "" } else { ", an implicit stepper" }
    )]
    BlownUp {
        body: String,
        growth: f64,
        /// Of its stepper.
        stability: Stability,
    },
    #[error(
        "a duration of {} s is {share:.3e} of the `period` of the `world`, {} s: no step would be made; expected a `duration` of at least half a period",
        readable(*.duration), readable(*.period)
    )]
    NoStep { duration: f64, period: f64, share: f64 },
    #[error(
        "a duration of {duration:e} s at a period of {} s is {steps:e} steps; at most {limit:e} can be counted",
        readable(*.period)
    )]
    TooManySteps { duration: f64, period: f64, steps: f64, limit: f64 },
}

/// What a run was.
pub struct Outcome {
    pub report: Report,
    pub traces: Vec<Trace>,
    pub recording: Recording,
    pub world: World,
    pub bodies: Vec<BodyInfo>,
    /// Files of an earlier run in its folder that it took the place of.
    pub replaced: usize,
    pub skins: Vec<SkinInfo>,
}

/// Runs a scene to its end, to a refused step, or until `watch` stops it.
///
/// Files in the folder of an earlier run are replaced when the first step is about to be made; a run that cannot
/// start removes nothing.
///
/// # Errors
/// The run cannot start. What goes wrong later (a refused step, an edit that does not fit, a file that cannot be
/// written) is no error: the report holds it, with all that was computed before.
pub fn run(
    scene: Scene,
    options: &Options,
    watch: &mut dyn FnMut(&Progress) -> Control,
) -> Result<Outcome, RunError> {
    let (duration, frame_count) = (scene.run.duration, options.frames.unwrap_or(scene.run.frames));
    let aims = course::Aims {
        expects: scene.expects.clone(),
        sounds: scene.sounds.clone(),
        scene_end: duration,
        view: scene.picture,
    };
    let mut session = Session::start(scene, options)?;
    let (first_step, period) = (session.first_step, session.world.model().period);
    let periods = duration::periods_of(options, duration, period, session.world.state())?;
    let steps = periods.count;
    session.warnings.extend(periods.warning);
    session.forecast();
    let folder = output_folder(options, &session, &aims.sounds, first_step)?;
    let traces: Vec<Trace> = session.probes.iter().map(Trace::new).collect();
    let frames = frames::Frames::open(folder.as_ref(), &session, frame_count, steps)?;
    let folds = folds::Folds::new(&session.world, &session.bodies);
    Ok(course::Course { session, folder, frames, traces, folds }.run(steps, options, &aims, watch))
}

fn snapshot_name(period: u64) -> String {
    format!("snapshot_{period:08}.souple")
}

/// The period of a snapshot by its name.
fn snapshot_period(name: &str) -> Option<u64> {
    name.strip_prefix("snapshot_")?.strip_suffix(".souple")?.parse().ok()
}

/// The folder of the run, cleared of the run before.
fn output_folder(
    options: &Options,
    session: &Session,
    sounds: &[Sound],
    first_step: u64,
) -> Result<Option<OutputFolder>, RunError> {
    let Some(out) = &options.out else { return Ok(None) };
    let (bodies, skins, probes) = (&session.bodies, &session.skins, &session.probes);
    let names: Vec<String> = bodies
        .iter()
        .flat_map(|body| {
            let carriers = body.frames.as_ref().map(|_| frames::carriers_of(&body.name));
            let worn = body.dress.as_ref().map(|dress| frames::worn_by(&dress.body));
            [Some(body.name.clone()), carriers, worn].into_iter().flatten()
        })
        .chain(frames::names_of_outlines(bodies))
        .collect();
    let is_frame = |file: &str| {
        names.iter().any(|name| frames::is_frame_of(name, "vtu", file))
            || skins.iter().any(|skin| {
                let name = frames::name_of_skin(skin, bodies);
                let formats = skin.formats.iter().map(String::as_str);
                formats.chain(["vtu"]).any(|format| frames::is_frame_of(&name, format, file))
            })
    };
    let writes = |name: &str| match name.split_once('/') {
        Some((output::FRAMES, file)) => is_frame(file),
        _ => {
            name == picture::PICTURE
                || report::NAMES.contains(&name)
                || sounds.iter().any(|sound| sound::sound_name(&sound.name) == name)
                || probes.iter().any(|probe| picture::plot_names(&probe.name).iter().any(|plot| plot == name))
                || (options.snapshot_every.is_some() && snapshot_period(name).is_some())
        }
    };
    let keeps = |name: &str| snapshot_period(name).is_some_and(|period| period <= first_step);
    let keeps: Option<&dyn Fn(&str) -> bool> = if options.resume.is_some() { Some(&keeps) } else { None };
    Ok(Some(OutputFolder::open(out, &Plan { writes: &writes, keeps })?))
}

/// What stands against stability before the first step.
pub fn forecast_warnings(world: &mut World) -> Vec<String> {
    let mut warnings = Vec::new();
    for index in 0..world.model().systems.len() {
        let stepper = &world.model().systems[index].stepper;
        let timestep = stepper.interval(world.model().timestep(index));
        if stepper.stability() == Stability::Unconditional {
            continue;
        }
        // points of levels have a bound on the safe side
        let bears = if stepper.ticks(1.0).is_some() { "is sure to bear" } else { "bears" };
        let (name, stepper, forecast, stiffest) = world.with_system(index, |system, state, around, ws| {
            let forecast = souple_engine::stability::forecast(system, state, around, ws);
            let stiffest = forecast.stiffest.map(|force| format!(", of `{}`", system.forces[force].name()));
            (system.name.clone(), system.stepper.name(), forecast, stiffest.unwrap_or_default())
        });
        if timestep > forecast.longest_step {
            warnings.push(format!(
                "system `{name}`: a step of {timestep:.3e} s is longer than {stepper} {bears} at rest, {:.3e} s (highest frequency {:.4e} rad/s{stiffest}); shorten the period, raise steps_per_period, or take an implicit stepper",
                forecast.longest_step, forecast.highest_frequency
            ));
        }
    }
    warnings
}
