//! The released program, what it answers, and the scenes it is shipped with.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;

use serde_json::Value;

static ROOT: LazyLock<PathBuf> =
    LazyLock::new(|| Path::new(env!("CARGO_MANIFEST_DIR")).parent().map(Path::to_owned).unwrap_or_default());

/// Built once for all tests; fresh already where `cargo xtask test` built it before.
static PROGRAM: LazyLock<PathBuf> = LazyLock::new(|| {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let arguments = ["build", "--release", "--package", "souple", "--locked", "--quiet"];
    let status = Command::new(cargo).args(arguments).current_dir(&*ROOT).status().expect("cargo can be run");
    assert!(status.success(), "the program cannot be built: {status}");
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| PathBuf::from("target"), PathBuf::from);
    ROOT.join(target).join("release/souple").with_extension(std::env::consts::EXE_EXTENSION)
});

/// What the program did.
pub struct Run {
    /// `None`: a signal ended it.
    pub status: Option<i32>,
    pub output: String,
    pub errors: String,
}

impl Run {
    /// The one document on its standard output.
    pub fn json(&self) -> Value {
        serde_json::from_str(&self.output)
            .unwrap_or_else(|error| panic!("{error} in {:?}; it said {}", self.output, self.errors))
    }
}

/// Runs the program in the root of the project.
pub fn souple(arguments: &[&str]) -> Run {
    let output =
        Command::new(&*PROGRAM).args(arguments).current_dir(&*ROOT).output().expect("the program can be run");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    Run { status: output.status.code(), output: text(&output.stdout), errors: text(&output.stderr) }
}

/// Names of the folders of `scenes/`, sorted.
pub fn scenes() -> Vec<String> {
    let folders = std::fs::read_dir(ROOT.join("scenes")).expect("there is a folder of scenes");
    let mut names: Vec<String> = folders
        .map(|entry| entry.expect("the folder of scenes can be read").path())
        .filter(|path| path.join("scene.toml").is_file())
        .map(|path| path.file_name().unwrap_or_default().to_string_lossy().into_owned())
        .collect();
    names.sort();
    assert!(!names.is_empty(), "no scene is shipped");
    names
}

/// An empty folder for what a test writes.
pub fn scratch(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    if folder.exists() {
        std::fs::remove_dir_all(&folder).expect("what the last run of the test wrote can be removed");
    }
    std::fs::create_dir_all(&folder).expect("the folder can be made");
    folder
}
