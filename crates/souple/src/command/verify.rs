//! `souple verify`: the validation cases.

use serde_json::Value;
use souple_verify::Row;

use super::{End, Refusal, did_you_mean, print_json, print_line};

#[derive(clap::Args)]
pub struct Arguments {
    /// Ids of cases or capabilities; all where none is named
    ids: Vec<String>,
    /// Names the cases without running them
    #[arg(long)]
    list: bool,
    /// Runs every case under its mutation instead: each row must fail
    #[arg(long)]
    mutations: bool,
    /// Cases at once; as many as there are cores where left out
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..=1024))]
    jobs: Option<u64>,
    #[arg(long)]
    pub json: bool,
}

pub fn verify(arguments: &Arguments) -> Result<End, Refusal> {
    let cases = souple_verify::cases(&arguments.ids).map_err(|unknown| {
        let hint = did_you_mean(&unknown, souple_verify::all().map(|case| case.id));
        let message = format!("there is no case `{unknown}`{hint}");
        Refusal::request("unknown_case", &unknown, "an id that `souple verify --list` prints", message)
    })?;
    if arguments.list {
        let rows: Vec<Value> = cases.iter().map(|case| case.to_json()).collect();
        if arguments.json {
            print_json(&Value::Array(rows));
        } else {
            cases.iter().for_each(|case| print_line(format_args!("{:32} {}", case.id, case.what)));
        }
        return Ok(End::Done);
    }
    // under its mutation a case that still holds, or whose scene is refused, sees nothing
    let is_as_wanted = |row: &Row| if arguments.mutations { row.sees_mutation() } else { row.pass };
    let verdict = if arguments.mutations { "seen" } else { "ok" };
    let mut tell = |row: &Row| {
        if !arguments.json {
            print_line(format_args!("{:4} {row}", if is_as_wanted(row) { verdict } else { "FAIL" }));
        }
    };
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let jobs = arguments.jobs.map_or(cores, |jobs| jobs as usize);
    let rows = souple_verify::suite::run(&cases, arguments.mutations, jobs, &mut tell)
        .map_err(|message| Refusal::work("threads", message))?;
    let failed: Vec<&str> = rows.iter().filter(|row| !is_as_wanted(row)).map(|row| row.case.id).collect();
    if arguments.json {
        print_json(&Value::Array(rows.iter().map(Row::to_json).collect()));
    } else {
        let verb = if arguments.mutations { "fail under their mutation, as they must" } else { "hold" };
        print_line(format_args!("{} of {} rows {verb}", rows.len() - failed.len(), rows.len()));
        if !failed.is_empty() {
            print_line(format_args!("not so: {}", failed.join(", ")));
        }
    }
    Ok(if failed.is_empty() { End::Done } else { End::Failed })
}
