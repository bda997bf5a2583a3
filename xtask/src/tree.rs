//! The files of the project, and the commands that run in it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::failure::Failure;

/// Folders of what is made, not written.
const MADE: [&str; 4] = [".git", "target", "out", "node_modules"];

/// The working tree.
pub struct Tree {
    pub root: PathBuf,
}

impl Tree {
    /// The tree that cargo runs this program in, or that it was built from.
    pub fn of_this_project() -> Self {
        let built_from = || env!("CARGO_MANIFEST_DIR").into();
        let own = PathBuf::from(std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_else(built_from));
        Self { root: own.parent().map(Path::to_owned).unwrap_or_default() }
    }

    /// Every written file, relative to the root, with forward slashes, sorted.
    pub fn files(&self) -> Result<Vec<String>, Failure> {
        let mut files = Vec::new();
        let mut folders = vec![self.root.clone()];
        while let Some(folder) = folders.pop() {
            let fail = |error| Failure::File { path: folder.clone(), error };
            for entry in fs::read_dir(&folder).map_err(fail)? {
                let path = entry.map_err(fail)?.path();
                let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
                if MADE.contains(&name.as_str()) || name.starts_with("target-") {
                    continue;
                }
                if path.is_dir() {
                    folders.push(path);
                } else if let Ok(relative) = path.strip_prefix(&self.root) {
                    files.push(relative.to_string_lossy().replace('\\', "/"));
                }
            }
        }
        files.sort();
        Ok(files)
    }

    /// The text of a file relative to the root.
    pub fn read(&self, file: &str) -> Result<String, Failure> {
        let path = self.root.join(file);
        fs::read_to_string(&path).map_err(|error| Failure::File { path, error })
    }

    /// The text of a file, or nothing if it is no text.
    pub fn read_if_text(&self, file: &str) -> Result<Option<String>, Failure> {
        let path = self.root.join(file);
        let bytes = fs::read(&path).map_err(|error| Failure::File { path, error })?;
        Ok(String::from_utf8(bytes).ok())
    }

    /// A cargo command in the root, by the cargo that runs this program.
    pub fn cargo(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        command.args(arguments).current_dir(&self.root);
        command
    }
}

/// The command as one would type it.
pub fn typed(command: &Command) -> String {
    let program = Path::new(command.get_program()).file_stem().unwrap_or_default();
    let words = std::iter::once(program).chain(command.get_args());
    words.map(|word| word.to_string_lossy().into_owned()).collect::<Vec<_>>().join(" ")
}

/// Runs a command, its output on ours.
pub fn run(command: &mut Command, remedy: &'static str) -> Result<(), Failure> {
    println!("$ {}", typed(command));
    let status =
        command.status().map_err(|error| Failure::Missing { command: typed(command), error, remedy })?;
    if status.success() { Ok(()) } else { Err(Failure::Command { command: typed(command), status }) }
}

/// Runs a command and takes what it writes to its standard output, whatever its status.
pub fn answer(
    command: &mut Command,
    remedy: &'static str,
) -> Result<(std::process::ExitStatus, String), Failure> {
    println!("$ {}", typed(command));
    let output = command
        .stderr(std::process::Stdio::inherit())
        .output()
        .map_err(|error| Failure::Missing { command: typed(command), error, remedy })?;
    Ok((output.status, String::from_utf8_lossy(&output.stdout).into_owned()))
}
