//! What the tests of the command line share: the program, its answers, scenes, folders that go away.

// each test binary uses its own part of this
#![allow(dead_code)]

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::atomic::{AtomicU64, Ordering};

use serde_json::Value;

/// The folder of the shipped scenes.
pub fn scenes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes")
}

/// Names of the folders in `scenes/`, sorted.
pub fn scene_names() -> Vec<String> {
    let entries = std::fs::read_dir(scenes()).expect("the folder of scenes");
    let mut names: Vec<String> = entries
        .map(|entry| entry.expect("an entry"))
        .filter(|entry| entry.path().is_dir())
        .map(|entry| entry.file_name().into_string().expect("a name in Unicode"))
        .collect();
    names.sort();
    names
}

/// The program, not yet started.
pub fn command() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_souple"));
    command.stdin(Stdio::null());
    command
}

/// What a call of the program gave.
#[derive(Debug)]
pub struct Answer {
    /// The call, for messages.
    pub call: String,
    /// `None`: ended by a signal.
    pub status: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl Answer {
    pub fn of(call: String, output: Output) -> Self {
        Self {
            call,
            status: output.status.code(),
            stdout: String::from_utf8(output.stdout).expect("text on standard output"),
            stderr: String::from_utf8(output.stderr).expect("text on standard error"),
        }
    }

    /// The same answer, its status being as it must.
    #[track_caller]
    pub fn ends(self, status: i32) -> Self {
        assert_eq!(self.status, Some(status), "{self:#?}");
        assert!(!self.stderr.contains("panicked"), "{self:#?}");
        self
    }

    /// Standard output as the one JSON document that it must be.
    #[track_caller]
    pub fn json(&self) -> Value {
        let parsed = serde_json::from_str(&self.stdout);
        parsed.unwrap_or_else(|error| panic!("not one JSON document: {error}\n{self:#?}"))
    }
}

/// Calls the program and waits for it.
pub fn souple<S: AsRef<OsStr>>(arguments: impl IntoIterator<Item = S>) -> Answer {
    souple_in(Path::new("."), arguments)
}

/// The same, in a folder.
pub fn souple_in<S: AsRef<OsStr>>(folder: &Path, arguments: impl IntoIterator<Item = S>) -> Answer {
    let mut command = command();
    command.current_dir(folder).args(arguments);
    let call = format!("{command:?}");
    Answer::of(call, command.output().expect("the program starts"))
}

/// A folder of its own for a test, removed at the end.
pub struct Folder(PathBuf);

impl Folder {
    pub fn new(name: &str) -> Self {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let count = COUNT.fetch_add(1, Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!("souple_{name}_{}_{count}", std::process::id()));
        std::fs::create_dir_all(&path).expect("a temporary folder");
        Self(path)
    }

    pub fn path(&self) -> &Path {
        &self.0
    }

    /// A file in it, as an argument.
    pub fn at(&self, name: &str) -> String {
        self.0.join(name).display().to_string()
    }

    /// Writes a file and gives its path.
    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> String {
        std::fs::write(self.0.join(name), content).expect("a file is written");
        self.at(name)
    }

    /// All files below it, relative, sorted.
    pub fn files(&self) -> Vec<String> {
        let mut found = Vec::new();
        let mut folders = vec![self.0.clone()];
        while let Some(folder) = folders.pop() {
            for entry in std::fs::read_dir(folder).expect("a folder") {
                let path = entry.expect("an entry").path();
                if path.is_dir() {
                    folders.push(path);
                } else {
                    found.push(path.strip_prefix(&self.0).expect("a path below").display().to_string());
                }
            }
        }
        found.sort();
        found
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // what cannot be removed from a temporary folder does no harm
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// A small scene: a cube of eight hexahedra that falls freely, ten steps of it.
pub const CUBE: &str = r#"format = 1
title = "A cube in free fall"
[world]
period = "10 ms"
gravity = [0, -9.81, 0]
[bodies.cube]
mesh = { generate = "box", size = [1, 1, 1], cells = [2, 2, 2], element = "hex8" }
material = { name = "neo_hookean", youngs_modulus = "20 kPa", poissons_ratio = 0.3, density = 1000 }
[probes.place]
body = "cube"
quantity = "position"
[run]
duration = "100 ms"
frames = 5
"#;

/// The keys that `report.json` has by contract.
pub const REPORT_KEYS: &[&str] = &[
    "version",
    "schema",
    "status",
    "scene",
    "scene_sha256",
    "settings",
    "binary",
    "isa",
    "threads",
    "seed",
    "steps",
    "simulated_seconds",
    "wall_seconds",
    "real_time_factor",
    "peak_bytes",
    "counts",
    "stages_ms",
    "energy",
    "momentum",
    "solver",
    "probes",
    "hashes",
    "expectations",
    "error",
    "warnings",
];

/// The keys that every error has by contract.
pub const ERROR_KEYS: &[&str] = &["code", "file", "line", "column", "path", "value", "expected", "message"];

/// A report that has all its keys.
#[track_caller]
pub fn assert_report(report: &Value) {
    for key in REPORT_KEYS {
        assert!(report.get(key).is_some(), "`{key}` is not in {report:#}");
    }
}

/// `{errors: […]}` with at least one error and all keys in each.
#[track_caller]
pub fn assert_errors(document: &Value) {
    let errors = document["errors"].as_array().unwrap_or_else(|| panic!("no errors in {document:#}"));
    assert!(!errors.is_empty(), "{document:#}");
    for error in errors {
        for key in ERROR_KEYS {
            assert!(error.get(key).is_some(), "`{key}` is not in {error:#}");
        }
        assert!(error["message"].as_str().is_some_and(|text| !text.is_empty()), "{error:#}");
    }
}
