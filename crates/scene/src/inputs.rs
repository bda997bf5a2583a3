//! What a scene was read from: texts, other files, settings. Enough to know it again, and to read it again elsewhere.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

/// All that a scene was read from, in the order it was read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Inputs {
    /// The scene's own text first, then those it includes.
    pub texts: Vec<InputText>,
    /// Meshes and surfaces, each once.
    pub files: Vec<InputFile>,
    /// `path=value` that changed it.
    pub settings: Vec<String>,
}

/// A text of a scene.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct InputText {
    /// Its path as it was opened, or what it is called in messages.
    pub name: String,
    /// Files named in it are relative to this folder.
    pub folder: PathBuf,
    pub text: String,
}

/// Another file that a scene was made from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InputFile {
    /// As it was opened, relative to the folder the program ran in.
    pub path: PathBuf,
    pub sha256: String,
}

/// Where to find what a scene names, instead of on the disk where it says.
#[derive(Clone, Debug, Default)]
pub struct Library {
    /// Included texts by the path that asks for them.
    pub texts: BTreeMap<PathBuf, String>,
    /// Places of other files by the path that asks for them.
    pub files: BTreeMap<PathBuf, PathBuf>,
}

impl Library {
    /// Where the file of a path is.
    pub fn place_of<'a>(&'a self, path: &'a Path) -> &'a Path {
        self.files.get(path).map_or(path, PathBuf::as_path)
    }
}

/// SHA-256 as hexadecimal digits.
pub fn sha256(bytes: &[u8]) -> String {
    hexadecimal(Sha256::new_with_prefix(bytes))
}

/// The fingerprint of a scene: of all texts, settings among them, and of all other files it was made from.
pub fn fingerprint<'a>(texts: impl Iterator<Item = &'a str>, files: &[InputFile]) -> String {
    let mut digest = Sha256::new();
    let mut add = |content: &str| {
        digest.update((content.len() as u64).to_le_bytes());
        digest.update(content);
    };
    // what could not be read stands as an empty text among the sources
    texts.filter(|text| !text.is_empty()).for_each(&mut add);
    files.iter().for_each(|file| add(&file.sha256));
    hexadecimal(digest)
}

fn hexadecimal(digest: Sha256) -> String {
    digest.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}
