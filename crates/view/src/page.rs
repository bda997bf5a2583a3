//! The page, embedded when the crate is built.

/// A file of the page.
pub struct File {
    /// As it is asked for.
    pub path: &'static str,
    /// Its media type.
    pub kind: &'static str,
    pub content: &'static [u8],
}

include!(concat!(env!("OUT_DIR"), "/page.rs"));

/// The file of a path.
pub fn file(path: &str) -> Option<&'static File> {
    FILES.iter().find(|file| file.path == path)
}
