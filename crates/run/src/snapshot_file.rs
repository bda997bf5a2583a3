//! A state on disk, with the scene it belongs to.

use std::path::Path;

use souple_engine::{SnapshotError, State};
use souple_io::IoError;

/// A file that is no snapshot of the scene at hand.
#[derive(Debug, thiserror::Error)]
pub enum SnapshotFileError {
    #[error("`{path}` cannot be read: {source}")]
    Unreadable { path: String, source: std::io::Error },
    #[error("`{path}` is no snapshot: it has no line that names its scene")]
    NoHeader { path: String },
    #[error(
        "`{path}` is of another scene: SHA-256 {found}, not {expected}; resume with the scene and the settings it was made with"
    )]
    OtherScene { path: String, found: String, expected: String },
    #[error("`{path}` is damaged: its content has the hash {found}, its first line says {expected}")]
    Damaged { path: String, found: String, expected: String },
    #[error("`{path}`: {source}")]
    Content { path: String, source: SnapshotError },
}

const HEADER: &str = "souple snapshot of scene ";

/// # Errors
/// The file cannot be written.
pub fn write_snapshot(path: &Path, scene_sha256: &str, state: &State) -> Result<(), IoError> {
    souple_io::write_file(path, |out| {
        writeln!(out, "{HEADER}{scene_sha256} state {}", state.hash())?;
        out.write_all(&state.to_bytes())
    })
}

/// # Errors
/// The file cannot be read, is no snapshot, or is of another scene.
pub fn read_snapshot(path: &Path, scene_sha256: &str) -> Result<State, SnapshotFileError> {
    let name = path.display().to_string();
    let bytes =
        std::fs::read(path).map_err(|source| SnapshotFileError::Unreadable { path: name.clone(), source })?;
    let no_header = || SnapshotFileError::NoHeader { path: name.clone() };
    let end = bytes.iter().position(|byte| *byte == b'\n').ok_or_else(no_header)?;
    let header = std::str::from_utf8(&bytes[..end]).map_err(|_| no_header())?;
    let (found, hash) =
        header.strip_prefix(HEADER).and_then(|rest| rest.split_once(" state ")).ok_or_else(no_header)?;
    if found != scene_sha256 {
        let (found, expected) = (found.to_owned(), scene_sha256.to_owned());
        return Err(SnapshotFileError::OtherScene { path: name, found, expected });
    }
    let state = State::from_bytes(&bytes[end + 1..])
        .map_err(|source| SnapshotFileError::Content { path: name.clone(), source })?;
    // numbers that were changed would be taken for indices
    if state.hash() != hash {
        return Err(SnapshotFileError::Damaged {
            path: name,
            found: state.hash(),
            expected: hash.to_owned(),
        });
    }
    Ok(state)
}
