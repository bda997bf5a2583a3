//! The SQLite file of a study: runs, their parameters and their results.
//!
//! `runs` has the whole report as JSON; `parameters` and `results` have it in rows, for queries:
//! `select number, last from parameters join results using (run) where path = '…' and name = '…'`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use rusqlite::{Connection, OptionalExtension, params};
use serde_json::Value;
use souple_run::{Outcome, Status};

use crate::SweepError;
use crate::study::Plan;

/// Results of a study.
pub struct Database {
    connection: Connection,
    path: PathBuf,
}

const TABLES: &str = "
create table if not exists study (key text primary key, value text not null);
create table if not exists runs (
    run integer primary key,
    scene_sha256 text not null,
    steps integer,
    settings text not null,
    status text not null,
    binary text not null,
    wall_seconds real not null,
    failure text,
    report text not null,
    unique (scene_sha256, steps)
);
create table if not exists parameters (
    run integer not null references runs (run) on delete cascade,
    path text not null,
    value text not null,
    number real,
    primary key (run, path)
);
create table if not exists results (
    run integer not null references runs (run) on delete cascade,
    name text not null,
    component integer not null,
    unit text not null,
    first real,
    last real,
    least real,
    greatest real,
    primary key (run, name, component)
);
";

/// A run as the file holds it.
#[derive(Clone, Debug)]
pub struct Stored {
    pub status: String,
    pub binary: String,
    pub wall_seconds: f64,
    /// By name and component.
    pub results: BTreeMap<(String, usize), Held>,
}

/// What a run left of one number.
#[derive(Clone, Debug)]
pub struct Held {
    pub unit: String,
    pub first: Option<f64>,
    pub last: Option<f64>,
    pub least: Option<f64>,
    pub greatest: Option<f64>,
}

impl Database {
    /// Opens the file, or makes it for the study of that scene.
    ///
    /// # Errors
    /// It cannot be opened, is no SQLite file, or is of another scene.
    pub fn open(path: &Path, scene: &str) -> Result<Self, SweepError> {
        let of = |source| SweepError::Database { path: path.to_owned(), source };
        let connection = Connection::open(path).map_err(of)?;
        connection.execute_batch("pragma foreign_keys = on;").map_err(of)?;
        connection.execute_batch(TABLES).map_err(of)?;
        let found: Option<String> = connection
            .query_row("select value from study where key = 'scene'", [], |row| row.get(0))
            .optional()
            .map_err(of)?;
        if let Some(found) = found.filter(|found| found != scene) {
            return Err(SweepError::OtherStudy { path: path.to_owned(), found, wanted: scene.to_owned() });
        }
        connection.execute("insert or ignore into study values ('scene', ?1)", [scene]).map_err(of)?;
        Ok(Self { connection, path: path.to_owned() })
    }

    fn fault(&self) -> impl Fn(rusqlite::Error) -> SweepError + '_ {
        |source| SweepError::Database { path: self.path.clone(), source }
    }

    /// The run of that scene with its settings, if it was made.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn find(&self, scene_sha256: &str, steps: Option<u64>) -> Result<Option<Stored>, SweepError> {
        let of_run =
            "select run, status, binary, wall_seconds from runs where scene_sha256 = ?1 and steps = ?2";
        let row = self
            .connection
            .query_row(of_run, params![scene_sha256, steps_column(steps)], |row| {
                Ok((row.get::<_, i64>(0)?, row.get(1)?, row.get(2)?, row.get(3)?))
            })
            .optional()
            .map_err(self.fault())?;
        let Some((run, status, binary, wall_seconds)) = row else { return Ok(None) };
        let of_results =
            "select name, component, unit, first, last, least, greatest from results where run = ?1";
        let mut statement = self.connection.prepare_cached(of_results).map_err(self.fault())?;
        let rows = statement
            .query_map([run], |row| {
                let key = (row.get(0)?, row.get::<_, i64>(1)? as usize);
                let held = Held {
                    unit: row.get(2)?,
                    first: row.get(3)?,
                    last: row.get(4)?,
                    least: row.get(5)?,
                    greatest: row.get(6)?,
                };
                Ok((key, held))
            })
            .map_err(self.fault())?;
        let results = rows.collect::<Result<_, _>>().map_err(self.fault())?;
        Ok(Some(Stored { status, binary, wall_seconds, results }))
    }

    /// Puts a run in the place of an earlier one of the same scene, settings and steps; all of it or nothing.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn store(&mut self, plan: &Plan, steps: Option<u64>, outcome: &Outcome) -> Result<(), SweepError> {
        let path = self.path.clone();
        let of = |source| SweepError::Database { path: path.clone(), source };
        let report = &outcome.report;
        let transaction = self.connection.transaction().map_err(of)?;
        let sha = &report.scene_sha256;
        transaction
            .execute(
                "delete from runs where scene_sha256 = ?1 and steps = ?2",
                params![sha, steps_column(steps)],
            )
            .map_err(of)?;
        transaction
            .execute(
                "insert into runs (scene_sha256, steps, settings, status, binary, wall_seconds, failure, report) \
                 values (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)",
                params![
                    sha,
                    steps_column(steps),
                    Value::from(plan.settings()).to_string(),
                    report.status.as_str(),
                    souple_run::binary(),
                    report.wall_seconds,
                    report.failure.as_ref().map(souple_run::Failure::message),
                    report.to_json().to_string(),
                ],
            )
            .map_err(of)?;
        let run = transaction.last_insert_rowid();
        for (path, value) in &plan.values {
            transaction
                .execute(
                    "insert into parameters values (?1, ?2, ?3, ?4)",
                    params![run, path, plain(value), number(value)],
                )
                .map_err(of)?;
        }
        for probe in &report.probes {
            for component in 0..probe.last.len() {
                let at = |values: &[f64]| values.get(component).copied().filter(|value| value.is_finite());
                transaction
                    .execute(
                        "insert into results values (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)",
                        params![
                            run,
                            probe.name,
                            component as i64,
                            probe.unit,
                            at(&probe.first),
                            at(&probe.last),
                            at(&probe.min),
                            at(&probe.max)
                        ],
                    )
                    .map_err(of)?;
            }
        }
        transaction.commit().map_err(of)
    }
}

/// Steps as the file has them: -1 for the scene's own end, since two nulls are not equal.
fn steps_column(steps: Option<u64>) -> i64 {
    steps.map_or(-1, |steps| steps as i64)
}

/// Whether a run that ended so is kept: one that was interrupted is made again.
pub fn is_kept(status: Status) -> bool {
    status != Status::Interrupted
}

/// A value as people write it: texts without quotes.
pub fn plain(value: &toml::Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// The number of a value, where it is one, in SI units where it has one.
pub fn number(value: &toml::Value) -> Option<f64> {
    match value {
        toml::Value::Integer(number) => Some(*number as f64),
        toml::Value::Float(number) => Some(*number),
        toml::Value::String(text) => Some(souple_formal::parse_quantity(text).ok()?.value),
        _ => None,
    }
}
