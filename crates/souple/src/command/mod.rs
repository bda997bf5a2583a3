//! Commands: one file each.

mod bench;
mod cache;
mod check;
mod compare;
mod derive;
mod frames_needed;
mod haptics;
mod interruption;
mod law_steps;
mod list;
mod mesh;
mod modes;
mod progress;
mod render;
mod replay;
mod run;
mod sweep;
mod verify;
mod view;

use std::io::{IsTerminal, Write};
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::{Parser, Subcommand};
use serde_json::{Value, json};
use souple_engine::Timeline;
use souple_formal::law::LawError;
use souple_models::materials::TextLaw;

/// A simulator of soft things.
#[derive(Parser)]
#[command(name = "souple", version, about)]
pub struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Subcommand)]
enum Command {
    /// Shows a scene live in the browser: pull it, change it
    View(view::Arguments),
    /// Runs a scene headless: report, probes, frames
    Run(run::Arguments),
    /// Puts a scene into people's hands, in true real time: forces a thousand times a second, emulated people where there
    /// are no devices
    Haptics(haptics::Arguments),
    /// Validates a scene without running it: every error with its place, a forecast of stability and cost
    Check(check::Arguments),
    /// Computes natural frequencies about a scene's first state
    Modes(modes::Arguments),
    /// Lists what there is of a kind: materials, elements, steppers, …
    List(list::ListArguments),
    /// Prints the page of one thing
    Describe(list::DescribeArguments),
    /// Prints the JSON Schema of scene files
    Schema(SchemaArguments),
    /// Runs the validation cases: measured, reference, tolerance
    Verify(verify::Arguments),
    /// Runs the benchmarks: speed with its error beside it
    Bench(bench::Arguments),
    /// Makes the runs of a study in parallel, into one SQLite file, with a table and graphs of them
    Sweep(sweep::Arguments),
    /// Plays a recording again
    Replay(replay::Arguments),
    /// Draws a scene or a run: picture, contact sheet, film, animated surfaces
    Render(Box<render::Arguments>),
    /// Compares two results field by field
    Compare(compare::Arguments),
    /// Derives a law on an element: stress, tangent, grouped constants, operation counts, code
    Derive(derive::Arguments),
    /// Generates, converts and measures meshes
    Mesh(mesh::Arguments),
}

#[derive(clap::Args)]
struct SchemaArguments {
    /// As with every command; a schema is JSON in any case
    #[arg(long)]
    json: bool,
}

/// How a command ended.
pub enum End {
    Done,
    /// The work failed; the reason has been printed.
    Failed,
    Interrupted,
}

/// A request that was wrong, or work that failed, in words.
pub struct Refusal {
    pub status: u8,
    pub errors: Vec<Value>,
    /// For people; the errors' messages where `None`.
    pub text: Option<String>,
}

/// Faults of a scene that are printed for people, whose screens end.
const MOST_FAULTS: usize = 20;

/// Exit status of a request that was wrong.
const WRONG_REQUEST: u8 = 2;
const WORK_FAILED: u8 = 1;
const INTERRUPTED: u8 = 130;

impl Refusal {
    /// The request was wrong: says what was read and what would be accepted.
    pub fn request(
        code: &str,
        value: impl Into<String>,
        expected: impl Into<String>,
        message: impl Into<String>,
    ) -> Self {
        Self::new(WRONG_REQUEST, code, value, expected, message)
    }

    /// The work failed.
    pub fn work(code: &str, message: impl Into<String>) -> Self {
        Self::new(WORK_FAILED, code, "", "", message)
    }

    fn new(
        status: u8,
        code: &str,
        value: impl Into<String>,
        expected: impl Into<String>,
        message: impl Into<String>,
    ) -> Self {
        let error = json!({
            "code": code, "file": Value::Null, "line": Value::Null, "column": Value::Null, "path": "",
            "value": value.into(), "expected": expected.into(), "message": message.into(),
        });
        Self { status, errors: vec![error], text: None }
    }

    /// At a place in `text`, which is that of the error's part: its name is the path, lines and columns are of the text.
    fn within(mut self, error: &LawError, text: &str) -> Self {
        let before = error.span.and_then(|span| text.get(..span.start));
        for own in &mut self.errors {
            own["path"] = json!(error.part);
            if let Some(before) = before {
                let line = before.rsplit('\n').next().unwrap_or_default();
                own["line"] = json!(1 + before.matches('\n').count());
                own["column"] = json!(1 + line.chars().count());
            }
        }
        self
    }

    /// The same, with what else went wrong.
    fn and(mut self, other: &Self) -> Self {
        for error in &other.errors {
            if let (Some(text), Some(message)) = (&mut self.text, error["message"].as_str()) {
                *text += &format!("\nerror: {message}");
            }
            self.errors.push(error.clone());
        }
        self
    }

    fn print(&self, as_json: bool) {
        if as_json {
            print_json(&json!({ "errors": self.errors }));
        }
        match &self.text {
            Some(text) => print_note(text),
            None => {
                for error in &self.errors {
                    let message = error["message"].as_str().unwrap_or_default();
                    print_note(format_args!("error: {message}"));
                    // what the message has said is not said again
                    let is_said =
                        |expected: &str| message.contains("; expected ") || message.contains(expected);
                    match error["expected"].as_str() {
                        Some(expected) if !is_said(expected) => {
                            print_note(format_args!("  = expected {expected}"));
                        }
                        _ => {}
                    }
                }
            }
        }
    }
}

impl From<souple_scene::Diagnostics> for Refusal {
    fn from(diagnostics: souple_scene::Diagnostics) -> Self {
        let errors = match diagnostics.to_json() {
            Value::Object(mut object) => match object.remove("errors") {
                Some(Value::Array(errors)) => errors,
                _ => Vec::new(),
            },
            _ => Vec::new(),
        };
        let shown: Vec<String> = diagnostics.0.iter().take(MOST_FAULTS).map(ToString::to_string).collect();
        let mut text = shown.join("\n\n");
        if diagnostics.0.len() > MOST_FAULTS {
            let rest = diagnostics.0.len() - MOST_FAULTS;
            text += &format!("\n\n… and {rest} more (all of them with --json)");
        }
        Self { status: WRONG_REQUEST, errors, text: Some(text) }
    }
}

/// A file that cannot be read or asked for in this way is a wrong request; one that cannot be written, failed work.
impl From<souple_io::IoError> for Refusal {
    fn from(error: souple_io::IoError) -> Self {
        use souple_io::{IoError, Place};
        let message = error.to_string();
        let (path, line, value, expected) = match error {
            IoError::Content { path, fault } => {
                let line = match fault.place {
                    Place::Line(line) | Place::PartLine { line, .. } => json!(line),
                    Place::Byte(_) => Value::Null,
                };
                (path, line, fault.found, fault.expected)
            }
            IoError::Read { path, .. } => {
                (path, Value::Null, String::new(), "a file that can be read".to_owned())
            }
            IoError::Extension { path, found, expected } => (path, Value::Null, found, expected),
            IoError::Unsupported { .. } | IoError::Request { .. } | IoError::UnknownFormat(_) => {
                return Self::request("file", "", "", message);
            }
            IoError::DiskFull { .. } | IoError::NotWritable { .. } | IoError::Write { .. } => {
                return Self::work("io", message);
            }
        };
        let mut refusal = Self::request("file", value, expected, message);
        refusal.errors[0]["file"] = json!(path);
        refusal.errors[0]["line"] = line;
        // the message has it all
        refusal.text = Some(format!("error: {}", refusal.errors[0]["message"].as_str().unwrap_or_default()));
        refusal
    }
}

impl From<souple_run::RunError> for Refusal {
    fn from(error: souple_run::RunError) -> Self {
        use souple_run::{OutputError, RunError};
        match &error {
            RunError::Snapshot(_)
            | RunError::Edit { .. }
            | RunError::Change { .. }
            | RunError::TooManySteps { .. }
            | RunError::NoStep { .. } => Self::request("run", "", "", error.to_string()),
            // what is found out after steps, and told by the report
            RunError::Recording(_) | RunError::BlownUp { .. } | RunError::Grown(_) => {
                Self::work("run", error.to_string())
            }
            RunError::Output(output) => match output {
                // the messages say what would be right
                OutputError::Foreign { .. }
                | OutputError::ForeignList { .. }
                | OutputError::NoFolder { .. }
                | OutputError::WouldLoseResults { .. }
                | OutputError::InUse { .. }
                | OutputError::List { .. } => Self::request("output", "", "", error.to_string()),
                OutputError::Folder { .. } | OutputError::NotRemoved { .. } | OutputError::Io(_) => {
                    Self::work("io", error.to_string())
                }
            },
        }
    }
}

/// Runs a command and gives its exit status.
pub fn execute(cli: Cli) -> ExitCode {
    // benchmarks time what is derived
    if !matches!(cli.command, Some(Command::Bench(_))) {
        TextLaw::keep_in(cache::kept_laws());
    }
    let Some(command) = cli.command else {
        // without the page the scene runs headless
        return match souple_view::missing_page() {
            None => exit_code(view::view_default_scene(), false),
            Some(problem) => {
                print_note(format_args!("there is no page to show it on: {problem}"));
                exit_code(run::run_default_scene(), false)
            }
        };
    };
    let (ended, as_json) = match command {
        Command::View(arguments) => (view::view(&arguments), false),
        Command::Run(arguments) => (run::run(&arguments), arguments.json),
        Command::Haptics(arguments) => (haptics::haptics(&arguments), arguments.json),
        Command::Sweep(arguments) => (sweep::sweep(&arguments), arguments.json),
        Command::Check(arguments) => (check::check(&arguments), arguments.json),
        Command::Modes(arguments) => (modes::modes(&arguments), arguments.json),
        Command::List(arguments) => (list::list(&arguments), arguments.json),
        Command::Describe(arguments) => (list::describe(&arguments), arguments.json),
        Command::Schema(_) => {
            print_json(&souple_scene::schema());
            (Ok(End::Done), true)
        }
        Command::Verify(arguments) => (verify::verify(&arguments), arguments.json),
        Command::Bench(arguments) => (bench::bench(&arguments), arguments.json),
        Command::Replay(arguments) => (replay::replay(&arguments), arguments.json),
        Command::Render(arguments) => (render::render(&arguments), arguments.json),
        Command::Compare(arguments) => (compare::compare(&arguments), arguments.json),
        Command::Derive(arguments) => (derive::derive(&arguments), arguments.json),
        Command::Mesh(arguments) => {
            let as_json = arguments.wants_json();
            (mesh::mesh(arguments), as_json)
        }
    };
    exit_code(ended, as_json)
}

fn exit_code(ended: Result<End, Refusal>, as_json: bool) -> ExitCode {
    match ended {
        Ok(End::Done) if OUTPUT_LOST.load(Ordering::Relaxed) => ExitCode::from(WORK_FAILED),
        Ok(End::Done) => ExitCode::SUCCESS,
        Ok(End::Failed) => ExitCode::from(WORK_FAILED),
        Ok(End::Interrupted) => ExitCode::from(INTERRUPTED),
        Err(refusal) => {
            refusal.print(as_json);
            ExitCode::from(refusal.status)
        }
    }
}

/// Help and version go out as they are; wrong arguments are a wrong request.
pub fn refuse_arguments(error: &clap::Error) -> ExitCode {
    let wants_json = std::env::args_os().any(|argument| argument == "--json");
    if !error.use_stderr() {
        match error.kind() {
            clap::error::ErrorKind::DisplayVersion if wants_json => {
                print_json(&json!({ "name": "souple", "version": env!("CARGO_PKG_VERSION") }));
            }
            _ => drop(error.print()),
        }
        return ExitCode::SUCCESS;
    }
    if wants_json {
        let refusal = Refusal::request("arguments", "", "see `souple --help`", error.to_string().trim());
        print_json(&json!({ "errors": refusal.errors }));
    }
    let _ = error.print();
    ExitCode::from(WRONG_REQUEST)
}

/// Whether something could not be written to standard output, and not because its reader has gone away.
static OUTPUT_LOST: AtomicBool = AtomicBool::new(false);

/// One document on standard output.
pub fn print_json(document: &Value) {
    print_line(format_args!("{document:#}"));
}

/// One line on standard output. A reader that has gone away is no fault of ours; a full disk ends with status 1.
pub fn print_line(line: impl std::fmt::Display) {
    let mut out = std::io::stdout().lock();
    if let Err(error) = writeln!(out, "{line}").and_then(|()| out.flush())
        && error.kind() != std::io::ErrorKind::BrokenPipe
        && !OUTPUT_LOST.swap(true, Ordering::Relaxed)
    {
        print_note(format_args!("error: standard output cannot be written: {error}"));
    }
}

/// One line on standard error; where even that is closed, there is nobody left to tell. Characters that would steer a terminal
/// come from files that are quoted, and are shown as escapes.
pub fn print_note(line: impl std::fmt::Display) {
    let mut text = String::new();
    for character in line.to_string().chars() {
        match character {
            '\n' | '\t' => text.push(character),
            steering if steering.is_control() => text.extend(steering.escape_default()),
            plain => text.push(plain),
        }
    }
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}

/// ` (did you mean …?)` where a known name is near.
pub fn did_you_mean<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    souple_table::nearest(name, known).map(|name| format!(" (did you mean `{name}`?)")).unwrap_or_default()
}

/// Whether progress can be drawn over itself.
pub fn on_terminal() -> bool {
    std::io::stderr().is_terminal()
}

/// A whole number on the command line, at least `N`.
pub fn count<const N: u64>(text: &str) -> Result<u64, String> {
    let number = text.parse().ok().filter(|number| *number >= N);
    number.ok_or_else(|| format!("expected a whole number of at least {N}"))
}

/// A time on the command line [s]: a number of seconds, or a quantity such as `5 ms`.
pub fn seconds(text: &str) -> Result<f64, String> {
    let number = text.parse().or_else(|_| souple_formal::quantity_in(text, "s"));
    let has_number = text.contains(|letter: char| letter.is_ascii_digit());
    let number: f64 = number.map_err(|error| match has_number {
        true => error.to_string(),
        false => "expected a time, as 0.5 or 500 ms".to_owned(),
    })?;
    if number.is_finite() { Ok(number) } else { Err(format!("{number} is no time")) }
}

/// Reads a scene file.
pub fn read_scene(path: &str, settings: &[String]) -> Result<souple_scene::Scene, Refusal> {
    Ok(souple_scene::read_file(&scene_path(path), settings)?)
}

/// A scene is a file, or a folder with a `scene.toml`.
pub fn scene_path(path: &str) -> PathBuf {
    let path = PathBuf::from(path);
    let inside = path.join("scene.toml");
    if inside.is_file() { inside } else { path }
}

/// A number of threads on the command line.
pub fn thread_count(text: &str) -> Result<usize, String> {
    text.trim().parse().map_err(|_| "expected a whole number, 1 to 1024".to_owned())
}

/// What keeps the stages of threads, where a file is to tell of them; one that cannot be written is found out before the work.
pub fn timeline_of(file: Option<&PathBuf>) -> Result<Timeline, Refusal> {
    let Some(path) = file else { return Ok(Timeline::default()) };
    souple_io::may_be_written(path).map_err(|error| {
        let (value, expected) = (path.display().to_string(), "a file that can be written");
        Refusal::request("trace", value, expected, format!("--trace: {error}"))
    })?;
    Ok(Timeline::begin())
}

/// Writes the stages of threads where they are asked for, however the work ended. The refusal of what could not be written takes nothing from
/// what else the work came to.
pub fn write_trace(file: Option<&PathBuf>, timeline: &Timeline) -> Option<Refusal> {
    let written = souple_run::write_timeline(file?, timeline);
    if written.is_ok() && timeline.left_out() > 0 {
        let kept = timeline.spans().len();
        print_note(format_args!(
            "warning: the trace has the last {kept} stages; {} before them gave way",
            timeline.left_out()
        ));
    }
    written.err().map(|error| Refusal::work("io", format!("the trace is lost: {error}")))
}

impl End {
    /// The same where nothing more was lost; an interruption is told in any case.
    fn with(self, lost: Option<&Refusal>) -> Self {
        match (self, lost) {
            (Self::Done, Some(_)) => Self::Failed,
            (end, _) => end,
        }
    }
}

/// Sets the number of threads of the whole process.
pub fn use_threads(threads: Option<usize>) -> Result<(), Refusal> {
    let Some(threads) = threads else { return Ok(()) };
    let refuse = |message: String| Refusal::request("threads", threads.to_string(), "1 to 1024", message);
    if !(1..=1024).contains(&threads) {
        return Err(refuse(format!("{threads} threads cannot be had")));
    }
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build_global()
        .map_err(|error| refuse(error.to_string()))
}
