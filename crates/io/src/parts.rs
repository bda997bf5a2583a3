//! Meshes kept in several files of one stem: the files joined to one content, and taken apart again.
//!
//! Joined, each part follows a line `# part EXTENSION` and ends with a line end that is not its own, the last one excepted: what
//! is joined comes apart byte for byte. Readers and writers of such formats work on joined content, as other formats work on the
//! bytes of their one file; faults name the part and the line within it.

use std::io::Write;
use std::path::{Path, PathBuf};

use crate::IoError;
use crate::encoding::unmarked;
use crate::error::{Fault, Place, quoted};

const MARK: &[u8] = b"# part ";

/// Begins the next part of joined content.
pub(crate) fn begin(joined: &mut dyn Write, index: usize, extension: &str) -> std::io::Result<()> {
    let end_of_last = if index > 0 { "\n" } else { "" };
    writeln!(joined, "{end_of_last}# part {extension}")
}

/// Reads the files of the stem of `path` that exist, joined in the order of `extensions`.
///
/// # Errors
/// The first of them, which every mesh has, cannot be read; or one that is there cannot.
pub(crate) fn read_joined(path: &Path, extensions: &[&str]) -> Result<Vec<u8>, IoError> {
    let mut joined = Vec::new();
    for (index, extension) in extensions.iter().enumerate() {
        let part = beside(path, extension);
        let read_into = |joined: &mut Vec<u8>| {
            let bytes = std::fs::read(&part)?;
            let text = match unmarked(&bytes) {
                Ok(text) => text,
                Err(fault) => return Ok(Err(fault)),
            };
            begin(joined, index, extension)?;
            joined.write_all(text).map(Ok)
        };
        match read_into(&mut joined) {
            Ok(read) => read.map_err(|fault| IoError::content(&part, fault))?,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound && index > 0 && part != path => {}
            Err(source) => return Err(IoError::Read { path: part, source }),
        }
    }
    Ok(joined)
}

/// The files of the stem of `path` that exist beside it, itself left out.
pub(crate) fn others_of(path: &Path, extensions: &[&str]) -> Vec<PathBuf> {
    let all = extensions.iter().map(|extension| beside(path, extension));
    all.filter(|part| part != path && part.is_file()).collect()
}

/// The file of another extension beside `path`, in the case of letters that `path` has.
fn beside(path: &Path, extension: &str) -> PathBuf {
    let upper = path.extension().is_some_and(|own| own.to_string_lossy().chars().all(|c| c.is_uppercase()));
    path.with_extension(if upper { extension.to_uppercase() } else { extension.to_owned() })
}

/// The parts of joined content with the names of their files.
pub(crate) fn split_for(path: &Path, joined: &[u8]) -> Vec<(PathBuf, Vec<u8>)> {
    let parts = split(joined).unwrap_or_default();
    parts.into_iter().map(|part| (beside(path, part.extension), part.bytes.to_vec())).collect()
}

/// One file of several.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part<'a> {
    pub extension: &'a str,
    pub bytes: &'a [u8],
}

/// The parts of joined content.
pub(crate) fn split(joined: &[u8]) -> Result<Vec<Part<'_>>, Fault> {
    let mut parts: Vec<Part<'_>> = Vec::new();
    let mut start = 0;
    let mut offset = 0;
    for line in joined.split_inclusive(|byte| *byte == b'\n') {
        let extension = line.strip_prefix(MARK).and_then(|name| std::str::from_utf8(name.trim_ascii()).ok());
        let end = offset + line.len();
        match (extension, parts.last_mut()) {
            (Some(extension), last) => {
                if let Some(part) = last {
                    part.bytes = part.bytes.strip_suffix(b"\n").unwrap_or_default();
                }
                parts.push(Part { extension, bytes: &joined[end..end] });
                start = end;
            }
            (None, Some(part)) => part.bytes = &joined[start..end],
            (None, None) => {
                let expected = "`# part` and an extension, the head of the first of several joined files";
                return Err(Fault::new(
                    Place::Line(1),
                    "the first line",
                    quoted(line.trim_ascii()),
                    expected,
                ));
            }
        }
        offset = end;
    }
    Ok(parts)
}

/// A fault at a line of a part.
pub(crate) fn in_part(extension: &'static str, fault: Fault) -> Fault {
    match fault.place {
        Place::Line(line) => Fault { place: Place::PartLine { extension, line }, ..fault },
        _ => fault,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_come_apart() {
        let joined = b"# part node\n1 2\n# a comment\n\n# part ele\n\n# part face\nx";
        let parts: Vec<_> = split(joined).unwrap().iter().map(|part| (part.extension, part.bytes)).collect();
        let expected: [(&str, &[u8]); 3] = [("node", b"1 2\n# a comment\n"), ("ele", b""), ("face", b"x")];
        assert_eq!(parts, expected);
        assert!(split(b"1 2\n").is_err());
        assert!(split(b"").unwrap().is_empty());
        let names: Vec<_> = split_for(Path::new("a/b.NODE"), joined).into_iter().map(|file| file.0).collect();
        assert_eq!(names, [Path::new("a/b.NODE"), Path::new("a/b.ELE"), Path::new("a/b.FACE")]);
    }
}
