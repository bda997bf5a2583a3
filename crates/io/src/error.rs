//! What can go wrong with a file: it cannot be opened, its content is faulty, it cannot be written.

use std::fmt;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// A file that cannot be read or written.
#[derive(Debug, thiserror::Error)]
pub enum IoError {
    #[error("cannot read {}: {source}", .path.display())]
    Read { path: PathBuf, source: std::io::Error },
    #[error("{}: {fault}", .path.display())]
    Content { path: PathBuf, fault: Box<Fault> },
    #[error("cannot write {}: the disk is full; nothing was left behind", .path.display())]
    DiskFull { path: PathBuf },
    #[error("cannot write {}: its folder is missing or may not be written to ({source})", .path.display())]
    NotWritable { path: PathBuf, source: std::io::Error },
    #[error("cannot write {}: {source}", .path.display())]
    Write { path: PathBuf, source: std::io::Error },
    #[error("{}: no format has the extension `{found}`; expected {expected}", .path.display())]
    Extension { path: PathBuf, found: String, expected: String },
    #[error("the format `{format}` cannot be {action}; expected {expected}")]
    Unsupported { format: &'static str, action: &'static str, expected: String },
    #[error("{subject} is {value}; expected {expected}")]
    Request { subject: String, value: String, expected: String },
    #[error(transparent)]
    UnknownFormat(#[from] souple_table::UnknownName),
}

/// A fault in the content of a file: where, about what, what was read, what would be accepted.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{place}: {subject} is {found}; expected {expected}")]
pub struct Fault {
    pub place: Place,
    pub subject: String,
    /// What was read.
    pub found: String,
    /// What would be accepted.
    pub expected: String,
}

impl Fault {
    /// Where what is what, without what would be accepted.
    pub fn what(&self) -> String {
        format!("{}: {} is {}", self.place, self.subject, self.found)
    }
}

/// A place in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Line of a text, from 1.
    Line(usize),
    /// Line of one file of several, from 1.
    PartLine { extension: &'static str, line: usize },
    /// Offset from the start of the file.
    Byte(usize),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}"),
            Self::PartLine { extension, line } => write!(f, "line {line} of the .{extension} file"),
            Self::Byte(offset) => write!(f, "byte {offset}"),
        }
    }
}

impl Fault {
    pub(crate) fn new(
        place: Place,
        subject: impl Into<String>,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Self {
        Self { place, subject: subject.into(), found: found.into(), expected: expected.into() }
    }

    /// The fault of a file that ends too early.
    pub(crate) fn cut_off(place: Place, subject: impl Into<String>, expected: impl Into<String>) -> Self {
        Self::new(place, subject, "missing, the file ends here", expected)
    }
}

impl IoError {
    pub(crate) fn request(
        subject: impl Into<String>,
        value: impl fmt::Display,
        expected: impl Into<String>,
    ) -> Self {
        Self::Request { subject: subject.into(), value: value.to_string(), expected: expected.into() }
    }

    pub(crate) fn content(path: &Path, fault: Fault) -> Self {
        Self::Content { path: path.to_owned(), fault: Box::new(fault) }
    }

    /// The error of a failed write, by its cause.
    pub(crate) fn write(path: &Path, source: std::io::Error) -> Self {
        let path = path.to_owned();
        match source.kind() {
            ErrorKind::StorageFull | ErrorKind::QuotaExceeded => Self::DiskFull { path },
            ErrorKind::NotFound
            | ErrorKind::PermissionDenied
            | ErrorKind::ReadOnlyFilesystem
            | ErrorKind::NotADirectory => Self::NotWritable { path, source },
            _ => Self::Write { path, source },
        }
    }
}

/// What was read, shortened, printable and in quotes.
pub(crate) fn quoted(bytes: &[u8]) -> String {
    const LONGEST: usize = 40;
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(4 * LONGEST)]);
    let mut shown: String = text.chars().take(LONGEST).flat_map(char::escape_debug).collect();
    if text.chars().count() > LONGEST || bytes.len() > 4 * LONGEST {
        shown.push('…');
    }
    format!("\"{shown}\"")
}
