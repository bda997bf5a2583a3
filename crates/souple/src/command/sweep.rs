//! `souple sweep`: the runs of a study, their table and graphs.

use std::path::{Path, PathBuf};

use serde_json::json;
use souple_io::Column;
use souple_sweep::{
    Database, Ending, Fit, FoundMotion, KeyState, Kind, Motion, Planner, Progress, Search, Seen, Study,
    SweepError, Tabulation, Tabulator, Unknown, When, Windows, Workers, fingerprints, graphs,
    sweep as make_runs, table_of,
};
use souple_table::{counted, with_unit};

use super::progress::Meter;
use super::{End, Refusal, interruption, print_json, print_line, print_note};

#[derive(clap::Args)]
pub struct Arguments {
    /// A study: a TOML file with a scene and what varies
    study: PathBuf,
    /// SQLite file of the results, beside which table and graphs go, of a fit the CSV file of the curve, or of a plan that of the
    /// commands; beside the study and named like it where left out
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Runs at once; as many as the machine has cores where left out
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..=1024))]
    jobs: Option<u64>,
    /// Worker threads of each run
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..=1024))]
    threads: u64,
    /// Makes runs again that the file holds
    #[arg(long)]
    again: bool,
    #[arg(long)]
    pub json: bool,
    /// No progress and no table
    #[arg(long)]
    quiet: bool,
}

impl From<SweepError> for Refusal {
    fn from(error: SweepError) -> Self {
        let message = error.to_string();
        match error {
            SweepError::At { path, line, column, error } => {
                let key =
                    if let SweepError::Value { path, .. } = &*error { path.clone() } else { String::new() };
                let mut refusal = Self::from(*error);
                for error in &mut refusal.errors {
                    error["file"] = json!(path.display().to_string());
                    (error["line"], error["column"]) = (json!(line), json!(column));
                    (error["path"], error["message"]) = (json!(key), json!(message));
                }
                refusal
            }
            SweepError::Value { value, expected, .. } => Self::request("study", value, expected, message),
            SweepError::Read { .. } | SweepError::Syntax { .. } => {
                Self::request("study", "", "a study: TOML with `scene` and `vary`, `fit` or `plan`", message)
            }
            SweepError::Plan { found, expected, .. } => Self::request("plan", found, expected, message),
            SweepError::Scene { settings, .. } => {
                Self::request("study", settings, "values that the scene takes", message)
            }
            SweepError::Failed { .. }
            | SweepError::Beyond { .. }
            | SweepError::Unmet { .. }
            | SweepError::Starts { .. } => Self::work("run", message),
            SweepError::OtherStudy { found, .. } => {
                Self::request("database", found, "a file of this study", message)
            }
            SweepError::Database { .. } | SweepError::Threads(_) => Self::work("database", message),
            SweepError::Io(error) => error.into(),
        }
    }
}

pub fn sweep(arguments: &Arguments) -> Result<End, Refusal> {
    let study = Study::read(&arguments.study)?;
    if let Some(fit) = &study.fit {
        return identify(arguments, &study, fit);
    }
    if let Some(motion) = &study.motion {
        return plan(arguments, &study, motion);
    }
    if let Some(tabulation) = &study.tabulation {
        return tabulate(arguments, &study, tabulation);
    }
    let out = arguments.out.clone().unwrap_or_else(|| arguments.study.with_extension("sqlite"));
    let mut database = Database::open(&out, &study.scene.display().to_string())?;
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let workers = Workers {
        count: arguments.jobs.map_or(cores, |jobs| jobs as usize),
        threads: arguments.threads as usize,
        again: arguments.again,
    };
    let interruption = interruption::heed();
    let meter = Meter::new("runs", arguments.quiet);
    let mut watch = |progress: Progress| meter.show(progress.done as u64, progress.runs as u64, "");
    let fingerprints = fingerprints(&study, workers)?;
    let summary = make_runs(&study, &fingerprints, &mut database, workers, &interruption, &mut watch)?;
    drop(meter);
    let table = table_of(&study, &fingerprints, &database)?;
    let csv = out.with_extension("csv");
    table.write_csv(&csv)?;
    let mut files = vec![out.clone(), csv];
    if !table.rows.is_empty() {
        files.extend(graphs::write(&study, &table, &out)?);
    }
    if summary.of_others > 0 {
        print_note(format_args!(
            "warning: {} made by another program; --again makes all of them anew",
            counted(summary.of_others as u64, "run")
        ));
    }
    let names: Vec<String> = files.iter().map(|file| file.display().to_string()).collect();
    let cells = table.cells();
    if arguments.json {
        print_json(&json!({
            "title": study.title,
            "scene": study.scene.display().to_string(),
            "runs": study.runs.len(),
            "made": summary.made,
            "held": summary.held,
            "failed": summary.failed,
            "interrupted": summary.interrupted,
            "table": cells,
            "files": names,
        }));
    } else if !arguments.quiet {
        print_table(&cells);
        print_line(format_args!(
            "{}: {} made, {} held, {} failed",
            counted(study.runs.len() as u64, "run"),
            summary.made,
            summary.held,
            summary.failed
        ));
        names.iter().for_each(|name| print_line(format_args!("  {name}")));
    }
    if interruption::is_interrupted() {
        return Ok(End::Interrupted);
    }
    Ok(if summary.failed > 0 { End::Failed } else { End::Done })
}

/// Looks for the values of a fit, and writes the curve that they give beside the measured one.
fn identify(arguments: &Arguments, study: &Study, fit: &Fit) -> Result<End, Refusal> {
    refuse_options(arguments, "fit", &["--jobs", "--out"])?;
    let out = arguments.out.clone().unwrap_or_else(|| arguments.study.with_extension("fit.csv"));
    keep_inputs(&out, &[&arguments.study, &study.scene, &fit.curve_file])?;
    let abscissa = fit.over.as_ref().map_or("time [s]", |over| over.name.as_str());
    let names = [abscissa, MEASURED, &fit.probe.name];
    keep_others(&out, &names)?;
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let interruption = interruption::heed();
    let count = arguments.jobs.map_or(cores, |jobs| jobs as usize);
    let search = Search { study, fit, count, stop: &interruption };
    let meter = Meter::new("iterations", arguments.quiet);
    let mut watch = |iterations: usize, residual: f64| {
        meter.show(iterations as u64, fit.iterations as u64, format!("residual {residual:.3e}"));
    };
    let found = search.run(&mut watch)?;
    drop(meter);
    let Some(found) = found else { return Ok(End::Interrupted) };
    let column =
        |index: usize| Column::new(names[index], found.curve.iter().map(|point| point[index]).collect());
    let columns = [column(0), column(1), column(2)];
    souple_io::write_csv(&out, &columns)?;
    let of_values = fit.unknowns.iter().zip(&found.values);
    let alike: Vec<&str> = found.alike.iter().map(|index| fit.unknowns[*index].path.as_str()).collect();
    if arguments.json {
        let value = |(unknown, (value, error)): (&Unknown, &(f64, Option<f64>))| {
            json!({
                "path": unknown.path,
                "value": value,
                "standard_error": error,
                "unit": unknown.unit,
                "is_at_bound": unknown.bounds.contains(value),
                "setting": unknown.setting(*value),
            })
        };
        print_json(&json!({
            "title": study.title,
            "scene": study.scene.display().to_string(),
            "values": of_values.map(value).collect::<Vec<_>>(),
            "residual": found.residual,
            "explained": found.explained,
            "iterations": found.iterations,
            "runs": found.runs,
            "converged": found.ending == Ending::Converged,
            "alike": alike,
            "points": found.curve.len(),
            "files": [out.display().to_string()],
        }));
    } else if !arguments.quiet {
        for (unknown, (value, error)) in of_values {
            let error = error.map_or("unknown error".to_owned(), |error| format!("± {error:.2e}"));
            let bound = if unknown.bounds.contains(value) { ", at a bound" } else { "" };
            let unit = if unknown.unit.is_empty() { String::new() } else { format!(" {}", unknown.unit) };
            print_line(format_args!("{} = {value:.9e} {error}{unit}{bound}", unknown.path));
        }
        let explained =
            found.explained.map_or(String::new(), |share| format!(", {share:.6} of the variance explained"));
        print_line(format_args!(
            "residual {:.3e}{explained}, {}, {}",
            found.residual,
            counted(found.iterations as u64, "iteration"),
            counted(found.runs as u64, "run")
        ));
        print_line(format_args!("  {}", out.display()));
    }
    if !found.alike.is_empty() {
        print_note(format_args!(
            "warning: the curve does not tell {} apart: other values of {} give the same; fix one, or measure something else",
            alike.join(", "),
            if alike.len() == 1 { "it" } else { "them" }
        ));
    }
    let iterations = counted(found.iterations as u64, "iteration");
    match found.ending {
        Ending::Converged => return Ok(End::Done),
        Ending::Interrupted => return Ok(End::Interrupted),
        Ending::Stalled => print_note(format_args!(
            "warning: it ended after {iterations} at values that no step betters, though slopes say that they are not the best: the probe \
             may leap with a value, or runs beside it fail"
        )),
        Ending::OutOfIterations => {
            print_note(format_args!("warning: it ended after {iterations}, before steps were small enough"));
        }
    }
    Ok(End::Failed)
}

/// Looks for the commands of a plan, and writes them where a scene may read them.
fn plan(arguments: &Arguments, study: &Study, motion: &Motion) -> Result<End, Refusal> {
    let how = match &motion.kind {
        Kind::Spacetime(how) => Some(how),
        Kind::LinearQuadratic { .. } => None,
    };
    let has_starts = how.is_some_and(|how| how.starts > 1);
    refuse_options(arguments, "plan", if has_starts { &["--jobs", "--out"] } else { &["--out"] })?;
    let out = arguments.out.clone().unwrap_or_else(|| arguments.study.with_extension("plan.csv"));
    let start = how.and_then(|how| how.start.as_ref());
    let inputs: Vec<&PathBuf> = [&arguments.study, &study.scene].into_iter().chain(start).collect();
    keep_inputs(&out, &inputs)?;
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let interruption = interruption::heed();
    let meter = Meter::new("iterations", arguments.quiet);
    let watch = |seen: Seen| {
        let of = seen.starts.map_or(String::new(), |[over, all]| format!("start {over} of {all} over, "));
        let message = match seen.came_to {
            Some([cost, miss]) => format!("{of}cost {cost:.4e}, miss {miss:.1e}"),
            None => format!("{of}without a motion"),
        };
        meter.show(seen.iterations as u64, motion.iterations as u64, message);
    };
    let count = arguments.jobs.map_or(cores, |jobs| jobs as usize);
    let found = Planner { study, motion, count, stop: &interruption }.run(&watch)?;
    drop(meter);
    let Some(found) = found else {
        print_note(format_args!("interrupted before a plan was found: {} is not written", out.display()));
        return Ok(End::Interrupted);
    };
    let columns = found.columns();
    let names: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
    keep_others(&out, &names)?;
    souple_io::write_csv(&out, &columns)?;
    if arguments.json {
        print_json(&told(study, motion, &found, &out));
    } else if !arguments.quiet {
        print_plan(motion, &found, &out);
    }
    found.warnings.iter().for_each(|warning| print_note(format_args!("warning: {warning}")));
    if found.ending == Ending::Converged {
        return Ok(End::Done);
    }
    let iterations = counted(found.iterations as u64, "iteration");
    let has_windows = how.is_some_and(|how| how.windows != Windows::Whole);
    let less = if has_windows { "; `plan.windows` that are longer or share more take fewer" } else { "" };
    let why = match found.ending {
        Ending::Stalled => format!("no step came nearer after {iterations}"),
        _ => {
            format!(
                "it was still on its way after {iterations}, as many as there may be (`plan.iterations`{less})"
            )
        }
    };
    print_note(format_args!("warning: {why}: keys or the least effort are not reached"));
    Ok(End::Failed)
}

/// What was found of a plan, as JSON.
fn told(study: &Study, motion: &Motion, found: &FoundMotion, out: &Path) -> serde_json::Value {
    let key = |(key, (reached, unit)): (&KeyState, (&f64, &&str))| {
        let mut told = match key.when {
            When::At(time) => json!({"time": time}),
            When::During([from, until]) => json!({"from": from, "until": until}),
        };
        told["probe"] = json!(key.probe.to_string());
        match key.band {
            [low, high] if low == high => told["value"] = json!(low),
            band => {
                for (name, side) in
                    ["least", "most"].into_iter().zip(band).filter(|(_, side)| side.is_finite())
                {
                    told[name] = json!(side);
                }
            }
        }
        told["reached"] = json!(reached);
        told["unit"] = json!(unit);
        told
    };
    let keys = motion.keys.iter().zip(found.reached.iter().zip(&found.units)).map(key);
    let attempts = found.attempts.iter().map(|attempt| {
        let message = Some(&attempt.message).filter(|message| !message.is_empty());
        json!({"cost": attempt.cost, "message": message})
    });
    json!({
        "title": study.title,
        "scene": study.scene.display().to_string(),
        "controls": found.commands.iter().map(|(name, _)| name).collect::<Vec<_>>(),
        "gains": found.gains.iter().map(|gain| &gain.number).collect::<Vec<_>>(),
        "cost": found.cost,
        "keys": keys.collect::<Vec<_>>(),
        "starts": attempts.collect::<Vec<_>>(),
        "warnings": found.warnings,
        "iterations": found.iterations,
        "steps": found.steps,
        "converged": found.ending == Ending::Converged,
        "files": [out.display().to_string()],
    })
}

fn print_plan(motion: &Motion, found: &FoundMotion, out: &Path) {
    for (key, (reached, unit)) in motion.keys.iter().zip(found.reached.iter().zip(&found.units)) {
        let reached = with_unit(&format!("{reached:.9e}"), unit);
        print_line(format_args!("{} {}: {reached}, for {}", key.probe, key.when, key.wanted(unit)));
    }
    let unit = if matches!(motion.kind, Kind::Spacetime(_)) { "N² s" } else { "" };
    print_line(format_args!(
        "cost {}, {}, {} stepped",
        with_unit(&format!("{:.9e}", found.cost), unit),
        counted(found.iterations as u64, "iteration"),
        counted(found.steps as u64, "period")
    ));
    for (cost, count) in found.answers() {
        let of = counted(found.attempts.len() as u64, "start");
        print_line(format_args!("{count} of {of} came to {}", with_unit(&format!("{cost:.6e}"), unit)));
    }
    for message in found.without_answer() {
        print_line(format_args!("without an answer {message}"));
    }
    print_line(format_args!("  {}", out.display()));
}

/// Looks for the table of commands over a state space, and writes it where a scene may read it.
fn tabulate(arguments: &Arguments, study: &Study, tabulation: &Tabulation) -> Result<End, Refusal> {
    refuse_options(arguments, "plan", &["--jobs", "--out"])?;
    let out = arguments.out.clone().unwrap_or_else(|| arguments.study.with_extension("table.csv"));
    keep_inputs(&out, &[&arguments.study, &study.scene])?;
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let interruption = interruption::heed();
    let count = arguments.jobs.map_or(cores, |jobs| jobs as usize);
    let meter = Meter::new("shots", arguments.quiet);
    let watch = |done: usize, all: usize| meter.show(done as u64, all as u64, "");
    let found = Tabulator { study, tabulation, count, stop: &interruption }.run(&watch)?;
    drop(meter);
    let Some(found) = found else { return Ok(End::Interrupted) };
    let columns = found.columns();
    let names: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
    keep_others(&out, &names)?;
    souple_io::write_csv(&out, &columns)?;
    let (unreached, first) = found.unreached();
    let from_start = found.from_start.filter(|value| value.is_finite());
    if arguments.json {
        print_json(&json!({
            "title": study.title,
            "scene": study.scene.display().to_string(),
            "controls": found.commands.iter().map(|(name, _)| name).collect::<Vec<_>>(),
            "states": found.values.len(),
            "unreached": unreached,
            "from_start": from_start,
            "shots": found.shots,
            "failed": found.failed,
            "iterations": found.iterations,
            "converged": found.is_converged,
            "files": [out.display().to_string()],
        }));
    } else if !arguments.quiet {
        print_line(format_args!(
            "{}, {}, {}",
            counted(found.values.len() as u64, "state"),
            counted(found.shots as u64, "shot"),
            counted(found.iterations as u64, "iteration")
        ));
        if let Some(value) = from_start {
            print_line(format_args!("from the start of the scene it costs {value:.9e} s"));
        }
        print_line(format_args!("  {}", out.display()));
    }
    if let Some(first) = first {
        print_note(format_args!(
            "note: from {} nothing leads to the target within the table, such as {first}",
            counted(unreached as u64, "state")
        ));
    }
    if from_start.is_none() {
        print_note(format_args!(
            "warning: from the start of the scene nothing leads to the target within the table"
        ));
    }
    if found.failed > 0 {
        let failed = counted(found.failed as u64, "shot");
        print_note(format_args!(
            "warning: {failed} could not be stepped, and count as ways that lead nowhere"
        ));
    }
    if found.is_converged {
        return Ok(End::Done);
    }
    print_note(format_args!(
        "warning: it ended after {}, before values stood",
        counted(found.iterations as u64, "iteration")
    ));
    Ok(End::Failed)
}

/// Refuses options of runs that vary, but for those that a study of this `kind` takes.
fn refuse_options(arguments: &Arguments, kind: &str, taken: &[&str]) -> Result<(), Refusal> {
    let given = [
        ("--again", arguments.again),
        ("--threads", arguments.threads > 1),
        ("--jobs", arguments.jobs.is_some()),
    ];
    match given.into_iter().find(|(option, is_given)| *is_given && !taken.contains(option)) {
        None => Ok(()),
        Some((option, _)) => {
            let message = format!(
                "{option} is of runs that vary; a study with a `{kind}` takes {}",
                taken.join(" and ")
            );
            Err(Refusal::request("option", option, taken.join(", "), message))
        }
    }
}

/// Refuses to write over what a study is read from.
fn keep_inputs(out: &Path, inputs: &[&PathBuf]) -> Result<(), Refusal> {
    let Ok(place) = out.canonicalize() else { return Ok(()) };
    match inputs.iter().find(|input| input.canonicalize().is_ok_and(|input| input == place)) {
        None => Ok(()),
        Some(_) => {
            let found = out.display().to_string();
            let message = format!("{found} is what the study is read from; expected another file in `--out`");
            Err(Refusal::request("option", found, "a file that the study does not read", message))
        }
    }
}

/// The name of the second column of what a fit writes.
const MEASURED: &str = "measured";

/// Refuses to write over what no study of these columns has written, among it the results of others.
fn keep_others(out: &Path, names: &[&str]) -> Result<(), Refusal> {
    use std::io::Read as _;
    let Ok(file) = std::fs::File::open(out) else { return Ok(()) };
    let mut head = Vec::new();
    // names of probes are no longer; what cannot be read cannot be written, which is told then
    if file.take(4096).read_to_end(&mut head).is_err() || head.is_empty() {
        return Ok(());
    }
    let line = head.split(|byte| *byte == b'\n').next().unwrap_or_default();
    let columns = names.iter().map(|name| souple_io::csv_cell(name)).collect::<Vec<_>>().join(",");
    if String::from_utf8_lossy(line).trim_end() == columns {
        return Ok(());
    }
    let found = out.display().to_string();
    let message = format!(
        "{found} is there, and nothing that this study has written, whose columns are {columns}; expected a new file in `--out`, or one that \
         it has written"
    );
    Err(Refusal::request("option", found, "a new file, or one that this study has written", message))
}

/// Columns under each other.
fn print_table(cells: &[Vec<String>]) {
    let columns = cells.first().map_or(0, Vec::len);
    let width = |column: usize| cells.iter().map(|line| line[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns).map(width).collect();
    for line in cells {
        let padded: Vec<String> =
            line.iter().zip(&widths).map(|(cell, width)| format!("{cell:<width$}")).collect();
        print_line(padded.join("  ").trim_end());
    }
}
