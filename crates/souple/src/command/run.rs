//! `souple run`: a scene from start to end.

use std::path::{Path, PathBuf};

use souple_run::{Control, Finding, Options, Outcome, Progress, Report, Status, Summary};
use souple_scene::Scene;
use souple_table::{counted, four_digits, with_unit};

use super::progress::Meter;
use super::{
    End, Refusal, count, interruption, print_json, print_line, print_note, read_scene, scene_path, seconds,
    timeline_of, use_threads, write_trace,
};

#[derive(clap::Args)]
// `--steps -1` is a wrong count, not an argument of that name
#[command(allow_negative_numbers = true)]
pub struct Arguments {
    /// Scene file, or a folder with a scene.toml
    scene: String,
    /// Folder for report, probes, frames and picture; made if missing. What an earlier run wrote there is replaced
    #[arg(long)]
    out: Option<PathBuf>,
    /// World periods to step; by default, to the end of the scene's duration
    #[arg(long, conflicts_with = "duration", value_parser = count::<0>)]
    steps: Option<u64>,
    /// Time to simulate, as `2 s` or `500 ms`; rounded to whole periods, with a warning
    #[arg(long)]
    duration: Option<String>,
    /// Changes a value of the scene: `bodies.bar.material.youngs_modulus="20 MPa"`; may be repeated. Mesh files are
    /// relative to the current folder
    #[arg(long = "set", value_name = "PATH=VALUE")]
    settings: Vec<String>,
    /// Worker threads; the results do not depend on it
    #[arg(long, value_parser = super::thread_count)]
    threads: Option<usize>,
    /// Recorded with the run, though nothing is random yet; the scene's by default
    #[arg(long, value_parser = count::<0>)]
    seed: Option<u64>,
    /// Frames of the series; the scene's number by default
    #[arg(long, value_parser = count::<0>)]
    frames: Option<u64>,
    /// Steps between hashes of the state
    #[arg(long, value_name = "STEPS", value_parser = count::<1>)]
    hash_every: Option<u64>,
    /// Steps between snapshots
    #[arg(long, value_name = "STEPS", value_parser = count::<1>, requires = "out")]
    snapshot_every: Option<u64>,
    /// Continues from a snapshot to the scene's end; --steps and --duration then count from the snapshot
    #[arg(long, value_name = "FILE")]
    resume: Option<PathBuf>,
    /// Writes a recording that `souple replay` repeats bit for bit, from the scene's start
    #[arg(long, value_name = "FILE", conflicts_with = "resume")]
    record: Option<PathBuf>,
    /// Writes who did what when, as trace events that chrome://tracing and Perfetto draw
    #[arg(long, value_name = "FILE")]
    trace: Option<PathBuf>,
    /// Whether an expectation that fails ends with status 1; `strict` by default, `warn` where --set changes the scene
    #[arg(long, value_enum)]
    expect: Option<Strictness>,
    /// One JSON document (the report) on standard output
    #[arg(long)]
    pub json: bool,
    /// No progress
    #[arg(long)]
    quiet: bool,
}

/// What a failing expectation does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Strictness {
    /// It ends the program with status 1
    Strict,
    /// It is said, and no more
    Warn,
}

pub fn run(arguments: &Arguments) -> Result<End, Refusal> {
    use_threads(arguments.threads)?;
    let scene = read_scene(&arguments.scene, &arguments.settings)?;
    if arguments.steps == Some(0) {
        print_note("`--steps 0`: nothing is stepped, and results are those of where it begins");
    }
    let mut options = Options {
        steps: arguments.steps,
        duration: arguments.duration.as_deref().map(parse_duration).transpose()?,
        out: arguments.out.clone(),
        frames: arguments.frames,
        hash_every: arguments.hash_every,
        snapshot_every: arguments.snapshot_every,
        record: arguments.record.clone(),
        scene_name: scene_path(&arguments.scene).display().to_string(),
        seed: arguments.seed,
        interruption: interruption::heed(),
        timeline: timeline_of(arguments.trace.as_ref())?,
        ..Options::default()
    };
    if let Some(path) = &arguments.resume {
        options.resume = Some(read_resumed(path, &scene.scene_sha256)?);
    }
    let played = play(scene, &options, arguments.quiet);
    // of a run that failed as well: it may say why
    let lost = write_trace(arguments.trace.as_ref(), &options.timeline);
    let outcome = match (played, &lost) {
        (Ok(outcome), _) => outcome,
        (Err(refusal), Some(lost)) => return Err(refusal.and(lost)),
        (Err(refusal), None) => return Err(refusal),
    };
    // a scene that was changed may well behave otherwise than its author expects
    let usual = if arguments.settings.is_empty() { Strictness::Strict } else { Strictness::Warn };
    let manner = Manner {
        out: options.out.as_deref(),
        output: if arguments.json { Output::Json } else { Output::Lines },
        quiet: arguments.quiet,
        expect: arguments.expect.unwrap_or(usual),
        lost: lost.as_ref(),
    };
    Ok(conclude(&outcome, &manner))
}

fn read_resumed(path: &Path, scene_sha256: &str) -> Result<souple_run::Snapshot, Refusal> {
    let snapshot = souple_run::read_snapshot(path, scene_sha256).map_err(|error| {
        Refusal::request(
            "snapshot",
            path.display().to_string(),
            "a snapshot of this scene",
            error.to_string(),
        )
    })?;
    let (binary, isa) = (souple_run::binary(), souple_run::instruction_set());
    if snapshot.binary != binary || snapshot.isa != isa {
        print_note(format_args!(
            "warning: the snapshot was written by {} on {}, this is {binary} on {isa}: the run may end with other bits than an unbroken one",
            snapshot.binary, snapshot.isa
        ));
    }
    Ok(snapshot)
}

/// Runs with progress, stopping cleanly at Ctrl-C and SIGTERM once they are heeded ([`Options::interruption`]).
pub fn play(scene: Scene, options: &Options, quiet: bool) -> Result<Outcome, Refusal> {
    let meter = Meter::new("steps", quiet);
    let mut watch = |progress: &Progress| {
        let factor = progress.simulated_seconds / progress.wall_seconds.max(1e-9);
        meter.show(progress.step, progress.steps, format_args!("{factor:.2} x real time"));
        if interruption::is_interrupted() { Control::Stop } else { Control::Continue }
    };
    let outcome = souple_run::run(scene, options, &mut watch)?;
    drop(meter);
    if let (false, 1.., Some(out)) = (quiet, outcome.replaced, &options.out) {
        print_note(format_args!(
            "note: {} of an earlier run in {} replaced",
            counted(outcome.replaced as u64, "file"),
            out.display()
        ));
    }
    Ok(outcome)
}

/// Where the results of a run are told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Output {
    Json,
    Lines,
}

/// How a run is told.
pub struct Manner<'a> {
    pub out: Option<&'a Path>,
    pub output: Output,
    pub quiet: bool,
    pub expect: Strictness,
    /// What could not be written beside the results.
    pub lost: Option<&'a Refusal>,
}

/// Prints what came out, and says how it ended.
pub fn conclude(outcome: &Outcome, manner: &Manner) -> End {
    let report = &outcome.report;
    for warning in &report.warnings {
        print_note(format_args!("warning: {warning}"));
    }
    if !manner.quiet {
        report.skin_changes.iter().for_each(|change| print_note(format_args!("note: {}", change.message())));
    }
    if let Some(failure) = &report.failure {
        print_note(format_args!("error: {}", failure.message()));
    }
    let verdicts = &report.expectations;
    let of = |finding: Finding| verdicts.iter().filter(move |verdict| verdict.finding == finding);
    let word =
        if manner.expect == Strictness::Strict { "not as expected" } else { "warning: not as expected" };
    of(Finding::Fails).for_each(|verdict| print_note(format_args!("{word}: {}", verdict.message())));
    let is_left_open = of(Finding::NotJudged).next().is_some();
    if let Some(lost) = manner.lost {
        lost.print(false);
    }
    if manner.output == Output::Json {
        let mut document = report.to_json();
        if let Some(lost) = manner.lost {
            document["errors"] = lost.errors.clone().into();
        }
        print_json(&document);
    } else if !manner.quiet {
        print_summary(report, manner.out);
    }
    if !verdicts.is_empty() && (is_left_open || !manner.quiet) {
        let line = format!("expectations: {}", souple_run::summary(verdicts));
        if manner.output == Output::Json || manner.quiet { print_note(line) } else { print_line(line) }
    }
    let end = match report.status {
        Status::Interrupted => End::Interrupted,
        Status::Failed => End::Failed,
        Status::Done if manner.expect == Strictness::Strict && of(Finding::Fails).next().is_some() => {
            End::Failed
        }
        Status::Done => End::Done,
    };
    end.with(manner.lost)
}

fn print_summary(report: &Report, out: Option<&Path>) {
    print_line(format_args!(
        "{}: {}, {:.4} s simulated in {:.2} s ({:.2} x real time)",
        report.status.as_str(),
        counted(report.steps, "step"),
        report.simulated_seconds,
        report.wall_seconds,
        report.real_time_factor()
    ));
    for probe in &report.probes {
        print_line(format_args!("  {} = {:?} {}{}", probe.name, probe.last, probe.unit, extremes(probe)));
    }
    let sounds = report.sounds.iter().map(|sound| format!("{}.wav", sound.name));
    let names = ["report.json", "probes.csv"].map(str::to_owned).into_iter().chain(sounds);
    let names: Vec<String> = names.chain(["last.png".to_owned()]).collect();
    let files = out.into_iter().flat_map(|out| names.iter().map(move |name| out.join(name)));
    for file in files.filter(|file| file.is_file()) {
        print_line(format_args!("  {}", file.display()));
    }
}

/// Between what a number was, and how long a vector was at most; nothing of what never changed, or was no number at some date.
fn extremes(probe: &Summary) -> String {
    let four = four_digits;
    match (probe.longest, &probe.min[..], &probe.max[..]) {
        (Some((length, time)), ..) if probe.min != probe.max && !length.is_nan() => {
            format!("; at most {} long, at {} s", with_unit(&four(length), probe.unit), four(time))
        }
        (None, [min], [max]) if min < max => {
            format!(
                "; from {} at {} s to {} at {} s",
                four(*min),
                four(probe.min_at[0]),
                four(*max),
                four(probe.max_at[0])
            )
        }
        _ => String::new(),
    }
}

fn parse_duration(text: &str) -> Result<f64, Refusal> {
    let refuse = |message: String| {
        Refusal::request("duration", text, "a time above 0, such as `2 s` or `500 ms`", message)
    };
    match seconds(text) {
        Ok(seconds) if seconds > 0.0 && seconds.is_finite() => Ok(seconds),
        Ok(seconds) => Err(refuse(format!("a duration of {seconds} s cannot be run"))),
        Err(message) => Err(refuse(message)),
    }
}

/// The scene of a program called without arguments, as it is in the repository.
const DEFAULT_SCENE: &str = include_str!("../../../../scenes/surgical/scene.toml");

/// Greets, runs the default scene headless, and says what to try next.
pub fn run_default_scene() -> Result<End, Refusal> {
    print_line(
        "Souple, a simulator of soft things. The default scene runs now: a liver of three meshes hangs from its ligament and is poked.",
    );
    let scene = souple_scene::read_text("surgical", DEFAULT_SCENE, Path::new("."), &[])?;
    let out = PathBuf::from("out").join("surgical");
    let options = Options {
        out: Some(out.clone()),
        scene_name: "surgical".to_owned(),
        interruption: interruption::heed(),
        ..Options::default()
    };
    let outcome = play(scene, &options, false)?;
    let manner = Manner {
        out: Some(&out),
        output: Output::Lines,
        quiet: false,
        expect: Strictness::Strict,
        lost: None,
    };
    let end = conclude(&outcome, &manner);
    print_line("Try next:");
    print_line("  souple list materials");
    print_line("  souple check scenes/cantilever/scene.toml");
    print_line("  souple run scenes/twisted_bar/scene.toml --out out/twisted_bar");
    Ok(end)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn summary(unit: &'static str, values: [&[f64]; 2], longest: Option<(f64, f64)>) -> Summary {
        let [min, max] = values.map(<[f64]>::to_vec);
        Summary {
            name: "tip".to_owned(),
            unit,
            first: min.clone(),
            last: max.clone(),
            min_at: vec![0.25; min.len()],
            max_at: vec![1.0; max.len()],
            min,
            max,
            longest,
            frequency: Vec::new(),
        }
    }

    /// Units stand where there are some, and nothing where nothing changed or a number is missing.
    #[test]
    fn extremes_are_told_of_what_changed() {
        let of = |unit, values, longest| extremes(&summary(unit, values, longest));
        assert_eq!(of("m", [&[-1.0], &[0.5]], None), "; from -1 at 0.25 s to 0.5 at 1 s");
        assert_eq!(of("m", [&[1.0], &[1.0]], None), "");
        assert_eq!(of("m", [&[f64::NAN], &[f64::NAN]], None), "");
        let vectors: [&[f64]; 2] = [&[0.0; 3], &[3.0, 4.0, 0.0]];
        assert_eq!(of("m", vectors, Some((5.0, 1.0))), "; at most 5 m long, at 1 s");
        assert_eq!(of("", vectors, Some((5.0, 1.0))), "; at most 5 long, at 1 s");
        let broken: [&[f64]; 2] = [&[f64::NAN, 0.0, 0.0], &[f64::NAN, 1.0, 0.0]];
        assert_eq!(of("m", broken, Some((f64::NAN, 1.0))), "");
    }
}
