//! `souple haptics`: a scene in the hands of people, in true real time.

use std::path::PathBuf;

use serde_json::Value;
use souple_run::{Control, InTime, Options, Progress, Session, TimeError, run_in_time};

use super::progress::Meter;
use super::{
    End, Refusal, interruption, print_json, print_line, print_note, read_scene, scene_path, seconds,
    use_threads,
};

#[derive(clap::Args)]
pub struct Arguments {
    /// Scene file, or a folder with a scene.toml, with [hands.NAME]
    scene: String,
    /// Folder for report, traces of hands and plots; made if missing
    #[arg(long)]
    out: Option<PathBuf>,
    /// Time on the clock, as `60 s`; the scene's duration by default
    #[arg(long, value_parser = seconds)]
    duration: Option<f64>,
    /// Changes a value of the scene; may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    settings: Vec<String>,
    /// Worker threads of the world
    #[arg(long, value_parser = super::thread_count)]
    threads: Option<usize>,
    /// Writes a recording that `souple replay` repeats bit for bit, without devices and without a clock
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// One JSON document (the report) on standard output
    #[arg(long)]
    pub json: bool,
    /// No progress
    #[arg(long)]
    quiet: bool,
}

/// Longest run [s]: every tick of it is kept.
const LONGEST: f64 = 3600.0;

pub fn haptics(arguments: &Arguments) -> Result<End, Refusal> {
    use_threads(arguments.threads)?;
    let scene = read_scene(&arguments.scene, &arguments.settings)?;
    let duration = arguments.duration.unwrap_or(scene.run.duration);
    if !(duration > 0.0 && duration <= LONGEST) {
        let message = format!("a run of {duration} s against the clock");
        return Err(Refusal::request("duration", duration.to_string(), "up to an hour", message));
    }
    let scene_name = scene_path(&arguments.scene).display().to_string();
    let interruption = interruption::heed();
    let mut session = Session::start(scene, &Options { scene_name, interruption, ..Options::default() })?;
    session.forecast();
    let meter = Meter::new("periods", arguments.quiet);
    let mut watch = |progress: &Progress| {
        let behind = progress.wall_seconds - progress.simulated_seconds;
        meter.show(progress.step, progress.steps, format_args!("clock less world {:.1} ms", 1e3 * behind));
        if interruption::is_interrupted() { Control::Stop } else { Control::Continue }
    };
    let run = run_in_time(&mut session, duration, &mut watch).map_err(refuse)?;
    drop(meter);
    if let Some(path) = &arguments.record {
        session.recording().write(path)?;
    }
    if let Some(folder) = &arguments.out {
        run.write(folder, &session)?;
    }
    Ok(conclude(&run, &session, arguments))
}

fn refuse(error: TimeError) -> Refusal {
    match error {
        TimeError::NoHand => Refusal::request("hands", "", "a scene with [hands.NAME]", error.to_string()),
        TimeError::Device { .. } => {
            Refusal::request("device", "", "a device that is there", error.to_string())
        }
        TimeError::Service(_) | TimeError::Edit { .. } | TimeError::Lost => {
            Refusal::work("haptics", error.to_string())
        }
    }
}

fn conclude(run: &InTime, session: &Session, arguments: &Arguments) -> End {
    for warning in &session.warnings {
        print_note(format_args!("warning: {warning}"));
    }
    if let Some(failure) = &session.failure {
        print_note(format_args!("error: {}", failure.message()));
    }
    let report = run.to_json(session);
    if arguments.json {
        print_json(&report);
    } else if !arguments.quiet {
        print_summary(&report);
    }
    match (&session.failure, run.was_stopped) {
        (Some(_), _) => End::Failed,
        (None, true) => End::Interrupted,
        (None, false) => End::Done,
    }
}

fn print_summary(report: &Value) {
    let number = |pointer: &str| report.pointer(pointer).and_then(Value::as_f64).unwrap_or(f64::NAN);
    print_line(format_args!(
        "devices: {} periods, 99.9 % within {:.3} ms and no more than {:.3} ms off one, longest {:.3} ms, {:.3} % within 1.2 ms ({})",
        number("/devices/periods/count"),
        number("/devices/periods/p99_9_ms"),
        number("/devices/periods/jitter_99_9_ms"),
        number("/devices/periods/longest_ms"),
        100.0 * number("/devices/periods/share_within_1_2_ms"),
        report["devices"]["priority"].as_str().unwrap_or_default(),
    ));
    print_line(format_args!(
        "world: {} periods, load {:.0} % (99 % of periods below {:.0} %), {} late, {:.3} s given up",
        number("/world/periods"),
        100.0 * number("/world/load/mean"),
        100.0 * number("/world/load/p99"),
        number("/world/late"),
        number("/world/lost_seconds"),
    ));
    let share = |of: &str| 100.0 * number(&format!("/world/shares/{of}"));
    print_line(format_args!(
        "clock less world {:.2} ms at the end; of the time of computing {:.0} % pairs, {:.0} % forces, {:.0} % equations, {:.0} % advance, {:.0} % fields, {:.0} % the rest",
        1e3 * number("/world/drift_seconds"),
        share("pairs"),
        share("forces"),
        share("solve"),
        share("advance"),
        share("fields"),
        share("rest"),
    ));
    for (name, hand) in report["hands"].as_object().into_iter().flatten() {
        let number = |key: &str| hand[key].as_f64().unwrap_or(f64::NAN);
        print_line(format_args!(
            "hand {name}: at most {:.3} N, {:.4} N from tick to tick, {:.3e} J put in less what came back, never less than {:.1e} J",
            number("greatest_force_n"),
            number("greatest_jump_n"),
            number("energy_j"),
            number("least_energy_j"),
        ));
        if number("share_at_limit") > 0.0 {
            print_line(format_args!(
                "hand {name}: its force was at the limit of {} N in {:.2} % of the ticks: a hand that pushes harder goes on alone; where force and tool quiver the coupling is too stiff",
                number("limit_n"),
                100.0 * number("share_at_limit"),
            ));
        }
        if number("share_lost") > 0.0 {
            print_line(format_args!(
                "hand {name}: its device was lost in {:.2} % of the ticks, first at {:.3} s",
                100.0 * number("share_lost"),
                number("first_lost_seconds"),
            ));
        }
        let most = |of: &str| hand[of]["p99_9_ms"].as_f64().unwrap_or(f64::NAN);
        print_line(format_args!(
            "hand {name}: 99.9 % of forces say of the body what was no more than {:.2} ms before when the next one comes, and answer within {:.2} ms to where the device was",
            most("age"),
            most("answer"),
        ));
    }
}
