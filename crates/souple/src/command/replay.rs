//! `souple replay`: a recording played again.

use std::path::PathBuf;

use serde_json::json;
use souple_run::{Divergence, Options, Recording, RecordingError, Status};

use super::run::{Manner, Output, Strictness, conclude, play};
use super::{End, Refusal, interruption, print_json, print_line, print_note, use_threads};

#[derive(clap::Args)]
pub struct Arguments {
    /// A recording made by `souple run --record`
    recording: PathBuf,
    /// Compares hashes and ends with status 1 where they differ
    #[arg(long)]
    verify: bool,
    /// Folder for report, probes and frames; what an earlier run wrote there is replaced
    #[arg(long)]
    out: Option<PathBuf>,
    #[arg(long, value_parser = super::thread_count)]
    threads: Option<usize>,
    #[arg(long)]
    pub json: bool,
    #[arg(long)]
    quiet: bool,
}

pub fn replay(arguments: &Arguments) -> Result<End, Refusal> {
    use_threads(arguments.threads)?;
    let name = arguments.recording.display().to_string();
    let refuse = |error: &RecordingError| {
        let expected = "a recording of `souple run --record`, with the files of its scene as they were";
        Refusal::request("recording", name.clone(), expected, error.to_string())
    };
    let recording = Recording::read(&arguments.recording).map_err(|error| refuse(&error))?;
    let places = recording.locate_files(&arguments.recording).map_err(|error| refuse(&error))?;
    let scene = souple_scene::read_again(&recording.inputs, places.clone())?;
    if scene.scene_sha256 != recording.scene_sha256 {
        let message = format!(
            "the scene within `{name}` is not the one it was made of: SHA-256 {}, recorded {}; the recording was changed, record the run anew",
            scene.scene_sha256, recording.scene_sha256
        );
        return Err(Refusal::request("recording", name, "an unchanged recording", message));
    }
    note_changed_texts(&recording);
    let options = Options {
        steps: Some(recording.steps),
        out: arguments.out.clone(),
        frames: arguments.out.is_none().then_some(0),
        hash_every: hash_distance(&recording),
        commands: recording.commands.clone(),
        changes: recording.changes.clone(),
        places,
        scene_name: recording.scene.clone(),
        seed: Some(recording.seed),
        interruption: interruption::heed(),
        ..Options::default()
    };
    let outcome = play(scene, &options, arguments.quiet)?;
    if !arguments.verify {
        let manner = Manner {
            out: options.out.as_deref(),
            output: if arguments.json { Output::Json } else { Output::Lines },
            quiet: arguments.quiet,
            expect: Strictness::Warn,
            lost: None,
        };
        return Ok(conclude(&outcome, &manner));
    }
    let divergence = recording.first_divergence(&outcome.recording);
    let same = divergence.is_none() && outcome.report.status == Status::Done;
    if arguments.json {
        let divergence = divergence.as_ref().map(|divergence| {
            json!({
                "step": divergence.period,
                "fields": divergence.fields,
                "recorded": divergence.recorded,
                "replayed": divergence.replayed,
            })
        });
        print_json(&json!({
            "same": same,
            "hashes": recording.hashes.len(),
            "divergence": divergence,
            "error": outcome.report.failure.as_ref().map(souple_run::Failure::to_json),
        }));
    } else if same {
        print_line(format_args!("the same bits at all {} hashes", recording.hashes.len()));
    }
    if let Some(failure) = &outcome.report.failure {
        print_note(format_args!("error: {}", failure.message()));
    }
    if let Some(divergence) = &divergence {
        print_divergence(divergence, &recording);
    }
    Ok(if same { End::Done } else { End::Failed })
}

/// Says where a scene on the disk is no longer what was recorded: the recorded one is played.
fn note_changed_texts(recording: &Recording) {
    for text in &recording.inputs.texts {
        if std::fs::read_to_string(&text.name).is_ok_and(|now| now != text.text) {
            print_note(format_args!(
                "note: `{}` has changed since; what is played is the text in the recording",
                text.name
            ));
        }
    }
}

fn print_divergence(divergence: &Divergence, recording: &Recording) {
    let Divergence { period, recorded, replayed, fields } = divergence;
    let place = match (replayed, &fields[..]) {
        (None, _) => String::new(),
        (Some(_), []) => ", in none of its fields: the hash in the recording was changed".to_owned(),
        (Some(_), [first, ..]) => format!(", first in `{first}` ({} of its fields differ)", fields.len()),
    };
    print_note(format_args!(
        "differs at step {period}{place}: recorded hash {recorded}, replayed {}",
        replayed.as_deref().unwrap_or("none: the replay has no such step")
    ));
    match recording.other_machine() {
        Some(why) => print_note(format_args!("  {why}")),
        None if !fields.is_empty() => print_note(
            "  the same version on the same instructions: another build of it, a changed recording, or a fault of Souple",
        ),
        None => {}
    }
}

/// The number of which all recorded periods with hashes are multiples; first and last have theirs anyway.
fn hash_distance(recording: &Recording) -> Option<u64> {
    let between = recording.hashes.get(1..recording.hashes.len().saturating_sub(1))?;
    let distance = between.iter().map(|hashed| hashed.period).fold(0, gcd);
    (distance > 0).then_some(distance)
}

fn gcd(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { gcd(b, a % b) }
}
