//! `souple replay`: a recording played again.

use std::path::PathBuf;

use serde_json::json;
use souple_run::{Options, Recording, Status};

use super::run::{conclude, play};
use super::{End, Refusal, print_json, print_line, print_note, read_scene, scene_path, use_threads};

#[derive(clap::Args)]
pub struct Arguments {
    /// A recording made by `souple run --record`
    recording: PathBuf,
    /// Compares hashes and ends with status 1 where they differ
    #[arg(long)]
    verify: bool,
    /// Folder for report, probes and frames
    #[arg(long)]
    out: Option<PathBuf>,
    #[arg(long)]
    threads: Option<usize>,
    #[arg(long)]
    pub json: bool,
    #[arg(long)]
    quiet: bool,
}

pub fn replay(arguments: &Arguments) -> Result<End, Refusal> {
    use_threads(arguments.threads)?;
    let name = arguments.recording.display().to_string();
    let refuse = |message: String| {
        Refusal::request("recording", name.clone(), "a recording of `souple run --record`", message)
    };
    let recording = Recording::read(&arguments.recording).map_err(|error| refuse(error.to_string()))?;
    let scene = read_scene(&recording.scene, &recording.settings)?;
    if scene.scene_sha256 != recording.scene_sha256 {
        let message = format!(
            "scene `{}` is not the one recorded: SHA-256 {}, recorded {}",
            recording.scene, scene.scene_sha256, recording.scene_sha256
        );
        return Err(refuse(message));
    }
    let options = Options {
        steps: Some(recording.steps),
        out: arguments.out.clone(),
        frames: arguments.out.is_none().then_some(0),
        hash_every: hash_distance(&recording),
        commands: recording.commands.clone(),
        scene_name: scene_path(&recording.scene).display().to_string(),
        seed: Some(recording.seed),
        ..Options::default()
    };
    let outcome = play(scene, &options, arguments.quiet)?;
    if !arguments.verify {
        return conclude(&outcome, options.out.as_deref(), arguments.json, arguments.quiet);
    }
    let divergence = recording.first_divergence(&outcome.recording);
    let same = divergence.is_none() && outcome.report.status == Status::Done;
    if arguments.json {
        let divergence = divergence.as_ref().map(|divergence| {
            json!({"step": divergence.period, "recorded": divergence.recorded, "replayed": divergence.replayed})
        });
        print_json(&json!({"same": same, "hashes": recording.hashes.len(), "divergence": divergence}));
    } else if same {
        print_line(format_args!("the same bits at all {} hashes", recording.hashes.len()));
    }
    if let Some(divergence) = divergence {
        print_note(format_args!(
            "differs at step {}: recorded hash {}, replayed {}",
            divergence.period,
            divergence.recorded,
            divergence.replayed.as_deref().unwrap_or("none: the replay has no such step")
        ));
    }
    Ok(if same { End::Done } else { End::Failed })
}

/// The distance at which all recorded hashes are met again.
fn hash_distance(recording: &Recording) -> Option<u64> {
    let periods: Vec<u64> = recording.hashes.iter().map(|(period, _)| *period).collect();
    let distance = periods.windows(2).map(|pair| pair[1].abs_diff(pair[0])).fold(0, gcd);
    (distance > 0).then_some(distance)
}

fn gcd(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { gcd(b, a % b) }
}
