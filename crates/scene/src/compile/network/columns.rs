//! Files of columns that `souple sweep` writes and controls read: plans and tables.

use super::super::Draft;
use crate::diagnostic::{Code, Site};

/// The text of a file that a control reads; `None` where it was refused, told what is expected.
pub fn text_of(draft: &Draft, (site, file): (&Site, &str), expected: &str) -> Option<String> {
    let read = draft.sources.read(site.place.source, file).map_err(|error| {
        let is_missing = error.kind() == std::io::ErrorKind::NotFound;
        let code = if is_missing { Code::NotFound } else { Code::Unreadable };
        draft.log.add(code, site, format!("`{file}`: {error}"), expected);
    });
    read.ok()
}
