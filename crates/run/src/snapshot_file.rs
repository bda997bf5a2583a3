//! A state on disk, with the scene it belongs to and the edits that were made on the way to it.

use std::path::Path;

use serde_json::{Value, json};
use souple_engine::{Command, SnapshotError, State};
use souple_io::IoError;

use crate::command::{command_from_json, command_to_json};
use crate::machine::{binary, instruction_set};

/// What is needed to go on with a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Snapshot {
    pub state: State,
    /// All edits since the start: the model is of their generation.
    pub commands: Vec<Command>,
    pub seed: u64,
    /// What it was written by and on: where these differ, a resumed run may differ from an unbroken one in bits.
    pub binary: String,
    pub isa: String,
}

/// A file that is no snapshot of the scene at hand.
#[derive(Debug, thiserror::Error)]
pub enum SnapshotFileError {
    #[error("`{path}` cannot be read: {source}")]
    Unreadable { path: String, source: std::io::Error },
    #[error("`{path}` is no snapshot: it has no line that names its scene")]
    NoHeader { path: String },
    #[error("the first line of `{path}` is wrong: {problem}")]
    Header { path: String, problem: String },
    #[error(
        "`{path}` is of another scene: SHA-256 {found}, not {expected}; resume with the scene, the settings (--set) and the mesh files it was made with"
    )]
    OtherScene { path: String, found: String, expected: String },
    #[error("`{path}` is damaged: its content has the hash {found}, its first line says {expected}")]
    Damaged { path: String, found: String, expected: String },
    #[error("`{path}`: {source}")]
    Content { path: String, source: SnapshotError },
}

/// Version of the first line; another one is refused.
const HEADER: &str = "souple snapshot 2 ";

/// The content of a snapshot.
pub fn snapshot_bytes(scene_sha256: &str, seed: u64, state: &State, commands: &[Command]) -> Vec<u8> {
    let header = json!({
        "scene_sha256": scene_sha256,
        "state": state.hash(),
        "seed": seed,
        "binary": binary(),
        "isa": instruction_set(),
        "commands": commands.iter().map(command_to_json).collect::<Vec<_>>(),
    });
    let mut bytes = format!("{HEADER}{header}\n").into_bytes();
    bytes.extend(state.to_bytes());
    bytes
}

/// # Errors
/// The file cannot be written.
pub fn write_snapshot(
    path: &Path,
    scene_sha256: &str,
    seed: u64,
    state: &State,
    commands: &[Command],
) -> Result<(), IoError> {
    let bytes = snapshot_bytes(scene_sha256, seed, state, commands);
    souple_io::write_file(path, |out| out.write_all(&bytes))
}

/// # Errors
/// The file cannot be read, is no snapshot, is damaged, or is of another scene.
pub fn read_snapshot(path: &Path, scene_sha256: &str) -> Result<Snapshot, SnapshotFileError> {
    let name = path.display().to_string();
    let bytes =
        std::fs::read(path).map_err(|source| SnapshotFileError::Unreadable { path: name.clone(), source })?;
    let no_header = || SnapshotFileError::NoHeader { path: name.clone() };
    let end = bytes.iter().position(|byte| *byte == b'\n').ok_or_else(no_header)?;
    let header = std::str::from_utf8(&bytes[..end]).map_err(|_| no_header())?;
    let header = header.strip_prefix(HEADER).ok_or_else(no_header)?;
    let malformed = |problem: String| SnapshotFileError::Header { path: name.clone(), problem };
    let header: Value = serde_json::from_str(header).map_err(|error| malformed(error.to_string()))?;
    let text = |key: &str| {
        let value = header[key].as_str().map(str::to_owned);
        value.ok_or_else(|| malformed(format!("`{key}` is missing or not a text")))
    };
    let (found, expected) = (text("scene_sha256")?, scene_sha256.to_owned());
    if found != expected {
        return Err(SnapshotFileError::OtherScene { path: name, found, expected });
    }
    let commands = header["commands"].as_array().map(Vec::as_slice).unwrap_or_default();
    let commands: Result<Vec<Command>, String> = commands.iter().map(command_from_json).collect();
    let commands = commands.map_err(malformed)?;
    let seed =
        header["seed"].as_u64().ok_or_else(|| malformed("`seed` is missing or not a count".to_owned()))?;
    let state = State::from_bytes(&bytes[end + 1..])
        .map_err(|source| SnapshotFileError::Content { path: name.clone(), source })?;
    // numbers that were changed would be taken for indices
    let (found, expected) = (state.hash(), text("state")?);
    if found != expected {
        return Err(SnapshotFileError::Damaged { path: name, found, expected });
    }
    Ok(Snapshot { state, commands, seed, binary: text("binary")?, isa: text("isa")? })
}
